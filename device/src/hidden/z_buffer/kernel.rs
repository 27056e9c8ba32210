//! Row kernels of the Z buffer: 16 pixels of a triangle's row at a time.
//!
//! A stored depth is the upper half of a 64-bit value that grows by `dx` a pixel. The lanes hold
//! upper and lower halves apart: lane k adds k * dx to both and carries where the lower half
//! overflowed, so 32-bit lanes give the bits of the 64-bit sum. Identifiers of the primitives that
//! won are kept beside the depths; colours come later, once for each pixel ([`crate::shading`]).
//!
//! Everything here must equal [`super::specification`] bit for bit at every SIMD level.

use super::DepthTest;
use super::tile::{TILE, Tile};
use crate::geometry::plane::DepthPlane;
use crate::geometry::triangle::{Triangle, WALK};
use fearless_simd::prelude::*;
use fearless_simd::{i32x16, mask32x16, u32x16};
use std::ops::Range;

/// Pixels that are tested together.
pub const LANES: usize = 16;

/// Numbers of the lanes.
pub(crate) const LANE: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Depth test `less`, depth written.
pub const LESS: u8 = 0;
/// Any depth test, depth written or not.
pub const GENERAL: u8 = 1;
/// No depth buffer: everything passes.
pub const NO_DEPTH: u8 = 2;
/// Any depth test on values that do not fit in two halves (depths of 31 bits): scalar.
pub const WIDE: u8 = 3;

/// Lane k's share of a value that grows from lane to lane: k steps in two halves.
pub(crate) struct Steps<S: Simd> {
    high: i32x16<S>,
    low: u32x16<S>,
}

impl<S: Simd> Steps<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, step: i64) -> Self {
        let lane = u32x16::from_slice(simd, &LANE);
        // k * low as 64 bits from 16-bit pieces: k < 16 leaves room in 32.
        let (low, high) = (step as u32, (step >> 32) as u32);
        let middle = lane * (low >> 16) + ((lane * (low & 0xFFFF)) >> 16_u32);
        let high = lane * high + (middle >> 16_u32);
        Steps { high: high.bitcast(), low: lane * low }
    }

    /// Upper halves of `value` + k steps.
    #[inline(always)]
    pub(crate) fn upper(&self, simd: S, value: i64) -> i32x16<S> {
        let base = u32x16::splat(simd, value as u32);
        let carried = (base + self.low).simd_lt(base);
        let high = self.high + i32x16::splat(simd, (value >> 32) as i32);
        carried.select(high + 1, high)
    }

    /// Upper halves of `value` + k steps, and of the same and `range` more.
    #[inline(always)]
    pub(crate) fn range(&self, simd: S, value: i64, range: i64) -> [i32x16<S>; 2] {
        let base = u32x16::splat(simd, value as u32);
        let low = base + self.low;
        let high = self.high + i32x16::splat(simd, (value >> 32) as i32);
        let near = low.simd_lt(base).select(high + 1, high);
        let more = u32x16::splat(simd, range as u32);
        let high = near + i32x16::splat(simd, (range >> 32) as i32);
        [near, (low + more).simd_lt(more).select(high + 1, high)]
    }

    /// Columns of an edge on [`LANES`] rows, counted from column `x`: the integer part of a walk lies in
    /// the upper half of its 64 bits.
    #[inline(always)]
    pub(crate) fn columns(&self, simd: S, walk: i64, x: i32) -> i32x16<S> {
        (self.upper(simd, walk) >> (WALK - 32)) - x
    }
}

/// What of a triangle all rows share.
pub(in crate::hidden) struct Lanes<S: Simd> {
    steps: Steps<S>,
    minimum: i32x16<S>,
    maximum: i32x16<S>,
    id: u32x16<S>,
    lane: u32x16<S>,
    less: mask32x16<S>,
    equal: mask32x16<S>,
    greater: mask32x16<S>,
    write: bool,
    dx: i64,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(in crate::hidden) fn new(simd: S, plane: &DepthPlane, id: u32, test: DepthTest) -> Self {
        Lanes {
            steps: Steps::new(simd, plane.dx),
            minimum: i32x16::splat(simd, plane.minimum),
            maximum: i32x16::splat(simd, plane.maximum),
            id: u32x16::splat(simd, id),
            lane: u32x16::from_slice(simd, &LANE),
            less: mask32x16::splat(simd, test.less),
            equal: mask32x16::splat(simd, test.equal),
            greater: mask32x16::splat(simd, test.greater),
            write: test.write,
            dx: plane.dx,
        }
    }

    /// Depths of a chunk whose lane 0 has value `value`.
    #[inline(always)]
    pub(in crate::hidden) fn depths(&self, simd: S, value: i64) -> i32x16<S> {
        self.steps.upper(simd, value).max(self.minimum).min(self.maximum)
    }

    /// Tests lanes `from..from + count` of a chunk (`from` modulo 2^32); returns a bit for each that passed,
    /// none without a depth buffer.
    ///
    /// `SKIP` looks first whether any did: worth it where whole layers are hidden.
    #[inline(always)]
    pub(in crate::hidden) fn chunk<const MODE: u8, const SKIP: bool>(
        &self,
        simd: S,
        depth: &mut [i32],
        ids: &mut [u32],
        z: i32x16<S>,
        from: u32,
        count: u32,
    ) -> u32 {
        let inside = (self.lane - from).simd_lt(u32x16::splat(simd, count));
        if MODE == NO_DEPTH {
            inside.select(self.id, u32x16::from_slice(simd, ids)).store_slice(ids);
            return 0;
        }
        let stored = i32x16::from_slice(simd, depth);
        let pass = if MODE == LESS {
            inside & z.simd_lt(stored)
        } else {
            let wins =
                (self.less & z.simd_lt(stored)) | (self.equal & z.simd_eq(stored)) | (self.greater & z.simd_gt(stored));
            inside & wins
        };
        let bits = pass.to_bitmask() as u32;
        if !SKIP || bits != 0 {
            if MODE == LESS || self.write {
                pass.select(z, stored).store_slice(depth);
            }
            pass.select(self.id, u32x16::from_slice(simd, ids)).store_slice(ids);
        }
        bits
    }
}

/// The three edges of a triangle, walked [`LANES`] rows at a time.
pub(in crate::hidden) struct Walks<S: Simd> {
    long: Steps<S>,
    upper: Steps<S>,
    lower: Steps<S>,
}

/// What a triangle covers on up to [`LANES`] rows of a tile, a lane each.
pub(in crate::hidden) struct Spans<S: Simd> {
    /// First column, counted from the tile's first.
    pub(in crate::hidden) from: i32x16<S>,
    /// Number of columns; means nothing where nothing is covered.
    pub(in crate::hidden) width: i32x16<S>,
    /// Rows that cover something.
    pub(in crate::hidden) covered: mask32x16<S>,
    /// Rows that begin in this tile and not in one left of it.
    pub(in crate::hidden) begun: mask32x16<S>,
}

/// The pixels a triangle covers on up to [`LANES`] rows of a tile.
struct Rows {
    /// First column on each row, counted from the tile's first.
    from: [i32; LANES],
    /// Number of columns on each row.
    count: [i32; LANES],
    /// Rows that cover something, a bit each.
    covered: u32,
    /// Rows that begin in this tile and not in one left of it, a bit each.
    begun: u32,
}

impl<S: Simd> Walks<S> {
    #[inline(always)]
    pub(in crate::hidden) fn new(simd: S, t: &Triangle) -> Self {
        Walks {
            long: Steps::new(simd, t.long.step),
            upper: Steps::new(simd, t.short[0].step),
            lower: Steps::new(simd, t.short[1].step),
        }
    }

    /// Rows `y..y + count`.
    #[inline(always)]
    pub(in crate::hidden) fn spans(&self, simd: S, t: &Triangle, y: i32, count: i32, tile: &Tile<'_>) -> Spans<S> {
        let lane = u32x16::from_slice(simd, &LANE);
        let in_upper = lane.simd_lt((t.rows[1] - y).clamp(0, LANES as i32) as u32);
        let long = self.long.columns(simd, t.long.walk(y - t.rows[0]), tile.x);
        let upper = self.upper.columns(simd, t.short[0].walk(y - t.rows[0]), tile.x);
        let lower = self.lower.columns(simd, t.short[1].walk(y - t.rows[1]), tile.x);
        let short = in_upper.select(upper, lower);
        let (least, greatest) = (tile.columns[0] - tile.x, tile.columns[1] - tile.x);
        let start = long.min(short);
        let from = start.max(least);
        let width = long.max(short).min(greatest) - from;
        let covered = lane.simd_lt(count as u32) & width.simd_gt(0);
        // A span is counted by the tile in which it begins; one cut by the scissor begins there.
        let begun = covered & start.simd_ge(if tile.scissor_x >= tile.x { i32::MIN } else { 0 });
        Spans { from, width, covered, begun }
    }

    /// Rows `y..y + count`.
    #[inline(always)]
    fn rows(&self, simd: S, t: &Triangle, y: i32, count: i32, tile: &Tile<'_>) -> Rows {
        let spans = self.spans(simd, t, y, count, tile);
        let mut rows = Rows {
            from: [0; LANES],
            count: [0; LANES],
            covered: spans.covered.to_bitmask() as u32,
            begun: spans.begun.to_bitmask() as u32,
        };
        spans.from.store_slice(&mut rows.from);
        spans.width.store_slice(&mut rows.count);
        rows
    }
}

/// Tests triangle `t` against the tile.
///
/// Most triangles are small: what they cover is found for [`LANES`] rows at once, rows without a
/// pixel are never looked at, and a row of at most [`LANES`] pixels is one chunk with no branch on
/// what passes.
#[inline(always)]
pub fn triangle<S: Simd, const MODE: u8>(
    simd: S,
    t: &Triangle,
    id: u32,
    test: DepthTest,
    below: u32,
    tile: &mut Tile<'_>,
) {
    let first = t.rows[0].max(tile.rows[0]);
    let beyond = t.rows[2].min(tile.rows[1]);
    if first >= beyond {
        return;
    }
    let lanes = Lanes::new(simd, &t.plane, id, test);
    let walks = Walks::new(simd, t);
    let (x, reach) = (tile.x, tile.reach);
    let (mut covered, mut passed) = (0, 0);
    let mut y = first;
    while y < beyond {
        let rows = walks.rows(simd, t, y, beyond - y, tile);
        tile.counts.spans += u64::from(rows.begun.count_ones());
        let top = (y - tile.band_y) as usize;
        if !tile.tokens.is_empty() {
            count_tokens(&mut tile.tokens[top..], rows.begun);
        }
        let value = t.plane.value(x, y);
        let mut left = rows.covered;
        while left != 0 {
            let k = left.trailing_zeros() as usize % LANES;
            left &= left - 1;
            let (from, count) = (rows.from[k] as usize, rows.count[k] as usize);
            let value = value.wrapping_add((k as i64).wrapping_mul(t.plane.dy));
            let ids = &mut tile.ids[(top + k) * TILE..][..TILE];
            let depth: &mut [i32] = if MODE == NO_DEPTH {
                &mut []
            } else {
                &mut tile.depth[(top + k) * tile.depth_pitch + x as usize..][..reach]
            };
            covered += count as u32;
            passed += if MODE == WIDE {
                wide_row(&t.plane, id, test, below, depth, ids, value, from..from + count)
            } else if count <= LANES {
                // One chunk, placed where it holds the whole run and ends inside the row.
                let start = from.min(reach - LANES);
                let z = lanes.depths(simd, value.wrapping_add((start as i64).wrapping_mul(lanes.dx)));
                let depth = if MODE == NO_DEPTH { depth } else { &mut depth[start..start + LANES] };
                let ids = &mut ids[start..start + LANES];
                let bits = lanes.chunk::<MODE, false>(simd, depth, ids, z, (from - start) as u32, count as u32);
                if MODE == NO_DEPTH { count as u32 } else { bits.count_ones() }
            } else {
                long_row::<S, MODE>(simd, &lanes, depth, ids, value, from, count)
            };
        }
        y += LANES as i32;
    }
    tile.counts.rows_touched(first, beyond);
    tile.counts.covered += u64::from(covered);
    tile.counts.passed += u64::from(passed);
}

/// Adds 1 to the count of each row that `begun` has a bit for.
fn count_tokens(tokens: &mut [u32], begun: u32) {
    for (row, tokens) in tokens.iter_mut().take(LANES).enumerate() {
        *tokens += (begun >> row) & 1;
    }
}

/// `count` pixels of a row from column `from` on, chunk by chunk.
#[inline(always)]
fn long_row<S: Simd, const MODE: u8>(
    simd: S,
    lanes: &Lanes<S>,
    depth: &mut [i32],
    ids: &mut [u32],
    value: i64,
    from: usize,
    count: usize,
) -> u32 {
    let (first, beyond) = (from & !(LANES - 1), (from + count).next_multiple_of(LANES));
    let mut value = value.wrapping_add((first as i64).wrapping_mul(lanes.dx));
    let mut z = lanes.depths(simd, value);
    let mut lane = (from as u32).wrapping_sub(first as u32);
    let mut passed = 0;
    let ids = ids[first..beyond].as_chunks_mut::<LANES>().0;
    if MODE == NO_DEPTH {
        for ids in ids {
            lanes.chunk::<MODE, true>(simd, &mut [], ids, z, lane, count as u32);
            lane = lane.wrapping_sub(LANES as u32);
        }
        return count as u32;
    }
    for (depth, ids) in depth[first..beyond].as_chunks_mut::<LANES>().0.iter_mut().zip(ids) {
        passed += lanes.chunk::<MODE, true>(simd, depth, ids, z, lane, count as u32).count_ones();
        lane = lane.wrapping_sub(LANES as u32);
        if lanes.dx != 0 {
            value = value.wrapping_add(lanes.dx.wrapping_mul(LANES as i64));
            z = lanes.depths(simd, value);
        }
    }
    passed
}

/// Pixels of a row one by one, in 64 bits.
#[expect(clippy::too_many_arguments, reason = "the loop state of its one caller")]
fn wide_row(
    plane: &DepthPlane,
    id: u32,
    test: DepthTest,
    below: u32,
    depth: &mut [i32],
    ids: &mut [u32],
    value: i64,
    columns: Range<usize>,
) -> u32 {
    let mut passed = 0;
    for x in columns {
        let z = plane.stored(value.wrapping_add((x as i64).wrapping_mul(plane.dx)), below);
        if test.passes(z, depth[x]) {
            if test.write {
                depth[x] = z;
            }
            ids[x] = id;
            passed += 1;
        }
    }
    passed
}
