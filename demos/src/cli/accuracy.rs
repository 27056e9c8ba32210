//! `zga accuracy`: what accuracy costs in time.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::flags::size;
use super::{Verdict, note, print, progress};
use crate::accuracy::{self, Effort, Options, PARTS};
use crate::error::Result;
use crate::picture::write_file;

/// Show what accuracy costs in time: each setting's error against exact arithmetic, and its price
///
/// Sweeps one setting with the others at their best, on random scenes and on a mesh. Errors and clocks are the same on
/// every machine for a seed; host times are this machine's.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga accuracy\n  zga accuracy grid depth-bits --json -\n  zga accuracy --full --html accuracy.html"
)]
pub(super) struct Accuracy {
    /// What to measure; everything if nothing is named
    #[arg(value_name = "AXIS", value_parser = part())]
    axes: Vec<&'static str>,
    /// Under a minute; what is done if nothing is asked for
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Minutes, with small standard errors
    #[arg(long)]
    full: bool,
    /// Seed of the random scenes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Mesh (.obj, .gltf, .glb) in place of the teapot
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Size of the pictures of the mesh in pixels
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = size)]
    size: [u32; 2],
    /// Host threads that draw; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Write it all as JSON; - for the standard output, in place of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write it all as one page with plots and pictures
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Write a Markdown fragment and a plot for a README
    #[arg(long, value_name = "FOLDER")]
    readme: Option<PathBuf>,
}

/// A parser for the names of the parts.
fn part() -> impl TypedValueParser<Value = &'static str> {
    let values = PARTS.iter().map(|(name, about, _)| PossibleValue::new(*name).help(*about));
    PossibleValuesParser::new(values).try_map(|text| {
        let found = PARTS.iter().find(|(name, ..)| *name == text);
        found.map(|(name, ..)| *name).ok_or_else(|| format!("{text} is not an axis"))
    })
}

impl Accuracy {
    pub(super) fn run(&self) -> Result<Verdict> {
        let Self { seed, size, threads, .. } = *self;
        let effort = if self.full { Effort::Full } else { Effort::Quick };
        let options = Options { seed, effort, size, threads, mesh: self.mesh.clone() };
        let parts = if self.axes.is_empty() { PARTS.len() } else { self.axes.len() };
        let bar = progress::named_bar(parts as u64);
        let report =
            accuracy::measure(&self.axes, &options, &mut |what| bar.set_message(what.to_owned()), &mut || bar.inc(1))?;
        bar.finish_and_clear();
        let json = format!("{:#}\n", accuracy::json(&report));
        let to_output = self.json.as_deref() == Some(Path::new("-"));
        if to_output {
            print(&json)?;
        } else {
            print(&accuracy::text(&report))?;
        }
        let write = |file: &Option<PathBuf>, text: &str| -> Result<()> {
            if let Some(file) = file.as_ref().filter(|file| *file != Path::new("-")) {
                write_file(file, text.as_bytes())?;
                note(&file.display().to_string());
            }
            Ok(())
        };
        write(&self.json, &json)?;
        write(&self.html, &accuracy::html(&report))?;
        if let Some(folder) = &self.readme {
            let (text, plot) = accuracy::fragment(&report);
            write(&Some(folder.join("accuracy.md")), &text)?;
            if let Some(plot) = plot {
                write(&Some(folder.join(accuracy::PLOT)), &plot)?;
            }
        }
        Ok(Verdict::Good)
    }
}
