//! Lights and materials.
//!
//! Names follow the registers of the tile unit's records (CN 1275225 A): a light has position, direction,
//! type, attenuation cut-off, spot exponent, colour and ambient; a material shininess, specular, emission,
//! blending, fog and a texture.

use std::sync::Arc;

pub use zga_abi::format::{DepthFunction, StencilOperation, TextureFormat, TextureFunction};
pub use zga_driver::{Shadow, Stencil, StencilSide};

use super::Colour;
use super::settings::{named_values, names_of};
use crate::texture::{Indexed, Picture};

/// Ways to store texels, by name.
pub const TEXTURE_FORMATS: [(&str, TextureFormat); TextureFormat::ALL.len()] = names_of!(TextureFormat);
/// Comparisons of a reference with a stencil value, by name.
pub const STENCIL_FUNCTIONS: [(&str, DepthFunction); DepthFunction::ALL.len()] = names_of!(DepthFunction);
/// What becomes of a stencil value, by name.
pub const STENCIL_OPERATIONS: [(&str, StencilOperation); StencilOperation::ALL.len()] = names_of!(StencilOperation);
/// Ways to combine a texel with the colour of the polygon, by name.
pub const TEXTURE_FUNCTIONS: [(&str, TextureFunction); TextureFunction::ALL.len()] = names_of!(TextureFunction);

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
        /// By its alpha, which its colour is multiplied by already.
        Premultiplied = "premultiplied",
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
        /// Depth cueing: the surface's share is `depth_cue_offset` less `depth_cue_scale` for each world unit.
        DepthCue = "depth-cue",
    }
}

named_values! {
    /// Where the light that falls on a surface is worked out.
    Lighting {
        /// Nowhere: colours are shown as they are.
        None = "none",
        /// At each vertex.
        Vertex = "vertex",
        /// At each pixel.
        Pixel = "pixel",
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

/// How a surface looks. The default is plain: opaque, the vertices' colours, no effect. What light falls on is the
/// vertices' colours, so a material has no colour of its own: loaders of meshes put it there.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Where light is worked out; without it at each vertex in a scene that has lights, else nowhere.
    pub light: Option<Lighting>,
    /// Normals that point away from the viewer are turned round.
    pub two_sided: bool,
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
    /// Depth cueing: what of the surface's share a world unit of distance takes.
    pub depth_cue_scale: f32,
    /// Depth cueing: the surface's share at the viewer.
    pub depth_cue_offset: f32,
    /// Depths of what is drawn are stored.
    pub depth_write: bool,
    /// Stencil test, and what becomes of stencil values; these begin as 0.
    pub stencil: Option<Stencil>,
    /// The texture.
    pub texture: Option<Texture>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            light: None,
            two_sided: false,
            shininess: 0.0,
            specular: [0, 0, 0, 255],
            emission: [0, 0, 0, 255],
            blend: Blend::Opaque,
            punch_through: None,
            fog_function: FogFunction::None,
            fog_density: 0.0,
            fog_end: 1.0,
            fog_colour: [0, 0, 0, 255],
            depth_cue_scale: 0.0,
            depth_cue_offset: 1.0,
            depth_write: true,
            stencil: None,
            texture: None,
        }
    }
}

/// A texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Picture file, relative to the scene file; of a picture that code made, what it is called in messages.
    pub file: String,
    /// The picture, once [`crate::scene::Scene::load_meshes`] has read it; nothing is textured before.
    pub image: Option<Arc<Picture>>,
    /// How texels are stored on the card.
    pub format: TextureFormat,
    /// How a texel is combined with the colour of the polygon.
    pub function: TextureFunction,
    /// Constant colour of the function `blend`; its alpha is not in use.
    pub colour: Colour,
    /// How it is read between texels.
    pub filter: TextureFilter,
    /// Smaller levels are made and used where the picture is seen from afar.
    pub mip_map: bool,
    /// Added to the level of detail, levels, -128..128.
    pub bias: f32,
    /// First texel used, x and y.
    pub offset: [u32; 2],
    /// Texels used, x and y; none for the whole picture.
    pub size: Option<[u32; 2]>,
    /// Repeat in x and y.
    pub repeat: [bool; 2],
    /// Every other repetition mirrored, in x and y.
    pub mirror: [bool; 2],
    /// Colours of a texture with a palette, at most as many as its format has; without them they are found.
    pub palette: Option<Vec<Colour>>,
}

impl Texture {
    /// A texture of a picture in memory: modulated, bilinear, 32 bits a texel, the whole picture, once.
    #[must_use]
    pub fn of(image: impl Into<Arc<Picture>>) -> Self {
        Self { image: Some(image.into()), ..Self::named(String::new()) }
    }

    /// The same of a picture in a file that is not read yet.
    pub(crate) fn named(file: String) -> Self {
        Self {
            file,
            image: None,
            format: TextureFormat::Rgba8888,
            function: TextureFunction::Modulate,
            colour: [0, 0, 0, 255],
            filter: TextureFilter::Bilinear,
            mip_map: false,
            bias: 0.0,
            offset: [0, 0],
            size: None,
            repeat: [false; 2],
            mirror: [false; 2],
            palette: None,
        }
    }

    /// The picture in the palette of the texture's format: that of [`Texture::palette`], else one of the picture's own
    /// colours. None for a format without a palette or a picture that is not there.
    #[must_use]
    pub fn indexed(&self) -> Option<Indexed> {
        let most = self.format.palette() as usize;
        let image = self.image.as_ref().filter(|_| most > 0)?;
        Some(match &self.palette {
            Some(palette) => image.in_palette(&palette[..palette.len().min(most)]),
            None => image.quantised(most),
        })
    }
}
