//! What is left of a pixel's fragments, and whether that makes it active.
//!
//! Opaque fragments that together cover every sample hide what lies behind the farthest of them; the *limit* is the
//! least depth at which some do. What was there before the first item counts as one of them, if its depth decides
//! something. A pixel is active if more than one is left, unless all of them have one colour and those that hide the
//! rest cover the pixel's centre too: then the path has drawn this colour there.
//!
//! Where borders alone are anti-aliased it is not active either if what is left lies *inside* a surface: it has one object
//! tag, covers every sample, none twice, and no border of it ([`super::edges`]) passes between the samples. The path has
//! drawn this surface there, unless a gap narrower than the samples' distance holds the centre.
//!
//! Inputs from: [`super::band`]. Outputs to: [`super::pixel`]. Clocks: none. [`super::specification`] has the same as
//! it is written here.

use super::band::{Input, Work};
use super::inside::meets_border;
use super::lists::Fragment;
use super::piece::Piece;
use super::scene::{Kind, Rule};
use crate::hidden::z_buffer::specification::covers;

/// So many fragments are put in order by insertion.
const FEW: usize = 16;

/// Drops the fragments that are hidden, and puts the others in order of submission. `None` if the pixel in column `x` of
/// line `line` is not active, else whether no sample of it is covered twice.
#[inline(always)]
pub(super) fn keep(work: &Work, input: &Input<'_>, list: &mut Vec<Fragment>, [x, line]: [usize; 2]) -> Option<bool> {
    // Most pixels have two fragments or three: loops over a known number have no end to be guessed.
    let mut cover = match &list[..] {
        [] => return None,
        two @ [_, _] => Cover::new(work, two),
        three @ [_, _, _] => Cover::new(work, three),
        all => Cover::new(work, all),
    };
    if input.setting.rule != Rule::InOrder {
        let base = input.base_at(x, line);
        let limit = cover.limit(work, input, list, base);
        let left = list.len() + usize::from(base <= limit);
        let place = [x as i32, input.top + line as i32];
        let is_one = || is_plain(work, input, list, limit, place) || cover.is_inside(work, input, list, place);
        if left < 2 || (limit < base && is_one()) {
            return None;
        }
    }
    let item = |fragment: &Fragment| work.briefs[fragment.piece as usize].item;
    match &mut list[..] {
        [a, b] => {
            if item(a) > item(b) {
                std::mem::swap(a, b);
            }
        }
        many if many.len() > FEW => many.sort_unstable_by_key(item),
        few => {
            for end in 1..few.len() {
                let mut place = end;
                while place > 0 && item(&few[place - 1]) > item(&few[place]) {
                    few.swap(place - 1, place);
                    place -= 1;
                }
            }
        }
    }
    Some(cover.twice == 0)
}

/// What the fragments of a pixel cover.
struct Cover {
    /// By any.
    all: u64,
    /// By two or more.
    twice: u64,
    /// By those that hide.
    solid: u64,
    /// One of them covers no sample, or hides nothing.
    odd: bool,
    /// The farthest of them.
    far: i32,
}

impl Cover {
    #[inline(always)]
    fn new(work: &Work, list: &[Fragment]) -> Cover {
        let mut cover = Cover { all: 0, twice: 0, solid: 0, odd: false, far: i32::MIN };
        for fragment in list {
            cover.twice |= cover.all & fragment.mask;
            cover.all |= fragment.mask;
            cover.far = cover.far.max(fragment.far);
            let layer = work.briefs[fragment.piece as usize].layer;
            cover.solid |= if layer { 0 } else { fragment.mask };
            cover.odd |= fragment.mask == 0 || layer;
        }
        cover
    }

    /// The limit of a pixel, behind which nothing of `list` stays.
    #[inline(always)]
    fn limit(&mut self, work: &Work, input: &Input<'_>, list: &mut Vec<Fragment>, base: i32) -> i32 {
        let full = input.setting.grid.full();
        // Without any of them there are samples that are not covered.
        if self.twice == 0 && !self.odd {
            return if self.all == full { self.far.min(base) } else { base };
        }
        if self.all != full {
            return base;
        }
        let mut limit = base;
        if self.solid == full {
            list.sort_unstable_by_key(|fragment| fragment.far);
            let mut union = 0;
            let solid = list.iter().filter(|fragment| !work.briefs[fragment.piece as usize].layer);
            let completes = solid.into_iter().find(|fragment| {
                union |= fragment.mask;
                union == full
            });
            limit = completes.map_or(base, |fragment| fragment.far.min(base));
        }
        list.retain(|fragment| fragment.near <= limit);
        *self = Cover::new(work, list);
        limit
    }

    /// Whether what is left lies inside a surface.
    #[inline(always)]
    fn is_inside(&self, work: &Work, input: &Input<'_>, list: &[Fragment], place: [i32; 2]) -> bool {
        let brief = |fragment: &Fragment| &work.briefs[fragment.piece as usize];
        let inner = |fragment: &Fragment| {
            let item = brief(fragment).item as usize;
            !meets_border(input.setting, &input.scene.items[item], input.edges[item], place)
        };
        !input.edges.is_empty()
            && self.twice == 0
            && self.solid == input.setting.grid.full()
            && list.iter().all(|fragment| brief(fragment).tag == brief(&list[0]).tag && inner(fragment))
    }
}

/// Whether all that is left has one colour, and the path has drawn it.
#[inline(always)]
fn is_plain(work: &Work, input: &Input<'_>, list: &[Fragment], limit: i32, place: [i32; 2]) -> bool {
    let brief = |fragment: &Fragment| &work.briefs[fragment.piece as usize];
    let colour = brief(&list[0]).colour;
    let covers =
        |fragment: &Fragment| covers_centre(input, &work.pieces[fragment.piece as usize], fragment.mask, place);
    list.iter().map(brief).all(|brief| brief.plain && brief.colour == colour && !brief.layer)
        && list.iter().any(|fragment| fragment.far <= limit && covers(fragment))
}

/// Whether a fragment covers its pixel's centre.
pub(super) fn covers_centre(input: &Input<'_>, piece: &Piece, mask: u64, [x, y]: [i32; 2]) -> bool {
    piece.kind != Kind::Masked
        || mask == input.setting.grid.full()
        || covers(&input.scene.items[piece.item as usize].vertices, x, y)
}
