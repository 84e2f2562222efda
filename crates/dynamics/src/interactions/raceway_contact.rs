//! The contacts of balls on raceways.
//!
//! With l the vector from groove centre to ball centre in the meridian plane of the ball, the geometric approach is g =
//! |l| + D_w/2 - R. |l| is convex in l and the contact energy V(g) convex and increasing, so the energy of a contact is
//! convex in small displacements; finite ones bend l ([`crate::system::Circle`]). At rest its force is Q n, with n =
//! l/|l| and Q = dV/dg; over a step it is a mean (see [`super::discrete_gradient`]). Both contacts of a ball have one
//! energy, because the ball yields as a sphere ([`super::between_contacts`]). On faceted raceways, at rest only, g has
//! a part of its own from the facets, and the forces have no energy.

use std::sync::Arc;

use contact::law::ContactForce;
use contact::{AcrossCompliance, BySide, ContactLaw, Meridian, NodalWeights, Side, Unevenness};
use timer::SharedLaps;

use super::between_contacts::{BallContacts, of_other};
use super::contact_damping::{ContactDamping, StepDamping};
use super::discrete_gradient::{BallLengths, BallMeans, ContactScheme, ContactTangent};
use super::strip_contact::{Lateral, StripSite};
use crate::model::Model;
use crate::mounting::Mounting;
use crate::surfaces::{Strips, SurfacePlace};
use crate::system::{
    BodyId, CarriedCircle, Character, CircleLengths, Interaction, Lengths, Link, LinkForces, LinkRows,
    LinkTerm,
};

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
    /// Groove centre to ball centre at zero displacement, m.
    pub reach: Meridian,
    /// |l| at which they touch, R - D_w/2, m.
    pub touching: f64,
    /// Radius of the groove centre from the axis: the lever of what carries a ring, m.
    pub lever: f64,
    /// Whether the ball sees the point of the groove circle at its azimuth, see [`crate::system::Circle`].
    pub is_projected: bool,
    /// Force law.
    pub law: ContactLaw,
    /// By how much it yields under the force of the ball's other contact.
    pub across: AcrossCompliance,
    /// How far the facets lie inside the torus; None on an exact torus.
    pub unevenness: Option<Arc<Unevenness>>,
    /// Its strips, where the scene asks for them; the law then brings only its compliances.
    pub strips: Option<Strips>,
    /// How fast it closes because the ball passes along a ring that is displaced, m/s; 0 where nothing damps.
    pub passing: f64,
    /// How it is mounted at the start and at the end of a step during which temperatures change; None: as it is here.
    pub ends: Option<[MountedEnd; 2]>,
}

/// What temperature changes of a contact, at one end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountedEnd {
    /// Groove centre to ball centre at zero displacement, m.
    pub reach: Meridian,
    /// |l| at which they touch, m.
    pub touching: f64,
}

/// A contact at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteState {
    /// Unit vector from groove centre to ball centre.
    pub normal: Meridian,
    /// |l|, m.
    pub length: f64,
    /// Change of the approach per unit of l besides |l|, from the facets.
    pub slope: Meridian,
    /// Force, its tangent over the contact's own approach, and energy.
    pub force: ContactForce,
    /// The force across the normal: of strips, and of a ball that yields between its contacts.
    pub lateral: Option<Lateral>,
    /// Contact angle, rad.
    pub angle: f64,
}

impl Site {
    /// A ball at an azimuth on an exact, rigid groove that has not turned, with the model's Hertz stiffness.
    pub fn new(model: &Model, mounting: &Mounting, ball: usize, side: Side, azimuth: f64) -> Site {
        Site {
            ball,
            side,
            azimuth,
            ring_azimuth: azimuth,
            reach: model.reach(mounting, side, None),
            touching: model.touching_distance(mounting, side, ball),
            lever: model.geometry.centre_radius(side),
            is_projected: model.contact.projects_grooves,
            law: ContactLaw {
                stiffness: model.hertz[side.index()].stiffness,
                patch_compliance: 0.0,
                ball_compliance: model.sphere.own[side.index()],
            },
            across: model.sphere.across,
            unevenness: None,
            strips: model.surfaces.at(ball, side, SurfacePlace::at_start(azimuth)),
            passing: 0.0,
            ends: None,
        }
    }

    /// How the contact is mounted otherwise, measured by its weights where they are known.
    pub fn mounted_end(
        &self,
        model: &Model,
        mounting: &Mounting,
        weights: Option<&NodalWeights>,
    ) -> MountedEnd {
        MountedEnd {
            reach: model.reach(mounting, self.side, weights),
            touching: model.touching_distance(mounting, self.side, self.ball),
        }
    }

    /// Its damping over a step of `dt` seconds.
    fn damping<'d>(&self, law: &'d ContactDamping, dt: f64) -> StepDamping<'d> {
        StepDamping {
            law,
            dt,
            passing: self.passing * dt,
        }
    }

    /// Contact angle at l, rad.
    pub fn angle(&self, l: Meridian) -> f64 {
        let sign = self.side.sign();
        (sign * l.axial).atan2(sign * l.radial)
    }

    /// l of a ball between rings that do not deform, the inner one on a shaft at these displacements, m and rad.
    pub fn reach_of_rigid(&self, shaft: [f64; 5], ball: Meridian) -> Meridian {
        let l = self.reach + ball;
        if self.side == Side::Outer {
            return l;
        }
        let more = Meridian::from(self.circle().lengths(CarriedCircle::of(&shaft)));
        let by_dof = self.carrier_rows().into_iter().zip(shaft);
        let of_shaft = by_dof.map(|(row, q)| row.map(|r| r * q)).reduce(|a, b| a + b);
        l + (more - of_shaft.unwrap_or_default())
    }

    /// The contact as one of strips, if it has them.
    pub(super) fn strip_site(&self) -> Option<StripSite<'_>> {
        let strips = self.strips.as_ref()?;
        Some(StripSite::new(strips, &self.law, self.touching, self.side.sign()))
    }

    /// |l| at which they touch along the direction of `l`, with what facets and profiles lack or add there, m.
    pub fn touching_along(&self, l: Meridian) -> f64 {
        let (state, approach) = self.place(l);
        let of_facets = approach - (state.length - self.touching);
        let of_strips = |strips: &Strips| {
            let (law, line) = (&strips.surface.law, strips.line());
            Some(law.first_touch(&line, state.angle)).filter(|touch| touch.is_finite())
        };
        self.touching - of_facets + self.strips.as_ref().and_then(of_strips).unwrap_or(0.0)
    }

    /// The contact at l, still without its force, and its approach, m.
    fn place(&self, l: Meridian) -> (SiteState, f64) {
        let length = l.norm();
        let normal = if length > 0.0 {
            l.map(|l| l / length)
        } else {
            Meridian::new(self.side.sign(), 0.0)
        };
        let mut state = SiteState {
            normal,
            length,
            slope: Meridian::default(),
            force: ContactForce::default(),
            lateral: None,
            angle: self.angle(normal),
        };
        let mut approach = length - self.touching;
        if let Some(unevenness) = &self.unevenness {
            let (offset, derivative) = unevenness.at(state.angle);
            approach += offset;
            // d angle / dl = (-n_axial, n_radial) / |l|.
            let [radial, axial] = normal.to_array();
            state.slope = Meridian::new(-derivative * axial / length, derivative * radial / length);
        }
        (state, approach)
    }
}

/// Both contacts of a ball.
type BallSites = [Site; 2];

fn contacts([inner, outer]: &BallSites) -> BallContacts {
    BallContacts {
        laws: [inner.law, outer.law],
        across: inner.across,
    }
}

/// Both contacts of a ball at l, and the growth of the force of each with l of the other, N/m.
fn ball_states(sites: &BallSites, l: BySide<Meridian>) -> (BySide<SiteState>, BySide<ContactTangent>) {
    let placed = [0, 1].map(|k| sites[k].place(l[k]));
    let approaches = placed.map(|(_, approach)| approach);
    let (found, lateral) = contacts(sites).instant(approaches, l);
    let state = |k: usize| {
        let (mut state, approach) = placed[k];
        state.force = found.contacts[k];
        state.force.tangent = found.tangent[k][k];
        state.lateral = lateral.map(|lateral| lateral[k]);
        if let Some(strips) = sites[k].strip_site() {
            let (force, lateral) = strips.state(approach, state.angle);
            (state.force, state.lateral) = (force, Some(lateral));
        }
        state
    };
    let states = [state(0), state(1)];
    let place = (
        states.map(|state| state.normal.to_array()),
        states.map(|state| state.gap_slope().to_array()),
        states.map(|state| state.length),
    );
    let other = |k: usize| of_other(k, found.tangent[k][1 - k], lateral.as_ref(), place);
    (states, [other(0), other(1)])
}

impl SiteState {
    /// Force on the ring, N.
    pub fn on_ring(&self) -> Meridian {
        let normal = self.normal.map(|n| self.force.force * n);
        match self.lateral.filter(|_| self.length > 0.0) {
            Some(lateral) => normal + lateral.force(self.normal, self.length),
            None => normal,
        }
    }

    /// l, m.
    pub fn reach(&self) -> Meridian {
        self.normal.map(|n| n * self.length)
    }

    /// Derivative of Q n with respect to l: k n (n + slope)^T + Q/|l| (1 - n n^T); without slope the Hessian of V(|l|).
    pub fn tangent(&self) -> ContactTangent {
        let (n, gap) = (self.normal.to_array(), self.gap_slope().to_array());
        let across = if self.length > 0.0 {
            self.force.force / self.length
        } else {
            0.0
        };
        let mut tangent = [0, 1].map(|i| {
            [0, 1].map(|j| {
                let identity = if i == j { 1.0 } else { 0.0 };
                self.force.tangent * n[i] * gap[j] + across * (identity - n[i] * n[j])
            })
        });
        if let Some(lateral) = self.lateral.filter(|_| self.length > 0.0) {
            let more = lateral.tangent(self.normal, self.length);
            let sums = tangent.as_flattened_mut().iter_mut();
            sums.zip(more.as_flattened()).for_each(|(sum, t)| *sum += t);
        }
        tangent
    }

    /// Growth of the approach with l.
    fn gap_slope(&self) -> Meridian {
        self.normal + self.slope
    }
}

/// Force on the ring of every contact, N.
pub fn on_rings(states: &[SiteState]) -> Vec<Meridian> {
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
    /// The lumped body with which the groove moves across the axis or tilts, if it may: that is finite.
    pub finite: Option<usize>,
    /// Motion of the groove centres that stays, m, by ball; empty is none.
    pub held: Vec<Meridian>,
}

/// Lengths of a ball's contacts: l of the inner one, then of the outer one.
pub const N_ROWS: usize = 4;

/// Tangent over all lengths of a ball, row-major, from that of each contact and of each force over the other's length.
fn tangent_of_ball(own: BySide<ContactTangent>, across: BySide<ContactTangent>) -> [f64; N_ROWS * N_ROWS] {
    std::array::from_fn(|i| {
        let (row, column) = (i / N_ROWS, i % N_ROWS);
        let (force, length) = (row / 2, column / 2);
        let block = if force == length {
            &own[force]
        } else {
            &across[force]
        };
        block[row % 2][column % 2]
    })
}

/// All contacts of a bearing: ball 0 inner, ball 0 outer, ball 1 inner, ...
#[derive(Clone, Debug)]
pub struct RacewayContacts {
    /// The contacts.
    pub sites: Vec<Site>,
    /// Additional forces on the rings at the contacts, N, by site; the balls get their negatives. None
    /// when empty.
    pub dead: Vec<Meridian>,
    /// Means over a step; None: forces of an instant.
    pub means: Option<Means>,
    links: Vec<Link>,
}

impl RacewayContacts {
    /// Contacts that are not connected yet.
    pub fn new(sites: Vec<Site>, dead: Vec<Meridian>, means: Option<Means>) -> RacewayContacts {
        RacewayContacts {
            links: Vec::new(),
            sites,
            dead,
            means,
        }
    }

    /// Connects balls, which are lumped bodies from `first_ball` on, and rings, inner first.
    pub fn connect(&mut self, first_ball: usize, rings: &[GrooveBodies; 2]) {
        let link = |sites: &BallSites| link(sites, first_ball + sites[0].ball, rings);
        self.links = self.balls().map(link).collect();
    }

    fn balls(&self) -> impl Iterator<Item = &BallSites> {
        self.sites.as_chunks().0.iter()
    }

    /// Contacts at an instant, by site.
    pub fn states(&self, lengths: &[f64]) -> Vec<SiteState> {
        self.ball_states(lengths).flat_map(|(states, _)| states).collect()
    }

    fn ball_states(
        &self,
        lengths: &[f64],
    ) -> impl Iterator<Item = (BySide<SiteState>, BySide<ContactTangent>)> {
        let l = lengths.as_chunks::<2>().0.as_chunks::<2>().0;
        let vectors = |l: &[_; 2]| l.map(Meridian::from);
        self.balls()
            .zip(l)
            .map(move |(sites, l)| ball_states(sites, vectors(l)))
    }

    /// Mean forces over a step without the dead ones; `costs` gets the time of the damping.
    pub fn mean_forces(&self, lengths: Lengths, means: Means, costs: &SharedLaps) -> Vec<BallMeans> {
        let at = |(ball, sites): (usize, &BallSites)| BallLengths {
            touching: [sites[0].touching, sites[1].touching],
            l: [0, 1].map(|k| lengths.of::<2>(2 * ball + k)),
        };
        let places: Vec<BallLengths> = self.balls().enumerate().map(at).collect();
        let damping = means.damping.as_ref().map(|law| {
            costs.time("contact_damping", || {
                let of_ball = |(sites, at): (&BallSites, &BallLengths)| {
                    [0, 1].map(|k| sites[k].damping(law, means.dt).viscous(at.touching[k], at.l[k]))
                };
                self.balls().zip(&places).map(of_ball).collect::<Vec<_>>()
            })
        });
        let scheme = (means.scheme, means.weight);
        let viscous = |ball: usize| damping.as_ref().map(|terms| terms[ball]);
        let balls = self.balls().zip(&places).enumerate();
        balls
            .map(|(ball, (sites, at))| {
                let mut found = contacts(sites).mean_forces(at, scheme, viscous(ball));
                for (k, site) in sites.iter().enumerate() {
                    if let Some(strips) = site.strip_site() {
                        let damping = means.damping.as_ref().map(|law| site.damping(law, means.dt));
                        found.contacts[k] = strips.mean_force(at.l[k].map(Meridian::from), scheme, damping);
                    }
                }
                found
            })
            .collect()
    }
}

/// The contacts of a ball as a link with their lengths, inner first: l = reach + ball - groove centre.
fn link(sites: &BallSites, ball: usize, rings: &[GrooveBodies; 2]) -> Link {
    let body = BodyId::Lumped(ball);
    let mut terms = vec![
        LinkTerm::new(body, 0, [1.0, 0.0, 1.0, 0.0]),
        LinkTerm::new(body, 1, [0.0, 1.0, 0.0, 1.0]),
    ];
    let mut reach = LinkRows::default();
    for (site, ring) in sites.iter().zip(rings) {
        let of_side = |radial: f64, axial: f64| {
            let side = site.side;
            side.choose([radial, axial, 0.0, 0.0], [0.0, 0.0, radial, axial])
        };
        if let Some(elastic) = ring.elastic {
            let body = BodyId::Elastic(elastic);
            terms.push(LinkTerm::new(body, 2 * site.ball, of_side(-1.0, 0.0)));
            terms.push(LinkTerm::new(body, 2 * site.ball + 1, of_side(0.0, -1.0)));
        }
        if let Some(carrier) = ring.carrier {
            let rows = site.carrier_rows().into_iter().enumerate();
            terms.extend(rows.map(|(dof, row)| {
                LinkTerm::new(BodyId::Lumped(carrier), dof, of_side(-row.radial, -row.axial))
            }));
        }
        let held = ring.held.get(site.ball).copied().unwrap_or_default();
        let first = site.reach - held;
        let first = of_side(first.radial, first.axial);
        reach.iter_mut().zip(first).for_each(|(sum, r)| *sum += r);
    }
    let finite = rings[Side::Inner.index()].finite.map(|carrier| CarriedCircle {
        carrier,
        circle: sites[Side::Inner.index()].circle(),
        lengths: CircleLengths::FromCircle,
    });
    Link { reach, terms, finite }
}

impl Interaction for RacewayContacts {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        N_ROWS
    }

    fn character(&self) -> Character {
        let is_convex = |site: &Site| site.unevenness.is_none() && site.strips.is_none();
        if self.sites.iter().all(is_convex) {
            Character::Potential
        } else {
            Character::General
        }
    }

    fn evaluate(&self, lengths: Lengths, costs: &SharedLaps) -> LinkForces {
        let n = self.sites.len();
        let (mut forces, mut tangents) = (Vec::with_capacity(2 * n), Vec::with_capacity(8 * n));
        match self.means {
            Some(means) => {
                for found in self.mean_forces(lengths, means, costs) {
                    forces.extend(found.contacts.iter().flat_map(|mean| mean.force));
                    let own = found.contacts.map(|mean| mean.tangent);
                    tangents.extend(tangent_of_ball(own, found.across));
                }
            }
            None => {
                for (states, across) in self.ball_states(lengths.end) {
                    forces.extend(states.iter().flat_map(|state| state.on_ring().to_array()));
                    let own = states.map(|state| state.tangent());
                    tangents.extend(tangent_of_ball(own, across));
                }
            }
        }
        for (force, dead) in forces
            .iter_mut()
            .zip(self.dead.iter().flat_map(|dead| dead.to_array()))
        {
            *force += dead;
        }
        LinkForces { forces, tangents }
    }

    fn round_off(&self, lengths: Lengths) -> f64 {
        let of_site = |(site, state): (&Site, SiteState)| {
            // The vector between the centres is a sum of terms of the size of these two.
            let place = 2.0 * f64::EPSILON * (state.length + site.reach.norm());
            // A contact that has no stiffness yet has the force of an approach that cannot be told from zero.
            (place * state.force.tangent).max(site.law.evaluate(place).force)
        };
        self.sites.iter().zip(self.states(lengths.end)).map(of_site).sum()
    }
}
