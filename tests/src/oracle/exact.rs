//! Exact numbers: an unreduced `i128` fraction that orders without overflow, the roundings that the rules name,
//! and the bridges to rationals of unbounded size.

use std::cmp::Ordering;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};

/// `numerator / denominator`, not reduced; the denominator is positive. Equality and order are those of the values.
#[derive(Clone, Copy, Debug)]
pub struct Fraction {
    numerator: i128,
    denominator: i128,
}

impl Fraction {
    /// # Panics
    /// When `denominator` is not positive.
    #[must_use]
    pub const fn new(numerator: i128, denominator: i128) -> Self {
        assert!(denominator > 0, "the denominator of a fraction must be positive");
        Self { numerator, denominator }
    }

    /// An integer.
    #[must_use]
    pub const fn whole(value: i128) -> Self {
        Self::new(value, 1)
    }

    /// As given, not reduced.
    #[must_use]
    pub const fn numerator(self) -> i128 {
        self.numerator
    }

    /// As given, not reduced; positive.
    #[must_use]
    pub const fn denominator(self) -> i128 {
        self.denominator
    }

    /// The largest integer that is not above the value.
    #[must_use]
    pub const fn floor(self) -> i128 {
        self.numerator.div_euclid(self.denominator)
    }

    /// `floor(value + 1/2)`.
    #[must_use]
    pub const fn round_half_up(self) -> i128 {
        round_half_up(self.numerator, self.denominator)
    }

    /// The same value, reduced.
    #[must_use]
    pub fn to_rational(self) -> BigRational {
        ratio(self.numerator, self.denominator)
    }

    /// `self - other`, exactly.
    #[must_use]
    pub fn minus(self, other: Self) -> BigRational {
        self.to_rational() - other.to_rational()
    }

    /// `|self - other|` as a float (for reports), and how it compares with 1 (exactly).
    #[must_use]
    pub fn distance(self, other: Self) -> (f64, Ordering) {
        let narrow = |f: &Self| bits(f.numerator) <= 75 && bits(f.denominator) <= 50;
        if narrow(&self) && narrow(&other) {
            let over = self.denominator * other.denominator;
            let difference = (self.numerator * other.denominator - other.numerator * self.denominator).abs();
            (difference as f64 / over as f64, difference.cmp(&over))
        } else {
            let difference = self.minus(other);
            let difference = if difference < BigRational::zero() { -difference } else { difference };
            (difference.to_f64().unwrap_or(f64::INFINITY), difference.cmp(&BigRational::one()))
        }
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        let fits = |a: i128, b: i128| bits(a) + bits(b) <= 126;
        if fits(self.numerator, other.denominator) && fits(other.numerator, self.denominator) {
            (self.numerator * other.denominator).cmp(&(other.numerator * self.denominator))
        } else {
            compare_by_parts(*self, *other)
        }
    }
}

/// Order without products: by whole parts, then by the reciprocals of the remainders (Euclid's algorithm).
fn compare_by_parts(mut left: Fraction, mut right: Fraction) -> Ordering {
    let mut sense = Ordering::Less;
    loop {
        let whole = left.floor().cmp(&right.floor());
        if whole != Ordering::Equal {
            return if sense == Ordering::Less { whole } else { whole.reverse() };
        }
        let left_rest = left.numerator.rem_euclid(left.denominator);
        let right_rest = right.numerator.rem_euclid(right.denominator);
        if left_rest == 0 || right_rest == 0 {
            let rest = left_rest.signum().cmp(&right_rest.signum());
            return if sense == Ordering::Less { rest } else { rest.reverse() };
        }
        left = Fraction::new(left.denominator, left_rest);
        right = Fraction::new(right.denominator, right_rest);
        sense = sense.reverse();
    }
}

/// Bits of the magnitude.
const fn bits(value: i128) -> u32 {
    128 - value.unsigned_abs().leading_zeros()
}

/// `floor(numerator / denominator + 1/2)` for a positive denominator: half up, also below zero.
#[must_use]
pub const fn round_half_up(numerator: i128, denominator: i128) -> i128 {
    let rest = numerator.rem_euclid(denominator);
    numerator.div_euclid(denominator) + (rest >= denominator - rest) as i128
}

/// `numerator / denominator` as a rational, reduced.
///
/// # Panics
/// When `denominator` is 0.
#[must_use]
pub fn ratio(numerator: i128, denominator: i128) -> BigRational {
    BigRational::new(BigInt::from(numerator), BigInt::from(denominator))
}

/// An integer as a rational.
#[must_use]
pub fn integer(value: impl Into<BigInt>) -> BigRational {
    BigRational::from_integer(value.into())
}

/// Every finite float is a rational; `None` for NaN and the infinities.
#[must_use]
pub fn from_f64(value: f64) -> Option<BigRational> {
    BigRational::from_float(value)
}

/// What the card reads: denormals are 0, the infinities the largest finite numbers; `None` for NaN.
#[must_use]
pub fn from_card_f32(value: f32) -> Option<BigRational> {
    if value.is_subnormal() {
        return Some(BigRational::zero());
    }
    BigRational::from_float(value.clamp(f32::MIN, f32::MAX))
}

/// Round to nearest, ties to even.
#[must_use]
pub fn round_ties_even(value: &BigRational) -> BigInt {
    let floor = value.floor().to_integer();
    let rest = value - integer(floor.clone());
    let half = ratio(1, 2);
    let odd = !(&floor % 2u32).is_zero();
    if rest > half || (rest == half && odd) { floor + 1u32 } else { floor }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn round_half_up_halves_go_up_on_both_sides_of_zero() {
        let rounded = [-5, -3, -2, -1, 0, 1, 2, 3, 5].map(|n| round_half_up(n, 2));

        assert_eq!(rounded, [-2, -1, -1, 0, 0, 1, 1, 2, 3]);
    }

    #[test]
    fn round_half_up_thirds_go_to_the_nearest() {
        let rounded = [-4, -2, -1, 1, 2, 4, 5].map(|n| round_half_up(n, 3));

        assert_eq!(rounded, [-1, -1, 0, 0, 1, 1, 2]);
    }

    #[test]
    fn round_ties_even_halves_go_to_the_even() {
        let rounded = [-3, -1, 1, 3, 5, 4].map(|n| round_ties_even(&ratio(n, 2)));

        assert_eq!(rounded, [-2, 0, 0, 2, 2, 2].map(BigInt::from));
    }

    #[test]
    fn from_card_f32_special_values_follow_the_input_rule() {
        assert_eq!(from_card_f32(f32::NAN), None);
        assert_eq!(from_card_f32(1.0e-40), Some(BigRational::zero()));
        assert_eq!(from_card_f32(f32::INFINITY), BigRational::from_float(f32::MAX));
        assert_eq!(from_card_f32(f32::NEG_INFINITY), BigRational::from_float(f32::MIN));
        assert_eq!(from_card_f32(0.375), Some(ratio(3, 8)));
    }

    proptest! {
        #[test]
        fn cmp_any_fractions_agrees_with_rationals(
            a in any::<i128>(), b in 1..=i128::MAX, c in any::<i128>(), d in 1..=i128::MAX, shift in 0u32..120,
        ) {
            let (left, right) = (Fraction::new(a >> shift, b), Fraction::new(c >> shift, d));

            prop_assert_eq!(left.cmp(&right), left.to_rational().cmp(&right.to_rational()));
            prop_assert_eq!(compare_by_parts(left, right), left.cmp(&right));
        }

        #[test]
        fn cmp_near_neighbours_agrees_with_rationals(
            a in -(1i128 << 80)..1i128 << 80, b in 1..1i128 << 49, scale in 1i128..1 << 40, nudge in -1i128..=1,
        ) {
            let (left, right) = (Fraction::new(a, b), Fraction::new(a * scale + nudge, b * scale));

            prop_assert_eq!(left.cmp(&right), 0.cmp(&nudge));
            prop_assert_eq!(compare_by_parts(left, right), 0.cmp(&nudge));
        }

        #[test]
        fn distance_both_paths_compare_with_one_alike(
            a in -(1i128 << 70)..1i128 << 70, b in 1..1i128 << 48, extra in -1i128..=1, wide in 60u32..70,
        ) {
            let narrow = Fraction::new(a, b).distance(Fraction::new(a + b + extra, b));
            let scaled = Fraction::new((a + b + extra) << 20, b << 20).distance(Fraction::new(a << 50, b << 50));
            let huge = Fraction::new(1 << wide, 1i128 << wide).distance(Fraction::whole(0));

            prop_assert_eq!(narrow.1, (b + extra).cmp(&b));
            prop_assert_eq!(scaled.1, narrow.1);
            prop_assert!((scaled.0 - narrow.0).abs() <= narrow.0 * 1e-12);
            prop_assert_eq!(huge, (1.0, Ordering::Equal));
        }

        #[test]
        fn round_half_up_is_floor_of_value_plus_half(n in -(1i128 << 100)..1i128 << 100, d in 1..1i128 << 60) {
            let expected = (ratio(n, d) + ratio(1, 2)).floor().to_integer();

            prop_assert_eq!(BigInt::from(round_half_up(n, d)), expected);
        }
    }
}
