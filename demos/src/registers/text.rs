//! The manual as aligned text.

use zga_abi::packet::Opcode;
use zga_abi::register::Register;
use zga_abi::registers::REGISTERS;
use zga_abi::{ABI_VERSION, Counter, FaultCode};

use super::{Bit, WINDOWS, effects, offset, reset, span, units};
use crate::table::{Align, lines, row, wrapped};

/// Characters of a line.
pub(super) const WIDTH: usize = 110;

/// The manual as text for the terminal.
#[must_use]
pub fn text() -> String {
    let mut text = format!("ZGA card, register interface {}.{}\n", ABI_VERSION >> 16, ABI_VERSION & 0xFFFF);
    heading(&mut text, "Address map", "byte addresses; all accesses are aligned 32-bit words");
    let windows = WINDOWS.iter().map(|window| {
        let end = u64::from(window.base) + u64::from(window.bytes);
        vec![format!("{:#010x}..{end:08x}", window.base), window.name.to_owned(), window.doc.to_owned()]
    });
    text.push_str(&wrapped("  ", &[], &windows.collect::<Vec<_>>(), WIDTH));

    heading(&mut text, "Registers", "RO read only, RW read and write, WO write only, W1C write 1 to clear");
    for register in REGISTERS {
        self::register(&mut text, register);
    }
    heading(&mut text, "Packets", "header: 31:24 opcode, 23:20 zero, 19:0 words that follow");
    for packet in Opcode::ALL {
        text.push_str(&format!("  {:#04x}  {}\n", *packet as u32, packet.name()));
        paragraph(&mut text, 8, &plain(packet.doc()));
        if !packet.payload().is_empty() {
            paragraph(&mut text, 8, &format!("Payload: {}", packet.payload()));
        }
    }
    heading(&mut text, "Faults", "values of ERROR_CODE");
    let faults = FaultCode::ALL
        .iter()
        .map(|code| vec![(*code as u32).to_string(), code.name().to_owned(), code.doc().trim().to_owned()]);
    text.push_str(&wrapped("  ", &[Align::Right], &faults.collect::<Vec<_>>(), WIDTH));

    heading(&mut text, "Counters", "64 bits each, low word first, from COUNTERS on");
    let counters = Counter::ALL
        .iter()
        .map(|counter| vec![format!("{:#06x}", counter.offset()), counter.name().to_owned(), counter.doc().to_owned()]);
    text.push_str(&wrapped("  ", &[], &counters.collect::<Vec<_>>(), WIDTH));

    heading(&mut text, "Effects", "bits of EFFECTS, CAPABILITY_EFFECTS, EFFECTS_CALLED");
    text.push_str(&bits(&effects()));
    heading(&mut text, "Units", "bits of UNITS_POWERED");
    text.push_str(&bits(&units()));
    text
}

fn heading(text: &mut String, title: &str, remark: &str) {
    text.push_str(&format!("\n{title}: {remark}\n{}\n", "-".repeat(title.len() + 2 + remark.len())));
}

fn bits(bits: &[Bit]) -> String {
    let rows = bits.iter().map(|bit| vec![bit.bit.to_string(), bit.name.clone(), bit.doc.to_owned()]);
    wrapped("  ", &[Align::Right], &rows.collect::<Vec<_>>(), WIDTH)
}

fn register(text: &mut String, register: &Register) {
    let mut head = format!("  {}  {}  {}", offset(register), register.name, register.access.name());
    match register.reset {
        [0] => {}
        _ => head.push_str(&format!("  reset {}", reset(register))),
    }
    if register.writable != 0 && register.writable != u32::MAX {
        head.push_str(&format!("  writable {:#010x}", register.writable));
    }
    if register.write_one_to_clear != 0 {
        head.push_str(&format!("  clears {:#010x}", register.write_one_to_clear));
    }
    text.push_str(&head);
    text.push('\n');
    paragraph(text, 10, register.doc);
    let fields: Vec<Vec<String>> =
        register.fields.iter().map(|field| row([&span(field.hi, field.lo), field.name, field.doc])).collect();
    text.push_str(&wrapped("          ", &[Align::Right], &fields, WIDTH));
}

/// Text broken into lines, `indent` spaces before each.
fn paragraph(text: &mut String, indent: usize, words: &str) {
    for line in lines(words, WIDTH - indent) {
        text.push_str(&format!("{}{line}\n", " ".repeat(indent)));
    }
}

/// A doc line without the links of its source.
pub(super) fn plain(doc: &str) -> String {
    doc.trim().replace("[`", "").replace("`]", "").replace('`', "")
}
