//! Copy: a rectangle to another place, as if all of it were read before any is written.
//!
//! Duties and clocks: see [`super`]; 1 clock for each line read and 1 for each line written.
//! Inputs: `checked::Copy` from the firmware. Outputs: pixels.
//!
//! With equal pitches, rows are moved away from the direction of travel: downward moves start at
//! the last row, so no row is overwritten before it is read, and a row that overlaps itself is moved
//! as `memmove` does. With different pitches and an overlap no order of rows is safe in general;
//! then all rows are read first.

use super::fill::rows_of;
use super::{Bitmap, Span, charge};
use crate::probe::account::Account;
use zga_firmware::checked::Copy;

impl Bitmap {
    /// Copies a rectangle.
    pub(crate) fn copy(&mut self, memory: &mut [u32], copy: &Copy, account: &mut Account) {
        let (from, to) = (rows_of(&copy.source), rows_of(&copy.destination));
        if copy.source.format.bytes() == 4 {
            self.move_rows(memory, from, to);
        } else {
            move_pixels(bytemuck::cast_slice_mut::<u32, u16>(memory), from, to, &mut self.scratch);
        }
        let pixels = u64::from(copy.source.width) * u64::from(copy.source.height);
        charge(account, pixels, from.lines() + to.lines());
    }

    /// Moves rows of words.
    pub(super) fn move_rows(&mut self, memory: &mut [u32], from: Span, to: Span) {
        move_pixels(memory, from, to, &mut self.scratch);
    }
}

/// The order of rows in which each is read before it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// From the first on.
    Rising,
    /// From the last on.
    Falling,
    /// There is none in general: all must be read first.
    None,
}

impl Order {
    /// The order for rows that are as many and as long in both.
    pub(super) fn of(from: &Span, to: &Span) -> Order {
        if from.apart(to) || (from.pitch == to.pitch && to.base <= from.base) {
            Order::Rising
        } else if from.pitch == to.pitch {
            Order::Falling
        } else {
            Order::None
        }
    }
}

/// Moves rows of pixels; both have the same number of rows of the same length.
pub(super) fn move_pixels<P: bytemuck::Pod>(memory: &mut [P], from: Span, to: Span, scratch: &mut Vec<u32>) {
    let (mut from, mut to) = (from, to);
    if from.joined().rows == to.joined().rows {
        (from, to) = (from.joined(), to.joined());
    }
    let length = from.pixels::<P>();
    let mut move_row = |row| {
        let start = from.at::<P>(row);
        memory.copy_within(start..start + length, to.at::<P>(row));
    };
    match Order::of(&from, &to) {
        Order::Rising => (0..from.rows).for_each(&mut move_row),
        Order::Falling => (0..from.rows).rev().for_each(&mut move_row),
        Order::None => {
            let from = stage(memory, from, scratch);
            let read: &[P] = bytemuck::cast_slice(scratch);
            for row in 0..to.rows {
                memory[to.at::<P>(row)..][..length].copy_from_slice(&read[from.at::<P>(row)..][..length]);
            }
        }
    }
}

/// Reads all rows into `scratch`, each from a whole word on; where they are there.
pub(super) fn stage<P: bytemuck::Pod>(memory: &[P], from: Span, scratch: &mut Vec<u32>) -> Span {
    let staged = Span { base: 0, pitch: from.row_bytes.next_multiple_of(4), ..from };
    // Not cleared: every byte that is looked at is written here.
    scratch.resize((staged.pitch * staged.rows / 4) as usize, 0);
    let read: &mut [P] = bytemuck::cast_slice_mut(scratch);
    let length = from.pixels::<P>();
    for row in 0..from.rows {
        read[staged.at::<P>(row)..][..length].copy_from_slice(&memory[from.at::<P>(row)..][..length]);
    }
    staged
}
