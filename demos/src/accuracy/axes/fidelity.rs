//! Simulation fidelity: functional or register by register. Pixels and clocks must be equal; only the host's time differs.

use zga_tests::harness::{Hidden, Path};
use zga_tests::study::card::{self, Setting};

use super::super::context::Context;
use super::super::model;
use super::super::report::{Section, Table};
use super::super::verdict::figure;
use super::mesh_name;
use crate::error::{Error, Result};

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let scene = model::scene(&context.mesh, context.effort.pick([160, 120], [320, 240]));
    let mut table = Table::new(
        format!("{}, one sample a pixel", mesh_name(context)),
        &[
            ("path", ""),
            ("clocks/pixel", ""),
            ("functional", "host ns/pixel"),
            ("clocked", "host ns/pixel"),
            ("slow-down", "x"),
            ("pixels and clocks", ""),
        ],
    );
    let mut slowest = (0.0, "");
    for (path, name) in [(Path::Za, "za"), (Path::Systolic, "systolic"), (Path::Tile, "tile")] {
        context.tell(&format!("{name}, clocked"));
        let functional = Setting { hidden: Hidden::on(path), ..Setting::centres() };
        let clocked = Setting { hidden: Hidden::on(path).clocked(), ..functional };
        let all = card::drawn(&scene, &[functional, clocked], context.threads, context.effort.pick(3, 7));
        if all[0].colour != all[1].colour || all[0].clocks != all[1].clocks {
            return Err(Error::Use(format!("{name}: the clocked simulation has another picture or other clocks")));
        }
        let pixels = scene.pixels() as f64;
        let slow_down = all[1].median() / all[0].median();
        slowest = if slow_down > slowest.0 { (slow_down, name) } else { slowest };
        table.rows.push(vec![
            name.into(),
            (all[0].clocks as f64 / pixels).into(),
            (all[0].median() / pixels).into(),
            (all[1].median() / pixels).into(),
            slow_down.into(),
            "equal".into(),
        ]);
    }
    Ok(Section {
        name: "fidelity",
        title: "Simulation fidelity: functional or register by register".to_owned(),
        about: vec![
            "Units with a clocked model can be simulated functionally or stepped register by register. That is no accuracy of the \
             card: pixels and clocks must be equal, and are compared here. What it costs is the time of this computer."
                .to_owned(),
        ],
        findings: vec![format!(
            "Pixels and clocks are equal on every path; stepping registers takes up to {} times as long ({}).",
            figure(slowest.0),
            slowest.1
        )],
        tables: vec![table],
        ..Section::default()
    })
}
