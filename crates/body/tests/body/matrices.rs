//! Bodies of matrices, from those of a mesh.

use std::fmt::Write;
use std::path::Path;

use body::matrix::{MatrixBody, MatrixFiles, MatrixSeat};
use body::{BodySeat, Surrounding};
use mesh::Mesh;

use super::{basis, material, space};

/// A symmetric matrix as a Matrix Market file, in another unit.
fn matrix_market(matrix: &sprs::CsMat<f64>, unit: f64) -> String {
    let mut text = String::from("%%MatrixMarket matrix coordinate real symmetric\n% of a test\n");
    let lower: Vec<(usize, usize, f64)> = matrix
        .iter()
        .filter(|(_, (i, j))| j <= i)
        .map(|(v, (i, j))| (i + 1, j + 1, v / unit))
        .collect();
    writeln!(text, "{0} {0} {1}", matrix.rows(), lower.len()).unwrap();
    for (i, j, v) in lower {
        writeln!(text, "{i} {j} {v:e}").unwrap();
    }
    text
}

/// Files of a body from the matrices of a mesh, in mm, N/mm and t.
pub fn write_matrix(dir: &Path, mesh: &Mesh, fixed: &str) -> MatrixFiles {
    let text = matrix_market(&fem::assemble_stiffness(mesh, &material(0.3)).unwrap(), 1e3);
    let mass = matrix_market(&fem::assemble_mass(mesh, &material(0.3)).unwrap(), 1e3);
    let mut nodes = String::from("node,x,y,z\n");
    for (i, x) in mesh.nodes.iter().enumerate() {
        writeln!(
            nodes,
            "{},{:e},{:e},{:e}",
            i + 101,
            1e3 * x[0],
            1e3 * x[1],
            1e3 * x[2]
        )
        .unwrap();
    }
    let areas = fem::facet_node_weights(mesh, mesh.group("seat_a"));
    let seat: String = areas
        .iter()
        .map(|(n, a)| format!("{},{:e}\n", n + 101, 1e6 * a))
        .collect();
    let held: String = mesh
        .group_nodes(fixed)
        .iter()
        .map(|n| format!("{}\n", n + 101))
        .collect();
    for (name, text) in [
        ("K.mtx", text),
        ("M.mtx", mass),
        ("nodes.csv", nodes),
        ("seat.csv", seat),
        ("fixed.csv", held),
    ] {
        std::fs::write(dir.join(name), text).unwrap();
    }
    MatrixFiles {
        stiffness: dir.join("K.mtx"),
        mass: Some((dir.join("M.mtx"), 1e3)),
        nodes: dir.join("nodes.csv"),
        seats: vec![MatrixSeat::Nodes(dir.join("seat.csv"))],
        fixed_nodes: Some(dir.join("fixed.csv")),
        length_unit: 1e-3,
        stiffness_unit: 1e3,
    }
}

pub fn of_matrix(files: &MatrixFiles) -> Result<Surrounding, String> {
    condensed(&MatrixBody::read(files).map_err(|e| e.to_string())?)
}

pub fn condensed(matrix: &MatrixBody) -> Result<Surrounding, String> {
    let seat = BodySeat {
        name: "seat".into(),
        space: space(basis(3, 1)),
        middle: None,
        is_turned: false,
    };
    Surrounding::of_matrix("other", matrix, &[seat]).map_err(|e| e.to_string())
}

/// File of the nodes of the first seat.
pub fn seat_file(files: &MatrixFiles) -> &Path {
    match &files.seats[0] {
        MatrixSeat::Nodes(path) => path,
        seat => panic!("{seat:?}"),
    }
}
