//! Bodies by themselves: closed forms of a tube, bodies from matrices, and every message.

mod gaps;
mod loads;
mod matrices;
mod memory;
mod reference;
mod vibration;
mod wrong_matrices;

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::path::Path;

use body::matrix::{MatrixBody, MatrixFiles};
use body::{BodySeat, SeatBasis, SeatCylinder, SeatFunctions, SeatSpace, Surrounding, cylinder_areas};
use fem::Material;
use matrices::{condensed, of_matrix, seat_file, write_matrix};
use mesh::{ElementKind, Mesh, Origin, Section, revolve};

const INNER: f64 = 40e-3;
const OUTER: f64 = 60e-3;
const WIDTH: f64 = 16e-3;

fn basis(harmonics: usize, across: usize) -> SeatBasis {
    SeatBasis::Harmonics { harmonics, across }
}

fn space(basis: SeatBasis) -> SeatSpace {
    let cylinder = SeatCylinder {
        radius: INNER,
        ends: [-0.5 * WIDTH, 0.5 * WIDTH],
    };
    SeatSpace::on(&cylinder, basis)
}

/// A tube about z with the groups `seat_a`, `outside` and `face`.
fn tube(kind: ElementKind, sectors: usize, [layers, rows]: [usize; 2]) -> Mesh {
    let (mut points, mut quads) = (Vec::new(), Vec::new());
    for j in 0..=rows {
        for i in 0..=layers {
            let r = INNER + (OUTER - INNER) * i as f64 / layers as f64;
            points.push([r, WIDTH * (j as f64 / rows as f64 - 0.5)]);
        }
    }
    let at = |i: usize, j: usize| (layers + 1) * j + i;
    for j in 0..rows {
        for i in 0..layers {
            quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    let along = |i: usize| (0..rows).map(|j| [at(i, j), at(i, j + 1)]).collect::<Vec<_>>();
    let face = (0..layers).map(|i| [at(i, 0), at(i + 1, 0)]).collect();
    let groups = BTreeMap::from([
        ("seat_a".to_string(), along(0)),
        ("outside".to_string(), along(layers)),
        ("face".to_string(), face),
    ]);
    revolve(&Section::new(points, quads, &groups).unwrap(), sectors, kind, &[]).unwrap()
}

fn made(mesh: Mesh, material: Material, fixed: &str, basis: SeatBasis) -> Result<Surrounding, String> {
    let origin = Origin::of_generated("tube", 1.0, &mesh);
    let seat = BodySeat {
        name: "seat_a".into(),
        space: space(basis),
        middle: None,
        is_turned: false,
    };
    let fixed = [fixed.to_string()];
    Surrounding::of_mesh("tube", (mesh, &origin), material, &fixed, &[seat]).map_err(|e| e.to_string())
}

fn material(nu: f64) -> Material {
    Material::new(200e9, nu, 7800.0).unwrap()
}

/// Wrong: a housing would be stiffer or softer than it is. A thick tube held outside, Poisson's ratio 0, under pressure
/// (Lame), and under a pressure cos 2 theta: Airy's function (A r^2 + B r^4 + C / r^2 + D) cos 2 theta (Timoshenko and
/// Goodier, Theory of Elasticity, 3rd ed., art. 43), whose four numbers follow from stress inside and rest outside.
#[test]
fn a_tube_has_the_flexibility_of_lame_and_of_the_plane_solution() {
    let body = made(
        tube(ElementKind::Hex20, 72, [4, 2]),
        material(0.0),
        "outside",
        basis(3, 1),
    )
    .unwrap();
    let n = body.n_functions();
    let e = 200e9;
    let (a, b) = (INNER, OUTER);
    let moved = (1.0 / a - a / (b * b)) / (e * (1.0 / (a * a) + 1.0 / (b * b)));
    let expected = moved / (TAU * a * WIDTH);
    let found = body.flexibility[0];
    assert!((found / expected - 1.0).abs() < 1e-4, "{found:e} {expected:e}");
    let plane = |r: f64| {
        [
            [-2.0, 0.0, -6.0 / r.powi(4), -4.0 / r.powi(2)],
            [2.0, 6.0 * r * r, -6.0 / r.powi(4), -2.0 / r.powi(2)],
            [-2.0 * r, 0.0, 2.0 / r.powi(3), 4.0 / r],
            [2.0 * r, 6.0 * r.powi(3), 2.0 / r.powi(3), -2.0 / r],
        ]
    };
    let (inside, outside) = (plane(a), plane(b));
    // Rows in units of their size; a radial traction t_r = cos 2 theta outwards is sigma_r = -cos 2 theta.
    let unit = [1.0, a * a, a.powi(-2), 1.0];
    let unit = [1.0 / unit[0], 1.0 / unit[1], a.powi(4), a * a];
    let rows = [inside[0], inside[1], outside[2], outside[3]];
    let matrix: Vec<f64> = rows
        .iter()
        .flat_map(|row| (0..4).map(|i| row[i] * unit[i]))
        .collect();
    let mut x = vec![-1.0, 0.0, 0.0, 0.0];
    dense::DenseLu::factor(4, &matrix).unwrap().solve(&mut x, 1);
    let u = (0..4).map(|i| inside[2][i] * unit[i] * x[i]).sum::<f64>() / e;
    let expected = u / (PI * a * WIDTH);
    // n = 2, cosine, j = 0, radial, with two degrees across: scalar (2 * 3) of 3 components.
    let k = 3 * 6;
    let found = body.flexibility[n * k + k];
    assert!((found / expected - 1.0).abs() < 1e-3, "{found:e} {expected:e}");
}

/// Wrong: energy could come out of a body, or order 2 answer order 3 on a round one.
#[test]
fn the_flexibility_is_positive_and_orders_of_a_round_body_are_apart() {
    let body = made(
        tube(ElementKind::Hex8, 48, [2, 3]),
        material(0.3),
        "outside",
        basis(6, 2),
    )
    .unwrap();
    let n = body.n_functions();
    assert_eq!(n, 3 * 13 * 3);
    assert!(dense::DenseCholesky::factor(n, &body.flexibility).is_ok());
    let order = |k: usize| body.seats[0].space.basis.order_and_degree(k).unwrap()[0];
    let largest = body.flexibility.iter().fold(0.0f64, |a, x| x.abs().max(a));
    for i in 0..n {
        for j in (0..n).filter(|&j| order(i) != order(j)) {
            assert!(body.flexibility[n * i + j].abs() < 1e-10 * largest);
        }
    }
}

/// Wrong: threads would change bits.
#[test]
fn a_body_has_the_same_bits_on_one_and_two_threads() {
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mesh = tube(ElementKind::Hex8, 36, [2, 2]);
        let body = pool.install(|| made(mesh, material(0.3), "outside", basis(4, 2)).unwrap());
        body.flexibility.iter().map(|f| f.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(1), bits(2));
}

/// Wrong: a rigid motion of a seat would look deformed, differently on two meshes.
#[test]
fn rigid_motions_are_measured_exactly_on_any_mesh() {
    let meshes = [
        tube(ElementKind::Hex8, 31, [1, 2]),
        tube(ElementKind::Hex20, 24, [1, 3]),
    ];
    let rigid = |x: [f64; 3]| {
        let (t, phi) = ([1.0, -2.0, 0.5], [3.0, 1.0, -2.0]);
        [0, 1, 2].map(|c| t[c] + phi[(c + 1) % 3] * x[(c + 2) % 3] - phi[(c + 2) % 3] * x[(c + 1) % 3])
    };
    let found = meshes.map(|mesh| {
        let areas = fem::facet_node_weights(&mesh, mesh.group("seat_a"));
        let place = |node: usize| mesh.nodes[node];
        let seat = SeatFunctions::new("seat", space(basis(4, 2)), &areas, place).unwrap();
        let u: Vec<f64> = mesh.nodes.iter().flat_map(|x| rigid(*x)).collect();
        let measured = seat.measure(&u);
        // A force of each function through the motion is its coefficient.
        let mut load = vec![0.0; mesh.n_dofs()];
        seat.add_unit_load(5, 2.0, &mut load);
        let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
        assert!((work - 2.0 * measured[5]).abs() < 1e-12);
        measured
    });
    for (a, b) in found[0].iter().zip(&found[1]) {
        assert!((a - b).abs() < 1e-12, "{found:?}");
    }
    // u_r = cos theta t_x + sin theta t_y + z (sin, cos) phi.
    assert!(
        (found[0][9] - 1.0).abs() < 1e-12 && (found[0][18] + 2.0).abs() < 1e-12,
        "{:?}",
        &found[0][..27]
    );
}

/// Wrong: areas of nodes without facets would differ from those of the facets of a regular mesh.
#[test]
fn cells_on_the_cylinder_are_the_areas_of_regular_facets() {
    let mesh = tube(ElementKind::Hex8, 40, [1, 4]);
    let areas = fem::facet_node_weights(&mesh, mesh.group("seat_a"));
    let places: Vec<[f64; 3]> = areas.iter().map(|a| mesh.nodes[a.0]).collect();
    let cylinder = SeatCylinder {
        radius: INNER,
        ends: [-0.5 * WIDTH, 0.5 * WIDTH],
    };
    let cells = cylinder_areas(&cylinder, &places);
    assert!((cells.iter().sum::<f64>() / (TAU * INNER * WIDTH) - 1.0).abs() < 1e-12);
    // Chords are shorter than arcs by the same share everywhere.
    let chord = (PI / 40.0).sin() / (PI / 40.0);
    for (cell, (_, area)) in cells.iter().zip(&areas) {
        assert!((cell * chord / area - 1.0).abs() < 1e-9, "{cell} {area}");
    }
}

/// Wrong: the same body would differ by the way it comes in.
#[test]
fn a_body_of_its_matrix_is_that_of_its_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    let files = write_matrix(dir.path(), &mesh, "outside");
    let of_mesh = made(mesh, material(0.3), "outside", basis(3, 1)).unwrap();
    let largest = of_mesh.flexibility.iter().fold(0.0f64, |a, x| x.abs().max(a));
    let without_areas = std::fs::read_to_string(seat_file(&files)).unwrap();
    let without_areas: String = without_areas
        .lines()
        .map(|line| format!("{}\n", line.split(',').next().unwrap()))
        .collect();
    for (seat, tolerance) in [(None, 1e-8), (Some(without_areas), 1e-8)] {
        if let Some(text) = seat {
            std::fs::write(seat_file(&files), text).unwrap();
        }
        let of_matrix = of_matrix(&files).unwrap();
        for (a, b) in of_matrix.flexibility.iter().zip(&of_mesh.flexibility) {
            assert!((a - b).abs() < tolerance * largest, "{a:e} {b:e}");
        }
    }
}

/// Wrong: a body of matrices that is turned by 180 deg about x would keep directions of its dofs. With its outside off
/// the middle the tube is not the same the other way round.
#[test]
fn a_turned_matrix_is_that_of_the_turned_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let mut mesh = tube(ElementKind::Hex8, 24, [2, 2]);
    for [x, y, z] in &mut mesh.nodes {
        let out = x.hypot(*y) - INNER;
        (*y, *z) = (*y + 0.2 * out, *z + 0.1 * out);
    }
    let files = write_matrix(dir.path(), &mesh, "outside");
    let mut matrix = MatrixBody::read(&files).unwrap();
    let as_it_is = condensed(&matrix).unwrap().flexibility;
    matrix.half_turn();
    let turned = condensed(&matrix).unwrap().flexibility;
    mesh.nodes.iter_mut().for_each(|[_, y, z]| (*y, *z) = (-*y, -*z));
    let expected = made(mesh, material(0.3), "outside", basis(3, 1))
        .unwrap()
        .flexibility;
    let largest = expected.iter().fold(0.0f64, |a, x| x.abs().max(a));
    let off = |found: &[f64]| {
        let pairs = found.iter().zip(&expected);
        pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / largest
    };
    assert!(off(&turned) < 1e-8, "{:e}", off(&turned));
    assert!(off(&as_it_is) > 1e-2, "{:e}", off(&as_it_is));
}

fn small() -> Mesh {
    tube(ElementKind::Hex8, 24, [1, 2])
}

/// Wrong: a mesh that does not fit would be tied somehow, or refused without saying what to do.
#[test]
fn meshes_that_do_not_fit_are_refused_with_a_remedy() {
    let steel = material(0.3);
    let refuse = |mesh: Mesh, fixed: &str, basis: SeatBasis, expected: &str| {
        let said = made(mesh, steel, fixed, basis).err().unwrap();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    };
    let scaled = |factor: f64| {
        let mut mesh = small();
        mesh.nodes = mesh
            .nodes
            .iter()
            .map(|x| x.map(|c| factor * c))
            .collect::<Vec<_>>()
            .into();
        mesh
    };
    let wide = |factor: f64| {
        let mut mesh = small();
        let moved = mesh.nodes.iter().map(|x| [x[0], x[1], factor * x[2]]);
        mesh.nodes = moved.collect::<Vec<_>>().into();
        mesh
    };
    let mut shifted = small();
    shifted.nodes = shifted
        .nodes
        .iter()
        .map(|x| [x[0] + 1e-3, x[1], x[2]])
        .collect::<Vec<_>>()
        .into();
    let mut no_seat = small();
    no_seat.groups.remove("seat_a");
    refuse(
        small(),
        "feet",
        basis(3, 1),
        "no facet group \"feet\" in its mesh; groups are \"face\", \"outside\", \"seat_a\"",
    );
    refuse(
        no_seat,
        "face",
        basis(3, 1),
        "no facet group \"seat_a\" in its mesh; groups are \"face\", \"outside\"",
    );
    refuse(
        scaled(1000.0),
        "face",
        basis(3, 1),
        "a unit 1000 times smaller, such as mm for m",
    );
    refuse(
        scaled(1.01),
        "face",
        basis(3, 1),
        "a radius of 40.4000 mm, that of the ring has 40.0000 mm",
    );
    refuse(
        wide(1.5),
        "outside",
        basis(3, 1),
        "24.0000 mm wide, that of the ring 16.0000 mm",
    );
    refuse(shifted, "outside", basis(3, 1), "is no cylinder about the z axis");
    refuse(
        small(),
        "seat_a",
        basis(3, 1),
        "of the seat \"seat_a\" is fixed as well",
    );
    refuse(
        small(),
        "outside",
        basis(30, 1),
        "too few or too uneven for 122 functions",
    );
    refuse(small(), "outside", basis(3, 8), "fewer harmonics or across");
}

/// Wrong: a ring far beside its seat would be blamed on the mesh, or one in its place be refused.
#[test]
fn a_ring_beside_its_seat_is_refused_with_its_distance() {
    let mesh = small();
    let origin = Origin::of_generated("tube", 1.0, &mesh);
    let with = |z: Option<f64>| {
        let seat = BodySeat {
            name: "seat_a".into(),
            space: space(basis(2, 1)),
            middle: z,
            is_turned: false,
        };
        let held = ["outside".to_string()];
        let found = Surrounding::of_mesh("tube", (mesh.clone(), &origin), material(0.3), &held, &[seat]);
        found.err().map(|error| error.to_string())
    };
    let middle = space(basis(2, 1)).middle;
    assert_eq!(with(None), None);
    assert_eq!(with(Some(middle + 1.5e-3)), None);
    let expected = "the ring stands beside the seat \"seat_a\" of body \"tube\": its middle lies 60.0000 mm along z \
                    from that of the seat, which is 16.0000 mm wide; expected at most 1.6000 mm: give another z of \
                    the seat, or none for its middle in the body";
    assert_eq!(with(Some(middle - 60e-3)).as_deref(), Some(expected));
}

/// Wrong: a body could be held at an edge, or not at all.
#[test]
fn bodies_that_can_move_are_refused() {
    let mut mesh = small();
    // One facet whose nodes are moved onto a line is no surface; an empty list of groups holds nothing.
    let seat = BodySeat {
        name: "seat_a".into(),
        space: space(basis(2, 1)),
        middle: None,
        is_turned: false,
    };
    let origin = Origin::of_generated("tube", 1.0, &mesh);
    let free = Surrounding::of_mesh(
        "tube",
        (mesh.clone(), &origin),
        material(0.3),
        &[],
        std::slice::from_ref(&seat),
    );
    let said = free.err().unwrap().to_string();
    assert!(
        said.contains("body \"tube\" is not held: it can move at node"),
        "{said}"
    );
    mesh.groups
        .insert("edge".into(), mesh.group("outside")[..1].to_vec());
    let held = Surrounding::of_mesh(
        "tube",
        (mesh, &origin),
        material(0.3),
        &["edge".to_string()],
        &[seat],
    );
    assert!(held.is_ok(), "a facet spans a plane");
}

/// Wrong: files of another program with a slip would make a wrong body, or end without a line and a remedy.
#[test]
fn matrices_with_slips_are_refused_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    let files = write_matrix(dir.path(), &small(), "outside");
    let whole = |path: &Path| std::fs::read_to_string(path).unwrap();
    let keep = [files.stiffness.as_path(), &files.nodes, seat_file(&files)].map(whole);
    let refuse = |path: &Path, text: String, expected: &str| {
        std::fs::write(path, text).unwrap();
        let said = of_matrix(&files).err().unwrap();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
        for (path, text) in [files.stiffness.as_path(), &files.nodes, seat_file(&files)]
            .iter()
            .zip(&keep)
        {
            std::fs::write(path, text).unwrap();
        }
    };
    let [k, nodes, seat] = &keep;
    refuse(
        &files.stiffness,
        k.replace("symmetric", "hermitian"),
        "line 1: no Matrix Market file of this kind",
    );
    refuse(
        &files.stiffness,
        k.replacen("\n432 432", "\n430 430", 1),
        "the matrix is 430 x 430",
    );
    refuse(
        &files.stiffness,
        format!("{k}1 1 x\n"),
        "is no entry; expected row, column from 1 to 432",
    );
    refuse(&files.stiffness, format!("{k}1 1 1.0\n"), "the sizes say");
    let general = k.replace("symmetric", "general");
    refuse(
        &files.stiffness,
        general,
        "the stiffness is not symmetric: node 101",
    );
    let (head, first) = (
        k.lines().take(3).collect::<Vec<_>>().join("\n"),
        k.lines().nth(3).unwrap(),
    );
    let negative = k.replacen(&format!("{head}\n{first}"), &format!("{head}\n1 1 -5.0"), 1);
    refuse(
        &files.stiffness,
        negative,
        "the stiffness of node 101 in x is -5e3; expected a positive number",
    );
    refuse(
        &files.nodes,
        nodes.replacen("102,", "101,", 1),
        "node 101 stands here twice",
    );
    refuse(&files.nodes, nodes.replacen("102,", "102,a,", 1), "line 3");
    refuse(seat_file(&files), format!("{seat}999\n"), "node 999 is not in");
    refuse(
        seat_file(&files),
        format!("{seat}{}", seat.lines().next().unwrap()),
        "stands here twice",
    );
    refuse(seat_file(&files), "1.5\n".into(), "1.5 is no number of a node");
    let mut missing = files.clone();
    missing.nodes = dir.path().join("nowhere.csv");
    assert!(of_matrix(&missing).err().unwrap().starts_with("cannot read"));
    let free = MatrixFiles {
        fixed_nodes: None,
        ..files.clone()
    };
    assert!(
        of_matrix(&free)
            .err()
            .unwrap()
            .contains("body \"other\" is not held: it can move at node")
    );
    let last = keep[1].lines().last().unwrap().split(',').next().unwrap();
    let line = format!("{last}\n");
    std::fs::write(files.fixed_nodes.as_ref().unwrap(), line).unwrap();
    assert!(
        of_matrix(&files)
            .err()
            .unwrap()
            .contains("is fixed at 1 nodes that lie on one line")
    );
}
