//! Tests of the Za unit's models against each other and against the plain Z buffer.

mod fast;
mod random;
mod units;

use super::grid::Grid;
use super::memory::{Frame, Settle, maximum};
use super::{Background, CLEARED, Surfaces, ZaCounts, ZaDraw, clocked, specification};
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Point, Shape};
use crate::geometry::line::Line;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::band::Setting;
use crate::shading::plane::Interpolation;
use zga_abi::format::{DepthFormat, DepthFunction, PixelFormat, ZaPrediction};
use zga_firmware::checked::Rectangle;

/// The state of a draw that cleared blocks or not, as tests choose it.
#[derive(Clone, Copy, Debug)]
struct State {
    function: Option<DepthFunction>,
    write: bool,
    interpolation: Interpolation,
    scissor: Rectangle,
    prediction: ZaPrediction,
    bypass: bool,
}

/// The memories of one card.
#[derive(Clone, Debug, PartialEq)]
struct Memory {
    colour: Vec<u32>,
    depth: Vec<i32>,
    words: Vec<i32>,
}

impl Memory {
    /// Memory that nobody should read: `seed` decides what is in it. All blocks are cleared.
    fn poisoned(frame: &Frame, seed: u32) -> Memory {
        let rows = frame.grid.size[1] as usize;
        let noise = |n: usize| (n as u32 ^ seed).wrapping_mul(0x9E37_79B9).rotate_left(13).wrapping_mul(0x85EB_CA6B);
        Memory {
            colour: (0..frame.colour_pitch * rows).map(noise).collect(),
            depth: (0..frame.depth_pitch.unwrap_or(0) * rows).map(|n| noise(n + 7) as i32).collect(),
            words: vec![CLEARED; frame.grid.words()],
        }
    }

    fn surfaces(&mut self) -> Surfaces<'_> {
        Surfaces { colour: &mut self.colour, depth: &mut self.depth, words: &mut self.words, stencil: &mut [] }
    }

    /// The memory after all cleared blocks were brought to it.
    fn settled(&self, frame: &Frame, background: &Background) -> Memory {
        let mut memory = self.clone();
        let _ = frame.settle(background, None, Settle::All, &mut memory.surfaces());
        memory
    }
}

/// A frame with some room at the end of each row.
fn frame(size: [u32; 2], block: [u32; 2], pixel_format: PixelFormat, depth_format: DepthFormat, depth: bool) -> Frame {
    let pitch = size[0].next_multiple_of(16) as usize + 16;
    let colour_pitch = if pixel_format == PixelFormat::Rgb565 { pitch / 2 } else { pitch };
    Frame { grid: Grid { block, size }, pixel_format, colour_pitch, depth_format, depth_pitch: depth.then_some(pitch) }
}

fn za_draw(frame: &Frame, background: Background, state: &State) -> ZaDraw {
    ZaDraw {
        pixels: Setting {
            test: state.function.map(|function| DepthTest::new(function, state.write)),
            format: frame.depth_format,
            interpolation: state.interpolation,
            shading: None,
            stencil: None,
            cuts_segments: false,
            scissor: state.scissor,
            width: frame.grid.size[0],
            pixel_format: frame.pixel_format,
            colour_pitch: frame.colour_pitch,
            depth_pitch: frame.depth_pitch.unwrap_or(0),
        },
        grid: frame.grid,
        background,
        prediction: state.prediction,
        bypass: state.bypass,
        depth_buffer: frame.depth_pitch.is_some(),
    }
}

/// A triangle, if it covers a pixel.
fn triangle(v: [ScreenVertex; 3], format: DepthFormat) -> Option<Shape> {
    Triangle::new(&v, format).map(|(triangle, _)| Shape::Triangle(triangle, v))
}

/// A line, if it draws a pixel.
fn line(v: [ScreenVertex; 2], format: DepthFormat) -> Option<Shape> {
    Line::new(&v, format).map(|line| Shape::Line(line, v))
}

/// A point.
fn point(v: ScreenVertex) -> Shape {
    Shape::Point(Point { pixel: [v.x >> 8, v.y >> 8], z: v.z as i32 }, v)
}

/// The plain Z buffer's picture and depths.
fn z_buffer_draw(draw: &ZaDraw, shape: &Shape, memory: &mut Memory) -> z_buffer::tile::TileCounts {
    z_buffer::specification::draw(&draw.pixels, std::iter::once((shape, 0)), &mut memory.colour, &mut memory.depth)
}

fn specification_draw(draw: &ZaDraw, shape: &Shape, memory: &mut Memory) -> ZaCounts {
    specification::draw(draw, std::iter::once((shape, 0)), &mut memory.surfaces())
}

fn clocked_draw(draw: &ZaDraw, shape: &Shape, memory: &mut Memory) -> ZaCounts {
    clocked::draw(draw, std::iter::once((shape, 0)), &mut memory.surfaces())
}

/// Words that are neither cleared nor the exact maximum of their blocks.
fn wrong_words(frame: &Frame, memory: &Memory) -> Vec<(usize, i32, i32)> {
    let exact = |index: usize| match frame.depth_pitch {
        Some(pitch) => maximum(&memory.depth, pitch, &frame.grid.area(index)),
        None => frame.depth_format.maximum() as i32,
    };
    let words = memory.words.iter().enumerate().map(|(index, &word)| (index, word, exact(index)));
    words.filter(|(_, word, exact)| *word >= 0 && word != exact).collect()
}
