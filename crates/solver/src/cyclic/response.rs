//! Responses of chosen section nodes to unit loads at the same nodes of one sector; by rotation, to loads anywhere.
//!
//! G_d, d = 0..N, is the displacement of the chosen nodes of sector d under unit forces (radial, azimuthal, axial) on
//! those of sector 0. The compliance between two patches of nodal weights w and v is then
//! `sum over p, q of w_p^T G_{s_p - s_q} v_q`: small products in place of solves.
//!
//! Cost: 3 n solves in harmonic space, of that part of the factor which begins with the first chosen node, and 9 n^2
//! inverse FFTs for n chosen nodes. Memory: 9 N n^2 numbers, 5 MB for 10 nodes and 720 sectors.

use fft::num_complex::Complex;
use pulp::Arch;
use rayon::prelude::*;

use super::factor::CyclicCholesky;
use super::patch::{BEYOND, Compliance, PatchWeights};
use super::phases::LANES;
use super::ring::CyclicRing;
use super::sweep::Sweeps;
use super::transform::{Spectrum, restore_line};

/// Unit loads solved for at a time.
const COLUMNS: usize = 6;

/// Table of the responses G_d.
#[derive(Clone, Debug)]
pub struct ResponseTable {
    ring: CyclicRing,
    /// Index among the chosen nodes of the node at each place, `usize::MAX` for others.
    chosen: Vec<usize>,
    /// Three per chosen node.
    n_dofs: usize,
    /// `[n_sectors][n_dofs][n_dofs]` and [`BEYOND`] zeros: sector, displacement, force; m/N.
    responses: Vec<f64>,
}

/// Nodes, and Cartesian weights of two directions at each.
pub type PairWeights<'a> = (&'a [usize], &'a [[[f64; 3]; 2]]);

/// A Cartesian unit vector at a chosen node.
pub(super) struct UnitVector {
    pub(super) sector: usize,
    pub(super) chosen: usize,
    /// Along (radial, azimuthal, axial).
    pub(super) weights: [f64; 3],
}

impl ResponseTable {
    /// Solves for unit loads at the section nodes `section_nodes`, distinct.
    ///
    /// # Panics
    /// When a section node does not exist or comes twice.
    pub fn new(factor: &CyclicCholesky, section_nodes: &[usize]) -> ResponseTable {
        let ring = factor.ring().clone();
        let mut chosen = vec![usize::MAX; ring.n_section_nodes()];
        for (i, &node) in section_nodes.iter().enumerate() {
            let place = &mut chosen[ring.shared.place[node]];
            assert_eq!(*place, usize::MAX, "section node {node} is chosen twice");
            *place = i;
        }
        let n_dofs = 3 * section_nodes.len();
        let places: Vec<usize> = section_nodes.iter().map(|&n| ring.shared.place[n]).collect();
        let spectra = spectra(factor, &places);
        let responses = transform(&ring, &places, &spectra);
        ResponseTable {
            ring,
            chosen,
            n_dofs,
            responses,
        }
    }

    /// A patch of pairs of directions, each on the caller's nodes with Cartesian weights, `[n][2][3]`. The error is the
    /// first node that is not chosen.
    ///
    /// # Panics
    /// Without a pair.
    pub fn patch(&self, pairs: &[PairWeights<'_>]) -> Result<PatchWeights, usize> {
        assert!(!pairs.is_empty(), "a patch has directions");
        let shared = &self.ring.shared;
        let width = self.ring.n_section_nodes();
        let mut sites = Vec::with_capacity(pairs.iter().map(|(nodes, _)| nodes.len()).sum());
        for (pair, (nodes, coefficients)) in pairs.iter().enumerate() {
            for (&node, weights) in nodes.iter().zip(*coefficients) {
                let site = *shared.sites.get(node).ok_or(node)?;
                let chosen = self.chosen[site % width];
                if chosen == usize::MAX {
                    return Err(node);
                }
                let [c, s] = shared.directions[site];
                let weights = weights.map(|[x, y, z]| [c * x + s * y, c * y - s * x, z]);
                sites.push(((site / width, 3 * chosen), pair, weights));
            }
        }
        sites.sort_unstable_by_key(|&(place, pair, _)| (place, pair));
        let mut patch = PatchWeights::new(pairs.len());
        for (place, pair, weights) in sites {
            patch.push(place, pair, weights);
        }
        Ok(patch)
    }

    /// Compliance between two patches of as many directions, m/N, row-major over directions: what a measures when b is
    /// loaded.
    ///
    /// # Panics
    /// When the patches differ in their number of directions, or have neither two nor four.
    pub fn compliance(&self, a: &PatchWeights, b: &PatchWeights) -> Vec<f64> {
        assert_eq!(a.n_directions(), b.n_directions(), "patches of equal directions");
        match a.n_directions() {
            2 => self.between_patches::<2>(a, b).concat(),
            4 => self.between_patches::<4>(a, b).concat(),
            n => panic!("a patch of {n} directions"),
        }
    }

    fn between_patches<const D: usize>(&self, a: &PatchWeights, b: &PatchWeights) -> [[f64; D]; D] {
        Arch::new().dispatch(Compliance::<D> {
            n_sectors: self.ring.n_sectors(),
            n_dofs: self.n_dofs,
            responses: &self.responses,
            a,
            b,
        })
    }

    /// Compliance of all patches, m/N, row-major over (patch, direction), exactly symmetric.
    ///
    /// # Panics
    /// As [`ResponseTable::compliance`].
    pub fn compliances(&self, patches: &[PatchWeights]) -> Vec<f64> {
        match patches.first().map_or(2, PatchWeights::n_directions) {
            2 => self.of_all::<2>(patches),
            4 => self.of_all::<4>(patches),
            n => panic!("patches of {n} directions"),
        }
    }

    fn of_all<const D: usize>(&self, patches: &[PatchWeights]) -> Vec<f64> {
        let (n, m) = (patches.len(), D * patches.len());
        // Of evenly spaced patches in order, pairs that are equally far apart read the same responses: they come
        // together. What is measured follows what is loaded by at most half a turn, so that half of the table is read.
        let apart = |k: usize| -> Vec<[[f64; D]; D]> {
            let pairs = (0..pairs_apart(n, k)).map(|b| (&patches[(b + k) % n], &patches[b]));
            pairs.map(|(a, b)| self.between_patches(a, b)).collect()
        };
        let blocks: Vec<_> = (0..=n / 2).into_par_iter().map(apart).collect();
        let mut all = vec![0.0; m * m];
        // Half of it is computed, the other half mirrored: reciprocity.
        for (k, blocks) in blocks.iter().enumerate() {
            for (b, block) in blocks.iter().enumerate() {
                let a = (b + k) % n;
                for (p, q) in (0..D * D)
                    .map(|i| (i / D, i % D))
                    .filter(|(p, q)| k > 0 || q <= p)
                {
                    let (i, j) = (D * a + p, D * b + q);
                    (all[m * i + j], all[m * j + i]) = (block[p][q], block[p][q]);
                }
            }
        }
        all
    }

    /// Displacement of chosen node `a` of sector `sector` per force on chosen node `b` of sector 0, m/N, row-major
    /// `[3][3]` over (radial, azimuthal, axial); nodes count as in the list given to [`ResponseTable::new`].
    ///
    /// # Panics
    /// When there is no such sector or node.
    pub fn response(&self, sector: usize, a: usize, b: usize) -> [f64; 9] {
        assert!(sector < self.ring.n_sectors(), "sector {sector} of the ring");
        let entry = |ij: usize| {
            self.responses[(sector * self.n_dofs + 3 * a + ij / 3) * self.n_dofs + 3 * b + ij % 3]
        };
        std::array::from_fn(entry)
    }

    /// Displacement of row `row` per force on row `column`, m/N; rows of the caller's Cartesian vectors, of chosen
    /// nodes.
    ///
    /// # Panics
    /// When a node is not chosen.
    pub fn between(&self, row: usize, column: usize) -> f64 {
        let [to, from] = [row, column].map(|row| self.unit(row));
        let n = self.ring.n_sectors();
        let response = self.response((to.sector + n - from.sector) % n, to.chosen, from.chosen);
        let part = |i: usize| -> f64 { (0..3).map(|j| response[3 * i + j] * from.weights[j]).sum() };
        (0..3).map(|i| to.weights[i] * part(i)).sum()
    }

    /// The table of the first `n_chosen` section nodes that were chosen.
    ///
    /// # Panics
    /// When there are fewer.
    pub fn first(&self, n_chosen: usize) -> ResponseTable {
        let n_dofs = 3 * n_chosen;
        assert!(n_dofs <= self.n_dofs, "{n_chosen} section nodes of the table");
        let keep = |&i: &usize| if i < n_chosen { i } else { usize::MAX };
        let sectors = self.responses.chunks_exact((self.n_dofs * self.n_dofs).max(1));
        let rows = sectors.flat_map(|sector| sector.chunks_exact(self.n_dofs).take(n_dofs));
        let rows = rows.map(|row| &row[..n_dofs]);
        ResponseTable {
            chosen: self.chosen.iter().map(keep).collect(),
            n_dofs,
            responses: rows
                .chain([[0.0; BEYOND].as_slice()])
                .flatten()
                .copied()
                .collect(),
            ring: self.ring.clone(),
        }
    }

    /// Sectors of the ring.
    pub(super) fn n_sectors(&self) -> usize {
        self.ring.n_sectors()
    }

    /// Displacement of a dof of the table in sector `sector` per force on the dofs of sector 0, m/N.
    pub(super) fn row(&self, sector: usize, dof: usize) -> &[f64] {
        &self.responses[(sector * self.n_dofs + dof) * self.n_dofs..][..self.n_dofs]
    }

    /// A row as a direction at a chosen node.
    pub(super) fn unit(&self, row: usize) -> UnitVector {
        let (shared, width) = (&self.ring.shared, self.ring.n_section_nodes());
        let site = shared.sites[row / 3];
        let chosen = self.chosen[site % width];
        assert_ne!(chosen, usize::MAX, "node {} is not in the table", row / 3);
        let [c, s] = shared.directions[site];
        UnitVector {
            sector: site / width,
            chosen,
            weights: [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]][row % 3],
        }
    }

    /// Bytes of the table.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * self.responses.capacity()
    }
}

/// Number of pairs among n things in a circle of which the second is k places behind the first, each pair once.
fn pairs_apart(n: usize, k: usize) -> usize {
    if k > 0 && 2 * k == n { k } else { n }
}

/// Harmonic responses of the chosen dofs to each unit load of the real basis, `[force][displacement][n_harmonics]`.
fn spectra(factor: &CyclicCholesky, places: &[usize]) -> Vec<Spectrum> {
    let ring = factor.ring();
    let (n_harmonics, n_dofs) = (ring.shared.phases.n_harmonics(), 3 * places.len());
    let (len, group_len, own) = (ring.harmonic_len(), ring.group_len(), ring.own_groups());
    let own_harmonics = own.start * LANES..n_harmonics.min(own.end * LANES);
    let index = |k: usize, dof: usize| {
        (k / LANES - own.start) * group_len + 2 * LANES * (3 * places[dof / 3] + dof % 3) + k % LANES
    };
    // Only what follows the first of them in the order is needed.
    let first_place = places.iter().copied().min().unwrap_or(0);
    let mut spectra = Vec::with_capacity(n_dofs * n_dofs * n_harmonics);
    let mut columns = vec![vec![0.0; len]; COLUMNS.min(n_dofs)];
    for first in (0..n_dofs).step_by(COLUMNS) {
        let forces = first..(first + COLUMNS).min(n_dofs);
        let used = &mut columns[..forces.len()];
        for (column, force) in used.iter_mut().zip(forces) {
            column.fill(0.0);
            own_harmonics.clone().for_each(|k| column[index(k, force)] = 1.0);
        }
        let mut used_columns: Vec<&mut [f64]> = used.iter_mut().map(Vec::as_mut_slice).collect();
        factor.sweep_harmonic(&mut used_columns, |_| Sweeps::Trailing(first_place));
        for column in used.iter() {
            let all = ring.at_places(places, column);
            for dof in 0..n_dofs {
                let at = (dof / 3, places[dof / 3]);
                spectra.extend((0..n_harmonics).map(|k| all.harmonic(k, at, dof % 3)));
            }
        }
    }
    spectra
}

/// Inverse transforms of the spectra, with the phases of the nodes' azimuths and of the azimuthal components,
/// `[n_sectors][displacement][force]`, then [`BEYOND`] zeros.
fn transform(ring: &CyclicRing, places: &[usize], spectra: &[Spectrum]) -> Vec<f64> {
    let shared = &ring.shared;
    let (n, n_harmonics, n_dofs) = (ring.n_sectors(), shared.phases.n_harmonics(), 3 * places.len());
    let mut lines = vec![0.0; n * n_dofs * n_dofs];
    lines
        .par_chunks_mut((n * n_dofs).max(1))
        .zip(spectra.par_chunks((n_harmonics * n_dofs).max(1)))
        .enumerate()
        .for_each(|(force, (lines, spectra))| {
            let mut spectrum = shared.inverse.make_input_vec();
            let mut scratch = shared.inverse.make_scratch_vec();
            let lines = lines.chunks_exact_mut(n).zip(spectra.chunks_exact(n_harmonics));
            for (dof, (line, values)) in lines.enumerate() {
                let step = shared.halves[places[dof / 3]] - shared.halves[places[force / 3]];
                // i for an azimuthal displacement, 1/i for an azimuthal force.
                let turn = match (dof % 3 == 1, force % 3 == 1) {
                    (true, false) => Complex::new(0.0, 1.0),
                    (false, true) => Complex::new(0.0, -1.0),
                    _ => Complex::new(1.0, 0.0),
                };
                for (k, (place, value)) in spectrum.iter_mut().zip(values).enumerate() {
                    let [cos, sin] = shared.phases.of(k, step);
                    *place = value * turn * Complex::new(cos, sin) / n as f64;
                }
                restore_line(&shared.inverse, &mut spectrum, line, &mut scratch);
            }
        });
    let mut responses = vec![0.0; lines.len() + BEYOND];
    responses[..lines.len()]
        .par_chunks_mut((n_dofs * n_dofs).max(1))
        .enumerate()
        .for_each(|(sector, table)| {
            for (place, value) in table.iter_mut().enumerate() {
                let (dof, force) = (place / n_dofs, place % n_dofs);
                *value = lines[(force * n_dofs + dof) * n + sector];
            }
        });
    responses
}
