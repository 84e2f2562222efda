//! The generalised-alpha family of one-step schemes (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371,
//! doi:10.1115/1.2900803).
//!
//! Balance: M a[1-am] + C v[1-af] + K w[1-af] = f, where x[1-s] = (1-s) x1 + s x0; Newmark: w1 = w0 + dt v0 + dt^2
//! ((1/2-beta) a0 + beta a1), v1 = v0 + dt ((1-gamma) a0 + gamma a1). Contact forces are means
//! over the step, moved to the weighted time ([`super::contacts`]). With am = af = 1/2, beta = 1/4, gamma = 1/2 this is the midpoint rule, which conserves the energy of a linear body exactly.

/// Parameters of the scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrator {
    /// Weight of the old acceleration.
    pub alpha_m: f64,
    /// Weight of the old displacement and velocity.
    pub alpha_f: f64,
    /// Newmark's beta.
    pub beta: f64,
    /// Newmark's gamma.
    pub gamma: f64,
}

impl Integrator {
    /// Average acceleration in its energy-conserving (midpoint) form: Chung-Hulbert with rho = 1.
    pub fn average_acceleration() -> Integrator {
        Integrator::chung_hulbert(1.0)
    }

    /// Whether the scheme conserves the energy of a linear body; the others lose some on purpose.
    pub fn is_conserving(&self) -> bool {
        *self == Integrator::average_acceleration()
    }

    /// Chung-Hulbert with spectral radius `rho` at infinite frequency, 0..=1; second order.
    pub fn chung_hulbert(rho: f64) -> Integrator {
        Integrator::second_order((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// HHT-alpha, `alpha` in 0..=1/3 (minus the alpha of Hilbert, Hughes and Taylor 1977); second order.
    pub fn hht(alpha: f64) -> Integrator {
        Integrator::second_order(0.0, alpha)
    }

    /// Newmark; second order only for gamma = 1/2. Balance is at the end of the step. Without numerical damping, gamma = 1/2,
    /// it is the mean of the balances at both ends: the same scheme for linear bodies, and contacts then exchange exactly the
    /// energy that they store. Their force at the end of the step would feed energy into flexible rings.
    pub fn newmark(beta: f64, gamma: f64) -> Integrator {
        let weight = if gamma == 0.5 { 0.5 } else { 0.0 };
        Integrator {
            alpha_m: weight,
            alpha_f: weight,
            beta,
            gamma,
        }
    }

    fn second_order(alpha_m: f64, alpha_f: f64) -> Integrator {
        let gamma = 0.5 - alpha_m + alpha_f;
        let root = 1.0 - alpha_m + alpha_f;
        Integrator {
            alpha_m,
            alpha_f,
            beta: 0.25 * root * root,
            gamma,
        }
    }

    /// Coefficients of M, C and K in the effective matrix S at step size `dt`.
    pub fn effective(&self, dt: f64) -> [f64; 3] {
        let (m, f) = (1.0 - self.alpha_m, 1.0 - self.alpha_f);
        [m / (self.beta * dt * dt), f * self.gamma / (self.beta * dt), f]
    }

    /// Coefficients of v0 and a0 in the vectors that M and C multiply on the right-hand side of S dw.
    pub fn history(&self, dt: f64) -> [[f64; 2]; 2] {
        let (m, f) = (1.0 - self.alpha_m, 1.0 - self.alpha_f);
        let (b, g) = (self.beta, self.gamma);
        let mass = [m / (b * dt), m * (0.5 / b - 1.0) - self.alpha_m];
        let damping = [f * (g / b - 1.0) - self.alpha_f, f * dt * (0.5 * g / b - 1.0)];
        [mass, damping]
    }

    /// Weighted acceleration a[1-am] of a step with displacement increment `dw`, and its derivative with respect to it.
    pub fn weighted_acceleration(&self, dt: f64, dw: f64, v0: f64, a0: f64) -> [f64; 2] {
        let (m, slope) = (1.0 - self.alpha_m, 1.0 / (self.beta * dt * dt));
        let old = self.alpha_m - m * (0.5 / self.beta - 1.0);
        [m * slope * (dw - dt * v0) + old * a0, m * slope]
    }

    /// Velocity and acceleration at the end of a step with displacement increment `dw`.
    pub fn update(&self, dt: f64, dw: f64, v0: f64, a0: f64) -> [f64; 2] {
        let a1 = (dw - dt * v0) / (self.beta * dt * dt) - (0.5 / self.beta - 1.0) * a0;
        [v0 + dt * ((1.0 - self.gamma) * a0 + self.gamma * a1), a1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error at t = 1 of w'' + 2 z p w' + p^2 w = 0, w(0) = 1, w'(0) = 0.
    fn error(scheme: Integrator, damping: f64, n: usize) -> f64 {
        let (p, dt) = (5.0f64, 1.0 / n as f64);
        let (m, c, k) = (1.0, 2.0 * damping * p, p * p);
        let [sm, sc, sk] = scheme.effective(dt);
        let s = sm * m + sc * c + sk * k;
        let (mut w, mut v, mut a) = (1.0, 0.0, -k);
        for _ in 0..n {
            let [[mv, ma], [cv, ca]] = scheme.history(dt);
            let dw = (-k * w + m * (mv * v + ma * a) + c * (cv * v + ca * a)) / s;
            [v, a] = scheme.update(dt, dw, v, a);
            w += dw;
        }
        let q = p * (1.0 - damping * damping).sqrt();
        let exact = (-damping * p).exp() * (q.cos() + damping * p / q * q.sin());
        (w - exact).abs()
    }

    /// Wrong: a setting would not have its order. Damped and undamped oscillator, step halved.
    #[test]
    fn every_setting_has_its_order() {
        let settings = [
            (Integrator::average_acceleration(), 2.0),
            (Integrator::chung_hulbert(0.8), 2.0),
            (Integrator::chung_hulbert(0.0), 2.0),
            (Integrator::hht(0.1), 2.0),
            (Integrator::newmark(0.25, 0.5), 2.0),
            (Integrator::newmark(0.3025, 0.6), 1.0),
        ];
        for (scheme, order) in settings {
            for damping in [0.0, 0.1] {
                let rate = (error(scheme, damping, 200) / error(scheme, damping, 400)).log2();
                assert!(
                    (rate - order).abs() < 0.1,
                    "{scheme:?} at damping {damping}: order {rate}, not {order}"
                );
            }
        }
    }

    /// Wrong: the midpoint rule would not conserve the energy of a linear oscillator.
    #[test]
    fn average_acceleration_conserves_energy() {
        let (scheme, dt, k) = (Integrator::average_acceleration(), 0.3, 25.0);
        let [sm, _, sk] = scheme.effective(dt);
        let (mut w, mut v, mut a) = (1.0, 0.0, -k);
        for _ in 0..1000 {
            let [[mv, ma], _] = scheme.history(dt);
            let dw = (-k * w + mv * v + ma * a) / (sm + sk * k);
            [v, a] = scheme.update(dt, dw, v, a);
            w += dw;
            assert!((0.5 * v * v + 0.5 * k * w * w - 12.5).abs() < 1e-11);
        }
    }

    /// Wrong: Newmark without numerical damping would be another scheme than average acceleration, and contacts would gain
    /// energy with it.
    #[test]
    fn newmark_without_damping_is_average_acceleration() {
        assert!(Integrator::newmark(0.25, 0.5).is_conserving());
        assert_eq!(Integrator::newmark(0.3025, 0.6).alpha_f, 0.0);
    }

    /// Wrong: `rho` would not be the damping of the highest frequencies per step.
    #[test]
    fn high_frequencies_decay_by_rho() {
        for rho in [0.5, 0.8] {
            let scheme = Integrator::chung_hulbert(rho);
            let k = 1e12;
            let [sm, _, sk] = scheme.effective(1.0);
            let (mut w, mut v, mut a) = (1.0, 0.0, -k);
            let mut sizes = Vec::new();
            for _ in 0..=60 {
                let [[mv, ma], _] = scheme.history(1.0);
                let dw = (-k * w + mv * v + ma * a) / (sm + sk * k);
                [v, a] = scheme.update(1.0, dw, v, a);
                w += dw;
                sizes.push(a.abs().max(k * w.abs()));
            }
            // The double root at infinity adds a factor that grows with the step number only.
            let decay = (sizes[60] / sizes[40]).powf(0.05);
            assert!((decay - rho).abs() < 0.05, "{rho}: {decay}");
        }
    }
}
