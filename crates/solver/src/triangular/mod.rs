//! The two triangular halves of a sparse Cholesky solve, S = L L^T, apart, and forward solutions that stay sparse.
//!
//! A right-hand side with few entries touches few columns of L: those of its rows and their ancestors in the
//! elimination tree (Gilbert and Peierls, *Sparse partial pivoting in time proportional to arithmetic operations*, SIAM
//! J. Sci. Stat. Comput. 9 (1988) 862, doi:10.1137/0909058). With z = L^-1 b and the columns Z = L^-1 W of sparse
//! functionals W,
//! ```text
//! W^T S^-1 W = Z^T Z,    W^T S^-1 b = Z^T z,    S^-1 (b + W f) = L^-T (z + Z f)
//! ```
//! So whoever needs the compliance of few ports, and later the whole solution under their forces, takes one solve: the
//! forward half before, the backward half after, and between them only the columns of L above the ports.
//!
//! **Cost.** Each half reads L once, [`ForwardColumns`] the columns that the ports reach.
//!
//! **Threads.** The tree is cut into subtrees of at most 1 / [`MOST_SHARE`] of the entries of L, and the top above.
//! Subtrees are swept in parallel, each with its own sums for the top, which are added in the order of the subtrees.
//! The cut belongs to the matrix, so the bits do not depend on the number of threads.

mod columns;
mod tree;

use rayon::prelude::*;

use crate::cholesky::SparseCholesky;
use crate::linear_solver::{LinearSolver, SparseVector};
use crate::panels::Panels;
use crate::permutation::invert;
use crate::symbolic::supernodes;

pub use columns::ForwardColumns;
pub use tree::MOST_SHARE;
use tree::{Piece, Tree};

/// A Cholesky factor whose halves are solved apart: see the module.
#[derive(Debug)]
pub struct TriangularFactor {
    tree: Tree,
    /// Place of each row, `[n]`: subtree by subtree, then the top.
    places: Vec<usize>,
}

impl TriangularFactor {
    /// Takes a factor; the analysis stays with whoever made it.
    pub fn new(factor: SparseCholesky) -> TriangularFactor {
        let (symbolic, values) = factor.into_parts();
        let n = symbolic.n();
        let supernodal = supernodes(&symbolic.shared.faer).expect("the analysis is supernodal");
        let (tree, new_places) = Tree::new(Panels::new(supernodal, values, n), n);
        let old = invert(symbolic.order(), n).expect("the analysis has a permutation");
        TriangularFactor {
            tree,
            places: old.into_iter().map(|place| new_places[place]).collect(),
        }
    }

    /// Bytes of the factor and its lists.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(&*self.places)
    }

    /// z = L^-1 b by places, `[n]`, of a load by rows, `[n]`.
    pub fn forward(&self, load: &[f64]) -> Vec<f64> {
        let mut z = vec![0.0; load.len()];
        for (&place, &value) in self.places.iter().zip(load) {
            z[place] = value;
        }
        self.forward_places(&mut z, 1);
        z
    }

    /// L^-T z by rows, `[n]`, of values by places, `[n]`.
    pub fn backward(&self, mut z: Vec<f64>) -> Vec<f64> {
        self.backward_places(&mut z, 1);
        self.places.iter().map(|&place| z[place]).collect()
    }

    /// L^-1 b of a load, and forward solutions of loads with few entries, at the same time.
    pub fn forward_with(&self, load: &[f64], loads: &[SparseVector]) -> (Vec<f64>, ForwardColumns) {
        rayon::join(|| self.forward(load), || self.columns(loads))
    }

    /// Forward solutions of loads with few entries.
    pub fn columns(&self, loads: &[SparseVector]) -> ForwardColumns {
        ForwardColumns::new(&self.tree, &self.places, loads)
    }

    /// `[L^-1 x]` of values by places, row-major `[n][n_rhs]`.
    fn forward_places(&self, x: &mut [f64], n_rhs: usize) {
        let (subtrees, top) = self.tree.split();
        let (below, own) = x.split_at_mut(n_rhs * top.places.start);
        let sweep = |(piece, x): (&Piece, &mut [f64])| {
            let mut local = Vec::with_capacity(x.len() + n_rhs * piece.boundary.len());
            local.extend_from_slice(x);
            local.resize(local.capacity(), 0.0);
            self.tree.panels.forward(piece.panels.clone(), &mut local, n_rhs);
            x.copy_from_slice(&local[..x.len()]);
            local.split_off(x.len())
        };
        let parts = slices(below, subtrees, n_rhs);
        let sums: Vec<Vec<f64>> = subtrees.par_iter().zip(parts).map(sweep).collect();
        for (piece, sums) in subtrees.iter().zip(&sums) {
            for (&row, sums) in piece.boundary.iter().zip(sums.chunks_exact(n_rhs)) {
                let x = &mut own[n_rhs * row..n_rhs * (row + 1)];
                x.iter_mut().zip(sums).for_each(|(x, s)| *x += s);
            }
        }
        self.tree.panels.forward(top.panels.clone(), own, n_rhs);
    }

    /// `[L^-T x]` of values by places, row-major `[n][n_rhs]`.
    fn backward_places(&self, x: &mut [f64], n_rhs: usize) {
        let (subtrees, top) = self.tree.split();
        let (below, own) = x.split_at_mut(n_rhs * top.places.start);
        self.tree.panels.backward(top.panels.clone(), own, n_rhs);
        let own = &*own;
        let sweep = |(piece, x): (&Piece, &mut [f64])| {
            let mut local = Vec::with_capacity(x.len() + n_rhs * piece.boundary.len());
            local.extend_from_slice(x);
            let above = piece.boundary.iter();
            local.extend(above.flat_map(|&row| &own[n_rhs * row..n_rhs * (row + 1)]));
            self.tree.panels.backward(piece.panels.clone(), &mut local, n_rhs);
            x.copy_from_slice(&local[..x.len()]);
        };
        let parts = slices(below, subtrees, n_rhs);
        subtrees.par_iter().zip(parts).for_each(sweep);
    }
}

/// The values of each subtree, mutable at the same time.
fn slices<'a>(mut x: &'a mut [f64], subtrees: &[Piece], n_rhs: usize) -> Vec<&'a mut [f64]> {
    let mut parts = Vec::with_capacity(subtrees.len());
    for piece in subtrees {
        let (part, rest) = x.split_at_mut(n_rhs * piece.places.len());
        parts.push(part);
        x = rest;
    }
    parts
}

impl LinearSolver for TriangularFactor {
    fn n(&self) -> usize {
        self.places.len()
    }

    fn solve(&self, rhs: &mut [f64], n_rhs: usize) {
        let n = self.n();
        assert_eq!(rhs.len(), n * n_rhs, "{n_rhs} right-hand sides of {n} rows");
        if rhs.is_empty() {
            return;
        }
        let mut x = vec![0.0; rhs.len()];
        for (row, &place) in self.places.iter().enumerate() {
            (0..n_rhs).for_each(|r| x[n_rhs * place + r] = rhs[n * r + row]);
        }
        self.forward_places(&mut x, n_rhs);
        self.backward_places(&mut x, n_rhs);
        for (row, &place) in self.places.iter().enumerate() {
            (0..n_rhs).for_each(|r| rhs[n * r + row] = x[n_rhs * place + r]);
        }
    }

    fn factor_bytes(&self) -> usize {
        self.bytes()
    }

    fn name(&self) -> &'static str {
        "sparse Cholesky, its halves apart"
    }
}
