//! Texture, light and fog of a draw.

use zga_abi::format::{FogFunction, TextureFilter, TextureFormat, TextureFunction};

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
