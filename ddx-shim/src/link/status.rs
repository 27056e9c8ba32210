//! Status: what a card counts, and what was called for, as the link carries it.
//!
//! Counters travel with their names, so that both ends need not be of one build.

use zga_abi::{Bus, Counter, Effects, Reg, Units};

use super::message::{take_text, text_words};

/// What a card has counted since its counters were cleared, and what was called since the last begin scene, or since
/// power-on where there was none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Effects that draws called for.
    pub effects: Effects,
    /// Units that were powered.
    pub units: Units,
    /// Names and values, in register order.
    pub counters: Vec<(String, u64)>,
}

impl Status {
    /// Reads it from the registers. Work under way still counts.
    pub(super) fn read(bus: &mut impl Bus) -> Status {
        let mut words = vec![0; 2 * Counter::COUNT];
        bus.read_burst(Reg::Counters.offset(), &mut words);
        let values = words.chunks_exact(2).map(|pair| u64::from(pair[0]) | u64::from(pair[1]) << 32);
        let names = Counter::ALL.iter().map(|counter| counter.name().to_owned());
        Status {
            effects: Effects::from_bits_truncate(bus.read32(Reg::EffectsCalled.offset())),
            units: Units::from_bits_truncate(bus.read32(Reg::UnitsPowered.offset())),
            counters: names.zip(values).collect(),
        }
    }

    /// The value of the counter with this name; `None` if the card has no such counter.
    #[must_use]
    pub fn counter(&self, name: &str) -> Option<u64> {
        self.counters.iter().find(|(known, _)| known == name).map(|(_, value)| *value)
    }

    /// Counters as they rose since `before`; maxima are as they stand now.
    #[must_use]
    pub fn since(&self, before: &Status) -> Status {
        let maxima = |name: &str| Counter::ALL.iter().any(|known| known.name() == name && known.is_maximum());
        let counters = self.counters.iter().map(|(name, value)| {
            let from = if maxima(name) { 0 } else { before.counter(name).unwrap_or(0) };
            (name.clone(), value.saturating_sub(from))
        });
        Status { counters: counters.collect(), ..self.clone() }
    }

    /// As words of a message.
    pub(super) fn words(&self) -> Vec<u32> {
        let mut words = vec![self.effects.bits(), self.units.bits(), self.counters.len() as u32];
        for (name, value) in &self.counters {
            words.extend(text_words(name));
            words.extend([*value as u32, (value >> 32) as u32]);
        }
        words
    }

    /// From words of a message; what is wrong with them otherwise.
    pub(super) fn from_words(mut words: &[u32]) -> Result<Status, String> {
        let [effects, units, count, rest @ ..] = words else {
            return Err(format!("a status of {} words, expected at least 3", words.len()));
        };
        let (effects, units) = (Effects::from_bits_truncate(*effects), Units::from_bits_truncate(*units));
        let count = *count;
        words = rest;
        let mut counters = Vec::new();
        for number in 0..count {
            let name = take_text(&mut words).ok_or_else(|| format!("counter {number} of {count} has no name"))?;
            let [low, high, rest @ ..] = words else {
                return Err(format!("counter {number} of {count}, {name}, has no value"));
            };
            counters.push((name, u64::from(*low) | u64::from(*high) << 32));
            words = rest;
        }
        match words.len() {
            0 => Ok(Status { effects, units, counters }),
            more => Err(format!("{more} words after the last of {count} counters")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Status {
        let counters = vec![("a".to_owned(), 7), ("longer.name".to_owned(), 1 << 40)];
        Status { effects: Effects::DEPTH, units: Units::FRONTEND, counters }
    }

    #[test]
    fn status_comes_back_from_its_words() {
        assert_eq!(Status::from_words(&example().words()), Ok(example()));
    }

    #[test]
    fn status_cut_anywhere_or_too_long_is_refused() {
        let words = example().words();
        for end in 0..words.len() {
            assert!(Status::from_words(&words[..end]).is_err(), "{end} words");
        }
        let longer = [&words[..], &[0]].concat();
        assert_eq!(Status::from_words(&longer), Err("1 words after the last of 2 counters".to_owned()));
    }

    #[test]
    fn since_takes_off_what_was_there_before() {
        let mut later = example();
        later.counters[0].1 = 10;
        assert_eq!(later.since(&example()).counters[0], ("a".to_owned(), 3));
        assert_eq!(later.since(&Status::default()), later);
    }
}
