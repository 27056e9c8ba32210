//! A scene that is held back: what a path that sorts before it draws has been given until END_SCENE.
//!
//! The clocked models of the systolic array and of the tile unit see a whole scene at once. Here it
//! waits, in order of submission.

use super::stencil::{StencilRows, StencilRule, Stencilled};
use super::z_buffer::DepthTest;
use crate::geometry::assembly::{List, Shape};
use crate::hidden::z_buffer::band::Setting;
use crate::shading::parameters::Parameters;
use crate::shading::pixel::{PixelShading, ShadingCounts};
use crate::shading::plane::{Interpolation, Shade};
use std::sync::Arc;
use zga_firmware::checked::{Rectangle, Stencil, Target};

/// Most items of a scene that is held back: about 300 MiB.
pub const HELD_LIMIT: usize = 1 << 20;

/// State that the primitives of a draw share; a primitive whose colours go through more has one of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldDraw {
    /// Depth test; `None` where depth is not called for: everything passes, no depth is stored.
    pub test: Option<DepthTest>,
    /// Which colour interpolators are called.
    pub interpolation: Interpolation,
    /// What interpolated colours go through.
    pub shading: Option<HeldShading>,
    /// Pixels that may change, inside the target.
    pub scissor: Rectangle,
    /// Stencil test; `None` where it is not called for.
    pub stencil: Option<Stencil>,
}

/// What the colours of one primitive go through.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldShading {
    /// The same for all of a draw.
    pub pixel: Arc<PixelShading>,
    /// What its vertices carry.
    pub vertices: Parameters,
}

impl HeldShading {
    /// That of primitive `number` of a draw.
    #[must_use]
    pub fn of(setting: &Setting, number: u32) -> Option<HeldShading> {
        let (pixel, vertices) = setting.shade(number).pixel?;
        Some(HeldShading { pixel: Arc::clone(pixel), vertices: *vertices })
    }

    /// The references that a shade is made of.
    #[must_use]
    pub fn parts(&self) -> (&Arc<PixelShading>, &Parameters) {
        (&self.pixel, &self.vertices)
    }
}

impl HeldDraw {
    /// How the pixels of a primitive get their colours.
    #[must_use]
    pub fn shade(&self) -> Shade<'_> {
        Shade { interpolation: self.interpolation, pixel: self.shading.as_ref().map(HeldShading::parts) }
    }

    /// Whether shading does anything for its pixels.
    #[must_use]
    pub fn is_shaded(&self) -> bool {
        self.interpolation != Interpolation::Flat || self.shading.is_some()
    }

    /// Whether pixels that pass get a colour.
    #[must_use]
    pub fn draws_colours(&self) -> bool {
        self.stencil.is_none_or(|stencil| !stencil.colour_off)
    }

    /// What becomes of stencil values where a primitive is drawn.
    #[must_use]
    pub fn stencil_rule(&self, shape: &Shape) -> StencilRule {
        self.stencil.map_or(StencilRule::Keep, |rule| StencilRule::Test(Stencilled::of(rule, shape)))
    }

    /// Whether the texture has holes.
    #[must_use]
    pub fn has_holes(&self) -> bool {
        self.shading.as_ref().is_some_and(|shading| shading.pixel.punch_through().is_some())
    }

    /// What looking for holes among so many fragments costs, where so many are holes.
    #[must_use]
    pub fn looked_up(&self, fragments: u64, holes: u64) -> ShadingCounts {
        let shading = self.shading.as_ref();
        shading.map_or(ShadingCounts::default(), |shading| shading.pixel.looked_up(fragments, holes))
    }

    /// What a pixel costs beyond its interpolated colour.
    #[must_use]
    pub fn cost(&self) -> ShadingCounts {
        self.shading.as_ref().map_or(ShadingCounts::default(), |shading| shading.pixel.cost())
    }
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
        /// Stencil value to be stored.
        stencil: Option<u8>,
    },
}

/// Depths before and after a scene that is drawn at once: those of the Z buffer, or, where somebody asks for them, of
/// registers whose contents would be lost.
#[derive(Debug)]
pub struct Depths<'m> {
    /// Rows of `pitch`.
    pub rows: &'m mut [i32],
    /// Elements from a row to the next; 0 where nobody asks.
    pub pitch: usize,
    /// Stencil values beside them, where the scene asks for any.
    pub stencil: StencilRows<'m>,
}

impl<'m> Depths<'m> {
    /// Those of the target's Z buffer, which are in `rows`; nobody's where there is none.
    #[must_use]
    pub fn of(target: &Target, rows: &'m mut [i32]) -> Self {
        let pitch = target.depth.map_or(0, |depth| depth.pitch as usize / 4);
        Depths { rows, pitch, stencil: StencilRows::none() }
    }

    /// Depth of pixel (`x`, `y`); anything below the last line.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Option<i32> {
        if self.pitch == 0 { None } else { self.rows.get(y as usize * self.pitch + x as usize).copied() }
    }
}

/// What the picture was before the first item.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Background {
    /// RGBA (R in 7:0) of a clear of all pixels; `None`: the frame buffer's own pixels stay where nothing is drawn.
    pub colour: Option<u32>,
    /// Depth of a clear of all pixels; `None`: what the Z buffer holds, or the farthest depth where there is none.
    pub depth: Option<i32>,
    /// Stencil value of a clear of all pixels; `None`: what the stencil plane holds.
    pub stencil: Option<u8>,
}

impl Background {
    /// A clear of all pixels; planes that it leaves alone stay.
    pub fn add(&mut self, colour: Option<u32>, depth: Option<i32>, stencil: Option<u8>) {
        let (colour, depth) = (colour.or(self.colour), depth.or(self.depth));
        *self = Background { colour, depth, stencil: stencil.or(self.stencil) };
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

    /// Adds the primitives of a list that was assembled for a draw. `shading` says what the colours of a primitive go
    /// through, given its number in the draw.
    pub fn add(&mut self, draw: &HeldDraw, list: &List, shading: impl Fn(u32) -> Option<HeldShading>) {
        for (shape, number) in &list.shapes {
            let draw = HeldDraw { shading: shading(*number), ..draw.clone() };
            if draw.shading.is_some() || self.draws.last() != Some(&draw) {
                self.draws.push(draw);
            }
            self.items.push(Item::Primitive(*shape, self.draws.len() as u32 - 1));
        }
    }

    /// Adds a clear, to the background or to what is drawn over it.
    pub fn clear(
        &mut self,
        background: bool,
        area: Rectangle,
        colour: Option<u32>,
        depth: Option<i32>,
        stencil: Option<u8>,
    ) {
        if background {
            self.background.add(colour, depth, stencil);
        } else {
            self.items.push(Item::Clear { area, colour, depth, stencil });
        }
    }

    /// Whether the scene has to do with stencil values.
    #[must_use]
    pub fn asks_for_stencil(&self) -> bool {
        self.background.stencil.is_some()
            || self.draws.iter().any(|draw| draw.stencil.is_some())
            || self.items.iter().any(|item| matches!(item, Item::Clear { stencil: Some(_), .. }))
    }

    /// Wants no more.
    #[must_use]
    pub fn full(&self) -> bool {
        self.items.len() >= HELD_LIMIT
    }
}
