//! Draws a surface, and its colour bar.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::Surface;
use crate::DataPoint;
use crate::canvas::{Canvas, Drawn, units, write};
use crate::layout::Span;
use crate::marks::Pen;
use crate::page::{LINE_WIDTH, Rect, TEXT, TICK};
use crate::palette::{self, Map};
use crate::text::Weight;
use crate::triangles::{LEVELS, bands, level_of};

/// Width of the lines that hide seams, units of the drawing.
const SEAM: u32 = 8;

/// Draws the cells, equal neighbours in one piece, and the colour bar with its labels.
pub(crate) fn draw_surface(surface: &Surface, bar: &(Rect, Span), pen: &Pen, canvas: &Canvas) -> Drawn {
    let (bar, span) = bar;
    let colour = |level: usize| palette::on_map(surface.map, level as f64 / (LEVELS - 1) as f64);
    for triangle in &surface.triangles {
        for (level, part) in bands(triangle, span.range) {
            let corners: Vec<_> = part
                .iter()
                .filter_map(|&p| pen.pixel(p.into()))
                .map(units)
                .collect();
            // A thin line of the same colour hides the seams between neighbours.
            canvas.draw(&Polygon::new(corners.clone(), colour(level).filled()))?;
            let outline = corners.iter().chain(corners.first()).copied().collect::<Vec<_>>();
            canvas.draw(&PathElement::new(outline, colour(level).stroke_width(SEAM)))?;
        }
    }
    let n_x = surface.x_edges.len().saturating_sub(1).max(1);
    for (row, values) in surface.values.chunks(n_x).enumerate() {
        let place = |value: &f64| surface.value.place(*value).and_then(|p| level_of(p, span.range));
        let levels: Vec<Option<usize>> = values.iter().map(place).collect();
        let mut column = 0;
        for run in levels.chunk_by(PartialEq::eq) {
            let ends = [column, column + run.len()];
            column = ends[1];
            let corner =
                |x: usize, y: usize| pen.pixel(DataPoint::new(surface.x_edges[x], surface.y_edges[y]));
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
    let brightest = if surface.is_of_series {
        palette::BRIGHTEST
    } else {
        1.0
    };
    draw_bar(bar, span, (surface.map, brightest), canvas)
}

/// Draws the bar of a map up to a part of it.
fn draw_bar(bar: &Rect, span: &Span, (map, brightest): (Map, f64), canvas: &Canvas) -> Drawn {
    let height = bar.bottom - bar.top;
    for level in 0..LEVELS {
        let y = |l: usize| bar.bottom - height * l as f64 / LEVELS as f64;
        let below = (y(level) + 0.5).min(bar.bottom);
        let corners = [units([bar.left, y(level + 1)]), units([bar.right, below])];
        let part = brightest * level as f64 / (LEVELS - 1) as f64;
        canvas.draw(&Rectangle::new(corners, palette::on_map(map, part).filled()))?;
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
