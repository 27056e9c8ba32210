//! Soak: everything mixed for a long time; memory, pixels and signs of life watched over.

use std::time::{Duration, Instant};

use clap::Args;
use zga_ddx_shim::session::Client;

use super::clients::{start, there_is};
use super::pair::Pair;
use super::play::settle;
use super::random::Random;
use super::scene::{Kind, Scene};
use super::{Held, SCREEN, Tested};

#[derive(Args, Debug)]
pub struct Soak {
    #[command(flatten)]
    tested: Tested,
    /// How long
    #[arg(long, default_value_t = 3600)]
    seconds: u64,
    /// Seed of what comes when
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Most that the server may grow after the first tenth, in MiB
    #[arg(long, default_value_t = 64)]
    growth: u64,
}

/// Programs that come and go on both servers alike.
const CROWD: [&str; 8] = [
    "xterm -geometry 80x24+5+5 -e sh -c 'seq 1 20000; sleep 2'",
    "xterm -fa Mono -fs 10 -geometry 80x24+200+100 -e sh -c 'seq 1 5000; sleep 2'",
    "xclock -geometry 150x150+300+20 -update 1",
    "xcalc -geometry +350+80",
    "xlogo -shape -geometry 200x200+100+200",
    "x11perf -repeat 1 -time 1 -aa10text -scroll500 -copywinwin100",
    "x11perf -repeat 1 -time 1 -putimage500 -getimage100 -seg100",
    "xeyes -geometry 120x80+20+300",
];

/// Most of them at a time.
const MOST: usize = 5;

impl Soak {
    pub fn run(&self) -> Held {
        let mut pair = Pair::start(&self.tested.options(SCREEN, None)?, &self.tested.right(SCREEN))?;
        let (began, mut random) = (Instant::now(), Random::new(self.seed));
        let whole = Duration::from_secs(self.seconds);
        let mut crowd: Vec<Client> = Vec::new();
        let (mut scenes, mut differ, mut started) = (0, 0, 0);
        let (mut first, mut most): (Option<u64>, u64) = (None, 0);
        let mut told = Instant::now();
        while began.elapsed() < whole {
            // Only while the screen is this test's alone can its pixels be compared.
            if random.once_in(3) || crowd.len() >= MOST {
                crowd.iter_mut().for_each(Client::end);
                crowd.clear();
                settle(&pair.tested)?;
                settle(&pair.right)?;
                let kind = Kind {
                    requests: random.between(50, 400) as usize,
                    depth: self.tested.depth as u8,
                    size: SCREEN.map(|side| side as u16),
                    render: random.once_in(2),
                    pressure: random.once_in(4),
                    composited: false,
                };
                let scene = Scene::new(random.bits(), kind);
                scenes += 1;
                if let Some(found) = pair.scene(&scene, None, &self.tested.out)? {
                    differ += 1;
                    print!("{kind:?}\n{found}");
                }
            } else {
                let command = random.of(&CROWD);
                if command.split(' ').next().is_some_and(there_is) {
                    crowd.extend(start(&pair.tested, &[command])?);
                    started += 1;
                }
                std::thread::sleep(Duration::from_millis(u64::from(random.below(2500))));
            }
            pair.tested.check()?;
            pair.right.check()?;
            let now = pair.tested.resident_bytes().unwrap_or(0);
            if began.elapsed() > whole / 10 {
                let first = *first.get_or_insert(now);
                most = most.max(now.saturating_sub(first));
            }
            if told.elapsed() > Duration::from_secs(60) {
                told = Instant::now();
                let (seconds, mib) = (began.elapsed().as_secs(), now >> 20);
                println!("soak: {seconds} s, {scenes} scenes, {differ} differ, {started} clients, {mib} MiB resident");
            }
        }
        crowd.iter_mut().for_each(Client::end);
        let grown = most >> 20;
        println!(
            "soak: {} s, {scenes} scenes, {differ} differ, {started} clients, grew by {grown} MiB at most",
            self.seconds
        );
        pair.tested.end()?;
        Ok(differ == 0 && grown <= self.growth)
    }
}
