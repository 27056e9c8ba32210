//! Scenes: BEGIN_SCENE, END_SCENE, CLEAR.
//!
//! Begin scene samples target, path and accuracy registers; until end scene they can be written
//! without effect. Begin and end do not nest. Clears and draws are valid inside a scene only; every
//! other packet is valid anywhere.

use super::claim::Claim;
use super::memory::VideoMemory;
use super::power::path_unit;
use super::{Processor, at_header, bad_length, effects, outcome, registers};
use crate::checked::{Clear, DepthSurface, StencilSurface, Surface, Target};
use crate::hardware::Hardware;
use zga_abi::format::HiddenSurface;
use zga_abi::packet::{CLEAR_COLOUR, CLEAR_DEPTH, CLEAR_STENCIL, CLEAR_STENCIL_SHIFT};
use zga_abi::{Effects, Fault, FaultCode, Reg};

/// Bytes of a depth in video memory.
const DEPTH_BYTES: u32 = 4;

/// The registers that begin scene samples.
pub(super) const TARGET_REGISTERS: [Reg; 22] = [
    Reg::TargetSize,
    Reg::ColourBase,
    Reg::ColourPitch,
    Reg::ColourFormat,
    Reg::DepthBase,
    Reg::DepthPitch,
    Reg::DepthFormat,
    Reg::HiddenSurface,
    Reg::SubpixelBits,
    Reg::Fidelity,
    Reg::ZaBlock,
    Reg::ZaPrediction,
    Reg::ZaBase,
    Reg::SystolicVariant,
    Reg::TileSize,
    Reg::SubpixelGrid,
    Reg::SubpixelDepth,
    Reg::SubpixelResolve,
    Reg::SubpixelPool,
    Reg::SubpixelEdges,
    Reg::StencilBase,
    Reg::StencilPitch,
];

/// A scene that was begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scene {
    /// Values of [`TARGET_REGISTERS`] when it was begun.
    pub registers: [u32; TARGET_REGISTERS.len()],
    /// What they mean.
    pub target: Target,
}

impl Scene {
    /// The scene that register values describe, on a card like `hardware`.
    pub fn check<H: Hardware>(hardware: &H, values: [u32; TARGET_REGISTERS.len()]) -> Result<Scene, Fault> {
        let mut claims = TARGET_REGISTERS.map(|register| Claim::register(register, 0));
        for (claim, value) in claims.iter_mut().zip(values) {
            claim.value = value;
        }
        let [
            size,
            colour_base,
            colour_pitch,
            colour_format,
            depth_base,
            depth_pitch,
            depth_format,
            path,
            subpixel_bits,
            fidelity,
            za_block,
            za_prediction,
            za_base,
            systolic,
            tile,
            grid,
            subpixel_depth,
            resolve,
            pool,
            edges,
            stencil_base,
            stencil_pitch,
        ] = claims;
        let memory = VideoMemory::of(hardware);

        let (width, height) = registers::size(size)?;
        let format = registers::pixel_format(colour_format)?;
        let colour_span = memory.frame(colour_base, colour_pitch, width * format.bytes(), height)?;
        let colour = Surface { base: colour_base.value, pitch: colour_pitch.value, width, height, format };

        let depth_format = registers::depth_format(depth_format)?;
        let mut taken = [Some(colour_span), None];
        let depth = if depth_pitch.value == 0 {
            None
        } else {
            let span = memory.frame(depth_base, depth_pitch, width * DEPTH_BYTES, height)?;
            if span.overlaps(colour_span) {
                return Err(depth_base.refuse(FaultCode::Overlap));
            }
            taken[1] = Some(span);
            Some(DepthSurface { base: depth_base.value, pitch: depth_pitch.value })
        };
        let stencil = if stencil_pitch.value == 0 {
            None
        } else {
            let span = memory.frame(stencil_base, stencil_pitch, width, height)?;
            if taken.into_iter().flatten().any(|other| span.overlaps(other)) {
                return Err(stencil_base.refuse(FaultCode::Overlap));
            }
            Some(StencilSurface { base: stencil_base.value, pitch: stencil_pitch.value })
        };

        let hidden_surface = registers::hidden_surface(path, hardware.register(Reg::CapabilityPaths, 0))?;
        let za = registers::za(za_block, za_prediction, za_base)?;
        if hidden_surface == HiddenSurface::Za {
            let [across, down] = za.blocks(width, height);
            let end = u64::from(za_base.value) + 4 * u64::from(across) * u64::from(down);
            if end > u64::from(hardware.register(Reg::ZaRamSize, 0)) {
                return Err(za_base.refuse(FaultCode::OutOfMemory));
            }
        }
        let target = Target {
            colour,
            depth,
            depth_format,
            subpixel_bits: registers::subpixel_bits(subpixel_bits)?,
            hidden_surface,
            fidelity: registers::fidelity(fidelity)?,
            za,
            systolic: registers::systolic(systolic),
            tile: registers::tile_size(tile)?,
            subpixel: registers::subpixel(
                hardware.register(Reg::CapabilityEffects, 0),
                grid,
                subpixel_depth,
                resolve,
                pool,
                edges,
            )?,
            stencil,
        };
        Ok(Scene { registers: values, target })
    }
}

impl Processor {
    /// The target of the scene; OUTSIDE_SCENE without one.
    pub(super) fn scene_target(&self, packet: &[u32]) -> Result<Target, Fault> {
        match self.scene {
            Some(scene) => Ok(scene.target),
            None => Err(at_header(FaultCode::OutsideScene, packet)),
        }
    }

    /// BEGIN_SCENE.
    pub(super) fn begin_scene<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        if self.in_scene() {
            return Err(at_header(FaultCode::InsideScene, packet));
        }
        let values = TARGET_REGISTERS.map(|register| hardware.register(register, 0));
        let scene = Scene::check(hardware, values)?;
        self.power.begin_scene(hardware);
        hardware.begin_scene(&scene.target);
        self.scene = Some(scene);
        Ok(())
    }

    /// END_SCENE. The scene is over even when the watchdog stops it.
    pub(super) fn end_scene<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let target = self.scene_target(packet)?;
        // A scene that calls for no stencil test has no shadows.
        let called = target.stencil.is_some() && self.power.effects().contains(Effects::STENCIL);
        let shadow = if called { effects::shadow(hardware)? } else { None };
        self.scene = None;
        outcome(hardware.end_scene(shadow.as_ref()))
    }

    /// CLEAR: planes, colour, depth. The value of a plane that is not cleared does not matter.
    pub(super) fn clear<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, planes, colour, depth] = packet else {
            return Err(bad_length(packet));
        };
        let target = self.scene_target(packet)?;
        let planes = Claim::word(1, planes);
        let depth = Claim::word(3, depth);
        let clears = |plane| planes.value & plane != 0;

        // The stencil plane's value stands beside its bit.
        let mut known = CLEAR_COLOUR | CLEAR_DEPTH;
        if clears(CLEAR_STENCIL) {
            known |= CLEAR_STENCIL | (0xFF << CLEAR_STENCIL_SHIFT);
        }
        planes.require(planes.value & !known == 0)?;
        planes.require(target.stencil.is_some() || !clears(CLEAR_STENCIL))?;
        if clears(CLEAR_DEPTH) {
            planes.require(target.has_depth())?;
            depth.require(depth.value <= target.depth_format.maximum())?;
        }
        if planes.value == 0 {
            return Ok(());
        }
        let probe = registers::probe_unit(hardware)?;

        self.power.need(hardware, path_unit(target.hidden_surface) | probe);
        hardware.clear(&Clear {
            colour: clears(CLEAR_COLOUR).then_some(colour),
            depth: clears(CLEAR_DEPTH).then_some(depth.value),
            stencil: clears(CLEAR_STENCIL).then_some((planes.value >> CLEAR_STENCIL_SHIFT) as u8),
            area: registers::scissor(hardware, target.colour.width, target.colour.height),
        });
        Ok(())
    }
}
