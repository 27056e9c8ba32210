//! Colours of samples: layers over one another, and the mean of a pixel.
//!
//! On the frame's values everything is exact: k layers over a stored level leave a number with denominator 255^k, and
//! the mean of such numbers is rounded half up, in integers of any size. Through the sRGB curve (IEC 61966-2-1), which
//! is irrational, f64 is good for 10^-12 of a level.
//!
//! The card composes in f64 too. Where the exact mean lies within 2^-30 of half way between two levels, its rounding
//! errors may decide, so both levels are right there. A mean of stored levels alone is a sum of integers over a power of
//! two, which an f64 holds, so it has but one right level, ties included.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::ToPrimitive;

use super::super::exact::{integer, ratio};

/// Half the width of the band about a tie, in levels: 2^-30. The f64 sums of 300 layers are good for 2^-36.
const CLOSE: i128 = 1 << 30;

/// Where samples are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Resolve {
    /// The frame's values.
    #[default]
    Values,
    /// Linear light; alpha by its values.
    Linear,
}

/// A channel of a resolved pixel: one level, or either of two neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// The lower one.
    pub low: u8,
    /// The same unless the mean is a tie as far as an f64 can tell.
    pub high: u8,
}

impl Level {
    /// Exactly this level.
    #[must_use]
    pub const fn exactly(level: u8) -> Self {
        Self { low: level, high: level }
    }

    /// Whether a level is right.
    #[must_use]
    pub const fn admits(self, level: u8) -> bool {
        level == self.low || level == self.high
    }
}

/// `numerator / 255^power`, in levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Exact {
    numerator: BigInt,
    power: u32,
}

fn power(exponent: u32) -> BigInt {
    BigInt::from(255u32).pow(exponent)
}

impl Exact {
    fn level(level: u8) -> Self {
        Self { numerator: level.into(), power: 0 }
    }

    /// `alpha / 255 * source + (1 - alpha / 255) * self`.
    fn under(&self, source: u8, alpha: u8) -> Self {
        let front = BigInt::from(u32::from(alpha) * u32::from(source)) * power(self.power);
        Self { numerator: front + BigInt::from(255 - alpha) * &self.numerator, power: self.power + 1 }
    }
}

/// The colour of a sample: red, green, blue, alpha.
#[derive(Clone, Debug)]
pub(super) enum Colour {
    /// As drawn.
    Plain([u8; 4]),
    /// With layers over it.
    Composed(Box<Composed>),
}

/// On both scales; only one of them is looked at.
#[derive(Clone, Debug)]
pub(super) struct Composed {
    levels: [Exact; 4],
    /// Red, green, blue, `0..=1`.
    light: [f64; 3],
}

impl Colour {
    fn levels(&self) -> [Exact; 4] {
        match self {
            Self::Plain(colour) => colour.map(Exact::level),
            Self::Composed(composed) => composed.levels.clone(),
        }
    }

    fn light(&self) -> [f64; 3] {
        match self {
            Self::Plain([r, g, b, _]) => [r, g, b].map(|&level| light(level)),
            Self::Composed(composed) => composed.light,
        }
    }

    /// This colour with a layer over it: source alpha over, 1 - alpha is a product.
    pub(super) fn under(&self, [r, g, b, alpha]: [u8; 4]) -> Self {
        let below = self.levels();
        // 255 - A' = (1 - a)(255 - A): the rule of a colour whose source is 255.
        let sources = [r, g, b, 255];
        let levels = [0, 1, 2, 3].map(|c| below[c].under(sources[c], alpha));
        let share = f64::from(alpha) / 255.0;
        let light = [0, 1, 2].map(|c| share * light(sources[c]) + (1.0 - share) * self.light()[c]);
        Self::Composed(Box::new(Composed { levels, light }))
    }
}

/// Linear light of an sRGB level.
fn light(level: u8) -> f64 {
    let value = f64::from(level) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// sRGB level, with a fraction, of linear light.
fn level_of(light: f64) -> f64 {
    let value = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    value * 255.0
}

/// The mean of the samples' colours.
pub(super) fn mean(samples: &[&Colour], resolve: Resolve) -> [Level; 4] {
    // Most pixels are of one colour as drawn; its mean is itself, on both scales.
    if let Some((Colour::Plain(first), rest)) = samples.split_first()
        && rest.iter().all(|colour| matches!(colour, Colour::Plain(other) if other == first))
    {
        return first.map(Level::exactly);
    }
    let on_values = means_on_values(samples);
    if resolve == Resolve::Values {
        return on_values;
    }
    let colours: Vec<[f64; 3]> = samples.iter().map(|colour| colour.light()).collect();
    let in_light = |channel: usize| {
        let sum: f64 = colours.iter().map(|light| light[channel]).sum();
        let level = level_of(sum / samples.len() as f64);
        let (low, high) = (level - 1.0 / CLOSE as f64, level + 1.0 / CLOSE as f64);
        let [low, high] = [low, high].map(|level| (level + 0.5).floor().clamp(0.0, 255.0) as u8);
        Level { low, high }
    };
    [in_light(0), in_light(1), in_light(2), on_values[3]]
}

/// The means of the frame's values. Without layers they are sums of small integers.
fn means_on_values(samples: &[&Colour]) -> [Level; 4] {
    let mut sums = [0_u32; 4];
    for colour in samples {
        let Colour::Plain(levels) = colour else { return means_of_layers(samples) };
        for (sum, &level) in sums.iter_mut().zip(levels) {
            *sum += u32::from(level);
        }
    }
    let count = samples.len() as u32;
    sums.map(|sum| Level::exactly(((2 * sum + count) / (2 * count)) as u8))
}

/// The same by definition, in integers of any size.
fn means_of_layers(samples: &[&Colour]) -> [Level; 4] {
    let levels: Vec<[Exact; 4]> = samples.iter().map(|colour| colour.levels()).collect();
    [0, 1, 2, 3].map(|channel: usize| mean_of_levels(levels.iter().map(|levels| &levels[channel])))
}

fn mean_of_levels<'a>(levels: impl ExactSizeIterator<Item = &'a Exact> + Clone) -> Level {
    let count = levels.len();
    let greatest = levels.clone().map(|level| level.power).max().unwrap_or(0);
    let sum: BigInt = levels.map(|level| &level.numerator * power(greatest - level.power)).sum();
    let mean = BigRational::new(sum, power(greatest) * count);
    let half_up = |level: BigRational| (level + ratio(1, 2)).floor().to_integer().to_u8().unwrap_or(u8::MAX);
    if greatest == 0 {
        return Level::exactly(half_up(mean));
    }
    let close = ratio(1, CLOSE);
    let low = if mean > close { &mean - &close } else { integer(0) };
    Level { low: half_up(low), high: half_up(mean + close) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(levels: &[u8], resolve: Resolve) -> Level {
        let colours: Vec<Colour> = levels.iter().map(|&level| Colour::Plain([level, 0, 0, 0])).collect();
        mean(&colours.iter().collect::<Vec<_>>(), resolve)[0]
    }

    #[test]
    fn mean_of_stored_levels_rounds_half_up() {
        assert_eq!(plain(&[0, 1], Resolve::Values), Level::exactly(1));
        assert_eq!(plain(&[0, 0, 0, 1], Resolve::Values), Level::exactly(0));
        assert_eq!(plain(&[0, 255], Resolve::Values), Level::exactly(128));
        assert_eq!(plain(&[254, 255], Resolve::Values), Level::exactly(255));
    }

    #[test]
    fn mean_of_stored_levels_equals_that_of_integers_of_any_size() {
        let colours: Vec<Colour> =
            (0..997_u32).map(|k| Colour::Plain((k * k).wrapping_mul(2_654_435_761).to_le_bytes())).collect();
        for count in [1, 2, 16, 32, 64] {
            for samples in colours.chunks_exact(count) {
                let samples: Vec<&Colour> = samples.iter().collect();

                assert_eq!(mean(&samples, Resolve::Values), means_of_layers(&samples));
            }
        }
    }

    #[test]
    fn mean_in_linear_light_of_black_and_white_is_the_published_188() {
        assert_eq!(plain(&[0, 255], Resolve::Linear), Level::exactly(188));
        assert_eq!(plain(&[0, 0, 0, 255], Resolve::Linear), Level::exactly(137));
    }

    #[test]
    fn mean_of_equal_levels_is_that_level_on_both_scales() {
        for level in 0..=255 {
            assert!((level_of(light(level)) - f64::from(level)).abs() < 1.0e-9);
            // A composed colour takes the long way: nothing of another colour over it.
            let composed = Colour::Plain([level; 4]).under([level, level, level, 0]);
            for resolve in [Resolve::Values, Resolve::Linear] {
                assert_eq!(mean(&[&composed], resolve), [Level::exactly(level); 4], "{resolve:?}");
            }
        }
    }

    #[test]
    fn under_one_layer_is_source_alpha_over() {
        // 51/255 = 1/5: 1/5 of (100, 0, 255) over (200, 10, 5); alpha 1 - 4/5 (1 - 55/255).
        let composed = Colour::Plain([200, 10, 5, 55]).under([100, 0, 255, 51]);

        assert_eq!(mean(&[&composed], Resolve::Values), [180, 8, 55, 95].map(Level::exactly));
    }

    #[test]
    fn under_many_layers_is_the_geometric_sum() {
        // n layers of white with alpha 1/255 over black leave 255 (1 - (254/255)^n).
        let mut colour = Colour::Plain([0; 4]);
        for _ in 0..300 {
            colour = colour.under([255, 255, 255, 1]);
        }

        let expected = (255.0 * (1.0 - (254.0f64 / 255.0).powi(300))).round() as u8;
        assert_eq!(mean(&[&colour], Resolve::Values), [Level::exactly(expected); 4]);
        let Colour::Composed(composed) = &colour else { panic!("composed") };
        assert_eq!(composed.levels[0].power, 300);
    }

    #[test]
    fn mean_composed_tie_admits_both_levels() {
        // 1/5 of 5 is 1, of which half is covered: 1/2.
        let [over, bare] = [Colour::Plain([0; 4]).under([5, 0, 0, 51]), Colour::Plain([0; 4])];

        let found = mean(&[&over, &bare], Resolve::Values)[0];

        assert_eq!(found, Level { low: 0, high: 1 });
        assert!(found.admits(1) && !found.admits(2));
    }
}
