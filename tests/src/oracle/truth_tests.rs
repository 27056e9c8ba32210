//! The true picture: gaps by hand, the prescribed picture judged by it, and the time it takes.

use proptest::prelude::*;

use super::super::exact::{integer, ratio};
use super::super::{Vertex, draw};
use super::*;
use crate::harness::scenes;

/// A triangle over the whole of a 4 x 4 target, of depth `z` at x = 0 and `z + rise` 16 px to the right.
fn cover(z: u32, rise: u32) -> Primitive {
    Primitive::Triangle([Vertex::at(0, 0, z), Vertex::at(4096, 0, z + rise), Vertex::at(0, 4096, z)])
}

fn scene(size: i32, depth: u32, count: usize) -> impl Strategy<Value = Vec<Primitive>> {
    let vertex = (0..size, 0..size, 0..depth).prop_map(|(x, y, z)| Vertex::at(x, y, z));
    let triangle = prop::array::uniform3(vertex).prop_map(Primitive::Triangle);
    prop::collection::vec(triangle, count)
}

#[test]
fn draw_true_nearer_by_a_fraction_of_a_step_wins_and_is_ambiguous() {
    // At pixel i the second is at 10 + (i + 1/2) / 16: behind 10, in front of 11.
    let image =
        draw_true(4, 4, &[cover(11, 0), cover(10, 1), cover(10, 0)], DepthFormat::default(), DepthFunction::Less);

    assert_eq!(image.winner, [Some(2); 16]);
    assert_eq!(image.runner_up, [Some(1); 16]);
    assert_eq!(image.gap_in_steps[..4], [1.0 / 32.0, 3.0 / 32.0, 5.0 / 32.0, 7.0 / 32.0]);
    assert_eq!(image.ambiguous, [true; 16]);
}

#[test]
fn draw_true_one_step_apart_is_ambiguous_two_are_not() {
    let format = DepthFormat::default();
    let one = draw_true(1, 1, &[cover(4, 0), cover(5, 0)], format, DepthFunction::Less);
    let two = draw_true(1, 1, &[cover(4, 0), cover(6, 0)], format, DepthFunction::Less);
    let background = draw_true(1, 1, &[cover(format.greatest() - 1, 0)], format, DepthFunction::Less);

    assert_eq!([one.ambiguous[0], two.ambiguous[0], background.ambiguous[0]], [true, false, true]);
    assert_eq!([one.gap_in_steps[0], two.gap_in_steps[0], background.gap_in_steps[0]], [1.0, 2.0, 1.0]);
}

#[test]
fn draw_true_functions_pick_and_measure_as_documented() {
    let scene = [cover(40, 0), cover(30, 0), cover(30, 0), cover(35, 0)];
    let format = DepthFormat::default();
    let far = f64::from(format.greatest());
    let outcome = DepthFunction::ALL.map(|function| {
        let image = draw_true(1, 1, &scene, format, function);
        (image.winner[0], image.runner_up[0], image.gap_in_steps[0])
    });

    assert_eq!(
        outcome,
        [
            (None, None, f64::INFINITY),
            (Some(1), Some(2), 0.0),
            (None, None, far - 40.0),
            (Some(2), Some(1), 0.0),
            (None, Some(0), far - 40.0),
            (Some(3), None, 0.0),
            (None, Some(0), far - 40.0),
            (Some(3), None, f64::INFINITY),
        ]
    );
}

#[test]
fn judge_false_winners_are_measured() {
    let scene = [cover(10, 0), cover(11, 0), cover(14, 0), Primitive::Point(Vertex::at(9999, 0, 0))];
    let image = draw_true(2, 2, &scene, DepthFormat::default(), DepthFunction::Less);

    let verdict = image.judge(&scene, &[Some(0), Some(1), Some(2), Some(3)], &integer(1));

    assert_eq!((verdict.same, verdict.within, verdict.wrong, verdict.uncovered), (1, 1, 2, 1));
    assert_eq!(verdict.largest_loss, integer(4));
    assert_eq!(verdict.first_wrong, Some((0, 1)));
}

/// Winner, depth, runner-up, gap, ambiguous.
type Parts = (Option<u32>, Fraction, Option<u32>, f64, bool);

/// Everything of a picture, pixel by pixel, in a form that can be compared.
fn parts(image: &TrueImage) -> Vec<Parts> {
    let TrueImage { winner, depth, runner_up, gap_in_steps, ambiguous, .. } = image;
    let pixel = |k: usize| (winner[k], depth[k], runner_up[k], gap_in_steps[k], ambiguous[k]);
    (0..winner.len()).map(pixel).collect()
}

#[test]
fn draw_true_coincident_planes_in_other_triangles_are_told_apart_exactly() {
    // One plane, z = x / 3 + y / 7 steps, as triangles of many sizes, and the same one least fraction nearer or farther.
    let scene: Vec<Primitive> = (1..40)
        .map(|k: i32| {
            let z = |x: i32, y: i32| ((x + 21 * 8192) / 21 * 7 + y / 7 * 3 + k % 3) as u32;
            let [a, b, c] = [(-21 * k, -7 * k), (21 * 900 + 42 * k, -14 * k), (-42 * k, 7 * 2000 + 7 * k)];
            Primitive::Triangle([a, b, c].map(|(x, y)| Vertex::at(x, y, z(x, y))))
        })
        .collect();
    for function in DepthFunction::ALL {
        let fast = draw_true(40, 30, &scene, DepthFormat::default(), function);
        let plain = draw_true_plain(40, 30, &scene, DepthFormat::default(), function);

        assert_eq!(parts(&fast), parts(&plain), "{function:?}");
    }
}

proptest! {
    #[test]
    fn draw_true_any_scene_equals_the_plain_form(
        pieces in scenes::scene([70, 41], 24, 20), bits in 0usize..3, function in 0usize..8,
    ) {
        let (format, function) = (DepthFormat { bits: [16, 24, 31][bits], fraction: 24 }, DepthFunction::ALL[function]);
        // Drawn over and over: ties everywhere, and more than one thread's worth of work.
        let scene: Vec<Primitive> = (0..5).flat_map(|_| scenes::primitives(&pieces)).collect();

        let fast = draw_true(70, 41, &scene, format, function);
        let plain = draw_true_plain(70, 41, &scene, format, function);

        prop_assert_eq!(parts(&fast), parts(&plain));
    }

    #[test]
    fn draw_any_scene_loses_no_more_than_its_rounding(scene in scene(2048, 1 << 10, 12)) {
        let format = DepthFormat { bits: 16, fraction: 16 };
        let truth = draw_true(8, 8, &scene, format, DepthFunction::Less);
        let image = draw(8, 8, &scene, format, DepthFunction::Less);

        // 1/2 step for each of the two, and 17 roundings of 2^-17 for the 8 + 8 pixels and the reference.
        let verdict = truth.judge(&scene, &image.winner, &(integer(1) + ratio(2 * 17, 1 << 17)));

        prop_assert_eq!(verdict.wrong, 0, "{:?}", verdict);
    }

    #[test]
    fn draw_unambiguous_pixels_have_the_true_winner(scene in scene(2048, 1 << 24, 12)) {
        let format = DepthFormat::default();
        let truth = draw_true(8, 8, &scene, format, DepthFunction::Less);
        let image = draw(8, 8, &scene, format, DepthFunction::Less);

        // A gap of exactly one step plus the drift is left to the test above.
        let clear = (0..64).filter(|&pixel| truth.gap_in_steps[pixel] > 1.01);

        for pixel in clear {
            prop_assert_eq!(image.winner[pixel], truth.winner[pixel]);
        }
    }

    #[test]
    fn draw_true_less_winner_is_the_nearest_cover(scene in scene(2048, 64, 10)) {
        let image = draw_true(8, 8, &scene, DepthFormat::default(), DepthFunction::Less);

        for pixel in 0..64i32 {
            let (i, j) = (pixel % 8, pixel / 8);
            let mut depths: Vec<_> = (0u32..).zip(&scene).filter(|(_, p)| covers(p, i, j))
                .map(|(index, p)| (TrueDepth::new(p).unwrap().at(i, j).to_rational(), index)).collect();
            depths.sort();
            prop_assert_eq!(image.winner[pixel as usize], depths.first().map(|d| d.1));
            prop_assert_eq!(image.runner_up[pixel as usize], depths.get(1).map(|d| d.1));
        }
    }
}
