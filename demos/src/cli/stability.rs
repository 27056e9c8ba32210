//! `zga stability`: the hard cases, run and reported.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use clap::builder::TypedValueParser;
use serde_json::json;
use zga_tests::hard::{CASES, Case, Row};

use super::{Verdict, note, print, progress};
use crate::error::Result;
use crate::picture::write_file;

/// Columns of the report.
const WIDTH: usize = 110;

/// Run the hard cases: constructions that break rasterisers, each with what must hold and what was measured
///
/// All 60, on cards of their own, without tolerances but those that a case states. Exit code 1 if one fails.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga stability\n  zga stability 46 49\n  zga stability decals --json -\n  zga stability hard::lines::diamond_corners"
)]
pub(super) struct Stability {
    /// Number (46), range (46-51), unit (decals) or name of cases; all of them if nothing is named
    #[arg(value_name = "CASE", value_parser = clap::builder::StringValueParser::new().try_map(|text| Filter::new(&text)))]
    cases: Vec<Filter>,
    /// Cases at a time
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=64))]
    threads: u8,
    /// Write the rows as JSON; - for the standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Which cases are meant.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Filter {
    Numbers(u32, u32),
    Unit(&'static str),
    Name(&'static str),
}

impl Filter {
    fn new(text: &str) -> std::result::Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|&number| CASES.iter().any(|case| case.number == number));
        let (first, last) = text.split_once('-').unwrap_or((text, text));
        if let (Some(first), Some(last)) = (number(first), number(last))
            && first <= last
        {
            return Ok(Self::Numbers(first, last));
        }
        if let Some(case) = CASES.iter().find(|case| case.unit == text) {
            return Ok(Self::Unit(case.unit));
        }
        let name = text.strip_prefix("hard::").unwrap_or(text);
        let found = CASES.iter().find(|case| {
            let bare = name.strip_prefix(case.unit).and_then(|rest| rest.strip_prefix("::"));
            case.name == bare.unwrap_or(name)
        });
        found.map(|case| Self::Name(case.name)).ok_or_else(|| {
            let mut units: Vec<&str> = CASES.iter().map(|case| case.unit).collect();
            units.dedup();
            format!("expected 1 to 60, a range of them, a name, or a unit: {}", units.join(", "))
        })
    }

    fn takes(&self, case: &Case) -> bool {
        match self {
            Self::Numbers(first, last) => (*first..=*last).contains(&case.number),
            Self::Unit(unit) => case.unit == *unit,
            Self::Name(name) => case.name == *name,
        }
    }
}

impl Stability {
    pub(super) fn run(&self) -> Result<Verdict> {
        let wanted = |case: &&Case| self.cases.is_empty() || self.cases.iter().any(|filter| filter.takes(case));
        let cases: Vec<Case> = CASES.iter().filter(wanted).copied().collect();
        let bar = progress::bar(cases.len() as u64, "cases");
        let rows = run_all(&cases, self.threads.into(), &|| bar.inc(1));
        bar.finish_and_clear();
        let failed = rows.iter().filter(|row| !row.passed).count();
        let json = || format!("{:#}\n", json(&cases, &rows));
        match self.json.as_deref() {
            Some(file) if file == Path::new("-") => print(&json())?,
            Some(file) => {
                write_file(file, json().as_bytes())?;
                print(&text(&cases, &rows))?;
                note(&format!("wrote {}", file.display()));
            }
            None => print(&text(&cases, &rows))?,
        }
        Ok(if failed == 0 { Verdict::Good } else { Verdict::Bad })
    }
}

/// Runs cases on threads; the rows are in the order of the cases. Each has cards of its own, so they do not meet.
fn run_all(cases: &[Case], threads: usize, done: &(dyn Fn() + Sync)) -> Vec<Row> {
    let next = AtomicUsize::new(0);
    let rows = Mutex::new(Vec::with_capacity(cases.len()));
    std::thread::scope(|scope| {
        for _ in 0..threads.min(cases.len()) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let row = run(case);
                    rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(row);
                    done();
                }
            });
        }
    });
    let mut rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    rows.sort_by_key(|row: &Row| row.case);
    rows
}

/// Runs a case. One that panics has failed, and the others go on.
fn run(case: &Case) -> Row {
    std::panic::catch_unwind(case.run).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("nothing said");
        Row {
            case: case.number,
            name: case.name,
            construction: "not finished",
            property: "the case ends",
            measured: format!("panicked: {said}"),
            passed: false,
        }
    })
}

/// How a case is run again: by the program, and as a test.
fn again(case: &Case) -> [String; 2] {
    let Case { number, unit, name, .. } = case;
    [format!("zga stability {number}"), format!("cargo test -p zga-tests --test hard hard::{unit}::{name}")]
}

fn text(cases: &[Case], rows: &[Row]) -> String {
    let mut text = String::new();
    for (case, row) in cases.iter().zip(rows) {
        let verdict = if row.passed { "holds" } else { "FAILED" };
        text += &format!("{:>3}  {verdict:<6}  hard::{}::{}\n", case.number, case.unit, case.name);
        let [program, test] = again(case);
        let parts = [("drawn", row.construction), ("must", row.property), ("measured", row.measured.as_str())];
        for (what, said) in parts.into_iter().chain([("again", program.as_str()), ("", test.as_str())]) {
            text += &paragraph(what, said);
        }
        text.push('\n');
    }
    let failed: Vec<String> =
        rows.iter().filter(|row| !row.passed).map(|row| format!("{} ({})", row.case, row.name)).collect();
    let end = if failed.is_empty() { String::new() } else { format!(": {}", failed.join(", ")) };
    text + &format!("{} of {} hold, {} failed{end}\n", rows.len() - failed.len(), rows.len(), failed.len())
}

/// Words under a name, in lines of at most [`WIDTH`] columns if they can be broken.
fn paragraph(name: &str, said: &str) -> String {
    const INDENT: usize = 15;
    let mut text = format!("{:5}{name:<10}", "");
    let mut column = INDENT;
    for word in said.split_whitespace() {
        if column > INDENT && column + word.len() >= WIDTH {
            text = text.trim_end().to_owned() + "\n" + &" ".repeat(INDENT);
            column = INDENT;
        }
        text += word;
        text.push(' ');
        column += word.len() + 1;
    }
    text.trim_end().to_owned() + "\n"
}

fn json(cases: &[Case], rows: &[Row]) -> serde_json::Value {
    let list: Vec<_> = cases
        .iter()
        .zip(rows)
        .map(|(case, row)| {
            json!({
                "case": case.number,
                "unit": case.unit,
                "name": format!("hard::{}::{}", case.unit, case.name),
                "construction": row.construction,
                "property": row.property,
                "measured": row.measured,
                "verdict": if row.passed { "holds" } else { "failed" },
                "reproduce": again(case),
            })
        })
        .collect();
    let failed = rows.iter().filter(|row| !row.passed).count();
    json!({ "schema": "zga.stability/1", "cases": list, "passed": rows.len() - failed, "failed": failed })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(number: u32, run: fn() -> Row) -> Case {
        Case { number, unit: "lines", name: "made_up", run }
    }

    fn row(case: u32, passed: bool) -> Row {
        Row { case, name: "lines::made_up", construction: "a line", property: "straight", measured: "1".into(), passed }
    }

    #[test]
    fn filters_numbers_ranges_units_and_names_are_told_apart() {
        let taken = |text: &str| {
            let filter = Filter::new(text).expect(text);
            CASES.iter().filter(|case| filter.takes(case)).map(|case| case.number).collect::<Vec<u32>>()
        };

        assert_eq!((taken("46"), taken("57-59")), (vec![46], vec![57, 58, 59]));
        assert_eq!(taken("decals"), [46, 47, 48, 49, 50, 51]);
        assert_eq!([taken("zero_length"), taken("lines::zero_length"), taken("hard::lines::zero_length")], [[57]; 3]);
        assert!(["0", "61", "9-3", "decal", "za::zero_length", ""].iter().all(|text| Filter::new(text).is_err()));
    }

    #[test]
    fn run_all_a_case_that_panics_fails_and_the_others_run() {
        let cases = [case(1, || row(1, true)), case(2, || panic!("no such luck")), case(3, || row(3, true))];

        let rows = run_all(&cases, 2, &|| ());

        assert_eq!(rows.iter().map(|row| row.passed).collect::<Vec<bool>>(), [true, false, true]);
        assert_eq!(rows[1].measured, "panicked: no such luck");
        assert!(text(&cases, &rows).ends_with("2 of 3 hold, 1 failed: 2 (made_up)\n"));
        assert_eq!(json(&cases, &rows)["failed"], 1);
        assert_eq!(json(&cases, &rows)["cases"][1]["verdict"], "failed");
    }

    #[test]
    fn text_long_words_are_broken_between_words() {
        let long = "word ".repeat(40);

        let lines: Vec<String> = paragraph("must", &long).lines().map(str::to_owned).collect();

        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("     must      word") && lines.iter().all(|line| line.len() <= WIDTH));
    }
}
