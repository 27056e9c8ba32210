//! A card with power, the driver that opened it, and the meshes and textures of a scene in its video memory.

mod effects;
mod survey;

use std::io::Write;
use std::time::Instant;

use zga_abi::format::{self, DepthFunction};
use zga_abi::{Bus, Effects};
use zga_device::{Card, CardBus, CardOptions, Monitor};
use zga_driver::bus::RecordingBus;
use zga_driver::{Camera, Driver, DriverError, Frame, MeshBuffer, Rectangle, Target, TargetOptions, Vertex, Vertices};

use super::{Asked, Cost, Look, Settings, check_kernel, za_ram};
use crate::error::{Error, Result};
use crate::scene::{self, Batch, Colour, Lighting, Scene, Topology};
use effects::Textures;

pub use survey::ZaWords;

/// Video memory is taken in steps of this, and at least four of them.
const MEMORY_STEP: u64 = 16 << 20;
/// Most video memory that a card can have.
const MOST_MEMORY: u64 = 1 << 30;

/// A scene on a card.
#[derive(Debug)]
pub struct Session<B: Bus = CardBus> {
    name: String,
    driver: Driver<B>,
    target: Target,
    settings: Settings,
    size: [u32; 2],
    /// The target has a stencil plane.
    stencil: bool,
    meshes: Vec<Uploaded>,
    textures: Textures,
    /// What the frame that was drawn last was seen by.
    view: Option<View>,
    /// Draw path of each draw packet of the frame that was drawn last.
    drawn: Vec<String>,
    /// What there is to tell beside the driver's warnings.
    untold: Vec<String>,
    warned: Vec<String>,
    // Last: the driver goes before its card.
    card: Card,
}

/// A batch whose vertices are in video memory.
#[derive(Debug)]
struct Uploaded {
    batch: Batch,
    mesh: MeshBuffer,
    /// Number of its texture.
    texture: Option<usize>,
}

/// What a scene has beside its batches.
#[derive(Clone, Debug)]
struct View {
    camera: scene::Camera,
    background: Colour,
    lights: Vec<zga_driver::Light>,
    ambient: Colour,
    shadow: Option<scene::Shadow>,
    /// Depths are compared and stored.
    tests_depth: bool,
}

impl View {
    fn of(scene: &Scene, look: Look) -> View {
        let lights = scene.lights.iter().map(effects::light).collect();
        let Scene { camera, background, ambient, shadow, .. } = *scene;
        View { camera, background, lights, ambient, shadow, tests_depth: look.tests_depth() }
    }
}

impl Session<CardBus> {
    /// Powers a card on for a scene called `name` (in messages).
    ///
    /// # Errors
    /// [`Error::Unsupported`] for settings that the card has not; [`Error::Card`], [`Error::Driver`].
    pub fn open(name: &str, scene: &Scene, asked: &Asked) -> Result<Self> {
        let card = power_on(name, scene, asked)?;
        let bus = card.bus();
        Session::on(name, scene, asked, card, bus)
    }
}

impl<W: Write> Session<RecordingBus<CardBus, W>> {
    /// The same with a recorder on the bus, which writes a trace to `to`.
    ///
    /// # Errors
    /// As [`Session::open`]; [`Error::Trace`] if the trace's header could not be written.
    pub fn record(name: &str, scene: &Scene, asked: &Asked, to: W, file: &std::path::Path) -> Result<Self> {
        let card = power_on(name, scene, asked)?;
        let fault = |reason| Error::Trace { file: file.to_path_buf(), reason };
        let bus = RecordingBus::new(card.bus(), to).map_err(fault)?;
        Session::on(name, scene, asked, card, bus)
    }

    /// Ends the recording and gives the writer back.
    ///
    /// # Errors
    /// [`Error::Driver`], [`Error::Trace`].
    pub fn finish_recording(self, file: &std::path::Path) -> Result<W> {
        let bus = self.driver.close().map_err(Error::driver(&self.name))?;
        let fault = |reason| Error::Trace { file: file.to_path_buf(), reason };
        bus.finish().map(|(_, writer)| writer).map_err(fault)
    }
}

/// A card with memory for the scene.
fn power_on(name: &str, scene: &Scene, asked: &Asked) -> Result<Card> {
    check_kernel(asked.kernel)?;
    let options = CardOptions {
        video_memory: video_memory(scene),
        za_ram: za_ram(scene.size),
        threads: asked.threads,
        kernel: asked.kernel,
    };
    Card::power_on(options).map_err(|reason| Error::Card { place: name.to_owned(), reason })
}

/// Bytes of video memory for a scene: two frame buffers, a Z buffer, a copy to read back, and room for its vertices and
/// textures, twice, since a frame's may still be in use while the next one's are written.
fn video_memory(scene: &Scene) -> u32 {
    let pixels = (u64::from(scene.size[0]) + 128) * u64::from(scene.size[1]);
    // As a wireframe a batch has its vertices twice, and two indices for each of its triangles' edges.
    let words = |batch: &Batch| {
        let effects = normals(batch).map_or(0, <[_]>::len) * 3 + coordinates(batch).map_or(0, <[_]>::len) * 2;
        2 * 4 * batch.positions.len() + effects + 3 * batch.indices.len() + 64
    };
    let batches = scene.batches();
    let words: usize = batches.iter().map(words).sum();
    let stencil = if asks_for_stencil(&batches) { pixels } else { 0 };
    let bytes = 4 * 4 * pixels + stencil + 2 * (4 * words as u64 + effects::texture_bytes(&batches)) + (4 << 20);
    bytes.next_multiple_of(MEMORY_STEP).clamp(4 * MEMORY_STEP, MOST_MEMORY) as u32
}

impl<B: Bus> Session<B> {
    fn on(name: &str, scene: &Scene, asked: &Asked, card: Card, bus: B) -> Result<Self> {
        let fault = || Error::driver(name);
        let mut driver = Driver::open(bus).map_err(fault())?;
        let settings = Settings::resolve(name, &scene.card, asked, scene.size, driver.card_info())?;
        settings.apply(&mut driver).map_err(fault())?;
        // Every frame begins with a clear of everything, and depths are drawn again for those who ask for them.
        driver.set_keep_depth(false);
        let [width, height] = scene.size;
        let stencil = driver.card_info().effects.contains(Effects::STENCIL) && asks_for_stencil(&scene.batches());
        let target = driver
            .create_target(TargetOptions {
                depth: Some(settings.depth),
                double_buffered: true,
                stencil,
                ..TargetOptions::new(width, height)
            })
            .map_err(fault())?;
        Ok(Session {
            name: name.to_owned(),
            driver,
            target,
            settings,
            size: scene.size,
            stencil,
            meshes: Vec::new(),
            textures: Textures::default(),
            view: None,
            drawn: Vec::new(),
            untold: Vec::new(),
            warned: Vec::new(),
            card,
        })
    }

    /// What the card is set to.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Sets the card to something else from the next frame on; the depth format stays as it is.
    ///
    /// # Errors
    /// [`Error::Driver`] for what the card has not.
    pub fn set(&mut self, settings: Settings) -> Result<()> {
        settings.apply(&mut self.driver).map_err(Error::driver(&self.name))?;
        self.settings = Settings { depth: self.settings.depth, ..settings };
        Ok(())
    }

    /// Pixels of a row, and rows.
    pub const fn size(&self) -> [u32; 2] {
        self.size
    }

    /// A display at the card.
    pub fn monitor(&self) -> Monitor {
        self.card.monitor()
    }

    /// The driver.
    pub const fn driver(&mut self) -> &mut Driver<B> {
        &mut self.driver
    }

    /// Path in the scene of a draw of the last frame.
    #[must_use]
    pub fn draw_path(&self, draw: u32) -> Option<&str> {
        self.drawn.get(draw as usize).map(String::as_str)
    }

    /// What is worth telling since the last call, each line once in a session: what the driver found, and what the card
    /// has no unit for.
    pub fn take_warnings(&mut self) -> Vec<String> {
        let lines = self.driver.take_warnings().into_iter().map(|warning| warning.to_string());
        let lines = lines.chain(std::mem::take(&mut self.untold));
        let fresh: Vec<String> = lines.filter(|line| !self.warned.contains(line)).collect();
        self.warned.extend(fresh.iter().cloned());
        fresh
    }

    /// Draws a scene and shows it; returns when the card is asked, not when it is done.
    ///
    /// # Errors
    /// [`Error::Driver`] with the path of the draw at fault.
    pub fn draw(&mut self, scene: &Scene, look: Look) -> Result<()> {
        let scene = look.scene(scene);
        self.upload(look.batches(&scene))?;
        self.submit(&View::of(&scene, look))
    }

    /// Draws what is in video memory and shows it.
    fn submit(&mut self, view: &View) -> Result<()> {
        self.view = Some(view.clone());
        self.encode(view, None)?;
        self.driver.present(&self.target).map_err(Error::driver(&self.name))
    }

    /// Puts the batches into video memory, with their textures; those that are there already stay.
    fn upload(&mut self, mut batches: Vec<Batch>) -> Result<()> {
        let has = self.driver.card_info().effects;
        let lacking = effects::reduce(&mut batches, has);
        if !lacking.is_empty() {
            self.untold.push(format!("this card has no unit for {}; drawn without", lacking.join(", ")));
        }
        if self.settings.is_antialiased() && !effects::reduce(&mut batches, has - Effects::STENCIL).is_empty() {
            self.untold.push("there is no stencil test with anti-aliasing; drawn without shadows".to_owned());
        }
        let mut old = std::mem::take(&mut self.meshes).into_iter();
        self.textures.begin();
        for batch in batches {
            let place = || Error::driver(format!("{}: {}", self.name, batch.path));
            let mesh = match old.next() {
                Some(known) if same_vertices(&known.batch, &batch) => known.mesh,
                other => {
                    if let Some(known) = other {
                        self.driver.free_mesh(known.mesh).map_err(place())?;
                    }
                    create_mesh(&mut self.driver, &batch).map_err(place())?
                }
            };
            let texture = match &batch.material.texture {
                Some(texture) => self.textures.place(&mut self.driver, texture).map_err(place())?,
                None => None,
            };
            self.meshes.push(Uploaded { batch, mesh, texture });
        }
        for known in old {
            self.driver.free_mesh(known.mesh).map_err(Error::driver(&self.name))?;
        }
        self.textures.end(&mut self.driver).map_err(Error::driver(&self.name))
    }

    /// Draws what is in video memory, all of it or what lies inside `cut`; the clear is of everything.
    fn encode(&mut self, view: &View, cut: Option<Rectangle>) -> Result<()> {
        let Self { name, driver, target, meshes, textures, drawn, settings, stencil, .. } = self;
        let masks = settings.is_antialiased();
        let fault = || Error::driver(name.as_str());
        drawn.clear();
        driver.set_camera(camera(&view.camera)).map_err(fault())?;
        // Only batches that are lit have normals in video memory; the others do not ask.
        if meshes.iter().any(|uploaded| uploaded.batch.light != Lighting::None) {
            driver.set_lights(&view.lights).map_err(fault())?;
            driver.set_scene_ambient(view.ambient).map_err(fault())?;
        }
        driver.set_depth_function(if view.tests_depth { DepthFunction::Less } else { DepthFunction::Always });
        driver.set_shadow(view.shadow.filter(|_| *stencil)).map_err(fault())?;
        driver.begin_scene(target).map_err(fault())?;
        driver.set_scissor(None);
        driver.clear_with_stencil(Some(view.background), Some(1.0), stencil.then_some(0)).map_err(fault())?;
        driver.set_scissor(cut);
        for Uploaded { batch, mesh, texture } in meshes {
            if mesh.primitives() == 0 {
                continue;
            }
            let place = || Error::driver(format!("{name}: {}", batch.path));
            driver.set_object_transform(&batch.transform).map_err(place())?;
            driver.set_tag(batch.tag);
            if masks {
                driver.set_line_width(batch.extent.into()).map_err(place())?;
                driver.set_point_size(batch.extent.into()).map_err(place())?;
            }
            let texture = texture.and_then(|number| textures.get(number));
            driver.set_depth_write(view.tests_depth && batch.material.depth_write);
            set_material(driver, batch, texture).map_err(place())?;
            match batch.slope {
                Some(slope) if batch.surfaces.is_empty() => driver.decal(slope.into(), |driver| driver.draw_mesh(mesh)),
                Some(slope) => driver.decal_on(slope.into(), &batch.surfaces, |driver| driver.draw_mesh(mesh)),
                None => driver.draw_mesh(mesh),
            }
            .map_err(place())?;
            drawn.push(batch.path.clone());
        }
        driver.end_scene().map_err(fault())
    }

    /// Draws a scene, waits for it, and takes the frame as it is scanned out, with what it cost.
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn frame(&mut self, scene: &Scene, look: Look) -> Result<(Frame, Cost)> {
        let scene = look.scene(scene);
        self.upload(look.batches(&scene))?;
        let view = View::of(&scene, look);
        let fault = |name: &str| Error::driver(name.to_owned());
        self.driver.finish().map_err(fault(&self.name))?;
        self.driver.clear_counters();
        let begun = Instant::now();
        self.submit(&view)?;
        self.driver.finish().map_err(fault(&self.name))?;
        let host = begun.elapsed();
        // Before the capture, which has the card compose the frame once more.
        let cost = Cost {
            counters: self.driver.counters(),
            called: self.driver.effects_called(),
            powered: self.driver.units_powered(),
            host,
        };
        Ok((self.driver.capture().map_err(fault(&self.name))?, cost))
    }

    /// The depths of the frame that was drawn last, dense rows. A path that kept none draws the frame once more, with
    /// a Z buffer: what the frame itself cost does not depend on who asks later.
    ///
    /// # Errors
    /// [`Error::Driver`].
    pub fn depths(&mut self) -> Result<Vec<u32>> {
        let depths = match (self.driver.capture_depth(&self.target), self.view.clone()) {
            (Err(DriverError::DepthNotKept { .. }), Some(view)) => {
                self.driver.set_keep_depth(true);
                let drawn = self.encode(&view, None);
                self.driver.set_keep_depth(false);
                drawn?;
                self.driver.capture_depth(&self.target)
            }
            (depths, _) => depths,
        };
        depths.map_err(Error::driver(&self.name))
    }
}

/// Whether a material has a stencil test.
fn asks_for_stencil(batches: &[Batch]) -> bool {
    batches.iter().any(|batch| batch.material.stencil.is_some())
}

/// Normals of a batch, where they are in use.
fn normals(batch: &Batch) -> Option<&[[f32; 3]]> {
    batch.normals.as_deref().filter(|_| batch.light != Lighting::None)
}

/// Texture coordinates of a batch, where they are in use.
fn coordinates(batch: &Batch) -> Option<&[[f32; 2]]> {
    batch.texture_coordinates.as_deref().filter(|_| batch.material.texture.is_some())
}

/// Whether two batches have the same words in video memory.
fn same_vertices(a: &Batch, b: &Batch) -> bool {
    (a.topology, &a.indices, &a.colours, &a.positions) == (b.topology, &b.indices, &b.colours, &b.positions)
        && (normals(a), coordinates(a)) == (normals(b), coordinates(b))
}

/// Copies a batch into video memory: vertices with what its material calls for, and indices.
fn create_mesh<B: Bus>(driver: &mut Driver<B>, batch: &Batch) -> std::result::Result<MeshBuffer, DriverError> {
    let vertices = batch.positions.iter().zip(&batch.colours);
    let vertices: Vec<Vertex> = vertices.map(|(at, colour)| Vertex::new(*at, *colour)).collect();
    let mut list = Vertices::coloured(&vertices);
    if let Some(normals) = normals(batch) {
        list = list.normals(normals);
    }
    if let Some(coordinates) = coordinates(batch) {
        list = list.coordinates(coordinates);
    }
    driver.create_mesh(topology(batch.topology), &list, Some(&batch.indices))
}

/// Sets what the draw of a batch calls for: texture, holes, light, fog, blending.
fn set_material<B: Bus>(
    driver: &mut Driver<B>,
    batch: &Batch,
    texture: Option<&zga_driver::Texture>,
) -> std::result::Result<(), DriverError> {
    let material = &batch.material;
    // A mesh without texture coordinates has no use for the texture that is set.
    if let (Some(wanted), Some(texture)) = (&material.texture, texture) {
        driver.set_texture(Some(&effects::texture_state(wanted, texture)))?;
        driver.set_punch_through(material.punch_through)?;
    }
    if batch.light != Lighting::None {
        driver.set_material(effects::material(material, batch.light))?;
    }
    driver.set_fog(effects::fog(material))?;
    driver.set_stencil(material.stencil)?;
    driver.set_blend(effects::blend_mode(material.blend).filter(|_| batch.translucent))
}

fn topology(topology: Topology) -> format::Topology {
    match topology {
        Topology::Triangles => format::Topology::Triangles,
        Topology::Lines => format::Topology::Lines,
        Topology::Points => format::Topology::Points,
    }
}

fn camera(camera: &scene::Camera) -> Camera {
    match *camera {
        scene::Camera::Screen => Camera::Screen,
        scene::Camera::Orthographic(scene::Orthographic { eye, target, up, width, near, far }) => {
            Camera::Orthographic { eye, target, up, width, near, far }
        }
        scene::Camera::Perspective(scene::Perspective { eye, target, up, fov_x_degrees, near, far }) => {
            Camera::Perspective { eye, target, up, fov_x_degrees, near, far }
        }
    }
}
