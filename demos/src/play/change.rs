//! One effect added to a scene or dropped from it, to see what it costs.
//!
//! Duties: says which changes make sense for a scene, and makes them: to its materials and lights before it is flattened,
//! to colours after, to what is asked of the card. Inputs from: [`Scene`], the effects that its draws called. Outputs
//! to: [`super::Look`], [`crate::effects`].

use std::sync::{Arc, OnceLock};

use zga_abi::Effects;

use super::environment::{fog_density, studio};
use crate::scene::{
    Batch, Blend, Camera, Colour, Draw, FogFunction, Lighting, Material, Scene, SubpixelGrid, Texture, TextureFilter,
};
use crate::texture::Picture;

/// Name of the material of draws that have none of their own.
const PLAIN: &str = "plain";
/// Alpha of everything where blending is added.
const HALF: u8 = 128;

/// A change to a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Without an effect that its draws call; one flag.
    Without(Effects),
    /// A checker on what has texture coordinates.
    Texture,
    /// Smaller levels of its textures, trilinear.
    MipMap,
    /// A checker with holes on what has texture coordinates.
    PunchThrough,
    /// Light at each vertex, of the scene's lights or three of the program's.
    LightPerVertex,
    /// The same at each pixel.
    LightPerPixel,
    /// Fog in the colour of the background.
    Fog,
    /// Everything with an alpha of 128.
    Blend,
    /// Anti-aliasing with so many samples.
    Antialias(SubpixelGrid),
}

impl Change {
    /// Changes that can be made to a scene whose draws call `called`, drawn with these samples, on a card that has the
    /// units `has`: what it calls dropped first, then what it does not call added.
    #[must_use]
    pub fn all(scene: &Scene, called: Effects, grid: SubpixelGrid, has: Effects) -> Vec<Change> {
        let drops = called.iter().filter(|effect| droppable().contains(*effect)).map(Change::Without);
        let (in_space, textured) = (scene.camera != Camera::Screen, has_coordinates(&scene.draw));
        let lightings: Vec<Lighting> = scene.batches().iter().map(|batch| batch.light).collect();
        let all_lit = |lighting| !lightings.iter().all(|found| [lighting, Lighting::None].contains(found));
        let adds = [
            (Change::Texture, !called.contains(Effects::TEXTURE) && textured),
            (Change::MipMap, called.contains(Effects::TEXTURE) && !called.contains(Effects::MIP_MAP)),
            (Change::PunchThrough, !called.contains(Effects::PUNCH_THROUGH) && textured),
            (Change::LightPerVertex, in_space && (!called.contains(Effects::LIGHT) || all_lit(Lighting::Vertex))),
            (Change::LightPerPixel, in_space && (!called.contains(Effects::LIGHT) || all_lit(Lighting::Pixel))),
            (Change::Fog, !called.contains(Effects::FOG) && fog_density(&scene.camera).is_some()),
            (Change::Blend, !called.contains(Effects::BLEND)),
            (Change::Antialias(SubpixelGrid::Grid4x4), grid != SubpixelGrid::Grid4x4),
            (Change::Antialias(SubpixelGrid::Grid8x8), grid != SubpixelGrid::Grid8x8),
        ];
        let adds = adds.into_iter().filter(|(change, makes_sense)| *makes_sense && has.contains(change.effect()));
        drops.chain(adds.map(|(change, _)| change)).collect()
    }

    /// The effect that is added or dropped.
    #[must_use]
    pub const fn effect(self) -> Effects {
        match self {
            Change::Without(effect) => effect,
            Change::Texture => Effects::TEXTURE,
            Change::MipMap => Effects::MIP_MAP,
            Change::PunchThrough => Effects::PUNCH_THROUGH,
            Change::LightPerVertex | Change::LightPerPixel => Effects::LIGHT,
            Change::Fog => Effects::FOG,
            Change::Blend => Effects::BLEND,
            Change::Antialias(_) => Effects::ANTI_ALIAS,
        }
    }

    /// What it is, for example `without texture` or `with fog`.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Change::Without(effect) => format!("without {}", super::effect_names(effect).join(", ")),
            Change::Texture => "with texture: a checker".to_owned(),
            Change::MipMap => "with mip_map: trilinear".to_owned(),
            Change::PunchThrough => "with punch_through: a checker with holes".to_owned(),
            Change::LightPerVertex => "with light at each vertex".to_owned(),
            Change::LightPerPixel => "with light at each pixel".to_owned(),
            Change::Fog => "with fog".to_owned(),
            Change::Blend => format!("with blend: everything at alpha {HALF}"),
            Change::Antialias(grid) => format!("with anti_alias {}", grid.name()),
        }
    }

    /// The samples of a pixel that it asks for.
    #[must_use]
    pub fn grid(self) -> Option<SubpixelGrid> {
        match self {
            Change::Without(Effects::ANTI_ALIAS) => Some(SubpixelGrid::Off),
            Change::Antialias(grid) => Some(grid),
            _ => None,
        }
    }

    /// Changes materials and lights.
    pub(super) fn scene(self, scene: &mut Scene) {
        match self {
            Change::Without(effect) => each_material(scene, |material| drop_effect(material, effect)),
            Change::Texture => each_material(scene, |material| material.texture = Some(checker(255))),
            Change::MipMap => each_material(scene, |material| {
                if let Some(texture) = &mut material.texture {
                    (texture.filter, texture.mip_map) = (TextureFilter::Trilinear, true);
                }
            }),
            Change::PunchThrough => each_material(scene, |material| {
                (material.texture, material.punch_through) = (Some(checker(0)), Some(HALF));
            }),
            Change::LightPerVertex => light(scene, Lighting::Vertex),
            Change::LightPerPixel => light(scene, Lighting::Pixel),
            Change::Fog => {
                let (Some(density), colour) = (fog_density(&scene.camera), scene.background) else { return };
                each_material(scene, |material| {
                    (material.fog_function, material.fog_density) = (FogFunction::ExponentialSquared, density);
                    material.fog_colour = colour;
                });
            }
            // What has a stencil test draws stencil values; no layer does.
            Change::Blend => each_material(scene, |material| {
                material.blend = if material.stencil.is_none() { Blend::Alpha } else { material.blend };
            }),
            Change::Antialias(_) => {}
        }
    }

    /// Changes colours and decals.
    pub(super) fn batches(self, batches: &mut [Batch]) {
        match self {
            Change::Blend => {
                batches.iter_mut().flat_map(|batch| &mut batch.colours).for_each(|colour| colour[3] = HALF);
            }
            Change::Without(Effects::GOURAUD) => {
                for batch in batches {
                    let colour = mean(&batch.colours);
                    batch.colours.fill(colour);
                }
            }
            Change::Without(Effects::DECAL) => batches.iter_mut().for_each(|batch| batch.slope = None),
            _ => {}
        }
    }
}

/// Effects that a scene can be drawn without: perspective is the camera's.
const fn droppable() -> Effects {
    Effects::all().difference(Effects::PERSPECTIVE).difference(Effects::STENCIL)
}

fn drop_effect(material: &mut Material, effect: Effects) {
    match effect {
        Effects::TEXTURE => (material.texture, material.punch_through) = (None, None),
        Effects::PUNCH_THROUGH => material.punch_through = None,
        Effects::MIP_MAP => {
            if let Some(texture) = &mut material.texture {
                texture.mip_map = false;
                if texture.filter == TextureFilter::Trilinear {
                    texture.filter = TextureFilter::Bilinear;
                }
            }
        }
        Effects::LIGHT => material.light = Some(Lighting::None),
        Effects::FOG => material.fog_function = FogFunction::None,
        Effects::BLEND => material.blend = Blend::Opaque,
        _ => {}
    }
}

fn light(scene: &mut Scene, lighting: Lighting) {
    if scene.lights.is_empty() {
        (scene.lights, scene.ambient) = studio();
    }
    each_material(scene, |material| material.light = Some(lighting));
}

/// A checker; the dark squares have this alpha.
fn checker(alpha: u8) -> Texture {
    const SIDE: u32 = 64;
    static PICTURES: [OnceLock<Option<Arc<Picture>>>; 2] = [OnceLock::new(), OnceLock::new()];
    let texel = |x: u32, y: u32| if (x / 8 + y / 8).is_multiple_of(2) { [255; 4] } else { [150, 150, 150, alpha] };
    let picture = PICTURES[usize::from(alpha == 255)].get_or_init(|| Picture::from_fn([SIDE; 2], texel).map(Arc::new));
    Texture { repeat: [true; 2], image: picture.clone(), ..Texture::named("checker".to_owned()) }
}

/// Changes every material that is in use, that of draws without one too.
pub(super) fn each_material(scene: &mut Scene, change: impl Fn(&mut Material)) {
    scene.materials.values_mut().for_each(&change);
    let mut plain = Material::default();
    change(&mut plain);
    if plain == Material::default() {
        each_part(&mut scene.draw, &change, None);
        return;
    }
    // A name that is not taken yet.
    let mut name = PLAIN.to_owned();
    while scene.materials.contains_key(&name) {
        name.push('+');
    }
    each_part(&mut scene.draw, &change, Some(&name));
    scene.materials.insert(name, plain);
}

/// Changes the materials of meshes' parts, and gives draws that have none the one of this name.
fn each_part(draws: &mut [Draw], change: &impl Fn(&mut Material), plain: Option<&str>) {
    let named = |material: &mut Option<String>| {
        if material.is_none() {
            *material = plain.map(str::to_owned);
        }
    };
    for draw in draws {
        match draw {
            Draw::Triangles(draw) | Draw::Lines(draw) | Draw::Points(draw) => named(&mut draw.material),
            Draw::Curve(curve) => named(&mut curve.material),
            Draw::Decal(decal) => each_part(&mut decal.draw, change, plain),
            Draw::Mesh(draw) => match &mut draw.mesh {
                Some(mesh) if draw.material.is_none() && !mesh.parts.is_empty() => {
                    for part in &mut Arc::make_mut(mesh).parts {
                        change(Arc::make_mut(&mut part.material));
                    }
                }
                _ => named(&mut draw.material),
            },
        }
    }
}

/// Whether some of what is drawn has texture coordinates.
fn has_coordinates(draws: &[Draw]) -> bool {
    draws.iter().any(|draw| match draw {
        Draw::Triangles(draw) | Draw::Lines(draw) | Draw::Points(draw) => draw.texture_coordinates.is_some(),
        Draw::Curve(_) => false,
        Draw::Decal(decal) => has_coordinates(&decal.draw),
        Draw::Mesh(draw) => draw.mesh.as_ref().is_some_and(|mesh| mesh.texture_coordinates.is_some()),
    })
}

/// The mean of colours.
fn mean(colours: &[Colour]) -> Colour {
    let count = colours.len().max(1) as u64;
    std::array::from_fn(|channel| {
        let sum: u64 = colours.iter().map(|colour| u64::from(colour[channel])).sum();
        ((sum + count / 2) / count) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Colours, Orthographic, Primitives};

    fn scene() -> Scene {
        let mut scene = Scene::new([16, 16], [10, 20, 30, 255]);
        let (eye, up) = ([0.0, 0.0, 4.0], [0.0, 1.0, 0.0]);
        scene.camera =
            Camera::Orthographic(Orthographic { eye, target: [0.0; 3], up, width: 4.0, near: 1.0, far: 9.0 });
        scene.draw.push(Draw::Triangles(Primitives {
            vertices: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
            texture_coordinates: Some(vec![[0.0; 2], [1.0, 0.0], [0.0, 1.0]]),
            colours: Colours::PerVertex(vec![[0, 0, 0, 255], [90, 0, 0, 255], [0, 60, 0, 255]]),
            ..Primitives::default()
        }));
        scene
    }

    fn changed(change: Change) -> Batch {
        let mut scene = scene();
        change.scene(&mut scene);
        let mut batches = scene.batches();
        change.batches(&mut batches);
        batches.remove(0)
    }

    #[test]
    fn all_offers_what_is_called_to_drop_and_what_is_not_to_add() {
        let called = Effects::DEPTH | Effects::GOURAUD | Effects::PERSPECTIVE;
        let names = |changes: Vec<Change>| changes.into_iter().map(Change::name).collect::<Vec<_>>();
        let found = names(Change::all(&scene(), called, SubpixelGrid::Off, Effects::all()));
        let expected = [
            "without depth",
            "without gouraud",
            "with texture: a checker",
            "with punch_through: a checker with holes",
            "with light at each vertex",
            "with light at each pixel",
            "with fog",
            "with blend: everything at alpha 128",
            "with anti_alias 4x4",
            "with anti_alias 8x8",
        ];
        assert_eq!(found, expected);
        let plain = Scene { camera: Camera::Screen, draw: Vec::new(), ..scene() };
        let found = names(Change::all(&plain, Effects::DEPTH, SubpixelGrid::Grid8x8, Effects::DEPTH | Effects::BLEND));
        assert_eq!(found, ["without depth", "with blend: everything at alpha 128"]);
    }

    #[test]
    fn scene_each_change_arrives_in_the_batch() {
        let texture = changed(Change::Texture).material.texture.clone();
        assert!(texture.is_some_and(|texture| texture.image.is_some()));
        let holes = changed(Change::PunchThrough);
        assert_eq!(holes.material.punch_through, Some(128));
        assert_eq!(changed(Change::LightPerPixel).light, Lighting::Pixel);
        assert_eq!(changed(Change::LightPerVertex).light, Lighting::Vertex);
        let fog = changed(Change::Fog);
        assert_eq!(
            (fog.material.fog_function, fog.material.fog_colour),
            (FogFunction::ExponentialSquared, [10, 20, 30, 255])
        );
        let half = changed(Change::Blend);
        assert!(half.translucent && half.colours.iter().all(|colour| colour[3] == 128));
        assert_eq!(changed(Change::Without(Effects::GOURAUD)).colours, [[30, 20, 0, 255]; 3]);
        assert_eq!(Change::Without(Effects::ANTI_ALIAS).grid(), Some(SubpixelGrid::Off));
    }
}
