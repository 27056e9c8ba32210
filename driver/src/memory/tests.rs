//! The allocator: named cases, and random ones against its invariants.

use proptest::prelude::*;

use super::{Alignment, MemoryError, VideoMemory};

#[test]
fn allocate_small_sizes_rounds_up_to_64_in_order() {
    let mut memory = VideoMemory::new(4096);
    let first = memory.allocate(1, Alignment::Line).expect("room");
    let second = memory.allocate(65, Alignment::Line).expect("room");
    assert_eq!((first.address(), first.bytes()), (0, 64));
    assert_eq!((second.address(), second.bytes()), (64, 128));
}

#[test]
fn allocate_page_leaves_the_gap_before_it_usable() {
    let mut memory = VideoMemory::new(16384);
    let line = memory.allocate(64, Alignment::Line).expect("room");
    let page = memory.allocate(64, Alignment::Page).expect("room");
    let gap = memory.allocate(4032, Alignment::Line).expect("room");
    assert_eq!((line.address(), page.address(), gap.address()), (0, 4096, 64));
}

#[test]
fn allocate_too_much_states_asked_and_largest() {
    let mut memory = VideoMemory::new(4096);
    let kept = memory.allocate(64, Alignment::Line).expect("room");
    let refused = memory.allocate(8192, Alignment::Page).expect_err("too much");
    assert_eq!(refused, MemoryError::OutOfMemory { asked: 8192, alignment: 4096, free: 4032, largest: 4032 });
    assert!(refused.to_string().contains("8192 bytes asked for"));
    memory.free(kept).expect("own");
    assert_eq!(memory.largest_free(), 4096);
}

#[test]
fn allocate_enormous_size_is_refused() {
    let mut memory = VideoMemory::new(1 << 30);
    assert!(memory.allocate(u64::MAX, Alignment::Line).is_err());
}

#[test]
fn free_middle_last_joins_both_neighbours() {
    let mut memory = VideoMemory::new(192);
    let [a, b, c] = [(); 3].map(|()| memory.allocate(64, Alignment::Line).expect("room"));
    memory.free(a).expect("own");
    memory.free(c).expect("own");
    memory.free(b).expect("own");
    assert_eq!((memory.largest_free(), memory.allocations()), (192, 0));
}

#[test]
fn free_foreign_allocation_is_refused() {
    let foreign = VideoMemory::new(4096).allocate(64, Alignment::Line).expect("room");
    let refused = VideoMemory::new(4096).free(foreign);
    assert_eq!(refused, Err(MemoryError::NotAllocated { address: 0, bytes: 64 }));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn allocator_random_order_keeps_its_books(
        steps in prop::collection::vec((0_u64..9000, any::<bool>(), any::<prop::sample::Index>()), 1..120)
    ) {
        const BYTES: u32 = 100_000;
        let mut memory = VideoMemory::new(BYTES);
        let mut held = Vec::new();
        for (bytes, page, pick) in steps {
            let alignment = if page { Alignment::Page } else { Alignment::Line };
            if let Ok(run) = memory.allocate(bytes, alignment) {
                prop_assert!(run.address().is_multiple_of(alignment.bytes()));
                prop_assert!(u64::from(run.bytes()) >= bytes && u64::from(run.address()) + u64::from(run.bytes()) <= u64::from(BYTES));
                held.push(run);
            } else if !held.is_empty() {
                let run = held.swap_remove(pick.index(held.len()));
                prop_assert!(memory.free(run).is_ok());
            }
            prop_assert!(memory.is_consistent(BYTES));
        }
        for run in held {
            prop_assert!(memory.free(run).is_ok());
        }
        prop_assert_eq!(memory.largest_free(), u64::from(BYTES) / 64 * 64);
    }
}
