//! How an elastic ring moves at the contact of a free ball, and where that goes on: slopes that the slope force takes,
//! and where Newton starts.
//!
//! Rates are means over the part before: velocities of the ring's nodes at an instant have modes that a step does not
//! resolve.

use crate::interactions::free_contact::FREE_PORTS;

/// An elastic ring at a contact in the part before, measured where the contact was in its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RingCourse {
    /// Mean velocity of groove [radial, axial] and patch (t, q), m/s.
    pub velocity: [f64; FREE_PORTS],
    /// Mean change in time of the growth of the groove's motion [radial, axial] with the azimuth, m/(rad s).
    pub slope_rate: [f64; 2],
}

impl RingCourse {
    /// Mean slope expected in a part of this size with this slope at its start.
    pub(super) fn expected_slope(&self, start: [f64; 2], dt: f64) -> [f64; 2] {
        [0, 1].map(|i| start[i] + 0.5 * dt * self.slope_rate[i])
    }

    /// The course over a part: motion of the ports and slopes at its start and its end.
    pub(super) fn over(ports: [[f64; FREE_PORTS]; 2], slopes: [[f64; 2]; 2], dt: f64) -> RingCourse {
        RingCourse {
            velocity: std::array::from_fn(|i| (ports[1][i] - ports[0][i]) / dt),
            slope_rate: [0, 1].map(|i| (slopes[1][i] - slopes[0][i]) / dt),
        }
    }

    /// As a row of numbers, for files.
    pub fn to_row(self) -> [f64; 6] {
        let RingCourse {
            velocity: [v_r, v_z, v_t, v_q],
            slope_rate: [r, z],
        } = self;
        [v_r, v_z, v_t, v_q, r, z]
    }

    /// From a row of numbers.
    pub fn from_row([v_r, v_z, v_t, v_q, r, z]: [f64; 6]) -> RingCourse {
        RingCourse {
            velocity: [v_r, v_z, v_t, v_q],
            slope_rate: [r, z],
        }
    }
}
