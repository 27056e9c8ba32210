//! Waveforms, read back with the parser of the `vcd` crate.

use super::scenes::target;
use super::*;
use crate::hidden::held::{Held, Item};
use crate::hidden::systolic::{Waves, draw_scene};
use std::collections::HashMap;
use vcd::{Command, IdCode, Parser, TimescaleUnit, Value};
use zga_abi::format::{DepthFormat, PixelFormat};
use zga_firmware::checked::{Rectangle, Target};

/// A waveform: the values of its signals at each time, most significant bit first.
struct Wave {
    header: vcd::Header,
    at: Vec<(u64, HashMap<IdCode, String>)>,
}

impl Wave {
    fn parse(text: &[u8]) -> Wave {
        let mut parser = Parser::new(text);
        let header = parser.parse_header().expect("a header");
        let mut wave = Wave { header, at: Vec::new() };
        let mut values: HashMap<IdCode, String> = HashMap::new();
        for command in parser {
            match command.expect("a command") {
                Command::Timestamp(time) => {
                    wave.at.last_mut().map(|last| last.1.clone_from(&values)).unwrap_or_default();
                    wave.at.push((time, HashMap::new()));
                }
                Command::ChangeScalar(id, value) => {
                    values.insert(id, value.to_string());
                }
                Command::ChangeVector(id, vector) => {
                    values.insert(id, vector.iter().map(|value: Value| value.to_string()).collect());
                }
                _ => {}
            }
        }
        wave
    }

    /// What a signal is at a time, as a number; `None` where nobody drives it.
    fn value(&self, time: u64, path: &[&str]) -> Option<u64> {
        let full = [&["card", "systolic"], path].concat();
        let id = self.header.find_var(&full).expect("a signal").code;
        let (_, values) = self.at.iter().rfind(|(at, _)| *at <= time).expect("a time");
        u64::from_str_radix(&values[&id], 2).ok()
    }
}

/// Two lines of 8 pixels; on the first a token with X = 1, dX = 4, Z = 40, tag 1.
fn scene(super_buffer: bool) -> (Held, Target) {
    let target = target(8, 2, DepthFormat::default(), PixelFormat::Xrgb8888, false);
    let area = Rectangle { x: 1, y: 0, right: 6, bottom: 1 };
    let items = vec![Item::Clear { area, colour: Some(0xFF), depth: Some(40), stencil: None }];
    let systolic = SystolicSetting { super_buffer, ..SystolicSetting::default() };
    (Held { items, ..Held::default() }, Target { systolic, ..target })
}

fn record(super_buffer: bool, mut waves: Waves, level: Option<Level>) -> Vec<u8> {
    let (held, target) = scene(super_buffer);
    let mut colour = vec![0; 2 * target.colour.pitch as usize / 4];
    let _ = draw_scene(&held, &target, &mut colour, &mut [], level, Some(&mut waves));
    waves.finish()
}

#[test]
fn waves_known_token_stands_in_the_registers_at_known_times() {
    let wave = Wave::parse(&record(false, Waves::new(0, 0..100, 0..8), Some(Level::new())));

    assert_eq!(wave.header.timescale, Some((1, TimescaleUnit::NS)));
    // The token enters in clocks 0 to 2: T1, T2, T3.
    assert_eq!([0, 10, 20].map(|time| wave.value(time, &["feeder", "A"])), [Some(1), Some(40 << 32), Some(40 << 32)]);
    assert_eq!([0, 10, 20].map(|time| wave.value(time, &["feeder", "B"])), [Some(4), Some(0), Some(1)]);
    assert_eq!([0, 10].map(|time| wave.value(time, &["feeder", "CTRL"])), [Some(1), Some(2)]);
    // Clock 1: element 1 in T1, where the segment starts; its registers show it from 20 ns on.
    assert_eq!([0, 10, 20, 30, 40].map(|time| wave.value(time, &["pe[001]", "phase"])), [0, 1, 2, 3, 1].map(Some));
    assert_eq!([10, 20].map(|time| wave.value(time, &["pe[001]", "IN"])), [Some(0), Some(1)]);
    assert_eq!([20, 30].map(|time| wave.value(time, &["pe[001]", "A"])), [Some(4), Some(40 << 32)]);
    // Clock 3: its T3.
    let far = u64::from(DepthFormat::default().maximum());
    assert_eq!([30, 40].map(|time| wave.value(time, &["pe[001]", "Zb"])), [Some(far), Some(40)]);
    assert_eq!([30, 40].map(|time| wave.value(time, &["pe[001]", "Ib"])), [Some(0), Some(1)]);
    // Element 6 finds the end of the segment in clock 6.
    assert_eq!(wave.value(70, &["pe[006]", "A"]), Some(u64::MAX));
    // The refresh token begins to enter in clock 3: pixel i on the bus in clock 5 + i.
    let bus: Vec<_> = (4..14).map(|clock| wave.value(10 * clock, &["bus", "luminance"])).collect();
    assert_eq!(bus, [None, Some(0), Some(1), Some(1), Some(1), Some(1), Some(1), Some(0), Some(0), Some(0)]);
    assert_eq!([4, 5].map(|clock| wave.value(10 * clock, &["bus", "valid"])), [Some(0), Some(1)]);
    // The clock is high in the first half of its 10 ns.
    assert_eq!([50, 54, 55, 59].map(|time| wave.value(time, &["clock"])), [1, 1, 0, 0].map(Some));
}

#[test]
fn waves_range_of_a_line_holds_those_clocks_and_elements_only() {
    // The second line begins in clock 6, when the first refresh token has entered.
    let wave = Wave::parse(&record(false, Waves::new(1, 2..5, 3..5), Some(Level::new())));

    let times: Vec<u64> = wave.at.iter().map(|(time, _)| *time).collect();
    assert_eq!(times, [80, 85, 90, 95, 100, 105, 110]);
    let known = |element: &str| wave.header.find_var(&["card", "systolic", element, "A"]).is_some();
    assert_eq!(["pe[002]", "pe[003]", "pe[004]", "pe[005]"].map(known), [false, true, true, false]);
    // Element 3 puts its pixel on the bus in clock 8.
    assert_eq!(wave.value(80, &["bus", "luminance"]), Some(1));
}

#[test]
fn waves_every_level_records_the_same() {
    for super_buffer in [false, true] {
        let record = |level| record(super_buffer, Waves::new(0, 0..60, 0..8), level);
        let expected = record(None);
        assert!(!expected.is_empty());
        assert!(levels().into_iter().all(|level| record(Some(level)) == expected));
    }
}

#[test]
fn waves_super_buffer_pixel_comes_out_every_second_clock() {
    let wave = Wave::parse(&record(true, Waves::new(0, 0..20, 0..8), Some(Level::new())));

    // One token, then the refresh token in clock 1: pixel i in clock 2 + 2 i.
    let bus: Vec<_> = (1..8).map(|clock| wave.value(10 * clock, &["bus", "luminance"])).collect();
    assert_eq!(bus, [None, Some(0), None, Some(1), None, Some(1), None]);
    assert_eq!(wave.value(0, &["feeder", "XR"]), Some(5));
}

#[test]
fn waves_without_a_scene_holds_nothing() {
    assert!(Waves::new(0, 0..10, 0..10).finish().is_empty());
}
