//! Filter: four texels, and two levels, become one.
//!
//! Duties: weighted means of texels, weights in 1/256. Inputs from: the texture memory. Outputs to: the texture function.
//! Clocks: 1 a look-up, 2 with two levels: one for each four texels.
//!
//! A bilinear sum has 16 fraction bits and is exact, a trilinear one has 24 and fits 32 bits; rounding comes once, at
//! the end. As sums are exact, the fast code may take them in another order: first along x, two channels in a word (a
//! channel has 16 bits then), then along y.

use super::coordinates::LANES;

/// The four texels around each of 16 pixels, and where it lies between them.
#[derive(Clone, Copy, Debug)]
pub struct Quads {
    /// RGBA: upper left, upper right, lower left, lower right.
    pub corners: [[u32; LANES]; 4],
    /// Weights of the right and of the lower texels, 0..=256.
    pub weight: [[u32; LANES]; 2],
}

/// Sums of 16 pixels: R, G, B, A, each with 16 fraction bits.
pub type Sums = [[u32; LANES]; 4];

/// Sums, R, G, B, A with 16 fraction bits, of the texels upper left, upper right, lower left, lower right; `fraction` is
/// the place between them, 0..=255. The specification.
#[must_use]
pub fn bilinear_sums(corners: [u32; 4], fraction: [u32; 2]) -> [u32; 4] {
    let [fx, fy] = fraction;
    let weights = [(256 - fx) * (256 - fy), fx * (256 - fy), (256 - fx) * fy, fx * fy];
    let mut sums = [0; 4];
    for (corner, weight) in corners.into_iter().zip(weights) {
        for (sum, channel) in sums.iter_mut().zip(corner.to_le_bytes()) {
            *sum += u32::from(channel) * weight;
        }
    }
    sums
}

/// The texel, RGBA, of bilinear sums: the specification.
#[must_use]
pub fn bilinear_texel(sums: [u32; 4]) -> u32 {
    u32::from_le_bytes(sums.map(|sum| ((sum + 0x8000) >> 16) as u8))
}

/// The texel, RGBA, between two levels with these sums; `fraction` is the weight of the second, 0..=255. The
/// specification.
#[must_use]
pub fn trilinear_texel(near: [u32; 4], far: [u32; 4], fraction: u32) -> u32 {
    let channel = |k: usize| (near[k] * (256 - fraction) + far[k] * fraction + 0x80_0000) >> 24;
    u32::from_le_bytes([0, 1, 2, 3].map(|k| channel(k) as u8))
}

/// `from` and `to` mixed by `weight`, 256 of which is all of `to`; in 1/256. Two values side by side are mixed at once.
#[inline(always)]
fn mix(from: u32, to: u32, weight: u32) -> u32 {
    (from << 8).wrapping_add(to.wrapping_sub(from).wrapping_mul(weight))
}

/// [`bilinear_sums`] of 16 pixels.
#[must_use]
#[inline(always)]
pub fn sum_lanes(quads: &Quads) -> Sums {
    const EVEN: u32 = 0x00FF_00FF;
    let mut sums = [[0; LANES]; 4];
    let [upper_left, upper_right, lower_left, lower_right] = &quads.corners;
    for i in 0..LANES {
        let (x, y) = (quads.weight[0][i], quads.weight[1][i]);
        let upper = mix(upper_left[i] & EVEN, upper_right[i] & EVEN, x);
        let lower = mix(lower_left[i] & EVEN, lower_right[i] & EVEN, x);
        sums[0][i] = mix(upper & 0xFFFF, lower & 0xFFFF, y);
        sums[2][i] = mix(upper >> 16, lower >> 16, y);
        let upper = mix(upper_left[i] >> 8 & EVEN, upper_right[i] >> 8 & EVEN, x);
        let lower = mix(lower_left[i] >> 8 & EVEN, lower_right[i] >> 8 & EVEN, x);
        sums[1][i] = mix(upper & 0xFFFF, lower & 0xFFFF, y);
        sums[3][i] = mix(upper >> 16, lower >> 16, y);
    }
    sums
}

/// [`bilinear_texel`] of 16 pixels.
#[must_use]
#[inline(always)]
pub fn bilinear_lanes(sums: &Sums) -> [u32; LANES] {
    let mut texel = [0; LANES];
    for i in 0..LANES {
        let channel = |k: usize| sums[k][i].wrapping_add(0x8000) >> 16;
        texel[i] = channel(0) | channel(1) << 8 | channel(2) << 16 | channel(3) << 24;
    }
    texel
}

/// [`trilinear_texel`] of 16 pixels.
#[must_use]
#[inline(always)]
pub fn trilinear_lanes(near: &Sums, far: &Sums, fraction: &[u32; LANES]) -> [u32; LANES] {
    let mut texel = [0; LANES];
    for i in 0..LANES {
        let channel = |k: usize| mix(near[k][i], far[k][i], fraction[i]).wrapping_add(0x80_0000) >> 24;
        texel[i] = channel(0) | channel(1) << 8 | channel(2) << 16 | channel(3) << 24;
    }
    texel
}
