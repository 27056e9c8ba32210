//! Batches: which work has been encoded, sent and executed, so that an access waits for what concerns it and no more.
//!
//! Everything encoded between two flushes is a batch. Batches are numbered from 1 on; each ends with a fence.

use std::collections::VecDeque;
use zga_driver::Fence;

/// Number of a batch; 0 is before all of them.
pub type Batch = u64;

/// The books of what is under way.
#[derive(Debug)]
pub struct Batches {
    /// The batch that is being encoded.
    current: Batch,
    /// Something is encoded in it.
    begun: bool,
    /// Sent, and not known to be executed; rising.
    sent: VecDeque<(Batch, Fence)>,
    /// All batches up to this one are executed.
    done: Batch,
}

impl Default for Batches {
    fn default() -> Self {
        Batches { current: 1, begun: false, sent: VecDeque::new(), done: 0 }
    }
}

impl Batches {
    /// Something is encoded; gives the batch that it is a part of.
    pub fn encoded(&mut self) -> Batch {
        self.begun = true;
        self.current
    }

    /// Something is encoded and not sent.
    #[must_use]
    pub const fn pending(&self) -> bool {
        self.begun
    }

    /// Whether this batch is known to be executed.
    #[must_use]
    pub const fn is_done(&self, batch: Batch) -> bool {
        batch <= self.done
    }

    /// Number of batches sent and not known to be executed.
    #[must_use]
    pub fn under_way(&self) -> usize {
        self.sent.len()
    }

    /// The current batch is sent; it is executed when `fence` is reached.
    pub fn sent(&mut self, fence: Fence) {
        self.sent.push_back((self.current, fence));
        self.current += 1;
        self.begun = false;
    }

    /// The fence to wait for so that `batch` is executed; `None` if it is, or if it has still to be sent.
    #[must_use]
    pub fn fence_of(&self, batch: Batch) -> Option<Fence> {
        self.sent.iter().find(|(number, _)| *number >= batch).filter(|_| !self.is_done(batch)).map(|(_, fence)| *fence)
    }

    /// The batch in the middle of those under way: to wait for it lets half of them go with one sleep.
    #[must_use]
    pub fn middle(&self) -> Option<Batch> {
        self.sent.get(self.sent.len() / 2).map(|(batch, _)| *batch)
    }

    /// FENCE_SEQUENCE shows `now`: the batches up to that fence are executed.
    pub fn seen(&mut self, now: u32) {
        while let Some((batch, fence)) = self.sent.front()
            && now.wrapping_sub(fence.sequence()) < 1 << 31
        {
            self.done = *batch;
            self.sent.pop_front();
        }
    }

    /// Batch `batch` and all before it are executed.
    pub fn executed(&mut self, batch: Batch) {
        self.done = self.done.max(batch);
        while self.sent.front().is_some_and(|(number, _)| *number <= self.done) {
            self.sent.pop_front();
        }
    }

    /// Everything sent is executed, or lost.
    pub fn all_executed(&mut self) {
        self.done = self.current - 1;
        self.sent.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_device::{Card, CardOptions};
    use zga_driver::Driver;

    /// Two batches that are sent.
    fn two() -> Batches {
        let card = Card::power_on(CardOptions::default()).expect("a card");
        let mut driver = Driver::open(card.bus()).expect("a driver");
        let mut batches = Batches::default();
        for _ in 0..2 {
            batches.encoded();
            batches.sent(driver.fence().expect("a fence"));
        }
        batches
    }

    #[test]
    fn encoded_is_pending_until_it_is_sent() {
        let mut batches = Batches::default();
        assert!(!batches.pending());
        assert_eq!(batches.encoded(), 1);
        assert!(batches.pending() && batches.fence_of(1).is_none());
        assert!(batches.is_done(0) && !batches.is_done(1));
    }

    #[test]
    fn executed_takes_all_before_with_it() {
        let mut batches = two();
        assert_eq!((batches.under_way(), batches.middle()), (2, Some(2)));
        assert!(batches.fence_of(1).is_some());
        batches.executed(2);
        assert!(batches.is_done(1) && batches.is_done(2) && batches.fence_of(1).is_none());
        assert_eq!((batches.under_way(), batches.encoded()), (0, 3));
    }

    #[test]
    fn all_executed_leaves_what_is_encoded() {
        let mut batches = two();
        assert_eq!(batches.encoded(), 3);
        batches.all_executed();
        assert!(batches.is_done(2) && !batches.is_done(3) && batches.pending());
    }
}
