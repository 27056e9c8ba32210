//! The Utah teapot's surface: 32 bicubic Bézier patches in four sheets.
//!
//! Source: M. Newell, "The Utilization of Procedure Models in Digital Image Synthesis", University of Utah, 1975;
//! J. Blinn, "What, Teapots Again?", IEEE CG&A 7(9), 1987, with the height of the published data (two thirds of
//! the first). Body and lid are profiles turned about the axis in quarters, so four points of each profile make four
//! patches; handle and spout are symmetric, so half of each is given and the other half reflected.
//!
//! Coordinates: y up along the axis, the spout toward +x, the handle toward -x; the bottom at y = 0.
//! Parameters: u runs down the profile (or along handle and spout), v round it. Each patch takes a unit of both.

use glam::DVec3;

/// A sheet of patches, closed in v and open in u.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Rim, body and bottom: u in 0..=4.
    Body,
    /// Knob and lid: u in 0..=2.
    Lid,
    /// Handle, from the upper end to the lower: u in 0..=2.
    Handle,
    /// Spout, from the body to the mouth: u in 0..=2.
    Spout,
}

/// Distance of the inner control points of a quarter circle of radius 1 from its ends.
const QUARTER: f64 = 0.56;
/// The same for the widest row of the knob, which the data give to two digits.
const QUARTER_OF_KNOB: f64 = 0.5625;

/// A row of a profile: radius, height, position of the inner control points.
type Row = (f64, f64, f64);

const fn row(radius: f64, height: f64) -> Row {
    (radius, height, QUARTER)
}

/// Rim, upper body, lower body, bottom.
const BODY: [[Row; 4]; 4] = [
    [row(1.4, 2.4), row(1.3375, 2.53125), row(1.4375, 2.53125), row(1.5, 2.4)],
    [row(1.5, 2.4), row(1.75, 1.875), row(2.0, 1.35), row(2.0, 0.9)],
    [row(2.0, 0.9), row(2.0, 0.45), row(1.5, 0.225), row(1.5, 0.15)],
    [row(1.5, 0.15), row(1.5, 0.075), row(1.425, 0.0), row(0.0, 0.0)],
];

/// Knob, lid.
const LID: [[Row; 4]; 2] = [
    [row(0.0, 3.15), (0.8, 3.15, QUARTER_OF_KNOB), row(0.0, 2.85), row(0.2, 2.7)],
    [row(0.2, 2.7), row(0.4, 2.55), row(1.3, 2.55), row(1.3, 2.4)],
];

/// A row across half of the handle or spout: one end on the plane of symmetry, the other end, half the width. The
/// four control points are the first end, the same moved aside, the second end moved aside, the second end.
type Across = ([f64; 2], [f64; 2], f64);

const HANDLE: [[Across; 4]; 2] = [
    [
        ([-1.6, 2.025], [-1.5, 2.25], 0.3),
        ([-2.3, 2.025], [-2.5, 2.25], 0.3),
        ([-2.7, 2.025], [-3.0, 2.25], 0.3),
        ([-2.7, 1.8], [-3.0, 1.8], 0.3),
    ],
    [
        ([-2.7, 1.8], [-3.0, 1.8], 0.3),
        ([-2.7, 1.575], [-3.0, 1.35], 0.3),
        ([-2.5, 1.125], [-2.65, 0.9375], 0.3),
        ([-2.0, 0.9], [-1.9, 0.6], 0.3),
    ],
];

const SPOUT: [[Across; 4]; 2] = [
    [
        ([1.7, 1.425], [1.7, 0.6], 0.66),
        ([2.6, 1.425], [3.1, 0.825], 0.66),
        ([2.3, 2.1], [2.4, 2.025], 0.25),
        ([2.7, 2.4], [3.3, 2.4], 0.25),
    ],
    [
        ([2.7, 2.4], [3.3, 2.4], 0.25),
        ([2.8, 2.475], [3.525, 2.49375], 0.25),
        ([2.9, 2.475], [3.45, 2.5125], 0.15),
        ([2.8, 2.4], [3.2, 2.4], 0.15),
    ],
];

/// Control points: the first index along u, the second along v.
type Patch = [[DVec3; 4]; 4];

/// The patches of one part.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) part: Part,
    /// Patches along u.
    pub(super) rows: usize,
    /// Patches along v.
    pub(super) columns: usize,
    patches: Vec<Patch>,
}

impl Sheet {
    /// All four sheets: 32 patches.
    pub(super) fn all() -> [Self; 4] {
        [
            Self::turned(Part::Body, &BODY),
            Self::turned(Part::Lid, &LID),
            Self::reflected(Part::Handle, &HANDLE),
            Self::reflected(Part::Spout, &SPOUT),
        ]
    }

    fn turned(part: Part, profile: &[[Row; 4]]) -> Self {
        let quarter = |points: &[Row; 4], turn: usize| {
            points.map(|(radius, height, inner)| {
                [(1.0, 0.0), (1.0, inner), (inner, 1.0), (0.0, 1.0)].map(|(x, z)| {
                    // A quarter turn takes (x, z) to (-z, x), exactly.
                    let (x, z) = (0..turn).fold((x, z), |(x, z), _| (-z, x));
                    DVec3::new(radius * x, height, radius * z)
                })
            })
        };
        let patches = profile.iter().flat_map(|points| (0..4).map(move |turn| quarter(points, turn)));
        Self { part, rows: profile.len(), columns: 4, patches: patches.collect() }
    }

    fn reflected(part: Part, halves: &[[Across; 4]]) -> Self {
        let half = |rows: &[Across; 4]| {
            rows.map(|([x0, y0], [x1, y1], aside)| {
                [(x0, y0, 0.0), (x0, y0, aside), (x1, y1, aside), (x1, y1, 0.0)].map(DVec3::from)
            })
        };
        let other =
            |patch: Patch| patch.map(|[a, b, c, d]| [d, c, b, a].map(|point| DVec3::new(point.x, point.y, -point.z)));
        let patches = halves.iter().flat_map(|rows| [half(rows), other(half(rows))]);
        Self { part, rows: halves.len(), columns: 2, patches: patches.collect() }
    }

    /// The patch and its own parameters at (u, v).
    fn place(&self, u: f64, v: f64) -> (&Patch, f64, f64) {
        let row = (u.floor().max(0.0) as usize).min(self.rows - 1);
        let v = v.rem_euclid(self.columns as f64);
        let column = (v.floor() as usize).min(self.columns - 1);
        (&self.patches[row * self.columns + column], u - row as f64, v - column as f64)
    }

    /// The surface point at (u, v).
    pub(super) fn point(&self, u: f64, v: f64) -> DVec3 {
        let (patch, u, v) = self.place(u, v);
        blend(patch, weights(u), weights(v))
    }

    /// The unit normal at (u, v), outwards. At the poles, where the rows shrink to a point, it is the axis.
    pub(super) fn normal(&self, u: f64, v: f64) -> DVec3 {
        let (patch, local_u, local_v) = self.place(u, v);
        let along = blend(patch, slopes(local_u), weights(local_v));
        let round = blend(patch, weights(local_u), slopes(local_v));
        let pole = if u < 1.0 { DVec3::Y } else { DVec3::NEG_Y };
        if round.length() > 1e-9 { round.cross(along).normalize_or(pole) } else { pole }
    }
}

/// Bernstein weights of degree 3; exactly the end points at 0 and 1.
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

fn blend(patch: &Patch, along: [f64; 4], round: [f64; 4]) -> DVec3 {
    let across = |row: &[DVec3; 4]| row.iter().zip(round).map(|(point, weight)| *point * weight).sum::<DVec3>();
    patch.iter().zip(along).map(|(row, weight)| across(row) * weight).sum()
}
