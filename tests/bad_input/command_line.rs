//! Command lines, launches and result folders that must be refused.

use super::{assert_refused, run};
use crate::util::{Dir, RIGID, SCENE};

/// Arguments and the essential part of the message.
type Case = (&'static [&'static str], &'static str);

const COMMANDS: [Case; 10] = [
    (&["solve", "scene.toml"], "error: unrecognized subcommand 'solve'"),
    (
        &["run"],
        "error: the following required arguments were not provided:\n  <SCENE>",
    ),
    (
        &["run", "scene.toml", "--outt", "out"],
        "error: unexpected argument '--outt' found",
    ),
    (
        &["run", "scene.toml", "--out"],
        "error: a value is required for '--out <OUT>' but none was supplied",
    ),
    (
        &["run", "scene.toml", "extra.toml"],
        "error: unexpected argument 'extra.toml' found",
    ),
    (
        &["run", "scene.toml", "--threads", "0"],
        "error: --threads is 0; expected at least 1",
    ),
    (
        &["run", "scene.toml", "--threads", "1000000"],
        "error: --threads is 1000000; expected at most 4096",
    ),
    (
        &["run", "scene.toml", "--threads", "two"],
        "error: invalid value 'two' for '--threads <THREADS>'",
    ),
    (
        &["run", "missing.toml"],
        "error: cannot read the scene missing.toml: No such file or directory (os error 2)\n",
    ),
    (
        &["mesh", "scene.toml"],
        "error: scene.toml describes no mesh to build: expected [inner.section] or [outer.section] of a flexible ring",
    ),
];

const OVERRIDES: [Case; 8] = [
    (
        &["--set", "effects.axial_force"],
        "error: --set \"effects.axial_force\": expected path=value such as \"effects.axial_force.value=3 kN\"",
    ),
    (
        &["--set", "a..b=3"],
        "error: --set \"a..b=3\": \"a..b\" is no path of keys; expected one such as effects.axial_force.value",
    ),
    (
        &["--set", "title.x=3"],
        "error: --set \"title.x=3\": title is a value, so it has no key \"x\"",
    ),
    (
        &["--set", "bearing.bals=17"],
        "unknown key \"bals\" in [bearing]; did you mean \"balls\"?",
    ),
    (
        &["--set", "bearing.bals=17"],
        "error: --set \"bearing.bals=17\": unknown key",
    ),
    (
        &["--set", "bearing.width=16"],
        "bearing.width: 16 is a number without a unit; expected a length",
    ),
    (
        &["--set", "bearing.width=16 N"],
        "bearing.width: \"16 N\" is a force; expected a length such as \"9 mm\"",
    ),
    (
        &["--set", "bearing.balls=1", "--set", "bearing.width=-1 mm"],
        "has 2 problems:\n  bearing.balls is 1; expected a whole number from 3 to 1000\n  bearing.width is -1 mm; a \
         width must be positive",
    ),
];

/// If this failed, a mistyped command would run something else or end without a hint.
#[test]
fn bad_command_lines_are_refused() {
    let dir = Dir::with_scene(SCENE);
    for (arguments, part) in &COMMANDS {
        assert_refused(&arguments.join(" "), &dir, &[], arguments, &[part]);
    }
}

/// If this failed, a mistyped `--set` would be ignored, and the scene solved with its old value.
#[test]
fn bad_overrides_are_refused() {
    let dir = Dir::with_meshes();
    for (overrides, part) in &OVERRIDES {
        assert_refused(&overrides.join(" "), &dir, &[], &run(overrides), &[part]);
    }
}

/// If this failed, a launcher would start several copies of one run, which overwrite each other's files.
#[test]
fn a_launch_of_several_tasks_is_refused() {
    let dir = Dir::with_scene(SCENE);
    for variable in ["SLURM_STEP_NUM_TASKS", "OMPI_COMM_WORLD_SIZE", "PMI_SIZE"] {
        let parts = [
            format!(
                "error: the launcher started 2 tasks ({variable}=2), but this program was built without MPI"
            ),
            "start one task (-n 1) and give it the cores as threads".to_string(),
        ];
        let parts = parts.each_ref().map(String::as_str);
        assert_refused(variable, &dir, &[(variable, "2")], &run(&RIGID), &parts);
    }
}

/// If this failed, a plain run inside a batch script that asked for several tasks would be refused.
#[test]
fn an_allocation_of_several_tasks_is_no_launch() {
    let dir = Dir::with_scene(SCENE);
    let outcome = dir.raceway_with(&[("SLURM_NTASKS", "2")], &run(&RIGID));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// If this failed, the results of an earlier run would be lost.
#[test]
fn existing_results_are_not_touched() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    let part =
        "error: out already holds results of a run (summary.json); choose another --out or remove them";
    assert_refused("finished run", &dir, &[], &run(&RIGID), &[part]);
}

/// If this failed, a run that was stopped, or a table of the user's own, would be overwritten.
#[test]
fn a_single_result_file_protects_its_folder() {
    for name in [
        "balls.csv",
        "shaft.csv",
        "energy.csv",
        "mesh.hdf",
        "step_000003.hdf",
        "run.hdf.series",
        "run.vtkhdf",
    ] {
        let dir = Dir::with_scene(SCENE);
        std::fs::create_dir(dir.path("out")).unwrap();
        dir.write(&format!("out/{name}"), "precious");
        let part = format!(
            "error: out already holds results of a run ({name}); choose another --out or remove them"
        );
        assert_refused(name, &dir, &[], &run(&RIGID), &[&part]);
    }
}

/// If this failed, a run would find out that it cannot write only after it has solved, or remove the file.
#[test]
fn a_file_in_the_way_of_the_results_is_refused() {
    let dir = Dir::with_scene(SCENE);
    dir.write("out", "precious");
    let part = "error: cannot write results to out: out is a file; expected a folder or nothing there, choose another \
                --out";
    assert_refused("out", &dir, &[], &run(&RIGID), &[part]);
    let below = [&["run", "scene.toml", "--out", "out/a/b"], &RIGID[..]].concat();
    let part = "error: cannot write results to out/a/b: out is a file; expected a folder";
    assert_refused("out/a/b", &dir, &[], &below, &[part]);
}

/// If this failed, a run into a folder that cannot be written would be solved first and lost then.
#[test]
fn a_folder_that_cannot_be_written_is_refused() {
    let dir = Dir::with_scene(SCENE);
    // Nobody, not even root, can make a file in /proc.
    let arguments = [&["run", "scene.toml", "--out", "/proc/raceway"], &RIGID[..]].concat();
    let part = "error: cannot write results to /proc/raceway; choose another --out: ";
    assert_refused("/proc", &dir, &[], &arguments, &[part]);
}
