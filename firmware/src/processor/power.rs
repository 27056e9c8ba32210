//! What is called for, and what is powered for it.
//!
//! Duties: OR the effects that draws really use over a scene; power a unit when it is first needed;
//! keep EFFECTS_CALLED and UNITS_POWERED. Begin scene takes power away again from all but the
//! front end (and scan-out while it runs by itself), so a unit that a scene never calls for is
//! never powered in it.

use crate::checked::{Draw, DrawState};
use crate::hardware::Hardware;
use zga_abi::format::{HiddenSurface, Topology};
use zga_abi::{Effects, Reg, Units};

/// Bit 0 of SCANOUT_CONTROL: vertical blanks without present packets.
const SCANOUT_CONTINUOUS: u32 = 1;

/// Effects and units since begin scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Power {
    effects: Effects,
    units: Units,
}

impl Power {
    /// Nothing called for; nothing powered yet.
    pub const fn new() -> Power {
        Power { effects: Effects::empty(), units: Units::empty() }
    }

    /// As a snapshot has it.
    pub const fn restored(effects: Effects, units: Units) -> Power {
        Power { effects, units }
    }

    /// Effects really used since begin scene.
    pub const fn effects(&self) -> Effects {
        self.effects
    }

    /// Units powered now.
    pub const fn units(&self) -> Units {
        self.units
    }

    /// Begin scene: no effects, and only what works without being told to.
    pub fn begin_scene<H: Hardware>(&mut self, hardware: &mut H) {
        let continuous = hardware.register(Reg::ScanoutControl, 0) & SCANOUT_CONTINUOUS != 0;
        let scanout = if continuous { Units::SCANOUT } else { Units::empty() };
        self.set_effects(hardware, Effects::empty());
        self.set_units(hardware, Units::FRONTEND | scanout);
    }

    /// Adds `effects` to the scene's.
    pub fn call<H: Hardware>(&mut self, hardware: &mut H, effects: Effects) {
        self.set_effects(hardware, self.effects | effects);
    }

    /// Sees to it that `units` are powered, and the front end with them.
    pub fn need<H: Hardware>(&mut self, hardware: &mut H, units: Units) {
        self.set_units(hardware, self.units | units | Units::FRONTEND);
    }

    fn set_effects<H: Hardware>(&mut self, hardware: &mut H, effects: Effects) {
        if self.effects != effects {
            self.effects = effects;
            hardware.set_register(Reg::EffectsCalled, 0, effects.bits());
        }
    }

    fn set_units<H: Hardware>(&mut self, hardware: &mut H, units: Units) {
        if self.units != units {
            self.units = units;
            hardware.power(units);
            hardware.set_register(Reg::UnitsPowered, 0, units.bits());
        }
    }
}

/// The effects called for that make a difference to such a draw.
///
/// Colours are interpolated only between vertices that carry one or that light falls on; without anything to
/// interpolate there is nothing to correct for perspective. Over a point nothing varies. Levels and holes are a
/// texture's. Fog whose function is none is no fog.
pub(super) fn really_used(state: &DrawState, draw: &Draw<'_>) -> Effects {
    let mut used = state.effects;
    if state.texture.is_none() {
        used.remove(Effects::MIP_MAP | Effects::PUNCH_THROUGH);
    }
    if state.texture.is_some_and(|texture| texture.levels == 1) {
        used.remove(Effects::MIP_MAP);
    }
    if state.fog.is_none() {
        used.remove(Effects::FOG);
    }
    let lit = state.light.is_some_and(|light| !light.per_pixel);
    if !(draw.coloured || lit) || draw.topology == Topology::Points {
        used.remove(Effects::GOURAUD);
    }
    let varies = used.intersects(Effects::GOURAUD | Effects::TEXTURE | Effects::FOG)
        || state.light.is_some_and(|light| light.per_pixel);
    if !varies || draw.topology == Topology::Points {
        used.remove(Effects::PERSPECTIVE);
    }
    used
}

/// The unit behind a hidden-surface path.
pub(super) const fn path_unit(path: HiddenSurface) -> Units {
    match path {
        HiddenSurface::ZBuffer => Units::Z_BUFFER,
        HiddenSurface::Za => Units::ZA,
        HiddenSurface::Systolic => Units::SYSTOLIC,
        HiddenSurface::Tile => Units::TILE,
    }
}

/// The units that effects need beside geometry and the hidden-surface path.
///
/// `masks`: the scene has a sub-pixel grid, so translucent layers are the mask unit's.
pub(super) fn effect_units(used: Effects, masks: bool) -> Units {
    let shading = Effects::GOURAUD | Effects::LIGHT | Effects::FOG | Effects::BLEND;
    let texture = Effects::TEXTURE | Effects::MIP_MAP | Effects::PUNCH_THROUGH;
    let mut units = Units::empty();
    units.set(Units::SHADING, used.intersects(shading));
    units.set(Units::TEXTURE, used.intersects(texture));
    units.set(Units::SUBPIXEL, masks && used.intersects(Effects::ANTI_ALIAS | Effects::BLEND));
    units
}
