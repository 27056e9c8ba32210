//! What the driver sends, word for word, against numbers restated from the manual.

mod common;

use common::{driver, opcodes, target, triangle};
use zga_abi::format::{DepthFunction, Topology};
use zga_abi::packet::Opcode;
use zga_abi::registers::Reg;
use zga_driver::bus::{MockAccess, MockBus};
use zga_driver::{Camera, Driver, DriverError, Rectangle, Submit, TargetOptions, Vertex};

const REGISTER_WRITE: u32 = 0x01;
const BEGIN_SCENE: u32 = 0x0200_0000;
const END_SCENE: u32 = 0x0300_0000;
const CLEAR: u32 = 0x0400_0003;
const RED: [u8; 4] = [255, 0, 0, 255];

/// The value that the register at `offset` had been given when packet `at` came.
fn register_before(packets: &[Vec<u32>], at: usize, offset: u32) -> Option<u32> {
    let writes = packets[..at].iter().filter(|packet| packet[0] >> 24 == REGISTER_WRITE);
    let values = writes.flat_map(|packet| (packet[1]..).step_by(4).zip(packet[2..].to_vec()));
    values.filter(|(to, _)| *to == offset).map(|(_, value)| value).last()
}

#[test]
fn open_resets_programs_ring_and_interrupts() {
    let driver = Driver::open(MockBus::new(common::MEMORY)).expect("the mock card opens");
    assert_eq!(driver.bus().register(0x0084), 0b101, "fence and error");
    assert_eq!(driver.bus().register(0x0104), 1 << 17, "RING_SIZE");
    assert_eq!(driver.card_info().video_memory, common::MEMORY);
    assert_eq!((driver.card_info().major, driver.card_info().paths), (1, 1));
}

#[test]
fn open_wrong_device_or_version_is_told() {
    let with = |register, value| {
        let mut bus = MockBus::new(common::MEMORY);
        bus.set_register(register, value);
        Driver::open(bus).err()
    };
    assert_eq!(with(Reg::Identification, u32::MAX), Some(DriverError::NoCard { found: u32::MAX }));
    assert_eq!(with(Reg::Identification, 7), Some(DriverError::NotThisCard { found: 7, expected: 0x5A47_4131 }));
    let refused = with(Reg::Revision, 0x0002_0003).expect("unknown version");
    assert_eq!(refused.to_string(), "REVISION (offset 0x0004) says interface 2.3, this driver speaks 1.x");
    assert!(matches!(Driver::open(MockBus::new(4096)), Err(DriverError::Memory(_))));
}

#[test]
fn scene_sets_target_once_and_clears_and_ends() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    for _ in 0..2 {
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some([1, 2, 3, 4]), Some(1.0)).expect("clears");
        driver.end_scene().expect("ends");
    }
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    assert_eq!(opcodes(&packets), [1, 2, 4, 3, 2, 4, 3, 0x30]);
    // TARGET_SIZE, COLOUR_BASE, COLOUR_PITCH, COLOUR_FORMAT, DEPTH_BASE, DEPTH_PITCH: the ring takes 16 KiB.
    assert_eq!(packets[0], [0x0100_0007, 0x200, 64 | 48 << 16, 0x4000, 256, 0, 0x4000 + 256 * 48, 256]);
    assert_eq!(packets[1], [BEGIN_SCENE]);
    assert_eq!(packets[2], [CLEAR, 3, 0x0403_0201, 0x00FF_FFFF]);
    assert_eq!(packets[3], [END_SCENE]);
}

#[test]
fn draw_triangle_words_are_flags_counts_and_vertices() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let draw = packets.iter().find(|packet| packet[0] >> 24 == 0x10).expect("a draw");
    assert_eq!(draw[..4], [0x1000_000F, 0x100, 3, 0]);
    assert_eq!(draw[4..8], [0x3F80_0000, 0x4000_0000, 0x3F00_0000, 0xFF00_00FF]);
    assert_eq!(draw.len(), 16);
}

/// The effects that a draw with this camera and these colours calls for.
fn effects(camera: Camera, vertices: &[Vertex; 3], decal: bool) -> u32 {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.set_camera(camera).expect("good camera");
    driver.begin_scene(&target).expect("begins");
    let draw = |driver: &mut Driver<MockBus>| driver.draw_triangle(*vertices);
    let drawn = if decal { driver.decal(8.0, draw) } else { draw(&mut driver) };
    drawn.expect("draws");
    driver.finish().expect("done");
    driver.bus().register(0x0280)
}

#[test]
fn effects_are_those_that_the_draw_calls_for() {
    let perspective = Camera::Perspective {
        eye: [0.0, 0.0, 5.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 60.0,
        near: 1.0,
        far: 9.0,
    };
    let plain = triangle(RED);
    let mut mixed = plain;
    mixed[1].colour = [0, 255, 0, 255];
    assert_eq!(effects(Camera::Screen, &plain, false), 0b0001);
    assert_eq!(effects(Camera::Screen, &mixed, false), 0b0011);
    assert_eq!(effects(perspective, &plain, false), 0b0001);
    assert_eq!(effects(perspective, &mixed, false), 0b0111);
    assert_eq!(effects(perspective, &plain, true), 0b1001);
}

#[test]
fn effects_two_triangles_of_one_colour_each_need_no_interpolation() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    let vertices = [triangle(RED), triangle([0, 0, 255, 255])].concat();
    driver.draw_triangles(&vertices).expect("draws");
    driver.draw_line_strip(&vertices).expect("draws");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let draws: Vec<usize> = (0..packets.len()).filter(|&at| packets[at][0] >> 24 == 0x10).collect();
    assert_eq!(register_before(&packets, draws[0], 0x280), None, "as after reset: depth");
    assert_eq!(register_before(&packets, draws[1], 0x280), Some(0b11));
}

#[test]
fn effects_no_depth_buffer_or_no_use_of_it_calls_for_no_depth_test() {
    let mut driver = driver(Submit::Ring);
    let flat = driver.create_target(TargetOptions { depth: None, ..TargetOptions::new(64, 48) }).expect("room");
    driver.begin_scene(&flat).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    assert!(matches!(driver.clear(None, Some(1.0)), Err(DriverError::NoDepthBuffer { .. })));
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!((driver.bus().register(0x0280), driver.bus().register(0x0214)), (0, 0));
    let deep = target(&mut driver);
    driver.set_depth_function(DepthFunction::Always);
    driver.set_depth_write(false);
    driver.begin_scene(&deep).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.finish().expect("done");
    assert_eq!((driver.bus().register(0x0280), driver.bus().register(0x0284)), (0, 7));
}

#[test]
fn decal_scope_sets_the_matrix_and_leaves_it_behind() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.decal(8.0, |driver| driver.draw_line([Vertex::default(); 2])).expect("draws");
    driver.draw_line([Vertex::default(); 2]).expect("draws");
    driver.finish().expect("done");
    // z' = z - 8 / (2 * 64).
    assert_eq!(f32::from_bits(driver.bus().register(0x0440 + 4 * 14)), -0.0625);
    let packets = driver.bus_mut().take_packets();
    assert_eq!(opcodes(&packets).iter().filter(|&&opcode| opcode == 1).count(), 4, "target, effects, matrix, effects");
    assert_eq!(driver.bus().register(0x0280), 1);
}

#[test]
fn decal_bad_slope_is_refused_before_anything_is_drawn() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    assert!(matches!(driver.decal(f64::NAN, |_| Ok(())), Err(DriverError::View(_))));
    driver.end_scene().expect("ends");
    let info = driver.decal_info(&target, 2.0).expect("good slope");
    assert!((info.offset_eye - 1.0).abs() < 1e-12);
}

#[test]
fn decal_under_one_step_is_warned_of_once() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    for _ in 0..2 {
        driver.decal(1e-6, |driver| driver.draw_point(Vertex::default())).expect("draws");
    }
    let warnings = driver.take_warnings();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].to_string().contains("under one depth step"), "{}", warnings[0]);
    assert!(driver.take_warnings().is_empty());
}

#[test]
fn frame_of_a_mesh_costs_few_words_and_six_accesses() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    let mesh = driver.upload_mesh(Topology::Triangles, &triangle(RED), Some(&[0, 1, 2])).expect("room");
    let mut frame = || {
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some([0; 4]), Some(1.0)).expect("clears");
        driver.draw_mesh(&mesh).expect("draws");
        driver.end_scene().expect("ends");
        let fence = driver.fence().expect("sent");
        driver.wait(fence).expect("done");
        (driver.bus_mut().take_accesses(), driver.bus_mut().take_packets())
    };
    frame();
    let (accesses, packets) = frame();
    assert_eq!(opcodes(&packets), [2, 4, 0x11, 3, 0x30]);
    assert_eq!(packets.iter().map(Vec::len).sum::<usize>(), 14);
    assert!(
        matches!(
            accesses[..],
            [
                MockAccess::WriteBurst(_, 14),
                MockAccess::Write(0x108, _),
                MockAccess::Write(0x110, _),
                MockAccess::Wait(0b101),
                MockAccess::Write(0x80, 1),
                MockAccess::Read(0x140),
            ]
        ),
        "{accesses:?}"
    );
}

#[test]
fn present_double_buffered_alternates_and_sets_scan_out() {
    let mut driver = driver(Submit::Ring);
    let options = TargetOptions { double_buffered: true, ..TargetOptions::new(64, 48) };
    let target = driver.create_target(options).expect("room");
    let mut bases = Vec::new();
    for _ in 0..3 {
        driver.begin_scene(&target).expect("begins");
        driver.end_scene().expect("ends");
        driver.present(&target).expect("presents");
        driver.finish().expect("done");
        bases.push((driver.bus().register(0x0204), driver.bus().register(0x0688)));
    }
    assert_eq!(bases, [(0x4000, 0x4000), (0x7000, 0x7000), (0x4000, 0x4000)]);
    assert_eq!([0x068C, 0x0690, 0x0694].map(|at| driver.bus().register(at)), [256, 0, 64 | 48 << 16]);
}

#[test]
fn capture_before_present_is_refused() {
    let mut driver = driver(Submit::Ring);
    assert_eq!(driver.capture().expect_err("nothing shown"), DriverError::NothingShown);
}

#[test]
fn misuse_is_told_and_encodes_nothing() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    assert!(matches!(driver.draw_triangle(triangle(RED)), Err(DriverError::OutsideScene { .. })));
    assert!(matches!(driver.end_scene(), Err(DriverError::OutsideScene { .. })));
    driver.begin_scene(&target).expect("begins");
    assert!(matches!(driver.begin_scene(&target), Err(DriverError::InsideScene { .. })));
    assert!(matches!(driver.present(&target), Err(DriverError::InsideScene { .. })));
    let refused = driver.draw_triangles(&triangle(RED)[..2]).expect_err("two vertices");
    assert_eq!(refused.to_string(), "2 vertices do not make whole triangles: a multiple of 3 is needed");
    let refused = driver.upload_mesh(Topology::Triangles, &triangle(RED), Some(&[0, 1, 3])).expect_err("index 3");
    assert_eq!(refused.to_string(), "index 2 is 3, but there are 3 vertices");
    assert!(driver.clear(None, Some(1.5)).is_err());
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [1, 2, 0x30]);
}

#[test]
fn scissor_tag_and_material_travel_in_one_packet() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.set_scissor(Some(Rectangle { x: 1, y: 2, right: 70_000, bottom: 4 }));
    driver.set_tag(9);
    driver.set_material_colour([1, 2, 3, 4]);
    driver.begin_scene(&target).expect("begins");
    driver.draw_positions(Topology::Points, &[[0.0; 3]]).expect("draws");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    assert_eq!(packets[2], [0x0100_0005, 0x288, 0x0403_0201, 9, 0x0002_0001, 0x0004_7FFF]);
    assert_eq!(packets[3], [0x1000_0006, 2, 1, 0, 0, 0, 0]);
}

#[test]
fn draw_longer_than_a_packet_is_split_between_primitives() {
    let mut driver = driver(Submit::Ring);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    let vertices = vec![Vertex::default(); 999];
    driver.draw_triangles(&vertices).expect("draws");
    driver.draw_line_strip(&vertices).expect("draws");
    driver.draw_indexed(Topology::Triangles, &vertices, &[0, 1, 2]).expect("draws");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let counts = |topology: u32| -> Vec<u32> {
        let draws = packets.iter().filter(|packet| packet[0] >> 24 == 0x10 && packet[1] == 0x100 | topology);
        draws.map(|packet| packet[2]).collect()
    };
    assert_eq!(counts(0), [252, 252, 252, 243, 3]);
    assert_eq!(counts(3), [252, 252, 252, 246], "each strip begins at the last vertex of the one before");
}

#[test]
fn probe_is_set_up_before_it_is_enabled() {
    let mut driver = driver(Submit::Ring);
    driver.probe_pixel(3, 4, 2).expect("room");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    assert_eq!(packets[0], [0x0100_0004, 0x604, 0x0004_0003, 0x4000, 2]);
    assert_eq!(packets[1], [0x0100_0002, 0x600, 1]);
    driver.bus_mut().set_register(Reg::ProbeCount, 5);
    let history = driver.pixel_history().expect("done");
    assert_eq!((history.fragments, history.records.len()), (5, 2));
    driver.probe_off().expect("off");
    driver.packet(Opcode::NoOperation, &[1, 2, 3]).expect("any payload");
    driver.finish().expect("done");
    assert_eq!(driver.bus().register(0x0600), 0);
}
