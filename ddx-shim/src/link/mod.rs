//! Link: the live view of a card that works in another process.
//!
//! The card lives in the process of the X server. Whoever wants to see what it puts out, or what it counts, attaches to
//! a Unix socket: [`Server`] is the end at the card, [`Viewer`] the other.
//!
//! ```text
//!   X server's process                                       any process of the same user
//!   +-- card ----+  Monitor   +-- Server ------+   socket   +-- Viewer -----------------+
//!   |  scan-out  |----------->| one thread,    |===========>| frames: newest only       |
//!   |  counters  |<-----------| 16 viewers     |<===========| counters, effects, units  |
//!   +------------+  CardBus   +----------------+  requests  +---------------------------+
//! ```
//!
//! # Protocol
//! Words of 32 bits in the host's order: both ends are on one machine, and a magic number tells if they are not of one
//! mind. A message is a kind, a length in words, and so many words.
//!
//! | message | from | words |
//! | --- | --- | --- |
//! | hello | both, first | magic (2), version; the server adds its process, and registers 0 to 6 of the card |
//! | next frame | viewer | none: asks for the newest frame once it differs from the one sent last |
//! | status | viewer | none: asks for counters, effects and units |
//! | frame | server | width, height, number (low, high), then XRGB8888 pixels, dense rows from the top |
//! | status | server | EFFECTS_CALLED, UNITS_POWERED, how many counters; of each length of its name, name, value (low, high) |
//! | refused | server | a text, after which it hangs up |
//!
//! # What cannot happen
//! A viewer gets a frame for each request, so never more than one is on its way to it: a slow viewer misses frames and
//! nobody waits for it. The server writes what a socket takes and goes on; a viewer that takes nothing for
//! [`STALL_LIMIT`] is dropped, as is one that says something that is not a request. Of each viewer it keeps one frame,
//! shared with the card's own. Without a viewer its thread sleeps and no frame is composed.

mod error;
mod incoming;
mod message;
mod place;
mod seat;
mod server;
mod status;
mod viewer;

pub use error::LinkError;
pub use message::VERSION;
pub use place::{folder, living, socket_path};
pub use seat::STALL_LIMIT;
pub use server::{MOST_VIEWERS, Server};
pub use status::Status;
pub use viewer::{Picture, Viewer};

#[cfg(test)]
mod tests;
