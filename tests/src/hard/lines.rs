//! Cases 57 to 59: lines.

use super::{Row, Tally, compare_on, fragments};
use crate::harness::screen::raw;
use crate::harness::{Options, Random, Screen, State, Topology};
use crate::oracle::raster::line_covers;
use crate::oracle::{DepthFormat, DepthFunction, Primitive, Vertex, draw};

fn line(from: (i32, i32), to: (i32, i32)) -> Primitive {
    Primitive::Line([Vertex::at(from.0, from.1, 5), Vertex::at(to.0, to.1, 900)])
}

/// Case 57.
#[must_use]
pub fn zero_length() -> Row {
    let mut screen = Screen::new(16, 16, &Options::default());
    let places = || (0..17 * 4).flat_map(|y| (0..17 * 4).map(move |x| (x * 64 - 64, y * 64 - 64)));
    let scene: Vec<Primitive> = places().map(|p| line(p, p)).collect();
    let separate = fragments(&mut screen, &scene);
    // Ends that differ by less than half a u, and fall together in the snap.
    screen.clear_counts();
    let pairs: Vec<_> = places()
        .flat_map(|(x, y)| {
            let place = |off: f32| crate::harness::RawVertex {
                position: [x as f32 / 256.0 + off, y as f32 / 256.0 - off, 0.5],
                colour: 1,
            };
            [place(0.0), place(0.0009)]
        })
        .collect();
    let state = State::with(DepthFunction::Always);
    screen.draw_raw(Topology::Lines, &pairs, None, &state);
    let strip = [raw(&Vertex::at(1000, 1000, 5), 24, 1); 50];
    screen.draw_raw(Topology::LineStrip, &strip, None, &state);
    let snapped = (screen.read().drawn(), screen.counts().reads);
    Row {
        case: 57,
        name: "lines::zero_length",
        construction: "4624 lines from a point to itself, on and off centres and diamond corners; 4624 whose ends fall together in \
                       the snap; a strip of 50 equal vertices",
        property: "no pixels",
        measured: format!("{} and {} pixels, {} and {} fragments", separate.0, snapped.0, separate.1, snapped.1),
        passed: separate == (0, 0) && snapped == (0, 0),
    }
}

/// Case 58.
#[must_use]
pub fn diamond_corners() -> Row {
    // Each line in a cell of its own: 24 x 24 px, the start near the middle.
    const CELL: i32 = 24 * 256;
    let starts =
        [(0, 0), (128, 0), (0, 128), (128, 128), (64, 64), (192, 64), (64, 192), (192, 192), (1, 128), (128, 1)];
    let mut screen = Screen::new(25 * 24, 25 * 24, &Options::default());
    let (mut tally, mut lines) = (Tally::default(), 0);
    for start in starts {
        for unit in [128, 64] {
            // All ends on the lattice of diamond corners (or of their edges' middles) in a square of 12 x 12.
            for backward in [false, true] {
                let scene: Vec<Primitive> = (0..625)
                    .map(|k| {
                        let cell = (k % 25 * CELL + CELL / 2, k / 25 * CELL + CELL / 2);
                        let from = (cell.0 + start.0, cell.1 + start.1);
                        let to = (from.0 + (k % 25 - 12) * unit, from.1 + (k / 25 - 12) * unit);
                        if backward { line(to, from) } else { line(from, to) }
                    })
                    .collect();
                lines += scene.len();
                tally.add(&compare_on(&mut screen, &scene, DepthFunction::Always));
            }
        }
    }
    Row {
        case: 58,
        name: "lines::diamond_corners",
        construction: "25000 lines between diamond corners, middles of their sides and 1 u beside them, 8 octants, both directions",
        property: "equal to the oracle",
        measured: format!("{tally}; {lines} lines"),
        passed: tally.wrong == 0 && lines == 25_000,
    }
}

/// Case 59.
#[must_use]
pub fn polylines_and_the_longest_line() -> Row {
    let (mut random, mut tally) = (Random::new(59), Tally::default());
    let mut screen = Screen::new(200, 60, &Options::default());
    for number in 0..200 {
        // Monotone in x and flatter than a diagonal: no pixel is met twice but at a shared end.
        let unit = [1, 64, 128, 256][number % 4];
        let mut vertices = vec![Vertex::at(200, 30 * 256, 5)];
        while let Some(last) = vertices.last().filter(|v| v.x < 190 * 256) {
            let dx = (random.int(1, 5000) / unit).max(1) * unit;
            let dy = (random.int(-dx, dx) / unit * unit).clamp(-last.y, 60 * 256 - last.y);
            vertices.push(Vertex::at(last.x + dx, last.y + dy, 5));
        }
        if number % 2 == 1 {
            vertices.reverse();
        }
        screen.clear();
        screen.clear_counts();
        let packed: Vec<_> = vertices.iter().map(|v| raw(v, 24, screen.options().pixels.colour_of(1))).collect();
        screen.draw_raw(Topology::LineStrip, &packed, None, &State::with(DepthFunction::Always));
        let (picture, counts) = (screen.read(), screen.counts());
        let pieces: Vec<Primitive> = vertices.windows(2).map(|w| Primitive::Line([w[0], w[1]])).collect();
        let image = draw(200, 60, &pieces, DepthFormat::default(), DepthFunction::Always);
        let drawn = picture.drawn();
        tally.pictures += 1;
        tally.pixels += picture.colour.len();
        let wrong = picture
            .winners()
            .iter()
            .zip(&image.winner)
            .filter(|(card, oracle)| card.is_some() != oracle.is_some())
            .count();
        tally.note(wrong, || format!("polyline {number}: {wrong} pixels are not the oracle's"));
        tally.expect(counts.reads == drawn as u64, || {
            format!("polyline {number}: {} fragments on {drawn} pixels", counts.reads)
        });
    }
    // dy = 1 u and 1 px, through centres, diamond corners and between; both ways, and along the other axis.
    let mut longest = 0;
    for size in [[16_384, 8], [8, 16_384]] {
        let mut screen = Screen::new(size[0], size[1], &Options::default());
        for (y, dy) in [0, 127, 128, 129, 255, 256, 1000].into_iter().flat_map(|y| [1, -1, 256, -256].map(|dy| (y, dy)))
        {
            let place = |along: i32, across: i32| if size[1] == 8 { (along, across) } else { (across, along) };
            let ends = [place(0, y), place(16_384 * 256, y + dy)];
            for scene in [[line(ends[0], ends[1])], [line(ends[1], ends[0])]] {
                tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
                let Primitive::Line(v) = scene[0] else { continue };
                longest += (0..16_384)
                    .filter(|&k| {
                        let (i, j) = place(k, (y + dy / 2) >> 8);
                        line_covers(&v, i, j)
                    })
                    .count();
            }
        }
    }
    Row {
        case: 59,
        name: "lines::polylines_and_the_longest_line",
        construction: "200 polylines as strips; lines of 16384 px with dy = +-1 u and +-1 px at 7 heights, both directions, along \
                       both axes; strips of 16384 x 8 and 8 x 16384",
        property: "polylines draw every pixel once, shared end points too; equal to the oracle",
        measured: format!("{tally}; {longest} pixels of the long lines on their middle row"),
        passed: tally.wrong == 0 && longest > 16_384,
    }
}
