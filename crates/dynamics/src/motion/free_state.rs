//! What evolves of free balls.

use contact::Meridian;

use super::cage_state::CageState;
use super::ring_course::RingCourse;
use crate::interactions::free_contact::place::orbit;
use crate::interactions::traction::Slip;
use crate::model::BallInertia;

/// Free balls: places, velocities and angular velocities in space, and what their contacts report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeState {
    /// Places of the centres, m.
    pub places: Vec<[f64; 3]>,
    /// Velocities, m/s.
    pub velocities: Vec<[f64; 3]>,
    /// Angular velocities, rad/s.
    pub turnings: Vec<[f64; 3]>,
    /// Changes of velocity and angular velocity in the last step beyond the turning round the axis, over its time,
    /// m/s^2 and rad/s^2: the next step's guess.
    pub trends: Vec<[f64; 6]>,
    /// Traction in the last step, by site.
    pub contacts: Vec<ContactTraction>,
    /// What contacts have met on elastic rings, by site.
    pub courses: Vec<RingCourse>,
    /// What real surfaces did in the last step, by site: force on the ball along the rolling direction, N, and moment
    /// on it in space, N m; empty where all are smooth.
    pub track: Vec<[f64; 4]>,
    /// Orientations of all balls, unit quaternions from the frame of a ball to space; empty where all are spheres.
    pub orientations: Vec<[f64; 4]>,
    /// The cage, if it is free.
    pub cage: Option<CageState>,
}

/// Traction of a contact in a step. Slips are those that the force follows: at the end of the step, as a rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactTraction {
    /// Slip of the ball on the ring in the frame of the rolling direction, the one across it and the normal, which
    /// points from the ball's centre to the raceway.
    pub slip: Slip,
    /// Forces on the ball along the first two of them, N, then moments about all three and the contact's centre, N m.
    pub action: [f64; 5],
    /// Power lost over the step, W.
    pub power: f64,
    /// Torque on the ball about the ring's axis, N m.
    pub torque: f64,
}

impl ContactTraction {
    /// As a row of numbers, for files.
    pub fn to_row(self) -> [f64; 12] {
        let ContactTraction {
            slip:
                Slip {
                    centre: [s_t, s_q],
                    turning: [w_t, w_q, spin],
                },
            action: [f_t, f_q, m_t, m_q, m_n],
            power,
            torque,
        } = self;
        [s_t, s_q, w_t, w_q, spin, f_t, f_q, m_t, m_q, m_n, power, torque]
    }

    /// From a row of numbers.
    pub fn from_row(row: [f64; 12]) -> ContactTraction {
        let [s_t, s_q, w_t, w_q, spin, f_t, f_q, m_t, m_q, m_n, power, torque] = row;
        ContactTraction {
            slip: Slip {
                centre: [s_t, s_q],
                turning: [w_t, w_q, spin],
            },
            action: [f_t, f_q, m_t, m_q, m_n],
            power,
            torque,
        }
    }
}

impl FreeState {
    /// Azimuth of a ball, rad.
    pub fn azimuth(&self, ball: usize) -> f64 {
        let [x, y, _] = self.places[ball];
        y.atan2(x)
    }

    /// Speed of a ball round the axis, rad/s.
    pub fn orbit(&self, ball: usize) -> f64 {
        orbit(self.places[ball], self.velocities[ball])
    }

    /// Distance of a ball from the axis, m; its speed round the axis and its turning about e_r, e_psi, e_z, rad/s.
    pub(super) fn rolls(&self, ball: usize) -> (f64, [f64; 4]) {
        let ([x, y, _], [u, v, w]) = (self.places[ball], self.turnings[ball]);
        let out = x.hypot(y);
        let turning = [(u * x + v * y) / out, (v * x - u * y) / out, w];
        (out, [self.orbit(ball), turning[0], turning[1], turning[2]])
    }

    /// Velocity of a ball in its meridian plane, m/s.
    pub fn meridian_velocity(&self, ball: usize) -> Meridian {
        let ([x, y, _], [u, v, w]) = (self.places[ball], self.velocities[ball]);
        let radius = x.hypot(y);
        let radial = if radius > 0.0 {
            (x * u + y * v) / radius
        } else {
            0.0
        };
        Meridian::new(radial, w)
    }

    /// Sum of all its numbers: not finite if one is not.
    pub(super) fn sum(&self) -> f64 {
        let vectors = [&self.places, &self.velocities, &self.turnings];
        let vectors = vectors.into_iter().flat_map(|v| v.as_flattened()).sum::<f64>();
        let cage = self.cage.iter().map(CageState::sum).sum::<f64>();
        let courses = self.courses.iter().flat_map(|c| c.to_row()).sum::<f64>();
        let surfaces = [&self.track, &self.orientations].into_iter();
        let track = surfaces.flat_map(|v| v.as_flattened()).sum::<f64>();
        vectors + cage + courses + track + self.contacts.iter().flat_map(|c| c.to_row()).sum::<f64>()
    }

    /// Kinetic energy of all balls of this inertia, J.
    pub fn kinetic(&self, BallInertia { mass, moment }: BallInertia) -> f64 {
        let square = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
        let pairs = self.velocities.iter().zip(&self.turnings);
        pairs
            .map(|(v, w)| 0.5 * (mass * square(v) + moment * square(w)))
            .sum()
    }
}
