//! Mapped memory: video memory as the host's program sees it, without the bus in between.
//!
//! Duties: gives the words away while the card keeps its hands off them.
//! Inputs: reads and writes of the host. Outputs: words; [`VideoMemory::generation`] moves when they may change.
//! Clocks: none, as for bursts; the host pays.

use super::VideoMemory;
use parking_lot::{ArcMutexGuard, Mutex, RawMutex};
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// All words of a card's video memory, from byte 0 on, for as long as this lives: the card's arbitration is the host's.
///
/// Meanwhile the card executes no packet, shows no new frame, and every access to video or Za RAM by a bus waits: to
/// wait for a fence while a mapping lives is to wait for ever. What a frame holds that is cleared in Za RAM only does not
/// stand in these words, as it does not for bursts.
///
/// The words stay at one address from power-on on, so a pointer to them that is only used while some mapping lives is good.
pub struct MappedMemory {
    memory: ArcMutexGuard<RawMutex, VideoMemory>,
}

impl MappedMemory {
    /// Waits for the card to come to the end of its packet.
    pub(crate) fn new(memory: &Arc<Mutex<VideoMemory>>) -> MappedMemory {
        MappedMemory { memory: memory.lock_arc() }
    }
}

impl Deref for MappedMemory {
    type Target = [u32];

    fn deref(&self) -> &[u32] {
        self.memory.words()
    }
}

impl DerefMut for MappedMemory {
    fn deref_mut(&mut self) -> &mut [u32] {
        self.memory.words_mut()
    }
}

impl fmt::Debug for MappedMemory {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "MappedMemory({} words)", self.len())
    }
}
