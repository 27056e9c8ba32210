//! Tests of the sub-pixel mask unit.
//!
//! | file | what is tested |
//! | --- | --- |
//! | `grid` | samples, bits and places against the manual's numbers |
//! | `hide` | what chunks that one piece covers from top to bottom of a band leave to be done |
//! | `inside` | edges that are shared, and pixels inside a surface, against the specification |
//! | `lists` | order, limits and room of lists |
//! | `rows` | bounds of the depths of a chunk against those of its pixels |
//! | `scene` | what a scene takes, and by which rule its opaque fragments are ordered |
//! | `search` | bands, ends and steps against the definition; start corners; where the search is exact, and where not |
//! | `search_clocked` | registers and clocks against the functional search |
//! | `walk` | what rows of samples meet and cover, and masks, against edge functions |

mod grid;
mod hide;
mod inside;
mod lists;
mod rows;
mod scene;
mod search;
mod search_clocked;
mod walk;

use super::Setting;
use super::grid::Grid;
use super::scene::Rule;
use fearless_simd::Level;
use zga_abi::format::{DepthFormat, SubpixelDepth, SubpixelEdges, SubpixelResolve};

/// A setting of the default depths, where the nearest is seen.
fn setting(grid: Grid, size: [u32; 2]) -> Setting {
    Setting {
        grid,
        pitch: [8 - grid.columns().ilog2(), 8 - grid.rows().ilog2()],
        depth: SubpixelDepth::Search,
        resolve: SubpixelResolve::Values,
        clocked: false,
        pool: 1 << 20,
        edges: SubpixelEdges::All,
        format: DepthFormat::default(),
        rule: Rule::Nearest,
        size,
    }
}

/// The SIMD levels below the best one of this host.
pub(super) fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let below = [best.as_avx2().map(Level::Avx2), best.as_sse4_2().map(Level::Sse4_2), best.as_sse2().map(Level::Sse2)];
    #[cfg(not(target_arch = "x86_64"))]
    let below = [best.is_fallback().then_some(best)];
    below.into_iter().flatten().collect()
}
