//! Runs whose ranks keep parts of the meshes, with all that looks at places of nodes.

use super::{done, on_ranks};
use crate::sectors::SECTOR;
use crate::util::SCENE;
use crate::util::lockstep::{assert_same_run, small_motion};

/// Held in their mean motion, weighed, in a turning frame, probed at nodes of both rings and inside.
const EVERYTHING: &str = "
[effects.frame_rotation]

[effects.gravity]
acceleration = \"9.81 m/s2\"
direction = [0, -1, 0]

[probes.node.raceway]
ring = \"inner\"
azimuth = \"170 deg\"
groove_angle = \"15 deg\"

[probes.node.inside]
ring = \"outer\"
azimuth = \"200 deg\"
r = \"38.5 mm\"
z = \"1 mm\"

[probes.point.below]
ring = \"outer\"
azimuth = \"140 deg\"
groove_angle = \"15 deg\"
depth = \"0.2 mm\"
";

const MEAN: [&str; 4] = [
    "--set",
    "inner.support=mean_motion",
    "--set",
    "outer.support=mean_motion",
];

/// Wrong: a rank would lack the position of a node that it needs, or sum over the nodes in another order: rings held
/// in their mean motion or clamped, in motion, at rest and in a sweep of the weight, whose probes lie in sectors of
/// other ranks than the first.
#[test]
#[ignore = "needs mpirun and a program built with MPI: scripts/test-mpi"]
fn parts_of_meshes_give_the_same_bits_as_whole_ones() {
    let dir = small_motion();
    let motion = dir.text("scene.toml") + EVERYTHING;
    dir.write("scene.toml", motion);
    dir.write(
        "still.toml",
        SCENE.to_string() + EVERYTHING.replace("[effects.frame_rotation]\n", "").as_str(),
    );
    let swept = SCENE.replace(
        "[static]",
        "[sweep]\nkey = \"effects.gravity.acceleration\"\nvalues = [\"10 m/s2\", \"1e4 m/s2\"]\n",
    );
    dir.write(
        "sweep.toml",
        swept + EVERYTHING.replace("[effects.frame_rotation]\n", "").as_str(),
    );
    let facets = ["--set", "contact.mode=facet"];
    let cases = [
        ("scene.toml", &MEAN[..]),
        ("scene.toml", &[]),
        ("still.toml", &MEAN[..]),
        ("still.toml", &facets[..]),
        ("sweep.toml", &MEAN[..]),
    ];
    for (k, (scene, more)) in cases.into_iter().enumerate() {
        let arguments = [&["run", scene], &SECTOR[..], more, &["--out"]].concat();
        let alone = format!("alone{k}");
        done(&dir.raceway(&[&arguments[..], &[&alone]].concat()));
        for ranks in [2, 4] {
            let out = format!("{k}on{ranks}");
            done(&on_ranks(&dir, ranks, &[&arguments[..], &[&out]].concat()));
            if scene == "scene.toml" {
                assert_same_run(&dir, &alone, &out);
            }
            for name in ["balls.csv", "shaft.csv", "probes.csv", "mesh.hdf"] {
                let read = |folder: &str| std::fs::read(dir.path(&format!("{folder}/{name}"))).unwrap();
                assert!(
                    read(&alone) == read(&out),
                    "{scene} {more:?}: {name} of {ranks} ranks differs"
                );
            }
        }
    }
}
