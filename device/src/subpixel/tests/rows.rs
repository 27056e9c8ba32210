//! Bounds of the depths of 16 pixels against those of each, at every SIMD level.

use super::super::Setting;
use super::super::band::Input;
use super::super::grid::Grid;
use super::super::piece::Piece;
use super::super::rows::Bounds;
use super::super::scene::{Item, Kind, Scene};
use super::scene::state;
use super::{levels, setting};
use crate::geometry::ScreenVertex;
use crate::hidden::z_buffer::DepthTest;
use crate::hidden::z_buffer::kernel::LANES;
use crate::shading::pixel::AlphaRule;
use crate::shading::plane::Interpolation;
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};
use proptest::prelude::*;
use zga_abi::Effects;
use zga_abi::format::{DepthFormat, SubpixelDepth};

/// Bounds of the chunk that begins with pixel (`x`, `y`).
#[inline(always)]
fn bounds<S: Simd>(simd: S, input: &Input<'_>, piece: &Piece, x: i32, y: i32) -> [[i32; LANES]; 2] {
    let bounds = Bounds::new(simd, input, piece);
    let mut found = [[0; LANES]; 2];
    let [near, far] = bounds.of(simd, bounds.value(x, y));
    near.store_slice(&mut found[0]);
    far.store_slice(&mut found[1]);
    found
}

fn vertex() -> impl Strategy<Value = ScreenVertex> {
    (0..16_384, 0..4096, 0_u32..1 << 16).prop_map(|(x, y, z)| ScreenVertex { x, y, z, ..ScreenVertex::default() })
}

proptest! {
    #[test]
    fn bounds_of_a_chunk_are_those_of_its_pixels(
        mut vertices in [vertex(), vertex(), vertex()], bits in prop::sample::select(vec![16, 24, 31]),
        depth in prop::sample::select(vec![SubpixelDepth::Centre, SubpixelDepth::Search]), y in 0..16_i32,
    ) {
        let format = DepthFormat::new(bits, 16).expect("a format");
        vertices.iter_mut().for_each(|vertex| vertex.z <<= bits - 16);
        let setting = Setting { depth, format, ..setting(Grid::G8X8, [64, 16]) };
        let mut scene = Scene::default();
        let (state, test) = (state(Effects::ANTI_ALIAS, 0), Some(DepthTest::LESS));
        let taken = scene.draw(&state, test, Interpolation::Flat, AlphaRule::Vertices).expect("taken");
        let item = Item { vertices, draw: taken.draw, number: 0, kind: Kind::Masked };
        taken.items.push(item);
        let input = Input { setting: &setting, scene: &scene, items: &[], edges: &[], surfaces: &[], top: 0, lines: 16 };
        let (piece, _) = Piece::new(&setting, 0, &item, &scene.draws[item.draw as usize], 0);
        for x in (0..64).step_by(LANES) {
            let expected: Vec<[i32; 2]> = (x..x + LANES as i32).map(|x| piece.bounds(x, y)).collect();
            for level in levels().into_iter().chain([Level::new()]) {
                let [near, far] = dispatch!(level, simd => bounds(simd, &input, &piece, x, y));
                let found: Vec<[i32; 2]> = near.into_iter().zip(far).map(<[i32; 2]>::from).collect();
                prop_assert_eq!(&found, &expected, "{:?}", level);
            }
        }
    }
}
