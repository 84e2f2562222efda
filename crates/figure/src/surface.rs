//! A quantity over both axes, shown by colour, with a colour bar.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::chart::{Canvas, Drawn, units, write};
use crate::layout::{LINE_WIDTH, Rect, Span, TEXT, TICK};
use crate::marks::Pen;
use crate::text::Weight;
use crate::{Axis, FigureError, palette};

/// Number of steps of the colours: few enough that their edges show as contour lines.
pub(crate) const LEVELS: usize = 20;

/// Values of a grid of rectangles.
#[derive(Clone, Debug)]
pub struct Surface {
    /// What the colours show.
    pub(crate) value: Axis,
    /// Edges of the columns, in ascending order, `[n_x + 1]`.
    pub(crate) x_edges: Vec<f64>,
    /// Edges of the rows, in ascending order, `[n_y + 1]`.
    pub(crate) y_edges: Vec<f64>,
    /// Values, row after row, `[n_y][n_x]`; NaN is left white.
    pub(crate) values: Vec<f64>,
}

impl Surface {
    /// A surface of `values`, `[n_y][n_x]`, over rectangles between the edges, `[n_x + 1]` and `[n_y + 1]`.
    pub fn new(
        value: Axis,
        x_edges: Vec<f64>,
        y_edges: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Surface, FigureError> {
        let expected = x_edges.len().saturating_sub(1) * y_edges.len().saturating_sub(1);
        if values.len() != expected || expected == 0 {
            return Err(FigureError::Length {
                what: "surface",
                found: values.len(),
                expected,
            });
        }
        Ok(Surface {
            value: value.tight(),
            x_edges,
            y_edges,
            values,
        })
    }

    /// Level, from 0, of a value in the range.
    pub(crate) fn level(value: f64, [low, high]: [f64; 2]) -> Option<usize> {
        let part = (value - low) / (high - low);
        part.is_finite()
            .then(|| ((part * LEVELS as f64) as usize).min(LEVELS - 1))
    }
}

/// Draws the cells, equal neighbours in one piece, and the colour bar with its labels.
pub(crate) fn draw_surface(surface: &Surface, bar: &(Rect, Span), pen: &Pen, canvas: &Canvas) -> Drawn {
    let (bar, span) = bar;
    let n_x = surface.x_edges.len() - 1;
    for (row, values) in surface.values.chunks(n_x).enumerate() {
        let place = |value: &f64| {
            surface
                .value
                .place(*value)
                .and_then(|p| Surface::level(p, span.range))
        };
        let levels: Vec<Option<usize>> = values.iter().map(place).collect();
        let mut column = 0;
        for run in levels.chunk_by(PartialEq::eq) {
            let ends = [column, column + run.len()];
            column = ends[1];
            let corner = |x: usize, y: usize| pen.pixel([surface.x_edges[x], surface.y_edges[y]]);
            let corners = (corner(ends[0], row + 1), corner(ends[1], row));
            let (Some(level), (Some(a), Some(b))) = (run[0], corners) else {
                continue;
            };
            // Half a pixel more to the right and below hides the seams between neighbours.
            let right = (b[0] + 0.5).min(pen.plot().right);
            let below = (b[1] + 0.5).min(pen.plot().bottom);
            canvas.draw(&Rectangle::new(
                [units(a), units([right, below])],
                colour(level).filled(),
            ))?;
        }
    }
    draw_bar(bar, span, canvas)
}

fn draw_bar(bar: &Rect, span: &Span, canvas: &Canvas) -> Drawn {
    let height = bar.bottom - bar.top;
    for level in 0..LEVELS {
        let y = |l: usize| bar.bottom - height * l as f64 / LEVELS as f64;
        let below = (y(level) + 0.5).min(bar.bottom);
        let corners = [units([bar.left, y(level + 1)]), units([bar.right, below])];
        canvas.draw(&Rectangle::new(corners, colour(level).filled()))?;
    }
    let [low, high] = span.range;
    for (place, text) in &span.ticks.labelled {
        let y = bar.bottom - height * (place - low) / (high - low);
        let tick = vec![units([bar.right, y]), units([bar.right + 0.5 * TICK, y])];
        canvas.draw(&PathElement::new(tick, BLACK.stroke_width(LINE_WIDTH)))?;
        write(
            canvas,
            text,
            [bar.right + TICK, y],
            TEXT,
            Weight::Regular,
            HPos::Left,
        )?;
    }
    Ok(())
}

fn colour(level: usize) -> RGBColor {
    palette::of_part(level as f64 / (LEVELS - 1) as f64)
}
