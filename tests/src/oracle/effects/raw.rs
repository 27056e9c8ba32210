//! Draws as the card gets them: vertices of a packet, words of registers, records and texels in memory.
//!
//! Positions go through the matrices in rationals, are snapped, and depths rounded, as [`super::super::clip`] has it.
//! Nothing is clipped here: every vertex must lie in front of the near plane, before the far one, and in the guard band.
//! Textures of lines and points are left out too: the manual does not say how their coordinates change across them.

use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};

use super::super::canvas::Test;
use super::super::clip::{Homogeneous, snap, stored_depth};
use super::super::exact::from_card_f32;
use super::super::raster::line::is_x_major;
use super::super::stencil::{Operation, Stencil};
use super::super::{DepthFunction, Primitive, Vertex};
use super::fog::Fog;
use super::light::{Lighting, eye_position, normal_matrix, normalised, transformed};
use super::picture::{Brush, Painting};
use super::shade::{Shader, Varying};
use super::surface::{Surface, Weights};
use super::texel::{Format, Memory, Texture};

const DEPTH: u32 = 0;
const GOURAUD: u32 = 1;
const PERSPECTIVE: u32 = 2;
const TEXTURE: u32 = 4;
const MIP_MAP: u32 = 5;
const LIGHT: u32 = 6;
const FOG: u32 = 7;
const BLEND: u32 = 8;
const PUNCH_THROUGH: u32 = 9;
const STENCIL: u32 = 11;

/// A vertex as a packet carries it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// x, y, z.
    pub position: [f32; 3],
    /// Red in 7:0.
    pub colour: u32,
    /// Object space.
    pub normal: [f32; 3],
    /// u, v.
    pub coordinates: [f32; 2],
}

/// The registers that a draw samples, as words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registers {
    /// EFFECTS.
    pub effects: u32,
    /// DEPTH_CONTROL.
    pub depth_control: u32,
    /// Left, top, right, bottom, the last two exclusive.
    pub scissor: [u32; 4],
    /// OBJECT_EYE.
    pub object_eye: [f32; 16],
    /// EYE_CLIP.
    pub eye_clip: [f32; 16],
    /// Scale x, y, z, offset x, y, z.
    pub viewport: [f32; 6],
    /// TEXTURE_BASE to PALETTE_BASE.
    pub texture: [u32; 8],
    /// PUNCH_THROUGH.
    pub punch_through: u32,
    /// BLEND_CONTROL.
    pub blend: u32,
    /// FOG_CONTROL to FOG_COLOUR.
    pub fog: [u32; 6],
    /// LIGHT_CONTROL to MATERIAL_SHININESS.
    pub light: [u32; 7],
    /// STENCIL_CONTROL, STENCIL_VALUE.
    pub stencil: [u32; 2],
}

/// A draw of triangles, lines or points.
#[derive(Clone, Copy, Debug)]
pub struct RawDraw<'a> {
    /// Vertices of a primitive: 3, 2 or 1.
    pub each: usize,
    /// All vertices.
    pub corners: &'a [Corner],
    /// State.
    pub registers: &'a Registers,
    /// Texels, palettes, lights.
    pub memory: &'a Memory,
}

/// A vertex on the screen.
struct Projected {
    vertex: Vertex,
    w: f64,
}

impl Registers {
    const fn calls(&self, effect: u32) -> bool {
        self.effects >> effect & 1 == 1
    }

    /// # Panics
    /// When the vertex would be clipped, or is not a number.
    fn project(&self, corner: &Corner, bits: u32) -> Projected {
        let rows = |m: &[f32; 16]| [0, 1, 2, 3].map(|r| [0, 1, 2, 3].map(|c| m[4 * r + c]));
        let exact = |value: f32| from_card_f32(value).expect("a number");
        let [x, y, z] = corner.position;
        let vertex = Homogeneous::from_f32([x, y, z, 1.0]);
        let vertex = vertex.and_then(|v| v.transformed(&rows(&self.object_eye))?.transformed(&rows(&self.eye_clip)));
        let [x, y, z, w] = vertex.expect("numbers").0;
        let inside = w.is_positive() && !z.is_negative() && z <= w;
        assert!(inside, "nothing is clipped here: {corner:?}");
        let screen = |k: usize, c: &BigRational| c / &w * exact(self.viewport[k]) + exact(self.viewport[3 + k]);
        let [px, py] = [screen(0, &x), screen(1, &y)].map(|pixels| snap(&pixels, 8).expect("in the guard band"));
        let z = stored_depth(&screen(2, &z), bits);
        let vertex = Vertex::at(px, py, z).coloured(corner.colour.to_le_bytes());
        Projected { vertex, w: w.to_f64().expect("a number") }
    }

    /// What becomes of the fragments' colours.
    fn shader(&self, memory: &Memory) -> Shader {
        let textured = self.calls(TEXTURE);
        Shader {
            gouraud: self.calls(GOURAUD),
            lighting: self.calls(LIGHT).then(|| Lighting::read(&self.light, memory)),
            texture: textured.then(|| Texture::read(&self.texture, memory, self.calls(MIP_MAP))),
            punch_through: (textured && self.calls(PUNCH_THROUGH)).then_some(self.punch_through as u8),
            fog: self.calls(FOG).then(|| Fog::read(&self.fog)).filter(|fog| fog.function != 0),
        }
    }

    fn test(&self) -> Test {
        let function = DepthFunction::ALL[(self.depth_control & 7) as usize];
        let function = self.calls(DEPTH).then_some(function);
        Test { function, write: self.depth_control >> 8 & 1 == 1, scissor: self.scissor, stencil: self.stencil() }
    }

    /// The stencil test, where it is called for.
    fn stencil(&self) -> Option<Stencil> {
        let [control, value] = self.stencil;
        let operations = |low: u32| [0, 4, 8].map(|more| Operation::ALL[(control >> (low + more) & 7) as usize]);
        let [reference, read_mask, write_mask, _] = value.to_le_bytes();
        self.calls(STENCIL).then(|| Stencil {
            function: DepthFunction::ALL[(control & 7) as usize],
            reference,
            read_mask,
            write_mask,
            front: operations(8),
            back: operations(20),
            colours: control >> 4 & 1 == 0,
        })
    }

    /// The blend mode of a primitive, unless it can be known to be opaque.
    fn mode(&self, alphas: impl IntoIterator<Item = u8>, texture: Option<&Texture>) -> Option<u32> {
        let opaque_texture = texture.is_none_or(|texture| texture.format == Format::Rgb565);
        let opaque = self.blend == 0 && opaque_texture && alphas.into_iter().all(|alpha| alpha == 255);
        (self.calls(BLEND) && !opaque).then_some(self.blend)
    }
}

impl Painting {
    /// Draws what a packet and the registers say.
    ///
    /// # Panics
    /// When they mean nothing, or something would have to be clipped.
    pub fn draw_raw(&mut self, draw: &RawDraw<'_>) {
        let registers = draw.registers;
        let shader = registers.shader(draw.memory);
        let normals = normal_matrix(&registers.object_eye);
        for corners in draw.corners.chunks_exact(draw.each) {
            let projected: Vec<Projected> =
                corners.iter().map(|corner| registers.project(corner, self.format().bits)).collect();
            // Points and lines have their last vertex more than once.
            let of = |k: usize| &corners[k.min(draw.each - 1)];
            let varying = Varying {
                colours: [0, 1, 2].map(|k| super::ideal(of(k).colour.to_le_bytes())),
                coordinates: [0, 1, 2].map(|k| of(k).coordinates.map(f64::from)),
                normals: [0, 1, 2].map(|k| normalised(transformed(of(k).normal.map(f64::from), &normals))),
                places: [0, 1, 2].map(|k| eye_position(of(k).position, &registers.object_eye)),
            };
            let vertex = |k: usize| projected[k].vertex;
            let primitive = match draw.each {
                3 => Primitive::Triangle([vertex(0), vertex(1), vertex(2)]),
                2 => Primitive::Line([vertex(0), vertex(1)]),
                _ => Primitive::Point(vertex(0)),
            };
            let alphas = projected.iter().map(|projected| projected.vertex.colour[3]);
            let mode = registers.mode(alphas, shader.texture.as_ref());
            let brush = Brush { test: registers.test(), mode };
            let w = |k: usize| if registers.calls(PERSPECTIVE) { projected[k].w } else { 1.0 };
            let surface = match &primitive {
                Primitive::Triangle(vertices) => Surface::new(*vertices, [w(0), w(1), w(2)]),
                _ => None,
            };
            self.draw(&primitive, &brush, |i, j| {
                let at = match (&primitive, &surface) {
                    (_, Some(surface)) => surface.at(i, j),
                    (Primitive::Line(line), _) => along(line, [w(0), w(1)], [i, j]),
                    _ => Weights::FIRST,
                };
                shader.fragment(&varying, &at)
            });
        }
    }
}

/// The parts of a line's ends at a pixel, limited to the line.
fn along(line: &[Vertex; 2], w: [f64; 2], [i, j]: [i32; 2]) -> Weights {
    let [from, to] = line.map(|v| f64::from(if is_x_major(line) { v.x } else { v.y }));
    let centre = f64::from(if is_x_major(line) { i } else { j }) * 256.0 + 128.0;
    let second = if from == to { 0.0 } else { ((centre - from) / (to - from)).clamp(0.0, 1.0) };
    let parts = [(1.0 - second) / w[0], second / w[1]];
    let sum = parts[0] + parts[1];
    Weights { weights: [parts[0] / sum, parts[1] / sum, 0.0], gradient: [[0.0; 3]; 2] }
}

#[cfg(test)]
#[path = "raw_tests.rs"]
mod tests;
