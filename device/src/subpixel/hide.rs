//! What of a band is hidden already, and by what covers whole pixels.
//!
//! A pixel has three depths: the farthest that can still be seen (what lies behind it is hidden), the least and the
//! second least of the nearest ones of what covers it wholly (if the second is not hidden, two surfaces cross). They
//! are only worked out in *open* chunks of 16 pixels, in which something is covered in part, or two spans meet. A chunk
//! that one span covers keeps its piece's number, and so do the chunks below one another that one piece covers on all
//! lines of the band: the inside of a surface costs a word for sixteen lines of sixteen pixels.
//!
//! Inputs from: [`super::cover`], [`super::rows`]. Outputs to: [`super::band`].

use super::band::{Input, Work, bits_of};
use super::rows::Bounds;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16};

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

/// Depths of the pixels of an open chunk.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Depths {
    /// The farthest that may be seen.
    pub(super) far: [i32; LANES],
    /// The least nearest depth of what covers the whole pixel.
    pub(super) near: [i32; LANES],
    /// The second least.
    pub(super) second: [i32; LANES],
}

impl Depths {
    /// Pixels in which everything is seen.
    pub(super) const ALL: Depths =
        Depths { far: [i32::MAX; LANES], near: [i32::MAX; LANES], second: [i32::MAX; LANES] };
}

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
            owner => self.is_nearer(owner, piece.plane.minimum),
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
    pub(super) fn split(&mut self, input: &Input<'_>, chunk: usize) {
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
        let x = chunk * LANES;
        let columns = (input.setting.size[0] as usize - x).min(LANES);
        let depths = &mut self.depths[line * input.chunks() + chunk];
        if let (UNTOUCHED, LANES, Some(base)) = (owner, columns, input.base_depth()) {
            *depths = Depths { far: [base; LANES], near: [base; LANES], ..Depths::ALL };
            return;
        }
        let Depths { far, near, second } = depths;
        if owner == UNTOUCHED {
            match input.base_depth() {
                Some(base) => far.fill(base),
                None => far[..columns].iter_mut().zip(x..).for_each(|(far, x)| *far = input.base_at(x, line)),
            }
            *near = *far;
        } else {
            let bounds = Bounds::new(simd, input, &self.pieces[owner as usize]);
            let [nearest, farthest] = bounds.of(simd, bounds.value(x as i32, input.top + line as i32));
            nearest.store_slice(near);
            farthest.store_slice(far);
        }
        far[columns..].fill(BEYOND);
        near[columns..].fill(BEYOND);
        second.fill(i32::MAX);
    }

    /// Whether all depths of a piece are nearer than `nearest`.
    #[inline(always)]
    pub(super) fn is_nearer(&self, piece: u32, nearest: i32) -> bool {
        self.pieces[piece as usize].plane.maximum < nearest
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
        let (left, right) = (left as usize, right as usize);
        for chunk in left / LANES..(right - 1) / LANES + 1 {
            let column = self.columns[chunk];
            match column {
                UNTOUCHED | OPEN => {}
                owner if self.is_nearer(owner, nearest) => continue,
                _ => return false,
            }
            let x = chunk * LANES;
            let inside = bits_of(0, left.saturating_sub(x), (right - x).min(LANES)) as u32;
            for line in (first - input.top) as usize..(beyond - input.top) as usize {
                let wanted = inside & self.inside.looked.on(line, chunk);
                if wanted == 0 {
                    continue;
                }
                if column == UNTOUCHED {
                    return false;
                }
                match self.owners[line * input.chunks() + chunk] {
                    OPEN => {
                        let far = i32x16::from_slice(simd, &self.depths[line * input.chunks() + chunk].far);
                        if wanted & far.simd_ge(nearest).to_bitmask() as u32 != 0 {
                            return false;
                        }
                    }
                    UNTOUCHED => return false,
                    owner if self.is_nearer(owner, nearest) => {}
                    _ => return false,
                }
            }
        }
        true
    }

    /// Pixels where two whole covers may cross become active.
    #[inline(always)]
    pub(super) fn cross<S: Simd>(&mut self, simd: S, input: &Input<'_>) {
        let words = input.words();
        for chunk in (0..input.chunks()).filter(|&chunk| self.columns[chunk] == OPEN) {
            for line in 0..input.lines {
                let at = line * input.chunks() + chunk;
                if self.owners[at] != OPEN {
                    continue;
                }
                let second = i32x16::from_slice(simd, &self.depths[at].second);
                let far = i32x16::from_slice(simd, &self.depths[at].far);
                let crossed = second.simd_le(far).to_bitmask();
                let crossed = crossed as u32 & self.inside.looked.on(line, chunk);
                self.active[line * words + chunk / 4] |= u64::from(crossed) << (chunk % 4 * LANES);
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
