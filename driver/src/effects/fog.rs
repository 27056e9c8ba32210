//! Fog and depth cueing.

use zga_abi::Effects;
use zga_abi::bus::Bus;
use zga_abi::format::FogFunction;
use zga_abi::registers::Reg;

use crate::{Driver, DriverError};

/// How much of a surface's colour is left at a distance d from the viewer, measured along the line of sight in
/// eye-space units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogCurve {
    /// 1 - d / end.
    Linear {
        /// Where nothing of the surface is left, above 0.
        end: f32,
    },
    /// e to the power of -(density d).
    Exponential {
        /// 0 or more.
        density: f32,
    },
    /// e to the power of -(density d)^2.
    ExponentialSquared {
        /// 0 or more.
        density: f32,
    },
    /// Depth cueing: offset - scale d, not below 0 and not above 1.
    DepthCue {
        /// kz.
        scale: f32,
        /// cz.
        offset: f32,
    },
}

impl FogCurve {
    const fn function(self) -> FogFunction {
        match self {
            FogCurve::Linear { .. } => FogFunction::Linear,
            FogCurve::Exponential { .. } => FogFunction::Exponential,
            FogCurve::ExponentialSquared { .. } => FogFunction::ExponentialSquared,
            FogCurve::DepthCue { .. } => FogFunction::DepthCue,
        }
    }

    fn check(self) -> Result<(), DriverError> {
        match self {
            FogCurve::Linear { end } => number("fog end", end, end > 0.0, "a finite number above 0"),
            FogCurve::Exponential { density } | FogCurve::ExponentialSquared { density } => {
                number("fog density", density, density >= 0.0, "a finite number, 0 or more")
            }
            FogCurve::DepthCue { scale, offset } => {
                number("depth cue scale", scale, true, "a finite number")?;
                number("depth cue offset", offset, true, "a finite number")
            }
        }
    }
}

/// Checks a number that must be finite and in a range.
pub(super) fn number(
    name: &'static str,
    found: f32,
    in_range: bool,
    expected: &'static str,
) -> Result<(), DriverError> {
    if found.is_finite() && in_range {
        return Ok(());
    }
    Err(DriverError::BadOption { name, found: found.to_string(), expected })
}

/// Fog: distant surfaces fade to its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// How it grows with the distance.
    pub curve: FogCurve,
    /// Red, green, blue; alpha is not in use.
    pub colour: [u8; 4],
}

impl<B: Bus> Driver<B> {
    /// Sets the fog of the draws that follow; none after opening.
    ///
    /// ```
    /// # use zga_abi::Reg;
    /// # use zga_driver::{Driver, DriverError, Fog, FogCurve, bus::MockBus};
    /// # let mut bus = MockBus::new(1 << 20);
    /// # bus.set_register(Reg::CapabilityEffects, 0xFFF);
    /// let mut driver = Driver::open(bus)?;
    /// driver.set_fog(Some(Fog { curve: FogCurve::Linear { end: 40.0 }, colour: [180, 190, 200, 255] }))?;
    /// let wrong = Fog { curve: FogCurve::Exponential { density: -1.0 }, colour: [0; 4] };
    /// let refused = driver.set_fog(Some(wrong)).expect_err("a negative density");
    /// assert_eq!(refused.to_string(), "fog density is -1, expected a finite number, 0 or more");
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without fog; [`DriverError::BadOption`] names the number that has no
    /// meaning. The setting stays as it was.
    pub fn set_fog(&mut self, fog: Option<Fog>) -> Result<(), DriverError> {
        if let Some(fog) = fog {
            self.has_effect(Effects::FOG, "fog")?;
            fog.curve.check()?;
        }
        self.state.effects.fog = fog;
        Ok(())
    }

    /// Wants the registers of a fog.
    pub(super) fn want_fog(&mut self, fog: &Fog) {
        self.registers.want(Reg::FogControl, &[fog.curve.function().code()]);
        self.registers.want(Reg::FogColour, &[u32::from_le_bytes(fog.colour)]);
        match fog.curve {
            FogCurve::Linear { end } => self.registers.want(Reg::FogEnd, &[end.to_bits()]),
            FogCurve::Exponential { density } | FogCurve::ExponentialSquared { density } => {
                self.registers.want(Reg::FogDensity, &[density.to_bits()]);
            }
            FogCurve::DepthCue { scale, offset } => {
                self.registers.want(Reg::DepthCueScale, &[scale.to_bits()]);
                self.registers.want(Reg::DepthCueOffset, &[offset.to_bits()]);
            }
        }
    }
}
