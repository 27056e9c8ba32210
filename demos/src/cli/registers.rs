//! `zga registers`: the register map, from the declarations that card and driver are made of.

use clap::{Args, ValueEnum};

use super::{Verdict, print};
use crate::error::Result;
use crate::registers;

/// Print the manual: registers, packets, faults, counters, effects, units
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga registers --format markdown > registers.md")]
pub(super) struct Registers {
    /// Form of the manual
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// Aligned text for the terminal
    Text,
    /// Tables
    Markdown,
    /// For programs
    Json,
}

impl Registers {
    pub(super) fn run(&self) -> Result<Verdict> {
        let manual = match self.format {
            Format::Text => registers::text(),
            Format::Markdown => registers::markdown(),
            Format::Json => registers::json(),
        };
        print(&manual)?;
        Ok(Verdict::Good)
    }
}
