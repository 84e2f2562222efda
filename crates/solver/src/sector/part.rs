//! One sector: order, analysis, factor of its interior, and what it leaves on its boundary.
//!
//! The Schur complement S_bb - F F^T of a sector is only semi-definite, as the sector itself is not held. It comes from
//! the factor of the sector's whole matrix with D, the diagonal of S_bb, added to the boundary: the last rows of
//! that factor are L_bb with L_bb L_bb^T = S_bb + D - F F^T, and D is taken off again. This loses no digits: S_bb and D
//! are of the same size.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, Mat, Par};
use sprs::CsMat;

use super::layout::{COMPONENTS, Sector};
use crate::dissection::dissection_within;
use crate::error::SolverError;
use crate::panels::Panels;
use crate::submatrix::restrict_lower;
use crate::symbolic::{Symbolic, supernodes};

/// Positions of the nodes of a ring, by their numbers.
pub type Points<'p> = dyn Fn(usize) -> [f64; 3] + Sync + 'p;

/// Size and cost of one sector, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectorCost {
    /// Number of its elements.
    pub n_elements: usize,
    /// Number of its rows, boundary included.
    pub n_rows: usize,
    /// Bytes of its factor with the boundary's part, which is not kept.
    pub factor_bytes: usize,
    /// Bytes of its analysis, which the factor keeps.
    pub analysis_bytes: usize,
    /// Bytes that its factorisation needs beside factor and matrix.
    pub work_bytes: usize,
    /// Rows that it shares with others.
    pub n_boundary: usize,
    /// Operations of its factorisation.
    pub flops: f64,
}

/// Analysis of one sector.
#[derive(Debug)]
pub(super) struct PartSymbolic {
    symbolic: Symbolic,
    /// Place in the elimination order of each row of the sector, `[n_rows]`.
    pub(super) places: Vec<u32>,
}

/// Factor of one sector's interior.
#[derive(Debug)]
pub(super) struct Part {
    panels: Panels,
}

impl PartSymbolic {
    /// Analyses the sector of a ring with the given nodes and elements; `matrix` has the pattern of its own matrix.
    pub(super) fn new(
        sector: &Sector,
        points: &Points<'_>,
        elements: &[usize],
        nodes_per_element: usize,
        matrix: &CsMat<f64>,
    ) -> Result<PartSymbolic, SolverError> {
        let own_points: Vec<[f64; 3]> = sector.nodes.iter().map(|&n| points(n)).collect();
        let local = |node: &usize| {
            let found = sector.nodes.binary_search(node);
            found.expect("a sector has the nodes of its elements")
        };
        let own_elements: Vec<usize> = sector
            .elements
            .iter()
            .flat_map(|&e| &elements[nodes_per_element * e..nodes_per_element * (e + 1)])
            .map(local)
            .collect();
        let nodes = dissection_within(&own_points, &own_elements, nodes_per_element, &sector.is_shared);
        let mut row_of = vec![usize::MAX; COMPONENTS * sector.nodes.len()];
        sector
            .dofs
            .iter()
            .enumerate()
            .for_each(|(row, &dof)| row_of[dof as usize] = row);
        let dofs = nodes.iter().flat_map(|&n| COMPONENTS * n..COMPONENTS * (n + 1));
        let interior = dofs.map(|dof| row_of[dof]).filter(|&row| row != usize::MAX);
        let order: Vec<usize> = interior.chain(sector.n_interior..sector.n_rows()).collect();
        let lower = restrict_lower(matrix, &sector.kept_dofs());
        let symbolic = Symbolic::with_tail(&lower, &order, sector.boundary.len())?;
        let mut places = vec![0; sector.n_rows()];
        for (place, &row) in symbolic.order().iter().enumerate() {
            places[row] = u32::try_from(place).expect("matrices of 2^32 rows fit into no memory");
        }
        Ok(PartSymbolic { symbolic, places })
    }

    pub(super) fn cost(&self, sector: &Sector) -> SectorCost {
        SectorCost {
            n_elements: sector.elements.len(),
            n_rows: sector.n_rows(),
            factor_bytes: self.symbolic.factor_bytes(),
            analysis_bytes: self.symbolic.bytes() + size_of::<u32>() * self.places.len(),
            work_bytes: self.symbolic.peak_bytes() - self.symbolic.factor_bytes(),
            n_boundary: sector.boundary.len(),
            flops: self.symbolic.flops(),
        }
    }

    /// Factors the sector's own matrix. Returns the factor and the Schur complement on the boundary, its lower
    /// triangle by rows.
    pub(super) fn factor(
        &self,
        sector: &Sector,
        matrix: &CsMat<f64>,
    ) -> Result<(Part, Vec<f64>), SolverError> {
        let mut lower = restrict_lower(matrix, &sector.kept_dofs());
        let shift = double_diagonal(&mut lower, sector.n_interior);
        let (symbolic, values) = self.symbolic.factor(&lower)?.into_parts();
        drop(lower);
        let supernodal = supernodes(&symbolic.shared.faer).expect("the analysis is supernodal");
        let complement = complement(supernodal, &values, symbolic.order(), sector.n_interior, &shift);
        let part = Part {
            panels: Panels::new(supernodal, values, sector.n_interior),
        };
        Ok((part, complement))
    }
}

impl Part {
    /// Bytes of the factor.
    pub(super) fn bytes(&self) -> usize {
        self.panels.bytes()
    }

    /// The forward sweep over values by places, `[places][n_rhs]`.
    pub(super) fn forward(&self, x: &mut [f64], n_rhs: usize) {
        self.panels.forward(self.panels.all(), x, n_rhs);
    }

    /// The backward sweep.
    pub(super) fn backward(&self, x: &mut [f64], n_rhs: usize) {
        self.panels.backward(self.panels.all(), x, n_rhs);
    }
}

/// Doubles the diagonal from a row on, and returns what was added.
fn double_diagonal(lower: &mut CsMat<f64>, first: usize) -> Vec<f64> {
    (first..lower.rows())
        .map(|row| match lower.get_mut(row, row) {
            Some(value) => {
                let added = *value;
                *value += added;
                added
            }
            None => 0.0,
        })
        .collect()
}

/// L_bb L_bb^T - D by rows of the lower triangle, boundary in the sector's order.
fn complement(
    supernodal: &SymbolicSupernodalCholesky<usize>,
    values: &[f64],
    order: &[usize],
    n_interior: usize,
    shift: &[f64],
) -> Vec<f64> {
    let n = shift.len();
    if n == 0 {
        return Vec::new();
    }
    let mut factor = Mat::<f64>::zeros(n, n);
    for s in 0..supernodal.n_supernodes() {
        let (begin, end) = (supernodal.supernode_begin()[s], supernodal.supernode_end()[s]);
        let pattern = supernodal.supernode(s).pattern();
        let (first, height) = (supernodal.col_ptr_for_val()[s], end - begin + pattern.len());
        for column in begin.max(n_interior)..end {
            let values = &values[first + (column - begin) * height..][..height];
            let rows = (begin..end).chain(pattern.iter().copied()).zip(values);
            for (row, &value) in rows.filter(|&(row, _)| row >= column) {
                factor[(row - n_interior, column - n_interior)] = value;
            }
        }
    }
    let mut square = Mat::<f64>::zeros(n, n);
    matmul(
        square.as_mut(),
        BlockStructure::TriangularLower,
        Accum::Replace,
        factor.as_ref(),
        BlockStructure::TriangularLower,
        factor.transpose(),
        BlockStructure::TriangularUpper,
        1.0,
        Par::Seq,
    );
    let mut packed = vec![0.0; n * (n + 1) / 2];
    for (j, &column) in order[n_interior..].iter().enumerate() {
        for (i, &row) in order[n_interior..].iter().enumerate().skip(j) {
            let (a, b) = (row.max(column) - n_interior, row.min(column) - n_interior);
            packed[a * (a + 1) / 2 + b] = square[(i, j)];
        }
    }
    for (i, d) in shift.iter().enumerate() {
        packed[i * (i + 1) / 2 + i] -= d;
    }
    packed
}
