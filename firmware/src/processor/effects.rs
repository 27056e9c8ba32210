//! Registers of the effects that a draw calls for: texture, holes, light, fog, blending, stencil; and of the shadow bit.
//!
//! Each group is looked at only where its effect is called: a draw that does not call for fog does not care what the
//! fog registers hold.

use super::claim::Claim;
use super::memory::{CHUNK, LARGEST_SIDE, VideoMemory};
use super::registers::{pair, sample, size};
use crate::checked::{Fog, Lighting, Shadow, Stencil, StencilOperations, StencilTest, Target, Texture};
use crate::hardware::Hardware;
use zga_abi::format::{
    BlendMode, DepthFunction, FogFunction, StencilOperation, TextureFilter, TextureFormat, TextureFunction,
};
use zga_abi::light::{LIGHT_BYTES, MOST_LIGHTS};
use zga_abi::{Effects, Fault, FaultCode, Reg};

/// Most levels of a texture: 16384 texels are halved 14 times.
const MOST_LEVELS: u32 = 15;
/// Largest shininess.
const LARGEST_SHININESS: f32 = 128.0;

/// What TEXTURE_CONTROL says.
pub(super) struct TextureControl {
    format: TextureFormat,
    filter: TextureFilter,
    function: TextureFunction,
    levels: u32,
}

/// The fields of TEXTURE_CONTROL that not every value has a meaning in.
pub(super) fn texture_control(claim: Claim) -> Result<TextureControl, Fault> {
    let field = |low: u32, bits: u32| claim.value >> low & ((1 << bits) - 1);
    let levels = field(16, 4);
    claim.require((1..=MOST_LEVELS).contains(&levels))?;
    Ok(TextureControl {
        format: claim.mean(TextureFormat::from_code(field(0, 3)))?,
        filter: claim.mean(TextureFilter::from_code(field(4, 2)))?,
        function: claim.mean(TextureFunction::from_code(field(8, 2)))?,
        levels,
    })
}

/// A pair of numbers, each at most 16384.
pub(super) fn texels(claim: Claim) -> Result<[u32; 2], Fault> {
    let (x, y) = pair(claim.value);
    claim.require(x <= LARGEST_SIDE && y <= LARGEST_SIDE)?;
    Ok([x, y])
}

/// How translucent fragments are combined.
pub(super) fn blend_mode(claim: Claim) -> Result<BlendMode, Fault> {
    claim.mean(BlendMode::from_code(claim.value))
}

/// A fog function.
pub(super) fn fog_function(claim: Claim) -> Result<FogFunction, Fault> {
    claim.mean(FogFunction::from_code(claim.value))
}

/// Number of lights.
pub(super) fn light_count(claim: Claim) -> Result<u32, Fault> {
    claim.require(claim.value <= MOST_LIGHTS)
}

/// Density of exponential fog: not negative.
pub(super) fn fog_density(claim: Claim) -> Result<f32, Fault> {
    number(claim, |density| density >= 0.0)
}

/// Distance at which linear fog is full: positive.
pub(super) fn fog_end(claim: Claim) -> Result<f32, Fault> {
    number(claim, |end| end > 0.0)
}

/// A number of depth cueing.
pub(super) fn depth_cue(claim: Claim) -> Result<f32, Fault> {
    number(claim, |_| true)
}

/// Sharpness of highlights.
pub(super) fn shininess(claim: Claim) -> Result<f32, Fault> {
    number(claim, |shininess| (0.0..=LARGEST_SHININESS).contains(&shininess))
}

/// An f32 that is finite and in a range.
fn number(claim: Claim, in_range: impl FnOnce(f32) -> bool) -> Result<f32, Fault> {
    let value = f32::from_bits(claim.value);
    claim.require(value.is_finite() && in_range(value))?;
    Ok(value)
}

/// The texture of a draw with these effects.
pub(super) fn texture<H: Hardware>(hardware: &H, effects: Effects) -> Result<Option<Texture>, Fault> {
    if !effects.contains(Effects::TEXTURE) {
        return Ok(None);
    }
    let base = sample(hardware, Reg::TextureBase);
    let size_claim = sample(hardware, Reg::TextureSize);
    let (width, height) = size(size_claim)?;
    let size = [width, height];
    let control_claim = sample(hardware, Reg::TextureControl);
    let TextureControl { format, filter, function, levels } = texture_control(control_claim)?;
    // The larger side can be halved so often.
    control_claim.require(levels <= 1 + width.max(height).ilog2())?;
    let flag = |bit: u32| control_claim.value >> bit & 1 == 1;

    let offset_claim = sample(hardware, Reg::TextureOffset);
    let offset = texels(offset_claim)?;
    offset_claim.require(offset[0] < width && offset[1] < height)?;
    let window_claim = sample(hardware, Reg::TextureWindow);
    let used = texels(window_claim)?;
    let left = [width - offset[0], height - offset[1]];
    window_claim.require(used[0] <= left[0] && used[1] <= left[1])?;
    let window = [0, 1].map(|axis| if used[axis] == 0 { left[axis] } else { used[axis] });

    let palette = sample(hardware, Reg::PaletteBase);
    let texture = Texture {
        base: base.value,
        size,
        format,
        levels,
        palette: palette.value,
        offset,
        window,
        repeat: [flag(12), flag(13)],
        mirror: [flag(14), flag(15)],
        filter,
        function,
        colour: hardware.register(Reg::TextureColour, 0),
        bias: i32::from(hardware.register(Reg::TextureBias, 0) as u16 as i16),
        mip_map: effects.contains(Effects::MIP_MAP),
    };
    let memory = VideoMemory::of(hardware);
    base.multiple_of(CHUNK)?;
    memory.span(base, texture.bytes())?;
    if format.palette() != 0 {
        palette.multiple_of(CHUNK)?;
        memory.span(palette, u64::from(4 * format.palette()))?;
    }
    Ok(Some(texture))
}

/// Which texels are holes, for a draw with these effects.
pub(super) fn punch_through<H: Hardware>(hardware: &H, effects: Effects) -> Option<u8> {
    effects
        .contains(Effects::PUNCH_THROUGH | Effects::TEXTURE)
        .then(|| hardware.register(Reg::PunchThrough, 0).min(255) as u8)
}

/// Lights and material of a draw with these effects.
pub(super) fn light<H: Hardware>(hardware: &H, effects: Effects) -> Result<Option<Lighting>, Fault> {
    if !effects.contains(Effects::LIGHT) {
        return Ok(None);
    }
    let control = hardware.register(Reg::LightControl, 0);
    let base = sample(hardware, Reg::LightBase);
    let count = light_count(sample(hardware, Reg::LightCount))?;
    base.multiple_of(CHUNK)?;
    VideoMemory::of(hardware).span(base, u64::from(count * LIGHT_BYTES))?;
    Ok(Some(Lighting {
        per_pixel: control & 1 != 0,
        two_sided: control & 2 != 0,
        local_viewer: control & 4 != 0,
        lights: base.value,
        count,
        ambient: hardware.register(Reg::SceneAmbient, 0),
        specular: hardware.register(Reg::MaterialSpecular, 0),
        emission: hardware.register(Reg::MaterialEmission, 0),
        shininess: shininess(sample(hardware, Reg::MaterialShininess))?,
    }))
}

/// Fog of a draw with these effects; none where its function says so.
pub(super) fn fog<H: Hardware>(hardware: &H, effects: Effects) -> Result<Option<Fog>, Fault> {
    if !effects.contains(Effects::FOG) {
        return Ok(None);
    }
    let function = fog_function(sample(hardware, Reg::FogControl))?;
    if function == FogFunction::None {
        return Ok(None);
    }
    Ok(Some(Fog {
        function,
        density: fog_density(sample(hardware, Reg::FogDensity))?,
        end: fog_end(sample(hardware, Reg::FogEnd))?,
        cue_scale: depth_cue(sample(hardware, Reg::DepthCueScale))?,
        cue_offset: depth_cue(sample(hardware, Reg::DepthCueOffset))?,
        colour: hardware.register(Reg::FogColour, 0),
    }))
}

/// Blending of a draw with these effects; alpha where none is called for.
pub(super) fn blend<H: Hardware>(hardware: &H, effects: Effects) -> Result<BlendMode, Fault> {
    if effects.contains(Effects::BLEND) {
        blend_mode(sample(hardware, Reg::BlendControl))
    } else {
        Ok(BlendMode::Alpha)
    }
}

/// The stencil test of a draw with these effects.
///
/// Refused: without a stencil plane; with a grid, whose samples share one stencil value; with BLEND where it changes a
/// value or draws no colour, since what is translucent is tested when the opaque picture is done.
pub(super) fn stencil<H: Hardware>(hardware: &H, target: &Target, effects: Effects) -> Result<Option<Stencil>, Fault> {
    if !effects.contains(Effects::STENCIL) {
        return Ok(None);
    }
    let called = sample(hardware, Reg::Effects);
    called.require(target.stencil.is_some())?;
    if target.subpixel.is_some() {
        return Err(called.refuse(FaultCode::Unsupported));
    }
    let control = sample(hardware, Reg::StencilControl);
    let value = hardware.register(Reg::StencilValue, 0);
    let operation = |low: u32| control.mean(StencilOperation::from_code(control.value >> low & 7));
    let operations = |low: u32| {
        let (fail, depth_fail, pass) = (operation(low)?, operation(low + 4)?, operation(low + 8)?);
        Ok(StencilOperations { fail, depth_fail, pass })
    };
    let stencil = Stencil {
        test: stencil_test(control, control.value, value, value >> 8)?,
        write_mask: (value >> 16) as u8,
        front: operations(8)?,
        back: operations(20)?,
        colour_off: control.value >> 4 & 1 == 1,
    };
    if effects.contains(Effects::BLEND) && (stencil.colour_off || stencil.changes_values()) {
        return Err(control.refuse(FaultCode::Unsupported));
    }
    Ok(Some(stencil))
}

/// A stencil test whose function is in bits 2:0; reference and mask are the low bits of their words.
fn stencil_test(claim: Claim, function: u32, reference: u32, mask: u32) -> Result<StencilTest, Fault> {
    let function = claim.mean(DepthFunction::from_code(function & 7))?;
    Ok(StencilTest { function, reference: reference as u8, read_mask: mask as u8 })
}

/// The shadow bit; none where it is not enabled.
pub(super) fn shadow<H: Hardware>(hardware: &H) -> Result<Option<Shadow>, Fault> {
    let control = sample(hardware, Reg::ShadowControl);
    if control.value & 1 == 0 {
        return Ok(None);
    }
    let test = stencil_test(control, control.value >> 4, control.value >> 8, control.value >> 16)?;
    Ok(Some(Shadow { test, intensity: hardware.register(Reg::ShadowIntensity, 0) as u8 }))
}
