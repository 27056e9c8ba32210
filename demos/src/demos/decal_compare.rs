//! One drawing on surfaces of slope 1, 4 and 7.9: as plain lines on the left, as decals of slope 8 on the right.
//!
//! The surfaces are stretched along the line of sight so that all six look the same from the viewer's place; only how
//! well the lines stay above them differs.

use std::f64::consts::TAU;

use glam::DVec3;

use super::palette::{AMBER, CORAL, MIST, NIGHT, PORCELAIN, TEAL, mix};
use super::{SIZE, shapes, text, turn};
use crate::scene::{Camera, Colour, Colours, Draw, Orthographic, Primitives, Scene, narrow};

const ROWS: [(f64, &str, Colour); 3] = [(1.0, "S = 1", TEAL), (4.0, "S = 4", AMBER), (7.9, "S = 7.9", CORAL)];
/// Half the width and half the visible height of a panel, in eye units.
const HALF: [f64; 2] = [1.5, 0.78];
/// Where the text stands: nearer than every surface.
const FRONT: f64 = 9.0;

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    scene.camera = Camera::Orthographic(Orthographic {
        eye: [0.0, 0.0, 10.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        width: 8.0,
        near: 0.5,
        far: 20.0,
    });
    let caption_colour = mix(MIST, PORCELAIN, 0.4);
    for (row, (slope, caption, colour)) in (0..).zip(ROWS) {
        let y = 1.68 - 1.86 * f64::from(row);
        for (x, as_decal) in [(-1.05, false), (2.25, true)] {
            let panel = Panel { centre: [x, y], slope };
            scene.draw.push(panel.surface(colour));
            let drawing = vec![shapes::lines(panel.drawing(turn(frame) / 6.0), PORCELAIN)];
            if as_decal {
                scene.draw.push(shapes::decal(drawing));
            } else {
                scene.draw.extend(drawing);
            }
        }
        scene.draw.push(caption_at(caption, [-3.75, y - 0.07], 0.15, caption_colour));
    }
    scene.draw.push(caption_at("PLAIN", [-1.05 - 0.2 * 14.0 / 6.0, 2.62], 0.2, caption_colour));
    scene.draw.push(caption_at("DECAL", [2.25 - 0.2 * 14.0 / 6.0, 2.62], 0.2, caption_colour));
    scene
}

fn caption_at(caption: &str, [x, y]: [f64; 2], height: f64, colour: Colour) -> Draw {
    let mut pairs = Vec::new();
    for stroke in text::strokes(caption) {
        let place = |[a, b]: &[f64; 2]| narrow(DVec3::new(x + a * height, y + b * height, FRONT));
        pairs.extend(shapes::pieces(&stroke.iter().map(place).collect::<Vec<_>>(), false));
    }
    shapes::lines(pairs, colour)
}

struct Panel {
    centre: [f64; 2],
    slope: f64,
}

impl Panel {
    /// From the panel's own coordinates, -1..=1, to the sloping surface: its top lies farther away.
    fn place(&self, [a, b]: [f64; 2]) -> [f32; 3] {
        let [x, y] = [a * HALF[0], b * HALF[1]];
        narrow(DVec3::new(self.centre[0] + x, self.centre[1] + y, -y * self.slope))
    }

    fn surface(&self, colour: Colour) -> Draw {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let (near, far) = (mix(NIGHT, colour, 0.62), mix(NIGHT, colour, 0.3));
        Draw::Triangles(Primitives {
            vertices: corners.map(|corner| self.place(corner)).to_vec(),
            indices: Some(vec![0, 1, 2, 0, 2, 3]),
            colours: Colours::PerVertex(vec![near, near, far, far]),
            ..Default::default()
        })
    }

    /// Circles, rays and a rosette, turned by `phase`.
    fn drawing(&self, phase: f64) -> Vec<[f32; 3]> {
        const STEPS: u32 = 240;
        // Round on the screen.
        let round = |radius: f64, angle: f64| {
            let angle = angle + phase;
            [radius * angle.cos() * HALF[1] / HALF[0], radius * angle.sin()]
        };
        let curve = |radius: &dyn Fn(f64) -> f64| {
            let points: Vec<[f32; 3]> = (0..STEPS)
                .map(|step| TAU * f64::from(step) / f64::from(STEPS))
                .map(|angle| self.place(round(radius(angle), angle)))
                .collect();
            shapes::pieces(&points, true)
        };
        let mut pairs = curve(&|_| 0.92);
        pairs.extend(curve(&|_| 0.3));
        pairs.extend(curve(&|angle| 0.61 + 0.25 * (7.0 * angle).sin()));
        pairs.extend(curve(&|angle| 0.61 - 0.25 * (7.0 * angle).sin()));
        for ray in 0..14 {
            let angle = TAU * f64::from(ray) / 14.0;
            pairs.extend([self.place(round(0.06, angle)), self.place(round(0.3, angle))]);
        }
        let frame = [[-0.97, -0.95], [0.97, -0.95], [0.97, 0.95], [-0.97, 0.95]];
        pairs.extend(shapes::pieces(&frame.map(|corner| self.place(corner)), true));
        for side in [-1.0, 1.0] {
            for line in 1..6 {
                let x = side * (0.55 + 0.07 * f64::from(line));
                pairs.extend([self.place([x, -0.95]), self.place([x, 0.95])]);
            }
        }
        pairs
    }
}
