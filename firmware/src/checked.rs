//! What packets and registers become once they are checked.
//!
//! Invariants hold by construction in [`crate::Processor`]: every address range lies in video
//! memory, every alignment is right, every enumeration has a meaning. Units do not check again.

mod compose;
mod lists;

pub(crate) use compose::are_entries;
pub use compose::{Compose, ComposeEntry, Mask, Paint, Picture, Sampled, Transform};
pub(crate) use lists::are_bitmaps;
pub use lists::{Bitmap, Canvas, ClipBox, CopyList, ExpandList, FillList, ListRectangle, Point, Segment, SegmentList};

use core::ops::Range;
use zga_abi::Effects;
use zga_abi::format::{
    BitmapFormat, BlendMode, DepthFormat, DepthFunction, EndTest, Fidelity, FogFunction, HiddenSurface, PixelFormat,
    RasterOperation, StencilOperation, StretchFilter, SubpixelDepth, SubpixelGrid, SubpixelResolve, TextureFilter,
    TextureFormat, TextureFunction, TokenColour, TokenPorts, Topology, ZaPrediction,
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

/// Stencil values in video memory, one byte a pixel; the size is that of the target.
///
/// # Invariants
/// `base` and `pitch` are multiples of 64; all `height` rows of `pitch` bytes lie in video memory
/// and apart from those of frame buffer and Z buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilSurface {
    /// First byte.
    pub base: u32,
    /// Bytes from a row to the next, at least the width.
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
    /// Sub-pixel mask unit; none where SUBPIXEL_GRID is off. Only with one do draws call for ANTI_ALIAS.
    pub subpixel: Option<SubpixelSetting>,
    /// Stencil plane, if there is one (STENCIL_PITCH is not 0). Only with one, and without a grid, do draws call for
    /// STENCIL.
    pub stencil: Option<StencilSurface>,
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

/// A stencil test: the reference OP the stored value, both masked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilTest {
    /// OP.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits that are compared.
    pub read_mask: u8,
}

/// A stencil test, and what becomes of stencil values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// The test.
    pub test: StencilTest,
    /// Bits that operations may change.
    pub write_mask: u8,
    /// Operations of the fragments of triangles whose vertices run counter-clockwise on the screen, of lines and points.
    pub front: StencilOperations,
    /// Operations of the fragments of other triangles.
    pub back: StencilOperations,
    /// Pixels that pass keep their colour.
    pub colour_off: bool,
}

/// What becomes of a pixel's stencil value when a fragment comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilOperations {
    /// It fails the stencil test.
    pub fail: StencilOperation,
    /// It passes the stencil test and fails the depth test.
    pub depth_fail: StencilOperation,
    /// It passes both.
    pub pass: StencilOperation,
}

impl StencilTest {
    /// Whether a stored value passes.
    #[must_use]
    #[inline(always)]
    pub const fn passes(&self, stored: u8) -> bool {
        let (reference, stored) = (self.reference & self.read_mask, stored & self.read_mask);
        match self.function {
            DepthFunction::Never => false,
            DepthFunction::Less => reference < stored,
            DepthFunction::Equal => reference == stored,
            DepthFunction::LessEqual => reference <= stored,
            DepthFunction::Greater => reference > stored,
            DepthFunction::NotEqual => reference != stored,
            DepthFunction::GreaterEqual => reference >= stored,
            DepthFunction::Always => true,
        }
    }
}

impl Stencil {
    /// What becomes of a stored value by an operation.
    #[must_use]
    #[inline(always)]
    pub const fn apply(&self, operation: StencilOperation, stored: u8) -> u8 {
        let result = match operation {
            StencilOperation::Keep => stored,
            StencilOperation::Zero => 0,
            StencilOperation::Replace => self.test.reference,
            StencilOperation::Increment => stored.saturating_add(1),
            StencilOperation::Decrement => stored.saturating_sub(1),
            StencilOperation::Invert => !stored,
            StencilOperation::IncrementWrap => stored.wrapping_add(1),
            StencilOperation::DecrementWrap => stored.wrapping_sub(1),
        };
        (stored & !self.write_mask) | (result & self.write_mask)
    }

    /// Whether an operation can change a value.
    #[must_use]
    pub fn changes_values(&self) -> bool {
        let all = |face: StencilOperations| [face.fail, face.depth_fail, face.pass];
        let mut operations = all(self.front).into_iter().chain(all(self.back));
        self.write_mask != 0 && operations.any(|operation| operation != StencilOperation::Keep)
    }

    /// Whether a fragment that fails a test can change a value.
    #[must_use]
    pub fn marks_failures(&self) -> bool {
        let failing = |face: StencilOperations| [face.fail, face.depth_fail];
        let mut operations = failing(self.front).into_iter().chain(failing(self.back));
        self.write_mask != 0 && operations.any(|operation| operation != StencilOperation::Keep)
    }
}

/// The shadow bit: pixels that are darkened when the opaque picture of a scene is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shadow {
    /// Pixels whose stencil value passes are in shadow.
    pub test: StencilTest,
    /// What is left of each channel, of 255.
    pub intensity: u8,
}

/// A texture in video memory, and how it is read.
///
/// # Invariants
/// All levels, and the palette where the format has one, lie in video memory; the window lies in the texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture {
    /// First byte of level 0, a multiple of 64.
    pub base: u32,
    /// Width and height of level 0, texels, 1..=16384.
    pub size: [u32; 2],
    /// How texels are stored.
    pub format: TextureFormat,
    /// Levels in memory, 1 ..= 1 + floor(log2(the larger side)).
    pub levels: u32,
    /// First byte of the palette, where the format has one.
    pub palette: u32,
    /// First texel used of level 0.
    pub offset: [u32; 2],
    /// Texels used of level 0, at least 1.
    pub window: [u32; 2],
    /// Repeated in x and y.
    pub repeat: [bool; 2],
    /// Mirrored at every other repetition in x and y.
    pub mirror: [bool; 2],
    /// How it is read between texels.
    pub filter: TextureFilter,
    /// How it is combined with the polygon's colour.
    pub function: TextureFunction,
    /// RGBA of the function `blend`.
    pub colour: u32,
    /// s7.8, levels: added to the level of detail.
    pub bias: i32,
    /// MIP_MAP is called: levels beyond the first are in use.
    pub mip_map: bool,
}

impl Texture {
    /// Width and height of level `level`, texels.
    #[must_use]
    pub const fn level_size(&self, level: u32) -> [u32; 2] {
        [level_side(self.size[0], level), level_side(self.size[1], level)]
    }

    /// Words of a row of level `level`.
    #[must_use]
    pub const fn row_words(&self, level: u32) -> u32 {
        (self.level_size(level)[0] * self.format.bits()).div_ceil(32)
    }

    /// First byte of level `level`, counted from `base`; of the first level that is not there, the size of the texture in
    /// bytes, rounded up to 64.
    #[must_use]
    pub const fn level_offset(&self, level: u32) -> u64 {
        let (mut offset, mut below) = (0, 0);
        while below < level {
            let bytes = 4 * self.row_words(below) as u64 * self.level_size(below)[1] as u64;
            offset += bytes.next_multiple_of(64);
            below += 1;
        }
        offset
    }

    /// Bytes of all levels, from `base` on.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        let last = self.levels - 1;
        self.level_offset(last) + 4 * self.row_words(last) as u64 * self.level_size(last)[1] as u64
    }
}

/// Texels along a side of level `level`.
const fn level_side(side: u32, level: u32) -> u32 {
    if side >> level == 0 { 1 } else { side >> level }
}

/// Lights and the material they fall on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// At each pixel shaded; else at each vertex.
    pub per_pixel: bool,
    /// Normals that point away from the viewer are turned round.
    pub two_sided: bool,
    /// Highlights are seen from the eye; else from infinity along +z.
    pub local_viewer: bool,
    /// First byte of the light records, a multiple of 64; all of them lie in video memory.
    pub lights: u32,
    /// Lights, 0..=256.
    pub count: u32,
    /// RGBA of the light that is everywhere.
    pub ambient: u32,
    /// RGBA of highlights.
    pub specular: u32,
    /// RGBA that the material gives off.
    pub emission: u32,
    /// Sharpness of highlights, 0..=128.
    pub shininess: f32,
}

/// Fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Never [`FogFunction::None`].
    pub function: FogFunction,
    /// Finite, not negative.
    pub density: f32,
    /// Finite, positive.
    pub end: f32,
    /// kz, finite.
    pub cue_scale: f32,
    /// cz, finite.
    pub cue_offset: f32,
    /// RGBA.
    pub colour: u32,
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

/// Pixels in video memory for the bitmap unit, in any of its formats.
///
/// # Invariants
/// `base` and `pitch` are multiples of the pixel's bytes; `pitch` holds a row, so rows lie apart;
/// `base + (height - 1) * pitch + width * format.bytes()` lies in video memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// First byte of the first pixel.
    pub base: u32,
    /// Bytes from a row to the next.
    pub pitch: u32,
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
    /// Format of a pixel.
    pub format: BitmapFormat,
}

impl Image {
    /// From its first byte to the first beyond its last row.
    #[must_use]
    pub const fn bytes(&self) -> Range<u64> {
        self.row(0).start..self.row(self.height as u64 - 1).end
    }

    /// Bytes of row `row`.
    #[must_use]
    pub const fn row(&self, row: u64) -> Range<u64> {
        let start = self.base as u64 + row * self.pitch as u64;
        start..start + self.width as u64 * self.format.bytes() as u64
    }

    /// A byte is a pixel's of both; gaps between rows do not count.
    #[must_use]
    pub const fn shares_bytes(&self, other: &Image) -> bool {
        let (mut mine, mut others) = (0, 0);
        // Both sets of rows rise: the one that ends first meets nothing more of the other.
        while mine < self.height as u64 && others < other.height as u64 {
            let (a, b) = (self.row(mine), other.row(others));
            if a.end <= b.start {
                mine += 1;
            } else if b.end <= a.start {
                others += 1;
            } else {
                return true;
            }
        }
        false
    }
}

/// What a raster operation takes for the source bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CombineSource {
    /// The same stored pixel everywhere; bits beyond the format do not count.
    Value(u32),
    /// A rectangle of the destination's size and format; overlap must come out right.
    Image(Image),
}

/// A raster operation on a rectangle.
///
/// # Invariants
/// It changes something: the operation is not no-operation, and `planes` has a bit of the format and none beyond.
/// The source is an image only where the operation reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Combine {
    /// From.
    pub source: CombineSource,
    /// To: `base` is the first pixel written.
    pub destination: Image,
    /// What becomes of a bit.
    pub operation: RasterOperation,
    /// Bits of the stored pixel that may change.
    pub planes: u32,
}

impl Combine {
    /// What is there has to be read: the operation depends on it, or some of its bits stay.
    #[must_use]
    pub const fn reads_destination(&self) -> bool {
        self.operation.reads_destination() || self.planes != self.destination.format.bits()
    }
}

/// A copy between two rectangles of the same size; overlap must come out right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convert {
    /// From: `base` is the first pixel read.
    pub source: Image,
    /// To: `base` is the first pixel written.
    pub destination: Image,
}

/// A stretch of a rectangle over a whole of another size, of which a part is written.
///
/// # Invariants
/// The part lies in the whole, and shares no byte with the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stretch {
    /// From: all of it is stretched over the whole.
    pub source: Image,
    /// To: the part.
    pub destination: Image,
    /// Width and height of the whole, pixels, 1..=16384.
    pub whole: [u32; 2],
    /// Column and row of the part's first pixel in the whole.
    pub part: [u32; 2],
    /// How it is read between pixels.
    pub filter: StretchFilter,
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
