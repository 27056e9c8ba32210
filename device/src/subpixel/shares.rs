//! Shares of pixels: so many samples of one colour; their mean.
//!
//! Inputs from: [`super::parts`]. Outputs to: [`super::finish`]. Clocks: those of colours ([`super::shader`]).

use super::gamma::Space;
use super::pixel::Pixel;
use super::queue::{Question, Queue};
use super::shader::{Shader, Source};
use super::{Counts, Setting};
use fearless_simd::Level;

/// Shares whose colours are found together: their memory stays in the host's cache.
const TOGETHER: usize = 1 << 13;

/// Samples of one colour.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// RGBA, R in 7:0; where it is asked for the number of the answer.
    value: u32,
    /// Samples.
    weight: u16,
    asked: bool,
}

/// Shares of pixels, and the colours that they wait for.
#[derive(Debug, Default)]
pub struct Shares {
    list: Vec<Share>,
    queue: Queue,
}

impl Shares {
    /// Shares so far.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// It is time to find the colours of those that there are.
    pub(super) fn is_full(&self) -> bool {
        self.list.len() >= TOGETHER
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.queue.clear();
    }

    /// Finds the colours that shares wait for.
    pub(super) fn find(&mut self, level: Option<Level>, shader: &mut Shader, source: Source<'_>, counts: &mut Counts) {
        self.queue.answer(level, Question::Colour, shader, source, Some(counts));
    }

    /// Adds samples of a colour.
    #[inline(always)]
    pub(super) fn plain(&mut self, colour: u32, samples: u64) {
        self.list.push(Share { value: colour, weight: samples.count_ones() as u16, asked: false });
    }

    /// Adds samples of a fragment's colour.
    #[inline(always)]
    pub(super) fn fragment(&mut self, pixel: &Pixel<'_>, fragment: usize, samples: u64, counts: &mut Counts) {
        let brief = pixel.brief(fragment);
        if brief.flat {
            return self.plain(brief.colour, samples);
        }
        if let Some(colour) = pixel.early(fragment).colour {
            counts.shade(pixel.draw(fragment), 1);
            return self.plain(colour, samples);
        }
        let number = self.queue.ask(pixel.rings, &pixel.fragments[fragment], pixel.place);
        self.list.push(Share { value: number, weight: samples.count_ones() as u16, asked: true });
    }

    /// The mean of some shares, which are all of a pixel.
    #[inline(always)]
    pub(super) fn mean(&self, shares: std::ops::Range<usize>, setting: &Setting, space: Space) -> u32 {
        let count = setting.grid.samples();
        let colour = |share: &Share| if share.asked { self.queue.answers[share.value as usize] } else { share.value };
        let shares = &self.list[shares];
        if space.is_of_values() {
            let sum: u64 = shares.iter().map(|share| spread(colour(share)) * u64::from(share.weight)).sum();
            // Half up; the number of samples is a power of two.
            return gathered((sum + u64::from(count / 2) * 0x0001_0001_0001_0001) >> count.ilog2());
        }
        let first = shares.first().map_or(0, colour);
        if shares.iter().all(|share| colour(share) == first) {
            return first;
        }
        let mut sum = [0.0; 4];
        for share in shares {
            let there = space.of(colour(share));
            sum = [0, 1, 2, 3].map(|c| sum[c] + f64::from(share.weight) * there[c]);
        }
        space.colour(sum.map(|c| c / f64::from(count)))
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
