//! Pictures that can be worked out by hand, and the older oracle's.

use super::super::super::canvas::Canvas;
use super::super::super::raster::covers;
use super::super::super::{Vertex, draw};
use super::*;
use proptest::prelude::*;

const ALL: Area = [0, 0, 99, 99];
const LESS: Test = Test { function: Some(DepthFunction::Less), write: true, scissor: ALL, stencil: None };

fn layer(mode: u32) -> Brush {
    Brush { test: LESS, mode: Some(mode) }
}

const OPAQUE: Brush = Brush { test: LESS, mode: None };

/// Over everything.
fn sheet(z: u32) -> Primitive {
    Primitive::Triangle([(0, 0), (9000, 0), (0, 9000)].map(|(x, y)| Vertex::at(x, y, z)))
}

fn plain(colour: Colour) -> impl Fn(i32, i32) -> Fragment {
    move |_, _| Fragment { shade: Shade::exactly(colour), hole: false, torn: false }
}

fn painting() -> Painting {
    Painting::new([2, 1], DepthFormat::default(), |colour| colour)
}

fn first(painting: &mut Painting) -> Colour {
    painting.end()[0].exact().unwrap()
}

#[test]
fn end_layers_are_composed_from_the_farthest_whatever_the_order() {
    let sheets = [(9, [255, 0, 0, 51]), (3, [0, 255, 0, 51]), (6, [0, 0, 255, 51])];
    let mut right = [0; 4];
    for (_, colour) in [sheets[0], sheets[2], sheets[1]] {
        right = blend::exact(0, right, colour);
    }
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mut painting = painting();
        order.iter().for_each(|&k| painting.draw(&sheet(sheets[k].0), &layer(0), plain(sheets[k].1)));
        assert_eq!(painting.deepest(), 3);
        assert_eq!(first(&mut painting), right);
    }
}

#[test]
fn end_equal_depths_keep_the_order_of_submission() {
    let mut painting = painting();
    painting.draw(&sheet(5), &layer(0), plain([255, 0, 0, 128]));
    painting.draw(&sheet(5), &layer(0), plain([0, 255, 0, 128]));

    assert_eq!(first(&mut painting), blend::exact(0, blend::exact(0, [0; 4], [255, 0, 0, 128]), [0, 255, 0, 128]));
}

#[test]
fn end_layers_behind_the_opaque_are_not_seen_and_store_no_depth() {
    let mut painting = painting();
    painting.draw(&sheet(9), &layer(1), plain([100, 0, 0, 255]));
    painting.draw(&sheet(2), &layer(1), plain([50, 0, 0, 255]));
    painting.draw(&sheet(5), &OPAQUE, plain([7, 7, 7, 255]));

    assert_eq!(first(&mut painting), [57, 7, 7, 255]);
    assert_eq!(painting.depths(), [Some(5); 2]);
}

#[test]
fn end_layers_without_a_test_are_nearest_of_all() {
    let mut painting = painting();
    let free = Brush { test: Test { function: None, ..LESS }, mode: Some(0) };
    painting.draw(&sheet(9), &free, plain([10, 0, 0, 255]));
    painting.draw(&sheet(9), &free, plain([20, 0, 0, 255]));
    painting.draw(&sheet(1), &layer(0), plain([30, 0, 0, 255]));

    assert_eq!(first(&mut painting), [20, 0, 0, 255]);
}

#[test]
fn clear_of_depth_alone_composes_and_of_both_forgets() {
    let mut painting = painting();
    painting.draw(&sheet(5), &OPAQUE, plain([0, 0, 0, 255]));
    painting.draw(&sheet(2), &layer(1), plain([40, 0, 0, 255]));
    painting.clear([0, 0, 1, 1], None, Some(1));
    painting.clear([1, 0, 2, 1], Some([9; 4]), Some(1));

    assert_eq!(painting.end().map_exact(), [[40, 0, 0, 255], [9; 4]]);
}

#[test]
fn draw_holes_let_everything_behind_through() {
    let mut painting = painting();
    painting.draw(&sheet(9), &OPAQUE, plain([1; 4]));
    painting.draw(&sheet(2), &OPAQUE, |i, _| Fragment { shade: Shade::exactly([2; 4]), hole: i == 0, torn: false });

    assert_eq!(painting.depths(), [Some(9), Some(2)]);
    assert_eq!(painting.end().map_exact(), [[1; 4], [2; 4]]);
}

#[test]
fn draw_torn_fragments_leave_doubt_until_both_planes_are_cleared() {
    let mut painting = painting();
    painting.draw(&sheet(2), &OPAQUE, |_, _| Fragment { shade: Shade::exactly([2; 4]), hole: false, torn: true });
    assert_eq!(painting.depths(), [None; 2]);
    assert!(painting.end()[0].doubt);
    painting.clear(ALL, Some([3; 4]), Some(4));
    assert_eq!(painting.depths(), [Some(4); 2]);
    assert!(!painting.end()[0].doubt);
}

/// Colours of exact shades.
trait Exact {
    fn map_exact(self) -> Vec<Colour>;
}

impl Exact for Vec<Shade> {
    fn map_exact(self) -> Vec<Colour> {
        self.into_iter().map(|shade| shade.exact().expect("an exact shade")).collect()
    }
}

fn triangles() -> impl Strategy<Value = Vec<(Primitive, Colour)>> {
    let vertex = || (-300_i32..2400, -300_i32..2400, 0_u32..40).prop_map(|(x, y, z)| Vertex::at(x, y, z));
    let one = ([vertex(), vertex(), vertex()], any::<Colour>());
    prop::collection::vec(one.prop_map(|(v, colour)| (Primitive::Triangle(v), colour)), 0..12)
}

proptest! {
    #[test]
    fn draw_any_opaque_scene_is_the_canvas(scene in triangles(), function in 0_usize..8) {
        let test = Test { function: Some(DepthFunction::ALL[function]), ..LESS };
        let mut canvas = Canvas::new(8, 8, DepthFormat::default(), u32::from_le_bytes);
        let mut painting = Painting::new([8, 8], DepthFormat::default(), |colour| colour);
        for (primitive, colour) in &scene {
            let Primitive::Triangle(v) = primitive else { continue };
            canvas.draw(&[Primitive::Triangle(v.map(|v| v.coloured(*colour)))], &test);
            painting.draw(primitive, &Brush { test, mode: None }, plain(*colour));
        }
        let depths: Vec<_> = canvas.depth.iter().map(|&z| Some(z)).collect();
        let colours: Vec<_> = canvas.colour.iter().map(|pixel| pixel.to_le_bytes()).collect();

        prop_assert_eq!(painting.depths(), depths);
        prop_assert_eq!(painting.end().map_exact(), colours);
    }

    #[test]
    fn draw_any_layers_are_those_of_a_pixel_alone(scene in triangles(), mode in 0_u32..4) {
        let mut painting = Painting::new([8, 8], DepthFormat::default(), |colour| colour);
        scene.iter().for_each(|(primitive, colour)| painting.draw(primitive, &layer(mode), plain(*colour)));
        let found = painting.end().map_exact();

        for (pixel, found) in found.iter().enumerate() {
            let (i, j) = (pixel as i32 % 8, pixel as i32 / 8);
            let depth = |primitive: &Primitive| draw(8, 8, &[*primitive], DepthFormat::default(), DepthFunction::Always).depth[pixel];
            let mut here: Vec<_> = scene.iter().filter(|(p, _)| covers(p, i, j)).map(|(p, c)| (depth(p), *c)).collect();
            let mut right = [0; 4];
            // Selection of the farthest, of equals the first.
            while let Some(z) = here.iter().map(|(z, _)| *z).max() {
                let place = here.iter().position(|(other, _)| *other == z).unwrap();
                right = blend::exact(mode, right, here.remove(place).1);
            }
            prop_assert_eq!(found, &right);
        }
    }
}
