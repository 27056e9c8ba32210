//! The built-in scenes: what `zga list` lists and `zga show NAME` shows.
//!
//! Each is a function from a frame number to a scene, so that it can move; frame 0 is the picture for a still.

mod crossing;
mod curve;
mod decal_compare;
mod depth;
mod effects;
mod fine_mesh;
mod floor;
mod foliage;
mod glass;
mod landscape;
mod layers;
mod lights;
mod looks;
mod overlay;
mod palette;
mod palette_texture;
mod paths;
mod pictures;
mod points;
mod raster;
mod shadow;
mod shapes;
mod solids;
mod spokes;
mod teapot;
mod text;
mod wireframe;
mod zone_plate;

use crate::scene::{Colour, Scene, SubpixelGrid};

/// A named scene.
#[derive(Clone, Copy, Debug)]
pub struct Demo {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it shows, in a line.
    pub description: &'static str,
    /// Frames after which it repeats; 1 for a still.
    pub frames: u32,
    scene: fn(u32) -> Scene,
}

impl Demo {
    /// The scene at a frame; frames past the last begin again.
    #[must_use]
    pub fn build(&self, frame: u32) -> Scene {
        (self.scene)(frame % self.frames)
    }
}

/// Size of the demonstrations, in pixels.
const SIZE: [u32; 2] = [800, 600];

/// Frames of a full turn.
const TURN: u32 = 180;

/// All demonstrations; the first is the one that `zga` shows by itself.
pub const DEMOS: &[Demo] = &[
    Demo {
        name: "teapot",
        description: "the Utah teapot with markings drawn on it as decals",
        frames: TURN,
        scene: teapot::scene,
    },
    Demo {
        name: "decal-compare",
        description: "the same drawing on three slopes, as plain lines (left) and as decals (right)",
        frames: TURN,
        scene: decal_compare::scene,
    },
    Demo {
        name: "wireframe",
        description: "a knot as lines, with the hidden ones removed by the surface behind them",
        frames: TURN,
        scene: wireframe::scene,
    },
    Demo {
        name: "curve",
        description: "Bézier curves as decals on the Bézier patch that they belong to, with its control net",
        frames: TURN,
        scene: curve::scene,
    },
    Demo {
        name: "interpenetrate",
        description: "solids that run through each other, where the depth test draws every seam",
        frames: TURN,
        scene: solids::scene,
    },
    Demo {
        name: "points",
        description: "a cloud of points round a torus, the far ones hidden by it",
        frames: TURN,
        scene: points::scene,
    },
    Demo {
        name: "depth-fight",
        description: "tiles a hair above a floor: 16 bits of depth cannot keep them apart far away",
        frames: depth::FRAMES,
        scene: depth::scene_16,
    },
    Demo {
        name: "depth-fight-24",
        description: "the same tiles with 24 bits of depth",
        frames: depth::FRAMES,
        scene: depth::scene_24,
    },
    Demo {
        name: "gouraud",
        description: "colours interpolated over triangles: a wheel of hues and the three primaries",
        frames: 1,
        scene: raster::gouraud,
    },
    Demo {
        name: "lines-octants",
        description: "lines in every direction, from the centre outwards and back",
        frames: 1,
        scene: raster::lines_octants,
    },
    Demo {
        name: "slivers",
        description: "triangles thinner than a pixel that share every edge: no hole, no double pixel",
        frames: 1,
        scene: raster::slivers,
    },
    Demo {
        name: "za",
        description: "a wall whose Za blocks reject the pillars behind it, under a sky that stays cleared",
        frames: 1,
        scene: paths::za,
    },
    Demo {
        name: "systolic",
        description: "tents one before the other: ever more plane segments on the lines of the systolic array",
        frames: 1,
        scene: paths::systolic,
    },
    Demo {
        name: "tile",
        description: "large, thin and many small triangles: short and long lists of the tile unit",
        frames: 1,
        scene: paths::tile,
    },
    Demo {
        name: "zone-plate",
        description: "rings that get thinner outwards than a pixel: what anti-aliasing is tried on",
        frames: zone_plate::FRAMES,
        scene: zone_plate::scene,
    },
    Demo {
        name: "spokes",
        description: "anti-aliased wedges that meet in a point, and fans of lines of five widths",
        frames: spokes::FRAMES,
        scene: spokes::scene,
    },
    Demo {
        name: "fine-mesh",
        description: "a rippled sheet of 60,000 anti-aliased triangles, many of them smaller than a pixel",
        frames: TURN,
        scene: fine_mesh::scene,
    },
    Demo {
        name: "teapot-smooth",
        description: "the teapot anti-aliased, its markings drawn as lines of two widths",
        frames: TURN,
        scene: teapot::smooth,
    },
    Demo {
        name: "crossing",
        description: "surfaces that cross inside pixels, where samples compare depths",
        frames: TURN,
        scene: crossing::scene,
    },
    Demo {
        name: "layers",
        description: "300 faint translucent discs in any order, with a ball and a bar among them",
        frames: TURN,
        scene: layers::scene,
    },
    Demo {
        name: "floor",
        description: "a paved floor to the horizon: nearest texel, bilinear, trilinear with a MIP map",
        frames: floor::FRAMES,
        scene: floor::scene,
    },
    Demo {
        name: "palette-texture",
        description: "one picture in every format of texels, from 32 bits to a palette of 16 colours",
        frames: 1,
        scene: palette_texture::scene,
    },
    Demo {
        name: "lights",
        description: "a sun, a lamp and a spot on two teapots: light at each vertex (left), at each pixel (right)",
        frames: TURN,
        scene: lights::scene,
    },
    Demo {
        name: "landscape",
        description: "hills round a lake in a low sun, fading into the haze",
        frames: TURN,
        scene: landscape::scene,
    },
    Demo {
        name: "foliage",
        description: "trees, bushes and grass of flat cards with holes, drawn in any order",
        frames: TURN,
        scene: foliage::scene,
    },
    Demo {
        name: "glass",
        description: "crossing panes that add, cover and multiply, and a glass teapot",
        frames: TURN,
        scene: glass::scene,
    },
    Demo {
        name: "shadow",
        description: "solids round a lamp: shadow volumes counted in the stencil plane, darkened by the shadow bit",
        frames: TURN,
        scene: shadow::scene,
    },
    Demo {
        name: "effects",
        description: "one small scene twelve times, each with one effect, the last with all",
        frames: TURN,
        scene: effects::scene,
    },
    Demo { name: "effects-smooth", description: "the same anti-aliased", frames: TURN, scene: effects::smooth },
];

/// The demonstration with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Demo> {
    DEMOS.iter().find(|demo| demo.name == name)
}

/// An empty scene that is anti-aliased with 64 samples a pixel, unless the demo, flags or keys say otherwise.
fn smooth_scene(size: [u32; 2], background: Colour) -> Scene {
    let mut scene = Scene::new(size, background);
    scene.card.antialias = Some(SubpixelGrid::Grid8x8);
    scene
}

/// Part of a full turn at a frame, in radians.
fn turn(frame: u32) -> f64 {
    std::f64::consts::TAU * f64::from(frame) / f64::from(TURN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn demos_names_differ_and_are_found() {
        let names: HashSet<&str> = DEMOS.iter().map(|demo| demo.name).collect();
        assert_eq!(names.len(), DEMOS.len());
        assert!(DEMOS.iter().all(|demo| find(demo.name).is_some_and(|found| found.name == demo.name)));
        assert!(find("no such demo").is_none());
    }

    #[test]
    fn demos_every_frame_tried_gives_sound_batches() {
        for demo in DEMOS {
            for frame in [0, demo.frames / 3, demo.frames - 1] {
                let batches = demo.build(frame).batches();
                assert!(!batches.is_empty(), "{}", demo.name);
                for batch in batches {
                    let count = batch.positions.len();
                    assert_eq!(batch.colours.len(), count, "{} {}", demo.name, batch.path);
                    assert!(batch.indices.iter().all(|index| (*index as usize) < count));
                    assert!(batch.positions.iter().flatten().all(|coordinate| coordinate.is_finite()));
                }
            }
        }
    }

    #[test]
    fn demos_of_anti_aliasing_ask_for_it_by_themselves() {
        let asking = |grid| {
            let asks = move |demo: &&Demo| demo.build(0).card.antialias == Some(grid);
            DEMOS.iter().filter(asks).map(|demo| demo.name).collect::<Vec<_>>()
        };
        let smooth = ["zone-plate", "spokes", "fine-mesh", "teapot-smooth", "crossing", "effects-smooth"];
        assert_eq!(asking(SubpixelGrid::Grid8x8), smooth);
        assert_eq!(asking(SubpixelGrid::Grid4x4), ["layers"]);
    }

    #[test]
    fn build_past_the_last_frame_begins_again() {
        let demo = find("teapot").expect("listed");
        assert_eq!(demo.build(demo.frames + 2), demo.build(2));
    }
}
