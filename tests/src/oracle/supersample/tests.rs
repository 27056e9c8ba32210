//! Pictures that can be worked out by hand.

use super::*;
use crate::harness::scenes;
use proptest::prelude::*;

const GRIDS: [[u32; 2]; 3] = [[4, 4], [8, 4], [8, 8]];
const ALL: Area = [0, 0, 99, 99];
const LESS: Test = Test { function: Some(DepthFunction::Less), write: true, scissor: ALL, stencil: None };

fn target(size: [u32; 2], grid: [u32; 2]) -> Supersampled {
    Supersampled::new(size, grid, DepthFormat::default(), Resolve::Values)
}

fn triangle(corners: [(i32, i32, u32); 3], colour: [u8; 4]) -> Primitive {
    Primitive::Triangle(corners.map(|(x, y, z)| Vertex::at(x, y, z).coloured(colour)))
}

/// Everything left of x = `right`, of one depth.
fn wall(right: i32, z: u32, colour: [u8; 4]) -> [Primitive; 2] {
    let (a, b, c, d) = ((-999, -999, z), (right, -999, z), (-999, 9999, z), (right, 9999, z));
    [triangle([a, b, c], colour), triangle([c, b, d], colour)]
}

/// Levels of a channel.
fn levels(picture: &[[Level; 4]], channel: usize) -> Vec<u8> {
    picture
        .iter()
        .map(|pixel| {
            assert_eq!(pixel[channel].low, pixel[channel].high, "no tie");
            pixel[channel].low
        })
        .collect()
}

#[test]
fn draw_wall_covers_the_columns_to_its_left() {
    for [columns, rows] in GRIDS {
        for right in 0..=256 {
            let mut target = target([1, 1], [columns, rows]);
            target.draw(&wall(right, 5, [255; 4]), &Brush::masked(LESS));

            // Column c lies at (2 c + 1) / 2C of the width; a right edge leaves out what lies on it.
            let covered = (0..columns as i32).filter(|c| (2 * c + 1) * 256 < right * 2 * columns as i32).count() as u32;
            let level = (2 * 255 * covered + columns) / (2 * columns);
            assert_eq!(levels(&target.end(), 0), [level as u8], "{columns} columns, {right} u");
        }
    }
}

#[test]
fn draw_half_pixels_on_the_diagonal_have_each_sample_once() {
    // The diagonal runs through samples of 4 x 4 and 8 x 8: they belong to the triangle with the left or top edge.
    for (grid, counts) in GRIDS.into_iter().zip([[10, 6], [16, 16], [36, 28]]) {
        let halves = [[(0, 0, 5), (256, 256, 5), (0, 256, 5)], [(0, 0, 5), (256, 0, 5), (256, 256, 5)]];
        let counted = halves.map(|corners| {
            let mut target = target([1, 1], grid);
            target.draw(&[triangle(corners, [1; 4])], &Brush::masked(LESS));
            target.sample_depths(0, 0).iter().filter(|&&z| z == 5).count()
        });
        // The upper right one has the diagonal as its left edge.
        assert_eq!([counted[1], counted[0]], counts, "{grid:?}");
    }
}

#[test]
fn draw_two_walls_are_seen_where_they_are_nearest() {
    let mut target = target([1, 1], [4, 4]);

    target.draw(&wall(128, 9, [255, 0, 0, 255]), &Brush::masked(LESS));
    target.draw(&wall(256, 10, [0, 255, 0, 255]), &Brush::masked(LESS));
    target.draw(&wall(64, 9, [0, 0, 255, 255]), &Brush::masked(LESS));

    // Equal depths: the earlier stays.
    assert_eq!(target.sample_depths(0, 0)[..4], [9, 9, 10, 10]);
    assert_eq!(target.centre_depths(), [10]);
    assert_eq!(target.end()[0], [128, 128, 0, 255].map(Level::exactly));
}

#[test]
fn draw_crossing_planes_change_places_inside_the_pixel() {
    // z = 40 at the left side of the pixel, 40 + 16 at its right; a wall at 48 crosses in the middle.
    let slope = triangle([(-256, -256, 24), (768, -256, 88), (-256, 768, 24)], [255, 0, 0, 255]);
    let mut target = target([1, 1], [4, 4]);

    target.draw(&wall(256, 48, [0, 255, 0, 255]), &Brush::masked(LESS));
    target.draw(&[slope], &Brush::masked(LESS));

    assert_eq!(target.sample_depths(0, 0)[..4], [42, 46, 48, 48]);
    assert_eq!(target.end()[0], [128, 128, 0, 255].map(Level::exactly));
}

#[test]
fn draw_without_masks_covers_all_samples_or_none_at_the_centres_depth() {
    let slope = |right: i32| triangle([(-256, -256, 24), (right, -256, 88), (-256, 768, 24)], [200; 4]);
    let mut target = target([2, 1], [8, 8]);

    target.draw(&[slope(768)], &Brush { anti_alias: false, ..Brush::masked(LESS) });

    assert_eq!((target.sample_depths(0, 0), target.sample_depths(1, 0)), (vec![48; 64], vec![0x00FF_FFFF; 64]));
    assert_eq!(levels(&target.end(), 0), [200, 0]);
}

#[test]
fn draw_scissor_write_and_no_test_are_obeyed() {
    let mut target = target([2, 1], [4, 4]);
    let right = Test { scissor: [1, 0, 2, 1], ..LESS };

    target.draw(&wall(9999, 7, [10; 4]), &Brush::masked(Test { write: false, ..LESS }));
    target.draw(&wall(9999, 8, [20; 4]), &Brush::masked(right));
    target.draw(&wall(9999, 9, [30; 4]), &Brush::masked(LESS));
    target.draw(&wall(128, 1, [90; 4]), &Brush::masked(Test { function: None, ..right }));

    assert_eq!((target.sample_depths(0, 0)[0], target.sample_depths(1, 0)[0]), (9, 8));
    assert_eq!(levels(&target.end(), 0), [30, 20]);
}

#[test]
fn draw_point_covers_its_square_and_line_its_rectangle() {
    let mut target = target([3, 1], [4, 4]);
    let brush = Brush { point_size: 128, line_width: 128, ..Brush::masked(LESS) };
    let at = |x: i32, y: i32| Vertex::at(x, y, 5).coloured([255; 4]);

    // A quarter of the first pixel; the upper half of half of the second and of all of the third.
    target.draw(&[Primitive::Point(at(64, 64)), Primitive::Line([at(384, 64), at(768, 64)])], &brush);

    assert_eq!(levels(&target.end(), 0), [64, 64, 128]);
}

#[test]
fn layers_are_ordered_by_depth_and_hidden_by_what_is_opaque() {
    let mut target = target([1, 1], [4, 4]);
    let layer = Brush { blend: true, ..Brush::masked(LESS) };

    target.draw(&wall(999, 50, [200, 0, 0, 51]), &layer);
    target.draw(&wall(999, 70, [0, 200, 0, 51]), &layer);
    target.draw(&wall(999, 90, [0, 0, 200, 51]), &layer);
    target.draw(&wall(999, 80, [100, 100, 100, 255]), &layer);
    target.draw(&wall(999, 1, [1, 2, 3, 0]), &layer);

    // 80 hides 90; over it 70 (80, 120, 80), then 50.
    assert_eq!(target.sample_depths(0, 0), [80; 16]);
    assert_eq!(target.end()[0], [104, 96, 64, 255].map(Level::exactly));
}

#[test]
fn layers_of_equal_depth_or_none_have_the_later_in_front() {
    let mut target = target([1, 1], [4, 4]);
    let layer = Brush { blend: true, ..Brush::masked(LESS) };
    let free = Brush { test: Test { function: None, ..LESS }, ..layer };

    target.draw(&wall(999, 0, [0, 0, 255, 51]), &free);
    target.draw(&wall(999, 9, [255, 0, 0, 51]), &layer);
    target.draw(&wall(999, 9, [0, 255, 0, 51]), &layer);

    // Red, then green over it, then blue, which has no depth: 255/5 (16/25, 4/5, 1).
    assert_eq!(levels(&target.end(), 0)[0], 33);
    assert_eq!(target.end()[0].map(|level| level.low), [33, 41, 51, 124]);
}

#[test]
fn layers_lose_the_samples_of_what_is_opaque_and_not_tested() {
    let mut target = target([1, 1], [4, 4]);
    let layer = Brush { blend: true, ..Brush::masked(LESS) };

    target.draw(&wall(999, 9, [200, 0, 0, 51]), &layer);
    target.draw(&wall(128, 0, [0, 100, 0, 255]), &Brush::masked(Test { function: None, ..LESS }));
    target.draw(&wall(64, 7, [0, 0, 100, 51]), &layer);

    // 40 of red on the right half; on the left 100 of green, a quarter under 20 of blue.
    assert_eq!(target.end()[0].map(|level| level.low), [20, 45, 5, 153]);
}

#[test]
fn layers_cover_samples_and_leave_the_rest() {
    let mut target = target([1, 1], [4, 4]);
    target.clear(ALL, Some([0, 0, 0, 255]), None);

    target.draw(&wall(128, 9, [200, 0, 0, 51]), &Brush { blend: true, ..Brush::masked(LESS) });

    // A fifth of 200 on half of the pixel.
    assert_eq!(levels(&target.end(), 0), [20]);
}

#[test]
fn clear_of_depth_composes_and_clear_of_colour_drops_layers() {
    let draw = |colour: Option<[u8; 4]>, depth: Option<u32>| {
        let mut target = target([1, 1], [4, 4]);
        target.draw(&wall(999, 9, [200, 0, 0, 51]), &Brush { blend: true, ..Brush::masked(LESS) });
        target.clear(ALL, colour, depth);
        // It would hide the layer.
        target.draw(&wall(128, 3, [0, 100, 0, 255]), &Brush::masked(LESS));
        target.end()[0].map(|level| level.low)
    };

    assert_eq!(draw(None, Some(5)), [20, 50, 0, 153]);
    assert_eq!(draw(Some([8; 4]), None), [4, 54, 4, 132]);
}

#[test]
fn load_gives_all_samples_the_pixels_colour_and_depth() {
    let mut target = target([2, 1], [8, 4]);

    target.load(&[[1, 2, 3, 4], [5, 6, 7, 8]], &[30, 10]);
    target.draw(&wall(9999, 20, [90; 4]), &Brush::masked(LESS));

    assert_eq!(levels(&target.end(), 0), [90, 5]);
    assert_eq!(target.centre_depths(), [20, 10]);
}

#[test]
fn end_in_linear_light_is_brighter() {
    let mut target = Supersampled::new([1, 1], [8, 8], DepthFormat::default(), Resolve::Linear);

    target.draw(&wall(128, 20, [255; 4]), &Brush::masked(LESS));

    assert_eq!(target.end()[0], [188, 188, 188, 128].map(Level::exactly));
}

proptest! {
    #[test]
    fn draw_any_scene_equals_the_plain_form(
        pieces in scenes::scene([30, 19], 24, 20), grid in 0usize..3, f in 0u32..4, function in 0usize..9, masked in any::<bool>(),
        blend in any::<bool>(), widths in (1u32..700, 1u32..700), scissor in (0u32..9, 0u32..9, 9u32..40, 9u32..40),
    ) {
        let test = Test {
            function: DepthFunction::ALL.get(function).copied(),
            write: true,
            stencil: None,
            scissor: [scissor.0, scissor.1, scissor.2, scissor.3],
        };
        let brush = Brush { test, anti_alias: masked, blend, line_width: widths.0, point_size: widths.1 };
        // Colours of which some are translucent; drawn over and over, so that threads have work.
        let scene: Vec<Primitive> = (0..3).flat_map(|_| scenes::primitives(&pieces)).enumerate().map(|(k, primitive)| {
            let colour = (k as u32).wrapping_mul(0x0700_2B0D).to_le_bytes();
            match primitive {
                Primitive::Triangle(v) => Primitive::Triangle(v.map(|v| v.coloured(colour))),
                Primitive::Line(v) => Primitive::Line(v.map(|v| v.coloured(colour))),
                Primitive::Point(v) => Primitive::Point(v.coloured(colour)),
            }
        }).collect();
        let format = DepthFormat { bits: 24, fraction: f * 8 };
        let mut fast = Supersampled::new([30, 19], GRIDS[grid], format, Resolve::Values);
        let mut plain = fast.clone();

        fast.draw(&scene, &brush);
        plain.draw_plain(&scene, &brush);

        prop_assert_eq!(fast.centre_depths(), plain.centre_depths());
        for pixel in 0..30 * 19 {
            let [i, j] = [pixel % 30, pixel / 30];
            prop_assert_eq!(fast.sample_depths(i, j), plain.sample_depths(i, j), "({}, {})", i, j);
        }
        prop_assert_eq!(fast.end(), plain.end());
    }
}
