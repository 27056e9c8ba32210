//! Draws from words.

use super::super::super::DepthFormat;
use super::super::{Colour, Shade, blend};
use super::*;

const ONE: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

/// Positions are pixels and depth.
fn registers(effects: u32) -> Registers {
    Registers {
        effects,
        depth_control: 0x101,
        scissor: [0, 0, 99, 99],
        object_eye: ONE,
        eye_clip: ONE,
        viewport: [1., 1., 1., 0., 0., 0.],
        texture: [0, 0x0001_0002, 1 << 16, 0, 0, 0, 0, 0],
        punch_through: 128,
        blend: 0,
        fog: [1, 0, 2.0_f32.to_bits(), 0, 0, 0x0000_00FF],
        light: [0, 0, 0, 0x0000_80FF, 0, 0, 0],
        stencil: [7, 0],
    }
}

fn corners(colour: u32, z: f32) -> [Corner; 3] {
    // u over 4 pixels.
    [(0.0, 0.0), (8.0, 0.0), (0.0, 8.0)].map(|(x, y)| Corner {
        position: [x, y, z],
        colour,
        normal: [0.0, 0.0, 1.0],
        coordinates: [x / 4.0, 0.5],
    })
}

fn picture(draws: &[(Registers, [Corner; 3])], memory: &Memory) -> (Vec<Shade>, Vec<Option<u32>>) {
    let mut painting = Painting::new([4, 1], DepthFormat { bits: 16, fraction: 8 }, |colour| colour);
    for (registers, corners) in draws {
        painting.draw_raw(&RawDraw { each: 3, corners, registers, memory });
    }
    (painting.end(), painting.depths())
}

fn colours(shades: &[Shade]) -> Vec<Colour> {
    shades.iter().map(|shade| shade.exact().expect("exact")).collect()
}

/// Two texels: green, and transparent red.
fn texels() -> Memory {
    let mut words = vec![0; 16];
    (words[0], words[1]) = (0xFF00_FF00, 0x0000_00FF);
    Memory { at: 0, words }
}

#[test]
fn draw_raw_nearest_texels_are_seen() {
    let (shades, depths) = picture(&[(registers(0x11), corners(u32::MAX, 0.5))], &texels());

    assert_eq!(colours(&shades), [[0, 255, 0, 255], [0, 255, 0, 255], [255, 0, 0, 0], [255, 0, 0, 0]]);
    assert_eq!(depths, [Some(32768); 4]);
}

#[test]
fn draw_raw_holes_show_what_is_behind() {
    let (far, near) = (corners(0xFF00_0009, 0.75), corners(u32::MAX, 0.25));
    let (shades, depths) = picture(&[(registers(0x211), near), (registers(0x1), far)], &texels());

    assert_eq!(colours(&shades), [[0, 255, 0, 255], [0, 255, 0, 255], [9, 0, 0, 255], [9, 0, 0, 255]]);
    assert_eq!(depths, [Some(16384), Some(16384), Some(49151), Some(49151)]);
}

#[test]
fn draw_raw_layers_of_alpha_255_are_opaque() {
    let mode = |mode: u32| Registers { blend: mode, ..registers(0x101) };
    let behind = corners(0x8000_00FF, 0.75);
    let of = |mode_word: u32, colour: u32| {
        let draws = [(mode(mode_word), corners(colour, 0.5)), (mode(0), behind)];
        let (shades, depths) = picture(&draws, &texels());
        (colours(&shades)[0], depths[0])
    };

    assert_eq!(of(0, 0xFF00_1000), ([0, 16, 0, 255], Some(32768)));
    let layered = |mode: u32, colour: Colour| blend::exact(mode, blend::exact(0, [0; 4], [255, 0, 0, 128]), colour);
    assert_eq!(of(0, 0x7F00_1000), (layered(0, [0, 16, 0, 127]), Some(65535)));
    assert_eq!(of(1, 0xFF00_1000), (layered(1, [0, 16, 0, 255]), Some(65535)));
}

#[test]
fn draw_raw_fog_and_ambient_light_are_applied_in_order() {
    let mut corners = corners(0xFF64_6464, 0.0);
    // Eye z is -1: half of the fog.
    corners.iter_mut().for_each(|corner| corner.position[2] = -1.0);
    let far =
        Registers { eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -0.5, 0., 0., 0., 0., 1.], ..registers(0xC1) };

    let (shades, _) = picture(&[(far, corners)], &texels());

    // 100 of red by 255/255, of green by 128/255; then half way to (255, 0, 0).
    let right = [177.5, 25.098, 0.0, 255.0];
    assert!((0..4).all(|c| (shades[0].colour[c] - right[c]).abs() < 1.0e-3), "{shades:?}");
}

#[test]
fn draw_raw_perspective_bends_coordinates() {
    // w is 1 at the left, 3 at the right: half way on the screen is a quarter of the way.
    let eye_clip = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.25, 1., 0., 0., 0., 0.];
    let state = Registers { eye_clip, ..registers(0x15) };
    let corner = |x: f32, y: f32, w: f32, u: f32| Corner {
        position: [x * w, y * w, w],
        colour: u32::MAX,
        coordinates: [u, 0.5],
        ..Corner::default()
    };
    let corners = [corner(-1.5, 0.0, 1.0, 0.0), corner(6.5, 0.0, 3.0, 1.9), corner(-1.5, 99.0, 1.0, 0.0)];

    let (shades, _) = picture(&[(state, corners)], &texels());

    // At x = 2.5 (half way along the top, a little down) u is just under 1.9 / 4 = 0.475: still the first texel.
    assert_eq!(colours(&shades)[2][1], 255);
    // Affine it would be 0.95.
    let (affine, _) = picture(&[(Registers { effects: 0x11, ..state }, corners)], &texels());
    assert_eq!(colours(&affine)[2][0], 255);
}

#[test]
#[should_panic(expected = "nothing is clipped here")]
fn draw_raw_vertices_behind_the_eye_are_refused() {
    let mut corners = corners(0, 0.5);
    corners[0].position[2] = -0.5;
    let _ = picture(&[(registers(1), corners)], &texels());
}
