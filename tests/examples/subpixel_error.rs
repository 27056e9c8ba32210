//! What a mask grid and a way to order fragments cost in accuracy, measured on the card.
//!
//! ```text
//! cargo run --release -p zga-tests --example subpixel_error -- --samples 1000000 --seed 1
//! ```
//! First the coverage error of each grid over that many half-planes, beside the published figures; then how many pixels with
//! an edge in them are wrong when fragments are ordered by the depth at the centre, by the mask search, or sample by sample.

use std::process::ExitCode;
use zga_tests::harness::{Grid, Order};
use zga_tests::study::scene::Kind;
use zga_tests::study::{coverage, order};

struct Arguments {
    samples: usize,
    seed: u64,
    scenes: usize,
}

fn arguments() -> Result<Arguments, String> {
    let mut arguments = Arguments { samples: 200_000, seed: 1, scenes: 10 };
    let mut given = std::env::args().skip(1);
    while let Some(name) = given.next() {
        let value: Option<u64> = given.next().and_then(|value| value.parse().ok());
        match (name.as_str(), value) {
            ("--samples", Some(value)) => arguments.samples = value as usize,
            ("--seed", Some(value)) => arguments.seed = value,
            ("--scenes", Some(value)) => arguments.scenes = value as usize,
            _ => return Err(format!("{name}: expected --samples N, --seed N and --scenes N")),
        }
    }
    Ok(arguments)
}

const fn name(grid: Grid) -> &'static str {
    match grid {
        Grid::Off => "1",
        Grid::Grid4x4 => "4x4",
        Grid::Grid8x4 => "8x4",
        Grid::Grid8x8 => "8x8",
    }
}

fn main() -> ExitCode {
    let Arguments { samples, seed, scenes } = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    println!("coverage, {samples} half-planes, seed {seed} (published figures in brackets)");
    println!("{:<5} {:>17} {:>17} {:>17}", "grid", "rmse", "near an axis", "largest");
    let published = [
        (Grid::Off, [0.249, 0.282, 0.5]),
        (Grid::Grid4x4, [0.0315, 0.060, 0.124]),
        (Grid::Grid8x4, [0.0213, 0.045, 0.124]),
        (Grid::Grid8x8, [0.0112, 0.0246, 0.062]),
    ];
    for (grid, figures) in published {
        let found = coverage::of_card(grid, samples, seed);
        print!("{:<5}", name(grid));
        for (value, figure) in [found.rmse, found.near_axis, found.largest].into_iter().zip(figures) {
            print!(" {value:>8.4} ({figure:<6})");
        }
        println!();
    }
    println!(
        "\norder of fragments, {scenes} scenes of each kind; wrong: edge pixels that are not what their samples exactly show"
    );
    println!(
        "{:<5} {:<9} {:<11} {:>9} {:>9} {:>8} {:>12} {:>13} {:>14}",
        "grid", "scene", "order", "edges", "wrong", "share", "mean levels", "evaluations", "clocks"
    );
    for (grid, kind) in Grid::ALL.into_iter().flat_map(|grid| Kind::ALL.map(|kind| (grid, kind))) {
        let (ways, _) = order::of_card(grid, kind, scenes, 1, 0, seed);
        for (way, found) in Order::ALL.into_iter().zip(ways) {
            println!(
                "{:<5} {:<9} {:<11} {:>9} {:>9} {:>7.3}% {:>12.2} {:>13} {:>14}",
                name(grid),
                format!("{kind:?}"),
                format!("{way:?}"),
                found.edges,
                found.wrong,
                order::percent(found.wrong, found.edges),
                found.levels / found.edges.max(1) as f64,
                found.evaluations,
                found.clocks
            );
        }
    }
    ExitCode::SUCCESS
}
