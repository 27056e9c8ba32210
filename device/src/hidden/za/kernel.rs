//! Row kernel of the Za path: a triangle against a host tile.
//!
//! Three ways, from the least work to the most:
//!
//! * A triangle that covers the tile wholly is hidden wholly, or seen wholly, by one comparison with
//!   the greatest word or the least depth of the tile.
//! * What a triangle covers is found for 16 rows at once; each column of blocks compares the words of 16
//!   rows with the triangle's least and greatest depth. Only where a word lies between the two, or is
//!   stale, is there a prediction to be made.
//! * Rows that meet a block which is not bypassed go through the chunks of the plain Z buffer, cut to
//!   those blocks. The bits that say which pixels passed also say which words they outdate.
//!
//! Counts and clocks are the same sums as one visit after another would give; see
//! [`super::specification`].

use super::blocks::{LANE, ones};
use super::holes::Holes;
use super::prediction::clocks;
use super::tile::ZaTile;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::kernel::{LANES, Lanes, NO_DEPTH, WIDE, Walks};
use crate::hidden::z_buffer::tile::TILE;
use fearless_simd::i32x16;
use fearless_simd::prelude::*;
use std::ops::Range;
use zga_abi::format::ZaPrediction;

/// Rows from which on it is worth a look whether all of a tile is in front of a triangle.
const TALL: i32 = 16;
/// Most columns of blocks of which that look is taken for a triangle that does not cover the tile.
const FEW_COLUMNS: usize = 4;

/// Draws triangle `t`, whose identifier is `id`.
#[inline(always)]
pub fn triangle<S: Simd, H: Holes, const MODE: u8>(simd: S, t: &Triangle, id: u32, holes: &H, tile: &mut ZaTile<'_>) {
    let first = t.rows[0].max(tile.pixels.rows[0]);
    let beyond = t.rows[2].min(tile.pixels.rows[1]);
    if first >= beyond {
        return;
    }
    let tall = beyond - first == tile.pixels.rows[1] - tile.pixels.rows[0];
    if !H::ANY && tall && whole::<S, MODE>(simd, t, id, tile) {
        return;
    }
    let covered = walk(simd, t, first..beyond, tile);
    if !covered {
        return;
    }
    store(simd, tile);
    let look = beyond - first >= TALL && tile.blocks.columns <= FEW_COLUMNS;
    let all = if t.plane.maximum <= tile.blocks.floor {
        // No word is less than the tile's least depth.
        Some(false)
    } else {
        is_hidden(simd, t, look, tile).then_some(true)
    };
    let drawn = visit::<S, H, MODE>(simd, t, all, tile);
    if drawn.rows != 0 {
        tile.pixels.counts.rows_touched(first, beyond);
        tile.blocks.floor = tile.blocks.floor.min(t.plane.minimum);
        rows::<S, H, MODE>(simd, t, id, holes, &drawn, tile);
    }
}

/// Finds what the triangle covers: spans of rows, and rows of columns of blocks. Returns whether
/// there is anything.
#[inline(always)]
fn walk<S: Simd>(simd: S, t: &Triangle, rows: Range<i32>, tile: &mut ZaTile<'_>) -> bool {
    let walks = Walks::new(simd, t);
    let (columns, shift) = (tile.blocks.columns, tile.blocks.width_shift());
    tile.runs.touched[..columns].fill(0);
    let (mut covered, mut begun) = (false, 0);
    let mut y = rows.start;
    while y < rows.end {
        let spans = walks.spans(simd, t, y, rows.end - y, &tile.pixels);
        let row = (y - tile.pixels.band_y) as usize;
        y += LANES as i32;
        let bits = spans.covered.to_bitmask();
        if bits == 0 {
            continue;
        }
        covered = true;
        begun += u64::from(spans.begun.to_bitmask().count_ones());
        let width = spans.covered.select(spans.width, i32x16::splat(simd, 0));
        spans.from.store_slice(&mut tile.runs.from[row..row + LANES]);
        width.store_slice(&mut tile.runs.count[row..row + LANES]);
        let end = spans.from + width;
        let (mut first, mut beyond) = (0, columns);
        if columns > 2 {
            first = spans.covered.select(spans.from, i32x16::splat(simd, TILE as i32)).reduce_min() as usize >> shift;
            beyond = (end.reduce_max() as usize).div_ceil(1 << shift).min(columns);
        }
        for column in first..beyond {
            let left = (column << shift) as i32;
            let meets = spans.covered & spans.from.simd_lt(left + (1 << shift)) & end.simd_gt(left);
            tile.runs.touched[column] |= meets.to_bitmask() << row;
        }
    }
    tile.counts.count_spans(begun);
    covered
}

/// What of a triangle is drawn.
struct Drawn {
    /// Rows.
    rows: u64,
    /// Those of them that meet a bypassed block as well.
    mixed: u64,
    /// Those of them that meet a block which is being initialised.
    fresh: u64,
}

/// Initialises cleared blocks and decides which of the others are bypassed, where it is not known already that
/// all of them are or none is.
#[inline(always)]
fn visit<S: Simd, H: Holes, const MODE: u8>(simd: S, t: &Triangle, all: Option<bool>, tile: &mut ZaTile<'_>) -> Drawn {
    let mut drawn = Drawn { rows: 0, mixed: 0, fresh: 0 };
    for column in 0..tile.blocks.columns {
        let touched = tile.runs.touched[column];
        if touched == 0 {
            tile.runs.needed[column] = 0;
            continue;
        }
        let visited = tile.blocks.meeting(touched);
        let fresh = visited & tile.blocks.cleared[column];
        let live = visited & !fresh;
        let mut bypassed = 0;
        if tile.may_bypass && live != 0 {
            bypassed = match all {
                Some(true) => live,
                Some(false) => 0,
                None => decide(simd, t, column, live, tile),
            };
            tile.visits.prediction += match tile.draw.prediction {
                ZaPrediction::Plane => {
                    let rows = touched & tile.blocks.rows(live);
                    u64::from(live.count_ones() + rows.count_ones())
                }
                fixed => clocks(fixed, 0) * u64::from(live.count_ones()),
            };
        }
        let compared = live & !bypassed;
        let needed = touched & tile.blocks.rows(visited & !bypassed);
        tile.runs.needed[column] = needed;
        drawn.rows |= needed;
        if bypassed != 0 {
            drawn.mixed |= touched & !needed;
            tile.visits.bypassed += u64::from(bypassed.count_ones());
            tile.visits.bypassed_fragments += tile.fragments(column, touched & !needed);
        }
        tile.visits.compared += u64::from(compared.count_ones());
        if MODE != NO_DEPTH && tile.writes {
            tile.visits.compared_pixels += tile.blocks.pixels(column, compared);
            tile.now_written(column, compared);
        } else if compared != 0 {
            tile.visits.compared_fragments += tile.fragments(column, touched & tile.blocks.rows(compared));
        }
        if fresh != 0 {
            let rows = touched & tile.blocks.rows(fresh);
            tile.visits.initialised += u64::from(fresh.count_ones());
            tile.visits.initialised_pixels += tile.blocks.pixels(column, fresh);
            if MODE == NO_DEPTH && !H::ANY {
                tile.visits.initialised_passed += tile.fragments(column, rows);
            } else {
                tile.note_fresh(column, rows, drawn.fresh);
                drawn.fresh |= rows;
            }
            tile.initialise(column, fresh);
        }
    }
    drawn.mixed &= drawn.rows;
    drawn
}

/// Whether the triangle is behind everything in the tile.
#[inline(always)]
fn is_hidden<S: Simd>(simd: S, t: &Triangle, look: bool, tile: &mut ZaTile<'_>) -> bool {
    if !tile.may_bypass || tile.blocks.cleared_count != 0 {
        return false;
    }
    // No prediction is less than the triangle's least depth.
    if t.plane.minimum > tile.blocks.ceiling {
        return true;
    }
    if !(look && tile.blocks.loose) {
        return false;
    }
    tile.blocks.tighten(simd);
    t.plane.minimum > tile.blocks.ceiling
}

/// Which of the initialised blocks `live` of a column are bypassed.
#[inline(always)]
fn decide<S: Simd>(simd: S, t: &Triangle, column: usize, live: u64, tile: &mut ZaTile<'_>) -> u64 {
    let (mut behind, mut near, mut left) = (0, 0, live);
    while left != 0 {
        // 16 rows from the first on: all of them, mostly.
        let row = left.trailing_zeros() as usize;
        left &= !(0xFFFF << row);
        let words = i32x16::from_slice(simd, &tile.blocks.words[column * TILE + row..][..LANES]);
        behind |= words.simd_lt(t.plane.minimum).to_bitmask() << row;
        near |= words.simd_lt(t.plane.maximum).to_bitmask() << row;
    }
    let mut bypassed = live & behind;
    // A stale word is an upper bound: what lies behind it is hidden, else it must be known.
    let mut open = live & !behind & (near | tile.blocks.stale[column]);
    while open != 0 {
        let row = open.trailing_zeros() as usize;
        let bit = open & open.wrapping_neg();
        open &= !bit;
        let word = tile.word(simd, column, row);
        if t.plane.maximum > word && predict(t, column, row, tile) > word {
            bypassed |= bit;
        }
    }
    bypassed
}

/// The predicted least depth of the triangle in the block of a column that begins on row `first`.
#[inline(always)]
fn predict(t: &Triangle, column: usize, first: usize, tile: &ZaTile<'_>) -> i32 {
    let plane = &t.plane;
    if t.steep {
        return plane.minimum;
    }
    let width = 1 << tile.blocks.width_shift();
    let (left, right) = ((column * width) as i32, ((column + 1) * width) as i32);
    let origin = plane.value(tile.pixels.x, tile.pixels.band_y);
    let across = |x: i32| i64::from(x).wrapping_mul(plane.dx);
    let down = |y: i32| i64::from(y).wrapping_mul(plane.dy);
    let mut rows = tile.runs.touched[column] & tile.blocks.rows(1 << first);
    let (top, bottom) = (rows.trailing_zeros() as i32, 63 - rows.leading_zeros() as i32);
    let (mut least, mut greatest, mut value) = (i32::MAX, i32::MIN, i64::MAX);
    while rows != 0 {
        let row = rows.trailing_zeros() as usize % TILE;
        rows &= rows - 1;
        let from = tile.runs.from[row].max(left);
        let last = (tile.runs.from[row] + tile.runs.count[row]).min(right) - 1;
        (least, greatest) = (least.min(from), greatest.max(last));
        let near = if plane.dx < 0 { last } else { from };
        value = value.min(origin.wrapping_add(across(near)).wrapping_add(down(row as i32)));
    }
    // Gradients are small enough for all of it to fit: see [`super::prediction`].
    let corner = origin.wrapping_add(across(least)).wrapping_add(down(top));
    let value = match tile.draw.prediction {
        ZaPrediction::BlockLength => {
            let height = tile.blocks.height() as i32;
            corner.wrapping_add(across(width as i32).min(0)).wrapping_add(down(height - 1).min(0))
        }
        ZaPrediction::CoveredRun => {
            corner.wrapping_add(across(greatest - least).min(0)).wrapping_add(down(bottom - top).min(0))
        }
        ZaPrediction::Plane => value,
    };
    plane.stored(value, tile.below)
}

impl ZaTile<'_> {
    /// Fragments of the primitive at hand in a column of blocks on some of the rows it touches there.
    #[inline(always)]
    fn fragments(&self, column: usize, mut rows: u64) -> u64 {
        let shift = self.blocks.width_shift();
        let (left, right) = ((column << shift) as i32, ((column + 1) << shift) as i32);
        let mut sum = 0;
        while rows != 0 {
            let row = rows.trailing_zeros() as usize % TILE;
            rows &= rows - 1;
            let end = self.runs.from[row] + self.runs.count[row];
            sum += end.min(right) - self.runs.from[row].max(left);
        }
        sum as u64
    }

    /// Notes that `rows` meet blocks of a column that are being initialised, as `before` did already.
    #[inline(always)]
    fn note_fresh(&mut self, column: usize, mut rows: u64, before: u64) {
        let pixels = self.blocks.column(column);
        while rows != 0 {
            let row = rows.trailing_zeros() as usize % TILE;
            rows &= rows - 1;
            let others = if (before >> row) & 1 == 0 { 0 } else { self.runs.fresh[row] };
            self.runs.fresh[row] = others | pixels;
        }
    }

    /// The exact word of the block of a column that begins on row `first`.
    #[inline(always)]
    pub fn word<S: Simd>(&mut self, simd: S, column: usize, first: usize) -> i32 {
        if (self.blocks.stale[column] >> first) & 1 == 0 {
            return self.blocks.words[column * TILE + first];
        }
        let depth = self.pixels.depth.get(self.pixels.x as usize..).unwrap_or_default();
        self.blocks.renew(simd, column, first, depth, self.pixels.depth_pitch)
    }
}

/// Draws the rows that meet blocks which are not bypassed.
#[inline(always)]
fn rows<S: Simd, H: Holes, const MODE: u8>(
    simd: S,
    t: &Triangle,
    id: u32,
    holes: &H,
    drawn: &Drawn,
    tile: &mut ZaTile<'_>,
) {
    let lanes = Lanes::new(simd, &t.plane, id, tile.test);
    let (x, reach) = (tile.pixels.x, tile.pixels.reach);
    let origin = t.plane.value(x, tile.pixels.band_y);
    let watch = tile.writes && tile.may_bypass;
    let (mut passed, mut fresh_passed, mut lost) = (0, 0, 0);
    let mut left = drawn.rows;
    while left != 0 {
        let row = left.trailing_zeros() as usize % TILE;
        left &= left - 1;
        let value = origin.wrapping_add((row as i64).wrapping_mul(t.plane.dy));
        let is_fresh = (drawn.fresh >> row) & 1 != 0;
        let ids = &mut tile.pixels.ids[row * TILE..][..TILE];
        let depth: &mut [i32] = if MODE == NO_DEPTH {
            &mut []
        } else {
            &mut tile.pixels.depth[row * tile.pixels.depth_pitch + x as usize..][..reach]
        };
        let (mut from, mut count) = (tile.runs.from[row] as u32, tile.runs.count[row] as u32);
        let mut rest = 0;
        if (drawn.mixed >> row) & 1 != 0 {
            let mut columns = 0;
            for column in 0..tile.blocks.columns {
                if (tile.runs.needed[column] >> row) & 1 != 0 {
                    columns |= tile.blocks.column(column);
                }
            }
            (from, count, rest) = next_run((ones(count) << from) & columns);
        }
        if H::ANY {
            let covered = (ones(count) << from) | rest;
            let found = holes.on_row(simd, x, tile.pixels.band_y + row as i32, covered);
            tile.counts.fragments += u64::from(covered.count_ones());
            tile.counts.holes += u64::from(found.count_ones());
            let solid = covered & !found;
            if MODE == NO_DEPTH {
                let fresh = if is_fresh { tile.runs.fresh[row] } else { 0 };
                tile.visits.initialised_passed += u64::from((solid & fresh).count_ones());
                tile.visits.unpainted += u64::from((found & !fresh).count_ones());
            }
            if solid == 0 {
                continue;
            }
            (from, count, rest) = next_run(solid);
        }
        let mut bits = 0;
        loop {
            bits |= run::<S, MODE>(simd, &lanes, t, id, tile.test, tile.below, depth, ids, value, from, count);
            if rest == 0 {
                break;
            }
            (from, count, rest) = next_run(rest);
        }
        if MODE == NO_DEPTH {
            continue;
        }
        passed += bits.count_ones();
        if is_fresh {
            fresh_passed += (bits & tile.runs.fresh[row]).count_ones();
        }
        if watch {
            let held = tile.blocks.holders[row];
            tile.blocks.holders[row] = held & !bits;
            lost |= u64::from(held & bits != 0) << row;
        }
    }
    if lost != 0 {
        for column in 0..tile.blocks.columns {
            tile.blocks.outdate(column, lost & tile.runs.needed[column]);
        }
    }
    if MODE != NO_DEPTH {
        tile.visits.initialised_passed += u64::from(fresh_passed);
        tile.visits.compared_passed += u64::from(passed - fresh_passed);
    }
}

/// The lowest run of ones of `columns` (not 0): where it begins, how many there are, what is left.
#[inline(always)]
fn next_run(columns: u64) -> (u32, u32, u64) {
    let from = columns.trailing_zeros();
    let count = (!(columns >> from)).trailing_zeros();
    (from, count, columns & !(ones(count) << from))
}

/// Tests `count` pixels of a row from column `from` on; returns a bit for each that passed.
#[expect(clippy::too_many_arguments, reason = "the loop state of its one caller")]
#[inline(always)]
fn run<S: Simd, const MODE: u8>(
    simd: S,
    lanes: &Lanes<S>,
    t: &Triangle,
    id: u32,
    test: DepthTest,
    below: u32,
    depth: &mut [i32],
    ids: &mut [u32],
    value: i64,
    from: u32,
    count: u32,
) -> u64 {
    let (dx, first) = (t.plane.dx, from as usize);
    if MODE == WIDE {
        let mut passed = 0;
        for x in first..first + count as usize {
            let z = t.plane.stored(value.wrapping_add((x as i64).wrapping_mul(dx)), below);
            if test.passes(z, depth[x]) {
                if test.write {
                    depth[x] = z;
                }
                ids[x] = id;
                passed |= 1 << x;
            }
        }
        return passed;
    }
    if count as usize <= LANES {
        // One chunk, placed where it holds the whole run and ends inside the row; no branch on what passes.
        let limit = if MODE == NO_DEPTH { TILE } else { depth.len() };
        let start = first.min(limit - LANES);
        let z = lanes.depths(simd, value.wrapping_add((start as i64).wrapping_mul(dx)));
        let depth = if MODE == NO_DEPTH { depth } else { &mut depth[start..start + LANES] };
        let ids = &mut ids[start..start + LANES];
        return u64::from(lanes.chunk::<MODE, false>(simd, depth, ids, z, (first - start) as u32, count)) << start;
    }
    let (mut start, beyond) = (first & !(LANES - 1), (first + count as usize).next_multiple_of(LANES));
    let mut passed = 0;
    while start < beyond {
        let z = lanes.depths(simd, value.wrapping_add((start as i64).wrapping_mul(dx)));
        let lane = from.wrapping_sub(start as u32);
        let depth = if MODE == NO_DEPTH { &mut *depth } else { &mut depth[start..start + LANES] };
        let ids = &mut ids[start..start + LANES];
        passed |= u64::from(lanes.chunk::<MODE, true>(simd, depth, ids, z, lane, count)) << start;
        start += LANES;
    }
    passed
}

/// Draws a triangle that covers the tile wholly, if it is hidden wholly or seen wholly; else (or where it does
/// not cover the tile) nothing happens.
#[inline(always)]
fn whole<S: Simd, const MODE: u8>(simd: S, t: &Triangle, id: u32, tile: &mut ZaTile<'_>) -> bool {
    let Some(spans) = covering(t, tile) else {
        return false;
    };
    let (rows, columns) = (tile.pixels.rows, tile.pixels.columns);
    let (top, height) = ((rows[0] - tile.pixels.band_y) as u32, (rows[1] - rows[0]) as u32);
    let (left, width) = ((columns[0] - tile.pixels.x) as usize, (columns[1] - columns[0]) as usize);
    let shift = tile.blocks.width_shift();
    let covered = ones(height) << top;
    let visited = u64::from(tile.blocks.meeting(covered).count_ones());
    let across = ((left + width).div_ceil(1 << shift) - (left >> shift)) as u64;
    let fragments = u64::from(height) * width as u64;
    let prediction = if !tile.may_bypass {
        0
    } else if tile.draw.prediction == ZaPrediction::Plane {
        across * (visited + u64::from(height))
    } else {
        across * visited * clocks(tile.draw.prediction, 0)
    };
    if is_hidden(simd, t, true, tile) {
        tile.visits.bypassed += across * visited;
        tile.visits.bypassed_fragments += fragments;
        tile.visits.prediction += prediction;
    } else if MODE != WIDE && [width, height as usize] == tile.blocks.size && seen::<MODE>(t, tile) {
        if tile.blocks.cleared_count == 0 {
            tile.visits.compared += across * visited;
            tile.visits.compared_pixels += fragments;
            tile.visits.compared_fragments += fragments;
            tile.visits.compared_passed += fragments;
            tile.visits.prediction += prediction;
        } else {
            tile.visits.initialised += across * visited;
            tile.visits.initialised_pixels += fragments;
            tile.visits.initialised_passed += fragments;
        }
        replace::<MODE>(t, id, tile);
    } else {
        return false;
    }
    tile.counts.count_spans(spans);
    true
}

/// Spans that begin in the tile if the triangle covers all of it; `None` if it does not, or if that would take
/// longer to tell.
#[inline(always)]
fn covering(t: &Triangle, tile: &ZaTile<'_>) -> Option<u64> {
    let pixels = &tile.pixels;
    let (first, last) = (pixels.rows[0], pixels.rows[1] - 1);
    // Each side is straight between the ends of the rows and the middle vertex.
    let ([l0, r0], [l1, r1]) = (t.span(first), t.span(last));
    let (mut least, mut left, mut right) = (l0.min(l1), l0.max(l1), r0.min(r1));
    if first < t.rows[1] && t.rows[1] <= last {
        let ([l2, r2], [l3, r3]) = (t.span(t.rows[1] - 1), t.span(t.rows[1]));
        (least, left, right) = (least.min(l2).min(l3), left.max(l2).max(l3), right.min(r2).min(r3));
    }
    if left > pixels.columns[0] || right < pixels.columns[1] {
        return None;
    }
    if pixels.scissor_x >= pixels.x || least >= pixels.x {
        Some((last + 1 - first) as u64)
    } else {
        (left < pixels.x).then_some(0)
    }
}

/// Whether every fragment passes, in a tile that the triangle covers and of which all or no blocks are cleared.
#[inline(always)]
fn seen<const MODE: u8>(t: &Triangle, tile: &ZaTile<'_>) -> bool {
    let (test, nearest) = (tile.test, tile.blocks.floor);
    (tile.blocks.cleared_count == 0 || tile.blocks.all_cleared())
        && (MODE == NO_DEPTH
            || (test.less && test.equal && test.greater)
            || (test.less && t.plane.maximum < nearest)
            || (test.less && test.equal && t.plane.maximum <= nearest))
}

/// Replaces everything in the tile; nothing is stored yet.
#[inline(always)]
fn replace<const MODE: u8>(t: &Triangle, id: u32, tile: &mut ZaTile<'_>) {
    let [width, height] = tile.blocks.size;
    if tile.blocks.cleared_count != 0 {
        if !tile.writes {
            tile.fill_depths(0, width, ones(height as u32));
        }
        // No colours: every pixel is seen to have the triangle's.
        for column in 0..tile.blocks.columns {
            tile.now_initialised(column, tile.blocks.all());
        }
    }
    tile.blocks.pending = Some((t.plane, id));
    if MODE != NO_DEPTH && tile.writes {
        tile.blocks.replaced(&t.plane, tile.may_bypass);
    }
}

/// Stores what has replaced everything in the tile.
#[inline(always)]
pub fn store<S: Simd>(simd: S, tile: &mut ZaTile<'_>) {
    let Some((plane, id)) = tile.blocks.pending.take() else {
        return;
    };
    let lanes = Lanes::new(simd, &plane, id, tile.test);
    let [width, height] = tile.blocks.size;
    let (x, top) = (tile.pixels.x, tile.pixels.band_y);
    tile.pixels.counts.rows_touched(top, top + height as i32);
    let whole = width & !(LANES - 1);
    for row in 0..height {
        tile.pixels.ids[row * TILE..][..width].fill(id);
        if !tile.writes {
            continue;
        }
        let depth = &mut tile.pixels.depth[row * tile.pixels.depth_pitch + x as usize..][..tile.pixels.reach];
        let mut value = plane.value(x, top + row as i32);
        for depth in depth[..whole].as_chunks_mut::<LANES>().0 {
            lanes.depths(simd, value).store_slice(depth);
            value = value.wrapping_add(plane.dx.wrapping_mul(LANES as i64));
        }
        if whole < width {
            let depth = &mut depth[whole..whole + LANES];
            let inside = i32x16::from_slice(simd, &LANE).simd_lt((width - whole) as i32);
            inside.select(lanes.depths(simd, value), i32x16::from_slice(simd, depth)).store_slice(depth);
        }
    }
}
