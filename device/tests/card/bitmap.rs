//! Fill, copy, upload, download, raster operations, conversion, stretch against a model that does one pixel, one bit or
//! one channel at a time. What the unit can do in two ways, fast and by its specification, is done in both.

use crate::rig::*;
use proptest::prelude::*;
use zga_abi::{Bus, Counter};
use zga_device::{Card, CardOptions, Kernel};

/// Bytes of memory that the tests work in.
const AREA: usize = 0x4000;

/// Memory as bytes, with the plain meaning of the packets.
struct Model {
    bytes: Vec<u8>,
}

impl Model {
    /// Random contents, and the same in the card's memory.
    fn new(rig: &mut Rig) -> Model {
        let words = noise(AREA / 4);
        rig.write_burst(MEMORY, &words);
        Model { bytes: words.iter().flat_map(|word| word.to_le_bytes()).collect() }
    }

    fn words(&self) -> Vec<u32> {
        self.bytes.chunks(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
    }

    fn fill(&mut self, surface: Place, size: [usize; 2], value: u32) {
        for (x, y) in pixels(size) {
            let at = surface.at(x, y);
            self.bytes[at..at + surface.pixel].copy_from_slice(&value.to_le_bytes()[..surface.pixel]);
        }
    }

    /// All of the source is read before any of the destination is written.
    fn copy(&mut self, from: Place, to: Place, size: [usize; 2]) {
        let before = self.bytes.clone();
        for (x, y) in pixels(size) {
            let (source, destination) = (from.at(x, y), to.at(x, y));
            self.bytes[destination..destination + to.pixel].copy_from_slice(&before[source..source + from.pixel]);
        }
    }
}

/// What becomes of a bit: by the place of its row in the truth table of the operation.
fn bit(operation: u32, source: bool, destination: bool) -> bool {
    let place = 2 * u32::from(!source) + u32::from(!destination);
    (operation >> place) & 1 == 1
}

/// A stored pixel after a raster operation on some planes, bit by bit.
fn operated(operation: u32, planes: u32, source: u32, destination: u32) -> u32 {
    (0..32).fold(0, |pixel, k| {
        let [source, destination, may_change] = [source, destination, planes].map(|word| (word >> k) & 1 == 1);
        let new = if may_change { bit(operation, source, destination) } else { destination };
        pixel | (u32::from(new) << k)
    })
}

/// Red, green, blue, alpha of a stored pixel.
fn colour(format: u32, pixel: u32) -> [u64; 4] {
    let field = |low: u32, bits: u32| u64::from(pixel >> low) % (1 << bits);
    match format {
        0 => [field(16, 8), field(8, 8), field(0, 8), 255],
        1 => [field(16, 8), field(8, 8), field(0, 8), field(24, 8)],
        2 => [field(11, 5) * 33 / 4, field(5, 6) * 65 / 16, field(0, 5) * 33 / 4, 255],
        _ => [0, 0, 0, field(0, 8)],
    }
}

/// The reverse.
fn stored(format: u32, [red, green, blue, alpha]: [u64; 4]) -> u32 {
    let pixel = match format {
        0 => (255 << 24) + (red << 16) + (green << 8) + blue,
        1 => (alpha << 24) + (red << 16) + (green << 8) + blue,
        2 => (red / 8) * 2048 + (green / 4) * 32 + blue / 8,
        _ => alpha,
    };
    pixel as u32
}

/// Two pixels along an axis and their weights, of 256, from the definition in the manual.
fn taken(place: u64, source: u64, whole: u64, bilinear: bool) -> [(usize, u64); 2] {
    let centre = ((2 * place + 1) * source * 65536 / (2 * whole)) as i64;
    if !bilinear {
        return [(centre.div_euclid(65536) as usize, 256), (0, 0)];
    }
    let from_first = centre - 32768;
    let first = from_first.div_euclid(65536);
    let fraction = (from_first.rem_euclid(65536) / 256) as u64;
    let inside = |pixel: i64| pixel.max(0).min(source as i64 - 1) as usize;
    [(inside(first), 256 - fraction), (inside(first + 1), fraction)]
}

impl Model {
    fn load(&self, place: Place, x: usize, y: usize) -> u32 {
        let bytes = &self.bytes[place.at(x, y)..][..place.pixel];
        bytes.iter().rev().fold(0, |pixel, &byte| pixel * 256 + u32::from(byte))
    }

    fn store(&mut self, place: Place, x: usize, y: usize, pixel: u32) {
        self.bytes[place.at(x, y)..][..place.pixel].copy_from_slice(&pixel.to_le_bytes()[..place.pixel]);
    }

    /// The stored pixels of a rectangle.
    fn all(&self, place: Place, size: [usize; 2]) -> Vec<u32> {
        pixels(size).map(|(x, y)| self.load(place, x, y)).collect()
    }

    fn combine(&mut self, sources: &[u32], to: Place, size: [usize; 2], operation: u32, planes: u32) {
        for ((x, y), &source) in pixels(size).zip(sources) {
            let new = operated(operation, planes, source, self.load(to, x, y));
            self.store(to, x, y, new);
        }
    }

    fn convert(&mut self, formats: [u32; 2], from: Place, to: Place, size: [usize; 2]) {
        for ((x, y), source) in pixels(size).zip(self.all(from, size)) {
            self.store(to, x, y, stored(formats[1], colour(formats[0], source)));
        }
    }

    fn stretch(&mut self, from: &Stretched, to: &Stretched, whole: [usize; 2], part: [usize; 2], bilinear: bool) {
        for (x, y) in pixels(to.size) {
            let [across, down] = [(x, 0), (y, 1)].map(|(place, axis)| {
                taken((part[axis] + place) as u64, from.size[axis] as u64, whole[axis] as u64, bilinear)
            });
            let mut sums = [0; 4];
            for (row, row_weight) in down {
                for (column, weight) in across {
                    let pixel = colour(from.format, self.load(from.place, column, row));
                    sums = [0, 1, 2, 3].map(|k| sums[k] + row_weight * weight * pixel[k]);
                }
            }
            self.store(to.place, x, y, stored(to.format, sums.map(|sum| (sum + 32768) / 65536)));
        }
    }
}

/// One side of a stretch.
#[derive(Clone, Debug)]
struct Stretched {
    format: u32,
    place: Place,
    size: [usize; 2],
}

/// Does each kernel's card, with this memory, come to the model's memory by this packet?
fn both_ways(before: &Model, packet: &[u32], after: &Model) -> Result<(), TestCaseError> {
    for kernel in [Kernel::Best, Kernel::Specification] {
        let mut rig = rig_of(kernel);
        rig.write_burst(MEMORY, &before.words());
        rig.push(packet);
        rig.finish(1);
        prop_assert_eq!(rig.read32(ERROR_CODE), 0);
        prop_assert!(rig.words(0, AREA / 4) == after.words(), "{:?}: memory differs from the model's", kernel);
    }
    Ok(())
}

fn rig_of(kernel: Kernel) -> Rig {
    let options = CardOptions { video_memory: 1 << 20, za_ram: 0x1_0000, threads: 1, kernel };
    let card = Card::power_on(options).expect("a card of these sizes");
    let bus = card.bus();
    Rig { card, bus }
}

/// Random memory.
fn model() -> Model {
    Model { bytes: noise(AREA / 4).iter().flat_map(|word| word.to_le_bytes()).collect() }
}

/// All formats of the unit: code and bytes of a pixel.
fn any_format() -> impl Strategy<Value = (u32, usize)> {
    prop::sample::select(vec![(0, 4), (1, 4), (2, 2), (3, 1)])
}

/// Places on surfaces of `pixel` bytes that hold 70 x 10 pixels inside the area; wide enough for every width of a host's
/// registers and what is left over.
fn wide_place(pixel: usize) -> impl Strategy<Value = Place> {
    (0..200_usize, 80..110_usize, 0..10_usize, 0..10_usize).prop_map(move |(base, pitch, x, y)| Place {
        base: base * pixel,
        pitch: pitch * pixel,
        x,
        y,
        pixel,
    })
}

/// Two places on surfaces of `pixel` bytes: anywhere, a few pixels apart on one surface, or with another pitch.
fn two_places(pixel: usize) -> impl Strategy<Value = (Place, Place)> {
    let near = (wide_place(pixel), 0..10_usize, 0..10_usize).prop_map(|(from, x, y)| (from, Place { x, y, ..from }));
    // Rows that run ahead of the other ones, or fall behind.
    let other_pitch =
        (wide_place(pixel), wide_place(pixel)).prop_map(|(from, to)| (from, Place { base: from.base, ..to }));
    prop_oneof![1 => (wide_place(pixel), wide_place(pixel)), 3 => near, 2 => other_pitch]
}

/// Every other one so narrow that rows end beside others.
fn size() -> impl Strategy<Value = [usize; 2]> {
    [prop_oneof![0..12_usize, 0..71_usize].boxed(), (0..11_usize).boxed()]
}

fn planes() -> impl Strategy<Value = u32> {
    prop_oneof![Just(u32::MAX), Just(0xFF), Just(0x00FF_FFFF), any::<u32>()]
}

/// Base, pitch, x, y.
fn surface(place: Place) -> [u32; 4] {
    [place.base, place.pitch, place.x, place.y].map(|value| value as u32)
}

/// Width and height.
fn words(size: [usize; 2]) -> [u32; 2] {
    size.map(|pixels| pixels as u32)
}

fn pixels([width, height]: [usize; 2]) -> impl Iterator<Item = (usize, usize)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// A rectangle's first pixel on a surface.
#[derive(Clone, Copy, Debug)]
struct Place {
    base: usize,
    pitch: usize,
    x: usize,
    y: usize,
    pixel: usize,
}

impl Place {
    fn at(&self, x: usize, y: usize) -> usize {
        self.base + (self.y + y) * self.pitch + (self.x + x) * self.pixel
    }
}

/// Places on surfaces of `pixel` bytes that hold 12 x 12 pixels inside the area.
fn place(pixel: usize) -> impl Strategy<Value = Place> {
    (0..200_usize, 24..60_usize, 0..10_usize, 0..10_usize).prop_map(move |(base, pitch, x, y)| Place {
        base: base * pixel,
        pitch: pitch * pixel,
        x,
        y,
        pixel,
    })
}

/// XRGB8888 or RGB565: code and bytes of a pixel.
fn format() -> impl Strategy<Value = (u32, usize)> {
    prop_oneof![Just((0, 4)), Just((1, 4)), Just((2, 2))]
}

fn copy_packet(format: u32, from: Place, to: Place, [width, height]: [usize; 2]) -> Vec<u32> {
    let surface = |p: Place| [p.base, p.pitch, p.x, p.y].map(|value| value as u32);
    let mut packet = vec![0x2100_000B, format];
    packet.extend(surface(from));
    packet.extend(surface(to));
    packet.extend([width as u32, height as u32]);
    packet
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn copy_any_overlap_equals_the_model(
        (code, from, to) in format().prop_flat_map(|(code, pixel)| (Just(code), place(pixel), place(pixel))),
        equal_pitch in any::<bool>(),
        size in [0..12_usize, 0..12_usize],
    ) {
        let to = if equal_pitch { Place { pitch: from.pitch, ..to } } else { to };
        let mut rig = Rig::new();
        let mut model = Model::new(&mut rig);
        model.copy(from, to, size);
        rig.push(&copy_packet(code, from, to, size));
        rig.finish(1);
        prop_assert_eq!(rig.read32(ERROR_CODE), 0);
        prop_assert_eq!(rig.words(0, AREA / 4), model.words());
    }

    #[test]
    fn fill_any_rectangle_equals_the_model(
        (code, place) in format().prop_flat_map(|(code, pixel)| (Just(code), place(pixel))),
        size in [0..12_usize, 0..12_usize],
        value in any::<u32>(),
    ) {
        let mut rig = Rig::new();
        let mut model = Model::new(&mut rig);
        model.fill(place, size, value);
        let [base, pitch, x, y, width, height] =
            [place.base, place.pitch, place.x, place.y, size[0], size[1]].map(|value| value as u32);
        rig.push(&[0x2000_0008, base, pitch, code, x, y, width, height, value]);
        rig.finish(1);
        prop_assert_eq!(rig.read32(ERROR_CODE), 0);
        prop_assert_eq!(rig.words(0, AREA / 4), model.words());
    }

    #[test]
    fn download_any_overlap_equals_the_model(
        address in 0..300_usize,
        gap in 0..5_usize,
        size in [1..12_usize, 1..12_usize],
        destination in 0..300_usize,
    ) {
        let mut rig = Rig::new();
        let mut model = Model::new(&mut rig);
        let from = Place { base: 4 * address, pitch: 4 * (size[0] + gap), x: 0, y: 0, pixel: 4 };
        let to = Place { base: 4 * destination, pitch: 4 * size[0], ..from };
        model.copy(from, to, size);
        let words = [from.base, from.pitch, size[0], size[1], to.base].map(|value| value as u32);
        rig.push(&[&[0x2300_0005], &words[..]].concat());
        rig.finish(1);
        prop_assert_eq!(rig.read32(ERROR_CODE), 0);
        prop_assert_eq!(rig.words(0, AREA / 4), model.words());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn fill_rop_any_operation_equals_the_model(
        (format, to) in any_format().prop_flat_map(|(format, pixel)| (Just(format), wide_place(pixel))),
        size in size(),
        value in any::<u32>(),
        operation in 0..16_u32,
        planes in planes(),
    ) {
        let (before, mut after) = (model(), model());
        after.combine(&vec![value; size[0] * size[1]], to, size, operation, planes);
        let [base, pitch, x, y] = surface(to);
        let [width, height] = words(size);
        let packet = [0x2400_000A, base, pitch, format, x, y, width, height, value, operation, planes];
        both_ways(&before, &packet, &after)?;
    }

    #[test]
    fn copy_rop_any_operation_and_overlap_equals_the_model(
        (format, (from, to)) in any_format().prop_flat_map(|(format, pixel)| (Just(format), two_places(pixel))),
        size in size(),
        operation in 0..16_u32,
        planes in planes(),
    ) {
        let (before, mut after) = (model(), model());
        after.combine(&before.all(from, size), to, size, operation, planes);
        let payload = [&[format][..], &surface(from), &surface(to), &words(size), &[operation, planes]].concat();
        both_ways(&before, &[&[0x2500_000D][..], &payload].concat(), &after)?;
    }

    #[test]
    fn convert_any_formats_and_overlap_equals_the_model(
        (from_format, from) in any_format().prop_flat_map(|(format, pixel)| (Just(format), wide_place(pixel))),
        (format, to) in any_format().prop_flat_map(|(format, pixel)| (Just(format), wide_place(pixel))),
        in_place in any::<bool>(),
        size in size(),
    ) {
        // The base is a multiple of 4 then, and the pitch holds the larger pixels.
        let from = Place { base: if in_place { 4 * from.base } else { from.base }, ..from };
        let pitch = 4 * (from.pitch / from.pixel);
        let from = if in_place { Place { base: from.base % 512, pitch, ..from } } else { from };
        let to = if in_place { Place { base: from.base, pitch, ..to } } else { to };
        let (before, mut after) = (model(), model());
        after.convert([from_format, format], from, to, size);
        let packet =
            [&[0x2600_000C, from_format][..], &surface(from), &[format], &surface(to), &words(size)].concat();
        both_ways(&before, &packet, &after)?;
    }

    #[test]
    fn stretch_any_sizes_and_part_equals_the_model(
        (from_format, from) in any_format().prop_flat_map(|(format, pixel)| (Just(format), wide_place(pixel))),
        (format, to) in any_format().prop_flat_map(|(format, pixel)| (Just(format), wide_place(pixel))),
        from_size in [1..40_usize, 1..10_usize],
        size in [1..71_usize, 1..9_usize],
        before_part in [0..3000_usize, 0..30_usize],
        behind_part in [0..3000_usize, 0..30_usize],
        bilinear in any::<bool>(),
    ) {
        // The source in the first half of the area, what is written in the second.
        let half = AREA / 2;
        let from = Place { base: from.base % 64 * from.pixel, ..from };
        let to = Place { base: half + to.base % 64 * to.pixel, ..to };
        let from = Stretched { format: from_format, place: from, size: from_size };
        let to = Stretched { format, place: to, size };
        let whole = [0, 1].map(|axis| before_part[axis] + size[axis] + behind_part[axis]);
        let (before, mut after) = (model(), model());
        after.stretch(&from, &to, whole, before_part, bilinear);
        let side = |side: &Stretched| [&[side.format][..], &surface(side.place), &words(side.size)].concat();
        let packet = [
            &[0x2700_0013, u32::from(bilinear)][..],
            &side(&from),
            &side(&to),
            &words(whole),
            &words(before_part),
        ];
        both_ways(&before, &packet.concat(), &after)?;
    }
}

#[test]
fn raster_operations_have_the_numbers_of_the_x_window_system() {
    // Rows: all four pairs of bits. s = 0011, d = 0101.
    let (s, d) = (0b0011, 0b0101);
    let expected =
        [0, s & d, s & !d, s, !s & d, d, s ^ d, s | d, !(s | d), !(s ^ d), !d, s | !d, !s, !s | d, !(s & d), !0_u32];
    for (operation, expected) in (0..).zip(expected) {
        let mut rig = Rig::new();
        rig.write_burst(MEMORY, &[d]);
        rig.push(&[0x2400_000A, 0, 64, 0, 0, 0, 1, 1, s, operation, u32::MAX]);
        rig.finish(1);
        assert_eq!(rig.words(0, 1), [expected], "operation {operation}");
    }
}

#[test]
fn copy_rop_scroll_in_each_direction_with_every_operation() {
    for operation in 0..16 {
        for (x, y) in [(1, 1), (0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (2, 2), (2, 0), (0, 2)] {
            let from = Place { base: 3, pitch: 90, x: 1, y: 1, pixel: 1 };
            let to = Place { x, y, ..from };
            let size = [70, 20];
            let (before, mut after) = (model(), model());
            after.combine(&before.all(from, size), to, size, operation, 0x7F);
            let payload = [&[3][..], &surface(from), &surface(to), &words(size), &[operation, 0x7F]].concat();
            let outcome = both_ways(&before, &[&[0x2500_000D][..], &payload].concat(), &after);
            assert!(outcome.is_ok(), "{outcome:?}: operation {operation}, from (1, 1) to ({x}, {y})");
        }
    }
}

#[test]
fn convert_every_pixel_of_sixteen_bits_and_back_is_the_same() {
    let mut rig = Rig::new();
    let all: Vec<u32> = (0..0x8000).map(|k| (2 * k) | ((2 * k + 1) << 16)).collect();
    rig.write_burst(MEMORY, &all);
    // 256 x 256 pixels: RGB565 to ARGB8888 at 128 KiB, and that to RGB565 at 0x60000.
    rig.push(&[0x2600_000C, 2, 0, 512, 0, 0, 1, 0x2_0000, 1024, 0, 0, 256, 256]);
    rig.push(&[0x2600_000C, 1, 0x2_0000, 1024, 0, 0, 2, 0x6_0000, 512, 0, 0, 256, 256]);
    rig.finish(1);
    let wide = rig.words(0x2_0000, 0x1_0000);
    let expected: Vec<u32> = (0..0x1_0000).map(|pixel| stored(1, colour(2, pixel))).collect();
    assert!(wide == expected);
    assert!(rig.words(0x6_0000, 0x8000) == all);
}

#[test]
fn stretch_in_parts_is_the_stretch_of_the_whole() {
    // 13 x 7 pixels over 50 x 40, whole at 0x8000, in 4 parts at 0x10000.
    for filter in [0, 1] {
        let mut rig = Rig::new();
        rig.write_burst(MEMORY, &noise(16 * 8));
        let mut stretch = |base, x, y, width, height| {
            let from = [filter, 1, 0, 64, 0, 0, 13, 7];
            rig.push(&[&[0x2700_0013][..], &from, &[1, base, 256, x, y, width, height, 50, 40, x, y]].concat());
        };
        stretch(0x8000, 0, 0, 50, 40);
        stretch(0x1_0000, 0, 0, 23, 11);
        stretch(0x1_0000, 23, 0, 27, 11);
        stretch(0x1_0000, 0, 11, 1, 29);
        stretch(0x1_0000, 1, 11, 49, 29);
        rig.finish(1);
        assert_eq!(rig.read32(ERROR_CODE), 0);
        assert!(rig.words(0x8000, 64 * 40) == rig.words(0x1_0000, 64 * 40), "filter {filter}");
    }
}

#[test]
fn stretch_of_largest_sides_stays_in_the_source() {
    // A row of 16384 pixels to one, one pixel to 16384, and 16383 to the last of 16384.
    for filter in [0, 1] {
        for kernel in [Kernel::Best, Kernel::Specification] {
            let mut rig = rig_of(kernel);
            let row: Vec<u32> = (0..4096_u32).map(|k| 0x0101_0101 * (k / 16)).collect();
            rig.write_burst(MEMORY, &row);
            let mut stretch = |[x, from]: [u32; 2], [base, width, whole, part]: [u32; 4]| {
                let source = [filter, 3, 0, 16384, x, 0, from, 1];
                let destination = [3, base, 16384, 0, 0, width, 1];
                rig.push(&[&[0x2700_0013][..], &source, &destination, &[whole, 1, part, 0]].concat());
            };
            stretch([0, 16384], [0x8000, 1, 1, 0]);
            stretch([16383, 1], [0x1_0000, 16384, 16384, 0]);
            stretch([0, 16383], [0x8004, 1, 16384, 16383]);
            rig.finish(1);
            assert_eq!(rig.read32(ERROR_CODE), 0);
            // Pixel 8192, or the mean of 8191 and 8192; all pixels the last; pixel 16382.
            assert_eq!(rig.words(0x8000, 2), [128, 255]);
            assert!(rig.words(0x1_0000, 4096).iter().all(|&word| word == u32::MAX));
        }
    }
}

/// Clocks of the unit, and its pixels moved, combined and stretched.
fn events(rig: &mut Rig) -> [u32; 4] {
    let counters = [Counter::CyclesBitmap, Counter::BitmapPixels, Counter::BitmapCombined, Counter::BitmapStretched];
    counters.map(|counter| rig.read32(counter.offset()))
}

#[test]
fn raster_operation_costs_a_clock_a_line_and_one_more_where_it_reads_what_is_there() {
    // 20 words from byte 60 on touch 3 lines, in each of 3 rows: copy, copy with a plane mask, xor, no-operation.
    let fill = |operation, planes| [0x2400_000A, 0, 4096, 0, 15, 0, 20, 3, 1, operation, planes];
    let cases = [
        (3, u32::MAX, [9, 60, 0, 0]),
        (3, 0xFFFF, [18, 60, 60, 0]),
        (6, u32::MAX, [18, 60, 60, 0]),
        (5, u32::MAX, [0; 4]),
        (6, 0, [0; 4]),
    ];
    for (operation, planes, expected) in cases {
        let mut rig = Rig::new();
        rig.push(&fill(operation, planes));
        rig.finish(1);
        assert_eq!(events(&mut rig), expected, "operation {operation}, planes {planes:#x}");
    }
    // 16 pixels of 2 bytes, twice: copy, or, and clear, which reads no source.
    for (operation, clocks, combined) in [(3, 4, 0), (7, 6, 32), (0, 2, 0)] {
        let mut rig = Rig::new();
        rig.push(&[0x2500_000D, 2, 0, 4096, 0, 0, 0x8000, 4096, 0, 0, 16, 2, operation, 0xFFFF]);
        rig.finish(1);
        assert_eq!(events(&mut rig), [clocks, 32, combined, 0], "operation {operation}");
    }
}

#[test]
fn convert_costs_the_lines_of_both_formats() {
    let mut rig = Rig::new();
    // 64 pixels of a byte are a line, of 4 bytes 4 lines; two rows.
    rig.push(&[0x2600_000C, 3, 0, 64, 0, 0, 1, 0x8000, 256, 0, 0, 64, 2]);
    rig.finish(1);
    assert_eq!(events(&mut rig), [10, 128, 0, 0]);
}

#[test]
fn stretch_costs_each_row_read_once_and_a_clock_a_pixel() {
    for kernel in [Kernel::Best, Kernel::Specification] {
        // 32 x 4 pixels of 4 bytes, 2 lines a row, to 16 x 8: 4 rows read, 128 pixels, 8 lines written.
        for filter in [0, 1] {
            let mut rig = rig_of(kernel);
            rig.push(&[0x2700_0013, filter, 0, 0, 128, 0, 0, 32, 4, 0, 0x8000, 64, 0, 0, 16, 8, 16, 8, 0, 0]);
            rig.finish(1);
            assert_eq!(events(&mut rig), [8 + 128 + 8, 128, 0, 128], "filter {filter}");
        }
        // 32 rows to 2: row 8 and 24, or those and the ones before; the last 16 columns alone.
        for (filter, read) in [(0, 2), (1, 4)] {
            let mut rig = rig_of(kernel);
            rig.push(&[0x2700_0013, filter, 0, 0, 128, 0, 0, 32, 32, 0, 0x8000, 64, 0, 0, 8, 2, 16, 2, 8, 0]);
            rig.finish(1);
            assert_eq!(events(&mut rig), [read + 16 + 2, 16, 0, 16], "filter {filter}");
        }
    }
}

#[test]
fn frame_cleared_in_za_ram_alone_is_there_for_every_packet() {
    let packets: [(&[u32], u32, u32); 4] = [
        // What is there, combined with a value: word 16 of the frame.
        (&[0x2400_000A, 0, 256, 0, 16, 0, 1, 1, 0x0000_00FF, 6, u32::MAX], 0x40, 0xFF12_34A9),
        // A source: to 0x8000.
        (&[0x2500_000D, 0, 0, 256, 0, 0, 0x8000, 256, 0, 0, 1, 1, 12, u32::MAX], 0x8000, 0x00ED_CBA9),
        (&[0x2600_000C, 0, 0, 256, 0, 0, 2, 0x8000, 256, 0, 0, 1, 1], 0x8000, 0x11AA),
        (&[0x2700_0013, 1, 0, 0, 256, 0, 0, 2, 2, 1, 0x8000, 64, 0, 0, 1, 1, 1, 1, 0, 0], 0x8000, 0xFF12_3456),
    ];
    for (packet, address, expected) in packets {
        let mut rig = Rig::new();
        // 64 x 32 pixels at 0, depths at 0x4000; path za; a clear of everything.
        rig.push(&register_write(0x200, &[(32 << 16) | 64, 0, 256, 0, 0x4000, 256]));
        rig.push(&register_write(0x240, &[1]));
        rig.push(&[0x0200_0000, 0x0400_0003, 3, 0x0056_3412, 0x00FF_FFFF, 0x0300_0000]);
        rig.finish(1);
        assert_eq!((rig.read32(ERROR_CODE), rig.words(0, 1)), (0, vec![0]), "cleared in Za RAM alone");
        rig.push(packet);
        rig.finish(2);
        assert_eq!((rig.read32(ERROR_CODE), rig.words(address, 1)), (0, vec![expected]));
        // The rest of the frame, too, is there for the host.
        assert_eq!(rig.words(4, 1), [0xFF12_3456]);
    }
}

#[test]
fn scroll_by_one_row_and_one_pixel_in_each_direction() {
    let places = [(1, 1), (0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (2, 2)];
    for (x, y) in places {
        let mut rig = Rig::new();
        let mut model = Model::new(&mut rig);
        let from = Place { base: 0, pitch: 256, x: 1, y: 1, pixel: 4 };
        let to = Place { x, y, ..from };
        model.copy(from, to, [60, 50]);
        rig.push(&copy_packet(0, from, to, [60, 50]));
        rig.finish(1);
        assert_eq!(rig.words(0, AREA / 4), model.words(), "from (1, 1) to ({x}, {y})");
    }
}

#[test]
fn upload_rows_leaves_the_gaps_alone() {
    let mut rig = Rig::new();
    let mut expected = Model::new(&mut rig).words();
    rig.push(&[0x2200_000A, 0x20, 0x40, 3, 2, 1, 2, 3, 4, 5, 6]);
    rig.finish(1);
    expected[8..11].copy_from_slice(&[1, 2, 3]);
    expected[24..27].copy_from_slice(&[4, 5, 6]);
    assert_eq!(rig.words(0, AREA / 4), expected);
}

#[test]
fn upload_one_row_needs_no_pitch() {
    let mut rig = Rig::new();
    rig.push(&[0x2200_0006, 0x40, 0, 2, 1, 8, 9]);
    rig.finish(1);
    assert_eq!(rig.words(0x40, 3), [8, 9, 0]);
}

#[test]
fn fill_565_odd_pixel_changes_one_half_of_a_word() {
    let mut rig = Rig::new();
    rig.push(&[0x2000_0008, 0, 64, 2, 1, 0, 2, 1, 0xFFFF_1234]);
    rig.finish(1);
    assert_eq!(rig.words(0, 3), [0x1234_0000, 0x0000_1234, 0]);
}
