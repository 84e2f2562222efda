//! What the program tells other programs and logs: `--json`, `--quiet`, `RACEWAY_THREADS`, `run.log`.

use serde_json::{Value, json};

use crate::resume::moved;
use crate::several::pair;
use crate::util::{Dir, Outcome, RIGID, SCENE};

/// The one line of standard output.
#[track_caller]
fn answer(outcome: &Outcome) -> Value {
    assert_eq!(outcome.stdout.lines().count(), 1, "{}", outcome.stdout);
    serde_json::from_str(&outcome.stdout).unwrap_or_else(|e| panic!("{e}: {}", outcome.stdout))
}

/// Wrong: a script would have to read what is written for people, or miss why a command failed.
#[test]
fn an_answer_is_one_line_of_json() {
    let dir = Dir::with_scene(SCENE);
    let run = [&["run", "scene.toml", "--out", "out", "--json"][..], &RIGID].concat();
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = answer(&outcome);
    assert_eq!(
        [
            &found["command"],
            &found["status"],
            &found["exit_code"],
            &found["error"],
            &found["results"]
        ],
        [
            &json!("run"),
            &json!("finished"),
            &json!(0),
            &Value::Null,
            &json!("out")
        ]
    );
    let summary: Value = serde_json::from_str(&dir.text("out/summary.json")).unwrap();
    assert_eq!(found["summary"], summary);
    // What a person would see is not lost.
    let lines = found["output"].as_array().unwrap();
    assert_eq!(lines.last().unwrap(), "results: out");
    assert!(outcome.stderr.contains("results: out\n"), "{}", outcome.stderr);
    // A second run there is refused, and the answer says so.
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(2));
    let found = answer(&outcome);
    assert_eq!(
        [&found["status"], &found["exit_code"]],
        [&json!("failed"), &json!(2)]
    );
    let error = found["error"].as_str().unwrap();
    assert!(error.starts_with("out already holds results of a run"), "{error}");
    assert!(outcome.stderr.contains(error) && found.get("results").is_none());
}

/// Wrong: a script would be sent to one bearing of a list whose modes it asked for, and find its log there.
#[test]
fn modes_of_a_list_answer_with_the_folder_of_the_list() {
    let dir = pair("[modes]\nnumber = 2");
    let outcome = dir.raceway(&["run", "pair.toml", "--out", "out", "--json"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = answer(&outcome);
    let summary: Value = serde_json::from_str(&dir.text("out/summary.json")).unwrap();
    assert_eq!([&found["results"], &found["summary"]], [&json!("out"), &summary]);
    assert!(dir.text("out/run.log").contains("# exit code 0"));
    assert!(!dir.path("out/rear/run.log").exists());
}

/// Wrong: a script that resumes until nothing is left would at last be told of no results.
#[test]
fn a_resume_with_nothing_to_do_answers_with_the_results() {
    let moving = "[speed]\ninner = \"3000 rpm\"\n[quasi_static]\nduration = \"1 ms\"\nstep = \"0.5 ms\"\n";
    let dir = pair(moving);
    dir.write("scene.toml", SCENE.replace("[static]", moving));
    for (scene, out, more) in [("scene.toml", "one", &RIGID[..]), ("pair.toml", "list", &[])] {
        let run = dir.raceway(&[&["run", scene, "--out", out], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let found = answer(&dir.raceway(&["resume", out, "--json"]));
        let summary: Value = serde_json::from_str(&dir.text(&format!("{out}/summary.json"))).unwrap();
        assert_eq!([&found["results"], &found["summary"]], [&json!(out), &summary]);
    }
}

/// Wrong: one of the commands would write other lines to standard output than its answer.
#[test]
fn all_commands_answer() {
    let dir = moved();
    let cases: [(&[&str], &str, Value); 5] = [
        (&["check", "scene.toml"], "step_files", json!(21)),
        (&["info", "whole"], "damaged", json!([])),
        (&["plot", "whole", "--out", "figures"], "folder", json!("figures")),
        (
            &["report", "whole", "--out", "page.html"],
            "page",
            json!("page.html"),
        ),
        (&["init", "6206"], "scene", json!("6206.toml")),
    ];
    for (arguments, key, expected) in cases {
        let outcome = dir.raceway(&[arguments, &["--json"]].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let found = answer(&outcome);
        assert_eq!(found["command"], arguments[0]);
        assert_eq!(found[key], expected, "{found:#}");
        assert!(!found["output"].as_array().unwrap().is_empty());
    }
    // The last call left a scene: its advice and estimates are numbers and sentences.
    let outcome = dir.raceway(&["check", "scene.toml", "--json"]);
    let found = answer(&outcome);
    assert!(
        found["peak_memory_bytes"].as_u64().unwrap() > 1_000_000,
        "{found:#}"
    );
    assert!(found["advice"].as_array().unwrap().iter().all(Value::is_string));
    let outcome = dir.raceway(&["info", "nowhere", "--json"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        answer(&outcome)["error"]
            .as_str()
            .unwrap()
            .starts_with("nowhere is not there")
    );
    // A stopped motion can be told from a failed one.
    let outcome = dir.raceway(&[
        "run",
        "scene.toml",
        "--out",
        "stopped",
        "--wall-time",
        "00:00:00",
        "--json",
    ]);
    let found = answer(&outcome);
    assert_eq!(
        [&found["status"], &found["exit_code"]],
        [&json!("stopped"), &json!(75)],
        "{found:#}"
    );
    assert_eq!(found["results"], "stopped");
}

/// Wrong: a quiet run would not be quiet, or keep silent about a warning or an error.
#[test]
fn a_quiet_run_says_results_warnings_and_errors() {
    let dir = Dir::with_scene(SCENE);
    let run = |out: &str, more: &[&str]| {
        dir.raceway(&[&["run", "scene.toml", "--out", out, "--quiet"][..], &RIGID, more].concat())
    };
    let outcome = run("a", &[]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    assert!(outcome.stdout.ends_with("results: a\n"), "{}", outcome.stdout);
    let outcome = run("a", &[]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome.stderr.starts_with("error: a already holds") && outcome.stderr.lines().count() == 1,
        "{}",
        outcome.stderr
    );
    // A stiffness that is most likely a slip of its unit is warned of.
    let outcome = run("b", &["--set", "contact.inner_stiffness=9.31e7 N/mm^1.5"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        !outcome.stderr.is_empty() && outcome.stderr.lines().all(|line| line.starts_with("warning: ")),
        "{}",
        outcome.stderr
    );
    let outcome = run("c", &["--json"]);
    assert_eq!(outcome.stderr, "");
    assert_eq!(answer(&outcome)["status"], "finished");
}

/// Wrong: a cluster could not set the number of threads for all commands, or a wrong number would be taken.
#[test]
fn the_environment_sets_the_number_of_threads_and_the_command_line_wins() {
    let dir = Dir::with_scene(SCENE);
    let run = [&["check", "scene.toml"][..], &RIGID].concat();
    let with = |threads: &str, more: &[&str]| {
        dir.raceway_with(&[("RACEWAY_THREADS", threads)], &[&run[..], more].concat())
    };
    for (threads, expected) in [
        ("0", "error: RACEWAY_THREADS is 0; expected at least 1"),
        ("5000", "error: RACEWAY_THREADS is 5000; expected at most 4096"),
        (
            "all",
            "error: RACEWAY_THREADS is \"all\"; expected a whole number of threads such as 4",
        ),
        (
            "",
            "error: RACEWAY_THREADS is \"\"; expected a whole number of threads such as 4",
        ),
    ] {
        let outcome = with(threads, &[]);
        assert_eq!(outcome.code, Some(2), "{threads}");
        assert!(outcome.stderr.contains(expected), "{threads}: {}", outcome.stderr);
    }
    let said = |outcome: Outcome| {
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stdout
    };
    assert!(said(with("3", &[])).contains(" with 3 threads"));
    assert!(said(with("3", &["--threads", "2"])).contains(" with 2 threads"));
    assert!(said(with("nonsense", &["--threads", "2"])).contains(" with 2 threads"));
    let outcome = with("3", &["--threads", "0"]);
    assert!(
        outcome
            .stderr
            .contains("error: --threads is 0; expected at least 1")
    );
}

/// Wrong: what a run said would be lost with the terminal, or another run's words stand in its log.
#[test]
fn a_log_in_the_folder_has_all_that_was_said() {
    let dir = moved();
    let log = dir.text("whole/run.log");
    let head = log.lines().next().unwrap();
    assert!(
        head.starts_with(&format!("# raceway {} (", env!("CARGO_PKG_VERSION")))
            && head.contains(" UTC: ")
            && head.ends_with(" run scene.toml --out whole"),
        "{head}"
    );
    assert!(
        log.contains("factoring") && log.contains("\nresults: whole\n"),
        "{log}"
    );
    assert!(
        log.lines().last().unwrap().starts_with("# exit code 0, 20"),
        "{log}"
    );
    // Both streams are in it, in their order, and nothing else.
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "again"]);
    let log = dir.text("again/run.log");
    let lines: Vec<&str> = log.lines().filter(|line| !line.starts_with("# ")).collect();
    for text in [&outcome.stdout, &outcome.stderr] {
        let mut rest = lines.iter();
        for line in text.lines() {
            assert!(rest.any(|l| *l == line), "{line} is not in\n{log}");
        }
    }
    assert_eq!(
        lines.len(),
        outcome.stdout.lines().count() + outcome.stderr.lines().count()
    );
    // A resumed run adds to it.
    let outcome = dir.raceway(&["resume", "again", "--step", "18", "--quiet"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let longer = dir.text("again/run.log");
    assert!(longer.starts_with(&log));
    let added = &longer[log.len()..];
    assert!(
        added.starts_with("# raceway ")
            && added.contains(" resume again --step 18")
            && added.contains("resuming "),
        "{added}"
    );
    // A run that fails before its folder leaves none; one that is refused adds nothing.
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "again"]);
    assert_eq!(outcome.code, Some(2));
    assert_eq!(dir.text("again/run.log"), longer);
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "bad", "--set", "shaft.x=3"]);
    assert_eq!(outcome.code, Some(2));
    assert!(!dir.path("bad").exists());
}

/// Wrong: a log of the user in the folder would be written over, or end a run.
#[test]
fn a_file_that_is_no_log_stays() {
    let dir = Dir::with_scene(SCENE);
    std::fs::create_dir(dir.path("out")).unwrap();
    dir.write("out/run.log", "mine");
    let outcome = dir.run("out", &RIGID);
    assert!(
        outcome
            .stderr
            .contains("warning: out/run.log is not written: the file there is no log of raceway"),
        "{}",
        outcome.stderr
    );
    assert_eq!(dir.text("out/run.log"), "mine");
}

/// Wrong: a path that is not UTF-8 would end a run in a panic before it says what is wrong, or its log be lost.
#[test]
fn a_path_that_is_not_utf_8_is_no_panic() {
    let dir = Dir::with_scene(SCENE);
    let missing = dir.raceway_after(r"set -- run $'bad\xff.toml' --out x", &[]);
    assert_eq!(missing.code, Some(2), "{}", missing.stderr);
    let missing = dir.raceway_after(r"set -- resume $'bad\xff'", &[]);
    assert_eq!(missing.code, Some(2), "{}", missing.stderr);
    let words = r#"cp scene.toml $'good\xff.toml'; set -- run $'good\xff.toml' --out run "$@""#;
    let run = dir.raceway_after(words, &RIGID);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let log = dir.text("run/run.log");
    assert!(log.contains("run good\u{fffd}.toml --out run"), "{log}");
}
