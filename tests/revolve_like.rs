//! The periodic mesh of a ring whose mesh is free: `raceway mesh --revolve-like`, and the line that offers it.

use crate::first_hour::has_gmsh;
use crate::util::Dir;
use crate::util::rings::coarse_files;
use crate::util::tables::Table;

/// The free mesh of the 7010C's inner ring.
const FREE: &[u8] = include_bytes!("../meshes/7010c_inner_tet10.msh");

/// What `raceway` with these words says; it must succeed.
#[track_caller]
fn done(dir: &Dir, words: &[&str]) -> String {
    let outcome = dir.raceway(words);
    assert_eq!(outcome.code, Some(0), "{words:?}: {}", outcome.stderr);
    outcome.stdout
}

/// Wrong: the periodic mesh of a free one would be another ring: other forces, or none that a run accepts; or a
/// command that fails would leave a file, or replace one.
#[test]
fn a_free_ring_and_its_periodic_mesh_carry_the_same_forces() {
    if !has_gmsh() {
        eprintln!("skipped: the section of this test is meshed by Gmsh, which is not installed");
        return;
    }
    let dir = Dir::with_meshes();
    dir.write("free.msh", FREE);
    let like = [
        "mesh",
        "--revolve-like",
        "free.msh",
        "--sectors",
        "90",
        "--groove-elements",
        "8",
    ];
    let said = done(&dir, &like);
    assert!(said.contains("free.msh: a body of revolution, "), "{said}");
    assert!(
        said.contains("groove   radius 4.650000 mm about r = 32.655000 mm, z = "),
        "{said}"
    );
    assert!(said.contains("bottom diameter 56.010000 mm"), "{said}");
    assert!(
        said.contains("bore diameter 50.000000 mm, width 16.000000 mm"),
        "{said}"
    );
    assert!(
        said.contains("free_periodic.msh: ") && said.contains(", 90 equal sectors"),
        "{said}"
    );
    assert!(
        said.contains("scene    inner.mesh = \"free_periodic.msh\"\n"),
        "{said}"
    );
    let made = std::fs::read(dir.path("free_periodic.msh")).unwrap();
    let again = dir.raceway(&like);
    assert_eq!(again.code, Some(2));
    assert!(
        again
            .stderr
            .contains("free_periodic.msh exists already; give --force to replace it, or another --out")
    );
    assert_eq!(std::fs::read(dir.path("free_periodic.msh")).unwrap(), made);

    let mut forces = Vec::new();
    for (mesh, solver) in [
        ("free.msh", "not rotationally periodic"),
        ("free_periodic.msh", "90 equal sectors"),
    ] {
        let set = format!("inner.mesh={mesh:?}");
        let check = done(&dir, &["check", "scene.toml", "--set", &set]);
        assert!(check.contains(solver), "{check}");
        let offer = "advice   the inner ring is a body of revolution, but its mesh has no equal sectors";
        let command = "raceway mesh --revolve-like free.msh --sectors 180\n";
        let n_offers = usize::from(mesh == "free.msh");
        assert_eq!(
            [offer, command].map(|part| check.matches(part).count()),
            [n_offers; 2],
            "{check}"
        );
        let out = mesh.replace(".msh", "");
        let outcome = dir.run(&out, &["--set", &set]);
        assert_eq!(
            outcome
                .stderr
                .matches("the inner ring is a body of revolution")
                .count(),
            n_offers
        );
        forces.push(Table::read(&dir, &format!("{out}/balls.csv")).column("inner_force_n"));
    }
    // Two meshes of one ring with clamped bore; hexahedra of this size are good to 0.5 %.
    let most = forces[0].iter().copied().fold(0.0, f64::max);
    let change = forces[0]
        .iter()
        .zip(&forces[1])
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(most > 400.0 && change < 5e-3 * most, "{change} of {most}");
}

/// Wrong: a wrong call would do something else than say what is wrong, or would leave files.
#[test]
fn wrong_calls_are_refused_and_leave_nothing() {
    let dir = Dir::empty();
    dir.write("ring.msh", &coarse_files()[0]);
    dir.write("free.msh", FREE);
    let before = dir.snapshot();
    for (words, expected) in [
        ("--revolve-like ring.msh", "--sectors"),
        ("--sectors 90", "<SCENE>"),
        (
            "--revolve-like ring.msh --sectors 2",
            "sectors is 2; expected 3 to 100000",
        ),
        (
            "--revolve-like ring.msh --sectors 90 --groove-elements 7",
            "expected an even number",
        ),
        (
            "--revolve-like ring.msh --sectors 90 --grading 9",
            "grading is 9; expected 1 (even) to 3",
        ),
        (
            "--revolve-like ring.msh --sectors 90 --out ring.msh --force",
            "is the mesh that is to be revolved",
        ),
        (
            "--revolve-like ring.msh --sectors 90 --tolerance 0um",
            "expected a positive length",
        ),
        ("--revolve-like ring.msh --sectors 90 --mesh-unit kg", "kg"),
        ("--revolve-like none.msh --sectors 90", "cannot read none.msh"),
        (
            "scene.toml --revolve-like ring.msh --sectors 90",
            "cannot be used with",
        ),
        (
            "--revolve-like free.msh --sectors 90 --tolerance 1e-16m",
            "nodes of its surface are off the section",
        ),
    ] {
        let arguments: Vec<&str> = ["mesh"].into_iter().chain(words.split(' ')).collect();
        let outcome = dir.raceway(&arguments);
        assert_eq!(outcome.code, Some(2), "{words}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(expected), "{words}: {}", outcome.stderr);
        assert!(dir.snapshot() == before, "{words}");
    }
}
