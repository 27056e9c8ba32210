//! One pixel: its fragments are ordered, merged, packed and averaged.
//!
//! Source: JP 2569952 B2 (1990).
//!
//! The pixel is at any time cut into *parts*: sets of samples that show one fragment and have the depths of one. The
//! parts have no sample in common and together all of them. An opaque fragment meets each part that it shares samples
//! with; its depth test is decided for all of these at once where the depth ranges of the two say it, and sample by
//! sample where they overlap. Translucent fragments (*layers*) wait until the opaque ones are through.
//!
//! | SUBPIXEL_DEPTH | range of a fragment | depths evaluated |
//! | --- | --- | --- |
//! | centre | the depth at the pixel's centre | 1 |
//! | search | from the nearest to the farthest depth that two searches find ([`super::search`]) | 2 to 4, more where ranges overlap |
//! | exhaustive | bounds of all its samples | one a sample |
//!
//! Ranges are found when they are first needed: never where masks have nothing in common, nor where the depths of the
//! vertices say the order.
//!
//! *Merge*: opaque fragments of one object tag that are seen and whose polygons' depths overlap go on as one, so that the samples
//! of a surface that edges cut up are packed once. Masks are exact: the picture is the same, only packing is less.
//!
//! *Pack*: the contribution of what is seen is the number of its samples over all. Layers are composed from the
//! farthest to the nearest over each part; where their ranges overlap, sample by sample.

use super::brief::Brief;
use super::gamma::Space;
use super::layers::Layer;
use super::lists::Fragment;
use super::map::Reason;
use super::parts::{Depths, Resolver};
use super::piece::{Piece, Sampled};
use super::scene::ItemDraw;
use super::shader::{Rings, Source};
use super::shares::Shares;
use super::waiting::Early;
use super::{Counts, Setting, search};
use fearless_simd::Level;
use zga_abi::format::BlendMode;

/// A pixel, and all that its fragments are looked up in.
pub(super) struct Pixel<'a> {
    pub(super) setting: &'a Setting,
    /// Lanes, if not by the specification.
    pub(super) level: Option<Level>,
    pub(super) space: Space,
    pub(super) source: Source<'a>,
    pub(super) briefs: &'a [Brief],
    pub(super) rings: &'a Rings,
    /// What is known of its fragments beforehand; empty where no piece of the band is a layer.
    pub(super) early: &'a [Early],
    pub(super) fragments: &'a [Fragment],
    pub(super) place: [i32; 2],
    /// Colour (RGBA, R in 7:0) and depth before the first item.
    pub(super) base: (u32, i32),
}

impl Pixel<'_> {
    pub(super) fn piece(&self, fragment: usize) -> &Piece {
        &self.source.pieces[self.fragments[fragment].piece as usize]
    }

    #[inline(always)]
    pub(super) fn brief(&self, fragment: usize) -> &Brief {
        &self.briefs[self.fragments[fragment].piece as usize]
    }

    pub(super) fn draw(&self, fragment: usize) -> &ItemDraw {
        &self.source.draws[self.piece(fragment).draw as usize]
    }

    /// What is known of a fragment beforehand.
    #[inline(always)]
    pub(super) fn early(&self, fragment: usize) -> Early {
        self.early.get(fragment).copied().unwrap_or_default()
    }

    /// Colour of a fragment of a pixel with layers.
    pub(super) fn colour(&self, fragment: usize, counts: &mut Counts) -> u32 {
        counts.shade(self.draw(fragment), 1);
        // Found beforehand for all that have samples; none that has not is seen.
        self.early(fragment).colour.unwrap_or_default()
    }

    pub(super) fn depth(&self, fragment: usize, sample: u32) -> i32 {
        let [x, y] = self.place;
        self.piece(fragment).depth(self.setting, x, y, search::offset_of(self.setting.grid, sample))
    }

    /// Depths of a fragment at the samples, where they can be said in 64 bits.
    pub(super) fn sampled(&self, fragment: usize) -> Option<Sampled> {
        let [x, y] = self.place;
        self.piece(fragment).sampled(self.setting, x, y)
    }

    pub(super) fn depth_of(&self, depths: Depths, sample: u32) -> i32 {
        match depths {
            Depths::Constant(depth) => depth,
            Depths::Fragment(fragment) => self.depth(fragment, sample),
        }
    }
}

/// Samples of a mask, by number.
pub(super) fn samples(setting: &Setting, mut mask: u64) -> impl Iterator<Item = u32> {
    let last = setting.grid.samples() - 1;
    std::iter::from_fn(move || {
        let bit = (mask != 0).then(|| mask.ilog2())?;
        mask &= !(1 << bit);
        Some(last - bit)
    })
}

impl Resolver {
    /// Cuts a pixel into shares, from its fragments in order of submission; `apart` if no sample is covered twice. Why it
    /// was taken up.
    #[inline(always)]
    pub(super) fn resolve(
        &mut self,
        pixel: &Pixel<'_>,
        apart: bool,
        shares: &mut Shares,
        counts: &mut Counts,
    ) -> Reason {
        if apart && self.mosaic(pixel, shares, counts) {
            return Reason::Edge;
        }
        self.stack(pixel, shares, counts)
    }

    /// The same where fragments lie over one another.
    fn stack(&mut self, pixel: &Pixel<'_>, shares: &mut Shares, counts: &mut Counts) -> Reason {
        let full = pixel.setting.grid.full();
        self.begin(pixel);
        let mut reason = Reason::Crossing;
        for (number, fragment) in pixel.fragments.iter().enumerate() {
            let (brief, draw) = (pixel.brief(number), pixel.draw(number));
            if brief.clear {
                self.clear(pixel, draw, counts);
                continue;
            }
            if fragment.mask != full {
                reason = reason.max_edge();
            }
            // One at the centre alone has no sample: it is not seen, hole or not.
            if brief.holes && (fragment.mask == 0 || pixel.early(number).hole) {
                continue;
            }
            if brief.layer && brief.blend {
                let colour = pixel.colour(number, counts);
                match colour >> 24 {
                    0 if draw.mode != BlendMode::Premultiplied => continue,
                    alpha if draw.hides(alpha) => {}
                    _ => {
                        reason = Reason::Layer;
                        self.layers.push(Layer::new(pixel.space, fragment.mask, number, colour, draw.mode));
                        continue;
                    }
                }
            }
            self.opaque(pixel, number, draw, counts);
        }
        self.finish(pixel, shares, counts);
        reason
    }
}

impl Reason {
    /// An edge is a stronger reason than a crossing, a layer than both.
    fn max_edge(self) -> Reason {
        if self == Reason::Layer { self } else { Reason::Edge }
    }
}
