//! Exactly rounded quotients: the one division of set-up.
//!
//! A gradient is round(n * 2^shift / d), half up. The quotient is first guessed in f64, rounded, and
//! then corrected by its remainder, which is seldom needed. Remainders are small, so they are exact in
//! wrapping i64 arithmetic even where n * 2^shift does not fit; only quotients beyond 2^50 take the
//! i128 way.

/// Guesses of larger magnitude are not within a few units of the quotient.
const GUESS_LIMIT: f64 = (1_u64 << 50) as f64;

/// 1.5 * 2^52: adding it to an f64 of magnitude below 2^51 leaves the rounded integer in the low bits.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// round(`n` * 2^`shift` / `d`), half up, modulo 2^64.
///
/// `d` in 1..=2^50, `inverse` = 1.0 / `d`, `shift` <= 32.
#[must_use]
#[inline(always)]
pub fn round_ratio(n: i64, shift: u32, d: i64, inverse: f64) -> i64 {
    debug_assert!((1..=1 << 50).contains(&d) && shift <= 32);
    let guess = n as f64 * (1_u64 << shift) as f64 * inverse;
    if guess.abs() >= GUESS_LIMIT {
        return round_ratio_wide(n, shift, d);
    }
    // floor((2 n 2^shift + d) / 2d)
    let twice = 2 * d;
    let mut quotient = (guess + ROUND).to_bits().wrapping_sub(ROUND.to_bits()) as i64;
    let mut remainder = n.wrapping_shl(shift + 1).wrapping_add(d).wrapping_sub(quotient.wrapping_mul(twice));
    while remainder < 0 {
        quotient -= 1;
        remainder += twice;
    }
    while remainder >= twice {
        quotient += 1;
        remainder -= twice;
    }
    quotient
}

/// The same by definition, for quotients beyond the guess.
#[cold]
fn round_ratio_wide(n: i64, shift: u32, d: i64) -> i64 {
    let quotient = ((i128::from(n) << (shift + 1)) + i128::from(d)).div_euclid(2 * i128::from(d));
    quotient as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn round_ratio_random_equals_definition(n in -(1_i64 << 56)..1 << 56, cut in 0_u32..50, d in 1_i64..1 << 50, shrink in 0_u32..50, shift in 0_u32..=32) {
            let (n, d) = (n >> cut, (d >> shrink).max(1));
            prop_assert_eq!(round_ratio(n, shift, d, 1.0 / d as f64), round_ratio_wide(n, shift, d));
        }
    }

    #[test]
    fn round_ratio_half_goes_up() {
        assert_eq!(round_ratio(1, 0, 2, 0.5), 1);
        assert_eq!(round_ratio(-1, 0, 2, 0.5), 0);
        assert_eq!(round_ratio(-3, 0, 2, 0.5), -1);
    }
}
