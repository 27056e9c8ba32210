//! A picture of the card's packet-writable registers, word for word.

use zga_abi::packet::Opcode;
use zga_abi::register::Access;
use zga_abi::registers::{REGISTERS, Reg};

use super::packets::packets;

/// First byte beyond the registers that packets can write.
const END: u32 = 0x0700;
/// Ranges that packets can write: WATCHDOG and SCRATCH, then target to scan-out.
const RANGES: [std::ops::Range<u32>; 2] = [0x0048..0x0050, 0x0200..END];
/// At most so many unchanged words are sent again rather than beginning a new packet (header and offset).
const BRIDGE: usize = 2;

/// Values of the registers in the ranges that packets can write, beginning with their reset values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RegisterImage {
    words: Vec<u32>,
}

impl RegisterImage {
    /// All reset values.
    pub fn reset() -> RegisterImage {
        let mut words = vec![0; (END / 4) as usize];
        for register in REGISTERS.iter().filter(|register| register.offset < END) {
            for index in 0..register.count {
                words[(register.word_offset(index) / 4) as usize] = register.reset_value(index);
            }
        }
        RegisterImage { words }
    }

    /// The word at byte `offset`; 0 outside.
    pub fn get(&self, offset: u32) -> u32 {
        self.words.get((offset / 4) as usize).copied().unwrap_or(0)
    }

    /// Sets the word at byte `offset`; outside nothing happens. Bits that the register has not stay.
    pub fn set(&mut self, offset: u32, value: u32) {
        if let Some((register, _)) = Reg::at(offset)
            && register.info().access == Access::ReadWrite
            && let Some(word) = self.words.get_mut((offset / 4) as usize)
        {
            let writable = register.info().writable;
            *word = (*word & !writable) | (value & writable);
        }
    }

    /// Follows what packets do to the registers.
    pub fn follow(&mut self, words: &[u32]) {
        for packet in packets(words) {
            match (packet.opcode(), packet.words) {
                (Some(Opcode::RegisterWrite), [_, offset, values @ ..]) => {
                    for (value, at) in values.iter().zip((*offset..).step_by(4)) {
                        self.set(at, *value);
                    }
                }
                (Some(Opcode::Present), [_, base, ..]) => self.set(Reg::ScanoutBase.offset(), *base),
                _ => {}
            }
        }
    }

    /// Byte offsets and values of all words that are not at their reset value.
    pub fn changed(&self) -> Vec<(u32, u32)> {
        let reset = RegisterImage::reset();
        let offsets = (0..END).step_by(4);
        offsets
            .zip(self.words.iter().zip(&reset.words))
            .filter(|(offset, (now, then))| now != then && RANGES.iter().any(|range| range.contains(offset)))
            .map(|(offset, (now, _))| (offset, *now))
            .collect()
    }
}

/// What the driver wants in the registers, and what it has sent: only the difference travels.
#[derive(Clone, Debug)]
pub(crate) struct RegisterState {
    wanted: RegisterImage,
    sent: RegisterImage,
    /// Words that packets may write.
    writable: Vec<bool>,
    /// First and last word that can differ; empty if first > last.
    dirty: (usize, usize),
}

impl RegisterState {
    /// Everything as after a reset.
    pub fn new() -> RegisterState {
        let writable = (0..END)
            .step_by(4)
            .map(|offset| {
                RANGES.iter().any(|range| range.contains(&offset))
                    && Reg::at(offset).is_some_and(|(register, _)| register.info().access == Access::ReadWrite)
            })
            .collect();
        let image = RegisterImage::reset();
        RegisterState { wanted: image.clone(), sent: image, writable, dirty: (usize::MAX, 0) }
    }

    /// Wants `values` from word 0 of `register` on.
    pub fn want(&mut self, register: Reg, values: &[u32]) {
        let first = (register.offset() / 4) as usize;
        for (index, &value) in (first..).zip(values) {
            if self.wanted.words.get(index) != Some(&value) {
                self.wanted.set(4 * index as u32, value);
                self.dirty = (self.dirty.0.min(index), self.dirty.1.max(index));
            }
        }
    }

    /// What is wanted in the first word of `register`.
    pub fn wanted(&self, register: Reg) -> u32 {
        self.wanted.get(register.offset())
    }

    /// Begins again from what the registers hold (or will hold).
    pub fn adopt(&mut self, image: RegisterImage) {
        self.sent = image.clone();
        self.wanted = image;
        self.dirty = (usize::MAX, 0);
    }

    /// Takes note of packets that somebody else encoded.
    pub fn follow(&mut self, words: &[u32]) {
        self.wanted.follow(words);
        self.sent.follow(words);
    }

    /// The payload (offset, values) of the next register write that is due, noted as sent.
    pub fn next_write(&mut self, payload: &mut Vec<u32>) -> bool {
        payload.clear();
        let differs = |state: &RegisterState, index: usize| state.wanted.words[index] != state.sent.words[index];
        let (low, high) = self.dirty;
        let Some(first) = (low..=high).find(|&index| self.writable[index] && differs(self, index)) else {
            self.dirty = (usize::MAX, 0);
            return false;
        };
        let mut last = first;
        for index in first + 1..=high {
            if index - last > BRIDGE + 1 || !self.writable[index] {
                break;
            }
            if differs(self, index) {
                last = index;
            }
        }
        payload.push(4 * first as u32);
        payload.extend_from_slice(&self.wanted.words[first..=last]);
        self.sent.words[first..=last].copy_from_slice(&self.wanted.words[first..=last]);
        self.dirty.0 = last + 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn writes(state: &mut RegisterState) -> Vec<Vec<u32>> {
        let mut payload = Vec::new();
        std::iter::from_fn(|| state.next_write(&mut payload).then(|| payload.clone())).collect()
    }

    #[test]
    fn next_write_nothing_changed_sends_nothing() {
        let mut state = RegisterState::new();
        state.want(Reg::Effects, &[1]);
        assert!(writes(&mut state).is_empty());
    }

    #[test]
    fn next_write_neighbours_share_a_packet() {
        let mut state = RegisterState::new();
        state.want(Reg::Effects, &[3]);
        state.want(Reg::ObjectTag, &[7]);
        assert_eq!(writes(&mut state), [vec![0x280, 3, 0x101, 0xFFFF_FFFF, 7]]);
        assert!(writes(&mut state).is_empty());
    }

    #[test]
    fn next_write_far_apart_or_across_a_hole_begins_a_new_packet() {
        let mut state = RegisterState::new();
        state.want(Reg::Effects, &[3]);
        state.want(Reg::ScissorMaximum, &[0x0010_0010]);
        state.want(Reg::Viewport, &[0]);
        assert_eq!(writes(&mut state), [vec![0x280, 3], vec![0x294, 0x0010_0010], vec![0x4C0, 0]]);
    }

    #[test]
    fn follow_register_write_and_present_are_noted() {
        let mut image = RegisterImage::reset();
        image.follow(&[0x0100_0003, 0x288, 1, 2, 0x3100_0001, 0x40]);
        assert_eq!(image.changed(), [(0x288, 1), (0x28C, 2), (0x688, 0x40)]);
    }

    #[test]
    fn set_masks_bits_that_the_register_has_not() {
        let mut image = RegisterImage::reset();
        image.set(0x204, 0x1234_5678);
        assert_eq!(image.get(0x204), 0x1234_5640);
    }
}
