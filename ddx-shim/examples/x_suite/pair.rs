//! Pair: a scene on two servers, compared; a difference narrowed down to the request that makes it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use zga_ddx_shim::session::{Options, Session};

use super::Fault;
use super::play::{Outcome, Part, Shot, play};
use super::scene::{Kind, Request, Scene};

/// How long a server may work on one scene before it counts as hung. It is a thousand times what the slowest takes.
const HUNG: Duration = Duration::from_secs(120);

/// Two servers: one that is tested, one that is right.
pub struct Pair {
    pub tested: Session,
    pub right: Session,
    watch: Watch,
}

/// Ends servers that hang, so that whoever waits for them hears of it.
struct Watch {
    /// Milliseconds from `start` at which the work under way began; 0 while there is none.
    since: Arc<AtomicU64>,
    start: Instant,
}

impl Watch {
    fn new(processes: Vec<u32>) -> Watch {
        let (since, start) = (Arc::new(AtomicU64::new(0)), Instant::now());
        let watched = Arc::downgrade(&since);
        std::thread::spawn(move || {
            while let Some(since) = watched.upgrade() {
                let began = since.load(Ordering::SeqCst);
                if began > 0 && start.elapsed() > Duration::from_millis(began) + HUNG {
                    eprintln!("a server did not answer for {} s and is ended", HUNG.as_secs());
                    for process in processes.iter().filter_map(|process| Pid::from_raw(*process as i32)) {
                        // With a core for whoever has asked for one.
                        let _ = kill_process(process, Signal::ABORT);
                    }
                    return;
                }
                drop(since);
                std::thread::sleep(Duration::from_millis(500));
            }
        });
        Watch { since, start }
    }

    /// Watches over `work`.
    fn over<T>(&self, work: impl FnOnce() -> T) -> T {
        self.since.store(self.start.elapsed().as_millis() as u64 + 1, Ordering::SeqCst);
        let done = work();
        self.since.store(0, Ordering::SeqCst);
        done
    }
}

/// A difference between two outcomes.
pub struct Difference {
    pub told: String,
    pub shots: Option<[Shot; 2]>,
}

/// Compares; `None` if there is no difference.
pub fn compare(tested: &Outcome, right: &Outcome) -> Option<Difference> {
    if tested.errors != right.errors {
        let odd = tested.errors.iter().zip(&right.errors).find(|(one, other)| one != other);
        let (one, other) = (tested.errors.len(), right.errors.len());
        return Some(Difference { told: format!("errors: {one} and {other}, first pair {odd:?}"), shots: None });
    }
    if tested.shots.len() != right.shots.len() {
        return Some(Difference { told: "not as many pictures".to_owned(), shots: None });
    }
    let (one, other) = tested.shots.iter().zip(&right.shots).find(|(one, other)| one != other)?;
    let (found, expected) = (one.pixels(), other.pixels());
    let odd: Vec<usize> = (0..found.len().min(expected.len())).filter(|at| found[*at] != expected[*at]).collect();
    let width = usize::from(one.size[0]);
    let first = odd.first().map_or("in bits that are no pixels".to_owned(), |at| {
        format!("({}, {}): {:08x}, expected {:08x}", at % width, at / width, found[*at], expected[*at])
    });
    let told = format!("{}: {} pixels differ, the first at {first}", one.name, odd.len());
    Some(Difference { told, shots: Some([one.clone(), other.clone()]) })
}

impl Pair {
    /// Starts both.
    pub fn start(tested: &Options, right: &Options) -> Result<Pair, Fault> {
        let (tested, right) = (Session::start(tested)?, Session::start(right)?);
        let watch = Watch::new(vec![tested.process(), right.process()]);
        Ok(Pair { tested, right, watch })
    }

    /// What a part of a scene comes to on each.
    pub fn outcomes(&mut self, scene: &Scene, part: Part, without: Option<usize>) -> Result<[Outcome; 2], Fault> {
        let one = |session: &mut Session, part: Part| {
            self.watch.over(|| play(session, scene, part)).map_err(|fault| {
                // A moment, in which a server that has crashed is found dead.
                std::thread::sleep(Duration::from_millis(300));
                match session.check() {
                    Err(ended) => Fault::Session(ended),
                    Ok(()) => Fault::Play(fault),
                }
            })
        };
        let tested = one(&mut self.tested, Part { without, ..part })?;
        Ok([tested, one(&mut self.right, part)?])
    }

    /// Plays a scene on both; where they differ, what by, from which request on, and pictures in `folder`.
    /// `without`: a request that the tested server does not get.
    pub fn scene(&mut self, scene: &Scene, without: Option<usize>, folder: &Path) -> Result<Option<Found>, Fault> {
        let part = |requests| Part { requests, without: None };
        let whole = scene.requests.len();
        let [tested, right] = self.outcomes(scene, part(whole), without)?;
        let Some(mut difference) = compare(&tested, &right) else { return Ok(None) };
        // The shortest beginning that differs: what differs once may be drawn over, so it is the first that a search
        // by halves comes upon, and the one before it does not differ.
        let (mut equal, mut differs) = (0, whole);
        while differs - equal > 1 {
            let middle = (equal + differs) / 2;
            let [tested, right] = self.outcomes(scene, part(middle), without)?;
            match compare(&tested, &right) {
                Some(found) => (differs, difference) = (middle, found),
                None => equal = middle,
            }
        }
        let files = match &difference.shots {
            Some(shots) => save(shots, &folder.join(format!("seed-{}", scene.seed)))?,
            None => Vec::new(),
        };
        let number = differs - 1;
        let request = scene.told(number);
        Ok(Some(Found { seed: scene.seed, number, request, told: difference.told, files }))
    }
}

/// A scene that differs.
pub struct Found {
    pub seed: u64,
    /// The request that it begins with.
    pub number: usize,
    pub request: String,
    pub told: String,
    pub files: Vec<PathBuf>,
}

impl std::fmt::Display for Found {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(to, "seed {}: differs from request {} on: {}", self.seed, self.number, self.request)?;
        writeln!(to, "  {}", self.told)?;
        self.files.iter().try_for_each(|file| writeln!(to, "  {}", file.display()))
    }
}

/// Saves what was found, what was expected, and where they differ.
fn save([found, expected]: &[Shot; 2], stem: &Path) -> Result<Vec<PathBuf>, Fault> {
    let (one, other) = (found.pixels(), expected.pixels());
    let odd = one.iter().zip(&other).map(|(one, other)| match one == other {
        true => 0xFF_FFFF - (other >> 2 & 0x3F_3F3F),
        false => 0xDC_143C,
    });
    let odd: Vec<u32> = odd.collect();
    let mut files = Vec::new();
    for (name, pixels) in [("found", &one), ("expected", &other), ("difference", &odd)] {
        let file = stem.with_extension(format!("{name}.png"));
        save_png(&file, found.size.map(u32::from), pixels)?;
        files.push(file);
    }
    Ok(files)
}

/// Writes XRGB8888 words as a PNG.
pub fn save_png(file: &Path, [width, height]: [u32; 2], pixels: &[u32]) -> Result<(), Fault> {
    let fault = |reason: String| Fault::File(file.to_path_buf(), reason);
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|reason| fault(reason.to_string()))?;
    }
    let bytes: Vec<u8> =
        pixels.iter().flat_map(|pixel| [(pixel >> 16) as u8, (pixel >> 8) as u8, *pixel as u8]).collect();
    let kind = image::ExtendedColorType::Rgb8;
    image::save_buffer_with_format(file, &bytes, width, height, kind, image::ImageFormat::Png)
        .map_err(|reason| fault(reason.to_string()))
}

/// A scene with a blot at its end, where nothing can draw over it, and the blot's number.
pub fn blotted(seed: u64, kind: Kind) -> (Scene, usize) {
    let mut scene = Scene::new(seed, kind);
    let at = scene.requests.len();
    let on = scene.surfaces.len() - 1;
    scene.requests.push(Request::Blot { on, at: [3, 3] });
    (scene, at)
}
