//! Layers: translucent fragments over the parts of a pixel.
//!
//! Each is tested by its own depth function against what is opaque at its samples, then all are composed from the
//! farthest to the nearest, equal depths in order of submission: over all samples of a part at once where their depth
//! ranges say one order for all, else sample by sample.

use super::Counts;
use super::gamma::Space;
use super::parts::{Depths, Paint, Part, Resolver};
use super::pixel::{Pixel, samples};
use super::shader::Shader;
use zga_abi::format::{BlendMode, SubpixelDepth};

/// A translucent fragment that waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    pub(super) mask: u64,
    pub(super) fragment: usize,
    pub(super) colour: u32,
    pub(super) mode: BlendMode,
}

/// Composed samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Class {
    pub(super) mask: u64,
    pub(super) value: [f64; 4],
    pub(super) depths: Depths,
}

impl Layer {
    /// The layer over what is below it.
    #[inline(always)]
    fn over(&self, space: Space, below: [f64; 4]) -> [f64; 4] {
        let alpha = f64::from(self.colour >> 24) / 255.0;
        // The coverage behind a layer: what is not let through grows toward 255.
        let source = space.of(self.colour | 0xFF00_0000);
        let white = space.of(u32::MAX);
        let blended = |c: usize| match self.mode {
            BlendMode::Alpha => below[c] * (1.0 - alpha) + source[c] * alpha,
            BlendMode::Add => (below[c] + source[c] * alpha).min(white[c]),
            BlendMode::Multiply => below[c] * (1.0 - alpha * (1.0 - source[c] / white[c])),
            BlendMode::Premultiplied => (source[c] + below[c] * (1.0 - alpha)).min(white[c]),
        };
        let coverage = match self.mode {
            BlendMode::Alpha | BlendMode::Premultiplied => below[3] * (1.0 - alpha) + white[3] * alpha,
            BlendMode::Add | BlendMode::Multiply => below[3],
        };
        [blended(0), blended(1), blended(2), coverage]
    }
}

impl Resolver {
    /// Values of all parts with the layers over them, in `classes`.
    pub(super) fn compose(&mut self, pixel: &Pixel<'_>, shader: &mut Shader, counts: &mut Counts) {
        self.classes.clear();
        for index in 0..self.parts.len() {
            let Part { mask, paint, depths } = self.parts[index];
            let value = match paint {
                Paint::Plain(colour) => pixel.space.of(colour),
                Paint::Fragment(fragment) => pixel.space.of(shader.colour(pixel, fragment, counts)),
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
            self.blend(pixel, &layer, layer.mask & !tangled);
        }
        for sample in samples(pixel.setting, tangled) {
            let bit = pixel.setting.grid.sample_bit(sample);
            self.sort_at(pixel, &layers, sample);
            let Some(at) = self.classes.iter().position(|class| class.mask & bit != 0) else {
                continue;
            };
            let mut value = self.classes[at].value;
            for &(_, number) in &self.order {
                let layer = &layers[number];
                if layer.mask & bit != 0 {
                    value = layer.over(pixel.space, value);
                }
            }
            let class = Class { mask: bit, value, ..self.classes[at] };
            self.classes[at].mask &= !bit;
            self.classes.push(class);
        }
        self.classes.retain(|class| class.mask != 0);
        self.layers = layers;
    }

    /// Puts the layers in order at one sample, from an order at another: few change places.
    fn sort_at(&mut self, pixel: &Pixel<'_>, layers: &[Layer], sample: u32) {
        for place in 0..self.order.len() {
            let number = self.order[place].1;
            let layer = &layers[number];
            let depth = match pixel.draw(layer.fragment).test {
                None => i32::MIN,
                Some(_) => pixel.depth(layer.fragment, sample),
            };
            // Farther, or as far and earlier, comes first.
            let mut to = place;
            while to > 0
                && (self.order[to - 1].0 < depth || (self.order[to - 1].0 == depth && self.order[to - 1].1 > number))
            {
                self.order[to] = self.order[to - 1];
                to -= 1;
            }
            self.order[to] = (depth, number);
        }
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
        // Of two with overlapping ranges the nearest depths say nothing, unless each has one depth, or no sample is
        // shared, or their planes do not meet in the pixel.
        let range = |number: usize| self.known[layers[number].fragment].range.unwrap_or_default();
        let [x, y] = pixel.place;
        let mut tangled = 0;
        // The farthest depth of those that follow: where it is nearer than all of one, that one is in its place. So is
        // it before those whose nearest depth is nearer by more than any of them is deep.
        let (mut farthest, mut deepest) = (i32::MIN, 0);
        for place in (0..order.len()).rev() {
            let far = range(order[place].1);
            if farthest >= far[0] {
                for &(nearest, number) in &order[place + 1..] {
                    if nearest.saturating_add(deepest) < far[0] {
                        break;
                    }
                    let near = range(number);
                    let tied = far[0] == far[1] && near[0] == near[1];
                    let shared = layers[order[place].1].mask & layers[number].mask & !tangled;
                    if near[1] >= far[0] && !tied && shared != 0 {
                        let [far, near] = [order[place].1, number].map(|number| pixel.piece(layers[number].fragment));
                        if pixel.setting.depth == SubpixelDepth::Centre || !far.lies_behind(near, pixel.setting, x, y) {
                            tangled |= shared;
                        }
                    }
                }
            }
            farthest = farthest.max(far[1]);
            deepest = deepest.max(far[1].saturating_sub(far[0]));
        }
        if pixel.setting.depth == SubpixelDepth::Search && tangled != 0 {
            let depths = layers.iter().map(|layer| u64::from((layer.mask & tangled).count_ones()));
            counts.evaluations += depths.sum::<u64>();
        }
        self.order = order;
        tangled
    }

    /// Blends a layer over samples.
    fn blend(&mut self, pixel: &Pixel<'_>, layer: &Layer, mask: u64) {
        for index in 0..self.classes.len() {
            let class = self.classes[index];
            let shared = class.mask & mask;
            if shared == 0 {
                continue;
            }
            self.classes[index].mask = shared;
            self.classes[index].value = layer.over(pixel.space, class.value);
            if shared != class.mask {
                self.classes.push(Class { mask: class.mask & !shared, ..class });
            }
        }
    }
}
