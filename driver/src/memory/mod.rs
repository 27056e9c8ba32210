//! Video memory allocator: first fit over a list of free ranges that are joined when they touch.
//!
//! Addresses are bytes from the start of video memory, as packets and registers hold them. The
//! allocator only keeps books; it never touches the bus.

mod block;

pub use block::VideoMemory;

/// What an address must be a multiple of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Alignment {
    /// 64 bytes: surfaces, vertices, everything the card reads in lines.
    #[default]
    Line,
    /// 4096 bytes: rings.
    Page,
}

impl Alignment {
    /// The alignment in bytes, a power of two.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Alignment::Line => 64,
            Alignment::Page => 4096,
        }
    }
}

/// A run of video memory that belongs to whoever holds this.
///
/// It is given back with [`VideoMemory::free`] (or [`crate::Driver::free`]); dropping it leaks the
/// run until the driver is gone, since a value without a bus cannot know when the card is done with it.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
#[must_use = "video memory that is dropped instead of freed is lost until the driver is gone"]
pub struct Allocation {
    address: u32,
    bytes: u32,
}

impl Allocation {
    /// First byte in video memory.
    #[must_use]
    pub const fn address(&self) -> u32 {
        self.address
    }

    /// Size in bytes, a multiple of 64; at least what was asked for.
    #[must_use]
    pub const fn bytes(&self) -> u32 {
        self.bytes
    }
}

/// Why the allocator refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MemoryError {
    /// No free range is large enough.
    #[error(
        "out of video memory: {asked} bytes asked for (aligned to {alignment}), {free} are free, \
         {largest} in the largest range"
    )]
    OutOfMemory {
        /// Bytes asked for.
        asked: u64,
        /// Alignment asked for, bytes.
        alignment: u32,
        /// Bytes free in all ranges.
        free: u64,
        /// Bytes in the largest free range.
        largest: u64,
    },
    /// The allocation is not one of this allocator's, or was freed before.
    #[error("video memory at {address:#010x} ({bytes} bytes) is not allocated here")]
    NotAllocated {
        /// First byte.
        address: u32,
        /// Size in bytes.
        bytes: u32,
    },
}

#[cfg(test)]
mod tests;
