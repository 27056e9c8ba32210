//! Pixels that wait for what the colours of their fragments decide: holes, and what is translucent.
//!
//! In a band with layers the active pixels are kept until all of them are known; then it is found out, piece by piece, which
//! fragments are holes, and what colours layers have and what may lie under them. What cannot come to anything is not asked.
//!
//! Inputs from: [`super::finish`]. Outputs to: [`super::pixel`]. Clocks: a texel for each fragment that may be a hole; of
//! colours those that are used, which is known later.

use super::Counts;
use super::brief::Brief;
use super::lists::Fragment;
use super::queue::{Question, Queue};
use super::shader::{Rings, Shader, Source};
use fearless_simd::Level;

/// A pixel that waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    pub(super) x: u16,
    /// Row of the target.
    pub(super) y: u16,
    /// Its first fragment's place, and the first beyond.
    fragments: [u32; 2],
    /// No sample of it is covered twice.
    pub(super) apart: bool,
}

/// What is known of a fragment before its pixel is cut into shares.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Early {
    pub(super) hole: bool,
    /// RGBA, R in 7:0: of what blends, and of what may be seen through that.
    pub(super) colour: Option<u32>,
}

/// The pixels of a band that wait.
#[derive(Debug, Default)]
pub struct Waits {
    /// A piece of the band is a layer: pixels wait.
    pub(super) called: bool,
    pub(super) pixels: Vec<Waiting>,
    /// Their fragments, one after another.
    fragments: Vec<Fragment>,
    /// What is known of each.
    early: Vec<Early>,
    /// Fragments that ask.
    asking: Vec<u32>,
    questions: Queue,
}

impl Waits {
    /// Makes ready for a band.
    pub(super) fn begin(&mut self, briefs: &[Brief]) {
        self.called = briefs.iter().any(|brief| brief.layer);
        self.pixels.clear();
        self.fragments.clear();
        self.early.clear();
    }

    /// Takes a pixel.
    pub(super) fn take(&mut self, list: &[Fragment], [x, y]: [u16; 2], apart: bool) {
        let first = self.fragments.len() as u32;
        self.fragments.extend_from_slice(list);
        self.pixels.push(Waiting { x, y, fragments: [first, first + list.len() as u32], apart });
    }

    /// The fragments of a pixel, and what is known of them.
    pub(super) fn of(&self, pixel: &Waiting) -> (&[Fragment], &[Early]) {
        let range = pixel.fragments[0] as usize..pixel.fragments[1] as usize;
        (&self.fragments[range.clone()], &self.early[range])
    }

    /// Finds out what is a hole, and the colours of layers and of what may lie under them.
    pub(super) fn ask(
        &mut self,
        level: Option<Level>,
        briefs: &[Brief],
        rings: &Rings,
        shader: &mut Shader,
        source: Source<'_>,
        counts: &mut Counts,
    ) {
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
        for &Waiting { x, y, fragments: [from, to], .. } in &self.pixels {
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
