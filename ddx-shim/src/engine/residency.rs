//! Residency: which pixmaps lie in video memory, when it does not hold all of them.
//!
//! A pixmap in host memory is drawn to by the server's renderer. Each operation that the card could have done, had the
//! pixmap been in video memory, earns the pixmap credit, as many bytes as the operation would have touched. When the
//! credit has paid for the move, the bytes that come in and the bytes that go out, the pixmap moves in and those used
//! longest ago move out; who moved out begins again without credit. So moves never cost more than a constant factor of
//! the drawing done meanwhile, whatever the order of operations: a working set larger than video memory does not make a
//! storm of moves.

/// A pixmap in video memory that could move out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resident {
    /// Its place in the pixmap table.
    pub pixmap: usize,
    /// Bytes of video memory that it takes.
    pub bytes: u64,
    /// When the card last used it, counted in operations.
    pub used: u64,
}

/// Which pixmaps have to move out so that `needed` bytes become free beside the `free` bytes that are: those used longest
/// ago, in that order. `None` if all of them would not be enough, or if `credit` does not pay for the move.
#[must_use]
pub fn victims(mut residents: Vec<Resident>, free: u64, needed: u64, credit: u64) -> Option<Vec<usize>> {
    residents.sort_unstable_by_key(|resident| resident.used);
    let (mut room, mut cost, mut leaving) = (free, needed, Vec::new());
    for resident in residents {
        if room >= needed {
            break;
        }
        room += resident.bytes;
        cost += resident.bytes;
        leaving.push(resident.pixmap);
    }
    (room >= needed && credit >= cost).then_some(leaving)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residents() -> Vec<Resident> {
        vec![
            Resident { pixmap: 0, bytes: 100, used: 9 },
            Resident { pixmap: 1, bytes: 200, used: 3 },
            Resident { pixmap: 2, bytes: 50, used: 5 },
        ]
    }

    #[test]
    fn victims_room_enough_nobody_leaves() {
        assert_eq!(victims(residents(), 64, 64, 64), Some(vec![]));
    }

    #[test]
    fn victims_used_longest_ago_leave_first_and_no_more_than_needed() {
        assert_eq!(victims(residents(), 0, 180, 1000), Some(vec![1]));
        assert_eq!(victims(residents(), 0, 240, 1000), Some(vec![1, 2]));
        assert_eq!(victims(residents(), 0, 350, 1000), Some(vec![1, 2, 0]));
    }

    #[test]
    fn victims_too_little_memory_or_credit_nobody_leaves() {
        assert_eq!(victims(residents(), 0, 351, 1000), None);
        assert_eq!(victims(residents(), 0, 180, 379), None);
        assert_eq!(victims(residents(), 0, 180, 380), Some(vec![1]));
    }

    /// Two pixmaps that are used in turn and do not fit together: at least as many bytes are drawn as are moved.
    #[test]
    fn victims_working_set_too_large_moves_no_more_than_is_drawn() {
        const BYTES: u64 = 1000;
        let (mut inside, mut credit, mut drawn, mut moved) = (0, [0_u64; 2], 0, 0);
        for step in 0..10_000_u64 {
            let wanted = (step % 2) as usize;
            drawn += 10;
            if wanted == inside {
                continue;
            }
            credit[wanted] += 10;
            let resident = vec![Resident { pixmap: inside, bytes: BYTES, used: step - 1 }];
            if victims(resident, 0, BYTES, credit[wanted]).is_some() {
                moved += 2 * BYTES;
                credit = [0; 2];
                inside = wanted;
            }
        }
        assert!(moved > 0 && moved <= drawn, "{moved} moved, {drawn} drawn");
    }
}
