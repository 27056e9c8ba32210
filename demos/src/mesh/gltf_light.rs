//! Lights of a glTF file: the extension KHR_lights_punctual.
//!
//! Duties: places the lights of the nodes that are walked, and brings candela and lux to the card's levels. Outputs to:
//! the glTF loader.
//!
//! The file states no exposure, so the lights are measured against each other: by the light that each sends to the
//! middle of the mesh (intensity, divided by the distance squared except for directional lights; a place inside the
//! mesh counts as half its radius away). The brightest has the level 255 in its strongest channel, the others less, and
//! all are encoded as colours are. The distance itself is folded in by this; on the card a light fades only toward its
//! range. A spot's exponent is the one with half the light midway between its two cones.

use glam::{DMat4, DVec3};
use gltf::khr_lights_punctual::{Kind, Light as FileLight};
use zga_abi::light::MOST_LIGHTS;

use super::Bounds;
use super::gltf_file::shown;
use crate::scene::{DARK, Light, LightType, narrow, wide};

/// The extension's name.
pub(super) const EXTENSION: &str = "KHR_lights_punctual";

/// Steps of a spot's exponent: coarse, so that the last bits of a host's logarithm do not show.
const EXPONENT_STEPS: f64 = 16.0;

/// The lights that were found.
#[derive(Default)]
pub(super) struct Lamps {
    lamps: Vec<Lamp>,
    /// Those that have no place, no direction or no light, and those past the card's most.
    left_out: usize,
}

struct Lamp {
    /// Without colours, which depend on all lights.
    light: Light,
    /// Linear, 0 and up.
    colour: [f64; 3],
    /// Candela, or lux of a directional light.
    intensity: f64,
}

impl Lamps {
    /// Adds the light of a node that is placed by `matrix`; it shines along the node's negative z axis.
    pub(super) fn add(&mut self, file: &FileLight<'_>, matrix: DMat4) {
        let (kind, spot_exponent) = match file.kind() {
            Kind::Directional => (LightType::Directional, 0.0),
            Kind::Point => (LightType::Point, 0.0),
            Kind::Spot { inner_cone_angle, outer_cone_angle } => {
                (LightType::Spot, spot_exponent(f64::from(inner_cone_angle), f64::from(outer_cone_angle)))
            }
        };
        let direction = matrix.transform_vector3(DVec3::NEG_Z).try_normalize();
        let lamp = Lamp {
            light: Light {
                kind,
                position: narrow(matrix.transform_point3(DVec3::ZERO)),
                direction: narrow(direction.unwrap_or(DVec3::NEG_Z)),
                attenuation_cut_off: file.range().filter(|range| range.is_finite() && *range > 0.0),
                spot_exponent,
                colour: DARK,
                ambient: DARK,
            },
            colour: file.color().map(|value| f64::from(value).max(0.0)),
            intensity: f64::from(file.intensity()),
        };
        let is_placed = lamp.light.position.iter().all(|coordinate| coordinate.is_finite());
        let is_bright = lamp.strength().is_finite() && lamp.strength() > 0.0;
        let points = direction.is_some() || kind == LightType::Point;
        if is_placed && is_bright && points && self.lamps.len() < MOST_LIGHTS as usize {
            self.lamps.push(lamp);
        } else {
            self.left_out += 1;
        }
    }

    /// The lights, for a mesh that takes this space.
    pub(super) fn finish(self, bounds: &Bounds, warnings: &mut Vec<String>) -> Vec<Light> {
        if self.left_out > 0 {
            warnings.push(format!("lights left out: {}", self.left_out));
        }
        let arriving = |lamp: &Lamp| match lamp.light.kind {
            LightType::Directional => lamp.strength(),
            LightType::Point | LightType::Spot => {
                let distance = wide(lamp.light.position).distance(wide(bounds.centre));
                let distance = distance.max(f64::from(bounds.radius) / 2.0).max(f64::MIN_POSITIVE.sqrt());
                lamp.strength() / (distance * distance)
            }
        };
        let brightest = self.lamps.iter().map(arriving).fold(0.0, f64::max);
        let light = |lamp: &Lamp| {
            let level = arriving(lamp) / brightest / lamp.strongest();
            let [r, g, b] = lamp.colour.map(|value| (value * level) as f32);
            Light { colour: shown([r, g, b, 1.0]), ..lamp.light.clone() }
        };
        self.lamps.iter().map(light).collect()
    }
}

impl Lamp {
    fn strongest(&self) -> f64 {
        self.colour.into_iter().fold(0.0, f64::max)
    }

    /// Intensity of the strongest channel.
    fn strength(&self) -> f64 {
        self.strongest() * self.intensity
    }
}

/// The exponent of a cosine that is one half midway between two angles from the axis, radians.
fn spot_exponent(inner: f64, outer: f64) -> f32 {
    let cosine = ((inner + outer) / 2.0).clamp(0.0, std::f64::consts::FRAC_PI_2).cos();
    // ln 0.5 / ln 0 is 0, a light all round; ln 0.5 / ln 1 is infinite, the card's narrowest.
    let exponent = (0.5_f64.ln() / cosine.ln().min(-1e-6)).clamp(0.0, 128.0);
    ((exponent * EXPONENT_STEPS).round() / EXPONENT_STEPS) as f32
}
