//! Address ranges: does what a packet names lie in video memory, and apart from something else?
//!
//! Sums and products are taken in u64 and saturate, so no claim wraps round into memory.

use super::claim::Claim;
use crate::hardware::Hardware;
use zga_abi::{Fault, FaultCode, Reg};

/// Alignment of everything that is drawn to or shown, in bytes: a chunk of 16 words.
pub(super) const CHUNK: u32 = 64;

/// Most pixels of a row, and most rows.
pub(super) const LARGEST_SIDE: u32 = 16384;

/// A run of bytes in video memory; `end` is exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    start: u64,
    end: u64,
}

impl Span {
    /// A byte lies in both.
    pub const fn overlaps(self, other: Span) -> bool {
        self.start < other.end && other.start < self.end
    }
}

/// How much video memory there is.
#[derive(Clone, Copy, Debug)]
pub(super) struct VideoMemory {
    bytes: u64,
}

impl VideoMemory {
    /// The card's video memory.
    pub fn of<H: Hardware>(hardware: &H) -> VideoMemory {
        VideoMemory { bytes: u64::from(hardware.register(Reg::VideoMemorySize, 0)) }
    }

    /// The run of `bytes` bytes from `base` on, or OUT_OF_MEMORY. An empty run is anywhere.
    pub fn span(self, base: Claim, bytes: u64) -> Result<Span, Fault> {
        let start = u64::from(base.value);
        let end = start.saturating_add(bytes);
        if bytes == 0 || end <= self.bytes { Ok(Span { start, end }) } else { Err(base.refuse(FaultCode::OutOfMemory)) }
    }

    /// A run of `words` words at the byte address `address`.
    pub fn words(self, address: Claim, words: u32) -> Result<(), Fault> {
        address.multiple_of(4)?;
        self.span(address, u64::from(words) * 4).map(|_| ())
    }

    /// Something drawn to or shown: `height` whole rows of `pitch` bytes, of which `row_bytes` are
    /// in use, on chunk boundaries.
    pub fn frame(self, base: Claim, pitch: Claim, row_bytes: u32, height: u32) -> Result<Span, Fault> {
        base.multiple_of(CHUNK)?;
        pitch.multiple_of(CHUNK)?;
        pitch.require(pitch.value >= row_bytes)?;
        self.span(base, u64::from(pitch.value) * u64::from(height))
    }
}
