//! A bearing type in a file of its own, through the whole program: run, resume, study.

use crate::resume::{refused, resumed};
use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::{Dir, RIGID, SCENE};

/// Splits a scene: the first tables, up to `[contact]`, are put into `types/type.toml`.
fn split(dir: &Dir) {
    let text = dir.text("scene.toml");
    let (title, rest) = text.split_once("[bearing]").unwrap();
    let (kind, rest) = rest.split_once("[contact]").unwrap();
    std::fs::create_dir_all(dir.path("types")).unwrap();
    dir.write("types/type.toml", format!("[bearing]{kind}"));
    dir.write(
        "scene.toml",
        format!("{title}include = \"types/type.toml\"\n\n[contact]{rest}"),
    );
}

/// Wrong: a scene that includes its bearing would give other results than the same tables in one file.
#[test]
fn a_scene_with_an_included_bearing_has_the_results_of_one_file() {
    let dir = Dir::with_scene(SCENE);
    dir.run("one", &RIGID);
    split(&dir);
    let said = dir.raceway(&[
        "check",
        "scene.toml",
        RIGID[0],
        RIGID[1],
        RIGID[2],
        RIGID[3],
        RIGID[4],
        RIGID[5],
    ]);
    assert_eq!(said.code, Some(0), "{}", said.stderr);
    dir.run("two", &RIGID);
    assert!(dir.text("one/balls.csv") == dir.text("two/balls.csv"));
    let identity = |out: &str| crate::util::tables::summary(&dir, out)["run"].clone();
    assert!(identity("one").is_string());
    assert_eq!(identity("one"), identity("two"));
    // What counts is the content: a comment changes nothing, a number does.
    let kind = dir.text("types/type.toml");
    dir.write("types/type.toml", format!("# a comment\n{kind}"));
    dir.run("three", &RIGID);
    assert_eq!(identity("one"), identity("three"));
    dir.write(
        "types/type.toml",
        kind.replace("width = \"16 mm\"", "width = \"17 mm\""),
    );
    dir.run("four", &RIGID);
    assert_ne!(identity("one"), identity("four"));
}

/// Wrong: a resumed run would take other values of a type file than the run, or need the file.
#[test]
fn a_resumed_run_notices_a_changed_type_and_goes_on_without_it() {
    let dir = small_motion();
    split(&dir);
    dir.run("whole", &[]);
    dir.run("cut", &[]);
    let kind = dir.text("types/type.toml");
    dir.write(
        "types/type.toml",
        kind.replace("width = \"16 mm\"", "width = \"17 mm\""),
    );
    refused(
        &dir,
        &["cut", "--step", "7"],
        &["has changed since the run: bearing.width from \"16 mm\" to \"17 mm\"; put it back, or"],
    );
    std::fs::remove_file(dir.path("types/type.toml")).unwrap();
    refused(
        &dir,
        &["cut", "--step", "7"],
        &[
            "the scene file of the run cannot be compared any more; --stored-scene goes on without it",
            "include: ",
            "types/type.toml cannot be read: No such file or directory",
        ],
    );
    resumed(&dir, &["cut", "--step", "7", "--stored-scene"]);
    assert_same_run(&dir, "whole", "cut");
    dir.write("types/type.toml", kind);
    resumed(&dir, &["cut", "--step", "9"]);
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: a study would mix points of two bearings, or could not vary the type.
#[test]
fn a_study_varies_types_and_notices_changed_ones() {
    let dir = Dir::with_scene(SCENE);
    split(&dir);
    let kind = dir.text("types/type.toml");
    dir.write(
        "types/wide.toml",
        kind.replace("width = \"16 mm\"", "width = \"17 mm\""),
    );
    let study = r#"
title = "Two types"
scene = "scene.toml"
set = ["contact.mode=rigid", "inner.flexible=false", "outer.flexible=false"]
[[axes]]
name = "type"
values = [
    { name = "narrow", set = ["include=types/type.toml"] },
    { name = "wide", set = ["include=types/wide.toml"] },
]
[[quantities]]
name = "z"
summary = "/shaft/displacement_m/2"
unit = "m"
"#;
    dir.write("study.toml", study);
    let run = || dir.raceway(&["study", "study.toml", "--out", "out"]);
    let outcome = run();
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let point = |n: usize| dir.text(&format!("out/points/000{n}/point.json"));
    assert!(point(0).contains("width = \\\"16 mm\\\"") && point(1).contains("width = \\\"17 mm\\\""));
    assert_eq!(run().code, Some(0));
    dir.write(
        "types/wide.toml",
        kind.replace("width = \"16 mm\"", "width = \"18 mm\""),
    );
    let outcome = run();
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("0001 was run with another text of the scene than"),
        "{}",
        outcome.stderr
    );
}
