//! [`Supersampled::draw`](super::Supersampled::draw), faster than by definition: the coverage of each sample is that of a
//! pixel's centre at another place, so the samples of a row that a triangle covers are one exact run for each position,
//! with depths that are equal steps along it. Bands of rows go to threads.

use std::ops::Range;

use super::super::bands::{self, ROWS};
use super::super::depth::{Along, PrescribedDepth};
use super::super::raster::{Outline, Rows};
use super::super::{DepthFormat, Primitive, Vertex};
use super::{Brush, Fragment, Pixel, faces};

/// A primitive, or a triangle of it, set up.
struct Piece {
    shape: Shape,
    rows: Range<u32>,
    plane: PrescribedDepth,
    colour: [u8; 4],
}

enum Shape {
    /// Sample by sample; which columns it can touch.
    Face(Outline, Range<u32>),
    /// All samples of a pixel or none.
    Whole(Rows),
}

const CENTRE: [u32; 2] = [128, 128];

/// What a band needs to know.
pub(super) struct Target<'a> {
    pub(super) size: [u32; 2],
    pub(super) format: DepthFormat,
    pub(super) positions: &'a [[u32; 2]],
}

impl Target<'_> {
    pub(super) fn draw(&self, pixels: &mut [Pixel], primitives: &[Primitive], brush: &Brush) {
        if pixels.is_empty() {
            return;
        }
        let pieces: Vec<Piece> = primitives.iter().flat_map(|primitive| self.pieces(primitive, brush)).collect();
        let bins = bands::bins(self.size[1], pieces.iter().map(|piece| piece.rows.clone()));
        let work = pieces.iter().map(|piece| piece.work() * self.positions.len() as u64).sum();
        let chunks = (0..).zip(pixels.chunks_mut((ROWS * self.size[0]) as usize)).zip(bins);
        bands::each(chunks, work, |((band, pixels), bin): ((u32, &mut [Pixel]), Vec<u32>)| {
            for piece in bin.into_iter().map(|index| &pieces[index as usize]) {
                for (j, row) in (band * ROWS..).zip(pixels.chunks_mut(self.size[0] as usize)) {
                    self.row(piece, j, row, brush);
                }
            }
        });
    }

    fn pieces(&self, primitive: &Primitive, brush: &Brush) -> Vec<Piece> {
        let [width, height] = self.size;
        let colour = primitive.vertices()[0].colour;
        let [left, top, right, bottom] = brush.test.scissor;
        let plane = |primitive: &Primitive| PrescribedDepth::new(primitive, self.format);
        let limit = |rows: Range<u32>| rows.start.max(top)..rows.end.min(bottom);
        if !brush.anti_alias {
            let rows = Rows::new(primitive, width, height);
            let piece = |plane| Piece { rows: limit(rows.rows()), shape: Shape::Whole(rows), plane, colour };
            return plane(primitive).map(piece).into_iter().collect();
        }
        let face = |face: [Vertex; 3]| {
            let outline = Outline::new(&face)?;
            let [columns, rows] =
                [(face.map(|v| v.x), width), (face.map(|v| v.y), height)].map(|(at, size)| touched(at, size));
            let columns = columns.start.max(left)..columns.end.min(right);
            let plane = plane(&Primitive::Triangle(face))?;
            Some(Piece { rows: limit(rows), shape: Shape::Face(outline, columns), plane, colour })
        };
        faces(primitive, brush.line_width, brush.point_size).into_iter().filter_map(face).collect()
    }

    fn row(&self, piece: &Piece, j: u32, pixels: &mut [Pixel], brush: &Brush) {
        if !piece.rows.contains(&j) {
            return;
        }
        let mut fragment = Fragment { depths: vec![None; self.positions.len()], centre: None };
        match &piece.shape {
            Shape::Face(outline, columns) => {
                let along = |&at: &[u32; 2]| {
                    let run = outline.run(j, at, columns);
                    (run.clone(), piece.plane.along_at(run, j, at))
                };
                let samples: Vec<(Range<u32>, Along)> = self.positions.iter().map(along).collect();
                let centre = along(&CENTRE);
                let depth = |(run, along): &(Range<u32>, Along), i| run.contains(&i).then(|| along.at(i - run.start));
                let runs = || samples.iter().chain([&centre]).map(|(run, _)| run).filter(|run| !run.is_empty());
                let touched = runs().map(|run| run.start).min()..runs().map(|run| run.end).max();
                for i in touched.start.unwrap_or(0)..touched.end.unwrap_or(0) {
                    for (place, sample) in fragment.depths.iter_mut().zip(&samples) {
                        *place = depth(sample, i);
                    }
                    fragment.centre = depth(&centre, i);
                    pixels[i as usize].take(&fragment, piece.colour, brush);
                }
            }
            Shape::Whole(rows) => {
                let [left, _, right, _] = brush.test.scissor;
                rows.for_each_run(j, |run| {
                    for i in run.start.max(left)..run.end.min(right) {
                        let depth = Some(piece.plane.stored(i as i32, j as i32));
                        fragment.depths.fill(depth);
                        fragment.centre = depth;
                        pixels[i as usize].take(&fragment, piece.colour, brush);
                    }
                });
            }
        }
    }
}

impl Piece {
    /// Pixels, at most.
    fn work(&self) -> u64 {
        match &self.shape {
            Shape::Face(_, columns) => self.rows.len() as u64 * columns.len() as u64,
            Shape::Whole(rows) => rows.work(),
        }
    }
}

/// The pixels of one axis whose squares a triangle can touch.
fn touched(coordinates: [i32; 3], size: u32) -> Range<u32> {
    let clip = |pixel: i32| pixel.clamp(0, size as i32) as u32;
    let least = coordinates.into_iter().fold(i32::MAX, i32::min).div_euclid(256);
    let greatest = coordinates.into_iter().fold(i32::MIN, i32::max).div_euclid(256);
    clip(least)..clip(greatest + 1)
}
