//! Address generator, first half: coordinates become texels of a level's window.
//!
//! Duties: repeats, mirrors or clamps; finds texels and the fractions between them, to 1/256 texel. Inputs from: u and v
//! at the place shaded. Outputs to: the texture memory. Clocks: none of its own.
//!
//! What is left of a coordinate after repetition is a small number, so it is rounded to 1/256 texel once, however far
//! out it was; from there on all is integers. Texel coordinates T are s23.8, and lie within -1 and 2 windows.

/// Pixels of a chunk.
pub const LANES: usize = 16;

/// What lies outside the window along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The texel at the edge.
    Clamp,
    /// The window again.
    Repeat,
    /// The window again, every other time the other way round.
    Mirror,
}

/// Integers within +-2^31 come to stand in the low word of this sum: 1.5 * 2^52.
const LOW_WORD: f64 = 6_755_399_441_055_744.0;

/// An integer of less than 31 bits. Plain casts have to look for those that do not fit.
#[must_use]
#[inline(always)]
pub fn to_integer(x: f64) -> i32 {
    (x + LOW_WORD).to_bits() as i32
}

impl Wrap {
    /// From the flags of an axis; mirroring implies repetition.
    #[must_use]
    pub fn new(repeat: bool, mirror: bool) -> Wrap {
        match (repeat, mirror) {
            (_, true) => Wrap::Mirror,
            (true, false) => Wrap::Repeat,
            (false, false) => Wrap::Clamp,
        }
    }

    /// The coordinate without repetitions: 0..=1 if repeated, 0..=2 if mirrored, -1..=2 if clamped. What is not a number
    /// counts as 0, as does an infinity that is repeated.
    #[must_use]
    #[inline(always)]
    pub fn reduce(self, u: f64) -> f64 {
        let u = if u.is_nan() { 0.0 } else { u };
        let reduced = match self {
            Wrap::Clamp => u.clamp(-1.0, 2.0),
            Wrap::Repeat => u - u.floor(),
            Wrap::Mirror => u - 2.0 * (u / 2.0).floor(),
        };
        if reduced.is_finite() { reduced } else { 0.0 }
    }

    /// [`Wrap::reduce`] of 16 pixels.
    #[must_use]
    #[inline(always)]
    pub fn reduce_lanes(self, u: &[f64; LANES]) -> [f64; LANES] {
        let mut reduced = [0.0; LANES];
        match self {
            Wrap::Clamp => each(&mut reduced, |i| Wrap::Clamp.reduce(u[i])),
            Wrap::Repeat => each(&mut reduced, |i| Wrap::Repeat.reduce(u[i])),
            Wrap::Mirror => each(&mut reduced, |i| Wrap::Mirror.reduce(u[i])),
        }
        reduced
    }

    /// Texel `index`, any integer, as one of the window's `size`: the specification.
    #[must_use]
    pub fn wrapped(self, index: i32, size: i32) -> i32 {
        match self {
            Wrap::Clamp => index.clamp(0, size - 1),
            Wrap::Repeat => index.rem_euclid(size),
            Wrap::Mirror => {
                let m = index.rem_euclid(2 * size);
                if m < size { m } else { 2 * size - 1 - m }
            }
        }
    }

    /// Texels of 16 pixels at reduced coordinates `place`; `scale` and `size` are those of each pixel's level.
    #[must_use]
    #[inline(always)]
    pub fn nearest_lanes(self, place: &[f64; LANES], scale: &[f64; LANES], size: &[i32; LANES]) -> [i32; LANES] {
        let mut texel = [0; LANES];
        let index = |i: usize| coordinate(place[i], scale[i]) >> 8;
        match self {
            Wrap::Clamp => each(&mut texel, |i| index(i).max(0).min(size[i].wrapping_sub(1))),
            // The window's end, where rounding reached it, is its beginning.
            Wrap::Repeat => each(&mut texel, |i| if index(i) < size[i] { index(i) } else { 0 }),
            Wrap::Mirror => each(&mut texel, |i| {
                let back = size[i].wrapping_mul(2).wrapping_sub(1).wrapping_sub(index(i)).max(0);
                if index(i) < size[i] { index(i) } else { back }
            }),
        }
        texel
    }

    /// The first of the two neighbouring texels that each of 16 pixels lies between, -1..size, and the weight of the
    /// second, 0..=256, in a window with a frame of one texel (see [`super::memory`]).
    ///
    /// A mirrored window is walked backwards every other time: the first texel is the second one then, and the weights
    /// change places.
    #[must_use]
    #[inline(always)]
    pub fn pair_lanes(
        self,
        place: &[f64; LANES],
        scale: &[f64; LANES],
        size: &[i32; LANES],
    ) -> ([i32; LANES], [u32; LANES]) {
        let mut between = [0; LANES];
        each(&mut between, |i| coordinate(place[i], scale[i]).wrapping_sub(128));
        let (mut first, mut weight) = ([0; LANES], [0; LANES]);
        each(&mut weight, |i| (between[i] & 255) as u32);
        let index = |i: usize| between[i] >> 8;
        match self {
            Wrap::Clamp => each(&mut first, |i| index(i).max(-1).min(size[i].wrapping_sub(1))),
            Wrap::Repeat => each(&mut first, |i| index(i).wrapping_add(if index(i) < 0 { size[i] } else { 0 })),
            Wrap::Mirror => {
                each(&mut first, |i| {
                    let back = size[i].wrapping_mul(2).wrapping_sub(2).wrapping_sub(index(i));
                    if index(i) < size[i] { index(i) } else { back }
                });
                let forward = weight;
                each(&mut weight, |i| {
                    let back = 256_u32.wrapping_sub(forward[i]);
                    if index(i) < size[i] { forward[i] } else { back }
                });
            }
        }
        (first, weight)
    }
}

/// Texel coordinate, s23.8, of a reduced coordinate; `scale` is the window's size in 1/256 texels.
#[must_use]
#[inline(always)]
pub fn coordinate(place: f64, scale: f64) -> i32 {
    to_integer((place * scale + 0.5).floor())
}

/// Sets all lanes.
#[inline(always)]
fn each<T>(lanes: &mut [T; LANES], value: impl Fn(usize) -> T) {
    for (i, lane) in lanes.iter_mut().enumerate() {
        *lane = value(i);
    }
}
