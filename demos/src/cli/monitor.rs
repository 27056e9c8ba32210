//! `zga monitor`: looks at a card in another process.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use zga_ddx_shim::link::{self, Viewer};

use super::show::FOLDER;
use super::x::seconds;
use super::{Verdict, note, print};
use crate::error::{Error, Result};
use crate::picture;
use crate::window;
use crate::x::report;
use crate::x::watch::{Captures, Watch, asked_to_end, check_out};

/// How long a card may take to answer.
const ANSWER: Duration = Duration::from_secs(5);

/// Look at a card that runs in another process, as a monitor at its connector
///
/// Attaches to the socket of a card that zga x has started, or that an X server with Option "Link" has. The card does not
/// wait for it. With --headless, --out, --stats, --report or no display: one picture, or one every --every seconds.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga monitor\n  zga monitor --out now.png\n  zga monitor /run/user/1000/zga/card-4711 --stats --seconds 10"
)]
pub(super) struct Monitor {
    /// The card's socket; the one card that runs without
    #[arg(value_name = "SOCKET")]
    socket: Option<PathBuf>,
    /// No window
    #[arg(long)]
    headless: bool,
    /// Where pictures go: a file that ends in .png, else a folder
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// A picture every so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    every: Option<f64>,
    /// End after so many seconds
    #[arg(long, value_name = "N", value_parser = seconds)]
    seconds: Option<f64>,
    /// Tell what the card counts, and which effects and units were called: with --seconds in that time, else since power-on
    #[arg(long)]
    stats: bool,
    /// Write that as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

impl Monitor {
    pub(super) fn run(&self) -> Result<Verdict> {
        check_out(self.out.as_deref(), self.every)?;
        let socket = match &self.socket {
            Some(socket) => socket.clone(),
            None => only(link::living()?)?,
        };
        let mut viewer = Viewer::connect(&socket, ANSWER)?;
        let figures = self.stats || self.report.is_some();
        let files = self.headless || self.out.is_some() || figures;
        let window = if files { None } else { window::open(&socket.display().to_string(), first_size(&mut viewer)?) };
        if window.is_none() && !files {
            note("no display: drawn to files");
        }
        let out = match (&self.out, &window) {
            (Some(out), _) => Some(out.clone()),
            (None, None) if !figures || self.every.is_some() => Some(FOLDER.into()),
            _ => None,
        };
        let captures = out.map(|out| Captures { out, every: self.every.map(Duration::from_secs_f64) });
        let before = match (figures, self.seconds) {
            (true, Some(_)) => viewer.status(ANSWER)?,
            _ => link::Status::default(),
        };
        // Without a window and a time, a moment is enough.
        let once = window.is_none() && self.seconds.is_none() && self.every.is_none();
        let mut watch = Watch { window, input: None, captures, seconds: self.seconds, asked_to_end: asked_to_end()? };
        let saved = watch.run(&mut viewer, || Ok(!once))?;
        let mut text: String = saved.iter().map(|file| format!("{}\n", file.display())).collect();
        if figures {
            let status = viewer.status(ANSWER)?.since(&before);
            if self.stats {
                text.push_str(&report::table(&status));
            }
            if let Some(file) = &self.report {
                picture::write_file(file, format!("{:#}\n", report::json(&status)).as_bytes())?;
                text.push_str(&format!("{}\n", file.display()));
            }
        }
        print(&text)?;
        Ok(Verdict::Good)
    }
}

/// The one card that runs.
fn only(living: Vec<PathBuf>) -> Result<PathBuf> {
    let told = match living.len() {
        1 => return Ok(living.into_iter().next().unwrap_or_default()),
        0 => format!("no card runs in {}: zga x starts one", link::folder()?.display()),
        _ => {
            let names: Vec<_> = living.iter().map(|path| path.display().to_string()).collect();
            format!("several cards run, name one: {}", names.join(", "))
        }
    };
    Err(Error::Use(told))
}

/// Pixels of the first frame.
fn first_size(viewer: &mut Viewer) -> Result<[u32; 2]> {
    match viewer.next_frame(ANSWER)? {
        Some(frame) => Ok([frame.width, frame.height]),
        None => Err(Error::Use(format!("the card shows no frame within {} s", ANSWER.as_secs()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_card_is_taken_and_several_are_named() {
        assert_eq!(only(vec!["/a".into()]).expect("one"), PathBuf::from("/a"));
        let told = only(vec!["/a".into(), "/b".into()]).expect_err("two").to_string();
        assert_eq!(told, "several cards run, name one: /a, /b");
    }
}
