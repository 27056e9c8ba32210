//! What the tests of the effects share: ways to draw, triangles, mappings, lights.

use zga_device::Kernel;
use zga_tests::harness::look::{Fog, Lights, Record};
use zga_tests::harness::{Camera, Hidden, Options, Pixels, Random};
use zga_tests::oracle::effects::Corner;

/// Paths, functional and clocked, with what matters on each.
pub fn paths() -> Vec<Hidden> {
    let tiles = [[8, 8], [4, 64], [64, 4], [32, 16]].map(Hidden::tile);
    let rest = [Hidden::default(), Hidden::za([32, 1]), Hidden::za([8, 4]), Hidden::systolic(0), Hidden::systolic(8)];
    tiles.into_iter().chain(rest).flat_map(|hidden| [hidden, hidden.clocked()]).collect()
}

/// Options of a way to draw: any path, kernel, number of threads, with or without a Z buffer where there may be none.
pub fn any_way(random: &mut Random) -> Options {
    let kernels = Kernel::available();
    let hidden = pick(random, &paths());
    Options {
        hidden,
        kernel: pick(random, &kernels),
        threads: random.range(1, 3) as usize,
        depth_buffer: !hidden.path.keeps_depths() || random.range(0, 1) == 0,
        pixels: Pixels::Argb8888,
        ..Options::default()
    }
}

/// The specification on a path.
pub fn specified(hidden: Hidden) -> Options {
    Options { hidden, kernel: Kernel::Specification, pixels: Pixels::Argb8888, ..Options::default() }
}

/// One of several.
pub fn pick<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[random.range(0, of.len() as i64 - 1) as usize]
}

/// True for `of_100` of 100.
pub fn chance(random: &mut Random, of_100: i64) -> bool {
    random.range(0, 99) < of_100
}

/// A way from pixels to texels that puts the pixels' centres well inside of texels: nothing is in doubt.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    first: [f64; 2],
    step: [f64; 2],
    size: [u32; 2],
}

impl Mapping {
    /// For a window of `size` texels.
    pub fn any(random: &mut Random, size: [u32; 2]) -> Self {
        let mut axis = || {
            let step = pick(random, &[0.25, 0.25, 1.0, -1.0, 2.0, 3.0, -0.25]);
            let first = random.range(-40, 40) as f64;
            let inside = if f64::fract(step) == 0.0 { pick(random, &[0.25, 0.5, 0.75]) } else { 0.125 };
            (first + inside, step)
        };
        let [x, y] = [axis(), axis()];
        Self { first: [x.0, y.0], step: [x.1, y.1], size }
    }

    /// Coordinates at a place in pixels.
    pub fn at(&self, place: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|axis| {
            let texel = self.first[axis] + self.step[axis] * (f64::from(place[axis]) - 0.5);
            (texel / f64::from(self.size[axis])) as f32
        })
    }
}

/// A corner at a place in pixels, with a depth of `0..=1`, under the identity camera.
pub fn corner(place: [f32; 2], z: f32, colour: u32) -> Corner {
    Corner { position: [place[0], place[1], z], colour, normal: [0.0, 0.0, 1.0], ..Corner::default() }
}

/// Two triangles over all of a target, of one depth and colour.
pub fn sheet([width, height]: [u32; 2], z: f32, colour: u32) -> [Corner; 6] {
    let [w, h] = [width, height].map(|side| side as f32);
    let at = |x: f32, y: f32| corner([x, y], z, colour);
    [at(0.0, 0.0), at(w, 0.0), at(0.0, h), at(0.0, h), at(w, 0.0), at(w, h)]
}

/// A triangle on the lattice of 1/256 pixel about a target, each vertex with a depth of its own, in one colour.
pub fn triangle(random: &mut Random, size: [u32; 2], colour: u32) -> [Corner; 3] {
    [(); 3].map(|()| {
        let place = size.map(|side| random.int(-1024, side as i32 * 256 + 1024) as f32 / 256.0);
        // 2^-20 steps: every depth survives the f32.
        corner(place, random.range(0, 1 << 20) as f32 / (1 << 20) as f32, colour)
    })
}

/// The object matrix of the scenes in perspective, not one that keeps angles, and what turns eye coordinates into object
/// coordinates under it.
pub fn stretched(size: [u32; 2]) -> Camera {
    let object_eye = [2., 0., 0., 0., 0., 0.5, 0., 0., 0.25, 0., 1., 0., 0., 0., -3., 1.];
    Camera { object_eye, ..Camera::perspective(size) }
}

/// A triangle in front of the eye, seen in perspective through [`stretched`]; distances from 1.5 to `far`.
pub fn seen(random: &mut Random, far: f64, colours: [u32; 3]) -> [Corner; 3] {
    // Normals lean towards the viewer, about one direction: between them none is near zero.
    let main = [random.between(-0.7, 0.7), random.between(-0.7, 0.7), 1.0];
    colours.map(|colour| {
        let distance = 1.5 * (far / 1.5).powf(random.unit());
        let [x, y] = [(); 2].map(|()| random.between(-1.4, 1.4) * distance);
        let z = 3.0 - distance;
        let normal = main.map(|n| (n + random.between(-0.4, 0.4)) as f32);
        let position = [((x - 0.25 * z) / 2.0) as f32, (2.0 * y) as f32, z as f32];
        let coordinates = [(); 2].map(|()| random.between(-3.0, 3.0) as f32);
        Corner { position, colour, normal, coordinates }
    })
}

/// A light somewhere in front of the eye.
pub fn any_record(random: &mut Random) -> Record {
    let share = |random: &mut Random| random.bits() as u32 & 0x007F_7F7F;
    let mut vector = |reach: f64| [(); 3].map(|()| random.between(-reach, reach) as f32);
    let (position, direction) = (vector(6.0), vector(1.0));
    Record {
        kind: random.range(0, 3) as u32,
        position: [position[0], position[1], position[2] - 4.0],
        direction,
        cut_off: pick(random, &[0.0, -1.0, 6.0, 20.0]),
        exponent: pick(random, &[0.0, 1.0, 2.5, 30.0, 128.0]),
        colour: share(random),
        ambient: share(random) >> 2 & 0x003F_3F3F,
    }
}

/// Registers for `count` lights whose records begin at `base`.
pub fn any_lights(random: &mut Random, base: u32, count: u32) -> Lights {
    let word = |random: &mut Random, mask: u32| random.bits() as u32 & mask;
    Lights {
        per_pixel: chance(random, 50),
        two_sided: chance(random, 50),
        local_viewer: chance(random, 50),
        base,
        count,
        ambient: word(random, 0x007F_7F7F),
        specular: pick(random, &[0, 0xFF00_0000, 0x00FF_8040, 0x0040_4040]),
        emission: word(random, 0x001F_1F1F),
        shininess: pick(random, &[0.0, 1.0, 3.75, 20.0, 128.0]),
    }
}

/// Fog that neither hides all nor nothing between 1 and 40.
pub fn any_fog(random: &mut Random) -> Fog {
    Fog {
        function: random.range(1, 4) as u32,
        density: random.between(0.01, 0.3) as f32,
        end: random.between(3.0, 50.0) as f32,
        scale: random.between(-0.02, 0.2) as f32,
        offset: random.between(0.0, 1.5) as f32,
        colour: random.bits() as u32,
    }
}
