//! Peak signal-to-noise ratio of a picture.

/// 10 log10(255^2 / mean square error) over the channels of all pixels, decibels; infinite for equal pictures, not a
/// number where there are no pixels or not as many.
#[must_use]
pub fn psnr(reference: &[[f64; 3]], test: &[[f64; 3]]) -> f64 {
    if reference.len() != test.len() || reference.is_empty() {
        return f64::NAN;
    }
    let squares = reference.iter().flatten().zip(test.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
    let mean = squares.sum::<f64>() / (3 * reference.len()) as f64;
    10.0 * (255.0 * 255.0 / mean).log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psnr_of_one_level_everywhere_is_48_decibels() {
        let (a, b) = ([[100.0; 3]; 4], [[101.0; 3]; 4]);
        assert!((psnr(&a, &b) - 48.130_803_608_679_1).abs() < 1e-9);
        assert!(psnr(&a, &a).is_infinite() && psnr(&[], &[]).is_nan() && psnr(&a, &b[..1]).is_nan());
    }
}
