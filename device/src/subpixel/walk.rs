//! Edges walked over rows of samples, 16 rows at a time.
//!
//! Duties: from a triangle's edges the columns that its rows of samples begin and end with; from those, for the 2 or 4
//! rows of pixels that they are, which pixels are met, which are covered wholly, and the masks of the others. Inputs
//! from: [`super::piece`]. Outputs to: [`super::cover`], [`super::rows`]. Clocks: those of masks are counted when it is
//! known what is left ([`super::band`]).

use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u8x64, u32x16};

/// Columns of samples where an empty row begins; beyond every target.
const EMPTY: i32 = 1 << 24;

/// The edges of a triangle, walked on [`LANES`] rows at a time.
pub(super) struct Walks<S: Simd> {
    long: Steps<S>,
    upper: Steps<S>,
    lower: Steps<S>,
}

impl<S: Simd> Walks<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, t: &Triangle) -> Self {
        Walks {
            long: Steps::new(simd, t.long.step),
            upper: Steps::new(simd, t.short[0].step),
            lower: Steps::new(simd, t.short[1].step),
        }
    }

    /// Rows of samples from `row` on, inside `columns`.
    #[inline(always)]
    pub(super) fn ends(&self, simd: S, t: &Triangle, row: i32, columns: [i32; 2]) -> Ends<S> {
        let lane: i32x16<S> = u32x16::from_slice(simd, &LANE).bitcast();
        let long = self.long.columns(simd, t.long.walk(row - t.rows[0]), 0);
        let upper = self.upper.columns(simd, t.short[0].walk(row - t.rows[0]), 0);
        let lower = self.lower.columns(simd, t.short[1].walk(row - t.rows[1]), 0);
        let short = lane.simd_lt(t.rows[1] - row).select(upper, lower);
        let (from, to) = (long.min(short).max(columns[0]), long.max(short).min(columns[1]));
        let covered = from.simd_lt(to) & lane.simd_ge(t.rows[0] - row) & lane.simd_lt(t.rows[2] - row);
        let empty = i32x16::splat(simd, EMPTY);
        Ends { from: covered.select(from, empty), to: covered.select(to, -empty) }
    }
}

/// What a triangle covers on [`LANES`] rows of samples, a lane each: first columns and first beyond; of rows that are not
/// covered [`EMPTY`] and its negative.
#[derive(Clone, Copy)]
pub(super) struct Ends<S: Simd> {
    from: i32x16<S>,
    to: i32x16<S>,
}

/// The same in pixels, for each of the rows of pixels that these are.
pub(super) struct Pixels {
    /// Least first column of a row of pixels, for all of them; then the greatest first beyond, negative.
    outer: [i32; LANES],
    /// First column and first beyond of the pixels that are covered wholly, in the lane of a row's first samples.
    inner: [[i32; LANES]; 2],
}

impl<S: Simd> Ends<S> {
    /// Rows that cover nothing.
    #[inline(always)]
    pub(super) fn empty(simd: S) -> Self {
        let empty = i32x16::splat(simd, EMPTY);
        Ends { from: empty, to: -empty }
    }

    /// First column and first beyond on the first row.
    #[inline(always)]
    pub(super) fn first(&self) -> [i32; 2] {
        [self.from[0], self.to[0]]
    }

    /// The pixels that are met, of `C` x `R` samples each.
    #[inline(always)]
    pub(super) fn pixels<const C: usize, const R: usize>(&self) -> Pixels {
        let (from, to) = (self.from, self.to);
        // Neighbouring rows together, until a lane stands for all rows of a pixel.
        let beyond = -to;
        let pairs = from.unzip_low(beyond).min(from.unzip_high(beyond));
        let fours = pairs.unzip_low(pairs).min(pairs.unzip_high(pairs));
        let outer = if R == 8 { fours.unzip_low(fours).min(fours.unzip_high(fours)) } else { fours };
        // The left border is convex and the right one concave: what all rows cover, the first and the last do.
        let [last_from, last_to] = if R == 8 {
            [from.slide::<7>(from), to.slide::<7>(to)]
        } else {
            [from.slide::<3>(from), to.slide::<3>(to)]
        };
        let mut pixels = Pixels { outer: [0; LANES], inner: [[0; LANES]; 2] };
        outer.store_slice(&mut pixels.outer);
        ((from.max(last_from) + (C as i32 - 1)) >> C.ilog2()).store_slice(&mut pixels.inner[0]);
        (to.min(last_to) >> C.ilog2()).store_slice(&mut pixels.inner[1]);
        pixels
    }

    /// Rows of pixels on which the triangle may cover a pixel's centre and none of the pixel's samples; `row` is the
    /// first row of samples. A bit a row of samples, that below the centres.
    ///
    /// The centres lie half-way between two rows of samples. Where no vertex lies between these, both sides of the
    /// triangle are straight there, and what it covers on the centres' row is the mean of what it covers on the two. A
    /// centre whose four samples are not covered then has a row that is too narrow to meet one, or one row ends before
    /// it and the other begins behind it.
    #[inline(always)]
    pub(super) fn misses(&self, t: &Triangle, row: i32) -> u32 {
        let (from, to) = (self.from, self.to);
        let narrow = (to - from).simd_lt(2).to_bitmask() as u32;
        let apart = to.simd_le(from.slide::<1>(from)) | to.slide::<1>(to).simd_le(from);
        let pairs = narrow << 1 | narrow | (apart.to_bitmask() as u32) << 1;
        let [top, middle, bottom] = t.rows.map(|vertex| vertex - row);
        let inside = low_bits(bottom) & !low_bits(top.saturating_add(1));
        let bit = |at: i32| low_bits(at + 1) & !low_bits(at);
        (pairs & inside) | bit(top) | bit(middle) | bit(bottom)
    }
}

impl Pixels {
    /// Pixels that are met on row `k`: the first column, and the first beyond; from more to less if there are none.
    #[inline(always)]
    pub(super) fn met<const C: usize, const R: usize>(&self, k: usize) -> [i32; 2] {
        let shift = C.ilog2();
        [self.outer[k] >> shift, (C as i32 - 1 - self.outer[k + LANES / R]) >> shift]
    }

    /// Those that are covered wholly.
    #[inline(always)]
    pub(super) fn whole<const R: usize>(&self, k: usize) -> [i32; 2] {
        [self.inner[0][k * R], self.inner[1][k * R]]
    }
}

/// Pixels that a [`Slot`] reaches: their columns of samples count to less than 255.
pub(super) const REACH: i32 = 31;

/// What all samples of some rows of pixels are told from: each has a lane of 8 bits, lane k is bit k of a mask.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Slot {
    /// The columns that the samples' rows begin and end with, counted from a pixel's first.
    ends: [[u8; 64]; 2],
}

impl<S: Simd> Ends<S> {
    /// Adds slots for [`REACH`] pixels from `base` on.
    #[inline(always)]
    pub(super) fn slots<const C: usize>(&self, simd: S, base: i32, slots: &mut Vec<Slot>) {
        let base = i32x16::splat(simd, base * C as i32);
        let (from, to) = (in_bytes::<S, C>(self.from - base), in_bytes::<S, C>(self.to - base));
        for k in 0..C / 4 {
            let mut slot = Slot { ends: [[0; 64]; 2] };
            from[k].store_slice(&mut slot.ends[0]);
            to[k].store_slice(&mut slot.ends[1]);
            slots.push(slot);
        }
    }
}

/// Columns of rows of samples as a lane each sample has, lane 0 is one of the last row.
#[inline(always)]
fn in_bytes<S: Simd, const C: usize>(columns: i32x16<S>) -> [u8x64<S>; 2] {
    let columns: u32x16<S> = columns.max(0).min(255).reverse().bitcast();
    let four = columns * 0x0101_0101;
    if C == 8 {
        [four.zip_high(four).bitcast(), four.zip_low(four).bitcast()]
    } else {
        [four.bitcast(), four.bitcast()]
    }
}

impl Slot {
    /// Rows of pixels of a slot.
    #[inline(always)]
    pub(super) const fn rows(columns: usize, rows: usize) -> usize {
        64 / (columns * rows)
    }

    /// Samples that are covered of a pixel on row `number` of those that are walked together, by its first column,
    /// counted as the slot's are; modulo 256.
    #[inline(always)]
    pub(super) fn mask<S: Simd, const C: usize, const R: usize>(&self, simd: S, number: usize, column: u32) -> u64 {
        let rows = Slot::rows(C, R);
        let shift = (rows - 1 - number % rows) * C * R;
        let samples: [u8; 64] = std::array::from_fn(|lane| (C - 1 - lane % C) as u8);
        let columns = u8x64::from_slice(simd, &samples) + column as u8;
        let [from, to] = &self.ends;
        let covered = u8x64::from_slice(simd, from).simd_le(columns) & u8x64::from_slice(simd, to).simd_gt(columns);
        (covered.to_bitmask() >> shift) & (u64::MAX >> (64 - C * R))
    }
}

/// As many bits as `count`, at most 16.
#[inline(always)]
fn low_bits(count: i32) -> u32 {
    (1 << count.clamp(0, LANES as i32)) - 1
}
