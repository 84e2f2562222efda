//! Contact force with a given restitution.
//!
//! Hunt and Crossley (J. Appl. Mech. 42 (1975) 440): force k d^1.5 (1 + A dd/dt / v_0), v_0 the speed at first touch.
//! For a free impact of restitution e, whatever exponent, stiffness and speed,
//!
//! ```text
//! A (1 + e) = ln[(1 + A) / (1 - A e)],   0 < A < 1/e
//! ```
//!
//! (from v dv/dd = -k d^1.5 (1 + A v/v_0)/m: the integrals of v dv/(1 + A v/v_0) over compression and restitution are
//! equal). The usual 3 (1 - e^2)/4 of Lankarani and Nikravesh is its limit near 1 alone: with 0.6 it rebounds with
//! 0.76. The force never pulls.

use contact::ContactLaw;

use super::design::Cage;
use crate::interactions::contact_damping::Viscous;
use crate::interactions::discrete_gradient::{MeanForce, mean_force_with};

/// Speed of a first touch at least, m/s: what begins to touch at rest has none. Below it impacts lose less than they
/// should, of energies that do not count; far below it round-off of the lengths, times A/v_0, would be a force.
const LEAST_SPEED: f64 = 1e-4;

impl Cage {
    /// Law of force and impact of its contacts.
    pub fn impact(&self) -> Impact {
        Impact::new(self.law(), self.restitution)
    }
}

/// Length below which two points count as one, m: their distance has no direction.
const ONE_POINT: f64 = 1e-15;

/// Law of a contact with impacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    law: ContactLaw,
    /// A.
    dissipation: f64,
    /// v_0, m/s.
    speed: f64,
}

impl Impact {
    /// Force law and restitution; nothing has touched yet.
    pub fn new(law: ContactLaw, restitution: f64) -> Impact {
        Impact {
            law,
            dissipation: dissipation(restitution),
            speed: LEAST_SPEED,
        }
    }

    /// The same after a first touch at a speed, m/s.
    pub fn met_at(self, speed: f64) -> Impact {
        let speed = speed.max(LEAST_SPEED);
        Impact { speed, ..self }
    }

    /// Speed of the first touch, m/s.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Mean force over a step of `dt` between the distances `l` from the middle of a clearance, whose half is
    /// `touching`; the sign is that of the force on what stands at the middle.
    pub fn mean(&self, touching: f64, l: [[f64; 2]; 2], dt: f64) -> MeanForce {
        let size = |l: [f64; 2]| l[0].hypot(l[1]);
        let ends = l.map(|l| size(l) - touching);
        if ends.iter().all(|d| *d <= 0.0) || l.iter().all(|l| size(*l) < ONE_POINT) {
            return MeanForce::default();
        }
        // A distance of zero has no direction: that of the other end is taken.
        let l = [0, 1].map(|i| {
            let (own, other) = (l[i], l[1 - i]);
            match size(own) < ONE_POINT {
                true => other.map(|x| x * ONE_POINT / size(other)),
                false => own,
            }
        });
        mean_force_with(&self.law, touching, l, |elastic, change| {
            self.damping(elastic, change, dt)
        })
    }

    /// Mean damping force over a step of `dt`, N, and its derivative with respect to the overlap at its end, from the
    /// same of the elastic force and the change of the overlap.
    fn damping(&self, [mean, slope]: [f64; 2], change: f64, dt: f64) -> Viscous {
        let rate = self.dissipation / self.speed / dt;
        Viscous {
            force: rate * mean * change,
            slope: rate * (mean + slope * change),
            passing: 0.0,
        }
    }

    /// Energy stored at an overlap, J.
    pub fn energy_at(&self, overlap: f64) -> f64 {
        self.law.evaluate(overlap).energy
    }

    /// What an error of an overlap, m, makes of a mean force over a step of `dt`, N.
    pub fn error_of(&self, force: f64, dt: f64, error: f64) -> f64 {
        let stiffness = 1.5 * self.law.stiffness.powf(2.0 / 3.0) * force.cbrt();
        self.force_at(error) + (stiffness + force * self.dissipation / self.speed / dt) * error
    }

    /// Force at an overlap, N.
    pub fn force_at(&self, overlap: f64) -> f64 {
        self.law.evaluate(overlap).force
    }
}

/// The factor A of a restitution above 0 and at most 1.
fn dissipation(restitution: f64) -> f64 {
    let e = restitution;
    if e >= 1.0 {
        return 0.0;
    }
    let excess = |a: f64| a * (1.0 + e) - ((1.0 + a) / (1.0 - a * e)).ln();
    let (mut low, mut high) = (0.0, 1.0 / e);
    // Positive below the root, negative above.
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if excess(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the factor of a restitution. Values of the equation to five digits, and its limits.
    #[test]
    fn the_factor_solves_its_equation() {
        for (e, expected) in [(0.9, 0.16648), (0.6, 0.97487), (0.3, 3.0871)] {
            let found = dissipation(e);
            assert!((found / expected - 1.0).abs() < 2e-5, "{e}: {found}");
        }
        assert_eq!(dissipation(1.0), 0.0);
        let near = dissipation(0.999);
        assert!(
            (near / (0.75 * (1.0 - 0.999f64.powi(2))) - 1.0).abs() < 5e-3,
            "{near}"
        );
    }

    /// Speed after an impact on a wall over that before it, of a body that starts just before its touch. `force` is the
    /// mean force over a step between two places and pushes it back.
    fn rebound((mass, speed): (f64, f64), dt: f64, steps: usize, force: impl Fn(f64, f64) -> f64) -> f64 {
        let (mut x, mut v) = (-1e-9, speed);
        for _ in 0..steps {
            // The balance grows with the place at the end.
            let (mut low, mut high) = (x - 2.0 * dt * speed, x + 2.0 * dt * speed);
            for _ in 0..100 {
                let end = 0.5 * (low + high);
                match 2.0 * mass / (dt * dt) * (end - x - dt * v) + force(x, end) > 0.0 {
                    true => high = end,
                    false => low = end,
                }
            }
            let end = 0.5 * (low + high);
            v = 2.0 * (end - x) / dt - v;
            x = end;
        }
        -v / speed
    }

    fn hertz(stiffness: f64) -> ContactLaw {
        ContactLaw {
            stiffness,
            patch_compliance: 0.0,
            ball_compliance: 0.0,
        }
    }

    /// Wrong: an impact would rebound with another restitution. One body against a wall, any e, stiffness, and speed;
    /// the error falls with the square of the step.
    #[test]
    fn a_body_rebounds_with_the_restitution_given() {
        let (mass, touching) = (2e-3, 1e-2);
        for e in [0.3, 0.6, 0.9, 1.0] {
            for (stiffness, speed) in [(2e8, 0.05), (2e8, 2.0), (5e6, 0.3)] {
                let impact = Impact::new(hertz(stiffness), e).met_at(speed);
                // Time of contact, about 3.2 (m / k)^(2/5) / v^(1/5).
                let time = 3.2 * (mass / stiffness).powf(0.4) / speed.powf(0.2);
                let found = |steps: f64| {
                    let dt = time / steps;
                    let force = |from: f64, to: f64| {
                        let l = [from, to].map(|x| [touching + x, 0.0]);
                        impact.mean(touching, l, dt).force[0]
                    };
                    rebound((mass, speed), dt, (3.0 * steps) as usize, force)
                };
                let [coarse, fine] = [100.0, 400.0].map(|n| (found(n) - e).abs());
                assert!(fine < 1e-3, "{e} {stiffness} {speed}: {fine}");
                assert!(fine < 0.3 * coarse + 1e-9, "{e}: {coarse} {fine}");
            }
        }
    }

    /// Wrong: the restitution would hold for point contact alone. The same damping on elastic forces k d^n with the
    /// exponents of a linear spring, a line contact, Hertz, a flat stamp's edge and a cube; the error falls with the
    /// square of the step.
    #[test]
    fn the_restitution_holds_for_any_exponent() {
        let (mass, speed, stiffness) = (2e-3, 0.3, 1e7f64);
        for exponent in [1.0f64, 10.0 / 9.0, 1.5, 2.0, 3.0] {
            // Overlap at which the strain is the energy of the impact: the time of contact is about 3 overlaps over v.
            let deepest =
                (0.5 * (exponent + 1.0) * mass * speed * speed / stiffness).powf(1.0 / (exponent + 1.0f64));
            for e in [0.3, 0.6, 0.9] {
                let impact = Impact::new(hertz(stiffness), e).met_at(speed);
                let energy = |x: f64| stiffness * x.max(0.0).powf(exponent + 1.0) / (exponent + 1.0);
                let found = |steps: f64| {
                    let dt = 3.0 * deepest / speed / steps;
                    let force = |from: f64, to: f64| {
                        let change = to - from;
                        let elastic = if change == 0.0 {
                            stiffness * to.max(0.0).powf(exponent)
                        } else {
                            (energy(to) - energy(from)) / change
                        };
                        (elastic + impact.damping([elastic, 0.0], change, dt).force).max(0.0)
                    };
                    rebound((mass, speed), dt, (4.0 * steps) as usize, force)
                };
                let [coarse, fine] = [200.0, 800.0].map(|n| (found(n) - e).abs());
                println!("{exponent} {e}: {coarse:e} {fine:e}");
                assert!(fine < 1e-3, "{exponent} {e}: {fine}");
                assert!(fine < 0.3 * coarse + 1e-7, "{exponent} {e}: {coarse} {fine}");
            }
        }
    }
}
