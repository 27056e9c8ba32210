//! The main demonstration: porcelain painted in cobalt.
//!
//! Every line is a surface marking: rings and meridians that run along edges of the triangles, and waves and letters
//! that cross them. Without the decal transform they would sink into the glaze.

use std::f64::consts::TAU;

use super::palette::{COBALT, CORAL, DUSK, NIGHT, PORCELAIN};
use super::{SIZE, shapes, smooth_scene, text, turn};
use crate::scene::{Camera, Draw, Perspective, Scene};
use crate::teapot::{Marking, Part, Teapot};

/// Cells along each side of a patch.
const LEVEL: u32 = 16;

/// Pixels that the pattern's and the letters' lines are wide, anti-aliased.
const WIDTHS: [f32; 2] = [1.25, 3.0];

pub(super) fn scene(frame: u32) -> Scene {
    let teapot = Teapot::new(LEVEL, PORCELAIN);
    // Each stroke of the letters five times for weight.
    let strokes = accents(&teapot, &[[0.0, 0.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
    let painted = vec![shapes::lines(pairs(&pattern(&teapot)), COBALT), shapes::lines(pairs(&strokes), CORAL)];
    showing(Scene::new(SIZE, NIGHT), &teapot, painted, frame)
}

/// The same anti-aliased: a line of the letters has its weight by its width.
pub(super) fn smooth(frame: u32) -> Scene {
    let teapot = Teapot::new(LEVEL, PORCELAIN);
    let strokes = accents(&teapot, &[[0.0, 0.0]]);
    let painted = vec![
        shapes::wide_lines(pairs(&pattern(&teapot)), COBALT, WIDTHS[0]),
        shapes::wide_lines(pairs(&strokes), CORAL, WIDTHS[1]),
    ];
    showing(smooth_scene(SIZE, NIGHT), &teapot, painted, frame)
}

/// The teapot on its floor with what is painted on it.
fn showing(mut scene: Scene, teapot: &Teapot, painted: Vec<Draw>, frame: u32) -> Scene {
    let camera = Camera::Perspective(Perspective {
        eye: [2.6, 4.3, 9.4],
        target: [0.2, 1.38, 0.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 42.0,
        near: 4.0,
        far: 24.0,
    });
    scene.camera = camera.orbited(turn(frame), 0.0, 1.0);
    scene.draw =
        vec![shapes::floor(-0.01, 9.0, DUSK, NIGHT), shapes::solid(teapot.mesh().clone()), shapes::decal(painted)];
    scene
}

fn pairs(markings: &[Marking]) -> Vec<[f32; 3]> {
    markings.iter().flat_map(|marking| shapes::pieces(&marking.points, marking.closed)).collect()
}

/// The painted pattern: bands, waves, leaves round the lid, the letters.
fn pattern(teapot: &Teapot) -> Vec<Marking> {
    let mut all = Vec::new();
    let rings = [
        (Part::Body, &[0.75, 1.125, 1.1875, 2.3125, 2.375, 2.875][..]),
        (Part::Lid, &[0.5, 1.25, 1.3125, 1.8125, 1.875]),
        (Part::Spout, &[0.5, 0.5625, 1.75, 1.8125]),
        (Part::Handle, &[0.375, 0.4375, 1.5, 1.5625]),
    ];
    for (part, at) in rings {
        all.extend(at.iter().map(|u| teapot.ring(part, *u)));
    }
    for line in 0..32 {
        all.push(teapot.meridian(Part::Lid, f64::from(line) / 8.0, 1.3125, 1.8125));
    }
    for line in 0..64 {
        all.push(teapot.meridian(Part::Body, f64::from(line) / 16.0, 2.3125, 2.375));
    }
    // Three waves a third of a period apart make a plait.
    for strand in 0..3 {
        all.push(wave(teapot, 1.28, 0.075, 24.0, f64::from(strand) / 3.0));
    }
    for strand in 0..2 {
        all.push(wave(teapot, 2.21, 0.06, 16.0, f64::from(strand) / 2.0));
    }
    // Along the back of the handle and the top of the spout.
    all.push(teapot.meridian(Part::Handle, 1.0, 0.0, 2.0));
    all.push(teapot.meridian(Part::Spout, 0.0, 0.5625, 1.75));
    all
}

/// A wave round the body: middle and height in u, periods round.
fn wave(teapot: &Teapot, middle: f64, height: f64, periods: f64, phase: f64) -> Marking {
    const STEPS: u32 = 768;
    let through = |step| {
        let v = 4.0 * f64::from(step) / f64::from(STEPS);
        [middle + height * (TAU * (periods * v / 4.0 + phase)).sin(), v]
    };
    let through: Vec<[f64; 2]> = (0..=STEPS).map(through).collect();
    teapot.marking(Part::Body, &through)
}

/// What is painted in the second colour: the name on both sides, each stroke once for each of `places` beside it.
fn accents(teapot: &Teapot, places: &[[f64; 2]]) -> Vec<Marking> {
    const TEXT: &str = "ZGA";
    /// Height of the letters, and how much wider a step in v is than one in u there.
    const HEIGHT: f64 = 0.42;
    const ASPECT: f64 = 0.34;
    const WEIGHT: f64 = 0.014;
    let mut all = Vec::new();
    for side in [1.0, 3.0] {
        for [right, up] in places {
            for stroke in text::strokes(TEXT) {
                let place = |[x, y]: [f64; 2]| {
                    let x = x - text::width(TEXT) / 2.0 + right * WEIGHT;
                    // Seen from outside, v grows to the left.
                    [1.75 + HEIGHT * (0.5 - y - up * WEIGHT), side - HEIGHT * ASPECT * 2.0 * x]
                };
                let through: Vec<[f64; 2]> = stroke.into_iter().map(place).collect();
                all.push(teapot.marking(Part::Body, &through));
            }
        }
    }
    all
}
