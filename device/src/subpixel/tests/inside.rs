//! Edges inside a surface, and pixels there, against the specification: meshes of shared vertices, torn, folded and
//! laid over one another.

use super::super::band::{Input, LINES, Resolved, Work};
use super::super::bands::Bands;
use super::super::edges::{Edges, SEEK, Sides};
use super::super::grid::Grid;
use super::super::inside::meets_border;
use super::super::scene::{Item, Kind, Rule, Scene};
use super::super::specification::meets;
use super::super::unit::Unit;
use super::super::{Counts, Setting};
use super::scene::state;
use super::{levels, setting};
use crate::geometry::ScreenVertex;
use crate::hidden::z_buffer::DepthTest;
use crate::shading::pixel::AlphaRule;
use crate::shading::plane::Interpolation;
use fearless_simd::Level;
use proptest::prelude::*;
use zga_abi::Effects;
use zga_abi::format::{DepthFormat, SubpixelDepth, SubpixelEdges};
use zga_firmware::checked::{Clear, DrawState, Rectangle};

const AREA: Rectangle = Rectangle { x: 0, y: 0, right: 80, bottom: 40 };
/// The farthest depth.
const FAR: u32 = (1 << 16) - 1;

/// A sheet of `SIDE` x `SIDE` vertices.
const SIDE: usize = 6;

#[derive(Clone, Debug)]
struct Mesh {
    /// The first vertex, and the vectors from one to the next along both axes of the sheet, u.
    origin: [i32; 2],
    across: [i32; 2],
    down: [i32; 2],
    /// How far each vertex lies off its place, u; its depth; its colour.
    vertices: Vec<([i32; 2], u32, u32)>,
    /// Depth of the first vertex; its changes along both axes.
    depth: [i32; 3],
    /// By triangle: left out, turned round, drawn twice, or one of its colours changed.
    odd: Vec<u8>,
}

fn mesh() -> impl Strategy<Value = Mesh> {
    let vector = |reach: i32| [-reach..=reach, -reach..=reach];
    let steps = prop_oneof![Just(60), Just(500), Just(2500), Just(8000)];
    let shape = (steps, prop_oneof![Just(0), Just(30), Just(900)]).prop_flat_map(move |(step, noise)| {
        let vertex = (vector(noise), 0_u32..800, 0_u32..0x0100_0000);
        (vector(step), vector(step), prop::collection::vec(vertex, SIDE * SIDE))
    });
    let any = prop::collection::vec(prop_oneof![12 => Just(0_u8), 1 => 1_u8..5], 2 * SIDE * SIDE);
    let odd = prop_oneof![2 => any, 1 => Just(vec![0; 2 * SIDE * SIDE])];
    let place = [-4000..24_000_i32, -4000..14_000_i32];
    // Some lie among one another.
    let depth = (prop_oneof![500..60_000_i32, 20_000..26_000_i32], -3000..3000_i32, -3000..3000_i32);
    (place, shape, depth, odd).prop_map(|(origin, (across, down, vertices), (first, right, below), odd)| {
        let depth = [first, right, below];
        Mesh { origin, across, down, vertices, depth, odd }
    })
}

impl Mesh {
    fn vertex(&self, i: usize, j: usize) -> ScreenVertex {
        let (across, down) = (i as i32, j as i32);
        let (off, depth, colour) = self.vertices[j * SIDE + i];
        let place = |c: usize| self.origin[c] + across * self.across[c] + down * self.down[c] + off[c];
        let z = self.depth[0] + across * self.depth[1] + down * self.depth[2] + depth as i32;
        let z = z.clamp(0, FAR as i32) as u32;
        ScreenVertex { x: place(0), y: place(1), z, colour: colour | 0xFF00_0000, reciprocal_w: 1.0 }
    }

    fn triangles(&self) -> Vec<[ScreenVertex; 3]> {
        let mut triangles = Vec::new();
        let mut odd = self.odd.iter();
        for j in 0..SIDE - 1 {
            for i in 0..SIDE - 1 {
                let [a, b, c, d] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| self.vertex(i, j));
                for mut triangle in [[a, b, c], [b, d, c]] {
                    match odd.next() {
                        Some(1) => continue,
                        Some(2) => triangle.swap(1, 2),
                        Some(3) => triangles.push(triangle),
                        Some(4) => triangle[0].colour ^= 0xFF,
                        _ => {}
                    }
                    triangles.push(triangle);
                }
            }
        }
        triangles
    }
}

/// The scene of some meshes, the last of which may be translucent.
fn scene(meshes: &[Mesh], test: Option<DepthTest>, translucent: bool) -> Scene {
    let mut scene = Scene::default();
    scene.clear(&Clear { area: AREA, colour: Some(0), depth: Some(FAR), stencil: None }, true, true);
    for (tag, mesh) in (0..).zip(meshes) {
        let blend = translucent && tag as usize + 1 == meshes.len();
        let effects = if blend { Effects::ANTI_ALIAS | Effects::BLEND } else { Effects::ANTI_ALIAS };
        let state = DrawState { scissor: AREA, ..state(effects, tag) };
        let taken = scene.draw(&state, test, Interpolation::Affine, AlphaRule::Vertices).expect("taken");
        for (mut vertices, number) in mesh.triangles().into_iter().zip(0..) {
            if blend {
                vertices.iter_mut().for_each(|v| v.colour = v.colour & 0x00FF_FFFF | 0x8000_0000);
            }
            taken.items.push(Item { vertices, draw: taken.draw, number, kind: Kind::Masked });
        }
    }
    scene
}

/// What the unit makes of a scene.
fn resolved(setting: &Setting, scene: &Scene, level: Option<Level>) -> (Vec<Resolved>, Counts) {
    let mut all = Vec::new();
    let write = |pixels: &[Resolved]| all.extend_from_slice(pixels);
    let (counts, stopped) = Unit::default().resolve(setting, scene, level, None, write, &|_| None);
    stopped.expect("nobody stops it");
    all.sort_by_key(|pixel| (pixel.y, pixel.x));
    (all, counts)
}

fn setting_of(grid: Grid, depth: SubpixelDepth, rule: Rule, fraction: u32) -> Setting {
    let format = DepthFormat::new(16, fraction).expect("a format");
    let edges = SubpixelEdges::Borders;
    Setting { depth, rule, format, edges, ..setting(grid, [AREA.right, AREA.bottom]) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn pixels_and_counts_are_those_of_the_specification(
        meshes in prop::collection::vec(mesh(), 1..4), translucent in prop::bool::weighted(0.2),
        grid in prop::sample::select(vec![Grid::G4X4, Grid::G8X4, Grid::G8X8]),
        depth in prop::sample::select(SubpixelDepth::ALL), depths in prop::bool::weighted(0.8),
        fraction in prop::sample::select(vec![0, 8, 24]),
    ) {
        let scene = scene(&meshes, depths.then_some(DepthTest::LESS), translucent);
        let setting = setting_of(grid, depth, scene.rule(), fraction);
        let expected = resolved(&setting, &scene, None);
        for level in levels().into_iter().chain([Level::new()]) {
            let found = resolved(&setting, &scene, Some(level));
            prop_assert_eq!(&found, &expected, "{:?}", level);
        }
        // Fewer pixels than where all edges count, and those as there.
        let all = resolved(&Setting { edges: SubpixelEdges::All, ..setting }, &scene, Some(Level::new())).0;
        let of_all = |pixel: &Resolved| {
            let place = all.binary_search_by_key(&(pixel.y, pixel.x), |pixel| (pixel.y, pixel.x));
            place.is_ok_and(|place| all[place] == *pixel)
        };
        prop_assert!(expected.0.iter().all(of_all));
    }

    #[test]
    fn edges_that_are_shared_are_those_of_the_specification(meshes in prop::collection::vec(mesh(), 1..4)) {
        let scene = scene(&meshes, Some(DepthTest::LESS), false);
        let setting = setting_of(Grid::G8X8, SubpixelDepth::Search, Rule::Nearest, 24);
        let (mut found, mut expected) = (Edges::default(), Edges::default());
        let mut counts = [Counts::default(); 2];
        found.find(&setting, &scene, &mut counts[0]);
        expected.specify(&setting, &scene, &mut counts[1]);
        prop_assert_eq!(found.sides(), expected.sides());
        prop_assert_eq!(counts[0], counts[1]);
    }

    #[test]
    fn borders_meet_a_pixel_where_they_pass_between_its_samples(
        corners in [[-600..900_i32, -600..900_i32], [-600..900, -600..900], [-600..900, -600..900]],
        grid in prop::sample::select(vec![Grid::G4X4, Grid::G8X4, Grid::G8X8]), shared in 0_u8..8,
    ) {
        let setting = setting_of(grid, SubpixelDepth::Search, Rule::Nearest, 24);
        let vertices = corners.map(|[x, y]| ScreenVertex { x, y, ..ScreenVertex::default() });
        let item = Item { vertices, draw: 0, number: 0, kind: Kind::Masked };
        let sides = Sides::SMOOTH | Sides::from_bits_retain(shared);
        let spare = setting.pitch.map(|bits| 1_i64 << (bits - 1));
        let places = corners.map(|place| place.map(i64::from));
        let expected = (0..3).any(|k| {
            !sides.shares(k) && meets(places[k], places[(k + 1) % 3], spare, spare.map(|spare| 256 - spare))
        });
        prop_assert_eq!(meets_border(&setting, &item, sides, [0, 0]), expected);
    }
}

/// A sheet without anything odd, all of it seen.
fn smooth() -> Mesh {
    let vertices = (0..SIDE * SIDE).map(|n| ([0; 2], 0, 0x0003_0501 * n as u32)).collect();
    Mesh {
        origin: [700, 600],
        across: [3500, 130],
        down: [-90, 1700],
        vertices,
        depth: [900, 700, 400],
        odd: vec![0; 72],
    }
}

/// Pixels more than active ones that may be looked at in a band: borders are taken for a little wider, which adds one on a
/// line at most.
const MORE: u32 = LINES as u32;

/// Pixels of the first band in which fragments are looked for, and those that are active on it.
fn looked_at(scene: &Scene) -> (u32, u32) {
    let setting = setting_of(Grid::G8X8, SubpixelDepth::Search, Rule::Nearest, 24);
    let (mut bands, mut edges, mut counts) = (Bands::default(), Edges::default(), Counts::default());
    bands.fill(scene, setting.rule, AREA.bottom);
    edges.find(&setting, scene, &mut counts);
    let (edges, surfaces) = (edges.sides(), edges.surfaces());
    let input = Input { setting: &setting, scene, items: bands.items(0), edges, surfaces, top: 0, lines: LINES };
    let (mut work, mut out) = (Work::default(), Vec::new());
    work.draw(Some(Level::new()), &input, &mut out, &mut counts);
    (work.inside.looked.count(), out.len() as u32)
}

#[test]
fn inside_of_a_surface_is_not_looked_at_whatever_lies_behind() {
    let (looked, active) = looked_at(&scene(&[smooth()], Some(DepthTest::LESS), false));
    assert!(active > 0, "its outline");
    let behind = Mesh { origin: [2000, 1500], depth: [40_000, 300, 200], ..smooth() };
    let (with, active_with) = looked_at(&scene(&[smooth(), behind.clone()], Some(DepthTest::LESS), false));
    assert!(looked <= active + MORE, "{looked} looked at, {active} active");
    // The outline of the sheet behind is hidden but for its end.
    assert!(with <= active_with + MORE, "{with} looked at, {active_with} active");
    // Every other triangle is turned round.
    let odd = (0..72).map(|n| if n % 2 == 0 { 0 } else { 2 }).collect();
    let (all, _) = looked_at(&scene(&[Mesh { odd, ..smooth() }], Some(DepthTest::LESS), false));
    assert_eq!(all, LINES as u32 * 80, "no edge is shared");
}

#[test]
fn inside_of_a_fold_is_not_looked_at() {
    // A sheet that is folded over down its middle: what faces away lies behind what faces the viewer, and both meet in the
    // tiles of the fold.
    let mut fold = Mesh { origin: [700, 300], depth: [900, 1500, 400], ..smooth() };
    for (n, (off, ..)) in fold.vertices.iter_mut().enumerate() {
        let beyond = (n % SIDE) as i32 - 3;
        *off = if beyond > 0 { [-beyond * 2 * fold.across[0] + 1000, 0] } else { [0; 2] };
    }
    let (looked, active) = looked_at(&scene(&[fold], Some(DepthTest::LESS), false));
    assert!(active > 0, "its outline");
    assert!(looked <= active + MORE, "{looked} looked at, {active} active");
}

#[test]
fn inside_of_the_nearer_of_two_surfaces_is_not_looked_at_though_their_depths_overlap() {
    // Both lean by more in a tile than they are apart.
    let near = Mesh { origin: [700, -600], depth: [900, 9000, 400], ..smooth() };
    let far = Mesh { depth: [2900, 9000, 400], ..near.clone() };
    let (alone, _) = looked_at(&scene(std::slice::from_ref(&near), Some(DepthTest::LESS), false));
    let (both, _) = looked_at(&scene(&[near, far], Some(DepthTest::LESS), false));
    assert!(both <= alone + MORE, "{both} looked at, {alone} with one of them");
}

#[test]
fn an_edge_looks_at_so_many_between_its_places() {
    let z = 500;
    let corner = |x: i32, y: i32, colour: u32| ScreenVertex { x: 256 * x, y: 256 * y, z, colour, reciprocal_w: 1.0 };
    let triangle = |colour: u32| [corner(0, 0, colour), corner(20, 0, 1), corner(0, 20, 2)];
    for (others, shares) in [(SEEK - 1, true), (SEEK, false)] {
        let mut scene = scene(&[], Some(DepthTest::LESS), false);
        let state = DrawState { scissor: AREA, ..state(Effects::ANTI_ALIAS, 0) };
        let test = Some(DepthTest::LESS);
        let taken = scene.draw(&state, test, Interpolation::Affine, AlphaRule::Vertices).expect("taken");
        let mut push = |vertices| {
            taken.items.push(Item { vertices, draw: taken.draw, number: 0, kind: Kind::Masked });
        };
        push(triangle(0));
        // Their edges from (20, 0) to (0, 20) lie there too, in other colours.
        (0..others as u32).for_each(|n| push([corner(1, 1, 9), corner(20, 0, 10 + n), corner(0, 20, 2)]));
        push([corner(20, 20, 3), corner(0, 20, 2), corner(20, 0, 1)]);
        let setting = setting_of(Grid::G8X8, SubpixelDepth::Search, Rule::Nearest, 24);
        let (mut found, mut expected) = (Edges::default(), Edges::default());
        found.find(&setting, &scene, &mut Counts::default());
        expected.specify(&setting, &scene, &mut Counts::default());
        assert_eq!(found.sides(), expected.sides());
        assert_eq!(found.sides()[0].shares(1), shares, "{others} between");
    }
}

#[test]
fn surfaces_that_cross_are_anti_aliased_where_no_border_is_near() {
    // Both are larger than the target.
    let one =
        Mesh { origin: [-6000, -4000], across: [8000, 130], down: [-90, 4000], depth: [2000, 6000, 0], ..smooth() };
    let alike = Mesh { depth: [26_000, -5000, 300], ..one.clone() };
    let turned = Mesh { origin: [34_000, -4000], across: [-8000, 130], depth: [2000, 5000, 300], ..one.clone() };
    for other in [alike, turned] {
        let scene = scene(&[one.clone(), other], Some(DepthTest::LESS), false);
        let setting = setting_of(Grid::G8X8, SubpixelDepth::Search, Rule::Nearest, 24);
        let expected = resolved(&setting, &scene, None);
        assert!(expected.0.len() > AREA.bottom as usize / 2, "a pixel on most lines: {}", expected.0.len());
        // The line in which they cross is steep: it passes through two pixels of a line at most.
        assert!(expected.0.len() <= 2 * AREA.bottom as usize, "no more than that line: {}", expected.0.len());
        for level in levels().into_iter().chain([Level::new()]) {
            assert_eq!(resolved(&setting, &scene, Some(level)), expected, "{level:?}");
        }
    }
}
