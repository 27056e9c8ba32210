//! Two teapots under the same lights: on the left worked out at each vertex, on the right at each pixel.
//!
//! A dim sun, a lamp that goes round and a spot. At vertices the spot's edge follows the triangles of the floor and
//! highlights come and go with the vertices of the pot; at pixels both are round.

use glam::{DMat4, DVec3};

use super::palette::{MIST, NIGHT, PORCELAIN, mix};
use super::{SIZE, looks, overlay, shapes, turn};
use crate::scene::{Camera, Colour, Draw, FogFunction, Lighting, Material, MeshDraw, Perspective, Scene, narrow};
use crate::teapot::Teapot;

/// Cells along each side of a patch: few, so that there is something to see.
const LEVEL: u32 = 5;
/// Where a pot stands from the middle, and its size.
const ASIDE: f64 = 2.45;
const SCALE: f64 = 0.6;
/// Cells of each half of the floor.
const CELLS: [u32; 2] = [16, 24];

const SPOT: Colour = [64, 226, 206, 255];
const LAMP: Colour = [255, 172, 84, 255];
const SUN: Colour = [70, 78, 132, 255];
/// The lamp itself.
const GLOW: &str = "glow";

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    scene.camera = Camera::Perspective(Perspective {
        eye: [0.0, 4.3, 9.8],
        target: [0.0, 0.4, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 49.0,
        near: 2.0,
        far: 40.0,
    });
    scene.ambient = [30, 32, 46, 255];
    scene.lights.push(looks::sun([0.45, -0.9, -0.35], SUN));
    let angle = turn(frame) + 0.9;
    let halves = [
        (-1.0, Lighting::Vertex, ["pot by vertex", "floor by vertex"], "light at each vertex"),
        (1.0, Lighting::Pixel, ["pot by pixel", "floor by pixel"], "light at each pixel"),
    ];
    looks::add(&mut scene, GLOW, looks::unlit());
    for (side, light, [pot, floor], caption) in halves {
        let centre = DVec3::new(side * ASIDE, 0.0, 0.0);
        looks::add(&mut scene, pot, looks::glazed(light, 210, 48.0));
        let fog = Material {
            fog_function: FogFunction::ExponentialSquared,
            fog_density: 0.062,
            fog_colour: NIGHT,
            ..looks::dull(light)
        };
        looks::add(&mut scene, floor, fog);
        let (left, right) = if side < 0.0 { (-14.0, 0.0) } else { (0.0, 14.0) };
        let ground = looks::level(0.0, [[left, -16.0], [right, 6.0]], CELLS, 1.0, mix(MIST, PORCELAIN, 0.75));
        scene.draw.push(looks::of(Draw::Mesh(MeshDraw::of(ground)), floor));
        let place = DMat4::from_translation(centre) * DMat4::from_scale(DVec3::splat(SCALE));
        let mesh = Teapot::new(LEVEL, PORCELAIN).mesh().clone();
        scene.draw.push(looks::of(shapes::placed(mesh, place * DMat4::from_rotation_y(0.3)), pot));

        let lamp = centre + DVec3::new(1.95 * angle.cos(), 0.95, 1.95 * angle.sin());
        scene.lights.push(looks::lamp(narrow(lamp), LAMP, 4.2));
        let spot = centre + DVec3::new(-0.7, 5.2, 3.6);
        let aim = centre + DVec3::new(-0.35, 0.0, 1.25) - spot;
        scene.lights.push(looks::spot(narrow(spot), narrow(aim), SPOT, 70.0, 14.0));
        let bulb = shapes::placed(shapes::sphere(0.08, 2, mix(LAMP, PORCELAIN, 0.5)), DMat4::from_translation(lamp));
        scene.draw.push(looks::of(bulb, GLOW));
        let middle = scene.camera.project(narrow(centre), SIZE).map_or(0.0, |seen| seen[0]);
        overlay::caption(&mut scene, [middle, 548.0], PORCELAIN, caption);
    }
    let [columns, rows] = SIZE.map(f64::from);
    overlay::plate(&mut scene, [columns / 2.0 - 1.0, 0.0, 2.0, rows], mix(NIGHT, MIST, 0.3));
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LightType;

    #[test]
    fn scene_has_every_kind_of_light_and_both_halves_have_the_same() {
        let lights = scene(7).lights;
        let kinds: Vec<LightType> = lights.iter().map(|light| light.kind).collect();
        use LightType::{Directional, Point, Spot};
        assert_eq!(kinds, [Directional, Point, Spot, Point, Spot]);
        // A lamp ends before the other pot, so that neither half has more than one.
        for lamp in [&lights[1], &lights[3]] {
            let other = -lamp.position[0].signum() * (ASIDE - 2.0 * SCALE) as f32;
            assert!(lamp.attenuation_cut_off.is_some_and(|end| (lamp.position[0] - other).abs() < 2.0 * end));
        }
        assert_eq!(lights[1].position[1..], lights[3].position[1..]);
    }

    #[test]
    fn scene_left_half_is_lit_at_vertices_and_the_right_one_at_pixels() {
        let batches = scene(0).batches();
        let lit = |light| batches.iter().filter(|batch| batch.light == light).collect::<Vec<_>>();
        let [at_vertices, at_pixels] = [lit(Lighting::Vertex), lit(Lighting::Pixel)];
        assert_eq!((at_vertices.len(), at_pixels.len()), (2, 2));
        let count = |all: &[&crate::scene::Batch]| all.iter().map(|batch| batch.indices.len()).sum::<usize>();
        assert_eq!(count(&at_vertices), count(&at_pixels));
    }
}
