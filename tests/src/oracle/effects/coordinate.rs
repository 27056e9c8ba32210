//! Texture coordinates: what lies outside of the window, and which texel a coordinate is in.
//!
//! The window is `0..1` of a coordinate. A coordinate is repeated, mirrored or limited first, then multiplied by the
//! window's size at the level; the *exact* texel coordinate is rounded to 1/256 texel, the *ideal* one is not.

use super::texel::{Texture, extent};

/// What a texture does with coordinates outside of its window, on one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The edge goes on.
    Clamp,
    /// Again and again.
    Repeat,
    /// Again and again, every other time mirrored.
    Mirror,
}

/// How the flags of an axis read: mirror implies repetition.
#[must_use]
pub const fn wrap_of(repeat: bool, mirror: bool) -> Wrap {
    match (mirror, repeat) {
        (true, _) => Wrap::Mirror,
        (false, true) => Wrap::Repeat,
        (false, false) => Wrap::Clamp,
    }
}

impl Wrap {
    /// The coordinate within one period, or within -1 to 2. What is no number is 0.
    #[must_use]
    pub fn reduce(self, u: f64) -> f64 {
        let u = if u.is_nan() { 0.0 } else { u };
        let reduced = match self {
            Self::Clamp => u.clamp(-1.0, 2.0),
            Self::Repeat => u - u.floor(),
            Self::Mirror => u - 2.0 * (u / 2.0).floor(),
        };
        if reduced.is_finite() { reduced } else { 0.0 }
    }

    /// The texel of the window that index `i` stands for.
    #[must_use]
    pub fn index(self, i: i64, size: u32) -> u32 {
        let size = i64::from(size);
        let index = match self {
            Self::Clamp => i.clamp(0, size - 1),
            Self::Repeat => i.rem_euclid(size),
            Self::Mirror => {
                let m = i.rem_euclid(2 * size);
                if m < size { m } else { 2 * size - 1 - m }
            }
        };
        index as u32
    }
}

/// The window of one axis at one level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// First texel.
    pub offset: u32,
    /// Texels.
    pub size: u32,
    /// Outside.
    pub wrap: Wrap,
}

impl Axis {
    /// Axis 0 (x) or 1 (y) of a texture at a level.
    #[must_use]
    pub fn of(texture: &Texture, axis: usize, level: u32) -> Self {
        let whole = extent(texture.levels[0].size, level)[axis];
        let offset = (texture.offset[axis] >> level).min(whole - 1);
        let size = (texture.window[axis] >> level).max(1).min(whole - offset);
        Self { offset, size, wrap: wrap_of(texture.repeat[axis], texture.mirror[axis]) }
    }

    /// Texel coordinate in 1/256 texel.
    #[must_use]
    pub fn exact(&self, u: f64) -> i64 {
        (self.wrap.reduce(u) * f64::from(self.size) * 256.0 + 0.5).floor() as i64
    }

    /// Texel coordinate, unrounded.
    #[must_use]
    pub fn ideal(&self, u: f64) -> f64 {
        self.wrap.reduce(u) * f64::from(self.size)
    }

    /// Column or row of the level that index `i` stands for.
    #[must_use]
    pub fn texel(&self, i: i64) -> u32 {
        self.offset + self.wrap.index(i, self.size)
    }
}

#[cfg(test)]
mod tests {
    use super::super::texel::{Filter, Format, Level};
    use super::*;
    use proptest::prelude::*;

    const ALL: [Wrap; 3] = [Wrap::Clamp, Wrap::Repeat, Wrap::Mirror];

    fn texture(size: [u32; 2], offset: [u32; 2], window: [u32; 2], levels: u32) -> Texture {
        let level = |k| Level { size: extent(size, k), texels: vec![] };
        Texture {
            format: Format::Rgba8888,
            levels: (0..levels).map(level).collect(),
            offset,
            window,
            repeat: [false; 2],
            mirror: [false; 2],
            filter: Filter::Nearest,
            function: 0,
            constant: [0; 4],
            bias: 0,
            mip_map: true,
        }
    }

    #[test]
    fn index_three_texels_outside_both_sides_follow_the_rule() {
        let indices = |wrap: Wrap| [-4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6].map(|i| wrap.index(i, 3));

        assert_eq!(indices(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(indices(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(indices(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }

    #[test]
    fn reduce_numbers_that_are_none_are_texels_all_the_same() {
        assert_eq!(ALL.map(|wrap| wrap.reduce(f64::NAN)), [0.0; 3]);
        assert_eq!(ALL.map(|wrap| wrap.reduce(f64::INFINITY)), [2.0, 0.0, 0.0]);
        assert_eq!(ALL.map(|wrap| wrap.reduce(f64::NEG_INFINITY)), [-1.0, 0.0, 0.0]);
        assert_eq!(ALL.map(|wrap| wrap.reduce(-1.0e300)), [-1.0, 0.0, 0.0]);
    }

    #[test]
    fn of_window_shrinks_with_the_levels_and_stays_inside() {
        let texture = texture([20, 8], [13, 7], [7, 1], 5);
        let x = [0, 1, 2, 3, 4].map(|k| Axis::of(&texture, 0, k)).map(|axis| (axis.offset, axis.size));
        let y = [0, 1, 2, 3, 4].map(|k| Axis::of(&texture, 1, k)).map(|axis| (axis.offset, axis.size));

        assert_eq!(x, [(13, 7), (6, 3), (3, 1), (1, 1), (0, 1)]);
        assert_eq!(y, [(7, 1), (3, 1), (1, 1), (0, 1), (0, 1)]);
    }

    #[test]
    fn exact_halves_of_256ths_go_up() {
        let axis = Axis { offset: 0, size: 4, wrap: Wrap::Clamp };
        let at = |t: f64| axis.exact(t / 1024.0);

        assert_eq!([-0.5, 0.49, 0.5, 1.5, 1023.5].map(at), [0, 0, 1, 2, 1024]);
    }

    proptest! {
        #[test]
        fn reduce_then_index_is_the_index_of_the_whole_coordinate(
            u in -50_000_i32..50_000, size in 1_u32..40, kind in 1_usize..3,
        ) {
            // Eighths of a texel in f64 are exact as long as they are not rounded by the division.
            let size = size.next_power_of_two();
            let (wrap, t) = (ALL[kind], f64::from(u) / 8.0);
            let axis = Axis { offset: 3, size, wrap };

            let reduced = axis.exact(t / f64::from(size)) >> 8;

            prop_assert_eq!(axis.texel(reduced), 3 + wrap.index(t.floor() as i64, size));
        }

        #[test]
        fn texel_any_coordinate_is_inside(u in any::<f64>(), size in 1_u32..=16384, kind in 0_usize..3) {
            let axis = Axis { offset: 5, size, wrap: ALL[kind] };
            let texel = axis.texel(axis.exact(u) >> 8);

            prop_assert!((5..5 + size).contains(&texel));
            prop_assert!((axis.exact(u) as f64 / 256.0 - axis.ideal(u)).abs() <= 1.0 / 512.0 + 1.0e-9);
        }
    }
}
