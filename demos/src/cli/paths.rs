//! `zga paths`: one scene on every hidden-surface path.

use std::path::{Path, PathBuf};

use clap::Args;
use zga_abi::format::HiddenSurface;

use super::flags::{LookFlags, UnitFlags, named, size};
use super::source::Source;
use super::{Verdict, note, print, progress};
use crate::error::{Error, Result};
use crate::paths::{self, Survey, cases, compare};
use crate::picture::write_file;
use crate::play::{Asked, KERNELS, Look, Session};
use crate::scene::{CardSettings, Scene};
use zga_device::Kernel;

/// Draw a scene on every hidden-surface path: the same picture? and what each costs
///
/// Runs the plain Z buffer, then za, systolic and tile in both fidelities. Exit code 1 when a picture differs, or when a
/// clocked run counts something else than the functional one. With --picture the scene is drawn once more for each
/// block, line and tile, to see where each path works.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga paths za\n  zga paths teapot --json -\n  zga paths interpenetrate --variants --picture paths.png --out one.png"
)]
pub(super) struct Paths {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// Also block shapes, predictions, tile sizes and variants of the array, simulated functionally
    #[arg(long)]
    variants: bool,
    /// Write it all as JSON; - for the standard output, in place of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write maps and bars as a picture
    #[arg(long, value_name = "FILE.png", value_parser = png)]
    picture: Option<PathBuf>,
    /// Write the scene as the first path draws it
    #[arg(long, value_name = "FILE.png", value_parser = png)]
    out: Option<PathBuf>,
    /// Frames of each run, for the host time
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
    /// Frame of a demo that moves
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// Size of the picture in pixels, for example 640x480
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Host threads that draw; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Pixel code; the picture does not depend on it
    #[arg(long, value_name = "NAME", default_value = "best", value_parser = named(&KERNELS))]
    kernel: Kernel,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    units: UnitFlags,
}

/// A path that ends in .png.
pub(super) fn png(text: &str) -> std::result::Result<PathBuf, String> {
    let path = Path::new(text);
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    if is_png { Ok(path.to_owned()) } else { Err("expected a file that ends in .png".to_owned()) }
}

impl Paths {
    pub(super) fn run(&self) -> Result<Verdict> {
        let units = self.units.settings();
        if units.fidelity.is_some() {
            return Err(Error::Use("--fidelity: zga paths runs both".to_owned()));
        }
        let card = CardSettings { hidden_surface: Some(HiddenSurface::ZBuffer), ..units };
        let Self { size, threads, kernel, .. } = *self;
        let asked = Asked { size, threads, kernel, subpixel_bits: None, card };
        let source = Source::open(&self.what, size, self.look.environment)?;
        let scene = Scene {
            card: CardSettings { fidelity: None, ..source.scene(self.frame).card },
            ..source.scene(self.frame)
        };
        let look = self.look.look();
        let mut session = Session::open(&source.name, &scene, &asked)?;
        let info = *session.driver().card_info();
        let all = cases(session.settings(), &info, self.variants);

        let bar = progress::bar(all.len() as u64, "runs");
        let found = compare(&source.name, &mut session, &scene, look, all, self.frames, || bar.inc(1))?;
        bar.finish_and_clear();
        let maps = match &self.picture {
            Some(_) => Some(maps(&mut session, &scene, look)?),
            None => None,
        };
        session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));

        let mut written = String::new();
        if let (Some(file), Some(maps)) = (&self.picture, &maps) {
            paths::sheet(&found, maps).save(file)?;
            written.push_str(&format!("{}\n", file.display()));
        }
        if let (Some(file), Some(run)) = (&self.out, found.reference()) {
            crate::picture::Picture::of_frame(&run.frame).save(file)?;
            written.push_str(&format!("{}  {}\n", file.display(), run.frame.hash));
        }
        let json = format!("{:#}\n", paths::json(&found, maps.as_deref()));
        match self.json.as_deref() {
            Some(file) if file == Path::new("-") => print(&json)?,
            file => {
                if let Some(file) = file {
                    write_file(file, json.as_bytes())?;
                    written.push_str(&format!("{}\n", file.display()));
                }
                let blank = if written.is_empty() { "" } else { "\n" };
                print(&format!("{}{blank}{written}", paths::table(&found)))?;
            }
        }
        Ok(if found.is_good() { Verdict::Good } else { Verdict::Bad })
    }
}

/// Maps of all paths that the card has.
fn maps(session: &mut Session, scene: &Scene, look: Look) -> Result<Vec<Survey>> {
    let info = *session.driver().card_info();
    let bar = progress::bar(4, "maps");
    let mut all = Vec::new();
    for path in HiddenSurface::ALL.iter().filter(|path| info.has_path(**path)) {
        match path {
            HiddenSurface::ZBuffer => all.push(paths::reads(session, scene, look)?),
            HiddenSurface::Za => all.extend(paths::blocks(session, scene, look)?),
            HiddenSurface::Systolic => all.push(paths::lines(session, scene, look)?),
            HiddenSurface::Tile => all.push(paths::tiles(session, scene, look)?),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    for map in all.iter().filter(|map| !map.adds_up()) {
        let whole = map.whole.unwrap_or(0);
        note(&format!("warning: {}: the cells have {}, the frame has {whole}", map.name, map.sum()));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_good_and_bad_names() {
        assert_eq!(png("a/b.PNG"), Ok(PathBuf::from("a/b.PNG")));
        assert!(png("b.jpg").is_err_and(|fault| fault.contains(".png")));
    }
}
