//! Layers: translucent fragments over the parts of a pixel.
//!
//! Each is tested by its own depth function against what is opaque at its samples, then all are composed from the
//! farthest to the nearest, equal depths in order of submission: over all samples of a part at once where their depth
//! ranges say one order for all, else sample by sample.

use super::gamma::{Space, WHITE};
use super::parts::{Depths, Paint, Part, Resolver};
use super::piece::Sampled;
use super::pixel::{Pixel, samples};
use super::{Counts, search};
use zga_abi::format::{BlendMode, SubpixelDepth};

/// A translucent fragment that waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    pub(super) mask: u64,
    pub(super) fragment: usize,
    /// Its colour, in the space in which samples are averaged.
    source: [f64; 3],
    /// 0 to 1.
    alpha: f64,
    mode: BlendMode,
}

/// Where the depths of a layer at samples come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum LayerDepths {
    /// It is not tested: it lies over all others.
    Last,
    /// 64 bits.
    Sampled(Sampled),
    /// More bits.
    Steep,
}

/// Layers with the same depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// Nearest and farthest.
    range: [i32; 2],
    /// Samples of any of them.
    mask: u64,
    /// One of them.
    fragment: usize,
}

/// Composed samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Class {
    pub(super) mask: u64,
    pub(super) value: [f64; 4],
    pub(super) depths: Depths,
}

impl Layer {
    /// Fragment `fragment`, of `colour` (RGBA, R in 7:0), over the samples of `mask`.
    pub(super) fn new(space: Space, mask: u64, fragment: usize, colour: u32, mode: BlendMode) -> Layer {
        let [r, g, b, _] = space.of(colour);
        Layer { mask, fragment, source: [r, g, b], alpha: f64::from(colour >> 24) / WHITE, mode }
    }

    /// The layer over what is below it.
    #[inline(always)]
    fn over(&self, below: [f64; 4]) -> [f64; 4] {
        let Layer { source, alpha, .. } = *self;
        let blended = |c: usize| match self.mode {
            BlendMode::Alpha => below[c] * (1.0 - alpha) + source[c] * alpha,
            BlendMode::Add => (below[c] + source[c] * alpha).min(WHITE),
            BlendMode::Multiply => below[c] * (1.0 - alpha * (1.0 - source[c] / WHITE)),
            BlendMode::Premultiplied => (source[c] + below[c] * (1.0 - alpha)).min(WHITE),
        };
        // The coverage behind a layer: what is not let through grows toward white.
        let coverage = match self.mode {
            BlendMode::Alpha | BlendMode::Premultiplied => below[3] * (1.0 - alpha) + WHITE * alpha,
            BlendMode::Add | BlendMode::Multiply => below[3],
        };
        [blended(0), blended(1), blended(2), coverage]
    }
}

impl Resolver {
    /// Values of all parts with the layers over them, in `classes`.
    pub(super) fn compose(&mut self, pixel: &Pixel<'_>, counts: &mut Counts) {
        self.classes.clear();
        for index in 0..self.parts.len() {
            let Part { mask, paint, depths } = self.parts[index];
            let value = match paint {
                Paint::Plain(colour) => pixel.space.of(colour),
                Paint::Fragment(fragment) => pixel.space.of(pixel.colour(fragment, counts)),
                Paint::Mixed(place) => self.mixed[place],
            };
            self.classes.push(Class { mask, value, depths });
        }
        let mut layers = std::mem::take(&mut self.layers);
        for layer in &mut layers {
            layer.mask = self.visible(pixel, layer, counts);
        }
        layers.retain(|layer| layer.mask != 0);
        counts.packed += layers.len() as u64;
        let tangled = self.sort(pixel, &layers, counts);
        for place in 0..self.order.len() {
            let layer = layers[self.order[place].1];
            self.blend(&layer, layer.mask & !tangled);
        }
        self.blend_tangled(pixel, &layers, tangled);
        self.classes.retain(|class| class.mask != 0);
        self.layers = layers;
    }

    /// Blends the layers over samples that have no common order, those that follow one another in the same order at once.
    fn blend_tangled(&mut self, pixel: &Pixel<'_>, layers: &[Layer], tangled: u64) {
        if tangled == 0 {
            return;
        }
        let mut order = std::mem::take(&mut self.order);
        let mut depths = std::mem::take(&mut self.sampled);
        order.retain(|&(_, number)| layers[number].mask & tangled != 0);
        depths.clear();
        depths.extend(layers.iter().map(|layer| match pixel.draw(layer.fragment).test {
            None => LayerDepths::Last,
            Some(_) => match pixel.sampled(layer.fragment) {
                Some(sampled) => LayerDepths::Sampled(sampled),
                None => LayerDepths::Steep,
            },
        }));
        let mut group = 0;
        for sample in samples(pixel.setting, tangled) {
            let offset = search::offset_of(pixel.setting.grid, sample);
            for (depth, number) in &mut order {
                *depth = match &depths[*number] {
                    LayerDepths::Last => i32::MIN,
                    LayerDepths::Sampled(sampled) => sampled.depth(offset),
                    LayerDepths::Steep => pixel.depth(layers[*number].fragment, sample),
                };
            }
            // Farther, or as far and earlier, comes first.
            let before = |a: &(i32, usize), b: &(i32, usize)| (b.0, a.1) < (a.0, b.1);
            if !order.is_sorted_by(before) {
                order.iter().for_each(|&(_, number)| self.blend(&layers[number], layers[number].mask & group));
                group = 0;
                // From an order to another few change places.
                for place in 1..order.len() {
                    let mut to = place;
                    while to > 0 && before(&order[to], &order[to - 1]) {
                        order.swap(to - 1, to);
                        to -= 1;
                    }
                }
            }
            group |= pixel.setting.grid.sample_bit(sample);
        }
        order.iter().for_each(|&(_, number)| self.blend(&layers[number], layers[number].mask & group));
        (self.order, self.sampled) = (order, depths);
    }

    /// Samples at which a layer is not hidden by what is opaque.
    fn visible(&mut self, pixel: &Pixel<'_>, layer: &Layer, counts: &mut Counts) -> u64 {
        let Some(test) = pixel.draw(layer.fragment).test else {
            return layer.mask;
        };
        let mut visible = 0;
        for index in 0..self.parts.len() {
            let Part { mask, depths, .. } = self.parts[index];
            let shared = mask & layer.mask;
            if shared != 0 {
                visible |= self.passing(pixel, test, layer.fragment, depths, shared, counts);
            }
        }
        visible
    }

    /// Puts the layers in order, the farthest first, of equal ones the earlier: places in `order`. Returns the samples
    /// that have no common order.
    fn sort(&mut self, pixel: &Pixel<'_>, layers: &[Layer], counts: &mut Counts) -> u64 {
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        if layers.len() < 2 {
            order.extend((0..layers.len()).map(|number| (0, number)));
            self.order = order;
            return 0;
        }
        for (number, layer) in layers.iter().enumerate() {
            let nearest = match pixel.draw(layer.fragment).test {
                None => {
                    self.known[layer.fragment].range = Some([i32::MIN; 2]);
                    i32::MIN
                }
                Some(_) => self.range(pixel, layer.fragment, counts)[0],
            };
            order.push((nearest, number));
        }
        order.sort_by_key(|&(nearest, number)| (std::cmp::Reverse(nearest), number));
        self.collect_runs(pixel, layers, &order);
        let tangled = self.tangled(pixel);
        if pixel.setting.depth == SubpixelDepth::Search && tangled != 0 {
            let depths = layers.iter().map(|layer| u64::from((layer.mask & tangled).count_ones()));
            counts.evaluations += depths.sum::<u64>();
        }
        self.order = order;
        tangled
    }

    /// Layers that follow one another in `order` and have the same depths wherever they are, as one: between them the
    /// order of submission is right.
    fn collect_runs(&mut self, pixel: &Pixel<'_>, layers: &[Layer], order: &[(i32, usize)]) {
        self.runs.clear();
        for &(_, number) in order {
            let Layer { mask, fragment, .. } = layers[number];
            let range = self.known[fragment].range.unwrap_or_default();
            match self.runs.last_mut() {
                Some(run)
                    if run.range == range
                        && (range[0] == range[1] || pixel.piece(run.fragment).lies_in(pixel.piece(fragment))) =>
                {
                    run.mask |= mask;
                }
                _ => self.runs.push(Run { range, mask, fragment }),
            }
        }
    }

    /// Samples that runs share of which the nearest depths do not say the order: their ranges overlap, and it is not
    /// certain that their planes do not meet in the pixel.
    fn tangled(&self, pixel: &Pixel<'_>) -> u64 {
        let [x, y] = pixel.place;
        let behind = |far: &Run, near: &Run| {
            pixel.setting.depth != SubpixelDepth::Centre
                && pixel.piece(far.fragment).lies_behind(pixel.piece(near.fragment), pixel.setting, x, y)
        };
        // Samples that two share: no more can be tangled.
        let (mut once, mut twice) = (0, 0);
        for run in &self.runs {
            twice |= once & run.mask;
            once |= run.mask;
        }
        let mut tangled = 0;
        // The farthest depth of those that follow: where it is nearer than all of one, that one is in its place. So is
        // it before those whose nearest depth is nearer by more than any of them is deep.
        let (mut farthest, mut deepest) = (i32::MIN, 0);
        for (place, far) in self.runs.iter().enumerate().rev() {
            if tangled == twice {
                break;
            }
            if farthest >= far.range[0] {
                for near in &self.runs[place + 1..] {
                    if near.range[0].saturating_add(deepest) < far.range[0] {
                        break;
                    }
                    let shared = far.mask & near.mask & !tangled;
                    if near.range[1] >= far.range[0] && shared != 0 && !behind(far, near) {
                        tangled |= shared;
                    }
                }
            }
            farthest = farthest.max(far.range[1]);
            deepest = deepest.max(far.range[1].saturating_sub(far.range[0]));
        }
        tangled
    }

    /// Blends a layer over samples.
    fn blend(&mut self, layer: &Layer, mask: u64) {
        for index in 0..self.classes.len() {
            let class = self.classes[index];
            let shared = class.mask & mask;
            if shared == 0 {
                continue;
            }
            self.classes[index].mask = shared;
            self.classes[index].value = layer.over(class.value);
            if shared != class.mask {
                self.classes.push(Class { mask: class.mask & !shared, ..class });
            }
        }
    }
}
