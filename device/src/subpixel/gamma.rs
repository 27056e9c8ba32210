//! Light: the sRGB curve (IEC 61966-2-1) from the levels of a frame to linear light and back.
//!
//! Duties: levels of colours in the space in which samples are averaged, means back to levels. Used by
//! [`super::pixel`]. A level is 0 to 255, light is 0 to 255 too: only ratios matter.
//!
//! Error: light is good for 2^-50; a mean goes to the nearest level but where it lies within 2^-40 of the middle
//! between two.

use std::sync::LazyLock;
use zga_abi::format::SubpixelResolve;

/// The greatest level, and its light.
pub const WHITE: f64 = 255.0;

/// Light of each level.
static LIGHT: LazyLock<[f64; 256]> = LazyLock::new(|| std::array::from_fn(|level| light_of(level as f64)));
/// Light of the middle between a level and the next.
static MIDDLES: LazyLock<[f64; 255]> = LazyLock::new(|| std::array::from_fn(|level| light_of(level as f64 + 0.5)));

fn light_of(level: f64) -> f64 {
    let value = level / 255.0;
    255.0 * if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// The space in which samples are averaged.
#[derive(Clone, Copy, Debug)]
pub struct Space {
    light: Option<(&'static [f64; 256], &'static [f64; 255])>,
}

impl Space {
    /// The space of a setting.
    #[must_use]
    pub fn new(resolve: SubpixelResolve) -> Space {
        Space { light: (resolve == SubpixelResolve::Linear).then(|| (&*LIGHT, &*MIDDLES)) }
    }

    /// Whether means are those of the levels themselves.
    #[must_use]
    pub fn is_of_values(self) -> bool {
        self.light.is_none()
    }

    /// A colour (RGBA, R in 7:0) in this space; alpha as its level.
    #[must_use]
    #[inline(always)]
    pub fn of(self, colour: u32) -> [f64; 4] {
        let levels = colour.to_le_bytes();
        match self.light {
            None => levels.map(f64::from),
            Some((light, _)) => {
                let [r, g, b, a] = levels;
                [light[usize::from(r)], light[usize::from(g)], light[usize::from(b)], f64::from(a)]
            }
        }
    }

    /// The colour that a mean in this space is nearest to.
    #[must_use]
    #[inline(always)]
    pub fn colour(self, mean: [f64; 4]) -> u32 {
        let near = |value: f64| (value + 0.5).clamp(0.0, 255.0) as u8;
        let levels = match self.light {
            None => mean.map(near),
            Some((_, middles)) => {
                let level = |light: f64| middles.partition_point(|&middle| middle <= light) as u8;
                [level(mean[0]), level(mean[1]), level(mean[2]), near(mean[3])]
            }
        };
        u32::from_le_bytes(levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_of_any_level_is_that_level_in_both_spaces() {
        for resolve in [SubpixelResolve::Values, SubpixelResolve::Linear] {
            let space = Space::new(resolve);
            for level in 0..=255_u32 {
                let colour = level * 0x0101_0101;
                assert_eq!(space.colour(space.of(colour)), colour, "{resolve:?}");
            }
        }
    }

    #[test]
    fn of_white_in_both_spaces_is_exactly_white() {
        for resolve in [SubpixelResolve::Values, SubpixelResolve::Linear] {
            assert_eq!(Space::new(resolve).of(u32::MAX), [WHITE; 4], "{resolve:?}");
        }
    }

    #[test]
    fn colour_half_black_half_white_in_light_is_188() {
        // IEC 61966-2-1: 1.055 0.5^(1/2.4) - 0.055 = 0.7354, times 255 is 187.5...
        let space = Space::new(SubpixelResolve::Linear);
        let [black, white] = [space.of(0), space.of(0x00FF_FFFF)];
        assert_eq!(space.colour([0, 1, 2, 3].map(|c| (black[c] + white[c]) / 2.0)), 0x00BC_BCBC);
    }
}
