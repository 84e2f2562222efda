//! A ring of the 7010C under equal contact forces through patches, alone.

use contact::patch_shape::PatchShape;
use contact::quadrature::PressureRule;
use contact::{Patch, RacewaySurface, RingPoint, SemiAxes, Side};
use dynamics::model::elastic;
use dynamics::statics::StaticRing;
use dynamics::{Hold, Model, RingModel};
use fem::stress::PointRecovery;

use super::{ANGLE, FORCE, model};
use crate::support::LEAST_PATCH;
use crate::support::rings::{Level, ring};

/// A ring, clamped, ready for loads.
pub struct Ring {
    side: Side,
    pub model: Model,
    /// Force on each patch, N.
    pub force: f64,
}

impl Ring {
    pub fn new(side: Side, level: Level) -> Ring {
        Ring::under(side, level, FORCE)
    }

    /// The same under another force, N.
    pub fn under(side: Side, level: Level, force: f64) -> Ring {
        let model = model(side, ring(side, level, Hold::Clamped));
        Ring { side, model, force }
    }

    pub fn ring(&self) -> &RingModel {
        self.model.ring(self.side).unwrap()
    }

    /// Semi-axes of the Hertz ellipse of the force, m.
    pub fn hertz_axes(&self) -> SemiAxes {
        self.model.hertz[self.side.index()].semi_axes(self.force)
    }

    /// Peak pressure of the force, Pa.
    pub fn peak_pressure(&self) -> f64 {
        self.model.hertz[self.side.index()].peak_pressure(self.force)
    }

    fn surface(&self) -> RacewaySurface {
        let ring = self.ring();
        RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove)
    }

    /// The patch that a run has on this mesh.
    pub fn patch(&self, azimuth: f64) -> PatchShape {
        PatchShape::new(&self.surface(), azimuth, ANGLE, self.hertz_axes(), LEAST_PATCH).unwrap()
    }

    /// Displacements, m, under the force on each of some patches.
    pub fn displacements(&self, patches: &[PatchShape]) -> Vec<f64> {
        let (ring, surface, rule) = (self.ring(), self.surface(), PressureRule::new());
        let direction = ring.groove.direction(ANGLE);
        let mut load = vec![0.0; ring.mesh.n_dofs()];
        for &shape in patches {
            let steel = elastic(&ring.material);
            let patch = Patch::new(&surface, &ring.mesh.nodes, &rule, shape, steel).unwrap();
            patch
                .weights
                .add_load(direction.map(|n| self.force * n), &mut load);
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
