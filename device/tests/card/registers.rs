//! The register file: reset values, masks, kinds of access, accesses that nothing answers.

use crate::rig::*;
use std::collections::BTreeMap;
use zga_abi::Bus;
use zga_device::{Card, CardError, CardOptions};

/// Offset, reset value, and what reads back after writing all ones, of every register that holds a value.
const READ_WRITE: &[(u32, u32, u32)] = &[
    (0x48, 0x0001_0000, 0xFFFF_FFFF),
    (0x4C, 0, 0xFFFF_FFFF),
    (0x84, 0, 0x7),
    (0x100, 0, 0xFFFF_F000),
    (0x104, 0, 0x001F_FFFF),
    (0x108, 0, 0x000F_FFFF),
    (0x200, 0, 0x7FFF_7FFF),
    (0x204, 0, 0xFFFF_FFC0),
    (0x208, 0, 0x000F_FFC0),
    (0x20C, 0, 0x3),
    (0x210, 0, 0xFFFF_FFC0),
    (0x214, 0, 0x000F_FFC0),
    (0x218, 0x1818, 0x1F1F),
    (0x240, 0, 0x3),
    (0x244, 8, 0xF),
    (0x248, 0, 0x1),
    (0x24C, 0x0001_0020, 0x7FFF_7FFF),
    (0x250, 0, 0x103),
    (0x254, 0, 0x01FF_FFC0),
    (0x258, 0, 0xF),
    (0x25C, 0x0008_0008, 0x007F_007F),
    (0x260, 0, 0x3),
    (0x264, 1, 0x3),
    (0x268, 0, 0x1),
    (0x26C, 0x0010_0000, 0x001F_FFFF),
    (0x280, 1, 0xFFF),
    (0x284, 0x101, 0x107),
    (0x288, 0xFFFF_FFFF, 0xFFFF_FFFF),
    (0x28C, 0, 0xFFFF_FFFF),
    (0x290, 0, 0x7FFF_7FFF),
    (0x294, 0x7FFF_7FFF, 0x7FFF_7FFF),
    (0x298, 0x100, 0xFFFF),
    (0x29C, 0x100, 0xFFFF),
    (0x400, 0x3F80_0000, 0xFFFF_FFFF),
    (0x404, 0, 0xFFFF_FFFF),
    (0x43C, 0x3F80_0000, 0xFFFF_FFFF),
    (0x454, 0x3F80_0000, 0xFFFF_FFFF),
    (0x4A8, 0x3F80_0000, 0xFFFF_FFFF),
    (0x4C8, 0x3F80_0000, 0xFFFF_FFFF),
    (0x4CC, 0, 0xFFFF_FFFF),
    (0x4D4, 0, 0xFFFF_FFFF),
    (0x600, 0, 1),
    (0x604, 0, 0x7FFF_7FFF),
    (0x608, 0, 0xFFFF_FFC0),
    (0x60C, 0, 0x00FF_FFFF),
    (0x680, 0, 1),
    (0x684, 16_667, 0x001F_FFFF),
    (0x688, 0, 0xFFFF_FFC0),
    (0x68C, 0, 0x000F_FFC0),
    (0x690, 0, 0x3),
    (0x694, 0, 0x7FFF_7FFF),
];

/// Offset and value after power-on of registers that can only be read.
const READ_ONLY: &[(u32, u32)] = &[
    (0x00, 0x5A47_4131),
    (0x04, 0x0001_0000),
    (0x0C, 0xF),
    (0x10, 0x0010_0000),
    (0x14, 0x0001_0000),
    (0x18, 1024),
    (0x88, 0),
    (0x8C, 0),
    (0x90, 0),
    (0x94, 0),
    (0x98, 0),
    (0x9C, 0),
    (0xA0, 0),
    (0xA4, 0),
    (0xA8, 0),
    (0xAC, 0),
    (0xB0, 0),
    (0xC0, 1024),
    (0x10C, 0),
    (0x140, 0),
    (0x610, 0),
    (0x698, 0),
    (0x700, 0),
    (0x704, 0),
    (0x1000, 0),
    (0x13FC, 0),
];

#[test]
fn power_on_every_register_has_its_reset_value() {
    let mut rig = Rig::new();
    let expected: BTreeMap<u32, u32> =
        READ_WRITE.iter().map(|&(offset, reset, _)| (offset, reset)).chain(READ_ONLY.iter().copied()).collect();
    let found: BTreeMap<u32, u32> = expected.keys().map(|&offset| (offset, rig.read32(offset))).collect();
    assert_eq!(found, expected);
}

#[test]
fn write_ones_changes_just_the_writable_bits() {
    let mut rig = Rig::new();
    let written: Vec<_> = READ_WRITE
        .iter()
        .map(|&(offset, reset, _)| {
            rig.write32(offset, 0xFFFF_FFFF);
            let ones = rig.read32(offset);
            rig.write32(offset, reset);
            (offset, rig.read32(offset), ones)
        })
        .collect();
    assert_eq!(written, READ_WRITE);
    assert_eq!(rig.read32(BUS_READ_ONLY), 0);
}

#[test]
fn write_read_only_register_is_ignored_and_counted() {
    let mut rig = Rig::new();
    rig.write32(0x00, 1);
    rig.write32(FRAME_COUNT, 1);
    rig.write32(0x1008, 1);
    assert_eq!(rig.read32(0x00), 0x5A47_4131);
    assert_eq!(rig.read32(FRAME_COUNT), 0);
    assert_eq!(rig.read32(0x1008), 0);
    assert_eq!(rig.read32(BUS_READ_ONLY), 3);
    assert_eq!(rig.read32(BUS_FAULT_ADDRESS), 0x1008);
    assert_eq!(rig.read32(BUS_UNMAPPED), 0);
}

#[test]
fn read_write_only_register_gives_zero() {
    let mut rig = Rig::new();
    rig.write32(DOORBELL, 0xFFFF_FFFF);
    assert_eq!([RESET, DOORBELL, 0x708].map(|offset| rig.read32(offset)), [0, 0, 0]);
    assert_eq!(rig.read32(BUS_UNMAPPED), 0);
}

#[test]
fn access_where_nothing_is_floats_and_is_counted() {
    let mut rig = Rig::new();
    let holes = [0x1C, 0x7FFC, 0x1400, FIFO, 0x9000, 0x0400_0000, MEMORY + 0x0010_0000, ZA + 0x1_0000, 0x8000_0000];
    let floating = holes.map(|address| rig.read32(address));
    assert_eq!(floating, [0xFFFF_FFFF; 9]);
    assert_eq!(rig.read32(BUS_UNMAPPED), 9);
    rig.write32(0x9000, 1);
    rig.write32(MEMORY + 0x3FFF_FFFC, 1);
    rig.write32(0x44C0, 1);
    assert_eq!(rig.read32(BUS_UNMAPPED), 12);
    assert_eq!(rig.read32(BUS_FAULT_ADDRESS), 0x44C0);
}

#[test]
fn access_misaligned_is_ignored_and_counted() {
    let mut rig = Rig::new();
    rig.write32(SCRATCH, 5);
    rig.write32(SCRATCH + 2, 6);
    rig.write32(FIFO + 1, 0xFFFF_FFFF);
    assert_eq!(rig.read32(MEMORY + 3), 0xFFFF_FFFF);
    assert_eq!(rig.read32(SCRATCH), 5);
    assert_eq!(rig.read32(BUS_MISALIGNED), 3);
    assert_eq!(rig.read32(BUS_FAULT_ADDRESS), MEMORY + 3);
    rig.finish(1);
    assert_eq!(rig.read32(ERROR_CODE), 0);
}

#[test]
fn burst_over_the_end_of_memory_keeps_what_fits_and_counts_the_rest() {
    let mut rig = Rig::new();
    rig.write_burst(MEMORY + 0x000F_FFF8, &[11, 12, 13, 14, 15]);
    assert_eq!(rig.read32(BUS_UNMAPPED), 3);
    assert_eq!(rig.read32(BUS_FAULT_ADDRESS), MEMORY + 0x0010_0008);
    let mut words = [0; 4];
    rig.read_burst(MEMORY + 0x000F_FFF8, &mut words);
    assert_eq!(words, [11, 12, 0xFFFF_FFFF, 0xFFFF_FFFF]);
    assert_eq!(rig.read32(BUS_UNMAPPED), 5);
}

#[test]
fn burst_over_registers_writes_each() {
    let mut rig = Rig::new();
    let matrix: Vec<u32> = (100..116).collect();
    rig.write_burst(0x440, &matrix);
    let mut read = [0; 16];
    rig.read_burst(0x440, &mut read);
    assert_eq!(read[..], matrix[..]);
    assert_eq!(rig.read32(0x43C), 0x3F80_0000);
    assert_eq!(rig.read32(0x480), 0x3F80_0000);
}

#[test]
fn za_ram_holds_words_and_ends() {
    let mut rig = Rig::new();
    assert_eq!(rig.read32(ZA + 0x8000), 0);
    rig.write_burst(ZA + 0xFFF8, &[1, 2, 3]);
    assert_eq!(rig.read32(ZA + 0xFFFC), 2);
    assert_eq!(rig.read32(ZA + 0x8000), 0);
    assert_eq!(rig.read32(BUS_UNMAPPED), 1);
}

#[test]
fn reset_sets_registers_and_keeps_both_memories() {
    let mut rig = Rig::new();
    rig.write32(SCRATCH, 99);
    rig.write32(MEMORY + 64, 0xCAFE);
    rig.write32(ZA + 64, 0xBEEF);
    rig.write32(0x9000, 0);
    rig.finish(17);
    rig.write32(RESET, 0);
    assert_eq!(rig.read32(SCRATCH), 99);
    rig.write32(RESET, 1);
    assert_eq!(rig.read32(SCRATCH), 0);
    assert_eq!(rig.read32(BUS_UNMAPPED), 0);
    assert_eq!(rig.read32(FENCE_SEQUENCE), 0);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0);
    assert_eq!(rig.read32(0x1000), 0);
    assert_eq!(rig.read32(MEMORY + 64), 0xCAFE);
    assert_eq!(rig.read32(ZA + 64), 0xBEEF);
    assert_eq!(rig.read32(0x00), 0x5A47_4131);
    assert_eq!(rig.read32(0x10), 0x0010_0000);
}

#[test]
fn power_on_bad_sizes_are_refused() {
    let power_on = |video_memory, za_ram| {
        Card::power_on(CardOptions { video_memory, za_ram, ..CardOptions::default() })
            .map(|_| ())
            .map_err(|e| e.to_string())
    };
    let message = power_on(0x0010_0001, 0).expect_err("not a multiple of 4096");
    assert_eq!(message, CardError::VideoMemory { bytes: 0x0010_0001 }.to_string());
    assert!(power_on(0x000F_F000, 0).is_err());
    assert!(power_on(0x4000_1000, 0).is_err());
    assert!(power_on(0x0010_0000, 0x0200_1000).is_err());
    assert!(power_on(0x0010_0000, 0x0200_0000).is_ok());
}

#[test]
fn power_off_reads_float_and_waits_return() {
    let Rig { card, mut bus } = Rig::new();
    drop(card);
    assert_eq!(bus.read32(0x00), 0xFFFF_FFFF);
    bus.write32(SCRATCH, 1);
    bus.write32(RESET, 1);
    bus.write_burst(FIFO, &[0; 5000]);
    assert_eq!(bus.wait_interrupt(7, LONG), 0);
    assert_eq!(bus.read32(MEMORY), 0xFFFF_FFFF);
}
