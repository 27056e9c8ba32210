//! The sub-pixel mask unit: anti-aliasing that costs only where edges are.
//!
//! Source: JP 2569952 B2 (1990).
//!
//! The hidden-surface path draws a scene with a grid as ever, one sample at each pixel's centre. At END_SCENE this unit
//! overwrites the pixels that are *active*. Opaque fragments that together cover every sample of a pixel hide what lies
//! behind the farthest of them; a pixel is active if more than one fragment is left, unless all that are have one colour
//! and those that hide the rest cover the centre too. All other pixels keep what the path drew, which is the same. So
//! every path gives one picture, and a pixel inside a triangle costs nothing here.
//!
//! SUBPIXEL_EDGES says whether that goes for pixels inside a *surface* too: with `borders`, where triangles that share
//! vertices in all that these say cover a pixel together and no other edge passes between its samples, it keeps the one
//! sample of the path instead of the mean of what they show; that mean differs from it by how much their colours bend
//! there. Outlines, creases, seams and layers are the same.
//!
//! | file | part |
//! | --- | --- |
//! | [`grid`] | samples of a pixel, bits of a mask |
//! | [`scene`] | what is drawn, taken while the path draws it |
//! | [`edges`] | edges that two triangles of one surface share |
//! | `inside` | pixels inside a surface, in which no fragment is looked for |
//! | `sheet` | triangles of a tile: how often each side of them covers its pixels, and which is nearer |
//! | `slant` | their depths, near enough |
//! | `looked` | the pixels of a band in which fragments are looked for |
//! | [`piece`] | an item set up for a band of lines: edges, depth bounds, depths at samples |
//! | `bands` | items sorted into bands of lines |
//! | [`band`] | a band from items to resolved pixels, from the nearest item to the farthest |
//! | `cover` | what an item covers, row by row |
//! | `walk` | its edges on rows of samples: which pixels it meets, masks |
//! | `rows` | its rows: what of them is seen, and hides |
//! | `runs` | what it covers in part becomes fragments |
//! | `hide` | what is hidden already, and by what covers whole pixels |
//! | `lists` | fragments by pixel, in bounded memory |
//! | `left` | what is left of them, and which pixels are active |
//! | [`specification`] | the same by definition, pixel by pixel |
//! | [`search`](mod@search) | the nearest or the farthest sub-pixel of a mask |
//! | [`search_clocked`] | the same as registers and clocks |
//! | `brief` | what is asked of a piece for every fragment |
//! | `finish` | the active pixels of a band, from their fragments to their colours |
//! | [`pixel`] | one pixel: its fragments are ordered, merged, packed |
//! | `parts` | which opaque fragment is seen at each sample |
//! | `compare` | depths of two planes at all samples of a pixel |
//! | `layers` | translucent fragments over them |
//! | `shares` | so many samples of one colour; the mean |
//! | `waiting` | pixels that wait for what colours decide: holes, layers |
//! | `queue` | what is asked at places, found piece by piece |
//! | `shader` | colours of fragments |
//! | [`gamma`] | linear light |
//! | [`unit`] | bands on threads; writes the frame |
//! | [`map`] | an instrument: which pixels were taken up, and why |
//!
//! # Clocks
//! 1 an edge that looks for another to share, 1 a mask (one for each fragment of an active pixel that covers a part of it,
//! or its centre alone, and one for each triangle, in which its edges begin), 1 a band of samples searched, 1 a depth
//! evaluated, 1 a merge, 1 a fragment packed, 1 an active pixel averaged and written; a colour is 1 clock of the shading
//! unit. Lists are written while masks are made.
//!
//! # Memory
//! The lists of one line of pixels lie in a pool of SUBPIXEL_POOL fragments of [`FRAGMENT_BYTES`] bytes. Pixels get
//! their lists from left to right; one whose list does not fit keeps the path's pixel, one sample, and is counted in
//! subpixel.pixels_degraded. Of the edges that have found none to share yet each takes [`EDGE_BYTES`], and what is known
//! of a primitive's edges one byte.

pub mod band;
mod bands;
mod brief;
mod compare;
mod cover;
pub mod edges;
mod finish;
pub mod gamma;
pub mod grid;
mod hide;
mod inside;
mod layers;
mod left;
mod lists;
mod looked;
pub mod map;
mod parts;
pub mod piece;
pub mod pixel;
mod queue;
mod rows;
mod runs;
pub mod scene;
pub mod search;
pub mod search_clocked;
mod shader;
mod shares;
mod sheet;
mod slant;
pub mod specification;
#[cfg(test)]
mod tests;
pub mod unit;
mod waiting;
mod walk;

use crate::probe::account::{Account, Clocks};
use crate::shading::pixel::ShadingCounts;
use grid::Grid;
use scene::{ItemDraw, Rule};
use zga_abi::Counter;
use zga_abi::format::{DepthFormat, Fidelity, SubpixelDepth, SubpixelEdges, SubpixelGrid, SubpixelResolve};
use zga_firmware::checked::Target;

/// Bytes of a fragment in the pool: its mask, its pixel, its primitive.
pub const FRAGMENT_BYTES: u64 = 16;
/// Bytes of an edge that waits for another to share: its key, its primitive.
pub const EDGE_BYTES: u64 = 8;

/// What all pixels of a scene share.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Samples of a pixel.
    pub grid: Grid,
    /// log2 of the distance of samples in x and y, u.
    pub pitch: [u32; 2],
    /// How fragments are ordered.
    pub depth: SubpixelDepth,
    /// Where samples are averaged.
    pub resolve: SubpixelResolve,
    /// Searches are stepped clock by clock.
    pub clocked: bool,
    /// Fragments of a line.
    pub pool: u32,
    /// Which edges are anti-aliased.
    pub edges: SubpixelEdges,
    /// Number format of depth.
    pub format: DepthFormat,
    /// From what the order of opaque fragments follows.
    pub rule: Rule,
    /// Width and height of the target.
    pub size: [u32; 2],
}

impl Setting {
    /// The setting of a scene on `target`; `None` without a grid.
    #[must_use]
    pub fn new(target: &Target, rule: Rule) -> Option<Setting> {
        let setting = target.subpixel?;
        let grid = match setting.grid {
            SubpixelGrid::Off => return None,
            SubpixelGrid::Grid4x4 => Grid::G4X4,
            SubpixelGrid::Grid8x4 => Grid::G8X4,
            SubpixelGrid::Grid8x8 => Grid::G8X8,
        };
        Some(Setting {
            grid,
            pitch: [8 - grid.columns().ilog2(), 8 - grid.rows().ilog2()],
            depth: setting.depth,
            resolve: setting.resolve,
            clocked: target.fidelity == Fidelity::Clocked,
            pool: setting.pool,
            edges: setting.edges,
            format: target.depth_format,
            rule,
            size: [target.colour.width, target.colour.height],
        })
    }
}

/// Events of the unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Masks made.
    pub masks: u64,
    /// Searches begun.
    pub searches: u64,
    /// Bands of samples that searches looked at.
    pub steps: u64,
    /// Depths evaluated at samples.
    pub evaluations: u64,
    /// Fragments merged with another of their tag.
    pub merges: u64,
    /// Fragments packed.
    pub packed: u64,
    /// Pixels taken up.
    pub active: u64,
    /// Fragments stored.
    pub fragments: u64,
    /// Pixels that the pool had no room for.
    pub degraded: u64,
    /// Most fragments of a line.
    pub most: u64,
    /// Edges that looked for another to share.
    pub edges: u64,
    /// Most bytes that edges took.
    pub edge_bytes: u64,
    /// Pixels shaded: colours interpolated, or taken through more.
    pub shaded: u64,
    /// What they cost beyond interpolated colours.
    pub shading: ShadingCounts,
}

impl crate::pipeline::bands::Counts for Counts {
    fn plus(self, other: Counts) -> Counts {
        Counts {
            masks: self.masks + other.masks,
            searches: self.searches + other.searches,
            steps: self.steps + other.steps,
            evaluations: self.evaluations + other.evaluations,
            merges: self.merges + other.merges,
            packed: self.packed + other.packed,
            active: self.active + other.active,
            fragments: self.fragments + other.fragments,
            degraded: self.degraded + other.degraded,
            most: self.most.max(other.most),
            edges: self.edges + other.edges,
            edge_bytes: self.edge_bytes.max(other.edge_bytes),
            shaded: self.shaded + other.shaded,
            shading: self.shading.plus(other.shading),
        }
    }
}

impl Counts {
    /// Adds what the colours of so many fragments of a draw cost.
    fn shade(&mut self, draw: &ItemDraw, fragments: u64) {
        if draw.is_shaded() {
            self.shaded += fragments;
        }
        if let Some(shading) = &draw.shading {
            self.shading = self.shading.plus(shading.pixel.cost().times(fragments));
        }
    }

    /// Clocks of the unit, without shading.
    #[must_use]
    pub fn clocks(&self) -> Clocks {
        Clocks(self.edges + self.masks + self.steps + self.evaluations + self.merges + self.packed + self.active)
    }
}

/// Charges the events of a scene.
pub fn charge(counts: &Counts, account: &mut Account) {
    account.add(Counter::SubpixelMasks, counts.masks);
    account.add(Counter::SubpixelSearches, counts.searches);
    account.add(Counter::SubpixelSearchSteps, counts.steps);
    account.add(Counter::SubpixelDepthEvaluations, counts.evaluations);
    account.add(Counter::SubpixelMerges, counts.merges);
    account.add(Counter::SubpixelPacked, counts.packed);
    account.add(Counter::SubpixelPixelsActive, counts.active);
    account.add(Counter::SubpixelFragments, counts.fragments);
    account.add(Counter::SubpixelPixelsDegraded, counts.degraded);
    account.maximum(Counter::SubpixelPoolPeakBytes, counts.most * FRAGMENT_BYTES);
    account.add(Counter::SubpixelEdges, counts.edges);
    account.maximum(Counter::SubpixelEdgePeakBytes, counts.edge_bytes);
    account.add(Counter::ColourWrites, counts.active);
    account.charge(Counter::CyclesSubpixel, counts.clocks());
    account.add(Counter::ShadingPixels, counts.shaded);
    account.charge(Counter::CyclesShading, Clocks(counts.shaded));
    counts.shading.charge(account);
}
