//! Fits, temperatures and films through the whole program.

use crate::resume::resumed;
use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, SCENE, assert_close};

/// 10 um on a solid shaft, all as warm as the shaft, and a node of the bore.
const FITTED: &str = "[effects.fit.inner]\ninterference = \"10 um\"\n\n\
                      [effects.temperature]\ninner = \"60 degC\"\nouter = \"60 degC\"\nballs = \"60 degC\"\n\n\
                      [probes.node.bore]\nring = \"inner\"\nazimuth = \"0 deg\"\nr = \"25 mm\"\n\
                      z = \"0 mm\"\n\n[static]";

fn fitted() -> Dir {
    let dir = Dir::with_meshes();
    let warm = SCENE.replace(
        "density = \"7800 kg/m3\"\n",
        "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n",
    );
    dir.write("scene.toml", warm.replace("[static]", FITTED));
    dir
}

/// Wrong: log, summary and probes would tell of another fit than was computed. The bore stands where the interference
/// less the give of the solid shaft puts it, u = I/2 - d (1 - nu)/(2 E) p, and grows by 40 K more; its hoop stress is
/// what u/r and the free strain of no stress along the axis make of it, less than E u/r.
#[test]
fn a_fit_is_in_log_summary_and_probes() {
    let dir = fitted();
    let said = dir.run("out", &["--set", "effects.radial_force=none"]);
    for part in [
        "radial clearance and free contact angle: unmounted 27.00 um, 14.93 deg; mounted 18.",
        "fit of the inner ring: interference 10.00 um, pressure ",
    ] {
        assert!(
            said.stderr.contains(part) || said.stdout.contains(part),
            "{}",
            said.stderr
        );
    }
    let found = summary(&dir, "out");
    let state = |name: &str, key: &str| number(&found, &format!("/clearance/{name}/{key}"));
    let growth = number(&found, "/fits/inner/groove_growth_m");
    let loss = state("unmounted", "radial_m") - state("mounted", "radial_m");
    assert_close("clearance", loss, 2.0 * growth, 1e-9);
    let same = |key: &str| state("operating", key) / state("mounted", key);
    assert_close("warm", same("radial_m"), 1.0 + 40.0 * 11.5e-6, 1e-9);
    assert_close("angle", same("free_contact_angle_rad"), 1.0, 1e-9);
    let pressure = number(&found, "/fits/inner/pressure_pa");
    let moved = 5e-6 - 50e-3 * 0.7 / (2.0 * 207e9) * pressure;
    let probes = Table::read(&dir, "out/probes.csv");
    let seen = probes.column("bore_displacement_r_m")[0];
    assert_close("bore", seen, moved + 40.0 * 11.5e-6 * 25e-3, 1e-6);
    let hoop = probes.column("bore_stress_tt_pa")[0];
    let tube = 207e9 * moved / 25e-3;
    assert!((0.8..1.2).contains(&(hoop / tube)), "{hoop} {tube}");
    // Warm all through and clamped: no force changes, so the stress is that of fit and preload alone.
    dir.run(
        "cold",
        &[
            "--set",
            "effects.temperature=none",
            "--set",
            "effects.radial_force=none",
        ],
    );
    let cold = Table::read(&dir, "cold/probes.csv").column("bore_stress_tt_pa")[0];
    assert_close("cold", hoop, cold, 1e-9);
}

/// Wrong: a run that is cut would go on with another groove than it had.
#[test]
fn a_mounted_motion_continues_bit_for_bit() {
    let dir = small_motion();
    let tables = "[effects.fit.inner]\ninterference = \"10 um\"\n\n[[effects.seat_form]]\nring = \"inner\"\norder = 2\n\
                  amplitude = \"1 um\"\n\n[dynamic]";
    dir.write("scene.toml", dir.text("scene.toml").replace("[dynamic]", tables));
    dir.run("whole", &[]);
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    resumed(&dir, &["cut", "--step", "7", "--threads", "2"]);
    assert_same_run(&dir, "whole", "cut");
    let plain = ["--set", "effects.fit=none", "--set", "effects.seat_form=none"];
    dir.run("plain", &plain);
    let forces = |out: &str| dir.text(&format!("{out}/balls.csv"));
    assert!(forces("plain") != forces("whole"), "the fit must change forces");
}

/// Wrong: a run through a schedule of temperatures would go on with other work or another groove after a cut, or close
/// its ledger only without it.
#[test]
fn a_motion_that_warms_up_continues_bit_for_bit() {
    let dir = small_motion();
    let warm = dir.text("scene.toml").replace(
        "density = \"7800 kg/m3\"\n",
        "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n",
    );
    let tables = "[effects.temperature]\nouter = \"20 degC\"\nballs = \"20 degC\"\n\
                  inner.ramp = { from = \"20 degC\", to = \"40 degC\", start = \"0 s\", duration = \"250 us\" }\n\n\
                  [dynamic]";
    dir.write("scene.toml", warm.replace("[dynamic]", tables));
    let said = dir.run("whole", &[]);
    let clearance = "mounted 27.00 um, 14.93 deg; at the start 27.00 um, 14.93 deg; at the end";
    assert!(
        said.stderr.contains(clearance) || said.stdout.contains(clearance),
        "{}",
        said.stderr
    );
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    resumed(&dir, &["cut", "--step", "7", "--threads", "2"]);
    assert_same_run(&dir, "whole", "cut");
    let energy = Table::read(&dir, "whole/energy.csv");
    let (work, defect, total) = (
        energy.column("temperature_work_j"),
        energy.column("defect_j"),
        energy.column("total_j"),
    );
    let last = work.len() - 1;
    assert!(work[last].abs() > 1e-6, "{work:?}");
    assert!(
        defect[last].abs() < 1e-8 * total[last],
        "{} of {}",
        defect[last],
        total[last]
    );
    dir.run("cold", &["--set", "effects.temperature=none"]);
    assert!(!dir.text("cold/energy.csv").contains("temperature_work_j"));
}

/// Wrong: real surfaces would move under warm contacts without a line in the ledger for each.
#[test]
fn schedules_beside_real_surfaces_are_refused_in_motion() {
    let dir = small_motion();
    let warm = dir.text("scene.toml").replace(
        "density = \"7800 kg/m3\"\n",
        "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n",
    );
    dir.write("scene.toml", warm);
    let outcome = dir.raceway(&[
        "run",
        "scene.toml",
        "--set",
        "contact.edges=true",
        "--set",
        "effects.temperature={outer=\"20 degC\", balls=\"20 degC\", inner={times=[\"0 s\", \"1 s\"], \
         values=[\"20 degC\", \"30 degC\"]}}",
    ]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let expected =
        "a moving bearing cannot have real surfaces ([[profiles.*]], contact.edges) beside temperatures";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
}

/// Wrong: a ring whose temperature varies would show the stress of its displacement alone. Warm at the bore and cold
/// outside it is pressed at the bore and pulled at the shoulder.
#[test]
fn uneven_temperatures_are_in_the_stress_that_is_shown() {
    let dir = fitted();
    let probe = "[probes.node.shoulder]\nring = \"inner\"\nazimuth = \"0 deg\"\nr = \"30.2 mm\"\nz = \"8 mm\"\n\n\
                 [static]";
    dir.write("scene.toml", dir.text("scene.toml").replace("[static]", probe));
    let uneven =
        "effects.temperature.inner={radii=[\"25 mm\", \"30.2 mm\"], values=[\"50 degC\", \"30 degC\"]}";
    let settings = ["effects.fit=none", "inner.support=mean_motion", uneven];
    let set: Vec<&str> = settings.iter().flat_map(|s| ["--set", s]).collect();
    dir.run("out", &set);
    let probes = Table::read(&dir, "out/probes.csv");
    let [bore, shoulder] = ["bore", "shoulder"].map(|name| probes.column(&format!("{name}_stress_tt_pa"))[0]);
    // E alpha (T_mean - T) is -24 and 24 MPa; the contacts of 2 kN add some MPa, and bending takes a part.
    assert!((-45e6..-10e6).contains(&bore), "{bore}");
    assert!((10e6..45e6).contains(&shoulder), "{shoulder}");
}

/// Wrong: a ring that its speed lifts off its shaft would be computed as one that sits, or with a code of success.
#[test]
fn a_fit_that_lets_go_is_refused() {
    let dir = fitted();
    let fast = "speed.inner=40000 rpm";
    let outcome = dir.raceway(&[
        "run",
        "scene.toml",
        "--set",
        fast,
        "--set",
        "effects.ball_centrifugal={}",
    ]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let start = "the inner ring lets go of its partner at 26";
    assert!(outcome.stderr.contains(start), "{}", outcome.stderr);
}

/// Wrong: films would not reach tables and summary, or a film thinner than the surfaces are rough go unsaid.
#[test]
fn films_reach_tables_and_warnings() {
    let dir = Dir::with_meshes();
    let oil = "lubricant={viscosity=\"40 mPa s\", pressure_coefficient=\"22 1/GPa\", \
               roughness={inner=\"0.5 um\", outer=\"0.1 um\", balls=\"0.1 um\"}}";
    let said = dir.run("out", &["--set", oil, "--set", "speed.inner=1800 rpm"]);
    let found = summary(&dir, "out");
    let balls = Table::read(&dir, "out/balls.csv");
    let thin = |column: &str| balls.column(column).into_iter().fold(f64::INFINITY, f64::min);
    assert_close(
        "inner",
        number(&found, "/film/inner/minimum_m"),
        thin("inner_film_minimum_m"),
        1e-14,
    );
    let lambda = number(&found, "/film/inner/lambda");
    let central = number(&found, "/film/inner/central_m");
    assert_close("lambda", lambda, central / (0.5e-6f64.hypot(0.1e-6)), 1e-12);
    assert!(lambda < 1.0 && number(&found, "/film/outer/lambda") > 1.0);
    let warning =
        "warning: the film of the inner raceway is thinner than the surfaces are rough: lambda is 0.8";
    assert!(
        said.stdout.contains(warning) || said.stderr.contains(warning),
        "{}",
        said.stdout
    );
}
