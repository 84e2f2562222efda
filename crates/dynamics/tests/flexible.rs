//! Flexible rings: convergence of ball forces and contact angles, limits and symmetries.

mod support;

use dynamics::{ContactMode, Hold, StaticSolver};
use std::time::Instant;
use support::Case;
use support::rings::Level;

#[test]
fn explore() {
    for level in [
        Level::hex8(180, 8, 2, 4),
        Level::hex8(360, 14, 3, 6),
        Level::hex20(90, 8, 2, 3),
        Level::hex20(180, 8, 2, 4),
    ] {
        let clock = Instant::now();
        let model = Case::axial(2000.0).flexible(ContactMode::Patch, level, Hold::Clamped);
        let meshed = clock.elapsed();
        let mut solver = StaticSolver::new(&model).unwrap();
        let s = solver.solve(&model, None).unwrap();
        let b = &s.balls[0];
        println!(
            "{:?} dofs {} {:.4} deg {:.4} N {:.4} um patch {:?} rounds {} newton {} mesh {:?} total {:?} {:?}",
            level.kind,
            model.rings[0].as_ref().unwrap().mesh.n_dofs(),
            b.inner.contact_angle_rad.to_degrees(),
            b.inner.force_n,
            1e6 * s.displacements.shaft[2],
            s.patch_axes(contact::Side::Inner)[0],
            s.rounds,
            s.newton_iterations,
            meshed,
            clock.elapsed(),
            solver.timing
        );
        let spread = s
            .balls
            .iter()
            .map(|x| (x.inner.force_n / b.inner.force_n - 1.0).abs())
            .fold(0.0, f64::max);
        println!(
            "spread {spread:e} outer angle {} {}",
            b.outer.contact_angle_rad.to_degrees(),
            b.outer.force_n
        );
    }
}
