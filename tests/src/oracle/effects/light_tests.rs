//! Light that can be worked out by hand.

use super::*;
use proptest::prelude::*;

fn lighting(lights: Vec<Light>) -> Lighting {
    Lighting {
        per_pixel: false,
        two_sided: false,
        local_viewer: false,
        lights,
        ambient: [0.2, 0.0, 0.0],
        specular: [0.0; 3],
        emission: [0.0, 5.0, 0.0],
        shininess: 1.0,
    }
}

fn white(kind: u32) -> Light {
    Light { kind, direction: [0.0, 0.0, -3.0], colour: [1.0; 3], ..Light::default() }
}

const COLOUR: Ideal = [100.0, 200.0, 50.0, 77.0];

fn close(found: Ideal, right: Ideal) -> bool {
    (0..4).all(|c| (found[c] - right[c]).abs() < 1.0e-9)
}

#[test]
fn lit_without_lights_is_ambient_and_emission() {
    assert!(close(lighting(vec![]).lit(COLOUR, [0.0; 3], [0.0, 0.0, 1.0]), [20.0, 5.0, 0.0, 77.0]));
}

#[test]
fn lit_directional_follows_the_cosine() {
    let lighting = lighting(vec![white(0)]);

    assert!(close(lighting.lit(COLOUR, [9.0; 3], [0.0, 0.0, 9.0]), [120.0, 205.0, 50.0, 77.0]));
    // 60 degrees.
    let slanted = [0.75_f64.sqrt(), 0.0, 0.5];
    assert!(close(lighting.lit(COLOUR, [9.0; 3], slanted), [70.0, 105.0, 25.0, 77.0]));
    assert!(close(lighting.lit(COLOUR, [9.0; 3], [0.0, 0.0, -1.0]), [20.0, 5.0, 0.0, 77.0]));
    assert!(close(lighting.lit(COLOUR, [9.0; 3], [0.0; 3]), [20.0, 5.0, 0.0, 77.0]));
}

#[test]
fn lit_two_sided_turns_the_normal() {
    let lighting = Lighting { two_sided: true, ..lighting(vec![white(0)]) };

    assert!(close(lighting.lit(COLOUR, [9.0; 3], [0.0, 0.0, -1.0]), [120.0, 205.0, 50.0, 77.0]));
}

#[test]
fn lit_point_light_falls_off_to_its_cut_off() {
    let at = |distance: f64| {
        let light = Light { position: [0.0, 0.0, distance], cut_off: 2.0, ..white(1) };
        lighting(vec![light]).lit(COLOUR, [0.0; 3], [0.0, 0.0, 1.0])[2]
    };

    // (1 - 1/4)^2 of 50.
    assert!((at(1.0) - 28.125).abs() < 1.0e-9);
    assert_eq!([at(2.0), at(3.0)], [0.0, 0.0]);
}

#[test]
fn lit_spot_falls_off_from_its_axis() {
    // 45 degrees off the axis, exponent 2: half; the surface is turned to the light.
    let place = [1.0, 0.0, -1.0];
    let light = Light { position: [0.0; 3], exponent: 2.0, ..white(2) };
    let lit = lighting(vec![light]).lit(COLOUR, place, [-1.0, 0.0, 1.0]);

    assert!((lit[2] - 25.0).abs() < 1.0e-9);
    // Behind it.
    assert_eq!(lighting(vec![light]).lit(COLOUR, [0.0, 0.0, 1.0], [0.0, 0.0, -1.0])[2], 0.0);
}

#[test]
fn lit_highlight_is_that_of_the_half_vector() {
    // Light from +x + z, viewer along +z: the half vector is 22.5 degrees off the normal.
    let light = Light { direction: [-1.0, 0.0, -1.0], ..white(0) };
    let shiny = |shininess: f64| Lighting { specular: [100.0; 3], shininess, ..lighting(vec![light]) };
    let diffuse = 50.0 * 0.5_f64.sqrt();
    let highlight = |shininess: f64| shiny(shininess).lit(COLOUR, [0.0; 3], [0.0, 0.0, 1.0])[2] - diffuse;

    let cosine = (std::f64::consts::PI / 8.0).cos();
    assert!((highlight(1.0) - 100.0 * cosine).abs() < 1.0e-9);
    assert!((highlight(8.0) - 100.0 * cosine.powi(8)).abs() < 1.0e-9);
    assert!((highlight(0.0) - 100.0).abs() < 1.0e-9);
    // No light from behind, no highlight.
    assert_eq!(shiny(0.0).lit(COLOUR, [0.0; 3], [-1.0, 0.0, 0.0])[2], 0.0);
}

#[test]
fn lit_local_viewer_sees_from_the_eye() {
    // Seen from the side: V = (-1, 0, 0) at (1, 0, 0); light from the same side, so the half vector is the normal.
    let light = Light { direction: [1.0, 0.0, 0.0], ..white(0) };
    let local = Lighting { specular: [100.0; 3], shininess: 50.0, local_viewer: true, ..lighting(vec![light]) };

    assert!((local.lit(COLOUR, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0])[2] - 150.0).abs() < 1.0e-9);
}

#[test]
fn lit_too_bright_is_255() {
    let bright = lighting(vec![white(0); 9]);

    assert_eq!(bright.rounded([255; 4], [0.0; 3], [0.0, 0.0, 1.0]), [255; 4]);
}

#[test]
fn read_numbers_that_are_none_are_0_and_exponents_limited() {
    let mut words = vec![0; 16];
    words[0] = 2;
    words[1] = f32::NAN.to_bits();
    words[2] = f32::INFINITY.to_bits();
    words[3] = 2.5_f32.to_bits();
    words[8] = 500.0_f32.to_bits();
    words[9] = 0x00FF_8000;
    let light = Light::read(&Memory { at: 64, words }, 64);

    assert_eq!((light.position, light.exponent), ([0.0, 0.0, 2.5], 128.0));
    assert_eq!(light.colour, [0.0, 128.0 / 255.0, 1.0]);
}

proptest! {
    #[test]
    fn normal_matrix_any_matrix_keeps_normals_upright(
        m in prop::array::uniform9(-4_i8..=4), tangent in prop::array::uniform3(-5_i8..=5), normal in prop::array::uniform3(-5_i8..=5),
    ) {
        let f = |k: usize| f32::from(m[k]);
        let matrix = [f(0), f(1), f(2), 0., f(3), f(4), f(5), 0., f(6), f(7), f(8), 0., 7., 8., 9., 1.];
        let (tangent, normal) = (tangent.map(f64::from), normal.map(f64::from));
        let upper = [0, 1, 2].map(|row| [0, 1, 2].map(|column| f64::from(matrix[4 * row + column])));

        let inverse_transpose = normal_matrix(&matrix);

        // n' . t' = n . t, whatever the matrix; a singular one has no normals.
        let found = dot(transformed(normal, &inverse_transpose), transformed(tangent, &upper));
        let singular = inverse_transpose == [[0.0; 3]; 3];
        prop_assert!(singular || (found - dot(normal, tangent)).abs() < 1.0e-6, "{} {}", found, dot(normal, tangent));
    }
}
