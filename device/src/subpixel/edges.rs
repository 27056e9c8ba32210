//! Edges inside a surface: those that two triangles share.
//!
//! Two triangles share an edge if they lie on both sides of it, face the same way, and agree at both its ends in all that
//! vertices say (place, depth, colour, normal, place in the texture) and in the state they are drawn with: the surface
//! goes on across the edge, and so do its colours. In order of submission an edge finds the last one that it can share
//! and that no other has found, of the [`SEEK`] last between its places. What is not shared is a *border*. A triangle of one
//! colour all over shares none: where its neighbour has that colour too there is nothing to average, and else a seam.
//!
//! A *surface* is what hangs together by shared edges.
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

/// Where an edge is looked for.
#[derive(Clone, Copy, Debug)]
struct Key {
    /// Of the places of both ends, whichever comes first.
    hash: u32,
    /// Which way it runs between them.
    up: bool,
}

/// The edges of a scene.
#[derive(Debug, Default)]
pub struct Edges {
    sides: Vec<Sides>,
    /// The first item of the surface that an item is part of; until all edges are known, one that leads to it.
    surfaces: Vec<u32>,
    /// The first that waits of each place of the table, plus 1: of edges that run one way, and of those that run the other.
    heads: Vec<[u32; 2]>,
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
        self.surfaces.clear();
        if !setting.looks_inside() {
            return;
        }
        self.heads.clear();
        self.heads.resize((2 * scene.items.len()).next_power_of_two(), [0; 2]);
        self.waiting.clear();
        self.free = 0;
        let shift = 32 - self.heads.len().trailing_zeros();
        let seed = *self.seed.get_or_insert_with(|| RandomState::new().build_hasher().finish());
        let (mut waits, mut most) = (0_u64, 0_u64);
        for (number, item) in (0..).zip(&scene.items) {
            let sides = Sides::of(setting, item, &scene.draws[item.draw as usize]);
            self.sides.push(sides);
            self.surfaces.push(number);
            if !sides.contains(Sides::SMOOTH) || sides.contains(Sides::NOTHING) {
                continue;
            }
            counts.edges += 3;
            let place = |v: &ScreenVertex| mixed(u64::from(v.x as u32) << 32 | u64::from(v.y as u32), seed);
            let places = [place(&item.vertices[0]), place(&item.vertices[1]), place(&item.vertices[2])];
            for k in 0..3 {
                let (from, to) = (places[k], places[after(k)]);
                let key = Key { hash: (mixed(from.min(to).rotate_left(24), from.max(to)) >> 32) as u32, up: from < to };
                waits = if self.join(scene, key, shift, number, k) { waits - 1 } else { waits + 1 };
            }
            most = most.max(waits);
        }
        // Each leads to one that comes before it, or to itself.
        for number in 0..self.surfaces.len() {
            self.surfaces[number] = self.surfaces[self.surfaces[number] as usize];
        }
        if !scene.items.is_empty() {
            counts.edge_bytes = most * EDGE_BYTES + scene.items.len() as u64;
        }
    }

    /// The first item that an item leads to.
    #[inline(always)]
    fn first(&mut self, mut number: u32) -> u32 {
        loop {
            let next = self.surfaces[number as usize];
            if next == number {
                return number;
            }
            let after = self.surfaces[next as usize];
            self.surfaces[number as usize] = after;
            number = after;
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
    fn join(&mut self, scene: &Scene, Key { hash, up }: Key, shift: u32, number: u32, k: usize) -> bool {
        let place = if shift == 32 { 0 } else { (hash >> shift) as usize };
        // It looks for one that runs the other way.
        let (own, wanted) = (usize::from(up), usize::from(!up));
        let item = &scene.items[number as usize];
        // What links to the one that is looked at: 0 the head, else a place plus 1.
        let (mut before, mut at, mut seen) = (0_u32, self.heads[place][wanted], 0);
        while at != 0 && seen < SEEK {
            let Waiting { hash: found, edge, next } = self.waiting[at as usize - 1];
            let (other, side) = ((edge / 4) as usize, (edge % 4) as usize);
            if found == hash && lie_together(item, k, &scene.items[other], side) {
                seen += 1;
                // What waits can share its edges, and so can this.
                let alike = (self.sides[other] ^ self.sides[number as usize]) & Sides::BACK == Sides::empty();
                if alike && share(scene, item, k, &scene.items[other], side) {
                    match before {
                        0 => self.heads[place][wanted] = next,
                        before => self.waiting[before as usize - 1].next = next,
                    }
                    self.waiting[at as usize - 1].next = self.free;
                    self.free = at;
                    self.sides[other] |= Sides::from_bits_retain(1 << side);
                    self.sides[number as usize] |= Sides::from_bits_retain(1 << k);
                    let (a, b) = (self.first(number), self.first(other as u32));
                    self.surfaces[a.max(b) as usize] = a.min(b);
                    return true;
                }
            }
            (before, at) = (at, next);
        }
        let link = &mut self.heads[place][own];
        let new = Waiting { hash, edge: number * 4 + k as u32, next: *link };
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

    /// The first item of the surface that each item is part of: one with all that it shares edges with.
    #[must_use]
    pub fn surfaces(&self) -> &[u32] {
        &self.surfaces
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

/// Whether edge `j` of one triangle and edge `k` of another, which lie together and face the same way, can be shared.
#[inline(always)]
pub(super) fn share(scene: &Scene, a: &Item, j: usize, b: &Item, k: usize) -> bool {
    let ends = [(j, after(k)), (after(j), k)];
    let corner = |(j, k): (usize, usize)| {
        let (v, w) = (&a.vertices[j], &b.vertices[k]);
        v.z == w.z && v.reciprocal_w == w.reciprocal_w
    };
    let flat = scene.draws[a.draw as usize].interpolation == Interpolation::Flat;
    let colours = |(j, k): (usize, usize)| a.vertices[j].colour == b.vertices[k].colour;
    let coloured = if flat { colours((0, 0)) } else { colours(ends[0]) && colours(ends[1]) };
    corner(ends[0]) && corner(ends[1]) && coloured && scene.goes_on(a, b, ends)
}
