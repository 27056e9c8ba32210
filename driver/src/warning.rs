//! What works, but perhaps not as wished.

use zga_abi::format::HiddenSurface;

/// Something worth telling that is not an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// A decal's offset is smaller than a step of the Z buffer somewhere in the depth range.
    DecalUnderOneStep {
        /// The slope S.
        slope: f64,
        /// Bits of a depth.
        depth_bits: u32,
        /// The offset at depth 1, in steps.
        steps_far: f64,
        /// Beyond this distance it is smaller than one step.
        distance: f64,
    },
    /// A scene without a Z buffer drew before it had cleared all depth; see [`crate::Driver::set_keep_depth`].
    DepthBeginsFar {
        /// The path that it was drawn on.
        path: HiddenSurface,
    },
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Warning::DecalUnderOneStep { slope, depth_bits, steps_far, distance } => write!(
                f,
                "decal slope {slope}: with {depth_bits} depth bits the offset is under one depth step beyond distance \
                 {distance} ({steps_far:.3} steps at the far end); markings there may be buried"
            ),
            Warning::DepthBeginsFar { path } => write!(
                f,
                "a scene on the {} path keeps no Z buffer and drew before it had cleared all depth: depth began at the \
                 farthest, whatever was drawn before",
                path.name()
            ),
        }
    }
}
