//! Snapshots as bytes: sections with checksums, memory compressed.
//!
//! Duties: writes a state; reads one back, refusing every byte that was changed, with its place.
//! Inputs and outputs: [`State`], bytes. Clocks: none.
//!
//! | bytes | content |
//! | --- | --- |
//! | 8 | `ZGASNAP` and a zero |
//! | 4 | version, 5 |
//! | ... | sections: the card (tag 1), then Za RAM (tag 2) and video memory (tag 3) in order |
//!
//! A section is: 8 bytes xxh3 of what follows in it, 4 bytes tag, 4 bytes length, content. Memory is
//! cut into sections of 1 MiB, each an LZ4 block; one of zeros alone has no content. Numbers are
//! little-endian. Lists are a count and their words.

use super::snapshot::State;
use crate::error::CardError;
use crate::frontend::fifo::FifoState;
use crate::frontend::ring::Pointers;
use xxhash_rust::xxh3::xxh3_64;
use zga_abi::Counter;
use zga_firmware::ProcessorState;

const MAGIC: &[u8; 8] = b"ZGASNAP\0";
const VERSION: u32 = 5;
const TAG_CARD: u32 = 1;
const TAG_ZA: u32 = 2;
const TAG_VIDEO: u32 = 3;
/// Words of memory in a section.
const SECTION_WORDS: usize = 1 << 18;
/// Most bytes of video memory.
const MOST_VIDEO: u32 = 1 << 30;
/// Most bytes of Za RAM.
const MOST_ZA: u32 = 32 << 20;

impl State {
    /// Everything as bytes.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        section(&mut bytes, TAG_CARD, bytemuck::cast_slice(&little_endian(&self.card_words())));
        for (tag, memory) in [(TAG_ZA, &self.za), (TAG_VIDEO, &self.video)] {
            for words in memory.chunks(SECTION_WORDS) {
                let packed = if words.iter().all(|&word| word == 0) {
                    Vec::new()
                } else {
                    lz4_flex::block::compress(bytemuck::cast_slice(&little_endian(words)))
                };
                section(&mut bytes, tag, &packed);
            }
        }
        bytes
    }

    /// All but the memories, as words.
    fn card_words(&self) -> Vec<u32> {
        let mut words = vec![
            4 * self.video.len() as u32,
            self.za_bytes,
            u32::from(!self.za.is_empty()),
            self.interrupt_status,
            self.interrupt_enable,
            self.ring.base,
            self.ring.size,
            self.ring.put,
            self.ring.get,
            u32::from(self.ring_halted),
            u32::from(self.ring_rung),
            u32::from(self.fifo_halted),
            self.fifo.taken,
            self.draws,
            self.blanks as u32,
            (self.blanks >> 32) as u32,
        ];
        words.extend(self.processor.to_words());
        let counters: Vec<u32> = self.counters.iter().flat_map(|&c| [c as u32, (c >> 32) as u32]).collect();
        for list in [&counters, &self.registers, &self.fifo.packet, &self.fifo.queued, &self.areas] {
            words.push(list.len() as u32);
            words.extend(list);
        }
        words
    }

    /// The reverse of [`State::to_bytes`].
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<State, CardError> {
        let mut reader = Reader { bytes, at: 0 };
        if reader.take(8, "the magic bytes of a snapshot")? != MAGIC {
            return Err(damaged(0, "the magic bytes of a snapshot"));
        }
        if reader.word("the version")? != VERSION {
            return Err(damaged(8, "version 5"));
        }
        let content = reader.section(TAG_CARD)?;
        let card = reader.at - content.len();
        let mut fields = Reader { bytes: &bytes[..reader.at], at: card };
        let (mut state, video_bytes, za_words) = card_state(&mut fields)?;
        fields.end("the end of the card's section")?;
        state.za = reader.memory(TAG_ZA, za_words)?;
        state.video = reader.memory(TAG_VIDEO, (video_bytes / 4) as usize)?;
        reader.end("the end of the snapshot")?;
        Ok(state)
    }
}

/// The state without its memories, the bytes of video memory, and the stored words of Za RAM.
fn card_state(fields: &mut Reader<'_>) -> Result<(State, u32, usize), CardError> {
    let video_bytes = fields.size(MOST_VIDEO, "a size of video memory")?;
    let za_bytes = fields.size(MOST_ZA, "a size of Za RAM")?;
    let za_stored = fields.flag()?;
    let [interrupt_status, interrupt_enable] = fields.words()?;
    let [base, size, put, get] = fields.words()?;
    let (ring_halted, ring_rung, fifo_halted) = (fields.flag()?, fields.flag()?, fields.flag()?);
    let [taken, draws, blanks_low, blanks_high] = fields.words()?;
    let processor = ProcessorState::from_words(&fields.words()?);
    let counters = fields.list()?;
    if counters.len() != 2 * Counter::COUNT {
        return Err(damaged(fields.at, "a value for each counter"));
    }
    let mut values = [0; Counter::COUNT];
    for (value, halves) in values.iter_mut().zip(counters.chunks_exact(2)) {
        *value = long(halves[0], halves[1]);
    }
    let state = State {
        interrupt_status,
        interrupt_enable,
        ring: Pointers::new(base, size, put, get),
        ring_halted,
        ring_rung,
        fifo_halted,
        processor,
        draws,
        blanks: long(blanks_low, blanks_high),
        counters: values,
        registers: fields.list()?,
        fifo: FifoState { packet: fields.list()?, queued: fields.list()?, taken },
        areas: fields.list()?,
        za_bytes,
        za: Vec::new(),
        video: Vec::new(),
    };
    Ok((state, video_bytes, if za_stored { (za_bytes / 4) as usize } else { 0 }))
}

fn long(low: u32, high: u32) -> u64 {
    u64::from(low) | (u64::from(high) << 32)
}

fn damaged(at: usize, what: &'static str) -> CardError {
    CardError::Damaged { at, what }
}

/// Words in the byte order of the file; and back.
fn little_endian(words: &[u32]) -> Vec<u32> {
    words.iter().map(|word| word.to_le()).collect()
}

/// The word that these bytes are, least first.
fn from_le_bytes(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, &byte| (word << 8) | u32::from(byte))
}

/// Appends a section.
fn section(bytes: &mut Vec<u8>, tag: u32, content: &[u8]) {
    let start = bytes.len();
    bytes.extend([0; 8]);
    bytes.extend(tag.to_le_bytes());
    bytes.extend((content.len() as u32).to_le_bytes());
    bytes.extend(content);
    let sum = xxh3_64(&bytes[start + 8..]);
    bytes[start..start + 8].copy_from_slice(&sum.to_le_bytes());
}

/// Reads fields from bytes, and knows where it is.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    /// The next `count` bytes, which are `what`.
    fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], CardError> {
        let bytes = self.bytes.get(self.at..).and_then(|rest| rest.get(..count)).ok_or(damaged(self.at, what))?;
        self.at += count;
        Ok(bytes)
    }

    fn word(&mut self, what: &'static str) -> Result<u32, CardError> {
        self.take(4, what).map(from_le_bytes)
    }

    fn words<const N: usize>(&mut self) -> Result<[u32; N], CardError> {
        let mut words = [0; N];
        for word in &mut words {
            *word = self.word("a field of the card")?;
        }
        Ok(words)
    }

    fn flag(&mut self) -> Result<bool, CardError> {
        let at = self.at;
        match self.word("a flag")? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(damaged(at, "a flag of 0 or 1")),
        }
    }

    fn size(&mut self, most: u32, what: &'static str) -> Result<u32, CardError> {
        let at = self.at;
        let size = self.word(what)?;
        if size <= most && size.is_multiple_of(4096) { Ok(size) } else { Err(damaged(at, what)) }
    }

    fn list(&mut self) -> Result<Vec<u32>, CardError> {
        let count = self.word("the length of a list")? as usize;
        let bytes = self.take(count.saturating_mul(4), "the words of a list")?;
        Ok(bytes.chunks_exact(4).map(from_le_bytes).collect())
    }

    /// The content of the next section, which has this tag.
    fn section(&mut self, tag: u32) -> Result<&'a [u8], CardError> {
        let start = self.at;
        let sum = self.take(8, "a section's checksum")?;
        let found = self.word("a section's tag")?;
        let length = self.word("a section's length")? as usize;
        let content = self.take(length, "a section's content")?;
        if xxh3_64(&self.bytes[start + 8..self.at]).to_le_bytes() != *sum {
            return Err(damaged(start, "a section that agrees with its checksum"));
        }
        if found != tag {
            return Err(damaged(start + 8, "the sections in their order"));
        }
        Ok(content)
    }

    /// A memory of `words` words.
    fn memory(&mut self, tag: u32, words: usize) -> Result<Vec<u32>, CardError> {
        let mut memory = vec![0; words];
        for part in memory.chunks_mut(SECTION_WORDS) {
            let content = self.section(tag)?;
            let at = self.at - content.len();
            if !content.is_empty() {
                let room: &mut [u8] = bytemuck::cast_slice_mut(part);
                let size = room.len();
                if lz4_flex::block::decompress_into(content, room).ok() != Some(size) {
                    return Err(damaged(at, "an LZ4 block of the section's memory"));
                }
                part.iter_mut().for_each(|word| *word = u32::from_le(*word));
            }
        }
        Ok(memory)
    }

    fn end(&self, what: &'static str) -> Result<(), CardError> {
        if self.at == self.bytes.len() { Ok(()) } else { Err(damaged(self.at, what)) }
    }
}
