//! Delta debugging: fewer and shorter actions that still fail.

use super::action::Action;
use std::time::{Duration, Instant};

/// The shortest list found within `time` for which `fails` holds; it holds for `actions`.
///
/// First actions go, in halves, quarters, down to one; then words of the actions that are left.
#[must_use]
pub fn minimise(actions: &[Action], time: Duration, mut fails: impl FnMut(&[Action]) -> bool) -> Vec<Action> {
    let deadline = Instant::now() + time;
    let mut least = without_parts(actions, deadline, &mut fails);
    for place in 0..least.len() {
        let Some(words) = words_of(&least[place]) else { continue };
        let with = |words: &[u32]| {
            let mut actions = least.clone();
            set_words(&mut actions[place], words);
            actions
        };
        let shorter = without_parts(words, deadline, &mut |words: &[u32]| fails(&with(words)));
        least = with(&shorter);
    }
    least
}

/// Takes parts out of `items` for as long as `fails` holds for the rest.
fn without_parts<T: Clone>(items: &[T], deadline: Instant, fails: &mut impl FnMut(&[T]) -> bool) -> Vec<T> {
    let mut least = items.to_vec();
    let mut part = least.len().div_ceil(2);
    while part > 0 {
        let mut at = 0;
        while at < least.len() && Instant::now() < deadline {
            let mut rest = least[..at].to_vec();
            rest.extend_from_slice(&least[(at + part).min(least.len())..]);
            if fails(&rest) {
                least = rest;
            } else {
                at += part;
            }
        }
        part = if part == 1 { 0 } else { part.div_ceil(2) };
    }
    least
}

fn words_of(action: &Action) -> Option<&[u32]> {
    match action {
        Action::Fifo(words) | Action::Write { words, .. } | Action::Ring { words, .. } => Some(words),
        _ => None,
    }
}

fn set_words(action: &mut Action, shorter: &[u32]) {
    if let Action::Fifo(words) | Action::Write { words, .. } | Action::Ring { words, .. } = action {
        *words = shorter.to_vec();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minimise_one_word_at_fault_is_all_that_is_left() {
        let actions: Vec<Action> = (0..40).map(|n| Action::Fifo((10 * n..10 * n + 10).collect())).collect();
        let fails =
            |actions: &[Action]| actions.iter().any(|a| matches!(a, Action::Fifo(words) if words.contains(&237)));
        assert_eq!(minimise(&actions, Duration::from_secs(60), fails), [Action::Fifo(vec![237])]);
    }
}
