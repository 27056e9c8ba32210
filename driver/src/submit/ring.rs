//! Arithmetic of the command ring. The driver owns the put pointer, the card the get pointer.
//!
//! Empty is `put == get`; full is one word left. A batch is always contiguous: what is left before the
//! end of the ring is filled with one NO_OPERATION if the batch does not fit there.

/// A ring of `size` words in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ring {
    /// First byte in video memory.
    pub base: u32,
    /// Words, a power of two.
    pub size: u32,
    /// Word after the last one written.
    pub put: u32,
    /// First word that the card may still have to read, as far as fences have told.
    pub get: u32,
}

/// Where a batch goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// Words of NO_OPERATION from the put pointer to the end of the ring; 0 for none.
    pub padding: u32,
    /// First word of the batch.
    pub start: u32,
    /// The put pointer after it.
    pub end: u32,
}

impl Ring {
    /// An empty ring.
    pub const fn new(base: u32, size: u32) -> Ring {
        Ring { base, size, put: 0, get: 0 }
    }

    /// Words that can be written now.
    pub const fn free(&self) -> u32 {
        self.get.wrapping_sub(self.put).wrapping_sub(1) & (self.size - 1)
    }

    /// Where a batch of `words` words goes, if there is room.
    pub fn place(&self, words: u32) -> Option<Place> {
        let to_end = self.size - self.put;
        let padding = if words > to_end { to_end } else { 0 };
        if words.checked_add(padding)? > self.free() {
            return None;
        }
        let start = (self.put + padding) & (self.size - 1);
        Some(Place { padding, start, end: (start + words) & (self.size - 1) })
    }

    /// Byte offset of a word in video memory.
    pub const fn address(&self, word: u32) -> u32 {
        self.base + 4 * word
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn place_empty_ring_takes_all_but_one_word() {
        let ring = Ring::new(0, 256);
        assert_eq!(ring.free(), 255);
        assert_eq!(ring.place(255), Some(Place { padding: 0, start: 0, end: 255 }));
        assert_eq!(ring.place(256), None);
    }

    #[test]
    fn place_exact_end_wraps_put_to_zero_without_padding() {
        let ring = Ring { put: 200, get: 200, ..Ring::new(0, 256) };
        assert_eq!(ring.place(56), Some(Place { padding: 0, start: 200, end: 0 }));
    }

    #[test]
    fn place_beyond_end_pads_and_starts_at_zero() {
        let ring = Ring { put: 200, get: 200, ..Ring::new(0, 256) };
        assert_eq!(ring.place(57), Some(Place { padding: 56, start: 0, end: 57 }));
    }

    #[test]
    fn place_padding_counts_as_used() {
        let ring = Ring { put: 200, get: 57, ..Ring::new(0, 256) };
        assert_eq!(ring.free(), 112);
        assert_eq!(ring.place(57), None);
    }

    #[test]
    fn free_put_behind_get_keeps_one_word() {
        let ring = Ring { put: 9, get: 10, ..Ring::new(0, 256) };
        assert_eq!(ring.free(), 0);
    }
}
