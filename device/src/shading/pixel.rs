//! Pixel shading: what a draw's pixels go through after their interpolated colour: light, texture, fog.
//!
//! Duties: the state of a draw, the planes of a primitive that is seen, the colour of a place. Inputs from: checked draw
//! state, [`super::parameters`], the texture unit. Outputs to: [`super::plane`], whose planes call for it.
//!
//! The order is fixed: interpolated colour, light (where it is worked out at each pixel), texture function, fog. What a
//! draw does not call for is not there: no planes, no code, no clocks. [`ShadedPlane::colour`] is the specification, one
//! place with everything switched by state; [`ShadedPlane::sixteen`] does 16 pixels stage by stage and must equal it.
//!
//! # Clocks
//! | what | `cycles.` | clocks a pixel |
//! | --- | --- | --- |
//! | a texel, nearest or bilinear | texture | 1: four banks |
//! | a texel, trilinear | texture | 2: two levels |
//! | light | shading | 1, and 4 for each light |
//! | fog | shading | 1 |

use super::fog::FogMixer;
use super::light::Lights;
use super::parameters::{Below, LANES, Needed, ParameterPlanes, ParameterTransform, Parameters, Place, PlaceLanes};
use crate::built::{Called, FogKey, LightKey, PunchThroughKey, TextureKey};
use crate::probe::account::{Account, Clocks};
use crate::texture::{Texture, combine, combine_lanes};
use fearless_simd::Simd;
use std::sync::Arc;
use zga_abi::Counter;
use zga_abi::format::TextureFunction;

/// A texture as a draw uses it.
#[derive(Clone, Debug)]
pub struct Textured {
    /// Texels.
    pub texture: Arc<Texture>,
    /// Texels with an alpha below this are holes.
    pub punch_through: Option<Called<PunchThroughKey, u8>>,
}

/// What the pixels of a draw go through. Two are equal if they are one and the same.
#[derive(Clone, Debug)]
pub struct PixelShading {
    /// From vertices to the screen and the eye.
    pub transform: ParameterTransform,
    /// Light at each pixel.
    pub light: Option<Called<LightKey, Lights>>,
    /// Texture.
    pub texture: Option<Called<TextureKey, Textured>>,
    /// Fog.
    pub fog: Option<Called<FogKey, FogMixer>>,
}

impl PartialEq for PixelShading {
    fn eq(&self, other: &PixelShading) -> bool {
        std::ptr::eq(self, other)
    }
}

/// Events and clocks of pixels that were shaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadingCounts {
    /// Texels looked up.
    pub texels: u64,
    /// Texels read.
    pub fetches: u64,
    /// Fragments that were holes.
    pub holes: u64,
    /// Clocks of the texture unit.
    pub texture_clocks: u64,
    /// Lights evaluated.
    pub lights: u64,
    /// Pixels with fog.
    pub fogged: u64,
    /// Clocks of the shading unit, without those of the colour interpolators.
    pub shading_clocks: u64,
}

impl ShadingCounts {
    /// The sum of two counts.
    #[must_use]
    pub fn plus(self, other: ShadingCounts) -> ShadingCounts {
        ShadingCounts {
            texels: self.texels + other.texels,
            fetches: self.fetches + other.fetches,
            holes: self.holes + other.holes,
            texture_clocks: self.texture_clocks + other.texture_clocks,
            lights: self.lights + other.lights,
            fogged: self.fogged + other.fogged,
            shading_clocks: self.shading_clocks + other.shading_clocks,
        }
    }

    /// The same for so many pixels.
    #[must_use]
    pub fn times(self, pixels: u64) -> ShadingCounts {
        ShadingCounts {
            texels: self.texels * pixels,
            fetches: self.fetches * pixels,
            holes: self.holes * pixels,
            texture_clocks: self.texture_clocks * pixels,
            lights: self.lights * pixels,
            fogged: self.fogged * pixels,
            shading_clocks: self.shading_clocks * pixels,
        }
    }

    /// Charges the events.
    pub fn charge(&self, account: &mut Account) {
        account.add(Counter::TextureTexels, self.texels);
        account.add(Counter::TextureFetches, self.fetches);
        account.add(Counter::TextureHoles, self.holes);
        account.charge(Counter::CyclesTexture, Clocks(self.texture_clocks));
        account.add(Counter::ShadingLights, self.lights);
        account.add(Counter::ShadingFogged, self.fogged);
        account.charge(Counter::CyclesShading, Clocks(self.shading_clocks));
    }
}

/// What alphas a primitive's fragments can have, so far as its vertices and texture tell beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaRule {
    /// The vertices'.
    Vertices,
    /// From them down to 0: the texture has texels that are not opaque.
    Below,
    /// A texture takes their place; `opaque` if all of its texels are.
    Texels {
        /// All texels have an alpha of 255.
        opaque: bool,
    },
}

impl AlphaRule {
    /// The least and the greatest alpha, where the vertices' are `least` to `greatest`. Nothing counts as opaque that has
    /// a vertex which is not, whatever its texture.
    #[must_use]
    #[inline(always)]
    pub const fn range(self, [least, greatest]: [u32; 2]) -> [u32; 2] {
        match self {
            AlphaRule::Vertices => [least, greatest],
            AlphaRule::Below => [0, greatest],
            AlphaRule::Texels { opaque } => [if opaque && least == 255 { 255 } else { 0 }, 255],
        }
    }
}

impl Textured {
    fn alphas(&self) -> AlphaRule {
        let opaque = self.texture.is_opaque();
        match self.texture.function() {
            TextureFunction::Replace => AlphaRule::Texels { opaque },
            _ if opaque => AlphaRule::Vertices,
            TextureFunction::Modulate | TextureFunction::Decal | TextureFunction::Blend => AlphaRule::Below,
        }
    }
}

impl PixelShading {
    /// Which parameters it needs.
    #[must_use]
    pub fn needed(&self) -> Needed {
        Needed { coordinates: self.texture.is_some(), surface: self.light.is_some(), distance: self.fog.is_some() }
    }

    /// What a pixel costs.
    #[must_use]
    pub fn cost(&self) -> ShadingCounts {
        let (fetches, texture_clocks) = self.texture.as_ref().map_or((0, 0), |textured| {
            let texture = &textured.texture;
            (texture.fetches(), texture.clocks())
        });
        let lights = self.light.as_ref().map_or(0, |lights| lights.count() as u64);
        let (lit, fogged) = (u64::from(self.light.is_some()), u64::from(self.fog.is_some()));
        ShadingCounts {
            texels: u64::from(self.texture.is_some()),
            fetches,
            holes: 0,
            texture_clocks,
            lights,
            fogged,
            shading_clocks: lit + 4 * lights + fogged,
        }
    }

    /// What looking for holes among so many fragments costs, a texel each, where so many of them are holes; nothing of a
    /// draw without any.
    #[must_use]
    pub fn looked_up(&self, fragments: u64, holes: u64) -> ShadingCounts {
        match &self.texture {
            Some(textured) if textured.punch_through.is_some() => {
                let (fetches, texture_clocks) = (textured.texture.fetches(), textured.texture.clocks());
                let cost = ShadingCounts { texels: 1, fetches, texture_clocks, ..ShadingCounts::default() };
                ShadingCounts { holes, ..cost.times(fragments) }
            }
            _ => ShadingCounts::default(),
        }
    }

    /// What alphas it makes of the vertices'.
    #[must_use]
    pub fn alphas(&self) -> AlphaRule {
        self.texture.as_ref().map_or(AlphaRule::Vertices, |textured| textured.alphas())
    }

    /// Texels with an alpha below this are holes, where the draw has any.
    #[must_use]
    pub fn punch_through(&self) -> Option<u8> {
        self.texture.as_ref()?.punch_through.as_deref().copied()
    }
}

/// What the pixels of a primitive go through.
#[derive(Clone, Debug)]
pub struct ShadedPlane {
    shading: Arc<PixelShading>,
    planes: ParameterPlanes,
}

impl ShadedPlane {
    /// Of the primitive with these vertices, which begins near pixel `anchor`.
    #[must_use]
    pub fn new(shading: &Arc<PixelShading>, anchor: [i32; 2], vertices: &Parameters) -> ShadedPlane {
        let planes = ParameterPlanes::new(anchor, vertices, shading.needed(), &shading.transform);
        ShadedPlane { shading: Arc::clone(shading), planes }
    }

    /// The texel at a place.
    fn texel(&self, textured: &Textured, place: &Place) -> u32 {
        let Some(coordinates) = &self.planes.coordinates else {
            return 0;
        };
        let [u, v] = [0, 1].map(|axis| coordinates[axis].at(place));
        let lambda = if textured.texture.has_levels() {
            textured.texture.level_of_detail(self.planes.gradients(coordinates, place, [u, v]))
        } else {
            0
        };
        textured.texture.texel(u, v, lambda)
    }

    /// A texture with holes, and the least alpha that is none.
    #[inline(always)]
    fn punched(&self) -> Option<(&Textured, u32)> {
        let textured = self.shading.texture.as_deref()?;
        Some((textured, u32::from(**textured.punch_through.as_ref()?)))
    }

    /// Whether the place `[x, y]`, in u, is a hole.
    #[must_use]
    pub fn is_hole(&self, at: [i32; 2]) -> bool {
        let Some((textured, reference)) = self.punched() else {
            return false;
        };
        self.texel(textured, &self.planes.place(at)) >> 24 < reference
    }

    /// What becomes of an interpolated colour at the place `[x, y]`, in u.
    #[must_use]
    pub fn colour(&self, colour: u32, at: [i32; 2]) -> u32 {
        let (shading, place) = (&*self.shading, self.planes.place(at));
        let mut colour = colour;
        if let (Some(lights), Some(surface)) = (&shading.light, &self.planes.surface) {
            let [px, py, pz, nx, ny, nz] = surface.each_ref().map(|part| part.at(&place) as f32);
            colour = lights.lit(colour, [px, py, pz], [nx, ny, nz]);
        }
        if let Some(textured) = &shading.texture {
            colour =
                combine(textured.texture.function(), colour, self.texel(textured, &place), textured.texture.colour());
        }
        if let (Some(fog), Some(distance)) = (&shading.fog, &self.planes.distance) {
            colour = fog.mixed(colour, distance.at(&place) as f32);
        }
        colour
    }

    /// Texels at those of 16 places that are wanted.
    #[inline(always)]
    fn texel_lanes<J: Below>(&self, textured: &Textured, places: &PlaceLanes<J>, wanted: u16) -> [u32; LANES] {
        let Some(coordinates) = &self.planes.coordinates else {
            return [0; LANES];
        };
        let (u, v) = (coordinates[0].at_lanes(places), coordinates[1].at_lanes(places));
        let lambda = if textured.texture.has_levels() {
            let gradients = self.planes.gradient_lanes(coordinates, places, [&u, &v]);
            textured.texture.level_of_detail_lanes(gradients.each_ref())
        } else {
            [0; LANES]
        };
        textured.texture.texels(&u, &v, &lambda, wanted)
    }

    #[inline(always)]
    fn hole_lanes<J: Below>(&self, places: &PlaceLanes<J>, wanted: u16) -> u16 {
        let Some((textured, reference)) = self.punched() else {
            return 0;
        };
        let texels = self.texel_lanes(textured, places, wanted);
        let mut holes = 0;
        for (lane, texel) in texels.iter().enumerate() {
            holes |= u16::from(texel >> 24 < reference) << lane;
        }
        holes & wanted
    }

    /// What becomes of the colours of the 16 pixels from (`x`, `y`) on; those not wanted mean nothing. One piece of code
    /// at each SIMD level for whoever asks.
    #[must_use]
    #[inline(never)]
    pub fn sixteen<S: Simd>(&self, simd: S, colours: &[u32; LANES], x: i32, y: i32, wanted: u16) -> [u32; LANES] {
        simd.vectorize(
            #[inline(always)]
            || self.lanes(*colours, &self.planes.places(x, y), wanted),
        )
    }

    /// The same at 16 places anywhere, columns and rows in u.
    #[must_use]
    #[inline(never)]
    pub fn scattered<S: Simd>(
        &self,
        simd: S,
        colours: &[u32; LANES],
        at: &[[i32; LANES]; 2],
        wanted: u16,
    ) -> [u32; LANES] {
        simd.vectorize(
            #[inline(always)]
            || self.lanes(*colours, &self.planes.scattered(at), wanted),
        )
    }

    /// The same for holes: which of the wanted pixels are any, a bit each.
    #[must_use]
    #[inline(never)]
    pub fn holes_of_sixteen<S: Simd>(&self, simd: S, x: i32, y: i32, wanted: u16) -> u16 {
        simd.vectorize(
            #[inline(always)]
            || self.hole_lanes(&self.planes.places(x, y), wanted),
        )
    }

    /// The same at 16 places anywhere, columns and rows in u.
    #[must_use]
    #[inline(never)]
    pub fn scattered_holes<S: Simd>(&self, simd: S, at: &[[i32; LANES]; 2], wanted: u16) -> u16 {
        simd.vectorize(
            #[inline(always)]
            || self.hole_lanes(&self.planes.scattered(at), wanted),
        )
    }

    #[inline(always)]
    fn lanes<J: Below>(&self, colours: [u32; LANES], places: &PlaceLanes<J>, wanted: u16) -> [u32; LANES] {
        let (shading, mut colours) = (&*self.shading, colours);
        if let (Some(lights), Some(surface)) = (&shading.light, &self.planes.surface) {
            let mut parts = [[0.0; LANES]; 6];
            for (part, parameter) in parts.iter_mut().zip(surface) {
                let values = parameter.at_lanes(places);
                for (value, wide) in part.iter_mut().zip(values) {
                    *value = wide as f32;
                }
            }
            let [px, py, pz, nx, ny, nz] = parts;
            colours = lights.lit_lanes(&colours, &[px, py, pz], &[nx, ny, nz]);
        }
        if let Some(textured) = &shading.texture {
            let texels = self.texel_lanes(textured, places, wanted);
            colours = combine_lanes(textured.texture.function(), &colours, &texels, textured.texture.colour());
        }
        if let (Some(fog), Some(distance)) = (&shading.fog, &self.planes.distance) {
            let mut distances = [0.0; LANES];
            for (distance, wide) in distances.iter_mut().zip(distance.at_lanes(places)) {
                *distance = wide as f32;
            }
            colours = fog.mixed_lanes(&colours, &distances);
        }
        colours
    }
}
