//! Traces: every write of a run over a bus, in a file that can be replayed headless.
//!
//! # File format, version 1
//!
//! All numbers are little-endian. `xxh3` is XXH3 with 64 bits and seed 0.
//!
//! | bytes | header |
//! | --- | --- |
//! | 0..8 | `ZGATRACE` |
//! | 8..12 | version, 1 |
//! | 12..16 | video memory of the card in bytes |
//! | 16..24 | xxh3 of bytes 0..16 |
//!
//! Then blocks, each with 16 bytes before its payload:
//!
//! | bytes | block |
//! | --- | --- |
//! | 0..4 | bytes of the records, at most [`BLOCK_BYTES`] |
//! | 4..8 | bytes of the payload: the records, compressed as one LZ4 block |
//! | 8..16 | xxh3 of the block's number (u32, from 0), bytes 0..8, and the payload |
//!
//! The last block has no records and no payload; nothing follows it. A record never lies in two blocks:
//!
//! | first byte | record | fields |
//! | --- | --- | --- |
//! | 1 | a word was written | address u32, value u32 |
//! | 2 | a burst was written | address u32, words u32 (at most [`BURST_WORDS`]), the words |
//! | 3 | a burst of memory was read | address u32, words u32, xxh3 of the words u64 |
//! | 4 | interrupts were waited for | mask u32, lines that came u32 (0 after a timeout) |
//! | 5 | FENCE_SEQUENCE was read | value u32 |
//! | 6 | the bus was marked | words u32 (at most [`MARK_WORDS`]), the words |
//!
//! A mark of five words that begins with [`FRAME_MARK`] says that the burst read last was a frame: width,
//! height, low and high half of its [`crate::frame_hash`].
//!
//! # Why a replay is deterministic
//!
//! A driver synchronises with the card by interrupts and FENCE_SEQUENCE only. Where the recorded run had
//! seen a fence executed the replay waits until it is, where an error or a vertical blank was met it waits
//! for one; what lies between are the same writes in the same order. Reads of other registers change
//! nothing and are not recorded. How many fence interrupts arrive is a matter of timing and is ignored.
//!
//! # Damage
//!
//! Lengths are checked before anything is allocated, checksums before anything is used: a reader never
//! holds more than one block. Every flipped bit and every missing or additional byte is refused with the
//! number of the block and its offset in the file.

mod format;
mod reader;
mod replay;
#[cfg(test)]
mod tests;
mod writer;

pub use format::{BLOCK_BYTES, BURST_WORDS, FRAME_MARK, MARK_WORDS, Record, TraceError, VERSION};
pub(crate) use format::{frame_mark, hash_words};
pub use reader::{TraceInfo, TraceReader, info};
pub use replay::{Difference, FrameReplay, ReplayReport, replay};
pub use writer::TraceWriter;
