//! Several host threads and the card's own: arbitration, waiting, loss of power.

use crate::rig::*;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use zga_abi::Bus;

#[test]
fn burst_while_the_card_fills_is_never_torn() {
    let mut rig = Rig::new();
    let done = AtomicBool::new(false);
    let mut reader = rig.bus.clone();
    let mixed = std::thread::scope(|threads| {
        let reader = threads.spawn(|| {
            let mut words = vec![0; 0x1_0000];
            let (mut mixed, mut seen) = (0, BTreeSet::new());
            until(|| {
                reader.read_burst(MEMORY, &mut words);
                mixed += u32::from(words.iter().any(|&word| word != words[0]));
                seen.insert(words[0]);
                seen.len() > 50
            });
            done.store(true, Ordering::SeqCst);
            mixed
        });
        for round in 1.. {
            rig.push(&fill(0, 4096, 1024, 64, round));
            if done.load(Ordering::SeqCst) {
                break;
            }
        }
        reader.join().expect("the reader ends")
    });
    assert_eq!(mixed, 0);
    rig.finish(1);
}

#[test]
fn burst_written_while_the_card_copies_is_never_torn() {
    let mut rig = Rig::new();
    let mut writer = rig.bus.clone();
    let torn = std::thread::scope(|threads| {
        threads.spawn(move || {
            for round in 0..300 {
                writer.write_burst(MEMORY, &vec![round; 0x4000]);
            }
        });
        // 64 KiB to a second place, compared there.
        let mut torn = 0;
        for round in 1..=100 {
            rig.push(&[0x2100_000B, 0, 0, 4096, 0, 0, 0x8_0000, 4096, 0, 0, 1024, 16]);
            rig.finish(round);
            let copy = rig.words(0x8_0000, 0x4000);
            torn += u32::from(copy.iter().any(|&word| word != copy[0]));
        }
        torn
    });
    assert_eq!(torn, 0);
}

#[test]
fn host_gets_memory_while_the_card_never_rests() {
    let mut rig = Rig::new();
    // 7000 fills of half of memory without a pause: a tenth of a second or more.
    let stream = fill(0, 4096, 1024, 128, 1).repeat(7000);
    rig.write_burst(MEMORY + 0x8_0000, &stream);
    rig.write_burst(MEMORY + 0x8_0000 + 4 * stream.len() as u32, &fence(1));
    rig.write32(RING_BASE, 0x8_0000);
    rig.write32(RING_SIZE, 0x1_0000);
    rig.write32(RING_PUT, stream.len() as u32 + 2);
    rig.write32(DOORBELL, 1);
    until(|| rig.read32(RING_GET) > 0);
    let reads = (0..20).map(|at| rig.read32(MEMORY + 4 * at)).filter(|&word| word == 1).count();
    assert_eq!((reads, rig.read32(FENCE_SEQUENCE)), (20, 0));
    rig.until(FENCE_SEQUENCE, 1);
}

#[test]
fn power_off_stalled_writer_returns() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.push(&present(0));
    let mut bus = rig.bus.clone();
    let writer = std::thread::spawn(move || bus.write_burst(FIFO, &[0; 100_000]));
    rig.until(FIFO_FREE, 0);
    drop(rig);
    writer.join().expect("the writer returns");
}

#[test]
fn power_off_waiting_driver_returns() {
    let rig = Rig::new();
    let mut bus = rig.bus.clone();
    let waiter = std::thread::spawn(move || bus.wait_interrupt(7, Duration::MAX));
    std::thread::sleep(Duration::from_millis(5));
    drop(rig);
    assert_eq!(waiter.join().expect("the waiter returns"), 0);
}

#[test]
fn power_off_at_work_ends_soon() {
    for _ in 0..20 {
        let mut rig = Rig::new();
        rig.push(&fill(0, 4096, 1024, 256, 1).repeat(100));
    }
}

#[test]
fn reset_from_several_threads_at_work_all_return() {
    let mut rig = Rig::new();
    std::thread::scope(|threads| {
        for _ in 0..3 {
            let mut bus = rig.bus.clone();
            threads.spawn(move || {
                for _ in 0..50 {
                    bus.write_burst(FIFO, &no_operation(3).repeat(20));
                    bus.write32(RESET, 1);
                }
            });
        }
    });
    rig.write32(RESET, 1);
    rig.finish(1);
    assert_eq!(rig.read32(STATUS), 0);
}
