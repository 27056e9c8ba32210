//! MIP levels of a picture: each from the one before by a box filter.
//!
//! Level k has max(1, width >> k) times max(1, height >> k) texels. A texel of a level is the mean of the area
//! that it covers in the level before. An even side halves into pairs; the texels of an odd side of 2n + 1 do not, so
//! each of the n texels covers 2 + 1/n of them, parts at both ends weighed by what is covered. Red, green, blue and
//! alpha are averaged alike, to the nearest level, halves up: four whole texels give (a + b + c + d + 2) >> 2.

/// An RGBA picture, dense rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Level {
    /// Texels.
    pub size: [u32; 2],
    pub texels: Vec<[u8; 4]>,
}

/// Texels along a side of level `level`.
pub(super) const fn side(side: u32, level: u32) -> u32 {
    if side >> level == 0 { 1 } else { side >> level }
}

/// Levels down to one texel: 1 + floor(log2(the larger side)).
pub(super) fn levels(size: [u32; 2]) -> u32 {
    1 + size[0].max(size[1]).max(1).ilog2()
}

/// Texels of a side of `from` that texel `at` of a side of `to` covers: the first, and how much of each of three.
///
/// A texel of `from` weighs `to` where the whole of it is covered, so weights are integers and their sum is `from`.
fn covered(from: u32, to: u32, at: u32) -> (usize, [u64; 3]) {
    let (from, to, at) = (u64::from(from), u64::from(to), u64::from(at));
    let (begin, end) = (at * from, (at + 1) * from);
    let first = begin / to;
    let weights = [0, 1, 2].map(|next| {
        let texel = (first + next) * to;
        (texel + to).min(end).saturating_sub(texel.max(begin))
    });
    (first as usize, weights)
}

impl Level {
    /// The level after this one; `None` after one texel.
    pub fn next(&self) -> Option<Level> {
        let [width, height] = self.size;
        if width <= 1 && height <= 1 {
            return None;
        }
        let size = self.size.map(|from| side(from, 1));
        let columns: Vec<_> = (0..size[0]).map(|x| covered(width, size[0], x)).collect();
        let (area, stride) = (u64::from(width) * u64::from(height), width as usize);
        let mut texels = Vec::with_capacity(size[0] as usize * size[1] as usize);
        for y in 0..size[1] {
            let (top, down) = covered(height, size[1], y);
            for &(left, across) in &columns {
                let mut sums = [area / 2; 4];
                for (row, weight_y) in (top..).zip(down).filter(|(_, weight)| *weight > 0) {
                    for (column, weight_x) in (left..).zip(across).filter(|(_, weight)| *weight > 0) {
                        let weight = weight_x * weight_y;
                        for (sum, part) in sums.iter_mut().zip(self.texels[row * stride + column]) {
                            *sum += weight * u64::from(part);
                        }
                    }
                }
                // A mean of numbers up to 255, so the cast is exact.
                texels.push(sums.map(|sum| (sum / area) as u8));
            }
        }
        Some(Level { size, texels })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> Level {
        let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
        Level { size, texels }
    }

    /// One row of grey.
    fn row(values: &[u8]) -> Level {
        Level { size: [values.len() as u32, 1], texels: values.iter().map(|&v| [v; 4]).collect() }
    }

    fn greys(level: &Level) -> Vec<u8> {
        level.texels.iter().map(|texel| texel[0]).collect()
    }

    #[test]
    fn next_of_even_sides_is_the_rounded_mean_of_four() {
        // The benchmark texture S8, at a quarter of its size.
        let first = level([64, 64], |x, y| {
            let (x, y, odd) = (x as u8, y as u8, (x >> 4 ^ y >> 4) & 1 == 1);
            [if odd { x } else { 255 - x }, x ^ y, if odd { 255 - y } else { y }, 255]
        });
        let next = first.next().expect("a level");
        let expected = level([32, 32], |x, y| {
            let at = |x: u32, y: u32| first.texels[(y * 64 + x) as usize].map(u32::from);
            let four = [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
            std::array::from_fn(|c| ((four.iter().map(|texel| texel[c]).sum::<u32>() + 2) >> 2) as u8)
        });
        assert_eq!(next, expected);
    }

    #[test]
    fn next_of_odd_sides_weighs_parts_of_texels() {
        // 3 to 1: thirds. 100 + 101 + 103 = 304; 101 and a third.
        assert_eq!(greys(&row(&[100, 101, 103]).next().expect("a level")), [101]);
        // 5 to 2: 2.5 texels each: (0 + 10 + 200 / 2) / 2.5 = 44, (200 / 2 + 40 + 50) / 2.5 = 76.
        assert_eq!(greys(&row(&[0, 10, 200, 40, 50]).next().expect("a level")), [44, 76]);
        // 7 to 3: 7/3 each: (70 / 3) / (7/3) = 10, (70 * 2/3 + 140 * 2/3) / (7/3) = 60, (140 / 3) / (7/3) = 20.
        assert_eq!(greys(&row(&[0, 0, 70, 0, 140, 0, 0]).next().expect("a level")), [10, 60, 20]);
    }

    #[test]
    fn next_rounds_halves_up() {
        assert_eq!(greys(&row(&[1, 2]).next().expect("a level")), [2]);
        assert_eq!(greys(&row(&[0, 1]).next().expect("a level")), [1]);
    }

    #[test]
    fn next_of_one_colour_is_that_colour_for_every_size() {
        for size in [[1, 9], [9, 1], [2, 3], [5, 7], [6, 1], [31, 33], [16, 2]] {
            let mut at = level(size, |_, _| [3, 127, 254, 255]);
            let mut sizes = vec![at.size];
            while let Some(next) = at.next() {
                assert!(next.texels.iter().all(|texel| *texel == [3, 127, 254, 255]), "{size:?}");
                sizes.push(next.size);
                at = next;
            }
            assert_eq!(sizes.len() as u32, levels(size), "{sizes:?}");
            assert!((0..).zip(&sizes).all(|(k, at)| *at == size.map(|from| side(from, k))), "{sizes:?}");
        }
    }

    #[test]
    fn covered_weights_are_the_whole_side_shared_alike() {
        for from in 2..200_u32 {
            let to = side(from, 1);
            let mut whole = vec![0; from as usize];
            for at in 0..to {
                let (first, weights) = covered(from, to, at);
                assert_eq!(weights.iter().sum::<u64>(), u64::from(from));
                for (texel, weight) in (first..).zip(weights).filter(|(_, weight)| *weight > 0) {
                    whole[texel] += weight;
                }
            }
            assert!(whole.iter().all(|weight| *weight == u64::from(to)), "{from}");
        }
    }
}
