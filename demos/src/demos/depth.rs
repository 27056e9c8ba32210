//! Tiles a hair above a floor, seen down to the horizon, with a depth range of 1 : 40000.
//!
//! Depth is linear on the screen, so far away the tiles and the floor get the same stored depth and the
//! earlier command wins, or they alternate. How far away that begins is a question of depth bits alone.

use super::SIZE;
use super::palette::{AMBER, CORAL, MIST, NIGHT, SKY, TEAL, mix};
use crate::scene::{Camera, Colour, Colours, Draw, Perspective, Primitives, Scene};

/// The view moves by one pair of rows.
pub(super) const FRAMES: u32 = 60;

const COLUMNS: i32 = 10;
const ROWS: i32 = 60;
const LEFT: f32 = -20.0;
const TILE: f32 = 4.0;
const GAP: f32 = 0.03;

pub(super) fn scene_16(frame: u32) -> Scene {
    scene(frame, 16)
}

pub(super) fn scene_24(frame: u32) -> Scene {
    scene(frame, 24)
}

fn scene(frame: u32, depth_bits: u32) -> Scene {
    let mut scene = Scene::new(SIZE, mix(NIGHT, MIST, 0.25));
    let forward = 2.0 * TILE * frame as f32 / FRAMES as f32;
    scene.camera = Camera::Perspective(Perspective {
        eye: [0.0, 7.0, -forward],
        target: [0.0, 4.2, -14.0 - forward],
        // Tilted, so that the steps of depth cross the rows of tiles.
        up: [0.1, 1.0, 0.0],
        fov_x_degrees: 62.0,
        near: 0.05,
        far: 2000.0,
    });
    scene.card.depth_bits = Some(depth_bits);
    let floor = mix(NIGHT, MIST, 0.55);
    let width = TILE * COLUMNS as f32;
    let length = TILE * ROWS as f32;
    let mut ground = Tiles::default();
    ground.add([LEFT, 0.0, 8.0], [width, length + 8.0], floor);
    let mut tiles = Tiles::default();
    for row in 0..ROWS {
        for column in (0..COLUMNS).filter(|column| (column + row) % 2 == 0) {
            let colour = [CORAL, AMBER, TEAL, SKY][((column / 2 + row) % 4) as usize];
            let corner = [LEFT + TILE * column as f32, GAP, -TILE * row as f32];
            tiles.add(corner, [TILE, TILE], colour);
        }
    }
    // The tiles come last: where depths are equal, the floor stays.
    scene.draw = vec![ground.draw(), tiles.draw()];
    scene
}

#[derive(Default)]
struct Tiles {
    vertices: Vec<[f32; 3]>,
    colours: Vec<Colour>,
    indices: Vec<u32>,
}

impl Tiles {
    /// A level rectangle from its near left corner.
    fn add(&mut self, [x, y, z]: [f32; 3], [width, length]: [f32; 2], colour: Colour) {
        let first = self.vertices.len() as u32;
        self.vertices.extend([[x, y, z], [x + width, y, z], [x + width, y, z - length], [x, y, z - length]]);
        self.colours.extend([colour; 4]);
        self.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }

    fn draw(self) -> Draw {
        Draw::Triangles(Primitives {
            vertices: self.vertices,
            indices: Some(self.indices),
            colours: Colours::PerVertex(self.colours),
            ..Default::default()
        })
    }
}
