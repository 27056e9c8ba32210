//! Flat pictures that try the rasteriser: colours over triangles, lines in every direction, slivers.

use std::f64::consts::TAU;

use super::SIZE;
use super::palette::{NIGHT, PORCELAIN, hue, mix, oklch};
use crate::scene::{Colour, Colours, Draw, Primitives, Scene};

/// Vertices with colours, joined by indices.
#[derive(Default)]
struct Patchwork {
    vertices: Vec<[f32; 3]>,
    colours: Vec<Colour>,
    indices: Vec<u32>,
}

impl Patchwork {
    fn vertex(&mut self, x: f64, y: f64, colour: Colour) -> u32 {
        self.vertices.push([x as f32, y as f32, 0.5]);
        self.colours.push(colour);
        self.vertices.len() as u32 - 1
    }

    fn into_primitives(self) -> Primitives {
        Primitives {
            vertices: self.vertices,
            indices: Some(self.indices),
            colours: Colours::PerVertex(self.colours),
            ..Default::default()
        }
    }
}

pub(super) fn gouraud(_frame: u32) -> Scene {
    const SPOKES: u32 = 96;
    let mut scene = Scene::new(SIZE, NIGHT);
    let mut work = Patchwork::default();
    let [x, y] = [270.0, 300.0];
    let around = |radius: f64, spoke: u32| {
        let (sine, cosine) = (TAU * f64::from(spoke) / f64::from(SPOKES)).sin_cos();
        (x + radius * cosine, y - radius * sine)
    };
    let hub = work.vertex(x, y, PORCELAIN);
    let rings = [(85.0, 0.86, 0.075), (190.0, 0.74, 0.135), (228.0, 0.36, 0.075)];
    for (radius, lightness, chroma) in rings {
        for spoke in 0..SPOKES {
            let (x, y) = around(radius, spoke);
            work.vertex(x, y, oklch(lightness, chroma, f64::from(spoke) / f64::from(SPOKES)));
        }
    }
    for spoke in 0..SPOKES {
        let next = (spoke + 1) % SPOKES;
        work.indices.extend([hub, hub + 1 + spoke, hub + 1 + next]);
        for ring in 0..2 {
            let (inner, outer) = (hub + 1 + ring * SPOKES, hub + 1 + (ring + 1) * SPOKES);
            work.indices.extend([inner + spoke, outer + spoke, inner + next]);
            work.indices.extend([inner + next, outer + spoke, outer + next]);
        }
    }
    // The three primaries of the screen in a single triangle.
    let corners =
        [(650.0, 102.0, [255, 0, 0, 255]), (530.0, 310.0, [0, 255, 0, 255]), (770.0, 310.0, [0, 0, 255, 255])];
    for (x, y, colour) in corners {
        let vertex = work.vertex(x, y, colour);
        work.indices.push(vertex);
    }
    // And two greys, a strip of which shows every step.
    let [dark, light] = [[0, 0, 0, 255], [255, 255, 255, 255]];
    for (top, from, to) in [(354.0, dark, light), (420.0, hue(0.07), hue(0.55)), (486.0, NIGHT, hue(0.25))] {
        let first = work.vertex(530.0, top, from);
        work.vertex(770.0, top, to);
        work.vertex(530.0, top + 42.0, from);
        work.vertex(770.0, top + 42.0, to);
        work.indices.extend([0, 1, 2, 1, 3, 2].map(|corner| first + corner));
    }
    scene.draw.push(Draw::Triangles(work.into_primitives()));
    scene
}

pub(super) fn lines_octants(_frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let mut work = Patchwork::default();
    let mut star = |[x, y]: [f64; 2], radii: [f64; 2], count: u32, inwards: bool| {
        for line in 0..count {
            let turns = f64::from(line) / f64::from(count);
            let (sine, cosine) = (TAU * turns).sin_cos();
            let dim = mix(NIGHT, hue(turns), 0.4);
            let ends = [
                work.vertex(x + radii[0] * cosine, y + radii[0] * sine, dim),
                work.vertex(x + radii[1] * cosine, y + radii[1] * sine, hue(turns)),
            ];
            work.indices.extend(if inwards { [ends[1], ends[0]] } else { ends });
        }
    };
    star([400.0, 300.0], [24.0, 250.0], 144, false);
    // Steep and shallow corners of the picture, drawn toward their centres.
    for (x, y) in [(96.0, 96.0), (704.0, 96.0), (96.0, 504.0), (704.0, 504.0)] {
        star([x, y], [6.0, 70.0], 48, true);
    }
    // Half-open lines end to end: each shared point is drawn once.
    for turns in 0..3 {
        let radius = 262.0 + 10.0 * f64::from(turns);
        let sides = 8 + 8 * turns;
        let first = work.vertices.len() as u32;
        for corner in 0..sides {
            let part = f64::from(corner) / f64::from(sides);
            let (sine, cosine) = (TAU * part).sin_cos();
            work.vertex(400.0 + radius * cosine, 300.0 + radius * sine, hue(part));
        }
        work.indices.extend((0..sides).flat_map(|corner| [first + corner, first + (corner + 1) % sides]));
    }
    scene.draw.push(Draw::Lines(work.into_primitives()));
    scene
}

pub(super) fn slivers(_frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let mut fan = Patchwork::default();
    // A fan about a point that is on no pixel centre: each triangle is thinner than a pixel over most of its length.
    const BLADES: u32 = 1440;
    let hub = fan.vertex(30.3, 570.7, PORCELAIN);
    for blade in 0..=BLADES {
        let part = f64::from(blade) / f64::from(BLADES);
        let (sine, cosine) = (TAU / 4.0 * part).sin_cos();
        let ripple = 510.0 + 12.0 * (TAU * 12.0 * part).sin();
        let colour = mix(hue(0.02 + 0.75 * part), NIGHT, if blade % 2 == 0 { 0.0 } else { 0.25 });
        let rim = fan.vertex(30.3 + ripple * cosine, 570.7 - ripple * sine, colour);
        if blade > 0 {
            fan.indices.extend([hub, rim, rim - 1]);
        }
    }
    // A curtain of columns that grow thinner by a twentieth each, down to a hundredth of a pixel, sharing every vertex.
    const COLUMNS: u32 = 150;
    const ROWS: u32 = 36;
    let mut curtain = Patchwork::default();
    let total: f64 = (0..COLUMNS).map(|column| 0.95_f64.powi(column as i32)).sum();
    let mut x = 0.0;
    for column in 0..=COLUMNS {
        for row in 0..=ROWS {
            let down = f64::from(row) / f64::from(ROWS);
            let sway = 14.0 * (TAU * (down * 1.5 + x * 0.5)).sin();
            let colour = oklch(0.5 + 0.35 * f64::from((column + row / 6) % 2), 0.11, 0.55 + 0.35 * x);
            let vertex = curtain.vertex(572.0 + 190.0 * x + sway, 30.0 + 540.0 * down, colour);
            if column > 0 && row > 0 {
                let (left, up) = (vertex - ROWS - 1, vertex - 1);
                curtain.indices.extend([left - 1, up, left, up, vertex, left]);
            }
        }
        x += 0.95_f64.powi(column as i32) / total;
    }
    scene.draw = vec![Draw::Triangles(fan.into_primitives()), Draw::Triangles(curtain.into_primitives())];
    scene
}
