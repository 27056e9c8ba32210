//! A bus that writes down what it is used for, as a trace.

use std::io::Write;
use std::time::Duration;

use zga_abi::bus::{Bus, FIFO_BASE, FIFO_BYTES, MEMORY_BASE, ZA_BASE};
use zga_abi::registers::Reg;

use crate::trace::{BURST_WORDS, Record, TraceError, TraceWriter, hash_words};

/// Records every write, memory burst, interrupt and fence that goes over `B` into a [trace](crate::trace).
///
/// A bus has no way to tell of a full disk: the first error of the writer is kept and told by
/// [`RecordingBus::finish`]; the accesses go on unrecorded.
#[derive(Debug)]
pub struct RecordingBus<B: Bus, W: Write> {
    bus: B,
    trace: TraceWriter<W>,
    failed: Option<TraceError>,
}

impl<B: Bus, W: Write> RecordingBus<B, W> {
    /// Records what goes over `bus` to `to`, from here on. The card should be as after power-on: its memory
    /// is not part of the trace.
    ///
    /// # Errors
    /// The header could not be written.
    pub fn new(mut bus: B, to: W) -> Result<RecordingBus<B, W>, TraceError> {
        let video_memory = bus.read32(Reg::VideoMemorySize.offset());
        let trace = TraceWriter::new(to, video_memory)?;
        Ok(RecordingBus { bus, trace, failed: None })
    }

    /// Ends the trace and gives bus and writer back.
    ///
    /// # Errors
    /// The first error met while recording; the file is not a whole trace then.
    pub fn finish(self) -> Result<(B, W), TraceError> {
        match self.failed {
            Some(failed) => Err(failed),
            None => Ok((self.bus, self.trace.finish()?)),
        }
    }

    fn record(&mut self, record: &Record<'_>) {
        if self.failed.is_none() {
            self.failed = self.trace.record(record).err();
        }
    }
}

impl<B: Bus, W: Write> Bus for RecordingBus<B, W> {
    fn read32(&mut self, address: u32) -> u32 {
        let value = self.bus.read32(address);
        if address == Reg::FenceSequence.offset() {
            self.record(&Record::FenceReached { sequence: value });
        }
        value
    }

    fn write32(&mut self, address: u32, value: u32) {
        self.record(&Record::Write { address, value });
        self.bus.write32(address, value);
    }

    fn read_burst(&mut self, address: u32, words: &mut [u32]) {
        self.bus.read_burst(address, words);
        if address >= ZA_BASE {
            self.record(&Record::ReadBurst { address, words: words.len() as u32, hash: hash_words(words) });
        }
    }

    fn write_burst(&mut self, address: u32, words: &[u32]) {
        // In parts that fit a block; inside the FIFO window the address does not rise.
        let in_fifo = (FIFO_BASE..FIFO_BASE + FIFO_BYTES).contains(&address);
        let mut at = address;
        for part in words.chunks(BURST_WORDS) {
            self.record(&Record::WriteBurst { address: at, words: part });
            at = if in_fifo { at } else { at.wrapping_add(4 * part.len() as u32) };
        }
        self.bus.write_burst(address, words);
    }

    fn wait_interrupt(&mut self, mask: u32, timeout: Duration) -> u32 {
        let lines = self.bus.wait_interrupt(mask, timeout);
        self.record(&Record::WaitInterrupt { mask, lines });
        lines
    }

    fn mark(&mut self, note: &[u32]) {
        self.record(&Record::Mark { words: note });
        self.bus.mark(note);
    }
}

const _: () = assert!(ZA_BASE < MEMORY_BASE, "both memory windows lie above the registers");
