//! What a frame called for, and what each unit of the card charged for it.
//!
//! Duties: sorts the counters of a frame by unit ([`Bill`]); checks that a unit without power has cost nothing; measures
//! what an effect more or less would cost ([`what_if`]). Inputs from: [`Cost`], [`Settings`]. Outputs to: `zga effects`.
//!
//! | file | holds |
//! | --- | --- |
//! | `mod` | parts of the card, their clocks, events and bytes |
//! | `what_if` | the scene with an effect more or less, beside the scene as it is |
//! | `report` | both as tables and as JSON |

mod report;
pub mod what_if;

use zga_abi::format::HiddenSurface;
use zga_abi::{Counter, Effects, Units};
use zga_driver::Counters;

use crate::paths::Storage;
use crate::play::{Cost, Settings};

pub use report::{json, table};

/// A part of the card: a unit, or a part of one that has an account of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    name: &'static str,
    /// The unit that has power when it works.
    unit: Units,
    clocks: Option<Counter>,
    events: &'static [Counter],
    /// Counters of bytes.
    bytes: &'static [Counter],
}

/// The part of the shading unit that blends without samples.
const LAYERS: &str = "layers";

/// The parts, in the order in which a frame meets them.
const PARTS: [Part; 13] = [
    Part {
        name: "frontend",
        unit: Units::FRONTEND,
        clocks: Some(Counter::CyclesFrontend),
        events: &[Counter::FrontendPackets, Counter::FrontendWords, Counter::FrontendFences],
        bytes: &[],
    },
    Part {
        name: "geometry",
        unit: Units::GEOMETRY,
        clocks: Some(Counter::CyclesGeometry),
        events: &[
            Counter::GeometryVertices,
            Counter::GeometryPrimitives,
            Counter::GeometryClipped,
            Counter::GeometryDiscarded,
        ],
        bytes: &[],
    },
    Part { name: "z_buffer", unit: Units::Z_BUFFER, clocks: Some(Counter::CyclesZBuffer), events: &[], bytes: &[] },
    Part {
        name: "za",
        unit: Units::ZA,
        clocks: Some(Counter::CyclesZa),
        events: &[
            Counter::ZaClears,
            Counter::ZaWordsWritten,
            Counter::ZaBlocksInitialised,
            Counter::ZaBlocksBypassed,
            Counter::ZaPixelsBypassed,
            Counter::ZaBlocksCompared,
            Counter::ZaBlocksSettled,
        ],
        bytes: &[],
    },
    Part {
        name: "systolic",
        unit: Units::SYSTOLIC,
        clocks: Some(Counter::CyclesSystolic),
        events: &[Counter::SystolicTokens, Counter::SystolicClocks],
        bytes: &[],
    },
    Part {
        name: "tile",
        unit: Units::TILE,
        clocks: Some(Counter::CyclesTile),
        events: &[
            Counter::TileVisited,
            Counter::TileEmpty,
            Counter::TileLinksWalked,
            Counter::TileLinksRemoved,
            Counter::TileFragmentsNotStored,
        ],
        bytes: &[Counter::TileSortMemoryBytes],
    },
    Part {
        name: "texture",
        unit: Units::TEXTURE,
        clocks: Some(Counter::CyclesTexture),
        events: &[Counter::TextureTexels, Counter::TextureFetches, Counter::TextureHoles],
        bytes: &[Counter::TextureDecodedBytes],
    },
    Part {
        name: "shading",
        unit: Units::SHADING,
        clocks: Some(Counter::CyclesShading),
        events: &[Counter::ShadingPixels, Counter::ShadingLights, Counter::ShadingFogged],
        bytes: &[],
    },
    Part {
        name: LAYERS,
        unit: Units::SHADING,
        clocks: Some(Counter::CyclesLayers),
        events: &[Counter::LayersFragments, Counter::LayersBlended, Counter::LayersSortedPixels],
        bytes: &[],
    },
    Part {
        name: "subpixel",
        unit: Units::SUBPIXEL,
        clocks: Some(Counter::CyclesSubpixel),
        events: &[
            Counter::SubpixelMasks,
            Counter::SubpixelSearches,
            Counter::SubpixelSearchSteps,
            Counter::SubpixelDepthEvaluations,
            Counter::SubpixelMerges,
            Counter::SubpixelPacked,
            Counter::SubpixelPixelsActive,
            Counter::SubpixelFragments,
            Counter::SubpixelPixelsDegraded,
            Counter::SubpixelEdges,
        ],
        bytes: &[Counter::SubpixelPoolPeakBytes, Counter::SubpixelEdgePeakBytes],
    },
    Part {
        name: "bitmap",
        unit: Units::BITMAP,
        clocks: Some(Counter::CyclesBitmap),
        events: &[
            Counter::BitmapPixels,
            Counter::BitmapCombined,
            Counter::BitmapStretched,
            Counter::BitmapEntries,
            Counter::BitmapSegmentPixels,
            Counter::BitmapExpanded,
            Counter::BitmapComposed,
        ],
        bytes: &[],
    },
    Part {
        name: "scanout",
        unit: Units::SCANOUT,
        clocks: Some(Counter::CyclesScanout),
        events: &[
            Counter::ScanoutFrames,
            Counter::ScanoutPixels,
            Counter::ScanoutBackgroundBlocks,
            Counter::ScanoutCursorPixels,
        ],
        bytes: &[],
    },
    Part { name: "probe", unit: Units::PROBE, clocks: None, events: &[Counter::ProbeFragments], bytes: &[] },
];

/// Events that every hidden-surface unit has: those of the one that has power.
const OF_THE_PATH: [Counter; 7] = [
    Counter::ZSpans,
    Counter::ZReads,
    Counter::ZWrites,
    Counter::ColourWrites,
    Counter::StencilTested,
    Counter::StencilFailed,
    Counter::StencilShadowed,
];

/// What a part of the card did for a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Account {
    /// Name of the part: that of the unit, or of what has an account of its own in it.
    pub part: &'static str,
    /// Its unit had power.
    pub powered: bool,
    /// Clocks.
    pub clocks: u64,
    /// Events by the names of their counters.
    pub events: Vec<(&'static str, u64)>,
    /// Bytes that it held, by name.
    pub bytes: Vec<(&'static str, u64)>,
}

impl Account {
    /// No clock, no event, no byte.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.clocks == 0 && self.events.iter().chain(&self.bytes).all(|(_, count)| *count == 0)
    }
}

/// What a frame called for, and the accounts of all parts of the card.
#[derive(Clone, Debug, PartialEq)]
pub struct Bill {
    /// Effects, units, counters and host time.
    pub cost: Cost,
    /// The parts, in the order in which a frame meets them.
    pub accounts: Vec<Account>,
}

impl Bill {
    /// The bill of a frame of `size` pixels on a card set to `settings`, drawn after the same frame, whose counters were
    /// `before`: what the card took in then and still holds is counted only then.
    #[must_use]
    pub fn new(cost: Cost, before: &Counters, settings: &Settings, size: [u32; 2]) -> Self {
        let value = |counter: &Counter| (counter.name(), cost.counters.get(*counter));
        let held = |counter: &Counter| {
            let before = if counter.is_maximum() { before.get(*counter) } else { 0 };
            (counter.name(), cost.counters.get(*counter).max(before))
        };
        let path = path_unit(settings.hidden_surface);
        let storage = Storage::new(settings, size, &cost.counters);
        let account = |part: &Part| {
            // Layers are the sub-pixel unit's where there are samples.
            let layers = cost.called.contains(Effects::BLEND) && !settings.is_antialiased();
            let powered = cost.powered.contains(part.unit) && (part.name != LAYERS || layers);
            let mut account = Account {
                part: part.name,
                powered,
                clocks: part.clocks.map_or(0, |counter| cost.counters.get(counter)),
                events: part.events.iter().map(value).collect(),
                bytes: part.bytes.iter().map(held).collect(),
            };
            if part.unit == path {
                account.events.extend(OF_THE_PATH.iter().map(value));
            }
            if part.unit == path && powered {
                let on_chip = storage.on_chip.iter().filter(|(_, bits)| *bits > 0);
                account.bytes.extend(on_chip.map(|(name, bits)| (*name, bits.div_ceil(8))));
                if storage.z_buffer_bytes > 0 {
                    account.bytes.push(("z_buffer", storage.z_buffer_bytes));
                }
                if cost.called.contains(Effects::STENCIL) {
                    // A byte a pixel, on every path.
                    account.bytes.push(("stencil", u64::from(size[0]) * u64::from(size[1])));
                }
            }
            account
        };
        let accounts = PARTS.iter().map(account).collect();
        Self { cost, accounts }
    }

    /// Parts that had no power and yet an entry in their account: what is not called must cost nothing.
    #[must_use]
    pub fn charged_without_power(&self) -> Vec<&'static str> {
        let charged = |account: &&Account| !account.powered && !account.is_empty();
        self.accounts.iter().filter(charged).map(|account| account.part).collect()
    }
}

/// The unit behind a hidden-surface path.
const fn path_unit(path: HiddenSurface) -> Units {
    match path {
        HiddenSurface::ZBuffer => Units::Z_BUFFER,
        HiddenSurface::Za => Units::ZA,
        HiddenSurface::Systolic => Units::SYSTOLIC,
        HiddenSurface::Tile => Units::TILE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demos;
    use crate::play::{Asked, Look, Session};
    use crate::scene::{CardSettings, HIDDEN_SURFACES};

    fn bill(demo: &str, card: CardSettings) -> Bill {
        let mut scene = demos::find(demo).expect("a demo").build(0);
        scene.size = [160, 120];
        let mut session = Session::open(demo, &scene, &Asked { card, threads: 1, ..Asked::default() }).expect("a card");
        let (_, before) = session.frame(&scene, Look::default()).expect("drawn");
        let (_, cost) = session.frame(&scene, Look::default()).expect("drawn");
        Bill::new(cost, &before.counters, session.settings(), session.size())
    }

    #[test]
    fn parts_have_every_counter_but_the_sum_once() {
        let mut found: Vec<Counter> = OF_THE_PATH.to_vec();
        for part in &PARTS {
            found.extend(part.clocks.into_iter().chain(part.events.iter().copied()).chain(part.bytes.iter().copied()));
        }
        found.push(Counter::CyclesTotal);
        found.sort();
        assert_eq!(found, Counter::ALL);
    }

    #[test]
    fn bill_of_every_path_charges_nothing_to_units_without_power() {
        for (path, name) in
            HIDDEN_SURFACES.map(|(_, path)| path).into_iter().zip(["z_buffer", "za", "systolic", "tile"])
        {
            for demo in ["teapot", "crossing", "layers", "points"] {
                let bill = bill(demo, CardSettings { hidden_surface: Some(path), ..CardSettings::default() });
                assert_eq!(bill.charged_without_power(), Vec::<&str>::new(), "{demo} on {name}");
                let account = bill.accounts.iter().find(|account| account.part == name).expect("listed");
                assert!(account.powered && account.clocks > 0, "{demo} on {name}");
                let sum: u64 = bill.accounts.iter().map(|account| account.clocks).sum();
                assert_eq!(sum, bill.cost.counters.get(Counter::CyclesTotal), "{demo} on {name}");
            }
        }
    }

    #[test]
    fn bill_counts_the_bytes_of_the_stencil_plane_where_it_is_called() {
        let bytes = |demo| {
            let bill = bill(demo, CardSettings::default());
            let account = bill.accounts.iter().find(|account| account.part == "z_buffer").expect("listed");
            account.bytes.clone()
        };
        assert_eq!(bytes("shadow"), [("z_buffer", 4 * 160 * 120), ("stencil", 160 * 120)]);
        assert_eq!(bytes("teapot"), [("z_buffer", 4 * 160 * 120)]);
    }

    #[test]
    fn charged_without_power_names_the_part() {
        let mut bill = bill("points", CardSettings::default());
        let texture = bill.accounts.iter_mut().find(|account| account.part == "texture").expect("listed");
        texture.bytes[0].1 = 64;
        assert_eq!(bill.charged_without_power(), ["texture"]);
    }
}
