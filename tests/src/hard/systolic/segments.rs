//! Cases 32, 33, 34 and 36: single segments.

use super::{clocks, drawn, point, screen, segment, ways};
use crate::hard::{Row, Tally};
use crate::harness::{Random, State};
use crate::oracle::{DepthFormat, DepthFunction, Primitive, Vertex};

/// Case 32.
#[must_use]
pub fn one_element() -> Row {
    let mut tally = Tally::default();
    for way in ways() {
        let mut screen = screen([17, 3], DepthFormat::default(), way);
        for x in 0..17 {
            // A point, a line and a triangle, each over one pixel; then a triangle and a line between centres.
            let at = |x: i32, y: i32| Vertex::at(x, y, 9);
            let (left, top) = (256 * x, 256);
            let small = [at(left + 100, top + 100), at(left + 200, top + 100), at(left + 100, top + 200)];
            let none = [at(left + 140, top + 140), at(left + 250, top + 140), at(left + 140, top + 250)];
            let covered = [point(x, 1, 9), segment(x, x + 1, 1, [9, 9]), Primitive::Triangle(small)];
            for one in covered {
                let flow = drawn(&mut screen, &[one], DepthFunction::Less, &mut tally);
                let written = screen.read().drawn();
                tally.expect(flow.tokens == 1 && written == 1, || {
                    format!("{way:?}, pixel {x}: {} tokens, {written} pixels", flow.tokens)
                });
            }
            let beside = at(left + 20, top + 5);
            let empty = [Primitive::Triangle(none), Primitive::Line([beside, beside])];
            let flow = drawn(&mut screen, &empty, DepthFunction::Always, &mut tally);
            let written = screen.read().drawn();
            tally.expect(flow.tokens == 0 && written == 0, || {
                format!("{way:?}, nothing at {x}: {} tokens, {written} pixels", flow.tokens)
            });
            let expected = clocks(&[0; 3], 17, way.0.variant & 8 != 0);
            tally.expect(flow.clocks == expected, || format!("{way:?}: {} clocks, not {expected}", flow.clocks));
        }
    }
    Row {
        case: 32,
        name: "systolic::one_element",
        construction: "point, line and triangle over one pixel, at each of 17 elements; triangle and line that cover none; all \
                       variants, both fidelities, with and without a Z buffer",
        property: "one token and one write; no token and none",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 33.
#[must_use]
pub fn equal_depths() -> Row {
    let mut tally = Tally::default();
    let z = 5000;
    // The same, a part of it, and beyond it on both sides; flat and tilted.
    let flat = [(2, 14), (2, 14), (5, 9), (0, 16)].map(|(left, right)| segment(left, right, 1, [z, z]));
    let tilted = [segment(2, 14, 2, [z, z + 120]), segment(2, 14, 2, [z, z + 120]), segment(14, 2, 2, [z + 120, z])];
    for way in ways() {
        let mut screen = screen([16, 4], DepthFormat::default(), way);
        for function in DepthFunction::ALL {
            for scene in [&flat[..], &flat[..2], &tilted, &[flat[1], flat[0]]] {
                drawn(&mut screen, scene, function, &mut tally);
            }
            drawn(&mut screen, &flat[..2], function, &mut tally);
            let winner = screen.read().winners()[16 + 7];
            let holds = match function {
                DepthFunction::Less | DepthFunction::NotEqual => winner == Some(0),
                DepthFunction::LessEqual | DepthFunction::Always => winner == Some(1),
                _ => winner.is_none(),
            };
            tally.expect(holds, || format!("{way:?}, {function:?}: {winner:?} won"));
        }
    }
    Row {
        case: 33,
        name: "systolic::equal_depths",
        construction: "2 to 4 tokens of equal depths back to back; 8 functions, all variants, both fidelities, with and without a \
                       Z buffer",
        property: "the first wins under less, the last under less-equal; = oracle",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 34.
#[must_use]
pub fn beyond_both_ends() -> Row {
    let mut tally = Tally::default();
    let (width, slope, start) = (24, 1000, 100_000);
    for way in ways() {
        let mut screen = screen([width as u32, 3], DepthFormat::default(), way);
        for sign in [1, -1] {
            // From pixel -5 to W + 5; depth at the centre of pixel x is start + slope (x + 5).
            let depth = |x: i32| (start + sign * slope * (x + 5)) as u32;
            let at = |x: i32, y: i32| Vertex::at(256 * x + 128, y, depth(x));
            let (left, right) = (-5, width + 5);
            let line = segment(left, right, 1, [depth(left), depth(right)]);
            // Its right side passes the row where the line ends.
            let triangle = Primitive::Triangle([at(left, 128), at(right + 34, 384), at(left, 640)]);
            for primitive in [line, triangle] {
                let flow = drawn(&mut screen, &[primitive], DepthFunction::Less, &mut tally);
                tally.expect(flow.tokens == 1 || primitive == triangle, || format!("{way:?}: {} tokens", flow.tokens));
                let picture = screen.read();
                let first = picture.at(0, 1);
                tally.expect(!way.1 || first.1 == depth(0), || {
                    format!("{way:?}: element 0 starts at {}, not {}", first.1, depth(0))
                });
                tally.expect((0..width as u32).all(|x| picture.at(x, 1).0 & 0x00FF_FFFF == 1), || {
                    format!("{way:?}: row not covered")
                });
            }
            // The scissor cuts as element 0 does.
            screen.clear();
            screen.draw_ids(&[line], &State { scissor: Some([7, 0, 20, 3]), ..State::default() });
            let picture = screen.read();
            for x in 0..width {
                let expected = if (7..20).contains(&x) { (1, depth(x)) } else { (0, (1 << 24) - 1) };
                let (colour, z) = picture.at(x as u32, 1);
                let holds = colour & 0x00FF_FFFF == expected.0 && (!way.1 || z == expected.1);
                tally.expect(holds, || format!("{way:?}, scissor, {x}: {:?}", (colour, z)));
            }
        }
    }
    Row {
        case: 34,
        name: "systolic::beyond_both_ends",
        construction: "line and triangle from pixel -5 to W + 5, rising and falling; cut by a scissor; all variants, both \
                       fidelities, with and without a Z buffer",
        property: "element 0 starts at Z + 5 Z', the scissor's first at Z + 12 Z'; = oracle",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 36.
#[must_use]
pub fn extreme_gradients() -> Row {
    let (mut tally, mut random) = (Tally::default(), Random::new(36));
    let size = [40_u32, 12];
    for bits in [16, 24, 31] {
        let format = DepthFormat { bits, fraction: 24 };
        let greatest = format.greatest();
        let scene: Vec<Primitive> = (0..300)
            .map(|number| {
                let [x, y] = size.map(|side| 256 * random.int(0, side as i32 - 1) + 128);
                let at = |dx: i32, dy: i32, z: u32| Vertex::at(x + dx, y + dy, z);
                let reach = random.int(1, 3000);
                match number % 4 {
                    // Twice-area 1 u^2: the steepest plane there is; gradients wrap.
                    0 => Primitive::Triangle([at(0, 0, 0), at(reach, 1, greatest), at(reach - 1, 1, greatest)]),
                    1 => Primitive::Triangle([at(0, 0, greatest), at(-reach, 1, 0), at(1 - reach, 1, greatest)]),
                    // Thin ones: steep, but as deep as the format is wide.
                    2 => Primitive::Triangle([at(-reach, -2, 0), at(reach, 2, greatest), at(0, 300, 0)]),
                    _ => Primitive::Line([at(-1, -reach / 64, 0), at(1, reach / 64, greatest)]),
                }
            })
            .collect();
        let mut counted = Vec::new();
        for way in ways() {
            let mut screen = screen(size, format, way);
            for function in [DepthFunction::Less, DepthFunction::Greater, DepthFunction::Always] {
                let flow = drawn(&mut screen, &scene, function, &mut tally);
                counted.push((way.0.variant & 8, flow.tokens, flow.clocks));
            }
        }
        counted.sort_unstable();
        counted.dedup();
        tally.expect(counted.len() == 2, || format!("{bits} bits: tokens and clocks {counted:?}"));
    }
    Row {
        case: 36,
        name: "systolic::extreme_gradients",
        construction: "300 triangles and lines with depths 0 to the maximum over a few u, twice-areas from 1 u^2; 3 depth widths, \
                       3 functions, all variants, both fidelities, with and without a Z buffer",
        property: "clocked = functional = oracle, the same tokens and clocks",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}
