//! The driver on the real card.

use std::time::Duration;

use proptest::prelude::*;
use zga_abi::format::{DepthFormat, PixelFormat, Topology};
use zga_abi::packet::Opcode;
use zga_abi::{Bus, Counter, Effects, FaultCode, Units};
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::bus::RecordingBus;
use zga_driver::{
    Antialias, Camera, Curve, Driver, DriverError, DriverOptions, Frame, Rectangle, Submit, Target, TargetOptions,
    Vertex, trace,
};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const WHITE: [u8; 4] = [255; 4];
const BACKGROUND: [u8; 4] = [0, 0, 64, 255];
const MEMORY: u32 = 4 << 20;

fn card() -> Card {
    Card::power_on(CardOptions { video_memory: MEMORY, threads: 1, ..CardOptions::default() }).expect("powers on")
}

/// A driver with the smallest ring, so that it wraps.
fn open(card: &Card, submit: Submit) -> Driver<CardBus> {
    let options = DriverOptions { submit, ring_words: 4096, timeout: Duration::from_secs(60) };
    Driver::open_with(card.bus(), options).expect("opens")
}

const TRIANGLE: [Vertex; 3] =
    [Vertex::new([4.0, 4.0, 0.2], RED), Vertex::new([60.0, 24.0, 0.8], GREEN), Vertex::new([4.0, 44.0, 0.2], RED)];

/// A triangle and, after `between`, a marking on it.
fn draw_scene<B: Bus>(
    driver: &mut Driver<B>,
    target: &Target,
    between: impl FnOnce(&mut Driver<B>) -> Result<(), DriverError>,
) -> Result<(), DriverError> {
    driver.begin_scene(target)?;
    driver.clear(Some(BACKGROUND), Some(1.0))?;
    driver.draw_triangle(TRIANGLE)?;
    between(driver)?;
    driver.decal(8.0, |driver| {
        driver.draw_line([Vertex::new([4.5, 24.5, 0.21], WHITE), Vertex::new([56.5, 24.5, 0.77], WHITE)])
    })?;
    driver.end_scene()?;
    driver.present(target)
}

fn plain_frame<B: Bus>(driver: &mut Driver<B>) -> Frame {
    let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
    draw_scene(driver, &target, |_| Ok(())).expect("draws");
    driver.capture().expect("captures")
}

#[test]
fn antialias_and_blend_power_the_sub_pixel_unit_while_they_are_called_for() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
    let mut called = |setting: Option<Antialias>, blend: bool| {
        driver.set_antialias(setting).expect("there");
        driver.set_blend(blend).expect("there");
        draw_scene(&mut driver, &target, |_| Ok(())).expect("draws");
        driver.finish().expect("the card takes it");
        (driver.effects_called(), driver.units_powered().contains(Units::SUBPIXEL))
    };
    let plain = Effects::DEPTH | Effects::GOURAUD | Effects::DECAL;
    assert_eq!(called(None, false), (plain, false));
    assert_eq!(called(Some(Antialias::default()), false), (plain | Effects::ANTI_ALIAS, true));
    assert_eq!(called(Some(Antialias::default()), true), (plain | Effects::ANTI_ALIAS | Effects::BLEND, true));
    assert_eq!(called(None, false), (plain, false));
}

#[test]
fn frame_is_the_same_through_ring_and_fifo() {
    let card = card();
    let ring = plain_frame(&mut open(&card, Submit::Ring));
    let fifo = plain_frame(&mut open(&card, Submit::Fifo));
    assert_eq!(ring, fifo);
    assert_eq!((ring.pixels[0], ring.pixels[24 * 64 + 20]), (0xFF00_0040, 0xFFFF_FFFF));
    assert_eq!(ring.hash.len(), "xxh3:".len() + 16);
}

#[test]
fn reports_tell_what_was_called_for() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    plain_frame(&mut driver);
    let expected = Effects::DEPTH | Effects::GOURAUD | Effects::DECAL;
    assert_eq!(driver.effects_called(), expected);
    assert!(driver.units_powered().contains(Units::GEOMETRY | Units::Z_BUFFER | Units::SHADING));
    let counters = driver.counters();
    assert_eq!(counters.get(Counter::GeometryPrimitives), 2);
    assert_eq!(counters.by_name("frontend.fences"), Some(1));
    driver.clear_counters();
    assert_eq!(driver.counters().get(Counter::GeometryPrimitives), 0);
    assert_eq!(driver.card_info().video_memory, MEMORY);
}

#[test]
fn capture_depth_is_clear_value_outside_and_the_plane_inside() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let format = DepthFormat::new(16, 8);
    let target = driver.create_target(TargetOptions { depth: format, ..TargetOptions::new(64, 48) }).expect("room");
    draw_scene(&mut driver, &target, |_| Ok(())).expect("draws");
    let depths = driver.capture_depth(&target).expect("captures");
    assert_eq!((depths.len(), depths[0]), (64 * 48, 0xFFFF));
    // At x = 10.5: 0.2 + 0.6 * 6.5 / 56, within a step.
    let expected = (0.2 + 0.6 * 6.5 / 56.0) * 65535.0;
    assert!((f64::from(depths[20 * 64 + 10]) - expected).abs() < 2.0, "{}", depths[20 * 64 + 10]);
}

#[test]
fn recovery_bad_packet_in_a_scene_leaves_the_rest_of_the_picture() {
    for submit in [Submit::Ring, Submit::Fifo] {
        let card = card();
        let mut driver = open(&card, submit);
        let expected = plain_frame(&mut driver);
        let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
        // Topology 3 with an unknown flag.
        draw_scene(&mut driver, &target, |driver| driver.packet(Opcode::DrawInline, &[0x0000_1003, 0, 0]))
            .expect("encodes");
        let refused = driver.capture().expect_err("the packet is bad");
        let DriverError::CardFault(fault) = &refused else { panic!("{refused}") };
        assert_eq!((fault.code, fault.word, fault.value), (Some(FaultCode::BadValue), 1, 0x1003), "{fault}");
        assert_eq!((fault.packet.as_str(), fault.field.as_str()), ("DRAW_INLINE", "flags"));
        assert_eq!(driver.capture().expect("works on"), expected);
    }
}

#[test]
fn recovery_bad_register_names_it() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    driver.packet(Opcode::RegisterWrite, &[0x0204, 64, 128, 0, 0, 0, 0, 0]).expect("encodes");
    let refused = driver.finish().expect_err("0x0218 + 4 is no register").to_string();
    assert!(refused.contains("BAD_REGISTER") || refused.contains("BAD_VALUE"), "{refused}");
    plain_frame(&mut driver);
}

#[test]
fn recovery_bad_target_drops_the_scene_and_works_on() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
    driver.packet(Opcode::BeginScene, &[]).expect("encodes");
    driver.packet(Opcode::EndScene, &[]).expect("encodes");
    let refused = driver.finish().expect_err("no target is set").to_string();
    assert!(refused.contains("register TARGET_SIZE"), "{refused}");
    draw_scene(&mut driver, &target, |_| Ok(())).expect("draws");
    assert_eq!(driver.capture().expect("works on").pixels[24 * 64 + 20], 0xFFFF_FFFF);
}

#[test]
fn many_frames_wrap_the_ring_and_stay_equal() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
    let mut fences = Vec::new();
    for _ in 0..300 {
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
        for shift in 0..8 {
            let moved = TRIANGLE
                .map(|v| Vertex { position: [v.position[0] + shift as f32, v.position[1], v.position[2]], ..v });
            driver.set_tag(shift);
            driver.draw_triangle(moved).expect("draws");
        }
        driver.end_scene().expect("ends");
        fences.push(driver.fence().expect("sent"));
    }
    driver.wait(fences[299]).expect("done");
    driver.wait(fences[0]).expect("done before");
    driver.present(&target).expect("presents");
    assert_eq!(driver.capture().expect("captures").pixels[24 * 64 + 6] >> 24, 0xFF);
    assert_eq!(driver.counters().get(Counter::GeometryPrimitives), 2400);
}

#[test]
fn mesh_draws_what_inline_vertices_draw() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
    let indices = [0, 1, 2];
    let mesh = driver.upload_mesh(Topology::Triangles, &TRIANGLE, Some(&indices)).expect("room");
    let mut hash = |draw: &dyn Fn(&mut Driver<CardBus>) -> Result<(), DriverError>| {
        driver.begin_scene(&target).expect("begins");
        driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
        draw(&mut driver).expect("draws");
        driver.end_scene().expect("ends");
        driver.present(&target).expect("presents");
        driver.capture().expect("captures").hash
    };
    let inline = hash(&|driver| driver.draw_triangles(&TRIANGLE));
    assert_eq!(hash(&|driver| driver.draw_mesh(&mesh)), inline);
    assert_eq!(hash(&|driver| driver.draw_indexed(Topology::Triangles, &TRIANGLE, &indices)), inline);
    assert_ne!(hash(&|_| Ok(())), inline);
    driver.free_mesh(mesh).expect("own");
}

/// Pixels of a white marking along a steep surface that are seen, in perspective.
fn marking_pixels(driver: &mut Driver<CardBus>, slope: Option<f64>) -> usize {
    let camera = Camera::Perspective {
        eye: [0.0, 0.0, 4.0],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 60.0,
        near: 1.0,
        far: 20.0,
    };
    driver.set_camera(camera).expect("good camera");
    let target = driver.create_target(TargetOptions::new(320, 240)).expect("room");
    driver.begin_scene(&target).expect("begins");
    driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
    // The plane z = 4 x + y: slope 4 across, 1 up.
    let on = |x: f32, y: f32, colour| Vertex::new([x, y, 4.0 * x + y], colour);
    let corners = [on(-0.5, -0.8, RED), on(0.5, -0.8, RED), on(0.5, 0.8, RED), on(-0.5, 0.8, RED)];
    driver.draw_indexed(Topology::Triangles, &corners, &[0, 1, 2, 0, 2, 3]).expect("draws");
    let line = [on(-0.4, -0.613, WHITE), on(0.37, 0.7, WHITE)];
    let curve = Curve::Quadratic([on(-0.4, 0.6, WHITE), on(0.1, -0.9, WHITE), on(0.4, 0.5, WHITE)]);
    let markings = |driver: &mut Driver<CardBus>| {
        driver.draw_line(line)?;
        driver.draw_curve(&curve, 0.25)
    };
    match slope {
        Some(slope) => driver.decal(slope, markings).expect("draws"),
        None => markings(driver).expect("draws"),
    }
    driver.end_scene().expect("ends");
    driver.present(&target).expect("presents");
    let frame = driver.capture().expect("captures");
    driver.destroy_target(target).expect("own");
    frame.pixels.iter().filter(|&&pixel| pixel == 0xFFFF_FFFF).count()
}

#[test]
fn decal_unburies_a_marking_on_a_steep_surface() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let [buried, seen, more] = [None, Some(8.0), Some(16.0)].map(|slope| marking_pixels(&mut driver, slope));
    assert!(buried * 5 < seen * 4, "{buried} of {seen} pixels without a decal");
    assert_eq!(seen, more, "nothing was left to bring up");
}

#[test]
fn probe_tells_the_history_of_a_pixel() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    driver.probe_pixel(20, 24, 16).expect("room");
    driver.set_tag(5);
    plain_frame(&mut driver);
    let history = driver.pixel_history().expect("done");
    assert_eq!((history.fragments, history.records.len()), (3, 3), "clear, triangle, line");
    assert_eq!(history.records.iter().map(|record| record.verdict & 0xFF).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(history.records[2].tag, 5);
    driver.probe_off().expect("off");
    assert!(driver.pixel_history().expect("done").records.is_empty());
}

#[test]
fn rgb565_without_depth_draws_and_captures() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let options = TargetOptions {
        pixel_format: PixelFormat::Rgb565,
        depth: None,
        double_buffered: true,
        ..TargetOptions::new(63, 47)
    };
    let target = driver.create_target(options).expect("room");
    driver.set_scissor(Some(Rectangle { x: 0, y: 0, right: 63, bottom: 30 }));
    driver.begin_scene(&target).expect("begins");
    driver.clear(Some(WHITE), None).expect("clears");
    driver.draw_triangle(TRIANGLE).expect("draws");
    driver.end_scene().expect("ends");
    driver.present(&target).expect("presents");
    let frame = driver.capture().expect("captures");
    assert_eq!(
        (frame.width, frame.height, frame.pixels[0], frame.pixels[62 + 46 * 63]),
        (63, 47, 0xFFFF_FFFF, 0xFF00_0000)
    );
    assert!(matches!(driver.capture_depth(&target), Err(DriverError::NoDepthBuffer { .. })));
}

#[test]
fn trace_of_a_run_with_a_fault_replays_equal_on_another_card() {
    let first = card();
    let bus = RecordingBus::new(first.bus(), Vec::new()).expect("a vector takes all");
    let mut driver =
        Driver::open_with(bus, DriverOptions { ring_words: 4096, ..DriverOptions::default() }).expect("opens");
    let target =
        driver.create_target(TargetOptions { double_buffered: true, ..TargetOptions::new(64, 48) }).expect("room");
    let mut hashes = Vec::new();
    for number in 0..6 {
        draw_scene(
            &mut driver,
            &target,
            |driver| {
                if number == 3 { driver.packet(Opcode::Clear, &[8, 0, 0]) } else { Ok(()) }
            },
        )
        .expect("encodes");
        let frame = driver.capture().or_else(|_| driver.capture()).expect("captures");
        hashes.push(frame.hash);
    }
    let (_, file) = driver.close().expect("closes").finish().expect("a vector takes all");

    let report = trace::replay(&file[..], &mut card().bus(), Duration::from_secs(60)).expect("replays");
    assert!(report.is_equal(), "{report:?}");
    assert_eq!(report.frames.iter().map(|frame| frame.found.clone()).collect::<Vec<_>>(), hashes);
    let small =
        Card::power_on(CardOptions { video_memory: 1 << 20, threads: 1, ..CardOptions::default() }).expect("powers on");
    assert!(matches!(
        trace::replay(&file[..], &mut small.bus(), Duration::ZERO),
        Err(trace::TraceError::OtherCard { .. })
    ));
}

#[test]
fn recovery_watchdog_names_the_draw_and_works_on() {
    let card = card();
    let mut driver = open(&card, Submit::Ring);
    let target = driver.create_target(TargetOptions::new(512, 512)).expect("room");
    let corners = [[0.0, 0.0, 0.5], [1024.0, 0.0, 0.5], [0.0, 1024.0, 0.5]].map(|at| Vertex::new(at, RED));
    // 2^20 clocks: 64 times 2^18 pixels are more.
    driver.packet(Opcode::RegisterWrite, &[0x0048, 1]).expect("encodes");
    driver.begin_scene(&target).expect("begins");
    driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
    driver.draw_triangles(&corners.repeat(64)).expect("encodes");
    driver.end_scene().expect("ends");
    let refused = driver.finish().expect_err("too long").to_string();
    assert!(refused.contains("refused DRAW_INLINE") && refused.contains("WATCHDOG"), "{refused}");
    driver.finish().expect("works on");
    assert_eq!(driver.bus_mut().read32(0x0048), 1, "restored");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Bad packets anywhere in a scene that is drawn through a small ring: the picture is that of the good ones.
    #[test]
    fn recovery_random_bad_packets_change_no_pixel(
        steps in prop::collection::vec((any::<bool>(), 0_u8..64, 0_u8..48, any::<[u8; 3]>()), 1..60),
        in_fifo in any::<bool>(),
        flush_each in 1_usize..20,
    ) {
        let submit = if in_fifo { Submit::Fifo } else { Submit::Ring };
        let run = |with_bad: bool| {
            let card = card();
            let mut driver = open(&card, submit);
            let target = driver.create_target(TargetOptions::new(64, 48)).expect("room");
            driver.begin_scene(&target).expect("begins");
            driver.clear(Some(BACKGROUND), Some(1.0)).expect("clears");
            for (number, &(bad, x, y, [r, g, b])) in steps.iter().enumerate() {
                let corner = [f32::from(x), f32::from(y), f32::from(r) / 255.0];
                let colour = [r, g, b, 255];
                driver.set_tag(number as u32);
                let at = |dx: f32, dy: f32| Vertex::new([corner[0] + dx, corner[1] + dy, corner[2]], colour);
                // Errors are told by whichever call meets them; what is drawn is encoded all the same.
                let _ = driver.draw_triangle([at(0.0, 0.0), at(20.0, 3.0), at(2.0, 17.0)]);
                if bad && with_bad {
                    let _ = driver.packet(Opcode::Fill, &[1, 2, 3]);
                }
                if number % flush_each == 0 {
                    let _ = driver.flush();
                }
            }
            driver.end_scene().expect("ends");
            while driver.finish().is_err() {}
            driver.present(&target).expect("presents");
            (driver.capture().expect("captures").hash, driver.capture_depth(&target).expect("captures"))
        };
        prop_assert_eq!(run(true), run(false));
    }
}
