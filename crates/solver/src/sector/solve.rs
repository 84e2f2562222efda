//! The solution of a ring in sectors: forwards in all of them, the interface, backwards.

use rayon::prelude::*;

use super::columns::SectorColumns;
use super::factor::SectorCholesky;
use super::layout::RowPlace;
use super::part::Part;
use crate::linear_solver::{LinearSolver, SparseVector};

/// Right-hand sides: dense ones, column-major `[n][..]`, then sparse ones.
#[derive(Clone, Copy)]
pub(super) struct RightHandSides<'a> {
    pub(super) dense: &'a [f64],
    pub(super) sparse: &'a [SparseVector],
    pub(super) n_dense: usize,
}

/// Columns that are put in place together.
const GROUP: usize = 8;

impl<'a> RightHandSides<'a> {
    /// # Panics
    /// When `dense.len()` is no multiple of n.
    pub(super) fn new(
        of: &SectorCholesky,
        dense: &'a [f64],
        sparse: &'a [SparseVector],
    ) -> RightHandSides<'a> {
        let n = of.n().max(1);
        assert!(dense.len().is_multiple_of(n), "right-hand sides of {n} rows");
        RightHandSides {
            dense,
            sparse,
            n_dense: dense.len() / n,
        }
    }

    pub(super) fn n_rhs(&self) -> usize {
        self.n_dense + self.sparse.len()
    }
}

impl LinearSolver for SectorCholesky {
    fn n(&self) -> usize {
        self.shared.layout.n()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        let columns = self.columns(rhs, &[]);
        self.collect(rhs, &columns);
    }

    fn solve_at(&self, loads: &[SparseVector], rows: &[usize]) -> Vec<f64> {
        self.columns(&[], loads).values_at(rows)
    }

    /// Bytes of the factors on this rank.
    fn factor_bytes(&self) -> usize {
        self.parts.iter().map(Part::bytes).sum::<usize>() + self.interface.as_ref().map_or(0, |i| i.bytes())
    }

    fn name(&self) -> &'static str {
        "sector Cholesky"
    }
}

impl SectorCholesky {
    /// Solutions for `dense` right-hand sides, column-major `[n][..]`, and then `sparse` ones, left by sector.
    /// Collective.
    ///
    /// # Panics
    /// When `dense.len()` is no multiple of n.
    pub fn columns(&self, dense: &[f64], sparse: &[SparseVector]) -> SectorColumns {
        let loads = RightHandSides::new(self, dense, sparse);
        let n_rhs = loads.n_rhs();
        if n_rhs == 0 {
            return SectorColumns {
                shared: self.shared.clone(),
                n_columns: 0,
                local: vec![Vec::new(); self.parts.len()],
                interface: Vec::new(),
            };
        }
        let mut local = self.forward(loads);
        let boundaries = local.iter().enumerate().map(|(i, x)| self.boundary(i, x, n_rhs));
        let sent = boundaries.collect::<Vec<_>>().concat();
        let interface = self.solve_interface(self.interface_loads(loads, sent), n_rhs);
        // The sectors whose factors were read last come first: they may still be in the cache.
        let sectors = local.par_iter_mut().enumerate().rev();
        sectors.for_each(|(i, x)| self.backward(i, x, &interface, n_rhs));
        SectorColumns {
            shared: self.shared.clone(),
            n_columns: n_rhs,
            local,
            interface,
        }
    }

    /// y and -F y of the sectors owned, by places, `[n_rows][n_rhs]` each.
    fn forward(&self, loads: RightHandSides<'_>) -> Vec<Vec<f64>> {
        let n_rhs = loads.n_rhs();
        let first = self.shared.owned().start;
        let forward = |(i, part): (usize, &Part)| {
            let sector = &self.shared.layout.sectors()[first + i];
            let places = &self.shared.parts[i].places;
            let mut x = vec![0.0; n_rhs * sector.n_rows()];
            self.put_dense(i, loads, &mut x, n_rhs);
            for (r, load) in loads.sparse.iter().enumerate() {
                for &(row, value) in load {
                    if self.shared.layout.place(row) == RowPlace::Inside(first + i) {
                        let place = places[sector.inside(row)] as usize;
                        x[n_rhs * place + loads.n_dense + r] += value;
                    }
                }
            }
            part.forward(&mut x, n_rhs);
            x
        };
        self.parts.par_iter().enumerate().map(forward).collect()
    }

    /// Puts dense right-hand sides inside the i-th sector owned first among those by places, `[n_rows][n_rhs]`.
    pub(super) fn put_dense(&self, i: usize, loads: RightHandSides<'_>, x: &mut [f64], n_rhs: usize) {
        if loads.n_dense == 0 {
            return;
        }
        let (sector, places) = (&self.shared.own_sectors()[i], &self.shared.parts[i].places);
        for (&row, &place) in sector.rows[..sector.n_interior].iter().zip(places) {
            let x = &mut x[n_rhs * place as usize..][..loads.n_dense];
            x.iter_mut()
                .enumerate()
                .for_each(|(r, x)| *x = loads.dense[self.n() * r + row as usize]);
        }
    }

    /// Values on the boundary of the i-th sector owned, `[boundary][n_rhs]`, of those by places.
    pub(super) fn boundary(&self, i: usize, x: &[f64], n_rhs: usize) -> Vec<f64> {
        let (sector, places) = (&self.shared.own_sectors()[i], &self.shared.parts[i].places);
        let at = |place: &u32| &x[n_rhs * *place as usize..][..n_rhs];
        places[sector.n_interior..].iter().flat_map(at).copied().collect()
    }

    /// The backward sweep of the i-th sector owned from the solution on the interface, by places, `[n_rows][n_rhs]`.
    pub(super) fn backward(&self, i: usize, x: &mut [f64], interface: &[f64], n_rhs: usize) {
        let (sector, places) = (&self.shared.own_sectors()[i], &self.shared.parts[i].places);
        for (&place, &at) in places[sector.n_interior..].iter().zip(&sector.boundary) {
            let (place, at) = (n_rhs * place as usize, n_rhs * at);
            x[place..place + n_rhs].copy_from_slice(&interface[at..at + n_rhs]);
        }
        self.parts[i].backward(x, n_rhs);
    }

    /// What reaches the interface, `[places][n_rhs]`, on all ranks: loads, and `-F y` of the boundaries of the sectors
    /// owned, `[n_rhs]` for each of their rows.
    pub(super) fn interface_loads(&self, loads: RightHandSides<'_>, boundaries: Vec<f64>) -> Vec<f64> {
        let (shared, n, n_rhs) = (&self.shared, self.n(), loads.n_rhs());
        let lengths = shared.lengths(|s| n_rhs * s.boundary.len());
        let all = shared.comm.all_gather(boundaries, &lengths);
        let rows = shared.layout.interface();
        let mut x = vec![0.0; n_rhs * rows.len()];
        for (x, &row) in x.chunks_exact_mut(n_rhs.max(1)).zip(rows) {
            let dense = x[..loads.n_dense].iter_mut().enumerate();
            dense.for_each(|(r, x)| *x = loads.dense[n * r + row]);
        }
        for (r, load) in loads.sparse.iter().enumerate() {
            for &(row, value) in load {
                if let RowPlace::Shared(place) = shared.layout.place(row) {
                    x[n_rhs * place + loads.n_dense + r] += value;
                }
            }
        }
        let mut parts = all.chunks_exact(n_rhs.max(1));
        for sector in shared.layout.sectors() {
            for (&place, values) in sector.boundary.iter().zip(parts.by_ref()) {
                let x = &mut x[n_rhs * place..n_rhs * (place + 1)];
                x.iter_mut().zip(values).for_each(|(x, value)| *x += value);
            }
        }
        x
    }

    /// The solution on the interface, `[places][n_rhs]`, in place of what reaches it, on all ranks.
    pub(super) fn solve_interface(&self, mut x: Vec<f64>, n_rhs: usize) -> Vec<f64> {
        if let Some(interface) = self.interface.as_ref().filter(|_| n_rhs > 0) {
            interface.solve(self.shared.comm, &mut x, n_rhs);
        }
        x
    }

    /// Puts the solutions of all sectors and of the interface in place, column-major.
    pub(super) fn collect(&self, rhs: &mut [f64], columns: &SectorColumns) {
        let (shared, n, n_rhs) = (&self.shared, self.n(), columns.n_columns);
        let lengths = shared.lengths(|s| n_rhs * s.n_interior);
        let mut sent = vec![0.0; lengths[shared.comm.rank()]];
        let mut rest = &mut sent[..];
        let mut pieces = Vec::with_capacity(self.parts.len());
        for ((x, part), sector) in columns.local.iter().zip(&shared.parts).zip(shared.own_sectors()) {
            let (piece, others) = rest.split_at_mut(n_rhs * sector.n_interior);
            pieces.push((piece, x, &part.places));
            rest = others;
        }
        pieces.into_par_iter().for_each(|(piece, x, places)| {
            for (values, &place) in piece.chunks_exact_mut(n_rhs).zip(places) {
                values.copy_from_slice(&x[n_rhs * place as usize..][..n_rhs]);
            }
        });
        let all = shared.comm.all_gather(sent, &lengths);
        // As many columns at a time as a line of the cache has values.
        let group = |(g, group): (usize, &mut [f64])| {
            let mut group: Vec<&mut [f64]> = group.chunks_exact_mut(n).collect();
            shared.layout.each_row(|row, place| {
                let (values, place) = match place {
                    RowPlace::Inside(place) => (&all, place),
                    RowPlace::Shared(place) => (&columns.interface, place),
                };
                let values = &values[n_rhs * place + GROUP * g..n_rhs * (place + 1)];
                group
                    .iter_mut()
                    .zip(values)
                    .for_each(|(column, value)| column[row] = *value);
            });
        };
        rhs.par_chunks_mut(n * GROUP).enumerate().for_each(group);
    }
}
