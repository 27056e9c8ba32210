//! Cases 25, 26 and 29: what may be bypassed.

use super::{both, predictions, quad, screen};
use crate::hard::{Row, Tally, compare_on};
use crate::harness::{Hidden, Prediction, Random, Screen, State};
use crate::oracle::canvas::{Canvas, Test};
use crate::oracle::{DepthFunction, Primitive, Vertex};

/// A triangle that covers the 32 pixels of row 0, with depth `left` at x = 0 and `slope` a pixel.
fn ramp(left: i32, slope: i32) -> Primitive {
    let at = |x: i32, y: i32| Vertex::at(x * 256, y * 256, (left + slope * x) as u32);
    Primitive::Triangle([at(0, -100), at(64, -100), at(0, 100)])
}

/// Blocks bypassed and compared, and pixels won, when something is drawn over a block of word 5000.
fn over_5000(screen: &mut Screen, primitive: Primitive, function: DepthFunction) -> [u64; 3] {
    screen.clear();
    screen.draw(&quad([0, 0, 32, 1], 5000), &State::default());
    screen.clear_counts();
    screen.draw(&[primitive], &State::with(function));
    let events = screen.events();
    [events["za.blocks_bypassed"], events["za.blocks_compared"], events["z.writes"]]
}

/// Case 25.
#[must_use]
pub fn equal_to_the_word() -> Row {
    let mut tally = Tally::default();
    for prediction in Prediction::ALL {
        for hidden in both(Hidden { prediction, ..Hidden::za([32, 1]) }) {
            let mut screen = screen([32, 1], hidden);
            // At a pixel's centre the ramp is half a step on; down 10 a pixel, 32 pixels on from 5320 it is 5000.
            let published = prediction == Prediction::BlockLength;
            let falls = if published { [0, 1, 0] } else { [1, 0, 0] };
            for (what, primitive, function, expected) in [
                ("flat, equal, less", ramp(5000, 0), DepthFunction::Less, [0, 1, 0]),
                ("flat, equal, less-equal", ramp(5000, 0), DepthFunction::LessEqual, [0, 1, 32]),
                ("flat, equal, equal", ramp(5000, 0), DepthFunction::Equal, [0, 1, 32]),
                ("flat, one behind, less-equal", ramp(5001, 0), DepthFunction::LessEqual, [1, 0, 0]),
                ("flat, one behind, never", ramp(5001, 0), DepthFunction::Never, [1, 0, 0]),
                ("flat, one behind, greater", ramp(5001, 0), DepthFunction::Greater, [0, 1, 32]),
                ("flat, one behind, not-equal", ramp(5001, 0), DepthFunction::NotEqual, [0, 1, 32]),
                ("rising from the word", ramp(4995, 10), DepthFunction::LessEqual, [0, 1, 1]),
                ("rising from one behind", ramp(4996, 10), DepthFunction::LessEqual, [1, 0, 0]),
                ("falling to the word beyond the block", ramp(5325, -10), DepthFunction::Less, falls),
                ("falling to one behind the word there", ramp(5326, -10), DepthFunction::Less, [1, 0, 0]),
                ("falling to the word at the last pixel", ramp(5315, -10), DepthFunction::LessEqual, [0, 1, 1]),
            ] {
                let found = over_5000(&mut screen, primitive, function);
                tally.pictures += 1;
                tally.pixels += 32;
                tally.expect(found == expected, || format!("{hidden:?}, {what}: {found:?}, expected {expected:?}"));
            }
        }
    }
    Row {
        case: 25,
        name: "za::equal_to_the_word",
        construction: "a block of word 5000, under it planes predicted at 5000 and 5001: flat, rising, falling; 3 predictions, \
                       both fidelities",
        property: "equal is compared (and wins under less-equal), one behind is bypassed, never under a function that passes farther",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Triangles of twice-area 1 u^2 near pixel centres, from depth 0 to the greatest.
fn steepest(random: &mut Random, size: [u32; 2], greatest: u32, count: usize) -> Vec<Primitive> {
    let triangle = |random: &mut Random| {
        let centre = size.map(|side| 256 * random.int(0, side as i32 - 1) + 128);
        let length = random.int(1, 60);
        let turned = random.int(0, 1) == 1;
        let [x, y] = [centre[0] - random.int(0, length), centre[1] - random.int(0, 1)];
        let corner = |along: i32, across: i32, z: u32| {
            let (dx, dy) = if turned { (across, along) } else { (along, across) };
            Vertex::at(x + dx, y + dy, z)
        };
        let middle = random.int(0, 1) as u32 * greatest;
        Primitive::Triangle([corner(0, 0, 0), corner(length, 1, greatest), corner(length - 1, 1, middle)])
    };
    (0..count).map(|_| triangle(random)).collect()
}

/// Case 26.
#[must_use]
pub fn predictor_overflow() -> Row {
    let (mut tally, mut random, mut drawn, mut bypassed) = (Tally::default(), Random::new(26), 0, 0);
    let size = [70, 20];
    for bits in [16, 24, 31] {
        let format = crate::oracle::DepthFormat { bits, fraction: 24 };
        let greatest = format.greatest();
        let middle = crate::harness::depth::survivor(greatest / 2, bits);
        // Between two layers, and a part of it before the first, so that cleared blocks meet them too.
        let layer = quad([0, 0, size[0] as i32, size[1] as i32], middle);
        let steep = steepest(&mut random, size, greatest, 4000);
        let scene = [&steep[..1000], &layer[..], &steep[1000..]].concat();
        for hidden in [[32, 1], [8, 4], [64, 64]].into_iter().flat_map(predictions) {
            let options = crate::harness::Options { depth: format, hidden, ..Default::default() };
            let mut screen = Screen::new(size[0], size[1], &options);
            for function in [DepthFunction::Less, DepthFunction::LessEqual] {
                screen.clear_counts();
                tally.add(&compare_on(&mut screen, &scene, function));
                bypassed += screen.events()["za.blocks_bypassed"];
            }
            drawn = drawn.max(screen.read().drawn());
        }
    }
    Row {
        case: 26,
        name: "za::predictor_overflow",
        construction: "4000 triangles of twice-area 1 u^2 with depth 0 to the maximum, before and behind a layer; 3 depth widths, \
                       3 block shapes, 3 predictions, both fidelities",
        property: "= oracle: no pixel that would have won is bypassed",
        measured: format!("{tally}; {bypassed} blocks bypassed"),
        passed: tally.wrong == 0 && drawn == (size[0] * size[1]) as usize,
    }
}

/// A clear between two draws: colour, depth, rectangle.
type Cut = (Option<u32>, Option<u32>, [u32; 4]);

/// Case 29.
#[must_use]
pub fn no_stale_bypass() -> Row {
    let mut tally = Tally::default();
    let size = [40, 6];
    let all = [0, 0, 40, 6];
    let far = (1 << 24) - 1;
    let cuts: [Option<Cut>; 6] = [
        None,
        Some((None, Some(far), [3, 1, 36, 5])),
        Some((None, Some(50), [3, 1, 36, 5])),
        Some((None, Some(far), all)),
        Some((Some(9), None, [0, 0, 32, 4])),
        Some((Some(0), Some(far), [0, 0, 32, 4])),
    ];
    let layers = [(100, [0, 0, 40, 6]), (700, [0, 0, 37, 6]), (400, [2, 1, 40, 5]), (100, [1, 0, 39, 5])];
    for hidden in [[32, 1], [8, 4]].into_iter().flat_map(|block| both(Hidden::za(block))) {
        let mut screen = screen(size, hidden);
        for (first, write) in DepthFunction::ALL.into_iter().flat_map(|f| [(f, true), (f, false)]) {
            for (cut, second) in cuts.iter().flat_map(|cut| DepthFunction::ALL.map(|second| (cut, second))) {
                screen.clear();
                let mut canvas = Canvas::new(size[0], size[1], screen.options().depth, |[r, g, b, _]| {
                    u32::from_be_bytes([255, r, g, b])
                });
                canvas.clear(all, Some([0; 4]), Some(far));
                for (number, &(z, area)) in (0_u8..).zip(&layers) {
                    let state = match number {
                        0 => State::default(),
                        1 => State { write, ..State::with(first) },
                        _ => State::with(second),
                    };
                    if let (2, Some((colour, depth, area))) = (number, cut) {
                        screen.clear_planes(*colour, *depth, Some(*area));
                        canvas.clear(*area, colour.map(u32::to_le_bytes), *depth);
                    }
                    let colour = [10 * number + 5, 7, 200 - number, 255];
                    let layer = quad(area, z).map(|primitive| coloured(primitive, colour));
                    screen.draw(&layer, &state);
                    let test = Test { function: Some(state.function), write: state.write, scissor: all, stencil: None };
                    canvas.draw(&layer, &test);
                }
                let found = (screen.shown(), screen.depths());
                let wrong = |a: &[u32], b: &[u32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
                let wrong = wrong(&found.0, &canvas.colour) + wrong(&found.1, &canvas.depth);
                tally.pictures += 1;
                tally.pixels += 240;
                tally.note(wrong, || format!("{hidden:?}: {first:?}, write {write}, {cut:?}, {second:?}"));
            }
        }
    }
    Row {
        case: 29,
        name: "za::no_stale_bypass",
        construction: "4 layers; function, writes and a clear of a part or a plane change between them: all pairs of functions, \
                       6 clears, writes on and off, 2 block shapes, both fidelities",
        property: "frame as scanned out and depths = oracle",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

fn coloured(primitive: Primitive, colour: [u8; 4]) -> Primitive {
    match primitive {
        Primitive::Triangle(v) => Primitive::Triangle(v.map(|vertex| vertex.coloured(colour))),
        other => other,
    }
}
