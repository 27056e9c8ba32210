//! Fitted decals against points that are projected one by one.

use super::fitted::{Corners, FitView, FittedDecal, Marking};
use super::{Camera, Decal, IDENTITY, Matrix, ViewError};
use zga_abi::format::{DepthFormat, Topology};

const SIZE: [u32; 2] = [640, 480];
const STEPS: f64 = 16_777_215.0;

fn cameras() -> [Camera; 3] {
    let (eye, target, up) = ([1.0, 2.0, 9.0], [0.5, 0.0, 0.0], [0.0, 1.0, 0.1]);
    [
        Camera::Screen,
        Camera::Orthographic { eye, target, up, width: 8.0, near: 0.5, far: 40.0 },
        Camera::Perspective { eye, target, up, fov_x_degrees: 50.0, near: 0.5, far: 40.0 },
    ]
}

fn view(camera: &Camera, object: Matrix) -> FitView<'_> {
    FitView { camera, object, size: SIZE, format: DepthFormat::default(), subpixel_bits: 8 }
}

fn row_product(v: [f64; 4], m: &Matrix) -> [f64; 4] {
    [0, 1, 2, 3].map(|column| (0..4).map(|row| v[row] * f64::from(m[4 * row + column])).sum())
}

/// Pixels and depth of a point in object space, as the card makes them: depth from the displaced point.
fn screen(view: &FitView<'_>, [x, y, z]: [f64; 3], decal: &Matrix) -> [f64; 3] {
    let matrices = view.camera.matrices(SIZE[0], SIZE[1]).expect("a camera");
    let eye = row_product(row_product([x, y, z, 1.0], &view.object), &matrices.world_eye);
    let (still, moved) =
        (row_product(eye, &matrices.eye_clip), row_product(row_product(eye, decal), &matrices.eye_clip));
    let [sx, sy, _, ox, oy, _] = matrices.viewport.map(f64::from);
    [still[0] / still[3] * sx + ox, still[1] / still[3] * sy + oy, moved[2] / moved[3]]
}

/// A triangle in the middle of each camera's view, and where that is.
fn surface(camera: &Camera) -> Corners {
    match camera {
        Camera::Screen => [[100.0, 50.0, 0.25], [500.0, 120.0, 0.375], [220.0, 400.0, 0.75]],
        _ => [[-2.0, -1.0, -3.0], [2.5, -0.5, 1.0], [0.25, 2.0, -0.5]],
    }
}

/// The point of a surface with these weights of its second and third corner.
fn point([a, b, c]: &Corners, s: f64, t: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| f64::from(a[k]) * (1.0 - s - t) + f64::from(b[k]) * s + f64::from(c[k]) * t)
}

#[test]
fn fitted_gradient_is_that_of_the_projected_surface() {
    let turned = [0.8, 0.6, 0.0, 0.0, -0.6, 0.8, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, -0.25, 0.125, 1.0];
    for (camera, object) in cameras().iter().flat_map(|camera| [(camera, IDENTITY), (camera, turned)]) {
        let (view, corners) = (view(camera, object), surface(camera));

        let info = FittedDecal::new(&view, 1e6, &[corners], Marking::Lines).expect("a surface").info;

        let [a, b, c] = corners.map(|corner| screen(&view, corner.map(f64::from), &IDENTITY));
        let [u, v] = [b, c].map(|to| [0, 1, 2].map(|k| to[k] - a[k]));
        let area = u[0] * v[1] - u[1] * v[0];
        let expected = [(u[2] * v[1] - v[2] * u[1]) / area, (u[0] * v[2] - v[0] * u[2]) / area];
        for (found, expected) in info.gradient.into_iter().zip(expected) {
            // World to eye space is rounded to f32, here once and on the card together with object to world.
            assert!((found - expected.abs()).abs() <= 2e-6 * expected.abs(), "{camera:?}: {info:?}, {expected}");
        }
        assert!(!info.limited);
    }
}

#[test]
fn fitted_matrix_moves_every_depth_by_the_displacement_and_no_pixel() {
    for camera in &cameras() {
        let (view, corners) = (view(camera, IDENTITY), surface(camera));
        for marking in [Marking::Triangles, Marking::Lines, Marking::Points, Marking::WideLines(0x300)] {
            let decal = FittedDecal::new(&view, 8.0, &[corners], marking).expect("a surface");
            for (s, t) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.3, 0.3), (0.9, 0.05)] {
                let place = point(&corners, s, t);

                let [still, moved] = [IDENTITY, decal.matrix].map(|matrix| screen(&view, place, &matrix));

                let (by, asked) = (still[2] - moved[2], decal.info.displacement);
                // The matrix is rounded up to f32, depths are good for 2^-50.
                assert!(by >= asked - 1e-14 && by <= asked * (1.0 + 2.5e-7) + 1e-14, "{camera:?}: {by} {asked}");
                assert_eq!(still[..2], moved[..2]);
            }
        }
    }
}

#[test]
fn fitted_displacement_is_half_a_pixel_of_the_steeper_gradient_and_little_more() {
    for camera in &cameras() {
        let (view, corners) = (view(camera, IDENTITY), surface(camera));
        let of = |marking| FittedDecal::new(&view, 1e6, &[corners], marking).expect("a surface").info;
        let [x, y] = of(Marking::Lines).gradient;
        // The snap of surface and marking to 1/256, three steps, and the rounding of positions, some steps.
        let slack = (x + y) / 256.0 + 16.0 / STEPS;
        let expected = [
            (Marking::Triangles, 0.0),
            (Marking::Lines, x.max(y) / 2.0),
            (Marking::Points, (x + y) / 2.0),
            (Marking::WideLines(0x280), 1.25 * x.hypot(y) + (x + y) / 512.0),
            (Marking::WidePoints(0x301), 1.504 * (x + y)),
        ];
        for (marking, expected) in expected {
            let found = of(marking).displacement;
            assert!(found > expected && found < expected * 1.001 + slack, "{camera:?}, {marking:?}: {found}");
        }
    }
}

#[test]
fn fitted_decal_takes_the_surface_that_needs_most() {
    let [_, camera, _] = cameras();
    let (view, steep) = (view(&camera, IDENTITY), surface(&camera));
    // Parallel to the view plane, nearly: the camera looks down, and this surface leans as much.
    let flat = steep.map(|[x, y, z]| [x, y, 0.1 * z - 0.2 * y]);
    let of = |surfaces: &[Corners]| FittedDecal::new(&view, 8.0, surfaces, Marking::Lines).expect("surfaces").info;
    let (one, other, both) = (of(&[steep]), of(&[flat]), of(&[flat, steep]));
    assert!(one.displacement > 2.0 * other.displacement, "{one:?} {other:?}");
    assert_eq!((both, of(&[steep, flat])), (one, one));
}

#[test]
fn fitted_decal_on_what_is_steeper_than_the_limit_moves_as_the_plain_one_at_the_nearest_corner() {
    let [screen_camera, orthographic, perspective] = cameras();
    // Through the line of sight: seen from its edge.
    let edge_on = [[0.75, 1.0, 4.5], [0.5, 0.0, 0.0], [0.75, 1.5, 0.0]];
    for slope in [0.0, 1.0, 8.0, 64.0] {
        for camera in [&orthographic, &perspective] {
            let view = view(camera, IDENTITY);
            let lines = FittedDecal::new(&view, slope, &[edge_on], Marking::Lines).expect("a plane");
            let plain = Decal::new(camera, SIZE[0], slope, DepthFormat::default()).expect("a slope");

            let nearest = edge_on
                .map(|corner| corner.map(f64::from))
                .into_iter()
                .map(|corner| [IDENTITY, plain.matrix].map(|matrix| screen(&view, corner, &matrix)[2]))
                .map(|[still, moved]| still - moved)
                .fold(0.0, f64::max);

            assert!(lines.info.limited, "{camera:?}, {slope}: {:?}", lines.info);
            // Snap of both coordinates, 2/256 of what is 1/2; rounding; steps.
            assert!(lines.info.displacement <= nearest * 1.02 + 4.0 / STEPS, "{camera:?}: {:?} {nearest}", lines.info);
        }
    }
    let upright = [[100.0, 50.0, 0.25], [100.0, 90.0, 0.5], [100.0, 60.0, 0.75]];
    let info =
        FittedDecal::new(&view(&screen_camera, IDENTITY), 8.0, &[upright], Marking::Lines).expect("a plane").info;
    assert!(info.limited && (info.gradient[0] - 8.0 / 640.0).abs() < 1e-12, "{info:?}");
}

#[test]
fn fitted_decal_behind_the_viewer_and_across_the_near_plane_is_finite() {
    let camera = cameras()[2];
    for corners in [
        [[0.0, -1.0, 20.0], [3.0, -1.0, 20.0], [0.0, -1.0, 30.0]],
        [[-5.0, -1.0, 20.0], [5.0, -1.0, 20.0], [0.0, -1.0, -20.0]],
        [[1.0, 2.0, 9.0], [2.0, 2.0, 9.0], [1.0, 3.0, 4.0]],
    ] {
        let decal = FittedDecal::new(&view(&camera, IDENTITY), 8.0, &[corners], Marking::Points).expect("a plane");
        assert!(decal.info.depth_steps >= 3.0 && decal.info.displacement < 0.5, "{corners:?}: {:?}", decal.info);
        assert!(decal.matrix.iter().all(|entry| entry.is_finite()));
    }
}

#[test]
fn fitted_decal_of_coarser_numbers_moves_farther() {
    let camera = cameras()[1];
    let fine = view(&camera, IDENTITY);
    let of =
        |view: &FitView<'_>| FittedDecal::new(view, 8.0, &[surface(&camera)], Marking::Triangles).expect("one").info;
    let coarse = of(&FitView { subpixel_bits: 4, ..fine }).displacement;
    assert!(coarse > 10.0 * of(&fine).displacement, "1/16 pixel: {coarse}");
    let depth = of(&FitView { format: DepthFormat::new(16, 0).expect("a format"), ..fine });
    // The surface is some 300 x 250 pixels, and without fraction bits a gradient is off by half a step a pixel.
    assert!(depth.depth_steps > 300.0 && depth.depth_steps < 3000.0, "{depth:?}");
}

#[test]
fn fitted_decal_of_what_is_no_surface_is_refused() {
    let camera = cameras()[2];
    let view = view(&camera, IDENTITY);
    let good = surface(&camera);
    let of = |slope: f64, surfaces: &[Corners]| FittedDecal::new(&view, slope, surfaces, Marking::Lines).err();

    assert_eq!(of(8.0, &[]), Some(ViewError::NoSurface { surface: 0 }));
    let line = [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
    assert_eq!(of(8.0, &[good, line]), Some(ViewError::NoSurface { surface: 1 }));
    assert_eq!(of(8.0, &[[[0.0; 3]; 3]]), Some(ViewError::NoSurface { surface: 0 }));
    let field = |error: Option<ViewError>| match error {
        Some(ViewError::BadNumber { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    assert_eq!(field(of(-1.0, &[good])), "decal slope");
    assert_eq!(field(of(f64::INFINITY, &[good])), "decal slope");
    assert_eq!(field(of(8.0, &[[[f32::NAN; 3], [0.0; 3], [1.0; 3]]])), "corner of a surface");
    let mut projective = IDENTITY;
    projective[3] = 0.5;
    let bent = FitView { object: projective, ..view };
    assert_eq!(field(FittedDecal::new(&bent, 8.0, &[good], Marking::Lines).err()), "object transform");
}

#[test]
fn marking_of_a_draw_has_widths_only_with_samples() {
    let kinds = [Topology::Triangles, Topology::Lines, Topology::LineStrip, Topology::Points];
    let plain = [Marking::Triangles, Marking::Lines, Marking::Lines, Marking::Points];
    let wide = [Marking::Triangles, Marking::WideLines(5), Marking::WideLines(5), Marking::WidePoints(7)];
    assert_eq!(kinds.map(|kind| Marking::of(kind, None)), plain);
    assert_eq!(kinds.map(|kind| Marking::of(kind, Some([5, 7]))), wide);
}
