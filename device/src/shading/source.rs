//! What a primitive's colours are made from.
//!
//! Duties: keeps place, colour and 1 / w of the vertices until the primitive turns out to be seen. Inputs from: set-up.
//! Outputs to: [`super::plane`], [`super::rare`]. Clocks: none.

use super::levels::whole_double;
use super::plane::Interpolation;
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};

/// What a primitive's colours are made from, once it turns out to be seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct ColourSource {
    /// x, y of the vertices; s16.8, pixels. A line repeats its second vertex, a point its only one.
    pub(super) position: [[i32; 2]; 3],
    /// RGBA of the vertices, R in 7:0.
    pub(super) colour: [u32; 3],
    /// 1 / w of the vertices.
    pub(super) reciprocal_w: [f32; 3],
}

/// What the shares of a triangle's second and third vertex at a place follow from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    origin: [f64; 2],
    /// From the first vertex to the others.
    edges: [[f64; 2]; 2],
    /// 1 / twice the area.
    inverse: f64,
    /// 1 / w of the others relative to the first's, where that matters.
    relative_w: Option<[f64; 2]>,
}

impl Shares {
    /// The shares at `place`, u.
    #[inline(always)]
    pub(super) fn at(&self, place: [i32; 2]) -> [f64; 2] {
        let [[x1, y1], [x2, y2]] = self.edges;
        let (px, py) = (f64::from(place[0]) - self.origin[0], f64::from(place[1]) - self.origin[1]);
        let share = [(px * y2 - py * x2) * self.inverse, (x1 * py - y1 * px) * self.inverse];
        let Some(w) = self.relative_w else {
            return share;
        };
        let weights = [1.0 - share[0] - share[1], share[0] * w[0], share[1] * w[1]];
        let inverse = 1.0 / (weights[0] + weights[1] + weights[2]);
        [weights[1] * inverse, weights[2] * inverse]
    }
}

/// One channel of a triangle's colours.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture {
    /// Level of the first vertex.
    first: f64,
    /// From it to the others.
    rises: [f64; 2],
    /// Least and greatest level of the vertices.
    limits: [f64; 2],
}

impl Mixture {
    /// The level where the other vertices have these shares.
    #[inline(always)]
    pub(super) fn level(&self, shares: [f64; 2]) -> u32 {
        let value = self.first + shares[0] * self.rises[0] + shares[1] * self.rises[1];
        // max and min put the range's ends where there is a NaN.
        whole_double(value.max(self.limits[0]).min(self.limits[1]) + 0.5)
    }
}

impl ColourSource {
    /// The source of a primitive with these vertices.
    #[must_use]
    #[inline(always)]
    pub fn new(v: &[ScreenVertex; 3]) -> ColourSource {
        let [a, b, c] = v;
        ColourSource {
            position: [[a.x, a.y], [b.x, b.y], [c.x, c.y]],
            colour: [a.colour, b.colour, c.colour],
            reciprocal_w: [a.reciprocal_w, b.reciprocal_w, c.reciprocal_w],
        }
    }

    /// The place of the first vertex, u.
    #[must_use]
    #[inline(always)]
    pub fn first_place(&self) -> [i32; 2] {
        self.position[0]
    }

    /// The places of the vertices, u.
    #[must_use]
    #[inline(always)]
    pub fn places(&self) -> [[i32; 2]; 3] {
        self.position
    }

    /// The colour of a flat primitive: its first vertex's.
    #[must_use]
    #[inline(always)]
    pub fn flat(&self) -> u32 {
        self.colour[0]
    }

    /// Colour of a triangle at a place that it covers, `[x, y]` in u: for fragments whose pixel's centre lies outside.
    /// The reference in f64, with the clamp and the rounding of the planes.
    #[must_use]
    pub fn colour_at(&self, place: [i32; 2], interpolation: Interpolation) -> u32 {
        if interpolation == Interpolation::Flat || self.is_even() {
            return self.flat();
        }
        let shares = self.shares(interpolation).at(place);
        (0..4).map(|k| self.mixture(k).level(shares) << (8 * k as u32)).sum()
    }

    /// All vertices have one colour.
    #[inline(always)]
    pub(super) fn is_even(&self) -> bool {
        self.colour[0] == self.colour[1] && self.colour[0] == self.colour[2]
    }

    /// What the shares of the vertices at a place follow from.
    #[inline(always)]
    pub(super) fn shares(&self, interpolation: Interpolation) -> Shares {
        // Differences of coordinates have 25 bits, their products 50: exact in f64.
        let [x0, y0] = self.position[0].map(f64::from);
        let along = |[x, y]: [i32; 2]| [f64::from(x) - x0, f64::from(y) - y0];
        let edges = [along(self.position[1]), along(self.position[2])];
        let [[x1, y1], [x2, y2]] = edges;
        let relative_w =
            (interpolation == Interpolation::Perspective).then(|| [self.relative_w(1), self.relative_w(2)]);
        Shares { origin: [x0, y0], edges, inverse: 1.0 / (x1 * y2 - y1 * x2), relative_w }
    }

    /// Channel `k` at the vertices.
    #[inline(always)]
    pub(super) fn mixture(&self, k: usize) -> Mixture {
        let [a, b, c] = [0, 1, 2].map(|vertex| f64::from(self.channel(vertex, k)));
        Mixture { first: a, rises: [b - a, c - a], limits: [a.min(b).min(c), a.max(b).max(c)] }
    }

    /// 1 / w of vertex `n` relative to vertex 0: keeps planes in range for any w.
    #[inline(always)]
    pub(super) fn relative_w(&self, n: usize) -> f64 {
        f64::from(self.reciprocal_w[n]) / f64::from(self.reciprocal_w[0])
    }

    /// Pixels from vertex 0 to the farthest vertex, along x (0) or y (1), and the anchor's own.
    #[inline(always)]
    pub(super) fn extent(&self, axis: usize) -> f64 {
        let far = |n: usize| (self.position[n][axis] - self.position[0][axis]).abs();
        f64::from(far(1).max(far(2)) / PIXEL + 1)
    }

    /// The same with its vertices in the given order.
    #[inline(always)]
    pub(super) fn ordered(&self, order: [usize; 3]) -> ColourSource {
        ColourSource {
            position: order.map(|n| self.position[n]),
            colour: order.map(|n| self.colour[n]),
            reciprocal_w: order.map(|n| self.reciprocal_w[n]),
        }
    }

    /// Row, then column: what vertices are ordered by.
    #[inline(always)]
    pub(super) fn place(&self, vertex: usize) -> [i32; 2] {
        let [x, y] = self.position[vertex];
        [y, x]
    }

    #[inline(always)]
    pub(super) fn channel(&self, vertex: usize, k: usize) -> u8 {
        self.colour[vertex].to_le_bytes()[k]
    }

    /// From vertex 0 to vertex `k`, u.
    #[inline(always)]
    pub(super) fn edge(&self, k: usize) -> [i64; 2] {
        let along = |c: usize| i64::from(self.position[k][c]) - i64::from(self.position[0][c]);
        [along(0), along(1)]
    }

    /// From vertex 0 to the centre of its pixel, u.
    #[inline(always)]
    pub(super) fn offset_to_centre(&self) -> [i32; 2] {
        self.position[0].map(|c| CENTRE - (c & (PIXEL - 1)))
    }

    /// The pixel of vertex 0.
    #[inline(always)]
    pub(super) fn anchor(&self) -> [i32; 2] {
        self.position[0].map(|c| c >> 8)
    }
}
