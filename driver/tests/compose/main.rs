//! Compositions against a model that does one pixel at a time, on a card that works fast and on one that works by its
//! specification; and what is sent and refused.

mod by_hand;
mod calls;
mod model;

use calls::{Call, HEIGHT, WIDTH, call, levels, next};
use model::Pixels;
use proptest::prelude::*;
use zga_abi::format::{BitmapFormat, ComposeOperator, PictureFormat, Repeat};
use zga_device::{Card, CardBus, CardOptions, Kernel};
use zga_driver::bus::MockBus;
use zga_driver::{
    ClipBox, Composition, Driver, DriverError, DriverOptions, Image, ImageError, ListRectangle, Mask, MaskGlyph, Paint,
    Picture, Rectangle, Transform,
};

// Cards ----------------------------------------------------------------------------------------

/// Pixels of noise for a format.
fn noise(seed: u32, format: PictureFormat) -> Pixels {
    let mut state = seed;
    let bits = u32::MAX >> (32 - 8 * format.bytes());
    (0..WIDTH * HEIGHT).map(|_| levels(&mut state) & bits).collect()
}

/// An image with these pixels. Formats that the bitmap unit has not lie in one of as many bytes.
fn image(driver: &mut Driver<CardBus>, format: PictureFormat, pixels: &Pixels) -> Image {
    let layout = match format.bytes() {
        4 => BitmapFormat::Xrgb8888,
        2 => BitmapFormat::Rgb565,
        _ => BitmapFormat::Alpha8,
    };
    let image = driver.create_image(WIDTH, HEIGHT, layout).expect("room");
    let mut bytes = Vec::new();
    for row in pixels.chunks(WIDTH as usize) {
        let first = bytes.len();
        bytes.extend(row.iter().flat_map(|pixel| pixel.to_le_bytes()[..format.bytes() as usize].to_vec()));
        bytes.resize(first + image.pitch() as usize, 0);
    }
    let words: Vec<u32> = bytes.as_chunks::<4>().0.iter().map(|&word| u32::from_le_bytes(word)).collect();
    driver.write_memory(image.memory(), 0, &words).expect("inside");
    image
}

/// An image's pixels, with what is stored between rows left out.
fn read(driver: &mut Driver<CardBus>, image: &Image) -> Pixels {
    driver.finish().expect("done");
    let mut words = vec![0; (image.pitch() * HEIGHT / 4) as usize];
    driver.read_memory(image.memory(), 0, &mut words).expect("inside");
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let pixel = image.format().bytes() as usize;
    let row = |row: &[u8]| row[..WIDTH as usize * pixel].to_vec();
    let rows: Vec<u8> = bytes.chunks(image.pitch() as usize).flat_map(row).collect();
    rows.chunks(pixel).map(|bytes| bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))).collect()
}

/// What a card of this kernel makes of a call, and its counters.
fn drawn(kernel: Kernel, call: &Call, formats: [PictureFormat; 3], noise: [&Pixels; 3]) -> (Pixels, Vec<u64>) {
    let options = CardOptions { video_memory: 1 << 20, threads: 1, kernel, ..CardOptions::default() };
    let card = Card::power_on(options).expect("powers on");
    let mut driver = Driver::open(card.bus()).expect("opens");
    let [onto, source, mask] = [0, 1, 2].map(|place| image(&mut driver, formats[place], noise[place]));
    call.draw(&mut driver, [&onto, &source, &mask]).expect("sent");
    let pixels = read(&mut driver, &onto);
    let counters = driver.counters();
    (pixels, zga_abi::Counter::ALL.iter().map(|&counter| counters.get(counter)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn compose_any_call_comes_to_the_model_by_both_kernels(call in call(), seed in any::<u32>()) {
        let formats = [call.onto.format, call.source.format(), call.mask_format()];
        let [onto, source, mask] = [0, 1, 2].map(|place| noise(seed ^ place as u32, formats[place]));
        let mut model = onto.clone();
        call.model(&mut model, &source, &mask);
        let (fast, fast_counters) = drawn(Kernel::Best, &call, formats, [&onto, &source, &mask]);
        let (plain, plain_counters) = drawn(Kernel::Specification, &call, formats, [&onto, &source, &mask]);
        prop_assert_eq!(&fast, &model);
        prop_assert_eq!(&plain, &model);
        prop_assert_eq!(fast_counters, plain_counters);
    }
}

// What is sent and refused ---------------------------------------------------------------------

/// A driver on a mock card of 4 MiB, with a ring of 4096 words.
fn mock() -> Driver<MockBus> {
    let options = DriverOptions { ring_words: 4096, ..DriverOptions::default() };
    Driver::open_with(MockBus::new(4 << 20), options).expect("the mock card opens")
}

#[test]
fn compose_sends_the_words_of_the_manual() {
    let mut driver = mock();
    let onto = driver.create_image(16, 8, BitmapFormat::Argb8888).expect("room");
    let source = driver.create_image(40, 30, BitmapFormat::Rgb565).expect("room");
    let transform = Transform { xx: 1, xy: -2, x0: 3, yx: -4, yy: 5, y0: -6 };
    let part = Some(Rectangle { x: 4, y: 2, right: 14, bottom: 9 });
    let picture = Picture { drawable: (&source).into(), part, format: PictureFormat::Rgb565 };
    let turned = Paint::Image { picture, offset: [-5, 6], repeat: Repeat::Pad, transform: Some(transform) };
    let clips = [ClipBox { x1: 1, y1: 2, x2: 3, y2: 4 }];
    let composition = Composition {
        operator: ComposeOperator::Atop,
        source: turned,
        mask: Mask::Components(Paint::Colour(0x1234_5678)),
        onto: Picture { drawable: (&onto).into(), part: None, format: PictureFormat::Abgr8888 },
        origin: [-1, 2],
        clips: &clips,
    };
    driver.compose(&composition, &[ListRectangle { x: -2, y: 3, width: 4, height: 5 }]).expect("sent");
    let plain = Composition { mask: Mask::None, ..composition };
    let rows = [1, 2, 3, 0, 0, 0, 4, 5, 6];
    let glyph = MaskGlyph { x: 1, y: 2, width: 3, height: 2, rows: &rows, stride: 6 };
    driver.compose_glyphs(&plain, PictureFormat::Alpha8, false, [glyph]).expect("sent");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    // The source's rows are 128 bytes long and begin behind the 8 rows of 64 bytes of the destination.
    let source = [3, 2, 2, 0x4200 + 2 * 128 + 8, 128, 0x0007_000A, 0xFFFF_FFFB, 6];
    let matrix = [1, 0xFFFF_FFFE, 3, 0xFFFF_FFFC, 5, 0xFFFF_FFFA];
    let expected = |flags: u32, mask: [u32; 4], entries: &[u32]| {
        let head = [0x4000, 64, 5, 0x0008_0010, 9, flags, 0x0002_FFFF, 1];
        let clip = [0x0002_0001, 0x0004_0003];
        let payload = [&head[..], &source, &matrix, &mask, &[0; 10], &clip, entries].concat();
        [&[0x2C00_0000 | payload.len() as u32], &payload[..]].concat()
    };
    assert_eq!(packets[0], expected(1, [1, 0, 0, 0x1234_5678], &[0x0003_FFFE, 0x0005_0004]));
    let glyph = [0x0002_0001, 0x0002_0003, 0x0003_0201, 0x0006_0504];
    assert_eq!(packets[1], expected(0, [4, 3, 0, 0], &glyph));
}

#[test]
fn compose_longer_than_a_packet_is_cut_and_loses_nothing() {
    let draw = |ring_words| {
        let options = CardOptions { video_memory: 8 << 20, threads: 1, ..CardOptions::default() };
        let card = Card::power_on(options).expect("powers on");
        let options = DriverOptions { ring_words, ..DriverOptions::default() };
        let mut driver = Driver::open_with(card.bus(), options).expect("opens");
        let onto = image(&mut driver, PictureFormat::Argb8888, &noise(1, PictureFormat::Argb8888));
        let composition = Composition {
            operator: ComposeOperator::Add,
            source: Paint::Colour(0x0102_0301),
            mask: Mask::None,
            onto: Picture { drawable: (&onto).into(), part: None, format: PictureFormat::Argb8888 },
            origin: [0, 0],
            clips: &[ClipBox::ALL],
        };
        let mut state = 5;
        let rectangles: Vec<ListRectangle> = (0..3000)
            .map(|_| {
                let [x, y] = [(); 2].map(|()| (next(&mut state) % 50) as i16 - 5);
                ListRectangle { x, y, width: 3, height: 2 }
            })
            .collect();
        driver.compose(&composition, &rectangles).expect("sent");
        // Letters one by one, and one that is longer than a packet of the short ring.
        let rows: Vec<u8> = (0..300 * 400).map(|_| next(&mut state) as u8).collect();
        let letters = rectangles.iter().map(|&ListRectangle { x, y, width, height }| MaskGlyph {
            x,
            y,
            width,
            height,
            rows: &rows[4 * x.unsigned_abs() as usize..],
            stride: 300,
        });
        let tall = MaskGlyph { x: -100, y: -200, width: 299, height: 400, rows: &rows, stride: 300 };
        driver.compose_glyphs(&composition, PictureFormat::Alpha8, false, letters.chain([tall])).expect("sent");
        read(&mut driver, &onto)
    };
    assert_eq!(draw(4096), draw(1 << 20));
}

/// All of an image.
fn picture(image: &Image, format: PictureFormat) -> Picture<'_> {
    Picture { drawable: image.into(), part: None, format }
}

/// A picture pixel by pixel.
fn paint(picture: Picture<'_>, offset: [i32; 2]) -> Paint<'_> {
    Paint::Image { picture, offset, repeat: Repeat::None, transform: None }
}

#[test]
fn compose_bad_arguments_are_refused_and_send_nothing() {
    let mut driver = mock();
    let onto = driver.create_image(16, 8, BitmapFormat::Argb8888).expect("room");
    let alpha = driver.create_image(16, 8, BitmapFormat::Alpha8).expect("room");
    let fine = Composition {
        operator: ComposeOperator::Over,
        source: paint(picture(&alpha, PictureFormat::Alpha8), [0, 0]),
        mask: Mask::None,
        onto: picture(&onto, PictureFormat::Xbgr8888),
        origin: [0, 0],
        clips: &[ClipBox::ALL],
    };
    let mut refused = |composition: &Composition<'_>| driver.compose(composition, &[ListRectangle::default()]);

    let narrow = picture(&alpha, PictureFormat::Argb8888);
    let differ = ImageError::FormatsDiffer { call: "compose", from: "alpha8", to: "argb8888" };
    assert_eq!(refused(&Composition { source: paint(narrow, [0, 0]), ..fine }), Err(differ.clone().into()));
    assert_eq!(refused(&Composition { mask: Mask::Unified(paint(narrow, [0, 0])), ..fine }), Err(differ.into()));
    let far = paint(picture(&alpha, PictureFormat::Alpha8), [0, -65536]);
    assert!(matches!(
        refused(&Composition { source: far, ..fine }),
        Err(DriverError::BadOption { name: "compose offset", .. })
    ));
    let itself = paint(picture(&onto, PictureFormat::Argb8888), [0, 0]);
    assert_eq!(refused(&Composition { mask: Mask::Components(itself), ..fine }), Err(ImageError::Overlap.into()));
    for part in [Rectangle { x: 0, y: 0, right: 17, bottom: 8 }, Rectangle { x: 3, y: 0, right: 3, bottom: 8 }] {
        let outside = Picture { part: Some(part), ..fine.onto };
        assert!(matches!(
            refused(&Composition { onto: outside, ..fine }),
            Err(DriverError::Image(ImageError::Outside { call: "compose", side: "destination", .. }))
        ));
    }

    let rows = [0; 8];
    let glyph = MaskGlyph { x: 0, y: 0, width: 3, height: 2, rows: &rows, stride: 6 };
    assert!(matches!(
        driver.compose_glyphs(&fine, PictureFormat::Rgb565, false, [glyph]),
        Err(DriverError::BadOption { name: "format of glyphs", .. })
    ));
    let short = ImageError::Bits { width: 3, height: 2, needed: 9, found: 8 };
    assert_eq!(driver.compose_glyphs(&fine, PictureFormat::Alpha8, false, [glyph]), Err(short.into()));
    driver.finish().expect("done");
    assert_eq!(driver.bus_mut().take_packets(), Vec::<Vec<u32>>::new());
}
