//! Does the card still answer? Identification, reset, and a scene whose picture is known.
//!
//! The scene goes through FIFO and ring, draws every topology from packet and memory, and is shown
//! and written back. It relies on nothing that was there before the reset.

use super::packets::packet;
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use zga_abi::bus::{FIFO_BASE, INTERRUPT_FENCE, MEMORY_BASE};
use zga_abi::packet::Opcode;
use zga_abi::{Bus, Reg};
use zga_device::{Card, CardBus, CardOptions};

const WIDTH: u32 = 64;
const HEIGHT: u32 = 48;
/// Frame buffer, Z buffer, vertices, indices, frame written back, ring: bytes in video memory.
const COLOUR: u32 = 0x1_0000;
const DEPTH: u32 = 0x2_0000;
const VERTICES: u32 = 0x3_0000;
const INDICES: u32 = 0x3_8000;
const FRAME: u32 = 0x4_0000;
const RING: u32 = 0x5_0000;
/// Longer than the scene takes on any machine.
const LONG: Duration = Duration::from_secs(15);

/// The picture's hash on a card that was never touched.
static KNOWN: OnceLock<Result<u64, String>> = OnceLock::new();

/// Asks the card all that it must answer after whatever was done to it.
///
/// # Errors
/// What it answered wrongly.
pub fn answers(card: &Card) -> Result<(), String> {
    let known = KNOWN.get_or_init(|| {
        let options = CardOptions { video_memory: 1 << 20, za_ram: 0, threads: 1, ..CardOptions::default() };
        let card = Card::power_on(options).map_err(|error| error.to_string())?;
        picture(&mut card.bus())
    });
    let known = known.clone()?;
    let mut bus = card.bus();
    expect(&mut bus, Reg::Identification, 0x5A47_4131)?;
    bus.write32(Reg::Reset.offset(), 1);
    idle(&mut bus)?;
    for reg in [Reg::Status, Reg::ErrorCode, Reg::ErrorSource, Reg::RingGet, Reg::FenceSequence, Reg::InterruptStatus] {
        expect(&mut bus, reg, 0)?;
    }
    expect(&mut bus, Reg::FifoFree, 1024)?;
    expect(&mut bus, Reg::Counters, 0)?;
    bus.write32(Reg::Scratch.offset(), 0x0BAD_CAFE);
    expect(&mut bus, Reg::Scratch, 0x0BAD_CAFE)?;
    let hash = picture(&mut bus)?;
    if hash == known { Ok(()) } else { Err(format!("the picture's hash is {hash:#018x}, it was {known:#018x}")) }
}

fn expect(bus: &mut CardBus, reg: Reg, value: u32) -> Result<(), String> {
    let found = bus.read32(reg.offset());
    if found == value { Ok(()) } else { Err(format!("{} reads {found:#010x}, not {value:#010x}", reg.info().name)) }
}

fn idle(bus: &mut CardBus) -> Result<(), String> {
    let begun = Instant::now();
    while bus.read32(Reg::Status.offset()) & 1 != 0 {
        if begun.elapsed() > LONG {
            return Err("busy after a reset".to_owned());
        }
        std::thread::yield_now();
    }
    Ok(())
}

/// Waits for fence `sequence`.
fn fence(bus: &mut CardBus, sequence: u32) -> Result<(), String> {
    let lines = bus.wait_interrupt(INTERRUPT_FENCE, LONG);
    bus.write32(Reg::InterruptStatus.offset(), INTERRUPT_FENCE);
    if lines != INTERRUPT_FENCE {
        let [code, word, value] = [Reg::ErrorCode, Reg::ErrorWord, Reg::ErrorValue].map(|reg| bus.read32(reg.offset()));
        return Err(format!("fence {sequence} did not come; fault {code} at word {word}, {value:#x}"));
    }
    expect(bus, Reg::FenceSequence, sequence)
}

/// Draws the scene on a card after reset; the hash of the frame written back.
fn picture(bus: &mut CardBus) -> Result<u64, String> {
    bus.write32(Reg::InterruptEnable.offset(), INTERRUPT_FENCE);
    bus.write_burst(MEMORY_BASE + VERTICES, &vertices());
    bus.write_burst(MEMORY_BASE + INDICES, &[0, 1, 2, 2, 1, 3]);
    bus.write_burst(FIFO_BASE, &drawing());
    fence(bus, 1)?;

    bus.write32(Reg::RingBase.offset(), RING);
    bus.write32(Reg::RingSize.offset(), 256);
    let packets = showing();
    bus.write_burst(MEMORY_BASE + RING, &packets);
    bus.write32(Reg::RingPut.offset(), packets.len() as u32);
    bus.write32(Reg::Doorbell.offset(), 1);
    fence(bus, 2)?;
    expect(bus, Reg::FrameCount, 1)?;

    let mut frame = vec![0; (WIDTH * HEIGHT) as usize];
    bus.read_burst(MEMORY_BASE + FRAME, &mut frame);
    // FNV-1a.
    Ok(frame.iter().fold(0xCBF2_9CE4_8422_2325, |hash, &word| (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01B3)))
}

/// Corners of a quadrilateral: x, y, z, colour.
fn vertices() -> Vec<u32> {
    let corners = [
        (4.0, 6.0, 0.2, 0xFF00_00FF),
        (58.0, 3.0, 0.8, 0xFF00_FF00),
        (9.0, 45.0, 0.6, 0xFFFF_0000),
        (61.5, 40.25, 0.1, 0xFFFF_FFFF),
    ];
    corners
        .iter()
        .flat_map(|&(x, y, z, colour): &(f32, f32, f32, u32)| [x.to_bits(), y.to_bits(), z.to_bits(), colour])
        .collect()
}

/// An inline draw with one colour for each vertex.
fn inline(topology: u32, vertices: &[(f32, f32, f32, u32)]) -> Vec<u32> {
    let mut payload = vec![0x100 | topology, vertices.len() as u32, 0];
    payload.extend(vertices.iter().flat_map(|&(x, y, z, colour)| [x.to_bits(), y.to_bits(), z.to_bits(), colour]));
    packet(Opcode::DrawInline, &payload)
}

fn drawing() -> Vec<u32> {
    let target = [Reg::TargetSize.offset(), (HEIGHT << 16) | WIDTH, COLOUR, 4 * WIDTH, 0, DEPTH, 4 * WIDTH];
    // Depth and Gouraud.
    let effects = [Reg::Effects.offset(), 3];
    let triangle =
        [(30.0, -500.0, 0.9, 0xFF00_FFFF), (700.0, 60.0, 0.0, 0xFFFF_00FF), (-600.0, 70.0, 0.4, 0xFF80_8000)];
    let lines = [
        (1.0, 1.0, 0.05, 0xFFFF_FFFF),
        (62.0, 47.0, 0.5, 0xFF00_0080),
        (0.0, 20.0, 0.3, 0xFF10_2030),
        (64.0, 21.0, 0.3, 0xFF30_2010),
    ];
    let points = [(5.5, 40.5, 0.0, 0xFFAB_CDEF), (f32::NAN, 0.0, 0.0, 0), (63.9, 0.1, 0.99, 0xFF12_3456)];
    [
        packet(Opcode::RegisterWrite, &target),
        packet(Opcode::RegisterWrite, &effects),
        packet(Opcode::BeginScene, &[]),
        packet(Opcode::Clear, &[3, 0xFF40_2010, 0x00FF_FFFF]),
        packet(Opcode::DrawBuffer, &[0x110, VERTICES, 4, INDICES, 6]),
        inline(0, &triangle),
        inline(1, &lines),
        inline(3, &lines),
        inline(2, &points),
        packet(Opcode::EndScene, &[]),
        packet(Opcode::Copy, &[0, COLOUR, 4 * WIDTH, 0, 0, COLOUR, 4 * WIDTH, 3, 2, 40, 20]),
        packet(Opcode::Fill, &[COLOUR, 4 * WIDTH, 0, 50, 30, 9, 9, 0x0012_3456]),
        packet(Opcode::Fence, &[1]),
    ]
    .concat()
}

fn showing() -> Vec<u32> {
    let scanout = [Reg::ScanoutBase.offset(), 0, 4 * WIDTH, 0, (HEIGHT << 16) | WIDTH];
    [
        packet(Opcode::RegisterWrite, &scanout),
        packet(Opcode::Present, &[COLOUR]),
        packet(Opcode::WriteBack, &[FRAME]),
        packet(Opcode::Fence, &[2]),
    ]
    .concat()
}
