//! A ring of the 7010C under equal contact forces through patches, alone.

use contact::patch::PatchShape;
use contact::quadrature::PressureRule;
use contact::{Patch, RacewaySurface, RingPoint, Side};
use dynamics::model::elastic;
use dynamics::statics::StaticRing;
use dynamics::{Hold, Model, RingModel};
use fem::stress::PointRecovery;

use crate::support::rings::{Level, ring};
use crate::{ANGLE, FORCE, model};

/// Spacings in a patch's semi-axis, as scenes have it.
const SPACINGS: f64 = 2.0;

/// A ring, clamped, ready for loads.
pub struct Ring {
    side: Side,
    pub model: Model,
}

impl Ring {
    pub fn new(side: Side, level: Level) -> Ring {
        let model = model(side, ring(side, level, Hold::Clamped));
        Ring { side, model }
    }

    pub fn ring(&self) -> &RingModel {
        self.model.ring(self.side).unwrap()
    }

    /// Semi-axes of the Hertz ellipse of the tests' force, m.
    pub fn hertz_axes(&self) -> [f64; 2] {
        self.model.hertz[self.side.index()].semi_axes(FORCE)
    }

    fn surface(&self) -> RacewaySurface {
        let ring = self.ring();
        RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove)
    }

    /// The patch that a run has on this mesh.
    pub fn patch(&self, azimuth: f64) -> PatchShape {
        PatchShape::new(&self.surface(), azimuth, ANGLE, self.hertz_axes(), SPACINGS).unwrap()
    }

    /// Displacements, m, under the tests' force on each of some patches.
    pub fn displacements(&self, patches: &[PatchShape]) -> Vec<f64> {
        let (ring, surface, rule) = (self.ring(), self.surface(), PressureRule::new());
        let direction = ring.groove.direction(ANGLE);
        let mut load = vec![0.0; ring.mesh.n_dofs()];
        for &shape in patches {
            let steel = elastic(&ring.material);
            let patch = Patch::new(&surface, &ring.mesh.nodes, &rule, shape, steel).unwrap();
            patch.weights.add_load(direction.map(|n| FORCE * n), &mut load);
        }
        StaticRing::new(&self.model, self.side, ring)
            .unwrap()
            .solver
            .solve(load, 1)
    }

    /// Stress of the elements at points, Pa, in the axes of the mesh.
    pub fn stress(&self, u: &[f64], points: &[RingPoint]) -> Vec<[f64; 6]> {
        let ring = self.ring();
        let positions: Vec<[f64; 3]> = points.iter().map(|p| p.position(&ring.groove)).collect();
        let recovery = PointRecovery::new(&ring.mesh, &ring.material, &positions).unwrap();
        recovery.stress(u)
    }
}
