//! What packets and registers become once they are checked.
//!
//! Invariants hold by construction in [`crate::Processor`]: every address range lies in video
//! memory, every alignment is right, every enumeration has a meaning. Units do not check again.

use core::ops::Range;
use zga_abi::Effects;
use zga_abi::format::{
    DepthFormat, DepthFunction, EndTest, Fidelity, HiddenSurface, PixelFormat, SubpixelDepth, SubpixelGrid,
    SubpixelResolve, TokenColour, TokenPorts, Topology, ZaPrediction,
};

/// A rectangle of pixels: `x`, `y` inclusive, `right`, `bottom` exclusive.
///
/// # Invariants
/// `x <= right` and `y <= bottom`; it is empty where they are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// First column beyond.
    pub right: u32,
    /// First row beyond.
    pub bottom: u32,
}

/// Pixels in video memory.
///
/// # Invariants
/// `base + (height - 1) * pitch + width * format.bytes()` lies in video memory; for render and
/// scan-out targets `base` and `pitch` are multiples of 64, so a row holds whole chunks of 16 words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next.
    pub pitch: u32,
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
    /// Format of a pixel.
    pub format: PixelFormat,
}

impl Surface {
    /// From its first byte to the first beyond its last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        let rows = (self.height as u64 - 1) * self.pitch as u64 + self.width as u64 * self.format.bytes() as u64;
        self.base as u64..self.base as u64 + rows
    }
}

/// Depths in video memory, one 32-bit word a pixel; the size is that of the target.
///
/// # Invariants
/// `base` and `pitch` are multiples of 64; all `height` rows of `pitch` bytes lie in video memory
/// and apart from the frame buffer's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthSurface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next, at least 4 times the width.
    pub pitch: u32,
}

/// What a scene draws to, and how; fixed from begin scene to end scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Frame buffer. All `height` rows of `pitch` bytes lie in video memory.
    pub colour: Surface,
    /// Z buffer, if there is one (DEPTH_PITCH is not 0).
    pub depth: Option<DepthSurface>,
    /// Number format of depth.
    pub depth_format: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to: 4 or 8.
    pub subpixel_bits: u32,
    /// Who decides visibility.
    pub hidden_surface: HiddenSurface,
    /// How units with a clocked model are simulated.
    pub fidelity: Fidelity,
    /// Za unit; on the Za path the frame's words lie in Za RAM.
    pub za: ZaSetting,
    /// Systolic array.
    pub systolic: SystolicSetting,
    /// Width and height of a tile of the tile unit, pixels: 4, 8, 16, 32 or 64.
    pub tile: [u32; 2],
    /// Sub-pixel mask unit; none where SUBPIXEL_GRID is off. Only with one do draws call for ANTI_ALIAS or BLEND.
    pub subpixel: Option<SubpixelSetting>,
}

impl Target {
    /// Depth can be tested and cleared: there is a Z buffer, or the path keeps depths in its own registers.
    #[must_use]
    pub const fn has_depth(&self) -> bool {
        self.depth.is_some() || self.is_sorted()
    }

    /// The path sorts a scene before it decides what is seen: it keeps depths in registers of its own.
    #[must_use]
    pub const fn is_sorted(&self) -> bool {
        matches!(self.hidden_surface, HiddenSurface::Systolic | HiddenSurface::Tile)
    }
}

/// The Za unit's registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ZaSetting {
    /// First word in Za RAM, a multiple of 16.
    pub base: u32,
    /// Width and height of a block, pixels, each 1..=16384.
    pub block: [u32; 2],
    /// How the least depth of a primitive in a block is predicted.
    pub prediction: ZaPrediction,
    /// Blocks behind the prediction are bypassed.
    pub bypass: bool,
}

impl Default for ZaSetting {
    /// As published: blocks of 32 pixels of a row, prediction over the length of a block.
    fn default() -> Self {
        ZaSetting { base: 0, block: [32, 1], prediction: ZaPrediction::BlockLength, bypass: true }
    }
}

impl ZaSetting {
    /// Blocks across and down a picture of `width` x `height` pixels; those at the edges are cut by it.
    #[must_use]
    pub const fn blocks(&self, width: u32, height: u32) -> [u32; 2] {
        [width.div_ceil(self.block[0]), height.div_ceil(self.block[1])]
    }
}

/// The variant of the systolic array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SystolicSetting {
    /// When a segment begins or ends.
    pub end_test: EndTest,
    /// How X and dX enter.
    pub ports: TokenPorts,
    /// What a token carries for the picture.
    pub colour: TokenColour,
    /// The earlier design, Super Buffer, in place of the array.
    pub super_buffer: bool,
}

impl Default for SystolicSetting {
    fn default() -> Self {
        SystolicSetting {
            end_test: EndTest::Negative,
            ports: TokenPorts::Swapped,
            colour: TokenColour::Tag,
            super_buffer: false,
        }
    }
}

/// The sub-pixel mask unit's registers, where there is a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SubpixelSetting {
    /// Samples of a pixel; never [`SubpixelGrid::Off`].
    pub grid: SubpixelGrid,
    /// How fragments that share samples are ordered.
    pub depth: SubpixelDepth,
    /// Space in which samples are averaged.
    pub resolve: SubpixelResolve,
    /// Fragments that the lists of one line of pixels have room for, 1..=2^20.
    pub pool: u32,
}

/// State of one draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawState {
    /// Effects called; DEPTH only where the target has a Z buffer or the path needs none, ANTI_ALIAS and
    /// BLEND only where the target has a grid.
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
    /// Vertex words: `vertex_count` times 3 or 4.
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
    /// Pixels to clear: the scissor cut to the target; can be empty.
    pub area: Rectangle,
}

/// A rectangle of one stored pixel value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fill {
    /// Pixels to fill: `base` is the first of them, a multiple of the pixel's bytes, as is `pitch`.
    pub surface: Surface,
    /// Stored value; the low 16 bits for 16-bit formats.
    pub value: u32,
}

/// A copy between two surfaces of the same format and size; overlap must come out right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copy {
    /// From: `base` is the first pixel copied.
    pub source: Surface,
    /// To: `base` is the first pixel written.
    pub destination: Surface,
}

/// Rows of words in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rows {
    /// First byte, a multiple of 4.
    pub address: u32,
    /// Bytes from a row to the next, a multiple of 4.
    pub pitch: u32,
    /// Words of a row.
    pub words: u32,
    /// Rows.
    pub rows: u32,
}

impl Rows {
    /// From the first byte to the first beyond the last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        let before = (self.rows as u64).saturating_sub(1) * self.pitch as u64;
        self.address as u64..self.address as u64 + before + 4 * self.words as u64
    }

    /// The bytes of all rows' words in one run from byte `address` on.
    #[must_use]
    pub const fn run_at(&self, address: u32) -> Range<u64> {
        address as u64..address as u64 + 4 * self.words as u64 * self.rows as u64
    }
}
