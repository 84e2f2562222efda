//! Real surfaces and spectra through the whole program, with rigid rings.

use crate::util::tables::Table;
use crate::util::{Dir, RIGID, lockstep, with_line};

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
    near_in(table, "amplitude_m_per_s2", frequency, width)
}

/// The same in a column.
pub fn near_in(table: &Table, column: &str, frequency: f64, width: f64) -> f64 {
    let amplitudes = table.column(column);
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
    let figure = dir.text("out/figures/spectrum_z_envelope.svg");
    assert!(figure.contains("BPFO") && figure.contains("Envelope of z from 1000 Hz to 4000 Hz"));
    // The ledger has the work of profiles, and closes.
    let energy = Table::read(&dir, "out/energy.csv");
    assert!(energy.column("profile_work_j").iter().any(|w| w.abs() > 1e-6));
}

/// Largest axial amplitude, m, at a line of the bearing and at its sidebands 30 Hz away, and what the command said: a
/// spall of 1 mm on a ring at 1800 rpm under a radial load of 1 kN, which stands or turns with the shaft. Equilibria
/// in time, without inertia, so that nothing but the loads of the balls shapes the pulses; 5 Hz of resolution.
fn line_and_sidebands(ring: &str, load: &str, line: f64) -> ([f64; 2], String) {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"0.2 s\"\nstep = \"100 us\"\n\
                  output_every = 2000\n";
    let spall = spall(ring).replace("0.5 mm", "1 mm");
    let scene = with_line("[static]", "[static]", &(spall + motion));
    assert!(scene.contains(RADIAL));
    let dir = Dir::with_scene(&scene.replace(RADIAL, load));
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let outcome = dir.raceway(&["spectrum", "out", "--probe", "z_m"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        dir.text("out/figures/spectrum_z.svg")
            .contains("short: sidebands")
    );
    let table = Table::read(&dir, "out/spectrum_z.csv");
    let at = |frequency: f64| near_in(&table, "amplitude_m", frequency, 10.0);
    ([at(line), at(line - 30.0).min(at(line + 30.0))], outcome.stdout)
}

/// Wrong: lines would not tell which ring is damaged. Under a load that stands an outer spall always meets the same
/// load: BPFO without sidebands; an inner one goes through it once a turn: BPFI with sidebands at the speed of the
/// shaft. Under a load that turns with the shaft (unbalance) both are exchanged. (Randall and Antoni, MSSP 25 (2011)
/// 485.) The marked lines have them alike.
#[test]
fn the_ring_that_turns_through_the_load_has_sidebands() {
    // 1 kN at 188.5 rad/s.
    let turns = "[effects.unbalance]\nmass = \"1 kg\"\neccentricity = \"28.145 mm\"\n";
    for (ring, load, line, name, has_sidebands) in [
        ("outer", RADIAL, 233.89, "BPFO", false),
        ("inner", RADIAL, 306.11, "BPFI", true),
        ("outer", turns, 233.89, "BPFO", true),
        ("inner", turns, 306.11, "BPFI", false),
    ] {
        let ([own, side], said) = line_and_sidebands(ring, load, line);
        assert!(own > 5e-8, "{ring} {load}: {own}");
        let share = side / own;
        let holds = if has_sidebands { share > 0.04 } else { share < 0.01 };
        assert!(holds, "{ring} {load}: {share}");
        let mut after = said.lines().skip_while(|text| !text.contains(name)).skip(1);
        let is_marked = after.next().is_some_and(|text| text.trim().starts_with("side -"));
        // An inner spall is marked under any load: one that stands is never quite absent.
        assert_eq!(is_marked, has_sidebands || ring == "inner", "{said}");
    }
}

/// Wrong: inertia would hide the sidebands of an inner spall: in motion its line stands out of all between, and so do
/// its sidebands.
#[test]
fn an_inner_spall_in_motion_has_sidebands() {
    let dir = rolled("inner");
    let outcome = dir.raceway(&["spectrum", "out", "--probe", "z_m", "--acceleration"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = Table::read(&dir, "out/spectrum_z_acceleration.csv");
    let line = near(&table, 306.11, 8.0);
    let [low, high] = [-30.0, 30.0].map(|off| near(&table, 306.11 + off, 8.0));
    let between = near(&table, 306.11 + 150.0, 40.0);
    assert!(line > 5.0 * low.max(high), "{line} {low} {high}");
    assert!(low.min(high) > 3.0 * between, "{low} {high} {between}");
}

const RADIAL: &str = "[effects.radial_force]\nvalue = \"1 kN\"\ndirection = \"0 deg\"\n";

/// Wrong: a ball of another size would not be seen, or elsewhere than at the frequency of the cage: it comes through
/// the loaded zone once a turn of the cage, 12.994 Hz. Equal balls leave no line there.
#[test]
fn one_larger_ball_shows_at_the_frequency_of_the_cage() {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"1 s\"\nstep = \"1 ms\"\n\
                  output_every = 1000\n";
    let at_cage = |first: &str| {
        let others = ", \"0 um\"".repeat(17);
        let balls = format!("[bearing.ball_diameters]\ndeviations = [\"{first}\"{others}]\n\n");
        let dir = Dir::with_scene(&with_line("[static]", "[static]", &(balls + motion)));
        let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let outcome = dir.raceway(&["spectrum", "out", "--probe", "x_m"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let table = Table::read(&dir, "out/spectrum_x.csv");
        [12.994, 18.0].map(|frequency| near_in(&table, "amplitude_m", frequency, 2.0))
    };
    let [line, beside] = at_cage("1 um");
    assert!(line > 1e-8 && line > 100.0 * beside, "{line} {beside}");
    let [line, _] = at_cage("0 um");
    assert!(line < 1e-12, "{line}");
}

/// Wrong: an elastic ring would be as dumb as a rigid one. Waves of order 2 on the inner ring move no rigid bearing
/// under thrust, nor the shaft between elastic rings. But the balls carry their pattern round, twice a turn of the
/// shaft, and material points of the outer ring follow.
#[test]
fn an_oval_ring_moves_material_points_of_elastic_rings_alone() {
    // 31.25 turns a second: 32 steps a turn.
    let motion = "[speed]\ninner = \"1875 rpm\"\n\n[quasi_static]\nduration = \"32 ms\"\nstep = \"1 ms\"\n\
                  output_every = 32\n\n[probes.node.p]\nring = \"outer\"\nazimuth = \"40 deg\"\n\
                  r = \"38.5 mm\"\nz = \"1 mm\"\n\n";
    let waves = "[[profiles.waviness]]\nring = \"inner\"\norder = 2\namplitude = \"1 um\"\n";
    let twice_a_turn = |waves: &str| {
        let dir = Dir::with_meshes();
        let scene = with_line("[static]", "[static]", &(motion.to_string() + waves));
        let scene = scene
            .replace(RADIAL, "")
            .replace("\"clamped\"", "\"mean_motion\"");
        dir.write("scene.toml", scene);
        let outcome = dir.raceway(&["run", "scene.toml", "--out", "out"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let amplitude = |table: &Table, column: &str| {
            let values = &table.column(column)[1..=32];
            let part = |shift: f64| -> f64 {
                let wave = |i: usize| (std::f64::consts::TAU * i as f64 / 16.0 + shift).cos();
                values.iter().enumerate().map(|(i, v)| v * wave(i)).sum::<f64>() / 16.0
            };
            part(0.0).hypot(part(0.5 * std::f64::consts::PI))
        };
        let [probes, shaft] = ["probes", "shaft"].map(|name| Table::read(&dir, &format!("out/{name}.csv")));
        [
            amplitude(&probes, "p_displacement_r_m"),
            amplitude(&shaft, "x_m").max(amplitude(&shaft, "z_m")),
        ]
    };
    let [point, shaft] = twice_a_turn(waves);
    let [smooth, _] = twice_a_turn("");
    assert!(point > 1e-8 && point > 20.0 * smooth, "{point} {smooth}");
    assert!(shaft < 0.02 * point, "{shaft} {point}");
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
        "expected two frequencies in Hz, the lower one first, such as 2000..8000",
    );
    refused(
        &["out", "--probe", "x_m", "--envelope", "1e3..1e6"],
        "the steps of the run show 25000 Hz at most",
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

/// Wrong: a user would look for the length of a spall, or for waves, in steps that skip them. At 1800 rpm contacts run
/// over the outer ring of the 7010C at 81.6 rad/s: 0.5 mm take 165 us.
#[test]
fn steps_that_skip_a_surface_are_warned_of() {
    let dent = "[[profiles.dent]]\nring = \"inner\"\nazimuth = \"0 deg\"\ngroove_angle = \"18 deg\"\n\
                diameter = \"0.2 mm\"\ndepth = \"5 um\"\n\n";
    let waves = "[[profiles.waviness]]\nring = \"inner\"\norder = 400\namplitude = \"0.1 um\"\n\n";
    let ball = "[[profiles.waviness]]\nball = 3\norder = 30\namplitude = \"0.1 um\"\n\n";
    let check = |step: &str| {
        let tables = spall("outer") + dent + waves + ball + &MOTION.replace("20 us", step);
        let dir = Dir::with_scene(&with_line("[static]", "[static]", &tables));
        let outcome = dir.raceway(&[&["check", "scene.toml"], &RIGID[..]].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout
    };
    let said = check("20 us");
    for part in [
        "a ball passes spall 1 of the outer ring in 165.",
        "expected 20 or more: dynamic.step of 8.2 us or less",
        "a ball passes dent 1 of the inner ring in ",
        "a ball passes a wave of order 400 of the inner ring in 147.0",
        // An ellipse of 0.13 mm on both sides, and waves of 0.45 mm.
        "a ball passes the edge of spall 1 of the outer ring within ",
        "waves of order 400 of the inner ring are felt with 0.",
        // 668.7 rad/s, which is 106.43 Hz, and 30 waves.
        "a raceway passes a wave of order 30 of ball 3 in 313.2 us",
    ] {
        assert!(said.contains(part), "{said}\nhas no\n{part}");
    }
    let said = check("2 us");
    assert!(
        !said.contains("a ball passes") && !said.contains("a raceway passes"),
        "{said}"
    );
}

/// Cells of a column of `out/balls.csv`; none where it has no such column.
fn cells(dir: &Dir, name: &str) -> Vec<String> {
    let text = dir.text("out/balls.csv");
    let mut rows = text.lines().map(|line| line.split(',').map(str::to_string));
    let place = rows.next().unwrap().position(|head| head == name);
    place.map_or_else(Vec::new, |place| {
        rows.map(|mut row| row.nth(place).unwrap()).collect()
    })
}

/// Wrong: the table would call an ellipse that a shoulder cuts Hertz's, or a whole one not, or have the columns where
/// no scene asks for edges. The ellipses outside reach from 8 to 31 deg, and the groove ends at 26 or at 65 deg. The
/// peak pressure of a cut one would be that of a whole one under its force: its middle touches, so that it goes with
/// the root of the approach as Hertz's does. Contacts of one another differ by the round-off of approaches, 1e-14.
#[test]
fn the_table_says_which_ellipses_a_shoulder_cuts() {
    let section = |ring: &str, diameter: &str| {
        format!(
            "[{ring}.section]\nshoulder_diameters = [\"{diameter}\", \"{diameter}\"]\nelement = \"hex8\"\n\
             sectors = 18\ngroove_elements = 4\nthickness_elements = 1\nshoulder_elements = 1\n\n"
        )
    };
    let (mut per_root, mut concentrations) = (Vec::new(), Vec::new());
    for (shoulder, edges, expected) in [
        ("73.08 mm", true, Some("edge")),
        ("68.6 mm", true, Some("hertz")),
        ("73.08 mm", false, None),
    ] {
        let sections = section("inner", "60.4 mm") + &section("outer", shoulder) + "[static]";
        let dir = Dir::with_scene(&with_line("[static]", "[static]", &sections));
        dir.run(
            "out",
            &[&RIGID[..], &["--set", &format!("contact.edges={edges}")]].concat(),
        );
        let first = |name: &str| -> f64 { cells(&dir, &format!("outer_{name}"))[0].parse().unwrap() };
        per_root.push(first("peak_pressure_pa") / first("approach_m").sqrt());
        let concentration = first("peak_pressure_pa") / first("force_n").cbrt();
        let [inner, outer] = ["inner_ellipse", "outer_ellipse"].map(|name| cells(&dir, name));
        let all = |texts: &[String], word: &str| texts.len() == 18 && texts.iter().all(|text| text == word);
        match expected {
            Some(word) => assert!(all(&outer, word) && all(&inner, "hertz"), "{inner:?} {outer:?}"),
            None => assert!(inner.is_empty() && outer.is_empty(), "{inner:?} {outer:?}"),
        }
        concentrations.push(concentration);
    }
    let [cut, whole, hertz] = per_root[..] else {
        unreachable!()
    };
    assert!(
        (cut / whole - 1.0).abs() < 1e-12 && (whole / hertz - 1.0).abs() < 1e-12,
        "{per_root:?}"
    );
    // A third of the half-width is missing: 0.96 of the force is left, and its lateral part grows.
    let more = concentrations[0] / concentrations[1];
    assert!((1.005..1.1).contains(&more), "{more}");
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
    let dent = "[[profiles.dent]]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"-80 deg\"\n\
                diameter = \"0.3 mm\"\ndepth = \"5 um\"\n\n[static]";
    let dented = with_line("[static]", "[static]", dent);
    let dented = dented.replacen("[static]", &format!("{sections}{outer}[static]"), 1);
    let said = check(&dented, &[]);
    let beyond = "dent 1 of the outer ring lies at the groove angle -80.00 deg beyond the groove";
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

/// Wrong: with sectors, which do not tell where a groove ends, a spall could be missing of the mesh and of the profile,
/// and so could the depth of a table with any solver. Behind the hole they are taken.
#[test]
fn marks_and_depths_where_the_mesh_has_no_raceway_are_refused_by_every_solver() {
    let hole = "\n[[outer.cut]]\nazimuth = [\"-10 deg\", \"10 deg\"]\nz = [\"-3 mm\", \"3 mm\"]\n\n";
    let dent = |azimuth: &str| {
        format!(
            "[[profiles.dent]]\nring = \"outer\"\nazimuth = \"{azimuth}\"\ngroove_angle = \"10 deg\"\n\
             diameter = \"0.3 mm\"\ndepth = \"5 um\"\n"
        )
    };
    let table = |azimuth: f64| {
        let mut text = "azimuth_deg,groove_angle_deg,height_um\n".to_string();
        for i in 0..72 {
            let at = 5.0 * f64::from(i);
            let height = if at == azimuth { -3.0 } else { 0.5 };
            text += &format!("{at},0,{height}\n");
        }
        text
    };
    let dir = lockstep::small_motion();
    let scene = dir.text("scene.toml") + hole;
    let tables = "[[profiles.table]]\nring = \"outer\"\nfile = \"roundness.csv\"\n";
    let over = "of the outer ring lies where its mesh has no raceway: it would count twice; leave out the \
                [[outer.cut]]";
    for backend in ["auto", "sparse", "sector"] {
        let check = |text: &str| {
            dir.write("scene.toml", scene.clone() + text);
            dir.raceway(&[
                "check",
                "scene.toml",
                "--set",
                &format!("solver.backend={backend}"),
            ])
        };
        let refused = |text: &str, what: &str, remedy: &str| {
            let outcome = check(text);
            assert_eq!(outcome.code, Some(2), "{backend}: {}", outcome.stdout);
            let said = format!("{what} {over}{remedy}");
            assert!(outcome.stderr.contains(&said), "{backend}: {}", outcome.stderr);
        };
        let taken = |text: &str| {
            let outcome = check(text);
            assert_eq!(outcome.code, Some(0), "{backend}: {}", outcome.stderr);
        };
        // From 2 to 48 deg: between the hole and its middle there is raceway.
        let long = spall("outer")
            .replace("10 deg", "25 deg")
            .replace("0.5 mm", "30 mm");
        refused(&long, "spall 1", " or the [[profiles.spall]]");
        refused(&dent("3 deg"), "dent 1", " or the [[profiles.dent]]");
        taken(&dent("40 deg"));
        dir.write("roundness.csv", table(5.0));
        refused(
            tables,
            "the depth of table 1",
            ", or give heights of 0 or more there",
        );
        dir.write("roundness.csv", table(40.0));
        taken(tables);
    }
}
