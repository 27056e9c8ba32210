//! The specification of a band: every mask sample by sample, every pixel on its own.
//!
//! What [`super::band`] must equal: fragments, active pixels, counts.

use super::band::{Input, Resolved, Work};
use super::bands::Entry;
use super::left::covers_centre;
use super::lists::Fragment;
use super::piece::{Cover, Piece};
use super::scene::Rule;
use super::{Counts, Setting};
use crate::hidden::z_buffer::specification::covers;

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
    left > 1 && !(one && base > limit && list.iter().any(|fragment| hides(fragment) && centre(fragment)))
}

/// Whether no sample is covered twice.
fn disjoint(fragments: &[Fragment]) -> bool {
    let covered: u32 = fragments.iter().map(|fragment| fragment.mask.count_ones()).sum();
    fragments.iter().fold(0, |all, fragment| all | fragment.mask).count_ones() == covered
}
