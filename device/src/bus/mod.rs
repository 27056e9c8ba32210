//! Bus interface: the card's edge connector.
//!
//! Duties: decodes addresses, carries single accesses and bursts, counts what nothing answers to.
//! Inputs: [`zga_abi::Bus`] calls of any number of host threads.
//! Outputs: register file, FIFO, Za RAM, video memory, interrupts.
//! Clocks: none; bus cycles are the host's time, not device time.
//!
//! No access fails and none panics: reads where nothing answers return all ones, and every word
//! that went nowhere is counted in BUS_UNMAPPED, BUS_READ_ONLY or BUS_MISALIGNED.

pub(crate) mod address;
pub(crate) mod backplane;
pub(crate) mod interrupts;
mod registers;

use address::{Aperture, decode};
use backplane::Backplane;
use std::sync::Arc;
use std::time::Duration;
use zga_abi::Reg;
use zga_abi::bus::{Bus, FIFO_BASE, FIFO_BYTES, FLOATING};

/// A host's connection to a card; clones reach the same card and can be used by other threads.
///
/// Accesses of one clone are in program order. Once the card has lost its power, reads return all
/// ones, writes go nowhere and waits return at once.
#[derive(Clone, Debug)]
pub struct CardBus {
    backplane: Arc<Backplane>,
}

impl CardBus {
    /// A connection to the card on `backplane`.
    pub(crate) fn new(backplane: Arc<Backplane>) -> CardBus {
        CardBus { backplane }
    }

    /// Counts `words` accesses from byte `address` upward that nothing answered.
    fn unmapped(&self, address: u32, words: usize) {
        let last = address.wrapping_add(4 * (words as u32).wrapping_sub(1));
        self.backplane.registers.count_fault(Reg::BusUnmapped, last, words);
    }

    /// Is the card there and `address` aligned? Counts `words` accesses if it is not aligned.
    fn answers(&self, address: u32, words: usize) -> bool {
        if !self.backplane.has_power() || words == 0 {
            return false;
        }
        let aligned = address.is_multiple_of(4);
        if !aligned {
            let last = address.wrapping_add(4 * (words as u32).wrapping_sub(1));
            self.backplane.registers.count_fault(Reg::BusMisaligned, last, words);
        }
        aligned
    }
}

impl Bus for CardBus {
    fn read32(&mut self, address: u32) -> u32 {
        let mut word = [FLOATING];
        self.read_burst(address, &mut word);
        word[0]
    }

    fn write32(&mut self, address: u32, value: u32) {
        self.write_burst(address, &[value]);
    }

    fn read_burst(&mut self, address: u32, words: &mut [u32]) {
        if !self.answers(address, words.len()) {
            words.fill(FLOATING);
            return;
        }
        let (mut at, mut rest) = (address, words);
        while !rest.is_empty() {
            let (aperture, reach) = decode(at);
            let count = match aperture {
                Aperture::Memory(_) | Aperture::Za(_) => reach.min(rest.len()),
                _ => 1,
            };
            let (part, after) = std::mem::take(&mut rest).split_at_mut(count);
            let answered = match aperture {
                Aperture::Registers(offset) => {
                    part.fill(self.backplane.read_register(offset));
                    count
                }
                Aperture::Memory(index) => self.backplane.memory.lock().read(index, part),
                Aperture::Za(index) => self.backplane.memory.lock().za().read(index, part),
                Aperture::Fifo | Aperture::Nothing => 0,
            };
            if answered < count {
                part[answered..].fill(FLOATING);
                self.unmapped(at.wrapping_add(4 * answered as u32), count - answered);
            }
            (at, rest) = (at.wrapping_add(4 * count as u32), after);
        }
    }

    fn write_burst(&mut self, address: u32, words: &[u32]) {
        if !self.answers(address, words.len()) {
            return;
        }
        if (FIFO_BASE..FIFO_BASE + FIFO_BYTES).contains(&address) {
            self.backplane.fifo.push(words, &self.backplane);
            return;
        }
        let (mut at, mut rest) = (address, words);
        while !rest.is_empty() {
            let (aperture, reach) = decode(at);
            let count = match aperture {
                Aperture::Memory(_) | Aperture::Za(_) | Aperture::Fifo => reach.min(rest.len()),
                _ => 1,
            };
            let (part, after) = rest.split_at(count);
            let answered = match aperture {
                Aperture::Registers(offset) => {
                    self.backplane.write_register(offset, part[0]);
                    count
                }
                Aperture::Fifo => {
                    self.backplane.fifo.push(part, &self.backplane);
                    count
                }
                Aperture::Memory(index) => self.backplane.memory.lock().write(index, part),
                Aperture::Za(index) => self.backplane.memory.lock().za_mut().write(index, part),
                Aperture::Nothing => 0,
            };
            if answered < count {
                self.unmapped(at.wrapping_add(4 * answered as u32), count - answered);
            }
            (at, rest) = (at.wrapping_add(4 * count as u32), after);
        }
    }

    fn wait_interrupt(&mut self, mask: u32, timeout: Duration) -> u32 {
        self.backplane.interrupts.wait(mask, timeout)
    }
}
