//! The report as one page: HTML that needs no script, no network and no other file. Plots are inline SVG, pictures PNG
//! in data URIs; it is light or dark as the reader has it, and as wide as the window.

mod plot;

use std::io::Cursor;

use super::report::{Axis, By, Cell, Kind, Panel, Plot, Report, Section, Series, Strip, Sweep, Table};
use super::terminal::{cell, of_sweep_table, threads};
use super::verdict::of_sweep;
use crate::picture::Picture;

pub use plot::{standalone, svg};

/// Pictures narrower than this are magnified without smoothing.
const LARGE: u32 = 200;

/// Text as it may stand in HTML and SVG, also in attributes.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The page.
#[must_use]
pub fn html(report: &Report) -> String {
    let origin = &report.origin;
    let mut text = String::from(
        "<!DOCTYPE html>\n<html lang=\"en-GB\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>ZGA: what accuracy costs</title>\n<style>\n",
    );
    text.push_str(plot::STYLE);
    text.push_str(include_str!("page.css"));
    text.push_str("</style>\n</head>\n<body>\n<header>\n<h1>What accuracy costs</h1>\n");
    text.push_str(
        "<p class=\"lead\">ZGA is a graphics card in software. Each of its settings that trades accuracy for time is drawn here on \
         the card, compared with exact arithmetic, and priced: in clocks of the card, which are counted, and in time of the \
         computer that simulates it, which is measured.</p>\n\
         <p>In every plot down is more exact and left is cheaper. A setting is <em>never worth it</em> when another has no more \
         error and no more clocks. Errors are never taken against another setting of the card.</p>\n",
    );
    text.push_str("<h2>What was found</h2>\n");
    text.push_str(&list(&report.headlines, "findings headlines"));
    text.push_str("<nav>\n");
    for section in &report.sections {
        text.push_str(&format!("<a href=\"#{}\">{}</a>\n", section.name, escaped(short(section))));
    }
    text.push_str("</nav>\n</header>\n<main>\n");
    report.sections.iter().for_each(|section| text.push_str(&of_section(section)));
    text.push_str(&format!(
        "</main>\n<footer>\n<p class=\"origin\">zga {}, {}, seed {}, {} run, {} on {}. Errors and clocks are the same on \
         every machine for this seed; host times are this machine's. The figures as JSON: <code>zga accuracy --json -</code></p>\n\
         </footer>\n</body>\n</html>\n",
        escaped(&origin.version),
        escaped(&origin.date),
        origin.seed,
        origin.effort,
        threads(origin.threads),
        escaped(&origin.processor)
    ));
    text
}

/// A section's name in the list of them: its title up to a colon.
fn short(section: &Section) -> &str {
    section.title.split_once(':').map_or(section.title.as_str(), |(name, _)| name)
}

fn list(lines: &[String], class: &str) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let items: String = lines.iter().map(|line| format!("<li>{}</li>\n", escaped(line))).collect();
    format!("<ul class=\"{class}\">\n{items}</ul>\n")
}

fn of_section(section: &Section) -> String {
    let mut text = format!("<section id=\"{}\">\n<h2>{}</h2>\n", section.name, escaped(&section.title));
    section.about.iter().for_each(|line| text.push_str(&format!("<p>{}</p>\n", escaped(line))));
    text.push_str(&list(&section.findings, "findings"));
    section.summary.iter().for_each(|table| text.push_str(&of_table(table, &[])));
    let plots: Vec<Plot> =
        section.sweeps.iter().flat_map(of_sweep_plots).chain(section.plots.iter().cloned()).collect();
    if !plots.is_empty() {
        text.push_str(if plots.len() == 1 { "<div class=\"plots single\">\n" } else { "<div class=\"plots\">\n" });
        for plot in &plots {
            let title = escaped(&plot.title);
            text.push_str(&format!("<figure>\n<figcaption>{title}</figcaption>\n{}</figure>\n", svg(plot)));
        }
        text.push_str("</div>\n");
    }
    section.strips.iter().for_each(|strip| text.push_str(&of_strip(strip)));
    if !section.sweeps.is_empty() || !section.tables.is_empty() {
        // Where there is nothing else to see the figures are open.
        let open = if plots.is_empty() { " open" } else { "" };
        text.push_str(&format!("<details{open}>\n<summary>All figures of this section</summary>\n"));
        for sweep in &section.sweeps {
            let lost: Vec<bool> = of_sweep(sweep).iter().map(Option::is_some).collect();
            text.push_str(&of_table(&of_sweep_table(sweep), &lost));
        }
        section.tables.iter().for_each(|table| text.push_str(&of_table(table, &[])));
        text.push_str("</details>\n");
    }
    section.notes.iter().for_each(|line| text.push_str(&format!("<p class=\"note\">{}</p>\n", escaped(line))));
    text.push_str("</section>\n");
    text
}

/// Error against clocks and against host time.
#[must_use]
pub fn of_sweep_plots(sweep: &Sweep) -> Vec<Plot> {
    let unit = if sweep.by == By::Rate { "%" } else { sweep.unit };
    let y = match unit {
        "" => sweep.measure.clone(),
        unit => format!("{}, {unit}", sweep.measure),
    };
    let of = |what: &str, label: &str, price: fn(&super::report::Point) -> Option<f64>| {
        let places = sweep.points.iter().filter_map(|point| Some(([price(point)?, sweep.error(point)?], point)));
        let (points, labels): (Vec<_>, Vec<_>) = places.map(|(place, point)| (place, point.setting.clone())).unzip();
        let errors: Vec<f64> = points.iter().map(|point| point[1]).collect();
        let positive = || errors.iter().copied().filter(|error| *error > 0.0);
        let (least, most) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
        let axis = if most > 4.0 * least { Axis::logarithmic } else { Axis::linear };
        // A line through many settings that have no one order is a tangle.
        let kind = if points.len() > 6 { Kind::Marks } else { Kind::Line };
        (points.len() > 1).then(|| Plot {
            title: format!("{}: error against {what}", sweep.scene),
            x: Axis::linear(label),
            y: axis(y.as_str()),
            series: vec![Series { name: String::new(), points, labels, kind }],
        })
    };
    let clocks = of("clocks", "clocks of the card for a pixel", |point| point.price.clocks);
    let time = of("time", "host time for a pixel, ns", |point| point.price.nanoseconds);
    clocks.into_iter().chain(time).collect()
}

fn of_table(table: &Table, lost: &[bool]) -> String {
    let is_text = |at: usize| table.rows.iter().all(|row| matches!(row.get(at), None | Some(Cell::Text(_))));
    let mut text = String::new();
    if !table.title.is_empty() {
        text.push_str(&format!("<h3>{}</h3>\n", escaped(&table.title)));
    }
    text.push_str("<div class=\"wide\"><table>\n<tr>");
    for (at, column) in table.columns.iter().enumerate() {
        let class = if is_text(at) { " class=\"text\"" } else { "" };
        let unit =
            if column.unit.is_empty() { String::new() } else { format!("<small>{}</small>", escaped(column.unit)) };
        text.push_str(&format!("<th{class}>{}{unit}</th>", escaped(&column.name)));
    }
    text.push_str("</tr>\n");
    for (number, row) in table.rows.iter().enumerate() {
        text.push_str(if lost.get(number) == Some(&true) { "<tr class=\"lost\">" } else { "<tr>" });
        for (at, value) in row.iter().enumerate() {
            let shown = cell(value);
            let class = match (is_text(at), shown.chars().count() > 40) {
                (true, true) => " class=\"text long\"",
                (true, false) => " class=\"text\"",
                _ => "",
            };
            text.push_str(&format!("<td{class}>{}</td>", escaped(&shown)));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table></div>\n");
    text
}

fn of_strip(strip: &Strip) -> String {
    let mut text =
        format!("<h3>{}</h3>\n<div class=\"strip across{}\">\n", escaped(&strip.title), strip.panels.len().clamp(1, 3));
    for Panel { name, picture } in &strip.panels {
        let class = if picture.width < LARGE { " class=\"large\"" } else { "" };
        let name = escaped(name);
        let [width, height] = [picture.width, picture.height];
        text.push_str(&format!(
            "<figure><img{class} alt=\"{name}\" width=\"{width}\" height=\"{height}\" src=\"data:image/png;base64,{}\">\
             <figcaption>{name}</figcaption></figure>\n",
            base64::encode(png(picture))
        ));
    }
    text.push_str(&format!("</div>\n<p class=\"note\">{}</p>\n", escaped(&strip.caption)));
    text
}

/// A picture as the bytes of a PNG; nothing for one whose bytes are not those of its size.
fn png(picture: &Picture) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let (kind, format) = (image::ExtendedColorType::Rgb8, image::ImageFormat::Png);
    match image::write_buffer_with_format(&mut bytes, &picture.rgb, picture.width, picture.height, kind, format) {
        Ok(()) => bytes.into_inner(),
        Err(_) => Vec::new(),
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
