//! Stencil test and shadow bit.

use zga_abi::Effects;
use zga_abi::bus::Bus;
use zga_abi::format::{DepthFunction, StencilOperation};
use zga_abi::registers::Reg;

use crate::{Driver, DriverError};

/// Bit 4 of STENCIL_CONTROL: pixels that pass keep their colour.
const COLOUR_OFF: u32 = 1 << 4;

/// What becomes of a pixel's stencil value when a fragment comes to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilSide {
    /// It fails the stencil test.
    pub fail: StencilOperation,
    /// It passes the stencil test and fails the depth test.
    pub depth_fail: StencilOperation,
    /// It passes both, or there is no depth test.
    pub pass: StencilOperation,
}

impl StencilSide {
    /// Nothing changes.
    pub const KEEP: StencilSide =
        StencilSide { fail: StencilOperation::Keep, depth_fail: StencilOperation::Keep, pass: StencilOperation::Keep };

    /// The bits of this side in STENCIL_CONTROL, from `low` on.
    const fn bits(self, low: u32) -> u32 {
        (self.fail.code() | self.depth_fail.code() << 4 | self.pass.code() << 8) << low
    }
}

/// A stencil test: what is drawn comes to the depth test only where the reference and the pixel's stencil value, both
/// masked, are as the function says. The target has a stencil plane ([`crate::TargetOptions::stencil`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// Reference OP stored value: with [`DepthFunction::Less`] larger values pass.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits that are compared.
    pub read_mask: u8,
    /// Bits that may change.
    pub write_mask: u8,
    /// For triangles whose vertices run counter-clockwise on the screen, lines and points.
    pub front: StencilSide,
    /// For other triangles.
    pub back: StencilSide,
    /// Pixels that pass get a colour; their depth is stored as ever.
    pub colours: bool,
}

impl Default for Stencil {
    /// Everything passes, nothing changes.
    fn default() -> Self {
        Stencil {
            function: DepthFunction::Always,
            reference: 0,
            read_mask: 0xFF,
            write_mask: 0xFF,
            front: StencilSide::KEEP,
            back: StencilSide::KEEP,
            colours: true,
        }
    }
}

impl Stencil {
    /// Counts the shadow volumes a pixel lies in: closed bodies drawn with it (after what they may shade, without
    /// storing depths) leave 0 where none is round what is seen. Sides behind it count, so the viewer may stand in
    /// shadow.
    #[must_use]
    pub const fn shadow_volume() -> Stencil {
        Stencil {
            function: DepthFunction::Always,
            reference: 0,
            read_mask: 0xFF,
            write_mask: 0xFF,
            front: StencilSide { depth_fail: StencilOperation::DecrementWrap, ..StencilSide::KEEP },
            back: StencilSide { depth_fail: StencilOperation::IncrementWrap, ..StencilSide::KEEP },
            colours: false,
        }
    }

    /// STENCIL_CONTROL and STENCIL_VALUE.
    fn words(&self) -> [u32; 2] {
        let colours = if self.colours { 0 } else { COLOUR_OFF };
        let control = self.function.code() | colours | self.front.bits(8) | self.back.bits(20);
        [control, u32::from_le_bytes([self.reference, self.read_mask, self.write_mask, 0])]
    }

    /// Whether a draw with it can change a stencil value.
    fn changes_values(&self) -> bool {
        self.write_mask != 0 && [self.front, self.back].iter().any(|side| *side != StencilSide::KEEP)
    }
}

/// The shadow bit: when a scene ends in which something was drawn with a [`Stencil`], pixels whose stencil value passes
/// are darkened. What is translucent is composed afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shadow {
    /// Reference OP stored value, both masked.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits that are compared.
    pub read_mask: u8,
    /// What is left of each colour channel, of 255.
    pub intensity: u8,
}

impl Default for Shadow {
    /// Where the stencil value is not 0; half of the light is left.
    fn default() -> Self {
        Shadow { function: DepthFunction::NotEqual, reference: 0, read_mask: 0xFF, intensity: 0x80 }
    }
}

impl<B: Bus> Driver<B> {
    /// Sets the stencil test of the draws that follow; none after opening.
    ///
    /// Only in scenes on a target with a stencil plane and without anti-aliasing; other draws are refused while it is
    /// set. What blends may be tested, but changes no stencil value and has colours.
    ///
    /// ```
    /// use zga_abi::Reg;
    /// # use zga_driver::{Driver, DriverError, Stencil, bus::MockBus};
    /// # let mut bus = MockBus::new(1 << 20);
    /// # bus.set_register(Reg::CapabilityEffects, 0xFFF);
    /// let mut driver = Driver::open(bus)?;
    /// driver.set_stencil(Some(Stencil::shadow_volume()))?;
    /// driver.set_stencil(None)?;
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without a stencil test. The setting stays as it was.
    pub fn set_stencil(&mut self, stencil: Option<Stencil>) -> Result<(), DriverError> {
        if stencil.is_some() {
            self.has_effect(Effects::STENCIL, "stencil test")?;
        }
        self.state.effects.stencil = stencil;
        Ok(())
    }

    /// The stencil test of the draws that follow.
    #[must_use]
    pub const fn stencil(&self) -> Option<Stencil> {
        self.state.effects.stencil
    }

    /// Sets what is darkened where scenes end, from the next end on; nothing after opening.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without a stencil test. The setting stays as it was.
    pub fn set_shadow(&mut self, shadow: Option<Shadow>) -> Result<(), DriverError> {
        if shadow.is_some() {
            self.has_effect(Effects::STENCIL, "shadow bit")?;
        }
        self.state.effects.shadow = shadow;
        Ok(())
    }

    /// What is darkened where scenes end.
    #[must_use]
    pub const fn shadow(&self) -> Option<Shadow> {
        self.state.effects.shadow
    }

    /// Checks that the open scene can have the stencil test that is set, and the blending beside it.
    ///
    /// # Errors
    /// [`DriverError::NoStencilPlane`], [`DriverError::StencilRefused`].
    pub(crate) fn check_stencil(&self, scene: &crate::target::Scene) -> Result<(), DriverError> {
        let Some(stencil) = self.state.effects.stencil else {
            return Ok(());
        };
        if !scene.stencil {
            return Err(DriverError::NoStencilPlane { id: scene.id });
        }
        if scene.grid {
            return Err(DriverError::StencilRefused { with: "anti-aliasing" });
        }
        if self.state.effects.blend.is_some() && (stencil.changes_values() || !stencil.colours) {
            return Err(DriverError::StencilRefused { with: "blending, except to test with colours" });
        }
        Ok(())
    }

    /// Wants the registers of a stencil test.
    pub(super) fn want_stencil(&mut self, stencil: &Stencil) {
        let [control, value] = stencil.words();
        self.registers.want(Reg::StencilControl, &[control]);
        self.registers.want(Reg::StencilValue, &[value]);
    }

    /// Wants the registers that END_SCENE samples.
    pub(crate) fn want_shadow(&mut self) {
        let Some(Shadow { function, reference, read_mask, intensity }) = self.state.effects.shadow else {
            // As the card resets it: disabled. A driver that never sets one sends nothing.
            self.registers.want(Reg::ShadowControl, &[Reg::ShadowControl.info().reset_value(0)]);
            return;
        };
        let values = u32::from(reference) << 8 | u32::from(read_mask) << 16;
        self.registers.want(Reg::ShadowControl, &[1 | function.code() << 4 | values]);
        self.registers.want(Reg::ShadowIntensity, &[u32::from(intensity)]);
    }
}
