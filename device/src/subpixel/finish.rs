//! From the fragments that are left in a band's active pixels to the pixels' colours.
//!
//! A pixel is *taken up*, and cut into *shares* ([`super::pixel`]): so many samples of one colour. The colours of
//! fragments are only asked for there, and found piece by piece when some pixels have their shares ([`super::shader`]);
//! the mean of a pixel's shares is its colour. In a band with layers all pixels wait before they are cut
//! ([`super::waiting`]).
//!
//! Inputs from: [`super::band`], [`super::specification`]. Outputs to: [`super::unit`]. Clocks: an active pixel costs one.

use super::Counts;
use super::band::{Input, Resolved, Work};
use super::brief::Brief;
use super::gamma::Space;
use super::lists::Fragment;
use super::map::Reason;
use super::pixel::Pixel;
use super::shader::Source;
use super::shares::Shares;
use super::waiting::{Early, Waiting, Waits};

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

/// Memory of one thread for the pixels of a band.
#[derive(Debug, Default)]
pub struct Pixels {
    active: Vec<Active>,
    shares: Shares,
    waits: Waits,
}

impl Work {
    /// Makes ready for the active pixels of a band whose pieces are set up.
    pub(super) fn open_pixels(&mut self, input: &Input<'_>) {
        self.shader.begin(self.pieces.len());
        self.rings.begin(input.setting.grid);
        let draws = &input.scene.draws;
        self.briefs.clear();
        self.briefs.extend(self.pieces.iter().map(|piece| Brief::new(piece, &draws[piece.draw as usize])));
        self.pixels.waits.begin(&self.briefs);
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
        if self.pixels.waits.called {
            return self.pixels.waits.take(list, [x, y], apart);
        }
        self.cut(input, list, &[], [x, y], apart, counts);
        if self.pixels.shares.is_full() {
            self.flush(input, out, counts);
        }
    }

    /// Resolves the pixels that were taken up and not yet resolved.
    pub(super) fn close_pixels(&mut self, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        if self.pixels.waits.called {
            let mut waits = std::mem::take(&mut self.pixels.waits);
            let source = Source { pieces: &self.pieces, draws: &input.scene.draws };
            waits.ask(self.level, &self.briefs, &self.rings, &mut self.shader, source, counts);
            for pixel in &waits.pixels {
                let (&Waiting { x, y, apart, .. }, (fragments, early)) = (pixel, waits.of(pixel));
                self.cut(input, fragments, early, [x, y], apart, counts);
                if self.pixels.shares.is_full() {
                    self.flush(input, out, counts);
                }
            }
            self.pixels.waits = waits;
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
        self.pixels.active.push(Active { x, y, shares: self.pixels.shares.len() as u32, reason });
    }

    /// Finds the colours that shares wait for, and the means of the pixels that were cut.
    fn flush(&mut self, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
        let source = Source { pieces: &self.pieces, draws: &input.scene.draws };
        let Pixels { active, shares, .. } = &mut self.pixels;
        shares.find(self.level, &mut self.shader, source, counts);
        let space = Space::new(input.setting.resolve);
        let mut first = 0;
        for &Active { x, y, shares: beyond, reason } in &*active {
            let colour = shares.mean(first..beyond as usize, input.setting, space);
            first = beyond as usize;
            out.push(Resolved { x, y, colour, reason });
        }
        active.clear();
        shares.clear();
    }
}
