//! Properties of FLIP that the paper states or that follow from its definition.

use super::*;
use crate::harness::Random;

fn noise(random: &mut Random, count: usize) -> Vec<Rgb> {
    (0..count).map(|_| [(); 3].map(|()| random.between(0.0, 255.0).round())).collect()
}

#[test]
fn identical_pictures_differ_nowhere() {
    let picture = noise(&mut Random::new(1), 30 * 20);
    assert!(flip(&picture, &picture, 30, PIXELS_PER_DEGREE).iter().all(|difference| *difference == 0.0));
}

#[test]
fn differences_are_symmetric_and_between_0_and_1() {
    let mut random = Random::new(2);
    let [a, b] = [(); 2].map(|()| noise(&mut random, 30 * 20));
    let [there, back] = [flip(&a, &b, 30, PIXELS_PER_DEGREE), flip(&b, &a, 30, PIXELS_PER_DEGREE)];
    assert!(there.iter().zip(&back).all(|(there, back)| (there - back).abs() < 1e-12));
    assert!(there.iter().all(|difference| (0.0..=1.0).contains(difference)) && mean(&there) > 0.1);
}

#[test]
fn green_against_blue_is_the_largest_difference_and_grey_levels_order() {
    let plain = |colour: Rgb| vec![colour; 12 * 12];
    let of = |a: Rgb, b: Rgb| mean(&flip(&plain(a), &plain(b), 12, PIXELS_PER_DEGREE));
    // Plain pictures have no features and no filter changes them: the colour difference alone, 1 by definition.
    assert!((of([0.0, 255.0, 0.0], [0.0, 0.0, 255.0]) - 1.0).abs() < 1e-9);
    let levels = [1.0, 8.0, 64.0, 255.0].map(|level| of([0.0; 3], [level; 3]));
    assert!(levels.windows(2).all(|pair| pair[0] < pair[1]), "{levels:?}");
    // Black against white, by hand: L* differs by 100, a* and b* hardly; 100^0.7 = 25.119 is more than 0.4 of the largest
    // difference, 308.13^0.7 = 55.2 (L* 87.735 - 32.297 and the Hunt-weighed a*, b* of green and blue), which is where
    // the mapping bends: 0.95 + (25.119 - 0.4 m) / (0.6 m) * 0.05.
    let most = largest();
    let expected = 0.95 + (100.0_f64.powf(0.7) - 0.4 * most) / (0.6 * most) * 0.05;
    assert!((levels[3] - expected).abs() < 1e-4, "{} and {expected}", levels[3]);
}

#[test]
fn colours_go_there_and_back() {
    for colour in noise(&mut Random::new(3), 50) {
        let linear_light = colour.map(|level| linear(level / 255.0));
        let back = linear_rgb(of_ycxcz(ycxcz(xyz(linear_light))));
        assert!(linear_light.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-9));
    }
    let [l, a, b] = lab(xyz([1.0; 3]));
    assert!((l - 100.0).abs() < 1e-9 && a.abs() < 1e-9 && b.abs() < 1e-9);
}

#[test]
fn a_point_is_seen_less_from_afar_and_differences_stay_near_it() {
    let plain = vec![[128.0; 3]; 61 * 61];
    let mut dotted = plain.clone();
    dotted[30 * 61 + 30] = [255.0; 3];
    let [near, far] = [20.0, 120.0].map(|degree| flip(&plain, &dotted, 61, degree));
    let peak = |map: &[f64]| map.iter().copied().fold(0.0, f64::max);
    assert!(peak(&near) > peak(&far) && peak(&far) > 0.0, "{} and {}", peak(&near), peak(&far));
    // At 20 pixels a degree the filters reach 6 pixels.
    assert_eq!(near[0], 0.0);
}

#[test]
fn pictures_that_do_not_fit_have_no_differences() {
    let picture = [[0.0; 3]; 6];
    assert!(flip(&picture, &picture[..3], 3, 67.0).is_empty() && flip(&picture, &picture, 4, 67.0).is_empty());
    assert!(flip(&picture, &picture, 0, 67.0).is_empty() && mean(&[]).is_nan());
}
