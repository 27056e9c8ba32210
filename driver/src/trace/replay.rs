//! Replaying a trace on a card.

use std::io::Read;
use std::time::{Duration, Instant};

use zga_abi::bus::{Bus, INTERRUPT_ALL, INTERRUPT_ERROR, INTERRUPT_FENCE, MEMORY_BASE, ZA_BASE, ZA_BYTES};
use zga_abi::registers::Reg;

use super::format::{FRAME_MARK, Record, TraceError, hash_words};
use super::reader::TraceReader;
use crate::{frame_hash, hash_text};

/// A read-back that was not what it was when the trace was recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Number of the record, from 0.
    pub record: u64,
    /// Bus address of the burst.
    pub address: u32,
    /// Words of the burst.
    pub words: u32,
    /// XXH3 of them when recorded.
    pub expected: u64,
    /// XXH3 of them now.
    pub found: u64,
}

/// A frame of a replayed trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameReplay {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Its hash when recorded, as [`crate::Frame::hash`] shows it.
    pub expected: String,
    /// Its hash now.
    pub found: String,
}

/// What a replay did and found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReplayReport {
    /// Records replayed.
    pub records: u64,
    /// Words written.
    pub words_written: u64,
    /// Read-backs compared.
    pub compared: u64,
    /// How many of them differ.
    pub differences: u64,
    /// The first that differs.
    pub first_difference: Option<Difference>,
    /// Frames, in order.
    pub frames: Vec<FrameReplay>,
}

impl ReplayReport {
    /// Whether every read-back and every frame is what it was.
    #[must_use]
    pub fn is_equal(&self) -> bool {
        self.differences == 0 && self.frames.iter().all(|frame| frame.expected == frame.found)
    }
}

/// Replays a trace on a card that is as after power-on; each wait may take `timeout`.
///
/// # Errors
/// What the reader finds; [`TraceError::OtherCard`] if the card has not the memory that the recorded one
/// had; [`TraceError::BadRead`]; [`TraceError::Stalled`] if a fence or interrupt does not come. Differences
/// are no errors: see the report.
pub fn replay<R: Read, B: Bus>(from: R, bus: &mut B, timeout: Duration) -> Result<ReplayReport, TraceError> {
    let mut reader = TraceReader::new(from)?;
    let recorded = reader.video_memory();
    let found = bus.read32(Reg::VideoMemorySize.offset());
    if recorded != found {
        return Err(TraceError::OtherCard { recorded, found });
    }
    let mut report = ReplayReport::default();
    let mut last_read = Vec::new();
    while let Some(record) = reader.next_record()? {
        let number = report.records;
        report.records += 1;
        match record {
            Record::Write { address, value } => {
                bus.write32(address, value);
                report.words_written += 1;
            }
            Record::WriteBurst { address, words } => {
                bus.write_burst(address, words);
                report.words_written += words.len() as u64;
            }
            Record::ReadBurst { address, words, hash } => {
                if !is_memory(address, words, recorded) {
                    return Err(TraceError::BadRead { record: number, address, words });
                }
                last_read.resize(words as usize, 0);
                bus.read_burst(address, &mut last_read);
                compare(
                    &mut report,
                    Difference { record: number, address, words, expected: hash, found: hash_words(&last_read) },
                );
            }
            Record::WaitInterrupt { lines, .. } => wait_lines(bus, lines & !INTERRUPT_FENCE, timeout, number)?,
            Record::FenceReached { sequence } => wait_fence(bus, sequence, timeout, number)?,
            Record::Mark { words: &[FRAME_MARK, width, height, low, high] } => {
                report.frames.push(FrameReplay {
                    width,
                    height,
                    expected: hash_text(u64::from(low) | u64::from(high) << 32),
                    found: hash_text(frame_hash(width, height, &last_read)),
                });
            }
            Record::Mark { .. } => {}
        }
    }
    Ok(report)
}

/// Whether a run of words lies in a memory window of a card with this much video memory.
fn is_memory(address: u32, words: u32, video_memory: u32) -> bool {
    let end = u64::from(address) + 4 * u64::from(words);
    let lies_in = |base: u32, bytes: u32| address >= base && end <= u64::from(base) + u64::from(bytes);
    lies_in(MEMORY_BASE, video_memory) || lies_in(ZA_BASE, ZA_BYTES)
}

fn compare(report: &mut ReplayReport, read: Difference) {
    report.compared += 1;
    if read.expected != read.found {
        report.differences += 1;
        report.first_difference.get_or_insert(read);
    }
}

/// Waits until each of the lines is pending. None is acknowledged: the trace holds that, too.
fn wait_lines<B: Bus>(bus: &mut B, lines: u32, timeout: Duration, record: u64) -> Result<(), TraceError> {
    for line in [1, 2, 4].into_iter().filter(|line| lines & line & INTERRUPT_ALL != 0) {
        if bus.wait_interrupt(line, timeout) == 0 {
            let what = if line == INTERRUPT_ERROR { "the error interrupt" } else { "the vertical blank" };
            return Err(TraceError::Stalled { record, what: what.to_owned() });
        }
    }
    Ok(())
}

/// Waits until FENCE_SEQUENCE has reached `sequence`.
fn wait_fence<B: Bus>(bus: &mut B, sequence: u32, timeout: Duration, record: u64) -> Result<(), TraceError> {
    let begin = Instant::now();
    while bus.read32(Reg::FenceSequence.offset()).wrapping_sub(sequence) >= 1 << 31 {
        let left = timeout.saturating_sub(begin.elapsed());
        if bus.wait_interrupt(INTERRUPT_FENCE | INTERRUPT_ERROR, left) & INTERRUPT_FENCE == 0 {
            let why = if bus.read32(Reg::ErrorCode.offset()) == 0 { "" } else { " (the card refused a packet)" };
            return Err(TraceError::Stalled { record, what: format!("fence {sequence}{why}") });
        }
        bus.write32(Reg::InterruptStatus.offset(), INTERRUPT_FENCE);
    }
    Ok(())
}
