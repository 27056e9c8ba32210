//! Textures: what lies in memory and what the driver sends for it, against numbers restated from the manual.

mod common;

use std::time::Duration;

use common::{opcodes, target, triangle};
use zga_abi::format::{TextureFilter, TextureFormat, TextureFunction, Topology};
use zga_abi::registers::Reg;
use zga_abi::{Fault, FaultCode};
use zga_driver::bus::{MockBus, Pace};
use zga_driver::{
    Camera, Driver, DriverError, DriverOptions, Submit, Target, Texture, TextureOptions, TextureState, Vertices,
};

/// TEXTURE_BASE, TEXTURE_SIZE, TEXTURE_CONTROL, TEXTURE_OFFSET, TEXTURE_WINDOW, TEXTURE_COLOUR, TEXTURE_BIAS,
/// PALETTE_BASE.
const TEXTURE: [u32; 8] = [0x0300, 0x0304, 0x0308, 0x030C, 0x0310, 0x0314, 0x0318, 0x031C];
const EFFECTS: u32 = 0x0280;
const DEPTH: u32 = 1;
const PERSPECTIVE: u32 = 1 << 2;
const TEXTURED: u32 = 1 << 4;
const MIP_MAP: u32 = 1 << 5;
const PUNCH_THROUGH: u32 = 1 << 9;

const CORNERS: [[f32; 3]; 3] = [[1.0, 2.0, 0.5], [30.0, 2.0, 0.5], [1.0, 40.0, 0.5]];
const COORDINATES: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// A driver on a mock card with every effect.
fn driver() -> Driver<MockBus> {
    let mut bus = MockBus::new(common::MEMORY);
    bus.set_register(Reg::CapabilityEffects, 0xFFF);
    let options = DriverOptions { submit: Submit::Ring, ring_words: 4096, timeout: Duration::from_millis(1) };
    Driver::open_with(bus, options).expect("the mock card opens")
}

fn options(width: u32, height: u32, format: TextureFormat, mip_map: bool) -> TextureOptions {
    TextureOptions { width, height, format, mip_map }
}

fn textured() -> Vertices<'static> {
    Vertices::new(&CORNERS).coordinates(&COORDINATES)
}

/// A scene with one textured triangle.
fn scene(driver: &mut Driver<MockBus>, target: &Target) {
    driver.begin_scene(target).expect("begins");
    driver.draw_vertices(Topology::Triangles, &textured(), None).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
}

fn registers<const N: usize>(driver: &Driver<MockBus>, offsets: [u32; N]) -> [u32; N] {
    offsets.map(|offset| driver.bus().register(offset))
}

/// Words of video memory from byte `address` on.
fn memory(driver: &Driver<MockBus>, address: u32, words: u32) -> Vec<u32> {
    driver.bus().memory()[(address / 4) as usize..][..words as usize].to_vec()
}

/// The first byte of a texture, as a draw tells the card.
fn base(driver: &mut Driver<MockBus>, target: &Target, texture: &Texture) -> u32 {
    driver.set_texture(Some(&TextureState::new(texture))).expect("known");
    scene(driver, target);
    driver.bus().register(TEXTURE[0])
}

fn grey(level: u8) -> [u8; 4] {
    [level, level, level, 255]
}

fn word(level: u32) -> u32 {
    (level * 0x0001_0101) | 0xFF00_0000
}

#[test]
fn upload_levels_follow_each_other_at_multiples_of_64_bytes() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(8, 4, TextureFormat::Rgba8888, true)).expect("room");
    // Columns of 10, 20, 30, ...; all rows alike.
    let texels: Vec<[u8; 4]> = (0..32).map(|at| grey(10 + 10 * (at % 8))).collect();
    driver.upload_texture(&texture, &texels).expect("fits");
    let base = base(&mut driver, &target, &texture);
    assert_eq!(base % 64, 0);
    assert_eq!(memory(&driver, base, 8), [10, 20, 30, 40, 50, 60, 70, 80].map(word));
    assert_eq!(memory(&driver, base + 128, 8), [15, 35, 55, 75, 15, 35, 55, 75].map(word));
    assert_eq!(memory(&driver, base + 192, 2), [25, 65].map(word));
    assert_eq!(memory(&driver, base + 256, 1), [45].map(word));
    assert_eq!((texture.levels(), texture.bytes()), (4, 260));
}

#[test]
fn upload_odd_sides_average_the_exact_area() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(5, 1, TextureFormat::Rgba8888, true)).expect("room");
    driver.upload_texture(&texture, &[0, 10, 200, 40, 50].map(grey)).expect("fits");
    let base = base(&mut driver, &target, &texture);
    assert_eq!(memory(&driver, base + 64, 2), [44, 76].map(word));
    assert_eq!(memory(&driver, base + 128, 1), [60].map(word));
}

#[test]
fn upload_rows_of_small_texels_begin_words() {
    let mut driver = driver();
    let target = target(&mut driver);
    let red_green = [[255, 0, 0, 255], [0, 255, 0, 255], [255, 0, 0, 255], [0, 255, 0, 255]].repeat(2);
    let cases = [
        (TextureFormat::Rgb565, vec![0x07E0_F800, 0x07E0_F800, 0x07E0_F800, 0x07E0_F800]),
        (TextureFormat::Rgba5551, vec![0x83E0_FC00, 0x83E0_FC00]),
        (TextureFormat::Rgba4444, vec![0xF0F0_FF00, 0xF0F0_FF00]),
        (TextureFormat::Palette8, vec![0x0100_0100, 0x0100_0100]),
        (TextureFormat::Palette4, vec![0x1010, 0x1010]),
    ];
    for (format, expected) in cases {
        let texture = driver.create_texture(&options(4, 2, format, false)).expect("room");
        driver.upload_texture(&texture, &red_green).expect("fits");
        let base = base(&mut driver, &target, &texture);
        assert_eq!(memory(&driver, base, expected.len() as u32), expected, "{}", format.name());
    }
    let palette = driver.bus().register(TEXTURE[7]);
    assert_eq!(palette % 64, 0);
    assert_eq!(memory(&driver, palette, 3), [0xFF00_00FF, 0xFF00_FF00, 0]);
}

#[test]
fn upload_with_a_palette_takes_the_nearest_colour() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(4, 1, TextureFormat::Palette4, false)).expect("room");
    let palette = [0, 100, 200].map(grey);
    driver.upload_texture_with_palette(&texture, &[49, 51, 150, 255].map(grey), &palette).expect("fits");
    let base = base(&mut driver, &target, &texture);
    // 150 is as far from 100 as from 200: the first.
    assert_eq!(memory(&driver, base, 1), [0x2110]);
}

#[test]
fn upload_that_does_not_fit_is_refused_and_writes_nothing() {
    let mut driver = driver();
    let four = driver.create_texture(&options(17, 1, TextureFormat::Palette4, false)).expect("room");
    let plain = driver.create_texture(&options(17, 1, TextureFormat::Rgba8888, false)).expect("room");
    let texels: Vec<[u8; 4]> = (0..17).map(grey).collect();
    let before = driver.bus().memory().to_vec();
    let told = |refused: Result<(), DriverError>| refused.expect_err("does not fit").to_string();
    let colours = driver.upload_texture(&four, &texels);
    assert_eq!(
        told(colours),
        "the picture has more than 16 colours: a palette4 texture needs upload_texture_with_palette"
    );
    let refused = driver.upload_texture(&plain, &texels[1..]);
    assert_eq!(told(refused), "16 texels for a texture of 17 x 1");
    let refused = driver.upload_texture_with_palette(&four, &texels, &texels);
    assert_eq!(told(refused), "texture palette is 17 colours, expected 1 to 16 colours");
    let refused = driver.upload_texture_with_palette(&four, &texels, &[]);
    assert_eq!(told(refused), "texture palette is 0 colours, expected 1 to 16 colours");
    let refused = driver.upload_texture_with_palette(&plain, &texels, &texels[..4]);
    assert_eq!(told(refused), "texture palette is 4 colours, expected none: the format of the texture has no palette");
    assert!(driver.bus().memory() == before, "nothing was written");
    driver.upload_texture_with_palette(&four, &texels, &texels[..16]).expect("16 colours fit");
}

#[test]
fn create_out_of_range_or_out_of_memory_is_refused_and_takes_nothing() {
    let mut driver = driver();
    let before = driver.memory().free_bytes();
    let told = |refused: Result<Texture, DriverError>| refused.expect_err("out of range").to_string();
    let refused = driver.create_texture(&TextureOptions::new(0, 5));
    assert_eq!(told(refused), "texture width is 0, expected 1 to 16384 texels");
    let refused = driver.create_texture(&TextureOptions::new(1, 16385));
    assert_eq!(told(refused), "texture height is 16385, expected 1 to 16384 texels");
    let huge = driver.create_texture(&TextureOptions::new(16384, 16384)).expect_err("a third more than 1 GiB");
    // 4 (4^15 - 1) / 3 bytes, and 48 to the multiple of 64 behind the level of 2 x 2.
    assert!(huge.to_string().contains("1431655812 bytes asked for"), "{huge}");
    // The levels fit, the palette does not.
    let rest = u32::try_from(driver.memory().largest_free()).expect("a few MiB");
    let all = options(16384, rest / 16384, TextureFormat::Palette8, false);
    let taken = driver.allocate(u64::from(rest % 16384), zga_driver::Alignment::Line).expect("room");
    assert!(matches!(driver.create_texture(&all), Err(DriverError::Memory(_))));
    driver.free(taken).expect("known");
    assert_eq!(driver.memory().free_bytes(), before);
}

#[test]
fn draw_textured_programs_every_field() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(16, 8, TextureFormat::Palette8, true)).expect("room");
    let state = TextureState {
        filter: TextureFilter::Bilinear,
        function: TextureFunction::Blend,
        repeat: [true, false],
        mirror: [false, true],
        offset: [3, 2],
        window: Some([13, 1]),
        bias: -1.5,
        colour: [1, 2, 3, 4],
        ..TextureState::new(&texture)
    };
    driver.set_texture(Some(&state)).expect("right");
    scene(&mut driver, &target);
    let [base, size, control, offset, window, colour, bias, palette] = registers(&driver, TEXTURE);
    assert_eq!([size, control, offset, window], [8 << 16 | 16, 0x0005_9314, 2 << 16 | 3, 1 << 16 | 13]);
    assert_eq!([colour, bias], [0x0403_0201, 0xFE80]);
    // 5 levels: 128, 64 (32), 64 (8), 64 (4), 64 (4) bytes; then the palette.
    assert_eq!(palette, base + 384);
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | TEXTURED | MIP_MAP);
    let draw = driver.bus_mut().take_packets().into_iter().find(|packet| packet[0] >> 24 == 0x10).expect("a draw");
    assert_eq!(draw[..4], [0x1000_0012, 0x400, 3, 0]);
    assert_eq!(draw[9..14], [30.0, 2.0, 0.5, 1.0, 0.0].map(f32::to_bits));
}

#[test]
fn draw_without_coordinates_or_without_a_texture_sends_nothing_of_it() {
    let mut driver = driver();
    let target = target(&mut driver);
    let reset = registers(&driver, TEXTURE);
    scene(&mut driver, &target);
    let texture = driver.create_texture(&TextureOptions::new(8, 8)).expect("room");
    driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
    driver.set_punch_through(Some(7)).expect("there");
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle([255; 4])).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(registers(&driver, TEXTURE), reset);
    assert_eq!(registers(&driver, [EFFECTS, 0x0320]), [DEPTH, 0x80]);
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [1, 2, 0x10, 3, 0x30, 2, 0x10, 3, 0x30], "the target alone");
}

#[test]
fn draw_textured_again_sends_no_register() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&TextureOptions::new(8, 8)).expect("room");
    driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
    scene(&mut driver, &target);
    driver.bus_mut().take_packets();
    scene(&mut driver, &target);
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [2, 0x10, 3, 0x30]);
}

#[test]
fn draw_textured_calls_for_levels_holes_and_perspective_where_they_count() {
    let mut driver = driver();
    let target = target(&mut driver);
    let mut called = |format, mip_map, holes, camera: Option<Camera>| {
        let texture = driver.create_texture(&options(8, 8, format, mip_map)).expect("room");
        driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
        driver.set_punch_through(holes).expect("there");
        driver.set_camera(camera.unwrap_or_default()).expect("good camera");
        scene(&mut driver, &target);
        driver.bus().register(EFFECTS)
    };
    let perspective = Camera::Perspective {
        eye: [0.0, 0.0, 5.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 60.0,
        near: 1.0,
        far: 9.0,
    };
    let plain = DEPTH | TEXTURED;
    assert_eq!(called(TextureFormat::Rgba8888, false, None, None), plain);
    assert_eq!(called(TextureFormat::Rgba8888, true, None, Some(perspective)), plain | MIP_MAP | PERSPECTIVE);
    assert_eq!(called(TextureFormat::Rgba8888, false, Some(9), None), plain | PUNCH_THROUGH);
    assert_eq!(called(TextureFormat::Rgba8888, false, Some(0), None), plain, "no alpha is below 0");
    assert_eq!(called(TextureFormat::Rgb565, false, Some(9), None), plain, "the format is opaque");
    assert_eq!(driver.bus().register(0x0320), 9);
}

#[test]
fn set_texture_fields_out_of_range_are_named_and_leave_what_was() {
    let mut driver = driver();
    let texture = driver.create_texture(&options(16, 8, TextureFormat::Rgb565, false)).expect("room");
    let whole = TextureState::new(&texture);
    let cases = [
        (TextureState { offset: [16, 0], ..whole }, "texture offset is 16, 0, expected a texel of the texture"),
        (
            TextureState { offset: [0, u32::MAX], ..whole },
            "texture offset is 0, 4294967295, expected a texel of the texture",
        ),
        (
            TextureState { offset: [10, 0], window: Some([7, 8]), ..whole },
            "texture window is 7, 8, expected at least 1, 1 and from the offset to the end at most",
        ),
        (
            TextureState { window: Some([16, 0]), ..whole },
            "texture window is 16, 0, expected at least 1, 1 and from the offset to the end at most",
        ),
        (TextureState { bias: 128.0, ..whole }, "texture bias is 128, expected -128 to 32767/256 levels"),
        (TextureState { bias: f64::NAN, ..whole }, "texture bias is NaN, expected -128 to 32767/256 levels"),
    ];
    let target = target(&mut driver);
    driver.set_texture(Some(&TextureState { bias: 127.0, ..whole })).expect("right");
    for (state, expected) in cases {
        assert_eq!(driver.set_texture(Some(&state)).expect_err(expected).to_string(), expected);
    }
    scene(&mut driver, &target);
    assert_eq!(driver.bus().register(TEXTURE[6]), 0x7F00);
}

#[test]
fn texture_of_another_driver_or_freed_is_unknown_and_freeing_ends_its_use() {
    let (mut driver, mut other) = (driver(), driver());
    let target = target(&mut driver);
    let stranger = other.create_texture(&TextureOptions::new(1, 1)).expect("room");
    assert_eq!(driver.set_texture(Some(&TextureState::new(&stranger))), Err(DriverError::UnknownTexture { id: 0 }));
    assert_eq!(driver.upload_texture(&stranger, &[[0; 4]]), Err(DriverError::UnknownTexture { id: 0 }));
    let texture = driver.create_texture(&TextureOptions::new(4, 4)).expect("room");
    driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
    driver.free_texture(texture).expect("known");
    scene(&mut driver, &target);
    assert_eq!(driver.bus().register(EFFECTS), DEPTH);
}

#[test]
fn upload_again_keeps_the_texels_that_draws_of_the_scene_read() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(2, 1, TextureFormat::Rgba8888, false)).expect("room");
    let draw = |driver: &mut Driver<MockBus>, level: u8| {
        driver.upload_texture(&texture, &[grey(level); 2]).expect("room");
        driver.draw_vertices(Topology::Triangles, &textured(), None).expect("draws");
        driver.finish().expect("done");
        driver.bus().register(TEXTURE[0])
    };
    driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
    driver.begin_scene(&target).expect("begins");
    let free = driver.memory().free_bytes();
    // The card may read texels as late as at the end of the scene: finishing is not enough.
    let bases = [draw(&mut driver, 1), draw(&mut driver, 2)];
    assert_eq!(bases.map(|base| memory(&driver, base, 1)[0]), [1, 2].map(word));
    assert_eq!(driver.memory().free_bytes(), free - 64);
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(driver.memory().free_bytes(), free);
    driver.upload_texture(&texture, &[grey(3); 2]).expect("in place");
    assert_eq!(memory(&driver, bases[1], 1), [word(3)]);
}

#[test]
fn free_in_a_scene_keeps_the_memory_until_its_end() {
    let mut driver = driver();
    let target = target(&mut driver);
    let free = driver.memory().free_bytes();
    let texture = driver.create_texture(&options(16, 16, TextureFormat::Palette4, true)).expect("room");
    let taken = driver.memory().free_bytes();
    driver.set_texture(Some(&TextureState::new(&texture))).expect("known");
    driver.begin_scene(&target).expect("begins");
    driver.draw_vertices(Topology::Triangles, &textured(), None).expect("draws");
    driver.free_texture(texture).expect("known");
    driver.finish().expect("done");
    assert_eq!(driver.memory().free_bytes(), taken);
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(driver.memory().free_bytes(), free);
}

#[test]
fn recovery_after_a_refused_packet_puts_the_texture_s_registers_back() {
    let mut driver = driver();
    let target = target(&mut driver);
    let texture = driver.create_texture(&options(16, 8, TextureFormat::Palette8, true)).expect("room");
    driver.set_texture(Some(&TextureState { bias: 1.0, ..TextureState::new(&texture) })).expect("known");
    driver.set_punch_through(Some(3)).expect("there");
    scene(&mut driver, &target);
    let expected = registers(&driver, TEXTURE);
    driver.bus_mut().take_packets();

    // The draw of the next scene is refused; the one behind it must find its texture.
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    let refused = driver.bus().packets_met() + 1;
    driver.bus_mut().refuse_packet(refused, Fault::new(FaultCode::BadValue, 0, 0x0300));
    driver.begin_scene(&target).expect("begins");
    driver.draw_vertices(Topology::Triangles, &textured(), None).expect("encoded");
    let fault = driver.finish().expect_err("refused").to_string();
    assert!(fault.contains("register TEXTURE_BASE"), "{fault}");
    assert_eq!(registers(&driver, TEXTURE), expected);
    assert_eq!(driver.bus().register(0x0320), 3);
    driver.draw_vertices(Topology::Triangles, &textured(), None).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(registers(&driver, TEXTURE), expected);
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [2, 2, 0x30, 0x10, 3, 0x30]);
}

#[test]
fn card_without_a_texture_unit_refuses_textures() {
    let mut driver = common::driver(Submit::Ring);
    let refused = driver.create_texture(&TextureOptions::new(4, 4)).expect_err("no unit").to_string();
    assert_eq!(refused, "this card has no textures: CAPABILITY_EFFECTS reads 0xf");
    let refused = driver.set_punch_through(Some(1)).expect_err("no unit").to_string();
    assert_eq!(refused, "this card has no punch-through textures: CAPABILITY_EFFECTS reads 0xf");
    driver.set_texture(None).expect("none is always possible");
    driver.set_punch_through(None).expect("none is always possible");
}
