//! Command ring: its pointers, and the fetch of packets from video memory.
//!
//! Duties: keeps RING_BASE, RING_SIZE, RING_PUT, RING_GET; copies packets out of the ring in one
//! piece; refuses a ring that does not lie in memory and a packet that goes beyond RING_PUT.
//! Inputs: register writes, the doorbell, words in video memory. Outputs: packets; RING_GET.
//! Clocks: those of the front end, 1 a word.
//!
//! # Who owns what
//! RING_PUT belongs to the driver, RING_GET to the card. The ring is empty when they are equal and
//! full when one word is left. RING_PUT is always the end of a packet. The card looks at RING_PUT
//! when the doorbell was rung, works up to there, and moves RING_GET past each packet when it is done.
//!
//! Writing base or size starts a new ring: `generation` tells a card that is still at work in the
//! old one that its RING_GET no longer counts.

use parking_lot::Mutex;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use zga_abi::{Fault, FaultCode};

/// Smallest ring, in words.
const LEAST_WORDS: u32 = 256;
/// Largest ring, in words.
const MOST_WORDS: u32 = 1 << 20;

/// The ring registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pointers {
    /// First byte, a multiple of 4096.
    pub(crate) base: u32,
    /// Words; 0 is no ring.
    pub(crate) size: u32,
    /// Word offset after the last word written.
    pub(crate) put: u32,
    /// Word offset of the next packet.
    pub(crate) get: u32,
    /// Counts new rings.
    generation: u32,
}

impl Pointers {
    /// Ring registers with these values.
    pub(crate) fn new(base: u32, size: u32, put: u32, get: u32) -> Pointers {
        Pointers { base, size, put, get, generation: 0 }
    }
}

/// The bus side of the ring.
#[derive(Debug, Default)]
pub(crate) struct Ring {
    pointers: Mutex<Pointers>,
    rung: AtomicBool,
    halted: AtomicBool,
}

impl Ring {
    /// The ring registers now.
    pub(crate) fn pointers(&self) -> Pointers {
        *self.pointers.lock()
    }

    /// Starts a new ring at byte `base`.
    pub(crate) fn set_base(&self, base: u32) {
        self.start(|old| Pointers::new(base, old.size, 0, 0));
    }

    /// Starts a new ring of `size` words.
    pub(crate) fn set_size(&self, size: u32) {
        self.start(|old| Pointers::new(old.base, size, 0, 0));
    }

    /// Moves RING_PUT.
    pub(crate) fn set_put(&self, put: u32) {
        self.pointers.lock().put = put;
    }

    fn start(&self, new: impl Fn(Pointers) -> Pointers) {
        let mut pointers = self.pointers.lock();
        *pointers = Pointers { generation: pointers.generation.wrapping_add(1), ..new(*pointers) };
    }

    /// Notes that the card has to look at RING_PUT.
    pub(crate) fn ring_doorbell(&self) {
        self.rung.store(true, SeqCst);
    }

    /// Do packets wait in the ring?
    pub(crate) fn waits(&self) -> bool {
        let pointers = self.pointers();
        pointers.get != pointers.put && !self.halted()
    }

    /// Has an error stopped the ring?
    pub(crate) fn halted(&self) -> bool {
        self.halted.load(SeqCst)
    }

    /// Stops the ring, or lets it run again.
    pub(crate) fn set_halted(&self, halted: bool) {
        self.halted.store(halted, SeqCst);
    }

    /// Is a doorbell not answered yet?
    pub(crate) fn rung(&self) -> bool {
        self.rung.load(SeqCst)
    }

    /// No ring, as after a reset; or the ring of a snapshot, whose `pointers` are looked at if `rung`.
    pub(crate) fn load(&self, pointers: Pointers, halted: bool, rung: bool) {
        self.start(|_| pointers);
        self.set_halted(halted);
        self.rung.store(rung, SeqCst);
    }

    /// Moves RING_GET, unless a new ring was started meanwhile; says whether it did.
    fn publish(&self, fetched: &Pointers) -> bool {
        let mut pointers = self.pointers.lock();
        let same = pointers.generation == fetched.generation;
        if same {
            pointers.get = fetched.get;
        }
        same
    }
}

/// The card's side of the ring.
#[derive(Debug, Default)]
pub(crate) struct RingFetch {
    /// The ring when the card last looked; `get` runs ahead of the register by the packet in work.
    seen: Pointers,
    /// Words of the packet in work.
    length: u32,
    /// The packet in one piece; its room is used again and again.
    packet: Vec<u32>,
}

impl RingFetch {
    /// Fetches the next packet; `None` when there is none up to where the doorbell was rung.
    ///
    /// # Errors
    /// BAD_RING, TRUNCATED, or the fault of a header that `length_of` refuses.
    pub(crate) fn collect(
        &mut self,
        ring: &Ring,
        memory: &[u32],
        length_of: impl Fn(u32) -> Result<u32, Fault>,
    ) -> Option<Result<(), Fault>> {
        if self.seen.get == self.seen.put {
            if !ring.rung() {
                return None;
            }
            ring.rung.store(false, SeqCst);
            self.seen = ring.pointers();
            if self.seen.get == self.seen.put {
                return None;
            }
            self.packet.clear();
            if let Err(fault) = check(&self.seen, memory.len()) {
                return Some(Err(fault));
            }
        }
        Some(self.fetch(memory, length_of))
    }

    /// Copies the packet at `seen.get` out of the ring. `seen` has been checked.
    fn fetch(&mut self, memory: &[u32], length_of: impl Fn(u32) -> Result<u32, Fault>) -> Result<(), Fault> {
        let Pointers { base, size, put, get, .. } = self.seen;
        let words = &memory[(base / 4) as usize..][..size as usize];
        let header = words[get as usize];
        self.packet.clear();
        self.packet.push(header);
        self.length = length_of(header)?;
        if self.length > put.wrapping_sub(get) & (size - 1) {
            return Err(Fault::new(FaultCode::Truncated, 0, header));
        }
        let (first, rest) = (get as usize + 1, self.length as usize - 1);
        let before_end = rest.min(words.len() - first);
        self.packet.extend_from_slice(&words[first..first + before_end]);
        self.packet.extend_from_slice(&words[..rest - before_end]);
        Ok(())
    }

    /// The packet last fetched; after a fault its header, if there is one.
    pub(crate) fn packet(&self) -> &[u32] {
        &self.packet
    }

    /// Word offset of the packet last fetched.
    pub(crate) fn offset(&self) -> u32 {
        self.seen.get
    }

    /// Moves RING_GET past the packet last fetched.
    pub(crate) fn advance(&mut self, ring: &Ring) {
        self.seen.get = (self.seen.get + self.length) & (self.seen.size - 1);
        if !ring.publish(&self.seen) {
            self.forget();
        }
    }

    /// Is there work that was seen and is not done?
    pub(crate) fn pending(&self) -> bool {
        self.seen.get != self.seen.put
    }

    /// Looks at the ring anew when the doorbell is rung next.
    pub(crate) fn forget(&mut self) {
        self.seen = Pointers::default();
    }
}

/// Is this a ring in a video memory of `memory` words?
fn check(ring: &Pointers, memory: usize) -> Result<(), Fault> {
    let bad = |value| Err(Fault::new(FaultCode::BadRing, 0, value));
    let sizes = LEAST_WORDS..=MOST_WORDS;
    if !sizes.contains(&ring.size) || !ring.size.is_power_of_two() {
        return bad(ring.size);
    }
    if (ring.base / 4) as usize + ring.size as usize > memory {
        return bad(ring.base);
    }
    if ring.put >= ring.size {
        return bad(ring.put);
    }
    if ring.get >= ring.size {
        return bad(ring.get);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(header: u32) -> Result<u32, Fault> {
        Ok(header)
    }

    /// A ring of 256 words at byte 4096, the doorbell rung at `put`, the card at `get`.
    fn ring(get: u32, put: u32) -> Ring {
        let ring = Ring::default();
        ring.load(Pointers::new(4096, 256, put, get), false, true);
        ring
    }

    #[test]
    fn collect_packet_across_the_end_is_in_one_piece() {
        let mut memory = vec![0; 4096];
        memory[1024 + 254] = 4;
        memory[1024 + 255] = 11;
        memory[1024] = 12;
        memory[1025] = 13;
        let ring = ring(254, 2);
        let mut fetch = RingFetch::default();
        assert_eq!(fetch.collect(&ring, &memory, length), Some(Ok(())));
        assert_eq!(fetch.packet(), [4, 11, 12, 13]);
        fetch.advance(&ring);
        assert_eq!(ring.pointers().get, 2);
        assert_eq!(fetch.collect(&ring, &memory, length), None);
    }

    #[test]
    fn collect_full_ring_of_one_packet_is_fetched() {
        let mut memory = vec![7; 4096];
        memory[1024 + 9] = 255;
        let ring = ring(9, 8);
        let mut fetch = RingFetch::default();
        assert_eq!(fetch.collect(&ring, &memory, length), Some(Ok(())));
        assert_eq!(fetch.packet().len(), 255);
    }

    #[test]
    fn advance_new_ring_started_meanwhile_leaves_get_alone() {
        let mut memory = vec![0; 4096];
        memory[1024] = 2;
        let ring = ring(0, 4);
        let mut fetch = RingFetch::default();
        assert_eq!(fetch.collect(&ring, &memory, length), Some(Ok(())));
        ring.set_base(8192);
        fetch.advance(&ring);
        assert_eq!((ring.pointers().get, ring.pointers().put), (0, 0));
        assert_eq!(fetch.collect(&ring, &memory, length), None);
    }
}
