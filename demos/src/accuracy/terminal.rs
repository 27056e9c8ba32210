//! The report on the terminal: a heading, what was found, and the tables of each section.

use super::report::{By, Cell, Column, Report, Section, Sweep, Table};
use super::verdict::{figure, of_sweep};
use crate::table::{Align, columns, grouped, lines};

/// Characters of a line.
const WIDTH: usize = 100;

/// All of it.
#[must_use]
pub fn text(report: &Report) -> String {
    let origin = &report.origin;
    let mut text = format!(
        "What accuracy costs: errors against exact arithmetic, clocks of the card, time of this host\n\
         zga {}, {}, seed {}, {} run, {} on {}\n",
        origin.version,
        origin.date,
        origin.seed,
        origin.effort,
        threads(origin.threads),
        origin.processor,
    );
    for line in &report.headlines {
        text.push_str(&bullet(line));
    }
    for section in &report.sections {
        text.push_str(&of_section(section));
    }
    text
}

/// A number of threads in words.
pub(super) fn threads(count: usize) -> String {
    if count == 1 { "1 thread".to_owned() } else { format!("{count} threads") }
}

fn of_section(section: &Section) -> String {
    let mut text = format!("\n{}  [{}]\n", section.title, section.name);
    section.findings.iter().for_each(|line| text.push_str(&bullet(line)));
    for table in section.sweeps.iter().map(of_sweep_table).chain(section.tables.iter().cloned()) {
        if !table.title.is_empty() {
            text.push_str(&format!("\n  {}\n", table.title));
        }
        text.push_str(&of_table(&table));
    }
    section.notes.iter().for_each(|line| text.push_str(&bullet(line)));
    text
}

fn bullet(line: &str) -> String {
    let broken = lines(line, WIDTH - 4);
    let mark = |at: usize| if at == 0 { "  * " } else { "    " };
    broken.iter().enumerate().map(|(at, line)| format!("{}{line}\n", mark(at))).collect()
}

fn of_table(table: &Table) -> String {
    let head = |column: &Column| match column.unit {
        "" => column.name.clone(),
        unit => format!("{}, {unit}", column.name),
    };
    let mut rows = vec![table.columns.iter().map(head).collect::<Vec<_>>()];
    rows.extend(table.rows.iter().map(|row| row.iter().map(cell).collect()));
    let text = |at: usize| table.rows.iter().all(|row| matches!(row.get(at), None | Some(Cell::Text(_))));
    let align = |at: usize| if text(at) { Align::Left } else { Align::Right };
    columns("    ", &(0..table.columns.len()).map(align).collect::<Vec<_>>(), &rows)
}

/// A cell as text.
#[must_use]
pub fn cell(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Number(number) => figure(*number),
        Cell::Count(count) => grouped(*count),
        Cell::Nothing => "-".to_owned(),
    }
}

/// The table of a sweep: a row for each setting; columns that nothing was measured for are left out.
#[must_use]
pub fn of_sweep_table(sweep: &Sweep) -> Table {
    let least =
        |of: fn(&super::report::Point) -> Option<f64>| sweep.points.iter().filter_map(of).fold(f64::INFINITY, f64::min);
    let (clocks, time) = (least(|point| point.price.clocks), least(|point| point.price.nanoseconds));
    let error_unit = if sweep.by == By::Rate { "%" } else { sweep.unit };
    let heads = [
        ("setting", ""),
        ("mean error", sweep.unit),
        ("largest error", sweep.unit),
        ("wrong", "%"),
        ("standard error", error_unit),
        ("published", error_unit),
        ("samples", ""),
        ("clocks/pixel", ""),
        ("x", ""),
        ("host ns/pixel", ""),
        ("+-", ""),
        ("x", ""),
        ("verdict", ""),
    ];
    let verdicts = of_sweep(sweep);
    let row = |(at, point): (usize, &super::report::Point)| {
        let (error, price) = (&point.error, &point.price);
        let times = |value: Option<f64>, least: f64| Cell::from(value.map(|value| format!("{:.2}", value / least)));
        let verdict = match verdicts[at] {
            Some(by) => format!("never worth it: {}", sweep.points[by].setting),
            None => String::new(),
        };
        vec![
            Cell::from(point.setting.as_str()),
            error.mean.into(),
            error.maximum.into(),
            error.rate.into(),
            error.standard_error.into(),
            error.published.into(),
            error.samples.into(),
            price.clocks.into(),
            times(price.clocks, clocks),
            price.nanoseconds.into(),
            price.spread.into(),
            times(price.nanoseconds, time),
            verdict.into(),
        ]
    };
    let title = format!("{} on {}", sweep.measure, sweep.scene);
    let mut table = Table::new(title, &heads);
    table.rows = sweep.points.iter().enumerate().map(row).collect();
    let empty = |cell: &Cell| match cell {
        Cell::Nothing => true,
        Cell::Text(text) => text.is_empty(),
        Cell::Count(count) => *count == 0,
        Cell::Number(_) => false,
    };
    let kept: Vec<bool> = (0..heads.len()).map(|at| !table.rows.iter().all(|row| empty(&row[at]))).collect();
    let mut places = kept.iter();
    table.columns.retain(|_| *places.next().unwrap_or(&true));
    for row in &mut table.rows {
        let mut places = kept.iter();
        row.retain(|_| *places.next().unwrap_or(&true));
    }
    table
}
