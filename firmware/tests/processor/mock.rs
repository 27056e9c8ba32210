//! A card without units: it records every call and checks that its arguments keep their promises.

use crate::invariants;
use std::collections::BTreeMap;
use zga_abi::format::Topology;
use zga_abi::registers::REGISTERS;
use zga_abi::{Reg, Units};
use zga_firmware::checked::{
    Clear, Combine, Compose, Convert, Copy, CopyList, Draw, DrawState, ExpandList, Fill, FillList, Rows, SegmentList,
    Shadow, Stretch, Target, Words,
};
use zga_firmware::{Hardware, Stopped};

/// Bytes of video memory.
pub const MEMORY: u32 = 0x0010_0000;

/// A run of words that outlives the packet.
#[derive(Clone, Debug, PartialEq)]
pub enum Run {
    /// In the packet.
    Inline(Vec<u32>),
    /// In video memory: address, words.
    Memory(u32, u32),
}

impl From<Words<'_>> for Run {
    fn from(words: Words<'_>) -> Run {
        match words {
            Words::Inline(words) => Run::Inline(words.to_vec()),
            Words::Memory { address, words } => Run::Memory(address, words),
        }
    }
}

/// A draw that outlives the packet.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    pub topology: Topology,
    pub coloured: bool,
    pub normals: bool,
    pub coordinates: bool,
    pub vertices: Run,
    pub vertex_count: u32,
    pub indices: Option<Run>,
}

/// A call of the firmware.
#[derive(Clone, Debug, PartialEq)]
pub enum Call {
    PacketTaken(u32),
    /// Byte offset, value.
    SetRegister(u32, u32),
    Power(Units),
    BeginScene(Target),
    EndScene(Option<Shadow>),
    Clear(Clear),
    Draw(DrawState, Drawn),
    Fill(Fill),
    Copy(Copy),
    Combine(Combine),
    Convert(Convert),
    /// The list as text: it does not outlive the packet.
    List(String),
    Stretch(Stretch),
    Upload(Rows, Vec<u32>),
    Download(Rows, u32),
    Fence(u32),
    Present(u32),
    WriteBack(u32),
}

/// The card.
pub struct Mock {
    /// What was called, in order.
    pub calls: Vec<Call>,
    /// Words of video memory that are not 0, by byte address.
    pub memory: BTreeMap<u32, u32>,
    /// What the next draws and ends of scenes stop with.
    pub stop: Option<Stopped>,
    /// The units powered.
    pub units: Units,
    /// The target of the scene.
    pub target: Option<Target>,
    registers: Vec<u32>,
}

impl Mock {
    /// A card after power-on that has every effect and path.
    pub fn new() -> Mock {
        let mut mock = Mock {
            calls: Vec::new(),
            memory: BTreeMap::new(),
            stop: None,
            units: Units::empty(),
            target: None,
            registers: vec![0; 0x2000],
        };
        for register in REGISTERS {
            for word in 0..register.count {
                mock.set(register.word_offset(word), register.reset_value(word));
            }
        }
        mock.set(0x0008, 0xFFF);
        mock.set(0x000C, 0xF);
        mock.set(0x0010, MEMORY);
        mock.set(0x0014, 0x1_0000);
        mock
    }

    /// Sets the register at a byte offset to any value.
    pub fn set(&mut self, offset: u32, value: u32) {
        self.registers[offset as usize / 4] = value;
    }

    /// The register at a byte offset.
    pub fn get(&self, offset: u32) -> u32 {
        self.registers[offset as usize / 4]
    }

    fn outcome(&self) -> Result<(), Stopped> {
        self.stop.map_or(Ok(()), Err)
    }

    /// Records a call of a unit, which has power.
    fn work(&mut self, needed: Units, call: Call) {
        assert!(self.units.contains(needed | Units::FRONTEND), "{call:?} needs {needed:?}, powered {:?}", self.units);
        self.calls.push(call);
    }

    fn scene(&self) -> Target {
        self.target.expect("a scene was begun")
    }
}

impl Hardware for Mock {
    fn register(&self, register: Reg, word: u32) -> u32 {
        assert!(word < register.info().count);
        self.get(register.info().word_offset(word))
    }

    fn set_register(&mut self, register: Reg, word: u32, value: u32) {
        let offset = register.info().word_offset(word);
        let old = self.get(offset);
        invariants::register_write(register, word, old, value);
        self.set(offset, value);
        self.calls.push(Call::SetRegister(offset, value));
    }

    fn power(&mut self, units: Units) {
        assert_ne!(units, self.units, "power is set only when it changes");
        self.units = units;
        self.calls.push(Call::Power(units));
    }

    fn begin_scene(&mut self, target: &Target) {
        assert_eq!(self.target, None, "scenes do not nest");
        invariants::target(self, target);
        self.target = Some(*target);
        self.work(Units::empty(), Call::BeginScene(*target));
    }

    fn end_scene(&mut self, shadow: Option<&Shadow>) -> Result<(), Stopped> {
        let target = self.scene();
        assert!(shadow.is_none() || target.stencil.is_some(), "shadows come from a stencil plane");
        self.target = None;
        self.work(Units::empty(), Call::EndScene(shadow.copied()));
        self.outcome()
    }

    fn clear(&mut self, clear: &Clear) {
        let target = self.scene();
        invariants::clear(&target, clear);
        self.work(invariants::path_unit(&target), Call::Clear(*clear));
    }

    fn draw(&mut self, state: &DrawState, draw: &Draw<'_>) -> Result<(), Stopped> {
        let target = self.scene();
        invariants::draw(self, &target, state, draw);
        let drawn = Drawn {
            topology: draw.topology,
            coloured: draw.coloured,
            normals: draw.normals,
            coordinates: draw.coordinates,
            vertices: draw.vertices.into(),
            vertex_count: draw.vertex_count,
            indices: draw.indices.map(Run::from),
        };
        let needed = Units::GEOMETRY | invariants::path_unit(&target);
        self.work(needed, Call::Draw(*state, drawn));
        self.outcome()
    }

    fn largest_index(&mut self, indices: &Words<'_>) -> Option<(u32, u32)> {
        invariants::words(self, indices);
        invariants::each(self, indices).zip(0..).max_by_key(|&(index, place)| (index, std::cmp::Reverse(place)))
    }

    fn fill(&mut self, fill: &Fill) {
        invariants::surface(self, &fill.surface);
        self.work(Units::BITMAP, Call::Fill(*fill));
    }

    fn copy(&mut self, copy: &Copy) {
        let (source, destination) = (&copy.source, &copy.destination);
        invariants::surface(self, source);
        invariants::surface(self, destination);
        assert_eq!(source.format, destination.format);
        assert_eq!((source.width, source.height), (destination.width, destination.height));
        self.work(Units::BITMAP, Call::Copy(*copy));
    }

    fn combine(&mut self, combine: &Combine) {
        invariants::combine(self, combine);
        self.work(Units::BITMAP, Call::Combine(*combine));
    }

    fn convert(&mut self, convert: &Convert) {
        let (source, destination) = (&convert.source, &convert.destination);
        invariants::image(self, source);
        invariants::image(self, destination);
        assert_eq!((source.width, source.height), (destination.width, destination.height));
        self.work(Units::BITMAP, Call::Convert(*convert));
    }

    fn stretch(&mut self, stretch: &Stretch) {
        invariants::stretch(self, stretch);
        self.work(Units::BITMAP, Call::Stretch(*stretch));
    }

    fn fill_list(&mut self, list: &FillList<'_>) {
        invariants::canvas(self, &list.canvas);
        assert_eq!(list.rectangles().len() * 2, list.entries.len());
        self.work(Units::BITMAP, Call::List(format!("{list:?}")));
    }

    fn copy_list(&mut self, list: &CopyList<'_>) {
        invariants::canvas(self, &list.canvas);
        invariants::image(self, &list.source);
        assert_eq!(list.source.format, list.canvas.surface.format);
        assert!(list.offset.iter().all(|pixels| pixels.abs() <= 65535));
        assert_eq!(list.rectangles().len() * 2, list.entries.len());
        self.work(Units::BITMAP, Call::List(format!("{list:?}")));
    }

    fn segments(&mut self, list: &SegmentList<'_>) {
        invariants::canvas(self, &list.canvas);
        assert!(list.flags.strip || list.entries.len().is_multiple_of(2));
        assert_eq!(list.segments().count(), list.segments().len());
        self.work(Units::BITMAP, Call::List(format!("{list:?}")));
    }

    fn expand(&mut self, list: &ExpandList<'_>) {
        invariants::canvas(self, &list.canvas);
        let words: usize = list.bitmaps().map(|bitmap| 2 + bitmap.rows.len()).sum();
        assert_eq!(words, list.entries.len());
        self.work(Units::BITMAP, Call::List(format!("{list:?}")));
    }

    fn compose(&mut self, compose: &Compose<'_>) {
        invariants::compose(self, compose);
        self.work(Units::BITMAP, Call::List(format!("{compose:?}")));
    }

    fn upload(&mut self, rows: &Rows, words: &[u32]) {
        invariants::rows(self, rows);
        assert_eq!(words.len() as u64, u64::from(rows.words) * u64::from(rows.rows));
        self.work(Units::BITMAP, Call::Upload(*rows, words.to_vec()));
    }

    fn download(&mut self, rows: &Rows, destination: u32) {
        invariants::rows(self, rows);
        invariants::run(self, destination, u64::from(rows.words) * u64::from(rows.rows));
        self.work(Units::BITMAP, Call::Download(*rows, destination));
    }

    fn fence(&mut self, sequence: u32) {
        self.calls.push(Call::Fence(sequence));
    }

    fn present(&mut self, base: u32) {
        invariants::shown(self, base);
        self.work(Units::SCANOUT, Call::Present(base));
    }

    fn write_back(&mut self, destination: u32) {
        let (width, height) = invariants::shown(self, self.get(0x0688));
        invariants::run(self, destination, u64::from(width) * u64::from(height));
        self.work(Units::SCANOUT, Call::WriteBack(destination));
    }

    fn packet_taken(&mut self, words: u32) {
        self.calls.push(Call::PacketTaken(words));
    }
}
