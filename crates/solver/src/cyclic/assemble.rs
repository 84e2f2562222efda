//! The matrices of a group of harmonics from the blocks of a sector, and products with them.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};

use super::matrix::CyclicMatrix;
use super::number::{Complex, Form};
use super::phases::LANES;
use super::ring::{OrderedCoupling, SharedRing};

/// Writes the lower triangle of a group's matrices, `A_k = sum of D^H C exp(i pi k q / N) D`, into the factor's blocks.
pub(super) struct Fill<'a, F: Form> {
    pub(super) shared: &'a SharedRing,
    pub(super) matrix: &'a CyclicMatrix,
    pub(super) group: usize,
    /// `[n_blocks][3][3][PARTS][LANES]`.
    pub(super) values: &'a mut [f64],
    pub(super) form: PhantomData<F>,
}

/// Overwrites one group's part of a vector with the product of its matrices and another one.
pub(super) struct Product<'a> {
    pub(super) shared: &'a SharedRing,
    pub(super) matrix: &'a CyclicMatrix,
    pub(super) group: usize,
    pub(super) x: &'a [f64],
    pub(super) y: &'a mut [f64],
}

/// Cosines and sines of all steps of a ring for a group, `[n_steps][2][LANES]`.
fn phases(shared: &SharedRing, group: usize) -> Vec<f64> {
    let steps = shared.steps.iter();
    steps
        .flat_map(|&q| shared.phases.lanes(group, q))
        .flatten()
        .collect()
}

impl<F: Form> WithSimd for Fill<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let phases = phases(self.shared, self.group);
        let phases = S::as_simd_f64s(&phases).0;
        let vectors = LANES / S::F64_LANES;
        let len = 9 * F::PARTS * vectors;
        self.values.fill(0.0);
        let values = S::as_mut_simd_f64s(self.values).0;
        for (link, &place) in self.shared.links.iter().zip(&self.shared.link_blocks) {
            if link.row < link.column {
                continue;
            }
            let there = &mut values[place * len..][..len];
            let block = &self.matrix.blocks[link.block];
            let step = &phases[2 * vectors * link.step..][..2 * vectors];
            for v in 0..vectors {
                let (cos, sin) = (step[v], step[vectors + v]);
                for ij in 0..9 {
                    let c = block[ij];
                    // conj(d_i) d_j (cos + i sin) of the diagonal matrix D.
                    let [(re, re_factor), (im, im_factor)] = match (ij / 3 == 1, ij % 3 == 1) {
                        (false, true) => [(sin, -c), (cos, c)],
                        (true, false) => [(sin, c), (cos, -c)],
                        _ => [(cos, c), (sin, c)],
                    };
                    let first = ij * F::PARTS * vectors + v;
                    there[first] = simd.mul_add_e_f64s(simd.splat_f64s(re_factor), re, there[first]);
                    if F::PARTS == 2 {
                        let second = first + vectors;
                        there[second] = simd.mul_add_e_f64s(simd.splat_f64s(im_factor), im, there[second]);
                    }
                }
            }
        }
    }
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let phases = phases(self.shared, self.group);
        let phases = S::as_simd_f64s(&phases).0;
        let vectors = LANES / S::F64_LANES;
        self.y.fill(0.0);
        let (x, y) = (S::as_simd_f64s(self.x).0, S::as_mut_simd_f64s(self.y).0);
        // Couplings of a row with one step share their phase.
        let mut links = self.shared.links.as_slice();
        while let Some(&OrderedCoupling { row, step, .. }) = links.first() {
            let n = links
                .iter()
                .take_while(|link| link.row == row && link.step == step)
                .count();
            let phase = &phases[2 * vectors * step..][..2 * vectors];
            for v in 0..vectors {
                let sums = add_blocks(simd, &self.matrix.blocks, &links[..n], x, v);
                let phase = Complex {
                    re: phase[v],
                    im: phase[vectors + v],
                };
                let node = &mut y[6 * vectors * row..][..6 * vectors];
                add_turned(simd, phase, sums, node, v);
            }
            links = &links[n..];
        }
    }
}

/// `sum of C D w` over couplings, D = diag(1, i, 1).
#[inline(always)]
fn add_blocks<S: Simd>(
    simd: S,
    blocks: &[[f64; 9]],
    links: &[OrderedCoupling],
    x: &[S::f64s],
    v: usize,
) -> [Complex<S>; 3] {
    let vectors = LANES / S::F64_LANES;
    let mut sums = [Complex::zero(simd); 3];
    for link in links {
        let node = &x[6 * vectors * link.column..][..6 * vectors];
        let at = |part: usize| node[part * vectors + v];
        for (row, sum) in blocks[link.block].chunks_exact(3).zip(&mut sums) {
            let [a, b, c] = [row[0], row[1], row[2]].map(|c| simd.splat_f64s(c));
            let re = simd.negate_mul_add_e_f64s(b, at(3), simd.mul_add_e_f64s(a, at(0), sum.re));
            let im = simd.mul_add_e_f64s(b, at(2), simd.mul_add_e_f64s(a, at(1), sum.im));
            sum.re = simd.mul_add_e_f64s(c, at(4), re);
            sum.im = simd.mul_add_e_f64s(c, at(5), im);
        }
    }
    sums
}

/// Adds `D^H phase sums` to a node.
#[inline(always)]
fn add_turned<S: Simd>(simd: S, phase: Complex<S>, sums: [Complex<S>; 3], node: &mut [S::f64s], v: usize) {
    let vectors = LANES / S::F64_LANES;
    for (i, sum) in sums.into_iter().enumerate() {
        let re = simd.mul_f64s(phase.re, sum.re);
        let re = simd.negate_mul_add_e_f64s(phase.im, sum.im, re);
        let im = simd.mul_f64s(phase.re, sum.im);
        let im = simd.mul_add_e_f64s(phase.im, sum.re, im);
        let (first, second) = (2 * i * vectors + v, (2 * i + 1) * vectors + v);
        // Division by i of the azimuthal component.
        if i == 1 {
            node[first] = simd.add_f64s(node[first], im);
            node[second] = simd.sub_f64s(node[second], re);
        } else {
            node[first] = simd.add_f64s(node[first], re);
            node[second] = simd.add_f64s(node[second], im);
        }
    }
}
