//! The bodies a result shows: the two rings as solid cells, the balls as vertex cells.

use std::ops::Range;

use mesh::{ElementKind, Mesh};

use crate::error::CheckpointError;

/// Kind of the cells of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// A single point, such as the centre of a ball.
    Vertex,
    /// A volume element; its node order is VTK's already.
    Element(ElementKind),
}

impl CellKind {
    /// VTK cell type: 1 for a vertex, else that of the element.
    pub fn vtk_type(self) -> u8 {
        match self {
            CellKind::Vertex => 1,
            CellKind::Element(kind) => kind.vtk_type(),
        }
    }

    /// Points of one cell.
    pub fn n_points(self) -> usize {
        match self {
            CellKind::Vertex => 1,
            CellKind::Element(kind) => kind.n_nodes(),
        }
    }
}

/// One body of the result. Its points are numbered from zero; in the files the points of all bodies follow each
/// other in the order of the bodies, see [`point_ranges`].
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name, for people: "inner_ring".
    pub name: String,
    /// Value of the cell array `body` on the cells of this body.
    pub id: u8,
    /// Undeformed points, m, `[n_points][3]`.
    pub points: Vec<[f64; 3]>,
    /// Kind of every cell.
    pub kind: CellKind,
    /// Points of the cells, `[n_cells][kind.n_points()]`, flat.
    pub connectivity: Vec<usize>,
    /// Value of the cell array `radius`, m: radius of the sphere a vertex stands for, 0 for solids.
    pub radius: f64,
}

impl Body {
    /// A ring: all elements of `mesh`, moved by `translation`, m. (The inner ring is meshed in its own frame and
    /// shown where it sits in the assembled bearing.)
    pub fn from_mesh(name: &str, id: u8, mesh: &Mesh, translation: [f64; 3]) -> Body {
        let moved = |node: &[f64; 3]| [0, 1, 2].map(|i| node[i] + translation[i]);
        Body {
            name: name.to_string(),
            id,
            points: mesh.nodes.iter().map(moved).collect(),
            kind: CellKind::Element(mesh.kind),
            connectivity: mesh.connectivity.clone(),
            radius: 0.0,
        }
    }

    /// Balls: one vertex per centre, m, `[n_balls][3]`, all of the same `radius`, m.
    pub fn balls(name: &str, id: u8, centres: &[[f64; 3]], radius: f64) -> Body {
        Body {
            name: name.to_string(),
            id,
            points: centres.to_vec(),
            kind: CellKind::Vertex,
            connectivity: (0..centres.len()).collect(),
            radius,
        }
    }

    /// Number of cells.
    pub fn n_cells(&self) -> usize {
        self.connectivity.len() / self.kind.n_points()
    }

    /// Checks that cells are whole and name existing points: a viewer given anything else may crash.
    pub(crate) fn validate(&self) -> Result<(), CheckpointError> {
        let fail = |what: String| {
            Err(CheckpointError::Body {
                body: self.name.clone(),
                what,
            })
        };
        let (n_points, per_cell) = (self.points.len(), self.kind.n_points());
        if !self.connectivity.len().is_multiple_of(per_cell) {
            let n = self.connectivity.len();
            return fail(format!(
                "connectivity has {n} entries, expected a multiple of {per_cell}"
            ));
        }
        if let Some(i) = self.connectivity.iter().position(|&point| point >= n_points) {
            let (cell, point) = (i / per_cell, self.connectivity[i]);
            return fail(format!(
                "cell {cell} names point {point}, the body has {n_points} points"
            ));
        }
        if let Some(i) = self.points.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            return fail(format!(
                "point {i} is at {:?}, expected finite coordinates",
                self.points[i]
            ));
        }
        Ok(())
    }
}

/// Rows of the point arrays that belong to each body, in the order of the bodies.
pub fn point_ranges(bodies: &[Body]) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut range = |body: &Body| {
        let range = start..start + body.points.len();
        start = range.end;
        range
    };
    bodies.iter().map(&mut range).collect()
}
