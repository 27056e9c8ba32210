//! The search for the nearest or the farthest sub-pixel of a fragment.
//!
//! Source: JP 2569952 B2 (1990).
//!
//! Duties: given the fraction mask of a polygon in a pixel (which samples it covers) and the signs of dz/dx and
//! dz/dy, find one or two samples that stand for the extreme of its depth, so that the plane equation is
//! evaluated there alone.
//!
//! The signs say at which corner of the pixel the plane is nearest (or farthest): the *start corner*. The *search
//! mask* is a band of samples across the diagonal from that corner. Band k holds the samples whose distance in
//! columns plus distance in rows from the start corner is k; band 0 is the corner alone. From band 0 on, the
//! search mask AND the fraction mask is looked at, until it is not 0. Its first and its last sample along the band
//! are the *ends*; depth changes linearly along the band, so the extreme of the band is at one of them.
//!
//! ```text
//!   4x4, start corner upper right: bands             fraction mask 0x0842: band 4, ends e
//!      3  2  1  0                                       .  .  .  .
//!      4  3  2  1                                       e  .  .  .     (-6, -2) in 1/16 pixel, y down
//!      5  4  3  2                                       .  x  .  .
//!      6  5  4  3                                       .  .  e  .     (2, 6)
//! ```
//!
//! # How exact it is
//! The search takes the extreme of the first band that it meets, not of the mask. Where a step of one column and
//! a step of one row change the depth by as much (|dz/dx| = |dz/dy| on 4x4 and 8x8, |dz/dx| = 2 |dz/dy| on 8x4)
//! a band has one depth and the search is exact for any mask; so it is where the start corner is covered.
//! Elsewhere a sample of a farther band can be the true extreme. The nearest depth that is found can then even lie
//! behind the farthest one that is found; [`range_of`] puts the two in order.
//!
//! A slope of 0 counts as positive.
//!
//! Inputs from: the mask generator (fraction mask), set-up (slopes).
//! Outputs to: the merge and pack stages (depths), the account (bands looked at, depths evaluated).
//!
//! Clocks: one for each band looked at, one for each depth evaluated; [`super::search_clocked`] steps them.

use super::grid::{Grid, Offset};
#[cfg(test)]
use crate::probe::account::Clocks;

/// Entries of a table of bands: 15 bands of the largest grid, and none.
const BANDS: usize = 16;

/// Which depth is looked for. Near is small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extreme {
    /// The smallest depth.
    Nearest,
    /// The largest depth.
    Farthest,
}

/// A corner of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Column 0, row 0.
    UpperLeft,
    /// Last column, row 0.
    UpperRight,
    /// Column 0, last row.
    LowerLeft,
    /// Last column, last row.
    LowerRight,
}

impl Corner {
    /// All corners, in the order of their values.
    pub const ALL: [Corner; 4] = [Corner::UpperLeft, Corner::UpperRight, Corner::LowerLeft, Corner::LowerRight];

    /// The start corner for slopes `[dz/dx, dz/dy]`, x to the right and y down, in any unit. A slope of 0 counts as
    /// positive.
    #[must_use]
    pub const fn start(slopes: [i64; 2], extreme: Extreme) -> Corner {
        let farthest = matches!(extreme, Extreme::Farthest);
        let (right, lower) = ((slopes[0] < 0) != farthest, (slopes[1] < 0) != farthest);
        Corner::ALL[lower as usize * 2 + right as usize]
    }

    /// At the right edge of the pixel.
    #[must_use]
    pub const fn is_right(self) -> bool {
        self as usize & 1 != 0
    }

    /// At the lower edge of the pixel.
    #[must_use]
    pub const fn is_lower(self) -> bool {
        self as usize & 2 != 0
    }

    /// The band that a sample is in when the search starts here.
    #[must_use]
    pub const fn band_of(self, grid: Grid, sample: u32) -> u32 {
        let (column, row) = (sample % grid.columns(), sample / grid.columns());
        let columns = if self.is_right() { grid.columns() - 1 - column } else { column };
        let rows = if self.is_lower() { grid.rows() - 1 - row } else { row };
        columns + rows
    }
}

/// Search masks: \[grid\]\[corner\]\[band\].
static SEARCH_MASKS: [[[u64; BANDS]; 4]; 3] = bands(false);

/// Search masks of a band and all before it: \[grid\]\[corner\]\[band\]. The last entry is the whole pixel.
static SWEPT: [[[u64; BANDS]; 4]; 3] = bands(true);

/// Where the samples are: \[grid\]\[sample\].
static OFFSETS: [[Offset; 64]; 3] = offsets();

/// The samples in band k, or in the bands up to k.
const fn bands(swept: bool) -> [[[u64; BANDS]; 4]; 3] {
    let mut table = [[[0; BANDS]; 4]; 3];
    let mut of_grid = 0;
    while of_grid < 3 {
        let grid = Grid::ALL[of_grid];
        let mut of_corner = 0;
        while of_corner < 4 {
            let mut sample = 0;
            while sample < grid.samples() {
                let mut band = Corner::ALL[of_corner].band_of(grid, sample) as usize;
                table[of_grid][of_corner][band] |= grid.sample_bit(sample);
                while swept && band < BANDS - 1 {
                    band += 1;
                    table[of_grid][of_corner][band] |= grid.sample_bit(sample);
                }
                sample += 1;
            }
            of_corner += 1;
        }
        of_grid += 1;
    }
    table
}

const fn offsets() -> [[Offset; 64]; 3] {
    let mut table = [[Offset { x: 0, y: 0 }; 64]; 3];
    let mut of_grid = 0;
    while of_grid < 3 {
        let grid = Grid::ALL[of_grid];
        let mut sample = 0;
        while sample < grid.samples() {
            table[of_grid][sample as usize] = grid.offset(sample);
            sample += 1;
        }
        of_grid += 1;
    }
    table
}

/// The search mask of a band; 0 past the last band of the grid.
#[cfg(test)]
#[must_use]
pub fn search_mask(grid: Grid, corner: Corner, band: u32) -> u64 {
    SEARCH_MASKS[grid.index()][corner as usize].get(band as usize).copied().unwrap_or(0)
}

/// The offset table.
///
/// # Panics
/// If the grid has no such sample. All that [`search`] returns are samples of its grid.
#[must_use]
#[inline(always)]
pub fn offset_of(grid: Grid, sample: u32) -> Offset {
    OFFSETS[grid.index()][..grid.samples() as usize][sample as usize]
}

/// What a search finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// The uppermost sample of the band that the mask covers.
    pub first: u32,
    /// The lowest one; the same where the mask covers one only.
    pub last: u32,
    /// Bands looked at: 1 where the start corner is covered.
    pub steps: u32,
}

impl Found {
    /// Depths to be evaluated: 1 or 2.
    #[must_use]
    pub const fn evaluations(&self) -> u32 {
        1 + (self.first != self.last) as u32
    }
}

/// Searches a mask band by band: the specification of [`search`]. `None` where the mask covers nothing. Bits that are
/// no samples of the grid do not count.
#[cfg(test)]
#[must_use]
pub fn search_by_bands(grid: Grid, mask: u64, corner: Corner) -> Option<Found> {
    let bands = grid.columns() + grid.rows() - 1;
    (0..bands).map(|band| (band, mask & search_mask(grid, corner, band))).find(|&(_, hit)| hit != 0).map(
        |(band, hit)| {
            let [first, last] = ends(grid, hit);
            Found { first, last, steps: band + 1 }
        },
    )
}

/// Searches a mask: what [`search_by_bands`] finds.
///
/// The bands up to k hold a sample of the mask from the band on that is looked for: four halvings find it, with no
/// branch that depends on the mask.
#[must_use]
#[inline(always)]
pub fn search(grid: Grid, mask: u64, corner: Corner) -> Option<Found> {
    let swept = &SWEPT[grid.index()][corner as usize];
    if mask & swept[BANDS - 1] == 0 {
        return None;
    }
    let mut band = 0;
    for half in [8, 4, 2, 1] {
        band += half * usize::from(mask & swept[band + half - 1] == 0);
    }
    let [first, last] = ends(grid, mask & SEARCH_MASKS[grid.index()][corner as usize][band]);
    Some(Found { first, last, steps: band as u32 + 1 })
}

/// The first and the last sample of a mask that is not 0. A band has one sample a row at most, and bits go by rows.
#[inline(always)]
pub(super) fn ends(grid: Grid, hit: u64) -> [u32; 2] {
    let last = grid.samples() - 1;
    [last - hit.ilog2(), last - hit.trailing_zeros()]
}

/// A depth that a search leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Evaluated {
    /// The nearer or the farther of the depths at the ends.
    pub depth: i32,
    /// Bands looked at.
    pub steps: u32,
    /// Depths evaluated: 1 or 2.
    pub evaluations: u32,
}

impl Evaluated {
    /// Clocks of the unit: one a band looked at, one a depth evaluated.
    #[cfg(test)]
    #[must_use]
    pub const fn clocks(&self) -> Clocks {
        Clocks((self.steps + self.evaluations) as u64)
    }
}

/// The nearest or the farthest depth of a fragment as the search has it. `slopes` as in [`Corner::start`]; `depth` is
/// the depth at a sample, called once for each end. `None` where the mask covers nothing.
#[inline(always)]
pub fn extreme_of(
    grid: Grid,
    mask: u64,
    slopes: [i64; 2],
    extreme: Extreme,
    mut depth: impl FnMut(Offset) -> i32,
) -> Option<Evaluated> {
    let found = search(grid, mask, Corner::start(slopes, extreme))?;
    let mut best = depth(offset_of(grid, found.first));
    if found.first != found.last {
        best = extreme.of(best, depth(offset_of(grid, found.last)));
    }
    Some(Evaluated { depth: best, steps: found.steps, evaluations: found.evaluations() })
}

impl Extreme {
    /// The nearer or the farther of two depths.
    #[must_use]
    pub fn of(self, a: i32, b: i32) -> i32 {
        match self {
            Extreme::Nearest => a.min(b),
            Extreme::Farthest => a.max(b),
        }
    }
}

/// Depths of a fragment as two searches have them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthRange {
    /// The nearer of the two depths found.
    pub nearest: i32,
    /// The farther one, inclusive.
    pub farthest: i32,
    /// Bands looked at by both searches.
    pub steps: u32,
    /// Depths evaluated by both searches: 2 to 4.
    pub evaluations: u32,
}

/// The range of depths of a fragment, by two searches. `None` where the mask covers nothing.
pub fn range_of(grid: Grid, mask: u64, slopes: [i64; 2], mut depth: impl FnMut(Offset) -> i32) -> Option<DepthRange> {
    let near = extreme_of(grid, mask, slopes, Extreme::Nearest, &mut depth)?;
    let far = extreme_of(grid, mask, slopes, Extreme::Farthest, &mut depth)?;
    Some(DepthRange {
        nearest: near.depth.min(far.depth),
        farthest: near.depth.max(far.depth),
        steps: near.steps + far.steps,
        evaluations: near.evaluations + far.evaluations,
    })
}
