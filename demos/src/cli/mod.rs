//! The commands of the program, a file each.
//!
//! Exit codes: 0, 1 for a difference or a failed case, 2 for bad use. Results go to the standard output; warnings,
//! errors and progress to the standard error.

mod accuracy;
mod bench;
mod capture;
mod effects;
mod flags;
mod list;
mod main_job;
mod monitor;
mod paths;
mod pixel;
mod progress;
mod registers;
mod show;
mod source;
mod stability;
mod trace;
mod waves;
mod x;

use std::ffi::OsString;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::error::{Error, Result};

/// How a command ended that met no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// As it should be.
    Good,
    /// Something differs or a case failed.
    Bad,
}

/// ZGA, a graphics adapter in software.
///
/// Without a command: draws the Utah teapot through driver and card, in a window where there is a display, else into
/// zga-out/, and tells what was simulated and what it cost.
#[derive(Debug, Parser)]
#[command(
    name = "zga",
    version,
    max_term_width = 100,
    after_help = "Examples:\n  zga\n  zga show teapot\n  zga show spot.obj --headless --out spot.png --report spot.json"
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    List(list::List),
    Show(show::Show),
    Capture(capture::Capture),
    Pixel(pixel::Pixel),
    Trace(trace::Trace),
    Paths(paths::Paths),
    Accuracy(accuracy::Accuracy),
    Stability(stability::Stability),
    Effects(effects::Effects),
    Waves(waves::Waves),
    Bench(bench::Bench),
    Registers(registers::Registers),
    X(x::X),
    Monitor(monitor::Monitor),
}

/// Runs the program with these arguments, the program's name first.
#[must_use]
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(told) => {
            // Help and version are no errors; clap writes either to where it belongs.
            let code = if told.use_stderr() { 2 } else { 0 };
            let _ = told.print();
            return ExitCode::from(code);
        }
    };
    let done = match &cli.command {
        None => main_job::run(),
        Some(Command::List(command)) => command.run(),
        Some(Command::Show(command)) => command.run(),
        Some(Command::Capture(command)) => command.run(),
        Some(Command::Pixel(command)) => command.run(),
        Some(Command::Trace(command)) => command.run(),
        Some(Command::Paths(command)) => command.run(),
        Some(Command::Accuracy(command)) => command.run(),
        Some(Command::Stability(command)) => command.run(),
        Some(Command::Effects(command)) => command.run(),
        Some(Command::Waves(command)) => command.run(),
        Some(Command::Bench(command)) => command.run(),
        Some(Command::Registers(command)) => command.run(),
        Some(Command::X(command)) => command.run(),
        Some(Command::Monitor(command)) => command.run(),
    };
    match done {
        Ok(Verdict::Good) => ExitCode::SUCCESS,
        Ok(Verdict::Bad) => ExitCode::from(1),
        Err(error) => {
            note(&format!("error: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// Writes to the standard output. A reader that has gone away is no error: `zga registers | head`.
///
/// # Errors
/// [`Error::Write`].
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(reason) if reason.kind() != ErrorKind::BrokenPipe => {
            Err(Error::Write { file: "standard output".into(), reason })
        }
        _ => Ok(()),
    }
}

/// Writes a line to the standard error; there is nowhere to tell that it cannot be written.
pub(crate) fn note(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn commands_are_sound_and_have_an_example() {
        let cli = Cli::command();
        cli.clone().debug_assert();
        for command in cli.get_subcommands() {
            let leaves: Vec<_> = match command.get_subcommands().count() {
                0 => vec![command],
                _ => command.get_subcommands().collect(),
            };
            for leaf in leaves {
                let help = leaf.get_after_help().map(ToString::to_string).unwrap_or_default();
                assert!(help.starts_with("Example"), "{} has no example", leaf.get_name());
            }
        }
    }
}
