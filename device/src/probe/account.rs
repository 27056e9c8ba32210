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
