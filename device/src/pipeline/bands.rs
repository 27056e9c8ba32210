//! Surfaces: rows of a frame and of what is kept beside it, cut into bands that are drawn apart.
//!
//! A band is one row of host tiles. Bands share nothing, so any number of threads gives the same
//! picture and the same counts.

use crate::hidden::z_buffer::band::Setting;
use crate::hidden::z_buffer::tile::TILE;
use std::ops::Range;

/// One plane: the rows of some bands. A plane that a path has no use for is empty.
#[derive(Debug)]
pub struct Plane<'m, T> {
    /// The rows.
    pub rows: &'m mut [T],
    /// Elements of a band; the last one can have fewer.
    band: usize,
}

impl<'m, T> Plane<'m, T> {
    /// A plane of rows of `pitch` elements, from the rows of band `first` on.
    pub fn new(rows: &'m mut [T], pitch: usize, first: usize) -> Self {
        Plane::of_bands(rows, pitch * TILE, first)
    }

    /// A plane of bands of `band` elements, from band `first` on.
    pub fn of_bands(rows: &'m mut [T], band: usize, first: usize) -> Self {
        Plane { rows: rows.get_mut(first * band..).unwrap_or_default(), band }
    }

    /// A plane that is not there.
    #[must_use]
    pub fn none() -> Self {
        Plane { rows: &mut [], band: 0 }
    }

    /// The first `bands` bands, and those after them.
    fn split(self, bands: usize) -> (Self, Self) {
        let middle = (bands * self.band).min(self.rows.len());
        let (low, high) = self.rows.split_at_mut(middle);
        (Plane { rows: low, band: self.band }, Plane { rows: high, band: self.band })
    }
}

/// All planes of some bands.
#[derive(Debug)]
pub struct Surfaces<'m> {
    /// Frame buffer, words.
    pub colour: Plane<'m, u32>,
    /// Depths; none where depth is not called for.
    pub depth: Plane<'m, i32>,
    /// Stencil values; none where no stencil test is called for.
    pub stencil: Plane<'m, u8>,
    /// Za words, of paths that have them.
    pub words: Plane<'m, i32>,
    /// What a path that shades late knows of its pixels.
    pub sight: Sight<'m>,
}

/// What the functional model of a path that shades late keeps of each pixel and line; all empty for the
/// others.
#[derive(Debug)]
pub struct Sight<'m> {
    /// Pixels that something was drawn to: a bit each, lowest leftmost; rows of whole chunks of 16.
    pub winner: Plane<'m, u16>,
    /// Pixels whose colour is interpolated, in the same way.
    pub late: Plane<'m, u16>,
    /// Plane segments on each line.
    pub tokens: Plane<'m, u32>,
    /// By what more than colours each pixel is shaded: a place in the path's list of costs, plus 1; 0 is nothing. Rows
    /// of whole chunks, and only once a draw has called for more.
    pub costs: Plane<'m, u16>,
    /// What the draw at hand notes there.
    pub cost: u16,
}

impl Sight<'_> {
    /// Nothing is kept.
    #[must_use]
    pub fn none() -> Self {
        let (costs, cost) = (Plane::none(), 0);
        Sight { winner: Plane::none(), late: Plane::none(), tokens: Plane::none(), costs, cost }
    }

    /// Notes one pixel that a draw has won, for planes that begin with row 0.
    pub fn note(&mut self, setting: &Setting, x: usize, y: usize) {
        let chunks = (setting.width as usize).div_ceil(16);
        let at = y * chunks + x / 16;
        let bit = 1_u16 << (x % 16);
        if let Some(cost) = self.costs.rows.get_mut(y * chunks * 16 + x) {
            *cost = self.cost;
        }
        if let (Some(winner), Some(late)) = (self.winner.rows.get_mut(at), self.late.rows.get_mut(at)) {
            *winner |= bit;
            *late = if setting.is_shaded() { *late | bit } else { *late & !bit };
        }
    }

    /// Whether anything is kept.
    #[must_use]
    #[inline(always)]
    pub fn is_kept(&self) -> bool {
        !self.tokens.rows.is_empty()
    }
}

impl Surfaces<'_> {
    fn split(self, bands: usize) -> (Self, Self) {
        let (colour, colour_after) = self.colour.split(bands);
        let (depth, depth_after) = self.depth.split(bands);
        let (stencil, stencil_after) = self.stencil.split(bands);
        let (words, words_after) = self.words.split(bands);
        let (winner, winner_after) = self.sight.winner.split(bands);
        let (late, late_after) = self.sight.late.split(bands);
        let (tokens, tokens_after) = self.sight.tokens.split(bands);
        let (costs, costs_after) = self.sight.costs.split(bands);
        let cost = self.sight.cost;
        (
            Surfaces { colour, depth, stencil, words, sight: Sight { winner, late, tokens, costs, cost } },
            Surfaces {
                colour: colour_after,
                depth: depth_after,
                stencil: stencil_after,
                words: words_after,
                sight: Sight { winner: winner_after, late: late_after, tokens: tokens_after, costs: costs_after, cost },
            },
        )
    }
}

/// Events that add up over bands.
pub trait Counts: Default + Send {
    /// The sum of two counts.
    #[must_use]
    fn plus(self, other: Self) -> Self;
}

/// Has bands `bands` of `planes` drawn, halves on two threads if `parallel`; adds up their counts.
pub fn each_band<C: Counts>(
    parallel: bool,
    planes: Surfaces<'_>,
    bands: Range<usize>,
    draw: &(impl Fn(usize, Surfaces<'_>) -> C + Sync),
) -> C {
    match bands.len() {
        0 => C::default(),
        1 => draw(bands.start, planes),
        count => {
            let (low, high) = planes.split(count / 2);
            let middle = bands.start + count / 2;
            let low = || each_band(parallel, low, bands.start..middle, draw);
            let high = || each_band(parallel, high, middle..bands.end, draw);
            let (low, high) = if parallel { rayon::join(low, high) } else { (low(), high()) };
            low.plus(high)
        }
    }
}
