//! Cases 8 and 9: triangles that leave the guard band.

use super::triangle;
use crate::hard::{Row, Tally, compare_on, fragments};
use crate::harness::{Camera, Options, Random, RawVertex, Screen, State, Topology};
use crate::oracle::clip::{Homogeneous, View, clip};
use crate::oracle::exact::integer;
use crate::oracle::{DepthFunction, Primitive, Vertex};

/// Pixels of a square target that a triangle in normalised coordinates shows on the card and not in the exact image, or
/// the other way round; and stray words.
fn wrong_pixels(screen: &mut Screen, size: u32, corners: [[f32; 2]; 3]) -> usize {
    let half = size as f32 / 2.0;
    let camera = Camera { viewport: [half, half, 1.0, half, half, 0.0], ..Camera::default() };
    screen.clear();
    let vertices = corners.map(|[x, y]| RawVertex { position: [x, y, 0.5], colour: u32::MAX });
    screen.draw_raw(Topology::Triangles, &vertices, None, &State { camera, ..State::default() });
    let picture = screen.read();

    let exact =
        corners.map(|[x, y]| Homogeneous::from_f32([x, y, 0.5, 1.0]).unwrap_or(Homogeneous(Default::default())));
    // A guard band far beyond the card's: the exact image is not cut.
    let view = View::normalised(size, size).guarded([integer(0), integer(0)], &integer(1_u64 << 40));
    let mut expected = vec![false; (size * size) as usize];
    clip(&exact, &view).for_each_pixel(size, size, |i, j| expected[(j * size + i) as usize] = true);
    let drawn = picture.colour.iter().map(|&pixel| pixel & 0x00FF_FFFF != 0);
    drawn.zip(expected).filter(|(card, exact)| card != exact).count() + picture.strays
}

/// Case 8.
#[must_use]
pub fn beyond_the_guard_band() -> Row {
    let (size, far) = (128, 1.0e5_f32);
    let mut screen = Screen::new(size, size, &Options::default());
    let mut tally = Tally::default();
    // Edges along axes and diagonals stay exact when they are cut: every pixel must be right. k / 64 is a pixel.
    for k in [-64, -63, -20, -1, 0, 1, 5, 33, 63, 64] {
        // Halves of a pixel put the edge through centres.
        for shift in [k as f32 / 64.0, (k as f32 + 0.5) / 64.0] {
            for side in [far, -far] {
                let shapes = [
                    [[shift, -far], [shift, far], [side, 0.0]],
                    [[-far, shift], [far, shift], [0.0, side]],
                    [[-far + shift, -far], [far + shift, far], [side, -side]],
                    [[-far + shift, far], [far + shift, -far], [side, side]],
                ];
                for corners in shapes {
                    let wrong = wrong_pixels(&mut screen, size, corners);
                    tally.pictures += 1;
                    tally.pixels += (size * size) as usize;
                    tally.note(wrong, || format!("{wrong} pixels of {corners:?}"));
                }
            }
        }
    }
    let clipped = screen.counts().clipped;

    // One corner at the edge of the guard band, 1 u inside, on it, 1 u beyond: the same pixels as the exact triangle.
    let mut screen = Screen::new(64, 48, &Options::default());
    let (mut random, middle) = (Random::new(8), [64 * 128, 48 * 128]);
    for _ in 0..60 {
        let mut near = || (random.int(-3000, 20_000), random.int(-3000, 16_000));
        let (a, b, c) = (near(), near(), near());
        for (reach, axis) in
            [-1, 1].into_iter().flat_map(|s| [-1, 0, 1].map(|d| s * ((1 << 23) + d))).flat_map(|r| [(r, 0), (r, 1)])
        {
            let corner = if axis == 0 { (middle[0] + reach, c.1) } else { (c.0, middle[1] + reach) };
            tally.add(&compare_on(&mut screen, &[triangle([a, b, corner], 5)], DepthFunction::Less));
        }
    }
    let at_edge = screen.counts().clipped;
    Row {
        case: 8,
        name: "rasteriser::beyond_the_guard_band",
        construction: "160 triangles with corners at NDC +-1e5 whose edges along axes and diagonals cross the target; 720 with a \
                       corner at the guard band's edge -1, 0, +1 u",
        property: "the same pixels as the exact triangle inside, none outside",
        measured: format!("{tally}; {clipped} and {at_edge} clipped"),
        passed: tally.wrong == 0 && clipped == 160 && at_edge == 240,
    }
}

/// Case 9.
#[must_use]
pub fn shared_edge_clipped_on_one_side() -> Row {
    let size = 96;
    let mut screen = Screen::new(size, size, &Options::default());
    let (mut random, mut tally) = (Random::new(9), Tally::default());
    let pixels = (size * size) as usize;
    for _ in 0..300 {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let (along, across) = ([angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]);
        // A pixel near the middle of the target, and from there so many pixels along and across the edge.
        let start = [0, 1].map(|_| random.between(28.0, 68.0));
        let mut at = |l: [f64; 2], c: [f64; 2], whole: bool| {
            let (l, c) = (random.between(l[0], l[1]), random.between(c[0], c[1]));
            let u = |axis: usize| ((start[axis] + along[axis] * l + across[axis] * c) * 256.0) as i32;
            // Far corners stand on whole pixels: an f32 has no u there.
            let u = |axis: usize| if whole { u(axis) & !255 } else { u(axis) };
            Vertex::at(u(0), u(1), 5)
        };
        let a = at([400.0, 15_000.0], [-0.2, 0.2], false);
        let b = at([-15_000.0, -400.0], [-0.2, 0.2], false);
        let inside = at([-300.0, 300.0], [500.0, 20_000.0], false);
        let beyond = at([-9e5, 9e5], [-4e6, -2e6], true);
        let scene = [Primitive::Triangle([a, b, inside]), Primitive::Triangle([b, a, beyond])];
        let (drawn, fragments) = fragments(&mut screen, &scene);
        tally.pictures += 1;
        tally.pixels += pixels;
        tally.note(pixels - drawn + (fragments as usize).abs_diff(drawn), || {
            format!("{fragments} fragments on {drawn} of {pixels} pixels: {scene:?}")
        });
        let clipped = screen.counts().clipped;
        tally.expect(clipped == 1, || format!("{clipped} clipped"));
    }
    // The far corner behind the eye: w = -1 on one side only, cut at the near plane.
    for _ in 0..300 {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let mut at = |l: f64, c: f64, w: f32| {
            let mut place = |axis: usize| {
                let (along, across) = ([angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]);
                ((48.0 + along[axis] * l + across[axis] * c) as f32 + random.between(-5.0, 5.0) as f32) * w
            };
            [place(0), place(1), w]
        };
        let (a, b, inside, behind) =
            (at(900.0, 0.0, 1.0), at(-900.0, 0.0, 1.0), at(9.0, 5000.0, 1.0), at(9.0, 700.0, -1.0));
        screen.clear();
        screen.clear_counts();
        let state = State { camera: super::eye::divided(), ..State::with(DepthFunction::Always) };
        let vertices = [a, b, inside, b, a, behind].map(|position| RawVertex { position, colour: u32::MAX });
        screen.draw_raw(Topology::Triangles, &vertices, None, &state);
        let (drawn, fragments) = (screen.read().drawn(), screen.counts().reads as usize);
        tally.pictures += 1;
        tally.pixels += pixels;
        tally.note(pixels - drawn + fragments.abs_diff(drawn), || {
            format!("{fragments} fragments, {drawn} pixels: {vertices:?}")
        });
    }
    Row {
        case: 9,
        name: "rasteriser::shared_edge_clipped_on_one_side",
        construction: "300 pairs of triangles over the whole target whose shared edge crosses it, one with its third corner \
                       2e6 to 4e6 px away; 300 with it behind the eye",
        property: "every pixel exactly once",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}
