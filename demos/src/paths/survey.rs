//! Where in the picture a path works: maps of its own counters.
//!
//! The picture is divided into cells: blocks of the Za unit, lines of the systolic array, tiles. For each cell the scene
//! is drawn once more with its draws cut to the cell by the scissor, and the card's counters are read. Blocks, lines and
//! tiles do not depend on each other, so a cell's counts are exactly its share of the whole scene's; [`Survey::adds_up`]
//! compares their sum with the counters of the frame that was not cut. Where there are more than [`MOST_CELLS`], each
//! cell is several blocks, lines or tiles.
//!
//! | map | counter |
//! | --- | --- |
//! | reads | `z.reads` |
//! | initialised, bypassed, compared | `za.blocks_*` |
//! | lines | `systolic.tokens` |
//! | tiles | `tile.links_walked` less the polygons of the cell's row: what the lists of its tiles hold |

use zga_abi::Counter;
use zga_abi::format::{Fidelity, HiddenSurface};
use zga_driver::{Counters, Rectangle};

use crate::error::Result;
use crate::play::{Look, Session, Settings};
use crate::scene::Scene;

/// Most cells of a map.
pub const MOST_CELLS: u32 = 3072;
/// Bytes of the head of a list in the sort memory of the tile unit.
const HEAD_BYTES: u64 = 4;
/// Bytes of a polygon there.
const RECORD_BYTES: u64 = 72;

/// A map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    /// What is counted, in a word or two.
    pub name: &'static str,
    /// Width and height of a cell, pixels.
    pub cell: [u32; 2],
    /// Blocks, lines or tiles of a cell.
    pub units: u32,
    /// Cells in a row, rows of cells.
    pub cells: [u32; 2],
    /// A count for each cell, row by row from the top.
    pub values: Vec<u64>,
    /// The count of the whole frame, where the card has a counter for it.
    pub whole: Option<u64>,
}

impl Survey {
    /// The largest count of a cell.
    #[must_use]
    pub fn most(&self) -> u64 {
        self.values.iter().copied().max().unwrap_or(0)
    }

    /// Sum over all cells.
    #[must_use]
    pub fn sum(&self) -> u64 {
        self.values.iter().sum()
    }

    /// The cells' counts are together those of the frame.
    #[must_use]
    pub fn adds_up(&self) -> bool {
        self.whole.is_none_or(|whole| whole == self.sum())
    }

    /// The count of the cell that pixel (`x`, `y`) lies in; 0 outside.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> u64 {
        let [column, row] = [x / self.cell[0], y / self.cell[1]];
        let inside = column < self.cells[0] && row < self.cells[1];
        if inside { self.values.get((row * self.cells[0] + column) as usize).copied().unwrap_or(0) } else { 0 }
    }
}

/// Cells of whole units of `unit` pixels, at most `most`; `down` says whether several rows of units may be one.
fn cell(size: [u32; 2], unit: [u32; 2], down: bool, most: u32) -> [u32; 2] {
    let mut cell = unit;
    let count = |cell: [u32; 2]| u64::from(size[0].div_ceil(cell[0])) * u64::from(size[1].div_ceil(cell[1]));
    while count(cell) > u64::from(most) {
        // The shorter side grows, as far as that helps.
        let may = [cell[0] < size[0], down && cell[1] < size[1]];
        match may {
            [true, true] if cell[1] < cell[0] => cell[1] *= 2,
            [true, _] => cell[0] *= 2,
            [_, true] => cell[1] *= 2,
            _ => break,
        }
    }
    cell
}

/// Draws the scene whole, then cell by cell; `count` gets the counters of each and the place of the cell, none for the
/// whole.
fn survey(
    session: &mut Session,
    (scene, look): (&Scene, Look),
    settings: Settings,
    cell: [u32; 2],
    mut count: impl FnMut(Option<usize>, &Counters),
) -> Result<[u32; 2]> {
    let (size, before) = (session.size(), *session.settings());
    // Counts do not depend on the fidelity, and this one is faster.
    session.set(Settings { fidelity: Fidelity::Functional, ..settings })?;
    session.frame(scene, look)?;
    let (_, whole) = session.frame(scene, look)?;
    count(None, &whole.counters);
    let cells = [0, 1].map(|axis| size[axis].div_ceil(cell[axis]));
    for row in 0..cells[1] {
        for column in 0..cells[0] {
            let [x, y] = [column * cell[0], row * cell[1]];
            let area = Rectangle { x, y, right: (x + cell[0]).min(size[0]), bottom: (y + cell[1]).min(size[1]) };
            if let Some(counters) = session.cost_of(area)? {
                count(Some((row * cells[0] + column) as usize), &counters);
            }
        }
    }
    session.set(before)?;
    Ok(cells)
}

/// Maps of several counters at once.
fn maps<const N: usize>(
    session: &mut Session,
    drawn: (&Scene, Look),
    settings: Settings,
    unit: [u32; 2],
    counters: [(&'static str, Counter); N],
) -> Result<[Survey; N]> {
    let cell = cell(session.size(), unit, true, MOST_CELLS);
    let (mut values, mut whole) = ([(); N].map(|()| Vec::new()), [0; N]);
    let cells = survey(session, drawn, settings, cell, |place, found| {
        for (map, (_, counter)) in counters.iter().enumerate() {
            match place {
                None => whole[map] = found.get(*counter),
                Some(_) => values[map].push(found.get(*counter)),
            }
        }
    })?;
    let units = [0, 1].map(|axis| cell[axis] / unit[axis].max(1)).iter().product();
    Ok(std::array::from_fn(|map| {
        let values = std::mem::take(&mut values[map]);
        Survey { name: counters[map].0, cell, units, cells, values, whole: Some(whole[map]) }
    }))
}

/// Depths read by the plain Z buffer, in cells of 8 x 8 pixels or more.
///
/// # Errors
/// [`crate::Error::Driver`].
pub fn reads(session: &mut Session, scene: &Scene, look: Look) -> Result<Survey> {
    let settings = Settings { hidden_surface: HiddenSurface::ZBuffer, ..*session.settings() };
    let [map] = maps(session, (scene, look), settings, [8, 8], [("depths read", Counter::ZReads)])?;
    Ok(map)
}

/// Visits of Za blocks: initialised, bypassed, compared.
///
/// # Errors
/// [`crate::Error::Driver`].
pub fn blocks(session: &mut Session, scene: &Scene, look: Look) -> Result<[Survey; 3]> {
    let settings = Settings { hidden_surface: HiddenSurface::Za, ..*session.settings() };
    let counters = [
        ("initialised", Counter::ZaBlocksInitialised),
        ("bypassed", Counter::ZaBlocksBypassed),
        ("compared", Counter::ZaBlocksCompared),
    ];
    maps(session, (scene, look), settings, settings.za.block, counters)
}

/// Tokens of each line of the systolic array.
///
/// # Errors
/// [`crate::Error::Driver`].
pub fn lines(session: &mut Session, scene: &Scene, look: Look) -> Result<Survey> {
    let settings = Settings { hidden_surface: HiddenSurface::Systolic, ..*session.settings() };
    let line = [session.size()[0], 1];
    let [map] = maps(session, (scene, look), settings, line, [("tokens", Counter::SystolicTokens)])?;
    Ok(map)
}

/// Lengths of the tiles' lists.
///
/// # Errors
/// [`crate::Error::Driver`].
pub fn tiles(session: &mut Session, scene: &Scene, look: Look) -> Result<Survey> {
    let settings = Settings { hidden_surface: HiddenSurface::Tile, ..*session.settings() };
    let size = session.size();
    let tile = settings.tile_size;
    let cell = cell(size, tile, false, MOST_CELLS);
    let heads = HEAD_BYTES * [0, 1].map(|axis| u64::from(size[axis].div_ceil(tile[axis]))).iter().sum::<u64>();
    let stored = |found: &Counters| found.get(Counter::TileSortMemoryBytes).saturating_sub(heads) / RECORD_BYTES;
    let (mut values, mut whole) = (Vec::new(), None);
    let cells = survey(session, (scene, look), settings, cell, |place, found| match place {
        // Every polygon is linked once in its first tile; the others are those that cutting would have stored.
        None => whole = Some(stored(found) + found.get(Counter::TileFragmentsNotStored)),
        // In a single row of tiles every polygon is walked once for the X sort, then once in each tile of its own.
        Some(_) => values.push(found.get(Counter::TileLinksWalked).saturating_sub(stored(found))),
    })?;
    Ok(Survey { name: "links of the lists", cell, units: cell[0] / tile[0], cells, values, whole })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demos;
    use crate::play::Asked;

    fn session(demo: &str, size: [u32; 2]) -> (Session, Scene) {
        let mut scene = demos::find(demo).expect("a demo").build(0);
        scene.size = size;
        (Session::open(demo, &scene, &Asked::default()).expect("a card"), scene)
    }

    #[test]
    fn cell_grows_only_as_far_as_it_must() {
        assert_eq!(cell([256, 192], [32, 1], true, 1536), [32, 1]);
        assert_eq!(cell([256, 192], [32, 1], true, 100), [32, 16]);
        assert_eq!(cell([256, 192], [8, 8], false, 100), [64, 8]);
        assert_eq!(cell([256, 192], [256, 1], true, 48), [256, 4]);
    }

    #[test]
    fn surveys_add_up_to_the_counters_of_the_frame() {
        for demo in ["za", "systolic", "tile", "interpenetrate"] {
            let (mut session, scene) = session(demo, [120, 90]);
            let look = Look::default();
            let mut all = vec![reads(&mut session, &scene, look).expect("drawn")];
            all.extend(blocks(&mut session, &scene, look).expect("drawn"));
            all.push(lines(&mut session, &scene, look).expect("drawn"));
            all.push(tiles(&mut session, &scene, look).expect("drawn"));
            for map in all {
                assert_eq!(Some(map.sum()), map.whole, "{demo}: {}", map.name);
                assert_eq!(map.values.len() as u32, map.cells[0] * map.cells[1]);
            }
        }
    }

    #[test]
    fn at_reads_the_cell_of_a_pixel() {
        let map = Survey { name: "", cell: [4, 2], units: 1, cells: [2, 2], values: vec![1, 2, 3, 4], whole: None };
        assert_eq!([(0, 0), (4, 1), (3, 2), (7, 3), (8, 0), (0, 4)].map(|(x, y)| map.at(x, y)), [1, 2, 3, 4, 0, 0]);
        assert_eq!((map.most(), map.sum(), map.adds_up()), (4, 10, true));
    }
}
