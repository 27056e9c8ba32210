//! What rows of samples meet, cover wholly and cover in part, against edge functions sample by sample, at every SIMD
//! level.

use super::levels;
use crate::geometry::ScreenVertex;
use crate::geometry::triangle::Triangle;
use crate::hidden::z_buffer::kernel::LANES;
use crate::hidden::z_buffer::specification::{covers, covers_place};
use crate::subpixel::band::LINES;
use crate::subpixel::grid::Grid;
use crate::subpixel::walk::{REACH, Slot, Walks};
use fearless_simd::{Level, Simd, dispatch};
use proptest::prelude::*;

/// Pixels of a row: more than a slot reaches.
const WIDTH: i32 = 48;

/// A row of pixels.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    met: [i32; 2],
    whole: [i32; 2],
    missed: bool,
    /// Of the pixels that a slot reaches, from its base on.
    masks: Vec<u64>,
}

/// The rows of a band that begins with row `top`, with slots that begin with pixel `base`.
#[inline(always)]
fn walked<S: Simd, const C: usize, const R: usize>(simd: S, t: &Triangle, top: i32, base: i32) -> Vec<Row> {
    let walks = Walks::new(simd, t);
    let mut rows = Vec::new();
    for place in (0..LINES).step_by(LANES / R) {
        let row = (top + place as i32) * R as i32;
        let ends = walks.ends(simd, t, row, [0, WIDTH * C as i32]);
        let (pixels, misses) = (ends.pixels::<C, R>(), ends.misses(t, row));
        let mut slots = Vec::new();
        ends.slots::<C>(simd, base, &mut slots);
        for k in 0..LANES / R {
            let slot = &slots[k / Slot::rows(C, R)];
            let mask = |x: i32| slot.mask::<S, C, R>(simd, place + k, ((x - base) * C as i32) as u32);
            rows.push(Row {
                met: pixels.met::<C, R>(k),
                whole: pixels.whole::<R>(k),
                missed: misses >> (k * R + R / 2) & 1 != 0,
                masks: (base..WIDTH.min(base + REACH)).map(mask).collect(),
            });
        }
    }
    rows
}

fn walked_at(level: Level, grid: Grid, t: &Triangle, top: i32, base: i32) -> Vec<Row> {
    match (grid.columns(), grid.rows()) {
        (4, _) => dispatch!(level, simd => walked::<_, 4, 4>(simd, t, top, base)),
        (_, 4) => dispatch!(level, simd => walked::<_, 8, 4>(simd, t, top, base)),
        _ => dispatch!(level, simd => walked::<_, 8, 8>(simd, t, top, base)),
    }
}

/// Samples of a pixel that a triangle covers, by definition.
fn defined(grid: Grid, v: &[ScreenVertex; 3], x: i32, y: i32) -> u64 {
    let covered = |&sample: &u32| {
        let [u, w] = grid.position(sample);
        covers_place(v, i64::from(256 * x + u), i64::from(256 * y + w))
    };
    (0..grid.samples()).filter(covered).map(|sample| grid.sample_bit(sample)).sum()
}

fn check(grid: Grid, v: &[ScreenVertex; 3], top: i32, base: i32) -> Result<(), TestCaseError> {
    let pitch = [8 - grid.columns().ilog2(), 8 - grid.rows().ilog2()];
    let [Some(outline)] = Triangle::outlines(v, [(pitch, top * grid.rows() as i32)]) else {
        return Ok(());
    };
    let best = walked_at(Level::new(), grid, &outline, top, base);
    for level in levels() {
        prop_assert_eq!(&walked_at(level, grid, &outline, top, base), &best, "{:?}", level);
    }
    for (row, y) in best.iter().zip(top..) {
        let masks: Vec<u64> = (0..WIDTH).map(|x| defined(grid, v, x, y)).collect();
        for (x, &mask) in (0..).zip(&masks) {
            let place = format!("{grid:?} pixel {x} {y} of {v:?}: {row:?}");
            let [met, whole] = [row.met, row.whole].map(|[from, to]| (from..to).contains(&x));
            prop_assert!(met || mask == 0, "met, {}", place);
            prop_assert_eq!(whole, mask == grid.full(), "whole, {}", place);
            prop_assert!(mask != 0 || !covers(v, x, y) || row.missed, "missed, {}", place);
        }
        let reached = &masks[base as usize..][..row.masks.len()];
        prop_assert_eq!(&row.masks[..], reached, "masks of row {} of {:?}", y, v);
        if row.met[0] < row.met[1] {
            let ends = [row.met[0], row.met[1] - 1].map(|x| masks[x as usize]);
            prop_assert!(!ends.contains(&0), "no more than is met on row {} of {:?}: {:?}", y, v, row);
        }
    }
    Ok(())
}

fn vertex() -> impl Strategy<Value = ScreenVertex> {
    (-4096..4096 + 256 * WIDTH, -2048..6144).prop_map(|(x, y)| ScreenVertex { x, y, ..ScreenVertex::default() })
}

fn grid() -> impl Strategy<Value = Grid> {
    prop::sample::select(Grid::ALL.to_vec())
}

proptest! {
    #[test]
    fn walk_any_triangle_meets_what_edge_functions_cover(
        grid in grid(), v in [vertex(), vertex(), vertex()], top in -4..9_i32, base in 0..40_i32,
    ) {
        check(grid, &v, top, base)?;
    }

    #[test]
    fn walk_small_triangle_meets_what_edge_functions_cover(
        grid in grid(), at in vertex(), d in [(-300..300, -300..300), (-300..300, -300..300)], base in 0..40_i32,
    ) {
        let beside = d.map(|(x, y)| ScreenVertex { x: at.x + x, y: at.y + y, ..at });
        check(grid, &[at, beside[0], beside[1]], 0, base)?;
    }

    #[test]
    fn walk_sliver_meets_what_edge_functions_cover(
        grid in grid(), a in vertex(), b in vertex(), t in 0.0..1.0_f64, d in -60..60_i32, top in -4..9_i32,
    ) {
        let mix = |a: i32, b: i32| (f64::from(a) + t * (f64::from(b) - f64::from(a))) as i32;
        let c = ScreenVertex { x: mix(a.x, b.x) + d, y: mix(a.y, b.y), ..a };
        check(grid, &[a, b, c], top, 0)?;
    }
}
