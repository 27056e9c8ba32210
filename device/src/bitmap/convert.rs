//! Convert: a rectangle into another format, as if all of it were read before any is written.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line read and 1 for each line written: the bits of a line change
//! places on their way.
//! Inputs: [`Convert`] from the firmware. Outputs: pixels. Specification: [`super::specification`].
//!
//! Between the two formats a row stands as ARGB8888 words, which hold the RGBA value of any pixel.

use super::copy::stage;
use super::{Bitmap, Span, charge, specification};
use crate::probe::account::Account;
use zga_abi::format::BitmapFormat;
use zga_firmware::checked::Convert;

/// Alpha 255 of an ARGB8888 word.
const OPAQUE: u32 = 0xFF00_0000;

impl Bitmap {
    /// Copies a rectangle into another format.
    pub(crate) fn convert(&mut self, memory: &mut [u32], convert: &Convert, account: &mut Account) {
        let Convert { source, destination } = convert;
        let (from, to) = (Span::of(source), Span::of(destination));
        if self.specification {
            specification::convert(memory, convert);
        } else {
            self.line.resize(source.width as usize, 0);
            let line = &mut self.line[..];
            if from.apart(&to) {
                for row in 0..to.rows {
                    read_line(memory, from.base + row * from.pitch, source.format, line);
                    write_line(memory, to.base + row * to.pitch, destination.format, line);
                }
            } else {
                // Pixels of two sizes overtake each other in any order.
                let bytes: &[u8] = bytemuck::cast_slice(memory);
                let from = stage(bytes, from, &mut self.scratch);
                for row in 0..to.rows {
                    read_line(&self.scratch, from.base + row * from.pitch, source.format, line);
                    write_line(memory, to.base + row * to.pitch, destination.format, line);
                }
            }
        }
        let pixels = u64::from(source.width) * u64::from(source.height);
        charge(account, pixels, from.lines() + to.lines());
    }
}

/// Reads pixels of a format from byte `address` on as ARGB8888.
pub(super) fn read_line(memory: &[u32], address: u64, format: BitmapFormat, line: &mut [u32]) {
    let first = (address / u64::from(format.bytes())) as usize;
    match format {
        BitmapFormat::Xrgb8888 => {
            let pixels = &memory[first..][..line.len()];
            line.iter_mut().zip(pixels).for_each(|(argb, pixel)| *argb = pixel | OPAQUE);
        }
        BitmapFormat::Argb8888 => line.copy_from_slice(&memory[first..][..line.len()]),
        BitmapFormat::Rgb565 => {
            let pixels = &bytemuck::cast_slice::<u32, u16>(memory)[first..][..line.len()];
            line.iter_mut().zip(pixels).for_each(|(argb, &pixel)| *argb = widen(u32::from(pixel)));
        }
        BitmapFormat::Alpha8 => {
            let pixels = &bytemuck::cast_slice::<u32, u8>(memory)[first..][..line.len()];
            line.iter_mut().zip(pixels).for_each(|(argb, &pixel)| *argb = u32::from(pixel) << 24);
        }
    }
}

/// Writes ARGB8888 words as pixels of a format from byte `address` on.
pub(super) fn write_line(memory: &mut [u32], address: u64, format: BitmapFormat, line: &[u32]) {
    let first = (address / u64::from(format.bytes())) as usize;
    match format {
        BitmapFormat::Xrgb8888 => {
            let pixels = &mut memory[first..][..line.len()];
            pixels.iter_mut().zip(line).for_each(|(pixel, argb)| *pixel = argb | OPAQUE);
        }
        BitmapFormat::Argb8888 => memory[first..][..line.len()].copy_from_slice(line),
        BitmapFormat::Rgb565 => {
            let pixels = &mut bytemuck::cast_slice_mut::<u32, u16>(memory)[first..][..line.len()];
            pixels.iter_mut().zip(line).for_each(|(pixel, &argb)| *pixel = narrow(argb));
        }
        BitmapFormat::Alpha8 => {
            let pixels = &mut bytemuck::cast_slice_mut::<u32, u8>(memory)[first..][..line.len()];
            pixels.iter_mut().zip(line).for_each(|(pixel, argb)| *pixel = (argb >> 24) as u8);
        }
    }
}

/// RGB565 as ARGB8888, widened by repeating top bits.
const fn widen(pixel: u32) -> u32 {
    let (red, green, blue) = (pixel >> 11, (pixel >> 5) & 63, pixel & 31);
    let (red, green, blue) = ((red << 3) | (red >> 2), (green << 2) | (green >> 4), (blue << 3) | (blue >> 2));
    OPAQUE | (red << 16) | (green << 8) | blue
}

/// ARGB8888 as RGB565: the top bits of each channel.
const fn narrow(argb: u32) -> u16 {
    (((argb >> 8) & 0xF800) | ((argb >> 5) & 0x07E0) | ((argb >> 3) & 0x001F)) as u16
}
