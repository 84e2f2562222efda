//! Balls with profiles through the whole program: the lines that they show, and the same bits on any threads and after
//! a resume.

use crate::resume::assert_cuts_continue;
use crate::surfaces::near_in;
use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE, with_line};

const RADIAL: &str = "[effects.radial_force]\nvalue = \"1 kN\"\ndirection = \"0 deg\"\n";

/// A spall on ball 4 at a latitude, rad.
fn spall(latitude: &str, width: &str) -> String {
    format!(
        "[[profiles.spall]]\nball = 4\nlongitude = \"90 deg\"\nlatitude = \"{latitude}\"\nlength = \"0.8 mm\"\n\
         width = \"{width}\"\ndepth = \"50 um\"\nedge = \"0.1 mm\"\n\n"
    )
}

/// Amplitudes, m, of a column of shaft.csv at frequencies, Hz, over 0.4 s at 1800 rpm in equilibria, to 5 Hz; and what
/// the command said.
fn amplitudes(spall: &str, load: &str, probe: &str, frequencies: &[f64]) -> (Vec<f64>, String) {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"0.4 s\"\nstep = \"100 us\"\n\
                  output_every = 4000\n";
    let scene = with_line("[static]", "[static]", &(spall.to_string() + motion));
    assert!(scene.contains(RADIAL));
    let dir = Dir::with_scene(&scene.replace(RADIAL, load));
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let outcome = dir.raceway(&["spectrum", "out", "--probe", probe]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = Table::read(
        &dir,
        &format!("out/spectrum_{}.csv", probe.trim_end_matches("_m")),
    );
    let at = |frequency: &f64| near_in(&table, "amplitude_m", *frequency, 3.0);
    (frequencies.iter().map(at).collect(), outcome.stdout)
}

/// Ball spin about its own axis relative to the cage, and speed of the cage, at 14.93 deg and 1800 rpm, Hz.
const BSF: f64 = 106.43;
const CAGE: f64 = 12.994;

/// Wrong: a spall on a ball would not show at twice the spin of the ball, where both raceways meet it, or without the
/// sidebands at the speed of the cage with which it goes through a load that stands (Randall and Antoni, MSSP 25 (2011)
/// 485). Under thrust alone nothing changes along the axis as the ball goes round: no sidebands.
#[test]
fn a_spalled_ball_shows_at_twice_its_spin_with_sidebands_of_the_cage() {
    let lines = [2.0 * BSF, 2.0 * BSF - CAGE, 2.0 * BSF + CAGE, BSF];
    let both = spall("0 deg", "4 mm");
    let (radial, said) = amplitudes(&both, RADIAL, "z_m", &lines);
    let [line, low, high, once] = radial[..] else {
        panic!("four lines")
    };
    assert!(line > 5e-9, "{line}");
    assert!(low.min(high) > 0.04 * line, "{low} {high} {line}");
    assert!(once < 0.2 * line, "{once} {line}");
    let mut after = said
        .lines()
        .skip_while(|text| !text.contains("2 BSF     212.8"))
        .skip(1);
    assert!(
        after.next().is_some_and(|text| text.trim().starts_with("side -")),
        "{said}"
    );
    let (thrust, _) = amplitudes(&both, "", "z_m", &lines);
    let [line, low, high, _] = thrust[..] else {
        panic!("four lines")
    };
    assert!(line > 5e-9 && low.max(high) < 0.01 * line, "{low} {high} {line}");
}

/// Wrong: a raceway would meet a mark that is not on its path. Under 2 kN of thrust the contact angles are 19.6 deg, so
/// that the paths on a ball that rolls at 14.9 deg are 4.6 deg from its equator, on both sides. A spall at 14 deg, 0.7
/// mm wide, is met by the outer raceway alone, once a turn of the ball.
#[test]
fn a_spall_beside_one_path_is_met_once_a_turn() {
    let lines = [BSF, 2.0 * BSF, 3.0 * BSF];
    let (found, _) = amplitudes(&spall("14 deg", "0.7 mm"), "", "z_m", &lines);
    let [once, twice, thrice] = found[..] else {
        panic!("three lines")
    };
    // The multiples of a pulse that is short against its period are alike; a Hann window leaves 15 % between its lines.
    assert!(once > 1e-9, "{once}");
    for other in [twice, thrice] {
        assert!((other / once - 1.0).abs() < 0.3, "{once} {twice} {thrice}");
    }
    let (found, _) = amplitudes(&spall("0 deg", "4 mm"), "", "z_m", &lines);
    assert!(found[1] > 5.0 * found[0], "{found:?}");
}

/// Wrong: where marks of balls are would depend on the machine, or a run that is cut go on with other ones.
#[test]
fn worn_balls_have_the_same_bits_on_any_threads_and_after_a_cut() {
    let dir = small_motion();
    let profiles = spall("0 deg", "4 mm").replace("90 deg", "-3 deg")
        + "[[profiles.random]]\nball = 4\norders = [2, 20]\namplitude = \"0.2 um\"\nslope = 1.0\nseed = 1\n\n\
           [speed.inner]\ntimes = [\"0 ms\", \"1 ms\"]\nvalues = [\"6000 rpm\", \"9000 rpm\"]\n\n\
           [dynamic]\nduration = \"0.4 ms\"\nstep = \"10 us\"\noutput_every = 2";
    dir.write("scene.toml", SCENE.replace("[static]", &profiles));
    dir.run("whole", &["--threads", "1"]);
    let work = Table::read(&dir, "whole/energy.csv").column("profile_work_j");
    assert!(work.iter().any(|work| work.abs() > 1e-7), "{work:?}");
    dir.run("two", &["--threads", "2"]);
    assert_same_run(&dir, "whole", "two");
    assert_cuts_continue(&dir, &[("0", "2"), ("14", "1"), ("38", "2")]);
}
