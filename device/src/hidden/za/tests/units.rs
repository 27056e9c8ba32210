//! Single events, followed by hand.

use super::*;
use crate::hidden::stencil::StencilCounts;
use crate::hidden::za::memory::{background_blocks, clear_logically};
use crate::probe::account::{Account, Clocks};
use zga_abi::Counter;

const FAR: i32 = 0xFFFF;
const RED: u32 = 0xFF00_00FF;
const GREEN: u32 = 0xFF00_FF00;
const WHITE: u32 = 0xFFFF_FFFF;

fn format16() -> DepthFormat {
    DepthFormat::new(16, 24).unwrap()
}

/// 96 pixels in one row, three blocks of 32, 16 bits of depth.
fn one_row() -> Frame {
    frame([96, 1], [32, 1], PixelFormat::Xrgb8888, format16(), true)
}

fn state(frame: &Frame, prediction: ZaPrediction) -> State {
    State {
        function: Some(DepthFunction::Less),
        write: true,
        interpolation: Interpolation::Flat,
        scissor: frame.grid.all(),
        prediction,
        bypass: true,
    }
}

/// A triangle that covers columns `first..beyond` of row 0; its depth goes from `z[0]` at the centre of
/// column `first` evenly to `z[1]` at that of column `beyond`.
///
/// Its left side stands upright through the centre of `first` (left edges own their pixels), its tip is
/// the centre of `beyond` (which no edge owns).
fn surface(first: i32, beyond: i32, z: [u32; 2], colour: u32, format: DepthFormat) -> Shape {
    let vertex =
        |column: i32, y: i32, z: u32| ScreenVertex { x: column * 256 + 128, y: 128 + y, z, colour, reciprocal_w: 1.0 };
    triangle([vertex(first, -4096, z[0]), vertex(first, 4096, z[0]), vertex(beyond, 0, z[1])], format).unwrap()
}

fn background() -> Background {
    Background { pixel: 0xFF11_2233, depth: FAR }
}

/// Draws with both models, which must agree, on `memory`.
fn draw_both(draw: &ZaDraw, shape: &Shape, memory: &mut Memory) -> ZaCounts {
    let mut other = memory.clone();
    let counts = specification_draw(draw, shape, memory);
    let clocked = clocked_draw(draw, shape, &mut other);
    assert_eq!(counts, clocked);
    assert_eq!(*memory, other);
    counts
}

/// The worked example of the unit's documentation.
///
/// | event | block 0 | block 1 | block 2 | clocks |
/// | --- | --- | --- | --- | --- |
/// | clear | cleared | cleared | cleared | 1: 3 words, 16 in a clock |
/// | A: span | | | | 2 |
/// | A: block 0, cleared: 32 pixels of A, depths 100..=131 | 131 | | | 1 + 32 + 1 |
/// | A: block 1, cleared: 32 pixels of A, depths 132..=163 | | 163 | | 1 + 32 + 1 |
/// | A: block 2, cleared: 16 pixels of A, 16 of background | | | 65535 | 1 + 32 + 1 |
/// | B: span | | | | 2 |
/// | B: block 0, from column 8 on: 219 - 32 = 187 > 131: bypassed | 131 | | | 1 + 1 |
/// | B: block 1: 195 - 32 = 163, not > 163: compared, none is nearer | | 163 | | 1 + 1 + 32 + 0 + 1 |
/// | B: block 2: 163 - 32 = 131, not > 65535: compared, 32 are nearer | | | 163 | 1 + 1 + 32 + 32 + 1 |
#[test]
fn worked_example_block_length_gives_the_stated_events() {
    let frame = one_row();
    let draw = za_draw(&frame, background(), &state(&frame, ZaPrediction::BlockLength));
    let mut memory = Memory::poisoned(&frame, 1);

    let clear = clear_logically(&mut memory.words);
    let a = draw_both(&draw, &surface(0, 80, [100, 180], RED, format16()), &mut memory);
    let words_after_a = memory.words.clone();
    let b = draw_both(&draw, &surface(8, 96, [219, 131], GREEN, format16()), &mut memory);

    assert_eq!((clear.words_written, clear.clocks), (3, 1));
    let expected = ZaCounts {
        spans: 1,
        passed: 80,
        initialised: 3,
        colour_writes: 96,
        depth_writes: 96,
        words_written: 3,
        clocks: 2 + 3 * (1 + 32 + 1),
        ..ZaCounts::default()
    };
    assert_eq!(a, expected);
    assert_eq!(words_after_a, [131, 163, FAR]);
    let expected = ZaCounts {
        spans: 1,
        passed: 32,
        bypassed: 1,
        pixels_bypassed: 24,
        compared: 2,
        reads: 64,
        depth_writes: 32,
        colour_writes: 32,
        words_written: 2,
        clocks: 2 + (1 + 1) + (1 + 1 + 32 + 1) + (1 + 1 + 32 + 32 + 1),
        ..ZaCounts::default()
    };
    assert_eq!(b, expected);
    assert_eq!(memory.words, [131, 163, 163]);
    assert_eq!(1 + a.clocks + b.clocks, 211);
}

/// As above, but the prediction of block 1 is 195 - 31 = 164 > 163 for one clock more: bypassed.
#[test]
fn worked_example_tighter_predictions_bypass_one_block_more() {
    let frame = one_row();
    for prediction in [ZaPrediction::CoveredRun, ZaPrediction::Plane] {
        let draw = za_draw(&frame, background(), &state(&frame, prediction));
        let mut memory = Memory::poisoned(&frame, 1);

        draw_both(&draw, &surface(0, 80, [100, 180], RED, format16()), &mut memory);
        let b = draw_both(&draw, &surface(8, 96, [219, 131], GREEN, format16()), &mut memory);

        assert_eq!((b.bypassed, b.pixels_bypassed, b.compared), (2, 24 + 32, 1), "{prediction:?}");
        assert_eq!(b.clocks, 2 + (1 + 2) + (1 + 2) + (1 + 2 + 32 + 32 + 1), "{prediction:?}");
        assert_eq!(memory.words, [131, 163, 163], "{prediction:?}");
    }
}

#[test]
fn worked_example_states_come_in_the_published_order() {
    use clocked::State::*;
    let frame = one_row();
    let draw = za_draw(&frame, background(), &state(&frame, ZaPrediction::BlockLength));
    let mut memory = Memory::poisoned(&frame, 1);
    draw_both(&draw, &surface(0, 80, [100, 180], RED, format16()), &mut memory);
    let mut unit = clocked::Unit::new(&draw);
    let mut states = Vec::new();

    unit.load(&surface(8, 96, [219, 131], GREEN, format16()), 0);
    states.push(unit.state());
    while unit.clock(&mut memory.surfaces()) {
        states.push(unit.state());
    }

    let mut expected = vec![StepEdges, LoadInterpolators, FetchWord, Predict, FetchWord, Predict];
    expected.extend([ReadPixel; 32]);
    expected.extend([StoreWord, FetchWord, Predict]);
    expected.extend([ReadPixel, WritePixel].repeat(32));
    expected.extend([StoreWord, Idle]);
    assert_eq!(states, expected);
    assert_eq!(unit.counts.clocks, states.len() as u64 - 1);
}

#[test]
fn prediction_equal_to_the_word_is_not_bypassed() {
    let frame = one_row();
    for prediction in [ZaPrediction::BlockLength, ZaPrediction::CoveredRun, ZaPrediction::Plane] {
        let state = State { function: Some(DepthFunction::LessEqual), ..state(&frame, prediction) };
        let draw = za_draw(&frame, background(), &state);
        let mut memory = Memory::poisoned(&frame, 2);

        draw_both(&draw, &surface(0, 96, [500, 500], RED, format16()), &mut memory);
        let equal = draw_both(&draw, &surface(0, 96, [500, 500], GREEN, format16()), &mut memory);
        let behind = draw_both(&draw, &surface(0, 96, [501, 501], WHITE, format16()), &mut memory);

        assert_eq!((equal.bypassed, equal.passed), (0, 96), "{prediction:?}");
        assert_eq!((behind.bypassed, behind.passed), (3, 0), "{prediction:?}");
    }
}

#[test]
fn word_drops_only_when_the_last_pixel_of_the_block_is_nearer() {
    let frame = one_row();
    let draw = za_draw(&frame, background(), &state(&frame, ZaPrediction::BlockLength));
    let mut memory = Memory::poisoned(&frame, 3);
    let shape = |first, beyond, z| surface(first, beyond, [z, z], RED, format16());

    draw_both(&draw, &shape(0, 32, 900), &mut memory);
    draw_both(&draw, &shape(0, 31, 10), &mut memory);
    let with_31 = memory.words[0];
    draw_both(&draw, &shape(31, 32, 20), &mut memory);

    assert_eq!((with_31, memory.words[0]), (900, 20));
}

#[test]
fn cleared_block_written_at_one_pixel_holds_the_background_elsewhere() {
    let frame = frame([33, 2], [8, 2], PixelFormat::Rgb565, format16(), true);
    let background = Background { pixel: 0x1234, depth: 777 };
    let draw = za_draw(&frame, background, &state(&frame, ZaPrediction::Plane));
    let mut memory = Memory::poisoned(&frame, 4);
    let poison = memory.clone();

    let counts = draw_both(
        &draw,
        &point(ScreenVertex { x: 9 << 8, y: 1 << 8, z: 5, colour: WHITE, reciprocal_w: 1.0 }),
        &mut memory,
    );

    let pixel = |x: usize, y: usize| (memory.colour[y * frame.colour_pitch + x / 2] >> (16 * (x % 2))) & 0xFFFF;
    assert_eq!((8..16).map(|x| pixel(x, 0)).collect::<Vec<_>>(), [0x1234; 8]);
    assert_eq!(
        (8..16).map(|x| pixel(x, 1)).collect::<Vec<_>>(),
        [0x1234, 0xFFFF, 0x1234, 0x1234, 0x1234, 0x1234, 0x1234, 0x1234]
    );
    let pitch = frame.depth_pitch.unwrap();
    assert_eq!(memory.depth[8..16], [777; 8]);
    assert_eq!(memory.depth[pitch + 8..pitch + 16], [777, 5, 777, 777, 777, 777, 777, 777]);
    assert_eq!((memory.depth[7], memory.depth[16]), (poison.depth[7], poison.depth[16]));
    assert_eq!(memory.words, [CLEARED, 777, CLEARED, CLEARED, CLEARED]);
    assert_eq!((counts.colour_writes, counts.reads, counts.spans, counts.clocks), (16, 0, 0, 1 + 16 + 1));
}

#[test]
fn largest_depth_is_not_taken_for_a_cleared_block() {
    let format = DepthFormat::new(31, 24).unwrap();
    let frame = frame([40, 1], [32, 1], PixelFormat::Argb8888, format, true);
    let largest = format.maximum();
    let draw = za_draw(&frame, Background { pixel: 0, depth: largest as i32 }, &state(&frame, ZaPrediction::Plane));
    let mut memory = Memory::poisoned(&frame, 5);

    let first = draw_both(&draw, &surface(0, 40, [largest, largest], RED, format), &mut memory);
    let second = draw_both(&draw, &surface(0, 40, [largest - 1, largest - 1], GREEN, format), &mut memory);

    assert_eq!((first.initialised, first.passed), (2, 0));
    assert_eq!((second.initialised, second.compared, second.passed), (0, 2, 40));
    assert_eq!(memory.words, [i32::MAX - 1, i32::MAX - 1]);
    assert_eq!(background_blocks(&memory.words), 0);
}

#[test]
fn farther_pixels_may_win_so_nothing_is_bypassed() {
    let frame = one_row();
    for function in
        [DepthFunction::Greater, DepthFunction::GreaterEqual, DepthFunction::NotEqual, DepthFunction::Always]
    {
        let near = state(&frame, ZaPrediction::Plane);
        let far = State { function: Some(function), ..near };
        let mut memory = Memory::poisoned(&frame, 6);

        draw_both(&za_draw(&frame, background(), &near), &surface(0, 96, [5, 5], RED, format16()), &mut memory);
        let counts =
            draw_both(&za_draw(&frame, background(), &far), &surface(0, 96, [9, 9], GREEN, format16()), &mut memory);

        assert_eq!((counts.bypassed, counts.compared, counts.passed), (0, 3, 96), "{function:?}");
        assert_eq!(counts.clocks, 2 + 3 * (1 + 32 + 32 + 1), "{function:?}");
        assert_eq!(memory.words, [9; 3], "{function:?}");
    }
}

#[test]
fn draw_without_depth_paints_and_leaves_words_alone() {
    let frame = one_row();
    let tested = state(&frame, ZaPrediction::BlockLength);
    let painted = State { function: None, ..tested };
    let mut memory = Memory::poisoned(&frame, 7);

    draw_both(&za_draw(&frame, background(), &tested), &surface(0, 32, [5, 5], RED, format16()), &mut memory);
    let counts =
        draw_both(&za_draw(&frame, background(), &painted), &surface(16, 48, [9, 9], GREEN, format16()), &mut memory);

    assert_eq!(memory.words, [5, FAR, CLEARED]);
    assert_eq!((counts.compared, counts.initialised, counts.reads, counts.passed), (1, 1, 0, 32));
    assert_eq!((counts.colour_writes, counts.depth_writes, counts.words_written), (16 + 32, 32, 1));
    assert_eq!(counts.clocks, 2 + (1 + 16) + (1 + 32 + 1));
}

#[test]
fn depth_not_written_reads_the_run_only() {
    let frame = one_row();
    let written = state(&frame, ZaPrediction::BlockLength);
    let kept = State { write: false, ..written };
    let mut memory = Memory::poisoned(&frame, 8);

    draw_both(&za_draw(&frame, background(), &written), &surface(0, 32, [50, 50], RED, format16()), &mut memory);
    let before = memory.depth.clone();
    let counts =
        draw_both(&za_draw(&frame, background(), &kept), &surface(4, 14, [9, 9], GREEN, format16()), &mut memory);

    assert_eq!(memory.words, [50, CLEARED, CLEARED]);
    assert_eq!(memory.depth, before);
    assert_eq!((counts.reads, counts.passed, counts.depth_writes, counts.words_written), (10, 10, 0, 0));
    assert_eq!(counts.clocks, 2 + 1 + 1 + 10 + 10);
}

#[test]
fn target_without_z_buffer_has_the_formats_maximum_as_word() {
    let frame = frame([96, 1], [32, 1], PixelFormat::Xrgb8888, format16(), false);
    let state = State { function: None, ..state(&frame, ZaPrediction::BlockLength) };
    let draw = za_draw(&frame, Background { pixel: 1, depth: 3 }, &state);
    let mut memory = Memory::poisoned(&frame, 9);

    let counts = draw_both(&draw, &surface(0, 40, [50, 50], RED, format16()), &mut memory);

    assert_eq!(memory.words, [FAR, FAR, CLEARED]);
    assert_eq!((counts.colour_writes, counts.depth_writes, counts.clocks), (64, 0, 2 + 2 * 34));
}

#[test]
fn charge_puts_each_count_into_its_counter() {
    let frame = one_row();
    let state = State { interpolation: Interpolation::Affine, ..state(&frame, ZaPrediction::BlockLength) };
    let draw = za_draw(&frame, background(), &state);
    let counts = ZaCounts {
        fragments: 0,
        holes: 0,
        spans: 1,
        stencil: StencilCounts { tested: 12, failed: 13 },
        passed: 2,
        initialised: 3,
        bypassed: 4,
        pixels_bypassed: 5,
        compared: 6,
        reads: 7,
        depth_writes: 8,
        colour_writes: 9,
        words_written: 10,
        clocks: 11,
    };
    let mut account = Account::default();

    crate::hidden::za::charge(&counts.plus(ZaCounts::default()), &draw, &mut account);

    let counters = [
        (Counter::ZSpans, 1),
        (Counter::ShadingPixels, 2),
        (Counter::ZaBlocksInitialised, 3),
        (Counter::ZaBlocksBypassed, 4),
        (Counter::ZaPixelsBypassed, 5),
        (Counter::ZaBlocksCompared, 6),
        (Counter::ZReads, 7),
        (Counter::ZWrites, 8),
        (Counter::ColourWrites, 9),
        (Counter::ZaWordsWritten, 10),
        (Counter::CyclesZa, 11),
        (Counter::CyclesShading, 2),
    ];
    for (counter, value) in counters {
        assert_eq!(account.get(counter), value, "{}", counter.name());
    }
    assert_eq!(account.total(), Clocks(13));
}

#[test]
fn grid_cuts_edge_blocks_and_finds_the_blocks_of_an_area() {
    let grid = Grid { block: [32, 3], size: [33, 7] };

    assert_eq!((grid.across(), grid.down(), grid.words()), (2, 3, 6));
    assert_eq!(grid.area(5), Rectangle { x: 32, y: 6, right: 33, bottom: 7 });
    assert_eq!((grid.pixels(0), grid.pixels(1), grid.pixels(5)), (96, 3, 1));
    assert_eq!(grid.meeting(&Rectangle { x: 31, y: 2, right: 33, bottom: 4 }), [0..2, 0..2]);
    assert_eq!(grid.meeting(&Rectangle { x: 32, y: 3, right: 900, bottom: 900 }), [1..2, 1..3]);
    assert_eq!(grid.meeting(&Rectangle { x: 4, y: 8, right: 4, bottom: 9 }), [0..0, 0..0]);
}

/// 20 x 4 pixels, blocks of 8 x 2, the last column of blocks is 4 pixels wide; block 0 is initialised.
fn clear_setup(planes: u64) -> (Frame, Memory) {
    let frame = frame([20, 4], [8, 2], PixelFormat::Xrgb8888, format16(), planes == 2);
    let mut memory = Memory::poisoned(&frame, 10);
    let draw_state = State { function: None, ..state(&frame, ZaPrediction::Plane) };
    let pixel = point(ScreenVertex { x: 0, y: 0, z: 9, colour: WHITE, reciprocal_w: 1.0 });
    draw_both(&za_draw(&frame, background(), &draw_state), &pixel, &mut memory);
    (frame, memory)
}

#[test]
fn clear_rectangle_settles_only_blocks_that_keep_some_background() {
    let (frame, mut memory) = clear_setup(2);
    let area = Rectangle { x: 4, y: 0, right: 16, bottom: 2 };

    let counts = frame.clear_rectangle(&area, Some(7), Some(70), Some(&background()), &mut memory.surfaces());

    // Block 0 keeps 4 columns, block 1 is overwritten wholly: neither needs its background in memory.
    assert_eq!(memory.words, [FAR, 70, CLEARED, CLEARED, CLEARED, CLEARED]);
    assert_eq!((counts.settled, counts.colour_writes, counts.depth_writes), (0, 8 + 16, 8 + 16));
    assert_eq!((counts.reads, counts.words_written), (16, 2));
    // Block 0: 2 rows of colour, of depth, 2 rows read, its word; block 1: 2 and 2 rows, its word.
    assert_eq!(counts.clocks, (2 + 2 + 2 + 1) + (2 + 2 + 1));
}

#[test]
fn clear_rectangle_of_part_of_a_cleared_block_brings_the_rest_to_memory() {
    let (frame, mut memory) = clear_setup(2);
    let area = Rectangle { x: 16, y: 2, right: 17, bottom: 3 };

    let counts = frame.clear_rectangle(&area, None, Some(70), Some(&background()), &mut memory.surfaces());

    assert_eq!(memory.words, [FAR, CLEARED, CLEARED, CLEARED, CLEARED, FAR]);
    let pitch = frame.depth_pitch.unwrap();
    assert_eq!(memory.depth[2 * pitch + 16..2 * pitch + 20], [70, FAR, FAR, FAR]);
    assert_eq!(memory.colour[3 * frame.colour_pitch + 16..][..4], [background().pixel; 4]);
    assert_eq!((counts.settled, counts.colour_writes, counts.depth_writes, counts.reads), (1, 8, 8 + 1, 8));
    assert_eq!((counts.words_written, counts.clocks), (2, (2 + 2 + 1) + 1 + (2 + 1)));
}

#[test]
fn clear_rectangle_to_the_background_touches_no_memory() {
    let (frame, mut memory) = clear_setup(2);
    let before = memory.clone();

    let counts = frame.clear_rectangle(
        &frame.grid.all(),
        Some(background().pixel),
        Some(FAR),
        Some(&background()),
        &mut memory.surfaces(),
    );

    assert_eq!(memory.words, [CLEARED; 6]);
    assert_eq!((memory.colour, memory.depth), (before.colour, before.depth));
    assert_eq!((counts.words_written, counts.clocks, counts.colour_writes), (1, 1, 0));
}

#[test]
fn clear_rectangle_of_the_same_depth_leaves_cleared_blocks_cleared() {
    let (frame, mut memory) = clear_setup(2);

    let counts = frame.clear_rectangle(&frame.grid.all(), None, Some(FAR), Some(&background()), &mut memory.surfaces());

    assert_eq!(memory.words, [FAR, CLEARED, CLEARED, CLEARED, CLEARED, CLEARED]);
    assert_eq!((counts.settled, counts.depth_writes), (0, 16));
}

#[test]
fn clear_rectangle_without_z_buffer_ends_cleared_blocks() {
    let (frame, mut memory) = clear_setup(1);

    let counts =
        frame.clear_rectangle(&frame.grid.all(), Some(1), Some(3), Some(&background()), &mut memory.surfaces());

    assert_eq!(memory.words, [FAR; 6]);
    assert_eq!((counts.settled, counts.colour_writes, counts.depth_writes, counts.words_written), (0, 80, 0, 5));
}

#[test]
fn settle_colour_only_leaves_depths_and_words_alone() {
    let (frame, mut memory) = clear_setup(2);
    let before = memory.clone();

    let counts = frame.settle(&background(), None, Settle::Colour, &mut memory.surfaces());

    assert_eq!((&memory.words, &memory.depth), (&before.words, &before.depth));
    assert_eq!(memory.colour[12..20], [background().pixel; 8]);
    assert_eq!((counts.settled, counts.colour_writes, counts.depth_writes), (5, 64, 0));
    assert_eq!((counts.words_written, counts.clocks), (0, 5 * 2));
}

#[test]
fn derive_takes_words_from_the_z_buffer_and_never_makes_a_cleared_one() {
    let (frame, mut memory) = clear_setup(2);
    memory.depth.fill(-5);
    memory.depth[1] = 44;
    let mut initialised_only = memory.clone();

    let counts = frame.derive(0..6, false, &mut memory.surfaces());
    let _ = frame.derive(0..6, true, &mut initialised_only.surfaces());

    assert_eq!(memory.words, [44, 0, 0, 0, 0, 0]);
    assert_eq!(initialised_only.words, [44, CLEARED, CLEARED, CLEARED, CLEARED, CLEARED]);
    assert_eq!((counts.reads, counts.words_written, counts.clocks), (80, 6, 6 * (2 + 1)));
}
