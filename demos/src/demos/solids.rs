//! Solids that run through each other. Nobody computes where they meet: the depth of each pixel decides it.

use glam::{DMat4, DVec3};

use super::palette::{AMBER, CORAL, DUSK, NIGHT, SKY, TEAL};
use super::{SIZE, shapes, turn};
use crate::scene::{Camera, Perspective, Scene};

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    scene.camera = Camera::Perspective(Perspective {
        eye: [2.4, 2.7, 6.4],
        target: [0.0, 0.05, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 42.0,
        near: 3.0,
        far: 18.0,
    });
    let angle = turn(frame);
    let turned = |axis: DVec3, angle: f64| DMat4::from_axis_angle(axis.normalize(), angle);
    let ring = shapes::closed_grid([96, 40], TEAL, |u, v| shapes::torus_point(1.5, 0.42, u, v));
    let bar = DVec3::new(2.05, 0.36, 0.36);
    scene.draw = vec![
        shapes::floor(-1.95, 8.0, DUSK, NIGHT),
        shapes::placed(shapes::sphere(1.02, 5, AMBER), DMat4::IDENTITY),
        shapes::placed(ring, turned(DVec3::new(1.0, 0.0, 0.35), 0.5 + angle)),
        shapes::placed(shapes::cuboid(bar, CORAL), turned(DVec3::new(0.2, 1.0, 0.3), 0.7 - angle)),
        shapes::placed(shapes::cuboid(bar, SKY), turned(DVec3::Z, 1.1) * turned(DVec3::X, 0.4 + 2.0 * angle)),
    ];
    scene
}
