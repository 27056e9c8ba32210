//! Cases 1 to 14: which pixels a triangle covers.

mod clipping;
mod coverage;
mod eye;
mod order;

pub use clipping::{beyond_the_guard_band, shared_edge_clipped_on_one_side};
pub use coverage::{
    fans_with_the_hub_on_a_centre, least_area, nearly_shared_floats, sliver_across_the_widest_target,
    small_triangles_at_a_centre, t_junction, vertices_at_the_limits,
};
pub use eye::{
    coordinates_near_the_integer_minimum, numbers_that_are_none, rotated_quads_in_perspective,
    vertices_at_and_behind_the_eye,
};
pub use order::shifts_orders_and_threads;

use crate::oracle::{Primitive, Vertex};

/// A triangle of one depth, corners in u.
fn triangle(corners: [(i32, i32); 3], z: u32) -> Primitive {
    Primitive::Triangle(corners.map(|(x, y)| Vertex::at(x, y, z)))
}

/// u at the centre of a pixel.
const fn centre(pixel: i32) -> i32 {
    pixel * 256 + 128
}
