//! Where fragments are looked for: pixels of a band, by tiles of 16 x 16.
//!
//! Inputs from: [`super::inside`]. Outputs to: [`super::band`], [`super::hide`], [`super::rows`]. Clocks: none.

use super::band::{Input, LINES};
use super::bands::Entry;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u16x16};

/// The pixels of a tile in which fragments are looked for.
#[derive(Clone, Copy, Debug)]
struct Tile {
    /// Line by line, a bit a pixel.
    lines: [u16; LINES],
    any: bool,
}

/// The pixels of a band in which fragments are looked for.
#[derive(Debug, Default)]
pub(super) struct Looked {
    tiles: Vec<Tile>,
    top: i32,
    /// They are all.
    all: bool,
}

impl Looked {
    /// None of a band's pixels, or all.
    pub(super) fn begin(&mut self, input: &Input<'_>, all: bool) {
        (self.top, self.all) = (input.top, all);
        let bits = if all { u16::MAX } else { 0 };
        self.tiles.clear();
        self.tiles.resize(input.chunks(), Tile { lines: [bits; LINES], any: all });
    }

    /// Some pixels on a line of a tile.
    #[inline(always)]
    pub(super) fn add(&mut self, line: usize, chunk: usize, pixels: u16) {
        let tile = &mut self.tiles[chunk];
        tile.lines[line] |= pixels;
        tile.any |= pixels != 0;
    }

    /// Wherever an item may be.
    pub(super) fn add_all(&mut self, input: &Input<'_>, entry: &Entry) {
        let [left, right] = [entry.from[0], entry.to[0]].map(usize::from);
        for line in self.lines([entry.from[1], entry.to[1]].map(i32::from), input.lines) {
            for chunk in left / LANES..=(right - 1) / LANES {
                self.add(line, chunk, columns(chunk, [left, right]));
            }
        }
    }

    /// Those of a chunk.
    #[inline(always)]
    pub(super) fn on(&self, line: usize, chunk: usize) -> u32 {
        u32::from(self.tiles[chunk].lines[line])
    }

    /// What of an area there are any in: its lines from the first with one to the last, and the chunks; `None` if there
    /// are none. First column and row, first beyond.
    #[inline(always)]
    pub(super) fn within<S: Simd>(&self, simd: S, [from, to]: [[u16; 2]; 2]) -> Option<[[u16; 2]; 2]> {
        if self.all {
            return Some([from, to]);
        }
        let (left, right) = (usize::from(from[0]), usize::from(to[0]));
        let rows = self.lines([i32::from(from[1]), i32::from(to[1])], LINES);
        let rows = (1_u32 << rows.end) - (1 << rows.start);
        let (mut lines, mut first, mut beyond) = (0, 0, 0);
        for chunk in left / LANES..=(right - 1) / LANES {
            let (tile, inside) = (&self.tiles[chunk], columns(chunk, [left, right]));
            if !tile.any {
                continue;
            }
            let there = u16x16::from_slice(simd, &tile.lines) & inside;
            let found = there.simd_gt(0).to_bitmask() as u32 & rows;
            if found != 0 {
                first = if lines == 0 { chunk } else { first };
                (lines, beyond) = (lines | found, chunk + 1);
            }
        }
        let row = |line: u32| (self.top as u32 + line) as u16;
        (lines != 0).then(|| {
            let from = [left.max(first * LANES) as u16, row(lines.trailing_zeros())];
            [from, [right.min(beyond * LANES) as u16, row(u32::BITS - lines.leading_zeros())]]
        })
    }

    /// Lines of the band from a row to another.
    #[inline(always)]
    fn lines(&self, rows: [i32; 2], lines: usize) -> std::ops::Range<usize> {
        let line = |row: i32| (row - self.top).clamp(0, lines as i32) as usize;
        line(rows[0])..line(rows[1])
    }

    /// How many there are.
    #[cfg(test)]
    pub(super) fn count(&self) -> u32 {
        self.tiles.iter().flat_map(|tile| tile.lines).map(u16::count_ones).sum()
    }
}

/// The columns of a chunk that lie in a range; at least one does.
#[inline(always)]
fn columns(chunk: usize, [left, right]: [usize; 2]) -> u16 {
    let x = chunk * LANES;
    (u32::from(u16::MAX) << left.saturating_sub(x) & u32::from(u16::MAX) >> (x + LANES).saturating_sub(right)) as u16
}
