//! Triangles under the top-left rule.
//!
//! A point strictly inside is covered. A point exactly on an edge is covered when the edge is a *left* edge (not
//! horizontal, the inside to its right) or a *top* edge (horizontal, the inside below it); a point on two edges, a
//! vertex, when both are. Source: Direct3D 10 rasterisation rules, "Triangle Rasterization Rules (Without
//! Multisampling)". Either winding is drawn; a triangle of area 0 covers nothing.

use super::super::Vertex;
use std::ops::Range;

/// A line through two vertices as `e(p) = a x + b y + c`, positive inside; units u for x and y, u^2 for e.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) a: i128,
    b: i128,
    c: i128,
    /// Left or top: its own points are inside.
    pub(super) closed: bool,
}

impl Edge {
    fn between(from: &Vertex, to: &Vertex) -> Self {
        let (dx, dy) = difference(from, to);
        Self {
            a: -dy,
            b: dx,
            c: dy * i128::from(from.x) - dx * i128::from(from.y),
            // The gradient of e, (-dy, dx), points to the inside: to the right of a left edge, below a top edge.
            closed: -dy > 0 || (dy == 0 && dx > 0),
        }
    }

    /// e at `(x / scale, y / scale)`, times `scale`.
    pub(super) fn at(&self, x: i128, y: i128, scale: i128) -> i128 {
        self.a * x + self.b * y + self.c * scale
    }

    fn admits(&self, e: i128) -> bool {
        e > 0 || (e == 0 && self.closed)
    }
}

fn difference(from: &Vertex, to: &Vertex) -> (i128, i128) {
    (i128::from(to.x) - i128::from(from.x), i128::from(to.y) - i128::from(from.y))
}

/// Twice the signed area in u^2; positive when the vertices run clockwise on the screen (y down).
#[must_use]
pub fn twice_area(triangle: &[Vertex; 3]) -> i128 {
    let (dx1, dy1) = difference(&triangle[0], &triangle[1]);
    let (dx2, dy2) = difference(&triangle[0], &triangle[2]);
    dx1 * dy2 - dx2 * dy1
}

/// The three edges with the inside on their positive sides; `None` for area 0.
pub(super) fn edges(triangle: &[Vertex; 3]) -> Option<[Edge; 3]> {
    let [a, b, c] = match twice_area(triangle).signum() {
        1 => *triangle,
        -1 => [triangle[0], triangle[2], triangle[1]],
        _ => return None,
    };
    Some([Edge::between(&a, &b), Edge::between(&b, &c), Edge::between(&c, &a)])
}

/// Whether the centre of pixel `(i, j)` is covered.
#[must_use]
pub fn triangle_covers(triangle: &[Vertex; 3], i: i32, j: i32) -> bool {
    triangle_covers_at(triangle, i64::from(i) * 256 + 128, i64::from(j) * 256 + 128, 1)
}

/// Whether the point `(x / scale, y / scale)`, in u, is covered: any sample position that is a rational.
///
/// # Panics
/// When `scale` is not positive.
#[must_use]
pub fn triangle_covers_at(triangle: &[Vertex; 3], x: i64, y: i64, scale: i64) -> bool {
    assert!(scale > 0, "the scale of a sample position must be positive");
    edges(triangle).is_some_and(|edges| edges.iter().all(|edge| edge.admits(edge.at(x.into(), y.into(), scale.into()))))
}

/// The three edges of a triangle, worked out once for many sample positions.
#[derive(Clone, Copy, Debug)]
pub struct Outline([Edge; 3]);

impl Outline {
    /// `None` for area 0.
    #[must_use]
    pub fn new(triangle: &[Vertex; 3]) -> Option<Self> {
        edges(triangle).map(Self)
    }

    /// The columns, of those given, at which a sample of row `j` is covered that lies `at` in 1/256 pixel from the
    /// pixel's upper left corner.
    #[must_use]
    pub fn run(&self, j: u32, at: [u32; 2], columns: &Range<u32>) -> Range<u32> {
        super::rows::run(&self.0, j, at, columns)
    }

    /// Whether the point `(x, y)`, in u, is covered.
    #[must_use]
    pub fn covers(&self, x: i64, y: i64) -> bool {
        self.0.iter().all(|edge| edge.admits(edge.at(x.into(), y.into(), 1)))
    }
}

/// Visits the covered pixels of the target, row by row. The edge functions step by exact integers along a row.
pub(super) fn visit(triangle: &[Vertex; 3], width: u32, height: u32, visit: &mut impl FnMut(u32, u32)) {
    let Some(edges) = edges(triangle) else { return };
    let xs = triangle.map(|v| v.x);
    let ys = triangle.map(|v| v.y);
    let range = |values: [i32; 3], size| {
        let least = values[0].min(values[1]).min(values[2]);
        let greatest = values[0].max(values[1]).max(values[2]);
        super::touched(least, greatest, size)
    };
    let columns = range(xs, width);
    let centre = |pixel: u32| i128::from(pixel) * 256 + 128;
    for j in range(ys, height) {
        let mut e = edges.map(|edge| edge.at(centre(columns.start), centre(j), 1));
        for i in columns.clone() {
            if edges.iter().zip(e).all(|(edge, e)| edge.admits(e)) {
                visit(i, j);
            }
            for (e, edge) in e.iter_mut().zip(&edges) {
                *e += edge.a * 256;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::exact::ratio;
    use super::*;
    use num_rational::BigRational;
    use proptest::prelude::*;

    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

    fn triangle(points: [(i32, i32); 3]) -> [Vertex; 3] {
        points.map(|(x, y)| Vertex::at(x, y, 0))
    }

    /// How many of the triangles cover each pixel of a `width` x `height` target.
    fn counts(triangles: &[[Vertex; 3]], width: i32, height: i32) -> Vec<usize> {
        let pixels = (0..height).flat_map(|j| (0..width).map(move |i| (i, j)));
        pixels.map(|(i, j)| triangles.iter().filter(|t| triangle_covers(t, i, j)).count()).collect()
    }

    /// The rule told without edge functions: on the scan line through the point, `x_left <= x < x_right`, for the
    /// scan lines `y_top <= y < y_bottom`.
    fn covers_by_spans(triangle: &[Vertex; 3], x: i64, y: i64) -> bool {
        let ys = triangle.map(|v| i64::from(v.y));
        let rows = *ys.iter().min().unwrap()..*ys.iter().max().unwrap();
        let crossings: Vec<BigRational> = [(0, 1), (1, 2), (2, 0)]
            .map(|(from, to)| (triangle[from], triangle[to]))
            .into_iter()
            .flat_map(|(p, q)| crossing(&p, &q, y))
            .collect();
        let x = ratio(x.into(), 1);
        rows.contains(&y)
            && crossings.iter().min().is_some_and(|left| *left <= x)
            && crossings.iter().max().is_some_and(|right| x < *right)
    }

    /// Where the closed segment meets the line of height `y`: no point, one, or both ends of a horizontal segment.
    fn crossing(p: &Vertex, q: &Vertex, y: i64) -> Vec<BigRational> {
        let [px, py, qx, qy, y] = [p.x.into(), p.y.into(), q.x.into(), q.y.into(), i128::from(y)];
        let both = if p.y == q.y { vec![px, qx] } else { vec![] };
        let touching = (py.min(qy)..=py.max(qy)).contains(&y);
        let ends = both.into_iter().map(|x| ratio(x, 1));
        let one = (py != qy).then(|| ratio(px * (qy - py) + (y - py) * (qx - px), qy - py));
        ends.chain(one).filter(|_| touching).collect()
    }

    #[test]
    fn triangle_covers_rectangle_through_centres_keeps_left_and_top() {
        let (a, b, c, d) = ((128, 128), (1152, 128), (128, 896), (1152, 896));

        let counts = counts(&[triangle([a, b, c]), triangle([c, b, d])], 6, 5);

        let expected: Vec<usize> = (0..30).map(|k| usize::from(k % 6 < 4 && k / 6 < 3)).collect();
        assert_eq!(counts, expected);
    }

    #[test]
    fn triangle_covers_every_order_of_vertices_is_the_same() {
        let points = [(128, 128), (1408, 640), (384, 1408)];
        let expected = counts(&[triangle(points)], 6, 6);

        let permuted = ORDERS.map(|order| counts(&[triangle(order.map(|k| points[k]))], 6, 6));

        assert!(expected.iter().sum::<usize>() > 5);
        assert_eq!(permuted, [(); 6].map(|()| expected.clone()));
    }

    #[test]
    fn triangle_covers_fans_on_a_centre_draw_the_hub_once() {
        let rim =
            [(900, 0), (640, 640), (0, 900), (-640, 640), (-900, 0), (-640, -640), (0, -900), (640, -640), (820, -300)];
        let hub = (1152, 1152);
        let spoke = |k: usize| (hub.0 + rim[k].0, hub.1 + rim[k].1);

        // Fans of 3 to 9 triangles round the hub, with spokes along axes and diagonals.
        let picks: [&[usize]; 7] = [
            &[0, 2, 5],
            &[0, 2, 4, 6],
            &[0, 2, 4, 6, 7],
            &[1, 2, 3, 4, 5, 7],
            &[0, 1, 2, 3, 4, 5, 7],
            &[0, 1, 2, 3, 4, 5, 6, 7],
            &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        ];
        let greatest = picks.map(|pick| {
            let fan: Vec<_> =
                (0..pick.len()).map(|k| triangle([hub, spoke(pick[k]), spoke(pick[(k + 1) % pick.len()])])).collect();
            let counts = counts(&fan, 9, 9);
            (counts[4 * 9 + 4], counts.into_iter().max().unwrap())
        });

        assert_eq!(greatest, [(1, 1); 7]);
    }

    #[test]
    fn triangle_covers_twice_area_of_one_hits_only_its_own_corner() {
        // Left top corner at the centre of pixel (0, 0): a left and a top edge meet there.
        let on = triangle([(128, 128), (129, 128), (128, 129)]);
        let right = triangle([(127, 128), (128, 128), (127, 129)]);
        let flat = triangle([(0, 0), (128, 128), (512, 512)]);

        assert_eq!([on, right, flat].map(|t| twice_area(&t)), [1, 1, 0]);
        assert_eq!([on, right, flat].map(|t| triangle_covers(&t, 0, 0)), [true, false, false]);
    }

    #[test]
    fn triangle_covers_guard_band_vertices_are_exact() {
        let far = 1 << 23;
        let whole = [(-far, -far), (far, -far), (-far, far), (far, far)];
        let halves = [triangle([whole[0], whole[1], whole[2]]), triangle([whole[2], whole[1], whole[3]])];

        let corner = halves.map(|t| triangle_covers(&t, 32767, 32767));
        // The diagonal x + y = 0 passes between centres: (-1, 0) lies on it.
        let diagonal = halves.map(|t| triangle_covers(&t, -1, 0));

        assert_eq!(corner, [false, true]);
        assert_eq!(diagonal, [false, true]);
    }

    proptest! {
        #[test]
        fn triangle_covers_any_triangle_equals_the_spans(
            xy in prop::array::uniform6(-4i32..5), x in -5i64..6, y in -5i64..6,
        ) {
            let t = triangle([(xy[0], xy[1]), (xy[2], xy[3]), (xy[4], xy[5])]);
            prop_assume!(twice_area(&t) != 0);

            prop_assert_eq!(triangle_covers_at(&t, x, y, 1), covers_by_spans(&t, x, y));
            prop_assert_eq!(Outline::new(&t).map(|outline| outline.covers(x, y)), Some(covers_by_spans(&t, x, y)));
        }

        #[test]
        fn triangle_covers_at_scaled_grid_equals_scaled_triangle(
            xy in prop::array::uniform6(-300i32..300), x in -300i64..300, y in -300i64..300, scale in 1i32..9,
        ) {
            let points = [(xy[0], xy[1]), (xy[2], xy[3]), (xy[4], xy[5])];
            let scaled = triangle(points.map(|(x, y)| (x * scale, y * scale)));

            let direct = triangle_covers_at(&triangle(points), x, y, scale.into());

            prop_assert_eq!(direct, triangle_covers_at(&scaled, x, y, 1));
        }

        #[test]
        fn triangle_covers_split_rectangle_is_covered_once(
            w in 1i32..1500, h in 1i32..1500, x in 0i32..600, y in 0i32..600, px in 1i32..1499, py in 1i32..1499,
        ) {
            // Four triangles round an inner point: shared edges and a shared vertex.
            let corners = [(x, y), (x + w + 1, y), (x + w + 1, y + h + 1), (x, y + h + 1)];
            let inner = (x + px.min(w), y + py.min(h));
            let fan = [0, 1, 2, 3].map(|k| triangle([inner, corners[k], corners[(k + 1) % 4]]));

            let expected: Vec<usize> = (0..100)
                .map(|k| (k % 10 * 256 + 128, k / 10 * 256 + 128))
                .map(|(cx, cy)| usize::from((x..x + w + 1).contains(&cx) && (y..y + h + 1).contains(&cy)))
                .collect();
            prop_assert_eq!(counts(&fan, 10, 10), expected);
        }
    }
}
