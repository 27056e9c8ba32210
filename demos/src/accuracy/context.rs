//! What a section is measured with: seed, effort, size, threads, the mesh, and where progress is told.

use std::path::PathBuf;

use super::report::Origin;
use crate::error::{Error, Result};
use crate::mesh::{self, Mesh};
use crate::picture::Picture;
use crate::teapot::Teapot;

/// How long the measuring may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Everything in under a minute on two cores.
    Quick,
    /// Small standard errors.
    Full,
}

impl Effort {
    /// Its name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }

    /// One of two numbers.
    pub const fn pick<T: Copy>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// What to measure with.
#[derive(Clone, Debug)]
pub struct Options {
    /// Seed of all random scenes.
    pub seed: u64,
    /// How long it may take.
    pub effort: Effort,
    /// Pixels of a row, and rows, of scenes that show a mesh.
    pub size: [u32; 2],
    /// Host threads that draw; 0 takes all cores.
    pub threads: usize,
    /// A mesh file; without one the teapot.
    pub mesh: Option<PathBuf>,
}

/// What every section gets.
pub struct Context<'a> {
    /// Seed of all random scenes.
    pub seed: u64,
    /// How long it may take.
    pub effort: Effort,
    /// Pixels of a row, and rows, of scenes that show the mesh.
    pub size: [u32; 2],
    /// Host threads that draw; 0 takes all cores.
    pub threads: usize,
    /// The mesh of all scenes that show one.
    pub mesh: Mesh,
    tell: &'a mut dyn FnMut(&str),
}

impl<'a> Context<'a> {
    /// Reads the mesh. `tell` is called with what is being measured, now and then.
    ///
    /// # Errors
    /// What is wrong with the mesh file.
    pub fn new(options: &Options, tell: &'a mut dyn FnMut(&str)) -> Result<Self> {
        let mesh = match &options.mesh {
            Some(file) => mesh::load(file)?,
            None => Teapot::new(8, [222, 226, 234, 255]).mesh().clone(),
        };
        if mesh.indices.is_empty() {
            let reason = "has no triangles to measure with".to_owned();
            return Err(Error::Mesh { file: options.mesh.clone().unwrap_or_default(), reason });
        }
        let Options { seed, effort, size, threads, .. } = *options;
        Ok(Self { seed, effort, size, threads, mesh, tell })
    }

    /// Tells what is being measured.
    pub fn tell(&mut self, what: &str) {
        (self.tell)(what);
    }
}

/// A picture of XRGB8888 words.
#[must_use]
pub fn picture([width, height]: [u32; 2], pixels: &[u32]) -> Picture {
    let rgb = pixels.iter().flat_map(|pixel| pixel.to_be_bytes()[1..].to_vec()).collect();
    Picture { width, height, rgb }
}

/// Where and when figures are taken.
pub(super) fn origin(options: &Options) -> Origin {
    let threads = match options.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    Origin {
        seed: options.seed,
        date: today(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        processor: processor(),
        threads,
        effort: options.effort.name(),
    }
}

/// What the processor calls itself, where the system tells.
fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name));
    name.map_or_else(|| format!("{} processor", std::env::consts::ARCH), str::to_owned)
}

/// The day in Greenwich, as 2026-01-31.
fn today() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    let [year, month, day] = date((since.map_or(0, |since| since.as_secs()) / 86_400) as i64);
    format!("{year:04}-{month:02}-{day:02}")
}

/// The date of a day counted from 1970-01-01, in the Gregorian calendar; years begin in March inside, so that the leap
/// day is their last.
fn date(days: i64) -> [i64; 3] {
    let days = days + 719_468;
    let era = days.div_euclid(146_097);
    let day_of_era = days.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    [year_of_era + era * 400 + i64::from(month <= 2), month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn date_of_days_with_and_without_leap_days() {
        let dates = [0, 59, 11_016, 11_017, 20_783].map(date);
        assert_eq!(dates, [[1970, 1, 1], [1970, 3, 1], [2000, 2, 29], [2000, 3, 1], [2026, 11, 26]]);
    }
}
