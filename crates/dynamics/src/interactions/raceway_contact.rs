//! The contacts of balls on raceways.
//!
//! With l the vector from groove centre to ball centre, the geometric approach is g = |l| + D_w/2 - R. |l| is convex in
//! all displacements and the contact energy V(g) convex and increasing, so the energy of a contact is convex. At rest
//! its force is Q n, with n = l/|l| and Q = dV/dg; over a step it is a mean (see [`super::discrete_gradient`]). On
//! faceted raceways, at rest only, g has a part of its own from the facets, and the forces have no energy.

use std::sync::Arc;

use contact::law::ContactForce;
use contact::{ContactLaw, Side, Unevenness};
use timer::SharedLaps;

use super::discrete_gradient::{ContactDamping, ContactScheme, MeanForce, mean_force, viscous};
use crate::model::Model;
use crate::system::{Body, Character, Interaction, Lengths, Link, LinkForces, LinkRows, LinkTerm};

/// One ball on one raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Ball number.
    pub ball: usize,
    /// Raceway.
    pub side: Side,
    /// Azimuth of the ball, rad.
    pub azimuth: f64,
    /// The same on the mesh of the ring, which may have turned, rad.
    pub ring_azimuth: f64,
    /// Groove centre to ball centre at zero displacement [radial, axial], m.
    pub reach: [f64; 2],
    /// |l| at which they touch, R - D_w/2, m.
    pub touching: f64,
    /// Radius of the groove centre from the axis: the lever of what carries a ring, m.
    pub lever: f64,
    /// Force law.
    pub law: ContactLaw,
    /// How far the facets lie inside the torus; None on an exact torus.
    pub unevenness: Option<Arc<Unevenness>>,
}

/// A contact at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteState {
    /// Unit vector from groove centre to ball centre.
    pub normal: [f64; 2],
    /// |l|, m.
    pub length: f64,
    /// Change of the approach per unit of l besides |l|, from the facets.
    pub slope: [f64; 2],
    /// Force, tangent and energy.
    pub force: ContactForce,
    /// Contact angle, rad.
    pub angle: f64,
}

impl Site {
    /// A ball at an azimuth on an exact, rigid groove that has not turned, with the model's Hertz stiffness.
    pub fn new(model: &Model, ball: usize, side: Side, azimuth: f64) -> Site {
        Site {
            ball,
            side,
            azimuth,
            ring_azimuth: azimuth,
            reach: model.reach(side, None),
            touching: model.touching_distance(side),
            lever: model.geometry.centre_radius(side),
            law: ContactLaw {
                stiffness: model.hertz[side.index()].stiffness,
                patch_compliance: 0.0,
            },
            unevenness: None,
        }
    }

    /// Motion [radial, axial] of the groove centre per unit of each dof of what carries the ring (tilts in rad).
    pub fn carrier_rows(&self) -> [[f64; 2]; 5] {
        let (sin, cos) = self.azimuth.sin_cos();
        [
            [cos, 0.0],
            [sin, 0.0],
            [0.0, 1.0],
            [0.0, self.lever * sin],
            [0.0, -self.lever * cos],
        ]
    }

    /// Contact angle at l, rad.
    pub fn angle(&self, l: [f64; 2]) -> f64 {
        let sign = self.side.sign();
        (sign * l[1]).atan2(sign * l[0])
    }

    /// The contact at l.
    pub fn at(&self, l: [f64; 2]) -> SiteState {
        let length = l[0].hypot(l[1]);
        let normal = if length > 0.0 {
            [l[0] / length, l[1] / length]
        } else {
            [self.side.sign(), 0.0]
        };
        let mut state = SiteState {
            normal,
            length,
            slope: [0.0; 2],
            force: ContactForce::default(),
            angle: self.angle(normal),
        };
        let mut approach = length - self.touching;
        if let Some(unevenness) = &self.unevenness {
            let (offset, derivative) = unevenness.at(state.angle);
            approach += offset;
            // d angle / dl = (-n_axial, n_radial) / |l|.
            state.slope = [-derivative * normal[1] / length, derivative * normal[0] / length];
        }
        state.force = self.law.evaluate(approach);
        state
    }
}

impl SiteState {
    /// Force on the ring [radial, axial], N.
    pub fn on_ring(&self) -> [f64; 2] {
        self.normal.map(|n| self.force.force * n)
    }

    /// l, m.
    pub fn reach(&self) -> [f64; 2] {
        self.normal.map(|n| n * self.length)
    }

    /// Derivative of Q n with respect to l: k n (n + slope)^T + Q/|l| (1 - n n^T); without slope the Hessian of V(|l|).
    pub fn tangent(&self) -> [[f64; 2]; 2] {
        let n = self.normal;
        let across = if self.length > 0.0 {
            self.force.force / self.length
        } else {
            0.0
        };
        let gap = [0, 1].map(|i| n[i] + self.slope[i]);
        [0, 1].map(|i| {
            [0, 1].map(|j| {
                let identity = if i == j { 1.0 } else { 0.0 };
                self.force.tangent * n[i] * gap[j] + across * (identity - n[i] * n[j])
            })
        })
    }
}

/// Force on the ring of every contact [radial, axial], N.
pub fn on_rings(states: &[SiteState]) -> Vec<[f64; 2]> {
    states.iter().map(SiteState::on_ring).collect()
}

/// Means over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Means {
    /// Step size, s.
    pub dt: f64,
    /// Force scheme.
    pub scheme: ContactScheme,
    /// Weight of the start, the integrator's alpha_f.
    pub weight: f64,
    /// Contact damping.
    pub damping: Option<ContactDamping>,
}

/// What moves the groove centres of one ring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrooveBodies {
    /// The elastic body whose ports they are.
    pub elastic: Option<usize>,
    /// The lumped body that carries the ring, where its motion is not in that of the ports.
    pub carrier: Option<usize>,
    /// Motion of the groove centres that stays [radial, axial], m, by ball; empty is none.
    pub held: Vec<[f64; 2]>,
}

/// All contacts of a bearing: ball 0 inner, ball 0 outer, ball 1 inner, ...
#[derive(Clone, Debug)]
pub struct RacewayContacts {
    /// The contacts.
    pub sites: Vec<Site>,
    /// Additional forces on the rings at the contacts [radial, axial], N, by site; the balls get their negatives. None
    /// when empty.
    pub dead: Vec<[f64; 2]>,
    /// Means over a step; None: forces of an instant.
    pub means: Option<Means>,
    links: Vec<Link>,
}

impl RacewayContacts {
    /// Contacts that are not connected yet.
    pub fn new(sites: Vec<Site>, dead: Vec<[f64; 2]>, means: Option<Means>) -> RacewayContacts {
        RacewayContacts {
            links: Vec::new(),
            sites,
            dead,
            means,
        }
    }

    /// Connects balls, which are lumped bodies from `first_ball` on, and rings, inner first.
    pub fn connect(&mut self, first_ball: usize, rings: &[GrooveBodies; 2]) {
        let link = |site: &Site| {
            link(
                site,
                Body::Lumped(first_ball + site.ball),
                &rings[site.side.index()],
            )
        };
        self.links = self.sites.iter().map(link).collect();
    }

    /// Contacts at an instant.
    pub fn states(&self, lengths: &[f64]) -> Vec<SiteState> {
        let l = lengths.as_chunks().0;
        self.sites.iter().zip(l).map(|(site, l)| site.at(*l)).collect()
    }

    /// Mean forces over a step without the dead ones; `costs` gets the time of the damping.
    pub fn mean_forces(&self, lengths: Lengths, means: Means, costs: &SharedLaps) -> Vec<MeanForce> {
        let places = || {
            self.sites
                .iter()
                .enumerate()
                .map(|(i, site)| (site, lengths.of::<2>(i)))
        };
        let damping = means.damping.as_ref().map(|damping| {
            costs.time("contact_damping", || {
                let at = |(s, l): (&Site, _)| viscous(damping, means.dt, s.touching, l);
                places().map(at).collect::<Vec<_>>()
            })
        });
        let scheme = (means.scheme, means.weight);
        let viscous = |index: usize| damping.as_ref().map(|terms| terms[index]);
        places()
            .enumerate()
            .map(|(index, (s, l))| mean_force(&s.law, s.touching, l, scheme, viscous(index)))
            .collect()
    }
}

/// A contact as a link: l = reach + ball - groove centre.
fn link(site: &Site, ball: Body, ring: &GrooveBodies) -> Link {
    let mut terms = vec![
        LinkTerm::new(ball, 0, [1.0, 0.0]),
        LinkTerm::new(ball, 1, [0.0, 1.0]),
    ];
    if let Some(elastic) = ring.elastic {
        let body = Body::Elastic(elastic);
        terms.push(LinkTerm::new(body, 2 * site.ball, [-1.0, 0.0]));
        terms.push(LinkTerm::new(body, 2 * site.ball + 1, [0.0, -1.0]));
    }
    if let Some(carrier) = ring.carrier {
        let rows = site.carrier_rows().into_iter().enumerate();
        terms.extend(rows.map(|(dof, row)| LinkTerm::new(Body::Lumped(carrier), dof, row.map(|r| -r))));
    }
    let mut reach: LinkRows = LinkRows::default();
    let held = ring.held.get(site.ball).copied().unwrap_or_default();
    (reach[0], reach[1]) = (site.reach[0] - held[0], site.reach[1] - held[1]);
    Link { reach, terms }
}

impl Interaction for RacewayContacts {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        2
    }

    fn character(&self) -> Character {
        if self.sites.iter().all(|site| site.unevenness.is_none()) {
            Character::Potential
        } else {
            Character::General
        }
    }

    fn evaluate(&self, lengths: Lengths, costs: &SharedLaps) -> LinkForces {
        let n = self.sites.len();
        let (mut forces, mut tangents) = (Vec::with_capacity(2 * n), Vec::with_capacity(4 * n));
        let mut add = |force: [f64; 2], tangent: [[f64; 2]; 2]| {
            forces.extend(force);
            tangents.extend(tangent.into_iter().flatten());
        };
        match self.means {
            Some(means) => {
                let found = self.mean_forces(lengths, means, costs);
                found.iter().for_each(|mean| add(mean.force, mean.tangent));
            }
            None => {
                let found = self.states(lengths.end);
                found
                    .iter()
                    .for_each(|state| add(state.on_ring(), state.tangent()));
            }
        }
        for (force, dead) in forces.iter_mut().zip(self.dead.as_flattened()) {
            *force += dead;
        }
        LinkForces { forces, tangents }
    }

    fn round_off(&self, lengths: Lengths) -> f64 {
        let of_site = |(site, state): (&Site, SiteState)| {
            // The vector between the centres is a sum of terms of the size of these two.
            let place = 2.0 * f64::EPSILON * (state.length + site.reach[0].hypot(site.reach[1]));
            // A contact that has no stiffness yet has the force of an approach that cannot be told from zero.
            (place * state.force.tangent).max(site.law.evaluate(place).force)
        };
        self.sites.iter().zip(self.states(lengths.end)).map(of_site).sum()
    }
}
