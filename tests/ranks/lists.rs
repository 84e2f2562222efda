//! Lists of bearings whose rings ranks share.

use std::path::{Path, PathBuf};

use super::{SECONDS, different, done, on_ranks, program};
use crate::sectors::SECTOR;
use crate::several::flexible_pair;
use crate::shared_housing::{FEW, SCENE as HOUSING, moving};
use crate::util::Dir;
use crate::util::delivered::delivered;
use crate::util::lockstep::copy;

/// A pair that speeds up under a load across, with all that a list keeps of a motion.
const MOTION: &str = "[speed]\ninner = { times = [\"0 ms\", \"1 ms\"], values = [\"1800 rpm\", \"6000 rpm\"] }\n\
                      [effects.radial_force]\nvalue = \"0.5 kN\"\ndirection = \"30 deg\"\n\
                      schedule.step = { at = \"60 us\" }\n\
                      [output]\nrestart_every = 2\nreduction = { every = 2 }\n\
                      [dynamic]\nduration = \"240 us\"\nstep = \"20 us\"\noutput_every = 2\n\
                      ledger_tolerance = 1e-2\n";
const SWEEP: &str = "[effects.radial_force]\nvalue = \"0.5 kN\"\ndirection = \"30 deg\"\n\
                     [sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0.2 kN\", \"0.5 kN\"]\n";

/// Files of a folder and of those in it whose bytes a run determines: tables, meshes, steps, what is found of all
/// steps; without those that a resumed run has moved aside.
fn determined(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        let counts = [".csv", ".hdf"].iter().any(|end| name.ends_with(end)) || name == "reduction.vtkhdf";
        match path.is_dir() {
            true if name.starts_with("superseded_") => {}
            true => found.extend(determined(&path)),
            false if counts => found.push(path),
            false => {}
        }
    }
    found.sort();
    found
}

/// Fails unless two folders have the same files with the same bytes.
#[track_caller]
fn assert_same_list(dir: &Dir, whole: &str, other: &str) {
    let [whole, other] = [whole, other].map(|name| dir.path(name));
    let names = |folder: &Path| -> Vec<PathBuf> {
        let files = determined(folder).into_iter();
        files
            .map(|path| path.strip_prefix(folder).unwrap().to_path_buf())
            .collect()
    };
    assert_eq!(names(&whole), names(&other));
    for name in names(&whole) {
        let read = |folder: &Path| std::fs::read(folder.join(&name)).unwrap();
        assert!(read(&whole) == read(&other), "{}", name.display());
    }
}

/// Runs a scene by one process and by several ranks: the same bytes.
fn assert_ranks_agree(dir: &Dir, (scene, name): (&str, &str), more: &[&str], ranks: &[(usize, &str)]) {
    let alone = format!("{name}_alone");
    let run = ["run", scene, "--out", &alone];
    done(&dir.raceway(&[&run[..], more].concat()));
    assert!(determined(&dir.path(&alone)).len() > 8, "files of a list");
    for &(ranks, threads) in ranks {
        let out = format!("{name}_{ranks}");
        let run = ["run", scene, "--out", &out, "--threads", threads];
        done(&on_ranks(dir, ranks, &[&run[..], more].concat()));
        assert_same_list(dir, &alone, &out);
    }
}

/// Wrong: bearings of a list would stand or move otherwise where ranks share their harmonics or sectors.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_pair_on_a_beam_has_the_same_bits_on_any_number_of_ranks() {
    let dir = flexible_pair(MOTION);
    let sweep = flexible_pair(SWEEP);
    assert_ranks_agree(
        &dir,
        ("pair.toml", "cyclic"),
        &[],
        &[(2, "1"), (3, "2"), (4, "1")],
    );
    assert_ranks_agree(&sweep, ("pair.toml", "cyclic"), &[], &[(2, "2"), (3, "1")]);
    let points = ["--set", "output.stress=integration_points"];
    let sectors = [&SECTOR[..], &points].concat();
    assert_ranks_agree(&dir, ("pair.toml", "sector"), &sectors, &[(2, "2"), (3, "1")]);
    assert_ranks_agree(&sweep, ("pair.toml", "sector"), &sectors, &[(3, "1")]);
    let sparse = ["--set", "solver.backend=sparse"];
    assert_ranks_agree(&dir, ("pair.toml", "sparse"), &sparse, &[(2, "2")]);
}

/// Wrong: bearings that feel each other through one housing would do so otherwise on several ranks.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_pair_in_one_housing_has_the_same_bits_on_any_number_of_ranks() {
    let dir = delivered();
    moving(&dir);
    assert_ranks_agree(&dir, (HOUSING, "rest"), &FEW, &[(2, "1"), (3, "1")]);
    assert_ranks_agree(&dir, ("moving.toml", "moving"), &FEW, &[(2, "2"), (3, "1")]);
}

/// Wrong: a list could not move to another machine. 3 ranks, one process without MPI, 2 ranks.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_list_goes_on_with_another_number_of_ranks_bit_for_bit() {
    let dir = flexible_pair(MOTION);
    done(&dir.raceway(&["run", "pair.toml", "--out", "whole"]));
    done(&on_ranks(&dir, 3, &["run", "pair.toml", "--out", "cut"]));
    for (ranks, step) in [(1, "8"), (2, "4"), (3, "4")] {
        let out = format!("cut{ranks}");
        copy(&dir, "cut", &out);
        let resume = ["resume", &out, "--step", step];
        done(&match ranks {
            1 => dir.raceway(&resume),
            _ => on_ranks(&dir, ranks, &resume),
        });
        assert_same_list(&dir, "whole", &out);
    }
}

/// Wrong: a list that one rank reads otherwise, or not at all, would leave the others waiting.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn a_list_that_one_rank_reads_otherwise_ends_all_with_its_message() {
    let dir = flexible_pair(MOTION);
    dir.write("bad.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    done(&dir.raceway(&["run", "pair.toml", "--out", "cut"]));
    let program = program();
    let run = [&program[..], "run", "pair.toml", "--out", "out"];
    let with = |set| [&run[..], &["--set", set]].concat();
    let bad = with("inner.mesh=bad.msh");
    let resume = [&program[..], "resume", "cut", "--step", "4"];
    let elsewhere = [&["env", "-C", "/"][..], &resume].concat();
    for (first, others, text) in [
        (&run[..], &with("pairing.offset=\"10 um\"")[..], "pairing.offset"),
        (&run, &with("bearing.balls=17"), "bearing.balls"),
        (&run, &bad, "is not that of rank 0: inner.mesh"),
        (&bad, &bad, "bad.msh"),
        (&elsewhere, &resume, "cut"),
        (&resume, &elsewhere, "cut is no folder"),
    ] {
        let (outcome, time) = different(&dir, first, others);
        assert_eq!(outcome.code, Some(2), "{text}: {}", outcome.stderr);
        let errors = outcome.stderr.lines().filter(|line| line.starts_with("error: "));
        let errors: Vec<&str> = errors.collect();
        assert!(
            errors.len() == 1 && errors[0].contains(text),
            "{text}: {}",
            outcome.stderr
        );
        assert!(time < SECONDS, "{time:?}");
        assert!(!dir.path("out").exists(), "{text}");
    }
}
