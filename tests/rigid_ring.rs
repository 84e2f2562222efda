//! A rigid inner ring that has the inertia of its section, through the whole program.

use mesh::{RingSection, RingSide};

use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE, assert_close};

/// Free of its balls: nothing acts on it but what the scene says.
fn scene(effects: &str, start: &str) -> String {
    let (head, _) = SCENE.split_once("[effects.axial_force]").unwrap();
    let section = "[inner]\ninertia = \"section\"\nsection = { shoulder_diameters = [\"60.4 mm\", \"60.4 mm\"], \
                   element = \"hex8\", sectors = 18, groove_elements = 2, thickness_elements = 1, \
                   shoulder_elements = 1 }";
    let free = ["x", "y"].iter().fold(head.to_string(), |text, axis| {
        text.replace(
            &format!("tilt_{axis} = \"locked\""),
            &format!("tilt_{axis} = \"free\""),
        )
    });
    format!("{}\n{effects}\n{start}", free.replacen("[inner]", section, 1))
}

/// Mass and moments of inertia across and about the axis of the ring of the scene.
fn inertia() -> [f64; 3] {
    let section = RingSection {
        side: RingSide::Inner,
        seat_diameter: 50e-3,
        raceway_diameter: 56.01e-3,
        groove_radius: 4.65e-3,
        shoulder_diameters: [60.4e-3; 2],
        width: 16e-3,
        groove_offset: 0.0,
        groove_elements: 2,
        thickness_elements: 1,
        shoulder_elements: [1; 2],
        grading: 1.0,
    };
    let moments = section.moments().unwrap();
    [moments.volume, moments.transverse(), moments.polar].map(|m| 7800.0 * m)
}

fn last(dir: &Dir, column: &str) -> f64 {
    *Table::read(dir, "out/shaft.csv").column(column).last().unwrap()
}

/// If this failed, a rigid ring in motion would weigh something else than its section says: 10 N pull it off its balls,
/// z = F t^2 / (2 m), which average acceleration has exactly.
#[test]
fn a_rigid_ring_off_its_balls_accelerates_by_its_own_mass() {
    let start = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"10 us\"\n\n[dynamic.start.free]";
    let dir = Dir::with_scene(&scene("[effects.axial_force]\nvalue = \"-10 N\"\n", start));
    let outcome = dir.run("out", &RIGID);
    let expected = -10.0 * 0.2e-3f64.powi(2) / (2.0 * inertia()[0]);
    assert_close("z", last(&dir, "z_m"), expected, 1e-11);
    let said = "the rigid inner ring has 0.095";
    assert!(
        outcome.stderr.contains(said) || outcome.stdout.contains(said),
        "{}",
        outcome.stderr
    );
}

/// If this failed, a rigid ring would have other moments of inertia than its section: off its balls at 20 000 rpm it
/// nutates with W I_p / I, second order in the step.
#[test]
fn a_rigid_ring_off_its_balls_nutates_by_its_own_moments_of_inertia() {
    let start = "[speed]\ninner = \"20000 rpm\"\n\n[dynamic]\nduration = \"0.5 ms\"\nstep = \"1 us\"\n\n\
                 [dynamic.start.given]\nvelocity_z = \"-0.1 m/s\"\nvelocity_tilt_x = \"0.5 rad/s\"";
    let dir = Dir::with_scene(&scene("", start));
    dir.run("out", &RIGID);
    let [_, transverse, polar] = inertia();
    let nutation = 20_000.0 * std::f64::consts::PI / 30.0 * polar / transverse;
    let angle = nutation * 0.5e-3;
    // I t'' + I_p W (t_y', -t_x') = 0 from rest with t_x' = w.
    let (x, y) = (angle.sin() / nutation, (1.0 - angle.cos()) / nutation);
    assert_close("tilt x", last(&dir, "tilt_x_rad"), 0.5 * x, 1e-5);
    assert_close("tilt y", last(&dir, "tilt_y_rad"), 0.5 * y, 1e-5);
}
