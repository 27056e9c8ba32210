//! Packet headers: opcode, reserved bits, and the length as far as the opcode tells it.

use zga_abi::packet::{Opcode, list, payload_words};
use zga_abi::{Fault, FaultCode};

/// Header bits 23:20, which are zero.
const RESERVED: u32 = 0x00F0_0000;

/// Payload words that an opcode can have.
enum Payload {
    /// Just as many.
    Exactly(u32),
    /// As many or more; the contents tell how many.
    AtLeast(u32),
}

/// The payload of an opcode, in words.
const fn payload(opcode: Opcode) -> Payload {
    match opcode {
        Opcode::NoOperation => Payload::AtLeast(0),
        Opcode::RegisterWrite => Payload::AtLeast(2),
        Opcode::BeginScene | Opcode::EndScene => Payload::Exactly(0),
        Opcode::Clear => Payload::Exactly(3),
        Opcode::DrawInline => Payload::AtLeast(3),
        Opcode::DrawBuffer => Payload::Exactly(5),
        Opcode::Fill => Payload::Exactly(8),
        Opcode::Copy => Payload::Exactly(11),
        Opcode::Upload => Payload::AtLeast(4),
        Opcode::Download => Payload::Exactly(5),
        Opcode::FillRop => Payload::Exactly(10),
        Opcode::CopyRop => Payload::Exactly(13),
        Opcode::Convert => Payload::Exactly(12),
        Opcode::Stretch => Payload::Exactly(19),
        Opcode::FillList => Payload::AtLeast(list::FILL_WORDS),
        Opcode::CopyList => Payload::AtLeast(list::COPY_WORDS),
        Opcode::Segments => Payload::AtLeast(list::SEGMENTS_WORDS),
        Opcode::Expand => Payload::AtLeast(list::EXPAND_WORDS),
        Opcode::Compose => Payload::AtLeast(list::COMPOSE_WORDS),
        Opcode::Fence | Opcode::Present | Opcode::WriteBack => Payload::Exactly(1),
    }
}

/// Opcode and total words of the packet that begins with `header`.
pub(super) const fn decode(header: u32) -> Result<(Opcode, u32), Fault> {
    let Some(opcode) = Opcode::from_code(header >> 24) else {
        return Err(Fault::new(FaultCode::UnknownOpcode, 0, header));
    };
    if header & RESERVED != 0 {
        return Err(Fault::new(FaultCode::ReservedBits, 0, header));
    }
    let words = payload_words(header);
    let fits = match payload(opcode) {
        Payload::Exactly(exact) => words == exact,
        Payload::AtLeast(least) => words >= least,
    };
    if fits { Ok((opcode, 1 + words)) } else { Err(Fault::new(FaultCode::BadLength, 0, header)) }
}
