//! The exact oracle: what a scene must look like, decided from the written rules alone.
//!
//! It shares no code with the card and takes no short cut of the card's: every decision is made with
//! `i128` integers or with rationals of unbounded size, so nothing here rounds unless a rule says "rounded".
//!
//! | module | answers | source of the rule |
//! | --- | --- | --- |
//! | [`raster`] | which pixels (or points, or how much of a pixel) a primitive covers | top-left rule (Direct3D 10 rasterisation rules); diamond-exit rule (OpenGL 4.6, 14.5.1) |
//! | [`depth`] | the depth on the exact plane, and the depth that the card's number formats prescribe | the card's manual, "Depth" |
//! | [`image`] | the picture bit for bit: [`draw`] | submission order, one depth test for each covered pixel |
//! | [`stencil`] | the stencil test, what becomes of stencil values, the shadow bit | the card's manual, "Stencil" |
//! | [`truth`] | the picture with unrounded depths: [`draw_true`] | the same, compared as rationals |
//! | [`canvas`] | the picture of many commands: any state, clears of planes and rectangles | the same |
//! | [`clip`] | the unsnapped polygon of a homogeneous triangle | Sutherland and Hodgman 1974; Blinn and Newell 1978 |
//! | [`supersample`] | the anti-aliased picture: masks, layers, mean of the samples | the rules of one sample, at each sample; Porter and Duff 1984 |
//! | [`colour`] | affine and perspective-correct colours at a pixel centre | barycentric interpolation; Blinn 1992, "Hyperbolic interpolation" |
//! | [`effects`] | texture, light, fog, blending, holes: exact where roundings are prescribed, ideal where they are not | the card's manual; see there |
//! | [`exact`] | fractions, floors and roundings | arithmetic |
//!
//! Whole pictures have two forms: a plain one that is the definition, and a fast one that equals it, exact too
//! (`bands`: rows as exact runs, shared out to threads). Example `oracle_time` tells what they take.
//!
//! Units: `u` is 1/256 pixel; pixel `(i, j)` is the square `[256 i, 256 i + 256] x [256 j, 256 j + 256]` with its
//! centre at `(256 i + 128, 256 j + 128)`; y points down. Depths are integers, larger is farther; one *step* is one
//! unit of the stored depth (1 LSB).
//!
//! Coordinates may take any value of an `i32` (the card itself stops at +-2^23 u), depths any value of 31 bits and
//! pixels any number within +-2^24: no intermediate of an `i128` computation exceeds 2^125.
//!
//! ```
//! use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};
//!
//! let triangle = Primitive::Triangle([Vertex::at(0, 0, 5), Vertex::at(1024, 0, 5), Vertex::at(0, 1024, 5)]);
//! let image = draw(4, 4, &[triangle], DepthFormat::default(), DepthFunction::Less);
//! assert_eq!(image.winner[0], Some(0));
//! assert_eq!(image.depth[15], (1 << 24) - 1);
//! ```

mod bands;
pub mod canvas;
pub mod clip;
pub mod colour;
pub mod depth;
pub mod effects;
pub mod exact;
pub mod image;
pub mod raster;
pub mod stencil;
pub mod supersample;
pub mod truth;

pub use image::{Image, draw};
pub use truth::{TrueImage, Verdict, draw_true};

/// A vertex after the snap.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Vertex {
    /// s16.8 pixels, to the right.
    pub x: i32,
    /// s16.8 pixels, down.
    pub y: i32,
    /// Depth in steps, `0..=2^n - 1`.
    pub z: u32,
    /// Red, green, blue, alpha, `0..=255`.
    pub colour: [u8; 4],
}

impl Vertex {
    /// A black, transparent vertex; `x` and `y` in u, `z` in steps.
    #[must_use]
    pub const fn at(x: i32, y: i32, z: u32) -> Self {
        Self { x, y, z, colour: [0; 4] }
    }

    /// The same vertex with another colour.
    #[must_use]
    pub const fn coloured(self, colour: [u8; 4]) -> Self {
        Self { colour, ..self }
    }
}

/// One primitive of a scene. Its position in the scene's list is its identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Primitive {
    /// Either winding is drawn; twice-area 0 draws nothing.
    Triangle([Vertex; 3]),
    /// From the first vertex to the second, width 1; the order matters (half-open).
    Line([Vertex; 2]),
    /// One pixel.
    Point(Vertex),
}

impl Primitive {
    /// The vertices in their order.
    #[must_use]
    pub fn vertices(&self) -> &[Vertex] {
        match self {
            Self::Triangle(vertices) => vertices,
            Self::Line(vertices) => vertices,
            Self::Point(vertex) => std::slice::from_ref(vertex),
        }
    }
}

/// How depths are stored and how finely their gradients are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DepthFormat {
    /// n: bits of a stored depth, 16, 24 or 31.
    pub bits: u32,
    /// F: fraction bits of the gradients and of the reference depth, 0, 8, 16 or 24.
    pub fraction: u32,
}

impl DepthFormat {
    /// The largest depth, `2^n - 1`; what a cleared pixel holds.
    #[must_use]
    pub const fn greatest(self) -> u32 {
        ((1u64 << self.bits) - 1) as u32
    }
}

impl Default for DepthFormat {
    /// n = 24, F = 24.
    fn default() -> Self {
        Self { bits: 24, fraction: 24 }
    }
}

/// The depth test: which new depths replace the stored one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthFunction {
    /// No fragment passes.
    Never,
    /// New < stored. Of equals the earlier stays.
    #[default]
    Less,
    /// New = stored.
    Equal,
    /// New <= stored. Of equals the later stays.
    LessEqual,
    /// New > stored.
    Greater,
    /// New != stored.
    NotEqual,
    /// New >= stored.
    GreaterEqual,
    /// Every fragment passes.
    Always,
}

impl DepthFunction {
    /// All eight, in the order of the card's register.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// Whether a fragment of depth `new` replaces the stored depth `stored`.
    #[must_use]
    pub fn passes<D: PartialOrd>(self, new: &D, stored: &D) -> bool {
        match self {
            Self::Never => false,
            Self::Less => new < stored,
            Self::Equal => new == stored,
            Self::LessEqual => new <= stored,
            Self::Greater => new > stored,
            Self::NotEqual => new != stored,
            Self::GreaterEqual => new >= stored,
            Self::Always => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_three_orders_match_the_table() {
        // Rows: new < stored, new = stored, new > stored; columns as in ALL.
        let table = [(1u32, 2u32), (2, 2), (3, 2)]
            .map(|(new, stored)| DepthFunction::ALL.map(|f| u8::from(f.passes(&new, &stored))));

        assert_eq!(table, [[0, 1, 0, 1, 0, 1, 0, 1], [0, 0, 1, 1, 0, 0, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1]]);
    }

    #[test]
    fn greatest_all_widths_are_all_ones() {
        let widths = [16, 24, 31].map(|bits| DepthFormat { bits, fraction: 0 }.greatest());

        assert_eq!(widths, [0xffff, 0x00ff_ffff, 0x7fff_ffff]);
    }
}
