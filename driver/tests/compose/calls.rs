//! Calls, and how they are drawn.

use proptest::prelude::*;
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_device::CardBus;
use zga_driver::{
    ClipBox, Composition, Driver, DriverError, Image, ListRectangle, Mask, MaskGlyph, Paint, Picture, Rectangle,
    Transform,
};

/// Pixels of an image.
pub const WIDTH: u32 = 45;
/// Pixels of an image.
pub const HEIGHT: u32 = 21;

/// A picture of a test: a part of an image of `WIDTH` x `HEIGHT` pixels.
#[derive(Clone, Debug)]
pub struct Part {
    pub format: PictureFormat,
    pub part: Option<Rectangle>,
}

#[derive(Clone, Debug)]
pub enum Brush {
    Colour(u32),
    Image { part: Part, offset: [i32; 2], repeat: Repeat, transform: Option<[i32; 6]> },
}

#[derive(Clone, Debug)]
pub struct Glyph {
    pub place: [i16; 2],
    pub size: [u16; 2],
    pub spare: usize,
    pub seed: u32,
}

#[derive(Clone, Debug)]
pub enum Through {
    Nothing(Vec<ListRectangle>),
    Paint { components: bool, brush: Brush, list: Vec<ListRectangle> },
    Glyphs { components: bool, format: PictureFormat, glyphs: Vec<Glyph> },
}

#[derive(Clone, Debug)]
pub struct Call {
    pub operator: ComposeOperator,
    pub source: Brush,
    pub through: Through,
    pub onto: Part,
    pub origin: [i16; 2],
    pub clips: Vec<ClipBox>,
}

/// A number by multiplying and adding.
pub fn next(state: &mut u32) -> u32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    *state >> 8
}

/// A word of levels, of which the least and the most are frequent.
pub fn levels(state: &mut u32) -> u32 {
    (0..4).fold(0, |word, _| {
        let level = match next(state) % 4 {
            0 => 0,
            1 => 255,
            _ => next(state) % 256,
        };
        word << 8 | level
    })
}

pub fn part() -> impl Strategy<Value = Part> {
    let corner = (0..WIDTH, 0..HEIGHT).prop_flat_map(|(x, y)| {
        (x + 1..=WIDTH, y + 1..=HEIGHT).prop_map(move |(right, bottom)| Rectangle { x, y, right, bottom })
    });
    (prop::sample::select(PictureFormat::ALL.to_vec()), prop::option::of(corner))
        .prop_map(|(format, part)| Part { format, part })
}

pub fn brush() -> impl Strategy<Value = Brush> {
    let number = || prop_oneof![2 => Just(1 << 16), 3 => -(1_i32 << 17)..1 << 17, 1 => any::<i32>()];
    let transform = prop::option::of([number(), number(), number(), number(), number(), number()]);
    let offset = prop_oneof![4 => [-30..30_i32, -30..30_i32], 1 => [-65535..=65535_i32, -65535..=65535_i32]];
    let image = (part(), offset, prop::sample::select(Repeat::ALL.to_vec()), transform)
        .prop_map(|(part, offset, repeat, transform)| Brush::Image { part, offset, repeat, transform });
    prop_oneof![1 => any::<u32>().prop_map(Brush::Colour), 4 => image]
}

pub fn through() -> impl Strategy<Value = Through> {
    let place = || prop_oneof![8 => -15..50_i16, 1 => any::<i16>()];
    let side = prop_oneof![6 => 0..50_u16, 1 => any::<u16>()];
    let one =
        (place(), place(), side.clone(), side).prop_map(|(x, y, width, height)| ListRectangle { x, y, width, height });
    let list = || prop::collection::vec(one.clone(), 0..4);
    let formats = prop::sample::select(vec![PictureFormat::Alpha8, PictureFormat::Argb8888]);
    let glyph = ([-15..50_i16, -15..30_i16], [0..40_u16, 0..12_u16], 0..6_usize, any::<u32>())
        .prop_map(|(place, size, spare, seed)| Glyph { place, size, spare, seed });
    prop_oneof![
        list().prop_map(Through::Nothing),
        (any::<bool>(), brush(), list()).prop_map(|(components, brush, list)| Through::Paint {
            components,
            brush,
            list
        }),
        (any::<bool>(), formats, prop::collection::vec(glyph, 0..5))
            .prop_map(|(components, format, glyphs)| Through::Glyphs { components, format, glyphs }),
    ]
}

pub fn call() -> impl Strategy<Value = Call> {
    let clip = (-5..40_i16, -5..18_i16, 0..40_i16, 0..20_i16).prop_map(|(x1, y1, width, height)| ClipBox {
        x1,
        y1,
        x2: x1 + width,
        y2: y1 + height,
    });
    let clips = prop_oneof![Just(vec![ClipBox::ALL]), prop::collection::vec(clip, 0..4)];
    let origin = prop_oneof![4 => Just([0, 0]), 2 => Just([3, -2]), 1 => [any::<i16>(), any::<i16>()]];
    let operator = prop::sample::select(ComposeOperator::ALL.to_vec());
    (operator, brush(), through(), part(), origin, clips).prop_map(
        |(operator, source, through, onto, origin, clips)| Call { operator, source, through, onto, origin, clips },
    )
}

impl Part {
    pub fn picture<'i>(&self, image: &'i Image) -> Picture<'i> {
        Picture { drawable: image.into(), part: self.part, format: self.format }
    }
}

impl Brush {
    pub fn paint<'i>(&self, image: &'i Image) -> Paint<'i> {
        match self {
            Brush::Colour(argb) => Paint::Colour(*argb),
            Brush::Image { part, offset, repeat, transform } => Paint::Image {
                picture: part.picture(image),
                offset: *offset,
                repeat: *repeat,
                transform: transform.map(|[xx, xy, x0, yx, yy, y0]| Transform { xx, xy, x0, yx, yy, y0 }),
            },
        }
    }

    pub fn format(&self) -> PictureFormat {
        match self {
            Brush::Colour(_) => PictureFormat::Argb8888,
            Brush::Image { part, .. } => part.format,
        }
    }
}

impl Glyph {
    pub fn stride(&self, format: PictureFormat) -> usize {
        usize::from(self.size[0]) * format.bytes() as usize + self.spare
    }

    pub fn rows(&self, format: PictureFormat) -> Vec<u8> {
        let mut state = self.seed;
        (0..self.stride(format) * usize::from(self.size[1])).map(|_| levels(&mut state) as u8).collect()
    }
}

impl Call {
    /// The format of the image that the mask is taken from.
    pub fn mask_format(&self) -> PictureFormat {
        match &self.through {
            Through::Paint { brush, .. } => brush.format(),
            Through::Nothing(_) | Through::Glyphs { .. } => PictureFormat::Argb8888,
        }
    }

    pub fn draw(&self, driver: &mut Driver<CardBus>, [onto, source, mask]: [&Image; 3]) -> Result<(), DriverError> {
        let with = |mask| Composition {
            operator: self.operator,
            source: self.source.paint(source),
            mask,
            onto: self.onto.picture(onto),
            origin: self.origin,
            clips: &self.clips,
        };
        match &self.through {
            Through::Nothing(list) => driver.compose(&with(Mask::None), list),
            Through::Paint { components: false, brush, list } => {
                driver.compose(&with(Mask::Unified(brush.paint(mask))), list)
            }
            Through::Paint { components: true, brush, list } => {
                driver.compose(&with(Mask::Components(brush.paint(mask))), list)
            }
            Through::Glyphs { components, format, glyphs } => {
                let rows: Vec<Vec<u8>> = glyphs.iter().map(|glyph| glyph.rows(*format)).collect();
                let glyphs = glyphs.iter().zip(&rows).map(|(glyph, rows)| {
                    let ([x, y], [width, height]) = (glyph.place, glyph.size);
                    MaskGlyph { x, y, width, height, rows, stride: glyph.stride(*format) }
                });
                driver.compose_glyphs(&with(Mask::None), *format, *components, glyphs)
            }
        }
    }
}
