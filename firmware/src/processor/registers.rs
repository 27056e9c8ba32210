//! Registers: what their values mean, and writes to them from the command stream.

use super::claim::Claim;
use super::memory::LARGEST_SIDE;
use super::{bad_length, effects, memory::VideoMemory};
use crate::checked::{Rectangle, SubpixelSetting, SystolicSetting, ZaSetting};
use crate::hardware::Hardware;
use zga_abi::format::{
    DepthFormat, EndTest, Fidelity, HiddenSurface, PixelFormat, SubpixelDepth, SubpixelEdges, SubpixelGrid,
    SubpixelResolve, TokenColour, TokenPorts, ZaPrediction,
};
use zga_abi::packet::PROBE_RECORD_WORDS;
use zga_abi::register::Access;
use zga_abi::{Effects, Fault, FaultCode, Reg, Units};

/// Bit 8 of ZA_PREDICTION: no block is bypassed.
const ZA_NO_BYPASS: u32 = 1 << 8;
/// Most fragments of SUBPIXEL_POOL.
const LARGEST_POOL: u32 = 1 << 20;

/// The value of a one-word register, not checked yet.
pub(super) fn sample<H: Hardware>(hardware: &H, register: Reg) -> Claim {
    Claim::register(register, hardware.register(register, 0))
}

/// The pair of numbers in a size or position register: 14:0 and 30:16.
pub(super) const fn pair(value: u32) -> (u32, u32) {
    (value & 0x7FFF, (value >> 16) & 0x7FFF)
}

/// Width and height in a size register, each 1 ..= 16384.
pub(super) fn size(claim: Claim) -> Result<(u32, u32), Fault> {
    let (width, height) = pair(claim.value);
    let sides = 1..=LARGEST_SIDE;
    claim.require(sides.contains(&width) && sides.contains(&height))?;
    Ok((width, height))
}

/// A pixel format.
pub(super) fn pixel_format(claim: Claim) -> Result<PixelFormat, Fault> {
    claim.mean(PixelFormat::from_code(claim.value))
}

/// A depth format.
pub(super) fn depth_format(claim: Claim) -> Result<DepthFormat, Fault> {
    claim.mean(DepthFormat::from_code(claim.value))
}

/// A hidden-surface path that the card has (`paths` as in CAPABILITY_PATHS).
pub(super) fn hidden_surface(claim: Claim, paths: u32) -> Result<HiddenSurface, Fault> {
    let path = claim.mean(HiddenSurface::from_code(claim.value))?;
    if paths & (1 << path.code()) == 0 {
        return Err(claim.refuse(FaultCode::Unsupported));
    }
    Ok(path)
}

/// How units with a clocked model are simulated.
pub(super) fn fidelity(claim: Claim) -> Result<Fidelity, Fault> {
    claim.mean(Fidelity::from_code(claim.value))
}

/// Width and height of a block of pixels.
pub(super) fn za_block(claim: Claim) -> Result<[u32; 2], Fault> {
    size(claim).map(|(width, height)| [width, height])
}

/// How the least depth in a block is predicted, and whether blocks are bypassed.
pub(super) fn za_prediction(claim: Claim) -> Result<(ZaPrediction, bool), Fault> {
    let prediction = claim.mean(ZaPrediction::from_code(claim.value & 0x3))?;
    Ok((prediction, claim.value & ZA_NO_BYPASS == 0))
}

/// The Za unit's registers.
pub(super) fn za(block: Claim, prediction: Claim, base: Claim) -> Result<ZaSetting, Fault> {
    let block = za_block(block)?;
    let (prediction, bypass) = za_prediction(prediction)?;
    base.multiple_of(super::memory::CHUNK)?;
    Ok(ZaSetting { base: base.value / 4, block, prediction, bypass })
}

/// The variant of the systolic array: every value has a meaning.
pub(super) fn systolic(claim: Claim) -> SystolicSetting {
    let bit = |number: u32| claim.value >> number & 1;
    SystolicSetting {
        end_test: if bit(0) == 0 { EndTest::Negative } else { EndTest::Zero },
        ports: if bit(1) == 0 { TokenPorts::Swapped } else { TokenPorts::Merged },
        colour: if bit(2) == 0 { TokenColour::Tag } else { TokenColour::Value },
        super_buffer: bit(3) == 1,
    }
}

/// Width and height of a tile.
pub(super) fn tile_size(claim: Claim) -> Result<[u32; 2], Fault> {
    let (width, height) = pair(claim.value);
    let sides = |side: u32| side.is_power_of_two() && (4..=64).contains(&side);
    claim.require(sides(width) && sides(height))?;
    Ok([width, height])
}

/// How fragments that share samples are ordered.
pub(super) fn subpixel_depth(claim: Claim) -> Result<SubpixelDepth, Fault> {
    claim.mean(SubpixelDepth::from_code(claim.value))
}

/// Fragments that the lists of one line have room for, 1 ..= 2^20.
pub(super) fn subpixel_pool(claim: Claim) -> Result<u32, Fault> {
    claim.require((1..=LARGEST_POOL).contains(&claim.value))?;
    Ok(claim.value)
}

/// The sub-pixel mask unit's registers; none where the grid is off. All of them are checked, grid or not. A card without
/// the unit (`capability` as in CAPABILITY_EFFECTS) has no grid.
pub(super) fn subpixel(
    capability: u32,
    grid: Claim,
    depth: Claim,
    resolve: Claim,
    pool: Claim,
    edges: Claim,
) -> Result<Option<SubpixelSetting>, Fault> {
    let claim = grid;
    let grid = claim.mean(SubpixelGrid::from_code(claim.value))?;
    if grid != SubpixelGrid::Off && !Effects::from_bits_truncate(capability).contains(Effects::ANTI_ALIAS) {
        return Err(claim.refuse(FaultCode::Unsupported));
    }
    let depth = subpixel_depth(depth)?;
    let resolve = resolve.mean(SubpixelResolve::from_code(resolve.value))?;
    let pool = subpixel_pool(pool)?;
    let edges = edges.mean(SubpixelEdges::from_code(edges.value))?;
    Ok((grid != SubpixelGrid::Off).then_some(SubpixelSetting { grid, depth, resolve, pool, edges }))
}

/// LINE_WIDTH or POINT_SIZE: u8.8, pixels, not 0.
pub(super) fn extent(claim: Claim) -> Result<u32, Fault> {
    claim.require((1..=0xFFFF).contains(&claim.value))?;
    Ok(claim.value)
}

/// Bits of a pixel that coordinates are snapped to.
pub(super) fn subpixel_bits(claim: Claim) -> Result<u32, Fault> {
    claim.require(matches!(claim.value, 4 | 8))
}

/// Effects that the card has units for (`capability` as in CAPABILITY_EFFECTS).
pub(super) fn effect_bits(claim: Claim, capability: u32) -> Result<Effects, Fault> {
    let effects = claim.mean(Effects::from_bits(claim.value))?;
    if claim.value & !capability != 0 {
        return Err(claim.refuse(FaultCode::Unsupported));
    }
    Ok(effects)
}

/// The scissor, cut to a target of this size.
pub(super) fn scissor<H: Hardware>(hardware: &H, width: u32, height: u32) -> Rectangle {
    let (x, y) = pair(hardware.register(Reg::ScissorMinimum, 0));
    let (right, bottom) = pair(hardware.register(Reg::ScissorMaximum, 0));
    let (right, bottom) = (right.min(width), bottom.min(height));
    Rectangle { x: x.min(right), y: y.min(bottom), right, bottom }
}

/// The unit that the probe needs: none while it is disabled, else its record area is checked.
pub(super) fn probe_unit<H: Hardware>(hardware: &H) -> Result<Units, Fault> {
    if hardware.register(Reg::ProbeControl, 0) & 1 == 0 {
        return Ok(Units::empty());
    }
    let base = sample(hardware, Reg::ProbeBase);
    let records = hardware.register(Reg::ProbeSize, 0);
    let bytes = u64::from(records) * u64::from(PROBE_RECORD_WORDS * 4);
    base.multiple_of(super::memory::CHUNK)?;
    VideoMemory::of(hardware).span(base, bytes)?;
    Ok(Units::PROBE)
}

/// REGISTER_WRITE: offset, value, ...
///
/// Every value is checked before the first is written.
pub(super) fn write<H: Hardware>(hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
    let &[_, offset, ref values @ ..] = packet else {
        return Err(bad_length(packet));
    };
    for write in writes(offset, values) {
        write.check(hardware)?;
    }
    for write in writes(offset, values) {
        if let Ok((register, word)) = write.register() {
            let old = hardware.register(register, word);
            let new = merge(register, old, write.claim.value);
            hardware.set_register(register, word, new);
        }
    }
    Ok(())
}

/// One value of a REGISTER_WRITE.
struct Write {
    /// Byte offset of the register word.
    offset: u32,
    /// The value.
    claim: Claim,
    /// Which of the packet's words names the offset, should no register be there.
    offset_word: u32,
}

/// The writes that a REGISTER_WRITE asks for, in stream order.
fn writes(offset: u32, values: &[u32]) -> impl Iterator<Item = Write> {
    (0..).zip(values).map(move |(index, &value)| Write {
        // A sum that would pass the end of the address space stays there, where no register is.
        offset: offset.saturating_add(4 * index),
        claim: Claim::word(2 + index, value),
        // The first offset stands in the packet; the others follow from the number of values.
        offset_word: if index == 0 { 1 } else { 2 + index },
    })
}

impl Write {
    /// The register word written, if packets may write it.
    fn register(&self) -> Result<(Reg, u32), Fault> {
        let open = matches!(self.offset, 0x0048..0x0050 | 0x0200..0x0700);
        Reg::at(self.offset)
            .filter(|(register, _)| open && register.info().access == Access::ReadWrite)
            .ok_or(Fault::new(FaultCode::BadRegister, self.offset_word, self.offset))
    }

    /// Is there such a register, and does it know the value?
    fn check<H: Hardware>(&self, hardware: &H) -> Result<(), Fault> {
        let (register, word) = self.register()?;
        let old = hardware.register(register, word);
        let claim = self.claim.meaning(merge(register, old, self.claim.value));
        match register {
            Reg::ColourFormat | Reg::ScanoutFormat => pixel_format(claim).map(|_| ()),
            Reg::DepthFormat => depth_format(claim).map(|_| ()),
            Reg::SubpixelBits => subpixel_bits(claim).map(|_| ()),
            Reg::ZaBlock => za_block(claim).map(|_| ()),
            Reg::ZaPrediction => za_prediction(claim).map(|_| ()),
            Reg::TileSize => tile_size(claim).map(|_| ()),
            Reg::SubpixelDepth => subpixel_depth(claim).map(|_| ()),
            Reg::SubpixelPool => subpixel_pool(claim).map(|_| ()),
            Reg::LineWidth | Reg::PointSize => extent(claim).map(|_| ()),
            Reg::TextureSize => size(claim).map(|_| ()),
            Reg::TextureControl => effects::texture_control(claim).map(|_| ()),
            Reg::TextureOffset | Reg::TextureWindow => effects::texels(claim).map(|_| ()),
            Reg::BlendControl => effects::blend_mode(claim).map(|_| ()),
            Reg::FogControl => effects::fog_function(claim).map(|_| ()),
            Reg::FogDensity => effects::fog_density(claim).map(|_| ()),
            Reg::FogEnd => effects::fog_end(claim).map(|_| ()),
            Reg::DepthCueScale | Reg::DepthCueOffset => effects::depth_cue(claim).map(|_| ()),
            Reg::LightCount => effects::light_count(claim).map(|_| ()),
            Reg::MaterialShininess => effects::shininess(claim).map(|_| ()),
            Reg::HiddenSurface => hidden_surface(claim, hardware.register(Reg::CapabilityPaths, 0)).map(|_| ()),
            Reg::Effects => effect_bits(claim, hardware.register(Reg::CapabilityEffects, 0)).map(|_| ()),
            _ => Ok(()),
        }
    }
}

/// The register's value after a write: bits outside the writable mask keep theirs.
fn merge(register: Reg, old: u32, value: u32) -> u32 {
    let writable = register.info().writable;
    (old & !writable) | (value & writable)
}
