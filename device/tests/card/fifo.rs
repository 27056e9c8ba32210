//! The PIO FIFO: order, stall, halt.

use crate::rig::*;
use std::time::{Duration, Instant};
use zga_abi::Bus;

#[test]
fn push_many_packets_they_are_executed_in_order() {
    let mut rig = Rig::new();
    // Each round overwrites word 0 and copies it to a place of its own.
    let stream: Vec<u32> = (0..2000)
        .flat_map(|i| {
            let mut packets = upload(0, &[i ^ 0x5A5A]);
            packets.extend([0x2300_0005, 0, 4, 1, 1, 64 + 4 * i]);
            packets
        })
        .collect();
    rig.push(&stream);
    rig.finish(1);
    let expected: Vec<u32> = (0..2000).map(|i| i ^ 0x5A5A).collect();
    assert_eq!(rig.words(64, 2000), expected);
}

#[test]
fn push_anywhere_in_the_window_counts_as_the_next_word() {
    let mut rig = Rig::new();
    rig.write32(FIFO + 0xFFC, 0x3000_0001);
    rig.write32(FIFO + 0x10, 33);
    rig.until(FENCE_SEQUENCE, 33);
    // A burst stays inside the window although its addresses would leave it.
    rig.write_burst(FIFO + 0xFFC, &[0x3000_0001, 34, 0x3000_0001, 35]);
    rig.until(FENCE_SEQUENCE, 35);
    assert_eq!(rig.read32(BUS_UNMAPPED), 0);
}

#[test]
fn free_while_the_card_waits_is_the_room_left() {
    let mut rig = Rig::new();
    assert_eq!(rig.read32(FIFO_FREE), 1024);
    rig.slow_blanks();
    rig.push(&present(0));
    rig.until(FIFO_FREE, 1024);
    rig.push(&[0; 10]);
    assert_eq!(rig.read32(FIFO_FREE), 1014);
    assert_eq!(rig.read32(STATUS) & 1, 1);
    rig.push(&[0; 1014]);
    assert_eq!(rig.read32(FIFO_FREE), 0);
    rig.write32(RESET, 1);
    assert_eq!(rig.read32(FIFO_FREE), 1024);
    rig.idle();
}

#[test]
fn push_into_a_full_fifo_stalls_and_loses_nothing() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    let start = Instant::now();
    rig.push(&present(0));
    let mut bus = rig.bus.clone();
    let writer = std::thread::spawn(move || {
        let stream: Vec<u32> = (0..3000).flat_map(|i| upload(4 * i, &[i + 1])).collect();
        bus.write_burst(FIFO, &stream);
        Instant::now()
    });
    rig.until(FIFO_FREE, 0);
    std::thread::sleep(Duration::from_millis(20));
    let stalled = !writer.is_finished();
    assert!(stalled || start.elapsed() > Duration::from_secs(1));
    writer.join().expect("the writer comes through");
    rig.finish(1);
    assert_eq!(rig.words(0, 3000), (1..=3000).collect::<Vec<u32>>());
}

#[test]
fn push_half_a_packet_the_ring_works_on() {
    let mut rig = Rig::new();
    rig.push(&[0x2200_0008, 0, 16]);
    rig.write_burst(MEMORY + 0x1000, &fence(5));
    rig.write32(RING_BASE, 0x1000);
    rig.write32(RING_SIZE, 256);
    rig.write32(RING_PUT, 2);
    rig.write32(DOORBELL, 1);
    rig.until(FENCE_SEQUENCE, 5);
    rig.push(&[4, 1, 1, 2, 3, 4]);
    rig.finish(6);
    assert_eq!(rig.words(0, 4), [1, 2, 3, 4]);
}

#[test]
fn push_after_an_error_is_rejected_and_counted() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.push(&present(0));
    rig.until(FIFO_FREE, 1024);
    // An opcode that does not exist, then 7 words that are in the FIFO when it is refused.
    rig.push(&[0x7700_0000, 0, 0, 0, 0, 0, 0, 0]);
    rig.until(ERROR_CODE, 1);
    until(|| rig.read32(BUS_REJECTED) == 7);
    rig.push(&fence(9));
    assert_eq!(rig.read32(BUS_REJECTED), 9);
    assert_eq!(rig.read32(STATUS) & 0b100, 0b100);
    assert_eq!(rig.read32(FIFO_FREE), 1024);
    assert_eq!(rig.read32(FENCE_SEQUENCE), 0);
}

#[test]
fn error_while_a_writer_is_stalled_lets_it_go_and_counts_every_word() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.push(&present(0));
    rig.push(&[0x7700_0000]);
    let mut bus = rig.bus.clone();
    let writer = std::thread::spawn(move || bus.write_burst(FIFO, &[0; 20_000]));
    writer.join().expect("the writer comes through");
    until(|| rig.read32(BUS_REJECTED) == 20_000);
    rig.write32(RESET, 1);
    rig.finish(3);
    assert_eq!(rig.read32(BUS_REJECTED), 0);
}
