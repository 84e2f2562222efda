//! A quantity over both axes, shown by colour.

pub(crate) mod draw;

use crate::axis::Axis;
use crate::error::FigureError;
use crate::triangles::Triangle;

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
