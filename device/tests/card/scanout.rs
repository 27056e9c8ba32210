//! Scan-out: presents, vertical blanks, frames on the cable, write back.

use crate::rig::*;
use std::time::{Duration, Instant};
use zga_abi::Bus;

#[test]
fn present_on_demand_is_a_vertical_blank_at_once() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 2);
    rig.show(0, 256, 0, 4, 2);
    rig.push(&present(0x400));
    assert_eq!(rig.wait_interrupt(2, LONG), 2);
    assert_eq!(rig.read32(FRAME_COUNT), 1);
    assert_eq!(rig.read32(SCANOUT_BASE), 0x400);
    rig.push(&present(0x400));
    rig.until(FRAME_COUNT, 2);
}

#[test]
fn present_monitor_shows_the_pixels() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    assert!(monitor.latest().is_none());
    rig.write_burst(MEMORY + 0x400, &[0x0011_2233, 0x8044_5566, 0xFF77_8899]);
    rig.write_burst(MEMORY + 0x440, &[1, 2, 3]);
    rig.show(0, 64, 0, 3, 2);
    rig.push(&present(0x400));
    let frame = monitor.wait_next(LONG).expect("a frame");
    assert_eq!((frame.width(), frame.height(), frame.number()), (3, 2, 1));
    let expected = [0xFF11_2233, 0xFF44_5566, 0xFF77_8899, 0xFF00_0001, 0xFF00_0002, 0xFF00_0003];
    assert_eq!(frame.pixels(), expected);
    assert!(monitor.wait_next(Duration::from_millis(5)).is_none());
    assert_eq!(monitor.latest(), Some(frame));
}

#[test]
fn present_565_is_widened() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    // Red 31, green 63, blue 31; red 1, green 1, blue 1 (bits 11, 5, 0); red 16, green 32, blue 16.
    rig.write_burst(MEMORY, &[0x0821_FFFF, 0x0000_8410]);
    rig.show(0, 64, 2, 3, 1);
    rig.push(&present(0));
    let frame = monitor.wait_next(LONG).expect("a frame");
    assert_eq!(frame.pixels(), [0xFFFF_FFFF, 0xFF08_0408, 0xFF84_8284]);
}

#[test]
fn present_nothing_changed_frames_share_their_pixels() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    rig.show(0, 256, 0, 64, 64);
    rig.push(&present(0));
    let first = monitor.wait_next(LONG).expect("a frame");
    rig.push(&present(0));
    let second = monitor.wait_next(LONG).expect("a frame");
    assert!(first.shares_pixels(&second));
    assert_eq!((first.number(), second.number()), (1, 2));
    rig.write32(MEMORY + 4, 0x00FF_0000);
    rig.push(&present(0));
    let third = monitor.wait_next(LONG).expect("a frame");
    assert!(!second.shares_pixels(&third));
    assert_eq!((second.pixels()[1], third.pixels()[1]), (0xFF00_0000, 0xFFFF_0000));
}

#[test]
fn present_many_frames_each_shows_its_own_picture() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    rig.show(0, 256, 0, 64, 64);
    let mut held = Vec::new();
    for colour in 1..=20 {
        rig.push(&fill(0, 256, 64, 64, colour));
        rig.push(&present(0));
        held.push(monitor.wait_next(LONG).expect("a frame"));
    }
    let shown: Vec<u32> = held.iter().map(|frame| frame.pixels()[4095] & 0xFFFF).collect();
    assert_eq!(shown, (1..=20).collect::<Vec<u32>>());
}

#[test]
fn present_dark_or_impossible_screen_counts_but_shows_nothing() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    rig.push(&present(0));
    rig.until(FRAME_COUNT, 1);
    assert!(monitor.wait_next(Duration::from_millis(5)).is_none());
    rig.show(0, 64, 0, 64, 64);
    rig.push(&present(0));
    rig.until(ERROR_CODE, 7);
    assert_eq!(rig.read32(FRAME_COUNT), 1);
}

#[test]
fn continuous_blanks_come_by_themselves_and_survive_bad_registers() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 2);
    rig.write32(SCANOUT_PERIOD, 0);
    rig.write32(SCANOUT_CONTROL, 1);
    let start = Instant::now();
    until(|| rig.read32(FRAME_COUNT) >= 20);
    // The least period is 1 ms.
    assert!(start.elapsed() >= Duration::from_millis(15), "{:?}", start.elapsed());
    assert_eq!(rig.wait_interrupt(2, LONG), 2);
    let _monitor = rig.card.monitor();
    for (base, pitch, format, size) in [(0xFFFF_FFC0, 0x000F_FFC0, 0, 0x7FFF_7FFF), (0, 0, 3, 0x0001_0001)] {
        rig.show(base, pitch, format, size & 0x7FFF, size >> 16);
        let count = rig.read32(FRAME_COUNT);
        until(|| rig.read32(FRAME_COUNT).wrapping_sub(count) >= 3);
    }
    rig.write32(SCANOUT_CONTROL, 0);
    rig.finish(1);
    let count = rig.read32(FRAME_COUNT);
    std::thread::sleep(Duration::from_millis(10));
    assert_eq!(rig.read32(FRAME_COUNT), count);
}

#[test]
fn continuous_monitor_gets_a_frame_only_when_something_changed() {
    let mut rig = Rig::new();
    rig.show(0x1000, 64, 0, 4, 4);
    rig.write32(SCANOUT_PERIOD, 1000);
    rig.write32(SCANOUT_CONTROL, 1);
    until(|| rig.read32(FRAME_COUNT) >= 2);
    let mut monitor = rig.card.monitor();
    assert!(monitor.wait_next(LONG).is_some(), "a monitor plugged in late sees the picture");
    assert!(monitor.wait_next(Duration::from_millis(20)).is_none());
    rig.write32(MEMORY + 0x2000, 1);
    assert!(monitor.wait_next(Duration::from_millis(20)).is_none(), "memory that is not shown");
    rig.write32(MEMORY + 0x1000, 0x0000_00AB);
    let frame = monitor.wait_next(LONG).expect("a frame");
    assert_eq!(frame.pixels()[0], 0xFF00_00AB);
}

#[test]
fn continuous_monitor_plugged_in_again_sees_the_picture_again() {
    let mut rig = Rig::new();
    rig.show(0x1000, 64, 0, 4, 4);
    rig.write32(SCANOUT_PERIOD, 1000);
    rig.write32(SCANOUT_CONTROL, 1);
    let first = rig.card.monitor().wait_next(LONG).expect("a frame");
    until(|| rig.read32(FRAME_COUNT) >= first.number() as u32 + 3);
    let again = rig.card.monitor().wait_next(LONG).expect("the same picture");
    assert!(again.number() > first.number());
    assert!(again.shares_pixels(&first));
}

#[test]
fn continuous_present_waits_for_the_blank_and_leaves_memory_alone() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    let start = Instant::now();
    rig.push(&present(0x40));
    rig.push(&fence(1));
    rig.until(FIFO_FREE, 1022);
    rig.write32(MEMORY, 5);
    assert_eq!(rig.read32(MEMORY), 5);
    assert!(start.elapsed() < Duration::from_millis(900), "memory was held: {:?}", start.elapsed());
    assert_eq!(rig.read32(SCANOUT_BASE), 0);
    assert_eq!(rig.read32(FENCE_SEQUENCE), 0);
    rig.until(FENCE_SEQUENCE, 1);
    assert!(start.elapsed() >= Duration::from_millis(500));
    assert_eq!(rig.read32(SCANOUT_BASE), 0x40);
    assert!(rig.read32(FRAME_COUNT) >= 1);
}

#[test]
fn reset_ends_the_wait_for_a_blank() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    let start = Instant::now();
    rig.push(&present(0));
    rig.until(FIFO_FREE, 1024);
    rig.write32(RESET, 1);
    assert!(start.elapsed() < Duration::from_millis(800), "{:?}", start.elapsed());
    rig.finish(1);
    assert_eq!(rig.read32(FRAME_COUNT), 0);
}

#[test]
fn write_back_is_dense_rows_of_the_frame_shown() {
    let mut rig = Rig::new();
    rig.write_burst(MEMORY + 0x1000, &[0x001F_F800, 0x0000_07E0]);
    rig.write_burst(MEMORY + 0x1040, &[0xFFFF_FFFF, 0x0000_FFFF]);
    rig.show(0x1000, 64, 2, 3, 2);
    rig.push(&write_back(0x4004));
    rig.finish(1);
    let expected = [0, 0xFFFF_0000, 0xFF00_00FF, 0xFF00_FF00, 0xFFFF_FFFF, 0xFFFF_FFFF, 0xFFFF_FFFF, 0];
    assert_eq!(rig.words(0x4000, 8), expected);
    assert_eq!(rig.read32(FRAME_COUNT), 0);
}

#[test]
fn power_off_monitor_keeps_the_frame_and_stops_waiting() {
    let mut rig = Rig::new();
    let mut monitor = rig.card.monitor();
    rig.show(0, 64, 0, 1, 1);
    rig.push(&present(0));
    let frame = monitor.wait_next(LONG).expect("a frame");
    drop(rig);
    assert!(monitor.wait_next(LONG).is_none());
    assert_eq!(monitor.latest(), Some(frame));
}
