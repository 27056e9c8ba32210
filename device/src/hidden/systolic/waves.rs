//! Waveforms: the registers of some elements over some clocks, as a VCD text for GTKWave and the like.
//!
//! A clock is 10 ns, from one rising edge of `card.systolic.clock` to the next; times count from the first
//! clock of the scene. At a rising edge each register shows what it took from the clock before, the feeder what
//! stands on the ports of element 0 in this clock, `bus` what is driven in this clock.
//!
//! | scope | signals |
//! | --- | --- |
//! | `card.systolic` | `clock` |
//! | `card.systolic.feeder` | the ports of element 0: `A`, `B`, `C_minimum`, `C_maximum`, `CTRL` |
//! | `card.systolic.pe[000]` ... | the same of each element, and `Zb`, `Ib`, `Ib_kind`, `IN`, and `phase`, the timing it is in |
//! | `card.systolic.bus` | `luminance`, `kind` (0 background, 1 tag, 2 colour), `depth`, `valid` |
//!
//! With the Super Buffer the elements have its registers instead.

use super::Machine;
use super::token::Pixel;
use std::io;
use std::ops::Range;
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value, Writer};

/// Nanoseconds of a clock.
pub const PERIOD: u64 = 10;
/// Text that is kept, bytes, about; what comes later is left out.
const LIMIT: usize = 256 << 20;

/// Bits of the bus signals.
const BUS: [(&str, u32); 4] = [("luminance", 32), ("kind", 2), ("depth", 32), ("valid", 1)];

/// A waveform being recorded.
#[derive(Debug)]
pub struct Waves {
    line: u32,
    clocks: Range<u64>,
    elements: Range<u32>,
    /// The clock in which the line begins, once it has.
    begun: Option<u64>,
    text: Text,
}

/// A signal and what it was last.
#[derive(Clone, Copy, Debug)]
struct Signal {
    id: IdCode,
    bits: u32,
    last: Option<u64>,
}

/// VCD text as it grows.
#[derive(Debug, Default)]
struct Text {
    bytes: Vec<u8>,
    clock: Option<IdCode>,
    feeder: Vec<Signal>,
    elements: Vec<Vec<Signal>>,
    bus: Vec<Signal>,
    /// The rising edge written last.
    time: Option<u64>,
}

impl Waves {
    /// Will record clocks `clocks` of line `line`, counted from the one in which its first token can enter, and
    /// elements `elements`. A scene's later lines are recorded where they fall into these clocks.
    #[must_use]
    pub fn new(line: u32, clocks: Range<u64>, elements: Range<u32>) -> Waves {
        Waves { line, clocks, elements, begun: None, text: Text::default() }
    }

    /// The VCD text; without a signal in it if no scene was drawn.
    #[must_use]
    pub fn finish(self) -> Vec<u8> {
        let mut text = self.text;
        if let Some(time) = text.time {
            // Writing to memory does not fail.
            Writer::new(&mut text.bytes).timestamp(time + PERIOD).unwrap_or_default();
        }
        text.bytes
    }

    /// A scene begins on a machine of `count` elements; what was recorded before is forgotten.
    pub(super) fn begin_scene<M: Machine>(&mut self, count: u32) {
        self.begun = None;
        let elements = self.elements.start.min(count)..self.elements.end.min(count);
        self.text = Text::default();
        self.text.header::<M>(elements).unwrap_or_default();
    }

    /// Line `y` begins in clock `clock`.
    pub(super) fn begin_line(&mut self, y: u32, clock: u64) {
        if y == self.line {
            self.begun = Some(clock);
        }
    }

    /// Whether clock `clock` of the scene is recorded.
    fn records(&self, clock: u64) -> bool {
        let of_line = self.begun.and_then(|begun| clock.checked_sub(begun));
        of_line.is_some_and(|clock| self.clocks.contains(&clock)) && self.text.bytes.len() < LIMIT
    }

    /// The rising edge of clock `clock`.
    pub(super) fn clock_begins<M: Machine>(&mut self, clock: u64, machine: &M, port: &M::Port) {
        if self.records(clock) {
            self.text.clock_begins(clock * PERIOD, self.elements.start as usize, machine, port).unwrap_or_default();
        }
    }

    /// What clock `clock` drove on the buses, and its falling edge.
    pub(super) fn clock_ends(&mut self, clock: u64, pixel: Option<&Pixel>) {
        if self.text.time == Some(clock * PERIOD) {
            self.text.clock_ends(pixel).unwrap_or_default();
        }
    }
}

impl Text {
    fn header<M: Machine>(&mut self, elements: Range<u32>) -> io::Result<()> {
        let mut writer = Writer::new(&mut self.bytes);
        writer.version("ZGA systolic scan-line array")?;
        writer.timescale(1, TimescaleUnit::NS)?;
        writer.add_module("card")?;
        writer.add_module("systolic")?;
        self.clock = Some(writer.add_wire(1, "clock")?);
        writer.add_module("feeder")?;
        self.feeder = signals(&mut writer, M::PORT_SIGNALS)?;
        writer.upscope()?;
        for element in elements {
            writer.add_module(&format!("pe[{element:03}]"))?;
            self.elements.push(signals(&mut writer, M::SIGNALS)?);
            writer.upscope()?;
        }
        writer.add_module("bus")?;
        self.bus = signals(&mut writer, &BUS)?;
        writer.upscope()?;
        writer.upscope()?;
        writer.upscope()?;
        writer.enddefinitions()
    }

    fn clock_begins<M: Machine>(&mut self, time: u64, first: usize, machine: &M, port: &M::Port) -> io::Result<()> {
        let mut writer = Writer::new(&mut self.bytes);
        writer.timestamp(time)?;
        if self.time.is_none() {
            // Until something is driven nothing is known of the bus.
            writer.begin(SimulationCommand::Dumpvars)?;
            for signal in &self.bus {
                undefined(&mut writer, signal, Value::X)?;
            }
            writer.end()?;
        }
        self.time = Some(time);
        if let Some(clock) = self.clock {
            writer.change_scalar(clock, true)?;
        }
        change(&mut writer, &mut self.feeder, &M::port_signals(port))?;
        for (element, signals) in (first..).zip(&mut self.elements) {
            change(&mut writer, signals, &machine.signals(element, port))?;
        }
        Ok(())
    }

    fn clock_ends(&mut self, pixel: Option<&Pixel>) -> io::Result<()> {
        let mut writer = Writer::new(&mut self.bytes);
        let valid = u64::from(pixel.is_some());
        if let Some(pixel) = pixel {
            let (kind, bits) = pixel.luminance.encode();
            let values = [u64::from(bits), u64::from(kind), u64::from(pixel.depth as u32), valid];
            change(&mut writer, &mut self.bus, &values)?;
        } else if let [driven @ .., flag] = self.bus.as_mut_slice() {
            // Nobody drives: the wires float.
            for signal in driven {
                if signal.last.take().is_some() {
                    undefined(&mut writer, signal, Value::Z)?;
                }
            }
            change(&mut writer, std::slice::from_mut(flag), &[valid])?;
        }
        let Some((time, clock)) = self.time.zip(self.clock) else { return Ok(()) };
        writer.timestamp(time + PERIOD / 2)?;
        writer.change_scalar(clock, false)
    }
}

/// Declares signals in the scope that is open.
fn signals(writer: &mut Writer<&mut Vec<u8>>, names: &[(&str, u32)]) -> io::Result<Vec<Signal>> {
    let declare = |&(name, bits): &(&str, u32)| Ok(Signal { id: writer.add_wire(bits, name)?, bits, last: None });
    names.iter().map(declare).collect()
}

/// Writes that a signal has no value.
fn undefined(writer: &mut Writer<&mut Vec<u8>>, signal: &Signal, value: Value) -> io::Result<()> {
    match signal.bits {
        1 => writer.change_scalar(signal.id, value),
        bits => writer.change_vector(signal.id, vec![value; bits as usize]),
    }
}

/// Writes the signals that have changed.
fn change(writer: &mut Writer<&mut Vec<u8>>, signals: &mut [Signal], values: &[u64]) -> io::Result<()> {
    for (signal, &value) in signals.iter_mut().zip(values) {
        if signal.last.replace(value) == Some(value) {
            continue;
        }
        if signal.bits == 1 {
            writer.change_scalar(signal.id, value != 0)?;
        } else {
            let bits = (0..signal.bits).rev().map(|bit| Value::from((value >> bit) & 1 != 0));
            writer.change_vector(signal.id, bits)?;
        }
    }
    Ok(())
}
