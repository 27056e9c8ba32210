//! A piece: an item of the scene set up for one band of lines.
//!
//! Duties: the edges that masks come from, walked from sample row to sample row; bounds of the depths in a pixel; the
//! depth at a sample; colours. Inputs from: [`super::scene`]. Outputs to: [`super::band`], [`super::specification`],
//! [`super::pixel`].

use super::Setting;
use super::grid::Offset;
use super::scene::{Item, ItemDraw, Kind, Rule};
use crate::geometry::line::Line;
use crate::geometry::plane::{DepthPlane, WidePlane, below};
use crate::geometry::triangle::{Triangle, doubled_area};
use crate::geometry::{CENTRE, PIXEL, ScreenVertex};
use crate::hidden::z_buffer::specification::covers_place;
use crate::shading::plane::{ColourPlane, ColourSource, Interpolation, Shade};
use zga_abi::format::SubpixelDepth;

/// What a piece covers.
#[derive(Clone, Copy, Debug)]
pub enum Cover {
    /// The samples inside edges, walked on rows of samples; `None` if no row or no column of samples meets them. A
    /// triangle that covers a pixel's centre and none of its samples is a fragment too: the path has drawn it there.
    Samples(Option<Triangle>),
    /// Pixels whose centres are inside edges, on rows of pixels.
    Centres(Triangle),
    /// The pixels of a line.
    Line(Line),
    /// A pixel.
    Pixel([i32; 2]),
    /// All pixels of the scissor.
    All,
    /// Nothing in this band.
    Nothing,
}

/// How depths inside a pixel follow from its centre's.
#[derive(Clone, Debug, PartialEq)]
enum Slope {
    /// They are the centre's.
    Level,
    /// In 64 bits.
    Fine,
    /// At samples in 128 bits; bounds fit in 64.
    Steep,
    /// Not even bounds fit in 64 bits: they are those of the vertices.
    Wild(Box<WidePlane>),
}

/// Depths at the samples of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// Value at the centre.
    pub(super) value: i64,
    /// Change for 1/16 pixel to the right and down.
    pub(super) gradient: [i64; 2],
    /// Bits of a value below its point.
    pub(super) below: u32,
    /// Least and greatest depth.
    pub(super) limits: [i32; 2],
}

impl Sampled {
    /// One depth at all samples.
    #[must_use]
    pub const fn level(depth: i32) -> Sampled {
        Sampled { value: depth as i64, gradient: [0; 2], below: 0, limits: [depth; 2] }
    }

    /// Depth at a sample.
    #[must_use]
    #[inline(always)]
    pub fn depth(&self, offset: Offset) -> i32 {
        let there = self.value + i64::from(offset.x) * self.gradient[0] + i64::from(offset.y) * self.gradient[1];
        (there >> self.below).clamp(i64::from(self.limits[0]), i64::from(self.limits[1])) as i32
    }
}

/// An item set up for a band.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Place in the scene.
    pub item: u32,
    /// Place of its draw.
    pub draw: u32,
    /// Its item's number in what the colours of the draw go through.
    pub number: u32,
    /// It may be translucent or have holes somewhere: it hides nothing.
    pub layer: bool,
    /// The path draws it too.
    pub drawn: bool,
    /// The one colour that it has all over; RGBA, R in 7:0. `None` where its colour may change.
    pub plain: Option<u32>,
    /// Its item's kind.
    pub kind: Kind,
    /// Depth.
    pub plane: DepthPlane,
    /// From the centre of a pixel to the farthest of its samples, in the plane's values.
    pub reach: i64,
    slope: Slope,
    below: u32,
    /// Where its colours come from.
    pub source: ColourSource,
}

/// A gradient below this share of 64 bits leaves room for 1/16 pixels; [`Piece::depth`].
const FINE: f64 = (1_u64 << 56) as f64;
/// A gradient below this leaves room for the bounds of a pixel that is not covered at its centre.
const BOUNDED: f64 = (1_u64 << 58) as f64;

impl Piece {
    /// Sets an item up for the band that begins with row `top`.
    #[must_use]
    #[inline(always)]
    pub fn new(setting: &Setting, number: u32, item: &Item, draw: &ItemDraw, top: i32) -> (Piece, Cover) {
        let v = &item.vertices;
        let below = below(setting.format);
        let mut piece = Piece {
            item: number,
            draw: item.draw,
            number: item.number,
            layer: !draw.is_opaque(v) || draw.has_holes(),
            drawn: draw.is_opaque(v),
            plain: plain(v, draw),
            kind: item.kind,
            plane: DepthPlane::default(),
            reach: 0,
            slope: Slope::Level,
            below,
            source: ColourSource::new(v),
        };
        if draw.is_nothing(v) {
            return (piece, Cover::Nothing);
        }
        let mut cover = Cover::Nothing;
        match item.kind {
            Kind::Masked => cover = piece.set_up(setting, item, draw, top),
            Kind::Triangle => {
                if let Some((triangle, _)) = Triangle::new(v, setting.format) {
                    (cover, piece.plane) = (Cover::Centres(triangle), triangle.plane);
                }
            }
            Kind::Line => {
                if let Some(line) = Line::new(&[v[0], v[1]], setting.format) {
                    (cover, piece.plane) = (Cover::Line(line), line.plane);
                }
            }
            Kind::Point => {
                cover = Cover::Pixel([v[0].x >> 8, v[0].y >> 8]);
                piece.plane = DepthPlane::flat(&v[0], setting.format);
            }
            Kind::Clear => cover = Cover::All,
        }
        if setting.rule == Rule::Last && item.kind != Kind::Clear {
            // What stands for its depth: the later, the nearer.
            let place = -(number as i32);
            let reference = i64::from(place) << below;
            (piece.plane, piece.reach, piece.slope) =
                (DepthPlane { reference, minimum: place, maximum: place, ..DepthPlane::default() }, 0, Slope::Level);
        }
        (piece, cover)
    }

    /// Edges on the grid of samples, and depth.
    #[inline(always)]
    fn set_up(&mut self, setting: &Setting, item: &Item, draw: &ItemDraw, top: i32) -> Cover {
        let v = &item.vertices;
        let area = doubled_area(&v[0], &v[1], &v[2]);
        if area == 0 {
            return Cover::Nothing;
        }
        let [samples] = Triangle::outlines(v, [(setting.pitch, top * setting.grid.rows() as i32)]);
        let cover = Cover::Samples(samples);
        if draw.test.is_none() {
            return cover;
        }
        let inverse = 1.0 / area as f64;
        let (plane, steep) = DepthPlane::triangle(v, area, inverse, setting.format);
        self.plane = plane;
        let mut slope = Slope::Fine;
        if steep {
            // The gradients themselves may have wrapped: as f64 they have not.
            let scale = inverse.abs() * f64::from(PIXEL) * (1_u64 << self.below) as f64;
            let along = |c: [i32; 3]| {
                let (c1, c2) = (i64::from(c[1]) - i64::from(c[0]), i64::from(c[2]) - i64::from(c[0]));
                let (z1, z2) = (i64::from(v[1].z) - i64::from(v[0].z), i64::from(v[2].z) - i64::from(v[0].z));
                (z1 * c2 - z2 * c1).unsigned_abs() as f64 * scale
            };
            let gradient = along(v.map(|v| v.x)).max(along(v.map(|v| v.y)));
            slope = match gradient {
                fine if fine < FINE => Slope::Fine,
                steep if steep < BOUNDED => Slope::Steep,
                _ => Slope::Wild(Box::new(WidePlane::triangle(v, setting.format))),
            };
        }
        if setting.depth == SubpixelDepth::Centre {
            // One depth a fragment; only where its centre is not covered it matters that the plane is wild.
            self.slope = if matches!(slope, Slope::Wild(_)) { slope } else { Slope::Level };
            return cover;
        }
        if !matches!(slope, Slope::Wild(_)) {
            let corner = setting.grid.corner_offset();
            self.reach = ((plane.dx.abs() * i64::from(corner.x) + plane.dy.abs() * i64::from(corner.y)) >> 4) + 1;
        }
        self.slope = slope;
        cover
    }

    /// Least and greatest depth of any sample of pixel (`x`, `y`), covered or not; of a piece that covers the whole
    /// pixel exactly those, but for one step that rounding may add.
    #[must_use]
    #[inline(always)]
    pub fn bounds(&self, x: i32, y: i32) -> [i32; 2] {
        if let Slope::Wild(_) = self.slope {
            return [self.plane.minimum, self.plane.maximum];
        }
        let value = self.plane.value(x, y);
        [self.plane.stored(value - self.reach, self.below), self.plane.stored(value + self.reach, self.below)]
    }

    /// Values that bound the depths of pixel (0, 0), modulo 2^64: what [`Piece::bounds`] shifts and clamps; and their
    /// change for one pixel to the right and down.
    #[must_use]
    #[inline(always)]
    pub fn values(&self) -> ([i64; 2], [i64; 2]) {
        if let Slope::Wild(_) = self.slope {
            return ([self.plane.minimum, self.plane.maximum].map(|z| i64::from(z) << self.below), [0; 2]);
        }
        let value = self.plane.value(0, 0);
        ([value.wrapping_sub(self.reach), value.wrapping_add(self.reach)], [self.plane.dx, self.plane.dy])
    }

    /// All samples of a pixel have one depth.
    #[must_use]
    pub fn is_level(&self, setting: &Setting) -> bool {
        matches!(self.slope, Slope::Level) || setting.depth == SubpixelDepth::Centre
    }

    /// Depth at a sample of pixel (`x`, `y`).
    #[must_use]
    #[inline(always)]
    pub fn depth(&self, setting: &Setting, x: i32, y: i32, offset: Offset) -> i32 {
        let offset = if setting.depth == SubpixelDepth::Centre { Offset::default() } else { offset };
        match &self.slope {
            Slope::Level => self.plane.stored(self.plane.value(x, y), self.below),
            Slope::Fine => {
                let value = self.plane.value(x, y);
                let there = 16 * value + i64::from(offset.x) * self.plane.dx + i64::from(offset.y) * self.plane.dy;
                self.plane.stored(there, self.below + 4)
            }
            Slope::Steep => {
                let along = |gradient: i64, offset: i32| i128::from(gradient) * i128::from(offset);
                let aside = along(self.plane.dx, offset.x) + along(self.plane.dy, offset.y);
                let depth = (16 * i128::from(self.plane.value(x, y)) + aside) >> (self.below + 4);
                depth.clamp(i128::from(self.plane.minimum), i128::from(self.plane.maximum)) as i32
            }
            Slope::Wild(wide) => wide.stored(x, y, [offset.x, offset.y]),
        }
    }

    /// Depths at the samples of pixel (`x`, `y`), where they can be said in 64 bits.
    #[must_use]
    #[inline(always)]
    pub fn sampled(&self, setting: &Setting, x: i32, y: i32) -> Option<Sampled> {
        let plane = &self.plane;
        let level = self.is_level(setting);
        if !level && !matches!(self.slope, Slope::Fine) {
            return None;
        }
        let value = plane.value(x, y);
        let limits = [plane.minimum, plane.maximum];
        Some(match level {
            true => Sampled { value, gradient: [0; 2], below: self.below, limits },
            false => Sampled { value: 16 * value, gradient: [plane.dx, plane.dy], below: self.below + 4, limits },
        })
    }

    /// Whether a piece has the depths of another wherever both are.
    #[must_use]
    #[inline(always)]
    pub fn lies_in(&self, other: &Piece) -> bool {
        self.plane == other.plane && self.slope == other.slope
    }

    /// Whether a piece has greater depths than another at all samples of pixel (`x`, `y`), by a step at least, and the
    /// limits of neither matter there. False where it cannot be said in 64 bits.
    #[must_use]
    pub fn lies_behind(&self, other: &Piece, setting: &Setting, x: i32, y: i32) -> bool {
        let fine = |piece: &Piece| matches!(piece.slope, Slope::Fine | Slope::Level);
        let free = |piece: &Piece| {
            let bounds = piece.bounds(x, y);
            bounds[0] > piece.plane.minimum && bounds[1] < piece.plane.maximum
        };
        if !fine(self) || !fine(other) || !free(self) || !free(other) {
            return false;
        }
        let corner = setting.grid.corner_offset();
        // What has one depth a pixel may have gradients that mean nothing.
        let gradient = |piece: &Piece| {
            let level = matches!(piece.slope, Slope::Level);
            if level { [0; 2] } else { [piece.plane.dx, piece.plane.dy] }
        };
        let (mine, others) = (gradient(self), gradient(other));
        let slant = |c: usize, offset: i32| (mine[c] - others[c]).abs() * i64::from(offset);
        let reach = (slant(0, corner.x) + slant(1, corner.y)) / 16 + 1;
        self.plane.value(x, y) - other.plane.value(x, y) > reach + (1 << self.below)
    }

    /// Signs of dz/dx and dz/dy, for the search.
    #[must_use]
    pub fn slopes(&self) -> [i64; 2] {
        match &self.slope {
            Slope::Wild(wide) => wide.signs(),
            Slope::Level | Slope::Fine | Slope::Steep => [self.plane.dx, self.plane.dy],
        }
    }

    /// The plane that colours at pixel centres come from.
    #[must_use]
    pub fn colours(&self, shade: &Shade<'_>) -> ColourPlane {
        let plane = match self.kind {
            Kind::Line | Kind::Point => ColourPlane::line(&self.source, shade.interpolation),
            _ => ColourPlane::triangle(&self.source, shade.interpolation),
        };
        plane.shaded(self.source.first_place(), shade)
    }

    /// Samples of pixel (`x`, `y`) that a triangle drawn with masks covers, by edge functions and the top-left rule:
    /// the specification.
    #[must_use]
    pub fn mask_by_edges(&self, setting: &Setting, item: &Item, x: i32, y: i32) -> u64 {
        let covers = |sample: u32| {
            let [u, w] = setting.grid.position(sample);
            covers_place(&item.vertices, i64::from(x * PIXEL + u), i64::from(y * PIXEL + w))
        };
        (0..setting.grid.samples()).filter(|&sample| covers(sample)).map(|sample| setting.grid.sample_bit(sample)).sum()
    }
}

/// The one colour of a primitive that has one, wherever it is shaded.
#[inline(always)]
pub(super) fn plain(v: &[ScreenVertex; 3], draw: &ItemDraw) -> Option<u32> {
    let [a, b, c] = [v[0].colour, v[1].colour, v[2].colour];
    let one = draw.interpolation == Interpolation::Flat || (a == b && a == c);
    (one && draw.shading.is_none()).then_some(a)
}

/// Rows and columns that an item can touch, `[[first x, first y], [beyond x, beyond y]]`, cut to its scissor.
#[must_use]
pub fn extent(item: &Item, draw: &ItemDraw) -> [[i32; 2]; 2] {
    let area = &draw.scissor;
    let [low, high] = [[area.x, area.y], [area.right, area.bottom]].map(|corner| corner.map(|c| c as i32));
    if item.kind == Kind::Clear {
        return [low, high];
    }
    // A line may draw a pixel whose centre lies a little beyond its end.
    let spare = if item.kind == Kind::Line { CENTRE } else { 0 };
    let v = &item.vertices;
    let [x, y] = [[v[0].x, v[1].x, v[2].x], [v[0].y, v[1].y, v[2].y]];
    let least = |c: [i32; 3]| (c[0].min(c[1]).min(c[2]) - spare) >> 8;
    let greatest = |c: [i32; 3]| ((c[0].max(c[1]).max(c[2]) + spare) >> 8) + 1;
    [[least(x).max(low[0]), least(y).max(low[1])], [greatest(x).min(high[0]), greatest(y).min(high[1])]]
}
