//! DRAW_INLINE and DRAW_BUFFER.

use crate::bench::{Bench, TRIANGLE, packet};
use crate::mock::{Call, Drawn, MEMORY, Run};
use zga_abi::format::{BlendMode, DepthFunction, Topology};
use zga_abi::{Effects, Fault, FaultCode};
use zga_firmware::Stopped;
use zga_firmware::checked::{DrawState, Rectangle};

/// Flags: vertices are named by indices.
const INDEXED: u32 = 0x10;
/// Flags: vertices carry a colour.
const COLOURED: u32 = 0x100;
/// Flags: vertices carry a normal.
const NORMALS: u32 = 0x200;
/// Flags: vertices carry texture coordinates.
const COORDINATES: u32 = 0x400;

/// An inline draw of one triangle with these indices.
fn inline_indexed(indices: &[u32]) -> Vec<u32> {
    [&[INDEXED, 3, indices.len() as u32], &TRIANGLE[..], indices].concat()
}

/// The draw that a call is.
fn drawn(call: Call) -> Drawn {
    match call {
        Call::Draw(_, drawn) => drawn,
        other => panic!("{other:?} is no draw"),
    }
}

#[test]
fn draw_inline_triangle_reaches_the_card_with_its_state() {
    let mut bench = Bench::in_scene();
    bench.card.set(0x0284, 0x006);
    bench.card.set(0x0288, 0x8040_2010);
    bench.card.set(0x028C, 77);
    bench.card.set(0x0290, (2 << 16) | 1);
    bench.card.set(0x0298, 0x0180);
    bench.card.set(0x029C, 0xFFFF);
    let call = bench.last(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
    let state = DrawState {
        effects: Effects::DEPTH,
        depth_function: DepthFunction::GreaterEqual,
        depth_write: false,
        material_colour: 0x8040_2010,
        tag: 77,
        scissor: Rectangle { x: 1, y: 2, right: 64, bottom: 32 },
        line_width: 0x0180,
        point_size: 0xFFFF,
        texture: None,
        punch_through: None,
        light: None,
        fog: None,
        blend: BlendMode::Alpha,
        stencil: None,
    };
    let draw = Drawn {
        topology: Topology::Triangles,
        coloured: false,
        normals: false,
        coordinates: false,
        vertices: Run::Inline(TRIANGLE.to_vec()),
        vertex_count: 3,
        indices: None,
    };
    assert_eq!(call, Call::Draw(state, draw));
}

#[test]
fn draw_inline_indices_follow_the_vertices() {
    let draw = drawn(Bench::in_scene().last(0x10, &inline_indexed(&[2, 1, 0])));
    assert_eq!(draw.vertices, Run::Inline(TRIANGLE.to_vec()));
    assert_eq!(draw.indices, Some(Run::Inline(vec![2, 1, 0])));
}

#[test]
fn draw_inline_coloured_vertices_have_four_words() {
    let payload = [&[COLOURED | 1, 2, 0], &[7; 8][..]].concat();
    let draw = drawn(Bench::in_scene().last(0x10, &payload));
    assert_eq!((draw.topology, draw.coloured), (Topology::Lines, true));
    assert_eq!(draw.vertices, Run::Inline(vec![7; 8]));
}

#[test]
fn draw_vertices_of_each_format_have_their_words() {
    let formats = [
        (0, 3),
        (COLOURED, 4),
        (NORMALS, 6),
        (COLOURED | NORMALS, 7),
        (COORDINATES, 5),
        (COLOURED | COORDINATES, 6),
        (NORMALS | COORDINATES, 8),
        (COLOURED | NORMALS | COORDINATES, 9),
    ];
    for (flags, words) in formats {
        let mut bench = Bench::in_scene();
        let inline = drawn(bench.last(0x10, &[&[flags, 3, 0], &vec![7; 3 * words as usize][..]].concat()));
        let carries = [COLOURED, NORMALS, COORDINATES].map(|flag| flags & flag != 0);
        assert_eq!([inline.coloured, inline.normals, inline.coordinates], carries, "{flags:#x}");
        assert_eq!(inline.vertices, Run::Inline(vec![7; 3 * words as usize]));
        let end = MEMORY - 12 * words;
        let buffer = drawn(bench.last(0x11, &[flags, end, 3, 0, 0]));
        assert_eq!([buffer.coloured, buffer.normals, buffer.coordinates], carries, "{flags:#x}");
        assert_eq!(buffer.vertices, Run::Memory(end, 3 * words));
        bench.bad(0x11, &[flags, end + 4, 3, 0, 0], FaultCode::OutOfMemory, 2, end + 4);
    }
}

#[test]
fn draw_inline_of_another_length_than_its_counts_say_is_a_bad_length() {
    let cases = [
        (0, 3, 0, 8),
        (0, 3, 0, 10),
        (COLOURED, 3, 0, 9),
        (INDEXED, 3, 3, 9),
        (0, 0, 0, 1),
        // Counts whose sum or product would wrap round in 32 bits.
        (0, 0x5555_5556, 0, 2),
        (COLOURED, 0x4000_0000, 0, 0),
        (INDEXED, 1, 0xFFFF_FFFD, 0),
        (INDEXED | COLOURED, 0xFFFF_FFFF, 0xFFFF_FFFF, 3),
        (NORMALS, 3, 0, 9),
        (COORDINATES, 3, 0, 18),
        (INDEXED | COLOURED | NORMALS | COORDINATES, 0xFFFF_FFFF, 0xFFFF_FFFF, 9),
        // 9 words each: 2^32 + 5.
        (COLOURED | NORMALS | COORDINATES, 0x1C71_C71D, 0, 5),
    ];
    for (flags, vertices, indices, words) in cases {
        let payload = [&[flags, vertices, indices], &vec![0; words][..]].concat();
        let header = packet(0x10, &payload)[0];
        Bench::in_scene().bad(0x10, &payload, FaultCode::BadLength, 0, header);
    }
}

#[test]
fn draw_with_a_reserved_flag_is_a_bad_value() {
    for flags in [0x4, 0x20, 0x800, 0x8000_0000] {
        let mut bench = Bench::in_scene();
        bench.bad(0x10, &[flags, 0, 0], FaultCode::BadValue, 1, flags);
        bench.bad(0x11, &[flags, 0, 0, 0, 0], FaultCode::BadValue, 1, flags);
    }
}

#[test]
fn draw_with_indices_that_the_flags_deny_is_a_bad_value() {
    let mut bench = Bench::in_scene();
    bench.bad(0x10, &[0, 0, 1, 0], FaultCode::BadValue, 3, 1);
    bench.bad(0x11, &[0, 0, 0, 4, 0], FaultCode::BadValue, 4, 4);
    bench.bad(0x11, &[0, 0, 0, 0, 5], FaultCode::BadValue, 5, 5);
}

#[test]
fn draw_inline_with_an_index_beyond_the_vertices_names_the_first() {
    let mut bench = Bench::in_scene();
    bench.bad(0x10, &inline_indexed(&[0, 3, 9]), FaultCode::BadIndex, 14, 3);
    let last = inline_indexed(&[0, 1, 2, 0xFFFF_FFFF]);
    bench.bad(0x10, &last, FaultCode::BadIndex, 16, 0xFFFF_FFFF);
    bench.bad(0x10, &[INDEXED, 0, 1, 0], FaultCode::BadIndex, 4, 0);
}

#[test]
fn draw_that_makes_no_primitive_is_a_legal_nothing() {
    let mut bench = Bench::in_scene();
    assert_eq!(bench.good(0x10, &[0, 0, 0]), []);
    assert_eq!(bench.good(0x10, &[&[0, 2, 0], &[0; 6][..]].concat()), []);
    assert_eq!(bench.good(0x10, &[1, 1, 0, 0, 0, 0]), []);
    assert_eq!(bench.good(0x10, &[3, 1, 0, 0, 0, 0]), []);
    assert_eq!(bench.good(0x10, &inline_indexed(&[0, 1])), []);
    assert_eq!(bench.good(0x11, &[0, 0xFFFF_FFFC, 0, 0, 0]), []);
    assert_eq!(bench.good(0x11, &[INDEXED, 0, 0, 0xFFFF_FFFC, 0]), []);
}

#[test]
fn draw_with_vertices_left_over_draws() {
    let draw = drawn(Bench::in_scene().last(0x10, &[&[0, 4, 0], &[0; 12][..]].concat()));
    assert_eq!(draw.vertex_count, 4);
}

#[test]
fn draw_buffer_vertices_and_indices_are_runs_in_memory() {
    let mut bench = Bench::in_scene();
    bench.card.memory.insert(0x9004, 4);
    let payload = [INDEXED | COLOURED | 3, 0x8000, 5, 0x9000, 3];
    let draw = drawn(bench.last(0x11, &payload));
    assert_eq!(draw.topology, Topology::LineStrip);
    assert_eq!(draw.vertices, Run::Memory(0x8000, 20));
    assert_eq!(draw.indices, Some(Run::Memory(0x9000, 3)));
}

#[test]
fn draw_buffer_up_to_the_last_word_of_memory_draws() {
    let draw = drawn(Bench::in_scene().last(0x11, &[2, MEMORY - 24, 2, 0, 0]));
    assert_eq!(draw.vertices, Run::Memory(MEMORY - 24, 6));
}

#[test]
fn draw_buffer_between_words_is_a_bad_alignment() {
    let mut bench = Bench::in_scene();
    bench.bad(0x11, &[0, 2, 3, 0, 0], FaultCode::BadAlignment, 2, 2);
    bench.bad(0x11, &[INDEXED, 0, 3, 1, 3], FaultCode::BadAlignment, 4, 1);
}

#[test]
fn draw_buffer_outside_memory_is_out_of_memory() {
    let cases = [
        ([2, MEMORY - 20, 2, 0, 0], 2, MEMORY - 20),
        ([0, 0xFFFF_FFFC, 3, 0, 0], 2, 0xFFFF_FFFC),
        ([0, 0, 0x5555_5556, 0, 0], 2, 0),
        ([COLOURED, 0, 0x4000_0001, 0, 0], 2, 0),
        ([INDEXED, 0, 3, MEMORY - 4, 2], 4, MEMORY - 4),
        ([INDEXED, 0, 3, 0, 0xFFFF_FFFF], 4, 0),
    ];
    for (payload, word, value) in cases {
        Bench::in_scene().bad(0x11, &payload, FaultCode::OutOfMemory, word, value);
    }
}

#[test]
fn draw_buffer_with_an_index_beyond_the_vertices_shows_the_largest() {
    let mut bench = Bench::in_scene();
    bench.card.memory.insert(0x9000, 3);
    bench.card.memory.insert(0x9008, 8);
    let payload = [INDEXED, 0x8000, 3, 0x9000, 3];
    bench.bad(0x11, &payload, FaultCode::BadIndex, 4, 8);
}

#[test]
fn draw_with_depth_but_no_z_buffer_is_a_bad_value() {
    let mut bench = Bench::in_scene_without_depth();
    bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
    bench.card.set(0x0280, 1);
    let payload = [&[0, 3, 0], &TRIANGLE[..]].concat();
    bench.bad(0x10, &payload, FaultCode::BadValue, 0, 0x0280);
}

#[test]
fn draw_with_masks_but_no_grid_is_a_bad_value() {
    let payload = [&[0, 3, 0], &TRIANGLE[..]].concat();
    for effects in [1 << 10, 0x501] {
        let mut bench = Bench::in_scene();
        bench.card.set(0x0280, effects);
        // A grid counts from the next begin scene on.
        bench.card.set(0x0260, 1);
        bench.bad(0x10, &payload, FaultCode::BadValue, 0, 0x0280);
        bench.bad(0x10, &[0, 0, 0], FaultCode::BadValue, 0, 0x0280);
        bench.good(0x03, &[]);
        bench.good(0x02, &[]);
        bench.good(0x10, &payload);
    }
}

#[test]
fn draw_with_a_width_or_size_out_of_range_is_a_bad_value() {
    for register in [0x0298, 0x029C] {
        for value in [0, 0x0001_0000] {
            let mut bench = Bench::in_scene();
            bench.card.set(register, value);
            bench.bad(0x10, &[0, 0, 0], FaultCode::BadValue, 0, register);
        }
    }
}

#[test]
fn draw_with_effects_that_mean_nothing_is_a_bad_value() {
    let mut bench = Bench::in_scene();
    bench.card.set(0x0280, 0x1001);
    bench.bad(0x10, &[0, 0, 0], FaultCode::BadValue, 0, 0x0280);
}

#[test]
fn draw_with_effects_that_the_card_lacks_is_unsupported() {
    let mut bench = Bench::in_scene();
    bench.card.set(0x0008, 0x00F);
    bench.card.set(0x0280, 0x011);
    bench.bad(0x10, &[0, 0, 0], FaultCode::Unsupported, 0, 0x0280);
}

#[test]
fn draw_keeps_effects_as_called() {
    let mut bench = Bench::in_scene_with_grid();
    // All but the stencil test, which a grid excludes.
    bench.card.set(0x0280, 0x7FF);
    let calls = bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
    let called = calls.iter().find_map(|call| match call {
        Call::Draw(state, _) => Some(state.effects),
        _ => None,
    });
    assert_eq!(called, Some(Effects::all() - Effects::STENCIL));
}

#[test]
fn draw_with_every_depth_function_is_legal() {
    for code in 0..8 {
        let mut bench = Bench::in_scene();
        bench.card.set(0x0284, 0xFFFF_FFF8 | code);
        bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
    }
}

#[test]
fn draw_that_the_watchdog_stops_faults_and_the_scene_goes_on() {
    let mut bench = Bench::in_scene();
    bench.card.stop = Some(Stopped::Watchdog);
    let payload = [&[0, 3, 0], &TRIANGLE[..]].concat();
    let (result, calls) = bench.run(&packet(0x10, &payload));
    assert_eq!(result, Err(Fault::new(FaultCode::Watchdog, 0, 0)));
    assert!(matches!(calls.last(), Some(Call::Draw(..))));
    assert!(bench.processor.in_scene());
}

#[test]
fn draw_that_a_reset_stops_is_no_fault() {
    let mut bench = Bench::in_scene();
    bench.card.stop = Some(Stopped::Reset);
    bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
}

#[test]
fn draw_while_the_probe_records_checks_its_area() {
    let mut bench = Bench::in_scene();
    let payload = [&[0, 3, 0], &TRIANGLE[..]].concat();
    bench.card.set(0x0600, 1);
    bench.card.set(0x0608, MEMORY - 64);
    bench.card.set(0x060C, 2);
    bench.good(0x10, &payload);
    bench.card.set(0x060C, 3);
    bench.bad(0x10, &payload, FaultCode::OutOfMemory, 0, 0x0608);
    bench.bad(0x04, &[1, 0, 0], FaultCode::OutOfMemory, 0, 0x0608);
    bench.card.set(0x0608, 4);
    bench.bad(0x10, &payload, FaultCode::BadAlignment, 0, 0x0608);
    bench.card.set(0x0600, 0);
    bench.good(0x10, &payload);
}
