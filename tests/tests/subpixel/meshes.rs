//! Random meshes, anti-aliased at borders alone: one picture and one count in every way the card can draw.

use super::borders::{Draws, SIZE, Way, both, drawn, in_every_way, specified, without_masks};
use proptest::prelude::*;
use zga_device::Kernel;
use zga_tests::harness::{Grid, Hidden, Order, Prediction, State, Subpixel};
use zga_tests::oracle::{DepthFunction, Primitive, Vertex};

fn hidden() -> impl Strategy<Value = Hidden> {
    let block = prop::sample::select(vec![[32, 1], [16, 2], [8, 4], [8, 8], [3, 5]]);
    let za = (block, prop::sample::select(Prediction::ALL.to_vec()));
    let za = za.prop_map(|(block, prediction)| Hidden { prediction, ..Hidden::za(block) });
    let tile = prop::sample::select(vec![4, 8, 16, 64]);
    let path = prop_oneof![
        2 => Just(Hidden::default()),
        1 => za,
        1 => (0_u32..16).prop_map(Hidden::systolic),
        1 => [tile.clone(), tile].prop_map(Hidden::tile),
    ];
    (path, any::<bool>()).prop_map(|(hidden, clocked)| if clocked { hidden.clocked() } else { hidden })
}

/// A place: on the target or near it; far beyond it; on a coarse raster, where edges lie on samples, centres and sides.
fn place() -> impl Strategy<Value = [i32; 2]> {
    let [width, height] = SIZE.map(|side| side as i32);
    let raster = (-1..=2 * width / 16, -1..=2 * height / 16).prop_map(|(x, y)| [x * 2048, y * 2048]);
    let fine = ([-40..=40_i32, -40..=40_i32], raster.clone()).prop_map(|(d, at)| [at[0] + d[0], at[1] + d[1]]);
    prop_oneof![
        4 => (-600..width * 256 + 600, -600..height * 256 + 600).prop_map(|(x, y)| [x, y]),
        1 => (-60_000..80_000_i32, -60_000..80_000_i32).prop_map(|(x, y)| [x, y]),
        2 => raster,
        1 => fine,
    ]
}

/// A vertex; few depths and colours, so that many agree.
fn vertex(alpha: u8) -> impl Strategy<Value = Vertex> {
    let depth = prop_oneof![2 => Just(70_000_u32), 1 => Just(70_001_u32), 3 => 0_u32..0x00FF_FFFF];
    let colour = prop_oneof![1 => Just([200, 90, 10]), 3 => any::<[u8; 3]>()];
    (place(), depth, colour, prop_oneof![6 => Just(255_u8), 1 => Just(alpha)])
        .prop_map(|([x, y], z, [r, g, b], a)| Vertex::at(x, y, z).coloured([r, g, b, a]))
}

/// Triangles over few vertices: of a net whose places are moved, some so far that it folds, or of any three; some turned
/// round, some twice.
fn mesh(alpha: u8) -> impl Strategy<Value = Vec<[Vertex; 3]>> {
    let loose = (prop::collection::vec(vertex(alpha), 4..9), prop::collection::vec([0_usize..64, 0..64, 0..64], 2..14));
    let loose = loose.prop_map(|(vertices, triples)| {
        let corner = |k: usize| vertices[k % vertices.len()];
        triples.into_iter().map(|triple| triple.map(corner)).collect::<Vec<_>>()
    });
    let corner = (-350..350_i32, -350..350_i32, 0_u32..0x00FF_FFFF, any::<[u8; 3]>());
    let slant = prop_oneof![1 => Just(false), 2 => Just(true)];
    let net = ([2_usize..7, 2_usize..7], [200..2500_i32, 200..2500_i32], [-3000..9000_i32, -3000..5000_i32]);
    let net = (net, prop::collection::vec(corner, 49), slant, prop::collection::vec(0_usize..36, 0..3));
    let net = net.prop_map(move |(([across, down], cell, [left, top]), corners, slants, missing)| {
        let at = |i: usize, j: usize| {
            let (dx, dy, z, [r, g, b]) = corners[j * 7 + i];
            let z = if slants { 1_000_000 + (i * 90_000 + j * 140_000) as u32 + z % 50_000 } else { z };
            let place = [left + i as i32 * cell[0] + dx, top + j as i32 * cell[1] + dy];
            Vertex::at(place[0], place[1], z).coloured([r, g, b, if i + j == 5 { alpha } else { 255 }])
        };
        let cells = (0..down - 1).flat_map(|j| (0..across - 1).map(move |i| (i, j)));
        let cells = cells.enumerate().filter(|(k, _)| !missing.contains(k));
        let halves = cells.flat_map(|(_, (i, j))| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            [[a, b, c], [c, b, d]]
        });
        halves.collect::<Vec<_>>()
    });
    let turns = prop::collection::vec(prop::option::weighted(0.08, any::<bool>()), 80);
    (prop_oneof![2 => net, 1 => loose], turns).prop_map(|(triangles, turns)| {
        let turned = |([a, b, c], turn): ([Vertex; 3], Option<bool>)| match turn {
            None => vec![[a, b, c]],
            Some(true) => vec![[b, a, c]],
            Some(false) => vec![[a, b, c], [b, c, a]],
        };
        triangles.into_iter().zip(turns).flat_map(turned).collect()
    })
}

/// A few meshes, each cut into draws; opaque, or some of them translucent.
fn draws(opaque: bool) -> impl Strategy<Value = Draws> {
    let function = prop_oneof![
        5 => Just(DepthFunction::Less),
        2 => Just(DepthFunction::LessEqual),
        1 => prop::sample::select(if opaque { vec![DepthFunction::Less] } else { DepthFunction::ALL.to_vec() }),
    ];
    let often = prop::bool::weighted;
    let scissor = prop::option::weighted(0.1, Just([3, 2, 61, 37]));
    let state = (function, often(0.85), often(0.9), often(if opaque { 0.0 } else { 0.3 }), often(0.3), scissor);
    let state = state.prop_map(|(function, gouraud, anti_alias, blend, perspective, scissor)| State {
        function,
        gouraud,
        anti_alias,
        blend,
        perspective: perspective && gouraud,
        scissor,
        ..State::default()
    });
    let alpha = if opaque { 255 } else { 120 };
    // Nearly always the second draw of a mesh is as the first.
    let part = (mesh(alpha), state.clone(), prop::option::weighted(0.2, state), 0_usize..40);
    let part = part.prop_map(|(triangles, first, second, cut)| {
        let primitives: Vec<Primitive> = triangles.into_iter().map(Primitive::Triangle).collect();
        let (before, after) = primitives.split_at(cut.min(primitives.len()));
        [(before.to_vec(), first), (after.to_vec(), second.unwrap_or(first))]
    });
    let depthless = often(0.15);
    (prop::collection::vec(part, 1..4), depthless).prop_map(|(parts, depthless)| {
        let draws = parts.into_iter().flatten().filter(|(triangles, _)| !triangles.is_empty());
        draws.map(|(triangles, state)| (triangles, State { depth_test: !depthless, ..state })).collect()
    })
}

fn setting() -> impl Strategy<Value = Subpixel> {
    (prop::sample::select(Grid::ALL.to_vec()), prop::sample::select(Order::ALL.to_vec()))
        .prop_map(|(grid, depth)| Subpixel { depth, ..Subpixel::on(grid) })
}

/// Every pixel code on some path, with some threads.
fn some_ways() -> impl Strategy<Value = Vec<Way>> {
    let kernels = Kernel::available();
    prop::collection::vec((hidden(), 1_usize..4), kernels.len()).prop_map(move |ways| {
        let ways = ways.into_iter().zip(&kernels);
        ways.map(|((hidden, threads), &kernel)| Way { hidden, kernel, threads }).collect()
    })
}

proptest! {
    #![proptest_config(super::cases(250))]

    #[test]
    fn run_any_meshes_at_borders_every_way_gives_one_picture_and_one_count(
        draws in draws(false), subpixel in setting(), ways in some_ways(), pool in prop::option::weighted(0.1, 1_u32..60),
    ) {
        let subpixel = Subpixel { pool: pool.unwrap_or(subpixel.pool), ..subpixel };
        in_every_way(&draws, subpixel.borders(), &ways)?;
    }

    #[test]
    fn run_any_opaque_meshes_at_borders_pixels_are_those_of_all_edges_or_the_paths(
        draws in draws(true), subpixel in setting(), ways in some_ways(),
    ) {
        let [all, borders] = both(subpixel);
        let (right, every) = in_every_way(&draws, all, &[])?;
        let (plain, _) = drawn(&without_masks(&draws), Subpixel::default(), specified());
        let (found, counted) = in_every_way(&draws, borders, &ways)?;

        for (k, pixel) in found.colour.iter().enumerate() {
            let of = [right.colour[k], plain.colour[k]];
            prop_assert!(of.contains(pixel), "pixel {}: {:08x}, must be one of {:08x?}", k, pixel, of);
        }
        prop_assert_eq!(&found.depth, &plain.depth);
        let [every, counted] = [every, counted].map(|events| events["subpixel.pixels_active"]);
        prop_assert!(counted <= every, "{} pixels active, {} with all edges", counted, every);
    }
}

#[test]
fn random_meshes_have_much_inside_them() {
    use proptest::strategy::ValueTree;
    // Otherwise the tests above would prove little: a tenth of the pixels that all edges make active, a third of the scenes.
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut every, mut some, mut inside) = (0, 0, 0);
    for _ in 0..60 {
        let draws = draws(false).new_tree(&mut runner).expect("meshes").current();
        let [all, borders] = both(Subpixel::on(Grid::Grid8x4)).map(|subpixel| drawn(&draws, subpixel, specified()).1);
        let [most, least] = [all, borders].map(|events| events["subpixel.pixels_active"]);
        (every, some) = (every + most, some + least);
        inside += u64::from(least < most);
    }
    let enough = 10 * (every - some) > every && 3 * inside > 60;
    assert!(enough, "{every} pixels active, {some} at borders; {inside} of 60 scenes differ");
}
