//! Facts about light that need no arithmetic.

use super::*;
use crate::shading::light::normal_matrix;

const ORIGIN: [f32; 3] = [0.0; 3];
const FACING: [f32; 3] = [0.0, 0.0, 1.0];

#[test]
fn light_that_faces_the_surface_is_full() {
    for &kind in LightType::ALL {
        for length in [1e-38, 0.5, 1.0, 7.0, 1e38] {
            assert_eq!(red(white(kind), ORIGIN, [0.0, 0.0, length]), 255, "{kind:?}, normal of {length}");
        }
    }
}

#[test]
fn light_behind_the_surface_adds_nothing() {
    let shiny = Lighting { specular: WHITE, shininess: 0.0, ..dull() };
    for &kind in LightType::ALL {
        for normal in [[0.0, 0.0, -1.0], [0.3, 0.0, -1.0], [1.0, 0.0, 0.0]] {
            let lit = lights(&shiny, &[white(kind)]).lit(0x80FF_FFFF, ORIGIN, normal);
            assert_eq!(lit, 0x8000_0000, "{kind:?} on {normal:?}");
        }
    }
}

#[test]
fn light_at_sixty_degrees_is_a_half() {
    let normal = [0.75_f32.sqrt(), 0.0, 0.5];
    for &kind in LightType::ALL {
        assert_eq!(red(white(kind), ORIGIN, normal), 128, "{kind:?}");
    }
}

#[test]
fn light_of_two_sides_turns_the_normal_to_the_viewer() {
    let both = Lighting { two_sided: true, ..dull() };
    for (local_viewer, position) in [(false, ORIGIN), (true, [0.0, 0.0, -3.0])] {
        let lights = lights(&Lighting { local_viewer, ..both }, &[white(LightType::Point)]);
        assert_eq!(lights.lit(WHITE, position, [0.0, 0.0, -1.0]), WHITE);
        assert_eq!(lights.lit(WHITE, position, FACING), WHITE);
    }
}

#[test]
fn light_adds_emission_scene_and_light_ambient() {
    let lighting = Lighting { emission: 0xFF01_0203, ambient: 0x0000_80FF, ..dull() };
    let record = LightRecord { ambient: 0x00FF_0000, colour: 0, ..white(LightType::Point) };
    // 3 + 20, 2 + 40 * 128 / 255 = 22.08, 1 + 60.
    assert_eq!(lights(&lighting, &[record]).lit(0x403C_2814, ORIGIN, [0.0; 3]), 0x403D_1617);
    assert_eq!(lights(&lighting, &[]).lit(0x403C_2814, ORIGIN, FACING), 0x4001_1617);
}

#[test]
fn light_colours_add_up_to_white_at_most() {
    let lights = lights(&Lighting { specular: WHITE, emission: WHITE, ..dull() }, &[white(LightType::Point); 9]);
    assert_eq!(lights.count(), 9);
    assert_eq!(lights.lit(0x00FF_FFFF, ORIGIN, FACING), 0x00FF_FFFF);
}

#[test]
fn light_of_a_spot_ends_at_its_cone() {
    for spot_exponent in [0.0, 1.0, 128.0] {
        let record = LightRecord { spot_exponent, ambient: WHITE, ..white(LightType::Spot) };
        assert_eq!(red(record, ORIGIN, FACING), 255, "on the axis, exponent {spot_exponent}");
        assert_eq!(red(record, [0.0, 0.0, 5.0], [0.0, 0.0, -1.0]), 0, "behind it, exponent {spot_exponent}");
        assert_eq!(red(record, [1.0, 0.0, 4.0], [-1.0, 0.0, 0.0]), 0, "beside it, exponent {spot_exponent}");
    }
}

#[test]
fn light_of_a_spot_falls_off_from_its_axis() {
    // At 60 degrees from the axis: (1/2)^e of the light.
    let place = [4.0 * 3.0_f32.sqrt(), 0.0, 0.0];
    let toward = [-place[0], 0.0, 4.0];
    let at = |spot_exponent| red(LightRecord { spot_exponent, ..white(LightType::Spot) }, place, toward);
    assert_eq!([0.0, 1.0, 2.0, 3.0, 20.0].map(at), [255, 128, 64, 32, 0]);
    // Beyond the range: as 128; not a number: as 0.
    assert_eq!([1e9, -3.0, f32::NAN, f32::INFINITY].map(at), [0, 255, 255, 255]);
}

#[test]
fn light_past_its_cut_off_is_none_and_falls_on_the_way() {
    for kind in [LightType::Point, LightType::Spot] {
        for cut_off in [1e-3, 3.7, 1e6] {
            let record = LightRecord { position: ORIGIN, cut_off, ..white(kind) };
            let at = |share: f32| red(record, [0.0, 0.0, -share * cut_off], FACING);
            let steps: Vec<u32> = (0..=3000).map(|n| at(0.0005 * (n as f32 + 0.01))).collect();
            assert!(steps.is_sorted_by(|a, b| a >= b), "{kind:?} of {cut_off}");
            // (1 - 1/4)^2 of 255 at half the distance: 143.4.
            assert_eq!([1e-4, 0.5, 1.0, 1.0001, 50.0].map(at), [255, 143, 0, 0, 0], "{kind:?} of {cut_off}");
        }
    }
}

#[test]
fn light_without_cut_off_reaches_everywhere() {
    for cut_off in [0.0, -0.0, -5.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        let record = LightRecord { cut_off, ..white(LightType::Point) };
        assert_eq!(red(record, [0.0, 0.0, -1e9], FACING), 255, "cut-off {cut_off}");
    }
    assert_eq!(red(LightRecord { cut_off: 1e-45, ..white(LightType::Point) }, ORIGIN, FACING), 0);
    assert_eq!(red(LightRecord { cut_off: 1.0, ..white(LightType::Directional) }, ORIGIN, FACING), 255);
}

#[test]
fn light_at_the_place_itself_adds_ambient_alone() {
    let ambient = 0x0010_1010;
    for (kind, expected) in [(LightType::Point, 16), (LightType::Spot, 0)] {
        let record = LightRecord { ambient, cut_off: 1e-45, ..white(kind) };
        assert_eq!(red(record, record.position, FACING), expected, "{kind:?}");
    }
}

#[test]
fn light_of_no_direction_has_the_stated_result() {
    for nothing in [0.0, f32::NAN, f32::INFINITY] {
        for (kind, expected) in [(LightType::Directional, 16), (LightType::Spot, 0)] {
            let record = LightRecord { ambient: 0x0010_1010, direction: [nothing; 3], ..white(kind) };
            assert_eq!(red(record, ORIGIN, FACING), expected, "{kind:?} of {nothing}");
        }
    }
}

#[test]
fn light_on_no_normal_is_ambient_alone() {
    for nothing in [0.0, -0.0, f32::NAN, f32::NEG_INFINITY] {
        let record = LightRecord { ambient: 0x0010_1010, ..white(LightType::Point) };
        assert_eq!(red(record, ORIGIN, [nothing; 3]), 16, "normal of {nothing}");
    }
}

#[test]
fn light_in_the_mirror_makes_a_full_highlight() {
    for shininess in [0.0, 1.0, 128.0] {
        let lighting = Lighting { specular: 0x0020_4080, shininess, ..dull() };
        let lit = lights(&lighting, &[white(LightType::Directional)]).lit(0, ORIGIN, FACING);
        assert_eq!(lit, 0x0020_4080, "shininess {shininess}");
    }
}

#[test]
fn light_of_an_unknown_type_is_directional() {
    let record = LightRecord { kind: 77, ..white(LightType::Directional) };
    assert_eq!(red(record, [0.0, 0.0, 100.0], FACING), 255);
}

#[test]
fn lights_outside_memory_are_left_out() {
    let memory = words(&[white(LightType::Point); 2]);
    let count = |lights, count| Lights::read(&memory, &Lighting { lights, count, ..dull() }).count();
    assert_eq!([count(0, 2), count(64, 1), count(64, 9), count(128, 1), count(u32::MAX, 256)], [2, 1, 1, 0, 0]);
}

#[test]
fn normal_matrix_is_the_inverse_transpose() {
    // Rows: x doubled, y and z turned by 90 degrees and halved.
    let turned = [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, -0.5, 0.0, 0.0, 7.0, 8.0, 9.0, 1.0];
    assert_eq!(normal_matrix(&turned), [[0.5, 0.0, 0.0], [0.0, 0.0, 2.0], [0.0, -2.0, 0.0]]);
    // A shear, x += 3 y: normals of planes x = constant lean, those of y = constant stay.
    let mut shear = [0.0; 16];
    (shear[0], shear[4], shear[5], shear[10]) = (1.0, 3.0, 1.0, 1.0);
    assert_eq!(normal_matrix(&shear), [[1.0, -3.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn normal_matrix_of_a_mirror_keeps_its_sign() {
    let mut mirror = [0.0; 16];
    (mirror[0], mirror[5], mirror[10]) = (-1.0, 1.0, 1.0);
    assert_eq!(normal_matrix(&mirror), [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn normal_matrix_of_a_singular_matrix_is_zero() {
    let zero = [[0.0; 3]; 3];
    assert_eq!(normal_matrix(&[0.0; 16]), zero);
    // The third row is twice the first, in numbers whose products round.
    let (a, b) = ([0.1_f32, 0.7, 0.3], [0.625_f32, -0.3, 0.9]);
    let mut flat = [0.0; 16];
    for k in 0..3 {
        (flat[k], flat[4 + k]) = (a[k], b[k]);
        flat[8 + k] = 2.0 * a[k];
    }
    assert_eq!(normal_matrix(&flat), zero);
    for bad in [f32::NAN, f32::INFINITY] {
        let mut matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        matrix[6] = bad;
        assert_eq!(normal_matrix(&matrix), zero, "{bad}");
    }
}

#[test]
fn normal_matrix_of_any_scale_is_found() {
    for scale in [1e-45_f32, 1e-30, 1e30, f32::MAX] {
        let mut matrix = [0.0; 16];
        (matrix[0], matrix[5], matrix[10]) = (scale, scale, scale);
        let found = normal_matrix(&matrix)[1][1] * f64::from(scale);
        // Two products and a quotient, each rounded by 2^-53.
        assert!((found - 1.0).abs() <= 4.0 * f64::EPSILON, "{scale}: {found}");
    }
}
