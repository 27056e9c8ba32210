//! The scenes through driver and card, with each cure for buried markings.

use zga_abi::format::{DepthFormat, DepthFunction};
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{Camera, Driver, DriverError, Target, TargetOptions, Vertex};

use super::exact::Truth;
use super::scene::{Marking, Place, SIDE, Scene};

/// What is done so that markings are not buried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cure {
    /// Nothing.
    Nothing,
    /// The decal transform moves markings toward the viewer, for surfaces up to this slope.
    Decal(f64),
    /// The decal transform fitted to the marking's own surfaces, with this slope as its limit.
    Fitted(f64),
    /// The decal transform moves surfaces away from the viewer, by the slope's negative.
    Surface(f64),
    /// The usual polygon offset on surfaces: `factor` times the steepest gradient of depth over a pixel, plus `units`
    /// times the least step of the Z buffer. The card has none: the host transforms the triangles, as a driver without
    /// decals would, and adds it to their vertices, which is the same for a plane.
    Offset {
        /// Times max(|dz/dx|, |dz/dy|) of a pixel.
        factor: f64,
        /// Times one step.
        units: f64,
    },
}

/// Colour of markings, and of nothing else: XRGB.
pub const MARKING: u32 = 0x00FF_B000;
const BACKGROUND: [u8; 4] = [18, 20, 30, 255];
const STEPS: f64 = 16_777_215.0;

/// A card with a driver and a target.
pub struct Desk {
    _card: Card,
    driver: Driver<CardBus>,
    target: Target,
}

impl Desk {
    /// Powers a card on.
    ///
    /// # Panics
    /// When there is no card to be had, which is a fault of the machine.
    #[must_use]
    pub fn new() -> Self {
        Self::with(DepthFormat::default())
    }

    /// The same with depths of a format.
    ///
    /// # Panics
    /// As [`Desk::new`].
    #[must_use]
    pub fn with(depth: DepthFormat) -> Self {
        let options = CardOptions { threads: 1, ..CardOptions::default() };
        let card = Card::power_on(options).unwrap_or_else(|error| panic!("{error}"));
        let mut driver = Driver::open(card.bus()).unwrap_or_else(|error| panic!("{error}"));
        let target = driver
            .create_target(TargetOptions { depth: Some(depth), ..TargetOptions::new(SIDE, SIDE) })
            .unwrap_or_else(|error| panic!("{error}"));
        Self { _card: card, driver, target }
    }

    /// The picture, row by row: XRGB. Surfaces are drawn under `less`, then markings under `less or equal`, the kinder
    /// test for all cures but the decal's, which needs no equality.
    pub(super) fn draw(&mut self, scene: &Scene, truth: &Truth, cure: Cure) -> Result<Vec<u32>, DriverError> {
        let camera = scene.projection.camera();
        let driver = &mut self.driver;
        driver.set_camera(camera)?;
        driver.begin_scene(&self.target)?;
        driver.clear(Some(BACKGROUND), Some(1.0))?;
        driver.set_depth_function(DepthFunction::Less);
        match cure {
            Cure::Surface(slope) => driver.decal(-slope, |driver| driver.draw_triangles(&surfaces(scene)))?,
            Cure::Offset { factor, units } => {
                driver.set_camera(Camera::Screen)?;
                driver.draw_triangles(&offset(scene, truth, factor, units))?;
                driver.set_camera(camera)?;
            }
            Cure::Nothing | Cure::Decal(_) | Cure::Fitted(_) => driver.draw_triangles(&surfaces(scene))?,
        }
        driver.set_depth_function(DepthFunction::LessEqual);
        cured_markings(driver, scene, cure)?;
        driver.end_scene()?;
        driver.present(&self.target)?;
        Ok(driver.capture()?.pixels.into_iter().map(|pixel| pixel & 0x00FF_FFFF).collect())
    }

    /// Draws the markings alone, with a cure: which pixels they have.
    pub(super) fn markings_alone(&mut self, scene: &Scene, cure: Cure) -> Result<Vec<bool>, DriverError> {
        let driver = &mut self.driver;
        driver.set_camera(scene.projection.camera())?;
        driver.begin_scene(&self.target)?;
        driver.clear(Some(BACKGROUND), Some(1.0))?;
        driver.set_depth_function(DepthFunction::Always);
        cured_markings(driver, scene, cure)?;
        driver.end_scene()?;
        driver.present(&self.target)?;
        Ok(driver.capture()?.pixels.into_iter().map(|pixel| pixel & 0x00FF_FFFF == MARKING).collect())
    }
}

impl Default for Desk {
    fn default() -> Self {
        Self::new()
    }
}

/// Draws the markings with what a cure does to them.
fn cured_markings(driver: &mut Driver<CardBus>, scene: &Scene, cure: Cure) -> Result<(), DriverError> {
    match cure {
        Cure::Decal(slope) => driver.decal(slope, |driver| markings(driver, &scene.markings)),
        Cure::Fitted(slope) => {
            // Those with the same carriers are neighbours in the list, but those of a body's edges.
            for group in scene.markings.chunk_by(|a, b| a.carriers == b.carriers) {
                let surfaces: Vec<[Place; 3]> = group[0].carriers.iter().map(|&face| scene.surfaces[face]).collect();
                driver.decal_on(slope, &surfaces, |driver| markings(driver, group))?;
            }
            Ok(())
        }
        Cure::Nothing | Cure::Surface(_) | Cure::Offset { .. } => markings(driver, &scene.markings),
    }
}

fn markings(driver: &mut Driver<CardBus>, markings: &[Marking]) -> Result<(), DriverError> {
    let [_, r, g, b] = MARKING.to_be_bytes();
    let vertices = |count: usize| -> Vec<Vertex> {
        let some = markings.iter().filter(|marking| marking.ends.len() == count);
        some.flat_map(|marking| &marking.ends).map(|&place| Vertex::new(place, [r, g, b, 255])).collect()
    };
    driver.draw_lines(&vertices(2))?;
    driver.draw_points(&vertices(1))
}

/// A colour by the triangle's place in the scene.
fn colour(index: usize) -> [u8; 4] {
    let shade = (index as u32 / 2 * 37 % 5 * 11) as u8;
    [70 + shade, 90 + shade, 120 + shade, 255]
}

fn surfaces(scene: &Scene) -> Vec<Vertex> {
    let triangles = scene.surfaces.iter().enumerate();
    triangles.flat_map(|(index, triangle)| triangle.map(|place| Vertex::new(place, colour(index)))).collect()
}

/// The triangles on the screen, x and y snapped as the card snaps them, with their depths moved away.
fn offset(scene: &Scene, truth: &Truth, factor: f64, units: f64) -> Vec<Vertex> {
    let mut vertices = Vec::with_capacity(3 * scene.surfaces.len());
    for (index, face) in truth.faces.iter().enumerate() {
        let [across, down] = face.gradient().map(f64::abs);
        let away = factor * across.max(down) + units / STEPS;
        // A triangle seen from its edge has no gradient and no pixels.
        let away = if away.is_finite() { away } else { 0.0 };
        for corner in &face.corners {
            let (place, z) = (corner.snapped(), (corner.about[2] + away).clamp(0.0, 1.0));
            vertices.push(Vertex::new([place.x as f32 / 256.0, place.y as f32 / 256.0, z as f32], colour(index)));
        }
    }
    vertices
}
