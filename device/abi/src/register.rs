//! What a register declaration is made of; the declarations themselves are in [`crate::registers`].

/// Who may do what with a register over the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only: a write is ignored and counted in BUS_READ_ONLY.
    ReadOnly,
    /// Read and written; bits outside the writable mask keep their value.
    ReadWrite,
    /// Reads as 0; a write triggers something.
    WriteOnly,
    /// Reads as status; writing 1 to a bit of the write-1-to-clear mask clears it.
    WriteOneToClear,
}

impl Access {
    /// Short form for the manual.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Access::ReadOnly => "RO",
            Access::ReadWrite => "RW",
            Access::WriteOnly => "WO",
            Access::WriteOneToClear => "W1C",
        }
    }
}

/// A group of bits in a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Highest bit, inclusive.
    pub hi: u32,
    /// Lowest bit.
    pub lo: u32,
    /// Name, lower case.
    pub name: &'static str,
    /// One line: meaning and unit.
    pub doc: &'static str,
}

impl Field {
    /// The bits of the field in place.
    #[must_use]
    pub const fn mask(self) -> u32 {
        (u32::MAX >> (31 - (self.hi - self.lo))) << self.lo
    }
}

/// A register, or a row of `count` registers of the same kind at consecutive words.
#[derive(Clone, Copy, Debug)]
pub struct Register {
    /// Name in the manual, upper case.
    pub name: &'static str,
    /// Byte offset of the first word in the register aperture.
    pub offset: u32,
    /// Number of consecutive words.
    pub count: u32,
    /// Access over the bus.
    pub access: Access,
    /// Values after power-on and after a soft reset: one for all words, or one for each.
    pub reset: &'static [u32],
    /// Bits that a write changes.
    pub writable: u32,
    /// Bits that a write of 1 clears.
    pub write_one_to_clear: u32,
    /// Fields, highest first.
    pub fields: &'static [Field],
    /// Meaning, unit, and what writing it does.
    pub doc: &'static str,
}

impl Register {
    /// Reset value of word `index`.
    #[must_use]
    pub const fn reset_value(&self, index: u32) -> u32 {
        if self.reset.len() == 1 { self.reset[0] } else { self.reset[index as usize] }
    }

    /// Byte offset of word `index`.
    #[must_use]
    pub const fn word_offset(&self, index: u32) -> u32 {
        self.offset + 4 * index
    }
}
