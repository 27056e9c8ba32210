//! Effects of a draw beside depth and colour: texture, holes, light, fog, blending, stencil.
//!
//! Duties: keeps what the user has set, and wants the registers of an effect where a draw calls for it. Inputs from:
//! the user. Outputs to: every draw. An effect that a draw does not call for sends nothing.
//!
//! | effect | called for by |
//! | --- | --- |
//! | texture | draws whose vertices have texture coordinates, while a texture is set |
//! | MIP map | the same, if the texture has levels beyond the first |
//! | punch-through | the same, while it is set and the texture can have holes |
//! | light | draws whose vertices have normals, while there are lights or an ambient light |
//! | fog | every draw, while it is set |
//! | blend | every draw, while it is set |
//! | stencil | every draw, while it is set |

mod fog;
mod light;
mod mip_map;
mod stencil;
mod texels;
mod texture;

use zga_abi::Effects;
use zga_abi::bus::Bus;
use zga_abi::format::{BlendMode, Topology};
use zga_abi::packet::DrawFlags;
use zga_abi::registers::Reg;

use crate::memory::Allocation;
use crate::{Driver, DriverError};
pub use fog::{Fog, FogCurve};
use light::LightState;
pub use light::{Light, LightSource, Material};
pub use stencil::{Shadow, Stencil, StencilSide};
pub(crate) use texture::TextureRecord;
use texture::TextureSetting;
pub use texture::{Texture, TextureOptions, TextureState};

/// How what is drawn with an alpha below 255 is combined with what lies behind it; see [`Driver::set_blend`].
///
/// `true` is [`BlendMode::Alpha`], `false` and `None` do not blend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Blend(pub Option<BlendMode>);

impl From<bool> for Blend {
    fn from(blend: bool) -> Blend {
        Blend(blend.then_some(BlendMode::Alpha))
    }
}

impl From<BlendMode> for Blend {
    fn from(mode: BlendMode) -> Blend {
        Blend(Some(mode))
    }
}

impl From<Option<BlendMode>> for Blend {
    fn from(mode: Option<BlendMode>) -> Blend {
        Blend(mode)
    }
}

/// What the user has set.
#[derive(Debug)]
pub(crate) struct EffectState {
    texture: Option<TextureSetting>,
    punch_through: Option<u8>,
    blend: Option<BlendMode>,
    fog: Option<Fog>,
    light: LightState,
    stencil: Option<Stencil>,
    shadow: Option<Shadow>,
}

impl EffectState {
    pub fn new() -> EffectState {
        EffectState {
            texture: None,
            punch_through: None,
            blend: None,
            fog: None,
            light: LightState::new(),
            stencil: None,
            shadow: None,
        }
    }

    /// Lights stand elsewhere in eye space.
    pub const fn camera_changed(&mut self) {
        self.light.due = true;
    }
}

impl<B: Bus> Driver<B> {
    /// Texels with an alpha below the reference are holes in what is drawn with the texture, whatever lies behind;
    /// `None` for no holes, as after opening.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card that has no holes. The setting stays as it was.
    pub fn set_punch_through(&mut self, reference: Option<u8>) -> Result<(), DriverError> {
        if reference.is_some() {
            self.has_effect(Effects::PUNCH_THROUGH, "punch-through textures")?;
        }
        self.state.effects.punch_through = reference;
        Ok(())
    }

    /// How the draws that follow are combined with what lies behind them: what they draw is a layer over it, whatever
    /// comes first. Not at all after opening. `true` is [`BlendMode::Alpha`].
    ///
    /// Layers are composed when the scene ends, from the farthest to the nearest, with and without anti-aliasing.
    ///
    /// ```
    /// use zga_abi::{Reg, format::BlendMode};
    /// # use zga_driver::{Driver, DriverError, bus::MockBus};
    /// # let mut bus = MockBus::new(1 << 20);
    /// # bus.set_register(Reg::CapabilityEffects, 0xFFF);
    /// let mut driver = Driver::open(bus)?;
    /// driver.set_blend(BlendMode::Add)?;
    /// driver.set_blend(true)?;
    /// driver.set_blend(None)?;
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card that cannot blend. The setting stays as it was.
    pub fn set_blend(&mut self, blend: impl Into<Blend>) -> Result<(), DriverError> {
        let Blend(mode) = blend.into();
        if mode.is_some() {
            self.has_effect(Effects::BLEND, "translucency")?;
        }
        self.state.effects.blend = mode;
        Ok(())
    }

    /// How the draws that follow blend.
    #[must_use]
    pub const fn blend(&self) -> Option<BlendMode> {
        self.state.effects.blend
    }

    /// The effects that a draw of such vertices calls for; wants their registers. `gouraud`: the colours of the
    /// vertices differ within a primitive. Lights are placed already.
    pub(crate) fn want_effects(&mut self, flags: DrawFlags, gouraud: bool) -> Effects {
        let light = self.is_lit(flags).then(|| self.want_light());
        let mut effects = Effects::empty();
        if flags.coordinates {
            effects |= self.want_texture();
        }
        if let Some(fog) = self.state.effects.fog {
            self.want_fog(&fog);
            effects |= Effects::FOG;
        }
        if let Some(mode) = self.state.effects.blend {
            self.registers.want(Reg::BlendControl, &[mode.code()]);
            effects |= Effects::BLEND;
        }
        if let Some(stencil) = self.state.effects.stencil {
            self.want_stencil(&stencil);
            effects |= Effects::STENCIL;
        }
        effects.set(Effects::LIGHT, light.is_some());
        // Nothing varies over a point.
        if flags.topology != Topology::Points {
            let at_vertices = light.is_some_and(|material| !material.per_pixel);
            effects.set(Effects::GOURAUD, gouraud || at_vertices);
            let interpolates = Effects::GOURAUD | Effects::TEXTURE | Effects::LIGHT | Effects::FOG;
            let perspective = effects.intersects(interpolates) && self.state.camera.is_perspective();
            effects.set(Effects::PERSPECTIVE, perspective);
        }
        effects
    }

    /// Gives memory back that draws of the open scene may read until its end, and again if it has to be repeated.
    pub(crate) fn free_after_scene(&mut self, allocation: Allocation) -> Result<(), DriverError> {
        if self.scene.is_none() {
            return self.free(allocation);
        }
        self.scene_memory.push(allocation);
        Ok(())
    }

    /// The scene has ended.
    pub(crate) fn free_scene_memory(&mut self) -> Result<(), DriverError> {
        std::mem::take(&mut self.scene_memory).into_iter().try_for_each(|allocation| self.free(allocation))
    }

    /// Checks that the card has the units for an effect.
    pub(crate) fn has_effect(&self, effect: Effects, what: &'static str) -> Result<(), DriverError> {
        if self.info.effects.contains(effect) {
            return Ok(());
        }
        Err(DriverError::Unsupported { what, register: "CAPABILITY_EFFECTS", found: self.info.effects.bits() })
    }
}
