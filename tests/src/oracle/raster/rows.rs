//! The pixels of a primitive as runs of rows, so that a picture can be drawn row by row and rows by many threads.
//!
//! A triangle covers a row where three linear inequalities in the column hold, one for each edge. Each is solved for the
//! column by one exact division, rounded towards the inside; what is left of the row is the run. Lines and points are
//! few pixels, found as the definition finds them and put into order.

use std::ops::Range;

use super::super::{Primitive, Vertex};
use super::triangle::{Edge, edges};
use super::{for_each_pixel, touched};

/// The pixels of a target that a primitive draws.
#[derive(Clone, Debug)]
pub struct Rows {
    rows: Range<u32>,
    shape: Shape,
}

#[derive(Clone, Debug)]
enum Shape {
    Triangle {
        edges: [Edge; 3],
        columns: Range<u32>,
    },
    /// Row and column, by row, then column.
    Pixels(Vec<[u32; 2]>),
}

impl Rows {
    /// On a target of `width` x `height` pixels.
    #[must_use]
    pub fn new(primitive: &Primitive, width: u32, height: u32) -> Self {
        match primitive {
            Primitive::Triangle(vertices) => Self::of_triangle(vertices, width, height),
            Primitive::Line(_) | Primitive::Point(_) => {
                let mut pixels = Vec::new();
                for_each_pixel(primitive, width, height, |i, j| pixels.push([j, i]));
                pixels.sort_unstable();
                let rows = pixels.first().map_or(0, |first| first[0])..pixels.last().map_or(0, |last| last[0] + 1);
                Self { rows, shape: Shape::Pixels(pixels) }
            }
        }
    }

    fn of_triangle(vertices: &[Vertex; 3], width: u32, height: u32) -> Self {
        let Some(edges) = edges(vertices) else { return Self { rows: 0..0, shape: Shape::Pixels(Vec::new()) } };
        let range = |values: [i32; 3], size| {
            let least = values.into_iter().fold(i32::MAX, i32::min);
            touched(least, values.into_iter().fold(i32::MIN, i32::max), size)
        };
        let columns = range(vertices.map(|v| v.x), width);
        Self { rows: range(vertices.map(|v| v.y), height), shape: Shape::Triangle { edges, columns } }
    }

    /// Rows outside of which nothing is drawn.
    #[must_use]
    pub fn rows(&self) -> Range<u32> {
        self.rows.clone()
    }

    /// At most as many pixels, or what it takes to find out that there are fewer.
    #[must_use]
    pub fn work(&self) -> u64 {
        match &self.shape {
            Shape::Triangle { columns, .. } => self.rows.len() as u64 * columns.len() as u64,
            Shape::Pixels(pixels) => pixels.len() as u64,
        }
    }

    /// Calls `visit` for the runs of row `j`, from left to right.
    pub fn for_each_run(&self, j: u32, mut visit: impl FnMut(Range<u32>)) {
        if !self.rows.contains(&j) {
            return;
        }
        match &self.shape {
            Shape::Triangle { edges, columns } => {
                let run = run(edges, j, [128, 128], columns);
                if !run.is_empty() {
                    visit(run);
                }
            }
            Shape::Pixels(pixels) => {
                let from = pixels.partition_point(|pixel| pixel[0] < j);
                pixels[from..].iter().take_while(|pixel| pixel[0] == j).for_each(|pixel| visit(pixel[1]..pixel[1] + 1));
            }
        }
    }
}

/// The columns whose sample `(u, v)`, in 1/256 pixel from the pixel's upper left corner, lies inside all edges.
pub(super) fn run(edges: &[Edge; 3], j: u32, [u, v]: [u32; 2], columns: &Range<u32>) -> Range<u32> {
    let y = i128::from(j) * 256 + i128::from(v);
    // First and last column, both of them inside.
    let (mut first, mut last) = (i128::from(columns.start), i128::from(columns.end) - 1);
    for edge in edges {
        // e >= 0 on a closed edge, e >= 1 on an open one, with e = e_0 + step * column.
        let missing = i128::from(!edge.closed) - edge.at(u.into(), y, 1);
        let step = edge.a * 256;
        match step.signum() {
            1 => first = first.max(-(-missing).div_euclid(step)),
            -1 => last = last.min((-missing).div_euclid(-step)),
            _ if missing > 0 => return 0..0,
            _ => {}
        }
    }
    if first > last { 0..0 } else { first as u32..last as u32 + 1 }
}

#[cfg(test)]
mod tests {
    use super::super::covers;
    use super::*;
    use proptest::prelude::*;

    fn check(primitive: &Primitive, width: u32, height: u32) -> Result<(), TestCaseError> {
        let rows = Rows::new(primitive, width, height);
        let mut count = vec![0u32; (width * height) as usize];
        for j in 0..height {
            rows.for_each_run(j, |run| run.for_each(|i| count[(j * width + i) as usize] += 1));
        }
        for (pixel, count) in (0..).zip(&count) {
            let (i, j) = (pixel % width as i32, pixel / width as i32);
            prop_assert_eq!(*count, u32::from(covers(primitive, i, j)), "pixel ({}, {})", i, j);
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn runs_any_primitive_equal_the_definition(xy in prop::array::uniform6(-900i32..2900), kind in 0usize..3) {
            let v = [0, 2, 4].map(|k| Vertex::at(xy[k], xy[k + 1], 0));
            check(&[Primitive::Triangle(v), Primitive::Line([v[0], v[1]]), Primitive::Point(v[0])][kind], 9, 8)?;
        }

        #[test]
        fn runs_edges_through_centres_equal_the_definition(xy in prop::array::uniform6(-3i32..20)) {
            // On the lattice of half pixels: most edges meet centres.
            check(&Primitive::Triangle([0, 2, 4].map(|k| Vertex::at(xy[k] * 128, xy[k + 1] * 128, 0))), 9, 8)?;
        }

        #[test]
        fn runs_any_coordinates_equal_the_definition(xy in any::<[i32; 6]>(), shift in 0u32..22) {
            check(&Primitive::Triangle([0, 2, 4].map(|k| Vertex::at(xy[k] >> shift, xy[k + 1] >> shift, 0))), 9, 8)?;
        }
    }
}
