//! Coverage by definition: which pixels a primitive draws.
//!
//! * [`triangle`]: the top-left rule (published as the Direct3D 10 rasterisation rules; OpenGL leaves the
//!   tie open and only asks that a shared edge be drawn once).
//! * [`mod@line`]: the diamond-exit rule (OpenGL 4.6 core profile, section 14.5.1, "Basic Line Segment Rasterization").
//! * A point draws the pixel whose half-open square holds it.
//! * [`rows`]: the same pixels as runs of rows, for whole pictures.
//! * [`area`]: how much of a pixel a triangle covers, for studies of accuracy.

pub mod area;
pub mod line;
pub mod rows;
pub mod triangle;

pub use area::{half_plane_area, pixel_area};
pub use line::line_covers;
pub use rows::Rows;
pub use triangle::{Outline, triangle_covers, triangle_covers_at};

use super::{Primitive, Vertex};

/// Whether the point draws pixel `(i, j)`: `256 i <= x < 256 i + 256`, and so for y.
#[must_use]
pub fn point_covers(vertex: &Vertex, i: i32, j: i32) -> bool {
    let inside = |value: i32, pixel: i32| {
        let from = i64::from(pixel) * 256;
        (from..from + 256).contains(&i64::from(value))
    };
    inside(vertex.x, i) && inside(vertex.y, j)
}

/// Whether the primitive draws pixel `(i, j)`.
#[must_use]
pub fn covers(primitive: &Primitive, i: i32, j: i32) -> bool {
    match primitive {
        Primitive::Triangle(vertices) => triangle_covers(vertices, i, j),
        Primitive::Line(vertices) => line_covers(vertices, i, j),
        Primitive::Point(vertex) => point_covers(vertex, i, j),
    }
}

/// Calls `visit(i, j)` once for each pixel of the target, `width` x `height` pixels, that the primitive draws.
pub fn for_each_pixel(primitive: &Primitive, width: u32, height: u32, mut visit: impl FnMut(u32, u32)) {
    match primitive {
        Primitive::Triangle(vertices) => triangle::visit(vertices, width, height, &mut visit),
        Primitive::Line(vertices) => line::visit(vertices, width, height, &mut visit),
        Primitive::Point(vertex) => {
            let (i, j) = (vertex.x.div_euclid(256), vertex.y.div_euclid(256));
            if let (Ok(i), Ok(j)) = (u32::try_from(i), u32::try_from(j))
                && i < width
                && j < height
            {
                visit(i, j);
            }
        }
    }
}

/// The pixels of one axis, clipped to `0..size`, that a span of coordinates (u, both ends included) can touch.
fn touched(least: i32, greatest: i32, size: u32) -> std::ops::Range<u32> {
    let clip = |pixel: i64| pixel.clamp(0, i64::from(size)) as u32;
    let first = i64::from(least).div_euclid(256) - 1;
    let last = i64::from(greatest).div_euclid(256) + 1;
    clip(first)..clip(last + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn point_covers_edges_of_the_square_are_half_open() {
        let covered = [(0, 0), (255, 255), (256, 0), (0, 256), (-1, 0), (0, -1)]
            .map(|(x, y)| point_covers(&Vertex::at(x, y, 0), 0, 0));

        assert_eq!(covered, [true, true, false, false, false, false]);
    }

    #[test]
    fn covers_integer_extremes_have_no_overflow() {
        let (least, greatest) = (i32::MIN, i32::MAX);
        let corners = [Vertex::at(least, least, 0), Vertex::at(greatest, least, 9), Vertex::at(least, greatest, 3)];

        assert!(covers(&Primitive::Triangle(corners), -1, -1));
        assert!(!covers(&Primitive::Triangle(corners), 1, 1));
        assert!(!covers(&Primitive::Line([corners[1], corners[2]]), i32::MAX, 0));
        assert!(covers(&Primitive::Line([corners[0], Vertex::at(greatest, greatest, 0)]), 7, 7));
        assert!(point_covers(&corners[0], least / 256, least / 256));
    }

    proptest! {
        #[test]
        fn for_each_pixel_any_primitive_equals_the_definition(
            xy in prop::array::uniform6(-700i32..1800), kind in 0usize..3,
        ) {
            let v = [0, 2, 4].map(|k| Vertex::at(xy[k], xy[k + 1], 0));
            let primitive = [Primitive::Triangle(v), Primitive::Line([v[0], v[1]]), Primitive::Point(v[0])][kind];
            let mut count = vec![0u32; 5 * 4];

            for_each_pixel(&primitive, 5, 4, |i, j| count[(j * 5 + i) as usize] += 1);

            let expected: Vec<u32> = (0..20).map(|k| u32::from(covers(&primitive, k % 5, k / 5))).collect();
            prop_assert_eq!(count, expected);
        }
    }
}
