//! The hard cases: constructions that break rasterisers, each with what must hold and what was measured.
//!
//! The list is the one in the manual, chapter "Numbers"; a case keeps its number there. Each is a function that draws on
//! a card of its own and returns a [`Row`]; [`CASES`] has all of them. There is no slack: a row passes when no sample is
//! wrong, unless its property says otherwise.
//!
//! Targets of 16384 pixels are strips of 16384 x 8 (or 8 x 16384): a whole one would take 2 GiB. The strip lies where
//! the construction has its pixels; what lies outside of it is drawn to, but not looked at.

use crate::harness::{Differences, Options, Screen, State};
use crate::oracle::{DepthFormat, DepthFunction, Primitive, draw};
use std::fmt;

pub mod card;
pub mod depth;
pub mod lines;
pub mod rasteriser;
pub mod subpixel;
pub mod systolic;
pub mod texture;
pub mod za;

/// One row of the stability report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Number of the case.
    pub case: u32,
    /// Unit and name.
    pub name: &'static str,
    /// What is drawn.
    pub construction: &'static str,
    /// What must hold.
    pub property: &'static str,
    /// What was found.
    pub measured: String,
    /// Whether it holds.
    pub passed: bool,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed { "ok" } else { "FAILED" };
        let Self { case, name, construction, property, measured, .. } = self;
        write!(f, "{case:>3} {verdict} {name}: {construction}; must: {property}; measured: {measured}")
    }
}

/// Every case, in the order of the numbers.
pub const CASES: &[fn() -> Row] = &[
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
];

/// What several pictures showed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) pictures: usize,
    pub(crate) pixels: usize,
    pub(crate) wrong: usize,
    first: Option<String>,
}

impl Tally {
    /// Adds a comparison with the oracle.
    pub(crate) fn add(&mut self, found: &Differences) {
        self.pictures += 1;
        self.pixels += found.pixels;
        self.note(found.count(), || found.to_string());
    }

    /// Adds `wrong` wrong samples, and says what they are.
    pub(crate) fn note(&mut self, wrong: usize, what: impl FnOnce() -> String) {
        self.wrong += wrong;
        if wrong > 0 && self.first.is_none() {
            self.first = Some(what());
        }
    }

    /// Adds a wrong sample unless it `holds`.
    pub(crate) fn expect(&mut self, holds: bool, what: impl FnOnce() -> String) {
        self.note(usize::from(!holds), what);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} pictures, {} pixels, {} wrong", self.pictures, self.pixels, self.wrong)?;
        self.first.as_ref().map_or(Ok(()), |first| write!(f, "; first: {first}"))
    }
}

/// Draws a scene with identities on a new card and compares it with the oracle.
pub(crate) fn compare(
    size: [u32; 2],
    scene: &[Primitive],
    format: DepthFormat,
    function: DepthFunction,
) -> Differences {
    let mut screen = Screen::new(size[0], size[1], &Options { depth: format, ..Options::default() });
    compare_on(&mut screen, scene, function)
}

/// The same on a card that is there, after a clear.
pub(crate) fn compare_on(screen: &mut Screen, scene: &[Primitive], function: DepthFunction) -> Differences {
    screen.clear();
    screen.draw_ids(scene, &State::with(function));
    let picture = screen.read();
    let image = draw(picture.width, picture.height, scene, screen.options().depth, function);
    picture.against(&image)
}

/// Draws a scene under `always` and tells how many pixels it drew, and how many fragments that took: as many where no
/// pixel is drawn twice.
pub(crate) fn fragments(screen: &mut Screen, scene: &[Primitive]) -> (usize, u64) {
    screen.clear();
    screen.clear_counts();
    screen.draw_ids(scene, &State::with(DepthFunction::Always));
    let drawn = screen.read().drawn();
    (drawn, screen.counts().reads)
}
