//! The declarations agree with themselves and with each other.

mod codes;

use crate::bus::{
    FIFO_BASE, FIFO_BYTES, MEMORY_BASE, MEMORY_BYTES, REGISTERS_BASE, REGISTERS_BYTES, ZA_BASE, ZA_BYTES,
};
use crate::format::{
    BlendMode, DepthFormat, DepthFunction, FogFunction, HiddenSurface, PixelFormat, SubpixelDepth, SubpixelEdges,
    SubpixelGrid, SubpixelResolve, TextureFilter, TextureFormat, TextureFunction,
};
use crate::registers::REGISTERS;
use crate::{Access, Bus, Counter, Effects, Fault, FaultCode, Field, Reg, Units};
use core::time::Duration;
use std::collections::HashSet;
use std::format;
use std::string::String;
use std::vec::Vec;

// Registers ----------------------------------------------------------------------------------

#[test]
fn registers_in_order_of_offset_do_not_overlap() {
    for pair in REGISTERS.windows(2) {
        let end = pair[0].word_offset(pair[0].count);
        assert!(end <= pair[1].offset, "{} runs into {}", pair[0].name, pair[1].name);
    }
}

#[test]
fn registers_all_words_lie_in_the_aperture() {
    for register in REGISTERS {
        assert!(register.count > 0, "{}", register.name);
        assert_eq!(register.offset % 4, 0, "{}", register.name);
        assert!(register.word_offset(register.count) <= REGISTERS_BYTES, "{}", register.name);
    }
}

#[test]
fn reg_every_name_has_its_own_declaration() {
    assert_eq!(Reg::ALL.len(), REGISTERS.len());
    let names: HashSet<_> = REGISTERS.iter().map(|r| r.name).collect();
    assert_eq!(names.len(), REGISTERS.len());
    for (&reg, register) in Reg::ALL.iter().zip(REGISTERS) {
        assert_eq!(reg.offset(), register.offset);
        assert_eq!(reg.info().name, register.name);
        assert!(!register.doc.trim().is_empty());
    }
}

#[test]
fn reg_at_every_offset_of_the_aperture_finds_its_owner_or_nothing() {
    for offset in 0..REGISTERS_BYTES + 16 {
        let owner = Reg::ALL
            .iter()
            .flat_map(|&reg| (0..reg.info().count).map(move |word| (reg, word)))
            .find(|&(reg, word)| reg.info().word_offset(word) == offset);
        assert_eq!(Reg::at(offset), owner, "offset {offset:#06x}");
    }
    assert_eq!(Reg::at(u32::MAX - 3), None);
}

#[test]
fn registers_well_known_offsets_stay_where_the_manual_has_them() {
    let offsets = [
        (Reg::Identification, 0x0000),
        (Reg::Reset, 0x0040),
        (Reg::InterruptStatus, 0x0080),
        (Reg::FifoFree, 0x00C0),
        (Reg::RingBase, 0x0100),
        (Reg::Doorbell, 0x0110),
        (Reg::FenceSequence, 0x0140),
        (Reg::TargetSize, 0x0200),
        (Reg::HiddenSurface, 0x0240),
        (Reg::SubpixelGrid, 0x0260),
        (Reg::SubpixelPool, 0x026C),
        (Reg::SubpixelEdges, 0x0270),
        (Reg::Effects, 0x0280),
        (Reg::LineWidth, 0x0298),
        (Reg::PointSize, 0x029C),
        (Reg::TextureBase, 0x0300),
        (Reg::TextureSize, 0x0304),
        (Reg::TextureControl, 0x0308),
        (Reg::TextureOffset, 0x030C),
        (Reg::TextureWindow, 0x0310),
        (Reg::TextureColour, 0x0314),
        (Reg::TextureBias, 0x0318),
        (Reg::PaletteBase, 0x031C),
        (Reg::PunchThrough, 0x0320),
        (Reg::BlendControl, 0x0324),
        (Reg::FogControl, 0x0330),
        (Reg::FogDensity, 0x0334),
        (Reg::FogEnd, 0x0338),
        (Reg::DepthCueScale, 0x033C),
        (Reg::DepthCueOffset, 0x0340),
        (Reg::FogColour, 0x0344),
        (Reg::LightControl, 0x0350),
        (Reg::LightBase, 0x0354),
        (Reg::LightCount, 0x0358),
        (Reg::SceneAmbient, 0x035C),
        (Reg::MaterialSpecular, 0x0360),
        (Reg::MaterialEmission, 0x0364),
        (Reg::MaterialShininess, 0x0368),
        (Reg::ObjectEye, 0x0400),
        (Reg::Decal, 0x0440),
        (Reg::EyeClip, 0x0480),
        (Reg::Viewport, 0x04C0),
        (Reg::ProbeControl, 0x0600),
        (Reg::ScanoutControl, 0x0680),
        (Reg::CursorControl, 0x06A0),
        (Reg::CursorBase, 0x06A4),
        (Reg::CursorPosition, 0x06A8),
        (Reg::EffectsCalled, 0x0700),
        (Reg::UnitsPowered, 0x0704),
        (Reg::Counters, 0x1000),
    ];
    for (reg, offset) in offsets {
        assert_eq!(reg.offset(), offset, "{}", reg.info().name);
    }
}

#[test]
fn fields_lie_in_the_word_highest_first_without_overlap() {
    for register in REGISTERS {
        let mut taken = 0;
        let mut below = 32;
        for field in register.fields {
            assert!(field.lo <= field.hi && field.hi < below, "{}.{}", register.name, field.name);
            assert_eq!(taken & field.mask(), 0, "{}.{}", register.name, field.name);
            taken |= field.mask();
            below = field.lo;
        }
        let names: HashSet<_> = register.fields.iter().map(|f| f.name).collect();
        assert_eq!(names.len(), register.fields.len(), "{}", register.name);
    }
}

#[test]
fn fields_of_what_can_be_written_cover_the_masks() {
    for register in REGISTERS.iter().filter(|r| !r.fields.is_empty()) {
        let fields = register.fields.iter().fold(0, |bits, f| bits | f.mask());
        let masks = register.writable | register.write_one_to_clear;
        assert_eq!(masks & !fields, 0, "{}", register.name);
    }
}

#[test]
fn field_mask_of_one_bit_and_of_a_whole_word_is_exact() {
    let field = |hi, lo| Field { hi, lo, name: "", doc: "" };
    assert_eq!(field(0, 0).mask(), 1);
    assert_eq!(field(31, 31).mask(), 0x8000_0000);
    assert_eq!(field(31, 0).mask(), 0xFFFF_FFFF);
    assert_eq!(field(12, 8).mask(), 0x1F00);
}

#[test]
fn masks_are_disjoint_and_match_the_access() {
    for register in REGISTERS {
        let (writable, clears) = (register.writable, register.write_one_to_clear);
        assert_eq!(writable & clears, 0, "{}", register.name);
        let expected = match register.access {
            Access::ReadOnly => (false, false),
            Access::ReadWrite | Access::WriteOnly => (true, false),
            Access::WriteOneToClear => (false, true),
        };
        assert_eq!((writable != 0, clears != 0), expected, "{}", register.name);
    }
}

#[test]
fn access_names_are_those_of_the_manual() {
    let all = [Access::ReadOnly, Access::ReadWrite, Access::WriteOnly, Access::WriteOneToClear];
    assert_eq!(all.map(Access::name), ["RO", "RW", "WO", "W1C"]);
}

#[test]
fn reset_values_are_one_for_all_words_or_one_for_each() {
    for register in REGISTERS {
        let given = register.reset.len();
        assert!(given == 1 || given == register.count as usize, "{}", register.name);
        assert_eq!(register.reset_value(0), register.reset[0]);
        assert_eq!(register.reset_value(register.count - 1), register.reset[given - 1]);
    }
}

#[test]
fn reset_values_of_what_can_be_written_fit_the_mask() {
    for register in REGISTERS.iter().filter(|r| r.access == Access::ReadWrite) {
        for &value in register.reset {
            assert_eq!(value & !register.writable, 0, "{}", register.name);
        }
    }
}

#[test]
fn reset_values_of_enumerations_have_a_meaning() {
    let reset = |reg: Reg| reg.info().reset_value(0);
    assert!(PixelFormat::from_code(reset(Reg::ColourFormat)).is_some());
    assert!(PixelFormat::from_code(reset(Reg::ScanoutFormat)).is_some());
    assert_eq!(DepthFormat::from_code(reset(Reg::DepthFormat)), Some(DepthFormat::default()));
    assert_eq!(HiddenSurface::from_code(reset(Reg::HiddenSurface)), Some(HiddenSurface::ZBuffer));
    assert_eq!(DepthFunction::from_code(reset(Reg::DepthControl) & 7), Some(DepthFunction::Less));
    assert_eq!(Effects::from_bits(reset(Reg::Effects)), Some(Effects::DEPTH));
    assert_eq!(SubpixelGrid::from_code(reset(Reg::SubpixelGrid)), Some(SubpixelGrid::Off));
    assert_eq!(SubpixelDepth::from_code(reset(Reg::SubpixelDepth)), Some(SubpixelDepth::Search));
    assert_eq!(SubpixelResolve::from_code(reset(Reg::SubpixelResolve)), Some(SubpixelResolve::Values));
    assert_eq!(SubpixelEdges::from_code(reset(Reg::SubpixelEdges)), Some(SubpixelEdges::All));
    let texture = reset(Reg::TextureControl);
    assert_eq!(TextureFormat::from_code(texture & 7), Some(TextureFormat::Rgba8888));
    assert_eq!(TextureFilter::from_code(texture >> 4 & 3), Some(TextureFilter::Nearest));
    assert_eq!(TextureFunction::from_code(texture >> 8 & 3), Some(TextureFunction::Modulate));
    assert_eq!((texture >> 16, reset(Reg::TextureSize)), (1, 0x0001_0001));
    assert_eq!(BlendMode::from_code(reset(Reg::BlendControl)), Some(BlendMode::Alpha));
    assert_eq!(FogFunction::from_code(reset(Reg::FogControl)), Some(FogFunction::None));
    let numbers = [Reg::FogDensity, Reg::FogEnd, Reg::DepthCueScale, Reg::DepthCueOffset, Reg::MaterialShininess];
    assert_eq!(numbers.map(|number| f32::from_bits(reset(number))), [0.0, 1.0, 0.0, 1.0, 0.0]);
}

#[test]
fn reset_matrices_are_the_identity() {
    for reg in [Reg::ObjectEye, Reg::Decal, Reg::EyeClip] {
        for word in 0..16 {
            let expected = if word % 5 == 0 { 1.0_f32 } else { 0.0 };
            let value = f32::from_bits(reg.info().reset_value(word));
            assert_eq!(value.to_bits(), expected.to_bits(), "word {word}");
        }
    }
}

// Bits that stand in two places --------------------------------------------------------------

/// Name and mask of every field, lowest first.
fn fields(reg: Reg) -> Vec<(String, u32)> {
    let fields = reg.info().fields.iter().rev();
    fields.map(|f| (f.name.into(), f.mask())).collect()
}

#[test]
fn effect_bits_are_the_fields_of_the_effects_register() {
    let bits: Vec<_> = Effects::all().iter_names().map(|(name, bit)| (name.to_lowercase(), bit.bits())).collect();
    assert_eq!(bits, fields(Reg::Effects));
    assert_eq!(Reg::Effects.info().writable, Effects::all().bits());
}

#[test]
fn unit_bits_are_the_fields_of_the_units_powered_register() {
    let bits: Vec<_> = Units::all().iter_names().map(|(name, bit)| (name.to_lowercase(), bit.bits())).collect();
    assert_eq!(bits, fields(Reg::UnitsPowered));
}

#[test]
fn hidden_surface_codes_are_the_bits_of_the_path_capabilities() {
    let bits: Vec<_> = HiddenSurface::ALL.iter().map(|path| (path.name().into(), 1 << path.code())).collect();
    assert_eq!(bits, fields(Reg::CapabilityPaths));
}

#[test]
fn interrupt_lines_are_the_fields_of_the_interrupt_status_register() {
    use crate::bus::{INTERRUPT_ALL, INTERRUPT_ERROR, INTERRUPT_FENCE, INTERRUPT_VERTICAL_BLANK};
    let lines = [
        ("fence".into(), INTERRUPT_FENCE),
        ("vertical_blank".into(), INTERRUPT_VERTICAL_BLANK),
        ("error".into(), INTERRUPT_ERROR),
    ];
    assert_eq!(fields(Reg::InterruptStatus), lines);
    assert_eq!(Reg::InterruptStatus.info().write_one_to_clear, INTERRUPT_ALL);
    assert_eq!(Reg::InterruptEnable.info().writable, INTERRUPT_ALL);
}

// Counters -----------------------------------------------------------------------------------

#[test]
fn counters_all_fit_in_the_counters_registers() {
    assert!(2 * Counter::COUNT <= Reg::Counters.info().count as usize);
    for (index, &counter) in Counter::ALL.iter().enumerate() {
        assert_eq!(counter.offset() as usize, 0x1000 + 8 * index);
        assert_eq!(Reg::at(counter.offset()), Some((Reg::Counters, 2 * index as u32)));
    }
}

#[test]
fn counter_names_are_unique_and_carry_their_unit() {
    let names: HashSet<_> = Counter::ALL.iter().map(|c| c.name()).collect();
    assert_eq!(names.len(), Counter::COUNT);
    for counter in Counter::ALL {
        assert!(counter.name().contains('.'), "{}", counter.name());
        assert!(!counter.doc().is_empty(), "{}", counter.name());
    }
}

#[test]
fn counters_of_newer_units_stand_behind_the_older_ones() {
    assert_eq!(Counter::TileFragmentsNotStored as usize, 41);
    assert_eq!(Counter::CyclesSubpixel as usize, 42);
    assert_eq!(Counter::CyclesTexture as usize, Counter::SubpixelPixelsDegraded as usize + 1);
    let maxima: Vec<_> = Counter::ALL.iter().filter(|counter| counter.is_maximum()).map(|c| c.name()).collect();
    assert_eq!(maxima, ["subpixel.pool_peak_bytes", "texture.decoded_bytes", "subpixel.edge_peak_bytes"]);
}

// Faults and bus -----------------------------------------------------------------------------

#[test]
fn fault_display_names_code_word_and_value() {
    let text = format!("{}", Fault::new(FaultCode::BadIndex, 7, 0x2A));
    assert_eq!(
        text,
        "BAD_INDEX at word 7 of the packet (found 0x0000002a): An index names a vertex that is not there."
    );
}

#[test]
fn bus_windows_do_not_overlap() {
    let windows =
        [(REGISTERS_BASE, REGISTERS_BYTES), (FIFO_BASE, FIFO_BYTES), (ZA_BASE, ZA_BYTES), (MEMORY_BASE, MEMORY_BYTES)];
    for pair in windows.windows(2) {
        assert!(pair[0].0 + pair[0].1 <= pair[1].0, "{pair:x?}");
    }
}

/// A bus that writes down where it was written to.
struct Recorder(Vec<(u32, u32)>);

impl Bus for Recorder {
    fn read32(&mut self, address: u32) -> u32 {
        !address
    }
    fn write32(&mut self, address: u32, value: u32) {
        self.0.push((address, value));
    }
    fn wait_interrupt(&mut self, mask: u32, _timeout: Duration) -> u32 {
        mask
    }
}

#[test]
fn bus_burst_to_memory_rises_and_to_the_fifo_stays() {
    let mut bus = Recorder(Vec::new());
    bus.write_burst(MEMORY_BASE, &[1, 2]);
    bus.write_burst(FIFO_BASE, &[3, 4]);
    assert_eq!(bus.0, [(0x4000_0000, 1), (0x4000_0004, 2), (0x8000, 3), (0x8000, 4)]);
    let mut words = [0; 2];
    bus.read_burst(0x10, &mut words);
    assert_eq!(words, [!0x10, !0x14]);
}
