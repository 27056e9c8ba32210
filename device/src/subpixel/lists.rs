//! The fragments of a band before they are sorted by pixel, in no more memory than the pool of its lines.
//!
//! As long as all of them fit, they are stored as they come. If not, some line's pool is full: then they are counted
//! first, which tells the pixels whose lists fit, and only theirs are stored.

use super::band::Input;
use super::pixel::Fragment;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Mode {
    /// All are stored, as long as there is room.
    #[default]
    All,
    /// They are counted.
    Counting,
    /// Those of pixels that were not rejected are stored.
    Fitting,
}

/// Fragments in the order in which they are found.
#[derive(Debug, Default)]
pub struct Lists {
    /// What is stored.
    pub stored: Vec<Fragment>,
    mode: Mode,
    /// Most that may be stored.
    limit: usize,
    overflowed: bool,
    /// Fragments of each pixel, once they are counted.
    counted: Vec<u32>,
    /// A bit a pixel whose list finds no room.
    rejected: Vec<u64>,
}

impl Lists {
    /// Empties the lists for a band.
    pub fn begin(&mut self, input: &Input<'_>) {
        self.stored.clear();
        self.mode = Mode::All;
        self.limit = input.setting.pool as usize * input.lines;
        self.overflowed = false;
        self.rejected.clear();
    }

    /// A fragment is found.
    #[inline(always)]
    pub fn put(&mut self, fragment: Fragment) {
        match self.mode {
            Mode::All if self.stored.len() < self.limit => self.stored.push(fragment),
            Mode::All => self.overflowed = true,
            Mode::Counting => self.counted[fragment.at as usize] += 1,
            Mode::Fitting if !self.is_rejected(fragment.at) => self.stored.push(fragment),
            Mode::Fitting => {}
        }
    }

    /// Not all that were found are stored: they are to be found again, twice. The first time they are counted.
    pub fn count(&mut self, input: &Input<'_>) -> bool {
        if self.overflowed {
            self.stored.clear();
            self.mode = Mode::Counting;
            self.counted.clear();
            self.counted.resize(input.words() * 64 * input.lines, 0);
        }
        self.overflowed
    }

    /// They are counted: finds out whose lists fit, from left to right. The second time those are stored.
    pub fn fit(&mut self, input: &Input<'_>) {
        self.mode = Mode::Fitting;
        self.rejected.resize(input.words() * input.lines, 0);
        let pool = u64::from(input.setting.pool);
        for (line, counted) in self.counted.chunks_exact(input.words() * 64).enumerate() {
            let mut used = 0;
            for (x, &count) in counted.iter().enumerate() {
                if used + u64::from(count) > pool {
                    self.rejected[line * input.words() + x / 64] |= 1 << (x % 64);
                } else {
                    used += u64::from(count);
                }
            }
        }
    }

    /// Whether a pixel's list finds no room, so far as that is known already.
    #[must_use]
    #[inline(always)]
    pub fn is_rejected(&self, at: u32) -> bool {
        self.rejected.get(at as usize / 64).is_some_and(|word| word & (1 << (at % 64)) != 0)
    }
}
