//! What a piece covers on the lines of a band: row by row of pixels.
//!
//! A triangle that is drawn with masks is walked on rows of samples as on rows of pixels. On each row of pixels it
//! covers, from left to right, some pixels in part, then some wholly (a *span*), then some in part.
//!
//! Inputs from: [`super::piece`], [`super::walk`]. Outputs to: [`super::rows`]. Clocks: those of masks are counted when it
//! is known what is left ([`super::band`]).

use super::band::{Input, LINES, Work};
use super::piece::{Cover, Piece};
use super::rows::{Bounds, Row, Rows};
use super::scene::Rule;
use super::walk::{Ends, REACH, Slot, Walks};
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
        let mut rows = Rows {
            rows: [Row::default(); LINES],
            line: (first - input.top) as usize,
            count: (beyond - first) as usize,
            taken: [0; 2],
            hides: !piece.layer && input.setting.rule != Rule::InOrder,
        };
        let drawn = piece.drawn;
        self.pieces.push(piece);
        if let Cover::Samples(Some(outline)) = &cover {
            return self.samples::<S, C, R>(simd, input, &bounds, &mut rows, outline, drawn.then_some(centres), area);
        }
        for (row, y) in rows.rows[..rows.count].iter_mut().zip(first..) {
            let [from, to] = match &cover {
                Cover::Samples(_) if drawn => centres.on(y, [left, right]),
                Cover::Centres(triangle) => on_row_of(triangle, y),
                Cover::Line(line) => on_row(line, y, [left, right]),
                Cover::Pixel([x, line]) if *line == y => [*x, x + 1],
                Cover::All => [left, right],
                Cover::Nothing | Cover::Samples(_) | Cover::Pixel(_) => [0; 2],
            };
            row.met = [from.max(left), to.min(right)];
            match cover {
                Cover::Samples(_) => row.centre = row.met,
                _ => row.whole = row.met,
            }
        }
        Ends::empty(simd).slots::<C>(simd, 0, &mut self.runs.slots);
        self.rows::<S, C, R>(simd, input, &bounds, &mut rows, |_, _, _, _| [0; 2]);
    }

    /// A triangle on rows of samples.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "what its one caller has set up")]
    fn samples<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        bounds: &Bounds<S>,
        rows: &mut Rows,
        t: &Triangle,
        centres: Option<Centres<'_>>,
        [[left, first], [right, beyond]]: [[i32; 2]; 2],
    ) {
        let (columns, height) = (C as i32, R as i32);
        let shift = C.ilog2();
        let limits = [left * columns, right * columns];
        let walks = Walks::new(simd, t);
        // Its inside, where that covers the band from top to bottom.
        if right - left >= WIDE && beyond - first == input.lines as i32 && input.setting.rule != Rule::InOrder {
            let row = |row: i32| walks.ends(simd, t, row, limits).first();
            let (upper, lower) = (row(first * height), row(beyond * height - 1));
            let (from, to) = (upper[0].max(lower[0]), upper[1].min(lower[1]));
            rows.taken = self.take_chunks(input, [(from + columns - 1) >> shift, to >> shift]);
        }
        // Rows of pixels that are walked together.
        let step = LANES / R;
        // The pixel that their slots count columns from: the first that is met.
        let mut bases = [0; LINES];
        let mut missed = 0_u32;
        for place in (0..rows.count).step_by(step) {
            let row = (first + place as i32) * height;
            let ends = walks.ends(simd, t, row, limits);
            let pixels = ends.pixels::<C, R>();
            for (k, row) in rows.rows[place..place + step].iter_mut().enumerate() {
                (row.met, row.whole) = (pixels.met::<C, R>(k), pixels.whole::<R>(k));
            }
            let misses = ends.misses(t, row);
            for k in 0..step {
                missed |= (misses >> (k * R + R / 2) & 1) << (place + k);
            }
            let base = rows.rows[place..place + step].iter().fold(right, |base, row| base.min(row.met[0]));
            bases[place / step] = base;
            ends.slots::<C>(simd, base, &mut self.runs.slots);
        }
        if let Some(mut centres) = centres {
            missed &= (1 << rows.count) - 1;
            while missed != 0 {
                let place = missed.trailing_zeros() as usize;
                missed &= missed - 1;
                let centre = centres.on(first + place as i32, [left, right]);
                if centre[0] < centre[1] {
                    let Row { met, .. } = rows.rows[place];
                    rows.rows[place].met = [met[0].min(centre[0]), met[1].max(centre[1])];
                    rows.rows[place].centre = centre;
                }
            }
        }
        let mut made = [(usize::MAX, 0, 0); 2];
        self.rows::<S, C, R>(simd, input, bounds, rows, |slots, place, x, [from, last]| {
            let (batch, number) = (place / step, place / Slot::rows(C, R));
            let base = bases[batch];
            // A centre may lie before what samples meet.
            if from >= base && last - base < REACH {
                return [number as u32, (x.wrapping_sub(base) * columns) as u32];
            }
            // Both sides of some rows need one.
            if (made[0].0, made[0].1) != (batch, x) {
                made.swap(0, 1);
                if (made[0].0, made[0].1) != (batch, x) {
                    made[0] = (batch, x, slots.len());
                    let ends = walks.ends(simd, t, (first + (batch * step) as i32) * height, limits);
                    ends.slots::<C>(simd, x, slots);
                }
            }
            [(made[0].2 + number % (C / 4)) as u32, 0]
        });
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
