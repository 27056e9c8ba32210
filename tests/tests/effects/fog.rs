//! Fog and depth cueing against f64.

use super::bench::{any_fog, any_way, chance, seen, sheet, specified, stretched};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_tests::harness::look::Fog;
use zga_tests::harness::{Camera, Hidden, Look, Path, Random, Stage, State};

const SIZE: [u32; 2] = [40, 33];

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn draw_any_fog_is_within_the_tolerance(seeds in seeds(6)) {
        let mut random = Random::new(seeds[0]);
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &[]);
        for seed in seeds {
            let mut random = Random::new(seed);
            let fog = any_fog(&mut random);
            let colours = [(); 3].map(|()| random.bits() as u32);
            let state = State {
                camera: stretched(SIZE),
                gouraud: chance(&mut random, 50),
                ..State::looking(Look { fog: Some(fog), ..Look::default() })
            };
            stage.triangles(&seen(&mut random, 40.0, colours), &state);
        }

        let found = stage.compare();

        prop_assert!(found.right() && found.doubtful == 0, "{}", found);
    }
}

#[test]
fn draw_sheet_in_each_fog_is_the_worked_out_colour() {
    // A sheet at eye z = -4; black fog over white: what is seen is the share.
    let fog = Fog { density: 0.25, end: 16.0, scale: 0.25, offset: 1.2, ..Fog::default() };
    for (function, share) in [(0, 255), (1, 191), (2, 94), (3, 94), (4, 51)] {
        for path in Path::ALL {
            let mut stage = Stage::new([8, 8], &specified(Hidden::on(path)), &[]);
            stage.screen.clear_counts();
            let mut corners = sheet([8, 8], -4.0, u32::MAX);
            corners.iter_mut().for_each(|corner| corner.colour = 0x50FF_FFFF);
            // Depth is -z / 8.
            let camera = Camera {
                eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -0.125, 0., 0., 0., 0., 1.],
                ..Camera::default()
            };
            let look = Look { fog: Some(Fog { function, ..fog }), ..Look::default() };
            stage.triangles(&corners, &State { camera, ..State::looking(look) });

            let (picture, found, _) = stage.end();

            assert!(found.right(), "{function} {path:?}: {found}");
            assert_eq!(picture.colour, [0x5000_0000 | share << 16 | share << 8 | share; 64], "{function} {path:?}");
            assert_eq!(
                stage.screen.events()["shading.fogged"],
                if function == 0 { 0 } else { 64 },
                "{function} {path:?}"
            );
        }
    }
}
