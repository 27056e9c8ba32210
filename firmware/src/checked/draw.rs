//! A draw: its state, its vertices and indices; a clear.

use super::{Fog, Lighting, Rectangle, Stencil, Texture};
use zga_abi::Effects;
use zga_abi::format::{BlendMode, DepthFunction, Topology};

/// State of one draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawState {
    /// Effects called; DEPTH only where the target has a Z buffer or the path needs none, ANTI_ALIAS only where the
    /// target has a grid.
    pub effects: Effects,
    /// Depth test.
    pub depth_function: DepthFunction,
    /// A passing fragment's depth is stored.
    pub depth_write: bool,
    /// RGBA of primitives without vertex colours, R in 7:0.
    pub material_colour: u32,
    /// Object tag.
    pub tag: u32,
    /// Pixels that may change: the scissor cut to the target; can be empty.
    pub scissor: Rectangle,
    /// Width of lines drawn with ANTI_ALIAS: u8.8, pixels, 1..=0xFFFF.
    pub line_width: u32,
    /// Side of points drawn with ANTI_ALIAS: u8.8, pixels, 1..=0xFFFF.
    pub point_size: u32,
    /// Where TEXTURE is called: the texture.
    pub texture: Option<Texture>,
    /// Where PUNCH_THROUGH is called, and TEXTURE with it: texels with an alpha below this are holes.
    pub punch_through: Option<u8>,
    /// Where LIGHT is called: lights and material.
    pub light: Option<Lighting>,
    /// Where FOG is called and its function is not none: fog.
    pub fog: Option<Fog>,
    /// How translucent fragments are combined, where BLEND is called.
    pub blend: BlendMode,
    /// Where STENCIL is called: the stencil test. With BLEND it changes no value and draws colours.
    pub stencil: Option<Stencil>,
}

/// A run of words, in the packet or in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words<'a> {
    /// In the packet.
    Inline(&'a [u32]),
    /// In video memory.
    Memory {
        /// First byte, a multiple of 4.
        address: u32,
        /// Number of words; the whole run lies in video memory.
        words: u32,
    },
}

/// Primitives to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw<'a> {
    /// How vertices make primitives.
    pub topology: Topology,
    /// A vertex is x, y, z (f32 bits) and, if set, a colour word.
    pub coloured: bool,
    /// Then, if set, a normal: 3 f32.
    pub normals: bool,
    /// Then, if set, texture coordinates: 2 f32.
    pub coordinates: bool,
    /// Vertex words: `vertex_count` times those of a vertex.
    pub vertices: Words<'a>,
    /// Number of vertices.
    pub vertex_count: u32,
    /// Indices, each less than `vertex_count` when the draw was checked.
    pub indices: Option<Words<'a>>,
}

/// A clear inside a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clear {
    /// Colour for the frame buffer, RGBA with R in 7:0.
    pub colour: Option<u32>,
    /// Depth to clear to, at most the format's maximum; only where the target has a Z buffer or the path needs none.
    pub depth: Option<u32>,
    /// Value for the stencil plane; only where the target has one.
    pub stencil: Option<u8>,
    /// Pixels to clear: the scissor cut to the target; can be empty.
    pub area: Rectangle,
}
