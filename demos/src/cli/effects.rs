//! `zga effects`: what a scene calls for, what each unit charges for it, and what an effect more or less would cost.

use std::path::PathBuf;

use clap::Args;

use super::flags::{CardFlags, LookFlags};
use super::source::Source;
use super::{Verdict, note, print, progress};
use crate::effects::what_if::WhatIf;
use crate::effects::{Bill, json, table};
use crate::error::Result;
use crate::picture::{Picture, write_file};
use crate::play::{Change, Session};

/// Tell which effects a scene calls, and what each unit of the card charges for them
///
/// A row for each unit: power, clocks, bytes that it holds, events. Exit code 1 when a unit without power has charged
/// something. With --what-if the scene is drawn again without each effect that it calls, and with each that it does not.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga effects teapot\n  zga effects spot.obj --environment studio --what-if\n  zga effects layers --antialias off --json"
)]
pub(super) struct Effects {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// Measure what each effect more or less would cost, in clocks and host time
    #[arg(long)]
    what_if: bool,
    /// what-if: pairs of frames that host times are the median of
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pairs: u32,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Write the picture
    #[arg(long, value_name = "FILE.png", value_parser = super::paths::png)]
    out: Option<PathBuf>,
    /// Write what the frame called for and what it cost, as JSON: the report of zga show
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Frame of a demo that moves
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    card: CardFlags,
}

impl Effects {
    pub(super) fn run(&self) -> Result<Verdict> {
        let asked = self.card.asked();
        let source = Source::open(&self.what, asked.size, self.look.environment)?;
        let (scene, look) = (source.scene(self.frame), self.look.look());
        let mut session = Session::open(&source.name, &scene, &asked)?;
        // The first frame also makes the host's threads and fills its caches; the second is what a frame costs.
        let (_, before) = session.frame(&scene, look)?;
        let (frame, cost) = session.frame(&scene, look)?;
        session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
        let size = session.size();
        let report = cost.report(size, session.settings(), &frame.hash);
        let bill = Bill::new(cost, &before.counters, session.settings(), size);

        let prices = if self.what_if {
            let (grid, has) = (session.settings().antialias.grid, session.driver().card_info().effects);
            let changes = Change::all(&look.scene(&scene), bill.cost.called, grid, has);
            let what_if = WhatIf { name: &source.name, scene: &scene, asked: &asked, look, pairs: self.pairs };
            let bar = progress::bar(changes.len() as u64, "changes");
            let mut prices = Vec::new();
            for change in changes {
                prices.push(what_if.price(&mut session, change)?);
                bar.inc(1);
            }
            bar.finish_and_clear();
            Some(prices)
        } else {
            None
        };

        let mut text = if self.json {
            format!("{:#}\n", json(&bill, prices.as_deref(), size, session.settings(), &frame.hash))
        } else {
            let ([width, height], path) = (size, session.settings().hidden_surface.name());
            let name = &source.name;
            format!("{name}, {width} x {height} pixels, {path} path\n\n{}", table(&bill, prices.as_deref()))
        };
        let mut written = String::new();
        if let Some(file) = &self.out {
            Picture::of_frame(&frame).save(file)?;
            written.push_str(&format!("{}  {}\n", file.display(), frame.hash));
        }
        if let Some(file) = &self.report {
            write_file(file, format!("{report:#}\n").as_bytes())?;
            written.push_str(&format!("{}\n", file.display()));
        }
        // JSON stays alone on the standard output.
        if !self.json && !written.is_empty() {
            text.push_str(&format!("\n{written}"));
        }
        print(&text)?;
        let charged = bill.charged_without_power();
        if !charged.is_empty() {
            note(&format!("error: charged without power: {}", charged.join(", ")));
            return Ok(Verdict::Bad);
        }
        Ok(Verdict::Good)
    }
}
