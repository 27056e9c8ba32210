//! Writing a trace: records are gathered and go out in compressed blocks.

use std::io::Write;

use xxhash_rust::xxh3::xxh3_64;

use super::format::{BLOCK_BYTES, BURST_WORDS, MAGIC, MARK_WORDS, Record, TraceError, VERSION, block_hash, encode};

/// A block goes out when its records have grown to this: with the largest record it still fits.
const FLUSH_BYTES: usize = BLOCK_BYTES / 2;
const _: () = assert!(FLUSH_BYTES + 4 * BURST_WORDS + 64 <= BLOCK_BYTES, "the largest record must fit");

/// Writes a trace to `W`. Without [`TraceWriter::finish`] the file is cut short and readers say so.
#[derive(Debug)]
pub struct TraceWriter<W: Write> {
    to: W,
    records: Vec<u8>,
    block: u32,
    offset: u64,
}

impl<W: Write> TraceWriter<W> {
    /// Begins a trace of a card with this much video memory.
    ///
    /// # Errors
    /// [`TraceError::Io`].
    pub fn new(to: W, video_memory: u32) -> Result<TraceWriter<W>, TraceError> {
        let mut header = MAGIC.to_vec();
        header.extend(VERSION.to_le_bytes());
        header.extend(video_memory.to_le_bytes());
        header.extend(xxh3_64(&header).to_le_bytes());
        let mut writer = TraceWriter { to, records: Vec::new(), block: 0, offset: 0 };
        writer.put(&header)?;
        Ok(writer)
    }

    /// Adds a record. Of a burst or mark with too many words the words that fit are written: callers split.
    ///
    /// # Errors
    /// [`TraceError::Io`].
    pub fn record(&mut self, record: &Record<'_>) -> Result<(), TraceError> {
        let record = match *record {
            Record::WriteBurst { address, words } => {
                Record::WriteBurst { address, words: &words[..words.len().min(BURST_WORDS)] }
            }
            Record::Mark { words } => Record::Mark { words: &words[..words.len().min(MARK_WORDS)] },
            other => other,
        };
        encode(&record, &mut self.records);
        if self.records.len() >= FLUSH_BYTES { self.put_block() } else { Ok(()) }
    }

    /// Ends the trace and gives the writer back, flushed.
    ///
    /// # Errors
    /// [`TraceError::Io`].
    pub fn finish(mut self) -> Result<W, TraceError> {
        if !self.records.is_empty() {
            self.put_block()?;
        }
        let hash = block_hash(self.block, [0, 0], &[]);
        self.put(&[0; 8])?;
        self.put(&hash.to_le_bytes())?;
        let offset = self.offset;
        self.to.flush().map_err(|source| TraceError::Io { offset, source })?;
        Ok(self.to)
    }

    fn put_block(&mut self) -> Result<(), TraceError> {
        let payload = lz4_flex::block::compress(&self.records);
        let lengths = [self.records.len() as u32, payload.len() as u32];
        let hash = block_hash(self.block, lengths, &payload);
        for word in lengths {
            self.put(&word.to_le_bytes())?;
        }
        self.put(&hash.to_le_bytes())?;
        self.put(&payload)?;
        self.records.clear();
        self.block += 1;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> Result<(), TraceError> {
        let offset = self.offset;
        self.to.write_all(bytes).map_err(|source| TraceError::Io { offset, source })?;
        self.offset += bytes.len() as u64;
        Ok(())
    }
}
