//! Cases 35 and 37: many tokens.

use super::{clocks, drawn, point, screen, segment, ways};
use crate::hard::{Row, Tally};
use crate::harness::Random;
use crate::oracle::{DepthFormat, DepthFunction, Primitive};

/// Case 35.
#[must_use]
pub fn refresh_with_tokens_in_flight() -> Row {
    let (mut tally, mut random, mut tokens) = (Tally::default(), Random::new(35), 0);
    let width = 16_i32;
    // As many tokens on a line as there are elements and a few more, so that 0..=W of them are in flight behind a
    // refresh token and before it; rising, falling, all or none.
    let lines = 2 * (width + 4);
    let counts: [Vec<i32>; 4] = [
        (0..lines).collect(),
        (0..lines).rev().collect(),
        (0..lines).map(|y| if y % 2 == 0 { 0 } else { width + 3 }).collect(),
        (0..lines).map(|_| random.int(0, width)).collect(),
    ];
    for counts in counts {
        let mut scene: Vec<Primitive> = Vec::new();
        for (y, &count) in (0..).zip(&counts) {
            for number in 0..count {
                let (left, z) = (random.int(-2, width - 1), random.depth(1 << 20));
                let right = left + random.int(1, width);
                scene.push(match number % 3 {
                    0 => segment(left, right.max(1), y, [z, random.depth(1 << 20)]),
                    1 => point(left.max(0), y, z),
                    // At the last element, where a refresh token is last.
                    _ => segment(width - 1, width + 3, y, [z, z]),
                });
            }
        }
        // Submission goes across lines.
        for place in (1..scene.len()).rev() {
            scene.swap(place, random.int(0, place as i32) as usize);
        }
        let each: Vec<u64> = counts.iter().map(|&count| count as u64).collect();
        for way in ways() {
            let mut screen = screen([width as u32, lines as u32], DepthFormat::default(), way);
            let flow = drawn(&mut screen, &scene, DepthFunction::Less, &mut tally);
            let expected = (each.iter().sum(), clocks(&each, width as u64, way.0.variant & 8 != 0));
            tally.expect((flow.tokens, flow.clocks) == expected, || {
                format!("{way:?}: {} tokens, {} clocks, not {expected:?}", flow.tokens, flow.clocks)
            });
            tokens += flow.tokens;
        }
    }
    Row {
        case: 35,
        name: "systolic::refresh_with_tokens_in_flight",
        construction: "16 elements, 40 lines with 0 to 39 tokens each: rising, falling, none and many in turn, random; all variants, \
                       both fidelities, with and without a Z buffer",
        property: "none lost or doubled: = oracle, tokens and clocks as computed",
        measured: format!("{tally}, {tokens} tokens"),
        passed: tally.wrong == 0,
    }
}

/// Case 37.
#[must_use]
pub fn disjoint_segments_permuted() -> Row {
    let (mut tally, mut random) = (Tally::default(), Random::new(37));
    let (width, height) = (61, 5);
    let mut segments = Vec::new();
    for y in 0..height {
        let mut left = random.int(-3, 2);
        while left < width {
            let right = left + random.int(1, 9);
            segments.push((left, right, y, [random.depth(1 << 24) & 0x00FF_FFFF, random.depth((1 << 24) - 1)]));
            // Now and then they touch.
            left = right + random.int(0, 3);
        }
    }
    // Identities must not follow the order: colours tell the segment.
    let scene: Vec<Primitive> = (0_u32..)
        .zip(&segments)
        .map(|(number, &(left, right, y, depths))| match segment(left, right, y, depths) {
            Primitive::Line(v) => Primitive::Line(v.map(|vertex| vertex.coloured((7 * number + 1).to_le_bytes()))),
            other => other,
        })
        .collect();
    for way in ways() {
        let mut screen = screen([width as u32, height as u32], DepthFormat::default(), way);
        let draw = |screen: &mut super::Screen, scene: &[Primitive]| {
            screen.end();
            screen.clear_counts();
            screen.clear();
            screen.draw(scene, &super::State::default());
            let shown = {
                screen.end();
                screen.shown()
            };
            let events = screen.events();
            (shown, way.1.then(|| screen.depths()), [events["systolic.tokens"], events["systolic.clocks"]])
        };
        let reference = draw(&mut screen, &scene);
        drawn(&mut screen, &scene, DepthFunction::Less, &mut tally);
        for _ in 0..8 {
            let mut permuted = scene.clone();
            for place in (1..permuted.len()).rev() {
                permuted.swap(place, random.int(0, place as i32) as usize);
            }
            let found = draw(&mut screen, &permuted);
            tally.pictures += 1;
            tally.pixels += found.0.len();
            tally.expect(found == reference, || format!("{way:?}: another line"));
        }
    }
    Row {
        case: 37,
        name: "systolic::disjoint_segments_permuted",
        construction: "disjoint segments on 5 lines of 61 pixels, some touching, in 8 random orders; all variants, both fidelities, \
                       with and without a Z buffer",
        property: "same lines, same depths, same tokens and clocks; = oracle",
        measured: format!("{} segments, {tally}", segments.len()),
        passed: tally.wrong == 0,
    }
}
