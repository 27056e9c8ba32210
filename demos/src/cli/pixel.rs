//! `zga pixel`: the history of one pixel.

use clap::Args;
use zga_abi::format::DepthFunction;
use zga_abi::packet::ProbeRecord;

use super::flags::{CardFlags, LookFlags};
use super::source::Source;
use super::{Verdict, note, print};
use crate::error::{Error, Result};
use crate::play::Session;
use crate::table::{Align, columns, row};

/// Most fragments that are recorded.
const MOST_RECORDS: u32 = 1 << 20;

/// Tell the history of one pixel: every fragment that came, and what became of it
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga pixel teapot 400 300")]
pub(super) struct Pixel {
    /// A demo, a scene file (.json) or a mesh (.obj, .gltf, .glb)
    #[arg(value_name = "NAME|FILE")]
    what: String,
    /// Column, from 0
    x: u32,
    /// Row, from 0 at the top
    y: u32,
    /// Frame of a demo that moves
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    #[command(flatten)]
    look: LookFlags,
    #[command(flatten)]
    card: CardFlags,
}

impl Pixel {
    pub(super) fn run(&self) -> Result<Verdict> {
        let asked = self.card.asked();
        let source = Source::open(&self.what, asked.size, self.look.environment)?;
        let scene = source.scene(self.frame);
        let ([width, height], (x, y)) = (scene.size, (self.x, self.y));
        if x >= width || y >= height {
            return Err(Error::Use(format!("pixel ({x}, {y}) lies outside: {} has {width} x {height}", source.name)));
        }
        let mut session = Session::open(&source.name, &scene, &asked)?;
        let fault = || Error::driver(source.name.as_str());
        session.driver().probe_pixel(x, y, MOST_RECORDS).map_err(fault())?;
        let (frame, _) = session.frame(&scene, self.look.look())?;
        session.take_warnings().iter().for_each(|line| note(&format!("warning: {line}")));
        let history = session.driver().pixel_history().map_err(fault())?;

        let mut text = format!("{}, pixel ({x}, {y}) of {width} x {height}\n\n", source.name);
        let mut rows =
            vec![row(["", "draw", "tag", "primitive", "kind", "depth", "test", "stored", "verdict", "colour"])];
        for (number, record) in history.records.iter().enumerate() {
            rows.push(fragment(number, record, session.draw_path(record.draw).unwrap_or("?")));
        }
        let right = Align::Right;
        let left = Align::Left;
        let aligns = [right, left, right, right, left, right, left, right];
        text.push_str(&columns("  ", &aligns, &rows));
        let kept = history.records.len() as u32;
        if kept < history.fragments {
            text.push_str(&format!("  ... and {} more\n", history.fragments - kept));
        }
        let shown = frame.pixels[(y * width + x) as usize] & 0x00FF_FFFF;
        let depth = session.depths()?[(y * width + x) as usize];
        let far = session.settings().depth.maximum();
        text.push_str(&format!("\nShown #{shown:06x}, depth {depth} of {far}\n"));
        print(&text)?;
        Ok(Verdict::Good)
    }
}

/// A record as a row.
fn fragment(number: usize, record: &ProbeRecord, path: &str) -> Vec<String> {
    let kind = record.verdict & 0xFF;
    let [red, green, blue, alpha] = record.colour.to_le_bytes();
    let colour = if alpha == 255 {
        format!("#{red:02x}{green:02x}{blue:02x}")
    } else {
        format!("#{red:02x}{green:02x}{blue:02x}{alpha:02x}")
    };
    let (depth, before) = (record.depth.to_string(), record.depth_before.to_string());
    let number = number.to_string();
    if kind == 0 {
        return row([&number, "(clear)", "", "", "clear", &depth, "", &before, "written", &colour]);
    }
    let kind = match kind {
        1 => "triangle",
        2 => "line",
        3 => "point",
        _ => "?",
    };
    let test = DepthFunction::from_code((record.verdict >> 8) & 0xFF).map_or("?", DepthFunction::name);
    let verdict = match (record.verdict >> 16 & 1, record.verdict >> 17 & 1) {
        (0, _) => "hidden",
        (_, 0) => "drawn, depth kept",
        _ => "drawn",
    };
    let (tag, primitive) = (record.tag.to_string(), record.primitive.to_string());
    row([&number, path, &tag, &primitive, kind, &depth, test, &before, verdict, &colour])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fragment_of_a_hidden_line_reads_well() {
        let record = ProbeRecord {
            primitive: 3,
            tag: 9,
            verdict: 2 | 1 << 8,
            depth: 70,
            depth_before: 60,
            colour: u32::from_le_bytes([1, 2, 3, 255]),
            ..ProbeRecord::default()
        };
        let expected = ["5", "draw[1]", "9", "3", "line", "70", "less", "60", "hidden", "#010203"];
        assert_eq!(fragment(5, &record, "draw[1]"), expected);
    }
}
