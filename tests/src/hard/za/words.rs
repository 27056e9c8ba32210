//! Cases 23 and 24: words are exact maxima.

use super::{both, point, predictions, quad, screen};
use crate::hard::{Row, Tally};
use crate::harness::scenes::fixed;
use crate::harness::{Hidden, Random, State};
use crate::oracle::DepthFunction;

/// Case 23.
#[must_use]
pub fn words_are_maxima() -> Row {
    let (mut tally, mut operations, mut blocks) = (Tally::default(), 0, 0);
    let shapes = [[32, 1], [16, 2], [8, 4], [8, 8], [1, 1], [5, 3], [64, 64], [200, 1]];
    for (seed, hidden) in (0_u64..).zip(shapes.into_iter().flat_map(predictions)) {
        let (size, mut random) = ([83, 41], Random::new(2300 + seed));
        let mut screen = screen(size, hidden);
        let scene = fixed(seed, size, 300, 20);
        let greatest = screen.options().depth.greatest();
        for number in 0..60 {
            let mut side = |most: u32| random.int(0, most as i32) as u32;
            let area = [side(83), side(41), side(90), side(50)];
            let kind = random.int(0, 9);
            let function = DepthFunction::ALL[random.int(0, 7) as usize];
            let depth = random.depth(greatest);
            match kind {
                0 => screen.clear(),
                1 => screen.clear_planes(None, Some(depth), Some(area)),
                2 => screen.clear_planes(Some(depth), None, Some(area)),
                3 => screen.clear_planes(Some(1), Some(depth), Some(area)),
                4 => screen.end(),
                _ => {
                    let first = random.int(0, 350) as usize;
                    let some = &scene[first..(first + 5).min(scene.len())];
                    let function = if kind < 8 { DepthFunction::Less } else { function };
                    let state =
                        State { function, write: number % 7 != 0, depth_test: number % 11 != 0, ..State::default() };
                    screen.draw_ids(some, &state);
                }
            }
            let (initialised, fault) = screen.za_check();
            (operations, blocks) = (operations + 1, blocks + initialised);
            tally.expect(fault.is_none(), || format!("{hidden:?}, operation {number}: {}", fault.unwrap_or_default()));
        }
    }
    Row {
        case: 23,
        name: "za::words_are_maxima",
        construction: "random draws with any state, clears of anything, scenes that end; 8 block shapes, 3 predictions, both \
                       fidelities; words and depths read over the bus after each",
        property: "word = exact maximum of its block's depths, or the block is cleared",
        measured: format!("{operations} operations, {blocks} words of initialised blocks, {tally}"),
        passed: tally.wrong == 0 && blocks > 10_000,
    }
}

/// Case 24.
#[must_use]
pub fn last_of_thirty_two() -> Row {
    let mut tally = Tally::default();
    let shapes = [([32, 1], [32, 1]), ([16, 2], [16, 2]), ([8, 4], [8, 4]), ([4, 8], [4, 8])];
    for (block, [width, height]) in shapes {
        for hidden in both(Hidden::za(block)) {
            let mut screen = screen([width, height], hidden);
            for last in 0..32 {
                screen.clear();
                screen.draw_ids(&quad([0, 0, width as i32, height as i32], 5000), &State::default());
                let place = |number: i32| (number % width as i32, number / width as i32);
                let others = (0..32).filter(|&number| number != last).map(place);
                let nearer: Vec<_> = others.map(|(x, y)| point(x, y, 1000)).collect();
                screen.draw_ids(&nearer, &State::default());
                let before = screen.za_words();
                let (x, y) = place(last);
                screen.draw_ids(&[point(x, y, 900)], &State::default());
                let after = screen.za_words();
                tally.pictures += 1;
                tally.pixels += 32;
                tally.expect(before == [5000] && after == [1000], || {
                    format!("{hidden:?}, {last}: {before:?}, {after:?}")
                });
            }
        }
    }
    Row {
        case: 24,
        name: "za::last_of_thirty_two",
        construction: "a block of 32 pixels at 5000; 31 of them drawn at 1000, then the other at 900; each of the 32, 4 shapes, \
                       both fidelities",
        property: "the word stays 5000, then drops to 1000",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}
