//! Random scenes: pixels, depths and counts against the specification of the Z buffer.

use super::*;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Point, Shape};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::held::{Background, Held, HeldDraw, Item};
use crate::hidden::stencil::StencilCounts;
use crate::hidden::systolic::{SystolicCounts, charge, closed_form, draw_scene};
use crate::hidden::z_buffer::band::Setting;
use crate::hidden::z_buffer::specification;
use crate::probe::account::Account;
use crate::shading::pixel::ShadingCounts;
use crate::shading::plane::Interpolation;
use zga_abi::Counter;
use zga_abi::format::{DepthFormat, Fidelity, HiddenSurface, PixelFormat, TokenColour};
use zga_firmware::checked::{DepthSurface, Rectangle, Surface, Target, ZaSetting};

/// What a scene was drawn to and what it cost.
#[derive(Debug, PartialEq)]
pub(super) struct Drawn {
    pub colour: Vec<u32>,
    pub depth: Vec<i32>,
    pub counts: SystolicCounts,
}

/// A scene before its shapes are set up, for any depth format.
#[derive(Clone, Debug)]
pub(super) enum Part {
    Triangle([ScreenVertex; 3], HeldDraw),
    Line([ScreenVertex; 2], HeldDraw),
    Point(ScreenVertex, HeldDraw),
    Clear(Rectangle, Option<u32>, Option<u32>),
}

pub(super) fn target(width: u32, height: u32, format: DepthFormat, pixels: PixelFormat, z_buffer: bool) -> Target {
    let pitch = (width * pixels.bytes()).next_multiple_of(64);
    Target {
        colour: Surface { base: 0, pitch, width, height, format: pixels },
        depth: z_buffer.then(|| DepthSurface { base: 1 << 20, pitch: (4 * width).next_multiple_of(64) }),
        depth_format: format,
        subpixel_bits: 8,
        hidden_surface: HiddenSurface::Systolic,
        fidelity: Fidelity::Clocked,
        za: ZaSetting::default(),
        systolic: SystolicSetting::default(),
        tile: [8, 8],
        subpixel: None,
        stencil: None,
    }
}

pub(super) fn held(parts: &[Part], background: Background, format: DepthFormat) -> Held {
    let mut held = Held { background, ..Held::default() };
    for part in parts {
        let (shape, draw) = match part {
            Part::Clear(area, colour, depth) => {
                let depth = depth.map(|depth| (depth & format.maximum()) as i32);
                held.items.push(Item::Clear { area: *area, colour: *colour, depth, stencil: None });
                continue;
            }
            Part::Triangle(v, draw) => {
                let v = v.map(|v| ScreenVertex { z: v.z & format.maximum(), ..v });
                (Triangle::new(&v, format).map(|(triangle, _)| Shape::Triangle(triangle, v)), draw)
            }
            Part::Line(v, draw) => {
                let v = v.map(|v| ScreenVertex { z: v.z & format.maximum(), ..v });
                (Line::new(&v, format).map(|line| Shape::Line(line, v)), draw)
            }
            Part::Point(v, draw) => {
                let v = ScreenVertex { z: v.z & format.maximum(), ..*v };
                let point = Point { pixel: [v.x >> 8, v.y >> 8], z: v.z as i32 };
                (Some(Shape::Point(point, v)), draw)
            }
        };
        if let Some(shape) = shape {
            held.draws.push(draw.clone());
            held.items.push(Item::Primitive(shape, held.draws.len() as u32 - 1));
        }
    }
    held
}

/// Frame buffer and Z buffer as they were before the scene: something else in every word.
fn surfaces(target: &Target) -> (Vec<u32>, Vec<i32>) {
    let height = target.colour.height;
    let colour = (0..target.colour.pitch / 4 * height).map(|n| n.wrapping_mul(0x9E37_79B9)).collect();
    let depths = target.depth.map_or(0, |depth| depth.pitch / 4 * height);
    let maximum = target.depth_format.maximum();
    (colour, (0..depths).map(|n| (n.wrapping_mul(0x85EB_CA6B) & maximum) as i32).collect())
}

pub(super) fn clocked(held: &Held, target: &Target, level: Option<Level>) -> Drawn {
    let (mut colour, mut depth) = surfaces(target);
    let counts = draw_scene(held, target, &mut colour, &mut depth, level, None);
    Drawn { colour, depth, counts }
}

/// The scene through the specification of the Z buffer, its tokens counted pixel by pixel.
fn specified(held: &Held, target: &Target) -> Drawn {
    let (width, height) = (target.colour.width, target.colour.height);
    let (mut colour, mut depth) = surfaces(target);
    let maximum = target.depth_format.maximum() as i32;
    // Without a Z buffer the depths are somebody's, who begins with the farthest.
    let depth_pitch = target.depth.map_or(width, |depth| depth.pitch / 4) as usize;
    depth.resize(depth_pitch * height as usize, maximum);
    let whole = Rectangle { x: 0, y: 0, right: width, bottom: height };
    let setting = |draw: &HeldDraw| Setting {
        test: draw.test,
        format: target.depth_format,
        interpolation: draw.interpolation,
        shading: None,
        stencil: None,
        cuts_segments: false,
        scissor: draw.scissor,
        width,
        pixel_format: target.colour.format,
        colour_pitch: target.colour.pitch as usize / 4,
        depth_pitch,
    };
    // A point drawn at a pixel is a clear of it, without a depth test.
    let clear = |area: &Rectangle, to: Option<u32>, z: Option<i32>, colour: &mut [u32], depth: &mut [i32]| {
        for (y, x) in (area.y..area.bottom).flat_map(|y| (area.x..area.right).map(move |x| (y, x))) {
            if let Some(to) = to {
                let draw = HeldDraw {
                    test: None,
                    interpolation: Interpolation::Flat,
                    shading: None,
                    scissor: whole,
                    stencil: None,
                };
                let vertex = ScreenVertex { x: x as i32 * 256, y: y as i32 * 256, colour: to, ..Default::default() };
                let point = Shape::Point(Point { pixel: [x as i32, y as i32], z: 0 }, vertex);
                let counts = specification::draw(&setting(&draw), std::iter::once((&point, 0)), colour, &mut []);
                assert_eq!(counts.passed, 1);
            }
            if let Some(z) = z {
                depth[y as usize * depth_pitch + x as usize] = z;
            }
        }
    };
    clear(&whole, held.background.colour, held.background.depth, &mut colour, &mut depth);

    let mut tokens = vec![0; height as usize];
    // Who is seen at a pixel: nobody yet, somebody flat, somebody whose colours are interpolated.
    let mut winners = vec![None; (width * height) as usize];
    let mut spans = 0;
    for item in &held.items {
        let before = depth.clone();
        let (area, shape) = match item {
            Item::Clear { area, colour: to, depth: z, .. } => {
                clear(area, *to, *z, &mut colour, &mut depth);
                (area, None)
            }
            Item::Primitive(shape, draw) => {
                let draw = &held.draws[*draw as usize];
                let drawn = specification::draw(&setting(draw), std::iter::once((shape, 0)), &mut colour, &mut depth);
                spans += drawn.spans;
                (&draw.scissor, Some(shape))
            }
        };
        // A clear meets every pixel of its area.
        let meets = |x: u32, y: u32| shape.is_none_or(|shape| specification::meets(shape, x as i32, y as i32));
        for y in area.y..area.bottom {
            let covered: Vec<u32> = (area.x..area.right).filter(|&x| meets(x, y)).collect();
            tokens[y as usize] += u32::from(!covered.is_empty());
            for x in covered {
                let winner = &mut winners[(y * width + x) as usize];
                match item {
                    Item::Clear { colour, .. } => *winner = if colour.is_some() { Some(false) } else { *winner },
                    Item::Primitive(shape, draw) => {
                        let draw = &held.draws[*draw as usize];
                        let plane = shape.plane(target.depth_format);
                        let below = crate::geometry::plane::below(target.depth_format);
                        let z = plane.stored(plane.value(x as i32, y as i32), below);
                        let stored = before[y as usize * depth_pitch + x as usize];
                        if draw.test.is_none_or(|test| test.passes(z, stored)) {
                            *winner = Some(draw.interpolation != Interpolation::Flat);
                        }
                    }
                }
            }
        }
    }
    let pixels = u64::from(width) * u64::from(height);
    let seen = |which: &dyn Fn(&Option<bool>) -> bool| winners.iter().filter(|winner| which(winner)).count() as u64;
    let counts = SystolicCounts {
        tokens: tokens.iter().copied().map(u64::from).sum(),
        clocks: closed_form(&tokens, width, &target.systolic),
        spans,
        reads: if target.depth.is_some() && held.background.depth.is_none() { pixels } else { 0 },
        writes: if target.depth.is_some() { pixels } else { 0 },
        colours: if held.background.colour.is_some() { pixels } else { seen(&|winner| winner.is_some()) },
        shaded: seen(&|winner| *winner == Some(true)),
        shading: ShadingCounts::default(),
        stencil: StencilCounts::default(),
    };
    if target.depth.is_none() {
        depth.clear();
    }
    Drawn { colour, depth, counts }
}

fn formats() -> impl Strategy<Value = DepthFormat> {
    (proptest::sample::select(vec![16_u32, 24, 31]), proptest::sample::select(vec![0_u32, 8, 16, 24]))
        .prop_filter_map("a format", |(bits, fraction)| DepthFormat::new(bits, fraction))
}

fn rectangles(width: u32, height: u32) -> impl Strategy<Value = Rectangle> {
    let side = |size: u32| (0..=size, 0..=size).prop_map(|(a, b)| (a.min(b), a.max(b)));
    let any = (side(width), side(height)).prop_map(|((x, right), (y, bottom))| Rectangle { x, y, right, bottom });
    prop_oneof![2 => Just(Rectangle { x: 0, y: 0, right: width, bottom: height }), 1 => any]
}

fn draws(width: u32, height: u32) -> impl Strategy<Value = HeldDraw> {
    let interpolation =
        proptest::sample::select(vec![Interpolation::Flat, Interpolation::Affine, Interpolation::Perspective]);
    let test = prop_oneof![2 => Just(Some(DepthTest::LESS)), 4 => tests().prop_map(Some), 1 => Just(None)];
    (test, interpolation, rectangles(width, height)).prop_map(|(test, interpolation, scissor)| HeldDraw {
        test,
        interpolation,
        shading: None,
        scissor,
        stencil: None,
    })
}

fn vertices() -> impl Strategy<Value = ScreenVertex> {
    let place = || prop_oneof![6 => -2000_i32..16_000, 2 => (-8_i32..60).prop_map(|p| p * 256 + 128), 1 => -(1_i32 << 22)..1 << 22];
    // Few depths, so that they tie; all of them; the limits of the range.
    let depth = prop_oneof![2 => 0_u32..4, 2 => any::<u32>(), 1 => Just(u32::MAX), 1 => Just(0)];
    let colour = prop_oneof![1 => Just(0xFF20_4060_u32), 3 => any::<u32>()];
    (place(), place(), depth, colour, prop_oneof![Just(1.0_f32), 0.1_f32..4.0])
        .prop_map(|(x, y, z, colour, reciprocal_w)| ScreenVertex { x, y, z, colour, reciprocal_w })
}

/// Triangles: any, and slivers one unit thin whose planes are steep.
fn corners() -> impl Strategy<Value = [ScreenVertex; 3]> {
    let sliver = (vertices(), vertices(), any::<[bool; 2]>(), vertices())
        .prop_map(|(a, b, [x, y], c)| [a, b, ScreenVertex { x: b.x + i32::from(x), y: b.y + i32::from(y), ..c }]);
    prop_oneof![3 => [vertices(), vertices(), vertices()], 1 => sliver]
}

pub(super) fn parts(width: u32, height: u32) -> impl Strategy<Value = Vec<Part>> {
    let draw = move || draws(width, height);
    let clear = (rectangles(width, height), any::<Option<u32>>(), any::<Option<u32>>())
        .prop_map(|(area, colour, depth)| Part::Clear(area, colour, depth));
    let part = prop_oneof![
        6 => (corners(), draw()).prop_map(|(v, draw)| Part::Triangle(v, draw)),
        2 => ([vertices(), vertices()], draw()).prop_map(|(v, draw)| Part::Line(v, draw)),
        1 => (vertices(), draw()).prop_map(|(v, draw)| Part::Point(v, draw)),
        1 => clear,
    ];
    proptest::collection::vec(part, 0..24)
}

fn targets() -> impl Strategy<Value = Target> {
    let pixels = proptest::sample::select(PixelFormat::ALL.to_vec());
    let variant = (0_usize..4, proptest::sample::select(TokenColour::ALL.to_vec()), any::<bool>())
        .prop_map(|(variant, colour, super_buffer)| SystolicSetting { colour, super_buffer, ..VARIANTS[variant] });
    (1_u32..60, 1_u32..40, formats(), pixels, any::<bool>(), variant).prop_map(
        |(width, height, format, pixels, z_buffer, systolic)| Target {
            systolic,
            ..target(width, height, format, pixels, z_buffer)
        },
    )
}

fn scenes() -> impl Strategy<Value = (Target, Vec<Part>, Background)> {
    targets().prop_flat_map(|target| {
        let maximum = target.depth_format.maximum();
        let depth = proptest::option::of((0..=maximum).prop_map(|depth| depth as i32));
        let background =
            (any::<Option<u32>>(), depth).prop_map(|(colour, depth)| Background { colour, depth, stencil: None });
        (Just(target), parts(target.colour.width, target.colour.height), background)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn scene_any_variant_equals_specification_of_the_z_buffer((target, parts, background) in scenes()) {
        let held = held(&parts, background, target.depth_format);
        let expected = specified(&held, &target);
        prop_assert_eq!(clocked(&held, &target, Some(Level::new())), expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn scene_any_level_equals_elements_one_by_one((target, parts, background) in scenes()) {
        let held = held(&parts, background, target.depth_format);
        let expected = clocked(&held, &target, None);
        for level in levels() {
            prop_assert_eq!(&clocked(&held, &target, Some(level)), &expected);
        }
    }
}

#[test]
fn scene_empty_is_refreshed_line_by_line() {
    let target = target(20, 5, DepthFormat::default(), PixelFormat::Xrgb8888, true);
    let held = Held {
        background: Background { colour: Some(0x0010_2030), depth: Some(77), stencil: None },
        ..Held::default()
    };

    let drawn = clocked(&held, &target, Some(Level::new()));

    let rows = drawn.colour.chunks(target.colour.pitch as usize / 4);
    assert!(rows.map(|row| &row[..20]).all(|row| row == [0xFF30_2010; 20]));
    assert!(drawn.depth.chunks(32).map(|row| &row[..20]).all(|row| row == [77; 20]));
    let counts = SystolicCounts { clocks: 4 * 20 + 20 + 2, writes: 100, colours: 100, ..SystolicCounts::default() };
    assert_eq!(drawn.counts, counts);
}

#[test]
fn charge_counts_stand_in_their_counters() {
    let counts = SystolicCounts {
        tokens: 1,
        clocks: 20,
        spans: 3,
        reads: 4,
        writes: 5,
        colours: 6,
        shaded: 70,
        ..SystolicCounts::default()
    };
    let mut account = Account::default();

    charge(&counts, &mut account);

    use Counter as C;
    let expected = [
        (C::SystolicTokens, 1),
        (C::SystolicClocks, 20),
        (C::CyclesSystolic, 20),
        (C::ZSpans, 3),
        (C::ZReads, 4),
        (C::ZWrites, 5),
        (C::ColourWrites, 6),
        (C::ShadingPixels, 70),
        (C::CyclesShading, 70),
        (C::CyclesTotal, 90),
    ];
    assert_eq!(expected.map(|(counter, _)| (counter, account.get(counter))), expected);
}
