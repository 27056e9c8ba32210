//! Translucent layers without a sub-pixel grid: order, modes, clears, on every path, exactly.

use super::bench::{any_way, chance, paths, pick, sheet, specified};
use super::{cases, seeds};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use zga_device::Kernel;
use zga_tests::harness::scenes::{Piece, piece};
use zga_tests::harness::screen::raw;
use zga_tests::harness::{Look, Options, Pixels, Random, Stage, State, Topology};
use zga_tests::oracle::effects::Corner;
use zga_tests::oracle::{DepthFunction, Primitive};

const SIZE: [u32; 2] = [37, 29];

/// A piece of a scene from a seed: any kind of primitive.
fn any_piece(random: &mut Random, bits: u32) -> Piece {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&random.bits().to_le_bytes());
    let mut runner = TestRunner::new_with_rng(Config::default(), TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    piece(SIZE, bits).new_tree(&mut runner).expect("a piece").current()
}

fn topology(primitive: &Primitive) -> Topology {
    match primitive {
        Primitive::Triangle(_) => Topology::Triangles,
        Primitive::Line(_) => Topology::Lines,
        Primitive::Point(_) => Topology::Points,
    }
}

/// The primitives in one colour each.
fn coloured(primitives: &[Primitive], random: &mut Random) -> Vec<(Topology, Vec<Corner>)> {
    let one = |primitive: &Primitive| {
        let alpha = pick(random, &[0, 1, 64, 128, 200, 254, 255, 255]);
        let colour = random.bits() as u32 & 0x00FF_FFFF | alpha << 24;
        let corner = |vertex| Corner { position: raw(vertex, 24, colour).position, colour, ..Corner::default() };
        (topology(primitive), primitive.vertices().iter().map(corner).collect())
    };
    primitives.iter().map(one).collect()
}

/// One draw, clear or both, the same for a seed.
fn step(stage: &mut Stage, seed: u64, piece: usize) {
    let mut random = Random::new(seed);
    let far = stage.screen.options().depth.greatest();
    if chance(&mut random, 8) {
        // What lies there is composed, and looked at no more.
        stage.clear_planes(None, Some(pick(&mut random, &[far, far / 2])), None);
    }
    if chance(&mut random, 5) {
        let [left, top] = SIZE.map(|side| random.range(0, i64::from(side)) as u32);
        let area = [left, top, left + random.range(0, 20) as u32, top + random.range(0, 20) as u32];
        stage.clear_planes(Some((random.bits() as u32).to_le_bytes()), Some(far), Some(area));
    }
    let blend = chance(&mut random, 75);
    let function = if chance(&mut random, 60) { DepthFunction::Less } else { pick(&mut random, &DepthFunction::ALL) };
    let state = State {
        blend,
        function,
        depth_test: chance(&mut random, 85),
        write: chance(&mut random, 85),
        scissor: chance(&mut random, 15).then(|| [3, 2, SIZE[0] - 5, SIZE[1] - 1]),
        look: Look { mode: random.range(0, 3) as u32, ..Look::default() },
        piece,
        ..State::default()
    };
    let primitives = any_piece(&mut random, 24).primitives();
    for (topology, corners) in coloured(&primitives, &mut random) {
        stage.draw(topology, &corners, &state);
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn draw_any_layers_any_way_equal_the_oracle(seeds in seeds(12)) {
        let mut random = Random::new(seeds[0]);
        let pixels = pick(&mut random, &[Pixels::Argb8888, Pixels::Argb8888, Pixels::Xrgb8888, Pixels::Rgb565]);
        let options = Options { pixels, ..any_way(&mut random) };
        let mut stage = Stage::new(SIZE, &options, &[]);
        for &seed in &seeds {
            step(&mut stage, seed, pick(&mut random, &[0, 0, 1, 3]));
        }

        let found = stage.compare();

        prop_assert!(found.right() && found.doubtful + found.drawn == 0, "{:?}: {}", options, found);
    }
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn draw_any_layers_every_way_counts_the_same(seeds in seeds(8)) {
        let reference = |options: &Options| {
            let mut stage = Stage::new(SIZE, options, &[]);
            stage.screen.clear_counts();
            seeds.iter().for_each(|&seed| step(&mut stage, seed, 0));
            let (picture, found, _) = stage.end();
            (picture, stage.screen.events().of_units(), found)
        };
        let mut pictures = Vec::new();
        for hidden in paths().into_iter().filter(|hidden| !hidden.clocked) {
            let (picture, events, found) = reference(&specified(hidden));
            prop_assert!(found.right(), "{:?}: {}", hidden, found);
            for (hidden, kernel, threads) in [(hidden.clocked(), Kernel::Specification, 1), (hidden, Kernel::Best, 3)] {
                let (other, counted, _) = reference(&Options { kernel, threads, ..specified(hidden) });
                prop_assert!(other == picture, "{:?} {:?}", hidden, kernel);
                prop_assert_eq!(counted.differences(&events), vec![], "{:?} {:?}", hidden, kernel);
            }
            let layers = ["layers.fragments", "layers.blended", "layers.sorted_pixels", "cycles.layers"];
            pictures.push((picture.colour, layers.map(|name| events[name])));
        }
        prop_assert!(pictures.iter().all(|other| *other == pictures[0]), "paths differ in colours or in counts of layers");
    }
}

#[test]
fn draw_sheets_count_fragments_blends_and_sorts() {
    // 12 pixels. Three sheets in no order, one of them behind the opaque.
    for hidden in paths() {
        let mut stage = Stage::new([4, 3], &specified(hidden), &[]);
        stage.screen.clear_counts();
        stage.triangles(&sheet([4, 3], 0.75, u32::MAX), &State::default());
        for (z, colour) in [(0.25, 0x8000_00FF), (0.5, 0x8000_FF00), (0.875, 0x80FF_0000)] {
            stage.triangles(&sheet([4, 3], z, colour), &State::blended(0));
        }

        let found = stage.compare();
        let events = stage.screen.events();

        assert!(found.right(), "{hidden:?}: {found}");
        let counted = ["layers.fragments", "layers.blended"].map(|name| events[name]);
        assert_eq!(counted, [36, 24], "{hidden:?}");
    }
}

#[test]
fn draw_alpha_255_that_is_known_is_opaque_and_stores_its_depth() {
    for hidden in paths() {
        let mut stage = Stage::new([4, 3], &specified(hidden), &[]);
        stage.screen.clear_counts();
        stage.triangles(&sheet([4, 3], 0.5, 0xFF00_00FF), &State::blended(0));
        stage.triangles(&sheet([4, 3], 0.75, 0x8000_FF00), &State::blended(0));

        let (picture, found, _) = stage.end();

        assert!(found.right(), "{hidden:?}: {found}");
        assert_eq!(picture.colour, [0xFFFF_0000; 12], "{hidden:?}");
        assert_eq!(stage.screen.events()["layers.blended"], 0, "{hidden:?}");
    }
}
