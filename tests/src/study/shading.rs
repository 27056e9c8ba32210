//! Where light is worked out: once a triangle, at its vertices, or at each pixel, against light at each pixel in f64 on
//! the interpolated normals. Visibility is the same in all three.

use super::card::{clocks, frame};
use crate::harness::look::{Lights, Record};
use crate::harness::{Camera, Look, Options, Pixels, Screen, Stage, State, Topology};
use crate::oracle::effects::Corner;

/// Where light is worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// At the first vertex, for all of the triangle.
    Flat,
    /// At the vertices; colours are interpolated.
    Gouraud,
    /// At each pixel; normals are interpolated.
    PerPixel,
}

impl Way {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Flat, Self::Gouraud, Self::PerPixel];

    /// A name for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "Gouraud",
            Self::PerPixel => "per pixel",
        }
    }
}

/// What was found of one way.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Which.
    pub way: Way,
    /// The card's picture, levels.
    pub picture: Vec<[f64; 3]>,
    /// Clocks of all units but the front end.
    pub clocks: u64,
    /// Host times of frames, rising, nanoseconds.
    pub nanoseconds: Vec<f64>,
}

/// All ways on one model.
#[derive(Clone, Debug)]
pub struct Found {
    /// Light at each pixel in f64, levels.
    pub truth: Vec<[f64; 3]>,
    /// In the order of [`Way::ALL`].
    pub outcomes: Vec<Outcome>,
}

/// A key light with a highlight, a weak one from the other side.
fn lights() -> Vec<u32> {
    let white = Record { kind: 0, direction: [-0.5, -0.6, -0.6], colour: 0x00FF_FFFF, ..Record::default() };
    let blue = Record { direction: [0.9, 0.1, -0.4], colour: 0x0060_4020, ..white };
    [white.words(), blue.words()].concat()
}

fn state(way: Way, size: [u32; 2]) -> State {
    let lights = Lights {
        per_pixel: way == Way::PerPixel,
        two_sided: true,
        local_viewer: true,
        count: 2,
        ambient: 0x0028_2020,
        specular: 0x00C0_C0C0,
        shininess: 32.0,
        ..Lights::default()
    };
    let look = Look { light: Some(lights), ..Look::default() };
    State { gouraud: way != Way::Flat, camera: Camera::perspective(size), ..State::looking(look) }
}

/// Draws triangles, three corners each in eye space between the near plane (1 before the eye) and 1000, in each way.
///
/// # Panics
/// When something would have to be clipped.
#[must_use]
pub fn of_card(corners: &[Corner], size: [u32; 2], threads: usize, repeats: usize) -> Found {
    let region = lights();
    let options = Options { pixels: Pixels::Argb8888, threads, ..Options::default() };
    let mut stage = Stage::new(size, &options, &region);
    stage.triangles(corners, &state(Way::PerPixel, size));
    let (_, _, shades) = stage.end();
    let truth = shades.iter().map(|shade| [shade.colour[0], shade.colour[1], shade.colour[2]]).collect();
    let levels = |pixel: &u32| {
        let [_, red, green, blue] = pixel.to_be_bytes();
        [red, green, blue].map(f64::from)
    };
    let mut screens = Vec::new();
    let mut outcomes = Vec::new();
    for way in Way::ALL {
        let mut screen = Screen::new(size[0], size[1], &Options { texture_bytes: 4 * region.len() as u32, ..options });
        screen.put_textures(0, &region);
        let draw = |screen: &mut Screen| screen.draw_corners(Topology::Triangles, corners, &state(way, size));
        let (_, events) = frame(&mut screen, draw);
        let picture = screen.read().colour.iter().map(levels).collect();
        outcomes.push(Outcome { way, picture, clocks: clocks(&events), nanoseconds: Vec::new() });
        screens.push(screen);
    }
    for _ in 0..repeats {
        for (screen, outcome) in screens.iter_mut().zip(&mut outcomes) {
            let state = state(outcome.way, size);
            let draw = |screen: &mut Screen| screen.draw_corners(Topology::Triangles, corners, &state);
            outcome.nanoseconds.push(frame(screen, draw).0);
        }
    }
    outcomes.iter_mut().for_each(|outcome| outcome.nanoseconds.sort_by(f64::total_cmp));
    Found { truth, outcomes }
}

/// A ball of `rings` x `2 rings` cells, 2 in radius, 3.2 before the eye.
#[must_use]
pub fn ball(rings: u32) -> Vec<Corner> {
    use std::f64::consts::PI;
    let at = |i: u32, j: u32| {
        let (down, round) = (PI * f64::from(i) / f64::from(rings), PI * f64::from(j) / f64::from(rings));
        let normal = [down.sin() * round.cos(), down.cos(), down.sin() * round.sin()];
        Corner {
            position: [2.0 * normal[0], 2.0 * normal[1], 2.0 * normal[2] - 3.2].map(|c| c as f32),
            colour: 0xFFC8_B496,
            normal: normal.map(|c| c as f32),
            coordinates: [0.0; 2],
        }
    };
    let cells = (0..rings).flat_map(|i| (0..2 * rings).map(move |j| (i, j)));
    let two = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
        [a, b, c, c, b, d]
    };
    cells.flat_map(two).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{flip, psnr::psnr};
    use super::*;

    #[test]
    fn of_card_ways_order_as_they_should() {
        let found = of_card(&ball(12), [80, 60], 1, 1);

        let quality: Vec<f64> = found.outcomes.iter().map(|o| psnr(&found.truth, &o.picture)).collect();
        let seen: Vec<f64> = found
            .outcomes
            .iter()
            .map(|o| flip::mean(&flip::flip(&found.truth, &o.picture, 80, flip::PIXELS_PER_DEGREE)))
            .collect();
        // Per pixel differs by rounding alone: half a level at most in each channel, 1/12 of a level squared on average,
        // is 59 dB; interpolated normals in f32 add to it.
        assert!(quality[0] < quality[1] && quality[1] < quality[2] && quality[2] > 50.0, "{quality:?}");
        assert!(seen[0] > seen[1] && seen[1] > seen[2] && seen[2] < 0.01, "{seen:?}");
        assert!(found.outcomes[2].clocks > found.outcomes[1].clocks);
    }
}
