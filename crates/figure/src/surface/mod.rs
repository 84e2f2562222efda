//! A quantity over both axes, shown by colour.

pub(crate) mod draw;

use crate::axis::Axis;
use crate::error::FigureError;
use crate::palette::Map;
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
    /// Colours of the values.
    pub(crate) map: Map,
}

/// Share of the largest size that values on the other side of zero must reach to have colours of their own.
const BOTH_SIGNS: f64 = 1e-3;

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
            map: Map::Sequential,
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
            map: Map::Sequential,
        }
    }

    /// A colour bar for the shaded series of a figure, which then have no names; the axis includes both its ends.
    pub fn bar_of_series(value: Axis) -> Surface {
        Surface {
            is_of_series: true,
            ..Surface::of_triangles(value, Vec::new())
        }
    }

    /// The same in colours that part at zero, blue below and red above, where values have both signs: equal sizes are
    /// equally strong, and the bar reaches as far to both sides.
    pub fn parted_at_zero(mut self) -> Surface {
        let finite = |value: &f64| value.is_finite();
        let [low, high] = self
            .values()
            .filter(finite)
            .fold([0.0f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
        let most = high.max(-low);
        if high.min(-low) > BOTH_SIGNS * most {
            self.value = self.value.including(-most).including(most);
            self.map = Map::Diverging;
        }
        self
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
