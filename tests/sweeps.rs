//! Sweeps through the whole program: a table with a column of the swept value, and the same numbers as single runs.

use std::sync::OnceLock;

use serde_json::Value;

use crate::util::tables::{Table, keys, number, summary};
use crate::util::{Dir, Files, RIGID, SCENE, assert_close, with_line};

/// A sweep of the radial force of the tests' scene.
const SWEEP: &str =
    "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0 kN\", \"0.5 kN\", \"1 kN\"]";

/// Column of the swept value: its key and the SI unit.
const COLUMN: &str = "effects.radial_force.value_n";

/// The swept values, N.
const VALUES: [f64; 3] = [0.0, 500.0, 1000.0];

/// A folder where the sweep was solved on the coarse meshes; solved once for all tests that look at it.
fn swept() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", with_line("[static]", "[static]", SWEEP));
        dir.run("out", &[]);
        dir.snapshot()
    }))
}

/// If this failed, the points of a sweep could not be told apart in its tables.
#[test]
fn every_table_of_a_sweep_has_a_column_of_the_swept_value() {
    let swept = swept();
    for (name, rows) in [("balls.csv", 18), ("shaft.csv", 1), ("energy.csv", 1)] {
        let table = Table::read(&swept, &format!("out/{name}"));
        assert_eq!(table.columns[..3], ["step", "time_s", COLUMN], "{name}");
        assert_eq!(table.rows.len(), rows * VALUES.len(), "{name}");
        for (step, value) in VALUES.into_iter().enumerate() {
            assert_eq!(
                table.step(step).column(COLUMN),
                vec![value; rows],
                "{name}, step {step}"
            );
        }
    }
}

/// If this failed, a point would depend on the points before it, from which it only starts.
#[test]
fn points_of_a_sweep_agree_with_single_runs() {
    let swept = swept();
    let table = Table::read(&swept, "out/balls.csv");
    let dir = Dir::with_meshes();
    for (step, value) in VALUES.into_iter().enumerate() {
        let out = format!("single{step}");
        let set = format!("effects.radial_force.value={value} N");
        dir.run(&out, &["--set", &set, "--set", "output.stress=none"]);
        let single = Table::read(&dir, &format!("{out}/balls.csv"));
        for name in [
            "inner_force_n",
            "outer_force_n",
            "inner_contact_angle_rad",
            "displacement_axial_m",
        ] {
            for (a, b) in table.step(step).column(name).iter().zip(single.column(name)) {
                // Both settle to 1e-10 of the largest force; two digits for small forces beside large ones.
                assert_close(&format!("{name} at {value} N"), *a, b, 1e-8);
            }
        }
    }
}

/// If this failed, scripts would find other numbers in the summary of a sweep than in its tables.
#[test]
fn the_summary_of_a_sweep_has_all_its_points() {
    let swept = swept();
    let summary = summary(&swept, "out");
    assert_eq!(summary["analysis"], "sweep");
    assert_eq!(keys(&summary["sweep"]), ["column", "key", "points"]);
    assert_eq!(
        (&summary["sweep"]["column"], &summary["sweep"]["key"]),
        (&COLUMN.into(), &"effects.radial_force.value".into())
    );
    let table = Table::read(&swept, "out/balls.csv");
    let points = summary["sweep"]["points"].as_array().unwrap();
    assert_eq!(points.len(), VALUES.len());
    for (step, point) in points.iter().enumerate() {
        assert_eq!(keys(point), ["balls", "shaft", "value"]);
        assert_eq!(number(point, "/value"), VALUES[step]);
        let force: Vec<f64> = (0..18)
            .map(|ball| number(point, &format!("/balls/{ball}/outer/force_n")))
            .collect();
        assert_eq!(force, table.step(step).column("outer_force_n"), "step {step}");
    }
    assert_eq!(
        summary["balls"], points[2]["balls"],
        "the main part is the last point"
    );
}

/// If this failed, ParaView would not find a file per point of the sweep.
#[test]
fn a_sweep_has_a_step_file_per_point() {
    let swept = swept();
    let series: Value = serde_json::from_str(&swept.text("out/run.hdf.series")).unwrap();
    let names: Vec<&str> = series["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|f| f["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["step_000000.hdf", "step_000001.hdf", "step_000002.hdf"]);
    for (step, name) in names.iter().enumerate() {
        let record = checkpoint::read_step(&swept.path(&format!("out/{name}"))).unwrap();
        assert_eq!((record.step, record.time), (step as u64, step as f64));
        assert!(
            record.scene.contains("[static]") && !record.scene.contains("[sweep]"),
            "{}",
            record.scene
        );
    }
}

/// If this failed, a range would have other values than its ends and equal steps between them.
#[test]
fn a_range_sweeps_both_ends_and_equal_steps_between() {
    let dir = Dir::empty();
    let range = "[sweep]\nkey = \"effects.axial_force.value\"\nfrom = \"1 kN\"\nto = \"4 kN\"\nsteps = 3";
    dir.write("scene.toml", with_line("[static]", "[static]", range));
    dir.run("out", &RIGID);
    let table = Table::read(&dir, "out/shaft.csv");
    assert_eq!(
        table.column("effects.axial_force.value_n"),
        [1000.0, 2000.0, 3000.0, 4000.0]
    );
    let z = table.column("z_m");
    assert!(
        z.windows(2).all(|pair| pair[0] < pair[1]),
        "the shaft must move on with the load: {z:?}"
    );
}

/// If this failed, a sweep that breaks down would lose the points it has, or pass for a finished one.
#[test]
fn a_sweep_that_breaks_down_keeps_its_points_and_ends_with_code_3() {
    let dir = Dir::empty();
    let sweep = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\", \"1e9 N\"]";
    dir.write("scene.toml", with_line("[static]", "[static]", sweep));
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let message = "error: effects.axial_force.value_n = 1000000000 failed after 2 finished points, which are kept in out: no \
                   equilibrium: z of the shaft";
    assert!(outcome.stderr.contains(message), "{}", outcome.stderr);
    assert_eq!(Table::read(&dir, "out/balls.csv").rows.len(), 2 * 18);
    assert!(dir.path("out/step_000001.hdf").exists() && !dir.path("out/summary.json").exists());

    let rigid = Dir::with_scene(SCENE);
    rigid.run(
        "single",
        &[&["--set", "effects.axial_force.value=2 kN"], &RIGID[..]].concat(),
    );
    let (kept, single) = (
        Table::read(&dir, "out/balls.csv").step(1),
        Table::read(&rigid, "single/balls.csv"),
    );
    for (a, b) in kept
        .column("inner_force_n")
        .iter()
        .zip(single.column("inner_force_n"))
    {
        assert_close("force", *a, b, 1e-8);
    }
}
