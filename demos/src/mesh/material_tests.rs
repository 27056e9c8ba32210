//! Materials, textures and lights of mesh files, good and damaged.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use proptest::prelude::*;

use super::tests::{glb, load_glb};
use super::*;
use crate::scene::{Blend, DARK, LightType, Lighting, Scene, Texture, TextureFilter};
use crate::texture::tests::png;

/// A folder for a test's files, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("zga-{name}-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("maps")).expect("a folder");
        Self(folder)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.0.join(name), bytes).expect("written");
    }

    fn obj(&self, library: &str, text: &str) -> Mesh {
        self.write("a.mtl", library);
        from_bytes(format!("mtllib a.mtl\n{CORNERS}{text}").as_bytes(), &self.0.join("a.obj")).expect("valid")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nvn 0 0 1\n";
const FACE: &str = "f 1/1/1 2/2/1 3/3/1\n";

fn texture(mesh: &Mesh, part: usize) -> &Texture {
    mesh.parts[part].material.texture.as_ref().expect("a texture")
}

#[test]
fn obj_materials_make_parts_with_highlights_and_textures() {
    let folder = Folder::new("obj-parts");
    folder.write("maps/brick wall.png", png([2, 1], &[[9, 8, 7, 255], [6, 5, 4, 255]]));
    let library = "newmtl wall\nKd 0.5 1 1\nKs 1 0.5 0\nNs 300\nKe 0 0 0.2\nillum 2\n\
        map_Kd -s 1 1 1 -clamp on maps\\brick wall.png\n\
        newmtl matt\nKd 1 0 0\nKs 1 1 1\nNs 300\nillum 1\nd 0.5\n";
    let mesh = folder.obj(library, &format!("usemtl wall\n{FACE}{FACE}usemtl matt\n{FACE}"));
    assert_eq!(mesh.warnings, Vec::<String>::new());
    let ranges: Vec<_> = mesh.parts.iter().map(|part| part.triangles.clone()).collect();
    assert_eq!(ranges, [0..2, 2..3]);
    let (wall, matt) = (&*mesh.parts[0].material, &*mesh.parts[1].material);
    assert_eq!((wall.specular, wall.shininess, wall.emission), ([255, 128, 0, 255], 128.0, [0, 0, 51, 255]));
    assert_eq!((matt.specular, matt.shininess, matt.blend), (DARK, 0.0, Blend::Alpha));
    let map = texture(&mesh, 0);
    assert_eq!((map.repeat, map.filter, map.mip_map), ([false; 2], TextureFilter::Trilinear, true));
    assert_eq!(map.image.as_ref().expect("read").pixels(), [[9, 8, 7, 255], [6, 5, 4, 255]]);
    let Colours::PerVertex(colours) = &mesh.colours else { panic!("two colours") };
    assert_eq!((colours[0], colours[5]), ([128, 255, 255, 255], [255, 0, 0, 128]));
    // The card's v grows downward.
    assert_eq!(mesh.texture_coordinates.as_ref().expect("there")[..3], [[0.0, 1.0], [1.0, 1.0], [0.0, 0.25]]);
}

#[test]
fn obj_missing_texture_is_a_warning_and_leaves_the_colour() {
    let folder = Folder::new("obj-missing");
    folder.write("bad.png", b"\x89PNG\r\n\x1a\n and no more than this");
    let library = "newmtl a\nKd 0 1 0\nmap_Kd none.png\nmap_Bump -bm 2 b.png\nnewmtl b\nmap_Kd -s 2 2 bad.png\n";
    let mesh = folder.obj(library, &format!("usemtl a\n{FACE}usemtl b\n{FACE}"));
    assert!(mesh.warnings[0].contains("left out: \"map_Bump\", map_Kd -s"), "{:?}", mesh.warnings);
    assert!(mesh.warnings.iter().any(|line| line.contains("none.png: cannot be read")), "{:?}", mesh.warnings);
    assert!(mesh.warnings.iter().any(|line| line.contains("bad.png: has")), "{:?}", mesh.warnings);
    assert!(mesh.parts.iter().all(|part| part.material.texture.is_none()));
    let Colours::PerVertex(colours) = &mesh.colours else { panic!("two colours") };
    assert_eq!((colours[0], colours[5]), ([0, 255, 0, 255], PLAIN_COLOUR));
}

#[test]
fn obj_texture_without_coordinates_is_a_warning() {
    let folder = Folder::new("obj-bare");
    folder.write("a.png", png([1, 1], &[[9; 4]]));
    let mesh = folder.obj("newmtl a\nmap_Kd a.png\n", "usemtl a\nf 1 2 3\n");
    assert_eq!(mesh.warnings, ["texture of material \"a\" left out where there are no coordinates"]);
    assert!(mesh.parts.is_empty());
}

#[test]
fn obj_alphas_of_map_d_are_holes_or_translucency() {
    let folder = Folder::new("obj-alpha");
    folder.write("rgba.png", png([2, 1], &[[9, 9, 9, 255], [9, 9, 9, 0]]));
    folder.write("grey.png", png([1, 1], &[[100, 100, 100, 255]]));
    let look = |maps: &str| {
        let mesh = folder.obj(&format!("newmtl a\n{maps}\n"), &format!("usemtl a\n{FACE}"));
        let material = &mesh.parts[0].material;
        let alphas: Vec<u8> =
            texture(&mesh, 0).image.as_ref().expect("read").pixels().iter().map(|pixel| pixel[3]).collect();
        (material.blend, material.punch_through, alphas, mesh.warnings.len())
    };
    assert_eq!(look("map_Kd rgba.png\nmap_d rgba.png"), (Blend::Opaque, Some(128), vec![255, 0], 0));
    assert_eq!(look("map_Kd rgba.png\nmap_d grey.png"), (Blend::Alpha, None, vec![100, 100], 0));
    assert_eq!(look("map_d grey.png"), (Blend::Alpha, None, vec![100], 0));
    assert_eq!(look("map_Kd rgba.png"), (Blend::Opaque, None, vec![255, 255], 1));
}

/// Two triangles with positions, two sets of texture coordinates and a picture of 2 x 1 texels, each with a material.
/// `changes` are replacements in the JSON.
fn two_materials(changes: &[(&str, &str)]) -> Vec<u8> {
    let picture = png([2, 1], &[[250, 0, 0, 255], [0, 250, 0, 90]]);
    let mut binary: Vec<u8> = Vec::new();
    for corner in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        binary.extend(corner.iter().flat_map(|c| c.to_le_bytes()));
    }
    for pair in [[0.0_f32, 0.0], [1.0, 0.0], [0.0, 1.0]] {
        binary.extend(pair.iter().flat_map(|c| c.to_le_bytes()));
    }
    // The second set as normalised bytes, rows of four.
    binary.extend([0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0]);
    binary.extend(&picture);
    binary.resize(binary.len().next_multiple_of(4), 0);
    let (length, size) = (binary.len(), picture.len());
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["KHR_texture_transform","KHR_lights_punctual","KHR_odd"],
        "extensions":{{"KHR_lights_punctual":{{"lights":[
            {{"type":"directional","color":[1,0.5,0],"intensity":2}},
            {{"type":"point","intensity":8,"range":50}},
            {{"type":"spot","intensity":0.001,"spot":{{"innerConeAngle":0.5,"outerConeAngle":0.7}}}}]}}}},
        "scenes":[{{"nodes":[0,1,2,3]}}],
        "nodes":[{{"mesh":0}},{{"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
            {{"translation":[0.5,0.5,4],"extensions":{{"KHR_lights_punctual":{{"light":1}}}}}},
            {{"rotation":[0,1,0,0],"extensions":{{"KHR_lights_punctual":{{"light":2}}}}}}],
        "meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2}},"material":0}},
            {{"attributes":{{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2}},"material":1}}]}}],
        "materials":[
            {{"name":"leaf","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
              "normalTexture":{{"index":0}},
              "pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,0.5],"roughnessFactor":0.5,"metallicFactor":0,
              "baseColorTexture":{{"index":0,"texCoord":1,
                "extensions":{{"KHR_texture_transform":{{"offset":[0.5,0.25],"scale":[2,5]}}}}}}}}}},
            {{"alphaMode":"BLEND","emissiveFactor":[0,0,1],
              "pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,0.25]}}}}],
        "samplers":[{{"wrapS":33071,"wrapT":33648,"magFilter":9729,"minFilter":9985}}],
        "textures":[{{"sampler":0,"source":0}}],
        "images":[{{"bufferView":3,"mimeType":"image/png"}}],
        "buffers":[{{"byteLength":{length}}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":24}},
            {{"buffer":0,"byteOffset":60,"byteLength":12,"byteStride":4}},
            {{"buffer":0,"byteOffset":72,"byteLength":{size}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}},
            {{"bufferView":2,"componentType":5121,"normalized":true,"count":3,"type":"VEC2"}}]}}"#
    );
    for (from, to) in changes {
        assert!(json.contains(from), "{from}");
        json = json.replacen(from, to, 1);
    }
    glb(&json, &binary)
}

fn changed(changes: &[(&str, &str)]) -> Mesh {
    load_glb(&two_materials(changes)).expect("valid")
}

#[test]
fn glb_two_materials_make_two_parts() {
    let mesh = changed(&[]);
    let ranges: Vec<_> = mesh.parts.iter().map(|part| part.triangles.clone()).collect();
    assert_eq!(ranges, [0..1, 1..2]);
    let (leaf, glass) = (&*mesh.parts[0].material, &*mesh.parts[1].material);
    // The cut-off is of the product: 0.25 of a factor of 0.5 is a texel of 0.5.
    assert_eq!((leaf.two_sided, leaf.blend, leaf.punch_through), (true, Blend::Opaque, Some(128)));
    // alpha = 0.25, n = 2 / 0.0625 - 2 = 30; F0 (n + 2) / 8 = 0.16, which is shown as 111.
    assert_eq!((leaf.shininess, leaf.specular, leaf.light), (30.0, [111, 111, 111, 255], None));
    assert_eq!((glass.two_sided, glass.blend, glass.emission), (false, Blend::Alpha, [0, 0, 255, 255]));
    assert_eq!((glass.shininess, glass.specular, glass.texture.as_ref()), (0.0, DARK, None));
    let map = texture(&mesh, 0);
    assert_eq!((map.filter, map.mip_map), (TextureFilter::Bilinear, true));
    assert_eq!((map.repeat, map.mirror), ([false, true], [false, true]));
    assert_eq!(map.image.as_ref().expect("read").pixels(), [[250, 0, 0, 255], [0, 250, 0, 90]]);
    // The first part has its second set, times (2, 5) plus (0.5, 0.25); the second part its first set.
    let coordinates = mesh.texture_coordinates.as_ref().expect("there");
    assert_eq!(coordinates[..3], [[0.5, 0.25], [2.5, 0.25], [0.5, 1.25]]);
    assert_eq!(coordinates[3..], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(mesh.warnings, ["extension \"KHR_odd\" left out", "normal textures left out"]);
    let batches = Scene::showing(mesh, [8, 8]).batches();
    assert_eq!(batches.iter().map(|batch| batch.translucent).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn glb_lights_are_measured_against_the_brightest() {
    let mesh = changed(&[]);
    let [sun, bulb, spot] = &mesh.lights[..] else { panic!("three lights") };
    // 2 lux by 1, 0.5, 0 is the brightest.
    assert_eq!((sun.kind, sun.direction, sun.colour), (LightType::Directional, [0.0, 0.0, -1.0], [255, 188, 0, 255]));
    // 8 candela from 4 units off are 0.5 lux: a quarter, which is shown as 137.
    assert_eq!((bulb.kind, bulb.position, bulb.colour), (LightType::Point, [0.5, 0.5, 4.0], [137, 137, 137, 255]));
    assert_eq!((bulb.attenuation_cut_off, sun.attenuation_cut_off), (Some(50.0), None));
    assert_eq!((spot.kind, spot.direction), (LightType::Spot, [0.0, 0.0, 1.0]));
    // The cosine of 0.6 is 0.8253; ln 0.5 / ln 0.8253 = 3.61.
    assert_eq!(spot.spot_exponent, 3.625);
    let dark = changed(&[("\"intensity\":0.001", "\"intensity\":0"), ("\"intensity\":8", "\"intensity\":-8")]);
    assert_eq!((dark.lights.len(), dark.warnings.last().map(String::as_str)), (1, Some("lights left out: 2")));
    let fault = load_glb(&two_materials(&[("{\"light\":2}", "{\"light\":3}")])).expect_err("there are three");
    assert!(fault.to_string().contains("not valid glTF"), "{fault}");
}

#[test]
fn glb_unlit_material_is_shown_as_it_is() {
    let mesh = changed(&[
        ("\"alphaMode\":\"BLEND\"", "\"extensions\":{\"KHR_materials_unlit\":{}}"),
        ("\"KHR_odd\"", "\"KHR_materials_unlit\""),
    ]);
    let unlit = &*mesh.parts[1].material;
    assert_eq!((unlit.light, unlit.emission), (Some(Lighting::None), DARK));
    let batch = Scene::showing(mesh, [8, 8]).batches().remove(1);
    assert_eq!((batch.light, batch.colours[0]), (Lighting::None, [255, 0, 0, 64]));
}

#[test]
fn gltf_images_come_from_files_and_data_uris() {
    let folder = Folder::new("gltf-images");
    folder.write("maps/a b.png", png([1, 1], &[[1, 2, 3, 255]]));
    let escaped: String = png([1, 1], &[[4, 5, 6, 255]]).iter().map(|byte| format!("%{byte:02x}")).collect();
    let load = |uri: &str| {
        let image = format!("{{\"uri\":\"{uri}\"}}");
        let file = two_materials(&[("{\"bufferView\":3,\"mimeType\":\"image/png\"}", &image)]);
        from_bytes(&file, &folder.0.join("a.glb")).expect("valid")
    };
    let texel = |mesh: &Mesh| texture(mesh, 0).image.as_ref().expect("read").pixels()[0];
    assert_eq!(texel(&load("maps/a%20b.png")), [1, 2, 3, 255]);
    assert_eq!(texel(&load(&format!("data:image/png,{escaped}"))), [4, 5, 6, 255]);
    let missing = load("maps/none.png");
    assert!(missing.parts[0].material.texture.is_none());
    assert_eq!(missing.parts[0].material.punch_through, None);
    assert!(missing.warnings[1].starts_with("image 0 left out: "), "{:?}", missing.warnings);
    assert!(missing.warnings[1].contains("none.png"), "{:?}", missing.warnings);
}

#[test]
fn glb_damaged_images_are_warnings() {
    let warning = |from: &str, to: &str| {
        let mesh = changed(&[(from, to)]);
        assert!(mesh.parts[0].material.texture.is_none(), "{to}");
        mesh.warnings.join("; ")
    };
    let view = "{\"bufferView\":3,\"mimeType\":\"image/png\"}";
    assert!(warning(view, "{}").contains("image 0 left out: has neither a buffer view nor a URI"));
    assert!(warning(view, "{\"bufferView\":0}").contains("image 0 left out: is neither a PNG nor a JPEG"));
    assert!(warning(view, "{\"uri\":\"data:image/png;base64,*\"}").contains("not base64"));
    assert!(warning("\"sampler\":0,\"source\":0", "\"sampler\":0").contains("texture 0 left out: it has no image"));
    assert!(warning("\"texCoord\":1,", "\"texCoord\":7,").contains("TEXCOORD"));
}

#[test]
fn glb_rotation_of_a_texture_is_left_out_by_name() {
    let mesh = changed(&[("\"offset\":[0.5,0.25]", "\"rotation\":1,\"offset\":[0.5,0.25]")]);
    assert!(mesh.warnings.contains(&"rotation of KHR_texture_transform left out of material \"leaf\"".to_owned()));
    assert_eq!(mesh.texture_coordinates.as_ref().expect("there")[0], [0.5, 0.25]);
}

#[test]
fn glb_samplers_choose_the_filter() {
    let filter = |sampler: &str| {
        let mesh = changed(&[("\"magFilter\":9729,\"minFilter\":9985", sampler)]);
        let map = texture(&mesh, 0);
        (map.filter, map.mip_map)
    };
    assert_eq!(filter("\"name\":\"none\""), (TextureFilter::Trilinear, true));
    assert_eq!(filter("\"minFilter\":9987"), (TextureFilter::Trilinear, true));
    assert_eq!(filter("\"minFilter\":9729"), (TextureFilter::Bilinear, false));
    assert_eq!(filter("\"minFilter\":9728"), (TextureFilter::Nearest, false));
    assert_eq!(filter("\"magFilter\":9728,\"minFilter\":9987"), (TextureFilter::Nearest, true));
}

#[test]
fn highlight_so_wide_that_all_would_shine_is_none() {
    assert_eq!(highlight([9, 8, 7], 0.9), (DARK, 0.0));
    assert_eq!(highlight([0, 0, 0], 20.0), (DARK, 0.0));
    assert_eq!(highlight([9, 8, 7], 1000.0), ([9, 8, 7, 255], 128.0));
}

#[test]
fn obj_parts_of_equal_materials_share_one() {
    let folder = Folder::new("obj-equal");
    let library = "newmtl a\nKd 1 0 0\nKs 1 1 1\nNs 9\nnewmtl b\nKd 0 1 0\nKs 1 1 1\nNs 9\n";
    let mesh = folder.obj(library, &format!("usemtl a\n{FACE}usemtl b\n{FACE}"));
    assert_eq!(mesh.parts, [Part { triangles: 0..2, material: Arc::clone(&mesh.parts[0].material) }]);
    assert_eq!(mesh.parts[0].material.shininess, 9.0);
}

proptest! {
    #[test]
    fn mtl_random_lines_never_panic(lines in proptest::collection::vec(
        "(newmtl a|Kd|Ks|Ke|Ns|d|Tr|illum|map_Kd|map_d|map_Bump)( -(clamp|s|o|mm|x|blendu))?( -?[0-9]{1,3}| nan| 1e40| on| a.png|\t){0,5}", 0..20))
    {
        let mut warnings = Vec::new();
        let text = mtl::plain_library(&lines.join("\n"), &mut warnings);
        prop_assert!(tobj::load_mtl_buf(&mut text.as_bytes()).is_ok(), "{}", text);
    }

    #[test]
    fn glb_materials_mutated_never_panic(
        changes in proptest::collection::vec((0..4000_usize, any::<u8>()), 1..8),
    ) {
        let mut bytes = two_materials(&[]);
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
    fn glb_material_numbers_swapped_never_panic(which in 0..120_usize, with in prop_oneof![
        Just("0"), Just("1"), Just("255"), Just("9728"), Just("4294967295"), Just("18446744073709551615"), Just("-1"),
        Just("1.5"), Just("1e30"), Just("1e39"), Just("-1e39")])
    {
        let bytes = two_materials(&[]);
        let end = 20 + u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        let json = std::str::from_utf8(&bytes[20..end]).expect("text");
        let mut seen = 0;
        let swapped: String = json.split_inclusive([':', ',', '[', ']', '}']).map(|word| {
            let number = word.trim_end_matches([',', ']', '}']);
            if number.parse::<f64>().is_err() {
                return word.to_owned();
            }
            seen += 1;
            if seen - 1 == which { word.replacen(number, with, 1) } else { word.to_owned() }
        }).collect();
        if let Ok(mesh) = load_glb(&glb(&swapped, &bytes[end + 8..])) {
            prop_assert_eq!(mesh.check(), Ok(()));
            let _ = Scene::showing(mesh, [64, 64]).batches();
        }
    }
}

#[test]
fn load_files_from_disk_find_what_lies_beside_them() {
    let folder = Folder::new("beside");
    folder.write("a.mtl", "newmtl a\nKs 1 1 1\nNs 20\n");
    folder.write("a.obj", format!("mtllib a.mtl\n{CORNERS}usemtl a\n{FACE}"));
    let mesh = load(Path::new(&folder.0.join("a.obj"))).expect("valid");
    assert_eq!((mesh.warnings.len(), mesh.parts[0].material.shininess), (0, 20.0));
}
