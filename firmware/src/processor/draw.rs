//! Draws: DRAW_INLINE and DRAW_BUFFER.
//!
//! A draw that makes no primitive is a legal nothing: it is checked like any other, but calls for
//! no effect and reaches no unit.

use super::claim::Claim;
use super::memory::VideoMemory;
use super::power::{effect_units, path_unit, really_used};
use super::{Processor, bad_length, effects, outcome, registers};
use crate::checked::{Draw, DrawState, Target, Words};
use crate::hardware::Hardware;
use zga_abi::format::DepthFunction;
use zga_abi::packet::DrawFlags;
use zga_abi::{Effects, Fault, FaultCode, Reg, Units};

/// DRAW_INLINE: words before the vertices.
const INLINE_HEAD: u32 = 4;

/// The indices of a draw, not looked at yet.
struct Indices<'a> {
    words: Words<'a>,
    count: u32,
    /// The word of the packet where index 0 stands, or the one with the indices' address.
    word: u32,
}

impl Processor {
    /// DRAW_INLINE: flags, vertices, indices, vertex words ..., index words ...
    pub(super) fn draw_inline<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, flags, vertex_count, index_count, ref body @ ..] = packet else {
            return Err(bad_length(packet));
        };
        let target = self.scene_target(packet)?;
        let flags = draw_flags(flags)?;
        if !flags.indexed {
            Claim::word(3, index_count).require(index_count == 0)?;
        }
        // At most (2^32 - 1) * 9 + 2^32 - 1 words: no overflow in u64.
        let vertex_words = u64::from(vertex_count) * u64::from(flags.vertex_words());
        if vertex_words + u64::from(index_count) != body.len() as u64 {
            return Err(bad_length(packet));
        }
        // The vertices are part of the packet, so the cast is exact.
        let (vertices, indices) = body.split_at(vertex_words as usize);

        let draw = Draw {
            topology: flags.topology,
            coloured: flags.coloured,
            normals: flags.normals,
            coordinates: flags.coordinates,
            vertices: Words::Inline(vertices),
            vertex_count,
            indices: flags.indexed.then_some(Words::Inline(indices)),
        };
        let indices = flags.indexed.then_some(Indices {
            words: Words::Inline(indices),
            count: index_count,
            word: INLINE_HEAD + vertices.len() as u32,
        });
        self.draw(hardware, &target, &draw, indices)
    }

    /// DRAW_BUFFER: flags, vertex address, vertices, index address, indices.
    pub(super) fn draw_buffer<H: Hardware>(&mut self, hardware: &mut H, packet: &[u32]) -> Result<(), Fault> {
        let &[_, flags, vertex_address, vertex_count, index_address, index_count] = packet else {
            return Err(bad_length(packet));
        };
        let target = self.scene_target(packet)?;
        let flags = draw_flags(flags)?;
        let memory = VideoMemory::of(hardware);

        let vertices = vertex_count.saturating_mul(flags.vertex_words());
        memory.words(Claim::word(2, vertex_address), vertices)?;
        if flags.indexed {
            memory.words(Claim::word(4, index_address), index_count)?;
        } else {
            Claim::word(4, index_address).require(index_address == 0)?;
            Claim::word(5, index_count).require(index_count == 0)?;
        }

        let words = Words::Memory { address: index_address, words: index_count };
        let draw = Draw {
            topology: flags.topology,
            coloured: flags.coloured,
            normals: flags.normals,
            coordinates: flags.coordinates,
            vertices: Words::Memory { address: vertex_address, words: vertices },
            vertex_count,
            indices: flags.indexed.then_some(words),
        };
        let indices = flags.indexed.then_some(Indices { words, count: index_count, word: 4 });
        self.draw(hardware, &target, &draw, indices)
    }

    /// The part that both have in common: state, indices, power, work.
    fn draw<H: Hardware>(
        &mut self,
        hardware: &mut H,
        target: &Target,
        draw: &Draw<'_>,
        indices: Option<Indices<'_>>,
    ) -> Result<(), Fault> {
        let state = draw_state(hardware, target)?;
        let probe = registers::probe_unit(hardware)?;
        let count = match indices {
            Some(indices) => {
                check_indices(hardware, &indices, draw.vertex_count)?;
                indices.count
            }
            None => draw.vertex_count,
        };
        if draw.topology.primitives(count) == 0 {
            return Ok(());
        }

        let used = really_used(&state, draw);
        let masks = target.subpixel.is_some();
        let units = Units::GEOMETRY | path_unit(target.hidden_surface) | effect_units(used, masks) | probe;
        self.power.call(hardware, used);
        self.power.need(hardware, units);
        outcome(hardware.draw(&state, draw))
    }
}

/// The flags word of a draw, word 1.
fn draw_flags(flags: u32) -> Result<DrawFlags, Fault> {
    Claim::word(1, flags).mean(DrawFlags::from_code(flags))
}

/// Samples the draw state.
fn draw_state<H: Hardware>(hardware: &H, target: &Target) -> Result<DrawState, Fault> {
    let effects_claim = registers::sample(hardware, Reg::Effects);
    let capability = hardware.register(Reg::CapabilityEffects, 0);
    let called = registers::effect_bits(effects_claim, capability)?;
    effects_claim.require(target.has_depth() || !called.contains(Effects::DEPTH))?;
    effects_claim.require(target.subpixel.is_some() || !called.contains(Effects::ANTI_ALIAS))?;

    let stencil = effects::stencil(hardware, target, called)?;
    // Without colours nobody asks what they would have been; a texture can have holes all the same.
    let mut called = called;
    if stencil.is_some_and(|stencil| stencil.colour_off) {
        called.remove(Effects::GOURAUD | Effects::LIGHT | Effects::FOG);
        if !called.contains(Effects::PUNCH_THROUGH) {
            called.remove(Effects::TEXTURE | Effects::MIP_MAP);
        }
    }

    let control = registers::sample(hardware, Reg::DepthControl);
    Ok(DrawState {
        effects: called,
        depth_function: control.mean(DepthFunction::from_code(control.value & 7))?,
        depth_write: control.value & 0x100 != 0,
        material_colour: hardware.register(Reg::MaterialColour, 0),
        tag: hardware.register(Reg::ObjectTag, 0),
        scissor: registers::scissor(hardware, target.colour.width, target.colour.height),
        line_width: registers::extent(registers::sample(hardware, Reg::LineWidth))?,
        point_size: registers::extent(registers::sample(hardware, Reg::PointSize))?,
        texture: effects::texture(hardware, called)?,
        punch_through: effects::punch_through(hardware, called),
        light: effects::light(hardware, called)?,
        fog: effects::fog(hardware, called)?,
        blend: effects::blend(hardware, called)?,
        stencil,
    })
}

/// Every index names one of `vertex_count` vertices, also those that make no primitive.
fn check_indices<H: Hardware>(hardware: &mut H, indices: &Indices<'_>, vertex_count: u32) -> Result<(), Fault> {
    let bad = match indices.words {
        Words::Inline(words) => {
            (indices.word..).zip(words).find(|&(_, &index)| index >= vertex_count).map(|(word, &index)| (word, index))
        }
        Words::Memory { words: 0, .. } => None,
        Words::Memory { .. } => hardware
            .largest_index(&indices.words)
            .filter(|&(index, _)| index >= vertex_count)
            .map(|(index, _)| (indices.word, index)),
    };
    match bad {
        Some((word, index)) => Err(Fault::new(FaultCode::BadIndex, word, index)),
        None => Ok(()),
    }
}
