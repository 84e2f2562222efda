//! A list of bearings at an instant: where the parts of its bearings stand, and the loads on its shaft.

use assembly::motion::AssemblyRates;
use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver, MountedBearing};
use dynamics::Pose;
use dynamics::effects::Now;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::motion::{comparison_time, pose_beside};
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

/// An equilibrium at t = 0 found once more, and the velocities at which equilibria follow each other there while the
/// bearings roll; none where none does.
pub fn rolling_start(
    (scene, assembly): (&SeveralScene, &mut Assembly),
    solver: &mut AssemblySolver,
    at: AssemblySolution,
) -> Result<(AssemblySolution, Option<AssemblyRates>), AssemblyError> {
    let rolling = rolling_of_all(scene);
    let of_bearings = rolling.iter().zip(&assembly.bearings);
    let times = of_bearings
        .filter_map(|(rolling, mounted)| comparison_time(&mounted.model.geometry, rolling.as_ref()?));
    // Of the bearing whose balls pass soonest.
    let Some(time) = times.min_by(f64::total_cmp) else {
        return Ok((at, None));
    };
    let start = at.as_start();
    // The last one is that of t = 0: bodies that carry several bearings know its forces then.
    let [before, after, at] = [-time, time, 0.0].map(|time| {
        let pose = |rolling: &Option<Rolling>| {
            rolling
                .as_ref()
                .map_or_else(Pose::default, |rolling| pose_beside(rolling, time))
        };
        let poses: Vec<Pose> = rolling.iter().map(pose).collect();
        solver.solve_at(assembly, &poses, Some(&start))
    });
    let rates = AssemblyRates::between([&before?, &after?], 2.0 * time);
    Ok((at?, Some(rates)))
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
