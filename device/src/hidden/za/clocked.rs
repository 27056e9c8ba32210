//! The Za unit register by register: one state a clock, clocks counted by stepping.
//!
//! The published flow (JP H07-120435 B2) with what blocks of more than one row ask for: the rows of a
//! primitive that lie in one row of blocks are taken up first, each with interpolators of its own, then
//! the blocks are visited from left to right. With blocks of one row that is the published order: a
//! run, block by block.
//!
//! ```text
//!             +--> StepEdges --> LoadInterpolators --+   (triangles; rows of lines and points
//!             |        ^---- next row ----'          |    come from the line walker in no time)
//!  next row of|                                      v
//!  blocks     |   .--- next block <-------------- FetchWord ---- cleared ----> InitialisePixel --.
//!             |   |        ^    ^                    |                          ^---- next ---'  |
//!             '---'        |    |                    | initialised                               |
//!                          |    |  farther           v                                           |
//!                          |    '--------- MeasureRun / PredictRow / Predict                     |
//!                          |                         | may be seen                               |
//!                          |                         v                                           |
//!                          |                     ReadPixel <---> WritePixel                      |
//!                          |                         | last pixel                                |
//!                          '-- StoreWord <-----------+-------------------------------------------'
//! ```
//!
//! Registers: the edge walker's edges, which grow by their steps from row to row; a depth and four
//! colours for each row, which grow by dZ and their own steps from pixel to pixel and jump over the block
//! when it is bypassed (perspective-correct colours come from a divider that is given the pixel instead);
//! the word that was fetched; a running maximum that starts at 0. What is done between two clocks (choosing
//! the next block, stepping over rows that cover nothing) is wiring.
//!
//! Where there is a stencil test a pixel of the run stays a clock longer in its state: the first is the stencil value's,
//! which is compared and put back, and whose verdict the second takes.
//!
//! Must equal [`super::specification`] in pixels, depths, words and each count, clocks included.

use super::memory::put;
use super::prediction::Predictor;
use super::walk::{Run, Walker};
use super::{Surfaces, ZaCounts, ZaDraw};
use crate::geometry::assembly::Shape;
use crate::geometry::plane::DepthPlane;
use crate::hidden::stencil::{Stencilled, is_front};
use crate::hidden::z_buffer::band::StencilSetting;
use crate::hidden::z_buffer::specification::colour_plane;
use crate::shading::plane::{AffinePlane, ColourPlane, Interpolated};
use zga_abi::format::ZaPrediction;
use zga_firmware::checked::Rectangle;

/// Draws primitives, each with its number in the draw, on whole surfaces, one after another.
#[must_use]
pub fn draw<'s>(
    draw: &ZaDraw,
    shapes: impl Iterator<Item = (&'s Shape, u32)>,
    surfaces: &mut Surfaces<'_>,
) -> ZaCounts {
    let mut unit = Unit::new(draw);
    for (shape, number) in shapes {
        unit.load(shape, number);
        while unit.clock(surfaces) {}
    }
    unit.counts
}

/// What the unit does in a clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing: it waits for a primitive, and no clock is counted.
    Idle,
    /// The edges move to the next row that they cover something of.
    StepEdges,
    /// A row's interpolators take their values at its first pixel.
    LoadInterpolators,
    /// The block's word is read.
    FetchWord,
    /// The gradients are multiplied by what is covered.
    MeasureRun,
    /// The nearer end of one row of the run is found; the row's place in the table.
    PredictRow(usize),
    /// The prediction is compared with the word.
    Predict,
    /// A pixel of a cleared block is written.
    InitialisePixel,
    /// A depth is read and compared.
    ReadPixel,
    /// A pixel that is seen is written.
    WritePixel,
    /// The running maximum becomes the block's word.
    StoreWord,
}

/// The interpolators of one row of the primitive.
#[derive(Clone, Copy, Debug)]
struct Row {
    y: i32,
    /// Next column to be drawn.
    x: i32,
    /// First column beyond the row's run.
    beyond: i32,
    /// Depth at `x`; modulo 2^64.
    z: i64,
    /// Affine colours at `x`; modulo 2^32.
    colour: [i32; 4],
}

/// Colours of a primitive.
#[derive(Clone, Debug)]
enum Colours {
    /// Stepped: the plane, and its change for one pixel to the right.
    Stepped(AffinePlane, [i32; 4]),
    /// One colour, or from the divider.
    Divided(ColourPlane),
}

/// The unit.
#[derive(Clone, Debug)]
pub struct Unit<'d> {
    draw: &'d ZaDraw,
    state: State,
    /// Events so far.
    pub counts: ZaCounts,
    // The primitive.
    depths: Predictor,
    colours: Colours,
    is_triangle: bool,
    /// The side that is seen.
    front: bool,
    walker: Walker,
    /// The walker's next row.
    next: Option<Run>,
    /// Rows of the primitive in the current row of blocks, from the top without a gap.
    table: Vec<Row>,
    // The block.
    area: Rectangle,
    index: usize,
    word: i32,
    /// All pixels of the block are visited, not just the run's.
    whole: bool,
    /// The pixel visited.
    x: i32,
    y: i32,
    maximum: i32,
    /// What the stencil test has said of the pixel visited, depth test and all.
    verdict: Option<bool>,
    /// What the gradients add to the prediction at most: their negative parts along the block or run.
    slack: [i128; 2],
    /// Prediction of the rows looked at.
    nearest: i32,
}

impl<'d> Unit<'d> {
    /// A unit without a primitive.
    #[must_use]
    pub fn new(draw: &'d ZaDraw) -> Unit<'d> {
        let plane = DepthPlane::default();
        Unit {
            draw,
            state: State::Idle,
            counts: ZaCounts::default(),
            depths: Predictor { plane, steep: false, below: 0 },
            colours: Colours::Divided(ColourPlane::flat(0)),
            is_triangle: false,
            front: true,
            walker: Walker::default(),
            next: None,
            table: Vec::new(),
            area: Rectangle { x: 0, y: 0, right: 0, bottom: 0 },
            index: 0,
            word: 0,
            whole: false,
            x: 0,
            y: 0,
            maximum: 0,
            verdict: None,
            slack: [0; 2],
            nearest: 0,
        }
    }

    /// What the next clock does.
    #[must_use]
    #[cfg(test)]
    pub fn state(&self) -> State {
        self.state
    }

    /// Takes primitive `number` of the draw from set-up; the unit must be idle, or what it was at is lost.
    pub fn load(&mut self, shape: &Shape, number: u32) {
        self.depths = Predictor::new(shape, self.draw.pixels.format);
        self.colours = match colour_plane(shape, &self.draw.pixels.shade(number)) {
            ColourPlane::Interpolated(Interpolated::Affine(plane)) => {
                let (here, right) = (plane.value(0, 0), plane.value(1, 0));
                Colours::Stepped(plane, [0, 1, 2, 3].map(|k| right[k].wrapping_sub(here[k])))
            }
            plane => Colours::Divided(plane),
        };
        self.is_triangle = matches!(shape, Shape::Triangle(..));
        self.front = is_front(shape);
        self.walker = Walker::new(shape, &self.draw.pixels.scissor);
        self.next = self.walker.next();
        self.next_row_of_blocks();
    }

    /// One clock. Returns false, and counts none, if the unit was idle.
    pub fn clock(&mut self, surfaces: &mut Surfaces<'_>) -> bool {
        match self.state {
            State::Idle => return false,
            State::StepEdges => self.state = State::LoadInterpolators,
            State::LoadInterpolators => self.load_interpolators(),
            State::FetchWord => self.fetch_word(surfaces),
            State::MeasureRun => self.measure_run(),
            State::PredictRow(row) => self.predict_row(row),
            State::Predict => self.predict(),
            State::InitialisePixel => self.initialise_pixel(surfaces),
            State::ReadPixel => self.read_pixel(surfaces),
            State::WritePixel => self.write_pixel(surfaces),
            State::StoreWord => self.store_word(surfaces),
        }
        self.counts.clocks += 1;
        true
    }

    // Rows.

    /// Starts on the rows of the primitive that lie in the next row of blocks.
    fn next_row_of_blocks(&mut self) {
        self.table.clear();
        if self.next.is_none() {
            self.state = State::Idle;
        } else if self.is_triangle {
            self.state = State::StepEdges;
        } else {
            while self.next_is_in_this_row_of_blocks() {
                self.take_row();
            }
            self.next_block();
        }
    }

    fn next_is_in_this_row_of_blocks(&self) -> bool {
        let row_of_blocks = |y: i32| y as u32 / self.draw.grid.block[1];
        self.next.is_some_and(|run| self.table.first().is_none_or(|row| row_of_blocks(row.y) == row_of_blocks(run.y)))
    }

    fn load_interpolators(&mut self) {
        self.take_row();
        self.counts.spans += 1;
        if self.next_is_in_this_row_of_blocks() {
            self.state = State::StepEdges;
        } else {
            self.next_block();
        }
    }

    /// Puts the walker's row into the table, and rows that cover nothing before it.
    fn take_row(&mut self) {
        let Some(run) = self.next else {
            return;
        };
        while let Some(y) = self.table.last().map(|row| row.y + 1).filter(|y| *y < run.y) {
            self.table.push(Row { y, x: 0, beyond: 0, z: 0, colour: [0; 4] });
        }
        let colour = match &self.colours {
            Colours::Stepped(plane, _) => plane.value(run.first, run.y),
            Colours::Divided(_) => [0; 4],
        };
        let z = self.depths.plane.value(run.first, run.y);
        self.table.push(Row { y: run.y, x: run.first, beyond: run.beyond, z, colour });
        self.next = self.walker.next();
    }

    // Blocks.

    /// Goes to the next block from the left in which a row of the table has pixels to be drawn.
    fn next_block(&mut self) {
        let left = self.table.iter().filter(|row| row.x < row.beyond).map(|row| (row.x, row.y)).min();
        let Some((x, y)) = left else {
            self.next_row_of_blocks();
            return;
        };
        let [width, height] = self.draw.grid.block;
        let (column, row) = ((x as u32 / width) as usize, (y as u32 / height) as usize);
        self.area = self.draw.grid.area_at(column, row);
        self.index = row * self.draw.grid.across() + column;
        self.state = State::FetchWord;
    }

    /// First column beyond a row's run in the block.
    fn end(&self, row: &Row) -> i32 {
        row.beyond.min(self.area.right as i32)
    }

    /// Rows of the table with pixels in the block.
    fn rows(&self) -> impl Iterator<Item = &Row> {
        self.table.iter().filter(|row| row.x < self.end(row))
    }

    fn fetch_word(&mut self, surfaces: &Surfaces<'_>) {
        self.word = surfaces.words[self.index];
        if self.word < 0 {
            self.counts.initialised += 1;
            self.first_pixel(true, State::InitialisePixel);
        } else if self.draw.test().is_none() {
            self.counts.compared += 1;
            self.first_pixel(false, State::WritePixel);
        } else if self.draw.may_bypass() {
            self.start_prediction();
        } else {
            self.compare();
        }
    }

    fn compare(&mut self) {
        self.counts.compared += 1;
        self.first_pixel(self.draw.test().is_some_and(|test| test.write), State::ReadPixel);
    }

    fn store_word(&mut self, surfaces: &mut Surfaces<'_>) {
        surfaces.words[self.index] = self.maximum;
        self.counts.words_written += 1;
        self.next_block();
    }

    // Prediction.

    fn start_prediction(&mut self) {
        let [width, height] = self.draw.grid.block;
        self.set_slack([width as i32, height as i32 - 1]);
        self.nearest = i32::MAX;
        self.state = match self.draw.prediction {
            ZaPrediction::BlockLength => State::Predict,
            ZaPrediction::CoveredRun => State::MeasureRun,
            ZaPrediction::Plane => self.row_to_predict(0),
        };
    }

    fn set_slack(&mut self, length: [i32; 2]) {
        let gradient = [self.depths.plane.dx, self.depths.plane.dy];
        for axis in 0..2 {
            self.slack[axis] = (i128::from(gradient[axis]) * i128::from(length[axis])).min(0);
        }
    }

    fn measure_run(&mut self) {
        let least = |of: fn(&Row) -> i32| self.rows().map(of).min().unwrap_or(0);
        let first = [least(|row| row.x), least(|row| row.y)];
        let last_column = self.rows().map(|row| self.end(row) - 1).max().unwrap_or(0);
        let last_row = self.rows().map(|row| row.y).max().unwrap_or(0);
        self.set_slack([last_column - first[0], last_row - first[1]]);
        self.state = State::Predict;
    }

    /// The next row of the table from `row` on with pixels in the block, or the comparison.
    fn row_to_predict(&self, row: usize) -> State {
        let rows = self.table.iter().enumerate().skip(row);
        rows.filter(|(_, row)| row.x < self.end(row))
            .map(|(at, _)| State::PredictRow(at))
            .next()
            .unwrap_or(State::Predict)
    }

    fn predict_row(&mut self, at: usize) {
        let (row, plane) = (&self.table[at], &self.depths.plane);
        let steps = if plane.dx < 0 { self.end(row) - 1 - row.x } else { 0 };
        let z = row.z.wrapping_add(i64::from(steps).wrapping_mul(plane.dx));
        self.nearest = self.nearest.min(plane.stored(z, self.depths.below));
        self.state = self.row_to_predict(at + 1);
    }

    fn predict(&mut self) {
        let plane = &self.depths.plane;
        let predicted = if self.depths.steep {
            plane.minimum
        } else if self.draw.prediction == ZaPrediction::Plane {
            self.nearest
        } else {
            self.corner()
        };
        if predicted > self.word {
            self.bypass();
        } else {
            self.compare();
        }
    }

    /// Prediction from the corner of what is covered: the first row's depth, taken back to the least column.
    fn corner(&self) -> i32 {
        let plane = &self.depths.plane;
        let column = self.rows().map(|row| row.x).min().unwrap_or(0);
        let (z, back) = self.rows().next().map_or((0, 0), |row| (row.z, row.x - column));
        let least = i128::from(z) - i128::from(back) * i128::from(plane.dx) + self.slack[0] + self.slack[1];
        (least >> self.depths.below).clamp(i128::from(plane.minimum), i128::from(plane.maximum)) as i32
    }

    /// The interpolators of all rows jump to the next block.
    fn bypass(&mut self) {
        let right = self.area.right as i32;
        let (mut table, mut pixels) = (std::mem::take(&mut self.table), 0);
        for row in &mut table {
            let steps = (row.beyond.min(right) - row.x).max(0);
            self.step(row, steps);
            pixels += steps as u64;
        }
        self.table = table;
        self.counts.bypassed += 1;
        self.counts.pixels_bypassed += pixels;
        self.next_block();
    }

    /// Moves a row's interpolators on.
    fn step(&self, row: &mut Row, steps: i32) {
        row.x += steps;
        row.z = row.z.wrapping_add(i64::from(steps).wrapping_mul(self.depths.plane.dx));
        if let Colours::Stepped(_, dx) = &self.colours {
            for (colour, dx) in row.colour.iter_mut().zip(dx) {
                *colour = colour.wrapping_add(steps.wrapping_mul(*dx));
            }
        }
    }

    // Pixels.

    /// Starts on the pixels of the block.
    fn first_pixel(&mut self, whole: bool, state: State) {
        self.whole = whole;
        self.maximum = 0;
        self.state = state;
        (self.x, self.y) = (self.area.x as i32, self.area.y as i32);
        if !whole {
            self.seek_run();
        }
    }

    /// Goes to the next pixel of the run; returns whether there is one.
    fn seek_run(&mut self) -> bool {
        let place = self.rows().map(|row| (row.x, row.y)).find(|(_, y)| *y >= self.y);
        place.map(|place| (self.x, self.y) = place).is_some()
    }

    /// Goes to the next pixel to be visited, in `state`; after the last one to the next block.
    fn next_pixel(&mut self, state: State) {
        self.state = state;
        if !self.whole {
            if !self.seek_run() {
                self.next_block();
            }
            return;
        }
        self.x += 1;
        if self.x == self.area.right as i32 {
            (self.x, self.y) = (self.area.x as i32, self.y + 1);
            if self.y == self.area.bottom as i32 {
                self.state = State::StoreWord;
            }
        }
    }

    /// The row of the table whose next pixel is the one visited; `None` outside the run.
    fn row_here(&self) -> Option<usize> {
        let at = usize::try_from(self.y - self.table.first()?.y).ok()?;
        let row = self.table.get(at)?;
        (row.x == self.x && row.x < row.beyond).then_some(at)
    }

    /// Depth of the pixel visited, as stored.
    fn depth(&self, row: usize) -> i32 {
        self.depths.plane.stored(self.table[row].z, self.depths.below)
    }

    /// Writes the run's colour to the pixel visited.
    fn write_colour(&mut self, row: usize, surfaces: &mut Surfaces<'_>) {
        let colour = match &self.colours {
            Colours::Stepped(plane, _) => plane.colour(self.table[row].colour),
            Colours::Divided(plane) => plane.colour(self.x, self.y),
        };
        self.put(self.draw.pixels.pixel_format.encode(colour.to_le_bytes()), surfaces);
    }

    /// Whether the pixel visited is a hole of the texture.
    fn is_hole(&self) -> bool {
        matches!(&self.colours, Colours::Divided(plane) if plane.is_hole(self.x, self.y))
    }

    /// Counts a fragment, if there is one, that a texel is looked up for.
    fn count_fragment(&mut self, row: Option<usize>) {
        if row.is_some() && self.draw.pixels.has_holes() {
            self.counts.fragments += 1;
            self.counts.holes += u64::from(self.is_hole());
        }
    }

    fn put(&mut self, pixel: u32, surfaces: &mut Surfaces<'_>) {
        let pixels = &self.draw.pixels;
        put(surfaces.colour, pixels.pixel_format, pixels.colour_pitch, self.x as usize, self.y as usize, pixel);
        self.counts.colour_writes += 1;
    }

    /// Place in the Z buffer of the pixel visited.
    fn place(&self) -> usize {
        self.y as usize * self.draw.pixels.depth_pitch + self.x as usize
    }

    /// Moves the interpolators of table row `row` to the next pixel.
    fn step_one(&mut self, row: usize) {
        let mut registers = self.table[row];
        self.step(&mut registers, 1);
        self.table[row] = registers;
    }

    /// The stencil value's clock, before the pixel's own; returns whether this one was it.
    fn test_stencil(&mut self, row: Option<usize>, stored: i32, surfaces: &mut Surfaces<'_>) -> bool {
        let (Some(&StencilSetting { rule, pitch }), Some(row)) = (self.draw.pixels.stencil.as_deref(), row) else {
            return false;
        };
        if self.verdict.is_some() || self.is_hole() {
            return false;
        }
        let z = self.depth(row);
        let passes = || self.draw.test().is_none_or(|test| test.passes(z, stored));
        let value = &mut surfaces.stencil[self.y as usize * pitch + self.x as usize];
        let stencilled = Stencilled { rule, front: self.front };
        self.verdict = Some(stencilled.decide(value, &mut self.counts.stencil, passes));
        true
    }

    /// Whether the run's pixel, in table row `row`, passes against `stored`. Takes the stencil test's verdict, where there
    /// is one.
    fn passes(&mut self, row: usize, stored: i32) -> bool {
        let verdict = self.verdict.take();
        let depth = || self.draw.test().is_none_or(|test| test.passes(self.depth(row), stored));
        !self.is_hole() && verdict.unwrap_or_else(depth)
    }

    fn initialise_pixel(&mut self, surfaces: &mut Surfaces<'_>) {
        let background = self.draw.background;
        let mut depth = background.depth;
        let row = self.row_here();
        if self.test_stencil(row, depth, surfaces) {
            return;
        }
        self.count_fragment(row);
        let passing = row.filter(|&row| self.passes(row, depth));
        if let Some(row) = passing.filter(|_| self.draw.test().is_some_and(|test| test.write)) {
            depth = self.depth(row);
        }
        self.counts.passed += u64::from(passing.is_some());
        match passing.filter(|_| self.draw.pixels.draws_colours()) {
            Some(row) => self.write_colour(row, surfaces),
            None => self.put(background.pixel, surfaces),
        }
        if self.draw.depth_buffer {
            surfaces.depth[self.place()] = depth;
            self.counts.depth_writes += 1;
        } else {
            depth = self.draw.pixels.format.maximum() as i32;
        }
        self.maximum = self.maximum.max(depth);
        if let Some(row) = row {
            self.step_one(row);
        }
        self.next_pixel(State::InitialisePixel);
    }

    fn read_pixel(&mut self, surfaces: &mut Surfaces<'_>) {
        let stored = surfaces.depth[self.place()];
        let row = self.row_here();
        if self.test_stencil(row, stored, surfaces) {
            return;
        }
        self.counts.reads += 1;
        self.count_fragment(row);
        if let Some(row) = row {
            if self.passes(row, stored) {
                self.counts.passed += 1;
                if self.draw.pixels.draws_colours() || self.draw.test().is_some_and(|test| test.write) {
                    self.state = State::WritePixel;
                    return;
                }
            }
            self.step_one(row);
        }
        self.maximum = self.maximum.max(stored);
        self.next_pixel(State::ReadPixel);
    }

    fn write_pixel(&mut self, surfaces: &mut Surfaces<'_>) {
        let test = self.draw.test();
        // The run's pixels only come here.
        let row = self.row_here();
        // With a depth test the pixel has passed already.
        let mut passed = true;
        if test.is_none() {
            if self.test_stencil(row, 0, surfaces) {
                return;
            }
            self.count_fragment(row);
            passed = row.is_some_and(|row| self.passes(row, 0));
            self.counts.passed += u64::from(passed);
        }
        if let Some(row) = row {
            if passed && self.draw.pixels.draws_colours() {
                self.write_colour(row, surfaces);
            }
            if test.is_some_and(|test| test.write) {
                let z = self.depth(row);
                surfaces.depth[self.place()] = z;
                self.counts.depth_writes += 1;
                self.maximum = self.maximum.max(z);
            }
            self.step_one(row);
        }
        self.next_pixel(if test.is_some() { State::ReadPixel } else { State::WritePixel });
    }
}
