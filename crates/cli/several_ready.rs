//! What a list of bearings needs before its first step: room on the disk, and in motion its matrices.

use std::path::Path;

use assembly::{Assembly, AssemblyError, AssemblyMotion};
use contact::Side;
use dynamics::effects::Now;
use dynamics::stiffness::N_SHAFT;
use results::disk::Forecast;
use results::failure::Failure;
use scene::{Dynamic, SeveralScene, loads_on_shaft, settings};

use crate::options::Limits;
use crate::progress::Progress;
use crate::several::solving;

/// Fails where the disk has no room for the files of all bearings after a step.
pub fn require_space(
    scene: &SeveralScene,
    assembly: &Assembly,
    (dir, done): (&Path, u64),
    limits: &Limits,
) -> Result<(), Failure> {
    forecast(scene, assembly, done).require_space(dir, limits.ignore_disk_space)
}

/// Size of the files of all bearings after a step; of a list at rest those of one load case.
pub fn forecast(scene: &SeveralScene, assembly: &Assembly, done: u64) -> Forecast {
    let bearings = scene.bearings.iter().zip(&assembly.bearings);
    let each = bearings.map(|(bearing, mounted)| Forecast::new(&bearing.scene, &mounted.model, done));
    let n_places = (assembly.shaft.n() / N_SHAFT).max(1) as u64;
    Forecast::of_all(&each.collect::<Vec<_>>(), n_places)
}

/// Bearings and shaft ready to move.
pub fn ready<'a>(
    scene: &'a SeveralScene,
    dynamic: &Dynamic,
    assembly: &'a Assembly,
) -> Result<AssemblyMotion<'a>, Failure> {
    let of_bearings = scene.bearings.iter().map(|b| settings(&b.scene, dynamic));
    let speed = scene.speed.clone().unwrap_or_default().inner;
    let load = |now: &Now<'_>| {
        let bearings = &assembly.bearings[..];
        loads_on_shaft(scene, (&assembly.shaft, bearings), now).map_err(|error| AssemblyError::ShaftBody {
            problem: error.to_string(),
        })
    };
    AssemblyMotion::new(assembly, of_bearings.collect(), speed, Box::new(load)).map_err(solving)
}

/// Says of which rings the inertia of the elastic part is left out.
pub fn say_left_out(motion: &AssemblyMotion<'_>, assembly: &Assembly, progress: &Progress) {
    for (bearing, mounted) in motion.bearings.iter().zip(&assembly.bearings) {
        for side in Side::BOTH {
            if let Some(note) = bearing.left_out(side).map(|of| of.note()) {
                progress.stage(&format!("{} ring of {:?}: {note}", side.name(), mounted.name));
            }
        }
    }
}
