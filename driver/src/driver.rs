//! The driver: opens a card, owns its memory, submits and waits.

use std::collections::BTreeMap;
use std::time::Duration;

use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::packet::Opcode;
use zga_abi::registers::Reg;

use crate::effects::TextureRecord;
use crate::info::CardInfo;
use crate::memory::{Alignment, Allocation, MemoryError, VideoMemory};
use crate::state::State;
use crate::submit::{CardFault, Fence, Queue, RegisterState, Submit};
use crate::target::{Scene, TargetState};
use crate::{DriverError, Warning};

/// Patterns for the scratch test: every bit is seen at 0 and at 1.
const SCRATCH_PATTERNS: [u32; 2] = [0x5A5A_A5A5, 0xA5A5_5A5A];
/// Most warnings kept until they are taken.
const MOST_WARNINGS: usize = 64;

/// How a card is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriverOptions {
    /// How packets reach the card.
    pub submit: Submit,
    /// Words of the ring, a power of two from 4096 to 2^20; also the most words under way through the FIFO.
    pub ring_words: u32,
    /// Longest wait for a fence.
    pub timeout: Duration,
}

impl Default for DriverOptions {
    /// A ring of 2^17 words (512 KiB), 30 seconds.
    fn default() -> Self {
        DriverOptions { submit: Submit::Ring, ring_words: 1 << 17, timeout: Duration::from_secs(30) }
    }
}

/// A ZGA card, ready to draw.
///
/// Calls encode packets; they reach the card with [`Driver::flush`], [`Driver::fence`] or
/// [`Driver::wait`], or when many have gathered. The card works meanwhile. Errors of the card are told
/// by the call that meets them, see [`CardFault`]; the driver works on afterwards.
#[derive(Debug)]
pub struct Driver<B: Bus> {
    pub(crate) bus: B,
    pub(crate) info: CardInfo,
    pub(crate) queue: Queue,
    pub(crate) registers: RegisterState,
    pub(crate) state: State,
    pub(crate) targets: BTreeMap<u32, TargetState>,
    pub(crate) next_target: u32,
    pub(crate) textures: BTreeMap<u32, TextureRecord>,
    pub(crate) next_texture: u32,
    pub(crate) scene: Option<Scene>,
    /// Given back, but the open scene may read it until its end.
    pub(crate) scene_memory: Vec<Allocation>,
    pub(crate) capture_area: Option<Allocation>,
    pub(crate) shown: Option<(u32, u32)>,
    pub(crate) cursor_area: Option<Allocation>,
    pub(crate) probe_area: Option<Allocation>,
    /// The books of Za RAM.
    pub(crate) za_ram: VideoMemory,
    memory: VideoMemory,
    /// Freed, but the card may still use it until the fence with this number.
    leaving: Vec<(u32, Allocation)>,
    warnings: Vec<Warning>,
    pub(crate) payload: Vec<u32>,
}

impl<B: Bus> Driver<B> {
    /// Finds the card on `bus`, resets it and sets it up with [`DriverOptions::default`].
    ///
    /// # Errors
    /// As [`Driver::open_with`].
    pub fn open(bus: B) -> Result<Driver<B>, DriverError> {
        Driver::open_with(bus, DriverOptions::default())
    }

    /// Finds the card on `bus`, resets it and sets it up.
    ///
    /// # Errors
    /// No card, another device, an unknown major version, writes that do not arrive, too little video
    /// memory for the ring, or an option without meaning.
    pub fn open_with(mut bus: B, options: DriverOptions) -> Result<Driver<B>, DriverError> {
        let ring = options.ring_words;
        if !ring.is_power_of_two() || !(1 << 12..=1 << 20).contains(&ring) {
            return Err(DriverError::BadOption {
                name: "ring_words",
                found: ring.to_string(),
                expected: "a power of two from 4096 to 1048576",
            });
        }
        let info = CardInfo::read(&mut bus)?;
        bus.write32(Reg::Reset.offset(), 1);
        for expected in SCRATCH_PATTERNS {
            bus.write32(Reg::Scratch.offset(), expected);
            let found = bus.read32(Reg::Scratch.offset());
            if found != expected {
                return Err(DriverError::ScratchTest { found, expected });
            }
        }
        bus.write32(Reg::Scratch.offset(), 0);
        let mut memory = VideoMemory::new(info.video_memory);
        // The ring is the driver's for as long as it lives; its books need not come back.
        let base = match options.submit {
            Submit::Ring => memory.allocate(u64::from(ring) * 4, Alignment::Page)?.address(),
            Submit::Fifo => 0,
        };
        let mut queue = Queue::new(options.submit, base, ring, options.timeout);
        queue.start(&mut bus);
        Ok(Driver {
            bus,
            info,
            queue,
            registers: RegisterState::new(),
            state: State::new(),
            targets: BTreeMap::new(),
            next_target: 0,
            textures: BTreeMap::new(),
            next_texture: 0,
            scene: None,
            scene_memory: Vec::new(),
            capture_area: None,
            shown: None,
            cursor_area: None,
            probe_area: None,
            za_ram: VideoMemory::new(info.za_ram),
            memory,
            leaving: Vec::new(),
            warnings: Vec::new(),
            payload: Vec::new(),
        })
    }

    /// Waits for all work, turns the card's interrupts off and gives the bus back.
    ///
    /// # Errors
    /// What [`Driver::finish`] tells; the bus is lost then.
    pub fn close(mut self) -> Result<B, DriverError> {
        self.finish()?;
        self.bus.write32(Reg::InterruptEnable.offset(), 0);
        Ok(self.bus)
    }

    /// The bus.
    pub const fn bus(&self) -> &B {
        &self.bus
    }

    /// The bus, for accesses past the driver. Ring, fences and interrupts are the driver's.
    pub const fn bus_mut(&mut self) -> &mut B {
        &mut self.bus
    }

    /// Sends everything encoded so far; returns without waiting.
    ///
    /// # Errors
    /// What waiting for space in the ring can tell. What was not sent goes out with the next call.
    pub fn flush(&mut self) -> Result<(), DriverError> {
        self.queue.flush(&mut self.bus).map(drop)
    }

    /// Sends everything encoded so far; the fence is reached when the card has executed it all.
    ///
    /// # Errors
    /// As [`Driver::flush`].
    pub fn fence(&mut self) -> Result<Fence, DriverError> {
        self.queue.flush(&mut self.bus).map(Fence)
    }

    /// Waits, by interrupt, until the card has reached `fence`.
    ///
    /// # Errors
    /// [`DriverError::Timeout`]; or [`DriverError::CardFault`] if the card refused a packet on the way:
    /// the driver has recovered then, and waiting again goes on with the rest.
    pub fn wait(&mut self, fence: Fence) -> Result<(), DriverError> {
        self.queue.wait(&mut self.bus, fence.0)?;
        self.let_go();
        Ok(())
    }

    /// Sends everything and waits for it.
    ///
    /// # Errors
    /// As [`Driver::wait`].
    pub fn finish(&mut self) -> Result<(), DriverError> {
        let fence = self.fence()?;
        self.wait(fence)
    }

    /// Looks whether the card has refused a packet and recovers if so; [`CardFault`] says what is lost.
    ///
    /// `fence`, `flush` and `wait` do this by themselves when an error interrupt arrives while they wait;
    /// this is for those who do not wait. The rest goes out with the next flush.
    pub fn recover(&mut self) -> Option<CardFault> {
        self.queue.recover(&mut self.bus)
    }

    /// Encodes a packet as it is, for what has no method here. The card judges it.
    ///
    /// Register values that it sets are noted; calls that need other values set them again. Scenes begun or
    /// ended like this are not known to the other methods.
    ///
    /// # Errors
    /// [`DriverError::PacketTooLong`], or as [`Driver::flush`].
    pub fn packet(&mut self, opcode: Opcode, payload: &[u32]) -> Result<(), DriverError> {
        self.adopt_recovered();
        let mut words = vec![zga_abi::packet::header(opcode, payload.len() as u32)];
        words.extend_from_slice(payload);
        self.registers.follow(&words);
        self.state.matrices_changed();
        self.encode(opcode, &[payload])
    }

    /// Takes video memory; `bytes` is rounded up to 64.
    ///
    /// Memory that was freed while the card still used it is waited for if it is needed.
    ///
    /// # Errors
    /// [`MemoryError::OutOfMemory`] with what was asked and what is free, or as [`Driver::wait`].
    pub fn allocate(&mut self, bytes: u64, alignment: Alignment) -> Result<Allocation, DriverError> {
        match self.memory.allocate(bytes, alignment) {
            Err(MemoryError::OutOfMemory { .. }) if !self.leaving.is_empty() => {
                self.finish()?;
                Ok(self.memory.allocate(bytes, alignment)?)
            }
            other => Ok(other?),
        }
    }

    /// Gives video memory back; it is used again when the card has executed what was encoded before.
    ///
    /// # Errors
    /// [`MemoryError::NotAllocated`] if it is not this driver's.
    pub fn free(&mut self, allocation: Allocation) -> Result<(), DriverError> {
        if self.queue.is_idle() {
            return Ok(self.memory.free(allocation)?);
        }
        self.leaving.push((self.queue.next_sequence(), allocation));
        Ok(())
    }

    /// The books of video memory.
    pub const fn memory(&self) -> &VideoMemory {
        &self.memory
    }

    /// Writes words into video memory, now: work under way that reads them is not waited for.
    ///
    /// # Errors
    /// [`DriverError::OutOfAllocation`].
    pub fn write_memory(&mut self, to: &Allocation, word: u32, words: &[u32]) -> Result<(), DriverError> {
        let address = word_address(to, word, words.len())?;
        self.bus.write_burst(address, words);
        Ok(())
    }

    /// Reads words from video memory, now: wait for the work that writes them first.
    ///
    /// # Errors
    /// [`DriverError::OutOfAllocation`].
    pub fn read_memory(&mut self, from: &Allocation, word: u32, words: &mut [u32]) -> Result<(), DriverError> {
        let address = word_address(from, word, words.len())?;
        self.bus.read_burst(address, words);
        Ok(())
    }

    /// What the driver found worth telling since the last call, oldest first, each once; at most 64 are kept.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.warnings)
    }

    /// Keeps a warning unless it is there already.
    pub(crate) fn warn(&mut self, warning: Warning) {
        if self.warnings.len() < MOST_WARNINGS && !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// Sends the registers that differ from what the card will have.
    pub(crate) fn send_registers(&mut self) -> Result<(), DriverError> {
        let mut payload = std::mem::take(&mut self.payload);
        let mut result = Ok(());
        while self.registers.next_write(&mut payload) {
            // The packet is encoded even if sending it met an error: the rest must follow.
            let sent = self.encode(Opcode::RegisterWrite, &[&payload]);
            result = result.and(sent);
        }
        self.payload = payload;
        result
    }

    /// Encodes a packet.
    pub(crate) fn encode(&mut self, opcode: Opcode, parts: &[&[u32]]) -> Result<(), DriverError> {
        self.queue.packet(&mut self.bus, opcode, parts)
    }

    /// Encodes a packet whose payload `write` appends; it is not longer than [`Queue::max_packet`].
    pub(crate) fn encode_with(&mut self, opcode: Opcode, write: impl FnOnce(&mut Vec<u32>)) -> Result<(), DriverError> {
        self.queue.packet_with(&mut self.bus, opcode, write)
    }

    /// Encodes a packet that needs a scene. An error in `sent`, of the sending of its registers, does not keep it back:
    /// what was encoded before it waits as well.
    pub(crate) fn encode_in_scene(
        &mut self,
        call: &'static str,
        sent: Result<(), DriverError>,
        opcode: Opcode,
        parts: &[&[u32]],
    ) -> Result<(), DriverError> {
        self.adopt_recovered();
        match self.open_scene(call) {
            Ok(_) => sent.and(self.encode(opcode, parts)),
            Err(lost) => sent.and(Err(lost)),
        }
    }

    /// After a recovery: begins again from what the registers will hold.
    pub(crate) fn adopt_recovered(&mut self) {
        if let Some(image) = self.queue.take_recovered() {
            self.registers.adopt(image);
            self.state.matrices_changed();
        }
        if self.queue.take_scene_lost()
            && let Some(scene) = &mut self.scene
        {
            scene.lost = true;
        }
    }

    /// Gives memory back that the card has done with.
    fn let_go(&mut self) {
        let queue = &self.queue;
        for (_, allocation) in self.leaving.extract_if(.., |(sequence, _)| queue.is_done(*sequence)) {
            // Only handles that this driver gave out are in the list, or foreign ones: those are ignored.
            let _ = self.memory.free(allocation);
        }
    }
}

/// Bus address of a word in an allocation.
fn word_address(allocation: &Allocation, word: u32, count: usize) -> Result<u32, DriverError> {
    let (offset, words) = (u64::from(word), u64::from(allocation.bytes() / 4));
    let end = offset + count as u64;
    if end > words {
        return Err(DriverError::OutOfAllocation { offset, end, words });
    }
    Ok(MEMORY_BASE + allocation.address() + 4 * word)
}
