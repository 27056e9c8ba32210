//! Lists against a model that does one pixel at a time, on a card that works fast and on one that works by its
//! specification; and what is sent and refused.

use proptest::prelude::*;
use zga_abi::format::{BitmapFormat, RasterOperation};
use zga_device::{Card, CardOptions, Kernel};
use zga_driver::bus::MockBus;
use zga_driver::{
    BitmapGlyph, Canvas, ClipBox, Driver, DriverError, Image, ImageError, ListRectangle, Point, Raster, Rectangle,
    Segment,
};

const WIDTH: i32 = 70;
const HEIGHT: i32 = 40;

/// A call.
#[derive(Clone, Debug)]
enum Call {
    Fill(Vec<ListRectangle>),
    Copy([i32; 2], Vec<ListRectangle>),
    Segments(Vec<Segment>, bool),
    Polyline(Vec<Point>, bool),
    Expand(u32, Option<u32>, Vec<(i16, i16, u16, u16, u32)>),
}

/// How it is made.
#[derive(Clone, Debug)]
struct How {
    origin: [i16; 2],
    clips: Vec<ClipBox>,
    raster: Raster,
    value: u32,
}

/// A number by multiplying and adding.
fn next(state: &mut u32) -> u32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    *state >> 8
}

fn place() -> impl Strategy<Value = i16> {
    prop_oneof![8 => -20..90_i16, 1 => any::<i16>(), 1 => Just(i16::MIN), 1 => Just(i16::MAX)]
}

fn side() -> impl Strategy<Value = u16> {
    prop_oneof![6 => 0..12_u16, 2 => 12..90_u16, 1 => any::<u16>()]
}

fn rectangles() -> impl Strategy<Value = Vec<ListRectangle>> {
    let one =
        (place(), place(), side(), side()).prop_map(|(x, y, width, height)| ListRectangle { x, y, width, height });
    prop::collection::vec(one, 0..8)
}

fn call() -> impl Strategy<Value = Call> {
    let segment = (place(), place(), place(), place()).prop_map(|(x1, y1, x2, y2)| Segment { x1, y1, x2, y2 });
    let point = (place(), place()).prop_map(|(x, y)| Point { x, y });
    let bitmap = (-20..90_i16, -20..50_i16, 0..75_u16, 0..14_u16, any::<u32>());
    prop_oneof![
        rectangles().prop_map(Call::Fill),
        ([-12..12_i32, -12..12_i32], rectangles()).prop_map(|(offset, list)| Call::Copy(offset, list)),
        (prop::collection::vec(segment, 0..8), any::<bool>()).prop_map(|(list, last)| Call::Segments(list, last)),
        (prop::collection::vec(point, 0..8), any::<bool>()).prop_map(|(list, last)| Call::Polyline(list, last)),
        (any::<u32>(), any::<Option<u32>>(), prop::collection::vec(bitmap, 0..6))
            .prop_map(|(ones, zeros, list)| Call::Expand(ones, zeros, list)),
    ]
}

fn how() -> impl Strategy<Value = How> {
    let clip = (-5..60_i16, -5..35_i16, 0..40_i16, 0..30_i16).prop_map(|(x1, y1, width, height)| ClipBox {
        x1,
        y1,
        x2: x1 + width,
        y2: y1 + height,
    });
    let clips = prop_oneof![Just(vec![ClipBox::ALL]), prop::collection::vec(clip, 0..4)];
    let operation = prop_oneof![Just(3_u32), 0..16_u32];
    let planes = prop_oneof![Just(u32::MAX), Just(0x00FF_FFFF), any::<u32>()];
    let origin = prop_oneof![Just([0, 0]), Just([3, -2]), Just([i16::MIN, 7]), Just([i16::MAX, i16::MAX])];
    (origin, clips, operation, planes, any::<u32>()).prop_map(|(origin, clips, operation, planes, value)| {
        let operation = RasterOperation::from_code(operation).expect("16 of them");
        How { origin, clips, raster: Raster { operation, planes }, value }
    })
}

/// The bytes of a bitmap, and whether a pixel of it is set.
fn bitmap(width: u16, height: u16, seed: u32) -> Vec<u8> {
    let (mut state, bytes) = (seed, 4 * usize::from(width).div_ceil(32) * usize::from(height));
    (0..bytes).map(|_| next(&mut state) as u8).collect()
}

/// What becomes of a pixel, bit by bit, by the rows of the operation's truth table.
fn operated(raster: Raster, source: u32, there: u32) -> u32 {
    (0..32).fold(0, |pixel, k| {
        let [s, d, may] = [source, there, raster.planes].map(|word| word >> k & 1);
        let result = raster.operation.code() >> (2 * (1 - s) + (1 - d)) & 1;
        pixel | (if may == 1 { result } else { d }) << k
    })
}

/// Pixels of an image as numbers.
struct Model {
    pixels: Vec<u32>,
    bits: u32,
}

impl Model {
    fn at(x: i64, y: i64) -> Option<usize> {
        let inside = (0..i64::from(WIDTH)).contains(&x) && (0..i64::from(HEIGHT)).contains(&y);
        inside.then_some((y * i64::from(WIDTH) + x) as usize)
    }

    fn put(&mut self, how: &How, clip: &ClipBox, [x, y]: [i64; 2], source: u32) {
        let holds = (i64::from(clip.x1)..i64::from(clip.x2)).contains(&x)
            && (i64::from(clip.y1)..i64::from(clip.y2)).contains(&y);
        if let (true, Some(at)) = (holds, Model::at(x, y)) {
            self.pixels[at] = operated(how.raster, source, self.pixels[at]) & self.bits;
        }
    }

    /// Places of a rectangle that lie in the image.
    fn places(how: &How, rectangle: &ListRectangle) -> Vec<[i64; 2]> {
        let [x, y] = [rectangle.x, rectangle.y].map(i64::from);
        let (x, y) = (x + i64::from(how.origin[0]), y + i64::from(how.origin[1]));
        let (right, bottom) = (x + i64::from(rectangle.width), y + i64::from(rectangle.height));
        let columns = x.max(0)..right.min(i64::from(WIDTH));
        (y.max(0)..bottom.min(i64::from(HEIGHT))).flat_map(|y| columns.clone().map(move |x| [x, y])).collect()
    }

    /// Steps along the longer axis; where the true line is half way between two pixels, the octant decides: towards the
    /// start where it goes up and is steep, or goes left and is flat; else away from it.
    fn line(&mut self, how: &How, from: Point, to: Point, last: bool) {
        let [x1, y1, x2, y2] = [from.x, from.y, to.x, to.y].map(i128::from);
        let [ox, oy] = how.origin.map(i128::from);
        let (dx, dy) = (x2 - x1, y2 - y1);
        let steep = dy.abs() > dx.abs();
        let (long, short) = if steep { (dy, dx) } else { (dx, dy) };
        for clip in &how.clips {
            for i in 0..long.abs() + i128::from(last) {
                let (n, m) = (long.abs().max(1), short.abs());
                // m i / n to the nearest, in halves: the remainder is exact.
                let (whole, rest) = (m * i / n, m * i % n);
                let up = if 2 * rest == n { long > 0 } else { 2 * rest > n };
                let across = (whole + i128::from(up)) * short.signum();
                let along = i * long.signum();
                let (x, y) = if steep { (x1 + across, y1 + along) } else { (x1 + along, y1 + across) };
                self.put(how, clip, [x + ox, y + oy].map(|place| place as i64), how.value);
            }
        }
    }

    fn call(&mut self, how: &How, call: &Call) {
        match call {
            Call::Fill(list) => {
                for rectangle in list {
                    for (clip, place) in each(&how.clips, &Model::places(how, rectangle)) {
                        self.put(how, clip, place, how.value);
                    }
                }
            }
            Call::Copy([dx, dy], list) => {
                for rectangle in list {
                    for clip in &how.clips {
                        let before = self.pixels.clone();
                        for place in Model::places(how, rectangle) {
                            if let Some(at) = Model::at(place[0] + i64::from(*dx), place[1] + i64::from(*dy)) {
                                self.put(how, clip, place, before[at]);
                            }
                        }
                    }
                }
            }
            Call::Segments(list, last) => {
                for &Segment { x1, y1, x2, y2 } in list {
                    self.line(how, Point { x: x1, y: y1 }, Point { x: x2, y: y2 }, *last);
                }
            }
            Call::Polyline(list, last) => {
                for (place, pair) in list.windows(2).enumerate() {
                    self.line(how, pair[0], pair[1], *last && place + 2 == list.len());
                }
                if let [point] = list[..] {
                    self.line(how, point, point, *last);
                }
            }
            Call::Expand(ones, zeros, list) => {
                for &(x, y, width, height, seed) in list {
                    let bytes = bitmap(width, height, seed);
                    let row_bytes = 4 * i64::from(width).div_ceil_32();
                    for (clip, place) in each(&how.clips, &Model::places(how, &ListRectangle { x, y, width, height })) {
                        let column = place[0] - i64::from(x) - i64::from(how.origin[0]);
                        let row = place[1] - i64::from(y) - i64::from(how.origin[1]);
                        let byte = bytes[(row * row_bytes + column / 8) as usize];
                        if let Some(value) = if byte >> (column % 8) & 1 == 1 { Some(*ones) } else { *zeros } {
                            self.put(how, clip, place, value);
                        }
                    }
                }
            }
        }
    }
}

trait Words {
    fn div_ceil_32(self) -> Self;
}

impl Words for i64 {
    fn div_ceil_32(self) -> i64 {
        (self + 31) / 32
    }
}

/// Each place through each clip box, box by box.
fn each<'a>(clips: &'a [ClipBox], places: &[[i64; 2]]) -> Vec<(&'a ClipBox, [i64; 2])> {
    clips.iter().flat_map(|clip| places.iter().map(move |&place| (clip, place))).collect()
}

/// An image's pixels, with what is stored between rows left out.
fn read(driver: &mut Driver<zga_device::CardBus>, image: &Image) -> Vec<u32> {
    driver.finish().expect("done");
    let mut words = vec![0; (image.pitch() * image.height() / 4) as usize];
    driver.read_memory(image.memory(), 0, &mut words).expect("inside");
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let pixel = image.format().bytes() as usize;
    let row = |row: &[u8]| row[..image.width() as usize * pixel].to_vec();
    let rows: Vec<u8> = bytes.chunks(image.pitch() as usize).flat_map(row).collect();
    rows.chunks(pixel).map(|bytes| bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))).collect()
}

/// What a card of this kernel makes of calls on an image of noise, and its counters.
fn drawn(kernel: Kernel, format: BitmapFormat, noise: &[u32], calls: &[(How, Call)]) -> (Vec<u32>, Vec<u64>) {
    let options = CardOptions { video_memory: 1 << 20, threads: 1, kernel, ..CardOptions::default() };
    let card = Card::power_on(options).expect("powers on");
    let mut driver = Driver::open(card.bus()).expect("opens");
    let image = driver.create_image(WIDTH as u32, HEIGHT as u32, format).expect("room");
    let pixel = format.bytes();
    let width = 16 * 4;
    // Whole words: the columns beyond are zeros in the model, too.
    let bytes: Vec<u8> = noise.iter().flat_map(|value| value.to_le_bytes()[..pixel as usize].to_vec()).collect();
    driver.fill(&image, Rectangle { x: 0, y: 0, right: WIDTH as u32, bottom: HEIGHT as u32 }, 0).expect("sent");
    let whole = Rectangle { x: 0, y: 0, right: width, bottom: HEIGHT as u32 };
    driver.upload(&image, whole, &bytes, (width * pixel) as usize).expect("sent");
    for (how, call) in calls {
        let canvas = Canvas { drawable: (&image).into(), origin: how.origin, clips: &how.clips, raster: how.raster };
        match call {
            Call::Fill(list) => driver.fill_list(&canvas, how.value, list),
            Call::Copy(offset, list) => driver.copy_list(&image, *offset, &canvas, list),
            Call::Segments(list, last) => driver.segments(&canvas, how.value, list, *last),
            Call::Polyline(list, last) => driver.polyline(&canvas, how.value, list, *last),
            Call::Expand(ones, zeros, list) => {
                let bits: Vec<Vec<u8>> = list.iter().map(|&(_, _, w, h, seed)| bitmap(w, h, seed)).collect();
                let glyphs = list.iter().zip(&bits).map(|(&(x, y, width, height, _), bits)| BitmapGlyph {
                    x,
                    y,
                    width,
                    height,
                    bits,
                });
                driver.expand(&canvas, *ones, *zeros, glyphs)
            }
        }
        .expect("sent");
    }
    let pixels = read(&mut driver, &image);
    let counters = driver.counters();
    (pixels, zga_abi::Counter::ALL.iter().map(|&counter| counters.get(counter)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn lists_any_calls_come_to_the_model_by_both_kernels(
        format in prop::sample::select(BitmapFormat::ALL.to_vec()),
        seed in any::<u32>(),
        calls in prop::collection::vec((how(), call()), 1..5),
    ) {
        let mut state = seed;
        let bits = (1_u64 << (8 * format.bytes())) as u32;
        let bits = bits.wrapping_sub(1);
        let noise: Vec<u32> = (0..64 * HEIGHT).map(|_| next(&mut state) ^ next(&mut state) << 16).collect();
        let mut model = Model { pixels: vec![0; (WIDTH * HEIGHT) as usize], bits };
        for (row, values) in noise.chunks(64).enumerate() {
            for (column, value) in values.iter().enumerate() {
                model.pixels[row * WIDTH as usize + column] = value & bits;
            }
        }
        for (how, call) in &calls {
            model.call(how, call);
        }
        let (fast, fast_counters) = drawn(Kernel::Best, format, &noise, &calls);
        let (plain, plain_counters) = drawn(Kernel::Specification, format, &noise, &calls);
        prop_assert_eq!(&fast, &model.pixels);
        prop_assert_eq!(&plain, &model.pixels);
        prop_assert_eq!(fast_counters, plain_counters);
    }
}

// What is sent and refused ---------------------------------------------------------------------

/// A driver on a mock card of 4 MiB, with a ring of 4096 words.
fn mock() -> Driver<MockBus> {
    let options = zga_driver::DriverOptions { ring_words: 4096, ..zga_driver::DriverOptions::default() };
    Driver::open_with(MockBus::new(4 << 20), options).expect("the mock card opens")
}

#[test]
fn lists_send_the_words_of_the_manual() {
    let mut driver = mock();
    let image = driver.create_image(16, 8, BitmapFormat::Argb8888).expect("room");
    let raster = Raster { operation: RasterOperation::Xor, planes: 0xF0 };
    let clips = [ClipBox { x1: 1, y1: 2, x2: 3, y2: 4 }];
    let canvas = Canvas { drawable: (&image).into(), origin: [-1, 2], clips: &clips, raster };
    driver.fill_list(&canvas, 9, &[ListRectangle { x: -2, y: 3, width: 4, height: 5 }]).expect("sent");
    driver.copy_list(&image, [-5, 6], &canvas, &[ListRectangle { x: -2, y: 3, width: 4, height: 5 }]).expect("sent");
    driver.segments(&canvas, 9, &[Segment { x1: 1, y1: 2, x2: -3, y2: 4 }], true).expect("sent");
    driver.polyline(&canvas, 9, &[Point { x: 1, y: 2 }, Point { x: 3, y: 4 }], false).expect("sent");
    let bits = [1, 2, 3, 4, 5, 6, 7, 8];
    let glyphs = [BitmapGlyph { x: 1, y: 2, width: 3, height: 2, bits: &bits }];
    driver.expand(&canvas, 9, Some(8), glyphs).expect("sent");
    driver.upload(&image, Rectangle { x: 2, y: 1, right: 3, bottom: 3 }, &bits, 4).expect("sent");
    driver.finish().expect("done");
    let packets = driver.bus_mut().take_packets();
    let head = [0x4000, 64, 1, 0x0008_0010, 6, 0xF0, 0x0002_FFFF, 1];
    let clip = [0x0002_0001, 0x0004_0003];
    let expected = |opcode: u32, parts: [&[u32]; 2]| {
        let payload = [&head[..], parts[0], &clip, parts[1]].concat();
        [&[opcode << 24 | payload.len() as u32], &payload[..]].concat()
    };
    let rectangle = [0x0003_FFFE, 0x0005_0004];
    assert_eq!(packets[0], expected(0x28, [&[9], &rectangle]));
    assert_eq!(packets[1], expected(0x29, [&[0x4000, 64, 0x0008_0010, 0xFFFF_FFFB, 6], &rectangle]));
    assert_eq!(packets[2], expected(0x2A, [&[9, 1], &[0x0002_0001, 0x0004_FFFD]]));
    assert_eq!(packets[3], expected(0x2A, [&[9, 2], &[0x0002_0001, 0x0004_0003]]));
    assert_eq!(packets[4], expected(0x2B, [&[9, 8, 1], &[0x0002_0001, 0x0002_0003, 0x0403_0201, 0x0807_0605]]));
    assert_eq!(packets[5], [0x2200_0006, 0x4048, 64, 1, 2, 0x0403_0201, 0x0807_0605]);
}

#[test]
fn lists_longer_than_a_packet_are_cut_and_lose_nothing() {
    let draw = |ring_words| {
        let options = CardOptions { video_memory: 8 << 20, threads: 1, ..CardOptions::default() };
        let card = Card::power_on(options).expect("powers on");
        let options = zga_driver::DriverOptions { ring_words, ..zga_driver::DriverOptions::default() };
        let mut driver = Driver::open_with(card.bus(), options).expect("opens");
        let image = driver.create_image(300, 200, BitmapFormat::Xrgb8888).expect("room");
        let whole = Raster::new(RasterOperation::Copy);
        driver
            .fill_list(&Canvas::whole(&image, whole), 0, &[ListRectangle { x: 0, y: 0, width: 300, height: 200 }])
            .expect("sent");
        let mut state = 5;
        let mut number = |most: u32| (next(&mut state) % most) as i16;
        let points: Vec<Point> = (0..5000).map(|_| Point { x: number(400) - 50, y: number(300) - 50 }).collect();
        let canvas = Canvas::whole(&image, Raster::new(RasterOperation::Xor));
        driver.polyline(&canvas, 0x55_AA33, &points, true).expect("sent");
        let rectangles: Vec<ListRectangle> =
            points.iter().map(|&Point { x, y }| ListRectangle { x, y, width: 5, height: 7 }).collect();
        driver.fill_list(&canvas, 0x12_3456, &rectangles).expect("sent");
        let bits = bitmap(300, 190, 7);
        let glyphs = [BitmapGlyph { x: 3, y: -4, width: 300, height: 190, bits: &bits }; 3];
        driver.expand(&canvas, 0xFF_00FF, Some(0x00_FF00), glyphs).expect("sent");
        read(&mut driver, &image)
    };
    assert_eq!(draw(4096), draw(1 << 20));
}

#[test]
fn lists_bad_arguments_are_refused_and_send_nothing() {
    let mut driver = mock();
    let image = driver.create_image(16, 8, BitmapFormat::Alpha8).expect("room");
    let wide = driver.create_image(16, 8, BitmapFormat::Argb8888).expect("room");
    let canvas = Canvas::whole(&image, Raster::new(RasterOperation::Copy));
    let short = BitmapGlyph { x: 0, y: 0, width: 33, height: 2, bits: &[0; 15] };
    let bits = ImageError::Bits { width: 33, height: 2, needed: 16, found: 15 };
    assert_eq!(driver.expand(&canvas, 1, None, [short]), Err(DriverError::Image(bits)));
    assert!(matches!(
        driver.copy_list(&wide, [0, 0], &canvas, &[ListRectangle::default()]),
        Err(DriverError::Image(ImageError::FormatsDiffer { call: "copy_list", .. }))
    ));
    assert!(matches!(
        driver.copy_list(&image, [0, 65536], &canvas, &[ListRectangle::default()]),
        Err(DriverError::BadOption { name: "copy_list offset", .. })
    ));
    let unaligned = driver.upload(&image, Rectangle { x: 2, y: 0, right: 6, bottom: 1 }, &[0; 4], 4);
    assert_eq!(unaligned, Err(DriverError::Image(ImageError::Unaligned { x: 2, width: 4, pixel: 1 })));
    let few = driver.upload(&image, Rectangle { x: 0, y: 0, right: 4, bottom: 3 }, &[0; 11], 4);
    assert_eq!(few, Err(DriverError::Image(ImageError::Rows { row_bytes: 4, stride: 4, rows: 3, found: 11 })));
    let clips = vec![ClipBox::ALL; 1000];
    let crowded = Canvas { clips: &clips, ..canvas };
    assert!(matches!(
        driver.fill_list(&crowded, 1, &[ListRectangle::default()]),
        Err(DriverError::PacketTooLong { packet: "FILL_LIST", .. })
    ));
    driver.finish().expect("done");
    assert_eq!(driver.bus_mut().take_packets(), Vec::<Vec<u32>>::new());
}
