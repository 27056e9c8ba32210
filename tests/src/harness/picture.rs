//! What was read back from the card, and how it differs from the oracle's picture.

use super::options::Pixels;
use crate::oracle::{Image, TrueImage, Verdict};
use num_rational::BigRational;
use std::fmt;

use crate::oracle::Primitive;

/// Frame buffer and Z buffer, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Format of `colour`.
    pub pixels: Pixels,
    /// Stored pixels.
    pub colour: Vec<u32>,
    /// Stored depths.
    pub depth: Vec<u32>,
    /// Stored stencil values; none without a plane.
    pub stencil: Vec<u8>,
    /// Words of video memory outside the rows' pixels (row ends, and 4 KiB before and behind each buffer) that changed.
    pub strays: usize,
}

/// How a picture differs from the oracle's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Differences {
    /// Pixels compared.
    pub pixels: usize,
    /// Pixels that show another primitive.
    pub winner: usize,
    /// Pixels that hold another depth.
    pub depth: usize,
    /// Words written outside the target.
    pub strays: usize,
    /// The first of them: column, row, (winner, depth) of the card, and of the oracle.
    pub first: Option<String>,
}

impl Differences {
    /// Whether there are none.
    #[must_use]
    pub const fn none(&self) -> bool {
        self.winner == 0 && self.depth == 0 && self.strays == 0
    }

    /// Pixels that differ in any way, and stray words.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.winner + self.depth + self.strays
    }
}

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.none() {
            return write!(f, "{} pixels, none differ", self.pixels);
        }
        let Self { pixels, winner, depth, strays, first } = self;
        write!(f, "{pixels} pixels, {winner} winners and {depth} depths differ, {strays} stray words")?;
        first.as_ref().map_or(Ok(()), |first| write!(f, "; first {first}"))
    }
}

impl Picture {
    /// What is seen at each pixel of a picture drawn with identities; `None` is the background.
    #[must_use]
    pub fn winners(&self) -> Vec<Option<u32>> {
        self.colour.iter().map(|&pixel| self.pixels.id_of(pixel).checked_sub(1)).collect()
    }

    /// Number of pixels that something was drawn to.
    #[must_use]
    pub fn drawn(&self) -> usize {
        self.winners().iter().flatten().count()
    }

    /// Compares with the oracle's picture, winner by winner and depth by depth.
    ///
    /// # Panics
    /// When the sizes differ.
    #[must_use]
    pub fn against(&self, image: &Image) -> Differences {
        assert_eq!((self.width, self.height), (image.width, image.height), "pictures of one size");
        let winners = self.winners();
        let mut found = Differences { pixels: winners.len(), winner: 0, depth: 0, strays: self.strays, first: None };
        for (k, winner) in winners.iter().enumerate() {
            let (card, oracle) = ((*winner, self.depth[k]), (image.winner[k], image.depth[k]));
            found.winner += usize::from(card.0 != oracle.0);
            found.depth += usize::from(card.1 != oracle.1);
            if card != oracle && found.first.is_none() {
                let (i, j) = (k as u32 % self.width, k as u32 / self.width);
                found.first = Some(format!("({i}, {j}): card {card:?}, oracle {oracle:?}"));
            }
        }
        found
    }

    /// Compares what is seen with the true picture; see [`TrueImage::judge`].
    #[must_use]
    pub fn judged(&self, image: &TrueImage, primitives: &[Primitive], allowed: &BigRational) -> Verdict {
        image.judge(primitives, &self.winners(), allowed)
    }

    /// Pixel and depth at column `i`, row `j`.
    #[must_use]
    pub fn at(&self, i: u32, j: u32) -> (u32, u32) {
        let k = (j * self.width + i) as usize;
        (self.colour[k], self.depth[k])
    }
}
