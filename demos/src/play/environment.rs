//! Light for a mesh that is shown alone.
//!
//! Lights stand in the world: they keep their places when the camera moves. Inputs from: the command line, and the
//! [`Mesh`] that is shown. Outputs to: lights, ambient light, background and materials of its [`Scene`].

use glam::DVec3;

use super::change::each_material;
use crate::mesh::{Bounds, Mesh};
use crate::scene::{Camera, Colour, FogFunction, Light, LightType, Lighting, Scene, narrow, wide};

/// Light that a mesh is shown in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Environment {
    /// Light worked into the colours on the host; the card lights nothing.
    Plain,
    /// Three soft lights, worked out at each pixel.
    Studio,
    /// One directional light and the sky, worked out at each vertex.
    Sun,
    /// Spots in the dark, worked out at each pixel.
    Night,
    /// The sun in fog.
    Fog,
}

/// Share of the distance to the target at which fog has taken a good part of a colour.
const FOG_REACH: f64 = 0.8;

impl Environment {
    /// Every value with its name.
    pub const NAMED: &'static [(&'static str, Environment)] = &[
        ("plain", Environment::Plain),
        ("studio", Environment::Studio),
        ("sun", Environment::Sun),
        ("night", Environment::Night),
        ("fog", Environment::Fog),
    ];

    /// What a mesh is shown in where nothing is asked for: one with materials of its own, but no lights, in the studio.
    #[must_use]
    pub fn usual(mesh: &Mesh) -> Environment {
        if mesh.parts.is_empty() || !mesh.lights.is_empty() { Environment::Plain } else { Environment::Studio }
    }

    /// Gives a scene that shows a mesh of these bounds its light. What the scene had of lights goes.
    pub fn light(self, scene: &mut Scene, bounds: Bounds) {
        let (centre, radius) = (wide(bounds.centre), f64::from(bounds.radius).max(1e-6));
        let lighting = match self {
            Environment::Plain => return,
            Environment::Studio => {
                let (lights, ambient) = studio();
                (scene.lights, scene.ambient) = (lights, ambient);
                Lighting::Pixel
            }
            Environment::Sun | Environment::Fog => {
                let direction = [-0.45, -0.8, -0.55];
                let sky = if self == Environment::Sun { [104, 146, 196, 255] } else { [138, 148, 162, 255] };
                (scene.lights, scene.ambient) = (vec![directional(direction, [186, 178, 158, 255])], [60, 70, 90, 255]);
                scene.background = sky;
                Lighting::Vertex
            }
            Environment::Night => {
                let spot = |from: [f64; 3], colour: Colour| {
                    let from = DVec3::from_array(from);
                    Light {
                        kind: LightType::Spot,
                        position: narrow(centre + from * radius),
                        direction: narrow(-from.normalize()),
                        // Past this nothing of a scene that the camera frames is to be seen.
                        attenuation_cut_off: Some((8.0 * radius) as f32),
                        spot_exponent: 40.0,
                        colour,
                        ambient: [0, 0, 0, 255],
                    }
                };
                scene.lights = vec![
                    spot([1.6, 2.2, 1.9], [255, 214, 150, 255]),
                    spot([-2.4, 0.9, 1.5], [90, 140, 255, 255]),
                    spot([0.4, 1.8, -2.4], [255, 90, 70, 255]),
                ];
                (scene.ambient, scene.background) = ([14, 16, 30, 255], [5, 6, 12, 255]);
                Lighting::Pixel
            }
        };
        let fog = (self == Environment::Fog).then(|| fog_density(&scene.camera)).flatten();
        let colour = scene.background;
        each_material(scene, |material| {
            material.light = material.light.or(Some(lighting));
            if let Some(density) = fog {
                (material.fog_function, material.fog_density) = (FogFunction::ExponentialSquared, density);
                material.fog_colour = colour;
            }
        });
    }
}

/// Density of squared exponential fog that begins to be seen about the target of a camera; none for pixels.
pub(super) fn fog_density(camera: &Camera) -> Option<f32> {
    let [eye, target, _] = camera.placement()?;
    let distance = wide(eye).distance(wide(target));
    (distance > 0.0).then(|| ((FOG_REACH / distance) as f32).min(f32::MAX))
}

/// The lights of the studio, and the light that is everywhere: a warm key light from above on the right, a cold one that
/// fills up the shadows, and one from behind.
pub(super) fn studio() -> (Vec<Light>, Colour) {
    let lights = vec![
        directional([-0.5, -0.75, -0.6], [152, 144, 132, 255]),
        directional([0.8, -0.1, -0.5], [58, 66, 82, 255]),
        directional([0.1, -0.5, 0.85], [64, 64, 70, 255]),
    ];
    (lights, [62, 62, 68, 255])
}

fn directional(direction: [f32; 3], colour: Colour) -> Light {
    Light {
        kind: LightType::Directional,
        position: [0.0; 3],
        direction,
        attenuation_cut_off: None,
        spot_exponent: 0.0,
        colour,
        ambient: [0, 0, 0, 255],
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::Part;
    use crate::scene::Material;

    /// A triangle that faces the viewer.
    fn mesh() -> Mesh {
        let mut mesh =
            Mesh::new("one.obj", vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], vec![0, 1, 2], [200, 80, 40, 255]);
        mesh.normals = Some(vec![[0.0, 0.0, 1.0]; 3]);
        mesh
    }

    #[test]
    fn usual_of_a_mesh_with_materials_is_the_studio() {
        let mut with_parts = mesh();
        assert_eq!(Environment::usual(&with_parts), Environment::Plain);
        with_parts.parts = vec![Part { triangles: 0..1, material: Arc::new(Material::default()) }];
        assert_eq!(Environment::usual(&with_parts), Environment::Studio);
        with_parts.lights = studio().0;
        assert_eq!(Environment::usual(&with_parts), Environment::Plain, "it brings its own light");
    }

    #[test]
    fn light_every_environment_but_plain_lights_the_mesh() {
        let lit = |environment: Environment| {
            let mut scene = Scene::showing(mesh(), [32, 32]);
            environment.light(&mut scene, mesh().bounds());
            let batch = scene.batches().remove(0);
            (batch.light, scene.lights.len(), batch.material.fog_function)
        };
        let none = FogFunction::None;
        assert_eq!(lit(Environment::Plain), (Lighting::None, 0, none));
        assert_eq!(lit(Environment::Studio), (Lighting::Pixel, 3, none));
        assert_eq!(lit(Environment::Sun), (Lighting::Vertex, 1, none));
        assert_eq!(lit(Environment::Night), (Lighting::Pixel, 3, none));
        assert_eq!(lit(Environment::Fog), (Lighting::Vertex, 1, FogFunction::ExponentialSquared));
    }
}
