//! What a draw's colours are made of: the registers of texture, blending, fog and light, and what they point to.
//!
//! Textures, palettes and lights lie in a region of video memory of their own ([`super::Options::texture_bytes`]); the
//! addresses here count from its start.

use super::options::State;
use super::packet::{EFFECT_FOG, EFFECT_LIGHT, EFFECT_MIP_MAP, EFFECT_PUNCH_THROUGH, EFFECT_TEXTURE};
use super::random::Random;
use crate::oracle::effects::raw::Registers;
use crate::oracle::effects::texel::{Filter, Format, level_offset, level_words};

/// A texture; words of TEXTURE_BASE to PALETTE_BASE.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// First byte of level 0, a multiple of 64.
    pub base: u32,
    /// Of level 0, texels.
    pub size: [u32; 2],
    /// How texels are stored.
    pub format: Format,
    /// Between texels.
    pub filter: Filter,
    /// 0 replace, 1 modulate, 2 decal, 3 blend.
    pub function: u32,
    /// In x and y.
    pub repeat: [bool; 2],
    /// In x and y.
    pub mirror: [bool; 2],
    /// In memory.
    pub levels: u32,
    /// First texel used.
    pub offset: [u32; 2],
    /// Texels used; 0: to the end.
    pub window: [u32; 2],
    /// Red in 7:0.
    pub constant: u32,
    /// 1/256 levels.
    pub bias: i16,
    /// First byte of the palette, a multiple of 64.
    pub palette: u32,
}

impl Default for Sampler {
    /// As the card resets them: one texel, modulate.
    fn default() -> Self {
        Self {
            base: 0,
            size: [1, 1],
            format: Format::Rgba8888,
            filter: Filter::Nearest,
            function: 1,
            repeat: [false; 2],
            mirror: [false; 2],
            levels: 1,
            offset: [0; 2],
            window: [0; 2],
            constant: 0,
            bias: 0,
            palette: 0,
        }
    }
}

impl Sampler {
    /// Bytes of all levels.
    #[must_use]
    pub fn bytes(&self) -> u32 {
        let last = self.levels - 1;
        let extent = crate::oracle::effects::texel::extent(self.size, last);
        level_offset(self.format, self.size, last) + 4 * level_words(self.format, extent)
    }

    /// A texture of noise with all of its levels and a palette behind it, and the region's words.
    #[must_use]
    pub fn noise(random: &mut Random, format: Format, size: [u32; 2]) -> (Self, Vec<u32>) {
        let levels = 1 + size[0].max(size[1]).ilog2();
        let sampler = Self { size, format, levels, ..Self::default() };
        let palette = sampler.bytes().next_multiple_of(64);
        let words = (0..palette / 4 + 256).map(|_| random.bits() as u32).collect();
        (Self { palette, ..sampler }, words)
    }

    /// A texture whose level k is all of colour k, and the region's words.
    #[must_use]
    pub fn plain_levels(size: [u32; 2], colours: &[u32]) -> (Self, Vec<u32>) {
        let sampler = Self { size, levels: colours.len() as u32, function: 0, ..Self::default() };
        let mut words = Vec::new();
        for (level, colour) in (0..).zip(colours) {
            words.resize(level_offset(sampler.format, size, level) as usize / 4, 0);
            let count = level_words(sampler.format, crate::oracle::effects::texel::extent(size, level));
            words.extend(std::iter::repeat_n(*colour, count as usize));
        }
        (sampler, words)
    }

    fn words(&self, region: u32) -> [u32; 8] {
        let pair = |[x, y]: [u32; 2]| y << 16 | x;
        let flags = |[x, y]: [bool; 2]| u32::from(x) | u32::from(y) << 1;
        let control = self.format as u32
            | (self.filter as u32) << 4
            | self.function << 8
            | flags(self.repeat) << 12
            | flags(self.mirror) << 14
            | self.levels << 16;
        [
            region + self.base,
            pair(self.size),
            control,
            pair(self.offset),
            pair(self.window),
            self.constant,
            u32::from(self.bias as u16),
            region + self.palette,
        ]
    }
}

/// FOG_CONTROL to FOG_COLOUR.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// 0 none, 1 linear, 2 exponential, 3 exponential-squared, 4 depth-cue.
    pub function: u32,
    /// For a unit of eye space.
    pub density: f32,
    /// Where linear fog is full.
    pub end: f32,
    /// kz.
    pub scale: f32,
    /// cz.
    pub offset: f32,
    /// Red in 7:0.
    pub colour: u32,
}

impl Default for Fog {
    /// As the card resets them: none.
    fn default() -> Self {
        Self { function: 0, density: 0.0, end: 1.0, scale: 0.0, offset: 1.0, colour: 0 }
    }
}

/// LIGHT_CONTROL to MATERIAL_SHININESS.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lights {
    /// At pixels instead of vertices.
    pub per_pixel: bool,
    /// Normals that point away are turned round.
    pub two_sided: bool,
    /// The viewer is the eye.
    pub local_viewer: bool,
    /// First byte of the records, a multiple of 64.
    pub base: u32,
    /// Records.
    pub count: u32,
    /// Of the scene.
    pub ambient: u32,
    /// Of the material.
    pub specular: u32,
    /// Of the material.
    pub emission: u32,
    /// Of the material.
    pub shininess: f32,
}

/// A light as it stands in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Record {
    /// 0 directional, 1 point, 2 spot.
    pub kind: u32,
    /// Eye space.
    pub position: [f32; 3],
    /// Of its rays.
    pub direction: [f32; 3],
    /// 0 or less: none.
    pub cut_off: f32,
    /// Of a spot.
    pub exponent: f32,
    /// Red in 7:0.
    pub colour: u32,
    /// Red in 7:0.
    pub ambient: u32,
}

impl Record {
    /// The 16 words.
    #[must_use]
    pub fn words(&self) -> [u32; 16] {
        let ([x, y, z], [dx, dy, dz]) = (self.position.map(f32::to_bits), self.direction.map(f32::to_bits));
        let [cut_off, exponent] = [self.cut_off, self.exponent].map(f32::to_bits);
        [self.kind, x, y, z, dx, dy, dz, cut_off, exponent, self.colour, self.ambient, 0, 0, 0, 0, 0]
    }
}

/// All of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// Calls for a texture.
    pub texture: Option<Sampler>,
    /// Calls for its levels.
    pub mip_map: bool,
    /// Calls for holes where a texel's alpha is below this.
    pub punch_through: Option<u8>,
    /// Of what blends: 0 alpha, 1 add, 2 multiply, 3 premultiplied.
    pub mode: u32,
    /// Calls for fog.
    pub fog: Option<Fog>,
    /// Calls for light.
    pub light: Option<Lights>,
}

impl Look {
    /// A texture and nothing else.
    #[must_use]
    pub fn textured(sampler: Sampler) -> Self {
        Self { texture: Some(sampler), ..Self::default() }
    }

    /// Its bits of EFFECTS.
    #[must_use]
    pub fn effects(&self) -> u32 {
        let bit = |on: bool, mask: u32| if on { mask } else { 0 };
        bit(self.texture.is_some(), EFFECT_TEXTURE)
            | bit(self.mip_map, EFFECT_MIP_MAP)
            | bit(self.punch_through.is_some(), EFFECT_PUNCH_THROUGH)
            | bit(self.fog.is_some(), EFFECT_FOG)
            | bit(self.light.is_some(), EFFECT_LIGHT)
    }

    /// TEXTURE_BASE to BLEND_CONTROL, where the region begins at byte `region`.
    #[must_use]
    pub fn texture_words(&self, region: u32) -> [u32; 10] {
        let [base, size, control, offset, window, constant, bias, palette] =
            self.texture.unwrap_or_default().words(region);
        let reference = u32::from(self.punch_through.unwrap_or(0x80));
        [base, size, control, offset, window, constant, bias, palette, reference, self.mode]
    }

    /// FOG_CONTROL to FOG_COLOUR.
    #[must_use]
    pub fn fog_words(&self) -> [u32; 6] {
        let Fog { function, density, end, scale, offset, colour } = self.fog.unwrap_or_default();
        let [density, end, scale, offset] = [density, end, scale, offset].map(f32::to_bits);
        [function, density, end, scale, offset, colour]
    }

    /// LIGHT_CONTROL to MATERIAL_SHININESS.
    #[must_use]
    pub fn light_words(&self, region: u32) -> [u32; 7] {
        let light = self.light.unwrap_or_default();
        let control = u32::from(light.per_pixel) | u32::from(light.two_sided) << 1 | u32::from(light.local_viewer) << 2;
        let Lights { base, count, ambient, specular, emission, shininess, .. } = light;
        [control, region + base, count, ambient, specular, emission, shininess.to_bits()]
    }
}

/// A state's registers as the oracle reads them, on a target of this size.
#[must_use]
pub fn registers(state: &State, region: u32, [width, height]: [u32; 2]) -> Registers {
    let [effects, depth_control, ..] = state.words();
    let [base, size, control, offset, window, constant, bias, palette, punch_through, blend] =
        state.look.texture_words(region);
    Registers {
        effects,
        depth_control,
        scissor: state.scissor.unwrap_or([0, 0, width, height]),
        object_eye: state.camera.object_eye,
        eye_clip: state.camera.eye_clip,
        viewport: state.camera.viewport,
        texture: [base, size, control, offset, window, constant, bias, palette],
        punch_through,
        blend,
        fog: state.look.fog_words(),
        light: state.look.light_words(region),
        stencil: state.stencil.as_ref().map_or([7, 0], State::stencil_words),
    }
}
