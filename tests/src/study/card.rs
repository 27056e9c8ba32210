//! What a card makes of a scene under a setting, and at which price.
//!
//! The price in clocks is that of all units but the front end, whose clocks depend on how packets were cut, not on any
//! accuracy. The price in time is from the first packet to the fence behind the last; where settings are to be compared
//! their frames are drawn in turn, so that whatever else the host does meets all of them alike.

use std::time::Instant;

use super::scene::Scene;
use super::truth::Truth;
use crate::harness::{Edges, Events, Grid, Hidden, Options, Order, Screen, State, Subpixel};
use crate::oracle::DepthFormat;

/// Everything about a card that decides how accurate its visibility is, and how that is found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Samples of a pixel.
    pub grid: Grid,
    /// How fragments of a pixel that share samples are ordered.
    pub order: Order,
    /// Which edges have samples.
    pub edges: Edges,
    /// Number format of depth.
    pub depth: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to, 4 or 8.
    pub coordinate_bits: u32,
    /// Who decides visibility, and how.
    pub hidden: Hidden,
}

impl Setting {
    /// Every axis at its best: 64 samples at every edge, each with its depth; 31 bits of depth with 24 fraction bits; 1/256 pixel.
    #[must_use]
    pub fn best() -> Self {
        Self {
            grid: Grid::Grid8x8,
            order: Order::Exhaustive,
            edges: Edges::All,
            depth: DepthFormat { bits: 31, fraction: 24 },
            coordinate_bits: 8,
            hidden: Hidden::default(),
        }
    }

    /// The best there is with one sample a pixel.
    #[must_use]
    pub fn centres() -> Self {
        Self { grid: Grid::Off, ..Self::best() }
    }

    /// How the harness builds such a card.
    #[must_use]
    pub fn options(&self, threads: usize) -> Options {
        Options {
            depth: self.depth,
            subpixel_bits: self.coordinate_bits,
            subpixel: Subpixel { depth: self.order, edges: self.edges, ..Subpixel::on(self.grid) },
            hidden: self.hidden,
            threads,
            ..Options::default()
        }
    }

    /// How it draws: with masks where there is a grid.
    #[must_use]
    pub fn state(&self) -> State {
        State { anti_alias: self.grid != Grid::Off, ..State::default() }
    }
}

/// A picture with its price.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// XRGB8888, row by row; 31:24 are 0.
    pub colour: Vec<u32>,
    /// All counters of one frame.
    pub events: Events,
    /// Clocks of all units but the front end.
    pub clocks: u64,
    /// Host time of each frame, rising.
    pub nanoseconds: Vec<f64>,
}

impl Drawn {
    /// The middle of the host times.
    #[must_use]
    pub fn median(&self) -> f64 {
        self.nanoseconds.get(self.nanoseconds.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Half the distance between the quartiles of the host times.
    #[must_use]
    pub fn spread(&self) -> f64 {
        let at = |part: usize| self.nanoseconds.get(self.nanoseconds.len() * part / 4).copied().unwrap_or(f64::NAN);
        (at(3) - at(1)) / 2.0
    }
}

/// Clocks of all units but the front end.
#[must_use]
pub fn clocks(events: &Events) -> u64 {
    events["cycles.total"] - events["cycles.frontend"]
}

/// A frame: cleared, drawn by `draw`, done. Its time in nanoseconds, and its counters.
pub fn frame(screen: &mut Screen, draw: impl FnOnce(&mut Screen)) -> (f64, Events) {
    screen.end();
    screen.clear_counts();
    let begun = Instant::now();
    screen.clear();
    draw(screen);
    screen.end();
    // Reading the counters waits for the fence.
    let events = screen.events();
    (begun.elapsed().as_secs_f64() * 1e9, events)
}

/// A scene under each setting, frames in turn: one to warm up, then `repeats` that count.
#[must_use]
pub fn drawn(scene: &Scene, settings: &[Setting], threads: usize, repeats: usize) -> Vec<Drawn> {
    let [width, height] = scene.size;
    let mut screens: Vec<Screen> =
        settings.iter().map(|setting| Screen::new(width, height, &setting.options(threads))).collect();
    let draw = |screen: &mut Screen, setting: &Setting| frame(screen, |screen| scene.draw(screen, &setting.state()));
    let mut all: Vec<Drawn> = screens
        .iter_mut()
        .zip(settings)
        .map(|(screen, setting)| {
            let (_, events) = draw(screen, setting);
            let colour = screen.read().colour.into_iter().map(|pixel| pixel & 0x00FF_FFFF).collect();
            Drawn { colour, clocks: clocks(&events), events, nanoseconds: Vec::with_capacity(repeats) }
        })
        .collect();
    for _ in 0..repeats {
        for ((screen, setting), drawn) in screens.iter_mut().zip(settings).zip(&mut all) {
            drawn.nanoseconds.push(draw(screen, setting).0);
        }
    }
    all.iter_mut().for_each(|drawn| drawn.nanoseconds.sort_by(f64::total_cmp));
    all
}

/// How a picture differs from the exact one. The distance of a pixel is that of its farthest channel, levels of 255.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PictureError {
    /// Pixels.
    pub pixels: u64,
    /// Mean distance.
    pub mean: f64,
    /// One standard error of the mean, as if pixels were independent.
    pub standard_error: f64,
    /// Largest distance.
    pub maximum: f64,
    /// Pixels farther off than rounding to a level explains.
    pub wrong: u64,
}

impl PictureError {
    /// Share of wrong pixels, percent.
    #[must_use]
    pub fn rate(&self) -> f64 {
        100.0 * self.wrong as f64 / self.pixels.max(1) as f64
    }
}

/// Compares a picture with the exact one.
#[must_use]
pub fn error(truth: &Truth, colour: &[u32]) -> PictureError {
    let (mut sum, mut squares) = (0.0, 0.0);
    let mut found = PictureError { pixels: colour.len() as u64, ..PictureError::default() };
    for (pixel, shown) in colour.iter().enumerate() {
        let distance = truth.distance(pixel, *shown);
        (sum, squares) = (sum + distance, squares + distance * distance);
        found.maximum = found.maximum.max(distance);
        found.wrong += u64::from(truth.is_wrong(pixel, *shown));
    }
    let count = colour.len().max(1) as f64;
    found.mean = sum / count;
    found.standard_error = ((squares / count - found.mean * found.mean).max(0.0) / count).sqrt();
    found
}

/// One standard error of a rate of `wrong` in `samples`, percent. Where none or all are wrong: as if one more, or one
/// less, had been.
#[must_use]
pub fn error_of_rate(wrong: u64, samples: u64) -> f64 {
    let n = samples.max(1) as f64;
    let p = (wrong as f64 / n).clamp(1.0 / (n + 1.0), n / (n + 1.0));
    100.0 * (p * (1.0 - p) / n).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::scene::Kind;
    use super::super::truth::truth;
    use super::*;
    use crate::harness::Random;

    #[test]
    fn drawn_best_setting_is_the_exact_picture_of_its_samples() {
        for kind in Kind::ALL {
            let scene = kind.scene([40, 32], &mut Random::new(3)).snapped();
            let all = drawn(&scene, &[Setting::best(), Setting::centres()], 1, 1);
            let exact = error(&truth(&scene, [8, 8]), &all[0].colour);
            let coarse = error(&truth(&scene, [8, 8]), &all[1].colour);
            // Depths of 31 bits are rounded to 2^-32 of the range: that two planes tie so closely at a sample is rare.
            assert!(exact.wrong <= 2, "{kind:?}: {exact:?}");
            assert!(coarse.mean > 10.0 * exact.mean && all[1].clocks < all[0].clocks, "{kind:?}: {coarse:?}");
        }
    }

    #[test]
    fn error_of_rate_is_never_zero() {
        assert!((error_of_rate(50, 100) - 5.0).abs() < 1e-9);
        assert!(error_of_rate(0, 100) > 0.9 && error_of_rate(0, 100) < 1.1);
    }
}
