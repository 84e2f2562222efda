//! Commands write over nothing but what the program wrote itself, never through a link, and whole files or none.

use std::os::unix::fs::symlink;

use crate::remarks::SECTION;
use crate::resume::{moved, refused};
use crate::study::inputs;
use crate::util::{Dir, RIGID, SCENE, with_line};

/// Wrong: a report, a figure, a count of cycles or an export would replace a file of the user's, or one that
/// a link leads to.
#[test]
fn a_file_that_is_not_the_programs_own_stays() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    let report = |path: &str| dir.raceway(&["report", "out", "--out", path]);
    let outcome = report("scene.toml");
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let said = "error: scene.toml was not written by this command, so it is not written over; \
                move it away, or give another --out where the command has one";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    assert_eq!(dir.text("scene.toml"), SCENE);
    // Its own page is replaced, a link is neither followed nor replaced.
    assert_eq!([report("page.html").code, report("page.html").code], [Some(0); 2]);
    dir.write("precious", "precious");
    for (name, command) in [
        ("report.html", &["report", "out"][..]),
        ("figures/ball_force.svg", &["plot", "out"]),
        ("figures/ball_force.png", &["plot", "out"]),
        (".raceway.lock", &["pack", "out"]),
    ] {
        std::fs::create_dir_all(dir.path("out/figures")).unwrap();
        let path = dir.path(&format!("out/{name}"));
        let _ = std::fs::remove_file(&path);
        symlink(dir.path("precious"), &path).unwrap();
        let outcome = dir.raceway(command);
        assert_eq!(outcome.code, Some(2), "{name}: {}", outcome.stderr);
        assert!(
            outcome.stderr.contains("is no plain file"),
            "{name}: {}",
            outcome.stderr
        );
        assert_eq!(dir.text("precious"), "precious", "{name}");
        std::fs::remove_file(&path).unwrap();
    }
    // A figure of another program's.
    dir.write("out/figures/ball_force.svg", "<?xml version=\"1.0\"?><svg/>");
    let outcome = dir.raceway(&["plot", "out"]);
    assert!(
        outcome
            .stderr
            .contains("ball_force.svg was not written by this command"),
        "{}",
        outcome.stderr
    );
    std::fs::remove_file(dir.path("out/figures/ball_force.svg")).unwrap();
    for _ in 0..2 {
        assert_eq!(dir.raceway(&["plot", "out"]).code, Some(0));
    }
}

/// Wrong: temporary names that somebody made links would lead a run to write over other files.
#[test]
fn a_run_writes_through_no_link() {
    let dir = Dir::with_scene(SCENE);
    dir.write("precious", "precious");
    std::fs::create_dir(dir.path("out")).unwrap();
    for name in [
        ".mesh.hdf.tmp",
        ".step_000000.hdf.tmp",
        ".run.hdf.series.tmp",
        ".run.vtkhdf.tmp",
        "summary.json.tmp",
    ] {
        symlink(dir.path("precious"), dir.path(&format!("out/{name}"))).unwrap();
    }
    dir.run("out", &RIGID);
    assert_eq!(dir.text("precious"), "precious");
    let other = Dir::with_scene(SCENE);
    other.write("precious", "precious");
    std::fs::create_dir(other.path("out")).unwrap();
    symlink(other.path("nowhere"), other.path("out/energy.csv")).unwrap();
    let outcome = other.raceway(&[&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("out/energy.csv"), "{}", outcome.stderr);
    assert!(!other.path("nowhere").exists());
}

/// Wrong: a full disk would leave an empty page, or half a figure, in the place of a whole one. A limit on
/// the size of files stands for the full disk.
#[test]
fn a_full_disk_leaves_the_old_file() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    for (command, name) in [("report", "report.html"), ("plot", "figures/ball_force.svg")] {
        assert_eq!(dir.raceway(&[command, "out"]).code, Some(0));
        let before = dir.text(&format!("out/{name}"));
        let outcome = dir.raceway_with_small_files(4, &[command, "out"]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("File too large"), "{}", outcome.stderr);
        assert_eq!(dir.text(&format!("out/{name}")), before, "{name}");
        let hidden = dir
            .snapshot()
            .into_keys()
            .find(|path| path.extension().is_some_and(|e| e == "tmp"));
        assert_eq!(hidden, None);
    }
}

/// Wrong: figures or an export would land in a folder elsewhere that a link leads to. One that a user names may be a
/// link.
#[test]
fn a_folder_in_the_results_that_is_a_link_is_not_followed() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    std::fs::create_dir(dir.path("elsewhere")).unwrap();
    for (command, name) in [
        (&["plot", "out"][..], "figures"),
        (&["export", "out", "--to", "vtu"], "export"),
    ] {
        let link = dir.path(&format!("out/{name}"));
        symlink(dir.path("elsewhere"), &link).unwrap();
        let outcome = dir.raceway(command);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        let said = format!(
            "error: out/{name} is a link or a file; expected a folder or nothing there, remove it or choose another \
             --out"
        );
        assert!(outcome.stderr.contains(&said), "{}", outcome.stderr);
        assert_eq!(std::fs::read_dir(dir.path("elsewhere")).unwrap().count(), 0);
        std::fs::remove_file(&link).unwrap();
        let named = format!("named_{name}");
        symlink(dir.path("elsewhere"), dir.path(&named)).unwrap();
        let named = [command, &["--out", &named]].concat();
        assert_eq!(dir.raceway(&named).code, Some(0));
        assert!(std::fs::read_dir(dir.path("elsewhere")).unwrap().count() > 0);
        std::fs::remove_dir_all(dir.path("elsewhere")).unwrap();
        std::fs::create_dir(dir.path("elsewhere")).unwrap();
    }
}

/// Wrong: a study would empty the file that a link in the place of its lock leads to, or run in a folder elsewhere.
#[test]
fn a_study_writes_through_no_link() {
    let dir = inputs();
    dir.write("precious", "precious");
    std::fs::create_dir(dir.path("elsewhere")).unwrap();
    std::fs::create_dir_all(dir.path("out/points/0000")).unwrap();
    std::fs::create_dir_all(dir.path("out/points/0003")).unwrap();
    symlink(dir.path("precious"), dir.path("out/points/0000/.lock")).unwrap();
    symlink(dir.path("elsewhere"), dir.path("out/points/0001")).unwrap();
    for (point, said) in [
        ("0", "cannot open the lock "),
        ("1", "out/points/0001 is a link or a file; expected a folder"),
    ] {
        let outcome = dir.raceway(&["study", "study.toml", "--out", "out", "--point", point]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    }
    assert_eq!(dir.text("precious"), "precious");
    assert_eq!(std::fs::read_dir(dir.path("elsewhere")).unwrap().count(), 0);
}

/// Wrong: a run that goes on would cut and continue a table elsewhere.
#[test]
fn a_run_goes_on_in_no_table_that_is_a_link() {
    let dir = moved();
    std::fs::rename(dir.path("whole/balls.csv"), dir.path("table")).unwrap();
    symlink(dir.path("table"), dir.path("whole/balls.csv")).unwrap();
    let said =
        "whole/balls.csv: it is a link, and nothing is written through one; put the file itself in its place";
    refused(&dir, &["whole", "--step", "0"], &[said]);
}

/// Wrong: Gmsh would write through a link in the place of its file, or `--force` replace a file that is no mesh.
#[test]
fn the_meshing_writes_over_meshes_only() {
    let dir = Dir::with_scene(&with_line("[outer]", "[outer]", SECTION));
    dir.write("precious", "precious");
    symlink(dir.path("precious"), dir.path("inner.section.new.msh")).unwrap();
    let path = dir.program("gmsh", "for last; do true; done\necho '$MeshFormat' > \"$last\"");
    let mesh = || dir.raceway_with(&[("PATH", &path)], &["mesh", "scene.toml"]);
    let outcome = mesh();
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("inner.section.msh"), "{}", outcome.stderr);
    assert_eq!(dir.text("inner.section.msh"), "$MeshFormat\n");
    assert_eq!(dir.text("precious"), "precious");
    // A section that was there without its geometry is the user's.
    std::fs::remove_file(dir.path("inner.geo")).unwrap();
    let outcome = mesh();
    let said = "cannot write inner.section.msh: it was not written by raceway mesh; move it away";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
}
