//! The draw list of a scene file.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use super::json::{ANY, Fault, Json, Object, Read, quoted};
use super::{Colours, Curve, CurveKind, DEFAULT_SLOPE, Decal, Draw, IDENTITY, Material, MeshDraw, Primitives, wide};

/// Steepest slope of a decal, either way; far above what any picture needs.
const MAX_SLOPE: f32 = 65536.0;

/// Most surfaces that a decal is fitted to.
const MAX_SURFACES: usize = 65_536;

/// Narrowest and widest line, least and greatest side of a point, in pixels: 1 and 65535 steps of 1/256.
const EXTENTS: RangeInclusive<f32> = 1.0 / 256.0..=65_535.0 / 256.0;

/// What a draw may refer to, and where it stands.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) materials: &'a BTreeMap<String, Material>,
    /// Positions are pixels and depth, so depth has a range.
    pub(super) in_pixels: bool,
    pub(super) inside_decal: bool,
    /// That decal is fitted to surfaces.
    pub(super) inside_fitted: bool,
}

/// Vertices of one primitive, and what a list of them is called.
#[derive(Clone, Copy)]
struct Kind {
    corners: usize,
    name: &'static str,
    fields: &'static [&'static str],
    /// Field with the width or side of what is drawn, if it has one.
    extent: Option<&'static str>,
}

/// Fields that all of them have.
const FIELDS: [&str; 8] =
    ["vertices", "indices", "colours", "per", "normals", "texture_coordinates", "material", "tag"];
const TRIANGLES: Kind = Kind { corners: 3, name: "triangles", fields: &FIELDS, extent: None };
const LINES: Kind = Kind { corners: 2, name: "lines", fields: &fields_and("width"), extent: Some("width") };
const POINTS: Kind = Kind { corners: 1, name: "points", fields: &fields_and("size"), extent: Some("size") };

const fn fields_and(last: &'static str) -> [&'static str; 9] {
    let [a, b, c, d, e, f, g, h] = FIELDS;
    [a, b, c, d, e, f, g, h, last]
}

/// Reads a draw list.
pub(super) fn draws(value: &Json, context: Context<'_>) -> Read<Vec<Draw>> {
    value.list("draws", 0..=usize::MAX, |value| draw(value, context))
}

fn draw(value: &Json, context: Context<'_>) -> Read<Draw> {
    let (kind, value) = value.tagged(&["triangles", "lines", "points", "curve", "decal", "mesh"])?;
    let read = match kind {
        "triangles" => primitives(value, context, TRIANGLES).map(Draw::Triangles),
        "lines" => primitives(value, context, LINES).map(Draw::Lines),
        "points" => primitives(value, context, POINTS).map(Draw::Points),
        "curve" => curve(value, context).map(Draw::Curve),
        "decal" => decal(value, context).map(Draw::Decal),
        _ if context.inside_fitted => {
            Err(Fault::new("a draw that is no mesh, because the decal it is in has surfaces", "a mesh"))
        }
        _ => mesh(value, context).map(Draw::Mesh),
    };
    read.map_err(|fault| fault.in_field(kind))
}

fn primitives(value: &Json, context: Context<'_>, kind: Kind) -> Read<Primitives> {
    let fields = value.object(kind.fields)?;
    let vertices = fields.required("vertices", |value| positions(value, context))?;
    let last = vertices.len().saturating_sub(1);
    let indices = fields.optional("indices", |value| {
        let indices = value.list("indices", 0..=usize::MAX, |index| {
            let index = index.whole(0..=u32::MAX)?;
            if (index as usize) < vertices.len() {
                Ok(index)
            } else {
                Err(Fault::new(format!("the index of a vertex, 0..={last}"), index.to_string()))
            }
        })?;
        whole_primitives(indices.len(), kind)?;
        Ok(indices)
    })?;
    let corners = indices.as_ref().map_or(vertices.len(), Vec::len);
    if indices.is_none() {
        whole_primitives(corners, kind).map_err(|fault| fault.in_field("vertices"))?;
    }
    let faces = (kind.corners == 3).then_some(corners / 3);
    Ok(Primitives {
        colours: colours(&fields, vertices.len(), faces)?,
        normals: fields.optional("normals", |value| one_for_each(value, "normals", vertices.len(), Json::numbers))?,
        texture_coordinates: fields.optional("texture_coordinates", |value| {
            one_for_each(value, "texture coordinates", vertices.len(), Json::numbers)
        })?,
        material: material(&fields, context)?,
        tag: tag(&fields)?,
        extent: kind.extent.map_or(Ok(None), |name| extent(&fields, name))?,
        vertices,
        indices,
    })
}

/// Refuses a list that ends inside a primitive.
fn whole_primitives(count: usize, kind: Kind) -> Read<()> {
    if count.is_multiple_of(kind.corners) {
        return Ok(());
    }
    let expected = format!("{} entries for each of the {}", kind.corners, kind.name);
    Err(Fault::new(expected, format!("a list of {count}")))
}

fn positions(value: &Json, context: Context<'_>) -> Read<Vec<[f32; 3]>> {
    value.list("positions", 0..=usize::MAX, |value| {
        let position: [f32; 3] = value.numbers()?;
        if context.in_pixels && !(0.0..=1.0).contains(&position[2]) {
            let fault = Fault::new("a depth in 0..=1, because the camera is screen", position[2].to_string());
            return Err(fault.in_item(2));
        }
        Ok(position)
    })
}

fn one_for_each<T>(value: &Json, what: &str, vertices: usize, read: impl Fn(&Json) -> Read<T>) -> Read<Vec<T>> {
    let items = value.list(what, 0..=usize::MAX, read)?;
    if items.len() == vertices {
        return Ok(items);
    }
    Err(Fault::new(format!("{vertices} {what}, one for each vertex"), format!("a list of {}", items.len())))
}

/// `colours` and `per`; `faces` is the number of triangles where colours by face are possible.
fn colours(fields: &Object<'_>, vertices: usize, faces: Option<usize>) -> Read<Colours> {
    let per_face = fields.or("per", false, |value| match faces {
        Some(_) => value.named(&[("vertex", false), ("face", true)]),
        None => value.named(&[("vertex", false)]),
    })?;
    let Some(list) = fields.optional("colours", |value| value.list("colours", 1..=usize::MAX, Json::colour))? else {
        return Ok(Colours::default());
    };
    let (wanted, of_what) = match faces {
        Some(faces) if per_face => (faces, "triangle"),
        _ => (vertices, "vertex"),
    };
    match list.len() {
        count if count == wanted && per_face => Ok(Colours::PerFace(list)),
        1 => Ok(Colours::One(list[0])),
        count if count == wanted => Ok(Colours::PerVertex(list)),
        count => {
            let expected = format!("1 colour for all, or {wanted}, one for each {of_what}");
            Err(Fault::new(expected, format!("a list of {count}")).in_field("colours"))
        }
    }
}

fn material(fields: &Object<'_>, context: Context<'_>) -> Read<Option<String>> {
    fields.optional("material", |value| {
        let name = value.text()?;
        if context.materials.contains_key(name) {
            return Ok(name.to_owned());
        }
        let known: Vec<String> = context.materials.keys().take(8).map(|name| quoted(name)).collect();
        let expected = match &known[..] {
            [] => "the name of a material, but the scene has none".to_owned(),
            known => format!("the name of a material of the scene ({})", known.join(", ")),
        };
        Err(Fault::new(expected, quoted(name)))
    })
}

fn tag(fields: &Object<'_>) -> Read<Option<u32>> {
    fields.optional("tag", |value| value.whole(0..=u32::MAX))
}

/// A width or side in pixels.
fn extent(fields: &Object<'_>, name: &str) -> Read<Option<f32>> {
    fields.optional(name, |value| value.number(EXTENTS))
}

fn slope(fields: &Object<'_>) -> Read<f32> {
    fields.or("slope", DEFAULT_SLOPE, |value| value.number(-MAX_SLOPE..=MAX_SLOPE))
}

fn curve(value: &Json, context: Context<'_>) -> Read<Curve> {
    const KINDS: [(&str, CurveKind); 3] =
        [("polyline", CurveKind::Polyline), ("quadratic", CurveKind::Quadratic), ("cubic", CurveKind::Cubic)];
    let fields =
        value.object(&["polyline", "quadratic", "cubic", "colours", "per", "tolerance", "width", "material", "tag"])?;
    let mut given = KINDS.iter().filter(|(name, _)| fields.get(name).is_some());
    let (Some((name, kind)), None) = (given.next(), given.next()) else {
        return Err(Fault::new("exactly one of polyline, quadratic, cubic", value.describe()));
    };
    let points = fields.required(name, |value| {
        let points = positions(value, context)?;
        let segment = kind.points_per_segment();
        let fits = match kind {
            CurveKind::Polyline => points.len() >= segment,
            _ => !points.is_empty() && points.len().is_multiple_of(segment),
        };
        if fits {
            return Ok(points);
        }
        let expected = match kind {
            CurveKind::Polyline => "at least 2 points".to_owned(),
            _ => format!("{segment} control points for each segment"),
        };
        Err(Fault::new(expected, format!("a list of {}", points.len())))
    })?;
    Ok(Curve {
        kind: *kind,
        colours: colours(&fields, points.len(), None)?,
        points,
        tolerance: fields.or("tolerance", 0.25, |value| value.number(0.001..=1000.0))?,
        width: extent(&fields, "width")?,
        material: material(&fields, context)?,
        tag: tag(&fields)?,
    })
}

fn decal(value: &Json, context: Context<'_>) -> Read<Decal> {
    if context.inside_decal {
        return Err(Fault::new("a draw that is no decal, because this one is inside a decal", "a decal"));
    }
    let fields = value.object(&["slope", "surfaces", "draw"])?;
    let surfaces = fields.or("surfaces", Vec::new(), |value| value.list("triangles", 1..=MAX_SURFACES, surface))?;
    let fitted = !surfaces.is_empty();
    let slope = match fitted {
        false => slope(&fields)?,
        // A limit has no direction.
        true => fields.or("slope", DEFAULT_SLOPE, |value| value.number(0.0..=MAX_SLOPE))?,
    };
    let inside = Context { inside_decal: true, inside_fitted: fitted, ..context };
    let draw = fields.required("draw", |value| draws(value, inside))?;
    Ok(Decal { slope, surfaces, draw })
}

/// A triangle with a plane.
fn surface(value: &Json) -> Read<[[f32; 3]; 3]> {
    let corners: [[f32; 3]; 3] = value.array("corners", Json::numbers)?;
    let [a, b, c] = corners.map(wide);
    match (b - a).cross(c - a) == glam::DVec3::ZERO {
        false => Ok(corners),
        true => Err(Fault::new("three corners that do not lie on a line", "corners on a line")),
    }
}

fn mesh(value: &Json, context: Context<'_>) -> Read<MeshDraw> {
    let fields = value.object(&["file", "transform", "material", "colours", "edges", "slope", "edge_colour", "tag"])?;
    let file = fields.required("file", |value| {
        let name = value.file_name()?;
        let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
        match ending.as_deref() {
            Some("obj" | "gltf" | "glb") => Ok(PathBuf::from(name)),
            _ => Err(Fault::new("a file name ending in .obj, .gltf or .glb", quoted(name))),
        }
    })?;
    let colour = fields.optional("colours", |value| value.array("colour for all", Json::colour))?;
    Ok(MeshDraw {
        file,
        transform: fields.or("transform", IDENTITY, |value| value.array("numbers", |item| item.number(ANY)))?,
        material: material(&fields, context)?,
        colour: colour.map(|[colour]: [[u8; 4]; 1]| colour),
        edges: fields.or("edges", false, Json::flag)?,
        slope: slope(&fields)?,
        edge_colour: fields.or("edge_colour", [20, 24, 36, 255], Json::colour)?,
        tag: tag(&fields)?,
        mesh: None,
    })
}
