//! What a piece covers on the lines of a band: row by row of pixels.
//!
//! A triangle that is drawn with masks is walked on rows of samples as on rows of pixels. On each row of pixels it
//! covers, from left to right, some pixels in part, then some wholly (a *span*), then some in part.
//!
//! Inputs from: [`super::piece`], [`super::walk`]. Outputs to: [`super::row`]. Clocks: those of masks are counted when it
//! is known what is left ([`super::band`]).

use super::band::{Input, Work};
use super::piece::{Cover, Piece};
use super::row::{Bounds, Row};
use super::scene::Rule;
use super::walk::{Ends, Masks, Walks};
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::Triangle;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::Simd;

/// Pixels of a row from which on it is worth asking whether a triangle covers chunks on all lines of a band.
const WIDE: i32 = 3 * LANES as i32;

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
        let bounds = Bounds::new(simd, input, &piece);
        let vertices = &input.scene.items[piece.item as usize].vertices;
        let mut centres = Centres { vertices, top: input.top, outline: None };
        let (drawn, hides) = (piece.drawn, !piece.layer && input.setting.rule != Rule::InOrder);
        self.pieces.push(piece);
        if let Cover::Samples(Some(outline)) = &cover {
            return self.samples::<S, C, R>(simd, input, &bounds, outline, (centres, hides), area);
        }
        let mut masks = Masks::new(Ends::empty(simd), 0);
        for y in first..beyond {
            let mut row = Row { y, number: 0, met: [left, right], whole: [0; 2], centre: [0; 2], taken: [0; 2] };
            row.met = match &cover {
                Cover::Samples(_) if drawn => centres.on(y, row.met),
                Cover::Centres(triangle) => on_row_of(triangle, y),
                Cover::Line(line) => on_row(line, y, row.met),
                Cover::Pixel([x, line]) if *line == y => [*x, x + 1],
                Cover::All => row.met,
                Cover::Nothing | Cover::Samples(_) | Cover::Pixel(_) => [0; 2],
            };
            row.met = [row.met[0].max(left), row.met[1].min(right)];
            match cover {
                Cover::Samples(_) => row.centre = row.met,
                _ => row.whole = row.met,
            }
            self.row::<S, C, R>(simd, input, &bounds, &mut masks, row);
        }
        self.make_masks::<S, C, R>(simd, input, hides);
    }

    /// A triangle on rows of samples.
    #[inline(always)]
    fn samples<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        bounds: &Bounds<S>,
        t: &Triangle,
        (mut centres, hides): (Centres<'_>, bool),
        [[left, first], [right, beyond]]: [[i32; 2]; 2],
    ) {
        let (columns, rows) = (C as i32, R as i32);
        let shift = C.ilog2();
        let limits = [left * columns, right * columns];
        let walks = Walks::new(simd, t);
        let drawn = self.pieces.last().is_some_and(|piece| piece.drawn);
        // Its inside, where that covers the band from top to bottom.
        let mut taken = [0; 2];
        if right - left >= WIDE && beyond - first == input.lines as i32 && input.setting.rule != Rule::InOrder {
            let row = |row: i32| walks.ends(simd, t, row, limits).first();
            let (upper, lower) = (row(first * rows), row(beyond * rows - 1));
            let (from, to) = (upper[0].max(lower[0]), upper[1].min(lower[1]));
            taken = self.take_chunks(input, [(from + columns - 1) >> shift, to >> shift]);
        }
        let step = LANES / R;
        for y in (first..beyond).step_by(step) {
            let ends = walks.ends(simd, t, y * rows, limits);
            let pixels = ends.pixels::<C, R>();
            let misses = if drawn { ends.misses(t, y * rows) } else { 0 };
            let mut masks = Masks::new(ends, pixels.least::<C, R>());
            for number in 0..step.min((beyond - y) as usize) {
                let y = y + number as i32;
                let (mut met, whole) = (pixels.met::<C, R>(number), pixels.whole::<R>(number));
                let mut centre = [0; 2];
                if misses >> (number * R + R / 2) & 1 != 0 {
                    centre = centres.on(y, [left, right]);
                    if centre[0] < centre[1] {
                        met = [met[0].min(centre[0]), met[1].max(centre[1])];
                    }
                }
                let row = Row { y, number, met, whole, centre, taken };
                self.row::<S, C, R>(simd, input, bounds, &mut masks, row);
            }
            if self.runs.are_many() || y + step as i32 >= beyond {
                self.make_masks::<S, C, R>(simd, input, hides);
            }
        }
    }
}

/// Columns of a triangle on row `y`.
fn on_row_of(triangle: &Triangle, y: i32) -> [i32; 2] {
    if (triangle.rows[0]..triangle.rows[2]).contains(&y) { triangle.span(y) } else { [0; 2] }
}

/// Columns of a line on row `y`; from more to less if there are none.
fn on_row(line: &Line, y: i32, columns: [i32; 2]) -> [i32; 2] {
    if line.axis == Axis::Y && !(line.steps[0]..line.steps[1]).contains(&y) {
        return [0; 2];
    }
    line.columns_on_row(y, columns)
}
