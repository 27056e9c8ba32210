//! Trees, bushes and grass of flat cards with holes: the punch-through test leaves what lies behind a hole to be seen.
//!
//! Every leaf belongs to a card that hides nothing where its texture is open, so the cards are drawn in any order with
//! the depth test alone. Normals of a crown's cards point away from its middle: it is lit like a ball.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};

use super::palette::mix;
use super::{SIZE, looks, pictures, shapes, turn};
use crate::scene::{
    Camera, Colour, Colours, Draw, FogFunction, Lighting, Material, MeshDraw, Perspective, Primitives, Scene, Texture,
    TextureFilter, narrow,
};
use pictures::{Shared, chance};

/// Sky behind everything.
const AIR: Colour = [190, 208, 222, 255];
/// A texel below this alpha is a hole.
const HOLE: u8 = 128;
/// Half the side of the meadow.
const HALF: f64 = 26.0;
/// Trees and bushes: place (x, z), height of the crown's middle, radius, cards.
const CROWNS: [([f64; 2], f64, f64, u32); 11] = [
    ([-3.4, -1.2], 3.0, 1.55, 64),
    ([2.7, -2.9], 3.5, 1.8, 76),
    ([-0.6, -6.8], 3.3, 1.7, 60),
    ([6.4, 1.6], 2.7, 1.35, 52),
    ([-7.6, -5.2], 3.4, 1.7, 56),
    ([-6.3, 4.4], 2.8, 1.4, 52),
    ([10.5, -4.4], 3.1, 1.6, 52),
    ([0.4, 0.9], 0.42, 0.62, 22),
    ([-1.7, 2.6], 0.36, 0.55, 18),
    ([3.9, 3.0], 0.4, 0.6, 20),
    ([-4.9, 1.2], 0.38, 0.58, 20),
];
/// Tufts of grass, two cards each, and how far they stand from the middle.
const TUFTS: u32 = 420;
const TUFTS_WITHIN: f64 = 13.0;

const LEAF: &str = "leaf";
const GRASS: &str = "grass";
const BARK: &str = "bark";
const GROUND: &str = "ground";

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, AIR);
    let camera = Camera::Perspective(Perspective {
        eye: [1.2, 2.3, 10.6],
        target: [0.0, 1.9, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 48.0,
        near: 0.5,
        far: 60.0,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    scene.ambient = [126, 134, 138, 255];
    scene.lights = vec![looks::sun([-0.5, -0.75, -0.55], [240, 226, 190, 255])];
    let foggy = Material {
        fog_function: FogFunction::ExponentialSquared,
        fog_density: 0.045,
        fog_colour: AIR,
        ..looks::dull(Lighting::Vertex)
    };
    let holed = |picture: &Shared| Material {
        texture: Some(Texture { mip_map: true, ..Texture::of(Arc::clone(picture)) }),
        punch_through: Some(HOLE),
        ..foggy.clone()
    };
    let meadow = looks::repeated(&pictures::MEADOW, TextureFilter::Trilinear);
    looks::add(&mut scene, LEAF, holed(&pictures::LEAVES));
    looks::add(&mut scene, GRASS, holed(&pictures::BLADES));
    looks::add(&mut scene, GROUND, Material { texture: Some(meadow), ..foggy.clone() });
    looks::add(&mut scene, BARK, foggy);
    let ground = looks::level(0.0, [[-HALF; 2], [HALF; 2]], [8, 8], 0.4, [255; 4]);
    scene.draw.push(looks::of(Draw::Mesh(MeshDraw::of(ground)), GROUND));
    let mut leaves = Cards::default();
    for (number, ([x, z], height, radius, cards)) in (0_u32..).zip(CROWNS) {
        leaves.crown(DVec3::new(x, height, z), radius, cards, number);
        if height > 1.0 {
            scene.draw.push(looks::of(trunk(DVec2::new(x, z), height), BARK));
        }
    }
    scene.draw.push(leaves.draw(LEAF));
    scene.draw.push(tufts().draw(GRASS));
    scene
}

/// Squares with a picture each.
#[derive(Default)]
struct Cards {
    found: Vec<Card>,
}

/// A card: middle, half its width to the right, half its height upwards, the normal it is lit by, and its tone.
struct Card {
    middle: DVec3,
    right: DVec3,
    up: DVec3,
    normal: DVec3,
    tone: Colour,
}

impl Cards {
    /// Cards all over a ball, facing any way, lit as the ball is.
    fn crown(&mut self, middle: DVec3, radius: f64, cards: u32, seed: u32) {
        for card in 0..cards {
            let random = |use_: u32| 2.0 * chance(card, use_, 100 + seed) - 1.0;
            // Even over the ball: a golden spiral, moved inwards by chance.
            let height = 1.0 - 2.0 * (f64::from(card) + 0.5) / f64::from(cards);
            let ring = (1.0 - height * height).sqrt();
            let (sine, cosine) = (TAU * 0.618_034 * f64::from(card)).sin_cos();
            let outwards = DVec3::new(ring * cosine, height, ring * sine);
            let flat = DVec3::new(1.0, 0.82, 1.0);
            let place = outwards * flat * radius * (0.68 + 0.2 * random(0));
            let facing = (outwards + DVec3::new(random(1), random(2), random(3)) * 0.55).normalize_or(DVec3::Z);
            let right =
                DVec3::new(random(4), random(5), random(6)).cross(facing).normalize_or(facing.any_orthogonal_vector());
            let half = radius * (0.46 + 0.1 * random(7));
            // Darker inside and below, where less light comes to.
            let open = 0.5 + 0.28 * height + 0.2 * random(0);
            let autumn = 0.5 + 0.5 * chance(seed, 3, 8);
            let warm = mix([206, 226, 190, 255], [255, 236, 170, 255], autumn * chance(card, 8, seed));
            self.found.push(Card {
                middle: middle + place,
                right: right * half,
                up: facing.cross(right) * half,
                normal: (outwards + DVec3::Y * 0.15).normalize_or(DVec3::Y),
                tone: mix([134, 148, 132, 255], warm, open),
            });
        }
    }

    fn draw(self, material: &str) -> Draw {
        let mut cards = Primitives { material: Some(material.to_owned()), ..Default::default() };
        let (mut normals, mut coordinates, mut colours, mut indices) = (vec![], vec![], vec![], vec![]);
        for Card { middle, right, up, normal, tone } in self.found {
            let first = cards.vertices.len() as u32;
            let corners = [middle - right + up, middle + right + up, middle + right - up, middle - right - up];
            cards.vertices.extend(corners.map(narrow));
            normals.extend([narrow(normal); 4]);
            coordinates.extend([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
            colours.extend([tone; 4]);
            indices.extend([0, 3, 1, 1, 3, 2].map(|corner| first + corner));
        }
        cards.normals = Some(normals);
        cards.texture_coordinates = Some(coordinates);
        cards.colours = Colours::PerVertex(colours);
        cards.indices = Some(indices);
        Draw::Triangles(cards)
    }
}

/// Tufts that stand on the meadow, crossed cards each.
fn tufts() -> Cards {
    let mut cards = Cards::default();
    for tuft in 0..TUFTS {
        let random = |use_: u32| chance(tuft, use_, 55);
        let (sine, cosine) = (TAU * random(0)).sin_cos();
        let away = TUFTS_WITHIN * random(1).sqrt();
        let height = 0.2 + 0.16 * random(2);
        let tone = mix([196, 204, 168, 255], [255, 250, 214, 255], random(3));
        for quarter in [0.0, 0.25] {
            let right = DQuat::from_rotation_y(TAU * (random(4) + quarter)) * DVec3::X * height;
            cards.found.push(Card {
                middle: DVec3::new(away * cosine, height, away * sine),
                right,
                up: DVec3::Y * height,
                normal: DVec3::Y,
                tone,
            });
        }
    }
    cards
}

/// A trunk that gets thinner upwards, with its foot in the ground.
fn trunk(foot: DVec2, height: f64) -> Draw {
    let bark = shapes::open_grid([12, 4], [122, 96, 74, 255], |u, v| {
        let radius = 0.2 * (1.0 - 0.55 * v) + 0.12 * (1.0 - v).powi(6);
        let (sine, cosine) = (TAU * u).sin_cos();
        let bend = 0.18 * (v * v) * (foot.x * 1.7).sin();
        DVec3::new(foot.x + radius * cosine + bend, height * v, foot.y + radius * sine)
    });
    shapes::solid(bark)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_has_hundreds_of_cards_with_holes_and_all_stand_on_the_meadow() {
        let batches = scene(0).batches();
        let holed: Vec<_> = batches.iter().filter(|batch| batch.material.punch_through == Some(HOLE)).collect();
        let cards: u32 = CROWNS.iter().map(|(.., cards)| cards).sum();
        assert_eq!(
            holed.iter().map(|batch| batch.indices.len() / 6).collect::<Vec<_>>(),
            [cards as usize, 2 * TUFTS as usize]
        );
        let lowest = holed[1].positions.iter().map(|point| point[1]).fold(f32::MAX, f32::min);
        assert!(lowest.abs() < 1e-6, "{lowest}");
        assert!(holed.iter().flat_map(|batch| &batch.positions).all(|p| p[0].abs().max(p[2].abs()) < HALF as f32));
    }

    #[test]
    fn crown_normals_point_away_from_its_middle() {
        let mut cards = Cards::default();
        cards.crown(DVec3::ZERO, 2.0, 50, 1);
        assert!(cards.found.iter().all(|card| card.normal.dot(card.middle.normalize()) > 0.7));
        assert!(cards.found.iter().all(|card| card.right.dot(card.up).abs() < 1e-9));
    }

    #[test]
    fn trunks_are_closed_round_and_face_outwards() {
        // There it is straight.
        let Draw::Mesh(found) = trunk(DVec2::new(0.0, 2.0), 3.0) else { panic!("a mesh") };
        let mesh = found.mesh.expect("made");
        for corners in mesh.triangles() {
            let middle = corners.iter().map(|corner| mesh.corner(*corner)).sum::<DVec3>() / 3.0;
            let outwards = DVec3::new(middle.x, 0.0, middle.z - 2.0);
            assert!(mesh.face_vector(corners).dot(outwards) > 0.0);
        }
    }
}
