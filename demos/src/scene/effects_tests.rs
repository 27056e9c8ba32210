//! Materials, textures and lights of scene files: what is accepted, what is read, where faults lie.

use std::path::Path;
use std::sync::Arc;

use super::parse_tests::{fault, parse};
use super::*;
use crate::texture::Picture;

#[test]
fn parse_texture_fields_left_out_have_defaults() {
    let with = |rest: &str| {
        let text =
            format!(r#"{{"size": [1,1], "draw": [], "materials": {{"m": {{"texture": {{"file": "a.png"{rest}}}}}}}}}"#);
        parse(&text).expect("valid").materials["m"].texture.clone().expect("a texture")
    };
    let plain = with("");
    let made = Texture::of(Picture::new([1, 1], vec![[9; 4]]).expect("possible"));
    assert_eq!(Texture { file: "a.png".to_owned(), image: None, ..made }, plain);
    assert_eq!((plain.filter, plain.mip_map), (TextureFilter::Bilinear, false));
    assert_eq!((plain.format, plain.function), (TextureFormat::Rgba8888, TextureFunction::Modulate));
    assert!(with(r#", "filter": "trilinear""#).mip_map);
    let colours = |count: usize| vec!["[1,2,3,4]"; count].join(",");
    let format = |count| with(&format!(r#", "palette": [{}]"#, colours(count))).format;
    assert_eq!(
        [format(1), format(16), format(17)],
        [TextureFormat::Palette4, TextureFormat::Palette4, TextureFormat::Palette8]
    );
}

#[test]
fn parse_wrong_effects_name_path_and_reason() {
    let material = |rest: &str| fault(&format!(r#"{{"size": [1,1], "draw": [], "materials": {{"m": {{{rest}}}}}}}"#));
    let texture = |rest: &str| material(&format!(r#""texture": {{"file": "a.png", {rest}}}"#));
    let at = |fault: [String; 3], path: &str, expected: &str| {
        assert_eq!((&*fault[0], &*fault[1]), (path, expected));
    };
    at(material(r#""light": "face""#), "materials.m.light", "one of \"none\", \"vertex\", \"pixel\"");
    at(material(r#""two_sided": 1"#), "materials.m.two_sided", "true or false");
    at(material(r#""depth_cue_scale": "far""#), "materials.m.depth_cue_scale", "a finite number");
    assert_eq!(material(r#""blend": "screen""#)[0], "materials.m.blend");
    assert_eq!(material(r#""texture": {"filter": "nearest"}"#)[0], "materials.m.texture.file");
    assert_eq!(texture(r#""format": "rgba32""#)[0], "materials.m.texture.format");
    assert_eq!(texture(r#""function": "multiply""#)[0], "materials.m.texture.function");
    at(texture(r#""bias": 128"#), "materials.m.texture.bias", "a number in -128..=127.99609");
    assert_eq!(texture(r#""colour": [1,2,3]"#)[0], "materials.m.texture.colour");
    assert_eq!(texture(r#""mipmap": true"#), [
        "materials.m.texture.mipmap".to_owned(),
        "one of the fields file, format, function, colour, filter, mip_map, bias, offset, size, repeat, mirror, palette"
            .to_owned(),
        "an unknown field".to_owned()
    ]);
    let palette = |format: &str, count: usize| {
        texture(&format!(r#""format": "{format}", "palette": [{}]"#, vec!["[0,0,0,0]"; count].join(",")))
    };
    let path = "materials.m.texture.palette";
    at(palette("rgb565", 1), path, "no palette with the format \"rgb565\"");
    at(palette("palette4", 17), path, "at most 16 colours with the format \"palette4\"");
    at(palette("palette8", 257), path, "a list of 1 to 256 colours");
    let lights = vec![r#"{"type": "point", "position": [0,0,0]}"#; 257].join(",");
    at(
        fault(&format!(r#"{{"size": [1,1], "draw": [], "lights": [{lights}]}}"#)),
        "lights",
        "a list of 0 to 256 lights",
    );
    assert_eq!(fault(r#"{"size": [1,1], "draw": [], "ambient": 3}"#)[0], "ambient");
}

#[test]
fn parse_every_name_of_an_effect_is_known() {
    let blends: Vec<&str> = Blend::NAMED.iter().map(|(name, _)| *name).collect();
    assert_eq!(blends, ["opaque", "alpha", "add", "multiply", "premultiplied"]);
    let fogs: Vec<&str> = FogFunction::NAMED.iter().map(|(name, _)| *name).collect();
    assert_eq!(fogs, ["none", "linear", "exponential", "exponential-squared", "depth-cue"]);
    let functions = TEXTURE_FUNCTIONS.map(|(name, _)| name);
    assert_eq!(functions, ["replace", "modulate", "decal", "blend"]);
    let formats = TEXTURE_FORMATS.map(|(name, _)| name);
    assert_eq!(formats, ["rgba8888", "rgb565", "rgba5551", "rgba4444", "palette8", "palette4"]);
}

#[test]
fn parse_stencil_and_shadow_have_defaults_and_every_field() {
    let text = r#"{"size": [1,1], "draw": [], "shadow": {"function": "less", "reference": 2, "read_mask": 7, "intensity": 90},
        "materials": {"a": {"stencil": {}}, "b": {"depth_write": false, "stencil": {"function": "equal", "reference": 3,
        "read_mask": 15, "write_mask": 240, "front": {"fail": "zero", "depth_fail": "invert", "pass": "replace"},
        "back": {"pass": "decrement-wrap"}, "colours": false}}}}"#;
    let scene = parse(text).expect("valid");
    let shadow = Shadow { function: DepthFunction::Less, reference: 2, read_mask: 7, intensity: 90 };
    assert_eq!(scene.shadow, Some(shadow));
    assert_eq!((scene.materials["a"].stencil, scene.materials["a"].depth_write), (Some(Stencil::default()), true));
    let front = StencilSide {
        fail: StencilOperation::Zero,
        depth_fail: StencilOperation::Invert,
        pass: StencilOperation::Replace,
    };
    let back = StencilSide { pass: StencilOperation::DecrementWrap, ..StencilSide::KEEP };
    let (function, colours) = (DepthFunction::Equal, false);
    let stencil = Stencil { function, reference: 3, read_mask: 15, write_mask: 240, front, back, colours };
    assert_eq!((scene.materials["b"].stencil, scene.materials["b"].depth_write), (Some(stencil), false));
    let plain = parse(r#"{"size": [1,1], "draw": [], "shadow": {}}"#).expect("valid");
    assert_eq!(plain.shadow, Some(Shadow::default()));
}

#[test]
fn parse_wrong_stencil_fields_name_path_and_reason() {
    let material = |rest: &str| fault(&format!(r#"{{"size": [1,1], "draw": [], "materials": {{"m": {{{rest}}}}}}}"#));
    assert_eq!(material(r#""stencil": {"reference": 256}"#)[0], "materials.m.stencil.reference");
    assert_eq!(material(r#""stencil": {"function": "nearer"}"#)[0], "materials.m.stencil.function");
    assert_eq!(material(r#""stencil": {"front": {"fail": "add"}}"#)[0], "materials.m.stencil.front.fail");
    assert_eq!(material(r#""stencil": {"mask": 1}"#)[0], "materials.m.stencil.mask");
    assert_eq!(fault(r#"{"size": [1,1], "draw": [], "shadow": {"intensity": -1}}"#)[0], "shadow.intensity");
}

#[test]
fn load_textures_are_read_once_and_faults_name_their_field() {
    let folder = std::env::temp_dir().join(format!("zga-scene-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = crate::texture::tests::png([2, 1], &[[1, 2, 3, 4], [5, 6, 7, 8]]);
    std::fs::write(folder.join("two.png"), file).expect("written");
    std::fs::write(folder.join("none.png"), "nothing").expect("written");
    let load = |texture: &str| {
        let text = format!(
            r#"{{"size": [1,1], "draw": [], "materials": {{"a": {{"texture": {{"file": "two.png"}}}}, "b c": {{"texture": {texture}}}}}}}"#
        );
        let mut scene = parse(&text).expect("valid");
        scene.load_meshes(&folder, Path::new("s.json")).map(|()| scene).map_err(|fault| fault.to_string())
    };
    let scene = load(r#"{"file": "two.png", "offset": [1,0], "size": [1,1]}"#).expect("readable");
    let image =
        |name: &str| scene.materials[name].texture.as_ref().and_then(|texture| texture.image.clone()).expect("read");
    assert!(Arc::ptr_eq(&image("a"), &image("b c")));
    assert_eq!(image("a").pixels(), [[1, 2, 3, 4], [5, 6, 7, 8]]);
    let missing = load(r#"{"file": "three.png"}"#).expect_err("no such file");
    assert!(missing.starts_with("s.json: materials[\"b c\"].texture.file: "), "{missing}");
    assert!(missing.contains("three.png"), "{missing}");
    assert!(load(r#"{"file": "none.png"}"#).expect_err("no picture").contains("neither a PNG nor a JPEG"));
    let beyond = load(r#"{"file": "two.png", "offset": [0,1]}"#).expect_err("one row");
    assert!(beyond.contains("texture.offset[1]: expected a texel of the picture, 0..=0, found 1"), "{beyond}");
    let long = load(r#"{"file": "two.png", "offset": [1,0], "size": [2,1]}"#).expect_err("one is left");
    assert!(long.contains("texture.size[0]: expected at most the 1 texels"), "{long}");
    std::fs::remove_dir_all(&folder).expect("removed");
}
