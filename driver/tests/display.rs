//! What the display shows beside presented targets: images, vertical blanks, the cursor; and mapped memory.

use std::time::Duration;
use zga_abi::Counter;
use zga_abi::format::BitmapFormat;
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{Driver, DriverError, Image, Rectangle};

/// A card, its driver, and an image of one colour shown.
fn shown(width: u32, height: u32, format: BitmapFormat, value: u32) -> (Card, Driver<CardBus>, Image) {
    let card = Card::power_on(CardOptions::default()).expect("a card");
    let mut driver = Driver::open(card.bus()).expect("a driver");
    let image = driver.create_image(width, height, format).expect("an image");
    driver.fill(&image, Rectangle { x: 0, y: 0, right: width, bottom: height }, value).expect("a fill");
    driver.show_image(&image, width, height).expect("an image that is shown");
    (card, driver, image)
}

/// A cursor's picture, opaque red but for a pixel of half a green.
fn picture() -> [u32; 4096] {
    let mut picture = [0xFFFF_0000; 4096];
    picture[64 * 2 + 1] = 0x8000_8000;
    picture
}

#[test]
fn cursor_lies_over_the_frame_and_not_in_it() {
    let (_card, mut driver, image) = shown(80, 70, BitmapFormat::Xrgb8888, 0xFF00_00FF);
    driver.set_cursor_image(&picture()).unwrap();
    driver.move_cursor(10, 20).unwrap();
    driver.show_cursor(true).unwrap();
    let frame = driver.capture().unwrap();
    let at = |x: usize, y: usize| frame.pixels[y * 80 + x];
    assert_eq!(
        [at(9, 20), at(10, 19), at(10, 20), at(73, 69), at(74, 69)],
        [0xFF00_00FF, 0xFF00_00FF, 0xFFFF_0000, 0xFFFF_0000, 0xFF00_00FF]
    );
    assert_eq!(at(11, 22), 0xFF00_807F);
    let mut word = [0];
    driver.read_memory(image.memory(), 20 * image.pitch() / 4 + 10, &mut word).unwrap();
    assert_eq!(word, [0xFF00_00FF]);
}

#[test]
fn cursor_beyond_every_edge_shows_what_is_on_the_frame() {
    let (_card, mut driver, _image) = shown(20, 10, BitmapFormat::Rgb565, 0);
    driver.set_cursor_image(&[0xFFFF_FFFF; 4096]).unwrap();
    driver.show_cursor(true).unwrap();
    let mut count = |x, y| {
        driver.move_cursor(x, y).unwrap();
        driver.capture().unwrap().pixels.iter().filter(|&&pixel| pixel == 0xFFFF_FFFF).count()
    };
    let corners = [(-60, -60), (17, 8), (-64, 0), (20, 0), (0, 10), (i32::MIN, i32::MAX), (-20, -20)];
    assert_eq!(corners.map(|(x, y)| count(x, y)), [16, 6, 0, 0, 0, 0, 200]);
}

#[test]
fn cursor_off_or_without_a_picture_costs_nothing() {
    let (_card, mut driver, _image) = shown(80, 70, BitmapFormat::Xrgb8888, 0);
    driver.show_cursor(true).unwrap();
    driver.capture().unwrap();
    driver.set_cursor_image(&picture()).unwrap();
    driver.show_cursor(false).unwrap();
    driver.capture().unwrap();
    let counters = driver.counters();
    assert_eq!(counters.get(Counter::ScanoutCursorPixels), 0);
    assert_eq!(counters.get(Counter::CyclesScanout), 2 * 80 * 70);
}

#[test]
fn cursor_charges_four_lines_for_each_row_on_the_frame() {
    let (_card, mut driver, _image) = shown(80, 70, BitmapFormat::Xrgb8888, 0);
    driver.set_cursor_image(&picture()).unwrap();
    driver.move_cursor(60, 60).unwrap();
    driver.show_cursor(true).unwrap();
    driver.capture().unwrap();
    let counters = driver.counters();
    assert_eq!(counters.get(Counter::ScanoutCursorPixels), 20 * 10);
    assert_eq!(counters.get(Counter::CyclesScanout), 80 * 70 + 4 * 10);
}

#[test]
fn monitor_sees_the_cursor_move_and_change() {
    let (card, mut driver, _image) = shown(70, 66, BitmapFormat::Xrgb8888, 0xFF00_0000);
    let mut monitor = card.monitor();
    driver.set_refresh(Some(Duration::from_millis(1))).unwrap();
    driver.set_cursor_image(&[0xFFFF_0000; 4096]).unwrap();
    driver.show_cursor(true).unwrap();
    driver.finish().unwrap();
    let mut wait_for = |x: usize, y: usize, pixel: u32| {
        (0..2000).any(|_| {
            let frame = monitor.wait_next(Duration::from_millis(10));
            frame.is_some_and(|frame| frame.pixels()[y * 70 + x] == pixel)
        })
    };
    assert!(wait_for(0, 0, 0xFFFF_0000));
    driver.move_cursor(3, 1).unwrap();
    driver.finish().unwrap();
    assert!(wait_for(0, 0, 0xFF00_0000));
    driver.set_cursor_image(&[0xFF00_FF00; 4096]).unwrap();
    driver.finish().unwrap();
    assert!(wait_for(3, 1, 0xFF00_FF00));
}

#[test]
fn show_image_refuses_what_it_has_not() {
    let (_card, mut driver, image) = shown(80, 70, BitmapFormat::Xrgb8888, 0);
    let alpha = driver.create_image(80, 70, BitmapFormat::Alpha8).unwrap();
    for refused in [
        driver.show_image(&image, 81, 70),
        driver.show_image(&image, 80, 0),
        driver.show_image(&alpha, 80, 70),
        driver.set_refresh(Some(Duration::from_micros(999))),
        driver.set_refresh(Some(Duration::from_secs(2))),
    ] {
        assert!(matches!(refused, Err(DriverError::BadOption { .. })), "{refused:?}");
    }
}

#[test]
fn destroying_the_image_shown_darkens_the_screen() {
    let (_card, mut driver, image) = shown(80, 70, BitmapFormat::Xrgb8888, 0);
    driver.destroy_image(image).unwrap();
    assert!(matches!(driver.capture(), Err(DriverError::NothingShown)));
}

#[test]
fn mapping_reads_and_writes_what_the_card_does() {
    let (card, mut driver, image) = shown(80, 70, BitmapFormat::Xrgb8888, 0xFF12_3456);
    driver.finish().unwrap();
    let first = (image.memory().address() / 4) as usize;
    let mut memory = card.map();
    assert_eq!(memory.len(), 16 << 20);
    assert_eq!(memory[first], 0xFF12_3456);
    memory[first + 1] = 0xFF65_4321;
    let place = memory.as_ptr();
    drop(memory);
    assert_eq!(driver.capture().unwrap().pixels[..3], [0xFF12_3456, 0xFF65_4321, 0xFF12_3456]);
    assert_eq!(card.map().as_ptr(), place);
}

#[test]
fn card_executes_nothing_while_memory_is_mapped() {
    let (card, mut driver, image) = shown(80, 70, BitmapFormat::Xrgb8888, 0);
    driver.finish().unwrap();
    let first = (image.memory().address() / 4) as usize;
    let memory = card.map();
    driver.fill(&image, Rectangle { x: 0, y: 0, right: 1, bottom: 1 }, 7).unwrap();
    let fence = std::thread::scope(|scope| {
        let fence = scope.spawn(|| driver.fence());
        // Nothing can be waited for: the card has no way to say that it does nothing.
        std::thread::sleep(Duration::from_millis(20));
        assert_eq!(memory[first], 0);
        drop(memory);
        fence.join().expect("a thread")
    });
    driver.wait(fence.unwrap()).unwrap();
    assert_eq!(card.map()[first], 7);
}
