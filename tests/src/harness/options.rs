//! How a card is built and how it draws.

use super::hidden::Hidden;
use super::look::Look;
use super::packet::{
    EFFECT_ANTI_ALIAS, EFFECT_BLEND, EFFECT_DECAL, EFFECT_DEPTH, EFFECT_GOURAUD, EFFECT_PERSPECTIVE, EFFECT_STENCIL,
};
use super::subpixel::Subpixel;
use crate::oracle::stencil::{Operation, Shadow, Stencil};
use crate::oracle::{DepthFormat, DepthFunction};
use std::fmt;
use zga_device::Kernel;

/// Which way packets go to the card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Feed {
    /// The ring in video memory.
    #[default]
    Ring,
    /// The PIO FIFO.
    Fifo,
}

/// Format of the frame buffer; the number is the register's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pixels {
    /// 31:24 written as 255, then red, green, blue.
    #[default]
    Xrgb8888 = 0,
    /// Alpha, red, green, blue.
    Argb8888 = 1,
    /// 15:11 red, 10:5 green, 4:0 blue.
    Rgb565 = 2,
}

impl Pixels {
    /// Bytes of a pixel.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        match self {
            Self::Xrgb8888 | Self::Argb8888 => 4,
            Self::Rgb565 => 2,
        }
    }

    /// The vertex colour (red in 7:0) whose stored pixel is `id` in its low bits.
    #[must_use]
    pub const fn colour_of(self, id: u32) -> u32 {
        let (r, g, b) = match self {
            Self::Xrgb8888 | Self::Argb8888 => (id >> 16 & 255, id >> 8 & 255, id & 255),
            Self::Rgb565 => ((id >> 11 & 31) << 3, (id >> 5 & 63) << 2, (id & 31) << 3),
        };
        r | g << 8 | b << 16 | 0xFF00_0000
    }

    /// The identity in a stored pixel.
    #[must_use]
    pub const fn id_of(self, pixel: u32) -> u32 {
        match self {
            Self::Xrgb8888 | Self::Argb8888 => pixel & 0x00FF_FFFF,
            Self::Rgb565 => pixel & 0xFFFF,
        }
    }
}

/// A card and its target.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Number format of depth.
    pub depth: DepthFormat,
    /// Format of the frame buffer.
    pub pixels: Pixels,
    /// Pixel code.
    pub kernel: Kernel,
    /// Host threads.
    pub threads: usize,
    /// Bits of a pixel that coordinates are snapped to.
    pub subpixel_bits: u32,
    /// Which way packets go.
    pub feed: Feed,
    /// Bytes of video memory for [`super::Screen::draw_buffer`].
    pub vertex_bytes: u32,
    /// Bytes of video memory for textures, palettes and lights.
    pub texture_bytes: u32,
    /// Who decides visibility, and how.
    pub hidden: Hidden,
    /// Samples of a pixel.
    pub subpixel: Subpixel,
    /// There is a Z buffer.
    pub depth_buffer: bool,
    /// There is a stencil plane.
    pub stencil: bool,
    /// Frame buffers, 1 or 2; they share the Z buffer.
    pub frames: u32,
}

impl Options {
    /// Whether depth can be tested.
    #[must_use]
    pub const fn has_depth(&self) -> bool {
        self.depth_buffer || self.hidden.path.keeps_depths()
    }
}

impl Default for Options {
    /// XRGB8888, 24 bits of depth with 24 fraction bits, 8 sub-pixel bits, one thread, the best kernel, the ring,
    /// the plain Z buffer, one sample a pixel, one frame.
    fn default() -> Self {
        Self {
            depth: DepthFormat::default(),
            pixels: Pixels::default(),
            kernel: Kernel::Best,
            threads: 1,
            subpixel_bits: 8,
            feed: Feed::Ring,
            vertex_bytes: 0,
            texture_bytes: 0,
            hidden: Hidden::default(),
            subpixel: Subpixel::default(),
            depth_buffer: true,
            stencil: false,
            frames: 1,
        }
    }
}

/// The geometry registers. Matrices are row-major for row vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Object to eye.
    pub object_eye: [f32; 16],
    /// Decal transform in eye space.
    pub decal: [f32; 16],
    /// Eye to clip space.
    pub eye_clip: [f32; 16],
    /// Scale x, y, z, offset x, y, z.
    pub viewport: [f32; 6],
}

/// The identity matrix.
pub const IDENTITY: [f32; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

impl Default for Camera {
    /// Object coordinates are pixels and depth.
    fn default() -> Self {
        Self { object_eye: IDENTITY, decal: IDENTITY, eye_clip: IDENTITY, viewport: [1., 1., 1., 0., 0., 0.] }
    }
}

impl Camera {
    /// An eye that looks down -z at a target of this size: near plane 1, far plane 1024, 90 degrees across and down, y up.
    #[must_use]
    pub fn perspective([width, height]: [u32; 2]) -> Self {
        let depth = -1024.0 / 1023.0;
        let [x, y] = [width, height].map(|side| side as f32 / 2.0);
        Self {
            eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., depth, -1., 0., 0., depth, 0.],
            viewport: [x, -y, 1., x, y, 0.],
            ..Self::default()
        }
    }

    /// The words of the registers.
    #[must_use]
    pub fn words(&self) -> Vec<u32> {
        let all = [&self.object_eye[..], &self.decal, &self.eye_clip, &self.viewport];
        all.concat().into_iter().map(f32::to_bits).collect()
    }
}

/// State of a draw.
#[derive(Clone, Copy, PartialEq)]
pub struct State {
    /// Whether depth is tested at all.
    pub depth_test: bool,
    /// Depth test.
    pub function: DepthFunction,
    /// Whether a passing depth is stored.
    pub write: bool,
    /// Colours interpolated.
    pub gouraud: bool,
    /// Colours interpolated perspective-correct.
    pub perspective: bool,
    /// Depth through the decal matrix.
    pub decal: bool,
    /// Sub-pixel masks; only with a grid.
    pub anti_alias: bool,
    /// Translucent layers.
    pub blend: bool,
    /// Width of lines drawn with masks, u8.8 pixels.
    pub line_width: u32,
    /// Side of points drawn with masks, u8.8 pixels.
    pub point_size: u32,
    /// Left, top, right, bottom in pixels, the last two exclusive; all of the target without it.
    pub scissor: Option<[u32; 4]>,
    /// Stencil test, where it is called for.
    pub stencil: Option<Stencil>,
    /// Geometry registers.
    pub camera: Camera,
    /// Texture, holes, blend mode, fog, light.
    pub look: Look,
    /// Most primitives of a packet; 0 puts in all that fit.
    pub piece: usize,
}

impl Default for State {
    /// Depth test less, written; flat colours; no masks or layers, lines and points one pixel wide; the identity camera.
    fn default() -> Self {
        Self {
            depth_test: true,
            function: DepthFunction::Less,
            write: true,
            gouraud: false,
            perspective: false,
            decal: false,
            anti_alias: false,
            blend: false,
            line_width: 0x100,
            point_size: 0x100,
            scissor: None,
            stencil: None,
            camera: Camera::default(),
            look: Look::default(),
            piece: 0,
        }
    }
}

impl fmt::Debug for State {
    /// The camera only where it is not the identity.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { depth_test, function, write, scissor, camera, look, piece, line_width, point_size, .. } = self;
        write!(f, "State {{ depth test {depth_test}, {function:?}, write {write}, scissor {scissor:?}, ")?;
        write!(f, "effects {:#x}, pieces of {piece}", self.effects())?;
        if (*line_width, *point_size) != (0x100, 0x100) {
            write!(f, ", lines {line_width:#x}, points {point_size:#x}")?;
        }
        if let Some(stencil) = &self.stencil {
            write!(f, ", {stencil:?}")?;
        }
        if *look != Look::default() {
            write!(f, ", {look:?}")?;
        }
        if *camera == Camera::default() { write!(f, " }}") } else { write!(f, ", {camera:?} }}") }
    }
}

impl State {
    /// The default with another depth function.
    #[must_use]
    pub fn with(function: DepthFunction) -> Self {
        Self { function, ..Self::default() }
    }

    /// The EFFECTS register.
    #[must_use]
    pub fn effects(&self) -> u32 {
        let bit = |on: bool, mask: u32| if on { mask } else { 0 };
        bit(self.depth_test, EFFECT_DEPTH)
            | bit(self.gouraud, EFFECT_GOURAUD)
            | bit(self.perspective, EFFECT_PERSPECTIVE)
            | bit(self.decal, EFFECT_DECAL)
            | bit(self.blend, EFFECT_BLEND)
            | bit(self.anti_alias, EFFECT_ANTI_ALIAS)
            | bit(self.stencil.is_some(), EFFECT_STENCIL)
            | self.look.effects()
    }

    /// The default with translucent layers.
    #[must_use]
    pub fn blended(mode: u32) -> Self {
        Self { blend: true, look: Look { mode, ..Look::default() }, ..Self::default() }
    }

    /// The default with this look, perspective-correct.
    #[must_use]
    pub fn looking(look: Look) -> Self {
        Self { perspective: true, look, ..Self::default() }
    }

    /// The default with sub-pixel masks.
    #[must_use]
    pub fn masked() -> Self {
        Self { anti_alias: true, ..Self::default() }
    }

    /// Words of STENCIL_CONTROL and STENCIL_VALUE.
    #[must_use]
    pub fn stencil_words(stencil: &Stencil) -> [u32; 2] {
        let operations = |of: [Operation; 3], low: u32| {
            let code = |operation| Operation::ALL.iter().position(|&other| other == operation).unwrap_or(0) as u32;
            of.into_iter().map(code).enumerate().fold(0, |word, (k, code)| word | code << (low + 4 * k as u32))
        };
        let control = function_code(stencil.function)
            | u32::from(!stencil.colours) << 4
            | operations(stencil.front, 8)
            | operations(stencil.back, 20);
        [control, u32::from_le_bytes([stencil.reference, stencil.read_mask, stencil.write_mask, 0])]
    }

    /// Words of effects, depth control, material colour, tag, scissor minimum and maximum, line width, point size.
    #[must_use]
    pub fn words(&self) -> [u32; 8] {
        let function = function_code(self.function);
        let [left, top, right, bottom] = self.scissor.unwrap_or([0, 0, 0x7FFF, 0x7FFF]);
        let control = function | u32::from(self.write) << 8;
        let (first, last) = (top << 16 | left, bottom << 16 | right);
        [self.effects(), control, u32::MAX, 0, first, last, self.line_width, self.point_size]
    }
}

/// The number of a function in a register.
pub(super) fn function_code(function: DepthFunction) -> u32 {
    DepthFunction::ALL.iter().position(|&other| other == function).unwrap_or(0) as u32
}

/// Words of SHADOW_CONTROL and SHADOW_INTENSITY; disabled without a shadow.
#[must_use]
pub fn shadow_words(shadow: Option<&Shadow>) -> [u32; 2] {
    shadow.map_or([0, 0], |shadow| {
        let values = u32::from(shadow.reference) << 8 | u32::from(shadow.mask) << 16;
        [1 | function_code(shadow.function) << 4 | values, u32::from(shadow.intensity)]
    })
}
