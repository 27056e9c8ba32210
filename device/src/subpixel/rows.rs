//! The rows of pixels of a piece: what of them is seen, and hides.
//!
//! Duties: for the 16 pixels of a chunk the bounds of their depths, at once; of the pixels that the piece covers in part
//! those that are not hidden already wait for their masks; the others hide what lies behind them. Inputs from:
//! [`super::cover`], [`super::walk`]. Outputs to: [`super::runs`], [`super::hide`]. Clocks: none.

use super::band::{Input, LINES, Work};
use super::hide::{OPEN, Span, UNTOUCHED};
use super::piece::Piece;
use super::runs::Run;
use super::walk::Slot;
use crate::geometry::plane::below;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, mask32x16, u32x16};

/// Bounds of the depths of a piece's pixels, and what else its rows share.
pub(super) struct Bounds<S: Simd> {
    steps: Steps<S>,
    /// The least value of pixel (0, 0), modulo 2^64.
    origin: i64,
    /// Change for one pixel to the right and down.
    gradient: [i64; 2],
    /// From the least value of a pixel to the greatest.
    range: i64,
    pub(super) minimum: i32,
    maximum: i32,
    below: u32,
}

impl<S: Simd> Bounds<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, input: &Input<'_>, piece: &Piece) -> Self {
        let (minimum, maximum) = (piece.plane.minimum, piece.plane.maximum);
        let ([near, far], gradient) = piece.values();
        Bounds {
            steps: Steps::new(simd, gradient[0]),
            origin: near,
            gradient,
            range: far.wrapping_sub(near),
            minimum,
            maximum,
            below: below(input.setting.format),
        }
    }

    /// Least value of pixel (`x`, `y`).
    #[inline(always)]
    pub(super) fn value(&self, x: i32, y: i32) -> i64 {
        let across = i64::from(x).wrapping_mul(self.gradient[0]);
        self.origin.wrapping_add(across).wrapping_add(i64::from(y).wrapping_mul(self.gradient[1]))
    }

    /// Least and greatest depths of a chunk, lane 0 of which has `value`; exactly those of [`Piece::bounds`].
    #[inline(always)]
    pub(super) fn of(&self, simd: S, value: i64) -> [i32x16<S>; 2] {
        if self.below == 32 {
            let [near, far] = self.steps.range(simd, value, self.range);
            let (minimum, maximum) = (self.minimum, self.maximum);
            return [near.max(minimum).min(maximum), far.max(minimum).min(maximum)];
        }
        // Depths of 31 bits do not fit in two halves.
        let (minimum, maximum) = (i64::from(self.minimum), i64::from(self.maximum));
        let mut bounds = [[0; LANES]; 2];
        let mut value = value;
        for lane in 0..LANES {
            for (bound, value) in bounds.iter_mut().zip([value, value.wrapping_add(self.range)]) {
                bound[lane] = (value >> self.below).clamp(minimum, maximum) as i32;
            }
            value = value.wrapping_add(self.gradient[0]);
        }
        [i32x16::from_slice(simd, &bounds[0]), i32x16::from_slice(simd, &bounds[1])]
    }
}

/// Pixels of a piece on one row of pixels; first columns and first beyond.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// All.
    pub(super) met: [i32; 2],
    /// Those that it covers wholly; from more to less if there are none.
    pub(super) whole: [i32; 2],
    /// Those whose centres it covers, as far as that must be known.
    pub(super) centre: [i32; 2],
    /// A whole one may be seen.
    seen: bool,
}

/// The rows of a piece in a band.
pub(super) struct Rows {
    /// The first is that of line `line` of the band, `count` mean something.
    pub(super) rows: [Row; LINES],
    pub(super) line: usize,
    pub(super) count: usize,
    /// Chunks of whole pixels that it has on all lines of the band: first, first beyond.
    pub(super) taken: [usize; 2],
    /// Whole pixels hide what lies behind them.
    pub(super) hides: bool,
}

/// A chunk that a piece meets.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Visit {
    /// Among the piece's rows.
    row: u32,
    /// First column.
    x: u32,
    /// Place in the band.
    at: u32,
    /// Pixels in which fragments are looked for.
    wanted: u32,
}

impl Work {
    /// The rows of the last piece. `slots` gives, for a row, the first column of a chunk, and the first and last pixel
    /// met there, the slot and the column of the chunk's first pixel.
    #[inline(always)]
    pub(super) fn rows<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        bounds: &Bounds<S>,
        rows: &mut Rows,
        mut slots: impl FnMut(&mut Vec<Slot>, usize, i32, [i32; 2]) -> [u32; 2],
    ) {
        self.meet(simd, input, bounds, rows);
        let lane = u32x16::from_slice(simd, &LANE);
        let hides = if rows.hides { u32x16::splat(simd, 0) } else { u32x16::splat(simd, LANES as u32) };
        let hides = lane.simd_ge(hides);
        self.runs.reserve(self.visits.len());
        for &Visit { row: number, x, at, wanted } in &self.visits {
            let number = number as usize;
            let line = rows.line + number;
            let row = &mut rows.rows[number];
            let [near, far] = bounds.of(simd, bounds.value(x as i32, input.top + line as i32));
            let columns = lane + x;
            let depths = &mut self.depths[at as usize];
            let limit = i32x16::from_slice(simd, &depths.far);
            // What is hidden already changes nothing.
            let seen = near.simd_le(limit) & inside(columns, row.met);
            let whole = inside(columns, row.whole);
            let parts = (seen & !whole).to_bitmask() as u32 & wanted;
            let whole = seen & whole & hides;
            row.seen |= whole.to_bitmask() != 0;
            let nearest = i32x16::from_slice(simd, &depths.near);
            let second = i32x16::from_slice(simd, &depths.second);
            whole.select(limit.min(far), limit).store_slice(&mut depths.far);
            whole.select(second.min(nearest.max(near)), second).store_slice(&mut depths.second);
            whole.select(nearest.min(near), nearest).store_slice(&mut depths.near);
            let centres = inside(columns, row.centre).to_bitmask() as u32;
            let x = x as i32;
            let reach = [row.met[0].max(x), (row.met[1] - 1).min(x + LANES as i32 - 1)];
            let [slot, column] = if parts != 0 { slots(&mut self.runs.slots, number, x, reach) } else { [0; 2] };
            let active = (line * input.words() * 64) as u32 + x as u32;
            self.runs.push(|run: &mut Run| {
                near.store_slice(&mut run.near);
                far.store_slice(&mut run.far);
                (run.at, run.pixels, run.centres, run.active) = (at, parts, centres, active);
                (run.slot, run.number, run.column) = (slot, number as u32, column);
            });
        }
        self.make_masks::<S, C, R>(simd, input, rows.hides);
        let piece = self.pieces.len() as u32 - 1;
        let [left, right] = rows.taken.map(|chunk| (chunk * LANES) as i32);
        for (row, line) in rows.rows[..rows.count].iter().zip(rows.line..) {
            let [from, to] = row.whole;
            if !row.seen {
                continue;
            }
            let spans = if left < right { [[from, left], [right, to]] } else { [row.whole, [0; 2]] };
            for columns in spans.into_iter().filter(|[from, to]| from < to) {
                let columns = columns.map(|column| column as u16);
                self.spans.push(Span { piece, line: line as u16, columns });
            }
        }
    }

    /// Lists the chunks that are to be looked at; they are open.
    #[inline(always)]
    fn meet<S: Simd>(&mut self, simd: S, input: &Input<'_>, bounds: &Bounds<S>, rows: &mut Rows) {
        let place = self.pieces.len() - 1;
        let undecided = input.undecided(&self.pieces[place]);
        let width = input.setting.size[0] as i32;
        let chunks = input.chunks();
        self.visits.clear();
        for number in 0..rows.count {
            let Row { met, whole, .. } = rows.rows[number];
            let line = rows.line + number;
            // What hides nothing is all seen.
            let mut seen = !rows.hides;
            if met[0] >= met[1] {
                continue;
            }
            for chunk in met[0] as usize / LANES..=(met[1] - 1) as usize / LANES {
                if (rows.taken[0]..rows.taken[1]).contains(&chunk) {
                    continue;
                }
                let x = (chunk * LANES) as i32;
                let wanted = self.inside.looked.on(line, chunk);
                if wanted == 0 {
                    continue;
                }
                let all = whole[0] <= x && whole[1] >= width.min(x + LANES as i32);
                if all && !rows.hides {
                    continue;
                }
                match self.columns[chunk] {
                    OPEN => {}
                    owner if owner != UNTOUCHED && self.is_nearer(owner, bounds.minimum) => continue,
                    _ => self.split(input, chunk),
                }
                let at = line * chunks + chunk;
                let owner = self.owners[at];
                if owner != OPEN {
                    if owner == UNTOUCHED && !undecided && all {
                        self.owners[at] = place as u32;
                        seen = true;
                        continue;
                    }
                    if owner != UNTOUCHED && self.is_nearer(owner, bounds.minimum) {
                        continue;
                    }
                    self.open(simd, input, line, chunk);
                }
                self.visits.push(Visit { row: number as u32, x: x as u32, at: at as u32, wanted });
            }
            rows.rows[number].seen = seen;
        }
    }
}

/// The columns that lie in a range.
#[inline(always)]
fn inside<S: Simd>(columns: u32x16<S>, [from, to]: [i32; 2]) -> mask32x16<S> {
    (columns - from as u32).simd_lt((to - from).max(0) as u32)
}
