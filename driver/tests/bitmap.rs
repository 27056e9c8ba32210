//! Images and the bitmap unit: what the driver sends, what it refuses, and what the card makes of it.

mod common;

use common::{driver, opcodes, target, triangle};
use zga_abi::format::{BitmapFormat, PixelFormat, RasterOperation, StretchFilter};
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{Driver, DriverError, Image, ImageError, Placement, Raster, Rectangle, Submit, Target, TargetOptions};

const RED: u32 = 0xFFFF_0000;
const BLUE: u32 = 0xFF00_00FF;

const fn rectangle(x: u32, y: u32, right: u32, bottom: u32) -> Rectangle {
    Rectangle { x, y, right, bottom }
}

fn card() -> Card {
    Card::power_on(CardOptions { video_memory: 4 << 20, threads: 1, ..CardOptions::default() }).expect("powers on")
}

/// A row of an image, as its first words.
fn row(driver: &mut Driver<CardBus>, image: &Image, row: u32, words: usize) -> Vec<u32> {
    driver.finish().expect("done");
    let mut read = vec![0; words];
    driver.read_memory(image.memory(), row * image.pitch() / 4, &mut read).expect("inside");
    read
}

/// A target of 64 x 48 pixels without a Z buffer that is shown when it is presented.
fn shown(driver: &mut Driver<CardBus>) -> Target {
    driver.create_target(TargetOptions { depth: None, ..TargetOptions::new(64, 48) }).expect("room")
}

// What is sent --------------------------------------------------------------------------------

#[test]
fn calls_send_the_words_of_the_manual() {
    let mut driver = driver(Submit::Ring);
    // The ring takes 16 KiB: 0x4000 and pitch 64, 0x4000 + 64 * 8 and pitch 64.
    let wide = driver.create_image(16, 8, BitmapFormat::Argb8888).expect("room");
    let mask = driver.create_image(40, 8, BitmapFormat::Alpha8).expect("room");
    let (a, b) = (0x4000, 0x4200);
    let xor = Raster { operation: RasterOperation::Xor, planes: 0xF0 };
    driver.fill(&wide, rectangle(1, 2, 4, 8), 5).expect("sent");
    driver.fill(&mask, rectangle(1, 2, 4, 8), 6).expect("sent");
    driver.fill_rop(&wide, rectangle(1, 2, 4, 8), 7, xor).expect("sent");
    driver.copy(&wide, [3, 1], &wide, rectangle(1, 2, 4, 8)).expect("sent");
    driver.copy(&mask, [3, 1], &mask, rectangle(1, 2, 4, 8)).expect("sent");
    driver.copy_rop(&wide, [3, 1], &wide, rectangle(1, 2, 4, 8), xor).expect("sent");
    driver.convert(&wide, [3, 1], &mask, rectangle(1, 2, 4, 8)).expect("sent");
    let placement = Placement { x: -2, y: 3, width: 50, height: 20 };
    let clip = rectangle(1, 0, 100, 100);
    driver.stretch(&wide, rectangle(3, 1, 16, 8), &mask, placement, clip, StretchFilter::Bilinear).expect("sent");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    assert_eq!(packets[0], [0x2000_0008, a, 64, 1, 1, 2, 3, 6, 5]);
    assert_eq!(packets[1], [0x2400_000A, b, 64, 3, 1, 2, 3, 6, 6, 3, u32::MAX]);
    assert_eq!(packets[2], [0x2400_000A, a, 64, 1, 1, 2, 3, 6, 7, 6, 0xF0]);
    assert_eq!(packets[3], [0x2100_000B, 1, a, 64, 3, 1, a, 64, 1, 2, 3, 6]);
    assert_eq!(packets[4], [0x2500_000D, 3, b, 64, 3, 1, b, 64, 1, 2, 3, 6, 3, u32::MAX]);
    assert_eq!(packets[5], [0x2500_000D, 1, a, 64, 3, 1, a, 64, 1, 2, 3, 6, 6, 0xF0]);
    assert_eq!(packets[6], [0x2600_000C, 1, a, 64, 3, 1, 3, b, 64, 1, 2, 3, 6]);
    // Columns 1 to 39 of the mask are 3 to 41 of the placement, rows 3 to 7 are 0 to 4.
    assert_eq!(packets[7], [0x2700_0013, 1, 1, a, 64, 3, 1, 13, 7, 3, b, 64, 1, 3, 39, 5, 50, 20, 3, 0]);
}

#[test]
fn empty_rectangles_send_nothing() {
    let mut driver = driver(Submit::Ring);
    let image = driver.create_image(16, 8, BitmapFormat::Rgb565).expect("room");
    let empty = rectangle(3, 3, 3, 8);
    driver.fill(&image, empty, 5).expect("nothing");
    driver.fill_rop(&image, empty, 5, Raster::new(RasterOperation::Set)).expect("nothing");
    driver.copy(&image, [0, 0], &image, empty).expect("nothing");
    driver.convert(&image, [0, 0], &image, empty).expect("nothing");
    let whole = rectangle(0, 0, 16, 8);
    let beyond = Placement { x: 16, y: 0, width: 4, height: 4 };
    driver.stretch(&image, whole, &image, beyond, whole, StretchFilter::Nearest).expect("nothing");
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), []);
}

#[test]
fn target_is_its_frame_buffer_that_is_drawn_to() {
    let mut driver = driver(Submit::Ring);
    let options = TargetOptions { double_buffered: true, ..TargetOptions::new(64, 48) };
    let target = driver.create_target(options).expect("room");
    let mut bases = [0; 2];
    for base in &mut bases {
        driver.fill(&target, rectangle(0, 0, 64, 48), 1).expect("sent");
        driver.finish().expect("done");
        *base = driver.bus_mut().take_packets()[0][1];
        driver.present(&target).expect("shown");
        driver.finish().expect("done");
        driver.bus_mut().take_packets();
    }
    assert_eq!(bases, [0x4000, 0x4000 + 256 * 48]);
}

// What is refused -----------------------------------------------------------------------------

#[test]
fn rectangle_beyond_its_image_is_told() {
    let mut driver = driver(Submit::Ring);
    let image = driver.create_image(16, 8, BitmapFormat::Rgb565).expect("room");
    let refused = driver.fill(&image, rectangle(1, 2, 17, 8), 0).expect_err("too wide");
    assert_eq!(
        refused.to_string(),
        "fill: the destination is 16 x 8 pixels, the rectangle goes from (1, 2) to (17, 8)"
    );
    let refused = driver.copy(&image, [10, 0], &image, rectangle(0, 0, 7, 1)).expect_err("too wide");
    assert_eq!(refused.to_string(), "copy: the source is 16 x 8 pixels, the rectangle goes from (10, 0) to (17, 1)");
    let outside = |refused: DriverError| matches!(refused, DriverError::Image(ImageError::Outside { .. }));
    assert!(outside(driver.convert(&image, [u32::MAX, 0], &image, rectangle(0, 0, 7, 1)).expect_err("far off")));
    let to = Placement { x: 0, y: 0, width: 4, height: 4 };
    let clip = rectangle(0, 0, 4, 4);
    let from = rectangle(0, 0, 16, 9);
    assert!(outside(driver.stretch(&image, from, &image, to, clip, StretchFilter::Nearest).expect_err("too high")));
    driver.finish().expect("done");
    assert_eq!(opcodes(&driver.bus_mut().take_packets()), []);
}

#[test]
fn copy_between_formats_is_told() {
    let mut driver = driver(Submit::Ring);
    let image = driver.create_image(16, 8, BitmapFormat::Rgb565).expect("room");
    let target = target(&mut driver);
    let refused = driver.copy(&image, [0, 0], &target, rectangle(0, 0, 4, 4)).expect_err("formats differ");
    assert_eq!(refused.to_string(), "copy from rgb565 to xrgb8888: the formats differ, see convert");
}

#[test]
fn stretch_into_its_source_or_of_no_size_is_told() {
    let mut driver = driver(Submit::Ring);
    let image = driver.create_image(16, 8, BitmapFormat::Rgb565).expect("room");
    let all = rectangle(0, 0, 16, 8);
    let mut stretch = |from, x, width| {
        let to = Placement { x, y: 0, width, height: 8 };
        driver.stretch(&image, from, &image, to, all, StretchFilter::Nearest)
    };
    assert_eq!(stretch(rectangle(0, 0, 8, 8), 7, 4), Err(ImageError::Overlap.into()));
    assert_eq!(stretch(rectangle(0, 0, 8, 8), 8, 4), Ok(()));
    let refused = stretch(rectangle(4, 4, 4, 8), 0, 4).expect_err("no source");
    assert_eq!(refused.to_string(), "stretch source is 0 x 4, expected 1 to 16384 pixels each way");
    let refused = stretch(all, 0, 16385).expect_err("too wide");
    assert_eq!(refused.to_string(), "stretch placement is 16385 x 8, expected 1 to 16384 pixels each way");
}

#[test]
fn target_of_the_open_scene_takes_no_part() {
    let mut driver = driver(Submit::Ring);
    let (target, other) = (target(&mut driver), target(&mut driver));
    driver.begin_scene(&target).expect("begins");
    driver.draw_triangle(triangle([255; 4])).expect("draws");
    let all = rectangle(0, 0, 64, 48);
    let refused = DriverError::InsideScene { call: "fill" };
    assert_eq!(driver.fill(&target, all, 1), Err(refused));
    let refused = DriverError::InsideScene { call: "copy" };
    assert_eq!(driver.copy(&target, [0, 0], &other, all), Err(refused));
    assert_eq!(driver.fill(&other, all, 1), Ok(()));
    driver.end_scene().expect("ends");
    assert_eq!(driver.fill(&target, all, 1), Ok(()));
}

#[test]
fn create_image_without_a_size_or_room_is_told() {
    let mut driver = driver(Submit::Ring);
    let refused = driver.create_image(0, 8, BitmapFormat::Rgb565).expect_err("no size");
    assert_eq!(refused.to_string(), "image width is 0, expected 1 to 16384 pixels");
    let refused = driver.create_image(16384, 16384, BitmapFormat::Alpha8).expect_err("no room");
    assert!(matches!(refused, DriverError::Memory(_)));
    let image = driver.create_image(16384, 200, BitmapFormat::Alpha8).expect("room");
    driver.destroy_image(image).expect("own");
    assert!(driver.create_image(16384, 200, BitmapFormat::Alpha8).is_ok());
}

// What the card makes of it -------------------------------------------------------------------

#[test]
fn picture_of_fills_copies_and_operations_is_shown() {
    let card = card();
    let mut driver = Driver::open(card.bus()).expect("opens");
    let target = shown(&mut driver);
    let all = rectangle(0, 0, 64, 48);
    driver.fill(&target, all, BLUE).expect("sent");
    driver.fill(&target, rectangle(0, 0, 8, 8), RED).expect("sent");
    // Red scrolled by (3, 2) over itself, then magenta by an or with red in a row.
    driver.copy(&target, [0, 0], &target, rectangle(3, 2, 11, 10)).expect("sent");
    let or = Raster::new(RasterOperation::Or);
    driver.fill_rop(&target, rectangle(0, 47, 64, 48), RED, or).expect("sent");
    // Blue alone inverted in a column.
    let invert = Raster { operation: RasterOperation::Invert, planes: 0xFF };
    driver.copy_rop(&target, [0, 0], &target, rectangle(63, 0, 64, 48), invert).expect("sent");
    driver.present(&target).expect("shown");
    let frame = driver.capture().expect("captured");
    let pixel = |x: usize, y: usize| frame.pixels[y * 64 + x];
    assert_eq!([pixel(0, 0), pixel(10, 9), pixel(11, 9), pixel(0, 8), pixel(2, 8)], [RED, RED, BLUE, BLUE, BLUE]);
    assert_eq!([pixel(0, 47), pixel(63, 0), pixel(63, 47)], [0xFFFF_00FF, 0xFF00_0000, RED]);
}

#[test]
fn converted_pixels_are_their_rgba_values() {
    let card = card();
    let mut driver = Driver::open(card.bus()).expect("opens");
    let images = BitmapFormat::ALL.iter().map(|&format| driver.create_image(16, 1, format).expect("room"));
    let images: Vec<Image> = images.collect();
    let all = rectangle(0, 0, 16, 1);
    let colour = [0x12, 0x34, 0x56, 0x78];
    for from in &images {
        for to in &images {
            driver.fill(to, all, 0).expect("sent");
            driver.fill(from, all, from.format().encode(colour)).expect("sent");
            driver.convert(from, [0, 0], to, all).expect("sent");
            let read = row(&mut driver, to, 0, 1)[0] & to.format().bits();
            let expected = to.format().encode(from.format().decode(from.format().encode(colour)));
            assert_eq!(read, expected, "{} to {}", from.format().name(), to.format().name());
        }
    }
}

#[test]
fn stretch_through_clips_is_the_stretch_at_once() {
    let card = card();
    let mut driver = Driver::open(card.bus()).expect("opens");
    let source = driver.create_image(9, 7, BitmapFormat::Rgb565).expect("room");
    let [whole, parts] = [(); 2].map(|()| driver.create_image(64, 48, BitmapFormat::Argb8888).expect("room"));
    for y in 0..7 {
        for x in 0..9 {
            driver.fill(&source, rectangle(x, y, x + 1, y + 1), 0x1234 * x + 0x0707 * y).expect("sent");
        }
    }
    let (from, to) = (rectangle(0, 0, 9, 7), Placement { x: -10, y: 5, width: 70, height: 60 });
    let all = rectangle(0, 0, 64, 48);
    let filter = StretchFilter::Bilinear;
    for image in [&whole, &parts] {
        driver.fill(image, all, 0).expect("sent");
    }
    driver.stretch(&source, from, &whole, to, all, filter).expect("sent");
    for clip in [rectangle(0, 0, 64, 6), rectangle(0, 6, 31, 48), rectangle(31, 6, 1000, 1000)] {
        driver.stretch(&source, from, &parts, to, clip, filter).expect("sent");
    }
    for y in 0..48 {
        assert_eq!(row(&mut driver, &whole, y, 64), row(&mut driver, &parts, y, 64), "row {y}");
    }
    // Columns 60 and up and rows before 5 are not the placement's.
    assert_eq!(row(&mut driver, &whole, 4, 64), [0; 64]);
    assert_eq!(row(&mut driver, &whole, 5, 64)[60..], [0; 4]);
    assert_eq!(row(&mut driver, &whole, 5, 1)[0] >> 24, 255);
}

#[test]
fn nearest_stretch_doubles_a_target() {
    let card = card();
    let mut driver = Driver::open(card.bus()).expect("opens");
    let options = TargetOptions { pixel_format: PixelFormat::Rgb565, depth: None, ..TargetOptions::new(4, 2) };
    let small = driver.create_target(options).expect("room");
    let large = driver.create_image(8, 4, BitmapFormat::Xrgb8888).expect("room");
    driver.fill(&small, rectangle(0, 0, 4, 2), 0x001F).expect("sent");
    driver.fill(&small, rectangle(1, 1, 2, 2), 0xF800).expect("sent");
    let to = Placement { x: 0, y: 0, width: 8, height: 4 };
    let all = rectangle(0, 0, 8, 4);
    driver.stretch(&small, rectangle(0, 0, 4, 2), &large, to, all, StretchFilter::Nearest).expect("sent");
    assert_eq!(row(&mut driver, &large, 1, 8), [BLUE; 8]);
    let doubled = [BLUE, BLUE, RED, RED, BLUE, BLUE, BLUE, BLUE];
    assert_eq!(row(&mut driver, &large, 2, 8), doubled);
    assert_eq!(row(&mut driver, &large, 3, 8), doubled);
}
