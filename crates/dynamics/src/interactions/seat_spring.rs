//! A spring between housing and outer ring along the axis: the ring slides in its seat.
//!
//! With u the displacement of the seat along +z, the spring presses the ring along -z with F0 + k u:
//! V = F0 u + k u^2/2.
//! Over a step the force is F0 + k (w u0 + (1 - w) u1), w the weight of the start. For w = 1/2 that is the discrete
//! gradient of V, which exchanges energy and makes none; a scheme that dissipates takes (1/2 - w) k (u1 - u0)^2.

use timer::SharedLaps;

use crate::system::{BodyId, Character, Interaction, Lengths, Link, LinkForces, LinkRows, LinkTerm};

/// A seat of the outer ring that slides along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Mass that slides with the seat besides a flexible ring, kg.
    pub mass: f64,
    /// Force of the spring at zero displacement, N.
    pub force: f64,
    /// Its stiffness, N/m.
    pub stiffness: f64,
}

/// The spring as an interaction.
#[derive(Clone, Debug)]
pub struct SeatSpring {
    seat: Seat,
    /// Weight of the start in the force over a step; 0 at rest.
    weight: f64,
    links: [Link; 1],
}

impl SeatSpring {
    /// The spring of a seat whose coordinate z is that of a lumped body.
    pub fn new(seat: Seat, body: usize, weight: f64) -> SeatSpring {
        let terms = vec![LinkTerm::new(BodyId::Lumped(body), 2, [1.0])];
        SeatSpring {
            seat,
            weight,
            links: [Link::linear(LinkRows::default(), terms)],
        }
    }

    /// Force on the spring at a displacement, N.
    pub fn force(&self, u: f64) -> f64 {
        self.seat.force + self.seat.stiffness * u
    }

    /// Work that the spring does on the seat between two displacements, J, and what a dissipating scheme takes.
    pub fn works(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let change = to - from;
        let energy = self.force(0.5 * (from + to)) * change;
        [
            -energy,
            (0.5 - self.weight) * self.seat.stiffness * change * change,
        ]
    }
}

impl Interaction for SeatSpring {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        1
    }

    fn character(&self) -> Character {
        Character::Potential
    }

    fn evaluate(&self, lengths: Lengths, _costs: &SharedLaps) -> LinkForces {
        let [[start], [end]] = lengths.of::<1>(0);
        LinkForces {
            forces: vec![self.force(self.weight * start + (1.0 - self.weight) * end)],
            tangents: vec![(1.0 - self.weight) * self.seat.stiffness],
        }
    }

    fn round_off(&self, lengths: Lengths) -> f64 {
        2.0 * f64::EPSILON * self.seat.stiffness * lengths.end[0].abs()
    }
}
