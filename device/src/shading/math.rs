//! Powers and directions, in f32, for [`super::light`] and [`super::fog`].
//!
//! Only basic operations and square roots, each rounded once, in the order written: the same bits on every machine
//! and in lanes of any width. No branches that depend on values but selections, so that loops over lanes become SIMD.
//!
//! The polynomials are the minimax ones of their degree (Remez exchange, 40 digits, coefficients rounded to f32):
//! * log2(m) = f P(f) with f = m - 1 and 1 / sqrt 2 <= m < sqrt 2, by relative error: P of degree 7, 1.7e-7;
//! * 2^f = 1 + f Q(f) with |f| <= 1/2, by relative error, exact at f = 0: Q of degree 5, 2.6e-9.
//!
//! exp2 takes f to the nearest multiple of 2^-20. Two neighbours differ by 11 * 2^-24 of their value then, more than roundings
//! make of it: exp2 is monotone, and fog, which rests on it.
//!
//! With all roundings: log2 within 7 * 2^-24, relative, for x in 1/2..1, and within (4 + |log2 x|) 2^-24 below; exp2 within
//! 8 * 2^-24, relative; pow within (8 + 5.6 |e log2 x|) 2^-24, relative. The tests measure all of them.

use std::f32::consts::{LN_2, LOG2_E};

/// Coordinates are limited to this, 2^125: differences of two, and squares of scaled ones, stay finite.
const LIMIT: f32 = f32::from_bits((125 + 127) << 23);
/// Exponent field of an f32.
const EXPONENT: u32 = 0xFF << 23;
/// 1 / sqrt 2, just below: mantissas begin here.
const LEAST_MANTISSA: u32 = 0x3F35_04F3;
/// Adding and subtracting 1.5 * 2^23 rounds an f32 of magnitude below 2^22 to an integer, ties to even.
const ROUND: f32 = 12_582_912.0;
/// Adding and subtracting 1.5 * 2^3 rounds an f32 of magnitude below 4 to a multiple of 2^-20.
const GRID: f32 = 12.0;
/// P, lowest power first; rounded, its first is log2 e.
const LOG2: [f32; 8] =
    [LOG2_E, -0.721_352_8, 0.480_923_24, -0.360_239_64, 0.287_098_7, -0.248_876_85, 0.234_042_4, -0.145_811_78];
/// Q, lowest power first; rounded, its first is ln 2.
const EXP2: [f32; 6] = [LN_2, 0.240_226_53, 0.055_503_106, 0.009_617_693, 0.001_340_664_4, 0.000_155_946_78];

/// A vector, component by component.
pub type Vector = [f32; 3];

/// log2 of a normal, positive, finite `x`. Of other numbers the result means nothing, but is finite.
#[must_use]
#[inline(always)]
pub fn log2(x: f32) -> f32 {
    let above = x.to_bits().wrapping_sub(LEAST_MANTISSA) & 0xFF80_0000;
    let f = f32::from_bits(x.to_bits().wrapping_sub(above)) - 1.0;
    let exponent = ((above as i32) >> 23) as f32;
    let [c0, c1, c2, c3, c4, c5, c6, c7] = LOG2;
    // In pairs: a chain half as long.
    let square = f * f;
    let (low, high) = ((c0 + c1 * f) + (c2 + c3 * f) * square, (c4 + c5 * f) + (c6 + c7 * f) * square);
    exponent + f * (low + high * (square * square))
}

/// 2^`y` for `y` of 0 or less; 0 for `y` of -126 or less. Never falls as `y` grows; exact for whole numbers.
#[must_use]
#[inline(always)]
pub fn exp2(y: f32) -> f32 {
    let in_range = y > -126.0;
    let y = if in_range { y } else { 0.0 };
    let rounded = y + ROUND;
    let f = ((y - (rounded - ROUND)) + GRID) - GRID;
    let [c0, c1, c2, c3, c4, c5] = EXP2;
    let square = f * f;
    let q = (c0 + c1 * f) + square * ((c2 + c3 * f) + square * (c4 + c5 * f));
    // The integer stands in the low bits of `rounded`: shifted, it adds to the exponent.
    let power = f32::from_bits((1.0 + f * q).to_bits().wrapping_add(rounded.to_bits() << 23));
    if in_range { power } else { 0.0 }
}

/// `x`^`e` for `x` in 0..=1 and a finite `e` of 0 or more. x^0 = 1; 0^e = 0 for e > 0. An `x` below 2^-126 counts as 0.
#[must_use]
#[inline(always)]
pub fn pow(x: f32, e: f32) -> f32 {
    let of_zero = if e > 0.0 { 0.0 } else { 1.0 };
    // At e = 0 the product is a zero: log2 is finite whatever x is.
    let power = exp2(e * log2(x));
    if x >= f32::MIN_POSITIVE { power } else { of_zero }
}

/// A coordinate as the unit takes it: not finite counts as 0, beyond +-2^125 as +-2^125.
#[must_use]
#[inline(always)]
pub fn coordinate(x: f32) -> f32 {
    let size = x.abs();
    let limited = if size < f32::INFINITY { LIMIT.copysign(x) } else { 0.0 };
    if size <= LIMIT { x } else { limited }
}

/// `a` . `b`, added from x to z.
#[must_use]
#[inline(always)]
pub fn dot(a: Vector, b: Vector) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// A direction and how far it reached.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Unit vector; zero for the zero vector.
    pub unit: Vector,
    /// Squared length in units of `scale`, 1..12 (less where a component is subnormal); 0 for the zero vector.
    pub square: f32,
    /// Power of two; 0 for vectors of subnormal components.
    pub scale: f32,
}

/// Direction and length of a vector of components within +-2^126: scaled by a power of two so that its largest
/// component lies in 1..2, then divided by the square root of its square. Components of the unit vector are within
/// 4 * 2^-24 of true, relative.
#[must_use]
#[inline(always)]
pub fn reach(v: Vector) -> Reach {
    let [x, y, z] = v.map(f32::abs);
    let most = if x > y { x } else { y };
    let most = if most > z { most } else { z };
    let exponent = most.to_bits() & EXPONENT;
    // 254 less the biased exponent: 2^-(exponent), and 2^127 for subnormal components.
    let inverse = f32::from_bits((254_u32 << 23).wrapping_sub(exponent));
    let scaled = [v[0] * inverse, v[1] * inverse, v[2] * inverse];
    let square = dot(scaled, scaled);
    let per_length = 1.0 / square.sqrt();
    // The quotient of the zero vector is infinite; it goes no farther.
    let per_length = if square > 0.0 { per_length } else { 0.0 };
    let unit = [scaled[0] * per_length, scaled[1] * per_length, scaled[2] * per_length];
    Reach { unit, square, scale: f32::from_bits(exponent) }
}

#[cfg(test)]
mod tests;
