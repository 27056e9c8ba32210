//! Hidden-surface paths of the real card through the driver: one setting, one picture.

use std::time::Duration;

use proptest::prelude::*;
use zga_abi::format::{DepthFunction, EndTest, Fidelity, HiddenSurface, TokenColour, TokenPorts, ZaPrediction};
use zga_abi::packet::Opcode;
use zga_abi::{Counter, Units};
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{
    Driver, DriverError, DriverOptions, Frame, Rectangle, Submit, SystolicVariant, Target, TargetOptions, Vertex,
    ZaSettings,
};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const WHITE: [u8; 4] = [255; 4];
const BACKGROUND: [u8; 4] = [0, 0, 64, 255];
const FIDELITIES: [Fidelity; 2] = [Fidelity::Functional, Fidelity::Clocked];

fn card(za_ram: u32) -> Card {
    let options = CardOptions { video_memory: 4 << 20, za_ram, threads: 1, ..CardOptions::default() };
    Card::power_on(options).expect("powers on")
}

fn open(card: &Card, submit: Submit) -> Driver<CardBus> {
    let options = DriverOptions { submit, ring_words: 4096, timeout: Duration::from_secs(60) };
    Driver::open_with(card.bus(), options).expect("opens")
}

fn target(driver: &mut Driver<CardBus>) -> Target {
    let options = TargetOptions { double_buffered: true, ..TargetOptions::new(75, 50) };
    driver.create_target(options).expect("room")
}

/// Two triangles through each other and a marking.
fn surfaces(driver: &mut Driver<CardBus>) -> Result<(), DriverError> {
    let at = |x, y, z, colour| Vertex::new([x, y, z], colour);
    driver.draw_triangle([at(4.0, 4.0, 0.2, RED), at(70.0, 24.0, 0.8, GREEN), at(4.0, 44.0, 0.2, RED)])?;
    driver.draw_triangle([at(70.0, 2.0, 0.1, BLUE), at(2.0, 20.0, 0.9, BLUE), at(60.0, 49.0, 0.4, BLUE)])?;
    driver.decal(8.0, |driver| driver.draw_line([at(4.5, 24.5, 0.21, WHITE), at(66.5, 24.5, 0.77, WHITE)]))
}

/// Everything that can come in a scene: functions, writes off, a scissor, clears of a part.
fn mixed(driver: &mut Driver<CardBus>) -> Result<(), DriverError> {
    let at = |x, y, z, colour| Vertex::new([x, y, z], colour);
    surfaces(driver)?;
    driver.set_scissor(Some(Rectangle { x: 10, y: 5, right: 41, bottom: 33 }));
    driver.clear(None, Some(0.5))?;
    driver.set_depth_function(DepthFunction::GreaterEqual);
    driver.draw_triangle([at(0.0, 0.0, 0.6, WHITE), at(75.0, 0.0, 0.4, WHITE), at(0.0, 50.0, 0.7, WHITE)])?;
    driver.set_scissor(Some(Rectangle { x: 30, y: 20, right: 64, bottom: 48 }));
    driver.clear(Some(GREEN), None)?;
    driver.set_depth_function(DepthFunction::LessEqual);
    driver.set_depth_write(false);
    driver.draw_line([at(0.0, 49.0, 0.3, RED), at(74.0, 0.0, 0.3, BLUE)])?;
    driver.set_scissor(None);
    driver.set_depth_function(DepthFunction::Always);
    driver.draw_point(at(50.5, 40.5, 0.9, RED))?;
    driver.set_depth_function(DepthFunction::Less);
    driver.set_depth_write(true);
    driver.draw_triangle([at(40.0, 0.0, 0.3, RED), at(75.0, 50.0, 0.3, RED), at(20.0, 50.0, 0.6, RED)])
}

fn set(driver: &mut Driver<CardBus>, path: HiddenSurface, fidelity: Fidelity) {
    driver.set_hidden_surface(path).expect("there");
    driver.set_fidelity(fidelity).expect("there");
}

/// Makes the frame that the next scene goes to something else, through the plain Z buffer: what a scene leaves out
/// is seen.
fn spoil(driver: &mut Driver<CardBus>, target: &Target) {
    let path = driver.hidden_surface();
    driver.set_hidden_surface(HiddenSurface::ZBuffer).expect("there");
    driver.begin_scene(target).expect("begins");
    driver.clear(Some([9; 4]), Some(0.3)).expect("clears");
    driver.end_scene().expect("ends");
    driver.set_hidden_surface(path).expect("there");
}

/// A scene that begins with a clear, as a frame, with its depths.
fn picture(
    driver: &mut Driver<CardBus>,
    target: &Target,
    draw: fn(&mut Driver<CardBus>) -> Result<(), DriverError>,
) -> (Frame, Option<Vec<u32>>) {
    spoil(driver, target);
    picture_over(driver, target, draw)
}

/// The same over what is there.
fn picture_over(
    driver: &mut Driver<CardBus>,
    target: &Target,
    draw: fn(&mut Driver<CardBus>) -> Result<(), DriverError>,
) -> (Frame, Option<Vec<u32>>) {
    driver.begin_scene(target).expect("begins");
    driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
    draw(driver).expect("draws");
    driver.end_scene().expect("ends");
    driver.present(target).expect("presents");
    let frame = driver.capture().expect("captures");
    (frame, driver.capture_depth(target).ok())
}

#[test]
fn every_path_and_setting_makes_the_picture_of_the_z_buffer() {
    let card = card(1 << 20);
    let mut driver = open(&card, Submit::Ring);
    let target = target(&mut driver);
    for draw in [surfaces, mixed] {
        set(&mut driver, HiddenSurface::ZBuffer, Fidelity::Functional);
        let expected = picture(&mut driver, &target, draw);
        for fidelity in FIDELITIES {
            for (block, prediction, bypass) in [
                ([32, 1], ZaPrediction::BlockLength, true),
                ([16, 2], ZaPrediction::CoveredRun, true),
                ([7, 5], ZaPrediction::Plane, true),
                ([1, 1], ZaPrediction::Plane, false),
                ([16384, 16384], ZaPrediction::BlockLength, true),
            ] {
                set(&mut driver, HiddenSurface::Za, fidelity);
                driver.set_za(ZaSettings { block, prediction, bypass }).expect("possible");
                assert!(picture(&mut driver, &target, draw) == expected, "za {fidelity:?} {block:?} {prediction:?}");
            }
            for (end_test, ports, colour, super_buffer) in [
                (EndTest::Negative, TokenPorts::Swapped, TokenColour::Tag, false),
                (EndTest::Zero, TokenPorts::Swapped, TokenColour::Value, false),
                (EndTest::Zero, TokenPorts::Merged, TokenColour::Tag, false),
                (EndTest::Negative, TokenPorts::Merged, TokenColour::Value, true),
            ] {
                set(&mut driver, HiddenSurface::Systolic, fidelity);
                let variant = SystolicVariant { end_test, ports, colour, super_buffer };
                driver.set_systolic(variant);
                assert!(picture(&mut driver, &target, draw) == expected, "systolic {fidelity:?} {variant:?}");
            }
            for size in [[8, 8], [4, 64], [32, 4]] {
                set(&mut driver, HiddenSurface::Tile, fidelity);
                driver.set_tile_size(size).expect("possible");
                assert!(picture(&mut driver, &target, draw) == expected, "tile {fidelity:?} {size:?}");
            }
        }
    }
}

#[test]
fn scene_without_a_z_buffer_is_the_same_picture_and_costs_no_depth_traffic() {
    let card = card(1 << 20);
    let mut driver = open(&card, Submit::Ring);
    let target = target(&mut driver);
    let expected = picture(&mut driver, &target, mixed).0;
    for path in [HiddenSurface::Systolic, HiddenSurface::Tile] {
        for fidelity in FIDELITIES {
            set(&mut driver, path, fidelity);
            driver.set_keep_depth(false);
            spoil(&mut driver, &target);
            driver.finish().expect("done");
            driver.clear_counters();
            let (frame, depths) = picture_over(&mut driver, &target, mixed);
            let traffic = [Counter::ZReads, Counter::ZWrites].map(|counter| driver.counters().get(counter));
            assert!(frame == expected, "{path:?} {fidelity:?}");
            assert_eq!((depths, traffic), (None, [0, 0]), "{path:?} {fidelity:?}");
            assert!(!driver.units_powered().contains(Units::Z_BUFFER));
            driver.set_keep_depth(true);
        }
    }
}

#[test]
fn scenes_that_go_on_from_one_another_may_change_paths() {
    let run = |first: (HiddenSurface, Fidelity), second: (HiddenSurface, Fidelity)| {
        let card = card(1 << 20);
        let mut driver = open(&card, Submit::Ring);
        let target = driver.create_target(TargetOptions::new(75, 50)).expect("room");
        set(&mut driver, first.0, first.1);
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
        driver
            .draw_triangle([[60.0, 3.0, 0.3], [70.0, 30.0, 0.3], [9.0, 20.0, 0.6]].map(|at| Vertex::new(at, WHITE)))
            .expect("draws");
        driver.end_scene().expect("ends");
        set(&mut driver, second.0, second.1);
        driver.begin_scene(&target).expect("begins");
        mixed(&mut driver).expect("draws");
        driver.end_scene().expect("ends");
        driver.present(&target).expect("presents");
        (driver.capture().expect("captures"), driver.capture_depth(&target).expect("kept"))
    };
    let plain = (HiddenSurface::ZBuffer, Fidelity::Functional);
    let expected = run(plain, plain);
    let all = || HiddenSurface::ALL.iter().flat_map(|&path| FIDELITIES.map(|fidelity| (path, fidelity)));
    for first in all() {
        for second in all() {
            assert!(run(first, second) == expected, "{first:?}, then {second:?}");
        }
    }
}

#[test]
fn za_frames_that_share_za_ram_keep_their_pictures() {
    // 75 x 50 pixels in blocks of 2 x 2 need 3800 bytes: room for one frame, not for two.
    for (za_ram, block) in [(4096, [2, 2]), (8192, [2, 2]), (1 << 20, [32, 1])] {
        let card = card(za_ram);
        let mut driver = open(&card, Submit::Ring);
        let targets = [target(&mut driver), target(&mut driver)];
        driver.set_hidden_surface(HiddenSurface::Za).expect("there");
        driver.set_za(ZaSettings { block, ..ZaSettings::default() }).expect("possible");
        // Logically cleared frames, one after the other; shown when all of them are drawn.
        for (target, colour) in targets.iter().zip([RED, GREEN]) {
            driver.begin_scene(target).expect("begins");
            driver.clear(Some(colour), Some(1.0)).expect("clears");
            driver.draw_point(Vertex::new([3.5, 3.5, 0.5], WHITE)).expect("draws");
            driver.end_scene().expect("ends");
        }
        let seen = targets.each_ref().map(|target| {
            driver.present(target).expect("presents");
            let frame = driver.capture().expect("captures");
            (frame.pixels[0], frame.pixels[3 * 75 + 3], frame.pixels[75 * 50 - 1])
        });
        let (red, green, white) = (0xFFFF_0000, 0xFF00_FF00, 0xFFFF_FFFF);
        assert_eq!(seen, [(red, white, red), (green, white, green)], "{za_ram} bytes");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    /// Bad packets anywhere in a scene on any path: the picture is that of the good ones.
    #[test]
    fn recovery_random_bad_packets_change_no_pixel_on_any_path(
        path in prop::sample::select(HiddenSurface::ALL),
        fidelity in prop::sample::select(&FIDELITIES),
        keep_depth in any::<bool>(),
        in_fifo in any::<bool>(),
        steps in prop::collection::vec((any::<bool>(), 0_u8..75, 0_u8..50, any::<[u8; 3]>()), 1..40),
        flush_each in 1_usize..20,
        wait_each in 1_usize..20,
    ) {
        let submit = if in_fifo { Submit::Fifo } else { Submit::Ring };
        let run = |with_bad: bool| {
            let card = card(1 << 20);
            let mut driver = open(&card, submit);
            let target = driver.create_target(TargetOptions::new(75, 50)).expect("room");
            set(&mut driver, path, fidelity);
            driver.set_keep_depth(keep_depth);
            driver.begin_scene(&target).expect("begins");
            driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
            for (number, &(bad, x, y, [r, g, b])) in steps.iter().enumerate() {
                let (x, y, z) = (f32::from(x), f32::from(y), f32::from(r) / 255.0);
                let at = |dx: f32, dy: f32| Vertex::new([x + dx, y + dy, z], [r, g, b, 255]);
                // Errors are told by whichever call meets them; what is drawn is encoded all the same.
                let _ = driver.draw_triangle([at(0.0, 0.0), at(20.0, 3.0), at(2.0, 17.0)]);
                if bad && with_bad {
                    let _ = driver.packet(Opcode::Fill, &[1, 2, 3]);
                }
                if number % flush_each == 0 {
                    let _ = driver.flush();
                }
                if number % wait_each == 0 {
                    let _ = driver.finish();
                }
            }
            driver.end_scene().expect("ends");
            while driver.finish().is_err() {}
            driver.present(&target).expect("presents");
            (driver.capture().expect("captures").hash, driver.capture_depth(&target).ok())
        };
        prop_assert_eq!(run(true), run(false));
    }
}
