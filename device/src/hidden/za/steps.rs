//! Lines and points against a host tile of the Za path: block by block, pixel by pixel.

use super::holes::Holes;
use super::prediction::clocks;
use super::tile::ZaTile;
use crate::geometry::line::Line;
use crate::geometry::plane::{Axis, DepthPlane};
use crate::geometry::triangle::WALK;
use crate::hidden::z_buffer::kernel::{LESS, NO_DEPTH};
use crate::hidden::z_buffer::tile::TILE;
use fearless_simd::Simd;
use zga_abi::format::ZaPrediction;

/// A visit: the block, and the run of the primitive in it.
struct Visit {
    /// Column of the block.
    column: usize,
    /// First row of the block.
    first: usize,
    /// Fragments of the run.
    fragments: u64,
    /// Rows of the run.
    rows: u64,
}

impl ZaTile<'_> {
    /// Tests one fragment; whether it passed.
    #[inline(always)]
    fn fragment<const MODE: u8>(&mut self, x: i32, y: i32, z: i32, id: u32) -> bool {
        let (row, column) = ((y - self.pixels.band_y) as usize % TILE, (x - self.pixels.x) as usize % TILE);
        let seen = &mut self.pixels.ids[row * TILE + column];
        if MODE == NO_DEPTH {
            *seen = id;
            return true;
        }
        let stored = &mut self.pixels.depth[row * self.pixels.depth_pitch + x as usize];
        let pass = if MODE == LESS { z < *stored } else { self.test.passes(z, *stored) };
        *stored = if pass & self.test.write { z } else { *stored };
        *seen = if pass { id } else { *seen };
        if self.writes {
            let held = self.blocks.holders[row];
            self.blocks.holders[row] = held & !(u64::from(pass) << column);
            if self.blocks.holders[row] != held {
                self.blocks.outdate(column >> self.blocks.width_shift(), 1 << row);
            }
        }
        pass
    }

    /// Begins a visit; `None` if the block is bypassed, else whether it was cleared. `predict` tells the
    /// prediction.
    #[inline(always)]
    fn begin<S: Simd, const MODE: u8>(
        &mut self,
        simd: S,
        visit: &Visit,
        plane: &DepthPlane,
        predict: impl Fn() -> i32,
    ) -> Option<bool> {
        let bit = 1 << visit.first;
        if self.blocks.cleared[visit.column] & bit != 0 {
            self.visits.initialised += 1;
            self.visits.initialised_pixels += self.blocks.pixels(visit.column, bit);
            self.initialise(visit.column, bit);
            return Some(true);
        }
        if MODE != NO_DEPTH && self.may_bypass {
            self.visits.prediction += clocks(self.draw.prediction, visit.rows);
            let bound = self.blocks.words[visit.column * TILE + visit.first];
            let stale = self.blocks.stale[visit.column] & bit != 0;
            let behind = plane.minimum > bound
                || ((stale || plane.maximum > bound) && {
                    let word = self.word(simd, visit.column, visit.first);
                    plane.maximum > word && predict() > word
                });
            if behind {
                self.visits.bypassed += 1;
                self.visits.bypassed_fragments += visit.fragments;
                return None;
            }
        }
        self.visits.compared += 1;
        if MODE != NO_DEPTH && self.writes {
            self.visits.compared_pixels += self.blocks.pixels(visit.column, bit);
            self.now_written(visit.column, bit);
        } else {
            self.visits.compared_fragments += visit.fragments;
        }
        Some(false)
    }

    /// Ends a visit of which `passed` fragments passed.
    #[inline(always)]
    fn end(&mut self, fresh: bool, passed: u64) {
        let counted = if fresh { &mut self.visits.initialised_passed } else { &mut self.visits.compared_passed };
        *counted += passed;
    }
}

impl ZaTile<'_> {
    /// Counts the fragments of a visit that was not bypassed, of which some were holes.
    fn count_holes<const MODE: u8>(&mut self, fresh: bool, fragments: u64, holes: u64) {
        self.counts.fragments += fragments;
        self.counts.holes += holes;
        self.visits.unpainted += if MODE == NO_DEPTH && !fresh { holes } else { 0 };
    }
}

/// Draws the steps of a line that fall into the tile.
#[inline(always)]
pub fn line<S: Simd, H: Holes, const MODE: u8>(simd: S, line: &Line, id: u32, holes: &H, tile: &mut ZaTile<'_>) {
    let one_row = !H::ANY && MODE != NO_DEPTH && tile.blocks.height() == 1;
    match (line.axis, one_row) {
        (Axis::X, false) => steps::<S, H, MODE, true>(simd, line, id, holes, tile),
        (Axis::Y, false) => steps::<S, H, MODE, false>(simd, line, id, holes, tile),
        (Axis::X, true) => one_row_steps::<S, MODE, true>(simd, line, id, tile),
        (Axis::Y, true) => one_row_steps::<S, MODE, false>(simd, line, id, tile),
    }
}

/// Draws the steps of a line, tested against blocks of one row.
///
/// As [`steps`], but step by step: no predictor knows where a line enters a block, which blocks are behind it
/// and which pixels pass. The fragments of a bypassed block are tested as well, for they cannot pass.
#[inline(always)]
fn one_row_steps<S: Simd, const MODE: u8, const ALONG_X: bool>(simd: S, line: &Line, id: u32, tile: &mut ZaTile<'_>) {
    let pixels = &tile.pixels;
    let (along, across) = if ALONG_X { (pixels.columns, pixels.rows) } else { (pixels.rows, pixels.columns) };
    let (first, beyond) = (line.steps[0].max(along[0]), line.steps[1].min(along[1]));
    if first >= beyond {
        return;
    }
    tile.pixels.counts.rows_touched(tile.pixels.rows[0], tile.pixels.rows[1]);
    let plane = &line.plane;
    let (mut value, gradient) = if ALONG_X {
        (plane.value(first, plane.anchor[1]), plane.dx)
    } else {
        (plane.value(plane.anchor[0], first), plane.dy)
    };
    let (shift, below) = (tile.blocks.width_shift(), tile.below);
    let (writes, may_bypass) = (tile.writes, tile.may_bypass);
    let mut walk = line.minor.wrapping_add(i64::from(first - line.steps[0]).wrapping_mul(line.slope));
    // The visit at hand.
    let (mut block, mut behind, mut fresh) = (usize::MAX, false, false);
    let (mut live, mut bypassed, mut compared_pixels) = (0, 0, 0);
    let (mut bypassed_fragments, mut compared_fragments, mut passed, mut fresh_passed) = (0, 0, 0, 0);
    for step in first..beyond {
        let at = (walk >> WALK) as i32;
        let begun = walk;
        walk = walk.wrapping_add(line.slope);
        let z = plane.stored(value, below);
        value = value.wrapping_add(gradient);
        if at < across[0] || at >= across[1] {
            continue;
        }
        let (x, y) = if ALONG_X { (step, at) } else { (at, step) };
        let row = (y - tile.pixels.band_y) as usize % TILE;
        let pixel = (x - tile.pixels.x) as usize % TILE;
        let column = pixel >> shift;
        let index = column * TILE + row;
        let entered = index != block;
        block = index;
        let bound = tile.blocks.words[index];
        let near = !may_bypass | (plane.minimum <= bound);
        let stale = (tile.blocks.stale[column] >> row) & 1 != 0;
        let known = !may_bypass | !near | (!stale & (plane.maximum <= bound));
        let cleared = (tile.blocks.cleared[column] >> row) & 1 != 0;
        behind = if entered { !near } else { behind };
        fresh &= !entered;
        if entered & (cleared | !known) {
            if cleared {
                tile.visits.initialised += 1;
                tile.visits.initialised_pixels += tile.blocks.pixels(column, 1 << row);
                tile.initialise(column, 1 << row);
                (behind, fresh) = (false, true);
            } else {
                let word = tile.word(simd, column, row);
                let from = value.wrapping_sub(gradient);
                behind = plane.maximum > word && !line.steep && {
                    let length = match (ALONG_X, tile.draw.prediction) {
                        (false, _) => 0,
                        (true, ZaPrediction::BlockLength) => 1 << shift,
                        (true, _) => {
                            let end = (((x - tile.pixels.x) | ((1 << shift) - 1)) + 1 + tile.pixels.x).min(beyond);
                            i64::from(last_on_row(begun, line.slope, step, end) - step)
                        }
                    };
                    let nearest = from.wrapping_add(length.wrapping_mul(gradient).min(0));
                    plane.stored(nearest, below) > word
                };
                // A steep line's prediction is its least depth.
                behind |= line.steep && plane.minimum > word;
            }
        }
        let compared = entered & !behind & !fresh;
        live += u64::from(entered & !fresh);
        bypassed += u64::from(entered & behind);
        bypassed_fragments += u64::from(behind);
        compared_fragments += u64::from(!behind & !fresh);
        if writes {
            let width = (tile.blocks.size[0] - (column << shift)).min(1 << shift);
            compared_pixels += if compared { width as u64 } else { 0 };
            let underived = (u64::from(compared) << row) & !tile.blocks.derived[column];
            tile.blocks.derived[column] |= underived;
            tile.blocks.stale[column] |= underived;
        }
        let stored = &mut tile.pixels.depth[row * tile.pixels.depth_pitch + x as usize];
        let seen = &mut tile.pixels.ids[row * TILE + pixel];
        let pass = if MODE == LESS { z < *stored } else { tile.test.passes(z, *stored) };
        *stored = if pass & writes { z } else { *stored };
        *seen = if pass { id } else { *seen };
        passed += u64::from(pass);
        fresh_passed += u64::from(pass & fresh);
        if writes {
            let held = tile.blocks.holders[row] & !(u64::from(pass) << pixel);
            tile.blocks.holders[row] = held;
            let lost = (held & tile.blocks.column(column) == 0) & !behind;
            tile.blocks.stale[column] |= u64::from(lost) << row;
        }
    }
    let visits = &mut tile.visits;
    visits.bypassed += bypassed;
    visits.bypassed_fragments += bypassed_fragments;
    visits.compared += live - bypassed;
    visits.compared_pixels += compared_pixels;
    visits.compared_fragments += if writes { 0 } else { compared_fragments };
    visits.compared_passed += passed - fresh_passed;
    visits.initialised_passed += fresh_passed;
    visits.prediction += if may_bypass { live * clocks(tile.draw.prediction, 1) } else { 0 };
}

/// The last step before `beyond` on the row of step `step`, where the walk is `walk`.
#[inline(always)]
fn last_on_row(mut walk: i64, slope: i64, step: i32, beyond: i32) -> i32 {
    let row = walk >> WALK;
    let mut last = step;
    while last + 1 < beyond {
        walk = walk.wrapping_add(slope);
        if walk >> WALK != row {
            break;
        }
        last += 1;
    }
    last
}

/// Draws the steps of a line along X or along Y.
#[inline(always)]
fn steps<S: Simd, H: Holes, const MODE: u8, const ALONG_X: bool>(
    simd: S,
    line: &Line,
    id: u32,
    holes: &H,
    tile: &mut ZaTile<'_>,
) {
    let pixels = &tile.pixels;
    let (along, across) = if ALONG_X { (pixels.columns, pixels.rows) } else { (pixels.rows, pixels.columns) };
    let (first, beyond) = (line.steps[0].max(along[0]), line.steps[1].min(along[1]));
    if first >= beyond {
        return;
    }
    tile.pixels.counts.rows_touched(tile.pixels.rows[0], tile.pixels.rows[1]);
    let plane = &line.plane;
    let [width, height] = [1_i32 << tile.blocks.width_shift(), tile.blocks.height() as i32];
    // From a value to the next, and how many of them the block-length prediction takes.
    let (mut value, gradient, length) = if ALONG_X {
        (plane.value(first, plane.anchor[1]), plane.dx, i64::from(width))
    } else {
        (plane.value(plane.anchor[0], first), plane.dy, i64::from(height) - 1)
    };
    let corner = [tile.pixels.x, tile.pixels.band_y];
    let ([start, side], [block, block_across]) =
        if ALONG_X { (corner, [width, height]) } else { ([corner[1], corner[0]], [height, width]) };
    let mut walk = line.minor.wrapping_add(i64::from(first - line.steps[0]).wrapping_mul(line.slope));
    let mut step = first;
    while step < beyond {
        let at = (walk >> WALK) as i32;
        let (run, begun) = (step, walk);
        walk = walk.wrapping_add(line.slope);
        step += 1;
        if at < across[0] || at >= across[1] {
            value = value.wrapping_add(gradient);
            continue;
        }
        // The run goes on to the end of the block, along the line or across it.
        let mut last = at;
        if block > 1 {
            let limit = (((run - start) | (block - 1)) + 1 + start).min(beyond);
            let least = ((at - side) & !(block_across - 1)) + side;
            let (least, greatest) = (least.max(across[0]), (least + block_across).min(across[1]));
            while step < limit {
                let next = (walk >> WALK) as i32;
                if next < least || next >= greatest {
                    break;
                }
                last = next;
                walk = walk.wrapping_add(line.slope);
                step += 1;
            }
        }
        let fragments = (step - run) as u64;
        let (x, y) = if ALONG_X { (run, at) } else { (at, run) };
        let visit = Visit {
            column: ((x - corner[0]) >> tile.blocks.width_shift()) as usize % TILE,
            first: tile.blocks.first_row((y - corner[1]) as usize % TILE),
            fragments,
            rows: if ALONG_X { u64::from(at.abs_diff(last)) + 1 } else { fragments },
        };
        let (prediction, below) = (tile.draw.prediction, tile.below);
        let predict = || {
            if line.steep {
                return plane.minimum;
            }
            let length = if prediction == ZaPrediction::BlockLength { length } else { fragments as i64 - 1 };
            plane.stored(value.wrapping_add(length.wrapping_mul(gradient).min(0)), below)
        };
        let Some(fresh) = tile.begin::<S, MODE>(simd, &visit, plane, predict) else {
            value = value.wrapping_add((fragments as i64).wrapping_mul(gradient));
            continue;
        };
        let (mut walk, mut passed, mut unpainted) = (begun, 0, 0);
        for step in run..step {
            let at = (walk >> WALK) as i32;
            let (x, y) = if ALONG_X { (step, at) } else { (at, step) };
            if H::ANY && holes.at(x, y) {
                unpainted += 1;
            } else {
                passed += u64::from(tile.fragment::<MODE>(x, y, plane.stored(value, below), id));
            }
            walk = walk.wrapping_add(line.slope);
            value = value.wrapping_add(gradient);
        }
        tile.end(fresh, passed);
        if H::ANY {
            tile.count_holes::<MODE>(fresh, fragments, unpainted);
        }
    }
}

/// Draws a point.
#[inline(always)]
pub fn point<S: Simd, H: Holes, const MODE: u8>(
    simd: S,
    pixel: [i32; 2],
    z: i32,
    id: u32,
    holes: &H,
    tile: &mut ZaTile<'_>,
) {
    let [x, y] = pixel;
    let pixels = &tile.pixels;
    if !(pixels.columns[0]..pixels.columns[1]).contains(&x) || !(pixels.rows[0]..pixels.rows[1]).contains(&y) {
        return;
    }
    let visit = Visit {
        column: ((x - pixels.x) >> tile.blocks.width_shift()) as usize % TILE,
        first: tile.blocks.first_row((y - pixels.band_y) as usize % TILE),
        fragments: 1,
        rows: 1,
    };
    tile.pixels.counts.rows_touched(y, y + 1);
    let plane = DepthPlane { minimum: z, maximum: z, ..DepthPlane::default() };
    if let Some(fresh) = tile.begin::<S, MODE>(simd, &visit, &plane, || z) {
        let hole = H::ANY && holes.at(x, y);
        let passed = u64::from(!hole && tile.fragment::<MODE>(x, y, z, id));
        tile.end(fresh, passed);
        if H::ANY {
            tile.count_holes::<MODE>(fresh, 1, u64::from(hole));
        }
    }
}
