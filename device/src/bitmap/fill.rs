//! Fill: one stored pixel value to a rectangle.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line written.
//! Inputs: [`Fill`] from the firmware. Outputs: pixels.

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
fn fill_rows<P: Copy>(pixels: &mut [P], size: u64, rows: Span, value: P) {
    let rows = rows.joined();
    for row in 0..rows.rows {
        let start = ((rows.base + row * rows.pitch) / size) as usize;
        pixels[start..start + (rows.row_bytes / size) as usize].fill(value);
    }
}
