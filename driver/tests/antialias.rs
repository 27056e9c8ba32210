//! Anti-aliasing: what the driver sends for it, against numbers restated from the manual.

mod common;

use std::time::Duration;

use common::{opcodes, target, triangle};
use zga_abi::format::{SubpixelDepth, SubpixelEdges, SubpixelGrid, SubpixelResolve};
use zga_abi::registers::Reg;
use zga_driver::bus::MockBus;
use zga_driver::{Antialias, Driver, DriverError, DriverOptions, Submit, Target};

const RED: [u8; 4] = [255, 0, 0, 128];
/// SUBPIXEL_GRID, SUBPIXEL_DEPTH, SUBPIXEL_RESOLVE, SUBPIXEL_POOL, SUBPIXEL_EDGES.
const SUBPIXEL: [u32; 5] = [0x0260, 0x0264, 0x0268, 0x026C, 0x0270];
/// LINE_WIDTH, POINT_SIZE.
const WIDTHS: [u32; 2] = [0x0298, 0x029C];
const EFFECTS: u32 = 0x0280;
const DEPTH: u32 = 1;
const BLEND: u32 = 0x100;
const ANTI_ALIAS: u32 = 0x400;

/// A driver on a mock card with a sub-pixel unit.
fn driver() -> Driver<MockBus> {
    let mut bus = MockBus::new(common::MEMORY);
    bus.set_register(Reg::CapabilityEffects, 0x50F);
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
fn antialias_programs_grid_depth_resolve_and_pool_and_draws_call_for_masks() {
    let mut driver = driver();
    let target = target(&mut driver);
    let (depth, resolve) = (SubpixelDepth::Exhaustive, SubpixelResolve::Linear);
    let setting = Antialias { grid: SubpixelGrid::Grid8x4, depth, resolve, pool: 4096, edges: SubpixelEdges::Borders };
    driver.set_antialias(Some(setting)).expect("there");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, SUBPIXEL), [2, 2, 1, 4096, 1]);
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | ANTI_ALIAS);
    assert_eq!(driver.antialias(), Some(setting));
}

#[test]
fn antialias_of_each_grid_has_the_code_of_the_manual() {
    let mut driver = driver();
    let target = target(&mut driver);
    let codes: Vec<u32> = SubpixelGrid::ALL
        .iter()
        .map(|&grid| {
            driver.set_antialias(Some(Antialias { grid, ..Antialias::default() })).expect("there");
            scene(&mut driver, &target).expect("draws");
            driver.bus().register(SUBPIXEL[0])
        })
        .collect();
    assert_eq!(codes, [0, 1, 2, 3]);
}

#[test]
fn antialias_is_off_after_opening_and_nothing_of_it_travels() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_line_width(2.0).expect("possible");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, SUBPIXEL), [0, 1, 0, 1 << 20, 0]);
    assert_eq!(registers(&driver, WIDTHS), [0x100, 0x100], "only masks have a width");
    assert_eq!(driver.bus().register(EFFECTS), DEPTH);
    let sent = opcodes(&driver.bus_mut().take_packets());
    assert_eq!(sent, [1, 2, 4, 0x10, 3, 0x30], "the target alone");
}

#[test]
fn antialias_counts_from_the_next_begin_scene_on() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.begin_scene(&target).expect("begins");
    driver.set_antialias(Some(Antialias::default())).expect("there");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(registers(&driver, [SUBPIXEL[0], EFFECTS]), [0, DEPTH]);
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, [SUBPIXEL[0], EFFECTS]), [3, DEPTH | ANTI_ALIAS]);
}

#[test]
fn antialias_none_inside_a_scene_draws_whole_pixels_and_then_no_grid() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_antialias(Some(Antialias::default())).expect("there");
    driver.begin_scene(&target).expect("begins");
    driver.set_antialias(None).expect("possible");
    driver.draw_triangle(triangle(RED)).expect("draws");
    driver.end_scene().expect("ends");
    driver.finish().expect("done");
    assert_eq!(registers(&driver, [SUBPIXEL[0], EFFECTS]), [3, DEPTH]);
    scene(&mut driver, &target).expect("draws");
    assert_eq!(driver.bus().register(SUBPIXEL[0]), 0);
}

#[test]
fn widths_are_rounded_to_256ths_and_sent_with_masks() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_antialias(Some(Antialias::default())).expect("there");
    for (pixels, steps) in [(1.5, 0x180), (0.003, 1), (255.996, 0xFFFF), (2.0 / 512.0, 1), (3.0, 0x300)] {
        driver.set_line_width(pixels).expect("possible");
        driver.set_point_size(pixels / 2.0 + 0.5).expect("possible");
        scene(&mut driver, &target).expect("draws");
        assert_eq!(driver.bus().register(WIDTHS[0]), steps, "{pixels}");
    }
    assert_eq!(registers(&driver, WIDTHS), [0x300, 0x200]);
}

#[test]
fn widths_out_of_range_are_refused_and_leave_what_was() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_antialias(Some(Antialias::default())).expect("there");
    for pixels in [0.0, -1.0, 0.001, 256.0, f64::INFINITY, f64::NAN] {
        assert!(matches!(driver.set_line_width(pixels), Err(DriverError::BadOption { name: "line width", .. })));
        assert!(matches!(driver.set_point_size(pixels), Err(DriverError::BadOption { name: "point size", .. })));
    }
    let refused = driver.set_line_width(-0.5).expect_err("negative").to_string();
    assert_eq!(refused, "line width is -0.5, expected 1/256 to 65535/256 pixels");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(registers(&driver, WIDTHS), [0x100, 0x100]);
}

#[test]
fn pool_out_of_range_is_refused_and_leaves_what_was() {
    let mut driver = driver();
    for pool in [0, (1 << 20) + 1] {
        let refused = driver.set_antialias(Some(Antialias { pool, ..Antialias::default() })).expect_err("no pool");
        assert_eq!(refused.to_string(), format!("sub-pixel pool is {pool}, expected 1 to 1048576 fragments"));
    }
    assert_eq!(driver.antialias(), None);
}

#[test]
fn blend_in_a_scene_with_a_grid_calls_for_layers() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_antialias(Some(Antialias::default())).expect("there");
    driver.set_blend(true).expect("there");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | BLEND | ANTI_ALIAS);
    driver.set_blend(false).expect("possible");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | ANTI_ALIAS);
}

#[test]
fn blend_without_a_grid_calls_for_layers_too() {
    let mut driver = driver();
    let target = target(&mut driver);
    driver.set_blend(true).expect("there");
    scene(&mut driver, &target).expect("draws");
    assert_eq!(driver.bus().register(EFFECTS), DEPTH | BLEND);
}

#[test]
fn card_without_a_sub_pixel_unit_refuses_both() {
    let mut driver = common::driver(Submit::Fifo);
    let refused = driver.set_antialias(Some(Antialias::default())).expect_err("no unit").to_string();
    assert_eq!(refused, "this card has no sub-pixel unit: CAPABILITY_EFFECTS reads 0xf");
    let refused = driver.set_blend(true).expect_err("no unit").to_string();
    assert_eq!(refused, "this card has no translucency: CAPABILITY_EFFECTS reads 0xf");
    driver.set_antialias(None).expect("off is always possible");
    driver.set_blend(false).expect("off is always possible");
}
