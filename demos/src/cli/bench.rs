//! `zga bench`: the fixed scenes of the comparison with other renderers.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::flags::{UnitFlags, named, size};
use super::{Verdict, print, progress};
use crate::bench::{Bench as Runner, BenchScene, Measured, SCENES};
use crate::error::{Error, Result};
use crate::picture::write_file;
use crate::play::Asked;
use crate::scene::{CardSettings, HIDDEN_SURFACES, HiddenSurface};
use crate::table::{Align, columns, row};

/// Measure the benchmark scenes S1 to S10
///
/// With --peer: prints the line of the comparison harness, peer,scene,size,samples,frames,median_ms,min_ms,p90_ms,
/// Mpixel/s,Mtri/s,prims, for one scene (S5 if none is named). S10 is S5 with anti-aliasing, 8x8 samples a pixel where --antialias asks for
/// nothing else.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  zga bench\n  zga bench S5 --json\n  zga bench S10 --antialias 4x4\n  zga bench S3 --path za --za-block 8x8\n  zga bench --scene 5 --size 1024x768 --secs 1.5 --peer zga-1"
)]
pub(super) struct Bench {
    /// Number of a scene: 5 or S5; all of them if none is named
    #[arg(value_name = "SCENE", value_parser = scene)]
    which: Option<u32>,
    /// The same as SCENE
    #[arg(long, value_name = "N", value_parser = scene, conflicts_with = "which")]
    scene: Option<u32>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1024x768")]
    size: [u32; 2],
    /// Least time for the frames of a scene
    #[arg(long, value_name = "S", default_value_t = 1.5, value_parser = seconds)]
    secs: f64,
    /// Print the line of the comparison harness under this name
    #[arg(long, value_name = "NAME", conflicts_with = "json")]
    peer: Option<String>,
    /// Host threads; one if the peer's name ends in -1, else all cores
    #[arg(long, value_name = "T")]
    threads: Option<usize>,
    /// Path that decides what is hidden
    #[arg(long, alias = "hidden-surface", value_name = "P", value_parser = named(&HIDDEN_SURFACES))]
    path: Option<HiddenSurface>,
    /// Pixel code
    #[arg(long, value_name = "NAME", default_value = "best", value_parser = named(&crate::play::KERNELS))]
    kernel: zga_device::Kernel,
    /// Write the last picture of a single scene: "RGBA W H", a line end, 4 bytes a pixel
    #[arg(long, value_name = "FILE")]
    dump: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    units: UnitFlags,
}

impl Bench {
    pub(super) fn run(&self) -> Result<Verdict> {
        let one = self.which.or(self.scene).or(self.peer.is_some().then_some(5));
        if self.dump.is_some() && one.is_none() {
            return Err(Error::Use("--dump takes the picture of one scene: name it".to_owned()));
        }
        let numbers: Vec<u32> = one.map_or_else(|| SCENES.map(|(number, ..)| number).to_vec(), |number| vec![number]);
        let bar = progress::bar(numbers.len() as u64, "scenes");
        let mut measured = Vec::new();
        for number in numbers {
            measured.push(self.measure(number)?);
            bar.inc(1);
        }
        bar.finish_and_clear();
        print(&match (&self.peer, self.json) {
            (Some(peer), _) => measured.iter().map(|measured| measured.csv(peer) + "\n").collect(),
            (None, true) => json(&measured, self.path()),
            (None, false) => table(&measured, self.size, self.path()),
        })?;
        Ok(Verdict::Good)
    }

    fn measure(&self, number: u32) -> Result<Measured> {
        let [width, height] = self.size;
        let scene = BenchScene::new(number, width, height).ok_or_else(|| {
            Error::Use(format!("--size: {width}x{height} is too small for the primitives of S{number}"))
        })?;
        let mut runner = Runner::new(scene, &self.asked()).map_err(|fault| match fault {
            // The flag has a shorter name here.
            Error::Unsupported { place, found, has } if place == "--hidden-surface" => {
                Error::Unsupported { place: "--path".to_owned(), found, has }
            }
            other => other,
        })?;
        let measured = runner.measure(self.secs)?;
        if let Some(file) = &self.dump {
            write_file(file, &runner.dump()?)?;
        }
        Ok(measured)
    }

    fn asked(&self) -> Asked {
        let one = self.peer.as_ref().is_some_and(|peer| peer.ends_with("-1"));
        Asked {
            threads: self.threads.unwrap_or(usize::from(one)),
            kernel: self.kernel,
            card: CardSettings { hidden_surface: self.path, ..self.units.settings() },
            ..Asked::default()
        }
    }

    /// The path's name.
    fn path(&self) -> &'static str {
        self.path.unwrap_or(HiddenSurface::ZBuffer).name()
    }
}

fn table(measured: &[Measured], [width, height]: [u32; 2], path: &str) -> String {
    let head = ["scene", "", "samples", "frames", "median ms", "least ms", "p90 ms", "Mpixel/s", "Mprim/s"];
    let mut rows = vec![row(head)];
    for measured in measured {
        let ([least, median, p90], [pixels, primitives]) = (measured.milliseconds(), measured.rates());
        let name = SCENES.iter().find(|(number, ..)| *number == measured.number).map_or("", |(_, name, _)| name);
        rows.push(vec![
            format!("S{}", measured.number),
            name.to_owned(),
            measured.samples.to_string(),
            measured.frames().to_string(),
            format!("{median:.3}"),
            format!("{least:.3}"),
            format!("{p90:.3}"),
            format!("{pixels:.0}"),
            format!("{primitives:.2}"),
        ]);
    }
    let right = [Align::Right; 7];
    let aligns = [&[Align::Left; 2][..], &right].concat();
    let rows = columns("  ", &aligns, &rows);
    format!("{width} x {height} pixels, {path} path, clear to fence, nothing read back\n\n{rows}")
}

fn json(measured: &[Measured], path: &str) -> String {
    let list: Vec<_> = measured
        .iter()
        .map(|measured| {
            let ([least, median, p90], [pixels, primitives]) = (measured.milliseconds(), measured.rates());
            json!({
                "scene": format!("S{}", measured.number),
                "path": path,
                "size": measured.size,
                "samples": measured.samples,
                "frames": measured.frames(),
                "median_ms": median,
                "min_ms": least,
                "p90_ms": p90,
                "mpixel_per_s": pixels,
                "mprim_per_s": primitives,
                "primitives": measured.primitives,
            })
        })
        .collect();
    format!("{:#}\n", serde_json::Value::from(list))
}

/// A scene's number, as 5 or S5.
fn scene(text: &str) -> std::result::Result<u32, String> {
    let number = text.strip_prefix(['S', 's']).unwrap_or(text).parse().ok();
    number
        .filter(|number| SCENES.iter().any(|(known, ..)| known == number))
        .ok_or_else(|| "expected 1 to 10, or S1 to S10".to_owned())
}

/// A time that is not negative and not endless.
fn seconds(text: &str) -> std::result::Result<f64, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| (0.0..=3600.0).contains(seconds));
    seconds.ok_or_else(|| "expected seconds, 0 to 3600".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_and_seconds_good_and_bad_texts() {
        assert_eq!((scene("5"), scene("S8"), scene("s10")), (Ok(5), Ok(8), Ok(10)));
        assert!(["0", "S0", "11", "x", ""].iter().all(|text| scene(text).is_err()));
        assert_eq!(seconds("0.5"), Ok(0.5));
        assert!(["-1", "nan", "1e9", "x"].iter().all(|text| seconds(text).is_err()));
    }
}
