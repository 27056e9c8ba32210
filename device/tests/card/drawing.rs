//! What the card adds to its pipeline: geometry registers, watchdog, probe, power.

use crate::rig::*;
use zga_abi::Bus;

/// Bit of EFFECTS.
const STENCIL: u32 = 1 << 11;

/// Opens a scene of 16 x 16 pixels: colours at 0, depths at 0x8000, both cleared.
fn begin(rig: &mut Rig) {
    rig.push(&register_write(0x200, &[(16 << 16) | 16, 0, 64, 0, 0x8000, 64]));
    rig.push(&[0x0200_0000]);
    rig.push(&[0x0400_0003, 3, 0xFF00_0000, 0x00FF_FFFF]);
}

/// A triangle over the pixels left of and above the diagonal of 16 x 16, at a depth, in one colour.
fn triangle(depth: f32, colour: u32) -> Vec<u32> {
    let mut packet = vec![0x1000_000F, 0x100, 3, 0];
    for (x, y) in [(0.0, 0.0), (16.0, 0.0), (0.0, 16.0_f32)] {
        packet.extend([f32::to_bits(x), y.to_bits(), depth.to_bits(), colour]);
    }
    packet
}

#[test]
fn draw_identity_matrices_coordinates_are_pixels() {
    let mut rig = Rig::new();
    begin(&mut rig);
    rig.push(&triangle(0.5, 0xFF00_00FF));
    rig.push(&[0x0300_0000]);
    rig.finish(1);
    assert_eq!(rig.read32(ERROR_CODE), 0);
    let frame = rig.words(0, 256);
    assert_eq!((frame[0], frame[17], frame[255]), (0xFFFF_0000, 0xFFFF_0000, 0xFF00_0000));
    // 0.5 of 2^24 - 1, rounded.
    assert_eq!(rig.words(0x8000, 1), [0x0080_0000]);
    // Scene over: depth was called for; front end, geometry and Z buffer were powered.
    assert_eq!(rig.read32(0x700), 1);
    assert_eq!(rig.read32(0x704), 0b111);
}

#[test]
fn draw_viewport_registers_move_it() {
    let mut rig = Rig::new();
    begin(&mut rig);
    // Offset x, y of the viewport.
    rig.push(&register_write(0x4CC, &[8.0_f32.to_bits(), 4.0_f32.to_bits()]));
    rig.push(&triangle(0.5, 0xFF00_00FF));
    rig.push(&[0x0300_0000]);
    rig.finish(1);
    let frame = rig.words(0, 256);
    assert_eq!([frame[4 * 16 + 7], frame[3 * 16 + 8], frame[4 * 16 + 8]], [0xFF00_0000, 0xFF00_0000, 0xFFFF_0000]);
}

#[test]
fn draw_longer_than_the_watchdog_allows_is_stopped() {
    let mut rig = Rig::with_memory(16 << 20);
    begin(&mut rig);
    // One unit of 2^20 clocks; 600000 points at the origin cost 5 clocks each in geometry alone.
    rig.push(&register_write(WATCHDOG, &[1]));
    rig.push(&[0x1100_0005, 2, 0x0010_0000, 600_000, 0, 0]);
    rig.until(ERROR_CODE, 14);
    assert_eq!(rig.read32(0x8C), 2);
    assert_eq!(rig.read32(0x94), 0x1100_0005);
    let spent = rig.read32(0x1000);
    assert!((1 << 20..3_000_000).contains(&spent), "{spent} clocks");
    // With no limit the same draw goes through.
    rig.write32(RESET, 1);
    begin(&mut rig);
    rig.push(&register_write(WATCHDOG, &[0]));
    rig.push(&[0x1100_0005, 2, 0x0010_0000, 600_000, 0, 0]);
    rig.finish(1);
    assert_eq!(rig.read32(ERROR_CODE), 0);
}

#[test]
fn shadow_longer_than_the_watchdog_allows_is_stopped_between_rows() {
    let mut rig = Rig::with_memory(32 << 20);
    // 2048 x 1024 white pixels, a stencil plane, and all of it in shadow, of which nothing is left.
    rig.push(&register_write(0x200, &[(1024 << 16) | 2048, 0, 8192, 0, 8 << 20, 8192]));
    rig.push(&register_write(0x21C, &[16 << 20, 2048]));
    rig.push(&register_write(0x380, &[0x71, 0]));
    rig.push(&register_write(WATCHDOG, &[1]));
    rig.push(&[0x0200_0000]);
    rig.push(&[0x0400_0003, 3, 0xFFFF_FFFF, 0x00FF_FFFF]);
    rig.push(&register_write(0x280, &[STENCIL | 1]));
    rig.push(&triangle(0.5, 0xFFFF_FFFF));
    rig.push(&[0x0300_0000]);
    rig.until(ERROR_CODE, 14);
    assert_eq!(rig.read32(0x94), 0x0300_0000);
    // 32 + 2048 clocks a row, 64 rows at a time: the limit of 2^20 lies in the eighth 64 rows.
    let column: Vec<u32> = (0..1024).map(|row| rig.words(8192 * row, 1)[0]).collect();
    assert!(column[..512].iter().all(|&pixel| pixel == 0xFF00_0000));
    assert!(column[512..].iter().all(|&pixel| pixel == 0xFFFF_FFFF));
}

#[test]
fn probe_enabled_every_fragment_of_the_pixel_is_recorded() {
    let mut rig = Rig::new();
    rig.push(&register_write(0x600, &[1, (2 << 16) | 3, 0x1_0000, 3]));
    begin(&mut rig);
    rig.push(&register_write(0x28C, &[70]));
    rig.push(&triangle(0.5, 0xFF00_00FF));
    rig.push(&register_write(0x28C, &[71]));
    rig.push(&triangle(0.75, 0xFF00_FF00));
    rig.push(&triangle(0.25, 0xFFFF_0000));
    rig.push(&[0x0300_0000]);
    rig.finish(1);
    assert_eq!(rig.read32(0x610), 4);
    // probe.fragments
    assert_eq!(rig.read32(0x10B0), 3);
    let clear = [0, 0, 0x0003_0000, 0x00FF_FFFF, 0, 0xFF00_0000, 0, 0];
    let nearer = [0, 70, 0x0003_0101, 0x0080_0000, 0x00FF_FFFF, 0xFF00_00FF, 0, 0];
    let farther = [0, 71, 0x0000_0101, 0x00BF_FFFF, 0x0080_0000, 0xFF00_FF00, 1, 0];
    let records = rig.words(0x1_0000, 32);
    assert_eq!(records[..8], clear);
    assert_eq!(records[8..16], nearer);
    assert_eq!(records[16..24], farther);
    // There was room for 3.
    assert_eq!(records[24..], [0; 8]);
}

#[test]
fn probe_enabled_again_counts_from_zero() {
    let mut rig = Rig::new();
    rig.write32(0x604, (2 << 16) | 3);
    rig.write32(0x600, 1);
    begin(&mut rig);
    rig.finish(1);
    assert_eq!(rig.read32(0x610), 1);
    rig.write32(0x600, 1);
    assert_eq!(rig.read32(0x610), 1);
    rig.write32(0x600, 0);
    rig.write32(0x600, 1);
    assert_eq!(rig.read32(0x610), 0);
}

#[test]
fn reset_during_a_long_draw_returns_soon() {
    let mut rig = Rig::with_memory(64 << 20);
    begin(&mut rig);
    let draw = [0x1100_0005, 2, 0x0010_0000, 5_000_000, 0, 0];
    rig.push(&draw.repeat(40));
    rig.write32(RESET, 1);
    assert_eq!(rig.read32(STATUS), 0);
    assert_eq!(rig.read32(0x1000), 0);
    rig.finish(1);
}
