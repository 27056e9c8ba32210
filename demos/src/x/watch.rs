//! A window, or files, that follow the frames of a source until something ends.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use minifb::Window;

use super::input::Input;
use super::source::{Seen, Source};
use crate::error::{Error, Result};

/// Longest wait for a frame before the rest is looked after.
const FRAME_WAIT: Duration = Duration::from_millis(20);

/// Where pictures go, and when.
#[derive(Clone, Debug)]
pub(crate) struct Captures {
    /// A file that ends in .png, or a folder.
    pub out: PathBuf,
    /// Time between pictures; one at the end without.
    pub every: Option<Duration>,
}

impl Captures {
    /// File of picture number `number`.
    fn file(&self, number: u32) -> PathBuf {
        match self.every {
            None if self.is_file() => self.out.clone(),
            None => self.out.join("x.png"),
            Some(_) => self.out.join(format!("x-{number:04}.png")),
        }
    }

    /// Is one file asked for?
    pub(crate) fn is_file(&self) -> bool {
        self.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
    }
}

/// True from the moment at which the user asks the program to end.
///
/// # Errors
/// [`Error::Use`] if the system lets no one hear of it.
pub(crate) fn asked_to_end() -> Result<Arc<AtomicBool>> {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&asked))
            .map_err(|reason| Error::Use(format!("signal {signal} cannot be watched for: {reason}")))?;
    }
    Ok(asked)
}

/// What follows the frames.
pub(crate) struct Watch {
    pub window: Option<Window>,
    /// Mouse and keyboard of the window, where they are passed on.
    pub input: Option<Input>,
    pub captures: Option<Captures>,
    /// When it ends by itself.
    pub seconds: Option<f64>,
    pub asked_to_end: Arc<AtomicBool>,
}

impl Watch {
    /// Follows frames until the window is closed, the time is over, the user asks, or `goes_on` says no. Returns the files
    /// that were written.
    ///
    /// # Errors
    /// What `goes_on` says, and what ended the source; [`Error::Write`].
    pub(crate) fn run(
        &mut self,
        source: &mut dyn Source,
        mut goes_on: impl FnMut() -> Result<bool>,
    ) -> Result<Vec<PathBuf>> {
        let began = Instant::now();
        let end = self.seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()).map(|after| began + after);
        let every = self.captures.as_ref().and_then(|captures| captures.every);
        let mut due = every.map(|every| began + every);
        let (mut newest, mut files): (Option<Seen>, Vec<PathBuf>) = (None, Vec::new());
        loop {
            let over = end.is_some_and(|end| Instant::now() >= end) || self.asked_to_end.load(Ordering::SeqCst);
            if over || !goes_on()? {
                break;
            }
            let next = match source.next(FRAME_WAIT) {
                Ok(next) => next,
                // Whoever is asked whether it goes on may know better why there is nothing more.
                Err(fault) => {
                    std::thread::sleep(FRAME_WAIT * 10);
                    if !goes_on()? {
                        break;
                    }
                    return Err(fault);
                }
            };
            let changed = next.is_some();
            newest = next.or(newest);
            if let Some(window) = &mut self.window {
                // A window that cannot be drawn to any more is as good as closed.
                let shown = match newest.as_ref().filter(|_| changed) {
                    Some(seen) => {
                        let size = seen.size.map(|pixels| pixels as usize);
                        window.update_with_buffer(&seen.pixels, size[0], size[1]).is_ok()
                    }
                    None => {
                        window.update();
                        true
                    }
                };
                if !shown || !window.is_open() {
                    break;
                }
                if let Some(input) = &mut self.input {
                    input.pass(window)?;
                }
            }
            if let (Some(moment), Some(every)) = (due, every)
                && Instant::now() >= moment
            {
                due = Some(moment + every);
                self.save(newest.as_ref(), &mut files)?;
            }
        }
        // One more look: what was drawn last may not have come yet.
        if self.captures.is_some() && every.is_none() {
            if let Ok(Some(seen)) = source.next(FRAME_WAIT * 5) {
                newest = Some(seen);
            }
            self.save(newest.as_ref(), &mut files)?;
        }
        Ok(files)
    }

    fn save(&self, seen: Option<&Seen>, files: &mut Vec<PathBuf>) -> Result<()> {
        if let (Some(captures), Some(seen)) = (&self.captures, seen) {
            let file = captures.file(files.len() as u32);
            seen.picture().save(&file)?;
            files.push(file);
        }
        Ok(())
    }
}

/// Refuses one file for many pictures.
///
/// # Errors
/// [`Error::Use`].
pub(crate) fn check_out(out: Option<&Path>, every: Option<f64>) -> Result<()> {
    let captures = out.map(|out| Captures { out: out.to_path_buf(), every: None });
    match (captures, every) {
        (Some(captures), Some(every)) if captures.is_file() => {
            let path = captures.out.display();
            Err(Error::Use(format!("--out {path} is one file, but --every {every} asks for many: name a folder")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives so many frames, each of one pixel with its number, and then fails.
    struct Frames(u32, u32);

    impl Source for Frames {
        fn next(&mut self, _: Duration) -> Result<Option<Seen>> {
            self.0 += 1;
            match self.0 <= self.1 {
                true => Ok(Some(Seen { size: [1, 1], pixels: vec![self.0] })),
                false => Err(Error::Use("no more frames".to_owned())),
            }
        }
    }

    fn watch(captures: Option<Captures>) -> Watch {
        Watch { window: None, input: None, captures, seconds: None, asked_to_end: Arc::default() }
    }

    #[test]
    fn watch_saves_the_newest_frame_at_its_end() {
        let folder = std::env::temp_dir().join(format!("zga-watch-{}", std::process::id()));
        let captures = Captures { out: folder.join("last.png"), every: None };
        let mut left = 4;
        let goes_on = || {
            left -= 1;
            Ok(left > 0)
        };
        let files = watch(Some(captures)).run(&mut Frames(0, 100), goes_on).expect("watched");
        assert_eq!(files, [folder.join("last.png")]);
        // Three while it went on, and one more look.
        assert_eq!(crate::picture::Picture::load(&files[0]).expect("saved").rgb, [0, 0, 4]);
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn source_that_ends_is_an_error_unless_it_was_to_end() {
        let fault = watch(None).run(&mut Frames(0, 2), || Ok(true)).expect_err("ended").to_string();
        assert_eq!(fault, "no more frames");
        let mut asked = 0;
        let knows = || {
            asked += 1;
            Ok(asked < 4)
        };
        assert!(watch(None).run(&mut Frames(0, 2), knows).is_ok());
    }

    #[test]
    fn watch_ends_when_its_time_is_over_or_the_user_asks() {
        let mut limited = Watch { seconds: Some(0.0), ..watch(None) };
        assert!(limited.run(&mut Frames(0, 0), || Ok(true)).is_ok());
        let mut asked = watch(None);
        asked.asked_to_end.store(true, Ordering::SeqCst);
        assert!(asked.run(&mut Frames(0, 0), || Ok(true)).is_ok());
    }

    #[test]
    fn many_pictures_into_one_file_are_refused() {
        assert!(check_out(Some(Path::new("a.png")), None).is_ok());
        assert!(check_out(Some(Path::new("folder")), Some(1.0)).is_ok());
        let told = check_out(Some(Path::new("a.png")), Some(1.0)).expect_err("refused").to_string();
        assert_eq!(told, "--out a.png is one file, but --every 1 asks for many: name a folder");
    }
}
