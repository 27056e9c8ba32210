//! Case 43: translucent layers.

use super::{Pair, coloured, inside, plane};
use crate::hard::{Row, Tally};
use crate::harness::{Grid, Order, Random, Resolve, State, Subpixel};
use crate::oracle::Primitive;

const LAYERS: [u32; 4] = [33, 65, 81, 300];

/// What the layers of a pixel have in common.
#[derive(Clone, Copy, Debug)]
enum Stack {
    /// Depths at random, whole pixels.
    Whole,
    /// The same, each cut by an edge.
    Cut,
    /// One depth: the later in front.
    Tied,
    /// No depth test: the later in front.
    Free,
    /// Three to a plane, which others cross; the later in front.
    Repeated,
    /// Half of them behind something opaque that comes in the middle.
    Hidden,
}

const STACKS: [Stack; 6] = [Stack::Whole, Stack::Cut, Stack::Tied, Stack::Free, Stack::Repeated, Stack::Hidden];

fn layers(random: &mut Random, place: [i32; 2], count: u32, stack: Stack) -> Vec<Primitive> {
    let mut last = None;
    let mut layer = |random: &mut Random, number: u32| {
        let (z, gradient) = match stack {
            Stack::Tied => (1 << 20, [0.0; 2]),
            _ => (random.int(1 << 18, 1 << 22), [random.between(-900.0, 900.0), random.between(-900.0, 900.0)]),
        };
        let cut = matches!(stack, Stack::Cut | Stack::Hidden);
        let triangle = match last {
            Some(last) if matches!(stack, Stack::Repeated) && !number.is_multiple_of(3) => last,
            _ => plane(random, place, z, gradient, cut),
        };
        last = Some(triangle);
        let [r, g, b, alpha] = (random.bits() as u32).to_le_bytes();
        // Thin ones, so that the last of 300 still counts.
        coloured(triangle, [r, g, b, 1 + alpha % 12])
    };
    (0..count).map(|number| layer(random, number)).collect()
}

/// Case 43.
#[must_use]
pub fn many_layers() -> Row {
    let (mut random, mut tally) = (Random::new(43), Tally::default());
    let (mut drawn, mut fragments, mut degraded) = (0, 0, 0);
    for (grid, resolve) in Grid::ALL.into_iter().flat_map(|grid| Resolve::ALL.map(|resolve| (grid, resolve))) {
        for depth in Order::ALL {
            let setting = Subpixel { depth, resolve, ..Subpixel::on(grid) };
            // Without a cut all samples of a pixel have the layers in one order, up to where planes cross.
            let exact = depth == Order::Exhaustive;
            let stacks = STACKS.into_iter().filter(|stack| exact || matches!(stack, Stack::Tied | Stack::Free));
            let mut pair = Pair::new([LAYERS.len() as u32, STACKS.len() as u32], setting);
            pair.clear([40, 120, 200, 90]);
            pair.screen.clear_counts();
            for (j, stack) in (0..).zip(stacks) {
                for (i, count) in (0..).zip(LAYERS) {
                    let scene = layers(&mut random, [i, j], count, stack);
                    let state = State { blend: true, depth_test: !matches!(stack, Stack::Free), ..inside(i, j) };
                    let (early, late) = scene.split_at(scene.len() / 2);
                    pair.draw(early, &state);
                    if matches!(stack, Stack::Hidden) {
                        let wall = plane(&mut random, [i, j], 1 << 21, [500.0, -900.0], true);
                        pair.draw(&[coloured(wall, [250, 10, 60, 255])], &inside(i, j));
                    }
                    pair.draw(late, &state);
                    drawn += u64::from(count);
                }
            }
            pair.compare(&mut tally, &format!("{setting:?}"));
            let events = pair.screen.events();
            fragments += events["subpixel.fragments"];
            degraded += events["subpixel.pixels_degraded"];
        }
    }
    tally.note(degraded as usize, || format!("{degraded} pixels degraded"));
    Row {
        case: 43,
        name: "subpixel::many_layers",
        construction: "33, 65, 81 and 300 translucent layers in one pixel: whole, cut by edges, of one depth, without a depth, of \
                       repeated planes, about something opaque; 3 grids, 2 ways to average, 3 orders (those that cross: exhaustive)",
        property: "every layer counts: equal to exact composition, no pixel degraded",
        measured: format!("{tally}; {drawn} layers, {fragments} fragments stored, {degraded} pixels degraded"),
        passed: tally.wrong == 0 && fragments > 0,
    }
}
