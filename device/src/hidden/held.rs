//! A scene that is held back: what a path that sorts before it draws has been given until END_SCENE.
//!
//! The clocked models of the systolic array and of the tile unit see a whole scene at once. Here it
//! waits, in order of submission.

use super::z_buffer::DepthTest;
use crate::geometry::assembly::{List, Shape};
use crate::shading::plane::Interpolation;
use zga_firmware::checked::Rectangle;

/// Most items of a scene that is held back: about 300 MiB.
pub const HELD_LIMIT: usize = 1 << 20;

/// State that the primitives of a draw share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeldDraw {
    /// Depth test; `None` where depth is not called for: everything passes, no depth is stored.
    pub test: Option<DepthTest>,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// Pixels that may change, inside the target.
    pub scissor: Rectangle,
}

/// A part of a scene.
#[derive(Clone, Copy, Debug)]
pub enum Item {
    /// A primitive, and the number of its draw in [`Held::draws`].
    Primitive(Shape, u32),
    /// A clear that is not the scene's background: a rectangle that passes always. `colour` is RGBA (R in
    /// 7:0), a plane that is not cleared is `None`.
    Clear {
        /// Pixels cleared, inside the target.
        area: Rectangle,
        /// Colour to be written.
        colour: Option<u32>,
        /// Depth to be stored.
        depth: Option<i32>,
    },
}

/// What the picture was before the first item.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Background {
    /// RGBA (R in 7:0) of a clear of all pixels; `None`: the frame buffer's own pixels stay where nothing is drawn.
    pub colour: Option<u32>,
    /// Depth of a clear of all pixels; `None`: what the Z buffer holds, or the farthest depth where there is none.
    pub depth: Option<i32>,
}

impl Background {
    /// A clear of all pixels; planes that it leaves alone stay.
    pub fn add(&mut self, colour: Option<u32>, depth: Option<i32>) {
        *self = Background { colour: colour.or(self.colour), depth: depth.or(self.depth) };
    }
}

/// A scene held back.
#[derive(Debug, Default)]
pub struct Held {
    /// In order of submission.
    pub items: Vec<Item>,
    /// State of the draws.
    pub draws: Vec<HeldDraw>,
    /// Before the first item.
    pub background: Background,
}

impl Held {
    /// Forgets everything.
    pub fn reset(&mut self) {
        self.items.clear();
        self.draws.clear();
        self.background = Background::default();
    }

    /// Adds the primitives of a list that was assembled for a draw.
    pub fn add(&mut self, draw: HeldDraw, list: &List) {
        if self.draws.last() != Some(&draw) {
            self.draws.push(draw);
        }
        let number = self.draws.len() as u32 - 1;
        self.items.extend(list.shapes.iter().map(|(shape, _)| Item::Primitive(*shape, number)));
    }

    /// Adds a clear, to the background or to what is drawn over it.
    pub fn clear(&mut self, background: bool, area: Rectangle, colour: Option<u32>, depth: Option<i32>) {
        if background {
            self.background.add(colour, depth);
        } else {
            self.items.push(Item::Clear { area, colour, depth });
        }
    }

    /// Wants no more.
    #[must_use]
    pub fn full(&self) -> bool {
        self.items.len() >= HELD_LIMIT
    }
}
