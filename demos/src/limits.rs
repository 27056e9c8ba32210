//! Bounds on what is read from files, so that no file can make the program take all the memory.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};

/// Largest file that is read, in bytes: a scene, a mesh, a buffer, a material library or a picture.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Most JSON values (numbers, texts, lists, objects) in one scene file.
pub const MAX_JSON_VALUES: usize = 24 << 20;

/// Widest and highest target, in pixels.
pub const MAX_TARGET_PIXELS_PER_SIDE: u32 = 16384;

/// Most vertices of one mesh, after its nodes are placed.
pub const MAX_MESH_VERTICES: usize = 16 << 20;

/// Most indices of one mesh, after strips, fans and polygons are cut into triangles.
pub const MAX_MESH_INDICES: usize = 48 << 20;

/// Widest and highest picture of a texture, in texels: what the card's registers can say.
pub const MAX_PICTURE_SIDE: u32 = 16384;

/// Most texels of one picture.
pub const MAX_PICTURE_TEXELS: u64 = 32 << 20;

/// Most texels of all pictures that one mesh or one scene file names.
pub const MAX_TEXELS: u64 = 64 << 20;

/// Reads a whole file, but no more than [`MAX_FILE_BYTES`].
///
/// # Errors
/// [`Error::Read`] when the system refuses, [`Error::TooLarge`] past the limit.
pub(crate) fn read_file(file: &Path) -> Result<Vec<u8>> {
    let fault = |reason| Error::Read { file: file.to_path_buf(), reason };
    let open = File::open(file).map_err(fault)?;
    let size = open.metadata().map_err(fault)?.len();
    let mut bytes = Vec::new();
    if size <= MAX_FILE_BYTES {
        // A device or a pipe states no size, so what arrives is bounded as well.
        open.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(fault)?;
    }
    let size = size.max(bytes.len() as u64);
    if size > MAX_FILE_BYTES {
        return Err(Error::TooLarge { file: file.to_path_buf(), bytes: size, limit: MAX_FILE_BYTES });
    }
    Ok(bytes)
}
