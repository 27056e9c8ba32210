//! Level of detail: how many texels of level 0 a pixel covers, as a power of two.

use super::texel::Texture;

/// Derivatives of the coordinates: of u and v for a pixel to the right, then for a pixel down.
pub type Gradient = [[f64; 2]; 2];

/// The larger square of texels a pixel covers in a direction: `max((du/dx Sx)^2 + (dv/dx Sy)^2, ...)`.
#[must_use]
pub fn rho_squared(gradient: &Gradient, window: [u32; 2]) -> f64 {
    let [across, down] = gradient.map(|[u, v]| {
        let [u, v] = [u * f64::from(window[0]), v * f64::from(window[1])];
        u * u + v * v
    });
    // A NaN in either is one of both.
    if across.is_nan() || down.is_nan() { f64::NAN } else { across.max(down) }
}

/// Level of detail in levels, unrounded, within the levels that are used.
#[must_use]
pub fn ideal(texture: &Texture, rho_squared: f64) -> f64 {
    let last = f64::from(texture.used_levels() - 1);
    if !rho_squared.is_finite() {
        return last;
    }
    if rho_squared == 0.0 {
        return 0.0;
    }
    (0.5 * rho_squared.log2() + f64::from(texture.bias) / 256.0).clamp(0.0, last)
}

/// The same in 1/256 levels, rounded half up; good for one unit where the logarithm is near a half.
#[must_use]
pub fn exact(texture: &Texture, rho_squared: f64) -> i32 {
    let last = 256 * (texture.used_levels() as i32 - 1);
    if !rho_squared.is_finite() {
        return last;
    }
    if rho_squared == 0.0 {
        return 0;
    }
    ((128.0 * rho_squared.log2() + 0.5).floor() as i32 + texture.bias).clamp(0, last)
}

#[cfg(test)]
mod tests {
    use super::super::texel::{Filter, Format, Level};
    use super::*;

    fn texture(bias: i32, mip_map: bool) -> Texture {
        Texture {
            format: Format::Rgba8888,
            levels: vec![Level { size: [1, 1], texels: vec![[0; 4]] }; 5],
            offset: [0; 2],
            window: [16, 8],
            repeat: [false; 2],
            mirror: [false; 2],
            filter: Filter::Nearest,
            function: 0,
            constant: [0; 4],
            bias,
            mip_map,
        }
    }

    #[test]
    fn rho_squared_is_that_of_the_longer_side() {
        // 2 texels across in u and 2 in v; 4 down in v.
        assert_eq!(rho_squared(&[[2.0 / 16.0, 2.0 / 8.0], [0.0, 4.0 / 8.0]], [16, 8]), 16.0);
        assert!(rho_squared(&[[f64::NAN, 0.0], [1.0, 1.0]], [16, 8]).is_nan());
    }

    #[test]
    fn exact_powers_of_two_are_levels() {
        let at = |texels: f64| exact(&texture(0, true), texels * texels);

        assert_eq!([0.25, 1.0, 2.0, 4.0, 16.0, 1000.0].map(at), [0, 0, 256, 512, 1024, 1024]);
        assert_eq!(at(2.0_f64.sqrt()), 128);
    }

    #[test]
    fn exact_bias_and_odd_numbers_stay_within_the_levels() {
        assert_eq!(exact(&texture(-100, true), 4.0), 156);
        assert_eq!(exact(&texture(-300, true), 4.0), 0);
        assert_eq!(exact(&texture(32767, true), 4.0), 1024);
        assert_eq!([f64::NAN, f64::INFINITY, 0.0].map(|rho| exact(&texture(0, true), rho)), [1024, 1024, 0]);
        assert_eq!(exact(&texture(500, false), 4.0), 0);
        assert_eq!(exact(&texture(0, true), f64::MIN_POSITIVE / 8.0), 0);
    }

    #[test]
    fn exact_is_monotone_and_within_half_a_unit_of_the_ideal() {
        let texture = texture(7, true);
        let mut last = 0;
        for k in 0..20_000 {
            let rho = f64::from(k) * 0.01;
            let (found, right) = (exact(&texture, rho), ideal(&texture, rho));
            assert!(found >= last && (f64::from(found) - 256.0 * right).abs() <= 0.5 + 1.0e-9, "{rho}");
            last = found;
        }
    }
}
