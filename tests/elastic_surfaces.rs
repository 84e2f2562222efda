//! A spall on elastic rings: the times of its passage, and what a sensor feels of it.

use crate::util::tables::Table;
use crate::util::{Dir, with_line};

/// 1 mm by 3 mm; ball 0, at azimuth 0, comes to it after 50 us.
const SPALL: &str = "[[profiles.spall]]\nring = \"outer\"\nazimuth = \"1.013 deg\"\ngroove_angle = \"18 deg\"\n\
                     length = \"1 mm\"\nwidth = \"3 mm\"\ndepth = \"50 um\"\nedge = \"0.05 mm\"\n\n";
const STEP: f64 = 4e-6;
/// 1800 rpm, rad/s.
const SPEED: f64 = 60.0 * std::f64::consts::PI;
/// Entry of the contact's middle, s.
const ENTRY: f64 = 50e-6;
/// Time in which it passes the spall, s: 1 mm at 36.79 mm times 81.64 rad/s.
const PASSAGE: f64 = 333e-6;
/// Time in which it passes its own half-width of 0.13 mm, s.
const HALF_WIDTH: f64 = 43e-6;

fn passed() -> Dir {
    let tables = "[speed]\ninner = \"1800 rpm\"\n\n[probes.contact.ball]\nball = 0\nring = \"outer\"\n\n\
                  [probes.node.n]\nring = \"outer\"\nazimuth = \"0 deg\"\nr = \"34.3 mm\"\nz = \"6 mm\"\n\
                  acceleration = true\n\n[probes.node.bore]\nring = \"inner\"\nazimuth = \"0 deg\"\n\
                  r = \"25 mm\"\nz = \"0 mm\"\naxes = \"cartesian\"\n\
                  acceleration = true\n\n[effects.contact_damping]\ncoefficient = \"100 N s/m\"\n\
                  full_approach = \"3 um\"\n\n[dynamic]\nduration = \"0.52 ms\"\nstep = \"4 us\"\n\
                  output_every = 1000\nintegrator = \"chung_hulbert\"\nrho = 0.8\ncontact = \"discrete_gradient\"\n\
                  ledger_tolerance = 1e-6\n";
    let dir = Dir::with_meshes();
    dir.write(
        "scene.toml",
        with_line("[static]", "[static]", &(SPALL.to_string() + tables)),
    );
    dir.run("out", &["--set", "shaft.mass=2 kg"]);
    dir
}

/// Time of the first value from a time on that holds, s.
fn first(values: &[f64], from: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let start = (from / STEP) as usize;
    let found = values[start..].iter().position(|v| holds(*v));
    STEP * (start + found.expect("it happens")) as f64
}

/// Wrong: balls on elastic rings would lose their load, or meet the far edge, at other times than the passage asks for;
/// or a sensor would not feel entry and impact as two events. The force has fallen by 2 % within b/v of the entry. The
/// far edge is met at L/(2 v), later by what ring and shaft have followed the ball: within b/v. The load is whole again
/// before L/v, by at most 1.5 b/v, for the ball is thrown against the rings. A node of the shoulder feels the entry as
/// a step, and the impact ten times as much.
#[test]
fn a_spall_on_elastic_rings_takes_the_times_of_its_passage_and_is_felt_twice() {
    let dir = passed();
    let probes = Table::read(&dir, "out/probes.csv");
    let force = probes.column("ball_force_n");
    let whole = force[0];
    let fell = first(&force, 0.0, |f| f < 0.98 * whole);
    assert!((0.0..HALF_WIDTH).contains(&(fell - ENTRY)), "{fell}");
    let empty = first(&force, fell, |f| f < 0.02 * whole);
    let impact = first(&force, empty, |f| f > 0.03 * whole) - ENTRY;
    println!("fell {fell} empty {empty} impact {impact}");
    assert!((impact - 0.5 * PASSAGE).abs() < HALF_WIDTH, "{impact}");
    let again = first(&force, ENTRY + impact, |f| f >= whole) - ENTRY;
    println!("whole again {again}");
    assert!(
        (PASSAGE - 1.5 * HALF_WIDTH..PASSAGE + 0.5 * HALF_WIDTH).contains(&again),
        "{again}"
    );
    let felt = probes.column("n_acceleration_r_m_per_s2");
    let largest = |from: f64, to: f64| {
        let range = (from / STEP) as usize..(to / STEP) as usize;
        felt[range].iter().fold(0.0, |most: f64, a| most.max(a.abs()))
    };
    let before = largest(8e-6, ENTRY - 8e-6);
    let entry = largest(ENTRY - 8e-6, ENTRY + 0.25 * PASSAGE);
    let blow = largest(ENTRY + impact - 12e-6, ENTRY + PASSAGE);
    println!("acceleration {before} {entry} {blow}");
    assert!(
        entry > 3.0 * before && blow > 5.0 * entry,
        "{before} {entry} {blow}"
    );
    // The shaft: up as the ball lets go, down from the far edge on. Its accelerations are those of its displacements,
    // to a tenth of the largest: those of a step are weighted in time.
    let of_shaft = probes.column("bore_acceleration_x_m_per_s2");
    let range = |from: f64, to: f64| &of_shaft[(from / STEP) as usize..(to / STEP) as usize];
    let up = range(ENTRY, ENTRY + 0.5 * PASSAGE)
        .iter()
        .copied()
        .fold(0.0, f64::max);
    let down = range(ENTRY + impact, ENTRY + 1.2 * PASSAGE)
        .iter()
        .copied()
        .fold(0.0, f64::min);
    let quiet = range(8e-6, ENTRY - 8e-6)
        .iter()
        .fold(0.0, |most: f64, a| most.max(a.abs()));
    println!("shaft {quiet} {up} {down}");
    assert!(up > 100.0 * quiet && down < -up, "{quiet} {up} {down}");
    let place = probes.column("bore_displacement_x_m");
    let middle = range(ENTRY, ENTRY + 0.5 * PASSAGE);
    let first = (ENTRY / STEP) as usize;
    for (i, a) in middle.iter().enumerate() {
        let u = &place[first + i - 1..first + i + 2];
        // A displacement in space has the turning of the bore, too.
        let turning = SPEED * SPEED * 25e-3 * (SPEED * STEP * (first + i) as f64).cos();
        let found = (u[0] - 2.0 * u[1] + u[2]) / (STEP * STEP) + turning;
        assert!((found - a).abs() < 0.1 * up, "{i}: {found} {a}");
    }
}

/// Wrong: a probe could ask for an acceleration that nothing has.
#[test]
fn accelerations_of_nodes_are_refused_at_rest() {
    let dir = Dir::with_meshes();
    let node = "[probes.node.n]\nring = \"outer\"\nazimuth = \"0 deg\"\nr = \"34.3 mm\"\nz = \"6 mm\"\n\
                acceleration = true\n\n[static]";
    dir.write("scene.toml", with_line("[static]", "[static]", node));
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let said = "probes.node.n.acceleration is true, but only a motion has accelerations; expected [dynamic], or \
                leave it out";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
}
