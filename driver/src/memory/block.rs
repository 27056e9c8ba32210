//! The books of the allocator.

use std::collections::BTreeMap;

use super::{Alignment, Allocation, MemoryError};

/// Granularity of sizes and addresses in bytes: the card's surfaces need it.
const LINE: u64 = Alignment::Line.bytes() as u64;

/// First-fit allocator over a card's video memory.
///
/// # Invariants
/// Free ranges are multiples of 64 bytes, never empty, never overlap and never touch; free and used
/// ranges together are the whole memory.
#[derive(Debug)]
pub struct VideoMemory {
    /// First byte to first byte beyond.
    free: BTreeMap<u64, u64>,
    /// First byte to size.
    used: BTreeMap<u32, u32>,
}

impl VideoMemory {
    /// Books for `bytes` bytes of memory, all free. A tail of less than 64 bytes is not used.
    #[must_use]
    pub fn new(bytes: u32) -> VideoMemory {
        let end = u64::from(bytes) / LINE * LINE;
        let mut free = BTreeMap::new();
        if end > 0 {
            free.insert(0, end);
        }
        VideoMemory { free, used: BTreeMap::new() }
    }

    /// Bytes that are free, in all ranges.
    #[must_use]
    pub fn free_bytes(&self) -> u64 {
        self.free.iter().map(|(start, end)| end - start).sum()
    }

    /// Bytes in the largest free range.
    #[must_use]
    pub fn largest_free(&self) -> u64 {
        self.free.iter().map(|(start, end)| end - start).max().unwrap_or(0)
    }

    /// Takes the first range that holds `bytes` bytes (rounded up to 64, at least 64) at this alignment.
    ///
    /// # Errors
    /// [`MemoryError::OutOfMemory`] with what was asked for and what is there.
    pub fn allocate(&mut self, bytes: u64, alignment: Alignment) -> Result<Allocation, MemoryError> {
        let refused = |books: &VideoMemory| MemoryError::OutOfMemory {
            asked: bytes,
            alignment: alignment.bytes(),
            free: books.free_bytes(),
            largest: books.largest_free(),
        };
        let Some(size) = bytes.max(1).checked_next_multiple_of(LINE) else { return Err(refused(self)) };
        let align = u64::from(alignment.bytes());
        let fit = self.free.iter().find_map(|(&start, &end)| {
            let at = start.next_multiple_of(align);
            (end.checked_sub(at)? >= size).then_some((start, end, at))
        });
        let Some((start, end, at)) = fit else { return Err(refused(self)) };
        let (Ok(address), Ok(taken)) = (u32::try_from(at), u32::try_from(size)) else { return Err(refused(self)) };
        self.free.remove(&start);
        if start < at {
            self.free.insert(start, at);
        }
        if at + size < end {
            self.free.insert(at + size, end);
        }
        self.used.insert(address, taken);
        Ok(Allocation { address, bytes: taken })
    }

    /// Gives a run back and joins it with free neighbours.
    ///
    /// # Errors
    /// [`MemoryError::NotAllocated`] if the run is not one of this allocator's.
    #[expect(clippy::needless_pass_by_value, reason = "freeing takes the handle away from its holder")]
    pub fn free(&mut self, allocation: Allocation) -> Result<(), MemoryError> {
        let Allocation { address, bytes } = allocation;
        if self.used.get(&address) != Some(&bytes) {
            return Err(MemoryError::NotAllocated { address, bytes });
        }
        self.used.remove(&address);
        let (mut start, mut end) = (u64::from(address), u64::from(address) + u64::from(bytes));
        if let Some((&before, &touches)) = self.free.range(..start).next_back()
            && touches == start
        {
            self.free.remove(&before);
            start = before;
        }
        if let Some(after) = self.free.remove(&end) {
            end = after;
        }
        self.free.insert(start, end);
        Ok(())
    }

    /// Number of runs in use.
    #[must_use]
    pub fn allocations(&self) -> usize {
        self.used.len()
    }

    /// Whether the invariants hold; for tests.
    #[cfg(test)]
    pub(super) fn is_consistent(&self, bytes: u32) -> bool {
        let mut ranges: Vec<(u64, u64, bool)> = self.free.iter().map(|(&s, &e)| (s, e, true)).collect();
        ranges.extend(self.used.iter().map(|(&a, &b)| (u64::from(a), u64::from(a) + u64::from(b), false)));
        ranges.sort_unstable();
        let whole = u64::from(bytes) / LINE * LINE;
        let covers = ranges.first().map_or(whole == 0, |r| r.0 == 0) && ranges.last().is_none_or(|r| r.1 == whole);
        covers && ranges.windows(2).all(|w| w[0].1 == w[1].0 && !(w[0].2 && w[1].2)) && ranges.iter().all(|r| r.0 < r.1)
    }
}
