//! The worked example of the documentation, from the elements themselves.

use super::*;
use crate::hidden::systolic::element::Element;
use crate::hidden::systolic::token::control;

const WIDTH: u32 = 8;

/// A and CTRL of an element: timing, A in whole numbers, a star where IN is 1.
fn moving(element: &Element) -> String {
    let star = if element.inside { "*" } else { "" };
    match element.control & control::PHASE {
        control::T1 => format!("T1 {}{star}", element.a as i64),
        control::T2 => format!("T2 {}{star}", element.a >> 32),
        control::T3 if element.control & control::REFRESH != 0 => "R".into(),
        control::T3 => format!("T3 {}{star}", element.a >> 32),
        _ => String::new(),
    }
}

/// Zb and Ib of an element.
fn kept(element: &Element) -> String {
    match element.luminance {
        Luminance::Background => String::new(),
        Luminance::Tag(tag) | Luminance::Value(tag) => format!("{}/{tag}", element.depth),
    }
}

/// The two tables: what the elements hold after each clock.
fn tables() -> String {
    let setting = SystolicSetting::default();
    let tokens = [token(1, 4, 40, 2, 1), token(3, 2, 50, -4, 2)];
    let beats: Vec<Beat> = tokens.iter().flat_map(|token| token.beats(&setting)).chain(Beat::REFRESH).collect();
    let mut machine = elements(WIDTH, setting, 32);
    let numbers: String = (0..WIDTH).map(|number| format!(" PE {number} |")).collect();
    let rule = |columns: usize| " --- |".repeat(columns);
    let mut registers = format!("| clock |{numbers}\n|{}\n", rule(9));
    let mut results = format!("| clock |{numbers} bus |\n|{}\n", rule(10));
    for clock in 0..3 * 3 - 1 + WIDTH as usize {
        let driven = machine.clock(beats.get(clock).copied().unwrap_or_default(), FAR);
        let row = |cell: fn(&Element) -> String| machine.elements.iter().map(cell).collect::<Vec<_>>().join(" | ");
        let bus = driven.map_or(String::new(), |pixel| match pixel.luminance {
            Luminance::Tag(tag) => tag.to_string(),
            _ => "background".into(),
        });
        registers += &format!("| {clock} | {} |\n", row(moving));
        results += &format!("| {clock} | {} | {bus} |\n", row(kept));
    }
    format!("{registers}\n{results}")
}

#[test]
fn worked_example_tables_are_what_the_elements_hold() {
    let documented = include_str!("../worked_example.md");
    let tables = tables();
    for table in tables.split("\n\n") {
        assert!(documented.contains(table.trim_end()), "the documentation lacks\n{table}");
    }
}

#[test]
fn worked_example_takes_the_clocks_of_the_closed_form() {
    let clocks = crate::hidden::systolic::closed_form(&[2], WIDTH, &SystolicSetting::default());
    assert_eq!(tables().lines().filter(|line| line.starts_with("| 15 |")).count(), 2);
    assert_eq!(clocks, 16);
}
