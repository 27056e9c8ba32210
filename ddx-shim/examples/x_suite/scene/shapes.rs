//! What requests are made with: pictures, colours, matrices, shapes, each from random numbers.

use x11rb::protocol::render::{Color, Pointfix, Transform, Trapezoid};

use super::super::random::Random;
use super::{Origin, PIXELS, Surface};

pub(super) fn pictures(surfaces: &[Surface], random: &mut Random) -> Vec<Origin> {
    let mut pictures = Vec::new();
    for (on, surface) in surfaces.iter().enumerate() {
        for (format, (depth, ..)) in PIXELS.iter().enumerate() {
            let fits = match format {
                // What is premultiplied with alpha in one byte is not with alpha in another.
                0 | 1 => (format == 1) == surface.is_reversed() && !surface.is_without_alpha(),
                7 => surface.is_without_alpha(),
                // Windows are read in the format of their visual alone.
                3 => surface.window.is_none(),
                _ => true,
            };
            if *depth == surface.depth && fits {
                pictures.push(Origin::Surface(on, format));
            }
        }
    }
    pictures.extend((0..4).map(|_| Origin::Solid(colour(random))));
    let mut place = || random.between(-20, 200);
    pictures.push(Origin::Linear([place(), place(), place(), place()]));
    pictures.push(Origin::Radial([place(), place(), 90]));
    pictures
}

/// A premultiplied colour.
pub(super) fn colour(random: &mut Random) -> Color {
    let any = random.bits() as u16;
    let alpha = random.of(&[0xFFFF, 0xFFFF, 0x8080, 0x1234, 0, any]);
    let mut channel = || (u32::from(random.bits() as u16) * u32::from(alpha) / 0xFFFF) as u16;
    Color { red: channel(), green: channel(), blue: channel(), alpha }
}

/// A number of pixels in 16.16, somewhere in the pixel.
pub(super) fn fixed(pixels: i16, random: &mut Random) -> i32 {
    (i32::from(pixels) << 16) + random.below(1 << 16) as i32
}

pub(super) fn matrix(random: &mut Random) -> Transform {
    let one = 1 << 16;
    let identity = Transform {
        matrix11: one,
        matrix12: 0,
        matrix13: 0,
        matrix21: 0,
        matrix22: one,
        matrix23: 0,
        matrix31: 0,
        matrix32: 0,
        matrix33: one,
    };
    let shift = |random: &mut Random| random.between(-30 * one, 30 * one);
    match random.below(6) {
        0 => identity,
        4 => {
            // A half or a quarter round.
            let [a, b] = random.of(&[[-one, 0], [0, one], [0, -one]]);
            let (x, y) = (shift(random), shift(random));
            Transform { matrix11: a, matrix12: b, matrix13: x, matrix21: -b, matrix22: a, matrix23: y, ..identity }
        }
        5 => {
            // Moved by parts of a pixel, among them those where one ends and the next begins.
            let mut way = || random.between(-60, 60) * one / 2 + random.between(-1, 1);
            Transform { matrix13: way(), matrix23: way(), ..identity }
        }
        1 => Transform { matrix13: random.between(-30, 30) << 16, matrix23: random.between(-30, 30) << 16, ..identity },
        2 => {
            let mut scale = || random.between(one / 4, 3 * one);
            Transform { matrix11: scale(), matrix22: scale(), ..identity }
        }
        _ => {
            let mut any = || random.between(-one, one);
            let [a, b, c, d] = [any(), any(), any(), any()];
            Transform {
                matrix11: a,
                matrix12: b,
                matrix13: shift(random),
                matrix21: c,
                matrix22: d,
                matrix23: shift(random),
                ..identity
            }
        }
    }
}

pub(super) fn trapezoid([x, y]: [i16; 2], random: &mut Random) -> Trapezoid {
    let (top, height) = (fixed(y, random), random.between(1, 60) << 16);
    let bottom = top + height;
    let mut edge = |around: i16| {
        let [from, to] = [0, 1].map(|_| fixed(around + random.between(-15, 15) as i16, random));
        x11rb::protocol::render::Linefix { p1: Pointfix { x: from, y: top }, p2: Pointfix { x: to, y: bottom } }
    };
    Trapezoid { top, bottom, left: edge(x), right: edge(x + 40) }
}
