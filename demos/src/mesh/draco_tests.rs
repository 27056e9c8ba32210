//! An octahedron compressed in both ways that there are, whole and damaged.

use proptest::prelude::*;

use super::tests::{glb, load_glb};
use crate::scene::Colours;

/// Positions (8 bits), normals (6 bits) and colours of an octahedron with corners at distance 1: edgebreaker.
const EDGEBREAKER: &str = "445241434f02020101000000060802070000026f15010110ff02cc40ff02cc4003ff00000000000100000100090300000201010903\
    00010301020203010201010101010180025515ffffffef1d0703912305edf2379f4d00000000ff000000000080bf000080bf000080bf00000040\
    0800030101023f0110775515591573550505eb23235b953f0000001f0000000601010101028002ad0a03ad0affffffe71d07711c1d0707f509ab\
    47bf4c8a00000000ff000000";
/// The same, sequential.
const SEQUENTIAL: &str = "445241434f020201000000080601040002040201040103040300050200050102050301050003010300090300000109030001020203\
    010202030100010100090701201301200300689001ffffc2bf3f0002f0ef0f0200000000ff00000000030101013f011077552577ad0a04ca50f4\
    5a3f0000001f00000000010100090701201301200300689001fefe82ff3f0002e0ff0f0200000000ff000000000080bf000080bf000080bf0000\
    00400806";

fn bytes(text: &str) -> Vec<u8> {
    let digits: Vec<char> = text.chars().filter(char::is_ascii_hexdigit).collect();
    digits.chunks(2).map(|pair| u8::from_str_radix(&String::from_iter(pair), 16).expect("two digits")).collect()
}

/// A document with one compressed primitive of `length` bytes.
fn json(length: usize) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"COLOR_0":2}},"indices":3,"mode":5,
            "extensions":{{"KHR_draco_mesh_compression":{{"bufferView":0,
                "attributes":{{"POSITION":0,"NORMAL":1,"COLOR_0":2}}}}}}}}]}}],
        "buffers":[{{"byteLength":{length}}}],"bufferViews":[{{"buffer":0,"byteLength":{length}}}],
        "accessors":[{{"componentType":5126,"count":6,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
            {{"componentType":5126,"count":6,"type":"VEC3"}},
            {{"componentType":5121,"normalized":true,"count":6,"type":"VEC3"}},
            {{"componentType":5123,"count":24,"type":"SCALAR"}}]}}"#
    )
}

fn load(stream: &[u8]) -> crate::Result<crate::mesh::Mesh> {
    load_glb(&glb(&json(stream.len()), stream))
}

#[test]
fn draco_octahedron_decodes_in_both_encodings() {
    for text in [EDGEBREAKER, SEQUENTIAL] {
        let mesh = load(&bytes(text)).expect("valid");
        assert_eq!((mesh.positions.len(), mesh.triangle_count()), (6, 8));
        let normals = mesh.normals.as_ref().expect("normals");
        let Colours::PerVertex(colours) = &mesh.colours else { panic!("a colour for each vertex") };
        for ((position, normal), colour) in mesh.positions.iter().zip(normals).zip(colours) {
            for axis in 0..3 {
                // Positions have 255 steps over the range of 2, so they are off by at most 1/255; normals have 6 bits.
                let along = position[axis].round();
                assert!((position[axis] - along).abs() <= 1.001 / 255.0, "{position:?}");
                assert!((normal[axis] - along).abs() < 0.05, "{normal:?} at {position:?}");
            }
            assert_eq!(position.iter().filter(|coordinate| coordinate.round() != 0.0).count(), 1);
            // The colours were (x + 1) * 127.5, shown through the sRGB curve: 0, 187 and 255.
            let shown = position.map(|x| [0, 187, 255][(x.round() + 1.0) as usize]);
            assert_eq!(colour[..3], shown, "{position:?}");
        }
    }
}

#[test]
fn draco_damage_is_told_with_mesh_and_primitive() {
    let stream = bytes(EDGEBREAKER);
    let fault = |from: &str, to: &str| {
        let text = json(stream.len());
        assert!(text.contains(from));
        load_glb(&glb(&text.replacen(from, to, 1), &stream)).expect_err("damaged").to_string()
    };
    let place = "folder/some.glb: mesh 0 primitive 0: KHR_draco_mesh_compression: ";
    assert!(fault("\"bufferView\":0", "\"bufferView\":7").starts_with(&format!("{place}bufferView 7 does not exist")));
    assert!(fault("\"bufferView\":0", "\"bufferView\":-1").ends_with("bufferView is not a number"));
    assert!(fault("\"POSITION\":0,\"NORMAL\":1,\"COLOR_0\":2}}}}", "\"POSITION\":9}}}}").contains("name attribute 9"));
    assert!(fault("\"count\":24", "\"count\":27").ends_with("holds 24 indices, the accessor says 27"));
    assert!(fault("\"count\":24", "\"count\":3").contains("stream decodes 8 faces, over the caller's ceiling of 1"));
    assert!(fault("\"count\":6", "\"count\":5").ends_with("holds 6 vertices, the accessors say 5"));
    let cut = load(&stream[..stream.len() / 2]).expect_err("cut short").to_string();
    assert!(cut.starts_with(place), "{cut}");
}

#[test]
fn draco_every_truncation_is_an_error_or_a_sound_mesh() {
    for text in [EDGEBREAKER, SEQUENTIAL] {
        let stream = bytes(text);
        for length in 0..stream.len() {
            assert!(load(&stream[..length]).is_err(), "{length} of {} bytes", stream.len());
        }
    }
}

proptest! {
    #[test]
    fn draco_mutated_never_panics(
        which in any::<bool>(),
        changes in proptest::collection::vec((0..200_usize, any::<u8>()), 1..6),
    ) {
        let mut stream = bytes(if which { EDGEBREAKER } else { SEQUENTIAL });
        let length = stream.len();
        for (place, byte) in changes {
            stream[place % length] = byte;
        }
        if let Ok(mesh) = load(&stream) {
            prop_assert_eq!(mesh.check(), Ok(()));
        }
    }
}
