//! Lights, materials, fog, blending, stencil and shadows: what the driver sends for them, against numbers restated from the manual.

mod common;

use std::time::Duration;

use common::{opcodes, target, triangle};
use zga_abi::format::{BlendMode, DepthFunction, StencilOperation, Topology};
use zga_abi::registers::Reg;
use zga_abi::{Fault, FaultCode};
use zga_driver::bus::{MockAccess, MockBus, Pace};
use zga_driver::{
    Antialias, Camera, Driver, DriverError, DriverOptions, Fog, FogCurve, Light, LightSource, Material, Shadow,
    Stencil, StencilSide, Submit, Target, TargetOptions, Vertex, Vertices,
};

const EFFECTS: u32 = 0x0280;
const DEPTH: u32 = 1;
const GOURAUD: u32 = 1 << 1;
const PERSPECTIVE: u32 = 1 << 2;
const LIGHT: u32 = 1 << 6;
const FOG: u32 = 1 << 7;
const BLEND: u32 = 1 << 8;
const ANTI_ALIAS: u32 = 1 << 10;
const STENCIL: u32 = 1 << 11;

const BLEND_CONTROL: u32 = 0x0324;
/// FOG_CONTROL, FOG_DENSITY, FOG_END, DEPTH_CUE_SCALE, DEPTH_CUE_OFFSET, FOG_COLOUR.
const FOG_REGISTERS: [u32; 6] = [0x0330, 0x0334, 0x0338, 0x033C, 0x0340, 0x0344];
/// LIGHT_CONTROL, LIGHT_BASE, LIGHT_COUNT, SCENE_AMBIENT, MATERIAL_SPECULAR, MATERIAL_EMISSION, MATERIAL_SHININESS.
const LIGHT_REGISTERS: [u32; 7] = [0x0350, 0x0354, 0x0358, 0x035C, 0x0360, 0x0364, 0x0368];

const CORNERS: [[f32; 3]; 3] = [[1.0, 2.0, 0.5], [30.0, 2.0, 0.5], [1.0, 40.0, 0.5]];
const NORMALS: [[f32; 3]; 3] = [[0.0, 0.0, 1.0]; 3];
const WHITE: [u8; 4] = [255; 4];
const SUN: Light = Light::new(LightSource::Directional { direction: [0.0, 0.0, -2.0] }, [200, 100, 50, 255]);

/// Looks from (3, 0, 5) along -z.
const PERSPECTIVE_CAMERA: Camera = Camera::Perspective {
    eye: [3.0, 0.0, 5.0],
    target: [3.0, 0.0, 0.0],
    up: [0.0, 1.0, 0.0],
    fov_x_degrees: 60.0,
    near: 1.0,
    far: 90.0,
};

/// A driver on a mock card with every effect.
fn driver() -> Driver<MockBus> {
    let mut bus = MockBus::new(common::MEMORY);
    bus.set_register(Reg::CapabilityEffects, 0xFFF);
    let options = DriverOptions { submit: Submit::Ring, ring_words: 4096, timeout: Duration::from_millis(1) };
    Driver::open_with(bus, options).expect("the mock card opens")
}

fn with_normals() -> Vertices<'static> {
    Vertices::new(&CORNERS).normals(&NORMALS)
}

/// A scene with one draw; the effects that it called for.
fn scene(driver: &mut Driver<MockBus>, target: &Target, topology: Topology, vertices: &Vertices<'_>) -> u32 {
    driver.begin_scene(target).expect("begins");
    driver.draw_vertices(topology, vertices, None).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    driver.bus().register(EFFECTS)
}

fn triangles(driver: &mut Driver<MockBus>, target: &Target) -> u32 {
    scene(driver, target, Topology::Triangles, &with_normals())
}

fn registers<const N: usize>(driver: &Driver<MockBus>, offsets: [u32; N]) -> [u32; N] {
    offsets.map(|offset| driver.bus().register(offset))
}

/// The record of light `number`.
fn record(driver: &Driver<MockBus>, number: usize) -> Vec<u32> {
    let first = driver.bus().register(LIGHT_REGISTERS[1]) as usize / 4 + 16 * number;
    driver.bus().memory()[first..first + 16].to_vec()
}

/// Words of a record.
fn words(kind: u32, numbers: [f32; 8], colour: u32, ambient: u32) -> Vec<u32> {
    [&[kind], &numbers.map(f32::to_bits)[..], &[colour, ambient, 0, 0, 0, 0, 0]].concat()
}

#[test]
fn lights_of_each_kind_have_the_record_of_the_manual_in_eye_space() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_camera(PERSPECTIVE_CAMERA).expect("good camera");
    let point = LightSource::Point { position: [3.0, 1.0, 2.0] };
    let spot = LightSource::Spot { position: [4.0, 0.0, 5.0], direction: [0.0, 8.0, 0.0], exponent: 16.0 };
    let lights = [
        SUN,
        Light { cut_off: Some(7.5), ambient: [1, 2, 3, 4], ..Light::new(point, [255, 0, 0, 0]) },
        Light::new(spot, WHITE),
    ];
    driver.set_lights(&lights).expect("good lights");
    triangles(&mut driver, &target);
    assert_eq!(driver.bus().register(0x0354) % 64, 0);
    let black = 0xFF00_0000;
    let sun = words(0, [0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0], 0xFF32_64C8, black);
    assert_eq!(record(&driver, 0), sun);
    let point = words(1, [0.0, 1.0, -3.0, 0.0, 0.0, 0.0, 7.5, 0.0], 0x0000_00FF, 0x0403_0201);
    assert_eq!(record(&driver, 1), point);
    let spot = words(2, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 16.0], 0xFFFF_FFFF, black);
    assert_eq!(record(&driver, 2), spot);
}

#[test]
fn lights_and_material_reach_their_registers() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_lights(&[SUN; 5]).expect("good lights");
    driver.set_scene_ambient([10, 20, 30, 255]).expect("there");
    let material =
        Material { specular: [1, 2, 3, 0], emission: [4, 5, 6, 0], shininess: 40.0, two_sided: true, per_pixel: true };
    driver.set_material(material).expect("good");
    let effects = triangles(&mut driver, &target);
    let [control, base, count, ambient, specular, emission, shininess] = registers(&driver, LIGHT_REGISTERS);
    assert_eq!([control, count], [0b011, 5]);
    assert_eq!([ambient, specular, emission], [0xFF1E_140A, 0x0003_0201, 0x0006_0504]);
    assert_eq!((base % 64, f32::from_bits(shininess)), (0, 40.0));
    assert_eq!(effects, DEPTH | LIGHT);
    driver.set_camera(PERSPECTIVE_CAMERA).expect("good camera");
    assert_eq!(triangles(&mut driver, &target), DEPTH | LIGHT | PERSPECTIVE);
    assert_eq!(driver.bus().register(LIGHT_REGISTERS[0]), 0b111, "the viewer is at the eye");
}

#[test]
fn lit_draws_are_those_with_normals_while_there_is_light() {
    let mut driver = driver();
    let target = target(&mut driver);
    let reset = registers(&driver, LIGHT_REGISTERS);
    let free = driver.memory().free_bytes();
    let plain = Vertices::new(&CORNERS);
    assert_eq!(triangles(&mut driver, &target), DEPTH, "no light is set");
    driver.set_lights(&[SUN]).expect("good light");
    assert_eq!(scene(&mut driver, &target, Topology::Triangles, &plain), DEPTH, "no normals");
    assert_eq!(registers(&driver, LIGHT_REGISTERS), reset);
    assert_eq!(driver.memory().free_bytes(), free, "nothing was placed");
    assert_eq!(triangles(&mut driver, &target), DEPTH | LIGHT | GOURAUD);
    assert_eq!(scene(&mut driver, &target, Topology::Points, &with_normals()), DEPTH | LIGHT);
    driver.set_lights(&[]).expect("none");
    assert_eq!(triangles(&mut driver, &target), DEPTH);
    driver.set_scene_ambient([0; 4]).expect("there");
    assert_eq!(triangles(&mut driver, &target), DEPTH | LIGHT | GOURAUD, "lit, but by nothing");
    assert_eq!(driver.bus().register(LIGHT_REGISTERS[2]), 0);
    assert_eq!(driver.memory().free_bytes(), free, "no records");
    driver.set_scene_ambient(None).expect("possible");
    assert_eq!(triangles(&mut driver, &target), DEPTH);
}

#[test]
fn records_travel_only_when_lights_or_camera_have_changed() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_lights(&[SUN]).expect("good light");
    triangles(&mut driver, &target);
    // Bursts of one record; the ring's batches are longer.
    let placed = |driver: &mut Driver<MockBus>| {
        driver.bus_mut().take_accesses();
        let effects = triangles(driver, &target);
        assert_eq!(effects & LIGHT, LIGHT);
        let accesses = driver.bus_mut().take_accesses();
        accesses.iter().filter(|access| matches!(access, MockAccess::WriteBurst(_, 16))).count()
    };
    assert_eq!(placed(&mut driver), 0);
    driver.set_lights(&[SUN]).expect("the same");
    assert_eq!(placed(&mut driver), 0);
    driver.set_camera(Camera::Screen).expect("the same");
    assert_eq!(placed(&mut driver), 0);
    // The sun shines along the line of sight of both: its record is the same.
    driver.set_camera(PERSPECTIVE_CAMERA).expect("good camera");
    assert_eq!(placed(&mut driver), 0);
    driver.set_lights(&[Light { colour: WHITE, ..SUN }]).expect("good light");
    assert_eq!(placed(&mut driver), 1);
    driver.set_material(Material { per_pixel: true, ..Material::default() }).expect("good");
    assert_eq!(placed(&mut driver), 0);
}

#[test]
fn lit_draw_again_sends_no_register() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_lights(&[SUN]).expect("good light");
    triangles(&mut driver, &target);
    driver.bus_mut().take_packets();
    triangles(&mut driver, &target);
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [2, 0x10, 3, 0x30]);
}

#[test]
fn lights_changed_in_a_scene_leave_the_records_of_its_draws_alone() {
    let mut driver = driver();
    let target = target(&mut driver);
    let free = driver.memory().free_bytes();
    driver.begin_scene(&target).expect("begins");
    let bases = [10, 20, 30].map(|red| {
        driver.set_lights(&[Light { colour: [red, 0, 0, 0], ..SUN }]).expect("good light");
        driver.draw_vertices(Topology::Triangles, &with_normals(), None).expect("draws");
        driver.finish().expect("done");
        driver.bus().register(LIGHT_REGISTERS[1])
    });
    let colours = bases.map(|base| driver.bus().memory()[base as usize / 4 + 9]);
    assert_eq!(colours, [10, 20, 30]);
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(driver.memory().free_bytes(), free - 64, "the last lights stay");
}

#[test]
fn lights_without_room_are_told_and_the_draw_is_not_encoded() {
    let mut driver = driver();
    let target = target(&mut driver);
    let rest = driver.allocate(driver.memory().largest_free(), zga_driver::Alignment::Line).expect("all of it");
    driver.set_lights(&[SUN]).expect("good light");
    driver.begin_scene(&target).expect("begins");
    let refused = driver.draw_vertices(Topology::Triangles, &with_normals(), None);
    assert!(matches!(refused, Err(DriverError::Memory(_))), "{refused:?}");
    driver.free(rest).expect("known");
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [1, 2, 0x30]);
    driver.draw_vertices(Topology::Triangles, &with_normals(), None).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(record(&driver, 0)[9], 0xFF32_64C8);
}

#[test]
fn lights_that_wait_for_memory_and_meet_a_fault_are_drawn_all_the_same() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    let rest = driver.allocate(driver.memory().largest_free(), zga_driver::Alignment::Line).expect("all of it");
    driver.begin_scene(&target).expect("begins");
    // Registers, begin scene, and the draw that is refused.
    driver.bus_mut().refuse_packet(2, Fault::new(FaultCode::BadValue, 0, 0x0280));
    driver.draw_triangle(triangle(WHITE)).expect("encoded");
    driver.free(rest).expect("when the draw is done");
    driver.set_lights(&[SUN]).expect("good light");
    let told = driver.draw_vertices(Topology::Triangles, &with_normals(), None);
    assert!(matches!(told, Err(DriverError::CardFault(_))), "{told:?}");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let draws: Vec<u32> = packets.iter().filter(|packet| packet[0] >> 24 == 0x10).map(|packet| packet[1]).collect();
    assert_eq!(draws, [0x200], "the lit one alone");
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | LIGHT | GOURAUD);
}

#[test]
fn lights_with_numbers_without_meaning_are_named_and_leave_what_was() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_lights(&[SUN]).expect("good light");
    let point = |position| Light::new(LightSource::Point { position }, WHITE);
    let spot = |direction, exponent| Light::new(LightSource::Spot { position: [0.0; 3], direction, exponent }, WHITE);
    let cases = [
        (point([0.0, f32::NAN, 0.0]), "light 1: position is [0.0, NaN, 0.0], expected finite numbers"),
        (spot([0.0; 3], 1.0), "light 1: direction is [0.0, 0.0, 0.0], expected a length above 0"),
        (spot([1.0, 0.0, f32::INFINITY], 1.0), "light 1: direction is [1.0, 0.0, inf], expected finite numbers"),
        (spot([1.0, 0.0, 0.0], 128.5), "light 1: exponent is 128.5, expected 0 to 128"),
        (spot([1.0, 0.0, 0.0], f32::NAN), "light 1: exponent is NaN, expected 0 to 128"),
        (Light { cut_off: Some(0.0), ..point([0.0; 3]) }, "light 1: cut-off is 0, expected a finite number above 0"),
    ];
    for (light, expected) in cases {
        assert_eq!(driver.set_lights(&[SUN, light]).expect_err(expected).to_string(), expected);
    }
    let refused = driver.set_lights(&[SUN; 257]).expect_err("too many").to_string();
    assert_eq!(refused, "number of lights is 257, expected at most 256");
    for shininess in [-1.0, 128.5, f32::NAN] {
        let refused = driver.set_material(Material { shininess, ..Material::default() }).expect_err("out of range");
        assert_eq!(refused.to_string(), format!("material shininess is {shininess}, expected 0 to 128"));
    }
    triangles(&mut driver, &target);
    assert_eq!(registers(&driver, LIGHT_REGISTERS)[2..], [1, 0, 0, 0, 0]);
}

#[test]
fn directions_of_any_length_are_one_long_in_their_record() {
    let mut driver = driver();
    let target = target(&mut driver);
    for length in [1e-30, 1e-45, 1.0, 3e38_f32] {
        driver
            .set_lights(&[Light::new(LightSource::Directional { direction: [0.0, -length, 0.0] }, WHITE)])
            .expect("good");
        triangles(&mut driver, &target);
        assert_eq!(record(&driver, 0)[4..7], [0.0, -1.0, 0.0].map(f32::to_bits), "{length}");
    }
}

#[test]
fn fog_of_each_curve_sends_its_own_registers_only() {
    let mut driver = driver();
    let target = target(&mut driver);
    let [_, density, end, scale, offset, _] = registers(&driver, FOG_REGISTERS);
    let colour = [1, 2, 3, 4];
    let mut fog = |curve| {
        driver.set_fog(Some(Fog { curve, colour })).expect("good fog");
        assert_eq!(triangles(&mut driver, &target), DEPTH | FOG);
        registers(&driver, FOG_REGISTERS)
    };
    let (word, f) = (0x0403_0201, f32::to_bits);
    assert_eq!(fog(FogCurve::Linear { end: 40.0 }), [1, density, f(40.0), scale, offset, word]);
    assert_eq!(fog(FogCurve::Exponential { density: 0.5 }), [2, f(0.5), f(40.0), scale, offset, word]);
    assert_eq!(fog(FogCurve::ExponentialSquared { density: 0.25 }), [3, f(0.25), f(40.0), scale, offset, word]);
    let cue = FogCurve::DepthCue { scale: -0.125, offset: 1.5 };
    assert_eq!(fog(cue), [4, f(0.25), f(40.0), f(-0.125), f(1.5), word]);
    assert_eq!(end, f(1.0));
    driver.set_fog(None).expect("possible");
    assert_eq!(triangles(&mut driver, &target), DEPTH);
}

#[test]
fn fog_with_numbers_without_meaning_is_named_and_leaves_what_was() {
    let mut driver = driver();
    let target = target(&mut driver);
    let cases = [
        (FogCurve::Linear { end: 0.0 }, "fog end is 0, expected a finite number above 0"),
        (FogCurve::Linear { end: f32::INFINITY }, "fog end is inf, expected a finite number above 0"),
        (FogCurve::Exponential { density: -1.0 }, "fog density is -1, expected a finite number, 0 or more"),
        (FogCurve::ExponentialSquared { density: f32::NAN }, "fog density is NaN, expected a finite number, 0 or more"),
        (FogCurve::DepthCue { scale: f32::NAN, offset: 0.0 }, "depth cue scale is NaN, expected a finite number"),
        (FogCurve::DepthCue { scale: 0.0, offset: f32::INFINITY }, "depth cue offset is inf, expected a finite number"),
    ];
    for (curve, expected) in cases {
        let refused = driver.set_fog(Some(Fog { curve, colour: WHITE })).expect_err(expected);
        assert_eq!(refused.to_string(), expected);
    }
    assert_eq!(triangles(&mut driver, &target), DEPTH);
}

#[test]
fn fog_in_perspective_is_interpolated_but_not_over_points() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_camera(PERSPECTIVE_CAMERA).expect("good camera");
    driver.set_fog(Some(Fog { curve: FogCurve::Linear { end: 9.0 }, colour: WHITE })).expect("good fog");
    let plain = Vertices::new(&CORNERS);
    assert_eq!(scene(&mut driver, &target, Topology::Triangles, &plain), DEPTH | FOG | PERSPECTIVE);
    assert_eq!(scene(&mut driver, &target, Topology::Points, &plain), DEPTH | FOG);
}

#[test]
fn blend_modes_have_their_codes_with_and_without_a_grid() {
    let mut driver = driver();
    let target = target(&mut driver);
    for (mode, code) in BlendMode::ALL.iter().zip(0..) {
        driver.set_blend(*mode).expect("there");
        assert_eq!(driver.blend(), Some(*mode));
        assert_eq!(triangles(&mut driver, &target), DEPTH | BLEND);
        assert_eq!(driver.bus().register(BLEND_CONTROL), code);
    }
    driver.set_antialias(Some(Antialias::default())).expect("there");
    driver.set_blend(Some(BlendMode::Multiply)).expect("there");
    assert_eq!(triangles(&mut driver, &target), DEPTH | BLEND | ANTI_ALIAS);
    assert_eq!(driver.bus().register(BLEND_CONTROL), 2);
    driver.set_blend(true).expect("there");
    assert_eq!(triangles(&mut driver, &target), DEPTH | BLEND | ANTI_ALIAS);
    assert_eq!(driver.bus().register(BLEND_CONTROL), 0);
    driver.set_blend(None).expect("possible");
    driver.set_antialias(None).expect("possible");
    assert_eq!(triangles(&mut driver, &target), DEPTH);
}

#[test]
fn effects_that_are_not_called_for_send_nothing() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_material(Material { shininess: 9.0, ..Material::default() }).expect("good");
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(WHITE)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [1, 2, 0x10, 3, 0x30], "the target alone");
}

#[test]
fn mesh_with_normals_and_colours_is_uploaded_and_drawn_as_it_is() {
    let mut driver = driver();
    let target = target(&mut driver);
    let coloured = CORNERS.map(|position| Vertex::new(position, [9, 8, 7, 255]));
    let vertices = Vertices::coloured(&coloured).normals(&NORMALS).coordinates(&[[0.5, 0.25]; 3]);
    let mesh = driver.create_mesh(Topology::Triangles, &vertices, Some(&[2, 1, 0])).expect("room");
    driver.set_lights(&[SUN]).expect("good light");
    driver.begin_scene(&target).expect("begins");
    driver.draw_mesh(&mesh).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    let draw = driver.bus_mut().take_packets().into_iter().find(|packet| packet[0] >> 24 == 0x11).expect("a draw");
    let [_, flags, address, count, indices, index_count] = draw[..] else { panic!("six words") };
    assert_eq!([flags, count, index_count], [0x710, 3, 3]);
    let words = |address: u32, count: usize| &driver.bus().memory()[address as usize / 4..][..count];
    let f = f32::to_bits;
    let first = [f(1.0), f(2.0), f(0.5), 0xFF07_0809, 0, 0, f(1.0), f(0.5), f(0.25)];
    assert_eq!(words(address, 9), first);
    assert_eq!(words(address + 4 * 18, 2), [f(1.0), f(40.0)]);
    assert_eq!(words(indices, 3), [2, 1, 0]);
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | LIGHT | GOURAUD);
    let refused = driver.create_mesh(Topology::Triangles, &vertices.normals(&NORMALS[..2]), None);
    assert_eq!(refused.expect_err("two normals").to_string(), "2 normals for 3 vertices");
    driver.free_mesh(mesh).expect("known");
}

#[test]
fn draw_longer_than_a_packet_keeps_normals_and_coordinates_with_their_vertices() {
    let mut driver = driver();
    let target = target(&mut driver);
    let positions: Vec<[f32; 3]> = (0..400_u16).map(|at| [at.into(), 0.0, 0.5]).collect();
    let coordinates: Vec<[f32; 2]> = (0..400_u16).map(|at| [0.0, at.into()]).collect();
    let indices: Vec<u32> = (0..399).rev().collect();
    let vertices = Vertices::new(&positions).normals(&[[0.0, 0.0, 1.0]; 400]).coordinates(&coordinates);
    driver.begin_scene(&target).expect("begins");
    driver.draw_vertices(Topology::Triangles, &vertices, Some(&indices)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let draws: Vec<&Vec<u32>> = packets.iter().filter(|packet| packet[0] >> 24 == 0x10).collect();
    assert!(draws.len() > 1 && draws.iter().all(|draw| draw[1] == 0x600 && draw[2] % 3 == 0));
    let sent: Vec<&[u32]> = draws.iter().flat_map(|draw| draw[4..].chunks_exact(8)).collect();
    let found: Vec<(f32, f32)> = sent.iter().map(|v| (f32::from_bits(v[0]), f32::from_bits(v[7]))).collect();
    let expected: Vec<(f32, f32)> = (0..399_u16).rev().map(|at| (at.into(), at.into())).collect();
    assert_eq!(found, expected);
}

#[test]
fn recovery_after_a_refused_packet_puts_lights_fog_and_blending_back() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_lights(&[SUN]).expect("good light");
    driver.set_material(Material { emission: [7; 4], shininess: 3.0, ..Material::default() }).expect("good");
    driver.set_fog(Some(Fog { curve: FogCurve::Linear { end: 9.0 }, colour: [5; 4] })).expect("good fog");
    driver.set_blend(BlendMode::Add).expect("there");
    triangles(&mut driver, &target);
    let all = |driver: &Driver<MockBus>| {
        (registers(driver, LIGHT_REGISTERS), registers(driver, FOG_REGISTERS), driver.bus().register(BLEND_CONTROL))
    };
    let expected = all(&driver);
    driver.bus_mut().set_pace(Pace::AFenceAWait);
    let refused = driver.bus().packets_met() + 1;
    driver.bus_mut().refuse_packet(refused, Fault::new(FaultCode::BadValue, 0, 0x0354));
    driver.begin_scene(&target).expect("begins");
    driver.draw_vertices(Topology::Triangles, &with_normals(), None).expect("encoded");
    let fault = driver.finish().expect_err("refused").to_string();
    assert!(fault.contains("register LIGHT_BASE"), "{fault}");
    assert_eq!(all(&driver), expected);
    driver.draw_vertices(Topology::Triangles, &with_normals(), None).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(all(&driver), expected);
    assert_eq!(record(&driver, 0)[9], 0xFF32_64C8);
}

#[test]
fn card_without_the_units_refuses_what_calls_for_them() {
    let mut driver = common::driver(Submit::Fifo);
    let told = |refused: Result<(), DriverError>| refused.expect_err("no unit").to_string();
    let none = |what: &str| format!("this card has no {what}: CAPABILITY_EFFECTS reads 0xf");
    assert_eq!(told(driver.set_lights(&[SUN])), none("lights"));
    assert_eq!(told(driver.set_scene_ambient(WHITE)), none("lights"));
    let fog = Fog { curve: FogCurve::Linear { end: 1.0 }, colour: WHITE };
    assert_eq!(told(driver.set_fog(Some(fog))), none("fog"));
    assert_eq!(told(driver.set_blend(BlendMode::Add)), none("translucency"));
    driver.set_lights(&[]).expect("none is always possible");
    driver.set_scene_ambient(None).expect("none is always possible");
    driver.set_fog(None).expect("none is always possible");
    driver.set_blend(None).expect("none is always possible");
}

/// STENCIL_BASE, STENCIL_PITCH; STENCIL_CONTROL, STENCIL_VALUE; SHADOW_CONTROL, SHADOW_INTENSITY.
const STENCIL_REGISTERS: [u32; 6] = [0x021C, 0x0220, 0x0328, 0x032C, 0x0380, 0x0384];

fn stencil_target(driver: &mut Driver<MockBus>) -> Target {
    driver.create_target(TargetOptions { stencil: true, ..TargetOptions::new(64, 48) }).expect("room")
}

#[test]
fn stencil_and_shadow_reach_their_registers() {
    let mut driver = driver();
    let target = stencil_target(&mut driver);
    let side = StencilSide {
        fail: StencilOperation::Zero,
        depth_fail: StencilOperation::Replace,
        pass: StencilOperation::Increment,
    };
    let back = StencilSide { fail: StencilOperation::DecrementWrap, ..StencilSide::KEEP };
    let stencil = Stencil {
        function: DepthFunction::Less,
        reference: 0x12,
        read_mask: 0x34,
        write_mask: 0x56,
        front: side,
        back,
        colours: false,
    };
    driver.set_stencil(Some(stencil)).expect("there");
    let shadow = Shadow { function: DepthFunction::Equal, reference: 3, read_mask: 0x0F, intensity: 99 };
    driver.set_shadow(Some(shadow)).expect("there");
    let effects = triangles(&mut driver, &target);
    assert_eq!(effects & STENCIL, STENCIL);
    let [base, pitch, control, value, shadow_control, intensity] = registers(&driver, STENCIL_REGISTERS);
    assert!(base != 0 && base.is_multiple_of(64));
    assert_eq!((pitch, control, value), (64, 0x0073_2111, 0x0056_3412));
    assert_eq!((shadow_control, intensity), (0x000F_0321, 99));

    // As the card resets it, once there is none.
    driver.set_stencil(None).expect("there");
    driver.set_shadow(None).expect("there");
    assert_eq!(triangles(&mut driver, &target) & STENCIL, 0);
    assert_eq!(registers(&driver, [0x0380]), [0x00FF_0050]);
}

#[test]
fn shadow_volume_counts_by_depth_fail_with_colours_off() {
    let mut driver = driver();
    let target = stencil_target(&mut driver);
    driver.set_stencil(Some(Stencil::shadow_volume())).expect("there");
    triangles(&mut driver, &target);
    // Always; colours off; front: decrement-wrap where depth fails, back: increment-wrap.
    assert_eq!(registers(&driver, [0x0328, 0x032C]), [0x0600_7017, 0x00FF_FF00]);
}

#[test]
fn clear_with_stencil_puts_its_value_beside_the_planes() {
    let mut driver = driver();
    let target = stencil_target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.clear_with_stencil(None, None, Some(0xA5)).expect("clears");
    driver.clear_with_stencil(Some(WHITE), None, Some(1)).expect("clears");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    let memory = driver.bus().memory();
    let clears = |planes: u32| memory.windows(2).any(|words| words == [0x0400_0003, planes]);
    assert!(clears(0xA504) && clears(0x0105));
}

#[test]
fn stencil_without_a_plane_with_samples_or_beside_blending_is_refused_before_it_is_sent() {
    let mut driver = driver();
    let plain = target(&mut driver);
    let target = stencil_target(&mut driver);
    driver.set_stencil(Some(Stencil::shadow_volume())).expect("there");
    driver.begin_scene(&plain).expect("begins");
    let refused = driver.draw_vertices(Topology::Triangles, &with_normals(), None);
    assert!(matches!(refused, Err(DriverError::NoStencilPlane { .. })), "{refused:?}");
    let refused = driver.clear_with_stencil(None, None, Some(0));
    assert!(matches!(refused, Err(DriverError::NoStencilPlane { .. })), "{refused:?}");
    driver.end_scene().expect("ends");

    driver.set_blend(true).expect("there");
    driver.begin_scene(&target).expect("begins");
    let refused = driver.draw_vertices(Topology::Triangles, &with_normals(), None);
    assert!(matches!(refused, Err(DriverError::StencilRefused { .. })), "{refused:?}");
    // To be tested is no harm.
    driver.set_stencil(Some(Stencil { function: DepthFunction::Equal, ..Stencil::default() })).expect("there");
    driver.draw_vertices(Topology::Triangles, &with_normals(), None).expect("draws");
    driver.end_scene().expect("ends");

    driver.set_blend(None).expect("there");
    driver.set_antialias(Some(Antialias::default())).expect("there");
    driver.begin_scene(&target).expect("begins");
    let refused = driver.draw_vertices(Topology::Triangles, &with_normals(), None);
    assert_eq!(refused.expect_err("refused").to_string(), "a stencil test does not go with anti-aliasing");
    driver.end_scene().expect("ends");
}
