//! A composition: pictures, paints, and entries with or without pixels of their own.
//!
//! As for the lists entries need no check of their places; see [`super::Canvas`].

use super::lists::{clip_boxes, place_of, take_rows};
use super::{ClipBox, Image, ListRectangle};
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_abi::packet::compose::{self, Transform};

/// Pixels with a meaning for a composition.
///
/// # Invariants
/// `image.format` is `format.layout()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Where they are.
    pub image: Image,
    /// What they mean.
    pub format: PictureFormat,
}

/// A picture as it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampled {
    /// The picture. It shares no byte with what is drawn onto.
    pub picture: Picture,
    /// From a pixel's place to that of the picture's, or to what is transformed; -65535..=65535.
    pub offset: [i32; 2],
    /// What lies outside.
    pub repeat: Repeat,
    /// Transformed, or pixel by pixel.
    pub transform: Option<Transform>,
}

/// A colour for each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// An ARGB word everywhere.
    Colour(u32),
    /// A picture's.
    Picture(Sampled),
}

/// What a source goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mask {
    /// Nothing.
    None,
    /// A paint.
    Paint(Paint),
    /// The pixels of each entry: alpha8 or argb8888.
    Inline(PictureFormat),
}

/// A composition in rectangles.
///
/// # Invariants
/// The operator is not destination. `clips` holds whole boxes, `entries` whole entries. `components` only with a mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Compose<'a> {
    /// All of the surface.
    pub onto: Picture,
    /// How source and destination are put together.
    pub operator: ComposeOperator,
    /// Each channel of the mask is for itself.
    pub components: bool,
    /// What is drawn.
    pub source: Paint,
    /// What it goes through.
    pub mask: Mask,
    /// Added to the places of entries.
    pub origin: [i32; 2],
    /// Words of the clip boxes, two each.
    pub clips: &'a [u32],
    /// Words of the entries.
    pub entries: &'a [u32],
}

/// A rectangle, and the pixels of an inline mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComposeEntry<'a> {
    /// Where it goes, with the origin added.
    pub place: ListRectangle,
    /// Rows of whole words; none without an inline mask.
    pub rows: &'a [u32],
}

impl<'a> Compose<'a> {
    /// The clip boxes cut to the surface, without those that are empty then.
    pub fn clip_boxes(&self) -> impl Iterator<Item = ClipBox> + use<'a> {
        clip_boxes(&self.onto.image, self.clips)
    }

    /// Bytes of a pixel in an entry; 0 without an inline mask.
    #[must_use]
    pub const fn inline_bytes(&self) -> u32 {
        match self.mask {
            Mask::Inline(format) => format.bytes(),
            Mask::None | Mask::Paint(_) => 0,
        }
    }

    /// The entries, in order.
    pub fn entries(&self) -> impl Iterator<Item = ComposeEntry<'a>> + use<'a> {
        let (origin, bytes, mut rest) = (self.origin, self.inline_bytes(), self.entries);
        core::iter::from_fn(move || {
            let (&[place, size], behind) = rest.split_first_chunk::<2>()?;
            let (rows, behind) = take_rows(behind, size, |width| compose::row_words(width, bytes))?;
            rest = behind;
            Some(ComposeEntry { place: place_of(place, size, origin), rows })
        })
    }
}

/// Whether words are whole entries with rows of pixels of `bytes` bytes.
pub(crate) fn are_entries(mut words: &[u32], bytes: u32) -> bool {
    while !words.is_empty() {
        let Some((&[_, size], behind)) = words.split_first_chunk::<2>() else { return false };
        let Some((_, behind)) = take_rows(behind, size, |width| compose::row_words(width, bytes)) else { return false };
        words = behind;
    }
    true
}
