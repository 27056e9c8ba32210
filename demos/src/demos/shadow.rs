//! Solids round a lamp, with the shadows that they cast on one another, on the floor and on the wall behind.
//!
//! The shadows are volumes: for each solid its faces that the lamp does not meet, the same faces far away from the lamp,
//! and a strip from each edge between a face in the dark and one in the light. They are drawn after the solids with
//! colours off, and count in the stencil plane where what is seen is nearer than they are: back faces up, front faces
//! down. A pixel that is not back at 0 lies in a shadow, wherever the eye stands, and the shadow bit darkens it.
//!
//! A volume begins a hair behind the solid, so that a solid does not shade itself face by face: where the light ends on
//! it is the lamp's business, which knows normals.

use std::collections::{HashMap, HashSet};

use glam::{DMat4, DVec3};

use super::palette::{AMBER, CORAL, PORCELAIN, TEAL, mix, oklch};
use super::{SIZE, looks, shapes, turn};
use crate::mesh::Mesh;
use crate::scene::{
    Camera, Colour, Colours, Draw, Lighting, Material, Perspective, Primitives, Scene, Shadow, Stencil, narrow, wide,
};

/// How far volumes reach from what casts them: beyond the floor and the wall, and not to the far plane.
const REACH: f64 = 40.0;
/// How far behind a solid its volume begins.
const HAIR: f64 = 0.012;
/// Height of the floor, and distance of the wall behind.
const FLOOR: f64 = -1.5;
const WALL: f64 = -5.5;
/// What is left of the light in shadow, of 255.
const INTENSITY: u8 = 92;
/// Columns in a half circle round the middle.
const COLUMNS: u32 = 7;

const NIGHT: Colour = [16, 18, 28, 255];
const LAMP: Colour = [255, 214, 160, 255];
/// Names of materials.
const GLAZE: &str = "glaze";
const STONE: &str = "stone";
const GLOW: &str = "glow";
const VOLUME: &str = "shadow volume";

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    scene.camera = Camera::Perspective(Perspective {
        eye: [2.6, 3.4, 9.6],
        target: [0.0, 0.1, -0.6],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 50.0,
        near: 1.0,
        far: 90.0,
    });
    let angle = turn(frame) + 0.55;
    let lamp = DVec3::new(1.9 * angle.cos(), 2.75, 0.4 + 1.5 * angle.sin());
    scene.ambient = [58, 64, 92, 255];
    scene.lights.push(looks::lamp(narrow(lamp), LAMP, 22.0));
    scene.lights.push(looks::sun([0.4, -0.5, -0.8], [38, 44, 66, 255]));
    looks::add(&mut scene, GLAZE, looks::glazed(Lighting::Pixel, 190, 52.0));
    looks::add(&mut scene, STONE, looks::dull(Lighting::Pixel));
    looks::add(&mut scene, GLOW, looks::unlit());
    let volume = Material { depth_write: false, stencil: Some(Stencil::shadow_volume()), ..looks::unlit() };
    looks::add(&mut scene, VOLUME, volume);
    scene.shadow = Some(Shadow { intensity: INTENSITY, ..Shadow::default() });

    scene.draw.push(floor());
    let wall = [[-16.0, 9.0], [16.0, 9.0], [16.0, FLOOR], [-16.0, FLOOR]].map(|[x, y]| DVec3::new(x, y, WALL));
    scene.draw.push(looks::quad(wall, [1.0; 2], mix(oklch(0.72, 0.035, 0.72), PORCELAIN, 0.25), STONE));
    let solids = solids(frame);
    for (mesh, material) in &solids {
        scene.draw.push(looks::of(shapes::solid(mesh.clone()), material));
    }
    let bulb = world(shapes::sphere(0.13, 3, mix(LAMP, [255; 4], 0.6)), DMat4::from_translation(lamp));
    scene.draw.push(looks::of(shapes::solid(bulb), GLOW));
    // After all that they may fall on.
    for (mesh, _) in &solids {
        scene.draw.push(Draw::Triangles(volume_of(mesh, lamp)));
    }
    scene
}

/// What casts shadows, where it stands in the world, with the name of its material.
fn solids(frame: u32) -> Vec<(Mesh, &'static str)> {
    let spin = turn(frame);
    let knot = shapes::closed_grid([240, 18], CORAL, |u, v| shapes::knot_point(0.72, 0.2, u, v));
    let knot_place = DMat4::from_translation(DVec3::new(0.0, 0.55, 0.0)) * DMat4::from_rotation_y(spin + 0.4);
    let ring = shapes::closed_grid([96, 24], TEAL, |u, v| shapes::torus_point(0.78, 0.2, u, v));
    let lean = DMat4::from_translation(DVec3::new(-2.55, FLOOR + 0.97, 1.35))
        * DMat4::from_rotation_y(0.5)
        * DMat4::from_rotation_x(1.35);
    let ball = shapes::sphere(0.62, 4, AMBER);
    let ball_place = DMat4::from_translation(DVec3::new(2.35, FLOOR + 0.62, 1.75));
    let plinth = looks::block(DVec3::new(0.62, 0.32, 0.62), PORCELAIN);
    let plinth_place = DMat4::from_translation(DVec3::new(0.0, FLOOR + 0.32, 0.0));
    let mut solids = vec![
        (world(knot, knot_place), GLAZE),
        (world(ring, lean), GLAZE),
        (world(ball, ball_place), GLAZE),
        (world(plinth, plinth_place), STONE),
    ];
    for column in 0..COLUMNS {
        let part = f64::from(column) / f64::from(COLUMNS - 1);
        let (sine, cosine) = (std::f64::consts::PI * part).sin_cos();
        let height = 0.85 + 0.55 * (1.0 - (2.0 * part - 1.0).powi(2));
        let block = looks::block(DVec3::new(0.16, height, 0.16), oklch(0.74, 0.09, 0.55 + 0.3 * part));
        let place = DMat4::from_translation(DVec3::new(-4.1 * cosine, FLOOR + height, -0.4 - 3.1 * sine))
            * DMat4::from_rotation_y(0.9 * part);
        solids.push((world(block, place), STONE));
    }
    solids
}

/// A floor of light and dark stones.
fn floor() -> Draw {
    const STONES: i32 = 14;
    let (mut vertices, mut colours, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (x, z) in (-STONES..STONES).flat_map(|z| (-STONES..STONES).map(move |x| (x, z))) {
        let first = vertices.len() as u32;
        let even = (x + z).rem_euclid(2) == 0;
        for (dx, dz) in [(0, 0), (0, 1), (1, 1), (1, 0)] {
            let at = DVec3::new(1.1 * f64::from(x + dx), FLOOR, 1.1 * f64::from(z + dz));
            vertices.push(narrow(at));
            colours.push(if even { [206, 200, 190, 255] } else { [150, 146, 148, 255] });
        }
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    let normals = Some(vec![[0.0, 1.0, 0.0]; vertices.len()]);
    let (indices, colours, material) = (Some(indices), Colours::PerVertex(colours), Some(STONE.to_owned()));
    Draw::Triangles(Primitives { vertices, indices, colours, normals, material, ..Default::default() })
}

/// A mesh whose positions are those of the world.
fn world(mut mesh: Mesh, place: DMat4) -> Mesh {
    for position in &mut mesh.positions {
        *position = narrow(place.transform_point3(wide(*position)));
    }
    for normal in mesh.normals.iter_mut().flatten() {
        *normal = narrow(place.transform_vector3(wide(*normal)).normalize_or(DVec3::Y));
    }
    mesh
}

/// The shadow volume of a closed mesh whose faces look outwards: closed too, its faces look outwards too.
fn volume_of(mesh: &Mesh, lamp: DVec3) -> Primitives {
    // Corners of different faces at one place are one corner.
    let mut known = HashMap::new();
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut corner = |index: u32| {
        let position = mesh.positions[index as usize];
        *known.entry(position.map(|coordinate| (coordinate + 0.0).to_bits())).or_insert_with(|| {
            corners.push(position);
            corners.len() as u32 - 1
        })
    };
    let faces: Vec<[u32; 3]> = mesh.triangles().map(|face| face.map(&mut corner)).collect();
    let place = |index: u32| wide(corners[index as usize]);
    let is_lit = |[a, b, c]: [u32; 3]| {
        let normal = (place(b) - place(a)).cross(place(c) - place(a));
        normal.dot(lamp - place(a)) > 0.0
    };
    let dark: Vec<[u32; 3]> = faces.into_iter().filter(|face| !is_lit(*face)).collect();
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let in_the_dark: HashSet<[u32; 2]> = dark.iter().flat_map(|face| edges(*face)).collect();

    let count = corners.len() as u32;
    let behind = |distance: f64| {
        corners.iter().map(move |corner| {
            let corner = wide(*corner);
            narrow(corner + distance * (corner - lamp).normalize_or(DVec3::NEG_Y))
        })
    };
    let vertices: Vec<[f32; 3]> = behind(HAIR).chain(behind(REACH)).collect();
    let mut indices = Vec::new();
    for face in &dark {
        let [a, b, c] = *face;
        indices.extend([a, c, b]);
        indices.extend([a, b, c].map(|corner| count + corner));
        for [from, to] in edges(*face).into_iter().filter(|[from, to]| !in_the_dark.contains(&[*to, *from])) {
            indices.extend([count + to, count + from, from, count + to, from, to]);
        }
    }
    let (indices, material) = (Some(indices), Some(VOLUME.to_owned()));
    Primitives { vertices, indices, material, ..Default::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directed edges of triangles, and how often each is there.
    fn edges(triangles: impl Iterator<Item = [[u32; 3]; 3]>) -> HashMap<[[u32; 3]; 2], i32> {
        let mut edges = HashMap::new();
        for [a, b, c] in triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        edges
    }

    fn assert_closed(triangles: impl Iterator<Item = [[u32; 3]; 3]>, what: &str) {
        let edges = edges(triangles);
        assert!(edges.len() > 6, "{what}");
        for (&[from, to], count) in &edges {
            assert_eq!(edges.get(&[to, from]), Some(count), "{what}");
        }
    }

    fn bits(position: [f32; 3]) -> [u32; 3] {
        position.map(|coordinate| (coordinate + 0.0).to_bits())
    }

    #[test]
    fn solids_and_their_volumes_are_closed() {
        for frame in [0, 50] {
            let lamp = DVec3::new(1.0, 2.8, 0.5);
            for (mesh, _) in solids(frame) {
                let faces = mesh.triangles().map(|face| face.map(|index| bits(mesh.positions[index as usize])));
                assert_closed(faces, &mesh.name);
                let volume = volume_of(&mesh, lamp);
                let indices = volume.indices.expect("indices");
                let faces = indices.as_chunks::<3>().0.iter();
                assert_closed(faces.map(|face| face.map(|index| bits(volume.vertices[index as usize]))), &mesh.name);
            }
        }
    }

    #[test]
    fn volume_of_a_block_below_the_lamp_holds_what_lies_under_it_and_not_what_stands_beside() {
        let block = looks::block(DVec3::splat(0.5), [255; 4]);
        let volume = volume_of(&block, DVec3::new(0.0, 2.0, 0.0));
        let indices = volume.indices.expect("indices");
        let at = |index: u32| wide(volume.vertices[index as usize]);
        // Signed solid angles, in parts of a sphere: 1 inside a closed surface that looks outwards, 0 outside.
        let round = |point: DVec3| {
            let angle = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|index| at(index) - point);
                let above = a.dot(b.cross(c));
                let below = a.length() * b.length() * c.length()
                    + a.dot(b) * c.length()
                    + b.dot(c) * a.length()
                    + c.dot(a) * b.length();
                2.0 * above.atan2(below)
            };
            indices.as_chunks::<3>().0.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
        };
        for (point, inside) in [
            ([0.0, -3.0, 0.0], 1.0),
            ([0.9, -1.5, 0.3], 1.0),
            ([3.0, -1.5, 0.0], 0.0),
            ([0.0; 3], 0.0),
            ([0.0, 1.0, 0.0], 0.0),
        ] {
            assert!((round(DVec3::from(point)) - inside).abs() < 1e-6, "{point:?}: {}", round(DVec3::from(point)));
        }
    }

    #[test]
    fn scene_draws_volumes_last_without_colours_or_depths() {
        let scene = scene(0);
        let batches = scene.batches();
        let volumes = batches.iter().filter(|batch| batch.material.stencil.is_some()).count();
        assert_eq!(volumes, 4 + COLUMNS as usize);
        let last = &batches[batches.len() - volumes..];
        assert!(last.iter().all(|batch| batch.material.stencil.is_some_and(|stencil| !stencil.colours)));
        assert!(last.iter().all(|batch| !batch.material.depth_write && !batch.translucent));
        assert!(scene.shadow.is_some_and(|shadow| shadow.intensity == INTENSITY));
    }
}
