//! Edges inside a surface: at every edge of a triangle, or at the borders of surfaces alone.

use zga_tests::harness::Edges;
use zga_tests::study::card::Setting;

use super::super::context::Context;
use super::super::model;
use super::super::report::{By, Cell, Section, Table};
use super::super::verdict::{figure, sentences};
use super::{GRIDS, Swept, magnified_at, mesh_name, pictures, worst};
use crate::error::Result;

/// From the coarser to the finer.
const EDGES: [(Edges, &str); 2] = [(Edges::Borders, "borders"), (Edges::All, "all")];
/// The smallest picture has so many times fewer pixels along a side than that of the mesh.
const SMALLER: u32 = 8;

/// Grids with samples, each with both kinds of edges, in this order.
fn settings() -> Vec<(String, Setting)> {
    let grids = GRIDS.into_iter().skip(1);
    let of_grid = |(grid, name)| {
        EDGES.map(|(edges, kind)| (format!("{name} {kind}"), Setting { grid, edges, ..Setting::best() }))
    };
    grids.flat_map(of_grid).collect()
}

/// Pixels in which the picture at borders differs from that at every edge.
#[derive(Clone, Debug, Default, PartialEq)]
struct Apart {
    /// How many.
    pixels: u64,
    /// Mean and largest distance from the truth there, at borders and at every edge, levels.
    mean: [f64; 2],
    largest: [f64; 2],
}

impl Apart {
    /// Of the pictures of one grid: their settings' positions in [`settings`].
    fn new(swept: &Swept, pair: [usize; 2]) -> Self {
        let pictures = pair.map(|at| &swept.drawn[at].colour);
        let mut found = Self::default();
        for pixel in (0..pictures[0].len()).filter(|pixel| pictures[0][*pixel] != pictures[1][*pixel]) {
            found.pixels += 1;
            for (k, picture) in pictures.into_iter().enumerate() {
                let distance = swept.truth.distance(pixel, picture[pixel]);
                found.mean[k] += distance;
                found.largest[k] = found.largest[k].max(distance);
            }
        }
        found.mean = found.mean.map(|sum| sum / found.pixels.max(1) as f64);
        found
    }
}

/// Distance of the farthest channel between two pictures, levels.
fn apart(a: &[u32], b: &[u32]) -> Vec<f64> {
    let pixel = |(a, b): (&u32, &u32)| {
        let channels = a.to_be_bytes().into_iter().zip(b.to_be_bytes());
        f64::from(channels.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0))
    };
    a.iter().zip(b).map(pixel).collect()
}

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    let settings = settings();
    let small = context.size.map(|side| (side / SMALLER).max(1));
    let scenes = [
        (format!("{} with flat faces", mesh_name(context)), model::scene(&context.mesh, context.size)),
        (format!("the same, smooth, on {} x {} pixels", small[0], small[1]), model::smooth(&context.mesh, small)),
        (format!("{}, smooth", mesh_name(context)), model::smooth(&context.mesh, context.size)),
    ];
    let mut section = Section {
        name: "subpixel-edges",
        title: "Edges inside a surface: samples at every edge, or at borders".to_owned(),
        about: vec![
            "An edge that two triangles of one surface share ends nothing: colours go on across it. With borders such edges have \
             no samples, and a pixel that lies inside a surface keeps the one colour of its centre; where a surface ends, folds or \
             changes its colour pixels have samples as with all. The error is that of the picture against the true picture, \
             which has 256 exactly decided samples a pixel, each with the colour of its own place. Faces of one colour each \
             share no edge unless their colours are the same, so nothing may be lost there; in a smooth mesh on few pixels triangles \
             are smaller than a pixel."
                .to_owned(),
        ],
        ..Section::default()
    };
    let mut table = Table::new(
        "Pixels that the unit took up, and those that differ: their distance from the true picture",
        &[
            ("scene", ""),
            ("grid", ""),
            ("taken up, all", ""),
            ("borders", ""),
            ("pixels that differ", ""),
            ("mean error there, all", "levels of 255"),
            ("borders", ""),
            ("largest, all", "levels of 255"),
            ("borders", ""),
        ],
    );
    for (name, scene) in &scenes {
        let swept = pictures(context, name, scene, &settings, By::Mean);
        section.findings.extend(sentences(&swept.sweep));
        let mut last = None;
        for (number, (_, grid)) in GRIDS.into_iter().skip(1).enumerate() {
            let pair = [2 * number, 2 * number + 1];
            let found = Apart::new(&swept, pair);
            let [borders, all] = pair.map(|at| swept.drawn[at].events["subpixel.pixels_active"]);
            let of_found = |figure: f64| (found.pixels > 0).then_some(figure).into();
            table.rows.push(vec![
                name.as_str().into(),
                grid.into(),
                Cell::Count(all),
                Cell::Count(borders),
                Cell::Count(found.pixels),
                of_found(found.mean[1]),
                of_found(found.mean[0]),
                of_found(found.largest[1]),
                of_found(found.largest[0]),
            ]);
            last = Some((grid, pair, found, [borders, all]));
        }
        let Some((grid, pair, found, [borders, all])) = last else { continue };
        let points = pair.map(|at| &swept.sweep.points[at]);
        let clocks = points.map(|point| point.price.clocks.unwrap_or(0.0));
        let error = points.map(|point| point.error.mean.unwrap_or(0.0));
        let there = match found.pixels {
            0 => "no pixel differs".to_owned(),
            pixels => format!(
                "{} in place of {} in the {pixels} pixels that differ, and {} in place of {} in the worst of them",
                figure(found.mean[0]),
                figure(found.mean[1]),
                figure(found.largest[0]),
                figure(found.largest[1]),
            ),
        };
        section.findings.push(format!(
            "Samples at borders alone, {grid}: {borders} pixels are taken up in place of {all}, for {} times the clocks; the mean colour \
             error is {} in place of {} levels of 255; {there} ({name}).",
            figure(clocks[0] / clocks[1]),
            figure(error[0]),
            figure(error[1]),
        ));
        if found.pixels > 0 {
            let [borders, all] = pair.map(|at| swept.drawn[at].colour.as_slice());
            let at = worst(&apart(borders, all), scene.size);
            let shown = [("all", all), ("borders", borders)];
            let caption = format!("Where both differ most, {grid}. Differences: white none, black 128 levels or more.");
            section.strips.push(magnified_at(at, name, &swept.truth, &shown, &caption));
        }
        section.sweeps.push(swept.sweep);
    }
    section.tables.push(table);
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::super::super::context::{Effort, Options};
    use super::*;

    #[test]
    fn section_flat_faces_lose_nothing_and_smooth_ones_are_taken_up_at_borders_alone() {
        let options = Options { seed: 1, effort: Effort::Quick, size: [160, 120], threads: 1, mesh: None };
        let mut tell = |_: &str| {};
        let mut context = Context::new(&options, &mut tell).expect("the teapot");

        let found = section(&mut context).expect("measured");

        let count = |row: &[Cell], column: usize| match row[column] {
            Cell::Count(count) => count,
            _ => panic!("a count in column {column} of {row:?}"),
        };
        let [flat, small, smooth] = found.tables[0].rows.as_chunks::<3>().0 else { panic!("three scenes") };
        for row in flat {
            assert!(count(row, 2) > 0 && count(row, 4) == 0, "{row:?}");
        }
        for row in small.iter().chain(smooth) {
            let [all, borders, differ] = [2, 3, 4].map(|column| count(row, column));
            // What differs was taken up before and is not now.
            assert!(borders < all && differ > 0 && differ <= all - borders, "{row:?}");
        }
        // The finer the grid the more exact, at every edge and at borders.
        for sweep in &found.sweeps {
            let error: Vec<f64> = sweep.points.iter().filter_map(|point| point.error.mean).collect();
            assert!(error[0] > error[4] && error[1] > error[5], "{error:?}");
        }
        assert_eq!(found.strips.len(), 2);
    }

    #[test]
    fn apart_is_the_farthest_channel() {
        assert_eq!(apart(&[0x10_2030, 0xFF_0000], &[0x12_2030, 0xF0_0014]), [2.0, 20.0]);
    }
}
