//! The hard cases: constructions that break rasterisers, each with what must hold and what was measured.
//!
//! The list is the one in the manual, chapter "Numbers"; a case keeps its number there. Each is a function that draws on
//! a card of its own and returns a [`Row`]; [`CASES`] has all of them, `zga stability` shows them, and each is a test. There is no slack: a row passes when no sample is
//! wrong, unless its property says otherwise.
//!
//! Targets of 16384 pixels are strips of 16384 x 8 (or 8 x 16384): a whole one would take 2 GiB. The strip lies where
//! the construction has its pixels; what lies outside of it is drawn to, but not looked at.

use crate::harness::{Differences, Options, Screen, State};
use crate::oracle::{DepthFormat, DepthFunction, Primitive, draw};
use std::fmt;

pub mod card;
pub mod decals;
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

/// The list of all cases, handed to a macro as `unit { number name; ... } ...`: what needs each of them by name, the report
/// or a test, is made from this one list.
#[macro_export]
macro_rules! hard_cases {
    ($take:ident) => {
        $take! {
            rasteriser {
                1 small_triangles_at_a_centre;
                2 nearly_shared_floats;
                3 fans_with_the_hub_on_a_centre;
                4 rotated_quads_in_perspective;
                5 sliver_across_the_widest_target;
                6 least_area;
                7 vertices_at_the_limits;
                8 beyond_the_guard_band;
                9 shared_edge_clipped_on_one_side;
                10 vertices_at_and_behind_the_eye;
                11 numbers_that_are_none;
                12 t_junction;
                13 shifts_orders_and_threads;
                14 coordinates_near_the_integer_minimum;
            }
            depth {
                15 flat_across_the_widest_target;
                16 whole_range_across_the_target;
                17 one_step_across_the_target;
                18 steepest_plane;
                19 offset_of_all_depths;
                20 equal_after_less;
                21 offsets_at_the_limits;
                22 planes_that_cross;
            }
            za {
                23 words_are_maxima;
                24 last_of_thirty_two;
                25 equal_to_the_word;
                26 predictor_overflow;
                27 one_pixel_in_a_cleared_block;
                28 largest_depth;
                29 no_stale_bypass;
                30 widths_beside_blocks;
                31 every_block_shape;
            }
            systolic {
                32 one_element;
                33 equal_depths;
                34 beyond_both_ends;
                35 refresh_with_tokens_in_flight;
                36 extreme_gradients;
                37 disjoint_segments_permuted;
            }
            subpixel {
                38 edges_through_samples;
                39 start_corner_ties;
                40 fans_inside_a_pixel;
                41 doubling_back_on_a_diagonal;
                42 interpenetration;
                43 many_layers;
                44 merge_in_any_order;
                45 triangles_between_samples;
            }
            decals {
                46 nothing_buried_up_to_the_limit;
                47 offset_under_one_step;
                48 same_pixels_with_and_without;
                49 occluder_at_the_offset;
                50 silhouettes_and_refusal;
                51 edge_on_surface;
            }
            texture {
                52 level_weights;
                53 quad_across_the_eye;
                54 widest_span_of_w;
                55 equal_layers;
                56 holes_at_the_reference;
            }
            lines {
                57 zero_length;
                58 diamond_corners;
                59 polylines_and_the_longest_line;
            }
            card {
                60 again_in_pieces_after_reset_and_restore;
            }
        }
    };
}

/// A case that can be run.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Number in the manual.
    pub number: u32,
    /// The unit it is about.
    pub unit: &'static str,
    /// Its name; the test is `hard::<unit>::<name>`.
    pub name: &'static str,
    /// Draws it.
    pub run: fn() -> Row,
}

macro_rules! list {
    ($($unit:ident { $($number:literal $name:ident;)+ })+) => {
        &[$($(Case { number: $number, unit: stringify!($unit), name: stringify!($name), run: $unit::$name },)+)+]
    };
}

/// Every case, in the order of the numbers.
pub const CASES: &[Case] = hard_cases!(list);

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
