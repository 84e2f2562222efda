//! Free balls on real surfaces through the whole program: the same bits on any threads and after a cut, and the lines
//! of balls that have speeds of their own.

use crate::free_resume::everything;
use crate::resume::assert_cuts_continue;
use crate::util::lockstep::assert_same_run;
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE};

/// Surfaces of rings and balls that all contacts of a short motion meet.
const SURFACES: &str = "[[profiles.spall]]\nring = \"outer\"\nazimuth = \"0.5 deg\"\ngroove_angle = \"18 deg\"\n\
     length = \"0.5 mm\"\nwidth = \"2 mm\"\ndepth = \"5 um\"\nedge = \"0.1 mm\"\n\n\
     [[profiles.random]]\nring = \"inner\"\norders = [3, 60]\namplitude = \"0.1 um\"\nslope = 1.0\nseed = 4\n\n\
     [[profiles.spall]]\nball = 4\nlongitude = \"-3 deg\"\nlatitude = \"0 deg\"\nlength = \"0.5 mm\"\n\
     width = \"3 mm\"\ndepth = \"5 um\"\nedge = \"0.1 mm\"\n\n\
     [[profiles.waviness]]\nball = 7\norder = 6\namplitude = \"0.2 um\"\n\n";

/// Wrong: orientations of balls or forces of surfaces would be lost in a step file, or depend on the machine.
#[test]
fn with_real_surfaces_a_run_has_the_same_bits_on_any_threads_and_after_a_cut() {
    let dir = everything();
    let scene = dir
        .text("scene.toml")
        .replace("[balls]\n", &(SURFACES.to_string() + "[balls]\n"))
        .replace("duration = \"0.4 ms\"", "duration = \"0.2 ms\"");
    dir.write("scene.toml", &scene);
    dir.run("whole", &["--threads", "1"]);
    let energy = Table::read(&dir, "whole/energy.csv");
    assert!(energy.column("profile_work_j").iter().any(|work| *work != 0.0));
    dir.run("two", &["--threads", "2"]);
    assert_same_run(&dir, "whole", "two");
    assert_cuts_continue(&dir, &[("0", "2"), ("14", "1")]);
}

/// Wrong: lines of free balls would be those of kinematics, or a free ball have none. 7010C under 2 kN at 6000 rpm with
/// friction: 2 BSF is twice the turning of the marked ball relative to its own orbit, of which the table tells.
#[test]
fn a_spectrum_marks_the_spin_of_a_free_ball() {
    let motion = "[[profiles.waviness]]\nball = 4\norder = 2\namplitude = \"0.2 um\"\n\n[balls]\nmotion = \"free\"\n\n\
                  [effects.traction]\nlaw = \"coulomb\"\nfriction = 0.1\n\n[speed]\ninner = \"6000 rpm\"\n\n\
                  [dynamic]\nduration = \"2 ms\"\nstep = \"10 us\"\noutput_every = 200\n";
    let dir = Dir::with_scene(&SCENE.replace("[static]", motion));
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let outcome = dir.raceway(&["spectrum", "out", "--probe", "z_m"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let line = outcome
        .stdout
        .lines()
        .find(|line| line.contains("2 BSF"))
        .unwrap();
    let found: f64 = line.split_whitespace().nth(2).unwrap().parse().unwrap();
    // Of a kinematic ball, which rolls at the free contact angle: under load contact angles are larger.
    let rolling = 2.0 * 106.43 * 6000.0 / 1800.0;
    assert!((found / rolling - 1.0).abs() < 0.02, "{found} {rolling}");
    assert!((found / rolling - 1.0).abs() > 1e-3, "{found} {rolling}");
}
