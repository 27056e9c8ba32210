//! The hidden-surface paths as their users compare them: tables, JSON, maps, waveforms.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

/// A folder of its own for each test, removed when the test passes.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Folder {
        let folder = std::env::temp_dir().join(format!("zga-paths-{}-{test}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Folder(folder)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).expect("there")
    }

    /// Runs the program in the folder, without a display; it must end well.
    fn zga(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zga"));
        command.args(arguments).current_dir(&self.0).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        command.output().expect("the program runs")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

#[test]
fn paths_json_says_that_every_path_gives_one_picture() {
    let folder = Folder::new("json");
    let text = folder.zga(&["paths", "za", "--json", "-", "--frames", "1", "--variants"]);
    let report: Value = serde_json::from_str(&text).expect("JSON alone");
    assert_eq!((&report["schema"], &report["same"]), (&"zga.paths/1".into(), &true.into()));
    let runs = report["runs"].as_array().expect("a list");
    let hash = &runs[0]["frame_hash"];
    assert!(runs.iter().all(|run| run["frame_hash"] == *hash && run["host_ms"].as_f64() > Some(0.0)));
    let clocks = |path: &str, variant: Value| {
        let run = runs.iter().find(|run| run["path"] == path && run["variant"] == variant).expect("a run");
        run["cycles"]["total"].as_u64().expect("a number")
    };
    assert!(clocks("za", "no bypass".into()) > clocks("za", Value::Null));
    assert!(clocks("systolic", "Super Buffer".into()) > clocks("systolic", Value::Null));
    assert_eq!(report.get("maps"), None, "no picture, no maps");
}

#[test]
fn paths_picture_has_maps_that_add_up() {
    let folder = Folder::new("picture");
    let flags = ["--frames", "1", "--picture", "maps/a.png", "--json", "a.json", "--out", "one.png"];
    let text = folder.zga(&[&["paths", "tile", "--size", "72x40"], &flags[..]].concat());
    assert!(text.ends_with("a.json\n") && text.contains("maps/a.png\n"), "{text}");
    assert!(folder.read("maps/a.png").starts_with(b"\x89PNG") && folder.read("one.png").starts_with(b"\x89PNG"));
    let report: Value = serde_json::from_slice(&folder.read("a.json")).expect("JSON");
    let maps = report["maps"].as_array().expect("a list");
    let names: Vec<&str> = maps.iter().filter_map(|map| map["name"].as_str()).collect();
    assert_eq!(names, ["depths read", "initialised", "bypassed", "compared", "tokens", "links of the lists"]);
    assert!(maps.iter().all(|map| map["adds_up"] == true), "{maps:?}");
}

#[test]
fn show_view_paints_another_picture_and_keeps_the_hash_of_the_frame() {
    let folder = Folder::new("view");
    let plain = folder.zga(&["show", "za", "--out", "plain.png"]);
    for (view, demo) in [("za", "za"), ("tokens", "za"), ("tiles", "za")] {
        let text = folder.zga(&["show", demo, "--view", view, "--out", "plain.png"]);
        assert!(text.starts_with(&plain), "{view}: {text}");
        folder.zga(&["show", demo, "--view", view, "--out", &format!("{view}.png")]);
    }
    folder.zga(&["show", "za", "--out", "plain.png"]);
    let files = ["plain.png", "za.png", "tokens.png", "tiles.png"].map(|name| folder.read(name));
    for (index, file) in files.iter().enumerate() {
        assert!(files[..index].iter().all(|other| other != file));
    }
    let refused = folder.run(&["show", "za", "--view", "tiles", "--path", "za", "--out", "a.png"]);
    assert_eq!(refused.status.code(), Some(2));
    let reason = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(reason.contains("--view: tiles shows what the tile path knows"), "{reason}");
}

#[test]
fn show_view_of_samples_works_on_every_path_with_a_grid() {
    let folder = Folder::new("samples");
    let card = ["--antialias", "4x4", "--size", "96x64"];
    for path in ["zbuffer", "za", "systolic", "tile"] {
        let flags = [&["--hidden-surface", path][..], &card].concat();
        let plain = folder.zga(&[&["show", "za", "--out", "plain.png"], &flags[..]].concat());
        let drawn = folder.read("plain.png");
        let viewed = folder.zga(&[&["show", "za", "--view", "subpixel", "--out", "plain.png"], &flags[..]].concat());
        // The frame is the same; what is written is another picture, and its key below.
        assert!(viewed.starts_with(&plain), "{path}: {viewed}");
        assert!(viewed.contains("teal: edge") && viewed.contains("red: degraded"), "{path}: {viewed}");
        assert!(folder.read("plain.png") != drawn, "{path}");
    }
}

#[test]
fn paths_of_a_scene_with_a_grid_keep_their_fields_and_tell_the_pool() {
    let folder = Folder::new("pool");
    let report = |flags: &[&str]| -> Value {
        let all = [&["paths", "za", "--size", "64x48", "--frames", "1", "--json", "-"], flags].concat();
        serde_json::from_str(&folder.zga(&all)).expect("JSON")
    };
    for grid in ["off", "4x4"] {
        let report = report(&["--antialias", grid]);
        let runs = report["runs"].as_array().expect("a list");
        assert_eq!((runs.len(), &report["same"]), (7, &true.into()), "{grid}");
        for run in runs {
            let storage = &run["storage"];
            assert!(["on_chip_bits", "z_buffer_bytes", "sort_memory_bytes"].iter().all(|old| !storage[old].is_null()));
            assert_eq!(storage["subpixel_pool_bytes"], run["counters"]["subpixel.pool_peak_bytes"]);
            assert_eq!(run["card"]["antialias"], grid);
        }
    }
}

#[test]
fn waves_records_the_clocks_and_elements_asked_for() {
    let folder = Folder::new("waves");
    let flags = ["--line", "40", "--clocks", "3..23", "--pes", "2..5", "--out", "w/line.vcd"];
    let text = folder.zga(&[&["waves", "systolic"], &flags[..]].concat());
    assert!(text.starts_with("w/line.vcd: systolic, line 40, elements 2..5\n  20 clocks, "), "{text}");
    let vcd = String::from_utf8(folder.read("w/line.vcd")).expect("text");
    for module in ["pe[002]", "pe[003]", "pe[004]", "feeder", "bus"] {
        assert!(vcd.contains(&format!("$scope module {module} $end")), "no {module}");
    }
    assert!(!vcd.contains("pe[001]") && !vcd.contains("pe[005]"));
    let late = folder.run(&["waves", "systolic", "--clocks", "900000..900001", "--out", "late.vcd"]);
    assert_eq!(late.status.code(), Some(2));
    let reason = String::from_utf8_lossy(&late.stderr).into_owned();
    assert!(reason.contains("--clocks: 900000..900001 of line 48 holds nothing"), "{reason}");
    assert!(!folder.0.join("late.vcd").exists());
}
