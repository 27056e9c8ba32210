//! PIO FIFO: 1024 words between the host's writes and the command processor.
//!
//! Duties: keeps the order of words; stalls the writer while it is full; refuses words while an
//! error has halted it; collects whole packets.
//! Inputs: words written to the FIFO window. Outputs: packets in one piece; FIFO_FREE, BUS_REJECTED.
//! Clocks: those of the front end, 1 a word.
//!
//! # Invariants
//! Every word written is either taken by the card in order, or counted in BUS_REJECTED, or dropped by
//! a reset or the loss of power. While the FIFO is halted the card's thread keeps taking words and
//! counting them, so no writer stalls for ever; when the card's thread ends the channel is
//! disconnected, and writers return.

use crate::bus::backplane::Backplane;
use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::SeqCst};
use zga_abi::bus::FIFO_WORDS;
use zga_abi::{Fault, Reg};

/// The host's end of the FIFO.
#[derive(Debug)]
pub(crate) struct FifoPort {
    words: Sender<u32>,
    /// Words of a restored snapshot that stand before those in the channel.
    carried: AtomicU32,
    halted: AtomicBool,
}

/// A FIFO: the host's end and the card's end.
pub(crate) fn fifo() -> (FifoPort, FifoFetch) {
    let (sender, receiver) = bounded(FIFO_WORDS as usize);
    let port = FifoPort { words: sender, carried: AtomicU32::new(0), halted: AtomicBool::new(false) };
    (port, FifoFetch { words: receiver, carried: VecDeque::new(), packet: Vec::new(), needed: 0, taken: 0 })
}

impl FifoPort {
    /// Pushes `words` in order; returns when the card has all of them, or has refused them.
    pub(crate) fn push(&self, words: &[u32], backplane: &Backplane) {
        for (done, &word) in words.iter().enumerate() {
            if self.halted() {
                backplane.registers.count(Reg::BusRejected, words.len() - done);
                break;
            }
            if let Err(TrySendError::Full(word)) = self.words.try_send(word) {
                backplane.control.wake();
                if self.words.send(word).is_err() {
                    return;
                }
            }
        }
        // Also after a refusal: a word that got in just before it is still to be discarded.
        backplane.control.wake();
    }

    /// Value of FIFO_FREE.
    pub(crate) fn free(&self) -> u32 {
        FIFO_WORDS.saturating_sub(self.words.len() as u32 + self.carried.load(SeqCst))
    }

    /// Are there words that the card has not taken?
    pub(crate) fn waits(&self) -> bool {
        !self.words.is_empty() || self.carried.load(SeqCst) > 0
    }

    /// Has an error stopped the FIFO?
    pub(crate) fn halted(&self) -> bool {
        self.halted.load(SeqCst)
    }

    /// Stops the FIFO, or lets it run again.
    pub(crate) fn set_halted(&self, halted: bool) {
        self.halted.store(halted, SeqCst);
    }
}

/// What a FIFO holds, for a snapshot.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct FifoState {
    /// Words taken of a packet that is not complete.
    pub(crate) packet: Vec<u32>,
    /// Words that the card has not taken.
    pub(crate) queued: Vec<u32>,
    /// Words taken since reset, modulo 2^32.
    pub(crate) taken: u32,
}

/// The card's end of the FIFO.
#[derive(Debug)]
pub(crate) struct FifoFetch {
    words: Receiver<u32>,
    carried: VecDeque<u32>,
    /// The packet being collected; its room is used again and again.
    packet: Vec<u32>,
    /// Words of the packet being collected; 0 before its header.
    needed: usize,
    /// Words taken since reset, modulo 2^32.
    taken: u32,
}

impl FifoFetch {
    /// The next word, if there is one.
    fn take(&mut self, port: &FifoPort) -> Option<u32> {
        let word = match self.carried.pop_front() {
            Some(word) => {
                port.carried.store(self.carried.len() as u32, SeqCst);
                word
            }
            None => self.words.try_recv().ok()?,
        };
        self.taken = self.taken.wrapping_add(1);
        Some(word)
    }

    /// Takes words until a packet is complete; `None` when they do not suffice.
    ///
    /// # Errors
    /// The fault of a header that `length_of` refuses.
    pub(crate) fn collect(
        &mut self,
        port: &FifoPort,
        length_of: impl Fn(u32) -> Result<u32, Fault>,
    ) -> Option<Result<(), Fault>> {
        if self.needed == 0 {
            self.packet.clear();
            let header = self.take(port)?;
            self.packet.push(header);
            match length_of(header) {
                Ok(words) => self.needed = words as usize,
                Err(fault) => return Some(Err(fault)),
            }
        }
        while self.packet.len() < self.needed {
            let word = self.take(port)?;
            self.packet.push(word);
        }
        self.needed = 0;
        Some(Ok(()))
    }

    /// The packet last collected.
    pub(crate) fn packet(&self) -> &[u32] {
        &self.packet
    }

    /// Words taken before the packet last collected, modulo 2^32.
    pub(crate) fn offset(&self) -> u32 {
        self.taken.wrapping_sub(self.packet.len() as u32)
    }

    /// Takes all words there are and throws them away; returns how many. They do not count as taken:
    /// how many a halted FIFO still gets hold of, and how many it refuses, is a matter of host time.
    pub(crate) fn discard(&mut self, port: &FifoPort) -> usize {
        let (mut words, taken) = (0, self.taken);
        while self.take(port).is_some() {
            words += 1;
        }
        self.taken = taken;
        words
    }

    /// Empties the FIFO, as a reset does.
    pub(crate) fn reset(&mut self, port: &FifoPort) {
        self.discard(port);
        self.load(port, &FifoState::default(), 0);
        port.set_halted(false);
    }

    /// What the FIFO holds now. Queued words leave the channel and are carried from here on.
    pub(crate) fn save(&mut self, port: &FifoPort) -> FifoState {
        let room = (FIFO_WORDS as usize).saturating_sub(self.carried.len());
        self.carried.extend(self.words.try_iter().take(room));
        port.carried.store(self.carried.len() as u32, SeqCst);
        let packet = if self.needed == 0 { Vec::new() } else { self.packet.clone() };
        FifoState { packet, queued: self.carried.iter().copied().collect(), taken: self.taken }
    }

    /// Puts `state` in place of what is collected and carried; `needed` is the length of the packet
    /// that is not complete, 0 if there is none.
    pub(crate) fn load(&mut self, port: &FifoPort, state: &FifoState, needed: usize) {
        self.packet.clear();
        self.packet.extend_from_slice(&state.packet);
        self.needed = needed;
        self.carried.clear();
        self.carried.extend(&state.queued);
        self.taken = state.taken;
        port.carried.store(self.carried.len() as u32, SeqCst);
    }
}
