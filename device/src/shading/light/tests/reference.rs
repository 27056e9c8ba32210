//! The specification against f64 with the library's powers, and lanes against the specification.

use super::*;
use fearless_simd::dispatch;
use proptest::prelude::*;

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: V) -> V {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|c| c / length) } else { v }
}

fn channel(colour: u32, k: usize) -> f64 {
    f64::from(colour.to_le_bytes()[k])
}

/// Red, green and blue before the limit and the rounding; and how far the nearest condition is from turning over.
fn exact(lighting: &Lighting, records: &[LightRecord], colour: u32, position: [f32; 3], normal: [f32; 3]) -> (V, f64) {
    let position = position.map(f64::from);
    let viewer = if lighting.local_viewer { unit(position.map(|c| -c)) } else { [0.0, 0.0, 1.0] };
    let mut normal = unit(normal.map(f64::from));
    let mut margin = 1.0_f64;
    if lighting.two_sided {
        margin = margin.min(dot(normal, viewer).abs());
        if dot(normal, viewer) < 0.0 {
            normal = normal.map(|c| -c);
        }
    }
    let level = |k| channel(lighting.emission, k) + channel(colour, k) * channel(lighting.ambient, k) / 255.0;
    let mut levels = [level(0), level(1), level(2)];
    for record in records {
        let against = unit(record.direction.map(|c| -f64::from(c)));
        let away: V = std::array::from_fn(|k| f64::from(record.position[k]) - position[k]);
        let directional = record.kind == LightType::Directional.code();
        let towards = if directional { against } else { unit(away) };
        let mut attenuation = 1.0;
        if !directional && record.cut_off > 0.0 {
            let relative = dot(away, away) / f64::from(record.cut_off).powi(2);
            attenuation = (1.0 - relative).max(0.0).powi(2);
        }
        if record.kind == LightType::Spot.code() {
            let cosine = dot(towards, against);
            margin = margin.min(cosine.abs());
            let exponent = f64::from(record.spot_exponent);
            attenuation *= if cosine > 0.0 { cosine.powf(exponent) } else { 0.0 };
        }
        let incidence = dot(normal, towards);
        margin = margin.min(incidence.abs());
        let sum: V = std::array::from_fn(|k| towards[k] + viewer[k]);
        // A short sum has a direction as uncertain as it is short: below 1/8 the test asks no more.
        if dot(sum, sum) < 1.0 / 64.0 {
            margin = 0.0;
        }
        let shine = dot(normal, unit(sum)).max(0.0).powf(f64::from(lighting.shininess));
        let shine = if incidence > 0.0 { shine } else { 0.0 };
        for (k, level) in levels.iter_mut().enumerate() {
            let (light, ambient) = (channel(record.colour, k) / 255.0, channel(record.ambient, k) / 255.0);
            let diffuse = channel(colour, k) * (ambient + light * incidence.max(0.0));
            *level += attenuation * (diffuse + channel(lighting.specular, k) * light * shine);
        }
    }
    (levels, margin)
}

fn vector(size: f32) -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(-size..size)
}

/// Lights of a scene.
fn any_light() -> impl Strategy<Value = LightRecord> {
    let cut_off = prop_oneof![Just(0.0_f32), 5.0_f32..40.0];
    let exponent = prop_oneof![Just(0.0_f32), 0.0_f32..128.0];
    (0_u32..3, vector(10.0), vector(1.0), cut_off, exponent, any::<u32>(), any::<u32>()).prop_map(
        |(kind, position, direction, cut_off, spot_exponent, colour, ambient)| LightRecord {
            kind,
            position,
            direction,
            cut_off,
            spot_exponent,
            colour,
            ambient,
            reserved: [0; 5],
        },
    )
}

fn any_lighting() -> impl Strategy<Value = Lighting> {
    let colour = || prop_oneof![Just(0), any::<u32>()];
    let shininess = prop_oneof![Just(0.0_f32), Just(128.0), 0.0_f32..128.0];
    (any::<bool>(), any::<bool>(), colour(), colour(), colour(), shininess).prop_map(
        |(two_sided, local_viewer, ambient, specular, emission, shininess)| Lighting {
            two_sided,
            local_viewer,
            ambient,
            specular,
            emission,
            shininess,
            ..dull()
        },
    )
}

/// Any bits, and those that break things.
fn hostile() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -10.0_f32..10.0,
        2 => any::<u32>().prop_map(f32::from_bits),
        1 => prop::sample::select(vec![
            0.0, -0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-45, -1e-38, 2e19,
        ]),
    ]
}

fn hostile_light() -> impl Strategy<Value = LightRecord> {
    let vector = || prop::array::uniform3(hostile());
    let kind = prop_oneof![8 => 0_u32..3, 1 => any::<u32>()];
    (kind, vector(), vector(), hostile(), hostile(), any::<u32>(), any::<u32>()).prop_map(
        |(kind, position, direction, cut_off, spot_exponent, colour, ambient)| LightRecord {
            kind,
            position,
            direction,
            cut_off,
            spot_exponent,
            colour,
            ambient,
            reserved: [0; 5],
        },
    )
}

/// Of 16 lanes, `[axis][lane]`: some at one light, some without normal.
fn hostile_vectors() -> impl Strategy<Value = [[f32; 16]; 3]> {
    prop::array::uniform3(prop::array::uniform16(hostile()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn lit_is_the_rounded_level_of_exact_arithmetic(
        lighting in any_lighting(),
        records in prop::collection::vec(any_light(), 0..5),
        colour in any::<u32>(),
        position in vector(10.0),
        normal in vector(1.0),
    ) {
        let (levels, margin) = exact(&lighting, &records, colour, position, normal);
        // Cosines are within 15 * 2^-24 = 9e-7. Nearer than that to where a condition turns over, f32 may see it on the other
        // side, and a highlight comes or goes there with all its levels.
        prop_assume!(margin > 1e-5);
        let lit = lights(&lighting, &records).lit(colour, position, normal);
        prop_assert_eq!(lit >> 24, colour >> 24);
        for (k, level) in levels.into_iter().enumerate() {
            let found = channel(lit, k);
            // Half a level is the rounding. The rest is the highlight's, x^128 with x = cos t between unit vectors: x is within
            // (6 + 10 sin t / |L + V|) 2^-24 (its sums; how far H is turned), a level within 255 * 128 times that times x^127,
            // where sin t x^127 < 0.053: 0.002 (6 + 0.53 / |L + V|) < 0.02 from |L + V| = 1/8 on. Highlights that add up to more
            // than 255 are cut there, so many have no more error than one. Diffuse light: 255 * 15 * 2^-24, 0.0002.
            prop_assert!((found - level.min(255.0)).abs() <= 0.5 + 0.02, "{} for {}", found, level);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    #[test]
    fn lit_in_lanes_is_the_specification(
        lighting in any_lighting(),
        records in prop::collection::vec(hostile_light(), 0..6),
        colours in prop::array::uniform16(any::<u32>()),
        mut position in hostile_vectors(),
        normal in hostile_vectors(),
    ) {
        // Some lanes at a light itself.
        for (lane, record) in records.iter().enumerate() {
            (0..3).for_each(|k| position[k][lane] = record.position[k]);
        }
        let lights = lights(&lighting, &records);
        let at = |v: &[[f32; 16]; 3], lane: usize| [v[0][lane], v[1][lane], v[2][lane]];
        let expected: [u32; 16] =
            std::array::from_fn(|lane| lights.lit(colours[lane], at(&position, lane), at(&normal, lane)));
        for level in levels() {
            prop_assert_eq!(dispatch!(level, _simd => lights.lit_lanes(&colours, &position, &normal)), expected);
        }
    }
}
