//! A knot drawn as lines, with the hidden ones removed: its faces have nearly the background's colour and hide what
//! lies behind them, and the lines are decals, so that their own faces do not hide them.

use glam::DVec3;

use super::palette::{NIGHT, hue, mix};
use super::{SIZE, shapes, turn};
use crate::scene::{Camera, Colours, Draw, Perspective, Primitives, Scene};

const CELLS: [u32; 2] = [144, 16];

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let camera = Camera::Perspective(Perspective {
        eye: [1.3, -1.7, 5.4],
        target: [0.0, -0.06, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 42.0,
        near: 2.0,
        far: 10.0,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    let mesh =
        shapes::closed_grid(CELLS, mix(NIGHT, [90, 104, 150, 255], 0.3), |u, v| shapes::knot_point(1.0, 0.27, u, v));
    let vertex = |i: u32, j: u32| (i % CELLS[0]) * CELLS[1] + j % CELLS[1];
    let all = || (0..CELLS[0]).flat_map(|i| (0..CELLS[1]).map(move |j| (i, j)));
    let indices = all().flat_map(|(i, j)| [vertex(i, j), vertex(i + 1, j), vertex(i, j), vertex(i, j + 1)]);
    // The hue follows the knot; what points down is darker.
    let shade = |(index, normal): (usize, &[f32; 3])| {
        let along = f64::from(index as u32 / CELLS[1]) / f64::from(CELLS[0]);
        let light = 0.62 + 0.38 * crate::scene::wide(*normal).dot(DVec3::new(0.0, 0.8, 0.6));
        mix(NIGHT, hue(along), light)
    };
    let colours = mesh.normals.iter().flatten().enumerate().map(shade).collect();
    let lines = Draw::Lines(Primitives {
        vertices: mesh.positions.clone(),
        indices: Some(indices.collect()),
        colours: Colours::PerVertex(colours),
        ..Default::default()
    });
    scene.draw = vec![shapes::solid(mesh), shapes::decal(vec![lines])];
    scene
}
