//! A housing given by its matrices through the whole program, against the same housing as a mesh.

use std::fmt::Write;
use std::path::Path;

use fem::Material;

use crate::shared_housing::{FEW, SCENE};
use crate::util::Dir;
use crate::util::delivered::coarse;
use crate::util::tables::Table;

/// Number of the first node in the files.
const FIRST: usize = 1001;
/// Seats of the housing, and the file of the nodes of each.
const SEATS: [(&str, &str); 2] = [("seat_front", "front.csv"), ("seat_rear", "rear.csv")];

/// A symmetric matrix as a Matrix Market file.
fn matrix_market<'a>(n: usize, entries: impl Iterator<Item = (&'a f64, (usize, usize))>) -> String {
    let (mut text, mut count) = (String::new(), 0);
    for (value, (i, j)) in entries.filter(|(_, (i, j))| j <= i) {
        writeln!(text, "{} {} {value:e}", i + 1, j + 1).unwrap();
        count += 1;
    }
    format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {count}\n{text}")
}

/// Writes the files of the delivered housing, in SI units.
fn write_housing(dir: &Dir) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/spindle_housing.msh");
    let (mesh, _) = mesh::read_body_msh(&path, 1e-3).unwrap();
    let iron = Material::new(110e9, 0.26, 7200.0).unwrap();
    let n = mesh.n_dofs();
    let (stiffness, mass) = (
        fem::assemble_stiffness(&mesh, &iron).unwrap(),
        fem::assemble_mass(&mesh, &iron).unwrap(),
    );
    dir.write("K.mtx", matrix_market(n, stiffness.iter()));
    dir.write("M.mtx", matrix_market(n, mass.iter()));
    let mut nodes = String::from("node,x,y,z\n");
    for (i, [x, y, z]) in mesh.nodes.iter().enumerate() {
        writeln!(nodes, "{},{x:e},{y:e},{z:e}", FIRST + i).unwrap();
    }
    dir.write("nodes.csv", nodes);
    for (group, file) in SEATS {
        let areas = fem::facet_node_weights(&mesh, mesh.group(group));
        let lines = areas
            .iter()
            .map(|(node, area)| format!("{},{area:e}\n", FIRST + node));
        dir.write(file, lines.collect::<String>());
    }
    let held = mesh.group_nodes("flange");
    let lines = held.iter().map(|node| format!("{}\n", FIRST + node));
    dir.write("fixed.csv", lines.collect::<String>());
}

/// The delivered scene in the folder, with the housing as its mesh or as its matrices, and another analysis.
fn scene(dir: &Dir, analysis: &str) -> [String; 2] {
    let text = dir.text(SCENE).replace("../meshes", "meshes");
    let text = text.replace("\"types/", "\"scenes/types/");
    let (before, _) = text.split_once("\n[static]").unwrap();
    let text = format!("{before}\n{analysis}\n");
    let start = text.find("mesh = \"meshes/spindle_housing.msh\"").unwrap();
    let end = start + text[start..].find("[[body.seat]]").unwrap();
    let files = "stiffness = \"K.mtx\"\nmass = \"M.mtx\"\nmass_unit = \"kg\"\nnodes = \"nodes.csv\"\n\
                 fixed_nodes = \"fixed.csv\"\nlength_unit = \"m\"\nstiffness_unit = \"N/m\"\n";
    let mut of_matrices = format!("{}{files}{}", &text[..start], &text[end..]);
    for (group, file) in SEATS {
        let of_mesh = format!("group = \"{group}\"");
        assert!(of_matrices.contains(&of_mesh));
        of_matrices = of_matrices.replace(&of_mesh, &format!("seat_nodes = \"{file}\""));
    }
    [text, of_matrices]
}

/// Runs both and returns their folders.
fn run_both(dir: &Dir, name: &str, analysis: &str, more: &[&str]) -> [String; 2] {
    let texts = scene(dir, analysis);
    let mut made = ["mesh", "matrices"].map(|kind| format!("{name}_{kind}"));
    for (folder, text) in made.iter_mut().zip(texts) {
        dir.write(&format!("{folder}.toml"), text);
        let scene = format!("{folder}.toml");
        let run = dir.raceway(&[&["run", &scene, "--out", folder], &FEW[..], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    made
}

/// Largest difference of columns of a table of both, over the largest value of each column.
fn difference(dir: &Dir, [mesh, matrices]: &[String; 2], table: &str, columns: &[&str]) -> f64 {
    let [mesh, matrices] = [mesh, matrices].map(|folder| Table::read(dir, &format!("{folder}/{table}")));
    let of_column = |name: &&str| {
        let (a, b) = (mesh.column(name), matrices.column(name));
        assert_eq!(a.len(), b.len());
        let largest = a.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max) / largest.max(f64::MIN_POSITIVE)
    };
    columns.iter().map(of_column).fold(0.0, f64::max)
}

/// Natural frequencies of a run, Hz.
fn frequencies(dir: &Dir, folder: &str) -> Vec<f64> {
    let text = dir.text(&format!("{folder}/modes.csv"));
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let at = head.iter().position(|name| *name == "frequency_hz").unwrap();
    lines.map(|row| row[at].parse().unwrap()).collect()
}

const SHAFT: [&str; 5] = ["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"];

/// If this failed, two bearings in a housing of another program would not be those in the housing that it is: at rest,
/// in its modes and in motion. The matrices are those of the mesh, with all digits: only round-off is between.
#[test]
fn a_pair_in_a_housing_of_matrices_is_that_in_its_mesh() {
    let dir = coarse(&[SCENE]);
    write_housing(&dir);
    let rest = run_both(&dir, "rest", "[static]", &[]);
    let off = difference(&dir, &rest, "shaft.csv", &SHAFT);
    assert!(off < 1e-8, "at rest {off:e}");
    let below = ["--set", "body.0.modes_below=3 kHz"];
    let modes = run_both(
        &dir,
        "modes",
        "[modes]\nnumber = 6\nbodies = [\"bearing\"]",
        &below,
    );
    let [of_mesh, of_matrices] = modes.map(|folder| frequencies(&dir, &folder));
    assert_eq!([of_mesh.len(), of_matrices.len()], [6, 6]);
    let pairs = of_mesh.iter().zip(&of_matrices);
    let off = pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-6, "modes {off:e}");
    let motion = "[speed]\ninner = \"3000 rpm\"\n[effects.axial_force]\nvalue = \"300 N\"\n\
                  schedule.step = { at = \"5 us\" }\n[dynamic]\nduration = \"80 us\"\nstep = \"10 us\"\n\
                  output_every = 4\n";
    let moved = run_both(&dir, "motion", motion, &below);
    let off = difference(&dir, &moved, "shaft.csv", &SHAFT);
    assert!(off < 1e-7, "in motion {off:e}");
}

/// If this failed, a slip in one of the seats would end in anything but a message that names it: the seat of the rear
/// bearing with the nodes of the front one stands where no bearing is, and one that is not there is said at once.
#[test]
fn a_wrong_seat_of_a_housing_of_matrices_is_named() {
    let dir = coarse(&[SCENE]);
    write_housing(&dir);
    let [_, text] = scene(&dir, "[static]");
    let refused = |text: String, expected: &str| {
        dir.write("bad.toml", text);
        let run = dir.raceway(&[&["run", "bad.toml", "--out", "bad"], &FEW[..]].concat());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(
            run.stderr.contains(expected),
            "{}\nexpected: {expected}",
            run.stderr
        );
    };
    refused(
        text.replace("\"rear.csv\"", "\"nowhere.csv\""),
        "body \"housing\": seat_nodes is \"nowhere.csv\", but there is no file",
    );
    dir.write("copy.csv", dir.text("front.csv"));
    refused(
        text.replace("\"rear.csv\"", "\"copy.csv\""),
        "the seat of bearing \"rear\" stands -0.0000 mm along the shaft from that of \"front\"",
    );
    dir.write("empty.csv", "node,area\n");
    refused(
        text.replace("\"rear.csv\"", "\"empty.csv\""),
        "empty.csv: no node; expected lines node or node,area",
    );
}

/// If this failed, a slip by thousands in the unit of a matrix, or the wrong file, would change the answer without a
/// word. With sound units nothing is said.
#[test]
fn units_that_make_no_solid_are_doubted() {
    let dir = coarse(&[SCENE]);
    write_housing(&dir);
    let few = FEW[..].to_vec();
    let doubts = |analysis: &str, [from, to]: [&str; 2]| {
        let [_, text] = scene(&dir, analysis);
        assert!(from.is_empty() || text.contains(from), "{from}");
        dir.write("odd.toml", text.replace(from, to));
        let said = dir.raceway(&[&["check", "odd.toml"], &few[..]].concat());
        assert_eq!(said.code, Some(0), "{}", said.stderr);
        said.stdout + &said.stderr
    };
    let modes = "[modes]\nnumber = 6\nbodies = [\"bearing\"]";
    let sound = doubts(modes, ["\"kg\"", "\"kg\""]);
    assert!(
        !sound.contains("check stiffness_unit") && !sound.contains("check mass_unit"),
        "{sound}"
    );
    assert!(sound.contains(", as stiff as a solid of "), "{sound}");
    let stiff = doubts("[static]", ["\"N/m\"", "\"N/mm\""]);
    let part = "body \"housing\": between its nodes it is as stiff as a solid of ";
    let line = stiff.lines().find(|line| line.contains(part)).expect(&stiff);
    let rest = " GPa, expected 1 to 5000 GPa: check stiffness_unit and length_unit, and that `stiffness` is not \
                the file of the mass";
    assert!(line.ends_with(rest), "{line}");
    let heavy = doubts(modes, ["\"kg\"", "\"g\""]);
    let part = "of the box round its nodes, expected 20 to 5e5 kg/m3: check mass_unit and length_unit";
    assert!(heavy.contains(part), "{heavy}");
}
