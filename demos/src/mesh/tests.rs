//! Loaders on small files, good and damaged; edges, framing and baked light.

use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::scene::{Camera, Scene, wide};

const CUBE: &str = "o cube\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf -8 -4 -1 -5\nf 2 3 7 6\n";

fn obj(text: &str) -> Result<Mesh> {
    from_bytes(text.as_bytes(), Path::new("folder/some.obj"))
}

fn obj_fault(text: &str) -> String {
    obj(text).expect_err("a damaged file").to_string()
}

/// A .glb from its JSON and its binary chunk.
pub(super) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend((binary.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

/// Four corners of a square as positions (48 bytes), then 0 1 2 3 as indices of 16 bits (8 bytes).
fn square() -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
    bytes.extend((0..4_u16).flat_map(u16::to_le_bytes));
    bytes
}

fn square_json(mode: u32, node: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode},"material":0}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1.0,0.0,0.0,0.5]}}}}],
        "buffers":[{{"byteLength":56}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":8}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
                     {{"bufferView":1,"componentType":5123,"count":4,"type":"SCALAR"}}]}}"#
    )
}

pub(super) fn load_glb(bytes: &[u8]) -> Result<Mesh> {
    from_bytes(bytes, Path::new("folder/some.glb"))
}

#[test]
fn obj_cube_of_quads_has_twelve_triangles_and_edges() {
    let cube = obj(CUBE).expect("valid");
    assert_eq!((cube.positions.len(), cube.triangle_count()), (8, 12));
    assert_eq!(cube.normals, None);
    assert_eq!(cube.feature_edges(30.0).len(), 12);
    assert_eq!(cube.feature_edges(91.0).len(), 0);
    assert_eq!(cube.feature_edges(-1.0).len(), 18);
    let bounds = cube.bounds();
    assert_eq!((bounds.least, bounds.greatest, bounds.centre), ([-1.0; 3], [1.0; 3], [0.0; 3]));
    assert!((bounds.radius - 3.0_f32.sqrt()).abs() < 1e-6);
}

#[test]
fn obj_feature_edges_weld_seams_and_find_boundaries() {
    // Two triangles of a square that share no vertex: the seam is no edge, the border is.
    let square = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n").expect("valid");
    assert_eq!(square.feature_edges(30.0).len(), 4);
}

#[test]
fn obj_polygon_with_texture_coordinates_and_normals_is_a_fan() {
    let text = "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv -1 1 0\nvt 0\nvt 0.5 0.5\nvn 0 0 2\n\
        f 1/1/1 2/2/1 3/2/1 4/1/1 5/-1/-1\nl 1 2 3\n";
    let mesh = obj(text).expect("valid");
    assert_eq!(mesh.triangle_count(), 3);
    assert!(mesh.normals.as_ref().expect("normals").iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
    assert_eq!(mesh.warnings, ["lines and points left out: 1"]);
}

#[test]
fn obj_corners_without_normals_drop_all_normals() {
    let mesh = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 3\n").expect("valid");
    assert_eq!(mesh.normals, None);
    assert_eq!(mesh.warnings.len(), 1);
}

#[test]
fn obj_missing_material_library_is_a_warning() {
    let mesh = obj("mtllib none.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("valid");
    assert_eq!(mesh.colours, Colours::One(PLAIN_COLOUR));
    assert!(mesh.warnings[0].contains("none.mtl"), "{:?}", mesh.warnings);
}

#[test]
fn obj_material_library_gives_colours() {
    let folder = std::env::temp_dir().join(format!("zga-obj-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("two tones.mtl"), "newmtl red\nKd 1 0 0\nKd\nd 0.5\nnewmtl grey\nKd 0.2\n")
        .expect("written");
    let text = "mtllib\ttwo tones.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl grey\nf 3 2 1\n";
    let mesh = from_bytes(text.as_bytes(), &folder.join("a.obj")).expect("valid");
    std::fs::remove_dir_all(&folder).expect("removed");
    let Colours::PerVertex(colours) = mesh.colours else { panic!("two colours") };
    assert_eq!((colours[0], colours[5]), ([255, 0, 0, 128], [51, 51, 51, 255]));
}

#[test]
fn obj_damaged_files_name_file_line_and_reason() {
    assert!(obj_fault("v 0 0 0\nf 1 1 2\n").starts_with("folder/some.obj: line 2: position 2 does not exist"));
    assert!(obj_fault("v 0 0\nf 1 1 1\n").contains("line 1: a position has 2 numbers"));
    assert!(obj_fault("v 0 0 nan\n").contains("expected a finite number, found \"nan\""));
    assert!(obj_fault("v 0 0 0\nvn 0 0 1\nf 1//0 1//1 1//1\n").contains("line 3: normal 0 does not exist"));
    assert!(obj_fault("v 0 0 0\nf 1/9223372036854775807 1 1\n").contains("texture coordinate"));
    assert!(obj_fault("v 0 0 0\nf 1/1/1/1 1 1\n").contains("line 2"));
    assert!(obj_fault("").contains("holds no face"));
}

#[test]
fn load_unknown_ending_or_missing_file_names_the_file() {
    assert!(load(Path::new("a.stl")).expect_err("no mesh").to_string().starts_with("a.stl: "));
    assert!(matches!(load(Path::new("none.glb")), Err(Error::Read { .. })));
}

#[test]
fn glb_strip_is_placed_by_its_node() {
    let node = r#","translation":[0,0,5],"scale":[2,2,2]"#;
    let mesh = load_glb(&glb(&square_json(5, node), &square())).expect("valid");
    assert_eq!(mesh.positions[3], [2.0, 2.0, 5.0]);
    assert_eq!(mesh.indices, [0, 1, 2, 2, 1, 3]);
    assert_eq!(mesh.colours, Colours::One([255, 0, 0, 128]));
    assert_eq!(mesh.normals, None);
}

#[test]
fn glb_mirrored_node_turns_triangles_over() {
    let mesh = load_glb(&glb(&square_json(5, r#","scale":[-1,1,1]"#), &square())).expect("valid");
    assert_eq!(mesh.indices, [0, 2, 1, 2, 3, 1]);
}

#[test]
fn glb_other_modes_become_fans_lines_and_points() {
    let with = |mode| load_glb(&glb(&square_json(mode, ""), &square())).expect("valid");
    assert_eq!(with(6).indices, [0, 1, 2, 0, 2, 3]);
    assert_eq!(with(0).points, [0, 1, 2, 3]);
    assert_eq!(with(1).lines, [0, 1, 2, 3]);
    assert_eq!(with(2).lines, [0, 1, 1, 2, 2, 3, 3, 0]);
    assert_eq!(with(3).lines, [0, 1, 1, 2, 2, 3]);
}

#[test]
fn gltf_data_uri_is_read() {
    let json = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"#;
    let mesh = from_bytes(json.as_bytes(), Path::new("a.gltf")).expect("valid");
    assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let beside = json.replace("data:application/octet-stream;base64,", "none/").replace("AAAA", "A");
    let fault = from_bytes(beside.as_bytes(), Path::new("a.gltf")).expect_err("no such buffer").to_string();
    assert!(fault.starts_with("a.gltf: buffer 0: none/"), "{fault}");
}

#[test]
fn glb_damaged_files_say_what_is_wrong() {
    let fault = |json: &str, binary: &[u8]| load_glb(&glb(json, binary)).expect_err("damaged").to_string();
    let good = square_json(4, "");
    let wrong_index = {
        let mut bytes = square();
        bytes[48] = 9;
        bytes
    };
    assert!(fault(&good, &wrong_index).contains("mesh 0 primitive 0: index 9 of 4 vertices"));
    assert!(fault(&good, &square()[..40]).contains("buffer 0: has 40 bytes, expected 56"));
    let long = good.replacen("\"count\":4", "\"count\":400", 1);
    assert!(fault(&long, &square()).contains("positions (accessor 0): needs more bytes than buffer view 0 has"));
    let beyond = good.replace("\"byteOffset\":48", "\"byteOffset\":18446744073709551000");
    assert!(fault(&beyond, &square()).contains("reaches past the end"));
    let circle = square_json(4, r#","children":[0]"#);
    assert!(fault(&circle, &square()).contains("in a circle"));
    let not_finite = {
        let mut bytes = square();
        bytes[..4].copy_from_slice(&f32::NAN.to_le_bytes());
        bytes
    };
    assert!(fault(&good, &not_finite).contains("position 0 is not finite"));
    let nowhere = good.replace("\"POSITION\":0", "\"POSITION\":77");
    assert!(fault(&nowhere, &square()).contains("mesh 0 names accessor 77 of 2"));
    let compressed = good.replacen('{', r#"{"extensionsRequired":["EXT_meshopt_compression"],"#, 1);
    assert!(fault(&compressed, &square()).contains("needs the glTF extension EXT_meshopt_compression"));
    assert!(fault("{", &[]).contains("not valid glTF"));
}

#[test]
fn glb_every_truncation_is_an_error() {
    let whole = glb(&square_json(5, ""), &square());
    for length in 0..whole.len() {
        let error = load_glb(&whole[..length]).expect_err("cut short").to_string();
        assert!(error.starts_with("folder/some.glb: "), "{error}");
    }
}

#[test]
fn default_camera_frames_the_whole_mesh() {
    for (text, size) in [(CUBE.to_owned(), [640, 480]), (CUBE.replace("v 1 ", "v 9 "), [300, 900])] {
        let mesh = obj(&text).expect("valid");
        let camera = Camera::Perspective(mesh.default_camera(size));
        for position in &mesh.positions {
            let [x, y, depth] = camera.project(*position, size).expect("in front");
            assert!((0.0..=f64::from(size[0])).contains(&x) && (0.0..=f64::from(size[1])).contains(&y));
            assert!((0.0..=1.0).contains(&depth), "{depth}");
        }
    }
}

#[test]
fn default_camera_of_a_point_far_away_is_still_a_view() {
    let mesh = Mesh::new("speck", vec![[1e9, -1e9, 3e8]; 3], vec![0, 1, 2], [255; 4]);
    let camera = Camera::Perspective(mesh.default_camera([640, 480]));
    let [x, y, _] = camera.project(mesh.positions[0], [640, 480]).expect("in front");
    assert!((x - 320.0).abs() < 2.0 && (y - 240.0).abs() < 2.0, "{x} {y}");
    let huge = Mesh::new("huge", vec![[f32::MAX; 3], [f32::MIN; 3], [0.0; 3]], vec![0, 1, 2], [255; 4]);
    assert!(Scene::showing(huge, [64, 64]).batches()[0].positions[0][0].is_finite());
}

#[test]
fn baked_light_is_by_face_without_normals_and_by_vertex_with() {
    let mut cube = obj(CUBE).expect("valid");
    let viewer = DVec3::new(2.0, 3.0, 9.0);
    let Colours::PerFace(faces) = cube.baked(&Colours::One([200; 4]), viewer) else { panic!("by face") };
    assert_eq!(faces.len(), 12);
    // Faces 2 and 3 look at the viewer, 0 and 1 away: those are lit on the side that would be seen.
    assert!(faces.iter().all(|colour| colour[0] > 40 && colour[3] == 200));
    cube.normals = Some(cube.positions.iter().map(|p| crate::scene::narrow(wide(*p).normalize())).collect());
    let Colours::PerVertex(vertices) = cube.baked(&Colours::One([200; 4]), viewer) else { panic!("by vertex") };
    assert_eq!(vertices.len(), 8);
    assert!(vertices[7][0] > vertices[1][0], "toward the light is brighter");
}

proptest! {
    #[test]
    fn obj_random_lines_never_panic(lines in proptest::collection::vec(
        "(v|vn|vt|f|l|usemtl|o|g|mtllib x)( -?[0-9]{1,3}(/[0-9]{0,2}){0,3}| nan| 1e40|\t){0,6}", 0..30))
    {
        let _ = obj(&lines.join("\n"));
    }

    #[test]
    fn obj_random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = from_bytes(&bytes, Path::new("a.obj"));
    }

    #[test]
    fn glb_mutated_never_panics(
        mode in 0..7_u32,
        changes in proptest::collection::vec((0..2000_usize, any::<u8>()), 1..8),
    ) {
        let mut bytes = glb(&square_json(mode, ""), &square());
        let length = bytes.len();
        for (place, byte) in changes {
            bytes[place % length] = byte;
        }
        if let Ok(mesh) = load_glb(&bytes) {
            prop_assert_eq!(mesh.check(), Ok(()));
            let _ = Scene::showing(mesh, [64, 64]).batches();
        }
    }

    #[test]
    fn glb_numbers_swapped_never_panic(which in 0..40_usize, with in prop_oneof![
        Just("0"), Just("1"), Just("255"), Just("5120"), Just("5125"), Just("4294967295"), Just("9007199254740993"),
        Just("18446744073709551615"), Just("-1"), Just("1.5"), Just("1e30")])
    {
        let json = square_json(4, r#","matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]"#);
        let mut seen = 0;
        let swapped: String = json.split_inclusive([':', ',', '[', ']', '}']).map(|word| {
            let number = word.trim_end_matches([',', ']', '}']);
            if number.parse::<f64>().is_err() {
                return word.to_owned();
            }
            seen += 1;
            if seen - 1 == which { word.replacen(number, with, 1) } else { word.to_owned() }
        }).collect();
        let _ = load_glb(&glb(&swapped, &square()));
    }
}
