//! Which marking pixels must be seen: in rationals, from the vertices that the card is given.
//!
//! * Where a marking's pixels are is the oracle's rule for lines and points on the snapped vertices.
//! * Such a pixel stands for one point p of the true, unsnapped line: the one with the pixel centre's major coordinate,
//!   or the nearer end. (A point stands for itself.) Its depth is the true line's.
//! * p is hidden where a triangle other than its carriers covers it and is strictly nearer there. Carriers never hide.
//! * The pixel shows what is at its centre c, up to half a pixel away. Where something else decides there than at p, the
//!   border of a surface runs between the two, and any answer is right: *undecided*, and not counted. That is so if p is
//!   hidden but no triangle that hides it, nor one beside it, covers c; or if p is not hidden, but a triangle that does
//!   not cover p, shares no corner with a carrier, and is nearer than p, covers c. Covers: as it is and as its corners are
//!   snapped, of which the card knows the latter alone; where the two differ at c, so do right answers.
//!
//! Signs and comparisons are floats where they are beyond a bound of their error, and rationals where they are not.

use std::cell::LazyCell;
use std::cmp::Ordering;

use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::scene::{Place, Projection, SIDE, Scene};
use crate::oracle::clip::Homogeneous;
use crate::oracle::exact::{integer, ratio, round_ties_even};
use crate::oracle::raster::for_each_pixel;
use crate::oracle::{Primitive, Vertex};

/// What exact arithmetic says of a marking's pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Must be seen.
    Seen,
    /// Must not be seen.
    Hidden,
    /// Between two surfaces.
    Undecided,
}

/// A pixel of a marking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragment {
    /// Column and row.
    pub pixel: [u32; 2],
    /// What must be.
    pub answer: Answer,
    /// Slope that the marking must survive here: change of eye-space distance over a pixel, in pixels. Of a line the
    /// larger of |dz/dx| and |dz/dy|, of a point their sum; the greatest of the carriers'.
    pub slope: f64,
    /// How far the carriers' planes are nearer at the pixel's centre than the marking is, in pixels of eye-space
    /// distance; the decal transform moves by S / 2.
    pub need: f64,
}

/// A place that is asked about; its exact form is made when floats cannot tell.
struct At<'a> {
    about: [f64; 3],
    exact: LazyCell<[BigRational; 3], Box<dyn FnOnce() -> [BigRational; 3] + 'a>>,
}

impl<'a> At<'a> {
    fn new(about: [f64; 3], exact: impl FnOnce() -> [BigRational; 3] + 'a) -> Self {
        Self { about, exact: LazyCell::new(Box::new(exact)) }
    }
}

/// A point on the screen: pixels, y down, and depth 0 to 1; exactly and about.
#[derive(Clone, Debug)]
pub(super) struct Spot {
    exact: [BigRational; 3],
    pub(super) about: [f64; 3],
}

impl Spot {
    fn new(exact: [BigRational; 3]) -> Self {
        let about = [0, 1, 2].map(|axis| exact[axis].to_f64().unwrap_or(f64::NAN));
        Self { exact, about }
    }

    /// Position in u.
    pub(super) fn snapped(&self) -> Vertex {
        let [x, y] =
            [0, 1].map(|axis| round_ties_even(&(&self.exact[axis] * integer(256))).to_i32().unwrap_or(i32::MAX));
        Vertex::at(x, y, 0)
    }
}

/// The exact way from eye space to the screen.
pub(super) struct Lens {
    eye_clip: [[f32; 4]; 4],
    projection: Projection,
}

impl Lens {
    /// # Panics
    /// When the camera is none, which those of [`super::Projection`] are not.
    pub(super) fn new(scene: &Scene) -> Self {
        let matrices = scene.projection.camera().matrices(SIDE, SIDE).unwrap_or_else(|error| panic!("{error}"));
        let m = matrices.eye_clip;
        let row = |r: usize| [m[4 * r], m[4 * r + 1], m[4 * r + 2], m[4 * r + 3]];
        Self { eye_clip: [row(0), row(1), row(2), row(3)], projection: scene.projection }
    }

    /// # Panics
    /// When the place has a NaN or lies at the viewer.
    pub(super) fn spot(&self, place: Place) -> Spot {
        let clip =
            Homogeneous::from_f32([place[0], place[1], place[2], 1.0]).and_then(|p| p.transformed(&self.eye_clip));
        let Some(Homogeneous([x, y, z, w])) = clip else { panic!("a place without a NaN") };
        let half = ratio(SIDE.into(), 2);
        let exact = [&half * (x / &w) + &half, &half - &half * (y / &w), z / &w];
        Spot::new(exact)
    }

    /// A change of depth, where depth is `z`, as a change of eye-space distance in pixels. Depth reaches from 1 to 1000.
    fn in_pixels(&self, change: f64, z: f64) -> f64 {
        let [near, far] = [1.0, 1000.0];
        if self.projection == Projection::Perspective {
            // z = (1 - near / distance) far / (far - near).
            let distance = near / (1.0 - z * (far - near) / far);
            change * distance * distance * (far - near) / (far * near) / self.projection.pixel(distance)
        } else {
            change * (far - near) / self.projection.pixel(0.0)
        }
    }
}

/// A triangle on the screen.
pub(super) struct Face {
    pub(super) corners: [Spot; 3],
    low: [f64; 2],
    high: [f64; 2],
    /// Seen from its edge: it covers nothing.
    flat: bool,
    /// Corners as the card has them, u.
    snapped: [[i64; 2]; 3],
}

/// Side of a directed edge that a point is on.
fn side(from: &Spot, to: &Spot, at: &At<'_>) -> Ordering {
    let [a, b, p] = [&from.about, &to.about, &at.about];
    let about = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    // Coordinates are below 2^11 and good for 2^-42: a product is off by less than 2^-28.
    if about.abs() > 1e-7 {
        return about.total_cmp(&0.0);
    }
    turn(&from.exact, &to.exact, &at.exact)
}

/// Sign of twice the area of three places.
fn turn(a: &[BigRational; 3], b: &[BigRational; 3], p: &[BigRational; 3]) -> Ordering {
    let twice = (&b[0] - &a[0]) * (&p[1] - &a[1]) - (&b[1] - &a[1]) * (&p[0] - &a[0]);
    twice.cmp(&BigRational::zero())
}

impl Face {
    fn new(corners: [Spot; 3]) -> Self {
        let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
            corners.iter().map(|corner| corner.about[axis]).reduce(pick).unwrap_or(f64::NAN)
        };
        let (low, high) = ([0, 1].map(|axis| bound(axis, f64::min)), [0, 1].map(|axis| bound(axis, f64::max)));
        let flat = turn(&corners[0].exact, &corners[1].exact, &corners[2].exact) == Ordering::Equal;
        let snapped = corners.each_ref().map(Spot::snapped).map(|corner| [corner.x.into(), corner.y.into()]);
        Self { corners, low, high, flat, snapped }
    }

    /// Whether a point lies in the triangle or on its border.
    fn covers(&self, at: &At<'_>) -> bool {
        let near = |axis: usize| (self.low[axis] - 1e-6..=self.high[axis] + 1e-6).contains(&at.about[axis]);
        if self.flat || !near(0) || !near(1) {
            return false;
        }
        let [a, b, c] = &self.corners;
        let sides = [side(a, b, at), side(b, c, at), side(c, a, at)];
        !(sides.contains(&Ordering::Less) && sides.contains(&Ordering::Greater))
    }

    /// Whether a pixel's centre lies in the snapped triangle or on its border.
    fn covers_snapped(&self, pixel: [u32; 2]) -> bool {
        let centre = pixel.map(|place| i64::from(place) * 256 + 128);
        let side = |from: [i64; 2], to: [i64; 2]| {
            ((to[0] - from[0]) * (centre[1] - from[1]) - (to[1] - from[1]) * (centre[0] - from[0])).signum()
        };
        let [a, b, c] = self.snapped;
        let sides = [side(a, b), side(b, c), side(c, a)];
        sides != [0; 3] && !(sides.contains(&1) && sides.contains(&-1))
    }

    /// The plane as depth = z_a + g . (p - a).
    pub(super) fn gradient(&self) -> [f64; 2] {
        let [a, b, c] = &self.corners;
        let [u, v] = [b, c].map(|to| [0, 1, 2].map(|axis| to.about[axis] - a.about[axis]));
        let area = u[0] * v[1] - u[1] * v[0];
        [(u[2] * v[1] - v[2] * u[1]) / area, (u[0] * v[2] - v[0] * u[2]) / area]
    }

    /// Whether the plane is strictly nearer at a point than the point's own depth.
    fn nearer_at(&self, at: &At<'_>) -> bool {
        let [a, b, c] = &self.corners;
        let [u, v, p] = [&b.about, &c.about, &at.about].map(|to| [0, 1, 2].map(|axis| to[axis] - a.about[axis]));
        let area = u[0] * v[1] - u[1] * v[0];
        // How far the point is behind the plane, times the area.
        let terms = [p[2] * area, -(u[2] * v[1] - v[2] * u[1]) * p[0], -(u[0] * v[2] - v[0] * u[2]) * p[1]];
        let behind: f64 = terms.iter().sum();
        // Coordinate differences are below 2^11 and good for 2^-41, depths below 1 and good for 2^-52: a term is off by
        // less than 2^-28 of depth differences. Those of one scene go down to 1e-6, which leaves the bound relative.
        let scale = (u[2].abs() + v[2].abs() + p[2].abs()) * 4096.0 * 1e-9 + 1e-9;
        if behind.abs() > scale {
            return (behind > 0.0) == (area > 0.0);
        }
        let difference = |to: &[BigRational; 3]| [0, 1, 2].map(|axis| &to[axis] - &a.exact[axis]);
        let [u, v, p] = [difference(&b.exact), difference(&c.exact), difference(&at.exact)];
        let area = &u[0] * &v[1] - &u[1] * &v[0];
        let behind = &p[2] * &area - (&u[2] * &v[1] - &v[2] * &u[1]) * &p[0] - (&u[0] * &v[2] - &v[0] * &u[2]) * &p[1];
        (behind.is_positive() && area.is_positive()) || (behind.is_negative() && area.is_negative())
    }
}

/// A scene on the screen.
pub(super) struct Truth {
    lens: Lens,
    pub(super) faces: Vec<Face>,
    /// Which triangles share a corner.
    beside: Vec<Vec<usize>>,
}

impl Truth {
    pub(super) fn new(scene: &Scene) -> Self {
        let lens = Lens::new(scene);
        let faces = scene.surfaces.iter().map(|triangle| Face::new(triangle.map(|place| lens.spot(place)))).collect();
        let touch = |a: &[Place; 3], b: &[Place; 3]| a.iter().any(|corner| b.contains(corner));
        let all = || scene.surfaces.iter().enumerate();
        let beside =
            scene.surfaces.iter().map(|a| all().filter(|(_, b)| touch(a, b)).map(|(k, _)| k).collect()).collect();
        Self { lens, faces, beside }
    }

    /// The pixels of all markings.
    pub(super) fn fragments(&self, scene: &Scene) -> Vec<Fragment> {
        let mut fragments = Vec::new();
        for marking in &scene.markings {
            let ends: Vec<Spot> = marking.ends.iter().map(|&place| self.lens.spot(place)).collect();
            let snapped: Vec<Vertex> = ends.iter().map(Spot::snapped).collect();
            let primitive = match snapped[..] {
                [from, to] => Primitive::Line([from, to]),
                _ => Primitive::Point(snapped[0]),
            };
            for_each_pixel(&primitive, SIDE, SIDE, |i, j| {
                let at = true_point(&ends, [i, j]);
                let answer = self.answer(&marking.carriers, &at, [i, j]);
                let slope = self.slope(&marking.carriers, &at, ends.len() == 1);
                let need = self.need(&marking.carriers, &at, [i, j]);
                fragments.push(Fragment { pixel: [i, j], answer, slope, need });
            });
        }
        fragments
    }

    fn slope(&self, carriers: &[usize], at: &At<'_>, point: bool) -> f64 {
        let of = |carrier: &usize| {
            let [x, y] = self.faces[*carrier].gradient().map(f64::abs);
            self.lens.in_pixels(if point { x + y } else { x.max(y) }, at.about[2])
        };
        carriers.iter().map(of).fold(0.0, f64::max)
    }

    fn need(&self, carriers: &[usize], at: &At<'_>, pixel: [u32; 2]) -> f64 {
        let off = [0, 1].map(|axis| f64::from(pixel[axis]) + 0.5 - at.about[axis]);
        let of = |carrier: &usize| {
            let gradient = self.faces[*carrier].gradient();
            self.lens.in_pixels(-(gradient[0] * off[0] + gradient[1] * off[1]), at.about[2])
        };
        carriers.iter().map(of).fold(0.0, f64::max)
    }

    fn answer(&self, carriers: &[usize], at: &At<'_>, pixel: [u32; 2]) -> Answer {
        let [x, y] = pixel.map(|place| f64::from(place) + 0.5);
        let centre = At::new([x, y, at.about[2]], || {
            let [x, y] = pixel.map(|place| integer(place) + ratio(1, 2));
            [x, y, at.exact[2].clone()]
        });
        let foreign = || (0..self.faces.len()).filter(|face| !carriers.contains(face));
        let hides = |&face: &usize| self.faces[face].covers(at) && self.faces[face].nearer_at(at);
        let hiding: Vec<usize> = foreign().filter(hides).collect();
        if !hiding.is_empty() {
            let at_centre = |face: usize| self.faces[face].covers(&centre) && self.faces[face].covers_snapped(pixel);
            let held = hiding.iter().any(|&face| self.beside[face].iter().any(|&beside| at_centre(beside)));
            return if held { Answer::Hidden } else { Answer::Undecided };
        }
        let attached = |face: usize| carriers.iter().any(|&carrier| self.beside[carrier].contains(&face));
        let intrudes = |face: usize| {
            let shape = &self.faces[face];
            (shape.covers(&centre) || shape.covers_snapped(pixel))
                && !shape.covers(at)
                && !attached(face)
                && shape.nearer_at(&centre)
        };
        if foreign().any(intrudes) { Answer::Undecided } else { Answer::Seen }
    }
}

/// The point that a pixel of a marking stands for.
fn true_point(ends: &[Spot], pixel: [u32; 2]) -> At<'_> {
    let [from, to] = ends else { return At::new(ends[0].about, || ends[0].exact.clone()) };
    let along = [0, 1].map(|axis| (to.about[axis] - from.about[axis]).abs());
    // Where the two are equal as far as floats can tell, either coordinate leads to the same point of the line.
    let major = usize::from(along[0] < along[1]);
    let middle = f64::from(pixel[major]) + 0.5;
    let part = ((middle - from.about[major]) / (to.about[major] - from.about[major])).clamp(0.0, 1.0);
    At::new([0, 1, 2].map(|axis| from.about[axis] + part * (to.about[axis] - from.about[axis])), move || {
        let run = &to.exact[major] - &from.exact[major];
        let part = (integer(pixel[major]) + ratio(1, 2) - &from.exact[major]) / run;
        let part = part.clamp(BigRational::zero(), integer(1));
        [0, 1, 2].map(|axis| &from.exact[axis] + &part * (&to.exact[axis] - &from.exact[axis]))
    })
}
