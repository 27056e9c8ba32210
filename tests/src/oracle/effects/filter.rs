//! Lookups: one texel, four, or four of two levels.
//!
//! Of a level, texel i has its centre at i + 1/2. *Exact*: fractions of 8 bits, sums of 16, rounded once. *Ideal*: none
//! of that.

use super::coordinate::Axis;
use super::texel::{Filter, Texture};
use super::{Colour, Ideal, ideal};

/// 1/256 texel.
type Fixed = [i64; 2];

fn axes(texture: &Texture, level: u32) -> [Axis; 2] {
    [0, 1].map(|axis| Axis::of(texture, axis, level))
}

fn texel(texture: &Texture, level: u32, axes: &[Axis; 2], i: [i64; 2]) -> Colour {
    texture.levels[level as usize].at(axes[0].texel(i[0]), axes[1].texel(i[1]))
}

/// The nearest texel of a level.
#[must_use]
pub fn nearest(texture: &Texture, coordinates: [f64; 2], level: u32) -> Colour {
    let axes = axes(texture, level);
    texel(texture, level, &axes, [0, 1].map(|axis| axes[axis].exact(coordinates[axis]) >> 8))
}

/// Four texels of a level, weighted; 16 fraction bits.
#[must_use]
pub fn bilinear_sum(texture: &Texture, coordinates: [f64; 2], level: u32) -> [u64; 4] {
    let axes = axes(texture, level);
    let places: Fixed = [0, 1].map(|axis| axes[axis].exact(coordinates[axis]) - 128);
    let [x, y] = places.map(|place| place >> 8);
    let [fx, fy] = places.map(|place| (place & 255) as u64);
    let corners = [
        ((256 - fx) * (256 - fy), [x, y]),
        (fx * (256 - fy), [x + 1, y]),
        ((256 - fx) * fy, [x, y + 1]),
        (fx * fy, [x + 1, y + 1]),
    ];
    let corners = corners.map(|(weight, i)| (weight, texel(texture, level, &axes, i)));
    [0, 1, 2, 3].map(|c| corners.iter().map(|(weight, colour)| weight * u64::from(colour[c])).sum())
}

/// The lookup of a texture at a level of detail, 1/256 levels, within the levels that are used.
#[must_use]
pub fn exact(texture: &Texture, coordinates: [f64; 2], lambda: i32) -> Colour {
    let lambda = lambda as u32;
    let level = (lambda + 128) >> 8;
    match texture.filter {
        Filter::Nearest => nearest(texture, coordinates, level),
        Filter::Trilinear if texture.mip_map => {
            let (k, f) = (lambda >> 8, u64::from(lambda & 255));
            let first = bilinear_sum(texture, coordinates, k);
            // Without a fraction the next level has no weight, and need not be there.
            let second = if f == 0 { [0; 4] } else { bilinear_sum(texture, coordinates, k + 1) };
            [0, 1, 2, 3].map(|c| ((first[c] * (256 - f) + second[c] * f + (1 << 23)) >> 24) as u8)
        }
        Filter::Bilinear | Filter::Trilinear => {
            bilinear_sum(texture, coordinates, level).map(|sum| ((sum + 32768) >> 16) as u8)
        }
    }
}

/// Four texels of a level, weighted without rounding.
#[must_use]
pub fn bilinear_ideal(texture: &Texture, coordinates: [f64; 2], level: u32) -> Ideal {
    let axes = axes(texture, level);
    let places = [0, 1].map(|axis| axes[axis].ideal(coordinates[axis]) - 0.5);
    let [x, y] = places.map(|place| place.floor() as i64);
    let [fx, fy] = places.map(|place| place - place.floor());
    let at = |dx: i64, dy: i64| ideal(texel(texture, level, &axes, [x + dx, y + dy]));
    let (c00, c10, c01, c11) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
    [0, 1, 2, 3].map(|c| {
        let top = c00[c] + (c10[c] - c00[c]) * fx;
        let bottom = c01[c] + (c11[c] - c01[c]) * fx;
        top + (bottom - top) * fy
    })
}

/// The lookup at a level of detail in levels, without rounding but the choice of one texel or level that a filter makes.
#[must_use]
pub fn ideal_lookup(texture: &Texture, coordinates: [f64; 2], lambda: f64) -> Ideal {
    let level = (lambda + 0.5).floor() as u32;
    match texture.filter {
        Filter::Nearest => {
            let axes = axes(texture, level);
            let i = [0, 1].map(|axis| axes[axis].ideal(coordinates[axis]).floor() as i64);
            ideal(texel(texture, level, &axes, i))
        }
        Filter::Trilinear if texture.mip_map => {
            let (k, f) = (lambda.floor() as u32, lambda - lambda.floor());
            let first = bilinear_ideal(texture, coordinates, k);
            let second = if f > 0.0 { bilinear_ideal(texture, coordinates, k + 1) } else { first };
            [0, 1, 2, 3].map(|c| first[c] + (second[c] - first[c]) * f)
        }
        Filter::Bilinear | Filter::Trilinear => bilinear_ideal(texture, coordinates, level),
    }
}

/// Whether a coordinate that is off by `reach` texels, or a level of detail that is off by `levels`, could choose another
/// texel or level: there the ideal lookup has no single answer.
#[must_use]
pub fn in_doubt(texture: &Texture, coordinates: [f64; 2], lambda: f64, reach: f64, levels: f64) -> bool {
    let level = (lambda + 0.5).floor() as u32;
    let one_level = !(texture.filter == Filter::Trilinear && texture.mip_map);
    let off = lambda + 0.5 - (lambda + 0.5).round();
    let between = one_level && texture.used_levels() > 1 && off.abs() <= levels;
    // On both sides of an edge that goes on lies the same texel.
    let edge = texture.filter == Filter::Nearest
        && (0..2).any(|axis| {
            let along = Axis::of(texture, axis, level);
            let place = along.ideal(coordinates[axis]);
            let texel = |place: f64| along.texel(place.floor() as i64);
            texel(place - reach) != texel(place + reach)
        });
    between || edge
}

/// The most that a coordinate off by `reach` texels (1 or less) on each axis changes an interpolated lookup, in levels:
/// 255 a texel and axis.
#[must_use]
pub fn spread(filter: Filter, reach: f64) -> f64 {
    if filter == Filter::Nearest { 0.0 } else { 2.0 * 255.0 * reach }
}

#[cfg(test)]
#[path = "filter_tests.rs"]
mod tests;
