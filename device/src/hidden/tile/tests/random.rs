//! Random scenes: the structural model against the plain Z buffer, the functional model against both sorts.

use super::scenes::{Picture, Scene, closed_form, grid, reference, scenes};
use crate::geometry::assembly::Shape;
use crate::hidden::held::{Held, Item};
use crate::hidden::tile::closed_form::{PixelCounts, pixels_of_tile};
use crate::hidden::tile::extent::Extent;
use crate::hidden::tile::scene::draw_scene;
use crate::hidden::tile::x_sort::XSort;
use crate::hidden::tile::y_sort::YSort;
use crate::hidden::z_buffer::specification::meets;
use proptest::prelude::*;
use zga_firmware::checked::Rectangle;

/// What both sorts do with a scene: the polygons of each tile, row by row, and links walked and removed.
struct Sorted {
    tiles: Vec<Vec<u32>>,
    /// Item of each polygon stored.
    items: Vec<usize>,
    walked: u64,
    removed: u64,
}

/// Runs both sorts without pixels.
fn sorted(scene: &Scene) -> Sorted {
    let grid = grid(scene);
    let mut y_sort = YSort::new(grid);
    let mut items = vec![];
    for (number, item) in scene.held.items.iter().enumerate() {
        y_sort.insert(item, Extent::new(&scene.held, item));
        if y_sort.polygons().len() > items.len() {
            items.push(number);
        }
    }
    let mut x_sort = XSort::new(grid);
    let mut sorted = Sorted { tiles: vec![], items, walked: 0, removed: 0 };
    let [columns, rows] = grid.tiles();
    for row in 0..rows {
        x_sort.begin(y_sort.boundaries(row));
        let walked = y_sort.walk(row, |address, polygon| x_sort.insert(address, polygon));
        sorted.walked += walked.links;
        sorted.removed += walked.removed;
        for column in 0..columns {
            let mut list = vec![];
            let walked = x_sort.walk(column, y_sort.polygons(), |address, _| list.push(address));
            sorted.walked += walked.links;
            sorted.removed += walked.removed;
            sorted.tiles.push(list);
        }
    }
    sorted
}

/// Whether something of an item may be seen in a tile.
fn draws_in(held: &Held, item: &Item, tile: &Rectangle) -> bool {
    let (area, shape): (_, Option<&Shape>) = match item {
        Item::Primitive(shape, draw) => (held.draws[*draw as usize].scissor, Some(shape)),
        Item::Clear { area, .. } => (*area, None),
    };
    let mut rows = tile.y.max(area.y)..tile.bottom.min(area.bottom);
    rows.any(|y| {
        let mut columns = tile.x.max(area.x)..tile.right.min(area.right);
        columns.any(|x| shape.is_none_or(|shape| meets(shape, x as i32, y as i32)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn scene_random_equals_plain_z_buffer_and_closed_form(scene in scenes(70, 14)) {
        let expected = reference(&scene);
        let mut picture = Picture::before(&scene.target);
        let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
        prop_assert_eq!(&picture, &expected.picture);
        let grid = grid(&scene);
        let won = |column: usize, row: usize| {
            pixels_of_tile(&expected.won, expected.pitch, &grid.pixels(column, row))
        };
        let functional = closed_form(&scene).finish(&scene.target, &scene.held.background, expected.pixels, won);
        prop_assert_eq!(counts, functional);
    }

    #[test]
    fn sorts_random_meet_what_draws_once_in_order_of_arrival(scene in scenes(90, 20)) {
        let sorted = sorted(&scene);
        let grid = grid(&scene);
        let columns = grid.tiles()[0];
        for (tile, list) in sorted.tiles.iter().enumerate() {
            prop_assert!(list.is_sorted_by(|a, b| a < b), "{:?}", list);
            let pixels = grid.pixels(tile % columns, tile / columns);
            let linked: Vec<usize> = list.iter().map(|&address| sorted.items[address as usize]).collect();
            for (number, item) in scene.held.items.iter().enumerate() {
                let lost = draws_in(&scene.held, item, &pixels) && !linked.contains(&number);
                prop_assert!(!lost, "item {} in tile {}", number, tile);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    // Sorts alone: many tiles, long edges, many polygons.
    #[test]
    fn sorts_large_target_equal_closed_form(scene in scenes(3000, 40)) {
        let sorted = sorted(&scene);
        let functional =
            closed_form(&scene).finish(&scene.target, &scene.held.background, PixelCounts::default(), |_, _| 0);
        // A scene of nothing does nothing.
        let all = sorted.tiles.len() as u64 * u64::from(functional.visited != 0);
        let empty = sorted.tiles.iter().filter(|list| list.is_empty()).count() as u64;
        prop_assert_eq!(functional.visited, all);
        prop_assert_eq!(functional.empty, empty.min(all));
        prop_assert_eq!(functional.links_walked, sorted.walked);
        prop_assert_eq!(functional.links_removed, sorted.removed);
    }
}
