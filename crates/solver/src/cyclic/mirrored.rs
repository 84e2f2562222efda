//! Products with matrices whose section is its own mirror image: half the multiplications.
//!
//! The blocks at the steps q and -q are then each other's images, `C(-q) = S C(q) S`, S = diag(1, -1, 1), and with
//! the azimuthal component divided by i the harmonic k of the matrix is real:
//! ```text
//! A_k = sum over |q| of E_q cos(pi k |q| / N) + O_q sin(pi k |q| / N)
//! ```
//! E_q holds the entries of C(q) + C(-q) that are even under S (rr, rz, tt, zr, zz), O_q the odd ones of C(q) - C(-q)
//! with the signs of the division by i (-rt, tr, -zt, tz). Mass couples no axial component with another, so the
//! entries rz, zr, tz, zt may be left out. Cost: 14 entries per pair of section nodes in place of 27, of mass 8; what
//! two images differ by in rounding is left out, as the factor does.

use pulp::{Simd, WithSimd};

use super::matrix::CyclicMatrix;
use super::number::Complex;
use super::phases::LANES;
use super::ring::SharedRing;
use super::sloan::sloan_orders;

/// A matrix of mirrored sections, prepared for products.
#[derive(Clone, Debug)]
pub(super) struct Mirrored {
    runs: Vec<PairRun>,
    pairs: Vec<Pair>,
    /// Half sectors |q| of the runs, the different values.
    steps: Vec<i32>,
    coupling: ComponentCoupling,
}

/// The entries that a matrix has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ComponentCoupling {
    /// All.
    Full,
    /// The axial component is on its own.
    Plane,
}

/// Pairs of one row at one step.
#[derive(Clone, Copy, Debug)]
struct PairRun {
    /// Place of the row's node.
    row: usize,
    /// Index of the step.
    step: usize,
    /// Number of pairs.
    len: usize,
}

/// What one section node does to another.
#[derive(Clone, Copy, Debug)]
struct Pair {
    /// Place of the column's node.
    column: usize,
    /// rr, tt, zz, rz, zr of E.
    even: [f64; 5],
    /// rt, tr, zt, tz of O.
    odd: [f64; 4],
}

impl Mirrored {
    /// Prepares `matrix`, of mirrored sections and the couplings of the ring.
    pub(super) fn new(shared: &SharedRing, matrix: &CyclicMatrix) -> Mirrored {
        let mut links: Vec<(usize, i32, usize, [f64; 9])> = Vec::with_capacity(shared.links.len());
        for link in &shared.links {
            let step = shared.steps[link.step];
            let sign = f64::from(step.signum());
            let block = matrix.blocks[link.block];
            let signed = std::array::from_fn(|ij| match (ij / 3 == 1, ij % 3 == 1) {
                (false, true) => -sign * block[ij],
                (true, false) => sign * block[ij],
                _ => block[ij],
            });
            links.push((link.row, step.abs(), link.column, signed));
        }
        let rank = local_order(shared);
        links.sort_by_key(|&(row, step, column, _)| (rank[row], step, rank[column]));
        let mut steps: Vec<i32> = links.iter().map(|link| link.1).collect();
        steps.sort_unstable();
        steps.dedup();
        let (mut runs, mut pairs): (Vec<PairRun>, Vec<Pair>) = (Vec::new(), Vec::new());
        for same in links.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let before = pairs.len();
            let columns = same.chunk_by(|a, b| a.2 == b.2);
            pairs.extend(columns.map(|images| Pair::new(images[0].2, images.iter().map(|link| &link.3))));
            runs.push(PairRun {
                row: same[0].0,
                step: steps.partition_point(|&s| s < same[0].1),
                len: pairs.len() - before,
            });
        }
        let is_plane = |p: &Pair| p.even[3..] == [0.0; 2] && p.odd[2..] == [0.0; 2];
        Mirrored {
            coupling: if pairs.iter().all(is_plane) {
                ComponentCoupling::Plane
            } else {
                ComponentCoupling::Full
            },
            runs,
            pairs,
            steps,
        }
    }

    /// Bytes of the entries.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Pair>() * self.pairs.capacity() + size_of::<PairRun>() * self.runs.capacity()
    }
}

/// Rank of each place in an order that keeps neighbours together, for the cache: elimination may take nodes from
/// anywhere.
fn local_order(shared: &SharedRing) -> Vec<usize> {
    let neighbours = shared.pattern.neighbours();
    let order = sloan_orders(&neighbours).swap_remove(0);
    let mut rank = vec![0; order.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(k, &node)| rank[shared.place[node]] = k);
    rank
}

impl Pair {
    /// The sum of the blocks of two images, or of one that is its own.
    fn new<'a>(column: usize, images: impl Iterator<Item = &'a [f64; 9]>) -> Pair {
        let mut sum = [0.0; 9];
        for block in images {
            sum.iter_mut().zip(block).for_each(|(sum, c)| *sum += c);
        }
        Pair {
            column,
            even: [0, 4, 8, 2, 6].map(|ij| sum[ij]),
            odd: [1, 3, 7, 5].map(|ij| sum[ij]),
        }
    }
}

/// Overwrites one group's part of a vector with the product of its matrices and another one.
pub(super) struct MirroredProduct<'a> {
    pub(super) shared: &'a SharedRing,
    pub(super) matrix: &'a Mirrored,
    pub(super) group: usize,
    pub(super) x: &'a [f64],
    pub(super) y: &'a mut [f64],
}

impl WithSimd for MirroredProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let lanes = |&q: &i32| self.shared.phases.lanes(self.group, q);
        let phases: Vec<f64> = self.matrix.steps.iter().flat_map(lanes).flatten().collect();
        let phases = S::as_simd_f64s(&phases).0;
        let vectors = LANES / S::F64_LANES;
        self.y.fill(0.0);
        let (x, y) = (S::as_simd_f64s(self.x).0, S::as_mut_simd_f64s(self.y).0);
        let mut pairs = self.matrix.pairs.as_slice();
        for run in &self.matrix.runs {
            let (own, rest) = pairs.split_at(run.len);
            pairs = rest;
            let phase = &phases[2 * vectors * run.step..][..2 * vectors];
            let node = &mut y[6 * vectors * run.row..][..6 * vectors];
            for v in 0..vectors {
                let sums = match self.matrix.coupling {
                    ComponentCoupling::Full => sum_full(simd, own, x, v),
                    ComponentCoupling::Plane => sum_plane(simd, own, x, v),
                };
                add(simd, [phase[v], phase[vectors + v]], sums, node, v);
            }
        }
    }
}

/// The three components of a node.
#[inline(always)]
fn components<S: Simd>(x: &[S::f64s], place: usize, v: usize) -> [Complex<S>; 3] {
    let vectors = LANES / S::F64_LANES;
    let node = &x[6 * vectors * place..][..6 * vectors];
    [0, 1, 2].map(|c| Complex {
        re: node[2 * c * vectors + v],
        im: node[(2 * c + 1) * vectors + v],
    })
}

/// `sum + factor x`.
#[inline(always)]
fn plus<S: Simd>(simd: S, sum: Complex<S>, factor: f64, x: Complex<S>) -> Complex<S> {
    let factor = simd.splat_f64s(factor);
    Complex {
        re: simd.mul_add_e_f64s(factor, x.re, sum.re),
        im: simd.mul_add_e_f64s(factor, x.im, sum.im),
    }
}

/// The sums of E x and of O x over pairs.
#[inline(always)]
fn sum_full<S: Simd>(simd: S, pairs: &[Pair], x: &[S::f64s], v: usize) -> [[Complex<S>; 3]; 2] {
    let [mut er, mut et, mut ez, mut or, mut ot, mut oz] = [Complex::zero(simd); 6];
    for pair in pairs {
        let ([r, t, z], [rr, tt, zz, rz, zr]) = (components(x, pair.column, v), pair.even);
        let [rt, tr, zt, tz] = pair.odd;
        er = plus(simd, er, rr, r);
        et = plus(simd, et, tt, t);
        ez = plus(simd, ez, zz, z);
        or = plus(simd, or, rt, t);
        ot = plus(simd, ot, tr, r);
        oz = plus(simd, oz, zt, t);
        er = plus(simd, er, rz, z);
        ez = plus(simd, ez, zr, r);
        ot = plus(simd, ot, tz, z);
    }
    [[er, et, ez], [or, ot, oz]]
}

/// The same without the entries between the axial component and the others.
#[inline(always)]
fn sum_plane<S: Simd>(simd: S, pairs: &[Pair], x: &[S::f64s], v: usize) -> [[Complex<S>; 3]; 2] {
    let [mut er, mut et, mut ez, mut or, mut ot] = [Complex::zero(simd); 5];
    for pair in pairs {
        let ([r, t, z], [rr, tt, zz, ..]) = (components(x, pair.column, v), pair.even);
        let [rt, tr, ..] = pair.odd;
        er = plus(simd, er, rr, r);
        et = plus(simd, et, tt, t);
        ez = plus(simd, ez, zz, z);
        or = plus(simd, or, rt, t);
        ot = plus(simd, ot, tr, r);
    }
    [[er, et, ez], [or, ot, Complex::zero(simd)]]
}

/// Adds cos E x + sin O x to a node.
#[inline(always)]
fn add<S: Simd>(
    simd: S,
    [cos, sin]: [S::f64s; 2],
    [even, odd]: [[Complex<S>; 3]; 2],
    node: &mut [S::f64s],
    v: usize,
) {
    let vectors = LANES / S::F64_LANES;
    for (c, (e, o)) in even.into_iter().zip(odd).enumerate() {
        for (part, (e, o)) in [(e.re, o.re), (e.im, o.im)].into_iter().enumerate() {
            let place = &mut node[(2 * c + part) * vectors + v];
            *place = simd.mul_add_e_f64s(cos, e, simd.mul_add_e_f64s(sin, o, *place));
        }
    }
}
