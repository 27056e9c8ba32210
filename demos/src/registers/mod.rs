//! The manual of the card: address map, registers, packets, faults, counters, effects and units, from the declarations
//! in `zga_abi` and nowhere else.
//!
//! | file | form |
//! | --- | --- |
//! | `text` | aligned text for the terminal |
//! | `markdown` | tables |
//! | `json` | for programs |

mod json;
mod markdown;
mod text;

use zga_abi::bus::{
    FIFO_BASE, FIFO_BYTES, MEMORY_BASE, MEMORY_BYTES, REGISTERS_BASE, REGISTERS_BYTES, ZA_BASE, ZA_BYTES,
};
use zga_abi::register::Register;

pub use json::json;
pub use markdown::markdown;
pub use text::text;

/// A part of the card's address space.
struct Window {
    name: &'static str,
    base: u32,
    bytes: u32,
    doc: &'static str,
}

/// The address map.
const WINDOWS: [Window; 4] = [
    Window {
        name: "registers",
        base: REGISTERS_BASE,
        bytes: REGISTERS_BYTES,
        doc: "The register aperture; offsets below count from here.",
    },
    Window {
        name: "FIFO",
        base: FIFO_BASE,
        bytes: FIFO_BYTES,
        doc: "A write anywhere inside pushes one word of a packet; a full FIFO stalls the writer.",
    },
    Window {
        name: "Za RAM",
        base: ZA_BASE,
        bytes: ZA_BYTES,
        doc: "Status words of the Za path; the RAM behind the window is ZA_RAM_SIZE bytes.",
    },
    Window {
        name: "video memory",
        base: MEMORY_BASE,
        bytes: MEMORY_BYTES,
        doc: "Frame buffers, Z buffers, rings, vertices; the memory behind the window is VIDEO_MEMORY_SIZE bytes.",
    },
];

/// What a bit of EFFECTS or UNITS_POWERED stands for.
struct Bit {
    bit: u32,
    name: String,
    doc: &'static str,
}

/// The bits of a flags register, lowest first, from its fields.
fn bits(register: &Register) -> Vec<Bit> {
    register
        .fields
        .iter()
        .rev()
        .map(|field| Bit { bit: field.lo, name: field.name.to_owned(), doc: field.doc })
        .collect()
}

/// The effects.
fn effects() -> Vec<Bit> {
    bits(zga_abi::Reg::Effects.info())
}

/// The units.
fn units() -> Vec<Bit> {
    let mut units = bits(zga_abi::Reg::UnitsPowered.info());
    for unit in &mut units {
        if unit.doc.is_empty() {
            unit.doc = unit_doc(&unit.name);
        }
    }
    units
}

/// What a unit is, where its field does not say so.
fn unit_doc(name: &str) -> &'static str {
    match name {
        "frontend" => "register file, FIFO, ring, command processor: always powered",
        "geometry" => "transform, clip, setup",
        "z_buffer" => "plain Z buffer",
        "za" => "Z buffer with block status words",
        "systolic" => "systolic scan-line array",
        "tile" => "sorted tiles",
        "subpixel" => "sub-pixel masks",
        "texture" => "texture",
        "shading" => "colours, lights, fog, blending",
        "bitmap" => "fills, copies, conversions, stretches, compositions, transfers",
        "scanout" => "display controller",
        "probe" => "pixel history",
        _ => "",
    }
}

/// Reset value as text: one word, or what a row of words holds.
fn reset(register: &Register) -> String {
    let word = |value: u32| format!("{value:#010x}");
    match register.reset {
        [value] => word(*value),
        values => {
            let floats: Vec<String> = values.iter().map(|value| f32::from_bits(*value).to_string()).collect();
            format!("f32 {}", floats.join(" "))
        }
    }
}

/// Offset, or first and last offset of a row, four hexadecimal digits each.
fn offset(register: &Register) -> String {
    match register.count {
        1 => format!("{:#06x}", register.offset),
        count => format!("{:#06x}..{:04x}", register.offset, register.word_offset(count - 1)),
    }
}

/// Bits of a field: `31:16`, or `3`.
fn span(hi: u32, lo: u32) -> String {
    if hi == lo { hi.to_string() } else { format!("{hi}:{lo}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zga_abi::{Counter, FaultCode};

    #[test]
    fn units_all_have_a_line_and_match_the_flags() {
        let names: Vec<String> = units().iter().map(|unit| unit.name.to_uppercase()).collect();
        let flags: Vec<String> = zga_abi::Units::all().iter_names().map(|(name, _)| name.to_owned()).collect();
        assert_eq!(names, flags);
        assert!(units().iter().all(|unit| !unit.doc.is_empty()));
        let names: Vec<String> = effects().iter().map(|effect| effect.name.to_uppercase()).collect();
        let flags: Vec<String> = zga_abi::Effects::all().iter_names().map(|(name, _)| name.to_owned()).collect();
        assert_eq!(names, flags);
    }

    #[test]
    fn manual_every_form_holds_every_declaration() {
        for manual in [text(), markdown(), json()] {
            for register in zga_abi::registers::REGISTERS {
                assert!(manual.contains(register.name), "{}", register.name);
            }
            for code in FaultCode::ALL {
                assert!(manual.contains(code.name()), "{}", code.name());
            }
            for counter in Counter::ALL {
                assert!(manual.contains(counter.name()), "{}", counter.name());
            }
            for packet in zga_abi::packet::Opcode::ALL {
                assert!(manual.contains(packet.name()), "{}", packet.name());
            }
        }
    }

    #[test]
    fn text_known_register_reads_as_in_the_manual() {
        let text = text();
        assert!(text.contains("0x0200  TARGET_SIZE"), "{text}");
        assert!(text.contains("0x0400..043c  OBJECT_EYE"));
        assert!(text.contains("30:16  height  pixels"));
        assert!(text.lines().all(|line| line.chars().count() <= text::WIDTH && line.trim_end() == line), "lines fit");
    }

    #[test]
    fn json_known_fields_have_their_numbers() {
        let value: serde_json::Value = serde_json::from_str(&json()).expect("valid");
        let registers = value["registers"].as_array().expect("a list");
        assert_eq!(registers.len(), zga_abi::registers::REGISTERS.len());
        let size = registers.iter().find(|register| register["name"] == "TARGET_SIZE").expect("there");
        assert_eq!(size["offset"], 0x200);
        assert_eq!(size["fields"][0]["mask"], 0x7FFF_0000);
        assert_eq!(value["address_map"][3]["base"], 0x4000_0000);
    }
}
