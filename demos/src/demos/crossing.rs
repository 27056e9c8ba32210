//! Surfaces that run through each other, so that no edge but the seam of two depths crosses a pixel: a cone through a
//! sphere, a rosette of planes through one point, and a rippled sheet through a level one.
//!
//! Which of two fragments is seen is decided for each sample. Where each covers all of a pixel, only the depths tell
//! that the pixel needs both.

use std::f64::consts::TAU;

use glam::{DMat4, DQuat, DVec3};

use super::palette::{AMBER, CORAL, DUSK, MIST, NIGHT, SKY, TEAL, hue, mix};
use super::{SIZE, shapes, smooth_scene, turn};
use crate::mesh::Mesh;
use crate::scene::{Camera, Colour, Colours, Draw, Perspective, Primitives, Scene, narrow};

/// Planes of the rosette.
const PLANES: u32 = 9;
/// Where the level sheet lies, and how far the rippled one goes above and below.
const LEVEL: f64 = -1.35;
const RIPPLE: f64 = 0.05;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = smooth_scene(SIZE, NIGHT);
    scene.camera = Camera::Perspective(Perspective {
        eye: [0.0, 1.9, 7.2],
        target: [0.0, -0.25, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 44.0,
        near: 3.0,
        far: 14.0,
    });
    let angle = turn(frame);
    let left = DMat4::from_translation(DVec3::new(-1.3, 0.1, 0.0));
    let tilt = DMat4::from_axis_angle(DVec3::new(0.3, 0.2, 1.0).normalize(), 0.9);
    let turned = left * DMat4::from_rotation_y(angle);
    scene.draw = vec![
        sheet(DUSK, |_, _| 0.0),
        sheet(mix(SKY, NIGHT, 0.25), |x, z| RIPPLE * (TAU * (1.1 * x + 0.4 * z)).sin() * (TAU * 0.9 * z).cos()),
        shapes::placed(shapes::sphere(0.9, 5, AMBER), left),
        shapes::placed(cone(0.8, 2.6, TEAL), turned * tilt),
        shapes::placed(shapes::cuboid(DVec3::new(1.3, 0.16, 0.16), CORAL), turned * DMat4::from_rotation_z(-0.5)),
        rosette(DVec3::new(1.55, 0.05, 0.0), 1.0, angle),
    ];
    scene
}

/// A sheet of the floor's size, at the floor's level and what `height` adds to it.
fn sheet(colour: Colour, height: impl Fn(f64, f64) -> f64) -> Draw {
    shapes::solid(shapes::open_grid([120, 80], colour, |u, v| {
        let [x, z] = [3.6 * (2.0 * u - 1.0), 2.6 * (2.0 * v - 1.0)];
        DVec3::new(x, LEVEL + height(x, z), z)
    }))
}

/// A closed cone along the x axis, its middle in the origin.
fn cone(radius: f64, length: f64, colour: Colour) -> Mesh {
    const SIDES: u32 = 96;
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for side in 0..SIDES {
        let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
        let rim = DVec3::new(-length / 2.0, radius * cosine, radius * sine);
        let outwards = DVec3::new(radius, length * cosine, length * sine).normalize();
        // Its tip has a vertex for each side, since each has a normal of its own.
        for (position, normal) in [
            (DVec3::X * (length / 2.0), outwards),
            (rim, outwards),
            (rim, DVec3::NEG_X),
            (DVec3::NEG_X * (length / 2.0), DVec3::NEG_X),
        ] {
            positions.push(narrow(position));
            normals.push(narrow(normal));
        }
        let [a, b] = [4 * side, 4 * ((side + 1) % SIDES)];
        indices.extend([a, a + 1, b + 1, a + 3, b + 2, a + 2]);
    }
    let mut mesh = Mesh::new("cone", positions, indices, colour);
    mesh.normals = Some(normals);
    mesh
}

/// Squares through one point, each tilted away from the viewer in another direction.
fn rosette(centre: DVec3, half: f64, angle: f64) -> Draw {
    const TILT: f64 = 0.5;
    let (mut vertices, mut colours) = (Vec::new(), Vec::new());
    for plane in 0..PLANES {
        let part = f64::from(plane) / f64::from(PLANES);
        let (sine, cosine) = (TAU * part + angle).sin_cos();
        let turn = DQuat::from_axis_angle(DVec3::new(cosine, sine, 0.0), TILT);
        let corner = |x: f64, y: f64| narrow(centre + turn * DVec3::new(x * half, y * half, 0.0));
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        vertices.extend([a, b, c, a, c, d]);
        colours.extend([mix(hue(part), MIST, 0.15), mix(hue(part), NIGHT, 0.2)]);
    }
    Draw::Triangles(Primitives { vertices, colours: Colours::PerFace(colours), ..Default::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::wide;

    #[test]
    fn cone_faces_and_normals_are_outwards() {
        let mesh = cone(1.0, 3.0, [255; 4]);
        assert_eq!(mesh.check(), Ok(()));
        let normals = mesh.normals.as_ref().expect("normals");
        for corners in mesh.triangles() {
            assert!(mesh.face_vector(corners).dot(wide(normals[corners[1] as usize])) > 0.0);
        }
        let volume: f64 = mesh.triangles().map(|corners| mesh.face_vector(corners).dot(mesh.corner(corners[0]))).sum();
        assert!((volume / 6.0 - TAU / 2.0).abs() < 0.01, "a third of base times height: {}", volume / 6.0);
    }

    #[test]
    fn rosette_planes_cross_in_the_middle_and_stand_apart_at_the_rim() {
        let Draw::Triangles(found) = rosette(DVec3::ZERO, 1.0, 0.3) else { panic!("triangles") };
        let squares = found.vertices.as_chunks::<6>().0;
        let middles = squares.iter().map(|square| (wide(square[0]) + wide(square[2])) / 2.0);
        assert!(middles.into_iter().all(|middle| middle.length() < 1e-6));
        let normal = |square: &[[f32; 3]; 6]| {
            (wide(square[1]) - wide(square[0])).cross(wide(square[2]) - wide(square[0])).normalize()
        };
        let normals: Vec<DVec3> = squares.iter().map(normal).collect();
        for (place, one) in normals.iter().enumerate() {
            assert!(normals[..place].iter().all(|other| one.angle_between(*other) > 0.2));
        }
    }

    #[test]
    fn sheets_cross_many_times() {
        let Scene { draw, .. } = scene(0);
        let heights: Vec<f32> = match &draw[1] {
            Draw::Mesh(sheet) => sheet.mesh.iter().flat_map(|mesh| mesh.positions.iter().map(|at| at[1])).collect(),
            _ => Vec::new(),
        };
        let above = heights.iter().map(|y| f64::from(*y) > LEVEL);
        let crossings = above.clone().zip(above.skip(1)).filter(|(one, next)| one != next).count();
        assert!(crossings > 500, "{crossings}");
    }
}
