//! The layer unit against its specification, and by hand.

use super::specification;
use super::unit::Unit;
use super::{Counts, Setting};
use crate::geometry::ScreenVertex;
use crate::hidden::z_buffer::DepthTest;
use crate::shading::plane::Interpolation;
use crate::subpixel::scene::{Item, ItemDraw, Kind, Scene};
use fearless_simd::Level;
use proptest::prelude::*;
use zga_abi::format::{BlendMode, DepthFormat, DepthFunction, PixelFormat};
use zga_firmware::Stopped;
use zga_firmware::checked::Rectangle;

/// Width, height; words of a row of colours and of depths.
const SIZE: [i32; 2] = [150, 140];
const PITCHES: [usize; 2] = [160, 176];

/// SIMD levels of this host.
fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![best];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse2().map(Level::Sse2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
    }
    levels
}

fn setting(format: DepthFormat, pixel_format: PixelFormat, area: [[i32; 2]; 2]) -> Setting {
    Setting { format, pixel_format, colour_pitch: PITCHES[0], depth_pitch: PITCHES[1], area, stencil_pitch: 0 }
}

fn whole() -> [[i32; 2]; 2] {
    SIZE.map(|size| [0, size])
}

fn at(x: i32, y: i32, z: u32, colour: u32) -> ScreenVertex {
    ScreenVertex { x, y, z, colour, reciprocal_w: 1.0 }
}

fn draw(test: Option<DepthTest>, mode: BlendMode) -> ItemDraw {
    let scissor = Rectangle { x: 0, y: 0, right: SIZE[0] as u32, bottom: SIZE[1] as u32 };
    ItemDraw {
        test,
        interpolation: Interpolation::Flat,
        shading: None,
        blend: true,
        mode,
        tag: 0,
        stencil: None,
        scissor,
        colour: None,
        depth: None,
    }
}

fn scene_of(items: Vec<Item>, draws: Vec<ItemDraw>) -> Scene {
    let mut scene = Scene::default();
    (scene.items, scene.draws) = (items, draws);
    scene
}

/// A triangle over all pixels, one depth, one colour.
fn wall(z: u32, colour: u32) -> Item {
    let [right, bottom] = SIZE.map(|size| 512 * size);
    Item {
        vertices: [at(0, 0, z, colour), at(right, 0, z, colour), at(0, bottom, z, colour)],
        draw: 0,
        number: 0,
        kind: Kind::Triangle,
    }
}

/// Composes over one colour and one opaque depth; returns pixel (3, 4) and the counts, which are the specification's.
fn composed(items: Vec<Item>, draws: Vec<ItemDraw>, pixel: u32, depth: i32) -> (u32, Counts) {
    let scene = scene_of(items, draws);
    let setting = setting(DepthFormat::default(), PixelFormat::Argb8888, whole());
    let results = [None, Some(Level::new())].map(|level| {
        let mut colours = vec![pixel; PITCHES[0] * SIZE[1] as usize];
        let mut depths = vec![depth; PITCHES[1] * SIZE[1] as usize];
        let (counts, stopped) =
            Unit::default().compose(&setting, &scene, level, None, &mut colours, &mut depths, &mut [], &|_| None);
        assert_eq!(stopped, Ok(()));
        (colours, counts)
    });
    assert_eq!(results[0], results[1]);
    (results[0].0[4 * PITCHES[0] + 3], results[0].1)
}

#[test]
fn compose_farthest_first_whatever_came_first() {
    let all = (SIZE[0] * SIZE[1]) as u64;
    let draws = vec![draw(Some(DepthTest::LESS), BlendMode::Alpha)];
    // Blue (B in 23:16) far, red near, both 128 of 255; over black: (0, 0, 128), then (128, 0, 64).
    let [red, blue] = [wall(10, 0x8000_00FF), wall(20, 0x80FF_0000)];
    let in_order = composed(vec![blue, red], draws.clone(), 0xFF00_0000, 30);
    assert_eq!(in_order.0, 0xFF80_0040);
    assert_eq!((in_order.1.comparisons, in_order.1.sorted_pixels), (all, 0));
    let reversed = composed(vec![red, blue], draws.clone(), 0xFF00_0000, 30);
    assert_eq!(reversed.0, 0xFF80_0040);
    assert_eq!((reversed.1.comparisons, reversed.1.sorted_pixels), (all, all));
    // Three out of order: each with each.
    let three = composed(vec![red, blue, wall(15, 0x8000_0000)], draws.clone(), 0xFF00_0000, 30);
    assert_eq!((three.1.fragments, three.1.blended, three.1.comparisons), (3 * all, 3 * all, 3 * all));
    // The opaque lies between.
    let hidden = composed(vec![red, blue], draws, 0xFF00_0000, 15);
    assert_eq!(hidden.0, 0xFF80_0000);
    assert_eq!((hidden.1.fragments, hidden.1.blended, hidden.1.comparisons), (2 * all, all, 0));
}

#[test]
fn compose_equal_depths_in_order_of_submission_and_untested_nearest() {
    let [red, blue] = [wall(10, 0x8000_00FF), wall(10, 0x80FF_0000)];
    let draws = vec![draw(Some(DepthTest::LESS), BlendMode::Alpha), draw(None, BlendMode::Alpha)];
    assert_eq!(composed(vec![red, blue], draws.clone(), 0xFF00_0000, 30).0, 0xFF40_0080);
    assert_eq!(composed(vec![blue, red], draws.clone(), 0xFF00_0000, 30).0, 0xFF80_0040);
    // Behind the opaque, but nobody asks.
    let free = Item { draw: 1, ..wall(90, 0x8000_00FF) };
    assert_eq!(composed(vec![free, blue], draws.clone(), 0xFF00_0000, 30).0, 0xFF80_0040);
    assert_eq!(composed(vec![blue, free], draws, 0xFF00_0000, 5).0, 0xFF80_0000);
}

#[test]
fn compose_stopped_says_so() {
    let scene = scene_of(vec![wall(1, 0x8000_00FF)], vec![draw(None, BlendMode::Add)]);
    let setting = setting(DepthFormat::default(), PixelFormat::Argb8888, whole());
    for level in [None, Some(Level::new())] {
        let mut colours = vec![0; PITCHES[0] * SIZE[1] as usize];
        let stop = |clocks: crate::probe::account::Clocks| (clocks.0 > 150).then_some(Stopped::Watchdog);
        let (counts, stopped) =
            Unit::default().compose(&setting, &scene, level, None, &mut colours, &mut [], &mut [], &stop);
        assert_eq!(stopped, Err(Stopped::Watchdog));
        assert!(counts.fragments < (SIZE[0] * SIZE[1]) as u64, "{level:?} went on");
    }
}

fn test() -> impl Strategy<Value = Option<DepthTest>> {
    let function = prop::sample::select(DepthFunction::ALL.to_vec());
    prop::option::weighted(0.85, function.prop_map(|function| DepthTest::new(function, false)))
}

fn rectangle() -> impl Strategy<Value = Rectangle> {
    let side = |size: i32| prop_oneof![1 => Just([0, size as u32]), 1 => [0..=size as u32, 0..=size as u32]];
    (side(SIZE[0]), side(SIZE[1])).prop_map(|(x, y)| Rectangle {
        x: x[0].min(x[1]),
        right: x[0].max(x[1]),
        y: y[0].min(y[1]),
        bottom: y[0].max(y[1]),
    })
}

fn any_draw() -> impl Strategy<Value = ItemDraw> {
    let interpolation = [Interpolation::Flat, Interpolation::Affine, Interpolation::Perspective];
    let interpolation = prop::sample::select(interpolation.to_vec());
    let mode = prop::sample::select(BlendMode::ALL.to_vec());
    let scissor = prop_oneof![2 => Just(draw(None, BlendMode::Alpha).scissor), 1 => rectangle()];
    // One that does not blend lies over what came before it.
    let blend = prop::bool::weighted(0.9);
    (test(), interpolation, mode, scissor, blend).prop_map(|(test, interpolation, mode, scissor, blend)| ItemDraw {
        interpolation,
        scissor,
        blend,
        ..draw(test, mode)
    })
}

/// Depths near to each other, so that ties and crossings are common, and anywhere.
fn depth(bits: u32) -> impl Strategy<Value = u32> {
    prop_oneof![3 => 100_u32..104, 1 => 0..1_u32 << bits]
}

fn vertex(bits: u32) -> impl Strategy<Value = ScreenVertex> {
    let place = || prop_oneof![3 => -2000_i32..42_000, 1 => (0_i32..160).prop_map(|pixel| 256 * pixel + 128)];
    let colour = prop_oneof![2 => any::<u32>(), 1 => Just(0x40FF_8020)];
    (place(), place(), depth(bits), colour, 0.2_f32..3.0).prop_map(|(x, y, z, colour, reciprocal_w)| ScreenVertex {
        x,
        y,
        z,
        colour,
        reciprocal_w,
    })
}

fn item(bits: u32, draws: usize) -> impl Strategy<Value = Item> {
    let kinds = [Kind::Triangle, Kind::Triangle, Kind::Triangle, Kind::Line, Kind::Point, Kind::Clear];
    let kind = prop::sample::select(kinds.to_vec());
    ([vertex(bits), vertex(bits), vertex(bits)], 0..draws as u32, kind, prop::bool::weighted(0.4)).prop_map(
        |([a, mut b, mut c], draw, kind, level)| {
            if level {
                (b.z, c.z) = (a.z, a.z);
            }
            match kind {
                Kind::Line => c = b,
                Kind::Point => (b, c) = (a, a),
                _ => {}
            }
            Item { vertices: [a, b, c], draw, number: 0, kind }
        },
    )
}

fn scene() -> impl Strategy<Value = (u32, Vec<Item>, Vec<ItemDraw>)> {
    let bits = prop::sample::select(vec![16_u32, 24, 31]);
    (bits, prop::collection::vec(any_draw(), 1..5)).prop_flat_map(|(bits, draws)| {
        let items = prop::collection::vec(item(bits, draws.len()), 1..14);
        (Just(bits), items, Just(draws))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn compose_random_layers_equals_the_specification_at_every_level(
        (bits, items, draws) in scene(), area in prop_oneof![2 => Just(None), 1 => rectangle().prop_map(Some)],
        opaque in prop::collection::vec(depth(31), 1..9), format in prop::sample::select(PixelFormat::ALL.to_vec()),
        fraction in prop::sample::select(vec![0_u32, 8, 24]), without_depths in prop::bool::weighted(0.1),
    ) {
        let mut scene = scene_of(items, draws);
        if without_depths {
            scene.draws.iter_mut().for_each(|draw| draw.test = None);
        }
        let area = area.map_or(whole(), |area| super::piece::pixels_of(&area));
        let mut setting = setting(DepthFormat::new(bits, fraction).unwrap(), format, area);
        let noise = |at: usize| (at as u32).wrapping_mul(0x9E37_79B9).rotate_left(9);
        let colours: Vec<u32> = (0..PITCHES[0] * SIZE[1] as usize).map(noise).collect();
        let most = (1_u32 << bits) - 1;
        let depths = (0..PITCHES[1] * SIZE[1] as usize).map(|at| opaque[at / 7 % opaque.len()].min(most) as i32);
        let mut depths: Vec<i32> = depths.collect();
        if without_depths {
            (depths, setting.depth_pitch) = (vec![], 0);
        }
        let before = depths.clone();
        let mut expected = colours.clone();
        let counts = specification::compose(&setting, &scene, &mut expected, &depths, &[]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        for (level, pool) in levels().into_iter().flat_map(|level| [(level, None), (level, Some(&pool))]) {
            let mut found = colours.clone();
            let (found_counts, stopped) =
                Unit::default().compose(&setting, &scene, Some(level), pool, &mut found, &mut depths, &mut [], &|_| None);
            prop_assert_eq!(stopped, Ok(()));
            prop_assert!(found == expected, "another picture at {:?}", level);
            prop_assert_eq!(found_counts, counts);
        }
        prop_assert!(depths == before, "depths are read only");
    }
}

#[test]
fn touched_holds_every_pixel_that_changes() {
    let vertices = [at(0, 0, 1, 0x80FF_FFFF), at(30_000, 200, 1, 0), at(0, 700, 1, 0)];
    let sliver = Item { vertices, ..wall(0, 0) };
    let sliver = scene_of(vec![sliver], vec![draw(None, BlendMode::Alpha)]);
    let setting = setting(DepthFormat::default(), PixelFormat::Argb8888, whole());
    let touched = Unit::default().touched(&setting, &sliver);
    let mut colours = vec![0; PITCHES[0] * SIZE[1] as usize];
    specification::compose(&setting, &sliver, &mut colours, &[], &[]);
    let inside = |x: u32, y: u32| touched.iter().any(|r| (r.x..r.right).contains(&x) && (r.y..r.bottom).contains(&y));
    let changed = |x: u32, y: u32| colours[y as usize * PITCHES[0] + x as usize] != 0;
    let pixels = || (0..SIZE[1] as u32).flat_map(|y| (0..SIZE[0] as u32).map(move |x| (x, y)));
    assert!(pixels().any(|(x, y)| changed(x, y)) && pixels().all(|(x, y)| !changed(x, y) || inside(x, y)));
    assert!(pixels().filter(|&(x, y)| inside(x, y)).count() < 150 * 8, "{touched:?}");
}
