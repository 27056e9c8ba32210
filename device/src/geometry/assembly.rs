//! Assembly: vertices become primitives, primitives are clipped and set up.
//!
//! What is left of each goes into a [`Sink`], in order: the bins of a hidden-surface path, or a plain
//! [`List`] for the specification and the probe.

use super::ScreenVertex;
use super::clip::{Polygon, clip_line};
use super::fetch::Fetch;
use super::line::Line;
use super::plane::DepthPlane;
use super::transform::Transform;
use super::triangle::Triangle;
use std::ops::Range;
use zga_abi::format::{DepthFormat, Topology};
use zga_firmware::checked::Rectangle;

/// A point: its pixel and depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Column, row.
    pub pixel: [i32; 2],
    /// Depth.
    pub z: i32,
}

/// Who takes primitives that are set up. The vertices are those the record was made from; `number` is
/// that of the primitive in its draw.
pub trait Sink {
    /// Takes a triangle; `columns` is its first column and the first beyond.
    fn triangle(&mut self, triangle: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32);
    /// Takes a line.
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32);
    /// Takes a point.
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32);
    /// Takes the outline of a triangle that is drawn with masks, also of one that lies between pixel centres; what of
    /// it the hidden-surface path draws comes as a triangle after it.
    fn masked(&mut self, vertices: &[ScreenVertex; 3], number: u32);
    /// Wants no more: what it has must be drawn first.
    fn full(&self) -> bool;
}

/// Events of the geometry unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryCounts {
    /// Primitives that arrived.
    pub primitives: u64,
    /// Primitives that a clip plane cut.
    pub clipped: u64,
    /// Clip planes that cut, over all primitives.
    pub cuts: u64,
    /// Primitives dropped.
    pub discarded: u64,
}

impl GeometryCounts {
    /// The sum of two counts.
    #[must_use]
    pub fn plus(self, other: GeometryCounts) -> GeometryCounts {
        GeometryCounts {
            primitives: self.primitives + other.primitives,
            clipped: self.clipped + other.clipped,
            cuts: self.cuts + other.cuts,
            discarded: self.discarded + other.discarded,
        }
    }
}

/// The assembly stage of one draw.
pub struct Assembler<'a> {
    /// Words.
    pub fetch: Fetch<'a>,
    /// Matrices.
    pub transform: &'a Transform,
    /// Depth format of the target.
    pub format: DepthFormat,
    /// How vertices make primitives.
    pub topology: Topology,
    /// Vertices of an indexed draw, or of one that light falls on, transformed once each; `None` stands for one to clip.
    pub shared: Option<&'a [Option<ScreenVertex>]>,
    /// Primitives are drawn with sub-pixel masks.
    pub masks: Option<Widths>,
}

/// What lines and points that are drawn with masks are made of: rectangles and squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Widths {
    /// Width of lines, u.
    pub line: u32,
    /// Side of points, u.
    pub point: u32,
}

impl Assembler<'_> {
    /// Assembles primitives `range` of the draw until all are done or `sink` is full; counts what
    /// happened and returns the first primitive not assembled.
    ///
    /// Its loop is the hottest of small triangles: it is a function of its own for each sink, so that what its caller
    /// holds has no say in which registers it gets.
    #[inline(never)]
    pub fn run(&self, range: Range<u32>, sink: &mut impl Sink, counts: &mut GeometryCounts) -> u32 {
        let begun = range.start;
        for number in range.clone() {
            if sink.full() {
                counts.primitives += u64::from(number - begun);
                return number;
            }
            let n = number as usize;
            let drawn = match self.topology {
                Topology::Triangles => self.triangle([3 * n, 3 * n + 1, 3 * n + 2], number, sink, counts),
                Topology::Lines => self.line([2 * n, 2 * n + 1], number, sink, counts),
                Topology::LineStrip => self.line([n, n + 1], number, sink, counts),
                Topology::Points => self.point(n, number, sink),
            };
            counts.discarded += u64::from(!drawn);
        }
        counts.primitives += u64::from(range.end - begun);
        range.end
    }

    #[inline(always)]
    fn triangle(&self, elements: [usize; 3], number: u32, sink: &mut impl Sink, counts: &mut GeometryCounts) -> bool {
        let [a, b, c] = elements;
        let vertices = [self.fetch.vertex_of(a), self.fetch.vertex_of(b), self.fetch.vertex_of(c)];
        let [a, b, c] = vertices;
        match (self.screen(a), self.screen(b), self.screen(c)) {
            (Some(a), Some(b), Some(c)) => self.set_up(&[a, b, c], number, sink),
            _ => self.clip_triangle(vertices, number, sink, counts),
        }
    }

    #[inline(always)]
    fn set_up(&self, v: &[ScreenVertex; 3], number: u32, sink: &mut impl Sink) -> bool {
        if self.masks.is_some() {
            sink.masked(v, number);
        }
        match Triangle::new(v, self.format) {
            Some((triangle, columns)) => {
                sink.triangle(&triangle, columns, v, number);
                true
            }
            None => false,
        }
    }

    #[cold]
    fn clip_triangle(
        &self,
        vertices: [usize; 3],
        number: u32,
        sink: &mut impl Sink,
        counts: &mut GeometryCounts,
    ) -> bool {
        let raw = vertices.map(|v| self.fetch.lit_vertex(v));
        let [Some(a), Some(b), Some(c)] = raw.map(|r| self.transform.clip_space(&r)) else {
            return false;
        };
        let polygon = Polygon::triangle(self.transform, &[a, b, c]);
        let left = polygon.vertices();
        if polygon.cuts > 0 && !left.is_empty() {
            counts.clipped += 1;
            counts.cuts += u64::from(polygon.cuts);
        }
        let mut any = false;
        for pair in left.windows(2).skip(1) {
            if let [Some(p), Some(q), Some(r)] = [&left[0], &pair[0], &pair[1]].map(|v| self.transform.project(v)) {
                any |= self.set_up(&[self.provoking(p, raw[0].colour), q, r], number, sink);
            }
        }
        any
    }

    fn line(&self, elements: [usize; 2], number: u32, sink: &mut impl Sink, counts: &mut GeometryCounts) -> bool {
        let vertices = [self.fetch.vertex_of(elements[0]), self.fetch.vertex_of(elements[1])];
        let ends = match (self.screen(vertices[0]), self.screen(vertices[1])) {
            (Some(a), Some(b)) => Some([a, b]),
            _ => self.clip_line(vertices, counts),
        };
        if let (Some(widths), Some([a, b])) = (self.masks, &ends) {
            let faces = rectangle(a, b, widths.line, self.transform.flat_colour());
            return faces.is_some_and(|faces| self.faces(&faces, number, sink));
        }
        let set = ends.and_then(|v| Line::new(&v, self.format).map(|line| (v, line)));
        if let Some((v, line)) = &set {
            sink.line(line, v, number);
        }
        set.is_some()
    }

    #[cold]
    fn clip_line(&self, vertices: [usize; 2], counts: &mut GeometryCounts) -> Option<[ScreenVertex; 2]> {
        let raw = vertices.map(|v| self.fetch.lit_vertex(v));
        let [Some(a), Some(b)] = raw.map(|r| self.transform.clip_space(&r)) else {
            return None;
        };
        let (left, cuts) = clip_line(self.transform, &[a, b]);
        let [a, b] = left?;
        counts.clipped += u64::from(cuts > 0);
        counts.cuts += u64::from(cuts);
        let (a, b) = (self.transform.project(&a)?, self.transform.project(&b)?);
        Some([self.provoking(a, raw[0].colour), b])
    }

    /// A point is inside or it is not: there is nothing to cut.
    fn point(&self, element: usize, number: u32, sink: &mut impl Sink) -> bool {
        let vertex = self.screen(self.fetch.vertex_of(element));
        if let (Some(widths), Some(v)) = (self.masks, &vertex) {
            return self.faces(&square(v, widths.point), number, sink);
        }
        if let Some(v) = &vertex {
            sink.point(&Point { pixel: [v.x >> 8, v.y >> 8], z: v.z as i32 }, v, number);
        }
        vertex.is_some()
    }

    /// Draws the two triangles of a line or point that is drawn with masks: never discarded, whatever of them the
    /// hidden-surface path draws.
    fn faces(&self, faces: &[[ScreenVertex; 3]; 2], number: u32, sink: &mut impl Sink) -> bool {
        for face in faces {
            self.set_up(face, number, sink);
        }
        true
    }

    /// Clipping mixes colours; the first vertex of a flat draw's piece keeps its own.
    fn provoking(&self, vertex: ScreenVertex, colour: u32) -> ScreenVertex {
        if self.transform.flat_colour() { ScreenVertex { colour, ..vertex } } else { vertex }
    }

    #[inline(always)]
    fn screen(&self, vertex: usize) -> Option<ScreenVertex> {
        match self.shared {
            Some(shared) => shared[vertex],
            None => self.transform.inside(&self.fetch.vertex(vertex)),
        }
    }
}

/// The rectangle of a line of a width in u, as two triangles; corners are rounded to u, ties to the even one. A flat one
/// has the colour of its first end. `None` for a line of no length.
fn rectangle(a: &ScreenVertex, b: &ScreenVertex, width: u32, flat: bool) -> Option<[[ScreenVertex; 3]; 2]> {
    let [dx, dy] = [f64::from(b.x) - f64::from(a.x), f64::from(b.y) - f64::from(a.y)];
    if dx == 0.0 && dy == 0.0 {
        return None;
    }
    // Sums and products of these integers are exact in f64; root and quotient are rounded once each.
    let length = (dx * dx + dy * dy).sqrt();
    let across = |along: f64| (along * f64::from(width) / (2.0 * length)).round_ties_even() as i32;
    let (nx, ny) = (across(-dy), across(dx));
    let b = if flat { ScreenVertex { colour: a.colour, ..*b } } else { *b };
    let beside = |v: &ScreenVertex, side: i32| ScreenVertex { x: v.x + side * nx, y: v.y + side * ny, ..*v };
    let [a0, a1, b0, b1] = [beside(a, 1), beside(a, -1), beside(&b, 1), beside(&b, -1)];
    Some([[a0, a1, b0], [b0, a1, b1]])
}

/// The square of a point of a size in u, as two triangles; an odd one is longer to the right and down.
fn square(v: &ScreenVertex, size: u32) -> [[ScreenVertex; 3]; 2] {
    let [left, top] = [v.x, v.y].map(|c| c - (size >> 1) as i32);
    let (right, bottom) = (left + size as i32, top + size as i32);
    let at = |x: i32, y: i32| ScreenVertex { x, y, ..*v };
    [[at(left, top), at(right, top), at(left, bottom)], [at(right, top), at(right, bottom), at(left, bottom)]]
}

/// A primitive that is set up.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A triangle and its snapped vertices.
    Triangle(Triangle, [ScreenVertex; 3]),
    /// A line and its snapped ends.
    Line(Line, [ScreenVertex; 2]),
    /// A point and its snapped vertex.
    Point(Point, ScreenVertex),
}

impl Shape {
    /// Depth plane.
    #[must_use]
    pub fn plane(&self, format: DepthFormat) -> DepthPlane {
        match self {
            Shape::Triangle(triangle, _) => triangle.plane,
            Shape::Line(line, _) => line.plane,
            Shape::Point(_, v) => DepthPlane::flat(v, format),
        }
    }

    /// Whether a line or point draws pixel (`x`, `y`), by its record. A triangle's record says nothing
    /// about single pixels: ask its edge functions.
    #[must_use]
    pub fn line_or_point_draws(&self, x: i32, y: i32) -> bool {
        match self {
            Shape::Triangle(..) => false,
            Shape::Line(line, _) => line.draws(x, y),
            Shape::Point(point, _) => point.pixel == [x, y],
        }
    }
}

/// Primitives in order, each with its number in the draw.
#[derive(Debug, Default)]
pub struct List {
    /// The primitives.
    pub shapes: Vec<(Shape, u32)>,
    /// Pixels that may change: first column and row, first beyond.
    area: [[i32; 2]; 2],
    /// Pixels of the area that the primitives' bounding boxes cover.
    pixels: u64,
}

/// Most primitives of a [`List`] before it wants to be drawn.
const LIST_LIMIT: usize = 1 << 16;
/// Most pixels to be looked at before it wants to be drawn: a reset waits no longer than they take.
const PIXEL_LIMIT: u64 = 1 << 24;

impl List {
    /// Empties the list, for a draw that can change the pixels of `scissor`.
    pub fn reset(&mut self, scissor: Rectangle) {
        self.shapes.clear();
        self.pixels = 0;
        self.area = [[scissor.x, scissor.y], [scissor.right, scissor.bottom]].map(|corner| corner.map(|c| c as i32));
    }

    fn push(&mut self, shape: Shape, vertices: &[ScreenVertex], number: u32) {
        let extent = |c: usize, of: fn(&ScreenVertex) -> i32| {
            let pixels = || vertices.iter().map(|v| of(v) >> 8);
            let (first, last) = (pixels().min().unwrap_or(0), pixels().max().unwrap_or(0));
            ((last + 1).min(self.area[1][c]) - first.max(self.area[0][c])).max(0) as u64
        };
        self.pixels += extent(0, |v| v.x) * extent(1, |v| v.y);
        self.shapes.push((shape, number));
    }
}

impl Sink for List {
    fn triangle(&mut self, triangle: &Triangle, _columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32) {
        self.push(Shape::Triangle(*triangle, *vertices), vertices, number);
    }
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32) {
        self.push(Shape::Line(*line, *vertices), vertices, number);
    }
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32) {
        self.push(Shape::Point(*point, *vertex), &[*vertex], number);
    }
    fn masked(&mut self, _vertices: &[ScreenVertex; 3], _number: u32) {}
    fn full(&self) -> bool {
        self.shapes.len() >= LIST_LIMIT || self.pixels >= PIXEL_LIMIT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: i32, y: i32, z: u32, colour: u32) -> ScreenVertex {
        ScreenVertex { x, y, z, colour, ..ScreenVertex::default() }
    }

    fn places(faces: &[[ScreenVertex; 3]; 2]) -> [[(i32, i32); 3]; 2] {
        faces.map(|face| face.map(|v| (v.x, v.y)))
    }

    #[test]
    fn rectangle_3_4_5_lies_along_the_line() {
        // 3, 4 px long; half of 2.5 px across: (-4, 3) / 5 of it.
        let faces = rectangle(&at(0, 0, 1, 7), &at(768, 1024, 2, 9), 640, false).unwrap();
        let corners = [(-256, 192), (256, -192), (512, 1216), (1024, 832)];
        assert_eq!(places(&faces), [[corners[0], corners[1], corners[2]], [corners[2], corners[1], corners[3]]]);
        assert_eq!(
            faces.map(|face| face.map(|v| (v.z, v.colour))),
            [[(1, 7), (1, 7), (2, 9)], [(2, 9), (1, 7), (2, 9)]]
        );
    }

    #[test]
    fn rectangle_flat_has_the_first_ends_colour_and_none_without_length() {
        let faces = rectangle(&at(0, 0, 1, 7), &at(512, 0, 2, 9), 256, true).unwrap();
        assert!(faces.as_flattened().iter().all(|v| v.colour == 7));
        assert!(rectangle(&at(5, 5, 1, 7), &at(5, 5, 2, 9), 256, false).is_none());
    }

    #[test]
    fn square_of_odd_size_is_longer_to_the_right_and_down() {
        let faces = square(&at(100, -20, 9, 3), 5);
        assert_eq!(places(&faces), [[(98, -22), (103, -22), (98, -17)], [(103, -22), (103, -17), (98, -17)]]);
        assert!(faces.as_flattened().iter().all(|v| (v.z, v.colour) == (9, 3)));
    }
}
