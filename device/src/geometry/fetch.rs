//! Vertex and index words, in the packet or in video memory, as plain slices.
//!
//! Where light falls on vertices, each is asked for once, lit ([`Fetch::lit_vertex`]), before primitives are assembled.
//!
//! The firmware has checked that the words are there and that each index named a vertex when it
//! looked. The host may have written over an index since: such an index reads as the last vertex,
//! so that no fetch leaves the vertex words.

use crate::built::{Key, LightKey};
use crate::shading::light::Lights;
use crate::shading::parameters::{ParameterTransform, Parameters, VertexParameters};
use zga_abi::format::Topology;
use zga_firmware::checked::{Draw, Words};

/// Light that falls on vertices.
#[derive(Clone, Debug)]
pub struct VertexLight {
    /// The lights.
    pub lights: Lights,
    /// To eye space.
    pub transform: ParameterTransform,
}

/// A draw's words, borrowed from packet or video memory.
#[derive(Clone, Copy, Debug)]
pub struct Fetch<'a> {
    vertices: &'a [u32],
    stride: usize,
    indices: Option<&'a [u32]>,
    last: usize,
    material: u32,
    /// The word after the position is a colour.
    coloured: bool,
    /// Words before a vertex's normal and texture coordinates; none without.
    normal: Option<usize>,
    coordinates: Option<usize>,
    light: Option<&'a VertexLight>,
}

/// A vertex as it stands in memory.
#[derive(Clone, Copy, Debug)]
pub struct RawVertex {
    /// Object space.
    pub position: [f32; 3],
    /// RGBA, R in 7:0.
    pub colour: u32,
}

impl<'a> Fetch<'a> {
    /// Finds the words of `draw`.
    #[must_use]
    pub fn new(memory: &'a [u32], draw: &Draw<'a>, material: u32, light: Option<&'a VertexLight>) -> Fetch<'a> {
        let words = |words: Words<'a>| match words {
            Words::Inline(words) => words,
            Words::Memory { address, words } => &memory[address as usize / 4..][..words as usize],
        };
        let normal = 3 + usize::from(draw.coloured);
        let coordinates = normal + if draw.normals { 3 } else { 0 };
        Fetch {
            vertices: words(draw.vertices),
            stride: coordinates + if draw.coordinates { 2 } else { 0 },
            indices: draw.indices.map(words),
            last: (draw.vertex_count as usize).saturating_sub(1),
            material,
            coloured: draw.coloured,
            normal: draw.normals.then_some(normal),
            coordinates: draw.coordinates.then_some(coordinates),
            light,
        }
    }

    /// Vertices are shared by indices.
    #[must_use]
    pub fn indexed(&self) -> bool {
        self.indices.is_some()
    }

    /// Number of vertices in memory.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices.len() / self.stride
    }

    /// Number of vertices or indices that make primitives.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.indices.map_or_else(|| self.vertices(), <[u32]>::len)
    }

    /// Which vertex element `element` is.
    #[must_use]
    #[inline(always)]
    pub fn vertex_of(&self, element: usize) -> usize {
        self.indices.map_or(element, |indices| (indices[element] as usize).min(self.last))
    }

    /// Vertex number `vertex`, as it stands. Denormals read as 0, infinities as the largest finite number.
    #[must_use]
    #[inline(always)]
    pub fn vertex(&self, vertex: usize) -> RawVertex {
        let words = &self.vertices[vertex * self.stride..][..self.stride];
        // A vertex has three words at least, and its colour after them if it has one: read so, none is looked for apart.
        let (position, rest) = words.split_first_chunk().unwrap_or((&[0; 3], &[]));
        let colour = if self.coloured { rest.first().copied() } else { None };
        RawVertex { position: position.map(number), colour: colour.unwrap_or(self.material) }
    }

    /// Light falls on the vertices.
    #[must_use]
    pub fn is_lit(&self) -> bool {
        LightKey::built().is_some() && self.light.is_some()
    }

    /// Vertex number `vertex` in the light that falls on it, if any does.
    #[must_use]
    pub fn lit_vertex(&self, vertex: usize) -> RawVertex {
        let raw = self.vertex(vertex);
        let (Some(light), Some(_)) = (self.light, LightKey::built()) else {
            return raw;
        };
        let carried = self.parameters(vertex);
        let position = light.transform.eye_position(raw.position).map(|c| c as f32);
        let normal = light.transform.eye_normal(carried.normal).map(|c| c as f32);
        RawVertex { colour: light.lights.lit(raw.colour, position, normal), ..raw }
    }

    /// What vertex number `vertex` carries.
    #[must_use]
    fn parameters(&self, vertex: usize) -> VertexParameters {
        let words = &self.vertices[vertex * self.stride..][..self.stride];
        let at = |first: usize, k: usize| number(words[first + k]);
        VertexParameters {
            position: [0, 1, 2].map(|k| at(0, k)),
            normal: self.normal.map_or([0.0; 3], |first| [0, 1, 2].map(|k| at(first, k))),
            coordinates: self.coordinates.map_or([0.0; 2], |first| [0, 1].map(|k| at(first, k))),
        }
    }

    /// What the vertices of primitive `number` carry.
    #[must_use]
    pub fn primitive(&self, topology: Topology, number: u32) -> Parameters {
        let n = number as usize;
        let elements = match topology {
            Topology::Triangles => [3 * n, 3 * n + 1, 3 * n + 2],
            Topology::Lines => [2 * n, 2 * n + 1, 2 * n + 1],
            Topology::LineStrip => [n, n + 1, n + 1],
            Topology::Points => [n; 3],
        };
        elements.map(|element| self.parameters(self.vertex_of(element)))
    }
}

/// The card's reading of an f32: denormals are 0, infinities the largest finite number, NaN stays.
#[inline(always)]
fn number(bits: u32) -> f32 {
    let magnitude = bits & 0x7FFF_FFFF;
    match magnitude {
        0..0x0080_0000 => 0.0,
        0x7F80_0000 => f32::from_bits(bits - 1),
        _ => f32::from_bits(bits),
    }
}
