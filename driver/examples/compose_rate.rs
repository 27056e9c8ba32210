//! What a composition costs on this host, nanoseconds a pixel, from call to fence, for each kernel:
//! `cargo run --release --example compose_rate -p zga-driver`.

use std::time::Instant;
use zga_abi::format::{BitmapFormat, ComposeOperator, PictureFormat, Repeat};
use zga_device::{Card, CardBus, CardOptions, Kernel};
use zga_driver::{
    ClipBox, Composition, Driver, DriverError, Image, ListRectangle, Mask, MaskGlyph, Paint, Picture, Transform,
};

/// Pixels of a row, and rows.
const SIDE: u16 = 500;

/// Compositions in a round.
const TIMES: usize = 16;

/// Width and height of a letter.
const LETTER: [u16; 2] = [9, 13];

/// What there is to be composed.
struct Images {
    onto: Image,
    source: Image,
    alpha: Image,
    narrow: Image,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("nanoseconds a pixel of {SIDE} x {SIDE}, the best of 20 rounds");
    for kernel in Kernel::available().into_iter().filter(|&kernel| kernel != Kernel::Specification) {
        let options = CardOptions { video_memory: 16 << 20, threads: 1, kernel, ..CardOptions::default() };
        let card = Card::power_on(options)?;
        let mut driver = Driver::open(card.bus())?;
        let side = u32::from(SIDE);
        let images = Images {
            onto: noise(&mut driver, side, PictureFormat::Argb8888)?,
            source: noise(&mut driver, side, PictureFormat::Argb8888)?,
            alpha: noise(&mut driver, side, PictureFormat::Alpha8)?,
            narrow: noise(&mut driver, 9, PictureFormat::Argb8888)?,
        };
        println!("{kernel:?}");
        rectangles(&mut driver, &images)?;
        letters(&mut driver, &images)?;
    }
    Ok(())
}

/// A square of noise.
fn noise(driver: &mut Driver<CardBus>, side: u32, format: PictureFormat) -> Result<Image, DriverError> {
    let layout = if format == PictureFormat::Alpha8 { BitmapFormat::Alpha8 } else { BitmapFormat::Argb8888 };
    let image = driver.create_image(side, side, layout)?;
    let words: Vec<u32> = (0..image.pitch() * side / 4).map(|word| word.wrapping_mul(0x9E37_79B9)).collect();
    driver.write_memory(image.memory(), 0, &words)?;
    Ok(image)
}

/// A picture, pixel by pixel from its corner on.
fn paint(image: &Image, format: PictureFormat, repeat: Repeat, transform: Option<Transform>) -> Paint<'_> {
    let picture = Picture { drawable: image.into(), part: None, format };
    Paint::Image { picture, offset: [0, 0], repeat, transform }
}

fn rectangles(driver: &mut Driver<CardBus>, images: &Images) -> Result<(), DriverError> {
    let (argb, xrgb, alpha8) = (PictureFormat::Argb8888, PictureFormat::Xrgb8888, PictureFormat::Alpha8);
    let source = paint(&images.source, argb, Repeat::None, None);
    let turned = Transform { xx: 0xF000, xy: 0x3000, x0: 0, yx: -0x3000, yy: 0xF000, y0: 0x10_0000 };
    let mask = || Mask::Unified(paint(&images.alpha, alpha8, Repeat::None, None));
    let by_component = Mask::Components(paint(&images.source, argb, Repeat::None, None));
    let colour = Paint::Colour(0x8040_2010);
    let (over, copy) = (ComposeOperator::Over, ComposeOperator::Source);
    for (name, operator, source, mask, onto) in [
        ("source", copy, source, Mask::None, argb),
        ("source onto xrgb8888", copy, source, Mask::None, xrgb),
        ("over", over, source, Mask::None, argb),
        ("over onto xrgb8888", over, source, Mask::None, xrgb),
        ("over, colour", over, colour, Mask::None, argb),
        ("over, colour, alpha8 mask", over, colour, mask(), xrgb),
        ("over, alpha8 mask", over, source, mask(), argb),
        ("over, colour, components", over, colour, by_component, xrgb),
        ("add, colour, alpha8 mask", ComposeOperator::Add, colour, mask(), argb),
        ("over, 9 pixels repeated", over, paint(&images.narrow, argb, Repeat::Normal, None), Mask::None, argb),
        ("over, 9 pixels reflected", over, paint(&images.narrow, argb, Repeat::Reflect, None), Mask::None, argb),
        ("over, turned", over, paint(&images.source, argb, Repeat::None, Some(turned)), Mask::None, argb),
    ] {
        let onto = Picture { drawable: (&images.onto).into(), part: None, format: onto };
        let composition = Composition { operator, source, mask, onto, origin: [0, 0], clips: &[ClipBox::ALL] };
        let all = [ListRectangle { x: 0, y: 0, width: SIDE, height: SIDE }; TIMES];
        let pixels = TIMES * usize::from(SIDE) * usize::from(SIDE);
        show(driver, name, pixels, |driver| driver.compose(&composition, &all))?;
    }
    Ok(())
}

fn letters(driver: &mut Driver<CardBus>, images: &Images) -> Result<(), DriverError> {
    let [width, height] = LETTER;
    let rows: Vec<u8> = (0..16 * usize::from(height)).map(|byte| (byte * 37) as u8).collect();
    let letter = |at: u16| {
        let [x, y] = [at % 50 * width, at / 50 % 35 * height].map(|place| place as i16);
        MaskGlyph { x, y, width, height, rows: &rows, stride: 16 }
    };
    let onto = Picture { drawable: (&images.onto).into(), part: None, format: PictureFormat::Xrgb8888 };
    let source = Paint::Colour(0xFF40_2010);
    let clips = &[ClipBox::ALL];
    let composition =
        Composition { operator: ComposeOperator::Over, source, mask: Mask::None, onto, origin: [0, 0], clips };
    const COUNT: u16 = 20_000;
    let pixels = usize::from(COUNT) * usize::from(width) * usize::from(height);
    show(driver, "letters", pixels, |driver| {
        driver.compose_glyphs(&composition, PictureFormat::Alpha8, false, (0..COUNT).map(letter))
    })
}

/// The least time of 20 rounds.
fn show(
    driver: &mut Driver<CardBus>,
    name: &str,
    pixels: usize,
    round: impl Fn(&mut Driver<CardBus>) -> Result<(), DriverError>,
) -> Result<(), DriverError> {
    let mut best = f64::INFINITY;
    for _ in 0..20 {
        let begun = Instant::now();
        round(driver)?;
        driver.finish()?;
        best = best.min(begun.elapsed().as_secs_f64());
    }
    println!("{name:>32}: {:6.2}", best * 1e9 / pixels as f64);
    Ok(())
}
