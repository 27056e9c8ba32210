//! The picture with unrounded depths: which primitive is in front according to the exact planes, and by how much.
//!
//! Coverage is that of the rules; only the depth test compares rationals. Where the two nearest surfaces are within one
//! step of each other the stored depths may tie or swap, so the pixel is *ambiguous*: the card's answer there is
//! judged by how much depth it gave away ([`TrueImage::judge`]), not by identity.
//!
//! [`draw_true_plain`] says it in so many words; [`draw_true`] is the same faster (`ranking`).

use std::cmp::Ordering;

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::bands;
use super::depth::TrueDepth;
use super::exact::Fraction;
use super::raster::{Rows, covers, for_each_pixel};
use super::{DepthFormat, DepthFunction, Primitive};

#[path = "ranking.rs"]
mod ranking;

/// A depth and whose it is; `None` for the cleared background at depth `2^n - 1`.
type Surface = (Fraction, Option<u32>);

/// The exact answer for each pixel, row by row from the top.
#[derive(Clone, Debug)]
pub struct TrueImage {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// What a cleared pixel holds, in steps.
    pub cleared: u32,
    /// Who passed last: position in submission order.
    pub winner: Vec<Option<u32>>,
    /// The winner's exact depth, or the clear depth.
    pub depth: Vec<Fraction>,
    /// The next surface behind the winner (for the `Less` pair) or before it (for the `Greater` pair); `None` also
    /// when that is the background, and for the other functions.
    pub runner_up: Vec<Option<u32>>,
    /// For the `Less` and `Greater` pairs the distance from the winner to the runner-up or the background, for `Equal`
    /// and `NotEqual` the narrowest comparison made, in steps, to about 15 digits; infinite without a rival.
    pub gap_in_steps: Vec<f64>,
    /// Whether that gap is at most one step; decided exactly.
    pub ambiguous: Vec<bool>,
}

/// How a card's winners compare with the true ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Pixels with the true winner.
    pub same: usize,
    /// Pixels with another winner whose depth is at most the allowed distance from the true winner's.
    pub within: usize,
    /// The other pixels.
    pub wrong: usize,
    /// Pixels, counted in `wrong` as well, whose winner does not cover them.
    pub uncovered: usize,
    /// The largest distance between the shown and the true winner's depth, in steps.
    pub largest_loss: BigRational,
    /// Column and row of the first wrong pixel.
    pub first_wrong: Option<(u32, u32)>,
}

impl TrueImage {
    /// Compares winners with the true ones. A different winner is allowed `allowed` steps of depth; two planes that
    /// are each stored within `1/2 + bound` of the truth can swap when they are within `1 + 2 bound`.
    ///
    /// # Panics
    /// When `winners` has not one entry for each pixel.
    #[must_use]
    pub fn judge(&self, primitives: &[Primitive], winners: &[Option<u32>], allowed: &BigRational) -> Verdict {
        assert_eq!(winners.len(), self.winner.len(), "one winner for each pixel");
        let mut verdict = Verdict {
            same: 0,
            within: 0,
            wrong: 0,
            uncovered: 0,
            largest_loss: BigRational::zero(),
            first_wrong: None,
        };
        for (pixel, winner) in winners.iter().enumerate() {
            if *winner == self.winner[pixel] {
                verdict.same += 1;
                continue;
            }
            let i = (pixel % self.width as usize) as u32;
            let j = (pixel / self.width as usize) as u32;
            let loss = self.depth_of(primitives, *winner, i, j).map(|depth| depth.minus(self.depth[pixel]).abs());
            verdict.uncovered += usize::from(loss.is_none());
            if loss.as_ref().is_some_and(|loss| loss <= allowed) {
                verdict.within += 1;
            } else {
                verdict.wrong += 1;
                verdict.first_wrong.get_or_insert((i, j));
            }
            verdict.largest_loss = verdict.largest_loss.max(loss.unwrap_or_default());
        }
        verdict
    }

    /// The exact depth of a claimed winner; `None` when it does not cover the pixel.
    fn depth_of(&self, primitives: &[Primitive], winner: Option<u32>, i: u32, j: u32) -> Option<Fraction> {
        let Some(index) = winner else {
            return Some(Fraction::whole(self.cleared.into()));
        };
        let primitive = primitives.get(index as usize)?;
        let (i, j) = (i as i32, j as i32);
        covers(primitive, i, j).then(|| TrueDepth::new(primitive).map(|depth| depth.at(i, j)))?
    }
}

/// A pixel while the scene is drawn.
#[derive(Clone, Copy)]
struct Pixel {
    held: Surface,
    /// The best of the surfaces that are not held (functions that order).
    second: Option<Surface>,
    /// The narrowest comparison, and how narrow to about 15 digits (functions that ask for equality).
    narrowest: Option<(Fraction, Fraction, f64)>,
}

impl Pixel {
    fn cleared(format: DepthFormat) -> Self {
        Self { held: (Fraction::whole(format.greatest().into()), None), second: None, narrowest: None }
    }

    fn take(&mut self, new: Surface, function: DepthFunction) {
        let passes = function.passes(&new.0, &self.held.0);
        match function {
            DepthFunction::Never | DepthFunction::Always => {}
            DepthFunction::Equal | DepthFunction::NotEqual => self.narrow(new.0),
            DepthFunction::Less | DepthFunction::LessEqual => {
                self.rank(if passes { self.held } else { new }, Ordering::Less);
            }
            DepthFunction::Greater | DepthFunction::GreaterEqual => {
                self.rank(if passes { self.held } else { new }, Ordering::Greater);
            }
        }
        if passes {
            self.held = new;
        }
    }

    /// Keeps the loser if it is better than the losers so far.
    fn rank(&mut self, loser: Surface, better: Ordering) {
        if self.second.is_none_or(|second| loser.0.cmp(&second.0) == better) {
            self.second = Some(loser);
        }
    }

    fn narrow(&mut self, new: Fraction) {
        let held = self.held.0;
        let about = new.distance(held).0;
        let narrower = self.narrowest.is_none_or(|(a, b, old)| {
            // Two distances that differ by more than their roundings need no exact comparison.
            let clear = (about - old).abs() > (about + old) * 1e-12;
            if clear { about < old } else { new.minus(held).abs() < a.minus(b).abs() }
        });
        if narrower {
            self.narrowest = Some((new, held, about));
        }
    }

    fn gap(&self) -> (f64, bool) {
        let rivals = self.narrowest.map(|(a, b, _)| (a, b));
        let rivals = rivals.or(self.second.map(|second| (self.held.0, second.0)));
        rivals.map_or((f64::INFINITY, false), |(a, b)| {
            let (steps, order) = a.distance(b);
            (steps, order != Ordering::Greater)
        })
    }
}

impl TrueImage {
    /// What pixels hold in the end.
    fn of([width, height]: [u32; 2], format: DepthFormat, pixels: &[Pixel]) -> Self {
        let gaps: Vec<(f64, bool)> = pixels.iter().map(Pixel::gap).collect();
        Self {
            width,
            height,
            cleared: format.greatest(),
            winner: pixels.iter().map(|pixel| pixel.held.1).collect(),
            depth: pixels.iter().map(|pixel| pixel.held.0).collect(),
            runner_up: pixels.iter().map(|pixel| pixel.second.and_then(|second| second.1)).collect(),
            gap_in_steps: gaps.iter().map(|gap| gap.0).collect(),
            ambiguous: gaps.iter().map(|gap| gap.1).collect(),
        }
    }
}

/// Draws a scene on a cleared target of `width` x `height` pixels with unrounded depths. Of `format` only the clear
/// depth counts.
#[must_use]
pub fn draw_true(
    width: u32,
    height: u32,
    primitives: &[Primitive],
    format: DepthFormat,
    function: DepthFunction,
) -> TrueImage {
    let pixels = width as usize * height as usize;
    let mut pixels = vec![Pixel::cleared(format); pixels];
    if pixels.is_empty() {
        return TrueImage::of([width, height], format, &pixels);
    }
    let set_up: Vec<(Rows, Option<TrueDepth>)> =
        primitives.iter().map(|primitive| (Rows::new(primitive, width, height), TrueDepth::new(primitive))).collect();
    let bins = bands::bins(height, set_up.iter().map(|(rows, _)| rows.rows()));
    let bands = (0..).zip(pixels.chunks_mut((bands::ROWS * width) as usize)).zip(bins);
    let work = set_up.iter().map(|(rows, _)| rows.work()).sum();
    bands::each(bands, work, |((band, pixels), bin): ((u32, &mut [Pixel]), Vec<u32>)| {
        let place = ranking::Place { top: band * bands::ROWS, width };
        match function {
            DepthFunction::Less | DepthFunction::LessEqual => {
                ranking::draw(pixels, place, &set_up, &bin, function, Ordering::Less);
            }
            DepthFunction::Greater | DepthFunction::GreaterEqual => {
                ranking::draw(pixels, place, &set_up, &bin, function, Ordering::Greater);
            }
            DepthFunction::Never | DepthFunction::Equal | DepthFunction::NotEqual | DepthFunction::Always => {
                ranking::for_each(pixels, place, &set_up, &bin, |pixel, new| pixel.take(new, function));
            }
        }
    });
    TrueImage::of([width, height], format, &pixels)
}

/// [`draw_true`] by definition: primitive by primitive, pixel by pixel, every comparison one of fractions.
#[must_use]
pub fn draw_true_plain(
    width: u32,
    height: u32,
    primitives: &[Primitive],
    format: DepthFormat,
    function: DepthFunction,
) -> TrueImage {
    let mut pixels = vec![Pixel::cleared(format); width as usize * height as usize];
    for (index, primitive) in (0..).zip(primitives) {
        let Some(depth) = TrueDepth::new(primitive) else {
            continue;
        };
        for_each_pixel(primitive, width, height, |i, j| {
            let pixel = &mut pixels[j as usize * width as usize + i as usize];
            pixel.take((depth.at(i as i32, j as i32), Some(index)), function);
        });
    }
    TrueImage::of([width, height], format, &pixels)
}

#[cfg(test)]
#[path = "truth_tests.rs"]
mod tests;
