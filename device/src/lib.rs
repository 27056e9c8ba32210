//! The ZGA card: a memory-mapped graphics adapter in software.
//!
//! A [`Card`] behaves as a board does. Its own thread takes command packets from a ring in video
//! memory or from a PIO FIFO, its firmware checks them and programs its units, and it answers with
//! fences, interrupts and frames. The host sees it through [`CardBus`] (an implementation of
//! [`zga_abi::Bus`]) and [`Monitor`], and through nothing else.
//!
//! ```text
//!        host: any number of threads                         host: display
//!          |  CardBus: read32, write32, bursts, wait              ^ Monitor
//!  ========|======================================================|====== edge connector
//!          v                                                      |
//!   +-- bus ---------+   registers   +-- frontend ----------+     |
//!   | address decode |<------------->| register file, STATUS|     |
//!   | interrupts     |   words       | FIFO, 1024 words     |     |
//!   |                |-------------->| ring fetch           |     |
//!   +------|---------+               +----------|-----------+     |
//!          |                                    | whole packets   |
//!          |                         +----------v-----------+     |
//!          |                         | zga_firmware:        |     |
//!          |                         | Processor checks all |     |
//!          |                         +---|--------------|---+     |
//!          |            checked draws    |              | fills, copies
//!          |      +----------------------v--+   +-------v--+   +--+------+
//!          |      | pipeline                |   | bitmap   |   | scanout |
//!          |      | geometry > hidden >     |   |          |   |         |
//!          |      | shading, texture        |   |          |   |         |
//!          |      +-----------|-------------+   +-----|----+   +----^----+
//!          | bursts           | pixels, depths        |             | pixels
//!   +------v------------------v-----------------------v-------------|----+
//!   | memory: video memory, one lock; the card's thread lets go of it     |
//!   | between packets; Za RAM                                             |
//!   +---------------------------------------------------------------------+
//!     probe: every unit charges its clocks and events; pixel history; snapshots
//! ```
//!
//! # The way of a command
//! 1. The host writes packets into the ring and rings the doorbell, or pushes them into the FIFO. A
//!    full FIFO stalls the writer; nothing is dropped.
//! 2. `frontend` puts a whole packet in one piece before the firmware, ring and FIFO in turn.
//! 3. The firmware refuses it, which halts its source and raises the error interrupt, or tells the
//!    units what to do.
//! 4. The units work in video memory and charge their clocks.
//! 5. A fence stores its number and raises an interrupt; a present puts a frame on the cable.
//!
//! # Example
//! Fill a rectangle through the FIFO window, wait for the fence, read the memory back:
//! ```
//! use std::time::Duration;
//! use zga_abi::bus::{Bus, FIFO_BASE, INTERRUPT_FENCE, MEMORY_BASE};
//! use zga_abi::packet::{Opcode, header};
//! use zga_abi::Reg;
//! use zga_device::{Card, CardOptions};
//!
//! # fn main() -> Result<(), zga_device::CardError> {
//! let card = Card::power_on(CardOptions { video_memory: 1 << 20, ..CardOptions::default() })?;
//! let mut bus = card.bus();
//! assert_eq!(bus.read32(Reg::Identification.offset()), 0x5A47_4131);
//!
//! bus.write32(Reg::InterruptEnable.offset(), INTERRUPT_FENCE);
//! // Base 0, pitch 256 bytes, XRGB8888; 3 x 2 pixels from (1, 1) on; red.
//! bus.write_burst(FIFO_BASE, &[header(Opcode::Fill, 8), 0, 256, 0, 1, 1, 3, 2, 0xFFFF_0000]);
//! bus.write_burst(FIFO_BASE, &[header(Opcode::Fence, 1), 7]);
//! assert_eq!(bus.wait_interrupt(INTERRUPT_FENCE, Duration::from_secs(10)), INTERRUPT_FENCE);
//! assert_eq!(bus.read32(Reg::FenceSequence.offset()), 7);
//!
//! let mut row = [0; 5];
//! bus.read_burst(MEMORY_BASE + 256, &mut row);
//! assert_eq!(row, [0, 0xFFFF_0000, 0xFFFF_0000, 0xFFFF_0000, 0]);
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod bitmap;
mod built;
mod bus;
mod card;
mod door;
mod error;
mod frontend;
mod geometry;
mod hidden;
mod layers;
mod memory;
mod pipeline;
mod probe;
mod scanout;
mod shading;
mod subpixel;
pub mod texture;

/// What the units of the hidden-surface paths are built from, for reports.
pub mod cost {
    /// Systolic array: adders, comparators, register bits and gates of its variants.
    pub mod systolic {
        pub use crate::hidden::systolic::gates::{Cost, Variant, Widths, clamp, element};
    }
    /// Tile unit: register bits and buffer bytes.
    pub mod tile {
        pub use crate::hidden::tile::storage::*;
    }
}

/// Lights and fog of the shading unit by themselves, to measure them.
pub mod effects {
    pub use crate::shading::fog::FogMixer;
    pub use crate::shading::light::{Lights, normal_matrix};
}

pub use bus::CardBus;
pub use door::{Card, CardOptions};
pub use error::CardError;
pub use memory::MappedMemory;
pub use pipeline::Kernel;
pub use probe::account::Clocks;
pub use probe::snapshot::Snapshot;
pub use scanout::monitor::{Connector, Frame, Monitor};
pub use subpixel::map::{Reason, SubpixelMap};
