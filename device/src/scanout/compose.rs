//! Composition: stored pixels of any format to the XRGB8888 words that leave the card.
//!
//! Duties: unpacks rows, drops their padding, sets the top byte of each word to 255; puts the background
//! out for logically cleared blocks, whose memory is not read.
//! Inputs: a checked surface in video memory, the Za words of its blocks. Outputs: dense rows.
//! Clocks: 1 a pixel, charged by [`super`].
//!
//! Alpha is not shown: ARGB8888 comes out as its colour. [`PixelFormat::decode`] is the
//! specification; the row loops must equal it for every pixel value.

use crate::hidden::za::memory::background_blocks;
use crate::memory::VideoMemory;
use std::ops::Range;
use zga_abi::format::PixelFormat;
use zga_firmware::checked::Surface;

/// The blocks of a frame that are logically cleared.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cleared<'m> {
    /// Width and height of a block, pixels.
    block: [usize; 2],
    /// Blocks in a row.
    across: usize,
    /// Words of the blocks; empty for a frame that has none.
    words: &'m [i32],
    /// What such a block shows.
    background: u32,
}

impl<'m> Cleared<'m> {
    /// Those of a frame in memory.
    pub(crate) fn of(memory: &'m VideoMemory, surface: &Surface) -> Cleared<'m> {
        let area = memory.areas().shown(surface);
        let words = area.and_then(|area| memory.za().words().get(area.words()));
        let (Some(area), Some(words)) = (area, words) else { return Cleared::default() };
        Cleared {
            block: area.block.map(|side| side as usize),
            across: area.grid().across(),
            words,
            background: shown(surface.format, area.background.pixel),
        }
    }

    /// How many there are.
    pub(crate) fn blocks(&self) -> u64 {
        background_blocks(self.words)
    }

    /// Has `copy` make the pixels of row `y` that are not cleared, a run of columns at a time, and puts the
    /// background out for the others.
    fn row(&self, y: usize, out: &mut [u32], mut copy: impl FnMut(Range<usize>, &mut [u32])) {
        let words = y.checked_div(self.block[1]).map_or(self.words, |row| &self.words[row * self.across..]);
        let words = &words[..self.across.min(words.len())];
        if !words.iter().any(|&word| word < 0) {
            copy(0..out.len(), out);
            return;
        }
        let mut x = 0;
        for run in words.chunk_by(|a, b| (*a < 0) == (*b < 0)) {
            let end = (x + run.len() * self.block[0]).min(out.len());
            match run {
                [word, ..] if *word < 0 => out[x..end].fill(self.background),
                _ => copy(x..end, &mut out[x..end]),
            }
            x = end;
        }
    }
}

/// The XRGB8888 word of a stored pixel.
fn shown(format: PixelFormat, pixel: u32) -> u32 {
    match format {
        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => pixel | 0xFF00_0000,
        PixelFormat::Rgb565 => widen(pixel & 0xFFFF),
    }
}

/// Composes `surface` into `frame`, which becomes `width * height` words.
pub(crate) fn compose(memory: &[u32], surface: &Surface, cleared: &Cleared<'_>, frame: &mut Vec<u32>) {
    let width = surface.width as usize;
    frame.resize(width * surface.height as usize, 0);
    let stored = &memory[(surface.base / 4) as usize..];
    let rows = stored.chunks(surface.pitch as usize / 4).zip(frame.chunks_exact_mut(width)).enumerate();
    match surface.format {
        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
            for (y, (row, out)) in rows {
                cleared.row(y, out, |columns, out| {
                    out.iter_mut().zip(&row[columns]).for_each(|(out, &pixel)| *out = pixel | 0xFF00_0000);
                });
            }
        }
        PixelFormat::Rgb565 => {
            for (y, (row, out)) in rows {
                let row: &[u16] = bytemuck::cast_slice(row);
                cleared.row(y, out, |columns, out| {
                    out.iter_mut().zip(&row[columns]).for_each(|(out, &pixel)| *out = widen(u32::from(pixel)));
                });
            }
        }
    }
}

/// XRGB8888 of an RGB565 pixel: the top bits of each channel are repeated below it.
#[inline]
fn widen(pixel: u32) -> u32 {
    let red_blue = ((pixel & 0xF800) << 8) | ((pixel & 0x1F) << 3);
    let green = (pixel & 0x07E0) << 5;
    0xFF00_0000 | red_blue | ((red_blue >> 5) & 0x0007_0007) | green | ((green >> 6) & 0x0300)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(format: PixelFormat, pixel: u32) -> u32 {
        let [red, green, blue, _] = format.decode(pixel);
        u32::from_be_bytes([255, red, green, blue])
    }

    #[test]
    fn widen_every_pixel_equals_decode() {
        let wrong = (0..=0xFFFF).find(|&pixel| widen(pixel) != decoded(PixelFormat::Rgb565, pixel));
        assert_eq!(wrong, None);
    }

    #[test]
    fn compose_padded_rows_are_dense() {
        let memory: Vec<u32> = (0..48).map(|word| word * 0x0102_0304).collect();
        let surface = Surface { base: 64, pitch: 64, width: 3, height: 2, format: PixelFormat::Argb8888 };
        let mut frame = vec![1; 99];
        compose(&memory, &surface, &Cleared::default(), &mut frame);
        let expected = [16, 17, 18, 32, 33, 34].map(|word: usize| decoded(PixelFormat::Argb8888, memory[word]));
        assert_eq!(frame, expected);
    }

    #[test]
    fn compose_cleared_blocks_show_the_background() {
        let memory: Vec<u32> = (0..48).collect();
        let surface = Surface { base: 0, pitch: 64, width: 7, height: 3, format: PixelFormat::Xrgb8888 };
        let words = [5, -1, 0, i32::MIN, -7, 9];
        let cleared = Cleared { block: [3, 2], across: 3, words: &words, background: 0xFF00_00FF };
        let mut frame = Vec::new();
        compose(&memory, &surface, &cleared, &mut frame);
        let b = 0xFF;
        let expected = [0, 1, 2, b, b, b, 6, 16, 17, 18, b, b, b, 22, b, b, b, b, b, b, 38];
        assert_eq!(frame, expected.map(|pixel| pixel | 0xFF00_0000));
        assert_eq!(cleared.blocks(), 3);
    }

    #[test]
    fn compose_odd_width_565_takes_halves_in_order() {
        let mut memory = vec![0; 16];
        memory[0] = 0x07E0_F800;
        memory[1] = 0xFFFF_001F;
        let surface = Surface { base: 0, pitch: 64, width: 3, height: 1, format: PixelFormat::Rgb565 };
        let mut frame = Vec::new();
        compose(&memory, &surface, &Cleared::default(), &mut frame);
        assert_eq!(frame, [0xFFFF_0000, 0xFF00_FF00, 0xFF00_00FF]);
    }
}
