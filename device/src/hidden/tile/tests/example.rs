//! The worked example of [`crate::hidden::tile`], step by step, and small scenes with known costs.

use super::scenes::{Made, Picture, Scene, closed_form, grid, scene, target};
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::held::HeldDraw;
use crate::hidden::tile::closed_form::{PixelCounts, pixels_of_tile};
use crate::hidden::tile::extent::Extent;
use crate::hidden::tile::link::{EMPTY, END, Walked};
use crate::hidden::tile::scene::draw_scene;
use crate::hidden::tile::storage::Storage;
use crate::hidden::tile::x_sort::XSort;
use crate::hidden::tile::y_sort::YSort;
use crate::hidden::tile::{SortCounts, charge};
use crate::hidden::z_buffer::DepthTest;
use crate::probe::account::{Account, Clocks};
use crate::shading::plane::Interpolation;
use zga_abi::Counter;
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::Rectangle;

const DRAW: HeldDraw = HeldDraw {
    test: Some(DepthTest::LESS),
    interpolation: Interpolation::Flat,
    shading: None,
    scissor: Rectangle { x: 0, y: 0, right: 24, bottom: 16 },
    stencil: None,
};

fn corner(x: i32, y: i32, z: u32) -> ScreenVertex {
    ScreenVertex { x: x * PIXEL, y: y * PIXEL, z, colour: 0xFF00_0000 | z, reciprocal_w: 1.0 }
}

fn triangle(corners: [[i32; 2]; 3], z: u32) -> Made {
    Made::Triangle(corners.map(|[x, y]| corner(x, y, z)))
}

/// Triangles 0 and 1 of the example on a target of 24 x 16 pixels.
fn example(with_depth: bool, background: [Option<u32>; 2]) -> Scene {
    let target = target([24, 16], [8, 8], PixelFormat::Argb8888, DepthFormat::default(), with_depth);
    let first = triangle([[2, 1], [22, 2], [4, 7]], 9);
    let second = triangle([[9, 1], [12, 2], [10, 6]], 5);
    scene(target, &[(first, DRAW), (second, DRAW)], background)
}

#[test]
fn sorts_example_has_the_documented_states() {
    let scene = example(false, [None; 2]);
    let mut y_sort = YSort::new(grid(&scene));
    let mut x_sort = XSort::new(grid(&scene));
    let mut met = vec![];

    assert_eq!(y_sort.lists().index(), [EMPTY, EMPTY]);
    y_sort.insert(&scene.held.items[0], Extent::new(&scene.held, &scene.held.items[0]));
    assert_eq!((y_sort.lists().index(), y_sort.lists().link(0)), (&[0, EMPTY][..], END));
    y_sort.insert(&scene.held.items[1], Extent::new(&scene.held, &scene.held.items[1]));
    assert_eq!((y_sort.lists().index(), y_sort.lists().link(1)), (&[1, EMPTY][..], 0));
    assert_eq!(y_sort.bytes(), 8 + 144);

    x_sort.begin(y_sort.boundaries(0));
    let row = y_sort.walk(0, |address, polygon| {
        met.push(address);
        x_sort.insert(address, polygon);
    });
    assert_eq!(row, Walked { links: 2, removed: 2 });
    assert_eq!(met, [1, 0]);
    assert_eq!(x_sort.lists().index(), [0, 1, EMPTY]);

    met.clear();
    let tiles = [0, 1, 2].map(|column| x_sort.walk(column, y_sort.polygons(), |address, _| met.push(address)));
    let walked = |links, removed| Walked { links, removed };
    assert_eq!(tiles, [walked(1, 0), walked(2, 1), walked(1, 1)]);
    assert_eq!(met, [0, 0, 1, 0]);
    assert!(y_sort.is_empty_row(1));
}

#[test]
fn scene_example_costs_what_is_documented() {
    let scene = example(false, [None; 2]);
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    // No pixel of memory happens to hold a colour of the triangles: what differs was drawn.
    let drawn = picture.colour.iter().zip(&Picture::before(&scene.target).colour).filter(|(a, b)| a != b).count();
    assert_eq!(
        SortCounts { clocks: 0, spans: 0, ..counts },
        SortCounts {
            visited: 6,
            empty: 3,
            links_walked: 6,
            links_removed: 4,
            sort_memory_bytes: 164,
            fragments_not_stored: 2,
            colours: drawn as u64,
            ..SortCounts::default()
        }
    );
}

#[test]
fn scene_known_background_clocks_follow_from_lists_and_pixels() {
    let scene = example(false, [Some(0), Some(100)]);
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    // 2 insertions in Y; row 0: 1 + 2 links + 2 insertions, tile of 1 link: 1 + 4. Each later tile waits
    // for the 64 pixels of the one before, the last write-out for nothing.
    assert_eq!(counts.clocks, 2 + (5 + 5) + 5 * 64 + 64);
    assert_eq!([counts.colours, counts.reads, counts.writes], [384, 0, 0]);
}

#[test]
fn scene_z_buffer_without_clear_loads_and_stores_every_depth() {
    let scene = example(true, [None, None]);
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    assert_eq!([counts.reads, counts.writes], [384, 384]);
    // The load of a tile stands before its drawing, the store of the one before beside it.
    assert_eq!(counts.clocks, 2 + 6 * 64 + (5 + 5) + 5 * 64 + 64);
}

#[test]
fn scene_z_buffer_with_clear_only_stores() {
    let scene = example(true, [None, Some(7)]);
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    assert_eq!([counts.reads, counts.writes], [0, 384]);
}

#[test]
fn scene_of_nothing_does_nothing() {
    let mut scene = example(true, [None; 2]);
    scene.held.items.clear();
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    assert_eq!(counts, SortCounts::default());
    assert_eq!(picture, Picture::before(&scene.target));
    let functional =
        closed_form(&scene).finish(&scene.target, &scene.held.background, PixelCounts::default(), |_, _| 0);
    assert_eq!(functional, counts);
}

#[test]
fn scene_of_equal_depths_shows_the_earlier_for_less_and_the_later_for_less_equal() {
    let corners = [[0, 0], [24, 0], [0, 16]];
    for (equal, seen) in [(false, 1), (true, 2)] {
        let draw = HeldDraw { test: Some(DepthTest { equal, ..DepthTest::LESS }), ..DRAW };
        let made = |colour: u32| {
            let Made::Triangle(v) = triangle(corners, 5) else { unreachable!("a triangle") };
            Made::Triangle(v.map(|v| ScreenVertex { colour: 0xFF00_0000 | colour, ..v }))
        };
        let target = target([24, 16], [8, 8], PixelFormat::Argb8888, DepthFormat::default(), false);
        let scene = scene(target, &[(made(1), draw.clone()), (made(2), draw)], [Some(0), None]);
        let mut picture = Picture::before(&scene.target);
        let _ = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
        assert_eq!(picture.colour[0], PixelFormat::Argb8888.encode([seen, 0, 0, 255]));
    }
}

#[test]
fn scene_more_layers_than_pixels_of_a_tile_finds_room_for_each() {
    // 40 layers, each nearer than the one before, in tiles of 16 pixels: places of the hidden are free again.
    let target = target([24, 16], [4, 4], PixelFormat::Argb8888, DepthFormat::default(), false);
    let layers: Vec<_> = (0..40).map(|k| (triangle([[0, 0], [48, 0], [0, 32]], 100 - k), DRAW)).collect();
    let scene = scene(target, &layers, [None; 2]);
    let mut picture = Picture::before(&scene.target);
    let _ = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    // The last layer is at depth 61, and that is its red.
    assert_eq!(picture.colour[..24], [PixelFormat::Argb8888.encode([61, 0, 0, 255]); 24]);
}

#[test]
fn polygon_in_the_scissors_shadow_is_walked_in_its_row_and_not_linked() {
    // The bounding box meets the scissor, the triangle in row 1 of tiles does not.
    let target = target([32, 16], [8, 8], PixelFormat::Argb8888, DepthFormat::default(), false);
    let draw = HeldDraw { scissor: Rectangle { x: 24, y: 0, right: 32, bottom: 16 }, ..DRAW };
    let scene = scene(target, &[(triangle([[0, 0], [32, 0], [0, 16]], 5), draw)], [None; 2]);
    let mut picture = Picture::before(&scene.target);
    let counts = draw_scene(&scene.held, &scene.target, &mut picture.colour, &mut picture.depth);
    // Rows 0 and 1, and tile 3 of row 0.
    assert_eq!([counts.links_walked, counts.links_removed, counts.empty], [3, 2, 7]);
    assert_eq!(counts.fragments_not_stored, 0);
}

#[test]
fn charge_adds_every_count_and_both_accounts() {
    let counts = SortCounts {
        visited: 1,
        empty: 2,
        links_walked: 3,
        links_removed: 4,
        sort_memory_bytes: 5,
        fragments_not_stored: 6,
        spans: 7,
        reads: 8,
        writes: 9,
        colours: 10,
        shaded: 11,
        clocks: 12,
        ..SortCounts::default()
    };
    let mut account = Account::default();
    charge(&counts, &mut account);
    use Counter as C;
    let counters = [
        C::TileVisited,
        C::TileEmpty,
        C::TileLinksWalked,
        C::TileLinksRemoved,
        C::TileSortMemoryBytes,
        C::TileFragmentsNotStored,
        C::ZSpans,
        C::ZReads,
        C::ZWrites,
        C::ColourWrites,
        C::ShadingPixels,
        C::CyclesTile,
        C::CyclesShading,
    ];
    assert_eq!(counters.map(|counter| account.get(counter)), [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 11]);
    assert_eq!(account.total(), Clocks(23));
}

#[test]
fn storage_published_tile_adds_up() {
    let with_depth = |with_depth| target([24, 16], [8, 8], PixelFormat::Argb8888, DepthFormat::default(), with_depth);
    // 7 + 24 + 147 + 13 bits, 561 a polygon, 2 x 33 a pixel.
    let storage = Storage::new(&with_depth(false));
    assert_eq!(storage, Storage { comparators: 64, comparator_bits: 191, parameter_bytes: 4488, colour_bytes: 528 });
    assert_eq!(storage.register_bits(), 12_224);
    assert_eq!(Storage::new(&with_depth(true)).colour_bytes, 1040);
}

#[test]
fn pixels_of_tile_counts_bits_inside_only() {
    let plane = [0xFFFF, 0x0001, 0x8001, 0xFFFF];
    let area = |x, right, y, bottom| Rectangle { x, y, right, bottom };
    assert_eq!(pixels_of_tile(&plane, 2, &area(4, 8, 0, 1)), 4);
    assert_eq!(pixels_of_tile(&plane, 2, &area(0, 32, 0, 2)), 16 + 1 + 2 + 16);
    assert_eq!(pixels_of_tile(&plane, 2, &area(15, 17, 0, 2)), 2 + 2);
    assert_eq!(pixels_of_tile(&plane, 2, &area(16, 19, 1, 2)), 3);
}
