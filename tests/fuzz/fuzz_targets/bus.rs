//! Coverage-guided fuzzing of the whole bus: see `zga_tests::fuzz` for what the bytes stand for.
//!
//! ```text
//! ./setup.sh     # once: installs cargo-fuzz, makes a first corpus
//! cd tests && cargo +nightly fuzz run bus -- -max_len=4096 -len_control=0 -max_total_time=600
//! cargo +nightly fuzz run bus artifacts/bus/crash-...   # once more, from tests/fuzz or tests
//! ```
//! A panic of any thread ends the process, with the bytes in `artifacts/`; so does a card that hangs
//! or does not answer afterwards, with the list of actions. Runs in lock-step are done on a second card
//! with the plainest kernel, and the two must agree.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zga_device::{CardOptions, Kernel};
use zga_tests::fuzz::{Mode, Options, differential, run};

fuzz_target!(|bytes: &[u8]| {
    let options = Options::default();
    let in_lock_step = bytes.first().is_some_and(|first| first & 2 != 0);
    let outcome = if in_lock_step {
        let other = CardOptions { kernel: Kernel::Specification, ..options.card };
        differential(bytes, Mode::Any, &options, other)
    } else {
        run(bytes, &options)
    };
    if let Some(failure) = outcome.failure {
        panic!("{failure}\nactions: {:#x?}", outcome.actions);
    }
});
