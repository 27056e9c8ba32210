//! What the variants cost: adders, comparators, register bits and gates of one element, and of N.
//!
//! # The gate model
//! A count of two-input NAND gates (an inverter counts as one), from text-book circuits. The constants are
//! assumptions, not measurements of any process; they serve to compare variants with each other.
//!
//! | part | gates | circuit |
//! | --- | --- | --- |
//! | full adder | 9 | the nine-NAND full adder |
//! | comparator bit | 6 | the carry of that adder alone: four of its NANDs make the first sum, two more the carry |
//! | D flip-flop, edge-triggered | 6 | the six-NAND flip-flop of the 7474 without set and clear |
//! | 2:1 multiplexer | 4 | three NANDs and an inverter, the inverter counted in every bit |
//! | AND or OR of two bits | 2 | NAND and inverter |
//!
//! A register that can keep its value has a multiplexer in front of it; one that can be set or cleared has one
//! AND or OR more a bit. Clock distribution and wires count nothing.
//!
//! # What is counted
//! *Published array*: ports A and B and one CTRL bit, IN, Zb, Ib. The one adder does everything: its second
//! operand is -1, dZ, nothing or the complement of Zb, its carry is the borrow of T1 and the comparison of
//! T3. The timing comes from a clock with three phases.
//!
//! *Our array* adds two bits that name the beat, the outcomes that pass and the write bits on CTRL, an
//! equality test, a second bit with Ib (is it a tag?), and the clamp: port C and two comparators and
//! multiplexers, listed apart because the published array has nothing like it. Values have two guard bits above
//! the depth, enough for every overshoot of a plane within its primitive.
//!
//! *Super Buffer*: a token all of whose fields are registers at once, the element's own number (wired, no
//! register), two range comparators, a depth comparator, an adder, and the pipeline that flows back.

use zga_abi::format::{EndTest, TokenPorts};

/// Gates of a full adder.
pub const FULL_ADDER: u64 = 9;
/// Gates of one bit of a comparator of magnitudes.
pub const COMPARATOR_BIT: u64 = 6;
/// Gates of an edge-triggered flip-flop.
pub const FLIP_FLOP: u64 = 6;
/// Gates of a 2:1 multiplexer.
pub const MULTIPLEXER: u64 = 4;
/// Gates of an AND or OR of two bits.
pub const LOGIC: u64 = 2;

/// Bits above the depth that our values have.
const GUARD: u64 = 2;
/// CTRL of our array beyond the published bit: two for the beat, three outcomes, two write bits, and one more
/// for the kind of I. (The model keeps them apart by beat in 11 bits; wires that one beat leaves free serve
/// the others, as the published bit does.)
const OUR_CONTROL: u64 = 8;

/// Widths that costs are functions of, bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Widths {
    /// A depth.
    pub depth: u32,
    /// Fraction of Z.
    pub fraction: u32,
    /// X and dX; 2 to this power is at least the number of elements.
    pub coordinate: u32,
    /// A colour or tag.
    pub colour: u32,
}

/// What can be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// The array as published.
    Published(TokenPorts, EndTest),
    /// The array with what the card needs for one picture on every path.
    Ours(TokenPorts, EndTest),
    /// The earlier design, compared with `<`, without a clamp.
    SuperBuffer,
}

impl Variant {
    /// All of them.
    pub const ALL: [Variant; 9] = {
        use {EndTest as E, TokenPorts as P, Variant as V};
        [
            V::Published(P::Swapped, E::Negative),
            V::Published(P::Swapped, E::Zero),
            V::Published(P::Merged, E::Negative),
            V::Published(P::Merged, E::Zero),
            V::Ours(P::Swapped, E::Negative),
            V::Ours(P::Swapped, E::Zero),
            V::Ours(P::Merged, E::Negative),
            V::Ours(P::Merged, E::Zero),
            V::SuperBuffer,
        ]
    };

    /// The name in reports.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Variant::Published(ports, test) => format!("published, {}, {}", ports.name(), test.name()),
            Variant::Ours(ports, test) => format!("ours, {}, {}", ports.name(), test.name()),
            Variant::SuperBuffer => "Super Buffer".into(),
        }
    }
}

/// Parts of one element, or of several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Adders.
    pub adders: u64,
    /// Bits of all adders.
    pub adder_bits: u64,
    /// Comparators of magnitudes.
    pub comparators: u64,
    /// Bits of all comparators.
    pub comparator_bits: u64,
    /// Flip-flops.
    pub register_bits: u64,
    /// Bits of 2:1 multiplexers.
    pub multiplexer_bits: u64,
    /// Two-input ANDs and ORs.
    pub logic: u64,
}

impl Cost {
    /// All of it in gates.
    #[must_use]
    pub const fn gates(&self) -> u64 {
        FULL_ADDER * self.adder_bits
            + COMPARATOR_BIT * self.comparator_bits
            + FLIP_FLOP * self.register_bits
            + MULTIPLEXER * self.multiplexer_bits
            + LOGIC * self.logic
    }

    /// `count` elements.
    #[must_use]
    pub const fn times(&self, count: u64) -> Cost {
        Cost {
            adders: count * self.adders,
            adder_bits: count * self.adder_bits,
            comparators: count * self.comparators,
            comparator_bits: count * self.comparator_bits,
            register_bits: count * self.register_bits,
            multiplexer_bits: count * self.multiplexer_bits,
            logic: count * self.logic,
        }
    }

    /// Both.
    #[must_use]
    pub const fn plus(&self, other: &Cost) -> Cost {
        Cost {
            adders: self.adders + other.adders,
            adder_bits: self.adder_bits + other.adder_bits,
            comparators: self.comparators + other.comparators,
            comparator_bits: self.comparator_bits + other.comparator_bits,
            register_bits: self.register_bits + other.register_bits,
            multiplexer_bits: self.multiplexer_bits + other.multiplexer_bits,
            logic: self.logic + other.logic,
        }
    }
}

/// One element of `variant`, clamp included.
#[must_use]
pub fn element(variant: Variant, widths: &Widths) -> Cost {
    let [depth, fraction, colour] = [widths.depth, widths.fraction, widths.colour].map(u64::from);
    match variant {
        Variant::Published(ports, test) => array(ports, test, widths, depth + fraction),
        Variant::Ours(ports, test) => {
            let value = depth + fraction + GUARD;
            let more = Cost {
                register_bits: OUR_CONTROL + 1,
                // The kind of Ib is kept and cleared as Ib is.
                multiplexer_bits: 1,
                // Equality: Z and Zb differ nowhere; three outcomes against three bits; two write enables.
                logic: 2 * depth + 5 + 2 + 1,
                ..Cost::default()
            };
            array(ports, test, widths, value).plus(&more).plus(&clamp(widths))
        }
        Variant::SuperBuffer => {
            let coordinate = u64::from(widths.coordinate);
            let token = 2 * coordinate + 2 * (depth + fraction) + colour + 2;
            let back = colour + 1;
            Cost {
                adders: 1,
                adder_bits: depth + fraction,
                comparators: 3,
                comparator_bits: 2 * coordinate + depth,
                register_bits: token + back + depth + colour,
                // Zb and Ib keep their values; the way back takes Ib or its neighbour.
                multiplexer_bits: depth + 2 * colour,
                // dZ only inside; Zb is set and Ib cleared; inside, nearer.
                logic: depth + fraction + depth + colour + 3,
            }
        }
    }
}

/// The share of the clamp in one element of our array: port C, two comparators, two multiplexers.
#[must_use]
pub fn clamp(widths: &Widths) -> Cost {
    let depth = u64::from(widths.depth);
    Cost {
        comparators: 2,
        comparator_bits: 2 * (depth + GUARD),
        register_bits: 2 * depth,
        multiplexer_bits: 2 * depth,
        ..Cost::default()
    }
}

/// What the published array and ours share, for values of `value` bits.
fn array(ports: TokenPorts, test: EndTest, widths: &Widths, value: u64) -> Cost {
    let [depth, coordinate, colour] = [widths.depth, widths.coordinate, widths.colour].map(u64::from);
    // The zero test takes X and dX one larger.
    let coordinate = coordinate + u64::from(test == EndTest::Zero);
    let (a, b) = match ports {
        TokenPorts::Swapped => (value.max(coordinate), value.max(coordinate).max(colour)),
        TokenPorts::Merged => (value.max(2 * coordinate), value.max(colour)),
    };
    let zero_test = if test == EndTest::Zero { coordinate } else { 0 };
    Cost {
        adders: 1,
        adder_bits: value.max(coordinate),
        comparators: 0,
        comparator_bits: 0,
        // A, B, CTRL, IN, Zb, Ib.
        register_bits: a + b + 1 + 1 + depth + colour,
        // The second operand: dZ or -1, or the complement of Zb; dX into A; A, IN, Zb and Ib keep their values.
        multiplexer_bits: value + depth + coordinate + a + 1 + depth + colour,
        // Operand nothing; all ones into A; Zb set, Ib cleared; all of A - 1 is zero; start and end of a segment,
        // the three timings, the two writes.
        logic: value + coordinate + depth + colour + zero_test + 8,
    }
}
