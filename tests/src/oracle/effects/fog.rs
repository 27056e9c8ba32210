//! Fog and depth cueing in f64.
//!
//! The distance is that along the line of sight, `max(0, -z)` in eye space. What fog leaves of a surface is its *share*;
//! the card takes it in 256 steps, `floor(255 f + 1/2)`.

use super::{Colour, Ideal, ideal, mix8, mixture};

/// FOG_CONTROL to FOG_COLOUR.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// 0 none, 1 linear, 2 exponential, 3 exponential-squared, 4 depth-cue.
    pub function: u32,
    /// For a unit of eye space.
    pub density: f64,
    /// Where linear fog is full.
    pub end: f64,
    /// kz.
    pub scale: f64,
    /// cz.
    pub offset: f64,
    /// Alpha is not in use.
    pub colour: Colour,
}

impl Fog {
    /// What the registers hold.
    #[must_use]
    pub fn read(registers: &[u32; 6]) -> Self {
        let [function, density, end, scale, offset, colour] = *registers;
        let [density, end, scale, offset] = [density, end, scale, offset].map(|word| f64::from(f32::from_bits(word)));
        Self { function, density, end, scale, offset, colour: colour.to_le_bytes() }
    }

    /// What is left of a surface at eye z, `0..=1`.
    #[must_use]
    pub fn share(&self, z: f64) -> f64 {
        let distance = (-z).max(0.0);
        let thickness = self.density * distance;
        let share = match self.function {
            1 => 1.0 - distance / self.end,
            2 => (-thickness).exp(),
            3 => (-thickness * thickness).exp(),
            4 => self.offset - self.scale * distance,
            _ => 1.0,
        };
        share.clamp(0.0, 1.0)
    }

    /// The steps that the card takes the share in.
    #[must_use]
    pub fn steps(share: f64) -> u8 {
        (255.0 * share + 0.5).floor() as u8
    }

    /// A colour in fog, by the card's steps.
    #[must_use]
    pub fn exact(&self, colour: Colour, steps: u8) -> Colour {
        [0, 1, 2, 3].map(|c| if c == 3 { colour[3] } else { mix8(self.colour[c], colour[c], steps) })
    }

    /// A colour in fog, unrounded.
    #[must_use]
    pub fn unrounded(&self, colour: Ideal, share: f64) -> Ideal {
        let fog = ideal(self.colour);
        [0, 1, 2, 3].map(|c| if c == 3 { colour[3] } else { mixture(fog[c], colour[c], 255.0 * share) })
    }
}

/// How far off a fogged colour can be, in levels, where the colour is off by so much: half a step of the share and 1/8
/// for the card's f32 distance and exponential, then one rounding.
#[must_use]
pub fn tolerance(colour: f64) -> f64 {
    colour + 0.625 + 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fog(function: u32) -> Fog {
        Fog { function, density: 0.5, end: 8.0, scale: 0.25, offset: 1.5, colour: [100, 100, 100, 0] }
    }

    #[test]
    fn share_of_each_function_is_that_of_the_table() {
        let at = |function: u32, z: f64| fog(function).share(z);

        assert_eq!([0.0, -2.0, -8.0, -99.0, 5.0].map(|z| at(1, z)), [1.0, 0.75, 0.0, 0.0, 1.0]);
        assert!((at(2, -2.0) - 0.367_879_441_171_442_3).abs() < 1.0e-15);
        assert!((at(3, -4.0) - 0.018_315_638_888_734_18).abs() < 1.0e-15);
        assert_eq!([0.0, -2.0, -4.0, -6.0, -7.0].map(|z| at(4, z)), [1.0, 1.0, 0.5, 0.0, 0.0]);
        assert_eq!(at(0, -1.0e9), 1.0);
    }

    #[test]
    fn exact_no_fog_and_all_fog() {
        let colour = [7, 200, 0, 9];

        assert_eq!(fog(1).exact(colour, Fog::steps(1.0)), colour);
        assert_eq!(fog(1).exact(colour, Fog::steps(0.0)), [100, 100, 100, 9]);
        assert_eq!(fog(1).unrounded(ideal(colour), 0.5), [53.5, 150.0, 50.0, 9.0]);
    }

    #[test]
    fn exact_every_share_is_within_the_tolerance_of_the_unrounded() {
        for k in 0..=1000 {
            let (share, colour) = (f64::from(k) / 1000.0, [0, 255, 90, 3]);
            let (found, right) = (fog(1).exact(colour, Fog::steps(share)), fog(1).unrounded(ideal(colour), share));
            assert!((0..4).all(|c| (f64::from(found[c]) - right[c]).abs() <= tolerance(0.0)), "{share}");
        }
    }
}
