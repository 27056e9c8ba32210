//! How fast the clocked models are stepped: elements times clocks a second, on one core.

use super::*;
use crate::hidden::systolic::super_buffer::{Slot, SuperBuffer};
use std::hint::black_box;
use std::time::Instant;

/// Elements stepped, times clocks, in each measurement.
const WORK: u64 = 1 << 30;

/// PE-clocks a second; the tokens leave no bubble.
fn rate<M: Machine>(mut machine: M, width: u32, ports: &[M::Port]) -> f64 {
    let clocks = WORK / u64::from(width);
    let start = Instant::now();
    for port in ports.iter().cycle().take(clocks as usize) {
        black_box(machine.clock(*port, FAR));
    }
    (clocks * u64::from(width)) as f64 / start.elapsed().as_secs_f64()
}

#[test]
#[ignore = "measures the host: cargo test --release -p zga-device --lib systolic::tests::rate -- --ignored --nocapture"]
fn array_dense_tokens_steps_1e9_elements_a_second() {
    let setting = SystolicSetting::default();
    let mut best = 0.0_f64;
    for level in levels() {
        for width in [1024_u32, 4096] {
            let token =
                |k: u32| token((k * 61) % width, (k * 17) % (width - (k * 61) % width), i64::from(k % 97), 3, k);
            let tokens: Vec<Token> = (1..1001).map(token).collect();
            for below in [32, 24] {
                let beats: Vec<Beat> = tokens.iter().flat_map(|token| token.beats(&setting)).collect();
                let array = rate(Array::new(width, Rules { setting, below }, level), width, &beats);
                let slots: Vec<Slot> = tokens.iter().map(Slot::from).collect();
                let earlier = rate(SuperBuffer::new(width, below, level), width, &slots);
                println!("{level:?}, N = {width}, {below} bits below: array {array:.3e}, Super Buffer {earlier:.3e}");
                best = best.max(array);
            }
        }
    }
    assert!(best >= 1e9, "{best:.3e} PE-clocks a second");
}
