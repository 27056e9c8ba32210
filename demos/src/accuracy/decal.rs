//! Surface markings: which slope S buries none, what S costs, and what the usual polygon offset does instead.

use zga_tests::study::decal::survey::{Extent, LIMIT, covered, open, scenes, total};
use zga_tests::study::decal::{
    Answer, Counts, Cure, Desk, MARKING, Outcome, Patch, Projection, SIDE, Subject, bodies, place, subjects,
};

use super::context::{Context, picture};
use super::report::{Axis, Cell, Kind, Panel, Plot, Section, Series, Strip, Table};
use super::verdict::figure;
use crate::error::{Error, Result};
use zga_driver::DriverError;

const SLOPES: &[f64] = &[0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0];
const FACTORS: &[f64] = &[0.25, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.5, 2.0, 4.0];
/// Powers of two up to the whole depth range.
const UNITS: &[f64] = &[1.0, 64.0, 512.0, 1024.0, 2048.0, 4096.0, 16_384.0, 65_536.0, 262_144.0];
/// |dz/dx| + |dz/dy| of a plane that falls away to 33 degrees, in tilts: cos 33 + sin 33.
const POINTS: f64 = 1.39;
/// XRGB.
const BURIED: u32 = 0x00FF_2020;
const THROUGH: u32 = 0x00FF_40FF;

/// What the driver may refuse.
type Drawn<T> = std::result::Result<T, DriverError>;

/// What is measured in one projection.
struct Measured {
    projection: Projection,
    /// S and what it makes of everything.
    slopes: Vec<(f64, Counts)>,
    /// Every cure on the scenes with tilts up to the limit.
    within: Vec<(Cure, Counts)>,
    tilts: Vec<Tilt>,
}

/// Patches of one tilt.
struct Tilt {
    tilt: f64,
    nothing: Counts,
    decal: Counts,
    /// S is what points on the plane need.
    own: Counts,
    usual: Counts,
    tuned: Counts,
}

/// glPolygonOffset(1, 1).
const USUAL: Cure = Cure::Offset { factor: 1.0, units: 1.0 };
/// Half a pixel of slope: what lines need.
const TUNED: Cure = Cure::Offset { factor: 0.5, units: 1.0 };

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
        title: "Surface markings: slope S".to_owned(),
        about: about(),
        findings: measured.iter().flat_map(findings).chain([points(&mut desk)?]).collect(),
        tables: measured.iter().flat_map(|measured| [cures(measured), tilts(measured)]).collect(),
        plots: vec![curve("buried", &measured, buried), curve("shown through", &measured, shown), trade(&measured)],
        strips: vec![body_strip(&mut desk)?, patch_strip(&mut desk)?],
        notes: notes(),
        ..Section::default()
    })
}

fn measure(desk: &mut Desk, projection: Projection, extent: Extent) -> Drawn<Measured> {
    let all = subjects(scenes(projection, extent));
    let mut slopes = Vec::new();
    for &slope in SLOPES {
        slopes.push((slope, total(&all, desk, Cure::Decal(slope))?));
    }
    drop(all);
    let mut tilts = Vec::new();
    let mut up_to_limit = vec![Subject::new(bodies(projection))];
    for tilt in [0.0, 1.0, 2.0, 4.0, 6.0, 7.9, 8.0, 8.1, 16.0] {
        let patches = subjects([open(projection, tilt, extent), covered(projection, tilt, extent)].concat());
        let mut of = |cure| total(&patches, desk, cure);
        let (nothing, decal) = (of(Cure::Nothing)?, of(Cure::Decal(LIMIT))?);
        let own = of(Cure::Decal(POINTS * tilt))?;
        tilts.push(Tilt { tilt, nothing, decal, own, usual: of(USUAL)?, tuned: of(TUNED)? });
        if [0.0, 1.0, 4.0, 8.0].contains(&tilt) {
            up_to_limit.extend(patches);
        }
    }
    let factors = FACTORS.iter().map(|&factor| Cure::Offset { factor, units: 1.0 });
    let units = UNITS.iter().map(|&units| Cure::Offset { factor: 0.0, units });
    let decals = [Cure::Nothing, Cure::Decal(LIMIT), Cure::Surface(LIMIT)];
    let mut within = Vec::new();
    for cure in decals.into_iter().chain(factors).chain(units) {
        within.push((cure, total(&up_to_limit, desk, cure)?));
    }
    Ok(Measured { projection, slopes, within, tilts })
}

impl Measured {
    fn of(&self, cure: Cure) -> Counts {
        self.within.iter().find(|(other, _)| *other == cure).map_or_else(Counts::default, |(_, counts)| *counts)
    }

    /// The offset that buries no more than the decal, of those that show the fewest through.
    fn rival(&self, sloped: bool) -> Option<(Cure, Counts)> {
        let decal = self.of(Cure::Decal(LIMIT));
        let offsets = self.within.iter().filter(|(cure, counts)| match cure {
            Cure::Offset { factor, .. } => (*factor > 0.0) == sloped && counts.buried <= decal.buried,
            _ => false,
        });
        offsets.min_by_key(|(_, counts)| counts.shown).copied()
    }
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
        Cure::Surface(slope) => format!("surface moved away, S = -{slope}"),
        Cure::Offset { factor, units } => format!("polygon offset {factor}, {units}"),
    }
}

fn about() -> Vec<String> {
    [
        "A line on a surface is drawn at pixel centres up to half a pixel beside it, with the line's depth; where the surface \
         slopes it sinks. The decal transform moves markings toward the viewer by S/2K, enough for surfaces of slope S. \
         Too small an S buries marking pixels; a large one lets markings show through what lies closely in front.",
        "Exact arithmetic says what must be seen: each pixel of a marking stands for the point of the true line at the same \
         major coordinate, and another surface hides it if it covers that point, unsnapped, and is strictly nearer there; all \
         in rationals from the vertices that the card was given. Pixels with the border of a surface between that point and \
         their centre are not counted. Buried: must be seen, and is not. Shown through: must be hidden, and is shown.",
        "Scenes, in both projections: lines in all directions, a curve and points on tilted planes, in the open and behind \
         parallel sheets 1 to 12 pixels in front; a floor up to the horizon; faceted bodies near to far with all edges marked. \
         The comparison of cures leaves out what is steeper than tilt 8 as a whole: planes of tilt 0, 1, 4, 8 and the bodies.",
    ]
    .map(str::to_owned)
    .to_vec()
}

fn findings(measured: &Measured) -> Vec<String> {
    let name_of = measured.projection.name();
    let (decal, nothing) = (measured.of(Cure::Decal(LIMIT)), measured.of(Cure::Nothing));
    let mut said = vec![format!(
        "{name_of}: with S = 8, {} of {} marking pixels on surfaces up to slope 8 are buried, without a cure {}% of them{}.",
        decal.buried_within,
        decal.seen_within,
        figure(percent(nothing.buried_within, nothing.seen_within)),
        match decal.ties {
            0 => String::new(),
            ties => format!(
                "; {ties} more where marking and surface meet exactly (half a pixel off on slope 8), and the last step of \
                 depth decides"
            ),
        },
    )];
    if let Some((_, all)) = measured.slopes.iter().find(|(slope, _)| *slope == LIMIT) {
        let missed = all.buried - all.buried_within - all.ties;
        said.push(format!(
            "{name_of}: beyond the limit it wears off. Of {} marking pixels on surfaces steeper than 8 (up to 100), S = 8 buries \
             {}%.",
            all.seen - all.seen_within,
            figure(percent(missed, all.seen - all.seen_within))
        ));
    }
    for (sloped, kind) in [(false, "constant"), (true, "slope-scaled")] {
        said.push(match measured.rival(sloped) {
            Some((cure, counts)) => format!(
                "{name_of}: of the {kind} polygon offsets that bury as little as S = 8 ({} pixels), the one that shows the \
                 fewest through is {}: {}% of what must be hidden, the decal {}%. {}",
                decal.buried,
                name(cure),
                figure(shown(&counts)),
                figure(shown(&decal)),
                if decal.shown <= counts.shown { "The decal is no worse." } else { "The offset is better there." }
            ),
            None => format!(
                "{name_of}: no {kind} polygon offset that was tried buries as little as S = 8 ({} pixels).",
                decal.buried
            ),
        });
    }
    let better = |of: fn(&Tilt) -> &Counts| {
        let some = measured.tilts.iter().filter(|found| found.tilt <= LIMIT && of(found).shown <= found.usual.shown);
        let some: Vec<String> = some.map(|found| found.tilt.to_string()).collect();
        if some.is_empty() { "none".to_owned() } else { some.join(", ") }
    };
    said.push(format!(
        "{name_of}: a decal moves by S/2K whatever the slope, a slope-scaled offset by the slope of each triangle. Of the tilts 0 \
         to 8 the decal with S = 8 shows no more through than polygon offset 1, 1 at {}; with S = 1.39 tilts, which its \
         points need, at {}.",
        better(|found| &found.decal),
        better(|found| &found.own)
    ));
    said
}

/// What points need.
fn points(desk: &mut Desk) -> Drawn<String> {
    let patch =
        Patch { projection: Projection::Orthographic, tilt: LIMIT, azimuth: 45.0, distance: 500.0, reach: 80.0 };
    let subject = Subject::new(patch.marked("points"));
    let mut of = |slope| subject.draw(desk, Cure::Decal(slope)).map(|outcome| subject.count(&outcome, slope).buried);
    let (limit, sum) = (of(LIMIT)?, of(LIMIT * std::f64::consts::SQRT_2)?);
    Ok(format!(
        "Points are off by half a pixel in both axes, so for them S must reach |dz/dx| + |dz/dy|: on tilt 8 along the diagonal \
         S = 8 buries {limit} points, S = 11.3 {sum}."
    ))
}

fn notes() -> Vec<String> {
    [
        "A decal costs no clocks: it is one matrix more in a product that is made once a state. Polygon offset needs the \
         gradient of each triangle; the card has none, so the host transforms the triangles and adds it to their vertices, \
         as a driver without decals would.",
        "In perspective the tilt of a plane is its steepest slope on the patch, the change of distance over a pixel in units of a \
         pixel's size there; elsewhere it is flatter. All pixels are judged by the slope at their place.",
        "Vertices off the card's grid are snapped by up to 1/512 pixel: on a slope between S / (1 + 1/64) and S a marking may \
         lose single pixels by that. The orthographic patches lie on the grid.",
        "Depths have 24 bits. Where an offset falls under one step the driver warns: hard case 47 (zga stability 47).",
    ]
    .map(str::to_owned)
    .to_vec()
}

fn cures(measured: &Measured) -> Table {
    let columns = [
        ("cure", ""),
        ("buried up to slope 8", "pixels"),
        ("of", "pixels"),
        ("buried steeper", "pixels"),
        ("of", "pixels"),
        ("shown through", "pixels"),
        ("of", "pixels"),
        ("shown through", "%"),
    ];
    let mut table = Table::new(format!("Cures, {}: tilts up to 8, and bodies", measured.projection.name()), &columns);
    for (cure, counts) in &measured.within {
        let Counts { seen, buried, buried_within, seen_within, hidden, shown: through, ties, .. } = *counts;
        let counts: [Cell; 7] = [
            buried_within.into(),
            seen_within.into(),
            (buried - buried_within - ties).into(),
            (seen - seen_within).into(),
            through.into(),
            hidden.into(),
            shown(counts).into(),
        ];
        table.rows.push([Cell::from(name(*cure))].into_iter().chain(counts).collect());
    }
    table
}

fn tilts(measured: &Measured) -> Table {
    let columns = [
        ("tilt", ""),
        ("buried: no cure", "%"),
        ("S = 8", "%"),
        ("S = 1.39 tilt", "%"),
        ("offset 1, 1", "%"),
        ("offset 0.5, 1", "%"),
        ("shown through: no cure", "%"),
        ("S = 8", "%"),
        ("S = 1.39 tilt", "%"),
        ("offset 1, 1", "%"),
        ("offset 0.5, 1", "%"),
    ];
    let mut table = Table::new(format!("Planes by tilt, {}", measured.projection.name()), &columns);
    for Tilt { tilt, nothing, decal, own, usual, tuned } in &measured.tilts {
        let all = [nothing, decal, own, usual, tuned];
        let cells = [*tilt].into_iter().chain(all.map(buried)).chain(all.map(shown));
        table.rows.push(cells.map(Cell::from).collect());
    }
    table
}

fn line(name: String, points: Vec<[f64; 2]>) -> Series {
    Series { name, points, labels: Vec::new(), kind: Kind::Line }
}

fn curve(what: &str, measured: &[Measured], of: fn(&Counts) -> f64) -> Plot {
    let series = measured.iter().map(|measured| {
        let points = measured.slopes.iter().map(|(slope, counts)| [*slope, of(counts)]).collect();
        line(measured.projection.name().to_owned(), points)
    });
    Plot {
        title: format!("Marking pixels {what}, over S; all scenes"),
        x: Axis::linear("slope S"),
        y: Axis::linear(format!("{what}, %")),
        series: series.collect(),
    }
}

/// Buried against shown through: what each kind of cure can reach.
fn trade(measured: &[Measured]) -> Plot {
    let mut series = Vec::new();
    for measured in measured.iter().filter(|measured| measured.projection == Projection::Perspective) {
        let family = |name: &str, pick: fn(&Cure) -> Option<String>| {
            let some = measured.within.iter().filter_map(|(cure, counts)| Some((pick(cure)?, counts)));
            let (labels, points) = some.map(|(label, counts)| (label, [shown(counts), buried(counts)])).unzip();
            Series { name: name.to_owned(), points, labels, kind: Kind::Marks }
        };
        series.push(family("", |cure| match cure {
            Cure::Nothing => Some("no cure".to_owned()),
            Cure::Decal(slope) => Some(format!("S = {slope}")),
            _ => None,
        }));
        series.push(family("", |cure| match cure {
            Cure::Offset { factor, .. } if [0.25, 0.5, 1.0, 2.0].contains(factor) => Some(format!("factor {factor}")),
            _ => None,
        }));
        series.push(family("", |cure| match cure {
            Cure::Offset { factor: 0.0, units } => Some(format!("{units} units")),
            _ => None,
        }));
    }
    Plot {
        title: "Cures in perspective: planes of tilt 0 to 8, and bodies near to far".to_owned(),
        x: Axis::linear("shown through, %"),
        y: Axis::logarithmic("buried, %"),
        series,
    }
}

/// A part of a picture with the wrong pixels marked.
fn crop(subject: &Subject, outcome: &Outcome, [left, top]: [u32; 2], size: u32) -> crate::picture::Picture {
    // Markings in the pale colour of paper, so that what is wrong stands out.
    let mut marked: Vec<u32> =
        outcome.picture.iter().map(|&pixel| if pixel == MARKING { 0x00E8_E4D8 } else { pixel }).collect();
    for (fragment, &seen) in subject.pixels.iter().zip(&outcome.shown) {
        match (fragment.answer, seen) {
            (Answer::Seen, false) => marked[place(fragment.pixel)] = BURIED,
            (Answer::Hidden, true) => marked[place(fragment.pixel)] = THROUGH,
            _ => {}
        }
    }
    let rows = (top..top + size).flat_map(|j| (left..left + size).map(move |i| [i, j]));
    let pixels: Vec<u32> = rows.map(|pixel| marked[place(pixel)]).collect();
    picture([size, size], &pixels)
}

fn strip(desk: &mut Desk, subject: &Subject, corner: [u32; 2], size: u32, cures: &[Cure]) -> Drawn<Vec<Panel>> {
    let mut panels = Vec::new();
    for &cure in cures {
        let outcome = subject.draw(desk, cure)?;
        let counts = subject.count(&outcome, LIMIT);
        let name = format!("{}: {} buried, {} shown through", name(cure), counts.buried, counts.shown);
        panels.push(Panel { name, picture: crop(subject, &outcome, corner, size) });
    }
    Ok(panels)
}

fn body_strip(desk: &mut Desk) -> Drawn<Strip> {
    let subject = Subject::new(bodies(Projection::Perspective));
    let constant = Cure::Offset { factor: 0.0, units: 16_384.0 };
    let cures = [Cure::Nothing, Cure::Decal(LIMIT), Cure::Decal(64.0), USUAL, constant];
    Ok(Strip {
        title: "Faceted bodies 4 to 500 units away, all edges marked".to_owned(),
        panels: strip(desk, &subject, [0, 0], SIDE, &cures)?,
        caption: "Red: buried. Magenta: shown through. Counts are those of the whole picture.".to_owned(),
    })
}

fn patch_strip(desk: &mut Desk) -> Drawn<Strip> {
    let patch =
        Patch { projection: Projection::Orthographic, tilt: LIMIT, azimuth: 33.0, distance: 500.0, reach: 80.0 };
    let subject = Subject::new(patch.behind("", 5.0));
    let cures = [Cure::Nothing, Cure::Decal(4.0), Cure::Decal(LIMIT), Cure::Decal(16.0), USUAL];
    Ok(Strip {
        title: "A plane of tilt 8, five pixels behind a parallel sheet; the upper left corner".to_owned(),
        panels: strip(desk, &subject, [10, 10], 88, &cures)?,
        caption:
            "Red: buried, beside the sheet. Magenta: shown through the sheet. Counts are those of the whole picture."
                .to_owned(),
    })
}
