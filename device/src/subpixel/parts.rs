//! The parts of a pixel: which opaque fragment is seen at each sample.
//!
//! What each test, range and merge means is told in [`super::pixel`].

use super::layers::{Class, Layer, LayerDepths, Run};
use super::lists::Fragment;
use super::piece::{Piece, Sampled};
use super::pixel::{Pixel, samples};
use super::scene::{ItemDraw, Kind, Rule};
use super::search::{self, DepthRange, Extreme};
use super::shader::Shader;
use super::{Counts, Setting, search_clocked};
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
    pub(super) fn begin(&mut self, setting: &Setting, (colour, depth): (u32, i32), fragments: usize) {
        self.parts.clear();
        self.layers.clear();
        self.mixed.clear();
        self.known.clear();
        self.known.resize(fragments, Known::default());
        self.parts.push(Part {
            mask: setting.grid.full(),
            paint: Paint::Plain(colour),
            depths: Depths::Constant(depth),
        });
    }

    /// The pixel where no sample is covered twice, all is opaque and nothing was nearer before: nothing is to be ordered.
    /// `None` if it is not so simple.
    #[inline(always)]
    pub(super) fn mosaic(
        &mut self,
        pixel: &Pixel<'_>,
        (colour, depth): (u32, i32),
        shader: &mut Shader,
        counts: &mut Counts,
    ) -> Option<u32> {
        let simple = |fragment: &Fragment| {
            let piece = &pixel.pieces[fragment.piece as usize];
            let before = match pixel.setting.rule {
                Rule::Nearest => piece.plane.maximum < depth,
                Rule::Last => true,
                Rule::InOrder => false,
            };
            before && !piece.layer
        };
        if !pixel.fragments.iter().all(simple) {
            return None;
        }
        if !pixel.space.is_of_values() {
            return None;
        }
        self.seen.clear();
        let mut rest = pixel.setting.grid.full();
        let (mut sum, mut first, mut same) = (0, None, true);
        let mut add = |colour: u32, mask: u64| {
            same &= *first.get_or_insert(colour) == colour;
            sum += spread(colour) * u64::from(mask.count_ones());
        };
        for (number, &Fragment { mask, .. }) in pixel.fragments.iter().enumerate() {
            if mask != 0 {
                rest &= !mask;
                add(shader.colour(pixel, number, counts), mask);
                self.merge(pixel, number, counts);
            }
        }
        if rest != 0 {
            counts.packed += 1;
            add(colour, rest);
        }
        counts.active += 1;
        // Half up; the number of samples is a power of two.
        let count = pixel.setting.grid.samples();
        let mean = (sum + u64::from(count / 2) * 0x0001_0001_0001_0001) >> count.ilog2();
        Some(if same { first.unwrap_or(colour) } else { gathered(mean) })
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
    pub(super) fn clear(&mut self, pixel: &Pixel<'_>, clear: &ItemDraw, shader: &mut Shader, counts: &mut Counts) {
        if clear.colour.is_none() && self.layers.iter().any(|layer| layer.mask != 0) {
            self.compose(pixel, shader, counts);
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

    /// The mean of the samples.
    pub(super) fn finish(&mut self, pixel: &Pixel<'_>, shader: &mut Shader, counts: &mut Counts) -> u32 {
        self.merge_parts(pixel, counts);
        let count = pixel.setting.grid.samples();
        if self.layers.iter().all(|layer| layer.mask == 0) && self.mixed.is_empty() {
            return self.mean_of_levels(pixel, shader, counts);
        }
        self.compose(pixel, shader, counts);
        let mut sum = [0.0; 4];
        for class in &self.classes {
            let weight = f64::from(class.mask.count_ones());
            sum = [0, 1, 2, 3].map(|c| sum[c] + weight * class.value[c]);
        }
        pixel.space.colour(sum.map(|c| c / f64::from(count)))
    }

    /// The mean where all parts have plain colours.
    fn mean_of_levels(&mut self, pixel: &Pixel<'_>, shader: &mut Shader, counts: &mut Counts) -> u32 {
        let count = pixel.setting.grid.samples();
        let mut sum = [0_u32; 4];
        let mut light = [0.0; 4];
        let (mut first, mut same) = (None, true);
        for part in &self.parts {
            let colour = match part.paint {
                Paint::Plain(colour) => colour,
                Paint::Fragment(fragment) => shader.colour(pixel, fragment, counts),
                // None is left: see `finish`.
                Paint::Mixed(_) => 0,
            };
            same &= *first.get_or_insert(colour) == colour;
            let weight = part.mask.count_ones();
            let levels = colour.to_le_bytes();
            sum = [0, 1, 2, 3].map(|c| sum[c] + weight * u32::from(levels[c]));
            if !pixel.space.is_of_values() {
                let there = pixel.space.of(colour);
                light = [0, 1, 2, 3].map(|c| light[c] + f64::from(weight) * there[c]);
            }
        }
        if same {
            return first.unwrap_or(0);
        }
        if pixel.space.is_of_values() {
            // Half up; the number of samples is a power of two.
            return u32::from_le_bytes(sum.map(|c| ((c + count / 2) >> count.ilog2()) as u8));
        }
        pixel.space.colour([0, 1, 2, 3].map(|c| if c < 3 { light[c] } else { f64::from(sum[c]) } / f64::from(count)))
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
        let piece = pixel.piece(fragment);
        let ItemDraw { tag, test, .. } = pixel.draws[piece.draw as usize];
        let bounds = if test.is_some() { [piece.plane.minimum, piece.plane.maximum] } else { [0; 2] };
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

/// The four levels of a colour in 16 bits each, so that 64 of them add up: 0 and 2, then 1 and 3.
#[inline(always)]
fn spread(colour: u32) -> u64 {
    let colour = u64::from(colour);
    (colour & 0x00FF_00FF) | ((colour >> 8) & 0x00FF_00FF) << 32
}

/// The reverse of [`spread`], for levels that fit; what lies above each is dropped.
#[inline(always)]
fn gathered(levels: u64) -> u32 {
    (levels & 0x00FF_00FF) as u32 | (((levels >> 32) & 0x00FF_00FF) << 8) as u32
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
    let depth = |offset| piece.depth(setting, x, y, offset);
    let slopes = piece.slopes();
    let found = if setting.clocked {
        let extreme = |extreme| search_clocked::extreme_of(setting.grid, mask, slopes, extreme, depth).0;
        extreme(Extreme::Nearest).zip(extreme(Extreme::Farthest)).map(|(near, far)| DepthRange {
            nearest: near.depth.min(far.depth),
            farthest: near.depth.max(far.depth),
            steps: near.steps + far.steps,
            evaluations: near.evaluations + far.evaluations,
        })
    } else {
        search::range_of(setting.grid, mask, slopes, depth)
    };
    // PANIC: a range is only asked for where samples are shared: the fragment covers one at least.
    found.unwrap_or_else(|| unreachable!("a fragment of no sample"))
}
