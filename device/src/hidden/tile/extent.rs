//! Extents: where a polygon lies in Y, and in X inside a row of tiles.
//!
//! Duties: the least and greatest Y of a polygon; the crossings of its edges with a row's boundaries, and
//! the least and greatest X they and the vertices inside the row leave. Inputs: what arrived and the
//! draw's scissor. Outputs: exact rationals in u, so that a polygon which ends on a tile's boundary does
//! not go beyond it, whatever its slope.
//!
//! Lines and points draw pixels that the mathematical line does not reach into (a diamond's corner, a tie
//! at a border): their outline is that of the pixels they draw.
//!
//! Clocks: none of its own, see [`super::clocks`].

use crate::geometry::assembly::Shape;
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::{PIXEL, ScreenVertex};
use crate::hidden::held::{Held, Item};
use std::cmp::Ordering;
use zga_firmware::checked::Rectangle;

/// A place on the X axis, u: numerator, and denominator above 0.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    n: i64,
    d: i64,
}

impl Place {
    /// A whole number of u.
    #[must_use]
    pub fn whole(u: i32) -> Place {
        Place { n: i64::from(u), d: 1 }
    }

    /// Whether it lies beyond (not on) boundary `u`.
    #[must_use]
    pub fn is_beyond(self, u: i32) -> bool {
        self.n > i64::from(u) * self.d
    }

    /// The interval of `step` u it lies in; a boundary belongs to the interval on its right.
    #[must_use]
    pub fn interval(self, step: i32) -> i64 {
        self.n.div_euclid(self.d * i64::from(step))
    }

    fn compare(self, other: Place) -> Ordering {
        (i128::from(self.n) * i128::from(other.d)).cmp(&(i128::from(other.n) * i128::from(self.d)))
    }
}

/// What the sorts know of something that arrived.
#[derive(Clone, Copy, Debug)]
pub enum Outline<'h> {
    /// Corners.
    Triangle(&'h [ScreenVertex; 3]),
    /// The pixels a line draws.
    Line(&'h Line),
    /// Pixels: first column, first row, and the first beyond.
    Pixels([i32; 4]),
}

/// An outline, and the pixels outside which it does not count.
#[derive(Clone, Copy, Debug)]
pub struct Extent<'h> {
    outline: Outline<'h>,
    /// First column and row, first beyond; pixels.
    area: [i32; 4],
}

impl<'h> Extent<'h> {
    /// The extent of an item of a scene.
    #[must_use]
    pub fn new(held: &Held, item: &'h Item) -> Extent<'h> {
        match item {
            Item::Primitive(shape, draw) => {
                let outline = match shape {
                    Shape::Triangle(_, v) => Outline::Triangle(v),
                    Shape::Line(line, _) => Outline::Line(line),
                    Shape::Point(point, _) => {
                        let [x, y] = point.pixel;
                        Outline::Pixels([x, y, x + 1, y + 1])
                    }
                };
                Extent { outline, area: corners(&held.draws[*draw as usize].scissor) }
            }
            Item::Clear { area, .. } => Extent { outline: Outline::Pixels(corners(area)), area: corners(area) },
        }
    }

    /// Least and greatest Y, u; `None` if its bounding box misses the scissor.
    #[must_use]
    pub fn down(&self) -> Option<[i32; 2]> {
        let [left, top, right, bottom] = self.area;
        let [y0, y1] = match self.outline {
            Outline::Triangle(v) => {
                let [least, greatest] = range(v.iter().map(|v| v.x));
                if greatest <= left * PIXEL || least >= right * PIXEL {
                    return None;
                }
                range(v.iter().map(|v| v.y))
            }
            Outline::Line(line) => line_rows(line, self.area)?.map(|y| y * PIXEL),
            Outline::Pixels([x0, y0, x1, y1]) => {
                if x1 <= left || x0 >= right {
                    return None;
                }
                [y0 * PIXEL, y1 * PIXEL]
            }
        };
        let [y0, y1] = [y0.max(top * PIXEL), y1.min(bottom * PIXEL)];
        (y0 < y1 && left < right).then_some([y0, y1])
    }

    /// Least and greatest X between two boundaries (u, multiples of a pixel) of a row that it reaches into;
    /// `None` if the scissor leaves nothing there.
    #[must_use]
    pub fn across(&self, row: [i32; 2]) -> Option<[Place; 2]> {
        let [left, top, right, bottom] = self.area;
        let row = [row[0].max(top * PIXEL), row[1].min(bottom * PIXEL)];
        let [least, greatest] = match self.outline {
            Outline::Triangle(v) => triangle_across(v, row)?,
            Outline::Line(line) => {
                line_columns(line, self.area, row.map(|y| y / PIXEL))?.map(|x| Place::whole(x * PIXEL))
            }
            Outline::Pixels([x0, _, x1, _]) => [Place::whole(x0 * PIXEL), Place::whole(x1 * PIXEL)],
        };
        let (left, right) = (Place::whole(left * PIXEL), Place::whole(right * PIXEL));
        let least = if least.compare(left).is_lt() { left } else { least };
        let greatest = if greatest.compare(right).is_gt() { right } else { greatest };
        least.compare(greatest).is_lt().then_some([least, greatest])
    }
}

/// Corners of a rectangle, pixels.
fn corners(area: &Rectangle) -> [i32; 4] {
    [area.x, area.y, area.right, area.bottom].map(|c| c as i32)
}

/// Least and greatest of some numbers.
fn range(numbers: impl Iterator<Item = i32>) -> [i32; 2] {
    numbers.fold([i32::MAX, i32::MIN], |[least, greatest], n| [least.min(n), greatest.max(n)])
}

/// Least and greatest X of a triangle between two boundaries: of its vertices there, and of its edges'
/// crossings with both.
fn triangle_across(v: &[ScreenVertex; 3], row: [i32; 2]) -> Option<[Place; 2]> {
    let inside = v.iter().filter(|v| (row[0]..=row[1]).contains(&v.y)).map(|v| Place::whole(v.x));
    let edges = [[&v[0], &v[1]], [&v[1], &v[2]], [&v[2], &v[0]]];
    let crossings = edges.into_iter().flat_map(|edge| row.map(|y| crossing(edge, y))).flatten();
    let mut all = inside.chain(crossings);
    let first = all.next()?;
    Some(all.fold([first; 2], |[least, greatest], place| {
        [
            if place.compare(least).is_lt() { place } else { least },
            if place.compare(greatest).is_gt() { place } else { greatest },
        ]
    }))
}

/// Where an edge crosses row boundary `y`, between its ends.
fn crossing([a, b]: [&ScreenVertex; 2], y: i32) -> Option<Place> {
    let (a, b) = if a.y < b.y { (a, b) } else { (b, a) };
    (a.y < y && y < b.y).then(|| {
        let [dx, dy] = [i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y)];
        Place { n: i64::from(a.x) * dy + i64::from(y - a.y) * dx, d: dy }
    })
}

/// Steps of a line inside an area.
fn line_steps(line: &Line, [left, top, right, bottom]: [i32; 4]) -> Option<[i32; 2]> {
    let [low, high] = if line.axis == Axis::X { [left, right] } else { [top, bottom] };
    let [first, beyond] = [line.steps[0].max(low), line.steps[1].min(high)];
    (first < beyond).then_some([first, beyond])
}

/// First row that a line draws in, and the first beyond, where its bounding box meets the area.
fn line_rows(line: &Line, area: [i32; 4]) -> Option<[i32; 2]> {
    let [first, beyond] = line_steps(line, area)?;
    let [least, greatest] = range([line.minor_at(first), line.minor_at(beyond - 1)].into_iter());
    match line.axis {
        Axis::X => Some([least, greatest + 1]),
        Axis::Y => (greatest >= area[0] && least < area[2]).then_some([first, beyond]),
    }
}

/// First column that a line draws on rows `row`, and the first beyond.
fn line_columns(line: &Line, area: [i32; 4], row: [i32; 2]) -> Option<[i32; 2]> {
    match line.axis {
        Axis::X => {
            let [first, beyond] = line_steps(line, area)?;
            // The rows of the steps go up or down all the way.
            let on_row = |step: i32| (row[0]..row[1]).contains(&line.minor_at(step));
            let falling = line.slope < 0;
            let before = |step: i32| {
                let y = line.minor_at(step);
                if falling { y >= row[1] } else { y < row[0] }
            };
            let start = partition([first, beyond], before);
            let end = partition([start, beyond], on_row);
            (start < end).then_some([start, end])
        }
        Axis::Y => {
            let [first, beyond] = line_steps(line, [area[0], row[0].max(area[1]), area[2], row[1].min(area[3])])?;
            let [least, greatest] = range([line.minor_at(first), line.minor_at(beyond - 1)].into_iter());
            Some([least, greatest + 1])
        }
    }
}

/// The first number in `first..beyond` for which `holds`, true up to there, does not; `beyond` if there is none.
fn partition([mut first, mut beyond]: [i32; 2], holds: impl Fn(i32) -> bool) -> i32 {
    while first < beyond {
        let middle = first + (beyond - first) / 2;
        if holds(middle) { first = middle + 1 } else { beyond = middle }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_abi::format::DepthFormat;

    fn at(x: i32, y: i32) -> ScreenVertex {
        ScreenVertex { x, y, ..ScreenVertex::default() }
    }

    const ALL: [i32; 4] = [0, 0, 64, 64];

    fn floor_and_end(places: Option<[Place; 2]>, tile: i32) -> Option<(i64, bool)> {
        places.map(|[least, greatest]| (least.interval(tile), greatest.is_beyond(tile)))
    }

    #[test]
    fn across_crossing_on_the_boundary_does_not_go_beyond() {
        // The right edge crosses y = 2048 at x = 2048 exactly: slope 1 from (0, 0).
        let v = [at(0, 0), at(4096, 4096), at(0, 4096)];
        let extent = Extent { outline: Outline::Triangle(&v), area: ALL };
        assert_eq!(floor_and_end(extent.across([0, 2048]), 2048), Some((0, false)));
        assert_eq!(floor_and_end(extent.across([2048, 4096]), 2048), Some((0, true)));
    }

    #[test]
    fn across_crossing_a_fraction_beyond_the_boundary_goes_beyond() {
        // At y = 2048 the edge is at 2048 + 2048 / 4097.
        let v = [at(0, 0), at(4098, 4097), at(0, 4097)];
        let extent = Extent { outline: Outline::Triangle(&v), area: ALL };
        assert_eq!(floor_and_end(extent.across([0, 2048]), 2048), Some((0, true)));
    }

    #[test]
    fn across_vertex_inside_the_row_counts() {
        let v = [at(100, 0), at(3000, 1000), at(100, 4000)];
        let extent = Extent { outline: Outline::Triangle(&v), area: ALL };
        assert_eq!(floor_and_end(extent.across([0, 2048]), 2048), Some((0, true)));
    }

    #[test]
    fn down_triangle_that_ends_on_a_boundary_is_cut_by_the_scissor_only() {
        let v = [at(-100, -100), at(2048, 0), at(0, 2048)];
        let extent = Extent { outline: Outline::Triangle(&v), area: ALL };
        assert_eq!(extent.down(), Some([0, 2048]));
    }

    #[test]
    fn down_bounding_box_beside_the_scissor_is_not_stored() {
        let v = [at(0, 0), at(2048, 0), at(0, 2048)];
        let extent = Extent { outline: Outline::Triangle(&v), area: [8, 0, 64, 64] };
        assert_eq!(extent.down(), None);
    }

    #[test]
    fn line_steep_and_flat_have_the_columns_of_their_pixels() {
        let ends = [[at(128, 128), at(128 + 40 * 256, 128 + 10 * 256)], [at(128, 128), at(128 + 2560, 128 + 10_240)]];
        for v in ends {
            let line = Line::new(&v, DepthFormat::default()).expect("long");
            let extent = Extent { outline: Outline::Line(&line), area: ALL };
            for row in 0..6 {
                let drawn = |x: i32| {
                    (8 * row..8 * row + 8).any(|y| {
                        let (step, minor) = if line.axis == Axis::X { (x, y) } else { (y, x) };
                        (line.steps[0]..line.steps[1]).contains(&step) && line.minor_at(step) == minor
                    })
                };
                let columns = extent.across([row * 2048, row * 2048 + 2048]).map(|c| c.map(|p| p.interval(256)));
                let first = (0..64).find(|&x| drawn(x));
                let beyond = (0..64).rfind(|&x| drawn(x)).map(|x| i64::from(x) + 1);
                assert_eq!(columns, first.map(i64::from).zip(beyond).map(|(a, b)| [a, b]), "row {row} of {line:?}");
            }
        }
    }
}
