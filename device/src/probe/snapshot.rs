//! Snapshots: everything a card holds between two packets, to go on from there later.
//!
//! Duties: collects the state of all blocks; checks a state and puts it in place.
//! Inputs and outputs: every block. Clocks: none; device time stands still meanwhile.
//!
//! A state is an allegation like a packet: it is checked before the first block changes. What is
//! only shown to the host (results, counts) is taken as it is; what a unit relies on is masked as a
//! write would be, and checked as a packet would be.

use crate::card::Board;
use crate::error::CardError;
use crate::frontend::fifo::FifoState;
use crate::frontend::ring::Pointers;
use crate::memory::areas::Areas;
use std::sync::Arc;
use std::sync::atomic::Ordering::SeqCst;
use zga_abi::bus::FIFO_WORDS;
use zga_abi::format::HiddenSurface;
use zga_abi::{Counter, Fault};
use zga_firmware::{Processor, ProcessorState};

/// A card's whole state. Clones share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    state: Arc<State>,
}

impl Snapshot {
    /// A snapshot of this state.
    pub(crate) fn new(state: State) -> Snapshot {
        Snapshot { state: Arc::new(state) }
    }

    /// What it holds.
    pub(crate) fn state(&self) -> Arc<State> {
        Arc::clone(&self.state)
    }

    /// The snapshot as bytes: versioned, compressed, with checksums.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.state.to_bytes()
    }

    /// The reverse of [`Snapshot::to_bytes`].
    ///
    /// # Errors
    /// [`CardError::Damaged`] with the place, for bytes that `to_bytes` did not make.
    pub fn from_bytes(bytes: &[u8]) -> Result<Snapshot, CardError> {
        State::from_bytes(bytes).map(Snapshot::new)
    }
}

/// The state of all blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct State {
    pub(crate) registers: Vec<u32>,
    pub(crate) interrupt_status: u32,
    pub(crate) interrupt_enable: u32,
    pub(crate) ring: Pointers,
    pub(crate) ring_halted: bool,
    /// The doorbell was rung, or packets up to RING_PUT were seen and are not done.
    pub(crate) ring_rung: bool,
    pub(crate) fifo: FifoState,
    pub(crate) fifo_halted: bool,
    pub(crate) processor: ProcessorState,
    /// Draws of the scene so far.
    pub(crate) draws: u32,
    /// Vertical blanks since power-on.
    pub(crate) blanks: u64,
    pub(crate) counters: [u64; Counter::COUNT],
    /// Size of Za RAM in bytes.
    pub(crate) za_bytes: u32,
    /// Words of Za RAM, or none if it was never written.
    pub(crate) za: Vec<u32>,
    /// The frames with logical clears, as [`Areas::to_words`] has them.
    pub(crate) areas: Vec<u32>,
    /// Words of video memory.
    pub(crate) video: Vec<u32>,
}

/// The state of `board`.
///
/// # Errors
/// [`CardError::HeldScene`].
pub(crate) fn save(board: &mut Board) -> Result<State, CardError> {
    let Board { backplane, frontend, blocks, .. } = board;
    if blocks.pipeline.holds_scene() {
        return Err(CardError::HeldScene);
    }
    backplane.publish(&mut blocks.account);
    let (memory, ring) = (backplane.memory.lock(), backplane.ring.pointers());
    Ok(State {
        registers: backplane.registers.save(),
        interrupt_status: backplane.interrupts.status(),
        interrupt_enable: backplane.interrupts.enable(),
        ring: Pointers::new(ring.base, ring.size, ring.put, ring.get),
        ring_halted: backplane.ring.halted(),
        // A doorbell over an empty ring or a halted one asks for nothing, heard or not.
        ring_rung: (backplane.ring.rung() && backplane.ring.waits()) || frontend.ring.pending(),
        fifo: frontend.fifo.save(&backplane.fifo),
        fifo_halted: backplane.fifo.halted(),
        processor: frontend.processor.state(),
        draws: blocks.probe.draws,
        blanks: blocks.scanout.blanks(),
        counters: *backplane.counters.lock().values(),
        za_bytes: memory.za().bytes(),
        za: memory.za().save(),
        areas: memory.areas().to_words(),
        video: memory.words().to_vec(),
    })
}

/// Puts `state` in place of the state of `board`; all or nothing.
///
/// # Errors
/// [`CardError::OtherCard`], [`CardError::Impossible`].
pub(crate) fn restore(board: &mut Board, state: &State) -> Result<(), CardError> {
    let processor = board.processor_of(&state.processor).map_err(impossible)?;
    let Board { backplane, frontend, blocks, .. } = board;
    let mut memory = backplane.memory.lock();
    same_size("video memory", 4 * state.video.len() as u32, 4 * memory.words().len() as u32)?;
    same_size("Za RAM", state.za_bytes, memory.za().bytes())?;
    let open = processor.target().filter(|target| target.hidden_surface == HiddenSurface::Za);
    let areas = Areas::from_words(&state.areas, memory.words().len(), memory.za().bytes(), open)
        .ok_or_else(|| CardError::Impossible { what: "logical clears of a frame that cannot be".to_owned() })?;
    let needed = check_fifo(&state.fifo)?;

    memory.words_mut().copy_from_slice(&state.video);
    memory.za_mut().load(&state.za);
    memory.set_areas(areas);
    backplane.registers.load(&state.registers);
    backplane.counters.lock().set_values(state.counters);
    blocks.account.clear();
    blocks.bitmap.power_off();
    blocks.scanout.load(state.blanks);
    blocks.pipeline.power_off(&mut memory);
    blocks.probe.reset();
    if let Some(target) = processor.target() {
        blocks.pipeline.resume_scene(target);
    }
    blocks.probe.draws = state.draws;
    blocks.powered = processor.units_powered();
    backplane.in_scene.store(processor.in_scene(), SeqCst);
    frontend.processor = processor;
    frontend.fifo.discard(&backplane.fifo);
    frontend.fifo.load(&backplane.fifo, &state.fifo, needed);
    backplane.fifo.set_halted(state.fifo_halted);
    frontend.ring.forget();
    backplane.ring.load(state.ring, state.ring_halted, state.ring_rung);
    backplane.interrupts.set(state.interrupt_status, state.interrupt_enable);
    Ok(())
}

fn same_size(memory: &'static str, found: u32, expected: u32) -> Result<(), CardError> {
    if found == expected { Ok(()) } else { Err(CardError::OtherCard { memory, found, expected }) }
}

/// Can a FIFO hold this? Returns the length of the packet that is not complete, 0 if there is none.
fn check_fifo(fifo: &FifoState) -> Result<usize, CardError> {
    if fifo.queued.len() > FIFO_WORDS as usize {
        return Err(CardError::Impossible { what: format!("{} words in the FIFO", fifo.queued.len()) });
    }
    let Some(&header) = fifo.packet.first() else { return Ok(0) };
    let needed = Processor::packet_length(header).map_err(impossible)? as usize;
    if fifo.packet.len() >= needed {
        return Err(CardError::Impossible { what: format!("a whole packet of {needed} words left undone") });
    }
    Ok(needed)
}

fn impossible(fault: Fault) -> CardError {
    CardError::Impossible { what: fault.to_string() }
}
