//! A ring whose seat moves with one node of a body of matrices, through the whole program.

use crate::util::Dir;
use crate::util::delivered::delivered;
use crate::util::tables::{Table, number, summary};

/// Springs of the node, N/mm and N mm/rad.
const SPRINGS: [f64; 6] = [2e5, 3e5, 5e5, 4e7, 7e7, 9e7];
/// Its mass, t, and inertia, t mm^2.
const INERTIA: [f64; 6] = [2e-3, 2e-3, 2e-3, 1.0, 1.0, 2.0];

fn diagonal(values: [f64; 6]) -> String {
    let entries = values.iter().enumerate();
    let lines = entries.map(|(i, value)| format!("{0} {0} {value:e}\n", i + 1));
    let head = "%%MatrixMarket matrix coordinate real symmetric\n6 6 6\n";
    format!("{head}{}", lines.collect::<String>())
}

/// Writes the files of a body of one node at the origin.
fn write_springs(dir: &Dir) {
    dir.write("K.mtx", diagonal(SPRINGS));
    dir.write("M.mtx", diagonal(INERTIA));
    dir.write("nodes.csv", "node,x,y,z,dofs\n4711,0,0,0,6\n");
}

/// Of the delivered scene: its load, 10 kN along -y.
const RADIAL: &str = "[effects.radial_force]\nvalue = \"10 kN\"\ndirection = \"270 deg\"\n";
/// Another load.
const AXIAL: &str = "[effects.axial_force]\nvalue = \"3 kN\"\n";

/// The delivered scene in the folder, with another body in the place of the block, another load and another analysis.
fn scene(dir: &Dir, body: &str, [load, analysis]: [&str; 2]) -> String {
    let text = dir.text("scenes/6010_plummer_block.toml");
    let text = text.replace("../meshes", "meshes");
    let part = |from: &str, to: &str| &text[text.find(from).unwrap()..text.find(to).unwrap()];
    let mut shaft = part("[shaft]", "[effects.radial_force]").to_string();
    if load.contains(AXIAL) {
        shaft = shaft.replace("z = \"locked\" ", "z = \"free\" ");
    }
    let (before, output) = (part("title = ", "[[body]]  "), part("[solver]", "[static]"));
    format!("{before}{body}\n{shaft}{load}{output}{analysis}\n")
}

const SPRUNG: &str = "[[body]]\nname = \"springs\"\nstiffness = \"K.mtx\"\nnodes = \"nodes.csv\"\n\
                      length_unit = \"mm\"\nstiffness_unit = \"N/mm\"\nmass = \"M.mtx\"\nmass_unit = \"t\"\n\
                      [[body.seat]]\nring = \"outer\"\n\
                      reference_node = 4711\n";

/// Runs a scene, and returns what the screen shows.
fn run(dir: &Dir, name: &str, text: String) -> String {
    dir.write(&format!("{name}.toml"), text);
    let run = dir.raceway(&["run", &format!("{name}.toml"), "--out", name]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    run.stdout
}

/// If this failed, a ring on springs would not stand where they do. Closed form: as in its mean motion, which is the
/// same ring and the same six functions, and moved by the load over the stiffness of its direction. No moment acts on
/// the springs under either load, and the shaft does not tilt.
#[test]
fn a_ring_on_springs_is_moved_by_the_load_over_their_stiffness() {
    let dir = delivered();
    write_springs(&dir);
    for (name, load, column, force, spring) in [
        ("radial", RADIAL, "y_m", -10e3, 1e3 * SPRINGS[1]),
        ("axial", AXIAL, "z_m", 3e3, 1e3 * SPRINGS[2]),
    ] {
        let held = scene(&dir, "", [load, "[static]"]);
        let held = held.replace("support = \"body\" ", "support = \"mean_motion\" ");
        let [held_run, sprung_run] = ["held", "sprung"].map(|kind| format!("{kind}_{name}"));
        run(&dir, &held_run, held);
        let said = run(&dir, &sprung_run, scene(&dir, SPRUNG, [load, "[static]"]));
        let line =
            "seat of the outer ring in body \"springs\": it moves as a rigid one, with its reference node";
        assert!(said.lines().any(|said| said == line), "{said}");
        let of = |folder: &str| Table::read(&dir, &format!("{folder}/shaft.csv"));
        let (held, sprung) = (of(&held_run), of(&sprung_run));
        let expected = force / spring;
        for other in ["x_m", "y_m", "z_m"] {
            let moved = sprung.column(other)[0] - held.column(other)[0];
            let expected = if other == column { expected } else { 0.0 };
            // Newton stops at 1e-10 of the load.
            let off = (moved - expected).abs();
            assert!(
                off < 1e-9 * force.abs() / spring,
                "{name} {other}: {moved:e} {expected:e}"
            );
        }
        let told = summary(&dir, &sprung_run);
        assert_eq!(number(&told, "/seat/functions"), 6.0);
        assert!(told["seat"]["energy_share_last_orders"].is_null());
        assert!(
            told.pointer("/seat/largest_pressure_pa")
                .is_some_and(serde_json::Value::is_null)
        );
        assert!(!dir.path(&format!("{sprung_run}/seat_outer.csv")).exists());
        let energy = 0.5 * force * expected;
        let found = number(&told, "/seat/body_energy_j");
        assert!((found / energy - 1.0).abs() < 1e-8, "{found} {energy}");
    }
}

/// If this failed, energy would come from the node, or a body of six dofs would have modes of round-off.
#[test]
fn a_ring_on_a_node_with_a_mass_moves_and_keeps_its_energy() {
    let dir = delivered();
    write_springs(&dir);
    let motion = "[speed]\ninner = \"600 rpm\"\n\
                  [dynamic]\nduration = \"240 us\"\nstep = \"20 us\"\noutput_every = 4\n";
    let load = format!("{RADIAL}{AXIAL}schedule.step = {{ at = \"10 us\" }}\n");
    let text = scene(&dir, SPRUNG, [&load, motion]);
    run(
        &dir,
        "moved",
        text.replace("load_point =", "mass = \"5 kg\"\nload_point ="),
    );
    let told = summary(&dir, "moved");
    let energy = |name: &str| number(&told, &format!("/energy_j/{name}"));
    assert!(energy("defect").abs() < 1e-9 * energy("total"), "{told}");
    assert!(energy("kinetic_outer") > 0.0);
}

/// If this failed, one would wait for a cluster to learn that a mass is wrong, or a body at rest would need one. Each
/// pair of directions has a positive energy, but x = y = z has not.
#[test]
fn check_refuses_a_mass_that_is_not_positive_where_the_body_moves() {
    let dir = delivered();
    write_springs(&dir);
    let wrong = diagonal(INERTIA).replace("6 6 6\n", "6 6 9\n");
    dir.write("M.mtx", format!("{wrong}2 1 -1.8e-3\n3 1 -1.8e-3\n3 2 -1.8e-3\n"));
    let check = |analysis: &str| {
        dir.write("scene.toml", scene(&dir, SPRUNG, [RADIAL, analysis]));
        dir.raceway(&["check", "scene.toml"])
    };
    let moving = check("[modes]\nnumber = 4\n");
    assert_eq!(moving.code, Some(2), "{}", moving.stderr);
    let expected = "body \"springs\": the mass matrix is not positive: elimination fails at node 4711 in ";
    assert!(moving.stderr.contains(expected), "{}", moving.stderr);
    let at_rest = check("[static]");
    assert_eq!(at_rest.code, Some(0), "{}", at_rest.stderr);
}

/// Wrong: a ring in its seat would turn about its axis without inertia over the speed. Closed form: a spring against
/// the moments of inertia of node and ring, that of the ring from its mesh. Its elasticity is 2e-4 of the frequency.
#[test]
fn a_ring_in_its_seat_turns_with_its_polar_moment() {
    let dir = delivered();
    write_springs(&dir);
    let text = scene(&dir, SPRUNG, [AXIAL, "[static]"]);
    let heavy = "mass = \"3 kg\"\ntransverse_inertia = \"8e-3 kg m2\"\npolar_inertia = \"6e-3 kg m2\"\n";
    assert!(!text.contains("\nmass = \"3"));
    let heavy = text.replace("load_point =", &format!("{heavy}load_point ="));
    dir.write("springs.toml", heavy);
    let arguments = [
        "campbell",
        "springs.toml",
        "--speeds",
        "0..0:1",
        "--number",
        "30",
        "--out",
        "c",
    ];
    let run = dir.raceway(&arguments);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let ring = mesh::read_msh(dir.path("meshes/6010_outer.msh"), 1e-3).unwrap();
    let mass = fem::assemble_mass(&ring, &fem::Material::new(207e9, 0.3, 7800.0).unwrap()).unwrap();
    let turn: Vec<f64> = ring.nodes.iter().flat_map(|[x, y, _]| [-y, *x, 0.0]).collect();
    let of_ring: f64 = mass.iter().map(|(m, (i, j))| turn[i] * m * turn[j]).sum();
    let inertia = 1e-3 * INERTIA[5] + of_ring;
    let expected = (1e-3 * SPRINGS[5] / inertia).sqrt() / std::f64::consts::TAU;
    let text = dir.text("c/campbell.csv");
    let (head, rows) = text.split_once('\n').unwrap();
    let at = head.split(',').position(|name| name == "frequency_hz").unwrap();
    let frequency = |row: &str| row.split(',').nth(at).unwrap().parse().unwrap();
    let found: Vec<f64> = rows.lines().map(frequency).collect();
    let near = found
        .iter()
        .map(|f| (f / expected - 1.0).abs())
        .fold(1.0, f64::min);
    println!("{expected} {of_ring:e} {near:e} {found:?}");
    assert!(near < 1e-3, "{expected}: {found:?}");
}
