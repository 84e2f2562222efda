//! All bodies as one unstructured grid, in the arrays VTKHDF asks for.

use crate::body::Body;
use crate::checksum::checksum;
use crate::error::CheckpointError;

/// The arrays of `mesh.hdf`.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Points, m, `[n_points][3]`.
    pub points: Vec<[f64; 3]>,
    /// Points of the cells, one cell after the other.
    pub connectivity: Vec<i64>,
    /// Start of each cell in `connectivity`, and its end, `[n_cells + 1]`.
    pub offsets: Vec<i64>,
    /// VTK cell types, `[n_cells]`.
    pub types: Vec<u8>,
    /// Body of each cell, `[n_cells]`.
    pub body: Vec<u8>,
    /// Radius of the sphere a cell stands for, m, 0 for solids, `[n_cells]`.
    pub radius: Vec<f64>,
}

impl Grid {
    /// Points of a cell.
    pub fn cell(&self, cell: usize) -> impl Iterator<Item = usize> {
        let range = self.offsets[cell] as usize..self.offsets[cell + 1] as usize;
        self.connectivity[range].iter().map(|&point| point as usize)
    }

    /// Joins the bodies in their order.
    pub(crate) fn join(bodies: &[Body]) -> Result<Grid, CheckpointError> {
        let mut grid = Grid {
            points: Vec::new(),
            connectivity: Vec::new(),
            offsets: vec![0],
            types: Vec::new(),
            body: Vec::new(),
            radius: Vec::new(),
        };
        for (i, body) in bodies.iter().enumerate() {
            body.validate()?;
            if let Some(other) = bodies[..i].iter().find(|other| other.id == body.id) {
                let what = format!(
                    "its id {} is that of body \"{}\", expected another",
                    body.id, other.name
                );
                return Err(CheckpointError::Body {
                    body: body.name.clone(),
                    what,
                });
            }
            grid.append(body);
        }
        Ok(grid)
    }

    fn append(&mut self, body: &Body) {
        let first_point = self.points.len();
        self.points.extend_from_slice(&body.points);
        self.connectivity.extend(
            body.connectivity
                .iter()
                .map(|&point| (first_point + point) as i64),
        );
        let mut end = self.offsets[self.offsets.len() - 1];
        for _ in 0..body.n_cells() {
            end += body.kind.n_points() as i64;
            self.offsets.push(end);
            self.types.push(body.kind.vtk_type());
            self.body.push(body.id);
            self.radius.push(body.radius);
        }
    }

    /// Whether every cell has its arrays, and nodes that are there.
    pub fn is_sound(&self) -> bool {
        let (n_points, n_cells) = (self.points.len() as i64, self.types.len());
        let ends = (self.offsets.first(), self.offsets.last());
        self.offsets.len() == n_cells + 1
            && ends == (Some(&0), Some(&(self.connectivity.len() as i64)))
            && self.offsets.is_sorted()
            && [self.body.len(), self.radius.len()] == [n_cells; 2]
            && self.connectivity.iter().all(|node| (0..n_points).contains(node))
    }

    /// Fingerprint of the grid: sizes and checksums of points, cells and bodies. It tells apart meshes made by
    /// different recipes; it is no protection against forgery.
    pub fn fingerprint(&self) -> String {
        let points = checksum("points", &[self.points.len(), 3], self.points.as_flattened());
        let connectivity = checksum("connectivity", &[self.connectivity.len()], &self.connectivity);
        let types = checksum("types", &[self.types.len()], &self.types);
        let body = checksum("body", &[self.body.len()], &self.body);
        let (n_points, n_cells) = (self.points.len(), self.types.len());
        format!("{n_points}-{n_cells}-{points:08x}{connectivity:08x}{types:08x}{body:08x}")
    }
}
