//! Progress of long work, on the standard error; silent when that is not a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar for `steps` steps of `what`; none for a single step.
pub(super) fn bar(steps: u64, what: &'static str) -> ProgressBar {
    if steps <= 1 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps).with_message(what);
    match ProgressStyle::with_template("{msg} [{bar:30}] {pos}/{len} {eta}") {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}

/// A bar for `steps` steps whose name changes.
pub(super) fn named_bar(steps: u64) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    match ProgressStyle::with_template("[{bar:20}] {pos}/{len} {elapsed} {msg}") {
        Ok(style) => bar.with_style(style.progress_chars("=> ")),
        Err(_) => bar,
    }
}
