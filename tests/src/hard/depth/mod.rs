//! Cases 15 to 22: depth.

mod planes;
mod relations;
mod visibility;

pub use planes::{
    flat_across_the_widest_target, one_step_across_the_target, steepest_plane, whole_range_across_the_target,
};
pub use relations::{equal_after_less, offset_of_all_depths, offsets_at_the_limits};
pub use visibility::planes_that_cross;

use crate::oracle::DepthFormat;

/// Every depth format: n, then F, rising.
fn formats() -> impl Iterator<Item = DepthFormat> {
    [16, 24, 31].into_iter().flat_map(|bits| [0, 8, 16, 24].map(|fraction| DepthFormat { bits, fraction }))
}
