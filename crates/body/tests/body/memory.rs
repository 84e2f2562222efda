//! Parts of the forecast of memory against what they stand for.

use mesh::ElementKind;

use super::{basis, made, material, tube};

const NUMBER: usize = size_of::<f64>();

/// Wrong: a job in a housing, or on an elastic shaft, would ask for too little memory. Stiffness, columns of the seats,
/// fields of the oscillators and blocks of vectors are counted as they are stored.
#[test]
fn what_a_body_takes_is_counted_as_it_is_stored() {
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    let (list, n_nodes) = (NUMBER * mesh.connectivity.len(), mesh.n_nodes());
    let held = mesh.group_nodes("outside").len();
    let stiffness = fem::assemble_stiffness(&mesh, &material(0.3)).unwrap();
    let k = stiffness.nnz() * (NUMBER + size_of::<usize>());
    let body = made(mesh, material(0.3), "outside", basis(3, 1)).unwrap();
    assert_eq!(body.kept_bytes() - body.bytes, 24 * n_nodes + list);
    let at_rest = body.making_bytes(None, 2);
    assert_eq!([at_rest.at_rest, at_rest.modes, at_rest.frame], [5 * k / 2, 0, 0]);
    let (free, all) = (3 * (n_nodes - held) * NUMBER, 3 * n_nodes * NUMBER);
    let standing = body.modes(150e3).unwrap();
    let [few, many] = [100, 101].map(|threads| body.making_bytes(Some(&standing), threads));
    // Two blocks of 32 vectors a thread: the shapes, and what the mass makes of them.
    assert_eq!(many.modes - few.modes, 64 * free);
    let columns = body.n_functions() * free;
    let own = columns + k + k / 3;
    assert!(
        few.modes > own + 6400 * free && few.modes < own + 6400 * free + 2 * k + 200 * standing.n().pow(2)
    );
    assert_eq!((few.frame, few.most()), (0, few.modes));
    let on_shaft = body.on_shaft(&[0.0]).unwrap();
    let moving = on_shaft.modes(150e3).unwrap();
    let [few, many] = [100, 101].map(|threads| on_shaft.making_bytes(Some(&moving), threads));
    assert_eq!(many.frame - few.frame, 64 * all);
    assert!(few.frame > columns + moving.n() * all + 6400 * all);
    // The reduced body has an oscillator for each function and mode, and the rigid ones.
    assert_eq!(moving.n(), on_shaft.n_functions() + moving.n_fixed + 5);
}
