//! Compositions: what RENDER asks for, where the card's pixels are those of the server's own renderer (libpixman) to the bit.
//!
//! Refused, so that the renderer does it: an image that lies in the destination's pixmap, but for copies of what is not written;
//! a surface that is not whole in its pixmap, or has not its size of pixel; images so far away that the renderer's own numbers
//! end (`reaches`). Fills and copies go as such, which the card does faster. Text is in [`super::glyphs`].

mod area;
mod request;

use zga_abi::format::RasterOperation;
use zga_device::CardBus;
use zga_driver::{
    Canvas, Composition, Drawable, Driver, DriverError, Image, ListRectangle, Mask, Paint, Picture, Raster, Rectangle,
};

use super::Engine;
use super::draw::image;
use super::lists::{ENTRY, MOST_CLIPS, moved};
use super::pixmaps::{Pixmap, Pixmaps};
pub(super) use area::Area;
use request::Plain;
pub use request::{Cover, Ink, Request, Sampled, Surface, finds_pixels};

impl Ink {
    /// As the driver has it.
    fn paint<'a>(&self, frame: &'a Image, pixmaps: &'a Pixmaps) -> Option<Paint<'a>> {
        match self {
            Ink::Colour(colour) => Some(Paint::Colour(*colour)),
            Ink::Sampled(sampled) => {
                let Sampled { surface, offset, repeat, transform } = *sampled;
                let picture = surface.picture(frame, pixmaps)?;
                Some(Paint::Image { picture, offset, repeat, transform })
            }
        }
    }
}

impl Surface {
    /// It is a part of a pixmap with its size of pixel.
    fn fits(&self, pixmap: &Pixmap, image: &Image) -> bool {
        self.size[0] <= image.width()
            && self.size[1] <= image.height()
            && 8 * self.format.bytes() == pixmap.bits_per_pixel
    }

    /// As the driver has it.
    fn picture<'a>(&self, frame: &'a Image, pixmaps: &'a Pixmaps) -> Option<Picture<'a>> {
        let pixmap = pixmaps.get(self.pixmap)?;
        let image = image(frame, pixmap).filter(|image| self.fits(pixmap, image))?;
        let [right, bottom] = self.size;
        let whole = right == image.width() && bottom == image.height();
        let part = (!whole).then_some(Rectangle { x: 0, y: 0, right, bottom });
        Some(Picture { drawable: Drawable::Image(image), part, format: self.format })
    }
}

/// What a request is drawn by: encodes for some boxes of its clip.
type Encode<'e> = dyn Fn(&mut Driver<CardBus>, &Pixmaps, &Composition<'_>) -> Result<(), DriverError> + 'e;

impl Engine {
    /// Composes a rectangle of the destination's pixmap. False, here and below: the server's renderer has to do it.
    pub fn compose(&mut self, request: &Request<'_>, rectangle: ListRectangle) -> bool {
        let Some(area) = Area::from(rectangle).common(Area::of(request.onto)) else { return true };
        if !request.reaches(area) {
            return false;
        }
        let request = request.simple().reduced(area);
        match request.plain(area) {
            Some(plain) => self.compose_plain(&request, area, &plain),
            None => {
                self.composed(&request, area, None, &|driver, _, composition| driver.compose(composition, &[rectangle]))
            }
        }
    }

    /// The boxes of a request's clip that an area lies in go to scratch; gives their pixels in it.
    fn clip(&mut self, request: &Request<'_>, area: Area) -> u64 {
        let clips = &mut self.scratch.clips;
        clips.clear();
        let mut pixels = 0;
        for clip in request.clips.iter().map(|clip| moved(*clip, request.moved)) {
            if let Some(common) = area.common(clip.into()) {
                pixels += common.pixels();
                clips.push(clip);
            }
        }
        pixels
    }

    /// Composes in an area. `entries`: work of a list of entries, where it is not that of the area.
    pub(super) fn composed(
        &mut self,
        request: &Request<'_>,
        area: Area,
        entries: Option<u64>,
        encode: &Encode<'_>,
    ) -> bool {
        if request.is_refused() {
            return false;
        }
        let pixels = self.clip(request, area);
        if pixels == 0 {
            return true;
        }
        let work = entries.unwrap_or(pixels) * request.touches() + ENTRY;
        let number = |ink: Option<&Ink>| ink.and_then(Ink::sampled).map(|sampled| sampled.surface.pixmap);
        let read = [number(Some(&request.source)), number(request.mask.ink())];
        let onto = request.onto.pixmap;
        let numbers = [onto, read[0].unwrap_or(onto), read[1].unwrap_or(onto)];
        if self.is_small(work) || !self.bring_in(&numbers, 4 * work) {
            return false;
        }
        let Engine { driver, frame, pixmaps, scratch, .. } = &mut *self;
        let (frame, pixmaps) = (&*frame, &*pixmaps);
        let place = |number| pixmaps.get(number).and_then(|pixmap| image(frame, pixmap)).map(std::ptr::from_ref);
        // Two pixmaps can be the frame buffer.
        if read.into_iter().flatten().any(|number| place(number) == place(onto)) {
            return false;
        }
        let paint = |ink: &Ink| ink.paint(frame, pixmaps);
        let (Some(source), Some(onto)) = (paint(&request.source), request.onto.picture(frame, pixmaps)) else {
            return false;
        };
        let mask = match &request.mask {
            Cover::None => Some(Mask::None),
            Cover::Unified(ink) => paint(ink).map(Mask::Unified),
            Cover::Components(ink) => paint(ink).map(Mask::Components),
        };
        let Some(mask) = mask else { return false };
        let operator = request.operator;
        // Boxes of a clip do not overlap, so it is all the same whether entries or boxes come first.
        let encoded = scratch.clips.chunks(MOST_CLIPS).try_for_each(|clips| {
            encode(driver, pixmaps, &Composition { operator, source, mask, onto, origin: [0, 0], clips })
        });
        self.drawn(encoded, &numbers, work)
    }

    /// Fills or copies an area.
    fn compose_plain(&mut self, request: &Request<'_>, area: Area, plain: &Plain) -> bool {
        let pixels = self.clip(request, area);
        if pixels == 0 {
            return true;
        }
        let onto = request.onto.pixmap;
        let (work, numbers) = match plain {
            Plain::Fill(_) => (pixels + ENTRY, [onto; 2]),
            Plain::Copy(from, _) => (2 * pixels + ENTRY, [from.pixmap, onto]),
        };
        if self.is_small(work) || !self.bring_in(&numbers, 4 * work) {
            return false;
        }
        let Engine { driver, frame, pixmaps, scratch, .. } = &mut *self;
        let drawable = |surface: &Surface| surface.picture(frame, pixmaps).map(|picture| picture.drawable);
        let Some(onto) = drawable(&request.onto) else { return false };
        // It lies in the surface, so in 16 bits.
        let [x, y] = [area.x1, area.y1].map(|number| number as i16);
        let [width, height] = [area.x2 - area.x1, area.y2 - area.y1].map(|number| number as u16);
        let list = [ListRectangle { x, y, width, height }];
        let raster = Raster::new(RasterOperation::Copy);
        let mut canvases =
            scratch.clips.chunks(MOST_CLIPS).map(|clips| Canvas { drawable: onto, origin: [0, 0], clips, raster });
        let encoded = match plain {
            Plain::Fill(value) => canvases.try_for_each(|canvas| driver.fill_list(&canvas, *value, &list)),
            Plain::Copy(from, offset) => {
                let Some(from) = drawable(from) else { return false };
                canvases.try_for_each(|canvas| driver.copy_list(from, *offset, &canvas, &list))
            }
        };
        self.drawn(encoded, &numbers, work)
    }
}
