//! The parts of a pixel: which opaque fragment is seen at each sample.
//!
//! What each test, range and merge means is told in [`super::pixel`].

use super::brief::Brief;
use super::grid::Offset;
use super::layers::{Class, Layer, LayerDepths, Run};
use super::lists::Fragment;
use super::piece::{Piece, Sampled};
use super::pixel::{Pixel, samples};
use super::scene::{ItemDraw, Kind, Rule};
use super::search::{self, DepthRange, Extreme};
use super::shares::Shares;
use super::{Counts, Setting, compare, search_clocked};
use crate::hidden::z_buffer::DepthTest;
use zga_abi::format::SubpixelDepth;

/// Where the colour of a part comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    /// RGBA, R in 7:0.
    Plain(u32),
    /// A fragment, by its place; shaded at the end.
    Fragment(usize),
    /// Composed: a place in [`Resolver::mixed`].
    Mixed(usize),
}

/// Where the depths of a part come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depths {
    /// One depth.
    Constant(i32),
    /// Those of a fragment, by its place.
    Fragment(usize),
}

/// Samples that show one thing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) mask: u64,
    pub(super) paint: Paint,
    pub(super) depths: Depths,
}

/// What is known of a fragment's depths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Known {
    pub(super) range: Option<[i32; 2]>,
}

/// Memory of one thread that resolves pixels.
#[derive(Debug, Default)]
pub struct Resolver {
    pub(super) parts: Vec<Part>,
    pub(super) layers: Vec<Layer>,
    pub(super) known: Vec<Known>,
    pub(super) mixed: Vec<[f64; 4]>,
    pub(super) classes: Vec<Class>,
    pub(super) order: Vec<(i32, usize)>,
    /// The layers in that order, those of the same depths as one.
    pub(super) runs: Vec<Run>,
    /// Depths of the layers, while they are put in order sample by sample.
    pub(super) sampled: Vec<LayerDepths>,
    /// Places of fragments that are seen and opaque, with what is compared when they are merged.
    seen: Vec<(u32, [i32; 2])>,
}

/// What a depth test says of all samples whose depths lie in these ranges, where it says the same of all.
#[inline(always)]
fn decided(test: DepthTest, new: [i32; 2], stored: [i32; 2]) -> Option<bool> {
    let less = (new[0] < stored[1]).then_some(test.less);
    let equal = (new[0] <= stored[1] && stored[0] <= new[1]).then_some(test.equal);
    let greater = (new[1] > stored[0]).then_some(test.greater);
    let mut verdicts = [less, equal, greater].into_iter().flatten();
    let first = verdicts.next()?;
    verdicts.all(|verdict| verdict == first).then_some(first)
}

impl Resolver {
    pub(super) fn begin(&mut self, pixel: &Pixel<'_>) {
        self.parts.clear();
        self.layers.clear();
        self.mixed.clear();
        self.known.clear();
        self.known.resize(pixel.fragments.len(), Known::default());
        let (colour, depth) = pixel.base;
        self.parts.push(Part {
            mask: pixel.setting.grid.full(),
            paint: Paint::Plain(colour),
            depths: Depths::Constant(depth),
        });
    }

    /// The pixel where no sample is covered twice, if all is opaque and nothing was nearer before: nothing is to be
    /// ordered. Whether it is so simple.
    #[inline(always)]
    pub(super) fn mosaic(&mut self, pixel: &Pixel<'_>, shares: &mut Shares, counts: &mut Counts) -> bool {
        // Most have two fragments or three.
        match pixel.fragments {
            two @ [_, _] => self.mosaic_of(pixel, two, shares, counts),
            three @ [_, _, _] => self.mosaic_of(pixel, three, shares, counts),
            all => self.mosaic_of(pixel, all, shares, counts),
        }
    }

    #[inline(always)]
    fn mosaic_of(
        &mut self,
        pixel: &Pixel<'_>,
        fragments: &[Fragment],
        shares: &mut Shares,
        counts: &mut Counts,
    ) -> bool {
        let (colour, depth) = pixel.base;
        let mut rest = pixel.setting.grid.full();
        let mut simple = true;
        for fragment in fragments {
            let brief = &pixel.briefs[fragment.piece as usize];
            let before = match pixel.setting.rule {
                Rule::Nearest => brief.range[1] < depth,
                Rule::Last => true,
                Rule::InOrder => false,
            };
            simple &= before & !brief.layer;
            rest &= !fragment.mask;
        }
        if !simple {
            return false;
        }
        if rest != 0 {
            counts.packed += 1;
            shares.plain(colour, rest);
        }
        self.seen.clear();
        for (number, fragment) in fragments.iter().enumerate() {
            if fragment.mask != 0 {
                shares.fragment(pixel, number, fragment.mask, counts);
                self.merge(pixel, number, counts);
            }
        }
        true
    }

    /// Depth range of a fragment as the setting has it, found when it is first asked for.
    pub(super) fn range(&mut self, pixel: &Pixel<'_>, fragment: usize, counts: &mut Counts) -> [i32; 2] {
        if let Some(range) = self.known[fragment].range {
            return range;
        }
        let range = range_of(pixel, fragment, counts);
        self.known[fragment].range = Some(range);
        range
    }

    fn range_of_depths(&mut self, pixel: &Pixel<'_>, depths: Depths, counts: &mut Counts) -> [i32; 2] {
        match depths {
            Depths::Constant(depth) => [depth; 2],
            Depths::Fragment(fragment) => self.range(pixel, fragment, counts),
        }
    }

    /// Samples of `shared` at which fragment `new` passes `test` against `depths`.
    pub(super) fn passing(
        &mut self,
        pixel: &Pixel<'_>,
        test: DepthTest,
        new: usize,
        depths: Depths,
        shared: u64,
        counts: &mut Counts,
    ) -> u64 {
        let all = |passes: bool| if passes { shared } else { 0 };
        let of_vertices = |fragment: usize| {
            let plane = &pixel.piece(fragment).plane;
            [plane.minimum, plane.maximum]
        };
        let stored = match depths {
            Depths::Constant(depth) => [depth; 2],
            Depths::Fragment(fragment) => of_vertices(fragment),
        };
        if let Some(passes) = decided(test, of_vertices(new), stored) {
            return all(passes);
        }
        let range = self.range(pixel, new, counts);
        let stored = self.range_of_depths(pixel, depths, counts);
        if let Some(passes) = decided(test, range, stored) {
            return all(passes);
        }
        if pixel.setting.depth == SubpixelDepth::Search {
            let planes = 1 + u64::from(matches!(depths, Depths::Fragment(_)));
            counts.evaluations += planes * u64::from(shared.count_ones());
        }
        let bit = |sample: u32| pixel.setting.grid.sample_bit(sample);
        let samples = samples(pixel.setting, shared);
        let sampled = match depths {
            Depths::Constant(depth) => Some(Sampled::level(depth)),
            Depths::Fragment(fragment) => pixel.sampled(fragment),
        };
        if let (Some(new), Some(stored)) = (pixel.sampled(new), sampled) {
            if let Some(level) = pixel.level {
                return compare::passing(level, pixel.setting.grid, test, &new, &stored) & shared;
            }
            let passes = |sample: &u32| {
                let offset = search::offset_of(pixel.setting.grid, *sample);
                test.passes(new.depth(offset), stored.depth(offset))
            };
            return samples.filter(passes).map(bit).sum();
        }
        samples.filter(|&sample| test.passes(pixel.depth(new, sample), pixel.depth_of(depths, sample))).map(bit).sum()
    }

    /// An opaque fragment.
    pub(super) fn opaque(&mut self, pixel: &Pixel<'_>, new: usize, draw: &ItemDraw, counts: &mut Counts) {
        let mask = pixel.fragments[new].mask;
        let (mut won, before) = (0, self.parts.len());
        for index in 0..before {
            let part = self.parts[index];
            let shared = part.mask & mask;
            if shared == 0 {
                continue;
            }
            let passed = match draw.test {
                None => shared,
                Some(test) => self.passing(pixel, test, new, part.depths, shared, counts),
            };
            self.parts[index].mask &= !passed;
            won |= passed;
            if passed != 0 && !draw.test.is_some_and(|test| test.write) {
                self.parts.push(Part { mask: passed, paint: Paint::Fragment(new), depths: part.depths });
            }
        }
        if won == 0 {
            return;
        }
        match draw.test {
            Some(test) if test.write => {
                self.parts.push(Part { mask: won, paint: Paint::Fragment(new), depths: Depths::Fragment(new) });
            }
            Some(_) => {}
            None => self.layers.iter_mut().for_each(|layer| layer.mask &= !mask),
        }
        self.parts.retain(|part| part.mask != 0);
    }

    /// A clear: of colours, which also takes the layers; of depths, which composes them first.
    pub(super) fn clear(&mut self, pixel: &Pixel<'_>, clear: &ItemDraw, counts: &mut Counts) {
        if clear.colour.is_none() && self.layers.iter().any(|layer| layer.mask != 0) {
            self.compose(pixel, counts);
            self.parts.clear();
            for class in &self.classes {
                self.mixed.push(class.value);
                let paint = Paint::Mixed(self.mixed.len() - 1);
                self.parts.push(Part { mask: class.mask, paint, depths: class.depths });
            }
        }
        self.layers.clear();
        for part in &mut self.parts {
            part.paint = clear.colour.map_or(part.paint, Paint::Plain);
            part.depths = clear.depth.map_or(part.depths, Depths::Constant);
        }
    }

    /// The shares of the parts, with the layers over them.
    pub(super) fn finish(&mut self, pixel: &Pixel<'_>, shares: &mut Shares, counts: &mut Counts) {
        self.merge_parts(pixel, counts);
        if self.layers.iter().all(|layer| layer.mask == 0) && self.mixed.is_empty() {
            for part in &self.parts {
                match part.paint {
                    Paint::Plain(colour) => shares.plain(colour, part.mask),
                    Paint::Fragment(fragment) => shares.fragment(pixel, fragment, part.mask, counts),
                    // None is left.
                    Paint::Mixed(_) => {}
                }
            }
            return;
        }
        self.compose(pixel, counts);
        let mut sum = [0.0; 4];
        for class in &self.classes {
            let weight = f64::from(class.mask.count_ones());
            sum = [0, 1, 2, 3].map(|c| sum[c] + weight * class.value[c]);
        }
        let grid = pixel.setting.grid;
        shares.plain(pixel.space.colour(sum.map(|c| c / f64::from(grid.samples()))), grid.full());
    }

    /// Counts what of the opaque is packed, and what is merged before.
    fn merge_parts(&mut self, pixel: &Pixel<'_>, counts: &mut Counts) {
        self.seen.clear();
        for index in 0..self.parts.len() {
            match self.parts[index].paint {
                Paint::Fragment(fragment) => self.merge(pixel, fragment, counts),
                Paint::Plain(_) | Paint::Mixed(_) => counts.packed += 1,
            }
        }
    }

    /// Merges a fragment with one that was seen before, or packs it.
    #[inline(always)]
    fn merge(&mut self, pixel: &Pixel<'_>, fragment: usize, counts: &mut Counts) {
        let Brief { tag, range: bounds, .. } = *pixel.brief(fragment);
        for (seen, range) in &mut self.seen {
            if *seen == tag && range[0] <= bounds[1] && bounds[0] <= range[1] {
                *range = [range[0].min(bounds[0]), range[1].max(bounds[1])];
                counts.merges += 1;
                return;
            }
        }
        self.seen.push((tag, bounds));
        counts.packed += 1;
    }
}

/// Depth range of a fragment, with the events that finding it takes.
fn range_of(pixel: &Pixel<'_>, fragment: usize, counts: &mut Counts) -> [i32; 2] {
    let setting = pixel.setting;
    let (piece, [x, y]) = (pixel.piece(fragment), pixel.place);
    let mask = pixel.fragments[fragment].mask;
    if piece.is_level(setting) || piece.kind != Kind::Masked {
        counts.evaluations += 1;
        return [piece.depth(setting, x, y, search::offset_of(setting.grid, 0)); 2];
    }
    match setting.depth {
        SubpixelDepth::Exhaustive => {
            counts.evaluations += u64::from(mask.count_ones());
            piece.bounds(x, y)
        }
        SubpixelDepth::Search | SubpixelDepth::Centre => {
            let found = searched(pixel, piece, mask);
            counts.searches += 2;
            counts.steps += u64::from(found.steps);
            counts.evaluations += u64::from(found.evaluations);
            [found.nearest, found.farthest]
        }
    }
}

/// Two searches: by tables, or clock by clock.
fn searched(pixel: &Pixel<'_>, piece: &Piece, mask: u64) -> DepthRange {
    let (setting, [x, y]) = (pixel.setting, pixel.place);
    let slopes = piece.slopes();
    let found = match piece.sampled(setting, x, y) {
        Some(sampled) if !setting.clocked => search::range_of(setting.grid, mask, slopes, |at| sampled.depth(at)),
        _ => {
            let depth = |offset| piece.depth(setting, x, y, offset);
            match setting.clocked {
                true => clocked(setting, mask, slopes, depth),
                false => search::range_of(setting.grid, mask, slopes, depth),
            }
        }
    };
    // PANIC: a range is only asked for where samples are shared: the fragment covers one at least.
    found.unwrap_or_else(|| unreachable!("a fragment of no sample"))
}

/// Two searches, clock by clock.
fn clocked(setting: &Setting, mask: u64, slopes: [i64; 2], depth: impl Fn(Offset) -> i32) -> Option<DepthRange> {
    let extreme = |extreme| search_clocked::extreme_of(setting.grid, mask, slopes, extreme, &depth).0;
    extreme(Extreme::Nearest).zip(extreme(Extreme::Farthest)).map(|(near, far)| DepthRange {
        nearest: near.depth.min(far.depth),
        farthest: near.depth.max(far.depth),
        steps: near.steps + far.steps,
        evaluations: near.evaluations + far.evaluations,
    })
}
