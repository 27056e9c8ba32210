//! The presets: what each costs and how far its pictures are from the true ones, with the bounds that are promised.

use zga_abi::format::{SubpixelDepth, SubpixelEdges, SubpixelGrid};
use zga_driver::Preset;
use zga_tests::harness::{Edges, Grid, Order, Random};
use zga_tests::oracle::DepthFormat;
use zga_tests::study::card::Setting;
use zga_tests::study::scene::{Kind, Scene};

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, Section, Sweep, Table};
use super::super::verdict::sentences;
use super::{crossing_name, magnified, pictures};
use crate::error::Result;

/// What is promised of a preset on the random scenes and the teapot, at the sizes of this section.
///
/// Where the bounds come from: errors and clocks of some thousand random triangles hardly depend on the seed, so each bound
/// lies at least four standard deviations above the mean, over seeds, of the worst figure of a seed. The test measures that
/// over 4 seeds, with `ZGA_LONG=1` over 32. By Cantelli's inequality a figure of any distribution with such a mean and
/// deviation is beyond the bound for at most 1 seed in 17. Of every scene whatever nothing can be promised but an error of
/// at most 255 levels.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Which.
    pub preset: Preset,
    /// Largest mean distance of a pixel's colour from the true picture, levels of 255.
    pub mean_error: f64,
    /// Most clocks, in multiples of the draft's.
    pub clocks: f64,
}

/// The promises; tests hold them.
pub const BOUNDS: [Bounds; 3] = [
    Bounds { preset: Preset::Draft, mean_error: 40.0, clocks: 1.0 },
    Bounds { preset: Preset::Standard, mean_error: 5.5, clocks: 2.6 },
    Bounds { preset: Preset::Exact, mean_error: 2.0, clocks: 7.0 },
];

/// A preset as the studies set a card up.
fn setting(preset: Preset) -> Setting {
    let (antialias, depth) = (preset.antialias(), preset.depth());
    let grid = match antialias.grid {
        SubpixelGrid::Off => Grid::Off,
        SubpixelGrid::Grid4x4 => Grid::Grid4x4,
        SubpixelGrid::Grid8x4 => Grid::Grid8x4,
        SubpixelGrid::Grid8x8 => Grid::Grid8x8,
    };
    let order = match antialias.depth {
        SubpixelDepth::Centre => Order::Centre,
        SubpixelDepth::Search => Order::Search,
        SubpixelDepth::Exhaustive => Order::Exhaustive,
    };
    let edges = match antialias.edges {
        SubpixelEdges::All => Edges::All,
        SubpixelEdges::Borders => Edges::Borders,
    };
    let depth = DepthFormat { bits: depth.bits(), fraction: depth.fraction() };
    Setting { grid, order, edges, depth, coordinate_bits: preset.subpixel_bits(), ..Setting::best() }
}

/// The scenes that the promises are about.
fn scenes(context: &Context<'_>) -> Vec<(String, Scene)> {
    let size = context.effort.pick([160, 120], [320, 240]);
    let random = |kind: Kind| (kind.name().to_owned(), kind.scene(size, &mut Random::new(context.seed)));
    let mesh = (crossing_name(context), model::crossing(&context.mesh, context.size));
    vec![random(Kind::Soup), random(Kind::Crossing), random(Kind::Terrain), mesh]
}

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let settings: Vec<(String, Setting)> =
        Preset::ALL.iter().map(|preset| (preset.name().to_owned(), setting(*preset))).collect();
    let mut section = Section {
        name: "presets",
        title: "Presets: accuracy by name".to_owned(),
        about: vec![
            "Settings that belong together: --preset on the command line, preset in a scene's card, Driver::set_preset. Worst is over \
             the scenes below, of which random small triangles leave hardly a pixel without an edge; what is promised is held by \
             the project's tests."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut sweeps: Vec<Sweep> = Vec::new();
    for (name, scene) in scenes(context) {
        let swept = pictures(context, &name, &scene, &settings, By::Mean);
        let shown: Vec<(&str, &[u32])> = settings
            .iter()
            .zip(&swept.drawn)
            .map(|((name, _), drawn)| (name.as_str(), drawn.colour.as_slice()))
            .collect();
        let caption = "Where the draft is worst. Differences: white none, black 128 levels or more.";
        section.strips = vec![magnified(&name, &swept.truth, &shown, caption)];
        sweeps.push(swept.sweep);
    }
    let mut table = Table::new(
        "The presets",
        &[
            ("preset", ""),
            ("settings", ""),
            ("worst mean error", "levels of 255"),
            ("promised", ""),
            ("most clocks", "x draft"),
            ("promised", ""),
        ],
    );
    for (at, bounds) in BOUNDS.iter().enumerate() {
        let setting = setting(bounds.preset);
        let [columns, rows] = setting.grid.size();
        let words = format!(
            "{columns}x{rows} samples, {}, Z{} F{}, 1/{} px",
            bounds.preset.antialias().depth.name(),
            setting.depth.bits,
            setting.depth.fraction,
            1 << setting.coordinate_bits
        );
        let [error, clocks] = worst(&sweeps, at);
        table.rows.push(vec![
            bounds.preset.name().into(),
            words.into(),
            error.into(),
            bounds.mean_error.into(),
            clocks.into(),
            bounds.clocks.into(),
        ]);
    }
    section.findings = sweeps.iter().flat_map(sentences).collect();
    section.summary = Some(table);
    section.sweeps = sweeps;
    Ok(section)
}

/// The largest mean error of a preset over the scenes, and its most clocks in multiples of the first preset's.
fn worst(sweeps: &[Sweep], at: usize) -> [f64; 2] {
    let over = |figure: fn(&Sweep, usize) -> Option<f64>| {
        sweeps.iter().filter_map(|sweep| figure(sweep, at)).fold(0.0, f64::max)
    };
    let error = over(|sweep, at| sweep.points.get(at)?.error.mean);
    let clocks = over(|sweep, at| Some(sweep.points.get(at)?.price.clocks? / sweep.points.first()?.price.clocks?));
    [error, clocks]
}

#[cfg(test)]
mod tests {
    use super::super::super::context::{Effort, Options};
    use super::*;

    /// Standard deviations between the mean of a figure over seeds and its bound.
    const DEVIATIONS: f64 = 4.0;

    /// Seeds of this run: 4, and with `ZGA_LONG=1` 32.
    fn seeds() -> std::ops::RangeInclusive<u64> {
        let long = std::env::var("ZGA_LONG").is_ok_and(|value| value == "1");
        1..=if long { 32 } else { 4 }
    }

    /// The worst error and the most clocks of each preset.
    fn found(seed: u64) -> [[f64; 2]; 3] {
        let options = Options { seed, effort: Effort::Quick, size: [160, 120], threads: 1, mesh: None };
        let mut tell = |_: &str| {};
        let mut context = Context::new(&options, &mut tell).expect("the teapot");
        let settings: Vec<(String, Setting)> =
            Preset::ALL.iter().map(|preset| (preset.name().to_owned(), setting(*preset))).collect();
        let sweeps: Vec<Sweep> = scenes(&context)
            .iter()
            .map(|(name, scene)| pictures(&mut context, name, scene, &settings, By::Mean).sweep)
            .collect();
        [0, 1, 2].map(|at| worst(&sweeps, at))
    }

    #[test]
    fn presets_keep_their_promises_and_order_by_error_and_clocks() {
        let all: Vec<[[f64; 2]; 3]> = seeds().map(found).collect();
        for (at, bounds) in BOUNDS.iter().enumerate() {
            for (figure, bound) in [bounds.mean_error, bounds.clocks].into_iter().enumerate() {
                let figures = || all.iter().map(|seed| seed[at][figure]);
                let mean = figures().sum::<f64>() / all.len() as f64;
                let variance = figures().map(|x| (x - mean).powi(2)).sum::<f64>() / (all.len() - 1) as f64;
                let most = figures().fold(0.0, f64::max);
                println!("{bounds:?}: mean {mean}, deviation {}, most {most}", variance.sqrt());
                assert!(most <= bound, "{bounds:?}: {most}");
                assert!(mean + DEVIATIONS * variance.sqrt() <= bound, "{bounds:?}: {mean} +- {}", variance.sqrt());
            }
        }
        for [draft, standard, exact] in all {
            assert!(draft[0] > standard[0] && standard[0] > exact[0]);
            assert!(draft[1] < standard[1] && standard[1] < exact[1]);
        }
    }
}
