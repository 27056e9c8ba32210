//! Cases 32 to 37: the systolic array, in every variant and both fidelities, with and without a Z buffer, over the bus.

mod flow;
mod segments;

pub use flow::{disjoint_segments_permuted, refresh_with_tokens_in_flight};
pub use segments::{beyond_both_ends, equal_depths, extreme_gradients, one_element};

use super::Tally;
use crate::harness::hidden::SUPER_BUFFER;
use crate::harness::{Hidden, Options, Screen, State};
use crate::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

/// Every variant functional and clocked, with and without a Z buffer.
fn ways() -> impl Iterator<Item = (Hidden, bool)> {
    let variants = (0..2 * SUPER_BUFFER).map(Hidden::systolic);
    variants.flat_map(|hidden| [hidden, hidden.clocked()]).flat_map(|hidden| [(hidden, true), (hidden, false)])
}

/// A screen in such a way.
fn screen(size: [u32; 2], format: DepthFormat, (hidden, depth_buffer): (Hidden, bool)) -> Screen {
    Screen::new(size[0], size[1], &Options { depth: format, hidden, depth_buffer, ..Options::default() })
}

/// What the array counted for a scene.
struct Flow {
    tokens: u64,
    clocks: u64,
}

/// Draws a scene after a clear, compares it with the oracle, and tells what entered the array.
fn drawn(screen: &mut Screen, scene: &[Primitive], function: DepthFunction, tally: &mut Tally) -> Flow {
    screen.end();
    screen.clear_counts();
    screen.clear();
    screen.draw_ids(scene, &State::with(function));
    let picture = screen.read();
    let mut image = draw(picture.width, picture.height, scene, screen.options().depth, function);
    if !screen.options().depth_buffer {
        // Depths are gone with the scene.
        image.depth.clone_from(&picture.depth);
    }
    tally.add(&picture.against(&image));
    let events = screen.events();
    Flow { tokens: events["systolic.tokens"], clocks: events["systolic.clocks"] }
}

/// A line along row `y` over the pixels from `left` to before `right`, with depths at its ends.
fn segment(left: i32, right: i32, y: i32, depths: [u32; 2]) -> Primitive {
    let at = |x: i32, z: u32| Vertex::at(x * 256 + 128, y * 256 + 128, z);
    Primitive::Line([at(left, depths[0]), at(right, depths[1])])
}

/// A point in pixel (x, y).
fn point(x: i32, y: i32, z: u32) -> Primitive {
    Primitive::Point(Vertex::at(x * 256 + 128, y * 256 + 128, z))
}

/// Clocks of a scene of lines of `tokens` tokens on `width` elements.
///
/// Array: a token takes 3 clocks, the refresh token as well; refresh tokens come at least `width` clocks apart; the last
/// pixel is out `width` + 2 clocks after the last of them began. Super Buffer: a token takes 1, and 2 a pixel to come out.
#[must_use]
pub fn clocks(tokens: &[u64], width: u64, super_buffer: bool) -> u64 {
    let Some((first, rest)) = tokens.split_first() else { return 0 };
    if super_buffer {
        return tokens.iter().map(|count| count + 2 * width).sum();
    }
    rest.iter().fold(3 * first, |refresh, count| refresh + (3 * count + 3).max(width)) + width + 2
}
