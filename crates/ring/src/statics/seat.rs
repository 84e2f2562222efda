//! The fields of [`crate::seat`], found with the factor of a ring at rest.

use std::sync::Arc;

use fem::{FemError, StressRecovery};
use mesh::Mesh;

use super::prepared::StaticSettings;
use super::solver::RingSolver;
use crate::error::RingError;
use crate::model::{Hold, RACEWAY_GROUP, RingModel};
use crate::seat::{OwnStress, RadialProfile, SeatAction, SeatField};
use crate::vectors::dot;

impl RingModel {
    /// Fields of some actions, in their order. Those that were asked for before are kept. Collective.
    pub fn seat_fields(
        &self,
        settings: StaticSettings,
        actions: &[SeatAction],
    ) -> Result<Vec<Arc<SeatField>>, RingError> {
        let known = |action: &SeatAction| {
            let fields = self.sectors.seat_fields.lock();
            let fields = fields.expect("no field is found while another is kept");
            fields
                .iter()
                .find(|(of, _)| of == action)
                .map(|(_, field)| field.clone())
        };
        let missing: Vec<SeatAction> = actions.iter().filter(|a| known(a).is_none()).cloned().collect();
        if !missing.is_empty() {
            let solver = RingSolver::new(self, settings)?;
            for action in missing {
                let field = Arc::new(self.seat_field(settings.name, &solver, &action)?);
                let fields = self.sectors.seat_fields.lock();
                fields
                    .expect("no field is found while another is kept")
                    .push((action, field));
            }
        }
        let found = actions
            .iter()
            .map(|action| known(action).expect("missing fields were found"));
        Ok(found.collect())
    }

    /// Field of one action.
    fn seat_field(
        &self,
        side: &'static str,
        solver: &RingSolver,
        action: &SeatAction,
    ) -> Result<SeatField, RingError> {
        assert!(
            matches!(action, SeatAction::OwnStrain(_))
                || (*action == SeatAction::Pressure) == (self.hold == Hold::MeanMotion),
            "a surface in its mean motion is pressed, a clamped one moved"
        );
        let fem = |source| RingError::Fem { side, source };
        let mesh = &self.mesh;
        let surface = HeldSurface::new(self);
        let mut own_stress = None;
        let (displacement, reaction) = match action {
            SeatAction::Pressure => (solver.solve(surface.normals.clone(), 1), surface.normals.clone()),
            SeatAction::OwnStrain(strain) => {
                let (stress, load) = self.strained(strain).map_err(fem)?;
                own_stress = Some(Arc::new(stress));
                let field = solver.solve(load.clone(), 1);
                let mut reaction = vec![0.0; load.len()];
                if self.hold == Hold::Clamped {
                    reaction = fem::stiffness_product(mesh, &self.material, &field).map_err(fem)?;
                    reaction.iter_mut().zip(&load).for_each(|(r, f)| *r -= f);
                }
                (field, reaction)
            }
            _ => {
                let moved = surface.motion(mesh, action, self.groove.centre_z);
                let product = |u: &[f64]| fem::stiffness_product(mesh, &self.material, u).map_err(fem);
                let load: Vec<f64> = product(&moved)?.into_iter().map(|f| -f).collect();
                let mut field = solver.solve(load, 1);
                field.iter_mut().zip(&moved).for_each(|(w, u)| *w += u);
                let reaction = product(&field)?;
                (field, reaction)
            }
        };
        let spin = fem::centrifugal_load(mesh, self.material.density, 1.0).map_err(fem)?;
        let mean = |a: &[f64], b: &[f64]| dot(a, b) / surface.area;
        let shares = surface.shares(mesh, action);
        Ok(SeatField {
            pressure: surface.pressure(&reaction, &shares),
            into_ring: mean(&surface.normals, &displacement),
            groove: self.groove_motion(&displacement),
            spin: mean(&spin, &displacement),
            displacement: Arc::new(displacement),
            own_stress,
        })
    }

    /// Stress of the ring held still while it strains by itself, and the forces that move it then, N.
    fn strained(&self, strain: &RadialProfile) -> Result<(OwnStress, Vec<f64>), FemError> {
        let recovery = StressRecovery::new(&self.mesh, &self.material)?;
        let points = recovery.held_stress(|[x, y, _]| strain.at(x.hypot(y)));
        let load = recovery.released_load(&points);
        let nodal = recovery.nodal_of_points(&points);
        Ok((OwnStress { nodal, points }, load))
    }

    /// Largest angle round the bore or seat from a node to the next one of its facet, rad.
    pub fn held_spacing(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for &facet in self.mesh.group(self.held_group) {
            let places = self.mesh.facet_nodes(facet).map(|node| self.mesh.nodes[node]);
            let places: Vec<[f64; 3]> = places.collect();
            let [first_x, first_y, _] = places[0];
            let from_first =
                |[x, y, _]: &[f64; 3]| (first_x * y - first_y * x).atan2(first_x * x + first_y * y);
            let mut angles: Vec<f64> = places.iter().map(from_first).collect();
            angles.sort_by(f64::total_cmp);
            largest = angles
                .windows(2)
                .fold(largest, |most, pair| most.max(pair[1] - pair[0]));
        }
        largest
    }

    /// Motion of the bottom of the groove [radial, axial], m; see [`SeatField::groove`].
    pub fn groove_motion(&self, displacement: &[f64]) -> [f64; 2] {
        let weights = fem::facet_node_weights(&self.mesh, self.mesh.group(RACEWAY_GROUP));
        // Sums of w, w z, w z^2, w u and w z u.
        let (mut moments, mut sums) = ([0.0; 3], [[0.0; 2]; 2]);
        for (node, weight) in weights {
            let [x, y, z] = self.mesh.nodes[node];
            let (arm, r) = (z - self.groove.centre_z, x.hypot(y));
            let u = &displacement[3 * node..3 * node + 3];
            let motion = [(x * u[0] + y * u[1]) / r, u[2]];
            for (power, moment) in [1.0, arm, arm * arm].into_iter().zip(&mut moments) {
                *moment += weight * power;
            }
            for (sum, u) in sums.iter_mut().zip(motion) {
                *sum = [sum[0] + weight * u, sum[1] + weight * arm * u];
            }
        }
        let [one, first, second] = moments;
        sums.map(|[mean, slope]| (second * mean - first * slope) / (one * second - first * first))
    }
}

/// The bore or seat of a ring.
struct HeldSurface {
    /// Its nodes.
    nodes: Vec<usize>,
    /// Unit vectors e at its nodes, 0 elsewhere, `[n_nodes][3]` flat.
    into_ring: Vec<f64>,
    /// Nodal forces of a pressure of 1 Pa, m^2, `[n_nodes][3]` flat.
    normals: Vec<f64>,
    /// Their sum along e, m^2.
    area: f64,
}

impl HeldSurface {
    fn new(ring: &RingModel) -> HeldSurface {
        let mesh = &ring.mesh;
        let nodes = mesh.group_nodes(ring.held_group);
        let normals = fem::pressure_load(mesh, mesh.group(ring.held_group), 1.0);
        let mut into_ring = vec![0.0; mesh.n_dofs()];
        for &node in &nodes {
            let [x, y, _] = mesh.nodes[node];
            let inwards = -ring.groove.side.sign() / x.hypot(y);
            into_ring[3 * node] = inwards * x;
            into_ring[3 * node + 1] = inwards * y;
        }
        HeldSurface {
            area: dot(&normals, &into_ring),
            nodes,
            into_ring,
            normals,
        }
    }

    /// Displacements of a clamped surface, 0 elsewhere.
    fn motion(&self, mesh: &Mesh, action: &SeatAction, centre_z: f64) -> Vec<f64> {
        let mut moved = vec![0.0; mesh.n_dofs()];
        for &node in &self.nodes {
            let [x, y, z] = mesh.nodes[node];
            let e = &self.into_ring[3 * node..3 * node + 3];
            let u = match *action {
                SeatAction::Radial => [e[0], e[1], 0.0],
                SeatAction::Stretch => [0.0, 0.0, z - centre_z],
                SeatAction::Wave { order, high } => {
                    let size = (order as f64 * (y.atan2(x) - high)).cos() / x.hypot(y);
                    [size * x, size * y, 0.0]
                }
                SeatAction::Pressure | SeatAction::OwnStrain(_) => [0.0; 3],
            };
            moved[3 * node..3 * node + 3].copy_from_slice(&u);
        }
        moved
    }

    /// How far the pressure of an action belongs to a node: 1 or, of a wave, its cosine.
    fn shares(&self, mesh: &Mesh, action: &SeatAction) -> Vec<f64> {
        let share = |&node: &usize| match *action {
            SeatAction::Wave { order, high } => {
                let [x, y, _] = mesh.nodes[node];
                (order as f64 * (y.atan2(x) - high)).cos()
            }
            _ => 1.0,
        };
        self.nodes.iter().map(share).collect()
    }

    /// The pressure p c, c the `shares`, that works on e c as the partner's forces do, Pa.
    fn pressure(&self, forces: &[f64], shares: &[f64]) -> f64 {
        let (mut work, mut unit) = (0.0, 0.0);
        for (&node, share) in self.nodes.iter().zip(shares) {
            let at = 3 * node..3 * node + 3;
            let e = &self.into_ring[at.clone()];
            work += share * dot(&forces[at.clone()], e);
            unit += share * share * dot(&self.normals[at], e);
        }
        work / unit
    }
}
