//! Primitives compressed with Draco: the glTF extension KHR_draco_mesh_compression.
//!
//! Duties: finds the compressed bytes of a primitive, has `draco-core` decode them, and hands out the decoded rows in
//! place of the accessors' own. Inputs from: [`Buffers`]. Outputs to: the glTF loader.
//!
//! The decoder is given ceilings that follow from what the accessors state, so no stream can make more of itself than
//! the file says; what comes out is compared with the accessors before it is used. `draco-core` forbids itself unsafe
//! code and answers damage with errors, so nothing is caught here that it might throw.

use draco_core::{DecodeLimits, DecoderBuffer, MeshDecoder};
use gltf::json::Value;

use super::accessor::{Buffers, normalised};
use crate::limits::{MAX_FILE_BYTES, MAX_MESH_INDICES, MAX_MESH_VERTICES};

/// The extension's name.
pub(super) const EXTENSION: &str = "KHR_draco_mesh_compression";

type Read<T> = Result<T, String>;

/// Where the vertices of a primitive come from.
pub(super) struct Vertices<'a> {
    primitive: &'a gltf::Primitive<'a>,
    buffers: &'a Buffers,
    compressed: Option<Compressed>,
}

/// A decoded primitive.
struct Compressed {
    mesh: draco_core::Mesh,
    /// Names of attributes in the file and their numbers in the stream.
    attributes: Vec<(String, u32)>,
}

impl<'a> Vertices<'a> {
    /// The vertices of a primitive; decoded here if they are compressed.
    pub(super) fn of(
        primitive: &'a gltf::Primitive<'a>,
        document: &gltf::Document,
        buffers: &'a Buffers,
    ) -> Read<Vertices<'a>> {
        let compressed = match primitive.extension_value(EXTENSION) {
            Some(value) => Some(
                Compressed::decode(value, primitive, document, buffers)
                    .map_err(|reason| format!("{EXTENSION}: {reason}"))?,
            ),
            None => None,
        };
        Ok(Vertices { primitive, buffers, compressed })
    }

    /// Whether the primitive was compressed: then its indices are a list of triangles, whatever its mode.
    pub(super) fn are_compressed(&self) -> bool {
        self.compressed.is_some()
    }

    /// The accessor of an attribute.
    pub(super) fn accessor(&self, semantic: &gltf::Semantic) -> Option<gltf::Accessor<'a>> {
        self.primitive.get(semantic)
    }

    /// The numbers of an attribute as rows of `components`; `what` begins every message.
    pub(super) fn rows(&self, semantic: &gltf::Semantic, components: usize, what: &str) -> Read<Vec<f64>> {
        let accessor = self.accessor(semantic).ok_or_else(|| format!("has no {what}"))?;
        let name = semantic.to_string();
        let numbered = |compressed: &'_ Compressed| {
            compressed.attributes.iter().find(|(known, _)| *known == name).map(|(_, number)| *number)
        };
        match &self.compressed {
            Some(compressed) if numbered(compressed).is_some() => {
                let number = numbered(compressed).unwrap_or_default();
                compressed.rows(number, &accessor, components).map_err(|reason| format!("{EXTENSION}: {what} {reason}"))
            }
            // The extension may leave an attribute to its accessor.
            _ => self.buffers.rows(&accessor, components, what),
        }
    }

    /// The indices, if the primitive has any.
    pub(super) fn indices(&self) -> Option<Read<Vec<f64>>> {
        match &self.compressed {
            Some(compressed) => Some(Ok(compressed.indices())),
            None => self.primitive.indices().map(|accessor| self.buffers.rows(&accessor, 1, "indices")),
        }
    }
}

impl Compressed {
    fn decode(
        value: &Value,
        primitive: &gltf::Primitive<'_>,
        document: &gltf::Document,
        buffers: &Buffers,
    ) -> Read<Compressed> {
        let number = |value: &Value| value.as_u64().and_then(|number| u32::try_from(number).ok());
        let view = value.get("bufferView").and_then(number).ok_or("bufferView is not a number")?;
        let view = document.views().nth(view as usize).ok_or_else(|| format!("bufferView {view} does not exist"))?;
        let named = value.get("attributes").and_then(Value::as_object).ok_or("attributes is not an object")?;
        let mut attributes = Vec::new();
        for (name, value) in named {
            let number = number(value).ok_or_else(|| format!("attributes.{name} is not a number"))?;
            attributes.push((name.clone(), number));
        }
        let points = primitive.get(&gltf::Semantic::Positions).ok_or("the primitive has no positions")?.count();
        // The specification lets the accessor of the indices state how many there are.
        let corners = primitive.indices().map_or(MAX_MESH_INDICES, |accessor| accessor.count());
        if points > MAX_MESH_VERTICES || corners > MAX_MESH_INDICES {
            return Err(format!("{points} vertices and {corners} indices are too many"));
        }
        let limits = DecodeLimits::default()
            .with_max_points(points as u64)
            .with_max_faces(corners as u64 / 3)
            .with_max_decoded_bytes(MAX_FILE_BYTES);
        let bytes = buffers.view(&view)?;
        let mut mesh = draco_core::Mesh::new();
        MeshDecoder::new()
            .decode(&mut DecoderBuffer::new(bytes).with_limits(limits), &mut mesh)
            .map_err(|fault| fault.to_string())?;
        if mesh.num_points() != points {
            return Err(format!("holds {} vertices, the accessors say {points}", mesh.num_points()));
        }
        if primitive.indices().is_some() && mesh.num_faces() * 3 != corners {
            return Err(format!("holds {} indices, the accessor says {corners}", mesh.num_faces() * 3));
        }
        Ok(Compressed { mesh, attributes })
    }

    fn rows(&self, number: u32, accessor: &gltf::Accessor<'_>, components: usize) -> Read<Vec<f64>> {
        let attribute = self.mesh.attribute_by_unique_id(number);
        let attribute = attribute.ok_or_else(|| format!("name attribute {number}, which is not in the stream"))?;
        let (found, stated) = (usize::from(attribute.num_components()), accessor.dimensions().multiplicity());
        if found != components || stated != components {
            return Err(format!("have {found} components ({stated} in the accessor), expected {components}"));
        }
        let points = self.mesh.num_points();
        if accessor.count() != points {
            return Err(format!("have {points} rows, the accessor says {}", accessor.count()));
        }
        let kind = accessor.normalized().then_some(accessor.data_type());
        let values = attribute.read_f32s(points, components);
        Ok(values.into_iter().map(|value| normalised(f64::from(value), kind)).collect())
    }

    fn indices(&self) -> Vec<f64> {
        self.mesh.faces().iter().flatten().map(|point| f64::from(point.0)).collect()
    }
}
