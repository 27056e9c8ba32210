//! A script as the exact oracle sees it.

use super::{Between, Command, Outcome, Script};
use crate::harness::{Pixels, State};
use crate::oracle::canvas::{Canvas, Test};
use crate::oracle::stencil::Shadow;

/// What must be seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Judgement {
    /// Both frames after each scene.
    pub shown: Vec<[Vec<u32>; 2]>,
    /// Looks in mid-scene.
    pub looks: Vec<Option<Vec<u32>>>,
    /// Depths at the end.
    pub depths: Vec<u32>,
    /// Stencil values at the end.
    pub stencils: Vec<u8>,
}

impl Judgement {
    /// Where an outcome is wrong, if it is.
    #[must_use]
    pub fn fault(&self, outcome: &Outcome) -> Option<String> {
        let Self { shown, looks, depths, stencils } = self.clone();
        let (depths, stencils, events) = (Some(depths), Some(stencils), outcome.events);
        outcome.difference(&Outcome { shown, looks, depths, stencils, stored: None, strays: 0, events })
    }
}

/// Frames after each scene and depths at the end; `None` where colours are interpolated: those are judged elsewhere.
/// `forgets`: there is no Z buffer, each scene starts with the farthest depths.
#[must_use]
pub fn judge(script: &Script, forgets: bool) -> Option<Judgement> {
    if script.gouraud {
        return None;
    }
    let ([width, height], pixels) = (script.size, script.pixels);
    let mut canvas = Canvas::new(width, height, script.format, encode(pixels));
    // Frame 0 was cleared to transparent black, frame 1 filled with pixels of 0.
    let mut frames = [vec![(canvas.encode)([0; 4]); canvas.colour.len()], canvas.colour.clone()];
    let mut judgement = Judgement { shown: Vec::new(), looks: Vec::new(), depths: Vec::new(), stencils: Vec::new() };
    let look = |frame: &[u32]| frame.iter().map(|&pixel| shown(pixels, pixel)).collect::<Vec<u32>>();
    let mut place = 0;
    for scene in &script.scenes {
        std::mem::swap(&mut canvas.colour, &mut frames[scene.frame]);
        if forgets {
            canvas.forget_depths();
        }
        let mut called = false;
        for command in &scene.commands {
            match command {
                Command::Clear { colour, depth, stencil, scissor } => {
                    let area = scissor.unwrap_or([0, 0, width, height]);
                    canvas.clear(area, colour.map(u32::to_le_bytes), *depth);
                    if let Some(value) = stencil {
                        canvas.clear_stencil(area, *value);
                    }
                }
                Command::Draw { pieces, state } => {
                    canvas.draw(&script.primitives(place, pieces), &test(state, script.size));
                    place += 1;
                    called |= state.stencil.is_some();
                }
                Command::Memory(between) => change(&mut canvas, between, pixels),
                Command::Look => judgement.looks.push(Some(look(&canvas.colour))),
            }
        }
        if let (Some(shadow), true) = (&scene.shadow, called) {
            darken(&mut canvas, shadow, pixels);
        }
        scene.after.iter().for_each(|between| change(&mut canvas, between, pixels));
        std::mem::swap(&mut canvas.colour, &mut frames[scene.frame]);
        judgement.shown.push([0, 1].map(|frame| look(&frames[frame])));
    }
    (judgement.depths, judgement.stencils) = (canvas.depth, canvas.stencil);
    Some(judgement)
}

pub(super) fn test(state: &State, [width, height]: [u32; 2]) -> Test {
    Test {
        function: state.depth_test.then_some(state.function),
        write: state.write,
        scissor: state.scissor.unwrap_or([0, 0, width, height]),
        stencil: state.stencil,
    }
}

/// What the shadow bit does to a frame.
fn darken(canvas: &mut Canvas, shadow: &Shadow, pixels: Pixels) {
    for (stored, value) in canvas.colour.iter_mut().zip(&canvas.stencil) {
        if shadow.falls_on(*value) {
            let [_, r, g, b] = shown(pixels, *stored).to_be_bytes();
            let [r, g, b] = [r, g, b].map(|level| shadow.darken(level));
            *stored = (canvas.encode)([r, g, b, (*stored >> 24) as u8]);
        }
    }
}

/// What the bitmap unit does to frame and Z buffer.
fn change(canvas: &mut Canvas, between: &Between, pixels: Pixels) {
    let width = canvas.width as usize;
    let corners = |[x, y, w, h]: [u32; 4]| [x, y, x + w, y + h];
    let mask = if pixels == Pixels::Rgb565 { 0xFFFF } else { u32::MAX };
    match between {
        Between::Fill(area, value) => canvas.for_each(corners(*area), |pixel, _| *pixel = value & mask),
        Between::FillDepth(area, value) => canvas.for_each(corners(*area), |_, depth| *depth = *value),
        Between::Copy([x, y, w, h], [to_x, to_y]) => {
            let from = canvas.colour.clone();
            for row in 0..*h as usize {
                let at = |x: u32, y: u32| (y as usize + row) * width + x as usize;
                let (from_at, to_at) = (at(*x, *y), at(*to_x, *to_y));
                canvas.colour[to_at..to_at + *w as usize].copy_from_slice(&from[from_at..from_at + *w as usize]);
            }
        }
        Between::Upload(row, words) => {
            let halves = words.iter().flat_map(|word| [word & 0xFFFF, word >> 16]).collect::<Vec<u32>>();
            let new = if pixels == Pixels::Rgb565 { &halves } else { words };
            let start = *row as usize * width;
            canvas.colour[start..start + new.len()].copy_from_slice(new);
        }
        Between::UploadDepths(row, words) => {
            let start = *row as usize * width;
            canvas.depth[start..start + words.len()].copy_from_slice(words);
        }
        Between::Depths | Between::Reset | Between::Restore => {}
    }
}

/// Stored pixels of a format.
pub(super) fn encode(pixels: Pixels) -> fn([u8; 4]) -> u32 {
    match pixels {
        Pixels::Xrgb8888 => |[r, g, b, _]| u32::from_be_bytes([255, r, g, b]),
        Pixels::Argb8888 => |[r, g, b, a]| u32::from_be_bytes([a, r, g, b]),
        Pixels::Rgb565 => |[r, g, b, _]| u32::from(r >> 3) << 11 | u32::from(g >> 2) << 5 | u32::from(b >> 3),
    }
}

/// What scan-out makes of a stored pixel.
pub(super) const fn shown(pixels: Pixels, pixel: u32) -> u32 {
    match pixels {
        Pixels::Xrgb8888 | Pixels::Argb8888 => pixel | 0xFF00_0000,
        Pixels::Rgb565 => {
            let (r, g, b) = (pixel >> 11 & 31, pixel >> 5 & 63, pixel & 31);
            0xFF00_0000 | (r << 3 | r >> 2) << 16 | (g << 2 | g >> 4) << 8 | b << 3 | b >> 2
        }
    }
}
