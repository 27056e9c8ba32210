//! Points spread evenly over a torus, and a dark torus just inside them that hides those on the far side.

use std::f64::consts::TAU;

use super::palette::{NIGHT, hue, mix};
use super::{SIZE, shapes, turn};
use crate::scene::{Camera, Colours, Draw, Perspective, Primitives, Scene, narrow};

const COUNT: u32 = 44000;
const LARGE: f64 = 1.6;
const SMALL: f64 = 0.72;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    scene.camera = Camera::Perspective(Perspective {
        eye: [0.0, 4.1, 5.6],
        target: [0.0, -0.1, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 44.0,
        near: 2.0,
        far: 12.0,
    });
    let body = shapes::closed_grid([96, 40], mix(NIGHT, [90, 104, 150, 255], 0.1), |u, v| {
        shapes::torus_point(LARGE, SMALL - 0.02, u, v)
    });
    let mut vertices = Vec::new();
    let mut colours = Vec::new();
    // Steps by the golden section never line up.
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    for index in 0..COUNT {
        let v = (f64::from(index) + 0.5) / f64::from(COUNT);
        // The outside of a torus has more room than the inside: v is bent so that points are equally dense.
        let v = evenly(v);
        let u = f64::from(index) * golden % 1.0;
        vertices.push(narrow(shapes::torus_point(LARGE, SMALL, u + turn(frame) / TAU / 6.0, v)));
        let bands = 0.5 + 0.5 * (TAU * (3.0 * u + 2.0 * v)).cos();
        colours.push(mix(NIGHT, hue(u + 0.3 * v), 0.35 + 0.65 * bands));
    }
    let cloud = Primitives { vertices, colours: Colours::PerVertex(colours), ..Default::default() };
    scene.draw = vec![shapes::solid(body), Draw::Points(cloud)];
    scene
}

/// The v below which the part `share` of the torus's area lies: area grows as v + small / (TAU large) sin(TAU v).
fn evenly(share: f64) -> f64 {
    let ratio = SMALL / LARGE;
    (0..30).fold(share, |v, _| {
        let area = v + ratio / TAU * (TAU * v).sin();
        v - (area - share) / (1.0 + ratio * (TAU * v).cos())
    })
}
