//! Pictures for textures: a value in memory, read from PNG and JPEG files, or made by code.
//!
//! Duties: holds the texels of level 0 ([`Picture`]); reads files within limits (`read`); finds palettes
//! (`quantise`). Smaller levels and packed formats are the driver's.
//! Inputs from: scene files, meshes, demonstrations. Outputs to: [`crate::scene::Texture`].

mod quantise;
mod read;
#[cfg(test)]
pub(crate) mod tests;

use std::fmt;

pub use quantise::Indexed;
pub(crate) use read::Room;

use crate::limits::{MAX_PICTURE_SIDE, MAX_PICTURE_TEXELS};
use crate::scene::Colour;

/// The texels of a texture, RGBA of 8 bits each, dense rows from the top.
///
/// # Invariants
/// Both sides are 1..=[`MAX_PICTURE_SIDE`], and there are as many texels as they say, at most [`MAX_PICTURE_TEXELS`].
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    size: [u32; 2],
    pixels: Vec<Colour>,
}

impl fmt::Debug for Picture {
    /// The size alone: scenes are printed in messages of tests.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(formatter, "Picture({width} x {height})")
    }
}

impl Picture {
    /// A picture of `size` (width, height) texels, row by row from the top; none unless the size is possible and there
    /// are as many pixels.
    #[must_use]
    pub fn new(size: [u32; 2], pixels: Vec<Colour>) -> Option<Self> {
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let possible = size.iter().all(|side| (1..=MAX_PICTURE_SIDE).contains(side)) && texels <= MAX_PICTURE_TEXELS;
        (possible && texels == pixels.len() as u64).then_some(Self { size, pixels })
    }

    /// A picture whose texel at column x and row y is `colour(x, y)`; none if the size is not possible.
    #[must_use]
    pub fn from_fn(size: [u32; 2], colour: impl Fn(u32, u32) -> Colour) -> Option<Self> {
        let [width, height] = size;
        if u64::from(width) * u64::from(height) > MAX_PICTURE_TEXELS {
            return None;
        }
        let row = |y| (0..width).map(move |x| (x, y));
        Self::new(size, (0..height).flat_map(row).map(|(x, y)| colour(x, y)).collect())
    }

    /// Width and height, texels.
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Texels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[Colour] {
        &self.pixels
    }

    /// Texel of column x and row y; the last one of the row or column past the end.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Colour {
        let [width, height] = self.size;
        self.pixels[y.min(height - 1) as usize * width as usize + x.min(width - 1) as usize]
    }

    /// Every texel has alpha 255.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.pixels.iter().all(|pixel| pixel[3] == 255)
    }

    /// The picture with alphas from `alpha`, which is read at the nearest texel where its size is another.
    #[must_use]
    pub(crate) fn with_alphas(&self, alpha: impl Fn(u32, u32) -> u8) -> Self {
        let mut picture = self.clone();
        let width = self.size[0] as usize;
        for (place, pixel) in picture.pixels.iter_mut().enumerate() {
            pixel[3] = alpha((place % width) as u32, (place / width) as u32);
        }
        picture
    }
}
