//! What happens when a packet is refused: the ERROR_* registers, the halt, the interrupt.
//!
//! Duties: tells the host which packet, where, and why; stops the source it came from. The other
//! source works on. Clocks: none; the card stands still.
//!
//! When both sources have failed, the ERROR_* registers tell of the first: they do not change while
//! a driver reads them. STATUS shows both halts.

use crate::bus::backplane::Backplane;
use zga_abi::bus::INTERRUPT_ERROR;
use zga_abi::{Fault, Reg};

/// Where a packet came from; the value of ERROR_SOURCE.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The command ring.
    Ring = 1,
    /// The PIO FIFO.
    Fifo = 2,
}

impl Backplane {
    /// Stops `source`, whose packet with the header `header` at `offset` was refused.
    pub(crate) fn refuse(&self, source: Source, offset: u32, header: u32, fault: Fault) {
        if self.registers.get(Reg::ErrorCode) == 0 {
            self.registers.set(Reg::ErrorSource, source as u32);
            self.registers.set(Reg::ErrorOffset, offset);
            self.registers.set(Reg::ErrorPacket, header);
            self.registers.set(Reg::ErrorWord, fault.word);
            self.registers.set(Reg::ErrorValue, fault.value);
            // Last: who polls ERROR_CODE then finds the others set.
            self.registers.set(Reg::ErrorCode, fault.code as u32);
        }
        match source {
            Source::Ring => self.ring.set_halted(true),
            Source::Fifo => self.fifo.set_halted(true),
        }
    }

    /// Raises the error interrupt.
    pub(crate) fn raise_error(&self) {
        self.interrupts.raise(INTERRUPT_ERROR);
    }
}
