//! Plots as SVG: axes that fit the figures, marks with labels beside them that do not lie over each other.
//!
//! Colours and type come from classes (`plot.css`), so that a page in the dark has dark plots; a plot in a file of its
//! own carries them along ([`standalone`]).

use super::super::report::{Axis, Kind, Plot, Scale, Series};
use super::super::verdict::figure;
use super::escaped;

/// Width and height of a plot, in its own units; type is 12 of them.
const SIZE: [f64; 2] = [460.0, 320.0];
/// Left, top, right, bottom margins.
const MARGINS: [f64; 4] = [62.0, 26.0, 18.0, 44.0];
/// Width of a character, and height of a line.
const TYPE: [f64; 2] = [6.5, 13.0];
/// Length of the low end of a logarithmic axis that zeros stand in.
const ZEROS: f64 = 26.0;
/// The look.
pub(super) const STYLE: &str = include_str!("plot.css");

/// Numbers to places along one axis.
struct Ruler {
    scale: Scale,
    /// Least and greatest number that has a place; logarithms of them where the axis is logarithmic.
    range: [f64; 2],
    /// Places of these.
    places: [f64; 2],
    /// Place of zeros on a logarithmic axis.
    zero: Option<f64>,
}

impl Ruler {
    fn new(axis: &Axis, values: impl Iterator<Item = f64> + Clone, [from, to]: [f64; 2]) -> Self {
        let finite = values.filter(|value| value.is_finite());
        let around = |low: f64, high: f64, least: f64| {
            let room = ((high - low) * 0.06).max(least);
            [low - room, high + room]
        };
        let bounds = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
        };
        match axis.scale {
            Scale::Linear => {
                let [low, high] = bounds(&mut finite.clone());
                let [low, high] = if low > high { [0.0, 1.0] } else { [low, high] };
                let near_zero = low >= 0.0 && low < 0.6 * high;
                let [least, greatest] = around(low, high, high.abs().max(1e-9) * 0.02);
                Self {
                    scale: axis.scale,
                    range: [if near_zero { 0.0 } else { least }, greatest],
                    places: [from, to],
                    zero: None,
                }
            }
            Scale::Logarithmic => {
                let [low, high] = bounds(&mut finite.clone().filter(|value| *value > 0.0).map(f64::log10));
                let [low, high] = if low > high { [-1.0, 0.0] } else { [low, high] };
                let has_zero = finite.clone().any(|value| value <= 0.0);
                let sign = (to - from).signum();
                let begin = if has_zero { from + sign * ZEROS } else { from };
                let zero = has_zero.then_some(from + sign * ZEROS / 2.0);
                Self { scale: axis.scale, range: around(low, high, 0.08), places: [begin, to], zero }
            }
        }
    }

    fn place(&self, value: f64) -> f64 {
        let number = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value <= 0.0 => return self.zero.unwrap_or(self.places[0]),
            Scale::Logarithmic => value.log10(),
        };
        let [low, high] = self.range;
        let [from, to] = self.places;
        from + (to - from) * ((number - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Numbers with a mark, and whether that has a text.
    fn ticks(&self) -> Vec<(f64, bool)> {
        let [low, high] = self.range;
        let mut all = Vec::new();
        match self.scale {
            Scale::Linear => {
                let rough = (high - low) / 5.0;
                let power = 10_f64.powf(rough.log10().floor());
                let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| *step >= rough);
                let step = step.unwrap_or(rough);
                let mut count = (low / step).ceil();
                while count * step <= high {
                    all.push((count * step, true));
                    count += 1.0;
                }
            }
            Scale::Logarithmic => {
                let decades = high - low;
                // Of many decades some have no text.
                let every = (decades / 6.0).ceil().max(1.0) as i32;
                for exponent in low.floor() as i32..=high.ceil() as i32 {
                    for factor in 1..10 {
                        let value = f64::from(factor) * 10_f64.powi(exponent);
                        let labelled = match factor {
                            1 => exponent.rem_euclid(every) == 0,
                            2 | 5 => decades < 1.7,
                            _ => decades < 0.6,
                        };
                        if (low..=high).contains(&value.log10()) && (labelled || decades < 4.0 || factor == 1) {
                            all.push((value, labelled));
                        }
                    }
                }
                if self.zero.is_some() {
                    all.push((0.0, true));
                }
            }
        }
        all
    }

    fn text(&self, value: f64) -> String {
        let exponent = value.abs().log10().round();
        let is_power = (10_f64.powf(exponent) / value - 1.0).abs() < 1e-9;
        if self.scale == Scale::Logarithmic && value > 0.0 && is_power && !(-3.0..=4.0).contains(&exponent) {
            let digits = format!("{exponent}");
            let raised = digits.chars().map(|digit| match digit {
                '-' => '⁻',
                digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize % 48 % 10],
            });
            return format!("10{}", raised.collect::<String>());
        }
        if value.abs() < 1e-12 { "0".to_owned() } else { figure(value) }
    }
}

/// A box that nothing else should lie over: left, top, right, bottom.
type Box = [f64; 4];

fn overlaps(a: &Box, b: &Box) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// The plot as an `svg` element without any style.
#[must_use]
pub fn svg(plot: &Plot) -> String {
    let [width, height] = SIZE;
    let [left, top, right, bottom] = [MARGINS[0], MARGINS[1], width - MARGINS[2], height - MARGINS[3]];
    let places = |axis: usize| plot.series.iter().flat_map(|series| &series.points).map(move |point| point[axis]);
    let x = Ruler::new(&plot.x, places(0), [left, right]);
    let y = Ruler::new(&plot.y, places(1), [bottom, top]);
    let mut text = format!(
        "<svg class=\"plot\" viewBox=\"0 0 {width} {height}\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\">\
         <title>{}</title>\n",
        escaped(&plot.title)
    );
    text.push_str(&grid(&x, &y, [left, top, right, bottom]));
    text.push_str(&format!(
        "<text class=\"axis\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\n\
         <text class=\"axis\" x=\"4\" y=\"13\">{}</text>\n",
        (left + right) / 2.0,
        height - 8.0,
        escaped(&plot.x.label),
        escaped(&plot.y.label)
    ));
    let mut taken: Vec<Box> = Vec::new();
    let mut labels: Vec<([f64; 2], &str, usize)> = Vec::new();
    let mut colour = 0;
    for series in &plot.series {
        let at: Vec<[f64; 2]> = series.points.iter().map(|point| [x.place(point[0]), y.place(point[1])]).collect();
        text.push_str(&marks(series, &at, colour));
        if series.kind != Kind::Cloud {
            taken.extend(at.iter().map(|[x, y]| [x - 4.0, y - 4.0, x + 4.0, y + 4.0]));
        }
        for (place, label) in at.iter().zip(&series.labels).filter(|(_, label)| !label.is_empty()) {
            labels.push((*place, label, colour));
        }
        if let (Some(last), false) = (at.last(), series.name.is_empty()) {
            labels.push((*last, &series.name, colour));
        }
        if !matches!(series.kind, Kind::Cloud | Kind::Reference) {
            colour = (colour + 1) % 6;
        }
    }
    for (place, label, colour) in labels {
        let (at, anchor, space) = beside(place, label, &taken, [left, top - 10.0, right + 14.0, bottom]);
        taken.push(space);
        text.push_str(&format!(
            "<text class=\"label ink{colour}\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>\n",
            at[0],
            at[1],
            escaped(label)
        ));
    }
    text.push_str("</svg>\n");
    text
}

/// The plot as a file of its own, light or dark as the reader's page is.
#[must_use]
pub fn standalone(plot: &Plot) -> String {
    let dark = "@media (prefers-color-scheme: dark) { svg.plot { --ground: #0d1117; --ink: #e6edf3; --quiet: #9aa4b2; --rule: #2b323c; } }";
    let style = format!("<style>{STYLE}{dark} svg.plot {{ background: var(--ground); }}</style>");
    svg(plot).replacen("</title>\n", &format!("</title>\n{style}\n"), 1)
}

/// Frame, ticks and lines behind the marks.
fn grid(x: &Ruler, y: &Ruler, [left, top, right, bottom]: Box) -> String {
    let mut text = String::new();
    for (value, labelled) in x.ticks() {
        let at = x.place(value);
        let class = if labelled { "rule" } else { "rule faint" };
        text.push_str(&format!("<path class=\"{class}\" d=\"M{at:.1} {top:.1}V{bottom:.1}\"/>\n"));
        if labelled {
            let below = bottom + 15.0;
            let label = x.text(value);
            text.push_str(&format!(
                "<text class=\"tick\" x=\"{at:.1}\" y=\"{below:.1}\" text-anchor=\"middle\">{label}</text>\n"
            ));
        }
    }
    for (value, labelled) in y.ticks() {
        let at = y.place(value);
        let class = if labelled { "rule" } else { "rule faint" };
        text.push_str(&format!("<path class=\"{class}\" d=\"M{left:.1} {at:.1}H{right:.1}\"/>\n"));
        if labelled {
            let (beside, base, label) = (left - 7.0, at + 4.0, y.text(value));
            text.push_str(&format!(
                "<text class=\"tick\" x=\"{beside:.1}\" y=\"{base:.1}\" text-anchor=\"end\">{label}</text>\n"
            ));
        }
    }
    text
}

fn marks(series: &Series, at: &[[f64; 2]], colour: usize) -> String {
    let mut text = String::new();
    let path = |points: &[[f64; 2]], staircase: bool| {
        let mut line = String::new();
        for (place, [x, y]) in points.iter().enumerate() {
            line.push_str(&match (place, staircase) {
                (0, _) => format!("M{x:.1} {y:.1}"),
                (_, true) => format!("H{x:.1}V{y:.1}"),
                _ => format!("L{x:.1} {y:.1}"),
            });
        }
        line
    };
    match series.kind {
        Kind::Line => text.push_str(&format!("<path class=\"line ink{colour}\" d=\"{}\"/>\n", path(at, false))),
        Kind::Staircase => text.push_str(&format!("<path class=\"line ink{colour}\" d=\"{}\"/>\n", path(at, true))),
        Kind::Reference => text.push_str(&format!("<path class=\"reference\" d=\"{}\"/>\n", path(at, false))),
        Kind::Marks | Kind::Cloud => {}
    }
    let (class, radius) = match series.kind {
        Kind::Reference => return text,
        Kind::Cloud => ("cloud".to_owned(), 2.5),
        _ => (format!("mark ink{colour}"), 4.0),
    };
    for (place, [x, y]) in at.iter().enumerate() {
        let name = series.labels.get(place).map_or("", String::as_str);
        let [across, up] = series.points[place].map(figure);
        let title = escaped(format!("{name} ({across}, {up})").trim());
        text.push_str(&format!(
            "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"><title>{title}</title></circle>\n"
        ));
    }
    text
}

/// A place for a label beside a mark where it meets nothing that is `taken`; the first of several that is free.
fn beside([x, y]: [f64; 2], label: &str, taken: &[Box], frame: Box) -> ([f64; 2], &'static str, Box) {
    let wide = TYPE[0] * label.chars().count() as f64;
    let mut best = None;
    for distance in [1.0_f64, 2.0, 3.2, 4.6] {
        let (side, tall) = (8.0 * distance.min(1.5), TYPE[1] * (distance - 1.0) + 8.0);
        let tries = [
            ([x + side, y + 4.0 - (tall - 8.0)], "start"),
            ([x - side, y + 4.0 - (tall - 8.0)], "end"),
            ([x, y - tall], "middle"),
            ([x, y + tall + 8.0], "middle"),
            ([x + side, y + 4.0 + (tall - 8.0)], "start"),
            ([x - side, y + 4.0 + (tall - 8.0)], "end"),
        ];
        for (at, anchor) in tries {
            let from = match anchor {
                "start" => at[0],
                "end" => at[0] - wide,
                _ => at[0] - wide / 2.0,
            };
            let space = [from, at[1] - 10.0, from + wide, at[1] + 3.0];
            let inside = space[0] >= frame[0] && space[2] <= frame[2] && space[1] >= frame[1] && space[3] <= frame[3];
            let free = !taken.iter().any(|other| overlaps(&space, other));
            if inside && free {
                return (at, anchor, space);
            }
            if inside && best.is_none() {
                best = Some((at, anchor, space));
            }
        }
    }
    best.unwrap_or(([x, y - 8.0], "middle", [x - wide / 2.0, y - 18.0, x + wide / 2.0, y - 5.0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<[f64; 2]>, scale: Scale) -> Plot {
        let labels = (0..points.len()).map(|at| format!("point <{at}>")).collect();
        let series = Series { name: "all".to_owned(), points, labels, kind: Kind::Line };
        let axis = |label: &str| Axis { label: label.to_owned(), scale };
        Plot { title: "a & b".to_owned(), x: axis("clocks"), y: axis("error"), series: vec![series] }
    }

    #[test]
    fn svg_has_a_mark_and_a_label_for_each_point_and_escapes_texts() {
        let text = svg(&plot(vec![[1.0, 0.1], [10.0, 0.01], [30.0, 0.0]], Scale::Logarithmic));
        assert_eq!(text.matches("<circle").count(), 3);
        assert_eq!(text.matches("class=\"label").count(), 4);
        assert!(text.contains("a &amp; b") && text.contains("point &lt;1&gt;") && !text.contains("NaN"));
    }

    #[test]
    fn rulers_put_zeros_below_all_powers_and_survive_no_points() {
        let axis = Axis::logarithmic("");
        let ruler = Ruler::new(&axis, [0.0, 0.001, 1.0].into_iter(), [300.0, 0.0]);
        assert!(ruler.place(0.0) > ruler.place(0.001) && ruler.place(0.001) > ruler.place(1.0));
        assert_eq!((ruler.text(1e-5), ruler.text(0.01)), ("10⁻⁵".to_owned(), "0.01".to_owned()));
        for scale in [Scale::Linear, Scale::Logarithmic] {
            for points in [vec![], vec![[0.0, 0.0]], vec![[5.0, 5.0], [5.0, 5.0]]] {
                assert!(!svg(&plot(points, scale)).contains("NaN"));
            }
        }
    }

    #[test]
    fn labels_of_near_points_do_not_lie_over_each_other() {
        let frame = [0.0, 0.0, 400.0, 300.0];
        let mut taken = Vec::new();
        for step in 0..5 {
            let (.., space) = beside([200.0 + f64::from(step), 150.0], "label", &taken, frame);
            assert!(!taken.iter().any(|other| overlaps(other, &space)), "label {step}");
            taken.push(space);
        }
    }
}
