//! The program zga: scenes, window, headless capture and reports for the ZGA card.

use std::process::ExitCode;

fn main() -> ExitCode {
    zga_demos::cli::run(std::env::args_os())
}
