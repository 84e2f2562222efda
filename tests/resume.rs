//! `raceway resume`: a run that was cut goes on to the same bits, and what cannot go on is refused.

use std::sync::OnceLock;

use checkpoint::{FolderLock, committed_steps};

use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::tables::{Table, keys, number, summary};
use crate::util::{Dir, Files, Outcome, RIGID};

/// A folder with the small motion run to its end as `whole`; once for all tests.
pub fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        dir.run("whole", &[]);
        dir.snapshot()
    }))
}

fn resume(dir: &Dir, arguments: &[&str]) -> Outcome {
    dir.raceway(&[&["resume"], arguments].concat())
}

/// The run `whole`, cut after each of these steps, goes on to the same bits; (step, threads).
pub fn assert_cuts_continue(dir: &Dir, cuts: &[(&str, &str)]) {
    for (step, threads) in cuts {
        let cut = format!("cut{step}");
        copy(dir, "whole", &cut);
        std::fs::remove_file(dir.path(&format!("{cut}/summary.json"))).unwrap();
        resumed(dir, &[&cut, "--step", step, "--threads", threads]);
        assert_same_run(dir, "whole", &cut);
    }
}

#[track_caller]
pub fn resumed(dir: &Dir, arguments: &[&str]) -> Outcome {
    let outcome = resume(dir, arguments);
    assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
    outcome
}

#[track_caller]
pub fn refused(dir: &Dir, arguments: &[&str], parts: &[&str]) {
    let before = dir.snapshot();
    let outcome = resume(dir, arguments);
    assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
    for part in parts {
        assert!(outcome.stderr.contains(part), "{} lacks {part:?}", outcome.stderr);
    }
    let lock = |name: &std::path::PathBuf| name.ends_with(".raceway.lock");
    let mut after = dir.snapshot();
    after.retain(|name, _| !lock(name) || before.contains_key(name));
    assert!(after == before, "{arguments:?} changed something");
}

/// Wrong: a resumed run would not be the run that was interrupted. Steps are compared in lockstep, with other numbers
/// of threads; some balls carry no load, and some come into load and go out of it.
#[test]
fn a_run_cut_at_any_step_continues_bit_for_bit() {
    let dir = moved();
    let forces = Table::read(&dir, "whole/balls.csv").column("outer_force_n");
    let unloaded = |step: usize| forces[18 * step..][..18].iter().filter(|f| **f == 0.0).count();
    let counts: Vec<usize> = (0..=20).map(unloaded).collect();
    assert!(
        counts.iter().max() > counts.iter().min() && counts.iter().max() < Some(&18),
        "balls must unload during the run: {counts:?}"
    );
    for (step, threads) in [("0", "1"), ("7", "2"), ("19", "3"), ("20", "1")] {
        let cut = format!("cut{step}");
        copy(&dir, "whole", &cut);
        std::fs::remove_file(dir.path(&format!("{cut}/summary.json"))).unwrap();
        resumed(&dir, &[&cut, "--step", step, "--threads", threads]);
        assert_same_run(&dir, "whole", &cut);
        for name in ["step_000020.hdf", "run.vtkhdf", "run.hdf.series"] {
            let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
            assert!(read("whole") == read(&cut), "{name} of {cut} differs");
        }
        let (a, b) = (summary(&dir, "whole"), summary(&dir, &cut));
        // All but what it took, with other numbers of threads and without an equilibrium.
        for key in keys(&a) {
            let cost = key == "timing_s" || key.ends_with("_bytes") || key == "factor_bytes_forecast";
            if !cost {
                assert_eq!(a[key], b[key], "{key}");
            }
        }
        assert_eq!(keys(&a), keys(&b));
        assert!(number(&a, "/factor_bytes_forecast/inner") > 0.0);
        assert_eq!(number(&b, "/factor_bytes_forecast/inner"), 0.0);
    }
}

/// Wrong: a run would go on from a cut with another step size than it had. Steps adapt here, and balls load and unload.
#[test]
fn a_run_whose_steps_adapt_continues_bit_for_bit() {
    let dir = moved();
    let adaptive = [
        "--set",
        "dynamic.adaptive.tolerance=1e-4",
        "--set",
        "dynamic.halvings=6",
    ];
    dir.run("adaptive", &adaptive);
    let energy = |out: &str| dir.text(&format!("{out}/energy.csv"));
    assert!(
        energy("adaptive") != energy("whole"),
        "the tolerance must change steps"
    );
    for step in ["3", "11"] {
        let cut = format!("cut{step}");
        copy(&dir, "adaptive", &cut);
        std::fs::remove_file(dir.path(&format!("{cut}/summary.json"))).unwrap();
        resumed(&dir, &[&cut, "--step", step]);
        assert_same_run(&dir, "adaptive", &cut);
    }
}

/// Wrong: what a resumed run replaces would be lost, or shown twice.
#[test]
fn superseded_steps_and_rows_are_kept_aside() {
    let dir = moved();
    let outcome = resumed(&dir, &["whole", "--step", "17"]);
    assert!(
        outcome
            .stderr
            .contains("what the run wrote after step 17 is kept in whole/superseded_1"),
        "{}",
        outcome.stderr
    );
    assert_eq!(
        committed_steps(&dir.path("whole/superseded_1")).unwrap(),
        [18, 19, 20]
    );
    let rows = Table::read(&dir, "whole/superseded_1/balls.csv").column("step");
    assert_eq!((rows[0], rows.len()), (18.0, 3 * 18));
    let series = dir.text("whole/run.hdf.series");
    assert_eq!(series.matches("step_0000").count(), 21);
    // Again, and again from another step: each keeps what it replaces.
    resumed(&dir, &["whole", "--step", "19"]);
    resumed(&dir, &["whole", "--step", "3", "--threads", "2"]);
    assert_eq!(
        committed_steps(&dir.path("whole/superseded_3")).unwrap().len(),
        17
    );
    assert_same_run(&moved_beside(&dir), "first", "whole");
}

/// The folder `dir` with an untouched run beside it as `first`.
fn moved_beside(dir: &Dir) -> Dir {
    let both = Dir::with_files(&dir.snapshot());
    std::fs::create_dir(both.path("first")).unwrap();
    for (name, content) in moved().snapshot() {
        if let (Ok(name), Some(bytes)) = (name.strip_prefix("whole"), content) {
            std::fs::write(both.path("first").join(name), bytes).unwrap();
        }
    }
    both
}

/// Wrong: a run that has ended would be run again, or integrated beyond its end.
#[test]
fn a_finished_run_has_nothing_to_do() {
    let dir = moved();
    let before = dir.snapshot();
    let outcome = resumed(&dir, &["whole"]);
    assert!(
        outcome
            .stdout
            .contains("nothing to do: whole has finished with step 20 of 20"),
        "{}",
        outcome.stdout
    );
    assert!(dir.snapshot() == before, "nothing to do, but something was done");
}

/// Wrong: a longer duration or other output would change the motion, or a shorter one would lose steps.
#[test]
fn duration_and_output_may_change() {
    let dir = moved();
    let longer = ["--set", "dynamic.duration=0.6 ms"];
    dir.run("long", &longer);
    let sparse = ["--set", "dynamic.output_every=8", "--set", "output.stress=none"];
    resumed(&dir, &[&["whole"], &longer[..], &sparse[..]].concat());
    let steps = committed_steps(&dir.path("whole")).unwrap();
    assert_eq!(steps[steps.len() - 3..], [20, 24, 30]);
    let table = |name: &str| dir.text(&format!("{name}/energy.csv"));
    assert!(
        table("whole") == table("long"),
        "the motion depends on its output"
    );
    refused(
        &dir,
        &["whole", "--set", "dynamic.duration=0.2 ms"],
        &["the run is at step 30, t = 0.0006", "dynamic.duration = 0.0002 s"],
    );
    // Once more, from a step between, with the full output again.
    resumed(
        &dir,
        &["whole", "--step", "24", "--set", "dynamic.output_every=1"],
    );
    assert!(table("whole") == table("long"), "the second resume differs");
}

/// Wrong: damage would be taken for a state, or nobody would hear of it.
#[test]
fn damaged_steps_are_skipped_loudly() {
    let dir = moved();
    copy(&dir, "whole", "cut");
    let path = |n: u32| dir.path(&format!("cut/step_{n:06}.hdf"));
    let bytes = std::fs::read(path(20)).unwrap();
    std::fs::write(path(20), &bytes[..bytes.len() / 2]).unwrap();
    let mut bytes = std::fs::read(path(19)).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    std::fs::write(path(19), bytes).unwrap();
    let outcome = resumed(&dir, &["cut"]);
    for part in [
        "warning: cut/step_000020.hdf is not a complete step file: its seal is missing or damaged",
        "of cut/step_000019.hdf is damaged",
        "resuming cut after step 18 of 20",
    ] {
        assert!(outcome.stderr.contains(part), "{} lacks {part}", outcome.stderr);
    }
    assert_same_run(&dir, "whole", "cut");
    // One in the middle of the run stays where it is, and out of the views.
    let mut bytes = std::fs::read(path(4)).unwrap();
    bytes[100] ^= 4;
    std::fs::write(path(4), bytes).unwrap();
    let outcome = resumed(&dir, &["cut", "--step", "19"]);
    assert!(outcome.stderr.contains("step_000004.hdf"), "{}", outcome.stderr);
    assert!(!dir.text("cut/run.hdf.series").contains("step_000004"));
    refused(&dir, &["cut", "--step", "4"], &["step_000004.hdf"]);
}

/// Wrong: a run would go on with another scene than it began with, and nothing would say so.
#[test]
fn a_changed_scene_is_refused_with_the_difference() {
    let dir = moved();
    let scene = dir.text("scene.toml");
    dir.write(
        "scene.toml",
        scene
            .replace("12000 rpm", "6000 rpm")
            .replace("[shaft]", "[shaft] # held"),
    );
    let difference = "speed.inner from \"12000 rpm\" to \"6000 rpm\"";
    refused(
        &dir,
        &["whole", "--step", "10"],
        &[
            "scene.toml has changed since the run",
            difference,
            "--stored-scene",
        ],
    );
    resumed(&dir, &["whole", "--step", "10", "--stored-scene"]);
    // Comments and what may change are no reason to refuse.
    dir.write(
        "scene.toml",
        scene
            .replace("[shaft]", "[shaft] # held")
            .replace("0.4 ms", "4 ms"),
    );
    resumed(&dir, &["whole", "--step", "10"]);
    // Moved away, or deleted.
    std::fs::create_dir(dir.path("elsewhere")).unwrap();
    std::fs::rename(dir.path("scene.toml"), dir.path("elsewhere/scene.toml")).unwrap();
    let outcome = resumed(&dir, &["whole", "--step", "10"]);
    assert!(
        outcome
            .stderr
            .contains("scene.toml is not there any more; going on with the scene stored in step 10"),
        "{}",
        outcome.stderr
    );
    refused(
        &dir,
        &["whole", "--step", "10", "--scene", "elsewhere/scene.toml"],
        &["inner.msh"],
    );
    refused(
        &dir,
        &["whole", "--step", "10", "--set", "effects.axial_force.value=1 kN"],
        &[
            "--set would change effects.axial_force.value from \"0.4 kN\" to \"1 kN\"",
            "dynamic.duration, dynamic.output_every, quasi_static.duration, quasi_static.output_every, output, life",
        ],
    );
    assert_same_run(&moved_beside(&dir), "first", "whole");
}

/// Wrong: a run would go on with other rings than it began with.
#[test]
fn a_changed_mesh_is_refused() {
    let dir = moved();
    let mut mesh = std::fs::read(dir.path("outer.msh")).unwrap();
    mesh.push(b'\n');
    dir.write("outer.msh", mesh);
    refused(
        &dir,
        &["whole", "--step", "3"],
        &[
            "the mesh of the outer ring has changed since the run: it was outer.msh (",
            " bytes, checksum ",
        ],
    );
    std::fs::remove_file(dir.path("outer.msh")).unwrap();
    refused(&dir, &["whole", "--step", "3"], &["outer.msh"]);
}

/// Wrong: a run would go on with another surface than it began with, and its tables hold both.
#[test]
fn a_changed_table_of_a_surface_is_refused() {
    let dir = small_motion();
    let table = |height: &str| {
        let rows = (0..36).map(|i| format!("{},0,{}\n", 10 * i, if i % 2 == 0 { height } else { "0" }));
        format!(
            "azimuth_deg,groove_angle_deg,height_um\n{}",
            rows.collect::<String>()
        )
    };
    let named = "\n[[profiles.table]]\nring = \"outer\"\nfile = \"roundness.csv\"\n";
    dir.write("scene.toml", dir.text("scene.toml") + named);
    dir.write("roundness.csv", table("0.02"));
    let run = [
        "run",
        "scene.toml",
        "--out",
        "whole",
        "--set",
        "output.stress=none",
    ];
    let outcome = dir.raceway(&[&run[..], &RIGID].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    dir.write("roundness.csv", table("0.05"));
    let said = "the file of profiles.table.0.file has changed since the run: it was (";
    refused(&dir, &["whole", "--step", "3"], &[said, " bytes, checksum "]);
    refused(&dir, &["whole", "--step", "3", "--stored-scene"], &[said]);
    std::fs::remove_file(dir.path("roundness.csv")).unwrap();
    refused(&dir, &["whole", "--step", "3"], &["cannot read", "roundness.csv"]);
}

/// Wrong: a request that cannot be met would do something else, or not say what is there.
#[test]
fn what_cannot_be_resumed_is_refused() {
    let dir = moved();
    refused(&dir, &["nowhere"], &["nowhere is no folder"]);
    std::fs::create_dir(dir.path("empty")).unwrap();
    refused(&dir, &["empty"], &["holds no committed step"]);
    refused(
        &dir,
        &["whole", "--step", "21"],
        &["has no step 21; committed steps are 0 to 20"],
    );
    refused(&dir, &["whole", "--wall-time", "90"], &["\"90\" is no wall time"]);
    let rows = dir.text("whole/shaft.csv");
    let short: Vec<&str> = rows.lines().take(12).collect();
    dir.write("whole/shaft.csv", short.join("\n"));
    refused(
        &dir,
        &["whole", "--step", "15"],
        &[
            "shaft.csv is not as the run wrote it: it has ",
            "go on from step 9, the newest whose tables are as written: --step 9",
        ],
    );
    dir.write("whole/shaft.csv", rows);
    let _writer = FolderLock::acquire(&dir.path("whole")).unwrap();
    let owner = format!("process {} on ", std::process::id());
    let outcome = resume(&dir, &["whole", "--step", "15"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome.stderr.contains(&owner) && outcome.stderr.contains("is writing to folder whole"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: a file that can be made again would be missed, or one that cannot would be made up.
#[test]
fn missing_files_are_made_again_where_that_can_be() {
    let dir = moved();
    copy(&dir, "whole", "cut");
    for name in ["mesh.hdf", "run.hdf.series", "run.vtkhdf", "summary.json"] {
        std::fs::remove_file(dir.path(&format!("cut/{name}"))).unwrap();
    }
    let outcome = resumed(&dir, &["cut"]);
    assert!(
        outcome
            .stderr
            .contains("mesh.hdf was missing in cut and is written again"),
        "{}",
        outcome.stderr
    );
    for name in ["mesh.hdf", "run.hdf.series", "run.vtkhdf"] {
        let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
        assert!(read("whole") == read("cut"), "{name} differs");
    }
    // Damage of the mesh is no reason to go back.
    let mut bytes = std::fs::read(dir.path("cut/mesh.hdf")).unwrap();
    bytes[2000] ^= 4;
    dir.write("cut/mesh.hdf", bytes);
    let advised = "raceway resume writes it again";
    let info = dir.raceway(&["info", "cut"]);
    assert!(
        info.code == Some(2) && info.stdout.contains(advised),
        "{}",
        info.stdout
    );
    let outcome = resumed(&dir, &["cut"]);
    assert!(
        outcome
            .stderr
            .contains("mesh.hdf was damaged in cut and is written again"),
        "{}",
        outcome.stderr
    );
    assert_eq!(dir.raceway(&["info", "cut"]).code, Some(0));
    std::fs::remove_file(dir.path("cut/energy.csv")).unwrap();
    refused(
        &dir,
        &["cut", "--step", "9"],
        &["cannot read cut/energy.csv: No such file"],
    );
}

/// Wrong: a packed step would be missed, or a run whose early steps are packed could not go on; a folder that is packed
/// already would be left without a word why nothing was done.
#[test]
fn a_run_goes_on_beside_its_packs() {
    let dir = moved();
    copy(&dir, "whole", "cut");
    let packed = dir.raceway(&["pack", "cut", "--keep", "5", "--per-file", "10"]);
    assert_eq!(packed.code, Some(0), "{}", packed.stderr);
    let again = dir.raceway(&["pack", "cut", "--keep", "5"]).stdout;
    let why = "0 steps packed, 2 packs in cut; 16 steps are in packs, the newest 5 stay files of their own (--keep)";
    assert!(again.contains(why), "{again}");
    refused(
        &dir,
        &["cut", "--step", "3"],
        &["step 3 is in a pack; raceway pack cut --undo"],
    );
    resumed(&dir, &["cut", "--step", "17"]);
    assert_eq!(dir.raceway(&["pack", "cut", "--undo"]).code, Some(0));
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: a sweep would be taken for a run over time.
#[test]
fn only_runs_over_time_are_resumed() {
    let dir = Dir::with_scene(crate::util::SCENE);
    dir.run("out", &RIGID);
    refused(
        &dir,
        &["out"],
        &[
            "holds results of a [static] scene; only a run over time, a scene with [dynamic] or [quasi_static], can",
        ],
    );
}
