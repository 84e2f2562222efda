//! Stiffness and mass of one sector of a rotationally periodic ring, in cylindrical components: no global matrix.
//!
//! Every node has its own frame, radial, azimuthal and axial at its own azimuth: `u_cyl = Q u`,
//! `Q = [c s 0; -s c 0; 0 0 1]`. In these components the couplings between nodes are the same in every sector, so the
//! elements of one sector say all: an element between nodes (s_a, a) and (s_b, b), with s the sector and a, b the
//! section nodes, adds `Q_a K_ab Q_b^T` to the coupling of a with b at the shift s_b - s_a. The mass `m_ab I` becomes
//! `m_ab Q_a Q_b^T`.
//!
//! Cost: the elements of one sector; memory: two 3 x 3 blocks per coupling of one sector.

use std::collections::BTreeMap;

use mesh::{Mesh, Periodicity};

use crate::chunks::for_each_element;
use crate::element::MAX_NODES;
use crate::error::FemError;
use crate::geometry::check_connectivity;
use crate::mass::NodeMass;
use crate::material::Material;
use crate::stiffness::ElementStiffness;

/// Coupling of the section nodes `row` and `column`, the second `shift` sectors farther.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SectorCoupling {
    /// Section node whose forces the block gives.
    pub row: usize,
    /// Section node whose displacements it multiplies.
    pub column: usize,
    /// Sectors from the first node to the second, above -N/2 and at most N/2.
    pub shift: i32,
}

/// Stiffness and mass of one sector.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorMatrices {
    /// Couplings in both directions, ascending.
    pub couplings: Vec<SectorCoupling>,
    /// Stiffness of each coupling, N/m, `[n_couplings][3][3]` flat over (radial, azimuthal, axial); a block and the
    /// block of the opposite coupling are exactly each other's transposes.
    pub stiffness: Vec<[f64; 9]>,
    /// Mass of each coupling, kg, in the same layout.
    pub mass: Vec<[f64; 9]>,
}

/// Assembles one sector of the mesh that `periodicity` describes.
///
/// # Panics
/// If the periodicity is another mesh's.
pub fn assemble_sector(
    mesh: &Mesh,
    periodicity: &Periodicity,
    material: &Material,
) -> Result<SectorMatrices, FemError> {
    assert_eq!(
        periodicity.sites().len(),
        mesh.n_nodes(),
        "the periodicity belongs to another mesh"
    );
    check_connectivity(mesh)?;
    material.validate()?;
    let couplings = couplings(mesh, periodicity);
    let stiffness = add_elements(mesh, periodicity, &couplings, &stiffness_blocks(mesh, material))?;
    let mass = add_elements(mesh, periodicity, &couplings, &mass_blocks(mesh, material))?;
    Ok(SectorMatrices {
        couplings,
        stiffness,
        mass,
    })
}

/// Unit vectors (cos, sin) of the azimuths of all nodes, `[n_nodes][2]`: the frames of the cylindrical components.
pub fn azimuth_directions(mesh: &Mesh) -> Vec<[f64; 2]> {
    let direction = |x: &[f64; 3]| {
        let r = x[0].hypot(x[1]);
        [x[0] / r, x[1] / r]
    };
    mesh.nodes.iter().map(direction).collect()
}

/// Number of entries of one element's matrix of all degrees of freedom.
fn n_entries(mesh: &Mesh) -> usize {
    9 * mesh.kind.n_nodes().pow(2)
}

/// Computes `[3 n][3 n]` stiffness of an element.
fn stiffness_blocks<'a>(
    mesh: &'a Mesh,
    material: &Material,
) -> impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync + 'a {
    let kernel = ElementStiffness::new(mesh.kind, material);
    move |e, matrix| kernel.compute(mesh, e, matrix)
}

/// Computes `[3 n][3 n]` mass of an element.
fn mass_blocks<'a>(
    mesh: &'a Mesh,
    material: &Material,
) -> impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync + 'a {
    let kernel = NodeMass::new(mesh.kind, material);
    scalar_blocks(mesh, move |e, scalars| kernel.compute(mesh, e, scalars))
}

/// Computes `[3 n][3 n]` of an element, of what `compute` writes between its nodes times the identity.
pub(crate) fn scalar_blocks<'a>(
    mesh: &'a Mesh,
    compute: impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync + 'a,
) -> impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync + 'a {
    let n = mesh.kind.n_nodes();
    move |e, matrix| {
        let mut scalars = [0.0; MAX_NODES * MAX_NODES];
        compute(e, &mut scalars[..n * n])?;
        matrix.fill(0.0);
        for a in 0..n {
            for b in 0..n {
                (0..3).for_each(|i| matrix[(3 * a + i) * 3 * n + 3 * b + i] = scalars[a * n + b]);
            }
        }
        Ok(())
    }
}

/// Couplings of all pairs of nodes of the sector's elements.
pub(crate) fn couplings(mesh: &Mesh, periodicity: &Periodicity) -> Vec<SectorCoupling> {
    let mut couplings = Vec::new();
    for &e in periodicity.elements() {
        for &a in mesh.element(e) {
            couplings.extend(mesh.element(e).iter().map(|&b| coupling(periodicity, a, b)));
        }
    }
    couplings.sort_unstable();
    couplings.dedup();
    couplings
}

/// Coupling of two nodes of the mesh.
pub(crate) fn coupling(periodicity: &Periodicity, a: usize, b: usize) -> SectorCoupling {
    let [a, b] = [a, b].map(|node| periodicity.sites()[node]);
    let n = periodicity.n_sectors();
    let forward = (b.sector + n - a.sector) % n;
    let shift = if 2 * forward > n {
        forward as i32 - n as i32
    } else {
        forward as i32
    };
    SectorCoupling {
        row: a.section_node,
        column: b.section_node,
        shift,
    }
}

/// Sums the elements of a sector, each turned to cylindrical components.
pub(crate) fn add_elements(
    mesh: &Mesh,
    periodicity: &Periodicity,
    couplings: &[SectorCoupling],
    compute: &(impl Fn(usize, &mut [f64]) -> Result<(), FemError> + Sync),
) -> Result<Vec<[f64; 9]>, FemError> {
    let places: BTreeMap<SectorCoupling, usize> = couplings.iter().copied().zip(0..).collect();
    let elements = periodicity.elements();
    let directions = azimuth_directions(mesh);
    let n = mesh.kind.n_nodes();
    let mut blocks = vec![[0.0; 9]; couplings.len()];
    for_each_element(
        elements.len(),
        n_entries(mesh),
        |i, matrix| compute(elements[i], matrix),
        |i, matrix| {
            let nodes = mesh.element(elements[i]);
            for (a, &node_a) in nodes.iter().enumerate() {
                for (b, &node_b) in nodes.iter().enumerate().skip(a) {
                    let block = std::array::from_fn(|ij| matrix[(3 * a + ij / 3) * 3 * n + 3 * b + ij % 3]);
                    let turned = turn(directions[node_a], &block, directions[node_b]);
                    let there = &mut blocks[places[&coupling(periodicity, node_a, node_b)]];
                    (0..9).for_each(|ij| there[ij] += turned[ij]);
                    if a != b {
                        let back = &mut blocks[places[&coupling(periodicity, node_b, node_a)]];
                        (0..9).for_each(|ij| back[ij] += turned[3 * (ij % 3) + ij / 3]);
                    }
                }
            }
        },
    )?;
    Ok(symmetric(blocks, couplings, &places, periodicity.n_sectors()))
}

/// Makes opposite couplings exactly each other's transposes: their sums were rounded in different orders.
fn symmetric(
    blocks: Vec<[f64; 9]>,
    couplings: &[SectorCoupling],
    places: &BTreeMap<SectorCoupling, usize>,
    n_sectors: usize,
) -> Vec<[f64; 9]> {
    let mean = |(c, block): (&SectorCoupling, &[f64; 9])| {
        let is_half_turn = 2 * c.shift.unsigned_abs() as usize == n_sectors;
        let opposite = SectorCoupling {
            row: c.column,
            column: c.row,
            shift: if is_half_turn { c.shift } else { -c.shift },
        };
        let back = &blocks[places[&opposite]];
        std::array::from_fn(|ij| 0.5 * (block[ij] + back[3 * (ij % 3) + ij / 3]))
    };
    couplings.iter().zip(&blocks).map(mean).collect()
}

/// `Q_a B Q_b^T`.
fn turn([ca, sa]: [f64; 2], block: &[f64; 9], [cb, sb]: [f64; 2]) -> [f64; 9] {
    let mut rows = *block;
    for j in 0..3 {
        let (x, y) = (block[j], block[3 + j]);
        rows[j] = ca * x + sa * y;
        rows[3 + j] = ca * y - sa * x;
    }
    let mut turned = rows;
    for i in 0..3 {
        let (x, y) = (rows[3 * i], rows[3 * i + 1]);
        turned[3 * i] = cb * x + sb * y;
        turned[3 * i + 1] = cb * y - sb * x;
    }
    turned
}
