//! Combine: a raster operation of a value or a rectangle with what is there, on some planes.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line of the source read, 1 for each line written, and 1 more for
//! each of those where what is there has to be read: for its bits, or because a plane mask keeps some.
//! Inputs: [`Combine`] from the firmware. Outputs: pixels. Specification: [`super::specification`].
//!
//! Under a source bit every operation leaves a destination bit, turns it round, or sets it to 0 or 1. So one expression,
//! (d & keep) ^ flip, is all sixteen of them, with two masks that follow from the source word; a bit outside the plane
//! mask is kept and not turned. Where nothing is kept, a value is a plain fill and a copy a plain move.

use super::copy::{Order, move_pixels, stage};
use super::fill::fill_row;
use super::{Bitmap, Span, charge, specification};
use crate::probe::account::Account;
use std::ops::{BitAnd, BitOr, BitXor, Not};
use zga_abi::Counter;
use zga_abi::format::RasterOperation;
use zga_firmware::checked::{Combine, CombineSource};

/// A stored pixel.
pub(super) trait Pixel:
    bytemuck::Pod + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self> + PartialEq
{
    /// The low bits of a word.
    fn of(word: u32) -> Self;

    /// A word full of such pixels.
    fn repeated(self) -> u32;
}

impl Pixel for u32 {
    fn of(word: u32) -> u32 {
        word
    }

    fn repeated(self) -> u32 {
        self
    }
}

impl Pixel for u16 {
    fn of(word: u32) -> u16 {
        word as u16
    }

    fn repeated(self) -> u32 {
        u32::from(self) * 0x0001_0001
    }
}

impl Pixel for u8 {
    fn of(word: u32) -> u8 {
        word as u8
    }

    fn repeated(self) -> u32 {
        u32::from(self) * 0x0101_0101
    }
}

/// An operation on some planes: `(d & ((s & keep[0]) ^ keep[1])) ^ ((s & flip[0]) ^ flip[1])`.
#[derive(Clone, Copy)]
pub(super) struct Masks<P> {
    keep: [P; 2],
    flip: [P; 2],
}

impl<P: Pixel> Masks<P> {
    /// The masks of an operation on the bits `planes`.
    pub(super) fn new(operation: RasterOperation, planes: u32) -> Masks<P> {
        // Results for source 1 over 1 and 0, and for source 0 over 1 and 0, in every bit of a word.
        let [one_one, one_zero, zero_one, zero_zero] =
            [0, 1, 2, 3].map(|bit| if operation.code() >> bit & 1 == 1 { u32::MAX } else { 0 });
        let (kept_by_one, kept_by_zero) = (one_one ^ one_zero, zero_one ^ zero_zero);
        let keep = [(kept_by_one ^ kept_by_zero) & planes, kept_by_zero | !planes];
        let flip = [(one_zero ^ zero_zero) & planes, zero_zero & planes];
        Masks { keep: keep.map(P::of), flip: flip.map(P::of) }
    }

    /// The masks for a source word: what is kept, and what is turned then.
    pub(super) fn under(&self, source: P) -> [P; 2] {
        [self.keep, self.flip].map(|[factor, term]| (source & factor) ^ term)
    }

    /// Is the result the source, whatever is there?
    pub(super) fn is_copy(&self) -> bool {
        let (none, all) = (P::of(0), P::of(u32::MAX));
        self.keep == [none, none] && self.flip == [all, none]
    }

    /// Combines a row with as many pixels of the source.
    fn row(&self, row: &mut [P], source: &[P]) {
        for (pixel, &source) in row.iter_mut().zip(source) {
            let [keep, flip] = self.under(source);
            *pixel = (*pixel & keep) ^ flip;
        }
    }
}

impl Bitmap {
    /// Combines a value or a rectangle with what is there.
    pub(crate) fn combine(&mut self, memory: &mut [u32], combine: &Combine, account: &mut Account) {
        let to = Span::of(&combine.destination);
        if self.specification {
            specification::combine(memory, combine);
        } else {
            match combine.destination.format.bytes() {
                4 => self.combine_pixels::<u32>(memory, combine),
                2 => self.combine_pixels::<u16>(bytemuck::cast_slice_mut(memory), combine),
                _ => self.combine_pixels::<u8>(bytemuck::cast_slice_mut(memory), combine),
            }
        }
        let pixels = u64::from(combine.destination.width) * u64::from(combine.destination.height);
        let read = match &combine.source {
            CombineSource::Value(_) => 0,
            CombineSource::Image(image) => Span::of(image).lines(),
        };
        let there = u64::from(combine.reads_destination());
        account.add(Counter::BitmapCombined, there * pixels);
        charge(account, pixels, read + (1 + there) * to.lines());
    }

    fn combine_pixels<P: Pixel>(&mut self, memory: &mut [P], combine: &Combine) {
        let masks = Masks::<P>::new(combine.operation, combine.planes);
        let to = Span::of(&combine.destination);
        match &combine.source {
            CombineSource::Value(value) => {
                let to = to.joined();
                let [keep, flip] = masks.under(P::of(*value));
                let length = to.pixels::<P>();
                for row in 0..to.rows {
                    let pixels = &mut memory[to.at::<P>(row)..][..length];
                    if keep == P::of(0) {
                        fill_row(pixels, flip);
                    } else {
                        pixels.iter_mut().for_each(|pixel| *pixel = (*pixel & keep) ^ flip);
                    }
                }
            }
            CombineSource::Image(image) if masks.is_copy() => {
                move_pixels(memory, Span::of(image), to, &mut self.scratch);
            }
            CombineSource::Image(image) => self.combine_rows(memory, masks, Span::of(image), to),
        }
    }

    /// Combines rows with rows, in an order in which each is read before it is written.
    pub(super) fn combine_rows<P: Pixel>(&mut self, memory: &mut [P], masks: Masks<P>, from: Span, to: Span) {
        let length = to.pixels::<P>();
        let mut row = |row| combine_row(memory, masks, from.at::<P>(row), to.at::<P>(row), length, &mut self.line);
        match Order::of(&from, &to) {
            Order::Rising => (0..to.rows).for_each(&mut row),
            Order::Falling => (0..to.rows).rev().for_each(&mut row),
            Order::None => {
                let from = stage(memory, from, &mut self.scratch);
                let source: &[P] = bytemuck::cast_slice(&self.scratch);
                for row in 0..to.rows {
                    let pixels = &mut memory[to.at::<P>(row)..][..length];
                    masks.row(pixels, &source[from.at::<P>(row)..][..length]);
                }
            }
        }
    }
}

/// Combines `length` pixels with as many of the source, as if all of these were read first.
fn combine_row<P: Pixel>(
    memory: &mut [P],
    masks: Masks<P>,
    from: usize,
    to: usize,
    length: usize,
    line: &mut Vec<u32>,
) {
    if to + length <= from {
        let (low, high) = memory.split_at_mut(from);
        masks.row(&mut low[to..][..length], &high[..length]);
    } else if from + length <= to {
        let (low, high) = memory.split_at_mut(to);
        masks.row(&mut high[..length], &low[from..][..length]);
    } else {
        line.resize((length * size_of::<P>()).div_ceil(4), 0);
        let read: &mut [P] = &mut bytemuck::cast_slice_mut(line)[..length];
        read.copy_from_slice(&memory[from..][..length]);
        masks.row(&mut memory[to..][..length], read);
    }
}
