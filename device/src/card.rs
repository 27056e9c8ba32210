//! The card: its blocks, the wires between them, and the step loop of its own thread.
//!
//! Duties: wires the firmware to the units; steps the front end; serves reset, save, restore and
//! power-off between two packets.
//! Inputs: packets, requests. Outputs: none of its own. Clocks: none of its own.
//!
//! The card's thread holds video memory while it works, and lets go between two packets when the
//! host waits for it, so a burst of the host sees memory before or after a packet, never within one.

use crate::bitmap::{Bitmap, fill, transfer};
use crate::bus::backplane::Backplane;
use crate::frontend::control::{ControlPort, Request};
use crate::frontend::{Frontend, Wired, charge_packet};
use crate::geometry::GeometryRegisters;
use crate::memory::VideoMemory;
use crate::pipeline::Pipeline;
use crate::probe::account::{Account, Clocks};
use crate::probe::{Probe, snapshot};
use crate::scanout::Scanout;
use parking_lot::MutexGuard;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::Ordering::SeqCst;
use zga_abi::bus::INTERRUPT_FENCE;
use zga_abi::{Counter, Fault, Reg, Units};
use zga_firmware::checked::{
    Clear, Combine, CombineSource, Compose, Convert, Copy, CopyList, Draw, DrawState, ExpandList, Fill, FillList, Mask,
    Paint, Rows, SegmentList, Shadow, Stretch, Target, Words,
};
use zga_firmware::{Hardware, Processor, ProcessorState, Stopped};

/// Units that [`Pipeline`] stands for.
const PIPELINE: Units = Units::GEOMETRY
    .union(Units::Z_BUFFER)
    .union(Units::ZA)
    .union(Units::SYSTOLIC)
    .union(Units::TILE)
    .union(Units::SHADING)
    .union(Units::SUBPIXEL);
/// WATCHDOG counts in units of this many clocks.
const WATCHDOG_UNIT: u64 = 1 << 20;

/// The blocks that only the card's own thread touches.
pub(crate) struct Blocks {
    pub(crate) pipeline: Pipeline,
    pub(crate) bitmap: Bitmap,
    pub(crate) scanout: Scanout,
    pub(crate) probe: Probe,
    /// What was counted since it was last published.
    pub(crate) account: Account,
    pub(crate) powered: Units,
}

/// The card's side of everything.
pub(crate) struct Board {
    pub(crate) backplane: Arc<Backplane>,
    pub(crate) control: ControlPort,
    pub(crate) frontend: Frontend,
    pub(crate) blocks: Blocks,
}

impl Board {
    /// The card's thread: until power-off.
    pub(crate) fn run(mut self) {
        while self.attend() {
            self.work();
            self.rest();
        }
    }

    /// Steps until there is nothing to do, or the host has a request.
    fn work(&mut self) {
        let Board { backplane, control, frontend, blocks } = self;
        let mut wiring = Wiring { memory: backplane.memory.lock(), backplane, blocks };
        while control.requests.is_empty() {
            let stepped = frontend.step(&mut wiring);
            wiring.tick();
            if !stepped {
                break;
            }
            MutexGuard::bump(&mut wiring.memory);
        }
        wiring.publish();
    }

    /// Sleeps until somebody rings, or a vertical blank is due.
    fn rest(&mut self) {
        let due = self.blocks.scanout.deadline(&self.backplane);
        self.backplane.active.store(false, SeqCst);
        // All ends of the wait mean the same: look for work.
        let _ = match due {
            Some(due) => self.control.bell.recv_deadline(due).ok(),
            None => self.control.bell.recv().ok(),
        };
        self.backplane.active.store(true, SeqCst);
    }

    /// Serves the host's requests; false at power-off.
    fn attend(&mut self) -> bool {
        // A stop comes just before its request: that one is waited for.
        while self.backplane.control.stopping() || !self.control.requests.is_empty() {
            match self.control.requests.recv() {
                // An answer that nobody waits for any more is no harm.
                Ok(Request::Reset(done)) => {
                    self.reset();
                    let _ = done.send(());
                }
                Ok(Request::Save(done)) => {
                    let _ = done.send(snapshot::save(self));
                }
                Ok(Request::Restore(state, done)) => {
                    let _ = done.send(snapshot::restore(self, &state));
                }
                Ok(Request::Record(waves, done)) => {
                    self.blocks.pipeline.record(waves);
                    let _ = done.send(());
                }
                Ok(Request::TakeRecorded(answer)) => {
                    let _ = answer.send(self.blocks.pipeline.take_recorded());
                }
                Ok(Request::RecordSubpixels(done)) => {
                    self.blocks.pipeline.record_subpixels();
                    let _ = done.send(());
                }
                Ok(Request::TakeSubpixels(answer)) => {
                    let _ = answer.send(self.blocks.pipeline.take_subpixels());
                }
                Ok(Request::PowerOff) | Err(_) => return false,
            }
        }
        true
    }

    /// The command processor of a snapshot, checked against this card.
    pub(crate) fn processor_of(&mut self, state: &ProcessorState) -> Result<Processor, Fault> {
        let Board { backplane, blocks, .. } = self;
        Processor::from_state(&Wiring { memory: backplane.memory.lock(), backplane, blocks }, state)
    }

    /// Soft reset of every block; both memories stay.
    fn reset(&mut self) {
        let Board { backplane, frontend, blocks, .. } = self;
        frontend.fifo.reset(&backplane.fifo);
        frontend.ring.forget();
        frontend.processor.reset();
        blocks.pipeline.power_off(&mut backplane.memory.lock());
        blocks.bitmap.power_off();
        blocks.scanout.reset();
        blocks.probe.reset();
        blocks.account.clear();
        blocks.powered = Units::empty();
        backplane.ring.load(Default::default(), false, false);
        backplane.registers.reset();
        backplane.counters.lock().clear();
        backplane.interrupts.set(0, 0);
        backplane.in_scene.store(false, SeqCst);
        backplane.control.reset_done();
    }
}

/// No bytes.
const NOTHING: Range<u64> = 0..0;

/// Asks whether a packet that has taken so many clocks is to stop.
fn watch(backplane: &Backplane) -> impl Fn(Clocks) -> Option<Stopped> {
    let limit = match backplane.registers.get(Reg::Watchdog) {
        0 => u64::MAX,
        units => u64::from(units) * WATCHDOG_UNIT,
    };
    move |spent| match (backplane.control.stopping(), spent.0 > limit) {
        (true, _) => Some(Stopped::Reset),
        (_, true) => Some(Stopped::Watchdog),
        _ => None,
    }
}

/// The firmware's pins wired to the units, while the card's thread holds video memory.
struct Wiring<'a> {
    backplane: &'a Backplane,
    memory: MutexGuard<'a, VideoMemory>,
    blocks: &'a mut Blocks,
}

impl Wiring<'_> {
    fn tick(&mut self) {
        self.blocks.scanout.tick(self.backplane, &mut self.memory, &mut self.blocks.account);
    }

    /// After a clear or draw: the probe's records go to memory.
    fn store_records(&mut self) {
        let Blocks { probe, account, .. } = &mut *self.blocks;
        probe.store(&self.backplane.registers, &mut self.memory, account);
    }
}

impl Wired for Wiring<'_> {
    fn backplane(&self) -> &Backplane {
        self.backplane
    }

    fn memory(&self) -> &VideoMemory {
        &self.memory
    }

    fn publish(&mut self) {
        self.backplane.publish(&mut self.blocks.account);
    }
}

impl Hardware for Wiring<'_> {
    fn register(&self, register: Reg, word: u32) -> u32 {
        self.backplane.registers.word(register, word)
    }

    fn set_register(&mut self, register: Reg, word: u32, value: u32) {
        self.backplane.registers.put(register, word, value);
    }

    fn power(&mut self, units: Units) {
        self.blocks.powered = units;
    }

    fn begin_scene(&mut self, target: &Target) {
        let Blocks { pipeline, probe, account, .. } = &mut *self.blocks;
        probe.begin_scene();
        pipeline.begin_scene(&mut self.memory, target, account);
    }

    fn end_scene(&mut self, shadow: Option<&Shadow>) -> Result<(), Stopped> {
        let stop = watch(self.backplane);
        let Blocks { pipeline, bitmap, scanout, account, powered, .. } = &mut *self.blocks;
        let ended = pipeline.end_scene(&mut self.memory, shadow, account, &stop);
        // Begin scene takes all power away. Memory goes back only now, from what the scene did not
        // call for: a unit that every scene needs keeps its memory from one to the next.
        if !powered.intersects(PIPELINE) {
            pipeline.power_off(&mut self.memory);
        }
        if !powered.contains(Units::TEXTURE) {
            pipeline.power_texture_off(&mut self.memory);
        }
        if !powered.contains(Units::SUBPIXEL) {
            pipeline.power_subpixels_off();
        }
        if !powered.contains(Units::SHADING) {
            pipeline.power_layers_off();
        }
        if !powered.intersects(Units::SUBPIXEL | Units::SHADING) {
            pipeline.power_scene_off();
        }
        if !powered.contains(Units::BITMAP) {
            bitmap.power_off();
        }
        if !powered.contains(Units::SCANOUT) && !self.backplane.cable.is_watched() {
            scanout.power_off();
        }
        ended
    }

    fn clear(&mut self, clear: &Clear) {
        let stop = watch(self.backplane);
        let Blocks { pipeline, probe, account, .. } = &mut *self.blocks;
        probe.clear(&self.backplane.registers, clear, |x, y| pipeline.depth_at(&self.memory, x, y));
        pipeline.clear(&mut self.memory, clear, account, &stop);
        self.store_records();
    }

    fn draw(&mut self, state: &DrawState, draw: &Draw<'_>) -> Result<(), Stopped> {
        let Backplane { registers, .. } = self.backplane;
        let Blocks { pipeline, probe, account, .. } = &mut *self.blocks;
        let geometry = GeometryRegisters {
            object_eye: registers.floats(Reg::ObjectEye),
            decal: registers.floats(Reg::Decal),
            eye_clip: registers.floats(Reg::EyeClip),
            viewport: registers.floats(Reg::Viewport),
        };
        let stop = watch(self.backplane);
        let probed = probe.watch(registers);
        let drawn = pipeline.draw(&mut self.memory, &geometry, state, draw, probed, account, &stop);
        self.store_records();
        drawn
    }

    fn largest_index(&mut self, indices: &Words<'_>) -> Option<(u32, u32)> {
        let words = match *indices {
            Words::Inline(words) => words,
            Words::Memory { address, words } => &self.memory.words()[(address / 4) as usize..][..words as usize],
        };
        let largest = words.iter().copied().max()?;
        (0..).zip(words).find(|&(_, &index)| index == largest).map(|(place, _)| (largest, place))
    }

    fn fill(&mut self, fill: &Fill) {
        let account = &mut self.blocks.account;
        let memory = self.memory.using(NOTHING, fill.surface.bytes(), account);
        fill::fill(memory, fill, account);
    }

    fn copy(&mut self, copy: &Copy) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(copy.source.bytes(), copy.destination.bytes(), account);
        bitmap.copy(memory, copy, account);
    }

    fn combine(&mut self, combine: &Combine) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let read = match &combine.source {
            CombineSource::Value(_) => NOTHING,
            CombineSource::Image(source) => source.bytes(),
        };
        let memory = self.memory.using(read, combine.destination.bytes(), account);
        bitmap.combine(memory, combine, account);
    }

    fn convert(&mut self, convert: &Convert) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(convert.source.bytes(), convert.destination.bytes(), account);
        bitmap.convert(memory, convert, account);
    }

    fn stretch(&mut self, stretch: &Stretch) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(stretch.source.bytes(), stretch.destination.bytes(), account);
        bitmap.stretch(memory, stretch, account);
    }

    fn fill_list(&mut self, fill: &FillList<'_>) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(NOTHING, fill.canvas.surface.bytes(), account);
        bitmap.fill_list(memory, fill, account);
    }

    fn copy_list(&mut self, copy: &CopyList<'_>) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(copy.source.bytes(), copy.canvas.surface.bytes(), account);
        bitmap.copy_list(memory, copy, account);
    }

    fn segments(&mut self, segments: &SegmentList<'_>) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(NOTHING, segments.canvas.surface.bytes(), account);
        bitmap.segments(memory, segments, account);
    }

    fn expand(&mut self, expand: &ExpandList<'_>) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(NOTHING, expand.canvas.surface.bytes(), account);
        bitmap.expand(memory, expand, account);
    }

    fn compose(&mut self, compose: &Compose<'_>) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let bytes = |paint: &Paint| match paint {
            Paint::Colour(_) => NOTHING,
            Paint::Picture(sampled) => sampled.picture.image.bytes(),
        };
        if let Mask::Paint(paint) = &compose.mask {
            self.memory.reading(bytes(paint), account);
        }
        let memory = self.memory.using(bytes(&compose.source), compose.onto.image.bytes(), account);
        bitmap.compose(memory, compose, account);
    }

    fn upload(&mut self, rows: &Rows, words: &[u32]) {
        let account = &mut self.blocks.account;
        let memory = self.memory.using(NOTHING, rows.bytes(), account);
        transfer::upload(memory, rows, words, account);
    }

    fn download(&mut self, rows: &Rows, destination: u32) {
        let Blocks { bitmap, account, .. } = &mut *self.blocks;
        let memory = self.memory.using(rows.bytes(), rows.run_at(destination), account);
        bitmap.download(memory, rows, destination, account);
    }

    fn fence(&mut self, sequence: u32) {
        self.blocks.account.add(Counter::FrontendFences, 1);
        self.publish();
        self.backplane.registers.set(Reg::FenceSequence, sequence);
        self.backplane.interrupts.raise(INTERRUPT_FENCE);
    }

    fn present(&mut self, base: u32) {
        let Blocks { scanout, account, .. } = &mut *self.blocks;
        scanout.present(self.backplane, &mut self.memory, base, account);
    }

    fn write_back(&mut self, destination: u32) {
        let Blocks { scanout, account, .. } = &mut *self.blocks;
        scanout.write_back(self.backplane, &mut self.memory, destination, account);
    }

    fn packet_taken(&mut self, words: u32) {
        charge_packet(words, &mut self.blocks.account);
    }
}
