//! A rippled sheet of some 60,000 triangles, most of them smaller than a few pixels, many smaller than one: nearly
//! every pixel has edges in it, and each triangle counts by the samples that it covers. Its stripes are no wider than two
//! triangles: what is inside the sheet is anti-aliased too.

use std::f64::consts::TAU;

use glam::DVec3;

use super::palette::{AMBER, NIGHT, SKY, TEAL, mix};
use super::{SIZE, shapes, smooth_scene, turn};
use crate::mesh::Mesh;
use crate::scene::{Camera, Colours, Perspective, Scene, SubpixelEdges};

/// Cells along each side, of two triangles each.
const CELLS: u32 = 174;
/// Half the side of the sheet, world units.
const HALF: f64 = 4.0;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = smooth_scene(SIZE, NIGHT);
    scene.card.antialias_edges = Some(SubpixelEdges::All);
    let camera = Camera::Perspective(Perspective {
        eye: [1.8, 5.2, 11.0],
        target: [0.0, -0.3, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 54.0,
        near: 5.0,
        far: 20.0,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    scene.draw.push(shapes::solid(sheet()));
    scene
}

/// Rings that spread from the middle and die away.
fn height(x: f64, z: f64) -> f64 {
    let from_middle = x.hypot(z);
    0.55 * (TAU * 0.62 * from_middle).cos() * (-0.32 * from_middle).exp() + 0.06 * (3.1 * x).sin() * (2.3 * z).cos()
}

fn sheet() -> Mesh {
    let mut mesh = shapes::open_grid([CELLS; 2], TEAL, |u, v| {
        let [x, z] = [u, v].map(|parameter| HALF * (2.0 * parameter - 1.0));
        DVec3::new(x, height(x, z), z)
    });
    // Low is blue, high is yellow, with bands a cell wide between, which one sample a pixel cannot keep apart.
    let shade = |(index, at): (u32, &[f32; 3])| {
        let level = (f64::from(at[1]) + 0.45) / 0.9;
        let colour = if level < 0.5 { mix(SKY, TEAL, 2.0 * level) } else { mix(TEAL, AMBER, 2.0 * level - 1.0) };
        let band = (index / (CELLS + 1)).is_multiple_of(2);
        mix(colour, NIGHT, if band { 0.45 } else { 0.0 })
    };
    mesh.colours = Colours::PerVertex((0..).zip(&mesh.positions).map(shade).collect());
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheet_has_sixty_thousand_triangles_and_its_front_is_above() {
        let mesh = sheet();
        assert_eq!(mesh.check(), Ok(()));
        assert!((60_000..62_000).contains(&mesh.triangles().count()));
        assert!(mesh.triangles().all(|corners| mesh.face_vector(corners).y > 0.0));
    }

    #[test]
    fn sheet_triangles_are_small_on_the_screen() {
        let (mesh, scene) = (sheet(), scene(0));
        let area = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|corner| {
                scene.camera.project(mesh.positions[corner as usize], scene.size).expect("before the viewer")
            });
            ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs() / 2.0
        };
        let areas: Vec<f64> = mesh.triangles().map(area).collect();
        let below = |most: f64| areas.iter().filter(|area| **area < most).count() as f64 / areas.len() as f64;
        assert!(below(1.0) > 0.15 && below(4.0) > 0.7, "{} {}", below(1.0), below(4.0));
        assert!(below(20.0) == 1.0);
    }
}
