//! Random scenes: every model against the plain Z buffer, primitive by primitive.

use super::*;
use proptest::prelude::*;
use proptest::sample::select;

/// What happens in a scene.
#[derive(Clone, Debug)]
enum Step {
    /// Primitives with one state.
    Draw(State, Vec<Figure>),
    /// A clear of a rectangle: colour, depth.
    Clear(Rectangle, Option<u32>, Option<u32>),
    /// A logical clear of the frame.
    ClearAll(u32, u32),
    /// Cleared blocks in a rectangle are brought to memory.
    Settle(Rectangle),
}

/// A primitive before its set-up; depths are shares of the range in 2^-16.
#[derive(Clone, Copy, Debug)]
pub(super) enum Figure {
    Triangle([ScreenVertex; 3]),
    Line([ScreenVertex; 2]),
    Point(ScreenVertex),
}

impl Figure {
    /// The primitive, if it draws something.
    pub(super) fn shape(self, format: DepthFormat) -> Option<Shape> {
        let depth =
            |v: ScreenVertex| ScreenVertex { z: (u64::from(v.z) * u64::from(format.maximum()) / 0xFFFF) as u32, ..v };
        match self {
            Figure::Triangle(v) => triangle(v.map(depth), format),
            Figure::Line(v) => line(v.map(depth), format),
            Figure::Point(v) => Some(point(depth(v))),
        }
    }
}

/// Depths: anything, or one of few, so that ties are common.
fn depth() -> impl Strategy<Value = u32> {
    prop_oneof![3 => 0_u32..=0xFFFF, 3 => select(vec![0_u32, 0x2000, 0x8000, 0x8001, 0xFFFE, 0xFFFF])]
}

fn vertex(x: std::ops::Range<i32>, y: std::ops::Range<i32>) -> impl Strategy<Value = ScreenVertex> {
    (x, y, depth(), any::<u32>(), select(vec![1.0_f32, 0.5, 0.01]))
        .prop_map(|(x, y, z, colour, reciprocal_w)| ScreenVertex { x, y, z, colour, reciprocal_w })
}

/// A vertex on the screen or a little off it.
fn near() -> impl Strategy<Value = ScreenVertex> {
    vertex(-2560..20_000, -2560..13_000)
}

/// A vertex anywhere in the guard band.
fn far() -> impl Strategy<Value = ScreenVertex> {
    vertex(-(1 << 23)..1 << 23, -(1 << 23)..1 << 23)
}

pub(super) fn figure() -> impl Strategy<Value = Figure> {
    let offset = || [-700_i32..=700, -700_i32..=700];
    let at = |v: ScreenVertex, [dx, dy]: [i32; 2], z: u32| ScreenVertex { x: v.x + dx, y: v.y + dy, z, ..v };
    prop_oneof![
        3 => [near(), near(), near()].prop_map(Figure::Triangle),
        1 => [far(), far(), far()].prop_map(Figure::Triangle),
        // Small ones are steep.
        2 => (near(), offset(), offset(), depth(), depth())
            .prop_map(move |(v, a, b, p, q)| Figure::Triangle([v, at(v, a, p), at(v, b, q)])),
        // Slivers: the third vertex lies beside the first side.
        2 => (near(), near(), 0..=256_i32, -90..=90_i32, -90..=90_i32, depth()).prop_map(|(a, b, t, dx, dy, z)| {
            let mix = |a: i32, b: i32| a + (b - a) * t / 256;
            Figure::Triangle([a, b, ScreenVertex { x: mix(a.x, b.x) + dx, y: mix(a.y, b.y) + dy, z, ..a }])
        }),
        // Two whole rows and columns: blocks that are covered wholly.
        1 => (near(), depth()).prop_map(|(v, z)| {
            let corner = |x: i32, y: i32, z: u32| ScreenVertex { x, y, z, ..v };
            Figure::Triangle([corner(-256, -256, v.z), corner(60_000, -256, z), corner(-256, 60_000, v.z)])
        }),
        2 => [near(), near()].prop_map(Figure::Line),
        1 => (far(), near()).prop_map(|(a, b)| Figure::Line([a, b])),
        1 => near().prop_map(Figure::Point),
    ]
}

pub(super) fn rectangle(size: [u32; 2]) -> impl Strategy<Value = Rectangle> {
    let [width, height] = size;
    let any = (0..=width, 0..=height, 0..=width, 0..=height).prop_map(|(a, b, c, d)| Rectangle {
        x: a.min(c),
        y: b.min(d),
        right: a.max(c),
        bottom: b.max(d),
    });
    prop_oneof![2 => Just(Rectangle { x: 0, y: 0, right: width, bottom: height }), 1 => any]
}

pub(super) fn state(size: [u32; 2], depth_buffer: bool) -> impl Strategy<Value = State> {
    let function = if depth_buffer {
        prop_oneof![
            4 => Just(Some(DepthFunction::Less)),
            4 => select(DepthFunction::ALL).prop_map(Some),
            1 => Just(None),
        ]
        .boxed()
    } else {
        Just(None).boxed()
    };
    (
        function,
        proptest::bool::weighted(0.8),
        select(vec![Interpolation::Flat, Interpolation::Affine, Interpolation::Perspective]),
        rectangle(size),
        select(ZaPrediction::ALL),
        proptest::bool::weighted(0.9),
    )
        .prop_map(|(function, write, interpolation, scissor, prediction, bypass)| State {
            function,
            write,
            interpolation,
            scissor,
            prediction,
            bypass,
        })
}

fn step(size: [u32; 2], depth_buffer: bool) -> impl Strategy<Value = Step> {
    // Few values, so that clears to the background itself happen.
    let pixel = || select(vec![0x1234_5678_u32, 0x8765_4321]);
    let z = || select(vec![0_u32, 0x9000, 0xFFFF]);
    let plane = |clears: bool| proptest::bool::weighted(if clears { 0.8 } else { 0.5 });
    prop_oneof![
        6 => (state(size, depth_buffer), proptest::collection::vec(figure(), 1..5)).prop_map(|(s, f)| Step::Draw(s, f)),
        2 => (rectangle(size), pixel(), z(), plane(true), plane(depth_buffer)).prop_map(|(area, pixel, z, c, d)| {
            Step::Clear(area, c.then_some(pixel), d.then_some(z))
        }),
        1 => (pixel(), z()).prop_map(|(pixel, z)| Step::ClearAll(pixel, z)),
        1 => rectangle(size).prop_map(Step::Settle),
    ]
}

/// A frame, and what happens on it.
fn scene() -> impl Strategy<Value = (Frame, bool, u32, Vec<Step>)> {
    let blocks = select(vec![
        [32_u32, 1],
        [33, 1],
        [5, 3],
        [8, 8],
        [16, 2],
        [8, 4],
        [1, 1],
        [1, 7],
        [100, 1],
        [64, 64],
        [16_384, 16_384],
        [3, 16_384],
    ]);
    let depth_format = (select(vec![16_u32, 24, 31]), select(vec![0_u32, 8, 16, 24]))
        .prop_map(|(bits, fraction)| DepthFormat::new(bits, fraction).unwrap());
    (1_u32..75, 1_u32..50, blocks, select(PixelFormat::ALL), depth_format, proptest::bool::weighted(0.85))
        .prop_flat_map(|(width, height, block, pixel_format, depth_format, depth_buffer)| {
            let frame = frame([width, height], block, pixel_format, depth_format, depth_buffer);
            let steps = proptest::collection::vec(step([width, height], depth_buffer), 1..7);
            (Just(frame), any::<bool>(), any::<u32>(), steps)
        })
}

/// A Z buffer that holds depths.
fn with_depths(frame: &Frame, memory: &Memory) -> Memory {
    let depth = memory.depth.iter().map(|z| z & frame.depth_format.maximum() as i32).collect();
    Memory { depth, ..memory.clone() }
}

fn fill(frame: &Frame, area: &Rectangle, pixel: Option<u32>, depth: Option<i32>, memory: &mut Memory) {
    for y in area.y as usize..area.bottom as usize {
        for x in area.x as usize..area.right as usize {
            if let Some(pixel) = pixel {
                let setting = (frame.pixel_format, frame.colour_pitch);
                crate::hidden::za::memory::put(&mut memory.colour, setting.0, setting.1, x, y, pixel);
            }
            if let (Some(depth), Some(pitch)) = (depth, frame.depth_pitch) {
                memory.depth[y * pitch + x] = depth;
            }
        }
    }
}

/// Runs a scene on the plain Z buffer, the specification and the clocked unit.
fn check(frame: &Frame, cleared: bool, seed: u32, steps: &[Step]) -> Result<(), TestCaseError> {
    let far = frame.depth_format.maximum();
    let stored = |z: u32| (u64::from(z) * u64::from(far) / 0xFFFF) as i32;
    let pixel_of = |pixel: u32| if frame.pixel_format == PixelFormat::Rgb565 { pixel & 0xFFFF } else { pixel };
    let mut background = Background { pixel: pixel_of(0x1234_5678), depth: stored(0x9000) };
    let mut za = Memory::poisoned(frame, seed);
    let mut plain = za.clone();
    let mut known = cleared;
    if cleared {
        fill(frame, &frame.grid.all(), Some(background.pixel), Some(background.depth), &mut plain);
    } else {
        za = with_depths(frame, &za);
        let _ = frame.derive(0..za.words.len(), false, &mut za.surfaces());
        plain = za.clone();
    }
    let mut clocked = za.clone();
    for step in steps {
        match step {
            Step::Draw(state, figures) => {
                let draw = za_draw(frame, background, state);
                for shape in figures.iter().filter_map(|figure| figure.shape(frame.depth_format)) {
                    let plain_counts = z_buffer_draw(&draw, &shape, &mut plain);
                    let counts = specification_draw(&draw, &shape, &mut za);
                    prop_assert_eq!(counts, clocked_draw(&draw, &shape, &mut clocked));
                    prop_assert_eq!((counts.spans, counts.passed), (plain_counts.spans, plain_counts.passed));
                    prop_assert!(counts.bypassed == 0 || draw.may_bypass());
                    prop_assert_eq!(wrong_words(frame, &za), vec![]);
                    prop_assert_eq!(&za, &clocked);
                }
            }
            Step::Clear(area, pixel, depth) => {
                let (pixel, depth) = (pixel.map(pixel_of), depth.map(stored));
                fill(frame, area, pixel, depth, &mut plain);
                let registers = known.then_some(&background);
                let counts = frame.clear_rectangle(area, pixel, depth, registers, &mut za.surfaces());
                prop_assert_eq!(wrong_words(frame, &za), vec![]);
                prop_assert!(counts.clocks > 0 || za == clocked);
                clocked = za.clone();
            }
            Step::ClearAll(pixel, depth) => {
                background = Background { pixel: pixel_of(*pixel), depth: stored(*depth) };
                known = true;
                fill(frame, &frame.grid.all(), Some(background.pixel), Some(background.depth), &mut plain);
                let _ = crate::hidden::za::memory::clear_logically(&mut za.words);
                clocked = za.clone();
            }
            Step::Settle(area) => {
                let colour_only = frame.settle(&background, Some(area), Settle::Colour, &mut za.surfaces());
                let counts = frame.settle(&background, Some(area), Settle::All, &mut za.surfaces());
                prop_assert_eq!(counts.settled, colour_only.settled);
                prop_assert_eq!(wrong_words(frame, &za), vec![]);
                clocked = za.clone();
            }
        }
    }
    let mut settled = za.settled(frame, &background);
    for index in 0..settled.words.len() {
        let area = frame.grid.area(index);
        for y in area.y as usize..area.bottom as usize {
            for x in area.x as usize..area.right as usize {
                prop_assert_eq!(pixel(frame, &settled, x, y), pixel(frame, &plain, x, y), "pixel {} {}", x, y);
            }
        }
    }
    let mut derived = settled.clone();
    let _ = frame.derive(0..derived.words.len(), true, &mut derived.surfaces());
    prop_assert_eq!(&derived, &settled);
    // Nothing was written beside the picture.
    fill(frame, &frame.grid.all(), Some(0), Some(0), &mut settled);
    fill(frame, &frame.grid.all(), Some(0), Some(0), &mut plain);
    prop_assert_eq!((settled.colour, settled.depth), (plain.colour, plain.depth));
    Ok(())
}

/// A pixel's colour as stored, and its depth.
fn pixel(frame: &Frame, memory: &Memory, x: usize, y: usize) -> (u32, Option<i32>) {
    let colour = match frame.pixel_format {
        PixelFormat::Rgb565 => (memory.colour[y * frame.colour_pitch + x / 2] >> (16 * (x % 2))) & 0xFFFF,
        PixelFormat::Xrgb8888 | PixelFormat::Argb8888 => memory.colour[y * frame.colour_pitch + x],
    };
    (colour, frame.depth_pitch.map(|pitch| memory.depth[y * pitch + x]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn random_scene_equals_the_plain_z_buffer((frame, cleared, seed, steps) in scene()) {
        check(&frame, cleared, seed, &steps)?;
    }

    #[test]
    fn random_triangles_bypass_more_with_tighter_predictions(
        figures in proptest::collection::vec(figure(), 8..30),
        block in select(vec![[32_u32, 1], [8, 8], [16, 2], [5, 3]]),
    ) {
        let frame = frame([70, 50], block, PixelFormat::Xrgb8888, DepthFormat::default(), true);
        let background = Background { pixel: 0, depth: DepthFormat::default().maximum() as i32 };
        let mut pixels = Vec::new();
        for &prediction in ZaPrediction::ALL {
            let state = State {
                function: Some(DepthFunction::Less),
                write: true,
                interpolation: Interpolation::Flat,
                scissor: frame.grid.all(),
                prediction,
                bypass: true,
            };
            let draw = za_draw(&frame, background, &state);
            let mut memory = Memory::poisoned(&frame, 0);
            let shapes: Vec<_> = figures.iter().filter_map(|figure| figure.shape(frame.depth_format)).collect();
            let counts = specification::draw(&draw, shapes.iter().zip(0..), &mut memory.surfaces());
            pixels.push((counts.bypassed, counts.pixels_bypassed, memory));
        }
        prop_assert!(pixels[0].0 <= pixels[1].0 && pixels[1].0 <= pixels[2].0);
        prop_assert!(pixels[0].1 <= pixels[1].1 && pixels[1].1 <= pixels[2].1);
        prop_assert_eq!(&pixels[0].2, &pixels[1].2);
        prop_assert_eq!(&pixels[0].2, &pixels[2].2);
    }
}
