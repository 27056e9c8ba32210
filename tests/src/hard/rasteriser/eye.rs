//! Cases 4, 10, 11, 14: perspective, the eye, and numbers that are none.

use super::triangle;
use crate::hard::{Row, Tally, compare_on};
use crate::harness::options::IDENTITY;
use crate::harness::{Camera, Options, Random, RawVertex, Screen, State, Topology};
use crate::oracle::DepthFunction;
use crate::oracle::clip::{ExactPolygon, Homogeneous, View, clip};
use crate::oracle::exact::{integer, ratio};
use crate::oracle::raster::area::ExactPoint;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

/// Object coordinates are x w and y w in pixels, and w; depth is 1/2 everywhere, the near plane goes through the eye.
pub(super) fn divided() -> Camera {
    let eye_clip = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.5, 1., 0., 0., 0., 0.];
    Camera { eye_clip, ..Camera::default() }
}

/// The same with depth 1 - 2^-10 / w: the near plane is at w = 2^-10.
fn divided_with_a_near_plane() -> Camera {
    let eye_clip = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 1., 0., 0., -1.0 / 1024.0, 0.];
    Camera { eye_clip, ..Camera::default() }
}

/// Case 4.
#[must_use]
pub fn rotated_quads_in_perspective() -> Row {
    let size = [100, 80];
    let mut screen = Screen::new(size[0], size[1], &Options::default());
    let (mut random, mut tally, all) = (Random::new(4), Tally::default(), 8000);
    let state = State { camera: divided(), ..State::with(DepthFunction::Always) };
    for number in 0..400 {
        let full = number % 2 == 0;
        let angle = random.between(0.0, std::f64::consts::TAU);
        let reach = if full { random.between(95.0, 400.0) } else { random.between(1.0, 70.0) };
        // 1 / w is affine on the screen; all four lie in 1/4 ..= 10.
        let inverse = loop {
            let [a, b, d] = [0; 3].map(|_| 1.0 / random.between(0.1, 4.0));
            let c = b + d - a;
            if (0.25..=10.0).contains(&c) {
                break [a, b, c, d];
            }
        };
        let corner = |k: usize| {
            let turn = angle + k as f64 * std::f64::consts::FRAC_PI_2;
            let w = 1.0 / inverse[k];
            let position = [(50.0 + reach * turn.cos()) * w, (40.0 + reach * turn.sin()) * w, w];
            RawVertex { position: position.map(|c| c as f32), colour: u32::MAX }
        };
        screen.clear();
        screen.clear_counts();
        screen.draw_raw(Topology::Triangles, &[0, 1, 2, 0, 2, 3].map(corner), None, &state);
        let (drawn, fragments) = (screen.read().drawn(), screen.counts().reads as usize);
        tally.pictures += 1;
        tally.pixels += all;
        tally.note(fragments.abs_diff(drawn), || format!("quad {number}: {fragments} fragments on {drawn} pixels"));
        tally.note(if full { all - drawn } else { 0 }, || format!("quad {number}: {drawn} pixels of the viewport"));
        tally.expect(drawn > 0, || format!("quad {number} draws nothing"));
    }
    Row {
        case: 4,
        name: "rasteriser::rotated_quads_in_perspective",
        construction: "400 rotated quads of two triangles with w in 0.1 ..= 4, half of them larger than the viewport",
        property: "every sample at most once; those larger than the viewport every sample exactly once",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// The square of the distance from a point to the nearest edge, in the unit of the outline.
fn distance_squared(outline: &[ExactPoint], point: &ExactPoint) -> Option<BigRational> {
    let edges = (0..outline.len()).map(|k| (&outline[k], &outline[(k + 1) % outline.len()]));
    let squared = |from: &ExactPoint, to: &ExactPoint| {
        let along = [0, 1].map(|k| &to[k] - &from[k]);
        let offset = [0, 1].map(|k| &point[k] - &from[k]);
        let dot = |a: &ExactPoint, b: &ExactPoint| &a[0] * &b[0] + &a[1] * &b[1];
        let length = dot(&along, &along);
        let t = if length.is_zero() { BigRational::zero() } else { dot(&offset, &along) / length };
        let t = t.clamp(integer(0), integer(1));
        let rest = [0, 1].map(|k| &offset[k] - &along[k] * &t);
        dot(&rest, &rest)
    };
    edges.map(|(from, to)| squared(from, to)).min()
}

/// Compares a clipped triangle with its exact image: pixels on the wrong side of an edge that is farther than 1 u from
/// their centre are wrong. The largest such distance, in u, goes to `worst`.
fn judge(
    screen: &mut Screen,
    camera: Camera,
    corners: [[f32; 3]; 3],
    size: u32,
    tally: &mut Tally,
    worst: &mut f64,
) -> usize {
    screen.clear();
    let vertices = corners.map(|position| RawVertex { position, colour: u32::MAX });
    screen.draw_raw(Topology::Triangles, &vertices, None, &State { camera, ..State::with(DepthFunction::Always) });
    let picture = screen.read();
    let matrix = [0, 1, 2, 3].map(|r| [0, 1, 2, 3].map(|c| camera.eye_clip[4 * r + c]));
    let homogeneous = |[x, y, z]: [f32; 3]| Homogeneous::from_f32([x, y, z, 1.0]).and_then(|v| v.transformed(&matrix));
    let exact = corners.map(|corner| homogeneous(corner).unwrap_or(Homogeneous(Default::default())));
    let middle = || ratio(size.into(), 2);
    let view = View { far: true, ..View::pixels().guarded([middle(), middle()], &integer(32_768)) };
    let polygon: ExactPolygon = clip(&exact, &view);
    let mut expected = vec![false; (size * size) as usize];
    polygon.for_each_pixel(size, size, |i, j| expected[(j * size + i) as usize] = true);
    let outline = polygon.outline();
    tally.pictures += 1;
    tally.pixels += expected.len();
    tally.note(picture.strays, || "stray words".into());
    for (k, (&pixel, &exact)) in (0..).zip(picture.colour.iter().zip(&expected)) {
        if (pixel & 0x00FF_FFFF != 0) != exact {
            let point = [k % size, k / size].map(|c: u32| integer(c) + ratio(1, 2));
            let u = distance_squared(&outline, &point)
                .map_or(f64::INFINITY, |d| (d * integer(65_536)).to_f64().unwrap_or(f64::INFINITY));
            *worst = worst.max(u.sqrt());
            tally.expect(u <= 1.0, || format!("pixel {} {} is {} u off: {corners:?}", k % size, k / size, u.sqrt()));
        }
    }
    expected.iter().filter(|&&e| e).count()
}

/// Case 10.
#[must_use]
pub fn vertices_at_and_behind_the_eye() -> Row {
    let size = 96;
    let mut screen = Screen::new(size, size, &Options::default());
    let (mut random, mut tally, mut worst, mut covered) = (Random::new(10), Tally::default(), 0.0, 0);
    for third in [2.0_f32.powi(-20), 0.0, -1.0] {
        for number in 0..200 {
            let mut corner = |w: f32| [random.between(-150.0, 250.0) as f32, random.between(-150.0, 250.0) as f32, w];
            let mut corners = [corner(1.0), corner(1.0), corner(third)];
            corners.rotate_left(number % 3);
            let camera = if number % 2 == 0 { divided() } else { divided_with_a_near_plane() };
            covered += judge(&mut screen, camera, corners, size, &mut tally, &mut worst);
        }
    }
    Row {
        case: 10,
        name: "rasteriser::vertices_at_and_behind_the_eye",
        construction: "600 triangles with w = 1, 1 and 2^-20, 0 or -1, near plane through the eye and at w = 2^-10",
        property: "finite; edges within 1 u of the exact homogeneous clip",
        measured: format!(
            "{tally}; {covered} pixels covered; a wrong pixel's centre is at most {worst:.4} u from the exact edge"
        ),
        passed: tally.wrong == 0 && covered > 0 && worst <= 1.0,
    }
}

/// Case 11.
#[must_use]
pub fn numbers_that_are_none() -> Row {
    let mut screen = Screen::new(32, 32, &Options::default());
    let mut tally = Tally::default();
    let good = [[3.0, 4.0, 0.5], [25.0, 9.0, 0.25], [8.0, 27.0, 0.75]];
    let mut drawn = |place: usize, number: f32, camera: Camera| {
        let mut corners = good;
        corners[place / 3][place % 3] = number;
        screen.clear();
        screen.clear_counts();
        let vertices = corners.map(|position| RawVertex { position, colour: u32::MAX });
        screen.draw_raw(Topology::Triangles, &vertices, None, &State { camera, ..State::default() });
        (screen.read(), screen.counts())
    };
    let quarter_turn =
        Camera { object_eye: [0., 1., 0., 0., 1., 0., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.], ..Camera::default() };
    let nans = [f32::NAN, -f32::NAN, f32::from_bits(0x7F80_0001), f32::from_bits(0xFFFF_FFFF)];
    let least = f32::from_bits(1);
    let large = f32::from_bits(0x007F_FFFF);
    for camera in [Camera::default(), quarter_turn] {
        for place in 0..9 {
            tally.pictures += 9;
            for nan in nans {
                let (picture, counts) = drawn(place, nan, camera);
                let found = (picture.drawn(), counts.discarded, counts.primitives, counts.reads);
                tally.expect(found == (0, 1, 1, 0), || format!("NaN at {place}: drawn, discarded, ...: {found:?}"));
            }
            let largest = [f32::MAX, f32::MIN].map(|number| drawn(place, number, camera));
            let infinite = [f32::INFINITY, f32::NEG_INFINITY].map(|number| drawn(place, number, camera));
            tally.expect(largest == infinite, || format!("infinities at {place} differ from the largest numbers"));
            let zero = drawn(place, 0.0, camera);
            for tiny in [least, -least, large, -large, -0.0] {
                tally.expect(drawn(place, tiny, camera) == zero, || format!("{tiny:e} at {place} differs from 0"));
            }
        }
    }
    // An infinity is cut at the guard band: what is left is drawn.
    let (picture, _) = drawn(3, f32::INFINITY, Camera::default());
    tally.expect(picture.drawn() > 50, || "an infinite corner leaves nothing".into());
    let scene = [triangle([(0, 0), (8192, 0), (0, 8192)], 5)];
    tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
    Row {
        case: 11,
        name: "rasteriser::numbers_that_are_none",
        construction: "NaN, +-Inf and denormals in each of the nine coordinates of a triangle, two cameras",
        property: "NaN discards the primitive and is counted; infinities draw as the largest numbers; denormals as 0",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 14.
#[must_use]
pub fn coordinates_near_the_integer_minimum() -> Row {
    // Pixels whose u are at or next to the least i32; the least i32 itself as pixels; the least i64.
    let least = -8_388_608.0_f32;
    let ends = [
        least,
        least.next_up(),
        least.next_down(),
        -least,
        (-least).next_down(),
        -2_147_483_648.0,
        -2_147_483_520.0,
        2_147_483_648.0,
        -9.223_372e18,
        9.223_372e18,
        -32_752.0,
        32_784.0,
        0.0,
        31.5,
    ];
    let mut screen = Screen::new(32, 32, &Options { threads: 2, ..Options::default() });
    let (mut random, mut tally, mut worst) = (Random::new(14), Tally::default(), 0.0);
    for topology in [Topology::Triangles, Topology::Lines, Topology::Points, Topology::LineStrip] {
        let mut pick = || ends[random.range(0, ends.len() as i64 - 1) as usize];
        let vertices: Vec<RawVertex> =
            (0..9000).map(|k| RawVertex { position: [pick(), pick(), 0.5], colour: k }).collect();
        screen.draw_raw(topology, &vertices, None, &State { gouraud: true, ..State::default() });
        screen.flush();
    }
    let strays = screen.read().strays;
    tally.note(strays, || format!("{strays} stray words"));
    // Triangles among them against the exact clip; w = 1 under the identity.
    for _ in 0..200 {
        let mut pick = || ends[random.range(0, ends.len() as i64 - 1) as usize];
        let corners = [[pick(), pick(), 0.5], [pick(), pick(), 0.5], [pick(), pick(), 0.5]];
        let camera = Camera { eye_clip: IDENTITY, ..Camera::default() };
        judge(&mut screen, camera, corners, 32, &mut tally, &mut worst);
    }
    let scene = [triangle([(0, 0), (8192, 0), (0, 8192)], 5)];
    tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
    Row {
        case: 14,
        name: "rasteriser::coordinates_near_the_integer_minimum",
        construction: "triangles, lines, points and strips with coordinates at and next to the least i32 in u, in pixels, and the \
                       least i64; overflow checks on",
        property: "ends, no overflow; triangles within 1 u of the exact clip; a triangle afterwards equals the oracle",
        measured: format!("{tally}; a wrong pixel's centre is at most {worst:.4} u from the exact edge"),
        passed: tally.wrong == 0 && worst <= 1.0,
    }
}
