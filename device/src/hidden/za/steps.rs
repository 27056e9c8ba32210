//! Lines and points against a host tile of the Za path: block by block, pixel by pixel.

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
        let (row, column) = ((y - self.pixels.band_y) as usize, (x - self.pixels.x) as usize);
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

    /// Begins a visit: whether the block is bypassed (and the visit counted), and else whether it was cleared and
    /// how many clocks a prediction took. `predict` tells the prediction.
    #[inline(always)]
    fn begin<S: Simd, const MODE: u8>(
        &mut self,
        simd: S,
        visit: &Visit,
        plane: &DepthPlane,
        predict: impl Fn() -> i32,
    ) -> Option<(bool, u64)> {
        let bit = 1 << visit.first;
        if self.blocks.cleared[visit.column] & bit != 0 {
            self.initialise(visit.column, bit);
            return Some((true, 0));
        }
        let mut spent = 0;
        if MODE != NO_DEPTH && self.may_bypass {
            spent = clocks(self.draw.prediction, visit.rows);
            let bound = self.blocks.words[visit.column * TILE + visit.first];
            let stale = self.blocks.stale[visit.column] & bit != 0;
            let behind = plane.minimum > bound
                || ((stale || plane.maximum > bound) && {
                    let word = self.word(simd, visit.column, visit.first);
                    plane.maximum > word && predict() > word
                });
            if behind {
                self.counts.count_bypassed(visit.fragments, spent);
                return None;
            }
        }
        if MODE != NO_DEPTH && self.writes {
            self.now_written(visit.column, bit);
        }
        Some((false, spent))
    }

    /// Ends a visit of which `passed` fragments passed.
    #[inline(always)]
    fn end<const MODE: u8>(&mut self, visit: &Visit, fresh: bool, spent: u64, passed: u64) {
        let pixels = self.blocks.pixels(visit.column, 1 << visit.first);
        if fresh {
            self.counts.count_initialised(pixels, passed, self.draw.depth_buffer);
        } else if MODE == NO_DEPTH {
            self.counts.count_painted(visit.fragments);
        } else {
            self.counts.count_compared(self.writes, pixels, visit.fragments, passed, spent);
        }
    }
}

/// Draws the steps of a line that fall into the tile.
#[inline(always)]
pub fn line<S: Simd, const MODE: u8>(simd: S, line: &Line, id: u32, tile: &mut ZaTile<'_>) {
    let pixels = &tile.pixels;
    let x_major = line.axis == Axis::X;
    let (along, across) = if x_major { (pixels.columns, pixels.rows) } else { (pixels.rows, pixels.columns) };
    let (first, beyond) = (line.steps[0].max(along[0]), line.steps[1].min(along[1]));
    if first >= beyond {
        return;
    }
    tile.pixels.counts.rows_touched(tile.pixels.rows[0], tile.pixels.rows[1]);
    let plane = &line.plane;
    let (origin, gradient, length) = if x_major {
        (plane.value(first, plane.anchor[1]), plane.dx, 1_i64 << tile.blocks.width_shift())
    } else {
        (plane.value(plane.anchor[0], first), plane.dy, tile.blocks.height() as i64 - 1)
    };
    // From a step to the last of its block along the line, and from a pixel to its block's first and last across.
    let sizes = [1 << tile.blocks.width_shift(), tile.blocks.height() as i32];
    let corner = [tile.pixels.x, tile.pixels.band_y];
    let (major, minor) = if x_major { (0, 1) } else { (1, 0) };
    let mut walk = line.minor.wrapping_add(i64::from(first - line.steps[0]).wrapping_mul(line.slope));
    let mut step = first;
    while step < beyond {
        let at = (walk >> WALK) as i32;
        if at < across[0] || at >= across[1] {
            walk = walk.wrapping_add(line.slope);
            step += 1;
            continue;
        }
        let limit = (((step - corner[major]) | (sizes[major] - 1)) + 1 + corner[major]).min(beyond);
        let least = (at - corner[minor]) & !(sizes[minor] - 1);
        let (least, greatest) =
            ((least + corner[minor]).max(across[0]), (least + corner[minor] + sizes[minor]).min(across[1]));
        let (run, begun) = (step, walk);
        let mut last = at;
        loop {
            walk = walk.wrapping_add(line.slope);
            step += 1;
            let next = (walk >> WALK) as i32;
            if step == limit || next < least || next >= greatest {
                break;
            }
            last = next;
        }
        let fragments = (step - run) as u64;
        let (x, y) = if x_major { (run, at) } else { (at, run) };
        let visit = Visit {
            column: ((x - corner[0]) >> tile.blocks.width_shift()) as usize,
            first: tile.blocks.first_row((y - corner[1]) as usize),
            fragments,
            rows: if x_major { u64::from(at.abs_diff(last)) + 1 } else { fragments },
        };
        let mut value = origin.wrapping_add(i64::from(run - first).wrapping_mul(gradient));
        let (prediction, below) = (tile.draw.prediction, tile.below);
        let predict = || {
            if line.steep {
                return plane.minimum;
            }
            let length = if prediction == ZaPrediction::BlockLength { length } else { fragments as i64 - 1 };
            plane.stored(value.wrapping_add(length.wrapping_mul(gradient).min(0)), below)
        };
        let Some((fresh, spent)) = tile.begin::<S, MODE>(simd, &visit, plane, predict) else {
            continue;
        };
        let (mut walk, mut passed) = (begun, 0);
        for step in run..step {
            let at = (walk >> WALK) as i32;
            let (x, y) = if x_major { (step, at) } else { (at, step) };
            passed += u64::from(tile.fragment::<MODE>(x, y, plane.stored(value, below), id));
            walk = walk.wrapping_add(line.slope);
            value = value.wrapping_add(gradient);
        }
        tile.end::<MODE>(&visit, fresh, spent, passed);
    }
}

/// Draws a point.
#[inline(always)]
pub fn point<S: Simd, const MODE: u8>(simd: S, pixel: [i32; 2], z: i32, id: u32, tile: &mut ZaTile<'_>) {
    let [x, y] = pixel;
    let pixels = &tile.pixels;
    if !(pixels.columns[0]..pixels.columns[1]).contains(&x) || !(pixels.rows[0]..pixels.rows[1]).contains(&y) {
        return;
    }
    let visit = Visit {
        column: ((x - pixels.x) >> tile.blocks.width_shift()) as usize,
        first: tile.blocks.first_row((y - pixels.band_y) as usize),
        fragments: 1,
        rows: 1,
    };
    tile.pixels.counts.rows_touched(y, y + 1);
    let plane = DepthPlane { minimum: z, maximum: z, ..DepthPlane::default() };
    if let Some((fresh, spent)) = tile.begin::<S, MODE>(simd, &visit, &plane, || z) {
        let passed = u64::from(tile.fragment::<MODE>(x, y, z, id));
        tile.end::<MODE>(&visit, fresh, spent, passed);
    }
}
