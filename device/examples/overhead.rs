//! What a packet and a fence cost on this host, beside the work they order:
//! `cargo run --release --example overhead -p zga-device`.

use std::time::{Duration, Instant};
use zga_abi::Reg;
use zga_abi::bus::{Bus, FIFO_BASE, INTERRUPT_FENCE, MEMORY_BASE};
use zga_abi::packet::{Opcode, header};
use zga_device::{Card, CardBus, CardError, CardOptions};

/// Words of the ring.
const RING_WORDS: u32 = 1 << 20;

fn main() -> Result<(), CardError> {
    let card = Card::power_on(CardOptions::default())?;
    let mut bus = card.bus();
    bus.write32(Reg::InterruptEnable.offset(), INTERRUPT_FENCE);
    bus.write32(Reg::RingBase.offset(), 0);
    bus.write32(Reg::RingSize.offset(), RING_WORDS);

    let packets: [(&str, Vec<u32>); 4] = [
        ("no operation", vec![header(Opcode::NoOperation, 0)]),
        ("register write", vec![header(Opcode::RegisterWrite, 2), Reg::ObjectTag.offset(), 1]),
        ("16 matrix words", [&[header(Opcode::RegisterWrite, 17), Reg::ObjectEye.offset()], &[0; 16][..]].concat()),
        ("fill of a pixel", vec![header(Opcode::Fill, 8), 32 << 20, 64, 0, 0, 0, 1, 1, 5]),
    ];
    println!("nanoseconds a packet, the best of 5 rounds");
    for (name, packet) in &packets {
        let count = (RING_WORDS as usize - 8) / packet.len().max(9);
        let stream = packet.repeat(count);
        let ring = best(|| ring_round(&mut bus, &stream));
        let fifo = best(|| fifo_round(&mut bus, &stream));
        let each = |time: Duration| time.as_nanos() as f64 / count as f64;
        println!("{name:>16}: ring {:6.1}, FIFO {:6.1}", each(ring), each(fifo));
    }
    let ring = best(|| (0..5000).map(|_| ring_round(&mut bus, &[])).sum());
    let fifo = best(|| (0..5000).map(|_| fifo_round(&mut bus, &[])).sum());
    let each = |time: Duration| time.as_nanos() as f64 / 5000.0 / 1000.0;
    println!("microseconds from submission to the driver's return: ring {:.2}, FIFO {:.2}", each(ring), each(fifo));
    Ok(())
}

/// The least time of 5 rounds.
fn best(mut round: impl FnMut() -> Duration) -> Duration {
    (0..5).map(|_| round()).min().unwrap_or_default()
}

/// Executes `stream` and a fence from the ring; the time from the doorbell to the interrupt.
fn ring_round(bus: &mut CardBus, stream: &[u32]) -> Duration {
    // A new ring starts at word 0.
    bus.write32(Reg::RingBase.offset(), 0);
    bus.write_burst(MEMORY_BASE, stream);
    bus.write_burst(MEMORY_BASE + 4 * stream.len() as u32, &[header(Opcode::Fence, 1), 1]);
    let start = Instant::now();
    bus.write32(Reg::RingPut.offset(), stream.len() as u32 + 2);
    bus.write32(Reg::Doorbell.offset(), 1);
    wait(bus);
    start.elapsed()
}

/// The same through the FIFO.
fn fifo_round(bus: &mut CardBus, stream: &[u32]) -> Duration {
    let start = Instant::now();
    bus.write_burst(FIFO_BASE, stream);
    bus.write_burst(FIFO_BASE, &[header(Opcode::Fence, 1), 1]);
    wait(bus);
    start.elapsed()
}

fn wait(bus: &mut CardBus) {
    bus.wait_interrupt(INTERRUPT_FENCE, Duration::from_secs(10));
    bus.write32(Reg::InterruptStatus.offset(), INTERRUPT_FENCE);
}
