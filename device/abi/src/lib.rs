//! Registers, packets, formats, effect bits and counters of the ZGA card, each declared once.
//!
//! Everything that two sides of the bus must agree on stands in this crate and nowhere else:
//! the card decodes from these declarations, the firmware validates against them, the driver
//! encodes with them, and the printed manual (`zga registers`) is their text.
//!
//! | module | declares |
//! | --- | --- |
//! | [`bus`] | the [`Bus`] trait, the address map, the interrupt lines |
//! | [`register`] | what a register declaration is made of |
//! | [`registers`] | every register: name, offset, access, reset value, masks, fields |
//! | [`packet`] | every command packet: opcode, payload words, flags |
//! | [`fault`] | the codes of the error interrupt |
//! | [`format`](mod@format) | pixel and depth formats, depth functions, topologies |
//! | [`light`] | light records in video memory |
//! | [`effect`] | effect bits a draw can call for, units the firmware can power |
//! | [`counter`] | every counter and cycle account |
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bus;
pub mod counter;
pub mod effect;
pub mod fault;
pub mod format;
pub mod light;
pub mod packet;
pub mod register;
pub mod registers;
#[cfg(test)]
mod tests;

pub use bus::Bus;
pub use counter::Counter;
pub use effect::{Effects, Units};
pub use fault::{Fault, FaultCode};
pub use register::{Access, Field, Register};
pub use registers::Reg;

/// Version of this interface as it stands in the REVISION register: major in 31:16, minor in 15:0.
pub const ABI_VERSION: u32 = 0x0001_0000;

/// Value of the IDENTIFICATION register: "ZGA1" in ASCII, first letter in the top byte.
pub const IDENTIFICATION: u32 = 0x5A47_4131;
