//! The engine on a card of its own, without a server.

use super::compose::{Cover, Ink, Request, Sampled, Surface};
use super::glyphs::Glyph;
use super::lists::Onto;
use super::pixmaps::Place;
use super::*;
use crate::format::raster;
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_driver::{ClipBox, ListRectangle};

/// X's function Copy.
const COPY: u32 = 3;
/// X's function Xor.
const XOR: u32 = 6;

fn engine(video_memory: u32, cpu_limit: u64) -> Engine {
    let options = EngineOptions {
        video_memory,
        threads: 1,
        accel: true,
        frame: (64, 64),
        format: BitmapFormat::Xrgb8888,
        cpu_limit,
    };
    Engine::new(&options, Box::new(|_, text| panic!("{text}"))).expect("an engine")
}

/// The words of a pixmap's rows, when the card is done with it.
fn pixels(engine: &mut Engine, number: usize) -> Vec<u32> {
    engine.access(number).expect("pixels");
    engine.finish();
    let pixmap = engine.pixmaps.get(number).expect("a pixmap");
    let count = (pixmap.bytes() / 4) as usize;
    match &pixmap.place {
        Place::Card(image) => {
            let first = image.memory().address() as usize / 4;
            engine.card.map()[first..first + count].to_vec()
        }
        Place::Spilled(words) => words.clone(),
        other => panic!("{other:?}"),
    }
}

/// Fills a pixmap through the card, or as the server's renderer would.
fn fill(engine: &mut Engine, number: usize, value: u32) {
    if engine.prepare_solid(number, 32, COPY, u32::MAX, value) {
        engine.solid(0, 0, 256, 256);
        engine.done();
    } else {
        engine.access(number).expect("pixels");
        if let Some(Pixmap { place: Place::Spilled(words), .. }) = engine.pixmaps.get_mut(number) {
            words.fill(value);
        }
        engine.finish();
    }
}

#[test]
fn solid_and_copy_are_seen_by_an_access() {
    let mut engine = engine(4 << 20, 0);
    let [from, onto] = [(); 2].map(|()| engine.create_pixmap((16, 4), 32, Wanted::Anywhere));
    assert!(engine.prepare_solid(from, 32, COPY, u32::MAX, 7));
    engine.solid(0, 0, 16, 4);
    engine.done();
    assert!(engine.prepare_solid(onto, 32, COPY, u32::MAX, 0));
    engine.solid(0, 0, 16, 4);
    engine.done();
    assert!(engine.prepare_copy(from, onto, 32, XOR, 5));
    engine.copy((1, 1), (2, 3), 3, 1);
    // Another offset, and what is empty or nowhere.
    engine.copy((1, 1), (8, 3), 2, 1);
    engine.copy((1, 1), (8, 3), 0, 1);
    engine.copy((1, 1), (70_000, 3), 1, 1);
    engine.done();
    let row: Vec<u32> = pixels(&mut engine, onto)[48..64].to_vec();
    assert_eq!(row, [0, 0, 5, 5, 5, 0, 0, 0, 5, 5, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn open_access_refuses_everything_the_card_could_do() {
    let mut engine = engine(4 << 20, 0);
    let number = engine.create_pixmap((16, 4), 32, Wanted::Anywhere);
    engine.access(number).expect("pixels");
    assert!(!engine.prepare_solid(number, 32, COPY, u32::MAX, 7));
    assert!(!engine.prepare_copy(number, number, 32, COPY, u32::MAX));
    assert!(!engine.upload(number, (0, 0), (4, 1), &[0; 4], 4));
    engine.finish();
    assert!(engine.prepare_solid(number, 32, COPY, u32::MAX, 7));
}

/// Few bytes go behind what the card has still to do, without a wait; many are written in place after it.
#[test]
fn upload_comes_after_what_was_drawn_before() {
    let mut engine = engine(4 << 20, 0);
    let number = engine.create_pixmap((256, 256), 32, Wanted::Anywhere);
    for (rows, waits) in [(2, false), (256, true)] {
        assert!(engine.prepare_solid(number, 32, COPY, u32::MAX, 7));
        engine.solid(0, 0, 256, 256);
        engine.done();
        // Rows of the server's memory are longer than the rectangle's.
        let bytes: Vec<u8> = (0..256 * 1024).map(|place| if place % 1024 < 1000 { 9 } else { 0 }).collect();
        assert!(engine.upload(number, (8, 0), (1000, rows), &bytes, 1024));
        assert_eq!(engine.batches.pending(), !waits, "{rows}");
        assert!(engine.prepare_solid(number, 32, XOR, u32::MAX, 1));
        engine.solid(2, 0, 3, 1);
        engine.done();
        let found = pixels(&mut engine, number);
        let pitch = found.len() / 256;
        assert_eq!(found[..4], [7, 7, 0x0909_0908, 0x0909_0909], "{rows}");
        assert_eq!(found[250..254], [0x0909_0909, 0x0909_0909, 7, 7], "{rows}");
        let below = if waits { 0x0909_0909 } else { 7 };
        assert_eq!(found[2 * pitch + 5], below, "{rows}");
    }
}

#[test]
fn host_pixmaps_have_an_address_and_are_never_drawn_to() {
    let mut engine = engine(4 << 20, 0);
    let bitmap = engine.create_pixmap((33, 4), 1, Wanted::Anywhere);
    let glyph = engine.create_pixmap((7, 4), 8, Wanted::InHostMemory);
    let header = engine.create_pixmap((0, 0), 32, Wanted::Anywhere);
    assert_eq!([bitmap, glyph, header].map(|number| engine.pitch(number)), [8, 8, 0]);
    assert!(engine.host_address(bitmap).is_some() && engine.host_address(glyph).is_some());
    assert!(engine.host_address(header).is_none() && engine.access(header).is_none());
    for number in [bitmap, glyph, header] {
        assert!(!engine.is_movable(number) && !engine.prepare_solid(number, 8, COPY, u32::MAX, 1));
    }
}

#[test]
fn small_work_is_the_renderers_while_the_card_is_idle() {
    let mut engine = engine(4 << 20, 100);
    let pixmap = engine.create_pixmap((64, 64), 32, Wanted::Anywhere);
    let clips = [ClipBox { x1: 0, y1: 0, x2: 64, y2: 64 }];
    let raster = raster(COPY, u32::MAX, 24).expect("an operation");
    let onto = Onto { pixmap, origin: [0, 0], moved: [0, 0], clips: &clips, raster };
    let rectangle = |width, height| [ListRectangle { x: 0, y: 0, width, height }];
    assert!(!engine.fill_list(&onto, 1, &rectangle(4, 4)));
    assert!(engine.fill_list(&onto, 1, &rectangle(40, 40)));
    assert!(engine.fill_list(&onto, 1, &rectangle(4, 4)), "behind other work the order counts");
    engine.access(pixmap).expect("pixels");
    engine.finish();
    assert!(!engine.fill_list(&onto, 1, &rectangle(4, 4)));
}

/// Thirty pixmaps of 256 KiB on a card of 4 MiB, drawn to in an order that makes them move; each keeps its own pixels.
#[test]
fn pixmaps_that_move_keep_their_pixels() {
    let mut engine = engine(4 << 20, 0);
    let pixmaps: Vec<usize> = (0..30).map(|_| engine.create_pixmap((256, 256), 32, Wanted::Anywhere)).collect();
    let mut expected = vec![0; pixmaps.len()];
    for (place, &number) in pixmaps.iter().enumerate() {
        fill(&mut engine, number, place as u32);
        expected[place] = place as u32;
    }
    let mut random = 1_u32;
    for step in 0..40_000_u32 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // A few are used most, and which these are changes.
        let place = ((random >> 24) % 4 + step / 8000 * 6) as usize % pixmaps.len();
        if step % 50 == 0 {
            fill(&mut engine, pixmaps[place], step);
            expected[place] = step;
        } else {
            // Asked for as a list is, with all its bytes at stake.
            engine.bring_in(&[pixmaps[place]], 1 << 10);
        }
    }
    let [came, left] = engine.moves;
    assert!(came >= 5 && left >= 5, "{came} came, {left} left");
    for (place, &number) in pixmaps.iter().enumerate() {
        let words = pixels(&mut engine, number);
        assert!(words.iter().all(|&word| word == expected[place]), "pixmap {place}");
    }
}

#[test]
fn pixmaps_more_than_memory_holds_are_spilled_and_freed_memory_is_used_again() {
    let mut engine = engine(2 << 20, 0);
    for _ in 0..100 {
        let pixmaps: Vec<usize> = (0..20).map(|_| engine.create_pixmap((256, 200), 32, Wanted::Anywhere)).collect();
        let inside = pixmaps.iter().filter(|&&number| engine.prepare_solid(number, 32, COPY, u32::MAX, 1)).count();
        assert!((1..20).contains(&inside), "{inside}");
        for number in pixmaps {
            engine.destroy_pixmap(number);
        }
    }
}

/// More boxes than a packet of the smallest ring takes: the clip of a mask can be so.
#[test]
fn clip_of_any_number_of_boxes_is_drawn_through() {
    let mut engine = engine(2 << 20, 0);
    let pixmap = engine.create_pixmap((128, 128), 32, Wanted::Anywhere);
    assert!(engine.prepare_solid(pixmap, 32, COPY, u32::MAX, 5));
    engine.solid(0, 0, 128, 128);
    engine.done();
    // Every second pixel.
    let place = |index: i16| (2 * (index % 64) + index / 64 % 2, index / 64);
    let clips: Vec<ClipBox> =
        (0..8192).map(place).map(|(x, y)| ClipBox { x1: x, y1: y, x2: x + 1, y2: y + 1 }).collect();
    let raster = raster(XOR, u32::MAX, 24).expect("an operation");
    let onto = Onto { pixmap, origin: [0, 0], moved: [0, 0], clips: &clips, raster };
    let rectangle = ListRectangle { x: 0, y: 0, width: 128, height: 128 };
    assert!(engine.fill_list(&onto, 3, &[rectangle]));
    let found = pixels(&mut engine, pixmap);
    let pitch = found.len() / 128;
    let expected = |index: usize| if (index % 128 + index / 128).is_multiple_of(2) { 5 ^ 3 } else { 5 };
    let wrong = (0..128 * 128).find(|&index| found[index / 128 * pitch + index % 128] != expected(index));
    assert_eq!(wrong, None);
}

/// A surface of 16 x 4 pixels, each `value`, and its picture.
fn surface(engine: &mut Engine, format: PictureFormat, value: u8) -> Surface {
    let (size, bytes) = ([16, 4], format.bytes());
    let pixmap = engine.create_pixmap((16, 4), 8 * bytes, Wanted::Anywhere);
    assert!(engine.upload(pixmap, (0, 0), (16 * bytes, 4), &[value; 256], 16 * bytes as usize));
    Surface { pixmap, size, format }
}

/// All of a destination, through one box.
fn over(source: Ink, mask: Cover, onto: Surface) -> Request<'static> {
    let clips = &[ClipBox { x1: 1, y1: 1, x2: 4, y2: 2 }];
    Request { operator: ComposeOperator::Over, source, mask, onto, clips, moved: [1, 0] }
}

const ALL: ListRectangle = ListRectangle { x: 0, y: 0, width: 16, height: 4 };

#[test]
fn compose_through_a_moved_box_and_a_mask() {
    let mut engine = engine(4 << 20, 0);
    let onto = surface(&mut engine, PictureFormat::Argb8888, 0);
    let mask = surface(&mut engine, PictureFormat::Alpha8, 0x80);
    let mask = Sampled { surface: mask, offset: [0; 2], repeat: Repeat::Normal, transform: None };
    let request = over(Ink::Colour(0xFF40_8000), Cover::Unified(Ink::Sampled(mask)), onto);
    assert!(engine.compose(&request, ALL));
    let found = pixels(&mut engine, onto.pixmap);
    assert_eq!(found[16..24], [0, 0, 0x8020_4000, 0x8020_4000, 0x8020_4000, 0, 0, 0]);
    assert!(found[..16].iter().chain(&found[32..]).all(|pixel| *pixel == 0));
}

#[test]
fn compose_image_of_the_destination_is_refused_but_for_a_copy() {
    let mut engine = engine(4 << 20, 0);
    let onto = surface(&mut engine, PictureFormat::Argb8888, 0x11);
    let sampled = |offset| Ink::Sampled(Sampled { surface: onto, offset, repeat: Repeat::None, transform: None });
    assert!(!engine.compose(&over(sampled([0, 1]), Cover::None, onto), ALL));
    let copy = Request { operator: ComposeOperator::Source, ..over(sampled([0, 1]), Cover::None, onto) };
    assert!(!engine.compose(&copy, ALL), "it would write what it reads");
    assert!(engine.compose(&copy, ListRectangle { height: 1, y: 1, ..ALL }));
}

#[test]
fn compose_surface_that_is_not_the_pixmap_is_refused() {
    let mut engine = engine(4 << 20, 0);
    let onto = surface(&mut engine, PictureFormat::Argb8888, 0);
    let black = |onto| over(Ink::Colour(0x8000_0000), Cover::None, onto);
    assert!(!engine.compose(&black(Surface { size: [17, 4], ..onto }), ALL));
    assert!(!engine.compose(&black(Surface { format: PictureFormat::Rgb565, ..onto }), ALL));
    engine.access(onto.pixmap).expect("pixels");
    assert!(!engine.compose(&black(onto), ALL), "it is open");
    engine.finish();
    assert!(engine.compose(&black(onto), ALL));
}

/// Two glyphs of two pixels each, 0x80 and 0x90, at these columns of row 1.
fn glyphs(engine: &mut Engine, columns: [i32; 2]) -> [Glyph; 2] {
    let pixmap = engine.create_pixmap((2, 1), 8, Wanted::InHostMemory);
    if let Some(Pixmap { place: Place::Host(words), .. }) = engine.pixmaps.get_mut(pixmap) {
        words[0] = 0x9080;
    }
    columns.map(|x| Glyph { pixmap, x, y: 1, width: 2, height: 1, format: PictureFormat::Alpha8 })
}

#[test]
fn compose_glyphs_added_up_first_or_one_by_one() {
    let mut engine = engine(4 << 20, 0);
    let mut found = |columns, mask, operator| {
        let onto = surface(&mut engine, PictureFormat::Alpha8, 0x40);
        let glyphs = glyphs(&mut engine, columns);
        let request = Request { operator, ..over(Ink::Colour(u32::MAX), Cover::None, onto) };
        assert!(engine.compose_glyphs(&request, &glyphs, mask));
        // Row 1 begins after the 64 bytes of row 0.
        pixels(&mut engine, onto.pixmap)[16..18].iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>()
    };
    let (over, source) = (ComposeOperator::Over, ComposeOperator::Source);
    let alpha = Some(PictureFormat::Alpha8);
    // The box holds columns 2 to 4.
    let apart = [0x40, 0x40, 0xA0, 0xAC, 0xA0, 0x40, 0x40, 0x40];
    assert_eq!(found([2, 4], None, over), apart);
    assert_eq!(found([2, 4], alpha, over), apart, "the sum is the same");
    assert_eq!(found([2, 3], None, over), [0x40, 0x40, 0xA0, 0xD6, 0xAC, 0x40, 0x40, 0x40]);
    assert_eq!(found([2, 3], alpha, over), [0x40, 0x40, 0xA0, 0xFF, 0xAC, 0x40, 0x40, 0x40]);
    assert_eq!(found([1, 4], alpha, source), [0x40, 0x40, 0x90, 0, 0x80, 0x40, 0x40, 0x40], "all of the box");
}
