//! Functionals of a ring's mount, and what unit forces of the partner move.
//!
//! A clamped or mean-motion mount has five or six functionals, each with entries of its own. The functions of a seat
//! are hundreds on the same nodes: they are kept as a matrix, whose nodes are looked up once.

use body::{SeatFunctions, SeatRows};
use dense::inner_products;
use solver::LinearSolver;

use crate::sparse::{SparseLoad, fill, sparse_dot};

/// Functionals of a mount.
#[derive(Clone, Debug, Default)]
pub struct MountRows {
    /// Index of a coordinate and value, by functional.
    pub rows: Vec<SparseLoad>,
    /// The same where they are many.
    dense: Option<DenseRows>,
}

/// Many functionals of the same coordinates.
#[derive(Clone, Debug)]
struct DenseRows {
    /// The coordinates, ascending.
    places: Vec<usize>,
    /// Functionals of single ones of these.
    units: Vec<SparseLoad>,
    /// The functionals of them.
    rows: SeatRows,
}

impl MountRows {
    /// A mount of few functionals.
    pub fn new(rows: Vec<SparseLoad>) -> MountRows {
        MountRows { rows, dense: None }
    }

    /// The functions of the seat of a ring whose coordinates are the dofs of its nodes.
    pub fn of_seat(functions: &SeatFunctions) -> MountRows {
        let dofs = |node: &usize| [3 * node, 3 * node + 1, 3 * node + 2];
        let places: Vec<usize> = functions.nodes.iter().flat_map(dofs).collect();
        MountRows {
            rows: functions.sparse_rows(),
            dense: Some(DenseRows {
                units: places.iter().map(|&i| vec![(i, 1.0)]).collect(),
                places,
                rows: functions.rows().clone(),
            }),
        }
    }

    /// Number of functionals.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The functionals that are rigid motions of the ring: those of shaft and housing, not those of a seat.
    pub fn rigid(&self) -> &[SparseLoad] {
        match self.dense {
            None => &self.rows,
            Some(_) => &[],
        }
    }

    /// Functionals of single coordinates from which values of all follow; None where they are their own.
    pub fn units(&self) -> Option<&[SparseLoad]> {
        self.dense.as_ref().map(|dense| &dense.units[..])
    }

    /// Values of the functionals from those of the units.
    pub fn of_units(&self, units: &[f64]) -> Vec<f64> {
        let dense = self.dense.as_ref().expect("a mount with units has its matrix");
        dense.rows.measure(units)
    }

    /// Values of many functionals at coordinates.
    pub fn measure(&self, y: &[f64]) -> Vec<f64> {
        let dense = self.dense.as_ref().expect("many functionals have their matrix");
        let here: Vec<f64> = dense.places.iter().map(|&i| y[i]).collect();
        self.of_units(&here)
    }

    /// Products of many functionals with each other, `[n][n]` flat.
    pub fn gram(&self) -> Vec<f64> {
        let dense = self.dense.as_ref().expect("many functionals have their matrix");
        let (n, rows) = (dense.rows.n(), &dense.rows);
        let rows: Vec<f64> = (0..n).flat_map(|k| rows.row(k)).collect();
        inner_products(dense.places.len(), &rows, n, &rows, n)
    }

    /// Loads of forces on the functionals: index and value, of many functionals each index once.
    pub fn loads<'a>(&'a self, forces: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let few = self.rigid().iter().zip(forces);
        let few = few.flat_map(|(row, f)| row.iter().map(move |&(i, w)| (i, f * w)));
        few.chain(self.dense.iter().flat_map(|dense| dense.loads(forces)))
    }
}

impl DenseRows {
    /// Loads of forces on the functionals.
    fn loads(&self, forces: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        let mut loads = vec![0.0; self.places.len()];
        self.rows.add_loads(forces, &mut loads);
        self.places.iter().copied().zip(loads)
    }
}

/// Functionals whose columns are solved together.
pub(crate) const COLUMNS_AT_ONCE: usize = 32;

/// S^-1 times the functionals of the mount, at the coordinates that contacts and defects meet.
pub(crate) struct MountColumns {
    /// Of each coordinate that is kept what the functionals move it, `[n_kept][n_mount]` flat.
    moved: Vec<f64>,
    /// Where a coordinate is kept.
    places: Vec<Option<usize>>,
    /// Their values at the functionals, row-major.
    pub compliance: Vec<f64>,
    n_mount: usize,
}

impl MountColumns {
    /// Those of a factor of n rows, at the coordinates `kept`.
    pub fn new(factor: &dyn LinearSolver, mount: &[SparseLoad], n: usize, kept: &[usize]) -> MountColumns {
        let m = mount.len();
        let mut places = vec![None; n];
        kept.iter()
            .enumerate()
            .for_each(|(place, &i)| places[i] = Some(place));
        let (mut moved, mut compliance) = (vec![0.0; m * kept.len()], vec![0.0; m * m]);
        for (block, functionals) in mount.chunks(COLUMNS_AT_ONCE).enumerate() {
            let mut columns = vec![0.0; n * functionals.len()];
            fill(&mut columns, functionals, n);
            factor.solve(&mut columns, functionals.len());
            for (c, column) in columns.chunks_exact(n).enumerate() {
                let k = COLUMNS_AT_ONCE * block + c;
                kept.iter()
                    .zip(moved.chunks_exact_mut(m))
                    .for_each(|(&i, at)| at[k] = column[i]);
                (0..m).for_each(|row| compliance[m * row + k] = sparse_dot(&mount[row], column));
            }
        }
        MountColumns {
            compliance,
            places,
            moved,
            n_mount: m,
        }
    }

    /// Number of functionals.
    pub fn n(&self) -> usize {
        self.n_mount
    }

    /// What unit forces on the functionals move a coordinate that is kept.
    pub fn at(&self, coordinate: usize) -> &[f64] {
        let place = self.places[coordinate].expect("contacts and defects meet what is kept");
        &self.moved[self.n_mount * place..][..self.n_mount]
    }

    /// What they move a functional.
    pub fn of(&self, functional: &SparseLoad) -> Vec<f64> {
        // As a sum of no numbers begins: bits of a zero stay.
        let mut sum = vec![-0.0; self.n_mount];
        for &(i, weight) in functional {
            sum.iter_mut().zip(self.at(i)).for_each(|(s, u)| *s += weight * u);
        }
        sum
    }
}
