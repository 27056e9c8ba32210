//! BEGIN_SCENE, END_SCENE, CLEAR.

use crate::bench::{Bench, TRIANGLE};
use crate::mock::{Call, MEMORY};
use zga_abi::format::{
    DepthFormat, DepthFunction, EndTest, Fidelity, HiddenSurface, PixelFormat, SubpixelDepth, SubpixelEdges,
    SubpixelGrid, SubpixelResolve, TokenColour, TokenPorts, ZaPrediction,
};
use zga_abi::{Fault, FaultCode};
use zga_firmware::Stopped;
use zga_firmware::checked::{
    Clear, DepthSurface, Rectangle, Shadow, StencilSurface, StencilTest, SubpixelSetting, Surface, SystolicSetting,
    Target, ZaSetting,
};

const WHOLE: Rectangle = Rectangle { x: 0, y: 0, right: 64, bottom: 32 };

#[test]
fn begin_scene_samples_the_target() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0218, 0x0810);
    bench.card.set(0x0240, 2);
    bench.card.set(0x0244, 4);
    bench.card.set(0x0248, 1);
    bench.card.set(0x024C, 0x0003_0021);
    bench.card.set(0x0250, 0x102);
    bench.card.set(0x0254, 0x40);
    bench.card.set(0x0258, 0b1011);
    bench.card.set(0x025C, 0x0004_0040);
    bench.card.set(0x0260, 2);
    bench.card.set(0x0264, 2);
    bench.card.set(0x0268, 1);
    bench.card.set(0x026C, 4096);
    bench.card.set(0x0270, 1);
    bench.card.set(0x021C, 0x7000);
    bench.card.set(0x0220, 64);
    let call = bench.last(0x02, &[]);
    let target = Target {
        colour: Surface { base: 0x1000, pitch: 256, width: 64, height: 32, format: PixelFormat::Xrgb8888 },
        depth: Some(DepthSurface { base: 0x4000, pitch: 256 }),
        depth_format: DepthFormat::new(16, 8).expect("a format"),
        subpixel_bits: 4,
        hidden_surface: HiddenSurface::Systolic,
        fidelity: Fidelity::Clocked,
        za: ZaSetting { base: 16, block: [33, 3], prediction: ZaPrediction::Plane, bypass: false },
        systolic: SystolicSetting {
            end_test: EndTest::Zero,
            ports: TokenPorts::Merged,
            colour: TokenColour::Tag,
            super_buffer: true,
        },
        tile: [64, 4],
        subpixel: Some(SubpixelSetting {
            grid: SubpixelGrid::Grid8x4,
            depth: SubpixelDepth::Exhaustive,
            resolve: SubpixelResolve::Linear,
            pool: 4096,
            edges: SubpixelEdges::Borders,
        }),
        stencil: Some(StencilSurface { base: 0x7000, pitch: 64 }),
    };
    assert_eq!(call, Call::BeginScene(target));
    assert_eq!(bench.processor.target(), Some(&target));
    assert!(bench.processor.in_scene());
}

#[test]
fn begin_scene_with_depth_pitch_zero_has_no_z_buffer() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0214, 0);
    bench.card.set(0x0210, 0xFFFF_FFFF);
    bench.good(0x02, &[]);
    assert_eq!(bench.processor.target().map(|t| t.depth), Some(None));
}

#[test]
fn begin_scene_with_a_register_at_fault_names_its_offset() {
    use FaultCode::{BadAlignment, BadValue, OutOfMemory, Overlap};
    let size = |width: u32, height: u32| (height << 16) | width;
    // Register, value, code, register at fault.
    let cases = [
        (0x0200, size(0, 32), BadValue, 0x0200),
        (0x0200, size(64, 0), BadValue, 0x0200),
        (0x0200, size(16385, 1), BadValue, 0x0200),
        (0x0200, size(1, 16385), BadValue, 0x0200),
        (0x0200, size(65, 1), BadValue, 0x0208), // a row is longer than the pitch
        (0x0204, 0x1020, BadAlignment, 0x0204),
        (0x0204, MEMORY - 0x1FC0, OutOfMemory, 0x0204),
        (0x0204, 0xFFFF_FFC0, OutOfMemory, 0x0204),
        (0x0208, 0x0110, BadAlignment, 0x0208),
        (0x0208, 192, BadValue, 0x0208),
        (0x0208, 0xFFFF_FFC0, OutOfMemory, 0x0204),
        (0x020C, 3, BadValue, 0x020C),
        (0x020C, 0xFFFF_FFFF, BadValue, 0x020C),
        (0x0210, 0x4004, BadAlignment, 0x0210),
        (0x0210, MEMORY - 0x1FC0, OutOfMemory, 0x0210),
        (0x0210, 0x1000, Overlap, 0x0210),
        (0x0210, 0x2FC0, Overlap, 0x0210),
        (0x0204, 0x2040, Overlap, 0x0210),
        (0x0214, 0x0101, BadAlignment, 0x0214),
        (0x0214, 192, BadValue, 0x0214),
        (0x0218, 0, BadValue, 0x0218),
        (0x0218, 0x1820, BadValue, 0x0218),
        (0x0240, 4, BadValue, 0x0240),
        (0x0244, 6, BadValue, 0x0244),
        (0x0248, 2, BadValue, 0x0248),
        (0x024C, size(0, 1), BadValue, 0x024C),
        (0x024C, size(1, 16385), BadValue, 0x024C),
        (0x0250, 3, BadValue, 0x0250),
        (0x0254, 0x20, BadAlignment, 0x0254),
        (0x025C, size(7, 8), BadValue, 0x025C),
        (0x025C, size(8, 2), BadValue, 0x025C),
        (0x025C, size(128, 8), BadValue, 0x025C),
        (0x0260, 4, BadValue, 0x0260),
        (0x0264, 3, BadValue, 0x0264),
        (0x0268, 2, BadValue, 0x0268),
        (0x026C, 0, BadValue, 0x026C),
        (0x026C, 0x0010_0001, BadValue, 0x026C),
        (0x0270, 2, BadValue, 0x0270),
        (0x021C, 0x7020, BadAlignment, 0x021C),
        (0x021C, MEMORY - 0x7C0, OutOfMemory, 0x021C),
        (0x021C, 0x1FC0, Overlap, 0x021C), // the frame buffer
        (0x021C, 0x5FC0, Overlap, 0x021C), // the Z buffer
        (0x021C, 0x3840, Overlap, 0x021C),
        (0x0220, 0x41, BadAlignment, 0x0220),
        (0x0220, 0xFFFF_FFC0, OutOfMemory, 0x021C),
    ];
    for (register, value, code, at_fault) in cases {
        let mut bench = Bench::with_stencil_plane();
        bench.card.set(register, value);
        bench.bad(0x02, &[], code, 0, at_fault);
    }
}

#[test]
fn begin_scene_on_the_last_bytes_and_side_by_side_is_legal() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0204, MEMORY - 0x2000);
    bench.card.set(0x0210, MEMORY - 0x4000);
    bench.good(0x02, &[]);
}

#[test]
fn begin_scene_of_the_largest_side_is_legal() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0200, (1 << 16) | 16384);
    bench.card.set(0x0208, 0x8000);
    bench.card.set(0x020C, 2);
    bench.card.set(0x0210, 0x2_0000);
    bench.card.set(0x0214, 0x1_0000);
    bench.good(0x02, &[]);
}

#[test]
fn begin_scene_on_a_path_the_card_lacks_is_unsupported() {
    let mut bench = Bench::with_target();
    bench.card.set(0x000C, 0b0001);
    bench.card.set(0x0240, 1);
    bench.bad(0x02, &[], FaultCode::Unsupported, 0, 0x0240);
}

#[test]
fn begin_scene_on_the_za_path_needs_words_for_all_blocks() {
    // 64 x 32 pixels in blocks of 16 x 2: 4 x 16 words, 256 bytes.
    let mut bench = Bench::with_target();
    bench.card.set(0x0014, 0x1000);
    bench.card.set(0x0240, 1);
    bench.card.set(0x024C, 0x0002_0010);
    bench.card.set(0x0254, 0x0F00);
    bench.good(0x02, &[]);
    bench.good(0x03, &[]);
    bench.card.set(0x0254, 0x0F40);
    bench.bad(0x02, &[], FaultCode::OutOfMemory, 0, 0x0254);
    // Only that path has a use for them.
    bench.card.set(0x0240, 3);
    bench.good(0x02, &[]);
}

#[test]
fn begin_scene_without_a_grid_has_no_sub_pixel_unit() {
    let mut bench = Bench::with_target();
    bench.card.set(0x0264, 2);
    bench.good(0x02, &[]);
    assert_eq!(bench.processor.target().map(|target| target.subpixel), Some(None));
}

#[test]
fn begin_scene_with_a_grid_after_reset_has_the_manual_s_values() {
    for (code, grid) in [(1, SubpixelGrid::Grid4x4), (2, SubpixelGrid::Grid8x4), (3, SubpixelGrid::Grid8x8)] {
        let mut bench = Bench::with_target();
        bench.card.set(0x0260, code);
        bench.good(0x02, &[]);
        let setting = SubpixelSetting {
            grid,
            depth: SubpixelDepth::Search,
            resolve: SubpixelResolve::Values,
            pool: 1 << 20,
            edges: SubpixelEdges::All,
        };
        assert_eq!(bench.processor.target().and_then(|target| target.subpixel), Some(setting));
    }
}

#[test]
fn depth_without_a_z_buffer_is_legal_on_paths_with_depth_registers() {
    for (path, legal) in [(0, false), (1, false), (2, true), (3, true)] {
        let mut bench = Bench::with_target();
        bench.card.set(0x0014, 0x1000);
        bench.card.set(0x0214, 0);
        bench.card.set(0x0240, path);
        bench.good(0x02, &[]);
        let (cleared, _) = bench.run(&[0x0400_0003, 2, 0, 5]);
        let (drawn, _) = bench.run(&[&[0x1000_000C, 0, 3, 0], &TRIANGLE[..]].concat());
        assert_eq!((cleared.is_ok(), drawn.is_ok()), (legal, legal), "path {path}");
    }
}

#[test]
fn begin_scene_in_a_scene_is_refused() {
    Bench::in_scene().bad(0x02, &[], FaultCode::InsideScene, 0, 0x0200_0000);
}

#[test]
fn end_scene_ends_and_another_may_begin() {
    let mut bench = Bench::in_scene();
    assert_eq!(bench.good(0x03, &[]), [Call::EndScene(None)]);
    assert!(!bench.processor.in_scene());
    assert_eq!(bench.processor.target(), None);
    bench.good(0x02, &[]);
}

#[test]
fn end_scene_clear_and_draws_outside_a_scene_are_refused() {
    let mut bench = Bench::with_target();
    bench.bad(0x03, &[], FaultCode::OutsideScene, 0, 0x0300_0000);
    bench.bad(0x04, &[1, 0, 0], FaultCode::OutsideScene, 0, 0x0400_0003);
    bench.bad(0x10, &[0, 0, 0], FaultCode::OutsideScene, 0, 0x1000_0003);
    bench.bad(0x11, &[0; 5], FaultCode::OutsideScene, 0, 0x1100_0005);
}

#[test]
fn end_scene_that_the_watchdog_stops_faults_and_is_over() {
    let mut bench = Bench::in_scene();
    bench.card.stop = Some(Stopped::Watchdog);
    let (result, calls) = bench.run(&[0x0300_0000]);
    assert_eq!(result, Err(Fault::new(FaultCode::Watchdog, 0, 0)));
    assert_eq!(calls, [Call::EndScene(None)]);
    assert!(!bench.processor.in_scene());
}

#[test]
fn end_scene_that_a_reset_stops_is_no_fault() {
    let mut bench = Bench::in_scene();
    bench.card.stop = Some(Stopped::Reset);
    bench.good(0x03, &[]);
}

#[test]
fn reset_in_a_scene_is_as_after_power_on() {
    let mut bench = Bench::in_scene();
    bench.processor.reset();
    assert!(!bench.processor.in_scene());
    assert_eq!(bench.processor.state(), Bench::new().processor.state());
}

#[test]
fn clear_of_each_set_of_planes_reaches_the_card() {
    let cases = [(1, Some(0x1122_3344), None), (2, None, Some(0x00FF_FFFF)), (3, Some(0x1122_3344), Some(0x00FF_FFFF))];
    for (planes, colour, depth) in cases {
        let call = Bench::in_scene().last(0x04, &[planes, 0x1122_3344, 0x00FF_FFFF]);
        let clear = Clear { colour, depth, stencil: None, area: WHOLE };
        assert_eq!(call, Call::Clear(clear));
    }
}

#[test]
fn clear_without_planes_does_nothing() {
    assert_eq!(Bench::in_scene().good(0x04, &[0, 1, 2]), []);
}

#[test]
fn clear_of_unknown_planes_is_a_bad_value() {
    for planes in [8, 0x101, 0x8000_0001] {
        Bench::in_scene().bad(0x04, &[planes, 0, 0], FaultCode::BadValue, 1, planes);
    }
}

#[test]
fn clear_of_a_depth_above_the_maximum_is_a_bad_value_only_if_it_is_used() {
    let mut bench = Bench::in_scene();
    bench.bad(0x04, &[2, 0, 0x0100_0000], FaultCode::BadValue, 3, 0x0100_0000);
    bench.bad(0x04, &[3, 0, 0xFFFF_FFFF], FaultCode::BadValue, 3, 0xFFFF_FFFF);
    bench.good(0x04, &[1, 0, 0xFFFF_FFFF]);
}

#[test]
fn clear_of_depth_without_z_buffer_is_a_bad_value() {
    let mut bench = Bench::in_scene_without_depth();
    bench.bad(0x04, &[3, 0, 0], FaultCode::BadValue, 1, 3);
    bench.good(0x04, &[1, 0, 0]);
}

#[test]
fn clear_area_is_the_scissor_cut_to_the_target() {
    let at = |x: u32, y: u32| (y << 16) | x;
    let rectangle = |x, y, right, bottom| Rectangle { x, y, right, bottom };
    let cases = [
        (at(3, 4), at(10, 20), rectangle(3, 4, 10, 20)),
        (at(3, 4), at(1000, 1000), rectangle(3, 4, 64, 32)),
        (at(100, 100), at(200, 200), rectangle(64, 32, 64, 32)),
        (at(20, 20), at(10, 10), rectangle(10, 10, 10, 10)),
        (0x8000_8001, 0xFFFF_FFFF, rectangle(1, 0, 64, 32)),
    ];
    for (minimum, maximum, area) in cases {
        let mut bench = Bench::in_scene();
        bench.card.set(0x0290, minimum);
        bench.card.set(0x0294, maximum);
        let expected = Clear { colour: Some(0), depth: None, stencil: None, area };
        assert_eq!(bench.last(0x04, &[1, 0, 0]), Call::Clear(expected));
    }
}

#[test]
fn begin_scene_with_stencil_pitch_zero_has_no_stencil_plane() {
    let mut bench = Bench::with_stencil_plane();
    bench.card.set(0x0220, 0);
    bench.card.set(0x021C, 0xFFFF_FFFF);
    bench.good(0x02, &[]);
    assert_eq!(bench.processor.target().map(|target| target.stencil), Some(None));
}

#[test]
fn clear_of_the_stencil_plane_takes_its_value_from_the_planes_word() {
    let cases = [(0x4, None, None, 0), (0xA505, Some(7), None, 0xA5), (0xFF07, Some(7), Some(9), 0xFF)];
    for (planes, colour, depth, stencil) in cases {
        let mut bench = Bench::with_stencil_plane();
        bench.good(0x02, &[]);
        let clear = Clear { colour, depth, stencil: Some(stencil), area: WHOLE };
        assert_eq!(bench.last(0x04, &[planes, 7, 9]), Call::Clear(clear));
    }
}

#[test]
fn clear_of_the_stencil_plane_where_there_is_none_or_with_odd_bits_is_a_bad_value() {
    Bench::in_scene().bad(0x04, &[5, 0, 0], FaultCode::BadValue, 1, 5);
    let mut bench = Bench::with_stencil_plane();
    bench.good(0x02, &[]);
    for planes in [0x0001_0004, 0x0000_0100, 0x0000_0102, 0x0000_000C] {
        bench.bad(0x04, &[planes, 0, 0], FaultCode::BadValue, 1, planes);
    }
}

#[test]
fn end_scene_with_the_shadow_bit_has_shadows_only_after_a_stencil_draw() {
    let shadow = Shadow {
        test: StencilTest { function: DepthFunction::Less, reference: 0x12, read_mask: 0x7F },
        intensity: 0x40,
    };
    for (effects, enable, expected) in [(0x800, 1, Some(shadow)), (0x800, 0, None), (0, 1, None)] {
        let mut bench = Bench::with_stencil_plane();
        bench.good(0x02, &[]);
        bench.card.set(0x0280, effects);
        bench.card.set(0x0380, 0x007F_1210 | enable);
        bench.card.set(0x0384, 0x40);
        bench.good(0x10, &[&[0, 3, 0], &TRIANGLE[..]].concat());
        assert_eq!(bench.good(0x03, &[]), [Call::EndScene(expected)], "{effects:#x}, {enable}");
    }
}
