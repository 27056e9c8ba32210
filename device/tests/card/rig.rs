//! A card on the bench: short names for its registers, packets and waits.

use std::ops::{Deref, DerefMut};
use std::time::{Duration, Instant};
use zga_abi::Bus;
use zga_device::{Card, CardBus, CardOptions};

pub const RESET: u32 = 0x40;
pub const STATUS: u32 = 0x44;
pub const WATCHDOG: u32 = 0x48;
pub const SCRATCH: u32 = 0x4C;
pub const INTERRUPT_STATUS: u32 = 0x80;
pub const INTERRUPT_ENABLE: u32 = 0x84;
pub const ERROR_CODE: u32 = 0x88;
pub const BUS_UNMAPPED: u32 = 0xA0;
pub const BUS_READ_ONLY: u32 = 0xA4;
pub const BUS_MISALIGNED: u32 = 0xA8;
pub const BUS_REJECTED: u32 = 0xAC;
pub const BUS_FAULT_ADDRESS: u32 = 0xB0;
pub const FIFO_FREE: u32 = 0xC0;
pub const RING_BASE: u32 = 0x100;
pub const RING_SIZE: u32 = 0x104;
pub const RING_PUT: u32 = 0x108;
pub const RING_GET: u32 = 0x10C;
pub const DOORBELL: u32 = 0x110;
pub const FENCE_SEQUENCE: u32 = 0x140;
pub const SCANOUT_CONTROL: u32 = 0x680;
pub const SCANOUT_PERIOD: u32 = 0x684;
pub const SCANOUT_BASE: u32 = 0x688;
pub const SCANOUT_PITCH: u32 = 0x68C;
pub const SCANOUT_FORMAT: u32 = 0x690;
pub const SCANOUT_SIZE: u32 = 0x694;
pub const FRAME_COUNT: u32 = 0x698;
/// The PIO FIFO window.
pub const FIFO: u32 = 0x8000;
/// Za RAM.
pub const ZA: u32 = 0x0200_0000;
/// Video memory.
pub const MEMORY: u32 = 0x4000_0000;
/// Longer than anything a test waits for.
pub const LONG: Duration = Duration::from_secs(60);

/// A card with 1 MiB of video memory and 64 KiB of Za RAM, and a bus to it.
pub struct Rig {
    pub card: Card,
    pub bus: CardBus,
}

impl Deref for Rig {
    type Target = CardBus;
    fn deref(&self) -> &CardBus {
        &self.bus
    }
}

impl DerefMut for Rig {
    fn deref_mut(&mut self) -> &mut CardBus {
        &mut self.bus
    }
}

impl Rig {
    pub fn new() -> Rig {
        Rig::with_memory(1 << 20)
    }

    pub fn with_memory(video_memory: u32) -> Rig {
        let options = CardOptions { video_memory, za_ram: 0x1_0000, threads: 1, ..CardOptions::default() };
        let card = Card::power_on(options).expect("a card of these sizes");
        let bus = card.bus();
        Rig { card, bus }
    }

    /// Pushes packets into the FIFO.
    pub fn push(&mut self, words: &[u32]) {
        self.bus.write_burst(FIFO, words);
    }

    /// Pushes a fence and waits until it is executed.
    pub fn finish(&mut self, sequence: u32) {
        self.push(&fence(sequence));
        self.until(FENCE_SEQUENCE, sequence);
        self.idle();
    }

    /// Waits until a register has this value.
    pub fn until(&mut self, register: u32, value: u32) {
        until(|| self.bus.read32(register) == value);
    }

    /// Waits until the card has nothing to do.
    pub fn idle(&mut self) {
        until(|| self.bus.read32(STATUS) & 1 == 0);
    }

    /// Words of video memory from byte `address` on.
    pub fn words(&mut self, address: u32, count: usize) -> Vec<u32> {
        let mut words = vec![0; count];
        self.bus.read_burst(MEMORY + address, &mut words);
        words
    }

    /// Makes every present wait for the next vertical blank, which is 1 s away.
    pub fn slow_blanks(&mut self) {
        self.bus.write32(SCANOUT_PERIOD, 1_000_000);
        self.bus.write32(SCANOUT_CONTROL, 1);
    }

    /// Sets up a frame to be shown.
    pub fn show(&mut self, base: u32, pitch: u32, format: u32, width: u32, height: u32) {
        self.bus.write32(SCANOUT_BASE, base);
        self.bus.write32(SCANOUT_PITCH, pitch);
        self.bus.write32(SCANOUT_FORMAT, format);
        self.bus.write32(SCANOUT_SIZE, (height << 16) | width);
    }
}

/// Waits until `done`, at most a minute.
pub fn until(mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < LONG, "the card does not come to an end");
        std::thread::yield_now();
    }
}

/// NO_OPERATION with `payload` words of payload.
pub fn no_operation(payload: u32) -> Vec<u32> {
    let mut packet = vec![payload];
    packet.resize(1 + payload as usize, 0xDEAD_BEEF);
    packet
}

pub fn fence(sequence: u32) -> [u32; 2] {
    [0x3000_0001, sequence]
}

pub fn present(base: u32) -> [u32; 2] {
    [0x3100_0001, base]
}

pub fn write_back(destination: u32) -> [u32; 2] {
    [0x3200_0001, destination]
}

/// FILL of XRGB8888 pixels from (0, 0) of a surface on.
pub fn fill(base: u32, pitch: u32, width: u32, height: u32, value: u32) -> [u32; 9] {
    [0x2000_0008, base, pitch, 0, 0, 0, width, height, value]
}

/// UPLOAD of one row.
pub fn upload(address: u32, words: &[u32]) -> Vec<u32> {
    let count = words.len() as u32;
    let mut packet = vec![0x2200_0004 + count, address, 4 * count, count, 1];
    packet.extend(words);
    packet
}

/// REGISTER_WRITE.
pub fn register_write(offset: u32, values: &[u32]) -> Vec<u32> {
    let mut packet = vec![0x0100_0001 + values.len() as u32, offset];
    packet.extend(values);
    packet
}

/// Numbers without a pattern, always the same.
pub fn noise(count: usize) -> Vec<u32> {
    let mut state = 0x1234_5678_9ABC_DEF1_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 16) as u32
    };
    (0..count).map(|_| next()).collect()
}
