//! All counters of the card, by the names and in the order of the manual.

use std::fmt;
use std::ops::Index;

/// Names, in the order of the COUNTERS registers.
pub const NAMES: [&str; 76] = [
    "cycles.total",
    "cycles.frontend",
    "cycles.geometry",
    "cycles.z_buffer",
    "cycles.shading",
    "cycles.bitmap",
    "cycles.scanout",
    "frontend.packets",
    "frontend.words",
    "frontend.fences",
    "geometry.vertices",
    "geometry.primitives",
    "geometry.clipped",
    "geometry.discarded",
    "z.spans",
    "z.reads",
    "z.writes",
    "colour.writes",
    "shading.pixels",
    "bitmap.pixels",
    "scanout.frames",
    "scanout.pixels",
    "probe.fragments",
    "cycles.za",
    "cycles.systolic",
    "cycles.tile",
    "za.clears",
    "za.words_written",
    "za.blocks_initialised",
    "za.blocks_bypassed",
    "za.pixels_bypassed",
    "za.blocks_compared",
    "za.blocks_settled",
    "scanout.background_blocks",
    "systolic.tokens",
    "systolic.clocks",
    "tile.visited",
    "tile.empty",
    "tile.links_walked",
    "tile.links_removed",
    "tile.sort_memory_bytes",
    "tile.fragments_not_stored",
    "cycles.subpixel",
    "subpixel.masks",
    "subpixel.searches",
    "subpixel.search_steps",
    "subpixel.depth_evaluations",
    "subpixel.merges",
    "subpixel.packed",
    "subpixel.pixels_active",
    "subpixel.fragments",
    "subpixel.pool_peak_bytes",
    "subpixel.pixels_degraded",
    "cycles.texture",
    "cycles.layers",
    "texture.texels",
    "texture.fetches",
    "texture.decoded_bytes",
    "texture.holes",
    "shading.lights",
    "shading.fogged",
    "layers.fragments",
    "layers.blended",
    "layers.sorted_pixels",
    "bitmap.combined",
    "bitmap.stretched",
    "stencil.tested",
    "stencil.failed",
    "stencil.shadowed",
    "scanout.cursor_pixels",
    "bitmap.entries",
    "bitmap.segment_pixels",
    "bitmap.expanded",
    "bitmap.composed",
    "subpixel.edges",
    "subpixel.edge_peak_bytes",
];

/// Values of all counters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Events(pub [u64; NAMES.len()]);

impl Index<&str> for Events {
    type Output = u64;

    fn index(&self, name: &str) -> &u64 {
        let place = NAMES.iter().position(|&other| other == name);
        &self.0[place.unwrap_or_else(|| panic!("no counter {name}"))]
    }
}

impl Events {
    /// Without those that depend on the way packets came: the front end's, and the sum over all units.
    #[must_use]
    pub fn of_units(mut self) -> Self {
        for (value, name) in self.0.iter_mut().zip(NAMES) {
            if name == "cycles.total" || name.contains("frontend") {
                *value = 0;
            }
        }
        self
    }

    /// Nothing counted.
    pub const NONE: Self = Self([0; NAMES.len()]);

    /// Counts of this and of `other` together.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(sum, count)| *sum += count);
        self
    }

    /// What differs from `other`: name, value here, value there.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<(&'static str, u64, u64)> {
        let values = NAMES.into_iter().zip(self.0).zip(other.0);
        values.filter(|((_, a), b)| a != b).map(|((name, a), b)| (name, a, b)).collect()
    }
}

impl fmt::Debug for Events {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(NAMES.iter().zip(self.0).filter(|(_, value)| *value > 0)).finish()
    }
}
