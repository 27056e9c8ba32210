//! Refused packets: what the registers tell, and what happens after a reset.

use crate::rig::*;
use zga_abi::Bus;

const ERROR_REGISTERS: [u32; 6] = [0x88, 0x8C, 0x90, 0x94, 0x98, 0x9C];

#[test]
fn bad_packet_in_the_fifo_interrupt_tells_which_and_why() {
    let mut rig = Rig::new();
    rig.write32(INTERRUPT_ENABLE, 4);
    rig.push(&no_operation(4));
    rig.push(&fence(1));
    // The fill reaches beyond the 1 MiB of memory: 256 rows of 4096 bytes from 64 on.
    rig.push(&fill(64, 4096, 1024, 256, 1));
    assert_eq!(rig.wait_interrupt(7, LONG), 4);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 0b101);
    let error = ERROR_REGISTERS.map(|offset| rig.read32(offset));
    assert_eq!(error, [8, 2, 7, 0x2000_0008, 1, 64]);
    assert_eq!(rig.words(64, 1), [0]);
    rig.write32(INTERRUPT_STATUS, 4);
    assert_eq!(rig.read32(INTERRUPT_STATUS), 1);
}

#[test]
fn bad_packet_then_reset_the_card_works_and_memory_is_kept() {
    let mut rig = Rig::new();
    rig.push(&fill(0, 4096, 1024, 16, 0x0BAD_CAFE));
    rig.push(&[0x1000_0000]);
    rig.until(ERROR_CODE, 3);
    rig.write32(RESET, 1);
    assert_eq!(ERROR_REGISTERS.map(|offset| rig.read32(offset)), [0; 6]);
    assert_eq!(rig.read32(STATUS) & 0b1110, 0);
    rig.push(&fill(0, 4096, 1, 1, 7));
    rig.finish(2);
    assert_eq!(rig.words(0, 3), [7, 0x0BAD_CAFE, 0x0BAD_CAFE]);
}

#[test]
fn bad_packets_in_both_sources_the_first_is_told() {
    let mut rig = Rig::new();
    rig.push(&[0x00F0_0000]);
    rig.until(ERROR_CODE, 2);
    rig.write32(INTERRUPT_STATUS, 4);
    rig.write32(RING_BASE, 0x1000);
    rig.write32(RING_SIZE, 256);
    rig.write32(MEMORY + 0x1000, 0xFF00_0000);
    rig.write32(RING_PUT, 1);
    rig.write32(DOORBELL, 1);
    rig.until(INTERRUPT_STATUS, 4);
    rig.until(STATUS, 0b110);
    assert_eq!(ERROR_REGISTERS.map(|offset| rig.read32(offset)), [2, 2, 0, 0x00F0_0000, 0, 0x00F0_0000]);
}

#[test]
fn reset_inside_a_scene_ends_it() {
    let mut rig = Rig::new();
    let target = [(64 << 16) | 64, 0, 256, 0, 0x8000, 256];
    rig.push(&register_write(0x200, &target));
    rig.push(&[0x0200_0000]);
    rig.finish(1);
    assert_eq!(rig.read32(STATUS), 0b1000);
    rig.write32(RESET, 1);
    assert_eq!(rig.read32(STATUS) & 0b1000, 0);
    rig.push(&[0x0300_0000]);
    rig.until(ERROR_CODE, 10);
}
