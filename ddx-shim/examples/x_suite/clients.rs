//! Clients: programs of the desktop on the card, compared where they draw the same each time, and pictures of all.

use std::ffi::OsString;
use std::path::Path;
use std::time::{Duration, Instant};

use clap::Args;
use zga_ddx_shim::session::{Client, Session};

use super::pair::save_png;
use super::play::{has_root_property, screenshot};
use super::{Fault, Held, Tested};

#[derive(Args, Debug)]
pub struct Clients {
    #[command(flatten)]
    tested: Tested,
    /// Longest wait for a picture that no longer changes, in seconds
    #[arg(long, default_value_t = 30)]
    wait: u64,
}

/// A group of programs on the screen at the same time.
struct Case {
    name: &'static str,
    size: [u32; 2],
    commands: &'static [&'static str],
    /// They draw the same each time, so the two drivers' pictures must be equal.
    steady: bool,
    /// The first program, without which the case is left out.
    needs: &'static str,
}

const CASES: [Case; 8] = [
    Case {
        name: "xterm-scroll",
        size: [800, 600],
        // The cursor is not shown: whether it blinks is a matter of time.
        commands: &[
            "xterm -geometry 100x40+10+10 -fn 9x15 +sb -e sh -c 'printf \"\\033[?25l\"; seq 1 20000; xprop -root -f ZGA_DONE 8s -set ZGA_DONE yes; sleep 600'",
        ],
        steady: true,
        needs: "xterm",
    },
    Case {
        name: "xterm-smooth",
        size: [800, 600],
        commands: &[
            "xterm -fa 'DejaVu Sans Mono' -fs 11 -geometry 90x35+10+10 -e sh -c 'printf \"\\033[?25l\"; seq 1 3000; printf \"\\033[1;32mbold \\033[7mreverse\\033[0m\"; xprop -root -f ZGA_DONE 8s -set ZGA_DONE yes; sleep 600'",
        ],
        steady: true,
        needs: "xterm",
    },
    Case { name: "xcalc", size: [400, 400], commands: &["xcalc -geometry +20+20"], steady: true, needs: "xcalc" },
    Case {
        name: "xlogo-shape",
        size: [400, 400],
        commands: &["xlogo -shape -geometry 300x300+40+40", "xclock -analog -geometry 100x100+10+10 -update 3600"],
        steady: false,
        needs: "xlogo",
    },
    Case {
        name: "desktop",
        size: [1024, 768],
        commands: &[
            "twm",
            "xsetroot -solid '#30506c'",
            "xterm -geometry 72x24+40+60 -fn 8x13 -e sh -c 'printf \"\\033[?25l\"; ls -la /usr/lib/xorg /usr/lib/xorg/modules; sleep 600'",
            "xclock -geometry 180x180+780+40",
            "xcalc -geometry 260x330+700+300",
        ],
        steady: false,
        needs: "twm",
    },
    Case {
        name: "gtk",
        size: [1024, 768],
        commands: &["gtk3-widget-factory"],
        steady: false,
        needs: "gtk3-widget-factory",
    },
    Case {
        name: "gtk-editor",
        size: [1024, 768],
        commands: &["mousepad /etc/services"],
        steady: false,
        needs: "mousepad",
    },
    Case {
        name: "browser",
        size: [1600, 1000],
        commands: &[
            "chromium --no-sandbox --disable-gpu --no-first-run --user-data-dir=\"$(mktemp -d)\" --window-size=1600,1000 --window-position=0,0 'data:text/html,<h1>A page</h1><p style=columns:3>'\"$(seq -s ' ' 1 4000)\"",
        ],
        steady: false,
        needs: "chromium",
    },
];

/// Property of the root window that a client sets when it has drawn all.
const DONE: &str = "ZGA_DONE";
/// How long a screen must not change to count as drawn.
const STILL: Duration = Duration::from_millis(2500);

/// Size and pixels of a screen.
type Screenshot = ([u32; 2], Vec<u32>);

/// Is a program to be had?
pub fn there_is(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Starts commands of the shell.
pub fn start(session: &Session, commands: &[&str]) -> Result<Vec<Client>, Fault> {
    let one = |command: &&str| -> Result<Client, Fault> {
        // With "exec" the shell is the program, if the command is one word.
        let client = session.client(&[OsString::from(format!("exec {command}"))], true)?;
        std::thread::sleep(Duration::from_millis(200));
        Ok(client)
    };
    commands.iter().map(one).collect()
}

/// The screen once it is no longer `blank`, the clients have said that they are done where they say so, and it has not
/// changed for a while; as it is after `wait`.
fn steady(session: &mut Session, case: &Case, blank: &Screenshot, wait: Duration) -> Result<Screenshot, Fault> {
    let deadline = Instant::now() + wait;
    let (mut shot, mut since) = (screenshot(session)?, Instant::now());
    let says = case.commands.iter().any(|command| command.contains(DONE));
    loop {
        std::thread::sleep(Duration::from_millis(200));
        session.check()?;
        let next = screenshot(session)?;
        if next != shot {
            (shot, since) = (next, Instant::now());
        }
        if says && !has_root_property(session, DONE)? {
            since = Instant::now();
        }
        let still = shot != *blank && since.elapsed() > STILL;
        if still || Instant::now() > deadline {
            return Ok(shot);
        }
    }
}

impl Clients {
    pub fn run(&self) -> Held {
        let mut held = true;
        for case in &CASES {
            if !there_is(case.needs) {
                println!("clients: {}: left out, there is no {}", case.name, case.needs);
                continue;
            }
            held &= self.case(case)?;
        }
        Ok(held)
    }

    fn case(&self, case: &Case) -> Held {
        let one = |options, file: &str| -> Result<Screenshot, Fault> {
            let mut session = Session::start(&options)?;
            let blank = screenshot(&session)?;
            let mut clients = start(&session, case.commands)?;
            let shot = steady(&mut session, case, &blank, Duration::from_secs(self.wait))?;
            save_png(&self.tested.out.join(file), shot.0, &shot.1)?;
            clients.iter_mut().for_each(Client::end);
            session.end()?;
            Ok(shot)
        };
        let file = format!("{}.png", case.name);
        let began = Instant::now();
        let shot = one(self.tested.options(case.size, None)?, &file)?;
        let took = began.elapsed().as_secs_f64();
        let shown = Path::new(&self.tested.out).join(&file);
        let colours = shot.1.iter().collect::<std::collections::BTreeSet<_>>().len();
        let mut told = format!("{colours} colours, {took:.1} s, {}", shown.display());
        let mut held = colours > 1;
        if case.steady {
            let right = one(self.tested.right(case.size), &format!("{}.dummy.png", case.name))?;
            let odd = shot.1.iter().zip(&right.1).filter(|(one, other)| one != other).count();
            told = format!("{odd} pixels differ from dummy, {told}");
            held &= odd == 0;
        }
        println!("clients: {}: {told}", case.name);
        Ok(held)
    }
}
