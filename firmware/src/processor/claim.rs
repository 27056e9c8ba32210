//! Claims: numbers from packets and registers that are not checked yet, with where they stand.

use zga_abi::{Fault, FaultCode, Reg};

/// A number that somebody outside alleges to be right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claim {
    /// The number.
    pub value: u32,
    /// The fault's `word`, should the number be wrong.
    word: u32,
    /// The fault's `value`.
    shown: u32,
}

impl Claim {
    /// Word `word` of the packet.
    pub const fn word(word: u32, value: u32) -> Claim {
        Claim { value, word, shown: value }
    }

    /// The value of a register; a fault shows the register's byte offset.
    pub const fn register(register: Reg, value: u32) -> Claim {
        Claim { value, word: 0, shown: register.offset() }
    }

    /// The same place with another value, for a word of which only some bits count.
    pub const fn meaning(self, value: u32) -> Claim {
        Claim { value, ..self }
    }

    /// The fault for which the number is refused.
    pub const fn refuse(self, code: FaultCode) -> Fault {
        Fault::new(code, self.word, self.shown)
    }

    /// The number, if `holds`; else a BAD_VALUE.
    pub const fn require(self, holds: bool) -> Result<u32, Fault> {
        if holds { Ok(self.value) } else { Err(self.refuse(FaultCode::BadValue)) }
    }

    /// What the number means; a BAD_VALUE when it means nothing.
    pub fn mean<T>(self, meaning: Option<T>) -> Result<T, Fault> {
        meaning.ok_or(self.refuse(FaultCode::BadValue))
    }

    /// The number, if it is a multiple of `alignment`; else a BAD_ALIGNMENT.
    pub const fn multiple_of(self, alignment: u32) -> Result<u32, Fault> {
        if self.value.is_multiple_of(alignment) { Ok(self.value) } else { Err(self.refuse(FaultCode::BadAlignment)) }
    }
}
