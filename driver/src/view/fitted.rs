//! Decals fitted to a surface: moved no farther than the surface that a marking lies on needs.
//!
//! Depth is linear on the screen in every projection, so a flat surface has one gradient g = (dz/dx, dz/dy) there, in parts
//! of the depth range a pixel, and what a marking on it needs is one displacement D of stored depth:
//!
//! ```text
//! D = off(g) + (|gx| + |gy|) / 2^s + rounded + (3 + drift) / (2^n - 1)
//! ```
//!
//! # Why nothing is buried
//!
//! Let c be a pixel's centre that both cover, P the surface's plane, s the bits of the grid, n those of a depth, F those of
//! its fraction. What the marking is farther away at c than the surface is at most the sum of:
//!
//! * **The pixel rule**, `off(g)`. A line's depth at c is that of its point q at the same major coordinate, which is up to 1/2
//!   away along the minor axis: |g . (q - c)| <= max(|gx|, |gy|) / 2. Where c lies beyond an end, the end has its depth and
//!   lies in the diamond |x| + |y| <= 1/2 of c, which gives the same bound: a line that is no steeper than its major axis and
//!   meets the diamond has everything between the diamond and the major coordinate of c inside it. A point is up to 1/2 off in both
//!   axes: (|gx| + |gy|) / 2. A triangle is covered at c itself: 0. With sub-pixel masks a line is a rectangle with the depths of
//!   its middle: half its width times |g|, and 1/2 u for each coordinate of its corners; a point is a square:
//!   half its side, rounded up to u, times |gx| + |gy|.
//! * **The snap** of x and y. A vertex moves by e with |ex|, |ey| <= 2^-(s+1) and keeps its depth. Inside the snapped primitive
//!   depth is a mean of the vertices' with weights of sum 1, so it is off P by a mean of g . e: at most
//!   (|gx| + |gy|) 2^-(s+1), once for the surface, once for the marking.
//! * **Rounded positions**. Vertices are the f32 next to points of P. Off P by n . p in object space is off in depth by a
//!   multiple of it; |n| . |p| 2^-24 is the most that rounding makes of it, and is greatest at a corner. Twice, as above.
//! * **Depth**: 1/2 step for the vertices and 1/2 for the stored value of each, 2 together; rounded gradients drift by (|i| + |j| +
//!   1) 2^-(F+1) steps over i and j pixels. One step more makes the marking nearer and not only as near.
//!
//! The first is reached: a line half a pixel off along the axis of the steeper gradient needs it to the last bit, so no smaller
//! displacement is enough for all lines of a plane. The snap adds 1/64 of it at most with s = 8, the rest some steps.
//!
//! # The limit
//!
//! g grows without end as a surface turns away. It is taken as no greater than that of slope S, the decal's, at the
//! surface's nearest corner: S |dz/d(distance)| / K a pixel. So a fitted decal moves a line no farther than the plain one of slope
//! S does there, but for the small terms; and where the slope is up to S somewhere on a surface nothing is buried anywhere on it.
//!
//! # The matrix
//!
//! Any T'e whose z / w is D less, whatever x, y and distance; x and y are those of the undisplaced vertex on the card.
//!
//! | camera | T'e | why |
//! | --- | --- | --- |
//! | screen, orthographic | z' = z - D / (dz/dz_eye) | depth is linear in z_eye |
//! | perspective | w' = 1 + D z_eye / E, E = far near / (near - far) | depth is a constant + E / z_w with z_w = -z_eye; to clip, E w' / z_w |

use glam::{DMat4, DVec3};
use zga_abi::format::{DepthFormat, Topology};

use super::{Camera, IDENTITY, Matrix, ViewError, camera, finite};

/// The positions of a triangle.
pub type Corners = [[f32; 3]; 3];

/// What a marking consists of, and so how far a pixel or sample of it can be from where it has its depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marking {
    /// Triangles: covered at the centre of a pixel, or a sample.
    Triangles,
    /// Lines a pixel wide.
    Lines,
    /// Points of a pixel.
    Points,
    /// Anti-aliased lines of a width, u8.8 pixels.
    WideLines(u32),
    /// Anti-aliased points with a side, u8.8 pixels.
    WidePoints(u32),
}

impl Marking {
    /// What a draw makes; `widths` of lines and points, u8.8 pixels, where they are anti-aliased.
    #[must_use]
    pub const fn of(topology: Topology, widths: Option<[u32; 2]>) -> Marking {
        match (topology, widths) {
            (Topology::Triangles, _) => Marking::Triangles,
            (Topology::Lines | Topology::LineStrip, None) => Marking::Lines,
            (Topology::Points, None) => Marking::Points,
            (Topology::Lines | Topology::LineStrip, Some([line, _])) => Marking::WideLines(line),
            (Topology::Points, Some([_, point])) => Marking::WidePoints(point),
        }
    }

    /// The most that depth changes between a covered place and the place that it has its depth of.
    fn off(self, [x, y]: [f64; 2]) -> f64 {
        let (x, y) = (x.abs(), y.abs());
        match self {
            Marking::Triangles => 0.0,
            Marking::Lines => x.max(y) / 2.0,
            Marking::Points => (x + y) / 2.0,
            Marking::WideLines(width) => f64::from(width) / 512.0 * x.hypot(y) + (x + y) / 512.0,
            Marking::WidePoints(side) => f64::from(side.div_ceil(2)) / 256.0 * (x + y),
        }
    }
}

/// Where markings are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitView<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Object to world space, of surface and markings.
    pub object: Matrix,
    /// Pixels of the target.
    pub size: [u32; 2],
    /// Format of the target's depths.
    pub format: DepthFormat,
    /// Bits of a pixel that coordinates are snapped to.
    pub subpixel_bits: u32,
}

/// The decal transform for markings on a surface that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedDecal {
    /// T'e: what the DECAL registers hold.
    pub matrix: Matrix,
    /// What it does, in numbers.
    pub info: FitInfo,
}

/// How far a fitted decal moves markings, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitInfo {
    /// |dz/dx| and |dz/dy| on the screen, of the surface that needs most: parts of the depth range a pixel, within the limit.
    pub gradient: [f64; 2],
    /// A surface is steeper than the limit all over: markings on it may be buried.
    pub limited: bool,
    /// D: parts of the depth range, toward the viewer.
    pub displacement: f64,
    /// The same in steps of the Z buffer, at least 3.
    pub depth_steps: f64,
}

impl FittedDecal {
    /// The transform for markings on any of `surfaces`, triangles in object space. `slope`: the limit S, in eye space as
    /// that of [`super::Decal::new`].
    ///
    /// # Errors
    /// [`ViewError::BadNumber`] if the slope is not finite or below 0, a corner is not finite, or the view has no meaning;
    /// [`ViewError::NoSurface`] without a surface, or if the corners of one lie on a line.
    pub fn new(view: &FitView<'_>, slope: f64, surfaces: &[Corners], marking: Marking) -> Result<Self, ViewError> {
        if finite("decal slope", slope)? < 0.0 {
            return Err(ViewError::BadNumber {
                field: "decal slope",
                found: slope,
                expected: "0 or above with a surface",
            });
        }
        let lens = Lens::new(view)?;
        let mut most: Option<FitInfo> = None;
        for (surface, corners) in surfaces.iter().enumerate() {
            let info = lens.need(slope, corners, marking)?.ok_or(ViewError::NoSurface { surface })?;
            if most.is_none_or(|most| info.displacement > most.displacement) {
                let limited = info.limited || most.is_some_and(|most| most.limited);
                most = Some(FitInfo { limited, ..info });
            } else if let Some(most) = &mut most {
                most.limited |= info.limited;
            }
        }
        let info = most.ok_or(ViewError::NoSurface { surface: 0 })?;
        Ok(Self { matrix: lens.matrix(info.displacement), info })
    }
}

/// From object space to depths on the screen, with the numbers that the card gets.
struct Lens<'a> {
    view: &'a FitView<'a>,
    object_eye: DMat4,
    /// Pixels for a unit of clip space x / w and y / w times what x and y of eye space become there.
    scale: [f64; 2],
    /// Perspective: E. Else dz/dz_eye.
    depth: f64,
}

impl<'a> Lens<'a> {
    fn new(view: &'a FitView<'a>) -> Result<Self, ViewError> {
        for (place, entry) in view.object.into_iter().enumerate() {
            let found = finite("object transform", entry.into())?;
            // A projective one would bend the plane's gradient.
            if place % 4 == 3 && entry != IDENTITY[place] {
                let expected = "0, 0, 0, 1 in the last column where a decal has a surface";
                return Err(ViewError::BadNumber { field: "object transform", found, expected });
            }
        }
        let matrices = view.camera.matrices(view.size[0], view.size[1])?;
        let object_eye = camera::narrow(view.camera.view()? * camera::wide(&view.object));
        let (clip, viewport) = (matrices.eye_clip.map(f64::from), matrices.viewport.map(f64::from));
        let depth = if view.camera.is_perspective() { clip[14] } else { clip[10] };
        let scale = [clip[0] * viewport[0], clip[5] * viewport[1]];
        Ok(Self { view, object_eye: camera::wide(&object_eye), scale, depth })
    }

    /// What markings on a surface need; `None` if it has no plane.
    fn need(&self, slope: f64, corners: &Corners, marking: Marking) -> Result<Option<FitInfo>, ViewError> {
        for entry in corners.as_flattened() {
            finite("corner of a surface", (*entry).into())?;
        }
        let perspective = self.view.camera.is_perspective();
        let object = corners.map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()));
        let eye = object.map(|corner| self.object_eye.transform_point3(corner));
        // Sides of differences: those of f32 are exact, or nearly.
        let [u, v] = [1, 2].map(|k| self.object_eye.transform_vector3(object[k] - object[0]));
        let normal = u.cross(v);
        if normal == DVec3::ZERO || !normal.is_finite() {
            return Ok(None);
        }
        // Homogeneous: g = (a, b) / c. Seen from its edge c is 0.
        let [a, b] = [normal.x / self.scale[0], normal.y / self.scale[1]].map(|part| (part * self.depth).abs());
        let c = if perspective { normal.dot(eye[0]) } else { normal.z }.abs();
        // No nearer than the near plane, which is where what lies behind it is cut.
        let [near, _] = self.view.camera.depth_range(self.view.size[0]);
        let distances = eye.map(|corner| -corner.z);
        let nearest = if perspective { distances.into_iter().fold(f64::INFINITY, f64::min).max(near) } else { 1.0 };
        let steepest = self.steepest(slope, nearest);
        let limit = a.max(b) / steepest;
        let limited = a.max(b) > 0.0 && limit > c;
        let c = if limited { limit } else { c };
        let gradient = [a / c, b / c];
        // Off the plane in object space: the normal there is that of eye space taken back.
        let back = self.object_eye.transpose().transform_vector3(normal).abs();
        let rounded = object.map(|corner| back.dot(corner.abs())).into_iter().fold(0.0, f64::max);
        let rounded = 2.0 * rounded * self.depth.abs() / (c * nearest) / 16_777_216.0;
        let (format, steps) = (self.view.format, f64::from(self.view.format.maximum()));
        let drift = (self.reach(&eye) + 1.0) / 2.0_f64.powi(format.fraction().cast_signed());
        let snap = (gradient[0] + gradient[1]) / f64::from(1_u32 << self.view.subpixel_bits);
        // All of this is in f64, good for far more bits than these 20.
        let exact = marking.off(gradient) + snap + rounded + (3.0 + drift) / steps;
        let displacement = exact * (1.0 + 1.0 / f64::from(1 << 20));
        Ok(Some(FitInfo { gradient, limited, displacement, depth_steps: displacement * steps }))
    }

    /// The gradient of slope S at a distance: parts of the depth range a pixel.
    fn steepest(&self, slope: f64, distance: f64) -> f64 {
        let columns = self.view.size[0];
        match self.view.camera {
            // As deep as the picture is wide: see `Decal`.
            Camera::Screen => slope / f64::from(columns),
            Camera::Orthographic { .. } | Camera::Perspective { .. } => {
                slope * self.depth.abs() / (self.view.camera.pixels_per_unit(columns) * distance)
            }
        }
    }

    /// Pixels across and down from one corner to another, at most; no more than the guard band has.
    fn reach(&self, eye: &[DVec3; 3]) -> f64 {
        const GUARD_BAND: f64 = 65_536.0;
        let perspective = self.view.camera.is_perspective();
        let spread = |at: fn(&DVec3) -> f64, scale: f64| {
            let places = eye.map(|corner| at(&corner) * scale / if perspective { -corner.z } else { 1.0 });
            let [low, high] = [f64::min, f64::max].map(|pick| places.into_iter().reduce(pick).unwrap_or(0.0));
            if perspective && eye.iter().any(|corner| corner.z >= 0.0) {
                GUARD_BAND
            } else {
                (high - low).min(GUARD_BAND)
            }
        };
        spread(|corner| corner.x, self.scale[0]) + spread(|corner| corner.y, self.scale[1])
    }

    /// T'e for a displacement.
    fn matrix(&self, displacement: f64) -> Matrix {
        let mut matrix = IDENTITY;
        // `depth` is below 0 but on the screen, where z grows away from the viewer.
        let (entry, value) = match self.view.camera {
            Camera::Perspective { .. } => (11, displacement / self.depth),
            Camera::Screen | Camera::Orthographic { .. } => (14, -displacement / self.depth),
        };
        let narrow = value as f32;
        // Never less than asked for.
        matrix[entry] = if f64::from(narrow).abs() >= value.abs() {
            narrow
        } else if value < 0.0 {
            narrow.next_down()
        } else {
            narrow.next_up()
        };
        matrix
    }
}
