//! Texels: every format, wrap and function exactly; filters and levels against f64.

use super::bench::{Mapping, any_way, pick, seen, sheet, specified, stretched, triangle};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_tests::harness::{Comparison, Hidden, Look, Options, Path, Pixels, Random, Sampler, Stage, State};
use zga_tests::oracle::effects::texel::{Filter, Format};

const SIZE: [u32; 2] = [34, 27];

/// A texture of noise, of which a part may be used, outside of which anything may happen.
fn any_sampler(random: &mut Random) -> (Sampler, Vec<u32>) {
    let format = pick(random, &Format::ALL);
    let size = [(); 2].map(|()| pick(random, &[1, 2, 3, 5, 8, 13, 16, 31]));
    let (sampler, words) = Sampler::noise(random, format, size);
    let part = |random: &mut Random, side: u32| {
        let offset = random.range(0, i64::from(side) - 1) as u32;
        [offset, random.range(0, i64::from(side - offset)) as u32]
    };
    let [x, y] = [part(random, size[0]), part(random, size[1])];
    let whole = random.range(0, 2) == 0;
    let bits = random.bits();
    let flag = |bit: u32| bits >> bit & 1 == 1;
    let sampler = Sampler {
        offset: if whole { [0; 2] } else { [x[0], y[0]] },
        window: if whole { [0; 2] } else { [x[1], y[1]] },
        repeat: [flag(0), flag(1)],
        mirror: [flag(2), flag(3)],
        function: random.range(0, 3) as u32,
        constant: bits as u32,
        ..sampler
    };
    (sampler, words)
}

/// Texels that the window has.
fn window(sampler: &Sampler) -> [u32; 2] {
    [0, 1].map(|axis| match sampler.window[axis] {
        0 => sampler.size[axis] - sampler.offset[axis],
        used => used,
    })
}

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn draw_nearest_any_format_wrap_and_function_is_exact(seeds in seeds(6)) {
        let mut random = Random::new(seeds[0]);
        let (sampler, words) = any_sampler(&mut random);
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &words);
        for seed in seeds {
            let mut random = Random::new(seed);
            let mapping = Mapping::any(&mut random, window(&sampler));
            let colour = random.bits() as u32;
            let mut corners = triangle(&mut random, SIZE, colour);
            for corner in &mut corners {
                corner.coordinates = mapping.at([corner.position[0], corner.position[1]]);
            }
            stage.triangles(&corners, &State::looking(Look::textured(sampler)));
        }

        let found = stage.compare();

        prop_assert!(found.right() && found.doubtful == 0 && found.drawn == 0, "{:?}: {}", sampler, found);
    }

    #[test]
    fn draw_any_filter_in_perspective_is_within_the_tolerance(seeds in seeds(6)) {
        let mut random = Random::new(seeds[0]);
        let (sampler, words) = any_sampler(&mut random);
        let sampler = Sampler { filter: pick(&mut random, &Filter::ALL), bias: random.range(-600, 600) as i16, ..sampler };
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &words);
        for seed in seeds {
            let mut random = Random::new(seed);
            let look = Look { mip_map: random.range(0, 1) == 1, ..Look::textured(sampler) };
            let colours = [random.bits() as u32; 3];
            stage.triangles(&seen(&mut random, 30.0, colours), &State { camera: stretched(SIZE), ..State::looking(look) });
        }

        let found = stage.compare();

        prop_assert!(found.right(), "{:?}: {}", sampler, found);
    }
}

/// Noise seen through a filter: `far` says how much it is minified, `scale` how often it repeats.
fn measure(filter: Filter, mip_map: bool, far: f64, scale: f32) -> Comparison {
    let mut random = Random::new(7);
    let (sampler, words) = Sampler::noise(&mut random, Format::Rgba8888, [64, 32]);
    let sampler = Sampler { filter, function: 0, repeat: [true; 2], ..sampler };
    let size = [192, 160];
    let mut stage = Stage::new(size, &Options { pixels: Pixels::Argb8888, ..Options::default() }, &words);
    for _ in 0..60 {
        let mut corners = seen(&mut random, far, [u32::MAX; 3]);
        corners.iter_mut().for_each(|corner| corner.coordinates = corner.coordinates.map(|c| c * scale));
        let look = Look { mip_map, ..Look::textured(sampler) };
        stage.triangles(&corners, &State { camera: stretched(size), ..State::looking(look) });
    }
    stage.compare()
}

#[test]
fn draw_filters_against_f64_errors_are_within_the_stated_ones() {
    // Largest: a coordinate off by 1/256 texel on both axes of noise (2 x 255 / 256), between levels another 1/128 level
    // (255 / 128), and the rounding to a level (1/2). Mean: rounding to 1/256 texel is off by 1/1024 on average, and
    // neighbours of noise differ by 85 levels on average, on two axes: 1/6 of a level; rounding to a level: 1/4; a level of
    // detail off by 1/1024: 1/12. In doubt is what lies 1/256 texel beside a boundary, on two axes and both sides: 1/64;
    // and of levels 1/64, where they are chosen.
    let bounds =
        [(Filter::Nearest, 0.0, 0.0, 0.04), (Filter::Bilinear, 2.5, 0.45, 0.02), (Filter::Trilinear, 4.5, 0.5, 0.001)];
    for (filter, largest, mean, doubtful) in bounds {
        for (mip_map, far, scale) in [(false, 4.0, 0.2), (true, 4.0, 0.2), (true, 40.0, 1.0), (true, 200.0, 3.0)] {
            let found = measure(filter, mip_map, far, scale);
            println!("{filter:?}, levels {mip_map}, to {far}, x {scale}: {found}");
            assert!(found.right(), "{filter:?}: {found}");
            assert!(found.largest <= largest && found.mean <= mean, "{filter:?}: {found}");
            assert!(found.doubtful as f64 <= doubtful * found.pixels as f64, "{filter:?}: {found}");
            assert!(filter == Filter::Nearest || found.drawn > found.pixels / 2, "{filter:?}: {found}");
        }
    }
}

#[test]
fn draw_levels_of_one_colour_show_which_level_is_read() {
    // Level k is all 40 k: what is seen is 40 times the level of detail.
    let colours: Vec<u32> = (0..7).map(|k| 0xFF00_0000 | (40 * k)).collect();
    let (sampler, words) = Sampler::plain_levels([64, 64], &colours);
    for (filter, bias, shrink, red) in [
        (Filter::Trilinear, 0, 4.0, 80),
        (Filter::Trilinear, 128, 4.0, 100),
        (Filter::Trilinear, -512, 4.0, 0),
        (Filter::Trilinear, 0, 0.25, 0),
        (Filter::Trilinear, 0, 1024.0, 240),
        (Filter::Nearest, 127, 4.0, 80),
        (Filter::Nearest, 128, 4.0, 120),
        (Filter::Bilinear, -129, 4.0, 40),
        (Filter::Bilinear, 32767, 4.0, 240),
    ] {
        let sampler = Sampler { filter, bias, repeat: [true; 2], ..sampler };
        let mut stage = Stage::new([16, 16], &specified(Hidden::default()), &words);
        let mut corners = sheet([16, 16], 0.5, u32::MAX);
        for corner in &mut corners {
            corner.coordinates = [corner.position[0] * shrink / 64.0, 0.5];
        }
        stage.triangles(&corners, &State::looking(Look { mip_map: true, ..Look::textured(sampler) }));

        let (picture, found, _) = stage.end();

        assert!(found.right(), "{filter:?} {bias} {shrink}: {found}");
        assert!(picture.colour.iter().all(|&pixel| pixel == 0xFF00_0000 | red << 16), "{filter:?} {bias} {shrink}");
    }
}

#[test]
fn draw_sheet_counts_lookups_fetches_and_clocks() {
    // 10 x 6 pixels; trilinear without levels is bilinear.
    let mut random = Random::new(1);
    let (sampler, words) = Sampler::noise(&mut random, Format::Rgba8888, [8, 8]);
    for (filter, mip_map, fetches, clocks) in [
        (Filter::Nearest, false, 60, 60),
        (Filter::Nearest, true, 60, 60),
        (Filter::Bilinear, true, 240, 60),
        (Filter::Trilinear, false, 240, 60),
        (Filter::Trilinear, true, 480, 120),
    ] {
        for path in Path::ALL {
            let mut stage = Stage::new([10, 6], &specified(Hidden::on(path)), &words);
            let mut corners = sheet([10, 6], 0.5, u32::MAX);
            // Between level 1 and level 2.
            corners.iter_mut().for_each(|corner| corner.coordinates = [corner.position[0] * 3.0 / 8.0, 0.3]);
            stage.screen.clear_counts();
            let look = Look { mip_map, ..Look::textured(Sampler { filter, ..sampler }) };
            stage.triangles(&corners, &State::looking(look));
            stage.screen.end();

            let events = stage.screen.events();

            let counted = ["texture.texels", "texture.fetches", "cycles.texture"].map(|name| events[name]);
            assert_eq!(counted, [60, fetches, clocks], "{filter:?}, levels {mip_map}, {path:?}");
            assert!(events["texture.decoded_bytes"] > 0, "{filter:?}");
            assert_eq!(events["texture.holes"], 0);
        }
    }
}
