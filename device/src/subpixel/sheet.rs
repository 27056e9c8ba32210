//! A sheet of triangles in a tile of 16 x 16 pixels: which pixels it covers, how often, and at which depths; and which of
//! some sheets is the nearest there.
//!
//! How often a sheet covers a place changes at its borders alone: its triangles say how often it covers the centre of the
//! tile's first pixel, its borders where on the way to other pixels that changes, first down the first column, then along
//! the line; and where no border passes between the samples they all are covered as often as the centre.
//!
//! A sheet hides another in a pixel if all of its depths there are nearer. Bounds of the depths of a whole tile say that of
//! most triangles; of the others they are found pixel by pixel.
//!
//! Everything here may err towards "not certain".
//!
//! Inputs from: [`super::inside`]. Outputs to: the same. Clocks: none.

use super::band::{Input, LINES};
use super::bands::Entry;
use super::edges::{Sides, after};
use super::slant::{ROUNDING, Slant};
use super::{Setting, slant};
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, i16x16, mask32x16};

/// What a border is taken for wider, u: more than the rounding of where it crosses a line.
const SPARE: f64 = 1.0;
/// Numbers of the lanes.
const LANE: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];

/// A number for each pixel of a tile.
type Pixels = [[f32; LANES]; LINES];

/// A sheet in a tile.
#[derive(Debug)]
pub(super) struct Sheet {
    /// First column and row of the tile, pixels.
    place: [i32; 2],
    lines: usize,
    /// How often centres are covered.
    counts: [[i16; LANES]; LINES],
    /// A bit a pixel between whose samples a border may pass.
    borders: [u16; LINES],
    /// Bounds of the depths in pixels that it may touch.
    near: Pixels,
    far: Pixels,
}

impl Default for Sheet {
    fn default() -> Self {
        let nothing = [[0.0; LANES]; LINES];
        let (counts, borders) = ([[0; LANES]; LINES], [0; LINES]);
        Sheet { place: [0; 2], lines: 0, counts, borders, near: nothing, far: nothing }
    }
}

impl Sheet {
    /// A sheet of the tile of a chunk, without a border; `covers` says how often it covers the centre of the first pixel,
    /// `bounds` are those of the depths of triangles that are not bounded pixel by pixel.
    #[inline(always)]
    pub(super) fn begin(&mut self, input: &Input<'_>, chunk: usize, covers: i16, bounds: [i32; 2]) {
        self.place = [(chunk * LANES) as i32, input.top];
        self.lines = input.lines;
        self.counts = [[covers; LANES]; LINES];
        self.borders = [0; LINES];
        let [near, far] = slant::floats(bounds);
        self.near = [[near; LANES]; LINES];
        self.far = [[far; LANES]; LINES];
    }

    /// A triangle: its borders, and bounds of its depths pixel by pixel, if these are asked for.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, input: &Input<'_>, entry: &Entry, [borders, depths]: [bool; 2]) {
        let sides = input.edges[entry.number as usize];
        let back = sides.contains(Sides::BACK);
        if borders {
            let v = &input.scene.items[entry.number as usize].vertices;
            for k in (0..3).filter(|&k| !sides.shares(k)) {
                self.border(input.setting, &v[k], &v[after(k)], back);
            }
        }
        if depths {
            self.bound(simd, input, entry, back, self.lines_of(entry));
        }
    }

    /// Lines of the tile that an item may be on: first, first beyond.
    #[inline(always)]
    fn lines_of(&self, entry: &Entry) -> [usize; 2] {
        let line = |y: u16| (i32::from(y) - self.place[1]).clamp(0, self.lines as i32) as usize;
        [line(entry.from[1]), line(entry.to[1])]
    }

    /// A border from `a` to `b`; what lies to the right of it is covered once more where it goes up, or, of a triangle
    /// that faces away, once less.
    #[inline(always)]
    fn border(&mut self, setting: &Setting, a: &ScreenVertex, b: &ScreenVertex, back: bool) {
        let (left, above) = (f64::from(1_u32 << setting.pitch[0]) / 2.0, f64::from(1_u32 << setting.pitch[1]) / 2.0);
        let pixel = f64::from(PIXEL);
        // In u, from the tile's corner.
        let (x, y) = (i64::from(self.place[0] * PIXEL), i64::from(self.place[1] * PIXEL));
        let (ax, bx) = (i64::from(a.x) - x, i64::from(b.x) - x);
        let (ay, by) = (i64::from(a.y) - y, i64::from(b.y) - y);
        let width = LANES as i64 * i64::from(PIXEL);
        if ax.max(bx) < 0 || ax.min(bx) > width {
            return;
        }
        let first_centre = i64::from(CENTRE);
        if (ax <= first_centre) != (bx <= first_centre) {
            // It crosses the first column: below it that is covered otherwise than above.
            let (dx, dy) = (bx - ax, by - ay);
            let owner = dy < 0 || (dy == 0 && dx > 0);
            let at = dx * (first_centre - ay) - dy * (first_centre - ax) - i64::from(!owner);
            for (counts, line) in self.counts[..self.lines].iter_mut().zip(0..) {
                let turn = i16::from(at + line * dx * i64::from(PIXEL) >= 0) - i16::from(at >= 0);
                let turn = if back { -turn } else { turn };
                counts.iter_mut().for_each(|count| *count += turn);
            }
        }
        let (low, high) = (ay.min(by), ay.max(by));
        let first = (low >> 8).max(0);
        let beyond = ((high >> 8) + 1).min(self.lines as i64);
        let (x0, y0) = (ax as f64, ay as f64);
        let slope = if ay == by { 0.0 } else { (bx - ax) as f64 / (by - ay) as f64 };
        for line in first..beyond {
            let row = line * i64::from(PIXEL);
            let (from, to) = ((low as f64).max(row as f64 + above), (high as f64).min(row as f64 + pixel - above));
            if from <= to {
                let at = |y: f64| x0 + (y - y0) * slope;
                let (from, to) = if ay == by { (x0, bx as f64) } else { (at(from), at(to)) };
                let (from, to) = (from.min(to) - SPARE, from.max(to) + SPARE);
                // Columns whose samples' rectangle it may meet; casts go towards 0, so none is less than 0.
                let first = ((from + left) / pixel).clamp(0.0, LANES as f64) as u32;
                let last = ((to - left + pixel) / pixel).clamp(0.0, LANES as f64) as u32;
                self.borders[line as usize] |= (((1_u32 << last) - 1) & !((1 << first) - 1)) as u16;
            }
            let centre = row + first_centre;
            if (ay <= centre) != (by <= centre) {
                // Where it crosses the line is right of the first centre.
                let right = (ax - first_centre) * (by - ay) + (centre - ay) * (bx - ax);
                if right.signum() * (by - ay).signum() > 0 {
                    let x = x0 + (centre as f64 - y0) * slope;
                    let column = (((x - first_centre as f64) / pixel).clamp(0.0, LANES as f64) as usize + 1) as u16;
                    let turn = if (by < ay) != back { 1 } else { -1 };
                    for (count, lane) in self.counts[line as usize].iter_mut().zip(0_u16..) {
                        *count += if lane >= column { turn } else { 0 };
                    }
                }
            }
        }
    }

    /// Bounds of the depths of a triangle, in the pixels that it may touch between the samples.
    #[inline(always)]
    fn bound<S: Simd>(&mut self, simd: S, input: &Input<'_>, entry: &Entry, back: bool, lines: [usize; 2]) {
        let item = &input.scene.items[entry.number as usize];
        let slant = Slant::new(input, entry, item);
        let [near, far, along, down] = slant.pixel(input.setting, self.place);
        let [from, to] = slant.limits();
        let [a, b, c] = reaches(input.setting, &item.vertices, back, self.place);
        let lane = f32x16::from_slice(simd, &LANE);
        let (first, second, third) = (lane * a.x + a.start, lane * b.x + b.start, lane * c.x + c.start);
        let (near, far) = (lane * along + near, lane * along + far);
        for line in lines[0]..lines[1] {
            let below = line as f32;
            let touched = (first + below * a.y).min(second + below * b.y).min(third + below * c.y).simd_ge(0.0);
            let near = (near + below * down).max(from).min(to);
            let far = (far + below * down).max(from).min(to);
            let nearest = f32x16::from_slice(simd, &self.near[line]);
            let farthest = f32x16::from_slice(simd, &self.far[line]);
            touched.select(nearest.min(near), nearest).store_slice(&mut self.near[line]);
            touched.select(farthest.max(far), farthest).store_slice(&mut self.far[line]);
        }
    }
}

/// How far inside an edge a pixel's samples reach.
#[derive(Clone, Copy, Debug, Default)]
struct Reach {
    /// Of the tile's first pixel, u^2; not less than 0 if it may have a sample inside.
    start: f32,
    /// Change for one pixel to the right and down.
    x: f32,
    y: f32,
}

/// That of the edges of a triangle, or a little more.
#[inline(always)]
fn reaches(setting: &Setting, v: &[ScreenVertex; 3], back: bool, [x, y]: [i32; 2]) -> [Reach; 3] {
    let (px, py) = (i64::from(x * PIXEL + CENTRE), i64::from(y * PIXEL + CENTRE));
    // Half the rectangle of a pixel's samples.
    let half = [CENTRE - (1 << setting.pitch[0]) / 2, CENTRE - (1 << setting.pitch[1]) / 2];
    let mut reaches = [Reach::default(); 3];
    for k in 0..3 {
        let (a, b) = (&v[k], &v[after(k)]);
        let (dx, dy) = (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y));
        let (dx, dy) = if back { (-dx, -dy) } else { (dx, dy) };
        let at = dx * (py - i64::from(a.y)) - dy * (px - i64::from(a.x));
        let spare = dx.abs() * i64::from(half[1]) + dy.abs() * i64::from(half[0]);
        let (x, y) = ((-dy * i64::from(PIXEL)) as f32, (dx * i64::from(PIXEL)) as f32);
        // More than all that rounding can take away in a tile.
        let rounding = ((at.abs() + spare) as f32 + LANES as f32 * (x.abs() + y.abs())) * ROUNDING;
        reaches[k] = Reach { start: (at + spare) as f32 + rounding, x, y };
    }
    reaches
}

/// What lies nearest in the pixels of a tile, of some sheets.
#[derive(Debug)]
pub(super) struct Nearest {
    /// The least near bound, and the least of the other sheets.
    near: Pixels,
    second: Pixels,
    /// The far bound of the sheet with the least.
    far: Pixels,
    /// The pixels that it covers once, and no border of it passes through.
    once: [u16; LINES],
}

impl Default for Nearest {
    fn default() -> Self {
        let nothing = [[f32::INFINITY; LANES]; LINES];
        Nearest { near: nothing, second: nothing, far: nothing, once: [0; LINES] }
    }
}

impl Nearest {
    /// Nothing.
    pub(super) fn begin(&mut self) {
        *self = Nearest::default();
    }

    /// A sheet.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, sheet: &Sheet) {
        let infinity = f32x16::splat(simd, f32::INFINITY);
        for line in 0..sheet.lines {
            let free = !sheet.borders[line];
            let counts = i16x16::from_slice(simd, &sheet.counts[line]);
            let never = counts.simd_eq(0).to_bitmask() as u16 & free;
            let once = counts.simd_eq(1).to_bitmask() as u16 & free;
            let never = mask32x16::from_bitmask(simd, u64::from(never));
            let near = f32x16::from_slice(simd, &sheet.near[line]);
            let far = f32x16::from_slice(simd, &sheet.far[line]);
            let near = never.select(infinity, near);
            let nearest = f32x16::from_slice(simd, &self.near[line]);
            let nearer = near.simd_lt(nearest);
            let second = f32x16::from_slice(simd, &self.second[line]);
            nearest.max(near).min(second).store_slice(&mut self.second[line]);
            nearest.min(near).store_slice(&mut self.near[line]);
            nearer.select(far, f32x16::from_slice(simd, &self.far[line])).store_slice(&mut self.far[line]);
            let bits = nearer.to_bitmask() as u16;
            self.once[line] = (self.once[line] & !bits) | (once & bits);
        }
    }

    /// The pixels of a line that are neither certainly inside the sheet that is nearest there, nor certainly empty.
    #[inline(always)]
    pub(super) fn uncertain<S: Simd>(&self, simd: S, line: usize) -> u16 {
        let near = f32x16::from_slice(simd, &self.near[line]);
        let second = f32x16::from_slice(simd, &self.second[line]);
        let far = f32x16::from_slice(simd, &self.far[line]);
        let inside = far.simd_lt(second).to_bitmask() as u16 & self.once[line];
        near.simd_lt(f32::INFINITY).to_bitmask() as u16 & !inside
    }
}
