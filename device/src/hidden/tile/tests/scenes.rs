//! Random scenes, and what the plain Z buffer makes of them.

use crate::geometry::assembly::{List, Point, Shape, Sink};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::held::{Held, HeldDraw, Item};
use crate::hidden::tile::Grid;
use crate::hidden::tile::closed_form::{PixelCounts, Sorts};
use crate::hidden::z_buffer::band::Setting;
use crate::hidden::z_buffer::{DepthTest, specification};
use crate::shading::plane::Interpolation;
use proptest::prelude::*;
use zga_abi::format::{DepthFormat, Fidelity, HiddenSurface, PixelFormat};
use zga_firmware::checked::{DepthSurface, Rectangle, Surface, SystolicSetting, Target, ZaSetting};

/// A target of `size` pixels.
pub fn target(size: [u32; 2], tile: [u32; 2], format: PixelFormat, depth: DepthFormat, with_depth: bool) -> Target {
    let pitch = |bytes: u32| (size[0] * bytes).next_multiple_of(64) + 64;
    let colour = Surface { base: 0, pitch: pitch(format.bytes()), width: size[0], height: size[1], format };
    Target {
        colour,
        depth: with_depth.then_some(DepthSurface { base: 1 << 24, pitch: pitch(4) }),
        depth_format: depth,
        subpixel_bits: 8,
        hidden_surface: HiddenSurface::Tile,
        fidelity: Fidelity::Clocked,
        za: ZaSetting::default(),
        systolic: SystolicSetting::default(),
        tile,
        subpixel: None,
        stencil: None,
    }
}

/// A coordinate near, on or far from a target of `pixels`; often on a boundary of a tile.
fn coordinate(pixels: u32) -> impl Strategy<Value = i32> {
    let end = pixels as i32 * PIXEL;
    prop_oneof![
        6 => -1024..end + 1024,
        2 => (-1..=end / 1024 + 1, -1..=1).prop_map(|(boundary, d)| boundary * 1024 + d),
        1 => (-1..=pixels as i32 + 1).prop_map(|x| x * PIXEL + 128),
        1 => -(1_i32 << 23)..1 << 23,
    ]
}

/// A vertex; few depths, so that many are equal.
fn vertex(size: [u32; 2], depth: DepthFormat) -> impl Strategy<Value = ScreenVertex> {
    let far = depth.maximum();
    let z = prop_oneof![Just(far), Just(0), Just(far / 2), Just(far / 2 + 1), 0..=far];
    // No transparent colour: tests tell by alpha where something was drawn.
    let colour = any::<u32>().prop_map(|c| c | 0x0100_0000);
    let w = prop_oneof![3 => Just(1.0_f32), 1 => 0.01_f32..4.0];
    (coordinate(size[0]), coordinate(size[1]), z, colour, w).prop_map(|(x, y, z, colour, reciprocal_w)| ScreenVertex {
        x,
        y,
        z,
        colour,
        reciprocal_w,
    })
}

/// What a random item is made from.
#[derive(Clone, Debug)]
pub enum Made {
    /// A triangle.
    Triangle([ScreenVertex; 3]),
    /// A line.
    Line([ScreenVertex; 2]),
    /// A point.
    Point(ScreenVertex),
    /// A clear; 3 bits say which planes.
    Clear(u32, u32, u8),
}

/// A random item: kind, and three vertices from which it is made.
pub fn made(size: [u32; 2], depth: DepthFormat) -> impl Strategy<Value = Made> {
    let three = (vertex(size, depth), vertex(size, depth), vertex(size, depth));
    (0_u32..18, three, -40_i32..40, -40_i32..40).prop_map(|(kind, (a, b, c), dx, dy)| match kind {
        0..=5 => Made::Triangle([a, b, c]),
        // Slivers and small, steep triangles.
        6 | 7 => Made::Triangle([a, b, ScreenVertex { x: (a.x + b.x) / 2 + dx, y: (a.y + b.y) / 2 + dy, ..c }]),
        8 | 9 => {
            let near = |v: ScreenVertex, dx: i32, dy: i32| ScreenVertex { x: a.x + 8 * dx, y: a.y + 8 * dy, ..v };
            Made::Triangle([a, near(b, dx, dy), near(c, dy, 20 - dx)])
        }
        // Lines that are level, upright, short.
        10 => Made::Line([a, ScreenVertex { y: a.y, ..b }]),
        11 => Made::Line([a, ScreenVertex { x: a.x, ..b }]),
        12 => Made::Line([a, ScreenVertex { x: a.x + 8 * dx, y: a.y + 8 * dy, ..b }]),
        13 => Made::Line([a, b]),
        // Corners and crossings on corners of tiles.
        14 | 15 => Made::Triangle([a, b, c].map(|v| ScreenVertex { x: v.x & !1023, y: v.y & !1023, ..v })),
        16 => Made::Point(ScreenVertex { x: a.x.clamp(-1 << 20, 1 << 20), ..a }),
        _ => Made::Clear(a.colour, a.z, (b.colour >> 30) as u8),
    })
}

/// A part of the target, often all of it.
fn scissor(size: [u32; 2]) -> impl Strategy<Value = Rectangle> {
    let [w, h] = size;
    let any = (0..=w, 0..=w, 0..=h, 0..=h).prop_map(|(a, b, c, d)| Rectangle {
        x: a.min(b),
        y: c.min(d),
        right: a.max(b),
        bottom: c.max(d),
    });
    prop_oneof![2 => Just(Rectangle { x: 0, y: 0, right: w, bottom: h }), 1 => any]
}

/// State of a random draw.
fn draw(size: [u32; 2]) -> impl Strategy<Value = HeldDraw> {
    let test = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>())
        .prop_map(|(less, equal, greater, write)| DepthTest { less, equal, greater, write });
    let test = prop_oneof![2 => Just(Some(DepthTest::LESS)), 3 => test.prop_map(Some), 1 => Just(None)];
    let interpolation =
        prop_oneof![Just(Interpolation::Flat), Just(Interpolation::Affine), Just(Interpolation::Perspective)];
    (test, interpolation, scissor(size)).prop_map(|(test, interpolation, scissor)| HeldDraw {
        test,
        interpolation,
        shading: None,
        scissor,
        stencil: None,
    })
}

/// A scene and its target.
#[derive(Debug)]
pub struct Scene {
    /// Where it is drawn.
    pub target: Target,
    /// What is drawn.
    pub held: Held,
}

/// Puts items together; those that draw nothing anywhere do not arrive.
pub fn scene(target: Target, items: &[(Made, HeldDraw)], background: [Option<u32>; 2]) -> Scene {
    let mut held = Held::default();
    let all = Rectangle { x: 0, y: 0, right: target.colour.width, bottom: target.colour.height };
    held.clear(true, all, background[0], background[1].map(|z| z as i32), None);
    for (made, draw) in items {
        let mut list = List::default();
        list.reset(draw.scissor);
        match made {
            Made::Triangle(v) => {
                if let Some((triangle, columns)) = Triangle::new(v, target.depth_format) {
                    list.triangle(&triangle, columns, v, 0);
                }
            }
            Made::Line(v) => {
                if let Some(line) = Line::new(v, target.depth_format) {
                    list.line(&line, v, 0);
                }
            }
            Made::Point(v) => list.point(&Point { pixel: [v.x >> 8, v.y >> 8], z: v.z as i32 }, v, 0),
            Made::Clear(colour, depth, planes) => {
                let colour = (planes & 1 == 0).then_some(*colour);
                held.clear(false, draw.scissor, colour, (planes & 2 == 0).then_some(*depth as i32), None);
            }
        }
        held.add(draw, &list, |_| None);
    }
    Scene { target, held }
}

fn depth_format() -> impl Strategy<Value = DepthFormat> {
    let format = |bits: u32, fraction: u32| DepthFormat::new(bits, fraction).expect("a format of the card");
    (prop_oneof![Just(16_u32), Just(24), Just(31)], prop_oneof![Just(0_u32), Just(8), Just(16), Just(24)])
        .prop_map(move |(bits, fraction)| format(bits, fraction))
}

fn tile() -> impl Strategy<Value = [u32; 2]> {
    let side = || prop_oneof![Just(4_u32), Just(8), Just(16), Just(32), Just(64)];
    [side(), side()]
}

/// A random scene of up to `count` items on a target of up to `size` pixels.
pub fn scenes(size: u32, count: usize) -> impl Strategy<Value = Scene> {
    let pixel = prop_oneof![Just(PixelFormat::Xrgb8888), Just(PixelFormat::Argb8888), Just(PixelFormat::Rgb565)];
    ([1..=size, 1..=size], tile(), pixel, depth_format(), any::<bool>())
        .prop_flat_map(move |(size, tile, pixel, depth, with_depth)| {
            let target = target(size, tile, pixel, depth, with_depth);
            let items = proptest::collection::vec((made(size, depth), draw(size)), 0..count);
            let colour = proptest::option::of(any::<u32>());
            (Just(target), items, colour, proptest::option::of(0..=depth.maximum()))
        })
        .prop_map(|(target, items, colour, depth)| scene(target, &items, [colour, depth]))
}

/// Surfaces, and what is known of their pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Frame buffer.
    pub colour: Vec<u32>,
    /// Z buffer; empty without one.
    pub depth: Vec<i32>,
}

impl Picture {
    /// Memory before the scene: something everywhere.
    pub fn before(target: &Target) -> Picture {
        let height = target.colour.height as usize;
        let words = target.colour.pitch as usize / 4 * height;
        let depths = target.depth.map_or(0, |depth| depth.pitch as usize / 4 * height);
        let some = |k: usize| (k as u32).wrapping_mul(0x9E37_79B9);
        let far = target.depth_format.maximum();
        Picture { colour: (0..words).map(some).collect(), depth: (0..depths).map(|k| (some(k) & far) as i32).collect() }
    }
}

/// What the plain Z buffer makes of a scene.
#[derive(Debug)]
pub struct Reference {
    /// Memory afterwards.
    pub picture: Picture,
    /// Events of pixels.
    pub pixels: PixelCounts,
    /// Pixels that a colour was drawn to: a bit each, rows of `pitch` chunks of 16.
    pub won: Vec<u16>,
    /// Chunks of a row.
    pub pitch: usize,
}

/// Draws a scene item by item with the specification of the plain Z buffer.
pub fn reference(scene: &Scene) -> Reference {
    let Scene { target, held } = scene;
    let surface = target.colour;
    let [width, height] = [surface.width as usize, surface.height as usize];
    let before = Picture::before(target);
    let mut picture = before.clone();
    // Without a Z buffer depths start at the farthest.
    let depth_pitch = target.depth.map_or(width, |depth| depth.pitch as usize / 4);
    if target.depth.is_none() {
        picture.depth = vec![target.depth_format.maximum() as i32; width * height];
    }
    let mut pixels = PixelCounts::default();
    // Per pixel of the target: drawn to, and interpolated.
    let mut seen = vec![(false, false); width * height];
    let all = Rectangle { x: 0, y: 0, right: surface.width, bottom: surface.height };
    let setting = |draw: &HeldDraw| Setting {
        test: draw.test,
        format: target.depth_format,
        interpolation: draw.interpolation,
        shading: None,
        stencil: None,
        cuts_segments: false,
        scissor: draw.scissor,
        width: surface.width,
        pixel_format: surface.format,
        colour_pitch: surface.pitch as usize / 4,
        depth_pitch,
    };
    let fill = |picture: &mut Picture, area: &Rectangle, colour: Option<u32>, depth: Option<i32>| {
        for y in area.y as usize..area.bottom as usize {
            for x in area.x as usize..area.right as usize {
                if let Some(colour) = colour {
                    let stored = surface.format.encode(colour.to_le_bytes());
                    let row = &mut picture.colour[y * surface.pitch as usize / 4..];
                    match surface.format {
                        PixelFormat::Rgb565 => bytemuck::cast_slice_mut::<u32, u16>(row)[x] = stored as u16,
                        _ => row[x] = stored,
                    }
                }
                if let Some(depth) = depth {
                    picture.depth[y * depth_pitch + x] = depth;
                }
            }
        }
    };
    fill(&mut picture, &all, held.background.colour, held.background.depth);
    for item in &held.items {
        match item {
            Item::Primitive(shape, draw) => {
                let draw = &held.draws[*draw as usize];
                let setting = setting(draw);
                // On a transparent sheet, with depths of its own: where it passes.
                let mut sheet = vec![0; width * height];
                let on_sheet = Setting { pixel_format: PixelFormat::Argb8888, colour_pitch: width, ..setting.clone() };
                let mut depth = picture.depth.clone();
                let counts = specification::draw(&on_sheet, [(shape, 0)].into_iter(), &mut sheet, &mut depth);
                pixels.spans += counts.spans;
                for (pixel, seen) in sheet.iter().zip(&mut seen) {
                    if *pixel != 0 {
                        *seen = (true, draw.interpolation != Interpolation::Flat);
                    }
                }
                let one = [(shape, 0)].into_iter();
                let again = specification::draw(&setting, one, &mut picture.colour, &mut picture.depth);
                assert_eq!(again, counts);
            }
            Item::Clear { area, colour, depth, .. } => {
                fill(&mut picture, area, *colour, *depth);
                if colour.is_some() {
                    for y in area.y as usize..area.bottom as usize {
                        seen[y * width..][area.x as usize..area.right as usize].fill((true, false));
                    }
                }
            }
        }
    }
    if target.depth.is_none() {
        picture.depth.clear();
    }
    pixels.shaded = seen.iter().filter(|(_, interpolated)| *interpolated).count() as u64;
    let pitch = width.div_ceil(16);
    let mut won = vec![0; pitch * height];
    for (k, _) in seen.iter().enumerate().filter(|(_, (seen, _))| *seen) {
        won[k / width * pitch + k % width / 16] |= 1 << (k % width % 16);
    }
    Reference { picture, pixels, won, pitch }
}

/// Gives the functional model what geometry would, in two parts.
pub fn closed_form(scene: &Scene) -> Sorts {
    let mut parts = [Sorts::new(&scene.target), Sorts::new(&scene.target)];
    for (number, item) in scene.held.items.iter().enumerate() {
        let part = &mut parts[number % 2];
        match item {
            Item::Primitive(shape, draw) => {
                part.scissor(scene.held.draws[*draw as usize].scissor);
                match shape {
                    Shape::Triangle(triangle, v) => part.triangle(triangle, [0, 0], v, 0),
                    Shape::Line(line, v) => part.line(line, v, 0),
                    Shape::Point(point, v) => part.point(point, v, 0),
                }
            }
            Item::Clear { area, .. } => part.clear(*area),
        }
    }
    let [mut sum, other] = parts;
    sum.merge(&other);
    sum
}

/// The grid of a scene's target.
pub fn grid(scene: &Scene) -> Grid {
    Grid::new(&scene.target)
}
