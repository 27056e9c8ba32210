//! Everything of a scene that lives in a server: made before its first request.

use x11rb::connection::Connection;
use x11rb::protocol::render::{
    Color, ConnectionExt as _, Glyphinfo, PictType, Pictformat, Pictforminfo, Picture, Pointfix,
};
use x11rb::protocol::xproto::{
    ConnectionExt as _, CreateGCAux, CreateWindowAux, Drawable, Font, Gcontext, ImageFormat, Screen, WindowClass,
};
use x11rb::rust_connection::RustConnection;

use super::{PlayError, stride};
use crate::random::Random;
use crate::scene::{CONTEXTS, FONTS, GLYPHS, Origin, PIXELS, Scene};

/// Everything of a scene that lives in a server.
pub(super) struct Stage<'a> {
    pub(super) connection: &'a RustConnection,
    pub(super) scene: &'a Scene,
    pub(super) root: Drawable,
    pub(super) surfaces: Vec<Drawable>,
    pub(super) contexts: Vec<Gcontext>,
    pub(super) fonts: Vec<Font>,
    pub(super) pictures: Vec<Picture>,
    /// Glyph sets, of the formats below.
    pub(super) glyphs: [u32; 2],
    /// Format of masks that trapezoids and glyphs are gathered in.
    pub(super) alpha: Pictformat,
    /// The same with components.
    pub(super) components: Pictformat,
}

/// Colours of at most their alpha, which is in byte `place`.
fn premultiply(bytes: &mut [u8], place: usize) {
    for pixel in bytes.as_chunks_mut::<4>().0 {
        let alpha = pixel[place];
        pixel.iter_mut().for_each(|channel| *channel = (*channel).min(alpha));
    }
}

impl<'a> Stage<'a> {
    pub(super) fn set(
        connection: &'a RustConnection,
        screen: &Screen,
        scene: &'a Scene,
    ) -> Result<Stage<'a>, PlayError> {
        let mut random = Random::new(scene.seed ^ 0x5EED);
        let mut surfaces: Vec<Drawable> = Vec::new();
        for surface in &scene.surfaces {
            let id = connection.generate_id()?;
            let [width, height] = [surface.width, surface.height];
            match surface.window {
                Some(placed) => {
                    let parent = placed.parent.map_or(screen.root, |parent| surfaces[parent]);
                    let settings = CreateWindowAux::new()
                        .background_pixel(random.bits() as u32 & 0x00FF_FFFF)
                        .border_pixel(random.bits() as u32 & 0x00FF_FFFF)
                        .override_redirect(1);
                    let (x, y, border) = (placed.x, placed.y, placed.border);
                    let class = WindowClass::INPUT_OUTPUT;
                    connection
                        .create_window(0, id, parent, x, y, width, height, border, class, 0, &settings)?
                        .check()?;
                    connection.map_window(id)?;
                }
                None => drop(connection.create_pixmap(surface.depth, id, screen.root, width, height)?),
            }
            surfaces.push(id);
        }
        let mut fonts = Vec::new();
        for name in FONTS {
            let font = connection.generate_id()?;
            connection.open_font(font, name.as_bytes())?.check()?;
            fonts.push(font);
        }
        let mut contexts = Vec::new();
        for depth in &scene.depths {
            let on = scene.surfaces.iter().position(|surface| surface.depth == *depth).unwrap_or(0);
            for _ in 0..CONTEXTS {
                let context = connection.generate_id()?;
                let settings = CreateGCAux::new()
                    .graphics_exposures(0)
                    .foreground(random.bits() as u32)
                    .background(random.bits() as u32)
                    .font(fonts[0]);
                connection.create_gc(context, surfaces[on], &settings)?.check()?;
                contexts.push(context);
            }
        }
        let mut stage = Stage {
            connection,
            scene,
            root: screen.root,
            surfaces,
            contexts,
            fonts,
            pictures: Vec::new(),
            glyphs: [0; 2],
            alpha: 0,
            components: 0,
        };
        stage.fill_pixmaps(&mut random)?;
        if scene.kind.render {
            stage.make_pictures(&mut random)?;
        }
        Ok(stage)
    }

    /// What pixmaps hold when they are made is nobody's business: they are filled first.
    fn fill_pixmaps(&self, random: &mut Random) -> Result<(), PlayError> {
        for (surface, id) in self.scene.surfaces.iter().zip(&self.surfaces) {
            if surface.window.is_some() {
                continue;
            }
            let context = self.connection.generate_id()?;
            self.connection.create_gc(context, *id, &CreateGCAux::new().graphics_exposures(0))?;
            // Rows at a time: a request holds a quarter of a megabyte.
            let row = stride(surface.width.into(), surface.depth);
            let most = (200_000 / row).max(1) as u16;
            let mut top = 0;
            while top < surface.height {
                let height = most.min(surface.height - top);
                let mut bytes = random.bytes(row * usize::from(height));
                if surface.depth == 32 {
                    premultiply(&mut bytes, if surface.is_reversed() { 0 } else { 3 });
                }
                let (format, width) = (ImageFormat::Z_PIXMAP, surface.width);
                self.connection.put_image(
                    format,
                    *id,
                    context,
                    width,
                    height,
                    0,
                    top as i16,
                    0,
                    surface.depth,
                    &bytes,
                )?;
                top += height;
            }
            self.connection.free_gc(context)?;
        }
        Ok(())
    }

    fn make_pictures(&mut self, random: &mut Random) -> Result<(), PlayError> {
        let connection = self.connection;
        let formats = connection.render_query_pict_formats()?.reply()?.formats;
        let format = |number: usize| -> Result<Pictformat, PlayError> {
            let found = formats.iter().find(|found| is_format(found, PIXELS[number]));
            found
                .map(|found| found.id)
                .ok_or_else(|| PlayError::Refused(format!("no picture format {:?}", PIXELS[number])))
        };
        for origin in &self.scene.pictures {
            let picture = connection.generate_id()?;
            match *origin {
                Origin::Surface(on, pixels) => {
                    connection.render_create_picture(
                        picture,
                        self.surfaces[on],
                        format(pixels)?,
                        &Default::default(),
                    )?;
                }
                Origin::Solid(colour) => {
                    connection.render_create_solid_fill(picture, colour)?;
                }
                Origin::Linear([x1, y1, x2, y2]) => {
                    let point = |x: i32, y: i32| Pointfix { x: x << 16, y: y << 16 };
                    let (stops, colours) = stops();
                    connection.render_create_linear_gradient(
                        picture,
                        point(x1, y1),
                        point(x2, y2),
                        &stops,
                        &colours,
                    )?;
                }
                Origin::Radial([x, y, radius]) => {
                    let centre = Pointfix { x: x << 16, y: y << 16 };
                    let (stops, colours) = stops();
                    connection.render_create_radial_gradient(
                        picture,
                        centre,
                        centre,
                        0,
                        radius << 16,
                        &stops,
                        &colours,
                    )?;
                }
            }
            self.pictures.push(picture);
        }
        (self.alpha, self.components) = (format(5)?, format(0)?);
        for (set, (format, depth)) in [(self.alpha, 8), (self.components, 32)].into_iter().enumerate() {
            self.glyphs[set] = connection.generate_id()?;
            connection.render_create_glyph_set(self.glyphs[set], format)?;
            for glyph in 0..GLYPHS {
                let [width, height] = [random.below(18) as u16 + 1, random.below(18) as u16 + 1];
                let info = Glyphinfo {
                    width,
                    height,
                    x: random.between(-3, 3) as i16,
                    y: random.between(0, 14) as i16,
                    x_off: width as i16,
                    y_off: 0,
                };
                let bytes = random.bytes(stride(width.into(), depth) * usize::from(height));
                connection.render_add_glyphs(self.glyphs[set], &[glyph], &[info], &bytes)?;
            }
        }
        Ok(())
    }
}

fn is_format(found: &Pictforminfo, (depth, red, red_mask, alpha_mask): (u8, u16, u16, u16)) -> bool {
    let direct = &found.direct;
    found.type_ == PictType::DIRECT
        && found.depth == depth
        && direct.red_mask == red_mask
        && (red_mask == 0 || direct.red_shift == red)
        && direct.alpha_mask == alpha_mask
}

/// Colours along a gradient.
fn stops() -> (Vec<i32>, Vec<Color>) {
    let colour = |red, green, blue, alpha| Color { red, green, blue, alpha };
    let colours = vec![
        colour(0xFFFF, 0, 0, 0xFFFF),
        colour(0, 0x8000, 0, 0x8000),
        colour(0x1000, 0x2000, 0x3000, 0x4000),
        colour(0, 0, 0xFFFF, 0xFFFF),
    ];
    (vec![0, 0x5000, 0xA000, 0x1_0000], colours)
}
