//! Tables and plots.

use zga_tests::study::decal::{Counts, Cure, Projection};

use super::super::report::{Axis, Cell, Kind, Plot, Series, Table};
use super::measure::{Measured, Tilt};
use super::{buried, name, shown};

pub(super) fn cures(measured: &Measured) -> Table {
    let columns = [
        ("cure", ""),
        ("buried up to slope 8", "pixels"),
        ("of", "pixels"),
        ("buried steeper", "pixels"),
        ("of", "pixels"),
        ("shown through", "pixels"),
        ("of", "pixels"),
        ("shown through", "%"),
    ];
    let mut table = Table::new(format!("Cures, {}: tilts up to 8, and bodies", measured.projection.name()), &columns);
    for (cure, counts) in &measured.within {
        let Counts { seen, buried, buried_within, seen_within, hidden, shown: through, ties, .. } = *counts;
        let counts: [Cell; 7] = [
            buried_within.into(),
            seen_within.into(),
            (buried - buried_within - ties).into(),
            (seen - seen_within).into(),
            through.into(),
            hidden.into(),
            shown(counts).into(),
        ];
        table.rows.push([Cell::from(name(*cure))].into_iter().chain(counts).collect());
    }
    table
}

pub(super) fn tilts(measured: &Measured) -> Table {
    const CURES: [&str; 7] =
        ["no cure", "S = 8", "fitted, S up to 8", "S = 1.39 tilt", "offset 1, 1", "offset 0.5, 1", "best offset"];
    let named: Vec<String> = ["buried", "shown through"]
        .into_iter()
        .flat_map(|what| {
            CURES
                .iter()
                .enumerate()
                .map(move |(at, cure)| if at == 0 { format!("{what}: {cure}") } else { (*cure).to_owned() })
        })
        .collect();
    let columns: Vec<(&str, &str)> = [("tilt", "")]
        .into_iter()
        .chain(named.iter().map(|name| (name.as_str(), "%")))
        .chain([("its factor", "")])
        .collect();
    let mut table = Table::new(format!("Planes by tilt, {}", measured.projection.name()), &columns);
    for Tilt { tilt, nothing, decal, fitted, best, own, usual, tuned } in &measured.tilts {
        let all = [
            Some(nothing),
            Some(decal),
            Some(fitted),
            Some(own),
            Some(usual),
            Some(tuned),
            best.as_ref().map(|(_, best)| best),
        ];
        let of = |share: fn(&Counts) -> f64| {
            all.map(|counts| counts.map_or_else(|| Cell::from("-"), |counts| share(counts).into()))
        };
        let factor = best.map_or_else(|| Cell::from("-"), |(factor, _)| factor.into());
        table.rows.push([(*tilt).into()].into_iter().chain(of(buried)).chain(of(shown)).chain([factor]).collect());
    }
    table
}

fn line(name: String, points: Vec<[f64; 2]>) -> Series {
    Series { name, points, labels: Vec::new(), kind: Kind::Line }
}

pub(super) fn curve(what: &str, measured: &[Measured], of: fn(&Counts) -> f64) -> Plot {
    let series = measured.iter().flat_map(|measured| {
        [("", &measured.slopes), (", fitted: S is the limit", &measured.limits)].map(|(kind, found)| {
            let points = found.iter().map(|(slope, counts)| [*slope, of(counts)]).collect();
            line(format!("{}{kind}", measured.projection.name()), points)
        })
    });
    Plot {
        title: format!("Marking pixels {what}, over S; all scenes"),
        x: Axis::linear("slope S"),
        y: Axis::linear(format!("{what}, %")),
        series: series.collect(),
    }
}

/// Shown through by the tilt of a plane.
pub(super) fn by_tilt(measured: &[Measured]) -> Vec<Plot> {
    let plot = |measured: &Measured| {
        let of = |name: &str, pick: fn(&Tilt) -> Option<&Counts>| {
            let points = measured.tilts.iter().filter_map(|found| Some([found.tilt, shown(pick(found)?)])).collect();
            line(name.to_owned(), points)
        };
        Plot {
            title: format!("Shown through, by the tilt of the plane; {}", measured.projection.name()),
            x: Axis::linear("tilt"),
            y: Axis::linear("shown through, %"),
            series: vec![
                of("S = 8", |found| Some(&found.decal)),
                of("fitted, S up to 8", |found| Some(&found.fitted)),
                of("offset 1, 1", |found| Some(&found.usual)),
                of("the best offset that buries as little", |found| Some(&found.best.as_ref()?.1)),
            ],
        }
    };
    measured.iter().map(plot).collect()
}

/// Buried against shown through: what each kind of cure can reach.
pub(super) fn trade(measured: &[Measured]) -> Plot {
    let mut series = Vec::new();
    for measured in measured.iter().filter(|measured| measured.projection == Projection::Perspective) {
        let family = |name: &str, pick: fn(&Cure) -> Option<String>| {
            let some = measured.within.iter().filter_map(|(cure, counts)| Some((pick(cure)?, counts)));
            let (labels, points) = some.map(|(label, counts)| (label, [shown(counts), buried(counts)])).unzip();
            Series { name: name.to_owned(), points, labels, kind: Kind::Marks }
        };
        series.push(family("", |cure| match cure {
            Cure::Nothing => Some("no cure".to_owned()),
            Cure::Decal(slope) => Some(format!("S = {slope}")),
            Cure::Fitted(slope) => Some(format!("fitted, S up to {slope}")),
            _ => None,
        }));
        series.push(family("", |cure| match cure {
            Cure::Offset { factor, .. } if [0.25, 0.5, 1.0, 2.0].contains(factor) => Some(format!("factor {factor}")),
            _ => None,
        }));
        series.push(family("", |cure| match cure {
            Cure::Offset { factor: 0.0, units } => Some(format!("{units} units")),
            _ => None,
        }));
    }
    Plot {
        title: "Cures in perspective: planes of tilt 0 to 8, and bodies near to far".to_owned(),
        x: Axis::linear("shown through, %"),
        y: Axis::logarithmic("buried, %"),
        series,
    }
}
