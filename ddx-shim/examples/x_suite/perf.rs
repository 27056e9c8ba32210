//! x11perf: the tested driver beside the server's own, the two in turn.

use clap::Args;
use zga_ddx_shim::session::Session;

use super::{Fault, Held, Tested, output};

#[derive(Args, Debug)]
pub struct Perf {
    #[command(flatten)]
    tested: Tested,
    /// Runs of each test on each driver, of which the median counts
    #[arg(long, default_value_t = 3)]
    runs: usize,
    /// Seconds of a run
    #[arg(long, default_value_t = 1)]
    seconds: u32,
    /// Tests of x11perf
    #[arg(default_values_t = TESTS.map(str::to_owned))]
    tests: Vec<String>,
}

/// A mix of what clients ask for: small and large fills, lines, moves, pixels to and from the client, text of both kinds.
const TESTS: [&str; 12] = [
    "-rect10",
    "-rect500",
    "-line100",
    "-line500",
    "-seg100",
    "-scroll500",
    "-copywinwin500",
    "-copypixwin500",
    "-putimage500",
    "-getimage500",
    "-aa10text",
    "-ftext",
];

/// Operations a second in what x11perf prints, and its name for the test.
fn rate(text: &str) -> Option<(f64, String)> {
    text.lines().find_map(|line| {
        let (_, rest) = line.split_once("reps @")?;
        let (_, rest) = rest.split_once('(')?;
        let (rate, name) = rest.split_once("/sec):")?;
        Some((rate.trim().parse().ok()?, name.trim().to_owned()))
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

impl Perf {
    pub fn run(&self) -> Held {
        let size = [1024, 768];
        let mut tested = Session::start(&self.tested.options(size, None)?)?;
        let mut right = Session::start(&self.tested.right(size))?;
        let out = &self.tested.out;
        std::fs::create_dir_all(out).map_err(|reason| Fault::File(out.clone(), reason.to_string()))?;
        let (mut logs, mut done) = (0.0, 0);
        println!("{:<44} {:>14} {:>14} {:>7}", "x11perf, operations a second", "dummy", self.tested.driver, "ratio");
        for test in &self.tests {
            let seconds = self.seconds.to_string();
            let arguments = ["-repeat", "1", "-time", &seconds, test];
            let one = |session: &mut Session| -> Result<Option<(f64, String)>, Fault> {
                let text = output(session, "x11perf", &arguments, &out.join("x11perf.log"))?;
                session.check()?;
                Ok(rate(&text))
            };
            let (mut before, mut after, mut name) = (Vec::new(), Vec::new(), String::new());
            for _ in 0..self.runs.max(1) {
                if let (Some((one, told)), Some((other, _))) = (one(&mut right)?, one(&mut tested)?) {
                    before.push(one);
                    after.push(other);
                    name = told;
                }
            }
            if before.is_empty() {
                println!("{test:<44} no result: the server lacks what it needs");
                continue;
            }
            let (before, after) = (median(before), median(after));
            let ratio = after / before;
            logs += ratio.ln();
            done += 1;
            let name = format!("{} {name}", test.trim_start_matches('-'));
            println!("{name:<44.44} {before:>14.0} {after:>14.0} {ratio:>7.2}");
        }
        println!(
            "{:<44} {:>14} {:>14} {:>7.2}",
            format!("geometric mean of {done}"),
            "",
            "",
            (logs / f64::from(done.max(1))).exp()
        );
        Ok(done > 0)
    }
}
