//! The fragments of a band as they are found: a list a pixel, through one array.
//!
//! Duties: bounded memory. When the array is full the band is drawn in parts; a single pixel always fits, since no item
//! leaves more than one fragment in it. Inputs from: [`super::cover`], [`super::band`]. Outputs to: [`super::band`].
//! Clocks: none, lists are written while masks are made.

use super::band::Input;
use std::hint::select_unpredictable;

/// What covers a part of a pixel; on the card its mask, its pixel and its primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fragment {
    /// Samples.
    pub mask: u64,
    /// Its piece's place among those of the band.
    pub piece: u32,
    /// No sample is nearer, covered or not.
    pub near: i32,
    /// No sample is farther, covered or not.
    pub far: i32,
    /// The fragment found before in the same pixel: its place plus 1, 0 if there is none.
    next: u32,
}

impl Fragment {
    /// A fragment with the bounds of its depths.
    #[must_use]
    pub fn new(mask: u64, piece: u32, [near, far]: [i32; 2]) -> Fragment {
        Fragment { mask, piece, near, far, next: 0 }
    }
}

/// A fragment in its pixel's list.
#[derive(Clone, Copy, Debug)]
struct Link {
    fragment: Fragment,
    /// Samples that the opaque fragments since the limit was last lowered have covered.
    union: u64,
    /// The farthest depth of those.
    far: i32,
    /// Fragments of the list so far.
    count: u32,
}

/// The end of all lists.
const END: Link =
    Link { fragment: Fragment { mask: 0, piece: 0, near: 0, far: 0, next: 0 }, union: 0, far: i32::MIN, count: 0 };

/// Fragments of a thread at most, but for those of one pixel: 10 MiB.
const MOST: usize = 1 << 18;

/// Fragments in the order in which they are found.
#[derive(Debug, Default)]
pub struct Lists {
    /// The first is [`END`]; `used` of them mean something.
    links: Vec<Link>,
    used: usize,
    /// The last link of each pixel of the band; 0 if it has none, as all have between bands.
    places: Vec<u32>,
    limit: usize,
    full: bool,
}

impl Lists {
    /// Makes ready for a band, or for a part of one.
    pub(super) fn begin(&mut self, input: &Input<'_>) {
        self.used = 1;
        let pool = (input.setting.pool as usize).saturating_mul(input.lines);
        self.limit = pool.min(MOST).max(input.items.len());
        self.full = false;
        self.has_room(0);
        let pixels = input.pitch() * input.lines;
        self.places.resize(pixels.max(self.places.len()), 0);
    }

    /// Whether there is room for so many more; once there is not, never again.
    #[inline(always)]
    pub(super) fn has_room(&mut self, more: usize) -> bool {
        self.full |= self.used - 1 + more > self.limit;
        // One more, for what is not kept.
        if !self.full && self.used + more >= self.links.len() {
            self.links.resize((2 * (self.used + more + 1)).min(self.limit + 2), END);
        }
        !self.full
    }

    /// There was no room for some.
    pub(super) fn is_full(&self) -> bool {
        self.full
    }

    /// Adds a fragment to a pixel; there must be room.
    #[inline(always)]
    pub(super) fn put(&mut self, at: usize, fragment: Fragment) {
        self.put_opaque(at, fragment, [true, false], u64::MAX, &mut 0);
    }

    /// Adds a fragment to a pixel in which everything behind `limit` is hidden, if it is to be kept, and lowers `limit`
    /// if it hides something, and completes some that cover the pixel together. What is not kept has no mask.
    #[inline(always)]
    pub(super) fn put_opaque(
        &mut self,
        at: usize,
        fragment: Fragment,
        [keep, hides]: [bool; 2],
        full: u64,
        limit: &mut i32,
    ) {
        let place = &mut self.places[at];
        let before = self.links[*place as usize];
        let joins = hides & (fragment.far < *limit);
        let union = before.union | select_unpredictable(joins, fragment.mask, 0);
        let far = before.far.max(select_unpredictable(joins, fragment.far, i32::MIN));
        let complete = union == full;
        *limit = select_unpredictable(complete, far, i32::MAX).min(*limit);
        self.links[self.used] = Link {
            fragment: Fragment { next: *place, ..fragment },
            union: select_unpredictable(complete, 0, union),
            far: select_unpredictable(complete, i32::MIN, far),
            count: before.count + 1,
        };
        *place = select_unpredictable(keep, self.used as u32, *place);
        self.used += usize::from(keep);
    }

    /// Moves the fragments of a pixel to `list`, those found last first.
    #[inline(always)]
    pub(super) fn take(&mut self, at: usize, list: &mut Vec<Fragment>) {
        list.clear();
        let mut next = std::mem::take(&mut self.places[at]) as usize;
        for _ in 0..self.links[next].count {
            let fragment = self.links[next].fragment;
            list.push(fragment);
            next = fragment.next as usize;
        }
    }

    /// Forgets the fragments of a pixel.
    pub(super) fn drop(&mut self, at: usize) {
        self.places[at] = 0;
    }
}
