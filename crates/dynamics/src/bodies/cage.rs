//! A cage over a step: a rigid body with small tilts and any turn.
//!
//! Coordinates are displacement (3), tilts (2) and turn (1) since the start of the step. The tilts have the gyroscopic
//! terms of the turn, I_p W times the mean rate of the other tilt, W the speed at the start: they do no work.

use super::UNMOVED;
use crate::system::{Interval, Lumped};

/// A cage over a step.
#[derive(Clone, Debug, PartialEq)]
pub struct CageBody {
    /// Mass of each coordinate: kg, then kg m^2 of tilts and turn.
    pub masses: [f64; 6],
    /// Rates at the start: m/s, rad/s.
    pub rates: [f64; 6],
    /// Mean load, N.
    pub load: [f64; 3],
    /// Step size, s.
    pub dt: f64,
}

impl CageBody {
    /// Rates at the end for the coordinates `x`.
    pub fn rates_at_end(&self, x: &[f64]) -> [f64; 6] {
        std::array::from_fn(|i| 2.0 * x[i] / self.dt - self.rates[i])
    }

    /// Work of its load for the coordinates `x`, J.
    pub fn load_work(&self, x: &[f64]) -> f64 {
        self.load.iter().zip(x).map(|(f, u)| f * u).sum()
    }

    /// I_p W, kg m^2/s.
    fn momentum(&self) -> f64 {
        self.masses[5] * self.rates[5]
    }
}

impl Lumped for CageBody {
    fn n_unknowns(&self) -> usize {
        6
    }

    fn start(&self) -> &[f64] {
        &UNMOVED
    }

    fn guess(&self, _interval: Interval) -> Vec<f64> {
        self.rates.iter().map(|rate| self.dt * rate).collect()
    }

    fn balance(&self, _interval: Interval, x: &[f64], residual: &mut [f64]) {
        let end = self.rates_at_end(x);
        for (i, out) in residual.iter_mut().enumerate() {
            let load = self.load.get(i).copied().unwrap_or(0.0);
            *out = self.masses[i] * (end[i] - self.rates[i]) / self.dt - load;
        }
        let turning = self.momentum() / self.dt;
        residual[3] += turning * x[4];
        residual[4] -= turning * x[3];
    }

    fn tangent(&self, _interval: Interval) -> Vec<f64> {
        let mut tangent = vec![0.0; 36];
        for i in 0..6 {
            tangent[7 * i] = 2.0 * self.masses[i] / (self.dt * self.dt);
        }
        let turning = self.momentum() / self.dt;
        tangent[6 * 3 + 4] = turning;
        tangent[6 * 4 + 3] = -turning;
        tangent
    }

    fn remedy(&self) -> &'static str {
        "give the cage a mass"
    }

    fn name(&self, unknown: usize) -> String {
        let names = ["x", "y", "z", "tilt about x", "tilt about y", "turn"];
        format!("cage, {}", names[unknown])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a step would make or lose kinetic energy, or the gyroscopic terms would work. A tilting cage that turns:
    /// forces times motion are the change of kinetic energy less the work of the load; a free one nutates at I_p W/I_t.
    #[test]
    fn forces_over_a_step_are_its_change_of_energy() {
        let cage = CageBody {
            masses: [0.012, 0.012, 0.012, 4e-6, 4e-6, 7e-6],
            rates: [0.1, -0.2, 0.05, 3.0, -2.0, 80.0],
            load: [0.1, -0.12, 0.0],
            dt: 1e-5,
        };
        let x = [1.1e-6, -1.7e-6, 6e-7, 2.9e-5, -2.2e-5, 8.1e-4];
        let mut residual = [0.0; 6];
        cage.balance(Interval::Rest, &x, &mut residual);
        let work: f64 = residual.iter().zip(x).map(|(f, u)| f * u).sum();
        let energy = |v: [f64; 6]| 0.5 * (0..6).map(|i| cage.masses[i] * v[i] * v[i]).sum::<f64>();
        let gain = energy(cage.rates_at_end(&x)) - energy(cage.rates);
        assert!((work + cage.load_work(&x) - gain).abs() < 1e-13 * energy(cage.rates));
        // Free nutation of the tilts over a turn of them.
        let speed = 7e-6 * 80.0 / 4e-6;
        let (n, mut rates) = (2000, [0.0, 0.0, 0.0, 1.0, 0.0, 80.0]);
        let dt = 2.0 * std::f64::consts::PI / speed / n as f64;
        for _ in 0..n {
            let step = CageBody {
                rates,
                load: [0.0; 3],
                dt,
                ..cage.clone()
            };
            // [2 I_t/dt^2, turning/dt; -turning/dt, 2 I_t/dt^2] x = 2 I_t/dt rate
            let (a, b) = (2.0 * 4e-6 / (dt * dt), step.momentum() / dt);
            let right = [3, 4].map(|i| 2.0 * 4e-6 / dt * rates[i]);
            let det = a * a + b * b;
            let mut x = [0.0; 6];
            x[3] = (a * right[0] - b * right[1]) / det;
            x[4] = (a * right[1] + b * right[0]) / det;
            x[5] = dt * 80.0;
            let mut out = [0.0; 6];
            step.balance(Interval::Rest, &x, &mut out);
            assert!(out[3].abs() < 1e-9 * right[0].abs().max(right[1].abs()));
            rates = step.rates_at_end(&x);
        }
        assert!(
            (rates[3] - 1.0).abs() < 1e-5 && rates[4].abs() < 1e-5,
            "{rates:?}"
        );
    }
}
