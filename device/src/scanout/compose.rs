//! Composition: stored pixels of any format to the XRGB8888 words that leave the card.
//!
//! Duties: unpacks rows, drops their padding, sets the top byte of each word to 255.
//! Inputs: a checked surface in video memory. Outputs: dense rows.
//! Clocks: 1 a pixel, charged by [`super`].
//!
//! Alpha is not shown: ARGB8888 comes out as its colour. [`PixelFormat::decode`] is the
//! specification; the row loops must equal it for every pixel value.

use zga_abi::format::PixelFormat;
use zga_firmware::checked::Surface;

/// Composes `surface` into `frame`, which becomes `width * height` words.
pub(crate) fn compose(memory: &[u32], surface: &Surface, frame: &mut Vec<u32>) {
    let width = surface.width as usize;
    frame.resize(width * surface.height as usize, 0);
    let stored = &memory[(surface.base / 4) as usize..];
    let rows = stored.chunks(surface.pitch as usize / 4).zip(frame.chunks_exact_mut(width));
    match surface.format {
        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => {
            for (row, out) in rows {
                out.iter_mut().zip(row).for_each(|(out, &pixel)| *out = pixel | 0xFF00_0000);
            }
        }
        PixelFormat::Rgb565 => {
            for (row, out) in rows {
                let row: &[u16] = bytemuck::cast_slice(row);
                out.iter_mut().zip(row).for_each(|(out, &pixel)| *out = widen(u32::from(pixel)));
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
        compose(&memory, &surface, &mut frame);
        let expected = [16, 17, 18, 32, 33, 34].map(|word: usize| decoded(PixelFormat::Argb8888, memory[word]));
        assert_eq!(frame, expected);
    }

    #[test]
    fn compose_odd_width_565_takes_halves_in_order() {
        let mut memory = vec![0; 16];
        memory[0] = 0x07E0_F800;
        memory[1] = 0xFFFF_001F;
        let surface = Surface { base: 0, pitch: 64, width: 3, height: 1, format: PixelFormat::Rgb565 };
        let mut frame = Vec::new();
        compose(&memory, &surface, &mut frame);
        assert_eq!(frame, [0xFFFF_0000, 0xFF00_FF00, 0xFF00_00FF]);
    }
}
