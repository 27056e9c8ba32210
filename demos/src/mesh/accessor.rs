//! Numbers out of the buffers of a glTF file, with every offset checked before it is used.
//!
//! The `gltf` crate checks the structure of the document (indices between its lists); how long the buffers really are
//! is checked here, in arithmetic that cannot overflow.

use std::path::Path;

use gltf::accessor::sparse::IndexType;
use gltf::accessor::{Accessor, DataType};
use gltf::buffer::{Source, View};

use crate::limits::{self, MAX_MESH_INDICES, MAX_MESH_VERTICES};

/// Most items of an accessor that begins as zeros.
const MAX_ITEMS_WITHOUT_VIEW: usize = 1 << 20;

type Read<T> = Result<T, String>;

/// The buffers of a document.
pub(super) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Reads all buffers: the binary chunk, data URIs and files beside `folder`.
    pub(super) fn load(document: &gltf::Document, blob: Option<Vec<u8>>, folder: &Path) -> Read<Self> {
        let mut blob = blob;
        let mut all = Vec::new();
        let mut total = 0_u64;
        for buffer in document.buffers() {
            let index = buffer.index();
            let bytes = match buffer.source() {
                Source::Bin => blob.take().ok_or_else(|| format!("buffer {index}: the file has no binary chunk")),
                Source::Uri(uri) => from_uri(uri, folder).map_err(|reason| format!("buffer {index}: {reason}")),
            }?;
            if bytes.len() < buffer.length() {
                let (found, expected) = (bytes.len(), buffer.length());
                return Err(format!("buffer {index}: has {found} bytes, expected {expected}"));
            }
            total += bytes.len() as u64;
            if total > limits::MAX_FILE_BYTES {
                return Err(format!("the buffers have more than {} bytes", limits::MAX_FILE_BYTES));
            }
            all.push(bytes);
        }
        Ok(Self(all))
    }

    /// All bytes of a view.
    pub(super) fn view(&self, view: &View<'_>) -> Read<&[u8]> {
        let buffer = view.buffer().index();
        let past = || format!("buffer view {} reaches past the end of buffer {buffer}", view.index());
        let end = view.offset().checked_add(view.length()).ok_or_else(past)?;
        self.0.get(buffer).and_then(|bytes| bytes.get(view.offset()..end)).ok_or_else(past)
    }

    /// The bytes of a view from `offset` on, at least as many as `count` items of `size` bytes, `stride` apart, need.
    fn items(&self, view: &View<'_>, offset: usize, count: usize, size: usize, stride: usize) -> Read<&[u8]> {
        let bytes = self.view(view)?;
        let needed = count
            .checked_sub(1)
            .map_or(Some(0), |steps| steps.checked_mul(stride).and_then(|bytes| bytes.checked_add(size)));
        let end = needed.and_then(|needed| needed.checked_add(offset)).filter(|end| *end <= bytes.len());
        let range = end.and_then(|end| bytes.get(offset..end));
        range.ok_or_else(|| format!("needs more bytes than buffer view {} has", view.index()))
    }

    /// Reads an accessor as rows of `components` numbers. Normalised integers become 0..=1 or -1..=1; other integers
    /// stay what they are, exactly. `what` begins every message.
    pub(super) fn rows(&self, accessor: &Accessor<'_>, components: usize, what: &str) -> Read<Vec<f64>> {
        let fault = |reason: String| format!("{what} (accessor {}): {reason}", accessor.index());
        let found = accessor.dimensions().multiplicity();
        if found != components {
            return Err(fault(format!("has {found} components, expected {components}")));
        }
        let count = accessor.count();
        // Without a view no byte of the file stands behind the count.
        let most = match (accessor.view(), components) {
            (None, _) => MAX_ITEMS_WITHOUT_VIEW,
            (Some(_), 1) => MAX_MESH_INDICES,
            (Some(_), _) => MAX_MESH_VERTICES,
        };
        if count > most {
            return Err(fault(format!("has {count} items, expected at most {most}")));
        }
        let layout = Layout { kind: accessor.data_type(), normalised: accessor.normalized(), components };
        let mut rows = match accessor.view() {
            Some(view) => self.read(&view, accessor.offset(), count, layout).map_err(fault)?,
            None => vec![0.0; count * components],
        };
        if let Some(sparse) = accessor.sparse() {
            let changed = sparse.count();
            let kind = match sparse.indices().index_type() {
                IndexType::U8 => DataType::U8,
                IndexType::U16 => DataType::U16,
                IndexType::U32 => DataType::U32,
            };
            let places = Layout { kind, normalised: false, components: 1 };
            let (indices, values) = (sparse.indices(), sparse.values());
            let places = self.read(&indices.view(), indices.offset(), changed, places).map_err(fault)?;
            let values = self.read(&values.view(), values.offset(), changed, layout).map_err(fault)?;
            for (place, value) in places.iter().zip(values.chunks_exact(components)) {
                let start = *place as usize * components;
                let row = rows.get_mut(start..start + components);
                row.ok_or_else(|| fault(format!("changes item {place} of {count}")))?.copy_from_slice(value);
            }
        }
        Ok(rows)
    }

    fn read(&self, view: &View<'_>, offset: usize, count: usize, layout: Layout) -> Read<Vec<f64>> {
        let size = layout.kind.size() * layout.components;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(format!("has a stride of {stride} bytes, expected at least {size}"));
        }
        let bytes = self.items(view, offset, count, size, stride)?;
        let mut numbers = Vec::with_capacity(count * layout.components);
        for item in bytes.chunks(stride).take(count) {
            let row = item.get(..size).unwrap_or_default();
            numbers.extend(row.chunks_exact(layout.kind.size()).map(|bytes| layout.number(bytes)));
        }
        Ok(numbers)
    }
}

#[derive(Clone, Copy)]
struct Layout {
    kind: DataType,
    normalised: bool,
    components: usize,
}

impl Layout {
    /// One little-endian number.
    fn number(self, bytes: &[u8]) -> f64 {
        let value = match (self.kind, bytes) {
            (DataType::I8, [a]) => f64::from(i8::from_le_bytes([*a])),
            (DataType::U8, [a]) => f64::from(*a),
            (DataType::I16, [a, b]) => f64::from(i16::from_le_bytes([*a, *b])),
            (DataType::U16, [a, b]) => f64::from(u16::from_le_bytes([*a, *b])),
            (DataType::U32, [a, b, c, d]) => f64::from(u32::from_le_bytes([*a, *b, *c, *d])),
            (DataType::F32, [a, b, c, d]) => f64::from(f32::from_le_bytes([*a, *b, *c, *d])),
            _ => 0.0,
        };
        normalised(value, self.normalised.then_some(self.kind))
    }
}

/// A number of a normalised kind as 0..=1 or -1..=1; any number as it is where there is no kind.
pub(super) fn normalised(value: f64, kind: Option<DataType>) -> f64 {
    let greatest = match kind {
        None | Some(DataType::F32) => return value,
        Some(DataType::I8) => f64::from(i8::MAX),
        Some(DataType::U8) => f64::from(u8::MAX),
        Some(DataType::I16) => f64::from(i16::MAX),
        Some(DataType::U16) => f64::from(u16::MAX),
        Some(DataType::U32) => f64::from(u32::MAX),
    };
    (value / greatest).max(-1.0)
}

/// The bytes that a URI stands for: a data URI or a file beside the document.
pub(super) fn from_uri(uri: &str, folder: &Path) -> Read<Vec<u8>> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or_else(|| "a data URI without a comma".to_owned())?;
        return match kind.strip_suffix(";base64") {
            Some(_) => base64(text).ok_or_else(|| "a data URI that is not base64".to_owned()),
            None => percent_decoded(text).ok_or_else(|| "a data URI with a bad escape".to_owned()),
        };
    }
    if uri.contains("://") {
        return Err(format!("the URI {uri:?} is not a file beside this one"));
    }
    let name = percent_decoded(uri).and_then(|bytes| String::from_utf8(bytes).ok());
    let name = name.ok_or_else(|| format!("the URI {uri:?} has a bad escape"))?;
    limits::read_file(&folder.join(name)).map_err(|fault| fault.to_string())
}

fn percent_decoded(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        if *first == b'%' {
            let digits = std::str::from_utf8(after.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    Some(bytes)
}

/// Decodes base64 (RFC 4648), with or without padding.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=');
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    let (mut bits, mut held) = (0_u32, 0_u32);
    for byte in text.bytes() {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
        }
        bits &= (1 << held) - 1;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_known_texts_decode() {
        assert_eq!(base64("AAECAw==").as_deref(), Some(&[0, 1, 2, 3][..]));
        assert_eq!(base64("//79").as_deref(), Some(&[255, 254, 253][..]));
        assert_eq!(base64("A*"), None);
    }

    #[test]
    fn percent_decoded_escapes_and_bad_ones() {
        assert_eq!(percent_decoded("a%20b").as_deref(), Some(&b"a b"[..]));
        assert_eq!(percent_decoded("a%2"), None);
        assert_eq!(percent_decoded("a%zz"), None);
    }
}
