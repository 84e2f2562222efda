//! What the interactions of a bearing do to its vibrating rings, its balls and what carries them.

use contact::Side;
use ring::VibratingRing;
use ring::sparse::SparseLoad;
use timer::SharedLaps;

use super::columns::{LengthGrowth, LinkTangent};
use crate::bearing::{BearingParts, FIRST_BALL, lengths};
use crate::model::Model;
use crate::solution::StaticSolution;
use crate::system::{BodyId, FiniteMotion, Link, LinkTerm, N_FINITE};

/// A coordinate of a lumped body that carries a rigid ring, and its motion by small dofs.
pub struct RingCarrier {
    /// The body.
    pub body: usize,
    /// The coordinate.
    pub coordinate: usize,
    /// Its motion.
    pub motion: SparseLoad,
}

/// Tangents of all interactions of the equilibrium and what they connect, contacts first, on patches that stay.
pub fn link_tangents(vibrating: &VibratingLinks<'_>) -> Vec<LinkTangent> {
    let parts = vibrating.parts;
    let x = parts.unknowns(&vibrating.equilibrium.displacements);
    let system = parts.system();
    let mut link_tangents = Vec::new();
    for (number, family) in parts.interactions().into_iter().enumerate() {
        let found = system.lengths_at(number, &x);
        let at = family.evaluate(lengths(&found), &SharedLaps::default());
        let finite = system.finite_motions(number, &x);
        let n = family.n_rows();
        let tangents = at.tangents.chunks_exact(n * n);
        for ((link, tangent), finite) in family.links().iter().zip(tangents).zip(&finite) {
            link_tangents.push(LinkTangent {
                tangent: tangent.to_vec(),
                lengths: (0..n).map(|row| vibrating.growth(link, row, finite)).collect(),
            });
        }
        if system.has_curvature() {
            link_tangents.extend(vibrating.curvature(family.links(), &finite, &at.forces));
        }
    }
    link_tangents
}

/// What moves the coordinates of a bearing that vibrates.
pub struct VibratingLinks<'v> {
    /// The bearing.
    pub model: &'v Model,
    /// The equilibrium about which it does.
    pub equilibrium: &'v StaticSolution,
    /// Its bodies and contacts, whose shaft may move in all that it is to move in.
    pub parts: &'v BearingParts,
    /// Its elastic rings with their group.
    pub rings: [Option<(usize, &'v VibratingRing)>; 2],
    /// First of the small dofs of its balls.
    pub first_ball: usize,
    /// What carries rigid rings.
    pub carriers: &'v [RingCarrier],
}

impl VibratingLinks<'_> {
    /// What moves one length of a link. What carries a ring has its dofs by body among the small ones, or in the motion
    /// of a flexible ring, which has that of its partner in it.
    fn growth(&self, link: &Link, row: usize, finite: &Option<FiniteMotion>) -> LengthGrowth {
        let mut growth = LengthGrowth::default();
        for term in link.terms.iter().filter(|term| term.rows[row] != 0.0) {
            if !self.is_in_ring(term, link) {
                self.add(&mut growth, (term.body, term.coordinate), term.rows[row]);
            }
        }
        if let (Some(carried), Some(finite)) = (link.finite, finite) {
            for (coordinate, row_of) in carried.coordinates().into_iter().zip(finite.rows()) {
                row_of
                    .get(row)
                    .into_iter()
                    .for_each(|value| self.add(&mut growth, coordinate, *value));
            }
        }
        growth
    }

    /// Whether the motion of a term is in that of the elastic ring that its body carries, which the link has too.
    fn is_in_ring(&self, term: &LinkTerm, link: &Link) -> bool {
        let BodyId::Lumped(body) = term.body else {
            return false;
        };
        let ring = self.carried(body).and_then(|side| self.parts.elastic(side));
        ring.is_some_and(|ring| link.terms.iter().any(|other| other.body == BodyId::Elastic(ring)))
    }

    /// What finite motions and the loads that follow them add to the stiffness of what carries them under the forces
    /// of the links.
    fn curvature(
        &self,
        links: &[Link],
        finite: &[Option<FiniteMotion>],
        forces: &[f64],
    ) -> Option<LinkTangent> {
        let carrier = links.iter().find_map(|link| link.finite)?;
        let mut tangent = [[0.0; N_FINITE]; N_FINITE];
        let mut add = |sign: f64, values: [[f64; N_FINITE]; N_FINITE]| {
            let sums = tangent.as_flattened_mut().iter_mut();
            sums.zip(values.as_flattened())
                .for_each(|(sum, value)| *sum += sign * value);
        };
        let forces = forces.chunks_exact(forces.len() / links.len());
        for (finite, force) in finite.iter().zip(forces) {
            if let Some(finite) = finite {
                add(1.0, finite.circle.curvature(finite.at, [force[0], force[1]]));
            }
        }
        let [.., tilt_x, tilt_y] = self.equilibrium.displacements.shaft;
        if let Some(loads) = self.parts.shaft.tilted {
            let [of_x, of_y] = loads.slopes([tilt_x, tilt_y]).map(|[x, y]| [0.0, 0.0, x, y]);
            add(-1.0, [[0.0; N_FINITE], [0.0; N_FINITE], of_x, of_y]);
        }
        let growth = |coordinate: (BodyId, usize)| {
            let mut growth = LengthGrowth::default();
            self.add(&mut growth, coordinate, 1.0);
            growth
        };
        Some(LinkTangent {
            tangent: tangent.as_flattened().to_vec(),
            lengths: carrier.coordinates().map(growth).to_vec(),
        })
    }

    /// Side of the ring that a lumped body carries.
    fn carried(&self, body: usize) -> Option<Side> {
        let carrier = |side: &Side| self.parts.carrier(*side) == Some(body);
        Side::BOTH.into_iter().find(carrier)
    }

    /// Adds `value` times the motion of a coordinate.
    fn add(&self, growth: &mut LengthGrowth, (body, coordinate): (BodyId, usize), value: f64) {
        match body {
            BodyId::Lumped(number) => {
                let Some(side) = self.carried(number) else {
                    let place = self.first_ball + 2 * (number - FIRST_BALL) + coordinate;
                    return growth.small.push((place, value));
                };
                let mut carriers = self.carriers.iter();
                if let Some(carrier) = carriers.find(|c| (c.body, c.coordinate) == (number, coordinate)) {
                    let motion = carrier.motion.iter();
                    growth.small.extend(motion.map(|&(k, w)| (k, value * w)));
                }
                let ring = self.rings[side.index()];
                if let Some((group, load)) =
                    ring.and_then(|(i, ring)| Some((i, ring.partner_load(coordinate)?)))
                {
                    growth.add_ring(group, load, value);
                }
            }
            BodyId::Elastic(number) => {
                let of = |side: &Side| self.parts.elastic(*side) == Some(number);
                let found = Side::BOTH.into_iter().find(of);
                let Some((side, (group, ring))) = found.and_then(|s| Some((s, self.rings[s.index()]?)))
                else {
                    return;
                };
                let foot = &self.equilibrium.footprints(side)[coordinate / 2];
                let weights = ring.contact_loads(&foot.weights);
                growth.add_ring(group, &weights[coordinate % 2], value);
            }
        }
    }
}
