//! The bitmap unit as one would write it down: every pixel by itself, every source pixel read before any is written.
//!
//! Duties: says what [`super::combine`], [`super::convert`] and [`super::stretch`] must come to; runs in their place with
//! [`crate::Kernel::Specification`]. Inputs, outputs and clocks: theirs.

use super::stretch::{Tap, tap};
use zga_abi::format::RasterOperation;
use zga_firmware::checked::{Combine, CombineSource, Convert, Image, Stretch};

/// The byte addresses of a pixel, its least byte first.
fn places(image: &Image, x: u32, y: u32) -> impl Iterator<Item = u64> + use<> {
    let bytes = u64::from(image.format.bytes());
    let first = u64::from(image.base) + u64::from(y) * u64::from(image.pitch) + u64::from(x) * bytes;
    first..first + bytes
}

/// The stored pixel in column `x` of row `y`.
pub(super) fn load(memory: &[u32], image: &Image, x: u32, y: u32) -> u32 {
    let byte = |at: u64| (memory[(at / 4) as usize] >> (8 * (at % 4))) & 0xFF;
    places(image, x, y).zip(0..).map(|(at, place)| byte(at) << (8 * place)).sum()
}

/// Stores a pixel.
pub(super) fn store(memory: &mut [u32], image: &Image, x: u32, y: u32, pixel: u32) {
    for (at, place) in places(image, x, y).zip(0..) {
        let (word, shift) = (&mut memory[(at / 4) as usize], 8 * (at % 4));
        *word = (*word & !(0xFF << shift)) | (((pixel >> (8 * place)) & 0xFF) << shift);
    }
}

/// Columns and rows of an image, row by row.
fn pixels(image: &Image) -> impl Iterator<Item = (u32, u32)> + use<> {
    let width = image.width;
    (0..image.height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// What becomes of the bits `d` under the bits `s`.
pub(super) fn operate(operation: RasterOperation, s: u32, d: u32) -> u32 {
    match operation {
        RasterOperation::Clear => 0,
        RasterOperation::And => s & d,
        RasterOperation::AndReverse => s & !d,
        RasterOperation::Copy => s,
        RasterOperation::AndInverted => !s & d,
        RasterOperation::NoOperation => d,
        RasterOperation::Xor => s ^ d,
        RasterOperation::Or => s | d,
        RasterOperation::Nor => !(s | d),
        RasterOperation::Equivalent => !(s ^ d),
        RasterOperation::Invert => !d,
        RasterOperation::OrReverse => s | !d,
        RasterOperation::CopyInverted => !s,
        RasterOperation::OrInverted => !s | d,
        RasterOperation::Nand => !(s & d),
        RasterOperation::Set => u32::MAX,
    }
}

/// Combines a value or a rectangle with what is there.
pub(super) fn combine(memory: &mut [u32], combine: &Combine) {
    let Combine { source, destination, operation, planes } = combine;
    let sources: Vec<u32> = match source {
        CombineSource::Value(value) => pixels(destination).map(|_| *value).collect(),
        CombineSource::Image(image) => pixels(image).map(|(x, y)| load(memory, image, x, y)).collect(),
    };
    for ((x, y), source) in pixels(destination).zip(sources) {
        let old = load(memory, destination, x, y);
        let new = operate(*operation, source, old);
        store(memory, destination, x, y, (new & planes) | (old & !planes));
    }
}

/// Copies a rectangle into another format.
pub(super) fn convert(memory: &mut [u32], convert: &Convert) {
    let Convert { source, destination } = convert;
    let sources: Vec<u32> = pixels(source).map(|(x, y)| load(memory, source, x, y)).collect();
    for ((x, y), pixel) in pixels(destination).zip(sources) {
        store(memory, destination, x, y, destination.format.encode(source.format.decode(pixel)));
    }
}

/// Stretches a rectangle to another size.
pub(super) fn stretch(memory: &mut [u32], stretch: &Stretch) {
    let Stretch { source, destination, whole: [width, height], part: [left, top], filter } = *stretch;
    for (x, y) in pixels(&destination) {
        let across = tap(left + x, source.width, width, filter);
        let down = tap(top + y, source.height, height, filter);
        let colour = |x, y| source.format.decode(load(memory, &source, x, y)).map(u32::from);
        let corners = [
            [colour(across.first, down.first), colour(across.second, down.first)],
            [colour(across.first, down.second), colour(across.second, down.second)],
        ];
        let weights = |tap: Tap| [256 - tap.fraction, tap.fraction];
        let mean = |channel: usize| {
            let weighed = weights(down).into_iter().zip(corners).flat_map(|(row, pixels)| {
                weights(across).into_iter().zip(pixels).map(move |(column, pixel)| row * column * pixel[channel])
            });
            ((weighed.sum::<u32>() + (1 << 15)) >> 16) as u8
        };
        store(memory, &destination, x, y, destination.format.encode([mean(0), mean(1), mean(2), mean(3)]));
    }
}
