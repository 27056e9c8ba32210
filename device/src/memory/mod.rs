//! Memory: video memory and Za RAM behind their windows.
//!
//! Duties: bounds of the memories, bursts, a note of what changed for scan-out; which frames have blocks
//! that are cleared in Za RAM only ([`areas`]).
//! Inputs: bursts of the host; the units, which work on the words directly.
//! Outputs: words; [`VideoMemory::generation`].
//! Clocks: none of its own; each unit charges its accesses. The interface is [`LINE_BYTES`] wide.
//!
//! Words are 32 bits; the first of two 16-bit pixels stands in a word's low half.

pub(crate) mod areas;
mod mapped;
mod za_ram;

pub use mapped::MappedMemory;
pub(crate) use za_ram::ZaRam;

use crate::probe::account::Account;
use areas::{Areas, Parts};
use std::ops::Range;

/// Bytes that video memory moves in one clock: one line, at an address that is a multiple of it.
pub(crate) const LINE_BYTES: u64 = 64;

/// Video memory, and Za RAM beside it: the host sees neither while a packet is at work.
#[derive(Debug)]
pub(crate) struct VideoMemory {
    words: Vec<u32>,
    za: ZaRam,
    areas: Areas,
    /// Counts changes that can be seen in the frame shown.
    generation: u64,
    /// Words of the frame and of the cursor shown; host writes elsewhere cannot be seen.
    watched: [Range<usize>; 2],
    /// Words whose contents the pipeline remembers.
    remembered: Range<usize>,
    /// Counts changes that others may have made there.
    foreign: u64,
    /// Words that the texture unit has decoded, and whether they may have changed since.
    texels: Vec<(Range<usize>, bool)>,
}

impl VideoMemory {
    /// `bytes` bytes of zeros, and Za RAM. The host's pages come when they are first touched.
    pub(crate) fn new(bytes: u32, za_ram: u32) -> VideoMemory {
        VideoMemory {
            words: vec![0; (bytes / 4) as usize],
            za: ZaRam::new(za_ram),
            areas: Areas::default(),
            generation: 0,
            watched: [0..0, 0..0],
            remembered: 0..0,
            foreign: 0,
            texels: Vec::new(),
        }
    }

    /// All words.
    pub(crate) fn words(&self) -> &[u32] {
        &self.words
    }

    /// All words, to change some of them without regard to what anybody remembers.
    pub(crate) fn words_mut(&mut self) -> &mut [u32] {
        self.generation += 1;
        self.foreign += 1;
        self.changed(0..self.words.len());
        &mut self.words
    }

    /// All words, for a unit that reads `read` and changes `changed` bytes: what is cleared there in Za RAM
    /// only comes to memory first.
    pub(crate) fn using(&mut self, read: Range<u64>, changed: Range<u64>, account: &mut Account) -> &mut [u32] {
        if !self.areas.all().is_empty() {
            let (mut parts, areas) = self.parts();
            areas.release(&mut parts, read, false, account);
            areas.release(&mut parts, changed.clone(), true, account);
        }
        self.generation += 1;
        let changed = (changed.start / 4) as usize..changed.end.div_ceil(4) as usize;
        if changed.start < self.remembered.end && self.remembered.start < changed.end {
            self.foreign += 1;
        }
        self.changed(changed);
        &mut self.words
    }

    /// A unit is about to read these bytes beside those that it names as it takes the words.
    pub(crate) fn reading(&mut self, read: Range<u64>, account: &mut Account) {
        if !self.areas.all().is_empty() {
            let (mut parts, areas) = self.parts();
            areas.release(&mut parts, read, false, account);
        }
    }

    /// All words, for the pipeline, which knows what it changes.
    pub(crate) fn drawing(&mut self) -> &mut [u32] {
        self.generation += 1;
        &mut self.words
    }

    /// Both memories and the frames with logical clears, for the pipeline.
    pub(crate) fn parts(&mut self) -> (Parts<'_>, &mut Areas) {
        self.generation += 1;
        (Parts { video: &mut self.words, za: self.za.words_mut(), foreign: self.foreign }, &mut self.areas)
    }

    /// Za RAM.
    pub(crate) fn za(&self) -> &ZaRam {
        &self.za
    }

    /// Za RAM, for the host, which can change what is shown by it.
    pub(crate) fn za_mut(&mut self) -> &mut ZaRam {
        self.generation += 1;
        &mut self.za
    }

    /// The frames with logical clears.
    pub(crate) fn areas(&self) -> &Areas {
        &self.areas
    }

    /// The frames with logical clears, to put those of a snapshot there.
    pub(crate) fn set_areas(&mut self, areas: Areas) {
        self.areas = areas;
    }

    /// Reads from word `index` on; returns how many words there are, the rest stay as they are.
    pub(crate) fn read(&self, index: usize, words: &mut [u32]) -> usize {
        let stored = self.words.get(index..).unwrap_or_default();
        let count = stored.len().min(words.len());
        words[..count].copy_from_slice(&stored[..count]);
        count
    }

    /// Writes from word `index` on; returns how many words there are, the rest go nowhere.
    pub(crate) fn write(&mut self, index: usize, words: &[u32]) -> usize {
        let stored = self.words.get_mut(index..).unwrap_or_default();
        let count = stored.len().min(words.len());
        stored[..count].copy_from_slice(&words[..count]);
        if self.watched.iter().any(|watched| index < watched.end && index + count > watched.start) {
            self.generation += 1;
        }
        if index < self.remembered.end && index + count > self.remembered.start {
            self.foreign += 1;
        }
        self.changed(index..index + count);
        count
    }

    /// Words may have changed that somebody keeps texels of.
    pub(crate) fn changed(&mut self, words: Range<usize>) {
        for (kept, stale) in &mut self.texels {
            *stale |= words.start < kept.end && kept.start < words.end;
        }
    }

    /// The texture unit keeps what these words hold; the range is told apart by its place, in order of these calls.
    pub(crate) fn keep_texels(&mut self, words: Range<usize>) {
        self.texels.push((words, false));
    }

    /// Whether the words of the range at `place` may have changed since they were kept.
    pub(crate) fn texels_are_stale(&self, place: usize) -> bool {
        self.texels.get(place).is_none_or(|(_, stale)| *stale)
    }

    /// The texture unit does not keep the range at `place` any more; those behind it move up.
    pub(crate) fn forget_texels(&mut self, place: usize) {
        if place < self.texels.len() {
            self.texels.remove(place);
        }
    }

    /// The pipeline remembers what these words hold.
    pub(crate) fn remember(&mut self, words: Range<usize>) {
        self.remembered = words;
    }

    /// Changes whenever somebody but the pipeline may have changed a remembered word.
    pub(crate) fn foreign(&self) -> u64 {
        self.foreign
    }

    /// Changes with every change that can be seen in the frame shown.
    pub(crate) fn generation(&self) -> u64 {
        self.generation
    }

    /// The frame and the cursor shown lie in these words.
    pub(crate) fn watch(&mut self, words: [Range<usize>; 2]) {
        self.watched = words;
    }
}

/// Lines that `bytes` bytes from byte `address` on lie in.
pub(crate) fn lines(address: u64, bytes: u64) -> u64 {
    if bytes == 0 {
        return 0;
    }
    (address + bytes - 1) / LINE_BYTES - address / LINE_BYTES + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_counts_each_line_touched() {
        assert_eq!(lines(0, 0), 0);
        assert_eq!(lines(0, 64), 1);
        assert_eq!(lines(60, 4), 1);
        assert_eq!(lines(60, 8), 2);
        assert_eq!(lines(63, 66), 3);
    }

    #[test]
    fn write_outside_the_frame_shown_is_no_change() {
        let mut memory = VideoMemory::new(4096, 0);
        memory.watch([16..32, 0..0]);
        memory.write(0, &[1; 16]);
        memory.write(32, &[1; 16]);
        assert_eq!(memory.generation(), 0);
        memory.write(15, &[1, 1]);
        memory.write(31, &[1]);
        assert_eq!(memory.generation(), 2);
    }

    #[test]
    fn foreign_counts_what_may_have_changed_remembered_words() {
        let mut memory = VideoMemory::new(4096, 0);
        memory.remember(16..32);
        memory.write(0, &[1; 16]);
        memory.write(32, &[1; 16]);
        memory.drawing()[20] = 1;
        assert_eq!(memory.foreign(), 0);
        memory.write(31, &[1]);
        assert_eq!(memory.foreign(), 1);
        memory.words_mut()[0] = 1;
        assert_eq!(memory.foreign(), 2);
    }

    #[test]
    fn read_beyond_the_end_says_how_far_it_came() {
        let mut memory = VideoMemory::new(4096, 0);
        assert_eq!(memory.write(1022, &[5; 8]), 2);
        let mut words = [9; 4];
        assert_eq!(memory.read(1023, &mut words), 1);
        assert_eq!(words, [5, 9, 9, 9]);
        assert_eq!(memory.read(5000, &mut words), 0);
    }
}
