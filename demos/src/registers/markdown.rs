//! The manual as Markdown tables.

use zga_abi::packet::Opcode;
use zga_abi::registers::REGISTERS;
use zga_abi::{ABI_VERSION, Counter, FaultCode};

use super::text::plain;
use super::{Bit, WINDOWS, effects, offset, reset, span, units};

/// The manual as Markdown.
#[must_use]
pub fn markdown() -> String {
    let mut text = format!("# ZGA card, register interface {}.{}\n", ABI_VERSION >> 16, ABI_VERSION & 0xFFFF);
    table(
        &mut text,
        "Address map",
        "| from | to | window | |\n| --- | --- | --- | --- |",
        WINDOWS.iter().map(|window| {
            let last = window.base + (window.bytes - 1);
            format!("`{:#010x}` | `{last:#010x}` | {} | {}", window.base, window.name, window.doc)
        }),
    );
    table(
        &mut text,
        "Registers",
        "| offset | register | access | reset | writable | write 1 to clear | meaning |\n\
         | --- | --- | --- | --- | --- | --- | --- |",
        REGISTERS.iter().map(|register| {
            format!(
                "`{}` | {} | {} | `{}` | `{:#010x}` | `{:#010x}` | {}",
                offset(register),
                register.name,
                register.access.name(),
                reset(register),
                register.writable,
                register.write_one_to_clear,
                register.doc.trim(),
            )
        }),
    );
    table(
        &mut text,
        "Fields",
        "| register | bits | field | meaning |\n| --- | --- | --- | --- |",
        REGISTERS.iter().flat_map(|register| {
            register.fields.iter().map(|field| {
                format!("{} | {} | {} | {}", register.name, span(field.hi, field.lo), field.name, field.doc)
            })
        }),
    );
    table(
        &mut text,
        "Packets",
        "| opcode | packet | payload words | meaning |\n| --- | --- | --- | --- |",
        Opcode::ALL.iter().map(|packet| {
            let doc = plain(packet.doc());
            format!("`{:#04x}` | {} | {} | {doc}", *packet as u32, packet.name(), packet.payload())
        }),
    );
    table(
        &mut text,
        "Faults",
        "| code | fault | meaning |\n| --- | --- | --- |",
        FaultCode::ALL.iter().map(|code| format!("{} | {} | {}", *code as u32, code.name(), code.doc().trim())),
    );
    table(
        &mut text,
        "Counters",
        "| offset | counter | meaning |\n| --- | --- | --- |",
        Counter::ALL
            .iter()
            .map(|counter| format!("`{:#06x}` | {} | {}", counter.offset(), counter.name(), counter.doc())),
    );
    bits(&mut text, "Effects", &effects());
    bits(&mut text, "Units", &units());
    text
}

fn bits(text: &mut String, title: &str, bits: &[Bit]) {
    let rows = bits.iter().map(|bit| format!("{} | {} | {}", bit.bit, bit.name, bit.doc));
    table(text, title, "| bit | name | meaning |\n| --- | --- | --- |", rows);
}

fn table(text: &mut String, title: &str, head: &str, rows: impl Iterator<Item = String>) {
    text.push_str(&format!("\n## {title}\n\n{head}\n"));
    for row in rows {
        text.push_str(&format!("| {row} |\n"));
    }
}
