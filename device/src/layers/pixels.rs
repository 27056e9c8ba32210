//! A block of a host tile, pixel by pixel: where the order of its layers is not one for all of its pixels, or a clear took
//! some of them back in a part of it.
//!
//! Row by row: the spans that its layers have on the row are found once; each pixel then collects the layers whose
//! span it lies in, sorts those that pass, and has them blended. No more is kept than the layers of one pixel.
//!
//! Duties: depth tests, order, blending. Inputs from: [`super::piece`], opaque depths. Outputs to: [`super::canvas`],
//! counts. Clocks: those of [`super`].

use super::Counts;
use super::canvas::Canvas;
use super::piece::{Palette, Part};
use super::tile::Place;
use crate::geometry::plane::below;
use crate::hidden::stencil::StencilCounts;
use crate::hidden::z_buffer::kernel::LANES;
use fearless_simd::Simd;
use fearless_simd::prelude::*;

/// A layer, or a clear, on a row.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: i32,
    to: i32,
    /// Its place among the parts.
    part: u32,
    /// Its colours in the chunk of 16 pixels at hand, if they are made.
    colours: Option<[u32; LANES]>,
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

/// Where pixels are composed.
struct Site<'a, 'p> {
    parts: &'a [Part],
    place: &'a Place<'p>,
    palette: &'a mut Palette,
    canvas: &'a mut Canvas,
}

impl Pixels {
    /// Composes the layers of an area; the canvas holds its pixels.
    #[inline(always)]
    pub fn compose<S: Simd>(
        &mut self,
        simd: S,
        parts: &[Part],
        place: &Place<'_>,
        palette: &mut Palette,
        canvas: &mut Canvas,
        counts: &mut Counts,
    ) {
        let below = below(place.format);
        let mut site = Site { parts, place, palette, canvas };
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
                    self.spans.push(Span { from, to, part: number, colours: None });
                }
            }
            let from = self.spans.iter().map(|span| span.from).min().unwrap_or(0);
            let to = self.spans.iter().map(|span| span.to).max().unwrap_or(0);
            for x in from..to {
                if x % LANES as i32 == 0 {
                    self.spans.iter_mut().for_each(|span| span.colours = None);
                }
                self.test(&site, [x, y], below, counts);
                self.blend(simd, &mut site, [x, y], counts);
            }
        }
    }

    /// Collects the layers of a pixel that pass, in the order in which they are composed. A fragment's number is the place
    /// of its span.
    #[inline(always)]
    fn test(&mut self, site: &Site<'_, '_>, [x, y]: [i32; 2], below: u32, counts: &mut Counts) {
        let stored = site.place.depth_at(x, y);
        let value = site.place.stencil_at(x, y);
        self.fragments.clear();
        let (mut came, mut tests) = (0, StencilCounts::default());
        for (span, number) in self.spans.iter().zip(0..).filter(|(span, _)| (span.from..span.to).contains(&x)) {
            let piece = match &site.parts[span.part as usize] {
                Part::Layer(piece) => piece,
                part => {
                    let hole = matches!(part, Part::Cover(piece) if piece.is_hole(site.place.draws, x, y));
                    if !hole {
                        self.fragments.clear();
                        (came, tests) = (0, StencilCounts::default());
                    }
                    continue;
                }
            };
            came += 1;
            if let Some(test) = piece.stencil(site.place.draws) {
                let failed = u64::from(!test.passes(value));
                tests = tests.plus(StencilCounts { tested: 1, failed });
                if failed == 1 {
                    continue;
                }
            }
            let depth = piece.depth(x, y, below);
            if piece.test.is_none_or(|test| test.passes(depth, stored)) {
                self.fragments.push(Fragment { depth, number });
            }
        }
        counts.fragments += came;
        counts.stencil = counts.stencil.plus(tests);
        sort(&mut self.fragments, counts);
    }

    /// Blends them. Colours are made 16 at a time: most layers go on for some pixels.
    #[inline(always)]
    fn blend<S: Simd>(&mut self, simd: S, site: &mut Site<'_, '_>, [x, y]: [i32; 2], counts: &mut Counts) {
        let (lane, pixel) = (x as usize % LANES, site.place.of(x, y));
        for fragment in &self.fragments {
            let span = &mut self.spans[fragment.number as usize];
            let Part::Layer(piece) = &site.parts[span.part as usize] else {
                continue;
            };
            piece.count_shaded(site.place.draws, 1, counts);
            let colours = match span.colours {
                Some(colours) => colours,
                None => {
                    let made = site.palette.of(piece, site.place.draws);
                    *span.colours.insert(made.sixteen(simd, x - lane as i32, y).to_array())
                }
            };
            site.canvas.blend(pixel, piece.mode, colours[lane]);
        }
    }
}
