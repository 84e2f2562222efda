//! What the way of the balls round their bearing adds to its matrices.
//!
//! A ball goes round with the speed W of the cage, so what it meets changes even where nothing moves. With the motion
//! of the balls as a function of azimuth and time, x(psi, t), and the approaches g(psi, t) of their contacts, it has
//!
//! ```text
//! x'' = d2x/dt2 + 2 W d2x/(dt dpsi) + W^2 d2x/dpsi2,      g' = dg/dt + W dg/dpsi
//! ```
//!
//! The first are the gyroscopic moment and the centrifugal force of balls that go round in a plane which tilts. With
//! contact damping c the second is a stiffness c W that turns: it takes from the drive of the balls and feeds motions
//! that go round along with them, more slowly than they do, as damping in a rotor does.
//!
//! d/dpsi is that of the trigonometric polynomial through the balls ([`course_slopes`]). It is exact where a shaft
//! moves or tilts on three or more balls alike, and leaves out that matrices change as single balls pass.

use crate::kinematics::course_slopes;
use crate::stiffness::{Linearisation, N_SHAFT, is_held};

impl Linearisation {
    /// The same with the inertia of balls of this mass, kg, that go round with `speed`, rad/s.
    pub fn going_round(mut self, ball_mass: f64, speed: f64) -> Linearisation {
        if speed == 0.0 {
            return self;
        }
        let slopes = self.slopes();
        self.add_orbits(&slopes, ball_mass * speed * speed);
        let (n, balls) = (self.n, self.n_balls);
        let mut damping = self.damping.take().unwrap_or_else(|| vec![0.0; n * n]);
        for (i, j) in (0..balls * balls).map(|k| (k / balls, k % balls)) {
            for dof in 0..2 {
                let at = n * (N_SHAFT + 2 * i + dof) + N_SHAFT + 2 * j + dof;
                damping[at] += 2.0 * ball_mass * speed * slopes[balls * i + j];
            }
        }
        self.damping = Some(damping);
        self
    }

    /// The same with that inertia where all stands still, as an equilibrium has it with `[effects.orbit_inertia]`.
    pub(crate) fn on_orbits(mut self, ball_mass: f64, speed: f64) -> Linearisation {
        let slopes = self.slopes();
        self.add_orbits(&slopes, ball_mass * speed * speed);
        self
    }

    /// Adds mass times squared speed, N/m, times the second derivative over the balls; once.
    fn add_orbits(&mut self, slopes: &[f64], inertia: f64) {
        if std::mem::replace(&mut self.has_orbits, true) {
            return;
        }
        let (n, balls) = (self.n, self.n_balls);
        for (i, j) in (0..balls * balls).map(|k| (k / balls, k % balls)) {
            let twice: f64 = (0..balls)
                .map(|k| slopes[balls * i + k] * slopes[balls * k + j])
                .sum();
            for dof in 0..2 {
                self.stiffness[n * (N_SHAFT + 2 * i + dof) + N_SHAFT + 2 * j + dof] += inertia * twice;
            }
        }
    }

    /// The same with damped contacts that close because their balls pass with `speed`, rad/s.
    pub fn passing(mut self, speed: f64) -> Linearisation {
        if speed != 0.0 && self.closing.iter().any(|contact| contact.damping > 0.0) {
            let slopes = self.slopes();
            self.add_passing(&slopes, speed);
        }
        self
    }

    /// d/dpsi over the balls, row-major.
    fn slopes(&self) -> Vec<f64> {
        let (n, balls) = (self.n, self.n_balls);
        let touched = (N_SHAFT..N_SHAFT + 2 * balls).step_by(2);
        let touched = touched.map(|i| is_held(&self.stiffness[n * i..n * (i + 1)], i));
        course_slopes(&touched.collect::<Vec<bool>>())
    }

    /// Damping of contacts that close because their balls pass.
    fn add_passing(&mut self, slopes: &[f64], speed: f64) {
        let (n, balls) = (self.n, self.n_balls);
        for (site, contact) in self.closing.iter().enumerate().filter(|(_, c)| c.damping > 0.0) {
            for (other, met) in self.closing.iter().enumerate().skip(site % 2).step_by(2) {
                let rate = contact.damping * speed * slopes[balls * (site / 2) + other / 2];
                for &(row, a) in contact.rows.iter().chain(&contact.of_ring) {
                    for &(column, b) in met.rows.iter().chain(&met.of_ring) {
                        self.stiffness[n * row + column] += rate * a * b;
                    }
                }
            }
        }
    }
}
