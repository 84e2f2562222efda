//! What an equilibrium is found for, and the unknowns of a bearing at rest.

use contact::{Meridian, Side};

use crate::bearing::{BearingParts, FIRST_BALL, SHAFT};
use crate::interactions::raceway_contact::{SiteState, on_rings};
use crate::system::{BodyId, System};

/// Displacements of everything small: m, rad.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacements {
    /// Shaft x, y, z, tilt x, tilt y.
    pub shaft: [f64; 5],
    /// Balls from the just-touching position.
    pub balls: Vec<Meridian>,
    /// Elastic motion of the groove centres, inner ring then outer, by ball.
    pub grooves: [Vec<Meridian>; 2],
    /// The seat of the outer ring along z; 0 unless it slides.
    pub seat: f64,
}

impl Displacements {
    /// Zero displacement; `flexible` tells which rings have groove motions.
    pub fn zero(n_balls: usize, flexible: [bool; 2]) -> Displacements {
        Displacements {
            shaft: [0.0; 5],
            balls: vec![Meridian::default(); n_balls],
            grooves: flexible.map(|f| vec![Meridian::default(); if f { n_balls } else { 0 }]),
            seat: 0.0,
        }
    }
}

impl BearingParts {
    /// The unknowns that place the bodies at `u`.
    pub fn unknowns(&self, u: &Displacements) -> Vec<f64> {
        let mut x: Vec<f64> = self.shaft.free().map(|dof| u.shaft[dof]).collect();
        x.extend(Meridian::flat(&u.balls));
        x.extend(self.seat.iter().map(|_| u.seat));
        for (ports, grooves) in self.rings.iter().zip(&u.grooves) {
            if ports.is_some() {
                x.extend(Meridian::flat(grooves));
            }
        }
        x
    }

    /// Where the unknowns place the bodies. Grooves of rings that do not answer stay as in `held`.
    pub fn displacements(&self, x: &[f64], held: &Displacements) -> Displacements {
        let system = self.system();
        let grooves = |side: Side| match self.elastic(side) {
            Some(i) => Meridian::list(&x[system.unknowns(BodyId::Elastic(i))]),
            None => held.grooves[side.index()].clone(),
        };
        Displacements {
            shaft: system.coordinates(SHAFT, x),
            balls: (0..self.balls.len())
                .map(|ball| system.coordinates(FIRST_BALL + ball, x).into())
                .collect(),
            grooves: Side::BOTH.map(grooves),
            seat: self.seat_end(&system, x),
        }
    }

    /// Displacement of the outer ring's seat along z for the unknowns `x` of the system, m; 0 unless it slides.
    pub fn seat_end(&self, system: &System, x: &[f64]) -> f64 {
        let carrier = self.carrier(Side::Outer);
        carrier.map_or(0.0, |body| system.coordinates::<5>(body, x)[2])
    }

    /// All contacts at given displacements.
    pub fn states_at(&self, u: &Displacements) -> Vec<SiteState> {
        self.states(&self.unknowns(u))
    }

    /// Force on the ring of every site, N.
    pub fn forces_at(&self, u: &Displacements) -> Vec<Meridian> {
        on_rings(&self.states_at(u))
    }
}
