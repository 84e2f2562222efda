//! Operators round the ring with more rows than a matrix: stress at the nodes.

use fem::{StressRecovery, rigid_modes};

use super::rings::{Ring, couplings, loads, rings, steel};
use crate::common::assert_close;

/// Stress of a displacement field by the weights of one sector, and element by element.
fn both(ring: &Ring, u: &[f64]) -> [Vec<[f64; 6]>; 2] {
    let recovery = StressRecovery::new(&ring.mesh, &steel()).unwrap();
    let sector = recovery.sector(&ring.mesh, &ring.periodicity);
    let couplings = couplings(&sector.couplings);
    let weights = sector.weights.as_flattened().as_flattened();
    let mut found = vec![[f64::NAN; 6]; ring.mesh.n_nodes()];
    ring.ring.stencil(6, &couplings, weights).tensors(u, &mut found);
    [found, recovery.nodal(u)]
}

/// Wrong: stress by the weights of one sector would not be that of the elements, for some kind of element, number of
/// sectors, or component; incompatible modes of hex8 included, which a rough field excites most.
#[test]
fn stress_by_the_sector_is_that_of_the_elements() {
    for (ring, _) in rings() {
        let u: Vec<f64> = loads(ring.mesh.n_dofs()).iter().map(|x| 1e-6 * x).collect();
        let [found, expected] = both(&ring, &u);
        assert_close(found.as_flattened(), expected.as_flattened(), 1e-13);
    }
}

/// Wrong: a ring that only turns and moves would be stressed, or a uniform strain would give another stress than
/// Hooke's: the weights would be those of another axis system.
#[test]
fn rigid_motions_and_uniform_strain_have_the_stress_of_the_textbook() {
    for (ring, _) in rings() {
        let stiff = steel().young_modulus / 0.025;
        for mode in rigid_modes(&ring.mesh, [0.0, 0.0, 0.01]) {
            let [found, _] = both(&ring, &mode);
            let largest = found.as_flattened().iter().fold(0.0f64, |m, s| m.max(s.abs()));
            // A motion of 1 m (or 1 rad at 0.03 m) that strained the ring would stress it by E/r.
            assert!(largest < 1e-10 * stiff, "{largest:e} Pa of {stiff:e}");
        }
        // Uniaxial strain and shear across the axes of the frame.
        let field = |x: &[f64; 3]| [1e-3 * x[0] + 2e-4 * x[1], 2e-4 * x[0], 0.0];
        let u: Vec<f64> = ring.mesh.nodes.iter().flat_map(field).collect();
        let [found, _] = both(&ring, &u);
        let (lambda, mu) = (steel().lame_lambda(), steel().shear_modulus());
        let expected = [
            1e-3 * (lambda + 2.0 * mu),
            1e-3 * lambda,
            1e-3 * lambda,
            4e-4 * mu,
            0.0,
            0.0,
        ];
        for stress in found {
            for c in 0..6 {
                let error = (stress[c] - expected[c]).abs();
                assert!(error < 1e-10 * expected[0], "{stress:?}, expected {expected:?}");
            }
        }
    }
}
