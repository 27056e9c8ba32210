//! Edges inside a surface: those that two triangles share.
//!
//! Two triangles share an edge if they lie on both sides of it, face the same way, and agree at both its ends in all that
//! vertices say (place, depth, colour, normal, place in the texture) and in the state they are drawn with: the surface
//! goes on across the edge, and so do its colours. In order of submission an edge finds the last one that it can share
//! and that no other has found, of the [`SEEK`] last between its places. What is not shared is a *border*. A triangle of one colour all over shares none: where its
//! neighbour has that colour too there is nothing to average, and else a seam.
//!
//! Inputs from: [`super::scene`]. Outputs to: [`super::inside`]. Clocks: one for each edge of a triangle that can share
//! its edges. The same by definition: [`super::specification`].

use super::piece::{extent, plain};
use super::scene::{Item, ItemDraw, Kind, Scene};
use super::{Counts, EDGE_BYTES, Setting, specification};
use crate::geometry::ScreenVertex;
use crate::geometry::triangle::doubled_area;
use crate::shading::plane::Interpolation;
use bitflags::bitflags;
use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};

bitflags! {
    /// What is known of an item's edges.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Sides: u8 {
        /// Its edge from vertex 0 to vertex 1 is shared.
        const FIRST = 1;
        /// Its edge from vertex 1 to vertex 2 is shared.
        const SECOND = 2;
        /// Its edge from vertex 2 to vertex 0 is shared.
        const THIRD = 4;
        /// It can share edges.
        const SMOOTH = 8;
        /// Its doubled area is less than 0.
        const BACK = 16;
        /// It has no area.
        const NOTHING = 32;
        /// All of its edges are shared.
        const INNER = 7;
    }
}

impl Sides {
    /// Whether edge `k`, from vertex `k` to the next, is shared.
    #[must_use]
    #[inline(always)]
    pub fn shares(self, k: usize) -> bool {
        self.bits() >> k & 1 != 0
    }
}

/// So many edges between the same two places are looked at for one that can be shared.
pub(super) const SEEK: usize = 16;

/// An edge that has found none to share yet.
#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    hash: u32,
    /// Its item's number, times 4, and its number in the item.
    edge: u32,
    /// The next of the same place in the table, plus 1; 0 if there is none.
    next: u32,
}

/// The edges of a scene.
#[derive(Debug, Default)]
pub struct Edges {
    sides: Vec<Sides>,
    /// The first that waits of each place of the table, plus 1.
    heads: Vec<u32>,
    waiting: Vec<Waiting>,
    /// Where places are hashed from: another for each table, so that nobody can know which of them meet.
    seed: Option<u64>,
    /// The first of `waiting` that means nothing, plus 1; they go on as the others do.
    free: u32,
}

/// The vertex after `k`.
#[inline(always)]
pub(super) fn after(k: usize) -> usize {
    if k == 2 { 0 } else { k + 1 }
}

impl Edges {
    /// Finds the edges that the items of a scene share, if they are asked for.
    pub fn find(&mut self, setting: &Setting, scene: &Scene, counts: &mut Counts) {
        self.sides.clear();
        if !setting.looks_inside() {
            return;
        }
        self.heads.clear();
        self.heads.resize((2 * scene.items.len()).next_power_of_two(), 0);
        self.waiting.clear();
        self.free = 0;
        let shift = 32 - self.heads.len().trailing_zeros();
        let seed = *self.seed.get_or_insert_with(|| RandomState::new().build_hasher().finish());
        let (mut waits, mut most) = (0_u64, 0_u64);
        for (number, item) in (0..).zip(&scene.items) {
            let sides = Sides::of(setting, item, &scene.draws[item.draw as usize]);
            self.sides.push(sides);
            if !sides.contains(Sides::SMOOTH) || sides.contains(Sides::NOTHING) {
                continue;
            }
            counts.edges += 3;
            let places = item.vertices.map(|v| mixed(u64::from(v.x as u32) << 32 | u64::from(v.y as u32), seed));
            let hash = |from: usize, to: usize| (mixed(places[from].rotate_left(24), places[to]) >> 32) as u32;
            for k in 0..3 {
                // It looks for one that runs the other way.
                let hashes = [hash(after(k), k), hash(k, after(k))];
                waits = if self.join(scene, hashes, shift, number, k) { waits - 1 } else { waits + 1 };
            }
            most = most.max(waits);
        }
        if !scene.items.is_empty() {
            counts.edge_bytes = most * EDGE_BYTES + scene.items.len() as u64;
        }
    }

    /// The same by definition.
    pub fn specify(&mut self, setting: &Setting, scene: &Scene, counts: &mut Counts) {
        self.sides.clear();
        if setting.looks_inside() {
            self.sides = specification::sides(setting, scene, counts);
        }
    }

    /// Has an edge share another that waits, or wait; whether it shares one.
    #[inline(always)]
    fn join(&mut self, scene: &Scene, [wanted, own]: [u32; 2], shift: u32, number: u32, k: usize) -> bool {
        let place = |hash: u32| if shift == 32 { 0 } else { (hash >> shift) as usize };
        let item = &scene.items[number as usize];
        // What links to the one that is looked at: 0 the head, else a place plus 1.
        let (mut before, mut at, mut seen) = (0_u32, self.heads[place(wanted)], 0);
        while at != 0 && seen < SEEK {
            let Waiting { hash: other, edge, next } = self.waiting[at as usize - 1];
            let (other_item, side) = ((edge / 4) as usize, (edge % 4) as usize);
            if other == wanted && lie_together(item, k, &scene.items[other_item], side) {
                seen += 1;
                let other = other_item;
                let facing = Sides::SMOOTH | Sides::BACK;
                let alike = self.sides[other] & facing == self.sides[number as usize] & facing;
                if alike && share(scene, item, k, &scene.items[other], side) {
                    match before {
                        0 => self.heads[place(wanted)] = next,
                        before => self.waiting[before as usize - 1].next = next,
                    }
                    self.waiting[at as usize - 1].next = self.free;
                    self.free = at;
                    self.sides[other] |= Sides::from_bits_retain(1 << side);
                    self.sides[number as usize] |= Sides::from_bits_retain(1 << k);
                    return true;
                }
            }
            (before, at) = (at, next);
        }
        let link = &mut self.heads[place(own)];
        let new = Waiting { hash: own, edge: number * 4 + k as u32, next: *link };
        match self.free {
            0 => {
                self.waiting.push(new);
                *link = self.waiting.len() as u32;
            }
            at => {
                self.free = std::mem::replace(&mut self.waiting[at as usize - 1], new).next;
                *link = at;
            }
        }
        false
    }

    /// What is known of the edges of each item; empty if nothing is.
    #[must_use]
    pub fn sides(&self) -> &[Sides] {
        &self.sides
    }
}

impl Sides {
    /// What is known of an item that shares no edge yet.
    #[inline(always)]
    pub(super) fn of(setting: &Setting, item: &Item, draw: &ItemDraw) -> Sides {
        let all = &draw.scissor;
        let whole = [all.x, all.y] == [0, 0] && [all.right, all.bottom] == setting.size;
        let plain = plain(&item.vertices, draw).is_some();
        if item.kind != Kind::Masked || plain || draw.blend || draw.has_holes() || !whole {
            return Sides::empty();
        }
        let [low, high] = extent(item, draw);
        if low[0] >= high[0] || low[1] >= high[1] {
            return Sides::empty();
        }
        let v = &item.vertices;
        let area = doubled_area(&v[0], &v[1], &v[2]);
        let mut sides = Sides::SMOOTH;
        sides.set(Sides::BACK, area < 0);
        sides.set(Sides::NOTHING, area == 0);
        sides
    }
}

/// Two numbers as one that few others have.
#[inline(always)]
fn mixed(a: u64, b: u64) -> u64 {
    let product = (a ^ b).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    product ^ product >> 29
}

/// Whether edge `j` of one triangle lies where edge `k` of another does, and runs the other way.
#[inline(always)]
fn lie_together(a: &Item, j: usize, b: &Item, k: usize) -> bool {
    let together = |v: &ScreenVertex, w: &ScreenVertex| v.x == w.x && v.y == w.y;
    together(&a.vertices[j], &b.vertices[after(k)]) && together(&a.vertices[after(j)], &b.vertices[k])
}

/// Whether edge `j` of one triangle and edge `k` of another that faces the same way can be shared.
#[inline(always)]
pub(super) fn share(scene: &Scene, a: &Item, j: usize, b: &Item, k: usize) -> bool {
    let ends = [(j, after(k)), (after(j), k)];
    let corner = |&(j, k): &(usize, usize)| {
        let (v, w) = (&a.vertices[j], &b.vertices[k]);
        v.x == w.x && v.y == w.y && v.z == w.z && v.reciprocal_w == w.reciprocal_w
    };
    if !ends.iter().all(corner) {
        return false;
    }
    let flat = scene.draws[a.draw as usize].interpolation == Interpolation::Flat;
    let colours = |&(j, k): &(usize, usize)| a.vertices[j].colour == b.vertices[k].colour;
    let coloured = if flat { colours(&(0, 0)) } else { ends.iter().all(colours) };
    coloured && scene.goes_on(a, b, ends)
}
