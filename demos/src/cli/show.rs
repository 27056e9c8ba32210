//! `zga show`: a scene in a window, or as files.

use std::path::{Path, PathBuf};

use clap::Args;

use super::flags::{CardFlags, LookFlags, named};
use super::source::Source;
use super::{Verdict, note, print, progress};
use crate::error::{Error, Result};
use crate::paths::View;
use crate::picture::{self, Picture};
use crate::play::{Asked, Session};
use crate::scene::{Scene, SubpixelGrid};
use crate::window::{self, Show as Shown};

/// Folder of pictures where nothing else is asked for.
pub(super) const FOLDER: &str = "zga-out";

/// Show a demo, a scene file or a mesh
///
/// In a window: drag to orbit, wheel to zoom, P the next path, F fidelity, A the next grid of samples, V the next view
/// (what the path knows, what the sub-pixel unit took up where there is a grid, none), D decals, W wireframe,
/// T texture filter, L light at vertices or pixels, G fog, Space
/// animation, S saves a picture, H help, Esc ends; the title tells path, anti-aliasing, view and clocks. With
/// --headless, one of --out, --depth, --report, or no display: as files.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga show teapot\n  zga show decal-compare --headless --out frames --frames 90\n  zga show spot.obj --out spot.png --depth spot-depth.png --report spot.json\n  zga show teapot --hidden-surface za --za-block 8x8 --za-prediction plane --report za.json\n  zga show za --view za --out za-words.png\n  zga show crossing --view subpixel --out samples.png\n  zga show wireframe --antialias 8x8 --out smooth.png"
)]
pub(super) struct Show {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// No window
    #[arg(long)]
    headless: bool,
    /// Where pictures go: a file that ends in .png for one frame, else a folder
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// Frames to draw
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// Write the depths of the last frame as a PNG of 16 bits, 0 near; a path that keeps none draws it once more
    #[arg(long, value_name = "FILE")]
    depth: Option<PathBuf>,
    /// Write what the last frame called for and what it cost, as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Paint over the picture what a path knows, drawn on that path: the Za words, the tokens of each line of the
    /// systolic array, or the lists of the tiles; or, on any path, the pixels that the sub-pixel unit took up and why
    #[arg(long, value_name = "VIEW", value_parser = named(View::NAMED))]
    view: Option<View>,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    card: CardFlags,
}

impl Show {
    pub(super) fn run(&self) -> Result<Verdict> {
        let one_file = self.out.as_deref().filter(|path| is_png(path));
        if let (Some(path), true) = (one_file, self.frames > 1) {
            let (path, frames) = (path.display(), self.frames);
            return Err(Error::Use(format!("--out {path} is one file, but --frames asks for {frames}: name a folder")));
        }
        let asked = viewed(self.card.asked(), self.view)?;
        let source = Source::open(&self.what, asked.size, self.look.environment)?;
        sampled(&asked, &source, self.view)?;
        let wants_files = self.headless || self.out.is_some() || self.depth.is_some() || self.report.is_some();
        if !wants_files && show_window(&source, &asked, self.look, self.view)? {
            return Ok(Verdict::Good);
        }
        if !wants_files {
            note("no display: drawn to files");
        }
        self.draw_files(&source, &asked)
    }

    fn draw_files(&self, source: &Source, asked: &Asked) -> Result<Verdict> {
        let mut session = Session::open(&source.name, &source.scene(0), asked)?;
        let bar = progress::bar(u64::from(self.frames), "frames");
        let folder = self.out.clone().unwrap_or_else(|| FOLDER.into());
        // Who asks for depths or a report alone gets no picture.
        let picture = self.out.is_some() || (self.depth.is_none() && self.report.is_none());
        let mut text = String::new();
        for number in 0..self.frames {
            let (scene, look) = (source.scene(number), self.look.look());
            let (frame, cost) = session.frame(&scene, look)?;
            session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
            if picture {
                let file = match &self.out {
                    Some(path) if is_png(path) => path.clone(),
                    _ => folder.join(source.file_name(number, self.frames, "png")),
                };
                match self.view {
                    Some(view) => view.paint(&mut session, &scene, look, &frame)?.save(&file)?,
                    None => Picture::of_frame(&frame).save(&file)?,
                }
                text.push_str(&format!("{}  {}\n", file.display(), frame.hash));
            }
            if let (Some(file), true) = (&self.report, number + 1 == self.frames) {
                let report = cost.report(session.size(), session.settings(), &frame.hash);
                picture::write_file(file, format!("{report:#}\n").as_bytes())?;
                text.push_str(&format!("{}\n", file.display()));
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        if let (Some(view), true) = (self.view, picture) {
            text.push_str(&format!("{}\n", view.key()));
        }
        if let Some(file) = &self.depth {
            let maximum = session.settings().depth.maximum();
            picture::save_depth(file, &session.depths()?, session.size(), maximum)?;
            text.push_str(&format!("{}\n", file.display()));
        }
        print(&text)?;
        Ok(Verdict::Good)
    }
}

/// What is asked for, on the path that a view is of.
fn viewed(mut asked: Asked, view: Option<View>) -> Result<Asked> {
    if let Some((view, needed)) = view.and_then(|view| Some((view, view.path()?))) {
        let path = asked.card.hidden_surface.get_or_insert(needed);
        if *path != needed {
            let (view, needed, asked) = (view.name(), needed.name(), path.name());
            let why = format!("shows what the {needed} path knows, but --hidden-surface asks for {asked}");
            return Err(Error::Use(format!("--view: {view} {why}")));
        }
    }
    Ok(asked)
}

/// Refuses the view of the sub-pixel unit where there are no samples for it.
fn sampled(asked: &Asked, source: &Source, view: Option<View>) -> Result<()> {
    let grid = asked.card.or(source.scene(0).card).antialias.unwrap_or(SubpixelGrid::Off);
    if view == Some(View::Subpixel) && grid == SubpixelGrid::Off {
        let why = "shows which pixels the sub-pixel unit took up, but anti-aliasing is off";
        let how = "switch it on with --antialias 8x8, or with antialias in the scene's card";
        return Err(Error::Use(format!("--view: subpixel {why}: {how}")));
    }
    Ok(())
}

fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

/// Shows a source in a window until it is closed; false where there is no display.
fn show_window(source: &Source, asked: &Asked, look: LookFlags, view: Option<View>) -> Result<bool> {
    let first = source.scene(0);
    let Some(window) = window::open(&source.name, first.size) else {
        return Ok(false);
    };
    let mut session = Session::open(&source.name, &first, asked)?;
    in_window(source, &mut session, window, look, view)?;
    Ok(true)
}

/// Shows a source in an open window until it is closed, at first with a view or without.
pub(super) fn in_window(
    source: &Source,
    session: &mut Session,
    window: minifb::Window,
    look: LookFlags,
    view: Option<View>,
) -> Result<()> {
    let scene = |frame: u32| -> Scene { source.scene(frame) };
    let save = |number: u32| Path::new(FOLDER).join(format!("{}-{number:04}.png", source.stem));
    Shown { name: &source.name, scene: &scene, save: &save, look: look.look(), view }.run(session, window)
}
