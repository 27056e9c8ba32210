//! Cases 1, 2, 3, 5, 6, 7, 12: coverage inside the guard band.

use super::{centre, triangle};
use crate::hard::{Row, Tally, compare, compare_on, fragments};
use crate::harness::{Options, Pixels, Random, RawVertex, Screen, State, Topology};
use crate::oracle::clip::snap;
use crate::oracle::exact::from_f64;
use crate::oracle::raster::covers;
use crate::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

/// Case 1.
#[must_use]
pub fn small_triangles_at_a_centre() -> Row {
    let shifts = [-16, -1, 0, 1, 16];
    // The right angle on the centre, the centre inside, the centre on the long side.
    let places = [0, -16, -24];
    let mut scene = Vec::new();
    for (sx, sy) in [(1, 1), (-1, 1), (1, -1), (-1, -1)] {
        for (place, dx, dy) in
            places.iter().flat_map(|p| shifts.map(|x| (p, x))).flat_map(|(p, x)| shifts.map(|y| (p, x, y)))
        {
            let (i, j) = (scene.len() as i32 % 20, scene.len() as i32 / 20);
            let corner = |x: i32, y: i32| (centre(i) + sx * (place + x) + dx, centre(j) + sy * (place + y) + dy);
            scene.push(triangle([corner(0, 0), corner(48, 0), corner(0, 48)], 7));
        }
    }
    let found = compare([20, 15], &scene, DepthFormat::default(), DepthFunction::Less);
    let covered = scene.iter().enumerate().filter(|(k, t)| covers(t, *k as i32 % 20, *k as i32 / 20)).count();
    Row {
        case: 1,
        name: "rasteriser::small_triangles_at_a_centre",
        construction: "300 triangles with legs of 3/16 px at a pixel centre, shifted by 0, 1 u and 1/16 px, 4 orientations",
        property: "equal to the oracle",
        measured: format!("{found}; {covered} of {} cover their centre", scene.len()),
        passed: found.none() && scene.len() == 300 && (1..300).contains(&covered),
    }
}

/// Case 2.
#[must_use]
pub fn nearly_shared_floats() -> Row {
    let corners = [[0.5_f32, 0.499_938_96], [0.5, 6.5], [6.500_061, 0.499_938_96], [6.500_061, 6.5]];
    let triangles = [[0, 1, 2], [3, 2, 1]];
    let mut screen = Screen::new(8, 8, &Options::default());
    screen.clear_counts();
    let vertices: Vec<RawVertex> = (1..)
        .zip(triangles)
        .flat_map(|(id, t)| t.map(|k| (id, corners[k])))
        .map(|(id, [x, y])| RawVertex { position: [x, y, 0.0], colour: Pixels::Xrgb8888.colour_of(id) })
        .collect();
    screen.draw_raw(Topology::Triangles, &vertices, None, &State::default());

    let u = |c: f32| from_f64(c.into()).and_then(|c| snap(&c, 8)).unwrap_or(i32::MIN);
    let scene = triangles.map(|t| triangle(t.map(|k| (u(corners[k][0]), u(corners[k][1]))), 0));
    let found = screen.read().against(&draw(8, 8, &scene, DepthFormat::default(), DepthFunction::Less));
    let fragments = screen.counts().reads;
    Row {
        case: 2,
        name: "rasteriser::nearly_shared_floats",
        construction: "(.5, .49993896) (.5, 6.5) (6.50006104, .49993896) (6.50006104, 6.5) as triangles 012 and 321",
        property: "no hole: the 36 pixels of the square once each, equal to the oracle",
        measured: format!("{found}; {fragments} fragments"),
        passed: found.none() && fragments == 36,
    }
}

/// A fan of `count` triangles round a hub, with corners at falling angles; axes and diagonals are frequent.
fn fan(random: &mut Random, hub: i32, count: usize) -> Vec<Primitive> {
    loop {
        let mut rim: Vec<(i32, i32)> = (0..count)
            .map(|_| {
                let r = random.int(40, 900);
                let octant =
                    |k: i64| [(r, 0), (r, r), (0, r), (-r, r), (-r, 0), (-r, -r), (0, -r), (r, -r)][k as usize];
                let free = (random.int(-900, 900), random.int(-900, 900));
                if random.range(0, 1) == 0 { octant(random.range(0, 7)) } else { free }
            })
            .collect();
        rim.sort_by(|a, b| f64::from(a.1).atan2(a.0.into()).total_cmp(&f64::from(b.1).atan2(b.0.into())));
        let pairs: Vec<_> = rim.iter().zip(rim.iter().cycle().skip(1)).collect();
        // Each spoke turns on by less than half a turn.
        if pairs.iter().all(|(a, b)| i64::from(a.0) * i64::from(b.1) > i64::from(a.1) * i64::from(b.0)) {
            let at = |p: &(i32, i32)| (hub + p.0, hub + p.1);
            return pairs.iter().map(|(a, b)| triangle([(hub, hub), at(a), at(b)], 5)).collect();
        }
    }
}

/// Case 3.
#[must_use]
pub fn fans_with_the_hub_on_a_centre() -> Row {
    let (mut random, mut tally, mut hubs) = (Random::new(3), Tally::default(), 0);
    let mut screen = Screen::new(9, 9, &Options::default());
    for count in (3..=9).flat_map(|n| [n; 40]) {
        let scene = fan(&mut random, centre(4), count);
        tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
        screen.clear_counts();
        let hub = State { scissor: Some([4, 4, 5, 5]), ..State::with(DepthFunction::Always) };
        screen.draw_ids(&scene, &hub);
        let covered = screen.counts().reads;
        hubs += 1;
        tally.expect(covered == 1, || format!("a hub of {count} triangles is covered {covered} times"));
        let (drawn, fragments) = fragments(&mut screen, &scene);
        tally.expect(drawn as u64 == fragments, || format!("{fragments} fragments on {drawn} pixels"));
    }
    Row {
        case: 3,
        name: "rasteriser::fans_with_the_hub_on_a_centre",
        construction: "280 fans of 3 to 9 triangles, hub on a pixel centre, spokes on axes, diagonals and anywhere",
        property: "hub covered once, every pixel at most once, equal to the oracle",
        measured: format!("{tally}; {hubs} hubs"),
        passed: tally.wrong == 0 && hubs == 280,
    }
}

/// Case 5.
#[must_use]
pub fn sliver_across_the_widest_target() -> Row {
    let far = 16_384 * 256;
    let mut screen = Screen::new(16_384, 8, &Options::default());
    let (mut tally, mut own) = (Tally::default(), 0);
    // As it stands it lies above the first row of centres; moved down by up to 4 rows it crosses them in every way.
    for y in [0, 125, 126, 127, 128, 129, 382, 383, 384, 1150, 1151, 1152] {
        let above = triangle([(0, y), (far, y - 700), (far, y + 1)], 5);
        let sliver = triangle([(0, y), (far, y + 1), (far, y + 2)], 5);
        let below = triangle([(0, y), (far, y + 2), (far, y + 700)], 5);
        let union = triangle([(0, y), (far, y - 700), (far, y + 700)], 5);
        for part in [above, sliver, below] {
            tally.add(&compare_on(&mut screen, &[part], DepthFunction::Less));
        }
        own += fragments(&mut screen, &[sliver]).0;
        let (drawn, fragments_of_parts) = fragments(&mut screen, &[above, sliver, below]);
        let whole = fragments(&mut screen, &[union]).0;
        tally.expect(drawn == whole && fragments_of_parts == whole as u64, || {
            format!("y = {y}: {fragments_of_parts} fragments on {drawn} pixels, the union has {whole}")
        });
    }
    Row {
        case: 5,
        name: "rasteriser::sliver_across_the_widest_target",
        construction: "sliver (0, 0) (16384 px, 1 u) (16384 px, 2 u) and both neighbours, at 12 heights; strip of 16384 x 8",
        property: "each equal to the oracle, union covered once",
        measured: format!("{tally}; slivers cover {own} pixels"),
        passed: tally.wrong == 0 && own > 0,
    }
}

/// Two vectors in u with determinant 1.
fn unimodular(random: &mut Random) -> [(i32, i32); 2] {
    let (mut a, mut b) = ((1, 0), (0, 1));
    for _ in 0..random.range(0, 6) {
        let k = random.int(-4, 4);
        (a, b) = ((a.0 + k * b.0, a.1 + k * b.1), b);
        // (a, b) -> (b, -a) keeps the determinant.
        (a, b) = (b, (-a.0, -a.1));
    }
    [a, b]
}

/// Case 6.
#[must_use]
pub fn least_area() -> Row {
    let mut random = Random::new(6);
    let cell = |k: usize| (centre(k as i32 % 30 * 8 + 4), centre(k as i32 / 30 * 8 + 4));
    // A corner on the sample, or near it.
    let mut scene: Vec<Primitive> = (0..900)
        .map(|k| {
            let (x, y) = cell(k);
            let (dx, dy) = if k % 2 == 0 { (0, 0) } else { (random.int(-2, 2), random.int(-2, 2)) };
            let [a, b] = loop {
                let found = unimodular(&mut random);
                if found.iter().all(|p| p.0.abs() < 800 && p.1.abs() < 800) {
                    break found;
                }
            };
            triangle([(x + dx, y + dy), (x + dx + a.0, y + dy + a.1), (x + dx + b.0, y + dy + b.1)], 5)
        })
        .collect();
    let size = [240, 240];
    let found = compare(size, &scene, DepthFormat::default(), DepthFunction::Less);
    let on =
        scene.iter().enumerate().filter(|(k, t)| covers(t, (k % 30 * 8 + 4) as i32, (k / 30 * 8 + 4) as i32)).count();
    // Area 0: all three on one line, two or three equal.
    for (k, primitive) in scene.iter_mut().enumerate() {
        let ((x, y), [a, _]) = (cell(k), unimodular(&mut random));
        let step = |n: i32| (x + n * a.0, y + n * a.1);
        *primitive = triangle([step(0), step(random.int(-2, 2)), step(random.int(-2, 2))], 5);
    }
    let mut screen = Screen::new(size[0], size[1], &Options::default());
    let empty = fragments(&mut screen, &scene);
    Row {
        case: 6,
        name: "rasteriser::least_area",
        construction: "900 triangles of twice-area 1 u^2 with a corner on a sample or within 2 u of it; 900 of area 0",
        property: "equal to the oracle; area 0 draws no pixel",
        measured: format!("{found}; {on} cover their sample; area 0: {} pixels", empty.0),
        passed: found.none() && on > 0 && on < 900 && empty == (0, 0),
    }
}

/// Case 7.
#[must_use]
pub fn vertices_at_the_limits() -> Row {
    let mut tally = Tally::default();
    let mut clipped = 0;
    let mut random = Random::new(7);
    for (size, pictures) in [([64, 48], 40), ([16_384, 8], 4), ([8, 16_384], 4)] {
        let mut screen = Screen::new(size[0], size[1], &Options::default());
        screen.clear_counts();
        let middle = size.map(|side| side as i32 * 128);
        for _ in 0..pictures {
            let mut coordinate = |axis: usize| {
                let jitter = random.int(0, 3);
                let limit = [1 << 23, -(1 << 23), random.int(-20_000, 20_000)][random.range(0, 2) as usize];
                middle[axis] + limit - jitter * limit.signum()
            };
            let mut corner = |z: u32| Vertex::at(coordinate(0), coordinate(1), z);
            let scene: Vec<Primitive> =
                (0..30).map(|k| Primitive::Triangle([corner(k * 500_000), corner(9), corner(0x00FF_FFFF)])).collect();
            tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
        }
        clipped += screen.counts().clipped;
    }
    Row {
        case: 7,
        name: "rasteriser::vertices_at_the_limits",
        construction: "1440 triangles with vertices at +-2^23 u (and up to 3 u inside) from the target's centre, where the guard \
                       band ends; 64 x 48, 16384 x 8, 8 x 16384",
        property: "i64 equals i128: equal to the oracle, nothing clipped",
        measured: format!("{tally}; {clipped} clipped"),
        passed: tally.wrong == 0 && clipped == 0,
    }
}

/// Case 12.
#[must_use]
pub fn t_junction() -> Row {
    let far = 16_384 * 256;
    let mut screen = Screen::new(16_384, 8, &Options::default());
    let (mut tally, mut holes, mut doubles) = (Tally::default(), 0, 0);
    // The line (0, y) - (16384 px, y + 3 px) meets the grid every 64 px, 3 u.
    for (y, k) in [(0, 1), (0, 77), (128, 128), (131, 200), (500, 13), (640, 255)] {
        for off in [0, 1, -1] {
            let ends = ((0, y), (far, y + 768));
            let middle = (k * 16_384, y + 3 * k + off);
            let (up, down) = ((far / 2, y - 60_000), (far / 3, y + 60_000));
            let scene = [
                triangle([ends.0, ends.1, up], 5),
                triangle([ends.0, middle, down], 5),
                triangle([middle, ends.1, down], 5),
            ];
            tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
            let union = [triangle([ends.0, ends.1, up], 5), triangle([ends.0, ends.1, down], 5)];
            let whole = fragments(&mut screen, &union).0;
            let (drawn, fragments) = fragments(&mut screen, &scene);
            let (hole, double) = (whole.abs_diff(drawn), (fragments - drawn as u64) as usize);
            tally.note(if off == 0 { hole + double } else { 0 }, || format!("{hole} holes, {double} pixels twice"));
            (holes, doubles) = (holes + hole, doubles + double);
        }
    }
    Row {
        case: 12,
        name: "rasteriser::t_junction",
        construction: "T-junction on (0, 0) - (16384 px, 3 px) at 6 places, vertex on the line and 1 u off; strip of 16384 x 8",
        property: "on the line: no hole, nothing twice; 1 u off: equal to the oracle, holes counted",
        measured: format!("{tally}; 1 u off: {holes} pixels more or less than the union, {doubles} twice"),
        passed: tally.wrong == 0,
    }
}
