//! Register file: one word of storage for each register word of [`zga_abi::registers`].
//!
//! Duties: reset values, writable masks, saturating error counts.
//! Inputs: host writes, REGISTER_WRITE packets, results of the units. Outputs: values, to everybody.
//! Clocks: none beside those of the packet that writes.
//!
//! Each word is atomic, so host and card need no lock. A writer stores with release and a reader
//! loads with acquire: who sees a result also sees what was stored before it. Registers whose value
//! lives elsewhere (STATUS, ring pointers, interrupts) have a word here that nobody uses.

use std::sync::atomic::{AtomicU32, Ordering};
use zga_abi::registers::REGISTERS;
use zga_abi::{Access, Reg};

/// Registers below this offset identify the card and survive a reset.
const IDENTIFICATION_END: u32 = 0x40;

/// All register words.
#[derive(Debug)]
pub(crate) struct RegisterFile {
    words: Box<[AtomicU32]>,
}

impl RegisterFile {
    /// Registers at their reset values.
    pub(crate) fn new() -> RegisterFile {
        let end = REGISTERS.iter().map(|r| r.word_offset(r.count)).max().unwrap_or(0);
        let file = RegisterFile { words: (0..end / 4).map(|_| AtomicU32::new(0)).collect() };
        file.load_reset_values(0);
        file
    }

    /// Sets all registers but the identification block to their reset values.
    pub(crate) fn reset(&self) {
        self.load_reset_values(IDENTIFICATION_END);
    }

    fn load_reset_values(&self, from: u32) {
        for (&reg, info) in Reg::ALL.iter().zip(REGISTERS).filter(|(reg, _)| reg.offset() >= from) {
            for word in 0..info.count {
                self.set_word(reg, word, info.reset_value(word));
            }
        }
    }

    fn cell(&self, reg: Reg, word: u32) -> &AtomicU32 {
        // The file has a word for every declared register, and `word` comes from a decoded access.
        &self.words[(reg.offset() / 4 + word) as usize]
    }

    /// Value of a one-word register.
    pub(crate) fn get(&self, reg: Reg) -> u32 {
        self.word(reg, 0)
    }

    /// Value of word `word` of a register.
    pub(crate) fn word(&self, reg: Reg, word: u32) -> u32 {
        self.cell(reg, word).load(Ordering::Acquire)
    }

    /// Sets a one-word register.
    pub(crate) fn set(&self, reg: Reg, value: u32) {
        self.set_word(reg, 0, value);
    }

    /// Sets word `word` of a register.
    pub(crate) fn set_word(&self, reg: Reg, word: u32, value: u32) {
        self.cell(reg, word).store(value, Ordering::Release);
    }

    /// A host's write: bits outside the writable mask keep their value.
    pub(crate) fn write(&self, reg: Reg, word: u32, value: u32) {
        let mask = reg.info().writable;
        self.put(reg, word, (self.word(reg, word) & !mask) | (value & mask));
    }

    /// A new value by host or packet, masks applied; enabling the probe starts its count.
    pub(crate) fn put(&self, reg: Reg, word: u32, value: u32) {
        if reg == Reg::ProbeControl && value & !self.word(reg, word) & 1 != 0 {
            self.set(Reg::ProbeCount, 0);
        }
        self.set_word(reg, word, value);
    }

    /// Adds to a register that saturates.
    pub(crate) fn count(&self, reg: Reg, events: usize) {
        let events = u32::try_from(events).unwrap_or(u32::MAX);
        let add = |value: u32| Some(value.saturating_add(events));
        // PANIC: none; the closure always gives a value, so both outcomes hold the old count.
        let _ = self.cell(reg, 0).fetch_update(Ordering::AcqRel, Ordering::Acquire, add);
    }

    /// Counts `accesses` that the bus refused, the last of them at `address`.
    pub(crate) fn count_fault(&self, reg: Reg, address: u32, accesses: usize) {
        self.set(Reg::BusFaultAddress, address);
        self.count(reg, accesses);
    }

    /// `N` words of a register as numbers.
    pub(crate) fn floats<const N: usize>(&self, reg: Reg) -> [f32; N] {
        let mut values = [0.0; N];
        for (word, value) in (0..reg.info().count).zip(&mut values) {
            *value = f32::from_bits(self.word(reg, word));
        }
        values
    }

    /// All words, for a snapshot.
    pub(crate) fn save(&self) -> Vec<u32> {
        self.words.iter().map(|word| word.load(Ordering::Acquire)).collect()
    }

    /// Sets all registers but the identification block from a snapshot. Bits that no write could
    /// have set keep their reset value; missing words do too.
    pub(crate) fn load(&self, words: &[u32]) {
        for (&reg, info) in Reg::ALL.iter().zip(REGISTERS).filter(|(reg, _)| reg.offset() >= IDENTIFICATION_END) {
            for word in 0..info.count {
                let reset = info.reset_value(word);
                let saved = words.get((info.word_offset(word) / 4) as usize).copied().unwrap_or(reset);
                let value = match info.access {
                    Access::ReadWrite => (reset & !info.writable) | (saved & info.writable),
                    Access::ReadOnly => saved,
                    Access::WriteOnly | Access::WriteOneToClear => reset,
                };
                self.set_word(reg, word, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn count_near_the_end_saturates() {
        let file = RegisterFile::new();
        file.set(Reg::BusRejected, u32::MAX - 1);
        file.count(Reg::BusRejected, 5);
        assert_eq!(file.get(Reg::BusRejected), u32::MAX);
    }

    #[test]
    fn load_bits_outside_the_masks_are_ignored() {
        let file = RegisterFile::new();
        let mut words = file.save();
        words.fill(u32::MAX);
        file.load(&words);
        assert_eq!(file.get(Reg::Identification), 0x5A47_4131);
        assert_eq!(file.get(Reg::ColourPitch), 0x000F_FFC0);
        assert_eq!(file.get(Reg::FrameCount), u32::MAX);
        file.load(&[]);
        assert_eq!(file.get(Reg::DepthFormat), 0x0000_1818);
    }
}
