//! A list of bearings at an instant: where the parts of its bearings stand, and the loads on its shaft.

use assembly::{Assembly, AssemblyError, MountedBearing};
use dynamics::Pose;
use dynamics::effects::Now;
use dynamics::kinematics::{Rolling, Speed};
use scene::{SeveralScene, loads_on_shaft, rolling};

/// How the parts of every bearing roll, in its own frame; None: nothing turns.
pub fn rolling_of_all(scene: &SeveralScene) -> Vec<Option<Rolling>> {
    let bearings = scene.bearings.iter();
    bearings.map(|bearing| rolling(&bearing.scene)).collect()
}

/// Where the parts of every bearing stand at a time, s, in its own frame.
pub fn poses(rolling: &[Option<Rolling>], assembly: &Assembly, time: f64) -> Vec<Pose> {
    let pose = |(rolling, mounted): (&Option<Rolling>, &MountedBearing)| {
        let at_rest = || Rolling::new(&mounted.model.geometry, Speed::constant(0.0), [0.0; 2]);
        rolling.clone().unwrap_or_else(at_rest).pose(time)
    };
    rolling.iter().zip(&assembly.bearings).map(pose).collect()
}

/// Puts the loads of a time, s, on the shaft.
pub fn load_at(scene: &SeveralScene, assembly: &mut Assembly, time: f64) -> Result<(), AssemblyError> {
    let now = Now {
        time,
        ..Now::default()
    };
    let Assembly { shaft, bearings, .. } = &*assembly;
    let load = loads_on_shaft(scene, (shaft, bearings), &now);
    assembly.load = load.map_err(|error| AssemblyError::ShaftBody {
        problem: error.to_string(),
    })?;
    Ok(())
}
