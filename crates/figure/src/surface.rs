//! A quantity over both axes, shown by colour, with a colour bar.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::chart::{Canvas, Drawn, units, write};
use crate::layout::{LINE_WIDTH, Rect, Span, TEXT, TICK};
use crate::marks::Pen;
use crate::text::Weight;
use crate::triangles::{LEVELS, Triangle, bands, level_of};
use crate::{Axis, FigureError, palette};

/// Width of the lines that hide seams, units of the drawing.
const SEAM: u32 = 8;

/// Values of a grid of rectangles, or of triangles.
#[derive(Clone, Debug)]
pub struct Surface {
    /// What the colours show.
    pub(crate) value: Axis,
    /// Edges of the columns, in ascending order, `[n_x + 1]`.
    x_edges: Vec<f64>,
    /// Edges of the rows, in ascending order, `[n_y + 1]`.
    y_edges: Vec<f64>,
    /// Values, row after row, `[n_y][n_x]`; NaN is left white.
    values: Vec<f64>,
    /// Triangles, where there is no grid.
    triangles: Vec<Triangle>,
    /// Whether it is no area, but the colours of the shaded series.
    pub(crate) is_of_series: bool,
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
            triangles: Vec::new(),
            is_of_series: false,
        })
    }

    /// A surface of triangles, the values linear in each; the rest stays white.
    pub fn of_triangles(value: Axis, triangles: Vec<Triangle>) -> Surface {
        Surface {
            value: value.tight(),
            x_edges: Vec::new(),
            y_edges: Vec::new(),
            values: Vec::new(),
            triangles,
            is_of_series: false,
        }
    }

    /// A colour bar for the shaded series of a figure, which then have no names; the axis includes both its ends.
    pub fn bar_of_series(value: Axis) -> Surface {
        Surface {
            is_of_series: true,
            ..Surface::of_triangles(value, Vec::new())
        }
    }

    /// All places along x (0) or y (1).
    pub(crate) fn places(&self, component: usize) -> Vec<f64> {
        let corners = self.triangles.iter().flat_map(|t| t.corners);
        let edges = [&self.x_edges, &self.y_edges][component].iter().copied();
        edges.chain(corners.map(|corner| corner[component])).collect()
    }

    /// All values.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> {
        let of_triangles = self.triangles.iter().flat_map(|t| t.values);
        self.values.iter().copied().chain(of_triangles)
    }
}

/// Draws the cells, equal neighbours in one piece, and the colour bar with its labels.
pub(crate) fn draw_surface(surface: &Surface, bar: &(Rect, Span), pen: &Pen, canvas: &Canvas) -> Drawn {
    let (bar, span) = bar;
    for triangle in &surface.triangles {
        for (level, part) in bands(triangle, span.range) {
            let corners: Vec<_> = part.iter().filter_map(|&p| pen.pixel(p)).map(units).collect();
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
    let brightest = if surface.is_of_series {
        palette::BRIGHTEST
    } else {
        1.0
    };
    draw_bar(bar, span, brightest, canvas)
}

fn draw_bar(bar: &Rect, span: &Span, brightest: f64, canvas: &Canvas) -> Drawn {
    let height = bar.bottom - bar.top;
    for level in 0..LEVELS {
        let y = |l: usize| bar.bottom - height * l as f64 / LEVELS as f64;
        let below = (y(level) + 0.5).min(bar.bottom);
        let corners = [units([bar.left, y(level + 1)]), units([bar.right, below])];
        let part = brightest * level as f64 / (LEVELS - 1) as f64;
        canvas.draw(&Rectangle::new(corners, palette::of_part(part).filled()))?;
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
