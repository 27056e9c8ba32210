//! The manual as JSON.

use serde_json::{Value, json as object};
use zga_abi::packet::Opcode;
use zga_abi::register::Register;
use zga_abi::registers::REGISTERS;
use zga_abi::{ABI_VERSION, Counter, FaultCode};

use super::text::plain;
use super::{Bit, WINDOWS, effects, units};

/// The manual as JSON: `version`, `address_map`, `registers`, `packets`, `faults`, `counters`, `effects`, `units`.
#[must_use]
pub fn json() -> String {
    let list = |values: Vec<Value>| Value::Array(values);
    let window = |w: &super::Window| object!({"name": w.name, "base": w.base, "bytes": w.bytes, "doc": w.doc});
    let packet = |packet: &Opcode| object!({"opcode": *packet as u32, "name": packet.name(), "payload": packet.payload(), "doc": plain(packet.doc())});
    let fault = |code: &FaultCode| object!({"code": *code as u32, "name": code.name(), "doc": code.doc().trim()});
    let counter = |counter: &Counter| object!({"index": *counter as u32, "offset": counter.offset(), "name": counter.name(), "doc": counter.doc()});
    let bit = |bit: &Bit| object!({"bit": bit.bit, "name": bit.name, "doc": bit.doc});
    let manual = object!({
        "version": [ABI_VERSION >> 16, ABI_VERSION & 0xFFFF],
        "address_map": list(WINDOWS.iter().map(window).collect()),
        "registers": list(REGISTERS.iter().map(register).collect()),
        "packets": list(Opcode::ALL.iter().map(packet).collect()),
        "faults": list(FaultCode::ALL.iter().map(fault).collect()),
        "counters": list(Counter::ALL.iter().map(counter).collect()),
        "effects": list(effects().iter().map(bit).collect()),
        "units": list(units().iter().map(bit).collect()),
    });
    format!("{manual:#}\n")
}

fn register(register: &Register) -> Value {
    let fields: Vec<Value> = register
        .fields
        .iter()
        .map(|field| {
            object!({"hi": field.hi, "lo": field.lo, "mask": field.mask(), "name": field.name, "doc": field.doc})
        })
        .collect();
    let reset: Vec<u32> = (0..register.count).map(|index| register.reset_value(index)).collect();
    object!({
        "name": register.name,
        "offset": register.offset,
        "count": register.count,
        "access": register.access.name(),
        "reset": if reset.iter().all(|value| *value == reset[0]) { object!(reset[0]) } else { object!(reset) },
        "writable": register.writable,
        "write_one_to_clear": register.write_one_to_clear,
        "fields": fields,
        "doc": register.doc.trim(),
    })
}
