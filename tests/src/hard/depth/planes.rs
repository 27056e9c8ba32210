//! Cases 15 to 18: single planes.

use super::formats;
use crate::hard::{Row, Tally, compare_on};
use crate::harness::depth::survivor;
use crate::harness::{Options, Random, Screen, State};
use crate::oracle::depth::{PrescribedDepth, TrueDepth};
use crate::oracle::raster::covers;
use crate::oracle::{DepthFunction, Primitive, Vertex};

const WIDEST: i32 = 16_384;

/// Two triangles over `width` x 8 pixels with one depth at the left and one at the right.
fn ramp(width: i32, left: u32, right: u32) -> [Primitive; 2] {
    let at = |x: i32, y: i32| Vertex::at(x * 256, y * 256, if x == 0 { left } else { right });
    [
        Primitive::Triangle([at(0, 0), at(width, 0), at(0, 8)]),
        Primitive::Triangle([at(0, 8), at(width, 0), at(width, 8)]),
    ]
}

/// Case 15.
#[must_use]
pub fn flat_across_the_widest_target() -> Row {
    let (mut random, mut tally) = (Random::new(15), Tally::default());
    for format in formats() {
        let mut screen = Screen::new(WIDEST as u32, 8, &Options { depth: format, ..Options::default() });
        let greatest = format.greatest();
        for z in [0, 1, greatest / 2, greatest - 1, greatest, random.depth(greatest)].map(|z| survivor(z, format.bits))
        {
            screen.clear();
            screen.draw_ids(&ramp(WIDEST, z, z), &State::with(DepthFunction::Always));
            let picture = screen.read();
            let wrong =
                picture.depth.iter().filter(|&&found| found != z).count() + WIDEST as usize * 8 - picture.drawn();
            tally.pictures += 1;
            tally.pixels += picture.depth.len();
            tally.note(wrong, || format!("{format:?}, z {z}: {wrong} pixels"));
        }
    }
    Row {
        case: 15,
        name: "depth::flat_across_the_widest_target",
        construction: "two triangles of one depth over a strip of 16384 x 8, 6 depths, every depth format",
        property: "every pixel has that depth",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 16.
#[must_use]
pub fn whole_range_across_the_target() -> Row {
    let (mut tally, mut drifts) = (Tally::default(), Vec::new());
    for format in formats() {
        let mut screen = Screen::new(WIDEST as u32, 8, &Options { depth: format, ..Options::default() });
        for width in [4096, WIDEST] {
            let scene = ramp(width, 0, format.greatest());
            tally.add(&compare_on(&mut screen, &scene, DepthFunction::Always));
            let picture = screen.read();
            let planes = scene.map(|p| TrueDepth::new(&p).zip(PrescribedDepth::new(&p, format)));
            let mut worst = 0.0_f64;
            for (k, winner) in (0..).zip(picture.winners()) {
                let Some(Some((exact, card))) = winner.map(|w| planes[w as usize]) else { continue };
                let (i, j) = (k % WIDEST, k / WIDEST);
                let exact = exact.at(i, j);
                // |z - exact| <= 1/2 + (|i| + |j| + 1) / 2^(F+1), both sides times 2^(F+1) d.
                let d = exact.denominator();
                let error = (i128::from(picture.depth[k as usize]) * d - exact.numerator()).abs();
                let steps = i128::from((i64::from(i) - card.anchor_x).abs() + (i64::from(j) - card.anchor_y).abs() + 1);
                worst = worst.max(error as f64 / d as f64);
                let holds = error << (format.fraction + 1) <= d * ((1 << format.fraction) + steps);
                tally.expect(holds, || format!("{format:?} at {i}, {j}: {error} / {d} steps off"));
            }
            drifts.push(format!("{}.{} {width}: {worst:.4}", format.bits, format.fraction));
        }
    }
    Row {
        case: 16,
        name: "depth::whole_range_across_the_target",
        construction: "depth 0 to the maximum across 4096 and 16384 px, every depth format; strip of 16384 x 8",
        property: "error <= 1/2 LSB + (|i| + |j| + 1) 2^-(F+1) LSB from the anchor; equal to the oracle",
        measured: format!("{tally}; largest error in LSB (n.F width): {}", drifts.join(", ")),
        passed: tally.wrong == 0,
    }
}

/// Case 17.
#[must_use]
pub fn one_step_across_the_target() -> Row {
    let (mut tally, mut misplaced) = (Tally::default(), 0_u32);
    for bits in [16, 24, 31] {
        let options = Options { depth: crate::oracle::DepthFormat { bits, fraction: 24 }, ..Options::default() };
        let mut screen = Screen::new(WIDEST as u32 - 1, 8, &options);
        // An f32 has neighbouring depths of 31 bits only far below 2^24.
        for z in [0, 1000, 40_000] {
            for (left, right) in [(z, z + 1), (z + 1, z)] {
                let scene = ramp(WIDEST - 1, left, right);
                tally.add(&compare_on(&mut screen, &scene, DepthFunction::Always));
                let picture = screen.read();
                for row in picture.depth.chunks(picture.width as usize) {
                    let step = row.iter().take_while(|&&found| found == left).count();
                    let rest = row[step..].iter().all(|&found| found == right);
                    // The centre of pixel i is at i + 1/2 of 16383: the depth is nearer to the right end from 8191 on.
                    let off = step.abs_diff(8191) as u32;
                    misplaced = misplaced.max(off);
                    tally.expect(rest && off <= 8, || {
                        format!("{bits} bits, {left} to {right}: step at {step}, once {rest}")
                    });
                }
            }
        }
    }
    Row {
        case: 17,
        name: "depth::one_step_across_the_target",
        construction: "1 LSB over 16383 px, rising and falling, 16, 24 and 31 bits, F = 24; strip of 16383 x 8",
        property: "each row has one step, at most 8 px misplaced; equal to the oracle",
        measured: format!("{tally}; misplaced by at most {misplaced} px"),
        passed: tally.wrong == 0,
    }
}

/// Case 18.
#[must_use]
pub fn steepest_plane() -> Row {
    let (mut random, mut tally, mut covered) = (Random::new(18), Tally::default(), 0);
    for format in formats() {
        let greatest = format.greatest();
        let size = [96, 96];
        let mut screen = Screen::new(size[0], size[1], &Options { depth: format, ..Options::default() });
        let scene: Vec<Primitive> = (0..576)
            .map(|k| {
                // A corner on the sample or next to it, the others 1 u away, or far off with the same area.
                let (x, y) = (k % 24 * 1024 + 640, k / 24 * 1024 + 640);
                let (dx, dy) = (random.int(-1, 0), random.int(-1, 0));
                let far = if k % 3 == 0 { random.int(-500, 500) } else { 0 };
                let mut z =
                    || [0, greatest, survivor(random.depth(greatest), format.bits)][random.range(0, 2) as usize];
                let corner = |x: i32, y: i32, z: u32| Vertex::at(x + dx, y + dy, z);
                Primitive::Triangle([corner(x, y, z()), corner(x + 1, y + far, z()), corner(x, y + 1, z())])
            })
            .collect();
        tally.add(&compare_on(&mut screen, &scene, DepthFunction::Always));
        let picture = screen.read();
        for (k, primitive) in (0..).zip(&scene) {
            let (i, j) = (k % 24 * 4 + 2, k / 24 * 4 + 2);
            if covers(primitive, i, j) {
                covered += 1;
                let range = primitive.vertices().iter().map(|v| v.z);
                let (least, most) = (range.clone().min().unwrap_or(0), range.max().unwrap_or(0));
                let found = picture.at(i as u32, j as u32).1;
                tally.expect((least..=most).contains(&found), || format!("{format:?}: {found} of {primitive:?}"));
            }
        }
    }
    Row {
        case: 18,
        name: "depth::steepest_plane",
        construction: "576 triangles of twice-area 1 u^2 at samples with depths 0, maximum and anything, every depth format",
        property: "covered depths within the vertices' range; equal to the oracle",
        measured: format!("{tally}; {covered} samples covered"),
        passed: tally.wrong == 0 && covered > 100,
    }
}
