//! COMPOSE.

use crate::bench::Bench;
use crate::mock::{Call, MEMORY};
use zga_abi::FaultCode::{self, BadAlignment, BadLength, BadValue, OutOfMemory};

/// A destination of 10 x 20 argb8888, an rgb565 source through an alpha8 mask, transformed; a clip box, a rectangle.
fn right() -> Vec<u32> {
    let head = [0x1000, 256, 1, 0x0014_000A, 3, 0, 0, 1];
    let source = [2, 2, 1, 0x8000, 64, 0x0008_0010, 3, 0xFFFF_FFFF, 0, 0, 0, 0, 0, 0];
    let mask = [3, 3, 0, 0xA001, 17, 0x0008_0010, 0, 0, 0x7FFF_FFFF, 0x8000_0000, 1, 2, 3, 4];
    [&head[..], &source, &mask, &[0, 0x0014_000A, 0x0001_0001, 0x0002_0002]].concat()
}

/// A source colour through masks of 5 x 2 alpha8 and 1 x 1.
fn inline() -> Vec<u32> {
    let mut words = right();
    words[8..22].copy_from_slice(&[1, 99, 99, 0x8040_2010, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99]);
    words[22..36].copy_from_slice(&[4, 3, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99]);
    words.truncate(38);
    words.extend([0x0001_0001, 0x0002_0005, 1, 2, 3, 4, 0, 0x0001_0001, 5]);
    words
}

/// Each case: word, value put there, fault, word that the fault names (0: the header).
fn each_fault(payload: &[u32], cases: &[(usize, u32, FaultCode, u32)]) {
    assert!(matches!(Bench::new().last(0x2C, payload), Call::List(_)));
    for &(word, value, code, at_fault) in cases {
        let mut payload = payload.to_vec();
        payload[word - 1] = value;
        let found = if at_fault == 0 { 0x2C00_0000 | payload.len() as u32 } else { payload[at_fault as usize - 1] };
        Bench::new().bad(0x2C, &payload, code, at_fault, found);
    }
}

#[test]
fn compose_each_word_at_fault_is_named() {
    let cases = [
        (1, MEMORY - 64, OutOfMemory, 1),
        (1, 0x1002, BadAlignment, 1),
        (2, 8, BadValue, 2),
        (2, 258, BadAlignment, 2),
        (3, 6, BadValue, 3),
        (4, 0x0000_000A, BadValue, 4),
        (5, 13, BadValue, 5),
        (6, 2, BadValue, 6),
        (8, 0x7FFF_FFFF, BadLength, 0),
        (9, 0, BadValue, 9), // no source
        (9, 4, BadValue, 9), // an inline source
        (9, 5, BadValue, 9),
        (10, 6, BadValue, 10),
        (11, 4, BadValue, 11),
        (12, 0x8001, BadAlignment, 12),
        (12, MEMORY, OutOfMemory, 12),
        (13, 30, BadValue, 13),
        (14, 0, BadValue, 14),
        (15, 65536, BadValue, 15),
        (16, 0x8000_0000, BadValue, 16),
        (23, 5, BadValue, 23),
        (24, 7, BadValue, 24),
        (25, 0xFFFF_FFFF, BadValue, 25),
        (26, 0x1000 + 19 * 256 + 39, BadValue, 26), // the destination's last byte
        (26, MEMORY, OutOfMemory, 26),
        (27, 15, BadValue, 27),
        (28, 0x4001_0001, BadValue, 28),
        (29, 0xFFFE_FFFF, BadValue, 29),
    ];
    each_fault(&right(), &cases);
    let whole = right();
    Bench::new().bad(0x2C, &whole[..39], BadLength, 0, 0x2C00_0027);
    Bench::new().bad(0x2C, &whole[..35], BadLength, 0, 0x2C00_0023);
}

#[test]
fn compose_components_need_a_mask() {
    let mut payload = right();
    payload[5] = 1;
    assert!(matches!(Bench::new().last(0x2C, &payload), Call::List(_)));
    payload[22] = 0;
    Bench::new().bad(0x2C, &payload, BadValue, 6, 1);
}

#[test]
fn compose_inline_entries_have_all_their_rows() {
    let cases = [
        (24, 0, BadValue, 24), // xrgb8888 is no mask
        (40, 0x0002_0009, BadLength, 0),
        (40, 0xFFFF_FFFF, BadLength, 0),
        (24, 1, BadLength, 0), // as argb8888 the rows are longer
    ];
    each_fault(&inline(), &cases);
    let whole = inline();
    Bench::new().bad(0x2C, &whole[..whole.len() - 1], BadLength, 0, 0x2C00_0000 | (whole.len() as u32 - 1));
}

#[test]
fn compose_that_changes_nothing_calls_no_unit() {
    // The operator destination; no entry; no clip box.
    let mut unchanging = vec![right(); 3];
    unchanging[0][4] = 2;
    unchanging[1].truncate(38);
    unchanging[2][7] = 0;
    for payload in unchanging {
        let mut bench = Bench::new();
        bench.good(0x2C, &payload);
        assert_eq!(bench.card.units.bits(), 0, "{payload:x?}");
    }
}
