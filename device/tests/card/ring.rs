//! The command ring: pointers, wrap, refusals.

use crate::rig::*;
use zga_abi::Bus;

const BASE: u32 = 0x2000;
const SIZE: u32 = 256;

/// A ring of 256 words, and where the driver writes next.
struct RingRig {
    rig: Rig,
    put: u32,
}

impl RingRig {
    fn new() -> RingRig {
        let mut rig = Rig::new();
        rig.write32(RING_BASE, BASE);
        rig.write32(RING_SIZE, SIZE);
        RingRig { rig, put: 0 }
    }

    /// Writes words behind those that are there; the ring wraps.
    fn write(&mut self, words: &[u32]) {
        for &word in words {
            self.rig.write32(MEMORY + BASE + 4 * self.put, word);
            self.put = (self.put + 1) % SIZE;
        }
    }

    fn submit(&mut self) {
        self.rig.write32(RING_PUT, self.put);
        self.rig.write32(DOORBELL, 1);
    }

    fn error(&mut self) -> [u32; 6] {
        self.rig.until(STATUS, 0b10);
        [0x88, 0x8C, 0x90, 0x94, 0x98, 0x9C].map(|offset| self.rig.read32(offset))
    }
}

#[test]
fn submit_round_and_round_every_packet_is_executed_once() {
    let mut ring = RingRig::new();
    for i in 0..200 {
        // 7 words each: the end of the ring cuts packets at every place.
        ring.write(&upload(0x8000 + 8 * i, &[i, i + 1]));
        ring.submit();
        let put = ring.put;
        ring.rig.until(RING_GET, put);
    }
    ring.rig.idle();
    let expected: Vec<u32> = (0..200).flat_map(|i| [i, i + 1]).collect();
    assert_eq!(ring.rig.words(0x8000, 400), expected);
    // frontend.packets
    assert_eq!(ring.rig.read32(0x1038), 200);
}

#[test]
fn submit_full_ring_all_is_executed() {
    let mut ring = RingRig::new();
    ring.write(&no_operation(99));
    ring.submit();
    ring.rig.until(RING_GET, 100);
    ring.write(&no_operation(252));
    ring.write(&fence(1));
    // One word is left: put + 1 = get.
    assert_eq!(ring.put, 99);
    ring.submit();
    ring.rig.until(FENCE_SEQUENCE, 1);
    ring.rig.until(RING_GET, 99);
}

#[test]
fn doorbell_empty_ring_does_nothing() {
    let mut ring = RingRig::new();
    ring.submit();
    ring.rig.idle();
    assert_eq!(ring.rig.read32(RING_GET), 0);
    assert_eq!(ring.rig.read32(ERROR_CODE), 0);
    assert_eq!(ring.rig.read32(0x1038), 0);
}

#[test]
fn put_without_doorbell_is_not_looked_at() {
    let mut ring = RingRig::new();
    ring.write(&fence(4));
    ring.rig.write32(RING_PUT, 2);
    ring.rig.push(&fence(3));
    ring.rig.until(FENCE_SEQUENCE, 3);
    assert_eq!(ring.rig.read32(RING_GET), 0);
    assert_eq!(ring.rig.read32(STATUS), 1);
    ring.rig.write32(DOORBELL, 0);
    ring.rig.until(FENCE_SEQUENCE, 4);
}

#[test]
fn submit_packet_beyond_put_is_truncated() {
    let mut ring = RingRig::new();
    ring.write(&fence(1));
    ring.write(&[0x2000_0008, 1, 2]);
    ring.submit();
    assert_eq!(ring.error(), [4, 1, 2, 0x2000_0008, 0, 0x2000_0008]);
    assert_eq!(ring.rig.read32(FENCE_SEQUENCE), 1);
    assert_eq!(ring.rig.read32(RING_GET), 2);
}

#[test]
fn submit_ring_beyond_memory_is_bad() {
    let mut ring = RingRig::new();
    ring.rig.write32(RING_BASE, 0x000F_F000);
    ring.rig.write32(RING_SIZE, 2048);
    ring.put = 2;
    ring.submit();
    assert_eq!(ring.error(), [5, 1, 0, 0, 0, 0x000F_F000]);
}

#[test]
fn submit_ring_of_a_bad_size_is_bad() {
    let mut ring = RingRig::new();
    ring.rig.write32(RING_SIZE, 300);
    ring.put = 2;
    ring.submit();
    assert_eq!(ring.error(), [5, 1, 0, 0, 0, 300]);
    let mut none = RingRig::new();
    none.rig.write32(RING_SIZE, 0);
    none.put = 1;
    none.submit();
    assert_eq!(none.error(), [5, 1, 0, 0, 0, 0]);
}

#[test]
fn submit_put_outside_the_ring_is_bad() {
    let mut ring = RingRig::new();
    ring.put = 256;
    ring.submit();
    assert_eq!(ring.error(), [5, 1, 0, 0, 0, 256]);
}

#[test]
fn write_base_or_size_sets_both_pointers_to_zero() {
    let mut ring = RingRig::new();
    ring.write(&fence(1));
    ring.submit();
    ring.rig.until(RING_GET, 2);
    ring.rig.write32(RING_BASE, 0x4000);
    assert_eq!((ring.rig.read32(RING_PUT), ring.rig.read32(RING_GET)), (0, 0));
    ring.rig.write_burst(MEMORY + 0x4000, &fence(2));
    ring.rig.write32(RING_PUT, 2);
    ring.rig.write32(DOORBELL, 1);
    ring.rig.until(RING_GET, 2);
    assert_eq!(ring.rig.read32(FENCE_SEQUENCE), 2);
    ring.rig.write32(RING_SIZE, 512);
    assert_eq!((ring.rig.read32(RING_PUT), ring.rig.read32(RING_GET)), (0, 0));
    assert_eq!(ring.rig.read32(RING_BASE), 0x4000);
}

#[test]
fn ring_halted_the_fifo_works_on_until_reset() {
    let mut ring = RingRig::new();
    ring.write(&[0x0F00_0000]);
    ring.write(&fence(1));
    ring.submit();
    assert_eq!(ring.error()[0], 1);
    ring.rig.push(&fence(8));
    ring.rig.until(FENCE_SEQUENCE, 8);
    ring.submit();
    ring.rig.finish(9);
    assert_eq!(ring.rig.read32(RING_GET), 0);
    ring.rig.write32(RESET, 1);
    ring.rig.write32(RING_BASE, BASE);
    ring.rig.write32(RING_SIZE, SIZE);
    ring.put = 0;
    ring.write(&fence(10));
    ring.submit();
    ring.rig.until(FENCE_SEQUENCE, 10);
}
