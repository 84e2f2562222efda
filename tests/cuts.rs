//! Parts cut out of the meshes of rings: a spall and a keyway in a whole run.

use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::tables::Table;
use crate::util::{Dir, SCENE};

/// A part of a shoulder of the inner ring, three elements long, and one of the outer ring, across azimuth 0.
pub const CUTS: &str = "\n[[inner.cut]]\nazimuth = [\"47 deg\", \"65 deg\"]\nz = [\"5 mm\", \"8 mm\"]\n\n\
                        [[outer.cut]]\nazimuth = [\"-10 deg\", \"10 deg\"]\nz = [\"-8 mm\", \"-5 mm\"]\n";

/// The small motion with these parts cut out.
pub fn cut_motion() -> Dir {
    let dir = small_motion();
    let scene = dir.text("scene.toml") + CUTS;
    dir.write("scene.toml", scene);
    dir
}

/// Wrong: a ring with a part cut out would be another one to harmonics than to a sparse factor, its bits would depend
/// on the number of threads, or a run that was cut short would go on otherwise. That the ledger closes in every step,
/// the program checks itself.
#[test]
fn a_motion_of_cut_rings_has_the_same_bits_resumes_and_agrees_with_sparse_factors() {
    let dir = cut_motion();
    let run = |out: &str, more: &[&str]| {
        let outcome = dir.raceway(&[&["run", "scene.toml", "--out", out], more].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        outcome.stderr
    };
    let log = run("whole", &["--threads", "1"]);
    for part in [
        "cyclic (54 equal sectors but for 3 missing elements in 3 of them",
        "with 4 absent nodes",
    ] {
        assert!(log.contains(part), "{log}");
    }
    run("two", &["--threads", "2"]);
    assert_same_run(&dir, "whole", "two");
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let outcome = dir.raceway(&["resume", "cut", "--step", "7", "--threads", "2"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "cut");

    run("sparse", &["--set", "solver.backend=sparse"]);
    let [found, expected] =
        ["whole", "sparse"].map(|out| Table::read(&dir, &format!("{out}/balls.csv")).column("outer_force_n"));
    let largest = expected.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    for (a, b) in found.iter().zip(&expected) {
        assert!((a - b).abs() <= 1e-9 * largest, "{a} and {b}");
    }
    // Without the cuts it is another motion.
    dir.write("scene.toml", dir.text("scene.toml").replace(CUTS, ""));
    run("uncut", &[]);
    let uncut = Table::read(&dir, "uncut/balls.csv").column("outer_force_n");
    let difference = found
        .iter()
        .zip(&uncut)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(difference > 1e-6 * largest, "{difference} N");
}

/// Wrong: `raceway check` would hide that a ring has a defect, what it costs, or that its mesh has fewer nodes than
/// the file.
#[test]
fn check_says_what_is_cut() {
    let dir = cut_motion();
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for part in [
        "rotationally periodic up to a defect; solver cyclic (54 equal sectors but for 3 missing elements in 3 of \
         them, the first beside node ",
        " rows, ",
    ] {
        assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    }
}

/// Wrong: a cut beside the ring would silently cut nothing, or a raceway could vanish.
#[test]
fn cuts_that_take_nothing_or_a_whole_raceway_are_refused() {
    let dir = Dir::with_meshes();
    for (cut, parts) in [
        (
            "azimuth = [\"0 deg\", \"20 deg\"]\nradius = [\"45 mm\", \"46 mm\"]",
            [
                "inner.msh: no element has its centre in the region of cut 1; expected one at least",
                "",
            ],
        ),
        (
            "azimuth = [\"0 deg\", \"360 deg\"]\nz = [\"-5 mm\", \"5 mm\"]",
            ["inner.msh: the cuts take all facets of the group \"", "raceway"],
        ),
    ] {
        dir.write("scene.toml", format!("{SCENE}\n[[inner.cut]]\n{cut}\n"));
        let outcome = dir.raceway(&["check", "scene.toml"]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        for part in parts {
            assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
        }
    }
}

/// Wrong: a backend that cannot be would end as a solution that was not found, exit code 3, and a script would try a
/// finer mesh.
#[test]
fn a_cyclic_solver_for_what_is_not_periodic_is_wrong_input() {
    let free = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/7010c_inner_tet10.msh");
    let free = format!("inner.mesh={:?}", free.to_str().unwrap());
    let cyclic = ["--set", "solver.backend=cyclic"];
    let dir = Dir::with_meshes();
    let not_periodic =
        "the inner ring is not rotationally periodic, so solver.backend = \"cyclic\" cannot be: ";
    let refused = |arguments: &[&str], part: &str| {
        let outcome = dir.raceway(&[arguments, &cyclic].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{arguments:?}: {}", outcome.stderr);
    };
    refused(&["check", "scene.toml", "--set", &free], not_periodic);
    refused(
        &["run", "scene.toml", "--out", "out", "--set", &free],
        not_periodic,
    );
    let cut = "\n[[inner.cut]]\nazimuth = [\"47 deg\", \"65 deg\"]\nz = [\"5 mm\", \"8 mm\"]\n";
    let modes = SCENE.replace("[static]", "[modes]\nnumber = 2\nbodies = [\"inner\"]");
    dir.write("modes.toml", modes + cut);
    refused(
        &["run", "modes.toml", "--out", "out"],
        "the inner ring is rotationally periodic only up to a defect, whose natural modes",
    );
}
