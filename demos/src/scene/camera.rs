//! How world positions become pixels.
//!
//! Eye space: the viewer at the origin looks down -z, x to the right, y up. Clip space: x and y in -w..=w
//! with y up, depth z in 0..=w, 0 near. Screen space: pixels, y down. Matrices are for row vectors.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};

use super::Matrix;

/// The camera of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Camera {
    /// Positions are pixels (centres at .5, y down) and depth 0..=1.
    #[default]
    Screen,
    /// Parallel projection.
    Orthographic(Orthographic),
    /// Central projection.
    Perspective(Perspective),
}

/// A parallel projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// Where the viewer stands.
    pub eye: [f32; 3],
    /// What the viewer looks at.
    pub target: [f32; 3],
    /// Roughly upwards; not along the line of sight.
    pub up: [f32; 3],
    /// Width of the field of view, world units.
    pub width: f32,
    /// Distance of depth 0, world units.
    pub near: f32,
    /// Distance of depth 1, world units.
    pub far: f32,
}

/// A central projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// Where the viewer stands.
    pub eye: [f32; 3],
    /// What the viewer looks at.
    pub target: [f32; 3],
    /// Roughly upwards; not along the line of sight.
    pub up: [f32; 3],
    /// Angle between the left and the right edge of the picture.
    pub fov_x_degrees: f32,
    /// Distance of depth 0, world units, above 0.
    pub near: f32,
    /// Distance of depth 1, world units.
    pub far: f32,
}

/// A position or direction in double precision.
pub(crate) fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))
}

/// A position or direction in single precision.
pub(crate) fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// A row-major matrix for row vectors lies in memory as a column-major one for column vectors.
pub(crate) fn wide_matrix(m: &Matrix) -> DMat4 {
    DMat4::from_cols_array(&m.map(f64::from))
}

fn narrow_matrix(m: DMat4) -> Matrix {
    m.to_cols_array().map(|entry| entry as f32)
}

impl Camera {
    /// Eye, target and up, unless positions are pixels already.
    #[must_use]
    pub fn placement(&self) -> Option<[[f32; 3]; 3]> {
        match self {
            Self::Screen => None,
            Self::Orthographic(camera) => Some([camera.eye, camera.target, camera.up]),
            Self::Perspective(camera) => Some([camera.eye, camera.target, camera.up]),
        }
    }

    /// Pixels for each eye-space unit (at distance 1 in perspective): the K of the decal transform.
    #[must_use]
    pub fn pixels_per_unit(&self, size: [u32; 2]) -> f64 {
        let columns = f64::from(size[0]);
        match self {
            Self::Screen => 1.0,
            Self::Orthographic(camera) => columns / f64::from(camera.width),
            Self::Perspective(camera) => columns / (2.0 * half_width_at_one(camera.fov_x_degrees)),
        }
    }

    /// World to eye space; the identity for the screen camera.
    #[must_use]
    pub fn view_matrix(&self) -> Matrix {
        narrow_matrix(self.view())
    }

    /// Eye to clip space for a target of `size` pixels; the identity for the screen camera.
    #[must_use]
    pub fn projection_matrix(&self, size: [u32; 2]) -> Matrix {
        narrow_matrix(self.projection(size))
    }

    fn view(&self) -> DMat4 {
        let Some([eye, target, up]) = self.placement() else { return DMat4::IDENTITY };
        let back = (wide(eye) - wide(target)).normalize();
        let right = wide(up).cross(back).normalize();
        let up = back.cross(right);
        let turn = DMat3::from_cols(right, up, back).transpose();
        DMat4::from_mat3_translation(turn, -(turn * wide(eye)))
    }

    fn projection(&self, size: [u32; 2]) -> DMat4 {
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        match self {
            Self::Screen => DMat4::IDENTITY,
            Self::Orthographic(camera) => {
                let half = f64::from(camera.width) / 2.0;
                let (near, far) = (f64::from(camera.near), f64::from(camera.far));
                DMat4::from_cols(
                    DVec4::new(1.0 / half, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, aspect / half, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, 1.0 / (near - far), 0.0),
                    DVec4::new(0.0, 0.0, near / (near - far), 1.0),
                )
            }
            Self::Perspective(camera) => {
                let half = half_width_at_one(camera.fov_x_degrees);
                let (near, far) = (f64::from(camera.near), f64::from(camera.far));
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

    /// Where a world position falls: x and y in pixels (y down) and depth; `None` at or behind the viewer.
    #[must_use]
    pub fn project(&self, position: [f32; 3], size: [u32; 2]) -> Option<[f64; 3]> {
        let position = wide(position);
        if matches!(self, Self::Screen) {
            return Some(position.to_array());
        }
        let clip = self.projection(size) * (self.view() * position.extend(1.0));
        if clip.w <= 0.0 {
            return None;
        }
        let [columns, rows] = size.map(f64::from);
        let (x, y) = (clip.x / clip.w, clip.y / clip.w);
        Some([(x + 1.0) / 2.0 * columns, (1.0 - y) / 2.0 * rows, clip.z / clip.w])
    }

    /// The camera moved round its target: `yaw` about the up direction and `pitch` toward it, in radians, and
    /// `zoom` as a factor on the distance (on the width, for a parallel projection). The depth range is widened
    /// when needed to hold what it held. Pitch stops short of the poles. The screen camera stays.
    #[must_use]
    pub fn orbited(&self, yaw: f64, pitch: f64, zoom: f64) -> Self {
        let Some([eye, target, up]) = self.placement() else { return *self };
        let zoom = zoom.clamp(0.01, 100.0);
        let (target, up) = (wide(target), wide(up).normalize());
        let arm = DQuat::from_axis_angle(up, yaw) * (wide(eye) - target);
        let side = up.cross(arm).normalize();
        let from_pole = arm.angle_between(up);
        let limit = 0.05;
        let pitch = pitch.clamp(from_pole - std::f64::consts::PI + limit, (from_pole - limit).max(-3.0));
        let arm = DQuat::from_axis_angle(side, -pitch) * arm;
        match *self {
            Self::Screen => *self,
            Self::Orthographic(camera) => Self::Orthographic(Orthographic {
                eye: narrow(target + arm),
                width: (f64::from(camera.width) * zoom) as f32,
                ..camera
            }),
            Self::Perspective(camera) => {
                let distance = arm.length();
                let moved = distance * (zoom - 1.0);
                let near = (f64::from(camera.near) + moved).max(f64::from(camera.near) * zoom.min(1.0));
                Self::Perspective(Perspective {
                    eye: narrow(target + arm * zoom),
                    near: near as f32,
                    far: (f64::from(camera.far) + moved.max(0.0)) as f32,
                    ..camera
                })
            }
        }
    }
}

/// Half the width of the field of view at distance 1.
fn half_width_at_one(fov_x_degrees: f32) -> f64 {
    (f64::from(fov_x_degrees).to_radians() / 2.0).tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn front_view() -> Camera {
        Camera::Perspective(Perspective {
            eye: [0.0, 0.0, 5.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_x_degrees: 90.0,
            near: 1.0,
            far: 9.0,
        })
    }

    #[test]
    fn project_target_falls_on_the_middle() {
        let [x, y, depth] = front_view().project([0.0; 3], [640, 480]).expect("in front");
        assert!((x - 320.0).abs() < 1e-9 && (y - 240.0).abs() < 1e-9);
        assert!((depth - 0.9).abs() < 1e-9, "{depth}");
    }

    #[test]
    fn project_right_and_up_goes_right_and_up_with_square_pixels() {
        let [x, y, _] = front_view().project([1.0, 1.0, 0.0], [640, 480]).expect("in front");
        assert!((x - 384.0).abs() < 1e-9 && (y - 176.0).abs() < 1e-9, "{x} {y}");
        assert_eq!(front_view().project([0.0, 0.0, 5.0], [640, 480]), None);
    }

    #[test]
    fn matrices_row_vector_product_equals_projection() {
        let point = [0.3_f32, -0.2, 1.0, 1.0];
        let row =
            |m: &Matrix, v: [f32; 4]| std::array::from_fn::<f32, 4, _>(|c| (0..4).map(|r| v[r] * m[4 * r + c]).sum());
        let clip = row(&front_view().projection_matrix([640, 480]), row(&front_view().view_matrix(), point));
        let [x, _, depth] = front_view().project([0.3, -0.2, 1.0], [640, 480]).expect("in front");
        assert!((f64::from(clip[0] / clip[3]) * 320.0 + 320.0 - x).abs() < 1e-3);
        assert!((f64::from(clip[2] / clip[3]) - depth).abs() < 1e-6);
    }

    #[test]
    fn orbited_keeps_the_distance_and_stops_at_the_poles() {
        let turned = front_view().orbited(1.0, 9.0, 1.0);
        let eye = wide(turned.placement().expect("placed")[0]);
        assert!((eye.length() - 5.0).abs() < 1e-5);
        assert!(eye.y > 4.9 && eye.y < 5.0, "{eye}");
    }

    #[test]
    fn pixels_per_unit_is_resolution_over_field_of_view() {
        assert!((front_view().pixels_per_unit([640, 480]) - 320.0).abs() < 1e-9);
    }
}
