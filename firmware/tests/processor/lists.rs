//! FILL_LIST, COPY_LIST, SEGMENTS, EXPAND.

use crate::bench::Bench;
use crate::mock::{Call, MEMORY};
use zga_abi::FaultCode::{self, BadAlignment, BadLength, BadValue, OutOfMemory};

/// base, pitch, format, size, operation, planes, origin, clips, value, a clip box, a rectangle
const FILL_LIST: [u32; 13] = [0x1000, 256, 0, 0x0014_000A, 6, 0xFF, 0, 1, 5, 0, 0x0014_000A, 0x0001_0001, 0x0002_0002];
/// The same, source base, pitch, size, offset x, offset y, a clip box, a rectangle
const COPY_LIST: [u32; 17] = [
    0x1000,
    256,
    2,
    0x0014_000A,
    3,
    0xFF,
    0,
    1,
    0x8000,
    64,
    0x0008_0010,
    3,
    0xFFFF_FFFF,
    0,
    0x0014_000A,
    0x0001_0001,
    0x0002_0002,
];
/// The same, value, flags, a clip box, a segment
const SEGMENTS: [u32; 14] =
    [0x1000, 256, 3, 0x0014_000A, 6, 0xFF, 0, 1, 5, 1, 0, 0x0014_000A, 0x0001_0001, 0x0002_0002];
/// The same, foreground, background, flags, a clip box, a bitmap of 33 x 1 pixels
const EXPAND: [u32; 17] =
    [0x1000, 256, 0, 0x0014_000A, 6, 0xFF, 0, 1, 5, 6, 1, 0, 0x0014_000A, 0x0001_0001, 0x0001_0021, 7, 8];

/// Each case: word, value put there, fault, word that the fault names (0: the header).
fn each_fault<const N: usize>(opcode: u32, right: [u32; N], cases: &[(usize, u32, FaultCode, u32)]) {
    assert!(matches!(Bench::new().last(opcode, &right), Call::List(_)));
    for &(word, value, code, at_fault) in cases {
        let mut payload = right;
        payload[word - 1] = value;
        let found = if at_fault == 0 { opcode << 24 | N as u32 } else { payload[at_fault as usize - 1] };
        Bench::new().bad(opcode, &payload, code, at_fault, found);
    }
}

/// Faults that all lists have.
const COMMON: [(usize, u32, FaultCode, u32); 11] = [
    (1, MEMORY - 64, OutOfMemory, 1),
    (1, 0xFFFF_FF00, OutOfMemory, 1),
    (2, 8, BadValue, 2), // a row is at least 10 pixels
    (2, 0xFFFF_FF00, OutOfMemory, 1),
    (3, 4, BadValue, 3),
    (4, 0x0000_000A, BadValue, 4),
    (4, 0x0014_0000, BadValue, 4),
    (4, 0x4001_0001, BadValue, 4),
    (5, 16, BadValue, 5),
    (8, 0x7FFF_FFFF, BadLength, 0),
    (8, 0xFFFF_FFFF, BadLength, 0),
];

#[test]
fn fill_list_each_word_at_fault_is_named() {
    each_fault(0x28, FILL_LIST, &COMMON);
    each_fault(0x28, FILL_LIST, &[(1, 0x1002, BadAlignment, 1), (2, 258, BadAlignment, 2)]);
    Bench::new().bad(0x28, &FILL_LIST[..12], BadLength, 0, 0x2800_000C);
}

#[test]
fn copy_list_each_word_at_fault_is_named() {
    each_fault(0x29, COPY_LIST, &COMMON);
    let cases = [
        (9, MEMORY, OutOfMemory, 9),
        (9, 0x8001, BadAlignment, 9),
        (10, 30, BadValue, 10),
        (11, 0, BadValue, 11),
        (12, 65536, BadValue, 12),
        (13, 0x8000_0000, BadValue, 13),
    ];
    each_fault(0x29, COPY_LIST, &cases);
    Bench::new().bad(0x29, &COPY_LIST[..16], BadLength, 0, 0x2900_0010);
}

#[test]
fn segments_each_word_at_fault_is_named() {
    each_fault(0x2A, SEGMENTS, &COMMON);
    each_fault(0x2A, SEGMENTS, &[(10, 4, BadValue, 10)]);
    Bench::new().bad(0x2A, &SEGMENTS[..13], BadLength, 0, 0x2A00_000D);
}

#[test]
fn segments_of_a_strip_can_be_an_odd_number_of_points() {
    let mut strip = SEGMENTS;
    strip[9] = 2;
    assert!(matches!(Bench::new().last(0x2A, &strip[..13]), Call::List(_)));
}

#[test]
fn expand_each_word_at_fault_is_named() {
    each_fault(0x2B, EXPAND, &COMMON);
    let cases = [(11, 2, BadValue, 11), (15, 0x0001_0020, BadLength, 0), (15, 0xFFFF_FFFF, BadLength, 0)];
    each_fault(0x2B, EXPAND, &cases);
    Bench::new().bad(0x2B, &EXPAND[..16], BadLength, 0, 0x2B00_0010);
}

#[test]
fn lists_that_change_nothing_call_no_unit() {
    // No-operation; no plane of the format; no entry; no clip box.
    let mut unchanging = vec![FILL_LIST.to_vec(); 4];
    unchanging[0][4] = 5;
    unchanging[1][2] = 3;
    unchanging[1][5] = 0xFFFF_FF00;
    unchanging[2].truncate(11);
    unchanging[3][7] = 0;
    for payload in unchanging {
        let mut bench = Bench::new();
        bench.good(0x28, &payload);
        assert_eq!(bench.card.units.bits(), 0, "{payload:x?}");
    }
}
