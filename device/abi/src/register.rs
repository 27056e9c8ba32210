//! What a register declaration is made of, and how registers are found; the declarations themselves are in [`crate::registers`].

use crate::registers::{REGISTERS, Reg};

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

// Declares registers: their names as `Reg`, their declarations as `REGISTERS`.
macro_rules! registers {
    ($(
        $(#[doc = $doc:literal])+
        $id:ident $name:literal @ $offset:literal [$count:literal] $access:ident
        reset $reset:expr, writable $writable:expr, w1c $w1c:expr,
        { $($hi:literal : $lo:literal $field:literal $fdoc:literal;)* }
    )+) => {
        /// Names of all registers; [`Reg::info`] gives the declaration.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u16)]
        pub enum Reg { $( $(#[doc = $doc])+ $id, )+ }

        /// Every register, in rising order of offset.
        pub static REGISTERS: &[Register] = &[ $( Register {
            name: $name, offset: $offset, count: $count, access: Access::$access,
            reset: $reset, writable: $writable, write_one_to_clear: $w1c,
            fields: &[ $( Field { hi: $hi, lo: $lo, name: $field, doc: $fdoc }, )* ],
            doc: concat!($($doc),+),
        }, )+ ];

        impl Reg {
            /// Every name, in rising order of offset.
            pub const ALL: &'static [Reg] = &[ $( Reg::$id, )+ ];

            /// Byte offset of the register's first word.
            #[must_use]
            pub const fn offset(self) -> u32 {
                match self { $( Reg::$id => $offset, )+ }
            }
        }
    };
}

pub(crate) use registers;

impl Reg {
    /// The declaration of this register.
    #[must_use]
    pub fn info(self) -> &'static Register {
        &REGISTERS[self as usize]
    }

    /// The register that owns the word at byte `offset` of the aperture, and which of its words it is.
    #[must_use]
    pub fn at(offset: u32) -> Option<(Reg, u32)> {
        let owner = usize::from(*OWNERS.get(offset as usize / 4)?);
        let reg = *Reg::ALL.get(owner)?;
        offset.is_multiple_of(4).then(|| (reg, (offset - reg.offset()) / 4))
    }
}

/// For each word of the aperture the number of the register that owns it; [`u16::MAX`] is nobody.
///
/// A table, since the card and its firmware look up every word of a register write.
static OWNERS: [u16; crate::bus::REGISTERS_BYTES as usize / 4] = {
    let mut owners = [u16::MAX; crate::bus::REGISTERS_BYTES as usize / 4];
    let mut number = 0;
    while number < REGISTERS.len() {
        let (first, count) = (REGISTERS[number].offset as usize / 4, REGISTERS[number].count as usize);
        let mut word = first;
        while word < first + count {
            owners[word] = number as u16;
            word += 1;
        }
        number += 1;
    }
    owners
};
