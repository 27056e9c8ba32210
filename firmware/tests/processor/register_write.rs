//! REGISTER_WRITE.

use crate::bench::Bench;
use crate::mock::Call;
use zga_abi::FaultCode;

#[test]
fn register_write_row_writes_rising_words_in_order() {
    let mut bench = Bench::new();
    let values: Vec<u32> = (100..116).collect();
    let calls = bench.good(0x01, &[&[0x0400], &values[..]].concat());
    let expected: Vec<_> = (0..16).map(|k| Call::SetRegister(0x0400 + 4 * k, 100 + k)).collect();
    assert_eq!(calls, expected);
}

#[test]
fn register_write_across_registers_that_touch_writes_them_all() {
    let calls = Bench::new().good(0x01, &[0x0048, 1, 2]);
    let expected = [Call::SetRegister(0x0048, 1), Call::SetRegister(0x004C, 2)];
    assert_eq!(calls, expected);
}

#[test]
fn register_write_bits_outside_the_mask_keep_their_value() {
    let mut bench = Bench::new();
    bench.card.set(0x0208, 0x8000_0001);
    let call = bench.last(0x01, &[0x0208, 0x7FFF_FFFE]);
    assert_eq!(call, Call::SetRegister(0x0208, 0x800F_FFC1));
}

#[test]
fn register_write_outside_the_open_ranges_is_a_bad_register() {
    // IDENTIFICATION, RESET, STATUS, INTERRUPT_ENABLE, RING_BASE, DOORBELL, COUNTER_CONTROL, COUNTERS.
    for offset in [0x0000, 0x0040, 0x0044, 0x0084, 0x0100, 0x0110, 0x0708, 0x1000] {
        Bench::new().bad(0x01, &[offset, 0], FaultCode::BadRegister, 1, offset);
    }
}

#[test]
fn register_write_to_read_only_registers_is_a_bad_register() {
    // PROBE_COUNT, FRAME_COUNT.
    for offset in [0x0610, 0x0698] {
        Bench::new().bad(0x01, &[offset, 0], FaultCode::BadRegister, 1, offset);
    }
}

#[test]
fn register_write_where_no_register_is_or_between_words_is_a_bad_register() {
    for offset in [0x0224, 0x06FC, 0x0201, 0x0402, 0x8000, 0xFFFF_FFFC, 0xFFFF_FFFF] {
        Bench::new().bad(0x01, &[offset, 0], FaultCode::BadRegister, 1, offset);
    }
}

#[test]
fn register_write_that_runs_into_a_gap_names_the_value_and_writes_nothing() {
    // 0x0220 is the last register of its group.
    let payload = [0x021C, 0, 64, 0];
    Bench::new().bad(0x01, &payload, FaultCode::BadRegister, 4, 0x0224);
    // 0x0050 is no register, and beyond the range.
    Bench::new().bad(0x01, &[0x0048, 0, 0, 0], FaultCode::BadRegister, 4, 0x0050);
}

#[test]
fn register_write_longest_packet_from_the_end_of_the_address_space_is_refused() {
    let mut payload = vec![0; 0x000F_FFFF];
    payload[0] = 0xFFFF_FFF0;
    Bench::new().bad(0x01, &payload, FaultCode::BadRegister, 1, 0xFFFF_FFF0);
}

#[test]
fn register_write_values_without_a_meaning_are_refused() {
    let cases = [
        (0x020C, 3),      // COLOUR_FORMAT
        (0x0690, 3),      // SCANOUT_FORMAT
        (0x0218, 0x1811), // DEPTH_FORMAT: 17 bits
        (0x0218, 0x0418), // DEPTH_FORMAT: 4 fraction bits
        (0x0244, 0),      // SUBPIXEL_BITS
        (0x0244, 5),
        (0x0264, 3), // SUBPIXEL_DEPTH
        (0x026C, 0), // SUBPIXEL_POOL
        (0x026C, 0x0010_0001),
        (0x0298, 0), // LINE_WIDTH
        (0x0298, 0x0001_0000),
        (0x029C, 0),           // POINT_SIZE
        (0x0304, 0x0000_0001), // TEXTURE_SIZE: no rows
        (0x0304, 0x0001_0000),
        (0x0304, 0x4001_0001),
        (0x0304, 0x0001_4001),
        (0x0308, 0x0000_0100), // TEXTURE_CONTROL: no level
        (0x0308, 0x0001_0106), // format
        (0x0308, 0x0001_0107),
        (0x0308, 0x0001_0130), // filter
        (0x030C, 0x4001_0000), // TEXTURE_OFFSET
        (0x0310, 0x0000_4001), // TEXTURE_WINDOW
        (0x0324, 4),           // BLEND_CONTROL
        (0x0330, 5),           // FOG_CONTROL
        (0x0334, 0xBF80_0000), // FOG_DENSITY: -1
        (0x0334, 0x7F80_0000),
        (0x0338, 0),           // FOG_END
        (0x0338, 0x8000_0001), // less than 0 by the least
        (0x0338, 0x7FC0_0000),
        (0x033C, 0xFF80_0000), // DEPTH_CUE_SCALE
        (0x0340, 0x7FC0_0000), // DEPTH_CUE_OFFSET
        (0x0358, 0x101),       // LIGHT_COUNT
        (0x0368, 0x4300_0001), // MATERIAL_SHININESS: over 128 by the least
        (0x0368, 0xBF80_0000),
        (0x0368, 0x7FC0_0000),
    ];
    for (offset, value) in cases {
        Bench::new().bad(0x01, &[offset, value], FaultCode::BadValue, 2, value);
    }
}

#[test]
fn register_write_value_at_fault_is_shown_as_it_stands_in_the_packet() {
    Bench::new().bad(0x01, &[0x020C, 0xFFFF_FFFF], FaultCode::BadValue, 2, 0xFFFF_FFFF);
}

#[test]
fn register_write_every_enumerated_value_is_taken() {
    let depth_formats = [0x0010, 0x0810, 0x1010, 0x1810, 0x0018, 0x1818, 0x001F, 0x181F];
    let mut cases: Vec<_> = depth_formats.map(|value| (0x0218, value)).to_vec();
    cases.extend((0..3).flat_map(|value| [(0x020C, value), (0x0690, value)]));
    cases.extend((0..4).map(|value| (0x0240, value)));
    cases.extend([(0x0244, 4), (0x0244, 8)]);
    cases.extend((0..4).map(|value| (0x0260, value)));
    cases.extend((0..3).map(|value| (0x0264, value)));
    cases.extend((0..2).map(|value| (0x0268, value)));
    cases.extend([(0x026C, 1), (0x026C, 0x0010_0000)]);
    cases.extend((0..2).map(|value| (0x0270, value)));
    cases.extend([(0x0304, 0x0001_0001), (0x0304, 0x4000_4000), (0x030C, 0x4000_4000), (0x0310, 0)]);
    cases.extend((0..6).map(|format| (0x0308, 0x000F_F100 | format)));
    cases.extend((0..3).map(|filter| (0x0308, 0x0001_0000 | filter << 4)));
    cases.extend((0..4).map(|function| (0x0308, 0x0001_0000 | function << 8)));
    cases.extend((0..4).map(|mode| (0x0324, mode)));
    cases.extend((0..5).map(|function| (0x0330, function)));
    cases.extend([(0x0334, 0), (0x0334, 0x7F7F_FFFF), (0x0338, 1), (0x0338, 0x7F7F_FFFF)]);
    cases.extend([(0x033C, 0xFF7F_FFFF), (0x0340, 0x8000_0000), (0x0358, 0x100)]);
    cases.extend([(0x0368, 0), (0x0368, 0x4300_0000), (0x0320, 0xFF), (0x0318, 0xFFFF)]);
    cases.extend([(0x0298, 1), (0x0298, 0xFFFF), (0x029C, 1), (0x029C, 0xFFFF)]);
    for (offset, value) in cases {
        let call = Bench::new().last(0x01, &[offset, value]);
        assert_eq!(call, Call::SetRegister(offset, value));
    }
}

#[test]
fn register_write_what_the_card_has_no_unit_for_is_unsupported() {
    let mut bench = Bench::new();
    bench.card.set(0x0008, 0x00F);
    bench.card.set(0x000C, 0b0101);
    bench.bad(0x01, &[0x0280, 0x010], FaultCode::Unsupported, 2, 0x010);
    bench.bad(0x01, &[0x0240, 1], FaultCode::Unsupported, 2, 1);
    bench.bad(0x01, &[0x0240, 3], FaultCode::Unsupported, 2, 3);
    assert_eq!(bench.good(0x01, &[0x0240, 2]).len(), 1);
    assert_eq!(bench.good(0x01, &[0x0280, 0x00F]).len(), 1);
}

#[test]
fn register_write_with_a_bad_value_behind_good_ones_writes_none() {
    let mut bench = Bench::new();
    let payload = [0x0200, 0x0020_0040, 0x1000, 0x100, 3];
    bench.bad(0x01, &payload, FaultCode::BadValue, 5, 3);
    assert_eq!(bench.card.get(0x0200), 0);
    assert_eq!(bench.card.get(0x0204), 0);
}

#[test]
fn register_write_in_a_scene_is_legal_and_leaves_the_target_alone() {
    let mut bench = Bench::in_scene();
    let before = bench.processor.target().copied();
    bench.good(0x01, &[0x0200, 0x0001_0001]);
    assert_eq!(bench.processor.target().copied(), before);
}
