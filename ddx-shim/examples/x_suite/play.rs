//! Play: a scene on a server, and the pixels that come of it.

use std::os::unix::net::UnixStream;

use x11rb::connection::Connection;
use x11rb::cookie::VoidCookie;
use x11rb::errors::{ConnectionError, ReplyError, ReplyOrIdError};
use x11rb::protocol::Event;
use x11rb::protocol::render::{
    Color, ConnectionExt as _, Glyphinfo, PictType, Pictformat, Pictforminfo, Picture, Pointfix,
};
use x11rb::protocol::xproto::{
    ChangeGCAux, Char2b, ClipOrdering, ConfigureWindowAux, ConnectionExt as _, CreateGCAux, CreateWindowAux, Drawable,
    Font, GX, Gcontext, ImageFormat, Rectangle, Screen, StackMode, WindowClass,
};
use x11rb::rust_connection::{DefaultStream, RustConnection};
use zga_ddx_shim::session::Session;

use super::random::Random;
use super::scene::{CONTEXTS, FONTS, GLYPHS, Gathered, Origin, PIXELS, Request, Scene};

/// Why a scene could not be played to its end.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    #[error("cannot connect to display {0}: {1}")]
    Connect(String, String),
    #[error("the connection broke: {0}")]
    Broken(#[from] ConnectionError),
    #[error("the server refused what it must not refuse: {0}")]
    Refused(String),
}

impl From<ReplyOrIdError> for PlayError {
    fn from(error: ReplyOrIdError) -> Self {
        match error {
            ReplyOrIdError::ConnectionError(broken) => Self::Broken(broken),
            other => Self::Refused(other.to_string()),
        }
    }
}

impl From<ReplyError> for PlayError {
    fn from(error: ReplyError) -> Self {
        ReplyOrIdError::from(error).into()
    }
}

/// Connects to a session's display.
pub fn connect(session: &Session) -> Result<(RustConnection, Screen), PlayError> {
    let display = session.display();
    let fault = |reason: String| PlayError::Connect(display.to_owned(), reason);
    let path = format!("/tmp/.X11-unix/X{}", display.trim_start_matches(':'));
    let stream = UnixStream::connect(path).map_err(|reason| fault(reason.to_string()))?;
    let (stream, _) = DefaultStream::from_unix_stream(stream).map_err(|reason| fault(reason.to_string()))?;
    let cookie = session.cookie().map_err(|reason| fault(reason.to_string()))?;
    let connection =
        RustConnection::connect_to_stream_with_auth_info(stream, 0, b"MIT-MAGIC-COOKIE-1".to_vec(), cookie)
            .map_err(|reason| fault(reason.to_string()))?;
    let screen = connection.setup().roots[0].clone();
    Ok((connection, screen))
}

/// Pixels of something at some moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shot {
    pub name: String,
    pub size: [u16; 2],
    pub depth: u8,
    /// As the server gave them; where they are whole pixels, bits that no depth has are 0.
    pub bytes: Vec<u8>,
}

/// What came of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    pub shots: Vec<Shot>,
    /// Numbers of requests that were refused, and the error's code.
    pub errors: Vec<(usize, u8)>,
}

/// Which part of a scene is played.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// So many requests.
    pub requests: usize,
    /// This one left out.
    pub without: Option<usize>,
}

/// Everything of a scene that lives in a server.
struct Stage<'a> {
    connection: &'a RustConnection,
    scene: &'a Scene,
    root: Drawable,
    surfaces: Vec<Drawable>,
    contexts: Vec<Gcontext>,
    fonts: Vec<Font>,
    pictures: Vec<Picture>,
    /// Glyph sets, of the formats below.
    glyphs: [u32; 2],
    /// Format of masks that trapezoids and glyphs are gathered in.
    alpha: Pictformat,
    /// The same with components.
    components: Pictformat,
}

/// Plays a part of a scene and takes the pixels. Everything is gone from the server afterwards, with the connection.
pub fn play(session: &Session, scene: &Scene, part: Part) -> Result<Outcome, PlayError> {
    let (connection, screen) = connect(session)?;
    let stage = Stage::set(&connection, &screen, scene)?;
    let mut outcome = Outcome::default();
    let mut numbers = Vec::new();
    let wanted = |number: &usize| part.without != Some(*number);
    for number in (0..part.requests.min(scene.requests.len())).filter(wanted) {
        let before = stage.request(number, &mut outcome)?;
        numbers.extend(before.map(|sequence| (sequence, number)));
    }
    stage.look(&mut outcome)?;
    while let Some(event) = connection.poll_for_event()? {
        if let Event::Error(error) = event {
            let number = numbers.iter().find(|(sequence, _)| *sequence as u16 == error.sequence);
            outcome.errors.push((number.map_or(usize::MAX, |(_, number)| *number), error.error_code));
        }
    }
    Ok(outcome)
}

/// Bytes of a row of pixels of some depth, as the wire has it.
fn stride(width: u32, depth: u8) -> usize {
    let bits = match depth {
        1 => 1,
        8 => 8,
        16 => 16,
        _ => 32,
    };
    (width as usize * bits).div_ceil(32) * 4
}

/// Colours of at most their alpha, which is in byte `place`.
fn premultiply(bytes: &mut [u8], place: usize) {
    for pixel in bytes.as_chunks_mut::<4>().0 {
        let alpha = pixel[place];
        pixel.iter_mut().for_each(|channel| *channel = (*channel).min(alpha));
    }
}

impl<'a> Stage<'a> {
    fn set(connection: &'a RustConnection, screen: &Screen, scene: &'a Scene) -> Result<Stage<'a>, PlayError> {
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

    /// Sends a request; its sequence number if it has no answer.
    fn request(&self, number: usize, outcome: &mut Outcome) -> Result<Option<u64>, PlayError> {
        let to = self.connection;
        let surface = |on: &usize| self.surfaces[*on];
        let context = |gc: &usize| self.contexts[*gc];
        let picture = |pic: &usize| self.pictures[*pic];
        let sent: VoidCookie<'_, RustConnection> = match &self.scene.requests[number] {
            Request::Change { gc, change } => {
                let pixmap = |on: usize| self.surfaces[on];
                let settings = ChangeGCAux {
                    function: change.function,
                    plane_mask: change.planes,
                    foreground: change.foreground,
                    background: change.background,
                    line_width: change.width,
                    line_style: change.line,
                    cap_style: change.cap,
                    join_style: change.join,
                    fill_style: change.fill,
                    fill_rule: change.rule,
                    tile: change.tile.map(pixmap),
                    stipple: change.stipple.map(pixmap),
                    tile_stipple_x_origin: change.origin.map(|[x, _]| x.into()),
                    tile_stipple_y_origin: change.origin.map(|[_, y]| y.into()),
                    font: change.font.map(|font| self.fonts[font]),
                    subwindow_mode: change.subwindows,
                    arc_mode: change.arcs,
                    ..ChangeGCAux::default()
                };
                to.change_gc(context(gc), &settings)?
            }
            Request::Dashes { gc, offset, list } => to.set_dashes(context(gc), *offset, list)?,
            Request::Clip { gc, x, y, rectangles } => {
                to.set_clip_rectangles(ClipOrdering::UNSORTED, context(gc), *x, *y, rectangles)?
            }
            Request::ClipMask { gc, mask, x, y } => {
                let mask = mask.map_or(0, |mask| self.surfaces[mask]);
                let settings =
                    ChangeGCAux::new().clip_mask(mask).clip_x_origin(i32::from(*x)).clip_y_origin(i32::from(*y));
                to.change_gc(context(gc), &settings)?
            }
            Request::Fill { on, gc, list } => to.poly_fill_rectangle(surface(on), context(gc), list)?,
            Request::Frames { on, gc, list } => to.poly_rectangle(surface(on), context(gc), list)?,
            Request::Arcs { on, gc, list, filled: true } => to.poly_fill_arc(surface(on), context(gc), list)?,
            Request::Arcs { on, gc, list, filled: false } => to.poly_arc(surface(on), context(gc), list)?,
            Request::Polygon { on, gc, shape, mode, list } => {
                to.fill_poly(surface(on), context(gc), *shape, *mode, list)?
            }
            Request::Segments { on, gc, list } => to.poly_segment(surface(on), context(gc), list)?,
            Request::Lines { on, gc, mode, list } => to.poly_line(*mode, surface(on), context(gc), list)?,
            Request::Points { on, gc, mode, list } => to.poly_point(*mode, surface(on), context(gc), list)?,
            Request::Copy { from, on, gc, at, to: there, size: [width, height] } => {
                let ([x, y], [to_x, to_y]) = (*at, *there);
                to.copy_area(surface(from), surface(on), context(gc), x, y, to_x, to_y, *width, *height)?
            }
            Request::Plane { from, on, gc, at, to: there, size: [width, height], plane } => {
                let ([x, y], [to_x, to_y]) = (*at, *there);
                to.copy_plane(surface(from), surface(on), context(gc), x, y, to_x, to_y, *width, *height, *plane)?
            }
            Request::Put { on, gc, format, depth, to: [x, y], size: [width, height], left, seed } => {
                let (wide, rows) = (u32::from(*width) + u32::from(*left), usize::from(*height));
                let length = match *format {
                    ImageFormat::Z_PIXMAP => stride((*width).into(), *depth) * rows,
                    ImageFormat::XY_BITMAP => stride(wide, 1) * rows,
                    _ => stride(wide, 1) * rows * usize::from(*depth),
                };
                let bytes = Random::new(*seed).bytes(length);
                to.put_image(*format, surface(on), context(gc), *width, *height, *x, *y, *left, *depth, &bytes)?
            }
            Request::Text { on, gc, to: [x, y], text, image, wide } => {
                let (on, gc) = (surface(on), context(gc));
                let pairs = || text.iter().map(|byte| Char2b { byte1: 0, byte2: *byte }).collect::<Vec<_>>();
                match (image, wide) {
                    (true, false) => to.image_text8(on, gc, *x, *y, text)?,
                    (true, true) => to.image_text16(on, gc, *x, *y, &pairs())?,
                    (false, false) => {
                        let items = [&[text.len() as u8, 2], &text[..]].concat();
                        to.poly_text8(on, gc, *x, *y, &items)?
                    }
                    (false, true) => {
                        let mut items = vec![text.len() as u8, 2];
                        items.extend(text.iter().flat_map(|byte| [0, *byte]));
                        to.poly_text16(on, gc, *x, *y, &items)?
                    }
                }
            }
            Request::Clear { window, at: [x, y], size: [width, height] } => {
                to.clear_area(false, surface(window), *x, *y, *width, *height)?
            }
            Request::Move { window, to: [x, y], size: [width, height] } => {
                let settings = ConfigureWindowAux::new()
                    .x(i32::from(*x))
                    .y(i32::from(*y))
                    .width(u32::from(*width))
                    .height(u32::from(*height));
                to.configure_window(surface(window), &settings)?
            }
            Request::Stack { window, above } => {
                let mode = if *above { StackMode::ABOVE } else { StackMode::BELOW };
                to.configure_window(surface(window), &ConfigureWindowAux::new().stack_mode(mode))?
            }
            Request::Show { window, shown: true } => to.map_window(surface(window))?,
            Request::Show { window, shown: false } => to.unmap_window(surface(window))?,
            Request::Read { on, at: [x, y], size, planes, format } => {
                let depth = self.scene.surfaces[*on].depth;
                let name = format!("surface {on} at request {number}");
                self.shoot(name, surface(on), [*x, *y], *size, depth, (*format, *planes), outcome)?;
                return Ok(None);
            }
            Request::Compose { op, from, mask, on, at, mask_at, to: there, size: [width, height] } => {
                let mask = mask.as_ref().map_or(0, picture);
                let ([x, y], [mask_x, mask_y], [to_x, to_y]) = (*at, *mask_at, *there);
                to.render_composite(
                    *op,
                    picture(from),
                    mask,
                    picture(on),
                    x,
                    y,
                    mask_x,
                    mask_y,
                    to_x,
                    to_y,
                    *width,
                    *height,
                )?
            }
            Request::Paint { op, on, colour, list } => to.render_fill_rectangles(*op, picture(on), *colour, list)?,
            Request::Picture { pic, repeat, component } => {
                let settings = x11rb::protocol::render::ChangePictureAux::new()
                    .repeat(*repeat)
                    .componentalpha(u32::from(*component));
                to.render_change_picture(picture(pic), &settings)?
            }
            Request::PictureClip { pic, rectangles } => {
                to.render_set_picture_clip_rectangles(picture(pic), 0, 0, rectangles)?
            }
            Request::Transformed { pic, matrix, filter } => {
                // Both belong together: a filter alone would be told as one request.
                to.render_set_picture_filter(picture(pic), filter.as_bytes(), &[])?;
                to.render_set_picture_transform(picture(pic), *matrix)?
            }
            Request::Trapezoids { op, from, on, masked, at: [x, y], list } => {
                let format = if *masked { self.alpha } else { 0 };
                to.render_trapezoids(*op, picture(from), picture(on), format, *x, *y, list)?
            }
            Request::Triangles { op, from, on, masked, at: [x, y], list } => {
                let format = if *masked { self.alpha } else { 0 };
                to.render_triangles(*op, picture(from), picture(on), format, *x, *y, list)?
            }
            Request::Glyphs { op, from, on, mask, at: [x, y], list } => {
                let format = match mask {
                    None => 0,
                    Some(Gathered::Alpha) => self.alpha,
                    Some(Gathered::Components) => self.components,
                };
                let of = |glyph: u8| usize::from(u32::from(glyph) >= GLYPHS);
                let first = list.first().map_or(0, |(glyph, _)| of(*glyph));
                let (mut commands, mut set) = (Vec::new(), first);
                for (glyph, [right, down]) in list {
                    if of(*glyph) != set {
                        // From here on the other set.
                        set = of(*glyph);
                        commands.extend([255, 0, 0, 0, 0, 0, 0, 0]);
                        commands.extend(self.glyphs[set].to_ne_bytes());
                    }
                    commands.extend([1, 0, 0, 0]);
                    commands.extend(right.to_ne_bytes());
                    commands.extend(down.to_ne_bytes());
                    commands.extend([glyph % GLYPHS as u8, 0, 0, 0]);
                }
                let set = self.glyphs[first];
                to.render_composite_glyphs8(*op, picture(from), picture(on), format, set, *x, *y, &commands)?
            }
            Request::Blot { on, at: [x, y] } => {
                let gc = to.generate_id()?;
                to.create_gc(gc, surface(on), &CreateGCAux::new().function(GX::INVERT))?;
                to.poly_fill_rectangle(surface(on), gc, &[Rectangle { x: *x, y: *y, width: 1, height: 1 }])?;
                to.free_gc(gc)?
            }
        };
        Ok(Some(sent.sequence_number()))
    }

    /// The pixels of everything at the end.
    fn look(&self, outcome: &mut Outcome) -> Result<(), PlayError> {
        let composited = self.scene.kind.composited;
        let (whole, scene) = ((ImageFormat::Z_PIXMAP, u32::MAX), self.scene);
        if !composited {
            let size = scene.kind.size;
            self.shoot("screen".to_owned(), self.root, [0, 0], size, scene.kind.depth, whole, outcome)?;
        }
        for (on, (surface, id)) in scene.surfaces.iter().zip(&self.surfaces).enumerate() {
            let kind = if surface.window.is_some() { "window" } else { "pixmap" };
            let name = format!("{kind} {on}, depth {}", surface.depth);
            if surface.window.is_none() {
                self.shoot(name, *id, [0, 0], [surface.width, surface.height], surface.depth, whole, outcome)?;
            } else if composited {
                let place = self.connection.get_geometry(*id)?.reply()?;
                let size = [place.width, place.height];
                self.shoot(name, *id, [0, 0], size, surface.depth, whole, outcome)?;
            }
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "a request's own fields")]
    fn shoot(
        &self,
        name: String,
        from: Drawable,
        [x, y]: [i16; 2],
        size: [u16; 2],
        depth: u8,
        (format, planes): (ImageFormat, u32),
        outcome: &mut Outcome,
    ) -> Result<(), PlayError> {
        let [width, height] = size;
        match self.connection.get_image(format, from, x, y, width, height, planes)?.reply() {
            Ok(image) => {
                let mut bytes = image.data;
                // Depth 24 in 32 bits: the protocol leaves the rest undefined. RENDER's pictures of it have no channel there, and
                // what the server's renderer leaves there depends on the way it takes; nothing reads it but as opaque.
                if format == ImageFormat::Z_PIXMAP && depth == 24 {
                    bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|pixel| pixel[3] = 0);
                }
                outcome.shots.push(Shot { name, size, depth, bytes });
                Ok(())
            }
            // A window that is hidden or reaches beyond the screen: the same on both.
            Err(ReplyError::X11Error(error)) => {
                outcome.errors.push((usize::MAX, error.error_code));
                Ok(())
            }
            Err(ReplyError::ConnectionError(broken)) => Err(broken.into()),
        }
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

/// The whole screen of a session, as XRGB8888 words.
pub fn screenshot(session: &Session) -> Result<([u32; 2], Vec<u32>), PlayError> {
    let (connection, screen) = connect(session)?;
    let (width, height) = (screen.width_in_pixels, screen.height_in_pixels);
    let image = connection.get_image(ImageFormat::Z_PIXMAP, screen.root, 0, 0, width, height, u32::MAX)?.reply()?;
    let shot = Shot { name: "screen".to_owned(), size: [width, height], depth: screen.root_depth, bytes: image.data };
    Ok(([width.into(), height.into()], shot.pixels()))
}

/// Has anybody set this property of the root window?
pub fn has_root_property(session: &Session, name: &str) -> Result<bool, PlayError> {
    let (connection, screen) = connect(session)?;
    let atom = connection.intern_atom(true, name.as_bytes())?.reply()?.atom;
    let property = connection.get_property(false, screen.root, atom, 0_u32, 0, 1);
    Ok(atom != 0 && property?.reply()?.type_ != 0)
}

/// Waits until the server has done all that it was sent by anybody before.
pub fn settle(session: &Session) -> Result<(), PlayError> {
    let (connection, _) = connect(session)?;
    connection.get_input_focus()?.reply()?;
    Ok(())
}

impl Shot {
    /// As XRGB8888 words for the eye.
    pub fn pixels(&self) -> Vec<u32> {
        let [width, height] = self.size.map(usize::from);
        let row = stride(width as u32, self.depth);
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            let line = self.bytes.get(y * row..).unwrap_or(&[]);
            let byte = |at: usize| u32::from(line.get(at).copied().unwrap_or(0));
            pixels.extend((0..width).map(|x| match self.depth {
                1 => (byte(x / 8) >> (x % 8) & 1) * 0xFF_FFFF,
                8 => byte(x) * 0x01_0101,
                16 => {
                    let pixel = byte(2 * x) | byte(2 * x + 1) << 8;
                    let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
                    (red * 255 / 31) << 16 | (green * 255 / 63) << 8 | (blue * 255 / 31)
                }
                _ => byte(4 * x) | byte(4 * x + 1) << 8 | byte(4 * x + 2) << 16,
            }));
        }
        pixels
    }
}
