//! Panes of coloured glass that cross each other and a ball, one pair for each way of blending, and a glass teapot.
//!
//! The panes run through one another and through what is opaque, so no order of drawing is right for a whole pane: the
//! card sorts what is translucent pixel by pixel (sample by sample with a grid).

use glam::{DMat4, DVec3};

use super::palette::{AMBER, COBALT, CORAL, MIST, PORCELAIN, SKY, TEAL, mix};
use super::{SIZE, looks, overlay, pictures, shapes, turn};
use crate::scene::{
    Blend, Camera, Colour, Draw, FogFunction, Lighting, Material, MeshDraw, Perspective, Scene, TextureFilter, narrow,
};
use crate::teapot::Teapot;

/// Cells along each side of a patch of the teapot.
const LEVEL: u32 = 10;
/// Half the width and the height of a pane.
const PANE: [f64; 2] = [1.15, 2.3];

/// A pair of panes and the ball that they cross.
struct Station {
    blend: Blend,
    name: &'static str,
    x: f64,
    panes: [Colour; 2],
}

/// A colour with another alpha.
const fn faint([r, g, b, _]: Colour, alpha: u8) -> Colour {
    [r, g, b, alpha]
}

const STATIONS: [Station; 3] = [
    Station { blend: Blend::Add, name: "add", x: -3.05, panes: [faint(CORAL, 96), faint(COBALT, 200)] },
    Station { blend: Blend::Alpha, name: "alpha", x: 0.0, panes: [faint(CORAL, 140), faint(TEAL, 140)] },
    Station { blend: Blend::Multiply, name: "multiply", x: 3.05, panes: [faint(AMBER, 255), faint(SKY, 255)] },
];

/// Behind everything: light enough to be darkened and dark enough to be lightened.
const BACK: Colour = [98, 107, 132, 255];
const BALL: &str = "ball";
/// Edges of the panes.
const RIM: &str = "rim";
const FLOOR: &str = "floor";
const TEAPOT: &str = "premultiplied";

pub(super) fn scene(frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, BACK);
    let camera = Camera::Perspective(Perspective {
        eye: [0.0, 3.6, 10.2],
        target: [0.0, 0.75, 0.4],
        up: [0.0, 1.0, 0.0],
        fov_x_degrees: 47.0,
        near: 2.0,
        far: 40.0,
    });
    scene.camera = camera.orbited(0.25 * turn(frame).sin(), 0.0, 1.0);
    scene.ambient = [92, 96, 112, 255];
    scene.lights = vec![looks::sun([-0.5, -0.8, -0.55], [206, 198, 182, 255])];
    let checks = looks::repeated(&pictures::CHECKS, TextureFilter::Trilinear);
    let fog = Material {
        texture: Some(checks),
        fog_function: FogFunction::ExponentialSquared,
        fog_density: 0.075,
        fog_colour: BACK,
        ..looks::dull(Lighting::Pixel)
    };
    looks::add(&mut scene, FLOOR, fog);
    looks::add(&mut scene, BALL, looks::glazed(Lighting::Pixel, 120, 40.0));
    let glass = Material { blend: Blend::Premultiplied, two_sided: true, ..looks::glazed(Lighting::Pixel, 255, 70.0) };
    looks::add(&mut scene, TEAPOT, glass);
    let floor = looks::level(0.0, [[-26.0, -24.0], [26.0, 12.0]], [1, 1], 0.22, mix(MIST, PORCELAIN, 0.6));
    scene.draw.push(looks::of(Draw::Mesh(MeshDraw::of(floor)), FLOOR));
    for station in &STATIONS {
        station.build(&mut scene, 0.25 * turn(frame));
    }
    // Its colour is multiplied by its alpha already, so its highlights are as bright as on porcelain.
    let teapot = Teapot::new(LEVEL, [18, 58, 78, 84]).mesh().clone();
    let place = DMat4::from_translation(DVec3::new(-0.1, 0.0, 3.1)) * DMat4::from_scale(DVec3::splat(0.42));
    scene.draw.push(looks::of(shapes::placed(teapot, place * DMat4::from_rotation_y(0.35)), TEAPOT));
    let captions: Vec<([f64; 2], &str)> = STATIONS
        .iter()
        .map(|station| (station.x, station.name))
        .filter_map(|(x, name)| {
            let top = scene.camera.project([x as f32, PANE[1] as f32, -0.6], SIZE)?;
            Some(([top[0], top[1] - 58.0], name))
        })
        .collect();
    for (place, name) in captions {
        overlay::caption(&mut scene, place, PORCELAIN, name);
    }
    if let Some([x, y, _]) = scene.camera.project([-0.05, 0.0, 4.0], SIZE) {
        overlay::caption(&mut scene, [x, y + 14.0], PORCELAIN, TEAPOT);
    }
    scene
}

impl Station {
    fn build(&self, scene: &mut Scene, turned: f64) {
        let centre = DVec3::new(self.x, 0.0, -0.6);
        let ball = shapes::sphere(0.72, 4, PORCELAIN);
        let bar = looks::block(DVec3::new(1.0, 0.09, 0.09), CORAL);
        let at = |rise: f64| DMat4::from_translation(centre + DVec3::Y * rise);
        scene.draw.push(looks::of(shapes::placed(ball, at(0.72)), BALL));
        let tilt = DMat4::from_rotation_y(0.3) * DMat4::from_rotation_z(0.22);
        scene.draw.push(looks::of(shapes::placed(bar, at(1.78) * tilt), BALL));
        looks::add(scene, self.name, Material { blend: self.blend, ..looks::unlit() });
        for (side, colour) in [-1.0, 1.0].into_iter().zip(self.panes) {
            let right = DMat4::from_rotation_y(side * 0.62 + turned.sin() * 0.3).transform_vector3(DVec3::X) * PANE[0];
            let top = DVec3::Y * PANE[1];
            // A hair above the floor, so that their edge is not in it.
            let foot = centre + DVec3::Y * 0.01;
            let corners = [foot - right + top, foot + right + top, foot + right, foot - right];
            scene.draw.push(looks::quad(corners, [1.0, 1.0], colour, self.name));
            let rim = shapes::pieces(&corners.map(narrow), true);
            let rim = shapes::wide_lines(rim, mix(faint(colour, 255), PORCELAIN, 0.45), 1.5);
            // Before the pane whose edge it is, by the slope of a pane seen at an angle.
            scene.draw.push(looks::of(shapes::decal(vec![rim]), RIM));
        }
        looks::add(scene, RIM, looks::unlit());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_blends_in_every_way_there_is() {
        let mut found: Vec<Blend> = scene(0).batches().iter().map(|batch| batch.material.blend).collect();
        found.sort_by_key(|blend| blend.name());
        found.dedup();
        let expected = [Blend::Add, Blend::Alpha, Blend::Multiply, Blend::Opaque, Blend::Premultiplied];
        assert_eq!(found, expected);
    }

    #[test]
    fn panes_of_a_station_cross_in_the_middle_of_its_ball() {
        let batches = scene(0).batches();
        for station in &STATIONS {
            let same = batches.iter().filter(|batch| batch.material.blend == station.blend);
            let panes: Vec<_> = same.map(|batch| batch.positions.clone()).collect();
            assert_eq!(panes.len(), 2);
            for corners in &panes {
                let middle = (corners[0][0] + corners[1][0]) / 2.0;
                assert!((f64::from(middle) - station.x).abs() < 1e-6);
            }
            let normal = |pane: &[[f32; 3]]| DVec3::Y.cross(crate::scene::wide(pane[1]) - crate::scene::wide(pane[0]));
            assert!(normal(&panes[0]).angle_between(normal(&panes[1])) > 1.0);
        }
    }
}
