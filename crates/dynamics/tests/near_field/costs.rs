//! What the near field costs.

use std::f64::consts::PI;
use std::time::Instant;

use contact::patch_shape::PatchShape;
use contact::{LoadedPatch, NearField, RacewaySurface, Side};
use dynamics::Hold;
use fem::stress::StressRecovery;

use super::{ANGLE, FORCE, NU, model};
use crate::support::LEAST_PATCH;
use crate::support::rings::{Level, ring};

/// Wrong: the price list of docs/stress.md. Shortest of some runs of both, in turn, on one thread, of 18 contacts on
/// both rings.
#[test]
#[ignore = "a measurement, which a busy machine spoils; scripts/test-slow runs it"]
fn the_near_field_costs_what_the_documents_say() {
    for level in [Level::hex8(180, 14, 3, 4), Level::hex8(360, 28, 6, 8)] {
        let (mut recovery_ms, mut near_ms, mut dofs) = (0.0, 0.0, 0);
        for side in Side::BOTH {
            let model = model(side, ring(side, level, Hold::Clamped));
            let ring = model.ring(side).unwrap();
            let hertz = &model.hertz[side.index()];
            let surface = RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
            let contact = |ball: usize| {
                let azimuth = ball as f64 * PI / 9.0;
                let semi_axes = hertz.semi_axes(FORCE);
                LoadedPatch {
                    azimuth,
                    force: FORCE,
                    angle: ANGLE,
                    semi_axes,
                    patch_angle: ANGLE,
                    patch_axes: PatchShape::new(&surface, azimuth, ANGLE, semi_axes, LEAST_PATCH)
                        .unwrap()
                        .semi_axes,
                }
            };
            let contacts: Vec<LoadedPatch> = (0..18).map(contact).collect();
            let recovery = StressRecovery::new(&ring.mesh, &ring.material).unwrap();
            let near_field = NearField::new(ring.groove, NU, 4.0, &ring.mesh.nodes);
            let u: Vec<f64> = ring.mesh.nodes.iter().flatten().map(|x| 1e-3 * x * x).collect();
            let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let (mut shortest, mut stress) = ([f64::INFINITY; 2], recovery.nodal(&u));
            for _ in 0..7 {
                let clock = Instant::now();
                stress = one.install(|| recovery.nodal(&u));
                shortest[0] = shortest[0].min(clock.elapsed().as_secs_f64());
                let clock = Instant::now();
                one.install(|| near_field.add(&contacts, &mut stress));
                shortest[1] = shortest[1].min(clock.elapsed().as_secs_f64());
            }
            assert!(stress.iter().flatten().all(|s| s.is_finite()));
            recovery_ms += 1e3 * shortest[0];
            near_ms += 1e3 * shortest[1];
            dofs += ring.mesh.n_dofs();
        }
        println!(
            "both rings, {dofs} dofs: recovery of nodal stress {recovery_ms:.1} ms, near field {near_ms:.1} ms, {:.2} \
             of it, one thread",
            near_ms / recovery_ms
        );
    }
}
