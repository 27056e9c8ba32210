//! A session: one card, the actions done to it, and what is noticed on the way.

use super::action::{Action, reaches};
use super::coverage::Coverage;
use std::time::{Duration, Instant};
use xxhash_rust::xxh3::xxh3_64;
use zga_abi::bus::{FIFO_BASE, MEMORY_BASE};
use zga_abi::{Bus, Reg};
use zga_device::{Card, CardBus, Monitor, Snapshot};

/// Bit 0 of STATUS.
const BUSY: u32 = 1;
/// Where the card's section stands in a snapshot: checksum, tag, length, content.
const SECTION: usize = 12;
/// Bytes of a section before its content.
const SECTION_HEAD: usize = 16;

/// Why a card's final state can depend on more than the actions.
///
/// Two cards are compared only if nothing of this was touched:
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timing {
    /// The host did not wait for the card between actions.
    pub race: bool,
    /// Vertical blanks came by the clock (SCANOUT_CONTROL).
    pub clock: bool,
    /// The watchdog stopped a draw: how far it came depends on how kernel and threads cut it into batches.
    pub watchdog: bool,
    /// A draw of many primitives: the same, if its vertices lie in its own target.
    pub batches: bool,
    /// The host lost patience and reset the card.
    pub impatient: bool,
}

impl Timing {
    /// Nothing was touched: the state is a function of the actions.
    #[must_use]
    pub fn is_exact(self) -> bool {
        self == Timing::default()
    }
}

/// Actions on a card, one by one.
#[derive(Debug)]
pub struct Session<'a> {
    card: &'a Card,
    bus: CardBus,
    lock_step: bool,
    patience: Duration,
    /// The snapshot that was kept, and whether its counters hold what the card has done.
    saved: Option<(Snapshot, bool)>,
    monitor: Option<Monitor>,
    /// FIFO words since the last reset; `None` after a restore, when nobody knows what stood before.
    stream: Option<Vec<u32>>,
    /// The counters hold what the card has done, not what a changed snapshot says.
    counted: bool,
    coverage: Coverage,
    timing: Timing,
}

impl<'a> Session<'a> {
    /// A session with a new card. Draws are stopped after a few million clocks until the actions say
    /// otherwise.
    #[must_use]
    pub fn new(card: &'a Card, lock_step: bool, patience: Duration) -> Session<'a> {
        let mut bus = card.bus();
        bus.write32(Reg::Watchdog.offset(), 8);
        let timing = Timing { race: !lock_step, ..Timing::default() };
        let stream = Some(Vec::new());
        let coverage = Coverage::default();
        Session { card, bus, lock_step, patience, saved: None, monitor: None, stream, counted: true, coverage, timing }
    }

    /// Does one action.
    pub fn act(&mut self, action: &Action) {
        match action {
            Action::Read { address, words } => {
                let mut read = vec![0; *words as usize];
                match read.as_mut_slice() {
                    [word] => *word = self.bus.read32(*address),
                    words => self.bus.read_burst(*address, words),
                }
            }
            Action::Write { address, words } => self.write(*address, words),
            Action::Fifo(words) => {
                if let Some(stream) = &mut self.stream {
                    stream.extend(words);
                }
                self.bus.write_burst(FIFO_BASE, words);
            }
            Action::Ring { start, words, put, doorbell } => self.ring(*start, words, *put, *doorbell),
            Action::Reset => self.write(Reg::Reset.offset(), &[1]),
            Action::Save => self.saved = self.card.snapshot().ok().map(|saved| (saved, self.counted)),
            Action::Restore { changes, sealed } => self.restore(changes, *sealed),
            Action::Wait { mask, microseconds } => {
                let _ = self.bus.wait_interrupt(*mask, Duration::from_micros(u64::from(*microseconds)));
            }
            Action::Monitor(plugged) => self.monitor = plugged.then(|| self.card.monitor()),
            Action::Settle => self.settle(),
        }
        if self.lock_step {
            self.settle();
        }
    }

    /// The end: what was noticed, and the state the card is in.
    #[must_use]
    pub fn finish(mut self) -> (Coverage, Timing, Option<Snapshot>) {
        self.settle();
        self.take_stock();
        let state = if self.timing.is_exact() { self.card.snapshot().ok() } else { None };
        (self.coverage, self.timing, state)
    }

    fn write(&mut self, address: u32, words: &[u32]) {
        let place = (Reg::Reset.offset().wrapping_sub(address) / 4) as usize;
        let resets = reaches(address, words.len(), Reg::Reset) && words.get(place).is_some_and(|word| word & 1 != 0);
        if resets && self.lock_step {
            self.take_stock();
        }
        if (FIFO_BASE..FIFO_BASE + 0x1000).contains(&address) && address.is_multiple_of(4) {
            return self.act(&Action::Fifo(words.to_vec()));
        }
        match words {
            [word] => self.bus.write32(address, *word),
            words => self.bus.write_burst(address, words),
        }
        if resets {
            self.stream = Some(Vec::new());
            self.counted = true;
        }
        // Packets that wait for a doorbell keep the card busy: in lock-step each gets one.
        let put = reaches(address, words.len(), Reg::RingPut);
        if self.lock_step && put && !reaches(address, words.len(), Reg::Doorbell) {
            self.bus.write32(Reg::Doorbell.offset(), 1);
        }
    }

    fn ring(&mut self, start: Option<[u32; 2]>, words: &[u32], put: Option<u32>, doorbell: bool) {
        if let Some([base, size]) = start {
            self.bus.write32(Reg::RingBase.offset(), base);
            self.bus.write32(Reg::RingSize.offset(), size);
        }
        let [base, size, at] = [Reg::RingBase, Reg::RingSize, Reg::RingPut].map(|reg| self.bus.read32(reg.offset()));
        let (size, at) = (size.max(1), at % size.max(1));
        let before_end = words.len().min((size - at) as usize);
        let (first, rest) = words.split_at(before_end);
        let memory = MEMORY_BASE.wrapping_add(base);
        self.bus.write_burst(memory.wrapping_add(at.wrapping_mul(4)), first);
        self.bus.write_burst(memory, rest);
        let end = (at + words.len() as u32) % size;
        self.bus.write32(Reg::RingPut.offset(), put.unwrap_or(end));
        if doorbell || self.lock_step {
            self.bus.write32(Reg::Doorbell.offset(), 1);
        }
        if self.lock_step && put.is_none() {
            self.settle();
            let done = self.bus.read32(Reg::RingGet.offset()).wrapping_sub(at) % size;
            self.timing.batches |= self.coverage.stream(words, done as usize);
        }
    }

    fn restore(&mut self, changes: &[(u32, u32)], sealed: bool) {
        let Some((saved, counted)) = self.saved.clone() else { return };
        if self.lock_step {
            self.take_stock();
        }
        let restored = if changes.is_empty() {
            self.card.restore(&saved)
        } else {
            let bytes = changed(saved.to_bytes(), changes, sealed);
            Snapshot::from_bytes(&bytes).and_then(|snapshot| self.card.restore(&snapshot))
        };
        match restored {
            Ok(()) => {
                self.coverage.restores += 1;
                self.stream = None;
                self.counted = counted && changes.is_empty();
                if self.lock_step {
                    self.bus.write32(Reg::Doorbell.offset(), 1);
                }
            }
            Err(_) => self.coverage.restores_refused += 1,
        }
    }

    /// Waits until the card has nothing to do; resets it if it does not come to an end.
    fn settle(&mut self) {
        let begun = Instant::now();
        let mut looks = 0_u32;
        while self.bus.read32(Reg::Status.offset()) & BUSY != 0 {
            looks += 1;
            if looks < 200 {
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
            // Packets that nobody rang for keep it busy for ever: no fault of the card.
            let waits =
                || self.bus.clone().read32(Reg::RingGet.offset()) != self.bus.clone().read32(Reg::RingPut.offset());
            if looks > 2000 && !self.lock_step && waits() {
                break;
            }
            if begun.elapsed() > self.patience {
                self.timing.impatient = true;
                self.bus.write32(Reg::Reset.offset(), 1);
                self.stream = Some(Vec::new());
                break;
            }
        }
        if self.lock_step {
            self.timing.clock |= self.bus.read32(Reg::ScanoutControl.offset()) & 1 != 0;
        }
    }

    /// What the packets since the last reset came to, as far as registers and counters tell.
    fn take_stock(&mut self) {
        let [status, code, source, offset] =
            [Reg::Status, Reg::ErrorCode, Reg::ErrorSource, Reg::ErrorOffset].map(|reg| self.bus.read32(reg.offset()));
        if status != u32::MAX {
            self.coverage.fault(code);
            if self.counted {
                self.coverage.add_counters(&mut self.bus);
            }
        }
        self.timing.watchdog |= code == zga_abi::FaultCode::Watchdog as u32;
        if let Some(stream) = self.stream.take() {
            let halted = status & 4 != 0;
            let done = match (halted, source) {
                (false, _) => stream.len(),
                (true, 2) => offset as usize,
                // The ring failed first; how far the FIFO came is not told.
                (true, _) => 0,
            };
            self.timing.batches |= self.coverage.stream(&stream, done.min(stream.len()));
        }
        self.timing.clock |= self.coverage.clock;
    }
}

/// A snapshot's bytes with words of the card's section changed: word and value; `sealed` makes the
/// checksum agree.
#[must_use]
pub fn changed(mut bytes: Vec<u8>, changes: &[(u32, u32)], sealed: bool) -> Vec<u8> {
    let content = SECTION + SECTION_HEAD;
    let length =
        bytes.get(content - 4..content).map_or(0, |b| b.iter().rev().fold(0, |n, &b| (n << 8) | usize::from(b)));
    for &(word, value) in changes {
        let at = content + (4 * word as usize) % length.max(4);
        if let Some(place) = bytes.get_mut(at..at + 4) {
            place.copy_from_slice(&value.to_le_bytes());
        }
    }
    if sealed && let Some(section) = bytes.get(SECTION + 8..content + length) {
        let sum = xxh3_64(section).to_le_bytes();
        bytes[SECTION..SECTION + 8].copy_from_slice(&sum);
    }
    bytes
}
