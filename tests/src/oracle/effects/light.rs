//! Lights and materials in f64: diffuse light and Blinn's highlights.
//!
//! Eye space: the viewer is at the origin and looks down -z. Numbers in a record that are not finite count as 0.

use super::texel::Memory;
use super::{Colour, Ideal};

/// x, y, z.
pub type Vector = [f64; 3];

/// The scalar product.
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The length.
#[must_use]
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Of length 1; zero stays zero.
#[must_use]
pub fn normalised(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 { a.map(|x| x / length) } else { [0.0; 3] }
}

fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// The inverse transpose of a matrix' upper 3x3 (row-major, for row vectors); the zero matrix of a singular one.
#[must_use]
pub fn normal_matrix(object_eye: &[f32; 16]) -> [Vector; 3] {
    let m = [0, 1, 2].map(|row| [0, 1, 2].map(|column| f64::from(object_eye[4 * row + column])));
    // The inverse transpose is the matrix of cofactors over the determinant: rows are products of the other two.
    let cross =
        |a: Vector, b: Vector| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let determinant = dot(m[0], cofactors[0]);
    if determinant == 0.0 { [[0.0; 3]; 3] } else { cofactors.map(|row| row.map(|x| x / determinant)) }
}

/// Row vector times matrix.
#[must_use]
pub fn transformed(vector: Vector, matrix: &[Vector; 3]) -> Vector {
    [0, 1, 2].map(|column| (0..3).map(|row| vector[row] * matrix[row][column]).sum())
}

/// A point times an affine matrix.
#[must_use]
pub fn eye_position(position: [f32; 3], object_eye: &[f32; 16]) -> Vector {
    let m = |row: usize, column: usize| f64::from(object_eye[4 * row + column]);
    [0, 1, 2].map(|column| (0..3).map(|row| f64::from(position[row]) * m(row, column)).sum::<f64>() + m(3, column))
}

/// A light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Light {
    /// 0 directional, 1 point, 2 spot.
    pub kind: u32,
    /// Eye space.
    pub position: Vector,
    /// Of its rays.
    pub direction: Vector,
    /// 0 or less: none.
    pub cut_off: f64,
    /// Of a spot.
    pub exponent: f64,
    /// Red, green, blue, `0..=1`.
    pub colour: Vector,
    /// The same.
    pub ambient: Vector,
}

/// LIGHT_CONTROL to MATERIAL_SHININESS, and the records.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// At pixels instead of vertices.
    pub per_pixel: bool,
    /// Normals that point away are turned round.
    pub two_sided: bool,
    /// The viewer is the eye.
    pub local_viewer: bool,
    /// In order.
    pub lights: Vec<Light>,
    /// Of the scene, `0..=1`.
    pub ambient: Vector,
    /// Of the material, levels.
    pub specular: Vector,
    /// Of the material, levels.
    pub emission: Vector,
    /// Of the material, `0..=128`.
    pub shininess: f64,
}

fn levels(word: u32) -> Vector {
    let [r, g, b, _] = word.to_le_bytes();
    [r, g, b].map(f64::from)
}

fn shares(word: u32) -> Vector {
    levels(word).map(|level| level / 255.0)
}

impl Light {
    /// The record at an address.
    #[must_use]
    pub fn read(memory: &Memory, at: u32) -> Self {
        let word = |k: u32| memory.word(at + 4 * k);
        let number = |k: u32| Some(f64::from(f32::from_bits(word(k)))).filter(|x| x.is_finite()).unwrap_or(0.0);
        Self {
            kind: word(0),
            position: [1, 2, 3].map(number),
            direction: [4, 5, 6].map(number),
            cut_off: number(7),
            exponent: number(8).clamp(0.0, 128.0),
            colour: shares(word(9)),
            ambient: shares(word(10)),
        }
    }

    /// Where the light comes from, and how much of it there is.
    fn reach(&self, position: Vector) -> (Vector, f64) {
        if self.kind != 1 && self.kind != 2 {
            return (normalised(self.direction.map(|x| -x)), 1.0);
        }
        let towards = difference(self.position, position);
        let (l, distance) = (normalised(towards), length(towards));
        let mut share = 1.0;
        if self.cut_off > 0.0 {
            let near = (1.0 - (distance / self.cut_off).powi(2)).max(0.0);
            share = near * near;
        }
        if self.kind == 2 {
            let c = dot(l.map(|x| -x), normalised(self.direction));
            share *= if c > 0.0 { c.powf(self.exponent) } else { 0.0 };
        }
        (l, share)
    }
}

impl Lighting {
    /// What registers and records hold.
    #[must_use]
    pub fn read(registers: &[u32; 7], memory: &Memory) -> Self {
        let [control, base, count, ambient, specular, emission, shininess] = *registers;
        Self {
            per_pixel: control & 1 != 0,
            two_sided: control & 2 != 0,
            local_viewer: control & 4 != 0,
            lights: (0..count).map(|k| Light::read(memory, base + 64 * k)).collect(),
            ambient: shares(ambient),
            specular: levels(specular),
            emission: levels(emission),
            shininess: f32::from_bits(shininess).into(),
        }
    }

    /// What each channel of the polygon's colour is multiplied by, and the levels that are added to it.
    fn sums(&self, position: Vector, normal: Vector) -> (Vector, Vector) {
        let viewer = if self.local_viewer { normalised(position.map(|x| -x)) } else { [0.0, 0.0, 1.0] };
        let normal = normalised(normal);
        let away = self.two_sided && dot(normal, viewer) < 0.0;
        let normal = if away { normal.map(|x| -x) } else { normal };
        let (mut factor, mut added) = (self.ambient, self.emission);
        for light in &self.lights {
            let (l, share) = light.reach(position);
            let half = normalised([0, 1, 2].map(|k| l[k] + viewer[k]));
            let diffuse = dot(normal, l).max(0.0);
            let shines = diffuse > 0.0 && self.specular != [0.0; 3];
            let highlight = if shines { dot(normal, half).max(0.0).powf(self.shininess) } else { 0.0 };
            for c in 0..3 {
                factor[c] += share * (light.ambient[c] + light.colour[c] * diffuse);
                added[c] += share * light.colour[c] * self.specular[c] * highlight;
            }
        }
        (factor, added)
    }

    /// A colour in this light, in levels, unrounded; alpha stays.
    #[must_use]
    pub fn lit(&self, colour: Ideal, position: Vector, normal: Vector) -> Ideal {
        let (factor, added) = self.sums(position, normal);
        let lit = [0, 1, 2].map(|c| (added[c] + colour[c] * factor[c]).min(255.0));
        [lit[0], lit[1], lit[2], colour[3]]
    }

    /// The same as the card stores it: rounded half up.
    #[must_use]
    pub fn rounded(&self, colour: Colour, position: Vector, normal: Vector) -> Colour {
        self.lit(super::ideal(colour), position, normal).map(|level| (level + 0.5).floor() as u8)
    }

    /// How far off a lit colour can be, in levels, where the colour is off by so much: by what the light multiplies it by,
    /// 1/8 for the card's f32, and one rounding.
    #[must_use]
    pub fn tolerance(&self, colour: f64, position: Vector, normal: Vector) -> f64 {
        let (factor, _) = self.sums(position, normal);
        colour * factor.into_iter().fold(1.0, f64::max) + 0.125 + 0.5
    }
}

#[cfg(test)]
#[path = "light_tests.rs"]
mod tests;
