//! Za prediction: blocks that could have been bypassed and were not.
//!
//! A replay in exact integers keeps the depth of each pixel. A primitive meets a block where it covers a pixel of it. The
//! meeting *could be bypassed* when the block is initialised and the least depth that the primitive really has there lies
//! behind the block's word, the greatest depth of the block: all that a perfect prediction could know. It is *hidden*
//! when no pixel of it passes the depth test: all that anybody could know. What the card bypassed is its counter.

use super::card::{self, Drawn, Setting};
use super::scene::{FAR, Scene};
use crate::harness::depth::stored;
use crate::harness::{Grid, Hidden, Path, Prediction};
use crate::oracle::depth::PrescribedDepth;
use crate::oracle::raster::for_each_pixel;
use crate::oracle::{DepthFormat, Primitive, Vertex};

/// The depth format of the study: the default.
const FORMAT: DepthFormat = DepthFormat { bits: 24, fraction: 24 };

/// What there was to bypass in a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chances {
    /// Times that a primitive met an initialised block.
    pub meetings: u64,
    /// Of these, those where no pixel passed.
    pub hidden: u64,
    /// Of these, those that a perfect prediction bypasses.
    pub bypassable: u64,
}

/// What a prediction did.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How it predicts; `None`: no block is bypassed.
    pub prediction: Option<Prediction>,
    /// Blocks that it bypassed.
    pub bypassed: u64,
    /// Its picture and price.
    pub drawn: Drawn,
}

/// A scene on the Za path.
#[derive(Clone, Debug)]
pub struct Found {
    /// What there was to bypass.
    pub chances: Chances,
    /// Without bypass, then each prediction.
    pub outcomes: Vec<Outcome>,
    /// Every outcome has the plain Z buffer's picture.
    pub same_picture: bool,
}

/// Snapped primitives with depths as the card stores them.
fn primitives(scene: &Scene) -> Vec<Primitive> {
    let facets = scene.facets.iter().map(|facet| {
        Primitive::Triangle([0, 1, 2].map(|k| {
            let [x, y] = facet.corners[k].map(|c| c / 16);
            Vertex::at(x, y, stored(facet.depths[k] as f32 / FAR as f32, FORMAT.bits))
        }))
    });
    facets.collect()
}

/// Counts what could be bypassed in a scene whose vertices lie on the card's grid.
#[must_use]
pub fn chances(scene: &Scene, block: [u32; 2]) -> Chances {
    let [width, height] = scene.size;
    let [across, down] = [width.div_ceil(block[0]), height.div_ceil(block[1])];
    let mut depths = vec![FORMAT.greatest(); scene.pixels()];
    let mut initialised = vec![false; (across * down) as usize];
    // Of the primitive at hand: least depth in each block it meets, and whether a pixel passed.
    let mut least = vec![u32::MAX; initialised.len()];
    let mut passed = vec![false; initialised.len()];
    let mut found = Chances::default();
    for primitive in primitives(scene) {
        let Some(plane) = PrescribedDepth::new(&primitive, FORMAT) else { continue };
        let mut covered = Vec::new();
        let mut met = Vec::new();
        for_each_pixel(&primitive, width, height, |i, j| {
            let (pixel, at) = ((j * width + i) as usize, (j / block[1] * across + i / block[0]) as usize);
            let z = plane.stored(i as i32, j as i32);
            if least[at] == u32::MAX {
                met.push(at);
            }
            least[at] = least[at].min(z);
            passed[at] |= z < depths[pixel];
            covered.push((pixel, z));
        });
        for &at in met.iter().filter(|at| initialised[**at]) {
            found.meetings += 1;
            if !passed[at] {
                found.hidden += 1;
                found.bypassable += u64::from(least[at] > word(&depths, scene.size, block, at as u32));
            }
        }
        for (pixel, z) in covered {
            depths[pixel] = depths[pixel].min(z);
        }
        for at in met {
            (initialised[at], least[at], passed[at]) = (true, u32::MAX, false);
        }
    }
    found
}

/// The greatest depth of a block's pixels on the target.
fn word(depths: &[u32], [width, height]: [u32; 2], [across, down]: [u32; 2], block: u32) -> u32 {
    let blocks = width.div_ceil(across);
    let (left, top) = (block % blocks * across, block / blocks * down);
    let rows = top..(top + down).min(height);
    let greatest = |j: u32| {
        let row = (j * width) as usize;
        depths[row + left as usize..row + (left + across).min(width) as usize].iter().copied().max().unwrap_or(0)
    };
    rows.map(greatest).max().unwrap_or(0)
}

/// Draws a scene, which is snapped first, on the Za path in every way.
#[must_use]
pub fn of_card(scene: &Scene, block: [u32; 2], threads: usize, repeats: usize) -> Found {
    let scene = scene.clone().snapped();
    let base = Setting { grid: Grid::Off, depth: FORMAT, ..Setting::best() };
    let ways: Vec<Option<Prediction>> = std::iter::once(None).chain(Prediction::ALL.map(Some)).collect();
    let za = |way: &Option<Prediction>| Hidden {
        path: Path::Za,
        block,
        bypass: way.is_some(),
        prediction: way.unwrap_or_default(),
        ..Hidden::default()
    };
    let mut settings: Vec<Setting> = ways.iter().map(|way| Setting { hidden: za(way), ..base }).collect();
    settings.push(base);
    let mut all = card::drawn(&scene, &settings, threads, repeats);
    let plain = all.pop();
    let same_picture = plain.is_some_and(|plain| all.iter().all(|drawn| drawn.colour == plain.colour));
    let outcome = |(prediction, drawn): (Option<Prediction>, Drawn)| {
        let bypassed = drawn.events["za.blocks_bypassed"];
        Outcome { prediction, bypassed, drawn }
    };
    Found { chances: chances(&scene, block), outcomes: ways.into_iter().zip(all).map(outcome).collect(), same_picture }
}

#[cfg(test)]
mod tests {
    use super::super::scene::Kind;
    use super::*;
    use crate::harness::Random;

    #[test]
    fn of_card_plane_prediction_bypasses_all_that_a_word_allows_and_none_bypasses_more() {
        // Planes over all of the target first: without them blocks hold background, and no word can hide anything.
        let mut random = Random::new(4);
        let mut scene = Kind::Crossing.scene([96, 64], &mut random);
        scene.facets.extend(Kind::Soup.scene([96, 64], &mut random).facets);
        for block in [[32, 1], [8, 4]] {
            let found = of_card(&scene, block, 1, 1);
            let bypassed: Vec<u64> = found.outcomes.iter().map(|outcome| outcome.bypassed).collect();
            assert!(found.same_picture);
            assert_eq!((bypassed[0], bypassed[3]), (0, found.chances.bypassable), "{block:?}: {:?}", found.chances);
            assert!(bypassed[1] <= bypassed[2] && bypassed[2] <= bypassed[3], "{bypassed:?}");
            assert!(found.chances.bypassable > 100 && found.chances.hidden >= found.chances.bypassable);
        }
    }
}
