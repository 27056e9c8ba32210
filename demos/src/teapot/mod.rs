//! The Utah teapot as a triangle mesh, with markings that lie exactly on its triangles.
//!
//! Duties: cuts every patch into level x level cells of two triangles, shares vertices between patches, gives analytic
//! normals. Inputs from: the Bézier data in `surface`. Outputs to: the demonstrations.

mod markings;
mod surface;
#[cfg(test)]
mod tests;

pub use markings::Marking;
pub use surface::Part;

use crate::mesh::Mesh;
use crate::scene::{Colour, narrow};
use surface::Sheet;

/// Coarsest cut of a patch: with one cell, both halves of the handle would fall together.
pub const MIN_LEVEL: u32 = 2;

/// Finest cut of a patch.
pub const MAX_LEVEL: u32 = 64;

/// A tessellated teapot.
#[derive(Clone, Debug)]
pub struct Teapot {
    mesh: Mesh,
    level: usize,
    grids: Vec<Grid>,
}

/// The vertices of one sheet in the mesh.
#[derive(Clone, Debug)]
struct Grid {
    sheet: Sheet,
    /// Cells along u and v.
    cells: [usize; 2],
    /// Mesh vertex of (0, 0).
    first: usize,
    /// Whether the first and the last row are single points.
    poles: [bool; 2],
}

impl Teapot {
    /// Cuts each of the 32 patches into `level` x `level` cells; `level` is held to 2..=64.
    #[must_use]
    pub fn new(level: u32, colour: Colour) -> Self {
        let level = level.clamp(MIN_LEVEL, MAX_LEVEL) as usize;
        let mut mesh = Mesh::new("teapot", Vec::new(), Vec::new(), colour);
        let mut normals = Vec::new();
        let mut grids = Vec::new();
        for sheet in Sheet::all() {
            let poles = match sheet.part {
                Part::Body => [false, true],
                Part::Lid => [true, false],
                Part::Handle | Part::Spout => [false, false],
            };
            let cells = [sheet.rows * level, sheet.columns * level];
            let grid = Grid { sheet, cells, first: mesh.positions.len(), poles };
            for i in 0..=cells[0] {
                let columns = if grid.is_pole(i) { 1 } else { cells[1] };
                for j in 0..columns {
                    let (u, v) = (i as f64 / level as f64, j as f64 / level as f64);
                    mesh.positions.push(narrow(grid.sheet.point(u, v)));
                    normals.push(narrow(grid.sheet.normal(u, v)));
                }
            }
            mesh.indices.extend(grid.triangles());
            grids.push(grid);
        }
        mesh.normals = Some(normals);
        Self { mesh, level, grids }
    }

    /// The mesh, with normals.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Cells along each side of a patch.
    #[must_use]
    pub fn level(&self) -> u32 {
        self.level as u32
    }
}

impl Grid {
    fn is_pole(&self, i: usize) -> bool {
        (i == 0 && self.poles[0]) || (i == self.cells[0] && self.poles[1])
    }

    /// The mesh vertex at row i and column j; columns go round.
    fn vertex(&self, i: usize, j: usize) -> u32 {
        let before = match i {
            0 => 0,
            _ if self.poles[0] => 1 + (i - 1) * self.cells[1],
            _ => i * self.cells[1],
        };
        let column = if self.is_pole(i) { 0 } else { j % self.cells[1] };
        (self.first + before + column) as u32
    }

    /// Two triangles a cell, anticlockwise from outside, the diagonal from (i, j + 1) to (i + 1, j); one at a pole.
    fn triangles(&self) -> impl Iterator<Item = u32> + '_ {
        let cells = (0..self.cells[0]).flat_map(|i| (0..self.cells[1]).map(move |j| (i, j)));
        let both = cells.flat_map(|(i, j)| {
            let [a, b] = [self.vertex(i, j), self.vertex(i, j + 1)];
            let [c, d] = [self.vertex(i + 1, j), self.vertex(i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        });
        both.filter(|[a, b, c]| a != b && b != c && c != a).flatten()
    }
}
