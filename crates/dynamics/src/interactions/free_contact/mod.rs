//! The contacts of free balls on raceways: normal force and traction over a step, on ball and ring.
//!
//! **Normal force**: the discrete gradient as of any ball ([`super::discrete_gradient`]), F = [V(d1) - V(d0)]/(d1 - d0)
//! along (l1 + l0)/(|l1| + |l0|), [radial, axial]. The radial part acts in space along (b'_0 + b'_1)/(r_0 + r_1) across
//! the ring's axis: its work is exactly F_r (r_1 - r_0), and it has no moment about that axis at the mean place.
//!
//! Both contacts of a ball that yields as a sphere have one energy ([`between`]).
//!
//! **Traction** ([`super::traction`]) follows the slip of the *end* of the step, in the frame of the end; its
//! components act in the frame of the *middle*, at the mean place of the ball. The midpoint rule would let slip
//! alternate from step to step; end velocities in the frame of the middle would be of first order. The work on both
//! bodies is h f(s_1) . s_mean: h f(s_1) . s_1, which is never positive, and h/2 f(s_1) . (s_0 - s_1), the
//! integrator's share. Where that sum comes out positive, a slip that reverses within the step, the contact takes the
//! slip of the middle ([`SlipAt::Middle`]), for which it cannot.
//!
//! Ellipse, lever and the slip of creep are those of the start of the step. The ring gets the opposite force and moment
//! at the same place; an elastic ring the force alone, along t and q of its patch, without the moment on its section.
//! The elastic velocity of the patch is the mean over the step: modes of a ring that the step does not resolve
//! alternate from step to step, and the slip would follow them.
//!
//! **Slope force**: a ball that moves along an elastic ring which its neighbours have bent climbs or falls. With
//! u_c(psi) the motion of the groove centre and F the normal force on the ring, the ball gets
//!
//! ```text
//! T = F . (du_c/dpsi) / r      along e_psi
//! ```
//!
//! which is the energy that the contact gives as its patch moves on, per length of its course: what the patch loses,
//! the ball and the drive of the ring gain. du_c/dpsi is that of the middle of the step if it changes as in the step
//! before: of second order, and no unknown. Where a ring is rigid the exact lengths have this force in them.
//!
//! On a real surface the normal force is that of strips, and the slope of the surface is a force along the track
//! ([`rolling_surface`]). Traction has the loads of the strips at the start of the step ([`super::traction::patch`]),
//! in the ellipse that has the contact's force on a smooth groove; they stay as they are over the step, so that
//! Newton's tangent is exact.
//!
//! Lengths of a link: displacement and rotation vector of the ball since the start (3 + 3), then either displacement of
//! what carries the ring (5) or motion of an elastic ring at the ball (groove r, z; patch t, q). That of the groove has
//! the finite motion of the shaft in it, as of balls in the cage's kinematics ([`crate::system::Circle`]).

pub mod between;
pub mod contact;
pub mod jet;
pub mod orientation;
pub mod place;
pub mod ring_step;
pub mod rolling_surface;
pub mod surface_force;

use timer::SharedLaps;

pub use contact::{ContactStep, FoundContact, SlipAt};
use jet::Jet;
pub use jet::N_LENGTHS;
pub use ring_step::{ElasticPlace, FREE_FEET, FREE_PORTS, GROOVE_LENGTH, RingStep, SlopeForce};
pub use surface_force::SurfaceForce;

use crate::system::{
    BodyId, CarriedCircle, Character, Interaction, Lengths, Link, LinkForces, LinkRows, LinkTerm,
};

/// What moves a ring's side of the contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier {
    /// A lumped body.
    Lumped(usize),
    /// An elastic ring: of each ball the ports of groove and patch.
    Elastic(usize),
    /// Nothing.
    AtRest,
}

/// All contacts of free balls: ball 0 inner, ball 0 outer, ball 1 inner, ...
#[derive(Clone, Debug, Default)]
pub struct FreeContacts {
    /// The contacts over a step.
    pub contacts: Vec<ContactStep>,
    links: Vec<Link>,
}

impl FreeContacts {
    /// Contacts that are not connected yet.
    pub fn new(contacts: Vec<ContactStep>) -> FreeContacts {
        FreeContacts {
            contacts,
            links: Vec::new(),
        }
    }

    /// Connects balls, which are lumped bodies from `first_ball` on, and rings, inner first. `finite` is what the
    /// elastic ring of a contact moves by beyond the motion of its ports, which is linear in its tilts.
    pub fn connect(
        &mut self,
        first_ball: usize,
        rings: [Carrier; 2],
        finite: impl Fn(usize) -> Option<CarriedCircle>,
    ) {
        let link = |(index, _): (usize, &ContactStep)| {
            let (ball, side) = (index / 2, index % 2);
            let mut terms: Vec<LinkTerm> = (0..6)
                .map(|c| unit(BodyId::Lumped(first_ball + ball), c, c))
                .collect();
            match rings[side] {
                Carrier::Lumped(body) => terms.extend((0..5).map(|c| unit(BodyId::Lumped(body), c, 6 + c))),
                Carrier::Elastic(body) => {
                    let coordinates = (FREE_PORTS * ball..FREE_PORTS * (ball + 1)).enumerate();
                    terms.extend(coordinates.map(|(i, c)| unit(BodyId::Elastic(body), c, 6 + i)));
                }
                Carrier::AtRest => {}
            }
            Link {
                finite: finite(index),
                ..Link::linear(LinkRows::default(), terms)
            }
        };
        self.links = self.contacts.iter().enumerate().map(link).collect();
    }

    /// Forces and slips of all contacts at these lengths.
    pub fn found(&self, lengths: Lengths) -> Vec<FoundContact> {
        let balls = self.contacts.as_chunks().0.iter().enumerate();
        let at = |(ball, contacts)| {
            let [inner, outer] = [2 * ball, 2 * ball + 1];
            between::evaluate(contacts, [lengths.of(inner), lengths.of(outer)])
        };
        balls.flat_map(at).collect()
    }
}

/// Forces and tangents of links from what resists the growth of the lengths of each.
pub fn link_forces(links: impl Iterator<Item = [Jet; N_LENGTHS]>) -> LinkForces {
    let mut found = LinkForces::default();
    for force in links.flatten() {
        found.forces.push(force.value);
        found.tangents.extend(force.slope);
    }
    found
}

/// A coordinate that is a length of its own.
pub fn unit(body: BodyId, coordinate: usize, row: usize) -> LinkTerm {
    let mut rows = LinkRows::default();
    rows[row] = 1.0;
    LinkTerm {
        body,
        coordinate,
        rows,
    }
}

impl Interaction for FreeContacts {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        N_LENGTHS
    }

    fn character(&self) -> Character {
        Character::General
    }

    fn evaluate(&self, lengths: Lengths, costs: &SharedLaps) -> LinkForces {
        costs.time("traction", || {
            link_forces(self.found(lengths).into_iter().map(|contact| contact.resists))
        })
    }

    fn round_off(&self, lengths: Lengths) -> f64 {
        let of = |(i, contact): (usize, &ContactStep)| contact.round_off(lengths.of(i));
        self.contacts.iter().enumerate().map(of).sum()
    }
}
