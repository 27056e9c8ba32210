//! Surface markings: which slope S buries none, what S costs, what fitting it to the surface saves, and what the usual
//! polygon offset does instead.
//!
//! | module | holds |
//! | --- | --- |
//! | `measure` | every cure on the scenes of the study |
//! | `findings` | what is said of that |
//! | `figures` | tables and plots |
//! | `pictures` | parts of pictures with the wrong pixels marked |

mod figures;
mod findings;
mod measure;
mod pictures;

use zga_driver::DriverError;
use zga_tests::study::decal::survey::Extent;
use zga_tests::study::decal::{Counts, Cure, Desk, Projection};

use self::figures::{by_tilt, cures, curve, tilts, trade};
use self::findings::{about, findings, notes, points};
use self::measure::measure;
use self::pictures::{body_strip, patch_strip};
use super::context::Context;
use super::report::Section;
use crate::error::{Error, Result};

/// What the driver may refuse.
type Drawn<T> = std::result::Result<T, DriverError>;

pub fn section(context: &mut Context<'_>) -> Result<Section> {
    make(context).map_err(Error::driver("the study of surface markings"))
}

fn make(context: &mut Context<'_>) -> Drawn<Section> {
    let extent = context.effort.pick(Extent::Few, Extent::Many);
    let mut desk = Desk::new();
    let mut measured = Vec::new();
    for projection in Projection::ALL {
        context.tell(&format!("surface markings, {}", projection.name()));
        measured.push(measure(&mut desk, projection, extent)?);
    }
    Ok(Section {
        name: "decal",
        title: "Surface markings: slope S, and decals fitted to their surface".to_owned(),
        about: about(),
        findings: measured.iter().flat_map(findings).chain([points(&mut desk)?]).collect(),
        tables: measured.iter().flat_map(|measured| [cures(measured), tilts(measured)]).collect(),
        plots: [
            vec![curve("buried", &measured, buried), curve("shown through", &measured, shown)],
            by_tilt(&measured),
            vec![trade(&measured)],
        ]
        .concat(),
        strips: vec![body_strip(&mut desk)?, patch_strip(&mut desk)?],
        notes: notes(),
        ..Section::default()
    })
}

fn percent(part: u64, whole: u64) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}

fn buried(counts: &Counts) -> f64 {
    percent(counts.buried, counts.seen)
}

fn shown(counts: &Counts) -> f64 {
    percent(counts.shown, counts.hidden)
}

fn name(cure: Cure) -> String {
    match cure {
        Cure::Nothing => "nothing".to_owned(),
        Cure::Decal(slope) => format!("decal, S = {slope}"),
        Cure::Fitted(slope) => format!("decal fitted to the surface, S up to {slope}"),
        Cure::Surface(slope) => format!("surface moved away, S = -{slope}"),
        Cure::Offset { factor, units } => format!("polygon offset {factor}, {units}"),
    }
}
