//! Cases 38, 40, 41 and 45: which samples are covered.

use super::{Pair, WHITE, count, flat, inside, samples, settings};
use crate::hard::{Row, Tally};
use crate::harness::{Grid, Random, State, Subpixel};
use crate::oracle::Primitive;

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const BLACK: [u8; 4] = [0, 0, 0, 255];

/// Sample positions of a grid, u from the pixel's upper left corner.
fn positions([columns, rows]: [u32; 2]) -> Vec<(i32, i32)> {
    let middle = |place: u32, of: u32| (256 * (2 * place + 1) / (2 * of)) as i32;
    (0..columns * rows).map(|k| (middle(k % columns, columns), middle(k / columns, rows))).collect()
}

/// Case 38.
#[must_use]
pub fn edges_through_samples() -> Row {
    const SIDE: i32 = 45;
    let (mut tally, mut edges, mut holes, mut doubles) = (Tally::default(), 0, 0, 0);
    for grid in Grid::ALL {
        let positions = positions(grid.size());
        let pairs = positions.iter().enumerate().flat_map(|(k, p)| positions[k + 1..].iter().map(move |q| (*p, *q)));
        // A rhombus about the pixel, cut along the line through two samples.
        let halves = pairs.zip(0..).map(|((p, q), number)| {
            let (i, j) = (number % SIDE, number / SIDE);
            let (dx, dy) = (q.0 - p.0, q.1 - p.1);
            let k = 1200 / dx.abs().max(dy.abs()) + 1;
            let at = |x: i32, y: i32| (i * 256 + p.0 + k * x, j * 256 + p.1 + k * y);
            let (a, b, c, d) = (at(-dx, -dy), at(dx, dy), at(-dy, dx), at(dy, -dx));
            ([i, j], flat([a, b, c], 5, RED), flat([b, a, d], 5, GREEN))
        });
        let halves: Vec<_> = halves.collect();
        let mut pair = Pair::new([SIDE as u32; 2], Subpixel::exhaustive(grid));
        let pictures = [false, true].map(|swapped| {
            pair.clear(BLUE);
            for &([i, j], first, second) in &halves {
                pair.draw(&if swapped { [second, first] } else { [first, second] }, &inside(i, j));
            }
            pair.compare(&mut tally, &format!("{grid:?}, swapped {swapped}"))
        });
        edges += halves.len();
        // Of equal depths the first stays: what both cover changes colour with the order.
        doubles += (0..halves.len()).filter(|&k| pictures[0][k] != pictures[1][k]).count();
        holes += (0..halves.len()).filter(|&k| pictures[0][k][2] != 0).count();
    }
    tally.note(holes + doubles, || "a shared edge leaks".into());
    Row {
        case: 38,
        name: "subpixel::edges_through_samples",
        construction: "a rhombus over a pixel, cut into two triangles along the line through two samples, all pairs of samples, 3 \
                       grids, both orders",
        property: "no sample twice (both orders give one picture), none left out, equal to the oracle",
        measured: format!("{tally}; {edges} edges, {holes} with a hole, {doubles} with a sample twice"),
        passed: tally.wrong == 0 && edges == 120 + 496 + 2016,
    }
}

/// Round a hub in pixel (1, 1), so large that it covers all of that pixel.
fn fan(random: &mut Random, hub: (i32, i32), spokes: i32) -> Vec<[(i32, i32); 3]> {
    let sector = std::f64::consts::TAU / f64::from(spokes);
    let turn = random.between(0.0, sector);
    let rim: Vec<(i32, i32)> = (0..spokes)
        .map(|k| {
            let angle = turn + sector * (f64::from(k) + random.between(-0.16, 0.16));
            let reach = random.between(2600.0, 4000.0);
            (hub.0 + (angle.cos() * reach) as i32, hub.1 + (angle.sin() * reach) as i32)
        })
        .collect();
    rim.iter().zip(rim.iter().cycle().skip(1)).map(|(a, b)| [hub, *a, *b]).collect()
}

/// Case 40.
#[must_use]
pub fn fans_inside_a_pixel() -> Row {
    const FANS: i32 = 140;
    let (mut random, mut tally, mut full, mut sums) = (Random::new(40), Tally::default(), 0, 0);
    for setting in settings() {
        let positions = positions(setting.grid.size());
        // Row by row: the whole fan in column 0, its triangles one by one behind it.
        let mut pair = Pair::new([10, FANS as u32], setting);
        pair.clear(BLACK);
        for j in 0..FANS {
            let hub = match j % 4 {
                0 => positions[random.range(0, positions.len() as i64 - 1) as usize],
                1 => (128, 128),
                2 => [(0, 0), (256, 0), (0, 128), (32, 256)][random.range(0, 3) as usize],
                _ => (random.int(0, 256), random.int(0, 256)),
            };
            let fan = fan(&mut random, hub, 3 + j % 7);
            let at =
                |i: i32, corners: [(i32, i32); 3]| flat(corners.map(|(x, y)| (i * 256 + x, j * 256 + y)), 5, WHITE);
            let whole: Vec<Primitive> = fan.iter().map(|corners| at(0, *corners)).collect();
            pair.draw(&whole, &inside(0, j));
            for (i, corners) in (1..).zip(&fan) {
                pair.draw(&[at(i, *corners)], &inside(i, j));
            }
        }
        let picture = pair.compare(&mut tally, &format!("{setting:?}"));
        for row in picture.chunks(10) {
            let sum: u32 = row[1..].iter().map(|pixel| count(pixel[0], setting)).sum();
            full += usize::from(row[0] == WHITE);
            sums += usize::from(sum == samples(setting));
        }
    }
    let fans = 9 * FANS as usize;
    tally.note(2 * fans - full - sums, || format!("{full} full, {sums} sums right"));
    Row {
        case: 40,
        name: "subpixel::fans_inside_a_pixel",
        construction: "140 white fans of 3 to 9 triangles over a black pixel, hub on a sample, the centre, a side, a corner or \
                       anywhere in the pixel; 3 grids, 3 orders; and each triangle alone",
        property: "together exact white; counts of samples sum to 16, 32, 64; equal to the oracle",
        measured: format!("{tally}; {full} of {fans} full, {sums} sums exact"),
        passed: tally.wrong == 0,
    }
}

/// Case 41.
#[must_use]
pub fn doubling_back_on_a_diagonal() -> Row {
    let (mut tally, mut pixels) = (Tally::default(), 0);
    for setting in settings() {
        // Corners on the pixels' corners, between samples, on samples.
        for inset in [0, 16, 32, 48, 100] {
            for mirrored in [false, true] {
                let mut pair = Pair::new([12, 12], setting);
                pair.clear(BLACK);
                let far = 12 * 256 - inset;
                let at = |x: i32, y: i32| if mirrored { (12 * 256 - x, y) } else { (x, y) };
                let (a, b, c, d) = (at(inset, inset), at(far, inset), at(far, far), at(inset, far));
                // One way round to c, back along the diagonal to a, which encloses nothing, and round the other way.
                let path = [[a, b, c], [c, a, c], [a, c, a], [a, c, d]];
                pair.draw(&path.map(|corners| flat(corners, 5, WHITE)), &State::masked());
                let picture = pair.compare(&mut tally, &format!("{setting:?}, {inset} u in"));
                let inner = (0..144).filter(|k| (1..11).contains(&(k % 12)) && (1..11).contains(&(k / 12)));
                let holes = inner.clone().filter(|&k| picture[k] != WHITE).count();
                pixels += inner.count();
                tally.note(holes, || format!("{setting:?}, {inset} u in: {holes} pixels are not full"));
            }
        }
    }
    Row {
        case: 41,
        name: "subpixel::doubling_back_on_a_diagonal",
        construction: "a square as a path that goes round to the opposite corner, back along the diagonal (two triangles of area 0) \
                       and round the other way; both diagonals, 5 insets, 3 grids, 3 orders",
        property: "every pixel inside full, equal to the oracle",
        measured: format!("{tally}; {pixels} pixels inside"),
        passed: tally.wrong == 0,
    }
}

/// Case 45.
#[must_use]
pub fn triangles_between_samples() -> Row {
    let (mut tally, mut alone, mut masks, mut meshed) = (Tally::default(), 0, 0, 0);
    for setting in settings() {
        // Squares of 8 u, in two halves, over 3 x 3 pixels and a margin: most miss all samples.
        let mut pair = Pair::new([5, 5], setting);
        let positions = positions(setting.grid.size());
        let cell = |k: i32| {
            let (x, y) = (200 + k % 110 * 8, 200 + k / 110 * 8);
            [[(x, y), (x + 8, y), (x, y + 8)], [(x, y + 8), (x + 8, y), (x + 8, y + 8)]]
        };
        let mesh: Vec<Primitive> = (0..110 * 110).flat_map(cell).map(|corners| flat(corners, 5, WHITE)).collect();
        pair.clear(BLACK);
        pair.draw(&mesh, &State::masked());
        let picture = pair.compare(&mut tally, &format!("{setting:?}: mesh"));
        let holes = (6..19).filter(|k| (1..4).contains(&(k % 5)) && picture[*k] != WHITE).count();
        tally.note(holes, || format!("{setting:?}: {holes} pixels of the mesh are not full"));
        meshed += mesh.len();

        // Those with no sample in them or on their sides, alone.
        let near = |c: (i32, i32), p: (i32, i32)| {
            let off = |c: i32, p: i32| c.rem_euclid(256) <= p && p <= c.rem_euclid(256) + 8;
            off(c.0, p.0) && off(c.1, p.1)
        };
        let empty = |primitive: &&Primitive| {
            let v = primitive.vertices();
            let corner = (v.iter().map(|v| v.x).min().unwrap_or(0), v.iter().map(|v| v.y).min().unwrap_or(0));
            !positions.iter().any(|&p| near(corner, p))
        };
        let between: Vec<Primitive> = mesh.iter().filter(empty).copied().collect();
        pair.clear(BLACK);
        pair.screen.clear_counts();
        pair.draw(&between, &State::masked());
        let picture = pair.compare(&mut tally, &format!("{setting:?}: alone"));
        let drawn = picture.iter().filter(|&&pixel| pixel != BLACK).count();
        let events = pair.screen.events();
        tally.note(drawn, || format!("{setting:?}: {drawn} pixels drawn by triangles without a sample"));
        tally.expect(events["subpixel.masks"] >= between.len() as u64, || {
            format!("{setting:?}: {} masks of {} triangles", events["subpixel.masks"], between.len())
        });
        alone += between.len();
        masks += events["subpixel.masks"];
    }
    Row {
        case: 45,
        name: "subpixel::triangles_between_samples",
        construction: "a white mesh of 24200 triangles with legs of 8 u over 3 x 3 pixels; those without a sample alone; 3 grids, 3 \
                       orders",
        property: "the mesh is full; without a sample nothing is drawn, but the mask is counted; equal to the oracle",
        measured: format!("{tally}; {meshed} triangles, {alone} without a sample made {masks} masks"),
        passed: tally.wrong == 0 && alone > 0,
    }
}
