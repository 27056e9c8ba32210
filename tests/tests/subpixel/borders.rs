//! Anti-aliasing at borders alone: where a surface goes on its pixels are the path's, everywhere else they are those of
//! all edges; in every way the card can draw.

use proptest::prop_assert;
use proptest::prop_assert_eq;
use proptest::test_runner::TestCaseError;
use zga_device::Kernel;
use zga_tests::harness::{Edges, Events, Grid, Hidden, Options, Order, Picture, Pixels, Screen, State, Subpixel};
use zga_tests::oracle::{DepthFormat, DepthFunction, Primitive, Vertex};

/// More than a band of lines, and than four chunks of columns.
pub(super) const SIZE: [u32; 2] = [72, 40];
const BACKGROUND: [u8; 4] = [0, 0, 255, 255];

/// Triangles drawn alike.
pub(super) type Draws = Vec<(Vec<Primitive>, State)>;

/// A path, pixel code and host threads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) hidden: Hidden,
    pub(super) kernel: Kernel,
    pub(super) threads: usize,
}

/// The plain Z buffer by the specification.
pub(super) fn specified() -> Way {
    Way { hidden: Hidden::default(), kernel: Kernel::Specification, threads: 1 }
}

/// Draws on a new card after a clear of everything.
pub(super) fn drawn(draws: &[(Vec<Primitive>, State)], subpixel: Subpixel, way: Way) -> (Picture, Events) {
    let Way { hidden, kernel, threads } = way;
    let options = Options { pixels: Pixels::Argb8888, subpixel, hidden, kernel, threads, ..Options::default() };
    let mut screen = Screen::new(SIZE[0], SIZE[1], &options);
    screen.clear_counts();
    screen.clear_planes(Some(u32::from_le_bytes(BACKGROUND)), Some(DepthFormat::default().greatest()), None);
    draws.iter().for_each(|(triangles, state)| screen.draw(triangles, state));
    (screen.read(), screen.events())
}

/// The same without masks.
pub(super) fn without_masks(draws: &Draws) -> Draws {
    draws.iter().map(|(triangles, state)| (triangles.clone(), State { anti_alias: false, ..*state })).collect()
}

/// Every path in both fidelities, with every pixel code and 1 to 3 threads.
fn ways() -> Vec<Way> {
    let paths = [Hidden::default(), Hidden::za([8, 4]), Hidden::systolic(0), Hidden::tile([8, 8])];
    let of = |hidden: Hidden| {
        let kernels = Kernel::available().into_iter().zip((1..=3).cycle());
        let ways = kernels.map(move |(kernel, threads)| Way { hidden, kernel, threads });
        ways.chain([Way { hidden: hidden.clocked(), kernel: Kernel::Best, threads: 2 }])
    };
    paths.into_iter().flat_map(of).collect()
}

/// Draws in every way; all must give the specification's picture and what it counts.
pub(super) fn in_every_way(
    draws: &Draws,
    subpixel: Subpixel,
    ways: &[Way],
) -> Result<(Picture, Events), TestCaseError> {
    let (picture, events) = drawn(draws, subpixel, specified());
    for &way in ways {
        let (found, counted) = drawn(draws, subpixel, way);
        let place = found.colour.iter().zip(&picture.colour).position(|(a, b)| a != b);
        prop_assert!(place.is_none(), "{:?} {:?}: pixel {:?}", subpixel, way, place);
        let differences = super::of_unit(&counted).differences(&super::of_unit(&events));
        prop_assert!(differences.is_empty(), "{:?} {:?} counts {:?}", subpixel, way, differences);
    }
    Ok((picture, events))
}

/// A grid for each way to say which edges.
pub(super) fn both(subpixel: Subpixel) -> [Subpixel; 2] {
    Edges::ALL.map(|edges| Subpixel { edges, ..subpixel })
}

fn smooth() -> State {
    State { gouraud: true, ..State::masked() }
}

/// A ball of shared vertices, each with a colour of its own, or all with one.
fn ball(one: Option<[u8; 4]>) -> Vec<Primitive> {
    const RINGS: usize = 14;
    const PARTS: usize = 22;
    let at = |ring: usize, part: usize| {
        let (down, round) = (ring as f64 / RINGS as f64, (part % PARTS) as f64 / PARTS as f64);
        let (polar, azimuth) = (down * std::f64::consts::PI, round * std::f64::consts::TAU);
        // Leant over, so that no edge lies along an axis and neither pole on the outline.
        let [x, y, z] = [polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin()];
        let [y, z] = [0.8 * y - 0.6 * z, 0.6 * y + 0.8 * z];
        let [x, y] = [0.9 * x - 0.4 * y, 0.4 * x + 0.9 * y];
        let place = |centre: f64, value: f64| (centre + 4500.0 * value).round() as i32;
        let depth = (8_000_000.0 + 3_000_000.0 * z) as u32;
        let level = |value: f64| (130.0 + 60.0 * value) as u8;
        let colour = one.unwrap_or([level(x), level(y), level(z).min(100), 255]);
        Vertex::at(place(9300.0, x), place(5100.0, y), depth).coloured(colour)
    };
    let cells = (0..RINGS).flat_map(|ring| (0..PARTS).map(move |part| (ring, part)));
    let halves = cells.flat_map(|(ring, part)| {
        let [a, b] = [at(ring, part), at(ring, part + 1)];
        let [c, d] = [at(ring + 1, part), at(ring + 1, part + 1)];
        [(ring + 1 < RINGS).then_some([a, d, c]), (ring > 0).then_some([a, b, d])]
    });
    // At a pole a cell is one triangle.
    halves.flatten().map(Primitive::Triangle).collect()
}

#[test]
fn a_ball_at_borders_is_smooth_at_its_outline_and_the_paths_inside() -> Result<(), TestCaseError> {
    let [body, flat] = [vec![(ball(None), smooth())], vec![(ball(Some([255, 0, 0, 255])), smooth())]];
    let (plain, _) = drawn(&without_masks(&body), Subpixel::default(), specified());
    for grid in Grid::ALL {
        let [all, borders] = both(Subpixel::exhaustive(grid));
        let (right, every) = in_every_way(&body, all, &ways())?;
        let (found, counted) = in_every_way(&body, borders, &ways())?;
        let (outline, _) = drawn(&flat, all, specified());

        let mut edges = 0;
        for (k, &pixel) in found.colour.iter().enumerate() {
            prop_assert!(pixel == right.colour[k] || pixel == plain.colour[k], "{grid:?}: pixel {k} is of neither");
            // Of the ball in one colour a pixel of another is covered in part.
            let partly = ![0xFFFF_0000, 0xFF00_00FF].contains(&outline.colour[k]);
            prop_assert!(!partly || pixel == right.colour[k], "{grid:?}: pixel {k} of the outline");
            edges += u64::from(partly);
        }
        prop_assert!(edges > 100, "{grid:?}: an outline of {edges} pixels");
        let [most, some] = [every, counted].map(|events| events["subpixel.pixels_active"]);
        prop_assert!(4 * some < most && some >= edges, "{grid:?}: {some} active of {most}, {edges} of the outline");
        prop_assert_eq!(counted["subpixel.edges"], 3 * ball(None).len() as u64);
        prop_assert_eq!(every["subpixel.edges"] + every["subpixel.edge_peak_bytes"], 0);
    }
    Ok(())
}

/// Two triangles over all of the target; colours of the corners top left, top right, bottom left, the first's; top
/// right, bottom right, bottom left, the second's.
fn quad(first: [[u8; 3]; 3], second: [[u8; 3]; 3]) -> Vec<Primitive> {
    let [right, bottom] = SIZE.map(|side| side as i32 * 256);
    let of = |corners: [(i32, i32); 3], colours: [[u8; 3]; 3]| {
        let corner = |k: usize| {
            let [r, g, b] = colours[k];
            Vertex::at(corners[k].0, corners[k].1, 5000).coloured([r, g, b, 255])
        };
        Primitive::Triangle([corner(0), corner(1), corner(2)])
    };
    vec![of([(0, 0), (right, 0), (0, bottom)], first), of([(right, 0), (right, bottom), (0, bottom)], second)]
}

const RED: [u8; 3] = [255, 0, 0];
const GREEN: [u8; 3] = [0, 255, 0];
const BLUE: [u8; 3] = [0, 0, 255];

#[test]
fn an_edge_with_one_colour_on_both_sides_makes_no_pixel_active() -> Result<(), TestCaseError> {
    let draws = vec![(quad([RED, GREEN, BLUE], [GREEN, RED, BLUE]), smooth())];
    let (plain, _) = drawn(&without_masks(&draws), Subpixel::default(), specified());
    for grid in Grid::ALL {
        for depth in Order::ALL {
            let [all, borders] = both(Subpixel { depth, ..Subpixel::on(grid) });
            let (_, every) = in_every_way(&draws, all, &[])?;
            let (found, counted) = in_every_way(&draws, borders, &ways())?;

            prop_assert_eq!(&found.colour, &plain.colour);
            prop_assert!(every["subpixel.pixels_active"] > 0);
            // Of six edges three wait, one of them is found, two more wait: four, and two primitives.
            let names = ["pixels_active", "edges", "edge_peak_bytes", "masks"];
            let of_unit = names.map(|name| counted[&format!("subpixel.{name}") as &str]);
            prop_assert_eq!(of_unit, [0, 6, 4 * 8 + 2, 2]);
            prop_assert_eq!(counted["cycles.subpixel"], 6 + 2);
        }
    }
    Ok(())
}

#[test]
fn an_edge_that_does_not_go_on_is_anti_aliased() -> Result<(), TestCaseError> {
    let one = [RED, GREEN, BLUE];
    let smooth = smooth();
    let apart = |second: State| {
        let [first, other]: [Primitive; 2] = quad(one, [GREEN, RED, BLUE]).try_into().expect("two triangles");
        vec![(vec![first], smooth), (vec![other], second)]
    };
    let mut deeper = quad(one, [GREEN, RED, BLUE]);
    if let Primitive::Triangle(corners) = &mut deeper[1] {
        corners[0].z += 1;
    }
    let mut turned = quad(one, [GREEN, RED, BLUE]);
    if let Primitive::Triangle(corners) = &mut turned[1] {
        corners.swap(0, 1);
    }
    let cases = [
        ("colours of a crease", vec![(quad(one, [RED, RED, GREEN]), smooth)]),
        ("one colour of an end", vec![(quad(one, [RED, RED, BLUE]), smooth)]),
        ("flat colours", vec![(quad([RED; 3], [GREEN; 3]), State::masked())]),
        ("depth of an end", vec![(deeper, smooth)]),
        ("the other way round", vec![(turned, smooth)]),
        ("flat beside smooth", apart(State::masked())),
        ("another depth test", apart(State { function: DepthFunction::LessEqual, ..smooth })),
    ];
    for (name, draws) in cases {
        for grid in Grid::ALL {
            let [all, borders] = both(Subpixel::exhaustive(grid));
            let (right, every) = in_every_way(&draws, all, &[])?;
            let (found, counted) = in_every_way(&draws, borders, &ways())?;

            prop_assert_eq!(&found.colour, &right.colour, "{} {:?}", name, grid);
            let [every, counted] = [every, counted].map(|events| events["subpixel.pixels_active"]);
            prop_assert!(every == counted && every > 0, "{} {:?}: {} active, {}", name, grid, counted, every);
        }
    }
    // The second draw may be another, if it is drawn alike.
    let (_, counted) = in_every_way(&apart(smooth), Subpixel::exhaustive(Grid::Grid8x8).borders(), &ways())?;
    prop_assert_eq!(counted["subpixel.pixels_active"], 0);
    Ok(())
}
