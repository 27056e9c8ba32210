//! Cases 39, 42 and 44: which fragment is in front.

use super::{Pair, WHITE, any_colour, coloured, flat, inside, plane, settings};
use crate::hard::{Row, Tally};
use crate::harness::{Order, Random, State, Subpixel};
use crate::oracle::{Primitive, Vertex};

/// Pixels that differ from the oracle's, for each way to order: rows of `[centre, search, exhaustive]`.
#[derive(Default)]
struct Ways {
    pixels: [usize; 3],
    wrong: [usize; 3],
    evaluations: [u64; 3],
    searches: [u64; 3],
}

impl Ways {
    fn add(&mut self, pair: &mut Pair, order: Order) {
        let (picture, wrong) = pair.end();
        let events = pair.screen.events();
        let way = order as usize;
        self.pixels[way] += picture.len();
        self.wrong[way] += wrong;
        self.evaluations[way] += events["subpixel.depth_evaluations"];
        self.searches[way] += events["subpixel.searches"];
    }

    fn exact(&self, order: Order) -> bool {
        self.pixels[order as usize] > 0 && self.wrong[order as usize] == 0
    }
}

impl std::fmt::Display for Ways {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (way, name) in ["centre", "search", "exhaustive"].into_iter().enumerate() {
            let (wrong, pixels, evaluations) = (self.wrong[way], self.pixels[way], self.evaluations[way]);
            let comma = if way == 0 { "" } else { ", " };
            write!(f, "{comma}{name} {wrong} of {pixels} wrong with {evaluations} depths")?;
        }
        Ok(())
    }
}

/// Gradients in steps a pixel: none, along an axis, along a diagonal, and between, in all octants.
fn gradients() -> Vec<[f64; 2]> {
    let ends = [-1600.0, -640.0, 0.0, 640.0, 1600.0];
    ends.into_iter().flat_map(|x| ends.map(|y| [x, y])).collect()
}

/// Case 39.
#[must_use]
pub fn start_corner_ties() -> Row {
    let gradients = gradients();
    let side = gradients.len() as u32;
    let (mut far, mut near) = (Ways::default(), Ways::default());
    for setting in settings() {
        let mut random = Random::new(39);
        let mut pair = Pair::new([side; 2], setting);
        // Far: deeper apart than the planes rise inside a pixel, so that ranges say the order. Near: they cross.
        for (distance, ways) in [(6000, &mut far), (100, &mut near)] {
            for _ in 0..6 {
                pair.clear([0, 0, 0, 255]);
                pair.screen.clear_counts();
                for (k, first) in gradients.iter().enumerate() {
                    for (n, second) in gradients.iter().enumerate() {
                        let place = [k as i32, n as i32];
                        let z = 1 << 20;
                        let front = plane(&mut random, place, z, *first, true);
                        let behind = plane(&mut random, place, z + distance, *second, true);
                        let scene =
                            [coloured(front, any_colour(&mut random)), coloured(behind, any_colour(&mut random))];
                        let swapped = [scene[1], scene[0]];
                        let scene = if random.range(0, 1) == 0 { scene } else { swapped };
                        pair.draw(&scene, &inside(place[0], place[1]));
                    }
                }
                ways.add(&mut pair, setting.depth);
            }
        }
    }
    let apart = far.wrong == [0; 3];
    Row {
        case: 39,
        name: "subpixel::start_corner_ties",
        construction: "two planes in one pixel, each cut by a random edge, with all 25 x 25 pairs of gradients out of 5 x 5 (dx = 0, \
                       dy = 0, |dx| = |dy|, 8 octants), far apart and crossing; 6 times, 3 grids",
        property: "exhaustive equal to the oracle; far apart the others too; at most two depths an extreme where the search looks",
        measured: format!(
            "far apart: {far}; crossing: {near}; {} searches far apart, {} crossing",
            far.searches[1], near.searches[1]
        ),
        passed: apart
            && near.exact(Order::Exhaustive)
            && far.searches[1] > 0
            && far.evaluations[1] <= 4 * far.searches[1],
    }
}

/// Case 42.
#[must_use]
pub fn interpenetration() -> Row {
    const SIDE: i32 = 40;
    let mut ways = Ways::default();
    for setting in settings() {
        let mut random = Random::new(42);
        let mut pair = Pair::new([SIDE as u32; 2], setting);
        pair.clear([0, 0, 0, 255]);
        for (i, j) in (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)) {
            // Two to five planes that meet within a fraction of their rise inside the pixel.
            let scene: Vec<Primitive> = (0..2 + (i + j) % 4)
                .map(|_| {
                    let gradient = [0; 2].map(|_: i32| random.between(-3000.0, 3000.0));
                    let (z, edge) = ((1 << 20) + random.int(-400, 400), random.range(0, 1) == 0);
                    let triangle = plane(&mut random, [i, j], z, gradient, edge);
                    coloured(triangle, any_colour(&mut random))
                })
                .collect();
            pair.draw(&scene, &inside(i, j));
        }
        ways.add(&mut pair, setting.depth);
    }
    Row {
        case: 42,
        name: "subpixel::interpenetration",
        construction: "1600 pixels with 2 to 5 planes that cross inside them, half of them cut by an edge; 3 grids",
        property: "exhaustive equal to the oracle; the others report their error",
        measured: ways.to_string(),
        passed: ways.exact(Order::Exhaustive),
    }
}

/// All orders of `n` things.
fn permutations(n: usize) -> Vec<Vec<usize>> {
    if n == 0 {
        return vec![vec![]];
    }
    let shorter = permutations(n - 1);
    shorter
        .iter()
        .flat_map(|order| {
            (0..n).map(move |place| {
                let mut order = order.clone();
                order.insert(place, n - 1);
                order
            })
        })
        .collect()
}

/// Case 44.
#[must_use]
pub fn merge_in_any_order() -> Row {
    let (mut tally, mut merges, mut unlike) = (Tally::default(), [0; 3], 0);
    let orders = permutations(5);
    // One plane, z = 500000 + 700 x + 300 y steps and pixels; a wall behind it.
    let at = |[i, j]: [i32; 2], (x, y): (i32, i32)| {
        let z = 500_000 + (700 * x + 300 * y) / 256;
        Vertex::at(i * 256 + x, j * 256 + y, z as u32).coloured(WHITE)
    };
    let shapes: [[(i32, i32); 6]; 3] = [
        // On samples of all grids, off them, and with spokes that end inside the pixel.
        [(96, 96), (2048, 96), (96, 2048), (-2048, 1024), (-2048, -1024), (1024, -2048)],
        [(131, 117), (1999, -212), (411, 1777), (-1733, 999), (-1601, -1511), (777, -1905)],
        [(128, 128), (216, 130), (150, 240), (60, 214), (24, 100), (140, 16)],
    ];
    for setting in settings() {
        for (number, shape) in shapes.iter().enumerate() {
            let mut pair = Pair::new([12, 10], setting);
            pair.clear([0, 0, 90, 255]);
            pair.screen.clear_counts();
            for (order, place) in orders.iter().zip((0..).map(|k| [k % 12, k / 12])) {
                let corners = |k: usize| [shape[0], shape[1 + k], shape[1 + (k + 1) % 5]];
                let scene = order.iter().map(|&k| Primitive::Triangle(corners(k).map(|corner| at(place, corner))));
                let [i, j] = place;
                let wall = [(-999, -999), (1999, -999), (-999, 1999)].map(|(x, y)| (i * 256 + x, j * 256 + y));
                let scene: Vec<Primitive> = scene.chain([flat(wall, 900_000, [200, 0, 0, 255])]).collect();
                pair.draw(&scene, &inside(i, j));
            }
            let picture = pair.compare(&mut tally, &format!("{setting:?}, shape {number}"));
            let others = picture.iter().filter(|&&pixel| pixel != picture[0]).count();
            unlike += others;
            tally.note(others, || format!("{setting:?}, shape {number}: {others} orders give another pixel"));
            merges[setting.depth as usize] += pair.screen.events()["subpixel.merges"];
        }
    }
    tally.note(whole_orders(), || "a surface drawn in two orders differs".into());
    Row {
        case: 44,
        name: "subpixel::merge_in_any_order",
        construction: "a surface of 5 triangles round a point in the pixel in all 120 orders before a wall, 3 shapes; a terrain \
                       forwards and backwards; 3 grids, 3 orders of fragments",
        property: "every order one picture, equal to the oracle",
        measured: format!("{tally}; {unlike} orders unlike; merges: centre, search, exhaustive {merges:?}"),
        passed: tally.wrong == 0,
    }
}

/// Pixels of a surface without folds that change when its triangles come in another order.
fn whole_orders() -> usize {
    let mut random = Random::new(44);
    let vertices: Vec<Vertex> = (0..100)
        .map(|k| {
            let [x, y] = [k % 10, k / 10].map(|c| c * 500 + random.int(-150, 150));
            Vertex::at(x, y, (1 << 20) + random.depth(4000)).coloured(WHITE)
        })
        .collect();
    let cell = |k: usize| {
        let [a, b, c, d] = [k, k + 1, k + 10, k + 11].map(|k| vertices[k]);
        [Primitive::Triangle([a, b, c]), Primitive::Triangle([c, b, d])]
    };
    let scene: Vec<Primitive> = (0..90).filter(|k| k % 10 < 9).flat_map(cell).collect();
    let backwards: Vec<Primitive> = scene.iter().rev().copied().collect();
    let differing = |setting: Subpixel| {
        let [a, b] = [&scene, &backwards].map(|scene| {
            let mut pair = Pair::new([18, 18], setting);
            pair.clear([0, 0, 90, 255]);
            pair.draw(scene, &State::masked());
            let (picture, wrong) = pair.end();
            (picture, wrong)
        });
        a.1 + b.1 + a.0.iter().zip(&b.0).filter(|(a, b)| a != b).count()
    };
    settings().map(differing).sum()
}
