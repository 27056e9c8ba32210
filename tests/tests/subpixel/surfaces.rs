//! One surface: whatever the order of fragments, no seam, no bleeding, and equal to the oracle.

use proptest::prelude::*;
use zga_tests::harness::{Grid, Options, Order, Path, Pixels, Screen, State, Subpixel};
use zga_tests::oracle::supersample::Level;
use zga_tests::oracle::{DepthFormat, Primitive, Vertex};
use zga_tests::script::smooth::{brush, target};

const SIZE: [u32; 2] = [20, 20];
const BACKGROUND: [u8; 4] = [60, 130, 200, 255];

/// Nearer than the background, wherever in a pixel it is asked for: the way to order must not matter.
fn depth() -> impl Strategy<Value = u32> + Clone {
    0_u32..0x00FF_FFFF
}

/// A field of cells whose corners are moved, but never so far that the surface folds: a convex quadrilateral is cut into
/// two triangles.
fn field() -> impl Strategy<Value = Vec<Primitive>> {
    let corner = (-120_i32..120, -120_i32..120, depth(), any::<[u8; 3]>());
    let cells = (2_usize..9, 2_usize..9, 400_i32..900, [-300_i32..1500, -300_i32..1500]);
    (cells, prop::collection::vec(corner, 81), prop::option::weighted(0.5, any::<[u8; 3]>())).prop_map(
        |((columns, rows, cell, [left, top]), corners, one)| {
            let at = |i: usize, j: usize| {
                let (dx, dy, z, colour) = corners[j * 9 + i];
                let [r, g, b] = one.unwrap_or(colour);
                // At least 400 u from corner to corner, of which at most 2 x 120 are taken away: no fold.
                let [x, y] = [left + i as i32 * cell + dx, top + j as i32 * cell + dy];
                Vertex::at(x, y, z).coloured([r, g, b, 255])
            };
            let cells = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| (i, j)));
            let halves = cells.flat_map(|(i, j)| {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
                // Cut so that both halves turn the same way.
                let turn = |p: Vertex, q: Vertex, r: Vertex| (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
                if turn(a, b, c) > 0 && turn(c, b, d) > 0 {
                    [Primitive::Triangle([a, b, c]), Primitive::Triangle([c, b, d])]
                } else {
                    [Primitive::Triangle([a, b, d]), Primitive::Triangle([a, d, c])]
                }
            });
            halves.collect()
        },
    )
}

/// Closed bodies of one colour: the front and the back cover the same samples, seen from anywhere.
fn body() -> impl Strategy<Value = Vec<Primitive>> {
    let corner = (-300_i32..5400, -300_i32..5400, depth());
    // A double pyramid over a ring of corners; without regard to folds, since all of it is one colour.
    (corner.clone(), corner.clone(), prop::collection::vec(corner, 3..7), any::<[u8; 3]>()).prop_map(
        |(top, bottom, ring, [r, g, b])| {
            let at = |(x, y, z): (i32, i32, u32)| Vertex::at(x, y, z).coloured([r, g, b, 255]);
            let sides = ring.iter().zip(ring.iter().cycle().skip(1));
            let sides = sides.flat_map(|(&p, &q)| [[top, p, q], [bottom, q, p]]);
            sides.map(|corners| Primitive::Triangle(corners.map(at))).collect()
        },
    )
}

/// Triangles over much of a wide target: some cover it from top to bottom over many pixels, as others cross them, lie
/// before or behind; a few are translucent.
fn sheets() -> impl Strategy<Value = Vec<Primitive>> {
    let corner = (-8_000_i32..42_000, -8_000_i32..18_000, depth());
    let flat = prop::option::weighted(0.5, depth());
    let alpha = prop_oneof![3 => Just(255_u8), 1 => 40_u8..220];
    let sheet = ([corner.clone(), corner.clone(), corner], flat, any::<[u8; 3]>(), alpha);
    let sheet = sheet.prop_map(|(corners, flat, [r, g, b], alpha)| {
        Primitive::Triangle(corners.map(|(x, y, z)| Vertex::at(x, y, flat.unwrap_or(z)).coloured([r, g, b, alpha])))
    });
    prop::collection::vec(sheet, 1..7)
}

/// More than a band of lines, and than four chunks of columns.
const WIDE: [u32; 2] = [130, 35];

fn screen(size: [u32; 2], subpixel: Subpixel, path: Path) -> Screen {
    let hidden = zga_tests::harness::Hidden::on(path);
    Screen::new(size[0], size[1], &Options { pixels: Pixels::Argb8888, subpixel, hidden, ..Options::default() })
}

/// Red, green, blue, alpha of each pixel on the card, and the oracle's.
fn drawn(
    size: [u32; 2],
    scene: &[Primitive],
    state: &State,
    (subpixel, path): (Subpixel, Path),
) -> (Vec<[u8; 4]>, Vec<[Level; 4]>) {
    let mut screen = screen(size, subpixel, path);
    let far = DepthFormat::default().greatest();
    screen.clear_planes(Some(u32::from_le_bytes(BACKGROUND)), Some(far), None);
    screen.draw(scene, state);
    let rgba = |pixel: u32| {
        let [a, r, g, b] = pixel.to_be_bytes();
        [r, g, b, a]
    };
    let mut oracle = target(size, DepthFormat::default(), &subpixel);
    oracle.clear([0, 0, size[0], size[1]], Some(BACKGROUND), Some(far));
    oracle.draw(scene, &brush(state, size));
    (screen.read().colour.into_iter().map(rgba).collect(), oracle.end())
}

fn setting() -> impl Strategy<Value = (Subpixel, Path)> {
    let path = prop::sample::select(Path::ALL.to_vec());
    (prop::sample::select(Grid::ALL.to_vec()), prop::sample::select(Order::ALL.to_vec()), path)
        .prop_map(|(grid, depth, path)| (Subpixel { depth, ..Subpixel::on(grid) }, path))
}

proptest! {
    #![proptest_config(super::cases(150))]

    #[test]
    fn draw_any_surface_without_folds_every_order_equals_the_oracle(scene in field(), (subpixel, path) in setting()) {
        let (found, right) = drawn(SIZE, &scene, &State::masked(), (subpixel, path));

        for (k, (pixel, levels)) in found.iter().zip(&right).enumerate() {
            prop_assert!(pixel.iter().zip(levels).all(|(c, level)| level.admits(*c)), "{}: {:?}, must be {:?}", k, pixel, levels);
        }
    }

    #[test]
    fn draw_any_closed_body_has_no_seam_and_equals_the_oracle(scene in body(), (subpixel, path) in setting()) {
        let (found, right) = drawn(SIZE, &scene, &State::masked(), (subpixel, path));

        let own = scene[0].vertices()[0].colour;
        for (k, (pixel, levels)) in found.iter().zip(&right).enumerate() {
            let between = (0..4).all(|c| (own[c].min(BACKGROUND[c])..=own[c].max(BACKGROUND[c])).contains(&pixel[c]));
            prop_assert!(between, "{}: {:?} is darker or lighter than {:?} and the background", k, pixel, own);
            prop_assert!(pixel.iter().zip(levels).all(|(c, level)| level.admits(*c)), "{}: {:?}, must be {:?}", k, pixel, levels);
        }
    }

    #[test]
    fn draw_any_wide_sheets_equal_the_oracle(scene in sheets(), (subpixel, path) in setting()) {
        let subpixel = Subpixel { depth: Order::Exhaustive, ..subpixel };
        let state = State { blend: true, ..State::masked() };
        let (found, right) = drawn(WIDE, &scene, &state, (subpixel, path));

        for (k, (pixel, levels)) in found.iter().zip(&right).enumerate() {
            prop_assert!(pixel.iter().zip(levels).all(|(c, level)| level.admits(*c)), "{}: {:?}, must be {:?}", k, pixel, levels);
        }
    }

    #[test]
    fn draw_disjoint_lines_and_points_every_order_equals_the_oracle(
        (subpixel, path) in setting(), lines in prop::collection::vec((0_i32..200, -250_i32..250, depth(), depth()), 5),
        width in 1_u32..0x300,
    ) {
        // Bands 4 px apart, lines up to 3 px wide that rise by less than a px; a point in front of each.
        let scene: Vec<Primitive> = (0..).zip(&lines).flat_map(|(k, &(x, rise, z0, z1))| {
            let y = k * 1024 + 512;
            let at = |x: i32, y: i32, z: u32| Vertex::at(x, y, z).coloured([250, 250, 10 * k as u8, 255]);
            let point = at(x, y, z1);
            [Primitive::Point(point), Primitive::Line([at(x + 900, y, z0), at(x + 3700, y + rise / 2, z1)])]
        }).collect();
        let state = State { line_width: width, point_size: width, ..State::masked() };
        let mut screen = screen(SIZE, subpixel, path);
        screen.draw(&scene, &state);
        let mut oracle = target(SIZE, DepthFormat::default(), &subpixel);
        oracle.draw(&scene, &brush(&state, SIZE));

        for (k, (pixel, levels)) in screen.read().colour.iter().zip(oracle.end()).enumerate() {
            let [a, r, g, b] = pixel.to_be_bytes();
            prop_assert!([r, g, b, a].iter().zip(&levels).all(|(c, level)| level.admits(*c)), "{}: {:08x}, must be {:?}", k, pixel, levels);
        }
    }
}

#[test]
fn draw_line_of_two_colours_is_flat_in_that_of_its_first_end() {
    let ends =
        [Vertex::at(300, 300, 5).coloured([255, 0, 0, 255]), Vertex::at(4000, 2200, 5).coloured([0, 255, 0, 255])];
    for grid in Grid::ALL {
        let mut screen = screen(SIZE, Subpixel::exhaustive(grid), Path::ZBuffer);
        screen.draw(&[Primitive::Line(ends)], &State { line_width: 0x300, ..State::masked() });

        let picture = screen.read().colour;

        assert!(picture.contains(&0xFFFF_0000), "{grid:?}: some pixels are full");
        assert!(picture.iter().all(|&pixel| pixel & 0x0000_FFFF == 0), "{grid:?}: only red");
    }
}
