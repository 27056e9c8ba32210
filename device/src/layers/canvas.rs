//! The pixels of a host tile while layers are composed over them.
//!
//! Duties: colours decoded from the frame buffer once, and encoded to it once, so that every layer is blended on levels
//! of 8 bits whatever the format; which pixels a layer was blended into, and in what order their layers came. Inputs
//! from: the frame buffer, [`super::tile`], [`super::pixels`]. Outputs to: the frame buffer, counts. Clocks: none.

use super::Counts;
use super::blend::over;
use crate::hidden::z_buffer::kernel::{LANE, LANES};
use crate::hidden::z_buffer::tile::TILE;
use crate::shading::resolve::{PixelRow, Row16, Row32};
use fearless_simd::prelude::*;
use fearless_simd::{mask32x16, u32x16};
use zga_abi::format::{BlendMode, PixelFormat};

/// A bit for each lane.
const BIT: [u32; LANES] = {
    let (mut bits, mut lane) = ([0; LANES], 0);
    while lane < LANES {
        bits[lane] = 1 << LANE[lane];
        lane += 1;
    }
    bits
};

/// Pixels of a tile.
#[derive(Debug)]
pub struct Canvas {
    /// RGBA, R in 7:0; rows of [`TILE`].
    pub colours: Box<[u32; TILE * TILE]>,
    /// Pixels that a layer was blended into: a bit each, lowest leftmost.
    pub blended: [u64; TILE],
    /// Pixels into which an earlier layer was blended after a later one.
    pub tangled: [u64; TILE],
    /// Layers blended into each pixel, where their order is looked at.
    depth: Box<[u32; TILE * TILE]>,
    /// The latest of them by order of submission.
    latest: Box<[u32; TILE * TILE]>,
}

impl Default for Canvas {
    fn default() -> Self {
        let empty = || Box::new([0; TILE * TILE]);
        let (colours, depth, latest) = (empty(), empty(), empty());
        Canvas { colours, blended: [0; TILE], tangled: [0; TILE], depth, latest }
    }
}

/// The rows of a frame buffer that a tile is a part of.
pub struct Frame<'a> {
    /// Words, from the tile's first row on.
    pub words: &'a mut [u32],
    /// Words from a row to the next.
    pub pitch: usize,
    /// Format of a pixel.
    pub format: PixelFormat,
    /// First column of the tile.
    pub x: usize,
}

impl Frame<'_> {
    fn row(&mut self, row: usize) -> &mut [u32] {
        &mut self.words[row * self.pitch..][..self.pitch]
    }
}

/// The lanes that `bits` has a bit for.
#[inline(always)]
pub fn lanes_of<S: Simd>(simd: S, bits: u32) -> mask32x16<S> {
    (u32x16::from_slice(simd, &BIT) & bits).simd_gt(0)
}

impl Canvas {
    /// Takes rows `rows` of the tile from the frame buffer; `ordered` if no pixel's layers can come out of order.
    #[inline(always)]
    pub fn load<S: Simd>(&mut self, simd: S, frame: &mut Frame<'_>, rows: [usize; 2], ordered: bool) {
        for row in rows[0]..rows[1] {
            (self.blended[row], self.tangled[row]) = (0, 0);
            let colours = &mut self.colours[row * TILE..][..TILE];
            let (x, format) = (frame.x, frame.format);
            let words = frame.row(row);
            match format {
                PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
                    let opaque = if format == PixelFormat::Xrgb8888 { 0xFF00_0000 } else { 0 };
                    // A pitch is whole chunks.
                    let words = words[x..].as_chunks::<LANES>().0;
                    for (words, colours) in words.iter().zip(colours.as_chunks_mut::<LANES>().0) {
                        let words = u32x16::from_slice(simd, words);
                        let blue = (words & 0xFF) << 16_u32;
                        let red = (words >> 16_u32) & 0xFF;
                        ((words & 0xFF00_FF00) | red | blue | opaque).store_slice(colours);
                    }
                }
                PixelFormat::Rgb565 => {
                    let pixels: &[u16] = bytemuck::cast_slice(words);
                    for (pixel, colour) in pixels[x..].iter().zip(colours) {
                        *colour = u32::from_le_bytes(format.decode(u32::from(*pixel)));
                    }
                }
            }
            if !ordered {
                self.depth[row * TILE..][..TILE].fill(0);
                self.latest[row * TILE..][..TILE].fill(0);
            }
        }
    }

    /// Gives rows back: the pixels that a layer was blended into.
    #[inline(always)]
    pub fn store<S: Simd>(&self, simd: S, frame: &mut Frame<'_>, rows: [usize; 2]) {
        for row in rows[0]..rows[1] {
            if self.blended[row] == 0 {
                continue;
            }
            let (x, format) = (frame.x, frame.format);
            let words = frame.row(row);
            match format {
                PixelFormat::Xrgb8888 => self.put(simd, &mut Row32 { words, opaque: 0xFF00_0000 }, x, row),
                PixelFormat::Argb8888 => self.put(simd, &mut Row32 { words, opaque: 0 }, x, row),
                PixelFormat::Rgb565 => {
                    self.put(simd, &mut Row16 { pixels: bytemuck::cast_slice_mut(words) }, x, row);
                }
            }
        }
    }

    #[inline(always)]
    fn put<S: Simd>(&self, simd: S, pixels: &mut impl PixelRow, x: usize, row: usize) {
        for (chunk, colours) in self.colours[row * TILE..][..TILE].as_chunks::<LANES>().0.iter().enumerate() {
            let bits = (self.blended[row] >> (LANES * chunk)) as u32 & 0xFFFF;
            if bits != 0 {
                pixels.put_chunk(simd, x + LANES * chunk, u32x16::from_slice(simd, colours), lanes_of(simd, bits));
            }
        }
    }

    /// Notes that layer `number`, counted from 1, was blended into the pixels of a chunk that `bits` has a bit for; the
    /// chunk begins with column `first` of row `row`.
    #[inline(always)]
    pub fn note<S: Simd>(&mut self, simd: S, row: usize, first: usize, bits: u32, number: u32) {
        let at = row * TILE + first;
        let mine = lanes_of(simd, bits);
        let depth = &mut self.depth[at..at + LANES];
        let before = u32x16::from_slice(simd, depth);
        mine.select(before + 1, before).store_slice(depth);
        let latest = &mut self.latest[at..at + LANES];
        let before = u32x16::from_slice(simd, latest);
        let number = u32x16::splat(simd, number);
        self.tangled[row] |= ((mine & before.simd_gt(number)).to_bitmask() & 0xFFFF) << first;
        mine.select(before.max(number), before).store_slice(latest);
    }

    /// Blends a colour over the pixel at a row and column.
    #[inline(always)]
    pub fn blend(&mut self, [row, column]: [usize; 2], mode: BlendMode, colour: u32) {
        let pixel = &mut self.colours[row * TILE + column];
        *pixel = over(mode, *pixel, colour);
        self.blended[row] |= 1 << column;
    }

    /// Adds up what the pixels of rows and of the columns in `mask` say: how many there are, and the comparisons of their sorts beyond one for each
    /// layer after the first. `blended` layers are counted by who blends them.
    pub fn count(&self, rows: [usize; 2], mask: u64, ordered: bool, counts: &mut Counts) {
        for row in rows[0]..rows[1] {
            counts.pixels += u64::from((self.blended[row] & mask).count_ones());
            let mut tangled = if ordered { 0 } else { self.tangled[row] & mask };
            counts.sorted_pixels += u64::from(tangled.count_ones());
            while tangled != 0 {
                let layers = u64::from(self.depth[row * TILE + tangled.trailing_zeros() as usize]);
                // Each with each, and not with the one before it only.
                counts.comparisons += layers * (layers - 1) / 2 - (layers - 1);
                tangled &= tangled - 1;
            }
        }
    }
}
