//! What an effect more or less would cost: the scene as it is and the changed scene, each on a card of its own, in turn.
//!
//! Clocks are counted, so one frame tells them. Host times are measured in pairs, a frame of one and a frame of the
//! other, so that what else the machine does meets both; differences and ratios are medians over the pairs.

use zga_abi::{Counter, Effects};

use crate::error::Result;
use crate::play::{Asked, Change, Look, Session};
use crate::scene::Scene;

/// A pair that takes longer, in milliseconds, is not measured again.
const LONG_MS: f64 = 4000.0;

/// A quantity of the scene as it is and of the changed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// As it is.
    pub before: f64,
    /// Changed.
    pub after: f64,
    /// After less before.
    pub difference: f64,
    /// After over before.
    pub ratio: f64,
}

/// What a change costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Price {
    /// The change.
    pub change: Change,
    /// Effects that the changed scene's draws called.
    pub called: Effects,
    /// Clocks of the card, all units.
    pub clocks: Compared,
    /// Host time, milliseconds: medians over the pairs.
    pub host_ms: Compared,
    /// Pairs measured.
    pub pairs: usize,
    /// Nothing came of it: an effect that was to go is still called, one that was to come is not.
    pub without_effect: bool,
}

/// The changed scene beside the scene as it is.
#[derive(Debug)]
pub struct WhatIf<'a> {
    /// Name of the scene, for messages.
    pub name: &'a str,
    /// The scene as it is.
    pub scene: &'a Scene,
    /// What is asked of the card for it.
    pub asked: &'a Asked,
    /// How it is looked at.
    pub look: Look,
    /// Pairs of frames, at least 1.
    pub pairs: u32,
}

impl WhatIf<'_> {
    /// Measures a change against the scene as it is, which `session` draws.
    ///
    /// # Errors
    /// [`crate::Error::Driver`], [`crate::Error::Card`], [`crate::Error::Unsupported`].
    pub fn price(&self, session: &mut Session, change: Change) -> Result<Price> {
        let look = Look { change: Some(change), ..self.look };
        let scene = look.scene(self.scene).into_owned();
        let mut asked = self.asked.clone();
        asked.card.antialias = change.grid().or(asked.card.antialias);
        let mut changed = Session::open(self.name, &scene, &asked)?;
        // Both frame buffers, and on the host caches and threads, are as they will be.
        for _ in 0..2 {
            session.frame(self.scene, self.look)?;
            changed.frame(&scene, look)?;
        }
        let mut times = Vec::new();
        let (before, after) = loop {
            let (_, before) = session.frame(self.scene, self.look)?;
            let (_, after) = changed.frame(&scene, look)?;
            let pair = [before.host_ms(), after.host_ms()];
            times.push(pair);
            if times.len() >= self.pairs as usize || pair[0] + pair[1] > LONG_MS {
                break (before, after);
            }
        };
        let [clocks_before, clocks_after] =
            [&before, &after].map(|cost| cost.counters.get(Counter::CyclesTotal) as f64);
        let middle = |of: &dyn Fn(&[f64; 2]) -> f64| median(times.iter().map(of).collect());
        let removed = matches!(change, Change::Without(_));
        Ok(Price {
            change,
            called: after.called,
            clocks: Compared {
                before: clocks_before,
                after: clocks_after,
                difference: clocks_after - clocks_before,
                ratio: ratio(clocks_after, clocks_before),
            },
            host_ms: Compared {
                before: middle(&|pair| pair[0]),
                after: middle(&|pair| pair[1]),
                difference: middle(&|pair| pair[1] - pair[0]),
                ratio: middle(&|pair| ratio(pair[1], pair[0])),
            },
            pairs: times.len(),
            without_effect: after.called.contains(change.effect()) == removed,
        })
    }
}

/// One over the other; 1 where there is nothing to compare with.
fn ratio(after: f64, before: f64) -> f64 {
    if before > 0.0 { after / before } else { 1.0 }
}

/// The middle of a list; of an even number of values, the upper one of the two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demos;
    use crate::scene::{CardSettings, SubpixelGrid};

    #[test]
    fn median_of_odd_and_even_lists() {
        assert_eq!(
            [median(vec![3.0, 1.0, 2.0]), median(vec![4.0, 1.0, 3.0, 2.0]), median(Vec::new())],
            [2.0, 3.0, 0.0]
        );
    }

    #[test]
    fn price_of_samples_is_above_and_of_no_colours_below_nothing() {
        let mut scene = demos::find("teapot").expect("a demo").build(0);
        scene.size = [120, 90];
        let asked = Asked { threads: 1, ..Asked::default() };
        let mut session = Session::open("teapot", &scene, &asked).expect("a card");
        let what_if = WhatIf { name: "teapot", scene: &scene, asked: &asked, look: Look::default(), pairs: 2 };
        let mut price = |change| what_if.price(&mut session, change).expect("drawn");
        let samples = price(Change::Antialias(SubpixelGrid::Grid4x4));
        assert!(samples.clocks.difference > 0.0 && samples.clocks.ratio > 1.0 && !samples.without_effect);
        assert!(samples.called.contains(Effects::ANTI_ALIAS) && samples.pairs == 2 && samples.host_ms.after > 0.0);
        let flat = price(Change::Without(Effects::GOURAUD));
        assert!(flat.clocks.difference < 0.0 && !flat.called.contains(Effects::GOURAUD) && !flat.without_effect);
        // What the scene does not call cannot be dropped from it.
        let none = price(Change::Without(Effects::TEXTURE));
        assert_eq!((none.clocks.difference, none.without_effect), (0.0, false));
        let card = CardSettings { antialias: Some(SubpixelGrid::Grid4x4), ..CardSettings::default() };
        let asked = Asked { card, ..asked };
        let mut session = Session::open("teapot", &scene, &asked).expect("a card");
        let what_if = WhatIf { asked: &asked, ..what_if };
        let off = what_if.price(&mut session, Change::Without(Effects::ANTI_ALIAS)).expect("drawn");
        assert_eq!(off.clocks.difference, -samples.clocks.difference);
    }
}
