//! Lists of fragments: their order, what completes a pixel, how many there are.

use super::super::Setting;
use super::super::band::Input;
use super::super::grid::Grid;
use super::super::lists::{Fragment, Lists};
use super::super::scene::Scene;
use super::setting;

/// The mask of a pixel that is covered fully.
const FULL: u64 = Grid::G4X4.full();

/// Lists of a band of one line of 32 pixels, for so many fragments.
fn lists(pool: u32) -> Lists {
    let setting = Setting { pool, ..setting(Grid::G4X4, [32, 1]) };
    let mut lists = Lists::default();
    lists.begin(&Input {
        setting: &setting,
        scene: &Scene::default(),
        items: &[],
        edges: &[],
        surfaces: &[],
        top: 0,
        lines: 1,
    });
    lists
}

/// Pieces and masks of a pixel's fragments.
fn taken(lists: &mut Lists, at: usize) -> Vec<(u32, u64)> {
    let mut list = vec![Fragment::default()];
    lists.take(at, &mut list);
    list.iter().map(|fragment| (fragment.piece, fragment.mask)).collect()
}

#[test]
fn take_gives_a_pixels_fragments_the_last_first() {
    let mut lists = lists(100);
    assert!(lists.has_room(5));
    for (at, piece) in [(3, 0), (3, 1), (9, 2), (3, 3), (3, 4)] {
        lists.put(at, Fragment::new(1 << piece, piece, [0, 0]));
    }
    assert_eq!(taken(&mut lists, 3), [(4, 16), (3, 8), (1, 2), (0, 1)]);
    assert_eq!(taken(&mut lists, 3), [], "once");
    assert_eq!(taken(&mut lists, 9), [(2, 4)]);
    assert_eq!(taken(&mut lists, 4), []);
}

#[test]
fn put_opaque_masks_that_cover_a_pixel_lower_its_limit_to_the_farthest() {
    let (mut lists, mut limit) = (lists(100), 50);
    assert!(lists.has_room(6));
    let mut put = |mask, hides, far| {
        lists.put_opaque(0, Fragment::new(mask, 0, [far - 5, far]), [true, hides], FULL, &mut limit);
        limit
    };
    assert_eq!(put(0x00FF, true, 50), 50, "as far as the limit: hides nothing more");
    assert_eq!(put(0x00FF, true, 40), 50);
    assert_eq!(put(0xFF00, false, 10), 50, "hides nothing");
    assert_eq!(put(0xFF00, true, 30), 40, "complete");
    assert_eq!(put(0x00FF, true, 20), 40, "begun anew");
    assert_eq!(put(0xFF0F, true, 25), 25);
    assert_eq!(taken(&mut lists, 0).len(), 6);
}

#[test]
fn put_opaque_what_is_not_kept_leaves_nothing() {
    let (mut lists, mut limit) = (lists(100), 50);
    assert!(lists.has_room(2));
    lists.put_opaque(7, Fragment::new(0, 1, [0, 1]), [false, true], FULL, &mut limit);
    lists.put_opaque(7, Fragment::new(0, 2, [0, 1]), [true, true], FULL, &mut limit);
    assert_eq!((taken(&mut lists, 7), limit), (vec![(2, 0)], 50));
}

#[test]
fn has_room_more_than_the_pool_is_full_for_good() {
    let mut lists = lists(2);
    assert!(lists.has_room(2) && !lists.is_full());
    lists.put(0, Fragment::new(1, 0, [0, 0]));
    assert!(lists.has_room(1), "one is left");
    assert!(!lists.has_room(2), "not two");
    assert!(lists.is_full() && !lists.has_room(0));
}
