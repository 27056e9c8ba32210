//! What of materials, lights and parts of meshes arrives in the batches.

use std::sync::Arc;

use super::*;
use crate::mesh::Part;
use crate::texture::Picture;

fn picture() -> Picture {
    Picture::new([2, 1], vec![[1, 2, 3, 255], [4, 5, 6, 255]]).expect("possible")
}

fn textured() -> Material {
    Material { punch_through: Some(9), texture: Some(Texture::of(picture())), ..Material::default() }
}

fn lamp() -> Light {
    Light {
        kind: LightType::Directional,
        position: [0.0; 3],
        direction: [0.0, 0.0, -1.0],
        attenuation_cut_off: None,
        spot_exponent: 0.0,
        colour: [255; 4],
        ambient: DARK,
    }
}

/// Four triangles on six vertices; those from the third on share none with the first two.
fn strip(materials: [Material; 4]) -> Mesh {
    let positions = (0..6_u8).map(|i| [f32::from(i), f32::from(i % 2), 0.0]).collect();
    let mut mesh = Mesh::new("strip", positions, vec![0, 1, 2, 2, 1, 0, 3, 4, 5, 5, 4, 3], [200; 4]);
    mesh.colours = Colours::PerVertex((0..6).map(|i| [100 + i, 9, 9, 255]).collect());
    mesh.texture_coordinates = Some((0..6_u8).map(|i| [f32::from(i), 0.5]).collect());
    let part = |(at, material)| Part { triangles: at..at + 1, material: Arc::new(material) };
    mesh.parts = materials.into_iter().enumerate().map(part).collect();
    mesh
}

fn four(material: &Material) -> [Material; 4] {
    std::array::from_fn(|_| material.clone())
}

#[test]
fn batches_parts_that_look_the_same_are_one() {
    let glass = Material { blend: Blend::Add, ..Material::default() };
    let plain = Material::default();
    let mesh = strip([plain.clone(), plain, glass.clone(), glass]);
    assert_eq!(mesh.check(), Ok(()));
    let batches = Scene::showing(mesh, [8, 8]).batches();
    let [solid, clear] = &batches[..] else { panic!("two runs") };
    assert_eq!([&*solid.path, &*clear.path], ["draw[0].mesh.parts[0]", "draw[0].mesh.parts[1]"]);
    assert_eq!([solid.translucent, clear.translucent], [false, true]);
    assert_eq!(clear.material.blend, Blend::Add);
    assert_eq!(solid.tag, clear.tag);
    // Faces are lit one by one, so corners are apart: two triangles each.
    assert_eq!([solid.positions.len(), clear.positions.len()], [6, 6]);
    assert_eq!(clear.positions[0], [3.0, 1.0, 0.0]);
}

#[test]
fn batches_run_has_the_vertices_that_it_uses_and_no_others() {
    let mut mesh = strip([textured(), textured(), Material::default(), Material::default()]);
    mesh.normals = Some(vec![[0.0, 0.0, 1.0]; 6]);
    let mut scene = Scene::showing(mesh, [8, 8]);
    scene.lights.push(lamp());
    let batches = scene.batches();
    let [painted, bare] = &batches[..] else { panic!("two runs") };
    assert_eq!((painted.positions.len(), bare.positions.len()), (3, 3));
    assert_eq!(bare.indices, [0, 1, 2, 2, 1, 0]);
    assert_eq!(bare.positions[2], [5.0, 1.0, 0.0]);
    assert_eq!(bare.colours, [[103, 9, 9, 255], [104, 9, 9, 255], [105, 9, 9, 255]]);
    assert_eq!(painted.texture_coordinates, Some(vec![[0.0, 0.5], [1.0, 0.5], [2.0, 0.5]]));
    assert_eq!(bare.texture_coordinates, None);
    assert_eq!((painted.light, bare.light), (Lighting::Vertex, Lighting::Vertex));
}

#[test]
fn batches_mesh_without_materials_is_one_plain_batch_in_baked_light() {
    let mut mesh = strip(four(&Material::default()));
    mesh.parts.clear();
    let scene = Scene::showing(mesh.clone(), [8, 8]);
    let [batch] = &scene.batches()[..] else { panic!("one batch") };
    assert_eq!((&*batch.path, batch.light, &*batch.material), ("draw[0]", Lighting::None, &Material::default()));
    assert_eq!((batch.texture_coordinates.as_ref(), batch.normals.as_ref()), (None, None));
    let Camera::Perspective(camera) = scene.camera else { panic!("a view of the mesh") };
    let Colours::PerFace(baked) = mesh.baked(&mesh.colours, wide(camera.eye)) else { panic!("flat faces") };
    assert_eq!(batch.colours, baked.iter().flat_map(|colour| [*colour; 3]).collect::<Vec<_>>());
}

#[test]
fn batches_material_of_the_scene_goes_before_those_of_the_file() {
    let mut scene = Scene::showing(strip(four(&textured())), [8, 8]);
    scene.materials.insert("gold".to_owned(), Material { shininess: 7.0, ..Material::default() });
    let Draw::Mesh(named) = &mut scene.draw[0] else { panic!("a mesh") };
    named.material = Some("gold".to_owned());
    let [batch] = &scene.batches()[..] else { panic!("one batch") };
    assert_eq!((batch.material.shininess, batch.material.texture.as_ref()), (7.0, None));
    assert_eq!(batch.texture_coordinates, None);
}

#[test]
fn batches_without_coordinates_or_picture_have_no_texture_and_no_holes() {
    let mut scene = Scene::new([8, 8], DARK);
    let unread = Texture { image: None, ..Texture::of(picture()) };
    scene.materials.insert("unread".to_owned(), Material { texture: Some(unread), ..textured() });
    scene.materials.insert("read".to_owned(), textured());
    let corners = |name: &str, coordinates| {
        Draw::Triangles(Primitives {
            vertices: vec![[0.0; 3]; 3],
            texture_coordinates: coordinates,
            material: Some(name.to_owned()),
            ..Primitives::default()
        })
    };
    let pairs = Some(vec![[0.5; 2]; 3]);
    scene.draw = vec![corners("read", pairs.clone()), corners("read", None), corners("unread", pairs)];
    let has = |batch: &Batch| (batch.material.texture.is_some(), batch.material.punch_through);
    let found: Vec<_> = scene.batches().iter().map(has).collect();
    assert_eq!(found, [(true, Some(9)), (false, None), (false, None)]);
    let expected = "draw[1]: drawn without the texture of \"read\", for want of texture coordinates";
    assert_eq!(scene.warnings(), [expected]);
}

#[test]
fn batches_emission_is_added_to_baked_light() {
    let with = |emission| {
        let material = Material { emission, ..Material::default() };
        let mesh = strip(four(&material));
        Scene::showing(mesh, [8, 8]).batches()[0].colours[0]
    };
    let (dark, bright) = (with(DARK), with([10, 0, 255, 255]));
    assert_eq!(bright, [dark[0] + 10, dark[1], 255, 255]);
}

#[test]
fn batches_light_follows_the_material_then_the_scene() {
    let light = |asked, lamps: Vec<Light>| {
        let material = Material { light: asked, ..Material::default() };
        let mut scene = Scene::showing(strip(four(&material)), [8, 8]);
        scene.lights = lamps;
        let batch = scene.batches().remove(0);
        // Light in colours changes them; light on the card leaves them.
        (batch.light, batch.colours[0] == [100, 9, 9, 255])
    };
    assert_eq!(light(None, vec![]), (Lighting::None, false));
    assert_eq!(light(None, vec![lamp()]), (Lighting::Vertex, true));
    assert_eq!(light(Some(Lighting::Pixel), vec![]), (Lighting::Pixel, true));
    assert_eq!(light(Some(Lighting::None), vec![]), (Lighting::None, true));
    assert_eq!(light(Some(Lighting::None), vec![lamp()]), (Lighting::None, true));
}

#[test]
fn batches_lit_triangles_without_normals_get_those_of_their_planes() {
    let mut scene = Scene::showing(strip(four(&Material::default())), [8, 8]);
    scene.lights.push(lamp());
    let lines = Primitives { vertices: vec![[0.0; 3]; 2], ..Primitives::default() };
    scene.draw.push(Draw::Lines(lines));
    let batches = scene.batches();
    assert_eq!((batches[0].positions.len(), batches[0].indices.len()), (12, 12));
    assert!(batches[0].material.two_sided);
    // Corners 0, 1, 2 turn to the right seen from +z, 2, 1, 0 to the left.
    let normals = batches[0].normals.as_ref().expect("of planes");
    assert_eq!((normals[0], normals[3]), ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]));
    assert_eq!((batches[1].light, batches[1].normals.as_ref()), (Lighting::None, None));
    scene.camera = Camera::Screen;
    assert_eq!(scene.batches()[0].light, Lighting::None);
}

#[test]
fn batch_made_plain_has_no_effect_left() {
    let mut scene = Scene::showing(strip(four(&textured())), [8, 8]);
    scene.lights.push(lamp());
    let mut batch = scene.batches().remove(0);
    assert!(batch.material.texture.is_some() && batch.light == Lighting::Vertex);
    batch.make_plain();
    assert_eq!((&*batch.material, batch.light, batch.translucent), (&Material::default(), Lighting::None, false));
    assert_eq!(batch.texture_coordinates, None);
}

#[test]
fn showing_takes_the_lights_of_the_mesh_and_scenes_say_that_they_do_not() {
    let mut mesh = strip(four(&Material::default()));
    mesh.lights.push(lamp());
    let mut scene = Scene::showing(mesh, [8, 8]);
    assert_eq!((scene.lights.len(), scene.warnings().len()), (1, 0));
    assert_ne!(scene.ambient, DARK);
    scene.lights.clear();
    assert_eq!(scene.warnings(), ["strip: lights left out, a scene has its own: 1"]);
}

#[test]
fn texture_indexed_takes_its_own_palette_or_finds_one() {
    let texture = Texture::of(picture());
    assert_eq!(texture.indexed(), None);
    let found = Texture { format: TextureFormat::Palette4, ..texture.clone() }.indexed().expect("a palette");
    assert_eq!((found.palette, found.indices), (vec![[1, 2, 3, 255], [4, 5, 6, 255]], vec![0, 1]));
    let own = Texture { format: TextureFormat::Palette8, palette: Some(vec![[9; 4], [4, 5, 6, 250]]), ..texture };
    assert_eq!(own.indexed().expect("a palette").indices, [1, 1]);
}

#[test]
fn mesh_parts_with_gaps_are_refused() {
    let mut mesh = strip(four(&Material::default()));
    mesh.parts.remove(1);
    assert_eq!(mesh.check(), Err("has parts with a gap or an overlap at triangle 1".to_owned()));
    mesh.parts.truncate(1);
    assert_eq!(mesh.check(), Err("has parts of 1 triangles, but 4 triangles".to_owned()));
    mesh.parts.clear();
    mesh.texture_coordinates = Some(vec![[f32::NAN, 0.0]; 6]);
    assert_eq!(mesh.check(), Err("texture coordinate 0 (from 0) is not finite".to_owned()));
}
