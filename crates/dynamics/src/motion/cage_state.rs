//! What evolves of a cage, and what a part of a step finds of it.

use crate::interactions::cage::CageForce;

/// A cage: place and rates in space, and what its contacts remember and report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CageState {
    /// Place of its centre, m, tilts and turn, rad.
    pub place: [f64; 6],
    /// Their rates.
    pub rates: [f64; 6],
    /// Speed at first touch of each contact that touches, m/s; 0 of one that is open. Pockets by ball, then both ends
    /// on the land.
    pub met: Vec<f64>,
    /// Mean normal force of each pocket on its ball in the last step, along e_psi and e_z, N.
    pub pockets: Vec<[f64; 2]>,
    /// Mean normal force of the land on both ends, x and y, N.
    pub lands: Vec<[f64; 2]>,
    /// Torque about the axis on the cage in the last step, N m: of the pockets, of the land.
    pub torques: [f64; 2],
}

impl CageState {
    /// Kinetic energy of a cage of these masses, J.
    pub fn kinetic(&self, masses: [f64; 6]) -> f64 {
        let terms = masses.iter().zip(&self.rates);
        0.5 * terms.map(|(mass, rate)| mass * rate * rate).sum::<f64>()
    }

    /// Sum of all its numbers: not finite if one is not.
    pub(super) fn sum(&self) -> f64 {
        let forces = self.pockets.iter().chain(&self.lands).flatten();
        let rest = self
            .place
            .iter()
            .chain(&self.rates)
            .chain(&self.met)
            .chain(&self.torques);
        forces.chain(rest).sum()
    }
}

/// A cage and its contacts over a part as they are solved.
#[derive(Clone, Debug, Default)]
pub struct CageSolution {
    /// Displacement, tilts and turn over the part.
    pub end: [f64; 6],
    /// Pockets by ball.
    pub pockets: Vec<CageForce>,
    /// Ends on the land.
    pub lands: Vec<CageForce>,
    /// Energy lost to the drag of the land, J, and its torque on the cage, N m.
    pub drag: [f64; 2],
    /// What the land asks of the shaft, N and N m.
    pub on_shaft: [f64; 5],
}
