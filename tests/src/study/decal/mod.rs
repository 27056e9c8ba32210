//! Surface markings: how many of their pixels are buried and how many show through, by every cure, against exact
//! arithmetic.
//!
//! * *Buried*: exact arithmetic says that the marking is seen at that pixel, and the card does not show it.
//! * *Shown through*: exact arithmetic says that another surface hides it, and the card shows it.
//!
//! | module | holds |
//! | --- | --- |
//! | `scene` | tilted patches with lines, a curve and points, with and without a sheet in front; a floor; round bodies near to far |
//! | `exact` | what must be seen, in rationals |
//! | [`survey`] | the scenes of the report, and sums over them |
//! | `card` | the same scenes by driver and card: decals of any slope and fitted ones, none, surfaces moved away, polygon offset |
//!
//! Source of the cure: JP 2579421 B2 / US 5,379,370. Polygon offset: OpenGL 4.6 (core profile), section 14.6.5.

mod card;
mod exact;
mod scene;
pub mod survey;

pub use card::{Cure, Desk, MARKING};
pub use exact::{Answer, Fragment};
pub use scene::{Marking, Patch, Place, Projection, SIDE, Scene, bodies, floor};

use std::collections::BTreeMap;

use zga_driver::DriverError;

/// Asks exact arithmetic about many scenes, on two threads.
#[must_use]
pub fn subjects(scenes: Vec<Scene>) -> Vec<Subject> {
    let (mut first, mut second) = (Vec::new(), Vec::new());
    for (number, scene) in scenes.into_iter().enumerate() {
        [&mut first, &mut second][number % 2].push((number, scene));
    }
    let ask = |scenes: Vec<(usize, Scene)>| -> Vec<(usize, Subject)> {
        scenes.into_iter().map(|(number, scene)| (number, Subject::new(scene))).collect()
    };
    let mut all = std::thread::scope(|scope| {
        let other = scope.spawn(|| ask(second));
        let mut all = ask(first);
        all.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        all
    });
    all.sort_by_key(|(number, _)| *number);
    all.into_iter().map(|(_, subject)| subject).collect()
}

/// A scene with what exact arithmetic says of it.
pub struct Subject {
    /// The scene.
    pub scene: Scene,
    truth: exact::Truth,
    /// One for each pixel with a marking, row by row.
    pub pixels: Vec<Fragment>,
}

/// What a cure made of a scene's pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pixels at which a marking must be seen.
    pub seen: u64,
    /// Of these, not shown.
    pub buried: u64,
    /// As `buried`, where the surface is no steeper than the limit that was asked about.
    pub buried_within: u64,
    /// As `seen`, with the same limit.
    pub seen_within: u64,
    /// Pixels at which all markings are hidden.
    pub hidden: u64,
    /// Of `buried`, at the very limit: the marking moved by S / 2 and the surface are within a step of depth there, and
    /// its rounding decides. Not in `buried_within`.
    pub ties: u64,
    /// Of `hidden`, shown.
    pub shown: u64,
    /// Pixels that are not counted: see [`Answer::Undecided`].
    pub undecided: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.seen += other.seen;
        self.buried += other.buried;
        self.buried_within += other.buried_within;
        self.seen_within += other.seen_within;
        self.ties += other.ties;
        self.hidden += other.hidden;
        self.shown += other.shown;
        self.undecided += other.undecided;
    }
}

/// A cure's picture of a subject.
pub struct Outcome {
    /// XRGB, row by row.
    pub picture: Vec<u32>,
    /// For each of the subject's pixels, whether it shows a marking.
    pub shown: Vec<bool>,
}

impl Subject {
    /// Asks exact arithmetic.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let truth = exact::Truth::new(&scene);
        let mut by_pixel: BTreeMap<[u32; 2], Fragment> = BTreeMap::new();
        for fragment in truth.fragments(&scene) {
            let [i, j] = fragment.pixel;
            by_pixel.entry([j, i]).and_modify(|held| *held = either(*held, fragment)).or_insert(fragment);
        }
        Self { scene, truth, pixels: by_pixel.into_values().collect() }
    }

    /// Draws it.
    ///
    /// # Errors
    /// What the driver refuses, for example a slope with S/2K of 1 or more.
    pub fn draw(&self, desk: &mut Desk, cure: Cure) -> Result<Outcome, DriverError> {
        let picture = desk.draw(&self.scene, &self.truth, cure)?;
        let shown = self.pixels.iter().map(|fragment| picture[place(fragment.pixel)] == MARKING).collect();
        Ok(Outcome { picture, shown })
    }

    /// Counts; `limit` is the slope of [`Counts::buried_within`].
    #[must_use]
    pub fn count(&self, outcome: &Outcome, limit: f64) -> Counts {
        let mut counts = Counts::default();
        for (fragment, &shown) in self.pixels.iter().zip(&outcome.shown) {
            let within = u64::from(fragment.slope <= limit * (1.0 + 1e-9));
            match fragment.answer {
                Answer::Undecided => counts.undecided += 1,
                Answer::Hidden => {
                    counts.hidden += 1;
                    counts.shown += u64::from(shown);
                }
                Answer::Seen => {
                    counts.seen += 1;
                    counts.seen_within += within;
                    counts.buried += u64::from(!shown);
                    // A step of depth is 999 units over 2^24, in pixels of 1/64 unit; less in perspective.
                    let tie = u64::from((fragment.need - limit / 2.0).abs() < 64.0 * 999.0 / 16_777_216.0);
                    counts.ties += u64::from(!shown) * tie;
                    counts.buried_within += u64::from(!shown) * within * (1 - tie);
                }
            }
        }
        counts
    }

    /// Pixels of the card's markings that are not the oracle's: without a decal, with one of this slope, with one fitted.
    ///
    /// # Errors
    /// As [`Subject::draw`].
    pub fn strays(&self, desk: &mut Desk, slope: f64) -> Result<[usize; 3], DriverError> {
        let mut mine = vec![false; (SIDE * SIDE) as usize];
        self.pixels.iter().for_each(|fragment| mine[place(fragment.pixel)] = true);
        let mut differ = |cure| -> Result<usize, DriverError> {
            let cards = desk.markings_alone(&self.scene, cure)?;
            Ok(cards.iter().zip(&mine).filter(|(card, mine)| card != mine).count())
        };
        Ok([differ(Cure::Nothing)?, differ(Cure::Decal(slope))?, differ(Cure::Fitted(slope))?])
    }
}

/// Where a pixel is in a picture.
#[must_use]
pub const fn place([i, j]: [u32; 2]) -> usize {
    (j * SIDE + i) as usize
}

/// Two markings at a pixel: one that must be seen is enough; one that is undecided leaves it so.
fn either(a: Fragment, b: Fragment) -> Fragment {
    match (a.answer, b.answer) {
        (Answer::Undecided, _) | (Answer::Seen, Answer::Hidden) => a,
        (_, Answer::Undecided) | (Answer::Hidden, Answer::Seen) => b,
        _ if a.slope <= b.slope => a,
        _ => b,
    }
}

#[cfg(test)]
mod fitted_tests;
#[cfg(test)]
mod tests;
