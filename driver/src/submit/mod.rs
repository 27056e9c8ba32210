//! Submission: packets are gathered on the host, travel in batches, and are kept until a fence tells
//! that the card has executed them.
//!
//! A batch is a run of packets that ends with a FENCE. It goes out in one burst and one doorbell. Space
//! in the ring comes back when the fence interrupt arrives: RING_GET is never polled. At most a ring's
//! worth of words is under way, so what is kept for [recovery](CardFault) is bounded, too.

mod image;
mod packets;
mod recovery;
mod ring;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use zga_abi::bus::{Bus, FIFO_BASE, INTERRUPT_ERROR, INTERRUPT_FENCE, MEMORY_BASE};
use zga_abi::packet::{MAX_PAYLOAD, Opcode, header};
use zga_abi::registers::Reg;

use crate::DriverError;
use image::RegisterImage;
pub(crate) use image::RegisterState;
pub use recovery::{CardFault, FaultSource};
use ring::Ring;

/// How packets reach the card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Submit {
    /// Through a ring in video memory: one burst and one doorbell for each batch.
    #[default]
    Ring,
    /// Through the PIO FIFO: every word crosses the register bus, and a full FIFO stalls the writer.
    Fifo,
}

/// A place in the stream of packets; see [`crate::Driver::fence`] and [`crate::Driver::wait`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[must_use = "a fence does nothing until it is waited for"]
pub struct Fence(pub(crate) u32);

impl Fence {
    /// The sequence number that FENCE_SEQUENCE shows when it has been executed.
    #[must_use]
    pub const fn sequence(self) -> u32 {
        self.0
    }
}

/// Whether sequence number `now` is `then` or after it (modulo 2^32).
const fn reached(now: u32, then: u32) -> bool {
    now.wrapping_sub(then) < 1 << 31
}

/// Words that were sent and not yet seen to be executed; they end with the fence `sequence`.
#[derive(Debug)]
struct Batch {
    words: Vec<u32>,
    /// Ring: word offset. FIFO: words pushed before it since the last reset.
    start: u32,
    /// The ring's put pointer after it.
    end: u32,
    sequence: u32,
}

/// Where batches go.
#[derive(Clone, Copy, Debug)]
enum Transport {
    Ring(Ring),
    Fifo { pushed: u32 },
}

/// The stream of packets to a card.
#[derive(Debug)]
pub(crate) struct Queue {
    transport: Transport,
    /// Words that may be under way: the ring's size.
    limit: usize,
    /// Encoded and not sent. May hold fences in its middle after a recovery, then `mixed` is set.
    pending: Vec<u32>,
    mixed: bool,
    /// Sent and not seen to be executed, oldest first.
    retained: VecDeque<Batch>,
    in_flight: usize,
    /// Empty vectors with capacity.
    spare: Vec<Vec<u32>>,
    /// Sequence number of the newest fence there is, sent, executed.
    newest: u32,
    sent: u32,
    completed: u32,
    /// Registers, and whether a scene is open, after the last packet seen to be executed.
    executed: recovery::Executed,
    scene_lost: bool,
    /// After a recovery: what the registers will hold when all that is pending has been executed.
    recovered: Option<RegisterImage>,
    timeout: Duration,
}

impl Queue {
    /// A queue over a ring of `words` words at byte `base` of video memory; or over the FIFO, with the same limits.
    pub fn new(submit: Submit, base: u32, words: u32, timeout: Duration) -> Queue {
        let transport = match submit {
            Submit::Ring => Transport::Ring(Ring::new(base, words)),
            Submit::Fifo => Transport::Fifo { pushed: 0 },
        };
        Queue {
            transport,
            limit: words as usize,
            pending: Vec::new(),
            mixed: false,
            retained: VecDeque::new(),
            in_flight: 0,
            spare: Vec::new(),
            newest: 0,
            sent: 0,
            completed: 0,
            executed: recovery::Executed::reset(),
            scene_lost: false,
            recovered: None,
            timeout,
        }
    }

    /// Programs interrupts and ring of a card that has just been reset.
    pub fn start<B: Bus>(&mut self, bus: &mut B) {
        bus.write32(Reg::InterruptEnable.offset(), INTERRUPT_FENCE | INTERRUPT_ERROR);
        match &mut self.transport {
            Transport::Ring(ring) => {
                *ring = Ring::new(ring.base, ring.size);
                bus.write32(Reg::RingBase.offset(), ring.base);
                bus.write32(Reg::RingSize.offset(), ring.size);
            }
            Transport::Fifo { pushed } => *pushed = 0,
        }
    }

    /// Most words of one packet, header included. Two of them and their fence fit half the ring.
    pub fn max_packet(&self) -> usize {
        (self.limit / 4 - 2).min(MAX_PAYLOAD as usize)
    }

    /// Sequence number that covers everything encoded so far.
    pub fn next_sequence(&self) -> u32 {
        if self.is_clean() { self.newest } else { self.newest.wrapping_add(1) }
    }

    /// Whether the fence with this number has been seen to be executed.
    pub fn is_done(&self, sequence: u32) -> bool {
        reached(self.completed, sequence)
    }

    /// Whether everything encoded is covered by a fence.
    fn is_clean(&self) -> bool {
        self.pending.is_empty() || (self.mixed && self.ends_with_fence())
    }

    /// Whether nothing is encoded or under way.
    pub fn is_idle(&self) -> bool {
        self.pending.is_empty() && self.retained.is_empty()
    }

    /// Whether the last pending packet is the newest fence.
    fn ends_with_fence(&self) -> bool {
        self.pending.ends_with(&[header(Opcode::Fence, 1), self.newest])
    }

    /// Whether a recovery has dropped the open scene; asking forgets it.
    pub fn take_scene_lost(&mut self) -> bool {
        std::mem::take(&mut self.scene_lost)
    }

    /// After a recovery, once: the registers as they will be when all that is pending has been executed.
    pub fn take_recovered(&mut self) -> Option<RegisterImage> {
        self.recovered.take()
    }

    /// Encodes a packet whose payload is `parts` in a row; sends the batch when it has grown large.
    ///
    /// # Errors
    /// PacketTooLong: nothing was encoded. Every other error is of the sending: the packet waits.
    pub fn packet<B: Bus>(&mut self, bus: &mut B, opcode: Opcode, parts: &[&[u32]]) -> Result<(), DriverError> {
        let payload: usize = parts.iter().map(|part| part.len()).sum();
        if payload + 1 > self.max_packet() {
            return Err(DriverError::PacketTooLong {
                packet: opcode.name(),
                words: payload + 1,
                most: self.max_packet(),
            });
        }
        self.pending.push(header(opcode, payload as u32));
        for part in parts {
            self.pending.extend_from_slice(part);
        }
        if self.pending.len() > self.limit / 8 {
            self.flush(bus)?;
        }
        Ok(())
    }

    /// Encodes a packet whose payload `write` appends, not longer than [`Queue::max_packet`]; sends as [`Queue::packet`].
    ///
    /// # Errors
    /// Of the sending: the packet waits.
    pub fn packet_with<B: Bus>(
        &mut self,
        bus: &mut B,
        opcode: Opcode,
        write: impl FnOnce(&mut Vec<u32>),
    ) -> Result<(), DriverError> {
        let first = self.pending.len();
        self.pending.push(0);
        write(&mut self.pending);
        self.pending[first] = header(opcode, (self.pending.len() - first - 1) as u32);
        if self.pending.len() > self.limit / 8 {
            self.flush(bus)?;
        }
        Ok(())
    }

    /// Sends everything encoded, with a fence behind it; gives the number of the newest fence.
    ///
    /// # Errors
    /// What waiting for space can tell: a card fault (already recovered) or a timeout. What was not sent
    /// waits for the next flush.
    pub fn flush<B: Bus>(&mut self, bus: &mut B) -> Result<u32, DriverError> {
        if !self.is_clean() {
            self.newest = self.newest.wrapping_add(1);
            self.pending.extend_from_slice(&[header(Opcode::Fence, 1), self.newest]);
        }
        while self.mixed && !self.pending.is_empty() {
            let (words, sequence) = self.first_chunk();
            self.make_room(bus, words)?;
            let chunk = self.pending.drain(..words).collect();
            self.send(bus, chunk, sequence);
        }
        self.mixed = false;
        if !self.pending.is_empty() {
            // If it has to wait for the next flush, packets behind this fence belong to the next batch.
            let room = self.make_room(bus, self.pending.len());
            self.mixed = room.is_err();
            room?;
            let chunk = std::mem::replace(&mut self.pending, self.spare.pop().unwrap_or_default());
            self.send(bus, chunk, self.newest);
        }
        Ok(self.newest)
    }

    /// Length and sequence number of what is pending up to its first fence.
    fn first_chunk(&self) -> (usize, u32) {
        packets::packets(&self.pending)
            .find(|packet| packet.opcode() == Some(Opcode::Fence))
            .map_or((self.pending.len(), self.newest), |packet| {
                (packet.start + packet.words.len(), packet.words.get(1).copied().unwrap_or(self.newest))
            })
    }

    /// Waits for the oldest batches until `words` more fit.
    fn make_room<B: Bus>(&mut self, bus: &mut B, words: usize) -> Result<(), DriverError> {
        loop {
            let fits = match &self.transport {
                Transport::Ring(ring) => ring.place(words as u32).is_some(),
                Transport::Fifo { .. } => self.in_flight + words <= self.limit,
            };
            match self.retained.front() {
                Some(oldest) if !fits => {
                    let sequence = oldest.sequence;
                    self.wait_sent(bus, sequence)?;
                }
                _ => return Ok(()),
            }
        }
    }

    /// Sends a batch. There is room: two of the longest packets and a fence are less than half the ring.
    fn send<B: Bus>(&mut self, bus: &mut B, words: Vec<u32>, sequence: u32) {
        let (start, end) = match &mut self.transport {
            Transport::Ring(ring) => {
                let Some(place) = ring.place(words.len() as u32) else { return };
                if place.padding > 0 {
                    let word = header(Opcode::NoOperation, place.padding - 1);
                    bus.write32(MEMORY_BASE + ring.address(ring.put), word);
                }
                bus.write_burst(MEMORY_BASE + ring.address(place.start), &words);
                ring.put = place.end;
                bus.write32(Reg::RingPut.offset(), place.end);
                bus.write32(Reg::Doorbell.offset(), 1);
                (place.start, place.end)
            }
            Transport::Fifo { pushed } => {
                let start = *pushed;
                *pushed = start.wrapping_add(words.len() as u32);
                bus.write_burst(FIFO_BASE, &words);
                (start, *pushed)
            }
        };
        self.in_flight += words.len();
        self.sent = sequence;
        self.retained.push_back(Batch { words, start, end, sequence });
    }

    /// Waits until the fence with this number is executed; sends it first if need be.
    ///
    /// # Errors
    /// Timeout, or a card fault that was met on the way (already recovered: wait again).
    pub fn wait<B: Bus>(&mut self, bus: &mut B, sequence: u32) -> Result<(), DriverError> {
        if !reached(self.sent, sequence) {
            self.flush(bus)?;
        }
        self.wait_sent(bus, sequence)
    }

    fn wait_sent<B: Bus>(&mut self, bus: &mut B, sequence: u32) -> Result<(), DriverError> {
        let begin = Instant::now();
        let mut left = self.timeout;
        while !reached(self.completed, sequence) {
            let lines = bus.wait_interrupt(INTERRUPT_FENCE | INTERRUPT_ERROR, left);
            // A line that sticks must not keep the wait going for ever.
            let lines = if left.is_zero() { 0 } else { lines };
            left = self.timeout.saturating_sub(begin.elapsed());
            if lines & INTERRUPT_FENCE != 0 {
                // Acknowledge first: a fence that comes between the two accesses is seen by the read, or
                // raises the line again.
                bus.write32(Reg::InterruptStatus.offset(), INTERRUPT_FENCE);
                let now = bus.read32(Reg::FenceSequence.offset());
                self.retire(now);
            } else if lines & INTERRUPT_ERROR != 0 {
                if let Some(fault) = self.recover(bus) {
                    return Err(fault.into());
                }
                bus.write32(Reg::InterruptStatus.offset(), INTERRUPT_ERROR);
            } else {
                return Err(self.timed_out(bus, begin.elapsed(), sequence));
            }
        }
        Ok(())
    }

    fn timed_out<B: Bus>(&self, bus: &mut B, waited: Duration, sequence: u32) -> DriverError {
        DriverError::Timeout {
            waited,
            sequence,
            reached: self.completed,
            pending: self.in_flight,
            ring_get: bus.read32(Reg::RingGet.offset()),
            ring_put: bus.read32(Reg::RingPut.offset()),
            status: bus.read32(Reg::Status.offset()),
        }
    }

    /// Takes note that the card has executed the fence `now`: its batch and those before it are done.
    fn retire(&mut self, now: u32) {
        if !reached(now, self.completed) || !reached(self.sent, now) {
            return; // Not one of ours: a card that was reset reads 0.
        }
        self.completed = now;
        while self.retained.front().is_some_and(|batch| reached(now, batch.sequence)) {
            let Some(batch) = self.retained.pop_front() else { break };
            self.executed.follow(&batch.words);
            self.in_flight -= batch.words.len();
            if let Transport::Ring(ring) = &mut self.transport {
                ring.get = batch.end;
            }
            let mut words = batch.words;
            words.clear();
            self.spare.push(words);
        }
    }
}
