//! Lines, marks, bands and error bars of series.

use plotters::prelude::*;

use crate::canvas::{Canvas, Drawn, UNITS, units, write};
use crate::layout::Layout;
use crate::legend::{LegendEntry, SAMPLE, style_index};
use crate::page::{LINE_WIDTH, Rect, TEXT};
use crate::text::Weight;
use crate::thin::thin;
use crate::{DataPoint, Figure, Look, palette};

/// Width of the lines of series, units.
const SERIES_WIDTH: u32 = 16;
/// Width of the first series: it shows at both sides of another on the same points.
const FIRST_WIDTH: u32 = 30;
/// How much of its colour an area has.
const AREA: f64 = 0.6;
/// Half the height of the sample of an area, pixels.
const AREA_SAMPLE: f64 = 4.5;
/// Width of the ends of a band beside others.
const BAND_END: u32 = 7;
/// The same for marks: size of those of the first series over that of others.
const FIRST_MARK: f64 = 1.4;
/// Half the size of a mark, pixels.
const MARK: f64 = 4.0;
/// Radius of a ring, pixels.
const RING: f64 = 7.5;

/// Maps data to pixels.
pub struct Pen<'a> {
    figure: &'a Figure,
    layout: &'a Layout,
}

impl<'a> Pen<'a> {
    /// The mapping of a laid-out figure.
    pub fn new(figure: &'a Figure, layout: &'a Layout) -> Pen<'a> {
        Pen { figure, layout }
    }

    /// Place of a point of the data, pixels; none if the axes have no place for it.
    pub fn pixel(&self, point: DataPoint) -> Option<[f64; 2]> {
        let (plot, layout) = (self.layout.plot, self.layout);
        let part = |axis: &crate::Axis, [low, high]: [f64; 2], value| {
            Some((axis.place(value)? - low) / (high - low))
        };
        let x = part(&self.figure.x, layout.x.range, point.x)?;
        let y = part(&self.figure.y, layout.y.range, point.y)?;
        Some([
            plot.left + x * (plot.right - plot.left),
            plot.bottom - y * (plot.bottom - plot.top),
        ])
    }

    /// The area between the axes, pixels.
    pub fn plot(&self) -> Rect {
        self.layout.plot
    }

    /// The same in units of the drawing.
    fn units(&self, point: DataPoint) -> Option<[i32; 2]> {
        self.pixel(point).map(units).map(|(x, y)| [x, y])
    }

    /// Lines in units of the drawing, broken where a point has no place.
    fn lines(&self, points: &[DataPoint]) -> Vec<Vec<[i32; 2]>> {
        let places: Vec<Option<[i32; 2]>> = points.iter().map(|&p| self.units(p)).collect();
        places
            .split(Option::is_none)
            .map(|line| line.iter().flatten().copied().collect::<Vec<_>>())
            .filter(|line| !line.is_empty())
            .map(|line| thin(&line, UNITS as i32))
            .collect()
    }
}

/// Colour of a series.
fn colour(figure: &Figure, index: usize) -> RGBColor {
    let series = &figure.series[index];
    match (series.look, series.shade) {
        (Look::Reference, _) => palette::REFERENCE,
        (Look::Rings, None) => BLACK,
        (_, Some(part)) => palette::of_part(palette::BRIGHTEST * part),
        _ => palette::of_series(style_index(&figure.series, index)),
    }
}

/// The band of a series, if it has one.
pub fn draw_band(figure: &Figure, index: usize, pen: &Pen, canvas: &Canvas) -> Drawn {
    let series = &figure.series[index];
    let Some(band) = &series.band else {
        return Ok(());
    };
    let end = |which: usize| {
        let points = series.points.iter().zip(band);
        let points = points.map(move |(p, b)| DataPoint::new(p.x, b[which]));
        points.filter_map(|p| pen.units(p)).map(|[x, y]| (x, y))
    };
    let mut outline: Vec<(i32, i32)> = end(1).collect();
    let below: Vec<(i32, i32)> = end(0).collect();
    if series.look == Look::Area {
        outline.extend(below.iter().rev());
        return canvas.draw(&Polygon::new(outline, colour(figure, index).mix(AREA)));
    }
    if figure
        .series
        .iter()
        .filter(|series| series.band.is_some())
        .count()
        > 1
    {
        // Two fills that overlap have a colour of neither: lines at their ends keep both apart.
        let colour = colour(figure, index).mix(0.7).stroke_width(BAND_END);
        canvas.draw(&PathElement::new(outline, colour))?;
        return canvas.draw(&PathElement::new(below, colour));
    }
    outline.extend(below.iter().rev());
    canvas.draw(&Polygon::new(outline, colour(figure, index).mix(0.2)))
}

/// Line, marks and error bars of a series.
pub fn draw_series(figure: &Figure, index: usize, pen: &Pen, canvas: &Canvas) -> Drawn {
    let series = &figure.series[index];
    let colour = colour(figure, index);
    if let Some(errors) = &series.errors {
        for (point, [low, high]) in series.points.iter().zip(errors) {
            let ends = [*low, *high].map(|y| DataPoint::new(point.x, y));
            draw_error(ends, colour, pen, canvas)?;
        }
    }
    if !matches!(series.look, Look::Marks | Look::Rings) {
        for line in pen.lines(&series.points) {
            draw_line(&line, series.look, colour, width(figure, index), canvas)?;
        }
    }
    for place in series.points.iter().filter_map(|&p| pen.pixel(p)) {
        draw_mark(figure, index, place, canvas)?;
    }
    Ok(())
}

/// The sample of a series and its name in the legend.
pub fn draw_sample(figure: &Figure, entry: &LegendEntry, canvas: &Canvas) -> Drawn {
    let series = &figure.series[entry.series];
    if series.look == Look::Area {
        let corners = [
            units([entry.x, entry.y - AREA_SAMPLE]),
            units([entry.x + SAMPLE, entry.y + AREA_SAMPLE]),
        ];
        let fill = colour(figure, entry.series).mix(AREA).filled();
        canvas.draw(&Rectangle::new(corners, fill))?;
    } else if !matches!(series.look, Look::Marks | Look::Rings) {
        let (from, to) = (units([entry.x, entry.y]), units([entry.x + SAMPLE, entry.y]));
        let line = [[from.0, from.1], [to.0, to.1]];
        let (colour, width) = (colour(figure, entry.series), width(figure, entry.series));
        draw_line(&line, series.look, colour, width, canvas)?;
    }
    draw_mark(figure, entry.series, [entry.x + 0.5 * SAMPLE, entry.y], canvas)?;
    let at = [entry.x + SAMPLE + 4.0, entry.y];
    write(
        canvas,
        &entry.name,
        at,
        TEXT,
        Weight::Regular,
        plotters::style::text_anchor::HPos::Left,
    )
}

/// Width of the line of a series, units.
fn width(figure: &Figure, index: usize) -> u32 {
    match is_under_others(figure, index) {
        true => FIRST_WIDTH,
        false => SERIES_WIDTH,
    }
}

/// Whether a series is the first of several of the palette.
fn is_under_others(figure: &Figure, index: usize) -> bool {
    let own = &figure.series[index];
    own.look != Look::Area
        && own.shade.is_none()
        && figure.series.len() > 1
        && style_index(&figure.series, index) == 0
}

fn draw_line(line: &[[i32; 2]], look: Look, colour: RGBColor, width: u32, canvas: &Canvas) -> Drawn {
    let points: Vec<(i32, i32)> = line.iter().map(|&[x, y]| (x, y)).collect();
    match look {
        Look::Reference => {
            for dash in dashes(&points) {
                canvas.draw(&PathElement::new(dash.to_vec(), colour.stroke_width(LINE_WIDTH)))?;
            }
            Ok(())
        }
        Look::BrokenOutline => {
            for dash in dashes(&points) {
                let dash = dash.to_vec();
                canvas.draw(&PathElement::new(dash.clone(), BLACK.stroke_width(width)))?;
                canvas.draw(&PathElement::new(dash, WHITE.stroke_width(LINE_WIDTH)))?;
            }
            Ok(())
        }
        Look::Outline => {
            canvas.draw(&PathElement::new(points.clone(), BLACK.stroke_width(width)))?;
            canvas.draw(&PathElement::new(points, WHITE.stroke_width(LINE_WIDTH)))
        }
        _ => canvas.draw(&PathElement::new(points, colour.stroke_width(width))),
    }
}

/// Dashes along a line.
fn dashes(points: &[(i32, i32)]) -> Vec<[(i32, i32); 2]> {
    let (dash, period) = (6.0 * UNITS, 10.0 * UNITS);
    let mut out = Vec::new();
    let mut done = 0.0;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|(x, y)| [f64::from(x), f64::from(y)]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(1e-9);
        let at = |s: f64| {
            let t = s / length;
            let between = |i: usize| (a[i] + t * (b[i] - a[i])).round() as i32;
            (between(0), between(1))
        };
        let mut start = (done / period).floor() * period - done;
        while start < length {
            let (from, to) = (start.max(0.0), (start + dash).min(length));
            if to > from {
                out.push([at(from), at(to)]);
            }
            start += period;
        }
        done += length;
    }
    out
}

fn draw_error(ends: [DataPoint; 2], colour: RGBColor, pen: &Pen, canvas: &Canvas) -> Drawn {
    let [Some([x, low]), Some([_, high])] = ends.map(|end| pen.units(end)) else {
        return Ok(());
    };
    let cap = (3.5 * UNITS) as i32;
    let style = colour.stroke_width(LINE_WIDTH);
    canvas.draw(&PathElement::new(vec![(x, low), (x, high)], style))?;
    for y in [low, high] {
        canvas.draw(&PathElement::new(vec![(x - cap, y), (x + cap, y)], style))?;
    }
    Ok(())
}

/// The mark of a series at a place, if its look has marks: a shape by its number, or a ring.
fn draw_mark(figure: &Figure, index: usize, place: [f64; 2], canvas: &Canvas) -> Drawn {
    let (look, colour) = (figure.series[index].look, colour(figure, index));
    match look {
        Look::Rings => {
            let radius = (RING * UNITS) as i32;
            canvas.draw(&Circle::new(
                units(place),
                radius,
                colour.stroke_width(LINE_WIDTH + 4),
            ))
        }
        Look::Marks | Look::LineAndMarks => {
            let size = if is_under_others(figure, index) {
                FIRST_MARK * MARK
            } else {
                MARK
            };
            let corners = shape(style_index(&figure.series, index));
            if corners.is_empty() {
                let radius = (size * UNITS) as i32;
                return canvas.draw(&Circle::new(units(place), radius, colour.filled()));
            }
            let corner = |[x, y]: &[f64; 2]| units([place[0] + size * x, place[1] + size * y]);
            canvas.draw(&Polygon::new(
                corners.iter().map(corner).collect::<Vec<_>>(),
                colour.filled(),
            ))
        }
        Look::Line | Look::Area | Look::Reference | Look::Outline | Look::BrokenOutline => Ok(()),
    }
}

/// Corners of a mark in half sizes, y downward; none is a circle.
fn shape(number: usize) -> &'static [[f64; 2]] {
    const SHAPES: [&[[f64; 2]]; 6] = [
        &[],
        &[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
        &[[0.0, -1.2], [1.1, 0.9], [-1.1, 0.9]],
        &[[0.0, -1.3], [1.1, 0.0], [0.0, 1.3], [-1.1, 0.0]],
        &[[0.0, 1.2], [1.1, -0.9], [-1.1, -0.9]],
        &[
            [-1.3, -0.4],
            [-0.4, -0.4],
            [-0.4, -1.3],
            [0.4, -1.3],
            [0.4, -0.4],
            [1.3, -0.4],
            [1.3, 0.4],
            [0.4, 0.4],
            [0.4, 1.3],
            [-0.4, 1.3],
            [-0.4, 0.4],
            [-1.3, 0.4],
        ],
    ];
    SHAPES[number % SHAPES.len()]
}
