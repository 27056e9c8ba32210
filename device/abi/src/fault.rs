//! Faults: why the command processor refuses a packet. They stand in the ERROR_* registers.

macro_rules! faults {
    ($( $(#[doc = $doc:literal])+ $id:ident = $code:literal $name:literal, )+) => {
        /// Why a packet was refused; the value of ERROR_CODE.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum FaultCode { $( $(#[doc = $doc])+ $id = $code, )+ }

        impl FaultCode {
            /// Every code, rising.
            pub const ALL: &'static [FaultCode] = &[ $( FaultCode::$id, )+ ];

            /// The fault with this code, if there is one.
            #[must_use]
            pub const fn from_code(code: u32) -> Option<FaultCode> {
                match code { $( $code => Some(FaultCode::$id), )+ _ => None }
            }

            /// The name in manual and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $( FaultCode::$id => $name, )+ }
            }

            /// One line: what was wrong.
            #[must_use]
            pub const fn doc(self) -> &'static str {
                match self { $( FaultCode::$id => concat!($($doc),+), )+ }
            }
        }
    };
}

faults! {
    /// No packet has this opcode.
    UnknownOpcode = 1 "UNKNOWN_OPCODE",
    /// Bits 23:20 of the header are not 0.
    ReservedBits = 2 "RESERVED_BITS",
    /// The packet has too few or too many payload words for its opcode and contents.
    BadLength = 3 "BAD_LENGTH",
    /// The packet goes on beyond RING_PUT, or is longer than the ring.
    Truncated = 4 "TRUNCATED",
    /// The ring's base, size or put pointer is not valid.
    BadRing = 5 "BAD_RING",
    /// No register at this offset, or one that packets may not write.
    BadRegister = 6 "BAD_REGISTER",
    /// A register or field holds a value that has no meaning.
    BadValue = 7 "BAD_VALUE",
    /// An address range does not lie in video memory.
    OutOfMemory = 8 "OUT_OF_MEMORY",
    /// An address, pitch or size does not have the alignment it needs.
    BadAlignment = 9 "BAD_ALIGNMENT",
    /// The packet is only valid between begin scene and end scene.
    OutsideScene = 10 "OUTSIDE_SCENE",
    /// The packet is not valid between begin scene and end scene.
    InsideScene = 11 "INSIDE_SCENE",
    /// An index names a vertex that is not there.
    BadIndex = 12 "BAD_INDEX",
    /// The card has no unit for this effect, path or format.
    Unsupported = 13 "UNSUPPORTED",
    /// The packet took longer than WATCHDOG allows.
    Watchdog = 14 "WATCHDOG",
    /// Surfaces that must lie apart overlap.
    Overlap = 15 "OVERLAP",
    /// A unit that holds a scene back (a clocked path, the sub-pixel unit) has no room for more primitives in it.
    SceneFull = 16 "SCENE_FULL",
}

/// A refused packet: the reason, and where in the packet it is.
///
/// Registers can be written at any time with any value, so they are checked when a packet samples
/// them. Where such a register is at fault (BAD_VALUE, OUT_OF_MEMORY, BAD_ALIGNMENT, OVERLAP or
/// UNSUPPORTED), `word` is 0 and `value` is the register's byte offset. With any other code, word 0
/// is the header itself and `value` the header; WATCHDOG and SCENE_FULL have no place in the
/// packet: both are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Why.
    pub code: FaultCode,
    /// Which word of the packet is at fault; 0 is the header, or a register that was sampled.
    pub word: u32,
    /// The value found there, or the value derived from it that broke the rule; the byte offset of
    /// a register that was sampled.
    pub value: u32,
}

impl Fault {
    /// A fault at word `word` of the packet, where `value` was found.
    #[must_use]
    pub const fn new(code: FaultCode, word: u32, value: u32) -> Fault {
        Fault { code, word, value }
    }
}

impl core::fmt::Display for Fault {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Fault { code, word, value } = self;
        write!(f, "{} at word {word} of the packet (found {value:#010x}): {}", code.name(), code.doc().trim())
    }
}
