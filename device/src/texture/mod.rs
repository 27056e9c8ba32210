//! Texture unit: looks a texture up for each pixel that is shaded.
//!
//! Source: CN 1275225 A, whose shading engine has a texture unit: an address generator with a level of detail, MIP maps
//! filtered three ways, 4-bit texels through a colour palette, offset, size, repetition and mirroring in x and y.
//!
//! Duties: takes a texture from video memory into its own memory, decoded; finds the level of detail; turns coordinates
//! into texels; filters them; combines the result with the colour of the polygon. Inputs from: the firmware's checked
//! texture, video memory, coordinates and their derivatives at the place shaded. Outputs to: shading, and the test for
//! holes of punch-through.
//!
//! Clocks: 1 for a nearest or bilinear look-up, for the texture memory has four banks; 2 for a trilinear one
//! ([`Texture::clocks`]); who asks charges them.
//!
//! | file | part |
//! | --- | --- |
//! | [`memory`] | texture memory: levels, the window, formats, the palette |
//! | [`level_of_detail`] | derivatives become a level |
//! | [`coordinates`] | coordinates become texels: repeated, mirrored or clamped |
//! | [`filter`] | four texels, and two levels, become one |
//! | `store` | textures kept from draw to draw |
//! | [`function`] | texel and colour of the polygon become one |
//!
//! [`Texture::texel`] is the specification; [`Texture::texels`] does 16 pixels in loops that a compiler turns into
//! vectors, and gives the same bits.

pub mod coordinates;
pub mod filter;
pub mod function;
pub mod level_of_detail;
pub mod memory;
pub(crate) mod store;

pub use function::{combine, combine_lanes};

use coordinates::{LANES, Wrap};
use memory::{LaneLevels, Memory};
use zga_abi::format::{TextureFilter, TextureFunction};
use zga_firmware::checked;

/// A texture decoded to RGBA words, as the unit holds it while a scene uses it.
#[derive(Debug)]
pub struct Texture {
    memory: Memory,
    /// [`TextureFilter::Trilinear`] only with levels to mix.
    filter: TextureFilter,
    /// In x and y.
    wrap: [Wrap; 2],
    function: TextureFunction,
    colour: u32,
    /// 1/256 levels.
    bias: i32,
}

impl Texture {
    /// Takes `texture` from video memory, of which `memory` is all words: the window of each level in use.
    #[must_use]
    pub fn decode(memory: &[u32], texture: &checked::Texture) -> Texture {
        let wrap = [0, 1].map(|axis| Wrap::new(texture.repeat[axis], texture.mirror[axis]));
        let filter = match texture.filter {
            TextureFilter::Trilinear if !texture.mip_map || texture.levels == 1 => TextureFilter::Bilinear,
            filter => filter,
        };
        Texture {
            memory: Memory::decode(memory, texture, wrap),
            filter,
            wrap,
            function: texture.function,
            colour: texture.colour,
            // s7.8 are 1/256 levels.
            bias: texture.bias,
        }
    }

    /// Every texel that a look-up can read has an alpha of 255, and so has what it returns.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.memory.is_opaque()
    }

    /// Bytes of the decoded texels, all levels in use.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// Texels that one look-up reads: 1, 4, or 8.
    #[must_use]
    pub fn fetches(&self) -> u64 {
        match self.filter {
            TextureFilter::Nearest => 1,
            TextureFilter::Bilinear => 4,
            TextureFilter::Trilinear => 8,
        }
    }

    /// Clocks of one look-up: the memory gives four texels a clock.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.fetches().div_ceil(4)
    }

    /// How the texel is combined with the colour of the polygon.
    #[must_use]
    pub fn function(&self) -> TextureFunction {
        self.function
    }

    /// RGBA of the function `blend`.
    #[must_use]
    pub fn colour(&self) -> u32 {
        self.colour
    }

    /// The level of detail can differ from 0; else derivatives need not be found.
    #[must_use]
    pub fn has_levels(&self) -> bool {
        self.memory.last_level() > 0
    }

    /// Level of detail, 1/256 levels, bias included, in the range of the levels in use, for `[du/dx, dv/dx, du/dy,
    /// dv/dy]` per pixel. Gradients that are not finite give the last level, gradients of zero level 0.
    #[must_use]
    #[inline(always)]
    pub fn level_of_detail(&self, gradients: [f64; 4]) -> i32 {
        level_of_detail::lambda(gradients, self.memory.window(), self.bias, self.last_lambda())
    }

    /// [`Texture::level_of_detail`] of 16 pixels.
    #[must_use]
    #[inline(always)]
    pub fn level_of_detail_lanes(&self, gradients: [&[f64; LANES]; 4]) -> [i32; LANES] {
        let mut lambda = [0; LANES];
        if !self.has_levels() {
            return lambda;
        }
        let [a, b, c, d] = gradients;
        let (window, bias, last) = (self.memory.window(), self.bias, self.last_lambda());
        for i in 0..LANES {
            lambda[i] = level_of_detail::lambda([a[i], b[i], c[i], d[i]], window, bias, last);
        }
        lambda
    }

    /// The texel, RGBA, at `u`, `v` (the window is 0..1; any number is allowed) and level of detail `lambda`, 1/256
    /// levels, clamped to those in use.
    #[must_use]
    pub fn texel(&self, u: f64, v: f64, lambda: i32) -> u32 {
        let lambda = lambda.clamp(0, self.last_lambda());
        let place = [self.wrap[0].reduce(u), self.wrap[1].reduce(v)];
        let near = ((lambda + 128) >> 8) as usize;
        match self.filter {
            TextureFilter::Nearest => self.memory.nearest(place, self.wrap, near),
            TextureFilter::Bilinear => filter::bilinear_texel(self.sums(place, near)),
            TextureFilter::Trilinear => {
                let (level, fraction) = ((lambda >> 8) as usize, (lambda & 255) as u32);
                filter::trilinear_texel(self.sums(place, level), self.sums(place, level + 1), fraction)
            }
        }
    }

    /// The texels of 16 pixels; those not in the mask `wanted` are 0.
    #[must_use]
    #[inline(always)]
    pub fn texels(&self, u: &[f64; LANES], v: &[f64; LANES], lambda: &[i32; LANES], wanted: u16) -> [u32; LANES] {
        if wanted == 0 {
            return [0; LANES];
        }
        let mut mask = [0; LANES];
        for (i, mask) in mask.iter_mut().enumerate() {
            *mask = (u32::from(wanted) >> i & 1).wrapping_neg();
        }
        let place = [self.wrap[0].reduce_lanes(u), self.wrap[1].reduce_lanes(v)];
        let (last, rounding) = (self.last_lambda(), if self.filter == TextureFilter::Trilinear { 0 } else { 128 });
        let (mut level, mut fraction) = ([0; LANES], [0; LANES]);
        for i in 0..LANES {
            // Pixels that are not wanted do not part the levels of the others.
            let lambda = (lambda[i].max(0).min(last)).wrapping_add(rounding) as u32 & mask[i];
            (level[i], fraction[i]) = (lambda >> 8, lambda & 255);
        }
        let levels = self.memory.lane_levels(&level, &mask);
        let mut texel = match self.filter {
            TextureFilter::Nearest => self.memory.nearest_lanes(&place, self.wrap, &levels),
            TextureFilter::Bilinear => filter::bilinear_lanes(&self.sum_lanes(&place, &levels)),
            TextureFilter::Trilinear => {
                let near = self.sum_lanes(&place, &levels);
                if fraction.iter().fold(0, |any, fraction| any | fraction) == 0 {
                    // The second level would count nothing: magnified, as a rule.
                    filter::bilinear_lanes(&near)
                } else {
                    for level in &mut level {
                        *level = level.wrapping_add(1);
                    }
                    let far = self.sum_lanes(&place, &self.memory.lane_levels(&level, &mask));
                    filter::trilinear_lanes(&near, &far, &fraction)
                }
            }
        };
        for i in 0..LANES {
            texel[i] &= mask[i];
        }
        texel
    }

    /// The greatest level of detail, 1/256 levels.
    fn last_lambda(&self) -> i32 {
        256 * self.memory.last_level() as i32
    }

    /// Bilinear sums at a place of level `level`: the specification.
    fn sums(&self, place: [f64; 2], level: usize) -> [u32; 4] {
        let (corners, fraction) = self.memory.corners(place, self.wrap, level);
        filter::bilinear_sums(corners, fraction)
    }

    /// Bilinear sums of 16 pixels.
    #[inline(always)]
    fn sum_lanes(&self, place: &[[f64; LANES]; 2], levels: &LaneLevels) -> filter::Sums {
        filter::sum_lanes(&self.memory.quads(place, self.wrap, levels))
    }
}

#[cfg(test)]
pub(crate) mod tests;
