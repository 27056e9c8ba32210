//! What lists are drawn onto: a surface as rows of pixels, clip boxes, and what a part of it costs.
//!
//! Duties: takes the clip boxes of a list apart once; cuts entries to them; counts pixels and lines of the parts.
//! Inputs from: [`super::fill_list`] and the other units of lists. Outputs to: the same. Clocks: those that these charge.

use crate::memory::lines;
use zga_firmware::checked::{ClipBox, Image};

/// A surface as pixels of memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Index of its first pixel.
    first: usize,
    /// Pixels from a row to the next.
    pub(super) pitch: usize,
}

impl Grid {
    /// A surface in memory as pixels of its size.
    pub(super) fn of(surface: &Image) -> Grid {
        let bytes = surface.format.bytes();
        Grid { first: (surface.base / bytes) as usize, pitch: (surface.pitch / bytes) as usize }
    }

    /// Index of a pixel of the surface.
    #[inline(always)]
    pub(super) fn at(&self, x: i32, y: i32) -> usize {
        self.first + y as usize * self.pitch + x as usize
    }

    /// Index of a place that may lie outside, to step on from.
    #[inline(always)]
    pub(super) fn reckon(&self, x: i32, y: i32) -> i64 {
        self.first as i64 + i64::from(y) * self.pitch as i64 + i64::from(x)
    }
}

/// Pixels and lines of parts of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Painted {
    pub(super) pixels: u64,
    pub(super) lines: u64,
}

impl Painted {
    /// Counts a part, which is not empty.
    #[inline(always)]
    pub(super) fn add(&mut self, surface: &Image, part: ClipBox) {
        let [width, rows] = [part.x2 - part.x1, part.y2 - part.y1].map(|side| side as u64);
        let bytes = u64::from(surface.format.bytes());
        let row_bytes = width * bytes;
        let pitch = u64::from(surface.pitch);
        let first = u64::from(surface.base) + part.y1 as u64 * pitch + part.x1 as u64 * bytes;
        self.pixels += width * rows;
        // Where a pitch is whole lines, all rows lie alike.
        self.lines += if pitch.is_multiple_of(crate::memory::LINE_BYTES) {
            rows * lines(first, row_bytes)
        } else {
            (0..rows).map(|row| lines(first + row * pitch, row_bytes)).sum()
        };
    }
}

/// Each part of an entry that lies in a clip box, box by box.
#[inline(always)]
pub(super) fn parts(entry: ClipBox, clips: &[ClipBox]) -> impl Iterator<Item = ClipBox> {
    clips.iter().map(move |clip| clip.cut(entry)).filter(|part| !part.is_empty())
}
