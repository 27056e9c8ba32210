//! A fragment for a README: the presets and the headlines in Markdown, and the plot of all settings as a file.

use super::page::{of_sweep_plots, standalone};
use super::report::{Cell, Report, Section};
use super::terminal::cell;

/// Name of the plot's file.
pub const PLOT: &str = "accuracy.svg";

/// The fragment, and the plot if anything was measured that has one.
#[must_use]
pub fn fragment(report: &Report) -> (String, Option<String>) {
    let origin = &report.origin;
    let find = |name: &str| report.sections.iter().find(|section| section.name == name);
    let plot = find("combined")
        .and_then(|section| section.plots.first().cloned())
        .or_else(|| report.sections.iter().flat_map(|section| &section.sweeps).flat_map(of_sweep_plots).next());
    let mut text = String::new();
    report.headlines.iter().for_each(|line| text.push_str(&format!("* {line}\n")));
    let shown = find("presets").and_then(|section: &Section| section.tables.first());
    if let Some(table) = shown {
        let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let head = |column: &super::report::Column| match column.unit {
            "" => column.name.clone(),
            unit => format!("{}, {unit}", column.name),
        };
        text.push('\n');
        text.push_str(&row(table.columns.iter().map(head).collect()));
        text.push_str(&row(table.columns.iter().map(|_| "---".to_owned()).collect()));
        table.rows.iter().for_each(|cells: &Vec<Cell>| text.push_str(&row(cells.iter().map(cell).collect())));
    }
    if plot.is_some() {
        text.push_str(&format!("\n![What accuracy costs: colour error against clocks]({PLOT})\n"));
    }
    text.push_str(&format!(
        "\nMeasured with `zga accuracy --{}`, seed {}, {}; errors against exact arithmetic, clocks of the card.\n",
        origin.effort, origin.seed, origin.date
    ));
    (text, plot.as_ref().map(standalone))
}
