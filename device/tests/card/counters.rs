//! Counters and cycle accounts, with the clocks that the units' headers state.

use crate::rig::*;
use zga_abi::Bus;

const TOTAL: u32 = 0x1000;
const FRONTEND: u32 = 0x1008;
const BITMAP: u32 = 0x1028;
const SCANOUT: u32 = 0x1030;
const PACKETS: u32 = 0x1038;
const WORDS: u32 = 0x1040;
const FENCES: u32 = 0x1048;
const BITMAP_PIXELS: u32 = 0x1098;
const SCANOUT_FRAMES: u32 = 0x10A0;
const SCANOUT_PIXELS: u32 = 0x10A8;

impl Rig {
    fn counters<const N: usize>(&mut self, offsets: [u32; N]) -> [u32; N] {
        offsets.map(|offset| self.read32(offset))
    }
}

#[test]
fn packets_cost_a_clock_a_word() {
    let mut rig = Rig::new();
    rig.push(&no_operation(9));
    rig.push(&no_operation(0));
    rig.finish(1);
    assert_eq!(rig.counters([PACKETS, WORDS, FENCES, FRONTEND, TOTAL]), [3, 13, 1, 13, 13]);
    assert_eq!(rig.counters([BITMAP, SCANOUT]), [0, 0]);
}

#[test]
fn fence_counters_are_up_to_date_while_the_card_is_at_work() {
    let mut rig = Rig::new();
    rig.slow_blanks();
    rig.push(&[&no_operation(4)[..], &fence(1), &present(0)].concat());
    rig.until(FENCE_SEQUENCE, 1);
    assert_eq!(rig.counters([PACKETS, WORDS, FENCES, FRONTEND]), [2, 7, 1, 7]);
}

#[test]
fn fill_costs_a_clock_a_line_written() {
    let mut rig = Rig::new();
    // 20 words from byte 60 on touch 3 lines of 64 bytes, in each of 3 rows.
    rig.push(&[0x2000_0008, 0, 4096, 0, 15, 0, 20, 3, 1]);
    rig.finish(1);
    assert_eq!(rig.counters([BITMAP, BITMAP_PIXELS]), [9, 60]);
    assert_eq!(rig.counters([TOTAL, FRONTEND]), [20, 11]);
}

#[test]
fn copy_and_transfers_cost_a_clock_a_line_read_and_a_line_written() {
    let mut rig = Rig::new();
    // 16 pixels of 2 bytes: half a line, twice.
    rig.push(&[0x2100_000B, 2, 0, 4096, 0, 0, 0x8000, 4096, 0, 0, 16, 2]);
    rig.finish(1);
    assert_eq!(rig.counters([BITMAP, BITMAP_PIXELS]), [4, 32]);
    rig.push(&upload(60, &[1, 2]));
    rig.finish(2);
    assert_eq!(rig.counters([BITMAP, BITMAP_PIXELS]), [6, 34]);
    // 4 rows of 8 words, 4 lines apart, to 128 bytes in one run.
    rig.push(&[0x2300_0005, 0, 256, 8, 4, 0x9000]);
    rig.finish(3);
    assert_eq!(rig.counters([BITMAP, BITMAP_PIXELS]), [12, 66]);
}

#[test]
fn scan_out_costs_a_clock_a_pixel_whether_or_not_anybody_looks() {
    let mut rig = Rig::new();
    rig.show(0, 256, 0, 40, 10);
    rig.push(&present(0));
    rig.finish(1);
    assert_eq!(rig.counters([SCANOUT, SCANOUT_FRAMES, SCANOUT_PIXELS]), [400, 1, 400]);
    let _monitor = rig.card.monitor();
    rig.push(&present(0));
    rig.push(&write_back(0x8000));
    rig.finish(2);
    assert_eq!(rig.counters([SCANOUT, SCANOUT_FRAMES, SCANOUT_PIXELS]), [1200, 3, 1200]);
}

#[test]
fn clear_sets_every_counter_to_zero() {
    let mut rig = Rig::new();
    rig.push(&fill(0, 4096, 16, 16, 1));
    rig.finish(1);
    rig.write32(0x708, 0);
    assert_eq!(rig.counters([FRONTEND, BITMAP]), [11, 16]);
    rig.write32(0x708, 1);
    assert_eq!(rig.counters([TOTAL, FRONTEND, BITMAP, PACKETS, WORDS, FENCES, BITMAP_PIXELS]), [0; 7]);
    rig.finish(2);
    assert_eq!(rig.counters([TOTAL, PACKETS]), [2, 1]);
}

#[test]
fn units_powered_follow_the_packets() {
    let mut rig = Rig::new();
    rig.finish(1);
    assert_eq!(rig.read32(0x704), 0);
    rig.push(&fill(0, 4096, 1, 1, 1));
    rig.finish(2);
    assert_eq!(rig.read32(0x704), 0b0010_0000_0001);
    rig.push(&present(0));
    rig.finish(3);
    assert_eq!(rig.read32(0x704), 0b0110_0000_0001);
}
