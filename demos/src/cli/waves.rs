//! `zga waves`: the registers of the systolic array, clock by clock.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use zga_abi::Counter;
use zga_abi::format::{Fidelity, HiddenSurface};

use super::flags::{LookFlags, UnitFlags, size};
use super::source::Source;
use super::{Verdict, note, print};
use crate::error::{Error, Result};
use crate::picture::write_file;
use crate::play::{Asked, Session};
use crate::scene::CardSettings;
use crate::table::grouped;

/// Clocks that are recorded where nothing is asked for.
const CLOCKS: u64 = 200;
/// Elements that are recorded where nothing is asked for.
const ELEMENTS: u32 = 16;

/// Record the registers of the systolic array as waveforms (VCD)
///
/// Draws the scene on the clocked array and records elements --pes over clocks --clocks of scan line --line. Clock 0 is
/// the one in which the line's first token can enter. The file opens in GTKWave and Surfer.
#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  zga waves systolic --line 40 --clocks 0..120 --pes 28..36 --out line.vcd\n  gtkwave line.vcd"
)]
pub(super) struct Waves {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// Scan line, from 0 at the top; the middle of the picture if none is named
    #[arg(long, value_name = "Y")]
    line: Option<u32>,
    /// Clocks of the line, the first and the one beyond the last [default: 0..200]
    #[arg(long, value_name = "A..B", value_parser = clocks)]
    clocks: Option<Range<u64>>,
    /// Elements, the first and the one beyond the last; an element is a pixel of the line [default: the first 16]
    #[arg(long, value_name = "A..B", value_parser = elements)]
    pes: Option<Range<u32>>,
    /// The waveforms
    #[arg(long, value_name = "FILE.vcd")]
    out: PathBuf,
    /// Frame of a demo that moves
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// Size of the picture in pixels, for example 640x480
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    units: UnitFlags,
}

impl Waves {
    pub(super) fn run(&self) -> Result<Verdict> {
        let units = self.units.settings();
        if units.fidelity == Some(Fidelity::Functional) {
            return Err(Error::Use(
                "--fidelity: functional has no registers to record; zga waves is clocked".to_owned(),
            ));
        }
        let card =
            CardSettings { hidden_surface: Some(HiddenSurface::Systolic), fidelity: Some(Fidelity::Clocked), ..units };
        let source = Source::open(&self.what, self.size, self.look.environment)?;
        let scene = source.scene(self.frame);
        let [width, height] = scene.size;
        let line = self.line.unwrap_or(height / 2);
        if line >= height {
            return Err(Error::Use(format!(
                "--line: {line} lies outside: {} has lines 0 to {}",
                source.name,
                height - 1
            )));
        }
        let clocks = self.clocks.clone().unwrap_or(0..CLOCKS);
        let pes = self.pes.clone().unwrap_or(0..ELEMENTS.min(width));
        if pes.end > width {
            let (from, to) = (pes.start, pes.end);
            return Err(Error::Use(format!(
                "--pes: {from}..{to} lies outside: {} has elements 0..{width}",
                source.name
            )));
        }
        let asked = Asked { size: self.size, card, ..Asked::default() };
        let mut session = Session::open(&source.name, &scene, &asked)?;
        let fault = |reason| Error::Card { place: source.name.clone(), reason };
        session.card().record_waves(line, clocks.clone(), pes.clone()).map_err(fault)?;
        let (_, cost) = session.frame(&scene, self.look.look())?;
        session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
        let vcd = session.card().take_waves().map_err(fault)?.unwrap_or_default();
        let Some(recorded) = recorded(&vcd) else {
            let (from, to, total) = (clocks.start, clocks.end, cost.counters.get(Counter::SystolicClocks));
            let why = format!("the scene ends {total} clocks after its first line began");
            return Err(Error::Use(format!("--clocks: {from}..{to} of line {line} holds nothing: {why}")));
        };
        write_file(&self.out, &vcd)?;
        print(&self.told(&source.name, line, &pes, &recorded))?;
        Ok(Verdict::Good)
    }

    /// What was recorded and how to look at it.
    fn told(&self, name: &str, line: u32, pes: &Range<u32>, recorded: &Recorded) -> String {
        let file = self.out.display();
        format!(
            "{file}: {name}, line {line}, elements {}..{}\n  {} clocks, from {} to {} ns of the scene, 10 ns each\n  {} \
             signals, {} bytes\n\nTo look at it: gtkwave {file}, or surfer {file}.\nThe signals of element n are in \
             card.systolic.pe[n], what enters the array in card.systolic.feeder, what leaves it in card.systolic.bus.\n",
            pes.start,
            pes.end,
            grouped(recorded.clocks),
            grouped(recorded.times[0]),
            grouped(recorded.times[1]),
            grouped(recorded.signals),
            grouped(recorded.bytes),
        )
    }
}

/// What a VCD text holds.
#[derive(Debug, PartialEq, Eq)]
struct Recorded {
    signals: u64,
    /// Rising edges.
    clocks: u64,
    /// First and last time, ns.
    times: [u64; 2],
    bytes: u64,
}

/// Looks into a VCD text; `None` if there is not a single time in it. Two times a clock, and one at the end.
fn recorded(vcd: &[u8]) -> Option<Recorded> {
    let lines = || vcd.split(|byte| *byte == b'\n');
    let signals = lines().filter(|line| line.starts_with(b"$var ")).count() as u64;
    let times = lines().filter_map(|line| std::str::from_utf8(line.strip_prefix(b"#")?).ok()?.trim().parse().ok());
    let times: Vec<u64> = times.collect();
    let (first, last) = (*times.first()?, *times.last()?);
    Some(Recorded { signals, clocks: times.len() as u64 / 2, times: [first, last], bytes: vcd.len() as u64 })
}

/// A range of clocks, as in 0..120.
fn clocks(text: &str) -> std::result::Result<Range<u64>, String> {
    let (from, to) = text.split_once("..").ok_or("expected A..B, for example 0..120")?;
    let number = |text: &str| text.parse::<u64>().map_err(|_| format!("{text:?} is no number; expected A..B"));
    let (from, to) = (number(from)?, number(to)?);
    if from < to { Ok(from..to) } else { Err(format!("{from}..{to} is empty: expected A below B")) }
}

/// A range of elements, as in 28..36.
fn elements(text: &str) -> std::result::Result<Range<u32>, String> {
    let range = clocks(text)?;
    let number = |value: u64| u32::try_from(value).map_err(|_| format!("{value} is too large for an element"));
    Ok(number(range.start)?..number(range.end)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_good_and_bad_ranges() {
        assert_eq!(clocks("3..7"), Ok(3..7));
        assert!(clocks("7").is_err_and(|fault| fault.contains("expected A..B")));
        assert!(clocks("7..7").is_err_and(|fault| fault.starts_with("7..7 is empty")));
        assert!(clocks("a..7").is_err_and(|fault| fault.starts_with("\"a\" is no number")));
        assert!(clocks("-1..7").is_err());
        assert!(elements("0..4294967296").is_err_and(|fault| fault.contains("too large")));
    }

    #[test]
    fn recorded_counts_signals_clocks_and_times() {
        let vcd = b"$var wire 1 ! clock $end\n$enddefinitions $end\n#70\n1!\n#75\n0!\n#80\n1!\n#85\n0!\n#90\n";
        let expected = Recorded { signals: 1, clocks: 2, times: [70, 90], bytes: vcd.len() as u64 };
        assert_eq!(recorded(vcd), Some(expected));
        assert_eq!(recorded(b"$enddefinitions $end\n"), None);
    }
}
