//! `zga capture`: frames compared with golden pictures, exactly.

use std::path::{Path, PathBuf};

use clap::Args;

use super::flags::{CardFlags, LookFlags};
use super::source::Source;
use super::{Verdict, note, print, progress};
use crate::error::{Error, Result};
use crate::picture::{Difference, Picture};
use crate::play::Session;

/// Compare frames with golden pictures
///
/// Exit code 1 when a frame differs; DIR/NAME.difference.png shows where.
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga capture teapot --golden golden --update\n  zga capture teapot --golden golden")]
pub(super) struct Capture {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// Folder of the golden pictures: NAME.png, or NAME-0000.png ... for several frames
    #[arg(long, value_name = "DIR")]
    golden: PathBuf,
    /// Write the golden pictures instead
    #[arg(long)]
    update: bool,
    /// Frames
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    card: CardFlags,
}

impl Capture {
    pub(super) fn run(&self) -> Result<Verdict> {
        let asked = self.card.asked();
        let source = Source::open(&self.what, asked.size, self.look.environment)?;
        let mut session = Session::open(&source.name, &source.scene(0), &asked)?;
        let bar = progress::bar(u64::from(self.frames), "frames");
        let (mut text, mut different) = (String::new(), 0);
        for number in 0..self.frames {
            let (frame, _) = session.frame(&source.scene(number), self.look.look())?;
            session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
            let found = Picture::of_frame(&frame);
            let file = self.golden.join(source.file_name(number, self.frames, "png"));
            if self.update {
                found.save(&file)?;
                text.push_str(&format!("{}: written\n", file.display()));
            } else {
                let (line, equal) = compare(&found, &file)?;
                text.push_str(&format!("{}: {line}\n", file.display()));
                different += u32::from(!equal);
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        if self.frames > 1 && !self.update {
            text.push_str(&format!("{different} of {} frames differ\n", self.frames));
        }
        print(&text)?;
        Ok(if different == 0 { Verdict::Good } else { Verdict::Bad })
    }
}

/// Compares a frame with a golden file, and writes a picture of the difference beside it if there is one.
fn compare(found: &Picture, file: &Path) -> Result<(String, bool)> {
    if !file.exists() {
        return Err(Error::Use(format!("{}: does not exist; --update writes it", file.display())));
    }
    let golden = Picture::load(file)?;
    let what = match found.difference(&golden) {
        None => return Ok(("equal".to_owned(), true)),
        Some(Difference::Sizes) => {
            let (from, to) = ([golden.width, golden.height], [found.width, found.height]);
            format!("{} x {} pixels, the frame has {} x {}", from[0], from[1], to[0], to[1])
        }
        Some(Difference::Pixels { count, first: [x, y], golden, found }) => {
            let (golden, found) = (hex(golden), hex(found));
            format!("{count} pixels differ, the first at ({x}, {y}): {golden} expected, {found} found")
        }
    };
    let shown = file.with_extension("difference.png");
    found.difference_picture(&golden).save(&shown)?;
    Ok((format!("{what}; see {}", shown.display()), false))
}

/// A colour as #rrggbb.
fn hex([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
