//! Products of block-circulant operators with nodal vectors, all sectors of a node at a time.
//!
//! An operator with R = 3 or 6 rows per node, such as a stiffness or the stress at the nodes, has the same R x 3
//! blocks in every sector: `(A u)_{s,a} = sum over couplings (a, b, d) of C_abd u_{s+d,b}`. With the values of a
//! node's component in all sectors next to each other, a *line*, the sum runs over whole vectors of the processor,
//! with one weight for all sectors.
//!
//! *Lines*: `[n_section_nodes][3 or R][stride]`, section nodes in elimination order, components (radial, azimuthal,
//! axial), then sectors. A line of displacements begins with the values of the last sectors and ends with those of
//! the first, as many as couplings reach, so that no sum wraps round.
//!
//! Cost: 3 R multiplications and additions per coupling and sector; the blocks of one sector stay in the cache.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::matrix::CyclicMatrix;
use super::pattern::Coupling;
use super::ring::{ABSENT, CyclicRing};
use crate::error::SolverError;

mod points;
pub use points::PointStencil;

/// Sectors of one pass with three rows: 9 sums and a displacement in three vectors of AVX2 fill its registers.
const WIDE: usize = 12;
/// Sectors of one pass with six rows.
const NARROW: usize = 8;
/// Room at the end of a line for the last pass of any kind.
const ROOM: usize = 12;
/// Section nodes of one task.
const TASK: usize = 4;

/// A block-circulant operator on nodal vectors of a ring; clones are deep.
#[derive(Clone, Debug)]
pub struct CyclicStencil {
    ring: CyclicRing,
    /// Rows per node, 3 or 6.
    rows: usize,
    /// First term of each place, and their number.
    starts: Vec<usize>,
    terms: Vec<Term>,
    /// `[n_terms][3][rows]`: for each component of the displacement what it gives to each row.
    weights: Vec<f64>,
}

/// A node that acts on another one.
#[derive(Clone, Copy, Debug)]
struct Term {
    /// Its place in the section.
    column: usize,
    /// Sectors to it.
    shift: i32,
}

impl CyclicRing {
    /// The operator with the given blocks, row-major `[n_couplings][rows][3]`, rows 3 or 6. No coupling may reach
    /// farther than those of the ring.
    ///
    /// # Panics
    /// When the lengths disagree, rows are neither 3 nor 6, or a coupling reaches too far.
    pub fn stencil(&self, rows: usize, couplings: &[Coupling], blocks: &[f64]) -> CyclicStencil {
        let places = (self.n_section_nodes(), |node: usize| self.shared.place[node]);
        self.stencil_of_rows(rows, places, couplings, blocks)
    }

    /// The same for rows that may belong to others than section nodes: their number, and the place of each.
    fn stencil_of_rows(
        &self,
        rows: usize,
        (n_places, place_of_row): (usize, impl Fn(usize) -> usize),
        couplings: &[Coupling],
        blocks: &[f64],
    ) -> CyclicStencil {
        assert!(rows == 3 || rows == 6, "an operator has 3 or 6 rows per node");
        assert_eq!(
            blocks.len(),
            3 * rows * couplings.len(),
            "{rows} x 3 numbers per coupling"
        );
        let reach = self.reach() as u32;
        let mut sorted: Vec<(usize, usize, i32, usize)> = couplings
            .iter()
            .enumerate()
            .map(|(i, c)| (place_of_row(c.row), self.shared.place[c.column], c.shift, i))
            .collect();
        sorted.sort_unstable();
        let mut starts = vec![0; n_places + 1];
        let mut stencil = CyclicStencil {
            ring: self.clone(),
            rows,
            starts: Vec::new(),
            terms: Vec::with_capacity(sorted.len()),
            weights: Vec::with_capacity(blocks.len()),
        };
        for (row, column, shift, i) in sorted {
            assert!(
                shift.unsigned_abs() <= reach,
                "a coupling reaches beyond the ring's"
            );
            starts[row + 1] += 1;
            stencil.terms.push(Term { column, shift });
            let block = &blocks[3 * rows * i..3 * rows * (i + 1)];
            stencil
                .weights
                .extend((0..3 * rows).map(|k| block[3 * (k % rows) + k / rows]));
        }
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        stencil.starts = starts;
        stencil
    }

    /// The operator of a matrix of this ring.
    pub fn operator(&self, matrix: &CyclicMatrix) -> Result<CyclicStencil, SolverError> {
        matrix.check_pattern(&self.shared.pattern)?;
        Ok(self.stencil(3, &self.shared.pattern.couplings, matrix.blocks.as_flattened()))
    }

    /// Length of a vector of displacements in lines.
    pub fn lines_len(&self) -> usize {
        3 * self.n_section_nodes() * self.stride()
    }

    /// Lines of the nodal vector `nodal` (Cartesian, `[n]`) into `lines`, `[lines_len()]`.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn to_lines(&self, nodal: &[f64], lines: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        assert_eq!(lines.len(), self.lines_len(), "a vector in lines");
        let (shared, width, stride, reach) =
            (&self.shared, self.n_section_nodes(), self.stride(), self.reach());
        let n = self.n_sectors();
        if lines.is_empty() {
            return;
        }
        lines
            .par_chunks_mut(3 * stride * TASK)
            .enumerate()
            .for_each(|(task, lines)| {
                for sector in 0..n {
                    for (i, node_lines) in lines.chunks_exact_mut(3 * stride).enumerate() {
                        let site = sector * width + TASK * task + i;
                        let [c, s] = shared.directions[site];
                        let [x, y, z] = self.at_site(nodal, site);
                        node_lines[reach + sector] = c * x + s * y;
                        node_lines[stride + reach + sector] = c * y - s * x;
                        node_lines[2 * stride + reach + sector] = z;
                    }
                }
                for line in lines.chunks_exact_mut(stride) {
                    for i in 0..reach {
                        line[i] = line[n + i];
                        line[reach + n + i] = line[reach + i];
                    }
                }
            });
    }

    /// Adds the nodal vector of `lines`, three per node, to `nodal` (Cartesian, `[n]`).
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn add_from_lines(&self, lines: &[f64], nodal: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        assert_eq!(lines.len(), self.lines_len(), "a vector in lines");
        self.for_each_node(lines, 3, nodal, |u, [r, t, z], [c, s]| {
            u[0] += c * r - s * t;
            u[1] += s * r + c * t;
            u[2] += z;
        });
    }

    /// Gives each node's numbers, `per_node` of them, its values in `lines` and its direction (cos, sin). The first
    /// three values are given for vectors; tensors ask for all with `R` = 6.
    fn for_each_node<const R: usize>(
        &self,
        lines: &[f64],
        per_node: usize,
        nodal: &mut [f64],
        put: impl Fn(&mut [f64], [f64; R], [f64; 2]) + Sync,
    ) {
        let (shared, width, stride) = (&self.shared, self.n_section_nodes(), self.stride());
        const NODES: usize = 2048;
        nodal
            .par_chunks_mut(per_node * NODES)
            .enumerate()
            .for_each(|(task, nodal)| {
                let sites = &shared.sites[NODES * task..];
                let there = nodal.chunks_exact_mut(per_node).zip(sites);
                for (u, &site) in there.filter(|(_, site)| **site != ABSENT) {
                    let (sector, place) = (site / width, site % width);
                    let first = R * place * stride + self.reach() + sector;
                    let values = std::array::from_fn(|i| lines[first + i * stride]);
                    put(u, values, shared.directions[site]);
                }
            });
    }

    /// Numbers of a line.
    fn stride(&self) -> usize {
        (self.n_sectors() + 2 * self.reach() + ROOM).next_multiple_of(4)
    }

    /// Sectors that couplings reach.
    fn reach(&self) -> usize {
        self.shared.reach
    }
}

impl CyclicStencil {
    /// The ring.
    pub fn ring(&self) -> &CyclicRing {
        &self.ring
    }

    /// Bytes of the blocks.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * self.weights.capacity() + size_of::<Term>() * self.terms.capacity()
    }

    /// Length of a product in lines.
    pub fn product_len(&self) -> usize {
        self.rows * (self.starts.len() - 1) * self.ring.stride()
    }

    /// Adds the product with `lines`, displacements in lines, to `product`, `[product_len()]`. What follows the last
    /// sector of a line of a product means nothing.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn add_product(&self, lines: &[f64], product: &mut [f64]) {
        assert_eq!(lines.len(), self.ring.lines_len(), "a vector in lines");
        assert_eq!(product.len(), self.product_len(), "a product in lines");
        let node_len = self.rows * self.ring.stride();
        let arch = Arch::new();
        product
            .par_chunks_mut(node_len.max(1))
            .with_min_len(TASK)
            .enumerate()
            .for_each(|(place, product)| {
                let node = Node {
                    stencil: self,
                    place,
                    lines,
                    product,
                };
                match self.rows {
                    3 => arch.dispatch(StencilRows::<3, WIDE>(node)),
                    _ => arch.dispatch(StencilRows::<6, NARROW>(node)),
                }
            });
    }

    /// The product with a nodal vector (Cartesian, `[n]`), three rows per node.
    ///
    /// # Panics
    /// When there are six rows, or the length is another.
    pub fn apply(&self, x: &[f64]) -> Vec<f64> {
        assert_eq!(self.rows, 3, "a vector has three components per node");
        let mut lines = vec![0.0; self.ring.lines_len()];
        self.ring.to_lines(x, &mut lines);
        let mut product = vec![0.0; self.product_len()];
        self.add_product(&lines, &mut product);
        let mut nodal = vec![0.0; x.len()];
        self.ring.add_from_lines(&product, &mut nodal);
        nodal
    }

    /// The scalar product `x . A x` of displacements in lines and their product: the sum over nodes, in a fixed order.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn lines_dot(&self, x: &[f64], product: &[f64]) -> f64 {
        assert_eq!(x.len(), product.len(), "two vectors in lines");
        let (stride, reach, n) = (self.ring.stride(), self.ring.reach(), self.ring.n_sectors());
        let lines = x.chunks_exact(stride).zip(product.chunks_exact(stride));
        lines
            .map(|(x, p)| fixed_dot(&x[reach..reach + n], &p[reach..reach + n]))
            .sum()
    }

    /// Tensors of the nodes in Cartesian components, order xx yy zz xy yz xz, from the operator's six rows in the
    /// order rr tt zz rt tz rz, for displacements `x` (Cartesian, `[n]`).
    ///
    /// # Panics
    /// When the operator has three rows, or the lengths are others.
    pub fn tensors(&self, x: &[f64], tensors: &mut [[f64; 6]]) {
        assert_eq!(self.rows, 6, "a tensor has six components");
        assert_eq!(3 * tensors.len(), self.ring.n(), "one tensor per node");
        let mut lines = vec![0.0; self.ring.lines_len()];
        self.ring.to_lines(x, &mut lines);
        let mut product = vec![0.0; self.product_len()];
        self.add_product(&lines, &mut product);
        let ring = &self.ring;
        ring.for_each_node(
            &product,
            6,
            tensors.as_flattened_mut(),
            |out, cylindrical, direction| {
                out.copy_from_slice(&turned(cylindrical, direction));
            },
        );
    }
}

/// Cartesian components of a tensor given along (radial, azimuthal, axial) at the direction (cos, sin).
fn turned([rr, tt, zz, rt, tz, rz]: [f64; 6], [c, s]: [f64; 2]) -> [f64; 6] {
    let twice = 2.0 * c * s * rt;
    [
        c * c * rr + s * s * tt - twice,
        s * s * rr + c * c * tt + twice,
        zz,
        c * s * (rr - tt) + (c * c - s * s) * rt,
        s * rz + c * tz,
        c * rz - s * tz,
    ]
}

/// A sum of products in four parts.
fn fixed_dot(a: &[f64], b: &[f64]) -> f64 {
    let (a4, a_rest) = a.as_chunks::<4>();
    let (b4, b_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a4.iter().zip(b4) {
        (0..4).for_each(|i| sums[i] += a[i] * b[i]);
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums[0] + sums[1] + (sums[2] + sums[3]) + rest
}

/// One node's part of a product.
struct Node<'a> {
    stencil: &'a CyclicStencil,
    place: usize,
    lines: &'a [f64],
    product: &'a mut [f64],
}

/// R rows, W sectors at a time.
struct StencilRows<'a, const R: usize, const W: usize>(Node<'a>);

impl<const R: usize, const W: usize> WithSimd for StencilRows<'_, R, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Node {
            stencil,
            place,
            lines,
            product,
        } = self.0;
        let ring = &stencil.ring;
        let (n, stride, reach) = (ring.n_sectors(), ring.stride(), ring.reach());
        let range = stencil.starts[place]..stencil.starts[place + 1];
        let terms = &stencil.terms[range.clone()];
        let weights = &stencil.weights[3 * R * range.start..3 * R * range.end];
        for first in (reach..reach + n).step_by(W) {
            // Vectors of any width up to W numbers; the unused ones of wider processors cost nothing.
            let mut sums = [[simd.splat_f64s(0.0); W]; R];
            let vectors = W / S::F64_LANES;
            for (term, weights) in terms.iter().zip(weights.chunks_exact(3 * R)) {
                let start = (first as i64 + i64::from(term.shift)) as usize;
                for j in 0..3 {
                    let line = &lines[(3 * term.column + j) * stride + start..][..W];
                    let u = &S::as_simd_f64s(line).0[..vectors];
                    for i in 0..R {
                        let weight = simd.splat_f64s(weights[R * j + i]);
                        for v in 0..vectors {
                            sums[i][v] = simd.mul_add_e_f64s(weight, u[v], sums[i][v]);
                        }
                    }
                }
            }
            for (i, row) in sums.iter().enumerate() {
                let line = &mut product[i * stride + first..][..W];
                let out = S::as_mut_simd_f64s(line).0;
                for v in 0..vectors {
                    out[v] = simd.add_f64s(out[v], row[v]);
                }
            }
        }
    }
}
