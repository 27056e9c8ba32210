//! Depth: planes by hand, the extremes, and the error bound under random planes.

use super::super::exact::ratio;
use super::super::raster::covers;
use super::*;
use num_traits::Signed;
use proptest::prelude::*;

const FRACTIONS: [u32; 4] = [0, 8, 16, 24];

fn triangle(points: [(i32, i32, u32); 3]) -> Primitive {
    Primitive::Triangle(points.map(|(x, y, z)| Vertex::at(x, y, z)))
}

#[test]
fn stored_hand_computed_plane_matches() {
    // z rises by 1 step for 3 pixels to the right and by 2 steps for 3 pixels down, from (0, 0) px.
    let primitive = triangle([(0, 0, 100), (3 * 256, 0, 101), (0, 3 * 256, 102)]);
    let depth = PrescribedDepth::new(&primitive, DepthFormat { bits: 24, fraction: 8 }).unwrap();

    // 256/3 = 85.33, 512/3 = 170.67; at the centre of (0, 0): 100 + 1/6 + 1/3 = 100.5, 25728 / 256.
    assert_eq!((depth.step_x, depth.step_y, depth.reference), (85, 171, 25728));
    // 100.5 goes up; 25813 / 256 = 100.83; (25728 + 85 + 171) / 256 = 101.5 goes up.
    assert_eq!([(0, 0), (1, 0), (1, 1)].map(|(i, j)| depth.stored(i, j)), [101, 101, 102]);
    assert_eq!(TrueDepth::new(&primitive).unwrap().at(1, 1), Fraction::new(203, 2));
}

#[test]
fn new_anchor_is_the_highest_vertex_and_of_a_level_pair_the_left() {
    let anchor = |points| {
        let depth = PrescribedDepth::new(&triangle(points), DepthFormat::default()).unwrap();
        (depth.anchor_x, depth.anchor_y)
    };

    assert_eq!(anchor([(-700, 800, 1), (900, -300, 2), (0, 0, 3)]), (3, -2));
    assert_eq!(anchor([(900, 256, 1), (511, 256, 2), (0, 700, 3)]), (1, 1));
    // The level of the anchor is that of the vertex, not of its pixel: y = 257 is below y = 256.
    assert_eq!(anchor([(0, 257, 1), (900, 256, 2), (0, 700, 3)]), (3, 1));
}

#[test]
fn stored_is_limited_to_the_vertices() {
    let primitive = triangle([(0, 0, 10), (256, 0, 20), (0, 256, 15)]);
    let depth = PrescribedDepth::new(&primitive, DepthFormat::default()).unwrap();

    assert_eq!([depth.stored(9, 9), depth.stored(-9, -9)], [20, 10]);
}

#[test]
fn stored_line_follows_the_major_axis_in_both_directions() {
    let ends = [Vertex::at(128, 128, 0), Vertex::at(4 * 256 + 128, 640, 40)];
    let format = DepthFormat::default();
    let depths = [ends, [ends[1], ends[0]]].map(|line| {
        let depth = PrescribedDepth::new(&Primitive::Line(line), format).unwrap();
        [0, 1, 2, 3, 4].map(|i| depth.stored(i, 77))
    });

    assert_eq!(depths, [[0, 10, 20, 30, 40]; 2]);
}

#[test]
fn stored_steep_line_counts_rows() {
    let line = Primitive::Line([Vertex::at(128, 5 * 256 + 128, 50), Vertex::at(300, 128, 0)]);
    let depth = PrescribedDepth::new(&line, DepthFormat::default()).unwrap();

    assert_eq!([0, 1, 3, 5].map(|j| depth.stored(-3, j)), [0, 10, 30, 50]);
}

#[test]
fn at_line_beyond_its_end_is_limited() {
    let line = Primitive::Line([Vertex::at(129, 128, 5), Vertex::at(200, 128, 9)]);

    let depths = [-1, 0, 1].map(|i| TrueDepth::new(&line).unwrap().at(i, 0));

    assert_eq!(depths, [5, 5, 9].map(Fraction::whole));
}

#[test]
fn new_nothing_to_draw_is_none() {
    let flat = triangle([(0, 0, 1), (5, 5, 2), (9, 9, 3)]);
    let dot = Primitive::Line([Vertex::at(3, 4, 1), Vertex::at(3, 4, 2)]);

    assert!([flat, dot].iter().all(|p| TrueDepth::new(p).is_none()));
    assert!([flat, dot].iter().all(|p| PrescribedDepth::new(p, DepthFormat::default()).is_none()));
}

#[test]
fn stored_flat_over_the_widest_target_is_constant() {
    let (far, z) = (16384 * 256, 0x7fff_fffe);
    let primitive = triangle([(0, 0, z), (far, 3, z), (77, far, z)]);

    let depths = FRACTIONS.map(|fraction| {
        let depth = PrescribedDepth::new(&primitive, DepthFormat { bits: 31, fraction }).unwrap();
        [0, 5000, 16383].map(|i| depth.interpolated(i, 16383 - i) >> fraction)
    });

    assert_eq!(depths, [[i128::from(z); 3]; 4]);
}

#[test]
fn stored_twice_area_of_one_stays_in_range() {
    // Twice-area 1 u^2, with its top left corner on a centre: a gradient of 2^86, past any 64-bit register.
    let corners = [(128, 128, 5), (129, 128, 0x7fff_ffff), (128 + (1 << 23), 129, 0)];
    let primitive = triangle(corners);
    let depth = PrescribedDepth::new(&primitive, DepthFormat { bits: 31, fraction: 24 }).unwrap();

    assert!(depth.step_y < -(1 << 85));
    assert!(covers(&primitive, 0, 0));
    assert_eq!(depth.interpolated(0, 0), 5 << 24);
    assert_eq!([(0, 0), (1, 0), (0, 1)].map(|(i, j)| depth.stored(i, j)), [5, 0x7fff_ffff, 0]);
}

#[test]
fn stored_coordinate_extremes_have_no_overflow() {
    let (low, high, z) = (i32::MIN, i32::MAX, 0x7fff_ffff);
    let wide = triangle([(low, low, 0), (high, low, z), (low, high, z)]);
    let depth = PrescribedDepth::new(&wide, DepthFormat { bits: 31, fraction: 24 }).unwrap();
    let truth = TrueDepth::new(&wide).unwrap();

    assert_eq!(depth.stored(i32::MIN / 256, i32::MIN / 256), 128);
    assert_eq!(truth.at(-1, -1).floor(), i128::from(z) - 128);
}

fn points(range: Range<i32>) -> impl Strategy<Value = [(i32, i32, u32); 3]> {
    prop::array::uniform3((range.clone(), range, 0u32..=0x7fff_ffff))
}

proptest! {
    #[test]
    fn interpolated_any_triangle_is_within_the_bound(
        points in points(-(1 << 23)..1 << 23), i in -32768i32..32768, j in -32768i32..32768, f in 0usize..4,
    ) {
        let primitive = triangle(points);
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };
        let (Some(depth), Some(truth)) = (PrescribedDepth::new(&primitive, format), TrueDepth::new(&primitive)) else {
            return Ok(());
        };

        let error = (ratio(depth.interpolated(i, j), 1 << FRACTIONS[f]) - truth.at(i, j).to_rational()).abs();

        prop_assert!(error <= depth.error_bound(i, j), "{error} > {}", depth.error_bound(i, j));
    }

    #[test]
    fn stored_covered_pixels_are_within_half_a_step_and_the_bound(
        points in points(-1024..1024), shrink in 0u32..10, f in 0usize..4,
    ) {
        // From 8 pixels down to 2 u, about the centre of pixel (4, 4).
        let primitive = triangle(points.map(|(x, y, z)| (1152 + (x >> shrink), 1152 + (y >> shrink), z)));
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };
        let planes = PrescribedDepth::new(&primitive, format).zip(TrueDepth::new(&primitive));

        for (i, j) in (0..81).map(|k| (k % 9, k / 9)).filter(|&(i, j)| covers(&primitive, i, j)) {
            let (depth, truth) = planes.unwrap();
            let error = (integer(depth.stored(i, j)) - truth.at(i, j).to_rational()).abs();
            prop_assert!(error <= depth.error_bound(i, j) + ratio(1, 2));
            // Why 64 wrapping bits are enough on the card.
            prop_assert!(i64::try_from(depth.interpolated(i, j)).is_ok());
        }
    }

    #[test]
    fn new_any_order_of_vertices_is_the_same(points in points(-(1 << 23)..1 << 23), f in 0usize..4) {
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };
        let [a, b, c] = points;
        let first = PrescribedDepth::new(&triangle(points), format);

        for order in [[a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
            prop_assert_eq!(PrescribedDepth::new(&triangle(order), format), first);
        }
    }

    #[test]
    fn stored_scene_shifted_by_pixels_is_the_same(
        points in points(-(1 << 20)..1 << 20), i in 0i32..99, j in 0i32..99, dx in -99i32..99, dy in -99i32..99,
    ) {
        let shifted = points.map(|(x, y, z)| (x + dx * 256, y + dy * 256, z));
        let format = DepthFormat { bits: 31, fraction: 16 };
        let stored = |points, i, j| PrescribedDepth::new(&triangle(points), format).map(|d| d.stored(i, j));

        prop_assert_eq!(stored(points, i, j), stored(shifted, i + dx, j + dy));
    }

    #[test]
    fn stored_all_depths_plus_k_is_plus_k(
        points in prop::array::uniform3((0i32..2048, 0i32..2048, 0u32..1 << 24)), k in 0u32..1 << 24, f in 0usize..4,
        i in 0i32..8, j in 0i32..8,
    ) {
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };
        let stored = |points| PrescribedDepth::new(&triangle(points), format).map(|d| d.stored(i, j));

        let expected = stored(points).map(|z| z + k);

        prop_assert_eq!(stored(points.map(|(x, y, z)| (x, y, z + k))), expected);
    }

    #[test]
    fn interpolated_any_line_is_within_the_bound(
        ends in prop::array::uniform2((-(1i32 << 23)..1 << 23, -(1i32 << 23)..1 << 23, 0u32..=0x7fff_ffff)),
        t in 0.0f64..1.0, f in 0usize..4,
    ) {
        let line = ends.map(|(x, y, z)| Vertex::at(x, y, z));
        let primitive = Primitive::Line(line);
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };
        let (Some(depth), Some(truth)) = (PrescribedDepth::new(&primitive, format), TrueDepth::new(&primitive)) else {
            return Ok(());
        };
        let along = |a: i32, b: i32| ((f64::from(a) + (f64::from(b) - f64::from(a)) * t) / 256.0) as i32;
        let (i, j) = (along(ends[0].0, ends[1].0), along(ends[0].1, ends[1].1));

        let error = (integer(depth.stored(i, j)) - truth.at(i, j).to_rational()).abs();

        prop_assert!(error <= depth.error_bound(i, j) + ratio(1, 2));
    }

    #[test]
    fn interpolated_short_lines_fit_64_bits(
        ends in prop::array::uniform2((0i32..768, 0i32..768, 0u32..=0x7fff_ffff)), shrink in 0u32..9, f in 0usize..4,
    ) {
        // Down to 1 u, about a corner that two diamonds share.
        let line = ends.map(|(x, y, z)| Vertex::at(512 + ((x - 384) >> shrink), 384 + ((y - 384) >> shrink), z));
        let primitive = Primitive::Line(line);
        let format = DepthFormat { bits: 31, fraction: FRACTIONS[f] };

        for (i, j) in (0..25).map(|k| (k % 5, k / 5)).filter(|&(i, j)| covers(&primitive, i, j)) {
            let depth = PrescribedDepth::new(&primitive, format).unwrap();
            prop_assert!(i64::try_from(depth.interpolated(i, j)).is_ok());
        }
    }
}

#[test]
fn stored_in_known_plane_is_the_written_sum() {
    // z = 1000 at the anchor's centre, 8 steps a pixel to the right, -4 down; a quarter pixel is 2 steps and -1.
    let plane = PrescribedDepth {
        anchor_x: 3,
        anchor_y: 2,
        reference: 1000 << 8,
        step_x: 8 << 8,
        step_y: -4 << 8,
        least: 0,
        greatest: 1005,
        fraction: 8,
    };

    let at = |i, j, u, v| plane.stored_in(i, j, [u, v]);

    assert_eq!([at(3, 2, 128, 128), at(3, 2, 192, 128), at(3, 2, 128, 64)], [1000, 1002, 1001]);
    // 1000 + 8 * 32/256 - 4 * 32/256 = 1000.5 goes up; one pixel on the plane is limited.
    assert_eq!([at(3, 2, 160, 160), at(3, 2, 96, 96), at(4, 2, 32, 32)], [1001, 1000, 1005]);
    // Without fraction bits there is no half step: the fraction is dropped.
    let coarse = PrescribedDepth { reference: 1000, step_x: 8, step_y: -4, fraction: 0, ..plane };
    assert_eq!([coarse.stored_in(3, 2, [160, 160]), coarse.stored_in(3, 2, [96, 96])], [1000, 999]);
}

proptest! {
    #[test]
    fn stored_in_the_centre_is_the_pixels_depth(
        xy in prop::array::uniform6(-700i32..1800), z in prop::array::uniform3(0u32..1 << 24), fraction in 0u32..4,
    ) {
        let primitive = Primitive::Triangle([0, 1, 2].map(|k| Vertex::at(xy[2 * k], xy[2 * k + 1], z[k])));
        let format = DepthFormat { bits: 24, fraction: 8 * fraction };
        let Some(plane) = PrescribedDepth::new(&primitive, format) else { return Ok(()) };

        for (i, j) in (0..16).map(|k| (k % 4, k / 4)) {
            prop_assert_eq!(plane.stored_in(i, j, [128, 128]), plane.stored(i, j));
        }
    }
}
