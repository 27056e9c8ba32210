//! The stencil test and the shadow bit, by their rules alone.
//!
//! A fragment that covers a pixel and is no hole is compared first by the stencil test, reference against stored value
//! through the read mask, then by the depth test. One of three operations follows: for failing the first, for failing the
//! second, for passing both; it changes the bits of the write mask. Operations are those of the side that is seen: of a
//! triangle the front, where its vertices run counter-clockwise on the screen, or the back; of anything else the front.

use super::{DepthFunction, Primitive};

/// What becomes of a stored value; the place in [`Operation::ALL`] is the register's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// It stays.
    Keep,
    /// 0.
    Zero,
    /// The reference.
    Replace,
    /// One more, 255 at most.
    Increment,
    /// One less, 0 at least.
    Decrement,
    /// All bits change.
    Invert,
    /// One more, modulo 256.
    IncrementWrap,
    /// One less, modulo 256.
    DecrementWrap,
}

impl Operation {
    /// All eight.
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::Increment,
        Self::Decrement,
        Self::Invert,
        Self::IncrementWrap,
        Self::DecrementWrap,
    ];

    fn of(self, stored: i32, reference: i32) -> i32 {
        match self {
            Self::Keep => stored,
            Self::Zero => 0,
            Self::Replace => reference,
            Self::Increment => (stored + 1).min(255),
            Self::Decrement => (stored - 1).max(0),
            Self::Invert => 255 - stored,
            Self::IncrementWrap => (stored + 1).rem_euclid(256),
            Self::DecrementWrap => (stored - 1).rem_euclid(256),
        }
    }
}

/// State of a stencil test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stencil {
    /// Reference FUNCTION stored value.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits compared.
    pub read_mask: u8,
    /// Bits changed.
    pub write_mask: u8,
    /// On a stencil fail, on a depth fail, on a pass, where the front is seen.
    pub front: [Operation; 3],
    /// The same for the back.
    pub back: [Operation; 3],
    /// Pixels that pass get a colour.
    pub colours: bool,
}

impl Stencil {
    /// Whether a fragment is drawn to a pixel that holds `stored`, and what the pixel holds then.
    #[must_use]
    pub fn outcome(&self, front: bool, stored: u8, depth_passes: bool) -> (bool, u8) {
        let stencil_passes = self.function.passes(&(self.reference & self.read_mask), &(stored & self.read_mask));
        let place = match (stencil_passes, depth_passes) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        let operation = if front { self.front[place] } else { self.back[place] };
        let new = operation.of(i32::from(stored), i32::from(self.reference)) as u8;
        (place == 2, stored & !self.write_mask | new & self.write_mask)
    }
}

/// Whether the front of a primitive is seen: the shoelace sum of a triangle's vertices, y down, is negative.
#[must_use]
pub fn shows_front(primitive: &Primitive) -> bool {
    match primitive {
        Primitive::Triangle(v) => {
            let cross =
                |a: usize, b: usize| i128::from(v[a].x) * i128::from(v[b].y) - i128::from(v[b].x) * i128::from(v[a].y);
            cross(0, 1) + cross(1, 2) + cross(2, 0) < 0
        }
        Primitive::Line(_) | Primitive::Point(_) => true,
    }
}

/// The shadow bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shadow {
    /// Reference FUNCTION stored value.
    pub function: DepthFunction,
    /// Reference.
    pub reference: u8,
    /// Bits compared.
    pub mask: u8,
    /// What is left of a channel, of 255.
    pub intensity: u8,
}

impl Shadow {
    /// Whether a pixel that holds `stored` lies in shadow.
    #[must_use]
    pub fn falls_on(&self, stored: u8) -> bool {
        self.function.passes(&(self.reference & self.mask), &(stored & self.mask))
    }

    /// A channel in shadow: the level nearest to level * intensity / 255.
    #[must_use]
    pub fn darken(&self, level: u8) -> u8 {
        let product = i64::from(level) * i64::from(self.intensity);
        (0..=255_u8).min_by_key(|&new| (255 * i64::from(new) - product).abs()).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Vertex;
    use super::*;

    const COUNT: Stencil = Stencil {
        function: DepthFunction::Always,
        reference: 0x35,
        read_mask: 255,
        write_mask: 255,
        front: [Operation::Keep; 3],
        back: [Operation::Keep; 3],
        colours: true,
    };

    #[test]
    fn outcome_every_operation_matches_the_table() {
        // Of 0, 1, 254, 255.
        let table = Operation::ALL.map(|operation| {
            let stencil = Stencil { front: [operation; 3], ..COUNT };
            [0, 1, 254, 255].map(|stored| stencil.outcome(true, stored, true).1)
        });
        let expected = [
            [0, 1, 254, 255],
            [0, 0, 0, 0],
            [0x35; 4],
            [1, 2, 255, 255],
            [0, 0, 253, 254],
            [255, 254, 1, 0],
            [1, 2, 255, 0],
            [255, 0, 253, 254],
        ];
        assert_eq!(table, expected);
    }

    #[test]
    fn outcome_masks_bound_what_is_compared_and_what_changes() {
        let stencil = Stencil { function: DepthFunction::Equal, read_mask: 0x0F, write_mask: 0x30, ..COUNT };
        let stencil = Stencil { back: [Operation::Zero, Operation::Invert, Operation::Replace], ..stencil };
        assert_eq!(stencil.outcome(false, 0xF5, true), (true, 0xF5), "0x35 into bits 5:4 of 0xF5");
        assert_eq!(stencil.outcome(false, 0xC5, true), (true, 0xF5));
        assert_eq!(stencil.outcome(false, 0xF5, false), (false, 0xC5));
        assert_eq!(stencil.outcome(false, 0xF4, true), (false, 0xC4));
        assert_eq!(stencil.outcome(true, 0xF4, true), (false, 0xF4), "the front keeps");
    }

    #[test]
    fn shows_front_of_a_triangle_that_runs_counter_clockwise_on_the_screen() {
        // y goes down: from the top left down, then right.
        let [a, b, c] = [(0, 0), (0, 9), (9, 9)].map(|(x, y)| Vertex::at(x, y, 0));
        assert!(shows_front(&Primitive::Triangle([a, b, c])));
        assert!(!shows_front(&Primitive::Triangle([a, c, b])));
        assert!(shows_front(&Primitive::Line([a, b])) && shows_front(&Primitive::Point(c)));
    }

    #[test]
    fn darken_rounds_to_the_nearest_level() {
        let shadow = Shadow { function: DepthFunction::NotEqual, reference: 0, mask: 255, intensity: 128 };
        assert_eq!([0, 1, 2, 254, 255].map(|level| shadow.darken(level)), [0, 1, 1, 127, 128]);
        assert_eq!(Shadow { intensity: 255, ..shadow }.darken(77), 77);
        assert!(shadow.falls_on(3) && !shadow.falls_on(0));
    }
}
