//! The few functions of libpixman that are needed, and the pixels of a pixmap of the engine: all of this example that is unsafe.

use std::ffi::c_int;
use std::marker::PhantomData;

/// pixman_image_t, which only the library looks into.
#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

/// pixman_color_t: a colour of 16 bits a channel.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Colour {
    pub red: u16,
    pub green: u16,
    pub blue: u16,
    pub alpha: u16,
}

#[link(name = "pixman-1")]
unsafe extern "C" {
    fn pixman_image_create_bits(format: u32, width: c_int, height: c_int, bits: *mut u32, stride: c_int)
    -> *mut Opaque;
    fn pixman_image_create_solid_fill(colour: *const Colour) -> *mut Opaque;
    fn pixman_image_unref(image: *mut Opaque) -> c_int;
    fn pixman_image_set_repeat(image: *mut Opaque, repeat: u32);
    fn pixman_image_set_component_alpha(image: *mut Opaque, components: c_int);
    fn pixman_image_set_filter(image: *mut Opaque, filter: u32, parameters: *const i32, count: c_int) -> c_int;
    fn pixman_image_set_transform(image: *mut Opaque, matrix: *const [[i32; 3]; 3]) -> c_int;
    fn pixman_image_composite32(
        operator: u32,
        source: *mut Opaque,
        mask: *mut Opaque,
        onto: *mut Opaque,
        source_x: i32,
        source_y: i32,
        mask_x: i32,
        mask_y: i32,
        x: i32,
        y: i32,
        width: i32,
        height: i32,
    );
}

/// An image of the library, on words of the caller.
pub struct Image<'w> {
    image: *mut Opaque,
    words: PhantomData<&'w mut [u32]>,
}

/// How an image is read.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    pub repeat: u32,
    pub filter: u32,
    pub components: bool,
    pub matrix: Option<[[i32; 3]; 3]>,
}

impl<'w> Image<'w> {
    /// An image of rows of `stride` words.
    pub fn bits(format: u32, [width, height]: [u32; 2], words: &'w mut [u32], stride: usize) -> Image<'w> {
        let bits = format >> 24;
        assert!(words.len() >= stride * height as usize && stride * 32 >= (bits * width) as usize);
        let (width, height, stride) = (width as c_int, height as c_int, 4 * stride as c_int);
        // SAFETY: the words hold the rows, as was looked at, and are borrowed as long as the image lives.
        let image = unsafe { pixman_image_create_bits(format, width, height, words.as_mut_ptr(), stride) };
        assert!(!image.is_null(), "libpixman refuses an image of format {format:#x}");
        Image { image, words: PhantomData }
    }

    /// One colour everywhere.
    pub fn solid(colour: Colour) -> Image<'static> {
        // SAFETY: the library copies the colour.
        let image = unsafe { pixman_image_create_solid_fill(&raw const colour) };
        assert!(!image.is_null(), "libpixman refuses a colour");
        Image { image, words: PhantomData }
    }

    /// Sets how it is read.
    pub fn read_as(&mut self, reading: &Reading) {
        // SAFETY: the image lives; the library copies the matrix; these filters have no parameters.
        unsafe {
            pixman_image_set_repeat(self.image, reading.repeat);
            pixman_image_set_component_alpha(self.image, reading.components.into());
            pixman_image_set_filter(self.image, reading.filter, std::ptr::null(), 0);
            if let Some(matrix) = &reading.matrix {
                pixman_image_set_transform(self.image, matrix);
            }
        }
    }

    /// Composes a source, through a mask if there is one, onto this image.
    pub fn compose(
        &mut self,
        operator: u32,
        source: (&Image<'_>, [i32; 2]),
        mask: Option<(&Image<'_>, [i32; 2])>,
        [x, y]: [i32; 2],
        [width, height]: [i32; 2],
    ) {
        let (from, [source_x, source_y]) = source;
        let (mask, [mask_x, mask_y]) = mask.map_or((std::ptr::null_mut(), [0; 2]), |(mask, at)| (mask.image, at));
        // SAFETY: all images live, with their words; a mask may be null. The library keeps to the images' sizes.
        unsafe {
            pixman_image_composite32(
                operator, from.image, mask, self.image, source_x, source_y, mask_x, mask_y, x, y, width, height,
            );
        }
    }
}

impl Drop for Image<'_> {
    fn drop(&mut self) {
        // SAFETY: it was made here, and this is its one reference.
        unsafe { pixman_image_unref(self.image) };
    }
}

/// The words of a pixmap that is open to this program.
pub fn words(address: *const u8, count: usize) -> Vec<u32> {
    // SAFETY: the engine gave the address of a pixmap's rows, whole words, as many as its pitch and height say, and keeps the card
    // away from them until the access ends, which is later.
    unsafe { std::slice::from_raw_parts(address.cast::<u32>(), count).to_vec() }
}
