//! A ring whose seat moves with one node of a body of matrices, through the whole program.

use crate::housing::delivered;
use crate::util::Dir;
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

/// The delivered scene in the folder, with another body in the place of the block, and another analysis.
fn scene(dir: &Dir, body: &str, analysis: &str) -> String {
    let text = dir
        .text("scenes/6010_plummer_block.toml")
        .replace("../meshes", "meshes");
    let (start, end) = (text.find("[[body]]  ").unwrap(), text.find("[shaft]").unwrap());
    let text = format!("{}{body}\n{}", &text[..start], &text[end..]);
    let text = text.replace("z = \"locked\" ", "z = \"free\" ");
    let text = text.replace("tilt_x = \"locked\"", "tilt_x = \"free\"");
    let text = text.replace("tilt_y = \"locked\"", "tilt_y = \"free\"");
    let (before, _) = text.split_once("\n[static]").unwrap();
    format!("{before}\n[effects.axial_force]\nvalue = \"3 kN\"\n{analysis}\n")
}

const SPRUNG: &str = "[[body]]\nname = \"springs\"\nstiffness = \"K.mtx\"\nnodes = \"nodes.csv\"\n\
                      length_unit = \"mm\"\nstiffness_unit = \"N/mm\"\nmass = \"M.mtx\"\nmass_unit = \"t\"\n\
                      [[body.seat]]\nring = \"outer\"\n\
                      reference_node = 4711\n";

fn run(dir: &Dir, name: &str, text: String) {
    dir.write(&format!("{name}.toml"), text);
    let run = dir.raceway(&["run", &format!("{name}.toml"), "--out", name]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

/// If this failed, a ring on springs would not stand where they do. Closed form: as in its mean motion, which is the
/// same ring and the same six functions, and moved by the load over the stiffness of each direction. The shaft tilts
/// freely and the load acts at the node, so there is no moment on the springs.
#[test]
fn a_ring_on_springs_is_moved_by_the_load_over_their_stiffness() {
    let dir = delivered();
    write_springs(&dir);
    let held = scene(&dir, "", "[static]").replace("support = \"body\" ", "support = \"mean_motion\" ");
    run(&dir, "held", held);
    run(&dir, "sprung", scene(&dir, SPRUNG, "[static]"));
    let [held, sprung] = ["held", "sprung"].map(|name| Table::read(&dir, &format!("{name}/shaft.csv")));
    let [along_y, along_z] = [-10e3 / (1e3 * SPRINGS[1]), 3e3 / (1e3 * SPRINGS[2])];
    for (name, expected) in [
        ("x_m", 0.0),
        ("y_m", along_y),
        ("z_m", along_z),
        ("tilt_x_rad", 0.0),
    ] {
        let moved = sprung.column(name)[0] - held.column(name)[0];
        // Newton stops at 1e-10 of the load.
        assert!(
            (moved - expected).abs() < 1e-8 * along_y.abs(),
            "{name}: {moved:e} {expected:e}"
        );
    }
    let told = summary(&dir, "sprung");
    assert_eq!(number(&told, "/seat/functions"), 6.0);
    assert!(
        told.pointer("/seat/largest_pressure_pa")
            .is_some_and(serde_json::Value::is_null)
    );
    assert!(!dir.path("sprung/seat_outer.csv").exists());
    let energy = 0.5 * (10e3 * along_y.abs() + 3e3 * along_z);
    let found = number(&told, "/seat/body_energy_j");
    assert!((found / energy - 1.0).abs() < 1e-6, "{found} {energy}");
}

/// If this failed, energy would come from the node, or its modes would not be among those of the bearing.
#[test]
fn a_ring_on_a_node_with_a_mass_moves_and_vibrates() {
    let dir = delivered();
    write_springs(&dir);
    let motion = "[speed]\ninner = \"600 rpm\"\n[dynamic]\nduration = \"240 us\"\nstep = \"20 us\"\noutput_every = 4\n";
    let text = scene(&dir, SPRUNG, motion);
    let text = text.replace(
        "value = \"3 kN\"\n",
        "value = \"3 kN\"\nschedule.step = { at = \"10 us\" }\n",
    );
    run(
        &dir,
        "moved",
        text.replace(
            "load_point =",
            "mass = \"5 kg\"\ntransverse_inertia = \"0.01 kg m2\"\nload_point =",
        ),
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
        dir.write("scene.toml", scene(&dir, SPRUNG, analysis));
        dir.raceway(&["check", "scene.toml"])
    };
    let moving = check("[modes]\nnumber = 4\n");
    assert_eq!(moving.code, Some(2), "{}", moving.stderr);
    let expected = "body \"springs\": the mass matrix is not positive: elimination fails at node 4711 in ";
    assert!(moving.stderr.contains(expected), "{}", moving.stderr);
    let at_rest = check("[static]");
    assert_eq!(at_rest.code, Some(0), "{}", at_rest.stderr);
}
