//! Pictures whose pixels can be told by hand: parts of images, a turn by half, long lists, glyphs of any size.

use zga_abi::format::{BitmapFormat, ComposeOperator, PictureFormat, Repeat};
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{
    ClipBox, Composition, Driver, DriverOptions, Image, ListRectangle, Mask, MaskGlyph, Paint, Picture, Rectangle,
    Submit, Transform,
};

const WHITE: u32 = 0xFFFF_FFFF;

/// A card with a short ring, so that lists are cut; it lives as long as the driver is used.
fn open() -> (Card, Driver<CardBus>) {
    let options = CardOptions { video_memory: 1 << 20, threads: 1, ..CardOptions::default() };
    let card = Card::power_on(options).expect("powers on");
    let options = DriverOptions { submit: Submit::Ring, ring_words: 4096, ..DriverOptions::default() };
    let driver = Driver::open_with(card.bus(), options).expect("opens");
    (card, driver)
}

fn image(driver: &mut Driver<CardBus>, width: u32, height: u32, value: u32) -> Image {
    let image = driver.create_image(width, height, BitmapFormat::Argb8888).expect("room");
    driver.fill(&image, Rectangle { x: 0, y: 0, right: width, bottom: height }, value).expect("sent");
    image
}

fn picture(image: &Image) -> Picture<'_> {
    Picture { drawable: image.into(), part: None, format: PictureFormat::Argb8888 }
}

fn over<'a>(source: Paint<'a>, onto: Picture<'a>) -> Composition<'a> {
    Composition {
        operator: ComposeOperator::Over,
        source,
        mask: Mask::None,
        onto,
        origin: [0, 0],
        clips: &[ClipBox::ALL],
    }
}

/// Rows of pixels.
fn read(driver: &mut Driver<CardBus>, image: &Image) -> Vec<Vec<u32>> {
    let mut words = vec![0; (image.pitch() / 4 * image.height()) as usize];
    driver.finish().expect("executes");
    driver.read_memory(image.memory(), 0, &mut words).expect("reads");
    words.chunks(image.pitch() as usize / 4).map(|row| row[..image.width() as usize].to_vec()).collect()
}

#[test]
fn compose_part_of_an_image_onto_part_of_another() {
    let (_card, mut driver) = open();
    let (from, onto) = (image(&mut driver, 8, 8, 0xFF00_0000), image(&mut driver, 8, 8, WHITE));
    driver.fill(&from, Rectangle { x: 3, y: 2, right: 5, bottom: 4 }, 0x8000_0000).expect("sent");
    let part = Rectangle { x: 3, y: 2, right: 5, bottom: 4 };
    let source = Paint::Image {
        picture: Picture { part: Some(part), ..picture(&from) },
        offset: [-1, -1],
        repeat: Repeat::None,
        transform: None,
    };
    // What lies beyond the source's part is transparent, what lies beyond the destination's part stays.
    let part = Rectangle { x: 4, y: 4, right: 7, bottom: 6 };
    let composition = over(source, Picture { part: Some(part), ..picture(&onto) });
    driver.compose(&composition, &[ListRectangle { x: 0, y: 0, width: 8, height: 8 }]).expect("sent");
    let rows = read(&mut driver, &onto);
    for (y, row) in rows.iter().enumerate() {
        for (x, &pixel) in row.iter().enumerate() {
            let expected = if y == 5 && (5..7).contains(&x) { 0xFF7F_7F7F } else { WHITE };
            assert_eq!(pixel, expected, "({x}, {y})");
        }
    }
}

#[test]
fn compose_transformed_turns_a_picture_round() {
    let (_card, mut driver) = open();
    let (from, onto) = (image(&mut driver, 3, 2, 0), image(&mut driver, 3, 2, 0));
    for x in 0..3 {
        for y in 0..2 {
            driver.fill(&from, Rectangle { x, y, right: x + 1, bottom: y + 1 }, 10 * y + x).expect("sent");
        }
    }
    // x' = 3 - x, y' = 2 - y.
    let turn = Transform { xx: -1 << 16, xy: 0, x0: 3 << 16, yx: 0, yy: -1 << 16, y0: 2 << 16 };
    let source = Paint::Image { picture: picture(&from), offset: [0, 0], repeat: Repeat::None, transform: Some(turn) };
    let composition = Composition { operator: ComposeOperator::Source, ..over(source, picture(&onto)) };
    driver.compose(&composition, &[ListRectangle { x: 0, y: 0, width: 3, height: 2 }]).expect("sent");
    assert_eq!(read(&mut driver, &onto), [[12, 11, 10], [2, 1, 0]]);
}

/// More rectangles than a packet takes; each pixel is composed as often as there are.
#[test]
fn compose_long_lists_are_cut_into_packets() {
    let (_card, mut driver) = open();
    let onto = image(&mut driver, 4, 1, 0);
    let composition =
        Composition { operator: ComposeOperator::Add, ..over(Paint::Colour(0x0000_0001), picture(&onto)) };
    let rectangles = vec![ListRectangle { x: 1, y: 0, width: 2, height: 1 }; 4000];
    driver.compose(&composition, &rectangles[..200]).expect("sent");
    assert_eq!(read(&mut driver, &onto), [[0, 200, 200, 0]]);
    driver.compose(&composition, &rectangles).expect("sent");
    assert_eq!(read(&mut driver, &onto), [[0, 255, 255, 0]]);
    assert_eq!(driver.counters().get(zga_abi::Counter::BitmapEntries), 4200);
}

#[test]
fn compose_glyphs_of_any_size_and_stride() {
    let (_card, mut driver) = open();
    let onto = image(&mut driver, 64, 448, 0xFF00_0000);
    let composition = over(Paint::Colour(WHITE), picture(&onto));
    // Taller than a packet of the short ring takes at once, rows of the sender's memory longer than the glyph.
    let rows: Vec<u8> =
        (0..440 * 70).map(|place| if place % 70 < 50 { (place / 70 % 60) as u8 * 4 } else { 77 }).collect();
    let large = MaskGlyph { x: 7, y: 2, width: 50, height: 440, rows: &rows, stride: 70 };
    let small = MaskGlyph { x: 1, y: 1, width: 3, height: 1, rows: &[255, 0, 51], stride: 3 };
    let none = MaskGlyph { x: 1, y: 1, width: 0, height: 5, rows: &[], stride: 0 };
    driver.compose_glyphs(&composition, PictureFormat::Alpha8, false, [large, none, small]).expect("sent");
    let found = read(&mut driver, &onto);
    for (y, row) in found.iter().enumerate() {
        for (x, &pixel) in row.iter().enumerate() {
            let level = match (x, y) {
                (1, 1) => 255,
                (3, 1) => 51,
                (7..57, 2..442) => (y as u32 - 2) % 60 * 4,
                _ => 0,
            };
            assert_eq!(pixel, 0xFF00_0000 | (level * 0x0001_0101), "({x}, {y})");
        }
    }
    let colours = MaskGlyph { x: 0, y: 0, width: 1, height: 1, rows: &[0, 0x80, 0xFF, 0], stride: 4 };
    driver.compose_glyphs(&composition, PictureFormat::Argb8888, true, [colours]).expect("sent");
    assert_eq!(read(&mut driver, &onto)[0][0], 0xFFFF_8000);
}
