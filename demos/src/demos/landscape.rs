//! Hills round a lake, lit by a low sun, that fade into the haze.
//!
//! The heights are noise of whole numbers; each vertex has the normal of the surface there and a colour of its height
//! and slope, the texture adds the grain, fog takes what is far, and the lake lets its shore shine through.

use std::f64::consts::TAU;
use std::sync::{Arc, LazyLock};

use glam::{DVec2, DVec3};

use super::palette::{COBALT, PORCELAIN, SKY, mix};
use super::{SIZE, looks, pictures, turn};
use crate::mesh::Mesh;
use crate::scene::{
    Blend, Camera, Colour, Colours, Draw, FogFunction, Lighting, Material, MeshDraw, Perspective, Primitives, Scene,
    TextureFilter, narrow,
};

/// Half the side of the land, and cells along it.
const HALF: f64 = 30.0;
const CELLS: u32 = 112;
/// Height of the lake.
const LAKE: f64 = 0.0;
/// What is far away fades into this.
const HAZE: Colour = [202, 206, 218, 255];
/// Part of the fog for each world unit.
const DENSITY: f32 = 0.034;

const LAND: &str = "land";
const WATER: &str = "water";
const AIR: &str = "air";

/// The land, which no frame changes.
static GROUND: LazyLock<Arc<Mesh>> = LazyLock::new(|| Arc::new(land()));

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, HAZE);
    let eye = turned(DVec2::new(0.0, 13.5), turn(frame));
    let eye = DVec3::new(eye.x, 4.8, eye.y);
    scene.camera = Camera::Perspective(Perspective {
        eye: narrow(eye),
        target: [0.0, 2.1, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 58.0,
        near: 1.0,
        far: 110.0,
    });
    scene.ambient = [70, 82, 112, 255];
    scene.lights = vec![looks::sun([-0.78, -0.42, -0.3], [255, 232, 196, 255])];
    let foggy = Material {
        fog_function: FogFunction::ExponentialSquared,
        fog_density: DENSITY,
        fog_colour: HAZE,
        ..looks::dull(Lighting::Vertex)
    };
    let grain = looks::repeated(&pictures::GRAIN, TextureFilter::Trilinear);
    looks::add(&mut scene, LAND, Material { texture: Some(grain), ..foggy.clone() });
    let gloss = Material { blend: Blend::Alpha, specular: [255, 236, 200, 255], shininess: 28.0, ..foggy };
    looks::add(&mut scene, WATER, Material { light: Some(Lighting::Pixel), ..gloss });
    looks::add(&mut scene, AIR, looks::unlit());
    let ground = MeshDraw { mesh: Some(Arc::clone(&GROUND)), ..MeshDraw::of(Mesh::new(LAND, vec![], vec![], HAZE)) };
    let lake = looks::level(LAKE, [[-HALF; 2], [HALF; 2]], [1, 1], 1.0, water_colour());
    scene.draw = vec![
        looks::of(sky(eye), AIR),
        looks::of(Draw::Mesh(ground), LAND),
        looks::of(Draw::Mesh(MeshDraw::of(lake)), WATER),
    ];
    scene
}

fn water_colour() -> Colour {
    let [r, g, b, _] = mix(COBALT, SKY, 0.45);
    [r, g, b, 178]
}

fn turned(at: DVec2, angle: f64) -> DVec2 {
    DVec2::from_angle(angle).rotate(at)
}

/// Height of the land: rough hills on a bowl whose middle the lake fills.
fn height(at: DVec2) -> f64 {
    let rough = pictures::fractal(at / 9.0 + DVec2::splat(40.0), 64, 5, 61);
    // Distance from a crease of the noise, rounded so that crests are no finer than the cells.
    let crease = 2.0 * pictures::fractal(at / 13.0 + DVec2::splat(50.0), 64, 3, 17) - 1.0;
    let ridge = 1.0 - (crease * crease + 0.004).sqrt();
    let away = (at.length() / 15.0).min(1.6);
    let bowl = away * away * (3.0 - 1.2 * away);
    4.4 * (rough - 0.5) + 4.2 * (ridge - 0.72) * (0.3 + bowl) + 1.9 * bowl - 1.5
}

/// The land as a mesh: each vertex has the slope of the surface at its place.
fn land() -> Mesh {
    const STEP: f64 = 0.05;
    let at = |index: u32| HALF * (2.0 * f64::from(index) / f64::from(CELLS) - 1.0);
    let (mut positions, mut normals, mut coordinates, mut colours) = (vec![], vec![], vec![], vec![]);
    let mut indices = Vec::new();
    for i in 0..=CELLS {
        for j in 0..=CELLS {
            let place = DVec2::new(at(i), at(j));
            let level = height(place);
            let slope = |by: DVec2| (height(place + by) - height(place - by)) / (2.0 * STEP);
            let normal = DVec3::new(-slope(DVec2::X * STEP), 1.0, -slope(DVec2::Y * STEP)).normalize();
            positions.push(narrow(DVec3::new(place.x, level, place.y)));
            normals.push(narrow(normal));
            coordinates.push([(place.x / 2.5) as f32, (place.y / 2.5) as f32]);
            colours.push(colour(place, level, normal.y));
            if i < CELLS && j < CELLS {
                let a = i * (CELLS + 1) + j;
                let c = a + CELLS + 1;
                // Diagonals that alternate have no direction of their own.
                let cell =
                    if (i + j) % 2 == 0 { [a, a + 1, c, a + 1, c + 1, c] } else { [a, a + 1, c + 1, a, c + 1, c] };
                indices.extend(cell);
            }
        }
    }
    let mut mesh = Mesh::new(LAND, positions, indices, HAZE);
    mesh.normals = Some(normals);
    mesh.texture_coordinates = Some(coordinates);
    mesh.colours = Colours::PerVertex(colours);
    mesh
}

/// Sand at the shore, grass, rock where it is steep, snow on top.
fn colour(at: DVec2, level: f64, upright: f64) -> Colour {
    let step = |from: f64, to: f64, value: f64| ((value - from) / (to - from)).clamp(0.0, 1.0);
    let patch = pictures::noise(at / 2.2 + DVec2::splat(90.0), 128, 5);
    let grass = mix([92, 124, 62, 255], [148, 150, 78, 255], patch);
    let shore = mix([214, 196, 150, 255], grass, step(0.1, 0.45, level));
    let rock = mix(shore, [132, 120, 112, 255], 1.0 - step(0.66, 0.84, upright));
    mix(rock, PORCELAIN, step(4.4, 5.8, level + 0.8 * (patch - 0.5)) * step(0.5, 0.72, upright))
}

/// A ring round the viewer that fades from the haze upwards to blue.
fn sky(eye: DVec3) -> Draw {
    const SIDES: u32 = 24;
    const RADIUS: f64 = 90.0;
    let bands = [(-0.2, HAZE), (0.1, HAZE), (0.34, mix(SKY, HAZE, 0.35)), (0.9, mix(SKY, COBALT, 0.35))];
    let (mut vertices, mut colours, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    let count = bands.len() as u32;
    for side in 0..SIDES {
        let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
        for (rise, shade) in bands {
            vertices.push(narrow(eye + RADIUS * DVec3::new(sine, rise, cosine)));
            colours.push(shade);
        }
        let [a, b] = [side, (side + 1) % SIDES].map(|side| side * count);
        indices.extend((0..count - 1).flat_map(|band| [a, b, a + 1, a + 1, b, b + 1].map(|corner| corner + band)));
    }
    let colours = Colours::PerVertex(colours);
    Draw::Triangles(Primitives { vertices, indices: Some(indices), colours, ..Default::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::wide;

    #[test]
    fn land_is_sound_and_its_normals_agree_with_its_triangles() {
        let mesh = &GROUND;
        assert_eq!(mesh.check(), Ok(()));
        assert_eq!(mesh.triangle_count(), 2 * (CELLS * CELLS) as usize);
        let normals = mesh.normals.as_ref().expect("normals");
        assert!(normals.iter().all(|normal| normal[1] > 0.0 && (wide(*normal).length() - 1.0).abs() < 1e-6));
        assert!(mesh.triangles().all(|corners| mesh.face_vector(corners).y > 0.0));
        let cosine = |corners: [u32; 3]| {
            let face = mesh.face_vector(corners).normalize();
            corners.iter().map(|corner| face.dot(wide(normals[*corner as usize]))).sum::<f64>() / 3.0
        };
        // The finest noise turns the surface within a cell here and there; most of the land is smoother.
        let mean = mesh.triangles().map(cosine).sum::<f64>() / mesh.triangle_count() as f64;
        assert!(mean > 0.9, "{mean}");
    }

    #[test]
    fn land_has_a_lake_in_the_middle_and_hills_above_it() {
        let under = |radius: f64| {
            let ring = (0..64).map(|step| turned(DVec2::new(radius, 0.0), TAU * f64::from(step) / 64.0));
            ring.filter(|at| height(*at) < LAKE).count()
        };
        assert!(under(3.0) > 30, "{}", under(3.0));
        assert!(under(20.0) < 8, "{}", under(20.0));
        let highest = GROUND.positions.iter().map(|point| point[1]).fold(f32::MIN, f32::max);
        assert!((5.0..14.0).contains(&highest), "{highest}");
    }

    #[test]
    fn scene_eye_stays_above_the_land_all_round() {
        for frame in 0..super::super::TURN {
            let [eye, ..] = scene(frame).camera.placement().expect("placed");
            let ground = height(DVec2::new(f64::from(eye[0]), f64::from(eye[2])));
            // The near plane is one unit away.
            assert!(f64::from(eye[1]) > ground + 1.0, "frame {frame}: {eye:?} over {ground}");
        }
    }
}
