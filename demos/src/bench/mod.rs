//! The benchmark: fixed scenes through driver, ring, firmware and card, timed frame by frame.
//!
//! A frame is: begin scene, clear, one draw of a vertex buffer that is in video memory, end scene, wait for the fence.
//! Nothing is read back. Two frames warm up; then at least five (three, if one takes over a second) and as many as
//! the given time holds.

mod scenes;

use std::time::Instant;

use zga_abi::format::Topology;
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{
    Driver, DriverError, MeshBuffer, Target, TargetOptions, Texture, TextureOptions, TextureState, Vertex, Vertices,
};

use crate::error::{Error, Result};
use crate::play::{Asked, Settings, check_kernel, za_ram};
use crate::scene::CardSettings;

pub use scenes::{BenchScene, Corner, SCENES, TEXTURE_SIDE, texture};

/// How a scene is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What is asked of the card; its size is not used.
    pub asked: Asked,
    /// Least time for all frames, seconds.
    pub seconds: f64,
}

/// Times of a scene's frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The scene's number.
    pub number: u32,
    /// Pixels of a row, and rows.
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub samples: u32,
    /// Seconds of each frame, rising; never empty.
    times: Vec<f64>,
    /// Nominal pixels.
    pub pixels: f64,
    /// Primitives.
    pub primitives: usize,
}

impl Measured {
    /// Frames measured.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// The least, the middle and the nine-tenths time of a frame, in milliseconds.
    #[must_use]
    pub fn milliseconds(&self) -> [f64; 3] {
        let n = self.times.len();
        [0, n / 2, n * 9 / 10].map(|place| self.times[place] * 1e3)
    }

    /// Millions of nominal pixels and of primitives in a second.
    #[must_use]
    pub fn rates(&self) -> [f64; 2] {
        let median = self.times[self.times.len() / 2];
        [self.pixels / median * 1e-6, self.primitives as f64 / median * 1e-6]
    }

    /// The line of the comparison harness:
    /// `peer,scene,size,samples,frames,median_ms,min_ms,p90_ms,Mpixel/s,Mtri/s,prims`.
    #[must_use]
    pub fn csv(&self, peer: &str) -> String {
        let ([least, median, p90], [pixels, primitives]) = (self.milliseconds(), self.rates());
        let ([width, height], number, frames, prims) = (self.size, self.number, self.frames(), self.primitives);
        let samples = self.samples;
        format!(
            "{peer},S{number},{width}x{height},{samples},{frames},{median:.4},{least:.4},{p90:.4},{pixels:.1},{primitives:.3},{prims}"
        )
    }
}

/// A benchmark scene on a card.
#[derive(Debug)]
pub struct Bench {
    scene: BenchScene,
    driver: Driver<CardBus>,
    target: Target,
    mesh: MeshBuffer,
    texture: Option<Texture>,
    samples: u32,
    frames: u8,
    // Last: the driver goes before its card.
    _card: Card,
}

impl Bench {
    /// A card with the scene's vertices in its video memory.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for what the card has not, [`Error::Card`], [`Error::Driver`].
    pub fn new(scene: BenchScene, asked: &Asked) -> Result<Self> {
        check_kernel(asked.kernel)?;
        let name = format!("S{}", scene.number);
        let fault = || Error::driver(name.as_str());
        let pixels = (u64::from(scene.width) + 128) * u64::from(scene.height);
        let bytes = 12 * pixels + 24 * scene.corners.len() as u64 + (4 << 20);
        let video_memory = bytes.next_multiple_of(1 << 22).clamp(1 << 24, 1 << 30) as u32;
        let size = [scene.width, scene.height];
        let (za_ram, threads, kernel) = (za_ram(size), asked.threads, asked.kernel);
        let card = Card::power_on(CardOptions { video_memory, za_ram, threads, kernel })
            .map_err(|reason| Error::Card { place: name.clone(), reason })?;
        let mut driver = Driver::open(card.bus()).map_err(fault())?;
        // What is asked for goes before the scene's own.
        let own = CardSettings { antialias: scene.antialias(), ..CardSettings::default() };
        let settings = Settings::resolve(&name, &own, asked, size, driver.card_info())?;
        settings.apply(&mut driver).map_err(fault())?;
        // A frame begins with a clear of everything, and nobody reads its depths.
        driver.set_keep_depth(false);
        let options = TargetOptions { depth: Some(settings.depth), ..TargetOptions::new(scene.width, scene.height) };
        let target = driver.create_target(options).map_err(fault())?;
        let vertices: Vec<Vertex> = scene.corners.iter().map(vertex).collect();
        let topology = if scene.lines { Topology::Lines } else { Topology::Triangles };
        let coordinates: Vec<[f32; 2]> = scene.corners.iter().map(coordinates).collect();
        let mut list = Vertices::coloured(&vertices);
        if scene.is_textured() {
            list = list.coordinates(&coordinates);
        }
        let mesh = driver.create_mesh(topology, &list, None).map_err(fault())?;
        let texture = if scene.is_textured() { Some(upload(&mut driver).map_err(fault())?) } else { None };
        let samples = settings.antialias.grid.samples();
        Ok(Bench { scene, driver, target, mesh, texture, samples, frames: 0, _card: card })
    }

    /// Draws a frame and waits for its fence.
    fn frame(&mut self) -> std::result::Result<(), DriverError> {
        self.frames = self.frames.wrapping_add(1);
        let red = if self.scene.number == 1 { self.frames } else { 0 };
        self.driver.begin_scene(&self.target)?;
        self.driver.clear(Some([red, 0, 0, 255]), Some(1.0))?;
        if self.scene.is_translucent() {
            self.driver.set_blend(true)?;
            self.driver.set_depth_write(false);
        }
        if let Some(texture) = &self.texture {
            // Repeated, trilinear, multiplied by the colour.
            self.driver.set_texture(Some(&TextureState::new(texture)))?;
        }
        self.driver.draw_mesh(&self.mesh)?;
        self.driver.end_scene()?;
        self.driver.finish()
    }

    /// Draws and times frames.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn measure(&mut self, seconds: f64) -> Result<Measured> {
        let name = format!("S{}", self.scene.number);
        let mut draw = || self.frame().map_err(Error::driver(name.as_str()));
        draw()?;
        draw()?;
        let mut times = Vec::new();
        let begun = Instant::now();
        loop {
            let frame = Instant::now();
            draw()?;
            times.push(frame.elapsed().as_secs_f64());
            let (spent, count) = (begun.elapsed().as_secs_f64(), times.len());
            if spent >= seconds && (count >= 5 || (count >= 3 && spent / count as f64 > 1.0)) {
                break;
            }
        }
        times.sort_by(f64::total_cmp);
        let BenchScene { number, width, height, pixels, primitives, .. } = self.scene;
        Ok(Measured { number, size: [width, height], samples: self.samples, times, pixels, primitives })
    }

    /// The picture: "RGBA width height" and a line end, then 4 bytes a pixel.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn dump(&mut self) -> Result<Vec<u8>> {
        let name = format!("S{}", self.scene.number);
        let fault = || Error::driver(name.as_str());
        self.driver.present(&self.target).map_err(fault())?;
        let frame = self.driver.capture().map_err(fault())?;
        let mut bytes = format!("RGBA {} {}\n", frame.width, frame.height).into_bytes();
        bytes.extend(frame.rgba());
        Ok(bytes)
    }
}

/// A corner as the card takes it: pixels, and depth 0 near to 1 far. All of it is exact in f32.
fn vertex(corner: &Corner) -> Vertex {
    let position = [corner.x as f32 / 256.0, corner.y as f32 / 256.0, corner.depth as f32 / 65_536.0];
    Vertex::new(position, corner.colour)
}

/// Texture coordinates of a corner, 1 the whole texture.
fn coordinates(corner: &Corner) -> [f32; 2] {
    [corner.u, corner.v].map(|units| (f64::from(units) / f64::from(1 << 24)) as f32)
}

/// The texture of S8 in video memory, with all of its levels.
fn upload(driver: &mut Driver<CardBus>) -> std::result::Result<Texture, DriverError> {
    let handle = driver.create_texture(&TextureOptions::new(TEXTURE_SIDE, TEXTURE_SIDE))?;
    driver.upload_texture(&handle, &texture())?;
    Ok(handle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_has_the_fields_of_the_harness() {
        let measured = Measured {
            number: 5,
            size: [1024, 768],
            samples: 64,
            times: vec![0.002, 0.004, 0.005],
            pixels: 8e6,
            primitives: 20_000,
        };
        assert_eq!(measured.csv("zga-1"), "zga-1,S5,1024x768,64,3,4.0000,2.0000,5.0000,2000.0,5.000,20000");
    }

    #[test]
    fn measure_draws_every_scene_and_dumps_it() {
        for (number, ..) in SCENES {
            let [width, height] = if number == 9 { [1024, 768] } else { [320, 320] };
            let scene = BenchScene::new(number, width, height).expect("fits");
            let mut bench = Bench::new(scene, &Asked { threads: 1, ..Asked::default() }).expect("a card");
            let measured = bench.measure(0.0).expect("drawn");
            assert!(measured.frames() >= 3);
            assert_eq!(measured.samples, if number == 10 { 64 } else { 1 });
            let dump = bench.dump().expect("captured");
            let head = format!("RGBA {width} {height}\n");
            assert!(dump.starts_with(head.as_bytes()));
            let pixels = dump[head.len()..].as_chunks::<4>().0;
            assert_eq!(pixels.len(), (width * height) as usize);
            let covered = pixels.iter().filter(|pixel| **pixel != [0, 0, 0, 255]).count();
            assert!(covered > pixels.len() / 2, "S{number}: {covered} pixels covered");
        }
    }
}
