//! What is hidden by chunks that one piece covers from the top of a band to its bottom.

use super::super::Counts;
use super::super::band::{Input, LINES, Work};
use super::super::bands::Bands;
use super::super::grid::Grid;
use super::super::hide::OPEN;
use super::super::scene::{Item, Kind, Scene};
use super::scene::state;
use super::setting;
use crate::geometry::ScreenVertex;
use crate::hidden::z_buffer::DepthTest;
use crate::shading::pixel::AlphaRule;
use crate::shading::plane::Interpolation;
use fearless_simd::Level;
use zga_abi::Effects;
use zga_firmware::checked::{Clear, DrawState, Rectangle};

/// Chunks of a line of the target.
const CHUNKS: u32 = 6;
/// The target: one band.
const AREA: Rectangle = Rectangle { x: 0, y: 0, right: 16 * CHUNKS, bottom: LINES as u32 };

/// A band with these triangles, corners in pixels and a depth each, as drawing it leaves it, and how many pixels were active.
fn drawn(triangles: &[([(i32, i32); 3], u32)]) -> (Work, usize) {
    let setting = setting(Grid::G8X8, [AREA.right, AREA.bottom]);
    let mut scene = Scene::default();
    scene.clear(&Clear { area: AREA, colour: Some(0), depth: Some(1 << 20), stencil: None }, true, true);
    let state = DrawState { scissor: AREA, ..state(Effects::ANTI_ALIAS, 0) };
    for &(corners, z) in triangles {
        let taken = scene.draw(&state, Some(DepthTest::LESS), Interpolation::Flat, AlphaRule::Vertices).expect("taken");
        let vertices =
            corners.map(|(x, y)| ScreenVertex { x: 256 * x, y: 256 * y, z, colour: z, ..ScreenVertex::default() });
        taken.items.push(Item { vertices, draw: taken.draw, number: 0, kind: Kind::Masked });
    }
    let mut bands = Bands::default();
    bands.fill(&scene, setting.rule, AREA.bottom);
    let input = Input {
        setting: &setting,
        scene: &scene,
        items: bands.items(0),
        edges: &[],
        surfaces: &[],
        top: 0,
        lines: LINES,
    };
    let (mut work, mut out, mut counts) = (Work::default(), Vec::new(), Counts::default());
    work.draw(Some(Level::new()), &input, &mut out, &mut counts);
    (work, out.len())
}

/// Items that were set up, in the order in which they were.
fn items(work: &Work) -> Vec<u32> {
    work.pieces.iter().map(|piece| piece.item).collect()
}

/// A triangle over everything left of a column.
fn sheet(right: i32) -> [(i32, i32); 3] {
    [(right, -1000), (right, 1000), (-4000, 0)]
}

#[test]
fn take_chunks_a_sheet_over_all_lines_has_them_at_a_word_each() {
    let (work, active) = drawn(&[(sheet(1000), 50)]);
    assert_eq!((&work.columns[..], work.spans.len(), active), (&[0; CHUNKS as usize][..], 0, 0));
}

#[test]
fn take_chunks_what_lies_behind_a_sheet_is_not_set_up() {
    let (work, active) = drawn(&[(sheet(1000), 60), (sheet(1000), 50), (sheet(40), 70)]);
    assert_eq!((work.pieces.len(), work.spans.len(), active), (1, 0, 0));
    assert_eq!(items(&work), [1], "the nearest");
}

#[test]
fn take_chunks_only_whole_ones_that_nothing_else_meets() {
    // An edge in the fourth chunk; the sheet behind takes no chunk, since that one is open.
    let (work, active) = drawn(&[(sheet(56), 50), (sheet(1000), 60)]);
    assert_eq!(work.columns[..3], [0; 3]);
    assert_eq!(work.columns[3..], [OPEN; 3]);
    let parts = |piece: u32| work.spans.iter().filter(move |span| span.piece == piece).map(|span| span.columns);
    assert!(parts(0).eq([[48, 56]; LINES]), "what no chunk holds of the nearer one");
    assert!(parts(1).eq([[0, 96]; LINES]), "all of the other");
    assert_eq!(active, 0, "the edge lies between two pixels");
}
