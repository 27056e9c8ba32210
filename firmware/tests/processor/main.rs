//! The command processor against a card that writes down what it is told.
//!
//! Offsets, opcodes and codes are restated here from the manual.

mod bench;
mod bitmap;
mod compose;
mod display;
mod draw;
mod effects;
mod header;
mod invariants;
mod lists;
mod mock;
mod power;
mod random;
mod register_write;
mod scene;
mod state;
