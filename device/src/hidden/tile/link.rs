//! Linked lists of the two sorts: an index of heads and a link for each polygon.
//!
//! Duties: insertion at the head; the walk over everything that is live, which merges the polygons that
//! stayed linked with those that start here, and unlinks those that end. Inputs: addresses in the sort
//! buffer, and for each one walked whether it stays. Outputs: addresses in order.
//!
//! Clocks: 1 an insertion (head read and written, link written: two memories in one clock), 1 a link
//! followed; the comparison of two heads goes beside it.

use super::HEAD_BYTES;

/// Address of a polygon in the sort buffer: its number in order of arrival.
pub type Address = u32;

/// A link of the last polygon of a list.
pub const END: Address = Address::MAX;
/// A head of a list that has no polygon.
pub const EMPTY: Address = Address::MAX - 1;

/// In which order a walk goes, and its lists stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The highest address first.
    Newest,
    /// The lowest address first.
    Oldest,
}

/// What happened on a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walked {
    /// Links followed.
    pub links: u64,
    /// Polygons unlinked.
    pub removed: u64,
}

/// Lists, and the one that is carried along from place to place.
///
/// # Invariants
/// Every list is ordered by address as `order` says; a polygon is in one list at most.
#[derive(Debug)]
pub struct Sort {
    order: Order,
    /// Heads: a row's or tile's list of polygons that start there.
    index: Vec<Address>,
    /// A link for each polygon.
    links: Vec<Address>,
    /// Head of the list of those that stayed linked at the last place.
    live: Address,
}

impl Sort {
    /// Empty lists for `places`, whose polygons come in the order opposite to `order`.
    #[must_use]
    pub fn new(order: Order, places: usize) -> Sort {
        Sort { order, index: vec![EMPTY; places], links: Vec::new(), live: END }
    }

    /// Heads of the lists.
    #[cfg(test)]
    #[must_use]
    pub fn index(&self) -> &[Address] {
        &self.index
    }

    /// Bytes of the index.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        HEAD_BYTES * self.index.len() as u64
    }

    /// Link of a polygon.
    #[cfg(test)]
    #[must_use]
    pub fn link(&self, address: Address) -> Address {
        self.links[address as usize]
    }

    /// Whether a walk at `place` meets nothing.
    #[cfg(test)]
    #[must_use]
    pub fn is_empty_at(&self, place: usize) -> bool {
        self.index[place] == EMPTY && self.live == END
    }

    /// Puts a polygon at the head of the list of `place`.
    pub fn insert(&mut self, place: usize, address: Address) {
        let slot = address as usize;
        if slot >= self.links.len() {
            self.links.resize(slot + 1, END);
        }
        let head = &mut self.index[place];
        self.links[slot] = if *head == EMPTY { END } else { *head };
        *head = address;
    }

    /// Walks everything live at `place`: what stayed linked there and what starts. `stays` is told each
    /// polygon once, in order, and says whether it is linked at the next place too. The list of `place`
    /// is EMPTY afterwards.
    pub fn walk(&mut self, place: usize, mut stays: impl FnMut(Address) -> bool) -> Walked {
        let started = std::mem::replace(&mut self.index[place], EMPTY);
        let mut heads = [self.live, if started == EMPTY { END } else { started }];
        let mut tail = END;
        let mut walked = Walked::default();
        self.live = END;
        while let Some(head) = self.first(heads) {
            let address = heads[head];
            heads[head] = self.links[address as usize];
            walked.links += 1;
            if !stays(address) {
                walked.removed += 1;
                continue;
            }
            // Its own link has been read: it can be the end of what stays.
            self.links[address as usize] = END;
            if tail == END {
                self.live = address;
            } else {
                self.links[tail as usize] = address;
            }
            tail = address;
        }
        walked
    }

    /// Which of two lists the walk goes on with.
    fn first(&self, heads: [Address; 2]) -> Option<usize> {
        match heads {
            [END, END] => None,
            [_, END] => Some(0),
            [END, _] => Some(1),
            [a, b] => Some(usize::from((b < a) == (self.order == Order::Oldest))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn insert_twice_links_the_newer_before_the_older() {
        let mut sort = Sort::new(Order::Newest, 2);
        sort.insert(1, 0);
        sort.insert(1, 1);
        assert_eq!(sort.index(), [EMPTY, 1]);
        assert_eq!([sort.link(0), sort.link(1)], [END, 0]);
    }

    #[test]
    fn walk_polygon_that_stays_is_met_at_the_next_place() {
        let mut sort = Sort::new(Order::Oldest, 3);
        sort.insert(1, 2);
        sort.insert(0, 1);
        let mut met = vec![];
        let mut counts = vec![];
        for place in 0..3 {
            counts.push(sort.walk(place, |address| {
                met.push((place, address));
                address == 1 && place == 0
            }));
        }
        assert_eq!(met, [(0, 1), (1, 1), (1, 2)]);
        assert_eq!(
            counts,
            [Walked { links: 1, removed: 0 }, Walked { links: 2, removed: 2 }, Walked { links: 0, removed: 0 }]
        );
    }

    #[test]
    fn walk_empty_place_meets_nothing() {
        let mut sort = Sort::new(Order::Newest, 1);
        assert!(sort.is_empty_at(0));
        assert_eq!(sort.walk(0, |_| true), Walked::default());
        assert_eq!(sort.index(), [EMPTY]);
    }

    proptest! {
        #[test]
        fn walk_random_meets_each_live_polygon_once_in_order(
            ranges in proptest::collection::vec((0_usize..6, 0_usize..6), 0..40),
            oldest: bool,
        ) {
            // Polygon k is live at places ranges[k].0 ..= ranges[k].0 + ranges[k].1, cut to 6 places.
            let mut sort = Sort::new(if oldest { Order::Oldest } else { Order::Newest }, 6);
            let mut arrivals: Vec<usize> = (0..ranges.len()).collect();
            if oldest {
                arrivals.reverse();
            }
            for &k in &arrivals {
                sort.insert(ranges[k].0, k as Address);
            }
            arrivals.reverse();
            for place in 0..6 {
                let live = |k: usize| (ranges[k].0..=ranges[k].0 + ranges[k].1).contains(&place);
                let expected: Vec<usize> = arrivals.iter().copied().filter(|&k| live(k)).collect();
                let mut met = vec![];
                let walked = sort.walk(place, |address| {
                    met.push(address as usize);
                    place < ranges[address as usize].0 + ranges[address as usize].1
                });
                prop_assert_eq!(walked.links, expected.len() as u64);
                prop_assert_eq!(met, expected);
            }
        }
    }
}
