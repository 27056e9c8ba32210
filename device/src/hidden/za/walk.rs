//! The edge and line walkers of the clocked Za unit: what a primitive covers, row by row from the top.
//!
//! A triangle's edges grow by their steps from row to row. Lines and points are walked ahead, one run for
//! each row, and put in order.

use crate::geometry::assembly::Shape;
use crate::geometry::line::Line;
use crate::geometry::plane::Axis;
use crate::geometry::triangle::{Triangle, WALK};
use zga_firmware::checked::Rectangle;

/// What a primitive covers of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Row.
    pub y: i32,
    /// First column.
    pub first: i32,
    /// First column beyond.
    pub beyond: i32,
}

/// Rows of a primitive that cover something inside the scissor, from the top.
#[derive(Clone, Debug)]
pub enum Walker {
    /// On the edges of a triangle.
    Edges(Edges),
    /// What was walked ahead, the last row first.
    Ahead(Vec<Run>),
}

/// The edges of a triangle on their way down.
#[derive(Clone, Copy, Debug)]
pub struct Edges {
    triangle: Triangle,
    /// The row they are on, and the first that they do not come to.
    rows: [i32; 2],
    /// Long and short edge on that row; s20.43, pixels.
    at: [i64; 2],
    /// Columns of the scissor.
    columns: [i32; 2],
}

impl Default for Walker {
    fn default() -> Self {
        Walker::Ahead(Vec::new())
    }
}

impl Walker {
    /// Starts a primitive; only pixels inside `scissor` are covered.
    #[must_use]
    pub fn new(shape: &Shape, scissor: &Rectangle) -> Walker {
        let columns = [scissor.x as i32, scissor.right as i32];
        let rows = [scissor.y as i32, scissor.bottom as i32];
        match shape {
            Shape::Triangle(triangle, _) => Walker::Edges(Edges::new(triangle, columns, rows)),
            Shape::Line(line, _) => Walker::Ahead(line_runs(line, columns, rows)),
            Shape::Point(point, _) => {
                let [x, y] = point.pixel;
                let inside = (columns[0]..columns[1]).contains(&x) && (rows[0]..rows[1]).contains(&y);
                Walker::Ahead(if inside { vec![Run { y, first: x, beyond: x + 1 }] } else { Vec::new() })
            }
        }
    }
}

impl Iterator for Walker {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        match self {
            Walker::Edges(edges) => edges.next(),
            Walker::Ahead(runs) => runs.pop(),
        }
    }
}

impl Edges {
    fn new(triangle: &Triangle, columns: [i32; 2], rows: [i32; 2]) -> Edges {
        let rows = [triangle.rows[0].max(rows[0]), triangle.rows[2].min(rows[1])];
        let short = if rows[0] < triangle.rows[1] {
            triangle.short[0].walk(rows[0] - triangle.rows[0])
        } else {
            triangle.short[1].walk(rows[0] - triangle.rows[1])
        };
        let long = triangle.long.walk(rows[0] - triangle.rows[0]);
        Edges { triangle: *triangle, rows, at: [long, short], columns }
    }

    /// The edges' row inside the scissor, and on to the next row.
    fn step(&mut self) -> Run {
        let [a, b] = self.at.map(|at| (at >> WALK) as i32);
        let y = self.rows[0];
        let run = Run { y, first: a.min(b).max(self.columns[0]), beyond: a.max(b).min(self.columns[1]) };
        let [upper, lower] = &self.triangle.short;
        self.rows[0] += 1;
        self.at[0] = self.at[0].wrapping_add(self.triangle.long.step);
        self.at[1] = if y + 1 == self.triangle.rows[1] {
            lower.x
        } else {
            self.at[1].wrapping_add(if y + 1 < self.triangle.rows[1] { upper.step } else { lower.step })
        };
        run
    }

    fn next(&mut self) -> Option<Run> {
        while self.rows[0] < self.rows[1] {
            let run = self.step();
            if run.first < run.beyond {
                return Some(run);
            }
        }
        None
    }
}

/// A line's runs inside the scissor, the last row first.
fn line_runs(line: &Line, columns: [i32; 2], rows: [i32; 2]) -> Vec<Run> {
    let (along, across) = if line.axis == Axis::X { (columns, rows) } else { (rows, columns) };
    let mut runs: Vec<Run> = Vec::new();
    for step in line.steps[0].max(along[0])..line.steps[1].min(along[1]) {
        let minor = line.minor_at(step);
        if !(across[0]..across[1]).contains(&minor) {
            continue;
        }
        let (x, y) = if line.axis == Axis::X { (step, minor) } else { (minor, step) };
        match runs.last_mut() {
            Some(run) if run.y == y => run.beyond = x + 1,
            _ => runs.push(Run { y, first: x, beyond: x + 1 }),
        }
    }
    if runs.first().is_some_and(|first| runs.last().is_some_and(|last| first.y < last.y)) {
        runs.reverse();
    }
    runs
}
