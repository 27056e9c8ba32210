//! Every cure on the scenes of the study.

use zga_tests::study::decal::survey::{Extent, FACTORS, LIMIT, best_offset, covered, open, scenes, total};
use zga_tests::study::decal::{Counts, Cure, Desk, Projection, Subject, bodies, subjects};

use super::Drawn;

const SLOPES: &[f64] = &[0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0];
/// Of a fitted decal, whose S is but a limit.
const LIMITS: &[f64] = &[0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
/// Powers of two up to the whole depth range.
const UNITS: &[f64] = &[1.0, 64.0, 512.0, 1024.0, 2048.0, 4096.0, 16_384.0, 65_536.0, 262_144.0];
/// |dz/dx| + |dz/dy| of a plane that falls away to 33 degrees, in tilts: cos 33 + sin 33.
pub(super) const POINTS: f64 = 1.39;
/// What is measured in one projection.
pub(super) struct Measured {
    pub projection: Projection,
    /// S and what it makes of everything.
    pub slopes: Vec<(f64, Counts)>,
    /// As `slopes` for fitted decals: S is the limit.
    pub limits: Vec<(f64, Counts)>,
    /// Every cure on the scenes with tilts up to the limit.
    pub within: Vec<(Cure, Counts)>,
    pub tilts: Vec<Tilt>,
}

/// Patches of one tilt.
pub(super) struct Tilt {
    pub tilt: f64,
    pub nothing: Counts,
    pub decal: Counts,
    pub fitted: Counts,
    /// The factor of a slope-scaled offset that shows the fewest through of those that bury no more than `fitted`.
    pub best: Option<(f64, Counts)>,
    /// S is what points on the plane need.
    pub own: Counts,
    pub usual: Counts,
    pub tuned: Counts,
}

/// glPolygonOffset(1, 1).
pub(super) const USUAL: Cure = Cure::Offset { factor: 1.0, units: 1.0 };
/// Half a pixel of slope: what lines need.
pub(super) const TUNED: Cure = Cure::Offset { factor: 0.5, units: 1.0 };

pub(super) fn measure(desk: &mut Desk, projection: Projection, extent: Extent) -> Drawn<Measured> {
    let all = subjects(scenes(projection, extent));
    let mut slopes = Vec::new();
    for &slope in SLOPES {
        slopes.push((slope, total(&all, desk, Cure::Decal(slope))?));
    }
    let mut limits = Vec::new();
    for &limit in LIMITS {
        limits.push((limit, total(&all, desk, Cure::Fitted(limit))?));
    }
    drop(all);
    let mut tilts = Vec::new();
    let mut up_to_limit = vec![Subject::new(bodies(projection))];
    for tilt in [0.0, 1.0, 2.0, 4.0, 6.0, 7.9, 8.0, 8.1, 16.0] {
        let patches = subjects([open(projection, tilt, extent), covered(projection, tilt, extent)].concat());
        let mut of = |cure| total(&patches, desk, cure);
        let (nothing, decal) = (of(Cure::Nothing)?, of(Cure::Decal(LIMIT))?);
        let (fitted, own) = (of(Cure::Fitted(LIMIT))?, of(Cure::Decal(POINTS * tilt))?);
        let (usual, tuned) = (of(USUAL)?, of(TUNED)?);
        let best = best_offset(&patches, desk, fitted.buried)?;
        tilts.push(Tilt { tilt, nothing, decal, fitted, best, own, usual, tuned });
        if [0.0, 1.0, 4.0, 8.0].contains(&tilt) {
            up_to_limit.extend(patches);
        }
    }
    let factors = FACTORS.iter().map(|&factor| Cure::Offset { factor, units: 1.0 });
    let units = UNITS.iter().map(|&units| Cure::Offset { factor: 0.0, units });
    let decals = [Cure::Nothing, Cure::Decal(LIMIT), Cure::Fitted(LIMIT), Cure::Surface(LIMIT)];
    let mut within = Vec::new();
    for cure in decals.into_iter().chain(factors).chain(units) {
        within.push((cure, total(&up_to_limit, desk, cure)?));
    }
    Ok(Measured { projection, slopes, limits, within, tilts })
}

impl Measured {
    pub fn of(&self, cure: Cure) -> Counts {
        self.within.iter().find(|(other, _)| *other == cure).map_or_else(Counts::default, |(_, counts)| *counts)
    }

    /// The offset that buries no more than a decal, of those the one that shows the fewest through.
    pub fn rival(&self, decal: Cure, sloped: bool) -> Option<(Cure, Counts)> {
        let decal = self.of(decal);
        let offsets = self.within.iter().filter(|(cure, counts)| match cure {
            Cure::Offset { factor, .. } => (*factor > 0.0) == sloped && counts.buried <= decal.buried,
            _ => false,
        });
        offsets.min_by_key(|(_, counts)| counts.shown).copied()
    }
}
