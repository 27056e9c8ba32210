//! Scripts whose pixels have samples: random ones, and what the exact oracle says of them.
//!
//! Scenes follow one another on one frame: each starts with the picture and the depths that the one before it left. Only
//! the last has layers, because a pixel with layers can have two right levels, and what follows would have to start from
//! either. For the same reason scripts of more than one scene average values: in linear light a mean of dark levels, where
//! the curve is straight, can lie in the middle between two.

use super::any::{format, rectangle, size, stack};
use super::judge::{encode, shown, test};
use super::{Command, Outcome, Scene, Script};
use crate::harness::scenes::{Piece, any_depth, piece};
use crate::harness::{Grid, Pixels, Resolve, State, Subpixel, depth};
use crate::oracle::supersample::{self, Brush, Level, Supersampled};
use crate::oracle::{DepthFunction, Vertex};
use proptest::prelude::*;

/// What must be seen.
#[derive(Clone, Debug)]
pub struct Judgement {
    pixels: Pixels,
    /// The frame after each scene.
    shown: Vec<Vec<[Level; 4]>>,
    /// At the centres, at the end.
    depths: Vec<u32>,
}

/// How a channel is stored.
fn stored(pixels: Pixels, levels: [u8; 4]) -> u32 {
    encode(pixels)(levels)
}

/// The colour that a stored pixel has.
const fn loaded(pixels: Pixels, pixel: u32) -> [u8; 4] {
    let [alpha, r, g, b] = shown(pixels, pixel).to_be_bytes();
    let alpha = if matches!(pixels, Pixels::Argb8888) { pixel.to_be_bytes()[0] } else { alpha };
    [r, g, b, alpha]
}

/// Whether a stored pixel is one of the right ones.
fn right(pixels: Pixels, pixel: u32, levels: &[Level; 4]) -> bool {
    let fits = |channel: usize| {
        let of_level = |level: u8| {
            let mut colour = [0; 4];
            colour[channel] = level;
            loaded(pixels, stored(pixels, colour))[channel]
        };
        let here = loaded(pixels, pixel)[channel];
        here == of_level(levels[channel].low) || here == of_level(levels[channel].high)
    };
    (0..4).all(fits)
}

impl Judgement {
    /// Where an outcome is wrong, if it is.
    #[must_use]
    pub fn fault(&self, outcome: &Outcome) -> Option<String> {
        let wrong = |what: &str, pixels: Pixels, found: &[u32], levels: &[[Level; 4]]| {
            let count = found.iter().zip(levels).filter(|(pixel, levels)| !right(pixels, **pixel, levels)).count();
            let place = found.iter().zip(levels).position(|(pixel, levels)| !right(pixels, *pixel, levels))?;
            let must = levels[place].map(|level| level.low);
            Some(format!("{what}: {count} pixels, first {place}: {:08x}, must be rgba {must:02x?}", found[place]))
        };
        for (scene, (found, levels)) in outcome.shown.iter().zip(&self.shown).enumerate() {
            // Scan-out shows no alpha, and five or six bits of a channel as eight.
            let must: Vec<_> = levels.iter().map(|levels| self.as_shown(levels)).collect();
            let fault = wrong(&format!("frame after scene {scene}"), Pixels::Xrgb8888, &found[0], &must);
            if fault.is_some() {
                return fault;
            }
        }
        let last = outcome.stored.as_ref().zip(self.shown.last());
        let fault = last.and_then(|(found, levels)| wrong("stored pixels", self.pixels, found, levels));
        let depths = outcome.depths.as_ref().and_then(|depths| {
            let place = depths.iter().zip(&self.depths).position(|(found, must)| found != must)?;
            Some(format!("depth {place}: {}, must be {}", depths[place], self.depths[place]))
        });
        fault.or(depths)
    }

    /// Pixels with two right levels in a channel, and all pixels.
    #[must_use]
    pub fn ties(&self) -> (usize, usize) {
        let pixels = || self.shown.iter().flatten();
        let tied = |levels: &&[Level; 4]| levels.iter().any(|level| level.low != level.high);
        (pixels().filter(tied).count(), pixels().count())
    }

    fn as_shown(&self, levels: &[Level; 4]) -> [Level; 4] {
        let pick = |pick: fn(&Level) -> u8| {
            let [_, r, g, b] = shown(self.pixels, stored(self.pixels, levels.each_ref().map(pick))).to_be_bytes();
            [r, g, b]
        };
        let (low, high) = (pick(|level| level.low), pick(|level| level.high));
        [0, 1, 2, 3].map(|c| if c < 3 { Level { low: low[c], high: high[c] } } else { Level::exactly(255) })
    }
}

/// How the oracle draws what a state of the card says.
#[must_use]
pub fn brush(state: &State, size: [u32; 2]) -> Brush {
    Brush {
        test: test(state, size),
        anti_alias: state.anti_alias,
        blend: state.blend,
        line_width: state.line_width,
        point_size: state.point_size,
    }
}

/// An empty target of the oracle for a card's setting.
#[must_use]
pub fn target(size: [u32; 2], format: crate::oracle::DepthFormat, subpixel: &Subpixel) -> Supersampled {
    let resolve = match subpixel.resolve {
        Resolve::Values => supersample::Resolve::Values,
        Resolve::Linear => supersample::Resolve::Linear,
    };
    Supersampled::new(size, subpixel.grid.size(), format, resolve)
}

/// The frame after each scene and the depths at the end.
#[must_use]
pub fn judge(script: &Script) -> Judgement {
    let (size, pixels) = (script.size, script.pixels);
    let mut target = target(size, script.format, &script.subpixel);
    let count = (size[0] * size[1]) as usize;
    let mut colours = vec![loaded(pixels, stored(pixels, [0; 4])); count];
    let mut depths = vec![script.format.greatest(); count];
    let (mut after, mut place) = (Vec::new(), 0);
    for scene in &script.scenes {
        target.load(&colours, &depths);
        for command in &scene.commands {
            match command {
                Command::Clear { colour, depth, scissor, .. } => {
                    let area = scissor.unwrap_or([0, 0, size[0], size[1]]);
                    target.clear(area, colour.map(u32::to_le_bytes), *depth);
                }
                Command::Draw { pieces, state } => {
                    target.draw(&script.primitives(place, pieces), &brush(state, size));
                    place += 1;
                }
                Command::Memory(_) | Command::Look => {}
            }
        }
        let levels = target.end();
        let keep = |levels: &[Level; 4]| loaded(pixels, stored(pixels, levels.map(|level| level.low)));
        colours = levels.iter().map(keep).collect();
        depths = target.centre_depths();
        after.push(levels);
    }
    Judgement { pixels, shown: after, depths }
}

/// What the scenes of a script share.
#[derive(Clone, Copy, Debug)]
struct Frame {
    size: [u32; 2],
    bits: u32,
    depthless: bool,
    colours: [u32; 2],
    depths: [u32; 2],
}

fn state(frame: Frame, layers: bool) -> impl Strategy<Value = State> {
    let function = prop_oneof![4 => Just(DepthFunction::Less), 5 => prop::sample::select(DepthFunction::ALL.to_vec())];
    let scissor = prop::option::weighted(0.25, rectangle(frame.size));
    let width = || {
        prop_oneof![
            4 => Just(0x100_u32),
            3 => prop::sample::select(vec![1, 2, 0x20, 0x40, 0x80, 0xFF, 0x101, 0x180, 0x300, 0x1000, 0xFFFF]),
            2 => 1_u32..0x800,
        ]
    };
    let effects = (prop::bool::weighted(0.75), prop::bool::weighted(if layers { 0.5 } else { 0.0 }));
    let depth = (function, prop::bool::weighted(0.8), prop::bool::weighted(0.85));
    (depth, effects, scissor, width(), width()).prop_map(
        move |((function, write, depth_test), (anti_alias, blend), scissor, line_width, point_size)| State {
            depth_test: depth_test && !frame.depthless,
            function,
            write,
            anti_alias,
            blend,
            scissor,
            line_width,
            point_size,
            ..State::default()
        },
    )
}

/// Planes through one point of the target, all about as deep there: they cross inside pixels.
fn crossing([width, height]: [u32; 2], bits: u32) -> impl Strategy<Value = Vec<Piece>> {
    let plane = ([-900_i32..900, -900_i32..900], 0.0_f64..6.3, 1.0_f64..4.0, -3_i32..=3);
    let reach = 4000.0;
    prop::collection::vec(plane, 2..7).prop_map(move |planes| {
        let greatest = ((1_u64 << bits) - 1) as f64;
        let [x, y] = [width, height].map(|side| side as i32 * 128);
        let piece = |(gradient, turn, size, off): ([i32; 2], f64, f64, i32)| {
            let corner = |k: f64| {
                let angle = turn + k * 2.1;
                let [dx, dy] = [angle.cos() * reach * size, angle.sin() * reach * size].map(|d| d as i32);
                let rise = f64::from(gradient[0]) * f64::from(dx) + f64::from(gradient[1]) * f64::from(dy);
                let z = (greatest / 2.0 + rise / 256.0 + f64::from(off)).clamp(0.0, greatest) as u32;
                Vertex::at(x + dx, y + dy, depth::survivor(z, bits))
            };
            Piece::Triangle([corner(0.0), corner(1.0), corner(2.0)])
        };
        planes.into_iter().map(piece).collect()
    })
}

fn pieces(frame: Frame) -> impl Strategy<Value = Vec<Piece>> {
    let Frame { size, bits, .. } = frame;
    prop_oneof![
        4 => prop::collection::vec(piece(size, bits), 1..8),
        1 => stack(size, bits),
        2 => crossing(size, bits),
    ]
}

fn clear(frame: Frame) -> impl Strategy<Value = Command> {
    let planes = prop_oneof![2 => Just((true, true)), 1 => Just((true, false)), 2 => Just((false, true))];
    let scissor = prop::option::weighted(0.5, rectangle(frame.size));
    let values = (prop::sample::select(frame.colours.to_vec()), prop::sample::select(frame.depths.to_vec()));
    (planes, values, scissor).prop_map(move |((coloured, deep), (colour, depth), scissor)| Command::Clear {
        colour: (coloured || frame.depthless).then_some(colour),
        depth: (deep && !frame.depthless).then_some(depth),
        stencil: None,
        scissor,
    })
}

fn scene(frame: Frame, layers: bool) -> impl Strategy<Value = Scene> {
    let (colour, depth) = (Some(frame.colours[0]), (!frame.depthless).then_some(frame.depths[0]));
    let whole = Command::Clear { colour, depth, stencil: None, scissor: None };
    let first = prop_oneof![3 => Just(vec![whole]), 1 => clear(frame).prop_map(|clear| vec![clear]), 2 => Just(vec![])];
    let draw = (pieces(frame), state(frame, layers)).prop_map(|(pieces, state)| Command::Draw { pieces, state });
    let command = prop_oneof![5 => draw, 1 => clear(frame)];
    (first, prop::collection::vec(command, 0..6)).prop_map(|(first, rest)| Scene {
        frame: 0,
        commands: [first, rest].concat(),
        shadow: None,
        after: vec![],
    })
}

/// A setting with a grid and room for every fragment.
pub fn subpixel() -> impl Strategy<Value = Subpixel> {
    let grid = prop::sample::select(Grid::ALL.to_vec());
    let order = prop::sample::select(crate::harness::Order::ALL.to_vec());
    let resolve = prop_oneof![3 => Just(Resolve::Values), 1 => Just(Resolve::Linear)];
    (grid, order, resolve).prop_map(|(grid, depth, resolve)| Subpixel { grid, depth, resolve, ..Subpixel::default() })
}

/// A script of up to `scenes` scenes on a target of up to `most` pixels a side; `layers`: the last has some.
pub fn script(most: u32, scenes: usize, layers: bool) -> impl Strategy<Value = Script> {
    let pixels = prop::sample::select(vec![Pixels::Xrgb8888, Pixels::Argb8888, Pixels::Argb8888, Pixels::Rgb565]);
    let head = (size(most), format(), pixels, prop::bool::weighted(0.1), any::<[u32; 2]>(), subpixel());
    head.prop_flat_map(move |(size, format, pixels, depthless, colours, subpixel)| {
        let depths = [Just(format.greatest()).boxed(), any_depth(format.bits).boxed()];
        depths.prop_flat_map(move |depths| {
            let frame = Frame { size, bits: format.bits, depthless, colours, depths };
            let early = prop::collection::vec(scene(frame, false), 0..scenes);
            (early, scene(frame, layers)).prop_map(move |(early, last)| Script {
                size,
                format,
                pixels,
                depthless,
                stencil: false,
                gouraud: false,
                subpixel: if early.is_empty() { subpixel } else { Subpixel { resolve: Resolve::Values, ..subpixel } },
                scenes: early.into_iter().chain([last]).collect(),
            })
        })
    })
}
