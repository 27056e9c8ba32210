//! The page holds everything, and nothing from elsewhere.

use super::super::report::{ErrorFigures, Origin, Point, Price};
use super::*;

fn report() -> Report {
    let point = |setting: &str, mean: f64, clocks: f64| Point {
        setting: setting.to_owned(),
        error: ErrorFigures { mean: Some(mean), samples: 10, ..ErrorFigures::default() },
        price: Price { clocks: Some(clocks), nanoseconds: Some(7.0 * clocks), spread: Some(0.5) },
    };
    let sweep = Sweep {
        scene: "tests <here>".to_owned(),
        measure: "error".to_owned(),
        unit: "px",
        by: By::Mean,
        points: vec![point("coarse", 2.0, 3.0), point("fine", 0.1, 2.0)],
    };
    let picture = Picture { width: 2, height: 1, rgb: vec![1, 2, 3, 4, 5, 6] };
    let panel = |name: &str| Panel { name: name.to_owned(), picture: picture.clone() };
    let panels = vec![panel("true picture"), panel("card"), panel("difference")];
    let section = Section {
        name: "axis",
        title: "An axis: with a title".to_owned(),
        sweeps: vec![sweep],
        strips: vec![Strip { title: "worst".to_owned(), panels, caption: "a caption".to_owned() }],
        summary: Some(Table::new("summary", &[("setting", ""), ("value", "px")])),
        ..Section::default()
    };
    let origin = Origin {
        seed: 7,
        date: "2026-01-31".to_owned(),
        version: "0.0.0".to_owned(),
        processor: "a & b".to_owned(),
        threads: 2,
        effort: "quick",
    };
    Report { origin, headlines: vec!["fine is better".to_owned()], sections: vec![section] }
}

#[test]
fn page_has_every_plot_and_picture_and_no_reference_to_elsewhere() {
    let text = html(&report());

    assert_eq!(text.matches("<svg ").count(), 2, "error against clocks and against time");
    assert_eq!(text.matches("src=\"data:image/png;base64,").count(), 3);
    assert_eq!(text.matches("src=").count(), 3);
    for foreign in ["<script", "<link", "url(", "@import", "href=\"http", "src=\"http"] {
        assert!(!text.contains(foreign), "{foreign}");
    }
    // The one address is the name of SVG's namespace.
    assert_eq!(text.matches("http").count(), text.matches("http://www.w3.org/2000/svg").count());
    assert!(text.contains("tests &lt;here&gt;") && text.contains("a &amp; b") && text.contains("href=\"#axis\""));
    assert!(text.contains("<tr class=\"lost\">"), "coarse is dominated");
}

#[test]
fn page_tags_are_closed() {
    let text = html(&report());
    for tag in ["section", "figure", "table", "svg", "details", "div", "ul", "main", "header", "footer", "nav"] {
        let (opened, closed) = (text.matches(&format!("<{tag}")).count(), text.matches(&format!("</{tag}>")).count());
        assert!(opened == closed || tag == "header", "{tag}: {opened} and {closed}");
    }
}

#[test]
fn png_is_a_picture_of_its_size_or_nothing() {
    let good = Picture { width: 2, height: 1, rgb: vec![0; 6] };
    assert_eq!(&png(&good)[1..4], b"PNG");
}
