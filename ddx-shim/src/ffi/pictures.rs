//! Pictures of the server as the engine has them.
//!
//! The server's renderer gives libpixman the whole pixmap of a drawable, not the drawable: what lies around a window is read
//! as well, and images repeat at the edges of their pixmaps. With a transform the window's place goes into the transform.
//! The clip of a picture that is read is not looked at.

use std::ffi::c_int;

use super::exa;
use super::gc::boxes;
use super::screen::pixmap_of;
use super::server::{self, GlyphListPtr, GlyphPtr, INT16, PictFormatPtr, PicturePtr, ScreenPtr};
use crate::engine::compose::{Cover, Ink, Request, Sampled, Surface, finds_pixels};
use crate::engine::glyphs::Glyph;
use zga_abi::format::{ComposeOperator, PictureFormat, Repeat};
use zga_driver::Transform;

/// One in the 16.16 of transforms.
const ONE: i32 = 1 << 16;

/// The card's format of a picture; `None` for one that it does not have.
pub fn format(format: u32) -> Option<PictureFormat> {
    match format {
        server::PICT_a8r8g8b8 => Some(PictureFormat::Argb8888),
        server::PICT_x8r8g8b8 => Some(PictureFormat::Xrgb8888),
        server::PICT_a8b8g8r8 => Some(PictureFormat::Abgr8888),
        server::PICT_x8b8g8r8 => Some(PictureFormat::Xbgr8888),
        server::PICT_r5g6b5 => Some(PictureFormat::Rgb565),
        server::PICT_a8 => Some(PictureFormat::Alpha8),
        _ => None,
    }
}

/// The pixmap of a picture's drawable, and where the drawable's upper left lies in it.
///
/// # Safety
/// The picture is the server's, with a drawable.
unsafe fn surface(picture: PicturePtr, exa: exa::Functions) -> Option<(Surface, [i32; 2])> {
    // SAFETY: the caller vouches for it.
    unsafe {
        let drawable = (*picture).pDrawable.as_ref()?;
        let (pixmap, moved) = pixmap_of((*picture).pDrawable);
        let header = &pixmap.as_ref()?.drawable;
        let size = [header.width.into(), header.height.into()];
        let surface = Surface { pixmap: exa.number(pixmap)?, size, format: format((*picture).format)? };
        Some((surface, [i32::from(drawable.x) + moved[0], i32::from(drawable.y) + moved[1]]))
    }
}

/// What is drawn onto: the surface, and where the drawable's upper left lies in it. `None`: it is not the card's to do.
///
/// # Safety
/// The picture is the server's, with a drawable.
unsafe fn onto(picture: PicturePtr, exa: exa::Functions) -> Option<(Surface, [i32; 2])> {
    use PictureFormat::{Xbgr8888, Xrgb8888};
    // SAFETY: the caller vouches for it.
    unsafe {
        let (surface, corner) = surface(picture, exa)?;
        // Bits without a channel that other pictures of the same pixmap read as alpha: what the renderer leaves there depends on
        // the way it takes.
        let hidden = matches!(surface.format, Xrgb8888 | Xbgr8888) && (*(*picture).pDrawable).depth == 32;
        ((*picture).alphaMap.is_null() && !hidden).then_some((surface, corner))
    }
}

/// A transform of a picture, for pixels counted from the pixmap's corner; `None` for one that the card cannot do.
///
/// # Safety
/// The matrix is the server's.
unsafe fn transform(matrix: &server::PictTransform, corner: [i32; 2]) -> Option<Transform> {
    let [[xx, xy, x], [yx, yy, y], last] = matrix.matrix;
    let place = |way: i32, corner: i32| way.checked_add(corner.checked_mul(ONE)?);
    let (x0, y0) = (place(x, corner[0])?, place(y, corner[1])?);
    (last == [0, 0, ONE]).then_some(Transform { xx, xy, x0, yx, yy, y0 })
}

/// A picture that is read, at the place `at` of it for pixel `to` of the destination's pixmap. `None`: it is not the card's.
///
/// # Safety
/// The picture is the server's.
unsafe fn ink(picture: PicturePtr, at: [INT16; 2], to: [i32; 2], exa: exa::Functions) -> Option<Ink> {
    // SAFETY: the caller vouches for it; a picture without drawable has a source of its own, whose type says what it is.
    unsafe {
        if !(*picture).alphaMap.is_null() {
            return None;
        }
        if (*picture).pDrawable.is_null() {
            let source = (*picture).pSourcePict.as_ref()?;
            if source.type_ != server::SourcePictTypeSolidFill {
                return None;
            }
            let colour = source.solidFill.fullcolor;
            // The upper halves, as the renderer takes them.
            let halves = [colour.alpha, colour.red, colour.green, colour.blue].map(|channel| (channel >> 8) as u8);
            return Some(Ink::Colour(u32::from_be_bytes(halves)));
        }
        let (surface, corner) = surface(picture, exa)?;
        let moves = match (*picture).transform.as_ref() {
            Some(matrix) => Some(transform(matrix, corner)?),
            None => None,
        };
        let nearest = match (*picture).filter() {
            server::PictFilterNearest | server::PictFilterFast => true,
            server::PictFilterBilinear | server::PictFilterGood => finds_pixels(moves.as_ref()),
            _ => false,
        };
        if !nearest {
            return None;
        }
        let corner = if moves.is_some() { [0; 2] } else { corner };
        let mut offset = [0; 2];
        for axis in 0..2 {
            // The renderer has 16 bits for it.
            let from = i16::try_from(i32::from(at[axis]) + corner[axis]).ok()?;
            offset[axis] = i32::from(from) - to[axis];
        }
        // RepeatNone to RepeatReflect are numbered alike.
        let repeat = Repeat::from_code((*picture).repeatType())?;
        Some(Ink::Sampled(Sampled { surface, offset, repeat, transform: moves }))
    }
}

/// A composition: operator, source, mask with their places, and the place on the destination that these belong to.
pub struct Composite {
    pub operator: u8,
    pub source: (PicturePtr, [INT16; 2]),
    /// Null without.
    pub mask: (PicturePtr, [INT16; 2]),
    pub onto: (PicturePtr, [INT16; 2]),
}

impl Composite {
    /// As the engine has it, with the place on the destination's pixmap. `None`: it is not the card's to do.
    ///
    /// # Safety
    /// The pictures are the server's, validated; the clip lives for `'a`.
    pub unsafe fn request<'a>(&self, exa: exa::Functions) -> Option<(Request<'a>, [i32; 2])> {
        // SAFETY: the caller vouches for it.
        unsafe {
            let operator = ComposeOperator::from_code(self.operator.into())?;
            let (onto, corner) = onto(self.onto.0, exa)?;
            let to = [0, 1].map(|axis| i32::from(self.onto.1[axis]) + corner[axis]);
            let source = ink(self.source.0, self.source.1, to, exa)?;
            let mask = match self.mask.0.as_ref() {
                None => Cover::None,
                Some(picture) => {
                    let ink = ink(self.mask.0, self.mask.1, to, exa)?;
                    if picture.componentAlpha() != 0 { Cover::Components(ink) } else { Cover::Unified(ink) }
                }
            };
            let clips = boxes((*self.onto.0).pCompositeClip);
            let (_, moved) = pixmap_of((*self.onto.0).pDrawable);
            Some((Request { operator, source, mask, onto, clips, moved }, to))
        }
    }
}

/// The format of a mask that glyphs are added up in.
///
/// # Safety
/// The format is null or the server's.
pub unsafe fn mask_format(mask: PictFormatPtr) -> Option<Option<PictureFormat>> {
    // SAFETY: the caller vouches for it.
    match unsafe { mask.as_ref() } {
        None => Some(None),
        Some(mask) => format(mask.format).map(Some),
    }
}

/// Letters of a request, and their pixels: what there is to do, told without a look at their pictures.
///
/// # Safety
/// The lists and letters are the server's.
pub unsafe fn text_size(count: c_int, lists: GlyphListPtr, letters: *mut GlyphPtr) -> (u64, u64) {
    let (mut total, mut pixels) = (0, 0);
    // SAFETY: the caller vouches for it; there are as many letters as the lists say together.
    unsafe {
        for place in 0..usize::try_from(count).unwrap_or(0) {
            for _ in 0..(*lists.add(place)).len {
                let info = &(**letters.add(total)).info;
                total += 1;
                pixels += u64::from(info.width) * u64::from(info.height);
            }
        }
    }
    (total as u64, pixels)
}

/// The glyphs of a request, counted from the drawable's upper left, which is at `corner` of its pixmap. `None`: not the card's.
///
/// # Safety
/// The lists and letters are the server's, with at least one list.
pub unsafe fn glyphs(
    pscreen: ScreenPtr,
    corner: [i32; 2],
    count: c_int,
    lists: GlyphListPtr,
    letters: *mut GlyphPtr,
    exa: exa::Functions,
) -> Option<Vec<Glyph>> {
    let mut glyphs = Vec::new();
    let [mut x, mut y] = corner;
    let mut next = 0;
    // SAFETY: the caller vouches for it; there are as many letters as the lists say together.
    unsafe {
        for place in 0..usize::try_from(count).ok()? {
            let list = &*lists.add(place);
            x += i32::from(list.xOff);
            y += i32::from(list.yOff);
            for _ in 0..list.len {
                let letter = *letters.add(next);
                next += 1;
                let info = &(*letter).info;
                // A letter without pixels has no picture.
                let picture = server::GetGlyphPicture(letter, pscreen);
                if !picture.is_null() {
                    let (surface, _) = surface(picture, exa)?;
                    let [width, height] = surface.size.map(u16::try_from);
                    glyphs.push(Glyph {
                        pixmap: surface.pixmap,
                        x: x - i32::from(info.x),
                        y: y - i32::from(info.y),
                        width: width.ok()?,
                        height: height.ok()?,
                        format: surface.format,
                    });
                }
                x += i32::from(info.xOff);
                y += i32::from(info.yOff);
            }
        }
    }
    Some(glyphs)
}
