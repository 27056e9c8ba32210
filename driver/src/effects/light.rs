//! Lights and materials.
//!
//! Lights are set in world space. The draw that needs them takes them to eye space with the camera, and puts their
//! records into fresh video memory if they are not those of the draw before: draws under way keep theirs.

use glam::{DMat4, DVec3};
use zga_abi::Effects;
use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::format::LightType;
use zga_abi::light::{LightRecord, MOST_LIGHTS};
use zga_abi::packet::DrawFlags;
use zga_abi::registers::Reg;

use super::fog::number;
use crate::memory::{Alignment, Allocation};
use crate::{Driver, DriverError};

/// Largest sharpness of highlights and largest exponent of a spot light.
const SHARPEST: f32 = 128.0;

/// Where light comes from. World space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel rays, as from the sun.
    Directional {
        /// Where the rays go; any length above 0.
        direction: [f32; 3],
    },
    /// All round from a place.
    Point {
        /// The place.
        position: [f32; 3],
    },
    /// A cone from a place.
    Spot {
        /// The place.
        position: [f32; 3],
        /// Where the axis goes; any length above 0.
        direction: [f32; 3],
        /// How fast it falls off from its axis: the power of the cosine, 0..=128.
        exponent: f32,
    },
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it comes from.
    pub source: LightSource,
    /// Distance past which a point or spot light has no effect, above 0, in world units; its light falls off as
    /// (1 - (d / cut-off)^2)^2. `None`: it is the same at every distance.
    pub cut_off: Option<f32>,
    /// Red, green, blue of diffuse light and highlights; alpha is not in use.
    pub colour: [u8; 4],
    /// Red, green, blue that it adds everywhere within its reach; alpha is not in use.
    pub ambient: [u8; 4],
}

impl Light {
    /// A light of this colour, without ambient light and without a cut-off.
    #[must_use]
    pub const fn new(source: LightSource, colour: [u8; 4]) -> Light {
        Light { source, cut_off: None, colour, ambient: [0, 0, 0, 255] }
    }

    /// Checks the numbers of light number `light`.
    fn check(&self, light: usize) -> Result<(), DriverError> {
        let bad = |field, found: String, expected| Err(DriverError::BadLight { light, field, found, expected });
        let (position, direction, exponent) = match self.source {
            LightSource::Directional { direction } => (None, Some(direction), 0.0),
            LightSource::Point { position } => (Some(position), None, 0.0),
            LightSource::Spot { position, direction, exponent } => (Some(position), Some(direction), exponent),
        };
        for (field, place) in [("position", position), ("direction", direction)] {
            if let Some(place) = place.filter(|place| !place.iter().all(|part| part.is_finite())) {
                return bad(field, format!("{place:?}"), "finite numbers");
            }
        }
        if direction == Some([0.0; 3]) {
            return bad("direction", "[0.0, 0.0, 0.0]".to_owned(), "a length above 0");
        }
        if !(0.0..=SHARPEST).contains(&exponent) {
            return bad("exponent", exponent.to_string(), "0 to 128");
        }
        match self.cut_off {
            Some(reach) if !(reach.is_finite() && reach > 0.0) => {
                bad("cut-off", reach.to_string(), "a finite number above 0")
            }
            _ => Ok(()),
        }
    }

    /// The record of the light as it stands in eye space.
    fn record(&self, view: DMat4) -> LightRecord {
        let wide = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
        // Places so far away that the turn takes them out of range stay at its edge.
        let largest = f64::from(f32::MAX);
        let narrow = |v: DVec3| v.to_array().map(|part| part.clamp(-largest, largest) as f32);
        let place = |at| narrow(view.transform_point3(wide(at)));
        // The card normalises in f32: a long or a short vector must not leave its range there.
        let along = |to| narrow(view.transform_vector3(wide(to)).normalize_or_zero());
        let (kind, position, direction, spot_exponent) = match self.source {
            LightSource::Directional { direction } => (LightType::Directional, [0.0; 3], along(direction), 0.0),
            LightSource::Point { position } => (LightType::Point, place(position), [0.0; 3], 0.0),
            LightSource::Spot { position, direction, exponent } => {
                (LightType::Spot, place(position), along(direction), exponent)
            }
        };
        LightRecord {
            kind: kind.code(),
            position,
            direction,
            cut_off: self.cut_off.unwrap_or(0.0),
            spot_exponent,
            colour: u32::from_le_bytes(self.colour),
            ambient: u32::from_le_bytes(self.ambient),
            reserved: [0; 5],
        }
    }
}

/// How a surface answers to light. Its diffuse colour is that of the vertices, or the material colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Red, green, blue of highlights; alpha is not in use. Black for none.
    pub specular: [u8; 4],
    /// Red, green, blue that it gives off by itself; alpha is not in use.
    pub emission: [u8; 4],
    /// Sharpness of highlights, 0..=128.
    pub shininess: f32,
    /// Normals that point away from the viewer are turned round: both sides of a surface are lit.
    pub two_sided: bool,
    /// Light is worked out at each pixel; else at each vertex.
    pub per_pixel: bool,
}

impl Default for Material {
    /// No highlights, lit on the side of the normals, at the vertices.
    fn default() -> Self {
        let black = [0; 4];
        Material { specular: black, emission: black, shininess: 0.0, two_sided: false, per_pixel: false }
    }
}

/// Light records in video memory.
#[derive(Debug)]
struct Placed {
    records: Vec<LightRecord>,
    block: Allocation,
}

/// What the user has set.
#[derive(Debug)]
pub(super) struct LightState {
    lights: Vec<Light>,
    ambient: Option<[u8; 4]>,
    material: Material,
    /// Lights or camera changed since the records were made.
    pub due: bool,
    placed: Option<Placed>,
}

impl LightState {
    pub fn new() -> LightState {
        LightState { lights: Vec::new(), ambient: None, material: Material::default(), due: false, placed: None }
    }
}

impl<B: Bus> Driver<B> {
    /// Sets the lights of the draws that follow, in world space: at most 256, none after opening.
    ///
    /// Draws whose vertices have normals are lit while there are lights or an ambient light; the colour of a lit
    /// vertex or pixel is what light makes of its colour and of the [`Material`]. Other draws keep their colours.
    ///
    /// ```
    /// # use zga_abi::{Reg, format::Topology};
    /// # use zga_driver::{Driver, DriverError, Light, LightSource, Material, TargetOptions, Vertices, bus::MockBus};
    /// # let mut bus = MockBus::new(1 << 20);
    /// # bus.set_register(Reg::CapabilityEffects, 0xFFF);
    /// let mut driver = Driver::open(bus)?;
    /// let sun = LightSource::Directional { direction: [0.0, -1.0, -1.0] };
    /// driver.set_lights(&[Light::new(sun, [255, 250, 240, 255])])?;
    /// driver.set_scene_ambient([40, 40, 48, 255])?;
    /// driver.set_material(Material { specular: [255; 4], shininess: 40.0, per_pixel: true, ..Material::default() })?;
    ///
    /// let corners = [[0.0, 0.0, 0.5], [60.0, 0.0, 0.5], [0.0, 40.0, 0.5]];
    /// let target = driver.create_target(TargetOptions::new(64, 48))?;
    /// driver.begin_scene(&target)?;
    /// driver.draw_vertices(Topology::Triangles, &Vertices::new(&corners).normals(&[[0.0, 0.0, 1.0]; 3]), None)?;
    /// driver.end_scene()?;
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without lights; [`DriverError::BadOption`] for more than 256;
    /// [`DriverError::BadLight`] names the light and its number that has no meaning. The lights stay as they were.
    pub fn set_lights(&mut self, lights: &[Light]) -> Result<(), DriverError> {
        if !lights.is_empty() {
            self.has_effect(Effects::LIGHT, "lights")?;
        }
        if lights.len() > MOST_LIGHTS as usize {
            let found = lights.len().to_string();
            return Err(DriverError::BadOption { name: "number of lights", found, expected: "at most 256" });
        }
        lights.iter().enumerate().try_for_each(|(number, light)| light.check(number))?;
        let state = &mut self.state.effects.light;
        if state.lights != lights {
            state.lights = lights.to_vec();
            state.due = true;
        }
        Ok(())
    }

    /// Sets the light that is everywhere: red, green, blue; alpha is not in use. `None` after opening: none, and
    /// without lights nothing is lit. Black without lights leaves lit draws what their material gives off.
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without lights. The setting stays as it was.
    pub fn set_scene_ambient(&mut self, colour: impl Into<Option<[u8; 4]>>) -> Result<(), DriverError> {
        let colour = colour.into();
        if colour.is_some() {
            self.has_effect(Effects::LIGHT, "lights")?;
        }
        self.state.effects.light.ambient = colour;
        Ok(())
    }

    /// Sets the material of the lit draws that follow; [`Material::default`] after opening. The colour without light
    /// is [`Driver::set_material_colour`]'s, or that of the vertices.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for a shininess that is not 0..=128. The material stays as it was.
    pub fn set_material(&mut self, material: Material) -> Result<(), DriverError> {
        let Material { shininess, .. } = material;
        number("material shininess", shininess, (0.0..=SHARPEST).contains(&shininess), "0 to 128")?;
        self.state.effects.light.material = material;
        Ok(())
    }

    /// Whether light falls on such vertices.
    pub(super) fn is_lit(&self, flags: DrawFlags) -> bool {
        let LightState { lights, ambient, .. } = &self.state.effects.light;
        flags.normals && (!lights.is_empty() || ambient.is_some())
    }

    /// Sees to it that the records of the lights are in video memory, for a draw of such vertices.
    ///
    /// # Errors
    /// Outer: nothing can be drawn. Inner: faults of the card that were met while memory was waited for.
    pub(crate) fn place_lights(&mut self, flags: DrawFlags) -> Result<Result<(), DriverError>, DriverError> {
        let mut met = Ok(());
        if !self.is_lit(flags) || !self.state.effects.light.due {
            return Ok(met);
        }
        let view = self.state.camera.view()?;
        let light = &self.state.effects.light;
        let records: Vec<LightRecord> = light.lights.iter().map(|light| light.record(view)).collect();
        let known = light.placed.as_ref().map_or(&[][..], |placed| &placed.records);
        if records != known {
            let fresh = if records.is_empty() {
                None
            } else {
                let bytes = size_of_val(&records[..]) as u64;
                // A fault is told, but costs no other packet than its own: each takes one away, so this ends.
                let block = loop {
                    match self.allocate(bytes, Alignment::Line) {
                        Ok(block) => break block,
                        Err(DriverError::CardFault(fault)) => met = met.and(Err(fault.into())),
                        Err(refused) => return Err(met.err().unwrap_or(refused)),
                    }
                };
                self.bus.write_burst(MEMORY_BASE + block.address(), bytemuck::cast_slice(&records));
                Some(Placed { records, block })
            };
            let before = std::mem::replace(&mut self.state.effects.light.placed, fresh);
            if let Some(Placed { block, .. }) = before {
                self.free_after_scene(block)?;
            }
        }
        self.state.effects.light.due = false;
        Ok(met)
    }

    /// Wants lights and material.
    pub(super) fn want_light(&mut self) -> Material {
        let &LightState { ambient, material, ref placed, .. } = &self.state.effects.light;
        let Material { specular, emission, shininess, two_sided, per_pixel } = material;
        let local_viewer = self.state.camera.is_perspective();
        let control = u32::from(per_pixel) | u32::from(two_sided) << 1 | u32::from(local_viewer) << 2;
        let count = placed.as_ref().map_or(0, |placed| placed.records.len() as u32);
        let colours = [ambient.unwrap_or_default(), specular, emission].map(u32::from_le_bytes);
        if let Some(Placed { block, .. }) = placed {
            self.registers.want(Reg::LightBase, &[block.address()]);
        }
        self.registers.want(Reg::LightControl, &[control]);
        self.registers.want(Reg::LightCount, &[count]);
        for (register, colour) in
            [Reg::SceneAmbient, Reg::MaterialSpecular, Reg::MaterialEmission].into_iter().zip(colours)
        {
            self.registers.want(register, &[colour]);
        }
        self.registers.want(Reg::MaterialShininess, &[shininess.to_bits()]);
        material
    }
}
