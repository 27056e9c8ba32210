//! Colours of one primitive at 16 places that lie anywhere: those of fragments, which the sub-pixel unit collects.
//!
//! The lanes must equal the scalar functions of [`super::plane`] and [`super::source`] bit for bit. Inputs from:
//! [`crate::subpixel`]. Clocks: none of their own.

use super::plane::{AffinePlane, Interpolated, Interpolation, PerspectivePlane};
use super::resolve::LANES;
use super::source::ColourSource;
use crate::geometry::{CENTRE, PIXEL};
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16, u32x16};

/// 16 places, columns and rows in u.
pub type Places = [[i32; LANES]; 2];

/// Colours at the centres of the pixels that begin at or before `at`: [`Interpolated::colour`].
#[must_use]
#[inline(never)]
pub fn at_centres<S: Simd>(simd: S, plane: &Interpolated, at: &Places) -> [u32; LANES] {
    simd.vectorize(
        #[inline(always)]
        || match plane {
            Interpolated::Flat(colour) => [*colour; LANES],
            Interpolated::Affine(plane) => affine(simd, plane, at),
            Interpolated::Perspective(plane) => perspective(simd, plane, at),
            Interpolated::Line(_) | Interpolated::Precise(_) => {
                std::array::from_fn(|lane| plane.colour(at[0][lane] >> 8, at[1][lane] >> 8))
            }
        },
    )
}

/// Colours of a triangle at places that it covers: [`ColourSource::colour_at`].
#[must_use]
#[inline(never)]
pub fn at_places<S: Simd>(simd: S, source: &ColourSource, at: &Places, interpolation: Interpolation) -> [u32; LANES] {
    simd.vectorize(
        #[inline(always)]
        || {
            if interpolation == Interpolation::Flat || source.is_even() {
                return [source.flat(); LANES];
            }
            let shares = source.shares(interpolation);
            let (mut second, mut third) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                [second[lane], third[lane]] = shares.at([at[0][lane], at[1][lane]]);
            }
            let mut colours = [0; LANES];
            for k in 0..4 {
                let channel = source.mixture(k);
                for lane in 0..LANES {
                    colours[lane] |= channel.level([second[lane], third[lane]]) << (8 * k);
                }
            }
            colours
        },
    )
}

/// From a plane's anchor to the pixels of places.
#[inline(always)]
fn offsets<S: Simd>(simd: S, anchor: [i32; 2], at: &Places) -> [i32x16<S>; 2] {
    // Not by `map`, whose code may stand apart, without lanes.
    let (x, y) = (i32x16::from_slice(simd, &at[0]), i32x16::from_slice(simd, &at[1]));
    [(x >> PIXEL.ilog2()) - anchor[0], (y >> PIXEL.ilog2()) - anchor[1]]
}

/// The lanes as colours.
#[inline(always)]
fn colours_of<S: Simd>(colours: i32x16<S>) -> [u32; LANES] {
    let mut stored = [0; LANES];
    let colours: u32x16<S> = colours.bitcast();
    colours.store_slice(&mut stored);
    stored
}

#[inline(always)]
fn affine<S: Simd>(simd: S, plane: &AffinePlane, at: &Places) -> [u32; LANES] {
    let [i, j] = offsets(simd, plane.anchor, at);
    let mut colours = i32x16::splat(simd, 0);
    for k in 0..4 {
        let value = i * plane.dx[k] + plane.reference[k] + j * plane.dy[k];
        let level = (value >> AffinePlane::FRACTION).max(plane.minimum[k]).min(plane.maximum[k]);
        colours |= level << (8 * k as u32);
    }
    colours_of(colours)
}

#[inline(always)]
fn perspective<S: Simd>(simd: S, plane: &PerspectivePlane, at: &Places) -> [u32; LANES] {
    let [i, j] = offsets(simd, plane.anchor, at);
    let (i, j): (f32x16<S>, f32x16<S>) = (i.to_float(), j.to_float());
    let value = |k: usize| i * plane.dx[k] + plane.reference[k] + j * plane.dy[k];
    let divisor = value(4);
    let mut colours = i32x16::splat(simd, 0);
    for k in 0..4 {
        let level = (value(k) / divisor).max_precise(plane.minimum[k]).min_precise(plane.maximum[k]);
        let level: i32x16<S> = (level + 0.5).to_int();
        colours |= level << (8 * k as u32);
    }
    colours_of(colours)
}

/// The centre of the pixel (`x`, `y`), u.
#[must_use]
#[inline(always)]
pub const fn centre_of(x: i32, y: i32) -> [i32; 2] {
    [x * PIXEL + CENTRE, y * PIXEL + CENTRE]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ScreenVertex;
    use crate::hidden::z_buffer::specification::covers;
    use crate::shading::plane::ColourPlane;
    use fearless_simd::{Level, dispatch};
    use proptest::prelude::*;

    fn vertex() -> impl Strategy<Value = ScreenVertex> {
        let w = prop_oneof![Just(1.0_f32), 0.001_f32..4.0];
        (-4000_i32..4000, -4000_i32..4000, any::<u32>(), w).prop_map(|(x, y, colour, reciprocal_w)| ScreenVertex {
            x,
            y,
            z: 0,
            colour,
            reciprocal_w,
        })
    }

    proptest! {
        #[test]
        fn scattered_colours_equal_single_ones(
            v in [vertex(), vertex(), vertex()],
            interpolation in prop::sample::select(vec![Interpolation::Flat, Interpolation::Affine, Interpolation::Perspective]),
            at in [prop::array::uniform16(-5000_i32..5000), prop::array::uniform16(-5000_i32..5000)],
        ) {
            let source = ColourSource::new(&v);
            let plane = ColourPlane::triangle(&source, interpolation);
            for level in [Level::new(), Level::baseline()] {
                let centres = dispatch!(level, simd => at_centres(simd, &plane, &at));
                let places = dispatch!(level, simd => at_places(simd, &source, &at, interpolation));
                for lane in 0..LANES {
                    let [x, y] = [at[0][lane], at[1][lane]];
                    prop_assert_eq!(places[lane], source.colour_at([x, y], interpolation));
                    // A plane says nothing far from its primitive.
                    if covers(&v, x >> 8, y >> 8) {
                        prop_assert_eq!(centres[lane], plane.colour(x >> 8, y >> 8));
                    }
                }
            }
        }
    }
}
