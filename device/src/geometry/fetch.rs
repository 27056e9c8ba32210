//! Vertex and index words, in the packet or in video memory, as plain slices.
//!
//! The firmware has checked that the words are there and that each index named a vertex when it
//! looked. The host may have written over an index since: such an index reads as the last vertex,
//! so that no fetch leaves the vertex words.

use zga_firmware::checked::{Draw, Words};

/// A draw's words, borrowed from packet or video memory.
#[derive(Clone, Copy, Debug)]
pub struct Fetch<'a> {
    vertices: &'a [u32],
    stride: usize,
    indices: Option<&'a [u32]>,
    last: usize,
    material: u32,
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
    pub fn new(memory: &'a [u32], draw: &Draw<'a>, material: u32) -> Fetch<'a> {
        let words = |words: Words<'a>| match words {
            Words::Inline(words) => words,
            Words::Memory { address, words } => &memory[address as usize / 4..][..words as usize],
        };
        Fetch {
            vertices: words(draw.vertices),
            stride: if draw.coloured { 4 } else { 3 },
            indices: draw.indices.map(words),
            last: (draw.vertex_count as usize).saturating_sub(1),
            material,
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

    /// Vertex number `vertex`. Denormals read as 0, infinities as the largest finite number.
    #[must_use]
    #[inline(always)]
    pub fn vertex(&self, vertex: usize) -> RawVertex {
        let words = &self.vertices[vertex * self.stride..][..self.stride];
        let colour = if self.stride == 4 { words[3] } else { self.material };
        RawVertex { position: [number(words[0]), number(words[1]), number(words[2])], colour }
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
