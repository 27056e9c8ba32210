//! Texture functions: the texel and the colour of the polygon.

use super::{Colour, Ideal, ideal, mix8, mixture, mul8, product};

/// 0 replace, 1 modulate, 2 decal, 3 blend with `constant`.
///
/// # Panics
/// For another function.
#[must_use]
pub fn exact(function: u32, base: Colour, texel: Colour, constant: Colour) -> Colour {
    let alpha = texel[3];
    match function {
        0 => texel,
        1 => [0, 1, 2, 3].map(|c| mul8(base[c], texel[c])),
        2 => [0, 1, 2, 3].map(|c| if c == 3 { base[3] } else { mix8(base[c], texel[c], alpha) }),
        3 => [0, 1, 2, 3].map(|c| if c == 3 { mul8(base[3], alpha) } else { mix8(base[c], constant[c], texel[c]) }),
        other => panic!("there is no texture function {other}"),
    }
}

/// The same without rounding.
///
/// # Panics
/// For another function.
#[must_use]
pub fn unrounded(function: u32, base: Ideal, texel: Ideal, constant: Colour) -> Ideal {
    let (alpha, constant) = (texel[3], ideal(constant));
    match function {
        0 => texel,
        1 => [0, 1, 2, 3].map(|c| product(base[c], texel[c])),
        2 => [0, 1, 2, 3].map(|c| if c == 3 { base[3] } else { mixture(base[c], texel[c], alpha) }),
        3 => {
            [0, 1, 2, 3].map(|c| if c == 3 { product(base[3], alpha) } else { mixture(base[c], constant[c], texel[c]) })
        }
        other => panic!("there is no texture function {other}"),
    }
}

/// How far off the result can be, in levels, where colour and texel are off by so much.
#[must_use]
pub fn tolerance(function: u32, base: f64, texel: f64) -> f64 {
    // A weight that is off by a level moves a mixture by a level at most. Each but replace rounds once.
    match function {
        0 => texel,
        2 => base + 2.0 * texel + 0.5,
        _ => base + texel + 0.5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BASE: Colour = [200, 100, 50, 128];
    const TEXEL: Colour = [255, 51, 0, 51];
    const CONSTANT: Colour = [0, 255, 10, 99];

    #[test]
    fn exact_functions_are_those_of_the_table() {
        assert_eq!(exact(0, BASE, TEXEL, CONSTANT), TEXEL);
        assert_eq!(exact(1, BASE, TEXEL, CONSTANT), [200, 20, 0, 26]);
        // A fifth of the texel.
        assert_eq!(exact(2, BASE, TEXEL, CONSTANT), [211, 90, 40, 128]);
        assert_eq!(exact(3, BASE, TEXEL, CONSTANT), [0, 131, 50, 26]);
    }

    #[test]
    fn exact_neutral_texels_change_nothing() {
        assert_eq!(exact(1, BASE, [255; 4], CONSTANT), BASE);
        assert_eq!(exact(2, BASE, [9, 9, 9, 0], CONSTANT), BASE);
        assert_eq!(exact(3, BASE, [0, 0, 0, 255], CONSTANT), BASE);
    }

    proptest! {
        #[test]
        fn exact_any_colours_are_within_the_tolerance_of_the_unrounded(
            function in 0_u32..4, base in any::<Colour>(), texel in any::<Colour>(), constant in any::<Colour>(),
        ) {
            let found = exact(function, base, texel, constant);
            let right = unrounded(function, ideal(base), ideal(texel), constant);

            for c in 0..4 {
                prop_assert!((f64::from(found[c]) - right[c]).abs() <= tolerance(function, 0.0, 0.0));
            }
        }
    }
}
