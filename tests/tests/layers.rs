//! Translucent layers without a sub-pixel grid, at the level of registers: one picture and one count on every path, in
//! both fidelities, with every kernel, number of threads, tile size and way of cutting draws into packets; and that
//! picture is what a model of a few lines says by definition.
//!
//! The model knows rectangles of one depth and one colour, whose pixels need no geometry. Slanted triangles, lines and
//! points are compared from path to path, and by the unit's own tests with its specification.
//!
//! Where there is a stencil plane, draws test it and those that do not blend change it; layers are tested against it as
//! the opaque picture left it, after the shadow bit has darkened that.

use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, TestCaseError};
use std::time::Duration;
use zga_abi::Bus;
use zga_device::{Card, CardBus, CardOptions, Kernel};
use zga_tests::harness::options::shadow_words;
use zga_tests::harness::{Hidden, State as Sheet, packet};
use zga_tests::oracle::DepthFunction;
use zga_tests::oracle::stencil::{Operation, Shadow, Stencil};
use zga_tests::script::any::sometimes;

/// Bytes: frame buffer, Z buffer, what comes back, stencil plane.
const PLACES: [u32; 4] = [0x1_0000, 0x4_0000, 0x8_0000, 0xC_0000];
/// The greatest depth.
const FARTHEST: u32 = 0x00FF_FFFF;
/// Colour of the frame before the scene, as it is stored, and the depth.
const BEFORE: (u32, u32) = (0x3F5A_C0DE, 0x0080_0000);
/// BLEND_CONTROL.
const BLEND_CONTROL: u32 = 0x0324;
/// Counters of blending: clocks, fragments tested, blended, pixels sorted.
const COUNTERS: [u32; 4] = [54, 61, 62, 63];
/// Counters of how packets came: clocks in all, of the front end, packets, words, fences.
const PACKETS: [u32; 5] = [0, 1, 7, 8, 9];

/// How something is drawn.
#[derive(Clone, Copy, Debug)]
struct State {
    /// Number of the depth function; `None` does not call for depth.
    function: Option<u32>,
    write: bool,
    gouraud: bool,
    /// Number of the mode; `None` does not call for blending.
    mode: Option<u32>,
    /// Stencil test.
    stencil: Option<Stencil>,
}

#[derive(Clone, Debug)]
enum Command {
    /// Left, top, right, bottom; a depth of 0..=15; RGBA.
    Rectangle { area: [u32; 4], depth: u32, colour: u32, state: State },
    /// Topology, and vertices x, y (1/16 pixels), depth, colour.
    Any { topology: u32, vertices: Vec<(i32, i32, u32, u32)>, state: State },
    /// RGBA, nearest (or farthest) depth, stencil value, area.
    Clear { colour: Option<u32>, nearest: Option<bool>, stencil: Option<u8>, area: Option<[u32; 4]> },
}

#[derive(Clone, Debug)]
struct Scene {
    size: [u32; 2],
    /// Number of the format: XRGB, ARGB, RGB565.
    format: u32,
    /// There is a stencil plane.
    plane: bool,
    /// What END_SCENE darkens if a draw has tested it.
    shadow: Option<Shadow>,
    commands: Vec<Command>,
}

#[derive(Clone, Debug)]
struct Way {
    hidden: Hidden,
    depth_buffer: bool,
    kernel: Kernel,
    threads: usize,
    /// Primitives of a packet.
    piece: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Outcome {
    /// As they are stored.
    pixels: Vec<u32>,
    depths: Option<Vec<u32>>,
    counters: [u64; 4],
    /// All counters but those of how the packets came.
    events: Vec<u64>,
}

/// A depth of 0..=15 as vertices have it: between the two of clears.
fn z(depth: u32) -> f32 {
    (depth + 1) as f32 / 32.0
}

/// Words of a vertex.
fn vertex(x: f32, y: f32, depth: u32, colour: u32) -> [u32; 4] {
    [x.to_bits(), y.to_bits(), z(depth).to_bits(), colour]
}

/// Draws a scene on a new card.
fn run(scene: &Scene, way: &Way) -> Outcome {
    let [width, height] = scene.size;
    let bytes = if scene.format == 2 { 2 } else { 4 };
    let pitches = [width * bytes, width * 4].map(|pitch| pitch.next_multiple_of(64));
    let Way { hidden, kernel, threads, .. } = *way;
    let card = Card::power_on(CardOptions { video_memory: 1 << 20, za_ram: 1 << 16, threads, kernel });
    let card = card.expect("the card has power");
    let mut bus = card.bus();
    bus.write32(packet::INTERRUPT_ENABLE, packet::INTERRUPT_FENCE);
    let depth_pitch = if way.depth_buffer { pitches[1] } else { 0 };
    let target = [height << 16 | width, PLACES[0], pitches[0], scene.format, PLACES[1], depth_pitch, 24 | 24 << 8];
    let mut stream = vec![
        packet::registers(packet::TARGET, &target),
        packet::registers(packet::PATH, &hidden.words(8)),
        packet::registers(packet::STENCIL_PLANE, &[PLACES[3], if scene.plane { 128 } else { 0 }]),
        packet::fill(PLACES[0], pitches[0], 0, [0, 0, pitches[0] / 4, height], BEFORE.0),
        packet::fill(PLACES[1], pitches[1], 0, [0, 0, width, height], BEFORE.1),
    ];
    let identity = |k: usize| f32::from(u8::from(k.is_multiple_of(5))).to_bits();
    let matrices: Vec<u32> = (0..48).map(|k| identity(k % 16)).collect();
    let viewport = [1.0_f32, 1.0, 1.0, 0.0, 0.0, 0.0].map(f32::to_bits);
    stream.push(packet::registers(packet::GEOMETRY, &[&matrices[..], &viewport].concat()));
    stream.push(packet::begin_scene());
    for command in &scene.commands {
        packets(command, way, &mut stream);
    }
    stream.push(packet::registers(packet::SHADOW, &shadow_words(scene.shadow.as_ref())));
    stream.push(packet::end_scene());
    send(&mut bus, &stream.concat(), 1);
    let mut counter = |index: u32| {
        let at = packet::COUNTERS + 8 * index;
        u64::from(bus.read32(at)) | u64::from(bus.read32(at + 4)) << 32
    };
    let counters = COUNTERS.map(&mut counter);
    let events = (0..69).filter(|index| !PACKETS.contains(index)).map(&mut counter).collect();
    // Through the bitmap unit: what is cleared in Za RAM only comes to memory.
    let mut fetch = |at: u32, pitch: u32, words: u32, sequence: u32| {
        send(&mut bus, &packet::download(at, pitch, words, height, PLACES[2]), sequence);
        let mut found = vec![0; (words * height) as usize];
        bus.read_burst(packet::MEMORY + PLACES[2], &mut found);
        found
    };
    let words = fetch(PLACES[0], pitches[0], (width * bytes).div_ceil(4), 2);
    let pixels = match bytes {
        4 => words,
        _ => words.chunks(width.div_ceil(2) as usize).flat_map(|row| halves(row, width as usize)).collect(),
    };
    let depths = way.depth_buffer.then(|| fetch(PLACES[1], pitches[1], width, 3));
    Outcome { pixels, depths, counters, events }
}

fn halves(row: &[u32], width: usize) -> Vec<u32> {
    row.iter().flat_map(|word| [word & 0xFFFF, word >> 16]).take(width).collect()
}

/// Sends packets through the FIFO and waits for their end.
fn send(bus: &mut CardBus, words: &[u32], sequence: u32) {
    bus.write_burst(packet::FIFO, &[words, &packet::fence(sequence)].concat());
    while bus.read32(packet::FENCE_SEQUENCE) != sequence {
        let raised = bus.wait_interrupt(packet::INTERRUPT_FENCE, Duration::from_secs(60));
        bus.write32(packet::INTERRUPT_STATUS, packet::INTERRUPT_FENCE);
        assert!(raised != 0 && bus.read32(packet::ERROR_CODE) == 0, "the card stands still");
    }
}

fn packets(command: &Command, way: &Way, stream: &mut Vec<Vec<u32>>) {
    let scissor = |[left, top, right, bottom]: [u32; 4]| [top << 16 | left, bottom << 16 | right];
    let everywhere = [0, 0, 0x7FFF, 0x7FFF];
    let (topology, vertices, state) = match command {
        Command::Clear { colour, nearest, stencil, area } => {
            let [first, last] = scissor(area.unwrap_or(everywhere));
            stream.push(packet::registers(packet::DRAW_STATE + 16, &[first, last]));
            let depth = nearest.map(|nearest| if nearest { 0 } else { FARTHEST });
            stream.push(packet::clear_with_stencil(*colour, depth, *stencil));
            return;
        }
        Command::Rectangle { area, depth, colour, state } => {
            let [left, top, right, bottom] = area.map(|side| side as f32);
            let corners = [(left, top), (right, top), (left, bottom), (right, top), (right, bottom), (left, bottom)];
            (0, corners.map(|(x, y)| vertex(x, y, *depth, *colour)).to_vec(), state)
        }
        Command::Any { topology, vertices, state } => {
            let place = |c: i32| c as f32 / 16.0;
            let words = vertices.iter().map(|&(x, y, depth, colour)| vertex(place(x), place(y), depth, colour));
            (*topology, words.collect(), state)
        }
    };
    let bit = |on: bool, mask: u32| if on { mask } else { 0 };
    let effects = bit(state.function.is_some(), packet::EFFECT_DEPTH)
        | bit(state.gouraud, packet::EFFECT_GOURAUD)
        | bit(state.mode.is_some(), packet::EFFECT_BLEND)
        | bit(state.stencil.is_some(), packet::EFFECT_STENCIL);
    let [first, last] = scissor(everywhere);
    let control = state.function.unwrap_or(0) | bit(state.write, 0x100);
    stream.push(packet::registers(packet::DRAW_STATE, &[effects, control, u32::MAX, 0, first, last]));
    stream.push(packet::registers(BLEND_CONTROL, &[state.mode.unwrap_or(0)]));
    if let Some(stencil) = &state.stencil {
        stream.push(packet::registers(packet::STENCIL, &Sheet::stencil_words(stencil)));
    }
    let each = [3, 2, 1][topology as usize];
    for part in vertices.chunks(each * way.piece) {
        stream.push(packet::draw_inline(topology | 0x100, part.len() as u32, part.as_flattened(), &[]));
    }
}

/// Red, green, blue, alpha of a stored pixel.
fn decode(format: u32, pixel: u32) -> [u32; 4] {
    let bits = |low: u32, count: u32| pixel >> low & ((1 << count) - 1);
    match format {
        0 => [bits(16, 8), bits(8, 8), bits(0, 8), 255],
        1 => [bits(16, 8), bits(8, 8), bits(0, 8), bits(24, 8)],
        _ => {
            let [r, g, b] = [bits(11, 5), bits(5, 6), bits(0, 5)];
            [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2, 255]
        }
    }
}

fn encode(format: u32, [r, g, b, a]: [u32; 4]) -> u32 {
    match format {
        0 => 0xFF00_0000 | r << 16 | g << 8 | b,
        1 => a << 24 | r << 16 | g << 8 | b,
        _ => r >> 3 << 11 | g >> 2 << 5 | b >> 3,
    }
}

fn channels(colour: u32) -> [u32; 4] {
    colour.to_le_bytes().map(u32::from)
}

fn passes(function: u32, z: u32, stored: u32) -> bool {
    [false, z < stored, z == stored, z <= stored, z > stored, z != stored, z >= stored, true][function as usize]
}

/// n / 255 to the nearest.
fn rounded(n: u32) -> u32 {
    (2 * n + 255) / 510
}

fn blended(mode: u32, behind: [u32; 4], source: [u32; 4]) -> [u32; 4] {
    let a = source[3];
    std::array::from_fn(|k| {
        let (d, s) = (behind[k], if k == 3 { 255 } else { source[k] });
        match (mode, k) {
            (0, _) => rounded(d * (255 - a) + s * a),
            (1 | 2, 3) => d,
            (1, _) => (d + rounded(s * a)).min(255),
            (2, _) => rounded(d * (255 - rounded(a * (255 - s)))),
            _ => (source[k] + rounded(d * (255 - a))).min(255),
        }
    })
}

/// A layer at a pixel: depth if it is tested, function, mode, colour, stencil test.
type Layer = (Option<(u32, u32)>, u32, [u32; 4], Option<Stencil>);

/// A pixel: as it is stored, its depth, what waits.
struct Pixel {
    stored: u32,
    depth: u32,
    stencil: u8,
    layers: Vec<Layer>,
}

impl Pixel {
    fn compose(&mut self, format: u32) {
        let (depth, value) = (self.depth, self.stencil);
        self.layers.retain(|(.., stencil)| stencil.is_none_or(|stencil| stencil.outcome(false, value, true).0));
        self.layers.retain(|(test, ..)| test.is_none_or(|(z, function)| passes(function, z, depth)));
        // Stable: equal ones stay in order. What is not tested is nearer than depth 0.
        self.layers.sort_by_key(|(test, ..)| -test.map_or(-1, |(z, _)| i64::from(z)));
        let colour = self
            .layers
            .iter()
            .fold(decode(format, self.stored), |behind, (_, mode, source, _)| blended(*mode, behind, *source));
        if !self.layers.is_empty() {
            self.stored = encode(format, colour);
        }
        self.layers.clear();
    }
}

/// The pixels of a scene by definition. Depths of vertices are exact in 24 bits but for the rounding, which keeps their
/// order: the model compares numbers of 32nds.
fn model(scene: &Scene, forgets: bool) -> Vec<u32> {
    let [width, height] = scene.size;
    let format = scene.format;
    let stored = if format == 2 { [BEFORE.0 & 0xFFFF, BEFORE.0 >> 16] } else { [BEFORE.0; 2] };
    // BEFORE.1 is half of the range, 16 of 32, and no vertex lies there: theirs are 1..=16 of 32 of 2^24 - 1.
    let depth = if forgets { 100 } else { 17 };
    let tests = |command: &Command| matches!(command, Command::Rectangle { state, .. } if state.stencil.is_some());
    let called = scene.commands.iter().any(tests);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixel = |(x, y): (u32, u32)| {
        let mut pixel = Pixel { stored: stored[x as usize % 2], depth, stencil: 0, layers: vec![] };
        let inside = |[l, t, r, b]: [u32; 4]| (l..r).contains(&x) && (t..b).contains(&y);
        for command in &scene.commands {
            match command {
                Command::Clear { colour, nearest, stencil, area } if area.is_none_or(inside) => {
                    if colour.is_some() {
                        pixel.layers.clear();
                    } else {
                        pixel.compose(format);
                    }
                    pixel.stored = colour.map_or(pixel.stored, |colour| encode(format, channels(colour)));
                    pixel.depth = nearest.map_or(pixel.depth, |nearest| if nearest { 0 } else { 100 });
                    pixel.stencil = stencil.unwrap_or(pixel.stencil);
                }
                Command::Rectangle { area, depth, colour, state } if inside(*area) => {
                    let z = depth + 1;
                    let source = channels(*colour);
                    let test = state.function.map(|function| (z, function));
                    match (state.mode, source[3]) {
                        (None, _) | (Some(0), 255) => {
                            // What asks for no depth lies over all that came before it; where a stencil test let it
                            // through, nobody knows later.
                            if test.is_none() && state.stencil.is_none() {
                                pixel.layers.clear();
                            }
                            let mut drawn = test.is_none_or(|(z, function)| passes(function, z, pixel.depth));
                            if let Some(stencil) = &state.stencil {
                                // The triangles of a rectangle run clockwise: their back is seen.
                                (drawn, pixel.stencil) = stencil.outcome(false, pixel.stencil, drawn);
                            }
                            if drawn {
                                if state.stencil.is_none_or(|stencil| stencil.colours) {
                                    pixel.stored = encode(format, source);
                                }
                                pixel.depth = if test.is_some() && state.write { z } else { pixel.depth };
                            }
                        }
                        (Some(0), 0) => {}
                        (Some(mode), _) => pixel.layers.push((test, mode, source, state.stencil)),
                    }
                }
                _ => {}
            }
        }
        if let Some(shadow) = scene.shadow.filter(|shadow| called && shadow.falls_on(pixel.stencil)) {
            let [r, g, b, a] = decode(format, pixel.stored);
            let [r, g, b] = [r, g, b].map(|level| u32::from(shadow.darken(level as u8)));
            pixel.stored = encode(format, [r, g, b, a]);
        }
        pixel.compose(format);
        pixel.stored
    };
    places.map(pixel).collect()
}

/// A stencil test of few values; where something blends it changes none.
fn stencil(blends: bool) -> impl Strategy<Value = Stencil> {
    let function =
        prop_oneof![1 => Just(DepthFunction::Always), 3 => prop::sample::select(DepthFunction::ALL.to_vec())];
    let operation = prop::sample::select(Operation::ALL.to_vec());
    let operations =
        prop_oneof![1 => Just([Operation::Keep; 3]), 3 => [operation.clone(), operation.clone(), operation]];
    (function, 0_u8..4, operations.clone(), operations, any::<bool>()).prop_map(
        move |(function, reference, front, back, colours)| {
            let of = |operations| if blends { [Operation::Keep; 3] } else { operations };
            let (front, back, colours) = (of(front), of(back), colours || blends);
            Stencil { function, reference, read_mask: 0xFF, write_mask: 0xFF, front, back, colours }
        },
    )
}

fn state(plane: bool) -> impl Strategy<Value = State> {
    let function = prop_oneof![2 => Just(Some(1)), 3 => (0_u32..8).prop_map(Some), 1 => Just(None)];
    let mode = prop_oneof![2 => Just(None), 3 => Just(Some(0)), 3 => (0_u32..4).prop_map(Some)];
    (function, any::<bool>(), any::<bool>(), mode).prop_flat_map(move |(function, write, gouraud, mode)| {
        let stencil = sometimes(if plane { 7 } else { 0 }, stencil(mode.is_some()));
        stencil.prop_map(move |stencil| State { function, write, gouraud, mode, stencil })
    })
}

fn colour() -> impl Strategy<Value = u32> + Clone {
    let alpha = prop_oneof![3 => any::<u8>(), 1 => Just(255), 1 => Just(0), 1 => Just(128)];
    (any::<u32>(), alpha).prop_map(|(colour, alpha)| colour & 0x00FF_FFFF | u32::from(alpha) << 24)
}

fn area([width, height]: [u32; 2]) -> impl Strategy<Value = [u32; 4]> {
    let free = ([0..=width, 0..=width], [0..=height, 0..=height]);
    let free = free.prop_map(|([a, b], [c, d])| [a.min(b), c.min(d), a.max(b), c.max(d)]);
    prop_oneof![2 => free, 1 => Just([0, 0, width, height])]
}

fn clear(size: [u32; 2], plane: bool) -> impl Strategy<Value = Command> {
    let planes = prop_oneof![2 => Just((true, true)), 2 => Just((true, false)), 3 => Just((false, true))];
    let area = prop::option::weighted(0.6, area(size));
    let stencil = sometimes(if plane { 5 } else { 0 }, (0_u8..4, any::<bool>()));
    (planes, any::<u32>(), prop::bool::weighted(0.2), stencil, area).prop_map(
        |(planes, colour, nearest, stencil, area)| {
            // Beside the others, or alone.
            let others = stencil.is_none_or(|(_, alone)| !alone);
            Command::Clear {
                colour: (planes.0 && others).then_some(colour),
                nearest: (planes.1 && others).then_some(nearest),
                stencil: stencil.map(|(value, _)| value),
                area,
            }
        },
    )
}

fn rectangle(size: [u32; 2], plane: bool) -> impl Strategy<Value = Command> {
    (area(size), 0_u32..6, colour(), state(plane)).prop_map(|(area, depth, colour, state)| {
        // One colour needs no interpolator; both ways must say the same.
        Command::Rectangle { area, depth, colour, state }
    })
}

fn anything([width, height]: [u32; 2], plane: bool) -> impl Strategy<Value = Command> {
    let vertex = (-200..16 * width as i32 + 200, -200..16 * height as i32 + 200, 0_u32..16, colour());
    (0_u32..3, 1_usize..4).prop_flat_map(move |(topology, count)| {
        let vertices = prop::collection::vec(vertex.clone(), count * [3, 2, 1][topology as usize]);
        (vertices, state(plane)).prop_map(move |(vertices, state)| Command::Any { topology, vertices, state })
    })
}

fn scene(slanted: bool, plane: bool) -> impl Strategy<Value = Scene> {
    let shadow = (prop::sample::select(DepthFunction::ALL.to_vec()), 0_u8..3, any::<u8>())
        .prop_map(|(function, reference, intensity)| Shadow { function, reference, mask: 0xFF, intensity });
    let shadow = sometimes(if plane { 5 } else { 0 }, shadow);
    (scene_with(slanted, plane), shadow).prop_map(|(scene, shadow)| Scene { shadow, ..scene })
}

fn scene_with(slanted: bool, plane: bool) -> impl Strategy<Value = Scene> {
    let sizes = vec![[20, 17], [33, 9], [70, 66], [64, 20]];
    (prop::sample::select(sizes), 0_u32..3).prop_flat_map(move |(size, format)| {
        let weight = if slanted { 6 } else { 0 };
        let command = prop_oneof![6 => rectangle(size, plane), weight => anything(size, plane), 2 => clear(size, plane)];
        let first = prop_oneof![
            3 => Just(vec![Command::Clear { colour: Some(0xFF40_2010), nearest: Some(false), stencil: None, area: None }]),
            1 => Just(vec![]),
        ];
        (first, prop::collection::vec(command, 1..9)).prop_map(move |(first, rest)| Scene {
            size,
            format,
            plane,
            shadow: None,
            commands: [first, rest].concat(),
        })
    })
}

/// Two functional ways and a clocked one for each path; kernels, threads and packets as the case has them.
fn ways(kernel: Kernel, threads: usize, piece: usize, depth_buffer: bool) -> Vec<[Way; 3]> {
    let hidden = [
        Hidden::default(),
        Hidden::za([8, 4]),
        Hidden::za([32, 1]),
        Hidden::systolic(0),
        Hidden::systolic(4),
        Hidden::systolic(8),
        Hidden::tile([8, 8]),
        Hidden::tile([64, 16]),
    ];
    let hidden = hidden.into_iter().filter(|hidden| depth_buffer || hidden.path.keeps_depths());
    hidden
        .map(|hidden| {
            let plain = Way { hidden, depth_buffer, kernel: Kernel::Specification, threads: 1, piece: 1000 };
            let clocked = Way { hidden: hidden.clocked(), kernel, ..plain.clone() };
            [plain.clone(), Way { kernel, threads, piece, ..plain }, clocked]
        })
        .collect()
}

fn check(scene: &Scene, ways: &[[Way; 3]]) -> Result<Outcome, TestCaseError> {
    let reference = run(scene, &ways[0][0]);
    for ways in ways {
        let mut events = None;
        for way in ways {
            let found = run(scene, way);
            let place = found.pixels.iter().zip(&reference.pixels).position(|(a, b)| a != b);
            prop_assert!(place.is_none(), "{:?}: pixel {:?}", way, place);
            let place = found.depths.iter().flatten().zip(reference.depths.iter().flatten()).position(|(a, b)| a != b);
            prop_assert!(place.is_none(), "{:?}: depth {:?}", way, place);
            prop_assert_eq!(found.counters, reference.counters, "counters {:?}", way);
            // Of one path functional and clocked, fast and by the specification.
            let first = events.get_or_insert_with(|| found.events.clone());
            prop_assert_eq!(&found.events, first, "events {:?}", way);
        }
    }
    Ok(reference)
}

fn cases(short: u32) -> ProptestConfig {
    let long = std::env::var_os("ZGA_LONG").is_some();
    ProptestConfig {
        cases: if long { 20 * short } else { short },
        max_shrink_iters: 2000,
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("failed"))),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn scene_of_rectangles_every_way_is_the_models(
        scene in scene(false, false), kernel in prop::sample::select(Kernel::available()), threads in 1_usize..4,
        piece in 1_usize..4,
    ) {
        let outcome = check(&scene, &ways(kernel, threads, piece, true))?;
        let expected = model(&scene, false);
        let place = outcome.pixels.iter().zip(&expected).position(|(a, b)| a != b);
        prop_assert!(place.is_none(), "pixel {:?} is not the model's", place);
        // Without a Z buffer the sorting paths begin with the farthest depth.
        let outcome = check(&scene, &ways(kernel, threads, piece, false))?;
        let expected = model(&scene, true);
        let place = outcome.pixels.iter().zip(&expected).position(|(a, b)| a != b);
        prop_assert!(place.is_none(), "without a Z buffer pixel {:?} is not the model's", place);
    }

    #[test]
    fn scene_of_anything_every_way_is_one_picture_and_one_count(
        scene in scene(true, false), kernel in prop::sample::select(Kernel::available()), threads in 1_usize..4,
        piece in 1_usize..4,
    ) {
        check(&scene, &ways(kernel, threads, piece, true))?;
        check(&scene, &ways(kernel, threads, piece, false))?;
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn scene_of_rectangles_with_stencil_tests_every_way_is_the_models(
        scene in scene(false, true), kernel in prop::sample::select(Kernel::available()), threads in 1_usize..4,
        piece in 1_usize..4,
    ) {
        for depth_buffer in [true, false] {
            let outcome = check(&scene, &ways(kernel, threads, piece, depth_buffer))?;
            let expected = model(&scene, !depth_buffer);
            let place = outcome.pixels.iter().zip(&expected).position(|(a, b)| a != b);
            prop_assert!(place.is_none(), "Z buffer {}: pixel {:?} is not the model's", depth_buffer, place);
        }
    }

    #[test]
    fn scene_of_anything_with_stencil_tests_every_way_is_one_picture_and_one_count(
        scene in scene(true, true), kernel in prop::sample::select(Kernel::available()), threads in 1_usize..4,
        piece in 1_usize..4,
    ) {
        check(&scene, &ways(kernel, threads, piece, true))?;
        check(&scene, &ways(kernel, threads, piece, false))?;
    }
}

#[test]
fn layers_with_a_stencil_test_see_what_the_opaque_picture_left_and_are_not_in_its_shadow() {
    let keep = [Operation::Keep; 3];
    let mark = Stencil {
        function: DepthFunction::Always,
        reference: 1,
        read_mask: 0xFF,
        write_mask: 0xFF,
        front: keep,
        back: [Operation::Replace; 3],
        colours: false,
    };
    let inside = Stencil { function: DepthFunction::Equal, back: keep, colours: true, ..mark };
    let state = State { function: None, write: false, gouraud: false, mode: Some(1), stencil: Some(inside) };
    // The layer comes first, and is tested when the mark is there; it adds to the darkened white below it.
    let scene = Scene {
        size: [20, 17],
        format: 0,
        plane: true,
        shadow: Some(Shadow { function: DepthFunction::NotEqual, reference: 0, mask: 0xFF, intensity: 51 }),
        commands: vec![
            Command::Clear { colour: Some(0xFFFF_FFFF), nearest: Some(false), stencil: Some(0), area: None },
            Command::Rectangle { area: [0, 0, 20, 1], depth: 1, colour: 0xFF00_0010, state },
            Command::Rectangle {
                area: [2, 0, 5, 1],
                depth: 1,
                colour: 0xFF00_0000,
                state: State { mode: None, stencil: Some(mark), ..state },
            },
        ],
    };
    for ways in ways(Kernel::Best, 2, 1000, true) {
        for way in ways {
            let found = run(&scene, &way);
            let expected = [0xFFFF_FFFF, 0xFFFF_FFFF, 0xFF43_3333, 0xFF43_3333, 0xFF43_3333, 0xFFFF_FFFF];
            assert_eq!(found.pixels[..6], expected, "{way:?}");
            // Clocks: 20 fragments tested twice, 3 blended.
            assert_eq!(found.counters, [43, 20, 3, 0], "{way:?}");
        }
    }
}

#[test]
fn layers_count_fragments_blends_and_pixels_sorted() {
    let state = State { function: Some(1), write: false, gouraud: false, mode: Some(0), stencil: None };
    let rectangle = |depth, colour| Command::Rectangle { area: [2, 3, 12, 7], depth, colour, state };
    let clear = Command::Clear { colour: Some(0), nearest: Some(false), stencil: None, area: None };
    let scene = |commands: &[Command]| Scene {
        size: [20, 17],
        format: 0,
        plane: false,
        shadow: None,
        commands: commands.to_vec(),
    };
    let way = &ways(Kernel::Best, 1, 1000, true)[0][1];
    let counters = |commands: &[Command]| run(&scene(commands), way).counters;
    let [near, far] = [rectangle(2, 0x8000_00FF), rectangle(5, 0x80FF_0000)];
    // 40 pixels: two tests, two blends and a comparison each.
    assert_eq!(counters(&[clear.clone(), far.clone(), near.clone()]), [200, 80, 80, 0]);
    assert_eq!(counters(&[clear.clone(), near.clone(), far.clone()]), [200, 80, 80, 40]);
    // Taken back by a clear of colours; composed before one of depths, which hides the next.
    assert_eq!(counters(&[clear.clone(), near.clone(), clear.clone()]), [0; 4]);
    let nearest = Command::Clear { colour: None, nearest: Some(true), stencil: None, area: None };
    assert_eq!(counters(&[clear, near, nearest, far]), [120, 80, 40, 0]);
}

#[test]
fn layers_on_the_za_path_leave_blocks_that_they_do_not_touch_cleared() {
    let state = State { function: Some(1), write: false, gouraud: false, mode: Some(0), stencil: None };
    let layer = Command::Rectangle { area: [0, 0, 8, 4], depth: 3, colour: 0x8000_00FF, state };
    let clear = Command::Clear { colour: Some(0), nearest: Some(false), stencil: None, area: None };
    let scene = |commands: Vec<Command>| Scene { size: [64, 20], format: 1, plane: false, shadow: None, commands };
    let way = Way { hidden: Hidden::za([8, 4]), depth_buffer: true, kernel: Kernel::Best, threads: 1, piece: 1000 };
    let outcome = run(&scene(vec![clear, layer]), &way);
    assert_eq!(outcome.pixels[..9], [[0x8080_0000; 8].as_slice(), &[0]].concat());
    assert_eq!(outcome.counters, [64, 32, 32, 0]);
}
