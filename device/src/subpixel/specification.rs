//! The specification of a band: every mask sample by sample, every pixel on its own.
//!
//! What [`super::band`] must equal: fragments, active pixels, counts.

use super::band::{Input, Work};
use super::piece::{Cover, Piece};
use super::pixel::Fragment;
use super::scene::Rule;
use super::{Counts, Setting};
use crate::hidden::z_buffer::specification::covers;

/// Finds the active pixels of a band and their fragments.
pub fn gather(work: &mut Work, input: &Input<'_>, counts: &mut Counts) {
    work.begin(input, counts);
    find(work, input, counts);
    if work.lists.count(input) {
        // The masks are counted already.
        find(work, input, &mut Counts::default());
        work.lists.fit(input);
        find(work, input, &mut Counts::default());
    }
}

fn find(work: &mut Work, input: &Input<'_>, counts: &mut Counts) {
    for line in 0..input.lines {
        for x in 0..input.setting.size[0] as usize {
            pixel(work, input, x, line, counts);
        }
    }
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
    inside && !piece.layer && matches!(cover, Cover::Samples(_)) && covers(vertices, x, y)
}

fn pixel(work: &mut Work, input: &Input<'_>, x: usize, line: usize, counts: &mut Counts) {
    let (column, y) = (x as i32, input.top + line as i32);
    let full = input.setting.grid.full();
    let at = (line * input.words() * 64 + x) as u32;
    let pieces = work.pieces.iter().zip(&work.covers).zip(0..);
    let found = pieces.filter_map(|((piece, cover), number)| {
        let mask = mask(input, piece, cover, column, y);
        (mask != 0 || centre_only(input, piece, cover, column, y)).then_some((piece, number, mask))
    });
    let found: Vec<_> = found.collect();
    let whole = |(piece, _, mask): &&(&Piece, u32, u64)| *mask == full && !piece.layer;
    let (seen, crossed): (Vec<_>, bool) = if input.setting.rule == Rule::InOrder {
        let covers = found.iter().filter(whole).map(|(piece, ..)| if input.undecided(piece) { 2 } else { 1 });
        let crossed = covers.sum::<usize>() >= 2;
        (found, crossed)
    } else {
        let base = input.base_at(x, line);
        let spans = found.iter().filter(whole).map(|(piece, ..)| piece.bounds(column, y));
        let limit = spans.clone().map(|bounds| bounds[1]).fold(base, i32::min);
        let not_hidden = spans.filter(|bounds| bounds[0] <= limit).count() + usize::from(base <= limit);
        (found.into_iter().filter(|(piece, ..)| piece.bounds(column, y)[0] <= limit).collect(), not_hidden >= 2)
    };
    counts.masks += seen.iter().filter(|(_, _, mask)| *mask != full).count() as u64;
    let active = crossed || seen.iter().any(|(piece, _, mask)| *mask != full || piece.layer);
    if active {
        work.active[line * input.words() + x / 64] |= 1 << (x % 64);
        let fragments: Vec<_> = seen.iter().map(|&(_, piece, mask)| Fragment { mask, at, piece }).collect();
        fragments.into_iter().for_each(|fragment| work.lists.put(fragment));
    }
}
