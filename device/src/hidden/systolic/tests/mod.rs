//! Tests of the systolic array.
//!
//! | file | what is tested |
//! | --- | --- |
//! | `machines` | fast models against their specification: every register, every clock, every SIMD level |
//! | `cases` | the systolic hard cases 32 to 37 |
//! | `clocks` | clocks of the clocked models against the closed form |
//! | `scenes` | pixels, depths and counts of random scenes against the specification of the Z buffer |
//! | `example` | the worked example of the documentation, line by line |
//! | `waves` | waveforms, read back |
//! | `gates` | costs of the variants |

mod cases;
mod clocks;
mod example;
mod gates;
mod machines;
mod scenes;
mod waves;

use super::Machine;
use super::array::Array;
use super::element::{Elements, Rules};
use super::token::{Beat, Luminance, Pixel, Token};
use crate::hidden::stencil::StencilRule;
use crate::hidden::z_buffer::DepthTest;
use fearless_simd::Level;
use proptest::prelude::*;
use zga_abi::format::{EndTest, TokenPorts};
use zga_firmware::checked::SystolicSetting;

/// The variants of the array's elements.
const VARIANTS: [SystolicSetting; 4] = {
    use {EndTest as E, TokenPorts as P};
    const fn variant(ports: TokenPorts, end_test: EndTest) -> SystolicSetting {
        SystolicSetting { end_test, ports, colour: zga_abi::format::TokenColour::Tag, super_buffer: false }
    }
    [
        variant(P::Swapped, E::Negative),
        variant(P::Swapped, E::Zero),
        variant(P::Merged, E::Negative),
        variant(P::Merged, E::Zero),
    ]
};

/// Depth that a line begins with in these tests.
const FAR: i32 = i32::MAX;

/// Every SIMD level of this host.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let narrow = [
        best.as_sse2().map(Level::Sse2),
        best.as_sse4_2().map(Level::Sse4_2),
        best.as_avx2().map(Level::Avx2),
        best.as_avx512().map(Level::Avx512),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let narrow: [Option<Level>; 0] = [];
    narrow.into_iter().flatten().chain([best]).collect()
}

/// A token that passes where it is nearer, with depths in whole steps.
fn token(first: u32, more: u32, z: i64, dz: i64, tag: u32) -> Token {
    Token {
        first,
        more,
        z: z << 32,
        dz: dz << 32,
        range: [0, i32::MAX],
        test: DepthTest::LESS,
        luminance: Some(Luminance::Tag(tag)),
        stencil: StencilRule::Keep,
    }
}

/// What `machine` drives when `beats` and then bubbles enter it, and in which clock each pixel comes.
fn drive<M: Machine>(machine: &mut M, ports: impl IntoIterator<Item = M::Port>, idle: u32) -> Vec<(u64, Pixel)> {
    let idle = std::iter::repeat_n(M::Port::default(), idle as usize);
    let clocks = (0..).zip(ports.into_iter().chain(idle));
    clocks.filter_map(|(clock, port)| Some((clock, machine.clock(port, FAR)?))).collect()
}

/// The pixels of one line of `width` that `tokens` make.
fn line(width: u32, tokens: &[Token], setting: SystolicSetting) -> Vec<Pixel> {
    let mut array = Array::new(width, Rules { setting, below: 32 }, Level::new());
    (0..width as usize).for_each(|element| array.preset(element, FAR));
    let beats = tokens.iter().flat_map(|token| token.beats(&setting)).chain(Beat::REFRESH);
    drive(&mut array, beats, width).into_iter().map(|(_, pixel)| pixel).collect()
}

/// The same by the definition: span by span against a line of depths.
fn line_by_definition(width: u32, tokens: &[Token], below: u32) -> Vec<Pixel> {
    let mut pixels = vec![Pixel { luminance: Luminance::Background, depth: FAR, stencil: 0 }; width as usize];
    for token in tokens {
        let covered = (0..).zip(&mut pixels).skip(token.first as usize).take(token.more as usize + 1);
        for (x, pixel) in covered {
            let steps = i64::from(x) - i64::from(token.first);
            let value = token.z.wrapping_add(steps.wrapping_mul(token.dz)) >> below;
            let z = value.clamp(i64::from(token.range[0]), i64::from(token.range[1])) as i32;
            if token.test.passes(z, pixel.depth) {
                pixel.depth = if token.test.write { z } else { pixel.depth };
                pixel.luminance = token.luminance.unwrap_or(pixel.luminance);
            }
        }
    }
    pixels
}

fn tests() -> impl Strategy<Value = DepthTest> {
    any::<[bool; 4]>().prop_map(|[less, equal, greater, write]| DepthTest { less, equal, greater, write })
}

fn luminances() -> impl Strategy<Value = Option<Luminance>> {
    let seen = prop_oneof![any::<u32>().prop_map(Luminance::Tag), any::<u32>().prop_map(Luminance::Value)];
    proptest::option::weighted(0.8, seen)
}

/// Tokens on a line of `width` pixels: Z anywhere in 64 bits, or in few steps so that depths tie.
fn tokens(width: u32) -> impl Strategy<Value = Token> {
    let few = (0_i64..4, -1_i64..=1).prop_map(|(z, dz)| (z << 32, dz << 31));
    let depths = prop_oneof![few, any::<(i64, i64)>(), any::<i64>().prop_map(|z| (z, i64::MIN))];
    let ranges = prop_oneof![
        Just([0, i32::MAX]),
        Just([0, 3]),
        any::<(u16, u16)>().prop_map(|(a, b)| [a.min(b).into(), a.max(b).into()])
    ];
    let segment = (0..width).prop_flat_map(move |first| (Just(first), 0..width - first));
    (segment, depths, ranges, tests(), luminances()).prop_map(|((first, more), (z, dz), range, test, luminance)| {
        Token { first, more, z, dz, range, test, luminance, stencil: StencilRule::Keep }
    })
}

/// A specified array on which nothing lies.
fn elements(width: u32, setting: SystolicSetting, below: u32) -> Elements {
    let mut elements = Elements::new(width, Rules { setting, below });
    (0..width as usize).for_each(|element| elements.preset(element, FAR));
    elements
}
