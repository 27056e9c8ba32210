//! What is left of a pixel's fragments, and whether that makes it active.
//!
//! Opaque fragments that together cover every sample hide what lies behind the farthest of them; the *limit* is the
//! least depth at which some do. What was there before the first item counts as one of them, if its depth decides
//! something. A pixel is active if more than one is left, unless all of them have one colour and those that hide the
//! rest cover the pixel's centre too: then the path has drawn this colour there.
//!
//! Inputs from: [`super::band`]. Outputs to: [`super::pixel`]. Clocks: none. [`super::specification`] has the same as
//! it is written here.

use super::band::{Input, Work};
use super::lists::Fragment;
use super::piece::Piece;
use super::scene::{Kind, Rule};
use crate::hidden::z_buffer::specification::covers;

/// So many fragments are put in order by insertion.
const FEW: usize = 16;

/// Drops the fragments that are hidden, and puts the others in order of submission. Whether the pixel in column `x` of
/// line `line` is active.
#[inline(always)]
pub(super) fn keep(work: &Work, input: &Input<'_>, list: &mut Vec<Fragment>, [x, line]: [usize; 2]) -> bool {
    if list.is_empty() {
        return false;
    }
    if input.setting.rule != Rule::InOrder {
        let base = input.base_at(x, line);
        let limit = limit(work, input, list, base);
        let left = list.len() + usize::from(base <= limit);
        if left < 2 || (limit < base && is_plain(work, input, list, limit, [x as i32, input.top + line as i32])) {
            return false;
        }
    }
    let number = |fragment: &Fragment| work.numbers[fragment.piece as usize];
    if list.len() > FEW {
        list.sort_unstable_by_key(number);
        return true;
    }
    for end in 1..list.len() {
        let mut place = end;
        while place > 0 && number(&list[place - 1]) > number(&list[place]) {
            list.swap(place - 1, place);
            place -= 1;
        }
    }
    true
}

/// The limit of a pixel, behind which nothing of `list` stays.
#[inline(always)]
fn limit(work: &Work, input: &Input<'_>, list: &mut Vec<Fragment>, base: i32) -> i32 {
    let full = input.setting.grid.full();
    let (mut all, mut twice, mut odd, mut far) = (0, 0, false, i32::MIN);
    for fragment in &*list {
        twice |= all & fragment.mask;
        all |= fragment.mask;
        far = far.max(fragment.far);
        odd |= fragment.mask == 0 || work.pieces[fragment.piece as usize].layer;
    }
    // Without any of them there are samples that are not covered.
    if twice == 0 && !odd {
        return if all == full { far.min(base) } else { base };
    }
    if all != full {
        return base;
    }
    list.sort_unstable_by_key(|fragment| fragment.far);
    let mut union = 0;
    let opaque = list.iter().filter(|fragment| !work.pieces[fragment.piece as usize].layer);
    let limit = opaque.into_iter().find_map(|fragment| {
        union |= fragment.mask;
        (union == full).then_some(fragment.far)
    });
    let limit = limit.map_or(base, |limit| limit.min(base));
    list.retain(|fragment| fragment.near <= limit);
    limit
}

/// Whether all that is left has one colour, and the path has drawn it.
#[inline(always)]
fn is_plain(work: &Work, input: &Input<'_>, list: &[Fragment], limit: i32, place: [i32; 2]) -> bool {
    let piece = |fragment: &Fragment| &work.pieces[fragment.piece as usize];
    let Some(colour) = piece(&list[0]).plain else {
        return false;
    };
    list.iter().all(|fragment| piece(fragment).plain == Some(colour) && !piece(fragment).layer)
        && list
            .iter()
            .any(|fragment| fragment.far <= limit && covers_centre(input, piece(fragment), fragment.mask, place))
}

/// Whether a fragment covers its pixel's centre.
pub(super) fn covers_centre(input: &Input<'_>, piece: &Piece, mask: u64, [x, y]: [i32; 2]) -> bool {
    piece.kind != Kind::Masked
        || mask == input.setting.grid.full()
        || covers(&input.scene.items[piece.item as usize].vertices, x, y)
}
