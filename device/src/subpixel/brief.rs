//! What is asked of a piece for every one of its fragments, in half a line of the host's cache.
//!
//! Inputs from: [`super::piece`], [`super::scene`]. Outputs to: [`super::left`], [`super::pixel`].

use super::piece::Piece;
use super::scene::{ItemDraw, Kind};

/// A piece in brief.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brief {
    /// Its item's place in the scene: the order of submission.
    pub(super) item: u32,
    /// Least and greatest depth of its vertices; 0 where the draw has no depths.
    pub(super) range: [i32; 2],
    /// Object tag.
    pub(super) tag: u32,
    /// The one colour that it has all over, if `flat` or `plain`; RGBA, R in 7:0.
    pub(super) colour: u32,
    /// Its colour costs nothing: that of its first vertex.
    pub(super) flat: bool,
    /// It has one colour all over.
    pub(super) plain: bool,
    /// It may be translucent or have holes somewhere: it hides nothing.
    pub(super) layer: bool,
    /// It may have holes.
    pub(super) holes: bool,
    /// Its draw blends.
    pub(super) blend: bool,
    /// It is a clear.
    pub(super) clear: bool,
}

impl Brief {
    /// Piece `piece`, of a draw.
    #[inline(always)]
    pub(super) fn new(piece: &Piece, draw: &ItemDraw) -> Brief {
        Brief {
            item: piece.item,
            range: if draw.test.is_some() { [piece.plane.minimum, piece.plane.maximum] } else { [0; 2] },
            tag: draw.tag,
            colour: piece.plain.unwrap_or(piece.source.flat()),
            flat: !draw.is_shaded(),
            plain: piece.plain.is_some(),
            layer: piece.layer,
            holes: draw.has_holes(),
            blend: draw.blend,
            clear: piece.kind == Kind::Clear,
        }
    }
}
