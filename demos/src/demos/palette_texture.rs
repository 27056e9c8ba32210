//! One picture in every format of texels, each as large as on the card: a texel a pixel.
//!
//! Soft shades show what a format cannot tell apart: 32 bits keep all, 16 bits make steps, a palette of 256 colours is
//! close where the picture has few hues, one of 16 leaves areas of one colour.

use std::sync::Arc;

use glam::DVec3;

use super::palette::{MIST, NIGHT, PORCELAIN};
use super::{SIZE, looks, overlay, pictures};
use crate::scene::{Material, Scene, TEXTURE_FORMATS, Texture, TextureFilter, TextureFormat, TextureFunction};

/// Where the panels begin, from one to the next, and below them the captions; pixels.
const FIRST: [f64; 2] = [20.0, 30.0];
const STEP: [f64; 2] = [260.0, 285.0];
/// Panels in a row.
const ACROSS: usize = 3;

pub(super) fn scene(_frame: u32) -> Scene {
    let mut scene = Scene::new(SIZE, NIGHT);
    let [width, height] = pictures::LAKE.size().map(f64::from);
    for (panel, (name, format)) in TEXTURE_FORMATS.into_iter().enumerate() {
        let texture = Texture {
            format,
            function: TextureFunction::Replace,
            filter: TextureFilter::Nearest,
            ..Texture::of(Arc::clone(&pictures::LAKE))
        };
        looks::add(&mut scene, name, Material { texture: Some(texture), ..looks::unlit() });
        let [x, y] = [FIRST[0] + STEP[0] * (panel % ACROSS) as f64, FIRST[1] + STEP[1] * (panel / ACROSS) as f64];
        let corner = |dx, dy| DVec3::new(x + dx, y + dy, 0.5);
        let corners = [corner(0.0, 0.0), corner(width, 0.0), corner(width, height), corner(0.0, height)];
        scene.draw.push(looks::quad(corners, [1.0, 1.0], [255; 4], name));
        let middle = x + width / 2.0;
        overlay::caption(&mut scene, [middle, y + height + 12.0], PORCELAIN, &title(name, format));
        overlay::caption(&mut scene, [middle, y + height + 36.0], MIST, &note(format));
    }
    scene
}

/// What a texel takes.
fn title(name: &str, format: TextureFormat) -> String {
    format!("{name}, {} bits", format.bits())
}

/// What the picture takes.
fn note(format: TextureFormat) -> String {
    let [width, height] = pictures::LAKE.size();
    let bytes = width * format.bits() / 8 * height + 4 * format.palette();
    format!("{},{:03} bytes", bytes / 1000, bytes % 1000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_show_every_format_a_texel_a_pixel() {
        let batches = scene(0).batches();
        let panels: Vec<_> = batches.iter().filter(|batch| batch.material.texture.is_some()).collect();
        let formats: Vec<TextureFormat> =
            panels.iter().filter_map(|batch| batch.material.texture.as_ref().map(|texture| texture.format)).collect();
        assert_eq!(formats, TextureFormat::ALL);
        for panel in panels {
            let [a, _, c, _] = [0, 1, 2, 3].map(|corner| panel.positions[corner]);
            assert_eq!([c[0] - a[0], c[1] - a[1]], [240.0, 200.0]);
            assert!(a.iter().chain(&c).all(|place| place.fract() == 0.0 || *place == 0.5));
            assert!(c[0] <= 800.0 && c[1] <= 600.0);
        }
    }

    #[test]
    fn title_names_format_and_bits() {
        assert_eq!(title("rgb565", TextureFormat::Rgb565), "rgb565, 16 bits");
    }

    #[test]
    fn note_counts_rows_and_palette() {
        assert_eq!(note(TextureFormat::Rgba8888), "192,000 bytes");
        assert_eq!(note(TextureFormat::Palette8), "49,024 bytes");
        assert_eq!(note(TextureFormat::Palette4), "24,064 bytes");
    }
}
