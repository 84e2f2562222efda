//! Results that are not where, or not whose, they were: behind links, moved, mixed with those of another run.

use crate::resume::{moved, refused, resumed};
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::summary;

/// Wrong: a step that was copied from another run of the same names would be gone on from, shown, packed or exported.
#[test]
fn a_step_of_another_run_is_not_taken_for_one_of_this() {
    let dir = moved();
    dir.run("other", &["--set", "effects.axial_force.value=0.5 kN"]);
    copy(&dir, "whole", "cut");
    let step = |folder: &str, step: u32| dir.path(&format!("{folder}/step_{step:06}.hdf"));
    std::fs::copy(step("other", 20), step("cut", 20)).unwrap();
    let said = "cut/step_000020.hdf is a step of another run, ";
    for (command, code) in [
        (&["info", "cut"][..], 2),
        (&["export", "cut", "--to", "csv"], 2),
        (&["plot", "cut", "--step", "20"], 2),
        (&["resume", "cut", "--step", "20"], 2),
        (&["resume", "cut"], 0),
    ] {
        let outcome = dir.raceway(command);
        let text = outcome.stdout.clone() + &outcome.stderr;
        assert_eq!(outcome.code, Some(code), "{command:?}: {text}");
        assert!(text.contains(said), "{command:?}: {text} lacks {said}");
    }
    assert_same_run(&dir, "whole", "cut");
    assert!(
        std::fs::read(dir.path("cut/superseded_1/step_000020.hdf")).unwrap()
            == std::fs::read(step("other", 20)).unwrap(),
        "nothing is lost"
    );
    // One in the middle stays out of the views; a summary says whose it is.
    std::fs::copy(step("other", 4), step("cut", 4)).unwrap();
    std::fs::copy(dir.path("other/summary.json"), dir.path("cut/summary.json")).unwrap();
    let outcome = resumed(&dir, &["cut", "--step", "19"]);
    assert!(
        outcome
            .stderr
            .contains("cut/step_000004.hdf is a step of another run"),
        "{}",
        outcome.stderr
    );
    assert!(!dir.text("cut/run.hdf.series").contains("step_000004"));
    std::fs::copy(dir.path("other/summary.json"), dir.path("cut/summary.json")).unwrap();
    let outcome = dir.raceway(&["report", "cut"]);
    assert!(
        outcome
            .stderr
            .contains("warning: cut/summary.json is of another run, "),
        "{}",
        outcome.stderr
    );
    // A run that goes further, or writes other fields, is the same run.
    resumed(
        &dir,
        &[
            "whole",
            "--set",
            "dynamic.duration=0.44 ms",
            "--set",
            "output.stress=none",
        ],
    );
    let run = |out: &str| summary(&dir, out)["run"].as_str().unwrap().to_string();
    assert_eq!((run("whole").len(), run("whole") == run("other")), (16, false));
    assert_eq!(dir.raceway(&["info", "whole"]).code, Some(0));
}

/// Wrong: results behind a link, as on the scratch disks of clusters, would have lost their scene and their meshes.
#[test]
fn results_behind_a_link_are_resumed() {
    let dir = moved();
    std::fs::create_dir_all(dir.path("deep/a/b")).unwrap();
    std::os::unix::fs::symlink("deep/a/b", dir.path("scratch")).unwrap();
    for stored in [&[][..], &["--stored-scene"]] {
        let outcome = dir.raceway(&[
            "run",
            "scene.toml",
            "--out",
            "scratch/out",
            "--wall-time",
            "00:00:00",
        ]);
        assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
        let outcome = resumed(&dir, &[&["scratch/out"], stored].concat());
        assert!(
            !outcome.stderr.contains("is not there any more"),
            "{}",
            outcome.stderr
        );
        assert_same_run(&dir, "whole", "scratch/out");
        std::fs::remove_dir_all(dir.path("deep/a/b/out")).unwrap();
    }
    // The scene behind a link, and the results moved away together with it.
    std::fs::create_dir(dir.path("project")).unwrap();
    for name in ["scene.toml", "inner.msh", "outer.msh"] {
        std::fs::rename(dir.path(name), dir.path(&format!("project/{name}"))).unwrap();
    }
    std::os::unix::fs::symlink("project", dir.path("link")).unwrap();
    let stopped = ["--out", "link/out", "--wall-time", "00:00:00"];
    assert_eq!(
        dir.raceway(&[&["run", "link/scene.toml"], &stopped[..]].concat())
            .code,
        Some(75)
    );
    std::fs::remove_file(dir.path("link")).unwrap();
    std::fs::rename(dir.path("project"), dir.path("elsewhere")).unwrap();
    resumed(&dir, &["elsewhere/out"]);
    assert_same_run(&dir, "whole", "elsewhere/out");
    std::fs::rename(dir.path("elsewhere/out"), dir.path("out")).unwrap();
    refused(
        &dir,
        &["out", "--step", "3"],
        &["--scene says where it is", "inner.msh"],
    );
}

/// Wrong: a scene that was given by its full path would have another name after a stop, which only holds from the
/// folder of that day.
#[test]
fn a_scene_by_its_full_path_keeps_that_name() {
    let dir = moved();
    let scene = dir.path("scene.toml").display().to_string();
    let stopped = dir.raceway(&["run", &scene, "--out", "cut", "--wall-time", "00:00:00"]);
    assert_eq!(stopped.code, Some(75), "{}", stopped.stderr);
    resumed(&dir, &["cut"]);
    assert_eq!(summary(&dir, "cut")["scene"], scene.as_str());
    // Given from here it is named from here.
    copy(&dir, "whole", "again");
    resumed(&dir, &["again", "--step", "10"]);
    assert_eq!(summary(&dir, "again")["scene"], "scene.toml");
}

/// Wrong: keys of another program, or of a later one, would be shown as numbers of this run, or be missing without a
/// word.
#[test]
fn a_summary_of_another_schema_is_refused() {
    let dir = moved();
    copy(&dir, "whole", "kept");
    let own = dir.text("kept/summary.json");
    let commands: [&[&str]; 6] = [
        &["info", "kept"],
        &["plot", "kept"],
        &["report", "kept"],
        &["life", "kept"],
        &["export", "kept", "--to", "csv"],
        &["resume", "kept"],
    ];
    for (text, said) in [
        (
            own.replacen("\"schema\": 1", "\"schema\": 7", 1),
            "kept/summary.json has schema 7, of version ",
        ),
        (
            "{\"status\": \"finished\"}".to_string(),
            "kept/summary.json has no schema; this program",
        ),
    ] {
        assert!(text != own);
        dir.write("kept/summary.json", &text);
        for command in commands {
            let outcome = dir.raceway(command);
            assert_eq!(outcome.code, Some(2), "{command:?}: {}", outcome.stderr);
            assert!(outcome.stderr.contains(said), "{command:?}: {}", outcome.stderr);
        }
    }
    // A summary of another version that has the same keys is read, with a word on it.
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(own.contains(&version));
    dir.write(
        "kept/summary.json",
        own.replacen(&version, "\"version\": \"0.0.1\"", 1),
    );
    for command in [["plot", "kept"], ["report", "kept"]] {
        let outcome = dir.raceway(&command);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let said = "warning: kept/summary.json was written by version 0.0.1 of the program, this is ";
        assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    }
    assert_eq!(dir.raceway(&["resume", "kept"]).code, Some(0));
}
