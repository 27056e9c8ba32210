//! Lights and materials of a scene file.

use std::collections::BTreeMap;

use zga_abi::light::MOST_LIGHTS;

use super::Colour;
use super::effects::{
    Blend, FogFunction, Light, LightType, Lighting, Material, STENCIL_FUNCTIONS, STENCIL_OPERATIONS, Shadow, Stencil,
    StencilOperation, StencilSide, TEXTURE_FORMATS, TEXTURE_FUNCTIONS, Texture, TextureFilter, TextureFormat,
};
use super::json::{ANY, Fault, Json, Object, Read};
use crate::limits::MAX_PICTURE_SIDE;

/// Least and greatest bias of the level of detail, levels: 16 bits with 8 of them behind the point.
const BIASES: std::ops::RangeInclusive<f32> = -128.0..=32767.0 / 256.0;

pub(super) fn lights(value: &Json) -> Read<Vec<Light>> {
    value.list("lights", 0..=MOST_LIGHTS as usize, light)
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
        "light",
        "two_sided",
        "shininess",
        "specular",
        "emission",
        "blend",
        "punch_through",
        "fog_function",
        "fog_density",
        "fog_end",
        "fog_colour",
        "depth_cue_scale",
        "depth_cue_offset",
        "depth_write",
        "stencil",
        "texture",
    ])?;
    Ok(Material {
        light: fields.optional("light", |value| value.named(Lighting::NAMED))?,
        two_sided: fields.or("two_sided", plain.two_sided, Json::flag)?,
        shininess: fields.or("shininess", plain.shininess, |value| value.number(0.0..=128.0))?,
        specular: fields.or("specular", plain.specular, Json::colour)?,
        emission: fields.or("emission", plain.emission, Json::colour)?,
        blend: fields.or("blend", plain.blend, |value| value.named(Blend::NAMED))?,
        punch_through: fields.optional("punch_through", |value| value.whole(0..=255))?.map(|least| least as u8),
        fog_function: fields.or("fog_function", plain.fog_function, |value| value.named(FogFunction::NAMED))?,
        fog_density: fields.or("fog_density", plain.fog_density, |value| value.number(0.0..=f32::MAX))?,
        fog_end: fields.or("fog_end", plain.fog_end, Json::positive)?,
        fog_colour: fields.or("fog_colour", plain.fog_colour, Json::colour)?,
        depth_cue_scale: fields.or("depth_cue_scale", plain.depth_cue_scale, |value| value.number(ANY))?,
        depth_cue_offset: fields.or("depth_cue_offset", plain.depth_cue_offset, |value| value.number(ANY))?,
        depth_write: fields.or("depth_write", plain.depth_write, Json::flag)?,
        stencil: fields.optional("stencil", stencil)?,
        texture: fields.optional("texture", texture)?,
    })
}

fn stencil(value: &Json) -> Read<Stencil> {
    let plain = Stencil::default();
    let fields = value.object(&["function", "reference", "read_mask", "write_mask", "front", "back", "colours"])?;
    Ok(Stencil {
        function: fields.or("function", plain.function, |value| value.named(&STENCIL_FUNCTIONS))?,
        reference: fields.or("reference", plain.reference, byte)?,
        read_mask: fields.or("read_mask", plain.read_mask, byte)?,
        write_mask: fields.or("write_mask", plain.write_mask, byte)?,
        front: fields.or("front", plain.front, stencil_side)?,
        back: fields.or("back", plain.back, stencil_side)?,
        colours: fields.or("colours", plain.colours, Json::flag)?,
    })
}

fn stencil_side(value: &Json) -> Read<StencilSide> {
    let fields = value.object(&["fail", "depth_fail", "pass"])?;
    let operation = |name: &str| fields.or(name, StencilOperation::Keep, |value| value.named(&STENCIL_OPERATIONS));
    Ok(StencilSide { fail: operation("fail")?, depth_fail: operation("depth_fail")?, pass: operation("pass")? })
}

/// The shadow bit of a scene.
pub(super) fn shadow(value: &Json) -> Read<Shadow> {
    let plain = Shadow::default();
    let fields = value.object(&["function", "reference", "read_mask", "intensity"])?;
    Ok(Shadow {
        function: fields.or("function", plain.function, |value| value.named(&STENCIL_FUNCTIONS))?,
        reference: fields.or("reference", plain.reference, byte)?,
        read_mask: fields.or("read_mask", plain.read_mask, byte)?,
        intensity: fields.or("intensity", plain.intensity, byte)?,
    })
}

fn byte(value: &Json) -> Read<u8> {
    value.whole(0..=255).map(|value| value as u8)
}

fn texture(value: &Json) -> Read<Texture> {
    let fields = value.object(&[
        "file", "format", "function", "colour", "filter", "mip_map", "bias", "offset", "size", "repeat", "mirror",
        "palette",
    ])?;
    let plain = Texture::named(fields.required("file", Json::file_name)?.to_owned());
    let filter = fields.or("filter", plain.filter, |value| value.named(TextureFilter::NAMED))?;
    let palette = fields.optional("palette", |value| value.list("colours", 1..=256, Json::colour))?;
    let format = fields.optional("format", |value| value.named(&TEXTURE_FORMATS))?;
    Ok(Texture {
        format: format_for(format, palette.as_deref()).map_err(|fault| fault.in_field("palette"))?,
        function: fields.or("function", plain.function, |value| value.named(&TEXTURE_FUNCTIONS))?,
        colour: fields.or("colour", plain.colour, Json::colour)?,
        filter,
        mip_map: fields.or("mip_map", filter == TextureFilter::Trilinear, Json::flag)?,
        bias: fields.or("bias", plain.bias, |value| value.number(BIASES))?,
        offset: fields.or("offset", plain.offset, |value| texels(value, 0))?,
        size: fields.optional("size", |value| texels(value, 1))?,
        repeat: flags(&fields, "repeat")?,
        mirror: flags(&fields, "mirror")?,
        palette,
        ..plain
    })
}

/// The format that is asked for, else the smallest that has room for the palette.
fn format_for(asked: Option<TextureFormat>, palette: Option<&[Colour]>) -> Read<TextureFormat> {
    let count = palette.map_or(0, <[Colour]>::len);
    let smallest = match count {
        0 => TextureFormat::Rgba8888,
        1..=16 => TextureFormat::Palette4,
        _ => TextureFormat::Palette8,
    };
    let format = asked.unwrap_or(smallest);
    match format.palette() as usize {
        most if count <= most => Ok(format),
        0 => Err(Fault::new(format!("no palette with the format \"{}\"", format.name()), format!("{count} colours"))),
        most => {
            Err(Fault::new(format!("at most {most} colours with the format \"{}\"", format.name()), format!("{count}")))
        }
    }
}

fn texels(value: &Json, least: u32) -> Read<[u32; 2]> {
    value.array("whole numbers", |side| side.whole(least..=MAX_PICTURE_SIDE))
}

fn flags(fields: &Object<'_>, name: &str) -> Read<[bool; 2]> {
    fields.or(name, [false; 2], |value| value.array("flags, for x and y", Json::flag))
}
