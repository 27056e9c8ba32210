//! Lights and materials, and which of their fields call for effects.
//!
//! Names follow the registers of the tile unit's records (CN 1275225 A): a light has position, direction,
//! type, attenuation cut-off, spot exponent, colour and ambient; a material shininess, specular, emission,
//! blending, fog and a texture.

use super::settings::named_values;
use super::{Colour, Scene, SubpixelGrid};

named_values! {
    /// What a light is like.
    LightType {
        /// Parallel rays along `direction`.
        Directional = "directional",
        /// All round from `position`.
        Point = "point",
        /// A cone from `position` along `direction`.
        Spot = "spot",
    }
}

named_values! {
    /// How a surface is combined with what lies behind it.
    Blend {
        /// It hides it.
        Opaque = "opaque",
        /// By its alpha.
        Alpha = "alpha",
        /// Its colour is added.
        Add = "add",
        /// The colours are multiplied.
        Multiply = "multiply",
    }
}

named_values! {
    /// How fog grows with distance.
    FogFunction {
        /// No fog.
        None = "none",
        /// In proportion to distance, full at `fog_end`.
        Linear = "linear",
        /// Exponentially with `fog_density`.
        Exponential = "exponential",
        /// Exponentially with the square.
        ExponentialSquared = "exponential-squared",
    }
}

named_values! {
    /// How a texture is read between texels.
    TextureFilter {
        /// The nearest texel.
        Nearest = "nearest",
        /// Four texels.
        Bilinear = "bilinear",
        /// Four texels of two MIP-map levels.
        Trilinear = "trilinear",
    }
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Directional, point or spot.
    pub kind: LightType,
    /// World position; needed by point and spot lights.
    pub position: [f32; 3],
    /// World direction of the rays; needed by directional and spot lights.
    pub direction: [f32; 3],
    /// Distance past which the light has no effect, world units; none without an end.
    pub attenuation_cut_off: Option<f32>,
    /// How fast a spot falls off from its axis, 0..=128.
    pub spot_exponent: f32,
    /// Colour of the diffuse and specular light.
    pub colour: Colour,
    /// Colour that it adds everywhere.
    pub ambient: Colour,
}

/// How a surface looks. The default is plain: opaque, the vertices' colours, no effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Sharpness of the highlight, 0..=128.
    pub shininess: f32,
    /// Colour of the highlight.
    pub specular: Colour,
    /// Colour that the surface gives off by itself.
    pub emission: Colour,
    /// How it is combined with what lies behind.
    pub blend: Blend,
    /// Texels with an alpha below this are holes.
    pub punch_through: Option<u8>,
    /// How fog grows with distance.
    pub fog_function: FogFunction,
    /// Density of exponential fog, for each world unit.
    pub fog_density: f32,
    /// Distance at which linear fog is full, world units.
    pub fog_end: f32,
    /// Colour of the fog.
    pub fog_colour: Colour,
    /// The texture.
    pub texture: Option<Texture>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            shininess: 0.0,
            specular: [0, 0, 0, 255],
            emission: [0, 0, 0, 255],
            blend: Blend::Opaque,
            punch_through: None,
            fog_function: FogFunction::None,
            fog_density: 0.0,
            fog_end: 1.0,
            fog_colour: [0, 0, 0, 255],
            texture: None,
        }
    }
}

/// A texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Picture file, relative to the scene file.
    pub file: String,
    /// How it is read between texels.
    pub filter: TextureFilter,
    /// First texel used, x and y.
    pub offset: [u32; 2],
    /// Texels used, x and y; none for the whole picture.
    pub size: Option<[u32; 2]>,
    /// Repeat in x and y.
    pub repeat: [bool; 2],
    /// Every other repetition mirrored, in x and y.
    pub mirror: [bool; 2],
    /// Colours of a 4-bit texture, at most 16.
    pub palette: Option<Vec<Colour>>,
}

impl Scene {
    /// The paths of all fields of lights and materials that call for an effect, in the file's order of names:
    /// empty for a scene of plain colours. A card without the units refuses or ignores what is listed here.
    /// Blending by alpha is the sub-pixel unit's, so it is listed where `antialias` is off.
    #[must_use]
    pub fn unsupported_effects(&self, antialias: SubpixelGrid) -> Vec<String> {
        let mut paths: Vec<String> = (0..self.lights.len()).map(|index| format!("lights[{index}]")).collect();
        let (plain, layers) = (Material::default(), antialias == SubpixelGrid::Off);
        for (name, material) in &self.materials {
            let called = [
                ("shininess", material.shininess != plain.shininess),
                ("specular", material.specular != plain.specular),
                ("emission", material.emission != plain.emission),
                ("blend", material.blend != plain.blend && material.blend != Blend::Alpha),
                ("blend (translucency needs antialias for now)", layers && material.blend == Blend::Alpha),
                ("punch_through", material.punch_through.is_some()),
                ("fog_function", material.fog_function != plain.fog_function),
                ("texture", material.texture.is_some()),
            ];
            let called = called.iter().filter(|(_, called)| *called);
            paths.extend(called.map(|(field, _)| format!("materials.{name}.{field}")));
        }
        paths
    }
}
