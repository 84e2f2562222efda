//! Seats that move with a node of six dofs.

use std::fmt::Write;
use std::path::Path;

use body::matrix::{MatrixBody, MatrixFiles, MatrixSeat};
use body::{BodySeat, SeatBasis, SeatSpace, Surrounding};

use super::{INNER, WIDTH, made, material, space, tube};
use mesh::ElementKind;

/// Number of the node.
const NODE: u64 = 4711;
/// Springs of it, N/m and N m/rad.
const SPRINGS: [f64; 6] = [2e8, 3e8, 5e8, 4e4, 7e4, 9e4];
/// Its inertia, kg and kg m^2.
const INERTIA: [f64; 6] = [1.5, 1.5, 1.5, 2e-3, 3e-3, 4e-3];

/// A symmetric matrix in N/mm, or in t, with rotations in rad, as a file.
fn write_matrix(path: &Path, matrix: &[[f64; 6]; 6]) {
    let mut text = String::from("%%MatrixMarket matrix coordinate real symmetric\n6 6 21\n");
    for i in 0..6 {
        for j in 0..=i {
            // A row of a rotation has lengths in mm.
            let unit = [i, j].map(|row| if row < 3 { 1.0 } else { 1e3 });
            writeln!(
                text,
                "{} {} {:e}",
                i + 1,
                j + 1,
                matrix[i][j] * unit[0] * unit[1] / 1e3
            )
            .unwrap();
        }
    }
    std::fs::write(path, text).unwrap();
}

fn diagonal(values: [f64; 6]) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { values[i] } else { 0.0 }))
}

/// Files of a body of one node at a place, m.
fn files(dir: &Path, stiffness: &[[f64; 6]; 6], [x, y, z]: [f64; 3]) -> MatrixFiles {
    write_matrix(&dir.join("K.mtx"), stiffness);
    write_matrix(&dir.join("M.mtx"), &diagonal(INERTIA));
    let [x, y, z] = [x, y, z].map(|c| 1e3 * c);
    std::fs::write(
        dir.join("nodes.csv"),
        format!("node,x,y,z,dofs\n{NODE},{x:e},{y:e},{z:e},6\n"),
    )
    .unwrap();
    MatrixFiles {
        stiffness: dir.join("K.mtx"),
        mass: Some((dir.join("M.mtx"), 1e3)),
        nodes: dir.join("nodes.csv"),
        seats: vec![MatrixSeat::Reference(NODE)],
        fixed_nodes: None,
        length_unit: 1e-3,
        stiffness_unit: 1e3,
    }
}

fn seat(middle: Option<f64>, is_turned: bool) -> BodySeat {
    BodySeat {
        name: format!("node {NODE}"),
        space: space(SeatBasis::Rigid),
        middle,
        is_turned,
    }
}

fn made_of(files: &MatrixFiles, seat: BodySeat) -> Result<Surrounding, String> {
    let matrix = MatrixBody::read(files).map_err(|e| e.to_string())?;
    Surrounding::of_matrix("springs", &matrix, &[seat]).map_err(|e| e.to_string())
}

/// T K^-1 T^T with the motion T of a place at an arm along z from the node, K the springs.
fn flexibility(arm: f64) -> [[f64; 6]; 6] {
    let mut t = diagonal([1.0; 6]);
    (t[0][4], t[1][3]) = (arm, -arm);
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| t[i][k] * t[j][k] / SPRINGS[k]).sum()))
}

fn assert_flexibility(body: &Surrounding, expected: &[[f64; 6]; 6]) {
    for i in 0..6 {
        for j in 0..6 {
            let size = (expected[i][i] * expected[j][j]).sqrt();
            let off = (body.flexibility[6 * i + j] - expected[i][j]) / size;
            assert!(off.abs() < 1e-12, "{i} {j}: {off:e}");
        }
    }
}

/// Wrong: a seat on springs would yield otherwise than the springs do: in other units, with a lever of the wrong sign,
/// or on its head. Closed form: the springs in series with a rigid lever from the node to the middle of the seat.
#[test]
fn a_seat_on_a_node_yields_as_the_springs_there() {
    let dir = tempfile::tempdir().unwrap();
    let files = files(dir.path(), &diagonal(SPRINGS), [0.0, 0.0, 2e-3]);
    assert_flexibility(&made_of(&files, seat(None, false)).unwrap(), &flexibility(0.0));
    assert_flexibility(
        &made_of(&files, seat(Some(7e-3), false)).unwrap(),
        &flexibility(5e-3),
    );
    // Turned by 180 deg about x, the node stands at -2 mm of the ring and its seat at 4 mm: y and z of the ring are the
    // others of the springs, whose diagonal does not tell them apart.
    assert_flexibility(
        &made_of(&files, seat(Some(4e-3), true)).unwrap(),
        &flexibility(6e-3),
    );
}

/// Wrong: a body that other programs condense to its seat would be another than its mesh. The stiffness of one node is
/// the inverse of the flexibility of a tube in the six mean motions of its bore, which an RBE3 has.
#[test]
fn a_body_condensed_to_a_node_is_that_of_its_mesh() {
    let of_mesh = made(
        tube(ElementKind::Hex8, 24, [2, 2]),
        material(0.3),
        "outside",
        SeatBasis::Rigid,
    )
    .unwrap();
    // Rotations in radii make a matrix of one size.
    let scale = |i: usize| if i < 3 { 1.0 } else { INNER };
    let scaled: Vec<f64> = (0..36)
        .map(|k| of_mesh.flexibility[k] * scale(k / 6) * scale(k % 6))
        .collect();
    let inverse = dense::DenseCholesky::factor(6, &scaled).unwrap().inverse();
    let stiffness =
        std::array::from_fn(|i| std::array::from_fn(|j| inverse[6 * i + j] * scale(i) * scale(j)));
    let dir = tempfile::tempdir().unwrap();
    let body = made_of(&files(dir.path(), &stiffness, [0.0; 3]), seat(None, false)).unwrap();
    for i in 0..6 {
        for j in 0..6 {
            let size = (of_mesh.flexibility[7 * i] * of_mesh.flexibility[7 * j]).sqrt();
            let off = (body.flexibility[6 * i + j] - of_mesh.flexibility[6 * i + j]) / size;
            assert!(off.abs() < 1e-10, "{i} {j}: {off:e}");
        }
    }
}

/// Wrong: a body of one node would vibrate otherwise than a mass on its springs, omega^2 = k / m.
#[test]
fn a_body_of_one_node_vibrates_as_its_mass_on_its_springs() {
    let dir = tempfile::tempdir().unwrap();
    let body = made_of(
        &files(dir.path(), &diagonal(SPRINGS), [0.0; 3]),
        seat(None, false),
    )
    .unwrap();
    let modes = body.modes(20e3).unwrap();
    assert_eq!(modes.n_fixed, 0);
    let mut expected: Vec<f64> = SPRINGS.iter().zip(INERTIA).map(|(k, m)| k / m).collect();
    expected.sort_unstable_by(f64::total_cmp);
    assert_eq!(modes.squares.len(), 6);
    for (found, expected) in modes.squares.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }
}

/// Wrong: a stiffness of nodes with rotations that a rigid motion strains would pass, or a sound one be refused. A
/// lever of two nodes, 30 mm apart along z, joined by springs, and held at one of them.
#[test]
fn rotations_take_part_in_rigid_motions() {
    let dir = tempfile::tempdir().unwrap();
    let mut files = files(dir.path(), &diagonal(SPRINGS), [0.0; 3]);
    files.mass = None;
    std::fs::write(&files.nodes, format!("{NODE},0,0,0,6\n9,0,0,-30,6\n")).unwrap();
    // Springs between the motion of node 9 and what the rigid lever makes of that of the first: theta x (0, 0, -l).
    let l: f64 = 30.0;
    let lever = |motion: usize| -> [f64; 12] {
        let mut row = [0.0; 12];
        (row[motion], row[6 + motion]) = (-1.0, 1.0);
        match motion {
            0 => row[4] = l,
            1 => row[3] = -l,
            _ => (),
        }
        row
    };
    let springs = [2e5, 3e5, 5e5, 4e7, 7e7, 9e7];
    let write = |bent: f64| {
        let mut text = String::from("%%MatrixMarket matrix coordinate real general\n12 12 144\n");
        for i in 0..12 {
            for j in 0..12 {
                let of = |k: usize| springs[k] * lever(k)[i] * lever(k)[j];
                let more = if i == 4 && j == 4 { bent } else { 0.0 };
                writeln!(
                    text,
                    "{} {} {:e}",
                    i + 1,
                    j + 1,
                    (0..6).map(of).sum::<f64>() + more
                )
                .unwrap();
            }
        }
        std::fs::write(&files.stiffness, text).unwrap();
    };
    let held = dir.path().join("fixed.csv");
    std::fs::write(&held, "9\n").unwrap();
    let files = MatrixFiles {
        fixed_nodes: Some(held),
        ..files.clone()
    };
    write(0.0);
    let body = made_of(&files, seat(None, false)).unwrap();
    // The lever is that of a seat beside its node: springs at node 9, 30 mm below.
    let k = [0, 1, 2, 3, 4, 5].map(|i| {
        if i < 3 {
            1e3 * springs[i]
        } else {
            1e-3 * springs[i]
        }
    });
    let expected = 1.0 / k[0] + 9e-4 / k[4];
    assert!(
        (body.flexibility[0] / expected - 1.0).abs() < 1e-10,
        "{} {expected}",
        body.flexibility[0]
    );
    assert!((body.flexibility[28] * k[4] - 1.0).abs() < 1e-10);
    write(1e6);
    let said = made_of(&files, seat(None, false)).err().unwrap();
    let expected = "moved as a whole about y, which should strain nothing, it asks for 1.000e3 N m at node 4711 in ry \
                    per rad";
    assert!(said.contains(expected), "{said}");
}

/// Wrong: a node that cannot carry a ring would carry it somehow.
#[test]
fn nodes_that_carry_no_seat_are_refused_with_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let files = files(dir.path(), &diagonal(SPRINGS), [0.0; 3]);
    let refused = |files: &MatrixFiles, seat: BodySeat, expected: &str| {
        let said = made_of(files, seat).err().unwrap();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    };
    let with_nodes = |text: &str, files: &MatrixFiles, expected: &str| {
        let before = std::fs::read_to_string(&files.nodes).unwrap();
        std::fs::write(&files.nodes, text).unwrap();
        refused(files, seat(None, false), expected);
        std::fs::write(&files.nodes, before).unwrap();
    };
    with_nodes(
        "4711,0,0,0,5\n",
        &files,
        "nodes.csv, line 1: node 4711 has 5 dofs; expected 3, ux uy uz, or 6, with rx ry rz after them",
    );
    with_nodes(
        "4711,0,0,0\n",
        &files,
        "node 4711 is the reference_node of a [[body.seat]] and has 3 dofs, with which the ring could turn; expected 6 \
         in the fifth column",
    );
    with_nodes(
        "4712,0,0,0,6\n",
        &files,
        "reference_node 4711 of a [[body.seat]] is not here; expected one of the nodes",
    );
    with_nodes("4711,0,0,0,6\n1,0,0,0\n", &files, "the matrix is 6 x 6, but ");
    with_nodes(
        "4711,0,0,0,6\n1,0,0,0\n",
        &files,
        "has 2 nodes; expected 9 x 9, rows ux uy uz of every node, and rx ry rz of those with 6 dofs",
    );
    with_nodes(
        "4711,0.5,0,0,6\n",
        &files,
        "the seat \"node 4711\" of body \"springs\" lies 0.5000 mm off the z axis, that of the ring in its seat; \
         expected at most 0.0800 mm",
    );
    let far = seat(Some(0.6 * WIDTH), false);
    refused(
        &files,
        far,
        "the ring stands beside the seat \"node 4711\" of body \"springs\"",
    );
    let held = dir.path().join("held.csv");
    std::fs::write(&held, "4711\n").unwrap();
    let fixed = MatrixFiles {
        fixed_nodes: Some(held),
        ..files.clone()
    };
    refused(
        &fixed,
        seat(None, false),
        "node 4711 of the seat \"node 4711\" is fixed as well",
    );
    write_matrix(&files.stiffness, &diagonal([1e8, 1e8, 1e8, 1e4, 0.0, 1e4]));
    refused(
        &files,
        seat(None, false),
        "the stiffness of node 4711 in ry is 0e0; expected a positive number",
    );
}

/// The six rigid functions keep their arms in any space.
#[test]
fn the_width_of_the_ring_does_not_matter_to_a_reference_node() {
    let dir = tempfile::tempdir().unwrap();
    let files = files(dir.path(), &diagonal(SPRINGS), [0.0; 3]);
    let other = SeatSpace {
        half_width: 2.0 * WIDTH,
        radius: 2.0 * INNER,
        ..space(SeatBasis::Rigid)
    };
    let seat = BodySeat {
        space: other,
        ..seat(Some(5e-3), false)
    };
    assert_flexibility(&made_of(&files, seat).unwrap(), &flexibility(5e-3));
}
