//! Records as bytes, and what can be wrong with a trace.

use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use crate::Frame;

/// First bytes of a trace.
pub(super) const MAGIC: [u8; 8] = *b"ZGATRACE";
/// Version of the format.
pub const VERSION: u32 = 1;
/// Bytes of the file header.
pub(super) const HEADER_BYTES: usize = 24;
/// Bytes before the payload of a block.
pub(super) const BLOCK_HEADER_BYTES: usize = 16;
/// Most bytes of records in a block.
pub const BLOCK_BYTES: usize = 1 << 20;
/// Most words of one burst record; longer bursts become several.
pub const BURST_WORDS: usize = 1 << 16;
/// Most words of a mark.
pub const MARK_WORDS: usize = 16;
/// First word of the mark after the burst that read a frame: "FRAM".
pub const FRAME_MARK: u32 = u32::from_be_bytes(*b"FRAM");

/// One thing that happened on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record<'a> {
    /// A word was written.
    Write {
        /// Bus address.
        address: u32,
        /// The word.
        value: u32,
    },
    /// A burst was written.
    WriteBurst {
        /// Bus address of the first word.
        address: u32,
        /// The words.
        words: &'a [u32],
    },
    /// A burst of memory was read.
    ReadBurst {
        /// Bus address of the first word.
        address: u32,
        /// How many.
        words: u32,
        /// XXH3 of them.
        hash: u64,
    },
    /// Interrupts were waited for.
    WaitInterrupt {
        /// Lines waited for.
        mask: u32,
        /// Lines that came; 0 after a timeout.
        lines: u32,
    },
    /// FENCE_SEQUENCE was read.
    FenceReached {
        /// Its value.
        sequence: u32,
    },
    /// The bus was marked.
    Mark {
        /// The note; at most [`MARK_WORDS`] words.
        words: &'a [u32],
    },
}

/// What is wrong with a trace, or with its replay.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// The file could not be read or written.
    #[error("trace, offset {offset}: {source}")]
    Io {
        /// Bytes of the file before it.
        offset: u64,
        /// Why.
        source: std::io::Error,
    },
    /// The file does not begin as a trace does.
    #[error("not a ZGA trace: the file begins with {found:02x?}")]
    NotATrace {
        /// The first bytes.
        found: [u8; 8],
    },
    /// The file is of a version that is not known.
    #[error("trace of version {found}, expected {VERSION}")]
    UnknownVersion {
        /// Its version.
        found: u32,
    },
    /// The file is damaged.
    #[error("trace is damaged in block {block} at offset {offset}: {what}")]
    Damaged {
        /// Number of the block, from 0; the header counts as block 0.
        block: u32,
        /// Where the block begins in the file.
        offset: u64,
        /// What does not hold.
        what: &'static str,
    },
    /// The trace was recorded on another card.
    #[error("recorded with {recorded} bytes of video memory, this card has {found}")]
    OtherCard {
        /// Bytes of the card it was recorded on.
        recorded: u32,
        /// Bytes of this card.
        found: u32,
    },
    /// A read does not lie in the card's memory.
    #[error("record {record}: {words} words at {address:#010x} do not lie in a memory window")]
    BadRead {
        /// Number of the record, from 0.
        record: u64,
        /// Bus address.
        address: u32,
        /// Words.
        words: u32,
    },
    /// The replay waited in vain.
    #[error("record {record}: {what} did not come")]
    Stalled {
        /// Number of the record, from 0.
        record: u64,
        /// What it waited for.
        what: String,
    },
}

/// XXH3 of words as little-endian bytes.
pub(crate) fn hash_words(words: &[u32]) -> u64 {
    if cfg!(target_endian = "little") {
        return xxh3_64(bytemuck::cast_slice(words));
    }
    let mut hash = Xxh3::new();
    for word in words {
        hash.update(&word.to_le_bytes());
    }
    hash.digest()
}

/// Checksum of a block.
pub(super) fn block_hash(number: u32, lengths: [u32; 2], payload: &[u8]) -> u64 {
    let mut hash = Xxh3::new();
    for word in [number, lengths[0], lengths[1]] {
        hash.update(&word.to_le_bytes());
    }
    hash.update(payload);
    hash.digest()
}

/// The mark that says: the burst read last was this frame.
pub(crate) fn frame_mark(frame: &Frame) -> [u32; 5] {
    let hash = crate::frame_hash(frame.width, frame.height, &frame.pixels);
    [FRAME_MARK, frame.width, frame.height, hash as u32, (hash >> 32) as u32]
}

/// Appends a record. Words beyond the most a record holds are not for it: see the callers.
pub(super) fn encode(record: &Record<'_>, to: &mut Vec<u8>) {
    let mut put = |kind: u8, fields: &[u32], words: &[u32]| {
        to.push(kind);
        to.extend(fields.iter().chain(words).flat_map(|word| word.to_le_bytes()));
    };
    match *record {
        Record::Write { address, value } => put(1, &[address, value], &[]),
        Record::WriteBurst { address, words } => put(2, &[address, words.len() as u32], words),
        Record::ReadBurst { address, words, hash } => put(3, &[address, words, hash as u32, (hash >> 32) as u32], &[]),
        Record::WaitInterrupt { mask, lines } => put(4, &[mask, lines], &[]),
        Record::FenceReached { sequence } => put(5, &[sequence], &[]),
        Record::Mark { words } => put(6, &[words.len() as u32], words),
    }
}

/// Takes the record at the front of `bytes`; words go to `words`.
pub(super) fn decode<'w>(bytes: &mut &[u8], words: &'w mut Vec<u32>) -> Result<Record<'w>, &'static str> {
    words.clear();
    let (&kind, rest) = bytes.split_first().ok_or("a record is missing")?;
    *bytes = rest;
    match kind {
        1 => Ok(Record::Write { address: word(bytes)?, value: word(bytes)? }),
        2 => {
            let (address, count) = (word(bytes)?, word(bytes)? as usize);
            take(bytes, count, BURST_WORDS, words)?;
            Ok(Record::WriteBurst { address, words })
        }
        3 => {
            let (address, count) = (word(bytes)?, word(bytes)?);
            let hash = u64::from(word(bytes)?) | u64::from(word(bytes)?) << 32;
            Ok(Record::ReadBurst { address, words: count, hash })
        }
        4 => Ok(Record::WaitInterrupt { mask: word(bytes)?, lines: word(bytes)? }),
        5 => Ok(Record::FenceReached { sequence: word(bytes)? }),
        6 => {
            let count = word(bytes)? as usize;
            take(bytes, count, MARK_WORDS, words)?;
            Ok(Record::Mark { words })
        }
        _ => Err("a record of unknown kind"),
    }
}

fn word(bytes: &mut &[u8]) -> Result<u32, &'static str> {
    let (first, rest) = bytes.split_first_chunk().ok_or("a record is cut short")?;
    *bytes = rest;
    Ok(u32::from_le_bytes(*first))
}

fn take(bytes: &mut &[u8], count: usize, most: usize, words: &mut Vec<u32>) -> Result<(), &'static str> {
    if count > most {
        return Err("a record has too many words");
    }
    let (run, rest) = bytes.split_at_checked(4 * count).ok_or("a record is cut short")?;
    *bytes = rest;
    words.extend(run.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    Ok(())
}
