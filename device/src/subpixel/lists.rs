//! The fragments of a band as they are found: a list a pixel, through one array.
//!
//! Duties: bounded memory. When the array is full the band is drawn in parts; a single pixel always fits, since no item
//! leaves more than one fragment in it. Inputs from: [`super::cover`], [`super::band`]. Outputs to: [`super::band`].
//! Clocks: none, lists are written while masks are made.

use super::band::Input;

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

/// Fragments that lie beside their pixel's state.
const NEAR: usize = 2;

/// A pixel while its fragments are found: a line of the host's cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Head {
    /// The fragments found first.
    near: [Fragment; NEAR],
    /// Samples that the opaque fragments since the limit was last lowered have covered.
    mask: u64,
    /// The farthest depth of those.
    far: i32,
    /// Fragments in `near`; the rest is a list that begins in `next` of the first.
    count: u32,
}

/// A pixel without fragments.
const NONE: Head =
    Head { near: [Fragment { mask: 0, piece: 0, near: 0, far: 0, next: 0 }; NEAR], mask: 0, far: i32::MIN, count: 0 };

/// Fragments of a thread at most, but for those of one pixel: 6 MiB.
const MOST: usize = 1 << 18;

/// Fragments in the order in which they are found.
#[derive(Debug, Default)]
pub struct Lists {
    /// Those that find no place beside their pixel's state.
    stored: Vec<Fragment>,
    /// All that were found.
    count: usize,
    /// Pixels that have fragments, in the order in which the first was found.
    heads: Vec<Head>,
    /// The place of each pixel of the band among those plus 1; 0 if it has none, as all have between bands.
    places: Vec<u32>,
    limit: usize,
    full: bool,
}

impl Lists {
    /// Makes ready for a band, or for a part of one.
    pub(super) fn begin(&mut self, input: &Input<'_>) {
        self.stored.clear();
        self.count = 0;
        let pool = (input.setting.pool as usize).saturating_mul(input.lines);
        self.limit = pool.min(MOST).max(input.items.len());
        self.full = false;
        self.heads.clear();
        let pixels = input.pitch() * input.lines;
        self.places.resize(pixels.max(self.places.len()), 0);
    }

    /// Whether there is room for so many more; once there is not, never again.
    #[inline(always)]
    pub(super) fn has_room(&mut self, more: usize) -> bool {
        self.full |= self.count + more > self.limit;
        !self.full
    }

    /// There was no room for some.
    pub(super) fn is_full(&self) -> bool {
        self.full
    }

    /// Adds a fragment to a pixel.
    #[inline(always)]
    pub(super) fn put(&mut self, at: usize, fragment: Fragment) -> &mut Head {
        self.count += 1;
        let place = &mut self.places[at];
        if *place == 0 {
            self.heads.push(NONE);
            *place = self.heads.len() as u32;
        }
        let head = &mut self.heads[*place as usize - 1];
        if let Some(place) = head.near.get_mut(head.count as usize) {
            *place = Fragment { next: 0, ..fragment };
            head.count += 1;
        } else {
            self.stored.push(Fragment { next: head.near[0].next, ..fragment });
            head.near[0].next = self.stored.len() as u32;
        }
        head
    }

    /// Adds an opaque fragment to a pixel in which everything behind `limit` is hidden, and lowers `limit` if the
    /// fragment completes some that cover the pixel together.
    #[inline(always)]
    pub(super) fn put_opaque(&mut self, at: usize, fragment: Fragment, full: u64, limit: &mut i32) {
        let head = self.put(at, fragment);
        if fragment.far < *limit {
            head.mask |= fragment.mask;
            head.far = head.far.max(fragment.far);
            if head.mask == full {
                *limit = head.far;
                (head.mask, head.far) = (0, i32::MIN);
            }
        }
    }

    /// Moves the fragments of a pixel to the end of `list`.
    #[inline(always)]
    pub(super) fn take(&mut self, at: usize, list: &mut Vec<Fragment>) {
        let place = std::mem::take(&mut self.places[at]) as usize;
        let Some(head) = self.heads.get(place.wrapping_sub(1)) else {
            return;
        };
        list.extend(head.near[..(head.count as usize).min(NEAR)].iter().copied());
        let mut next = head.near[0].next;
        while next != 0 {
            let fragment = self.stored[next as usize - 1];
            next = fragment.next;
            list.push(fragment);
        }
    }

    /// Forgets the fragments of a pixel.
    pub(super) fn drop(&mut self, at: usize) {
        self.places[at] = 0;
    }
}
