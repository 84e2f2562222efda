//! Damaged results: any bytes as a file of a run, or a sound file with bytes changed and its end cut. It is refused,
//! or what is read is exactly what was written.
//!
//! The first byte of the input chooses: even, the rest is the file; odd, the rest is damage: four bytes of a length
//! to keep (0: all), then places of four bytes and a value each. Its second bit chooses between a step file and the
//! mesh.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use checkpoint::{Grid, Output, StepRecord, Storage};
use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

#[path = "../../crates/checkpoint/tests/suite/fixture.rs"]
#[allow(dead_code)]
mod fixture;

struct Sound {
    dir: TempDir,
    step: Vec<u8>,
    mesh: Vec<u8>,
    record: StepRecord,
    grid: Grid,
}

const STEP: &str = "step_000004.hdf";

fn sound() -> &'static Sound {
    static SOUND: OnceLock<Sound> = OnceLock::new();
    SOUND.get_or_init(|| {
        let dir = tempfile::tempdir().unwrap();
        let mut output = Output::create(dir.path(), &fixture::bodies(), Storage::default()).unwrap();
        let path = output.write_step(&fixture::record(4)).unwrap();
        Sound {
            step: std::fs::read(&path).unwrap(),
            mesh: std::fs::read(dir.path().join("mesh.hdf")).unwrap(),
            record: checkpoint::read_step(&path).unwrap(),
            grid: checkpoint::read_mesh(dir.path()).unwrap(),
            dir,
        }
    })
}

/// The file with the damage that the input says.
fn damaged(file: &[u8], damage: &[u8]) -> Vec<u8> {
    let number = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap()) as usize;
    let mut file = file.to_vec();
    let Some((length, places)) = damage.split_at_checked(4) else { return file };
    for place in places.chunks_exact(5) {
        let at = number(&place[..4]) % file.len();
        file[at] = place[4];
    }
    match number(length) % (file.len() + 1) {
        0 => {}
        keep => file.truncate(keep),
    }
    file
}

fuzz_target!(|data: &[u8]| {
    let Some((choice, rest)) = data.split_first() else { return };
    let sound = sound();
    let is_mesh = choice & 2 != 0;
    let whole = if is_mesh { &sound.mesh } else { &sound.step };
    let bytes = if choice & 1 == 0 { rest.to_vec() } else { damaged(whole, rest) };
    let path: PathBuf = sound.dir.path().join(if is_mesh { "mesh.hdf" } else { STEP });
    std::fs::write(&path, &bytes).unwrap();
    if is_mesh {
        if let Ok(grid) = checkpoint::read_mesh(sound.dir.path()) {
            assert!(grid == sound.grid, "a damaged mesh is read as another one");
        }
        std::fs::write(&path, &sound.mesh).unwrap();
    } else {
        if let Ok(record) = checkpoint::read_step(&path) {
            assert!(format!("{record:?}") == format!("{:?}", sound.record), "a damaged step is read as another one");
        }
        let _ = (checkpoint::read_step_time(&path), checkpoint::read_about(&path));
        let _ = checkpoint::committed_steps(sound.dir.path());
    }
    let _ = checkpoint::describe(&path);
});
