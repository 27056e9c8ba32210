//! Fog and depth cueing: a colour gives way to the fog's with distance.
//!
//! Duties: the density calculator (how much of the surface is seen at a distance) and the mixer.
//! Inputs from: the texture function (a colour), the interpolators (distance, -z in eye space); the draw's [`Fog`]. Outputs to:
//! blending, or the frame buffer. Clocks: 1 a pixel; whoever calls charges them.
//!
//! The share of the surface is an f32, worked out in the order written here from basic operations and [`super::math::exp2`];
//! rounded to 0..=255 it mixes in integers. [`FogMixer::mixed`] is the specification, [`FogMixer::mixed_lanes`] the same 16
//! times side by side.
//!
//! Error: the rounded share is that of exact arithmetic but where the exact one lies within 2^-12 of the middle between
//! two. It never grows with distance (nor falls, for a depth cue with a negative scale).

use super::levels::whole;
use super::math::exp2;
use std::f32::consts::LOG2_E;
use zga_abi::format::FogFunction;
use zga_firmware::checked::Fog;

/// Pixels side by side.
const LANES: usize = 16;
/// Red and blue, each with room for 16 bits.
const RED_BLUE: u32 = 0x00FF_00FF;

/// Mixes colours with the fog of a draw.
#[derive(Clone, Debug)]
pub struct FogMixer {
    fog: Fog,
}

impl FogMixer {
    /// The mixer of a draw's fog.
    #[must_use]
    pub fn new(fog: &Fog) -> FogMixer {
        FogMixer { fog: *fog }
    }

    /// `colour` (RGBA, R in 7:0) seen through the fog at `distance`, -z in eye space; alpha stays. A negative distance and
    /// one that is not a number count as 0, an infinite one as the greatest f32. The specification.
    #[must_use]
    #[inline(always)]
    pub fn mixed(&self, colour: u32, distance: f32) -> u32 {
        self.mix(self.fog.function, colour, distance)
    }

    /// [`FogMixer::mixed`] of 16 pixels at once, equal bit for bit.
    #[must_use]
    #[inline(always)]
    pub fn mixed_lanes(&self, colours: &[u32; 16], distance: &[f32; 16]) -> [u32; 16] {
        // One loop for each function, so that none asks in its lanes.
        match self.fog.function {
            FogFunction::None => *colours,
            FogFunction::Linear => self.lanes(FogFunction::Linear, colours, distance),
            FogFunction::Exponential => self.lanes(FogFunction::Exponential, colours, distance),
            FogFunction::ExponentialSquared => self.lanes(FogFunction::ExponentialSquared, colours, distance),
            FogFunction::DepthCue => self.lanes(FogFunction::DepthCue, colours, distance),
        }
    }

    /// All lanes; `function` is the fog's, a constant to the compiler.
    #[inline(always)]
    fn lanes(&self, function: FogFunction, colours: &[u32; LANES], distance: &[f32; LANES]) -> [u32; LANES] {
        let mut mixed = [0; LANES];
        for lane in 0..LANES {
            mixed[lane] = self.mix(function, colours[lane], distance[lane]);
        }
        mixed
    }

    /// One pixel.
    #[inline(always)]
    fn mix(&self, function: FogFunction, colour: u32, distance: f32) -> u32 {
        let fog = &self.fog;
        // Finite from here on, so that no product of a zero and it is NaN; those that overflow end in the limits below.
        let distance = if distance > 0.0 { distance } else { 0.0 };
        let distance = if distance < f32::MAX { distance } else { f32::MAX };
        let share = match function {
            FogFunction::None => 1.0,
            FogFunction::Linear => 1.0 - distance / fog.end,
            FogFunction::Exponential => exp2(-((fog.density * distance) * LOG2_E)),
            FogFunction::ExponentialSquared => {
                let depth = fog.density * distance;
                exp2(-((depth * depth) * LOG2_E))
            }
            FogFunction::DepthCue => fog.cue_offset - fog.cue_scale * distance,
        };
        let share = if share > 0.0 { share } else { 0.0 };
        let share = if share < 1.0 { share } else { 1.0 };
        mix(fog.colour, colour, whole(255.0 * share + 0.5))
    }
}

/// (`fog` (255 - `share`) + `colour` `share` + 127) / 255 of red, green and blue; alpha of `colour`. `share` is 0..=255.
#[inline(always)]
fn mix(fog: u32, colour: u32, share: u32) -> u32 {
    // Two channels at once, modulo 2^32: 255 fog + share (colour - fog) + 127 of each is 127..=65152, so the sum is what it
    // would be without wraps, and the channels do not meet.
    let numerators = |shift: u32| {
        let (fog, colour) = ((fog >> shift) & RED_BLUE, (colour >> shift) & RED_BLUE);
        let constant = fog.wrapping_mul(255).wrapping_add(0x007F_007F);
        constant.wrapping_add(share.wrapping_mul(colour.wrapping_sub(fog)))
    };
    // n / 255 = (n + 1 + n / 256) / 256, rounded down, for n below 65535.
    let quotients = |n: u32| (n.wrapping_add(0x0001_0001).wrapping_add((n >> 8) & RED_BLUE) >> 8) & RED_BLUE;
    let (red_blue, green) = (quotients(numerators(0)), quotients(numerators(8)) & 0xFF);
    (colour & 0xFF00_0000) | red_blue | (green << 8)
}

#[cfg(test)]
mod tests;
