//! A host tile, pixel by pixel: where the order of its layers is not one for all of its pixels, or a clear took some of
//! them back in a part of it.
//!
//! Row by row: the spans that the tile's layers have on the row are found once; each pixel then collects the layers whose
//! span it lies in, sorts those that pass, and has them blended. No more is kept than the layers of one pixel.
//!
//! Duties: depth tests, order, blending. Inputs from: [`super::piece`], opaque depths. Outputs to: [`super::canvas`],
//! counts. Clocks: those of [`super`].

use super::Counts;
use super::canvas::Canvas;
use super::piece::{Colours, Part};
use super::tile::{Place, blend_at};
use crate::geometry::plane::below;
use crate::hidden::stencil::StencilCounts;

/// A layer, or a clear, on a row.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: i32,
    to: i32,
    /// Its place among the parts.
    part: u32,
}

/// A layer at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fragment {
    /// Depth; of a layer that is not tested nearer than all.
    pub depth: i32,
    /// Its place in the order of submission.
    pub number: u32,
}

/// Memory of a thread.
#[derive(Debug, Default)]
pub struct Pixels {
    spans: Vec<Span>,
    fragments: Vec<Fragment>,
    colours: Vec<Option<Colours>>,
}

/// Puts the layers of a pixel, which are in order of submission, in the order in which they are composed, and counts what
/// that takes.
pub fn sort(fragments: &mut [Fragment], counts: &mut Counts) {
    let layers = fragments.len() as u64;
    if layers == 0 {
        return;
    }
    counts.pixels += 1;
    counts.blended += layers;
    if fragments.is_sorted_by(|a, b| a.depth >= b.depth) {
        counts.comparisons += layers - 1;
        return;
    }
    counts.sorted_pixels += 1;
    counts.comparisons += layers * (layers - 1) / 2;
    fragments.sort_unstable_by_key(|fragment| (std::cmp::Reverse(fragment.depth), fragment.number));
}

impl Pixels {
    /// Composes the layers of a tile; the canvas holds its pixels.
    pub fn compose(&mut self, parts: &[Part], place: &Place<'_>, canvas: &mut Canvas, counts: &mut Counts) {
        self.colours.clear();
        self.colours.resize(parts.len(), None);
        let below = below(place.format);
        for y in place.area[1][0]..place.area[1][1] {
            self.spans.clear();
            for (part, number) in parts.iter().zip(0..) {
                let area = part.area();
                if !(area[1][0]..area[1][1]).contains(&y) {
                    continue;
                }
                let [from, to] = match part {
                    Part::Layer(piece) | Part::Cover(piece) => piece.span(y),
                    Part::Clear(area) => area[0],
                };
                if from < to {
                    self.spans.push(Span { from, to, part: number });
                }
            }
            let from = self.spans.iter().map(|span| span.from).min().unwrap_or(0);
            let to = self.spans.iter().map(|span| span.to).max().unwrap_or(0);
            for x in from..to {
                self.pixel(parts, [x, y], below, place, canvas, counts);
            }
        }
    }

    fn pixel(
        &mut self,
        parts: &[Part],
        [x, y]: [i32; 2],
        below: u32,
        place: &Place<'_>,
        canvas: &mut Canvas,
        counts: &mut Counts,
    ) {
        let stored = place.depth_at(x, y);
        let value = place.stencil_at(x, y);
        self.fragments.clear();
        let (mut came, mut tests) = (0, StencilCounts::default());
        for span in self.spans.iter().filter(|span| (span.from..span.to).contains(&x)) {
            let piece = match &parts[span.part as usize] {
                Part::Layer(piece) => piece,
                part => {
                    let hole = matches!(part, Part::Cover(piece) if piece.is_hole(place.draws, x, y));
                    if !hole {
                        self.fragments.clear();
                        (came, tests) = (0, StencilCounts::default());
                    }
                    continue;
                }
            };
            came += 1;
            if let Some(test) = piece.stencil(place.draws) {
                let failed = u64::from(!test.passes(value));
                tests = tests.plus(StencilCounts { tested: 1, failed });
                if failed == 1 {
                    continue;
                }
            }
            let depth = piece.depth(x, y, below);
            if piece.test.is_none_or(|test| test.passes(depth, stored)) {
                self.fragments.push(Fragment { depth, number: span.part });
            }
        }
        counts.fragments += came;
        counts.stencil = counts.stencil.plus(tests);
        sort(&mut self.fragments, counts);
        for fragment in &self.fragments {
            let part = fragment.number as usize;
            if let Part::Layer(piece) = &parts[part] {
                let colours = self.colours[part].get_or_insert_with(|| piece.colours(place.draws));
                piece.count_shaded(place.draws, 1, counts);
                blend_at(piece, colours, [x, y], place, canvas);
            }
        }
    }
}
