//! Which pixels the unit takes up, and what it leaves alone.

use zga_tests::harness::{Events, Grid, Hidden, Options, Order, Path, Picture, Screen, State, Subpixel};
use zga_tests::oracle::{DepthFunction, Primitive, Vertex};

const SIDE: i32 = 32;

fn triangle(corners: [(i32, i32); 3], z: u32) -> Primitive {
    Primitive::Triangle(corners.map(|(x, y)| Vertex::at(x, y, z).coloured([200, 100, 50, 255])))
}

/// Two triangles over all of the target, one depth.
fn quad(z: u32) -> [Primitive; 2] {
    let far = SIDE * 256;
    [triangle([(0, 0), (far, 0), (0, far)], z), triangle([(0, far), (far, 0), (far, far)], z)]
}

/// One triangle over all of the target.
fn cover(z: u32) -> Primitive {
    triangle([(-256, -256), (SIDE * 768, -256), (-256, SIDE * 768)], z)
}

/// Draws on a new card and counts.
fn events(subpixel: Subpixel, path: Path, draw: impl Fn(&mut Screen)) -> (Picture, Events) {
    let options = Options { subpixel, hidden: Hidden::on(path), ..Options::default() };
    let mut screen = Screen::new(SIDE as u32, SIDE as u32, &options);
    screen.clear();
    screen.clear_counts();
    draw(&mut screen);
    (screen.read(), screen.events())
}

/// Every grid, order and path.
fn everywhere() -> impl Iterator<Item = (Subpixel, Path)> {
    Grid::ALL.into_iter().flat_map(|grid| {
        Order::ALL
            .into_iter()
            .flat_map(move |depth| Path::ALL.map(|path| (Subpixel { depth, ..Subpixel::on(grid) }, path)))
    })
}

#[test]
fn one_triangle_over_everything_makes_no_pixel_active() {
    for (subpixel, path) in everywhere() {
        let (picture, events) = events(subpixel, path, |screen| screen.draw(&[cover(5)], &State::masked()));

        assert_eq!(events["subpixel.pixels_active"], 0, "{subpixel:?} {path:?}");
        assert!(picture.colour.iter().all(|&pixel| pixel == 0xFFC8_6432), "{subpixel:?} {path:?}");
    }
}

/// The two triangles of [`quad`] in two colours.
fn two_colours(z: u32) -> [Primitive; 2] {
    let [mut first, second] = quad(z);
    if let Primitive::Triangle(vertices) = &mut first {
        *vertices = vertices.map(|vertex| vertex.coloured([0, 0, 0, 255]));
    }
    [first, second]
}

#[test]
fn a_quad_of_one_colour_over_everything_makes_no_pixel_active() {
    for (subpixel, path) in everywhere() {
        let (picture, events) = events(subpixel, path, |screen| screen.draw(&quad(5), &State::masked()));

        // The edges of two triangles begin; nothing else happens.
        let of_unit = ["cycles.subpixel", "subpixel.masks", "subpixel.pixels_active", "subpixel.fragments"];
        assert_eq!(of_unit.map(|name| events[name]), [2, 2, 0, 0], "{subpixel:?} {path:?}");
        assert!(picture.colour.iter().all(|&pixel| pixel == 0xFFC8_6432), "{subpixel:?} {path:?}");
    }
}

#[test]
fn a_quad_of_two_colours_over_everything_makes_only_its_diagonal_active() {
    for (subpixel, path) in everywhere() {
        let (_, events) = events(subpixel, path, |screen| screen.draw(&two_colours(5), &State::masked()));

        assert_eq!(events["subpixel.pixels_active"], SIDE as u64, "{subpixel:?} {path:?}");
    }
}

#[test]
fn triangles_that_cover_a_pixel_together_hide_what_lies_behind() {
    for (subpixel, path) in everywhere() {
        // Behind the quad's diagonal lies another edge, submitted before it or after.
        let behind = [triangle([(0, 0), (SIDE * 256, 0), (0, SIDE * 256)], 9000)];
        let drawn = |order: [&[Primitive]; 2]| {
            events(subpixel, path, |screen| order.iter().for_each(|part| screen.draw(part, &State::masked()))).1
        };
        let front = two_colours(5);
        let [alone, before, after] = [[&front[..], &[]], [&behind, &front], [&front, &behind]].map(drawn);

        let stored = [alone, before, after].map(|events| events["subpixel.fragments"]);
        assert_eq!(stored, [2 * SIDE as u64; 3], "{subpixel:?} {path:?}");
    }
}

#[test]
fn what_a_nearer_cover_hides_makes_no_pixel_active() {
    for (subpixel, path) in everywhere() {
        let (picture, events) = events(subpixel, path, |screen| {
            screen.draw(&quad(9000), &State::masked());
            screen.draw(&[cover(5)], &State::masked());
        });

        assert_eq!(events["subpixel.pixels_active"], 0, "{subpixel:?} {path:?}");
        assert!(picture.colour.iter().all(|&pixel| pixel == 0xFFC8_6432), "{subpixel:?} {path:?}");
    }
}

#[test]
fn draws_without_masks_or_layers_leave_the_unit_alone() {
    for (subpixel, path) in everywhere() {
        let draw = |screen: &mut Screen| screen.draw(&quad(5), &State::with(DepthFunction::LessEqual));
        let (with, counted) = events(subpixel, path, draw);
        let (without, _) = events(Subpixel::default(), path, draw);

        assert_eq!((with.colour, with.depth), (without.colour, without.depth), "{subpixel:?} {path:?}");
        let unit = ["cycles.subpixel", "subpixel.masks", "subpixel.pixels_active", "subpixel.fragments"];
        assert_eq!(unit.map(|name| counted[name]), [0; 4], "{subpixel:?} {path:?}");
    }
}

#[test]
fn layers_make_the_pixels_active_that_show_them() {
    for (subpixel, path) in everywhere() {
        let layer = |z: u32| {
            let far = 8 * 256;
            let corners =
                [(0, 0), (far, 0), (0, far), (far, far)].map(|(x, y)| Vertex::at(x, y, z).coloured([0, 0, 255, 128]));
            [
                Primitive::Triangle([corners[0], corners[1], corners[2]]),
                Primitive::Triangle([corners[2], corners[1], corners[3]]),
            ]
        };
        let state = State { blend: true, ..State::masked() };
        let (_, shown) = events(subpixel, path, |screen| {
            screen.draw(&[cover(500)], &State::masked());
            screen.draw(&layer(5), &state);
        });
        let (_, hidden) = events(subpixel, path, |screen| {
            screen.draw(&layer(900), &state);
            screen.draw(&[cover(500)], &State::masked());
        });

        let active = [shown, hidden].map(|events| events["subpixel.pixels_active"]);
        assert_eq!(active, [64, 0], "{subpixel:?} {path:?}");
    }
}

#[test]
fn lists_that_the_pool_has_no_room_for_leave_the_paths_pixels_and_are_counted() {
    for (subpixel, path) in everywhere() {
        // Each line has one pixel on the diagonal, with two fragments.
        let with_pool = |pool: u32| {
            let (picture, events) = events(Subpixel { pool, ..subpixel }, path, |screen| {
                screen.draw(&two_colours(5), &State::masked());
            });
            let of_unit = ["pixels_active", "pixels_degraded", "fragments", "pool_peak_bytes"];
            (picture.colour, of_unit.map(|name| events[&format!("subpixel.{name}") as &str]))
        };
        let (smooth, roomy) = with_pool(2);
        let (plain, tight) = with_pool(1);

        let lines = SIDE as u64;
        assert_eq!(roomy, [lines, 0, 2 * lines, 32], "{subpixel:?} {path:?}");
        assert_eq!(tight, [0, lines, 0, 0], "{subpixel:?} {path:?}");
        assert!(plain.iter().all(|&pixel| pixel == 0xFF00_0000 || pixel == 0xFFC8_6432), "{subpixel:?} {path:?}");
        assert_eq!(smooth.iter().zip(&plain).filter(|(a, b)| a != b).count(), SIDE as usize, "{subpixel:?} {path:?}");
    }
}
