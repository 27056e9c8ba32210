//! A composition as one would write it down: every pixel and every channel by itself.
//!
//! Duties: says what [`super`] must come to; runs in its place with [`crate::Kernel::Specification`]. Inputs, outputs and
//! clocks: those of [`super`].

use super::super::specification::{load, store};
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_firmware::checked::{ClipBox, Compose, ComposeEntry, Mask, Paint, Sampled};

/// Blue, green, red, alpha.
type Channels = [u32; 4];

const ALPHA: usize = 3;

/// a b / 255, rounded.
fn multiply(a: u32, b: u32) -> u32 {
    let t = a * b + 128;
    (t + t / 256) / 256
}

fn widen(bits: u32, count: u32) -> u32 {
    (bits << (8 - count)) | (bits >> (2 * count - 8))
}

fn channels(format: PictureFormat, pixel: u32) -> Channels {
    let byte = |place: u32| (pixel >> (8 * place)) & 0xFF;
    match format {
        PictureFormat::Argb8888 => [byte(0), byte(1), byte(2), byte(3)],
        PictureFormat::Xrgb8888 => [byte(0), byte(1), byte(2), 255],
        PictureFormat::Abgr8888 => [byte(2), byte(1), byte(0), byte(3)],
        PictureFormat::Xbgr8888 => [byte(2), byte(1), byte(0), 255],
        PictureFormat::Rgb565 => [widen(pixel & 31, 5), widen((pixel >> 5) & 63, 6), widen((pixel >> 11) & 31, 5), 255],
        PictureFormat::Alpha8 => [0, 0, 0, byte(0)],
    }
}

fn pixel(format: PictureFormat, [b, g, r, a]: Channels) -> u32 {
    match format {
        PictureFormat::Argb8888 => a << 24 | r << 16 | g << 8 | b,
        PictureFormat::Xrgb8888 => 255 << 24 | r << 16 | g << 8 | b,
        PictureFormat::Abgr8888 => a << 24 | b << 16 | g << 8 | r,
        PictureFormat::Xbgr8888 => 255 << 24 | b << 16 | g << 8 | r,
        PictureFormat::Rgb565 => (r / 8) << 11 | (g / 4) << 5 | (b / 8),
        PictureFormat::Alpha8 => a,
    }
}

/// The place in a row of `size` pixels; `None` outside.
fn place(repeat: Repeat, at: i64, size: u32) -> Option<u32> {
    let size = i64::from(size);
    let at = match repeat {
        Repeat::None => at,
        Repeat::Normal => ((at % size) + size) % size,
        Repeat::Pad if at < 0 => 0,
        Repeat::Pad => at.min(size - 1),
        Repeat::Reflect => {
            let period = ((at % (2 * size)) + 2 * size) % (2 * size);
            period.min(2 * size - 1 - period)
        }
    };
    u32::try_from(at).ok().filter(|_| at < size)
}

fn sample(memory: &[u32], sampled: &Sampled, x: i32, y: i32) -> Channels {
    let (i, j) = (i64::from(x + sampled.offset[0]), i64::from(y + sampled.offset[1]));
    let (column, row) = match sampled.transform {
        None => (i, j),
        Some(t) => {
            // The centre of the pixel in 1/2^32, then to the nearest 1/2^16.
            let centre = |n: i64| (2 * n + 1) << 15;
            let sum = |a: i32, b: i32, c: i32| {
                let product = i128::from(a) * i128::from(centre(i)) + i128::from(b) * i128::from(centre(j));
                ((product + (1 << 15)) >> 16) + i128::from(c)
            };
            let pixel = |sum: i128| ((sum - 1) >> 16) as i64;
            (pixel(sum(t.xx, t.xy, t.x0)), pixel(sum(t.yx, t.yy, t.y0)))
        }
    };
    let image = &sampled.picture.image;
    match (place(sampled.repeat, column, image.width), place(sampled.repeat, row, image.height)) {
        (Some(column), Some(row)) => channels(sampled.picture.format, load(memory, image, column, row)),
        _ => [0; 4],
    }
}

fn paint_at(memory: &[u32], paint: &Paint, x: i32, y: i32) -> Channels {
    match paint {
        Paint::Colour(argb) => channels(PictureFormat::Argb8888, *argb),
        Paint::Picture(sampled) => sample(memory, sampled, x, y),
    }
}

/// The factors of source and destination, from the alphas of destination and source.
fn factors(operator: ComposeOperator, there: u32, source: u32) -> [u32; 2] {
    match operator {
        ComposeOperator::Clear => [0, 0],
        ComposeOperator::Source => [255, 0],
        ComposeOperator::Destination => [0, 255],
        ComposeOperator::Over => [255, 255 - source],
        ComposeOperator::OverReverse => [255 - there, 255],
        ComposeOperator::In => [there, 0],
        ComposeOperator::InReverse => [0, source],
        ComposeOperator::Out => [255 - there, 0],
        ComposeOperator::OutReverse => [0, 255 - source],
        ComposeOperator::Atop => [there, 255 - source],
        ComposeOperator::AtopReverse => [255 - there, source],
        ComposeOperator::Xor => [255 - there, 255 - source],
        ComposeOperator::Add => [255, 255],
    }
}

/// Draws the part of an entry that lies in a clip box.
pub(super) fn paint(memory: &mut [u32], compose: &Compose<'_>, entry: &ComposeEntry<'_>, part: ClipBox) {
    for y in part.y1..part.y2 {
        for x in part.x1..part.x2 {
            let source = paint_at(memory, &compose.source, x, y);
            let mask = match &compose.mask {
                Mask::None => None,
                Mask::Paint(paint) => Some(paint_at(memory, paint, x, y)),
                Mask::Inline(format) => {
                    let [column, row] = [x - entry.place.x, y - entry.place.y].map(|pixels| pixels as u32);
                    let bytes = format.bytes();
                    let row_words = (entry.place.width as u32 * bytes).div_ceil(4);
                    let byte = row * row_words * 4 + column * bytes;
                    let word = entry.rows[(byte / 4) as usize] >> (8 * (byte % 4));
                    Some(channels(*format, word))
                }
            };
            let image = &compose.onto.image;
            let there = channels(compose.onto.format, load(memory, image, x as u32, y as u32));
            let result = [0, 1, 2, 3].map(|channel| {
                let (s, alpha) = match mask {
                    None => (source[channel], source[ALPHA]),
                    Some(mask) if compose.components => {
                        (multiply(source[channel], mask[channel]), multiply(mask[channel], source[ALPHA]))
                    }
                    Some(mask) => (multiply(source[channel], mask[ALPHA]), multiply(source[ALPHA], mask[ALPHA])),
                };
                let [f, g] = factors(compose.operator, there[ALPHA], alpha);
                (multiply(s, f) + multiply(there[channel], g)).min(255)
            });
            store(memory, image, x as u32, y as u32, pixel(compose.onto.format, result));
        }
    }
}
