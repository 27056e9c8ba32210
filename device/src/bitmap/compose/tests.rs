//! The fast way against the specification, at every level of host instructions; figures by hand.

use super::*;
use crate::Kernel;
use zga_abi::format::{ComposeOperator, PictureFormat};
use zga_abi::packet::compose::Transform;
use zga_abi::packet::{compose as words, list};
use zga_firmware::checked::{Image, Sampled};

struct Random(u64);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as u32
    }

    fn below(&mut self, end: u32) -> u32 {
        self.next() % end
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u32) as usize]
    }

    /// Ends of the range are as likely as what lies between.
    fn level(&mut self) -> u32 {
        let between = self.below(256);
        self.pick(&[0, 255, between, between])
    }

    fn argb(&mut self) -> u32 {
        (0..4).fold(0, |word, _| word << 8 | self.level())
    }

    fn picture(&mut self, base: u32) -> Picture {
        let format = self.pick(PictureFormat::ALL);
        let [width, height] = [1 + self.below(40), 1 + self.below(12)];
        let pitch = (width + self.below(5)) * format.bytes();
        let base = base + self.below(4) * format.bytes();
        Picture { image: Image { base, pitch, width, height, format: format.layout() }, format }
    }

    fn paint(&mut self, base: u32) -> Paint {
        if self.below(4) == 0 {
            return Paint::Colour(self.argb());
        }
        let offset = [(); 2].map(|()| self.below(41) as i32 - 20);
        let number = |random: &mut Random| {
            let small = random.below(1 << 18) as i32 - (1 << 17);
            let any = random.next() as i32;
            random.pick(&[0, 1 << 16, -(1 << 16), small, small, any])
        };
        let transform = (self.below(3) == 0).then(|| {
            let [xx, xy, x0, yx, yy, y0] = [(); 6].map(|()| number(self));
            Transform { xx, xy, x0, yx, yy, y0 }
        });
        Paint::Picture(Sampled { picture: self.picture(base), offset, repeat: self.pick(Repeat::ALL), transform })
    }
}

/// What a composition makes of memory and account.
fn outcome(kernel: Kernel, memory: &[u32], compose: &Compose<'_>) -> (Vec<u32>, Vec<u64>) {
    let (mut memory, mut account) = (memory.to_vec(), Account::default());
    Bitmap::new(kernel).compose(&mut memory, compose, &mut account);
    let counters = [Counter::BitmapEntries, Counter::BitmapComposed, Counter::BitmapPixels, Counter::CyclesBitmap];
    (memory, counters.map(|counter| account.get(counter)).to_vec())
}

#[test]
fn compose_every_kernel_is_the_specification() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut changed = 0;
    for trial in 0..20_000 {
        let memory: Vec<u32> = (0..3 * 1024).map(|_| random.argb()).collect();
        let operator = ComposeOperator::ALL[trial % ComposeOperator::ALL.len()];
        if operator == ComposeOperator::Destination {
            continue;
        }
        let (onto, source) = (random.picture(0), random.paint(4096));
        let mask = match random.below(4) {
            0 => Mask::None,
            1 => Mask::Inline(random.pick(&[PictureFormat::Alpha8, PictureFormat::Argb8888])),
            _ => Mask::Paint(random.paint(8192)),
        };
        let components = mask != Mask::None && random.below(2) == 0;
        let mut entries = Vec::new();
        for _ in 0..random.below(3) + 1 {
            let [x, y] = [random.below(50) as i16 - 10, random.below(18) as i16 - 6];
            let [width, height] = [random.below(60), random.below(10)];
            entries.extend([list::pair(x as u16, y as u16), list::pair(width as u16, height as u16)]);
            if let Mask::Inline(format) = mask {
                entries.extend((0..words::row_words(width, format.bytes()) * height).map(|_| random.argb()));
            }
        }
        let clips = [0, list::pair(25, 7), list::pair(30, 2), list::pair(100, 100)];
        let origin = [random.below(5) as i32 - 2, random.below(5) as i32 - 2];
        let compose = Compose { onto, operator, components, source, mask, origin, clips: &clips, entries: &entries };
        let expected = outcome(Kernel::Specification, &memory, &compose);
        changed += usize::from(expected.0 != memory);
        for kernel in Kernel::available() {
            assert_eq!(outcome(kernel, &memory, &compose), expected, "{kernel:?} {compose:?}");
        }
    }
    // The others lie outside, are empty or leave things as they are.
    assert!(changed > 6_000, "{changed} compositions changed a pixel");
}

/// One pixel, source over destination through a mask, of a colour.
fn pixel(operator: ComposeOperator, source: u32, mask: Option<(u32, bool)>, there: u32) -> u32 {
    let format = PictureFormat::Argb8888;
    let image = Image { base: 0, pitch: 4, width: 1, height: 1, format: format.layout() };
    let through = mask.map_or(Mask::None, |(argb, _)| Mask::Paint(Paint::Colour(argb)));
    let compose = Compose {
        onto: Picture { image, format },
        operator,
        components: mask.is_some_and(|(_, components)| components),
        source: Paint::Colour(source),
        mask: through,
        origin: [0, 0],
        clips: &[0, 0x0001_0001],
        entries: &[0, 0x0001_0001],
    };
    outcome(Kernel::Best, &[there], &compose).0[0]
}

#[test]
fn compose_pixels_by_hand() {
    use ComposeOperator::{Add, Atop, Clear, In, Over, Source, Xor};
    assert_eq!(pixel(Clear, 0xFFFF_FFFF, None, 0x1234_5678), 0);
    // 0x80 + 0xFF * 0x7F / 255 = 0xFF; 0x40 + 0x80 * 0x7F / 255 = 0x40 + 0x40 (63.75) = 0x80.
    assert_eq!(pixel(Over, 0x8040_4040, None, 0xFF80_8080), 0xFF80_8080);
    assert_eq!(pixel(Add, 0x8040_F001, None, 0x9020_20FF), 0xFF60_FFFF);
    // Through a mask of a half: 0xFF * 0x80 / 255 = 0x80, then 0x80 + 0x64 * 0x7F / 255 (49.8) = 0x80 + 0x32.
    assert_eq!(pixel(Over, 0xFFFF_FFFF, Some((0x8000_0000, false)), 0xFF64_6464), 0xFFB2_B2B2);
    // By components: blue alone is let through.
    assert_eq!(pixel(Over, 0xFFFF_FFFF, Some((0x0000_00FF, true)), 0xFF64_6464), 0xFF64_64FF);
    assert_eq!(pixel(Source, 0x8040_2010, Some((0x80FF_0080, true)), 0xFF64_6464), 0x4040_0008);
    // 0x80 of 0x80 is 0x40 (64.25), and 0x40 * 0x80 / 255 = 0x20 (32.1).
    assert_eq!(pixel(In, 0x8040_2010, None, 0x8000_0000), 0x4020_1008);
    // Atop: s D + d (1 - S): 0x20 + 0x10 * 0x7F / 255 (7.97).
    assert_eq!(pixel(Atop, 0x8040_4040, None, 0x8010_1010), 0x8028_2828);
    // Xor: s (1 - D) + d (1 - S): 0x80 * 0x7F / 255 twice (63.75) = 0x80.
    assert_eq!(pixel(Xor, 0x8080_8080, None, 0x8080_8080), 0x8080_8080);
}

#[test]
fn compose_clocks_are_lines_or_fetched_pixels() {
    let picture = |base, width| {
        let format = PictureFormat::Argb8888;
        Picture { image: Image { base, pitch: 256, width, height: 4, format: format.layout() }, format }
    };
    let source =
        |repeat| Paint::Picture(Sampled { picture: picture(1024, 16), offset: [0, 0], repeat, transform: None });
    let clocks = |operator, source| {
        let compose = Compose {
            onto: picture(0, 32),
            operator,
            components: false,
            source,
            mask: Mask::None,
            origin: [0, 0],
            clips: &[0, 0x0010_0100],
            entries: &[0, 0x0004_0020],
        };
        outcome(Kernel::Best, &[0; 1024], &compose).1[3]
    };
    // Four rows of two lines are written; over reads them as well.
    assert_eq!(clocks(ComposeOperator::Source, Paint::Colour(1)), 8);
    assert_eq!(clocks(ComposeOperator::Over, Paint::Colour(1)), 16);
    // Half of the pixels have a source, a line in each row; repeated, each pixel is fetched.
    assert_eq!(clocks(ComposeOperator::Over, source(Repeat::None)), 16 + 4);
    assert_eq!(clocks(ComposeOperator::Over, source(Repeat::Normal)), 16 + 128);
    assert_eq!(clocks(ComposeOperator::Clear, source(Repeat::Normal)), 8);
}
