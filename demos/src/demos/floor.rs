//! One paved floor to the horizon, read in three ways: nearest texel, four texels, and eight of two levels of a MIP map.
//!
//! Far away a pixel covers many texels. What takes one or four of them shimmers; what takes a level in which they are
//! averaged already does not. Near the viewer, nearest texels show their corners. The strips part along planes through
//! the eye, so that each of them reaches from the viewer to the horizon.

use glam::DVec3;

use super::palette::{AMBER, MIST, NIGHT, PORCELAIN, SKY, mix};
use super::{SIZE, looks, overlay, pictures};
use crate::scene::{
    Camera, Colour, Colours, Draw, Material, Perspective, Primitives, Scene, Texture, TextureFilter, narrow,
};

/// Frames in which the viewer walks over one picture of the texture.
pub(super) const FRAMES: u32 = 120;

/// Height of the eye, where the floor begins and ends before it, and the side of one picture; world units.
const EYE: f64 = 1.0;
const NEAR: f64 = 0.8;
const FAR: f64 = 600.0;
const PICTURE: f64 = 2.0;
/// Half the width of the picture at distance 1.
const HALF: f64 = 0.7;
/// How far the eye looks below the horizon.
const DROP: f64 = 0.26;

/// Names of the strips' materials and captions.
const STRIPS: [(&str, TextureFilter); 3] = [
    ("nearest", TextureFilter::Nearest),
    ("bilinear", TextureFilter::Bilinear),
    ("trilinear", TextureFilter::Trilinear),
];

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let fov = 2.0 * HALF.atan().to_degrees();
    scene.camera = Camera::Perspective(Perspective {
        eye: [0.0, EYE as f32, 0.0],
        target: [0.0, (EYE - DROP) as f32, -1.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: fov as f32,
        near: 0.25,
        far: 2.0 * FAR as f32,
    });
    let walked = f64::from(frame) / f64::from(FRAMES);
    scene.draw.push(sky());
    for (strip, (name, filter)) in STRIPS.into_iter().enumerate() {
        let texture = looks::repeated(&pictures::TILES, filter);
        looks::add(&mut scene, name, Material { texture: Some(Texture { ..texture }), ..looks::unlit() });
        // The last one goes on past the picture's edge, as the first does, whatever the picture's form.
        let edge = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
        scene.draw.push(floor([edge[strip], edge[strip + 1]], walked, name));
    }
    let [columns, rows] = SIZE.map(f64::from);
    for border in [1.0, 2.0] {
        overlay::plate(&mut scene, [columns * border / 3.0 - 1.0, 0.0, 2.0, rows], mix(NIGHT, MIST, 0.25));
    }
    for (strip, (name, _)) in (0_u32..).zip(STRIPS) {
        let middle = columns * (f64::from(strip) + 0.5) / 3.0;
        overlay::caption(&mut scene, [middle, 24.0], AMBER, name);
    }
    let notes = ["one texel", "four texels", "eight texels"];
    for (strip, note) in (0_u32..).zip(notes) {
        let middle = columns * (f64::from(strip) + 0.5) / 3.0;
        overlay::caption(&mut scene, [middle, 48.0], PORCELAIN, note);
    }
    scene
}

/// The part of the floor between two planes through the eye, given by how far aside they are as parts of half the
/// picture's width.
fn floor(sides: [f64; 2], walked: f64, material: &str) -> Draw {
    // A plane through the eye and a vertical of the picture meets the floor in a line. Seen with a lowered gaze, the
    // point at distance z before the foot has the depth z cos + EYE sin, and lies so far aside.
    let (sine, cosine) = (DROP / DROP.hypot(1.0), 1.0 / DROP.hypot(1.0));
    let corner = |side: f64, z: f64| DVec3::new(side * HALF * (z * cosine + EYE * sine), 0.0, -z);
    let corners = [corner(sides[0], FAR), corner(sides[1], FAR), corner(sides[1], NEAR), corner(sides[0], NEAR)];
    let coordinates = corners.map(|point| [(point.x / PICTURE) as f32, (point.z / PICTURE - walked) as f32]);
    Draw::Triangles(Primitives {
        vertices: corners.map(narrow).to_vec(),
        indices: Some(vec![0, 3, 1, 1, 3, 2]),
        texture_coordinates: Some(coordinates.to_vec()),
        material: Some(material.to_owned()),
        ..Default::default()
    })
}

/// A wall past the end of the floor that fades upwards.
fn sky() -> Draw {
    let height = [-0.05, 0.1, 0.45].map(|part| EYE + part * 2.0 * FAR);
    let shades: [Colour; 3] = [mix(SKY, PORCELAIN, 0.55), mix(SKY, PORCELAIN, 0.2), mix(SKY, NIGHT, 0.5)];
    let distance = -1.9 * FAR;
    let (mut vertices, mut colours) = (Vec::new(), Vec::new());
    for (y, shade) in height.into_iter().zip(shades) {
        vertices.extend([-1.0, 1.0].map(|side| narrow(DVec3::new(side * 2.0 * FAR, y, distance))));
        colours.extend([shade; 2]);
    }
    let indices = Some(vec![0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5]);
    Draw::Triangles(Primitives { vertices, indices, colours: Colours::PerVertex(colours), ..Default::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_strips_are_thirds_of_the_picture_from_the_bottom_to_the_horizon() {
        let scene = scene(0);
        for (strip, batch) in (0_u32..).zip(&scene.batches()[1..4]) {
            let seen: Vec<[f64; 3]> =
                batch.positions.iter().filter_map(|point| scene.camera.project(*point, SIZE)).collect();
            let [left, right] = [0.0, 1.0].map(|side| (f64::from(strip) + side) * 800.0 / 3.0);
            // Single precision keeps the corners within a hundredth of a pixel of the planes.
            for (corner, expected) in seen.iter().zip([left, right, right, left]) {
                assert!((corner[0] - expected).abs() < 0.01, "{corner:?}");
            }
            let horizon = 300.0 - DROP * 400.0 / HALF;
            assert!((seen[0][1] - horizon).abs() < 1.5, "the far end is the horizon: {seen:?}");
            assert!(seen[2][1] > 600.0, "the near end lies below the picture: {seen:?}");
            let texture = batch.material.texture.as_ref().expect("textured");
            assert_eq!((texture.filter, texture.mip_map), (STRIPS[strip as usize].1, strip == 2));
        }
    }

    #[test]
    fn floor_after_a_whole_walk_is_the_same_picture() {
        let Draw::Triangles(before) = floor([0.0, 1.0], 0.0, "") else { panic!("triangles") };
        let Draw::Triangles(after) = floor([0.0, 1.0], 1.0, "") else { panic!("triangles") };
        let pairs =
            before.texture_coordinates.into_iter().flatten().zip(after.texture_coordinates.into_iter().flatten());
        for (before, after) in pairs {
            assert_eq!(before[0], after[0]);
            // The coordinates go up to 300, where single precision has steps of 3e-5.
            assert!((before[1] - after[1] - 1.0).abs() < 1e-4);
        }
    }
}
