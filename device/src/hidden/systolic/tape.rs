//! Tapes: pipeline registers of all elements, which move one element a clock.
//!
//! Each register of an array is an array of 32-bit words. On every clock each word goes on to the next
//! element; rather than move all of them, the place that counts as element 0 moves the other way. When it
//! comes to the end of the memory the words are copied back once. So a register that only delays costs
//! nothing, and one that changes is changed where it lies.

use bytemuck::{Pod, Zeroable};

/// Elements that are stepped together.
pub const LANES: usize = 16;

/// A cache line: chunks of a tape never straddle two.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
struct CacheLine([u32; LANES]);

/// Words in whole cache lines.
#[derive(Clone, Debug)]
pub struct Words(Vec<CacheLine>);

impl Words {
    /// `count` zeros, rounded up to whole chunks.
    #[must_use]
    pub fn new(count: usize) -> Words {
        Words(vec![CacheLine([0; LANES]); count.div_ceil(LANES)])
    }

    /// The words.
    #[must_use]
    #[inline(always)]
    pub fn get(&self) -> &[u32] {
        bytemuck::cast_slice(&self.0)
    }

    /// The words.
    #[inline(always)]
    pub fn get_mut(&mut self) -> &mut [u32] {
        bytemuck::cast_slice_mut(&mut self.0)
    }
}

/// `REGISTERS` registers of each element that go to the right; the last of them is CTRL, 0 for a bubble.
///
/// # Invariants
/// Beyond the last element and, within a chunk, before the first, CTRL is 0: lanes there do nothing.
#[derive(Clone, Debug)]
pub struct Tape<const REGISTERS: usize> {
    /// The registers.
    pub registers: [Words; REGISTERS],
    /// Word of element 0.
    pub head: usize,
    elements: usize,
    /// Word of element 0 when the words have just been copied back.
    home: usize,
}

impl<const REGISTERS: usize> Tape<REGISTERS> {
    /// Bubbles for `elements` elements.
    #[must_use]
    pub fn new(elements: usize) -> Self {
        let home = elements.next_multiple_of(LANES).max(1024);
        // The element beyond the last, the rest of its chunk, and one chunk to look ahead into.
        let words = home + elements + 1 + 2 * LANES;
        Tape { registers: std::array::from_fn(|_| Words::new(words)), head: home, elements, home }
    }

    /// All go on by one; what the last element gave is gone, and `input` stands before the first.
    #[inline(always)]
    pub fn shift(&mut self, input: [u32; REGISTERS]) {
        if self.head == 0 {
            for register in &mut self.registers {
                register.get_mut().copy_within(0..=self.elements, self.home);
            }
            self.registers[REGISTERS - 1].get_mut()[..self.home].fill(0);
            self.head = self.home;
        }
        self.head -= 1;
        for (register, input) in self.registers.iter_mut().zip(input) {
            register.get_mut()[self.head] = input;
        }
        self.registers[REGISTERS - 1].get_mut()[self.head + self.elements] = 0;
    }

    /// First word of the first chunk, and the number of chunks that hold all elements.
    #[must_use]
    #[inline(always)]
    pub fn chunks(&self) -> (usize, usize) {
        let first = self.head & !(LANES - 1);
        (first, (self.head + self.elements - first).div_ceil(LANES))
    }

    /// Register `register` of element `element`.
    #[must_use]
    pub fn word(&self, register: usize, element: usize) -> u32 {
        self.registers[register].get()[self.head + element]
    }
}

/// `REGISTERS` registers that stay with their element.
#[derive(Clone, Debug)]
pub struct Fixed<const REGISTERS: usize> {
    registers: [Vec<u32>; REGISTERS],
}

impl<const REGISTERS: usize> Fixed<REGISTERS> {
    /// Zeros for `elements` elements, with room for lanes before the first and beyond the last.
    #[must_use]
    pub fn new(elements: usize) -> Self {
        Fixed { registers: std::array::from_fn(|_| vec![0; elements + 2 * LANES]) }
    }

    /// The registers in chunks of which the first begins `before` elements before element 0.
    #[inline(always)]
    pub fn chunks(&mut self, before: usize) -> [&mut [[u32; LANES]]; REGISTERS] {
        self.registers.each_mut().map(|register| register[LANES - before..].as_chunks_mut().0)
    }

    /// Register `register` of element `element`.
    #[must_use]
    pub fn word(&self, register: usize, element: usize) -> u32 {
        self.registers[register][LANES + element]
    }

    /// Sets it.
    pub fn set(&mut self, register: usize, element: usize, word: u32) {
        self.registers[register][LANES + element] = word;
    }
}
