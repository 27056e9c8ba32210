//! Fill, copy, upload, download against a model that moves one pixel at a time.

use crate::rig::*;
use proptest::prelude::*;
use zga_abi::Bus;

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
