//! The specification of a band: every mask sample by sample, every pixel on its own.
//!
//! What [`super::band`] must equal: fragments, active pixels, counts.

use super::band::{Input, Resolved, Work};
use super::bands::Entry;
use super::edges::{SEEK, Sides, share};
use super::left::covers_centre;
use super::lists::Fragment;
use super::piece::{Cover, Piece};
use super::scene::{Rule, Scene};
use super::{Counts, EDGE_BYTES, Setting};
use crate::geometry::PIXEL;
use crate::hidden::z_buffer::specification::covers;
use std::collections::HashMap;

/// Resolves the active pixels of a band.
pub fn draw(work: &mut Work, input: &Input<'_>, out: &mut Vec<Resolved>, counts: &mut Counts) {
    let scene = input.scene;
    let beyond = input.top + input.lines as i32;
    work.pieces.clear();
    work.covers.clear();
    for &Entry { number, .. } in input.items {
        let item = &scene.items[number as usize];
        let draw = &scene.draws[item.draw as usize];
        let (piece, cover) = Piece::new(input.setting, number, item, draw, input.top);
        work.pieces.push(piece);
        work.covers.push((cover, input.area(item, [[0, input.top], [i32::MAX, beyond]])));
    }
    work.open_pixels(input);
    let mut list = Vec::new();
    for line in 0..input.lines {
        for x in 0..input.setting.size[0] as usize {
            list.clear();
            if pixel(work, input, &mut list, x, line) {
                work.take_up(input, &list, [x, line], disjoint(&list), out, counts);
            }
        }
    }
    work.close_pixels(input, out, counts);
}

/// Samples of a pixel that a piece covers.
fn mask(input: &Input<'_>, piece: &Piece, (cover, area): &(Cover, [[i32; 2]; 2]), x: i32, y: i32) -> u64 {
    let Setting { grid, .. } = input.setting;
    let item = &input.scene.items[piece.item as usize];
    let [[left, first], [right, beyond]] = *area;
    if !(left..right).contains(&x) || !(first..beyond).contains(&y) {
        return 0;
    }
    let whole = |covered: bool| if covered { grid.full() } else { 0 };
    match cover {
        Cover::Nothing => 0,
        Cover::Samples(_) => piece.mask_by_edges(input.setting, item, x, y),
        Cover::Centres(_) => whole(covers(&item.vertices, x, y)),
        Cover::Line(line) => whole(line.draws(x, y)),
        Cover::Pixel(place) => whole(*place == [x, y]),
        Cover::All => grid.full(),
    }
}

/// Whether a piece that covers no sample of a pixel has been drawn there by the path.
fn centre_only(input: &Input<'_>, piece: &Piece, (cover, area): &(Cover, [[i32; 2]; 2]), x: i32, y: i32) -> bool {
    let [[left, first], [right, beyond]] = *area;
    let inside = (left..right).contains(&x) && (first..beyond).contains(&y);
    let vertices = &input.scene.items[piece.item as usize].vertices;
    inside && piece.drawn && matches!(cover, Cover::Samples(_)) && covers(vertices, x, y)
}

/// Finds what is left of the fragments of a pixel, and whether it is active.
fn pixel(work: &Work, input: &Input<'_>, list: &mut Vec<Fragment>, x: usize, line: usize) -> bool {
    let (column, y) = (x as i32, input.top + line as i32);
    let full = input.setting.grid.full();
    for ((piece, cover), number) in work.pieces.iter().zip(&work.covers).zip(0..) {
        let mask = mask(input, piece, cover, column, y);
        if mask != 0 || centre_only(input, piece, cover, column, y) {
            list.push(Fragment::new(mask, number, piece.bounds(column, y)));
        }
    }
    let piece = |fragment: &Fragment| &work.pieces[fragment.piece as usize];
    let part = |fragment: &Fragment| fragment.mask != full || piece(fragment).layer;
    if input.setting.rule == Rule::InOrder {
        let whole = list.iter().filter(|fragment| !part(fragment));
        let covers: usize = whole.map(|fragment| if input.undecided(piece(fragment)) { 2 } else { 1 }).sum();
        return covers >= 2 || list.iter().any(part);
    }
    let base = input.base_at(x, line);
    let cover_together = |depth: i32| {
        let opaque = list.iter().filter(|fragment| fragment.far <= depth && !piece(fragment).layer);
        opaque.fold(0, |mask, fragment| mask | fragment.mask) == full
    };
    let limit = list.iter().map(|fragment| fragment.far).filter(|&far| cover_together(far)).fold(base, i32::min);
    list.retain(|fragment| fragment.near <= limit);
    let left = list.len() + usize::from(base <= limit);
    let colours = list.iter().map(|fragment| piece(fragment).plain.filter(|_| !piece(fragment).layer));
    let colours: Vec<Option<u32>> = colours.collect();
    let one = colours.iter().all(|&colour| colour.is_some() && colour == colours[0]);
    let hides = |fragment: &Fragment| fragment.far <= limit;
    let centre = |fragment: &Fragment| covers_centre(input, piece(fragment), fragment.mask, [column, y]);
    let plain = one && list.iter().any(|fragment| hides(fragment) && centre(fragment));
    left > 1 && !(base > limit && (plain || lies_inside(work, input, list, [column, y])))
}

/// Whether what is left of a pixel's fragments lies inside a surface.
fn lies_inside(work: &Work, input: &Input<'_>, list: &[Fragment], [x, y]: [i32; 2]) -> bool {
    if input.edges.is_empty() {
        return false;
    }
    let Setting { grid, pitch, .. } = *input.setting;
    let piece = |fragment: &Fragment| &work.pieces[fragment.piece as usize];
    let covered = list.iter().fold(0, |mask, fragment| mask | fragment.mask) == grid.full();
    let draw = |fragment: &Fragment| &input.scene.draws[piece(fragment).draw as usize];
    let smooth = |fragment: &Fragment| input.edges[piece(fragment).item as usize].contains(Sides::SMOOTH);
    let one = list.iter().all(|fragment| smooth(fragment) && draw(fragment).tag == draw(&list[0]).tag);
    let first = [x, y].map(|c| i64::from(c) * i64::from(PIXEL));
    let spare = pitch.map(|bits| (1_i64 << bits) / 2);
    let low = [first[0] + spare[0], first[1] + spare[1]];
    let high = [first[0] + i64::from(PIXEL) - spare[0], first[1] + i64::from(PIXEL) - spare[1]];
    let borders = |fragment: &Fragment| {
        let item = piece(fragment).item as usize;
        let sides = input.edges[item];
        let corners = input.scene.items[item].vertices.map(|v| [i64::from(v.x), i64::from(v.y)]);
        (0..3).any(|k| !sides.shares(k) && meets(corners[k], corners[(k + 1) % 3], low, high))
    };
    covered && one && disjoint(list) && !list.iter().any(borders)
}

/// Whether the line from `a` to `b` has a point in a rectangle, its sides included.
pub(super) fn meets(a: [i64; 2], b: [i64; 2], low: [i64; 2], high: [i64; 2]) -> bool {
    // The part of the line inside, as fractions of it: numerators and denominators, the latter greater than 0.
    let less = |s: [i64; 2], t: [i64; 2]| i128::from(s[0]) * i128::from(t[1]) < i128::from(t[0]) * i128::from(s[1]);
    let (mut from, mut to) = ([0, 1], [1, 1]);
    for c in 0..2 {
        let length = b[c] - a[c];
        if length == 0 {
            if a[c] < low[c] || a[c] > high[c] {
                return false;
            }
            continue;
        }
        let (near, far) = if length > 0 { (low[c], high[c]) } else { (high[c], low[c]) };
        let at = |place: i64| [(place - a[c]) * length.signum(), length.abs()];
        if less(from, at(near)) {
            from = at(near);
        }
        if less(at(far), to) {
            to = at(far);
        }
    }
    !less(to, from)
}

/// Edges of a scene's items that have found none to share yet, by the places of their ends.
type Waiting = HashMap<[[i32; 2]; 2], Vec<(u32, usize)>>;

/// What is known of the edges of a scene's items.
pub fn sides(setting: &Setting, scene: &Scene, counts: &mut Counts) -> Vec<Sides> {
    let mut all: Vec<Sides> = Vec::with_capacity(scene.items.len());
    let mut waiting = Waiting::new();
    let (mut waits, mut most) = (0, 0);
    for (number, item) in (0..).zip(&scene.items) {
        let sides = Sides::of(setting, item, &scene.draws[item.draw as usize]);
        all.push(sides);
        if !sides.contains(Sides::SMOOTH) || sides.contains(Sides::NOTHING) {
            continue;
        }
        for k in 0..3 {
            counts.edges += 1;
            let ends = [k, (k + 1) % 3].map(|k| [item.vertices[k].x, item.vertices[k].y]);
            let others = waiting.entry([ends[1], ends[0]]).or_default();
            let fits = |&(other, side): &(u32, usize)| {
                let back = |item: u32| all[item as usize].contains(Sides::BACK);
                back(other) == back(number) && share(scene, item, k, &scene.items[other as usize], side)
            };
            match others.iter().rev().take(SEEK).position(fits) {
                Some(place) => {
                    let (other, side) = others.remove(others.len() - 1 - place);
                    waits -= 1;
                    all[other as usize].insert(Sides::from_bits_retain(1 << side));
                    all[number as usize].insert(Sides::from_bits_retain(1 << k));
                }
                None => {
                    waiting.entry(ends).or_default().push((number, k));
                    waits += 1;
                }
            }
        }
        most = most.max(waits);
    }
    if !scene.items.is_empty() {
        counts.edge_bytes = most * EDGE_BYTES + scene.items.len() as u64;
    }
    all
}

/// Whether no sample is covered twice.
fn disjoint(fragments: &[Fragment]) -> bool {
    let covered: u32 = fragments.iter().map(|fragment| fragment.mask.count_ones()).sum();
    fragments.iter().fold(0, |all, fragment| all | fragment.mask).count_ones() == covered
}
