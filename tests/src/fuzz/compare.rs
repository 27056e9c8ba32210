//! The same actions on two cards: whatever kernel and threads they have, they end in the same state.
//!
//! The state is a snapshot: both memories, every register, interrupts, ring, FIFO, the scene that is
//! open, every counter. Runs that touched something that depends on time are left out ([`Timing`]).

use super::{Failure, Mode, Options, Outcome, Timing, run};
use zga_abi::bus::MEMORY_BASE;
use zga_abi::registers::REGISTERS;
use zga_abi::{Bus, Counter, Reg};
use zga_device::{Card, CardOptions, Snapshot};

/// Runs `bytes` in lock-step on the card of `options` and on one like `other`; the outcome of the
/// first, which is a failure if the two disagree.
#[must_use]
pub fn differential(bytes: &[u8], mode: Mode, options: &Options, other: CardOptions) -> Outcome {
    let options = Options { mode, lock_step: Some(true), ..*options };
    let mut first = run(bytes, &options);
    if first.failure.is_some() || !first.timing.is_exact() {
        return first;
    }
    let second = run(bytes, &Options { card: other, ..options });
    first.elapsed += second.elapsed;
    first.words += second.words;
    if second.failure.is_some() {
        first.failure = second.failure;
    } else if second.timing.is_exact() && first.state != second.state {
        first.failure = Some(Failure::Differ(first_difference(&options.card, &first, &second)));
    }
    first.timing = Timing { impatient: first.timing.impatient || second.timing.impatient, ..first.timing };
    first
}

/// Where two states differ first.
fn first_difference(options: &CardOptions, first: &Outcome, second: &Outcome) -> String {
    let (Some(first), Some(second)) = (&first.state, &second.state) else {
        return "only one of them gave a state".to_owned();
    };
    match (visible(options, first), visible(options, second)) {
        (Ok(a), Ok(b)) => {
            // The first ones: sums differ with what they are made of.
            let differences = a.iter().zip(&b).filter(|(a, b)| a != b).take(6);
            let told: Vec<_> = differences.map(|(a, b)| format!("{} is {:#x} and {:#x}", a.0, a.1, b.1)).collect();
            if told.is_empty() {
                format!("in something that the bus does not show: {}", hidden_difference(first, second))
            } else {
                told.join(", ")
            }
        }
        (Err(error), _) | (_, Err(error)) => error,
    }
}

/// What stands in the two states' text where it begins to differ.
fn hidden_difference(first: &Snapshot, second: &Snapshot) -> String {
    let texts = [first, second].map(|state| format!("{state:?}"));
    let same = texts[0].bytes().zip(texts[1].bytes()).take_while(|(a, b)| a == b).count();
    let around = |text: &str| text.chars().skip(same.saturating_sub(60)).take(100).collect::<String>();
    format!("{:?} and {:?}", around(&texts[0]), around(&texts[1]))
}

/// All that the bus shows of a state, with names.
fn visible(options: &CardOptions, state: &Snapshot) -> Result<Vec<(String, u32)>, String> {
    let card = Card::power_on(*options).map_err(|error| error.to_string())?;
    card.restore(state).map_err(|error| error.to_string())?;
    let mut bus = card.bus();
    let mut words = Vec::new();
    for counter in Counter::ALL {
        words.push((counter.name().to_owned(), bus.read32(counter.offset())));
    }
    let registers = REGISTERS.iter().filter(|register| register.offset != Reg::Counters.offset());
    for register in registers {
        for word in 0..register.count {
            words.push((format!("{} {word}", register.name), bus.read32(register.word_offset(word))));
        }
    }
    let mut memory = vec![0; (options.video_memory / 4) as usize];
    bus.read_burst(MEMORY_BASE, &mut memory);
    words.extend((0_u32..).zip(memory).map(|(at, word)| (format!("video memory at {:#x}", 4 * at), word)));
    Ok(words)
}
