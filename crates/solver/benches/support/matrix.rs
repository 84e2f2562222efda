//! S = K + c M of a ring, c that of a step of 1e-5 s: as one sparse matrix, and from the blocks of one sector.

#![allow(dead_code)]

use fem::{Material, SectorCoupling, SectorMatrices};
use mesh::{Mesh, Periodicity};
use solver::{Coupling, CyclicMatrix};
use sprs::CsMat;

use crate::ring::SHIFT;

/// Bearing steel.
pub fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).expect("steel")
}

/// S of a mesh or a part of one, both triangles.
pub fn sparse(mesh: &Mesh) -> CsMat<f64> {
    let mut matrix = fem::assemble_stiffness(mesh, &steel()).expect("a valid mesh");
    let mass = fem::assemble_mass(mesh, &steel()).expect("a valid mesh");
    let pairs = matrix.data_mut().iter_mut().zip(mass.data());
    pairs.for_each(|(k, m)| *k += SHIFT * m);
    matrix
}

/// Couplings of a sector as the solver has them.
pub fn couplings(couplings: &[SectorCoupling]) -> Vec<Coupling> {
    let coupling = |c: &SectorCoupling| Coupling {
        row: c.row,
        column: c.column,
        shift: c.shift,
    };
    couplings.iter().map(coupling).collect()
}

/// S, K and M of a ring by its sector.
pub fn cyclic(periodicity: &Periodicity, sector: &SectorMatrices) -> [CyclicMatrix; 3] {
    let couplings = couplings(&sector.couplings);
    let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
    let stiffness = CyclicMatrix::new(n, width, &couplings, &sector.stiffness).expect("symmetric");
    let mass = stiffness
        .with_blocks(&couplings, &sector.mass)
        .expect("symmetric");
    let effective = stiffness.combined(1.0, SHIFT, &mass).expect("one pattern");
    [effective, stiffness, mass]
}
