//! Punch-through: texels that decide what is visible.

use super::bench::{Mapping, any_way, chance, pick, seen, specified, stretched, triangle};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_tests::harness::{Hidden, Look, Path, Random, Sampler, Stage, State};
use zga_tests::oracle::DepthFunction;
use zga_tests::oracle::effects::texel::{Filter, Format};

const SIZE: [u32; 2] = [34, 27];

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn draw_any_holes_of_nearest_texels_are_exact_on_every_path(seeds in seeds(8)) {
        let mut random = Random::new(seeds[0]);
        let format = pick(&mut random, &Format::ALL);
        let (sampler, words) = Sampler::noise(&mut random, format, [8, 8]);
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &words);
        for seed in seeds {
            let mut random = Random::new(seed);
            let sampler = Sampler { repeat: [true; 2], function: random.range(0, 3) as u32, ..sampler };
            let mapping = Mapping::any(&mut random, [8, 8]);
            let colour = random.bits() as u32;
            let mut corners = triangle(&mut random, SIZE, colour);
            for corner in &mut corners {
                corner.coordinates = mapping.at([corner.position[0], corner.position[1]]);
            }
            let reference = chance(&mut random, 80).then(|| random.bits() as u8);
            let look = Look { punch_through: reference, ..Look::textured(sampler) };
            let function = if chance(&mut random, 70) { DepthFunction::Less } else { pick(&mut random, &DepthFunction::ALL) };
            let state = State { function, write: chance(&mut random, 85), ..State::looking(look) };
            stage.triangles(&corners, &state);
        }

        let found = stage.compare();

        prop_assert!(found.right() && found.doubtful == 0 && found.drawn == 0, "{}", found);
    }

    #[test]
    fn draw_any_holes_of_filtered_texels_are_right_but_in_doubt(seeds in seeds(5)) {
        let mut random = Random::new(seeds[0]);
        let (sampler, words) = Sampler::noise(&mut random, Format::Rgba8888, [16, 16]);
        let sampler = Sampler { filter: pick(&mut random, &Filter::ALL), repeat: [true; 2], ..sampler };
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &words);
        for seed in seeds {
            let mut random = Random::new(seed);
            let look = Look {
                mip_map: chance(&mut random, 50),
                punch_through: Some(random.bits() as u8),
                ..Look::textured(sampler)
            };
            let colours = [random.bits() as u32; 3];
            stage.triangles(&seen(&mut random, 20.0, colours), &State { camera: stretched(SIZE), ..State::looking(look) });
        }

        let found = stage.compare();

        prop_assert!(found.right(), "{:?}: {}", sampler.filter, found);
    }
}

#[test]
fn draw_counts_holes_and_what_was_behind_stays() {
    // Two columns of texels: alpha 127 and 128; the reference is 128.
    let words = [0x7F00_00FF, 0x8000_FF00];
    let sampler = Sampler { size: [2, 1], function: 0, ..Sampler::default() };
    for path in Path::ALL {
        let mut stage = Stage::new([8, 4], &specified(Hidden::on(path)), &words);
        stage.clear([0, 0, 9, 255]);
        stage.screen.clear_counts();
        let mut corners = super::bench::sheet([8, 4], 0.5, u32::MAX);
        corners.iter_mut().for_each(|corner| corner.coordinates = [corner.position[0] / 8.0, 0.5]);
        let look = Look { punch_through: Some(128), ..Look::textured(sampler) };
        stage.triangles(&corners, &State::looking(look));

        let (picture, found, _) = stage.end();

        assert!(found.right(), "{path:?}: {found}");
        assert_eq!(picture.colour[..8], [[0xFF00_0009; 4], [0x8000_FF00; 4]].concat(), "{path:?}");
        assert_eq!(stage.screen.events()["texture.holes"], 16, "{path:?}");
    }
}
