//! The two best surfaces of each pixel of a band, exactly, with few exact comparisons.
//!
//! Beside whose surface it is a pixel keeps its depth as an f64 whose error has a bound. Two depths whose difference is
//! beyond twice that bound are in the order that the floats say; all others are compared as fractions. Only the two that
//! are left in the end become fractions for the answer.
//!
//! The bound. Depths of covered pixels lie within those of the vertices, below 2^32. At a run's first pixel the exact
//! numerator and denominator are rounded and divided: three roundings, 3 * 2^-53 of the value. From there k steps: the
//! step has three roundings too, its product with k one; k steps are at most the range of the vertices, so 4 * 2^-53 of
//! 2^32. The sum has one rounding of less than 2^33. Together below 10 * 2^-21 = 2^-17.6, hence [`SLACK`] for two.

use std::cmp::Ordering;
use std::ops::Range;

use super::super::depth::TrueDepth;
use super::super::exact::Fraction;
use super::super::raster::Rows;
use super::{DepthFunction, Pixel, Surface};

/// A difference beyond this decides, in steps.
const SLACK: f64 = 1.0 / 65536.0;

/// Where a band lies.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Its first row.
    pub(super) top: u32,
    /// Pixels of a row.
    pub(super) width: u32,
}

type SetUp = [(Rows, Option<TrueDepth>)];

/// Whose depth, and about what; `None` is the background.
#[derive(Clone, Copy)]
struct About {
    depth: f64,
    who: Option<u32>,
}

#[derive(Clone, Copy)]
struct Pair {
    held: About,
    second: Option<About>,
}

/// Calls `visit` for every fragment of the band, primitive by primitive.
pub(super) fn for_each(
    pixels: &mut [Pixel],
    place: Place,
    set_up: &SetUp,
    bin: &[u32],
    mut visit: impl FnMut(&mut Pixel, Surface),
) {
    runs(pixels.len(), place, set_up, bin, |index, depth, j, run, row| {
        for i in run {
            visit(&mut pixels[row + i as usize], (depth.at(i as i32, j as i32), Some(index)));
        }
    });
}

/// Draws the band; `better` is the order of a surface that hides another.
pub(super) fn draw(
    pixels: &mut [Pixel],
    place: Place,
    set_up: &SetUp,
    bin: &[u32],
    function: DepthFunction,
    better: Ordering,
) {
    let Some(Pixel { held: (cleared, _), .. }) = pixels.first().copied() else { return };
    let exact = |about: About, i: u32, j: u32| {
        let depth = about.who.and_then(|who| set_up[who as usize].1.as_ref());
        depth.map_or(cleared, |depth| depth.at(i as i32, j as i32))
    };
    // Of the background's depth, an integer, the float is exact.
    let background = About { depth: about(cleared), who: None };
    let mut pairs = vec![Pair { held: background, second: None }; pixels.len()];
    runs(pixels.len(), place, set_up, bin, |index, depth, j, run, row| {
        let first = about(depth.at(run.start as i32, j as i32));
        let step = depth.step().map(about);
        for (k, i) in (0_u32..).zip(run) {
            let z = step.map_or_else(|| about(depth.at(i as i32, j as i32)), |step| first + f64::from(k) * step);
            let new = About { depth: z, who: Some(index) };
            let pair = &mut pairs[row + i as usize];
            let order = |a: About, b: About| {
                let difference = a.depth - b.depth;
                if difference > SLACK {
                    Ordering::Greater
                } else if difference < -SLACK {
                    Ordering::Less
                } else {
                    exact(a, i, j).cmp(&exact(b, i, j))
                }
            };
            let passes = passes(function, order(new, pair.held));
            let loser = if passes { std::mem::replace(&mut pair.held, new) } else { new };
            if pair.second.is_none_or(|second| order(loser, second) == better) {
                pair.second = Some(loser);
            }
        }
    });
    for (place_in_band, (pixel, pair)) in (0_u32..).zip(pixels.iter_mut().zip(pairs)) {
        let (i, j) = (place_in_band % place.width, place.top + place_in_band / place.width);
        let surface = |about: About| (exact(about, i, j), about.who);
        *pixel = Pixel { held: surface(pair.held), second: pair.second.map(surface), narrowest: None };
    }
}

/// Calls `visit` with index, depth, row, run, and where the row begins in the band, for all that is drawn.
fn runs(
    pixels: usize,
    place: Place,
    set_up: &SetUp,
    bin: &[u32],
    mut visit: impl FnMut(u32, &TrueDepth, u32, Range<u32>, usize),
) {
    let rows = pixels as u32 / place.width;
    for &index in bin {
        let (shape, Some(depth)) = &set_up[index as usize] else { continue };
        for row in 0..rows {
            let j = place.top + row;
            shape.for_each_run(j, |run| visit(index, depth, j, run, (row * place.width) as usize));
        }
    }
}

/// A fraction with three roundings.
fn about(fraction: Fraction) -> f64 {
    fraction.numerator() as f64 / fraction.denominator() as f64
}

/// Whether a function passes what has this order to the stored depth.
fn passes(function: DepthFunction, order: Ordering) -> bool {
    function.passes(&(order as i8), &0)
}
