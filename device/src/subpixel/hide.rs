//! What of a band is hidden by what covers whole pixels, and where two such cross.

use super::band::{Input, Work};
use super::piece::Piece;
use crate::geometry::plane::below;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u32x16};

impl Work {
    /// Depths of what covers whole pixels, in the chunks that need them; pixels where two cross become active.
    #[inline(always)]
    pub(super) fn compare<S: Simd>(&mut self, simd: S, input: &Input<'_>) {
        let (chunks, pitch, chunk_words) = (input.chunks(), input.pitch(), input.chunk_words());
        for depths in [&mut self.far, &mut self.near, &mut self.second] {
            depths.resize((pitch * input.lines).max(depths.len()), 0);
        }
        for (need, part) in self.need.iter_mut().zip(&self.part) {
            *need |= part;
        }
        let uniform = input.base_depth();
        for line in 0..input.lines {
            for chunk in 0..chunks {
                if self.need[line * chunk_words + chunk / 64] & (1 << (chunk % 64)) == 0 {
                    continue;
                }
                let place = line * pitch + chunk * LANES;
                let far = &mut self.far[place..place + LANES];
                match uniform {
                    Some(base) => far.fill(base),
                    None => {
                        for (x, far) in (chunk * LANES..).zip(&mut *far) {
                            *far = input.base_at(x, line);
                        }
                    }
                }
                self.near[place..place + LANES].copy_from_slice(far);
                self.second[place..place + LANES].fill(i32::MAX);
            }
        }
        let wide = below(input.setting.format) != 32;
        let mut lanes = (u32::MAX, Steps::new(simd, 0));
        let lane = u32x16::from_slice(simd, &LANE);
        for span in &mut self.spans {
            let piece = &self.pieces[span.piece as usize];
            if piece.layer {
                continue;
            }
            let (line, from, to) = (usize::from(span.line), usize::from(span.columns[0]), usize::from(span.columns[1]));
            if lanes.0 != span.piece {
                lanes = (span.piece, Steps::new(simd, piece.row_step()));
            }
            let (minimum, maximum) = (piece.plane.minimum, piece.plane.maximum);
            let y = input.top + i32::from(span.line);
            let mut chunk = from / LANES;
            let mut values = piece.row_values((chunk * LANES) as i32, y);
            let step = piece.row_step().wrapping_mul(LANES as i64);
            let mut any = false;
            while chunk * LANES < to {
                let x = chunk * LANES;
                let needed = self.need[line * chunk_words + chunk / 64] & (1 << (chunk % 64)) != 0;
                let [value, value_far] = values;
                values = [value.wrapping_add(step), value_far.wrapping_add(step)];
                chunk += 1;
                if !needed {
                    continue;
                }
                let place = line * pitch + x;
                let inside = (lane - (from as u32).wrapping_sub(x as u32)).simd_lt((to - from) as u32);
                let (nearest, farthest) = if wide {
                    wide_bounds(simd, piece, x, from, to, y)
                } else {
                    (
                        lanes.1.upper(simd, value).max(minimum).min(maximum),
                        lanes.1.upper(simd, value_far).max(minimum).min(maximum),
                    )
                };
                let far = i32x16::from_slice(simd, &self.far[place..place + LANES]);
                // What is hidden already changes nothing.
                let seen = inside & nearest.simd_le(far);
                if seen.to_bitmask() == 0 {
                    continue;
                }
                any = true;
                let near = i32x16::from_slice(simd, &self.near[place..place + LANES]);
                let second = i32x16::from_slice(simd, &self.second[place..place + LANES]);
                seen.select(far.min(farthest), far).store_slice(&mut self.far[place..place + LANES]);
                seen.select(second.min(near.max(nearest)), second).store_slice(&mut self.second[place..place + LANES]);
                seen.select(near.min(nearest), near).store_slice(&mut self.near[place..place + LANES]);
            }
            if !any {
                // Nothing of it is a fragment.
                span.columns = [0; 2];
            }
        }
        let words = input.words();
        for line in 0..input.lines {
            for chunk in 0..chunks {
                if self.need[line * chunk_words + chunk / 64] & (1 << (chunk % 64)) == 0 {
                    continue;
                }
                let place = line * pitch + chunk * LANES;
                let second = i32x16::from_slice(simd, &self.second[place..place + LANES]);
                let far = i32x16::from_slice(simd, &self.far[place..place + LANES]);
                let crossed = second.simd_le(far).to_bitmask();
                self.active[line * words + chunk / 4] |= crossed << (chunk % 4 * LANES);
            }
        }
    }

    /// Where no rule says what hides what: a pixel with two covers is active, or with one that may pass in part.
    pub(super) fn count_covers(&mut self, input: &Input<'_>) {
        self.far.clear();
        self.far.resize(input.pitch() * input.lines, i32::MAX);
        self.stacked.clear();
        self.stacked.resize(input.pitch() * input.lines, 0);
        for span in &self.spans {
            let piece = &self.pieces[span.piece as usize];
            let count = if input.undecided(piece) { 2 } else { 1 };
            let line = usize::from(span.line) * input.pitch();
            let [from, to] = span.columns.map(usize::from);
            self.stacked[line + from..line + to].iter_mut().for_each(|n| *n = n.saturating_add(count));
        }
        for line in 0..input.lines {
            for x in 0..input.setting.size[0] as usize {
                if self.stacked[line * input.pitch() + x] >= 2 {
                    self.active[line * input.words() + x / 64] |= 1 << (x % 64);
                }
            }
        }
    }
}

/// Bounds of the depths of a chunk where they do not fit in two halves (depths of 31 bits).
#[inline(always)]
fn wide_bounds<S: Simd>(simd: S, piece: &Piece, x: usize, from: usize, to: usize, y: i32) -> (i32x16<S>, i32x16<S>) {
    let mut bounds = [[0; LANES]; 2];
    for column in from.max(x)..to.min(x + LANES) {
        [bounds[0][column - x], bounds[1][column - x]] = piece.bounds(column as i32, y);
    }
    (i32x16::from_slice(simd, &bounds[0]), i32x16::from_slice(simd, &bounds[1]))
}
