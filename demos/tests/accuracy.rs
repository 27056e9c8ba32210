//! `zga accuracy` as a program: its JSON keeps the documented schema, its page has every plot.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn zga(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_zga")).args(arguments).output().expect("zga runs")
}

/// A folder of the test's own, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("zga-accuracy-{name}-{}", std::process::id())))
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn list<'a>(value: &'a Value, name: &str) -> &'a Vec<Value> {
    value[name].as_array().unwrap_or_else(|| panic!("{name} is a list in {value}"))
}

/// A number, or null where nothing is measured.
fn figure(value: &Value) -> bool {
    value.is_null() || value.as_f64().is_some_and(|number| number >= 0.0)
}

#[test]
fn json_has_the_documented_fields_and_the_page_a_plot_for_each_sweep() {
    let folder = Folder::new("all");
    let (json, page, readme) = (folder.file("a.json"), folder.file("a.html"), folder.file("readme"));
    let parts = ["accuracy", "coordinates", "za-prediction", "fidelity", "presets", "--seed", "5", "--size", "96x72"];
    let files = ["--threads", "1", "--json", &json, "--html", &page, "--readme", &readme];
    let told = zga(&[&parts[..], &files].concat());
    assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
    let text = String::from_utf8_lossy(&told.stdout);
    assert!(text.contains("seed 5, quick run") && text.contains("Coordinate bits") && text.contains("clocks/pixel"));

    let report: Value = serde_json::from_slice(&std::fs::read(&json).expect("written")).expect("JSON");
    assert_eq!((&report["schema"], &report["effort"]), (&"zga.accuracy/1".into(), &"quick".into()));
    assert!(report["seed"] == 5 && report["machine"]["processor"].is_string() && report["machine"]["threads"] == 1);
    assert_eq!(report["date"].as_str().map(str::len), Some(10));
    let sections = list(&report, "sections");
    let names: Vec<&str> = sections.iter().filter_map(|section| section["name"].as_str()).collect();
    assert_eq!(names, ["presets", "coordinates", "za-prediction", "fidelity"]);
    let mut sweeps = 0;
    for section in sections {
        assert!(["about", "findings", "notes", "tables", "plots"].iter().all(|name| section[*name].is_array()));
        for sweep in list(section, "sweeps") {
            sweeps += 1;
            check_sweep(sweep);
        }
        for table in list(section, "tables") {
            let columns = list(table, "columns").len();
            assert!(list(table, "rows").iter().all(|row| row.as_array().map(Vec::len) == Some(columns)), "{table}");
        }
    }

    let html = std::fs::read_to_string(&page).expect("written");
    assert_eq!(html.matches("<svg class=\"plot\"").count(), 2 * sweeps);
    assert!(names.iter().all(|name| html.contains(&format!("<section id=\"{name}\">"))));
    assert!(!html.contains("<script") && !html.contains("href=\"http") && !html.contains("NaN"));
    let fragment = std::fs::read_to_string(Path::new(&readme).join("accuracy.md")).expect("written");
    assert!(fragment.contains("| draft |") && fragment.contains("(accuracy.svg)") && fragment.contains("seed 5"));
    let plot = std::fs::read_to_string(Path::new(&readme).join("accuracy.svg")).expect("written");
    assert!(plot.starts_with("<svg") && plot.contains("<style>"));
}

fn check_sweep(sweep: &Value) {
    assert!(["mean", "maximum", "rate"].contains(&sweep["by"].as_str().unwrap_or_default()), "{sweep}");
    let settings: Vec<&Value> = list(sweep, "points").iter().map(|point| &point["setting"]).collect();
    for point in list(sweep, "points") {
        let of_error = ["mean", "maximum", "rate_percent", "standard_error", "published", "samples"];
        assert!(of_error.iter().all(|name| point["error"].get(*name).is_some_and(figure)), "{point}");
        let of_price = ["clocks_per_pixel", "host_ns_per_pixel", "host_ns_spread"];
        assert!(of_price.iter().all(|name| point.get(*name).is_some_and(figure)), "{point}");
        let by = &point["dominated_by"];
        assert!(by.is_null() || settings.contains(&by), "{point}");
    }
}

#[test]
fn errors_and_clocks_are_the_same_again_and_on_any_threads() {
    let run = |threads: &str| -> Vec<Value> {
        let told = zga(&["accuracy", "subpixel-depth", "--size", "64x48", "--threads", threads, "--json", "-"]);
        let report: Value = serde_json::from_slice(&told.stdout).expect("JSON");
        let sweeps = report["sections"][0]["sweeps"].as_array().cloned().unwrap_or_default();
        let points = sweeps.iter().flat_map(|sweep| sweep["points"].as_array().cloned().unwrap_or_default());
        points.map(|point| serde_json::json!([point["error"], point["clocks_per_pixel"]])).collect()
    };
    let (one, two) = (run("1"), run("2"));
    assert!(one.len() == 12 && one == two, "{one:?} and {two:?}");
}

#[test]
fn presets_set_the_card_and_flags_go_before_them() {
    let folder = Folder::new("preset");
    let report = folder.file("report.json");
    let card = |more: &[&str]| -> Value {
        let (out, plain) = (folder.file("a.png"), ["show", "gouraud", "--headless", "--size", "64x48", "--out"]);
        let all = [&plain[..], &[out.as_str(), "--report", report.as_str()], more].concat();
        let told = zga(&all);
        assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
        let value: Value = serde_json::from_slice(&std::fs::read(&report).expect("written")).expect("JSON");
        value["card"].clone()
    };
    let exact = card(&["--preset", "exact"]);
    assert_eq!((&exact["antialias"], &exact["subpixel_depth"]), (&"8x8".into(), &"exhaustive".into()));
    assert_eq!((&exact["depth_bits"], &exact["depth_fraction_bits"]), (&31.into(), &24.into()));
    let other = card(&["--preset", "standard", "--depth-bits", "16"]);
    assert_eq!((&other["antialias"], &other["depth_bits"]), (&"4x4".into(), &16.into()));
}
