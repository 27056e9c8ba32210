//! Scenes with surface markings, in eye space: the viewer at the origin looks down -z, x to the right, y up.
//!
//! Lengths are given in *pixels of the patch's place*: one pixel is delta = 1/K (orthographic) or distance/K
//! (perspective). A marking knows its *carriers*, the triangles that it lies in by construction: their planes hold it
//! exactly, whatever the f32 of its vertices rounded.

use zga_driver::Camera;

/// Square targets: pixels of a side.
pub const SIDE: u32 = 192;

/// How eye space becomes a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// A pixel is 1/64 unit everywhere.
    Orthographic,
    /// 40 degrees across: a pixel is distance/264.
    Perspective,
}

impl Projection {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Orthographic, Self::Perspective];

    /// Name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Orthographic => "orthographic",
            Self::Perspective => "perspective",
        }
    }

    /// The camera. Depth reaches from 1 to 1000 units.
    #[must_use]
    pub fn camera(self) -> Camera {
        let (eye, target, up, near, far) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 1.0, 1000.0);
        match self {
            Self::Orthographic => Camera::Orthographic { eye, target, up, width: SIDE as f32 / 64.0, near, far },
            Self::Perspective => Camera::Perspective { eye, target, up, fov_x_degrees: 40.0, near, far },
        }
    }

    /// A pixel in eye-space units at a distance.
    #[must_use]
    pub fn pixel(self, distance: f64) -> f64 {
        let per_unit = self.camera().pixels_per_unit(SIDE);
        match self {
            Self::Orthographic => 1.0 / per_unit,
            Self::Perspective => distance / per_unit,
        }
    }
}

/// A point in eye space.
pub type Place = [f32; 3];

/// A surface marking.
#[derive(Clone, Debug, PartialEq)]
pub struct Marking {
    /// Two ends of a line, or one point.
    pub ends: Vec<Place>,
    /// The triangles it lies in.
    pub carriers: Vec<usize>,
}

/// Surfaces and their markings.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What it is.
    pub name: String,
    /// How it is looked at.
    pub projection: Projection,
    /// Triangles.
    pub surfaces: Vec<[Place; 3]>,
    /// Lines and points.
    pub markings: Vec<Marking>,
}

impl Scene {
    /// Nothing yet.
    #[must_use]
    pub fn new(name: impl Into<String>, projection: Projection) -> Self {
        Self { name: name.into(), projection, surfaces: Vec::new(), markings: Vec::new() }
    }

    /// Adds a parallelogram as two triangles, and tells which they are.
    pub fn sheet(&mut self, [a, b, c, d]: [Place; 4]) -> Vec<usize> {
        let first = self.surfaces.len();
        self.surfaces.extend([[a, b, c], [c, b, d]]);
        vec![first, first + 1]
    }

    /// Moves everything along the picture by pixels at the place of each vertex, so that orthographic scenes leave the
    /// card's grid; markings stay in their carriers, up to the rounding of positions.
    #[must_use]
    pub fn shifted(mut self, by: [f64; 2]) -> Self {
        let projection = self.projection;
        let shift = |place: &mut Place| {
            let pixel = projection.pixel(-f64::from(place[2]));
            (0..2).for_each(|axis| place[axis] = (f64::from(place[axis]) + by[axis] * pixel) as f32);
        };
        self.surfaces.iter_mut().flatten().for_each(shift);
        self.markings.iter_mut().flat_map(|marking| &mut marking.ends).for_each(shift);
        self
    }

    fn line(&mut self, ends: [Place; 2], carriers: &[usize]) {
        self.markings.push(Marking { ends: ends.to_vec(), carriers: carriers.to_vec() });
    }
}

/// A tilted rectangle about the line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// How it is looked at.
    pub projection: Projection,
    /// The steepest slope found on it: change of distance over a pixel, in pixels.
    pub tilt: f64,
    /// Which way it falls away, degrees from the x axis.
    pub azimuth: f64,
    /// Of its middle.
    pub distance: f64,
    /// Half its side as seen, in pixels.
    pub reach: f64,
}

impl Patch {
    /// The point of the patch that is seen `(x, y)` pixels from the middle, moved `nearer` by pixels.
    ///
    /// Orthographic: distance = middle + tilt * pixels along the azimuth. In perspective a plane has the steepest slope
    /// where it goes farthest away: 1 / distance is linear on the screen, and its gradient is chosen so that the slope
    /// there is the tilt. Orthographic places are put on the card's grid of 1/256 pixel, so that its snap has no part in
    /// what is found there.
    #[must_use]
    pub fn at(&self, [x, y]: [f64; 2], nearer: f64) -> Place {
        let (sin, cos) = self.azimuth.to_radians().sin_cos();
        let pixel = self.projection.pixel(self.distance);
        match self.projection {
            Projection::Orthographic => {
                let [x, y] = [x, y].map(|place| (place * 256.0).round() / 256.0);
                let along = cos * x + sin * y;
                [x * pixel, y * pixel, -(self.distance + (self.tilt * along - nearer) * pixel)].map(|v| v as f32)
            }
            Projection::Perspective => {
                let along = cos * x + sin * y;
                // Slope in pixels: d'(X) / (d / K) with d = d0 / (1 - g X) is g K / (1 - g X).
                let per_unit = self.projection.camera().pixels_per_unit(SIDE);
                let farthest = self.reach * (sin.abs() + cos.abs());
                let gradient = self.tilt / (per_unit + self.tilt * farthest);
                let distance = self.distance / (1.0 - gradient * along) * (1.0 - nearer / per_unit);
                [x / per_unit * distance, y / per_unit * distance, -distance].map(|v| v as f32)
            }
        }
    }

    fn corners(&self, reach: f64, nearer: f64) -> [Place; 4] {
        [[-reach, -reach], [reach, -reach], [-reach, reach], [reach, reach]].map(|corner| self.at(corner, nearer))
    }

    /// Lines in 24 directions with odd ends, a polygon for a curve, and points, all in the patch.
    #[must_use]
    pub fn marked(&self, name: impl Into<String>) -> Scene {
        let mut scene = Scene::new(name, self.projection);
        let carriers = scene.sheet(self.corners(self.reach, 0.0));
        let place = |x: f64, y: f64| self.at([x, y], 0.0);
        for k in 0..24 {
            let angle = f64::from(k) * std::f64::consts::TAU / 24.0 + 0.013;
            let (sin, cos) = angle.sin_cos();
            let [inner, outer] = [0.31, 0.93].map(|part| part * self.reach);
            scene.line([place(inner * cos, inner * sin), place(outer * cos, outer * sin)], &carriers);
        }
        for radius in [0.16, 0.27] {
            let at = |k: i32| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 60.0).sin_cos();
                place(radius * self.reach * cos, radius * self.reach * sin)
            };
            (0..60).for_each(|k| scene.line([at(k), at(k + 1)], &carriers));
        }
        for k in 0..80 {
            // A golden-angle spiral between the spokes' ends and the border.
            let (sin, cos) = (f64::from(k) * 2.399_963).sin_cos();
            let radius = self.reach * 0.96 * (f64::from(k) / 80.0).sqrt();
            scene.markings.push(Marking { ends: vec![place(radius * cos, radius * sin)], carriers: carriers.clone() });
        }
        scene
    }

    /// The marked patch behind a parallel sheet that is `gap` pixels nearer and hides its middle.
    #[must_use]
    pub fn behind(&self, name: impl Into<String>, gap: f64) -> Scene {
        let mut scene = self.marked(name);
        scene.sheet(self.corners(0.8 * self.reach, gap));
        scene
    }
}

/// A floor that reaches from under the viewer to far away, with lines across and along: every slope from 2 to 100.
#[must_use]
pub fn floor(projection: Projection) -> Scene {
    let mut scene = Scene::new("floor", projection);
    let place = |along: f64, x: f64| -> Place {
        // `along` runs from 0 at the lower edge to 1 at the horizon; x in half widths.
        let per_unit = projection.camera().pixels_per_unit(SIDE);
        let y = (along - 1.0) * 0.42 * f64::from(SIDE);
        let x = x * 0.45 * f64::from(SIDE);
        match projection {
            Projection::Perspective => {
                let distance = 5.0 * 80.0 / (80.0 * (1.0 - along) + along);
                [x / per_unit * distance, y / per_unit * distance, -distance].map(|v| v as f32)
            }
            Projection::Orthographic => {
                // One slope everywhere, 32.
                [x / per_unit, y / per_unit, -(5.0 + 40.0 * along)].map(|v| v as f32)
            }
        }
    };
    let carriers = scene.sheet([place(0.0, -1.0), place(0.0, 1.0), place(1.0, -1.0), place(1.0, 1.0)]);
    for k in 1..30 {
        let along = f64::from(k) / 30.3;
        scene.line([place(along, -0.9), place(along + 0.011, 0.93)], &carriers);
        let x = f64::from(k) / 15.0 - 1.0;
        scene.line([place(0.02, x), place(0.97, x * 0.9)], &carriers);
    }
    scene
}

/// Round bodies of facets, all edges marked, the ones on their backs too: five from near to far.
#[must_use]
pub fn bodies(projection: Projection) -> Scene {
    let mut scene = Scene::new("bodies", projection);
    let places =
        [(-48.0, 44.0, 4.0, 34.0), (44.0, 46.0, 9.0, 32.0), (-46.0, -46.0, 30.0, 30.0), (46.0, -40.0, 120.0, 34.0)];
    for (number, (x, y, distance, radius)) in (0..).zip(places) {
        body(&mut scene, [x, y], distance, radius, [8, 11, 14, 18][number]);
    }
    body(&mut scene, [0.0, 2.0], 500.0, 20.0, 9);
    scene
}

/// A globe of triangles: centre and radius in pixels as seen at its distance.
fn body(scene: &mut Scene, [x, y]: [f64; 2], distance: f64, radius: f64, meridians: u32) {
    let pixel = scene.projection.pixel(distance);
    let parallels = meridians / 2;
    // Turned, so that no edge lies along an axis.
    let (turn, lean) = (0.37_f64.sin_cos(), 0.61_f64.sin_cos());
    let vertex = |i: u32, j: u32| -> Place {
        let (sin, cos) = (std::f64::consts::PI * f64::from(j) / f64::from(parallels)).sin_cos();
        let (east, north) = (std::f64::consts::TAU * f64::from(i % meridians) / f64::from(meridians)).sin_cos();
        let [a, b, c] = [sin * north, cos, sin * east];
        let [a, c] = [turn.1 * a + turn.0 * c, turn.1 * c - turn.0 * a];
        let [a, b] = [lean.1 * a + lean.0 * b, lean.1 * b - lean.0 * a];
        let r = radius * pixel;
        [x * pixel + a * r, y * pixel + b * r, -distance + c * r].map(|v| v as f32)
    };
    let mut edges: std::collections::BTreeMap<[[u32; 2]; 2], Vec<usize>> = std::collections::BTreeMap::new();
    let name = |[i, j]: [u32; 2]| if j == 0 || j == parallels { [0, j] } else { [i % meridians, j] };
    for (i, j) in (0..parallels).flat_map(|j| (0..meridians).map(move |i| (i, j))) {
        let corners = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]].map(name);
        for triangle in [[corners[0], corners[1], corners[2]], [corners[2], corners[1], corners[3]]] {
            let [a, b, c] = triangle;
            if a == b || b == c || c == a {
                continue;
            }
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.entry([from.min(to), from.max(to)]).or_default().push(scene.surfaces.len());
            }
            scene.surfaces.push(triangle.map(|[i, j]| vertex(i, j)));
        }
    }
    for ([[a, b], [c, d]], carriers) in edges {
        scene.line([vertex(a, b), vertex(c, d)], &carriers);
    }
}
