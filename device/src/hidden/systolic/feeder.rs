//! The feeder: the scene's primitives cut by one scan line after another.
//!
//! Duties: for each line, in order of submission, one token for each primitive that covers a pixel of it inside
//! its scissor, and one for each clear that touches it. Inputs: a scene that was held back. Outputs: tokens.
//! The clocks are those the array needs to take them.
//!
//! Primitives wait in buckets by their first row; those that have begun and not ended are in the active list.
//! So memory is two words a primitive and the tokens of one line, whatever the scene.
//!
//! A segment that begins left of its scissor (or of element 0) is cut there: X is the first pixel inside, Z the
//! plane's value at it in closed form, which is what counting would have given.

use super::token::{Luminance, Token};
use crate::geometry::assembly::Shape;
use crate::geometry::line::Line;
use crate::geometry::plane::{Axis, DepthPlane, below};
use crate::hidden::held::{Held, HeldDraw, Item};
use crate::hidden::stencil::StencilRule;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::specification::colour_plane;
use crate::shading::pixel::{PixelShading, ShadingCounts};
use crate::shading::plane::ColourPlane;
use std::ops::Range;
use zga_abi::format::{DepthFormat, TokenColour};
use zga_firmware::checked::{Rectangle, Target};

/// A scene on its way into the array.
#[derive(Debug)]
pub struct Feeder<'a> {
    held: &'a Held,
    format: DepthFormat,
    colour: TokenColour,
    height: u32,
    /// Items by their first row, in order of submission; a row's end where the next one's begin.
    waiting: Vec<u32>,
    starts: Vec<u32>,
    /// Items that have begun, in order of submission, and the first row beyond each.
    active: Vec<(u32, u32)>,
    /// Where the active list of the next line is put together.
    merged: Vec<(u32, u32)>,
    tokens: Vec<Token>,
    /// Tokens of triangles so far.
    pub spans: u64,
    /// What looking for holes has cost.
    pub shading: ShadingCounts,
}

impl<'a> Feeder<'a> {
    /// Puts the items of a scene into their buckets.
    #[must_use]
    pub fn new(held: &'a Held, target: &Target) -> Feeder<'a> {
        let height = target.colour.height;
        let mut starts = vec![0; height as usize + 1];
        for item in &held.items {
            let rows = rows(item, &held.draws);
            if !rows.is_empty() {
                starts[rows.start as usize + 1] += 1;
            }
        }
        for row in 0..height as usize {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut waiting = vec![0; starts[height as usize] as usize];
        for (number, item) in held.items.iter().enumerate() {
            let rows = rows(item, &held.draws);
            if !rows.is_empty() {
                let place = &mut next[rows.start as usize];
                waiting[*place as usize] = number as u32;
                *place += 1;
            }
        }
        Feeder {
            held,
            format: target.depth_format,
            colour: target.systolic.colour,
            height,
            waiting,
            starts,
            active: Vec::new(),
            merged: Vec::new(),
            tokens: Vec::new(),
            spans: 0,
            shading: ShadingCounts::default(),
        }
    }

    /// The tokens of line `y`. Lines are asked for one after another, from 0 on.
    pub fn line(&mut self, y: u32) -> &[Token] {
        self.tokens.clear();
        if y >= self.height {
            return &self.tokens;
        }
        self.activate(y);
        for &(number, _) in &self.active {
            let item = &self.held.items[number as usize];
            if let Some(token) = self.token(item, number, y) {
                self.spans += u64::from(matches!(item, Item::Primitive(Shape::Triangle(..), _)));
                match holes(self.held, item) {
                    None => self.tokens.push(token),
                    Some((colours, shading)) => {
                        let before = self.tokens.len();
                        cut(&token, y, &colours, &mut self.tokens);
                        let pixels = |token: &Token| u64::from(token.more) + 1;
                        let solid: u64 = self.tokens[before..].iter().map(pixels).sum();
                        let looked_up = shading.looked_up(pixels(&token), pixels(&token) - solid);
                        self.shading = self.shading.plus(looked_up);
                    }
                }
            }
        }
        &self.tokens
    }

    /// Brings the active list to line `y`.
    fn activate(&mut self, y: u32) {
        self.merged.clear();
        let begun = self.starts[y as usize] as usize..self.starts[y as usize + 1] as usize;
        let mut begun = self.waiting[begun].iter().copied().peekable();
        for &(number, end) in self.active.iter().filter(|(_, end)| *end > y) {
            while let Some(earlier) = begun.next_if(|&new| new < number) {
                self.merged.push((earlier, rows(&self.held.items[earlier as usize], &self.held.draws).end));
            }
            self.merged.push((number, end));
        }
        for number in begun {
            self.merged.push((number, rows(&self.held.items[number as usize], &self.held.draws).end));
        }
        std::mem::swap(&mut self.active, &mut self.merged);
    }

    /// The token of an item on line `y`, if it covers anything there.
    fn token(&self, item: &Item, number: u32, y: u32) -> Option<Token> {
        match item {
            Item::Clear { area, colour, depth, stencil } => {
                let depth = depth.unwrap_or(0);
                let plane = DepthPlane {
                    reference: i64::from(depth) << below(self.format),
                    minimum: depth,
                    maximum: depth,
                    ..DepthPlane::default()
                };
                let luminance = colour.map(|colour| match self.colour {
                    TokenColour::Tag => Luminance::Tag(number + 1),
                    TokenColour::Value => Luminance::Value(colour),
                });
                let test = match item {
                    Item::Clear { depth: Some(_), .. } => DepthTest { write: true, ..DepthTest::ALWAYS },
                    _ => DepthTest::ALWAYS,
                };
                let token = segment([area.x as i32, area.right as i32], area, y, &plane, test, luminance)?;
                Some(Token { stencil: stencil.map_or(StencilRule::Keep, StencilRule::Store), ..token })
            }
            Item::Primitive(shape, draw) => {
                let draw = &self.held.draws[*draw as usize];
                let luminance = match self.colour {
                    TokenColour::Value if !draw.is_shaded() => Luminance::Value(first_colour(shape)),
                    _ => Luminance::Tag(number + 1),
                };
                let test = draw.test.unwrap_or(DepthTest::ALWAYS);
                let columns = columns(shape, &draw.scissor, y as i32);
                let luminance = draw.draws_colours().then_some(luminance);
                let token = segment(columns, &draw.scissor, y, &shape.plane(self.format), test, luminance)?;
                Some(Token { stencil: draw.stencil_rule(shape), ..token })
            }
        }
    }
}

/// What knows the holes of an item's texture, and its shading; `None` if it has none.
fn holes<'h>(held: &'h Held, item: &Item) -> Option<(ColourPlane, &'h PixelShading)> {
    let Item::Primitive(shape, draw) = item else {
        return None;
    };
    let draw = &held.draws[*draw as usize];
    let shading = draw.shading.as_ref().filter(|shading| shading.pixel.punch_through().is_some())?;
    Some((colour_plane(shape, &draw.shade()), &*shading.pixel))
}

/// The tokens of a segment on line `y` that is cut at the holes of its texture.
fn cut(token: &Token, y: u32, colours: &ColourPlane, tokens: &mut Vec<Token>) {
    let beyond = token.first + token.more + 1;
    let mut first = token.first;
    while first < beyond {
        if colours.is_hole(first as i32, y as i32) {
            first += 1;
            continue;
        }
        let end = (first..beyond).find(|&x| colours.is_hole(x as i32, y as i32)).unwrap_or(beyond);
        let skipped = i64::from(first - token.first);
        let z = token.z.wrapping_add(token.dz.wrapping_mul(skipped));
        tokens.push(Token { first, more: end - first - 1, z, ..*token });
        first = end;
    }
}

/// The token of a segment that covers `columns` (`[first, beyond)`) of line `y`, cut to `area`.
#[must_use]
pub fn segment(
    columns: [i32; 2],
    area: &Rectangle,
    y: u32,
    plane: &DepthPlane,
    test: DepthTest,
    luminance: Option<Luminance>,
) -> Option<Token> {
    let first = columns[0].max(area.x as i32);
    let beyond = columns[1].min(area.right as i32);
    (first < beyond).then(|| Token {
        first: first as u32,
        more: (beyond - first - 1) as u32,
        z: plane.value(first, y as i32),
        dz: plane.dx,
        range: [plane.minimum, plane.maximum],
        test,
        luminance,
        stencil: StencilRule::Keep,
    })
}

/// Rows of the target that an item can touch.
fn rows(item: &Item, draws: &[HeldDraw]) -> Range<u32> {
    match item {
        Item::Clear { area, .. } if area.x < area.right => area.y..area.bottom,
        Item::Clear { .. } => 0..0,
        Item::Primitive(shape, draw) => {
            let area = &draws[*draw as usize].scissor;
            let [first, beyond] = match shape {
                Shape::Triangle(triangle, _) => [triangle.rows[0], triangle.rows[2]],
                Shape::Line(line, _) => line_rows(line, area),
                Shape::Point(point, _) => [point.pixel[1], point.pixel[1] + 1],
            };
            let (first, beyond) = (first.max(area.y as i32), beyond.min(area.bottom as i32));
            if first < beyond { first as u32..beyond as u32 } else { 0..0 }
        }
    }
}

/// Rows that a line draws, those outside `area` as they come.
fn line_rows(line: &Line, area: &Rectangle) -> [i32; 2] {
    if line.axis == Axis::Y {
        return line.steps;
    }
    let [first, beyond] = line.steps_inside([area.x as i32, area.right as i32]);
    if first >= beyond {
        return [0, 0];
    }
    let ends = [line.minor_at(first), line.minor_at(beyond - 1)];
    [ends[0].min(ends[1]), ends[0].max(ends[1]) + 1]
}

/// Columns that a shape covers on row `y`, one of its rows: `[first, beyond)`.
fn columns(shape: &Shape, area: &Rectangle, y: i32) -> [i32; 2] {
    match shape {
        Shape::Triangle(triangle, _) => triangle.span(y),
        Shape::Point(point, _) => [point.pixel[0], point.pixel[0] + 1],
        Shape::Line(line, _) => line.columns_on_row(y, [area.x as i32, area.right as i32]),
    }
}

/// The colour of a shape without interpolation.
fn first_colour(shape: &Shape) -> u32 {
    match shape {
        Shape::Triangle(_, v) => v[0].colour,
        Shape::Line(_, v) => v[0].colour,
        Shape::Point(_, v) => v.colour,
    }
}
