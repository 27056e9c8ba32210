//! Clears again and again: the host may leave depths alone that already are what a clear writes, and
//! nobody may be able to tell. 16 x 160 pixels, so that the depths lie in three bands of 64 rows.

use crate::rig::*;
use zga_abi::Bus;

const ROWS: u32 = 160;
const DEPTHS: u32 = 0x1_0000;
const FAR: u32 = 0x00FF_FFFF;

/// One scene: both planes cleared, then `draws`.
fn scene(rig: &mut Rig, colour_base: u32, depth_base: u32, value: u32, draws: &[Vec<u32>]) {
    rig.push(&register_write(0x200, &[(ROWS << 16) | 16, colour_base, 64, 0, depth_base, 64]));
    rig.push(&[0x0200_0000]);
    rig.push(&[0x0400_0003, 3, 0xFF00_0000, value]);
    draws.iter().for_each(|draw| rig.push(draw));
    rig.push(&[0x0300_0000]);
}

/// A triangle over rows 0 to 15 at depth 1/2.
fn triangle() -> Vec<u32> {
    let mut packet = vec![0x1000_000F, 0x100, 3, 0];
    for (x, y) in [(0.0, 0.0), (16.0, 0.0), (0.0, 16.0_f32)] {
        packet.extend([f32::to_bits(x), y.to_bits(), 0.5_f32.to_bits(), 0xFF00_00FF]);
    }
    packet
}

fn depths(rig: &mut Rig) -> Vec<u32> {
    rig.words(DEPTHS, (16 * ROWS) as usize)
}

fn assert_cleared(rig: &mut Rig, sequence: u32, value: u32) {
    scene(rig, 0, DEPTHS, value, &[]);
    rig.finish(sequence);
    assert_eq!(rig.read32(ERROR_CODE), 0);
    assert!(depths(rig).iter().all(|&depth| depth == value));
}

#[test]
fn clear_after_a_draw_every_depth_is_far() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    scene(&mut rig, 0, DEPTHS, FAR, &[triangle()]);
    rig.finish(2);
    assert_eq!(depths(&mut rig)[0], 0x0080_0000);
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_to_another_depth_every_depth_follows() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    assert_cleared(&mut rig, 2, 7);
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_after_the_host_wrote_a_depth_every_depth_is_far() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    rig.write32(MEMORY + DEPTHS + 64 * 100, 3);
    assert_cleared(&mut rig, 2, FAR);
    rig.bus.write_burst(MEMORY + DEPTHS + 64 * ROWS - 4, &[3, 3]);
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_after_fill_and_upload_every_depth_is_far() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    rig.push(&fill(DEPTHS + 64 * 70, 64, 3, 2, 9));
    assert_cleared(&mut rig, 2, FAR);
    rig.push(&upload(DEPTHS + 64 * 130, &[1, 2, 3]));
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_after_another_target_lay_over_the_depths_every_depth_is_far() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    // Its frame buffer is the other's Z buffer.
    scene(&mut rig, DEPTHS, 0x4_0000, FAR, &[triangle()]);
    assert_cleared(&mut rig, 2, FAR);
    // Its Z buffer begins one row further on.
    scene(&mut rig, 0x4_0000, DEPTHS + 64, 5, &[]);
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_inside_a_scissor_and_again_every_depth_is_far() {
    let mut rig = Rig::new();
    assert_cleared(&mut rig, 1, FAR);
    rig.push(&register_write(0x290, &[(80 << 16) | 2, (90 << 16) | 5]));
    scene(&mut rig, 0, DEPTHS, 1, &[]);
    rig.push(&register_write(0x290, &[0, 0x7FFF_7FFF]));
    rig.finish(2);
    let inside = depths(&mut rig).iter().filter(|&&depth| depth == 1).count();
    assert_eq!(inside, 30);
    assert_cleared(&mut rig, 3, FAR);
}

#[test]
fn clear_after_reset_and_restore_every_depth_is_far() {
    let mut rig = Rig::new();
    scene(&mut rig, 0, DEPTHS, FAR, &[triangle()]);
    rig.finish(1);
    let drawn = rig.card.snapshot().expect("a card under power");
    assert_cleared(&mut rig, 2, FAR);
    rig.card.restore(&drawn).expect("a snapshot of this card");
    assert_eq!(depths(&mut rig)[0], 0x0080_0000);
    assert_cleared(&mut rig, 3, FAR);
    rig.write32(RESET, 1);
    rig.write32(MEMORY + DEPTHS, 4);
    assert_cleared(&mut rig, 4, FAR);
}

#[test]
fn clear_again_costs_the_card_the_same() {
    let mut rig = Rig::new();
    let mut spent = Vec::new();
    for sequence in 1..=3 {
        rig.write32(0x708, 1);
        assert_cleared(&mut rig, sequence, FAR);
        // cycles.z_buffer, z.writes
        spent.push([rig.read32(0x1018), rig.read32(0x1080)]);
    }
    assert_eq!(spent[0], spent[1]);
    assert_eq!(spent[1], spent[2]);
    assert_eq!(spent[0][1], 16 * ROWS);
}
