//! A card made of registers and memory only, for tests of drivers: it takes packets, draws nothing.
//!
//! Registers have the access rules, masks and reset values of their declarations. Packets from ring and
//! FIFO are kept for inspection; register writes, presents and fences take effect, everything else is
//! only counted. The model checks no more than packet lengths: what a card refuses is scripted with
//! [`MockBus::refuse_packet`].

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use zga_abi::bus::{
    Bus, FIFO_BASE, FIFO_BYTES, FIFO_WORDS, FLOATING, INTERRUPT_ERROR, INTERRUPT_FENCE, INTERRUPT_VERTICAL_BLANK,
    MEMORY_BASE,
};
use zga_abi::packet::{Opcode, header, payload_words};
use zga_abi::register::Access;
use zga_abi::registers::{REGISTERS, Reg};
use zga_abi::{Effects, Fault, FaultCode};

/// When the model executes packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pace {
    /// As soon as they arrive.
    #[default]
    AtOnce,
    /// Up to the next fence whenever somebody waits for an interrupt.
    AFenceAWait,
    /// Not at all: every wait times out at once.
    Never,
}

/// One access that the model saw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MockAccess {
    /// A word was read at this address.
    Read(u32),
    /// A word was written: address, value.
    Write(u32, u32),
    /// A burst was read: address, words.
    ReadBurst(u32, usize),
    /// A burst was written: address, words.
    WriteBurst(u32, usize),
    /// Somebody waited for interrupts in this mask.
    Wait(u32),
}

/// The model. Registers that a test wants to see otherwise are set with [`MockBus::set_register`].
#[derive(Debug)]
pub struct MockBus {
    registers: BTreeMap<u32, u32>,
    memory: Vec<u32>,
    fifo: VecDeque<u32>,
    fifo_taken: u32,
    pace: Pace,
    refuse: BTreeMap<usize, Fault>,
    stuck_lines: u32,
    packets: Vec<Vec<u32>>,
    /// Packets met since power-on, refused ones included.
    met: usize,
    accesses: Vec<MockAccess>,
}

impl MockBus {
    /// A model with `memory_bytes` bytes of video memory (a multiple of 4) and the plain Z buffer.
    #[must_use]
    pub fn new(memory_bytes: u32) -> MockBus {
        let mut bus = MockBus {
            registers: BTreeMap::new(),
            memory: vec![0; (memory_bytes / 4) as usize],
            fifo: VecDeque::new(),
            fifo_taken: 0,
            pace: Pace::AtOnce,
            refuse: BTreeMap::new(),
            stuck_lines: 0,
            packets: Vec::new(),
            met: 0,
            accesses: Vec::new(),
        };
        bus.reset();
        let effects = Effects::DEPTH | Effects::GOURAUD | Effects::PERSPECTIVE | Effects::DECAL;
        bus.set_register(Reg::CapabilityEffects, effects.bits());
        bus.set_register(Reg::CapabilityPaths, 1);
        bus.set_register(Reg::VideoMemorySize, memory_bytes / 4 * 4);
        bus
    }

    /// Sets the first word of a register, past all access rules.
    pub fn set_register(&mut self, register: Reg, value: u32) {
        self.registers.insert(register.offset(), value);
    }

    /// The word at byte `offset` of the register aperture, without side effects.
    #[must_use]
    pub fn register(&self, offset: u32) -> u32 {
        self.registers.get(&offset).copied().unwrap_or(0)
    }

    /// Video memory.
    #[must_use]
    pub fn memory(&self) -> &[u32] {
        &self.memory
    }

    /// When packets are executed from here on.
    pub fn set_pace(&mut self, pace: Pace) {
        self.pace = pace;
    }

    /// Refuses packet number `number` (counted from 0 since power-on, refused ones included) with `fault`.
    pub fn refuse_packet(&mut self, number: usize, fault: Fault) {
        self.refuse.insert(number, fault);
    }

    /// Interrupt lines that look pending whatever is acknowledged.
    pub fn set_stuck_lines(&mut self, lines: u32) {
        self.stuck_lines = lines;
    }

    /// Packets met since power-on, refused ones included: the number of the next one.
    #[must_use]
    pub const fn packets_met(&self) -> usize {
        self.met
    }

    /// Takes the packets executed since the last call, headers included.
    pub fn take_packets(&mut self) -> Vec<Vec<u32>> {
        std::mem::take(&mut self.packets)
    }

    /// Takes the accesses seen since the last call.
    pub fn take_accesses(&mut self) -> Vec<MockAccess> {
        std::mem::take(&mut self.accesses)
    }

    fn reset(&mut self) {
        let keep =
            [Reg::CapabilityEffects, Reg::CapabilityPaths, Reg::VideoMemorySize, Reg::ZaRamSize].map(Reg::offset);
        self.registers.retain(|offset, _| keep.contains(offset));
        for register in REGISTERS.iter().filter(|register| !keep.contains(&register.offset)) {
            for index in 0..register.count {
                self.registers.insert(register.word_offset(index), register.reset_value(index));
            }
        }
        self.fifo.clear();
        self.fifo_taken = 0;
    }

    fn get(&self, register: Reg) -> u32 {
        self.register(register.offset())
    }

    fn raise(&mut self, line: u32) {
        self.set_register(Reg::InterruptStatus, self.get(Reg::InterruptStatus) | line);
    }

    fn count(&mut self, register: Reg, address: u32) {
        self.set_register(register, self.get(register).saturating_add(1));
        self.set_register(Reg::BusFaultAddress, address);
    }

    fn write_register(&mut self, address: u32, value: u32) {
        let Some((register, _)) = Reg::at(address) else { return self.count(Reg::BusUnmapped, address) };
        let info = register.info();
        match info.access {
            Access::ReadOnly => self.count(Reg::BusReadOnly, address),
            Access::ReadWrite => {
                let old = self.register(address);
                self.registers.insert(address, (old & !info.writable) | (value & info.writable));
            }
            Access::WriteOneToClear => {
                let old = self.register(address);
                self.registers.insert(address, old & !(value & info.write_one_to_clear));
            }
            Access::WriteOnly => {}
        }
        match register {
            Reg::Reset if value & 1 == 1 => self.reset(),
            Reg::RingBase | Reg::RingSize => {
                self.set_register(Reg::RingGet, 0);
                self.set_register(Reg::RingPut, 0);
            }
            Reg::Doorbell if self.pace == Pace::AtOnce => self.run(false),
            _ => {}
        }
    }

    fn write_word(&mut self, address: u32, value: u32) {
        if !address.is_multiple_of(4) {
            self.count(Reg::BusMisaligned, address);
        } else if (FIFO_BASE..FIFO_BASE + FIFO_BYTES).contains(&address) {
            if self.get(Reg::Status) & 4 != 0 {
                self.set_register(Reg::BusRejected, self.get(Reg::BusRejected).saturating_add(1));
            } else {
                self.fifo.push_back(value);
                if self.pace == Pace::AtOnce || self.fifo.len() >= FIFO_WORDS as usize {
                    self.run(false);
                }
            }
        } else if let Some(word) = self.memory_word(address) {
            self.memory[word] = value;
        } else {
            self.write_register(address, value);
        }
    }

    fn read_word(&mut self, address: u32) -> u32 {
        if !address.is_multiple_of(4) {
            self.count(Reg::BusMisaligned, address);
            return FLOATING;
        }
        if let Some(word) = self.memory_word(address) {
            return self.memory[word];
        }
        match Reg::at(address) {
            Some((register, _)) if register.info().access == Access::WriteOnly => 0,
            Some(_) => self.register(address),
            None => {
                self.count(Reg::BusUnmapped, address);
                FLOATING
            }
        }
    }

    fn memory_word(&self, address: u32) -> Option<usize> {
        let word = (address.checked_sub(MEMORY_BASE)? / 4) as usize;
        (word < self.memory.len()).then_some(word)
    }

    /// Executes packets of ring and FIFO; up to the first fence if `one_fence`.
    fn run(&mut self, one_fence: bool) {
        while self.step_ring() || self.step_fifo() {
            let fence = self.packets.last().is_some_and(|packet| packet[0] == header(Opcode::Fence, 1));
            if one_fence && fence {
                break;
            }
        }
    }

    fn step_ring(&mut self) -> bool {
        let (get, put, size) = (self.get(Reg::RingGet), self.get(Reg::RingPut), self.get(Reg::RingSize));
        if get == put || size == 0 || self.get(Reg::Status) & 2 != 0 {
            return false;
        }
        let base = self.get(Reg::RingBase) / 4;
        let at = |word: u32| self.memory.get((base + word % size) as usize).copied().unwrap_or(FLOATING);
        let length = 1 + payload_words(at(get));
        let packet: Vec<u32> = (get..get + length).map(at).collect();
        if length > put.wrapping_sub(get) % size {
            self.halt(&packet, Fault::new(FaultCode::Truncated, 0, packet[0]), 1, get);
        } else if self.execute(packet, 1, get) {
            self.set_register(Reg::RingGet, (get + length) % size);
        }
        true
    }

    fn step_fifo(&mut self) -> bool {
        let Some(&first) = self.fifo.front() else { return false };
        let length = 1 + payload_words(first) as usize;
        if self.fifo.len() < length || self.get(Reg::Status) & 4 != 0 {
            return false;
        }
        let packet: Vec<u32> = self.fifo.drain(..length).collect();
        if self.execute(packet, 2, self.fifo_taken) {
            self.fifo_taken = self.fifo_taken.wrapping_add(length as u32);
        }
        true
    }

    /// Executes a packet; false if it was refused.
    fn execute(&mut self, packet: Vec<u32>, source: u32, offset: u32) -> bool {
        let number = self.met;
        self.met += 1;
        if let Some(fault) = self.refuse.remove(&number) {
            self.halt(&packet, fault, source, offset);
            return false;
        }
        match (Opcode::from_code(packet[0] >> 24), &packet[1..]) {
            (Some(Opcode::RegisterWrite), [offset, values @ ..]) => {
                for (value, at) in values.iter().copied().zip((*offset..).step_by(4)) {
                    self.write_register(at, value);
                }
            }
            (Some(Opcode::Present), [base, ..]) => {
                self.set_register(Reg::ScanoutBase, *base);
                self.set_register(Reg::FrameCount, self.get(Reg::FrameCount).wrapping_add(1));
                self.raise(INTERRUPT_VERTICAL_BLANK);
            }
            (Some(Opcode::Fence), [sequence, ..]) => {
                self.set_register(Reg::FenceSequence, *sequence);
                self.raise(INTERRUPT_FENCE);
            }
            _ => {}
        }
        self.packets.push(packet);
        true
    }

    fn halt(&mut self, packet: &[u32], fault: Fault, source: u32, offset: u32) {
        let words = [fault.code as u32, source, offset, packet[0], fault.word, fault.value];
        for (word, at) in words.into_iter().zip((Reg::ErrorCode.offset()..).step_by(4)) {
            self.registers.insert(at, word);
        }
        self.set_register(Reg::Status, self.get(Reg::Status) | if source == 1 { 2 } else { 4 });
        self.raise(INTERRUPT_ERROR);
    }
}

impl Bus for MockBus {
    fn read32(&mut self, address: u32) -> u32 {
        self.accesses.push(MockAccess::Read(address));
        self.read_word(address)
    }

    fn write32(&mut self, address: u32, value: u32) {
        self.accesses.push(MockAccess::Write(address, value));
        self.write_word(address, value);
    }

    fn read_burst(&mut self, address: u32, words: &mut [u32]) {
        self.accesses.push(MockAccess::ReadBurst(address, words.len()));
        for (word, at) in words.iter_mut().zip((address..).step_by(4)) {
            *word = self.read_word(at);
        }
    }

    fn write_burst(&mut self, address: u32, words: &[u32]) {
        self.accesses.push(MockAccess::WriteBurst(address, words.len()));
        let step = if (FIFO_BASE..FIFO_BASE + FIFO_BYTES).contains(&address) { 0 } else { 4 };
        let mut at = address;
        for &word in words {
            self.write_word(at, word);
            at = at.wrapping_add(step);
        }
    }

    /// Never blocks: what is not pending when the packets are executed does not come.
    fn wait_interrupt(&mut self, mask: u32, _timeout: Duration) -> u32 {
        self.accesses.push(MockAccess::Wait(mask));
        let pending = |bus: &MockBus| bus.get(Reg::InterruptStatus) & bus.get(Reg::InterruptEnable) & mask;
        if self.pace == Pace::AFenceAWait && pending(self) == 0 {
            self.run(true);
        }
        pending(self) | self.stuck_lines & mask
    }
}
