//! The contract of the result files: names, keys and columns as scripts depend on them, the same numbers in all of
//! them, and no run that overwrites another.

use checkpoint::{StateArray, read_step};
use serde_json::Value;

use crate::statics::reference;
use crate::util::tables::{Table, keys, number, summary};
use crate::util::{Dir, RIGID, SCENE, assert_within};

const SUMMARY_KEYS: [&str; 22] = [
    "advice",
    "analysis",
    "balls",
    "contact_mode",
    "dofs",
    "effects",
    "elements",
    "energy_j",
    "factor_bytes_forecast",
    "iterations",
    "peak_memory_bytes",
    "peak_memory_forecast_bytes",
    "run",
    "scene",
    "schema",
    "shaft",
    "status",
    "subsurface",
    "timing_s",
    "title",
    "version",
    "warnings",
];

const CONTACT_KEYS: [&str; 5] = [
    "approach_m",
    "contact_angle_rad",
    "force_n",
    "peak_pressure_pa",
    "semi_axes_m",
];

const BALL_COLUMNS: [&str; 18] = [
    "step",
    "time_s",
    "ball",
    "azimuth_rad",
    "inner_force_n",
    "outer_force_n",
    "inner_contact_angle_rad",
    "outer_contact_angle_rad",
    "inner_approach_m",
    "inner_semi_axis_groove_m",
    "inner_semi_axis_rolling_m",
    "inner_peak_pressure_pa",
    "outer_approach_m",
    "outer_semi_axis_groove_m",
    "outer_semi_axis_rolling_m",
    "outer_peak_pressure_pa",
    "displacement_radial_m",
    "displacement_axial_m",
];

const SHAFT_COLUMNS: [&str; 12] = [
    "step",
    "time_s",
    "x_m",
    "y_m",
    "z_m",
    "tilt_x_rad",
    "tilt_y_rad",
    "reaction_x_n",
    "reaction_y_n",
    "reaction_z_n",
    "reaction_tilt_x_n_m",
    "reaction_tilt_y_n_m",
];

const ENERGY_COLUMNS: [&str; 7] = [
    "step",
    "time_s",
    "strain_j",
    "hertz_j",
    "load_potential_j",
    "total_j",
    "defect_j",
];

/// Columns of `balls.csv` and where the same number stands in a ball of `summary.json`.
const SAME_IN_SUMMARY: [(&str, &str); 15] = [
    ("azimuth_rad", "/azimuth_rad"),
    ("inner_force_n", "/inner/force_n"),
    ("outer_force_n", "/outer/force_n"),
    ("inner_contact_angle_rad", "/inner/contact_angle_rad"),
    ("outer_contact_angle_rad", "/outer/contact_angle_rad"),
    ("inner_approach_m", "/inner/approach_m"),
    ("inner_semi_axis_groove_m", "/inner/semi_axes_m/0"),
    ("inner_semi_axis_rolling_m", "/inner/semi_axes_m/1"),
    ("inner_peak_pressure_pa", "/inner/peak_pressure_pa"),
    ("outer_approach_m", "/outer/approach_m"),
    ("outer_semi_axis_groove_m", "/outer/semi_axes_m/0"),
    ("outer_semi_axis_rolling_m", "/outer/semi_axes_m/1"),
    ("outer_peak_pressure_pa", "/outer/peak_pressure_pa"),
    ("displacement_radial_m", "/displacement_m/radial"),
    ("displacement_axial_m", "/displacement_m/axial"),
];

/// If this failed, scripts would not find a key of the summary, or find one that nobody has described.
#[test]
fn the_summary_has_the_keys_of_schema_1() {
    let dir = reference();
    let summary = summary(&dir, "out");
    assert_eq!(keys(&summary), SUMMARY_KEYS);
    assert_eq!(
        keys(&summary["shaft"]),
        [
            "displacement_m",
            "reaction_force_n",
            "reaction_moment_n_m",
            "rotation_rad"
        ]
    );
    assert_eq!(keys(&summary["dofs"]), ["inner", "outer"]);
    assert_eq!(keys(&summary["elements"]), ["inner", "outer"]);
    assert_eq!(
        keys(&summary["energy_j"]),
        ["defect", "hertz", "load_potential", "strain", "total"]
    );
    assert_eq!(keys(&summary["iterations"]), ["newton", "rounds"]);
    assert_eq!(keys(&summary["factor_bytes_forecast"]), ["inner", "outer"]);
    let parts = [
        "assemble",
        "columns",
        "contact",
        "disk",
        "disk_wait",
        "effect_axial_force",
        "effect_radial_force",
        "factor",
        "output",
        "read",
        "solve",
        "stress",
        "total",
    ];
    assert_eq!(keys(&summary["timing_s"]), parts);
    let balls = summary["balls"].as_array().unwrap();
    assert_eq!(balls.len(), 18);
    for ball in balls {
        assert_eq!(keys(ball), ["azimuth_rad", "displacement_m", "inner", "outer"]);
        assert_eq!(keys(&ball["displacement_m"]), ["axial", "radial"]);
        assert_eq!(
            (keys(&ball["inner"]), keys(&ball["outer"])),
            (CONTACT_KEYS.into(), CONTACT_KEYS.into())
        );
    }
}

/// If this failed, a script could not tell what was computed.
#[test]
fn the_summary_says_what_was_computed() {
    let dir = reference();
    let summary = summary(&dir, "out");
    let expected = [
        ("schema", 1.into()),
        ("scene", "scene.toml".into()),
        ("title", "7010C under test".into()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("analysis", "static".into()),
        ("status", "finished".into()),
        ("contact_mode", "patch".into()),
        ("effects", Value::from(["axial_force", "radial_force"].to_vec())),
        ("warnings", Value::Array(Vec::new())),
    ];
    for (key, value) in expected {
        assert_eq!(summary[key], value, "{key}");
    }
    for pointer in [
        "/peak_memory_bytes",
        "/peak_memory_forecast_bytes",
        "/factor_bytes_forecast/inner",
        "/timing_s/total",
        "/iterations/rounds",
    ] {
        assert!(number(&summary, pointer) > 0.0, "{pointer}");
    }
}

/// If this failed, scripts that read the tables by name or by place would read other numbers.
#[test]
fn the_tables_have_their_columns() {
    let dir = reference();
    for (name, columns, rows) in [
        ("balls.csv", &BALL_COLUMNS[..], 18),
        ("shaft.csv", &SHAFT_COLUMNS, 1),
        ("energy.csv", &ENERGY_COLUMNS, 1),
    ] {
        let table = Table::read(&dir, &format!("out/{name}"));
        assert_eq!(table.columns, columns, "{name}");
        assert_eq!(table.rows.len(), rows, "{name}");
        assert_eq!(
            (table.column("step"), table.column("time_s")),
            (vec![0.0; rows], vec![0.0; rows]),
            "{name}"
        );
    }
}

/// If this failed, two files of one run would contradict each other.
#[test]
fn summary_and_tables_agree_to_the_last_bit() {
    let dir = reference();
    let summary = summary(&dir, "out");
    let balls = Table::read(&dir, "out/balls.csv");
    for (column, pointer) in SAME_IN_SUMMARY {
        for (i, value) in balls.column(column).into_iter().enumerate() {
            let other = number(&summary["balls"][i], pointer);
            assert_eq!(
                value.to_bits(),
                other.to_bits(),
                "ball {i}, {column}: {value:?} and {other:?}"
            );
        }
    }
    let shaft = Table::read(&dir, "out/shaft.csv");
    let places = [
        "displacement_m/0",
        "displacement_m/1",
        "displacement_m/2",
        "rotation_rad/0",
        "rotation_rad/1",
    ];
    let reactions = [
        "reaction_force_n/0",
        "reaction_force_n/1",
        "reaction_force_n/2",
        "reaction_moment_n_m/0",
        "reaction_moment_n_m/1",
    ];
    for (column, place) in SHAFT_COLUMNS[2..].iter().zip(places.iter().chain(&reactions)) {
        let (a, b) = (
            shaft.column(column)[0],
            number(&summary, &format!("/shaft/{place}")),
        );
        assert_eq!(a.to_bits(), b.to_bits(), "{column}: {a:?} and {b:?}");
    }
    let energy = Table::read(&dir, "out/energy.csv");
    for column in &ENERGY_COLUMNS[2..] {
        let (a, b) = (
            energy.column(column)[0],
            number(&summary, &format!("/energy_j/{}", column.trim_end_matches("_j"))),
        );
        assert_eq!(a.to_bits(), b.to_bits(), "{column}: {a:?} and {b:?}");
    }
}

/// If this failed, the energies would not be those of an equilibrium.
#[test]
fn the_energies_add_up_and_close() {
    let dir = reference();
    let energy = Table::read(&dir, "out/energy.csv");
    let term = |name: &str| energy.column(name)[0];
    let sum = term("strain_j") + term("hertz_j") + term("load_potential_j");
    // Three roundings.
    assert_within(
        "total",
        term("total_j"),
        sum,
        4.0 * f64::EPSILON * term("load_potential_j").abs(),
    );
    assert!(term("strain_j") > 0.0 && term("hertz_j") > 0.0 && term("load_potential_j") < 0.0);
    // Virtual work of the residual forces, which are 1e-10 of the loads, through the displacements.
    assert_within(
        "defect",
        term("defect_j"),
        0.0,
        1e-9 * term("load_potential_j").abs(),
    );
}

/// If this failed, a run would leave something that is not described, or not leave what is.
#[test]
fn a_run_leaves_exactly_its_files() {
    let dir = reference();
    let names: Vec<String> = std::fs::read_dir(dir.path("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut names = names;
    names.sort();
    let expected = [
        ".raceway.lock",
        "balls.csv",
        "energy.csv",
        "mesh.hdf",
        "run.hdf.series",
        "run.log",
        "run.vtkhdf",
        "shaft.csv",
        "step_000000.hdf",
        "summary.json",
    ];
    assert_eq!(names, expected);
}

/// If this failed, the picture of a run would show other forces and displacements than its tables.
#[test]
fn the_step_file_has_the_numbers_of_the_summary() {
    let dir = reference();
    let summary = summary(&dir, "out");
    let step = read_step(&dir.path("out/step_000000.hdf")).unwrap();
    assert_eq!(step.scene, SCENE);
    let StateArray::Real(shaft) = &step.state["shaft"] else {
        panic!("the shaft is not real")
    };
    let place = |i: usize| number(&summary, &format!("/shaft/displacement_m/{i}"));
    assert_eq!(shaft[..3], [place(0), place(1), place(2)]);

    let n_rings = ((number(&summary, "/dofs/inner") + number(&summary, "/dofs/outer")) / 3.0) as usize;
    assert_eq!(step.points.displacement.len(), n_rings + 18);
    let (inner, outer) = (step.points.force_inner.unwrap(), step.points.force_outer.unwrap());
    for ball in 0..18 {
        for (side, forces) in [("inner", &inner), ("outer", &outer)] {
            let [x, y, z] = forces[n_rings + ball];
            let force = number(&summary, &format!("/balls/{ball}/{side}/force_n"));
            // A vector of three rounded components.
            assert_within(side, x.hypot(y).hypot(z), force, 8.0 * f64::EPSILON * force);
        }
        let resting = (0..3)
            .map(|c| (inner[n_rings + ball][c] + outer[n_rings + ball][c]).abs())
            .fold(0.0, f64::max);
        // The forces of a ball at rest cancel as far as they have settled: 1e-10 of the largest, and a digit.
        assert!(
            resting < 1e-9 * 2000.0,
            "ball {ball}: {resting:e} N do not cancel"
        );
    }
    let von_mises = step.points.von_mises.unwrap();
    let largest = von_mises[..n_rings].iter().copied().fold(0.0, f64::max);
    assert!(
        (1e7..1e10).contains(&largest),
        "largest von Mises stress {largest:e} Pa"
    );
    assert!(
        von_mises[n_rings..].iter().all(|&s| s == 0.0),
        "balls have no stress"
    );
}

/// If this failed, a second run of a scene would overwrite the first.
#[test]
fn default_folders_are_numbered_and_never_overwritten() {
    let dir = Dir::with_scene(SCENE);
    for expected in ["results/scene", "results/scene-2", "results/scene-3"] {
        let before = dir.snapshot();
        let outcome = dir.raceway(&[&["run", "scene.toml"], &RIGID[..]].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert!(
            outcome.stdout.ends_with(&format!("results: {expected}\n")),
            "{}",
            outcome.stdout
        );
        assert!(dir.path(expected).join("summary.json").exists());
        let after = dir.snapshot();
        assert!(
            before
                .iter()
                .all(|(path, content)| after.get(path) == Some(content)),
            "an older file was changed"
        );
    }
}

/// If this failed, `raceway run ... | head` would end in a panic after the results are written.
#[test]
fn a_closed_pipe_is_no_crash() {
    let dir = Dir::with_scene(SCENE);
    let outcome =
        dir.raceway_into_closed_pipe(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert!(!outcome.stderr.contains("panicked"), "{}", outcome.stderr);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(dir.path("out/summary.json").exists());
}

/// Wrong: a script would take an answer that a full disk has cut off, or an empty one, for a whole one.
#[test]
fn an_answer_that_cannot_be_written_is_a_failure() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    let rigid = |words: &[&'static str]| [words, &RIGID[..]].concat();
    for arguments in [
        rigid(&["check", "scene.toml"]),
        rigid(&["check", "scene.toml", "--json"]),
        rigid(&["run", "scene.toml", "--out", "again", "--json"]),
        vec!["info", "out"],
        vec!["help", "scene"],
    ] {
        let outcome = dir.raceway_after("exec > /dev/full", &arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        let part = "error: cannot write to standard output: No space left on device";
        assert!(outcome.stderr.contains(part), "{arguments:?}: {}", outcome.stderr);
    }
    assert!(dir.path("again/summary.json").exists());
}
