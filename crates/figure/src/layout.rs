//! Who gets which part of the picture. Lengths are SVG pixels, y downward.

use crate::axis::Axis;
use crate::legend::{self, Legend};
use crate::page::{GAP, Rect, TEXT, TICK, TITLE};
use crate::text::{self, LINE, Weight};
use crate::ticks::Ticks;
use crate::{DataPoint, Figure, FigureError, Surface};

/// Width of the colour bar.
const BAR: f64 = 16.0;
/// Smallest width and height of the area between the axes.
const SMALLEST: f64 = 60.0;

/// Range of an axis, in places, and its ticks.
#[derive(Clone, Debug)]
pub struct Span {
    pub range: [f64; 2],
    pub ticks: Ticks,
}

/// The parts of the picture.
#[derive(Clone, Debug)]
pub struct Layout {
    pub title: Vec<String>,
    /// Lines below the title, and the middle of the first.
    pub note: (Vec<String>, f64),
    pub legend: Legend,
    /// Area between the axes.
    pub plot: Rect,
    pub x: Span,
    pub y: Span,
    /// The colour bar with its range.
    pub bar: Option<(Rect, Span)>,
}

/// Lays a figure out.
pub fn lay_out(figure: &Figure) -> Result<Layout, FigureError> {
    let (mut x, mut y) = (span_of(figure, 0)?, span_of(figure, 1)?);
    let mut value = figure
        .surface
        .as_ref()
        .map(|s| value_span(figure, &s.value))
        .transpose()?;
    let [width, height] = [f64::from(figure.size.0), f64::from(figure.size.1)];
    let title = wrap(&figure.title, (TITLE, Weight::Bold), width - 2.0 * GAP);
    let note = wrap(&figure.note, (TEXT, Weight::Regular), width - 2.0 * GAP);
    let left = GAP + LINE * TEXT + GAP + widest(&y.ticks) + TICK;
    let bar_room = value.as_ref().map_or(0.0, |v| {
        2.0 * GAP + BAR + TICK + widest(&v.ticks) + GAP + LINE * TEXT
    });
    let right = width - GAP - bar_room - 0.5 * widest(&x.ticks).min(40.0);
    let legend = legend::arrange(figure, width - left - GAP);
    let note_top = GAP + title.len() as f64 * LINE * TITLE;
    let legend_top = note_top + note.len() as f64 * LINE * TEXT + 0.5 * GAP;
    let top = legend_top + legend.height() + GAP;
    let bottom = height - GAP - LINE * TEXT - GAP - LINE * TEXT - TICK + 4.0;
    if right - left < SMALLEST || bottom - top < SMALLEST {
        return Err(FigureError::NoRoom {
            title: figure.title.clone(),
            width: figure.size.0,
            height: figure.size.1,
        });
    }
    let plot = Rect {
        left,
        top,
        right,
        bottom,
    };
    if figure.has_equal_scales {
        equalise(
            (&mut x, &figure.x, right - left),
            (&mut y, &figure.y, bottom - top),
        );
    }
    let text_width = |text: &str| text::width(text, TEXT, Weight::Regular) + 10.0;
    let line_height = |_: &str| 1.15 * TEXT;
    separate(&mut x, right - left, text_width);
    separate(&mut y, bottom - top, line_height);
    if let Some(value) = &mut value {
        separate(value, bottom - top, line_height);
    }
    Ok(Layout {
        title,
        note: (note, note_top + 0.5 * LINE * TEXT),
        legend: legend.at(left, legend_top),
        plot,
        x,
        y,
        bar: value.map(|span| (bar_beside(plot), span)),
    })
}

/// The colour bar beside the area between the axes.
fn bar_beside(plot: Rect) -> Rect {
    let left = plot.right + 2.0 * GAP;
    Rect {
        left,
        right: left + BAR,
        ..plot
    }
}

/// Range and ticks of axis 0 (x) or 1 (y), from all that is drawn.
fn span_of(figure: &Figure, component: usize) -> Result<Span, FigureError> {
    let axis = [&figure.x, &figure.y][component];
    let other = [&figure.y, &figure.x][component];
    let shown = |p: &&DataPoint| {
        axis.place(p.along(component)).is_some() && other.place(p.along(1 - component)).is_some()
    };
    let points = figure.series.iter().flat_map(|series| &series.points);
    let mut values: Vec<f64> = points.filter(shown).map(|p| p.along(component)).collect();
    values.extend(figure.labels.iter().map(|label| label.at.along(component)));
    if let Some(surface) = &figure.surface {
        values.extend(surface.places(component));
    }
    if component == 1 {
        let spreads = figure.series.iter().flat_map(|s| s.errors.iter().chain(&s.band));
        values.extend(spreads.flatten().flatten());
    }
    let range = (!values.is_empty())
        .then(|| axis.range(values.into_iter()))
        .flatten();
    let (range, ticks) = range.ok_or_else(|| empty(figure))?;
    Ok(Span { range, ticks })
}

/// Widens one of the ranges so that a unit has the same length along both axes. Each axis comes with its length.
fn equalise(a: (&mut Span, &Axis, f64), b: (&mut Span, &Axis, f64)) {
    let density = |span: &Span, length: f64| (span.range[1] - span.range[0]) / length;
    let wanted = density(a.0, a.2).max(density(b.0, b.2));
    for (span, axis, length) in [a, b] {
        let [low, high] = span.range;
        let (middle, half) = (0.5 * (low + high), 0.5 * wanted * length);
        if half > 0.5 * (high - low) * (1.0 + 1e-12) {
            span.range = [middle - half, middle + half];
            span.ticks = crate::ticks::linear(span.range[0], span.range[1], axis.step);
        }
    }
}

fn value_span(figure: &Figure, axis: &Axis) -> Result<Span, FigureError> {
    let values = figure.surface.iter().flat_map(Surface::values);
    let (range, ticks) = axis.range(values).ok_or_else(|| empty(figure))?;
    Ok(Span { range, ticks })
}

fn empty(figure: &Figure) -> FigureError {
    let logarithmic = [&figure.x, &figure.y]
        .iter()
        .any(|a| a.scale == crate::Scale::Logarithmic);
    FigureError::Empty {
        title: figure.title.clone(),
        n_points: figure.series.iter().map(|s| s.points.len()).sum(),
        on_axes: if logarithmic {
            " and positive where an axis is logarithmic"
        } else {
            ""
        },
    }
}

fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks
        .labelled
        .iter()
        .map(|(_, text)| text::width(text, TEXT, Weight::Regular));
    widths.fold(0.0, f64::max)
}

/// Takes the labels off every second tick until none touches its neighbour.
fn separate(span: &mut Span, length: f64, extent: impl Fn(&str) -> f64) {
    let [low, high] = span.range;
    let scale = length / (high - low);
    while span.ticks.labelled.windows(2).any(|pair| {
        let distance = (pair[1].0 - pair[0].0) * scale;
        distance < 0.5 * (extent(&pair[0].1) + extent(&pair[1].1))
    }) {
        let labelled = std::mem::take(&mut span.ticks.labelled);
        for (i, tick) in labelled.into_iter().enumerate() {
            match i % 2 {
                0 => span.ticks.labelled.push(tick),
                _ => span.ticks.minor.push(tick.0),
            }
        }
    }
}

/// The text in lines of at most `room`, broken at spaces; a word that is longer is cut.
fn wrap(text: &str, (size, weight): (f64, Weight), room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| text::width(line, size, weight) <= room) {
            Some(line) => *lines.last_mut().expect("there is a line to lengthen") = line,
            None => lines.push(text::fit(word, size, weight, room)),
        }
    }
    lines
}
