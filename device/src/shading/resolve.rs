//! Resolve: identifiers of what is seen become frame buffer pixels, 16 at a time.
//!
//! A chunk of identifiers says which primitive is seen at each of its pixels (0: none of this draw).
//! One primitive after another is shaded for the whole chunk and blended in under the mask of its
//! pixels, so the work follows the number of primitives seen, not the lengths of runs.
//!
//! The lanes must equal the scalar functions of [`super::plane`] bit for bit.

use super::plane::{AffinePlane, ColourPlane, Interpolated, PerspectivePlane};
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16, mask32x16, u32x16};
use zga_abi::format::PixelFormat;

/// Pixels of a chunk.
pub const LANES: usize = 16;

/// Numbers of the lanes.
const LANE: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// A row of frame buffer pixels.
pub trait PixelRow {
    /// Writes the colour (RGBA, R in 7:0) of the pixel at column `x`.
    fn put(&mut self, x: usize, colour: u32);

    /// Writes the colours of the lanes in `seen`; lane 0 is column `x`, the chunk ends inside the row.
    fn put_chunk<S: Simd>(&mut self, simd: S, x: usize, colours: u32x16<S>, seen: mask32x16<S>);
}

/// 32-bit pixels; alpha is stored as it is or as 255.
pub struct Row32<'a> {
    /// The row's words, column 0 first.
    pub words: &'a mut [u32],
    /// OR-ed into each pixel: 0xFF00_0000 for XRGB.
    pub opaque: u32,
}

/// 16-bit pixels.
pub struct Row16<'a> {
    /// The row's pixels, column 0 first.
    pub pixels: &'a mut [u16],
}

impl PixelRow for Row32<'_> {
    #[inline(always)]
    fn put(&mut self, x: usize, colour: u32) {
        // RGBA with R lowest -> ARGB with B lowest: swap R and B.
        self.words[x] = colour.swap_bytes().rotate_right(8) | self.opaque;
    }

    #[inline(always)]
    fn put_chunk<S: Simd>(&mut self, simd: S, x: usize, colours: u32x16<S>, seen: mask32x16<S>) {
        let red = (colours & 0xFF) << 16_u32;
        let blue = (colours >> 16_u32) & 0xFF;
        let pixels = (colours & 0xFF00_FF00) | red | blue | self.opaque;
        let words = &mut self.words[x..x + LANES];
        seen.select(pixels, u32x16::from_slice(simd, words)).store_slice(words);
    }
}

impl PixelRow for Row16<'_> {
    #[inline(always)]
    fn put(&mut self, x: usize, colour: u32) {
        self.pixels[x] = PixelFormat::Rgb565.encode(colour.to_le_bytes()) as u16;
    }

    #[inline(always)]
    fn put_chunk<S: Simd>(&mut self, _simd: S, x: usize, colours: u32x16<S>, seen: mask32x16<S>) {
        let colours = colours.to_array();
        let mut left = seen.to_bitmask();
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            self.put(x + lane, colours[lane]);
            left &= left - 1;
        }
    }
}

/// What colours of pixels come from.
pub trait Sixteen {
    /// Colours of those of the 16 pixels from (`x`, `y`) on that are wanted, a bit each; the others mean nothing.
    fn sixteen<S: Simd>(&self, simd: S, x: i32, y: i32, wanted: u16) -> u32x16<S>;
}

/// Where the colour plane of a primitive comes from.
pub trait Planes {
    /// What colours come from. The kernel of [`Interpolated`] has no code for more.
    type Plane: Sixteen;

    /// The plane of primitive `id`.
    fn plane(&mut self, id: u32) -> &Self::Plane;
}

/// Shades the pixels of `row` that `ids` names; `ids[0]` stands at column `x0` of row `y`. The row
/// holds whole chunks of [`LANES`] pixels.
#[inline(always)]
pub fn resolve_row<S: Simd>(
    simd: S,
    row: &mut impl PixelRow,
    ids: &[u32],
    x0: usize,
    y: usize,
    planes: &mut impl Planes,
) {
    for (chunk, x) in ids.as_chunks::<LANES>().0.iter().zip((x0..).step_by(LANES)) {
        let ids = u32x16::from_slice(simd, chunk);
        let seen = ids.simd_gt(0);
        let mut left = seen.to_bitmask();
        if left == 0 {
            continue;
        }
        let mut colours = u32x16::splat(simd, 0);
        while left != 0 {
            let id = chunk[left.trailing_zeros() as usize % LANES];
            let mine = ids.simd_eq(id);
            left &= !mine.to_bitmask();
            let shaded = planes.plane(id).sixteen(simd, x as i32, y as i32, mine.to_bitmask() as u16);
            colours = mine.select(shaded, colours);
        }
        row.put_chunk(simd, x, colours, seen);
    }
}

impl Sixteen for ColourPlane {
    #[inline(always)]
    fn sixteen<S: Simd>(&self, simd: S, x: i32, y: i32, wanted: u16) -> u32x16<S> {
        match self {
            ColourPlane::Interpolated(plane) => plane.sixteen(simd, x, y, wanted),
            ColourPlane::Shaded(both) => {
                let colours = both.0.sixteen(simd, x, y, wanted).to_array();
                u32x16::from_slice(simd, &both.1.sixteen(simd, &colours, x, y, wanted))
            }
        }
    }
}

impl Sixteen for Interpolated {
    #[inline(always)]
    fn sixteen<S: Simd>(&self, simd: S, x: i32, y: i32, _wanted: u16) -> u32x16<S> {
        match self {
            Interpolated::Flat(colour) => u32x16::splat(simd, *colour),
            Interpolated::Affine(plane) => affine(simd, plane, x, y),
            Interpolated::Perspective(plane) => perspective(simd, plane, x, y),
            Interpolated::Line(_) | Interpolated::Precise(_) => u32x16::from_slice(simd, &one_by_one(self, x, y)),
        }
    }
}

/// Colours of 16 pixels without the help of lanes. Seldom called for, so apart from the kernels: it would take registers
/// from what is.
#[cold]
#[inline(never)]
fn one_by_one(plane: &Interpolated, x: i32, y: i32) -> [u32; LANES] {
    LANE.map(|lane| plane.colour(x + lane, y))
}

/// Colours of 16 pixels from (`x`, `y`) on.
#[inline(always)]
fn affine<S: Simd>(simd: S, plane: &AffinePlane, x: i32, y: i32) -> u32x16<S> {
    let lane = i32x16::from_slice(simd, &LANE);
    let mut colours = i32x16::splat(simd, 0);
    for (k, first) in plane.value(x, y).into_iter().enumerate() {
        let value = lane * plane.dx[k] + i32x16::splat(simd, first);
        let level = (value >> AffinePlane::FRACTION).max(plane.minimum[k]).min(plane.maximum[k]);
        colours |= level << (8 * k as u32);
    }
    colours.bitcast()
}

/// Colours of 16 pixels from (`x`, `y`) on.
#[inline(always)]
fn perspective<S: Simd>(simd: S, plane: &PerspectivePlane, x: i32, y: i32) -> u32x16<S> {
    let i: f32x16<S> = (i32x16::from_slice(simd, &LANE) + (x - plane.anchor[0])).to_float();
    let j = (y - plane.anchor[1]) as f32;
    let divisor = i * plane.dx[4] + plane.reference[4] + j * plane.dy[4];
    let mut colours = i32x16::splat(simd, 0);
    for k in 0..4 {
        let value = i * plane.dx[k] + plane.reference[k] + j * plane.dy[k];
        let level = (value / divisor).max_precise(plane.minimum[k]).min_precise(plane.maximum[k]);
        let level: i32x16<S> = (level + 0.5).to_int();
        colours |= level << (8 * k as u32);
    }
    colours.bitcast()
}
