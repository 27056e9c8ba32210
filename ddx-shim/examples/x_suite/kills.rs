//! Kills: clients, viewers and servers that die at the wrong moment, and what is left then.

use std::time::{Duration, Instant};

use clap::Args;
use zga_ddx_shim::link::{LinkError, Viewer};
use zga_ddx_shim::session::{Driver, Session, SessionError};

use super::pair::Pair;
use super::play::settle;
use super::random::Random;
use super::scene::{Kind, Scene};
use super::{Fault, Held, SCREEN, Tested};

#[derive(Args, Debug)]
pub struct Kills {
    #[command(flatten)]
    tested: Tested,
    /// Clients that are killed
    #[arg(long, default_value_t = 12)]
    clients: u32,
}

/// What draws while it is killed.
const VICTIMS: [&[&str]; 4] = [
    &["x11perf", "-repeat", "100", "-rect500"],
    &["x11perf", "-repeat", "100", "-copywinwin500"],
    &["x11perf", "-repeat", "100", "-aa10text"],
    &["x11perf", "-repeat", "100", "-putimage500"],
];

/// Longest wait for something that must come.
const LONG: Duration = Duration::from_secs(30);

impl Kills {
    pub fn run(&self) -> Held {
        let folder = std::env::temp_dir().join(format!("zga-kills-{}", std::process::id()));
        std::fs::create_dir_all(&folder).map_err(|reason| Fault::File(folder.clone(), reason.to_string()))?;
        let held = self.all(&folder);
        let _ = std::fs::remove_dir_all(&folder);
        held
    }

    fn all(&self, folder: &std::path::Path) -> Held {
        let link = folder.join("card");
        let options = self.tested.options(SCREEN, Some(link.clone()))?;
        let linked = matches!(options.driver, Driver::Zga { .. });
        let mut pair = Pair::start(&options, &self.tested.right(SCREEN))?;
        let depth = self.tested.depth as u8;
        let kind = Kind {
            requests: 200,
            depth,
            size: SCREEN.map(|side| side as u16),
            render: true,
            pressure: false,
            composited: false,
        };
        let equal = |pair: &mut Pair, after: &str, seed| -> Held {
            let found = pair.scene(&Scene::new(seed, kind), None, &self.tested.out)?;
            println!(
                "kills: after {after}: {}",
                found.as_ref().map_or("drawn as before".to_owned(), ToString::to_string)
            );
            Ok(found.is_none())
        };
        let mut held = true;

        let mut random = Random::new(1);
        for _ in 0..self.clients {
            let words: Vec<_> = random.of(&VICTIMS).iter().map(Into::into).collect();
            let mut victim = pair.tested.client(&words, true)?;
            std::thread::sleep(Duration::from_millis(u64::from(random.below(500)) + 50));
            victim.kill();
            pair.tested.check()?;
            settle(&pair.tested)?;
        }
        held &= equal(&mut pair, &format!("{} clients killed while they drew", self.clients), 101)?;

        if linked {
            // One that asks for frames and reads none, one that is dropped between its request and the answer.
            let mut viewers = Vec::new();
            for _ in 0..4 {
                let mut viewer = Viewer::connect(&link, LONG)?;
                viewer.next_frame(Duration::ZERO)?;
                viewers.push(viewer);
            }
            drop(viewers.split_off(2));
            held &= equal(&mut pair, "viewers that hang and viewers that left", 102)?;
            let frame = viewers[0].next_frame(LONG)?;
            held &= frame.is_some();
            println!("kills: a viewer that hung gets a frame: {}", frame.is_some());
        }

        pair.tested.kill();
        let ended = matches!(pair.tested.check(), Err(SessionError::Ended { .. }));
        println!("kills: a server that was killed is told as such: {ended}");
        held &= ended;
        if linked {
            let dead = matches!(Viewer::connect(&link, LONG), Err(LinkError::Dead { .. }));
            println!("kills: its socket is told to be a dead server's: {dead}");
            held &= dead;
        }
        let began = Instant::now();
        pair.tested = Session::start(&options)?;
        println!("kills: the next server is ready after {} ms", began.elapsed().as_millis());
        held &= equal(&mut pair, "a server killed and another started", 103)?;
        if linked {
            let mut viewer = Viewer::connect(&link, LONG)?;
            let shown = viewer.next_frame(LONG)?.is_some();
            println!("kills: the new server took over the socket: {shown}");
            held &= shown;
        }
        pair.tested.end()?;
        if linked {
            println!("kills: a server that ends takes its socket along: {}", !link.exists());
            held &= !link.exists();
        }
        Ok(held)
    }
}
