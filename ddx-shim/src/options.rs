//! Options of the Device section: names, values, and what is wrong with them.

use std::path::PathBuf;

/// Video memory when nothing is said, MiB.
const DEFAULT_MEMORY: u32 = 64;
/// Sizes of video memory that a card is made with, MiB.
const MEMORY: std::ops::RangeInclusive<u32> = 2..=1024;
/// Pixels that the server's renderer draws in the time that waking the card's thread and waiting for it takes.
const DEFAULT_LIMIT: u32 = 1 << 15;
/// Most threads that are worth asking for.
const MOST_THREADS: u32 = 256;

/// What the Device section asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Path of the socket for viewers; none: nobody can look.
    pub link: Option<PathBuf>,
    /// Video memory of the card, MiB.
    pub video_memory: u32,
    /// The card draws; without, the server's renderer does everything, in the card's memory.
    pub accel: bool,
    /// Threads that the card computes with; 0: all cores.
    pub threads: usize,
    /// Pixels of work under which a card that has nothing to do is not woken; 0: it always is.
    pub cpu_limit: u32,
}

impl Default for Options {
    fn default() -> Self {
        Options { link: None, video_memory: DEFAULT_MEMORY, accel: true, threads: 0, cpu_limit: DEFAULT_LIMIT }
    }
}

/// Why an option is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OptionError {
    /// There is no such option.
    #[error("Option \"{name}\" is unknown to driver zga; it has Link, VideoMemory, Accel, Threads and CpuLimit")]
    Unknown {
        /// As it stands in the file.
        name: String,
    },
    /// The value means nothing.
    #[error("Option \"{name}\" \"{found}\": expected {expected}")]
    Value {
        /// As it stands in the file.
        name: String,
        /// As it stands in the file.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
}

impl Options {
    /// The options of a section in its order; of an option that stands there twice the first counts, as for the server.
    ///
    /// # Errors
    /// The first one that cannot be meant: [`OptionError`].
    pub fn parse<'a>(section: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Options, OptionError> {
        let mut options = Options::default();
        let mut seen = Vec::new();
        for (name, value) in section {
            let plain = plain(name);
            // "Monitor-OUTPUT" ties a Monitor section to an output; the server reads it itself.
            if plain.starts_with("monitor-") || seen.contains(&plain) {
                continue;
            }
            let wrong = |expected| OptionError::Value { name: name.to_owned(), found: value.to_owned(), expected };
            match plain.as_str() {
                "link" => {
                    // An address of a Unix socket has room for 107 bytes.
                    let good = value.starts_with('/') && value.len() < 108;
                    let path = good.then(|| PathBuf::from(value));
                    options.link = Some(path.ok_or_else(|| wrong("an absolute path of at most 107 bytes"))?);
                }
                "videomemory" => {
                    let size = value.parse::<u32>().ok().filter(|size| MEMORY.contains(size));
                    options.video_memory = size.ok_or_else(|| wrong("MiB, from 2 to 1024"))?;
                }
                "accel" => {
                    options.accel =
                        boolean(value).ok_or_else(|| wrong("on or off, true or false, yes or no, 1 or 0"))?;
                }
                "threads" => {
                    let threads = value.parse::<u32>().ok().filter(|threads| *threads <= MOST_THREADS);
                    options.threads =
                        threads.ok_or_else(|| wrong("a number of threads up to 256, or 0 for all cores"))? as usize;
                }
                "cpulimit" => {
                    let limit = value.parse::<u32>().ok().filter(|limit| *limit <= 1 << 30);
                    options.cpu_limit = limit.ok_or_else(|| wrong("a number of pixels up to 1073741824"))?;
                }
                _ => return Err(OptionError::Unknown { name: name.to_owned() }),
            }
            seen.push(plain);
        }
        Ok(options)
    }
}

/// A name without what the server's configuration does not tell apart: case, blanks and underlines.
fn plain(name: &str) -> String {
    name.chars()
        .filter(|letter| !matches!(letter, '_' | ' ' | '\t'))
        .map(|letter| letter.to_ascii_lowercase())
        .collect()
}

/// What the server's configuration takes for a boolean; nothing at all is true.
fn boolean(value: &str) -> Option<bool> {
    match value.to_ascii_lowercase().as_str() {
        "" | "1" | "on" | "true" | "yes" => Some(true),
        "0" | "off" | "false" | "no" => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parse_all_options_in_the_spelling_of_the_server() {
        let section =
            [("link", "/run/zga"), ("Video_Memory", "16"), ("ACCEL", "off"), ("Threads", "2"), ("CPU_limit", "0")];
        let expected =
            Options { link: Some("/run/zga".into()), video_memory: 16, accel: false, threads: 2, cpu_limit: 0 };
        assert_eq!(Options::parse(section), Ok(expected));
    }

    #[test]
    fn parse_nothing_gives_the_defaults() {
        assert_eq!(
            Options::parse([]),
            Ok(Options { link: None, video_memory: 64, accel: true, threads: 0, cpu_limit: 32768 })
        );
    }

    #[test]
    fn parse_first_of_two_counts_and_monitor_is_the_servers() {
        let section = [("VideoMemory", "8"), ("Monitor-ZGA-1", "Left"), ("VideoMemory", "9")];
        assert_eq!(Options::parse(section).map(|options| options.video_memory), Ok(8));
    }

    #[test]
    fn parse_bad_values_are_named() {
        for (name, value) in [
            ("Link", "relative"),
            ("VideoMemory", "1"),
            ("VideoMemory", "1025"),
            ("VideoMemory", "64 MB"),
            ("Accel", "maybe"),
            ("Threads", "-1"),
            ("CpuLimit", "none"),
        ] {
            let error = Options::parse([(name, value)]).expect_err(name);
            assert!(matches!(error, OptionError::Value { .. }));
            assert!(error.to_string().starts_with(&format!("Option \"{name}\" \"{value}\": expected ")));
        }
        assert!(Options::parse([("Link", "/".repeat(108).as_str())]).is_err());
    }

    #[test]
    fn parse_unknown_option_is_refused() {
        let error = Options::parse([("Acell", "on")]).expect_err("unknown");
        assert_eq!(error, OptionError::Unknown { name: "Acell".to_owned() });
    }
}
