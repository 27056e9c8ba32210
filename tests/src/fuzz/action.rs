//! Actions on the bus, and how bytes become them.
//!
//! The list of a run is made before the card is touched and does not depend on what the card does,
//! so a failure can be repeated, printed and cut down.

use super::bytes::Bytes;
use super::packets::Composer;
use zga_abi::Reg;
use zga_abi::bus::{FIFO_BASE, FIFO_BYTES, MEMORY_BASE, REGISTERS_BYTES, ZA_BASE};
use zga_abi::registers::REGISTERS;

/// Most actions of a run.
const MOST_ACTIONS: usize = 400;
/// Most words of one raw burst.
const MOST_BURST: u32 = 96;

/// One thing a host does to a card.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Action {
    /// Reads `words` words from byte `address` on.
    Read {
        /// Byte address, aligned or not.
        address: u32,
        /// Words.
        words: u32,
    },
    /// Writes words from byte `address` on.
    Write {
        /// Byte address, aligned or not.
        address: u32,
        /// The words.
        words: Vec<u32>,
    },
    /// Pushes words into the FIFO.
    Fifo(Vec<u32>),
    /// Puts words into the command ring.
    Ring {
        /// A new ring: RING_BASE and RING_SIZE; else the one there is goes on.
        start: Option<[u32; 2]>,
        /// The words, behind those that are there.
        words: Vec<u32>,
        /// RING_PUT; else the end of the words.
        put: Option<u32>,
        /// The doorbell is rung.
        doorbell: bool,
    },
    /// Soft reset.
    Reset,
    /// Takes a snapshot and keeps it.
    Save,
    /// Restores the snapshot that was kept, with words of its card section changed.
    Restore {
        /// Word of the section, and its value.
        changes: Vec<(u32, u32)>,
        /// The checksum is made to agree with the changes.
        sealed: bool,
    },
    /// Waits for interrupts.
    Wait {
        /// Lines.
        mask: u32,
        /// Longest wait.
        microseconds: u32,
    },
    /// Plugs a monitor in, or pulls it out.
    Monitor(bool),
    /// Waits until the card has nothing to do.
    Settle,
}

impl Action {
    /// Bus words that the action moves.
    #[must_use]
    pub fn words(&self) -> u64 {
        match self {
            Action::Read { words, .. } => u64::from(*words),
            Action::Write { words, .. } | Action::Fifo(words) => words.len() as u64,
            Action::Ring { start, words, doorbell, .. } => {
                words.len() as u64 + 2 * u64::from(start.is_some()) + u64::from(*doorbell) + 1
            }
            Action::Reset => 1,
            _ => 0,
        }
    }
}

/// What kind of words a run is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The first byte says.
    #[default]
    Any,
    /// Words without a plan.
    Raw,
    /// Packets that are valid but for a few words.
    Structured,
}

/// The actions that `bytes` stand for, on a card with `memory` bytes of video memory and `za` of Za RAM.
#[must_use]
pub fn decode(bytes: &[u8], mode: Mode, memory: u32, za: u32) -> Vec<Action> {
    let mut bytes = Bytes::new(bytes);
    let first = bytes.byte();
    let structured = match mode {
        Mode::Any => first & 1 == 1,
        Mode::Raw => false,
        Mode::Structured => true,
    };
    let mut decoder = Decoder { bytes, memory, za, actions: Vec::new() };
    while !decoder.bytes.is_empty() && decoder.actions.len() < MOST_ACTIONS {
        if structured { decoder.structured() } else { decoder.raw() }
    }
    decoder.actions
}

struct Decoder<'a> {
    bytes: Bytes<'a>,
    memory: u32,
    za: u32,
    actions: Vec<Action>,
}

impl Decoder<'_> {
    /// A plan: one scene, or packets without one, through FIFO or ring; seldom something between.
    fn structured(&mut self) {
        if self.bytes.chance(24) {
            self.raw();
        }
        let mut composer = Composer::new(&mut self.bytes, self.memory);
        let scene = composer.scene();
        let mut words: Vec<u32> = scene.packets.concat();
        let ring = self.bytes.chance(90);
        if ring {
            let start = self.bytes.chance(180).then(|| self.ring_place());
            let room = start.map_or(255, |[_, size]| size.clamp(256, 8192) as usize - 1);
            // A ring that is too small gets the packets that fit.
            let mut end = 0;
            let fit = scene.packets.iter().take_while(|packet| {
                end += packet.len();
                end <= room
            });
            words = fit.flatten().copied().collect();
            let put = self.bytes.chance(8).then(|| self.bytes.word());
            let doorbell = !self.bytes.chance(8);
            self.actions.push(Action::Ring { start, words, put, doorbell });
        } else if self.bytes.chance(40) {
            let cut = self.bytes.below(words.len() as u32) as usize;
            let rest = words.split_off(cut);
            self.actions.push(Action::Fifo(words));
            self.between();
            self.actions.push(Action::Fifo(rest));
        } else {
            self.actions.push(Action::Fifo(words));
        }
        // A refused packet halts its source: a host that notices resets.
        if scene.mutated && self.bytes.chance(220) {
            self.actions.push(Action::Reset);
        } else if self.bytes.chance(24) {
            self.between();
        }
    }

    /// Something in the middle of a packet stream.
    fn between(&mut self) {
        match self.bytes.byte() % 8 {
            0 => self.actions.push(Action::Save),
            1 | 2 => self.restore(),
            3 => self.actions.push(Action::Settle),
            4 => self.actions.push(Action::Reset),
            5 => {
                let plugged = self.bytes.chance(160);
                self.actions.push(Action::Monitor(plugged));
            }
            _ => self.raw(),
        }
    }

    /// One action without a plan.
    fn raw(&mut self) {
        let action = match self.bytes.byte() % 32 {
            0..=2 => Action::Read { address: self.address(), words: 1 },
            3 | 4 => Action::Read { address: self.address(), words: self.bytes.below(MOST_BURST) },
            5..=8 => Action::Write { address: self.address(), words: vec![self.bytes.word()] },
            9..=12 => Action::Write { address: self.address(), words: self.raw_words() },
            13..=20 => Action::Fifo(self.raw_words()),
            21..=25 => Action::Ring {
                start: self.bytes.chance(128).then(|| self.ring_place()),
                words: self.raw_words(),
                put: self.bytes.chance(64).then(|| self.bytes.word()),
                doorbell: !self.bytes.chance(32),
            },
            26 => Action::Save,
            27 => return self.restore(),
            28 => Action::Wait { mask: self.bytes.word(), microseconds: self.bytes.below(200) },
            29 => Action::Monitor(self.bytes.chance(160)),
            _ => Action::Reset,
        };
        self.actions.push(action);
    }

    fn restore(&mut self) {
        let count = self.bytes.below(6).saturating_sub(2);
        // Half of them where the card's own state stands, the others in the register file and behind it.
        let place = |bytes: &mut Bytes<'_>| if bytes.chance(128) { bytes.below(40) } else { bytes.below(700) };
        let changes = (0..count).map(|_| (place(&mut self.bytes), self.bytes.word())).collect();
        let sealed = !self.bytes.chance(32);
        self.actions.push(Action::Restore { changes, sealed });
    }

    /// Words that are sometimes headers, sometimes anything.
    fn raw_words(&mut self) -> Vec<u32> {
        let count = self.bytes.below(MOST_BURST);
        let headers = self.bytes.chance(160);
        let mut words = Vec::new();
        while words.len() < count as usize && !self.bytes.is_empty() {
            if headers && self.bytes.chance(128) {
                words.extend(Composer::new(&mut self.bytes, self.memory).loose());
            } else {
                words.push(self.bytes.word());
            }
        }
        words
    }

    /// Base and size of a ring, most of them possible.
    fn ring_place(&mut self) -> [u32; 2] {
        let size = if self.bytes.chance(24) { self.bytes.word() } else { 256 << self.bytes.below(6) };
        let pages = self.memory.saturating_sub(size.saturating_mul(4)) / 4096;
        let base = if self.bytes.chance(16) { self.bytes.word() } else { 4096 * self.bytes.below(pages.max(1)) };
        [base, size]
    }

    /// An address: a register, an edge of a window, or anything.
    fn address(&mut self) -> u32 {
        let aligned = match self.bytes.byte() % 16 {
            0..=5 => {
                let register = &REGISTERS[self.bytes.below(REGISTERS.len() as u32) as usize];
                register.word_offset(self.bytes.below(register.count))
            }
            6 => 4 * self.bytes.below(REGISTERS_BYTES / 4),
            7 => FIFO_BASE + 4 * self.bytes.below(FIFO_BYTES / 4),
            8..=10 => MEMORY_BASE + 4 * self.bytes.below(self.memory / 4),
            11 => MEMORY_BASE.wrapping_add(self.memory).wrapping_sub(4 * self.bytes.below(32)),
            12 => ZA_BASE + 4 * self.bytes.below((self.za / 4).max(1)),
            13 => ZA_BASE.wrapping_add(self.za).wrapping_sub(4 * self.bytes.below(32)),
            14 => self.bytes.word(),
            _ => self.bytes.raw(),
        };
        if self.bytes.chance(12) { aligned.wrapping_add(self.bytes.below(4)) } else { aligned }
    }
}

/// Does a write of `words` words from byte `address` on reach `register`?
#[must_use]
pub fn reaches(address: u32, words: usize, register: Reg) -> bool {
    let from = u64::from(address);
    address.is_multiple_of(4) && (from..from + 4 * words as u64).contains(&u64::from(register.offset()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decode_any_bytes_come_to_an_end() {
        for seed in 0..=255_u8 {
            let bytes: Vec<u8> = (0..600_u32).map(|k| (k as u8).wrapping_mul(seed) ^ seed).collect();
            let actions = decode(&bytes, Mode::Any, 1 << 20, 1 << 16);
            assert!(actions.len() <= MOST_ACTIONS + 4);
            assert_eq!(actions, decode(&bytes, Mode::Any, 1 << 20, 1 << 16));
        }
        assert_eq!(decode(&[], Mode::Structured, 1 << 20, 0), []);
    }

    #[test]
    fn reaches_word_in_the_middle_of_a_burst() {
        assert!(reaches(0x100, 3, Reg::RingPut));
        assert!(!reaches(0x100, 2, Reg::RingPut));
        assert!(!reaches(0x106, 3, Reg::RingPut));
    }
}
