//! Soak: millions of random bus words, half of them raw, half of them packets with a few words wrong.
//!
//! ```text
//! cargo run --release -p zga-tests --example soak -- --words 10000000 --seed 1
//! ```
//! Each run has a card of its own and a seed of its own; every fourth is done on two cards, of which
//! one has another kernel and other threads. Exit code 1 and the shortest failing list of actions found
//! if the card panics, hangs, does not answer afterwards, or two cards disagree.

use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};
use zga_device::{CardOptions, Kernel};
use zga_tests::fuzz::{self, Coverage, Failure, Mode, Options, Outcome, Timing};

/// Most bytes of memory that the process may have held.
const MOST_MEMORY: u64 = 2 << 30;
/// One run in so many may keep the host waiting until it resets the card: long draws, slow blanks.
const MOST_IMPATIENT: u64 = 500;
/// Bytes of a run.
const RUN_BYTES: [usize; 4] = [256, 1024, 3000, 6000];

struct Arguments {
    words: u64,
    seed: u64,
}

fn arguments() -> Result<Arguments, String> {
    let mut arguments = Arguments { words: 10_000_000, seed: 1 };
    let mut given = std::env::args().skip(1);
    while let Some(name) = given.next() {
        let value = given.next().and_then(|value| value.parse().ok());
        match (name.as_str(), value) {
            ("--words", Some(value)) => arguments.words = value,
            ("--seed", Some(value)) => arguments.seed = value,
            _ => return Err(format!("{name}: expected --words N and --seed N")),
        }
    }
    Ok(arguments)
}

/// The run with number `number`: what is done and how.
fn plan(seed: u64, number: u64) -> (Vec<u8>, Options, Option<CardOptions>) {
    let length = RUN_BYTES[(number / 2 % 4) as usize];
    let bytes = fuzz::noise(seed.wrapping_mul(0x1_0000_0001).wrapping_add(number), length);
    let mode = if number.is_multiple_of(2) { Mode::Raw } else { Mode::Structured };
    let options = Options { mode, ..Options::default() };
    let kernels = Kernel::available();
    let kernel = kernels[(number / 8) as usize % kernels.len()];
    let threads = 1 + (number / 4 % 3) as usize;
    let other = CardOptions { threads, kernel, ..options.card };
    (bytes, options, (number / 2 % 4 == 3).then_some(other))
}

fn do_run((bytes, options, other): &(Vec<u8>, Options, Option<CardOptions>)) -> Outcome {
    match other {
        Some(other) => fuzz::differential(bytes, options.mode, options, *other),
        None => fuzz::run(bytes, options),
    }
}

/// Prints a failing run, cut down as far as a minute allows.
fn report(seed: u64, number: u64, failure: &Failure, outcome: &Outcome) {
    let (bytes, options, other) = plan(seed, number);
    println!("FAILED: seed {seed}, run {number}: {failure}");
    let lock_step = other.is_some() || bytes.first().is_some_and(|first| first & 2 != 0);
    let kind = std::mem::discriminant(failure);
    let options = Options { hang: Duration::from_secs(3), ..options };
    let fails = |actions: &[fuzz::Action]| {
        let failure = fuzz::run_actions(Arc::new(actions.to_vec()), lock_step, &options).failure;
        failure.is_some_and(|failure| std::mem::discriminant(&failure) == kind)
    };
    let least = match failure {
        Failure::Differ(_) => outcome.actions.to_vec(),
        _ => fuzz::minimise(&outcome.actions, Duration::from_secs(60), fails),
    };
    println!("{} of {} actions are left (lock-step: {lock_step}):", least.len(), outcome.actions.len());
    for action in &least {
        println!("    {action:x?},");
    }
}

fn main() -> ExitCode {
    let Arguments { words, seed } = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    let begun = Instant::now();
    let (mut done, mut coverage, mut longest) = (0, Coverage::default(), (Duration::ZERO, 0));
    let (mut exact, mut impatient, mut shown, mut number) = (0_u64, 0_u64, Duration::ZERO, 0);
    while done < words {
        let outcome = do_run(&plan(seed, number));
        done += outcome.words;
        coverage.add(&outcome.coverage);
        longest = longest.max((outcome.elapsed, number));
        impatient += u64::from(outcome.timing.impatient);
        exact += u64::from(number / 2 % 4 == 3 && outcome.timing == Timing::default());
        if let Some(failure) = &outcome.failure {
            report(seed, number, failure, &outcome);
            return ExitCode::FAILURE;
        }
        number += 1;
        if impatient > 10 + number / MOST_IMPATIENT {
            println!(
                "FAILED: seed {seed}, up to run {number}: {impatient} cards stalled their host until it reset them"
            );
            return ExitCode::FAILURE;
        }
        if begun.elapsed() > shown + Duration::from_secs(5) {
            shown = begun.elapsed();
            println!("{done} words, {number} runs, {:.0} words/s", done as f64 / shown.as_secs_f64());
        }
    }
    let seconds = begun.elapsed().as_secs_f64();
    println!("seed {seed}: {done} bus words in {number} runs, {seconds:.1} s, {:.0} words/s", done as f64 / seconds);
    println!("longest run: {:?} (run {}); cards reset by an impatient host: {impatient}", longest.0, longest.1);
    println!("runs compared on two cards: {exact}");
    print!("{coverage}");
    let memory = fuzz::peak_memory();
    println!("most memory held: {} MiB", memory.unwrap_or(0) >> 20);
    if !coverage.missing().is_empty() || memory.is_some_and(|bytes| bytes > MOST_MEMORY) {
        println!("FAILED: never executed: {:?}, or too much memory", coverage.missing());
        return ExitCode::FAILURE;
    }
    println!("no panic, no hang, every card answered afterwards");
    ExitCode::SUCCESS
}
