//! What a piece covers on the lines of a band: edges walked over rows of samples, 16 at a time.
//!
//! A triangle that is drawn with masks is walked on rows of samples as on rows of pixels. On each row of pixels it
//! covers, from left to right, some pixels in part, then some wholly (a *span*), then some in part. Those in part
//! become fragments at once, unless they are hidden already.
//!
//! Inputs from: [`super::piece`]. Outputs to: [`super::lists`], [`super::hide`]. Clocks: those of masks are counted when
//! it is known what is left ([`super::band`]).

use super::band::{Input, Work};
use super::hide::Span;
use super::lists::Fragment;
use super::piece::{Cover, Piece};
use super::scene::Rule;
use crate::geometry::line::Line;
use crate::geometry::plane::{Axis, below};
use crate::geometry::triangle::Triangle;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u8x64, u32x16};

/// Pixels of a row from which on it is worth asking whether a triangle covers chunks on all lines of a band.
const WIDE: i32 = 3 * LANES as i32;

/// Columns of samples where an empty row begins; beyond every target.
const EMPTY: i32 = 1 << 24;

/// The edges of a triangle, walked on [`LANES`] rows at a time.
struct Walks<S: Simd> {
    long: Steps<S>,
    upper: Steps<S>,
    lower: Steps<S>,
}

impl<S: Simd> Walks<S> {
    #[inline(always)]
    fn new(simd: S, t: &Triangle) -> Self {
        Walks {
            long: Steps::new(simd, t.long.step),
            upper: Steps::new(simd, t.short[0].step),
            lower: Steps::new(simd, t.short[1].step),
        }
    }

    /// First columns and first beyond on rows from `row` on, inside `columns`; of rows that are not covered
    /// [`EMPTY`] and its negative.
    #[inline(always)]
    fn spans(&self, simd: S, t: &Triangle, row: i32, columns: [i32; 2]) -> [[i32; LANES]; 2] {
        let lane: i32x16<S> = u32x16::from_slice(simd, &LANE).bitcast();
        let long = self.long.columns(simd, t.long.walk(row - t.rows[0]), 0);
        let upper = self.upper.columns(simd, t.short[0].walk(row - t.rows[0]), 0);
        let lower = self.lower.columns(simd, t.short[1].walk(row - t.rows[1]), 0);
        let short = lane.simd_lt(t.rows[1] - row).select(upper, lower);
        let (from, to) = (long.min(short).max(columns[0]), long.max(short).min(columns[1]));
        let covered = from.simd_lt(to) & lane.simd_ge(t.rows[0] - row) & lane.simd_lt(t.rows[2] - row);
        let mut spans = [[0; LANES]; 2];
        covered.select(from, i32x16::splat(simd, EMPTY)).store_slice(&mut spans[0]);
        covered.select(to, i32x16::splat(simd, -EMPTY)).store_slice(&mut spans[1]);
        spans
    }
}

/// The pixels whose centres a triangle covers, where that must be known.
struct Centres<'a> {
    vertices: &'a [ScreenVertex; 3],
    /// First row that may be asked for.
    top: i32,
    /// Set up when they are first asked for.
    outline: Option<Option<Triangle>>,
}

impl Centres<'_> {
    /// Columns on row `y`, from the first to the first beyond, inside `columns`.
    fn on(&mut self, y: i32, [left, right]: [i32; 2]) -> [i32; 2] {
        let grid = ([PIXEL.ilog2(); 2], self.top);
        match self.outline.get_or_insert_with(|| Triangle::outlines(self.vertices, [grid])[0]) {
            Some(t) if (t.rows[0]..t.rows[2]).contains(&y) => {
                let [from, to] = t.span(y);
                [from.max(left), to.min(right)]
            }
            _ => [0; 2],
        }
    }
}

/// Whether a triangle may cover a pixel's centre on row `y` of pixels and none of the pixel's samples.
///
/// The centres lie half-way between two rows of samples. Where no vertex lies between these, both sides of the triangle
/// are straight there, and what it covers on the centres' row is the mean of what it covers on the two. A centre whose
/// four samples are not covered then has a row that is too narrow to meet one, or one row ends before it and the other
/// begins behind it.
#[inline(always)]
fn may_miss<const R: usize>(t: &Triangle, y: i32, froms: &[i32; R], tos: &[i32; R]) -> bool {
    let (above, below) = (R / 2 - 1, R / 2);
    let row = y * R as i32 + below as i32;
    let narrow = |k: usize| tos[k] - froms[k] < 2;
    let apart = tos[above] <= froms[below] || tos[below] <= froms[above];
    let meets = t.rows[0] < row && row < t.rows[2];
    t.rows.contains(&row) || (meets && (narrow(above) || narrow(below) || apart))
}

impl Work {
    /// Everything that a piece covers inside `area`: fragments of the pixels that it covers in part, spans of those that
    /// it covers wholly.
    #[inline(always)]
    pub(super) fn cover<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        (piece, cover): (Piece, Cover),
        area: [[i32; 2]; 2],
    ) {
        let [[left, first], [right, beyond]] = area;
        let steps = Steps::new(simd, piece.row_step());
        self.pieces.push(piece);
        let vertices = &input.scene.items[self.pieces[self.pieces.len() - 1].item as usize].vertices;
        match cover {
            Cover::Nothing => {}
            Cover::Samples(Some(outline)) => {
                self.samples::<S, C, R>(simd, input, &steps, &outline, vertices, area);
            }
            Cover::Samples(None) if self.pieces.last().is_some_and(|piece| !piece.drawn) => {}
            Cover::Samples(None) => {
                let mut centres = Centres { vertices, top: input.top, outline: None };
                for y in first..beyond {
                    let centre = centres.on(y, [left, right]);
                    self.partly::<S, C, R>(simd, input, y, (&[EMPTY; R], &[-EMPTY; R]), centre, [centre, [0; 2]]);
                }
            }
            Cover::Centres(triangle) => {
                for y in first.max(triangle.rows[0])..beyond.min(triangle.rows[2]) {
                    let [from, to] = triangle.span(y);
                    self.span(simd, input, &steps, y, [from.max(left), to.min(right)]);
                }
            }
            Cover::Line(line) => {
                for y in first..beyond {
                    let [from, to] = on_row(&line, y, [left, right]);
                    self.span(simd, input, &steps, y, [from.max(left), to.min(right)]);
                }
            }
            Cover::Pixel([x, y]) if (left..right).contains(&x) && (first..beyond).contains(&y) => {
                self.span(simd, input, &steps, y, [x, x + 1]);
            }
            Cover::Pixel(_) => {}
            Cover::All => (first..beyond).for_each(|y| self.span(simd, input, &steps, y, [left, right])),
        }
    }

    /// A triangle on rows of samples.
    #[inline(always)]
    fn samples<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        steps: &Steps<S>,
        t: &Triangle,
        vertices: &[ScreenVertex; 3],
        [[left, first], [right, beyond]]: [[i32; 2]; 2],
    ) {
        let (columns, rows) = (C as i32, R as i32);
        let shift = C.ilog2();
        let walks = Walks::new(simd, t);
        let drawn = self.pieces.last().is_some_and(|piece| piece.drawn);
        let mut centres = Centres { vertices, top: input.top, outline: None };
        // Its inside, where that covers the band from top to bottom.
        let mut taken = [0; 2];
        if right - left >= WIDE && beyond - first == input.lines as i32 && input.setting.rule != Rule::InOrder {
            let row = |row: i32| walks.spans(simd, t, row, [left * columns, right * columns]).map(|ends| ends[0]);
            let (upper, lower) = (row(first * rows), row(beyond * rows - 1));
            let (from, to) = (upper[0].max(lower[0]), upper[1].min(lower[1]));
            taken = self.take_chunks(input, [(from + columns - 1) >> shift, to >> shift]);
        }
        let [taken_from, taken_to] = taken.map(|chunk| (chunk * LANES) as i32);
        let mut y = first;
        while y < beyond {
            let [froms, tos] = walks.spans(simd, t, y * rows, [left * columns, right * columns]);
            for (froms, tos) in froms.as_chunks::<R>().0.iter().zip(tos.as_chunks::<R>().0) {
                if y >= beyond {
                    break;
                }
                let (mut least, mut greatest) = (froms[0], tos[0]);
                for k in 1..R {
                    (least, greatest) = (least.min(froms[k]), greatest.max(tos[k]));
                }
                let mut met = [least >> shift, (greatest + columns - 1) >> shift];
                // The left border is convex and the right one concave: what all rows cover, the first and the last do.
                let [inner_from, inner_to] = [froms[0].max(froms[R - 1]), tos[0].min(tos[R - 1])];
                let whole = [(inner_from + columns - 1) >> shift, inner_to >> shift];
                let mut centre = [0; 2];
                if drawn && may_miss(t, y, froms, tos) {
                    centre = centres.on(y, [left, right]);
                    if centre[0] < centre[1] {
                        met = [met[0].min(centre[0]), met[1].max(centre[1])];
                    }
                }
                let mut parts = [met, [0; 2]];
                if whole[0] < whole[1] {
                    if taken_from < taken_to {
                        self.span(simd, input, steps, y, [whole[0], taken_from]);
                        self.span(simd, input, steps, y, [taken_to, whole[1]]);
                    } else {
                        self.span(simd, input, steps, y, whole);
                    }
                    parts = [[met[0], whole[0]], [whole[1], met[1]]];
                }
                self.partly::<S, C, R>(simd, input, y, (froms, tos), centre, parts);
                y += 1;
            }
        }
    }

    /// Fragments of the last piece in the pixels `parts` of row `y`, none of which it covers wholly, unless they are
    /// hidden: where it covers samples, or the centre, that of columns `centre`.
    #[inline(always)]
    fn partly<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        y: i32,
        (froms, tos): (&[i32; R], &[i32; R]),
        centre: [i32; 2],
        parts: [[i32; 2]; 2],
    ) {
        let line = (y - input.top) as usize;
        let number = self.pieces.len() - 1;
        let below = below(input.setting.format);
        let (start, words) = (line * input.pitch(), line * input.words());
        let full = input.setting.grid.full();
        for [from, to] in parts {
            if from >= to {
                continue;
            }
            let (first, beyond) = (from as usize, to as usize);
            if !self.lists.has_room(beyond - first) {
                return;
            }
            for chunk in first / LANES..(beyond - 1) / LANES + 1 {
                self.open(simd, input, line, chunk);
            }
            let piece = &self.pieces[number];
            let (minimum, maximum) = (i64::from(piece.plane.minimum), i64::from(piece.plane.maximum));
            let stored = |value: i64| (value >> below).max(minimum).min(maximum) as i32;
            let [value, value_far] = piece.row_values(from, y);
            let (deep, step) = (value_far.wrapping_sub(value), piece.row_step());
            let hides = !piece.layer && input.setting.rule != Rule::InOrder;
            let mut value = value.wrapping_sub(step);
            for base in (first..beyond).step_by(REACH) {
                let rows = Rows::new::<C, R>(simd, froms, tos, (base * C) as i32);
                for x in base..beyond.min(base + REACH) {
                    value = value.wrapping_add(step);
                    let (near, limit) = (stored(value), &mut self.far[start + x]);
                    if near > *limit {
                        continue;
                    }
                    let mask = rows.mask((x - base) * C);
                    if mask == 0 && !(centre[0]..centre[1]).contains(&(x as i32)) {
                        continue;
                    }
                    let fragment = Fragment::new(mask, number as u32, [near, stored(value.wrapping_add(deep))]);
                    if hides {
                        self.lists.put_opaque(start + x, fragment, full, limit);
                    } else {
                        self.lists.put(start + x, fragment);
                    }
                    self.active[words + x / 64] |= 1 << (x % 64);
                }
            }
        }
    }

    /// Pixels that the last piece covers wholly.
    #[inline(always)]
    fn span<S: Simd>(&mut self, simd: S, input: &Input<'_>, steps: &Steps<S>, y: i32, [from, to]: [i32; 2]) {
        if from < to {
            let line = (y - input.top) as u16;
            let span = Span { piece: self.pieces.len() as u32 - 1, line, columns: [from as u16, to as u16] };
            if input.setting.rule == Rule::InOrder || self.hide(simd, input, steps, &span) {
                self.spans.push(span);
            }
        }
    }
}

/// Columns of a line on row `y`; from more to less if there are none.
fn on_row(line: &Line, y: i32, columns: [i32; 2]) -> [i32; 2] {
    if line.axis == Axis::Y && !(line.steps[0]..line.steps[1]).contains(&y) {
        return [0; 2];
    }
    line.columns_on_row(y, columns)
}

/// Pixels that [`Rows`] reach: their columns of samples count to less than 255.
const REACH: usize = 31;

/// Columns of samples that rows of samples begin and end with, a lane for each sample of a pixel: lane k is bit k of a
/// mask.
struct Rows<S: Simd> {
    froms: u8x64<S>,
    tos: u8x64<S>,
    /// Columns of the samples of the first pixel.
    columns: u8x64<S>,
}

impl<S: Simd> Rows<S> {
    /// Of [`REACH`] pixels, the first of which begins with column `x`. Lanes that are no samples cover nothing.
    #[inline(always)]
    fn new<const C: usize, const R: usize>(simd: S, froms: &[i32; R], tos: &[i32; R], x: i32) -> Self {
        let lanes = |columns: &[i32; R], rest: u64| {
            let mut words = [rest; 8];
            for (row, column) in columns.iter().rev().enumerate() {
                let column = (column - x).clamp(0, 255) as u64;
                if C == 8 {
                    words[row] = column * 0x0101_0101_0101_0101;
                } else {
                    let shift = 32 * (row % 2);
                    words[row / 2] = (words[row / 2] & !(0xFFFF_FFFF << shift)) | ((column * 0x0101_0101) << shift);
                }
            }
            u8x64::from_slice(simd, bytemuck::cast_slice(&words.map(u64::to_le)))
        };
        let columns: [u8; 64] = std::array::from_fn(|lane| (C - 1 - lane % C) as u8);
        Rows { froms: lanes(froms, u64::MAX), tos: lanes(tos, 0), columns: u8x64::from_slice(simd, &columns) }
    }

    /// Samples of the pixel whose columns begin so many after the first one's.
    #[inline(always)]
    fn mask(&self, column: usize) -> u64 {
        let columns = self.columns + column as u8;
        (self.froms.simd_le(columns) & self.tos.simd_gt(columns)).to_bitmask()
    }
}
