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
mod decal;
mod json;
mod model;
mod page;
mod readme;
mod report;
mod terminal;
mod verdict;

pub use axes::presets::{BOUNDS, Bounds};
pub use context::{Context, Effort, Options, picture};
pub use json::json;
pub use page::{html, standalone, svg};
pub use readme::{PLOT, fragment};
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
pub const PARTS: &[(&str, &str, Measure)] = &[
    ("presets", "presets: accuracy by name", axes::presets::section),
    ("combined", "all settings together, and the Pareto line", axes::combined::section),
    ("grid", "mask grid: samples of a pixel", axes::grid::section),
    ("subpixel-depth", "who is in front inside a pixel: centre, search, exhaustive", axes::order::section),
    ("subpixel-edges", "edges inside a surface: with samples or without", axes::edges::section),
    ("depth-bits", "bits of a depth and of its fraction", axes::depth::bits),
    ("depth-fraction", "fraction bits: drift over 16384 pixels", axes::depth::fraction),
    ("coordinates", "bits of a coordinate behind the point", axes::coordinates::section),
    ("texture", "texture filter: nearest, bilinear, trilinear", axes::filter::section),
    ("shading", "shading: flat, Gouraud, per pixel", axes::shading::section),
    ("za-prediction", "Za prediction: blocks not bypassed", axes::bypass::section),
    ("fidelity", "simulation: functional or clocked", axes::fidelity::section),
    ("decal", "surface markings: slope S", decal::section),
];

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
    let headlines = headlines(&sections);
    Ok(Report { origin: context::origin(options), headlines, sections })
}

/// What matters most: a sentence of each of the first sections, what is free, what is never worth it.
fn headlines(sections: &[Section]) -> Vec<String> {
    let sweeps =
        || sections.iter().filter(|section| section.name != "presets").map(|section| (section, &section.sweeps));
    let name = |section: &Section| section.title.split(':').next().unwrap_or_default().to_owned();
    let mut all: Vec<String> = sections
        .iter()
        .filter_map(|section| match section.name {
            "combined" => section.findings.first().cloned(),
            "grid" => section.findings.first().map(|line| format!("Samples of a pixel: {line}")),
            "presets" => section.findings.last().map(|line| format!("Preset {line}")),
            "subpixel-depth" | "subpixel-edges" => section.findings.last().cloned(),
            _ => None,
        })
        .collect();
    let mut free = Vec::new();
    let mut lost = Vec::new();
    for (section, sweeps) in sweeps() {
        if !sweeps.is_empty() && sweeps.iter().all(verdict::is_free) {
            free.push(name(section));
        }
        // A setting that some scene has a use for is none that is never worth it.
        let losers = |sweep: &Sweep| -> Vec<String> {
            let points = sweep.points.iter().zip(verdict::of_sweep(sweep));
            points.filter(|(_, by)| by.is_some()).map(|(point, _)| point.setting.clone()).collect()
        };
        let mut each = sweeps.iter().map(losers);
        let mut always = each.next().unwrap_or_default();
        for other in each {
            always.retain(|setting| other.contains(setting));
        }
        if !sweeps.iter().all(verdict::is_free) && !always.is_empty() {
            lost.push(format!("{} ({})", always.join(" and "), name(section).to_lowercase()));
        }
    }
    let noise = noise(sections);
    if !free.is_empty() {
        all.push(format!(
            "Free in clocks, so there is no reason for less than the best: {}.",
            free.join(", ").to_lowercase()
        ));
    }
    if !lost.is_empty() {
        all.push(format!(
            "Never worth it, because another setting is as exact and as cheap or better: {}.",
            lost.join("; ")
        ));
    }
    if noise > NOISY {
        all.push(format!(
            "Host times were noisy in this run (their quartiles typically lie {} % from the median): take them as orders of \
             magnitude. Errors and clocks have no such noise.",
            figure(100.0 * noise)
        ));
    }
    all
}

/// Relative spread of host times beyond which that is told.
const NOISY: f64 = 0.1;

/// The typical spread of a host time, relative to the time: the middle one over all settings; 0 where none was measured.
fn noise(sections: &[Section]) -> f64 {
    let points = sections.iter().flat_map(|section| &section.sweeps).flat_map(|sweep| &sweep.points);
    let mut all: Vec<f64> = points.filter_map(|point| Some(point.price.spread? / point.price.nanoseconds?)).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(settings: &[(&str, f64, f64)]) -> Section {
        let point = |&(setting, mean, clocks): &(&str, f64, f64)| Point {
            setting: setting.to_owned(),
            error: ErrorFigures { mean: Some(mean), ..ErrorFigures::default() },
            price: Price { clocks: Some(clocks), nanoseconds: Some(10.0), spread: Some(4.0) },
        };
        let points = settings.iter().map(point).collect();
        let sweep = Sweep { scene: String::new(), measure: String::new(), unit: "", by: By::Mean, points };
        Section { name: "axis", title: "The axis: explained".to_owned(), sweeps: vec![sweep], ..Section::default() }
    }

    #[test]
    fn headlines_name_free_axes_lost_settings_and_noise() {
        let free = headlines(&[section(&[("a", 2.0, 5.0), ("b", 1.0, 5.0)])]);
        assert!(free[0].starts_with("Free in clocks") && free[0].ends_with("the axis."), "{free:?}");
        let lost = headlines(&[section(&[("a", 2.0, 5.0), ("b", 1.0, 4.0), ("c", 0.5, 9.0)])]);
        assert!(lost[0].contains("Never worth it") && lost[0].ends_with("a (the axis)."), "{lost:?}");
        assert!(lost[1].contains("40 % from the median"), "{lost:?}");
    }

    #[test]
    fn parts_have_names_that_are_anchors_and_no_two_the_same() {
        let mut names: Vec<&str> = PARTS.iter().map(|(name, ..)| *name).collect();
        assert!(names.iter().all(|name| name.chars().all(|c| c.is_ascii_lowercase() || c == '-')));
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), PARTS.len());
    }
}
