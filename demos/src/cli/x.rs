//! `zga x`: a stock X server on the card, with clients.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::Args;
use clap::builder::PossibleValuesParser;
use zga_ddx_shim::link::{self, Status, Viewer};
use zga_ddx_shim::session::{Client, Driver, Options, Session, find_module};

use super::flags::size;
use super::show::FOLDER;
use super::{Verdict, note, print};
use crate::error::{Error, Result};
use crate::picture;
use crate::window;
use crate::x::input::Input;
use crate::x::report;
use crate::x::source::{Screens, Source};
use crate::x::watch::{Captures, Watch, asked_to_end, check_out};

/// How long the card's link may take to answer.
const LINK_WAIT: Duration = Duration::from_secs(10);

/// Run X programs on the card: a stock X server whose screen is the card's memory
///
/// Starts the server, then the clients after --, and shows what the card puts out: in a window, with mouse and keyboard
/// passed on, or with --headless, --out, --report or no display as files. It ends with the clients, with --seconds, when
/// the window is closed or with Ctrl-C, and leaves nothing behind.
///
/// A client is a program and its arguments, or one text for the shell. --and starts another beside it, --then another
/// after all before it have ended.
///
/// The server and the module zga_drv.so have to be there: ddx-shim/setup.sh and ddx-shim/test.sh build.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga x -- xterm\n  zga x --size 800x600 -- twm --and xterm --and xclock -update 1\n  zga x --seconds 5 --out xterm.png --stats -- xterm -e 'seq 1 20000; sleep 60'\n  zga x --headless --out frames --every 0.5 -- 'xeyes & exec xclock -update 1'\n  zga x --driver dummy --seconds 2 --out dummy.png -- xcalc"
)]
pub(super) struct X {
    /// In a window; fails where there is no display
    #[arg(long, conflicts_with = "headless")]
    window: bool,
    /// No window
    #[arg(long)]
    headless: bool,
    /// Pixels of the screen
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    size: [u32; 2],
    /// Bits of a pixel that count
    #[arg(long, value_name = "N", default_value = "24", value_parser = PossibleValuesParser::new(["24", "16"]))]
    depth: String,
    /// Video memory in MiB
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..=1024))]
    memory: Option<u32>,
    /// Host threads that the card draws with
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=256))]
    threads: Option<u32>,
    /// Have the server draw in the card's memory instead of the card
    #[arg(long)]
    no_accel: bool,
    /// The server's driver: the card's, or the server's own without a card, to compare
    #[arg(long, value_name = "NAME", default_value = "zga", value_parser = PossibleValuesParser::new(["zga", "dummy"]))]
    driver: String,
    /// The module for the server, or its folder
    #[arg(long, value_name = "PATH")]
    module: Option<PathBuf>,
    /// Socket at which zga monitor can attach; in the default place without
    #[arg(long, value_name = "SOCKET")]
    link: Option<PathBuf>,
    /// Where pictures go: a file that ends in .png for the last frame, else a folder
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// A picture every so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    every: Option<f64>,
    /// End after so many seconds
    #[arg(long, value_name = "N", value_parser = seconds)]
    seconds: Option<f64>,
    /// Tell what the card has counted, and which effects and units were called
    #[arg(long)]
    stats: bool,
    /// Write that as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Clients: program and arguments, with --and and --then between them
    #[arg(last = true, value_name = "CLIENT")]
    clients: Vec<OsString>,
}

/// A time from the command line: more than 0, at most a year.
pub(super) fn seconds(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds <= 31_536_000.0 => Ok(seconds),
        _ => Err("expected a number of seconds above 0".to_owned()),
    }
}

/// Stages of clients, one after the other; those of a stage run side by side.
fn stages(words: &[OsString]) -> Result<Vec<Vec<Vec<OsString>>>> {
    let stages: Vec<Vec<Vec<OsString>>> = words
        .split(|word| word == "--then")
        .map(|stage| stage.split(|word| word == "--and").map(<[OsString]>::to_vec).collect())
        .collect();
    if stages.iter().flatten().any(Vec::is_empty) {
        let told = match words.is_empty() {
            true => "no client: name one after --, for example zga x -- xterm",
            false => "a client is missing: expected one before and after each --and and --then",
        };
        return Err(Error::Use(told.to_owned()));
    }
    Ok(stages)
}

/// The clients as they come and go.
struct Crowd {
    waiting: std::collections::VecDeque<Vec<Vec<OsString>>>,
    running: Vec<Client>,
    /// One has ended otherwise than well.
    failed: bool,
    quiet: bool,
}

impl Crowd {
    /// Starts who is due; false when all have ended.
    fn go_on(&mut self, session: &mut Session) -> Result<bool> {
        session.check()?;
        let failed = &mut self.failed;
        self.running.retain_mut(|client| match client.ended() {
            None => true,
            Some(status) => {
                if !status.success() {
                    *failed = true;
                    note(&format!("{}: ended with {status}", client.name().display()));
                }
                false
            }
        });
        if self.running.is_empty() {
            let Some(stage) = self.waiting.pop_front() else { return Ok(false) };
            for arguments in stage {
                self.running.push(session.client(&arguments, self.quiet)?);
            }
        }
        Ok(true)
    }
}

impl X {
    pub(super) fn run(&self) -> Result<Verdict> {
        check_out(self.out.as_deref(), self.every)?;
        let waiting = stages(&self.clients)?.into();
        let driver = match self.driver.as_str() {
            "dummy" => {
                if self.stats || self.report.is_some() || self.link.is_some() {
                    let told = "--driver dummy has no card: nothing to count, nothing to attach to";
                    return Err(Error::Use(told.to_owned()));
                }
                Driver::Dummy
            }
            _ => {
                let module = find_module(self.module.as_deref())?;
                let link = match &self.link {
                    Some(link) => std::path::absolute(link).map_err(Error::write(link))?,
                    None => link::socket_path(std::process::id())?,
                };
                Driver::Zga { module, link: Some(link), accel: !self.no_accel, cpu_limit: None }
            }
        };
        let asked_to_end = asked_to_end()?;
        let depth = if self.depth == "16" { 16 } else { 24 };
        let options = Options { driver, size: self.size, depth, memory: self.memory, threads: self.threads };
        let mut session = Session::start(&options)?;
        let done = self.in_session(&mut session, &options, waiting, asked_to_end);
        // Before anything is told: a server that fails at its end has failed.
        let ended = session.end();
        if let (Driver::Zga { link: Some(link), .. }, None) = (&options.driver, &self.link) {
            // There is one only if the server was killed, and nobody else would ever use its name.
            let _ = std::fs::remove_file(link);
        }
        let (done, failed) = done?;
        ended?;
        print(&done)?;
        Ok(if failed { Verdict::Bad } else { Verdict::Good })
    }

    /// Runs the clients; what is to be told, and whether one has failed.
    fn in_session(
        &self,
        session: &mut Session,
        options: &Options,
        waiting: std::collections::VecDeque<Vec<Vec<OsString>>>,
        asked_to_end: Arc<AtomicBool>,
    ) -> Result<(String, bool)> {
        let files = self.headless || self.out.is_some() || self.report.is_some();
        let mut window = match self.window || !files {
            true => window::open(&format!("X on {}", options.driver_name()), self.size),
            false => None,
        };
        match (&window, self.window, files) {
            (None, true, _) => return Err(Error::Use("--window: there is no display for it".to_owned())),
            (None, false, false) => note("no display: drawn to files"),
            _ => {}
        }
        let captures = match (&window, &self.out) {
            (_, Some(out)) => Some(out.clone()),
            (None, None) if self.report.is_none() || self.every.is_some() => Some(FOLDER.into()),
            _ => None,
        };
        let captures = captures.map(|out| Captures { out, every: self.every.map(Duration::from_secs_f64) });
        let input = match &mut window {
            Some(window) => Some(Input::new(session, window)?),
            None => None,
        };
        let mut viewer = match &options.driver {
            Driver::Zga { link: Some(link), .. } => Some(Viewer::connect(link, LINK_WAIT)?),
            _ => None,
        };
        let before = viewer.as_mut().map(|viewer| viewer.status(LINK_WAIT)).transpose()?;
        let mut screens;
        let source: &mut dyn Source = match &mut viewer {
            Some(viewer) => viewer,
            None => {
                screens = Screens::new(session)?;
                &mut screens
            }
        };
        let mut crowd = Crowd { waiting, running: Vec::new(), failed: false, quiet: false };
        let ended = Arc::clone(&asked_to_end);
        let mut watch = Watch { window, input, captures, seconds: self.seconds, asked_to_end };
        let saved = watch.run(source, || crowd.go_on(session))?;
        let after = viewer.as_mut().map(|viewer| viewer.status(LINK_WAIT)).transpose()?;
        crowd.running.iter_mut().for_each(Client::end);

        let mut text: String = saved.iter().map(|file| format!("{}\n", file.display())).collect();
        if let (Some(before), Some(after)) = (before, after) {
            text.push_str(&self.figures(&after.since(&before))?);
        }
        let failed = crowd.failed && !ended.load(Ordering::SeqCst);
        Ok((text, failed))
    }

    /// Counters as asked for.
    fn figures(&self, status: &Status) -> Result<String> {
        let mut text = String::new();
        if self.stats {
            text.push_str(&report::table(status));
        }
        if let Some(file) = &self.report {
            picture::write_file(file, format!("{:#}\n", report::json(status)).as_bytes())?;
            text.push_str(&format!("{}\n", file.display()));
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split(' ').filter(|word| !word.is_empty()).map(Into::into).collect()
    }

    #[test]
    fn stages_are_cut_at_then_and_clients_at_and() {
        let cut = stages(&words("twm --and xterm -e ls --then xcalc")).expect("three clients");
        let expected = vec![vec![words("twm"), words("xterm -e ls")], vec![words("xcalc")]];
        assert_eq!(cut, expected);
    }

    #[test]
    fn client_that_is_missing_is_told() {
        for text in ["", "--and xterm", "xterm --then", "a --and --then b"] {
            assert!(stages(&words(text)).is_err(), "{text:?}");
        }
    }
}
