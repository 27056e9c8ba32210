//! What is asked at places in pixels, and found piece by piece, 16 places at a time: the fragments of a piece share its
//! planes, wherever they lie.
//!
//! Inputs from: [`super::shares`], [`super::waiting`]. Outputs to: the same. Clocks: those of colours ([`super::shader`]).

use super::Counts;
use super::lists::Fragment;
use super::shader::{Rings, Shader, Source};
use crate::hidden::z_buffer::kernel::LANES;
use crate::shading::scattered::{Places, centre_of};
use fearless_simd::Level;

/// A place at which a piece is asked for something.
#[derive(Clone, Copy, Debug)]
struct Asked {
    /// Twice the number of the piece, and 1 if the place is a pixel's centre.
    key: u32,
    /// u.
    place: [i32; 2],
}

/// What is asked for at places, and the answers in the same order.
#[derive(Debug, Default)]
pub(super) struct Queue {
    asked: Vec<Asked>,
    /// Colours; or 1 where there is a hole, else 0.
    pub(super) answers: Vec<u32>,
    /// Numbers of what is asked, piece by piece.
    order: Vec<u32>,
    /// Where those of each key begin.
    starts: Vec<u32>,
}

/// What a queue asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Question {
    /// Colours.
    Colour,
    /// Whether there is a hole.
    Hole,
}

impl Queue {
    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.asked.clear();
        self.answers.clear();
    }

    /// Asks for a fragment's place in pixel (`x`, `y`); returns the number of the answer.
    #[inline(always)]
    pub(super) fn ask(&mut self, rings: &Rings, fragment: &Fragment, [x, y]: [i32; 2]) -> u32 {
        let (key, place) = match rings.place_of(fragment.mask, [x, y]) {
            None => (2 * fragment.piece + 1, centre_of(x, y)),
            Some(place) => (2 * fragment.piece, place),
        };
        self.asked.push(Asked { key, place });
        self.asked.len() as u32 - 1
    }

    /// Puts the numbers of what is asked in order of their pieces.
    fn sort(&mut self, pieces: usize) {
        self.starts.clear();
        self.starts.resize(2 * pieces + 1, 0);
        for asked in &self.asked {
            self.starts[asked.key as usize + 1] += 1;
        }
        for key in 1..self.starts.len() {
            self.starts[key] += self.starts[key - 1];
        }
        self.order.resize(self.asked.len(), 0);
        for (number, asked) in (0..).zip(&self.asked) {
            let start = &mut self.starts[asked.key as usize];
            self.order[*start as usize] = number;
            *start += 1;
        }
    }

    /// Answers everything; the events of that go to `counts`.
    pub(super) fn answer(
        &mut self,
        level: Option<Level>,
        question: Question,
        shader: &mut Shader,
        source: Source<'_>,
        mut counts: Option<&mut Counts>,
    ) {
        self.answers.resize(self.asked.len(), 0);
        self.sort(source.pieces.len());
        let order = std::mem::take(&mut self.order);
        for group in order.chunk_by(|&a, &b| self.asked[a as usize].key == self.asked[b as usize].key) {
            let key = self.asked[group[0] as usize].key;
            let (piece, at_centre) = (key / 2, key % 2 == 1);
            let mut found = 0;
            for numbers in group.chunks(LANES) {
                // Lanes beyond the last repeat the first.
                let [x, y] = self.asked[numbers[0] as usize].place;
                let mut at: Places = [[x; LANES], [y; LANES]];
                for (lane, &number) in numbers.iter().enumerate() {
                    [at[0][lane], at[1][lane]] = self.asked[number as usize].place;
                }
                let wanted = u16::MAX >> (LANES - numbers.len());
                let answers = match question {
                    Question::Colour => shader.colours(level, source, piece, at_centre, &at, wanted),
                    Question::Hole => shader.holes(level, source, piece, &at, wanted),
                };
                for (number, answer) in numbers.iter().zip(answers) {
                    self.answers[*number as usize] = answer;
                    found += u64::from(answer);
                }
            }
            let Some(counts) = &mut counts else {
                continue;
            };
            match (question, &source.draw(piece).shading) {
                (Question::Colour, _) => counts.shade(source.draw(piece), group.len() as u64),
                (Question::Hole, None) => {}
                (Question::Hole, Some(shading)) => {
                    counts.shading = counts.shading.plus(shading.pixel.looked_up(group.len() as u64, found));
                }
            }
        }
        self.order = order;
    }
}
