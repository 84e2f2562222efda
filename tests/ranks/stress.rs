//! Stress that ranks recover together.

use super::{done, on_ranks};
use crate::reduction::REDUCTION;
use crate::sectors::SECTOR;
use crate::util::SCENE;
use crate::util::lockstep::{assert_same_run, small_motion};

/// Equilibria in time of a ring that turns, with loads on its volume. A file every second step.
const SERIES: &str = "[quasi_static]\nduration = \"0.6 ms\"\nstep = \"0.2 ms\"\noutput_every = 2\n\n[speed]\n\
                      inner = \"18000 rpm\"\n\n[effects.frame_rotation]\n\n[effects.gravity]\n\
                      acceleration = \"9.81 m/s2\"\ndirection = [0, -1, 0]";

/// Wrong: stress, with near field or without, at nodes or at integration points, or loads on the volume of a ring,
/// would depend on the number of ranks, more of them than sectors included, or a rank would wait for another.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn stress_has_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    dir.write("series.toml", SCENE.replace("[static]", SERIES));
    let near = ["--set", "stress.near_field=true"];
    let points = ["--set", "output.stress=integration_points"];
    for (k, kind) in [&near[..], &points[..], &[near, points].concat()]
        .into_iter()
        .enumerate()
    {
        let arguments = [&["run", "series.toml"], &SECTOR[..], kind, &["--out"]].concat();
        let alone = format!("alone{k}");
        done(&dir.raceway(&[&arguments[..], &[&alone]].concat()));
        for ranks in [2, 3, 6] {
            let out = format!("{k}on{ranks}");
            done(&on_ranks(&dir, ranks, &[&arguments[..], &[&out]].concat()));
            assert_same_run(&dir, &alone, &out);
            let summary = dir.text(&format!("{out}/summary.json"));
            assert!(
                summary.contains("\"gather\""),
                "ranks have recovered stress together: {summary}"
            );
        }
    }
}

/// Wrong: what is kept in a region, in some files, or found of a whole run would depend on the number of ranks, on
/// stress that step files have or not.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn regions_and_extremes_have_the_same_bits_on_any_number_of_ranks() {
    let dir = small_motion();
    dir.write("series.toml", SCENE.replace("[static]", SERIES));
    let fields = [
        "--set",
        "output.every.displacement=2",
        "--set",
        "output.region.raceway_distance=1 mm",
    ];
    for kind in ["nodal", "none", "integration_points"] {
        let stress = format!("output.stress={kind}");
        let both = [
            "--set",
            "output.region.fields=[\"stress\", \"displacement\"]",
            "--set",
            &stress,
        ];
        let arguments = [
            &["run", "series.toml"],
            &SECTOR[..],
            &fields,
            &REDUCTION,
            &both,
            &["--out"],
        ]
        .concat();
        let alone = format!("alone_{kind}");
        done(&dir.raceway(&[&arguments[..], &[&alone]].concat()));
        for ranks in [2, 3] {
            let out = format!("{kind}_on{ranks}");
            done(&on_ranks(&dir, ranks, &[&arguments[..], &[&out]].concat()));
            for name in [
                "reduction.vtkhdf",
                "step_000000.hdf",
                "step_000002.hdf",
                "step_000003.hdf",
            ] {
                let read = |folder: &str| std::fs::read(dir.path(folder).join(name)).unwrap();
                assert!(read(&alone) == read(&out), "{name} with {kind} on {ranks} ranks");
            }
        }
    }
}
