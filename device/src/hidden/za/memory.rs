//! What is done to words and memory without drawing: clears, and bringing cleared blocks to memory.
//!
//! Duties: clears a frame by its words alone; writes the background of cleared blocks to memory where
//! somebody who does not know of words will read it; takes words anew from a Z buffer that somebody
//! else has written; clears rectangles and single planes in mid-scene.
//! Inputs: the frame's layout ([`Frame`]), its background, its memories. Outputs: frame buffer, Z buffer,
//! words, [`MemoryCounts`].
//!
//! Memory is written and read here in lines of 64 bytes, as a clear of the plain Z buffer is: for each
//! row of pixels 1 clock for 16 of them, rounded up, and that for each plane written or read. Words are
//! 1 clock for 16 of a logical clear, else 1 clock each. (Looking which blocks are cleared is part of
//! the word's own clock; blocks that stay as they are cost nothing.)

use super::grid::{self, Grid};
use super::{Background, CLEARED, Surfaces};
use crate::probe::account::{Account, Clocks};
use std::ops::Range;
use zga_abi::Counter;
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::Rectangle;

/// Pixels, depths or words of one clock.
const LINE: u64 = 16;

/// Where the pixels of a frame lie in its memories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Its blocks.
    pub grid: Grid,
    /// Format of the frame buffer.
    pub pixel_format: PixelFormat,
    /// Words from a row of the frame buffer to the next.
    pub colour_pitch: usize,
    /// Number format of depth.
    pub depth_format: DepthFormat,
    /// Words from a row of depths to the next; `None` without a Z buffer.
    pub depth_pitch: Option<usize>,
}

/// Which planes of cleared blocks are brought to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settle {
    /// All there are; the blocks are initialised then.
    All,
    /// The colour only, for somebody who reads the frame buffer; the blocks stay cleared.
    Colour,
}

/// Events of this unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryCounts {
    /// Cleared blocks whose background was written to memory.
    pub settled: u64,
    /// Depths read.
    pub reads: u64,
    /// Depths written.
    pub depth_writes: u64,
    /// Pixels written.
    pub colour_writes: u64,
    /// Za words written.
    pub words_written: u64,
    /// Clocks of the Za unit.
    pub clocks: u64,
}

impl MemoryCounts {
    /// Charges the events.
    pub fn charge(&self, account: &mut Account) {
        account.add(Counter::ZaBlocksSettled, self.settled);
        account.add(Counter::ZReads, self.reads);
        account.add(Counter::ZWrites, self.depth_writes);
        account.add(Counter::ColourWrites, self.colour_writes);
        account.add(Counter::ZaWordsWritten, self.words_written);
        account.charge(Counter::CyclesZa, Clocks(self.clocks));
    }

    /// A plane of `area` was written or read; returns how many pixels that are.
    fn lines(&mut self, area: &Rectangle) -> u64 {
        let pixels = grid::pixels(area);
        if pixels > 0 {
            self.clocks += u64::from(area.right - area.x).div_ceil(LINE) * u64::from(area.bottom - area.y);
        }
        pixels
    }

    /// One word was written.
    fn word(&mut self) {
        self.words_written += 1;
        self.clocks += 1;
    }
}

/// Clears a frame: all its blocks are logically cleared, no pixel and no depth is touched.
#[must_use]
pub fn clear_logically(words: &mut [i32]) -> MemoryCounts {
    words.fill(CLEARED);
    let count = words.len() as u64;
    MemoryCounts { words_written: count, clocks: count.div_ceil(LINE), ..MemoryCounts::default() }
}

/// How many blocks are logically cleared.
#[must_use]
pub fn background_blocks(words: &[i32]) -> u64 {
    words.iter().map(|&word| u64::from(word < 0)).sum()
}

/// The greatest depth of an area, at least 0: a running maximum starts there.
#[must_use]
pub fn maximum(depth: &[i32], pitch: usize, area: &Rectangle) -> i32 {
    let mut greatest = 0;
    for y in area.y as usize..area.bottom as usize {
        for &z in &depth[y * pitch + area.x as usize..y * pitch + area.right as usize] {
            greatest = greatest.max(z);
        }
    }
    greatest
}

/// Writes one pixel, given as it is stored; of two pixels in a word the left one is the low half.
#[inline(always)]
pub fn put(colour: &mut [u32], format: PixelFormat, pitch: usize, x: usize, y: usize, pixel: u32) {
    match format {
        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => colour[y * pitch + x] = pixel,
        PixelFormat::Rgb565 => {
            let (word, shift) = (&mut colour[y * pitch + x / 2], 16 * (x as u32 % 2));
            *word = (*word & !(0xFFFF << shift)) | ((pixel & 0xFFFF) << shift);
        }
    }
}

impl Frame {
    /// Brings cleared blocks to memory: those that hold a pixel of `area`, or all.
    pub fn settle(
        &self,
        background: &Background,
        area: Option<&Rectangle>,
        planes: Settle,
        surfaces: &mut Surfaces<'_>,
    ) -> MemoryCounts {
        let mut counts = MemoryCounts::default();
        let [columns, rows] = self.grid.meeting(area.unwrap_or(&self.grid.all()));
        for row in rows {
            let first = row * self.grid.across();
            for column in columns.clone() {
                if surfaces.words[first + column] < 0 {
                    self.settle_block(background, column, row, planes, surfaces, &mut counts);
                }
            }
        }
        counts
    }

    /// Brings one cleared block to memory.
    fn settle_block(
        &self,
        background: &Background,
        column: usize,
        row: usize,
        planes: Settle,
        surfaces: &mut Surfaces<'_>,
        counts: &mut MemoryCounts,
    ) {
        let area = self.grid.area_at(column, row);
        counts.settled += 1;
        self.fill_colour(surfaces.colour, &area, background.pixel, counts);
        if planes == Settle::All {
            self.fill_depth(surfaces.depth, &area, background.depth, counts);
            surfaces.words[row * self.grid.across() + column] = self.word_of(background.depth);
            counts.word();
        }
    }

    /// Takes the words of blocks `range` anew from the Z buffer: of all of them, which are initialised then,
    /// or of those that are initialised already.
    pub fn derive(&self, range: Range<usize>, only_initialised: bool, surfaces: &mut Surfaces<'_>) -> MemoryCounts {
        let mut counts = MemoryCounts::default();
        for index in range {
            if !only_initialised || surfaces.words[index] >= 0 {
                self.derive_block(index, surfaces, &mut counts);
            }
        }
        counts
    }

    fn derive_block(&self, index: usize, surfaces: &mut Surfaces<'_>, counts: &mut MemoryCounts) {
        let word = match self.depth_pitch {
            Some(pitch) => {
                let area = self.grid.area(index);
                counts.reads += counts.lines(&area);
                maximum(surfaces.depth, pitch, &area)
            }
            None => self.depth_format.maximum() as i32,
        };
        surfaces.words[index] = word;
        counts.word();
    }

    /// Clears a part of the picture, or one of its planes: `pixel` as it is stored, `depth` where there is a
    /// Z buffer. `background` is `None` before the first logical clear; no block is cleared then.
    ///
    /// A block ends up logically cleared where the clear leaves nothing in it but the background: it was
    /// cleared and the values are the background's, or all of it is cleared to them. Every other block
    /// is brought to memory first if it was cleared and something of the background stays in it; then its
    /// pixels are written, then its word is exact.
    pub fn clear_rectangle(
        &self,
        area: &Rectangle,
        pixel: Option<u32>,
        depth: Option<i32>,
        background: Option<&Background>,
        surfaces: &mut Surfaces<'_>,
    ) -> MemoryCounts {
        let mut counts = MemoryCounts::default();
        let depth = depth.filter(|_| self.depth_pitch.is_some());
        if pixel.is_none() && depth.is_none() {
            return counts;
        }
        let all_planes = pixel.is_some() && (depth.is_some() || self.depth_pitch.is_none());
        let [columns, rows] = self.grid.meeting(area);
        for row in rows {
            for column in columns.clone() {
                let block = self.grid.area_at(column, row);
                let part = grid::common(&block, area);
                let index = row * self.grid.across() + column;
                let cleared = surfaces.words[index] < 0;
                if let Some(background) = background {
                    let same = pixel.is_none_or(|pixel| pixel == background.pixel)
                        && depth.is_none_or(|depth| depth == background.depth);
                    if same && cleared {
                        continue;
                    }
                    if same && all_planes && part == block {
                        surfaces.words[index] = CLEARED;
                        counts.word();
                        continue;
                    }
                    if cleared && !(all_planes && part == block) {
                        self.settle_block(background, column, row, Settle::All, surfaces, &mut counts);
                    }
                }
                if let Some(pixel) = pixel {
                    self.fill_colour(surfaces.colour, &part, pixel, &mut counts);
                }
                if let Some(depth) = depth {
                    self.fill_depth(surfaces.depth, &part, depth, &mut counts);
                }
                match depth {
                    Some(_) if part != block => self.derive_block(index, surfaces, &mut counts),
                    None if surfaces.words[index] >= 0 => {}
                    // Without a Z buffer the block is just no longer cleared.
                    _ => {
                        surfaces.words[index] = self.word_of(depth.unwrap_or(0));
                        counts.word();
                    }
                }
            }
        }
        counts
    }

    /// The word of a block that holds depth `depth` only.
    fn word_of(&self, depth: i32) -> i32 {
        if self.depth_pitch.is_some() { depth.max(0) } else { self.depth_format.maximum() as i32 }
    }

    fn fill_colour(&self, colour: &mut [u32], area: &Rectangle, pixel: u32, counts: &mut MemoryCounts) {
        let columns = area.x as usize..area.right as usize;
        for y in area.y as usize..area.bottom as usize {
            let row = &mut colour[y * self.colour_pitch..][..self.colour_pitch];
            match self.pixel_format {
                PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[columns.clone()].fill(pixel),
                PixelFormat::Rgb565 => bytemuck::cast_slice_mut::<u32, u16>(row)[columns.clone()].fill(pixel as u16),
            }
        }
        counts.colour_writes += counts.lines(area);
    }

    /// Nothing where there is no Z buffer.
    fn fill_depth(&self, depth: &mut [i32], area: &Rectangle, z: i32, counts: &mut MemoryCounts) {
        let Some(pitch) = self.depth_pitch else {
            return;
        };
        for y in area.y as usize..area.bottom as usize {
            depth[y * pitch..][area.x as usize..area.right as usize].fill(z);
        }
        counts.depth_writes += counts.lines(area);
    }
}
