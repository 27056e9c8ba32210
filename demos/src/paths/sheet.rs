//! The picture of a comparison: where each path works, and bars of what it costs.
//!
//! Inputs from: [`Comparison`], [`Survey`]. Outputs to: `zga paths --picture`, documentation.
//!
//! Six panels, each the scene with a map over it, then bars: clocks by unit, words by kind, bits on the chip.

use zga_abi::Counter;
use zga_abi::format::HiddenSurface;

use super::view::{self, CLEARED, COSTLY, FREE, HATCH, NEAR_FAR, OPEN, free_tokens};
use super::{Comparison, Run, Survey};
use crate::canvas::{Canvas, Ink, heat, shrunk, text_size};
use crate::picture::Picture;
use crate::table::grouped;

/// Widest and highest that the scene is in a panel, pixels.
const PANEL: [u32; 2] = [400, 300];
/// Space round things.
const GAP: u32 = 20;
/// Height of a panel's caption: a title, two lines below the map.
const CAPTION: [u32; 2] = [26, 30];
/// Width of an entry of a key without its text.
const KEY: u32 = 28;
/// Height of a bar with the space below it.
const BAR: u32 = 20;
const PAPER: Ink = [14, 16, 24];
const WHITE: Ink = [236, 238, 244];
const GREY: Ink = [150, 158, 178];
/// Colours of the parts of a bar.
const PARTS: [Ink; 8] = [
    [96, 104, 128],
    [88, 142, 206],
    [244, 130, 70],
    [252, 196, 92],
    [186, 110, 170],
    [112, 186, 120],
    [224, 92, 104],
    [60, 190, 180],
];

/// A map with what stands round it.
struct Panel {
    title: &'static str,
    map: Picture,
    notes: [String; 2],
    key: Vec<(Ink, String)>,
}

impl Panel {
    /// Width of the map or of the longest line, pixels.
    fn width(&self) -> u32 {
        let key: u32 = self.key.iter().map(|(_, text)| KEY + text_size(1, text)[0]).sum();
        let title = text_size(1, self.title)[0] + key;
        self.notes.iter().map(|note| text_size(1, note)[0]).fold(title.max(self.map.width), u32::max)
    }
}

/// A group of bars.
struct Bars {
    title: &'static str,
    names: Vec<&'static str>,
    /// Name, parts and the text behind each bar.
    rows: Vec<(String, Vec<u64>)>,
}

/// The contact sheet; `maps` as [`super::reads`], [`super::blocks`], [`super::lines`], [`super::tiles`] give them.
#[must_use]
pub fn sheet(found: &Comparison, maps: &[Survey]) -> Picture {
    let panels = panels(found, maps);
    let bars = [clocks(found), words(found), bits(found)];
    let columns = 3.min(panels.len().max(1)) as u32;
    let size = panels.iter().fold([0, 0], |size, panel| [size[0].max(panel.width()), size[1].max(panel.map.height)]);
    let step = [size[0] + GAP, size[1] + CAPTION[0] + CAPTION[1] + GAP];
    let rows = (panels.len() as u32).div_ceil(columns);
    let height_of = |bars: &Bars| 46 + BAR * bars.rows.len() as u32;
    let width = GAP + columns * step[0];
    let top = 56;
    let height = top + rows * step[1] + bars.iter().map(height_of).sum::<u32>() + GAP;
    let mut canvas = Canvas::new([width, height], PAPER);
    let [pixels, lines] = found.size;
    canvas.text([GAP, GAP], 2, WHITE, &format!("{}, {pixels} x {lines}: one picture, four ways", found.name));
    for (place, panel) in (0_u32..).zip(&panels) {
        let at = [GAP + place % columns * step[0], top + place / columns * step[1]];
        draw_panel(&mut canvas, at, panel);
    }
    let mut y = top + rows * step[1];
    for group in &bars {
        draw_bars(&mut canvas, y, width, group);
        y += height_of(group);
    }
    canvas.into_picture()
}

fn draw_panel(canvas: &mut Canvas, [x, y]: [u32; 2], panel: &Panel) {
    canvas.text([x, y + 6], 1, WHITE, panel.title);
    let mut right = x + text_size(1, panel.title)[0];
    for (ink, text) in &panel.key {
        canvas.fill([right + 12, y + 6], [8, 8], *ink);
        canvas.text([right + 24, y + 6], 1, GREY, text);
        right += KEY + text_size(1, text)[0];
    }
    let top = y + CAPTION[0];
    canvas.put([x, top], 1, &panel.map);
    canvas.frame([x, top], [panel.map.width, panel.map.height], [60, 66, 88]);
    for (line, note) in (0_u32..).zip(&panel.notes) {
        canvas.text([x, top + panel.map.height + 6 + 12 * line], 1, GREY, note);
    }
}

fn draw_bars(canvas: &mut Canvas, top: u32, width: u32, bars: &Bars) {
    const NUMBERS: u32 = 120;
    let names = 16 + bars.rows.iter().map(|(name, _)| text_size(1, name)[0]).max().unwrap_or(0);
    canvas.text([GAP, top], 1, WHITE, bars.title);
    let mut x = GAP + text_size(1, bars.title)[0] + 18;
    for (name, ink) in bars.names.iter().zip(PARTS) {
        canvas.fill([x, top], [8, 8], ink);
        canvas.text([x + 12, top], 1, GREY, name);
        x += 24 + text_size(1, name)[0];
    }
    let room = f64::from(width.saturating_sub(2 * GAP + names + NUMBERS));
    let most = bars.rows.iter().map(|(_, parts)| parts.iter().sum::<u64>()).max().unwrap_or(0).max(1);
    for (line, (name, parts)) in (0_u32..).zip(&bars.rows) {
        let y = top + 18 + BAR * line;
        canvas.text([GAP, y + 4], 1, WHITE, name);
        let place = |count: u64| GAP + names + (room * count as f64 / most as f64).round() as u32;
        let mut sum = 0;
        for (part, ink) in parts.iter().zip(PARTS) {
            let from = place(sum);
            sum += part;
            canvas.fill([from, y], [place(sum) - from, BAR - 5], ink);
        }
        canvas.text([place(sum) + 8, y + 4], 1, WHITE, &grouped(sum));
    }
}

/// The panels that there are data for.
fn panels(found: &Comparison, maps: &[Survey]) -> Vec<Panel> {
    let Some(reference) = found.reference() else {
        return Vec::new();
    };
    let whole = Picture::of_frame(&reference.frame);
    let picture = shrunk(&whole, PANEL);
    // A scene that is shrunk has maps of its own size, which are shrunk with it; a small one is drawn larger.
    let times = if picture == whole { (PANEL[0] / whole.width).min(PANEL[1] / whole.height).max(1) } else { 1 };
    let small = |map: Picture| shrunk(&map, PANEL);
    let map = |name: &str| maps.iter().find(|map| map.name == name);
    let mut all = vec![Panel {
        title: "the picture",
        map: small(enlarged(&whole, times)),
        notes: [
            if found.is_good() { "every path gives these bits".to_owned() } else { "THE PATHS DIFFER".to_owned() },
            reference.frame.hash.clone(),
        ],
        key: Vec::new(),
    }];
    let heat_key = |survey: &Survey| match survey.most() {
        0 => Vec::new(),
        most => vec![(heat(0.12), "few".to_owned()), (heat(1.0), grouped(most))],
    };
    if let Some(survey) = map("depths read") {
        all.push(Panel {
            title: "zbuffer: depths read",
            map: small(view::cells(&whole, survey, times)),
            notes: [sum(survey, "depths"), cell_note(survey, "pixels")],
            key: heat_key(survey),
        });
    }
    let za = found.plain(HiddenSurface::Za);
    if let Some((run, words)) = za.and_then(|run| run.za.as_ref().map(|words| (run, words))) {
        let cleared = words.words.iter().filter(|word| **word < 0).count() as u64;
        let maximum = run.case.settings.depth.maximum() as i32;
        all.push(Panel {
            title: "za: words at the end",
            map: small(view::za(&whole, words, maximum, times)),
            notes: [
                format!("{} of {} blocks are cleared still:", grouped(cleared), grouped(words.words.len() as u64)),
                "scan-out puts out their background".to_owned(),
            ],
            key: vec![
                (HATCH, "cleared".to_owned()),
                (OPEN, "open".to_owned()),
                (NEAR_FAR[0], "near".to_owned()),
                (NEAR_FAR[1], "far".to_owned()),
            ],
        });
    }
    for (name, title) in [("compared", "za: blocks compared"), ("bypassed", "za: blocks bypassed")] {
        if let Some(survey) = map(name) {
            all.push(Panel {
                title,
                map: small(view::cells(&whole, survey, times)),
                notes: [sum(survey, "visits"), cell_note(survey, "blocks")],
                key: heat_key(survey),
            });
        }
    }
    if let (Some(survey), Some(run)) = (map("tokens"), found.plain(HiddenSurface::Systolic)) {
        let free = free_tokens(&run.case.settings, whole.width, survey.units);
        all.push(Panel {
            title: "systolic: tokens of the lines",
            map: small(view::tokens(&whole, survey, free, times)),
            notes: [
                sum(survey, "tokens"),
                format!("most {}; up to {free} hide behind the pixels on the bus", grouped(survey.most())),
            ],
            key: vec![(FREE, "hidden".to_owned()), (COSTLY, "cost clocks".to_owned())],
        });
    }
    if let Some(survey) = map("links of the lists") {
        all.push(Panel {
            title: "tile: lists of the tiles",
            map: small(view::cells(&whole, survey, times)),
            notes: [sum(survey, "links"), cell_note(survey, "tiles")],
            key: heat_key(survey),
        });
    }
    if all.len() % 3 == 1 {
        // The comparisons say more than the depths of a path that compares everywhere.
        all.retain(|panel| panel.title != "zbuffer: depths read");
    }
    all
}

fn sum(survey: &Survey, what: &str) -> String {
    format!("{} {what}", grouped(survey.sum()))
}

fn cell_note(survey: &Survey, what: &str) -> String {
    let [width, height] = survey.cell;
    match survey.units {
        1 => format!("cells of {width} x {height} pixels; most {}", grouped(survey.most())),
        units => format!("cells of {width} x {height} pixels, {units} {what}; most {}", grouped(survey.most())),
    }
}

/// Each pixel `times` as wide and high.
fn enlarged(picture: &Picture, times: u32) -> Picture {
    let mut canvas = Canvas::new([picture.width * times, picture.height * times], CLEARED);
    canvas.put([0, 0], times, picture);
    canvas.into_picture()
}

/// The runs that bars are drawn for: functional ones; a clocked one counts the same.
fn barred(found: &Comparison) -> impl Iterator<Item = (String, &Run)> {
    let functional = |run: &&Run| found.same_counters(run).is_none();
    found.runs.iter().filter(functional).map(|run| {
        let path = run.case.settings.hidden_surface.name();
        let variant = &run.case.variant;
        (if variant.is_empty() { path.to_owned() } else { format!("{path} {variant}") }, run)
    })
}

fn clocks(found: &Comparison) -> Bars {
    const UNITS: [(&str, &[Counter]); 6] = [
        ("front end", &[Counter::CyclesFrontend]),
        ("geometry", &[Counter::CyclesGeometry]),
        ("hidden surfaces", &[Counter::CyclesZBuffer, Counter::CyclesZa, Counter::CyclesSystolic, Counter::CyclesTile]),
        ("shading", &[Counter::CyclesShading]),
        ("bitmap, scan-out", &[Counter::CyclesBitmap, Counter::CyclesScanout]),
        ("sub-pixels", &[Counter::CyclesSubpixel]),
    ];
    let parts = |run: &Run| {
        UNITS.iter().map(|(_, counters)| counters.iter().map(|counter| run.counters.get(*counter)).sum()).collect()
    };
    let rows = barred(found).map(|(name, run)| (name, parts(run))).collect();
    Bars { title: "Clocks", names: UNITS.map(|(name, _)| name).to_vec(), rows }
}

fn words(found: &Comparison) -> Bars {
    let names =
        vec!["depths read", "depths written", "colours written", "colours to scan-out", "Za words read and written"];
    let parts = |run: &Run| {
        let words = &run.words;
        let za = words.za_read + words.za_written;
        vec![words.depths_read, words.depths_written, words.colours_written, words.scan_out_read, za]
    };
    Bars { title: "Words to and from memory", names, rows: barred(found).map(|(n, run)| (n, parts(run))).collect() }
}

fn bits(found: &Comparison) -> Bars {
    let rows = barred(found).map(|(name, run)| (name, vec![run.storage.on_chip_bits()])).collect();
    Bars { title: "Bits on the chip", names: Vec::new(), rows }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::tests::compared;
    use crate::paths::{blocks, lines, reads, tiles};
    use crate::play::Look;

    #[test]
    fn sheet_has_a_panel_for_each_map_and_is_the_same_every_time() {
        let (mut session, found) = compared("za", [96, 64], false);
        let scene = crate::demos::find("za").expect("a demo").build(0);
        let look = Look::default();
        let mut maps = vec![reads(&mut session, &scene, look).expect("drawn")];
        maps.extend(blocks(&mut session, &scene, look).expect("drawn"));
        maps.push(lines(&mut session, &scene, look).expect("drawn"));
        maps.push(tiles(&mut session, &scene, look).expect("drawn"));
        let panels = panels(&found, &maps);
        assert_eq!(panels.len(), 6);
        assert!(panels.iter().all(|panel| (panel.map.width, panel.map.height) == (4 * 96, 4 * 64)));
        let first = sheet(&found, &maps);
        assert!(first.width > 3 * 384 && first.height > 2 * 256);
        assert_eq!(first, sheet(&found, &maps));
    }
}
