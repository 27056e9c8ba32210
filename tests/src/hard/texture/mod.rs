//! Cases 52 to 56: levels of detail, coordinates near the eye, layers of one depth, holes.

mod holes;
mod layers;
mod levels;
mod span;

pub use holes::holes_at_the_reference;
pub use layers::equal_layers;
pub use levels::{level_weights, quad_across_the_eye};
pub use span::widest_span_of_w;

use super::Tally;
use crate::harness::{Comparison, Hidden, Options, Path, Pixels};
use crate::oracle::effects::Corner;
use zga_device::Kernel;

/// A corner under the identity camera: pixels and depth; coordinates.
fn corner([x, y]: [f32; 2], z: f32, colour: u32, coordinates: [f32; 2]) -> Corner {
    Corner { position: [x, y, z], colour, coordinates, ..Corner::default() }
}

/// Two triangles between four corners: upper left, upper right, lower left, lower right.
const fn quad([a, b, c, d]: [Corner; 4]) -> [Corner; 6] {
    [a, b, c, c, b, d]
}

/// Two triangles over all of a target; u and v go from 0 to 1.
fn sheet([width, height]: [u32; 2], z: f32, colour: u32) -> [Corner; 6] {
    let [w, h] = [width, height].map(|side| side as f32);
    quad([[0., 0.], [1., 0.], [0., 1.], [1., 1.]].map(|[u, v]| corner([u * w, v * h], z, colour, [u, v])))
}

/// Every path and every size of a tile; two kernels.
fn ways() -> Vec<Options> {
    let sides = [4, 8, 16, 32, 64];
    let tiles = sides.into_iter().flat_map(|width| sides.map(|height| Hidden::tile([width, height])));
    let others = [Path::ZBuffer, Path::Za, Path::Systolic].map(Hidden::on);
    let all: Vec<Hidden> = tiles.chain(others).collect();
    let clocked = all.iter().filter(|hidden| hidden.tile[0] == 8).map(|hidden| hidden.clocked());
    let hidden: Vec<Hidden> = all.iter().copied().chain(clocked).collect();
    let kernels = [(Kernel::Specification, 1), (Kernel::Best, 2)];
    let options =
        |(kernel, threads), hidden| Options { hidden, kernel, threads, pixels: Pixels::Argb8888, ..Options::default() };
    hidden.iter().flat_map(|&hidden| kernels.map(|kernel| options(kernel, hidden))).collect()
}

impl Tally {
    /// Adds a comparison with the oracle of the effects.
    fn compared(&mut self, found: &Comparison, what: impl FnOnce() -> String) {
        self.pictures += 1;
        self.pixels += found.pixels;
        self.note(found.wrong + found.depths + found.strays, || format!("{}: {found}", what()));
    }
}
