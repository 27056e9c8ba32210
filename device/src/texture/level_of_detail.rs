//! Level of detail: how many texels a pixel covers becomes a level of the MIP map.
//!
//! Duties: rho, the longer of the pixel's two sides in texels of level 0; its logarithm; bias and clamp. Inputs from: the
//! derivatives of the coordinates, the window's size. Outputs to: the filter. Clocks: none of its own.
//!
//! The base-2 logarithm is made of basic operations in f64, so every host has the same bits: the exponent, and for the
//! mantissa 1 + t, cut to 20 bits, t + t (1 - t) q(t). That form is exact at both ends of an octave; q is the polynomial
//! of degree 5 through (log2(1 + t) - t) / (t (1 - t)) at the six Chebyshev nodes of 0..1, t = (1 - cos(pi (2 i + 1) /
//! 12)) / 2, computed with 40 digits and rounded. The polynomial is wrong by at most 1.1e-6, the cut by at most
//! 2^-20 / ln 2 = 1.4e-6; half of their sum, in levels, is far below 2^-12. Its slope is at least 0.72, so from one
//! mantissa of 20 bits to the next it climbs by 6.8e-7, which the roundings, at 2^-50, cannot undo: it is monotone.

/// Coefficients of q, from that of t^0 on.
const Q: [f64; 6] = [
    0.442_688_853_537_296_4,
    -0.278_201_673_132_911_66,
    0.196_661_002_612_440_24,
    -0.131_446_539_289_713_17,
    0.064_072_939_874_211_32,
    -0.015_125_446_952_607_258,
];

/// Base-2 logarithm of `x`, which is not negative: 1024 and more for what is not finite, -1023 for 0.
#[must_use]
#[inline(always)]
pub fn log2(x: f64) -> f64 {
    // The high word holds sign, exponent and the first 20 bits of the mantissa. A NaN can have either sign.
    let high = (x.to_bits() >> 32) as u32;
    let exponent = f64::from((high >> 20 & 0x7FF) as i32 - 1023);
    let t = f64::from_bits(u64::from(high & 0xF_FFFF | 0x3FF0_0000) << 32) - 1.0;
    let q = Q[0] + t * (Q[1] + t * (Q[2] + t * (Q[3] + t * (Q[4] + t * Q[5]))));
    exponent + (t + t * (1.0 - t) * q)
}

/// Level of detail in 1/256 levels, `bias` added, in 0..=`last`, of `[du/dx, dv/dx, du/dy, dv/dy]` per pixel in a window
/// of `size` texels.
#[must_use]
#[inline(always)]
pub fn lambda(gradients: [f64; 4], size: [f64; 2], bias: i32, last: i32) -> i32 {
    let side = |du: f64, dv: f64| {
        let (x, y) = (du * size[0], dv * size[1]);
        x * x + y * y
    };
    let (along_x, along_y) = (side(gradients[0], gradients[1]), side(gradients[2], gradients[3]));
    // A NaN of either must win: no texel size is known then.
    let rho2 = if along_x > along_y || along_x.is_nan() { along_x } else { along_y };
    // 0 has a logarithm of -1023, infinity and NaN have one of 1024 at least; no bias of up to 128 levels, 256 in rho2's
    // logarithm, keeps those from their ends of the range.
    let lambda = super::coordinates::to_integer((128.0 * log2(rho2) + 0.5).floor());
    lambda.wrapping_add(bias).max(0).min(last)
}
