//! From world to pixels: cameras, and the decal transform that depends on them.
//!
//! Matrices are 16 f32, row-major, for row vectors: `[x y z 1] * object_eye * decal * eye_clip`, then the
//! viewport. They are composed in f64 and rounded once.

pub(crate) mod camera;
mod decal;
mod fitted;

pub use camera::{Camera, CameraMatrices};
pub use decal::{Decal, DecalInfo};
pub use fitted::{Corners, FitInfo, FitView, FittedDecal, Marking};

/// A 4x4 matrix, row-major, for row vectors.
pub type Matrix = [f32; 16];

/// The identity.
pub const IDENTITY: Matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

/// Why a camera, a transform or a decal slope was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// A number is not finite or not in its range.
    #[error("{field} is {found}, expected {expected}")]
    BadNumber {
        /// Which number.
        field: &'static str,
        /// Its value.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// Eye and target are the same point, or up lies along the line of sight.
    #[error("the camera looks nowhere: {reason} (eye {eye:?}, target {target:?}, up {up:?})")]
    Degenerate {
        /// What is wrong.
        reason: &'static str,
        /// Eye.
        eye: [f32; 3],
        /// Target.
        target: [f32; 3],
        /// Up.
        up: [f32; 3],
    },
    /// In perspective a marking would be moved to the viewer or behind it.
    #[error("decal slope {slope} moves markings by S/2K = {part} of their distance; it must be below {limit} (2K)")]
    SlopeTooLarge {
        /// The slope S.
        slope: f64,
        /// S/2K, at least 1.
        part: f64,
        /// 2K: the slope must be smaller.
        limit: f64,
    },
    /// A fitted decal has no plane to be fitted to.
    #[error("surface {surface} of a fitted decal is none: three corners that do not lie on a line are expected")]
    NoSurface {
        /// Its place in the list of surfaces.
        surface: usize,
    },
}

/// Checks that a number is finite.
pub(crate) fn finite(field: &'static str, found: f64) -> Result<f64, ViewError> {
    if found.is_finite() { Ok(found) } else { Err(ViewError::BadNumber { field, found, expected: "a finite number" }) }
}

#[cfg(test)]
mod fitted_tests;
#[cfg(test)]
mod tests;
