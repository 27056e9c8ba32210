//! What a card has counted, as table and as JSON.

use serde_json::{Map, Value, json as value};
use zga_ddx_shim::link::Status;

use crate::play::{effect_names, unit_names};
use crate::table::{Align, columns, grouped, row};

/// Effects, units and the counters that are not 0.
pub(crate) fn table(status: &Status) -> String {
    let none = |names: Vec<String>| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let mut text = columns(
        "  ",
        &[],
        &[
            row(["effects called", &none(effect_names(status.effects))]),
            row(["units powered", &none(unit_names(status.units))]),
        ],
    );
    let counted = status.counters.iter().filter(|(_, count)| *count > 0);
    let rows: Vec<_> = counted.map(|(name, count)| row([name, &grouped(*count)])).collect();
    text.push('\n');
    text.push_str(&match rows.is_empty() {
        true => "  nothing was counted\n".to_owned(),
        false => columns("  ", &[Align::Left, Align::Right], &rows),
    });
    text
}

/// The same for programs: `effects` (`called`, `powered`) and `counters`, all of them by their names.
pub(crate) fn json(status: &Status) -> Value {
    let counters: Map<String, Value> =
        status.counters.iter().map(|(name, count)| (name.clone(), (*count).into())).collect();
    value!({
        "effects": { "called": effect_names(status.effects), "powered": unit_names(status.units) },
        "counters": counters,
    })
}

#[cfg(test)]
mod tests {
    use zga_abi::{Effects, Units};

    use super::*;

    #[test]
    fn table_leaves_out_what_is_0_and_json_does_not() {
        let counters = vec![("bitmap.pixels".to_owned(), 12_345), ("z.spans".to_owned(), 0)];
        let status = Status { effects: Effects::empty(), units: Units::FRONTEND, counters };
        let expected = "  effects called  none\n  units powered   frontend\n\n  bitmap.pixels  12 345\n";
        assert_eq!(table(&status), expected);
        assert_eq!(json(&status)["counters"], value!({ "bitmap.pixels": 12_345, "z.spans": 0 }));
        assert!(table(&Status::default()).contains("nothing was counted"));
    }
}
