//! Cameras and decals against numbers worked out by hand.

use zga_abi::format::DepthFormat;

use super::*;

const PERSPECTIVE: Camera = Camera::Perspective {
    eye: [0.0, 0.0, 5.0],
    target: [0.0; 3],
    up: [0.0, 1.0, 0.0],
    fov_x_degrees: 90.0,
    near: 1.0,
    far: 9.0,
};
const ORTHOGRAPHIC: Camera = Camera::Orthographic {
    eye: [10.0, 0.0, 0.0],
    target: [0.0; 3],
    up: [0.0, 0.0, 2.0],
    width: 8.0,
    near: 0.0,
    far: 20.0,
};

fn row_product(v: [f64; 4], m: &Matrix) -> [f64; 4] {
    std::array::from_fn(|c| (0..4).map(|r| v[r] * f64::from(m[4 * r + c])).sum())
}

/// Pixels and depth of a world position, as the card computes them.
fn screen(camera: &Camera, [x, y, z]: [f64; 3], width: u32, height: u32) -> [f64; 3] {
    let m = camera.matrices(width, height).expect("good camera");
    let clip = row_product(row_product([x, y, z, 1.0], &m.world_eye), &m.eye_clip);
    std::array::from_fn(|i| clip[i] / clip[3] * f64::from(m.viewport[i]) + f64::from(m.viewport[i + 3]))
}

#[track_caller]
fn assert_near(found: [f64; 3], expected: [f64; 3]) {
    let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(close, "{found:?} instead of {expected:?}");
}

#[test]
fn perspective_corners_fall_on_the_corners_of_the_picture() {
    // 90 degrees: at distance 1 the field is 2 wide; 640x480 makes it 1.5 high.
    assert_near(screen(&PERSPECTIVE, [-1.0, 0.75, 4.0], 640, 480), [0.0, 0.0, 0.0]);
    assert_near(screen(&PERSPECTIVE, [1.0, -0.75, 4.0], 640, 480), [640.0, 480.0, 0.0]);
    assert_near(screen(&PERSPECTIVE, [-9.0, 6.75, -4.0], 640, 480), [0.0, 0.0, 1.0]);
    assert_near(screen(&PERSPECTIVE, [0.0, 0.0, 0.0], 640, 480), [320.0, 240.0, 0.9]);
}

#[test]
fn orthographic_corners_fall_on_the_corners_of_the_picture() {
    // Looks along -x with z up: y is to the right.
    assert_near(screen(&ORTHOGRAPHIC, [10.0, -4.0, 2.0], 800, 400), [0.0, 0.0, 0.0]);
    assert_near(screen(&ORTHOGRAPHIC, [-10.0, 4.0, -2.0], 800, 400), [800.0, 400.0, 1.0]);
    assert_near(screen(&ORTHOGRAPHIC, [0.0, 1.0, 0.0], 800, 400), [500.0, 200.0, 0.5]);
}

#[test]
fn screen_camera_is_the_identity() {
    let m = Camera::Screen.matrices(640, 480).expect("good camera");
    assert_eq!((m.world_eye, m.eye_clip, m.viewport), (IDENTITY, IDENTITY, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
}

#[test]
fn check_bad_numbers_are_named() {
    let refused = |camera: Camera| camera.check().expect_err("bad camera").to_string();
    let Camera::Perspective { eye, target, up, fov_x_degrees, near, far } = PERSPECTIVE else { unreachable!() };
    let with = |eye, target, up, fov_x_degrees, near, far| {
        refused(Camera::Perspective { eye, target, up, fov_x_degrees, near, far })
    };
    assert!(with([f32::NAN, 0.0, 0.0], target, up, fov_x_degrees, near, far).starts_with("eye is NaN"));
    assert!(with(target, target, up, fov_x_degrees, near, far).contains("the same point"));
    assert!(with(eye, target, [0.0, 0.0, 3.0], fov_x_degrees, near, far).contains("along the line of sight"));
    assert!(with(eye, target, [0.0; 3], fov_x_degrees, near, far).contains("up has no length"));
    assert!(with(eye, target, up, 180.0, near, far).starts_with("fov_x_degrees is 180"));
    assert!(with(eye, target, up, f32::NAN, near, far).starts_with("fov_x_degrees is NaN"));
    assert!(with(eye, target, up, fov_x_degrees, 0.0, far).starts_with("near is 0"));
    assert!(with(eye, target, up, fov_x_degrees, near, near).starts_with("far is 1"));
    assert!(with(eye, target, up, fov_x_degrees, near, f32::INFINITY).starts_with("far is inf"));
}

#[test]
fn pixels_per_unit_is_resolution_over_field_of_view() {
    assert!((PERSPECTIVE.pixels_per_unit(640) - 320.0).abs() < 1e-9);
    assert!((ORTHOGRAPHIC.pixels_per_unit(800) - 100.0).abs() < 1e-9);
    assert!((Camera::Screen.pixels_per_unit(800) - 1.0).abs() < 1e-9);
}

#[test]
fn decal_orthographic_adds_s_over_2k_to_z() {
    let decal = Decal::new(&ORTHOGRAPHIC, 800, 8.0, DepthFormat::default()).expect("good slope");
    let mut expected = IDENTITY;
    expected[14] = 0.04; // 8 / (2 * 100)
    assert_eq!(decal.matrix, expected);
    assert!((decal.info.offset_eye - 0.04).abs() < 1e-12);
    // 0.04 of 20 units, in 2^24 - 1 steps.
    assert!((decal.info.depth_steps_near - 33_554.43).abs() < 0.01, "{:?}", decal.info);
    assert!(!decal.info.under_one_step);
}

#[test]
fn decal_perspective_scales_by_one_minus_s_over_2k() {
    let decal = Decal::new(&PERSPECTIVE, 640, 8.0, DepthFormat::default()).expect("good slope");
    let mut expected = IDENTITY;
    [expected[0], expected[5], expected[10]] = [0.9875; 3]; // 1 - 8 / 640
    assert_eq!(decal.matrix, expected);
}

#[test]
fn decal_screen_moves_half_a_pixel_of_slope_toward_depth_zero() {
    let decal = Decal::new(&Camera::Screen, 640, 8.0, DepthFormat::default()).expect("good slope");
    let mut expected = IDENTITY;
    expected[14] = -0.00625; // 8 / (2 * 640)
    assert_eq!(decal.matrix, expected);
    assert!((decal.info.offset_eye - 4.0).abs() < 1e-12);
}

#[test]
fn decal_negative_slope_moves_away_and_zero_does_not_move() {
    let away = Decal::new(&PERSPECTIVE, 640, -8.0, DepthFormat::default()).expect("good slope");
    assert!((away.matrix[0] - 1.0125).abs() < 1e-6);
    let still = Decal::new(&PERSPECTIVE, 640, 0.0, DepthFormat::default()).expect("good slope");
    assert_eq!((still.matrix, still.info.under_one_step), (IDENTITY, false));
}

#[test]
fn decal_slope_of_2k_is_refused_in_perspective_only() {
    let refused = Decal::new(&PERSPECTIVE, 640, 640.0, DepthFormat::default()).expect_err("at the viewer");
    assert!(refused.to_string().contains("below 64"), "{refused}");
    assert!(Decal::new(&PERSPECTIVE, 640, 639.9, DepthFormat::default()).is_ok());
    assert!(Decal::new(&ORTHOGRAPHIC, 640, 1e6, DepthFormat::default()).is_ok());
    assert!(Decal::new(&Camera::Screen, 640, f64::NAN, DepthFormat::default()).is_err());
    assert!(Decal::new(&Camera::Screen, 640, f64::INFINITY, DepthFormat::default()).is_err());
}

#[test]
fn decal_info_far_away_says_when_the_offset_is_under_one_step() {
    // Numerics case 47: near 1, far 1000, K 1000.
    let camera = Camera::Perspective {
        eye: [0.0; 3],
        target: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 90.0,
        near: 1.0,
        far: 1000.0,
    };
    let with_bits = |bits| {
        let format = DepthFormat::new(bits, 24).expect("known format");
        Decal::new(&camera, 2000, 8.0, format).expect("good slope").info
    };
    let (coarse, fine) = (with_bits(16), with_bits(24));
    // r / (1 - r) / 999 with r = 0.004, in 65535 and 2^24 - 1 steps.
    assert!((coarse.depth_steps_far - 0.263_46).abs() < 1e-4, "{coarse:?}");
    assert!((fine.depth_steps_far - 67.446).abs() < 1e-2, "{fine:?}");
    assert!(coarse.under_one_step && !fine.under_one_step);
    let beyond = coarse.one_step_distance.expect("within the range");
    assert!((beyond - 263.46).abs() < 0.1, "{beyond}");
}
