//! The transform chain through the bus: matrices, viewport, snap, decal, clip, discards, indices.
//!
//! Expected vertices come from rationals ([`zga_tests::oracle::clip`]); the card works in f64. A vertex would have to lie
//! within 2^-20 u of a boundary between two u without being on it for the two to differ, which these seeds do not do.

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;
use zga_tests::harness::options::IDENTITY;
use zga_tests::harness::screen::raw;
use zga_tests::harness::{Camera, Counts, Options, Picture, Random, RawVertex, Screen, State, Topology};
use zga_tests::oracle::clip::{Homogeneous, snap, stored_depth};
use zga_tests::oracle::exact::from_f64;
use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

const SIZE: [u32; 2] = [80, 60];

fn exact(value: f32) -> BigRational {
    from_f64(value.into()).expect("finite")
}

fn rows(matrix: &[f32; 16]) -> [[f32; 4]; 4] {
    [0, 1, 2, 3].map(|r| [0, 1, 2, 3].map(|c| matrix[4 * r + c]))
}

/// Clip coordinates of an object vertex, through the decal or not.
fn clip_of(camera: &Camera, position: [f32; 3], decal: bool) -> [BigRational; 4] {
    let [x, y, z] = position;
    let vertex = Homogeneous::from_f32([x, y, z, 1.0]).expect("a number");
    let eye = vertex.transformed(&rows(&camera.object_eye)).expect("numbers");
    let eye = if decal { eye.transformed(&rows(&camera.decal)).expect("numbers") } else { eye };
    eye.transformed(&rows(&camera.eye_clip)).expect("numbers").0
}

/// The snapped vertex; `None` where a clip plane would have to be looked at.
fn snapped(camera: &Camera, position: [f32; 3], decal: bool, options: &Options) -> Option<Vertex> {
    let [x, y, z, w] = clip_of(camera, position, false);
    if !w.is_positive() || z.is_negative() || z > w {
        return None;
    }
    let viewport = camera.viewport.map(exact);
    let screen = |k: usize, c: &BigRational| c / &w * &viewport[k] + &viewport[3 + k];
    let depth = if decal {
        let [_, _, z, w] = clip_of(camera, position, true);
        (z / w).clamp(BigRational::zero(), BigRational::from_integer(1.into()))
    } else {
        z / &w
    };
    let z = stored_depth(&(depth * &viewport[2] + &viewport[5]), options.depth.bits);
    let u = |k: usize, c: &BigRational| snap(&screen(k, c), options.subpixel_bits).filter(|u| u.abs() < 8_000_000);
    Some(Vertex::at(u(0, &x)?, u(1, &y)?, z))
}

/// Numbers with few bits, so that exact ties are frequent.
fn number(reach: i32) -> impl Strategy<Value = f32> {
    (-reach * 8..=reach * 8, prop_oneof![Just(8.0_f32), Just(10.0), Just(12.25)]).prop_map(|(n, d)| n as f32 / d)
}

/// A camera over the target: any affine object matrix, w from depth or not, a viewport that may be mirrored.
fn camera() -> impl Strategy<Value = Camera> {
    let turn = prop::array::uniform9(number(2));
    let place = (number(3), number(3), 2_i32..60);
    (turn, place, any::<bool>(), any::<bool>(), any::<bool>()).prop_map(
        |(m, (x, y, z), perspective, mirror, reverse)| {
            let z = z as f32;
            let object_eye = [m[0], m[1], m[2], 0., m[3], m[4], m[5], 0., m[6], m[7], m[8], 0., x, y, z, 1.];
            // Near plane at 1, far plane at 101 (eye coordinates).
            let eye_clip = if perspective {
                [1.5, 0., 0., 0., 0., 2., 0., 0., 0., 0., 1.01, 1., 0., 0., -1.01, 0.]
            } else {
                [0.1, 0., 0., 0., 0., 0.1, 0., 0., 0., 0., 0.01, 0., 0., 0., -0.01, 1.]
            };
            let viewport = [
                40.,
                if mirror { -30. } else { 30. },
                if reverse { -1. } else { 1. },
                40.,
                30.25,
                f32::from(u8::from(reverse)),
            ];
            Camera { object_eye, eye_clip, viewport, ..Camera::default() }
        },
    )
}

fn triangle() -> impl Strategy<Value = [[f32; 3]; 3]> {
    prop::array::uniform3((number(6), number(6), number(6)).prop_map(|(x, y, z)| [x, y, z]))
}

fn vertices(triangles: &[[[f32; 3]; 3]], options: &Options) -> Vec<RawVertex> {
    let colours = (1..).map(|id| options.pixels.colour_of(id));
    triangles.iter().zip(colours).flat_map(|(t, colour)| t.map(|position| RawVertex { position, colour })).collect()
}

fn drawn(options: &Options, vertices: &[RawVertex], state: &State) -> (Picture, Counts) {
    let mut screen = Screen::new(SIZE[0], SIZE[1], options);
    screen.clear_counts();
    screen.draw_raw(Topology::Triangles, vertices, None, state);
    (screen.read(), screen.counts())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn transform_any_camera_equals_the_exact_chain(
        camera in camera(), triangles in prop::collection::vec(triangle(), 1..12),
        subpixel_bits in prop_oneof![Just(4_u32), Just(8)], bits in prop_oneof![Just(16_u32), Just(24)],
    ) {
        let options = Options { subpixel_bits, depth: DepthFormat { bits, fraction: 24 }, ..Options::default() };
        let inside = |t: &[[f32; 3]; 3]| t.map(|p| snapped(&camera, p, false, &options));
        let kept: Vec<_> = triangles.into_iter().filter(|t| inside(t).iter().all(Option::is_some)).collect();
        let expected: Vec<_> = kept.iter().map(|t| Primitive::Triangle(inside(t).map(|v| v.expect("inside")))).collect();

        let (picture, counts) = drawn(&options, &vertices(&kept, &options), &State { camera, ..State::default() });

        let found = picture.against(&draw(SIZE[0], SIZE[1], &expected, options.depth, DepthFunction::Less));
        prop_assert!(found.none(), "{}", found);
        prop_assert_eq!((counts.clipped, counts.primitives, counts.vertices), (0, kept.len() as u64, 3 * kept.len() as u64));
    }

    #[test]
    fn decal_any_displacement_moves_depth_alone(
        camera in camera(), triangles in prop::collection::vec(triangle(), 1..12), shift in prop::array::uniform3(number(1)),
    ) {
        let options = Options::default();
        let mut decal = IDENTITY;
        decal[12..15].copy_from_slice(&shift);
        let camera = Camera { decal, ..camera };
        let always = State { camera, ..State::with(DepthFunction::Always) };
        // Clipped triangles too: the pixels are the same bit for bit.
        let all = vertices(&triangles, &options);
        let plain = drawn(&options, &all, &always);
        let marked = drawn(&options, &all, &State { decal: true, ..always });
        prop_assert_eq!(&plain.0.colour, &marked.0.colour);
        let events = |c: Counts| [c.clipped, c.discarded, c.spans, c.reads, c.colours];
        prop_assert_eq!(events(plain.1), events(marked.1));

        // And the depth is that of the displaced vertex, as long as that is before the eye.
        let place = |t: &[[f32; 3]; 3]| t.map(|p| {
            let before = clip_of(&camera, p, true)[3].is_positive();
            snapped(&camera, p, true, &options).filter(|_| before)
        });
        let kept: Vec<_> = triangles.into_iter().filter(|t| place(t).iter().all(Option::is_some)).collect();
        let expected: Vec<_> = kept.iter().map(|t| Primitive::Triangle(place(t).map(|v| v.expect("inside")))).collect();
        let (picture, _) = drawn(&options, &vertices(&kept, &options), &State { decal: true, ..always });
        let found = picture.against(&draw(SIZE[0], SIZE[1], &expected, options.depth, DepthFunction::Always));
        prop_assert!(found.none(), "{}", found);
    }

    #[test]
    fn indexed_any_order_equals_unindexed(
        camera in camera(), pool in prop::collection::vec((number(6), number(6), number(6), any::<u32>()), 1..30),
        picks in prop::collection::vec(any::<prop::sample::Index>(), 0..60), kind in 0_usize..4, gouraud in any::<bool>(),
    ) {
        let topology = [Topology::Triangles, Topology::Lines, Topology::Points, Topology::LineStrip][kind];
        let pool: Vec<_> = pool.into_iter().map(|(x, y, z, colour)| RawVertex { position: [x, y, z], colour }).collect();
        let indices: Vec<u32> = picks.iter().map(|pick| pick.index(pool.len()) as u32).collect();
        let spelled: Vec<_> = indices.iter().map(|&k| pool[k as usize]).collect();
        let state = State { camera, gouraud, ..State::default() };
        let options = Options { vertex_bytes: 1 << 16, ..Options::default() };
        let inline = |screen: &mut Screen| screen.draw_raw(topology, &spelled, None, &state);
        let inline_indexed = |screen: &mut Screen| screen.draw_raw(topology, &pool, Some(&indices), &state);
        let buffer = |screen: &mut Screen| screen.draw_buffer(topology, &spelled, None, &state);
        let buffer_indexed = |screen: &mut Screen| screen.draw_buffer(topology, &pool, Some(&indices), &state);
        let ways: [&dyn Fn(&mut Screen); 4] = [&inline, &inline_indexed, &buffer, &buffer_indexed];
        let found = ways.map(|way| {
            let mut screen = Screen::new(SIZE[0], SIZE[1], &options);
            screen.clear_counts();
            way(&mut screen);
            let (picture, counts) = (screen.read(), screen.counts());
            // An indexed draw transforms each vertex once: its vertices and clocks are others.
            (picture, Counts { vertices: 0, clocks: [0; 3], ..counts })
        });
        prop_assert!(found.iter().all(|other| *other == found[0]));
    }
}

#[test]
fn depth_one_half_at_any_w_is_stored_as_the_rule_says() {
    // z / w is 1/2 exactly; z * (1 / w) is less for w = 49 and many others. floor(2^23 - 1/2 + 1/2) = 2^23.
    let options = Options::default();
    for w in (1..400).map(|w| w as f32) {
        let camera =
            Camera { eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.], ..Camera::default() };
        let corners = [[0.0, 0.0], [200.0, 0.0], [0.0, 200.0]].map(|[x, y]| [x * w, y * w, w]);
        let (picture, _) = drawn(&options, &vertices(&[corners], &options), &State { camera, ..State::default() });
        assert_eq!(picture.at(5, 5).1, 1 << 23, "w = {w}");
    }
}

#[test]
fn position_of_a_tie_at_any_w_goes_to_the_even_u() {
    // x / w is half a u beyond the centre of pixel 10, which is even: a left edge there covers the pixel, a right one not.
    let options = Options::default();
    for w in (1..400).map(|w| w as f32) {
        let camera =
            Camera { eye_clip: [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.], ..Camera::default() };
        let x = (10.0 * 256.0 + 128.5) / 256.0;
        for (other, expected) in [(900.0, [0, 1, 1]), (-900.0, [1, 0, 0])] {
            let corners = [[x, -500.0], [other, 30.0], [x, 500.0]].map(|[x, y]| [x * w, y * w, w]);
            let (picture, _) = drawn(&options, &vertices(&[corners], &options), &State { camera, ..State::default() });
            let found = [9, 10, 11].map(|i| picture.at(i, 30).0 & 0x00FF_FFFF);
            assert_eq!(found, expected, "w = {w}");
        }
    }
}

/// Two triangles over the target whose depth goes from -1/2 at the left to 3/2 at column 64.
fn slope() -> Vec<RawVertex> {
    let at = |x: f32, y: f32| RawVertex { position: [x, y, (x - 16.0) / 32.0], colour: u32::MAX };
    vec![at(0.0, 0.0), at(64.0, 0.0), at(0.0, 60.0), at(64.0, 0.0), at(64.0, 60.0), at(0.0, 60.0)]
}

#[test]
fn clip_near_and_far_leave_the_columns_between() {
    let (picture, counts) = drawn(&Options::default(), &slope(), &State::with(DepthFunction::Always));

    let column = |i: u32| (0..60).filter(|&j| picture.at(i, j).0 & 0x00FF_FFFF != 0).count();
    let columns: Vec<usize> = (0..80).map(column).collect();
    let expected: Vec<usize> = (0..80).map(|i| if (16..48).contains(&i) { 60 } else { 0 }).collect();
    assert_eq!(columns, expected);
    assert_eq!((counts.clipped, counts.discarded), (2, 0));
    // Cut vertices have their depth rounded to a step, pixels theirs: 1/2 + 1/2 step.
    for i in 16..48 {
        let exact = (f64::from(i) + 0.5 - 16.0) / 32.0 * f64::from((1 << 24) - 1);
        let worst = (0..60).map(|j| (f64::from(picture.at(i, j).1) - exact).abs()).fold(0.0, f64::max);
        assert!(worst <= 1.0, "column {i}: {worst} steps");
    }
}

#[test]
fn clip_reversed_depth_is_mirrored() {
    let reversed = Camera { viewport: [1., 1., -1., 0., 0., 1.], ..Camera::default() };
    let state = State::with(DepthFunction::Always);
    let plain = drawn(&Options::default(), &slope(), &state).0;

    let mirrored = drawn(&Options::default(), &slope(), &State { camera: reversed, ..state }).0;

    assert_eq!(plain.colour, mirrored.colour);
    // Each is within a step of the exact depth.
    let sums = (0..60).flat_map(|j| (16..48).map(move |i| (i, j))).map(|(i, j)| plain.at(i, j).1 + mirrored.at(i, j).1);
    let worst = sums.map(|sum| sum.abs_diff((1 << 24) - 1)).max();
    assert!(worst <= Some(2), "{worst:?}");
}

#[test]
fn clip_fan_to_huge_corners_covers_every_pixel_once() {
    // Four triangles round a point of the target: each of the four edges between them is cut in both.
    let mut random = Random::new(3);
    let mut screen = Screen::new(SIZE[0], SIZE[1], &Options::default());
    for reach in [1e5, 1e7, 1e12, 1e20, 1e30, 3e38_f32] {
        for turn in 0..40 {
            let angle = f64::from(turn) * 0.04;
            let hub = [random.between(0.0, 80.0) as f32, random.between(0.0, 60.0) as f32, 0.5];
            let corner = |k: i32| {
                let (sin, cos) = (angle + f64::from(k) * std::f64::consts::FRAC_PI_2).sin_cos();
                [cos as f32 * reach, sin as f32 * reach, 0.5]
            };
            // Every other triangle names the shared edge the other way round.
            let fan = [0, 1, 2, 3]
                .map(|k| if k % 2 == 0 { [hub, corner(k), corner(k + 1)] } else { [corner(k), corner(k + 1), hub] });
            screen.clear();
            screen.clear_counts();
            screen.draw_raw(
                Topology::Triangles,
                &vertices(&fan, &Options::default()),
                None,
                &State::with(DepthFunction::Always),
            );
            let (drawn, counts) = (screen.read().drawn(), screen.counts());
            assert_eq!(
                (drawn, counts.reads, counts.clipped),
                (4800, 4800, 4),
                "reach {reach:e}, turn {turn}, hub {hub:?}"
            );
        }
    }
}

#[test]
fn clip_everything_outside_one_plane_is_discarded_and_counted() {
    let far = 40_000.0;
    let outside: [[[f32; 3]; 3]; 6] = [
        [[1., 1., -0.1], [50., 1., -0.2], [1., 50., -0.1]],
        [[1., 1., 1.1], [50., 1., 1.2], [1., 50., 1.1]],
        [[far, 1., 0.5], [far + 9., 1., 0.5], [far, 50., 0.5]],
        [[-far, 1., 0.5], [-far - 9., 1., 0.5], [-far, 50., 0.5]],
        [[1., far, 0.5], [50., far, 0.5], [1., far + 9., 0.5]],
        [[1., -far, 0.5], [50., -far, 0.5], [1., -far - 9., 0.5]],
    ];
    for corners in outside {
        let vertices = vertices(&[corners], &Options::default());
        let mut screen = Screen::new(SIZE[0], SIZE[1], &Options::default());
        for (topology, primitives) in [(Topology::Triangles, 1), (Topology::LineStrip, 2), (Topology::Points, 3)] {
            screen.clear_counts();
            screen.draw_raw(topology, &vertices, None, &State::default());
            let counts = screen.counts();
            let found = (counts.primitives, counts.discarded, counts.clipped, counts.reads);
            assert_eq!(found, (primitives, primitives, 0, 0), "{topology:?} {corners:?}");
        }
        assert_eq!(screen.read().drawn(), 0);
    }
}

#[test]
fn discard_nan_takes_its_own_primitive_alone() {
    let mut screen = Screen::new(SIZE[0], SIZE[1], &Options::default());
    let mut random = Random::new(1);
    let scene: Vec<Primitive> = (0..30)
        .map(|_| {
            let mut at = || Vertex::at(random.int(0, 20_000), random.int(0, 15_000), random.depth((1 << 24) - 1));
            Primitive::Triangle([at(), at(), at()])
        })
        .collect();
    let colour = |k: usize| screen.options().pixels.colour_of(k as u32 / 3 + 1);
    let mut vertices: Vec<RawVertex> =
        scene.iter().flat_map(|p| p.vertices().to_vec()).enumerate().map(|(k, v)| raw(&v, 24, colour(k))).collect();
    let spoilt = [4, 17, 22];
    for (place, triangle) in spoilt.into_iter().enumerate() {
        vertices[3 * triangle + place].position[place] = f32::NAN;
    }
    // What is left out keeps its number: a triangle without area draws nothing.
    let kept: Vec<Primitive> = scene
        .iter()
        .enumerate()
        .map(|(k, p)| if spoilt.contains(&k) { Primitive::Triangle([Vertex::default(); 3]) } else { *p })
        .collect();
    screen.clear_counts();

    screen.draw_raw(Topology::Triangles, &vertices, None, &State::default());

    let found = screen.read().against(&draw(SIZE[0], SIZE[1], &kept, DepthFormat::default(), DepthFunction::Less));
    assert!(found.none(), "{found}");
    assert_eq!(screen.counts().discarded, 3);
}

#[test]
fn matrices_of_any_bits_end_and_stay_inside_the_target() {
    let mut screen = Screen::new(SIZE[0], SIZE[1], &Options { threads: 2, ..Options::default() });
    let mut random = Random::new(2);
    let special =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE, 1e-40, 0.0, -0.0, 1.0];
    for _ in 0..300 {
        let mut word = || {
            let any = f32::from_bits(random.bits() as u32);
            let plain = random.between(-3.0, 3.0) as f32;
            [any, special[random.range(0, 9) as usize], plain, plain][random.range(0, 3) as usize]
        };
        let mut matrix = || [0; 16].map(|_| word());
        let (object_eye, decal, eye_clip) = (matrix(), matrix(), matrix());
        let viewport = [0; 6].map(|_| word());
        let camera = Camera { object_eye, decal, eye_clip, viewport };
        let vertices: Vec<RawVertex> =
            (0..60).map(|k| RawVertex { position: [word(), word(), word()], colour: k * 0x0404_0404 }).collect();
        let state =
            State { camera, decal: random.range(0, 1) == 0, gouraud: true, perspective: true, ..State::default() };
        for topology in [Topology::Triangles, Topology::Lines, Topology::Points, Topology::LineStrip] {
            screen.draw_raw(topology, &vertices, None, &state);
        }
    }
    assert_eq!(screen.read().strays, 0);
    assert_eq!(screen.counts().primitives, 300 * (20 + 30 + 60 + 59));
}
