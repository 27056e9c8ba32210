//! The axes of accuracy, a file each: a study's figures become a section.

pub(super) mod bypass;
pub(super) mod combined;
pub(super) mod coordinates;
pub(super) mod depth;
pub(super) mod edges;
pub(super) mod fidelity;
pub(super) mod filter;
pub(super) mod grid;
pub(super) mod order;
pub(super) mod presets;
pub(super) mod shading;

use zga_tests::harness::{Grid, Order, Random};
use zga_tests::study::card::{self, Drawn, Setting};
use zga_tests::study::scene::{Kind, Scene};
use zga_tests::study::truth::{Truth, truth};

use super::context::{Context, picture};
use super::model;
use super::report::{By, ErrorFigures, Panel, Point, Price, Strip, Sweep};
use crate::picture::Picture;

/// Samples along a side of a pixel for the true picture.
const EXACT: u32 = 16;
/// Pixels of a crop.
const CROP: [u32; 2] = [32, 24];

/// Grids and what they are called in tables.
const GRIDS: [(Grid, &str); 4] =
    [(Grid::Off, "1"), (Grid::Grid4x4, "4x4"), (Grid::Grid8x4, "8x4"), (Grid::Grid8x8, "8x8")];
/// Orders of fragments and what they are called.
const ORDERS: [(Order, &str); 3] =
    [(Order::Centre, "centre"), (Order::Search, "search"), (Order::Exhaustive, "exhaustive")];

/// Settings of an axis on a scene, measured.
struct Swept {
    sweep: Sweep,
    drawn: Vec<Drawn>,
    truth: Truth,
}

/// What a frame costs for each of `pixels`.
fn price(drawn: &Drawn, pixels: usize) -> Price {
    let pixels = pixels.max(1) as f64;
    let timed = !drawn.nanoseconds.is_empty();
    Price {
        clocks: Some(drawn.clocks as f64 / pixels),
        nanoseconds: timed.then(|| drawn.median() / pixels),
        spread: timed.then(|| drawn.spread() / pixels),
    }
}

/// Draws a scene under each setting and compares with the true picture.
fn pictures(context: &mut Context<'_>, name: &str, scene: &Scene, settings: &[(String, Setting)], by: By) -> Swept {
    context.tell(name);
    let repeats = context.effort.pick(11, 31);
    let plain: Vec<Setting> = settings.iter().map(|(_, setting)| *setting).collect();
    let truth = truth(scene, [EXACT; 2]);
    let drawn = card::drawn(scene, &plain, context.threads, repeats);
    let points = settings.iter().zip(&drawn).map(|((name, _), drawn)| {
        let found = card::error(&truth, &drawn.colour);
        let standard_error = match by {
            By::Mean => Some(found.standard_error),
            By::Rate => Some(card::error_of_rate(found.wrong, found.pixels)),
            By::Maximum => None,
        };
        let error = ErrorFigures {
            mean: Some(found.mean),
            maximum: Some(found.maximum),
            rate: Some(found.rate()),
            standard_error,
            samples: found.pixels,
            published: None,
        };
        Point { setting: name.clone(), error, price: price(drawn, scene.pixels()) }
    });
    let sweep = Sweep {
        scene: name.to_owned(),
        measure: "colour error against the true picture".to_owned(),
        unit: "levels of 255",
        by,
        points: points.collect(),
    };
    Swept { sweep, drawn, truth }
}

/// The random scenes and the mesh, with names.
fn scenes(context: &Context<'_>) -> Vec<(String, Scene)> {
    let size = context.effort.pick([160, 120], [320, 240]);
    let soup = Kind::Soup.scene(size, &mut Random::new(context.seed));
    vec![(Kind::Soup.name().to_owned(), soup), (mesh_name(context), model::scene(&context.mesh, context.size))]
}

/// What the mesh is called in the report.
fn mesh_name(context: &Context<'_>) -> String {
    format!("{} ({} triangles)", context.mesh.name, context.mesh.indices.len() / 3)
}

/// What the mesh is called where it stands twice, see [`model::crossing`].
fn crossing_name(context: &Context<'_>) -> String {
    format!("{} twice, crossing", context.mesh.name)
}

/// The part of a picture from `at`.
fn cropped(whole: &Picture, at: [u32; 2], size: [u32; 2]) -> Picture {
    let [width, height] = [size[0].min(whole.width), size[1].min(whole.height)];
    let places = (at[1]..at[1] + height).flat_map(|y| (at[0]..at[0] + width).map(move |x| (x, y)));
    let rgb = places.flat_map(|(x, y)| whole.at(x, y).unwrap_or_default()).collect();
    Picture { width, height, rgb }
}

/// Where a window of the crop's size has the most of `distances` in it.
fn worst(distances: &[f64], [width, height]: [u32; 2]) -> [u32; 2] {
    let at = |x: u32, y: u32| distances.get((y * width + x) as usize).copied().unwrap_or(0.0);
    let [across, down] = [CROP[0].min(width), CROP[1].min(height)];
    let sum = |[left, top]: [u32; 2]| -> f64 {
        (top..top + down).flat_map(|y| (left..left + across).map(move |x| (x, y))).map(|(x, y)| at(x, y)).sum()
    };
    let windows = (0..=height - down).step_by(6).flat_map(|y| (0..=width - across).step_by(6).map(move |x| [x, y]));
    windows.max_by(|a, b| sum(*a).total_cmp(&sum(*b))).unwrap_or([0, 0])
}

/// Differences as a picture: white where there is none, through orange to black at 128 levels and more.
fn heat(distances: &[f64], [width, height]: [u32; 2]) -> Picture {
    let colour = |distance: &f64| {
        let t = (distance / 128.0).clamp(0.0, 1.0).sqrt();
        let channel = |from: f64, middle: f64, to: f64| {
            let level =
                if t < 0.5 { from + (middle - from) * 2.0 * t } else { middle + (to - middle) * (2.0 * t - 1.0) };
            level.round() as u8
        };
        [channel(250.0, 235.0, 60.0), channel(250.0, 120.0, 0.0), channel(250.0, 30.0, 20.0)]
    };
    Picture { width, height, rgb: distances.iter().flat_map(colour).collect() }
}

/// Distances of the pixels of a picture of `size` from the truth, levels.
fn distances(truth: &Truth, colour: &[u32]) -> Vec<f64> {
    colour.iter().enumerate().map(|(at, shown)| truth.distance(at, *shown)).collect()
}

/// A magnified crop of where the first picture is worst; a row for each: true picture, that of the card, difference.
fn magnified(title: &str, truth: &Truth, shown: &[(&str, &[u32])], caption: &str) -> Strip {
    let at = shown.first().map_or([0, 0], |(_, bad)| worst(&distances(truth, bad), truth.size));
    magnified_at(at, title, truth, shown, caption)
}

/// The same of the crop at `at`.
fn magnified_at(at: [u32; 2], title: &str, truth: &Truth, shown: &[(&str, &[u32])], caption: &str) -> Strip {
    let size = truth.size;
    let panel = |name: String, whole: &Picture| Panel { name, picture: cropped(whole, at, CROP) };
    let mut panels = Vec::new();
    for (name, colour) in shown {
        panels.push(panel("true picture".to_owned(), &picture(size, &truth.rounded())));
        panels.push(panel((*name).to_owned(), &picture(size, colour)));
        panels.push(panel("difference".to_owned(), &heat(&distances(truth, colour), size)));
    }
    Strip { title: title.to_owned(), panels, caption: caption.to_owned() }
}
