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

use super::band::Work;
use super::gamma::Space;
use super::layers::Layer;
pub(super) use super::lists::Fragment;
use super::map::Reason;
use super::parts::Depths;
use super::piece::{Piece, Sampled};
use super::scene::{ItemDraw, Kind};
use super::{Counts, Setting, search};
use zga_abi::format::BlendMode;

/// A pixel, and all that its fragments are looked up in.
pub(super) struct Pixel<'a> {
    pub(super) setting: &'a Setting,
    pub(super) space: Space,
    pub(super) draws: &'a [ItemDraw],
    pub(super) pieces: &'a [Piece],
    pub(super) fragments: &'a [Fragment],
    pub(super) place: [i32; 2],
}

impl Pixel<'_> {
    pub(super) fn piece(&self, fragment: usize) -> &Piece {
        &self.pieces[self.fragments[fragment].piece as usize]
    }

    pub(super) fn draw(&self, fragment: usize) -> &ItemDraw {
        &self.draws[self.piece(fragment).draw as usize]
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

impl Work {
    /// The colour (RGBA, R in 7:0) of pixel (`x`, `y`), from its fragments in order of submission, and why it was
    /// taken up.
    #[expect(clippy::too_many_arguments, reason = "one pixel's inputs, from its one caller")]
    pub fn resolve(
        &mut self,
        setting: &Setting,
        space: Space,
        draws: &[ItemDraw],
        fragments: &[Fragment],
        place: [i32; 2],
        base: (u32, i32),
        counts: &mut Counts,
    ) -> (u32, Reason) {
        let full = setting.grid.full();
        let apart = disjoint(fragments);
        let pixel = Pixel { setting, space, draws, pieces: &self.pieces, fragments, place };
        let resolver = &mut self.resolver;
        if apart && let Some(colour) = resolver.mosaic(&pixel, base, &mut self.shader, counts) {
            return (colour, Reason::Edge);
        }
        resolver.begin(setting, base, fragments.len());
        let mut reason = Reason::Crossing;
        for (number, fragment) in fragments.iter().enumerate() {
            let piece = pixel.piece(number);
            let draw = &draws[piece.draw as usize];
            if piece.kind == Kind::Clear {
                resolver.clear(&pixel, draw, &mut self.shader, counts);
                continue;
            }
            if fragment.mask != full {
                reason = reason.max_edge();
            }
            // One at the centre alone has no sample: it is not seen, hole or not.
            if draw.has_holes() && (fragment.mask == 0 || self.shader.is_hole(&pixel, number, counts)) {
                continue;
            }
            if piece.layer && draw.blend {
                let colour = self.shader.colour(&pixel, number, counts);
                match colour >> 24 {
                    0 if draw.mode != BlendMode::Premultiplied => continue,
                    alpha if draw.hides(alpha) => {}
                    _ => {
                        reason = Reason::Layer;
                        resolver.layers.push(Layer::new(space, fragment.mask, number, colour, draw.mode));
                        continue;
                    }
                }
            }
            resolver.opaque(&pixel, number, draw, counts);
        }
        counts.active += 1;
        let colour = resolver.finish(&pixel, &mut self.shader, counts);
        (colour, reason)
    }
}

/// Whether no sample is covered twice.
#[inline(always)]
fn disjoint(fragments: &[Fragment]) -> bool {
    let (mut all, mut shared) = (0, 0);
    for fragment in fragments {
        shared |= all & fragment.mask;
        all |= fragment.mask;
    }
    shared == 0
}

impl Reason {
    /// An edge is a stronger reason than a crossing, a layer than both.
    fn max_edge(self) -> Reason {
        if self == Reason::Layer { self } else { Reason::Edge }
    }
}
