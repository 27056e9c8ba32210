//! FILL, COPY, UPLOAD, DOWNLOAD, FILL_ROP, COPY_ROP, CONVERT, STRETCH.

use crate::bench::Bench;
use crate::mock::{Call, MEMORY};
use zga_abi::FaultCode::{self, BadAlignment, BadLength, BadValue, OutOfMemory, Overlap};
use zga_abi::format::{BitmapFormat, PixelFormat, RasterOperation, StretchFilter};
use zga_firmware::checked::{Combine, CombineSource, Convert, Copy, Fill, Image, Rows, Stretch, Surface};

/// base, pitch, format, x, y, width, height, value
const FILL: [u32; 8] = [0x1000, 256, 0, 2, 3, 10, 20, 0xAABB_CCDD];
/// format, source base, pitch, x, y, destination base, pitch, x, y, width, height
const COPY: [u32; 11] = [2, 0x1000, 128, 2, 3, 0x8000, 64, 4, 5, 10, 20];
/// address, pitch, words, rows, six words
const UPLOAD: [u32; 10] = [0x1004, 12, 3, 2, 1, 2, 3, 4, 5, 6];
/// address, pitch, words, rows, destination
const DOWNLOAD: [u32; 5] = [0x1004, 16, 3, 2, 0x8004];
/// base, pitch, format, x, y, width, height, value, operation, planes
const FILL_ROP: [u32; 10] = [0x1000, 256, 0, 2, 3, 10, 20, 0xAABB_CCDD, 6, 0xFFFF_0000];
/// format, source base, pitch, x, y, destination base, pitch, x, y, width, height, operation, planes
const COPY_ROP: [u32; 13] = [2, 0x1000, 128, 2, 3, 0x8000, 64, 4, 5, 10, 20, 7, 0xFFFF_FF0F];
/// source format, base, pitch, x, y, destination format, base, pitch, x, y, width, height
const CONVERT: [u32; 12] = [2, 0x1000, 128, 2, 3, 1, 0x8000, 64, 4, 5, 10, 20];
/// filter, source format, base, pitch, x, y, width, height, destination format, base, pitch, x, y, width, height,
/// whole width, height, part x, y
const STRETCH: [u32; 19] = [1, 2, 0x1000, 128, 2, 3, 8, 9, 1, 0x8000, 64, 4, 5, 10, 20, 40, 30, 29, 9];

/// The payload with one word changed; `word` counts the header.
fn with<const N: usize>(payload: [u32; N], word: usize, value: u32) -> [u32; N] {
    let mut changed = payload;
    changed[word - 1] = value;
    changed
}

/// Each case: word, value put there, fault, word that the fault names, by the value there.
fn each_fault<const N: usize>(opcode: u32, right: [u32; N], cases: &[(usize, u32, FaultCode, u32)]) {
    for &(word, value, code, at_fault) in cases {
        let payload = with(right, word, value);
        Bench::new().bad(opcode, &payload, code, at_fault, payload[at_fault as usize - 1]);
    }
}

/// What the firmware makes of a raster operation.
fn combined<const N: usize>(opcode: u32, payload: [u32; N]) -> Combine {
    match Bench::new().last(opcode, &payload) {
        Call::Combine(combine) => combine,
        other => panic!("{other:?}"),
    }
}

#[test]
fn fill_folds_the_place_into_the_base() {
    let surface =
        Surface { base: 0x1000 + 3 * 256 + 2 * 4, pitch: 256, width: 10, height: 20, format: PixelFormat::Xrgb8888 };
    let fill = Fill { surface, value: 0xAABB_CCDD };
    assert_eq!(Bench::new().last(0x20, &FILL), Call::Fill(fill));
}

#[test]
fn fill_each_word_at_fault_is_named() {
    let cases = [
        (1, 0x1002, BadAlignment, 1),
        (1, MEMORY - 64, OutOfMemory, 1),
        (1, 0xFFFF_FFFC, OutOfMemory, 1),
        (2, 258, BadAlignment, 2),
        (2, 44, BadValue, 2), // 2 + 10 pixels are 48 bytes
        (3, 3, BadValue, 3),
        (3, 0xFFFF_FFFF, BadValue, 3),
        (4, 0xFFFF_FFFF, BadValue, 2), // beyond the row
        (5, 0xFFFF_FFFF, OutOfMemory, 1),
        (6, 16385, BadValue, 6),
        (6, 0xFFFF_FFFF, BadValue, 6),
        (7, 16385, BadValue, 7),
        (7, 16384, OutOfMemory, 1),
    ];
    for (word, value, code, at_fault) in cases {
        let payload = with(FILL, word, value);
        let found = payload[at_fault as usize - 1];
        Bench::new().bad(0x20, &payload, code, at_fault, found);
    }
}

#[test]
fn fill_with_huge_pitch_and_row_does_not_wrap_into_memory() {
    let payload = [0, 0xFFFF_FFFC, 0, 0, 0xFFFF_FFFF, 1, 16384, 0];
    Bench::new().bad(0x20, &payload, OutOfMemory, 1, 0);
}

#[test]
fn fill_up_to_the_last_pixel_is_legal_and_one_further_is_not() {
    // Two rows of two pixels; the last row ends where memory ends.
    let base = MEMORY - 256 - 8;
    let payload = [base, 256, 0, 0, 0, 2, 2, 0];
    Bench::new().good(0x20, &payload);
    Bench::new().bad(0x20, &with(payload, 4, 1), OutOfMemory, 1, base);
}

#[test]
fn fill_of_sixteen_bit_pixels_is_aligned_to_two() {
    let payload = [0x1002, 66, 2, 1, 1, 3, 3, 0xBEEF];
    let call = Bench::new().last(0x20, &payload);
    let surface = Surface { base: 0x1002 + 66 + 2, pitch: 66, width: 3, height: 3, format: PixelFormat::Rgb565 };
    let fill = Fill { surface, value: 0xBEEF };
    assert_eq!(call, Call::Fill(fill));
    Bench::new().bad(0x20, &with(payload, 1, 0x1001), BadAlignment, 1, 0x1001);
    Bench::new().bad(0x20, &with(payload, 2, 65), BadAlignment, 2, 65);
}

#[test]
fn empty_rectangles_and_blocks_are_legal_nothings() {
    let mut bench = Bench::new();
    assert_eq!(bench.good(0x20, &with(FILL, 6, 0)), []);
    assert_eq!(bench.good(0x20, &with(FILL, 7, 0)), []);
    assert_eq!(bench.good(0x20, &[0xFFFF_FFFC, 0, 0, 9, 9, 0, 9, 0]), []);
    assert_eq!(bench.good(0x21, &with(COPY, 10, 0)), []);
    assert_eq!(bench.good(0x21, &with(COPY, 11, 0)), []);
    assert_eq!(bench.good(0x22, &[0x1000, 64, 0, 5]), []);
    assert_eq!(bench.good(0x22, &[0x1000, 64, 0xFFFF_FFFF, 0]), []);
    assert_eq!(bench.good(0x23, &with(DOWNLOAD, 3, 0)), []);
    assert_eq!(bench.good(0x23, &with(DOWNLOAD, 4, 0)), []);
}

#[test]
fn copy_folds_both_places_into_the_bases() {
    let surface = |base, pitch| Surface { base, pitch, width: 10, height: 20, format: PixelFormat::Rgb565 };
    let copy = Copy { source: surface(0x1000 + 3 * 128 + 4, 128), destination: surface(0x8000 + 5 * 64 + 8, 64) };
    assert_eq!(Bench::new().last(0x21, &COPY), Call::Copy(copy));
}

#[test]
fn copy_onto_itself_is_legal() {
    let payload = [0, 0x1000, 256, 0, 0, 0x1000, 256, 1, 1, 10, 20];
    assert!(matches!(Bench::new().last(0x21, &payload), Call::Copy(_)));
}

#[test]
fn copy_each_word_at_fault_is_named() {
    let cases = [
        (1, 3, BadValue, 1),
        (2, 0x1001, BadAlignment, 2),
        (2, MEMORY, OutOfMemory, 2),
        (3, 127, BadAlignment, 3),
        (3, 22, BadValue, 3),
        (5, 0xFFFF_FFFF, OutOfMemory, 2),
        (6, 0x8001, BadAlignment, 6),
        (6, MEMORY, OutOfMemory, 6),
        (7, 63, BadAlignment, 7),
        (7, 26, BadValue, 7),
        (9, 0xFFFF_FFFF, OutOfMemory, 6),
        (10, 16385, BadValue, 10),
        (11, 16385, BadValue, 11),
    ];
    for (word, value, code, at_fault) in cases {
        let payload = with(COPY, word, value);
        let found = payload[at_fault as usize - 1];
        Bench::new().bad(0x21, &payload, code, at_fault, found);
    }
}

#[test]
fn upload_hands_over_the_words() {
    let rows = Rows { address: 0x1004, pitch: 12, words: 3, rows: 2 };
    let call = Bench::new().last(0x22, &UPLOAD);
    assert_eq!(call, Call::Upload(rows, vec![1, 2, 3, 4, 5, 6]));
}

#[test]
fn upload_of_another_length_than_its_rows_is_a_bad_length() {
    let mut bench = Bench::new();
    bench.bad(0x22, &UPLOAD[..9], BadLength, 0, 0x2200_0009);
    bench.bad(0x22, &with(UPLOAD, 3, 4), BadLength, 0, 0x2200_000A);
    // 2^16 * 2^16 is 0 in 32 bits.
    let wraps = [0x1000, 0, 0x1_0000, 0x1_0000];
    bench.bad(0x22, &wraps, BadLength, 0, 0x2200_0004);
    bench.bad(0x22, &[0x1000, 4, 0, 1, 9], BadLength, 0, 0x2200_0005);
}

#[test]
fn upload_each_word_at_fault_is_named() {
    let cases = [
        (1, 0x1002, BadAlignment, 1),
        (1, MEMORY - 20, OutOfMemory, 1),
        (2, 14, BadAlignment, 2),
        (2, 8, BadValue, 2),
        (2, 0xFFFF_FFFC, OutOfMemory, 1),
    ];
    for (word, value, code, at_fault) in cases {
        let payload = with(UPLOAD, word, value);
        let found = payload[at_fault as usize - 1];
        Bench::new().bad(0x22, &payload, code, at_fault, found);
    }
}

#[test]
fn upload_of_one_row_needs_no_pitch() {
    let rows = Rows { address: MEMORY - 8, pitch: 0, words: 2, rows: 1 };
    let call = Bench::new().last(0x22, &[MEMORY - 8, 0, 2, 1, 8, 9]);
    assert_eq!(call, Call::Upload(rows, vec![8, 9]));
}

#[test]
fn download_gathers_to_the_destination() {
    let rows = Rows { address: 0x1004, pitch: 16, words: 3, rows: 2 };
    let call = Bench::new().last(0x23, &DOWNLOAD);
    assert_eq!(call, Call::Download(rows, 0x8004));
}

#[test]
fn download_each_word_at_fault_is_named() {
    let cases = [
        (1, 0x1001, BadAlignment, 1),
        (1, MEMORY - 24, OutOfMemory, 1),
        (2, 18, BadAlignment, 2),
        (2, 8, BadValue, 2),
        (3, 0xFFFF_FFFF, BadValue, 2),
        (4, 0xFFFF_FFFF, OutOfMemory, 1),
        (5, 0x8002, BadAlignment, 5),
        (5, MEMORY - 20, OutOfMemory, 5),
        (5, 0xFFFF_FFFC, OutOfMemory, 5),
    ];
    for (word, value, code, at_fault) in cases {
        let payload = with(DOWNLOAD, word, value);
        let found = payload[at_fault as usize - 1];
        Bench::new().bad(0x23, &payload, code, at_fault, found);
    }
}

#[test]
fn bitmap_packets_are_legal_in_a_scene() {
    let mut bench = Bench::in_scene();
    bench.good(0x20, &FILL);
    bench.good(0x21, &COPY);
    bench.good(0x22, &UPLOAD);
    bench.good(0x23, &DOWNLOAD);
    bench.good(0x24, &FILL_ROP);
    bench.good(0x25, &COPY_ROP);
    bench.good(0x26, &CONVERT);
    bench.good(0x27, &STRETCH);
}

#[test]
fn fill_rop_is_a_combination_with_a_value() {
    let destination = Image { base: 0x1308, pitch: 256, width: 10, height: 20, format: BitmapFormat::Xrgb8888 };
    let source = CombineSource::Value(0xAABB_CCDD);
    let combine = Combine { source, destination, operation: RasterOperation::Xor, planes: 0xFFFF_0000 };
    assert_eq!(combined(0x24, FILL_ROP), combine);
}

#[test]
fn fill_rop_of_eight_bit_pixels_has_no_alignment() {
    let combine = combined(0x24, [0x1001, 61, 3, 1, 1, 3, 3, 0x7F, 3, 0xFFFF_FFFF]);
    assert_eq!((combine.destination.base, combine.planes), (0x1001 + 61 + 1, 0xFF));
    // Up to the last byte of memory, and one further.
    let payload = [MEMORY - 61 - 3, 61, 3, 0, 0, 3, 2, 0, 3, 0xFF];
    Bench::new().good(0x24, &payload);
    Bench::new().bad(0x24, &with(payload, 4, 1), OutOfMemory, 1, payload[0]);
}

#[test]
fn raster_operation_reads_its_source_only_where_it_counts() {
    // All but clear, no-operation (which calls no unit at all), invert, set.
    for operation in [1, 2, 3, 4, 6, 7, 8, 9, 11, 12, 13, 14] {
        let combine = combined(0x25, with(COPY_ROP, 12, operation));
        assert!(matches!(combine.source, CombineSource::Image(_)), "operation {operation}");
    }
    for operation in [0, 10, 15] {
        assert_eq!(combined(0x25, with(COPY_ROP, 12, operation)).source, CombineSource::Value(0));
    }
}

#[test]
fn raster_operation_reads_what_is_there_for_its_bits_or_for_a_plane_mask() {
    let reads = |operation, planes| combined(0x25, with(with(COPY_ROP, 12, operation), 13, planes)).reads_destination();
    let all = 0xFFFF;
    assert_eq!([0, 3, 12, 15].map(|operation| reads(operation, all)), [false; 4]);
    assert_eq!([1, 2, 4, 6, 7, 8, 9, 10, 11, 13, 14].map(|operation| reads(operation, all)), [true; 11]);
    assert_eq!([0, 3, 12, 15].map(|operation| reads(operation, 0x7FFF)), [true; 4]);
}

#[test]
fn raster_operation_that_changes_nothing_is_a_legal_nothing_in_memory() {
    let mut bench = Bench::new();
    assert_eq!(bench.good(0x24, &with(FILL_ROP, 9, 5)), []);
    assert_eq!(bench.good(0x24, &with(FILL_ROP, 10, 0)), []);
    assert_eq!(bench.good(0x25, &with(COPY_ROP, 12, 5)), []);
    // Planes above the 16 of the format.
    assert_eq!(bench.good(0x25, &with(COPY_ROP, 13, 0xFFFF_0000)), []);
    bench.bad(0x25, &with(with(COPY_ROP, 12, 5), 2, MEMORY), OutOfMemory, 2, MEMORY);
}

#[test]
fn raster_operation_without_a_pixel_is_a_legal_nothing() {
    let mut bench = Bench::new();
    assert_eq!(bench.good(0x24, &with(FILL_ROP, 6, 0)), []);
    assert_eq!(bench.good(0x25, &with(COPY_ROP, 11, 0)), []);
    assert_eq!(bench.good(0x26, &with(CONVERT, 11, 0)), []);
    assert_eq!(bench.good(0x27, &with(STRETCH, 7, 0)), []);
    assert_eq!(bench.good(0x27, &with(STRETCH, 15, 0)), []);
}

#[test]
fn fill_rop_each_word_at_fault_is_named() {
    let cases = [
        (1, 0x1002, BadAlignment, 1),
        (1, MEMORY - 64, OutOfMemory, 1),
        (2, 258, BadAlignment, 2),
        (2, 44, BadValue, 2),
        (3, 4, BadValue, 3),
        (4, 0xFFFF_FFFF, BadValue, 2),
        (5, 0xFFFF_FFFF, OutOfMemory, 1),
        (6, 16385, BadValue, 6),
        (7, 16385, BadValue, 7),
        (9, 16, BadValue, 9),
        (9, 0xFFFF_FFFF, BadValue, 9),
    ];
    each_fault(0x24, FILL_ROP, &cases);
}

#[test]
fn copy_rop_each_word_at_fault_is_named() {
    let cases = [
        (1, 4, BadValue, 1),
        (2, 0x1001, BadAlignment, 2),
        (2, MEMORY, OutOfMemory, 2),
        (3, 127, BadAlignment, 3),
        (3, 22, BadValue, 3),
        (5, 0xFFFF_FFFF, OutOfMemory, 2),
        (6, 0x8001, BadAlignment, 6),
        (6, MEMORY, OutOfMemory, 6),
        (7, 26, BadValue, 7),
        (9, 0xFFFF_FFFF, OutOfMemory, 6),
        (10, 16385, BadValue, 10),
        (11, 16385, BadValue, 11),
        (12, 16, BadValue, 12),
    ];
    each_fault(0x25, COPY_ROP, &cases);
}

#[test]
fn convert_has_a_format_for_each_side() {
    let source = Image { base: 0x1184, pitch: 128, width: 10, height: 20, format: BitmapFormat::Rgb565 };
    let destination = Image { base: 0x8150, pitch: 64, width: 10, height: 20, format: BitmapFormat::Argb8888 };
    assert_eq!(Bench::new().last(0x26, &CONVERT), Call::Convert(Convert { source, destination }));
    // Overlap is right, so it is legal.
    assert!(matches!(Bench::new().last(0x26, &with(CONVERT, 7, 0x1000)), Call::Convert(_)));
}

#[test]
fn convert_each_word_at_fault_is_named() {
    let cases = [
        (1, 4, BadValue, 1),
        (2, 0x1001, BadAlignment, 2),
        (2, MEMORY, OutOfMemory, 2),
        (3, 127, BadAlignment, 3),
        (3, 22, BadValue, 3),
        (6, 4, BadValue, 6),
        (7, 0x8002, BadAlignment, 7),
        (7, MEMORY, OutOfMemory, 7),
        (8, 66, BadAlignment, 8),
        (8, 52, BadValue, 8),
        (9, 0xFFFF_FFFF, BadValue, 8),
        (10, 0xFFFF_FFFF, OutOfMemory, 7),
        (11, 16385, BadValue, 11),
        (12, 16385, BadValue, 12),
    ];
    each_fault(0x26, CONVERT, &cases);
}

#[test]
fn stretch_has_a_source_a_whole_and_a_part() {
    let source = Image { base: 0x1184, pitch: 128, width: 8, height: 9, format: BitmapFormat::Rgb565 };
    let destination = Image { base: 0x8150, pitch: 64, width: 10, height: 20, format: BitmapFormat::Argb8888 };
    let stretch = Stretch { source, destination, whole: [40, 30], part: [29, 9], filter: StretchFilter::Bilinear };
    assert_eq!(Bench::new().last(0x27, &STRETCH), Call::Stretch(stretch));
}

#[test]
fn stretch_each_word_at_fault_is_named() {
    let cases = [
        (1, 2, BadValue, 1),
        (2, 4, BadValue, 2),
        (3, 0x1001, BadAlignment, 3),
        (3, MEMORY, OutOfMemory, 3),
        (4, 18, BadValue, 4),
        (6, 0xFFFF_FFFF, OutOfMemory, 3),
        (7, 16385, BadValue, 7),
        (8, 16385, BadValue, 8),
        (9, 4, BadValue, 9),
        (10, 0x8002, BadAlignment, 10),
        (10, MEMORY, OutOfMemory, 10),
        (11, 52, BadValue, 11),
        (14, 16385, BadValue, 14),
        (15, 16385, BadValue, 15),
        (16, 16385, BadValue, 16),
        (16, 38, BadValue, 18),
        (17, 16385, BadValue, 17),
        (17, 0, BadValue, 19),
        (18, 31, BadValue, 18),
        (18, 0xFFFF_FFFF, BadValue, 18),
        (19, 11, BadValue, 19),
    ];
    each_fault(0x27, STRETCH, &cases);
}

#[test]
fn stretch_into_its_source_is_refused_and_beside_it_is_not() {
    // Columns 0..8 of rows of 64 bytes at 0x1000 to columns from `x` on, 8 more rows.
    let beside = |x, y| [0, 0, 0x1000, 64, 0, 0, 8, 8, 0, 0x1000, 64, x, y, 4, 8, 4, 8, 0, 0];
    Bench::new().good(0x27, &beside(8, 0));
    Bench::new().good(0x27, &beside(0, 8));
    Bench::new().bad(0x27, &beside(7, 0), Overlap, 10, 0x1000);
    Bench::new().bad(0x27, &beside(0, 7), Overlap, 10, 0x1000);
    // Rows of the part begin where the source's 32 bytes end, but its pitch brings the second one to the source.
    let other = [0, 0, 0x1000, 64, 0, 0, 8, 8, 0, 0x1020, 96, 0, 0, 4, 2, 4, 2, 0, 0];
    Bench::new().bad(0x27, &other, Overlap, 10, 0x1020);
}
