//! Cases 23 to 31: the Za unit, with both fidelities, over the bus.

mod blocks;
mod bypass;
mod words;

pub use blocks::{every_block_shape, largest_depth, one_pixel_in_a_cleared_block, widths_beside_blocks};
pub use bypass::{equal_to_the_word, no_stale_bypass, predictor_overflow};
pub use words::{last_of_thirty_two, words_are_maxima};

use crate::harness::{Hidden, Options, Prediction, Screen};
use crate::oracle::{Primitive, Vertex};

/// A screen on the Za path.
fn screen(size: [u32; 2], hidden: Hidden) -> Screen {
    Screen::new(size[0], size[1], &Options { hidden, ..Options::default() })
}

/// A setting with both fidelities.
fn both(hidden: Hidden) -> [Hidden; 2] {
    [hidden, hidden.clocked()]
}

/// A block shape with every prediction and both fidelities.
fn predictions(block: [u32; 2]) -> impl Iterator<Item = Hidden> {
    Prediction::ALL.into_iter().flat_map(move |prediction| both(Hidden { prediction, ..Hidden::za(block) }))
}

/// Two triangles over the pixels from (left, top) to before (right, bottom), of one depth.
fn quad([left, top, right, bottom]: [i32; 4], z: u32) -> [Primitive; 2] {
    let at = |x: i32, y: i32| Vertex::at(x * 256, y * 256, z);
    [
        Primitive::Triangle([at(left, top), at(right, top), at(left, bottom)]),
        Primitive::Triangle([at(left, bottom), at(right, top), at(right, bottom)]),
    ]
}

/// A point on a pixel's centre.
fn point(x: i32, y: i32, z: u32) -> Primitive {
    Primitive::Point(Vertex::at(x * 256 + 128, y * 256 + 128, z))
}
