//! Every hard case of the manual, chapter "Numbers", as a test of its own. `--nocapture` prints the rows.

use zga_tests::hard::{CASES, Row, card, depth, lines, rasteriser, subpixel, systolic, texture, za};

fn check(row: &Row) {
    println!("{row}");
    assert!(row.passed, "{row}");
}

/// One test for each case.
macro_rules! cases {
    ($($unit:ident::$case:ident,)+) => {
        $(
            #[test]
            fn $case() {
                check(&$unit::$case());
            }
        )+

        /// Names in the order of this list.
        const NAMES: &[&str] = &[$(stringify!($case)),+];
    };
}

cases! {
    rasteriser::small_triangles_at_a_centre,
    rasteriser::nearly_shared_floats,
    rasteriser::fans_with_the_hub_on_a_centre,
    rasteriser::rotated_quads_in_perspective,
    rasteriser::sliver_across_the_widest_target,
    rasteriser::least_area,
    rasteriser::vertices_at_the_limits,
    rasteriser::beyond_the_guard_band,
    rasteriser::shared_edge_clipped_on_one_side,
    rasteriser::vertices_at_and_behind_the_eye,
    rasteriser::numbers_that_are_none,
    rasteriser::t_junction,
    rasteriser::shifts_orders_and_threads,
    rasteriser::coordinates_near_the_integer_minimum,
    depth::flat_across_the_widest_target,
    depth::whole_range_across_the_target,
    depth::one_step_across_the_target,
    depth::steepest_plane,
    depth::offset_of_all_depths,
    depth::equal_after_less,
    depth::offsets_at_the_limits,
    depth::planes_that_cross,
    za::words_are_maxima,
    za::last_of_thirty_two,
    za::equal_to_the_word,
    za::predictor_overflow,
    za::one_pixel_in_a_cleared_block,
    za::largest_depth,
    za::no_stale_bypass,
    za::widths_beside_blocks,
    za::every_block_shape,
    systolic::one_element,
    systolic::equal_depths,
    systolic::beyond_both_ends,
    systolic::refresh_with_tokens_in_flight,
    systolic::extreme_gradients,
    systolic::disjoint_segments_permuted,
    subpixel::edges_through_samples,
    subpixel::start_corner_ties,
    subpixel::fans_inside_a_pixel,
    subpixel::doubling_back_on_a_diagonal,
    subpixel::interpenetration,
    subpixel::many_layers,
    subpixel::merge_in_any_order,
    subpixel::triangles_between_samples,
    texture::level_weights,
    texture::quad_across_the_eye,
    texture::widest_span_of_w,
    texture::equal_layers,
    texture::holes_at_the_reference,
    lines::zero_length,
    lines::diamond_corners,
    lines::polylines_and_the_longest_line,
    card::again_in_pieces_after_reset_and_restore,
}

#[test]
fn cases_all_have_a_test() {
    assert_eq!(CASES.len(), NAMES.len());
}
