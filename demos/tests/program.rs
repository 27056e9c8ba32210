//! The program as its users run it: pictures, goldens, reports, traces, exit codes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};

/// A folder of its own for each test, removed when the test passes.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Folder {
        let folder = std::env::temp_dir().join(format!("zga-program-{}-{test}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Folder(folder)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).expect("written");
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).expect("there")
    }

    /// Runs the program in the folder, without a display.
    fn zga(&self, arguments: &[&str]) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zga"));
        command.args(arguments).current_dir(&self.0).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        Run(command.output().expect("the program runs"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

struct Run(Output);

impl Run {
    fn code(&self) -> Option<i32> {
        self.0.status.code()
    }

    fn out(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn err(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }
}

/// A red triangle over a blue one, and a line on it.
const SCENE: &str = r#"{ "size": [64, 48], "background": [16, 16, 32, 255],
  "card": {"depth_bits": 16, "depth_fraction_bits": 8},
  "draw": [
    {"triangles": {"vertices": [[4,4,0.5],[60,24,0.5],[4,44,0.5]], "colours": [[0,0,255,255]], "tag": 7}},
    {"triangles": {"vertices": [[8,8,0.25],[50,24,0.25],[8,40,0.25]], "colours": [[255,0,0,255]]}},
    {"decal": {"draw": [{"lines": {"vertices": [[4.5,24.5,0.25],[40.5,24.5,0.25]], "colours": [[255,255,255,255]]}}]}}
  ]}"#;

#[test]
fn main_job_without_display_writes_pictures_and_tells_the_cost() {
    let folder = Folder::new("main");
    let run = folder.zga(&[]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    for name in ["teapot", "teapot-depth", "teapot-without-decals", "teapot-wireframe"] {
        let png = folder.read(&format!("zga-out/{name}.png"));
        assert!(png.starts_with(b"\x89PNG"), "{name}");
    }
    let out = run.out();
    for part in ["depth, gouraud, perspective, decal", "geometry.primitives", "z_buffer", "Host time"] {
        assert!(out.contains(part), "no {part:?} in {out}");
    }
}

#[test]
fn show_report_has_the_fields_and_counters_add_up() {
    let folder = Folder::new("report");
    folder.write("scene.json", SCENE);
    let flags = ["show", "scene.json", "--out", "deep/a.png", "--report", "a.json", "--depth", "d.png"];
    let run = folder.zga(&flags);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    let report: Value = serde_json::from_slice(&folder.read("a.json")).expect("JSON");
    assert_eq!(report["size"], serde_json::json!([64, 48]));
    assert_eq!((&report["hidden_surface"], &report["fidelity"]), (&"zbuffer".into(), &"functional".into()));
    assert!(report["frame_hash"].as_str().is_some_and(|hash| hash.starts_with("xxh3:") && hash.len() == 21));
    assert!(run.out().contains(report["frame_hash"].as_str().expect("text")));
    assert!(report["host_ms"].as_f64().is_some_and(|ms| ms > 0.0));
    assert_eq!(report["effects"]["called"], serde_json::json!(["depth", "decal"]));
    let powered = report["effects"]["powered"].as_array().expect("a list");
    assert!(powered.contains(&"geometry".into()) && !powered.contains(&"texture".into()));
    assert_eq!(report["counters"]["geometry.primitives"], 3);
    assert_eq!(report["counters"]["frontend.packets"].as_u64().map(|packets| packets > 5), Some(true));
    let cycles = report["cycles"].as_object().expect("an object");
    let sum: u64 = cycles.iter().filter(|(unit, _)| *unit != "total").filter_map(|(_, clocks)| clocks.as_u64()).sum();
    assert_eq!(cycles["total"].as_u64(), Some(sum));
    assert!(folder.read("deep/a.png").starts_with(b"\x89PNG") && folder.read("d.png").starts_with(b"\x89PNG"));
}

#[test]
fn show_hash_is_the_same_for_threads_kernels_and_sizes_of_files() {
    let folder = Folder::new("threads");
    let hash = |flags: &[&str]| {
        let run = folder.zga(&[&["show", "solids.json", "--out", "a.png"], flags].concat());
        assert_eq!(run.code(), Some(0), "{}", run.err());
        run.out()
    };
    folder.write("solids.json", SCENE);
    let first = hash(&["--threads", "1"]);
    assert_eq!(hash(&["--threads", "3"]), first);
    assert_eq!(hash(&["--kernel", "specification"]), first);
    assert_ne!(hash(&["--size", "65x48"]), first);
    assert_ne!(hash(&["--no-decals"]), first);
}

#[test]
fn show_frames_go_to_a_folder_with_numbers() {
    let folder = Folder::new("frames");
    let run = folder.zga(&["show", "gouraud", "--headless", "--out", "many", "--frames", "2", "--size", "80x60"]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    assert!(folder.read("many/gouraud-0000.png").starts_with(b"\x89PNG"));
    assert!(folder.read("many/gouraud-0001.png").starts_with(b"\x89PNG"));
}

/// A lit square in fog, half of it behind glass.
const EFFECTS: &str = r#"{ "size": [64, 48], "background": [16, 16, 32, 255],
  "camera": {"orthographic": {"eye": [0,0,4], "target": [0,0,0], "up": [0,1,0], "width": 4, "near": 1, "far": 9}},
  "lights": [{"type": "directional", "direction": [0,0,-1]}],
  "materials": {"wall": {"light": "pixel", "fog_function": "linear", "fog_end": 20}, "glass": {"light": "none", "blend": "alpha"}},
  "draw": [
    {"triangles": {"vertices": [[-1,-1,0],[1,-1,0],[1,1,0],[-1,1,0]], "indices": [0,1,2,0,2,3],
      "texture_coordinates": [[0,1],[1,1],[1,0],[0,0]], "colours": [[200,150,100,255]], "material": "wall"}},
    {"triangles": {"vertices": [[0,-1,1],[1,-1,1],[1,1,1]], "colours": [[0,0,255,100]], "material": "glass"}}
  ]}"#;

#[test]
fn effects_of_a_plain_scene_are_free_of_every_other_unit() {
    let folder = Folder::new("effects-plain");
    folder.write("scene.json", SCENE);
    let run = folder.zga(&["effects", "scene.json", "--json", "--report", "r.json", "--out", "deep/p.png"]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    let found: Value = serde_json::from_str(&run.out()).expect("JSON alone");
    assert_eq!(found["effects"]["called"], json!(["depth", "decal"]));
    assert_eq!(found["charged_without_power"], json!([]));
    for unit in ["texture", "shading", "layers", "subpixel", "za", "systolic", "tile", "probe"] {
        let unit = &found["units"][unit];
        assert_eq!((&unit["powered"], &unit["clocks"]), (&json!(false), &json!(0)), "{unit}");
        let all =
            ["events", "bytes"].map(|list| unit[list].as_object().expect("counts").values().all(|n| *n == json!(0)));
        assert_eq!(all, [true; 2], "{unit}");
    }
    assert_eq!(found["units"]["geometry"]["events"]["geometry.primitives"], 3);
    assert_eq!(found["units"]["z_buffer"]["bytes"]["z_buffer"], 4 * 64 * 48);
    let report: Value = serde_json::from_slice(&folder.read("r.json")).expect("JSON");
    assert_eq!((&report["effects"], &report["frame_hash"]), (&found["effects"], &found["frame_hash"]));
    assert!(folder.read("deep/p.png").starts_with(b"\x89PNG"));
}

#[test]
fn effects_of_a_scene_are_charged_to_their_units() {
    let folder = Folder::new("effects-lit");
    folder.write("scene.json", EFFECTS);
    for path in ["zbuffer", "za", "systolic", "tile"] {
        let run = folder.zga(&["effects", "scene.json", "--json", "--path", path]);
        assert_eq!((run.code(), run.err()), (Some(0), String::new()), "{path}");
        let found: Value = serde_json::from_str(&run.out()).expect("JSON");
        assert_eq!(found["effects"]["called"], json!(["depth", "light", "fog", "blend"]), "{path}");
        let count = |unit: &str, name: &str| found["units"][unit]["events"][name].as_u64().unwrap_or(0);
        // The wall is 32 x 32 pixels, each with one light and fog; the glass is half of 16 x 32 of them.
        assert_eq!(count("shading", "shading.lights"), 32 * 32, "{path}");
        assert_eq!(count("shading", "shading.fogged"), 32 * 32, "{path}");
        assert!((200..=280).contains(&count("layers", "layers.blended")), "{path}");
        assert_eq!(found["units"]["texture"]["powered"], false);
    }
    let table = folder.zga(&["effects", "scene.json", "--antialias", "8x8"]);
    assert_eq!(table.code(), Some(0), "{}", table.err());
    assert!(table.out().contains("depth, light, fog, blend, anti_alias") && table.out().contains("What is not called"));
}

#[test]
fn effects_what_if_prices_what_is_called_and_what_is_not() {
    let folder = Folder::new("effects-what-if");
    folder.write("scene.json", EFFECTS);
    let run = folder.zga(&["effects", "scene.json", "--what-if", "--pairs", "3", "--json", "--threads", "1"]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    let found: Value = serde_json::from_str(&run.out()).expect("JSON");
    let prices = found["what_if"].as_array().expect("a list");
    let names: Vec<&str> = prices.iter().filter_map(|price| price["change"].as_str()).collect();
    let expected = [
        "without depth",
        "without light",
        "without fog",
        "without blend",
        "with texture: a checker",
        "with punch_through: a checker with holes",
        "with light at each vertex",
        "with anti_alias 4x4",
        "with anti_alias 8x8",
    ];
    assert_eq!(names, expected);
    let clocks = |name: &str| {
        let price = prices.iter().find(|price| price["change"] == name).expect("there");
        (price["pairs"].as_u64(), price["clocks"]["difference"].as_f64().expect("a number"))
    };
    // A clock a fogged pixel; 4 a light and 1 a pixel; a texel a pixel of the wall.
    assert_eq!(clocks("without fog"), (Some(3), -1024.0));
    assert!(clocks("without light").1 <= -5.0 * 1024.0);
    assert!(clocks("with texture: a checker").1 >= 1024.0);
    assert!(clocks("with anti_alias 8x8").1 > 0.0);
    assert!(prices.iter().all(|price| price["note"] == Value::Null && price["host_ms"]["ratio"].as_f64() > Some(0.0)));
}

#[test]
fn show_environment_lights_a_mesh_and_nothing_else() {
    let folder = Folder::new("environment");
    folder.write("one.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    let show = |environment: &str| {
        let flags = ["show", "one.obj", "--size", "64x48", "--out", "a.png", "--report", "r.json"];
        let run = folder.zga(&[&flags[..], &["--environment", environment]].concat());
        assert_eq!(run.code(), Some(0), "{}", run.err());
        let report: Value = serde_json::from_slice(&folder.read("r.json")).expect("JSON");
        (report["frame_hash"].clone(), report["effects"]["called"].clone())
    };
    let all = ["plain", "studio", "sun", "night", "fog"].map(show);
    assert_eq!(all[0].1, json!(["depth"]));
    assert_eq!(all[1].1, json!(["depth", "perspective", "light"]));
    assert_eq!(all[4].1, json!(["depth", "gouraud", "perspective", "light", "fog"]));
    for (number, (hash, _)) in all.iter().enumerate() {
        assert!(all[..number].iter().all(|(other, _)| other != hash), "{number}");
    }
    let refused = folder.zga(&["show", "teapot", "--environment", "sun", "--headless"]);
    assert_eq!(refused.code(), Some(2));
    assert!(refused.err().contains("--environment: teapot is no mesh"), "{}", refused.err());
}

#[test]
fn capture_equal_different_and_missing_goldens() {
    let folder = Folder::new("capture");
    folder.write("scene.json", SCENE);
    let capture = |flags: &[&str]| folder.zga(&[&["capture", "scene.json", "--golden", "g"], flags].concat());
    let missing = capture(&[]);
    assert_eq!(missing.code(), Some(2));
    assert!(missing.err().contains("--update writes it"), "{}", missing.err());
    assert_eq!(capture(&["--update"]).code(), Some(0));
    let equal = capture(&[]);
    assert_eq!((equal.code(), equal.out().trim_end().ends_with("equal")), (Some(0), true));

    folder.write("scene.json", &SCENE.replace("[0,0,255,255]", "[0,1,255,255]"));
    let different = capture(&[]);
    assert_eq!(different.code(), Some(1));
    // The blue triangle's first pixel: row 4, where its left edge begins.
    assert!(different.out().contains("the first at (4, 4): #0000ff expected, #0001ff found"), "{}", different.out());
    assert!(folder.read("g/scene.difference.png").starts_with(b"\x89PNG"));
    assert_eq!(capture(&["--size", "32x48"]).code(), Some(1));
    std::fs::write(folder.0.join("g/scene.png"), "no picture").expect("written");
    let damaged = capture(&[]);
    assert_eq!(damaged.code(), Some(2));
    assert!(damaged.err().contains("scene.png: is not a picture"), "{}", damaged.err());
}

#[test]
fn pixel_tells_every_fragment_with_its_verdict() {
    let folder = Folder::new("pixel");
    folder.write("scene.json", SCENE);
    let run = folder.zga(&["pixel", "scene.json", "20", "24"]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    let lines: Vec<String> =
        run.out().lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    // Depths of 16 bits: 0.5 is 32768 and 0.25 is 16384; a decal of slope 8 on 64 pixels moves by 8 / 128 = 1/16.
    let expected = [
        "0 (clear) clear 65535 0 written #101020",
        "1 draw[0] 7 0 triangle 32768 less 65535 drawn #0000ff",
        "2 draw[1] 8 0 triangle 16384 less 32768 drawn #ff0000",
        "3 draw[2].decal.draw[0] 9 0 line 12288 less 16384 drawn #ffffff",
    ];
    assert_eq!(lines[3..7], expected);
    assert_eq!(lines[8], "Shown #ffffff, depth 12288 of 65535");
    assert_eq!(folder.zga(&["pixel", "scene.json", "64", "24"]).code(), Some(2));
}

#[test]
fn trace_replays_equal_and_damage_is_told() {
    let folder = Folder::new("trace");
    folder.write("scene.json", SCENE);
    let record = folder.zga(&["trace", "record", "t.zga", "scene.json"]);
    assert_eq!(record.code(), Some(0), "{}", record.err());
    let replay = folder.zga(&["trace", "replay", "t.zga", "--threads", "1"]);
    assert_eq!(replay.code(), Some(0), "{}", replay.err());
    let hash = record.out().split_whitespace().find(|word| word.starts_with("xxh3:")).expect("a hash").to_owned();
    assert!(replay.out().contains(&format!("64 x 48  {hash}  equal")), "{}", replay.out());
    let info = folder.zga(&["trace", "info", "t.zga"]);
    assert!(info.out().contains(&hash), "{}", info.out());

    let whole = folder.read("t.zga");
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    for (bytes, reason) in
        [(&flipped[..], "damaged"), (&whole[..whole.len() - 1], "cut short"), (b"x", "not a ZGA trace")]
    {
        std::fs::write(folder.0.join("bad.zga"), bytes).expect("written");
        for command in ["replay", "info"] {
            let run = folder.zga(&["trace", command, "bad.zga"]);
            assert_eq!(run.code(), Some(2));
            assert!(run.err().contains("bad.zga: ") && run.err().contains(reason), "{}", run.err());
        }
    }
}

#[test]
fn bench_prints_the_line_of_the_harness() {
    let folder = Folder::new("bench");
    let run =
        folder.zga(&["bench", "--scene", "3", "--size", "64x64", "--secs", "0", "--peer", "zga-1", "--dump", "d"]);
    assert_eq!(run.code(), Some(0), "{}", run.err());
    let out = run.out();
    let fields: Vec<&str> = out.trim_end().split(',').collect();
    assert_eq!((fields.len(), &fields[..4], fields[10]), (11, &["zga-1", "S3", "64x64", "1"][..], "128"));
    assert!(fields[4..10].iter().all(|field| field.parse::<f64>().is_ok_and(|number| number > 0.0)), "{out}");
    let dump = folder.read("d");
    assert_eq!((&dump[..11], dump.len()), (&b"RGBA 64 64\n"[..], 11 + 4 * 64 * 64));
}

#[test]
fn every_path_makes_the_same_picture_and_depths_and_reports_its_own_cost() {
    let folder = Folder::new("paths");
    folder.write("scene.json", SCENE);
    let draw = |path: &str, flags: &[&str]| {
        let common = ["show", "scene.json", "--hidden-surface", path, "--out", "a.png", "--report", "a.json"];
        let run = folder.zga(&[&common[..], flags].concat());
        assert_eq!(run.code(), Some(0), "{path} {flags:?}: {}", run.err());
        let report: Value = serde_json::from_slice(&folder.read("a.json")).expect("JSON");
        assert_eq!(report["hidden_surface"], path);
        report
    };
    let depth = |path: &str| {
        let run = folder.zga(&["show", "scene.json", "--hidden-surface", path, "--depth", "d.png"]);
        assert_eq!(run.code(), Some(0), "{path}: {}", run.err());
        folder.read("d.png")
    };
    let (plain, plain_depth) = (draw("zbuffer", &[]), depth("zbuffer"));
    for (path, counter, flags) in [
        ("za", "za.words_written", &["--za-block", "8x8", "--za-prediction", "plane"][..]),
        ("systolic", "systolic.tokens", &["--systolic-variant", "zero,merged,value"]),
        ("tile", "tile.visited", &["--tile-size", "16x8"]),
    ] {
        let functional = draw(path, flags);
        assert_eq!(functional["frame_hash"], plain["frame_hash"], "{path}");
        assert!(functional["counters"][counter].as_u64() > Some(0), "{path}: {functional:#}");
        assert!(functional["cycles"][path].as_u64() > Some(0), "{path}: {functional:#}");
        assert_eq!((&plain["counters"][counter], &plain["cycles"][path]), (&0.into(), &0.into()));
        let powered = functional["effects"]["powered"].as_array().expect("a list");
        assert!(powered.contains(&path.into()) && !powered.contains(&"z_buffer".into()), "{path}: {powered:?}");
        let clocked = draw(path, &[flags, &["--fidelity", "clocked"]].concat());
        let same = ["frame_hash", "cycles", "counters", "card"].map(|field| functional[field] == clocked[field]);
        assert_eq!(same, [true; 4], "{path}: {functional:#}\n{clocked:#}");
        assert_eq!(depth(path), plain_depth, "{path}");
    }
}

#[test]
fn pixel_and_trace_work_on_every_path() {
    let folder = Folder::new("path-pixel");
    folder.write("scene.json", SCENE);
    for path in ["za", "systolic", "tile"] {
        let card = ["--hidden-surface", path];
        let run = folder.zga(&[&["pixel", "scene.json", "20", "24"][..], &card].concat());
        assert_eq!(run.code(), Some(0), "{path}: {}", run.err());
        assert!(run.out().ends_with("Shown #ffffff, depth 12288 of 65535\n"), "{path}: {}", run.out());
        let record = folder.zga(&[&["trace", "record", "t.zga", "scene.json", "--frames", "2"][..], &card].concat());
        assert_eq!(record.code(), Some(0), "{path}: {}", record.err());
        let replay = folder.zga(&["trace", "replay", "t.zga"]);
        assert_eq!(replay.code(), Some(0), "{path}: {} {}", replay.out(), replay.err());
    }
}

#[test]
fn bench_takes_path_fidelity_and_depth_bits() {
    let folder = Folder::new("bench-paths");
    let dump = |flags: &[&str]| {
        let run = folder.zga(&[&["bench", "S3", "--size", "64x64", "--secs", "0", "--dump", "d"], flags].concat());
        assert_eq!(run.code(), Some(0), "{flags:?}: {}", run.err());
        folder.read("d")
    };
    let plain = dump(&[]);
    for path in ["za", "systolic", "tile"] {
        assert!(dump(&["--path", path]) == plain, "{path}");
        assert!(dump(&["--path", path, "--fidelity", "clocked", "--depth-bits", "16"]) == plain, "{path}, clocked");
    }
}

#[test]
fn antialias_of_flags_goes_before_the_scene_and_stands_in_the_report() {
    let folder = Folder::new("antialias");
    let card = r#""depth_bits": 16, "antialias": "4x4", "subpixel_depth": "exhaustive", "subpixel_pool": 4096"#;
    folder.write("scene.json", &SCENE.replace("\"depth_bits\": 16", card));
    let draw = |flags: &[&str]| -> Value {
        let run = folder.zga(&[&["show", "scene.json", "--out", "a.png", "--report", "a.json"], flags].concat());
        assert_eq!(run.code(), Some(0), "{flags:?}: {}", run.err());
        serde_json::from_slice(&folder.read("a.json")).expect("JSON")
    };
    let called = |report: &Value, what: &str, name: &str| {
        report["effects"][what].as_array().expect("a list").contains(&name.into())
    };
    let scene = draw(&[]);
    let set = |report: &Value| {
        let fields = ["antialias", "subpixel_depth", "antialias_resolve", "subpixel_pool", "antialias_edges"];
        Value::from(fields.map(|field| report["card"][field].clone()).to_vec())
    };
    assert_eq!(set(&scene), json!(["4x4", "exhaustive", "values", 4096, "all"]));
    assert!(called(&scene, "called", "anti_alias") && called(&scene, "powered", "subpixel"));
    let flags = draw(&[
        "--antialias",
        "8x8",
        "--subpixel-depth",
        "centre",
        "--antialias-resolve",
        "linear",
        "--antialias-edges",
        "borders",
    ]);
    assert_eq!(set(&flags), json!(["8x8", "centre", "linear", 4096, "borders"]));
    let off = draw(&["--antialias", "off"]);
    assert_eq!((&off["card"]["antialias"], off["card"].get("subpixel_depth")), (&"off".into(), None));
    assert!(!called(&off, "called", "anti_alias") && !called(&off, "powered", "subpixel"));
}

#[test]
fn translucency_is_drawn_with_and_without_antialias() {
    let folder = Folder::new("translucent");
    let glass = SCENE
        .replace("\"draw\": [\n", "\"materials\": {\"glass\": {\"blend\": \"alpha\"}}, \"draw\": [\n")
        .replace("[[255,0,0,255]]", "[[255,0,0,128]], \"material\": \"glass\"");
    folder.write("glass.json", &glass);
    let called = [("a.json", "off"), ("b.json", "4x4")].map(|(file, grid)| {
        let run = folder.zga(&["show", "glass.json", "--antialias", grid, "--report", file]);
        assert_eq!((run.code(), run.err()), (Some(0), String::new()), "{grid}");
        let report: Value = serde_json::from_slice(&folder.read(file)).expect("JSON");
        let blends = report["effects"]["called"].as_array().expect("a list").contains(&"blend".into());
        (blends, report["counters"]["layers.blended"].as_u64() > Some(100))
    });
    // Without samples layers are the layer unit's, with them the sub-pixel unit's.
    assert_eq!(called, [(true, true), (true, false)]);
}

#[test]
fn demos_of_anti_aliasing_are_smooth_at_once_and_flags_go_first() {
    let folder = Folder::new("smooth-demos");
    for demo in ["zone-plate", "spokes", "fine-mesh", "teapot-smooth", "crossing", "layers"] {
        let draw = |flags: &[&str]| -> (Value, String) {
            let all = [&["show", demo, "--size", "200x150", "--report", "a.json"], flags].concat();
            let run = folder.zga(&all);
            assert_eq!(run.code(), Some(0), "{demo}: {}", run.err());
            (serde_json::from_slice(&folder.read("a.json")).expect("JSON"), run.err())
        };
        let (smooth, told) = draw(&[]);
        let grid = if demo == "layers" { "4x4" } else { "8x8" };
        assert_eq!((&smooth["card"]["antialias"], told.as_str()), (&grid.into(), ""), "{demo}");
        let called = smooth["effects"]["called"].as_array().expect("a list");
        assert!(called.contains(&"anti_alias".into()), "{demo}");
        assert_eq!(called.contains(&"blend".into()), demo == "layers");
        let (plain, told) = draw(&["--antialias", "off"]);
        assert_eq!(plain["card"]["antialias"], "off");
        let called = plain["effects"]["called"].as_array().expect("a list");
        assert!(!called.contains(&"anti_alias".into()) && told.is_empty(), "{told}");
        assert_eq!(called.contains(&"blend".into()), demo == "layers");
    }
}

#[test]
fn bench_smooth_scene_tells_its_samples() {
    let folder = Folder::new("bench-smooth");
    let line = |flags: &[&str]| {
        let run = folder.zga(&[&["bench", "S10", "--size", "64x64", "--secs", "0", "--peer", "zga-1"], flags].concat());
        assert_eq!(run.code(), Some(0), "{flags:?}: {}", run.err());
        run.out().split(',').take(4).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(line(&[]), ["zga-1", "S10", "64x64", "64"]);
    assert_eq!(line(&["--antialias", "8x4"])[3], "32");
    assert_eq!(line(&["--antialias", "off"])[3], "1");
}

#[test]
fn bad_scenes_name_file_and_field() {
    let folder = Folder::new("bad");
    let fault = |name: &str, text: &str| {
        folder.write(name, text);
        let run = folder.zga(&["show", name, "--out", "a.png"]);
        assert_eq!(run.code(), Some(2), "{name}");
        assert!(!Path::new(&folder.0.join("a.png")).exists());
        run.err()
    };
    assert!(fault("a.json", "{").contains("a.json:1:"));
    let value = fault("b.json", &SCENE.replace("[16, 16, 32, 255]", "[16, 16, 32, 256]"));
    assert!(value.contains("b.json: background[3]: expected"), "{value}");
    let field = fault("c.json", &SCENE.replace("\"depth_bits\": 16", "\"subpixel_pool\": 0"));
    assert!(field.contains("c.json: card.subpixel_pool: expected a whole number in 1..=1048576"), "{field}");
    let mesh = fault("d.obj", "v 0 0 0\nf 1 2 3\n");
    assert!(mesh.contains("d.obj: line 2"), "{mesh}");
}
