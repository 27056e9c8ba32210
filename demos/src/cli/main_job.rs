//! `zga` alone: the teapot through driver and card, and what that cost.

use std::path::Path;

use zga_driver::Frame;

use super::flags::LookFlags;
use super::show::{FOLDER, in_window};
use super::source::Source;
use super::{Verdict, note, print};
use crate::demos::DEMOS;
use crate::error::Result;
use crate::picture::{self, Picture};
use crate::play::{Asked, Cost, Look, Session};
use crate::scene::Scene;
use crate::table::{columns, row};
use crate::window;

pub(super) fn run() -> Result<Verdict> {
    let source = Source::open(DEMOS[0].name, None, None)?;
    let scene = source.scene(0);
    let asked = Asked::default();
    let window = window::open(&source.name, scene.size);
    let mut session = Session::open(&source.name, &scene, &asked)?;

    // The first frame also makes the host's threads and fills its caches; the second is what a frame costs.
    session.frame(&scene, Look::default())?;
    let (frame, cost) = session.frame(&scene, Look::default())?;
    let mut text = introduction(&session, DEMOS[0].description, &cost);
    session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
    match window {
        Some(window) => {
            text.push_str("\nThe window shows it: drag to orbit, wheel to zoom, H for the keys, Esc to end.\n");
            print(&text)?;
            in_window(&source, &mut session, window, LookFlags::default(), None)?;
        }
        None => {
            text.push_str("\nThere is no display, so the pictures are files:\n");
            text.push_str(&columns("  ", &[], &save_pictures(&mut session, &scene, &frame)?));
            text.push_str("\nMore: zga list, zga show NAME, zga --help\n");
            print(&text)?;
        }
    }
    Ok(Verdict::Good)
}

/// Writes the picture and what there is to see beside it; a row for each file.
fn save_pictures(session: &mut Session, scene: &Scene, frame: &Frame) -> Result<Vec<Vec<String>>> {
    let depths = session.depths()?;
    let depth = picture::depth_picture(&depths, session.size(), session.settings().depth.maximum());
    let (plain, _) = session.frame(scene, Look { decals: false, ..Look::default() })?;
    let (wires, _) = session.frame(scene, Look { wireframe: true, ..Look::default() })?;
    let pictures = [
        ("teapot.png", "the teapot, its markings drawn as decals", Picture::of_frame(frame)),
        (
            "teapot-without-decals.png",
            "its markings as plain lines: the surface buries them",
            Picture::of_frame(&plain),
        ),
        ("teapot-wireframe.png", "its triangles, hidden lines removed", Picture::of_frame(&wires)),
        ("teapot-depth.png", "its Z buffer, near is bright", depth),
    ];
    let mut rows = Vec::new();
    for (name, what, picture) in pictures {
        let file = Path::new(FOLDER).join(name);
        picture.save(&file)?;
        rows.push(row([&file.display().to_string(), what]));
    }
    Ok(rows)
}

fn introduction(session: &Session, description: &str, cost: &Cost) -> String {
    let ([width, height], settings) = (session.size(), session.settings());
    format!(
        "ZGA {}, a graphics adapter in software\n\n  {description}\n  {width} x {height} pixels, {} path, depth of {} \
         bits with {} fraction bits, {} fidelity\n\n{}",
        env!("CARGO_PKG_VERSION"),
        settings.hidden_surface.name(),
        settings.depth.bits(),
        settings.depth.fraction(),
        settings.fidelity.name(),
        cost.table(),
    )
}
