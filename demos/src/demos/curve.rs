//! A bicubic Bézier patch, its curves of constant parameter as decals, and its control net.
//!
//! The curves go to the scene as control points, exactly those of the patch; they are cut into chords for the size
//! at which they are seen, while the patch is cut into fixed triangles. So lines and triangles agree only nearly, as
//! in any modeller, and the decal keeps the lines in sight.

use glam::DVec3;

use super::palette::{AMBER, DUSK, MIST, NIGHT, PORCELAIN, SKY, TEAL, mix};
use super::{SIZE, shapes, turn};
use crate::mesh::Mesh;
use crate::scene::{Camera, Colour, Colours, Curve, CurveKind, Draw, Perspective, Primitives, Scene, narrow};

/// Heights of the control points.
const HEIGHTS: [[f64; 4]; 4] =
    [[0.0, 1.1, -1.0, 0.4], [1.0, 1.9, -0.5, -1.0], [-0.8, 0.2, 1.7, 0.4], [0.2, -1.0, 0.7, 0.9]];
const CELLS: u32 = 40;
const CURVES: u32 = 10;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let camera = Camera::Perspective(Perspective {
        eye: [4.2, 4.0, 7.6],
        target: [0.0, 0.1, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 40.0,
        near: 3.0,
        far: 18.0,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    let mut inner = Vec::new();
    let mut border = Vec::new();
    for curve in 0..=CURVES {
        let t = f64::from(curve) / f64::from(CURVES);
        for along_u in [true, false] {
            let on_border = curve == 0 || curve == CURVES;
            if on_border { &mut border } else { &mut inner }.extend(iso_curve(t, along_u));
        }
    }
    scene.draw = vec![
        shapes::floor(-1.6, 7.0, DUSK, NIGHT),
        shapes::solid(patch()),
        shapes::decal(vec![cubic(inner, mix(TEAL, PORCELAIN, 0.75)), cubic(border, AMBER)]),
        shapes::lines(net(), mix(NIGHT, MIST, 0.8)),
        Draw::Points(Primitives {
            vertices: (0..16).map(|index| narrow(control(index / 4, index % 4))).collect(),
            colours: Colours::One(SKY),
            ..Default::default()
        }),
    ];
    scene
}

fn cubic(points: Vec<[f32; 3]>, colour: Colour) -> Draw {
    Draw::Curve(Curve {
        kind: CurveKind::Cubic,
        points,
        colours: Colours::One(colour),
        tolerance: 0.1,
        width: None,
        material: None,
        tag: None,
    })
}

fn control(i: usize, j: usize) -> DVec3 {
    DVec3::new(-2.1 + 1.4 * i as f64, HEIGHTS[i][j], -2.1 + 1.4 * j as f64)
}

fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// The control points of the curve at constant v (along u) or constant u.
fn iso_curve(t: f64, along_u: bool) -> [[f32; 3]; 4] {
    let of = |i: usize, j: usize| if along_u { control(i, j) } else { control(j, i) };
    std::array::from_fn(|i| narrow(weights(t).iter().enumerate().map(|(j, w)| of(i, j) * *w).sum()))
}

fn patch() -> Mesh {
    let point = |u: f64, v: f64| -> DVec3 {
        let (along, across) = (weights(u), weights(v));
        (0..16).map(|index| control(index / 4, index % 4) * along[index / 4] * across[index % 4]).sum()
    };
    shapes::open_grid([CELLS; 2], TEAL, point)
}

fn net() -> Vec<[f32; 3]> {
    let row = |i: usize| [0, 1, 2, 3].map(|j| narrow(control(i, j)));
    let column = |j: usize| [0, 1, 2, 3].map(|i| narrow(control(i, j)));
    (0..4).flat_map(|k| [row(k), column(k)]).flat_map(|points| shapes::pieces(&points, false)).collect()
}
