//! The card against the exact oracle, pixel by pixel, on random scenes; and against itself in every way it can run.
//!
//! A failing scene is shrunk and printed; proptest also prints the seed and keeps it beside this file. With `ZGA_LONG=1`
//! each property runs 40 times as many scenes: `ZGA_LONG=1 cargo test -p zga-tests --test differential`.

#[path = "differential/colour.rs"]
mod colour;
#[path = "differential/large.rs"]
mod large;

use num_rational::BigRational;
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;
use zga_device::Kernel;
use zga_tests::harness::scenes::{Piece, primitives, scene};
use zga_tests::harness::{Feed, Options, Pixels, Screen, State};
use zga_tests::oracle::depth::PrescribedDepth;
use zga_tests::oracle::exact::integer;
use zga_tests::oracle::{DepthFormat, DepthFunction, draw, draw_true};

/// Scenes for each property.
fn cases(short: u32) -> ProptestConfig {
    let long = std::env::var_os("ZGA_LONG").is_some();
    ProptestConfig {
        cases: if long { 40 * short } else { short },
        max_shrink_iters: 4000,
        // Writes the seed of a failure beside the source file, and says so.
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("failed"))),
        ..ProptestConfig::default()
    }
}

fn format() -> impl Strategy<Value = DepthFormat> {
    let bits = prop_oneof![Just(16), Just(24), Just(31)];
    let fraction = prop_oneof![Just(0), Just(8), Just(16), Just(24)];
    (bits, fraction).prop_map(|(bits, fraction)| DepthFormat { bits, fraction })
}

fn function() -> impl Strategy<Value = DepthFunction> {
    prop_oneof![4 => Just(DepthFunction::Less), 4 => (0_usize..8).prop_map(|k| DepthFunction::ALL[k])]
}

/// Widths around chunks of 16 and tiles of 64, and the degenerate ones.
fn size() -> impl Strategy<Value = [u32; 2]> {
    let side =
        || prop_oneof![Just(1), Just(15), Just(16), Just(17), Just(33), Just(64), Just(65), Just(80), 1_u32..150];
    [side(), side()]
}

fn kernel() -> impl Strategy<Value = Kernel> {
    prop::sample::select(Kernel::available())
}

#[derive(Clone, Debug)]
struct Scene {
    size: [u32; 2],
    format: DepthFormat,
    pieces: Vec<Piece>,
}

fn any_scene(most: usize) -> impl Strategy<Value = Scene> {
    (size(), format()).prop_flat_map(move |(size, format)| {
        scene(size, format.bits, most).prop_map(move |pieces| Scene { size, format, pieces })
    })
}

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn draw_any_scene_equals_the_oracle(
        scene in any_scene(120), function in function(), kernel in kernel(), piece in prop_oneof![Just(0_usize), 1_usize..40],
        rgb565 in any::<bool>(), fifo in any::<bool>(),
    ) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let options = Options {
            depth: format,
            kernel,
            pixels: if rgb565 { Pixels::Rgb565 } else { Pixels::Argb8888 },
            feed: if fifo { Feed::Fifo } else { Feed::Ring },
            ..Options::default()
        };
        let mut screen = Screen::new(width, height, &options);
        screen.clear_counts();

        screen.draw_ids(&primitives, &State { piece, ..State::with(function) });

        let image = draw(width, height, &primitives, format, function);
        let found = screen.read().against(&image);
        prop_assert!(found.none(), "{}", found);
        let counts = screen.counts();
        let sum = |values: &[u32]| values.iter().map(|&v| u64::from(v)).sum::<u64>();
        prop_assert_eq!((counts.reads, counts.writes), (sum(&image.layers), sum(&image.writes)));
    }

    #[test]
    fn draw_any_scene_without_depth_shows_the_last(scene in any_scene(60), kernel in kernel()) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let mut screen = Screen::new(width, height, &Options { depth: format, kernel, ..Options::default() });

        screen.draw_ids(&primitives, &State { depth_test: false, ..State::default() });

        let image = draw(width, height, &primitives, format, DepthFunction::Always);
        let picture = screen.read();
        prop_assert_eq!(picture.winners(), image.winner);
        prop_assert!(picture.depth.iter().all(|&z| z == format.greatest()), "a depth was written");
        prop_assert_eq!(picture.strays, 0);
    }

    #[test]
    fn draw_any_scene_depth_not_written_compares_with_the_clear(
        scene in any_scene(60), function in function(), kernel in kernel(),
    ) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let mut screen = Screen::new(width, height, &Options { depth: format, kernel, ..Options::default() });

        screen.draw_ids(&primitives, &State { write: false, ..State::with(function) });

        // Every fragment meets the clear depth: the last that passes against it stays.
        let mut expected = vec![None; (width * height) as usize];
        for (index, primitive) in (0..).zip(&primitives) {
            let image = draw(width, height, std::slice::from_ref(primitive), format, function);
            for (pixel, winner) in expected.iter_mut().zip(&image.winner) {
                *pixel = winner.map(|_| index).or(*pixel);
            }
        }
        let picture = screen.read();
        prop_assert_eq!(picture.winners(), expected);
        prop_assert!(picture.depth.iter().all(|&z| z == format.greatest()), "a depth was written");
    }

    #[test]
    fn draw_any_scene_scissored_equals_the_oracle_inside_and_nothing_outside(
        scene in any_scene(60), kernel in kernel(), corners in [0_u32..150, 0_u32..150, 0_u32..150, 0_u32..150],
    ) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let [left, top, right, bottom] = corners;
        let mut screen = Screen::new(width, height, &Options { depth: format, kernel, ..Options::default() });

        screen.draw_ids(&primitives, &State { scissor: Some(corners), ..State::default() });

        let mut image = draw(width, height, &primitives, format, DepthFunction::Less);
        for k in 0..width * height {
            if !(left..right).contains(&(k % width)) || !(top..bottom).contains(&(k / width)) {
                (image.winner[k as usize], image.depth[k as usize]) = (None, format.greatest());
            }
        }
        let found = screen.read().against(&image);
        prop_assert!(found.none(), "{}", found);
    }

    #[test]
    fn draw_any_scene_shows_no_surface_that_truth_hides_beyond_the_bound(scene in any_scene(60), kernel in kernel()) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let mut screen = Screen::new(width, height, &Options { depth: format, kernel, ..Options::default() });

        screen.draw_ids(&primitives, &State::default());

        // Two planes are each stored within 1/2 + bound of the truth; where both are limited to their vertices' range
        // they are closer still. The bound is the largest of the scene's on this target.
        let corners = [(0, 0), (width as i32, 0), (0, height as i32), (width as i32, height as i32)];
        let planes = primitives.iter().filter_map(|p| PrescribedDepth::new(p, format));
        let bound = planes.flat_map(|p| corners.map(|(i, j)| p.error_bound(i, j))).max();
        let allowed = integer(1) + integer(2) * bound.unwrap_or_else(|| BigRational::from_integer(0.into()));
        let truth = draw_true(width, height, &primitives, format, DepthFunction::Less);
        let verdict = screen.read().judged(&truth, &primitives, &allowed);
        prop_assert_eq!((verdict.wrong, verdict.uncovered), (0, 0), "{:?}", verdict);
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn draw_any_scene_every_kernel_piece_and_feed_is_identical(scene in any_scene(100), function in function()) {
        let Scene { size: [width, height], format, pieces } = scene;
        let primitives = primitives(&pieces);
        let ways = Kernel::available().into_iter().flat_map(|kernel| {
            [(kernel, 0, Feed::Ring), (kernel, 1, Feed::Fifo), (kernel, 7, Feed::Ring)]
        });
        let mut pictures = ways.map(|(kernel, piece, feed)| {
            let options = Options { depth: format, kernel, feed, ..Options::default() };
            let mut screen = Screen::new(width, height, &options);
            screen.clear_counts();
            screen.draw_ids(&primitives, &State { piece, ..State::with(function) });
            (screen.read(), screen.counts())
        });

        let first = pictures.next();
        for other in pictures {
            prop_assert!(first.as_ref() == Some(&other), "{:?} and {:?}", first.as_ref().map(|f| f.1), other.1);
        }
    }
}
