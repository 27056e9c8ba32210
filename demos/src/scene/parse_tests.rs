//! What the scene parser accepts, and where it says a fault lies.

use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::error::{Error, Result};

/// The example of the format's description, with everything in it.
const FULL: &str = r#"{ "size": [640, 480], "background": [16, 16, 32, 255],
  "camera": {"screen": {}},
  "card": {"hidden_surface": "zbuffer", "fidelity": "functional", "antialias": "8x4", "subpixel_depth": "search",
           "antialias_resolve": "linear", "subpixel_pool": 65536, "antialias_edges": "all",
           "za_block": [32, 1], "za_prediction": "block-length", "za_bypass": false, "tile_size": [8, 64],
           "systolic_variant": {"end_test": "zero", "ports": "merged", "colour": "value", "super_buffer": true},
           "depth_bits": 24, "depth_fraction_bits": 24},
  "ambient": [30,31,32,255],
  "lights": [{"type": "spot", "position": [0,1,2], "direction": [0,-1,0], "attenuation_cut_off": 9.5,
              "spot_exponent": 4, "colour": [255,240,200,255], "ambient": [8,8,8,255]}],
  "materials": {"plain": {}, "glass": {"blend": "alpha", "shininess": 32, "specular": [255,255,255,255],
     "emission": [0,0,0,255], "punch_through": 128, "fog_function": "linear", "fog_density": 0.5, "fog_end": 9,
     "fog_colour": [1,2,3,255], "depth_cue_scale": 0.1, "depth_cue_offset": 1.5, "light": "pixel", "two_sided": true,
     "texture": {"file": "brick.png", "filter": "trilinear", "offset": [1,2],
     "size": [64,32], "repeat": [true,false], "mirror": [false,true], "palette": [[1,2,3,4]], "format": "palette8",
     "function": "blend", "colour": [7,8,9,10], "bias": -1.5, "mip_map": false}}},
  "draw": [
    {"triangles": {"vertices": [[10,10,0.5],[90,12,0.5],[40,80,0.2]], "colours": [[255,0,0,255]], "material": "plain", "tag": 1}},
    {"lines": {"vertices": [[0,0,0.1],[99,40,0.1]], "colours": [[255,255,255,255]], "width": 2.5, "material": "glass"}},
    {"points": {"vertices": [[5,5,0]], "indices": [0,0,0], "size": 8}},
    {"curve": {"cubic": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], "tolerance": 0.5, "width": 0.5}},
    {"decal": {"slope": 8.0, "draw": [ {"lines": {"vertices": [[1,1,0.5],[2,2,0.5]], "colours": [[0,0,0,255]]}} ]}},
    {"mesh": {"file": "spot.obj", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "material": "plain",
              "edges": true, "slope": 4}} ] }"#;

pub(super) fn parse(text: &str) -> Result<Scene> {
    Scene::from_json(text.as_bytes(), Path::new("folder/scene.json"))
}

/// Path, expected and found of the fault.
pub(super) fn fault(text: &str) -> [String; 3] {
    match parse(text) {
        Err(Error::Field { path, expected, found, .. }) => [path, expected, found],
        other => panic!("a fault of a field, not {other:?}"),
    }
}

/// The fault of a scene with this draw list.
fn draw_fault(draw: &str) -> [String; 3] {
    fault(&format!(r#"{{"size": [8, 8], "draw": [{draw}]}}"#))
}

#[test]
fn parse_full_example_keeps_every_field() {
    let scene = parse(FULL).expect("the example is valid");
    assert_eq!(scene.size, [640, 480]);
    assert_eq!(scene.card.hidden_surface, Some(HiddenSurface::ZBuffer));
    assert_eq!(scene.card.za_block, Some([32, 1]));
    assert_eq!((scene.card.za_bypass, scene.card.tile_size), (Some(false), Some([8, 64])));
    let variant = SystolicSettings {
        end_test: Some(EndTest::Zero),
        ports: Some(TokenPorts::Merged),
        colour: Some(TokenColour::Value),
        super_buffer: Some(true),
    };
    assert_eq!(scene.card.systolic_variant, variant);
    assert_eq!(scene.card.depth_bits, Some(24));
    let antialias = (scene.card.antialias, scene.card.subpixel_depth);
    assert_eq!(antialias, (Some(SubpixelGrid::Grid8x4), Some(SubpixelDepth::Search)));
    let resolve = (scene.card.antialias_resolve, scene.card.subpixel_pool);
    assert_eq!(resolve, (Some(SubpixelResolve::Linear), Some(65536)));
    assert_eq!(scene.card.antialias_edges, Some(SubpixelEdges::All));
    let drawn: Vec<(f32, bool)> = scene.batches().iter().map(|batch| (batch.extent, batch.translucent)).collect();
    assert_eq!(drawn, [(1.0, false), (2.5, true), (8.0, false), (0.5, false), (1.0, false)]);
    assert_eq!(scene.lights[0].kind, LightType::Spot);
    assert_eq!(scene.ambient, [30, 31, 32, 255]);
    let glass = &scene.materials["glass"];
    assert_eq!((glass.light, glass.two_sided), (Some(Lighting::Pixel), true));
    assert_eq!((glass.depth_cue_scale, glass.depth_cue_offset), (0.1, 1.5));
    let texture = Texture {
        file: "brick.png".to_owned(),
        image: None,
        format: TextureFormat::Palette8,
        function: TextureFunction::Blend,
        colour: [7, 8, 9, 10],
        filter: TextureFilter::Trilinear,
        mip_map: false,
        bias: -1.5,
        offset: [1, 2],
        size: Some([64, 32]),
        repeat: [true, false],
        mirror: [false, true],
        palette: Some(vec![[1, 2, 3, 4]]),
    };
    assert_eq!(glass.texture, Some(texture));
    assert_eq!(scene.draw.len(), 6);
    let Draw::Triangles(triangles) = &scene.draw[0] else { panic!("triangles first") };
    assert_eq!((triangles.tag, triangles.material.as_deref()), (Some(1), Some("plain")));
    assert_eq!(triangles.colours, Colours::One([255, 0, 0, 255]));
    let Draw::Mesh(mesh) = &scene.draw[5] else { panic!("a mesh last") };
    assert!(mesh.edges && mesh.slope == 4.0 && mesh.transform == IDENTITY);
}

#[test]
fn parse_smallest_scene_has_defaults() {
    let scene = parse(r#"{"size": [1, 16384], "draw": []}"#).expect("valid");
    assert_eq!(scene, Scene::new([1, 16384], [0, 0, 0, 255]));
}

#[test]
fn parse_bad_syntax_names_line_and_column() {
    let error = parse("{\"size\": [1, 1],\n \"draw\": [,]}").expect_err("not JSON");
    assert!(matches!(error, Error::Syntax { line: 2, column: 11, .. }), "{error:?}");
    assert!(error.to_string().starts_with("folder/scene.json:2:11: "), "{error}");
    let cut = parse("{\"size\": [1, 1").expect_err("not JSON").to_string();
    assert!(cut.contains("EOF"), "{cut}");
    let twice = parse("{\"size\": [1,1], \"draw\": [],\n\"draw\": []}").expect_err("a field twice");
    assert!(twice.to_string().contains("\"draw\" is there twice"), "{twice}");
    assert!(parse("{\"size\": [1,1], \"draw\": []} 1").is_err());
    assert!(parse(&"[".repeat(100_000)).is_err());
    assert!(parse("{\"size\": [1e999, 1], \"draw\": []}").is_err());
    assert!(parse("{\"size\": [NaN, 1], \"draw\": []}").is_err());
}

#[test]
fn parse_unknown_fields_name_their_path() {
    let unknown = |text: &str| {
        let [path, expected, found] = fault(text);
        assert_eq!(found, "an unknown field");
        assert!(expected.contains("field"), "{expected}");
        path
    };
    assert_eq!(unknown(r#"{"size": [1,1], "draw": [], "sise": 3}"#), "sise");
    assert_eq!(unknown(r#"{"size": [1,1], "draw": [], "card": {"depth": 3}}"#), "card.depth");
    assert_eq!(unknown(r#"{"size": [1,1], "draw": [], "camera": {"screen": {"eye": 1}}}"#), "camera.screen.eye");
    assert_eq!(unknown(r#"{"size": [1,1], "draw": [{"lines": {"vertex": []}}]}"#), "draw[0].lines.vertex");
    assert_eq!(unknown(r#"{"size": [1,1], "draw": [{"quads": {}}]}"#), "draw[0].quads");
    assert_eq!(
        unknown(r#"{"size": [1,1], "draw": [], "materials": {"a b": {"shine": 1}}}"#),
        "materials[\"a b\"].shine"
    );
}

#[test]
fn parse_wrong_values_name_path_expected_and_found() {
    let cases: [(&str, &str, &str, &str); 17] = [
        (r#"{"draw": []}"#, "size", "this field", "nothing"),
        (r#"[]"#, "the document", "an object", "a list of 0"),
        (r#"{"size": [0, 1], "draw": []}"#, "size[0]", "a whole number in 1..=16384", "0"),
        (r#"{"size": [1, 2.5], "draw": []}"#, "size[1]", "a whole number in 1..=16384", "2.5"),
        (r#"{"size": [1], "draw": []}"#, "size", "a list of 2 whole numbers", "a list of 1"),
        (r#"{"size": [1,1], "draw": 3}"#, "draw", "a list of at least 0 draws", "3"),
        (
            r#"{"size": [1,1], "draw": [], "background": [0,0,256,0]}"#,
            "background[2]",
            "a whole number in 0..=255",
            "256",
        ),
        (r#"{"size": [1,1], "draw": [], "card": {"depth_bits": 20}}"#, "card.depth_bits", "one of 16, 24, 31", "20"),
        (
            r#"{"size": [1,1], "draw": [], "card": {"za_block": [8, 16385]}}"#,
            "card.za_block[1]",
            "a whole number in 1..=16384",
            "16385",
        ),
        (
            r#"{"size": [1,1], "draw": [], "card": {"tile_size": [12, 8]}}"#,
            "card.tile_size[0]",
            "one of 4, 8, 16, 32, 64",
            "12",
        ),
        (
            r#"{"size": [1,1], "draw": [], "card": {"systolic_variant": {"ports": "both"}}}"#,
            "card.systolic_variant.ports",
            "one of \"swapped\", \"merged\"",
            "\"both\"",
        ),
        (
            r#"{"size": [1,1], "draw": [], "card": {"fidelity": "exact"}}"#,
            "card.fidelity",
            "one of \"functional\", \"clocked\"",
            "\"exact\"",
        ),
        (
            r#"{"size": [1,1], "draw": [], "camera": {"perspective": {"eye": [0,0,1], "target": [0,0,0], "up": [0,1,0], "fov_x_degrees": 60, "near": 2, "far": 1}}}"#,
            "camera.perspective.far",
            "a distance above near (2)",
            "1",
        ),
        (
            r#"{"size": [1,1], "draw": [], "camera": {"orthographic": {"eye": [0,0,1], "target": [0,0,0], "up": [0,0,3], "width": 2, "near": 0, "far": 1}}}"#,
            "camera.orthographic.up",
            "a direction that is not along the line of sight",
            "[0.0, 0.0, 3.0]",
        ),
        (
            r#"{"size": [1,1], "draw": [], "lights": [{"type": "point"}]}"#,
            "lights[0].position",
            "this field",
            "nothing",
        ),
        (
            r#"{"size": [1,1], "draw": [], "camera": {}}"#,
            "camera",
            "an object with exactly one of screen, orthographic, perspective",
            "an empty object",
        ),
        (
            r#"{"size": [1,1], "draw": [], "materials": {"m": {"fog_density": -1}}}"#,
            "materials.m.fog_density",
            "a number in 0..=340282350000000000000000000000000000000",
            "-1",
        ),
    ];
    for (text, path, expected, found) in cases {
        assert_eq!(fault(text), [path, expected, found], "{text}");
    }
}

#[test]
fn parse_wrong_draws_name_path_and_reason() {
    let vertices = "[1,1,0],[2,2,0],[1,2,0]";
    let with = |rest: &str| draw_fault(&format!(r#"{{"triangles": {{"vertices": [{vertices}], {rest}}}}}"#));
    let [path, expected, _] = with(r#""indices": [0, 1, 3]"#);
    assert_eq!((&*path, &*expected), ("draw[0].triangles.indices[2]", "the index of a vertex, 0..=2"));
    assert_eq!(with(r#""indices": [0, 1]"#)[0], "draw[0].triangles.indices");
    assert_eq!(with(r#""colours": [[0,0,0,0],[0,0,0,0]]"#)[1], "1 colour for all, or 3, one for each vertex");
    assert_eq!(
        with(r#""colours": [[0,0,0,0],[0,0,0,0]], "per": "face""#)[1],
        "1 colour for all, or 1, one for each triangle"
    );
    assert_eq!(with(r#""colours": [[0,0,0]]"#)[0], "draw[0].triangles.colours[0]");
    assert_eq!(with(r#""normals": [[0,0,1]]"#)[1], "3 normals, one for each vertex");
    assert_eq!(with(r#""material": "gold""#)[0], "draw[0].triangles.material");
    assert_eq!(with(r#""tag": -1"#)[0], "draw[0].triangles.tag");
    assert_eq!(with(r#""width": 2"#)[0], "draw[0].triangles.width");
    assert_eq!(draw_fault(r#"{"points": {"vertices": [[0,0,0]], "size": 256}}"#)[0], "draw[0].points.size");
    assert_eq!(draw_fault(r#"{"lines": {"vertices": [], "width": 0}}"#)[0], "draw[0].lines.width");

    let [path, _, found] = draw_fault(r#"{"lines": {"vertices": [[0,0,0],[1,1,1.5]]}}"#);
    assert_eq!((&*path, &*found), ("draw[0].lines.vertices[1][2]", "1.5"));
    let [path, expected, _] = draw_fault(r#"{"lines": {"vertices": [[0,0,0],[1e39,1,1]]}}"#);
    assert_eq!((&*path, &*expected), ("draw[0].lines.vertices[1][0]", "a finite number"));
    assert_eq!(draw_fault(r#"{"lines": {"vertices": [[0,0,0]]}}"#)[0], "draw[0].lines.vertices");
    assert_eq!(draw_fault(r#"{"lines": {"vertices": [], "per": "face"}}"#)[0], "draw[0].lines.per");
    assert_eq!(draw_fault(r#"{"curve": {"cubic": [[0,0,0]]}}"#)[1], "4 control points for each segment");
    assert_eq!(draw_fault(r#"{"curve": {"colours": [[0,0,0,0]]}}"#)[0], "draw[0].curve");
    assert_eq!(draw_fault(r#"{"mesh": {"file": "a.stl"}}"#)[0], "draw[0].mesh.file");
    assert_eq!(draw_fault(r#"{"mesh": {"file": "a.obj", "transform": [1]}}"#)[1], "a list of 16 numbers");
    assert_eq!(draw_fault(r#"{"points": {"vertices": []}, "lines": {"vertices": []}}"#)[2], "2 fields");
    assert_eq!(draw_fault(r#"{"decal": {"draw": [{"decal": {"draw": []}}]}}"#)[0], "draw[0].decal.draw[0].decal");
}

#[test]
fn parse_decal_with_surfaces_is_fitted_to_them_and_takes_no_mesh() {
    let with = |surfaces: &str, draw: &str| format!(r#"{{"decal": {{"surfaces": {surfaces}, "draw": [{draw}]}}}}"#);
    let line = r#"{"lines": {"vertices": [[1,1,0.5],[2,2,0.5]]}}"#;
    let plane = "[[[0,0,0.25],[9,0,0.5],[0,9,0.75]]]";
    let scene = parse(&format!(r#"{{"size": [9,9], "draw": [{}, {line}]}}"#, with(plane, line))).expect("valid");
    let [fitted, plain] = &scene.batches()[..] else { panic!("two batches") };
    assert_eq!(*fitted.surfaces, [[[0.0, 0.0, 0.25], [9.0, 0.0, 0.5], [0.0, 9.0, 0.75]]]);
    assert_eq!((fitted.slope, plain.slope, plain.surfaces.len()), (Some(8.0), None, 0));

    assert_eq!(draw_fault(&with("[]", line))[0], "draw[0].decal.surfaces");
    assert_eq!(draw_fault(&with("[[[0,0,0],[1,1,1]]]", line))[0], "draw[0].decal.surfaces[0]");
    assert_eq!(draw_fault(&with("[[[0,0,0],[1,1,1],[3,3,3]]]", line))[2], "corners on a line");
    let [path, expected, _] = draw_fault(&with(plane, r#"{"mesh": {"file": "a.obj"}}"#));
    assert_eq!(path, "draw[0].decal.draw[0].mesh");
    assert!(expected.contains("no mesh"), "{expected}");
    let negative = r#"{"decal": {"slope": -1, "surfaces": [[[0,0,0],[1,0,0],[0,1,0]]], "draw": []}}"#;
    assert_eq!(draw_fault(negative)[0], "draw[0].decal.slope");
}

#[test]
fn load_missing_mesh_names_field_and_file() {
    let mut scene = parse(r#"{"size": [1,1], "draw": [{"mesh": {"file": "none.obj"}}]}"#).expect("valid");
    let error = scene.load_meshes(Path::new("nowhere"), Path::new("s.json")).expect_err("no such file");
    let text = error.to_string();
    assert!(text.starts_with("s.json: draw[0].mesh.file: ") && text.contains("nowhere/none.obj"), "{text}");
}

#[test]
fn batches_join_decals_faces_and_curves() {
    let scene = parse(
        r#"{"size": [64,64], "draw": [
        {"triangles": {"vertices": [[0,0,0],[9,0,0],[9,9,0],[0,9,0]], "indices": [0,1,2,0,2,3],
                       "colours": [[1,1,1,1],[2,2,2,2]], "per": "face", "tag": 4}},
        {"decal": {"slope": 3, "draw": [{"curve": {"quadratic": [[0,0,0],[30,60,0],[60,0,0]], "tolerance": 0.1}}]}}]}"#,
    )
    .expect("valid");
    let [faces, curve] = &scene.batches()[..] else { panic!("two batches") };
    assert_eq!((faces.positions.len(), faces.tag, faces.slope), (6, 4, None));
    assert_eq!((faces.colours[2], faces.colours[3]), ([1; 4], [2; 4]));
    assert_eq!((curve.topology, curve.slope, curve.tag), (Topology::Lines, Some(3.0), 5));
    assert_eq!(curve.path, "draw[1].decal.draw[0]");
    // Every chord's middle is close to the parabola y = 2 x (60 - x) / 60.
    for ends in curve.indices.chunks_exact(2) {
        let [a, b] = [0, 1].map(|end| curve.positions[ends[end] as usize]);
        let (x, y) = ((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0);
        assert!((y - 2.0 * x * (60.0 - x) / 60.0).abs() <= 0.1001);
    }
}

#[test]
fn batches_mesh_with_edges_and_flat_transform_is_sound() {
    let mesh = Mesh::new("corner", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![0, 1, 2], [9; 4]);
    let mut scene = Scene::showing(mesh.clone(), [64, 64]);
    let flat = MeshDraw { transform: [0.0; 16], edges: true, slope: 2.0, ..MeshDraw::of(mesh) };
    scene.draw.push(Draw::Mesh(flat));
    let [lit, unlit, edges] = &scene.batches()[..] else { panic!("three batches") };
    assert_ne!(lit.colours[0], [9; 4]);
    assert_eq!(unlit.colours, [[9; 4]; 3]);
    assert_eq!((edges.topology, edges.slope, edges.indices.len()), (Topology::Lines, Some(2.0), 6));
    assert!(lit.tag != unlit.tag && unlit.tag != edges.tag);
}

#[test]
fn batches_bezier_segments_are_not_joined() {
    let curve = Curve {
        kind: CurveKind::Cubic,
        points: (0..8_u8).map(|i| [f32::from(i * i), f32::from(i % 3), 0.0]).collect(),
        colours: Colours::One([9; 4]),
        tolerance: 0.25,
        width: Some(2.5),
        material: None,
        tag: None,
    };
    let mut scene = Scene::new([64, 64], [0; 4]);
    scene.draw.push(Draw::Curve(curve));
    let batch = &scene.batches()[0];
    let joined = [9.0_f32, 16.0];
    let across = batch
        .indices
        .chunks_exact(2)
        .any(|ends| [batch.positions[ends[0] as usize][0], batch.positions[ends[1] as usize][0]] == joined);
    assert!(!across);
}

proptest! {
    #[test]
    fn parse_random_bytes_never_panics(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = Scene::from_json(&bytes, Path::new("random.json"));
    }

    #[test]
    fn parse_mutated_example_never_panics(
        changes in proptest::collection::vec((0..FULL.len(), any::<u8>()), 1..6),
        removed in 0..FULL.len(),
        length in 0..40_usize,
    ) {
        let mut bytes = FULL.as_bytes().to_vec();
        for (place, byte) in changes {
            bytes[place] = byte;
        }
        bytes.drain(removed..(removed + length).min(FULL.len()));
        if let Ok(scene) = Scene::from_json(&bytes, Path::new("mutated.json")) {
            let _ = scene.batches();
        }
    }

    #[test]
    fn parse_numbers_swapped_for_others_never_panics(
        which in 0..60_usize,
        with in prop_oneof![
            Just("1e38"), Just("-1e38"), Just("1e-45"), Just("-0"), Just("4294967295"), Just("4294967296"),
            Just("null"), Just("\"x\""), Just("[]"), Just("{}"), Just("1e308"), Just("0.1")],
    ) {
        let mut seen = 0;
        let words = FULL.split_inclusive([',', '[', ']', ':', ' ']);
        let text: String = words.map(|word| {
            let number = word.trim_end_matches([',', ']', ' ']);
            if number.parse::<f64>().is_err() {
                return word.to_owned();
            }
            seen += 1;
            if seen - 1 == which { word.replacen(number, with, 1) } else { word.to_owned() }
        }).collect();
        if let Ok(scene) = parse(&text) {
            let _ = scene.batches();
        }
    }
}
