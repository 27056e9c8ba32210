//! `zga trace`: every bus write of a run, recorded and replayed.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, Subcommand};
use zga_device::{Card, CardOptions};
use zga_driver::trace::{self, TraceReader};

use super::flags::{CardFlags, LookFlags};
use super::source::Source;
use super::{Verdict, note, print, progress};
use crate::error::{Error, Result};
use crate::play::{MOST_ZA_RAM, Session};
use crate::table::{columns, grouped, row};

/// Longest wait for a fence of a replay.
const TIMEOUT: Duration = Duration::from_secs(60);

/// Record every bus write of a run, replay it, look into it
#[derive(Args, Debug)]
pub(super) struct Trace {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Record(Record),
    Replay(Replay),
    Info(Info),
}

/// Draw a scene and record every bus write
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga trace record teapot.zga teapot --frames 3")]
struct Record {
    /// The trace
    file: PathBuf,
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE", default_value = "teapot")]
    what: String,
    /// Frames
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    card: CardFlags,
}

/// Replay a trace on a fresh card and compare every frame
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga trace replay teapot.zga")]
struct Replay {
    /// The trace
    file: PathBuf,
    /// Host threads that draw; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

/// Check a trace and tell what it holds
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga trace info teapot.zga")]
struct Info {
    /// The trace
    file: PathBuf,
}

impl Trace {
    pub(super) fn run(&self) -> Result<Verdict> {
        match &self.command {
            Command::Record(command) => command.run(),
            Command::Replay(command) => command.run(),
            Command::Info(command) => command.run(),
        }
    }
}

impl Record {
    fn run(&self) -> Result<Verdict> {
        let asked = self.card.asked();
        let source = Source::open(&self.what, asked.size, self.look.environment)?;
        let file = &self.file;
        let to = BufWriter::new(File::create(file).map_err(Error::write(file))?);
        let mut session = Session::record(&source.name, &source.scene(0), &asked, to, file)?;
        let bar = progress::bar(u64::from(self.frames), "frames");
        let mut text = String::new();
        for number in 0..self.frames {
            let (frame, _) = session.frame(&source.scene(number), self.look.look())?;
            text.push_str(&format!("frame {number}: {}\n", frame.hash));
            bar.inc(1);
        }
        bar.finish_and_clear();
        session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
        session.finish_recording(file)?;
        let bytes = std::fs::metadata(file).map_or(0, |data| data.len());
        text.push_str(&format!("{}: {} bytes\n", file.display(), grouped(bytes)));
        print(&text)?;
        Ok(Verdict::Good)
    }
}

impl Replay {
    fn run(&self) -> Result<Verdict> {
        let file = &self.file;
        let fault = |reason| Error::Trace { file: file.clone(), reason };
        let video_memory = TraceReader::new(open(file)?).map_err(fault)?.video_memory();
        // More Za RAM than the recorded card had changes nothing: base addresses are in the trace.
        let options =
            CardOptions { video_memory, za_ram: MOST_ZA_RAM, threads: self.threads, ..CardOptions::default() };
        let place = || file.display().to_string();
        let card = Card::power_on(options).map_err(|reason| Error::Card { place: place(), reason })?;
        let report = trace::replay(open(file)?, &mut card.bus(), TIMEOUT).map_err(fault)?;
        let mut text = String::new();
        for (number, frame) in report.frames.iter().enumerate() {
            let verdict = if frame.expected == frame.found {
                "equal".to_owned()
            } else {
                format!("differs: {} was recorded", frame.expected)
            };
            text.push_str(&format!("frame {number}: {} x {}  {}  {verdict}\n", frame.width, frame.height, frame.found));
        }
        text.push_str(&format!(
            "{} records replayed, {} words written, {} read-backs compared, {} differ\n",
            grouped(report.records),
            grouped(report.words_written),
            grouped(report.compared),
            grouped(report.differences),
        ));
        if let Some(first) = report.first_difference {
            let (record, words, address) = (first.record, first.words, first.address);
            text.push_str(&format!("first difference: record {record}, {words} words at {address:#010x}\n"));
        }
        print(&text)?;
        Ok(if report.is_equal() { Verdict::Good } else { Verdict::Bad })
    }
}

impl Info {
    fn run(&self) -> Result<Verdict> {
        let file = &self.file;
        let info = trace::info(open(file)?).map_err(|reason| Error::Trace { file: file.clone(), reason })?;
        let number = |name, value: u64| row([name, &grouped(value)]);
        let rows = [
            number("video memory, bytes", info.video_memory.into()),
            number("file, bytes", info.file_bytes),
            number("blocks", info.blocks.into()),
            number("records", info.records),
            number("words written", info.words_written),
            number("words read in bursts", info.words_read),
            number("fences reached", info.fences),
            number("frames", info.frames.len() as u64),
        ];
        let mut text = format!("{}\n{}", file.display(), columns("  ", &[], &rows));
        for (number, hash) in info.frames.iter().enumerate() {
            text.push_str(&format!("  frame {number}  {hash}\n"));
        }
        print(&text)?;
        Ok(Verdict::Good)
    }
}

fn open(file: &Path) -> Result<BufReader<File>> {
    File::open(file).map(BufReader::new).map_err(|reason| Error::Read { file: file.to_path_buf(), reason })
}
