//! The legend: rows of names above the axes, so that it covers no data.

use crate::Figure;
use crate::page::{GAP, TEXT};
use crate::series::{Look, Series};
use crate::text::{self, Weight};

/// Width of the sample of a line or mark.
pub const SAMPLE: f64 = 26.0;
/// Height of a row.
const ROW: f64 = 1.5 * TEXT;

/// Names in their places.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    pub entries: Vec<LegendEntry>,
    n_rows: usize,
}

/// A name and the series that it stands for.
#[derive(Clone, Debug)]
pub struct LegendEntry {
    /// Number of the series.
    pub series: usize,
    pub name: String,
    /// Left end of the sample.
    pub x: f64,
    /// Middle of the row.
    pub y: f64,
}

impl Legend {
    /// Height of all rows.
    pub fn height(&self) -> f64 {
        self.n_rows as f64 * ROW
    }

    /// Moved to the given left and top.
    pub fn at(mut self, left: f64, top: f64) -> Legend {
        for entry in &mut self.entries {
            entry.x += left;
            entry.y += top;
        }
        self
    }
}

/// The legend takes at most this part of a figure if there are shaded series to leave out.
const MOST: f64 = 0.25;

/// Arranges the names of all series in rows of the given width, from the origin. Where they would take too much of
/// the figure, only some of the shaded series are named, the first and the last among them: the shades between
/// tell the others.
pub fn arrange(figure: &Figure, room: f64) -> Legend {
    let has_bar = figure.surface.as_ref().is_some_and(|s| s.is_of_series);
    let mut all = names(&figure.series);
    all.retain(|(i, _)| !has_bar || figure.series[*i].shade.is_none());
    let (mut legend, mut every) = (in_rows(&all, room), 1);
    let n_shaded = all
        .iter()
        .filter(|(i, _)| figure.series[*i].shade.is_some())
        .count();
    while legend.height() > MOST * f64::from(figure.size.1) && every < n_shaded {
        every *= 2;
        legend = in_rows(&some_shaded(&figure.series, &all, every), room);
    }
    legend
}

/// The names without shaded ones, but for each of a number `every` and the last.
fn some_shaded<'a>(series: &[Series], all: &[(usize, &'a str)], every: usize) -> Vec<(usize, &'a str)> {
    let is_shaded = |i: usize| series[i].shade.is_some();
    let last = all.iter().rposition(|(i, _)| is_shaded(*i));
    let (mut kept, mut n) = (Vec::new(), 0);
    for (place, &(i, name)) in all.iter().enumerate() {
        if !is_shaded(i) || n % every == 0 || Some(place) == last {
            kept.push((i, name));
        }
        n += usize::from(is_shaded(i));
    }
    kept
}

fn in_rows(names: &[(usize, &str)], room: f64) -> Legend {
    let mut legend = Legend::default();
    let mut x = 0.0;
    for &(series, name) in names {
        let name = text::fit(name, TEXT, Weight::Regular, room - SAMPLE - GAP);
        let width = SAMPLE + 0.5 * GAP + text::width(&name, TEXT, Weight::Regular);
        if legend.n_rows == 0 || x + width > room {
            legend.n_rows += 1;
            x = 0.0;
        }
        let y = (legend.n_rows as f64 - 0.5) * ROW;
        legend.entries.push(LegendEntry { series, name, x, y });
        x += width + 2.0 * GAP;
    }
    legend
}

/// Each name once, with the first series that has it.
fn names(series: &[Series]) -> Vec<(usize, &str)> {
    let mut names: Vec<(usize, &str)> = Vec::new();
    for (i, s) in series.iter().enumerate() {
        if !s.name.is_empty() && !names.iter().any(|(_, name)| *name == s.name) {
            names.push((i, &s.name));
        }
    }
    names
}

/// The number that gives a series its colour and mark: series of equal names share it, references have none.
pub fn style_index(series: &[Series], index: usize) -> usize {
    let own = &series[index];
    let first = series
        .iter()
        .position(|s| !own.name.is_empty() && s.name == own.name)
        .unwrap_or(index);
    let counts = |s: &&Series| {
        !matches!(
            s.look,
            Look::Reference | Look::Outline | Look::BrokenOutline | Look::Rings
        ) && s.shade.is_none()
    };
    let mut seen: Vec<&str> = Vec::new();
    for s in series[..first].iter().filter(counts) {
        if s.name.is_empty() || !seen.contains(&s.name.as_str()) {
            seen.push(&s.name);
        }
    }
    seen.len()
}
