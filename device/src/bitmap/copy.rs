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
            move_pixels(bytemuck::cast_slice_mut::<u32, u16>(memory), 2, from, to, &mut self.scratch);
        }
        let pixels = u64::from(copy.source.width) * u64::from(copy.source.height);
        charge(account, pixels, from.lines() + to.lines());
    }

    /// Moves rows of words.
    pub(super) fn move_rows(&mut self, memory: &mut [u32], from: Span, to: Span) {
        move_pixels(memory, 4, from, to, &mut self.scratch);
    }
}

/// Moves rows of pixels of `size` bytes; both have the same number of rows of the same length.
fn move_pixels<P: bytemuck::Pod>(memory: &mut [P], size: u64, from: Span, to: Span, scratch: &mut Vec<u32>) {
    let at = |rows: &Span, row: u64| ((rows.base + row * rows.pitch) / size) as usize;
    let (mut from, mut to) = (from, to);
    if from.joined().rows == to.joined().rows {
        (from, to) = (from.joined(), to.joined());
    }
    let length = (from.row_bytes / size) as usize;
    let mut move_row = |row| {
        let start = at(&from, row);
        memory.copy_within(start..start + length, at(&to, row));
    };
    if from.apart(&to) || (from.pitch == to.pitch && to.base <= from.base) {
        (0..from.rows).for_each(&mut move_row);
    } else if from.pitch == to.pitch {
        (0..from.rows).rev().for_each(&mut move_row);
    } else {
        let all = length * from.rows as usize;
        scratch.clear();
        scratch.resize((all * size_of::<P>()).div_ceil(4), 0);
        let read: &mut [P] = &mut bytemuck::cast_slice_mut(scratch)[..all];
        for (row, words) in (0..from.rows).zip(read.chunks_exact_mut(length)) {
            words.copy_from_slice(&memory[at(&from, row)..][..length]);
        }
        for (row, words) in (0..to.rows).zip(read.chunks_exact(length)) {
            memory[at(&to, row)..][..length].copy_from_slice(words);
        }
    }
}
