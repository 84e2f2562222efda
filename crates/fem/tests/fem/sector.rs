//! One sector in cylindrical components.

use fem::{SectorMatrices, assemble_sector, inertia};
use mesh::{ElementKind, Mesh, PERIODIC_TOLERANCE, Periodicity, find_periodicity};

use crate::support::{grids, steel};

/// Rings of all kinds with `n` sectors.
fn rings(n: usize) -> Vec<(Mesh, Periodicity)> {
    ElementKind::ALL
        .into_iter()
        .map(|kind| {
            let mut mesh = grids::ring(kind, [2, n, 2], [0.02, 0.03], 0.01, std::f64::consts::TAU);
            // Two of the groups are the planes at which the grid was closed.
            mesh.groups.clear();
            let periodicity = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
            assert_eq!(periodicity.n_sectors(), n, "{kind:?}");
            (mesh, periodicity)
        })
        .collect()
}

/// Forces of each section node, `[n_section_nodes][3]`, when every sector has the cylindrical displacements `u`.
fn forces(
    blocks: &[[f64; 9]],
    sector: &SectorMatrices,
    u: impl Fn(usize) -> [f64; 3],
    n: usize,
) -> Vec<[f64; 3]> {
    let mut forces = vec![[0.0; 3]; n];
    for (c, block) in sector.couplings.iter().zip(blocks) {
        let u = u(c.column);
        for i in 0..3 {
            forces[c.row][i] += (0..3).map(|j| block[3 * i + j] * u[j]).sum::<f64>();
        }
    }
    forces
}

/// Wrong: moving a ring along its axis, or turning it about it, would cost force; or the sector would weigh something
/// else than its share of the ring. All sectors move alike in these motions, so one sector's blocks must give them.
#[test]
fn a_sector_resists_no_motion_along_or_about_the_axis_and_has_its_share_of_mass() {
    for n in [7, 12] {
        for (mesh, periodicity) in rings(n) {
            let sector = assemble_sector(&mesh, &periodicity, &steel()).unwrap();
            let width = periodicity.n_section_nodes();
            let radius = |j: usize| {
                let x = mesh.nodes[periodicity.nodes()[j]];
                x[0].hypot(x[1])
            };
            let stiffest = sector
                .stiffness
                .iter()
                .flatten()
                .fold(0.0_f64, |m, k| m.max(k.abs()));
            let axial = forces(&sector.stiffness, &sector, |_| [0.0, 0.0, 1.0], width);
            let turn = forces(
                &sector.stiffness,
                &sector,
                |j| [0.0, radius(j) / 0.03, 0.0],
                width,
            );
            for f in axial.iter().chain(&turn).flatten() {
                // Rounding of sums of some hundred entries.
                assert!(
                    f.abs() < 1e-13 * stiffest,
                    "{:?}: {f:e} of {stiffest:e}",
                    mesh.kind
                );
            }
            let momentum = forces(&sector.mass, &sector, |_| [0.0, 0.0, 1.0], width);
            let mass = n as f64 * momentum.iter().map(|p| p[2]).sum::<f64>();
            let expected = inertia(&mesh, &steel()).unwrap();
            assert!(
                (mass / expected.mass - 1.0).abs() < 1e-13,
                "{mass} {}",
                expected.mass
            );
            // Angular momentum about the axis per unit of spin.
            let spin = forces(&sector.mass, &sector, |j| [0.0, radius(j), 0.0], width);
            let about_axis = n as f64 * (0..width).map(|j| radius(j) * spin[j][1]).sum::<f64>();
            let ratio = about_axis / expected.tensor[2][2];
            assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
        }
    }
}

/// Wrong: the sector's blocks would not make a symmetric matrix, which the solver refuses.
#[test]
fn opposite_couplings_are_exact_transposes() {
    for n in [3, 4, 16] {
        for (mesh, periodicity) in rings(n) {
            let sector = assemble_sector(&mesh, &periodicity, &steel()).unwrap();
            for blocks in [&sector.stiffness, &sector.mass] {
                for (c, block) in sector.couplings.iter().zip(blocks) {
                    let place = sector
                        .couplings
                        .iter()
                        .position(|o| (o.row, o.column, o.shift) == (c.column, c.row, -c.shift))
                        .unwrap();
                    for ij in 0..9 {
                        assert_eq!(block[ij], blocks[place][3 * (ij % 3) + ij / 3]);
                    }
                }
            }
        }
    }
}
