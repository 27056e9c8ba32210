//! Random scripts: everything that makes the paths disagree if one of them is wrong.
//!
//! Colours and depths of clears come from a palette of two, so that blocks are cleared to what they are cleared to
//! already. Depths come often from a few values close together, so that ties and near ties are common.

use super::{Between, Command, Scene, Script};
use crate::harness::scenes::{Piece, any_depth, piece};
use crate::harness::{Pixels, State, Subpixel};
use crate::oracle::stencil::{Operation, Shadow, Stencil};
use crate::oracle::{DepthFormat, DepthFunction, Vertex};
use proptest::prelude::*;

/// What all parts of a script share.
#[derive(Clone, Copy, Debug)]
struct Frame {
    size: [u32; 2],
    format: DepthFormat,
    pixels: Pixels,
    depthless: bool,
    stencil: bool,
    gouraud: bool,
    colours: [u32; 2],
    depths: [u32; 2],
}

/// Widths around blocks, chunks and tiles; the picture stays small, since clocked models are slow.
pub(super) fn size(most: u32) -> impl Strategy<Value = [u32; 2]> {
    let sides = [1, 7, 8, 9, 15, 16, 17, 31, 32, 33, 40, 63, 64, 65, 100];
    let sides: Vec<u32> = sides.into_iter().filter(|&side| side <= most).collect();
    let side = move || prop_oneof![2 => prop::sample::select(sides.clone()), 1 => 1..=most];
    [side(), side()]
}

pub(super) fn format() -> impl Strategy<Value = DepthFormat> {
    let bits = prop_oneof![1 => Just(16), 3 => Just(24), 2 => Just(31)];
    let fraction = prop_oneof![1 => Just(0), 1 => Just(8), 1 => Just(16), 3 => Just(24)];
    (bits, fraction).prop_map(|(bits, fraction)| DepthFormat { bits, fraction })
}

/// A rectangle: any, on the boundaries of blocks, or empty; left, top, right, bottom.
pub(super) fn rectangle([width, height]: [u32; 2]) -> impl Strategy<Value = [u32; 4]> {
    let free = [0..=width, 0..=height, 0..=width + 2, 0..=height + 2];
    let free = free.prop_map(|[left, top, right, bottom]| [left, top, right, bottom]);
    let aligned = (0..=width / 8, 0..=height / 8, 1_u32..6, 1_u32..6);
    let aligned = aligned.prop_map(|(x, y, w, h)| [8 * x, 8 * y, 8 * (x + w), 8 * (y + h)]);
    prop_oneof![3 => free, 2 => aligned]
}

/// Something in so many of ten cases; 0 is never.
pub fn sometimes<T: Clone + std::fmt::Debug>(
    tenths: u32,
    something: impl Strategy<Value = T>,
) -> impl Strategy<Value = Option<T>> {
    prop_oneof![10 - tenths => Just(None), tenths => something.prop_map(Some)]
}

/// A stencil test: often one that passes, and values close together, so that the same ones meet again.
pub(super) fn stencil() -> impl Strategy<Value = Stencil> {
    let function =
        prop_oneof![2 => Just(DepthFunction::Always), 3 => prop::sample::select(DepthFunction::ALL.to_vec())];
    let operation = prop::sample::select(Operation::ALL.to_vec());
    let operations = prop_oneof![
        1 => Just([Operation::Keep; 3]),
        1 => operation.clone().prop_map(|pass| [Operation::Keep, Operation::Keep, pass]),
        1 => operation.clone().prop_map(|depth_fail| [Operation::Keep, depth_fail, Operation::Keep]),
        2 => [operation.clone(), operation.clone(), operation],
    ];
    let mask = || prop_oneof![3 => Just(0xFF), 1 => any::<u8>()];
    let value = prop_oneof![4 => 0_u8..4, 1 => 253_u8..=255, 1 => any::<u8>()];
    (function, value, mask(), mask(), operations.clone(), operations, prop::bool::weighted(0.7)).prop_map(
        |(function, reference, read_mask, write_mask, front, back, colours)| Stencil {
            function,
            reference,
            read_mask,
            write_mask,
            front,
            back,
            colours,
        },
    )
}

/// What lies in shadow.
fn shadow() -> impl Strategy<Value = Shadow> {
    let function =
        prop_oneof![2 => Just(DepthFunction::NotEqual), 1 => prop::sample::select(DepthFunction::ALL.to_vec())];
    (function, 0_u8..4, prop_oneof![2 => Just(0xFF), 1 => any::<u8>()], any::<u8>())
        .prop_map(|(function, reference, mask, intensity)| Shadow { function, reference, mask, intensity })
}

fn state(frame: Frame) -> impl Strategy<Value = State> {
    let function = prop_oneof![4 => Just(DepthFunction::Less), 5 => prop::sample::select(DepthFunction::ALL.to_vec())];
    let scissor = prop::option::weighted(0.25, rectangle(frame.size));
    let stencil = sometimes(if frame.stencil { 8 } else { 0 }, stencil());
    (function, prop::bool::weighted(0.8), prop::bool::weighted(0.85), scissor, stencil).prop_map(
        move |(function, write, depth_test, scissor, stencil)| State {
            depth_test: depth_test && !frame.depthless,
            function,
            write,
            gouraud: frame.gouraud,
            scissor,
            stencil,
            ..State::default()
        },
    )
}

/// Layers over all of the target or most of it, tilted a little or not at all: what a bypass is for.
pub(super) fn stack([width, height]: [u32; 2], bits: u32) -> impl Strategy<Value = Vec<Piece>> {
    let layer = (any_depth(bits), 0_u32..3, -600_i32..600);
    prop::collection::vec(layer, 1..7).prop_map(move |layers| {
        let [right, bottom] = [width as i32 * 512 + 512, height as i32 * 512 + 512];
        let piece = |(z, tilt, left): (u32, u32, i32)| {
            let greatest = ((1_u64 << bits) - 1) as u32;
            let other = crate::harness::depth::survivor(z.saturating_add(tilt * 1000).min(greatest), bits);
            let corners = [(left, -300, z), (right, -300, other), (left, bottom, z)];
            Piece::Triangle(corners.map(|(x, y, z)| Vertex::at(x, y, z)))
        };
        layers.into_iter().map(piece).collect()
    })
}

fn pieces(frame: Frame) -> impl Strategy<Value = Vec<Piece>> {
    let bits = frame.format.bits;
    prop_oneof![4 => prop::collection::vec(piece(frame.size, bits), 1..8), 1 => stack(frame.size, bits)]
}

fn clear(frame: Frame) -> impl Strategy<Value = Command> {
    let (colours, depths) = (frame.colours, frame.depths);
    let planes = prop_oneof![3 => Just((true, true)), 1 => Just((true, false)), 1 => Just((false, true))];
    let scissor = prop::option::weighted(0.5, rectangle(frame.size));
    // Of the stencil plane beside the others, alone, or not at all.
    let value = sometimes(if frame.stencil { 5 } else { 0 }, 0_u8..4);
    let alone = prop::bool::weighted(0.4);
    let values = (prop::sample::select(colours.to_vec()), prop::sample::select(depths.to_vec()), value, alone);
    (planes, values, scissor).prop_map(move |((coloured, deep), (colour, depth, stencil, alone), scissor)| {
        let others = stencil.is_none() || !alone;
        Command::Clear {
            colour: ((coloured || frame.depthless) && others).then_some(colour),
            depth: (deep && !frame.depthless && others).then_some(depth),
            stencil,
            scissor,
        }
    })
}

fn between(frame: Frame) -> impl Strategy<Value = Between> {
    let [width, height] = frame.size;
    // x, y, width, height inside.
    let inside = (0..width, 0..height, 0..=width, 0..=height);
    let inside = inside.prop_map(move |(x, y, w, h)| [x, y, w.min(width - x), h.min(height - y)]);
    let to = (inside.clone(), 0..width, 0..height);
    let copy = to.prop_map(move |([x, y, w, h], to_x, to_y)| {
        Between::Copy([x, y, w.min(width - to_x), h.min(height - to_y)], [to_x, to_y])
    });
    // Whole words only.
    let words = width * frame.pixels.bytes() / 4;
    let depth = any_depth(frame.format.bits);
    let fill_depth = (inside.clone(), depth.clone()).prop_map(|(area, z)| Between::FillDepth(area, z));
    let upload = (0..height, prop::collection::vec(any::<u32>(), 0..=words as usize));
    let upload_depths = (0..height, prop::collection::vec(depth, 0..=width as usize));
    prop_oneof![
        2 => (inside, any::<u32>()).prop_map(|(area, value)| Between::Fill(area, value)),
        1 => fill_depth,
        1 => copy,
        1 => upload.prop_map(|(row, words)| Between::Upload(row, words)),
        1 => upload_depths.prop_map(|(row, words)| Between::UploadDepths(row, words)),
        2 => Just(Between::Depths),
        1 => Just(Between::Reset),
        1 => Just(Between::Restore),
    ]
}

/// Not a reset: that would end the scene.
fn in_scene(frame: Frame) -> impl Strategy<Value = Command> {
    between(frame).prop_map(|between| match between {
        Between::Reset => Command::Look,
        between => Command::Memory(between),
    })
}

fn scene(frame: Frame, shared: bool) -> impl Strategy<Value = Scene> {
    let whole = Command::Clear {
        colour: Some(frame.colours[0]),
        depth: (!frame.depthless).then_some(frame.depths[0]),
        stencil: None,
        scissor: None,
    };
    let first = prop_oneof![4 => Just(vec![whole]), 1 => clear(frame).prop_map(|clear| vec![clear]), 2 => Just(vec![])];
    let draw = (pieces(frame), state(frame)).prop_map(|(pieces, state)| Command::Draw { pieces, state });
    let weight = if shared { 2 } else { 0 };
    let command = prop_oneof![6 => draw, 2 => clear(frame), 1 => Just(Command::Look), weight => in_scene(frame)];
    let commands = (first, prop::collection::vec(command, 0..6)).prop_map(|(first, rest)| [first, rest].concat());
    let after = prop_oneof![3 => Just(vec![]), 1 => prop::collection::vec(between(frame), 1..4)];
    let shadow = sometimes(if frame.stencil { 5 } else { 0 }, shadow());
    (prop_oneof![3 => Just(0), 1 => Just(1)], commands, shadow, after)
        .prop_map(|(frame, commands, shadow, after)| Scene { frame, commands, shadow, after })
}

/// A script of up to `scenes` scenes on a target of up to `most` pixels a side.
pub fn script(most: u32, scenes: usize) -> impl Strategy<Value = Script> {
    scripts(most, scenes, false)
}

/// The same with a stencil plane, and draws that test it.
pub fn stencil_script(most: u32, scenes: usize) -> impl Strategy<Value = Script> {
    scripts(most, scenes, true)
}

fn scripts(most: u32, scenes: usize, stencil: bool) -> impl Strategy<Value = Script> {
    let pixels = prop::sample::select(vec![Pixels::Xrgb8888, Pixels::Argb8888, Pixels::Rgb565]);
    let flags = (prop::bool::weighted(0.1), prop::bool::weighted(0.25), prop::bool::weighted(0.2));
    (size(most), format(), pixels, flags, any::<[u32; 2]>()).prop_flat_map(
        move |(size, format, pixels, flags, colours)| {
            let (depthless, gouraud, shared) = flags;
            let depths = [Just(format.greatest()).boxed(), any_depth(format.bits).boxed()];
            depths.prop_flat_map(move |depths| {
                let frame = Frame { size, format, pixels, depthless, stencil, gouraud, colours, depths };
                prop::collection::vec(scene(frame, shared), 1..=scenes).prop_map(move |scenes| Script {
                    size,
                    format,
                    pixels,
                    depthless,
                    stencil,
                    gouraud,
                    subpixel: Subpixel::default(),
                    scenes,
                })
            })
        },
    )
}
