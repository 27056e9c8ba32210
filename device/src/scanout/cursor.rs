//! Cursor: a picture over the frame shown, as it leaves the card.
//!
//! Duties: blends the cursor's pixels over those of a composed frame; no frame buffer changes.
//! Inputs: CURSOR registers, the picture in video memory. Outputs: pixels of the frame.
//! Clocks (`cycles.scanout`): 4 for each row of the picture on the frame, the lines of 64 bytes that a row of it lies in;
//! they are fetched before the row goes out. Blending keeps up with the display.
//!
//! The picture has 64 x 64 ARGB8888 pixels, colours multiplied by their alpha: a channel becomes
//! c + round(d * (255 - a) / 255), at most 255.

use crate::bus::backplane::Backplane;
use crate::memory::VideoMemory;
use std::ops::Range;
use zga_abi::Reg;
use zga_abi::format::CURSOR_SIDE;
use zga_firmware::checked::Surface;

/// Words of the picture.
const WORDS: usize = (CURSOR_SIDE * CURSOR_SIDE) as usize;

/// A cursor that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cursor {
    /// First word of the picture.
    first: usize,
    /// Place of the picture's first pixel on the frame.
    position: [i32; 2],
}

impl Cursor {
    /// The cursor that the registers describe; `None` if it is off or its picture does not lie in memory.
    ///
    /// A host can write the registers with any values at any time, so they are checked here each time.
    pub(crate) fn shown(backplane: &Backplane, memory: &VideoMemory) -> Option<Cursor> {
        let get = |reg| backplane.registers.get(reg);
        if get(Reg::CursorControl) & 1 == 0 {
            return None;
        }
        let first = (get(Reg::CursorBase) / 4) as usize;
        let place = get(Reg::CursorPosition);
        let position = [place as i16, (place >> 16) as i16].map(i32::from);
        (first + WORDS <= memory.words().len()).then_some(Cursor { first, position })
    }

    /// Words that the picture lies in.
    pub(crate) fn words(&self) -> Range<usize> {
        self.first..self.first + WORDS
    }

    /// Columns and rows of the picture that lie on a frame of this size.
    fn visible(&self, surface: &Surface) -> [Range<usize>; 2] {
        let side = CURSOR_SIDE as i32;
        let clip = |position: i32, size: u32| {
            let first = (-position).clamp(0, side);
            first as usize..(size as i32 - position).clamp(first, side) as usize
        };
        [clip(self.position[0], surface.width), clip(self.position[1], surface.height)]
    }

    /// Pixels on the frame, and clocks to fetch them.
    pub(crate) fn cost(&self, surface: &Surface) -> [u64; 2] {
        let [columns, rows] = self.visible(surface).map(|range| range.len() as u64);
        [columns * rows, if columns == 0 { 0 } else { 4 * rows }]
    }

    /// Blends the picture over a composed frame.
    pub(crate) fn overlay(&self, memory: &VideoMemory, surface: &Surface, frame: &mut [u32]) {
        let [columns, rows] = self.visible(surface);
        if columns.is_empty() {
            return;
        }
        let picture = &memory.words()[self.words()];
        let x = (self.position[0] + columns.start as i32) as usize;
        for row in rows {
            let y = (self.position[1] + row as i32) as usize;
            let out = &mut frame[y * surface.width as usize + x..][..columns.len()];
            let pixels = &picture[row * CURSOR_SIDE as usize..][columns.clone()];
            out.iter_mut().zip(pixels).for_each(|(out, &pixel)| *out = over(pixel, *out));
        }
    }
}

/// A pixel of the cursor over one of the frame; 31:24 becomes 255.
fn over(cursor: u32, below: u32) -> u32 {
    let rest = 255 - (cursor >> 24);
    let channel = |shift: u32| {
        let product = (below >> shift & 255) * rest + 128;
        ((cursor >> shift & 255) + ((product + (product >> 8)) >> 8)).min(255) << shift
    };
    0xFF00_0000 | channel(16) | channel(8) | channel(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn over_is_the_rounded_quotient() {
        for alpha in 0..=255 {
            for below in 0..=255_u32 {
                let expected = (f64::from(below * (255 - alpha)) / 255.0).round() as u32;
                assert_eq!(over(alpha << 24, below), 0xFF00_0000 | expected, "alpha {alpha} over {below}");
            }
        }
    }

    #[test]
    fn over_of_colours_brighter_than_their_alpha_stays_in_a_byte() {
        assert_eq!(over(0x01FF_80FF, 0xFFFF_FFFF), 0xFFFF_FFFF);
    }
}
