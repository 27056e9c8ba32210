//! Random bytes on the bus, and what was once found that way.

use proptest::prelude::*;
use std::time::{Duration, Instant};
use zga_abi::Bus;
use zga_device::{Card, CardBus, CardOptions, Kernel, Snapshot};
use zga_tests::fuzz::{self, Mode, Options, session::changed};

const RESET: u32 = 0x40;
const STATUS: u32 = 0x44;
const WATCHDOG: u32 = 0x48;
const DOORBELL: u32 = 0x110;
const FRAME_COUNT: u32 = 0x698;
const FIFO: u32 = 0x8000;
const MEMORY: u32 = 0x4000_0000;
/// "ZGA1".
const IDENTIFICATION: u32 = 0x5A47_4131;
/// Words of a snapshot's card section: draws of the scene, vertical blanks.
const SNAPSHOT_DRAWS: u32 = 13;
const SNAPSHOT_BLANKS: [u32; 2] = [14, 15];

fn card() -> Card {
    card_with(1)
}

fn card_with(threads: usize) -> Card {
    let options = CardOptions { video_memory: 1 << 20, za_ram: 0, threads, kernel: Kernel::Best };
    Card::power_on(options).expect("a card of these sizes")
}

fn idle(bus: &mut CardBus) {
    let begun = Instant::now();
    while bus.read32(STATUS) & 1 != 0 {
        assert_eq!(bus.read32(0), IDENTIFICATION, "the card has lost its power");
        assert!(begun.elapsed() < Duration::from_secs(60), "the card does not come to an end");
        std::thread::yield_now();
    }
}

/// Target of `width` x `height` RGB565 pixels at 0 without a Z buffer, no effects, scene begun.
fn begin(bus: &mut CardBus, width: u32, height: u32) {
    bus.write_burst(FIFO, &[0x0100_0008, 0x200, (height << 16) | width, 0, 2 * width, 2, 0, 0, 0x1818]);
    bus.write_burst(FIFO, &[0x0100_0002, 0x280, 0, 0x0200_0000]);
}

/// Three vertices, as x and y.
fn corners(points: [(f32, f32); 3]) -> Vec<u32> {
    points.iter().flat_map(|&(x, y)| [x.to_bits(), y.to_bits(), 0]).collect()
}

/// Restores the card's own snapshot with words changed.
fn restore_changed(card: &Card, changes: &[(u32, u32)]) {
    let bytes = changed(card.snapshot().expect("a snapshot").to_bytes(), changes, true);
    let snapshot = Snapshot::from_bytes(&bytes).expect("a snapshot that agrees with its checksum");
    card.restore(&snapshot).expect("a state that a card can be in");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, max_shrink_iters: 200, ..ProptestConfig::default() })]

    #[test]
    fn run_any_bytes_card_answers(bytes in prop::collection::vec(any::<u8>(), 0..3000)) {
        // To tell a card that hangs from one that is slow: a wide target with samples takes seconds on a busy machine.
        let outcome = fuzz::run(&bytes, &Options { patience: Duration::from_secs(60), ..Options::default() });
        prop_assert!(outcome.failure.is_none(), "{} after {:x?}", outcome.failure.unwrap(), outcome.actions);
        prop_assert!(!outcome.timing.impatient, "the host lost patience with {:x?}", outcome.actions);
    }

    #[test]
    fn run_any_bytes_kernels_and_threads_agree(
        bytes in prop::collection::vec(any::<u8>(), 0..3000),
        kernel in prop::sample::select(Kernel::available()),
        threads in 1_usize..4,
    ) {
        let options = Options::default();
        let other = CardOptions { kernel, threads, ..options.card };
        let outcome = fuzz::differential(&bytes, Mode::Structured, &options, other);
        prop_assert!(outcome.failure.is_none(), "{} after {:x?}", outcome.failure.unwrap(), outcome.actions);
    }
}

#[test]
fn run_noise_every_packet_kind_is_executed() {
    let mut coverage = fuzz::Coverage::default();
    for seed in 0..400 {
        let outcome = fuzz::run(&fuzz::noise(seed, 2000), &Options { mode: Mode::Structured, ..Options::default() });
        assert!(outcome.failure.is_none(), "seed {seed}: {:?}", outcome.failure);
        coverage.add(&outcome.coverage);
    }
    assert_eq!(coverage.missing(), Vec::<&str>::new());
    assert!(coverage.topologies.iter().all(|&draws| draws > 0), "{coverage}");
    let silent = coverage.silent();
    let stencil = ["stencil.tested", "stencil.failed", "stencil.shadowed"];
    assert!(stencil.iter().all(|counter| !silent.contains(counter)), "{silent:?}");
}

#[test]
fn restore_last_of_all_blanks_present_goes_on() {
    let card = card();
    let mut bus = card.bus();
    restore_changed(&card, &SNAPSHOT_BLANKS.map(|word| (word, u32::MAX)));
    bus.write_burst(FIFO, &[0x3100_0001, 0]);
    idle(&mut bus);
    assert_eq!(bus.read32(FRAME_COUNT), 1);
}

#[test]
fn restore_last_of_all_draws_probed_draw_goes_on() {
    let card = card();
    let mut bus = card.bus();
    begin(&mut bus, 32, 32);
    // Probe on, pixel (1, 1), records at 64 KiB.
    bus.write_burst(FIFO, &[0x0100_0005, 0x600, 1, 0x1_0001, 0x1_0000, 16]);
    idle(&mut bus);
    restore_changed(&card, &[(SNAPSHOT_DRAWS, u32::MAX)]);
    for _ in 0..2 {
        bus.write_burst(FIFO, &[0x1000_000C, 0, 3, 0]);
        bus.write_burst(FIFO, &corners([(0.0, 0.0), (16.0, 0.0), (0.0, 16.0)]));
    }
    idle(&mut bus);
    assert_eq!(bus.read32(0), IDENTIFICATION);
    assert_eq!(bus.read32(0x610), 2);
    // Number of the draw in each record.
    assert_eq!((bus.read32(MEMORY + 0x1_0018), bus.read32(MEMORY + 0x1_0038)), (u32::MAX, 0));
}

#[test]
fn snapshot_of_a_halted_fifo_is_the_same_whenever_words_were_refused() {
    let states = [0, 2, 0, 2].map(|milliseconds| {
        let card = card();
        let mut bus = card.bus();
        // No opcode 0xEE; the words behind are thrown away by the card, or refused once it has halted.
        bus.write32(FIFO, 0xEE00_0000);
        std::thread::sleep(Duration::from_millis(milliseconds));
        bus.write_burst(FIFO, &[7; 700]);
        idle(&mut bus);
        card.snapshot().expect("a snapshot")
    });
    // BUS_REJECTED, the sum of both, is the same too: it is part of the state.
    assert!(states.iter().all(|state| *state == states[0]));
}

#[test]
fn snapshot_after_a_doorbell_over_an_empty_ring_is_the_same_whenever_it_is_heard() {
    let states = [0, 2, 0, 2, 0, 2].map(|milliseconds| {
        let card = card();
        card.bus().write32(DOORBELL, 1);
        std::thread::sleep(Duration::from_millis(milliseconds));
        card.snapshot().expect("a snapshot")
    });
    assert!(states.iter().all(|state| *state == states[0]));
}

#[test]
fn reset_during_a_probed_draw_of_large_triangles_returns_soon() {
    let card = card();
    let mut bus = card.bus();
    bus.write32(WATCHDOG, 0);
    // 512 x 256 pixels; one triangle over all of them, named by indices that are all there is.
    bus.write_burst(MEMORY + 0x4_0000, &corners([(-1.0, -1.0), (1100.0, -1.0), (-1.0, 600.0)]));
    let indices: Vec<u32> = [0, 1, 2].repeat(60_000);
    bus.write_burst(MEMORY + 0x4_1000, &indices);
    begin(&mut bus, 512, 256);
    bus.write_burst(FIFO, &[0x0100_0005, 0x600, 1, 0, 0, 0]);
    bus.write_burst(FIFO, &[0x1100_0005, 0x10, 0x4_0000, 3, 0x4_1000, indices.len() as u32]);
    // Long enough for the card to be in the middle of it.
    std::thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    bus.write32(RESET, 1);
    // 60000 times 131072 pixels are minutes, one by one.
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
    assert_eq!(bus.read32(0), IDENTIFICATION);
}

#[test]
fn draw_large_meshes_in_every_tile_memory_is_given_back() {
    let card = card();
    let mut bus = card.bus();
    begin(&mut bus, 512, 512);
    let indices: Vec<u32> = [0, 1, 2].repeat(36_000);
    bus.write_burst(MEMORY + 0x8_1000, &indices);
    for tile in 0..64 {
        let (x, y) = ((tile % 8 * 64) as f32, (tile / 8 * 64) as f32);
        idle(&mut bus);
        bus.write_burst(MEMORY + 0x8_0000, &corners([(x, y), (x + 2.0, y), (x, y + 2.0)]));
        bus.write_burst(FIFO, &[0x1100_0005, 0x10, 0x8_0000, 3, 0x8_1000, indices.len() as u32]);
    }
    idle(&mut bus);
    // Each draw fills some 6 MiB of bins, in a tile of its own.
    let peak = fuzz::peak_memory().unwrap_or(0);
    assert!(peak < 256 << 20, "{} MiB", peak >> 20);
}

#[test]
fn writers_stalled_at_the_fifo_while_others_reset_all_return() {
    let card = card_with(2);
    let bus = card.bus();
    std::thread::scope(|threads| {
        for _ in 0..2 {
            let mut bus = bus.clone();
            // Opcodes from good to bad: the FIFO fills, halts, and is reset under the writer's hands.
            let words: Vec<u32> = (0..60_000).map(|n| if n % 911 == 0 { 0xEE00_0000 } else { n % 3 }).collect();
            threads.spawn(move || bus.write_burst(FIFO, &words));
        }
        for _ in 0..2 {
            let mut bus = bus.clone();
            let card = &card;
            threads.spawn(move || {
                for _ in 0..300 {
                    bus.write32(RESET, 1);
                    let saved = card.snapshot().expect("a snapshot");
                    card.restore(&saved).expect("the state it was in");
                }
            });
        }
    });
    assert_eq!(fuzz::reference::answers(&card), Ok(()));
}
