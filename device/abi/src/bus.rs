//! The bus between a driver and a card: address map, accesses, interrupt lines.
//!
//! Driver and card never see each other's types; they meet at [`Bus`]. All addresses are byte
//! addresses and all accesses are aligned 32-bit words, as on a board without byte enables.

use core::time::Duration;

/// First byte of the register aperture.
pub const REGISTERS_BASE: u32 = 0x0000_0000;
/// Size of the register aperture in bytes.
pub const REGISTERS_BYTES: u32 = 0x0000_8000;
/// First byte of the PIO FIFO window: a write at any address inside pushes one word, in order.
pub const FIFO_BASE: u32 = 0x0000_8000;
/// Size of the PIO FIFO window in bytes.
pub const FIFO_BYTES: u32 = FIFO_WORDS * 4;
/// Depth of the PIO FIFO in words.
pub const FIFO_WORDS: u32 = 1024;
/// First byte of the Za RAM window.
pub const ZA_BASE: u32 = 0x0200_0000;
/// Size of the Za RAM window in bytes (the RAM behind it can be smaller: ZA_RAM_SIZE).
pub const ZA_BYTES: u32 = 0x0200_0000;
/// First byte of the video memory window.
pub const MEMORY_BASE: u32 = 0x4000_0000;
/// Size of the video memory window in bytes (the memory behind it can be smaller: VIDEO_MEMORY_SIZE).
pub const MEMORY_BYTES: u32 = 0x4000_0000;

/// Interrupt line: a fence packet was executed.
pub const INTERRUPT_FENCE: u32 = 1 << 0;
/// Interrupt line: a vertical blank began.
pub const INTERRUPT_VERTICAL_BLANK: u32 = 1 << 1;
/// Interrupt line: a packet was refused; the ERROR_* registers say which and why.
pub const INTERRUPT_ERROR: u32 = 1 << 2;
/// Every interrupt line there is.
pub const INTERRUPT_ALL: u32 = 0b111;

/// What reads return where nothing answers, as on a bus with pull-up resistors.
pub const FLOATING: u32 = 0xFFFF_FFFF;

/// A path to a card. Single accesses are in program order; a burst is a row of them.
///
/// No access fails: a card that is gone reads as [`FLOATING`], and what the card refuses it counts
/// (BUS_UNMAPPED, BUS_READ_ONLY, BUS_MISALIGNED).
pub trait Bus {
    /// Reads the word at byte `address`.
    fn read32(&mut self, address: u32) -> u32;

    /// Writes the word at byte `address`; returns when the card has taken it (a full FIFO stalls).
    fn write32(&mut self, address: u32, value: u32);

    /// Reads `words.len()` words from rising addresses, starting at byte `address`.
    fn read_burst(&mut self, address: u32, words: &mut [u32]) {
        for (word, at) in words.iter_mut().zip((address..).step_by(4)) {
            *word = self.read32(at);
        }
    }

    /// Writes `words` to rising addresses, starting at byte `address`.
    ///
    /// Inside the FIFO window the address does not rise: every word goes into the FIFO.
    fn write_burst(&mut self, address: u32, words: &[u32]) {
        let step = if (FIFO_BASE..FIFO_BASE + FIFO_BYTES).contains(&address) { 0 } else { 4 };
        let mut at = address;
        for &word in words {
            self.write32(at, word);
            at = at.wrapping_add(step);
        }
    }

    /// Waits until an enabled interrupt in `mask` is pending, at most `timeout`.
    ///
    /// Returns the pending lines of `mask` (INTERRUPT_STATUS & INTERRUPT_ENABLE & `mask`), 0 after
    /// the timeout. Nothing is acknowledged: write 1 to INTERRUPT_STATUS for that.
    fn wait_interrupt(&mut self, mask: u32, timeout: Duration) -> u32;

    /// Tells a logic analyser that is clipped to the bus what the accesses before were for.
    ///
    /// Nothing reaches the card; a bus that nobody watches ignores it, as this default does.
    fn mark(&mut self, note: &[u32]) {
        let _ = note;
    }
}

impl<B: Bus + ?Sized> Bus for &mut B {
    fn read32(&mut self, address: u32) -> u32 {
        (**self).read32(address)
    }
    fn write32(&mut self, address: u32, value: u32) {
        (**self).write32(address, value);
    }
    fn read_burst(&mut self, address: u32, words: &mut [u32]) {
        (**self).read_burst(address, words);
    }
    fn write_burst(&mut self, address: u32, words: &[u32]) {
        (**self).write_burst(address, words);
    }
    fn wait_interrupt(&mut self, mask: u32, timeout: Duration) -> u32 {
        (**self).wait_interrupt(mask, timeout)
    }
    fn mark(&mut self, note: &[u32]) {
        (**self).mark(note);
    }
}
