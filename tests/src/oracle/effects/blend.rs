//! Blend modes: a translucent fragment over what lies behind it.

use super::{Colour, Ideal, mix8, mixture, mul8, product};

/// 0 alpha, 1 add, 2 multiply, 3 premultiplied: `source` over `below`, in levels.
///
/// # Panics
/// For another mode.
#[must_use]
pub fn exact(mode: u32, below: Colour, source: Colour) -> Colour {
    let alpha = source[3];
    let mut composed = below;
    for c in 0..4 {
        let (s, d) = (source[c], below[c]);
        composed[c] = match (mode, c) {
            (0, 3) => mix8(d, 255, alpha),
            (0, _) => mix8(d, s, alpha),
            (1 | 2, 3) => d,
            (1, _) => d.saturating_add(mul8(s, alpha)),
            (2, _) => mul8(d, 255 - mul8(alpha, 255 - s)),
            // Colour and alpha alike: the source's alpha takes the place of the product.
            (3, _) => s.saturating_add(mul8(d, 255 - alpha)),
            (other, _) => panic!("there is no blend mode {other}"),
        };
    }
    composed
}

/// The same without rounding.
///
/// # Panics
/// For another mode.
#[must_use]
pub fn unrounded(mode: u32, below: Ideal, source: Ideal) -> Ideal {
    let alpha = source[3];
    let mut composed = below;
    for c in 0..4 {
        let (s, d) = (source[c], below[c]);
        composed[c] = match (mode, c) {
            (0, 3) => mixture(d, 255.0, alpha),
            (0, _) => mixture(d, s, alpha),
            (1 | 2, 3) => d,
            (1, _) => (d + product(s, alpha)).min(255.0),
            (2, _) => product(d, 255.0 - product(alpha, 255.0 - s)),
            (3, _) => (s + product(d, 255.0 - alpha)).min(255.0),
            (other, _) => panic!("there is no blend mode {other}"),
        };
    }
    composed
}

/// How far off the result can be, in levels, where both colours are off by so much: each of source, alpha and what is
/// below counts at most once, and there are at most two roundings.
#[must_use]
pub fn tolerance(below: f64, source: f64) -> f64 {
    below + 2.0 * source + 1.0
}

#[cfg(test)]
mod tests {
    use super::super::ideal;
    use super::*;
    use proptest::prelude::*;

    const BELOW: Colour = [200, 10, 5, 55];

    #[test]
    fn exact_modes_are_those_of_the_manual() {
        let source = [100, 0, 255, 51];

        assert_eq!(exact(0, BELOW, source), [180, 8, 55, 95]);
        assert_eq!(exact(1, BELOW, source), [220, 10, 56, 55]);
        // 255 - 31 = 224; 255 - 51 = 204; 255.
        assert_eq!(exact(2, BELOW, source), [176, 8, 5, 55]);
        assert_eq!(exact(3, BELOW, source), [255, 8, 255, 95]);
    }

    #[test]
    fn exact_alpha_0_changes_nothing_and_alpha_255_replaces() {
        for mode in 0..3 {
            assert_eq!(exact(mode, BELOW, [7, 8, 9, 0]), BELOW, "{mode}");
        }
        assert_eq!(exact(3, BELOW, [0; 4]), BELOW);
        assert_eq!(exact(0, BELOW, [7, 8, 9, 255]), [7, 8, 9, 255]);
        assert_eq!(exact(3, BELOW, [7, 8, 9, 255]), [7, 8, 9, 255]);
    }

    proptest! {
        #[test]
        fn exact_any_colours_are_within_the_tolerance_of_the_unrounded(
            mode in 0_u32..4, below in any::<Colour>(), source in any::<Colour>(),
        ) {
            let (found, right) = (exact(mode, below, source), unrounded(mode, ideal(below), ideal(source)));

            for c in 0..4 {
                prop_assert!((f64::from(found[c]) - right[c]).abs() <= tolerance(0.0, 0.0), "{:?} {:?}", found, right);
            }
        }
    }
}
