//! Front end: from the bus to the command processor.
//!
//! Duties: keeps the register file; queues words in the FIFO; fetches packets from the ring; puts
//! whole packets, in one piece, before the firmware; halts a source whose packet was refused.
//! Inputs: the bus ([`fifo::FifoPort`], [`ring::Ring`], [`control::Control`]).
//! Outputs: packets to `zga_firmware::Processor`; ERROR_* registers; STATUS.
//! Clocks: 1 for each word of a packet, header included: ring and FIFO deliver a word a clock and
//! the firmware decodes at that pace. Charged when the firmware takes the packet, refused or not; a
//! packet that is not complete, or has no valid header, does not come that far.
//!
//! | file | stage |
//! | --- | --- |
//! | [`register_file`] | the registers that only hold a value |
//! | [`fifo`] | the PIO FIFO, both ends |
//! | [`ring`] | ring pointers and ring fetch |
//! | [`control`] | reset, snapshot, power: requests to the card's thread |
//! | [`refusal`] | what happens when a packet is refused |

pub(crate) mod control;
pub(crate) mod fifo;
pub(crate) mod refusal;
pub(crate) mod register_file;
pub(crate) mod ring;

use crate::bus::backplane::Backplane;
use crate::memory::VideoMemory;
use crate::probe::account::{Account, Clocks};
use fifo::FifoFetch;
use refusal::Source;
use ring::RingFetch;
use std::sync::atomic::Ordering::SeqCst;
use zga_abi::{Counter, Fault, Reg};
use zga_firmware::{Hardware, Processor};

/// What the front end needs of the card's wiring beside the units.
pub(crate) trait Wired: Hardware {
    /// Everything that host and card share.
    fn backplane(&self) -> &Backplane;
    /// Video memory.
    fn memory(&self) -> &VideoMemory;
    /// Shows the host all that was counted.
    fn publish(&mut self);
}

/// The card's side of the front end.
#[derive(Debug)]
pub(crate) struct Frontend {
    pub(crate) fifo: FifoFetch,
    pub(crate) ring: RingFetch,
    pub(crate) processor: Processor,
}

impl Frontend {
    /// Executes one packet of each source, if there is one; says whether there was.
    pub(crate) fn step(&mut self, wiring: &mut impl Wired) -> bool {
        let ring = self.step_ring(wiring);
        let fifo = self.step_fifo(wiring);
        ring || fifo
    }

    fn step_ring(&mut self, wiring: &mut impl Wired) -> bool {
        let backplane = wiring.backplane();
        if backplane.ring.halted() || backplane.control.stopping() {
            return false;
        }
        let fetched = self.ring.collect(&backplane.ring, wiring.memory().words(), Processor::packet_length);
        let Some(fetched) = fetched else { return false };
        match fetched.and_then(|()| self.processor.execute(wiring, self.ring.packet())) {
            Ok(()) => self.ring.advance(&wiring.backplane().ring),
            Err(fault) => {
                refuse(wiring, Source::Ring, self.ring.offset(), self.ring.packet(), fault);
                self.ring.forget();
                wiring.backplane().raise_error();
            }
        }
        wiring.backplane().in_scene.store(self.processor.in_scene(), SeqCst);
        true
    }

    fn step_fifo(&mut self, wiring: &mut impl Wired) -> bool {
        let backplane = wiring.backplane();
        if backplane.fifo.halted() {
            self.reject(backplane);
            return false;
        }
        if backplane.control.stopping() {
            return false;
        }
        let collected = self.fifo.collect(&backplane.fifo, Processor::packet_length);
        let Some(collected) = collected else { return false };
        if let Err(fault) = collected.and_then(|()| self.processor.execute(wiring, self.fifo.packet())) {
            refuse(wiring, Source::Fifo, self.fifo.offset(), self.fifo.packet(), fault);
            self.reject(wiring.backplane());
            wiring.backplane().raise_error();
        }
        wiring.backplane().in_scene.store(self.processor.in_scene(), SeqCst);
        true
    }

    /// Throws away what a halted FIFO holds, and counts it.
    fn reject(&mut self, backplane: &Backplane) {
        let words = self.fifo.discard(&backplane.fifo);
        if words > 0 {
            backplane.registers.count(Reg::BusRejected, words);
        }
    }
}

/// Halts `source` for a refused packet, of which `packet` has at least the header if there is one.
fn refuse(wiring: &mut impl Wired, source: Source, offset: u32, packet: &[u32], fault: Fault) {
    wiring.publish();
    wiring.backplane().refuse(source, offset, packet.first().copied().unwrap_or(0), fault);
}

/// Charges a packet of `words` words.
pub(crate) fn charge_packet(words: u32, account: &mut Account) {
    account.add(Counter::FrontendPackets, 1);
    account.add(Counter::FrontendWords, u64::from(words));
    account.charge(Counter::CyclesFrontend, Clocks(u64::from(words)));
}
