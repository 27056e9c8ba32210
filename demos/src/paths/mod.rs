//! One scene on every hidden-surface path: the same picture? and what each path spends on it.
//!
//! | module | holds |
//! | --- | --- |
//! | `cases` | which paths, fidelities and variants are run |
//! | `memory` | words moved, storage: formulas |
//! | `survey` | where in the picture each path works, from the card's own counters |
//! | `report` | the table and the JSON |
//! | `sheet` | the picture: maps and bars |
//! | `view` | one map over the picture, for `zga show --view` |
//!
//! Duties: [`compare`] runs the cases on one card. Inputs from: scenes, [`Settings`]. Outputs to: `zga paths`,
//! `zga show`.

mod cases;
mod memory;
mod report;
mod sheet;
mod survey;
mod view;

use zga_abi::Counter;
use zga_abi::format::{Fidelity, HiddenSurface};
use zga_driver::{Counters, Frame};

use crate::error::Result;
use crate::play::{Look, Session, Settings, ZaWords};
use crate::scene::Scene;

pub use cases::{Case, cases};
pub use memory::{Storage, Words, element};
pub use report::{json, table};
pub use sheet::sheet;
pub use survey::{MOST_CELLS, Survey, blocks, lines, reads, tiles};
pub use view::View;

/// Frame buffers of a session's target.
const FRAME_BUFFERS: usize = 2;
/// A frame that takes longer than this is not drawn again to find a median.
const LONG_MS: f64 = 700.0;

/// What one case gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// The case.
    pub case: Case,
    /// The frame.
    pub frame: Frame,
    /// Its counters, present included.
    pub counters: Counters,
    /// Words that it moved.
    pub words: Words,
    /// What the path keeps, and where.
    pub storage: Storage,
    /// Its Za words, on that path.
    pub za: Option<ZaWords>,
    /// Host time of a frame, the median, milliseconds.
    pub host_ms: f64,
}

/// A scene on all paths.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What the scene is called.
    pub name: String,
    /// Pixels of a row, and rows.
    pub size: [u32; 2],
    /// The runs; the first is the plain Z buffer, or what comes first on a card without.
    pub runs: Vec<Run>,
}

impl Comparison {
    /// The run that all others are compared with.
    #[must_use]
    pub fn reference(&self) -> Option<&Run> {
        self.runs.first()
    }

    /// Whether a run gave the picture of the reference.
    #[must_use]
    pub fn same_picture(&self, run: &Run) -> bool {
        self.reference().is_some_and(|reference| reference.frame.hash == run.frame.hash)
    }

    /// Whether a clocked run counted what the functional one counted; `None` where there is nothing to compare.
    #[must_use]
    pub fn same_counters(&self, run: &Run) -> Option<bool> {
        if run.case.settings.fidelity != Fidelity::Clocked {
            return None;
        }
        let functional = Settings { fidelity: Fidelity::Functional, ..run.case.settings };
        let other = self.runs.iter().find(|other| other.case.settings == functional)?;
        Some(unit_counters(&run.counters) == unit_counters(&other.counters))
    }

    /// Whether all pictures are the same, and all counts of both fidelities.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.runs.iter().all(|run| self.same_picture(run) && self.same_counters(run) != Some(false))
    }

    /// The plain functional run of a path.
    #[must_use]
    pub fn plain(&self, path: HiddenSurface) -> Option<&Run> {
        let plain = |run: &&Run| run.case.variant.is_empty() && run.case.settings.fidelity == Fidelity::Functional;
        self.runs.iter().filter(plain).find(|run| run.case.settings.hidden_surface == path)
    }
}

/// All counters but those of the front end, which also fetches the setting of fidelity.
fn unit_counters(counters: &Counters) -> Vec<(&'static str, u64)> {
    const OTHER: [Counter; 5] = [
        Counter::CyclesTotal,
        Counter::CyclesFrontend,
        Counter::FrontendPackets,
        Counter::FrontendWords,
        Counter::FrontendFences,
    ];
    counters.iter().filter(|(name, _)| OTHER.iter().all(|other| other.name() != *name)).collect()
}

/// Runs cases one after the other on a card; `done` is told after each. Before a case is measured both frame buffers are
/// drawn as it has them, functionally: what the case before left behind, as logically cleared blocks that must be
/// settled, is counted with none. A frame that takes long is measured once, others as often as `frames` says.
///
/// # Errors
/// [`crate::Error::Driver`].
pub fn compare(
    name: &str,
    session: &mut Session,
    scene: &Scene,
    look: Look,
    all: Vec<Case>,
    frames: u32,
    mut done: impl FnMut(),
) -> Result<Comparison> {
    let mut runs = Vec::new();
    let before = *session.settings();
    for case in all {
        session.set(Settings { fidelity: Fidelity::Functional, ..case.settings })?;
        for _ in 0..FRAME_BUFFERS {
            session.frame(scene, look)?;
        }
        session.set(case.settings)?;
        let (mut frame, mut cost) = session.frame(scene, look)?;
        let mut times = vec![cost.host_ms()];
        while times.len() < frames as usize && cost.host_ms() < LONG_MS {
            (frame, cost) = session.frame(scene, look)?;
            times.push(cost.host_ms());
        }
        times.sort_by(f64::total_cmp);
        let za = session.za_words()?;
        let size = session.size();
        runs.push(Run {
            words: Words::new(&cost.counters, size, za.as_ref()),
            storage: Storage::new(&case.settings, size, &cost.counters),
            case,
            frame,
            counters: cost.counters,
            za,
            host_ms: times[times.len() / 2],
        });
        done();
    }
    session.set(before)?;
    Ok(Comparison { name: name.to_owned(), size: session.size(), runs })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::demos;
    use crate::play::Asked;
    use zga_abi::Effects;
    use zga_abi::format::{DepthFormat, SubpixelGrid};
    use zga_driver::{Antialias, CardInfo, SystolicVariant, ZaSettings};

    pub(super) const ALL_PATHS: CardInfo = CardInfo {
        major: 1,
        minor: 0,
        effects: Effects::DEPTH,
        paths: 15,
        video_memory: 0,
        za_ram: 1 << 20,
        fifo_words: 0,
    };

    pub(super) fn settings() -> Settings {
        Settings {
            hidden_surface: HiddenSurface::ZBuffer,
            fidelity: Fidelity::Functional,
            depth: DepthFormat::default(),
            subpixel_bits: 8,
            antialias: Antialias { grid: SubpixelGrid::Off, ..Antialias::default() },
            za: ZaSettings::default(),
            systolic: SystolicVariant::default(),
            tile_size: [8, 8],
        }
    }

    pub(super) fn compared(demo: &str, size: [u32; 2], variants: bool) -> (Session, Comparison) {
        let mut scene = demos::find(demo).expect("a demo").build(0);
        scene.size = size;
        let mut session = Session::open(demo, &scene, &Asked::default()).expect("a card");
        let info = *session.driver().card_info();
        let all = cases(session.settings(), &info, variants);
        let found = compare(demo, &mut session, &scene, Look::default(), all, 1, || ()).expect("drawn");
        (session, found)
    }

    #[test]
    fn compare_every_path_and_variant_gives_one_picture_and_equal_counts() {
        for demo in ["za", "systolic", "tile", "points"] {
            let (_, found) = compared(demo, [120, 90], true);
            for run in &found.runs {
                let what = (demo, run.case.settings.hidden_surface.name(), &run.case.variant);
                assert!(found.same_picture(run), "{what:?}");
                assert_ne!(found.same_counters(run), Some(false), "{what:?}");
            }
            assert!(found.is_good() && found.runs.len() >= 7);
        }
    }

    #[test]
    fn is_good_of_another_picture_is_not() {
        let (_, mut found) = compared("gouraud", [40, 30], false);
        found.runs[3].frame.hash.push('x');
        assert!(!found.is_good() && !found.same_picture(&found.runs[3]));
    }
}
