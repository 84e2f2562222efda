//! A small motion that is cut and resumed, and the comparison with the run that was not.

use std::path::Path;
use std::sync::OnceLock;

use checkpoint::{StepRecord, committed_steps, read_step, step_file_name};
use mesh::MshFormat;

use super::rings::{Level, file, ring};
use super::{Dir, SCENE};

/// Few enough nodes for a step to take milliseconds.
const SMALL: Level = Level {
    sectors: 54,
    groove: 6,
    shoulder: 1,
    thickness: 1,
};

/// 20 steps, a file each. The radial force unloads balls, the speed makes everything move.
const SMALL_MOTION: &str = "[dynamic]\nduration = \"0.4 ms\"\nstep = \"20 us\"\nledger_tolerance = \
                            1e-3\n\n[speed]\ninner = \"12000 rpm\"";

/// Scene and meshes of the small motion.
pub fn small_motion() -> Dir {
    static MESHES: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    let meshes = MESHES.get_or_init(|| {
        let text = |side| file(&ring(side, SMALL), 1e-3, MshFormat::Binary);
        [text(mesh::RingSide::Inner), text(mesh::RingSide::Outer)]
    });
    let scene = SCENE
        .replace("[static]", SMALL_MOTION)
        .replace("value = \"2 kN\"", "value = \"0.4 kN\"");
    let dir = Dir::with_scene(&scene);
    dir.write("inner.msh", &meshes[0]);
    dir.write("outer.msh", &meshes[1]);
    dir
}

/// Fails unless the folder `cut` holds the steps of the folder `whole` (it may hold more), equal in every bit, and the
/// same tables.
#[track_caller]
pub fn assert_same_run(dir: &Dir, whole: &str, cut: &str) {
    let (whole, cut) = (dir.path(whole), dir.path(cut));
    let steps = committed_steps(&whole).unwrap();
    assert!(!steps.is_empty());
    for step in steps {
        let read = |folder: &Path| read_step(&folder.join(step_file_name(step))).unwrap();
        if let Some(field) = first_difference(&read(&whole), &read(&cut)) {
            panic!("step {step} differs first in {field}");
        }
    }
    let own = ["cage.csv", "probes.csv"]
        .into_iter()
        .filter(|name| whole.join(name).exists());
    for name in ["balls.csv", "shaft.csv", "energy.csv"].into_iter().chain(own) {
        let read = |folder: &Path| std::fs::read_to_string(folder.join(name)).unwrap();
        let (whole, cut) = (read(&whole), read(&cut));
        let differ = whole.lines().zip(cut.lines()).find(|(a, b)| a != b);
        assert!(whole == cut, "{name} differs first at {differ:?}");
    }
}

/// The first field whose bits differ; scene texts may, they hold the duration.
fn first_difference(a: &StepRecord, b: &StepRecord) -> Option<String> {
    if a.time.to_bits() != b.time.to_bits() {
        return Some(format!("time: {:?} and {:?}", a.time, b.time));
    }
    if !a.state.keys().eq(b.state.keys()) {
        return Some("the names of the state arrays".to_string());
    }
    // Debug prints every f64 as the shortest text that is this number only.
    let state = a.state.iter().zip(b.state.values());
    let mut state = state.filter(|((_, a), b)| format!("{a:?}") != format!("{b:?}"));
    if let Some(((name, _), _)) = state.next() {
        return Some(format!("state array {name}"));
    }
    let (p, q) = (&a.points, &b.points);
    let fields = [
        ("displacement", p.displacement == q.displacement),
        ("stress", p.stress == q.stress),
        ("von_mises", p.von_mises == q.von_mises),
        ("force_inner", p.force_inner == q.force_inner),
        ("force_outer", p.force_outer == q.force_outer),
        ("fields over cells", a.cells == b.cells),
        ("all fields", p == q),
    ];
    let different = fields.iter().find(|(_, same)| !same);
    different.map(|(name, _)| name.to_string())
}

/// Copies a result folder with all that is in it.
pub fn copy(dir: &Dir, from: &str, to: &str) {
    copy_folder(&dir.path(from), &dir.path(to));
}

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let (path, name) = entry.map(|e| (e.path(), e.file_name())).unwrap();
        if path.is_dir() {
            copy_folder(&path, &to.join(name));
        } else {
            std::fs::copy(&path, to.join(name)).unwrap();
        }
    }
}
