//! Powers and directions against f64.

use super::{coordinate, exp2, log2, pow, reach};

/// 2^-24: half a unit in the last place of 1.
const HALF_ULP: f64 = 1.0 / 16_777_216.0;

/// Every f32 of -1..1's kind from `first` on, each `step`-th.
fn numbers(first: f32, last: f32, step: usize) -> impl Iterator<Item = f32> {
    let (a, b) = (first.abs().to_bits(), last.abs().to_bits());
    let negative = if first < 0.0 { 1_u32 << 31 } else { 0 };
    (a.min(b)..=a.max(b)).step_by(step).map(move |bits| f32::from_bits(bits | negative))
}

#[test]
fn log2_of_every_mantissa_stays_within_its_error() {
    // The polynomial's 2.8 half units, and those of the sums, the product and, below 1 / sqrt 2, the difference of twice
    // the size of the result.
    let relative = |x: f32| (f64::from(log2(x)) / f64::from(x).log2() - 1.0).abs();
    let most = numbers(0.5, 1.0_f32.next_down(), 1).map(relative).fold(0.0, f64::max);
    assert!(most <= LOG2_ERROR * HALF_ULP, "{} half units", most / HALF_ULP);
    assert_eq!(log2(1.0), 0.0);
}

/// Relative, half units.
const LOG2_ERROR: f64 = 7.0;
/// Relative, half units: 5.6 of the grid (ln 2 times 2^-21), the last sum's 1, which counts double below 1, the product's.
const EXP2_ERROR: f64 = 8.0;

#[test]
fn log2_of_small_numbers_stays_within_its_error() {
    for exponent in [-2, -3, -10, -64, -126] {
        let scale = 2.0_f32.powi(exponent);
        for x in numbers(1.0, 2.0, 97).map(|m| m * scale) {
            let exact = f64::from(x).log2();
            let error = (f64::from(log2(x)) - exact).abs();
            assert!(error <= 4.0 * HALF_ULP + HALF_ULP * exact.abs(), "log2 {x:e}: {error:e}");
        }
    }
}

#[test]
fn exp2_stays_within_its_error() {
    let relative = |y: f32| (f64::from(exp2(y)) / f64::from(y).exp2() - 1.0).abs();
    let most = numbers(-1e-9, -125.999, 211).map(relative).fold(0.0, f64::max);
    assert!(most <= EXP2_ERROR * HALF_ULP, "{} half units", most / HALF_ULP);
}

#[test]
fn exp2_rises_with_its_argument() {
    // Two binades of all arguments that it tells apart; the others are these times a power of two.
    let powers: Vec<f32> = (0..=1 << 21).map(|k| exp2(k as f32 / -1_048_576.0)).collect();
    assert!(powers.is_sorted_by(|a, b| a > b));
    // Between two of them it is one of the two.
    let between = numbers(-0.25, -1.75, 1).map(exp2);
    assert!(between.is_sorted_by(|a, b| a >= b));
}

#[test]
fn exp2_of_whole_numbers_is_exact() {
    for n in 0..126 {
        assert_eq!(f64::from(exp2(-(n as f32))), f64::from(-n).exp2());
    }
    assert_eq!(exp2(-0.0), 1.0);
}

#[test]
fn exp2_past_its_range_is_0() {
    for y in [-126.0, -127.0, -1e9, f32::MIN, f32::NEG_INFINITY, f32::NAN] {
        assert_eq!(exp2(y).to_bits(), 0, "{y}");
    }
}

#[test]
fn pow_stays_within_its_error() {
    for e in [0.01, 0.5, 1.0, 2.0, 7.3, 20.0, 64.0, 128.0] {
        for x in numbers(1e-6, 1.0, 1009) {
            let exact = f64::from(x).powf(f64::from(e));
            let y = f64::from(e) * f64::from(x).log2();
            if y > -120.0 {
                let relative = (f64::from(pow(x, e)) / exact - 1.0).abs();
                // exp2's own error, and ln 2 times those of log2 and the product, each relative to y.
                let bound = (EXP2_ERROR + 0.7 * (LOG2_ERROR + 1.0) * y.abs()) * HALF_ULP;
                assert!(relative <= bound, "{x}^{e}: {} half units", relative / HALF_ULP);
            }
        }
    }
}

#[test]
fn pow_at_the_ends_is_exact() {
    for x in [0.0, 1e-45, 1e-38, 0.3, 1.0] {
        assert_eq!(pow(x, 0.0), 1.0, "{x}^0");
    }
    for e in [1e-45, 1e-3, 1.0, 128.0] {
        assert_eq!(pow(1.0, e), 1.0, "1^{e}");
        assert_eq!(pow(0.0, e).to_bits(), 0, "0^{e}");
        assert_eq!(pow(f32::MIN_POSITIVE.next_down(), e), 0.0, "subnormal^{e}");
    }
}

#[test]
fn coordinates_not_finite_count_as_0() {
    for x in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(coordinate(x).to_bits(), 0);
    }
    let limit = 2.0_f32.powi(125);
    assert_eq!([f32::MAX, f32::MIN, 1e-45, -3.5].map(coordinate), [limit, -limit, 1e-45, -3.5]);
}

#[test]
fn reach_of_vectors_of_any_size_is_a_unit_vector() {
    let shapes = [[1.0, 0.0, 0.0], [0.3, -0.4, 1.2], [1.0, 1.0, 1.0], [-1.0, 1e-3, 0.999]];
    for exponent in -120..=125 {
        for v in shapes.map(|shape| shape.map(|c: f32| c * 2.0_f32.powi(exponent))) {
            let length = v.map(f64::from).map(|c| c * c).iter().sum::<f64>().sqrt();
            let found = reach(v);
            for (found, exact) in found.unit.iter().zip(v.map(|c| f64::from(c) / length)) {
                // The square's three roundings halved by the root, the root, the quotient, the product.
                assert!((f64::from(*found) - exact).abs() <= 4.5 * HALF_ULP * exact.abs(), "{v:?}");
            }
            let found = f64::from(found.square).sqrt() * f64::from(found.scale);
            // The square's roundings again, halved.
            assert!((found / length - 1.0).abs() <= 1.5 * HALF_ULP, "{v:?}: {found} for {length}");
        }
    }
}

#[test]
fn reach_of_nothing_is_zero() {
    for zero in [0.0, -0.0] {
        let found = reach([zero; 3]);
        assert!(found.unit == [0.0; 3] && found.square == 0.0 && found.scale == 0.0);
    }
    assert_eq!(reach([1e-45, 0.0, 0.0]).unit, [1.0, 0.0, 0.0], "the least vector has a direction");
}
