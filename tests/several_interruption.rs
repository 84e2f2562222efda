//! Lists of bearings that are killed, stopped, or whose disk is full.

use std::io::{BufRead, BufReader};
use std::path::Path;

use checkpoint::{committed_steps, read_stamps, step_file_name};

use crate::interruption::{outcome_of, signal, wait_for_steps};
use crate::several::{pair, succeeds};
use crate::util::Dir;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::summary;

const BEARINGS: [&str; 2] = ["front", "rear"];

const EQUILIBRIA: &str =
    "[speed]\ninner = \"3000 rpm\"\n[quasi_static]\nduration = \"1 ms\"\nstep = \"0.25 ms\"\n";
const MOTION: &str = "[speed]\ninner = \"3000 rpm\"\n[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"\n\
                      output_every = 100\n";

/// Fails unless two folders have the same tables, and the folder `cut` all steps of `whole`, which tell the same of the
/// tables.
#[track_caller]
fn assert_same_list(dir: &Dir, whole: &str, cut: &str) {
    for name in ["balls.csv", "bearings.csv", "shaft.csv"] {
        let [whole, cut] = [whole, cut].map(|out| dir.text(&format!("{out}/{name}")));
        let differ = whole.lines().zip(cut.lines()).find(|(a, b)| a != b);
        assert!(whole == cut, "{name} differs first at {differ:?}");
    }
    for bearing in BEARINGS {
        let [whole, cut] = [whole, cut].map(|out| format!("{out}/{bearing}"));
        assert_same_run(dir, &whole, &cut);
        assert_same_stamps(dir, &whole, &cut);
    }
}

/// Fails unless the steps of the folder `whole` tell the same of the tables as those of the folder `cut`.
#[track_caller]
pub fn assert_same_stamps(dir: &Dir, whole: &str, cut: &str) {
    for step in committed_steps(&dir.path(whole)).unwrap() {
        let stamps = |out: &str| read_stamps(&dir.path(out).join(step_file_name(step))).unwrap();
        assert_eq!(stamps(whole), stamps(cut), "step {step}");
    }
}

/// Runs the pair into a folder with a limit on the size of its files, at which it ends. In the folder `alone` one
/// bearing was faster than the other: it has the step with which the run in `whole` begins.
fn ends_early(dir: &Dir, limit: u32, out: &str, first_step: u64) {
    let outcome = dir.raceway_with_small_files(limit, &["run", "pair.toml", "--out", out]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("File too large"), "{}", outcome.stderr);
    if out == "alone" {
        let step = step_file_name(first_step);
        let [from, to] = ["whole", "alone"].map(|out| dir.path(&format!("{out}/front/{step}")));
        std::fs::copy(from, to).unwrap();
        std::fs::remove_file(dir.path("alone/front/.raceway.starting")).unwrap();
    }
}

/// Wrong: a list that ended before its first step could neither go on nor be run again, or running it again would take
/// files of the user or results with it. A limit on the size of files stands for the end: no mesh file fits, or no
/// step.
#[test]
fn a_list_that_ended_before_its_first_step_is_run_again() {
    for analysis in [EQUILIBRIA, MOTION] {
        let dir = pair(analysis);
        let run = |out: &'static str| ["run", "pair.toml", "--out", out];
        succeeds(&dir, &run("whole"));
        for (limit, out) in [(1, "early"), (16, "late"), (16, "alone")] {
            ends_early(&dir, limit, out, 0);
            let refused = dir.raceway(&["resume", out]);
            assert_eq!(refused.code, Some(2));
            let expected = format!(
                "{out} holds no step that is whole in all bearings: the run ended before its first one; start it again \
                 with raceway run SCENE --out {out}"
            );
            assert!(refused.stderr.contains(&expected), "{}", refused.stderr);
            let said = succeeds(&dir, &run(out)).stderr;
            let expected = format!("the run in {out} ended before its first step was whole in all bearings");
            assert!(said.contains(&expected), "{said}");
            assert_same_list(&dir, "whole", out);
        }
        let kept = dir.path("alone/front/superseded_1");
        assert_eq!(committed_steps(&kept).unwrap(), [0]);
    }
}

/// Wrong: modes of a list that were killed as they were written would leave a folder that is refused as results. The
/// limit is as above: no mesh file fits, or no mode of the second bearing.
#[test]
fn modes_of_a_list_that_ended_early_are_run_again() {
    let dir = pair("[modes]\nnumber = 2\n");
    let run = |out: &'static str| ["run", "pair.toml", "--out", out];
    succeeds(&dir, &run("whole"));
    for (limit, out) in [(1, "early"), (16, "late"), (16, "alone")] {
        ends_early(&dir, limit, out, 1);
        let said = succeeds(&dir, &run(out)).stderr;
        let expected = format!("the run in {out} ended before its first step was whole in all bearings");
        assert!(said.contains(&expected), "{said}");
        for name in ["modes.csv", "mode_shaft.csv", "shaft.csv", "rear/modes.csv"] {
            let text = |out: &str| dir.text(&format!("{out}/{name}"));
            assert_eq!(text(out), text("whole"), "{out}/{name}");
        }
    }
}

/// Wrong: a run would begin where results or files of the user are, and replace them.
#[test]
fn a_list_begins_only_where_nothing_is_lost() {
    let dir = pair(EQUILIBRIA);
    succeeds(&dir, &["run", "pair.toml", "--out", "killed"]);
    std::fs::remove_file(dir.path("killed/summary.json")).unwrap();
    copy(&dir, "killed", "half");
    for step in 0..=4 {
        std::fs::remove_file(dir.path(&format!("half/rear/{}", step_file_name(step)))).unwrap();
    }
    for (out, name) in [
        ("tables", "shaft.csv"),
        ("scenes", "scene.toml"),
        ("bearings", "bearings.csv"),
    ] {
        std::fs::create_dir(dir.path(out)).unwrap();
        dir.write(&format!("{out}/{name}"), "mine");
    }
    let before = dir.snapshot();
    for (out, file) in [
        ("killed", "results of a run (balls.csv)"),
        ("half", "results of a run (balls.csv)"),
        ("tables", "results of a run (shaft.csv)"),
        ("scenes", "scene.toml"),
        ("bearings", "bearings.csv"),
    ] {
        let refused = dir.raceway(&["run", "pair.toml", "--out", out]);
        assert_eq!(refused.code, Some(2));
        let expected = format!("{out} already holds {file}; choose another --out");
        assert!(refused.stderr.contains(&expected), "{}", refused.stderr);
    }
    assert!(dir.snapshot() == before);
}

/// Wrong: a stop of a list would leave rows between those that `output.tables_every` asks for, in its tables and in
/// those of its bearings, and a run that is stopped twice could not go on.
#[test]
fn rows_that_only_stops_add_to_a_list_are_gone_after_them() {
    for (analysis, key) in [(EQUILIBRIA, "quasi_static"), (MOTION, "dynamic")] {
        let dir = pair(analysis);
        let set = |more: &str| format!("{key}.{more}");
        let endless = [set("duration=20 s"), set("output_every=1000000")];
        let mut arguments = vec![
            "run",
            "pair.toml",
            "--out",
            "cut",
            "--set",
            "output.tables_every=7",
        ];
        endless.iter().for_each(|set| arguments.extend(["--set", set]));
        let stopped = |arguments: &[&str]| {
            let mut child = dir.start(arguments);
            let lines = wait_for_steps(&mut child);
            signal(&child, "TERM");
            let outcome = outcome_of(child, lines);
            assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
            *committed_steps(&dir.path("cut/rear")).unwrap().last().unwrap()
        };
        let first = stopped(&arguments);
        let rows = dir.text("cut/shaft.csv");
        assert!(rows.lines().last().unwrap().starts_with(&format!("{first},")));
        let second = stopped(&["resume", "cut"]);
        assert!(second >= first);
        let step = if key == "dynamic" { 10 } else { 250 };
        let (last, duration) = (second + 9, set(&format!("duration={} us", step * (second + 9))));
        succeeds(&dir, &["resume", "cut", "--set", &duration]);
        let every = set(&format!("output_every={last}"));
        let whole = [
            "run",
            "pair.toml",
            "--out",
            "whole",
            "--set",
            "output.tables_every=7",
        ];
        succeeds(
            &dir,
            &[&whole[..], &["--set", &duration, "--set", &every]].concat(),
        );
        assert_same_list(&dir, "whole", "cut");
    }
}

/// Wrong: the part of a sweep would pass for all of it in the folders of its bearings.
#[test]
fn bearings_of_a_stopped_sweep_are_stopped_too() {
    let values: Vec<String> = (0..600).map(|i| format!("\"{} nm\"", 14_000 + i)).collect();
    let sweep = format!(
        "[sweep]\nkey = \"pairing.offset\"\nvalues = [{}]",
        values.join(", ")
    );
    let dir = pair(&sweep);
    let mut child = dir.start(&["run", "pair.toml", "--out", "out"]);
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while !line.contains("] 2/600 bearings at ") {
        line.clear();
        assert!(lines.read_line(&mut line).unwrap() > 0);
    }
    signal(&child, "TERM");
    let outcome = outcome_of(child, lines);
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    for folder in ["out", "out/front", "out/rear"] {
        let status = summary(&dir, folder)["status"].clone();
        let is_stopped = status.as_str().unwrap().starts_with("stopped: SIGTERM received");
        assert!(is_stopped, "{folder}: {status}");
    }
}

/// Bytes of all files in a folder.
fn bytes_below(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let size = |entry: std::fs::DirEntry| match entry.path().is_dir() {
        true => bytes_below(&entry.path()),
        false => entry.metadata().unwrap().len(),
    };
    entries.map(size).sum()
}

/// Wrong: a list of rigid rings, most of whose results are tables, would fill a disk of which it was said to have room.
#[test]
fn the_output_of_a_list_in_motion_is_forecast() {
    let dir = pair(MOTION);
    let checked = succeeds(&dir, &["check", "pair.toml", "--json", "--quiet"]).stdout;
    let found: serde_json::Value = serde_json::from_str(&checked).unwrap();
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let forecast = found["output_bytes"].as_u64().unwrap() as f64 / bytes_below(&dir.path("out")) as f64;
    assert!((0.8..1.4).contains(&forecast), "{forecast}");
}

/// Wrong: who has no room for equilibria over time would be told of a key that their scene does not have.
#[test]
fn a_list_without_room_names_the_key_of_its_analysis() {
    let dir = pair(EQUILIBRIA);
    let long = [
        "--set",
        "quasi_static.duration=\"1e5 s\"",
        "--set",
        "quasi_static.step=\"1 ms\"",
    ];
    let refused = dir.raceway(&[&["run", "pair.toml"], &long[..]].concat());
    assert_eq!(refused.code, Some(2));
    let expected = "write fewer steps with quasi_static.output_every, choose another --out";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
}

/// Wrong: a list at rest would start without room for its results, which `check` would not tell or tell wrongly.
#[test]
fn the_output_of_a_list_at_rest_is_forecast() {
    for (analysis, n) in [
        ("[static]", 1),
        (
            "[sweep]\nkey = \"pairing.offset\"\nvalues = [\"18 um\", \"20 um\", \"22 um\"]",
            3,
        ),
    ] {
        let dir = pair(analysis);
        let checked = succeeds(&dir, &["check", "pair.toml", "--json", "--quiet"]).stdout;
        let found: serde_json::Value = serde_json::from_str(&checked).unwrap();
        assert_eq!(found["step_files"], 2 * n);
        assert!(found["assumed"].is_array());
        succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
        for bearing in BEARINGS {
            let steps = committed_steps(&dir.path(&format!("out/{bearing}"))).unwrap();
            assert_eq!(steps.len(), n);
        }
        let bytes = bytes_below(&dir.path("out"));
        let forecast = found["output_bytes"].as_u64().unwrap() as f64 / bytes as f64;
        assert!((0.85..1.3).contains(&forecast), "{forecast}");
    }
}

/// Wrong: a list that was killed after its last step, before it had summed up, would be called finished and never have
/// a summary, nor the file in which ParaView finds its steps.
#[test]
fn a_list_killed_after_its_last_step_is_summed_up() {
    for analysis in [EQUILIBRIA, MOTION] {
        let dir = pair(analysis);
        succeeds(&dir, &["run", "pair.toml", "--out", "whole"]);
        for lost in ["summary.json", "rear/summary.json", "front/run.vtkhdf"] {
            copy(&dir, "whole", "cut");
            std::fs::remove_file(dir.path(&format!("cut/{lost}"))).unwrap();
            succeeds(&dir, &["resume", "cut"]);
            assert!(dir.path(&format!("cut/{lost}")).exists(), "{lost}");
            assert_same_list(&dir, "whole", "cut");
            let [whole, cut] = ["whole", "cut"].map(|out| summary(&dir, out));
            for key in ["status", "shaft", "balls", "bearings"] {
                assert_eq!(whole[key], cut[key], "{key} after {lost}");
            }
            let again = succeeds(&dir, &["resume", "cut"]).stdout;
            assert!(again.contains("nothing to do: cut has finished"), "{again}");
            std::fs::remove_dir_all(dir.path("cut")).unwrap();
        }
    }
}

/// Wrong: a list that goes on beyond its end, and fails on the way, would still be called finished, with the shaft of a
/// step long before.
#[test]
fn a_list_that_goes_on_is_not_finished_any_more() {
    let dir = pair(EQUILIBRIA);
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let longer = ["resume", "out", "--set", "quasi_static.duration=\"2 ms\""];
    let failed = dir.raceway_with_small_files(16, &longer);
    assert_eq!(failed.code, Some(2), "{}", failed.stderr);
    assert!(failed.stderr.contains("File too large"), "{}", failed.stderr);
    let text = std::fs::read_to_string(dir.path("out/summary.json")).unwrap_or_default();
    assert!(!text.contains("\"finished\""), "{text}");
    succeeds(&dir, &longer);
    assert_eq!(summary(&dir, "out")["status"], "finished");
}

/// Wrong: who has moved the results of a list, or lost a part of them, would not be told what helps.
#[test]
fn a_list_that_was_moved_or_is_not_whole_says_what_helps() {
    let dir = pair(EQUILIBRIA);
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    std::fs::create_dir_all(dir.path("far/away")).unwrap();
    std::fs::rename(dir.path("out"), dir.path("far/away/out")).unwrap();
    let longer = ["--set", "quasi_static.duration=\"2 ms\""];
    let resume = |more: &[&str]| dir.raceway(&[&["resume", "far/away/out"], more, &longer[..]].concat());
    let refused = resume(&[]);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.stderr.contains("--scene says where it is"),
        "{}",
        refused.stderr
    );
    let helped = resume(&["--scene", "pair.toml"]);
    assert_eq!(helped.code, Some(0), "{}", helped.stderr);
    std::fs::remove_dir_all(dir.path("far/away/out/rear")).unwrap();
    let refused = resume(&["--scene", "pair.toml"]);
    assert_eq!(refused.code, Some(2));
    let expected = "the folder far/away/out/rear of a bearing is not there";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
}
