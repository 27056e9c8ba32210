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
use super::map::Reason;
use super::parts::Depths;
use super::piece::Piece;
use super::scene::{ItemDraw, Kind, Rule};
use super::{Counts, Setting, search};

/// What covers a part of a pixel: 16 bytes of the pool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fragment {
    /// Samples.
    pub mask: u64,
    /// Pixel of the band: its bit in [`Work::active`].
    pub at: u32,
    /// Its piece's place among those of the band: also the order of submission.
    pub piece: u32,
}

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
        fragments: &mut [Fragment],
        place: [i32; 2],
        base: (u32, i32),
        counts: &mut Counts,
    ) -> (u32, Reason) {
        let full = setting.grid.full();
        let mut apart = disjoint(fragments);
        let mut left = fragments.len();
        if !apart && setting.rule != Rule::InOrder {
            left = drop_hidden(&self.pieces, fragments, full, place);
            apart = disjoint(&fragments[..left]);
        }
        let fragments = &fragments[..left];
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
            if piece.layer {
                let colour = self.shader.colour(&pixel, number, counts);
                match colour >> 24 {
                    0 => continue,
                    255 => {}
                    _ => {
                        reason = Reason::Layer;
                        resolver.layers.push(Layer { mask: fragment.mask, fragment: number, colour });
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

/// Fragments whose order is looked for at once, at most.
const FEW: usize = 24;

/// Drops fragments that lie behind others which together cover the whole pixel, where the nearest is seen: the front of
/// a surface hides its back at its edges too. Those that are left stand in front, in order; returns how many.
fn drop_hidden(pieces: &[Piece], fragments: &mut [Fragment], full: u64, [x, y]: [i32; 2]) -> usize {
    let count = fragments.len();
    if count > FEW {
        return count;
    }
    let mut bounds = [[0; 2]; FEW];
    // Opaque ones by their farthest depth: as few as cover the pixel say how far is seen.
    let mut order = [(0, 0_u64); FEW];
    let mut opaque = 0;
    for (fragment, bounds) in fragments.iter().zip(&mut bounds) {
        let piece = &pieces[fragment.piece as usize];
        *bounds = piece.bounds(x, y);
        if !piece.layer {
            let mut place = opaque;
            while place > 0 && order[place - 1].0 > bounds[1] {
                order[place] = order[place - 1];
                place -= 1;
            }
            order[place] = (bounds[1], fragment.mask);
            opaque += 1;
        }
    }
    let mut union = 0;
    let limit = order[..opaque].iter().find_map(|&(far, mask)| {
        union |= mask;
        (union == full).then_some(far)
    });
    let Some(limit) = limit else {
        return count;
    };
    let mut left = 0;
    for number in 0..count {
        fragments[left] = fragments[number];
        left += usize::from(bounds[number][0] <= limit);
    }
    left
}

impl Reason {
    /// An edge is a stronger reason than a crossing, a layer than both.
    fn max_edge(self) -> Reason {
        if self == Reason::Layer { self } else { Reason::Edge }
    }
}
