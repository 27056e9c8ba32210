//! After an error interrupt: what was refused, and how the rest goes on.

use zga_abi::bus::{Bus, FLOATING};
use zga_abi::fault::FaultCode;
use zga_abi::format::HiddenSurface;
use zga_abi::packet::{Opcode, header};
use zga_abi::registers::Reg;

use super::image::RegisterImage;
use super::packets::{Packet, field_name, packets};
use super::{Queue, Transport};

/// Words of the FENCE that ends every batch.
const FENCE_WORDS: usize = 2;

/// Where a refused packet came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultSource {
    /// The ring in video memory.
    Ring,
    /// The PIO FIFO.
    Fifo,
    /// ERROR_SOURCE holds another value.
    Unknown(u32),
}

impl std::fmt::Display for FaultSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FaultSource::Ring => f.write_str("ring"),
            FaultSource::Fifo => f.write_str("FIFO"),
            FaultSource::Unknown(value) => write!(f, "unknown source {value}"),
        }
    }
}

/// The card refused a packet; the driver has recovered when this is handed out.
///
/// What is lost, and nothing else:
/// * the refused packet (a fence is never dropped; it is sent again),
/// * with a refused BEGIN_SCENE also the clears and draws of that scene and its END_SCENE,
/// * with a packet that ended half-way (`WATCHDOG`): the part of it that was done stays in memory,
/// * if the packet is none of the driver's (somebody else wrote to ring or FIFO): everything that was under
///   way, except the register values it would have left.
///
/// The card was reset, its registers were set to what they were before the packet, an open scene was
/// begun again, and everything behind the packet is sent again with the next flush, fence or wait.
/// Video memory is kept, so what the scene had drawn into it stays.
///
/// The systolic array and the tile unit hold a scene's depths on the chip, or the whole scene until its end: a
/// reset loses them. On these paths the open scene is sent again from its BEGIN_SCENE on, without the refused
/// packet, and its fences count as not reached until then. A scene that begins with a clear of everything becomes
/// exactly what it would have been. The vertices that its draws read from video memory must stay as they are until
/// the scene has ended. What a refused END_SCENE should have drawn is lost.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the card refused {packet} at word {offset:#x} of the {from}: {code_name} at word {word} ({field}), found {value:#010x}"
)]
pub struct CardFault {
    /// ERROR_CODE, if it is a known one.
    pub code: Option<FaultCode>,
    /// Name of the code; "fault N" for an unknown one.
    pub code_name: String,
    /// Where the packet came from.
    pub from: FaultSource,
    /// ERROR_OFFSET: word offset in the ring, or FIFO words taken before the packet.
    pub offset: u32,
    /// Name of the packet; "opcode 0xNN" for an unknown one.
    pub packet: String,
    /// Header word of the packet.
    pub header: u32,
    /// Which word of the packet is at fault; 0 is the header.
    pub word: u32,
    /// The value found there, or derived from it.
    pub value: u32,
    /// Name of that word in the manual, or of the register that the packet samples.
    pub field: String,
}

/// Registers and scene after the last packet known to be executed.
#[derive(Debug)]
pub(super) struct Executed {
    image: RegisterImage,
    in_scene: bool,
    /// Number of the last fence.
    fence: u32,
    /// The open scene, if the card loses it with a reset.
    held: Option<HeldScene>,
}

/// An open scene that has to be sent again as a whole.
#[derive(Debug)]
struct HeldScene {
    /// Registers and last fence before it.
    image: RegisterImage,
    fence: u32,
    /// Its packets from BEGIN_SCENE on, fences among them.
    words: Vec<u32>,
}

impl HeldScene {
    /// Keeps what draws, what it needs, and the fences, so that batches stay as long as they were.
    fn keep(&mut self, words: &[u32]) {
        for packet in packets(words) {
            let draws = packet.needs_scene() || packet.opcode() == Some(Opcode::BeginScene);
            if draws || matches!(packet.opcode(), Some(Opcode::RegisterWrite | Opcode::Fence)) {
                self.words.extend_from_slice(packet.words);
            }
        }
    }
}

impl Executed {
    pub fn reset() -> Executed {
        Executed { image: RegisterImage::reset(), in_scene: false, fence: 0, held: None }
    }

    /// Follows packets that were executed.
    pub fn follow(&mut self, words: &[u32]) {
        // A scene that begins and ends here leaves nothing to keep.
        let (mut open_from, mut ends) = (None, false);
        for packet in packets(words) {
            match packet.opcode() {
                Some(Opcode::BeginScene) => open_from = Some(packet.start),
                Some(Opcode::EndScene) => (open_from, ends) = (None, true),
                _ => {}
            }
        }
        if let Some(start) = open_from {
            let (before, scene) = words.split_at(start);
            self.advance(before);
            self.in_scene = true;
            let (image, fence) = (&self.image, self.fence);
            self.held =
                image.is_lost_with_a_reset().then(|| HeldScene { image: image.clone(), fence, words: Vec::new() });
            self.keep_and_advance(scene);
        } else if ends {
            (self.in_scene, self.held) = (false, None);
            self.advance(words);
        } else {
            self.keep_and_advance(words);
        }
    }

    fn keep_and_advance(&mut self, words: &[u32]) {
        if let Some(held) = &mut self.held {
            held.keep(words);
        }
        self.advance(words);
    }

    /// Follows registers and fences.
    fn advance(&mut self, words: &[u32]) {
        self.image.follow(words);
        let fences = packets(words).filter(|packet| packet.opcode() == Some(Opcode::Fence));
        self.fence = fences.last().and_then(|packet| packet.words.get(1).copied()).unwrap_or(self.fence);
    }
}

impl RegisterImage {
    /// Whether a scene that began with these registers is lost, in whole or in part, when the card is reset.
    fn is_lost_with_a_reset(&self) -> bool {
        let path = HiddenSurface::from_code(self.get(Reg::HiddenSurface.offset()));
        matches!(path, Some(HiddenSurface::Systolic | HiddenSurface::Tile))
    }
}

impl Queue {
    /// Takes note of registers that were written past the stream, as a packet would have written them.
    pub fn note_registers(&mut self, packet: &[u32]) {
        self.executed.image.follow(packet);
    }

    /// Looks whether the card refused a packet; if so resets it and arranges that the rest goes on.
    ///
    /// `None` if there is no error. Nothing is sent yet: the next flush does that.
    pub fn recover<B: Bus>(&mut self, bus: &mut B) -> Option<CardFault> {
        let mut report = [0; 6];
        bus.read_burst(Reg::ErrorCode.offset(), &mut report);
        let [code, source, offset, header_word, word, value] = report;
        if code == 0 || code == FLOATING {
            return None;
        }
        self.retire(bus.read32(Reg::FenceSequence.offset()));
        let from = match source {
            1 => FaultSource::Ring,
            2 => FaultSource::Fifo,
            other => FaultSource::Unknown(other),
        };

        // What the card has not executed, in order: the refused packet first, if it is one of ours.
        let place = self.find(from, offset, header_word);
        let mut rest = Vec::with_capacity(self.in_flight + self.pending.len() + 1);
        for (index, batch) in self.retained.drain(..).enumerate() {
            let executed = match place {
                Some((refused, at)) if index == refused => at,
                Some((refused, _)) if index > refused => 0,
                Some(_) => batch.words.len(),
                None => batch.words.len() - FENCE_WORDS,
            };
            self.executed.follow(&batch.words[..executed]);
            rest.extend_from_slice(&batch.words[executed..]);
        }
        self.in_flight = 0;
        let refused = place.and_then(|_| packets(&rest).next());
        let header_only = [header_word];
        let field = match Reg::at(value) {
            // Registers are sampled by the packet: the value is the offset of the one at fault.
            Some((register, _)) if word == 0 && value != header_word => format!("register {}", register.info().name),
            _ => field_name(refused.map_or(&header_only, |packet| packet.words), word),
        };
        let opcode = Opcode::from_code(header_word >> 24);
        let fault = CardFault {
            code: FaultCode::from_code(code),
            code_name: FaultCode::from_code(code)
                .map_or_else(|| format!("fault {code}"), |known| known.name().to_owned()),
            from,
            offset,
            packet: opcode
                .map_or_else(|| format!("opcode {:#04x}", header_word >> 24), |known| known.name().to_owned()),
            header: header_word,
            word,
            value,
            field,
        };

        let dropped =
            refused.map_or(0, |packet| if packet.opcode() == Some(Opcode::Fence) { 0 } else { packet.words.len() });
        let scene_opens = place.is_some() && opcode == Some(Opcode::BeginScene);
        let scene_ends = place.is_some() && opcode == Some(Opcode::EndScene);
        let mut again = Vec::with_capacity(rest.len() + self.pending.len() + 1);
        let (in_scene, held) = (std::mem::take(&mut self.executed.in_scene), self.executed.held.take());
        match held {
            _ if !in_scene || scene_ends => {}
            None => again.push(header(Opcode::BeginScene, 0)),
            Some(HeldScene { image, fence, words }) => {
                again.extend_from_slice(&words);
                self.executed.image = image;
                self.executed.fence = fence;
                self.completed = fence;
            }
        }
        rest.append(&mut self.pending);
        if scene_opens {
            self.scene_lost = copy_without_scene(&rest[dropped..], &mut again);
        } else {
            again.extend_from_slice(&rest[dropped..]);
        }
        self.pending = again;
        self.mixed = true;
        let mut image = self.executed.image.clone();
        image.follow(&self.pending);
        self.recovered = Some(image);
        self.sent = self.completed;

        bus.write32(Reg::Reset.offset(), 1);
        for (offset, value) in self.executed.image.changed() {
            bus.write32(offset, value);
        }
        self.start(bus);
        Some(fault)
    }

    /// Which retained batch holds the packet that begins at `offset`, and where in it.
    fn find(&self, from: FaultSource, offset: u32, header_word: u32) -> Option<(usize, usize)> {
        match (from, &self.transport) {
            (FaultSource::Ring, Transport::Ring(_)) | (FaultSource::Fifo, Transport::Fifo { .. }) => {}
            _ => return None,
        }
        self.retained.iter().enumerate().find_map(|(index, batch)| {
            let at = offset.wrapping_sub(batch.start) as usize;
            let is_it = |packet: &Packet<'_>| packet.start == at && packet.words.first() == Some(&header_word);
            (at < batch.words.len() && packets(&batch.words).any(|packet| is_it(&packet))).then_some((index, at))
        })
    }
}

/// Copies packets without those of the scene whose begin was refused; true if its end is still to come.
fn copy_without_scene(words: &[u32], to: &mut Vec<u32>) -> bool {
    let mut lost = true;
    for packet in packets(words) {
        if !(lost && packet.needs_scene()) {
            to.extend_from_slice(packet.words);
        }
        lost &= packet.opcode() != Some(Opcode::EndScene);
    }
    lost
}
