//! Snapshots of the command processor.

use super::power::Power;
use super::scene::{Scene, TARGET_REGISTERS};
use super::{Claim, Processor};
use crate::hardware::Hardware;
use zga_abi::{Effects, Fault, Reg, Units};

/// What a command processor remembers between two packets, as words for a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProcessorState {
    /// 1 between begin scene and end scene, else 0.
    pub in_scene: u32,
    /// Bits of EFFECTS_CALLED.
    pub effects_called: u32,
    /// Bits of UNITS_POWERED.
    pub units_powered: u32,
    /// TARGET_SIZE, COLOUR_BASE, COLOUR_PITCH, COLOUR_FORMAT, DEPTH_BASE, DEPTH_PITCH, DEPTH_FORMAT,
    /// HIDDEN_SURFACE, SUBPIXEL_BITS, FIDELITY, ZA_BLOCK, ZA_PREDICTION, ZA_BASE, SYSTOLIC_VARIANT,
    /// TILE_SIZE, SUBPIXEL_GRID, SUBPIXEL_DEPTH, SUBPIXEL_RESOLVE, SUBPIXEL_POOL, SUBPIXEL_EDGES,
    /// STENCIL_BASE and STENCIL_PITCH as begin scene sampled them; 0 outside a scene.
    pub target: [u32; TARGET_REGISTERS.len()],
}

impl ProcessorState {
    /// Number of words.
    pub const WORDS: usize = 3 + TARGET_REGISTERS.len();

    /// All of it in the order of the fields.
    #[must_use]
    pub fn to_words(&self) -> [u32; ProcessorState::WORDS] {
        let head = [self.in_scene, self.effects_called, self.units_powered];
        let mut words = [0; ProcessorState::WORDS];
        for (word, value) in words.iter_mut().zip(head.into_iter().chain(self.target)) {
            *word = value;
        }
        words
    }

    /// The reverse of [`ProcessorState::to_words`].
    #[must_use]
    pub fn from_words(words: &[u32; ProcessorState::WORDS]) -> ProcessorState {
        let &[in_scene, effects_called, units_powered, ref target @ ..] = words;
        ProcessorState { in_scene, effects_called, units_powered, target: *target }
    }
}

impl Processor {
    /// Everything to begin again from here.
    #[must_use]
    pub fn state(&self) -> ProcessorState {
        ProcessorState {
            in_scene: u32::from(self.in_scene()),
            effects_called: self.effects_called().bits(),
            units_powered: self.units_powered().bits(),
            target: self.scene.map_or([0; TARGET_REGISTERS.len()], |scene| scene.registers),
        }
    }

    /// The command processor of a snapshot, on a card whose memory size and capabilities are set.
    ///
    /// No unit is called: the card powers [`Processor::units_powered`] and begins the scene of
    /// [`Processor::target`] itself.
    ///
    /// # Errors
    /// A snapshot is an allegation like a packet; the fault names the register whose value cannot
    /// be (STATUS stands for `in_scene`), as for registers sampled by a packet.
    pub fn from_state<H: Hardware>(hardware: &H, state: &ProcessorState) -> Result<Processor, Fault> {
        let in_scene = Claim::register(Reg::Status, state.in_scene);
        in_scene.require(in_scene.value <= 1)?;
        let effects = Claim::register(Reg::EffectsCalled, state.effects_called);
        let effects = effects.mean(Effects::from_bits(effects.value))?;
        let units = Claim::register(Reg::UnitsPowered, state.units_powered);
        let units = units.mean(Units::from_bits(units.value))?;
        let scene = if state.in_scene == 1 { Some(Scene::check(hardware, state.target)?) } else { None };
        Ok(Processor { scene, power: Power::restored(effects, units) })
    }
}
