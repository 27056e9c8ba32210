//! Tests of the X.Org module with a real server: what needs one, and so is no test of Cargo's.
//!
//! Each command starts its own servers, tells what it found, and ends with code 0 if all held, 1 if something did not,
//! 2 if it could not be tested. `ddx-shim/test.sh` runs them.

mod clients;
mod kills;
mod pair;
mod perf;
mod play;
mod random;
mod rendercheck;
mod scene;
mod soak;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::{Args, Parser, Subcommand};
use zga_ddx_shim::link::LinkError;
use zga_ddx_shim::session::{Client, Driver, Options, Session, SessionError, find_module};

use pair::{Pair, blotted};
use play::PlayError;
use scene::{Kind, Scene};

/// Why something could not be tested.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// A server does not do what it should.
    #[error("{0}")]
    Session(#[from] SessionError),
    /// A scene cannot be played.
    #[error("{0}")]
    Play(#[from] PlayError),
    /// A card cannot be looked at.
    #[error("{0}")]
    Link(#[from] LinkError),
    /// A file cannot be written or read.
    #[error("{}: {}", .0.display(), .1)]
    File(PathBuf, String),
    /// A client or a program of the suites does not run.
    #[error("{0}")]
    Program(String),
}

/// Did all hold?
type Held = Result<bool, Fault>;

/// Tests of the X.Org module with a real server
#[derive(Debug, Parser)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Random scenes on two servers, byte for byte
    Differential(Differential),
    /// Shows that the differential test finds a difference: one request more on one side
    Mutants(Differential),
    /// Selections of rendercheck
    Rendercheck(rendercheck::Rendercheck),
    /// x11perf on both drivers, in turn
    Perf(perf::Perf),
    /// Programs of the desktop, with pictures
    Clients(clients::Clients),
    /// Everything mixed, for a long time
    Soak(soak::Soak),
    /// Clients, viewers and servers that die at the wrong moment
    Kills(kills::Kills),
}

/// The tested server.
#[derive(Args, Clone, Debug)]
struct Tested {
    /// Driver that is tested: zga or dummy
    #[arg(long, default_value = "zga")]
    driver: String,
    /// The module's file or folder
    #[arg(long)]
    module: Option<PathBuf>,
    /// Have the server draw in the card's memory instead of the card
    #[arg(long)]
    no_accel: bool,
    /// Work in pixels under which an idle card is not woken; 0 has the card draw all that it can
    #[arg(long)]
    cpu_limit: Option<u32>,
    /// Bits of a pixel of the screen
    #[arg(long, default_value_t = 24)]
    depth: u32,
    /// Video memory in MiB
    #[arg(long)]
    memory: Option<u32>,
    /// Where pictures go
    #[arg(long, default_value = "zga-out/x")]
    out: PathBuf,
}

impl Tested {
    fn options(&self, size: [u32; 2], link: Option<PathBuf>) -> Result<Options, Fault> {
        let driver = match self.driver.as_str() {
            "dummy" => Driver::Dummy,
            "zga" => Driver::Zga {
                module: find_module(self.module.as_deref())?,
                link,
                accel: !self.no_accel,
                cpu_limit: self.cpu_limit,
            },
            other => return Err(Fault::Program(format!("--driver {other}: expected zga or dummy"))),
        };
        let memory = self.memory.filter(|_| driver != Driver::Dummy);
        Ok(Options { driver, size, depth: self.depth, memory, threads: None })
    }

    /// The server that is right: the same screen without a card.
    fn right(&self, size: [u32; 2]) -> Options {
        Options { size, depth: self.depth, ..Options::default() }
    }
}

#[derive(Args, Clone, Debug)]
struct Differential {
    #[command(flatten)]
    tested: Tested,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seeds
    #[arg(long, default_value_t = 200)]
    seeds: u64,
    /// Requests of a scene
    #[arg(long, default_value_t = 300)]
    requests: usize,
    /// RENDER requests besides
    #[arg(long)]
    render: bool,
    /// Many large pixmaps: with little --memory they do not all fit
    #[arg(long)]
    pressure: bool,
    /// Under the compositing manager xcompmgr
    #[arg(long)]
    composite: bool,
    /// Go on after a difference, up to so many
    #[arg(long, default_value_t = 3)]
    most: usize,
}

/// Pixels of the screen of a scene.
const SCREEN: [u32; 2] = [640, 480];

impl Differential {
    fn kind(&self) -> Kind {
        Kind {
            requests: self.requests,
            depth: self.tested.depth as u8,
            size: SCREEN.map(|side| side as u16),
            render: self.render,
            pressure: self.pressure,
            composited: self.composite,
        }
    }

    fn start(&self) -> Result<(Pair, Vec<Client>), Fault> {
        let pair = Pair::start(&self.tested.options(SCREEN, None)?, &self.tested.right(SCREEN))?;
        let mut managers = Vec::new();
        if self.composite {
            for session in [&pair.tested, &pair.right] {
                managers.push(session.client(&["xcompmgr".into(), "-n".into()], true)?);
            }
            // Until it has redirected all windows; nothing tells when that is.
            std::thread::sleep(Duration::from_millis(500));
        }
        Ok((pair, managers))
    }

    fn run(&self) -> Held {
        let (mut pair, mut managers) = self.start()?;
        let (mut found, mut seed) = (0, self.seed);
        while seed < self.seed + self.seeds && found < self.most {
            let scene = Scene::new(seed, self.kind());
            match pair.scene(&scene, None, &self.tested.out) {
                Ok(None) => {}
                Ok(Some(difference)) => {
                    found += 1;
                    print!("{difference}");
                }
                Err(Fault::Session(fault @ SessionError::Ended { .. })) => {
                    found += 1;
                    println!("seed {seed}: {fault}");
                    drop(managers);
                    (pair, managers) = self.start()?;
                }
                Err(fault) => return Err(fault),
            }
            seed += 1;
        }
        if managers.iter_mut().any(|manager| manager.ended().is_some()) {
            return Err(Fault::Program("xcompmgr has ended: nothing was composited".to_owned()));
        }
        let kinds = format!(
            "{}{}{}, depth {}{}",
            if self.render { "core and RENDER" } else { "core" },
            if self.pressure { ", many pixmaps" } else { "" },
            if self.composite { ", composited" } else { "" },
            self.tested.depth,
            self.tested.memory.map_or(String::new(), |memory| format!(", {memory} MiB")),
        );
        let kinds = match self.tested.cpu_limit {
            Some(limit) => format!("{kinds}, CpuLimit {limit}"),
            None => kinds,
        };
        let (played, requests) = (seed - self.seed, self.requests);
        println!("differential: {played} scenes of {requests} requests ({kinds}): {found} differ from dummy");
        drop(managers);
        pair.tested.end()?;
        pair.right.end()?;
        Ok(found == 0)
    }

    /// Each scene with a blot that only the right server gets must be found, and by its number.
    fn mutants(&self) -> Held {
        let (mut pair, _managers) = self.start()?;
        let mut missed = 0;
        for seed in self.seed..self.seed + self.seeds {
            let (scene, at) = blotted(seed, self.kind());
            match pair.scene(&scene, Some(at), &self.tested.out)? {
                Some(found) if found.number == at => {}
                Some(found) => {
                    missed += 1;
                    println!("seed {seed}: the blot at request {at} was found, but at {}", found.number);
                }
                None => {
                    missed += 1;
                    println!("seed {seed}: the blot at request {at} was not found");
                }
            }
        }
        println!("mutants: {} of {} blots found and named", self.seeds - missed, self.seeds);
        Ok(missed == 0)
    }
}

/// The lines that a program wrote, or why there are none.
fn output(session: &Session, program: &str, arguments: &[&str], log: &Path) -> Result<String, Fault> {
    let fault = |reason: std::io::Error| Fault::Program(format!("{program}: {reason}"));
    let file = std::fs::File::create(log).map_err(|reason| Fault::File(log.to_path_buf(), reason.to_string()))?;
    let mut child = std::process::Command::new(program)
        .args(arguments)
        .env("DISPLAY", session.display())
        .env("XAUTHORITY", session.authority())
        .stdin(std::process::Stdio::null())
        .stdout(file.try_clone().map_err(fault)?)
        .stderr(file)
        .spawn()
        .map_err(fault)?;
    child.wait().map_err(fault)?;
    let bytes = std::fs::read(log).map_err(fault)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn main() -> ExitCode {
    let held = match Cli::parse().command {
        Command::Differential(command) => command.run(),
        Command::Mutants(command) => command.mutants(),
        Command::Rendercheck(command) => command.run(),
        Command::Perf(command) => command.run(),
        Command::Clients(command) => command.run(),
        Command::Soak(command) => command.run(),
        Command::Kills(command) => command.run(),
    };
    match held {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::from(2)
        }
    }
}
