//! A defect of a ring whose vectors are harmonics: those of its regular ring, which has rows that the true ring lacks.
//!
//! With D the change from the regular ring's matrices to the true ones on the rows r of the defect and the rows g
//! that only the regular ring has, forces on r make the regular ring's equations on all true rows those of the true
//! ring,
//! ```text
//! f = (D_M m + D_K k)_r,    m = (history) - c_M x,   k = (history) - w - c_K x
//! ```
//! at the values on r and g. The rows g obey the regular ring's own equations: a piece of it that the true ring moves
//! and that does not act back. So a step is that of the regular ring, all its solves and products harmonic by
//! harmonic, under the forces f. With x0 the predictor of the regular ring, the rest of its increment x has no load
//! on g, so that there D is the condensed one ([`solver::cyclic::Defect`]): with q = f(x0), G the compliance of r and
//! V F the motion of r by the contacts,
//! ```text
//! f = q - S (G q + V F)
//! ```
//! Energies and other quadratic forms are those of the regular ring plus the form of D, which takes the rows g out
//! again. At the start g is at rest in the regular ring's statics. Cost: a transform of the defect's section nodes
//! per vector, three products of n^2.

use dense::DenseCholesky;
use solver::cyclic::SectionPart;
use solver::{CyclicRing, NodalLoad};
use sprs::CsMat;

use super::defect_change::Changes;
use super::periodic::HeldSectors;
use crate::matrices::{Matrix, Nodes};
use crate::sparse::product;
use crate::state::{RingState, RowValues};
use crate::step::FrameTurn;
use crate::vectors::{add, dot};

/// The defect of a ring in harmonic space.
pub(crate) struct SpaceDefect {
    /// The ring with all rows of the regular one.
    regular: CyclicRing,
    /// Section nodes of the rows.
    part: SectionPart,
    /// Where the rows are in a vector: those of the true ring, then those that it lacks.
    places: Vec<SpaceRow>,
    /// Rows of the true ring.
    n_rows: usize,
    /// D of M and K.
    change: [CsMat<f64>; 2],
    /// K of the rows that the true ring lacks.
    lacking: Option<DenseCholesky>,
    /// What the inertia of a turning frame has on the rows beyond that of the regular ring; none when the frame stays.
    frame: Option<FrameRows>,
}

/// Inertia of a turning frame on the rows that does not come from the rows' own motion, the true ring's less the
/// regular one's, for P u = (u_x, u_y, 0) and J u = (u_y, -u_x, 0).
struct FrameRows {
    /// Of the node positions.
    position: [Vec<f64>; 2],
    /// Of the motion of the held nodes with each dof of the shaft.
    shaft: Vec<[Vec<f64>; 2]>,
}

/// Where a row is in a vector of the space.
enum SpaceRow {
    /// A row of the regular ring.
    Free(usize),
    /// A row behind the harmonics.
    Shaft(usize),
}

/// Factors of the terms in the equations of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    /// Of v and a under M, and under K, in what is known.
    pub history: [[f64; 2]; 2],
    /// Of M and K in the effective matrix.
    pub effective: [f64; 2],
}

impl SpaceDefect {
    /// The defect that changes the matrices of the regular ring `held` by `changes`. None when the true ring has rows
    /// that the regular one lacks, or when a piece that is missing hangs on a hinge in the regular ring.
    pub(super) fn new(changes: &Changes, held: &HeldSectors) -> Option<SpaceDefect> {
        let (regular, seen) = (held.sectors.ring.clone(), held.seen.as_ref()?);
        let n_free = 3 * seen.len();
        if !changes.loose().is_empty() {
            return None;
        }
        let place = |&row: &usize| match row.checked_sub(n_free) {
            Some(shaft) => Some(SpaceRow::Shaft(shaft)),
            None => Some(SpaceRow::Free(3 * seen[row / 3]? + row % 3)),
        };
        let rows: Option<Vec<SpaceRow>> = changes.rows().iter().map(place).collect();
        let (mut places, n_rows) = (rows?, changes.rows().len());
        places.extend(changes.gone().iter().map(|&row| SpaceRow::Free(row)));
        let n = places.len();
        let [mass, stiffness] = changes.values();
        let of_lacking: Vec<f64> = (n_rows..n)
            .flat_map(|i| stiffness[n * i + n_rows..n * (i + 1)].iter().map(|k| -k))
            .collect();
        let lacking = match n - n_rows {
            0 => None,
            n_gone => Some(DenseCholesky::factor(n_gone, &of_lacking).ok()?),
        };
        let nodes = places.iter().filter_map(|place| match place {
            SpaceRow::Free(row) => Some(row / 3),
            SpaceRow::Shaft(_) => None,
        });
        Some(SpaceDefect {
            part: regular.section_part(&[], nodes),
            change: [mass, stiffness].map(|values| compressed(n, values)),
            regular,
            places,
            n_rows,
            lacking,
            frame: None,
        })
    }

    /// The same in a turning frame; `own` are the nodes of the true ring, `regular` those of the regular one.
    pub(super) fn turning(self, own: Nodes<'_>, regular: Nodes<'_>, true_rows: &[usize]) -> SpaceDefect {
        let n_free = regular.coordinates.free().len();
        let on_rows = |[own, regular]: [Vec<f64>; 2]| -> Vec<f64> {
            let place = |(i, place): (usize, &SpaceRow)| {
                let of_regular = match place {
                    SpaceRow::Free(row) => regular[*row],
                    SpaceRow::Shaft(k) => regular[n_free + k],
                };
                true_rows.get(i).map_or(0.0, |&row| own[row]) - of_regular
            };
            self.places.iter().enumerate().map(place).collect()
        };
        let both = |[own, regular]: [[Vec<f64>; 2]; 2]| {
            let ([p, j], [regular_p, regular_j]) = (own, regular);
            [on_rows([p, regular_p]), on_rows([j, regular_j])]
        };
        let nodes = [own, regular];
        let frame = FrameRows {
            position: both(nodes.map(|nodes| nodes.inertia_of_positions())),
            shaft: (0..own.coordinates.shaft().0.len())
                .map(|k| both(nodes.map(|nodes| nodes.inertia_of_shaft(k))))
                .collect(),
        };
        SpaceDefect {
            frame: Some(frame),
            ..self
        }
    }

    /// The ring with all rows of the regular one.
    pub(super) fn regular(&self) -> &CyclicRing {
        &self.regular
    }

    /// Inertia of the turning frame on the rows, the true ring's less the regular one's, at displacement and velocity
    /// `w` and `v` of the rows.
    pub(super) fn inertia(&self, turn: FrameTurn, [w, v]: [&[f64]; 2]) -> Vec<f64> {
        let (speed, acceleration) = (turn.speed, turn.acceleration);
        let square = speed * speed;
        let turned = |(i, place): (usize, &SpaceRow)| match place {
            SpaceRow::Free(row) if row % 3 == 0 => {
                square * w[i] + acceleration * w[i + 1] + 2.0 * speed * v[i + 1]
            }
            SpaceRow::Free(row) if row % 3 == 1 => {
                square * w[i] - acceleration * w[i - 1] - 2.0 * speed * v[i - 1]
            }
            SpaceRow::Free(_) | SpaceRow::Shaft(_) => 0.0,
        };
        let field: Vec<f64> = self.places.iter().enumerate().map(turned).collect();
        let mut inertia = product(&self.change[0], &field);
        let Some(frame) = &self.frame else { return inertia };
        let mut more = |[own, turned]: [f64; 2], [p, j]: &[Vec<f64>; 2]| {
            let terms = inertia.iter_mut().zip(p.iter().zip(j));
            terms.for_each(|(sum, (p, j))| *sum += own * p + turned * j);
        };
        more([square, acceleration], &frame.position);
        for (i, place) in self.places.iter().enumerate() {
            if let SpaceRow::Shaft(k) = place {
                let factors = [square * w[i], acceleration * w[i] + 2.0 * speed * v[i]];
                more(factors, &frame.shaft[*k]);
            }
        }
        inertia
    }

    /// The values on the rows of a vector of the space, `[n]`: rows of the true ring, then those that it lacks.
    pub(super) fn values(&self, x: &[f64]) -> Vec<f64> {
        let (harmonics, border) = x.split_at(self.regular.harmonic_len());
        let field = self.regular.field_at(&self.part, harmonics);
        let value = |place: &SpaceRow| match place {
            SpaceRow::Free(row) => field.value(*row),
            SpaceRow::Shaft(k) => border[*k],
        };
        self.places.iter().map(value).collect()
    }

    /// The same of a state.
    pub(super) fn of_state(&self, state: &RingState) -> RowValues {
        RowValues(state.vectors().map(|x| self.values(x)))
    }

    /// q, the forces of the defect at the predictor `predictor` of the regular ring from a state with the values
    /// `state`, on the true rows.
    pub(super) fn known(&self, terms: Terms, state: &RowValues, predictor: &[f64]) -> Vec<f64> {
        let RowValues([w, v, a]) = state;
        let ([m, k], [cm, ck]) = (terms.history, terms.effective);
        let x = self.values(predictor);
        let of_mass: Vec<f64> = (0..x.len())
            .map(|i| m[0] * v[i] + m[1] * a[i] - cm * x[i])
            .collect();
        let of_stiffness: Vec<f64> = (0..x.len())
            .map(|i| k[0] * v[i] + k[1] * a[i] - w[i] - ck * x[i])
            .collect();
        let mut forces = product(&self.change[0], &of_mass);
        add(&mut forces, &product(&self.change[1], &of_stiffness));
        forces.truncate(self.n_rows);
        forces
    }

    /// a D b of one matrix.
    pub(super) fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        dot(a, &self.product(matrix, b))
    }

    /// D b of one matrix.
    pub(super) fn product(&self, matrix: Matrix, b: &[f64]) -> Vec<f64> {
        product(&self.change[matrix as usize], b)
    }

    /// Moves the rows that the true ring lacks, which are zero in `x`, as the statics of the regular ring does.
    pub(super) fn fill(&self, x: &mut [f64]) {
        let Some(lacking) = &self.lacking else { return };
        let coupled = product(&self.change[1], &self.values(x));
        let mut moved = coupled[self.n_rows..].to_vec();
        lacking.solve(&mut moved, 1);
        let rows = self.places[self.n_rows..].iter().zip(moved);
        let loads = rows.filter_map(|(place, value)| match place {
            SpaceRow::Free(row) => {
                let mut force = [0.0; 3];
                force[row % 3] = value;
                Some(NodalLoad { node: row / 3, force })
            }
            SpaceRow::Shaft(_) => None,
        });
        let harmonics = &mut x[..self.regular.harmonic_len()];
        self.regular.add_loads(&loads.collect::<Vec<_>>(), harmonics);
    }
}

/// A matrix, row-major `[n][n]`, without its zeros.
fn compressed(n: usize, values: &[f64]) -> CsMat<f64> {
    let (mut starts, mut columns, mut entries) = (vec![0], Vec::new(), Vec::new());
    for row in values.chunks_exact(n.max(1)) {
        for (j, &value) in row.iter().enumerate() {
            if value != 0.0 {
                columns.push(j);
                entries.push(value);
            }
        }
        starts.push(columns.len());
    }
    CsMat::new((n, n), starts, columns, entries)
}
