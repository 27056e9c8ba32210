//! Register accesses of the host: what reading shows and what writing sets off.
//!
//! Duties: applies access, masks and write-1-to-clear of [`zga_abi::registers`]; computes live
//! registers; starts side effects.
//! Inputs: offset and value from the bus. Outputs: to every block on the backplane.
//! Clocks: none; the host's accesses are not device time.

use super::backplane::Backplane;
use std::sync::atomic::Ordering::SeqCst;
use zga_abi::bus::FLOATING;
use zga_abi::{Access, Counter, Reg};

impl Backplane {
    /// A host read of the register at byte `offset`.
    pub(crate) fn read_register(&self, offset: u32) -> u32 {
        let Some((reg, word)) = Reg::at(offset) else {
            self.registers.count_fault(Reg::BusUnmapped, offset, 1);
            return FLOATING;
        };
        match reg {
            Reg::Status => self.status(),
            Reg::InterruptStatus => self.interrupts.status(),
            Reg::InterruptEnable => self.interrupts.enable(),
            Reg::FifoFree => self.fifo.free(),
            Reg::RingBase => self.ring.pointers().base,
            Reg::RingSize => self.ring.pointers().size,
            Reg::RingPut => self.ring.pointers().put,
            Reg::RingGet => self.ring.pointers().get,
            Reg::Counters => self.read_counter(word),
            _ if reg.info().access == Access::WriteOnly => 0,
            _ => self.registers.word(reg, word),
        }
    }

    /// A host write of `value` to the register at byte `offset`.
    pub(crate) fn write_register(&self, offset: u32, value: u32) {
        let Some((reg, word)) = Reg::at(offset) else {
            self.registers.count_fault(Reg::BusUnmapped, offset, 1);
            return;
        };
        let info = reg.info();
        let masked = value & info.writable;
        match reg {
            Reg::Reset if masked != 0 => self.control.reset(),
            Reg::Reset => {}
            Reg::InterruptStatus => self.interrupts.acknowledge(value & info.write_one_to_clear),
            Reg::InterruptEnable => self.interrupts.set_enable(masked),
            Reg::RingBase => self.ring.set_base(masked),
            Reg::RingSize => self.ring.set_size(masked),
            Reg::RingPut => self.ring.set_put(masked),
            Reg::Doorbell => {
                self.ring.ring_doorbell();
                self.control.wake();
            }
            Reg::CounterControl if masked != 0 => self.counters.lock().clear(),
            Reg::CounterControl => {}
            _ if info.access == Access::ReadOnly => self.registers.count_fault(Reg::BusReadOnly, offset, 1),
            _ => self.registers.write(reg, word, value),
        }
        if matches!(reg, Reg::ScanoutControl | Reg::ScanoutPeriod) {
            self.control.wake();
        }
    }

    /// Word `word` of COUNTERS: a low word latches its high word.
    fn read_counter(&self, word: u32) -> u32 {
        let Some(&counter) = Counter::ALL.get((word / 2) as usize) else { return 0 };
        if word % 2 == 1 {
            return self.registers.word(Reg::Counters, word);
        }
        let value = self.counters.lock().get(counter);
        self.registers.set_word(Reg::Counters, word + 1, (value >> 32) as u32);
        value as u32
    }

    /// Is there still a card behind the connector?
    pub(crate) fn has_power(&self) -> bool {
        !self.control.power_lost().load(SeqCst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn read_counter_low_word_latches_the_high_word() {
        let (backplane, _fifo, _control) = Backplane::new(4096, 0);
        let low = Counter::ZWrites.offset();
        backplane.counters.lock().add(Counter::ZWrites, 0x1_FFFF_FFFF);
        assert_eq!(backplane.read_register(low + 4), 0);
        assert_eq!(backplane.read_register(low), 0xFFFF_FFFF);
        backplane.counters.lock().add(Counter::ZWrites, 1);
        assert_eq!(backplane.read_register(low + 4), 1);
        assert_eq!(backplane.read_register(low), 0);
        assert_eq!(backplane.read_register(low + 4), 2);
    }
}
