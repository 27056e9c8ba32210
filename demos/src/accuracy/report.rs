//! What a report of accuracy is made of: plain values, which terminal, JSON and page show each in its way.
//!
//! A [`Report`] is a list of [`Section`]s, one an axis or a study. Most sections hold [`Sweep`]s: the settings of one
//! axis, each with its measured [`ErrorFigures`] and its measured [`Price`]; table, plots and verdict of a sweep follow
//! from it and are not made by the section. What is no sweep is a [`Table`], a [`Plot`], a [`Strip`] of pictures or a
//! note.

use crate::picture::Picture;

/// Everything that was measured.
#[derive(Clone, Debug)]
pub struct Report {
    /// Where and when.
    pub origin: Origin,
    /// What was found, most important first, a sentence each.
    pub headlines: Vec<String>,
    /// The parts, in order.
    pub sections: Vec<Section>,
}

/// Where and when figures were taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Seed of all random scenes.
    pub seed: u64,
    /// Day, as 2026-01-31.
    pub date: String,
    /// The program's version.
    pub version: String,
    /// What the processor calls itself.
    pub processor: String,
    /// Host threads that drew.
    pub threads: usize,
    /// `quick` or `full`.
    pub effort: &'static str,
}

/// A part of the report: an axis, or a study of its own.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Short name, as on the command line; the page's anchor. Letters, digits and `-`.
    pub name: &'static str,
    /// Heading.
    pub title: String,
    /// What is asked and how it is measured, in plain words; a paragraph each.
    pub about: Vec<String>,
    /// What was found, in plain words, computed from the figures; a sentence or two each.
    pub findings: Vec<String>,
    /// Settings with error and price.
    pub sweeps: Vec<Sweep>,
    /// Other figures.
    pub tables: Vec<Table>,
    /// Other plots.
    pub plots: Vec<Plot>,
    /// Pictures.
    pub strips: Vec<Strip>,
    /// How figures differ from published ones and why; what is not measured.
    pub notes: Vec<String>,
}

/// The settings of one axis on one kind of scene.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What was drawn, for example `random half-planes`.
    pub scene: String,
    /// What the error is, for example `coverage error`.
    pub measure: String,
    /// Its unit, for example `pixel areas`; `%` for a rate.
    pub unit: &'static str,
    /// Which of the figures is plotted and decides what is dominated.
    pub by: By,
    /// From the coarsest setting to the finest.
    pub points: Vec<Point>,
}

/// Which figure of an error stands for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The mean.
    Mean,
    /// The largest.
    Maximum,
    /// The share of samples that are wrong, in percent.
    Rate,
}

/// A setting, what it gets wrong and what it costs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// The setting, as on the command line, for example `8x8`.
    pub setting: String,
    /// What it gets wrong against exact arithmetic.
    pub error: ErrorFigures,
    /// What it costs.
    pub price: Price,
}

/// Error against exact arithmetic; what does not fit the measure is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorFigures {
    /// Mean, or root of the mean square where the measure says so; in the sweep's unit.
    pub mean: Option<f64>,
    /// Largest; in the sweep's unit.
    pub maximum: Option<f64>,
    /// Wrong samples, percent.
    pub rate: Option<f64>,
    /// One standard error of the figure that [`Sweep::by`] names, in its unit.
    pub standard_error: Option<f64>,
    /// Samples looked at.
    pub samples: u64,
    /// The published figure to compare with, in the same unit.
    pub published: Option<f64>,
}

/// What a setting costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Price {
    /// Clocks of the card for a pixel of the target: counted, the same on every machine.
    pub clocks: Option<f64>,
    /// Host time for a pixel of the target, nanoseconds: the median of interleaved repeats.
    pub nanoseconds: Option<f64>,
    /// Half the distance between the quartiles of the repeats, nanoseconds.
    pub spread: Option<f64>,
}

/// Rows of figures.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Heading.
    pub title: String,
    /// Heads of the columns.
    pub columns: Vec<Column>,
    /// A cell for each column.
    pub rows: Vec<Vec<Cell>>,
}

/// Head of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// Unit, or nothing.
    pub unit: &'static str,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number, shown to about three digits.
    Number(f64),
    /// A count, shown in full.
    Count(u64),
    /// Not measured, or without meaning here.
    Nothing,
}

/// A plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Heading.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upward.
    pub y: Axis,
    /// What is drawn, in order.
    pub series: Vec<Series>,
}

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name with the unit, for example `clocks for a pixel`.
    pub label: String,
    /// How numbers become places.
    pub scale: Scale,
}

/// How numbers become places on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps, from 0 where that is near.
    Linear,
    /// Equal ratios; zeros stand on a line of their own at the low end.
    Logarithmic,
}

/// Points of a plot that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name, drawn beside the last point; nothing where the points have labels of their own.
    pub name: String,
    /// Places.
    pub points: Vec<[f64; 2]>,
    /// A label for each point, or none at all; an empty one is not drawn.
    pub labels: Vec<String>,
    /// How it looks.
    pub kind: Kind,
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Points joined by a line.
    Line,
    /// Points alone.
    Marks,
    /// Small pale points behind the others.
    Cloud,
    /// The Pareto line: a staircase through the points.
    Staircase,
    /// A dashed line without points: a reference.
    Reference,
}

/// Pictures side by side.
#[derive(Clone, Debug)]
pub struct Strip {
    /// Heading.
    pub title: String,
    /// Pictures of one size, for example exact, card, difference.
    pub panels: Vec<Panel>,
    /// What is to be seen.
    pub caption: String,
}

/// A picture with its name.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Name, below the picture.
    pub name: String,
    /// The picture; small ones are magnified without smoothing.
    pub picture: Picture,
}

impl ErrorFigures {
    /// The figure that stands for the error.
    #[must_use]
    pub const fn by(&self, by: By) -> Option<f64> {
        match by {
            By::Mean => self.mean,
            By::Maximum => self.maximum,
            By::Rate => self.rate,
        }
    }
}

impl Sweep {
    /// The plotted error of a point.
    #[must_use]
    pub const fn error(&self, point: &Point) -> Option<f64> {
        point.error.by(self.by)
    }
}

impl Table {
    /// A table with these columns: name and unit.
    #[must_use]
    pub fn new(title: impl Into<String>, columns: &[(&str, &'static str)]) -> Self {
        let column = |&(name, unit): &(&str, &'static str)| Column { name: name.to_owned(), unit };
        Self { title: title.into(), columns: columns.iter().map(column).collect(), rows: Vec::new() }
    }
}

impl Axis {
    /// A linear axis.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear }
    }

    /// A logarithmic axis.
    #[must_use]
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Logarithmic }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}
