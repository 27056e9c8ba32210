//! What the effects of a draw must look like: texture, light, fog, blending, holes.
//!
//! Two answers stand side by side. The *exact* one follows the manual's roundings bit for bit, where these say all: a
//! texel at given coordinates and level of detail, a texture function, a blend. The *ideal* one is what the roundings
//! approximate, in f64: no coordinate in 1/256 texel, no weight of 8 bits, no level between 0 and 255 but the last. The
//! distance between a card and the ideal is what its roundings cost.
//!
//! | module | answers | source of the rule |
//! | --- | --- | --- |
//! | [`texel`] | texels of every format, where levels lie | the card's manual, "Texture" |
//! | [`coordinate`] | repetition, mirrors, edges; the window of a level | the same |
//! | [`filter`](mod@filter) | nearest, bilinear, trilinear | the same; Williams 1983, "Pyramidal parametrics" |
//! | [`detail`] | the level of detail | the same; Heckbert 1983 |
//! | [`function`] | texel and colour of the polygon | the same |
//! | [`light`] | lights and materials | the manual, "Light"; Blinn 1977, "Models of light reflection" |
//! | [`fog`] | fog and depth cueing | the manual, "Fog" |
//! | [`blend`] | translucency | the manual, "Blending"; Porter and Duff 1984 |
//! | [`surface`] | attributes and their derivatives at a pixel | Blinn 1992, "Hyperbolic interpolation" |
//! | [`shade`] | the colour of a fragment: all of these in their order | the manual |
//! | [`picture`] | the picture: visibility, holes, layers | the manual; submission order |
//! | [`raw`] | draws as the card's registers and packets have them | the manual |
//!
//! Colours are red, green, blue, alpha; levels `0..=255`, in f64 where they are ideal.

pub mod blend;
pub mod coordinate;
pub mod detail;
pub mod filter;
pub mod fog;
pub mod function;
pub mod light;
pub mod picture;
pub mod raw;
pub mod shade;
pub mod surface;
pub mod texel;

pub use picture::Painting;
pub use raw::{Corner, RawDraw};
pub use shade::Shade;
pub use texel::{Memory, Texture};

/// Red, green, blue, alpha.
pub type Colour = [u8; 4];

/// The same in levels with fractions.
pub type Ideal = [f64; 4];

/// The product of two levels, 255 standing for 1, rounded: `(a b + 127) / 255`.
#[must_use]
pub const fn mul8(a: u8, b: u8) -> u8 {
    ((a as u32 * b as u32 + 127) / 255) as u8
}

/// From `a` to `b` by `t / 255`, rounded: `(a (255 - t) + b t + 127) / 255`.
#[must_use]
pub const fn mix8(a: u8, b: u8, t: u8) -> u8 {
    let (a, b, t) = (a as u32, b as u32, t as u32);
    ((a * (255 - t) + b * t + 127) / 255) as u8
}

/// Levels as they are.
#[must_use]
pub fn ideal(colour: Colour) -> Ideal {
    colour.map(f64::from)
}

/// The product of two levels, 255 standing for 1.
#[must_use]
pub fn product(a: f64, b: f64) -> f64 {
    a * b / 255.0
}

/// From `a` to `b` by `t / 255`.
#[must_use]
pub fn mixture(a: f64, b: f64, t: f64) -> f64 {
    (a * (255.0 - t) + b * t) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mul8_and_mix8_every_pair_are_the_nearest_levels() {
        for a in 0..=255_u8 {
            for b in 0..=255_u8 {
                let [a1, b1] = [a, b].map(f64::from);
                assert!((f64::from(mul8(a, b)) - product(a1, b1)).abs() <= 0.5);
                for t in [0, 1, 2, 51, 127, 128, 200, 254, 255] {
                    assert!((f64::from(mix8(a, b, t)) - mixture(a1, b1, t.into())).abs() <= 0.5);
                }
            }
        }
    }

    #[test]
    fn mul8_and_mix8_ends_are_exact() {
        for a in 0..=255 {
            assert_eq!((mul8(a, 255), mul8(255, a), mul8(a, 0)), (a, a, 0));
            assert_eq!((mix8(a, 7, 0), mix8(7, a, 255), mix8(a, a, 99)), (a, a, a));
        }
    }
}
