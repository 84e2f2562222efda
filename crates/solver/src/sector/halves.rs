//! Right-hand sides that stay half way: swept forwards in the sectors, solved on the interface.
//!
//! With y = L^-1 f inside a sector, what reaches the interface r = f_b - sum over s of F y, and x_b = C^-1 r,
//! ```text
//! f S^-1 g = sum over s of y(f) y(g)  +  r(f) x_b(g)
//! ```
//! So what forces at contacts move, and how the contacts move under any load, needs no sweep backwards; the one that
//! ends a solution may wait until the forces are known. A sparse right-hand side is swept in the sectors that it
//! touches, a few panels of each.
//!
//! Memory: one number per row of the sectors owned that a right-hand side touches, and two of the interface. All
//! functions are collective, but those that change no number of another rank.

use std::sync::Arc;

use rayon::prelude::*;

use super::columns::SectorColumns;
use super::factor::{SectorCholesky, SharedAnalysis};
use super::layout::RowPlace;
use super::solve::RightHandSides;
use crate::linear_solver::SparseVector;

/// Right-hand sides half way: see the module.
#[derive(Debug)]
pub struct SectorHalves {
    shared: Arc<SharedAnalysis>,
    n_columns: usize,
    /// y of the sectors owned.
    local: Vec<Swept>,
    /// r, row-major `[places][n_columns]`.
    reached: Vec<f64>,
    /// x_b, the same.
    interface: Vec<f64>,
}

/// The right-hand sides that touch one sector.
#[derive(Debug)]
struct Swept {
    /// Their numbers, ascending.
    columns: Vec<usize>,
    /// y by places, row-major `[n_interior][columns]`.
    values: Vec<f64>,
    /// -F y on the boundary, row-major `[boundary][columns]`; empty once it is on the interface.
    boundary: Vec<f64>,
}

impl SectorCholesky {
    /// `dense` right-hand sides, column-major `[n][..]`, and `sparse` ones.
    ///
    /// # Panics
    /// When `dense.len()` is no multiple of n.
    pub fn halves(&self, dense: &[f64], sparse: &[SparseVector]) -> [SectorHalves; 2] {
        let loads = RightHandSides::new(self, dense, sparse);
        let sweep = |i: usize| [self.sweep_dense(i, loads), self.sweep_sparse(i, sparse)];
        let mut swept: Vec<[Swept; 2]> = (0..self.parts.len()).into_par_iter().map(sweep).collect();
        let (n_dense, n_columns) = (loads.n_dense, loads.n_rhs());
        let mut sent = Vec::new();
        for (pieces, sector) in swept.iter_mut().zip(self.shared.own_sectors()) {
            let first = sent.len();
            sent.resize(first + n_columns * sector.boundary.len(), 0.0);
            for (piece, offset) in pieces.iter_mut().zip([0, n_dense]) {
                let values = std::mem::take(&mut piece.boundary);
                let rows = sent[first..].chunks_exact_mut(n_columns.max(1));
                for (row, values) in rows.zip(values.chunks(piece.columns.len().max(1))) {
                    let pairs = piece.columns.iter().zip(values);
                    pairs.for_each(|(column, value)| row[offset + column] = *value);
                }
            }
        }
        let reached = self.interface_loads(loads, sent);
        let interface = self.solve_interface(reached.clone(), n_columns);
        let part = |values: &[f64], columns: std::ops::Range<usize>| -> Vec<f64> {
            let rows = values.chunks_exact(n_columns.max(1));
            rows.flat_map(|row| &row[columns.clone()]).copied().collect()
        };
        let (dense, sparse) = swept.into_iter().map(|[dense, sparse]| (dense, sparse)).unzip();
        let halves = |local: Vec<Swept>, columns: std::ops::Range<usize>| SectorHalves {
            shared: self.shared.clone(),
            n_columns: columns.len(),
            local,
            reached: part(&reached, columns.clone()),
            interface: part(&interface, columns),
        };
        [halves(dense, 0..n_dense), halves(sparse, n_dense..n_columns)]
    }

    /// All dense right-hand sides in the i-th sector owned.
    fn sweep_dense(&self, i: usize, loads: RightHandSides<'_>) -> Swept {
        let n_rhs = loads.n_dense;
        let mut x = vec![0.0; n_rhs * self.shared.own_sectors()[i].n_rows()];
        self.put_dense(i, loads, &mut x, n_rhs);
        self.swept(i, (0..n_rhs).collect(), x)
    }

    /// The sparse right-hand sides that touch the inside of the i-th sector owned.
    fn sweep_sparse(&self, i: usize, loads: &[SparseVector]) -> Swept {
        let s = self.shared.owned().start + i;
        let (sector, places) = (&self.shared.own_sectors()[i], &self.shared.parts[i].places);
        let inside = |&&(row, _): &&(usize, f64)| self.shared.layout.place(row) == RowPlace::Inside(s);
        let touching = |r: &usize| loads[*r].iter().any(|entry| inside(&entry));
        let columns: Vec<usize> = (0..loads.len()).filter(touching).collect();
        let n_rhs = columns.len();
        if n_rhs == 0 {
            return self.swept(i, columns, Vec::new());
        }
        let mut x = vec![0.0; n_rhs * sector.n_rows()];
        for (k, &r) in columns.iter().enumerate() {
            for &(row, value) in loads[r].iter().filter(inside) {
                x[n_rhs * places[sector.inside(row)] as usize + k] += value;
            }
        }
        self.swept(i, columns, x)
    }

    /// The forward sweep of a sector, `x` by places, `[n_rows][columns]`.
    fn swept(&self, i: usize, columns: Vec<usize>, mut x: Vec<f64>) -> Swept {
        let n_rhs = columns.len();
        if n_rhs == 0 {
            return Swept {
                columns,
                values: Vec::new(),
                boundary: Vec::new(),
            };
        }
        self.parts[i].forward(&mut x, n_rhs);
        let boundary = self.boundary(i, &x, n_rhs);
        x.truncate(n_rhs * self.shared.own_sectors()[i].n_interior);
        Swept {
            columns,
            values: x,
            boundary,
        }
    }

    /// The sum of all solutions of `terms` times their factors, `[n]`, on all ranks: one sweep backwards.
    ///
    /// # Panics
    /// When a term has another number of factors than columns.
    pub fn finish(&self, terms: &[(&SectorHalves, &[f64])]) -> Vec<f64> {
        for (halves, factors) in terms {
            assert_eq!(halves.n_columns, factors.len(), "one factor per column");
        }
        let shared = &self.shared;
        let mut interface = vec![0.0; shared.layout.interface().len()];
        for (halves, factors) in terms {
            add_combined(&mut interface, &halves.interface, factors);
        }
        let solve = |i: usize| {
            let mut x = vec![0.0; shared.own_sectors()[i].n_rows()];
            for (halves, factors) in terms {
                let Swept { columns, values, .. } = &halves.local[i];
                let factors: Vec<f64> = columns.iter().map(|&column| factors[column]).collect();
                add_combined(&mut x, values, &factors);
            }
            self.backward(i, &mut x, &interface, 1);
            x
        };
        // The sectors whose factors were read last come first: they may still be in the cache.
        let local = (0..self.parts.len()).into_par_iter().rev().map(solve);
        let mut local: Vec<Vec<f64>> = local.collect();
        local.reverse();
        let mut whole = vec![0.0; shared.layout.n()];
        let columns = SectorColumns {
            shared: shared.clone(),
            n_columns: 1,
            local,
            interface,
        };
        self.collect(&mut whole, &columns);
        whole
    }
}

impl SectorHalves {
    /// Number of right-hand sides.
    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    /// Bytes on this rank.
    pub fn bytes(&self) -> usize {
        let local: usize = self.local.iter().map(|swept| swept.values.len()).sum();
        size_of::<f64>() * (local + self.reached.len() + self.interface.len())
    }

    /// f S^-1 g of all right-hand sides f of these and g of others, row-major `[n_columns][others.n_columns]`, on all
    /// ranks.
    pub fn products(&self, others: &SectorHalves) -> Vec<f64> {
        let (n, m) = (self.n_columns, others.n_columns);
        let pairs: Vec<(&Swept, &Swept)> = self.local.iter().zip(&others.local).collect();
        let within = |(f, g): (&Swept, &Swept)| {
            let mut products = vec![0.0; n * m];
            let own = f.times(g);
            for (&i, row) in f.columns.iter().zip(own.chunks(g.columns.len().max(1))) {
                let pairs = g.columns.iter().zip(row);
                pairs.for_each(|(&j, value)| products[m * i + j] = *value);
            }
            products
        };
        let sent: Vec<Vec<f64>> = pairs.into_par_iter().map(within).collect();
        let lengths = self.shared.lengths(|_| n * m);
        let all = self.shared.comm.all_gather(sent.concat(), &lengths);
        let mut sum = row_products([&self.reached, &others.interface], [n, m]);
        for products in all.chunks_exact((n * m).max(1)) {
            sum.iter_mut()
                .zip(products)
                .for_each(|(sum, value)| *sum += value);
        }
        sum
    }

    /// Adds right-hand sides to these, one to one.
    ///
    /// # Panics
    /// When their numbers differ, or they touch other sectors.
    pub fn add(&mut self, more: &SectorHalves) {
        assert_eq!(self.n_columns, more.n_columns, "as many right-hand sides");
        let pairs = self.local.iter_mut().zip(&more.local);
        let local = pairs.map(|(own, more)| {
            assert_eq!(own.columns, more.columns, "right-hand sides in the same sectors");
            (&mut own.values, &more.values)
        });
        let interface = [
            (&mut self.reached, &more.reached),
            (&mut self.interface, &more.interface),
        ];
        for (own, more) in local.chain(interface) {
            own.iter_mut().zip(more).for_each(|(x, y)| *x += y);
        }
    }
}

impl Swept {
    /// y(f) y(g), row-major `[columns][others.columns]`.
    fn times(&self, others: &Swept) -> Vec<f64> {
        row_products(
            [&self.values, &others.values],
            [self.columns.len(), others.columns.len()],
        )
    }
}

/// A^T B of row-major matrices with as many rows, of n and m columns, row-major; zeros of A cost nothing.
fn row_products([a, b]: [&[f64]; 2], [n, m]: [usize; 2]) -> Vec<f64> {
    let mut sums = vec![0.0; n * m];
    if n == 0 || m == 0 {
        return sums;
    }
    for (a, b) in a.chunks_exact(n).zip(b.chunks_exact(m)) {
        for (&a, sums) in a.iter().zip(sums.chunks_exact_mut(m)) {
            if a != 0.0 {
                sums.iter_mut().zip(b).for_each(|(sum, b)| *sum += a * b);
            }
        }
    }
    sums
}

/// Adds the sum of the columns of a row-major matrix times their factors.
fn add_combined(sum: &mut [f64], values: &[f64], factors: &[f64]) {
    if factors.is_empty() {
        return;
    }
    for (sum, row) in sum.iter_mut().zip(values.chunks_exact(factors.len())) {
        row.iter().zip(factors).for_each(|(x, f)| *sum += f * x);
    }
}
