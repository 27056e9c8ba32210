//! From the fragments that are left in a band's active pixels to the pixels' colours.
//!
//! A pixel is *taken up*, and cut into *shares* ([`super::pixel`]): so many samples of one colour. The colours of
//! fragments are only asked for there, and found piece by piece when some pixels have their shares ([`super::shader`]);
//! the mean of a pixel's shares is its colour. In a band with layers all pixels are taken up first: what a fragment's
//! colour decides (it is a hole, or a layer's) is found for all of them before any is cut.
//!
//! Inputs from: [`super::band`], [`super::specification`]. Outputs to: [`super::unit`]. Clocks: an active pixel costs one.

use super::band::{Input, Resolved, Work};
use super::brief::Brief;
use super::gamma::Space;
use super::lists::Fragment;
use super::map::Reason;
use super::pixel::Pixel;
use super::shader::{Question, Queue, Rings, Shader, Source};
use super::{Counts, Setting};
use fearless_simd::Level;

/// Shares whose colours are found together: their memory stays in the host's cache.
const TOGETHER: usize = 1 << 13;

/// Samples of one colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    /// RGBA, R in 7:0; where it is asked for the number of the answer.
    value: u32,
    /// Samples.
    weight: u16,
    asked: bool,
}

/// A pixel that is active, and cut into shares.
#[derive(Clone, Copy, Debug)]
struct Active {
    x: u16,
    /// Row of the target.
    y: u16,
    /// The first share beyond its own.
    shares: u32,
    reason: Reason,
}

/// One that waits for what its fragments' colours decide.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    x: u16,
    y: u16,
    /// Its first fragment's place, and the first beyond.
    fragments: [u32; 2],
    /// No sample of it is covered twice.
    apart: bool,
}

/// What is known of a fragment before its pixel is cut into shares.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Early {
    pub(super) hole: bool,
    /// RGBA, R in 7:0: of what blends, and of what may be seen through that.
    pub(super) colour: Option<u32>,
}

/// Memory of one thread for the pixels of a band.
#[derive(Debug, Default)]
pub struct Pixels {
    active: Vec<Active>,
    shares: Shares,
    /// A piece of the band is a layer, and pixels wait.
    wait: bool,
    waiting: Vec<Waiting>,
    /// The fragments of those that wait, one after another.
    fragments: Vec<Fragment>,
    /// What is known of each beforehand.
    early: Vec<Early>,
    /// Fragments that ask early.
    asking: Vec<u32>,
    questions: Queue,
}

/// Shares of pixels, and the colours that they wait for.
#[derive(Debug, Default)]
pub(super) struct Shares {
    list: Vec<Share>,
    queue: Queue,
}

impl Shares {
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
    fn mean(&self, shares: std::ops::Range<usize>, setting: &Setting, space: Space) -> u32 {
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

impl Work {
    /// Makes ready for the active pixels of a band whose pieces are set up.
    pub(super) fn open_pixels(&mut self, input: &Input<'_>) {
        self.shader.begin(self.pieces.len());
        self.rings.begin(input.setting.grid);
        let draws = &input.scene.draws;
        self.briefs.clear();
        self.briefs.extend(self.pieces.iter().map(|piece| Brief::new(piece, &draws[piece.draw as usize])));
        self.pixels.wait = self.briefs.iter().any(|brief| brief.layer);
        self.pixels.waiting.clear();
        self.pixels.fragments.clear();
    }

    /// Takes up the pixel in column `x` of line `line`, with what is left there in order of submission; `apart` if no
    /// sample is covered twice.
    #[inline(always)]
    pub(super) fn take_up(
        &mut self,
        input: &Input<'_>,
        list: &[Fragment],
        [x, line]: [usize; 2],
        apart: bool,
        out: &mut Vec<Resolved>,
        counts: &mut Counts,
    ) {
        let full = input.setting.grid.full();
        counts.masks += list.iter().filter(|fragment| fragment.mask != full).count() as u64;
        let (x, y) = (x as u16, input.top as u16 + line as u16);
        if self.used[line] + list.len() > input.setting.pool as usize {
            counts.degraded += 1;
            out.push(Resolved { x, y, colour: 0, reason: Reason::Degraded });
            return;
        }
        self.used[line] += list.len();
        if self.pixels.wait {
            let first = self.pixels.fragments.len() as u32;
            self.pixels.fragments.extend_from_slice(list);
            let fragments = [first, first + list.len() as u32];
            self.pixels.waiting.push(Waiting { x, y, fragments, apart });
            return;
        }
        self.cut(input, list, &[], [x, y], apart, counts);
        if self.pixels.shares.list.len() >= TOGETHER {
            self.flush(input, out, counts);
        }
    }

    /// Resolves the pixels that were taken up and not yet resolved.
    pub(super) fn close_pixels(
        &mut self,
        input: &Input<'_>,
        out: &mut Vec<Resolved>,
        counts: &mut Counts,
    ) {
        if self.pixels.wait {
            let source = Source { pieces: &self.pieces, draws: &input.scene.draws };
            self.pixels.ask_early(self.level, &self.briefs, &self.rings, &mut self.shader, source, counts);
            let waiting = std::mem::take(&mut self.pixels.waiting);
            let fragments = std::mem::take(&mut self.pixels.fragments);
            let early = std::mem::take(&mut self.pixels.early);
            for &Waiting { x, y, fragments: [from, to], apart } in &waiting {
                let range = from as usize..to as usize;
                self.cut(input, &fragments[range.clone()], &early[range], [x, y], apart, counts);
                if self.pixels.shares.list.len() >= TOGETHER {
                    self.flush(input, out, counts);
                }
            }
            (self.pixels.waiting, self.pixels.fragments, self.pixels.early) = (waiting, fragments, early);
        }
        self.flush(input, out, counts);
    }

    /// Cuts a pixel into shares.
    #[inline(always)]
    fn cut(
        &mut self,
        input: &Input<'_>,
        fragments: &[Fragment],
        early: &[Early],
        [x, y]: [u16; 2],
        apart: bool,
        counts: &mut Counts,
    ) {
        let (setting, scene) = (input.setting, input.scene);
        let at = usize::from(y) * setting.size[0] as usize + usize::from(x);
        let pixel = Pixel {
            setting,
            level: self.level,
            space: Space::new(setting.resolve),
            source: Source { pieces: &self.pieces, draws: &scene.draws },
            briefs: &self.briefs,
            rings: &self.rings,
            early,
            fragments,
            place: [x, y].map(i32::from),
            base: (scene.colour.at(at), scene.depth.at(at)),
        };
        counts.active += 1;
        let reason = self.resolver.resolve(&pixel, apart, &mut self.pixels.shares, counts);
        self.pixels.active.push(Active { x, y, shares: self.pixels.shares.list.len() as u32, reason });
    }

    /// Finds the colours that shares wait for, and the means of the pixels that were cut.
    fn flush(&mut self, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        let source = Source { pieces: &self.pieces, draws: &input.scene.draws };
        let Pixels { active, shares, .. } = &mut self.pixels;
        shares.queue.answer(self.level, Question::Colour, &mut self.shader, source, Some(counts));
        let space = Space::new(input.setting.resolve);
        let mut first = 0;
        for &Active { x, y, shares: beyond, reason } in &*active {
            let colour = shares.mean(first..beyond as usize, input.setting, space);
            first = beyond as usize;
            out.push(Resolved { x, y, colour, reason });
        }
        active.clear();
        shares.list.clear();
        shares.queue.clear();
    }
}

impl Pixels {
    /// Finds out what is a hole, and the colours of layers and of what may lie under them.
    fn ask_early(
        &mut self,
        level: Option<Level>,
        briefs: &[Brief],
        rings: &Rings,
        shader: &mut Shader,
        source: Source<'_>,
        counts: &mut Counts,
    ) {
        self.early.clear();
        self.early.resize(self.fragments.len(), Early::default());
        if briefs.iter().any(|brief| brief.holes) {
            self.ask_of(briefs, rings, |brief, _| brief.holes);
            self.questions.answer(level, Question::Hole, shader, source, Some(counts));
            for (&number, &answer) in self.asking.iter().zip(&self.questions.answers) {
                self.early[number as usize].hole = answer != 0;
            }
        }
        if briefs.iter().any(|brief| brief.layer && brief.blend) {
            self.ask_of(briefs, rings, |_, layers| layers);
            // Which of them are used is known later.
            self.questions.answer(level, Question::Colour, shader, source, None);
            for (&number, &answer) in self.asking.iter().zip(&self.questions.answers) {
                self.early[number as usize].colour = Some(answer);
            }
        }
    }

    /// Asks for those fragments that `asks` says, by their pieces and whether there are layers in their pixel.
    fn ask_of(&mut self, briefs: &[Brief], rings: &Rings, asks: impl Fn(&Brief, bool) -> bool) {
        self.questions.clear();
        self.asking.clear();
        for &Waiting { x, y, fragments: [from, to], .. } in &self.waiting {
            let range = from as usize..to as usize;
            let fragments = &self.fragments[range.clone()];
            let brief = |fragment: &Fragment| &briefs[fragment.piece as usize];
            let layers = fragments.iter().map(brief).any(|brief| brief.layer && brief.blend);
            for ((number, fragment), early) in (from..).zip(fragments).zip(&mut self.early[range]) {
                let brief = brief(fragment);
                // One at the centre alone has no sample: it is not seen.
                if brief.clear || fragment.mask == 0 || early.hole || !asks(brief, layers) {
                    continue;
                }
                if brief.flat {
                    early.colour = Some(brief.colour);
                    continue;
                }
                self.questions.ask(rings, fragment, [x, y].map(i32::from));
                self.asking.push(number);
            }
        }
    }
}
