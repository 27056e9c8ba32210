//! The colour of a fragment: polygon, light, texture, fog, in that order, each without rounding where it interpolates.
//!
//! A [`Shade`] says how far a card may be from it. The tolerance is 0 while nothing was interpolated: a flat colour, a
//! nearest texel, a texture function of the two are exact, and rounded as the manual says. From the first interpolation
//! on colours are ideal, and what the card's roundings can add up to is carried along:
//!
//! * an interpolated colour: 3/4 of a level (rounding 1/2, the planes a quarter);
//! * a texel coordinate: 1/256 texel ([`REACH`]), half of it the rounding to 1/256, half the planes';
//! * a level of detail: 1/128 ([`LEVELS`]), a quarter of it the rounding, the rest the logarithm's and the slopes'.

use super::fog::{self, Fog};
use super::light::{Lighting, Vector};
use super::surface::Weights;
use super::texel::{Filter, Texture};
use super::{Colour, Ideal, detail, filter, function, ideal};

/// How far off a card's texel coordinate may be, texels.
pub const REACH: f64 = 1.0 / 256.0;
/// How far off a card's level of detail may be, levels.
pub const LEVELS: f64 = 1.0 / 128.0;
/// How far off an interpolated colour may be, levels.
const INTERPOLATED: f64 = 0.75;

/// A colour, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Levels.
    pub colour: Ideal,
    /// How far off a card may be, in levels; 0 is exact.
    pub tolerance: f64,
    /// A card may have chosen another texel or level.
    pub doubt: bool,
}

impl Shade {
    /// Exactly this colour.
    #[must_use]
    pub fn exactly(colour: Colour) -> Self {
        Self { colour: ideal(colour), tolerance: 0.0, doubt: false }
    }

    /// The colour, where it is exact.
    #[must_use]
    pub fn exact(&self) -> Option<Colour> {
        // Exact colours are whole levels.
        (self.tolerance == 0.0).then(|| self.colour.map(|level| level as u8))
    }

    /// The largest distance of a colour's channels, in levels.
    #[must_use]
    pub fn error(&self, colour: Colour) -> f64 {
        (0..4).map(|c| (f64::from(colour[c]) - self.colour[c]).abs()).fold(0.0, f64::max)
    }

    /// Whether a card may show this colour.
    #[must_use]
    pub fn admits(&self, colour: Colour) -> bool {
        self.doubt || self.error(colour) <= self.tolerance + 1.0e-9
    }
}

/// A fragment before its depth test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragment {
    /// Its colour.
    pub shade: Shade,
    /// It is a hole of the texture.
    pub hole: bool,
    /// Whether it is one is in doubt.
    pub torn: bool,
}

/// What the vertices of a primitive carry; points and lines have theirs at all three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Varying {
    /// Levels.
    pub colours: [Ideal; 3],
    /// u, v.
    pub coordinates: [[f64; 2]; 3],
    /// Eye space, length 1.
    pub normals: [Vector; 3],
    /// Eye space.
    pub places: [Vector; 3],
}

/// What a draw does with its fragments' colours.
#[derive(Clone, Debug, Default)]
pub struct Shader {
    /// Colours are interpolated; else the first vertex'.
    pub gouraud: bool,
    /// Lights.
    pub lighting: Option<Lighting>,
    /// Texture.
    pub texture: Option<Texture>,
    /// A texel with an alpha below this is a hole.
    pub punch_through: Option<u8>,
    /// Fog.
    pub fog: Option<Fog>,
}

impl Shader {
    /// A fragment where the vertices have these parts.
    #[must_use]
    pub fn fragment(&self, varying: &Varying, at: &Weights) -> Fragment {
        let texel = self.texture.as_ref().map(|texture| (texture, look_up(texture, varying, at)));
        let (hole, torn) = match (self.punch_through, texel) {
            (Some(reference), Some((_, texel))) => {
                // The card compares a rounded alpha: below the reference is below half a level under it.
                let off = texel.colour[3] - (f64::from(reference) - 0.5);
                (off < 0.0, texel.doubt || off.abs() < texel.tolerance)
            }
            _ => (false, false),
        };
        let base = self.base(varying, at);
        let textured = texel.map_or(base, |(texture, texel)| combine(texture, base, texel));
        let shade = self.fog.map_or(textured, |fog| {
            let share = fog.share(at.mix(varying.places)[2]);
            let colour = fog.unrounded(textured.colour, share);
            Shade { colour, tolerance: fog::tolerance(textured.tolerance), ..textured }
        });
        Fragment { shade, hole, torn }
    }

    /// The polygon's colour, lit.
    fn base(&self, varying: &Varying, at: &Weights) -> Shade {
        let mut vertices = varying.colours.map(|colour| Shade { colour, tolerance: 0.0, doubt: false });
        let at_vertices = self.lighting.as_ref().filter(|lighting| !lighting.per_pixel);
        if let Some(lighting) = at_vertices {
            for (k, vertex) in vertices.iter_mut().enumerate() {
                let (place, normal) = (varying.places[k], varying.normals[k]);
                vertex.tolerance = lighting.tolerance(0.0, place, normal);
                vertex.colour = lighting.lit(vertex.colour, place, normal);
            }
        }
        let colour = if self.gouraud {
            let worst = vertices.iter().map(|vertex| vertex.tolerance).fold(0.0, f64::max);
            let colour = at.mix(vertices.map(|vertex| vertex.colour));
            Shade { colour, tolerance: worst + INTERPOLATED, doubt: false }
        } else {
            vertices[0]
        };
        match self.lighting.as_ref().filter(|lighting| lighting.per_pixel) {
            Some(lighting) => {
                let (place, normal) = (at.mix(varying.places), at.mix(varying.normals));
                let tolerance = lighting.tolerance(colour.tolerance, place, normal);
                Shade { colour: lighting.lit(colour.colour, place, normal), tolerance, doubt: false }
            }
            None => colour,
        }
    }
}

/// The texel at a place.
fn look_up(texture: &Texture, varying: &Varying, at: &Weights) -> Shade {
    let coordinates = at.mix(varying.coordinates);
    let rho = detail::rho_squared(&at.slope(varying.coordinates), texture.window);
    let lambda = detail::ideal(texture, rho);
    let colour = filter::ideal_lookup(texture, coordinates, lambda);
    let doubt = filter::in_doubt(texture, coordinates, lambda, REACH, LEVELS);
    let between_levels = texture.filter == Filter::Trilinear && texture.mip_map;
    let tolerance = match texture.filter {
        Filter::Nearest => 0.0,
        _ => filter::spread(texture.filter, REACH) + if between_levels { 255.0 * LEVELS } else { 0.0 } + 0.5,
    };
    Shade { colour, tolerance, doubt }
}

/// Texture function: exact of exact colours.
fn combine(texture: &Texture, base: Shade, texel: Shade) -> Shade {
    let (function, constant) = (texture.function, texture.constant);
    let doubt = base.doubt || texel.doubt;
    match (base.exact(), texel.exact()) {
        (Some(base), Some(texel)) => {
            Shade { doubt, ..Shade::exactly(function::exact(function, base, texel, constant)) }
        }
        _ => Shade {
            colour: function::unrounded(function, base.colour, texel.colour, constant),
            tolerance: function::tolerance(function, base.tolerance, texel.tolerance),
            doubt,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::super::texel::{Format, Level};
    use super::*;

    fn varying(colours: [Colour; 3]) -> Varying {
        Varying {
            colours: colours.map(ideal),
            coordinates: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            normals: [[0.0, 0.0, 1.0]; 3],
            places: [[0.0, 0.0, -4.0]; 3],
        }
    }

    fn texture(alphas: [u8; 2], filter: Filter) -> Texture {
        Texture {
            format: Format::Rgba8888,
            levels: vec![Level { size: [2, 1], texels: alphas.map(|a| [10, 20, 30, a]).to_vec() }],
            offset: [0; 2],
            window: [2, 1],
            repeat: [false; 2],
            mirror: [false; 2],
            filter,
            function: 1,
            constant: [0; 4],
            bias: 0,
            mip_map: false,
        }
    }

    const MIDDLE: Weights = Weights { weights: [0.6, 0.2, 0.2], gradient: [[0.0; 3]; 2] };

    #[test]
    fn fragment_flat_and_nearest_is_exact() {
        let shader = Shader { texture: Some(texture([255, 0], Filter::Nearest)), ..Shader::default() };

        let found = shader.fragment(&varying([[255, 128, 0, 9], [0; 4], [0; 4]]), &MIDDLE);

        assert_eq!(found.shade, Shade::exactly([10, 10, 0, 9]));
        assert_eq!((found.hole, found.torn), (false, false));
    }

    #[test]
    fn fragment_interpolated_has_a_tolerance() {
        let shader = Shader { gouraud: true, ..Shader::default() };

        let found = shader.fragment(&varying([[100; 4], [50; 4], [0; 4]]), &MIDDLE).shade;

        assert!(found.admits([70; 4]) && !found.admits([71; 4]) && found.exact().is_none());
    }

    #[test]
    fn fragment_holes_are_alphas_below_the_reference() {
        let of = |alpha: u8, reference: u8| {
            let texture = Some(texture([alpha, alpha], Filter::Nearest));
            let shader = Shader { texture, punch_through: Some(reference), ..Shader::default() };
            let fragment = shader.fragment(&varying([[255; 4]; 3]), &MIDDLE);
            (fragment.hole, fragment.torn)
        };

        assert_eq!([of(99, 100), of(100, 100), of(101, 100)], [(true, false), (false, false), (false, false)]);
        assert_eq!([of(0, 0), of(254, 255), of(255, 255)], [(false, false), (true, false), (false, false)]);
    }

    #[test]
    fn fragment_near_a_boundary_of_texels_is_in_doubt() {
        let shader = |reference| Shader {
            texture: Some(texture([255, 0], Filter::Nearest)),
            punch_through: Some(reference),
            ..Shader::default()
        };
        let boundary = Weights { weights: [0.5, 0.5, 0.0], gradient: [[0.0; 3]; 2] };

        let found = shader(128).fragment(&varying([[255; 4]; 3]), &boundary);

        assert!(found.torn && found.shade.doubt && found.shade.admits([1, 2, 3, 4]));
    }

    #[test]
    fn fragment_fog_comes_last_and_keeps_alpha() {
        let fog = Fog { function: 1, density: 0.0, end: 8.0, scale: 0.0, offset: 0.0, colour: [200, 0, 0, 0] };
        let shader = Shader { fog: Some(fog), ..Shader::default() };

        let found = shader.fragment(&varying([[100, 50, 0, 7]; 3]), &MIDDLE).shade;

        assert_eq!(found.colour, [150.0, 25.0, 0.0, 7.0]);
    }
}
