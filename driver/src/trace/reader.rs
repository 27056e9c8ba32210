//! Reading a trace: one block at a time, checked before it is used.

use std::io::{ErrorKind, Read};

use xxhash_rust::xxh3::xxh3_64;

use super::format::{
    BLOCK_BYTES, BLOCK_HEADER_BYTES, FRAME_MARK, HEADER_BYTES, MAGIC, Record, TraceError, VERSION, block_hash, decode,
};
use crate::hash_text;

/// Reads the records of a trace in order.
#[derive(Debug)]
pub struct TraceReader<R: Read> {
    from: R,
    video_memory: u32,
    records: Vec<u8>,
    /// Bytes of `records` that are taken.
    taken: usize,
    /// Number of the block that comes next, and where it begins.
    block: u32,
    offset: u64,
    /// Where the block in `records` begins.
    block_offset: u64,
    ended: bool,
    words: Vec<u32>,
}

impl<R: Read> TraceReader<R> {
    /// Reads and checks the header.
    ///
    /// # Errors
    /// [`TraceError::NotATrace`], [`TraceError::UnknownVersion`], [`TraceError::Damaged`], [`TraceError::Io`].
    pub fn new(mut from: R) -> Result<TraceReader<R>, TraceError> {
        let mut header = [0; HEADER_BYTES];
        let found = fill(&mut from, &mut header, 0)?;
        let (magic, rest) = header.split_first_chunk::<8>().unwrap_or((&MAGIC, &[]));
        if *magic != MAGIC {
            return Err(TraceError::NotATrace { found: *magic });
        }
        let damaged = |what| TraceError::Damaged { block: 0, offset: 0, what };
        if found < HEADER_BYTES {
            return Err(damaged("the header is cut short"));
        }
        let version = word(rest, 0);
        if version != VERSION {
            return Err(TraceError::UnknownVersion { found: version });
        }
        if xxh3_64(&header[..16]).to_le_bytes() != header[16..] {
            return Err(damaged("the header's checksum does not match"));
        }
        Ok(TraceReader {
            from,
            video_memory: word(rest, 4),
            records: Vec::new(),
            taken: 0,
            block: 0,
            offset: HEADER_BYTES as u64,
            block_offset: 0,
            ended: false,
            words: Vec::new(),
        })
    }

    /// Video memory of the card that the trace was recorded on, in bytes.
    pub const fn video_memory(&self) -> u32 {
        self.video_memory
    }

    /// Blocks read so far.
    pub const fn blocks(&self) -> u32 {
        self.block
    }

    /// Bytes read so far.
    pub const fn offset(&self) -> u64 {
        self.offset
    }

    /// The next record; `None` at the end of a whole trace.
    ///
    /// # Errors
    /// [`TraceError::Damaged`] with the block and its place, [`TraceError::Io`].
    pub fn next_record(&mut self) -> Result<Option<Record<'_>>, TraceError> {
        while self.taken == self.records.len() {
            if self.ended || !self.next_block()? {
                return Ok(None);
            }
        }
        let mut rest = &self.records[self.taken..];
        let (block, offset) = (self.block - 1, self.block_offset);
        let record = decode(&mut rest, &mut self.words).map_err(|what| TraceError::Damaged { block, offset, what })?;
        self.taken = self.records.len() - rest.len();
        Ok(Some(record))
    }

    /// Reads the next block; false if it was the last.
    fn next_block(&mut self) -> Result<bool, TraceError> {
        let (block, offset) = (self.block, self.offset);
        let damaged = |what| TraceError::Damaged { block, offset, what };
        let mut header = [0; BLOCK_HEADER_BYTES];
        if fill(&mut self.from, &mut header, offset)? < BLOCK_HEADER_BYTES {
            return Err(damaged("the file is cut short"));
        }
        let lengths = [word(&header, 0), word(&header, 4)];
        let hash = u64::from(word(&header, 8)) | u64::from(word(&header, 12)) << 32;
        let [raw, packed] = lengths.map(|length| length as usize);
        if raw > BLOCK_BYTES || packed > lz4_flex::block::get_maximum_output_size(BLOCK_BYTES) {
            return Err(damaged("the block is larger than blocks can be"));
        }
        let mut payload = vec![0; packed];
        if fill(&mut self.from, &mut payload, offset)? < packed {
            return Err(damaged("the file is cut short"));
        }
        if block_hash(block, lengths, &payload) != hash {
            return Err(damaged("the block's checksum does not match"));
        }
        self.offset += (BLOCK_HEADER_BYTES + packed) as u64;
        self.block_offset = offset;
        self.taken = 0;
        self.records.clear();
        if lengths == [0, 0] {
            self.ended = true;
            if fill(&mut self.from, &mut [0], self.offset)? != 0 {
                return Err(damaged("something follows the end"));
            }
            return Ok(false);
        }
        self.block += 1;
        self.records = lz4_flex::block::decompress(&payload, raw).map_err(|_| damaged("the block does not unpack"))?;
        if raw == 0 || self.records.len() != raw {
            return Err(damaged("the block's length does not match"));
        }
        Ok(true)
    }
}

/// The little-endian word at byte `at`; 0 beyond the end.
fn word(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..).and_then(|rest| rest.first_chunk()).map_or(0, |chunk| u32::from_le_bytes(*chunk))
}

/// Reads until `to` is full or the file ends; tells how many bytes there were.
fn fill(from: &mut impl Read, to: &mut [u8], offset: u64) -> Result<usize, TraceError> {
    let mut filled = 0;
    while filled < to.len() {
        match from.read(&mut to[filled..]) {
            Ok(0) => break,
            Ok(count) => filled += count,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(source) => return Err(TraceError::Io { offset: offset + filled as u64, source }),
        }
    }
    Ok(filled)
}

/// What a trace holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TraceInfo {
    /// Video memory of the card, bytes.
    pub video_memory: u32,
    /// Blocks with records.
    pub blocks: u32,
    /// Bytes of the file.
    pub file_bytes: u64,
    /// Records.
    pub records: u64,
    /// Words written, single and in bursts.
    pub words_written: u64,
    /// Words read in bursts.
    pub words_read: u64,
    /// Fences seen to be executed.
    pub fences: u64,
    /// Hashes of the frames, in order, as [`crate::Frame::hash`] shows them.
    pub frames: Vec<String>,
}

/// Reads a whole trace, checks it, and tells what it holds.
///
/// # Errors
/// As [`TraceReader::new`] and [`TraceReader::next_record`].
pub fn info(from: impl Read) -> Result<TraceInfo, TraceError> {
    let mut reader = TraceReader::new(from)?;
    let mut info = TraceInfo { video_memory: reader.video_memory(), ..TraceInfo::default() };
    while let Some(record) = reader.next_record()? {
        info.records += 1;
        match record {
            Record::Write { .. } => info.words_written += 1,
            Record::WriteBurst { words, .. } => info.words_written += words.len() as u64,
            Record::ReadBurst { words, .. } => info.words_read += u64::from(words),
            Record::FenceReached { .. } => info.fences += 1,
            Record::Mark { words: &[FRAME_MARK, _, _, low, high] } => {
                info.frames.push(hash_text(u64::from(low) | u64::from(high) << 32));
            }
            Record::WaitInterrupt { .. } | Record::Mark { .. } => {}
        }
    }
    (info.blocks, info.file_bytes) = (reader.blocks(), reader.offset());
    Ok(info)
}
