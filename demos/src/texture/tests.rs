//! Pictures in memory, from files good and damaged, and in palettes.

use std::io::Cursor;

use image::{ExtendedColorType, ImageFormat};
use proptest::prelude::*;

use super::*;

/// A PNG or JPEG file of these bytes.
pub(crate) fn encoded(bytes: &[u8], [width, height]: [u32; 2], kind: ExtendedColorType, as_: ImageFormat) -> Vec<u8> {
    let mut file = Vec::new();
    image::write_buffer_with_format(&mut Cursor::new(&mut file), bytes, width, height, kind, as_).expect("encodes");
    file
}

/// A PNG of RGBA texels.
pub(crate) fn png(size: [u32; 2], pixels: &[Colour]) -> Vec<u8> {
    encoded(pixels.as_flattened(), size, ExtendedColorType::Rgba8, ImageFormat::Png)
}

fn decoded(bytes: &[u8]) -> Result<Picture, String> {
    Picture::decode(bytes, &mut Room::default())
}

/// A PNG header that promises this size, and nothing behind it.
fn promise(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\x0DIHDR".to_vec();
    bytes.extend(width.to_be_bytes());
    bytes.extend(height.to_be_bytes());
    bytes.extend([8, 6, 0, 0, 0]);
    bytes
}

#[test]
fn picture_new_wants_as_many_pixels_as_the_size_says() {
    assert!(Picture::new([2, 1], vec![[1; 4]; 2]).is_some());
    assert_eq!(Picture::new([2, 1], vec![[1; 4]; 3]), None);
    assert_eq!(Picture::new([0, 1], vec![]), None);
    assert_eq!(Picture::new([16385, 1], vec![[1; 4]; 16385]), None);
    assert_eq!(Picture::from_fn([16384, 16384], |_, _| [0; 4]), None);
    let ramp = Picture::from_fn([3, 2], |x, y| [x as u8, y as u8, 0, 255]).expect("possible");
    assert_eq!((ramp.at(2, 1), ramp.at(9, 9), ramp.is_opaque()), ([2, 1, 0, 255], [2, 1, 0, 255], true));
}

#[test]
fn decode_png_of_every_colour_type_is_rgba() {
    let rgba = png([2, 1], &[[1, 2, 3, 4], [250, 251, 252, 253]]);
    assert_eq!(decoded(&rgba).expect("valid").pixels(), [[1, 2, 3, 4], [250, 251, 252, 253]]);
    let rgb = encoded(&[9, 8, 7], [1, 1], ExtendedColorType::Rgb8, ImageFormat::Png);
    assert_eq!(decoded(&rgb).expect("valid").pixels(), [[9, 8, 7, 255]]);
    let grey = encoded(&[77, 78], [1, 2], ExtendedColorType::L8, ImageFormat::Png);
    assert_eq!(decoded(&grey).expect("valid").pixels(), [[77, 77, 77, 255], [78, 78, 78, 255]]);
    let words: Vec<u8> = [0_u16, 0xFFFF, 0x8080, 0xFFFF].into_iter().flat_map(u16::to_ne_bytes).collect();
    let deep = encoded(&words, [1, 1], ExtendedColorType::Rgba16, ImageFormat::Png);
    assert_eq!(decoded(&deep).expect("valid").pixels(), [[0, 255, 128, 255]]);
}

#[test]
fn decode_jpeg_is_close_to_what_was_encoded() {
    let bytes: Vec<u8> = (0..16 * 16).flat_map(|i| if i % 16 < 8 { [200, 40, 40] } else { [40, 40, 200] }).collect();
    let file = encoded(&bytes, [16, 16], ExtendedColorType::Rgb8, ImageFormat::Jpeg);
    let picture = decoded(&file).expect("valid");
    assert_eq!((picture.size(), picture.is_opaque()), ([16, 16], true));
    // Away from the edge; 24 levels are what the encoder's default quality loses at most on such a block.
    let near = |[r, g, b, _]: Colour, want: [u8; 3]| [r, g, b].iter().zip(want).all(|(a, b)| a.abs_diff(b) <= 24);
    assert!(near(picture.at(2, 8), [200, 40, 40]), "{:?}", picture.at(2, 8));
    assert!(near(picture.at(13, 8), [40, 40, 200]), "{:?}", picture.at(13, 8));
}

#[test]
fn decode_refuses_a_size_before_the_texels_are_read() {
    let fault = |bytes: &[u8]| decoded(bytes).expect_err("refused");
    assert!(fault(&promise(16385, 1)).contains("has 16385 x 1 texels, expected at most 16384 on a side"));
    assert!(fault(&promise(16384, 16384)).contains("has 16384 x 16384 texels"));
    assert!(fault(&promise(0, 4)).contains("has 0 x 4 texels"));
    assert!(fault(&promise(4, 4)).contains("cannot be decoded"));
    assert!(fault(&promise(4, 4)[..20]).contains("ends inside the header"));
    assert!(fault(b"GIF89a").contains("is neither a PNG nor a JPEG"));
    assert!(fault(&[0xFF, 0xD8, 0xFF, 0xE0]).contains("cannot be decoded"));
    let wide = {
        let mut file = encoded(&[0; 3], [1, 1], ExtendedColorType::Rgb8, ImageFormat::Jpeg);
        let frame = file.windows(2).position(|pair| pair[0] == 0xFF && (0xC0..=0xC2).contains(&pair[1]));
        let height = frame.expect("a frame header") + 5;
        file[height..height + 4].fill(0xFF);
        file
    };
    assert!(fault(&wide).contains("has 65535 x 65535 texels"));
}

#[test]
fn decode_room_is_used_up_by_what_was_read() {
    let file = png([2, 2], &[[1; 4]; 4]);
    let mut room = Room::with(7);
    assert!(Picture::decode(&file, &mut room).is_ok());
    assert!(Picture::decode(&file, &mut room).expect_err("3 are left").contains("all pictures together"));
}

#[test]
fn load_names_the_file() {
    let fault = Picture::load(std::path::Path::new("nowhere/none.png")).expect_err("no such file");
    assert!(fault.contains("nowhere/none.png"), "{fault}");
}

#[test]
fn quantised_few_colours_are_kept_exactly() {
    let picture = Picture::from_fn([16, 16], |x, y| [x as u8, y as u8, 7, 255]).expect("possible");
    let indexed = picture.quantised(256);
    assert_eq!(indexed.palette.len(), 256);
    let back: Vec<Colour> = indexed.indices.iter().map(|place| indexed.palette[usize::from(*place)]).collect();
    assert_eq!(back, picture.pixels());
}

#[test]
fn quantised_ramp_in_16_colours_is_near_everywhere() {
    let picture = Picture::from_fn([256, 1], |x, _| [x as u8, x as u8, x as u8, 255]).expect("possible");
    let indexed = picture.quantised(16);
    assert_eq!(indexed.palette.len(), 16);
    for (pixel, place) in picture.pixels().iter().zip(&indexed.indices) {
        // 16 equal parts of a ramp of 256 levels have their means 8 levels from their ends.
        assert!(indexed.palette[usize::from(*place)][0].abs_diff(pixel[0]) <= 8, "{pixel:?}");
    }
}

#[test]
fn quantised_more_colours_than_are_told_apart_takes_cells() {
    let picture = Picture::from_fn([512, 256], |x, y| [x as u8, y as u8, (x >> 1) as u8, 255]).expect("possible");
    let indexed = picture.quantised(256);
    assert!((200..=256).contains(&indexed.palette.len()), "{}", indexed.palette.len());
    let error = |(pixel, place): (&Colour, &u8)| -> u64 {
        let known = indexed.palette[usize::from(*place)];
        (0..4).map(|i| u64::from(known[i].abs_diff(pixel[i])).pow(2)).sum()
    };
    let sum: u64 = picture.pixels().iter().zip(&indexed.indices).map(error).sum();
    // Two sheets of 256 x 286 levels in 256 squares of 24 x 24: 2 * 24^2 / 12 = 96 a texel. Cuts at the mean of one
    // channel do not make squares of sheets that stand askew, so a third more.
    assert!(sum / 131_072 < 128, "{}", sum / 131_072);
    assert_eq!(indexed, picture.quantised(256));
}

#[test]
fn in_palette_takes_the_nearest_and_of_equals_the_first() {
    let picture = Picture::new([3, 1], vec![[10, 0, 0, 255], [20, 0, 0, 255], [15, 0, 0, 255]]).expect("possible");
    let indexed = picture.in_palette(&[[20, 0, 0, 255], [10, 0, 0, 255], [10, 0, 0, 255]]);
    assert_eq!(indexed.indices, [1, 0, 0]);
    assert_eq!(picture.in_palette(&[]), Indexed { palette: vec![[255; 4]], indices: vec![0; 3] });
}

proptest! {
    #[test]
    fn decode_damaged_files_never_panics(
        jpeg in any::<bool>(),
        changes in proptest::collection::vec((0..4000_usize, any::<u8>()), 1..6),
        length in 0..4000_usize,
    ) {
        let bytes: Vec<u8> = (0..24 * 24 * 3).map(|i: u32| ((i * i) >> 3) as u8).collect();
        let format = if jpeg { ImageFormat::Jpeg } else { ImageFormat::Png };
        let mut file = encoded(&bytes, [24, 24], ExtendedColorType::Rgb8, format);
        for (place, byte) in changes {
            let place = place % file.len();
            file[place] = byte;
        }
        // Half of the cases are cut as well.
        file.truncate(length.max(file.len() / 2 * (length % 2) + 1));
        if let Ok(picture) = decoded(&file) {
            prop_assert_eq!(picture.pixels().len() as u64, picture.size().map(u64::from).iter().product::<u64>());
        }
    }

    #[test]
    fn quantised_every_index_is_in_the_palette(
        pixels in proptest::collection::vec(any::<[u8; 4]>(), 1..60), most in 0..300_usize,
    ) {
        let picture = Picture::new([pixels.len() as u32, 1], pixels).expect("possible");
        let indexed = picture.quantised(most);
        prop_assert!((1..=most.clamp(1, 256)).contains(&indexed.palette.len()));
        prop_assert!(indexed.indices.iter().all(|place| usize::from(*place) < indexed.palette.len()));
        prop_assert_eq!(indexed.indices.len(), picture.pixels().len());
    }
}
