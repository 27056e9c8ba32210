//! Transfer: words of a packet to rows, rows to a dense run.
//!
//! Duties and clocks: see [`super`]; an upload costs 1 clock for each line written, a download 1
//! for each line read and 1 for each line written.
//! Inputs: [`Rows`] from the firmware. Outputs: words in video memory.

use super::{Bitmap, Span, charge};
use crate::probe::account::Account;
use zga_firmware::checked::Rows;

/// The rows of a transfer. One row has no pitch: none that it names is looked at.
fn span(rows: &Rows) -> Span {
    let row_bytes = 4 * u64::from(rows.words);
    let pitch = if rows.rows == 1 { row_bytes } else { u64::from(rows.pitch) };
    Span { base: u64::from(rows.address), pitch, row_bytes, rows: u64::from(rows.rows) }
}

/// Writes `words` to rows; there are as many as the rows hold.
pub(crate) fn upload(memory: &mut [u32], rows: &Rows, words: &[u32], account: &mut Account) {
    let to = span(rows);
    for (row, words) in (0..to.rows).zip(words.chunks_exact(rows.words as usize)) {
        memory[((to.base + row * to.pitch) / 4) as usize..][..words.len()].copy_from_slice(words);
    }
    charge(account, words.len() as u64, to.lines());
}

impl Bitmap {
    /// Gathers rows into a dense run at byte `destination`, as if all were read before any is written.
    pub(crate) fn download(&mut self, memory: &mut [u32], rows: &Rows, destination: u32, account: &mut Account) {
        let from = span(rows);
        let to = Span { base: u64::from(destination), pitch: from.row_bytes, ..from };
        self.move_rows(memory, from, to);
        let words = from.rows * u64::from(rows.words);
        charge(account, words, from.lines() + to.joined().lines());
    }
}
