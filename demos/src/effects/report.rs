//! A bill and its prices as tables and as JSON.

use serde_json::{Map, Value, json as value};
use zga_abi::Effects;

use super::what_if::{Compared, Price};
use super::{Account, Bill};
use crate::play::{Change, Settings, effect_names, unit_names};
use crate::table::{Align, columns, grouped, row};

/// The bill and, where they were measured, the prices, for the terminal.
#[must_use]
pub fn table(bill: &Bill, prices: Option<&[Price]>) -> String {
    let none = |names: Vec<String>| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let cost = &bill.cost;
    let mut text = columns(
        "  ",
        &[],
        &[
            row(["effects called", &none(effect_names(cost.called))]),
            row(["units powered", &none(unit_names(cost.powered))]),
            row(["host time", &format!("{:.2} ms from the first packet to the fence", cost.host_ms())]),
        ],
    );
    let mut rows = vec![row(["unit", "power", "clocks", "bytes", "events"])];
    rows.extend(bill.accounts.iter().map(account));
    let total: u64 = bill.accounts.iter().map(|account| account.clocks).sum();
    rows.push(row(["total", "", &grouped(total), "", ""]));
    let aligns = [Align::Left, Align::Left, Align::Right, Align::Right];
    text.push('\n');
    text.push_str(&columns("  ", &aligns, &rows));
    let charged = bill.charged_without_power();
    text.push_str(&match charged.is_empty() {
        true => "\n  What is not called costs nothing: no clock, event or byte of a unit without power.\n".to_owned(),
        false => format!("\n  Charged without power: {}\n", charged.join(", ")),
    });
    if let Some(prices) = prices {
        text.push('\n');
        text.push_str(&price_table(prices, cost.called));
    }
    text
}

/// A row of a part.
fn account(account: &Account) -> Vec<String> {
    let named = |list: &[(&str, u64)]| {
        let there = list.iter().filter(|(_, count)| *count > 0);
        there.map(|(name, count)| format!("{} {}", short(name), grouped(*count))).collect::<Vec<_>>().join(", ")
    };
    let bytes: u64 = account.bytes.iter().map(|(_, bytes)| bytes).sum();
    let power = if account.powered { "on" } else { "off" };
    vec![account.part.to_owned(), power.to_owned(), grouped(account.clocks), grouped(bytes), named(&account.events)]
}

/// The name of a counter without its unit.
fn short(name: &str) -> &str {
    match name.split_once('.') {
        // "writes" alone could be of depths or of colours.
        Some(("z" | "colour", _)) | None => name,
        Some((_, event)) => event,
    }
}

fn price_table(prices: &[Price], called: Effects) -> String {
    let mut rows =
        vec![row(["an effect more or less", "clocks", "difference", "ratio", "host ms", "difference", "ratio"])];
    for price in prices {
        let (clocks, host) = (&price.clocks, &price.host_ms);
        let mut cells = row([
            &price.change.name(),
            &grouped(clocks.after as u64),
            &signed(clocks.difference),
            &format!("{:.3}", clocks.ratio),
            &format!("{:.2}", host.after),
            &format!("{:+.2}", host.difference),
            &format!("{:.2}", host.ratio),
        ]);
        cells.extend(note(price));
        rows.push(cells);
    }
    let right = [Align::Right; 6];
    let aligns = [&[Align::Left][..], &right].concat();
    let mut text = columns("  ", &aligns, &rows);
    let pairs = prices.iter().map(|price| price.pairs).min().unwrap_or(0);
    text.push_str(&format!(
        "\n  Against the scene as it is; host times are medians of {pairs} interleaved pairs of frames.\n"
    ));
    if called.contains(Effects::PERSPECTIVE) {
        text.push_str("  Perspective belongs to the camera: there is no such picture without it.\n");
    }
    text
}

/// Why there is nothing to see in a price.
fn note(price: &Price) -> Option<String> {
    price.without_effect.then(|| match price.change {
        Change::Without(Effects::GOURAUD) => "still called: light at vertices needs it".to_owned(),
        Change::Without(_) => "still called".to_owned(),
        _ => "nothing to call it for".to_owned(),
    })
}

/// A whole number with its sign.
fn signed(value: f64) -> String {
    let sign = if value < 0.0 { "-" } else { "+" };
    format!("{sign}{}", grouped(value.abs() as u64))
}

/// The same for programs: `size`, `hidden_surface`, `fidelity`, `card`, `frame_hash`, `host_ms`, `effects` (`called`,
/// `powered`), `units` (of each part `powered`, `clocks`, `events`, `bytes`), `charged_without_power`, and `what_if` where
/// prices were measured.
#[must_use]
pub fn json(bill: &Bill, prices: Option<&[Price]>, size: [u32; 2], settings: &Settings, hash: &str) -> Value {
    let counts = |list: &[(&'static str, u64)]| -> Map<String, Value> {
        list.iter().map(|(name, count)| ((*name).to_owned(), (*count).into())).collect()
    };
    let unit = |account: &Account| {
        let account_of = value!({
            "powered": account.powered,
            "clocks": account.clocks,
            "events": counts(&account.events),
            "bytes": counts(&account.bytes),
        });
        (account.part.to_owned(), account_of)
    };
    let units: Map<String, Value> = bill.accounts.iter().map(unit).collect();
    let cost = &bill.cost;
    let mut report = value!({
        "size": size,
        "hidden_surface": settings.hidden_surface.name(),
        "fidelity": settings.fidelity.name(),
        "card": settings.report(),
        "frame_hash": hash,
        "host_ms": cost.host_ms(),
        "effects": { "called": effect_names(cost.called), "powered": unit_names(cost.powered) },
        "units": units,
        "charged_without_power": bill.charged_without_power(),
    });
    if let Some(prices) = prices {
        report["what_if"] = prices.iter().map(price).collect();
    }
    report
}

fn price(price: &Price) -> Value {
    let compared = |Compared { before, after, difference, ratio }: Compared| value!({ "before": before, "after": after, "difference": difference, "ratio": ratio });
    value!({
        "change": price.change.name(),
        "effect": effect_names(price.change.effect()),
        "added": !matches!(price.change, Change::Without(_)),
        "called": effect_names(price.called),
        "clocks": compared(price.clocks),
        "host_ms": compared(price.host_ms),
        "pairs": price.pairs,
        "note": note(price),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_names_keep_what_tells_them_apart() {
        assert_eq!(
            ["geometry.vertices", "z.writes", "colour.writes"].map(short),
            ["vertices", "z.writes", "colour.writes"]
        );
        assert_eq!([signed(-1234.0), signed(0.0), signed(7.0)], ["-1 234", "+0", "+7"]);
    }
}
