//! The cyclic solver against the sparse one on assembled rings.

mod common;

use std::collections::BTreeMap;

use common::assert_close;
use fem::Material;
use mesh::{ElementKind, Mesh, PERIODIC_TOLERANCE, Periodicity, Section, find_periodicity, revolve};
use solver::{
    Bordered, Coupling, CyclicCholesky, CyclicMatrix, CyclicRing, DenseCholesky, LinearSolver, ResponseTable,
    SolverError, SparseCholesky, Symbolic, Symmetry, angular_dissection, expand, restrict_lower,
    restrict_order,
};
use sprs::CsMat;

/// Shift by the mass, 1/s^2: that of a step of 1e-5 s.
const SHIFT: f64 = 4e10;

/// A lopsided section of 4 x 5 nodes, its inner side named `bore`.
fn section() -> Section {
    let (n_r, n_z) = (3, 4);
    let mut points = Vec::new();
    for j in 0..=n_z {
        for i in 0..=n_r {
            let (x, y) = (i as f64 / n_r as f64, j as f64 / n_z as f64);
            points.push([0.025 + 0.006 * x + 0.001 * x * y, 0.016 * y + 0.0015 * x * x]);
        }
    }
    let at = |i: usize, j: usize| j * (n_r + 1) + i;
    let quads = (0..n_z)
        .flat_map(|j| (0..n_r).map(move |i| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let bore = (0..n_z).map(|j| [at(0, j), at(0, j + 1)]).collect();
    Section::new(
        points,
        quads.collect(),
        &BTreeMap::from([("bore".to_string(), bore)]),
    )
    .unwrap()
}

/// A ring whose planes are turned against each other along the axis: periodic without mirror symmetry.
fn twisted(mut mesh: Mesh) -> Mesh {
    for [x, y, z] in &mut mesh.nodes {
        let (s, c) = (20.0 * *z).sin_cos();
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
    mesh
}

/// A ring in both forms.
struct Ring {
    mesh: Mesh,
    periodicity: Periodicity,
    stiffness: CyclicMatrix,
    mass: CyclicMatrix,
    ring: CyclicRing,
}

impl Ring {
    fn new(mesh: Mesh) -> Ring {
        let periodicity = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
        let half_way = periodicity.half_way().map(<[bool]>::to_vec);
        Ring::with_offsets(mesh, periodicity, half_way.as_deref())
    }

    fn with_offsets(mesh: Mesh, periodicity: Periodicity, half_way: Option<&[bool]>) -> Ring {
        let sector = fem::assemble_sector(&mesh, &periodicity, &steel()).unwrap();
        let couplings: Vec<Coupling> = sector
            .couplings
            .iter()
            .map(|c| Coupling {
                row: c.row,
                column: c.column,
                shift: c.shift,
            })
            .collect();
        let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
        let stiffness = CyclicMatrix::new(n, width, &couplings, &sector.stiffness).unwrap();
        let mass = stiffness.with_blocks(&couplings, &sector.mass).unwrap();
        let directions = fem::azimuth_directions(&mesh);
        let ring = CyclicRing::new(&stiffness, periodicity.nodes(), &directions, half_way).unwrap();
        Ring {
            mesh,
            periodicity,
            stiffness,
            mass,
            ring,
        }
    }

    fn shifted(&self) -> CyclicMatrix {
        self.stiffness.combined(1.0, SHIFT, &self.mass).unwrap()
    }

    /// The same matrix assembled over all elements.
    fn assembled(&self, shift: f64) -> CsMat<f64> {
        let mut matrix = fem::assemble_stiffness(&self.mesh, &steel()).unwrap();
        let mass = fem::assemble_mass(&self.mesh, &steel()).unwrap();
        matrix
            .data_mut()
            .iter_mut()
            .zip(mass.data())
            .for_each(|(k, m)| *k += shift * m);
        matrix
    }

    /// Sparse factor of the rows `free` of an assembled matrix.
    fn sparse(&self, matrix: &CsMat<f64>, free: &[usize]) -> SparseCholesky {
        let mesh = &self.mesh;
        let nodes = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
        let lower = restrict_lower(matrix, free);
        let symbolic = Symbolic::new(&lower, &restrict_order(&expand(&nodes, 3), free)).unwrap();
        symbolic.factor(&lower).unwrap()
    }
}

fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).unwrap()
}

/// Numbers between -1 and 1 by a fixed rule.
fn loads(n: usize) -> Vec<f64> {
    (0..n as u64)
        .map(|i| {
            let mixed = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            ((mixed ^ (mixed >> 31)) % 20_001) as f64 / 1e4 - 1.0
        })
        .collect()
}

/// Solutions of both solvers for three right-hand sides must agree.
#[track_caller]
fn assert_agree(cyclic: &CyclicCholesky, sparse: &SparseCholesky, tolerance: f64) {
    let (n, n_rhs) = (sparse.n(), 3);
    assert_eq!(cyclic.n(), n);
    let mut found = loads(n * n_rhs);
    let mut expected = found.clone();
    cyclic.solve(&mut found, n_rhs);
    sparse.solve(&mut expected, n_rhs);
    for (found, expected) in found.chunks(n).zip(expected.chunks(n)) {
        assert_close(found, expected, tolerance);
    }
}

/// All rings tested: even, odd and prime numbers of sectors, both hexahedra, with and without mirror symmetry.
fn rings() -> Vec<(Ring, Symmetry)> {
    let mut rings = Vec::new();
    for (kind, n) in [
        (ElementKind::Hex8, 24),
        (ElementKind::Hex8, 15),
        (ElementKind::Hex8, 37),
        (ElementKind::Hex20, 12),
        (ElementKind::Hex20, 13),
    ] {
        let mesh = revolve(&section(), n, kind, &[]).unwrap();
        rings.push((Ring::new(mesh.clone()), Symmetry::Mirrored));
        rings.push((Ring::new(twisted(mesh)), Symmetry::None));
    }
    rings
}

/// Wrong: a step of a free ring would move it otherwise than the assembled matrix does.
#[test]
fn a_free_ring_with_mass_is_solved_as_by_the_sparse_factor() {
    for (ring, symmetry) in rings() {
        let free: Vec<usize> = (0..ring.mesh.n_dofs()).collect();
        let cyclic = ring.ring.factor(&ring.shifted()).unwrap();
        assert_eq!(cyclic.symmetry(), symmetry);
        let sparse = ring.sparse(&ring.assembled(SHIFT), &free);
        assert_agree(&cyclic, &sparse, 1e-12);
    }
}

/// Wrong: the statics of a ring clamped at its bore would differ from that of the assembled matrix.
#[test]
fn a_clamped_ring_is_solved_as_by_the_sparse_factor() {
    for (ring, symmetry) in rings() {
        let held = ring.mesh.group_nodes("bore");
        let held_section = ring.periodicity.section_nodes(&held).unwrap();
        let keep: Vec<usize> = (0..ring.periodicity.n_section_nodes())
            .filter(|node| held_section.binary_search(node).is_err())
            .collect();
        let free: Vec<usize> = (0..ring.mesh.n_dofs())
            .filter(|dof| held.binary_search(&(dof / 3)).is_err())
            .collect();
        let matrix = ring.stiffness.restricted(&keep);
        let cyclic = ring
            .ring
            .restricted(&matrix, &keep)
            .unwrap()
            .factor(&matrix)
            .unwrap();
        assert_eq!(cyclic.symmetry(), symmetry);
        assert_agree(&cyclic, &ring.sparse(&ring.assembled(0.0), &free), 1e-12);
    }
}

/// Wrong: the real form of mirrored sections would be another matrix than the Hermitian form, which needs no symmetry.
#[test]
fn the_real_and_the_hermitian_form_agree() {
    for n in [24, 15] {
        let mesh = revolve(&section(), n, ElementKind::Hex20, &[]).unwrap();
        let real = Ring::new(mesh.clone());
        let periodicity = real.periodicity.clone();
        let hermitian = Ring::with_offsets(mesh, periodicity, None);
        let factors = [&real, &hermitian].map(|ring| ring.ring.factor(&ring.shifted()).unwrap());
        assert_eq!(factors[0].symmetry(), Symmetry::Mirrored);
        assert_eq!(factors[1].symmetry(), Symmetry::None);
        assert_eq!(2 * factors[0].factor_bytes(), factors[1].factor_bytes());
        let mut solutions = [(); 2].map(|()| loads(real.mesh.n_dofs()));
        factors
            .iter()
            .zip(&mut solutions)
            .for_each(|(f, x)| f.solve(x, 1));
        assert_close(&solutions[0], &solutions[1], 1e-12);
    }
}

/// Wrong: products through the sectors, in nodal and in harmonic space, would not be those of the assembled matrix; or
/// energies summed in harmonic space would not be those of the nodal vectors.
#[test]
fn products_through_the_sector_are_those_of_the_assembled_matrix() {
    for (ring, _) in rings() {
        let n = ring.mesh.n_dofs();
        let x = loads(n);
        let matrix = ring.assembled(SHIFT);
        let expected = common::product(&matrix, &x);
        let shifted = ring.shifted();
        assert_close(&ring.ring.apply(&shifted, &x).unwrap(), &expected, 1e-13);

        let mut w = vec![0.0; ring.ring.harmonic_len()];
        let mut product = w.clone();
        ring.ring.to_harmonic(&x, &mut w);
        ring.ring.apply_harmonic(&shifted, &w, &mut product).unwrap();
        let mut nodal = vec![0.0; n];
        ring.ring.from_harmonic(&product, &mut nodal);
        assert_close(&nodal, &expected, 1e-13);

        let energy: f64 = x.iter().zip(&expected).map(|(x, f)| x * f).sum();
        let harmonic = ring.ring.harmonic_dot(&w, &product);
        assert_close(&[harmonic], &[energy], 1e-12);
    }
}

/// Wrong: a field would change on its way to harmonic space and back, for some number of sectors.
#[test]
fn a_field_survives_the_way_to_harmonic_space_and_back() {
    for n in [3, 4, 7, 16, 97] {
        let ring = Ring::new(revolve(&section(), n, ElementKind::Hex20, &[]).unwrap());
        let x = loads(ring.mesh.n_dofs());
        let (mut w, mut back) = (vec![0.0; ring.ring.harmonic_len()], vec![0.0; x.len()]);
        ring.ring.to_harmonic(&x, &mut w);
        ring.ring.from_harmonic(&w, &mut back);
        assert_close(&back, &x, 1e-14);
    }
}

/// Wrong: the same scene would give other bits on another number of threads.
#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let ring = Ring::new(revolve(&section(), 90, ElementKind::Hex8, &[]).unwrap());
    let matrix = ring.shifted();
    let results: Vec<Vec<f64>> = [1, 2, 4]
        .into_iter()
        .map(|n_threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n_threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut x = loads(5 * ring.mesh.n_dofs());
                ring.ring.factor(&matrix).unwrap().solve(&mut x, 5);
                x.extend(ring.ring.apply(&matrix, &x[..ring.mesh.n_dofs()]).unwrap());
                x
            })
        })
        .collect();
    assert!(results[1..].iter().all(|other| *other == results[0]));
}

/// Wrong: a free ring without mass, which can move as a whole, would get a solution that is nothing but round-off.
#[test]
fn a_ring_free_to_move_is_refused() {
    for n in [24, 15] {
        let ring = Ring::new(revolve(&section(), n, ElementKind::Hex8, &[]).unwrap());
        let error = ring.ring.factor(&ring.stiffness).unwrap_err();
        let is_refused = matches!(
            error,
            SolverError::NotPositiveDefinite { .. } | SolverError::Singular { .. }
        );
        assert!(is_refused, "{error}");
        assert!(error.row().unwrap() < ring.mesh.n_dofs());
    }
}

/// Wrong: blocks that make no symmetric matrix would be taken, and half of them ignored.
#[test]
fn couplings_that_make_no_symmetric_matrix_are_refused() {
    let own = Coupling {
        row: 0,
        column: 0,
        shift: 0,
    };
    let next = Coupling { shift: 1, ..own };
    let back = Coupling { shift: -1, ..own };
    let (unit, mut skew) = ([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [0.0; 9]);
    let refused = |couplings: &[Coupling], blocks: &[[f64; 9]]| {
        CyclicMatrix::new(5, 1, couplings, blocks)
            .unwrap_err()
            .to_string()
    };
    let text = refused(&[own, next], &[unit, skew]);
    assert!(text.starts_with(
        "the coupling of section node 0 with section node 0, 1 sectors farther, has no opposite"
    ));
    assert!(refused(&[next, back], &[unit, unit]).contains("is missing"));
    assert!(refused(&[own, own], &[unit, unit]).contains("is given twice"));
    assert!(refused(&[own, Coupling { row: 1, ..own }], &[unit, unit]).contains("does not exist"));
    skew[1] = 0.5;
    assert!(refused(&[own, next, back], &[unit, skew, skew]).contains("expected transposed blocks"));
    skew[1] = f64::NAN;
    assert!(refused(&[own], &[skew]).contains("expected finite numbers"));
}

/// Takes the resultant force and moment out of nodal loads: subtracts the combination of rigid motions they work on.
fn balance(mesh: &Mesh, loads: &mut [f64]) {
    let modes = fem::rigid_modes(mesh, [0.0; 3]);
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram: Vec<f64> = modes
        .iter()
        .flat_map(|a| modes.iter().map(|b| dot(a, b)))
        .collect();
    let factor = DenseCholesky::factor(modes.len(), &gram).unwrap();
    // Twice: once leaves the rounding of the first.
    for _ in 0..2 {
        let mut parts: Vec<f64> = modes.iter().map(|mode| dot(mode, loads)).collect();
        factor.solve(&mut parts, 1);
        for (part, mode) in parts.iter().zip(&modes) {
            loads.iter_mut().zip(mode).for_each(|(f, m)| *f -= part * m);
        }
    }
}

/// Wrong: a ring held in its mean motion would feel the springs that hold it, and its oval shape would be off.
#[test]
fn a_ring_that_nothing_holds_deforms_freely_under_balanced_loads() {
    for (ring, symmetry) in rings() {
        let mut balanced = loads(ring.mesh.n_dofs());
        balance(&ring.mesh, &mut balanced);
        let factor = ring.ring.factor_unheld(&ring.stiffness).unwrap();
        assert_eq!(factor.symmetry(), symmetry);
        let mut found = balanced.clone();
        factor.solve(&mut found, 1);
        let product = ring.ring.apply(&ring.stiffness, &found).unwrap();
        let stiffest = ring
            .assembled(0.0)
            .data()
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let residual: Vec<f64> = product.iter().zip(&balanced).map(|(p, f)| p - f).collect();
        // Backward error: rounding of some hundred operations.
        let error = largest(&residual) / (stiffest * largest(&found) + 1.0);
        assert!(error < 1e-14, "{error:e}");

        // Six dofs fixed instead: the same but for a rigid motion, taken out in both.
        let free: Vec<usize> = (0..ring.mesh.n_dofs())
            .filter(|dof| !supports(&ring).contains(dof))
            .collect();
        let sparse = ring.sparse(&ring.assembled(0.0), &free);
        let mut part: Vec<f64> = free.iter().map(|&dof| balanced[dof]).collect();
        sparse.solve(&mut part, 1);
        let mut expected = vec![0.0; found.len()];
        free.iter().zip(part).for_each(|(&dof, x)| expected[dof] = x);
        balance(&ring.mesh, &mut expected);
        balance(&ring.mesh, &mut found);
        // Rigid motions of the sparse solution are some thousand times the deformation.
        assert_close(&found, &expected, 1e-8);
    }
}

/// Six dofs that hold a body: a node in three directions, a second in two, a third in one.
fn supports(ring: &Ring) -> [usize; 6] {
    let (nodes, width) = (ring.periodicity.nodes(), ring.periodicity.n_section_nodes());
    let quarter = ring.periodicity.n_sectors() / 4;
    let [a, b, c] = [nodes[0], nodes[quarter * width], nodes[2 * quarter * width]];
    [3 * a, 3 * a + 1, 3 * a + 2, 3 * b + 2, 3 * c + 1, 3 * c + 2]
}

/// Wrong: a bore that follows the shaft would not move as it does in the matrix with the shaft's rows assembled.
#[test]
fn a_bore_that_follows_five_rigid_dofs_is_a_border() {
    for (ring, _) in rings() {
        let bore = ring.mesh.group_nodes("bore");
        let held = ring.periodicity.section_nodes(&bore).unwrap();
        let keep: Vec<usize> = (0..ring.periodicity.n_section_nodes())
            .filter(|node| !held.contains(node))
            .collect();
        let (n_dofs, shifted) = (ring.mesh.n_dofs(), ring.shifted());
        let free: Vec<usize> = (0..n_dofs).filter(|dof| !bore.contains(&(dof / 3))).collect();
        // Rigid motions of the bore: translations and the two tilts.
        let modes: Vec<Vec<f64>> = [0, 1, 2, 3, 4]
            .iter()
            .map(|&i| {
                let mut mode = fem::rigid_modes(&ring.mesh, [0.0; 3])[i].clone();
                free.iter().for_each(|&dof| mode[dof] = 0.0);
                mode
            })
            .collect();
        let forces: Vec<Vec<f64>> = modes
            .iter()
            .map(|mode| ring.ring.apply(&shifted, mode).unwrap())
            .collect();
        let border: Vec<f64> = forces
            .iter()
            .flat_map(|f| free.iter().map(|&dof| f[dof]))
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let corner: Vec<f64> = modes
            .iter()
            .flat_map(|m| forces.iter().map(|f| dot(m, f)))
            .collect();
        let matrix = shifted.restricted(&keep);
        let factor = ring
            .ring
            .restricted(&matrix, &keep)
            .unwrap()
            .factor(&matrix)
            .unwrap();
        let bordered = Bordered::new(factor, &border, 5, &corner).unwrap();

        // T^T A T w with w = T [x; q] must be the load, whatever way A is applied.
        let n = bordered.n();
        assert_eq!(n, free.len() + 5);
        let rhs = loads(2 * n);
        let mut found = rhs.clone();
        bordered.solve(&mut found, 2);
        let assembled = ring.assembled(SHIFT);
        for (found, rhs) in found.chunks(n).zip(rhs.chunks(n)) {
            let mut w = vec![0.0; n_dofs];
            free.iter().zip(found).for_each(|(&dof, x)| w[dof] = *x);
            for (q, mode) in found[free.len()..].iter().zip(&modes) {
                w.iter_mut().zip(mode).for_each(|(w, m)| *w += q * m);
            }
            let f = common::product(&assembled, &w);
            let mut reduced: Vec<f64> = free.iter().map(|&dof| f[dof]).collect();
            reduced.extend(modes.iter().map(|mode| dot(mode, &f)));
            assert_close(&reduced, rhs, 1e-10);
        }
    }
}

/// Wrong: compliances of patches from the table would not be those that solves for the same loads give.
#[test]
fn the_table_gives_the_compliances_of_solves() {
    for (ring, _) in rings() {
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let chosen = [4, 1, 7, 11];
        let table = ResponseTable::new(&factor, &chosen);
        let (n, width) = (ring.periodicity.n_sectors(), ring.periodicity.n_section_nodes());
        assert_eq!(table.bytes(), 8 * n * 12 * 12);
        let node = |sector: usize, i: usize| ring.periodicity.nodes()[(sector % n) * width + chosen[i]];
        let values = loads(200);
        let patches: Vec<(Vec<usize>, Vec<[[f64; 3]; 2]>)> = [0, 1, n / 2, n - 1]
            .iter()
            .enumerate()
            .map(|(p, &sector)| {
                let nodes: Vec<usize> = (0..5).map(|i| node(sector + i / 2, (p + i) % 4)).collect();
                let value = |i: usize| values[(40 * p + i) % 200];
                let weights = (0..5)
                    .map(|i| {
                        [
                            [0, 1, 2].map(|c| value(6 * i + c)),
                            [3, 4, 5].map(|c| value(6 * i + c)),
                        ]
                    })
                    .collect();
                (nodes, weights)
            })
            .collect();
        let in_table: Vec<_> = patches.iter().map(|(n, w)| table.patch(n, w).unwrap()).collect();
        let m = 2 * patches.len();
        let mut expected = vec![0.0; m * m];
        for j in 0..m {
            let mut u = vec![0.0; ring.mesh.n_dofs()];
            let (nodes, weights) = &patches[j / 2];
            for (&node, w) in nodes.iter().zip(weights) {
                (0..3).for_each(|c| u[3 * node + c] += w[j % 2][c]);
            }
            factor.solve(&mut u, 1);
            for i in 0..m {
                let (nodes, weights) = &patches[i / 2];
                let measured = nodes
                    .iter()
                    .zip(weights)
                    .map(|(&node, w)| (0..3).map(|c| w[i % 2][c] * u[3 * node + c]).sum::<f64>());
                expected[m * i + j] = measured.sum();
            }
        }
        assert_close(&table.compliances(&in_table), &expected, 1e-12);
        let other = (0..ring.mesh.n_nodes())
            .find(|&node| !chosen.contains(&ring.periodicity.sites()[node].section_node))
            .unwrap();
        assert_eq!(table.patch(&[other], &[[[0.0; 3]; 2]]), Err(other));
    }
}

/// Wrong: a new step size would be solved with the factor of the old one, or with other bits than a fresh factor.
#[test]
fn a_factor_made_in_the_memory_of_another_has_the_same_bits() {
    for (ring, _) in rings() {
        let other = ring.stiffness.combined(0.5, 9.0 * SHIFT, &ring.mass).unwrap();
        let fresh = ring.ring.factor(&ring.shifted()).unwrap();
        let again = ring
            .ring
            .factor(&other)
            .unwrap()
            .refactored(&ring.shifted())
            .unwrap();
        let mut solutions = [(); 2].map(|()| loads(ring.mesh.n_dofs()));
        fresh.solve(&mut solutions[0], 1);
        again.solve(&mut solutions[1], 1);
        assert_eq!(solutions[0], solutions[1]);
    }
}
