//! The exact clip: by hand, the awkward values of w, and against coverage decided without clipping or division.

use proptest::prelude::*;

use super::*;

fn triangle(vertices: [[f64; 4]; 3]) -> [Homogeneous; 3] {
    vertices.map(|v| Homogeneous::from_f64(v).unwrap())
}

fn positions(polygon: &ExactPolygon) -> Vec<[f64; 2]> {
    polygon.corners.iter().map(|c| [0, 1].map(|axis| c.position[axis].to_f64().unwrap())).collect()
}

/// How many of the polygons cover each pixel of an 8 x 8 target.
fn counts(polygons: &[ExactPolygon]) -> Vec<usize> {
    let mut counts = vec![0; 64];
    for polygon in polygons {
        polygon.for_each_pixel(8, 8, |i, j| counts[(j * 8 + i) as usize] += 1);
    }
    counts
}

#[test]
fn clip_inside_only_divides() {
    let polygon = clip(
        &triangle([[-2.0, -2.0, 1.0, 2.0], [4.0, -4.0, 1.0, 4.0], [-1.0, 1.0, 0.5, 1.0]]),
        &View::normalised(8, 8),
    );

    assert_eq!(positions(&polygon), [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]]);
    assert_eq!(polygon.corners[1].depth, ratio(1, 4));
    assert_eq!(polygon.corners[1].inverse_w, ratio(1, 4));
    assert_eq!(polygon.corners[2].weights, [integer(0), integer(0), integer(1)]);
}

#[test]
fn clip_near_plane_cuts_at_depth_zero() {
    // The third vertex is behind the near plane: two edges are cut half way before the divide.
    let polygon = clip(&triangle([[0.0, 0.0, 1.0, 1.0], [6.0, 0.0, 1.0, 1.0], [0.0, 6.0, -1.0, 1.0]]), &View::pixels());

    assert_eq!(positions(&polygon), [[0.0, 0.0], [6.0, 0.0], [3.0, 3.0], [0.0, 3.0]]);
    assert_eq!(polygon.corners[2].depth, integer(0));
    assert_eq!(polygon.corners[2].weights, [integer(0), ratio(1, 2), ratio(1, 2)]);
}

#[test]
fn clip_far_plane_cuts_only_when_asked() {
    let far = triangle([[0.0, 0.0, 0.5, 1.0], [4.0, 0.0, 0.5, 1.0], [0.0, 4.0, 1.5, 1.0]]);
    let cut = clip(&far, &View { far: true, ..View::pixels() });

    assert_eq!(positions(&clip(&far, &View::pixels())).len(), 3);
    assert_eq!(positions(&cut), [[0.0, 0.0], [4.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
}

#[test]
fn clip_behind_or_outside_is_empty() {
    let behind = triangle([[0.0, 0.0, -1.0, 1.0], [1.0, 0.0, -2.0, 1.0], [0.0, 1.0, -1.0, 1.0]]);
    let negative = triangle([[0.0, 0.0, 1.0, -1.0], [1.0, 0.0, 1.0, -1.0], [0.0, 1.0, 1.0, -1.0]]);
    let outside = triangle([[40000.0, 0.0, 1.0, 1.0], [50000.0, 0.0, 1.0, 1.0], [40000.0, 9.0, 1.0, 1.0]]);

    assert_eq!([behind, negative, outside].map(|t| clip(&t, &View::pixels()).corners.len()), [0; 3]);
}

#[test]
fn covers_rectangle_through_centres_keeps_left_and_top() {
    // From (1/2, 1/2) to (4 1/2, 3 1/2) pixels, with different w.
    let corners = [[0.5, 0.5, 0.5, 1.0], [9.0, 1.0, 0.5, 2.0], [0.5, 3.5, 0.5, 1.0], [18.0, 14.0, 0.5, 4.0]];

    let halves = [[0, 1, 2], [2, 1, 3]].map(|t| clip(&triangle(t.map(|k: usize| corners[k])), &View::pixels()));

    let expected: Vec<usize> = (0..64).map(|k| usize::from(k % 8 < 4 && k / 8 < 3)).collect();
    let asked: Vec<usize> = (0..64).map(|k| halves.iter().filter(|half| half.covers(k % 8, k / 8)).count()).collect();
    assert_eq!(counts(&halves), expected);
    assert_eq!(asked, expected);
}

#[test]
fn clip_third_w_tiny_zero_and_negative_is_finite() {
    let view = View::normalised(8, 8);
    let polygons = [2.0f64.powi(-20), 0.0, -1.0]
        .map(|w| clip(&triangle([[-1.0, -1.0, 0.5, 1.0], [1.0, -1.0, 0.5, 1.0], [0.25, 2.0, 0.5, w]]), &view));

    // As w sinks to 0 the third corner leaves the guard band downwards and the edges become parallel; below 0 they
    // open, and the right one leaves the guard band at the side.
    assert_eq!(polygons.each_ref().map(|p| p.corners.len()), [4, 4, 5]);
    let limit = integer(32768);
    assert!(polygons.iter().flat_map(|p| &p.corners).all(|c| c.position.iter().all(|x| x.abs() <= limit)));
    assert!(polygons.iter().all(|p| p.covers(4, 4) && p.covers(90, 700)));
    assert!(!polygons[0].covers(-1, 2) && !polygons[2].covers(-1, 0));
}

#[test]
fn clip_through_the_eye_keeps_the_triangle_between_the_other_corners() {
    // The first vertex is the eye itself, x = y = w = 0: every point of an edge to it has one image.
    let polygon = clip(&triangle([[0.0, 0.0, 1.0, 0.0], [6.0, 0.0, 1.0, 1.0], [0.0, 6.0, 1.0, 1.0]]), &View::pixels());

    assert_eq!(positions(&polygon), [[6.0, 0.0], [0.0, 6.0]]);
    assert_eq!(counts(&[polygon]), [0; 64]);
}

#[test]
fn clip_huge_coordinates_cover_what_they_should() {
    let far = 1.0e5;
    let corners = [[-far, -far], [far, -far], [-far, far], [far, far]].map(|[x, y]| [x, y, 0.5, 1.0]);
    let halves = [[0, 1, 2], [2, 1, 3]].map(|t| clip(&triangle(t.map(|k: usize| corners[k])), &View::normalised(8, 8)));

    assert_eq!(counts(&halves), [1; 64]);
}

#[test]
fn clip_shared_edge_with_one_side_cut_has_no_hole() {
    let view = View::pixels();
    let (a, b) = ([8.0, 0.0, 0.5, 1.0], [0.0, 8.0, 0.5, 1.0]);
    let whole = clip(&triangle([[0.0, 0.0, 0.5, 1.0], a, b]), &view);
    let cut = clip(&triangle([b, a, [9.0e6, 9.0e6, 0.5, 1.0]]), &view);

    assert_eq!(cut.corners.len(), 5);
    assert_eq!(counts(&[whole, cut]), [1; 64]);
}

#[test]
fn transformed_row_vector_times_matrix() {
    let shift = [[2.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.5], [7.0, -3.0, 0.0, 1.0]];
    let vertex = Homogeneous::from_f32([1.0, 2.0, 4.0, 1.0]).unwrap();

    assert_eq!(vertex.transformed(&shift), Homogeneous::from_f64([9.0, -1.0, 4.0, 3.0]));
    assert_eq!(Homogeneous::from_f32([f32::NAN, 0.0, 0.0, 1.0]), None);
}

#[test]
fn snap_both_grids_round_ties_to_even() {
    let eighth = [(1, 512), (3, 512), (5, 512), (-1, 512), (-3, 512)].map(|(n, d)| snap(&ratio(n, d), 8));
    let quarter = [(1, 32), (3, 32), (33, 256)].map(|(n, d)| snap(&ratio(n, d), 4));

    assert_eq!(eighth, [Some(0), Some(2), Some(2), Some(0), Some(-2)]);
    assert_eq!(quarter, [Some(0), Some(32), Some(32)]);
    assert_eq!(snap(&integer(1 << 24), 8), None);
}

#[test]
fn stored_depth_ends_and_middle_are_rounded_half_up() {
    let depths = [ratio(-1, 9), ratio(0, 1), ratio(1, 2), ratio(1, 1), ratio(3, 2)].map(|d| stored_depth(&d, 16));

    assert_eq!(depths, [0, 0, 0x8000, 0xffff, 0xffff]);
}

#[test]
fn distance_squared_known_outlines() {
    let square = ExactPolygon {
        corners: [[0, 0], [1, 0], [1, 1], [0, 1]]
            .map(|p| Corner {
                position: p.map(integer),
                depth: integer(0),
                inverse_w: integer(1),
                weights: [0, 0, 0].map(integer),
            })
            .to_vec(),
    };
    let shifted = [(3, 0), (259, 0), (259, 256), (3, 256)];
    let longer = [(0, 0), (256, 0), (256, 261), (0, 256)];

    assert_eq!(square.distance_squared(&shifted), Some(integer(9)));
    assert_eq!(square.distance_squared(&longer), Some(integer(25)));
    assert_eq!(square.distance_squared(&[]), None);
}

/// Coverage without clipping or division (Olano and Greer 1997): the weights l of the homogeneous vertices with
/// `l . (x, y, w) = (px, py, 1)`. `None` on any boundary.
fn inside_homogeneous(t: &[Homogeneous; 3], i: i32, j: i32) -> Option<bool> {
    let p = [integer(i) + ratio(1, 2), integer(j) + ratio(1, 2), integer(1)];
    let columns = [0, 1, 2].map(|k| [0, 1, 3].map(|row| t[k].0[row].clone()));
    let determinant = |c: &[[BigRational; 3]; 3]| {
        let minor = |a: usize, b: usize| &c[1][a] * &c[2][b] - &c[1][b] * &c[2][a];
        &c[0][0] * minor(1, 2) - &c[0][1] * minor(0, 2) + &c[0][2] * minor(0, 1)
    };
    let whole = determinant(&columns);
    let weights = [0, 1, 2].map(|k| {
        let mut replaced = columns.clone();
        replaced[k] = p.clone();
        determinant(&replaced) * whole.signum()
    });
    let z: BigRational = (0..3).map(|k| &weights[k] * &t[k].0[2]).sum();
    let signs = [&weights[0], &weights[1], &weights[2], &z].map(Signed::signum);
    let decided = !whole.is_zero() && !signs.iter().any(Zero::is_zero);
    decided.then(|| signs.iter().all(Signed::is_positive))
}

proptest! {
    #[test]
    fn covers_any_triangle_equals_homogeneous_coverage(
        v in prop::array::uniform3(prop::array::uniform4(-12i32..20)), scale in 0u32..4,
    ) {
        // Small integers: w = 0, z = 0 and shared corners come up often.
        let t = v.map(|[x, y, z, w]| Homogeneous([x << scale, y << scale, z, w].map(integer)));
        let polygon = clip(&t, &View::pixels());

        let visited = counts(std::slice::from_ref(&polygon));
        for k in 0..64 {
            let (i, j) = (k % 8, k / 8);
            let covered = polygon.covers(i, j);
            prop_assert_eq!(inside_homogeneous(&t, i, j).unwrap_or(covered), covered, "pixel {}, {}", i, j);
            prop_assert_eq!(visited[k as usize], usize::from(covered), "pixel {}, {}", i, j);
        }
    }

    #[test]
    fn covers_split_quad_at_most_once(
        centre in (-4.0f64..12.0, -4.0f64..12.0), angle in 0.0f64..6.3, w in prop::array::uniform4(0.1f64..4.0),
    ) {
        let corners = [0usize, 1, 2, 3].map(|k| {
            let (sin, cos) = (angle + k as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
            [(centre.0 + 5.0 * cos) * w[k], (centre.1 + 5.0 * sin) * w[k], 0.5 * w[k], w[k]]
        });

        let halves = [[0, 1, 2], [2, 3, 0]].map(|t| clip(&triangle(t.map(|k: usize| corners[k])), &View::pixels()));

        prop_assert!(counts(&halves).into_iter().max() <= Some(1));
    }

    #[test]
    fn distance_squared_snapped_polygon_is_within_half_a_unit_squared(
        v in prop::array::uniform3((-300.0f64..300.0, -300.0f64..300.0, 0.05f64..4.0)),
    ) {
        let polygon = clip(&triangle(v.map(|(x, y, w)| [x, y, 0.5 * w, w])), &View::pixels());
        let outline: Vec<_> = polygon.outline().iter()
            .map(|p| (snap(&p[0], 8).unwrap(), snap(&p[1], 8).unwrap())).collect();

        // 1/2 u in x and in y.
        prop_assert!(polygon.distance_squared(&outline) <= Some(ratio(1, 2)));
    }
}
