//! Za RAM: static memory of the Za path, seen by the host through its own window.
//!
//! Duties: holds words; costs the host nothing until somebody writes to it.
//! Inputs and outputs: bursts of the host; the Za unit, which works on the words directly.
//! Clocks: none of its own; the Za unit charges its accesses.

/// Za RAM.
#[derive(Debug)]
pub(crate) struct ZaRam {
    words: usize,
    /// Empty until the first write: all words are 0 then.
    stored: Vec<u32>,
}

impl ZaRam {
    /// `bytes` bytes of zeros.
    pub(crate) fn new(bytes: u32) -> ZaRam {
        ZaRam { words: (bytes / 4) as usize, stored: Vec::new() }
    }

    /// Reads from word `index` on; returns how many words there are.
    pub(crate) fn read(&self, index: usize, words: &mut [u32]) -> usize {
        let count = words.len().min(self.words.saturating_sub(index));
        match self.stored.get(index..index + count) {
            Some(stored) => words[..count].copy_from_slice(stored),
            None => words[..count].fill(0),
        }
        count
    }

    /// Writes from word `index` on; returns how many words there are.
    pub(crate) fn write(&mut self, index: usize, words: &[u32]) -> usize {
        let count = words.len().min(self.words.saturating_sub(index));
        if count > 0 {
            self.stored.resize(self.words, 0);
            self.stored[index..index + count].copy_from_slice(&words[..count]);
        }
        count
    }

    /// All words, for the Za unit.
    pub(crate) fn words_mut(&mut self) -> &mut [i32] {
        self.stored.resize(self.words, 0);
        bytemuck::cast_slice_mut(&mut self.stored)
    }

    /// All words that were ever written; the others are 0.
    pub(crate) fn words(&self) -> &[i32] {
        bytemuck::cast_slice(&self.stored)
    }

    /// Everything that was ever written, for a snapshot; empty when nothing was.
    pub(crate) fn save(&self) -> Vec<u32> {
        self.stored.clone()
    }

    /// The reverse of [`ZaRam::save`].
    pub(crate) fn load(&mut self, stored: &[u32]) {
        self.stored = stored.to_vec();
        if !self.stored.is_empty() {
            self.stored.resize(self.words, 0);
        }
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> u32 {
        // The power-on options are bytes in a u32.
        4 * self.words as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn read_before_the_first_write_is_zero_and_allocates_nothing() {
        let mut ram = ZaRam::new(4096);
        let mut words = [7; 2];
        assert_eq!(ram.read(1023, &mut words), 1);
        assert_eq!(words, [0, 7]);
        assert_eq!(ram.write(1024, &[1]), 0);
        assert!(ram.save().is_empty());
        assert_eq!(ram.write(1023, &[1, 2]), 1);
        assert_eq!(ram.save().len(), 1024);
    }
}
