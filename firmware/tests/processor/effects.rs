//! Registers of the effects that a draw calls for: texture, holes, light, fog, blending, stencil.

use crate::bench::{Bench, TRIANGLE};
use crate::mock::{Call, MEMORY};
use zga_abi::FaultCode;
use zga_abi::format::{
    BlendMode, DepthFunction, FogFunction, StencilOperation, TextureFilter, TextureFormat, TextureFunction,
};
use zga_firmware::checked::{DrawState, Fog, Lighting, Stencil, StencilOperations, StencilTest, Texture};

const EFFECTS: u32 = 0x0280;
const TEXTURE: u32 = 1 << 4;
const MIP_MAP: u32 = 1 << 5;
const LIGHT: u32 = 1 << 6;
const FOG: u32 = 1 << 7;
const BLEND: u32 = 1 << 8;
const PUNCH_THROUGH: u32 = 1 << 9;
const STENCIL: u32 = 1 << 11;

const TEXTURE_BASE: u32 = 0x0300;
const TEXTURE_SIZE: u32 = 0x0304;
const TEXTURE_CONTROL: u32 = 0x0308;
const TEXTURE_OFFSET: u32 = 0x030C;
const TEXTURE_WINDOW: u32 = 0x0310;
const PALETTE_BASE: u32 = 0x031C;
const BLEND_CONTROL: u32 = 0x0324;
const STENCIL_CONTROL: u32 = 0x0328;
const STENCIL_VALUE: u32 = 0x032C;
const FOG_CONTROL: u32 = 0x0330;
const LIGHT_CONTROL: u32 = 0x0350;
const LIGHT_BASE: u32 = 0x0354;
const LIGHT_COUNT: u32 = 0x0358;
const MATERIAL_SHININESS: u32 = 0x0368;

/// Values of registers in a scene whose draws call for `effects`.
fn bench(effects: u32, registers: &[(u32, u32)]) -> Bench {
    let mut bench = Bench::in_scene();
    bench.card.set(EFFECTS, effects);
    for &(offset, value) in registers {
        bench.card.set(offset, value);
    }
    bench
}

/// The state that a triangle reaches the card with.
fn state(effects: u32, registers: &[(u32, u32)]) -> DrawState {
    match bench(effects, registers).last(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat()) {
        Call::Draw(state, _) => state,
        other => panic!("{other:?} is no draw"),
    }
}

/// The registers make a draw be refused, also one that makes no primitive; the fault shows `offset`.
#[track_caller]
fn refused(effects: u32, registers: &[(u32, u32)], code: FaultCode, offset: u32) {
    let mut bench = bench(effects, registers);
    bench.bad(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat(), code, 0, offset);
    bench.bad(0x11, &[0, 0, 0, 0, 0], code, 0, offset);
    // What is not called for is not looked at.
    bench.card.set(EFFECTS, 0);
    bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
}

#[test]
fn texture_registers_become_a_texture() {
    let registers = [
        (TEXTURE_BASE, 0x8000),
        (TEXTURE_SIZE, 8 << 16 | 20),
        (TEXTURE_CONTROL, 0x0005_9324),
        (TEXTURE_OFFSET, 2 << 16 | 5),
        (TEXTURE_WINDOW, 6 << 16 | 4),
        (0x0314, 0x8040_2010),
        (0x0318, 0xFE80),
        (PALETTE_BASE, 0x9000),
        (0x0320, 77),
    ];
    let texture = Texture {
        base: 0x8000,
        size: [20, 8],
        format: TextureFormat::Palette8,
        levels: 5,
        palette: 0x9000,
        offset: [5, 2],
        window: [4, 6],
        repeat: [true, false],
        mirror: [false, true],
        filter: TextureFilter::Trilinear,
        function: TextureFunction::Blend,
        colour: 0x8040_2010,
        bias: -0x180,
        mip_map: true,
    };
    let with_levels = state(TEXTURE | MIP_MAP, &registers);
    assert_eq!((with_levels.texture, with_levels.punch_through), (Some(texture), None));
    let with_holes = state(TEXTURE | PUNCH_THROUGH, &registers);
    assert_eq!(with_holes.texture, Some(Texture { mip_map: false, ..texture }));
    assert_eq!(with_holes.punch_through, Some(77));
    let without = state(MIP_MAP | PUNCH_THROUGH, &registers);
    assert_eq!((without.texture, without.punch_through), (None, None));
}

#[test]
fn texture_levels_follow_each_other_at_multiples_of_64_bytes() {
    let texture = |size: u32, control: u32| {
        state(TEXTURE, &[(TEXTURE_SIZE, size), (TEXTURE_CONTROL, control)]).texture.expect("a texture")
    };
    // 9 x 5 nibbles: rows of 2 words.
    let nibbles = texture(5 << 16 | 9, 0x0004_0105);
    assert_eq!([0, 1, 2, 3].map(|level| nibbles.level_size(level)), [[9, 5], [4, 2], [2, 1], [1, 1]]);
    assert_eq!([0, 1, 2, 3].map(|level| nibbles.row_words(level)), [2, 1, 1, 1]);
    assert_eq!([0, 1, 2, 3, 4].map(|level| nibbles.level_offset(level)), [0, 64, 128, 192, 256]);
    assert_eq!(nibbles.bytes(), 196);
    // 32 x 16 words: 2048, 512, 128, 32 and a rest.
    let words = texture(16 << 16 | 32, 0x0004_0100);
    assert_eq!([0, 1, 2, 3, 4].map(|level| words.level_offset(level)), [0, 2048, 2560, 2688, 2752]);
    assert_eq!(words.bytes(), 2720);
    // Rows of 3 x 16 bits take 2 words.
    assert_eq!(texture(2 << 16 | 3, 0x0001_0101).bytes(), 16);
}

#[test]
fn texture_window_of_zero_goes_to_the_end() {
    let window = |window: u32| {
        let registers = [(TEXTURE_SIZE, 8 << 16 | 20), (TEXTURE_OFFSET, 3 << 16 | 1), (TEXTURE_WINDOW, window)];
        state(TEXTURE, &registers).texture.map(|texture| texture.window)
    };
    assert_eq!(window(0), Some([19, 5]));
    assert_eq!(window(7), Some([7, 5]));
    assert_eq!(window(5 << 16), Some([19, 5]));
}

#[test]
fn texture_register_without_a_meaning_is_a_bad_value_and_named() {
    let size = (TEXTURE_SIZE, 8 << 16 | 20);
    let cases = [
        (TEXTURE_SIZE, 0x0000_0001),
        (TEXTURE_SIZE, 0x0001_0000),
        (TEXTURE_SIZE, 0x4001_0001),
        (TEXTURE_CONTROL, 0x0000_0100), // no level
        (TEXTURE_CONTROL, 0x0001_0106), // format
        (TEXTURE_CONTROL, 0x0001_0130), // filter
        (TEXTURE_CONTROL, 0x0006_0100), // 20 texels are halved 4 times
        (TEXTURE_OFFSET, 20),           // outside
        (TEXTURE_OFFSET, 8 << 16),
        (TEXTURE_OFFSET, 0x7FFF),
        (TEXTURE_WINDOW, 21),
        (TEXTURE_WINDOW, 9 << 16),
        (TEXTURE_WINDOW, 0x7FFF),
    ];
    for (offset, value) in cases {
        refused(TEXTURE, &[size, (offset, value)], FaultCode::BadValue, offset);
    }
    let window = [size, (TEXTURE_OFFSET, 15), (TEXTURE_WINDOW, 6)];
    refused(TEXTURE, &window, FaultCode::BadValue, TEXTURE_WINDOW);
    bench(TEXTURE, &[size, (TEXTURE_CONTROL, 0x0005_0100)]).good(0x10, &[0, 0, 0]);
    bench(TEXTURE, &[size, (TEXTURE_OFFSET, 15), (TEXTURE_WINDOW, 5)]).good(0x10, &[0, 0, 0]);
}

#[test]
fn texture_between_chunks_is_a_bad_alignment() {
    refused(TEXTURE, &[(TEXTURE_BASE, 0x8020)], FaultCode::BadAlignment, TEXTURE_BASE);
    let palette = [(TEXTURE_CONTROL, 0x0001_0105), (PALETTE_BASE, 0x20)];
    refused(TEXTURE, &palette, FaultCode::BadAlignment, PALETTE_BASE);
    // Other formats have none.
    bench(TEXTURE, &[(PALETTE_BASE, 0x20)]).good(0x10, &[0, 0, 0]);
}

#[test]
fn texture_or_palette_outside_memory_is_out_of_memory() {
    // 16 x 4 words and a level of 8 x 2: 256 + 64 bytes.
    let texture = |base: u32| [(TEXTURE_BASE, base), (TEXTURE_SIZE, 4 << 16 | 16), (TEXTURE_CONTROL, 0x0002_0100)];
    refused(TEXTURE, &texture(MEMORY - 256), FaultCode::OutOfMemory, TEXTURE_BASE);
    refused(TEXTURE, &texture(0xFFFF_FFC0), FaultCode::OutOfMemory, TEXTURE_BASE);
    bench(TEXTURE, &texture(MEMORY - 320)).good(0x10, &[0, 0, 0]);
    // The largest there is: more than a gigabyte.
    let largest = [(TEXTURE_SIZE, 0x4000_4000), (TEXTURE_CONTROL, 0x000F_0100)];
    refused(TEXTURE, &largest, FaultCode::OutOfMemory, TEXTURE_BASE);
    for (control, bytes) in [(0x0001_0104, 1024), (0x0001_0105, 64)] {
        let palette = |base: u32| [(TEXTURE_CONTROL, control), (PALETTE_BASE, base)];
        refused(TEXTURE, &palette(MEMORY), FaultCode::OutOfMemory, PALETTE_BASE);
        refused(TEXTURE, &palette(MEMORY - bytes + 64), FaultCode::OutOfMemory, PALETTE_BASE);
        bench(TEXTURE, &palette(MEMORY - bytes)).good(0x10, &[0, 0, 0]);
    }
}

#[test]
fn light_registers_become_lights_and_a_material() {
    let registers = [
        (LIGHT_BASE, 0x8000),
        (LIGHT_COUNT, 3),
        (0x035C, 0x0000_3020),
        (0x0360, 0x0010_2030),
        (0x0364, 0x0001_0203),
        (MATERIAL_SHININESS, 40.0_f32.to_bits()),
    ];
    let lighting = Lighting {
        per_pixel: false,
        two_sided: false,
        local_viewer: false,
        lights: 0x8000,
        count: 3,
        ambient: 0x0000_3020,
        specular: 0x0010_2030,
        emission: 0x0001_0203,
        shininess: 40.0,
    };
    let light = |control: u32| state(LIGHT, &[&registers[..], &[(LIGHT_CONTROL, control)]].concat()).light;
    assert_eq!(light(0), Some(lighting));
    assert_eq!(light(1), Some(Lighting { per_pixel: true, ..lighting }));
    assert_eq!(light(2), Some(Lighting { two_sided: true, ..lighting }));
    assert_eq!(light(4), Some(Lighting { local_viewer: true, ..lighting }));
    assert_eq!(state(0, &registers).light, None);
}

#[test]
fn light_register_without_a_meaning_is_refused_and_named() {
    refused(LIGHT, &[(LIGHT_COUNT, 257)], FaultCode::BadValue, LIGHT_COUNT);
    refused(LIGHT, &[(LIGHT_BASE, 0x20)], FaultCode::BadAlignment, LIGHT_BASE);
    let records = |base: u32, count: u32| [(LIGHT_BASE, base), (LIGHT_COUNT, count)];
    refused(LIGHT, &records(MEMORY - 64, 2), FaultCode::OutOfMemory, LIGHT_BASE);
    refused(LIGHT, &records(MEMORY - 256 * 64 + 64, 256), FaultCode::OutOfMemory, LIGHT_BASE);
    bench(LIGHT, &records(MEMORY - 64, 1)).good(0x10, &[0, 0, 0]);
    bench(LIGHT, &records(MEMORY - 256 * 64, 256)).good(0x10, &[0, 0, 0]);
    bench(LIGHT, &records(0xFFFF_FFC0, 0)).good(0x10, &[0, 0, 0]);
    for shininess in [-0.5, 128.5, f32::NAN, f32::INFINITY] {
        let registers = [(MATERIAL_SHININESS, shininess.to_bits())];
        refused(LIGHT, &registers, FaultCode::BadValue, MATERIAL_SHININESS);
    }
}

#[test]
fn fog_registers_become_fog() {
    let numbers = [0.5_f32, 40.0, -0.25, 1.5];
    let registers = [0x0334, 0x0338, 0x033C, 0x0340].into_iter().zip(numbers.map(f32::to_bits));
    let registers: Vec<_> = registers.chain([(0x0344, 0x00C0_B0A0)]).collect();
    let fog = |control: u32| state(FOG, &[&registers[..], &[(FOG_CONTROL, control)]].concat()).fog;
    let expected = |function| {
        Some(Fog { function, density: 0.5, end: 40.0, cue_scale: -0.25, cue_offset: 1.5, colour: 0x00C0_B0A0 })
    };
    assert_eq!(fog(0), None);
    assert_eq!(fog(1), expected(FogFunction::Linear));
    assert_eq!(fog(2), expected(FogFunction::Exponential));
    assert_eq!(fog(3), expected(FogFunction::ExponentialSquared));
    assert_eq!(fog(4), expected(FogFunction::DepthCue));
    assert_eq!(state(0, &[(FOG_CONTROL, 1)]).fog, None);
}

#[test]
fn fog_register_without_a_meaning_is_a_bad_value_and_named() {
    refused(FOG, &[(FOG_CONTROL, 5)], FaultCode::BadValue, FOG_CONTROL);
    let cases = [
        (0x0334, -1.0),
        (0x0334, f32::INFINITY),
        (0x0338, 0.0),
        (0x0338, -0.0),
        (0x0338, f32::NAN),
        (0x033C, f32::NEG_INFINITY),
        (0x0340, f32::NAN),
    ];
    for (offset, value) in cases {
        let registers = [(FOG_CONTROL, 1), (offset, value.to_bits())];
        refused(FOG, &registers, FaultCode::BadValue, offset);
        // Without a function nothing of it counts.
        bench(FOG, &[(offset, value.to_bits())]).good(0x10, &[0, 0, 0]);
    }
    // The least number above 0.
    bench(FOG, &[(FOG_CONTROL, 1), (0x0338, 1), (0x0334, 0x8000_0000)]).good(0x10, &[0, 0, 0]);
}

#[test]
fn blend_needs_no_grid_and_its_mode_counts_where_it_is_called() {
    let mode = |effects: u32, mode: u32| state(effects, &[(BLEND_CONTROL, mode)]).blend;
    let modes = [BlendMode::Alpha, BlendMode::Add, BlendMode::Multiply, BlendMode::Premultiplied];
    assert_eq!([0, 1, 2, 3].map(|code| mode(BLEND, code)), modes);
    assert_eq!(mode(0, 3), BlendMode::Alpha);
    refused(BLEND, &[(BLEND_CONTROL, 4)], FaultCode::BadValue, BLEND_CONTROL);
}

#[test]
fn effects_that_the_card_lacks_are_unsupported_before_their_registers_are_looked_at() {
    for effect in [TEXTURE, MIP_MAP, LIGHT, FOG, BLEND, PUNCH_THROUGH] {
        let mut bench = bench(effect, &[(TEXTURE_SIZE, 0), (LIGHT_COUNT, 257), (FOG_CONTROL, 7), (BLEND_CONTROL, 7)]);
        bench.card.set(0x0008, 0xFFF & !effect);
        bench.bad(0x10, &[0, 0, 0], FaultCode::Unsupported, 0, EFFECTS);
        bench.bad(0x01, &[EFFECTS, effect], FaultCode::Unsupported, 2, effect);
    }
}

/// Values of registers in a scene with a stencil plane whose draws call for `effects`.
fn stencil_bench(effects: u32, registers: &[(u32, u32)]) -> Bench {
    let mut bench = Bench::with_stencil_plane();
    bench.good(0x02, &[]);
    bench.card.set(EFFECTS, effects);
    for &(offset, value) in registers {
        bench.card.set(offset, value);
    }
    bench
}

#[test]
fn stencil_registers_become_a_test_with_operations_for_both_sides() {
    use StencilOperation::{Decrement, DecrementWrap, Increment, IncrementWrap, Invert, Keep, Replace, Zero};
    let mut bench = stencil_bench(STENCIL, &[(STENCIL_CONTROL, 0x7654_3213), (STENCIL_VALUE, 0x00CD_AB42)]);
    let Call::Draw(state, _) = bench.last(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat()) else {
        panic!("no draw");
    };
    let expected = Stencil {
        test: StencilTest { function: DepthFunction::LessEqual, reference: 0x42, read_mask: 0xAB },
        write_mask: 0xCD,
        front: StencilOperations { fail: Replace, depth_fail: Increment, pass: Decrement },
        back: StencilOperations { fail: Invert, depth_fail: IncrementWrap, pass: DecrementWrap },
        colour_off: true,
    };
    assert_eq!(state.stencil, Some(expected));
    // As the card resets them: everything passes and nothing changes.
    let mut bench = stencil_bench(STENCIL, &[]);
    let Call::Draw(state, _) = bench.last(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat()) else {
        panic!("no draw");
    };
    let keep = StencilOperations { fail: Keep, depth_fail: Keep, pass: Keep };
    let test = StencilTest { function: DepthFunction::Always, reference: 0, read_mask: 0xFF };
    let plain = Stencil { test, write_mask: 0xFF, front: keep, back: keep, colour_off: false };
    assert_eq!(state.stencil, Some(plain));
    assert_eq!(plain.apply(Zero, 9), 0);
}

#[test]
fn stencil_without_a_plane_or_with_a_grid_is_refused_at_effects() {
    refused(STENCIL, &[], FaultCode::BadValue, EFFECTS);
    let mut bench = Bench::with_stencil_plane();
    bench.card.set(0x0260, 1);
    bench.good(0x02, &[]);
    bench.card.set(EFFECTS, STENCIL);
    bench.bad(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat(), FaultCode::Unsupported, 0, EFFECTS);
    bench.card.set(EFFECTS, 0);
    bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
}

#[test]
fn stencil_with_blending_may_test_but_not_change_nor_draw_no_colour() {
    let triangle = [&[0, 3, 0], &TRIANGLE[..]].concat();
    for control in [0x0000_0103, 0x0000_2003, 0x0005_0003, 0x0020_0003, 0x0300_0003, 0x7000_0003, 0x13] {
        let mut bench = stencil_bench(STENCIL | BLEND, &[(STENCIL_CONTROL, control)]);
        bench.bad(0x10, &triangle, FaultCode::Unsupported, 0, STENCIL_CONTROL);
        // A mask of 0 changes nothing, whatever the operation.
        bench.card.set(STENCIL_VALUE, 0x0000_FF00);
        let (result, _) = bench.run(&crate::bench::packet(0x10, &triangle));
        assert_eq!(result.is_ok(), control != 0x13, "{control:#x}");
        bench.card.set(EFFECTS, STENCIL);
        bench.good(0x10, &triangle);
    }
    stencil_bench(STENCIL | BLEND, &[(STENCIL_CONTROL, 3)]).good(0x10, &triangle);
}

#[test]
fn stencil_with_colours_off_asks_for_no_colour() {
    // No register of light and texture would do; a texture with holes is asked for them all the same.
    let called = STENCIL | LIGHT | FOG | TEXTURE | MIP_MAP | 0x2;
    let wrong = [(STENCIL_CONTROL, 0x17), (LIGHT_COUNT, 257), (TEXTURE_SIZE, 0), (FOG_CONTROL, 5)];
    let mut bench = stencil_bench(called, &wrong);
    let Call::Draw(state, _) = bench.last(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat()) else {
        panic!("no draw");
    };
    assert_eq!(state.effects.bits(), STENCIL);
    bench.card.set(EFFECTS, called | PUNCH_THROUGH);
    bench.bad(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat(), FaultCode::BadValue, 0, TEXTURE_SIZE);
}
