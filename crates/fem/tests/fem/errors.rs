//! What the user reads when a mesh or a material is wrong.

use fem::{FemError, Material, Pattern, StressRecovery, assemble_mass, assemble_stiffness};
use mesh::ElementKind;

use crate::support::grids::wavy_cube;
use crate::support::steel;

/// Otherwise an absurd material would give absurd results without a word.
#[test]
fn a_material_outside_its_physical_range_is_refused_with_the_range() {
    let message = |e, nu, rho| Material::new(e, nu, rho).unwrap_err().to_string();
    assert_eq!(
        message(-1.0, 0.3, 7800.0),
        "young's modulus is -1, expected a positive number of pascals; check the material's units"
    );
    assert!(
        message(207e9, 0.5, 7800.0)
            .contains("poisson's ratio is 0.5, expected a number above -1 and below 0.5")
    );
    assert!(message(207e9, 0.3, f64::NAN).contains("density is NaN"));
    assert!(message(f64::INFINITY, 0.3, 7800.0).contains("young's modulus is inf"));
}

/// Otherwise an inverted element would make K indefinite and the solver's message would blame the wrong thing.
#[test]
fn an_inverted_element_is_named_with_its_place() {
    for kind in ElementKind::ALL {
        let mut mesh = wavy_cube(kind, 2);
        let n = kind.n_nodes();
        // Mirror element 3: exchange bottom and top, or the ends of one edge of the tetrahedron.
        let pairs: &[[usize; 2]] = match kind {
            ElementKind::Tet10 => &[[0, 1], [5, 6], [7, 8]],
            ElementKind::Hex8 => &[[0, 4], [1, 5], [2, 6], [3, 7]],
            ElementKind::Hex20 => &[
                [0, 4],
                [1, 5],
                [2, 6],
                [3, 7],
                [8, 12],
                [9, 13],
                [10, 14],
                [11, 15],
            ],
        };
        pairs
            .iter()
            .for_each(|&[a, b]| mesh.connectivity[3 * n..].swap(a, b));
        let errors = [
            assemble_stiffness(&mesh, &steel()).map(drop).unwrap_err(),
            assemble_mass(&mesh, &steel()).map(drop).unwrap_err(),
            StressRecovery::new(&mesh, &steel()).map(drop).unwrap_err(),
            fem::volume(&mesh).unwrap_err(),
            fem::check_elements(&mesh).unwrap_err(),
        ];
        for error in errors {
            assert!(
                matches!(error, FemError::NonPositiveJacobian { element: 3, .. }),
                "{error}"
            );
            assert!(
                error
                    .to_string()
                    .starts_with(&format!("element 3 ({}) is inverted", kind.name()))
            );
        }
        assert!(fem::check_elements(&wavy_cube(kind, 2)).is_ok());
    }
}

/// Otherwise a broken mesh would panic somewhere inside.
#[test]
fn a_broken_connectivity_is_refused() {
    let whole = wavy_cube(ElementKind::Hex8, 2);
    let mut mesh = whole.clone();
    mesh.connectivity[17] = 99;
    let error = Pattern::new(&mesh).unwrap_err();
    assert_eq!(
        error.to_string(),
        "element 2 names node 99, expected a node below 27; check the mesh's node numbers"
    );
    let mut mesh = whole.clone();
    mesh.connectivity.pop();
    assert_eq!(
        fem::volume(&mesh).unwrap_err().to_string(),
        "the mesh lists 63 element nodes, expected a multiple of 8 (hex8); the mesh is cut short or mixes element kinds"
    );
    mesh.connectivity.clear();
    assert!(
        fem::volume(&mesh)
            .unwrap_err()
            .to_string()
            .starts_with("the mesh has no elements")
    );
}
