//! Fuzzing over the whole bus: bytes become actions, actions go to a card, the card must survive.
//!
//! [`run`] is all that a fuzzer, a random test or a soak needs. It powers a card on, does what the
//! bytes stand for, and then asks whether the card is still a card ([`mod@reference`]): it identifies
//! itself, it resets, and a known scene gives the known picture.
//!
//! | module | part |
//! | --- | --- |
//! | [`bytes`] | bytes as a source of choices |
//! | [`action`] | what a host can do to a card; bytes to actions |
//! | [`packets`], `surfaces`, `draws`, `looks` | packets that are valid but for a few words |
//! | [`session`] | a card, and the actions done to it one by one |
//! | [`coverage`] | which packets were executed, which faults were seen |
//! | [`mod@reference`] | does the card still answer? |
//! | [`compare`] | two cards that must end in the same state |
//! | [`mod@minimise`] | a failing list of actions, cut down |
//!
//! # Two paces
//! In a race the host does not wait: it writes memory and registers under the card's hands. In lock-step
//! it lets the card finish after each action; then everything the card holds is a function of the
//! actions, and two cards can be compared. See [`session::Timing`] for what is no such function.
//!
//! # What counts as a failure
//! A panic on either side of the bus; a card that has lost its power, its mind or its picture; an
//! access that does not return. The host gives a slow card [`Options::patience`] and then resets it from
//! another thread, as a driver would; that must free whoever waits within [`Options::hang`].

pub mod action;
pub mod bytes;
pub mod compare;
pub mod coverage;
mod draws;
mod lists;
mod looks;
pub mod minimise;
pub mod packets;
pub mod reference;
pub mod session;
mod surfaces;

pub use action::{Action, Mode};
pub use compare::differential;
pub use coverage::Coverage;
pub use minimise::minimise;
pub use session::Timing;

use session::Session;
use std::fmt;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};
use zga_abi::{Bus, Reg};
use zga_device::{Card, CardOptions, Kernel, Snapshot};

/// How a run is done.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The card. Small memories bound what a draw can cost.
    pub card: CardOptions,
    /// What the bytes become.
    pub mode: Mode,
    /// Lets the card finish after each action; `None`: the second bit of the first byte says.
    pub lock_step: Option<bool>,
    /// How long an action may take before the host resets the card.
    pub patience: Duration,
    /// How long after that reset everything must have returned.
    pub hang: Duration,
}

impl Default for Options {
    /// 1 MiB of video memory, 64 KiB of Za RAM, one thread, the widest kernel.
    fn default() -> Self {
        Options {
            card: CardOptions { video_memory: 1 << 20, za_ram: 1 << 16, threads: 1, kernel: Kernel::Best },
            mode: Mode::Any,
            lock_step: None,
            patience: Duration::from_millis(500),
            hang: Duration::from_secs(20),
        }
    }
}

/// What went wrong in a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The host's side of the bus panicked; the message.
    Panic(String),
    /// An access, or a reset meant to free it, did not return.
    Hang(Duration),
    /// The card does not do any more what it did when it was new.
    Mind(String),
    /// Two cards that must agree do not.
    Differ(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Panic(message) => write!(f, "panic on the bus: {message}"),
            Failure::Hang(after) => write!(f, "nothing returned for {after:?}"),
            Failure::Mind(what) => write!(f, "the card does not answer as it should: {what}"),
            Failure::Differ(what) => write!(f, "two cards disagree: {what}"),
        }
    }
}

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was done.
    pub actions: Arc<Vec<Action>>,
    /// Bus words moved.
    pub words: u64,
    /// What was reached.
    pub coverage: Coverage,
    /// Whether the final state is a function of the actions alone.
    pub timing: Timing,
    /// The card's state after the actions, before it was asked whether it still answers.
    pub state: Option<Snapshot>,
    /// Time it took.
    pub elapsed: Duration,
    /// What went wrong, if anything did.
    pub failure: Option<Failure>,
}

/// Does what `bytes` stand for to a new card.
#[must_use]
pub fn run(bytes: &[u8], options: &Options) -> Outcome {
    let CardOptions { video_memory, za_ram, .. } = options.card;
    let actions = action::decode(bytes, options.mode, video_memory, za_ram);
    let lock_step = options.lock_step.unwrap_or(bytes.first().is_some_and(|first| first & 2 != 0));
    run_actions(Arc::new(actions), lock_step, options)
}

/// Does `actions` to a new card.
#[must_use]
pub fn run_actions(actions: Arc<Vec<Action>>, lock_step: bool, options: &Options) -> Outcome {
    let begun = Instant::now();
    let (patience, hang) = (options.patience, options.hang);
    let mut outcome = Outcome {
        words: actions.iter().map(Action::words).sum(),
        actions: Arc::clone(&actions),
        coverage: Coverage::default(),
        timing: Timing::default(),
        state: None,
        elapsed: Duration::ZERO,
        failure: None,
    };
    let card = match Card::power_on(options.card) {
        Ok(card) => Arc::new(card),
        Err(error) => {
            outcome.failure = Some(Failure::Mind(error.to_string()));
            return outcome;
        }
    };
    // The thread is left behind if it hangs: nothing it holds is needed any more.
    let (done, finished) = channel();
    let worker = Arc::clone(&card);
    let session = std::thread::spawn(move || {
        let mut session = Session::new(&worker, lock_step, patience);
        for action in actions.iter() {
            session.act(action);
        }
        let (coverage, timing, state) = session.finish();
        // Who waits is gone only when it has given up.
        let _ = done.send((coverage, timing, state, reference::answers(&worker)));
    });
    let mut impatient = false;
    let received = match finished.recv_timeout(patience * 4) {
        Err(RecvTimeoutError::Timeout) => {
            impatient = true;
            let mut bus = card.bus();
            std::thread::spawn(move || bus.write32(Reg::Reset.offset(), 1));
            finished.recv_timeout(hang)
        }
        received => received,
    };
    match received {
        Ok((coverage, timing, state, answer)) => {
            // It has said its last word; nothing of it is left when the next run begins.
            let _ = session.join();
            outcome.coverage = coverage;
            outcome.timing = Timing { impatient: timing.impatient || impatient, ..timing };
            outcome.state = state;
            outcome.failure = answer.err().map(Failure::Mind);
        }
        Err(RecvTimeoutError::Timeout) => {
            // Dropping the card would wait for its thread.
            std::mem::forget(card);
            outcome.failure = Some(Failure::Hang(hang));
        }
        Err(RecvTimeoutError::Disconnected) => {
            let message = match session.join() {
                Ok(()) => "ended without a word".to_owned(),
                Err(payload) => payload.downcast_ref::<String>().cloned().unwrap_or_else(|| {
                    payload.downcast_ref::<&str>().map_or_else(|| "no message".to_owned(), ToString::to_string)
                }),
            };
            outcome.failure = Some(Failure::Panic(message));
        }
    }
    outcome.elapsed = begun.elapsed();
    outcome
}

/// Most memory that this process has held so far, in bytes; `None` where the host does not tell.
#[must_use]
pub fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().trim_end_matches("kB").trim().parse::<u64>().ok().map(|kib| kib * 1024)
}

/// Bytes without a pattern, always the same for a seed.
#[must_use]
pub fn noise(seed: u64, count: usize) -> Vec<u8> {
    let mut state = seed;
    let mut next = || {
        // splitmix64.
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    };
    let mut bytes: Vec<u8> = (0..count.div_ceil(8)).flat_map(|_| next().to_le_bytes()).collect();
    bytes.truncate(count);
    bytes
}
