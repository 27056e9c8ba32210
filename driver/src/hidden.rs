//! Who decides visibility, and the settings of those who do.
//!
//! Duties: checks the settings, gives each frame its words in Za RAM, and wants the registers that BEGIN_SCENE
//! samples. Inputs from: the user. Outputs to: [`Driver::begin_scene`]. Which path draws is one setting; every
//! path makes the same picture. Registers of a path travel only when a scene uses it.

use zga_abi::bus::Bus;
use zga_abi::format::{EndTest, Fidelity, HiddenSurface, TokenColour, TokenPorts, ZaPrediction};
use zga_abi::packet::{Opcode, header};
use zga_abi::registers::Reg;

use crate::memory::{Alignment, Allocation};
use crate::{Driver, DriverError};

/// Longest side of a Za block, pixels.
const MOST_BLOCK_SIDE: u32 = 16384;
/// Sides that a tile can have, pixels.
const TILE_SIDES: [u32; 5] = [4, 8, 16, 32, 64];
/// Bytes of a word of Za RAM.
const ZA_WORD: u64 = 4;
/// Bit 8 of ZA_PREDICTION.
const NO_BYPASS: u32 = 1 << 8;

/// Settings of the Za unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ZaSettings {
    /// Width and height of the block of pixels that shares a word, each 1..=16384 pixels.
    pub block: [u32; 2],
    /// How the least depth of a primitive in a block is predicted.
    pub prediction: ZaPrediction,
    /// Blocks behind the prediction are bypassed.
    pub bypass: bool,
}

impl Default for ZaSettings {
    /// As published: 32 pixels of a row, prediction over the length of a block.
    fn default() -> Self {
        ZaSettings { block: [32, 1], prediction: ZaPrediction::BlockLength, bypass: true }
    }
}

impl ZaSettings {
    /// Bytes of Za RAM that a frame of so many pixels needs.
    #[must_use]
    pub const fn frame_bytes(&self, width: u32, height: u32) -> u64 {
        let [across, down] = [width.div_ceil(self.block[0]), height.div_ceil(self.block[1])];
        ZA_WORD * across as u64 * down as u64
    }
}

/// Variant of the systolic array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SystolicVariant {
    /// When an element sees that a segment has begun or ended.
    pub end_test: EndTest,
    /// How X and dX of a segment enter.
    pub ports: TokenPorts,
    /// What a token carries for the picture.
    pub colour: TokenColour,
    /// The earlier design in place of the array: a token a clock, refresh data flow back.
    pub super_buffer: bool,
}

impl Default for SystolicVariant {
    fn default() -> Self {
        SystolicVariant {
            end_test: EndTest::Negative,
            ports: TokenPorts::Swapped,
            colour: TokenColour::Tag,
            super_buffer: false,
        }
    }
}

impl SystolicVariant {
    /// The value of SYSTOLIC_VARIANT.
    const fn code(self) -> u32 {
        self.end_test.code() | self.ports.code() << 1 | self.colour.code() << 2 | (self.super_buffer as u32) << 3
    }
}

/// What the user has set, sampled by the next begin scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HiddenState {
    pub surface: HiddenSurface,
    pub fidelity: Fidelity,
    pub za: ZaSettings,
    pub systolic: SystolicVariant,
    pub tile: [u32; 2],
    pub keep_depth: bool,
}

impl HiddenState {
    pub fn new() -> HiddenState {
        HiddenState {
            surface: HiddenSurface::ZBuffer,
            fidelity: Fidelity::Functional,
            za: ZaSettings::default(),
            systolic: SystolicVariant::default(),
            tile: [8, 8],
            keep_depth: true,
        }
    }

    /// A scene drawn like this uses the target's Z buffer.
    pub const fn uses_z_buffer(&self) -> bool {
        self.keep_depth || !matches!(self.surface, HiddenSurface::Systolic | HiddenSurface::Tile)
    }
}

/// Areas of a target's frames in Za RAM.
#[derive(Debug, Default)]
pub(crate) struct ZaAreas {
    /// One for each frame buffer; none if Za RAM has no room for all, then they share its beginning.
    frames: Vec<Allocation>,
    /// Bytes that each was made for: what the worst block shape so far needs.
    bytes: u64,
}

impl ZaAreas {
    /// First byte of the words of frame `frame`.
    fn base(&self, frame: usize) -> u32 {
        self.frames.get(frame).map_or(0, Allocation::address)
    }
}

impl<B: Bus> Driver<B> {
    /// Sets who decides visibility, from the next begin scene on; the plain Z buffer after opening.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] if the card has not this path.
    pub fn set_hidden_surface(&mut self, path: HiddenSurface) -> Result<(), DriverError> {
        if !self.info.has_path(path) {
            return Err(self.no_path(path.name()));
        }
        self.state.hidden.surface = path;
        Ok(())
    }

    /// Who decides visibility from the next begin scene on.
    #[must_use]
    pub const fn hidden_surface(&self) -> HiddenSurface {
        self.state.hidden.surface
    }

    /// Sets how units that have a clocked model are simulated, from the next begin scene on; functional after
    /// opening. Pixels, counters and clocks do not depend on it.
    ///
    /// A change waits for all work and is written past the stream of packets: how a card is simulated must not
    /// show in what the stream costs.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] for clocked on a card none of whose paths has such a model, or as
    /// [`Driver::finish`]; it stays as it was.
    pub fn set_fidelity(&mut self, fidelity: Fidelity) -> Result<(), DriverError> {
        if fidelity == Fidelity::Clocked && !self.info.has_clocked_model() {
            return Err(self.no_path("path with a clocked model"));
        }
        if fidelity != self.state.hidden.fidelity {
            self.finish()?;
            self.adopt_recovered();
            self.bus.write32(Reg::Fidelity.offset(), fidelity.code());
            let written = [header(Opcode::RegisterWrite, 2), Reg::Fidelity.offset(), fidelity.code()];
            self.registers.follow(&written);
            self.queue.note_registers(&written);
            self.state.hidden.fidelity = fidelity;
        }
        Ok(())
    }

    /// Sets up the Za unit, from the next begin scene on that uses it.
    ///
    /// Each frame buffer of a target gets words of its own in Za RAM, enough for the finest blocks it was ever
    /// drawn with, so that its logical clears last while others are drawn. Where Za RAM has no room for all of
    /// a target's frames they share its beginning: the picture is the same, but the card must write out the
    /// cleared blocks of one frame before it begins another.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for a block side of 0 or over 16384. Whether Za RAM can hold a frame is known
    /// with its target: [`Driver::begin_scene`] tells.
    pub fn set_za(&mut self, settings: ZaSettings) -> Result<(), DriverError> {
        let [width, height] = settings.block;
        if !settings.block.iter().all(|side| (1..=MOST_BLOCK_SIDE).contains(side)) {
            return Err(DriverError::BadOption {
                name: "Za block",
                found: format!("{width} x {height}"),
                expected: "1 to 16384 pixels each way",
            });
        }
        self.state.hidden.za = settings;
        Ok(())
    }

    /// Sets the variant of the systolic array, from the next begin scene on that uses it.
    pub const fn set_systolic(&mut self, variant: SystolicVariant) {
        self.state.hidden.systolic = variant;
    }

    /// Sets width and height of a tile of the tile unit, from the next begin scene on that uses it; 8 x 8 after
    /// opening.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for sides other than 4, 8, 16, 32 and 64 pixels.
    pub fn set_tile_size(&mut self, [width, height]: [u32; 2]) -> Result<(), DriverError> {
        if ![width, height].iter().all(|side| TILE_SIDES.contains(side)) {
            return Err(DriverError::BadOption {
                name: "tile size",
                found: format!("{width} x {height}"),
                expected: "4, 8, 16, 32 or 64 pixels each way",
            });
        }
        self.state.hidden.tile = [width, height];
        Ok(())
    }

    /// Whether scenes leave their depths in the target's Z buffer on every path; true after opening.
    ///
    /// The systolic array and the tile unit decide visibility in registers of their own. With `false` a scene
    /// on these two paths is given no Z buffer: nothing is loaded or stored, depth begins at the farthest, and
    /// is gone when the scene ends. That is right for scenes that begin with a clear of all depth and whose
    /// depths nobody reads; a scene that draws before it has cleared all depth gets
    /// [`crate::Warning::DepthBeginsFar`]. The plain Z buffer and the Za path keep depths in any case.
    pub const fn set_keep_depth(&mut self, keep: bool) {
        self.state.hidden.keep_depth = keep;
    }

    /// Wants what begin scene samples of the path, for a scene on target `id` that draws to frame `frame`.
    pub(crate) fn want_path(&mut self, id: u32, frame: usize) -> Result<(), DriverError> {
        let HiddenState { surface, fidelity, za, systolic, tile: [tile_width, tile_height], .. } = self.state.hidden;
        match surface {
            HiddenSurface::ZBuffer => {}
            HiddenSurface::Za => {
                let base = self.place_za_words(id, frame)?;
                let [width, height] = za.block;
                let prediction = za.prediction.code() | if za.bypass { 0 } else { NO_BYPASS };
                self.registers.want(Reg::ZaBlock, &[width | height << 16]);
                self.registers.want(Reg::ZaPrediction, &[prediction]);
                self.registers.want(Reg::ZaBase, &[base]);
            }
            HiddenSurface::Systolic => self.registers.want(Reg::SystolicVariant, &[systolic.code()]),
            HiddenSurface::Tile => self.registers.want(Reg::TileSize, &[tile_width | tile_height << 16]),
        }
        self.registers.want(Reg::HiddenSurface, &[surface.code()]);
        // Sent only where a recovery has put back what was before.
        self.registers.want(Reg::Fidelity, &[fidelity.code()]);
        Ok(())
    }

    /// First byte in Za RAM of the words of a frame. Areas only grow: finer blocks move them, coarser do not.
    fn place_za_words(&mut self, id: u32, frame: usize) -> Result<u32, DriverError> {
        let Driver { targets, za_ram, state, info, .. } = self;
        let target = targets.get_mut(&id).ok_or(DriverError::UnknownTarget { id })?;
        let (width, height, block) = (target.options.width, target.options.height, state.hidden.za.block);
        let needed = state.hidden.za.frame_bytes(width, height);
        if needed > u64::from(info.za_ram) {
            return Err(DriverError::ZaRamTooSmall { width, height, block, needed, has: info.za_ram });
        }
        if needed > target.za.bytes {
            for area in target.za.frames.drain(..) {
                za_ram.free(area)?;
            }
            target.za.bytes = needed;
            for _ in 0..target.frames() {
                match za_ram.allocate(needed, Alignment::Line) {
                    Ok(area) => target.za.frames.push(area),
                    Err(_) => {
                        for area in target.za.frames.drain(..) {
                            za_ram.free(area)?;
                        }
                        break;
                    }
                }
            }
        }
        Ok(target.za.base(frame))
    }

    /// Gives the words of a target that is gone back.
    pub(crate) fn free_za_words(&mut self, areas: ZaAreas) -> Result<(), DriverError> {
        for area in areas.frames {
            self.za_ram.free(area)?;
        }
        Ok(())
    }

    fn no_path(&self, what: &'static str) -> DriverError {
        DriverError::Unsupported { what, register: "CAPABILITY_PATHS", found: self.info.paths }
    }
}
