//! Pictures in bands of rows, shared out to threads. A band goes through its primitives in submission order and shares
//! no pixel with another, so the picture does not depend on the number of threads.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Rows of a band.
pub(super) const ROWS: u32 = 8;

/// Pixels of work that are worth another thread.
const WORTH: u64 = 1 << 18;

/// For each band of a target of `height` rows the primitives, by position, whose rows meet it.
pub(super) fn bins(height: u32, rows: impl Iterator<Item = Range<u32>>) -> Vec<Vec<u32>> {
    let mut bins = vec![Vec::new(); height.div_ceil(ROWS) as usize];
    for (index, rows) in (0..).zip(rows).filter(|(_, rows)| !rows.is_empty()) {
        for band in rows.start / ROWS..=(rows.end - 1) / ROWS {
            bins[band as usize].push(index);
        }
    }
    bins
}

/// Calls `draw` for each band, on as many threads as `work` pixels are worth and the machine has.
pub(super) fn each<B: Send>(bands: impl Iterator<Item = B> + Send, work: u64, draw: impl Fn(B) + Sync) {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = processors.min((work / WORTH) as usize);
    if threads < 2 {
        bands.for_each(draw);
        return;
    }
    let queue = Mutex::new(bands);
    // A thread that panics takes the scope down with it, so what it held does not matter.
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| std::iter::from_fn(&next).for_each(&draw));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn bins_rows_at_the_borders_of_bands_are_in_all_that_they_meet() {
        let bins = bins(20, [0..8, 7..9, 3..3, 16..20, 0..20].into_iter());

        assert_eq!(bins, [vec![0, 1, 4], vec![1, 4], vec![3, 4]]);
    }

    #[test]
    fn each_band_is_drawn_once_by_one_thread_and_by_many() {
        for work in [0, u64::MAX] {
            let drawn = [const { AtomicU32::new(0) }; 100];

            each(drawn.iter(), work, |band| {
                band.fetch_add(1, Ordering::Relaxed);
            });

            assert!(drawn.iter().all(|count| count.load(Ordering::Relaxed) == 1));
        }
    }
}
