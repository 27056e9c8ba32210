//! Cameras: from world to eye to clip space, and the viewport.
//!
//! Eye space is right-handed: the viewer at the origin looks down -z, x to the right, y up. Clip space
//! is inside where -w <= x, y <= w (y up) and 0 <= z <= w, 0 near. Screen space is pixels, y down.

use glam::{DMat4, DVec3, DVec4};

use super::{Matrix, ViewError, finite};

/// How positions become pixels. Angles in degrees, lengths in world units.
///
/// The height of the field of view follows from the target's shape: pixels are square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Camera {
    /// No camera: x and y are pixels (centres at .5, y down), z is depth, 0 near to 1 far.
    #[default]
    Screen,
    /// Parallel projection.
    Orthographic {
        /// Where the viewer stands.
        eye: [f32; 3],
        /// What the viewer looks at.
        target: [f32; 3],
        /// Roughly upwards; not along the line of sight.
        up: [f32; 3],
        /// Width of the field of view, above 0.
        width: f32,
        /// Distance of depth 0; can be negative.
        near: f32,
        /// Distance of depth 1, above `near`.
        far: f32,
    },
    /// Central projection.
    Perspective {
        /// Where the viewer stands.
        eye: [f32; 3],
        /// What the viewer looks at.
        target: [f32; 3],
        /// Roughly upwards; not along the line of sight.
        up: [f32; 3],
        /// Angle between the left and the right edge of the picture, above 0 and below 180.
        fov_x_degrees: f32,
        /// Distance of depth 0, above 0.
        near: f32,
        /// Distance of depth 1, above `near`.
        far: f32,
    },
}

/// What the card's geometry registers hold for a camera and a target size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraMatrices {
    /// World to eye space.
    pub world_eye: Matrix,
    /// Eye to clip space.
    pub eye_clip: Matrix,
    /// Scale x, y, z, then offset x, y, z: clip / w to pixels and depth.
    pub viewport: [f32; 6],
}

impl Camera {
    /// Whether colours need perspective correction.
    #[must_use]
    pub const fn is_perspective(&self) -> bool {
        matches!(self, Camera::Perspective { .. })
    }

    /// Pixels for each eye-space unit (at distance 1 in perspective) on a target of `width` pixels: the K of
    /// the decal transform. 1 for the screen camera, whose unit is a pixel.
    #[must_use]
    pub fn pixels_per_unit(&self, width: u32) -> f64 {
        match self {
            Camera::Screen => 1.0,
            Camera::Orthographic { width: field, .. } => f64::from(width) / f64::from(*field),
            Camera::Perspective { fov_x_degrees, .. } => f64::from(width) / (2.0 * half_width(*fov_x_degrees)),
        }
    }

    /// Distances of depth 0 and depth 1. For the screen camera, whose depth range counts as deep as the
    /// picture is wide (see [`super::Decal`]), 0 and `width`.
    #[must_use]
    pub fn depth_range(&self, width: u32) -> [f64; 2] {
        match self {
            Camera::Screen => [0.0, f64::from(width)],
            Camera::Orthographic { near, far, .. } | Camera::Perspective { near, far, .. } => {
                [f64::from(*near), f64::from(*far)]
            }
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// Names the field that is not finite or out of range, or says why the placement looks nowhere.
    pub fn check(&self) -> Result<(), ViewError> {
        let [near, far] = self.depth_range(1);
        let bad = |field, found, expected| Err(ViewError::BadNumber { field, found, expected });
        match *self {
            Camera::Screen => return Ok(()),
            Camera::Orthographic { width, .. } => {
                if finite("width", width.into())? <= 0.0 {
                    return bad("width", width.into(), "above 0");
                }
            }
            Camera::Perspective { fov_x_degrees, near, .. } => {
                if !(fov_x_degrees > 0.0 && fov_x_degrees < 180.0) {
                    return bad("fov_x_degrees", fov_x_degrees.into(), "above 0 and below 180");
                }
                if finite("near", near.into())? <= 0.0 {
                    return bad("near", near.into(), "above 0");
                }
            }
        }
        finite("near", near)?;
        if finite("far", far)? <= near {
            return bad("far", far, "above near");
        }
        self.view().map(drop)
    }

    /// The matrices for a target of `width` times `height` pixels.
    ///
    /// # Errors
    /// As [`Camera::check`].
    pub fn matrices(&self, width: u32, height: u32) -> Result<CameraMatrices, ViewError> {
        self.check()?;
        let [columns, rows] = [width, height].map(f64::from);
        let viewport = match self {
            Camera::Screen => [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            _ => [columns / 2.0, -rows / 2.0, 1.0, columns / 2.0, rows / 2.0, 0.0].map(|entry| entry as f32),
        };
        Ok(CameraMatrices {
            world_eye: narrow(self.view()?),
            eye_clip: narrow(self.projection(columns / rows)),
            viewport,
        })
    }

    /// Eye, target and up, unless positions are pixels already.
    fn placement(&self) -> Option<[[f32; 3]; 3]> {
        match *self {
            Camera::Screen => None,
            Camera::Orthographic { eye, target, up, .. } | Camera::Perspective { eye, target, up, .. } => {
                Some([eye, target, up])
            }
        }
    }

    /// World to eye space.
    pub(crate) fn view(&self) -> Result<DMat4, ViewError> {
        let Some(placement) = self.placement() else { return Ok(DMat4::IDENTITY) };
        for (field, point) in ["eye", "target", "up"].into_iter().zip(placement) {
            for part in point {
                finite(field, part.into())?;
            }
        }
        let [eye, target, up] = placement.map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()));
        let degenerate = |reason| {
            let [eye, target, up] = placement;
            ViewError::Degenerate { reason, eye, target, up }
        };
        let forward = (target - eye).try_normalize().ok_or_else(|| degenerate("eye and target are the same point"))?;
        let up = up.try_normalize().ok_or_else(|| degenerate("up has no length"))?;
        let across = forward.cross(up);
        if across.length() < 1e-9 {
            return Err(degenerate("up lies along the line of sight"));
        }
        let right = across.normalize();
        let up = right.cross(forward);
        Ok(DMat4::from_cols(
            DVec4::new(right.x, up.x, -forward.x, 0.0),
            DVec4::new(right.y, up.y, -forward.y, 0.0),
            DVec4::new(right.z, up.z, -forward.z, 0.0),
            DVec4::new(-right.dot(eye), -up.dot(eye), forward.dot(eye), 1.0),
        ))
    }

    /// Eye to clip space for a target that is `aspect` times as wide as high.
    pub(crate) fn projection(&self, aspect: f64) -> DMat4 {
        match *self {
            Camera::Screen => DMat4::IDENTITY,
            Camera::Orthographic { width, near, far, .. } => {
                let half = f64::from(width) / 2.0;
                let (near, depth) = (f64::from(near), 1.0 / (f64::from(near) - f64::from(far)));
                DMat4::from_cols(
                    DVec4::new(1.0 / half, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, aspect / half, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, depth, 0.0),
                    DVec4::new(0.0, 0.0, near * depth, 1.0),
                )
            }
            Camera::Perspective { fov_x_degrees, near, far, .. } => {
                let half = half_width(fov_x_degrees);
                let (near, far) = (f64::from(near), f64::from(far));
                let depth = far / (near - far);
                DMat4::from_cols(
                    DVec4::new(1.0 / half, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, aspect / half, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, depth, -1.0),
                    DVec4::new(0.0, 0.0, near * depth, 0.0),
                )
            }
        }
    }
}

/// Half the width of the field of view at distance 1.
fn half_width(fov_x_degrees: f32) -> f64 {
    (f64::from(fov_x_degrees).to_radians() / 2.0).tan()
}

/// A column-major matrix for column vectors lies in memory as a row-major one for row vectors.
pub(crate) fn narrow(matrix: DMat4) -> Matrix {
    matrix.to_cols_array().map(|entry| entry as f32)
}

/// The other way.
pub(crate) fn wide(matrix: &Matrix) -> DMat4 {
    DMat4::from_cols_array(&matrix.map(f64::from))
}
