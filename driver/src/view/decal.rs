//! Decal transform: surface markings are moved toward the viewer by S/2K, so that they are not buried
//! (JP 2579421 B2 / US 5,379,370).
//!
//! A marking's pixel lies up to half a pixel off the true line but has the true line's depth; on a surface
//! of slope S it can so be up to S * delta / 2 too far away, delta being a pixel in eye-space units.
//!
//! | camera | K, pixels for each unit | a pixel | matrix T'e |
//! | --- | --- | --- | --- |
//! | orthographic | width in pixels / field width | 1/K | z' = z + S/2K |
//! | perspective | width in pixels / field width at distance 1 | distance/K | (x, y, z) * (1 - S/2K) |
//! | screen | 1: the unit is a pixel | 1 | z' = z - S / (2 * width in pixels) |
//!
//! The slope is a ratio of lengths, so the screen camera needs a length for its depth range: it counts as
//! deep as the picture is wide. A surface that goes through the whole depth range from the left edge to
//! the right edge has slope 1, as it has for an orthographic camera with `far - near = width`. A shift of
//! S/2K = S/2 pixels is then S / (2 * width) of the depth range, and nearer is smaller.

use zga_abi::format::DepthFormat;

use super::{Camera, IDENTITY, Matrix, ViewError, finite};

/// The decal transform for a camera, a target and a slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decal {
    /// T'e: what the DECAL registers hold.
    pub matrix: Matrix,
    /// What it does, in numbers.
    pub info: DecalInfo,
}

/// How far a decal moves markings, and how much of it a Z buffer can tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecalInfo {
    /// The slope S that markings survive.
    pub slope: f64,
    /// K: pixels for each eye-space unit (at distance 1 in perspective).
    pub pixels_per_unit: f64,
    /// S/2K. Orthographic: eye-space units. Perspective: part of the distance. Screen: pixels.
    /// Positive is toward the viewer.
    pub offset_eye: f64,
    /// What the offset is in steps of the Z buffer at depth 0.
    pub depth_steps_near: f64,
    /// What the offset is in steps of the Z buffer at depth 1.
    pub depth_steps_far: f64,
    /// Somewhere in the depth range the offset is smaller than one step: markings there may be buried.
    pub under_one_step: bool,
    /// Distance beyond which the offset is smaller than one step, if that is within the depth range
    /// (perspective), or the near distance if it is so everywhere.
    pub one_step_distance: Option<f64>,
}

impl Decal {
    /// The transform for markings on surfaces up to `slope` (|dz/dx| or |dz/dy| in eye space), drawn on a
    /// target of `width` pixels. Negative slopes move away from the viewer; 0 moves nothing.
    ///
    /// # Errors
    /// The slope is not finite; or S/2K is 1 or more in perspective (the text says the limit).
    pub fn new(camera: &Camera, width: u32, slope: f64, format: DepthFormat) -> Result<Decal, ViewError> {
        finite("decal slope", slope)?;
        let pixels_per_unit = camera.pixels_per_unit(width);
        let offset_eye = slope / (2.0 * pixels_per_unit);
        let [near, far] = camera.depth_range(width);
        let steps = f64::from(format.maximum());
        let mut matrix = IDENTITY;
        // Steps are counted with the matrix entry as the card gets it: an offset that f32 rounds away is none.
        let (depth_steps_near, depth_steps_far) = match camera {
            Camera::Screen => {
                matrix[14] = (-offset_eye / far) as f32;
                let shift = -f64::from(matrix[14]) * steps;
                (shift, shift)
            }
            Camera::Orthographic { .. } => {
                matrix[14] = offset_eye as f32;
                let shift = f64::from(matrix[14]) / (far - near) * steps;
                (shift, shift)
            }
            Camera::Perspective { .. } => {
                // As the card would get it: 1 minus less than half a step of f32 is 1.
                if offset_eye as f32 >= 1.0 {
                    return Err(ViewError::SlopeTooLarge { slope, part: offset_eye, limit: 2.0 * pixels_per_unit });
                }
                let scale = (1.0 - offset_eye) as f32;
                [matrix[0], matrix[5], matrix[10]] = [scale; 3];
                let scale = f64::from(scale);
                let at_one = near * far / (far - near) * (1.0 - scale) / scale * steps;
                (at_one / near, at_one / far)
            }
        };
        let under_one_step = slope != 0.0 && depth_steps_near.abs().min(depth_steps_far.abs()) < 1.0;
        // In perspective the steps fall with 1 / distance.
        let reach = if depth_steps_near.abs() < 1.0 { near } else { depth_steps_near.abs() * near };
        Ok(Decal {
            matrix,
            info: DecalInfo {
                slope,
                pixels_per_unit,
                offset_eye,
                depth_steps_near,
                depth_steps_far,
                under_one_step,
                one_step_distance: under_one_step.then_some(reach),
            },
        })
    }
}
