//! Light at vertices and at pixels against f64.

use super::bench::{any_lights, any_record, any_way, chance, corner, seen, sheet, specified, stretched};
use super::{cases, seeds};
use proptest::prelude::*;
use zga_tests::harness::look::{Lights, Record};
use zga_tests::harness::{Hidden, Look, Path, Random, Stage, State};
use zga_tests::oracle::effects::Corner;

const SIZE: [u32; 2] = [40, 33];

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn draw_any_lights_are_within_the_tolerance(seeds in seeds(5)) {
        let mut random = Random::new(seeds[0]);
        let records: Vec<Record> = (0..8).map(|_| any_record(&mut random)).collect();
        let words: Vec<u32> = records.iter().flat_map(Record::words).collect();
        let mut stage = Stage::new(SIZE, &any_way(&mut random), &words);
        for seed in seeds {
            let mut random = Random::new(seed);
            let [first, count] = [0; 2].map(|_: u32| random.range(0, 4) as u32);
            let light = any_lights(&mut random, 64 * first, count);
            let colours = [(); 3].map(|()| random.bits() as u32);
            let state = State {
                camera: stretched(SIZE),
                gouraud: chance(&mut random, 70),
                ..State::looking(Look { light: Some(light), ..Look::default() })
            };
            stage.triangles(&seen(&mut random, 20.0, colours), &state);
        }

        let found = stage.compare();

        prop_assert!(found.right() && found.doubtful == 0, "{:?}: {}", records, found);
    }
}

#[test]
fn draw_sheet_of_each_kind_of_light_is_the_worked_out_colour() {
    // Eye coordinates are pixels here: a sheet at z = 0.5 seen from +z, lit along -z; its colour is 200. The point lights
    // are over the centre of the pixel looked at.
    let white = Record { direction: [0.0, 0.0, -1.0], colour: 0x00FF_FFFF, ..Record::default() };
    let near = Record { kind: 1, position: [1.5, 1.5, 1.5], cut_off: 4.0, ..white };
    let lights = Lights { per_pixel: true, count: 1, ..Lights::default() };
    for (record, lights, level) in [
        (white, lights, 200),
        (Record { colour: 0x0033_3333, ..white }, lights, 40),
        (Record { direction: [0.0, 0.0, 1.0], ..white }, lights, 0),
        (Record { kind: 7, ..white }, lights, 200),
        (white, Lights { count: 0, ambient: 0x0080_8080, ..lights }, 100),
        (white, Lights { count: 0, emission: 0x0021_2121, ..lights }, 33),
        (white, Lights { specular: 0x0014_1414, shininess: 5.0, ..lights }, 220),
        (white, Lights { emission: 0x00FF_FFFF, ..lights }, 255),
        // Distance 1 of 4: (1 - 1/16)^2 = 225/256.
        (near, lights, 176),
        (Record { kind: 2, exponent: 3.0, ..near }, lights, 176),
        (Record { kind: 2, direction: [0.0, 0.0, 1.0], ..near }, lights, 0),
        (Record { cut_off: f32::NAN, ..near }, lights, 200),
    ] {
        let mut stage = Stage::new([3, 3], &specified(Hidden::default()), &record.words());
        let look = Look { light: Some(lights), ..Look::default() };
        stage.triangles(&sheet([3, 3], 0.5, 0x7FC8_C8C8), &State::looking(look));

        let (picture, found, _) = stage.end();

        assert!(found.right(), "{record:?} {lights:?}: {found}");
        let right = 0x7F00_0000 | level << 16 | level << 8 | level;
        assert_eq!(picture.at(1, 1).0, right, "{record:?} {lights:?}");
    }
}

#[test]
fn draw_zero_normals_have_ambient_light_alone() {
    let record = Record { direction: [0.0, 0.0, -1.0], colour: 0x00FF_FFFF, ambient: 0x0000_00FF, ..Record::default() };
    for path in Path::ALL {
        let mut stage = Stage::new([4, 4], &specified(Hidden::on(path)), &record.words());
        let lights = Lights { count: 1, ambient: 0x0000_8000, ..Lights::default() };
        let corners = sheet([4, 4], 0.5, u32::MAX).map(|corner| Corner { normal: [0.0; 3], ..corner });
        stage.triangles(&corners, &State::looking(Look { light: Some(lights), ..Look::default() }));

        let (picture, found, _) = stage.end();

        assert!(found.right(), "{path:?}: {found}");
        assert_eq!(picture.colour, [0xFFFF_8000; 16], "{path:?}");
    }
}

#[test]
fn draw_counts_lights_at_vertices_and_at_pixels() {
    let words: Vec<u32> = (0..3).flat_map(|_| Record { colour: 0x00FF_FFFF, ..Record::default() }.words()).collect();
    for path in Path::ALL {
        for (per_pixel, evaluated) in [(false, 3 * 3), (true, 3 * 15)] {
            let mut stage = Stage::new([5, 3], &specified(Hidden::on(path)), &words);
            stage.screen.clear_counts();
            // One triangle over all 15 pixels.
            let corners = [[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]].map(|place| corner(place, 0.5, u32::MAX));
            let light = Lights { per_pixel, count: 3, ..Lights::default() };
            stage.triangles(&corners, &State::looking(Look { light: Some(light), ..Look::default() }));
            stage.screen.end();

            let events = stage.screen.events();

            assert_eq!(events["shading.lights"], evaluated, "{path:?}, at pixels {per_pixel}");
        }
    }
}
