//! Counters and cycle accounts of a card.
//!
//! Every unit adds its events here; the COUNTERS registers show them. Time is [`Clocks`], never a
//! bare number.

use zga_abi::Counter;

/// Device time in clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Clocks(pub u64);

/// All counters of a card. Saturating, so no count ever wraps to something plausible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Account {
    values: [u64; Counter::COUNT],
}

impl Default for Account {
    fn default() -> Self {
        Account { values: [0; Counter::COUNT] }
    }
}

impl Account {
    /// Value of a counter; `cycles.total` is the sum of the units' accounts.
    #[must_use]
    pub fn get(&self, counter: Counter) -> u64 {
        self.values[counter as usize]
    }

    /// Adds `events` to a counter.
    pub fn add(&mut self, counter: Counter, events: u64) {
        let value = &mut self.values[counter as usize];
        *value = value.saturating_add(events);
    }

    /// Raises a counter to `value`, for those that hold the largest of their events.
    pub fn maximum(&mut self, counter: Counter, value: u64) {
        let largest = &mut self.values[counter as usize];
        *largest = value.max(*largest);
    }

    /// Takes in what another account has counted since: sums are added, maxima raised.
    pub fn merge(&mut self, other: &Account) {
        for (&counter, &events) in Counter::ALL.iter().zip(&other.values) {
            if counter.is_maximum() {
                self.maximum(counter, events);
            } else {
                self.add(counter, events);
            }
        }
    }

    /// Charges `clocks` to a unit's cycle account and to the total: units do not overlap on this card.
    pub fn charge(&mut self, unit: Counter, clocks: Clocks) {
        self.add(unit, clocks.0);
        self.add(Counter::CyclesTotal, clocks.0);
    }

    /// Device time since the counters were cleared.
    #[must_use]
    pub fn total(&self) -> Clocks {
        Clocks(self.get(Counter::CyclesTotal))
    }

    /// Sets every counter to 0.
    pub fn clear(&mut self) {
        self.values = [0; Counter::COUNT];
    }

    /// All values, in register order.
    #[must_use]
    pub fn values(&self) -> &[u64; Counter::COUNT] {
        &self.values
    }

    /// Sets all values, in register order.
    pub fn set_values(&mut self, values: [u64; Counter::COUNT]) {
        self.values = values;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merge_adds_sums_and_raises_maxima() {
        let (mut shown, mut counted) = (Account::default(), Account::default());
        for (fragments, bytes) in [(3, 48), (5, 80), (2, 32)] {
            counted.add(Counter::SubpixelFragments, fragments);
            counted.maximum(Counter::SubpixelPoolPeakBytes, bytes);
            shown.merge(&counted);
            counted.clear();
        }
        assert_eq!(shown.get(Counter::SubpixelFragments), 10);
        assert_eq!(shown.get(Counter::SubpixelPoolPeakBytes), 80);
    }
}
