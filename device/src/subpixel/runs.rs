//! Pixels that the last piece covers in part, until their masks are made.
//!
//! Duties: of a chunk's pixels that may be seen those are kept that have a mask, as fragments. All of a triangle's chunks
//! are gone through at once, without a branch on what is found: how many pixels of a chunk are covered in part, and
//! which of them at all, no predictor knows. Inputs from: [`super::rows`]. Outputs to: [`super::lists`]. Clocks: none.

use super::band::{Input, Work};
use super::lists::Fragment;
use super::walk::Slot;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::Simd;
use std::hint::select_unpredictable;

/// Pixels of a chunk that a piece covers in part.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(super) struct Run {
    /// Bounds of their depths.
    pub(super) near: [i32; LANES],
    pub(super) far: [i32; LANES],
    /// The chunk's place in the band.
    pub(super) at: u32,
    /// The pixels, a bit each.
    pub(super) pixels: u32,
    /// Those that are fragments even without a mask.
    pub(super) centres: u32,
    /// What their masks come from: a slot, the row in it, and the first pixel's column, modulo 256.
    pub(super) slot: u32,
    pub(super) number: u32,
    pub(super) column: u32,
    /// The first one's bit among those of the active pixels.
    pub(super) active: u32,
}

/// All that wait.
#[derive(Debug, Default)]
pub(super) struct Runs {
    /// The first [`Runs::count`] wait.
    list: Vec<Run>,
    count: usize,
    pub(super) slots: Vec<Slot>,
}

impl Runs {
    /// None.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.slots.clear();
    }

    /// Makes room for as many chunks.
    #[inline(always)]
    pub(super) fn reserve(&mut self, more: usize) {
        // One more ends the list.
        if self.count + more >= self.list.len() {
            self.list.resize(2 * (self.count + more + 1), Run::default());
        }
    }

    /// Adds a run, if it has pixels.
    #[inline(always)]
    pub(super) fn push(&mut self, fill: impl FnOnce(&mut Run)) {
        let run = &mut self.list[self.count];
        fill(run);
        self.count += usize::from(run.pixels != 0);
    }
}

impl Work {
    /// Makes the masks of the runs that wait; those of the last piece.
    #[inline(always)]
    pub(super) fn make_masks<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        hides: bool,
    ) {
        let runs = &self.runs.list[..=self.runs.count];
        let count = runs[..self.runs.count].iter().map(|run| run.pixels.count_ones() as usize).sum();
        if self.lists.has_room(count) {
            let full = input.setting.grid.full();
            let piece = self.pieces.len() as u32 - 1;
            let (mut place, mut left) = (0, runs[0].pixels);
            for _ in 0..count {
                let run = &runs[place];
                let lane = left.trailing_zeros() as usize % LANES;
                let rest = left & (left - 1);
                place += usize::from(rest == 0);
                left = select_unpredictable(rest == 0, runs[place].pixels, rest);
                let column = run.column.wrapping_add((lane * C) as u32);
                let mask = self.runs.slots[run.slot as usize].mask::<S, C, R>(simd, run.number as usize, column);
                let keep = (mask != 0) | ((run.centres >> lane) & 1 != 0);
                let fragment = Fragment::new(mask, piece, [run.near[lane], run.far[lane]]);
                let limit = &mut self.depths[run.at as usize].far[lane];
                self.lists.put_opaque(run.at as usize * LANES + lane, fragment, [keep, hides], full, limit);
                let bit = run.active as usize + lane;
                self.active[bit / 64] |= u64::from(keep) << (bit % 64);
            }
        }
        self.runs.clear();
    }
}
