//! Z comparator array: one comparator for each pixel of the tile, all of them at work at once.
//!
//! Duties: coverage and depth test of one polygon after another. Inputs: the polygon's set-up, the same
//! for all; depths at the start of the tile. Outputs: for each pixel the polygon seen, its depth, and the
//! division ratios t0, t1, t2 of its vertices there.
//!
//! What a comparator keeps in the source: polygon id, 1 / z, t0, t1, t2, window, stencil, shadow. Here
//! * the id is the place of the polygon's vertices in the parameter buffer;
//! * in place of 1 / z stands the card's stored depth, on the quantised plane that every path shares (as
//!   1 / z it is affine on the screen); any depth function, with or without write, decides;
//! * the ratios are exact: numerators of edge functions over the polygon's doubled area, which is kept
//!   once with its vertices. Coverage *is* their signs, with the top-left rule where one is 0. Of a line
//!   they divide its major axis;
//! * the stencil value is tested and changed by the rule that every path shares ([`crate::hidden::stencil`]), and the
//!   shadow bit follows from it when the tile is written out; window is a bit of the register ([`super::storage`]) that
//!   nothing drives.
//!
//! Clocks: 3 a polygon, for the set-up; see [`super::clocks`].

use crate::geometry::line::Line;
use crate::geometry::plane::{Axis, DepthPlane};
use crate::geometry::triangle::doubled_area;
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};
use crate::hidden::stencil::{StencilCounts, StencilRule};
use crate::hidden::z_buffer::DepthTest;
use crate::shading::plane::ColourPlane;
use zga_firmware::checked::Rectangle;

/// Place of a polygon in the parameter buffer.
pub type Slot = u16;

/// The id of a comparator whose pixel nothing was drawn to.
pub const NONE: Slot = Slot::MAX;

/// Numerators of t0, t1, t2.
pub type Ratios = [i64; 3];

/// One comparator's registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Comparator {
    /// Polygon seen, or [`NONE`].
    pub id: Slot,
    /// Stencil value; 0 in a scene that does not ask for any.
    pub stencil: u8,
    /// Depth.
    pub depth: i32,
    /// Division ratios of the polygon seen.
    pub ratios: Ratios,
}

/// An edge function: positive inside.
#[derive(Clone, Copy, Debug, Default)]
struct EdgeFunction {
    /// A point of the edge, u.
    from: [i64; 2],
    /// Its direction, u.
    along: [i64; 2],
}

impl EdgeFunction {
    fn new(a: &ScreenVertex, b: &ScreenVertex) -> EdgeFunction {
        let [ax, ay, bx, by] = [a.x, a.y, b.x, b.y].map(i64::from);
        EdgeFunction { from: [ax, ay], along: [bx - ax, by - ay] }
    }

    fn at(&self, [x, y]: [i64; 2]) -> i64 {
        self.along[0] * (y - self.from[1]) - self.along[1] * (x - self.from[0])
    }

    /// The least value that is inside: left edges (going up) and top edges (going right) own their points.
    fn threshold(&self) -> i64 {
        let [dx, dy] = self.along;
        i64::from(!(dy < 0 || (dy == 0 && dx > 0)))
    }
}

/// Which pixels a polygon covers, and its ratios there.
#[derive(Clone, Copy, Debug)]
pub enum Coverage<'h> {
    /// The edge function opposite each vertex.
    Triangle(TriangleRatios),
    /// A line and its ends.
    Line(&'h Line, &'h [ScreenVertex; 2]),
    /// One pixel.
    Point([i32; 2]),
    /// Every pixel of the area.
    Everywhere,
}

/// The three edge functions of a triangle, each opposite the vertex of its number.
#[derive(Clone, Copy, Debug)]
pub struct TriangleRatios([EdgeFunction; 3]);

impl TriangleRatios {
    /// The functions of a triangle with an area.
    #[must_use]
    pub fn new(v: &[ScreenVertex; 3]) -> TriangleRatios {
        let order = if doubled_area(&v[0], &v[1], &v[2]) > 0 { [0, 1, 2] } else { [0, 2, 1] };
        let mut edges = [EdgeFunction::default(); 3];
        for k in 0..3 {
            edges[order[k]] = EdgeFunction::new(&v[order[(k + 1) % 3]], &v[order[(k + 2) % 3]]);
        }
        TriangleRatios(edges)
    }

    fn at(&self, x: i32, y: i32) -> Option<Ratios> {
        let centre = [x, y].map(|c| i64::from(c * PIXEL + CENTRE));
        let mut ratios = [0; 3];
        for (ratio, edge) in ratios.iter_mut().zip(&self.0) {
            *ratio = edge.at(centre);
            if *ratio < edge.threshold() {
                return None;
            }
        }
        Some(ratios)
    }
}

impl Coverage<'_> {
    /// Ratios at pixel (`x`, `y`), if it is covered.
    #[must_use]
    pub fn at(&self, x: i32, y: i32) -> Option<Ratios> {
        match self {
            Coverage::Triangle(triangle) => triangle.at(x, y),
            Coverage::Line(line, ends) => {
                let (step, minor) = if line.axis == Axis::X { (x, y) } else { (y, x) };
                let drawn = (line.steps[0]..line.steps[1]).contains(&step) && line.minor_at(step) == minor;
                drawn.then(|| {
                    let [a, b] = ends.map(|v| i64::from(if line.axis == Axis::X { v.x } else { v.y }));
                    let centre = i64::from(step * PIXEL + CENTRE);
                    let sign = (b - a).signum();
                    [(b - centre) * sign, (centre - a) * sign, 0]
                })
            }
            Coverage::Point(pixel) => (*pixel == [x, y]).then_some([1, 0, 0]),
            Coverage::Everywhere => Some([1, 0, 0]),
        }
    }
}

/// What decides, and what becomes of the depth.
#[derive(Clone, Copy, Debug)]
pub enum DepthRule {
    /// Everything passes, the depth stays.
    Keep,
    /// Everything passes, this depth is stored.
    Store(i32),
    /// The plane's depth (this many bits below its point) is tested, and stored if the test says so.
    Test(DepthTest, DepthPlane, u32),
}

/// Set-up of a polygon, the same for all comparators.
#[derive(Clone, Debug)]
pub struct SetUp<'h> {
    /// Where it covers.
    pub coverage: Coverage<'h>,
    /// Pixels that may change.
    pub area: Rectangle,
    /// Depth.
    pub depth: DepthRule,
    /// Stencil value.
    pub stencil: StencilRule,
    /// Its colour is drawn: it becomes the polygon seen where it passes.
    pub seen: bool,
    /// What knows the holes of its texture, where that has any.
    pub holes: Option<ColourPlane>,
}

/// All comparators of a tile, row by row.
#[derive(Debug)]
pub struct Array {
    comparators: Vec<Comparator>,
    /// Comparators of a row.
    width: usize,
    /// Pixels of the tile that are on the screen.
    pixels: Rectangle,
    /// Events of stencil tests.
    pub tests: StencilCounts,
}

impl Array {
    /// An array for tiles of `tile` pixels.
    #[must_use]
    pub fn new(tile: [u32; 2]) -> Array {
        let none = Comparator { id: NONE, stencil: 0, depth: 0, ratios: [0; 3] };
        Array {
            comparators: vec![none; (tile[0] * tile[1]) as usize],
            width: tile[0] as usize,
            pixels: Rectangle { x: 0, y: 0, right: 0, bottom: 0 },
            tests: StencilCounts::default(),
        }
    }

    /// Begins a tile that shows `pixels`, with the depth and stencil value that `before` gives for a column and row.
    pub fn reset(&mut self, pixels: Rectangle, before: impl Fn(u32, u32) -> (i32, u8)) {
        self.pixels = pixels;
        for y in pixels.y..pixels.bottom {
            for x in pixels.x..pixels.right {
                let place = self.place(x, y);
                let (depth, stencil) = before(x, y);
                self.comparators[place] = Comparator { id: NONE, stencil, depth, ratios: [0; 3] };
            }
        }
    }

    /// Compares a polygon at all pixels. Comparators that now see it are listed in `won`; their ids are
    /// still those of what they saw before. Returns how many pixels it covers, and how many of them are holes.
    pub fn compare(&mut self, polygon: &SetUp<'_>, won: &mut Vec<usize>) -> [u64; 2] {
        let [mut covered, mut punched] = [0; 2];
        let (area, tile) = (&polygon.area, self.pixels);
        for y in tile.y.max(area.y)..tile.bottom.min(area.bottom) {
            for x in tile.x.max(area.x)..tile.right.min(area.right) {
                let [column, row] = [x as i32, y as i32];
                let Some(ratios) = polygon.coverage.at(column, row) else {
                    continue;
                };
                covered += 1;
                if polygon.holes.as_ref().is_some_and(|holes| holes.is_hole(column, row)) {
                    punched += 1;
                    continue;
                }
                let place = self.place(x, y);
                let mine = &mut self.comparators[place];
                let held = mine.depth;
                let (passes, stores) = match polygon.depth {
                    DepthRule::Keep => (true, None),
                    DepthRule::Store(depth) => (true, Some(depth)),
                    DepthRule::Test(test, plane, below) => {
                        let depth = plane.stored(plane.value(column, row), below);
                        (test.passes(depth, held), test.write.then_some(depth))
                    }
                };
                if !polygon.stencil.decide(&mut mine.stencil, &mut self.tests, || passes) {
                    continue;
                }
                mine.depth = stores.unwrap_or(held);
                if polygon.seen {
                    mine.ratios = ratios;
                    won.push(place);
                }
            }
        }
        [covered, punched]
    }

    /// Changes the polygon that a comparator sees; returns the one before.
    pub fn identify(&mut self, place: usize, id: Slot) -> Slot {
        std::mem::replace(&mut self.comparators[place].id, id)
    }

    /// The comparator of pixel (`x`, `y`), which is one of the tile's.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> &Comparator {
        &self.comparators[self.place(x, y)]
    }

    /// Number of the comparator of a pixel.
    fn place(&self, x: u32, y: u32) -> usize {
        (y - self.pixels.y) as usize * self.width + (x - self.pixels.x) as usize
    }
}
