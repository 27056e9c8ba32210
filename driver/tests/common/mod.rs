//! What the tests on the mock bus share.

use std::time::Duration;

use zga_driver::bus::MockBus;
use zga_driver::{Driver, DriverOptions, Submit, Target, TargetOptions, Vertex};

/// Bytes of the mock card's video memory.
pub const MEMORY: u32 = 4 << 20;

/// A driver on a mock card of 4 MiB, with a ring of 4096 words.
pub fn driver(submit: Submit) -> Driver<MockBus> {
    let options = DriverOptions { submit, ring_words: 4096, timeout: Duration::from_millis(1) };
    let mut driver = Driver::open_with(MockBus::new(MEMORY), options).expect("the mock card opens");
    driver.bus_mut().take_accesses();
    driver
}

/// A target of 64 x 48 pixels with a Z buffer.
pub fn target(driver: &mut Driver<MockBus>) -> Target {
    driver.create_target(TargetOptions::new(64, 48)).expect("room for a target")
}

/// A triangle in one colour.
pub fn triangle(colour: [u8; 4]) -> [Vertex; 3] {
    [[1.0, 2.0, 0.5], [30.0, 2.0, 0.5], [1.0, 40.0, 0.5]].map(|position| Vertex::new(position, colour))
}

/// Opcodes of packets, in order.
pub fn opcodes(packets: &[Vec<u32>]) -> Vec<u32> {
    packets.iter().map(|packet| packet[0] >> 24).collect()
}
