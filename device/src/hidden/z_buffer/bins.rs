//! Bins: for each host tile the primitives that can touch it, in order.
//!
//! A bin holds the primitives themselves, not references to them: a tile then reads its own memory
//! from front to back, where references would miss the cache on every primitive of a large scene.
//! A primitive goes into the tiles that the rows (or steps) of each tile row (or column) can reach,
//! not into those of its bounding box: a long sliver touches a handful of tiles.

use super::tile::TILE;
use crate::geometry::ScreenVertex;
use crate::geometry::assembly::{Point, Sink};
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::Triangle;
use crate::shading::plane::ColourSource;
use zga_firmware::checked::Rectangle;

/// log2 of the tile size.
const SHIFT: u32 = TILE.trailing_zeros();

/// Bytes in all bins after which they want to be drawn.
const LIMIT: usize = 64 << 20;

/// Pixels in all bounding boxes after which they want to be drawn: a reset waits no longer than they take.
const PIXEL_LIMIT: u64 = 1 << 28;

/// A primitive, and what its colours are made from once it is seen.
pub type Entry<T> = (T, ColourSource);

/// Bytes of room that emptied bins keep for the next draw; beyond it all of it is given back.
const KEPT: usize = 4 * LIMIT;

/// Numbers of the primitives of a tile, apart from it: most draws have none.
#[derive(Debug, Default)]
struct Numbers(Vec<u32>);

/// Primitives of one tile; a draw has one kind of them only.
#[derive(Debug, Default)]
pub struct Bin {
    /// Triangles.
    pub triangles: Vec<Entry<Triangle>>,
    /// Lines.
    pub lines: Vec<Entry<Line>>,
    /// Points.
    pub points: Vec<Entry<Point>>,
    /// Number of each primitive in the draw, where pixels are shaded by more than its colours.
    numbers: Option<Box<Numbers>>,
    /// Bytes of room when it was emptied last.
    room: usize,
}

impl Bin {
    /// Number of primitives.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len() + self.lines.len() + self.points.len()
    }

    /// Nothing touches the tile.
    #[must_use]
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty() && self.lines.is_empty() && self.points.is_empty()
    }

    /// What the colours of primitive `index` are made from.
    #[must_use]
    pub fn colours(&self, index: usize) -> Option<&ColourSource> {
        let triangle = self.triangles.get(index).map(|(_, colours)| colours);
        let line = || self.lines.get(index).map(|(_, colours)| colours);
        triangle.or_else(line).or_else(|| self.points.get(index).map(|(_, colours)| colours))
    }

    /// The number of primitive `index` in the draw, where numbers are kept.
    #[must_use]
    pub fn number(&self, index: usize) -> Option<u32> {
        self.numbers.as_ref()?.0.get(index).copied()
    }

    /// Empties it; returns by how many bytes its room has grown.
    fn clear(&mut self) -> usize {
        self.triangles.clear();
        self.lines.clear();
        self.points.clear();
        let numbers = self.numbers.as_mut().map_or(0, |numbers| {
            numbers.0.clear();
            numbers.0.capacity()
        });
        let room = self.triangles.capacity() * size_of::<Entry<Triangle>>()
            + self.lines.capacity() * size_of::<Entry<Line>>()
            + self.points.capacity() * size_of::<Entry<Point>>()
            + numbers * size_of::<u32>();
        room - std::mem::replace(&mut self.room, room)
    }
}

/// The bins of one share of a draw.
#[derive(Debug, Default)]
pub struct Bins {
    tiles: Vec<Bin>,
    touched: Vec<u32>,
    columns: usize,
    area: [i32; 4],
    bytes: usize,
    pixels: u64,
    /// Bytes of room in all bins, those that went with a larger target counted in.
    room: usize,
}

impl Bins {
    /// Empties the bins for a target of `width` x `height` pixels of which `scissor` may change.
    pub fn reset(&mut self, width: u32, height: u32, scissor: Rectangle) {
        for tile in self.touched.drain(..) {
            self.room += self.tiles[tile as usize].clear();
        }
        if self.room > KEPT {
            self.tiles.clear();
            self.room = 0;
        }
        self.columns = (width as usize).div_ceil(TILE);
        let count = self.columns * (height as usize).div_ceil(TILE);
        if self.tiles.len() != count {
            self.tiles.resize_with(count, Bin::default);
        }
        self.area = [scissor.x, scissor.y, scissor.right, scissor.bottom].map(|c| c as i32);
        self.bytes = 0;
        self.pixels = 0;
    }

    /// Primitives that can touch tile (`column`, `row`).
    #[must_use]
    #[inline(always)]
    pub fn tile(&self, column: usize, row: usize) -> &Bin {
        &self.tiles[row * self.columns + column]
    }

    /// How much there is to draw, roughly in pixels: those in bounding boxes, and a byte an equal of one.
    #[must_use]
    pub fn weight(&self) -> u64 {
        self.pixels + self.bytes as u64
    }

    /// Tile rows that hold something: first, first beyond; `None` if none does.
    #[must_use]
    pub fn rows(&self) -> Option<[usize; 2]> {
        let row = |tile: &u32| *tile as usize / self.columns;
        Some([self.touched.iter().map(row).min()?, self.touched.iter().map(row).max()? + 1])
    }

    #[inline(always)]
    fn bin<T>(
        &mut self,
        column: i32,
        row: i32,
        number: Option<u32>,
        entries: fn(&mut Bin) -> &mut Vec<Entry<T>>,
    ) -> &mut Vec<Entry<T>> {
        let tile = row as usize * self.columns + column as usize;
        if let Some(number) = number {
            self.tiles[tile].numbers.get_or_insert_default().0.push(number);
            self.bytes += size_of::<u32>();
        }
        let entries = entries(&mut self.tiles[tile]);
        if entries.is_empty() {
            self.touched.push(tile as u32);
        }
        self.bytes += size_of::<Entry<T>>();
        entries
    }
}

/// Bins that take primitives. `NUMBERS`: with their numbers in the draw where these are asked for, as only shading by more
/// than colours does; else there is no code for them.
#[derive(Debug)]
pub struct BinSink<'a, const NUMBERS: bool> {
    bins: &'a mut Bins,
    numbers: bool,
}

impl<'a> BinSink<'a, false> {
    /// Bins of a draw without numbers.
    pub fn plain(bins: &'a mut Bins) -> Self {
        BinSink { bins, numbers: false }
    }
}

impl<'a> BinSink<'a, true> {
    /// Bins of any draw; `numbers` are kept or not.
    pub fn any(bins: &'a mut Bins, numbers: bool) -> Self {
        BinSink { bins, numbers }
    }
}

impl<const NUMBERS: bool> BinSink<'_, NUMBERS> {
    /// The number to keep, if any.
    #[inline(always)]
    fn kept(&self, number: u32) -> Option<u32> {
        (NUMBERS && self.numbers).then_some(number)
    }
}

impl<const NUMBERS: bool> Sink for BinSink<'_, NUMBERS> {
    fn masked(&mut self, _vertices: &[ScreenVertex; 3], _number: u32) {}

    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: u32) {
        self.bins.take_triangle(triangle, columns, vertices, self.kept(number));
    }

    #[inline(always)]
    fn line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: u32) {
        self.bins.take_line(line, vertices, self.kept(number));
    }

    #[inline(always)]
    fn point(&mut self, point: &Point, vertex: &ScreenVertex, number: u32) {
        self.bins.take_point(point, vertex, self.kept(number));
    }

    #[inline(always)]
    fn full(&self) -> bool {
        self.bins.bytes >= LIMIT || self.bins.pixels >= PIXEL_LIMIT
    }
}

impl Bins {
    #[inline(always)]
    fn take_triangle(&mut self, t: &Triangle, columns: [i32; 2], vertices: &[ScreenVertex; 3], number: Option<u32>) {
        let area = self.area;
        let (left, right) = (columns[0].max(area[0]), columns[1].min(area[2]));
        let (top, bottom) = (t.rows[0].max(area[1]), t.rows[2].min(area[3]));
        if left >= right || top >= bottom {
            return;
        }
        self.pixels += (right - left) as u64 * (bottom - top) as u64;
        let colours = ColourSource::new(vertices);
        let (columns, rows) = ([left >> SHIFT, (right - 1) >> SHIFT], [top >> SHIFT, (bottom - 1) >> SHIFT]);
        if columns[0] == columns[1] {
            for row in rows[0]..=rows[1] {
                self.bin(columns[0], row, number, |bin| &mut bin.triangles).push((*t, colours));
            }
            return;
        }
        for row in rows[0]..=rows[1] {
            let (first, last) = (top.max(row << SHIFT), (bottom - 1).min((row << SHIFT) + TILE as i32 - 1));
            // Each side is straight between the ends of the rows and the middle vertex.
            let ([l0, r0], [l1, r1]) = (t.span(first), t.span(last));
            let (mut from, mut to) = (l0.min(l1), r0.max(r1));
            if first < t.rows[1] && t.rows[1] <= last {
                let ([l2, r2], [l3, r3]) = (t.span(t.rows[1] - 1), t.span(t.rows[1]));
                (from, to) = (from.min(l2).min(l3), to.max(r2).max(r3));
            }
            let (from, to) = (from.max(left), to.min(right));
            if from < to {
                for column in from >> SHIFT..=(to - 1) >> SHIFT {
                    self.bin(column, row, number, |bin| &mut bin.triangles).push((*t, colours));
                }
            }
        }
    }

    #[inline(always)]
    fn take_line(&mut self, line: &Line, vertices: &[ScreenVertex; 2], number: Option<u32>) {
        let area = self.area;
        let x_major = line.axis == Axis::X;
        let (along, across) =
            if x_major { ([area[0], area[2]], [area[1], area[3]]) } else { ([area[1], area[3]], [area[0], area[2]]) };
        let (first, beyond) = (line.steps[0].max(along[0]), line.steps[1].min(along[1]));
        if first >= beyond {
            return;
        }
        let colours = ColourSource::new(&[vertices[0], vertices[1], vertices[1]]);
        for major in first >> SHIFT..=(beyond - 1) >> SHIFT {
            let from = line.minor_at(first.max(major << SHIFT));
            let to = line.minor_at((beyond - 1).min((major << SHIFT) + TILE as i32 - 1));
            let (from, to) = (from.min(to).max(across[0]), from.max(to).min(across[1] - 1));
            if from <= to {
                for minor in from >> SHIFT..=to >> SHIFT {
                    let (column, row) = if x_major { (major, minor) } else { (minor, major) };
                    self.bin(column, row, number, |bin| &mut bin.lines).push((*line, colours));
                }
            }
        }
    }

    #[inline(always)]
    fn take_point(&mut self, point: &Point, vertex: &ScreenVertex, number: Option<u32>) {
        let ([x, y], area) = (point.pixel, self.area);
        if (area[0]..area[2]).contains(&x) && (area[1]..area[3]).contains(&y) {
            let colours = ColourSource::new(&[*vertex; 3]);
            self.bin(x >> SHIFT, y >> SHIFT, number, |bin| &mut bin.points).push((*point, colours));
        }
    }
}
