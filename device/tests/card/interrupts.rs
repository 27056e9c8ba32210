//! Interrupt lines: fence, enable, acknowledge, wait.

use crate::rig::*;
use std::time::{Duration, Instant};
use zga_abi::Bus;

#[test]
fn fence_interrupt_comes_with_its_number() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 1);
    for sequence in 1..=500 {
        rig.push(&fence(sequence));
        assert_eq!(rig.wait_interrupt(1, LONG), 1);
        assert_eq!(rig.read32(FENCE_SEQUENCE), sequence);
        rig.write32(INTERRUPT_STATUS, 1);
        assert_eq!(rig.read32(INTERRUPT_STATUS), 0);
    }
}

#[test]
fn fence_all_before_it_is_in_memory() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 1);
    for round in 1..=50 {
        rig.push(&fill(0, 4096, 1024, 256, round));
        rig.push(&fence(round));
        assert_eq!(rig.wait_interrupt(1, LONG), 1);
        rig.write32(INTERRUPT_STATUS, 1);
        assert_eq!(rig.words(0x000F_FFFC, 1), [round]);
    }
}

#[test]
fn wait_nothing_happens_times_out_in_time() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 7);
    let start = Instant::now();
    assert_eq!(rig.wait_interrupt(7, Duration::from_millis(30)), 0);
    assert!(start.elapsed() >= Duration::from_millis(30));
    assert_eq!(rig.wait_interrupt(7, Duration::ZERO), 0);
}

#[test]
fn wait_line_not_enabled_does_not_reach_the_host() {
    let mut rig = Rig::new();
    rig.finish(1);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 1);
    assert_eq!(rig.wait_interrupt(7, Duration::from_millis(5)), 0);
    let mut bus = rig.bus.clone();
    let waiter = std::thread::spawn(move || bus.wait_interrupt(7, LONG));
    std::thread::sleep(Duration::from_millis(5));
    rig.write32(INTERRUPT_ENABLE, 1);
    assert_eq!(waiter.join().expect("the waiter returns"), 1);
}

#[test]
fn acknowledge_clears_just_the_lines_written() {
    let mut rig = Rig::new();
    rig.push(&present(0));
    rig.finish(1);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0b011);
    rig.write32(INTERRUPT_STATUS, 0);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0b011);
    rig.write32(INTERRUPT_STATUS, 0b010);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0b001);
    rig.write32(INTERRUPT_STATUS, 0xFFFF_FFF9);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0);
}
