//! What pieces cover on the lines of a band: edges walked over rows of samples, 16 at a time.

use super::band::{Input, Work, bits_of};
use super::piece::Cover;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::kernel::{LANE, LANES, Steps};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x16, u32x16};

/// Columns of samples where an empty row begins; beyond every target.
const EMPTY: i32 = 1 << 24;

/// A run of pixels on one line that a piece covers wholly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) piece: u32,
    /// Line of the band.
    pub(super) line: u16,
    /// First column, first beyond.
    pub(super) columns: [u16; 2],
}

/// What a triangle covers on one line: pixels in part on both sides of a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) piece: u32,
    /// Line of the band.
    pub(super) line: u16,
    /// First column, first of the span, first beyond the span, first beyond.
    pub(super) columns: [u16; 4],
    /// First column whose centre is covered, first beyond.
    pub(super) centres: [u16; 2],
}

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

impl Work {
    /// What all pieces cover on their lines.
    #[inline(always)]
    pub(super) fn cover<S: Simd, const C: usize, const R: usize>(&mut self, simd: S, input: &Input<'_>) {
        for number in 0..self.pieces.len() {
            let (cover, area) = self.covers[number];
            let [[left, first], [right, beyond]] = area;
            if left >= right || first >= beyond {
                continue;
            }
            match cover {
                Cover::Nothing => {}
                Cover::Samples(outlines) => {
                    self.samples::<S, C, R>(simd, input, number, &outlines, area);
                }
                Cover::Centres(triangle) => {
                    for y in first.max(triangle.rows[0])..beyond.min(triangle.rows[2]) {
                        let [from, to] = triangle.span(y);
                        self.span(input, number, y, [from.max(left), to.min(right)]);
                    }
                }
                Cover::Line(line) => {
                    for y in first..beyond {
                        if line.axis == Axis::Y && !(line.steps[0]..line.steps[1]).contains(&y) {
                            continue;
                        }
                        let [from, to] = line.columns_on_row(y, [left, right]);
                        self.span(input, number, y, [from.max(left), to.min(right)]);
                    }
                }
                Cover::Pixel([x, y]) if (left..right).contains(&x) && (first..beyond).contains(&y) => {
                    self.span(input, number, y, [x, x + 1]);
                }
                Cover::Pixel(_) => {}
                Cover::All => (first..beyond).for_each(|y| self.span(input, number, y, [left, right])),
            }
        }
    }

    /// A triangle on rows of samples.
    #[inline(always)]
    fn samples<S: Simd, const C: usize, const R: usize>(
        &mut self,
        simd: S,
        input: &Input<'_>,
        number: usize,
        [t, centres]: &[Triangle; 2],
        [[left, first], [right, beyond]]: [[i32; 2]; 2],
    ) {
        let (columns, rows) = (C as i32, R as i32);
        let walks = Walks::new(simd, t);
        let centres = Walks::new(simd, centres).spans(simd, centres, first, [left, right]);
        let mut y = first;
        while y < beyond {
            let [froms, tos] = walks.spans(simd, t, y * rows, [left * columns, right * columns]);
            for (froms, tos) in froms.as_chunks::<R>().0.iter().zip(tos.as_chunks::<R>().0) {
                if y < beyond {
                    let place = (y - first) as usize % LANES;
                    let centre = [centres[0][place], centres[1][place]];
                    self.row::<C, R>(input, number, y, froms, tos, centre);
                }
                y += 1;
            }
        }
    }

    /// A triangle on the rows of samples of one row of pixels; of those whose centres it covers, `centre`, it may cover
    /// no sample.
    #[inline(always)]
    fn row<const C: usize, const R: usize>(
        &mut self,
        input: &Input<'_>,
        number: usize,
        y: i32,
        froms: &[i32; R],
        tos: &[i32; R],
        centre: [i32; 2],
    ) {
        let columns = C as i32;
        let shift = C.ilog2();
        // The left border is convex and the right one concave: what all rows cover, the first and the last do.
        let [inner_from, inner_to] = [froms[0].max(froms[R - 1]), tos[0].min(tos[R - 1])];
        let (mut least, mut greatest) = (froms[0], tos[0]);
        for k in 1..R {
            (least, greatest) = (least.min(froms[k]), greatest.max(tos[k]));
        }
        let (mut first, mut beyond) = (least >> shift, (greatest + columns - 1) >> shift);
        if first >= beyond {
            (first, beyond) = (centre[0], centre[1]);
            if first >= beyond {
                return;
            }
        }
        let mut whole = [(inner_from + columns - 1) >> shift, inner_to >> shift];
        if whole[0] < whole[1] {
            self.span(input, number, y, whole);
        } else {
            whole = [beyond; 2];
        }
        if centre[0] < centre[1] {
            (first, beyond) = (first.min(centre[0]), beyond.max(centre[1]));
            if whole[0] == whole[1] {
                whole = [beyond; 2];
            }
        }
        let line = (y - input.top) as usize;
        self.rows.push(Row {
            piece: number as u32,
            line: line as u16,
            columns: [first, whole[0], whole[1], beyond].map(|x| x as u16),
            centres: if centre[0] < centre[1] { centre.map(|x| x as u16) } else { [0, 0] },
        });
        self.edges.extend_from_slice(froms);
        self.edges.extend_from_slice(tos);
        let words = &mut self.part[line * input.chunk_words()..][..input.chunk_words()];
        mark(words, first, whole[0]);
        mark(words, whole[1], beyond);
    }

    /// Pixels that a piece covers wholly.
    #[inline(always)]
    fn span(&mut self, input: &Input<'_>, number: usize, y: i32, [from, to]: [i32; 2]) {
        if from >= to {
            return;
        }
        let line = (y - input.top) as usize;
        self.spans.push(Span { piece: number as u32, line: line as u16, columns: [from as u16, to as u16] });
        let piece = &self.pieces[number];
        // Layers are looked for everywhere; a second span in a chunk may be hidden or hide the first.
        let always = piece.layer || input.undecided(piece);
        let words = line * input.chunk_words();
        let chunks = [from as usize / LANES, (to as usize - 1) / LANES];
        for word in chunks[0] / 64..chunks[1] / 64 + 1 {
            let bits = bits_of(word, chunks[0], chunks[1] + 1);
            let place = words + word;
            self.need[place] |= bits & (self.once[place] | if always { u64::MAX } else { 0 });
            self.once[place] |= bits;
        }
    }
}

/// Marks the chunks of some columns.
#[inline(always)]
fn mark(words: &mut [u64], from: i32, to: i32) {
    if from < to {
        let chunks = [from as usize / LANES, (to as usize - 1) / LANES];
        for (word, bits) in words.iter_mut().enumerate().take(chunks[1] / 64 + 1).skip(chunks[0] / 64) {
            *bits |= bits_of(word, chunks[0], chunks[1] + 1);
        }
    }
}
