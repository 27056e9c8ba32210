//! Hidden-surface paths: what the driver sends for each, against numbers restated from the manual.

mod common;

use std::time::Duration;

use common::{opcodes, target, triangle};
use zga_abi::format::{EndTest, Fidelity, HiddenSurface, TokenColour, TokenPorts, ZaPrediction};
use zga_abi::registers::Reg;
use zga_abi::{Fault, FaultCode};
use zga_driver::bus::{MockAccess, MockBus};
use zga_driver::{
    Driver, DriverError, DriverOptions, Rectangle, Submit, SystolicVariant, Target, TargetOptions, Warning, ZaSettings,
};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
/// ZA_BLOCK, ZA_PREDICTION, ZA_BASE.
const ZA: [u32; 3] = [0x024C, 0x0250, 0x0254];
const HIDDEN_SURFACE: u32 = 0x0240;
const FIDELITY: u32 = 0x0248;
const SYSTOLIC_VARIANT: u32 = 0x0258;
const TILE_SIZE: u32 = 0x025C;
const DEPTH_PITCH: u32 = 0x0214;

/// A driver on a mock card with all four paths and so much Za RAM.
fn driver(za_ram: u32) -> Driver<MockBus> {
    let mut bus = MockBus::new(common::MEMORY);
    bus.set_register(Reg::CapabilityPaths, 0b1111);
    bus.set_register(Reg::ZaRamSize, za_ram);
    let options = DriverOptions { submit: Submit::Ring, ring_words: 4096, timeout: Duration::from_millis(1) };
    Driver::open_with(bus, options).expect("the mock card opens")
}

/// A whole scene without presenting it.
fn scene(driver: &mut Driver<MockBus>, target: &Target) -> Result<(), DriverError> {
    driver.begin_scene(target)?;
    driver.clear(Some([0; 4]), Some(1.0))?;
    driver.draw_triangle(triangle(RED))?;
    driver.end_scene()?;
    driver.finish()
}

fn registers<const N: usize>(driver: &Driver<MockBus>, offsets: [u32; N]) -> [u32; N] {
    offsets.map(|offset| driver.bus().register(offset))
}

#[test]
fn za_scene_programs_block_prediction_and_base() {
    let mut driver = driver(1 << 20);
    let target = target(&mut driver);
    driver.set_hidden_surface(HiddenSurface::Za).expect("there");
    driver.set_za(ZaSettings { block: [16, 2], prediction: ZaPrediction::Plane, bypass: false }).expect("possible");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, [HIDDEN_SURFACE]), [1]);
    assert_eq!(registers(&driver, ZA), [2 << 16 | 16, 0x102, 0]);
}

#[test]
fn settings_unchanged_are_not_sent_again_and_others_paths_not_at_all() {
    let mut driver = driver(1 << 20);
    let target = target(&mut driver);
    driver.set_tile_size([16, 4]).expect("possible");
    driver.set_fidelity(Fidelity::Clocked).expect("there");
    driver.set_hidden_surface(HiddenSurface::Za).expect("there");
    for _ in 0..2 {
        scene(&mut driver, &target).expect("draws");
    }
    assert_eq!(registers(&driver, [HIDDEN_SURFACE, FIDELITY, TILE_SIZE]), [1, 1, 0x0008_0008]);
    let sent = opcodes(&driver.bus_mut().take_packets());
    assert_eq!(sent, [1, 1, 2, 4, 0x10, 3, 0x30, 2, 4, 0x10, 3, 0x30], "target and path, once");
    driver.set_hidden_surface(HiddenSurface::Tile).expect("there");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, [HIDDEN_SURFACE, TILE_SIZE]), [3, 4 << 16 | 16]);
}

#[test]
fn fidelity_is_written_past_the_stream_and_put_back_by_a_recovery() {
    let mut driver = driver(1 << 20);
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.set_fidelity(Fidelity::Clocked).expect("there");
    driver.set_fidelity(Fidelity::Clocked).expect("there");
    let writes = driver.bus_mut().take_accesses();
    assert_eq!(writes.iter().filter(|access| **access == MockAccess::Write(FIDELITY, 1)).count(), 1);
    driver.end_scene().expect("ends");
    let next = driver.bus().packets_met();
    driver.bus_mut().refuse_packet(next + 1, Fault::new(FaultCode::UnknownOpcode, 0, 0));
    driver.packet(zga_abi::packet::Opcode::NoOperation, &[]).expect("encoded");
    assert!(matches!(driver.finish(), Err(DriverError::CardFault(_))));
    scene(&mut driver, &target).expect("works on");
    assert_eq!(registers(&driver, [FIDELITY]), [1]);
    let packets = driver.bus_mut().take_packets();
    let sent = packets.iter().filter(|packet| {
        packet[0] >> 24 == 1 && packet[1] <= FIDELITY && FIDELITY < packet[1] + 4 * (packet.len() as u32 - 2)
    });
    assert_eq!(sent.count(), 0, "not in the stream");
}

#[test]
fn systolic_variant_bits_are_those_of_the_manual() {
    let mut driver = driver(0);
    let target = target(&mut driver);
    driver.set_hidden_surface(HiddenSurface::Systolic).expect("there");
    let plain = SystolicVariant::default();
    let variants = [
        plain,
        SystolicVariant { end_test: EndTest::Zero, ..plain },
        SystolicVariant { ports: TokenPorts::Merged, ..plain },
        SystolicVariant { colour: TokenColour::Value, ..plain },
        SystolicVariant { super_buffer: true, ..plain },
    ];
    let sent = variants.map(|variant| {
        driver.set_systolic(variant);
        scene(&mut driver, &target).expect("draws");
        driver.bus().register(SYSTOLIC_VARIANT)
    });
    assert_eq!(sent, [0, 1, 2, 4, 8]);
}

#[test]
fn za_areas_of_two_frames_lie_apart() {
    let mut driver = driver(1 << 20);
    let options = TargetOptions { double_buffered: true, ..TargetOptions::new(64, 48) };
    let target = driver.create_target(options).expect("room");
    driver.set_hidden_surface(HiddenSurface::Za).expect("there");
    let base = |driver: &mut Driver<MockBus>, block| {
        driver.set_za(ZaSettings { block, ..ZaSettings::default() }).expect("possible");
        scene(driver, &target).expect("draws");
        driver.present(&target).expect("presents");
        driver.bus().register(ZA[2])
    };
    // 2 blocks on each of 48 rows are 384 bytes.
    assert_eq!([(); 3].map(|()| base(&mut driver, [32, 1])), [0, 384, 0]);
    // Coarser blocks stay where they are; finer ones need larger areas: 8 x 48 blocks are 1536 bytes.
    assert_eq!([(); 2].map(|()| base(&mut driver, [8, 8])), [384, 0]);
    assert_eq!([(); 2].map(|()| base(&mut driver, [8, 1])), [1536, 0]);
}

#[test]
fn za_areas_of_two_targets_lie_apart_and_come_back() {
    let mut driver = driver(1 << 20);
    driver.set_hidden_surface(HiddenSurface::Za).expect("there");
    let first = target(&mut driver);
    let second = target(&mut driver);
    let base = |driver: &mut Driver<MockBus>, target: &Target| {
        scene(driver, target).expect("draws");
        driver.bus().register(ZA[2])
    };
    assert_eq!((base(&mut driver, &first), base(&mut driver, &second)), (0, 384));
    driver.destroy_target(first).expect("own");
    let third = target(&mut driver);
    assert_eq!((base(&mut driver, &third), base(&mut driver, &second)), (0, 384));
}

#[test]
fn za_ram_with_room_for_one_frame_is_shared_and_with_less_is_refused() {
    let mut driver = driver(512);
    let options = TargetOptions { double_buffered: true, ..TargetOptions::new(64, 48) };
    let target = driver.create_target(options).expect("room");
    driver.set_hidden_surface(HiddenSurface::Za).expect("there");
    for _ in 0..2 {
        scene(&mut driver, &target).expect("draws");
        driver.present(&target).expect("presents");
        assert_eq!(driver.bus().register(ZA[2]), 0);
    }
    driver.set_za(ZaSettings { block: [8, 1], ..ZaSettings::default() }).expect("known with the target");
    let refused = driver.begin_scene(&target).expect_err("1536 bytes").to_string();
    assert_eq!(
        refused,
        "Za blocks of 8 x 1 pixels are too small: a frame of 64 x 48 pixels needs 1536 bytes of Za RAM, this card has 512"
    );
    driver.set_za(ZaSettings::default()).expect("possible");
    scene(&mut driver, &target).expect("no scene was left open");
}

#[test]
fn settings_without_meaning_are_refused_and_leave_what_was() {
    let mut driver = driver(1 << 20);
    let bad = ZaSettings { block: [0, 1], ..ZaSettings::default() };
    let refused = driver.set_za(bad).expect_err("no width").to_string();
    assert_eq!(refused, "Za block is 0 x 1, expected 1 to 16384 pixels each way");
    let refused = driver.set_tile_size([8, 12]).expect_err("12 rows").to_string();
    assert_eq!(refused, "tile size is 8 x 12, expected 4, 8, 16, 32 or 64 pixels each way");
    let target = target(&mut driver);
    for path in [HiddenSurface::Za, HiddenSurface::Tile] {
        driver.set_hidden_surface(path).expect("there");
        scene(&mut driver, &target).expect("draws");
    }
    assert_eq!(registers(&driver, [ZA[0], TILE_SIZE]), [0x0001_0020, 0x0008_0008]);
}

#[test]
fn card_without_a_path_refuses_it_and_clocked_fidelity() {
    let mut driver = common::driver(Submit::Fifo);
    let refused = driver.set_hidden_surface(HiddenSurface::Tile).expect_err("one path").to_string();
    assert_eq!(refused, "this card has no tile: CAPABILITY_PATHS reads 0x1");
    let refused = driver.set_fidelity(Fidelity::Clocked).expect_err("no model").to_string();
    assert_eq!(refused, "this card has no path with a clocked model: CAPABILITY_PATHS reads 0x1");
    assert_eq!(driver.hidden_surface(), HiddenSurface::ZBuffer);
}

#[test]
fn keep_depth_off_takes_the_z_buffer_away_on_paths_that_need_none() {
    let mut driver = driver(1 << 20);
    let target = target(&mut driver);
    driver.set_keep_depth(false);
    let pitches: Vec<u32> = HiddenSurface::ALL
        .iter()
        .map(|path| {
            driver.set_hidden_surface(*path).expect("there");
            scene(&mut driver, &target).expect("draws");
            driver.bus().register(DEPTH_PITCH)
        })
        .collect();
    assert_eq!(pitches, [256, 256, 0, 0]);
    assert_eq!(driver.bus().register(0x0280), 1, "depth is tested all the same");
    let refused = driver.capture_depth(&target).expect_err("nothing kept").to_string();
    assert_eq!(refused, "target 0 has no depths of its last scene: the tile path kept none, see set_keep_depth");
    driver.set_keep_depth(true);
    scene(&mut driver, &target).expect("draws");
    assert_eq!(driver.bus().register(DEPTH_PITCH), 256);
    driver.capture_depth(&target).expect("kept");
    assert!(driver.take_warnings().is_empty());
}

#[test]
fn keep_depth_off_drawing_before_a_whole_clear_is_warned_of() {
    let mut driver = driver(0);
    let target = target(&mut driver);
    driver.set_keep_depth(false);
    driver.set_hidden_surface(HiddenSurface::Systolic).expect("there");
    let mut warned = |scissor, depth| {
        driver.begin_scene(&target).expect("begins");
        driver.set_scissor(scissor);
        driver.clear(Some([0; 4]), depth).expect("clears");
        driver.draw_triangle(triangle(RED)).expect("draws");
        driver.end_scene().expect("ends");
        driver.take_warnings()
    };
    let warning = Warning::DepthBeginsFar { path: HiddenSurface::Systolic };
    assert_eq!(warned(None, Some(0.5)), []);
    let all = Rectangle { x: 0, y: 0, right: 64, bottom: 48 };
    assert_eq!(warned(Some(all), Some(0.5)), []);
    assert_eq!(warned(Some(Rectangle { x: 1, ..all }), Some(0.5)), std::slice::from_ref(&warning));
    assert_eq!(warned(None, None), [warning]);
}

#[test]
fn recovery_on_a_path_that_holds_scenes_sends_the_whole_scene_again() {
    for (path, again) in [
        // Only the scene is begun again; the fence counts as reached.
        (HiddenSurface::Za, vec![2, 0x10, 3, 0x30]),
        // Clear, draw, fence, draw; then what was not executed yet.
        (HiddenSurface::Systolic, vec![2, 4, 1, 0x10, 0x30, 0x10, 0x10, 3, 0x30]),
        (HiddenSurface::Tile, vec![2, 4, 1, 0x10, 0x30, 0x10, 0x10, 3, 0x30]),
    ] {
        let mut driver = driver(1 << 20);
        let target = target(&mut driver);
        driver.set_hidden_surface(path).expect("there");
        scene(&mut driver, &target).expect("a scene before");
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some([0; 4]), Some(1.0)).expect("clears");
        driver.set_tag(7);
        driver.draw_triangle(triangle(RED)).expect("draws");
        driver.finish().expect("a fence inside the scene");
        driver.draw_triangle(triangle(GREEN)).expect("draws");
        driver.draw_triangle(triangle([1; 4])).expect("draws");
        driver.draw_triangle(triangle(RED)).expect("draws");
        driver.end_scene().expect("ends");
        let next = driver.bus().packets_met();
        driver.bus_mut().refuse_packet(next + 1, Fault::new(FaultCode::BadValue, 5, 0x1234));
        let fence = driver.fence().expect("sent");
        driver.bus_mut().take_packets();
        assert!(matches!(driver.wait(fence), Err(DriverError::CardFault(_))));
        driver.wait(fence).expect("the rest was done");
        let packets = driver.bus_mut().take_packets();
        assert_eq!(opcodes(&packets), again, "{path:?}");
        assert!(packets.iter().all(|packet| packet.get(7) != Some(&0x0101_0101)), "the refused draw is gone");
        assert_eq!(registers(&driver, [HIDDEN_SURFACE, 0x028C]), [path.code(), 7]);
        scene(&mut driver, &target).expect("works on");
    }
}

#[test]
fn recovery_on_a_path_that_holds_scenes_ends_when_its_end_is_refused() {
    let mut driver = driver(0);
    let target = target(&mut driver);
    driver.set_hidden_surface(HiddenSurface::Tile).expect("there");
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.finish().expect("a fence inside the scene");
    driver.end_scene().expect("ends");
    let next = driver.bus().packets_met();
    driver.bus_mut().refuse_packet(next, Fault::new(FaultCode::Watchdog, 0, 0));
    assert!(matches!(driver.finish(), Err(DriverError::CardFault(_))));
    driver.bus_mut().take_packets();
    driver.finish().expect("nothing is left of the scene");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), [0x30]);
    scene(&mut driver, &target).expect("works on");
}

#[test]
fn recovery_of_a_held_scene_larger_than_the_ring_keeps_every_draw_in_order() {
    let mut driver = driver(0);
    let target = target(&mut driver);
    driver.set_hidden_surface(HiddenSurface::Systolic).expect("there");
    driver.begin_scene(&target).expect("begins");
    for number in 0..1000 {
        driver.draw_positions(zga_abi::format::Topology::Points, &[[number as f32, 0.0, 0.0]]).expect("draws");
    }
    driver.finish().expect("a fence inside the scene");
    driver.draw_positions(zga_abi::format::Topology::Points, &[[-1.0; 3]]).expect("encodes");
    driver.end_scene().expect("ends");
    let next = driver.bus().packets_met();
    driver.bus_mut().refuse_packet(next, Fault::new(FaultCode::BadValue, 0, 0));
    assert!(matches!(driver.finish(), Err(DriverError::CardFault(_))));
    driver.bus_mut().take_packets();
    driver.finish().expect("works on");
    let packets = driver.bus_mut().take_packets();
    let drawn: Vec<u32> = packets.iter().filter(|packet| packet[0] >> 24 == 0x10).map(|packet| packet[4]).collect();
    let expected: Vec<u32> = (0..1000).map(|number| (number as f32).to_bits()).collect();
    assert_eq!(drawn, expected);
}
