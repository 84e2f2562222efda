//! Real surfaces and spectra through the whole program, with rigid rings.

use crate::util::tables::Table;
use crate::util::{Dir, RIGID, with_line};

/// A motion of 0.1 s at 1800 rpm with heavy shaft and damping.
const MOTION: &str = "[speed]\ninner = \"1800 rpm\"\n\n[effects.contact_damping]\ncoefficient = \"200 N s/m\"\n\
                      full_approach = \"3 um\"\n\n[dynamic]\nduration = \"0.1 s\"\nstep = \"20 us\"\n\
                      output_every = 5000\nintegrator = \"average_acceleration\"\n\
                      contact = \"discrete_gradient\"\nledger_tolerance = 1e-6\n";

fn spall(ring: &str) -> String {
    format!(
        "[[profiles.spall]]\nring = \"{ring}\"\nazimuth = \"10 deg\"\ngroove_angle = \"18 deg\"\nlength = \"0.5 mm\"\n\
         width = \"4 mm\"\ndepth = \"50 um\"\nedge = \"0.1 mm\"\n\n"
    )
}

/// Runs a motion over a spall into `out`.
fn rolled(ring: &str) -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &(spall(ring) + MOTION)));
    let outcome = dir.raceway(
        &[
            &["run", "scene.toml", "--out", "out", "--set", "shaft.mass=2 kg"],
            &RIGID[..],
        ]
        .concat(),
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    dir
}

/// Largest amplitude of a spectrum within some Hz of a frequency.
fn near(table: &Table, frequency: f64, width: f64) -> f64 {
    let amplitudes = table.column("amplitude_m_per_s2");
    let lines = table.column("frequency_hz");
    let found = lines
        .iter()
        .zip(&amplitudes)
        .filter(|(f, _)| (*f - frequency).abs() <= width);
    found.map(|(_, a)| *a).fold(0.0, f64::max)
}

/// Wrong: a spall on the outer ring would not ring at the ball pass frequency of that ring, 233.89 Hz at 14.93 deg, or
/// at another one: its line and multiples stand out of all between them.
#[test]
fn an_outer_spall_shows_lines_at_bpfo() {
    let dir = rolled("outer");
    let outcome = dir.raceway(&["spectrum", "out", "--probe", "z_m", "--acceleration"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("BPFO      233.888 Hz"),
        "{}",
        outcome.stdout
    );
    assert!(
        outcome.stdout.contains("BPFI      306.112 Hz"),
        "{}",
        outcome.stdout
    );
    let table = Table::read(&dir, "out/spectrum_z_acceleration.csv");
    let bpfo = 233.89;
    for k in 1..=4 {
        let line = near(&table, k as f64 * bpfo, 12.0);
        let between = near(&table, (k as f64 + 0.5) * bpfo, 60.0);
        assert!(line > 5.0 * between, "{k}: {line} {between}");
    }
    let again = dir.raceway(&["spectrum", "out", "--probe", "z_m", "--envelope", "1000..4000"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    assert!(
        dir.text("out/spectrum_z_envelope.csv")
            .starts_with("frequency_hz,envelope_amplitude_m\n")
    );
    assert!(dir.text("out/figures/spectrum_z_envelope.svg").contains("BPFO"));
    // The ledger has the work of profiles, and closes.
    let energy = Table::read(&dir, "out/energy.csv");
    assert!(energy.column("profile_work_j").iter().any(|w| w.abs() > 1e-6));
}

/// Wrong: a spectrum would be made of what has none, or write over a file of the user.
#[test]
fn spectra_refuse_what_they_cannot_show() {
    let scene = with_line("[static]", "[static]", MOTION).replace("0.1 s", "1 ms");
    let dir = Dir::with_scene(&scene);
    let outcome = dir.raceway(
        &[
            &["run", "scene.toml", "--out", "out", "--set", "shaft.mass=2 kg"],
            &RIGID[..],
        ]
        .concat(),
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let refused = |arguments: &[&str], text: &str| {
        let outcome = dir.raceway(&[&["spectrum"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(text), "{arguments:?}: {}", outcome.stderr);
    };
    refused(
        &["nowhere", "--probe", "x_m"],
        "nowhere is no folder; expected the results of a motion",
    );
    refused(
        &["out", "--probe", "w"],
        "out has no signal \"w\"; expected a column of probes.csv or shaft.csv: x_m, y_m",
    );
    refused(
        &["out", "--probe", "x_m", "--from", "0.9e-3"],
        "expected 16 at least",
    );
    refused(
        &["out", "--probe", "x_m", "--envelope", "9..2"],
        "expected two frequencies in Hz such as 2000..8000",
    );
    refused(
        &["out", "--probe", "x_m", "--envelope", "1e3..1e6"],
        "the steps of the run show 25000.0 Hz at most",
    );
    refused(
        &["out", "--probe", "tilt_x_rad", "--acceleration"],
        "tilt_x_rad is no displacement, in m",
    );
    dir.write("out/spectrum_x.csv", "mine");
    refused(
        &["out", "--probe", "x_m"],
        "out/spectrum_x.csv was not written by this command",
    );
    assert_eq!(dir.text("out/spectrum_x.csv"), "mine");
}

/// Wrong: edges and profiles that fit no ring would be taken; a rigid ring without a section has no shoulders, and a
/// spall beyond them is none.
#[test]
fn surfaces_that_fit_no_ring_are_refused() {
    let check = |text: &str, set: &[&str]| {
        let dir = Dir::with_scene(text);
        let outcome = dir.raceway(&[&["check", "scene.toml"], &RIGID[..], set].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stdout);
        outcome.stderr
    };
    let far = with_line(
        "[static]",
        "[static]",
        &(spall("outer").replace("18 deg", "80 deg").replace("4 mm", "1 mm") + "[static]"),
    );
    let sections = "[inner.section]\nshoulder_diameters = [\"60.4 mm\", \"60.4 mm\"]\nelement = \"hex8\"\n\
                    sectors = 18\n\
                    groove_elements = 4\nthickness_elements = 1\nshoulder_elements = 1\n\n";
    let outer = sections.replace("inner", "outer").replace("60.4", "68.6");
    let with_sections = far.replacen("[static]", &format!("{sections}{outer}[static]"), 1);
    let bare = with_line("[static]", "[static]", "[static]");
    let said = check(&bare, &["--set", "contact.edges=true"]);
    let ends = "contact.edges is true, but nothing says where the groove of the rigid inner ring ends";
    assert!(said.contains(ends), "{said}");
    let said = check(&with_sections, &[]);
    let beyond = "spall 1 of the outer ring lies at the groove angle 80.00 deg beyond the groove";
    assert!(said.contains(beyond), "{said}");
    let sharp = spall("inner")
        .replace("0.5 mm", "0.02 mm")
        .replace("edge = \"0.1 mm\"", "");
    let fine = sharp + "[static]";
    let said = check(&with_line("[static]", "[static]", &fine), &[]);
    assert!(
        said.contains("the profiles of the inner ring need a grid of more than 20 million points"),
        "{said}"
    );
}
