//! Requests as they are sent.

use x11rb::connection::Connection;
use x11rb::cookie::VoidCookie;
use x11rb::protocol::render::ConnectionExt as _;
use x11rb::protocol::xproto::{
    ChangeGCAux, Char2b, ClipOrdering, ConfigureWindowAux, ConnectionExt as _, CreateGCAux, GX, ImageFormat, Rectangle,
    StackMode,
};
use x11rb::rust_connection::RustConnection;

use super::stage::Stage;
use super::{Outcome, PlayError, stride};
use crate::random::Random;
use crate::scene::{GLYPHS, Gathered, Request};

impl Stage<'_> {
    /// Sends a request; its sequence number if it has no answer.
    pub(super) fn request(&self, number: usize, outcome: &mut Outcome) -> Result<Option<u64>, PlayError> {
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
}
