//! Case 13: what must not matter.

use crate::hard::{Row, Tally};
use crate::harness::scenes::fixed;
use crate::harness::{Counts, Options, Picture, Random, Screen, State};
use crate::oracle::{Primitive, Vertex};
use zga_device::Kernel;

/// Every order of three vertices.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
const SIZE: [u32; 2] = [220, 170];

fn shifted(primitive: &Primitive, [dx, dy]: [i32; 2]) -> Primitive {
    let shift = |v: &Vertex| Vertex { x: v.x + 256 * dx, y: v.y + 256 * dy, ..*v };
    match primitive {
        Primitive::Triangle(v) => Primitive::Triangle([0, 1, 2].map(|k| shift(&v[k]))),
        Primitive::Line(v) => Primitive::Line([0, 1].map(|k| shift(&v[k]))),
        Primitive::Point(v) => Primitive::Point(shift(v)),
    }
}

fn permuted(primitive: &Primitive, order: [usize; 3]) -> Primitive {
    match primitive {
        Primitive::Triangle(v) => Primitive::Triangle(order.map(|k| v[k])),
        other => *other,
    }
}

fn painted(primitive: Primitive, random: &mut Random) -> Primitive {
    let mut colour = |v: Vertex| v.coloured((random.bits() as u32).to_le_bytes());
    match primitive {
        Primitive::Triangle([a, b, c]) => Primitive::Triangle([colour(a), colour(b), colour(c)]),
        Primitive::Line([a, b]) => Primitive::Line([colour(a), colour(b)]),
        Primitive::Point(v) => Primitive::Point(colour(v)),
    }
}

fn drawn(scene: &[Primitive], kernel: Kernel, threads: usize) -> (Picture, Counts) {
    let mut screen = Screen::new(SIZE[0], SIZE[1], &Options { kernel, threads, ..Options::default() });
    screen.clear_counts();
    screen.draw(scene, &State { gouraud: true, ..State::default() });
    (screen.read(), screen.counts())
}

/// Pixels that differ when `moved` is looked at (+7, -13) pixels away from `picture`.
fn differ(picture: &Picture, moved: &Picture) -> (usize, usize) {
    let places = (0..SIZE[0] - 7).flat_map(|i| (13..SIZE[1]).map(move |j| (i, j)));
    let wrong = places.clone().filter(|&(i, j)| picture.at(i, j) != moved.at(i + 7, j - 13)).count();
    (wrong, places.count())
}

/// Case 13.
#[must_use]
pub fn shifts_orders_and_threads() -> Row {
    let (mut random, mut tally) = (Random::new(13), Tally::default());
    let scene: Vec<Primitive> = fixed(13, SIZE, 3000, 12).into_iter().map(|p| painted(p, &mut random)).collect();
    let reference = drawn(&scene, Kernel::Specification, 1);

    let moved: Vec<Primitive> = scene.iter().map(|p| shifted(p, [7, -13])).collect();
    for kernel in Kernel::available() {
        let (wrong, pixels) = differ(&reference.0, &drawn(&moved, kernel, 2).0);
        tally.pictures += 1;
        tally.pixels += pixels;
        tally.note(wrong, || format!("{kernel:?}: {wrong} pixels differ after the shift"));
    }
    for order in ORDERS {
        let scene: Vec<Primitive> = scene.iter().map(|p| permuted(p, order)).collect();
        for kernel in Kernel::available() {
            for threads in 1..=4 {
                let found = drawn(&scene, kernel, threads);
                tally.pictures += 1;
                tally.pixels += found.0.colour.len();
                tally.expect(found == reference, || format!("{order:?}, {kernel:?}, {threads} threads differ"));
            }
        }
    }
    Row {
        case: 13,
        name: "rasteriser::shifts_orders_and_threads",
        construction: "3064 primitives with interpolated colours, shifted by (+7, -13) px, in all 6 vertex orders, on every kernel \
                       and 1 to 4 threads (the card takes its tiles in the order in which threads are free)",
        property: "identical colours, depths and counts",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}
