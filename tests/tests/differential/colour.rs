//! Interpolated colours against exact rationals, and bit for bit between the ways to draw.

use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use proptest::prelude::*;
use zga_device::Kernel;
use zga_tests::harness::options::{Camera, IDENTITY};
use zga_tests::harness::scenes::{Piece, primitives, scene};
use zga_tests::harness::{Options, Pixels, RawVertex, Screen, State, Topology};
use zga_tests::oracle::colour::{ExactColour, affine, line_weights, perspective};
use zga_tests::oracle::exact::{from_f64, integer, ratio};
use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

/// Red, green, blue, alpha of a stored ARGB pixel.
fn channels(pixel: u32) -> [u32; 4] {
    [pixel >> 16 & 255, pixel >> 8 & 255, pixel & 255, pixel >> 24]
}

/// The largest distance of a pixel's channels from exact ones, in levels.
fn error(pixel: u32, exact: &ExactColour) -> BigRational {
    let distance = |(card, exact): (u32, &BigRational)| (integer(card) - exact).abs();
    channels(pixel).into_iter().zip(exact).map(distance).max().unwrap_or_default()
}

/// Gives every vertex of a scene its own colour.
fn paint(primitives: &mut [Primitive], colours: &[[u8; 4]]) {
    let mut colours = colours.iter().cycle();
    for primitive in primitives {
        let vertices: &mut [Vertex] = match primitive {
            Primitive::Triangle(v) => v,
            Primitive::Line(v) => v,
            Primitive::Point(v) => std::slice::from_mut(v),
        };
        vertices.iter_mut().zip(&mut colours).for_each(|(v, colour)| v.colour = *colour);
    }
}

fn painted() -> impl Strategy<Value = (Vec<Piece>, Vec<[u8; 4]>)> {
    (scene([90, 70], 24, 30), prop::collection::vec(any::<[u8; 4]>(), 1..60))
}

proptest! {
    #![proptest_config(super::cases(60))]

    #[test]
    fn gouraud_affine_any_scene_is_the_nearest_level_everywhere((pieces, colours) in painted(), kernel in super::kernel()) {
        let mut primitives = primitives(&pieces);
        paint(&mut primitives, &colours);
        let options = Options { pixels: Pixels::Argb8888, kernel, ..Options::default() };
        let mut screen = Screen::new(90, 70, &options);

        screen.draw(&primitives, &State { gouraud: true, ..State::default() });

        // Rounding to a level is off by 1/2 at most. Gradients and reference have 22 fraction bits: over the 2^16 pixels
        // to both sides of the guard band another (2^16 + 2^16 + 1) 2^-23 < 1/63.
        let tolerance = ratio(1, 2) + ratio(1, 63);
        let image = draw(90, 70, &primitives, DepthFormat::default(), DepthFunction::Less);
        let picture = screen.read();
        for (k, winner) in (0_i32..).zip(&image.winner) {
            let Some(winner) = winner else { continue };
            let exact = affine(&primitives[*winner as usize], k % 90, k / 90).expect("a winner has an area");
            let pixel = picture.colour[k as usize];
            let found = error(pixel, &exact);
            prop_assert!(found <= tolerance, "({}, {}): {:08x}, off by {}", k % 90, k / 90, pixel, found.to_f64().unwrap());
        }
    }

    #[test]
    fn gouraud_any_scene_order_of_vertices_and_kernel_give_the_same_bits(
        (pieces, colours) in painted(), order in 0_usize..6, kernel in super::kernel(),
    ) {
        let mut primitives = primitives(&pieces);
        paint(&mut primitives, &colours);
        let permuted: Vec<Primitive> = primitives.iter().map(|p| match p {
            Primitive::Triangle(v) => Primitive::Triangle(ORDERS[order].map(|k| v[k])),
            other => *other,
        }).collect();
        let draw = |primitives: &[Primitive], kernel: Kernel| {
            let options = Options { pixels: Pixels::Argb8888, kernel, ..Options::default() };
            let mut screen = Screen::new(90, 70, &options);
            screen.draw(primitives, &State { gouraud: true, ..State::default() });
            screen.read()
        };

        prop_assert!(draw(&permuted, kernel) == draw(&primitives, Kernel::Specification));
    }

    #[test]
    fn gouraud_perspective_any_triangle_is_within_a_level((v, w, colours, kernel) in projected()) {
        let triangle = [0, 1, 2].map(|k| v[k].coloured(colours[k]));
        let exact_w = w.map(|w| from_f64(f64::from(w)).expect("finite"));
        let options = Options { pixels: Pixels::Argb8888, kernel, ..Options::default() };
        let mut screen = Screen::new(64, 64, &options);
        let vertices = [0, 1, 2].map(|k| RawVertex {
            position: [triangle[k].x, triangle[k].y].map(|c| c as f32 / 256.0 * w[k]).into_iter().chain([w[k]])
                .collect::<Vec<_>>().try_into().expect("three"),
            colour: u32::from_le_bytes(triangle[k].colour),
        });

        let state = State { gouraud: true, perspective: true, camera: divided(), ..State::default() };
        screen.draw_raw(Topology::Triangles, &vertices, None, &state);

        // Rounding to a level is off by 1/2 at most; the planes are evaluated in f32 as long as that is good for a quarter
        // of a level, else in f64. x w is rounded to an f32, which moves no vertex to another u.
        let tolerance = ratio(3, 4);
        let image = draw(64, 64, &[Primitive::Triangle(triangle)], DepthFormat::default(), DepthFunction::Always);
        let picture = screen.read();
        for (k, winner) in (0_i32..).zip(&image.winner) {
            let pixel = picture.colour[k as usize];
            prop_assert_eq!(picture.depth[k as usize] != 0x00FF_FFFF, winner.is_some(), "coverage of {} {}", k % 64, k / 64);
            let Some(exact) = winner.and_then(|_| perspective(&triangle, &exact_w, k % 64, k / 64)) else { continue };
            let found = error(pixel, &exact);
            prop_assert!(found <= tolerance, "({}, {}): {:08x}, off by {}", k % 64, k / 64, pixel, found.to_f64().unwrap());
        }
    }

    #[test]
    fn gouraud_perspective_any_line_has_its_ends_colours_and_no_others((v, w, colours, kernel) in projected(), long in 0_u32..12) {
        // From under a u to the whole target, so that the pixels' centres often lie beyond an end.
        let near = |from: i32, to: i32| from + ((to - from) >> long);
        let ends = [v[0], Vertex { x: near(v[0].x, v[1].x), y: near(v[0].y, v[1].y), ..v[1] }];
        let line = [0, 1].map(|k| ends[k].coloured(colours[k]));
        let exact_w = [0, 1].map(|k| from_f64(f64::from(w[k])).expect("finite"));
        let options = Options { pixels: Pixels::Argb8888, kernel, ..Options::default() };
        let mut screen = Screen::new(64, 64, &options);
        let vertices = [0, 1].map(|k| RawVertex {
            position: [line[k].x as f32 / 256.0 * w[k], line[k].y as f32 / 256.0 * w[k], w[k]],
            colour: u32::from_le_bytes(line[k].colour),
        });

        let state = State { gouraud: true, perspective: true, camera: divided(), ..State::default() };
        screen.draw_raw(Topology::Lines, &vertices, None, &state);

        // As for triangles: the quotient of two f32 sums of two terms is good for far less than a quarter of a level.
        let tolerance = ratio(3, 4);
        let image = draw(64, 64, &[Primitive::Line(line)], DepthFormat::default(), DepthFunction::Always);
        let picture = screen.read();
        for (k, winner) in (0_i32..).zip(&image.winner) {
            let pixel = picture.colour[k as usize];
            prop_assert_eq!(picture.depth[k as usize] != 0x00FF_FFFF, winner.is_some(), "coverage of {} {}", k % 64, k / 64);
            let Some(screen_weights) = winner.and_then(|_| line_weights(&line, k % 64, k / 64)) else { continue };
            let parts = [0, 1].map(|n| &screen_weights[n] / &exact_w[n]);
            let sum = &parts[0] + &parts[1];
            let exact: ExactColour = [0, 1, 2, 3].map(|c| {
                (&parts[0] * integer(line[0].colour[c]) + &parts[1] * integer(line[1].colour[c])) / &sum
            });
            let found = error(pixel, &exact);
            prop_assert!(found <= tolerance, "({}, {}): {:08x}, off by {}", k % 64, k / 64, pixel, found.to_f64().unwrap());
        }
    }

    #[test]
    fn gouraud_any_scene_every_kernel_and_format_is_identical(
        (pieces, colours) in painted(), format in 0_usize..3, in_perspective in any::<bool>(), scissor in [0_u32..90, 0_u32..70, 0_u32..90, 0_u32..70],
    ) {
        let mut primitives = primitives(&pieces);
        paint(&mut primitives, &colours);
        let pixels = [Pixels::Xrgb8888, Pixels::Argb8888, Pixels::Rgb565][format];
        // An object matrix that makes w follow x and y, so that perspective has something to do.
        let mut eye_clip = IDENTITY;
        (eye_clip[3], eye_clip[7], eye_clip[15]) = (0.01, 0.02, 3.0);
        let camera = Camera { eye_clip, viewport: [3., 3., 1., 0., 0., 0.], ..Camera::default() };
        let state = State { gouraud: true, perspective: in_perspective, camera, ..State::default() };
        let drawn = Kernel::available().into_iter().map(|kernel| {
            let mut screen = Screen::new(90, 70, &Options { pixels, kernel, ..Options::default() });
            screen.draw(&primitives, &state);
            screen.draw(&primitives, &State { scissor: Some(scissor), camera: Camera::default(), ..state });
            (screen.read(), screen.counts())
        });
        let drawn: Vec<_> = drawn.collect();
        prop_assert!(drawn.iter().all(|other| *other == drawn[0]));
    }
}

/// Every order of three vertices.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// A triangle over 64 x 64 pixels, the w of its vertices, colours. One in three is a sliver that reaches far beyond.
fn projected() -> impl Strategy<Value = ([Vertex; 3], [f32; 3], [[u8; 4]; 3], Kernel)> {
    let vertex = (-4096_i32..20_480, -4096_i32..20_480).prop_map(|(x, y)| Vertex::at(x, y, 1 << 23));
    let plain = prop::array::uniform3(vertex);
    let ends = (0.0_f64..6.3, 30.0_f64..30_000.0, [-1.0_f64..1.0, -1.0..1.0], 1.0_f64..600.0);
    let sliver = ends.prop_map(|(angle, reach, [along, across], width)| {
        let at = |l: f64, c: f64| {
            let (sin, cos) = angle.sin_cos();
            let [x, y] = [(cos * l) * 256.0 - sin * c, (sin * l) * 256.0 + cos * c];
            Vertex::at(8192 + x as i32, 8192 + y as i32, 1 << 23)
        };
        [at(-reach, 0.0), at(reach, width * across), at(reach * along, -width)]
    });
    let w = (-23_i32..14).prop_map(|k| 2.0_f32.powf(k as f32 / 7.0));
    (prop_oneof![2 => plain, 1 => sliver], prop::array::uniform3(w), any::<[[u8; 4]; 3]>(), super::kernel())
}

/// Object coordinates are x w, y w in pixels, and w; depth is 1/2 everywhere.
fn divided() -> Camera {
    Camera {
        eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.],
        object_eye: IDENTITY,
        ..Camera::default()
    }
}
