//! A processor on a mock card, and short ways to feed it.

use crate::mock::{Call, Mock};
use zga_abi::{Fault, FaultCode};
use zga_firmware::Processor;

/// A processor and its card.
pub struct Bench {
    pub card: Mock,
    pub processor: Processor,
}

/// A packet with the right length in its header.
pub fn packet(opcode: u32, payload: &[u32]) -> Vec<u32> {
    let mut words = vec![(opcode << 24) | payload.len() as u32];
    words.extend_from_slice(payload);
    words
}

/// Three vertices without colours.
pub const TRIANGLE: [u32; 9] = [1, 2, 3, 4, 5, 6, 7, 8, 9];

impl Bench {
    /// After power-on.
    pub fn new() -> Bench {
        Bench { card: Mock::new(), processor: Processor::new() }
    }

    /// After power-on, with registers for a target of 64 x 32 pixels with Z buffer:
    /// colours in 0x1000..0x3000, depths in 0x4000..0x6000.
    pub fn with_target() -> Bench {
        let mut bench = Bench::new();
        bench.card.set(0x0200, (32 << 16) | 64);
        bench.card.set(0x0204, 0x1000);
        bench.card.set(0x0208, 256);
        bench.card.set(0x0210, 0x4000);
        bench.card.set(0x0214, 256);
        bench
    }

    /// The same with a stencil plane in 0x7000..0x7800.
    pub fn with_stencil_plane() -> Bench {
        let mut bench = Bench::with_target();
        bench.card.set(0x021C, 0x7000);
        bench.card.set(0x0220, 64);
        bench
    }

    /// The same inside a scene.
    pub fn in_scene_with_stencil_plane() -> Bench {
        let mut bench = Bench::with_stencil_plane();
        bench.good(0x02, &[]);
        bench
    }

    /// With a target inside a scene.
    pub fn in_scene() -> Bench {
        let mut bench = Bench::with_target();
        bench.good(0x02, &[]);
        bench
    }

    /// In a scene with 8x8 samples a pixel.
    pub fn in_scene_with_grid() -> Bench {
        let mut bench = Bench::with_target();
        bench.card.set(0x0260, 3);
        bench.good(0x02, &[]);
        bench
    }

    /// In a scene without Z buffer; EFFECTS is 0.
    pub fn in_scene_without_depth() -> Bench {
        let mut bench = Bench::with_target();
        bench.card.set(0x0214, 0);
        bench.card.set(0x0280, 0);
        bench.good(0x02, &[]);
        bench
    }

    /// Executes a packet; what it returned, and the calls after PacketTaken, which comes first.
    pub fn run(&mut self, packet: &[u32]) -> (Result<(), Fault>, Vec<Call>) {
        self.card.calls.clear();
        let result = self.processor.execute(&mut self.card, packet);
        let calls = std::mem::take(&mut self.card.calls);
        assert_eq!(calls[0], Call::PacketTaken(packet.len() as u32));
        (result, calls[1..].to_vec())
    }

    /// Executes a packet that is right; the calls after PacketTaken.
    pub fn good(&mut self, opcode: u32, payload: &[u32]) -> Vec<Call> {
        let (result, calls) = self.run(&packet(opcode, payload));
        assert_eq!(result, Ok(()));
        calls
    }

    /// Executes a packet that is right; its last call.
    pub fn last(&mut self, opcode: u32, payload: &[u32]) -> Call {
        self.good(opcode, payload).pop().expect("a call")
    }

    /// Executes a packet that is refused with nothing done.
    pub fn bad(&mut self, opcode: u32, payload: &[u32], code: FaultCode, word: u32, value: u32) {
        let before = self.processor.state();
        let (result, calls) = self.run(&packet(opcode, payload));
        assert_eq!(result, Err(Fault::new(code, word, value)));
        assert_eq!(calls, []);
        assert_eq!(self.processor.state(), before);
    }
}
