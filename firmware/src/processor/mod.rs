//! The command processor's program: one packet in, calls to the card's units out.
//!
//! Duties: decode a packet, check every claim in it and every register it samples, power the units
//! it needs, program them.
//! Inputs from: ring and FIFO (whole packets), the register file through [`Hardware::register`].
//! Outputs to: every unit, through [`Hardware`]; EFFECTS_CALLED and UNITS_POWERED.
//! Clocks: none of its own; the front end charges packet fetch and decode in
//! [`Hardware::packet_taken`].
//!
//! # How a packet is refused
//! Nothing of a refused packet happens: all of it is checked before the first unit is called and
//! before the first register changes. The [`Fault`] says where the trouble is:
//!
//! | at fault | `word` | `value` |
//! | --- | --- | --- |
//! | the header, the length, or a packet in the wrong place | 0 | the header |
//! | a payload word | its place in the packet | the word |
//! | an index in video memory | the word with the indices' address | the index |
//! | a register that does not exist or is closed to packets | the offset word, or the value word that has no register | the byte offset |
//! | a register that was sampled | 0 | the register's byte offset |
//! | the time it took (WATCHDOG) | 0 | 0 |
//!
//! A host can write a register at any time and with any value, so registers are checked when they
//! are sampled: the target's by begin scene, the draw state's by each draw and clear, scan-out's by
//! present and write back. Such a fault is BAD_VALUE, OUT_OF_MEMORY, BAD_ALIGNMENT, OVERLAP or
//! UNSUPPORTED; none of these is ever a fault of the header, so the code tells the two uses of
//! word 0 apart. Of several faults in one packet the first is reported: header, place, payload
//! words, registers, then indices.
//!
//! # What is checked where
//! `decode` opcode and length; `claim` numbers and where they stand; `memory` address ranges;
//! `registers` register values and writes; `scene`, `draw`, `bitmap`, `lists`, `display` the packets;
//! `power` effects and units; `state` snapshots.

mod bitmap;
mod claim;
mod compose;
mod decode;
mod display;
mod draw;
mod effects;
mod lists;
mod memory;
mod power;
mod registers;
mod scene;
mod state;

use crate::checked::Target;
use crate::hardware::{Hardware, Stopped};
use claim::Claim;
use power::Power;
use scene::Scene;
pub use state::ProcessorState;
use zga_abi::packet::Opcode;
use zga_abi::{Effects, Fault, FaultCode, Units};

/// The command processor.
///
/// It holds what lasts from packet to packet: the scene that was begun and what has been powered.
#[derive(Clone, Debug)]
pub struct Processor {
    scene: Option<Scene>,
    power: Power,
}

impl Default for Processor {
    fn default() -> Self {
        Processor::new()
    }
}

impl Processor {
    /// A command processor after power-on: no scene, and no unit powered yet.
    #[must_use]
    pub const fn new() -> Processor {
        Processor { scene: None, power: Power::new() }
    }

    /// Back to the state after power-on. The card resets its registers and units itself.
    pub fn reset(&mut self) {
        *self = Processor::new();
    }

    /// Between begin scene and end scene.
    #[must_use]
    pub const fn in_scene(&self) -> bool {
        self.scene.is_some()
    }

    /// The target of the scene, while there is one.
    #[must_use]
    pub fn target(&self) -> Option<&Target> {
        self.scene.as_ref().map(|scene| &scene.target)
    }

    /// Effects that draws have really used since begin scene, as EFFECTS_CALLED shows them.
    #[must_use]
    pub const fn effects_called(&self) -> Effects {
        self.power.effects()
    }

    /// Units powered now, as UNITS_POWERED shows them; none before the first packet that needs one.
    #[must_use]
    pub const fn units_powered(&self) -> Units {
        self.power.units()
    }

    /// Words of the packet that begins with `header`, the header included: 1 ..= 2^20.
    ///
    /// # Errors
    /// UNKNOWN_OPCODE, RESERVED_BITS, or BAD_LENGTH where the opcode alone tells that the length is
    /// wrong, so that a bad header faults before its payload has arrived.
    pub const fn packet_length(header: u32) -> Result<u32, Fault> {
        match decode::decode(header) {
            Ok((_, length)) => Ok(length),
            Err(fault) => Err(fault),
        }
    }

    /// Executes `packet`, one whole packet with its header first.
    ///
    /// A packet that a host's reset stops ([`Stopped::Reset`]) ends without a fault: the reset
    /// throws away the packet and everything behind it.
    ///
    /// # Errors
    /// The [`Fault`] for which the packet was refused, the first that was found in the order header,
    /// place, payload words, registers, indices; nothing of it has been done. WATCHDOG is the
    /// exception: what was drawn before time ran out stays.
    pub fn execute<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        // A packet has at most 2^20 words; a longer slice is refused below.
        hardware.packet_taken(u32::try_from(packet.len()).unwrap_or(u32::MAX));
        let header = packet.first().copied().unwrap_or(0);
        let (opcode, length) = decode::decode(header)?;
        if packet.len() != length as usize {
            return Err(bad_length(packet));
        }
        match opcode {
            Opcode::NoOperation => Ok(()),
            Opcode::RegisterWrite => registers::write(hardware, packet),
            Opcode::BeginScene => self.begin_scene(hardware, packet),
            Opcode::EndScene => self.end_scene(hardware, packet),
            Opcode::Clear => self.clear(hardware, packet),
            Opcode::DrawInline => self.draw_inline(hardware, packet),
            Opcode::DrawBuffer => self.draw_buffer(hardware, packet),
            Opcode::Fill => self.fill(hardware, packet),
            Opcode::Copy => self.copy(hardware, packet),
            Opcode::Upload => self.upload(hardware, packet),
            Opcode::Download => self.download(hardware, packet),
            Opcode::FillRop => self.fill_rop(hardware, packet),
            Opcode::CopyRop => self.copy_rop(hardware, packet),
            Opcode::Convert => self.convert(hardware, packet),
            Opcode::Stretch => self.stretch(hardware, packet),
            Opcode::FillList => self.fill_list(hardware, packet),
            Opcode::CopyList => self.copy_list(hardware, packet),
            Opcode::Compose => self.compose(hardware, packet),
            Opcode::Segments => self.segments(hardware, packet),
            Opcode::Expand => self.expand(hardware, packet),
            Opcode::Fence => self.fence(hardware, packet),
            Opcode::Present => self.present(hardware, packet),
            Opcode::WriteBack => self.write_back(hardware, packet),
        }
    }
}

/// The fault of a packet whose length does not fit its opcode or contents.
fn bad_length(packet: &[u32]) -> Fault {
    at_header(FaultCode::BadLength, packet)
}

/// A fault of the packet as a whole.
fn at_header(code: FaultCode, packet: &[u32]) -> Fault {
    Fault::new(code, 0, packet.first().copied().unwrap_or(0))
}

/// What the packet ends with when a unit has stopped early.
fn outcome(work: Result<(), Stopped>) -> Result<(), Fault> {
    match work {
        // The host throws the packet away; there is nothing to report.
        Ok(()) | Err(Stopped::Reset) => Ok(()),
        Err(Stopped::Watchdog) => Err(Fault::new(FaultCode::Watchdog, 0, 0)),
        Err(Stopped::SceneFull) => Err(Fault::new(FaultCode::SceneFull, 0, 0)),
    }
}
