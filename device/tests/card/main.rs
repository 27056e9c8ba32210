//! Register-level tests of the card. Addresses, offsets, codes and headers are restated from the
//! manual as numbers; nothing is imported from the declarations they are made from.

mod bitmap;
mod clears;
mod concurrency;
mod counters;
mod drawing;
mod errors;
mod fifo;
mod interrupts;
mod registers;
mod rig;
mod ring;
mod scanout;
mod snapshot;
