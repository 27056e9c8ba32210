//! What accuracy costs in time: every accuracy setting with its measured error against exact arithmetic and its measured
//! price.
//!
//! ```text
//!   tests/src/study      draws on a card, compares with the oracle: errors, counts, host times
//!          |
//!   axes, ...            a section each: sweeps, pictures, notes
//!          |
//!   report, verdict      plain values; what is dominated follows from the figures
//!        / | \
//! terminal json page     three ways to show the same
//! ```
//!
//! A part of the report is a line of [`PARTS`] and a function that makes its [`Section`].

mod axes;
mod context;
mod json;
mod page;
mod report;
mod terminal;
mod verdict;

pub use context::{Context, Effort, Options, picture};
pub use json::json;
pub use page::{html, standalone, svg};
pub use report::{
    Axis, By, Cell, Column, ErrorFigures, Kind, Origin, Panel, Plot, Point, Price, Report, Scale, Section, Series,
    Strip, Sweep, Table,
};
pub use terminal::text;
pub use verdict::{dominated, figure};

use crate::error::Result;

/// Makes a section.
pub type Measure = fn(&mut Context<'_>) -> Result<Section>;

/// The parts of the report in order: name on the command line, what it is about, how it is made.
pub const PARTS: &[(&str, &str, Measure)] = &[("grid", "mask grid: samples of a pixel", axes::grid::section)];

/// Measures the parts with these names; all of them if there is none. `tell` is called with what is being measured,
/// `done` when a part is.
///
/// # Errors
/// What is wrong with the mesh file; what the card refuses.
pub fn measure(
    names: &[&str],
    options: &Options,
    tell: &mut dyn FnMut(&str),
    done: &mut dyn FnMut(),
) -> Result<Report> {
    let mut context = Context::new(options, tell)?;
    let wanted = PARTS.iter().filter(|(name, ..)| names.is_empty() || names.contains(name));
    let mut sections = Vec::new();
    for (_, about, measure) in wanted {
        context.tell(about);
        sections.push(measure(&mut context)?);
        done();
    }
    let headlines = Vec::new();
    Ok(Report { origin: context::origin(options), headlines, sections })
}
