//! Half-widths of the contact ellipses along the track, by which real surfaces are felt: from the equilibrium of the
//! scene's start on smooth, rigid grooves.

use contact::Side;
use dynamics::kinematics::BothRings;
use dynamics::{ContactMode, Model, StaticSolver};

use crate::tables::Scene;

/// Half-widths along the track under the mean load of the loaded balls, m, inner first. 0 where nothing is loaded at
/// the start, or no equilibrium is found there: waves then keep their amplitudes.
pub fn half_widths(scene: &Scene, model: &mut Model) -> BothRings {
    if !scene.profiles.has_profiles() {
        return [0.0; 2];
    }
    // Rigid rings are the same on all ranks, and their loads nearly those of elastic ones.
    let rings = std::mem::take(&mut model.rings);
    let mode = std::mem::replace(&mut model.contact.mode, ContactMode::Rigid);
    let solution = StaticSolver::new(model).and_then(|mut solver| solver.solve(model, None));
    (model.rings, model.contact.mode) = (rings, mode);
    let Ok(solution) = solution else { return [0.0; 2] };
    Side::BOTH.map(|side| {
        let forces = solution.balls.iter().map(|ball| ball.contact(side).force_n);
        let loaded: Vec<f64> = forces.filter(|force| *force > 0.0).collect();
        let mean = loaded.iter().sum::<f64>() / loaded.len().max(1) as f64;
        model.hertz[side.index()].semi_axes(mean).rolling
    })
}
