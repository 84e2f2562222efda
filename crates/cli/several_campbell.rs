//! `raceway campbell` of a scene with a list of bearings: modes of the shaft on all of them over the speed.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::anyhow;
use assembly::stiffness::LinearAssembly;
use assembly::whirl::TurningAssembly;
use assembly::{Assembly, AssemblySolver};
use dynamics::kinematics::Speed;
use results::campbell::{CAMPBELL_LINES, CAMPBELL_TABLE, ModesAtSpeed};
use results::failure::Failure;
use results::survey::say_doubts;
use results::whole::require_free;
use scene::{SeveralScene, assembly_with_rings, build_assembly};

use crate::campbell_files::{
    self, Diagram, MODES_OF_BEAM, ball_forces, cage_speeds, growing, keep_modes_of_shaft, require_forward,
    require_one_point, without_stress,
};
use crate::damping::{damping_note, laws};
use crate::progress::Progress;
use crate::several::{rings, solving, warnings_at};
use crate::several_read::all_doubts;
use crate::stiffness::instant;

/// Computes the modes at speeds, rpm, and writes them.
pub fn campbell(
    scene: SeveralScene,
    speeds: &[f64],
    number: Option<usize>,
    out: &Path,
) -> Result<(), Failure> {
    require_one_point(&scene.analysis, &scene.path)?;
    instant((&scene.analysis, &scene.path), None)?;
    require_forward(scene.speed.as_ref(), 0.0)?;
    require_free(out, &[CAMPBELL_TABLE, CAMPBELL_LINES])?;
    let slip = scene.effects.slip();
    let first = scene::geometry(&scene.bearings[0].scene);
    let is_like = |b: &scene::BearingOnShaft| scene::geometry(&b.scene) == first;
    let name = scene.bearings[0].name.clone();
    let others = !scene.bearings.iter().all(is_like);
    let laws = laws(&scene.effects);
    let (modes, assembly, warnings) = diagram(scene.moving_by_modes(), speeds, number)?;
    let note = others.then(|| format!("the lines of cage and ball pass are those of bearing {name:?}"));
    let diagram = Diagram {
        modes,
        warnings,
        note,
        damping_note: damping_note(laws, assembly.bearings.iter().map(|bearing| &bearing.model)),
    };
    campbell_files::write(&diagram, out, &first, slip)
}

/// Modes at all speeds.
fn diagram(
    mut scene: SeveralScene,
    speeds: &[f64],
    number: Option<usize>,
) -> Result<(Vec<ModesAtSpeed>, Assembly, Vec<String>), Failure> {
    let mut progress = Progress::new(speeds.len() as u64);
    progress.stage("reading meshes");
    let (mut assembly, _) = build_assembly(&scene)?;
    let mut warnings = all_doubts(&scene, &assembly);
    say_doubts(&warnings);
    let models = assembly.bearings.iter().map(|bearing| &bearing.model);
    warnings.extend(without_stress(models));
    let n_free = assembly.shaft.held.iter().filter(|held| held.is_none()).count();
    let turning = TurningAssembly::new(&assembly).map_err(solving)?;
    let default = if turning.has_bodies() {
        MODES_OF_BEAM
    } else {
        n_free.min(MODES_OF_BEAM)
    };
    let number = number.unwrap_or(default);
    if number == 0 {
        return Err(Failure::User(anyhow!(
            "no mode is asked for; expected --number of at least 1, and a free motion in [shaft]"
        )));
    }
    progress.stage("factoring the stiffness of the rings");
    let mut solver = AssemblySolver::new(&assembly).map_err(solving)?;
    let (mut found, mut before, mut is_warned) = (Vec::new(), None, false);
    for &rpm in speeds {
        let at = |failure: Failure| failure.context(format!("{rpm} rpm"));
        progress.stage(&format!("{rpm} rpm"));
        let speed = rpm * PI / 30.0;
        turn_shaft(&mut scene, speed);
        assembly = assembly_with_rings(&scene, rings(assembly))?;
        let solution = solver.solve(&mut assembly, before.as_ref());
        let solution = solution.map_err(solving).map_err(at)?;
        let cages = cage_speeds(&scene, 0.0);
        let modes = LinearAssembly::passing(&assembly, &solver, &solution, (laws(&scene.effects), &cages))
            .map(|linear| linear.going_round(&assembly, &cages))
            .and_then(|linear| turning.equations((&assembly, &solver), (&solution, &linear), speed));
        let modes = modes.map_err(solving).map_err(at)?.modes();
        let mut modes = modes.map_err(Failure::solving).map_err(at)?;
        keep_modes_of_shaft(&mut modes, number);
        warnings.extend(growing(rpm, &modes, &ball_forces(&solution.bearings)));
        if !is_warned {
            let found = warnings_at(&format!("from {rpm} rpm on: "), &assembly, &solution);
            is_warned = !found.is_empty();
            warnings.extend(found);
        }
        let outer = scene.speed.as_ref().map_or(0.0, |speed| speed.outer.at(0.0));
        found.push(ModesAtSpeed {
            speeds: [speed, outer],
            modes,
        });
        before = Some(solution);
        progress.advance();
    }
    progress.finish();
    Ok((found, assembly, warnings))
}

/// Has the shaft turn at a speed, rad/s, in all bearings.
fn turn_shaft(scene: &mut SeveralScene, speed: f64) {
    for bearing in &mut scene.bearings {
        let mut own = bearing.scene.speed.clone().unwrap_or_default();
        own.inner = Speed::constant(bearing.orientation.turned_angle(speed));
        bearing.scene.speed = Some(own);
    }
}
