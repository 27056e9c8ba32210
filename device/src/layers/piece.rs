//! An item set up for a tile: what it covers, its depths, its colours.
//!
//! Duties: set-up of what waits, at pixel centres as the hidden-surface paths have it. Inputs from:
//! [`crate::subpixel::scene`]. Outputs to: [`super::tile`], [`super::pixels`], [`super::specification`]. Clocks: none;
//! the geometry unit has charged them.

use super::Counts;
use crate::geometry::assembly::{Point, Shape};
use crate::geometry::line::Line;
use crate::geometry::plane::{Axis, DepthPlane, below};
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::specification::colour_plane;
use crate::shading::plane::{ColourPlane, Interpolated};
use crate::shading::resolve::Sixteen;
use crate::subpixel::scene::{Item, ItemDraw, Kind};
use fearless_simd::prelude::*;
use fearless_simd::u32x16;
use zga_abi::format::{BlendMode, DepthFormat};
use zga_firmware::checked::{Rectangle, StencilTest};

/// What stands for the depth of a layer that is not tested: nearer than all.
pub const NEAREST: i32 = -1;

/// Columns and rows of pixels: `[[first, first beyond] of x, the same of y]`.
pub type Pixels = [[i32; 2]; 2];

/// A layer.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// What it covers.
    pub shape: Shape,
    /// Depth.
    pub plane: DepthPlane,
    /// The gradients of `plane` mean nothing but at covered pixels.
    steep: bool,
    /// Depth test; `None` passes always and is nearest of all.
    pub test: Option<DepthTest>,
    /// How it is combined with what lies behind it.
    pub mode: BlendMode,
    /// Place of its draw in the scene.
    draw: u32,
    /// Its item's number in what the colours of the draw go through.
    shading: u32,
    /// Its place among the parts of its tile.
    number: u32,
    /// Pixels that it may change.
    pub area: Pixels,
}

/// Colours of the parts of a tile, each made when it is first seen.
#[derive(Debug, Default)]
pub struct Palette(Vec<Option<Colours>>);

impl Palette {
    /// Colours of so many parts, none of them made.
    pub fn reset(&mut self, parts: usize) {
        self.0.clear();
        self.0.resize(parts, None);
    }

    /// Those of a piece of the tile.
    #[inline(always)]
    pub fn of(&mut self, piece: &Piece, draws: &[ItemDraw]) -> &Colours {
        self.0[piece.number as usize].get_or_insert_with(|| piece.colours(draws))
    }
}

/// What a tile has to do with an item.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// A layer over it.
    Layer(Piece),
    /// The layers that came before are taken back in these pixels.
    Clear(Pixels),
    /// So they are where this covers a pixel: it is opaque and asks for no depth, so it lies over them.
    Cover(Piece),
}

/// Colours of a layer. A hole of its texture is transparent black, which changes nothing in any mode.
#[derive(Clone, Debug)]
pub struct Colours(ColourPlane);

impl Colours {
    /// The colour of a layer that has one only; RGBA, R in 7:0.
    #[must_use]
    #[inline(always)]
    pub fn flat(&self) -> Option<u32> {
        if let ColourPlane::Interpolated(Interpolated::Flat(colour)) = self.0 { Some(colour) } else { None }
    }

    /// Colours of 16 pixels from (`x`, `y`) on.
    #[inline(always)]
    pub fn sixteen<S: Simd>(&self, simd: S, x: i32, y: i32) -> u32x16<S> {
        let colours = self.0.sixteen(simd, x, y, u16::MAX);
        match self.0.hole_lanes(simd, x, y, u16::MAX) {
            0 => colours,
            holes => {
                let mut kept = colours.to_array();
                for (lane, colour) in kept.iter_mut().enumerate() {
                    *colour = if holes >> lane & 1 == 1 { 0 } else { *colour };
                }
                u32x16::from_slice(simd, &kept)
            }
        }
    }
}

/// What two areas have in common; empty where the first is not less than the first beyond.
#[must_use]
#[inline(always)]
pub fn common(a: &Pixels, b: &Pixels) -> Pixels {
    [0, 1].map(|c| [a[c][0].max(b[c][0]), a[c][1].min(b[c][1])])
}

/// Whether an area has no pixel.
#[must_use]
#[inline(always)]
pub fn is_empty(area: &Pixels) -> bool {
    area[0][0] >= area[0][1] || area[1][0] >= area[1][1]
}

/// The pixels of a rectangle.
#[must_use]
#[inline(always)]
pub fn pixels_of(area: &Rectangle) -> Pixels {
    [[area.x as i32, area.right as i32], [area.y as i32, area.bottom as i32]]
}

impl Part {
    /// The pixels that it may change.
    #[must_use]
    #[inline(always)]
    pub fn area(&self) -> Pixels {
        match self {
            Part::Layer(piece) | Part::Cover(piece) => piece.area,
            Part::Clear(pixels) => *pixels,
        }
    }

    /// Gives it its place among the parts of its tile.
    #[inline(always)]
    pub fn set_number(&mut self, place: usize) {
        if let Part::Layer(piece) | Part::Cover(piece) = self {
            piece.number = place as u32;
        }
    }

    /// The same for the pixels of `area` alone; `None` if it has nothing to do with them.
    #[must_use]
    #[inline(always)]
    pub fn within(&self, area: &Pixels) -> Option<Part> {
        let area = common(area, &self.area());
        if is_empty(&area) {
            return None;
        }
        let cut = |piece: &Piece| {
            let piece = Piece { area, ..*piece };
            let [from, to] = piece.reach(area[1]);
            (from < to).then_some(piece)
        };
        match self {
            Part::Layer(piece) => cut(piece).map(Part::Layer),
            Part::Cover(piece) => cut(piece).map(Part::Cover),
            Part::Clear(_) => Some(Part::Clear(area)),
        }
    }

    /// Sets an item up for the pixels of `area`; `None` if it has nothing to do with them.
    #[must_use]
    #[inline(always)]
    pub fn new(item: &Item, draw: &ItemDraw, format: DepthFormat, area: &Pixels) -> Option<Part> {
        let mut area = common(area, &pixels_of(&draw.scissor));
        if item.kind == Kind::Clear {
            return (!is_empty(&area)).then_some(Part::Clear(area));
        }
        let v = &item.vertices;
        let (shape, steep) = match item.kind {
            Kind::Line => {
                let ends = [v[0], v[1]];
                let line = Line::new(&ends, format)?;
                let along = if line.axis == Axis::X { 0 } else { 1 };
                area[along] = [area[along][0].max(line.steps[0]), area[along][1].min(line.steps[1])];
                (Shape::Line(line, ends), line.steep)
            }
            Kind::Point => {
                let pixel = [v[0].x >> 8, v[0].y >> 8];
                area = common(&area, &pixel.map(|c| [c, c + 1]));
                (Shape::Point(Point { pixel, z: v[0].z as i32 }, v[0]), false)
            }
            Kind::Triangle | Kind::Masked | Kind::Clear => {
                let (triangle, columns) = Triangle::new(v, format)?;
                area = common(&area, &[columns, [triangle.rows[0], triangle.rows[2]]]);
                (Shape::Triangle(triangle, *v), triangle.steep)
            }
        };
        if is_empty(&area) {
            return None;
        }
        let (plane, ItemDraw { test, mode, .. }) = (shape.plane(format), draw);
        let piece = Piece {
            shape,
            plane,
            steep,
            test: *test,
            mode: *mode,
            draw: item.draw,
            shading: item.number,
            number: 0,
            area,
        };
        Some(if draw.is_opaque(v) { Part::Cover(piece) } else { Part::Layer(piece) })
    }
}

impl Piece {
    /// Its colours.
    #[must_use]
    pub fn colours(&self, draws: &[ItemDraw]) -> Colours {
        Colours(colour_plane(&self.shape, &draws[self.draw as usize].shade(self.shading)))
    }

    /// Its stencil test, where it has one.
    #[must_use]
    pub fn stencil<'a>(&self, draws: &'a [ItemDraw]) -> Option<&'a StencilTest> {
        draws[self.draw as usize].stencil.as_ref()
    }

    /// Whether a pixel that it covers is a hole of its texture.
    #[must_use]
    pub fn is_hole(&self, draws: &[ItemDraw], x: i32, y: i32) -> bool {
        let draw = &draws[self.draw as usize];
        draw.has_holes() && colour_plane(&self.shape, &draw.shade(self.shading)).is_hole(x, y)
    }

    /// Counts that the colours of `pixels` of its pixels were made.
    pub fn count_shaded(&self, draws: &[ItemDraw], pixels: u64, counts: &mut Counts) {
        counts.count_shaded(&draws[self.draw as usize], pixels);
    }

    /// Columns on row `y`, one of its area's: first, first beyond.
    #[must_use]
    #[inline(always)]
    pub fn span(&self, y: i32) -> [i32; 2] {
        let [left, right] = self.area[0];
        let [from, to] = match &self.shape {
            Shape::Triangle(triangle, _) => triangle.span(y),
            Shape::Line(line, _) => line.columns_on_row(y, self.area[0]),
            Shape::Point(..) => [left, right],
        };
        [from.max(left), to.min(right)]
    }

    /// Columns that it can touch on rows `[first, beyond)`, which are of its area: first, first beyond.
    #[must_use]
    #[inline(always)]
    pub fn reach(&self, [first, beyond]: [i32; 2]) -> [i32; 2] {
        let last = beyond - 1;
        let [[l0, r0], [l1, r1]] = [self.span(first), self.span(last)];
        let (mut from, mut to) = (l0.min(l1), r0.max(r1));
        match &self.shape {
            // Each side is straight between the ends of the rows and the middle vertex.
            Shape::Triangle(t, _) if first < t.rows[1] && t.rows[1] <= last => {
                let [[l2, r2], [l3, r3]] = [self.span(t.rows[1] - 1), self.span(t.rows[1])];
                (from, to) = (from.min(l2).min(l3), to.max(r2).max(r3));
            }
            // On some rows it can have no pixel of the area at all.
            Shape::Line(line, _) if line.axis == Axis::X => return self.area[0],
            _ => {}
        }
        [from, to]
    }

    /// Depth of pixel (`x`, `y`), which it covers.
    #[must_use]
    #[inline(always)]
    pub fn depth(&self, x: i32, y: i32, below: u32) -> i32 {
        if self.test.is_none() { NEAREST } else { self.plane.stored(self.plane.value(x, y), below) }
    }

    /// Bounds of its depths in its area: nearest, farthest.
    #[must_use]
    #[inline(always)]
    pub fn range(&self, format: DepthFormat) -> [i32; 2] {
        let DepthPlane { minimum, maximum, .. } = self.plane;
        if self.test.is_none() {
            return [NEAREST; 2];
        }
        if minimum == maximum || self.steep {
            return [minimum, maximum];
        }
        // Without a wrap the extremes of a plane lie in corners.
        let [[left, right], [top, bottom]] = self.area;
        let corners = [[left, top], [right - 1, top], [left, bottom - 1], [right - 1, bottom - 1]];
        let depths = corners.map(|[x, y]| self.plane.stored(self.plane.value(x, y), below(format)));
        [depths.into_iter().min().unwrap_or(minimum), depths.into_iter().max().unwrap_or(maximum)]
    }
}
