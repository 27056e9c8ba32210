//! What of a band is hidden already, and by what covers whole pixels.
//!
//! A pixel has three depths: the farthest that can still be seen (what lies behind it is hidden), the least and the
//! second least of the nearest ones of what covers it wholly (if the second is not hidden, two surfaces cross). They
//! are only worked out in *open* chunks of 16 pixels, in which something is covered in part, or two spans meet. A chunk
//! that one span covers keeps its piece's number, and so do the chunks below one another that one piece covers on all
//! lines of the band: the inside of a surface costs a word for sixteen lines of sixteen pixels.
//!
//! Inputs from: [`super::cover`]. Outputs to: [`super::band`].

use super::band::{Input, Work};
use super::piece::Piece;
use crate::geometry::plane::below;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u32x16};

/// A run of pixels on one line that a piece covers wholly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) piece: u32,
    /// Line of the band.
    pub(super) line: u16,
    /// First column, first beyond.
    pub(super) columns: [u16; 2],
}

/// A chunk that nothing has touched.
pub(super) const UNTOUCHED: u32 = u32::MAX;
/// A chunk whose depths are worked out.
pub(super) const OPEN: u32 = u32::MAX - 1;

/// The farthest depth that is seen beyond the right edge of the target: nothing is.
const BEYOND: i32 = i32::MIN;

impl Work {
    /// Lets the last piece have the chunks in `columns`, which it covers on all lines of the band, if that decides what is
    /// seen there: they are untouched, or what has them is nearer. Returns the chunks; none if it is not so.
    #[inline(always)]
    pub(super) fn take_chunks(&mut self, input: &Input<'_>, [from, to]: [i32; 2]) -> [usize; 2] {
        let number = self.pieces.len() - 1;
        let piece = &self.pieces[number];
        let first = (from.max(0) as usize).div_ceil(LANES);
        let width = input.setting.size[0] as usize;
        let beyond = if to.max(0) as usize >= width { input.chunks() } else { to.max(0) as usize / LANES };
        if first >= beyond || piece.layer || input.undecided(piece) {
            return [0; 2];
        }
        let decided = |&owner: &u32| match owner {
            UNTOUCHED => true,
            OPEN => false,
            owner => self.pieces[owner as usize].plane.maximum < piece.plane.minimum,
        };
        if !self.columns[first..beyond].iter().all(decided) {
            return [0; 2];
        }
        for owner in &mut self.columns[first..beyond] {
            if *owner == UNTOUCHED {
                *owner = number as u32;
            }
        }
        [first, beyond]
    }

    /// Gives the chunks below one another an owner each.
    #[inline(always)]
    fn split(&mut self, input: &Input<'_>, chunk: usize) {
        let owner = std::mem::replace(&mut self.columns[chunk], OPEN);
        if owner == OPEN {
            return;
        }
        let from = chunk * LANES;
        let to = (from + LANES).min(input.setting.size[0] as usize);
        for line in 0..input.lines {
            self.owners[line * input.chunks() + chunk] = owner;
            if owner != UNTOUCHED {
                self.spans.push(Span { piece: owner, line: line as u16, columns: [from as u16, to as u16] });
            }
        }
    }

    /// Works the depths of a chunk out, if that is still to be done.
    #[inline(always)]
    pub(super) fn open<S: Simd>(&mut self, simd: S, input: &Input<'_>, line: usize, chunk: usize) {
        self.split(input, chunk);
        let owner = &mut self.owners[line * input.chunks() + chunk];
        if *owner == OPEN {
            return;
        }
        let owner = std::mem::replace(owner, OPEN);
        let (x, y) = (chunk * LANES, input.top + line as i32);
        let columns = (input.setting.size[0] as usize - x).min(LANES);
        let place = line * input.pitch() + x;
        let far = &mut self.far[place..place + LANES];
        let near = &mut self.near[place..place + LANES];
        if owner == UNTOUCHED {
            match input.base_depth() {
                Some(base) => far.fill(base),
                None => far[..columns].iter_mut().zip(x..).for_each(|(far, x)| *far = input.base_at(x, line)),
            }
            near.copy_from_slice(far);
        } else {
            let piece = &self.pieces[owner as usize];
            let values = piece.row_values(x as i32, y);
            let bounds =
                bounds(simd, input, piece, &Steps::new(simd, piece.row_step()), values, [x, x + columns, y as usize]);
            bounds.0.store_slice(near);
            bounds.1.store_slice(far);
        }
        far[columns..].fill(BEYOND);
        near[columns..].fill(BEYOND);
        self.second[place..place + LANES].fill(i32::MAX);
    }

    /// Whether everything in `area` that is not nearer than `nearest` is hidden.
    #[inline(always)]
    pub(super) fn is_hidden<S: Simd>(
        &self,
        simd: S,
        input: &Input<'_>,
        nearest: i32,
        [[left, first], [right, beyond]]: [[i32; 2]; 2],
    ) -> bool {
        let lane = u32x16::from_slice(simd, &LANE);
        let (left, right) = (left as usize, right as usize);
        let nearer = |owner: u32| self.pieces[owner as usize].plane.maximum < nearest;
        for chunk in left / LANES..(right - 1) / LANES + 1 {
            match self.columns[chunk] {
                UNTOUCHED => return false,
                OPEN => {}
                owner if nearer(owner) => continue,
                _ => return false,
            }
            for line in (first - input.top) as usize..(beyond - input.top) as usize {
                match self.owners[line * input.chunks() + chunk] {
                    OPEN => {
                        let place = line * input.pitch() + chunk * LANES;
                        let far = i32x16::from_slice(simd, &self.far[place..place + LANES]);
                        let x = chunk * LANES;
                        let inside = (lane - (left as u32).wrapping_sub(x as u32)).simd_lt((right - left) as u32);
                        if (inside & far.simd_ge(nearest)).to_bitmask() != 0 {
                            return false;
                        }
                    }
                    UNTOUCHED => return false,
                    owner if nearer(owner) => {}
                    _ => return false,
                }
            }
        }
        true
    }

    /// What a span of an opaque piece, the last one set up, hides; of a layer's nothing. False if it is hidden itself.
    #[inline(always)]
    pub(super) fn hide<S: Simd>(&mut self, simd: S, input: &Input<'_>, steps: &Steps<S>, span: &Span) -> bool {
        let piece = &self.pieces[span.piece as usize];
        if piece.layer {
            return true;
        }
        let undecided = input.undecided(piece);
        let width = input.setting.size[0] as usize;
        let (line, from, to) = (usize::from(span.line), usize::from(span.columns[0]), usize::from(span.columns[1]));
        let y = input.top + i32::from(span.line);
        let lane = u32x16::from_slice(simd, &LANE);
        let minimum = piece.plane.minimum;
        let step = piece.row_step().wrapping_mul(LANES as i64);
        let mut values = piece.row_values((from / LANES * LANES) as i32, y);
        let mut any = false;
        for chunk in from / LANES..(to - 1) / LANES + 1 {
            let x = chunk * LANES;
            let [value, value_far] = values;
            values = [value.wrapping_add(step), value_far.wrapping_add(step)];
            match self.columns[chunk] {
                OPEN => {}
                owner if owner != UNTOUCHED && self.pieces[owner as usize].plane.maximum < minimum => continue,
                _ => self.split(input, chunk),
            }
            let owner = &mut self.owners[line * input.chunks() + chunk];
            if *owner != OPEN {
                let all = from <= x && to >= (x + LANES).min(width);
                if *owner == UNTOUCHED && all && !undecided {
                    *owner = span.piece;
                    any = true;
                    continue;
                }
                if *owner != UNTOUCHED && self.pieces[*owner as usize].plane.maximum < minimum {
                    continue;
                }
                self.open(simd, input, line, chunk);
            }
            let piece = &self.pieces[span.piece as usize];
            let place = line * input.pitch() + x;
            let inside = (lane - (from as u32).wrapping_sub(x as u32)).simd_lt((to - from) as u32);
            let columns = [from.max(x), to.min(x + LANES)];
            let (nearest, farthest) =
                bounds(simd, input, piece, steps, [value, value_far], [columns[0], columns[1], y as usize]);
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
        any
    }

    /// Pixels where two whole covers may cross become active.
    #[inline(always)]
    pub(super) fn cross<S: Simd>(&mut self, simd: S, input: &Input<'_>) {
        let words = input.words();
        for chunk in (0..input.chunks()).filter(|&chunk| self.columns[chunk] == OPEN) {
            for line in 0..input.lines {
                if self.owners[line * input.chunks() + chunk] != OPEN {
                    continue;
                }
                let place = line * input.pitch() + chunk * LANES;
                let second = i32x16::from_slice(simd, &self.second[place..place + LANES]);
                let far = i32x16::from_slice(simd, &self.far[place..place + LANES]);
                let crossed = second.simd_le(far).to_bitmask();
                self.active[line * words + chunk / 4] |= crossed << (chunk % 4 * LANES);
            }
        }
    }

    /// Where no rule says what hides what: a pixel with two covers is active, or with one that may pass in part.
    pub(super) fn count_covers(&mut self, input: &Input<'_>) {
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

/// Bounds of the depths of a chunk whose lane 0 has `values`; columns `from..to` of row `y` of it matter.
#[inline(always)]
fn bounds<S: Simd>(
    simd: S,
    input: &Input<'_>,
    piece: &Piece,
    steps: &Steps<S>,
    values: [i64; 2],
    [from, to, y]: [usize; 3],
) -> (i32x16<S>, i32x16<S>) {
    let (minimum, maximum) = (piece.plane.minimum, piece.plane.maximum);
    if below(input.setting.format) == 32 {
        let [near, far] = values.map(|value| steps.upper(simd, value).max(minimum).min(maximum));
        return (near, far);
    }
    // Depths of 31 bits do not fit in two halves.
    let mut bounds = [[0; LANES]; 2];
    for column in from..to {
        [bounds[0][column % LANES], bounds[1][column % LANES]] = piece.bounds(column as i32, y as i32);
    }
    (i32x16::from_slice(simd, &bounds[0]), i32x16::from_slice(simd, &bounds[1]))
}
