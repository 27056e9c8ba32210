//! Lights: the colour of a vertex or a pixel under the lights of a draw.
//!
//! Duties: takes light records from video memory into the form that the unit works with; ambient, diffuse and specular
//! light of directional, point and spot lights; attenuation to a cut-off, fall-off of spots from their axis.
//! Inputs from: `geometry` (a vertex in eye space, its normal) or the interpolators (the same at a pixel); the draw's
//! [`Lighting`]; records in video memory. Outputs to: `geometry` (the vertex's colour) or the texture function.
//! Clocks: 4 a light and vertex or pixel, 1 a lit pixel; whoever calls charges them.
//!
//! All numbers are f32, each operation is rounded, in the order written here; [`Lights::lit`] is the specification and
//! [`Lights::lit_lanes`] does the same 16 times side by side, with the same functions for a place and a light.
//!
//! Error of a level before it is rounded: 0.02 where |L + V| is 1/8 or more (shininess 128; in proportion below), growing as
//! 0.001 / |L + V| where light and viewer face each other more than that; diffuse light alone 0.0003.
//!
//! What comes from outside is made finite where it enters, records in [`Lights::read`], places and normals in `Place::new`:
//! a number that is not finite counts as 0, a coordinate beyond +-2^125 as +-2^125. From there no infinity lasts and no
//! NaN is formed but where a selection drops it.
//!
//! | case | result |
//! | --- | --- |
//! | zero normal | ambient and emission alone |
//! | light at the place itself | its ambient, unattenuated; no diffuse, no specular. A spot: nothing |
//! | zero direction | directional: its ambient alone. Spot: nothing |
//! | place at the eye, local viewer | highlights as from a viewer in the light's own direction; normals are not turned |
//! | light exactly behind, L = -V | H is zero: specular only where the shininess is 0 |

use super::levels::whole;
use super::math::{Reach, Vector, coordinate, dot, pow, reach};
use zga_abi::format::LightType;
use zga_abi::light::LightRecord;
use zga_firmware::checked::Lighting;

/// Vertices or pixels side by side.
const LANES: usize = 16;
/// Words of a record.
const RECORD: usize = size_of::<LightRecord>() / 4;
/// Greatest exponent of a spot and of the shininess.
const MOST_EXPONENT: f32 = 128.0;

/// A vector a lane.
type Vectors = [[f32; LANES]; 3];

/// Lights of a draw, read from video memory, in the form the unit works with.
#[derive(Clone, Debug)]
pub struct Lights {
    lights: Vec<Light>,
    two_sided: bool,
    local_viewer: bool,
    /// Levels that the material gives off.
    emission: Vector,
    /// Share of the colour that is seen everywhere.
    ambient: Vector,
    /// Some light can make a highlight.
    glossy: bool,
    shininess: f32,
}

/// One light.
#[derive(Clone, Copy, Debug)]
struct Light {
    kind: LightType,
    /// Eye space.
    position: Vector,
    /// Against the rays, along the axis of a spot: a unit vector, or zero.
    against: Vector,
    /// 1 / cut-off, at most the greatest f32; 0 where there is none.
    per_cut_off: f32,
    exponent: f32,
    /// Share of the surface's colour, 0..=1, that it adds within its reach.
    ambient: Vector,
    /// Share of the surface's colour, 0..=1, that full diffuse light adds.
    colour: Vector,
    /// Levels of a full highlight, 0..=255.
    highlight: Vector,
}

/// A vertex or a pixel.
#[derive(Clone, Copy, Debug)]
struct Place {
    position: Vector,
    /// Unit vector, or zero; toward the viewer where lights are two-sided.
    normal: Vector,
    /// Toward the viewer: unit vector, or zero.
    viewer: Vector,
}

/// What one light sends to a place.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    /// Toward the light: unit vector, or zero.
    towards: Vector,
    attenuation: f32,
    /// Cosine of the angle of incidence, 0 or more.
    diffuse: f32,
}

/// Light gathered at a place.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// Times the surface's colour.
    share: Vector,
    /// Levels of highlights.
    gloss: Vector,
}

/// Red, green and blue of a colour, levels.
#[inline(always)]
fn levels(colour: u32) -> Vector {
    let level = |shift: u32| ((colour >> shift) & 0xFF) as i32 as f32;
    [level(0), level(8), level(16)]
}

/// An exponent as the unit takes it: not finite counts as 0.
fn exponent(value: f32) -> f32 {
    if value.is_finite() && value > 0.0 { value.min(MOST_EXPONENT) } else { 0.0 }
}

impl Light {
    fn new(record: &LightRecord, specular: Vector) -> Light {
        let kind = LightType::from_code(record.kind).unwrap_or(LightType::Directional);
        let cut_off = record.cut_off;
        let reaches_far = !(cut_off.is_finite() && cut_off > 0.0);
        let colour = levels(record.colour).map(|level| level / 255.0);
        Light {
            kind,
            position: record.position.map(coordinate),
            against: reach(record.direction.map(|c| -coordinate(c))).unit,
            // The quotient of a subnormal cut-off can be infinite.
            per_cut_off: if reaches_far { 0.0 } else { (1.0 / cut_off).min(f32::MAX) },
            exponent: exponent(record.spot_exponent),
            ambient: levels(record.ambient).map(|level| level / 255.0),
            colour,
            highlight: std::array::from_fn(|k| specular[k] * colour[k]),
        }
    }

    /// Diffuse light at a place; `kind` is the light's, a constant to the compiler.
    #[inline(always)]
    fn arrival(&self, kind: LightType, position: Vector, normal: Vector) -> Arrival {
        if kind == LightType::Directional {
            return Arrival { towards: self.against, attenuation: 1.0, diffuse: positive(dot(normal, self.against)) };
        }
        let [x, y, z] = self.position;
        let Reach { unit, square, scale } = reach([x - position[0], y - position[1], z - position[2]]);
        // (d / R)^2; infinite at worst, since neither factor of the first product is, and only where `square` is not 0.
        let relative = scale * self.per_cut_off;
        let left = positive(1.0 - square * (relative * relative));
        let mut attenuation = left * left;
        if kind == LightType::Spot {
            let cosine = dot(unit, self.against);
            let fall_off = pow(one_at_most(cosine), self.exponent);
            attenuation *= if cosine > 0.0 { fall_off } else { 0.0 };
        }
        Arrival { towards: unit, attenuation, diffuse: positive(dot(normal, unit)) }
    }
}

/// `x`, or 0 if it is less or not a number.
#[inline(always)]
fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// `x`, or 1 if it is more.
#[inline(always)]
fn one_at_most(x: f32) -> f32 {
    if x < 1.0 { x } else { 1.0 }
}

impl Arrival {
    /// What highlights are in proportion to; 0 on the side away from the light.
    #[inline(always)]
    fn shine(&self) -> f32 {
        if self.diffuse > 0.0 { self.attenuation } else { 0.0 }
    }
}

/// The share of a highlight that is seen: (N . H)^shininess, H half-way between light and viewer.
#[inline(always)]
fn specular(towards: Vector, normal: Vector, viewer: Vector, shininess: f32) -> f32 {
    let half = [towards[0] + viewer[0], towards[1] + viewer[1], towards[2] + viewer[2]];
    let square = dot(half, half);
    let cosine = dot(normal, half) / square.sqrt();
    // 0 / 0 goes no farther.
    let cosine = if square > 0.0 { cosine } else { 0.0 };
    pow(one_at_most(positive(cosine)), shininess)
}

impl Sum {
    /// Adds ambient and diffuse light.
    #[inline(always)]
    fn add_share(share: f32, attenuation: f32, diffuse: f32, ambient: f32, colour: f32) -> f32 {
        share + attenuation * (ambient + colour * diffuse)
    }
}

impl Lights {
    /// Reads the lights of a draw from `memory`, the words of video memory. Records that do not lie in it are left out.
    #[must_use]
    pub fn read(memory: &[u32], lighting: &Lighting) -> Lights {
        let specular = levels(lighting.specular);
        let records = memory.get(lighting.lights as usize / 4..).unwrap_or_default().as_chunks::<RECORD>().0;
        let lights: Vec<Light> = records
            .iter()
            .take(lighting.count as usize)
            .map(|words| Light::new(&bytemuck::cast(*words), specular))
            .collect();
        Lights {
            glossy: lights.iter().any(|light| light.highlight != [0.0; 3]),
            lights,
            two_sided: lighting.two_sided,
            local_viewer: lighting.local_viewer,
            emission: levels(lighting.emission),
            ambient: levels(lighting.ambient).map(|level| level / 255.0),
            shininess: exponent(lighting.shininess),
        }
    }

    /// Number of lights.
    #[must_use]
    pub fn count(&self) -> usize {
        self.lights.len()
    }

    /// The colour (RGBA, R in 7:0) of a vertex or pixel of colour `colour` under the lights; alpha stays. Position and normal
    /// in eye space; the normal need not be a unit vector, zero stays zero. The specification.
    #[must_use]
    pub fn lit(&self, colour: u32, position: [f32; 3], normal: [f32; 3]) -> u32 {
        let place = self.place(position, normal);
        let mut sum = Sum::default();
        for light in &self.lights {
            let arrival = light.arrival(light.kind, place.position, place.normal);
            let shine = arrival.shine() * specular(arrival.towards, place.normal, place.viewer, self.shininess);
            for k in 0..3 {
                let (ambient, colour) = (light.ambient[k], light.colour[k]);
                sum.share[k] = Sum::add_share(sum.share[k], arrival.attenuation, arrival.diffuse, ambient, colour);
                sum.gloss[k] += shine * light.highlight[k];
            }
        }
        self.resolved(colour, &sum)
    }

    /// [`Lights::lit`] of 16 vertices or pixels at once, equal bit for bit.
    #[must_use]
    #[inline(always)]
    pub fn lit_lanes(&self, colours: &[u32; 16], position: &[[f32; 16]; 3], normal: &[[f32; 16]; 3]) -> [u32; 16] {
        let mut places = Lanes { position: *position, normal: *normal, ..Lanes::default() };
        for lane in 0..LANES {
            let place = self.place(at(position, lane), at(normal, lane));
            set(&mut places.position, lane, place.position);
            set(&mut places.normal, lane, place.normal);
            set(&mut places.viewer, lane, place.viewer);
        }
        let (mut share, mut gloss) = (Vectors::default(), Vectors::default());
        for light in &self.lights {
            // One loop for each kind, so that none asks in its lanes.
            match light.kind {
                LightType::Directional => self.gather(LightType::Directional, light, &places, &mut share, &mut gloss),
                LightType::Point => self.gather(LightType::Point, light, &places, &mut share, &mut gloss),
                LightType::Spot => self.gather(LightType::Spot, light, &places, &mut share, &mut gloss),
            }
        }
        let mut lit = [0; LANES];
        for lane in 0..LANES {
            lit[lane] = self.resolved(colours[lane], &Sum { share: at(&share, lane), gloss: at(&gloss, lane) });
        }
        lit
    }

    /// Adds one light in all lanes.
    #[inline(always)]
    fn gather(&self, kind: LightType, light: &Light, places: &Lanes, share: &mut Vectors, gloss: &mut Vectors) {
        let mut towards = Vectors::default();
        let mut shine = [0.0_f32; LANES];
        for lane in 0..LANES {
            let arrival = light.arrival(kind, at(&places.position, lane), at(&places.normal, lane));
            let (attenuation, diffuse) = (arrival.attenuation, arrival.diffuse);
            for (k, share) in share.iter_mut().enumerate() {
                share[lane] = Sum::add_share(share[lane], attenuation, diffuse, light.ambient[k], light.colour[k]);
            }
            set(&mut towards, lane, arrival.towards);
            shine[lane] = arrival.shine();
        }
        // Where no lane faces the light within its reach all highlights are +0, and adding them changes nothing.
        if !self.glossy || shine.iter().fold(0, |bits, shine| bits | shine.to_bits()) == 0 {
            return;
        }
        for lane in 0..LANES {
            let (normal, viewer) = (at(&places.normal, lane), at(&places.viewer, lane));
            let shine = shine[lane] * specular(at(&towards, lane), normal, viewer, self.shininess);
            for (k, gloss) in gloss.iter_mut().enumerate() {
                gloss[lane] += shine * light.highlight[k];
            }
        }
    }

    /// A place in the form that lights ask for.
    #[inline(always)]
    fn place(&self, position: [f32; 3], normal: [f32; 3]) -> Place {
        let [x, y, z] = position.map(coordinate);
        let unit = reach(normal.map(coordinate)).unit;
        let viewer = if self.local_viewer { reach([-x, -y, -z]).unit } else { [0.0, 0.0, 1.0] };
        let away = self.two_sided & (dot(unit, viewer) < 0.0);
        let turned = |c: f32| if away { -c } else { c };
        let normal = [turned(unit[0]), turned(unit[1]), turned(unit[2])];
        Place { position: [x, y, z], normal, viewer }
    }

    /// The colour that light makes of `colour`.
    #[inline(always)]
    fn resolved(&self, colour: u32, sum: &Sum) -> u32 {
        let mut lit = colour & 0xFF00_0000;
        for (k, surface) in levels(colour).into_iter().enumerate() {
            let level = (self.emission[k] + surface * (self.ambient[k] + sum.share[k])) + sum.gloss[k];
            let level = if level < 255.0 { level } else { 255.0 };
            lit |= whole(level + 0.5) << (8 * k as u32);
        }
        lit
    }
}

/// 16 places.
#[derive(Clone, Copy, Debug, Default)]
struct Lanes {
    position: Vectors,
    normal: Vectors,
    viewer: Vectors,
}

/// The vector of a lane.
#[inline(always)]
fn at(vectors: &Vectors, lane: usize) -> Vector {
    [vectors[0][lane], vectors[1][lane], vectors[2][lane]]
}

/// Puts the vector of a lane.
#[inline(always)]
fn set(vectors: &mut Vectors, lane: usize, vector: Vector) {
    for k in 0..3 {
        vectors[k][lane] = vector[k];
    }
}

/// Normal matrix: the inverse transpose of the upper 3x3 of OBJECT_EYE (row vectors: a normal stands before it), f64.
///
/// Zero if the 3x3 is singular or not finite. It counts as singular when its determinant is at most 2^-49 of the sum of
/// its products' magnitudes, twice what rounding can make of 0.
#[must_use]
pub fn normal_matrix(object_eye: &[f32; 16]) -> [[f64; 3]; 3] {
    let m = |row: usize, column: usize| f64::from(object_eye[4 * row + column]);
    // Products of two f32 are exact in f64. Each is the cofactor of (i, j), and the sum of its products' magnitudes.
    let cofactor = |i: usize, j: usize| {
        let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        let (plus, minus) = (m(r, c) * m(s, d), m(r, d) * m(s, c));
        (plus - minus, plus.abs() + minus.abs())
    };
    let terms: [(f64, f64); 3] = std::array::from_fn(|j| {
        let (value, magnitude) = cofactor(0, j);
        (m(0, j) * value, m(0, j).abs() * magnitude)
    });
    let determinant = (terms[0].0 + terms[1].0) + terms[2].0;
    let magnitude = (terms[0].1 + terms[1].1) + terms[2].1;
    // False for numbers that are not finite, too.
    let regular = determinant.is_finite() && determinant.abs() > magnitude * f64::from_bits((1023 - 49) << 52);
    if !regular {
        return [[0.0; 3]; 3];
    }
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(i, j).0 / determinant))
}

#[cfg(test)]
mod tests;
