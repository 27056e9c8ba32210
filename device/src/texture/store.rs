//! Texture memory: textures that draws have called for, decoded, until their words change.
//!
//! Duties: decodes a texture when a draw first calls for it, and again only if somebody may have written to its words or
//! its palette. Inputs from: video memory, checked textures. Outputs to: [`crate::shading::pixel`]. Clocks: none; on the
//! card texels are decoded as they are read.
//!
//! At most [`MOST`] textures and [`KEPT`] bytes of texels are kept beyond the draw that uses them.

use super::Texture;
use crate::memory::VideoMemory;
use std::ops::Range;
use std::sync::Arc;
use zga_firmware::checked;

/// Most textures kept.
const MOST: usize = 32;
/// Most bytes of texels kept.
const KEPT: u64 = 256 << 20;

/// Textures kept; empty until a draw calls for one.
#[derive(Debug, Default)]
pub struct TextureStore {
    /// Oldest first. Each has two ranges among those that video memory watches: its own, and its palette's.
    kept: Vec<(checked::Texture, Arc<Texture>)>,
}

impl TextureStore {
    /// The texels of a texture; whether they were decoded for this.
    pub(crate) fn texels(&mut self, memory: &mut VideoMemory, texture: &checked::Texture) -> (Arc<Texture>, bool) {
        if let Some(place) = self.kept.iter().position(|(key, _)| key == texture) {
            if !memory.texels_are_stale(2 * place) && !memory.texels_are_stale(2 * place + 1) {
                return (Arc::clone(&self.kept[place].1), false);
            }
            self.forget(memory, place);
        }
        let decoded = Arc::new(Texture::decode(memory.words(), texture));
        while self.kept.len() >= MOST || (!self.kept.is_empty() && self.bytes() + decoded.bytes() > KEPT) {
            self.forget(memory, 0);
        }
        memory.keep_texels(words(texture.base, texture.bytes()));
        memory.keep_texels(words(texture.palette, 4 * u64::from(texture.format.palette())));
        self.kept.push((*texture, Arc::clone(&decoded)));
        (decoded, true)
    }

    /// Bytes of the texels kept.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.kept.iter().map(|(_, texture)| texture.bytes()).sum()
    }

    /// Gives its memory back.
    pub(crate) fn power_off(&mut self, memory: &mut VideoMemory) {
        while !self.kept.is_empty() {
            self.forget(memory, 0);
        }
        self.kept = Vec::new();
    }

    fn forget(&mut self, memory: &mut VideoMemory, place: usize) {
        self.kept.remove(place);
        memory.forget_texels(2 * place + 1);
        memory.forget_texels(2 * place);
    }
}

/// The words of `bytes` bytes from byte `base` on.
fn words(base: u32, bytes: u64) -> Range<usize> {
    let base = base as usize / 4;
    base..base + bytes.div_ceil(4) as usize
}
