//! Lines: drawn by hand in all octants, at the corners of diamonds, and against a second definition.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use proptest::prelude::*;

use super::super::super::exact::{integer, ratio};
use super::*;

fn line(from: (i32, i32), to: (i32, i32)) -> [Vertex; 2] {
    [from, to].map(|(x, y)| Vertex::at(x, y, 0))
}

/// The line between the centres of two pixels.
fn between_centres(from: (i32, i32), to: (i32, i32)) -> [Vertex; 2] {
    line((from.0 * 256 + 128, from.1 * 256 + 128), (to.0 * 256 + 128, to.1 * 256 + 128))
}

/// The drawn pixels of `-2..8` squared, sorted.
fn pixels(line: &[Vertex; 2]) -> Vec<(i32, i32)> {
    (-2..8).flat_map(|i| (-2..8).map(move |j| (i, j))).filter(|&(i, j)| line_covers(line, i, j)).collect()
}

/// The rule with a small number for e, and with the diamond as a distance: the least `|a| + |b|` on the segment,
/// which is convex and piecewise linear, is found at an end or where a or b changes sign.
fn covers_by_distance(line: &[Vertex; 2], i: i32, j: i32) -> bool {
    let e = ratio(1, 1 << 60);
    let shift = [e.clone(), &e * &e];
    let [start, end] = line.map(|v| {
        [
            ratio(v.x.into(), 1) - &shift[0] - ratio(i128::from(i) * 256 + 128, 1),
            ratio(v.y.into(), 1) - &shift[1] - ratio(i128::from(j) * 256 + 128, 1),
        ]
    });
    let at = |t: &BigRational, axis: usize| &start[axis] + t * (&end[axis] - &start[axis]);
    let distance = |t: &BigRational| at(t, 0).abs() + at(t, 1).abs();
    let zeros = [0, 1]
        .into_iter()
        .filter(|&axis| start[axis] != end[axis])
        .map(|axis| -&start[axis] / (&end[axis] - &start[axis]));
    let unit = BigRational::zero()..=BigRational::one();
    let least =
        zeros.filter(|t| unit.contains(t)).chain([BigRational::zero(), BigRational::one()]).map(|t| distance(&t)).min();
    least < Some(integer(128)) && distance(&BigRational::one()) >= integer(128)
}

#[test]
fn line_covers_axis_lines_between_centres_leave_the_end_out() {
    assert_eq!(pixels(&between_centres((0, 0), (3, 0))), [(0, 0), (1, 0), (2, 0)]);
    assert_eq!(pixels(&between_centres((3, 0), (0, 0))), [(1, 0), (2, 0), (3, 0)]);
    assert_eq!(pixels(&between_centres((0, 0), (0, 3))), [(0, 0), (0, 1), (0, 2)]);
    assert_eq!(pixels(&between_centres((0, 3), (0, 0))), [(0, 1), (0, 2), (0, 3)]);
}

#[test]
fn line_covers_diagonals_between_centres_take_no_neighbour() {
    assert_eq!(pixels(&between_centres((0, 0), (3, 3))), [(0, 0), (1, 1), (2, 2)]);
    assert_eq!(pixels(&between_centres((3, 3), (0, 0))), [(1, 1), (2, 2), (3, 3)]);
    assert_eq!(pixels(&between_centres((0, 3), (3, 0))), [(0, 3), (1, 2), (2, 1)]);
    assert_eq!(pixels(&between_centres((3, 0), (0, 3))), [(1, 2), (2, 1), (3, 0)]);
}

// Slopes of 1/2: at every other pixel the line passes exactly through a corner of two diamonds. Moved by (-e, -e^2), a
// line that falls to the right is e/2 lower at the same x, one that rises to the right e/2 higher, and a steep one lies
// to the left. Each pair is one octant, there and back.

#[test]
fn line_covers_half_slope_right_down_takes_the_lower_of_tied_pixels() {
    assert_eq!(pixels(&between_centres((0, 0), (4, 2))), [(0, 0), (1, 1), (2, 1), (3, 2)]);
    assert_eq!(pixels(&between_centres((4, 2), (0, 0))), [(1, 1), (2, 1), (3, 2), (4, 2)]);
}

#[test]
fn line_covers_half_slope_right_up_takes_the_upper_of_tied_pixels() {
    assert_eq!(pixels(&between_centres((0, 2), (4, 0))), [(0, 2), (1, 1), (2, 1), (3, 0)]);
    assert_eq!(pixels(&between_centres((4, 0), (0, 2))), [(1, 1), (2, 1), (3, 0), (4, 0)]);
}

#[test]
fn line_covers_steep_right_down_takes_the_left_of_tied_pixels() {
    assert_eq!(pixels(&between_centres((0, 0), (2, 4))), [(0, 0), (0, 1), (1, 2), (1, 3)]);
    assert_eq!(pixels(&between_centres((2, 4), (0, 0))), [(0, 1), (1, 2), (1, 3), (2, 4)]);
}

#[test]
fn line_covers_steep_left_down_takes_the_left_of_tied_pixels() {
    assert_eq!(pixels(&between_centres((2, 0), (0, 4))), [(0, 3), (1, 1), (1, 2), (2, 0)]);
    assert_eq!(pixels(&between_centres((0, 4), (2, 0))), [(0, 3), (0, 4), (1, 1), (1, 2)]);
}

// The four corners of the diamond of pixel (1, 1), whose centre is (384, 384). Only the right corner is its own: the
// point moves left, into the diamond. The others move out of it; the left corner is the right corner of (0, 1).

#[test]
fn in_diamond_corners_only_the_right_one_belongs() {
    let corners = [(512, 384), (256, 384), (384, 256), (384, 512)];

    let inside = corners.map(|(x, y)| in_diamond(&Vertex::at(x, y, 0), [384, 384]));

    assert_eq!(inside, [true, false, false, false]);
}

#[test]
fn in_diamond_sides_only_the_right_two_belong() {
    let sides = [(448, 320), (448, 448), (320, 320), (320, 448)];

    let inside = sides.map(|(x, y)| in_diamond(&Vertex::at(x, y, 0), [384, 384]));

    assert_eq!(inside, [true, true, false, false]);
}

#[test]
fn line_covers_ending_at_the_right_corner_stays_in_the_diamond() {
    assert_eq!(pixels(&line((640, 384), (512, 384))), [(2, 1)]);
    assert_eq!(pixels(&line((384, 384), (512, 384))), []);
}

#[test]
fn line_covers_starting_at_the_right_corner_leaves_the_diamond() {
    assert_eq!(pixels(&line((512, 384), (640, 384))), [(1, 1)]);
    assert_eq!(pixels(&line((512, 384), (640, 640))), [(1, 1)]);
}

#[test]
fn line_covers_ending_at_the_left_corner_has_left_the_diamond() {
    assert_eq!(pixels(&line((384, 384), (256, 384))), [(1, 1)]);
    assert_eq!(pixels(&line((256, 384), (384, 384))), [(0, 1)]);
}

#[test]
fn line_covers_at_the_lower_corner_belongs_to_the_pixel_below_or_to_none() {
    // The lower corner of (1, 1) moves left past both it and the upper corner of (1, 2): into neither diamond.
    assert_eq!(pixels(&line((384, 384), (384, 512))), [(1, 1)]);
    assert_eq!(pixels(&line((384, 512), (384, 384))), []);
    assert_eq!(pixels(&line((384, 512), (384, 640))), []);
    assert_eq!(pixels(&line((384, 640), (384, 512))), [(1, 2)]);
}

#[test]
fn line_covers_touching_a_corner_in_passing_follows_the_shift() {
    // Horizontal through the lower corners of row 1 (y = 512): moves up, into row 1. Vertical through the right
    // corners of column 1 (x = 512): moves left, into column 1.
    assert_eq!(pixels(&line((256, 512), (1024, 512))), [(1, 1), (2, 1), (3, 1)]);
    assert_eq!(pixels(&line((512, 256), (512, 1024))), [(1, 1), (1, 2), (1, 3)]);
}

#[test]
fn line_covers_length_zero_draws_nothing() {
    let points = [(384, 384), (512, 384), (256, 256), (448, 448)];

    assert_eq!(points.map(|p| pixels(&line(p, p))), [const { Vec::new() }; 4]);
}

#[test]
fn line_covers_closed_square_draws_each_pixel_once() {
    let corners = [(0, 0), (4, 0), (4, 4), (0, 4)];

    let mut drawn: Vec<_> = (0..4).flat_map(|k| pixels(&between_centres(corners[k], corners[(k + 1) % 4]))).collect();
    drawn.sort_unstable();

    let rim = |&(i, j): &(i32, i32)| i == 0 || i == 4 || j == 0 || j == 4;
    let expected: Vec<_> = (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).filter(rim).collect();
    assert_eq!(drawn, expected);
}

#[test]
fn visit_sixteen_thousand_pixels_with_a_rise_of_one_has_one_step() {
    let mut rows = [0; 3];
    let mut columns = vec![0; 16384];

    visit(&between_centres((0, 0), (16384, 1)), 16384, 3, &mut |i, j| {
        rows[j as usize] += 1;
        columns[i as usize] += 1;
    });

    // The line crosses y = 256 at the centre of column 8192, falling: the tie goes to the lower row.
    assert_eq!(rows, [8192, 8192, 0]);
    assert_eq!(columns, vec![1; 16384]);
}

proptest! {
    #[test]
    fn line_covers_any_line_equals_the_distance(
        x0 in 0i32..1024, y0 in 0i32..1024, x1 in 0i32..1024, y1 in 0i32..1024, coarse in 0u32..8, i in 0i32..4, j in 0i32..4,
    ) {
        // Coarse coordinates hit corners and sides of diamonds often.
        let snap = |v: i32| v >> coarse << coarse;
        let line = line((snap(x0), snap(y0)), (snap(x1), snap(y1)));

        prop_assert_eq!(line_covers(&line, i, j), covers_by_distance(&line, i, j));
    }

    #[test]
    fn line_covers_split_line_draws_the_same_pixels_once(
        x in 0i32..700, y in 0i32..700, dx in -90i32..90, dy in -90i32..90, first in 1i32..8, second in 1i32..8,
    ) {
        let at = |k: i32| (x + dx * k, y + dy * k);
        let mut parts = pixels(&line(at(0), at(first)));
        parts.extend(pixels(&line(at(first), at(first + second))));
        parts.sort_unstable();

        prop_assert_eq!(parts, pixels(&line(at(0), at(first + second))));
    }

    #[test]
    fn line_covers_shifted_by_whole_pixels_is_shifted(
        x0 in 0i32..1024, y0 in 0i32..1024, x1 in 0i32..1024, y1 in 0i32..1024,
    ) {
        let shifted = line((x0 + 256, y0 - 256), (x1 + 256, y1 - 256));
        let expected: Vec<_> = pixels(&line((x0, y0), (x1, y1))).into_iter().map(|(i, j)| (i + 1, j - 1)).collect();

        prop_assert_eq!(pixels(&shifted), expected);
    }
}
