//! The fast path against the specification: random draws on several tiles, every SIMD level, any number of shares.

use super::random::{Figure, figure, rectangle, state};
use super::*;
use crate::built::Called;
use crate::geometry::GeometryRegisters;
use crate::geometry::assembly::Sink;
use crate::geometry::transform::Transform;
use crate::hidden::z_buffer::band::{DrawShading, Scratch};
use crate::hidden::z_buffer::bins::{BinSink, Bins};
use crate::hidden::z_buffer::tile::TILE;
use crate::shading::parameters::{ParameterTransform, VertexParameters};
use crate::shading::pixel::{PixelShading, Textured};
use crate::texture::Texture;
use crate::texture::tests::{noise, plain};
use fearless_simd::Level;
use proptest::prelude::*;
use proptest::sample::select;
use std::sync::Arc;
use zga_abi::Effects;
use zga_abi::format::Topology;

/// Every SIMD level that this host can run, the widest first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let others =
        [best.as_avx2().map(Level::Avx2), best.as_sse4_2().map(Level::Sse4_2), best.as_sse2().map(Level::Sse2)];
    #[cfg(not(target_arch = "x86_64"))]
    let others: [Option<Level>; 0] = [];
    std::iter::once(best).chain(others.into_iter().flatten()).collect()
}

/// Puts a primitive into bins.
fn bin(shape: &Shape, number: u32, bins: &mut Bins, pixels: &Setting) {
    let (mut bins, format) = (BinSink::any(bins, pixels.shading.is_some()), pixels.format);
    match shape {
        Shape::Triangle(_, v) => {
            let (triangle, columns) = Triangle::new(v, format).expect("it was one before");
            bins.triangle(&triangle, columns, v, number);
        }
        Shape::Line(line, v) => bins.line(line, v, number),
        Shape::Point(point, v) => bins.point(point, v, number),
    }
}

/// Draws primitives of one kind band by band, as the pipeline does, in `shares` shares.
fn fast_draw(draw: &ZaDraw, level: Level, shares: usize, shapes: &[Shape], memory: &mut Memory) -> ZaCounts {
    let [width, height] = draw.grid.size;
    let each = shapes.len().div_ceil(shares).max(1);
    let mut bins: Vec<Bins> = Vec::new();
    for share in 0..shares {
        let mut share_bins = Bins::default();
        share_bins.reset(width, height, draw.pixels.scissor);
        shapes.iter().zip(0..).skip(share * each).take(each).for_each(|(shape, number)| {
            bin(shape, number, &mut share_bins, &draw.pixels);
        });
        bins.push(share_bins);
    }
    let mut scratch = Scratch::default();
    let mut total = ZaCounts::default();
    let words = TILE / draw.grid.block[1] as usize * draw.grid.across();
    for band in 0..(height as usize).div_ceil(TILE) {
        let colour = &mut memory.colour[band * TILE * draw.pixels.colour_pitch..];
        let depth = memory.depth.get_mut(band * TILE * draw.pixels.depth_pitch..).unwrap_or_default();
        let words = &mut memory.words[band * words..];
        total = total.plus(draw.draw_band(level, &bins, band, colour, depth, words, &mut scratch));
    }
    total
}

/// Primitives of one kind, three times as large and far apart as those of small pictures.
fn figures() -> impl Strategy<Value = Vec<Figure>> {
    let scale = |v: ScreenVertex| ScreenVertex { x: 3 * v.x, y: 3 * v.y, ..v };
    let guarded = |v: &ScreenVertex| v.x.abs().max(v.y.abs()) < 1 << 21;
    let larger = move |figure: Figure| match figure {
        Figure::Triangle(v) if v.iter().all(guarded) => Figure::Triangle(v.map(scale)),
        Figure::Line(v) if v.iter().all(guarded) => Figure::Line(v.map(scale)),
        Figure::Point(v) => Figure::Point(scale(v)),
        far => far,
    };
    // One of a kind decides for all of them.
    let kind = |figure: &Figure| std::mem::discriminant(figure);
    proptest::collection::vec((figure(), any::<bool>()), 1..24).prop_map(move |figures| {
        let first = kind(&figures[0].0);
        let same = figures.into_iter().filter(|(figure, _)| kind(figure) == first);
        same.map(|(figure, large)| if large { larger(figure) } else { figure }).collect()
    })
}

/// A frame of some tiles with blocks that divide them.
fn fast_frame() -> impl Strategy<Value = Frame> {
    let size = || select(vec![1_u32, 2, 4, 8, 16, 32, 64]);
    let block = prop_oneof![
        3 => Just([32, 1]),
        2 => select(vec![[16, 2], [8, 4], [8, 8], [64, 64]]),
        3 => [size(), size()],
    ];
    let depth_format = (select(vec![16_u32, 24, 31]), select(vec![0_u32, 8, 16, 24]))
        .prop_map(|(bits, fraction)| DepthFormat::new(bits, fraction).unwrap());
    let side = || prop_oneof![1_u32..230, select(vec![64_u32, 128, 192])];
    (side(), 1_u32..150, block, select(PixelFormat::ALL), depth_format, proptest::bool::weighted(0.85)).prop_map(
        |(width, height, block, pixel_format, depth_format, depth_buffer)| {
            frame([width, height], block, pixel_format, depth_format, depth_buffer)
        },
    )
}

/// Memory before the first draw: all blocks cleared, or none, or those that `seed` says.
fn before(frame: &Frame, seed: u32, cleared: u8) -> Memory {
    let mut memory = Memory::poisoned(frame, seed);
    if cleared != 0 {
        memory.depth.iter_mut().for_each(|z| *z &= frame.depth_format.maximum() as i32);
        let all = 0..memory.words.len();
        let _ = frame.derive(all, false, &mut memory.surfaces());
    }
    if cleared == 2 {
        for (index, word) in memory.words.iter_mut().enumerate() {
            if (index as u32 ^ seed).wrapping_mul(0x9E37_79B9) >> 30 == 0 {
                *word = -1 - index as i32;
            }
        }
    }
    memory
}

/// A texture of which about half are holes, in runs of some pixels, over each of the primitives.
fn punched(shapes: &[Shape], seed: u64, frame: &Frame) -> Arc<DrawShading> {
    let size = [16, 8];
    let texels = noise(size[0] as usize * size[1] as usize, seed);
    let texture = Texture::decode(&texels, &plain(size));
    let topology = match shapes.first() {
        Some(Shape::Line(..)) => Topology::Lines,
        Some(Shape::Point(..)) => Topology::Points,
        _ => Topology::Triangles,
    };
    let one: [[f64; 4]; 4] = std::array::from_fn(|r| std::array::from_fn(|c| f64::from(u8::from(r == c))));
    let transform = ParameterTransform {
        screen: Transform::new(&GeometryRegisters::IDENTITY, Effects::empty(), frame.grid.size, frame.depth_format, 8),
        eye: one,
        normal: std::array::from_fn(|r| std::array::from_fn(|c| one[r][c])),
        perspective: false,
        topology,
    };
    let vertex = |v: &ScreenVertex, coordinates: [f32; 2]| VertexParameters {
        position: [v.x as f32 / 256.0, v.y as f32 / 256.0, 0.0],
        coordinates,
        ..VertexParameters::default()
    };
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]];
    let vertices = shapes.iter().map(|shape| {
        let v = match shape {
            Shape::Triangle(_, v) => *v,
            Shape::Line(_, v) => [v[0], v[1], v[1]],
            Shape::Point(_, v) => [*v; 3],
        };
        [0, 1, 2].map(|k| vertex(&v[k], corners[k]))
    });
    let textured = Called::new(|| Textured { texture: Arc::new(texture), punch_through: Called::new(|| 128) });
    let pixel = Arc::new(PixelShading { transform, light: None, texture: textured, fog: None });
    Arc::new(DrawShading { pixel, first: 0, vertices: vertices.collect() })
}

/// Draws, one after another, by the specification and at every level; all must be equal after each.
fn check(
    frame: &Frame,
    background: Background,
    mut memory: Memory,
    draws: &[(State, Vec<Figure>)],
    shares: usize,
    holes: Option<u64>,
) -> Result<(), TestCaseError> {
    for (state, figures) in draws {
        let shapes: Vec<Shape> = figures.iter().filter_map(|figure| figure.shape(frame.depth_format)).collect();
        let mut draw = za_draw(frame, background, state);
        draw.pixels.shading = holes.map(|seed| punched(&shapes, seed, frame));
        prop_assert!(draw.fast());
        let begun = memory.clone();
        let counts = specification::draw(&draw, shapes.iter().zip(0..), &mut memory.surfaces());
        for level in levels() {
            let mut fast = begun.clone();
            let fast_counts = fast_draw(&draw, level, shares, &shapes, &mut fast);
            prop_assert_eq!(fast_counts, counts, "{:?}, {:?}", level, state);
            prop_assert!(fast.words == memory.words, "words, {:?}, {:?}", level, state);
            prop_assert!(fast.depth == memory.depth, "depths, {:?}, {:?}", level, state);
            prop_assert!(fast.colour == memory.colour, "colours, {:?}, {:?}", level, state);
        }
    }
    Ok(())
}

fn scene() -> impl Strategy<Value = (Frame, Vec<(State, Vec<Figure>)>)> {
    fast_frame().prop_flat_map(|frame| {
        let draw = (state(frame.grid.size, frame.depth_pitch.is_some()), figures());
        (Just(frame), proptest::collection::vec(draw, 1..5))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, ..ProptestConfig::default() })]
    #[test]
    fn fast_random_draws_equal_the_specification(
        (frame, draws) in scene(),
        seed: u32,
        cleared in 0_u8..3,
        shares in 1_usize..4,
        share_of_range in select(vec![0_u32, 0x9000, 0xFFFF]),
    ) {
        let depth = (u64::from(share_of_range) * u64::from(frame.depth_format.maximum()) / 0xFFFF) as i32;
        let background = Background { pixel: 0x1234_5678 & if frame.pixel_format == PixelFormat::Rgb565 { 0xFFFF } else { u32::MAX }, depth };
        check(&frame, background, before(&frame, seed, cleared), &draws, shares, None)?;
    }

    #[test]
    fn fast_random_draws_with_holes_equal_the_specification(
        (frame, draws) in scene(),
        seed: u32,
        cleared in 0_u8..3,
        shares in 1_usize..4,
    ) {
        let background = Background { pixel: 0x1234, depth: frame.depth_format.maximum() as i32 };
        check(&frame, background, before(&frame, seed, cleared), &draws, shares, Some(u64::from(seed)))?;
    }

    #[test]
    fn fast_dense_lines_and_points_equal_the_specification(
        size in [1_u32..20, 1_u32..20],
        shift in [0_u32..4, 0_u32..3],
        ends in proptest::collection::vec([[-256_i32..5000, -256..5000, 0..0x10000], [-256_i32..5000, -256..5000, 0..0x10000]], 1..80),
        lines: bool,
        function in select(DepthFunction::ALL),
        prediction in select(ZaPrediction::ALL),
    ) {
        let vertex = |[x, y, z]: [i32; 3]| ScreenVertex { x, y, z: z as u32, colour: z as u32, reciprocal_w: 1.0 };
        let figure = |ends: [[i32; 3]; 2]| {
            if lines { Figure::Line(ends.map(vertex)) } else { Figure::Point(vertex(ends[0])) }
        };
        let figures: Vec<Figure> = ends.into_iter().map(figure).collect();
        let frame = frame(size, shift.map(|s| 1 << s), PixelFormat::Xrgb8888, DepthFormat::default(), true);
        let state = State {
            function: Some(function),
            write: true,
            interpolation: Interpolation::Flat,
            scissor: frame.grid.all(),
            prediction,
            bypass: true,
        };
        let background = Background { pixel: 0x4321, depth: frame.depth_format.maximum() as i32 };
        check(&frame, background, before(&frame, 3, 0), &[(state, figures)], 1, None)?;
    }

    #[test]
    fn fast_whole_layers_equal_the_specification(
        frame in fast_frame(),
        layers in proptest::collection::vec((prop_oneof![0_u32..=0xFFFF, 40_000_u32..40_004], 0_u32..3000, 0_u32..3000, any::<bool>()), 1..12),
        order in 0_u8..3,
        function in select(vec![DepthFunction::Less, DepthFunction::LessEqual, DepthFunction::Always, DepthFunction::Greater]),
        write in proptest::bool::weighted(0.9),
        prediction in select(ZaPrediction::ALL),
        scissor in rectangle([230, 150]),
        cleared in 0_u8..3,
    ) {
        let [width, height] = frame.grid.size;
        let scissor = Rectangle {
            x: scissor.x.min(width),
            y: scissor.y.min(height),
            right: if scissor.right == 230 { width } else { scissor.right.min(width) },
            bottom: if scissor.bottom == 150 { height } else { scissor.bottom.min(height) },
        };
        let mut layers = layers;
        layers.sort_unstable_by_key(|layer| match order {
            0 => layer.0,
            1 => 0xFFFF - layer.0,
            _ => 0,
        });
        let mut figures = Vec::new();
        for (z, dx, dy, one) in layers {
            let (right, bottom) = (256 * width as i32, 256 * height as i32);
            let flat = dx % 2 == 0;
            let corner = |x: i32, y: i32, more: u32| ScreenVertex {
                x,
                y,
                z: if flat { z } else { (z + more).min(0xFFFF) },
                colour: z ^ more,
                reciprocal_w: 1.0,
            };
            if one {
                figures.push(Figure::Triangle([
                    corner(-256, -256, 0),
                    corner(2 * right + 512, -256, dx),
                    corner(-256, 2 * bottom + 512, dy),
                ]));
            } else {
                let ends = [corner(0, 0, 0), corner(right, bottom, dx)];
                figures.push(Figure::Triangle([ends[0], corner(right, 0, dy), ends[1]]));
                figures.push(Figure::Triangle([ends[0], ends[1], corner(0, bottom, dy)]));
            }
        }
        let state = State {
            function: frame.depth_pitch.is_some().then_some(function),
            write,
            interpolation: Interpolation::Flat,
            scissor,
            prediction,
            bypass: true,
        };
        let background = Background { pixel: 0x4321, depth: frame.depth_format.maximum() as i32 };
        check(&frame, background, before(&frame, 7, cleared), &[(state, figures)], 2, None)?;
    }
}

#[test]
fn fast_shape_that_does_not_divide_a_host_tile_is_refused() {
    let all = Rectangle { x: 0, y: 0, right: 100, bottom: 100 };
    let state = State {
        function: None,
        write: true,
        interpolation: Interpolation::Flat,
        scissor: all,
        prediction: ZaPrediction::Plane,
        bypass: true,
    };
    let background = Background { pixel: 0, depth: 0 };
    for block in [[33, 1], [128, 1], [1, 128], [5, 3]] {
        let frame = frame([100, 100], block, PixelFormat::Xrgb8888, DepthFormat::default(), true);
        assert!(!za_draw(&frame, background, &state).fast(), "{block:?}");
    }
}
