//! Colour buffer: two banks of w x h pixels, so that one tile is written out while the next is drawn.
//!
//! Duties: takes the finished pixels of a tile; writes the other bank to the frame buffer, and depths to
//! the Z buffer if there is one. Inputs: colours of the interpolator, depths of the comparators. Outputs:
//! pixels in video memory.
//!
//! A tile whose depths are stored has a depth beside each colour: the comparators cannot keep them, they
//! go on with the next tile.
//!
//! Clocks: 1 a pixel written, hidden behind the next tile's drawing ([`super::clocks`]).

use bytemuck::cast_slice_mut;
use zga_abi::format::PixelFormat;
use zga_firmware::checked::{Rectangle, Surface};

/// A pixel of a bank.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BankPixel {
    /// RGBA, R in 7:0; `None` is not written.
    pub colour: Option<u32>,
    /// Depth.
    pub depth: i32,
}

/// One bank.
#[derive(Debug)]
struct Bank {
    /// Where its tile stands on the screen; empty: it holds none.
    area: Rectangle,
    /// Rows of as many pixels as the area has.
    pixels: Vec<BankPixel>,
}

/// Frame buffer and Z buffer in video memory.
#[derive(Debug)]
pub struct Memory<'m> {
    /// Frame buffer words.
    pub colour: &'m mut [u32],
    /// Where the frame buffer's pixels are.
    pub surface: Surface,
    /// Depths, rows of `depth_pitch` words; nothing is stored if the pitch is 0.
    pub depth: &'m mut [i32],
    /// Words from a row of depths to the next.
    pub depth_pitch: usize,
}

/// Both banks.
#[derive(Debug)]
pub struct ColourBuffer {
    banks: [Bank; 2],
    /// The bank that is drawn to.
    drawn: usize,
}

impl Default for ColourBuffer {
    fn default() -> Self {
        let bank = || Bank { area: Rectangle { x: 0, y: 0, right: 0, bottom: 0 }, pixels: Vec::new() };
        ColourBuffer { banks: [bank(), bank()], drawn: 0 }
    }
}

impl ColourBuffer {
    /// Takes a tile's pixels, row by row, into the bank that is drawn to.
    pub fn draw(&mut self, area: Rectangle, pixels: impl Iterator<Item = BankPixel>) {
        let bank = &mut self.banks[self.drawn];
        bank.area = area;
        bank.pixels.clear();
        bank.pixels.extend(pixels);
    }

    /// Writes out the bank that is not drawn to: the tile before.
    pub fn write_out(&mut self, memory: &mut Memory<'_>) {
        let bank = &mut self.banks[1 - self.drawn];
        let Rectangle { x, y, right, .. } = bank.area;
        let width = (right - x) as usize;
        for (row, pixels) in (y as usize..).zip(bank.pixels.chunks(width.max(1))) {
            memory.put_row(x as usize, row, pixels);
        }
        bank.pixels.clear();
    }

    /// The banks change places.
    pub fn swap(&mut self) {
        self.drawn = 1 - self.drawn;
    }
}

impl Memory<'_> {
    /// The depth stored for a pixel.
    #[must_use]
    pub fn depth_at(&self, x: u32, y: u32) -> i32 {
        self.depth[y as usize * self.depth_pitch + x as usize]
    }

    /// Writes a row of pixels from column `x` on.
    fn put_row(&mut self, x: usize, y: usize, pixels: &[BankPixel]) {
        let format = self.surface.format;
        let pitch = self.surface.pitch as usize / 4;
        let row = &mut self.colour[y * pitch..][..pitch];
        for (x, pixel) in (x..).zip(pixels) {
            if let Some(colour) = pixel.colour {
                let stored = format.encode(colour.to_le_bytes());
                match format {
                    PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => row[x] = stored,
                    PixelFormat::Rgb565 => cast_slice_mut::<u32, u16>(row)[x] = stored as u16,
                }
            }
        }
        if self.depth_pitch != 0 {
            let row = &mut self.depth[y * self.depth_pitch + x..][..pixels.len()];
            for (depth, pixel) in row.iter_mut().zip(pixels) {
                *depth = pixel.depth;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_out_takes_the_tile_before_the_one_drawn() {
        let surface = Surface { base: 0, pitch: 64, width: 2, height: 1, format: PixelFormat::Argb8888 };
        let mut colour = [0; 16];
        let mut buffer = ColourBuffer::default();
        let pixel = |red| [BankPixel { colour: Some(red), depth: 0 }].into_iter();
        let at = |x| Rectangle { x, y: 0, right: x + 1, bottom: 1 };
        let mut shown = vec![];
        for (x, red) in [(0, 1), (1, 2)] {
            buffer.draw(at(x), pixel(red));
            buffer.write_out(&mut Memory { colour: &mut colour, surface, depth: &mut [], depth_pitch: 0 });
            buffer.swap();
            shown.push([colour[0], colour[1]]);
        }
        buffer.write_out(&mut Memory { colour: &mut colour, surface, depth: &mut [], depth_pitch: 0 });
        shown.push([colour[0], colour[1]]);
        assert_eq!(shown, [[0, 0], [0x1_0000, 0], [0x1_0000, 0x2_0000]]);
    }
}
