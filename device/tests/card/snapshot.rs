//! Snapshots: round trips in the middle of everything, and bytes that were changed.

use crate::rig::*;
use zga_abi::Bus;
use zga_device::{CardError, Snapshot};

/// A card in the middle of a packet in the FIFO, a scene, a ring that was not rung, and a few results.
fn busy_rig() -> Rig {
    let mut rig = Rig::new();
    rig.write_burst(MEMORY + 0x3000, &noise(5000));
    rig.write32(ZA + 0x100, 77);
    rig.write32(SCRATCH, 0xABCD);
    rig.write32(INTERRUPT_ENABLE, 1);
    rig.write32(0x9000, 0);
    rig.push(&register_write(0x200, &[(16 << 16) | 16, 0, 64, 0, 0x8000, 64]));
    rig.push(&[0x0200_0000]);
    rig.finish(41);
    rig.write_burst(MEMORY + 0x1000, &fence(43));
    rig.write32(RING_BASE, 0x1000);
    rig.write32(RING_SIZE, 256);
    rig.write32(RING_PUT, 2);
    // 4 words of an upload of 3: two are missing.
    rig.push(&[0x2200_0007, 0xA000, 12, 3, 1, 9]);
    rig.until(FIFO_FREE, 1024);
    rig
}

/// The rest of the packet; then what the card does with all it was told.
fn go_on(rig: &mut Rig) -> (Vec<u32>, Vec<u32>) {
    rig.push(&[8, 7]);
    rig.push(&[0x0400_0003, 3, 0x4433_2211, 5, 0x0300_0000]);
    rig.push(&fence(42));
    rig.until(FENCE_SEQUENCE, 42);
    rig.write32(DOORBELL, 1);
    rig.until(FENCE_SEQUENCE, 43);
    rig.idle();
    let registers = (0..0x710).step_by(4).chain((0x1000..0x10C0).step_by(4));
    let registers = registers.filter(|&offset| offset != BUS_FAULT_ADDRESS && offset != BUS_UNMAPPED);
    (registers.map(|offset| rig.read32(offset)).collect(), rig.words(0, 0x1_0000))
}

#[test]
fn restore_another_card_goes_on_as_the_first() {
    let mut first = busy_rig();
    let bytes = first.card.snapshot().expect("a snapshot").to_bytes();
    let snapshot = Snapshot::from_bytes(&bytes).expect("whole bytes");
    let mut second = Rig::new();
    second.write32(MEMORY + 0x9_0000, 1);
    second.push(&[0x7777_7777]);
    second.card.restore(&snapshot).expect("a card of the same sizes");
    assert_eq!(second.read32(STATUS), 0b1001);
    assert_eq!(second.read32(SCRATCH), 0xABCD);
    assert_eq!(second.read32(ZA + 0x100), 77);
    assert_eq!(second.read32(BUS_UNMAPPED), 1);
    assert_eq!(second.wait_interrupt(1, LONG), 1);
    let expected = go_on(&mut first);
    let found = go_on(&mut second);
    assert_eq!(found.0, expected.0, "registers");
    assert!(found.1 == expected.1, "memory");
    assert_eq!(second.words(0xA000, 3), [9, 8, 7]);
}

#[test]
fn restore_the_same_card_goes_back() {
    let mut rig = busy_rig();
    let snapshot = rig.card.snapshot().expect("a snapshot");
    let first = go_on(&mut rig);
    rig.push(&fill(0, 4096, 1024, 256, 0xFFFF_FFFF));
    rig.push(&[0x7777_7777]);
    rig.until(ERROR_CODE, 1);
    rig.card.restore(&snapshot).expect("its own snapshot");
    let second = go_on(&mut rig);
    assert_eq!(first.0, second.0, "registers");
    assert!(first.1 == second.1, "memory");
}

#[test]
fn snapshot_words_queued_in_the_fifo_are_kept() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.push(&present(0));
    rig.until(FIFO_FREE, 1024);
    let stream: Vec<u32> = (0..100).flat_map(|i| upload(0x400 + 4 * i, &[i + 1])).collect();
    rig.push(&stream);
    let snapshot = rig.card.snapshot().expect("a snapshot");
    rig.write32(RESET, 1);
    rig.write_burst(MEMORY + 0x400, &[0; 100]);
    rig.card.restore(&snapshot).expect("its own snapshot");
    rig.finish(1);
    assert_eq!(rig.words(0x400, 100), (1..=100).collect::<Vec<u32>>());
}

#[test]
fn snapshot_packets_seen_in_the_ring_are_done_after_restore() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.write_burst(MEMORY + 0x1000, &[&fence(4)[..], &present(0), &fence(5)].concat());
    rig.write32(RING_BASE, 0x1000);
    rig.write32(RING_SIZE, 256);
    rig.write32(RING_PUT, 6);
    rig.write32(DOORBELL, 1);
    rig.until(FENCE_SEQUENCE, 4);
    // The card answers between two packets: the second fence is not executed yet.
    let snapshot = rig.card.snapshot().expect("a snapshot");
    rig.until(FENCE_SEQUENCE, 5);
    rig.write32(RESET, 1);
    rig.card.restore(&snapshot).expect("its own snapshot");
    rig.until(FENCE_SEQUENCE, 5);
    rig.until(RING_GET, 6);
}

#[test]
fn from_bytes_any_changed_byte_is_refused() {
    let rig = busy_rig();
    let whole = rig.card.snapshot().expect("a snapshot").to_bytes();
    assert!(whole.len() > 20_000, "{} bytes: is memory in them?", whole.len());
    let accepted: Vec<usize> = (0..600)
        .chain((600..whole.len()).step_by(97))
        .filter(|&at| {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            Snapshot::from_bytes(&bytes).is_ok()
        })
        .collect();
    assert_eq!(accepted, [0_usize; 0]);
}

#[test]
fn from_bytes_cut_or_lengthened_is_refused_with_its_place() {
    let rig = busy_rig();
    let whole = rig.card.snapshot().expect("a snapshot").to_bytes();
    let accepted: Vec<usize> =
        (0..whole.len()).step_by(331).filter(|&end| Snapshot::from_bytes(&whole[..end]).is_ok()).collect();
    assert_eq!(accepted, [0_usize; 0]);
    let longer = [&whole[..], &[0]].concat();
    let error = Snapshot::from_bytes(&longer).expect_err("a byte too many");
    assert!(matches!(error, CardError::Damaged { at, .. } if at == whole.len()), "{error}");
    let error = Snapshot::from_bytes(&whole[..10]).expect_err("no version");
    assert!(matches!(error, CardError::Damaged { at: 8, .. }), "{error}");
}

#[test]
fn restore_card_of_other_sizes_is_refused_and_unchanged() {
    let snapshot = Rig::new().card.snapshot().expect("a snapshot");
    let mut larger = Rig::with_memory(2 << 20);
    larger.write32(SCRATCH, 3);
    let error = larger.card.restore(&snapshot).expect_err("other sizes");
    assert_eq!(error.to_string(), "snapshot of a card with 1048576 bytes of video memory, this card has 2097152");
    assert_eq!(larger.read32(SCRATCH), 3);
    larger.finish(1);
}
