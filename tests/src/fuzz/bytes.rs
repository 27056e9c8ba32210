//! Bytes as a source of choices: the same bytes always give the same choices.
//!
//! A fuzzer changes bytes, so each choice takes few of them and a run never fails for want of more:
//! behind the end everything is 0, which stands for the plainest choice.

/// Words that break things: ends of ranges, signs, alignments, register offsets, floats without a value.
const EDGES: [u32; 24] = [
    0,
    1,
    2,
    3,
    4,
    63,
    64,
    255,
    256,
    4095,
    4096,
    0x3FFF,
    0x4000,
    0x7FFF,
    0xFFFF,
    0x0001_0000,
    0x000F_FFFF,
    0x0010_0000,
    0x7F80_0000,
    0x7FFF_FFFF,
    0x8000_0000,
    0xFF80_0000,
    0xFFFF_FFFC,
    0xFFFF_FFFF,
];

/// Numbers that break things, as f32: no value, no end, hardly anything, the guard band.
const FLOATS: [f32; 20] = [
    0.0,
    -0.0,
    0.5,
    1.0,
    -1.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-42,
    1e-30,
    1e30,
    32_768.0,
    -32_768.5,
    40_960.0,
    16_384.0,
    8_388_608.0,
    1.000_000_1,
];

/// Bytes that are used up from the front.
#[derive(Clone, Debug)]
pub struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    /// Choices from these bytes.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Bytes<'a> {
        Bytes { rest: bytes }
    }

    /// All bytes are used up.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        match self.rest.split_first() {
            Some((&byte, rest)) => {
                self.rest = rest;
                byte
            }
            None => 0,
        }
    }

    /// A word of any value: four bytes, least first.
    pub fn raw(&mut self) -> u32 {
        u32::from_le_bytes([(); 4].map(|()| self.byte()))
    }

    /// A number below `end`, 0 if `end` is 0; takes as many bytes as it needs.
    pub fn below(&mut self, end: u32) -> u32 {
        let number = match end {
            0..=1 => return 0,
            2..=0x100 => u32::from(self.byte()),
            0x101..=0x1_0000 => u32::from(u16::from_le_bytes([self.byte(), self.byte()])),
            _ => self.raw(),
        };
        number % end
    }

    /// True for `of_256` of 256 values of a byte, never for 0 unless all are.
    pub fn chance(&mut self, of_256: u32) -> bool {
        u32::from(self.byte()) + of_256 >= 256
    }

    /// One of `choices`; the default if there is none.
    pub fn pick<T: Copy + Default>(&mut self, choices: &[T]) -> T {
        let index = self.below(choices.len() as u32) as usize;
        choices.get(index).copied().unwrap_or_default()
    }

    /// A word that is often at the edge of something.
    pub fn word(&mut self) -> u32 {
        match self.byte() % 8 {
            0 | 1 => self.pick(&EDGES),
            2 => self.below(256),
            3 => 1 << self.below(32),
            4 => (1_u32 << self.below(32)).wrapping_sub(1),
            5 => self.raw() & !63,
            6 => self.pick(&EDGES).wrapping_add(self.below(9)).wrapping_sub(4),
            _ => self.raw(),
        }
    }

    /// The bits of an f32 that is often no ordinary number.
    pub fn odd_float(&mut self) -> u32 {
        if self.chance(128) { self.raw() } else { self.pick(&FLOATS).to_bits() }
    }

    /// The bits of an f32 in -`range`..`range` in steps of 1/16, seldom an odd one.
    pub fn coordinate(&mut self, range: u32) -> u32 {
        match self.byte() {
            0..8 => self.odd_float(),
            8..200 => (self.below(16 * range.max(1)) as f32 / 16.0).to_bits(),
            _ => (self.below(32 * range.max(1)) as f32 / 16.0 - range as f32).to_bits(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_behind_the_end_are_the_plainest() {
        let mut bytes = Bytes::new(&[]);
        assert!(bytes.is_empty());
        assert_eq!((bytes.byte(), bytes.raw(), bytes.below(1000), bytes.word()), (0, 0, 0, 0));
        assert!(!bytes.chance(255));
        assert!(bytes.chance(256));
    }

    #[test]
    fn below_takes_no_more_bytes_than_it_needs() {
        let mut bytes = Bytes::new(&[7, 1, 1, 9]);
        assert_eq!(bytes.below(5), 2);
        assert_eq!(bytes.below(300), 257);
        assert_eq!(bytes.below(1), 0);
        assert_eq!(bytes.byte(), 9);
    }
}
