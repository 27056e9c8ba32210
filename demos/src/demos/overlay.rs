//! Captions in front of a scene: letters of the charts' font on a plane right behind the near one.
//!
//! Duties: turns letters into rectangles that cover whole pixels at the demonstrations' size, so that they are crisp
//! there and scale with the picture elsewhere. Inputs from: [`crate::canvas`], the scene's camera. Outputs to: the draw
//! list. The places are those of the camera as it is when the caption is added.

use glam::DVec3;

use crate::canvas::{Canvas, text_size};
use crate::scene::{Camera, Colour, Colours, Draw, Lighting, Material, Primitives, Scene, narrow, wide};

/// Name of the captions' material: no light falls on them.
const MATERIAL: &str = "caption";
/// Pixels of the screen for one of a letter.
const SCALE: u32 = 2;

/// What lies nearer hides what lies farther.
#[derive(Clone, Copy)]
enum Layer {
    Plate = 3,
    Shadow = 2,
    Letters = 1,
}

/// Writes a line of text, `centre` being the middle of its upper edge in pixels, with a shadow that keeps it apart from
/// what it covers.
pub(super) fn caption(scene: &mut Scene, centre: [f64; 2], colour: Colour, text: &str) {
    // The last letter's cell ends with a column of space.
    let [width, height] = text_size(SCALE, text);
    let [left, top] = [(centre[0] - f64::from(width - SCALE) / 2.0).round(), centre[1].round()];
    let mut canvas = Canvas::new([width, height + 2 * SCALE], [0; 3]);
    canvas.text([0, 0], SCALE, [255; 3], text);
    let picture = canvas.into_picture();
    let mut runs = Vec::new();
    for y in (0..picture.height).step_by(SCALE as usize) {
        let set = |x| x < picture.width && picture.at(x, y).is_some_and(|ink| ink[0] != 0);
        let mut start = None;
        for x in 0..=picture.width {
            match (set(x), start) {
                (true, None) => start = Some(x),
                (false, Some(from)) => {
                    runs.push([f64::from(from), f64::from(y), f64::from(x - from), f64::from(SCALE)]);
                    start = None;
                }
                _ => {}
            }
        }
    }
    let moved = |by: f64| runs.iter().map(move |[x, y, w, h]| [left + x + by, top + y + by, *w, *h]);
    let shadow = moved(1.0).collect::<Vec<_>>();
    rectangles(scene, &shadow, Layer::Shadow, [0, 0, 0, 255]);
    let letters = moved(0.0).collect::<Vec<_>>();
    rectangles(scene, &letters, Layer::Letters, colour);
}

/// A rectangle of one colour behind all captions: x, y, width and height in pixels.
pub(super) fn plate(scene: &mut Scene, rectangle: [f64; 4], colour: Colour) {
    rectangles(scene, &[rectangle], Layer::Plate, colour);
}

fn rectangles(scene: &mut Scene, all: &[[f64; 4]], layer: Layer, colour: Colour) {
    let place = |x, y| narrow(place(&scene.camera, scene.size, [x, y], layer));
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for [x, y, width, height] in all {
        let first = vertices.len() as u32;
        vertices.extend([place(*x, *y), place(x + width, *y), place(x + width, y + height), place(*x, y + height)]);
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    let material = Material { light: Some(Lighting::None), ..Material::default() };
    scene.materials.insert(MATERIAL.to_owned(), material);
    scene.draw.push(Draw::Triangles(Primitives {
        vertices,
        indices: Some(indices),
        colours: Colours::One(colour),
        material: Some(MATERIAL.to_owned()),
        ..Default::default()
    }));
}

/// The point of a layer that is seen at a place of the picture, in pixels.
fn place(camera: &Camera, size: [u32; 2], [x, y]: [f64; 2], layer: Layer) -> DVec3 {
    let depth = 1.0 + 0.02 * f64::from(layer as u32);
    let (near, parallel) = match camera {
        Camera::Screen => return DVec3::new(x, y, 0.002 * f64::from(layer as u32)),
        Camera::Orthographic(camera) => (camera.near, true),
        Camera::Perspective(camera) => (camera.near, false),
    };
    let [eye, target, up] = camera.placement().unwrap_or_default().map(wide);
    let forward = (target - eye).normalize();
    let right = forward.cross(up).normalize();
    let up = right.cross(forward);
    let distance = depth * f64::from(near);
    let unit = camera.pixels_per_unit(size);
    let [x, y] = [(x - f64::from(size[0]) / 2.0) / unit, (f64::from(size[1]) / 2.0 - y) / unit];
    let aside = right * x + up * y;
    eye + forward * distance + if parallel { aside } else { aside * distance }
}

#[cfg(test)]
mod tests {
    use super::super::SIZE;
    use super::*;
    use crate::scene::{Orthographic, Perspective};

    const EYE: [f32; 3] = [3.0, 2.0, 5.0];
    const UP: [f32; 3] = [0.0, 1.0, 0.0];

    fn cameras() -> [Camera; 3] {
        let (eye, target, up, near, far) = (EYE, [0.0; 3], UP, 0.5, 50.0);
        [
            Camera::Screen,
            Camera::Orthographic(Orthographic { eye, target, up, width: 9.0, near, far }),
            Camera::Perspective(Perspective { eye, target, up, fov_x_degrees: 50.0, near, far }),
        ]
    }

    #[test]
    fn place_is_seen_at_its_pixel_and_layers_lie_before_one_another() {
        for camera in cameras() {
            let seen = |layer| {
                let point = narrow(place(&camera, SIZE, [120.0, 77.0], layer));
                camera.project(point, SIZE).expect("before the viewer")
            };
            let layers = [Layer::Letters, Layer::Shadow, Layer::Plate].map(seen);
            // Single precision of world coordinates moves a place by far less than a hundredth of a pixel.
            assert!(layers.iter().all(|[x, y, _]| (x - 120.0).abs() < 0.01 && (y - 77.0).abs() < 0.01), "{layers:?}");
            assert!(layers.iter().all(|[.., depth]| (0.0..1.0).contains(depth)), "{layers:?}");
            assert!(layers.windows(2).all(|pair| pair[0][2] < pair[1][2]), "{layers:?}");
        }
    }

    #[test]
    fn caption_covers_the_pixels_of_its_letters_twice_as_large() {
        let mut scene = Scene::new(SIZE, [0, 0, 0, 255]);
        caption(&mut scene, [100.0, 50.0], [255; 4], "-");
        let batches = scene.batches();
        // A dash is one run of five pixels in the fourth row; with its space its cell is 12 wide.
        let of = |batch: &crate::scene::Batch| [batch.positions[0], batch.positions[2]].map(|p| [p[0], p[1]]);
        assert_eq!(
            batches.iter().map(of).collect::<Vec<_>>(),
            [[[96.0, 57.0], [106.0, 59.0]], [[95.0, 56.0], [105.0, 58.0]]]
        );
        assert!(batches.iter().all(|batch| batch.light == Lighting::None));
    }
}
