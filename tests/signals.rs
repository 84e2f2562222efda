//! Tachometers, order spectra, exported signals and labelled sets, through the whole program with rigid rings.

use std::f64::consts::TAU;

use crate::util::tables::Table;
use crate::util::{Dir, Files, RIGID, with_line};

/// A run-up from 1200 to 3600 rpm within 0.1 s, of a heavy damped shaft over an outer spall, with a tachometer.
const RUN_UP: &str = "[speed]\ninner = { ramp = { from = \"1200 rpm\", to = \"3600 rpm\", \
    start = \"0 ms\", duration = \"100 ms\" } }\n\n\
    [probes.tachometer.shaft]\nring = \"inner\"\n\n\
    [probes.contact.ball]\nball = 0\nring = \"outer\"\n\n\
    [[profiles.spall]]\nring = \"outer\"\nazimuth = \"10 deg\"\ngroove_angle = \"18 deg\"\nlength = \"0.5 mm\"\n\
    width = \"4 mm\"\ndepth = \"50 um\"\nedge = \"0.1 mm\"\n\n\
    [effects.contact_damping]\ncoefficient = \"200 N s/m\"\nfull_approach = \"3 um\"\n\n\
    [dynamic]\nduration = \"100 ms\"\nstep = \"20 us\"\noutput_every = 5000\nintegrator = \"average_acceleration\"\n\
    contact = \"discrete_gradient\"\nledger_tolerance = 1e-6\n";

fn ran(analysis: &str) -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", analysis));
    let run = ["run", "scene.toml", "--out", "out", "--set", "shaft.mass=2 kg"];
    let outcome = dir.raceway(&[&run, &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    dir
}

/// Wrong: a tachometer would not show the angle of its ring, or a spall's line would be smeared over the speeds of a
/// run-up, over the frequency without a word: over orders it stands at the balls that pass per turn of the shaft,
/// 18 (1 - 0.43313), and stands out.
#[test]
fn a_spall_under_a_rising_speed_is_a_line_over_orders() {
    let dir = ran(RUN_UP);
    let probes = Table::read(&dir, "out/probes.csv");
    let (times, angles) = (probes.column("time_s"), probes.column("shaft_angle_rad"));
    for (t, angle) in times.iter().zip(&angles) {
        let exact = TAU * (20.0 * t + 0.5 * 400.0 * t * t);
        assert!((angle - exact).abs() < 1e-12 * exact.max(1.0), "{angle} {exact}");
    }
    let both = ["spectrum", "out", "--probe", "z_m", "--acceleration"];
    let outcome = dir.raceway(&[&both[..], &["--orders", "shaft"]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("BPFO        7.796:"),
        "{}",
        outcome.stdout
    );
    let table = Table::read(&dir, "out/spectrum_z_acceleration_orders.csv");
    let (orders, amplitudes) = (table.column("order"), table.column("amplitude_m_per_s2"));
    let largest = |from: f64, to: f64| {
        let of = orders
            .iter()
            .zip(&amplitudes)
            .filter(|(o, _)| (from..to).contains(*o));
        of.map(|(_, a)| *a).fold(0.0, f64::max)
    };
    let bpfo = 7.796;
    // At the second multiple the run-up passes a natural frequency.
    let (line, beside) = (
        largest(bpfo - 0.5, bpfo + 0.5),
        largest(bpfo + 1.5, 2.0 * bpfo - 1.5),
    );
    assert!(line > 3.0 * beside, "{line} {beside}");
    assert!(
        dir.text("out/figures/spectrum_z_acceleration_orders.svg")
            .contains("BPFO")
    );
    // Over the frequency the lines named are those of a mean speed that the run-up passes in a moment.
    let smeared = dir.raceway(&both);
    let warning = "warning: the inner ring turns at 1206 to 3594 rpm in this time, so lines smear";
    assert!(smeared.stderr.contains(warning), "{}", smeared.stderr);
    assert!(!outcome.stderr.contains("smear"), "{}", outcome.stderr);
    let refused = dir.raceway(&[&both[..], &["--upto", "nan"]].concat());
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.stderr.contains("--upto is NaN; expected more than 0"),
        "{}",
        refused.stderr
    );
    // Steps at the highest speed show orders up to half their number a turn: 60 turns a second, 50 000 steps.
    assert!(*orders.last().unwrap() < 0.5 * 50_000.0 / 60.0 + 1.0);
}

/// Wrong: a signal in other hands would have another scale or rate, or replace a file of the user.
#[test]
fn a_signal_goes_out_as_wav_and_csv() {
    let dir = ran(&RUN_UP.replace("100 ms\"\nstep", "2 ms\"\nstep"));
    let arguments = ["spectrum", "out", "--probe", "ball_force_n", "--wav", "--csv"];
    let outcome = dir.raceway(&arguments);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("signal_ball_force.wav, its scale in"),
        "{}",
        outcome.stdout
    );
    let probes = Table::read(&dir, "out/probes.csv");
    let (times, forces) = (probes.column("time_s"), probes.column("ball_force_n"));
    let text = dir.text("out/signal_ball_force.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|l| l.split(',').map(|c| c.parse().unwrap()).collect())
        .collect();
    assert!(text.starts_with("time_s,ball_force_n\n") && rows.len() == forces.len());
    for (row, (time, force)) in rows.iter().zip(times.iter().zip(&forces)) {
        assert!((row[0] - time).abs() < 1e-15 && row[1] == *force);
    }
    let about = dir.text("out/signal_ball_force.wav.toml");
    let number = |key: &str| -> f64 {
        let line = about
            .lines()
            .find_map(|line| line.strip_prefix(&format!("{key} = ")));
        line.unwrap_or_else(|| panic!("{key} in {about}"))
            .parse()
            .unwrap()
    };
    assert!(
        (number("samples_per_second") - 50_000.0).abs() < 1e-6
            && number("samples_per_second_of_the_wav") == 50_000.0
    );
    // A WAV file of one channel: at 20 its format 3, floats; at 24 its rate; samples are the last bytes.
    let wav = std::fs::read(dir.path("out/signal_ball_force.wav")).unwrap();
    assert_eq!((&wav[..4], &wav[8..12]), (&b"RIFF"[..], &b"WAVE"[..]));
    assert_eq!(u32::from_le_bytes(wav[24..28].try_into().unwrap()), 50_000);
    let samples = wav[wav.len() - 4 * forces.len()..].chunks_exact(4);
    let mut largest = 0.0f64;
    for (sample, force) in samples.zip(&forces) {
        let sample = f64::from(f32::from_le_bytes(sample.try_into().unwrap()));
        largest = largest.max(sample.abs());
        let back = number("offset") + number("scale") * sample;
        assert!((back - force).abs() <= 1e-7 * number("scale"), "{back} {force}");
    }
    assert_eq!(largest, 1.0);
    assert_eq!(dir.raceway(&arguments).code, Some(0), "own files are replaced");
    std::fs::remove_file(dir.path("out/signal_ball_force.wav.toml")).unwrap();
    dir.write("out/signal_ball_force.wav", "mine");
    let refused = dir.raceway(&arguments);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused
            .stderr
            .contains("signal_ball_force.wav was not written by this command"),
        "{}",
        refused.stderr
    );
    assert_eq!(dir.text("out/signal_ball_force.wav"), "mine");
}

/// Wrong: a tachometer would be of a ring that stands, or orders be made without one.
#[test]
fn orders_need_a_ring_that_turns() {
    let dir = ran(&RUN_UP.replace("100 ms\"\nstep", "2 ms\"\nstep"));
    let refused = |arguments: &[&str], text: &str| {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stdout);
        assert!(outcome.stderr.contains(text), "{arguments:?}: {}", outcome.stderr);
    };
    refused(
        &["spectrum", "out", "--probe", "z_m", "--orders", "ball_force_n"],
        "ball_force_n is no angle; --orders needs a tachometer, from [probes.tachometer.NAME] of a scene",
    );
    refused(
        &["spectrum", "out", "--probe", "z_m", "--orders", "tacho"],
        "out has no signal \"tacho\"; expected a column of probes.csv: ball_force_x_n",
    );
    refused(
        &[
            &[
                "check",
                "scene.toml",
                "--set",
                "probes.tachometer.shaft.ring=outer",
            ],
            &RIGID[..],
        ]
        .concat(),
        "probes.tachometer.shaft.ring is \"outer\", but [speed] gives that ring no speed; expected a ring that turns",
    );
}

/// Wrong: lines over orders would be named where none stands, because the outer ring does not keep step.
#[test]
fn rings_that_do_not_keep_step_smear_orders() {
    let both = RUN_UP
        .replace("1200 rpm", "6000 rpm")
        .replace("3600 rpm", "18000 rpm")
        .replace("100 ms", "20 ms")
        .replace("[probes.tach", "outer = \"-5000 rpm\"\n\n[probes.tach");
    let spectrum = ["spectrum", "out", "--probe", "z_m", "--orders", "shaft"];
    let warning = "warning: the outer ring turns -0.8";
    let outcome = ran(&both).raceway(&spectrum);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(warning), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("so lines smear over orders too"),
        "{}",
        outcome.stderr
    );
    let in_step = both.replace(
        "\"-5000 rpm\"",
        "{ ramp = { from = \"-3000 rpm\", to = \"-9000 rpm\", start = \"0 ms\", duration = \"20 ms\" } }",
    );
    let outcome = ran(&in_step).raceway(&spectrum);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(!outcome.stderr.contains("smear"), "{}", outcome.stderr);
}

const STUDY: &str = r#"
title = "spalls"
scene = "scene.toml"
set = [
    "contact.mode = rigid", "inner.flexible = false", "outer.flexible = false", 'shaft.mass = "2 kg"',
    '''profiles.spall = [{ ring = "outer", azimuth = "10 deg", groove_angle = "18 deg", length = "{length} mm",
                           width = "4 mm", depth = "50 um", edge = "0.1 mm" }]''',
    'profiles.random = [{ ring = "outer", orders = [2, 40], amplitude = "0.05 um", slope = 2.0, seed = {seed} }]',
]
[signals]
columns = ["ball_force_n", "shaft_angle_rad"]
[[axes]]
name = "length"
values = [{ name = "0.5" }, { name = "1" }]
[[axes]]
name = "seed"
values = [{ name = "1" }, { name = "2" }]
[[quantities]]
name = "largest force"
unit = "N"
table = "probes.csv"
column = "ball_force_n"
take = "max"
"#;

/// Wrong: a learner would be given signals under the labels of other ones: every file has the columns of its run,
/// every
/// line the values of its point; other seeds and lengths give other signals.
#[test]
fn a_study_makes_a_labelled_set() {
    let dir = labelled();
    let outcome = dir.raceway(&["study", "study.toml", "--out", "out"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("4 labelled signals: "),
        "{}",
        outcome.stdout
    );
    let labels = dir.text("out/labels.csv");
    let lines: Vec<&str> = labels.lines().collect();
    assert_eq!(lines.len(), 5);
    assert_eq!(
        lines[0],
        "point,file,length,seed,samples,samples_per_second,largest force [N]"
    );
    let mut seen = Vec::new();
    for (point, (length, seed)) in [("0.5", "1"), ("0.5", "2"), ("1", "1"), ("1", "2")]
        .into_iter()
        .enumerate()
    {
        let file = format!("signals/{point:04}.csv");
        let cells: Vec<&str> = lines[point + 1].split(',').collect();
        assert_eq!(&cells[..5], &[&point.to_string(), &*file, length, seed, "101"]);
        let rate: f64 = cells[5].parse().unwrap();
        assert!((rate - 50_000.0).abs() < 1e-6);
        let own = Table::read(&dir, &format!("out/points/{point:04}/run/probes.csv"));
        let signal = Table::read(&dir, &format!("out/{file}"));
        for column in ["time_s", "ball_force_n", "shaft_angle_rad"] {
            assert_eq!(signal.column(column), own.column(column));
        }
        let summary = dir.text(&format!("out/points/{point:04}/point.json"));
        assert!(summary.contains(&format!("seed = {seed}")) && summary.contains(&format!("{length} mm")));
        seen.push(signal.column("ball_force_n"));
    }
    assert!(seen[0] != seen[1] && seen[0] != seen[2]);
    dir.write(
        "bad.toml",
        STUDY.replace("\"ball_force_n\", \"shaft", "\"no_n\", \"shaft"),
    );
    let refused = dir.raceway(&["study", "bad.toml", "--out", "out"]);
    assert_ne!(refused.code, Some(0));
    assert!(refused.stderr.contains("no_n"), "{}", refused.stderr);
    for (from, to, text) in [
        (
            "columns = [\"ball_force_n\", \"shaft_angle_rad\"]",
            "columns = []",
            "[signals] has no columns",
        ),
        (
            "[signals]\n",
            "[signals]\ntable = \"balls.csv\"\n",
            "[signals] has the table \"balls.csv\"; expected \"probes.csv\"",
        ),
    ] {
        dir.write("bad.toml", STUDY.replace(from, to));
        let refused = dir.raceway(&["study", "bad.toml", "--list"]);
        assert_eq!(refused.code, Some(2));
        assert!(refused.stderr.contains(text), "{}", refused.stderr);
    }
}

/// Scene and study of a labelled set of four short signals.
pub fn labelled() -> Dir {
    let analysis = RUN_UP.replace("100 ms\"\nstep", "2 ms\"\nstep");
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &analysis));
    dir.write("study.toml", STUDY);
    dir
}

/// Wrong: rows further apart than half a turn of the cage would be read as a slower cage, or lines beyond what rows
/// show pass for measured ones. 7010C at 18 000 rpm, a row every 6 ms: 0.78 turns of a cage of 0.433 shaft speeds.
#[test]
fn rows_turns_apart_have_the_lines_of_all_rows() {
    let dir = ran("[speed]\ninner = \"18000 rpm\"\n\n\
                   [dynamic]\nduration = \"96 ms\"\nstep = \"20 us\"\noutput_every = 4800\n\n\
                   [effects.contact_damping]\ncoefficient = \"200 N s/m\"\nfull_approach = \"3 um\"\n");
    let run = ["run", "scene.toml", "--out", "few", "--set", "shaft.mass=2 kg"];
    let few = ["--set", "output.tables_every=300"];
    let outcome = dir.raceway(&[&run, &RIGID[..], &few[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let lines = |out: &str| -> Vec<(String, f64, bool)> {
        let outcome = dir.raceway(&["spectrum", out, "--probe", "z_m"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let all = outcome.stdout.lines().filter(|line| line.starts_with("  "));
        let line = |line: &str| {
            let (name, rest) = line.trim().split_at(6);
            let place = rest.split_whitespace().next().unwrap().parse().unwrap();
            (name.trim().to_string(), place, line.ends_with("not resolved"))
        };
        all.map(line).collect()
    };
    let (all, few) = (lines("out"), lines("few"));
    let cage = all.iter().find(|line| line.0 == "cage").unwrap();
    assert!((cage.1 - 300.0 * 0.43313).abs() < 0.01 && !cage.2, "{cage:?}");
    let names = |lines: &[(String, f64, bool)]| lines.iter().map(|l| l.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&all), names(&few));
    for (of_all, of_few) in all.iter().zip(&few) {
        assert!((of_all.1 - of_few.1).abs() < 2e-3, "{of_all:?} {of_few:?}");
        // Rows 6 ms apart show up to 83 Hz.
        assert!(of_few.2, "{of_few:?}");
    }
}

/// Wrong: a spectrum, that of an envelope and that of a density would stop each other: the second would say that the
/// file of the first was not written by this command.
#[test]
fn kinds_of_spectra_have_files_of_their_own() {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"10 ms\"\nstep = \"100 us\"\n";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", motion));
    dir.run("out", &RIGID);
    let band = ["--envelope", "500..4000"];
    for more in [&[][..], &band, &["--density"], &band, &[]] {
        let outcome = dir.raceway(&[&["spectrum", "out", "--probe", "x_m", "--upto", "900"], more].concat());
        assert_eq!(outcome.code, Some(0), "{more:?}: {}", outcome.stderr);
    }
    for (kind, column) in [("", "amplitude_m"), ("_envelope", "envelope_amplitude_m")] {
        let table = dir.text(&format!("out/spectrum_x{kind}.csv"));
        assert!(table.starts_with(&format!("frequency_hz,{column}\n")), "{kind}");
    }
}

/// Wrong: what commands make of a run could only stand in its folder; two bands or spans would replace each other, or
/// `--out` the files of another run.
#[test]
fn what_is_made_of_a_run_goes_where_it_is_asked_for() {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"10 ms\"\nstep = \"100 us\"\n";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", motion));
    dir.run("out", &RIGID);
    let before = dir.snapshot();
    let arguments = [
        "spectrum", "out", "--probe", "x_m", "--upto", "900", "--wav", "--csv", "--out",
    ];
    let made = dir.raceway(&[&arguments[..], &["new/spectra"]].concat());
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    assert!(
        made.stdout
            .contains("spectrum_x.csv in new/spectra, figure in new/spectra/figures")
    );
    let names = [
        "spectrum_x.csv",
        "figures/spectrum_x.svg",
        "figures/spectrum_x.png",
        "signal_x.wav",
        "signal_x.wav.toml",
        "signal_x.csv",
    ];
    for name in names {
        assert!(dir.path("new/spectra").join(name).exists(), "{name}");
        // Any of them alone is in the way, and nothing is written beside it.
        let folder = format!("other_{}", name.replace('/', "_"));
        std::fs::create_dir_all(dir.path(&folder).join("figures")).unwrap();
        dir.write(&format!("{folder}/{name}"), "mine");
        let refused = dir.raceway(&[&arguments[..], &[&folder]].concat());
        assert_eq!(refused.code, Some(2), "{name}: {}", refused.stdout);
        assert!(refused.stderr.contains(name), "{name}: {}", refused.stderr);
        assert_eq!(dir.text(&format!("{folder}/{name}")), "mine");
        let beside = std::fs::read_dir(dir.path(&folder)).unwrap().count();
        assert_eq!(beside, if name.starts_with("figures") { 1 } else { 2 }, "{name}");
    }
    let again = dir.raceway(&[&arguments[..], &["new/spectra"]].concat());
    assert_eq!(again.code, Some(2), "{}", again.stdout);
    let out = |files: &Files| files.iter().filter(|(name, _)| name.starts_with("out")).count();
    assert_eq!(out(&before), out(&dir.snapshot()));
}

/// Wrong: points of a sweep would be taken for seconds, by a spectrum and by its lines of the bearing.
#[test]
fn a_sweep_has_no_spectrum() {
    let values: Vec<String> = (1..=20).map(|n| format!("\"{n}00 N\"")).collect();
    let sweep = format!(
        "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [{}]\n",
        values.join(", ")
    );
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &sweep));
    dir.run("out", &RIGID);
    for command in [
        &["spectrum", "out", "--probe", "z_m"][..],
        &["spall-length", "out", "--ring", "outer"],
    ] {
        let outcome = dir.raceway(command);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stdout);
        let expected = "out has the results of [static] or [sweep], whose steps are no times; expected those of \
                        [dynamic] or [quasi_static]";
        assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    }
    // Cycles from point to point are no times either.
    let head = "step,time_s,effects.axial_force.value_n,g_pa\n";
    let rows = (0..20).map(|n| format!("{n},{n}.0,{n}00.0,{}\n", n % 3));
    dir.write("out/probes.csv", head.to_string() + &rows.collect::<String>());
    let said = dir.raceway(&["cycles", "out"]).stdout;
    assert!(
        said.contains("1 stresses from point 0 to point 19 of the sweep"),
        "{said}"
    );
}
