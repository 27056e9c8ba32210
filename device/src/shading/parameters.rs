//! Parameters: what vertices carry beside place and colour, interpolated over a primitive.
//!
//! Duties: keeps the raw words of a primitive's vertices until it turns out to be seen (the vertex parameter buffer of
//! CN 1275225 A); makes planes of texture coordinates, normal, eye position and distance from them. Inputs from: the
//! fetch stage, the transform. Outputs to: [`super::pixel`]. Clocks: none of their own.
//!
//! A parameter p is interpolated as p / w over 1 / w. Both are planes on the screen, found from the vertices in
//! homogeneous screen coordinates (X, Y, W): the planes a with a . (X, Y, W) = p at the three vertices. So a vertex behind
//! the viewer needs no clipping: a clipped primitive has the planes of the whole one. Where perspective is not called
//! for, W is 1. Vertices that lie in the guard band are taken at their snapped places, as colours are.
//!
//! Planes are f64, anchored at a pixel near the primitive; one division a pixel. The error of a texture coordinate stays
//! below 1/256 texel where 1 / w spans 2^20. Every parameter is limited to the range of its vertices, which is also what
//! a plane without meaning (a primitive that is a line in the vertices' own places) gives.
//!
//! A line's planes change along its major axis only; a point has its vertex's parameters.

use crate::geometry::transform::Transform;
use zga_abi::format::Topology;

/// What one vertex carries, as it stands in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VertexParameters {
    /// Object space.
    pub position: [f32; 3],
    /// Object space; 0 where the draw has none.
    pub normal: [f32; 3],
    /// Texture coordinates u, v; 0 where the draw has none.
    pub coordinates: [f32; 2],
}

/// What a primitive's vertices carry; a line repeats its second vertex, a point its only one.
pub type Parameters = [VertexParameters; 3];

/// Which parameters a draw's pixels need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needed {
    /// Texture coordinates.
    pub coordinates: bool,
    /// Eye position and normal.
    pub surface: bool,
    /// Distance from the viewer.
    pub distance: bool,
}

/// Matrices that parameters go through.
#[derive(Clone, Debug)]
pub struct ParameterTransform {
    /// To the screen.
    pub screen: Transform,
    /// Object to eye, rows.
    pub eye: [[f64; 4]; 4],
    /// Of normals, object to eye.
    pub normal: [[f64; 3]; 3],
    /// Interpolation is perspective-correct.
    pub perspective: bool,
    /// What the draw's vertices make.
    pub topology: Topology,
}

/// A quantity that is affine on the screen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plane {
    reference: f64,
    dx: f64,
    dy: f64,
}

impl Plane {
    /// Value `i` pixels right of and `j` below the anchor's centre.
    #[inline(always)]
    fn at(&self, i: f64, j: f64) -> f64 {
        (self.reference + j * self.dy) + i * self.dx
    }
}

/// A parameter: its plane over w, and the range of its vertices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parameter {
    over_w: Plane,
    minimum: f64,
    maximum: f64,
}

/// Lanes of a chunk of pixels.
pub const LANES: usize = 16;

/// The planes of a primitive.
#[derive(Clone, Debug)]
pub struct ParameterPlanes {
    anchor: [i32; 2],
    reciprocal: Plane,
    /// u, v.
    pub coordinates: Option<[Parameter; 2]>,
    /// Eye position x, y, z and normal x, y, z.
    pub surface: Option<[Parameter; 6]>,
    /// Distance from the viewer along its axis, -z.
    pub distance: Option<Parameter>,
}

/// A place to shade: its offset from the anchor, and w there.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    i: f64,
    j: f64,
    w: f64,
}

/// 16 places: side by side on one row, or anywhere.
#[derive(Clone, Copy, Debug)]
pub struct PlaceLanes<J> {
    i: [f64; LANES],
    j: J,
    w: [f64; LANES],
}

/// How far below the anchor 16 places lie: one number for all, or one each.
pub trait Below: Copy {
    /// That of a lane.
    fn of(&self, lane: usize) -> f64;
}

impl Below for f64 {
    #[inline(always)]
    fn of(&self, _lane: usize) -> f64 {
        *self
    }
}

impl Below for [f64; LANES] {
    #[inline(always)]
    fn of(&self, lane: usize) -> f64 {
        self[lane]
    }
}

impl Parameter {
    /// Value at a place.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, place: &Place) -> f64 {
        // max and min put the range's ends where there is a NaN.
        (self.over_w.at(place.i, place.j) * place.w).max(self.minimum).min(self.maximum)
    }

    /// The same for lanes.
    #[must_use]
    #[inline(always)]
    pub fn at_lanes<J: Below>(&self, places: &PlaceLanes<J>) -> [f64; LANES] {
        let mut values = [0.0; LANES];
        for (lane, value) in values.iter_mut().enumerate() {
            let over_w = self.over_w.at(places.i[lane], places.j.of(lane));
            *value = (over_w * places.w[lane]).max(self.minimum).min(self.maximum);
        }
        values
    }

    /// Change of the parameter, which is `value` at a place where w is `w`, for one pixel right and down.
    #[inline(always)]
    fn slopes(&self, reciprocal: &Plane, value: f64, w: f64) -> [f64; 2] {
        [(self.over_w.dx - value * reciprocal.dx) * w, (self.over_w.dy - value * reciprocal.dy) * w]
    }
}

impl ParameterPlanes {
    /// The planes of a primitive near pixel `anchor`.
    #[must_use]
    pub fn new(anchor: [i32; 2], vertices: &Parameters, needed: Needed, transform: &ParameterTransform) -> Self {
        let mut at = vertices.map(|vertex| transform.screen.homogeneous(vertex.position));
        if !transform.perspective && at.iter().all(|[_, _, w]| *w > 0.0) {
            at = at.map(|[x, y, w]| [x / w, y / w, 1.0]);
        }
        let system = System::new(transform.topology, &at, anchor);
        let parameter = |values: [f64; 3]| {
            let values = values.map(|value| if value.is_finite() { value } else { 0.0 });
            Parameter {
                over_w: system.plane(values),
                minimum: values[0].min(values[1]).min(values[2]),
                maximum: values[0].max(values[1]).max(values[2]),
            }
        };
        let eye = vertices.map(|vertex| transform.eye_position(vertex.position));
        let surface = needed.surface.then(|| {
            let normals = vertices.map(|vertex| transform.eye_normal(vertex.normal));
            let part = |of: &[[f64; 3]; 3], axis: usize| parameter([of[0][axis], of[1][axis], of[2][axis]]);
            [part(&eye, 0), part(&eye, 1), part(&eye, 2), part(&normals, 0), part(&normals, 1), part(&normals, 2)]
        });
        ParameterPlanes {
            anchor,
            reciprocal: system.plane([1.0; 3]),
            coordinates: needed
                .coordinates
                .then(|| [0, 1].map(|axis| parameter(vertices.map(|v| f64::from(v.coordinates[axis]))))),
            surface,
            distance: needed.distance.then(|| parameter(eye.map(|[_, _, z]| -z))),
        }
    }

    /// The place `[x, y]`, in u.
    #[must_use]
    #[inline(always)]
    pub fn place(&self, [x, y]: [i32; 2]) -> Place {
        let offset = |c: usize, at: i32| f64::from(at - self.anchor[c] * 256 - 128) / 256.0;
        let (i, j) = (offset(0, x), offset(1, y));
        Place { i, j, w: 1.0 / self.reciprocal.at(i, j) }
    }

    /// The centres of the 16 pixels from (`x`, `y`) on.
    #[must_use]
    #[inline(always)]
    pub fn places(&self, x: i32, y: i32) -> PlaceLanes<f64> {
        let (first, j) = (x - self.anchor[0], f64::from(y - self.anchor[1]));
        let (mut i, mut w) = ([0.0; LANES], [0.0; LANES]);
        for (lane, (i, w)) in (0..).zip(i.iter_mut().zip(&mut w)) {
            *i = f64::from(first + lane);
            *w = 1.0 / self.reciprocal.at(*i, j);
        }
        PlaceLanes { i, j, w }
    }

    /// 16 places, columns and rows in u.
    #[must_use]
    #[inline(always)]
    pub fn scattered(&self, at: &[[i32; LANES]; 2]) -> PlaceLanes<[f64; LANES]> {
        let [mut i, mut j, mut w] = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let offset = |c: usize| f64::from(at[c][lane] - self.anchor[c] * 256 - 128) / 256.0;
            (i[lane], j[lane]) = (offset(0), offset(1));
            w[lane] = 1.0 / self.reciprocal.at(i[lane], j[lane]);
        }
        PlaceLanes { i, j, w }
    }

    /// du/dx, dv/dx, du/dy, dv/dy at a place with these texture coordinates, a pixel.
    #[must_use]
    #[inline(always)]
    pub fn gradients(&self, [u, v]: &[Parameter; 2], place: &Place, at: [f64; 2]) -> [f64; 4] {
        let [dux, duy] = u.slopes(&self.reciprocal, at[0], place.w);
        let [dvx, dvy] = v.slopes(&self.reciprocal, at[1], place.w);
        [dux, dvx, duy, dvy]
    }

    /// The same for lanes.
    #[must_use]
    #[inline(always)]
    pub fn gradient_lanes<J>(
        &self,
        [u, v]: &[Parameter; 2],
        places: &PlaceLanes<J>,
        at: [&[f64; LANES]; 2],
    ) -> [[f64; LANES]; 4] {
        let mut gradients = [[0.0; LANES]; 4];
        for lane in 0..LANES {
            let [dux, duy] = u.slopes(&self.reciprocal, at[0][lane], places.w[lane]);
            let [dvx, dvy] = v.slopes(&self.reciprocal, at[1][lane], places.w[lane]);
            gradients[0][lane] = dux;
            gradients[1][lane] = dvx;
            gradients[2][lane] = duy;
            gradients[3][lane] = dvy;
        }
        gradients
    }
}

impl ParameterTransform {
    /// A place in eye space.
    #[must_use]
    pub fn eye_position(&self, [x, y, z]: [f32; 3]) -> [f64; 3] {
        let (x, y, z) = (f64::from(x), f64::from(y), f64::from(z));
        let m = &self.eye;
        [0, 1, 2].map(|c| x * m[0][c] + y * m[1][c] + z * m[2][c] + m[3][c])
    }

    /// A normal in eye space, of length 1, or 0 where it has none.
    #[must_use]
    pub fn eye_normal(&self, normal: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = normal.map(|c| if c.is_finite() { f64::from(c) } else { 0.0 });
        let m = &self.normal;
        let turned = [0, 1, 2].map(|c| x * m[0][c] + y * m[1][c] + z * m[2][c]);
        let length = (turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2]).sqrt();
        if length > 0.0 && length.is_finite() { turned.map(|c| c / length) } else { [0.0; 3] }
    }
}

/// The equations a . (X, Y, W) = p of a primitive, solved for any p. X and Y count from the anchor's centre.
enum System {
    /// Rows of the inverse, times the determinant; the determinant.
    Triangle([[f64; 3]; 3], f64),
    /// It runs along columns (0) or rows (1); places and W of both ends.
    Line(usize, [f64; 2], [f64; 2]),
    /// One value everywhere.
    Point,
}

impl System {
    fn new(topology: Topology, at: &[[f64; 3]; 3], anchor: [i32; 2]) -> System {
        let centre = anchor.map(|pixel| f64::from(pixel) + 0.5);
        let at = at.map(|[x, y, w]| [x - w * centre[0], y - w * centre[1], w]);
        match topology {
            Topology::Triangles => {
                let [a, b, c] = &at;
                let rows = [cross(b, c), cross(c, a), cross(a, b)];
                let determinant = a[0] * rows[0][0] + a[1] * rows[0][1] + a[2] * rows[0][2];
                System::Triangle(rows, determinant)
            }
            Topology::Lines | Topology::LineStrip => {
                let [[x0, y0, w0], [x1, y1, w1], _] = at;
                let axis = usize::from((y1 / w1 - y0 / w0).abs() > (x1 / w1 - x0 / w0).abs());
                System::Line(axis, [at[0][axis], at[1][axis]], [w0, w1])
            }
            Topology::Points => System::Point,
        }
    }

    /// The plane of p / w where the vertices have `values`.
    fn plane(&self, values: [f64; 3]) -> Plane {
        match self {
            System::Triangle(rows, determinant) => {
                let part =
                    |c: usize| (values[0] * rows[0][c] + values[1] * rows[1][c] + values[2] * rows[2][c]) / determinant;
                Plane { reference: part(2), dx: part(0), dy: part(1) }
            }
            System::Line(axis, at, w) => {
                // m at + n w = value at both ends.
                let determinant = at[0] * w[1] - at[1] * w[0];
                let slope = (values[0] * w[1] - values[1] * w[0]) / determinant;
                let reference = (at[0] * values[1] - at[1] * values[0]) / determinant;
                let (dx, dy) = if *axis == 0 { (slope, 0.0) } else { (0.0, slope) };
                Plane { reference, dx, dy }
            }
            System::Point => Plane { reference: values[0], dx: 0.0, dy: 0.0 },
        }
    }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::GeometryRegisters;
    use proptest::prelude::*;
    use zga_abi::Effects;
    use zga_abi::format::DepthFormat;

    /// To the screen with w = z, so that a vertex at (x z, y z, z) is seen at (x, y).
    fn transform(topology: Topology) -> ParameterTransform {
        let eye_clip = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.];
        let registers = GeometryRegisters { eye_clip, ..GeometryRegisters::IDENTITY };
        ParameterTransform {
            screen: Transform::new(&registers, Effects::PERSPECTIVE, [64, 64], DepthFormat::default(), 8),
            eye: [[1., 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 1., 0.], [0., 0., 0., 1.]],
            normal: [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
            perspective: true,
            topology,
        }
    }

    /// A vertex seen at a place in u, at distance `w`.
    fn seen([x, y]: [i32; 2], w: f32, coordinates: [f32; 2]) -> VertexParameters {
        let position = [x as f32 / 256.0 * w, y as f32 / 256.0 * w, w];
        VertexParameters { position, normal: [0.0, 0.0, 2.0], coordinates }
    }

    const ALL: Needed = Needed { coordinates: true, surface: true, distance: true };

    proptest! {
        #[test]
        fn parameters_at_vertices_are_the_vertices(
            places in prop::array::uniform3([0_i32..16384, 0_i32..16384]),
            // Powers of two: x w and y w are exact in f32, so places snap to themselves.
            distances in prop::array::uniform3(-10_i32..=10),
            coordinates in prop::array::uniform3([-4.0_f32..4.0, -4.0_f32..4.0]),
        ) {
            let [a, b, c] = places.map(|place| place.map(i64::from));
            prop_assume!(((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs() > 65536);
            let v: Parameters =
                std::array::from_fn(|n| seen(places[n], (distances[n] as f32).exp2(), coordinates[n]));
            let planes = ParameterPlanes::new([0, 0], &v, ALL, &transform(Topology::Triangles));
            for n in 0..3 {
                let place = planes.place(places[n]);
                let [u, w] = planes.coordinates.unwrap().map(|parameter| parameter.at(&place));
                // 1 / w spans 2^20, determinants cancel at most as much again: 2^-53 2^40 is below 2^-12 of a unit.
                prop_assert!((u - f64::from(coordinates[n][0])).abs() < 1e-6, "{} {:?}", u, coordinates[n]);
                prop_assert!((w - f64::from(coordinates[n][1])).abs() < 1e-6);
            }
        }

        #[test]
        fn places_lanes_equal_single_places(x in -40_i32..40, y in -40_i32..40, w in prop::array::uniform3(0.1_f32..8.0)) {
            let v = [seen([256, 512], w[0], [0.0, 1.0]), seen([9000, 700], w[1], [2.0, 0.5]), seen([100, 8000], w[2], [0.25, 3.0])];
            let planes = ParameterPlanes::new([3, 4], &v, ALL, &transform(Topology::Triangles));
            let lanes = planes.places(x, y);
            let both = planes.coordinates.unwrap();
            let [u, v] = both.map(|parameter| parameter.at_lanes(&lanes));
            let gradients = planes.gradient_lanes(&both, &lanes, [&u, &v]);
            let at = [std::array::from_fn(|lane| (x + lane as i32) * 256 + 128), [y * 256 + 128; LANES]];
            let scattered = both.map(|parameter| parameter.at_lanes(&planes.scattered(&at)));
            for lane in 0..LANES {
                let place = planes.place([at[0][lane], at[1][lane]]);
                prop_assert_eq!([u[lane], v[lane]].map(f64::to_bits), scattered.map(|lanes| lanes[lane].to_bits()));
                let at = both.map(|parameter| parameter.at(&place));
                prop_assert_eq!([u[lane], v[lane]].map(f64::to_bits), at.map(f64::to_bits));
                let single = planes.gradients(&both, &place, at);
                prop_assert_eq!(gradients.map(|lanes| lanes[lane].to_bits()), single.map(f64::to_bits));
            }
        }
    }

    #[test]
    fn parameters_of_a_line_change_along_it_and_of_a_point_not_at_all() {
        let ends = [seen([0, 0], 1.0, [0.0, 0.0]), seen([2560, 512], 1.0, [1.0, 2.0])];
        let line = ParameterPlanes::new([0, 0], &[ends[0], ends[1], ends[1]], ALL, &transform(Topology::Lines));
        let [u, v] = line.coordinates.unwrap();
        assert!(
            (u.at(&line.place([1280, 0])) - 0.5).abs() < 1e-12 && (v.at(&line.place([1280, 999])) - 1.0).abs() < 1e-12
        );
        let point = ParameterPlanes::new([0, 0], &[ends[1]; 3], ALL, &transform(Topology::Points));
        let [u, v] = point.coordinates.unwrap().map(|parameter| parameter.at(&point.place([9999, -9999])));
        assert_eq!([u, v], [1.0, 2.0]);
    }

    #[test]
    fn parameters_without_meaning_stay_in_the_range_of_the_vertices() {
        // Three vertices on one line: the plane does not exist.
        let v = [seen([0, 0], 1.0, [0.25, 0.5]), seen([256, 256], 1.0, [0.5, 0.5]), seen([512, 512], 1.0, [0.75, 0.5])];
        let planes = ParameterPlanes::new([0, 0], &v, ALL, &transform(Topology::Triangles));
        let [u, v] = planes.coordinates.unwrap().map(|parameter| parameter.at(&planes.place([300, 100])));
        assert!((0.25..=0.75).contains(&u), "{u}");
        assert_eq!(v, 0.5);
    }
}
