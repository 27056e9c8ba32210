//! Which settings are worth their price: computed from the figures, never written by hand.
//!
//! A setting is *dominated* when another has no more error and no more clocks, and less of one of them. What no other
//! dominates makes the Pareto line. Host time is measured, with noise, so no verdict rests on it.

use super::report::{By, Point, Sweep};

/// Clocks within this ratio are called the same.
const SAME: f64 = 1.005;

/// For each place (error, price) the position of one that dominates it, the best of those; `None` on the Pareto line.
#[must_use]
pub fn dominated(places: &[[f64; 2]]) -> Vec<Option<usize>> {
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let better = |place: &[f64; 2]| {
        let all = places.iter().enumerate().filter(|(_, other)| beats(other, place));
        all.min_by(|a, b| a.1[0].total_cmp(&b.1[0]).then(a.1[1].total_cmp(&b.1[1]))).map(|(at, _)| at)
    };
    places.iter().map(better).collect()
}

/// For each point of a sweep one that dominates it in error and clocks; none where either is not measured.
#[must_use]
pub fn of_sweep(sweep: &Sweep) -> Vec<Option<usize>> {
    let place = |point: &Point| Some([sweep.error(point)?, point.price.clocks?]);
    let measured: Vec<(usize, [f64; 2])> =
        sweep.points.iter().enumerate().filter_map(|(at, point)| Some((at, place(point)?))).collect();
    let places: Vec<[f64; 2]> = measured.iter().map(|(_, place)| *place).collect();
    let mut all = vec![None; sweep.points.len()];
    for ((at, _), by) in measured.iter().zip(dominated(&places)) {
        all[*at] = by.map(|by| measured[by].0);
    }
    all
}

/// Whether all settings take the same clocks.
#[must_use]
pub fn is_free(sweep: &Sweep) -> bool {
    let clocks = || sweep.points.iter().filter_map(|point| point.price.clocks);
    let (least, most) = (clocks().fold(f64::INFINITY, f64::min), clocks().fold(0.0, f64::max));
    clocks().count() > 1 && most <= least * SAME
}

/// What follows from a sweep, in sentences.
#[must_use]
pub fn sentences(sweep: &Sweep) -> Vec<String> {
    let priced: Vec<(&Point, f64, f64)> =
        sweep.points.iter().filter_map(|point| Some((point, sweep.error(point)?, point.price.clocks?))).collect();
    let (Some(cheap), Some(exact)) = (
        priced.iter().min_by(|a, b| a.2.total_cmp(&b.2).then(a.1.total_cmp(&b.1))),
        priced.iter().min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2))),
    ) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let dearest = priced.iter().map(|(.., clocks)| *clocks).fold(0.0, f64::max);
    let scene = &sweep.scene;
    if dearest <= cheap.2 * SAME {
        let what = if priced.iter().all(|(_, error, _)| *error == exact.1) {
            "and none has another error".to_owned()
        } else {
            format!("so there is no reason for less than {}", exact.0.setting)
        };
        all.push(format!("Every setting takes the same clocks: this accuracy is free, {what} ({scene})."));
        return all;
    }
    if exact.0.setting != cheap.0.setting {
        let error = match exact.1 {
            0.0 => format!("takes the error from {} to exactly 0", quantity(cheap.1, sweep)),
            least => format!("divides the error by {}", figure(cheap.1 / least)),
        };
        let clocks = figure(exact.2 / cheap.2);
        all.push(format!(
            "{} instead of {} {error} for {clocks} times the clocks ({scene}).",
            exact.0.setting, cheap.0.setting
        ));
    }
    for (at, by) in of_sweep(sweep).into_iter().enumerate() {
        let Some(by) = by else { continue };
        let (loser, winner) = (&sweep.points[at], &sweep.points[by]);
        let [lost, won] = [loser, winner].map(|point| sweep.error(point).unwrap_or(0.0));
        let clocks = winner.price.clocks.unwrap_or(0.0) / loser.price.clocks.unwrap_or(1.0);
        let error = if won == lost {
            "is as exact".to_owned()
        } else {
            format!("has {} where it has {}", quantity(won, sweep), quantity(lost, sweep))
        };
        let price = if clocks * SAME >= 1.0 {
            "for the same clocks".to_owned()
        } else {
            format!("for {} times its clocks", figure(clocks))
        };
        all.push(format!("{} is never worth it: {} {error}, {price} ({scene}).", loser.setting, winner.setting));
    }
    all
}

/// An error with the unit of the figure that stands for it.
fn quantity(error: f64, sweep: &Sweep) -> String {
    let unit = if sweep.by == By::Rate { "%" } else { sweep.unit };
    format!("{} {unit}", figure(error)).trim_end().to_owned()
}

/// A number to about three digits.
#[must_use]
pub fn figure(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value.is_nan() { "-".to_owned() } else { "infinite".to_owned() };
    }
    if size < 0.9995e-3 {
        let text = format!("{value:.1e}");
        return text.replace(".0e", "e");
    }
    // The exponent after rounding to three digits decides how many of them stand behind the point.
    let exponent = format!("{size:.2e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    if exponent >= 4 {
        let grouped = crate::table::grouped(size.round() as u64);
        return if value < 0.0 { format!("-{grouped}") } else { grouped };
    }
    let text = format!("{value:.*}", (2 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::report::{ErrorFigures, Price};

    fn point(setting: &str, mean: f64, clocks: f64) -> Point {
        Point {
            setting: setting.to_owned(),
            error: ErrorFigures { mean: Some(mean), ..ErrorFigures::default() },
            price: Price { clocks: Some(clocks), ..Price::default() },
        }
    }

    fn sweep(points: Vec<Point>) -> Sweep {
        Sweep { scene: "tests".to_owned(), measure: String::new(), unit: "px", by: By::Mean, points }
    }

    #[test]
    fn dominated_is_who_has_a_better_in_both() {
        let places = [[4.0, 1.0], [3.0, 3.0], [2.0, 2.0], [2.0, 2.0], [0.0, 9.0]];
        assert_eq!(dominated(&places), [None, Some(2), None, None, None]);
    }

    #[test]
    fn sentences_name_what_is_free_and_what_is_never_worth_it() {
        let free = sentences(&sweep(vec![point("8", 1.0, 5.0), point("16", 0.1, 5.0)]));
        assert_eq!(
            free,
            [
                "Every setting takes the same clocks: this accuracy is free, so there is no reason for less than 16 (tests)."
            ]
        );
        let found = sentences(&sweep(vec![point("a", 8.0, 1.0), point("b", 4.0, 3.0), point("c", 2.0, 2.0)]));
        assert_eq!(found.len(), 2);
        assert_eq!(found[0], "c instead of a divides the error by 4 for 2 times the clocks (tests).");
        assert!(found[1].starts_with("b is never worth it: c has 2 px"), "{}", found[1]);
    }

    #[test]
    fn figure_has_three_digits_whatever_the_size() {
        let texts = [0.0, 0.000_123, 0.0315, 0.25, 1.0, 12.345, 999.6, 7_712.0, 123_456.0].map(figure);
        assert_eq!(texts, ["0", "1.2e-4", "0.0315", "0.25", "1", "12.3", "1000", "7712", "123 456"]);
    }
}
