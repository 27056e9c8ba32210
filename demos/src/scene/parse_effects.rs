//! Lights and materials of a scene file.

use std::collections::BTreeMap;

use super::effects::{Blend, FogFunction, Light, LightType, Material, Texture, TextureFilter};
use super::json::{Fault, Json, Object, Read};

/// Most lights of a scene.
const MAX_LIGHTS: usize = 1024;
/// Largest side of a texture, in texels.
const MAX_TEXTURE_SIDE: u32 = 16384;

pub(super) fn lights(value: &Json) -> Read<Vec<Light>> {
    value.list("lights", 0..=MAX_LIGHTS, light)
}

fn light(value: &Json) -> Read<Light> {
    let fields = value.object(&[
        "type",
        "position",
        "direction",
        "attenuation_cut_off",
        "spot_exponent",
        "colour",
        "ambient",
    ])?;
    let kind = fields.required("type", |value| value.named(LightType::NAMED))?;
    let position = match kind {
        LightType::Directional => fields.or("position", [0.0; 3], Json::numbers)?,
        LightType::Point | LightType::Spot => fields.required("position", Json::numbers)?,
    };
    let direction = match kind {
        LightType::Point => fields.or("direction", [0.0, 0.0, -1.0], direction)?,
        LightType::Directional | LightType::Spot => fields.required("direction", direction)?,
    };
    Ok(Light {
        kind,
        position,
        direction,
        attenuation_cut_off: fields.optional("attenuation_cut_off", Json::positive)?,
        spot_exponent: fields.or("spot_exponent", 0.0, |value| value.number(0.0..=128.0))?,
        colour: fields.or("colour", [255; 4], Json::colour)?,
        ambient: fields.or("ambient", [0, 0, 0, 255], Json::colour)?,
    })
}

fn direction(value: &Json) -> Read<[f32; 3]> {
    let direction: [f32; 3] = value.numbers()?;
    if direction == [0.0; 3] {
        return Err(Fault::new("a direction", "[0, 0, 0]"));
    }
    Ok(direction)
}

pub(super) fn materials(value: &Json) -> Read<BTreeMap<String, Material>> {
    let mut materials = BTreeMap::new();
    for (name, value) in value.entries()? {
        let material = material(value).map_err(|fault| fault.in_field(name))?;
        materials.insert(name.to_string(), material);
    }
    Ok(materials)
}

fn material(value: &Json) -> Read<Material> {
    let plain = Material::default();
    let fields = value.object(&[
        "shininess",
        "specular",
        "emission",
        "blend",
        "punch_through",
        "fog_function",
        "fog_density",
        "fog_end",
        "fog_colour",
        "texture",
    ])?;
    Ok(Material {
        shininess: fields.or("shininess", plain.shininess, |value| value.number(0.0..=128.0))?,
        specular: fields.or("specular", plain.specular, Json::colour)?,
        emission: fields.or("emission", plain.emission, Json::colour)?,
        blend: fields.or("blend", plain.blend, |value| value.named(Blend::NAMED))?,
        punch_through: fields.optional("punch_through", |value| value.whole(0..=255))?.map(|least| least as u8),
        fog_function: fields.or("fog_function", plain.fog_function, |value| value.named(FogFunction::NAMED))?,
        fog_density: fields.or("fog_density", plain.fog_density, |value| value.number(0.0..=f32::MAX))?,
        fog_end: fields.or("fog_end", plain.fog_end, Json::positive)?,
        fog_colour: fields.or("fog_colour", plain.fog_colour, Json::colour)?,
        texture: fields.optional("texture", texture)?,
    })
}

fn texture(value: &Json) -> Read<Texture> {
    let fields = value.object(&["file", "filter", "offset", "size", "repeat", "mirror", "palette"])?;
    Ok(Texture {
        file: fields.required("file", Json::file_name)?.to_owned(),
        filter: fields.or("filter", TextureFilter::Bilinear, |value| value.named(TextureFilter::NAMED))?,
        offset: fields.or("offset", [0, 0], |value| texels(value, 0))?,
        size: fields.optional("size", |value| texels(value, 1))?,
        repeat: flags(&fields, "repeat")?,
        mirror: flags(&fields, "mirror")?,
        palette: fields.optional("palette", |value| value.list("colours", 1..=16, Json::colour))?,
    })
}

fn texels(value: &Json, least: u32) -> Read<[u32; 2]> {
    value.array("whole numbers", |side| side.whole(least..=MAX_TEXTURE_SIDE))
}

fn flags(fields: &Object<'_>, name: &str) -> Read<[bool; 2]> {
    fields.or(name, [false; 2], |value| value.array("flags, for x and y", Json::flag))
}
