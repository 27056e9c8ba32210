//! Fill: one stored pixel value to a rectangle.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line written.
//! Inputs: [`Fill`] from the firmware. Outputs: pixels.

use super::combine::Pixel;
use super::{Span, charge};
use crate::probe::account::Account;
use zga_firmware::checked::{Fill, Surface};

/// The rows of a surface.
pub(super) fn rows_of(surface: &Surface) -> Span {
    Span {
        base: u64::from(surface.base),
        pitch: u64::from(surface.pitch),
        row_bytes: u64::from(surface.width) * u64::from(surface.format.bytes()),
        rows: u64::from(surface.height),
    }
}

/// Fills a rectangle.
pub(crate) fn fill(memory: &mut [u32], fill: &Fill, account: &mut Account) {
    let rows = rows_of(&fill.surface);
    if fill.surface.format.bytes() == 4 {
        fill_rows(memory, 4, rows, fill.value);
    } else {
        // The value of a 16-bit format is its low half.
        fill_rows(bytemuck::cast_slice_mut::<u32, u16>(memory), 2, rows, fill.value as u16);
    }
    let pixels = u64::from(fill.surface.width) * u64::from(fill.surface.height);
    charge(account, pixels, rows.lines());
}

/// Fills rows of pixels of `size` bytes.
fn fill_rows<P: Pixel>(pixels: &mut [P], size: u64, rows: Span, value: P) {
    let rows = rows.joined();
    for row in 0..rows.rows {
        let start = ((rows.base + row * rows.pitch) / size) as usize;
        fill_row(&mut pixels[start..start + (rows.row_bytes / size) as usize], value);
    }
}

/// A line of the host's memory.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
struct Line([u32; 16]);

/// Shortest row that is filled by lines, in bytes.
const LONG: usize = 256;

/// Fills a row: a long one line by line, for the host takes longer over writes that lie across two of its lines.
#[inline]
pub(super) fn fill_row<P: Pixel>(row: &mut [P], value: P) {
    if size_of_val(row) < LONG {
        row.fill(value);
        return;
    }
    let (before, lines, after) = bytemuck::pod_align_to_mut::<P, Line>(row);
    before.fill(value);
    lines.fill(Line([value.repeated(); 16]));
    after.fill(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of all lengths about that of a few lines, from every place of a line on.
    fn rows_hold_the_value_and_nothing_beside_them<P: Pixel + std::fmt::Debug>(value: P, other: P) {
        let pixels = 320 / size_of::<P>();
        for first in 0..64 / size_of::<P>() {
            for length in 0..pixels {
                let mut memory = vec![other; 2 * pixels];
                fill_row(&mut memory[first..first + length], value);
                let expected = |place: usize| if (first..first + length).contains(&place) { value } else { other };
                let wrong = (0..memory.len()).find(|&place| memory[place] != expected(place));
                assert_eq!(wrong, None, "{length} from {first}");
            }
        }
    }

    #[test]
    fn fill_row_writes_the_row_alone() {
        rows_hold_the_value_and_nothing_beside_them(0x0123_4567_u32, 0x89AB_CDEF);
        rows_hold_the_value_and_nothing_beside_them(0x0123_u16, 0x89AB);
        rows_hold_the_value_and_nothing_beside_them(0x12_u8, 0x89);
    }
}
