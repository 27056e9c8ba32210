//! What the card says about itself: identification, counters, effects and units of the last scene.

use zga_abi::bus::{Bus, FLOATING, MEMORY_BYTES};
use zga_abi::format::HiddenSurface;
use zga_abi::registers::Reg;
use zga_abi::{ABI_VERSION, Counter, Effects, IDENTIFICATION, Units};

use crate::{Driver, DriverError};

/// What a card is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CardInfo {
    /// Major version of registers and packets.
    pub major: u32,
    /// Minor version of registers and packets.
    pub minor: u32,
    /// Effects that it has a unit for.
    pub effects: Effects,
    /// CAPABILITY_PATHS: bit k stands for value k of HIDDEN_SURFACE.
    pub paths: u32,
    /// Video memory in bytes.
    pub video_memory: u32,
    /// Za RAM in bytes.
    pub za_ram: u32,
    /// Depth of the PIO FIFO in words.
    pub fifo_words: u32,
}

impl CardInfo {
    /// Reads the identification block.
    pub(crate) fn read<B: Bus>(bus: &mut B) -> Result<CardInfo, DriverError> {
        let mut block = [0; 7];
        bus.read_burst(Reg::Identification.offset(), &mut block);
        let [found, revision, effects, paths, video_memory, za_ram, fifo_words] = block;
        if found == FLOATING {
            return Err(DriverError::NoCard { found });
        }
        if found != IDENTIFICATION {
            return Err(DriverError::NotThisCard { found, expected: IDENTIFICATION });
        }
        let (major, minor, expected) = (revision >> 16, revision & 0xFFFF, ABI_VERSION >> 16);
        if major != expected {
            return Err(DriverError::UnknownRevision { major, minor, expected });
        }
        // More memory than the window shows cannot be reached.
        let video_memory = video_memory.min(MEMORY_BYTES);
        let effects = Effects::from_bits_truncate(effects);
        Ok(CardInfo { major, minor, effects, paths, video_memory, za_ram, fifo_words })
    }

    /// Whether the card has this hidden-surface path.
    #[must_use]
    pub const fn has_path(&self, path: HiddenSurface) -> bool {
        self.paths >> path.code() & 1 == 1
    }

    /// Whether one of its paths has a clocked model: all but the plain Z buffer do.
    #[must_use]
    pub const fn has_clocked_model(&self) -> bool {
        self.has_path(HiddenSurface::Za) || self.has_path(HiddenSurface::Systolic) || self.has_path(HiddenSurface::Tile)
    }
}

/// All counters at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    values: Vec<u64>,
}

impl Counters {
    /// The value of one counter.
    #[must_use]
    pub fn get(&self, counter: Counter) -> u64 {
        self.values.get(counter as usize).copied().unwrap_or(0)
    }

    /// Names and values, in register order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, u64)> {
        Counter::ALL.iter().map(|counter| counter.name()).zip(self.values.iter().copied())
    }

    /// The value of the counter with this name in reports.
    #[must_use]
    pub fn by_name(&self, name: &str) -> Option<u64> {
        self.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
    }
}

impl<B: Bus> Driver<B> {
    /// What the card is; read once when it was opened.
    #[must_use]
    pub const fn card_info(&self) -> &CardInfo {
        &self.info
    }

    /// Reads all counters as they stand. Wait for a fence first: work under way still counts.
    pub fn counters(&mut self) -> Counters {
        let mut words = vec![0; 2 * Counter::COUNT];
        self.bus.read_burst(Reg::Counters.offset(), &mut words);
        let values = words.chunks_exact(2).map(|pair| u64::from(pair[0]) | u64::from(pair[1]) << 32).collect();
        Counters { values }
    }

    /// Sets every counter to 0.
    pub fn clear_counters(&mut self) {
        self.bus.write32(Reg::CounterControl.offset(), 1);
    }

    /// Effects called since the last begin scene that the card has executed.
    pub fn effects_called(&mut self) -> Effects {
        Effects::from_bits_truncate(self.bus.read32(Reg::EffectsCalled.offset()))
    }

    /// Units powered since the last begin scene that the card has executed.
    pub fn units_powered(&mut self) -> Units {
        Units::from_bits_truncate(self.bus.read32(Reg::UnitsPowered.offset()))
    }
}
