//! Backplane: what the host's side and the card's own thread both touch.
//!
//! Duties: holds the blocks between the two sides and the wires that wake the card's thread.
//! Inputs and outputs: see the blocks. Clocks: none; these are wires.
//!
//! | block | shared by | rule |
//! | --- | --- | --- |
//! | [`RegisterFile`] | everybody | one atomic word for each register word |
//! | [`Ring`] | driver (put), card (get) | a lock, held for a few loads |
//! | [`Interrupts`] | card raises, driver acknowledges | atomic latches |
//! | counters | card adds, driver reads and clears | a lock, held to add or read |
//! | [`VideoMemory`] | both | a lock; the card holds it for one packet, a burst for one copy, a host's mapping while it is there |
//! | FIFO | driver pushes, card takes | a bounded channel of the FIFO's depth |
//!
//! Lock order: video memory before any other; no thread holds two of the others.

use super::interrupts::Interrupts;
use crate::frontend::control::{Control, ControlPort, control};
use crate::frontend::fifo::{FifoFetch, FifoPort, fifo};
use crate::frontend::register_file::RegisterFile;
use crate::frontend::ring::Ring;
use crate::memory::VideoMemory;
use crate::probe::account::Account;
use crate::scanout::monitor::Cable;
use parking_lot::Mutex;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use zga_abi::Reg;
use zga_abi::format::HiddenSurface;

/// Hidden-surface paths that this card has, as in CAPABILITY_PATHS.
const PATHS: u32 = {
    let (mut paths, mut index) = (0, 0);
    while index < HiddenSurface::ALL.len() {
        paths |= 1 << HiddenSurface::ALL[index].code();
        index += 1;
    }
    paths
};

/// Bit 3 of STATUS.
const STATUS_IN_SCENE: u32 = 1 << 3;
/// Bit 2 of STATUS.
const STATUS_FIFO_HALTED: u32 = 1 << 2;
/// Bit 1 of STATUS.
const STATUS_RING_HALTED: u32 = 1 << 1;
/// Bit 0 of STATUS.
const STATUS_BUSY: u32 = 1 << 0;

/// The backplane of one card.
#[derive(Debug)]
pub(crate) struct Backplane {
    pub(crate) registers: RegisterFile,
    pub(crate) interrupts: Interrupts,
    pub(crate) ring: Ring,
    pub(crate) fifo: FifoPort,
    pub(crate) control: Control,
    pub(crate) memory: Arc<Mutex<VideoMemory>>,
    /// Counters as the COUNTERS registers show them; the card adds what it has counted since
    /// before every fence, every interrupt and every rest.
    pub(crate) counters: Mutex<Account>,
    pub(crate) cable: Arc<Cable>,
    /// The card's thread is at work: set before it takes a word from the FIFO.
    pub(crate) active: AtomicBool,
    /// A scene is open.
    pub(crate) in_scene: AtomicBool,
}

impl Backplane {
    /// The backplane of a card with memories of these sizes in bytes, after power-on; and what only
    /// the card's thread may hold.
    pub(crate) fn new(video_memory: u32, za_ram: u32) -> (Backplane, FifoFetch, ControlPort) {
        let registers = RegisterFile::new();
        registers.set(Reg::CapabilityEffects, crate::built::EFFECTS.bits());
        registers.set(Reg::CapabilityPaths, PATHS);
        registers.set(Reg::VideoMemorySize, video_memory);
        registers.set(Reg::ZaRamSize, za_ram);
        let (control, control_port) = control();
        let (fifo, fifo_fetch) = fifo();
        let backplane = Backplane {
            registers,
            interrupts: Interrupts::default(),
            ring: Ring::default(),
            fifo,
            control,
            memory: Arc::new(Mutex::new(VideoMemory::new(video_memory, za_ram))),
            counters: Mutex::new(Account::default()),
            cable: Arc::new(Cable::default()),
            active: AtomicBool::new(true),
            in_scene: AtomicBool::new(false),
        };
        (backplane, fifo_fetch, control_port)
    }

    /// Value of the STATUS register.
    ///
    /// The sources are looked at before `active`: the card's thread becomes active before it takes
    /// anything from them, so work is seen in the one place or in the other.
    pub(crate) fn status(&self) -> u32 {
        let waits = self.fifo.waits() || self.ring.waits();
        let busy = waits || self.active.load(SeqCst);
        [
            (busy, STATUS_BUSY),
            (self.ring.halted(), STATUS_RING_HALTED),
            (self.fifo.halted(), STATUS_FIFO_HALTED),
            (self.in_scene.load(SeqCst), STATUS_IN_SCENE),
        ]
        .iter()
        .filter(|(set, _)| *set)
        .fold(0, |status, (_, bit)| status | bit)
    }

    /// Adds what the card has counted to what the registers show, and empties `counted`.
    pub(crate) fn publish(&self, counted: &mut Account) {
        self.counters.lock().merge(counted);
        counted.clear();
    }
}
