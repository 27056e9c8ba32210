//! Bitmap unit: fills and moves rectangles in video memory.
//!
//! Duties: fill, copy with any overlap, upload from packets, download to a dense run.
//! Inputs: checked rectangles from the firmware. Outputs: words in video memory.
//! Clocks (`cycles.bitmap`): video memory moves one line of 64 bytes a clock, so each row costs
//! 1 clock for each line it writes and, where it reads, 1 for each line it reads. What the words
//! pass through in between costs nothing: it works while memory does. An upload's words come from
//! the front end, which has charged them. A copy that overlaps itself costs what any other does.
//!
//! | file | stage |
//! | --- | --- |
//! | [`fill`] | one value to a rectangle |
//! | [`copy`] | rectangle to rectangle |
//! | [`transfer`] | packet to rows, rows to a dense run |

pub(crate) mod copy;
pub(crate) mod fill;
pub(crate) mod transfer;

use crate::memory::lines;
use crate::probe::account::{Account, Clocks};
use zga_abi::Counter;

/// Room that the bitmap unit uses again and again; empty until an overlap needs it.
#[derive(Debug, Default)]
pub(crate) struct Bitmap {
    scratch: Vec<u32>,
}

impl Bitmap {
    /// Gives its memory back.
    pub(crate) fn power_off(&mut self) {
        self.scratch = Vec::new();
    }
}

/// Rows of bytes in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    base: u64,
    pitch: u64,
    row_bytes: u64,
    rows: u64,
}

impl Span {
    /// First byte beyond the last row.
    fn end(&self) -> u64 {
        self.base + (self.rows - 1) * self.pitch + self.row_bytes
    }

    /// Lie the two apart, gaps between rows counted in?
    fn apart(&self, other: &Span) -> bool {
        self.end() <= other.base || other.end() <= self.base
    }

    /// Lines that the rows lie in, each row by itself.
    fn lines(&self) -> u64 {
        (0..self.rows).map(|row| lines(self.base + row * self.pitch, self.row_bytes)).sum()
    }

    /// The same rows as one, if nothing lies between them.
    fn joined(self) -> Span {
        if self.pitch == self.row_bytes {
            Span { row_bytes: self.row_bytes * self.rows, rows: 1, ..self }
        } else {
            self
        }
    }
}

/// Charges `lines` lines and counts `pixels` pixels or words.
fn charge(account: &mut Account, pixels: u64, lines: u64) {
    account.add(Counter::BitmapPixels, pixels);
    account.charge(Counter::CyclesBitmap, Clocks(lines));
}
