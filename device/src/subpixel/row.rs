//! One row of pixels of a piece: what of it is seen becomes fragments, and hides.
//!
//! Duties: for the 16 pixels of a chunk the bounds of their depths, at once; of the pixels that the piece covers in part
//! those that are not hidden already wait for their masks; the others hide what lies behind them. Inputs from:
//! [`super::cover`], [`super::walk`]. Outputs to: [`super::runs`], [`super::hide`]. Clocks: none.

use super::band::{Input, Work};
use super::hide::{OPEN, Span, UNTOUCHED};
use super::piece::Piece;
use super::scene::Rule;
use super::walk::{Masks, low_bits};
use crate::geometry::plane::below;
use crate::hidden::z_buffer::kernel::{LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, mask32x16};

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

/// Pixels of the last piece on one row of pixels; first columns and first beyond.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Row of the target.
    pub(super) y: i32,
    /// Which of the rows that are walked together.
    pub(super) number: usize,
    /// All.
    pub(super) met: [i32; 2],
    /// Those that it covers wholly, if any.
    pub(super) whole: [i32; 2],
    /// Those whose centres it covers, as far as that must be known.
    pub(super) centre: [i32; 2],
    /// Chunks of the whole ones that it has on all lines of the band: first, first beyond.
    pub(super) taken: [usize; 2],
}

impl Work {
    /// A row of the last piece.
    #[inline(always)]
    pub(super) fn row<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        bounds: &Bounds<S>,
        masks: &mut Masks<S>,
        row: Row,
    ) {
        let Row { y, number, met, whole, centre, taken } = row;
        if met[0] >= met[1] {
            return;
        }
        let place = self.pieces.len() - 1;
        let piece = &self.pieces[place];
        let ordered = input.setting.rule == Rule::InOrder;
        let hides = !piece.layer && !ordered;
        let undecided = input.undecided(piece);
        let line = (y - input.top) as usize;
        let (first, last) = (met[0] as usize / LANES, (met[1] - 1) as usize / LANES);
        self.runs.reserve(last + 1 - first);
        let step = bounds.gradient[0].wrapping_mul(LANES as i64);
        let mut next = bounds.value((first * LANES) as i32, y);
        // A whole pixel is seen.
        let mut seen_whole = !hides;
        for chunk in first..=last {
            let value = next;
            next = next.wrapping_add(step);
            if (taken[0]..taken[1]).contains(&chunk) {
                continue;
            }
            let x = (chunk * LANES) as i32;
            let inside = |[from, to]: [i32; 2]| low_bits(to - x) & !low_bits(from - x);
            let (all, whole) = (inside(met), inside(whole));
            let parts = all & !whole;
            if parts == 0 && !hides {
                continue;
            }
            match self.columns[chunk] {
                OPEN => {}
                owner if owner != UNTOUCHED && self.is_nearer(owner, bounds.minimum) => continue,
                _ => self.split(input, chunk),
            }
            let at = line * input.chunks() + chunk;
            let owner = self.owners[at];
            if owner != OPEN {
                if owner == UNTOUCHED && !undecided && whole == low_bits(input.setting.size[0] as i32 - x) {
                    self.owners[at] = place as u32;
                    seen_whole = true;
                    continue;
                }
                if owner != UNTOUCHED && self.is_nearer(owner, bounds.minimum) {
                    continue;
                }
                self.open(simd, input, line, chunk);
            }
            let [near, far] = bounds.of(simd, value);
            let depths = &mut self.depths[at];
            let limit = i32x16::from_slice(simd, &depths.far);
            // What is hidden already changes nothing.
            let seen = near.simd_le(limit).to_bitmask() as u32 & all;
            if seen & whole != 0 && hides {
                seen_whole = true;
                let seen = mask32x16::from_bitmask(simd, u64::from(seen & whole));
                let nearest = i32x16::from_slice(simd, &depths.near);
                let second = i32x16::from_slice(simd, &depths.second);
                seen.select(limit.min(far), limit).store_slice(&mut depths.far);
                seen.select(second.min(nearest.max(near)), second).store_slice(&mut depths.second);
                seen.select(nearest.min(near), nearest).store_slice(&mut depths.near);
            }
            if parts == 0 {
                continue;
            }
            masks.reach::<C>(simd, &mut self.runs.slots, [met[0].max(x), (met[1] - 1).min(x + LANES as i32 - 1)]);
            self.runs.push(|run| {
                near.store_slice(&mut run.near);
                far.store_slice(&mut run.far);
                run.at = at as u32;
                run.pixels = seen & parts;
                run.centres = inside(centre);
                run.place = masks.place::<C, R>(number, x);
                run.active = (line * input.words() * 64 + chunk * LANES) as u32;
            });
        }
        if !seen_whole {
            return;
        }
        let [left, right] = taken.map(|chunk| (chunk * LANES) as i32);
        let spans = if left < right { [[whole[0], left], [right, whole[1]]] } else { [whole, [0; 2]] };
        for columns in spans {
            if columns[0] < columns[1] {
                let columns = columns.map(|column| column as u16);
                self.spans.push(Span { piece: place as u32, line: line as u16, columns });
            }
        }
    }
}
