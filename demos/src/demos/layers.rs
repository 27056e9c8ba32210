//! A stack of three hundred translucent discs, each so faint that a single one is hardly seen, with a ball in the
//! middle and a bar through it, which hide those behind them.
//!
//! The discs are drawn in an order that has nothing to do with their depths and are tilted so that neighbours cross:
//! the unit sorts them for each sample. Behind all of them little of the background is left; in 8 bits a layer would be
//! rounded away.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::palette::{CORAL, NIGHT, PORCELAIN, oklch};
use super::{SIZE, shapes, smooth_scene, turn};
use crate::scene::{Blend, Camera, Colours, Draw, Material, Orthographic, Primitives, Scene, SubpixelGrid, narrow};

/// Discs of the stack.
const LAYERS: u32 = 300;
/// Steps from a disc to the next one drawn; it shares no factor with [`LAYERS`], so each is drawn once.
const STRIDE: u32 = 77;
/// Sides of a disc.
const SIDES: u32 = 20;
/// Least and greatest alpha of a disc, of 255.
const ALPHAS: [u8; 2] = [1, 3];
/// Length of the stack and radius of a disc, world units.
const LENGTH: f64 = 2.0;
const RADIUS: f64 = 0.8;
/// Name of the discs' material.
const GLASS: &str = "glass";

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = smooth_scene(SIZE, NIGHT);
    // The unit orders the layers of each sample, and edges so faint do not need more samples.
    scene.card.antialias = Some(SubpixelGrid::Grid4x4);
    let camera = Camera::Orthographic(Orthographic {
        eye: [0.0, 1.6, 5.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        width: 7.2,
        near: 2.0,
        far: 8.5,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    scene.materials = BTreeMap::from([(GLASS.to_owned(), Material { blend: Blend::Alpha, ..Material::default() })]);
    let tilt = DMat4::from_axis_angle(DVec3::new(0.5, 1.0, 0.0).normalize(), 0.75);
    scene.draw = vec![
        Draw::Triangles(discs()),
        shapes::placed(shapes::sphere(0.38, 4, PORCELAIN), DMat4::IDENTITY),
        shapes::placed(shapes::cuboid(DVec3::new(1.25, 0.06, 0.06), CORAL), tilt),
    ];
    scene
}

/// The discs round the z axis, from the back to the front by place, in another order by command.
fn discs() -> Primitives {
    let (mut vertices, mut colours, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for command in 0..LAYERS {
        let layer = command * STRIDE % LAYERS;
        let part = (f64::from(layer) + 0.5) / f64::from(LAYERS);
        // Steps by the golden section: no two tilts are the same.
        let (sine, cosine) = (TAU * f64::from(layer) * 0.618_034).sin_cos();
        let normal = DVec3::new(0.16 * cosine, 0.16 * sine, 1.0).normalize();
        let across = normal.cross(DVec3::Y).normalize();
        let up = across.cross(normal);
        let centre = DVec3::new(0.24 * cosine, 0.24 * sine, LENGTH * (part - 0.5));
        let [red, green, blue, _] = oklch(0.8, 0.15, part * 0.85);
        let alpha = ALPHAS[0] + (layer % u32::from(1 + ALPHAS[1] - ALPHAS[0])) as u8;
        let first = vertices.len() as u32;
        for side in 0..SIDES {
            let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            vertices.push(narrow(centre + RADIUS * (cosine * across + sine * up)));
            colours.push([red, green, blue, alpha]);
        }
        indices.extend((1..SIDES - 1).flat_map(|side| [first, first + side, first + side + 1]));
    }
    Primitives {
        vertices,
        indices: Some(indices),
        colours: Colours::PerVertex(colours),
        material: Some(GLASS.to_owned()),
        ..Default::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Topology;

    #[test]
    fn discs_are_faint_and_each_is_drawn_once_out_of_order() {
        let found = discs();
        let discs = found.vertices.as_chunks::<{ SIDES as usize }>().0;
        assert_eq!(discs.len(), LAYERS as usize);
        let middle = |disc: &[[f32; 3]; SIDES as usize]| disc.iter().map(|at| at[2]).sum::<f32>() / SIDES as f32;
        let places: Vec<f32> = discs.iter().map(middle).collect();
        let mut sorted = places.clone();
        sorted.sort_by(f32::total_cmp);
        assert!(places != sorted);
        let step = (LENGTH / f64::from(LAYERS)) as f32;
        assert!(sorted.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 0.2 * step));
        let Colours::PerVertex(colours) = found.colours else { panic!("a colour for each vertex") };
        assert!(colours.iter().all(|colour| (ALPHAS[0]..=ALPHAS[1]).contains(&colour[3])));
    }

    #[test]
    fn scene_layers_cover_a_part_of_the_picture_only_and_cross() {
        let scene = scene(0);
        let batches = scene.batches();
        assert_eq!(batches.iter().map(|batch| batch.translucent).collect::<Vec<_>>(), [true, false, false]);
        assert_eq!(batches[0].topology, Topology::Triangles);
        let on_screen: Vec<[f64; 3]> =
            batches[0].positions.iter().filter_map(|at| scene.camera.project(*at, scene.size)).collect();
        for axis in 0..2 {
            let of = || on_screen.iter().map(|at| at[axis]);
            let extent = of().fold(f64::MIN, f64::max) - of().fold(f64::MAX, f64::min);
            assert!((180.0..330.0).contains(&extent), "{extent} pixels");
        }
        assert!(on_screen.iter().all(|at| (0.0..=1.0).contains(&at[2])));
        // A disc reaches far past its neighbours in depth, so that they cross.
        let first: Vec<f64> = on_screen[..SIDES as usize].iter().map(|at| at[2]).collect();
        let reach = first.iter().copied().fold(f64::MIN, f64::max) - first.iter().copied().fold(f64::MAX, f64::min);
        assert!(reach > 10.0 * LENGTH / f64::from(LAYERS) / 6.5, "{reach}");
    }
}
