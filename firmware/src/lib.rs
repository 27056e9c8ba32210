//! The program of the ZGA card's command processor.
//!
//! Packets are allegations: [`Processor::execute`] checks a packet's length, addresses and states
//! once, turns it into the types of [`checked`], and only then tells the card's units what to do,
//! through the [`Hardware`] trait. What does not hold is a [`zga_abi::Fault`] with the word at fault.
//!
//! The firmware also decides what is powered: it ORs the effects of a scene's draws and powers the
//! units they need, each when it is first called for.
//!
//! No allocation, no `std`, no `unsafe`: it would run on the processor of a real board.
#![no_std]
#![forbid(unsafe_code)]

pub mod checked;
pub mod hardware;
mod processor;

pub use hardware::{Hardware, Stopped};
pub use processor::{Processor, ProcessorState};
