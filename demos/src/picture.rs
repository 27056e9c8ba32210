//! Pictures as PNG files, and their exact comparison.
//!
//! Inputs from: frames of the driver. Outputs to: the files that a user asks for.

use std::io::Cursor;
use std::path::Path;

use image::{ColorType, ExtendedColorType, ImageDecoder, ImageFormat};

use crate::error::{Error, Result};
use crate::limits;

/// A picture in memory, dense rows of red, green, blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 3 bytes a pixel.
    pub rgb: Vec<u8>,
}

/// Where two pictures differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// They have different sizes.
    Sizes,
    /// So many pixels differ.
    Pixels {
        /// How many.
        count: u64,
        /// Column and row of the first one, row by row from the top.
        first: [u32; 2],
        /// Its colour in the golden picture.
        golden: [u8; 3],
        /// Its colour in the other.
        found: [u8; 3],
    },
}

impl Picture {
    /// A picture of XRGB8888 words.
    #[must_use]
    pub fn of_frame(frame: &zga_driver::Frame) -> Self {
        Self { width: frame.width, height: frame.height, rgb: rgb(&frame.pixels) }
    }

    /// A picture of `size` in XRGB8888 words, dense rows.
    #[must_use]
    pub fn of_xrgb([width, height]: [u32; 2], pixels: &[u32]) -> Self {
        Self { width, height, rgb: rgb(pixels) }
    }

    /// The picture as XRGB8888 words.
    #[must_use]
    pub fn xrgb(&self) -> Vec<u32> {
        self.rgb
            .as_chunks::<3>()
            .0
            .iter()
            .map(|[red, green, blue]| u32::from_be_bytes([0, *red, *green, *blue]))
            .collect()
    }

    /// Colour of a pixel; `None` outside.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let place = (y as usize * self.width as usize + x as usize) * 3;
        self.rgb.get(place..place + 3).map(|bytes| [bytes[0], bytes[1], bytes[2]])
    }

    /// Reads a PNG of 8 bits a channel; alpha is left out.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::TooLarge`]; [`Error::Picture`] for what is no such PNG.
    pub fn load(file: &Path) -> Result<Self> {
        let bytes = limits::read_file(file)?;
        let fault = |reason: String| Error::Picture { file: file.to_path_buf(), reason };
        let unreadable = |reason: image::ImageError| fault(reason.to_string());
        let decoder = image::codecs::png::PngDecoder::new(Cursor::new(bytes)).map_err(unreadable)?;
        let (width, height) = decoder.dimensions();
        let most = limits::MAX_TARGET_PIXELS_PER_SIDE;
        if width > most || height > most {
            return Err(fault(format!("has {width} x {height} pixels, expected at most {most} on a side")));
        }
        if !matches!(decoder.color_type(), ColorType::Rgb8 | ColorType::Rgba8) {
            return Err(fault(format!("has colours of type {:?}, expected 8 bits RGB or RGBA", decoder.color_type())));
        }
        let image = image::DynamicImage::from_decoder(decoder).map_err(unreadable)?;
        Ok(Self { width, height, rgb: image.into_rgb8().into_raw() })
    }

    /// Writes a PNG; folders that are missing are made.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save(&self, file: &Path) -> Result<()> {
        write_png(file, &self.rgb, [self.width, self.height], ExtendedColorType::Rgb8)
    }

    /// Compares with a golden picture, exactly.
    #[must_use]
    pub fn difference(&self, golden: &Self) -> Option<Difference> {
        if [self.width, self.height] != [golden.width, golden.height] {
            return Some(Difference::Sizes);
        }
        let pairs = || self.rgb.as_chunks::<3>().0.iter().zip(golden.rgb.as_chunks::<3>().0);
        let (place, (found, golden)) = pairs().enumerate().find(|(_, (found, golden))| found != golden)?;
        let count = pairs().filter(|(found, golden)| found != golden).count() as u64;
        let first = [place % self.width as usize, place / self.width as usize].map(|at| at as u32);
        Some(Difference::Pixels { count, first, golden: *golden, found: *found })
    }

    /// A picture of the difference: the golden one, pale and grey, with red where the two differ. It is as large as
    /// the larger one; what only one of the two has counts as different.
    #[must_use]
    pub fn difference_picture(&self, golden: &Self) -> Self {
        let (width, height) = (self.width.max(golden.width), self.height.max(golden.height));
        let mut rgb = Vec::with_capacity(width as usize * height as usize * 3);
        for y in 0..height {
            for x in 0..width {
                rgb.extend(match (self.at(x, y), golden.at(x, y)) {
                    (found, Some(colour)) if found == Some(colour) => {
                        let [r, g, b] = colour.map(u32::from);
                        // Rec. 709 luma, into the brightest third.
                        let grey = (54 * r + 183 * g + 19 * b) / 256;
                        [(168 + grey / 3) as u8; 3]
                    }
                    _ => [220, 20, 60],
                });
            }
        }
        Self { width, height, rgb }
    }
}

/// XRGB8888 words as red, green, blue.
fn rgb(pixels: &[u32]) -> Vec<u8> {
    let bytes = pixels.iter().flat_map(|pixel| {
        let [_, red, green, blue] = pixel.to_be_bytes();
        [red, green, blue]
    });
    bytes.collect()
}

/// Writes depths 0..=`maximum` as a PNG of 16 bits a pixel: 0 near, 65535 far, rounded to the nearest.
///
/// # Errors
/// [`Error::Write`].
pub fn save_depth(file: &Path, depths: &[u32], [width, height]: [u32; 2], maximum: u32) -> Result<()> {
    let maximum = u64::from(maximum.max(1));
    let scaled = depths.iter().map(|depth| ((u64::from(*depth) * 65535 + maximum / 2) / maximum).min(65535) as u16);
    // The encoder takes the bytes of 16-bit words as the host has them.
    let bytes: Vec<u8> = scaled.flat_map(u16::to_ne_bytes).collect();
    write_png(file, &bytes, [width, height], ExtendedColorType::L16)
}

/// Depths as a picture for the eye: what was drawn from white (nearest) to dark (farthest), on black.
#[must_use]
pub fn depth_picture(depths: &[u32], [width, height]: [u32; 2], maximum: u32) -> Picture {
    let drawn = || depths.iter().copied().filter(|depth| *depth < maximum);
    let (near, far) = (drawn().min().unwrap_or(0), drawn().max().unwrap_or(maximum));
    let range = f64::from(far - near).max(1.0);
    let grey = |depth: &u32| match *depth {
        depth if depth >= maximum => [0; 3],
        depth => [(255.0 - 215.0 * f64::from(depth - near) / range).round() as u8; 3],
    };
    Picture { width, height, rgb: depths.iter().flat_map(grey).collect() }
}

fn write_png(file: &Path, bytes: &[u8], [width, height]: [u32; 2], kind: ExtendedColorType) -> Result<()> {
    let mut png = Vec::new();
    image::write_buffer_with_format(&mut Cursor::new(&mut png), bytes, width, height, kind, ImageFormat::Png)
        .map_err(|reason| Error::write(file)(std::io::Error::other(reason)))?;
    write_file(file, &png)
}

/// Writes a file; folders that are missing are made.
///
/// # Errors
/// [`Error::Write`].
pub(crate) fn write_file(file: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(Error::write(folder))?;
    }
    std::fs::write(file, bytes).map_err(Error::write(file))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_by_one(rgb: [u8; 6]) -> Picture {
        Picture { width: 2, height: 1, rgb: rgb.to_vec() }
    }

    #[test]
    fn difference_counts_and_names_the_first_pixel() {
        let golden = two_by_one([1, 2, 3, 4, 5, 6]);
        assert_eq!(golden.difference(&golden), None);
        let found = two_by_one([1, 2, 3, 4, 5, 7]);
        let expected = Difference::Pixels { count: 1, first: [1, 0], golden: [4, 5, 6], found: [4, 5, 7] };
        assert_eq!(found.difference(&golden), Some(expected));
        assert_eq!(found.difference_picture(&golden).at(1, 0), Some([220, 20, 60]));
        assert_ne!(found.difference_picture(&golden).at(0, 0), Some([220, 20, 60]));
    }

    #[test]
    fn difference_of_other_sizes_is_told_and_shown() {
        let wide = two_by_one([0; 6]);
        let high = Picture { width: 1, height: 2, rgb: vec![0; 6] };
        assert_eq!(wide.difference(&high), Some(Difference::Sizes));
        let shown = wide.difference_picture(&high);
        assert_eq!((shown.width, shown.height), (2, 2));
        assert_ne!(shown.at(0, 0), Some([220, 20, 60]));
        assert_eq!([shown.at(1, 0), shown.at(0, 1), shown.at(1, 1)], [Some([220, 20, 60]); 3]);
    }

    #[test]
    fn png_written_and_read_is_the_same_picture() {
        let file = std::env::temp_dir().join(format!("zga-picture-{}.png", std::process::id()));
        let picture = two_by_one([9, 8, 7, 250, 251, 252]);
        picture.save(&file).expect("written");
        assert_eq!(Picture::load(&file).expect("read"), picture);
        save_depth(&file, &[0, 0xFF_FFFF], [2, 1], 0xFF_FFFF).expect("written");
        let refused = Picture::load(&file).expect_err("16 bits").to_string();
        assert!(refused.contains("expected 8 bits RGB or RGBA"), "{refused}");
        std::fs::write(&file, b"no picture").expect("written");
        assert!(Picture::load(&file).expect_err("damaged").to_string().contains("is not a picture to compare with"));
        std::fs::remove_file(&file).expect("removed");
    }

    #[test]
    fn depth_picture_is_white_near_dark_far_black_nowhere() {
        let picture = depth_picture(&[10, 20, 100], [3, 1], 100);
        assert_eq!(picture.rgb, [255, 255, 255, 40, 40, 40, 0, 0, 0]);
    }
}
