//! A cage with six dofs: its pockets push balls, and a land of a ring may guide it.
//!
//! The cage is rigid. Its tilts are small, its turn theta is any. A pocket is a cylinder whose axis is radial; with u =
//! b - x_c from the centre of the cage to the ball, and e_psi, e_z directions of the pocket in the cage,
//!
//! ```text
//! d = (u . e_psi,  u_z + tilt_y u_x - tilt_x u_y)          from the pocket's centre to the ball's
//! overlap |d| - c_p/2,   force k overlap^1.5 along d,   energy 2/5 k overlap^2.5
//! ```
//!
//! c_p is the diametral clearance. The land holds the ends of the cage: in the planes z = -w/2 and w/2 of the cage the
//! overlap is the eccentricity less c_g/2, by the same law. Forces over a step are discrete gradients
//! ([`super::discrete_gradient`]), and what they do on the coordinates is such that their work is exactly the change of
//! the stored energy.
//!
//! **Impacts** lose energy by Hunt and Crossley's factor ([`impact`]), so that the restitution is the one given, at any
//! speed. **Friction** of balls in pockets and of the cage on its land is Coulomb's, at the slip of the end of the step
//! as the traction of the raceways ([`super::free_contact`]); where that would do work, at the slip of the middle.
//! **Drag** of the land is Petroff's, 2 pi eta R^3 w / (c_g/2) times the relative speed, as if concentric.
//!
//! The land belongs to what carries the ring: deformation of the ring there is left out. Moment of momentum about the
//! axis is kept to the second order in the tilts.

pub mod design;
pub mod impact;
pub mod land;
pub mod links;
pub mod pocket;

pub use self::design::{Cage, Land};

use self::impact::Impact;
use super::free_contact::jet::Jet;
use super::free_contact::{N_LENGTHS, SlipAt};

/// Least slip, m/s, below which friction grows in proportion to slip.
const LEAST_SLIP: f64 = 1e-3;
/// The same over the speed of the ball's surface.
const SHARE_OF_SURFACE: f64 = 1e-3;

/// What a contact of the cage does over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CageForce {
    /// Normal force: in a pocket on the ball along e_psi and e_z, on a land on the cage along x and y, N.
    pub normal: [f64; 2],
    /// Energy stored at the end, J.
    pub energy: f64,
    /// Energy lost to impacts, J.
    pub impact_loss: f64,
    /// Work of friction on both bodies, J: never positive once the step is solved.
    pub friction_work: f64,
    /// Part of it at the slip that friction follows, J.
    pub work_at_slip: f64,
    /// Torque about the axis on the cage, N m: of a land that of its friction, the rest has none.
    pub torque: f64,
    /// Whether it touches at the end.
    pub touches: bool,
}

/// A contact of the cage over a step.
pub trait CageContact: Send + Sync {
    /// Overlap at the start, m; negative is a gap.
    fn overlap_at_start(&self) -> f64;
    /// Speed at which the bodies move from the middle of their clearance at the start, m/s.
    fn closing_speed(&self) -> f64;
    /// Forces at lengths at the end; adds what resists the growth of the lengths.
    fn evaluate(&self, end: [f64; N_LENGTHS], resists: &mut [Jet; N_LENGTHS]) -> CageForce;
    /// Time of the step, s, and the largest length that enters, m.
    fn sizes(&self) -> (f64, f64);
    /// Its law.
    fn impact(&self) -> &Impact;
    /// The same, to change.
    fn impact_mut(&mut self) -> &mut Impact;

    /// The contact after it was met at a speed, m/s; 0: it was open. The speed counts anew where it opens, and grows
    /// where the bodies are driven on.
    fn after(mut self, met: f64) -> Self
    where
        Self: Sized,
    {
        let closing = self.closing_speed();
        let speed = if self.overlap_at_start() > 0.0 {
            met.max(closing)
        } else {
            closing
        };
        *self.impact_mut() = self.impact().met_at(speed);
        self
    }
}

/// Normal force of a contact between distances from the middle of a clearance, whose half is `touching`: as it grows
/// with the lengths, and what it does; None where it stays open.
fn press(
    impact: &Impact,
    touching: f64,
    (start, last): ([f64; 2], [Jet; 2]),
    dt: f64,
) -> Option<([Jet; 2], CageForce)> {
    let reach = [start, last.map(|l| l.value)];
    let overlap = reach.map(|l| l[0].hypot(l[1]) - touching);
    if overlap.iter().all(|d| *d <= 0.0) {
        return None;
    }
    let mean = impact.mean(touching, reach, dt);
    let load = [0, 1].map(|i| {
        let mut jet = last[0] * mean.tangent[i][0] + last[1] * mean.tangent[i][1];
        jet.value = mean.force[i];
        jet
    });
    let found = CageForce {
        normal: mean.force.map(|f| -f),
        energy: impact.energy_at(overlap[1]),
        impact_loss: mean.loss,
        touches: overlap[1] > 0.0,
        ..CageForce::default()
    };
    Some((load, found))
}

/// Coulomb's friction over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubbing {
    /// Coefficient.
    pub coefficient: f64,
    /// Slip below which friction is in proportion to it, m/s.
    pub small_slip: f64,
    /// Which slip it follows.
    pub slip_at: SlipAt,
}

impl Cage {
    /// Friction of a surface that moves at `speed` m/s.
    pub fn rubbing(&self, speed: f64) -> Rubbing {
        Rubbing {
            coefficient: self.friction,
            small_slip: LEAST_SLIP.max(SHARE_OF_SURFACE * speed.abs()),
            slip_at: SlipAt::default(),
        }
    }
}

impl Rubbing {
    /// Friction under a normal force on the body whose slip is given: that at the middle and, where it is asked for,
    /// that at the end of a step of `dt`; notes its works.
    fn rub(
        &self,
        load: [Jet; 2],
        (at_middle, at_end): ([Jet; 2], impl FnOnce() -> [Jet; 2]),
        dt: f64,
        found: &mut CageForce,
    ) -> [Jet; 2] {
        let slip = match self.slip_at {
            SlipAt::Middle => at_middle,
            SlipAt::End => at_end(),
        };
        let small = self.small_slip;
        let normal = (load[0] * load[0] + load[1] * load[1]).sqrt();
        let size = (slip[0] * slip[0] + slip[1] * slip[1] + small * small).sqrt();
        let share = normal * size.recip() * -self.coefficient;
        let force = slip.map(|s| share * s);
        let work = |slip: [Jet; 2]| dt * (0..2).map(|i| force[i].value * slip[i].value).sum::<f64>();
        found.friction_work = work(at_middle);
        found.work_at_slip = work(slip);
        force
    }

    /// Whether there is friction under a normal force.
    fn acts(&self, found: &CageForce) -> bool {
        self.coefficient > 0.0 && found.normal != [0.0; 2]
    }
}
